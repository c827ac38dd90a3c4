"""Pages of the app: every element in each state, and what a page tells the browser."""

import asyncio
import dataclasses
import json
import os
import re
from functools import partial
from typing import Any

import pytest
from nicegui import ui

from page_session import MOVING, RUN, answering, computed, pages_shown, press, session_of
from snapshot import held
from underfoot.app import projects
from underfoot.app.components import SoleView, drop_zone, task_line
from underfoot.app.frame import build_framed_page
from underfoot.app.jobs import DONE, FAILED, INTERRUPTED, RUNNING, QueuedTask
from underfoot.app.pages import (
    PAGES,
    answer,
    assumptions,
    compare,
    design,
    measured_file,
    place,
    project,
    repair,
    sole_file,
    start,
    studies,
    trials,
    wear,
)
from underfoot.app.pages.trials_folder import FolderView
from underfoot.app.pages.trials_trial import TrialView
from underfoot.app.project import Project, Summary
from underfoot.app.result_table import ResultTable
from underfoot.app.trials_study import TrialsFolder
from underfoot.app.variant_bar import _rename, new_variant, no_variant, variant_bar
from underfoot.core import InputError

# paths of a case are more where another package brings some
HIDE = MOVING + r"|data-own=\"[^\"]*\"|#hidden|options=\[\d{3}, [^\n]*"


