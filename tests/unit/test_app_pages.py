"""Pages of the app in this process, without browser or server, and the queue behind them."""

import asyncio
import json
import os
import re
import tomllib
from contextlib import nullcontext
from functools import partial
from importlib import import_module
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import xarray as xr
from nicegui import ui
from nicegui.testing.user_simulation import user_simulation

from underfoot.app import trials_plots, work, work_sole, work_studies
from underfoot.app.jobs import (
    DONE,
    FAILED,
    INTERRUPTED,
    RUNNING,
    STOPPED,
    WAITING,
    Jobs,
    Lane,
    Task,
)
from underfoot.app.pages import (
    PAGES,
    answer,
    design,
    measured_file,
    place,
    sole_file,
    studies,
    trials,
)
from underfoot.app.pages.trials_trial import TrialView
from underfoot.app.project import Project
from underfoot.app.session import Exchange, Session, problem_parts
from underfoot.app.text import LANGUAGES, Text
from underfoot.app.trials_study import STANDARD, Study
from underfoot.app.variant_bar import new_variant
from underfoot.core import SourcedValue, silent
from underfoot.core.errors import Cancelled, InputError
from underfoot.core.page import Section
from underfoot.trials.study.file_result import StepResult
from underfoot.trials.study.record_signals import Envelope

RUN = "underfoot.app.work:computed"


class Here:
    """Answers in this process what a page asks."""

    async def ask(self, function, *args, units, language, **options):
        module, _, name = function.partition(":")
        return getattr(import_module(module), name)(*args, progress=lambda *_: None, **options)


def session_of(folder, language="en", **query):
    jobs = Jobs(folder)
    jobs.live = jobs.reading = cast(Any, Here())
    return Session(Project(folder), jobs, Text(language), query, Exchange(), PAGES)


def shown(build, look):
    """Return what ``look`` finds on a page that ``build`` fills."""

    async def run():
        async with user_simulation(root=build) as user:
            await user.open("/")
            await asyncio.sleep(0.05)  # timers that begin at once
            found = look(cast(Any, user.client).elements.values())
            return await found if asyncio.iscoroutine(found) else found

    return asyncio.run(run())


async def until(holds):
    """Wait until something holds, for 20 s at most."""
    for _ in range(400):
        if holds():
            return
        await asyncio.sleep(0.05)


def words_of(elements):
    return [each.text for each in elements if isinstance(each, ui.label | ui.button)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.route)
def test_every_page_opens_with_a_heading_with_and_without_a_variant(tmp_path, caplog, page):
    for variants, language in enumerate(LANGUAGES):
        session = session_of(tmp_path, language)
        if variants:
            new_variant(session, "shoe", shoe="work_shoe_half_tread", contaminant="detergent")

        def heads(elements):
            return [each.tag for each in elements if each.tag in ("h1", "h2")]

        # a page of one variant asks for one where there is none
        asks = not variants and page.route in ("/design", "/answer")
        assert bool(shown(partial(page.build, session), heads)) is not asks
    assert not [each for each in caplog.records if each.levelname == "ERROR"]


def test_a_project_shows_how_far_its_runs_are_and_queues_those_that_lack(tmp_path, caplog):
    session = session_of(tmp_path)
    for name in "abc":
        new_variant(session, name, shoe="work_shoe_half_tread", contaminant="detergent")
    tasks = [session.submit("run", RUN, about=name) for name in "ab"]
    tasks[0].state, tasks[0].fraction = RUNNING, 0.5
    page = next(each for each in PAGES if each.route == "/project")

    async def look(elements):
        (bar,) = (each for each in elements if isinstance(each, ui.linear_progress))
        wanted = session.text("project.compute_some", count=1)
        await until(lambda: wanted in words_of(elements))
        (button,) = (e for e in elements if isinstance(e, ui.button) and e.text == wanted)
        seen = bar.value, cast(Any, bar.parent_slot).parent.visible, words_of(elements)
        for each in list(button._event_listeners.values()):
            if each.type == "click":
                cast(Any, each.handler)(
                    SimpleNamespace(sender=button, client=button.client, args={})
                )
        await until(lambda: len(session.jobs.tasks) == 3)
        return seen

    value, visible, lines = shown(lambda: page.build(session), look)
    assert (value, visible) == (0.25, True)
    assert [task.about for task in session.jobs.tasks.values()] == ["a", "b", "c"]
    assert not [each for each in caplog.records if each.levelname == "ERROR"]
    assert session.text("project.left", done=0, total=2, now="a") in lines


