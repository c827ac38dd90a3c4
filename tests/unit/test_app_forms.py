"""Forms of the app: what a typed or moved value becomes, what a sole's file changes."""

import asyncio
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import numpy as np
import pytest
from nicegui import ui

from page_session import button, computed, press, session_of, shown, until, words_of
from underfoot.app import inputs, serve, work
from underfoot.app.inputs import (
    Input,
    Slider,
    changes,
    number_field,
    read_in_unit,
    sliders,
)
from underfoot.app.jobs import DONE, FAILED, INTERRUPTED, RUNNING
from underfoot.app.pages import assumptions, design, place, sole_file, start
from underfoot.app.pages.project import _others, _state_text
from underfoot.app.project import Project
from underfoot.app.session import Exchange
from underfoot.app.variant_bar import new_variant, no_variant, variant_bar
from underfoot.core import InputError, silent

SPEED = Slider("motion.speed", "m/s", 0.05, 1.5, 0.01)
VISCOSITY = Slider("contaminant.viscosity", "cP", 0.5, 1000.0, 1.0, log=True)
DEPTH = Slider("shoe.tread.depth", "mm", 0.5, 8.0, 0.1)
HARDNESS = Slider("shoe.material.shore_a", "", 45.0, 85.0, 1.0)


@pytest.fixture
def session(tmp_path):
    made = session_of(tmp_path)
    new_variant(made, "a", shoe="work_shoe_full_tread", contaminant="detergent")
    made.project.change("a", {"motion.speed": "0.4 m/s", "contaminant.viscosity": "100 cP"})
    return made


def answering(monkeypatch, session, **answers):
    asked = []

    async def ask(function, *args, **options):
        asked.append((function.partition(":")[2], *args))
        return answers[function.partition(":")[2]]

    monkeypatch.setattr(session, "ask", ask)
    return asked


# values


@pytest.mark.parametrize(
    ("each", "typed", "units", "written"),
    [(SPEED, "0.5", "si", "0.5 m/s"), (SPEED, "50 cm/s", "si", "50 cm/s"),
     (SPEED, "2", "us", "2 ft/s"), (DEPTH, "0.1", "us", "0.1 in"), (DEPTH, "3", "si", "3 mm"),
     (HARDNESS, "62", "si", 62.0), (VISCOSITY, "3", "us", "3 cP")],
)  # fmt: skip
def test_what_is_typed_stands_in_the_unit_that_is_shown(each, typed, units, written):
    assert each.read_typed(typed, units, comma=False) == written
    for wrong in ("fast", "3 kg"):
        with pytest.raises(InputError):
            each.read_typed(wrong, units, comma=False)


def test_sliders_are_written_in_the_unit_of_the_case_and_read_from_it(session):
    case = session.project.case("a")
    assert SPEED.value_in(case) == pytest.approx(0.4)
    assert VISCOSITY.value_in(case) == pytest.approx(100)
    assert HARDNESS.value_in(case) == pytest.approx(case.value("shoe.material.shore_a"))
    assert Input("shoe.sole.midsole.thickness", "mm").value_in(case) is None
    moved = {"motion.speed": "0.55", "shoe.material.shore_a": 61, "unknown": 3}
    assert changes([SPEED, HARDNESS], moved) == {
        "motion.speed": "0.55 m/s", "shoe.material.shore_a": 61.0,
    }  # fmt: skip
    assert SPEED.shown_in("si") == (1.0, "m/s")
    assert SPEED.shown_in("us") == (0.3048, "ft/s")
    assert Input("x", "deg").shown_in("us") == (1.0, "°")
    assert read_in_unit("2 in", "mm", comma=False) == pytest.approx(50.8)
    assert read_in_unit("2,5", "mm", comma=True) == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("typed", "error", "value"),
    [("3", False, 3), ("0", True, 0), ("2.5", True, 0), ("1", False, 1)],
)
def test_a_count_is_a_whole_number_from_1_on(typed, error, value):
    if error:
        with pytest.raises(InputError):
            inputs.whole_number(typed, comma=False)
    else:
        assert inputs.whole_number(typed, comma=False) == value