@pytest.fixture
def session(tmp_path):
    """Return a session of a project with two variants; the newer one is "a"."""
    made = session_of(tmp_path)
    new_variant(made, "b", shoe="work_shoe_full_tread")
    new_variant(made, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    for name, time in (("b", 1e9), ("a", 2e9)):
        os.utime(made.project.path(name), (time, time))
    return made


def held_pages(file_regression, session, shown, **options):
    """Hold pages without the folder of the project."""
    folder = str(session.project.folder)

    def plain(text):
        return text.replace(folder, "PROJECT").replace(str(session.project.folder.parent), "HERE")

    told = {
        k: plain(v) if isinstance(v, str) else [plain(one) for one in v] for k, v in shown.items()
    }
    held(file_regression, told, hide=HIDE, **options)


def task(number=1, **parts):
    return QueuedTask(number, f"job {number}", **{"function": RUN, "about": "a", **parts})


def queued(session, *tasks):
    session.jobs.tasks = {each.number: each for each in tasks}


def summary(name="a", **parts):
    made = Summary(name, "converged", 0.3, 0.25, 0.36, 0.1, "hash", "2026")
    return dataclasses.replace(made, **parts)


# frame and start


def test_the_frame(file_regression, monkeypatch, session):
    queued(
        session,
        task(1, state=DONE, about=""),
        task(2, state=RUNNING, fraction=0.456, stage="film"),
        task(3),
        task(4, state=FAILED, problem="too thick"),
        task(5, state=INTERRUPTED),
        task(6, state=RUNNING),
        *(task(k, state=DONE) for k in range(7, 16)),
    )
    session.theme, session.units = "dark", "us"
    broken = dataclasses.replace(PAGES[2], build=lambda _: 1 / 0)

    async def act(places):
        for each in list(places["whole"].descendants()):
            if each.props.get("icon") == "contrast":
                press(each)

    shown = pages_shown(monkeypatch, {"whole": partial(build_framed_page, session, broken)}, act)
    held_pages(file_regression, session, shown)


@pytest.mark.parametrize("language", ["en", "de"])
def test_an_empty_project(file_regression, monkeypatch, tmp_path, language):
    session = session_of(tmp_path, language)
    monkeypatch.setattr(projects, "known_projects", list)
    monkeypatch.setattr(project, "known_projects", list)
    builds = {"start": start.build, "design": design.build, "answer": answer.build,
              "compare": compare.build, "place": place.build, "studies": studies.build,
              "trials": trials.build}  # fmt: skip
    shown = pages_shown(monkeypatch, {k: partial(v, session) for k, v in builds.items()})
    held_pages(file_regression, session, shown)


def test_what_was_worked_on_last(file_regression, monkeypatch, session):
    for name in ("c", "d", "e"):
        new_variant(session, name)
        os.utime(session.project.path(name), (3e9, 3e9 + ord(name)))
    found = {"a": summary(), "b": summary("b", cof=None), "c": summary("c", low=None), "d": None}
    monkeypatch.setattr(Project, "summary", lambda _, name: found.get(name))
    monkeypatch.setattr(Project, "is_current", lambda _, name: name == "a")
    lost = [task(k, state=INTERRUPTED, about=f"v{k}") for k in range(1, 11)]

    def recent(*tasks):
        queued(session, *tasks)
        start._recent(session)

    builds = {"many": partial(recent, *lost), "one": partial(recent, task(1, state=INTERRUPTED)),
              "none": recent}  # fmt: skip
    held_pages(file_regression, session, pages_shown(monkeypatch, builds))


# a variant


def test_the_bar_of_a_variant(file_regression, monkeypatch, session):
    session.project.change("a", {"motion.speed": "0.3 m/s"})
    new_variant(session, "gone")
    session.project.remove("gone")
    builds = {
        "bar": lambda: variant_bar(session, "/design", "a", print),
        "rename": lambda: _rename(session, "/design", "a"),
        "none": lambda: no_variant(session, "/design", print),
    }

    async def act(places):
        for each in list(places["bar"].descendants()):
            if each.props.get("data-step") in ("undo", "redo") or isinstance(each, ui.menu_item):
                press(each)
                await asyncio.sleep(0)

    shown = pages_shown(monkeypatch, builds, act)
    shown["variants"] = sorted(session.project.variants())
    shown["removed"] = session.project.removed_variants()
    held_pages(file_regression, session, shown)


SOLE = {"html": "<i>", "measures": {"length": "90", "width": "60", "land": "50", "lugs": "7"}}


def beyond(first, other):
    """Return the lines of a page that another has not, and how many there are in all."""
    lines = other.splitlines()
    return "\n".join([str(len(lines)), *(one for one in lines if one not in first.splitlines())])


def test_designs_of_variants(file_regression, monkeypatch, session):
    """Of a catalogue's tread; of another with grooves; of a flat sole on a dry floor."""
    new_variant(session, "grooved", shoe="work_shoe_full_tread")
    groove = {"along": "40 mm", "across": "1 mm", "width": "3 mm", "length": "20 mm"}
    more = {"shoe.tread.grooves": [groove], "shoe.wear.depth": "1 mm", "shoe.wear.angle": "7 deg"}
    session.project.change("grooved", more)
    new_variant(session, "dry", shoe="work_shoe_untreaded")
    session.project.change("dry", {"contaminant": "none"} | design.MIDSOLE)
    answering(monkeypatch, session, sole=SOLE)
    monkeypatch.setattr(session.jobs, "warm", lambda: None)

    def build(name):
        design._Design(session, name).show()

    shown = pages_shown(
        monkeypatch, {name: partial(build, name) for name in ("a", "grooved", "dry")}
    )
    told = {name: beyond(shown["a"], shown[name]) for name in ("grooved", "dry")}
    held_pages(file_regression, session, shown | told)


def test_sliders_of_every_pattern(file_regression, monkeypatch, session):
    """Each pattern brings what it needs, and has a slider for each value that it has."""
    monkeypatch.setattr(design.sole_file, "build", lambda *_: None)
    more = {
        "shoe.tread.sipes": {"width": "0.8 mm", "depth": "2 mm", "spacing": "9 mm"},
        "shoe.heel.profile": {"model": "facet", "angle": "7 deg", "length": "20 mm"},
    }
    told: dict[str, Any] = {}

    def build():
        for pattern in design.TreadPattern.options():
            page = design._Design(session, "b")
            page.view = SoleView(session)
            changed = page._pattern_changes(pattern)
            added = more if pattern == "grid" else {}
            try:
                session.project.change("b", changed | added)
            except design.UnderfootError as error:
                told[pattern] = [str(error)]
                continue
            with ui.element("div") as place:
                page._sole(session.project.case("b"))
            (html,) = (e for e in place.descendants() if "sliders" in e.classes)
            found = re.findall(r'name="(\S+)" (min="[^>]*step="[^"]*")', html.content)
            told[pattern] = [changed, *(" ".join(one) for one in found)]
            session.project.undo("b")

    pages_shown(monkeypatch, {"page": build})
    seen = {line.split()[0] for each in told.values() for line in each[1:]}
    assert seen == {each.path for each in design.TREAD}
    held(file_regression, told)


ANSWER: dict[str, Any] = {
    "usable": True, "verdict": "doubtful", "headline": ["In words."], "cof": 0.3014,
    "interval": (0.2501, 0.3604), "slip": 0.1, "slip_interval": (0.04, 0.16),
    "extrapolated": True, "cautions": ["Mind this."], "limit": "The film limits it.",
    "tables": [{"title": "Results", "columns": ["", "X"], "shows": "", "rows": [["COF", "0.3 %"]]},
               {"title": "Lugs", "columns": ["", "way"], "shows": "lug",
                "rows": [["1", "2 mm"], ["2", "3 mm"]]}],
    "remarks": {"Assumed": ["a dry shoe"]}, "advised": [1], "html": "<i>",
}  # fmt: skip
RISK = {
    "cof": {"value": 0.2},
    "slip_probability": {"value": 0.4, "interval": [0.3, 0.5]},
    "changes": [
        {
            "name": "rinse",
            "action": "rinse it",
            "cof": 0.25,
            "slip_probability": 0.35,
            "values": {},
        },
        {
            "name": "dilute",
            "action": "dilute it",
            "cof": None,
            "reason": "no film",
            "slip_probability": None,
        },
        {
            "name": "new",
            "action": "new tread",
            "cof": 0.4,
            "slip_probability": 0.1,
            "slip_interval": [0.001, 0.97],
            "values": {},
        },
        {
            "name": "idle",
            "action": "idle",
            "cof": 0.201,
            "slip_probability": 0.39,
            "does_something": False,
        },
    ],
}


@pytest.mark.parametrize(
    ("name", "current", "given", "state"),
    [("current", True, {}, None), ("earlier", False, {"interval": None, "slip": None}, None),
     ("unusable", True, {"usable": False}, None), ("running", True, {"cautions": []}, RUNNING),
     ("interrupted", False, {"slip": 5e-4, "slip_interval": None}, INTERRUPTED)],
)  # fmt: skip
def test_an_answer(file_regression, monkeypatch, session, name, current, given, state):
    computed(session, "a")
    computed(session, "b")
    session.query = {"variant": "a", "beside": "b"} if name == "current" else {"variant": "a"}
    session.project.known = "b" if name == "current" else "c"
    folder = session.project.result_folder("a")
    if name == "current":
        (folder / "risk.json").write_text(json.dumps(RISK), encoding="utf-8")
        (folder / "report.html").write_text("", encoding="utf-8")
    monkeypatch.setattr(Project, "is_current", lambda *_: current)
    if state:
        queued(session, task(state=state, fraction=0.3, stage="film"))
    answering(monkeypatch, session, answer=ANSWER | given, previewed={})
    shown = pages_shown(monkeypatch, {"page": lambda: answer.build(session)})
    held_pages(file_regression, session, shown)


def test_risks_in_words(file_regression, session):
    page = answer._Answer(session, "a", session.project.case("a"))
    risks = [(p, ends, False) for p in (9.9e-4, 1e-3, 0.1999, 0.2, 0.5, 1.0)
             for ends in (None, (0.9 * p, min(1.1 * p, 1)))]  # fmt: skip
    risks += [(0.45, (0.002, 0.93), True), (0.45, (0.2, 0.9), False)]
    told = [
        page._risk({"slip": p, "slip_interval": ends, "extrapolated": far})
        for p, ends, far in risks
    ]
    told += [page._chance(p, ends) for p, ends, _ in risks]
    told += [page._change(each, RISK) for each in RISK["changes"] if each["cof"]]
    dry = session.project.case("a").replace({"contaminant": "none", "floor.roughness.rq": "3 um"})
    held(file_regression, [told, page._under(), answer.conditions(dry)])


@pytest.mark.parametrize("known", [True, False])
def test_behind_a_preview(file_regression, monkeypatch, session, known):
    """The preview, the full run that replaces it, and a run without a number."""
    page = answer._Answer(session, "a", session.project.case("a"))
    seen = {"cof": 0.25, "error": 0.012, "fluid_load": "90 N", "slip": 0.3 if known else None,
            "slip_interval": (0.2, 0.4), "extrapolated": False, "html": "<b>"}  # fmt: skip
    answering(
        monkeypatch, session, previewed=seen, answer=ANSWER | {"slip": 0.2 if known else None}
    )
    said: list[Any] = []

    def build():
        page.view, page.behind = SoleView(session), ui.element("div")

    async def act(places):
        with places["page"]:
            said.append(await page._preview({"motion.speed": "0.5 m/s"}))
            page._start_tried({"motion.speed": "0.5 m/s", "shoe.wear.depth": "1 mm"})
            ran: Any = page.tried
            said.append([ran.title, ran.about, ran.arguments[2]])
            ran.state, ran.answer = DONE, 0.3 if known else None

    shown = pages_shown(monkeypatch, {"page": build}, act)
    shown["said"] = [json.dumps(one, ensure_ascii=False) for one in said]
    held_pages(file_regression, session, shown)


def test_parts_beside_an_answer(file_regression, monkeypatch, session):
    """Wear, assumptions and measured files: before, while and after they are computed."""
    told = {"headline": ["lasts"], "cautions": ["mind"], "hash": session.project.case("a").hash,
            "tables": [{"title": "T", "columns": ["", "x"], "rows": [["a", "1"]]}]}  # fmt: skip
    folder = session.project.inside("studies", "a, wear")
    folder.mkdir()
    effects = session.project.inside("studies", "b, sensitivity")
    effects.mkdir()
    (effects / "case-hash.txt").write_text(session.project.case("b").hash)
    listed = [
        {
            "path": "shoe.material.shore_a",
            "low": [50, 0.1],
            "high": [70, 0.2],
            "deviation": 0.04,
            "reason": "why",
        },
        {
            "path": "floor.odd_one",
            "low": [1, 0.1],
            "high": [2, 0.2],
            "deviation": None,
            "reason": "r",
        },
        {
            "path": "motion.speed",
            "low": [0.1, 0.1],
            "high": [0.3, 0.2],
            "deviation": 0.01,
            "reason": "",
        },
    ]
    stored = {
        "quantities": {"cof": {"effects": [one for one in listed if "odd" not in one["path"]]}}
    }
    (effects / "sensitivity.json").write_text(json.dumps(stored))

    def worn(*tasks, shown=None):
        queued(session, *tasks)
        (folder / "shown.json").write_text(json.dumps(shown) if shown else "{")
        wear.build(session, "a")

    def assumed(name, *tasks):
        queued(session, *tasks)
        assumptions.build(session, name)

    of = {"function": wear.WORN}
    builds = {
        "wear": worn, "worn": partial(worn, shown=told),
        "wearing": partial(worn, task(state=RUNNING, **of)),
        "not worn": partial(worn, task(state=FAILED, problem="too thin", **of)),
        "interrupted": partial(worn, task(state=INTERRUPTED, **of)),
        "assumed": partial(assumed, "a"), "effects": partial(assumed, "b"),
        "computing": partial(assumed, "a", task(state=RUNNING, function=assumptions.EFFECTS)),
        "files": lambda: [measured_file.build(session, "a", part, print) for part in
                          ("sole", "floor", "motion")],
    }  # fmt: skip
    shown = pages_shown(monkeypatch, builds)
    told = {name: beyond(shown["assumed"], shown[name]) for name in ("effects", "computing")}
    held_pages(file_regression, session, shown | told)


def test_a_variant_that_can_not_be_read(file_regression, monkeypatch, session):
    soles = session.project.inside("soles")
    for name in ("one.stl", "two.stl", "same.stl", "x.ply"):
        (soles / name).write_text(name)
    digest = repair.checksum(soles / "same.stl")
    texts = {
        "lost": 'file = "../soles/lost.stl"',
        "changed": f'file = "../soles/one.stl"\nsha256 = "{digest}"',
        "odd": "x = ",
    }
    for name, text in texts.items():
        session.project._set(name, f"[shoe.outsole]\n{text}\n")
    builds = {name: partial(repair.open_variant, session, "/design", name) for name in texts}
    held_pages(file_regression, session, pages_shown(monkeypatch, builds))


# soles from files


def test_the_sole_of_a_file(file_regression, monkeypatch, session):
    for name in ("heel.stl", "heel, revision 2.stl", "B.step", "notes.txt"):
        session.project.inside("soles", name).write_text(name)
    text = session.project.text("b").replace(
        "[shoe]", '[shoe.outsole]\nfile = "../soles/heel.stl"\n[shoe]'
    )
    session.project.path("b").write_text(text)
    read = {
        "html": "<i>",
        "headline": ["90 x 60 mm."],
        "shoe": {"from": "x"},
        "remarks": {"Read": ["a line"]},
        "tables": [{"title": "Tread", "columns": ["", ""], "rows": [["Land", "50 %"]]}],
    }
    answering(monkeypatch, session, inspected_sole=read)
    monkeypatch.setattr(session.jobs, "reading", session.jobs.live)

    def build():
        view = SoleView(session)
        sole_file.build(session, "a", view, print)
        sole_file._Inspection(
            session, "a", "soles/heel, revision 2.stl", view, print, ui.element("div")
        )

    held_pages(file_regression, session, pages_shown(monkeypatch, {"page": build}))


def test_a_file_that_is_not_read(file_regression, monkeypatch, session):
    answering(monkeypatch, session, inspected_sole=sole_file.Cancelled("stopped"))

    def build(stop):
        view = SoleView(session)
        made = sole_file._Inspection(session, "a", "soles/x.stl", view, print, ui.element("div"))
        assert made.busy is True
        if stop:
            made._choice("unit", ("auto", "mm"))

    held_pages(file_regression, session, pages_shown(monkeypatch, {"page": partial(build, True)}))


# several variants


COMPARED: dict[str, Any] = {
    "headline": ["b is better.", "By 5 %."], "cautions": ["mind"], "open": True, "html": "<i>",
    "letters": ["A", "B"], "chances": [["", "25 %"], ["75 %", ""]],
    "tables": [{"title": "Inputs", "columns": ["", "A", "B"], "shows": "",
                "rows": [["motion.speed", "1", "2"], ["other", "3", "4"]]}],
}  # fmt: skip
ROWS = {
    "inputs": [("motion.speed", "m/s"), *((f"x.i{k}", "1") for k in range(7))],
    "rows": [
        {"name": "a", "state": "current", "verdict": "grips", "remark": "", "cof": 0.3},
        {"name": "b", "state": "unusable", "verdict": "", "remark": "not converged"},
        {"name": "c", "state": "not_computed", "verdict": "", "remark": ""},
    ],
}


def test_results_side_by_side(file_regression, monkeypatch, session):
    for name in ("a", "b"):
        computed(session, name)
    monkeypatch.setattr(Project, "is_current", lambda _, name: name == "a")
    answering(monkeypatch, session, comparison=COMPARED, rows=ROWS, exported="said",
              written="file.csv")  # fmt: skip

    async def act(places):
        for each in list(places["page"].descendants()):
            if isinstance(each, ui.button) and each.props.get("icon") != "balance":
                press(each)

    shown = pages_shown(monkeypatch, {"page": lambda: compare.build(session)}, act)
    held_pages(file_regression, session, shown)


@pytest.mark.parametrize("state", ["none", RUNNING, FAILED, DONE])
def test_two_of_equal_land(file_regression, monkeypatch, session, state):
    """Equal already; a variant that is computed, that fails, that is done and then compared."""
    for name in ("a", "b"):
        computed(session, name)
    monkeypatch.setattr(Project, "is_current", lambda *_: True)
    words = {"before": "2 mm", "land": "50 %", "had": "60 %", "after": "3 mm"}
    changes = {} if state == "none" else {"shoe.tread.channel_width": "3 mm"}
    answering(monkeypatch, session, comparison=COMPARED | {"open": False, "tables": []}, rows=ROWS,
              equal_land=(changes, words))  # fmt: skip

    async def act(places):
        for each in list(places["page"].descendants()):
            if each.props.get("icon") == "balance":
                press(each)
        await asyncio.sleep(0.05)
        for each in session.jobs.tasks.values():
            each.state = state
            if state == DONE:
                computed(session, each.about)

    shown = pages_shown(monkeypatch, {"page": lambda: compare.build(session)}, act)
    shown["page"] = "\n".join(
        line
        for line in shown["page"].splitlines()
        if "Select" in line or "task" in line or " | " in line
    )
    held_pages(file_regression, session, shown)


def test_the_table_of_a_project(file_regression, monkeypatch, session):
    new_variant(session, "C")
    others = [session.project.folder, session.project.folder.parent / "other"]
    monkeypatch.setattr(project, "known_projects", lambda: others)
    monkeypatch.setattr(project.time, "strftime", lambda _: "today")
    answering(monkeypatch, session, rows=ROWS, written="file.csv")
    queued(
        session,
        task(1, state=RUNNING, fraction=0.5),
        task(2, about="b"),
        task(3, about="c", state=FAILED, problem="too thick"),
        task(4, about="d", state=DONE),
    )

    async def act(places):
        for each in list(places["page"].descendants()):
            if isinstance(each, ui.button) and each.props.get("icon") in ("table_view", "print"):
                press(each)

    shown = pages_shown(monkeypatch, {"page": lambda: project.build(session)}, act)
    held_pages(file_regression, session, shown)


def test_a_table_with_few_inputs(file_regression, monkeypatch, session):
    few = {"inputs": ROWS["inputs"][:2], "rows": ROWS["rows"]}
    answering(monkeypatch, session, rows=few)

    def build(lettered):
        made = ResultTable(session, "t", lambda: [("a", "x", "y")], lettered=lettered)
        ui.timer(0, partial(made.show, {"b": "waits"}), once=True)

    shown = pages_shown(monkeypatch, {str(one): partial(build, one) for one in (True, False)})
    held_pages(file_regression, session, shown)


# places, studies


def test_places(file_regression, monkeypatch, session):
    folder = session.project.inside("places")
    (folder / "shop").mkdir(parents=True)
    for name in ("shop", "new"):
        (folder / f"{name}.toml").write_text("")
        os.utime(folder / f"{name}.toml", (1e9, 1e9))
    shown = {"heading": "Shoe of a shop", "headline": ["one"], "cautions": ["two"],
             "picture": "data:image/png;base64,AAAA", "remarks": {"Assumed": ["x"]},
             "tables": [{"title": "T", "columns": ["", "x"], "rows": [["a", "1"]]}]}  # fmt: skip
    (folder / "shop" / "shown.json").write_text(json.dumps(shown))

    def build(name, **more):
        queued(session, *more.get("tasks", ()))
        session.query = {"place": name}
        place.build(session)
        if more.get("old"):
            os.utime(folder / "shop.toml", None)
            os.utime(folder / "shop" / "shown.json", (1e9, 1e9))

    lost = task(state=INTERRUPTED, about="new", function=place.WORK)
    builds = {"shop": partial(build, "shop"), "new": partial(build, "new", tasks=[lost], old=True),
              "changed": partial(build, "shop"), "none": partial(build, "gone")}  # fmt: skip
    held_pages(file_regression, session, pages_shown(monkeypatch, builds))


SHEET: dict[str, Any] = {
    "headline": ["40 cases."], "cautions": ["mind"], "remarks": {"Lost": ["1", "2", "3", "4"]},
    "ended": 0, "begun": False, "open": True,
}  # fmt: skip
FORM = {
    "base": "../variants/a.toml",
    "vary": {"shoe.tread.depth": {"from": "1 mm", "to": "2 mm"}, "odd": {"a": 1},
             "shoe.tread.pattern": ["grid", "bars"]},
    "uncertain": {"motion.speed": {"normal": "1 m/s", "sd": "0.1 m/s"}},
    "conditions": {"wear": ["new"]}, "outputs": {"maximise": ["cof"], "require": "land > 0.4"},
    "method": {"kind": "optimise", "budget": 40, "front_grid": "quick"},
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "sheet", "form"),
    [("new", SHEET, FORM), ("wrong", InputError("no base", where="base", allowed="one"), FORM),
     ("done", SHEET | {"begun": True, "open": False, "working": 0, "budget": 8, "ended": 8}, {}),
     ("working", SHEET | {"begun": True, "working": 2, "budget": 41, "ended": 3}, {}),
     ("unread", SHEET, InputError("odd"))],
)  # fmt: skip
def test_a_study(file_regression, monkeypatch, session, name, sheet, form):
    file = session.project.inside("studies", "s.toml")
    file.write_text("file_version = 1\n")
    session.query = {"study": "s"}
    answering(monkeypatch, session, form=form, state=sheet, results=["plots", "rest"])
    shown = pages_shown(monkeypatch, {"page": lambda: studies.build(session)})
    held_pages(file_regression, session, shown)