@pytest.mark.parametrize(
    ("state", "current", "offered"),
    [(None, True, True), (DONE, True, False), (INTERRUPTED, True, True),
     (None, False, False), (DONE, False, False), (INTERRUPTED, False, False)],
)  # fmt: skip
def test_what_would_help_is_offered_for_the_present_inputs_until_it_was_computed(
    tmp_path, monkeypatch, state, current, offered
):
    session = session_of(tmp_path)
    monkeypatch.setattr(Project, "is_current", lambda *_: current)
    task = None if state is None else Task(1, "help", state=state)

    def build():
        page = SimpleNamespace(session=session, name="a", text=session.text, help=ui.element())
        answer._Answer._offer_help(cast(Any, page), task)

    found = shown(build, lambda elements: [e for e in elements if isinstance(e, ui.button)])
    assert bool(found) is offered


def test_a_measured_file_comes_into_its_folder_and_into_the_case(tmp_path, monkeypatch):
    session, sent = session_of(tmp_path), []
    name = new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    monkeypatch.setattr(ui, "run_javascript", sent.append)
    used = []
    rows = ["x [mm],z [um]", *(f"{k / 1000},{(3 * k + k * k) % 7}" for k in range(400))]
    session.project.inside("measured").mkdir(exist_ok=True)
    session.project.inside("measured", "scan.csv").write_text("\n".join(rows), encoding="utf-8")

    async def look(elements):
        zones = [e for e in elements if "drop" in e.classes]
        return [next(iter(zone._event_listeners.values())).handler for zone in zones]

    (handler, _) = shown(
        lambda: measured_file.build(session, name, "floor", lambda: used.append(1)),
        lambda elements: [
            next(iter(each._event_listeners.values())).handler
            for each in elements
            if "drop" in each.classes
        ],
    )
    assert [re.findall(r'"folder": ?"(\w+)"', each)[0] for each in sent] == ["measured"] * 2
    asyncio.run(handler(SimpleNamespace(args={"detail": {"paths": ["measured/scan.csv"]}})))
    text = session.project.path(name).read_text("utf-8")
    assert "../measured/scan.csv" in text
    assert used == [1]


def test_an_edit_that_is_undone_and_done_again_is_written_from_the_text_that_stands_there():
    asked = []

    async def ask(*args):
        asked.append(args[2:])

    async def discard():
        pass

    study = SimpleNamespace(asked={}, done=[("before", "after")], undone=[])
    page: Any = SimpleNamespace(session=SimpleNamespace(ask=ask), study=study, _discard=discard)
    page._put = partial(TrialView._put, page)
    asyncio.run(TrialView._undo(page))
    assert (study.done, study.undone) == ([], [("before", "after")])
    asyncio.run(TrialView._redo(page))
    assert (study.done, study.undone) == ([("before", "after")], [])
    assert asked == [("before", "after"), ("after", "before")]


def test_how_a_folder_is_analysed_is_kept_and_is_new_once(tmp_path):
    project = Project(tmp_path)
    project.inside("trials", "walks").mkdir(parents=True)
    study = Study(project, "walks")
    assert study.keep(STANDARD) is False
    assert study.keep({"names": "a"}) is True
    assert study.keep({"names": "a"}) is False
    assert Study(project, "walks").settings == {**STANDARD, "names": "a"}