def attributes(text):
    import re

    return [dict(re.findall(r'([\w-]+)="([^"]*)"', each)) for each in
            re.findall(r"<input [^>]*>", text)]  # fmt: skip


def test_a_slider_stands_where_the_case_does_and_asks_what_its_page_does(session, monkeypatch):
    case, sent = session.project.case("a"), []
    moved, rested = [], []
    monkeypatch.setattr(ui, "run_javascript", sent.append)

    async def moving(given):
        moved.append(given)
        return {"texts": {}}

    none = Slider("shoe.sole.midsole.thickness", "mm", 1.0, 20.0, 1.0)
    fast = Slider("motion.speed", "m/s", 0.05, 0.3, 0.01)
    given = (fast, VISCOSITY, none)

    def build():
        sliders(session, given, case, moving, rested.append, ui.element(), keep=False)

    async def look(elements):
        (html,) = (each for each in elements if isinstance(each, ui.html))
        (handler,) = session.exchange.handlers.values()
        values = {"motion.speed": "0.2"}
        assert await handler({"values": values, "last": False}) == {"texts": {}}
        assert await handler({"values": values, "last": True}) == {}
        return html.content

    text = shown(build, look)
    speed, viscosity = attributes(text)
    assert (speed["min"], speed["max"], speed["value"]) == ("0.05", "0.4", "0.4")
    assert "data-log" not in speed
    low, high = (float(viscosity[key]) for key in ("min", "max"))
    assert (low, high) == pytest.approx((np.log10(0.5), 3), abs=1e-5)
    assert float(viscosity["value"]) == pytest.approx(2)
    assert viscosity["data-log"] == "1"
    assert float(viscosity["data-given"]) == pytest.approx(100)
    assert moved == rested == [{"motion.speed": "0.2 m/s"}]


@pytest.mark.parametrize(
    ("typed", "change", "error"),
    [("0.5", {"motion.speed": "0.5 m/s"}, False), ("0.4", None, False),
     ("", {"motion.speed": None}, False), ("fast", None, True)],
)  # fmt: skip
def test_a_field_changes_the_file_where_something_else_was_typed(session, typed, change, error):
    case, given = session.project.case("a"), []

    def look(elements):
        (field,) = (each for each in elements if isinstance(each, ui.input))
        assert field.value == "0.4"
        assert field.props["suffix"] == "m/s"
        field.value = typed
        press(field, "change")
        return bool(field.error)

    failed = shown(lambda: number_field(session, SPEED, case, given.append), look)
    assert failed is error
    assert given == ([] if change is None else [change])


def test_an_empty_field_of_the_catalogue_shows_its_value_again(session):
    case, given = session.project.case("a"), []
    force = Input("motion.normal_force", "N")

    def look(elements):
        (field,) = (each for each in elements if isinstance(each, ui.input))
        before = field.value
        field.value = ""
        press(field, "change")
        return before, field.value

    before, after = shown(lambda: number_field(session, force, case, given.append), look)
    assert before == after != ""
    assert given == []
    layer = Input("shoe.sole.midsole.thickness", "mm")
    assert shown(lambda: number_field(session, layer, case, given.append), list) is not None
    fields = shown(lambda: number_field(session, layer, case, given.append), lambda e: [
        each for each in e if isinstance(each, ui.input)])  # fmt: skip
    assert fields == []


# the page of a design


