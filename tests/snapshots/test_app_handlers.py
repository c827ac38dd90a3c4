"""What a page does when it is used, each handler called as its button calls it."""

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest
from fastapi import FastAPI
from nicegui import ui

from page_session import (
    answering,
    button,
    computed,
    pages_shown,
    press,
    session_of,
    session_of_a_variant,
)
from snapshot import held
from underfoot.app.frame import open_session
from underfoot.app.jobs import DONE, INTERRUPTED, RUNNING, JobQueue
from underfoot.app.pages import PAGES, answer, repair, start, wear
from underfoot.app.project import Project
from underfoot.app.session import Exchange
from underfoot.core import InputError
from underfoot.core.files import checksum


@pytest.fixture
def session(tmp_path):
    return session_of_a_variant(tmp_path)


def opened(folder, cookies=None, headers=None, query=None):
    request: Any = SimpleNamespace(
        cookies=cookies or {}, headers=headers or {}, query_params=query or {}
    )
    project, jobs, exchange = Project(folder), JobQueue(folder), Exchange()
    made = open_session(project, jobs, exchange, PAGES, None, request)
    assert (made.project, made.jobs, made.exchange) == (project, jobs, exchange)
    return made


def test_a_session_is_that_of_the_browser(tmp_path):
    bare = opened(tmp_path)
    assert (bare.text.language, bare.theme, bare.units, bare.query) == ("en", "", "si", {})
    german = {"accept-language": "de-CH,de;q=0.9,en;q=0.8"}
    assert opened(tmp_path, headers=german).text.language == "de"
    assert opened(tmp_path, {"language": "en"}, german).text.language == "en"
    assert opened(tmp_path, {"language": "xx"}, german).text.language == "de"
    chosen = opened(tmp_path, {"theme": "dark", "units": "us"}, query={"variant": "a"})
    assert (chosen.theme, chosen.units, chosen.query) == ("dark", "us", {"variant": "a"})
    assert opened(tmp_path, {"units": "furlongs"}).units == "si"


def test_an_answer_is_changed_and_kept(file_regression, monkeypatch, session):
    project, told = session.project, {}
    went: list[Any] = []
    monkeypatch.setattr(session, "go", lambda route, **query: went.append([route, query]))
    page = answer._Answer(session, "a", project.case("a"))
    asked = answering(
        monkeypatch, session, advised_groove={"motion.speed": "0.4 m/s"},
        previewed=lambda path, folder, changes: {
            "cof": 0.25, "error": 0.01, "fluid_load": "5 %", "slip": 0.02,
            "slip_interval": [0.01, 0.04], "html": {"heel": "<svg/>"}},
    )  # fmt: skip
    monkeypatch.setattr(page, "run", lambda: went.append("run"))
    asyncio.run(page._cut(2))
    assert project.case("a").value("motion.speed") == pytest.approx(0.4)
    told["cut"] = [asked[0][0], asked[0][1][2]]
    message = asyncio.run(page._preview({"motion.speed": "0.5 m/s"}))
    told["moved"], told["cof"] = message, page.preview_cof
    answering(monkeypatch, session, previewed=InputError("too wide", allowed="below 1"))
    told["refused"], told["no cof"] = asyncio.run(page._preview({})), page.preview_cof
    tried = project.folder / "tried"
    tried.mkdir()
    (tried / "result.json").write_text("{}")
    page._keep(str(tried), {"name": "kept", "motion.speed": "0.6 m/s"})
    assert (project.result_folder("kept") / "result.json").read_text() == "{}"
    assert not tried.exists()
    page._make({"name": "wider_channels", "values": {"motion.speed": "0.7 m/s"}})
    page._make({"name": "dry_floor", "values": {"contaminant.viscosity": "2 cP"}})
    told["variants"] = {
        name: [
            line for line in project.text(name).splitlines() if line.startswith(("name", "speed"))
        ]
        for name in sorted(project.variants())
    }
    told["went"] = went
    told["tasks"] = [[one.about, one.first] for one in session.jobs.tasks.values()]
    held(file_regression, told)


def asking_for_help(monkeypatch, session):
    """Return the page of an answer, and what builds its part that says what would help."""
    monkeypatch.setattr(Project, "is_current", lambda self, name: True)
    page = answer._Answer(session, "a", session.project.case("a"))

    def build():
        page.help = ui.element("div")
        page.helped = ui.timer(1.0, lambda: None, active=False)
        page._helps()

    return page, build


def test_what_would_help_is_asked_for_where_it_was_not(monkeypatch, session):
    computed(session, "a")
    page, build = asking_for_help(monkeypatch, session)
    done: list[Any] = []

    async def act(places):
        label = session.text("answer.help_begin")
        press(button(list(places["page"].descendants()), label))
        done.extend(session.jobs.tasks.values())

    pages_shown(monkeypatch, {"page": build}, act)
    (task,) = done
    assert (task.function, task.about, task.first) == (answer.ADVICE, "a", True)
    assert task.title == session.text("answer.help_job")
    assert page.helped.active