def test_a_step_is_drawn_with_the_ratio_of_its_own_contact():
    seen = Envelope(0.0, 0.1, np.zeros(1), np.array([900.0]))
    plate = SimpleNamespace(start=0.0, end=9.0, rate=1000.0, envelope=lambda *_: seen)
    signals = SimpleNamespace(force={"P": plate}, heel_speed={})
    ratios = [
        {"number": k, "ratio": [k / 10.0] * 2, "normal": [600.0, 10.0],
         "time": np.array([0.0, 0.1]), "peak": k / 10.0, "peak_time": 0.02, "gate": 0.01}
        for k in (1, 2, 3)
    ]  # fmt: skip
    step = StepResult(
        number=2, contact=1.0, toe_off=1.6, plate="P", verdict="accepted", side="left"
    )
    record = SimpleNamespace(curves={"steps": ratios})
    drawn = trials_plots.step_plot(cast(Any, record), step, cast(Any, signals))
    assert [each["value"] for each in drawn["events"] if each["id"] == "rcof"] == [0.2]
    assert len(drawn["panels"]) == 2


def queue(folder, answers):
    """Return jobs whose processes give these answers, or raise them."""

    class Lane:
        async def ask(self, function, *args, heard, **options):
            heard(SimpleNamespace(stage="half way", fraction=0.5))
            answer = answers[function.partition(":")[2]]
            if isinstance(answer, BaseException):
                raise answer
            return answer

    jobs: Any = Jobs(folder)
    jobs._lane = lambda _: Lane()
    return jobs


def test_a_job_ends_done_stopped_or_failed_and_what_follows_one_that_is_done_is_queued(tmp_path):
    refused = InputError("too thick", where="film")
    jobs = queue(tmp_path, {"good": 7, "left": Cancelled("stopped"), "bad": refused, "next": 8})
    then = "after it", "b:next", "x"
    tasks = [
        jobs.submit(name, f"{module}:{name}", about=name, then=then)
        for module, name in (("a", "good"), ("c", "left"), ("d", "bad"))
    ]
    assert [task.state for task in tasks] == [WAITING] * 3

    async def run():
        running = asyncio.create_task(jobs.run())
        for task in tasks:
            await jobs.finished(task)
        await until(lambda: not any(task.open for task in jobs.tasks.values()))
        running.cancel()

    asyncio.run(run())
    assert [task.state for task in tasks] == [DONE, STOPPED, FAILED]
    assert [task.fraction for task in tasks] == [1.0, 0.5, 0.5]
    assert [task.answer for task in tasks] == [7, None, None]
    assert "too thick" in tasks[2].problem
    assert all(task.began <= task.ended for task in tasks)
    (last,) = [task for task in jobs.tasks.values() if task not in tasks]
    assert (last.title, last.about, last.arguments, last.state) == (
        "after it",
        "good",
        ("x",),
        DONE,
    )


@pytest.mark.parametrize("rows", [None, 0.05])
def test_two_soles_are_made_of_equal_land_by_the_width_of_channels_where_one_does(
    tmp_path, monkeypatch, rows
):
    """Land of lugs of 6 mm beside channels w: (6 / (6 + w))^2; ``rows``: only in whole steps."""

    def share(case):
        width = case.value("shoe.tread.channel_width")
        exact = (6e-3 / (6e-3 + width)) ** 2
        return exact if rows is None else rows * round(exact / rows - 0.4) + 0.02 * (width > 4e-3)

    session, paths = session_of(tmp_path), []
    for name, width in (("a", "3 mm"), ("b", "5 mm")):
        new_variant(session, name, shoe="work_shoe_full_tread", contaminant="detergent")
        session.project.change(name, {"shoe.tread.channel_width": width})
        paths.append(str(session.project.path(name)))
    monkeypatch.setattr(work_sole, "_land_share", share)
    if rows:
        with pytest.raises(InputError, match="no channel width near"):
            work_sole.equal_land(*paths, progress=silent)
        return
    changes, words = work_sole.equal_land(*paths, progress=silent)
    assert float(changes["shoe.tread.channel_width"].split()[0]) == pytest.approx(3.0, rel=0.02)
    assert words["land"] != words["had"]
    again, _ = work_sole.equal_land(paths[0], paths[0], progress=silent)
    assert again == {}


