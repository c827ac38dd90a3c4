"""Pages of the app as they are used: files that are dropped, examples, edits of a study's file."""

import asyncio
from types import SimpleNamespace
from typing import Any, cast

import pytest
from nicegui import ui

from page_session import RUN, answering, computed, pages_shown, session_of_a_variant
from snapshot import held
from underfoot.app.jobs import DONE, FAILED, RUNNING
from underfoot.app.pages import (
    answer,
    design,
    measured_file,
    repair,
    sole_file,
    studies,
    trials,
)
from underfoot.app.project import Project


@pytest.fixture
def session(tmp_path):
    return session_of_a_variant(tmp_path)


def went_of(monkeypatch, session):
    """Return where a session goes, in place of going there."""
    went: list[Any] = []
    monkeypatch.setattr(session, "go", lambda route, **query: went.append([route, query]))
    return went


def dropped(monkeypatch, module):
    """Return what is called with files that are dropped on a page of a module."""
    places: list[Any] = []

    def zone(session, folder, arrived, **words):
        places.append([folder, arrived, sorted(words)])
        return ui.element("div")

    monkeypatch.setattr(module, "drop_zone", zone)
    return places


def test_examples_of_the_start(file_regression, monkeypatch, session):
    went = went_of(monkeypatch, session)
    answer.example(session)
    design.example(session)
    trials.example(session)
    tasks = session.jobs.tasks.values()
    texts = {name: session.project.path(name).read_text() for name in session.project.variants()}
    held(
        file_regression,
        {
            "went": went, "variants": sorted(texts),
            "parts": {name: [line for line in text.splitlines() if line.startswith(
                ("from", "shoe", "contaminant", "name"))] for name, text in texts.items()},
            "tasks": [[one.title, one.function, one.about, one.first, one.then[:2]]
                      for one in tasks],
        },
    )  # fmt: skip


def test_a_run_of_an_answer(file_regression, monkeypatch, session):
    went = went_of(monkeypatch, session)
    monkeypatch.setattr(session, "follow", lambda *_: None)
    alerts: list[Any] = []
    monkeypatch.setattr(answer, "_alert", lambda words: alerts.append(words))
    followed: list[Any] = []
    monkeypatch.setattr(
        answer, "task_line", lambda session, task, ended: followed.append([task, ended])
    )
    page = answer._Answer(session, "a", session.project.case("a"))
    told: list[Any] = []

    async def act(places):
        with places["page"]:
            told.append(page.run_button.enabled)
            page.run()
            told.append(page.run_button.enabled)
            ((task, ended),) = followed
            told.append([task.function, task.about, task.first])
            await ended(SimpleNamespace(problem="no such thing", state=FAILED))
            told.append([page.run_button.enabled, list(went)])
            await ended(SimpleNamespace(problem="", state=DONE))
            told.append([list(went), list(alerts)])

    pages_shown(monkeypatch, {"page": page.show}, act)
    held(file_regression, told)


def test_files_that_are_dropped(file_regression, monkeypatch, session):
    project = session.project
    told: dict[str, Any] = {}
    used: list[str] = []
    asked = answering(monkeypatch, session, compound="rubber.toml")
    places = dropped(monkeypatch, measured_file)
    builds = {
        "sole": lambda: measured_file.build(session, "a", "sole", lambda: used.append("sole")),
        "floor": lambda: measured_file.build(session, "a", "floor", lambda: used.append("floor")),
    }
    changed: list[Any] = []
    monkeypatch.setattr(
        Project, "change", lambda self, name, values: changed.append([name, values])
    )
    pages_shown(monkeypatch, builds)
    for folder, arrived, words in places:
        for file in ("measured/x.csv", "measured/x.toml"):
            asyncio.run(arrived([file]))
        told[f"{folder} {len(told)}"] = words
    told["changed"], told["used"] = list(changed), list(used)
    told["asked"] = [[name, [str(one).rpartition("/")[2] for one in given]]
                     for name, given, _ in asked]  # fmt: skip
    monkeypatch.undo()
    # what a case says is there
    case: Any = SimpleNamespace(value=lambda path: "../measured/old.csv")
    monkeypatch.setattr(Project, "case", lambda self, name: case)
    monkeypatch.setattr(
        Project, "change", lambda self, name, values: changed.append([name, values])
    )
    changed.clear()

    async def leave(found):
        with found["page"]:
            buttons = [one for one in found["page"].descendants() if isinstance(one, ui.button)]
            for one in buttons:
                for heard in one._event_listeners.values():
                    if heard.type == "click":
                        cast(Any, heard.handler)(SimpleNamespace(sender=one, client=one.client,
                                                                 args={}))  # fmt: skip

    lines = pages_shown(
        monkeypatch,
        {"page": lambda: measured_file.build(session, "a", "floor", lambda: used.append("left"))},
        leave,
    )
    told["left"] = [[name, [f"{k}: {v}" for k, v in one.items()]] for name, one in changed]
    told["used then"] = used[-2:]
    told["label"] = [line.strip() for line in lines["page"].splitlines() if "old.csv" in line]
    monkeypatch.undo()
    taken: list[Any] = []
    places = dropped(monkeypatch, sole_file)
    monkeypatch.setattr(
        sole_file, "_Inspection", lambda session, name, path, *_: taken.append([name, path])
    )
    pages_shown(
        monkeypatch, {"page": lambda: sole_file.build(session, "a", cast(Any, None), print)}
    )
    asyncio.run(places[0][1](["soles/new.stl", "soles/other.stl"]))
    monkeypatch.undo()
    soles = project.inside("soles")
    soles.mkdir(exist_ok=True)
    for name in ("one.stl", "two.stl"):
        (soles / name).write_text(name)
    project._set("lost", '[shoe.outsole]\nfile = "../soles/lost.stl"\n')
    places = dropped(monkeypatch, repair)
    monkeypatch.setattr(
        repair, "replace_file",
        lambda project, name, reference, file: taken.append([name, file.name]),
    )  # fmt: skip
    went = went_of(monkeypatch, session)

    async def choose(found):
        (choice,) = (one for one in found["page"].descendants()
                     if isinstance(one, ui.select) and "two.stl" in one.options)  # fmt: skip
        told["choices"] = choice.options
        choice.value = "two.stl"

    pages_shown(
        monkeypatch, {"page": lambda: repair.open_variant(session, "/design", "lost")}, choose
    )
    asyncio.run(places[0][1](["soles/one.stl"]))
    told["taken"], told["went"] = taken, went
    held(file_regression, told)