def test_a_design_keeps_what_is_chosen_and_a_new_pattern_brings_what_it_needs(session, monkeypatch):
    monkeypatch.setattr(session, "go", lambda *_, **__: None)
    made: Any = design._Design(session, "a")
    case = session.project.case("a")
    patterned = made._pattern_changes("waves")
    lacks = {f"shoe.tread.{key}" for key in design.usual_tread("waves")
             if case.value(f"shoe.tread.{key}") is None}  # fmt: skip
    assert set(patterned) == {"shoe.tread.pattern"} | lacks
    assert lacks
    sipes = design._sipes(case)
    lug, channel, depth = (case.value(f"shoe.tread.{name}") for name in (
        "lug_width", "channel_width", "depth"))  # fmt: skip
    along = case.value("shoe.tread.lug_length") or lug
    assert sipes == {
        "shoe.tread.sipes.width": "0.8 mm",
        "shoe.tread.sipes.depth": f"{750 * depth:.4g} mm",
        "shoe.tread.sipes.spacing": f"{1e3 * (along + channel):.4g} mm",
    }
    filled = []
    made.fill = lambda: filled.append(1)
    made.change({"motion.speed": "0.6 m/s"})
    assert session.project.case("a").value("motion.speed") == pytest.approx(0.6)
    assert filled == [1]
    taken = []
    made.shown = lambda action: (taken.append(1), action())
    made.moved = 5.0
    made._keep({"motion.speed": "0.7 m/s"})
    assert session.project.case("a").value("motion.speed") == pytest.approx(0.7)
    assert (made.moved, taken) == (0.0, [1])
    made.run()
    (task,) = session.jobs.tasks.values()
    assert task.about == "a"
    names = made._entries("setup", case.catalogue)
    assert case.entries["motion"] in names


def test_a_design_is_drawn_with_its_measures(session, monkeypatch):
    measures = {"length": "70", "width": "65", "land": "50", "lugs": "12"}
    asked = answering(monkeypatch, session, sole={"html": "the sole", "measures": measures})
    made = design._Design(session, "a")
    told = asyncio.run(made._moving({"motion.speed": "1 m/s"}))
    assert asked == [("sole", str(session.project.path("a")), {"motion.speed": "1 m/s"})]
    assert told["html"] == "the sole"
    assert told["texts"] == {"measures": session.text("design.measures", **measures)}
    assert made.moved > 0


# assumptions, start, others


@pytest.mark.parametrize("state", [None, RUNNING, INTERRUPTED])
@pytest.mark.parametrize("stored", [True, False])
def test_the_largest_effect_of_what_is_assumed_is_told_first(session, state, stored):
    case = session.project.case("a")
    folder = session.project.inside("studies", "a, sensitivity")
    effects = [
        {"path": "motion.speed", "low": [0.3], "high": [0.5], "deviation": 0.04, "reason": "why"},
        {"path": "contaminant.viscosity", "low": [0.1], "high": [0.2], "deviation": 0.01,
         "reason": "so"},
        {"path": "shoe.tread.depth", "low": [1e-3], "high": [2e-3], "deviation": None,
         "reason": "not"},
    ]  # fmt: skip
    if stored:
        folder.mkdir(parents=True)
        (folder / "case-hash.txt").write_text(case.hash)
        content = {"quantities": {"cof": {"effects": effects}}}
        (folder / "sensitivity.json").write_text(json.dumps(content))
    if state:
        session.submit("effects", assumptions.EFFECTS, about="a").state = state
    before = len(session.jobs.tasks)

    async def look(elements):
        widths = [each.style["width"] for each in elements if "effect" in each.classes]
        strong = [each.text for each in elements if isinstance(each, ui.label)
                  and "strong" in each.classes]  # fmt: skip
        bars = [each for each in elements if isinstance(each, ui.linear_progress)]
        offered = [each for each in elements if isinstance(each, ui.button)
                   and each.text == session.text("assumptions.compute")]  # fmt: skip
        (folded,) = (each for each in elements if isinstance(each, ui.expansion))
        words, opened = words_of(elements), folded.value
        for each in offered:
            press(each)
            await asyncio.sleep(0.02)
        return widths, strong, bool(bars), bool(offered), opened, words

    widths, strong, bar, offered, opened, words = shown(
        lambda: assumptions.build(session, "a"), look
    )
    text = session.text
    assert bar is (state == RUNNING)
    assert offered is (not stored and state != RUNNING)
    assert opened is not stored
    assert len(session.jobs.tasks) - before == offered
    if offered:
        task = list(session.jobs.tasks.values())[-1]
        assert (task.function, task.about) == (assumptions.EFFECTS, "a")
        assert tuple(task.arguments) == (str(session.project.path("a")), str(folder))
    assert widths == (["100%", "25%"] if stored else [])
    if stored:
        assert strong[0].endswith(text("assumptions.first"))
        assert not strong[1].endswith(text("assumptions.first"))
        assert text("assumptions.effect", low="0.3 m/s", high="0.5 m/s", effect="0.040") in words
        assert text("assumptions.unknown") in words