@pytest.mark.parametrize("stopped", [False, True])
def test_a_process_tells_how_far_it_is_until_its_answer_is_there_or_it_is_stopped(stopped):
    heard, lane = [], Lane()

    class Job:
        done, fraction = False, 0.0

        def result(self):
            if stopped:
                raise Cancelled("stopped")
            return 7

    class Worker:
        def submit(self, call, function, *args):
            self.asked, self.job = (function, *args), Job()
            return self.job

        def poll(self):
            self.job.fraction += 0.5
            self.job.done = self.job.fraction == 1.0

        def cancel(self):
            self.job.done = True

    lane._worker = worker = cast(Any, Worker())

    async def run():
        asked = asyncio.create_task(
            lane.ask("a:b", 3, heard=lambda job: heard.append(job.fraction))
        )
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        if stopped:
            lane.stop()
        return await asked

    if stopped:
        with pytest.raises(Cancelled):
            asyncio.run(run())
        assert 1.0 not in heard
    else:
        assert asyncio.run(run()) == 7
        assert heard == [0.5, 1.0]
    assert worker.asked == ("a:b", 3)


@pytest.mark.parametrize("had", ["", "sipes", "midsole"])
def test_a_design_offers_sipes_and_a_midsole_where_there_are_none(tmp_path, had):
    session = session_of(tmp_path)
    name = new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    changes = {
        "": {},
        "sipes": design._sipes(session.project.case(name)),
        "midsole": design.MIDSOLE,
    }
    if changes[had]:
        session.project.change(name, changes[had])
    page = next(each for each in PAGES if each.route == "/design")
    words = shown(lambda: page.build(session), words_of)
    for part in ("sipes", "midsole"):
        assert (session.text(f"sole.{part}") in words) is (part != had)


def test_a_trial_is_shown_as_a_part_of_its_folder(monkeypatch):
    made = []

    class Ask:
        async def __call__(self, function, asked, file):
            return {"file": file, "asked": asked}

    page: Any = SimpleNamespace(
        session=SimpleNamespace(ask=Ask()), study=SimpleNamespace(asked="folder", name="walks"),
        _turn=lambda **_: None, place=nullcontext(), overview=1, show=2,
    )  # fmt: skip
    monkeypatch.setattr(trials, "TrialView", lambda *given: made.append(given))
    asyncio.run(trials._Trials.show(page, "walk.csv"))
    view = {"file": "walk.csv", "asked": "folder"}
    assert made == [(page.session, page.study, view, 1, 2)]


@pytest.mark.parametrize(("typed", "read"), [("12", 12), ("", None), ("some", ...)])
def test_a_number_of_a_study_is_read_when_its_field_is_left(tmp_path, typed, read):
    kept = []

    async def keep(*given, part):
        kept.append((*given, part))

    session = session_of(tmp_path)
    page: Any = SimpleNamespace(session=session, text=session.text, keep=keep)

    async def look(elements):
        (field,) = (each for each in elements if isinstance(each, ui.input))
        field.value = typed
        (left,) = (each for each in field._event_listeners.values() if each.type == "blur")
        with field:
            await cast(Any, left.handler)()
        return field.error

    error = shown(lambda: studies._Study._method(page, "budget", (), {"budget": 5}), look)
    assert kept == ([] if read is ... else [("method", {"budget": read}, True)])
    assert bool(error) is (read is ...)


