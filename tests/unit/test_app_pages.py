"""Pages of the app in this process, without browser or server, and the queue behind them."""

import asyncio
import json
import os
import re
import tomllib
from contextlib import nullcontext
from functools import partial
from itertools import pairwise
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import xarray as xr
from nicegui import ui

from page_session import RUN, computed, keydown, session_of, shown, until, words_of
from underfoot.app import trials_plots, work, work_sole, work_studies
from underfoot.app.frame import MOST_SHOWN, _jobs_button
from underfoot.app.jobs import (
    DONE,
    FAILED,
    INTERRUPTED,
    RUNNING,
    STOPPED,
    WAITING,
    JobQueue,
    Lane,
    QueuedTask,
)
from underfoot.app.pages import (
    PAGES,
    answer,
    design,
    measured_file,
    place,
    repair,
    sole_file,
    studies,
    trials,
)
from underfoot.app.pages.trials_trial import TrialView
from underfoot.app.project import Project
from underfoot.app.session import Session, problem_parts
from underfoot.app.text import LANGUAGES
from underfoot.app.trials_study import STANDARD, TrialsFolder
from underfoot.app.variant_bar import _rename, new_variant
from underfoot.core import SourcedValue, silent
from underfoot.core.errors import Cancelled, InputError
from underfoot.core.page import PageSection
from underfoot.trials.study.file_result import StepResult
from underfoot.trials.study.record_signals import Envelope

