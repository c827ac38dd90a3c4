"""What stands on the page of an answer, on those beside it, and what their buttons do."""

import asyncio
import json
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from nicegui import ui

from page_session import (
    answering,
    button,
    computed,
    press,
    session_of,
    session_of_a_variant,
    shown,
    until,
    words_of,
)
from underfoot.app import components
from underfoot.app.jobs import DONE, FAILED, INTERRUPTED, RUNNING, STOPPED, JobQueue
from underfoot.app.pages import answer, repair, wear
from underfoot.app.project import Project
from underfoot.app.variant_bar import new_variant
from underfoot.core import InputError
from underfoot.core.files import checksum
from underfoot.core.presentation import Part

TABLE = {"title": "Numbers", "columns": ["", "value"], "rows": [["load", "5 N"], ["  film", "2 %"]],
         "shows": ""}  # fmt: skip
LUGS = {"title": "Lugs", "columns": ["lug", ""], "rows": [["1", "a"], ["2", "b"]], "shows": "lug"}
ANSWER: dict[str, Any] = {
    "usable": True, "headline": ["In words."], "verdict": "doubtful", "cof": 0.3014,
    "interval": (0.2501, 0.3604), "slip": 0.1, "slip_interval": (0.04, 0.16),
    "extrapolated": False, "cautions": ["Mind this."], "limit": "The film limits it.",
    "tables": [TABLE, LUGS], "remarks": {"Assumed": ["a dry shoe"]}, "advised": [1], "html": "<i>",
}  # fmt: skip


@pytest.fixture
def session(tmp_path):
    return session_of_a_variant(tmp_path)


@pytest.fixture
def page(session):
    return answer._Answer(session, "a", session.project.case("a"))


def classes_of(elements, kind):
    return [each for each in elements if kind in each.classes]


@pytest.mark.parametrize("current", [True, False])
def test_an_answer_shows_its_numbers_and_marks_those_of_other_inputs(
    session, page, monkeypatch, current
):
    computed(session, "a")
    monkeypatch.setattr(Project, "is_current", lambda *_: current)
    asked = answering(monkeypatch, session, answer=ANSWER, previewed={})
    text = session.text

    async def look(elements):
        await until(lambda: "0.301" in words_of(elements))
        await until(lambda: len(asked) == 1 + current)
        await asyncio.sleep(0.02)
        stale = [each.classes for each in classes_of(elements, "stale")]
        return words_of(elements), len(stale), [e.classes for e in classes_of(elements, "verdict")]

    words, stale, verdicts = shown(page.show, look)
    assert [name for name, *_ in asked] == ["answer", "previewed"][: 1 + current]
    assert stale == (0 if current else 5)
    assert (text("answer.changed") in words) is not current
    assert (text("answer.live") in words) is current
    assert (text("answer.under", **page._under()) in words) is current
    assert words.index(text("answer.interval", low="0.250", high="0.360")) == (
        words.index("0.301") + 1
    )
    for said in ("Mind this.", "The film limits it.", "In words.", "a dry shoe"):
        assert said in words
    assert words.index(text("answer.no_report")) < words.index("Mind this.")
    assert "doubtful" in verdicts[0]
    assert (text("answer.cut") in words) is current
    assert words.count(text("answer.cut")) == current  # of the lug that is advised alone


def test_an_answer_without_a_number_says_why_and_nothing_else(session, page):
    def build():
        page.summary, page.verdict, page.reasons = (ui.element() for _ in range(3))
        page._headline({**ANSWER, "usable": False}, True)

    assert [word for word in shown(build, words_of) if word] == ["In words."]