@pytest.mark.parametrize("turned", [False, True])
def test_a_preview_shows_pressures_of_contact_and_film_on_the_sole_as_it_is_turned(
    tmp_path, monkeypatch, turned
):
    session = session_of(tmp_path)
    name = new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    stored = {"cof": {"value": 0.2}, "fluid_load": {"value": 90.0}}
    (tmp_path / "result.json").write_text(json.dumps(stored), encoding="utf-8")
    total, film = np.full((2, 3), 5.0), np.arange(6.0).reshape(2, 3) / 2
    seen = SimpleNamespace(
        sole=SimpleNamespace(joint=None), total_pressure=total, fluid_pressure=film,
        film_thickness=film, cof=SourcedValue(0.25, "1"), cof_draws=None,
        errors={"cof": 0.01, "fluid_load": 2.0}, values={"fluid_load": 80.0},
    )  # fmt: skip
    asked, degrees = [], {"motion.shoe_angle": "17 deg"} if turned else {}

    def rolled(what, turn, *_):
        asked.append(np.degrees(turn))
        return what

    monkeypatch.setattr(work, "preview_of_run", lambda *_, **__: seen)
    monkeypatch.setattr(work, "rolled_sole", rolled)
    monkeypatch.setattr(work, "map_fields", lambda _: xr.Dataset())
    monkeypatch.setattr(work, "designed_surface", lambda *_: "surface")
    monkeypatch.setattr(work, "rolled_surface", rolled)
    monkeypatch.setattr(work, "sole_html", lambda drawn, surface: (drawn, surface))
    path = str(session.project.path(name))
    shown = work.previewed(path, str(tmp_path), degrees, progress=silent)
    (drawn, surface), data = shown["html"], shown["html"][0].data
    assert surface == "surface"
    assert drawn.name == "a"
    assert data["contact_pressure"].values == pytest.approx(total - film)
    assert data["fluid_pressure"].values == pytest.approx(film)
    own = np.degrees(session.project.case(name).value("motion.shoe_angle"))
    assert asked == pytest.approx([17 - own if turned else 0.0] * 2)
    assert (shown["cof"], shown["error"]) == (0.25, 0.01)


@pytest.mark.parametrize("keeps", [True, False])
def test_sliders_of_a_design_keep_what_they_are_moved_to_and_those_of_an_answer_try_it(
    tmp_path, monkeypatch, keeps
):
    session, calls = session_of(tmp_path), []
    name = new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    monkeypatch.setattr(ui, "run_javascript", calls.append)

    def tried():
        page = SimpleNamespace(
            session=session, text=session.text, case=session.project.case(name),
            _moved=None, _rested=None, view=ui.element(),
        )  # fmt: skip
        answer._Answer._live(cast(Any, page))

    shown(partial(design.build, session) if keeps else tried, list)
    (live,) = (call for call in calls if call.startswith("askLive("))
    assert live.endswith(", true)" if keeps else ", false)")


def test_the_bar_of_a_file_that_is_read_begins_empty_and_goes_when_it_is_stopped(
    tmp_path, monkeypatch
):
    session, asked = session_of(tmp_path), []
    name = new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    ended = asyncio.Event()
    session.jobs.reading = cast(Any, SimpleNamespace(stop=ended.set))

    async def ask(function, *args, heard, **_):
        asked.append(heard)
        await ended.wait()
        raise Cancelled("stopped")

    monkeypatch.setattr(session, "ask", ask)
    inspection: Any = None

    def build():
        nonlocal inspection
        page = ui.element()
        inspection = sole_file._Inspection(
            session, name, "soles/a.stl", cast(Any, None), lambda: None, page
        )

    async def look(elements):
        await until(lambda: asked)
        values = [inspection.bar.value]
        asked[0](SimpleNamespace(stage="Faces", fraction=0.25))
        values += [inspection.bar.value, inspection.stage.text, inspection.busy]
        ended.set()
        again = session.text("sole_file.again")
        await until(lambda: again in words_of(elements))
        bars = [each for each in elements if isinstance(each, ui.linear_progress)]
        return values, bars, inspection.busy

    assert shown(build, look) == ([0.0, 0.25, "Faces", True], [], False)


PLACE = {
    "heading": "Shoes of the ward", "headline": ["B slips least"], "cautions": ["One floor"],
    "picture": "data:image/png;base64,", "tables": [], "remarks": {"Assumed": ["dry floors"]},
}  # fmt: skip