def test_studies_of_a_project(file_regression, monkeypatch, session):
    for name in ("s", "B b", "_no"):
        session.project.inside("studies", f"{name}.toml").write_text("")
    went: list[Any] = []
    monkeypatch.setattr(session, "go", lambda route, **query: went.append((route, query)))
    for _ in range(2):
        studies.example(session)
    shown = pages_shown(monkeypatch, {"page": lambda: studies.build(session)})
    shown["went"] = [str(one) for one in went]
    shown["file"] = session.project.inside("studies", f"{went[0][1]['study']}.toml").read_text()
    held_pages(file_regression, session, shown)


# trials


STEP = {
    "number": 2, "side": "left", "rcof": 0.21, "rcof_uncertainty": 0.013, "verdict": "accepted",
    "contact": 1.0, "plate": "P1", "by_hand": [], "item": "step 2", "cautions": ["near the rim"],
    "peak_slipping_speed": None, "outcome": "", "slip_distance": None, "reason": "",
}  # fmt: skip
SLIP = STEP | {"number": 1, "contact": 0.95, "rcof": None, "verdict": "caution", "item": "step 1",
               "side": "unknown", "peak_slipping_speed": 0.5, "outcome": "slip",
               "slip_distance": 0.1234}  # fmt: skip
EDIT = {"step": "step 2", "what": "side", "before": "left", "after": "right", "why": "seen so",
        "quantity": "rcof", "number_before": 0.2, "number_after": None}  # fmt: skip