@pytest.mark.parametrize(
    ("slip", "interval", "said", "parts"),
    [
        (0.5, (0.4, 0.6), "risk", {"share": "50 %"}),
        (0.2, (0.15, 0.25), "risk", {"share": "20 %"}),
        (0.19, (0.15, 0.25), "risk_odds", {"count": "5"}),
        (0.001, (0.0005, 0.002), "risk_odds", {"count": "1000"}),
        (0.0009, (0.0005, 0.002), "risk_rare", {}),
        (0.5, (0.002, 0.99), "risk_unknown", {"low": "0.2 %", "high": "99 %"}),
        (0.3, None, "risk", {"share": "30 %"}),
    ],
)
@pytest.mark.parametrize("extrapolated", [False, True])
def test_a_risk_is_said_as_people_say_it(page, slip, interval, said, parts, extrapolated):
    text = page.text
    found = page._risk({"slip": slip, "slip_interval": interval, "extrapolated": extrapolated})
    wanted = text(f"answer.{said}", **parts)
    if interval and said != "risk_unknown":
        low, high = map(answer.probability_text, interval)
        wanted += f" ({text('answer.interval', low=low, high=high)})"
    assert found == wanted + f" ({text('answer.extrapolated')})" * extrapolated


@pytest.mark.parametrize("known", [None, "b"])
def test_a_cof_stands_on_a_scale_with_what_walkers_need_and_a_known_shoe(session, page, known):
    for name in "abc":
        if name != "a":
            new_variant(session, name, shoe="work_shoe_half_tread", contaminant="detergent")
        computed(session, name)
    session.project.known = known

    def build():
        page.beside = ui.element()
        page._beside(ANSWER)

    def look(elements):
        marks = {
            next(iter(each.classes)): each.style["left"]
            for each in elements
            if each.tag == "i" and "left" in each.style and "right" not in each.style
        }
        (reach,) = classes_of(elements, "reach")
        (choice,) = (each for each in elements if isinstance(each, ui.select))
        links = [each for each in elements if isinstance(each, ui.link)]
        choice.value = "c"
        return marks, dict(reach.style), choice.options, [each.props["href"] for each in links]

    marks, reach, options, links = shown(build, look)
    need = session.project.case("a").value("risk.rcof_mean")
    wanted = {"here": 0.3014, "needed": need} | ({"known": 0.3} if known else {})
    assert marks == {kind: f"{100 * cof / 0.8:.1f}%" for kind, cof in wanted.items()}
    assert (reach["left"], reach["right"]) == ("31.3%", "calc(100% - 45.0%)")
    assert sorted(options) == ["b", "c"]
    assert session.project.known == "c"
    assert links == (["/compare?variants=b%7Ca"] if known else [])


def test_a_scale_ends_where_it_ends():
    def build():
        components.scale([("low", "l", -0.2), ("high", "h", 3.0)], None)

    def look(elements):
        return [each.style["left"] for each in elements if "left" in each.style]

    assert shown(build, look) == ["0.0%", "100.0%"]


STORED = {
    "cof": {"value": 0.2}, "slip_probability": {"value": 0.4, "interval": [0.3, 0.5]},
    "changes": [
        {"name": "rinse", "action": "rinse it", "cof": 0.25, "slip_probability": 0.35,
         "values": {"motion.speed": "0.5 m/s"}},
        {"name": "dilute", "action": "dilute it", "cof": None, "reason": "no film",
         "slip_probability": None},
        {"name": "new_tread", "action": "new tread", "cof": 0.4, "slip_probability": 0.1,
         "slip_interval": [0.001, 0.97], "values": {}},
        {"name": "idle", "action": "idle", "cof": 0.201, "slip_probability": 0.39,
         "does_something": False},
        {"name": "worse", "action": "worse", "cof": 0.1, "slip_probability": 0.4,
         "extrapolated": True},
    ],
}  # fmt: skip