@pytest.mark.parametrize("stored", [None, "before", "after"])
def test_a_place_shows_its_answer_where_there_is_one_and_that_its_file_has_changed(
    tmp_path, stored
):
    session = session_of(tmp_path, place="ward")
    file = tmp_path / "places" / "ward.toml"
    file.parent.mkdir(exist_ok=True)
    file.write_text("")
    if stored:
        answered = file.parent / "ward" / "shown.json"
        answered.parent.mkdir()
        answered.write_text(json.dumps(PLACE))
        os.utime(answered, (1e9, 1e9))
        changed = 1e9 + (10 if stored == "before" else -10)
        os.utime(file, (changed, changed))
    lines = shown(partial(place.build, session), words_of)
    text = session.text
    assert (text("place.compute") in lines) is (stored is None)
    assert (text("place.again") in lines) is (stored is not None)
    for line in ("B slips least", "One floor", "dry floors"):
        assert (line in lines) is (stored is not None)
    assert (text("start.changed") in lines) is (stored == "before")


def test_a_section_of_a_study_is_written_as_a_table_or_as_a_value(tmp_path):
    """A part of a section leaves its other keys; a key of None goes."""
    written = 'base = "a.toml"\n[method]\nkind = "sweep"\nbudget = 5\n'

    def kept_as(section, value, **part):
        texts = []

        async def write(text):
            texts.append(text)

        page: Any = SimpleNamespace(written=lambda: written, _write=write)
        asyncio.run(studies._Study.keep(page, section, value, **part))
        return tomllib.loads(texts[0])

    method = {"kind": "sweep", "budget": 5}
    base = {"base": "a.toml", "method": method}
    assert kept_as("base", "b.toml") == base | {"base": "b.toml"}
    assert kept_as("base", ["b.toml"]) == base | {"base": ["b.toml"]}
    part = kept_as("method", {"budget": None, "batch": 3}, part=True)
    assert part["method"] == {"kind": "sweep", "batch": 3}
    speed = {"motion.speed": {"from": "0.3 m/s", "to": "0.7 m/s"}, "shoe.wear.depth": ["1 mm"]}
    assert kept_as("vary", speed) == base | {"vary": speed}
    assert kept_as("method", {"kind": "lhs"})["method"] == {"kind": "lhs"}


def test_an_error_is_told_with_its_place_and_work_that_was_stopped_is_none(tmp_path):
    session = session_of(tmp_path)
    error = InputError("no such floor", where="floor.from", remedy="Take a known one")
    session.tell(error)  # before there is a place for it

    def build():
        session.problems = ui.element()
        session.tell(Cancelled("stopped"))
        session.tell(error)

    told = [each for each in shown(build, words_of) if each]
    assert told == [text for _, text in problem_parts(error)]
    assert [kind for kind, _ in problem_parts(error)] == ["where", "what", "remedy"]


def test_results_of_a_study_are_those_of_its_end_or_of_its_live_page(monkeypatch):
    study = SimpleNamespace(result=lambda: "ready")
    live = SimpleNamespace(cost_table=lambda: "cost", cautions=lambda: ("so far", "more"))
    sheets = {"ready": ["plots", "table", "notes"], "live": ["plots", "so many"]}
    parts = {
        name: [Section(title, intro=f"of {name}") for title in titles]
        for name, titles in sheets.items()
    }
    fakes = {
        "Study": SimpleNamespace(load=lambda *_: study), "shown": lambda result: result,
        "figures": lambda _: {"front": lambda: "figure"}, "png": lambda figure: f"png of {figure}",
        "sections": lambda result, pictures: [parts[result]], "live_study": lambda _: live,
        "live_sections": lambda _: parts["live"],
        "page_part": lambda part: [(each.title, each.intro) for each in part],
    }  # fmt: skip
    for name, fake in fakes.items():
        monkeypatch.setattr(work_studies, name, fake)
    whole: Any = work_studies.results("study.toml", "study", progress=silent)
    assert whole == [
        [("plots", "of ready")], [("table", "of ready"), ("notes", "of ready")],
    ]  # fmt: skip
    running: Any = work_studies.results("study.toml", "study", False, progress=silent)
    assert running == [
        [("Cost", ""), ("plots", "so far of live")], [("so many", "of live")],
    ]  # fmt: skip