VIEW: dict[str, Any] = {
    "file": "b.csv", "verdict": "accepted", "numbers": ["RCOF 0.21"], "conditions": {"shoe": "A"},
    "reasons": ["a reason"], "steps": [STEP, SLIP], "edits": [], "kind": "walking", "run": 1,
    "whole": {"bands": []}, "chosen": 2, "plot": {"panels": []},
}  # fmt: skip
CARD = {"file": "b.csv", "verdict": "accepted", "svg": "<svg/>", "numbers": ["1", "2", "3"],
        "noted": "shoe A", "edits": 0, "reasons": ["why"], "conditions": {}}  # fmt: skip
FOLDER = {
    "cards": [CARD, CARD | {"file": "c.csv", "verdict": "refused", "edits": 2, "svg": ""}],
    "lead": "2 files.", "notes": ["a note"], "counts": {"accepted": 1, "refused": 1},
    "summary": {"title": "Summary", "columns": ["", "n"], "rows": [["A", "1"]], "below": ["p = 1"],
                "notes": ["n"], "cautions": ["c"]},
    "findings": [{"title": f"F{k}", "columns": ["", "n"], "rows": [["A", "1"], ["B", "2"]],
                  "below": ["", ""], "notes": []} for k in (1, 2)],
    "study": [],
}  # fmt: skip