@pytest.mark.parametrize("current", [True, False])
def test_recent_variants_show_their_friction_and_whether_it_is_of_their_inputs(
    session, monkeypatch, current
):
    new_variant(session, "b", shoe="work_shoe_full_tread", contaminant="detergent")
    computed(session, "a")
    monkeypatch.setattr(Project, "is_current", lambda *_: current)
    tasks = [session.submit("run", "m:f", about=f"v{k % 9}") for k in range(11)]
    for task in tasks:
        task.state = INTERRUPTED

    def look(elements):
        links = [(each.text, each.props["href"]) for each in elements if isinstance(each, ui.link)]
        return links, words_of(elements)

    links, words = shown(lambda: start._recent(session), look)
    text = session.text
    assert (text("start.cof", cof="0.300"), "/answer?variant=a") in links
    assert [name for name, href in links if href.startswith("/design")] == ["b", "a"]
    assert words.count(text("start.not_computed")) == 1
    assert (text("start.changed") in words) is not current
    about = ", ".join(f"v{k}" for k in range(8)) + " …"
    assert text("start.interrupted", about=about) in words


@pytest.mark.parametrize(
    ("state", "problem", "told"),
    [(DONE, "", None), (FAILED, "too thin", ": too thin"), (FAILED, "", ""),
     (INTERRUPTED, "odd", ""), (RUNNING, "", "")],
)  # fmt: skip
def test_a_row_says_what_its_run_does_or_why_it_has_no_result(session, state, problem, told):
    task: Any = SimpleNamespace(state=state, problem=problem)
    words = "" if told is None else session.text(f"jobs.{state}") + told
    assert _state_text(session, task) == words


def test_a_project_is_packed_beside_what_computes(session, monkeypatch):
    fetched = []

    async def look(elements):
        monkeypatch.setattr(type(ui.download), "file", lambda _, path: fetched.append(path))
        pack = button(elements, session.text("start.pack"))
        press(pack)
        await until(lambda: session.jobs.tasks)
        (task,) = session.jobs.tasks.values()
        busy = pack.enabled
        task.answer, task.state = "x.zip", DONE
        await until(lambda: pack.enabled)
        return task, busy, pack.enabled

    task, busy, after = shown(lambda: start._pack(session), look)
    assert tuple(task.arguments) == (str(session.project.folder),)
    assert (busy, after) == (False, True)


def test_other_projects_are_opened_by_their_folder(session, monkeypatch, tmp_path):
    import underfoot.app.pages.project as page

    went: list[Any] = []

    class Elsewhere:
        async def link(self, folder):
            went.append(folder)
            return "/"

    session.elsewhere = Elsewhere()
    own, other = session.project.folder, tmp_path / "other"
    monkeypatch.setattr(page, "known_projects", lambda: [own, other])

    async def look(elements):
        listed = [each for each in elements if isinstance(each, ui.button)
                  and each.props.get("icon") == "folder"]  # fmt: skip
        press(listed[0])
        await until(lambda: len(went) == 1)
        (field,) = (each for each in elements if isinstance(each, ui.input))
        for k, typed in enumerate(("/abs/there", " beside ")):
            field.value = typed
            press(field, "keydown.enter")
            await until(lambda k=k: len(went) == k + 2)
        field.value = " "
        press(field, "keydown.enter")
        await asyncio.sleep(0.05)
        return [each.text for each in listed]

    assert shown(lambda: _others(session), look) == [str(other)]
    assert went == [other, Path("/abs/there"), own.parent / "beside"]