HEADINGS = {f"h{level}" for level in range(1, 7)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.route)
def test_every_page_opens_with_a_heading_with_and_without_a_variant(tmp_path, caplog, page):
    for variants, language in enumerate(LANGUAGES):
        session = session_of(tmp_path, language)
        if variants:
            new_variant(session, "shoe", shoe="work_shoe_half_tread", contaminant="detergent")

        def heads(elements):
            heard = [kind.type for each in elements for kind in each._event_listeners.values()]
            assert all(isinstance(each, str) for each in heard)
            return [int(each.tag[1]) for each in elements if each.tag in HEADINGS]

        # a page of one variant asks for one where there is none
        asks = not variants and page.route in ("/design", "/answer")
        levels = shown(partial(page.build, session), heads)
        assert bool(levels) is not asks
        # no level is left out, for who walks through a page by its headings
        assert all(to <= above + 1 for above, to in pairwise([0, *levels]))
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
    task = None if state is None else QueuedTask(1, "help", state=state)

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
    study = TrialsFolder(project, "walks")
    assert study.keep(STANDARD) is False
    assert study.keep({"names": "a"}) is True
    assert study.keep({"names": "a"}) is False
    assert TrialsFolder(project, "walks").settings == {**STANDARD, "names": "a"}


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

    jobs: Any = JobQueue(folder)
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
            await jobs.wait_for(task)
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
            _preview=None, _start_tried=None, view=ui.element(),
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

        page: Any = SimpleNamespace(study_text=lambda: written, _write=write)
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
        name: [PageSection(title, intro=f"of {name}") for title in titles]
        for name, titles in sheets.items()
    }
    fakes = {
        "Study": SimpleNamespace(load=lambda *_: study), "shown_study": lambda result: result,
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


def test_looks_at_a_study_are_put_off_by_their_own_work_not_by_their_waiting(monkeypatch):
    clock, shows = [100.0], []
    looks = iter([(0.4, 1), (0.4, 2), (0.4, 2)])  # processor time, cases that ended

    async def check(seen):
        clock[0] += 3.0  # the study's workers have the processors
        seconds, ended = next(looks)
        return {"ended": ended, "seconds": seconds} | ({"parts": ended} if ended != seen else {})

    page: Any = SimpleNamespace(
        run_button=SimpleNamespace(set_enabled=lambda _: None), sheet={"ended": 0}, _working=2,
        _check=check, _put=shows.append,
    )  # fmt: skip
    monkeypatch.setattr(studies, "time", SimpleNamespace(monotonic=lambda: clock[0]))
    made: list[Any] = []

    def timer(interval, look):
        made.append(SimpleNamespace(interval=interval, look=look))
        return made[-1]

    monkeypatch.setattr(studies.ui, "timer", timer)
    watch = studies._Study._watch(page)
    intervals = []
    for _ in range(3):
        asyncio.run(made[0].look())
        intervals.append(watch.interval)
        clock[0] += 4.0
    # of 3, 10 and 17 s that have gone looks took 0.4, 0.8 and 1.2 s: 5 % of 8, 16 and 24 s
    assert intervals == pytest.approx([5.0, 6.0, 7.0])
    assert shows == [1, 2]


@pytest.mark.parametrize(
    ("route", "results"),
    [("/", True), ("/project", True), ("/answer", True), ("/compare", True), ("/design", False)],
)
def test_a_page_follows_the_files_of_its_variants_and_their_results_where_it_shows_any(
    tmp_path, monkeypatch, route, results
):
    session, followed = session_of(tmp_path, variant="a"), []
    for name in "abc":
        new_variant(session, name, shoe="work_shoe_half_tread", contaminant="detergent")
        if route == "/compare" and name != "c":
            computed(session, name)
    monkeypatch.setattr(
        Session, "follow", lambda _, state, *given, **more: followed.append(state) or (lambda: None)
    )
    (page,) = (each for each in PAGES if each.route == route)

    async def look(_):
        await until(lambda: followed)

    shown(partial(page.build, session), look)
    (state,) = followed
    seen = [state()]
    if results and route != "/compare":
        computed(session, "a")
        seen.append(state())
    session.project.change("a", {"motion.speed": "0.31 m/s"})
    seen.append(state())
    assert all(before != after for before, after in pairwise(seen))
    if not results:
        computed(session, "a")
        assert state() == seen[-1]


def test_a_variant_that_can_not_be_read_is_looked_at_again_when_its_file_changed(
    tmp_path, monkeypatch
):
    session, followed, went = session_of(tmp_path), [], []
    name = new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    path = session.project.path(name)
    whole = path.read_text("utf-8")
    path.write_text("no case", encoding="utf-8")
    monkeypatch.setattr(Session, "follow", lambda _, *given: followed.append(given))
    monkeypatch.setattr(Session, "go", lambda _, route, **query: went.append((route, query)))
    found: Any = []
    shown(lambda: found.append(repair.open_variant(session, "/design", name)), words_of)
    state, again = followed[-1]
    assert found == [None]
    before = state()
    computed(session, name)
    assert session.project.summary(name) is not None
    assert state() == before
    path.write_text(whole, encoding="utf-8")
    assert state() != before
    again()
    assert went == [("/design", {"variant": name})]


@pytest.mark.parametrize(
    ("about", "function", "state", "free"),
    [("a", RUN, WAITING, False), ("a", RUN, RUNNING, False), ("a", RUN, FAILED, True),
     ("b", RUN, RUNNING, True), ("a", "other:one", RUNNING, True)],
)  # fmt: skip
def test_an_answer_is_computed_once_at_a_time(tmp_path, about, function, state, free):
    session = session_of(tmp_path)
    for name in "ab":
        new_variant(session, name, shoe="work_shoe_half_tread", contaminant="detergent")
    task = session.submit("run", function, about=about)
    task.state = state

    def look(elements):
        (run,) = (each for each in elements if "main-action" in each.classes)
        return run.enabled

    page = answer._Answer(session, "a", session.project.case("a"))
    assert shown(page.show, look) is free


@pytest.mark.parametrize("count", [0, 1, MOST_SHOWN, MOST_SHOWN + 3])
def test_jobs_that_compute_come_first_and_of_many_the_rest_is_counted(tmp_path, count):
    session = session_of(tmp_path)
    tasks = [session.submit(f"job {k}", RUN, about="") for k in range(count)]
    if tasks:
        tasks[-1].state = RUNNING
    words = shown(lambda: _jobs_button(session), words_of)
    listed = [word for word in words if word.startswith("job ")]
    order = [tasks[-1], *tasks[:-1]] if tasks else []
    assert listed == [task.title for task in order[:MOST_SHOWN]]
    more = session.text("jobs.more", count=count - MOST_SHOWN)
    assert (more in words) is (count > MOST_SHOWN)
    assert (session.text("jobs.empty") in words) is (count == 0)
    assert (session.text("jobs.stop_all") in words) is (count > 1)


@pytest.mark.parametrize(("others", "working"), [(False, 2), (False, 0), (True, 2), (True, 0)])
def test_a_study_is_watched_until_the_others_that_work_on_it_have_ended(
    monkeypatch, others, working
):
    """One that this page began is shown at its end by what follows the job."""
    enabled, timers, done = [], [], []

    async def check(seen):
        return {"ended": 5, "seconds": 0.0, "parts": ["so far"]}

    async def show():
        done.append("whole")

    page: Any = SimpleNamespace(
        run_button=SimpleNamespace(set_enabled=enabled.append), sheet={"ended": 0},
        _working=working, _check=check, _put=done.extend, _show=show,
    )  # fmt: skip

    def timer(interval, look):
        timers.append(look)
        return SimpleNamespace(interval=interval, deactivate=lambda: done.append("stopped"))

    monkeypatch.setattr(studies.ui, "timer", timer)
    studies._Study._watch(page, others=others)
    asyncio.run(timers[0]())
    ended = others and not working
    assert done == (["stopped", "whole"] if ended else ["so far"])
    assert enabled == [False, ended]


def test_a_variant_has_the_name_that_is_typed_when_enter_is_pressed(tmp_path, monkeypatch):
    session, went = session_of(tmp_path), []
    new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    monkeypatch.setattr(Session, "go", lambda _, route, **query: went.append((route, query)))

    def look(elements):
        (field,) = (each for each in elements if isinstance(each, ui.input))
        field.value = " b "
        keydown(field, "enter")()

    shown(lambda: _rename(session, "/design", "a"), look)
    assert session.project.variants() == ["b"]
    assert went == [("/design", {"variant": "b"})]


@pytest.mark.parametrize(
    ("typed", "read"),
    [({"from": "0.3 m/s", "to": "0.7 m/s"}, {"from": "0.3 m/s", "to": "0.7 m/s"}),
     ({"from": "0.2 m/s"}, {"from": "0.2 m/s", "to": "0.5 m/s"}),
     ({"values": "0.2 m/s; 0.3 m/s"}, ["0.2 m/s", "0.3 m/s"]),
     ({"from": "fast"}, {"from": "0.4 m/s", "to": "0.5 m/s"}),
     ({"to": ""}, None)],
)  # fmt: skip
def test_a_row_of_a_study_says_its_path_and_what_is_typed_or_the_last_that_could_be_read(
    tmp_path, typed, read
):
    """An end that says nothing leaves the row out; what can't be read leaves the file as it is."""
    session, given = session_of(tmp_path), {"from": "0.4 m/s", "to": "0.5 m/s"}
    kept: list[Any] = []

    async def keep(section, value):
        kept.append((section, value))

    page: Any = SimpleNamespace(
        session=session, text=session.text, keep=keep, _heading=lambda _: None
    )
    rows: list[studies._Rows] = []

    def build():
        rows.append(studies._Rows(page, "vary", {"motion.speed": given}))

    async def look(elements):
        fields = {each.props["label"]: each for each in elements if isinstance(each, ui.input)}
        for key, text in typed.items():
            fields[session.text(f"studies.field_{key}")].value = text
        first = next(iter(fields.values()))
        assert rows[0].rows[0]() == ("motion.speed", read)
        await keydown(first, "enter")()

    shown(build, look)
    assert kept == [("vary", {} if read is None else {"motion.speed": read})]