@pytest.fixture
def study(session):
    session.project.inside("trials", "walks").mkdir(parents=True)
    session.project.inside("trials", ".hidden").mkdir()
    made = TrialsFolder(session.project, "walks")
    made.files = ["a.csv", "b.csv", "c.csv"]
    return made


async def nothing(*_):
    """Stand for what leads elsewhere."""


def test_trials(file_regression, monkeypatch, session, study):
    edited = VIEW | {
        "edits": [EDIT, EDIT | {"quantity": "peak", "number_after": 0.3, "why": "a slip"}]
    }
    views = {
        "plain": VIEW,
        "slip": edited | {"chosen": 1, "file": "a.csv"},
        "by hand": VIEW
        | {"steps": [STEP | {"by_hand": ["exclude"], "rcof": None, "reason": "no load"}]},
        "run": VIEW
        | {"steps": [], "chosen": None, "whole": None, "kind": "slide", "file": "c.csv"},
        "readings": VIEW
        | {"steps": [], "chosen": None, "whole": None, "plot": None, "kind": "readings"},
    }

    def build(view, pending=None):
        made = TrialView(session, study, view, print, nothing)
        if pending:
            made.pending = {"step": 2, "what": "side"}
            made._fill(edited)

    builds: dict[str, Any] = {name: partial(build, view) for name, view in views.items()}
    builds["pending"] = partial(build, edited, True)
    held_pages(file_regression, session, pages_shown(monkeypatch, builds))