@pytest.mark.parametrize("action", ["undo", "redo", "remove"])
def test_a_variant_is_undone_done_again_and_removed_by_its_bar(session, monkeypatch, action):
    new_variant(session, "b", shoe="work_shoe_full_tread", contaminant="detergent")
    went, changed = [], []
    monkeypatch.setattr(session, "go", lambda route, variant: went.append((route, variant)))
    monkeypatch.setattr(ui, "notify", lambda *_: None)
    session.project.change("a", {"motion.speed": "0.9 m/s"})
    if action == "redo":
        session.project.undo("a")

    def look(elements):
        if action == "remove":
            items = [each for each in elements if isinstance(each, ui.menu_item)]
            wanted = session.text("variant.remove")
            (item,) = (
                each for each in items
                if wanted in [getattr(one, "text", "") for one in (each, *each.descendants())]
            )  # fmt: skip
            press(item)
        else:
            (made,) = (each for each in elements if each.props.get("data-step") == action)
            press(made)

    shown(lambda: variant_bar(session, "/design", "a", lambda: changed.append(1)), look)
    if action == "remove":
        assert session.project.variants() == ["b"]
        assert went == [("/design", "b")]
        words = shown(lambda: no_variant(session, "/design", lambda _: None), words_of)
        assert session.text("variant.restore", name="a") in words
        return
    assert changed == [1]
    speed = session.project.case("a").value("motion.speed")
    assert speed == pytest.approx(0.4 if action == "undo" else 0.9)


# soles from files and places


def test_files_of_soles_are_listed_by_name_the_newest_revision_first(session):
    soles = session.project.inside("soles")
    for name in ("heel.stl", "heel, revision 2.stl", "Arch.step", "notes.txt", ".hidden.stl"):
        (soles / name).write_text("x")

    def look(elements):
        (known,) = (each for each in elements if isinstance(each, ui.select))
        return known.options

    view: Any = None
    options: Any = shown(lambda: sole_file.build(session, "a", view, lambda: None), look)
    latest = session.text("sole_file.revision", file="heel, revision 2.stl", count=2)
    assert list(options.items()) == [
        ("Arch.step", "Arch.step"), ("heel, revision 2.stl", latest), ("heel.stl", "heel.stl"),
    ]  # fmt: skip


@pytest.mark.parametrize("which", ["use", "use_new", "use_in"])
def test_the_sole_of_a_file_is_taken_by_one_variant_by_all_of_the_earlier_one_or_a_new(
    session, monkeypatch, which
):
    soles = session.project.inside("soles")
    for name in ("heel.stl", "heel, revision 2.stl"):
        (soles / name).write_text(name)
    text = '[shoe.outsole]\nfile = "../soles/heel.stl"\n'
    session.project.path("old").write_text(text, encoding="utf-8")
    new_variant(session, "other", shoe="work_shoe_full_tread", contaminant="detergent")
    took, used, went = [], [], []
    monkeypatch.setattr(Project, "take_sole", lambda _, name, shoe: took.append((name, shoe)))
    monkeypatch.setattr(session, "go", lambda route, variant: went.append(variant))
    page: Any = object.__new__(sole_file._Inspection)
    page.session, page.text, page.name = session, session.text, "a"
    page.path, page.used = "soles/heel, revision 2.stl", lambda: used.append(1)

    def look(elements):
        wanted = session.text(f"sole_file.{which}", names="old")
        press(button(elements, wanted))

    shown(lambda: page._uses({"shoe": 1}), look)
    names = [name for name, _ in took]
    assert names == {"use": ["a"], "use_in": ["a", "old"], "use_new": ["heel, revision 2"]}[which]
    assert used == ([] if which == "use_new" else [1])
    assert went == (["heel, revision 2"] if which == "use_new" else [])