def test_what_would_help_is_listed_from_the_best_on_and_the_rest_is_folded(
    session, page, monkeypatch
):
    page.folder.mkdir(parents=True)
    (page.folder / "risk.json").write_text(json.dumps(STORED), encoding="utf-8")
    begun, went = [], []
    monkeypatch.setattr(answer, "begin_run", lambda _, name, **__: begun.append(name))
    monkeypatch.setattr(session, "go", lambda route, **query: went.append((route, query)))

    def build():
        page.help = ui.element()
        page.helped = SimpleNamespace(deactivate=lambda: None)
        page._helps()

    def look(elements):
        helps = [words_of(each.descendants()) for each in classes_of(elements, "help")]
        makes = [e for e in elements if isinstance(e, ui.button) and "action" not in e.classes]
        (folded,) = (each for each in elements if isinstance(each, ui.expansion))
        press(makes[1])
        return helps, [word for word in words_of(folded.descendants()) if word]

    helps, rest = shown(build, look)
    text = page.text

    def line(action, cof, after, more=""):
        said = text("answer.change", action=action, now="0.200", cof=cof, before="40 %",
                    after=after) + more  # fmt: skip
        return said.replace(" %", "\u00a0%")

    unsure = text("answer.between", low="0.1 %", high="97 %")
    make = text("answer.make")
    assert helps == [
        [line("New tread", "0.400", unsure), make], [line("Rinse it", "0.250", "35 %"), make],
    ]  # fmt: skip
    assert rest[-3:] == [
        line("Idle", "0.201", "39 %"),
        line("Worse", "0.100", "40 %", f" ({text('answer.extrapolated')})"),
        text("answer.not_computed", action="Dilute it", reason="no film"),
    ]
    new = f"a, {text('changes.rinse')}"
    assert begun == [new]
    assert went == [("/answer", {"variant": new, "beside": "a"})]
    assert session.project.case(new).value("motion.speed") == pytest.approx(0.5)


@pytest.mark.parametrize(("state", "waits"), [(None, False), (RUNNING, True), (DONE, False)])
def test_help_is_waited_for_while_its_job_is_open_and_else_offered(
    session, page, monkeypatch, state, waits
):
    looked = []
    if state:
        session.submit("help", answer.ADVICE, about="a").state = state
    before = len(session.jobs.tasks)

    def build():
        page.help = ui.element()
        page.helped = SimpleNamespace(
            deactivate=lambda: looked.append("off"), activate=lambda: looked.append("on")
        )
        page._helps()

    def look(elements):
        words = words_of(elements)
        offered = [e for e in elements if isinstance(e, ui.button)]
        for each in offered:
            press(each)
        return words

    monkeypatch.setattr(Project, "is_current", lambda *_: True)
    words = shown(build, look)
    assert (page.text("answer.help_waits") in words) is waits
    assert looked == ([] if waits else ["off"] if state else ["off", "on"])
    tasks = list(session.jobs.tasks.values())[before:]
    assert [(task.function, task.about, task.first, task.arguments) for task in tasks] == (
        [] if state else [
            (answer.ADVICE, "a", True, (str(session.project.path("a")), str(page.folder)))
        ]
    )  # fmt: skip


@pytest.mark.parametrize(
    ("state", "began", "same"),
    [(None, 0.0, False), ("waiting", 0.0, True), (RUNNING, 2e9, True), (RUNNING, 1e9, False),
     (DONE, 2e9, False)],
)  # fmt: skip
@pytest.mark.parametrize("later", [False, True])
def test_a_run_of_the_present_file_is_begun_once(session, monkeypatch, state, began, same, later):
    os.utime(session.project.path("a"), (1.5e9, 1.5e9))
    cancelled = []
    monkeypatch.setattr(JobQueue, "cancel", lambda _, task: cancelled.append(task))
    old = None
    if state:
        old = session.submit("old", answer.RUN, about="a")
        old.state, old.began = state, began
    task = answer.begin_run(session, "a", later=later)
    assert (task is old) is same
    assert cancelled == ([old] if state == RUNNING and not same else [])
    if same:
        return
    files = str(session.project.path("a")), str(session.project.result_folder("a"))
    assert (task.function, task.about, tuple(task.arguments)) == (answer.RUN, "a", files)
    assert task.first is not later
    help_job = (session.text("answer.help_job"), answer.ADVICE, *files)
    assert tuple(task.then) == (() if later else help_job)