def test_a_study_is_edited(file_regression, monkeypatch, session):
    file = session.project.inside("studies", "s.toml")
    file.write_text('base = "../variants/a.toml"\n[method]\nbudget = 9\n')
    sheet = {"headline": ["9 cases."], "cautions": [], "remarks": {}, "ended": 0, "begun": False,
             "open": True}  # fmt: skip
    form = {"base": "../variants/a.toml", "method": {"budget": 9}}
    asked = answering(monkeypatch, session, form=form, state=sheet, results=["plots", "rest"],
                      stop=None)  # fmt: skip
    told_to: list[str] = []
    monkeypatch.setattr(session, "tell", lambda error: told_to.append(str(error)))
    pages: list[Any] = []
    session.query = {"study": "s"}
    told: dict[str, Any] = {}

    async def act(places):
        page = pages[0]
        with places["page"]:
            (base,) = (one for one in page.form.descendants() if isinstance(one, ui.select)
                       and "studies.base" not in str(one._props.get("label")) and isinstance(
                           one.options, dict) and "../variants/a.toml" in one.options)  # fmt: skip
            told["bases"] = base.options
            await page.keep("base", "../variants/b.toml")
            told["base"] = page.study_text()
            page.editor.value = 'base = "x"\n'
            await page._take_text()
            told["edited"] = page.study_text()
            before = len(asked)
            await page._take_text()  # nothing has changed
            told["asks again"] = len(asked) - before
            await page.keep("outputs", {"maximise": ["cof"], "require": None}, part=True)
            await page.keep("vary", {"motion.speed": {"from": 1, "to": 2}})
            await page.keep("method", {"kind": "optimise"}, part=True)
            await page.keep("method", {"kind": None, "seed": 3}, part=True)
            told["written"] = page.study_text()
            ends: list[Any] = []
            monkeypatch.setattr(
                studies, "task_line", lambda session, task, ended: ends.append([task, ended])
            )
            await page.run()
            ((task, ended),) = ends
            told["task"] = [task.title, task.function, task.about]
            told["while"] = page.run_button.enabled
            await ended(SimpleNamespace(problem="it broke"))
            await ended(SimpleNamespace(problem=""))
            told["after"] = [page.run_button.enabled, list(told_to)]
            await page.stop()
            told["asked"] = [name for name, *_ in asked]

    def build():
        original = studies._Study.__init__

        def made(self, *given):
            pages.append(self)
            original(self, *given)

        monkeypatch.setattr(studies._Study, "__init__", made)
        studies.build(session)

    pages_shown(monkeypatch, {"page": build}, act)
    held(file_regression, told)


def test_folders_of_trials_that_are_dropped(file_regression, monkeypatch, session):
    went = went_of(monkeypatch, session)
    heard: list[Any] = []
    told_to: list[str] = []
    monkeypatch.setattr(session, "tell", lambda error: told_to.append(str(error)))
    opened: list[str] = []
    monkeypatch.setattr(trials._Trials, "open", lambda self, name: opened.append(name))
    settled = iter(["walks", ""])
    monkeypatch.setattr(trials._Trials, "_settle_folder", lambda self, arriving: next(settled))
    monkeypatch.setattr(trials._Trials, "_turn", lambda self, **_: None)

    class Drop:
        def __init__(self, session, arriving):
            heard.append(len(arriving))

        def on(self, kind, handler):
            heard.append([kind, handler])

    monkeypatch.setattr(trials, "FolderDrop", Drop)
    session.query = {}
    pages_shown(monkeypatch, {"page": lambda: trials.build(session)})
    (kind, arrived) = heard[1]
    arrived(SimpleNamespace(args={"refused": []}))
    arrived(SimpleNamespace(args={"refused": [f"file {k}" for k in range(7)]}))
    held(file_regression, [kind, opened, told_to, went])


def test_a_run_of_a_file_that_changed(monkeypatch, session):
    """A run goes on while its file is the same, and begins again when it is newer."""
    computed(session, "a")
    first = answer.begin_run(session, "a")
    assert answer.begin_run(session, "a") is first
    first.state, first.began = RUNNING, session.project.path("a").stat().st_mtime
    assert answer.begin_run(session, "a") is first
    first.began -= 1.0
    stopped: list[Any] = []
    monkeypatch.setattr(session.jobs, "cancel", stopped.append)
    second = answer.begin_run(session, "a")
    assert second is not first
    assert stopped == [first]
    assert second.function == RUN
    assert second.first
    assert second.then[1].endswith(":advised")
    later = answer.begin_run(session, "a", later=True)
    assert later is second  # it waits still
    later.state = DONE
    third = answer.begin_run(session, "a", later=True)
    assert (third.first, third.then) == (False, ())