def test_a_place_that_was_dropped_is_computed_and_its_end_is_told(tmp_path):
    session = session_of(tmp_path)
    folder = tmp_path / "places"
    folder.mkdir(exist_ok=True)
    pages: list[Any] = []

    async def look(elements):
        (folder / "ward.toml").write_text("")
        page = pages[0]
        await page.take_file(["places/ward.toml"])
        (task,) = session.jobs.tasks.values()
        task.problem, task.state = "no floor", DONE
        await until(lambda: "no floor" in words_of(elements))
        return page.choice.value, task, words_of(elements)

    value, task, words = shown(lambda: pages.append(place._Place(session)), look)
    assert value == task.about == "ward"
    assert task.function == place.WORK
    assert tuple(task.arguments) == (str(folder / "ward.toml"), str(folder / "ward"))
    assert "no floor" in words


# what the computing processes are asked


@pytest.mark.parametrize("lugs", [True, False])
@pytest.mark.parametrize("usable", [True, False])
def test_an_answer_has_its_numbers_and_the_lugs_whose_fluid_has_a_long_way(
    monkeypatch, lugs, usable
):
    data = {
        "lug_way": SimpleNamespace(values=np.array([1.0, 5.0, 2.0])),
        "lug_height": SimpleNamespace(values=np.array([3.0, 3.0, 1.0])),
    } if lugs else {}  # fmt: skip
    scalars = {"cof": SimpleNamespace(value=0.3, interval=(0.2, 0.4))}
    if usable:
        scalars["slip_probability"] = SimpleNamespace(value=0.1, interval=(0.0, 0.2), note="n")
    result = SimpleNamespace(scalars=scalars, verdict=lambda: ("grips", "x"), data=data,
                             usable=usable)  # fmt: skip
    monkeypatch.setattr(work.Result, "load", lambda _: result)
    monkeypatch.setattr(work, "friction_limit", lambda _: "the limit")
    monkeypatch.setattr(work, "surface_of_result", lambda _: "surface")
    monkeypatch.setattr(work, "sole_html", lambda shown, surface: (shown, surface))
    monkeypatch.setattr(work, "presented", lambda _: {"words": 1})
    told = work.answer("folder", progress=silent)
    assert told["advised"] == ([1, 2] if lugs else [])
    assert (told["verdict"], told["cof"], told["interval"]) == ("grips", 0.3, (0.2, 0.4))
    assert told["limit"] == ("the limit" if usable else "")
    wanted = (0.1, (0.0, 0.2), True) if usable else (None, None, False)
    assert (told["slip"], told["slip_interval"], told["extrapolated"]) == wanted
    assert told["html"] == (result, "surface")


def test_wear_is_computed_from_one_worn_pair_without_a_band(monkeypatch):
    case = SimpleNamespace(hash="h")
    monkeypatch.setattr(work.Case, "load", lambda _: case)
    monkeypatch.setattr(work, "worn_pair", lambda text: f"pair {text}")
    monkeypatch.setattr(work, "wear_mode", lambda mode, given: (mode, given))
    asked = []

    def series(given, **more):
        asked.append((given, more))
        return "series"

    monkeypatch.setattr(work, "wear_series", series)
    monkeypatch.setattr(work, "presented", lambda shown: {"of": shown})
    written = []

    def report(shown, folder, *, overwrite, further):
        written.append((shown, folder, overwrite, further))
        return SimpleNamespace(page=None)

    monkeypatch.setattr(work, "write_report", report)
    monkeypatch.setattr(work, "write_text", lambda text: text)
    monkeypatch.setattr(work, "put_language", lambda _: None)
    work.worn("path", "folder", "1 mm", progress=silent)
    (((given, more),), ((shown_, folder, overwrite, further),)) = asked, written
    assert given is case
    assert more == {"mode": (None, case), "band": False, "pair": "pair 1 mm", "progress": silent}
    assert (shown_, folder, overwrite) == ("series", "folder", True)
    assert json.loads(further["shown.json"]) == {"of": "series", "hash": "h"}