@pytest.mark.parametrize(("previewed", "words"), [(0.3, True), (0.0, True), (0.3, None)])
def test_the_full_run_behind_a_preview_replaces_it_and_may_be_kept(
    session, page, monkeypatch, previewed, words
):
    asked = answering(monkeypatch, session, answer={**ANSWER, "verdict": "No result"})
    cancelled, sent, went, views = [], [], [], []
    monkeypatch.setattr(JobQueue, "cancel", lambda _, task: cancelled.append(task))
    monkeypatch.setattr(ui, "run_javascript", sent.append)
    monkeypatch.setattr(session, "go", lambda route, **query: went.append(query))

    def build():
        page.behind, page.view = ui.element(), SimpleNamespace(show=views.append)
        page._start_tried({"motion.speed": "0.4 m/s"})
        page._start_tried({"motion.speed": "0.5 m/s"})

    async def look(elements):
        task = page.tried
        page.preview_cof = previewed
        task.answer = 0.33 if words else None
        task.state = DONE
        await until(lambda: asked)
        await asyncio.sleep(0.05)
        said = words_of(elements)
        if words:
            Path(task.arguments[1]).mkdir(parents=True)
            press(button(elements, page.text("answer.keep")))
        return said

    said = shown(build, look)
    first, task = session.jobs.tasks.values()
    assert cancelled == [first]
    path, folder, named = task.arguments
    assert path == str(session.project.path("a"))
    assert Path(folder).parts[-3:] == ("results", ".tried", "a")
    assert named["motion.speed"] == "0.5 m/s"
    assert named["name"] == f"a, {page.text('inputs.motion.speed')} 0.5 m per s"
    assert task.function == answer.RUN
    empty = [each for each in sent if each.startswith("showTexts")]
    assert bool(empty) is not previewed
    text = page.text
    if not words:
        assert "No result" in said
        assert views == []
        return
    full = text("answer.full_run", cof="0.330")
    if previewed:
        full += " " + text("answer.replaced", preview="0.300", off="+10.0")
    assert full in said
    assert views == ["<i>"]
    assert went == [{"variant": named["name"]}]
    kept = session.project.case(named["name"])
    assert kept.value("motion.speed") == pytest.approx(0.5)
    assert session.project.result_folder(named["name"]).is_dir()


def test_a_preview_tells_its_cof_or_that_there_is_none(session, page, monkeypatch):
    seen = {"cof": 0.3014, "error": 0.0123, "fluid_load": "90 N", "html": "sole", "slip": None}
    asked = answering(monkeypatch, session, previewed=seen)
    change = {"motion.speed": "0.4 m/s"}
    told = asyncio.run(page._preview(change))
    assert [(name, *given) for name, given, _ in asked] == [
        ("previewed", str(session.project.path("a")), str(page.folder), change)
    ]
    wanted = page.text("answer.preview", cof="0.301", error="0.012", fluid_load="90 N")
    assert told == {"texts": {"preview": wanted, "preview_note": ""}, "html": "sole"}
    assert page.preview_cof == 0.3014
    answering(monkeypatch, session, previewed=seen | {"slip": 0.5, "slip_interval": None})
    risk = page.text("answer.risk", share="50 %")
    assert asyncio.run(page._preview(change))["texts"]["preview_note"] == risk
    answering(monkeypatch, session, previewed=InputError("too fast", where="speed"))
    told = asyncio.run(page._preview(change))
    assert told["unanswered"] is True
    assert told["texts"] == {
        "preview": page.text("answer.no_preview"), "preview_note": "Too fast",
    }  # fmt: skip
    assert page.preview_cof == 0.0


def test_a_groove_is_cut_into_the_file_and_the_answer_computed_anew(session, page, monkeypatch):
    asked = answering(monkeypatch, session, advised_groove={"motion.speed": "0.5 m/s"})
    ran = []
    monkeypatch.setattr(page, "run", lambda: ran.append(1))
    asyncio.run(page._cut(3))
    assert [(name, *given) for name, given, _ in asked] == [
        ("advised_groove", str(session.project.path("a")), str(page.folder), 3)
    ]
    assert session.project.case("a").value("motion.speed") == pytest.approx(0.5)
    assert ran == [1]