def test_another_file_takes_the_place_of_one_that_lacks(session):
    project = session.project
    new = project.inside("soles", "new.stl")
    new.parent.mkdir(exist_ok=True)
    new.write_text("new")
    sums = "0" * 64
    for quote in "\"'":
        file = f"file = {quote}../soles/old.stl{quote}\nsha256 = '{sums}'\n"
        project._set("b", f"[shoe.outsole]\n{file}note = '../soles/older.stl'\n")
        for reference in repair.references(project, "b"):
            if reference.name.endswith("old.stl"):
                assert not reference.holds(project)
                repair.replace_file(project, "b", reference, new)
        text = project.text("b")
        assert f"file = {quote}../soles/new.stl{quote}" in text
        assert f"sha256 = '{checksum(new)}'" in text
        assert "'../soles/older.stl'" in text
    plain = repair.FileReference("../soles/older.stl", None)
    assert not plain.holds(project)
    repair.replace_file(project, "b", plain, new)
    assert project.text("b").count("../soles/new.stl") == 2
    (held_now, other) = repair.references(project, "b")
    assert held_now.holds(project)
    assert other.holds(project)


def test_wear_of_what_was_measured_is_computed(file_regression, monkeypatch, session):
    again: list[str] = []
    told: dict[str, Any] = {}

    async def anew():
        again.append("again")

    def build():
        wear._fill_dialog(session, "a", anew)

    async def act(places):
        inputs = [one for one in places["page"].descendants() if isinstance(one, ui.input)]
        lost, months = inputs
        pressed = button(list(places["page"].descendants()), session.text("wear.compute"))
        for thickness, time in (("0", "3"), ("1.5", "-1"), ("1.5", "6"), ("0.1 cm", "2.5")):
            lost.value, months.value = thickness, time
            press(pressed)
            await asyncio.sleep(0.05)
            tasks = session.jobs.tasks.values()
            told[f"{thickness}, {time}"] = [
                [one.title, one.function, one.about, str(one.arguments[-1]), one.first]
                for one in tasks
            ], len(again), [bool(one.error) for one in inputs]  # fmt: skip

    pages_shown(monkeypatch, {"page": build}, act)
    held(file_regression, told)


@pytest.mark.parametrize("state", [RUNNING, DONE, INTERRUPTED])
def test_help_waits_for_what_runs(monkeypatch, session, state):
    """A button is shown where help isn't there, isn't computed, and was not computed."""
    computed(session, "a")
    build = asking_for_help(monkeypatch, session)[1]
    task = session.submit("t", answer.ADVICE, about="a")
    task.state = state
    shown: list[Any] = []

    async def act(places):
        shown.extend(one.text for one in places["page"].descendants() if isinstance(one, ui.button))

    pages_shown(monkeypatch, {"page": build}, act)
    assert (session.text("answer.help_begin") in shown) == (state == INTERRUPTED)


def test_the_server_of_pages_is_set_up(monkeypatch, session):
    from underfoot.app import serve

    given: dict[str, Any] = {}
    monkeypatch.setattr(serve.pages_app, "on_startup", lambda _: None)
    monkeypatch.setattr(serve.pages_app, "add_static_files", lambda *_: None)
    monkeypatch.setattr(serve, "_route", lambda *_: None)
    monkeypatch.setattr(serve.ui, "run_with", lambda application, **options: given.update(options))
    serve._application(session.project, session.jobs, None)
    assert given == {
        "title": "Underfoot", "dark": None, "tailwind": False, "reconnect_timeout": 30.0,
        "binding_refresh_interval": None, "show_welcome_message": False,
    }  # fmt: skip
    assert serve.pages_app.config.quasar_config["loadingBar"]["skipHijack"] is True


def test_the_gate_stands_before_the_application_with_its_secret():
    from underfoot.app import serve
    from underfoot.app.gate import Gate

    made = serve._server(application := FastAPI(), "secret", 8123, "machine")
    assert vars(made.config.app) == vars(
        Gate(application, "secret", 8123, serve.MOST_BYTES, "machine")
    )
    assert (made.config.log_level, made.config.lifespan) == ("warning", "on")


@pytest.mark.parametrize("kind", ["new", "used", "emptied", "toured"])
def test_the_tour_opens_by_itself_in_a_new_project_alone(monkeypatch, tmp_path, kind):
    session = session_of(tmp_path) if kind in ("new", "toured") else session_of_a_variant(tmp_path)
    if kind == "emptied":
        session.project.remove("a")
    seen: list[bool] = []

    cookies = {"toured": "1"} if kind == "toured" else {}
    request = property(lambda self: SimpleNamespace(cookies=cookies))

    def build():
        with monkeypatch.context() as patch:
            patch.setattr(type(ui.context.client), "request", request)
            start._tour(session)

    async def act(places):
        elements = places["page"].client.elements.values()
        seen.extend(one.value for one in elements if isinstance(one, ui.dialog))

    pages_shown(monkeypatch, {"page": build}, act)
    assert seen == [kind == "new"]