def test_cells_of_a_moving_sole_cover_it_by_as_many_as_are_drawn():
    axes = {"x": np.array([0.0, 0.3]), "y": np.array([-0.05, 0.05])}
    fields: Any = {name: SimpleNamespace(values=each) for name, each in axes.items()}
    side = work._moving_spacing(fields)
    assert 0.3 * 0.1 / side**2 == pytest.approx(work.SHAPED)
    fields["x"].values = np.array([0.0, 1e-3])
    assert work._moving_spacing(fields) == work.DESIGNED


# the server


class Browser:
    """Asks an application without a server."""

    def __init__(self, application):
        self.transport = httpx.ASGITransport(application)

    def ask(self, method, path, **more):
        async def asked():
            async with httpx.AsyncClient(transport=self.transport, base_url="http://here") as one:
                return await one.request(method, path, **more)

        return asyncio.run(asked())

    def get(self, path):
        return self.ask("GET", path)

    def post(self, path, **more):
        return self.ask("POST", path, **more)


def test_the_server_gives_contents_words_and_pictures_and_takes_questions_and_files(
    tmp_path, monkeypatch
):
    session = session_of(tmp_path)
    new_variant(session, "a", shoe="work_shoe_full_tread", contaminant="detergent")
    monkeypatch.setattr(serve.ui, "run_with", lambda *_, **__: None)
    monkeypatch.setattr(serve.pages_app, "on_startup", lambda _: None)
    monkeypatch.setattr(serve.pages_app, "add_static_files", lambda *_: None)
    monkeypatch.setattr(serve, "_route", lambda *_: None)
    exchange = Exchange()
    monkeypatch.setattr(serve, "Exchange", lambda: exchange)
    pictured = []

    class Live:
        async def ask(self, function, path):
            pictured.append(path)
            return "<svg/>"

    session.jobs.live = Live()  # type: ignore[assignment]
    browser = Browser(serve._application(session.project, session.jobs, None))
    address = exchange.keep("<p>kept</p>", "text/html")
    found = browser.get(address)
    assert (found.status_code, found.text) == (200, "<p>kept</p>")
    assert found.headers["content-type"].startswith("text/html")
    assert browser.get("/api/content/none").status_code == 410
    for kind in ("variant", "result"):
        assert browser.get(f"/api/picture/{kind}/a").text == "<svg/>"
    assert pictured == [str(session.project.path("a")),
                        str(session.project.result_folder("a") / "case.toml")]  # fmt: skip
    assert browser.get("/api/picture/variant/..a").status_code == 404
    script = serve.Text("de").script_name
    assert browser.get(serve.WORDS + script).status_code == 200
    assert browser.get(serve.WORDS + "de-old.js").status_code == 404
    assert browser.get(serve.WORDS + "xx.js").status_code == 404

    async def handler(asked):
        if asked.get("fails"):
            raise (asked["fails"] == "disk" and OSError("full")) or InputError("no", where="there")
        return {"twice": 2 * asked["n"]}

    exchange.handlers["k"] = handler
    assert browser.post("/api/ask/k", json={"n": 4}).json() == {"twice": 8}
    assert browser.post("/api/ask/other", json={}).status_code == 410
    told = browser.post("/api/ask/k", json={"fails": "input"}).json()
    assert told == {"problem": "there no", "again": False}
    assert browser.post("/api/ask/k", json={"fails": "disk"}).json()["again"] is True
    typed = {"text": "2 in", "unit": "mm", "comma": False}
    assert browser.post("/api/quantity", json=typed).json() == {"value": pytest.approx(50.8)}
    assert "problem" in browser.post("/api/quantity", json=typed | {"text": "x"}).json()
    sent = browser.post(serve.UPLOADS + "measured/a.csv", content=b"1,2").json()
    assert sent == {"path": "measured/a.csv"}
    assert session.project.inside("measured", "a.csv").read_bytes() == b"1,2"
    assert "problem" in browser.post(serve.UPLOADS + "elsewhere/a.csv", content=b"1").json()