@pytest.mark.parametrize("title", ["", "Numbers"])
def test_a_table_marks_parts_and_has_buttons_in_the_rows_that_are_said(title):
    pressed = []
    given = {**TABLE, "title": title, "shows": "lug", "rows": [["a", "1 %"], [Part("b"), "2"]]}

    def look(elements):
        cells = {
            tag: [words_of(each.descendants()) for each in elements if each.tag == tag]
            for tag in ("caption", "th", "td")
        }
        (cut,) = (each for each in elements if isinstance(each, ui.button))
        press(cut)
        parts = [words_of(each.descendants()) for each in classes_of(elements, "part")]
        lines = [each.props["data-lug"] for each in elements if "data-lug" in each.props]
        return cells, parts, lines

    cells, parts, lines = shown(lambda: components.table(given, ("Cut", pressed.append), [1]), look)
    assert cells["caption"] == ([["Numbers"]] if title else [])
    assert cells["th"] == [[""], ["value"], ["a"], ["b"]]
    assert cells["td"] == [["1\u00a0%"], ["2", "Cut"]]
    assert parts == [["b"]]
    assert lines == ["0", "1"]
    assert pressed == [1]


@pytest.mark.parametrize("state", [DONE, FAILED, STOPPED])
def test_a_line_of_a_task_shows_how_far_it_is_and_goes_when_it_ended(session, state):
    task = session.submit("Run", answer.RUN, about="a")
    done = []

    async def ended(told):
        done.append(told)

    async def look(elements):
        (bar,) = (each for each in elements if isinstance(each, ui.linear_progress))
        task.state, task.stage, task.fraction = RUNNING, "half way", 0.5
        await until(lambda: bar.value == 0.5)
        words = words_of(elements)
        assert not done
        task.state = state
        await until(lambda: done)
        return words, [each for each in elements if isinstance(each, ui.linear_progress)]

    words, bars = shown(lambda: components.task_line(session, task, ended), look)
    assert "Run: half way" in words
    assert (done, bars) == ([task], [])


@pytest.mark.parametrize(
    ("state", "said"), [(INTERRUPTED, True), (FAILED, False), (DONE, False), (None, False)]
)
def test_only_a_task_that_was_interrupted_is_told_as_that(session, state, said):
    task = session.submit("Run", answer.RUN, about="a") if state else None
    if task:
        task.state = state
    words = shown(lambda: components.interruption(session, task), words_of)
    assert words == ([f"Run: {session.text('jobs.interrupted')}"] if said else [])


# wear


@pytest.mark.parametrize(
    ("lost", "months", "pair"),
    [("1.2", "5", "1.2 mm after 5.0 months"), ("0.1 cm", "6", "1.0 mm after 6.0 months"),
     ("0", "5", None), ("1", "", None)],
)  # fmt: skip
def test_how_a_shoe_wears_is_begun_from_one_worn_pair(session, lost, months, pair):
    async def look(elements):
        fields = [each for each in elements if isinstance(each, ui.input)]
        fields[0].value, fields[1].value = lost, months
        press(button(elements, session.text("wear.compute")))
        await asyncio.sleep(0.05)
        return [bool(field.error) for field in fields]

    errors = shown(lambda: wear.build(session, "a"), look)
    tasks = list(session.jobs.tasks.values())
    if pair is None:
        assert (tasks, any(errors)) == ([], True)
        return
    (task,) = tasks
    folder = session.project.inside("studies", "a, wear")
    assert (task.function, task.about) == (wear.WORN, "a")
    assert task.arguments[:2] == (str(session.project.path("a")), str(folder))
    assert task.arguments[2] == pair