def test_a_folder_of_trials(file_regression, monkeypatch, session, study):
    many = FOLDER | {"cards": [CARD | {"file": f"{k}.csv"} for k in range(63)], "summary": None,
                     "findings": [], "counts": {"accepted": 63}}  # fmt: skip
    given = iter([FOLDER, many, InputError("nothing there", where="trials")])

    def view(*_):
        found = next(given)
        if isinstance(found, Exception):
            raise found
        return found

    answering(monkeypatch, session, protocols={"level_walking": "Level walking"}, folder_view=view,
              trial_view=VIEW)  # fmt: skip
    study.keep({"names": "{who}_{n}", "merge_spelling": True})
    builds = {name: lambda: FolderView(session, study, print, nothing) for name in "abc"}
    shown = pages_shown(monkeypatch, builds)
    shown["command"], shown["asked"] = study.command, json.dumps(study.asked)
    held_pages(file_regression, session, shown)


def test_folders_of_trials(file_regression, monkeypatch, session, study):
    answering(monkeypatch, session, trial_view=VIEW, folder_view=FOLDER, protocols={})
    builds = {}
    for name, query in (("all", {}), ("trial", {"study": "walks", "trial": "b.csv"}),
                        ("folder", {"study": "walks"})):  # fmt: skip

        def build(asked=query):
            session.query = asked
            trials.build(session)

        builds[name] = build
    held_pages(file_regression, session, pages_shown(monkeypatch, builds))


# parts


def test_places_for_files_and_lines_of_tasks(file_regression, monkeypatch, session):
    async def done(_):
        ui.label("done")

    def line(**parts):
        each = task(**parts)
        queued(session, each)
        task_line(session, each, done)

    builds = {
        "drop": lambda: drop_zone(session, "soles", nothing, label="Drop"),
        "drop many": lambda: drop_zone(
            session, "trials", nothing, label="D", accept=".a", multiple=True
        ),
        "running": partial(line, state=RUNNING, fraction=0.3, stage="film"),
        "waiting": line,
        "failed": partial(line, state=FAILED),
    }
    held_pages(file_regression, session, pages_shown(monkeypatch, builds))