@pytest.mark.parametrize("state", [None, RUNNING, FAILED])
@pytest.mark.parametrize("stored", ["this", "another", None])
def test_the_wear_that_is_shown_is_of_the_present_case(session, state, stored):
    if stored:
        file = session.project.inside("studies", "a, wear", "shown.json")
        file.parent.mkdir(parents=True)
        kept = {"headline": ["It lasts."], "cautions": ["About."], "tables": [TABLE],
                "hash": session.project.case("a").hash if stored == "this" else "x"}  # fmt: skip
        file.write_text(json.dumps(kept), encoding="utf-8")
    if state:
        task = session.submit("wear", wear.WORN, about="a")
        task.state, task.problem = state, "too thin" * (state == FAILED)

    def look(elements):
        compute = button(elements, session.text("wear.compute"))
        bars = [each for each in elements if isinstance(each, ui.linear_progress)]
        (folded,) = (each for each in elements if isinstance(each, ui.expansion))
        return words_of(elements), compute.enabled, bool(bars), folded.value

    words, enabled, bar, is_open = shown(lambda: wear.build(session, "a"), look)
    assert is_open is (state is not None)
    assert (enabled, bar) == (state != RUNNING, state == RUNNING)
    assert ("too thin" in words) is (state == FAILED)
    for said in ("It lasts.", "About.", "load"):
        assert (said in words) is (state is None and stored == "this")


# a file that is gone


@pytest.mark.parametrize("had", ["gone", "changed", "moved"])
def test_a_variant_whose_file_is_gone_takes_another(tmp_path, monkeypatch, had):
    session = session_of(tmp_path)
    soles = session.project.inside("soles")
    meant, other = soles / "a.stl", soles / "b.stl"
    meant.write_text("meant")
    sha = checksum(meant)
    text = f'[shoe.outsole]\nfile = "../soles/a.stl"\nsha256 = "{sha}"\n[floor]\nfrom = "x"\n'
    session.project.path("v").write_text(text, encoding="utf-8")
    (reference,) = repair.references(session.project, "v")
    assert (reference.name, reference.sha256) == ("../soles/a.stl", sha)
    assert reference.holds(session.project)
    if had == "moved":
        meant.rename(other)
    elif had == "gone":
        meant.unlink()
        other.write_text("other")
    else:
        meant.write_text("changed")
        other.write_text("other")
    assert not reference.holds(session.project)
    mended = []
    (soles / "c.txt").write_text("no sole")

    def look(elements):
        names = [each.text for each in elements if isinstance(each, ui.button)]
        choices = [each for each in elements if isinstance(each, ui.select)]
        if had == "gone":
            choices[0].value = "b.stl"
        else:
            press(next(each for each in elements if isinstance(each, ui.button)))
        return names, [choice.options for choice in choices]

    def build():
        repair._choices(session, "v", reference, lambda: mended.append(1))

    names, options = shown(build, look)
    said = session.text
    assert names == {
        "gone": [], "changed": [said("repair.present", file="a.stl")],
        "moved": [said("repair.same", file="b.stl")],
    }[had]  # fmt: skip
    assert options == ([] if had == "moved" else [["b.stl"]])
    assert mended == [1]
    taken = meant if had == "changed" else other
    written = session.project.text("v")
    assert f'file = "../soles/{taken.name}"' in written
    assert f'sha256 = "{checksum(taken)}"' in written
    (again,) = repair.references(session.project, "v")
    assert again.holds(session.project)


def test_what_a_variant_names_is_told_where_it_can_not_be_read(session, monkeypatch):
    written = 'a = "../soles/x.stl"\n[b]\nc = "../measured/y.csv"\nd = "../z"\n'
    session.project.path("v").write_text(written, encoding="utf-8")
    names = [(each.name, each.sha256) for each in repair.references(session.project, "v")]
    assert names == [("../soles/x.stl", None), ("../measured/y.csv", None)]
    session.project.path("w").write_text("no toml at all [", encoding="utf-8")
    assert repair.references(session.project, "w") == []
    error = InputError("it is broken")
    for name, lacks in (("w", False), ("v", True)):
        words = shown(lambda name=name: repair._card(session, name, error, lambda: None), words_of)
        assert (session.text("repair.undo") in words) is not lacks
        assert (session.text("repair.lacks", file="x.stl") in words) is lacks
