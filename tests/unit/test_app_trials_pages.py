"""Pages of measurements: what a folder and a trial show, and what their buttons ask for."""

import asyncio
import shlex
from collections import Counter
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from nicegui import ui

from page_session import answering, button, press, session_of, shown, until, words_of
from underfoot.app import trials_plots, work_trials
from underfoot.app.jobs import DONE
from underfoot.app.pages import trials, trials_folder
from underfoot.app.pages.trials_folder import FolderView
from underfoot.app.pages.trials_trial import TrialView, _edit_words, _step_words
from underfoot.app.trials_study import TrialsFolder, free_name, studies
from underfoot.core import InputError
from underfoot.trials.study.record_signals import Envelope

STEP = {
    "number": 2, "side": "left", "rcof": 0.21, "rcof_uncertainty": 0.013, "verdict": "accepted",
    "contact": 1.0, "plate": "P1", "by_hand": [], "item": "step 2", "cautions": ["near the rim"],
    "peak_slipping_speed": None, "outcome": "", "slip_distance": None, "reason": "",
}  # fmt: skip
OTHER = STEP | {"number": 1, "contact": 0.3, "rcof": None, "verdict": "refused", "item": "step 1"}
EDIT = {"step": "step 2", "what": "side", "before": "left", "after": "right", "why": "seen so",
        "quantity": "rcof", "number_before": 0.2, "number_after": None}  # fmt: skip
VIEW: dict[str, Any] = {
    "file": "b.csv", "verdict": "accepted", "numbers": ["RCOF 0.21"], "conditions": {"shoe": "A"},
    "reasons": ["a reason"], "steps": [STEP, OTHER], "edits": [], "kind": "walking", "run": 1,
    "whole": {"bands": []}, "chosen": 2, "plot": {"panels": []},
}  # fmt: skip


@pytest.fixture
def session(tmp_path):
    made = session_of(tmp_path)
    made.project.inside("trials", "walks").mkdir(parents=True)
    return made


@pytest.fixture
def study(session):
    made = TrialsFolder(session.project, "walks")
    made.files = ["a.csv", "b.csv", "c.csv"]
    return made


def tool(elements, icon):
    (found,) = (each for each in elements if each.props.get("icon") == icon)
    return found


@pytest.mark.parametrize("file", ["a.csv", "b.csv", "c.csv", "gone.csv"])
def test_a_trial_leads_to_those_beside_it_where_there_are_any(session, study, file):
    went = []

    async def show(name):
        went.append(name)

    def build():
        TrialView(session, study, {**VIEW, "file": file}, lambda: None, show)

    async def look(elements):
        tools = [tool(elements, icon) for icon in ("navigate_before", "navigate_next")]
        for each in tools:
            if each.enabled:
                press(each)
        await asyncio.sleep(0.02)
        undone = [tool(elements, icon).enabled for icon in ("undo", "redo")]
        return [each.enabled for each in tools], undone

    study.done = [("x", "y")]
    enabled, undone = shown(build, look)
    at = study.files.index(file) if file in study.files else None
    assert enabled == ([at > 0, at < 2] if at is not None else [False, False])
    beside = [] if at is None else study.files[max(at - 1, 0) : at] + study.files[at + 1 : at + 2]
    assert went == beside
    assert undone == [True, False]


def built(session, study, view):
    pages = []

    async def show(_):
        pass

    def build():
        pages.append(TrialView(session, study, view, lambda: None, show))

    return pages, build


@pytest.mark.parametrize(
    ("changes", "near", "offered"),
    [({}, False, ["exclude", "is_right"]), ({"side": "unknown"}, False,
     ["exclude", "is_left", "is_right"]), ({}, True, ["exclude", "is_right", "this_plate"]),
     ({"by_hand": ["exclude"]}, True, [])],
)  # fmt: skip
def test_a_step_offers_what_may_be_done_with_it(
    session, study, monkeypatch, changes, near, offered
):
    step = STEP | changes
    other = OTHER | ({"contact": 1.09} if near else {"contact": 0.88})
    _, build = built(session, study, VIEW | {"steps": [step, other]})
    asked = answering(monkeypatch, session, trial_view=VIEW)
    text = session.text
    names = {text(f"trials.{key}"): key
             for key in ("exclude", "is_left", "is_right", "this_plate")}  # fmt: skip

    async def look(elements):
        made = [each for each in elements if isinstance(each, ui.button) and each.text in names]
        keys = [names[each.text] for each in made]
        chips = [(each.text, each.props["aria-pressed"]) for each in elements
                 if "chip" in each.classes]  # fmt: skip
        words = words_of(elements)
        if made:
            press(made[-1])
            await until(lambda: asked)
        return keys, chips, words

    keys, chips, words = shown(build, look)
    assert keys == offered
    side = f"trials.side_{step['side']}"
    assert chips == [
        (f"1 {text('trials.side_left')}: –", "false"), (f"2 {text(side)}: 0.210", "true"),
    ]  # fmt: skip
    assert "step 2: RCOF 0.2100 ± 0.0130" in words
    for said in ("near the rim", "a reason", "shoe: A", "RCOF 0.21"):
        assert said in words
    if offered:
        change = {"exclude": {"what": "exclude"}, "is_right": {"what": "side", "value": "right"},
                  "this_plate": {"what": "plate", "value": "P1"}}[offered[-1]]  # fmt: skip
        ((_, given, options),) = asked
        assert given[1:] == ("b.csv", 2)
        assert options == {"change": {"step": 2, **change}, "keep": False}


def test_an_edit_that_lacks_its_reason_is_kept_with_one_and_taken_back(session, study, monkeypatch):
    edited = VIEW | {"edits": [EDIT, EDIT | {"step": "step 3", "why": ""}]}
    pages, build = built(session, study, edited)
    kept = edited | {"before": "old", "after": "new"}
    asked = answering(monkeypatch, session, trial_view=kept)

    async def look(elements):
        page, text = pages[0], session.text
        log = words_of(elements)
        takes = [e for e in elements
                 if isinstance(e, ui.button) and e.text == text("trials.take_back")]  # fmt: skip
        press(takes[1])
        await until(lambda: asked)
        await asyncio.sleep(0.02)
        assert asked.pop()[2] == {"change": {"step": 1, "what": "take back"}, "keep": True}
        page.pending = {"step": 2, "what": "side", "value": "left"}
        page._fill(edited)
        assert [each for each in elements if isinstance(each, ui.input)]
        (why,) = (each for each in elements if isinstance(each, ui.input))
        pending = words_of(elements)
        keep = button(elements, text("trials.keep"))
        press(keep)
        await asyncio.sleep(0.05)
        assert not asked
        assert why.error
        why.value = " I saw it "
        press(keep)
        await until(lambda: asked)
        await asyncio.sleep(0.02)
        return log, pending, why.props.get("list") or why._props

    log, pending, _ = shown(build, look)
    said = "step 2: side left → right, RCOF 0.2000 → –. seen so"
    assert said in log
    assert said not in pending
    assert "step 3: side left → right, RCOF 0.2000 → –" in pending
    change = {"step": 2, "what": "side", "value": "left", "why": "I saw it"}
    assert asked[-1][2] == {"change": change, "keep": True}
    assert study.done == [("old", "new")] * 2
    assert pages[0].pending is None


@pytest.mark.parametrize(
    ("kind", "edits", "plot", "offered"),
    [("walking", [], True, True), ("readings", [], True, False), ("walking", [EDIT], True, False),
     ("walking", [], False, False)],
)  # fmt: skip
def test_a_run_without_steps_may_be_excluded_once(
    session, study, monkeypatch, kind, edits, plot, offered
):
    view = VIEW | {"steps": [], "chosen": None, "kind": kind, "edits": edits, "run": 3,
                   "plot": {"panels": []} if plot else None, "whole": None}  # fmt: skip
    _, build = built(session, study, view)
    asked = answering(monkeypatch, session, trial_view=view)

    async def look(elements):
        wanted = session.text("trials.exclude_run")
        made = [e for e in elements if isinstance(e, ui.button) and e.text == wanted]
        if made:
            press(made[0])
            await until(lambda: asked)
        return len(made)

    assert shown(build, look) == offered
    if offered:
        assert asked[0][2] == {"change": {"step": 3, "what": "exclude"}, "keep": False}


def test_a_mark_that_is_moved_is_tried_at_its_time_and_another_step_forgets_it(
    session, study, monkeypatch
):
    pages, build = built(session, study, VIEW)
    asked = answering(monkeypatch, session, trial_view=VIEW | {"edits": [EDIT]})

    async def look(_):
        page = pages[0]
        await page._drag_mark(SimpleNamespace(args={"time": 1.23456, "id": "contact"}))
        pending = page.pending
        revision = page.plot._props["revision"]
        await page.choose_step(1)
        return pending, page.pending, page.plot._props["revision"] - revision

    pending, after, drawn = shown(build, look)
    assert pending == {"step": 2, "what": "contact", "value": "1.2346 s"}
    assert (after, drawn) == (None, 1)
    assert asked[1][1] == (study.asked, "b.csv", 1)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "RCOF 0.2100 ± 0.0130"),
        ({"rcof_uncertainty": None}, "RCOF 0.2100"),
        ({"rcof": None, "peak_slipping_speed": 0.4321}, "peak slipping speed 0.432 m/s"),
        ({"outcome": "slid", "slip_distance": 0.0834}, "RCOF 0.2100 ± 0.0130, slid, 83 mm"),
        ({"rcof": None, "reason": "short"}, "short"),
        ({"rcof": None}, "–"),
    ],
)
def test_a_step_says_its_numbers_or_why_it_has_none(changes, said):
    assert _step_words(STEP | changes) == said


def test_an_edit_says_what_it_did():
    assert _edit_words(EDIT | {"quantity": ""}) == "side left → right"
    speed = EDIT | {"quantity": "speed", "number_after": 0.25}
    assert _edit_words(speed) == "side left → right, speed (m/s) 0.2000 → 0.2500"


# a folder


def card(number, verdict="accepted", **more):
    return {"file": f"{number}.csv", "verdict": verdict, "svg": "", "numbers": ["one", "two", "3"],
            "noted": "dry", "edits": 0, "reasons": ["why so", "and so"], **more}  # fmt: skip


def table_of(title, **more):
    return {"title": title, "columns": ["a"], "rows": [["1"], ["2"]], "below": ["", ""],
            "notes": [f"note of {title}"], **more}  # fmt: skip


def folder(cards, **more):
    counts = Counter(each["verdict"] for each in cards)  # of those that there are
    return {"cards": cards, "lead": "The lead", "notes": ["a note"], "counts": dict(counts),
            "summary": table_of("Summary"), "findings": [table_of("First"), table_of("Second")],
            "study": [table_of("Third")], **more}  # fmt: skip


def opened(session, study, look, view, monkeypatch, went=None):
    asked = answering(monkeypatch, session, protocols={"level_walking": "Walking"},
                      folder_view=view)  # fmt: skip

    async def show(name):
        if went is not None:
            went.append(name)

    async def ready(elements):
        await until(lambda: len(asked) > 1)
        await asyncio.sleep(0.05)
        found = look(elements)
        return await found if asyncio.iscoroutine(found) else found

    made = []
    found = shown(lambda: made.append(FolderView(session, study, lambda: None, show)), ready)
    return found, asked, made[0]


def test_a_folder_shows_a_card_a_trial_its_verdicts_and_its_statistics(session, study, monkeypatch):
    cards = [card(1), card(2, "refused", edits=2), card(3, "caution"), card(4)]
    went = []

    async def look(elements):
        made = [each for each in elements if "trial-card" in each.classes]
        words = [words_of(each.descendants()) for each in made]
        chips = [each.text for each in elements if "chip" in each.classes]
        folds = [each for each in elements if isinstance(each, ui.expansion)]
        folded = words_of(folds[0].descendants())
        press(made[2])
        press(next(each for each in elements if "is-refused" in each.classes and
                   "chip" in each.classes))  # fmt: skip
        await asyncio.sleep(0.02)
        alone = [words_of(each.descendants())[0] for each in elements
                 if "trial-card" in each.classes]  # fmt: skip
        return words, chips, folded, words_of(elements), alone

    found, asked, page = opened(session, study, look, folder(cards), monkeypatch, went)
    words, chips, folded, whole, alone = found
    text = session.text
    assert words == [
        ["1.csv", "one · two", "dry", ""],
        ["2.csv", "one · two", "dry", f"{text('trials.edited', count=2)}; why so"],
        ["3.csv", "one · two", "dry", "why so"], ["4.csv", "one · two", "dry", ""],
    ]  # fmt: skip
    assert chips == [
        f"{count} {text(f'trials.{key}')}"
        for key, count in (("every", 4), ("accepted", 2), ("caution", 1), ("refused", 1))
    ]
    assert went == ["3.csv"]
    assert alone == ["2.csv"]
    assert study.files == [f"{k}.csv" for k in range(1, 5)]
    assert [said for said in ("Second", "Third") if said in folded] == ["Second", "Third"]
    assert "Summary" not in folded
    assert "First" not in folded
    for said in ("The lead", "a note", "Summary", "First", study.command):
        assert said in whole
    assert [name for name, *_ in asked] == ["protocols", "folder_view"]
    assert page.protocol.options == {"level_walking": "Walking (level_walking)"}


@pytest.mark.parametrize("count", [60, 61, 130])
def test_of_many_cards_the_first_are_shown_and_more_on_demand(session, study, monkeypatch, count):
    cards = [card(k) for k in range(count)]

    async def look(elements):
        def number():
            return sum("trial-card" in each.classes for each in elements)

        seen = [number()]
        assert sum("chip" in each.classes for each in elements) == 2  # all, and accepted

        def more():
            wanted = session.text("trials.more", count=count - seen[-1])
            return [e for e in elements if isinstance(e, ui.button) and e.text == wanted]

        while more() and len(seen) < 5:
            press(more()[0])
            await asyncio.sleep(0.02)
            seen.append(number())
        return seen

    seen, *_ = opened(session, study, look, folder(cards), monkeypatch)
    shown_at_once = trials_folder.SHOWN
    assert seen == [min(count, shown_at_once * k) for k in range(1, 2 + (count - 1) // 60)]


def test_how_a_folder_is_analysed_is_asked_anew_only_where_it_changed(session, study, monkeypatch):
    async def look(elements):
        (names,) = (each for each in elements if isinstance(each, ui.input))
        (merge,) = (each for each in elements if isinstance(each, ui.checkbox))
        merge.value = True
        await asyncio.sleep(0.05)
        names.value = " {shoe} "
        press(names, "blur")
        await asyncio.sleep(0.05)
        press(names, "blur")
        await asyncio.sleep(0.05)

    _, asked, _ = opened(session, study, look, folder([card(1)]), monkeypatch)
    given = [args[0] for name, args, _ in asked if name == "folder_view"]
    assert [each["merge_spelling"] for each in given] == [False, True, True]
    assert [each["names"] for each in given] == ["", "", "{shoe}"]


def test_a_folder_that_can_not_be_analysed_offers_to_try_again(session, study, monkeypatch):
    told = []
    monkeypatch.setattr(session, "tell", told.append)
    error = InputError("no trials")

    def look(elements):
        return session.text("trials.again") in words_of(elements)

    offered, *_ = opened(session, study, look, error, monkeypatch)
    assert offered
    assert told == [error]


@pytest.mark.parametrize("below", [["", ""], ["p = 0.1", ""], ["only one"]])
def test_what_stands_below_rows_of_statistics_stands_beside_them(below):
    def look(elements):
        rows = [[words_of(each.descendants()) for each in row] for row in
                (list(line) for line in elements if line.tag == "tr")]  # fmt: skip
        return [[cell[0] for cell in row if cell] for row in rows], words_of(elements)

    given = table_of("T", below=below, cautions=["careful"])
    rows, words = shown(lambda: trials_folder._study_table(given), look)
    wanted = [["a"], ["1"], ["2"]]
    if any(below):
        wanted[0].append("")
        for row, said in zip(wanted[1:], below, strict=False):
            row.append(said)
    assert rows == wanted
    assert words[-2:] == ["careful", "note of T"]


def test_the_report_of_a_folder_is_queued_and_opened_when_it_is_done(
    session, study, monkeypatch, tmp_path
):
    page_file = tmp_path / "report.html"
    page_file.write_text("<p>The report</p>")

    async def look(elements):
        press(button(elements, session.text("trials.report")))
        await until(lambda: session.jobs.tasks)
        (task,) = session.jobs.tasks.values()
        task.answer, task.state = str(page_file), DONE
        await until(lambda: any(isinstance(each, ui.link) for each in elements))
        return task, [each.props["href"] for each in elements if isinstance(each, ui.link)]

    (task, links), *_ = opened(session, study, look, folder([card(1)]), monkeypatch)
    assert task.function == f"{trials_folder.WORK}:written_report"
    assert (tuple(task.arguments), task.about) == ((study.asked,), "walks")
    assert session.exchange.content[links[0].rpartition("/")[2]][0] == "<p>The report</p>"


# all folders


def test_folders_that_arrive_have_the_name_of_what_is_in_them(session):
    page: Any = SimpleNamespace(session=session)

    def settled(*parts):
        folder_ = session.project.inside("trials", "arriving 1")
        for part in parts:
            (folder_ / part).parent.mkdir(parents=True, exist_ok=True)
            (folder_ / part).write_text("x")
        return trials._Trials._settle_folder(page, "arriving 1")

    assert settled() == ""
    assert settled("mine/a.csv", "mine/b.csv") == "mine"
    assert sorted(p.name for p in session.project.inside("trials", "mine").iterdir()) == [
        "a.csv", "b.csv",
    ]  # fmt: skip
    assert settled("mine/a.csv") == "mine 2"
    unnamed = session.text("trials.unnamed")
    assert settled("a.csv") == unnamed
    assert settled("one/a.csv", "b.csv") == f"{unnamed} 2"
    assert studies(session.project) == sorted(["mine", "mine 2", unnamed, f"{unnamed} 2", "walks"])
    assert free_name(session.project, "mine") == "mine 3"
    assert free_name(session.project, "new") == "new"


@pytest.mark.parametrize("merged", [False, True])
def test_a_folder_says_the_command_that_does_the_same(session, study, merged):
    study.settings |= {"merge_spelling": merged, "names": "{shoe}" if merged else ""}
    wanted = 'underfoot trials analyse "trials/walks" --protocol level_walking'
    wanted += ' --out "results/walks trials"'
    assert study.command == wanted + ' --names "{shoe}" --merge-spelling' * merged
    # a shell takes what stands between these quotes as it is
    study.name = "Größe's walks"
    assert shlex.split(study.command)[3] == "trials/Größe's walks"


@pytest.mark.parametrize("query", [{}, {"study": "walks"}, {"study": "walks", "trial": "b.csv"},
                                   {"study": "gone"}, {"example": "slips"}])  # fmt: skip
def test_the_address_of_a_folder_or_a_trial_opens_it(tmp_path, monkeypatch, query):
    session = session_of(tmp_path, **query)
    session.project.inside("trials", "walks").mkdir(parents=True)
    did = []

    async def made(page, *args):
        did.append(("show", *args))

    async def example(page):
        did.append(("example",))

    monkeypatch.setattr(trials._Trials, "show", made)
    monkeypatch.setattr(trials._Trials, "make_example", example)
    monkeypatch.setattr(trials._Trials, "overview", lambda page: did.append((page.study.name,)))
    monkeypatch.setattr(trials._Trials, "choose", lambda page: did.append(("choose",)))

    async def look(_):
        await asyncio.sleep(0.05)

    shown(lambda: trials.build(session), look)
    assert did == {
        "": [("choose",)], "study": [("walks",)], "study trial": [("show", "b.csv")],
        "example": [("choose",), ("example",)],
    }[" ".join(key for key in query if query[key] != "gone")]  # fmt: skip


def test_the_example_of_trials_is_analysed_as_slips(session, monkeypatch):
    asked = answering(monkeypatch, session, example=None)
    opened_as = []
    page: Any = SimpleNamespace(session=session, open=opened_as.append)
    asyncio.run(trials._Trials.make_example(page))
    name = session.text("trials.example")
    assert opened_as == [name]
    assert asked[0][1] == (str(session.project.inside("trials", name)),)
    assert TrialsFolder(session.project, name).settings["protocol"] == "report_g6"


# plots


def test_a_small_plot_has_its_curve_on_the_scale_of_its_sheet():
    sheet: Any = SimpleNamespace(x_range=(0.0, 2.0), y_range=(0.0, 4.0), line=1.0)
    tile: Any = SimpleNamespace(
        x=np.array([-1.0, 0, 1, 2, 3]), y=np.array([1.0, 0, 2, 8, 1]), verdict="caution",
        marks=[(1.0, 2.0), (np.nan, 1.0)],
    )  # fmt: skip
    svg = trials_plots.tile_svg([tile], sheet)
    wide, high = trials_plots.TILE
    assert f'class="limit" points="0.0,{high * 0.75:.1f} {wide:.1f},{high * 0.75:.1f}"' in svg
    middle = f"{wide / 2:.1f},{high / 2:.1f}"
    assert f'class="caution" points="0.0,{high:.1f} {middle} {wide:.1f},0.0"' in svg
    assert svg.count("<circle") == 1
    assert f'cx="{wide / 2:.1f}" cy="{high / 2:.1f}"' in svg
    many: Any = SimpleNamespace(x=np.linspace(0, 2, 400), y=np.ones(400), verdict="", marks=[])
    points = trials_plots.tile_svg([many], sheet).rpartition('points="')[2].split()
    assert len(points) == trials_plots.TILE_POINTS


@pytest.mark.parametrize(
    ("values", "low", "high"),
    [([1.0, 3.0], 0.0, 3.0), ([-2.0, 3.0], -2.0, 3.0), ([None, 0.5], 0.0, 0.5),
     ([9.0, 0.1], 0.0, 5.0), ([], 0.0, 1e-9)],
)  # fmt: skip
def test_a_panel_reaches_from_0_or_its_lowest_to_its_highest_or_what_it_shows_at_most(
    values, low, high
):
    lines = [{"low": values[:1], "high": values[1:]}]
    panel = trials_plots._panel("force", lines, 5.0)
    assert (panel["low"], panel["high"]) == (low, high)


def test_events_of_a_step_lie_where_they_may_be_moved():
    seen = Envelope(0.0, 0.1, np.array([10.0, 20.0]), np.array([30.0, 20.0]))
    idle = Envelope(0.0, 0.1, np.zeros(2), np.zeros(2))
    plates = {
        name: SimpleNamespace(start=0.2, end=2.0, rate=100.0, envelope=lambda *_, e=each: e)
        for name, each in (("P", seen), ("Q", idle), ("R", Envelope(0, 0.1, *np.full((2, 1), 900))))
    }
    speed = SimpleNamespace(envelope=lambda *_: seen)
    signals: Any = SimpleNamespace(force=plates, heel_speed={"left": speed})
    heel = {"start": 0.1, "end": None, "peak_time": 0.2, "peak": 1.5}
    curve = {"number": 2, "ratio": [0.1, 0.2, 0.3], "normal": [600.0, 50.0, None],
             "time": [0.0, 0.1, 0.2], "peak": 0.5, "peak_time": 0.05, "gate": 0.02}  # fmt: skip
    record: Any = SimpleNamespace(curves={"slipping": [curve], "heel": [heel]})
    step: Any = SimpleNamespace(
        number=2, contact=0.4, toe_off=1.0, plate="P", verdict="accepted", by_hand=(),
        judged_for_slip=True,
    )  # fmt: skip
    plot = trials_plots.step_plot(record, step, signals)
    assert (plot["begin"], plot["end"]) == pytest.approx((0.2, 1.15))
    assert plot["spacing"] == pytest.approx(0.01)
    force, ratio, speeds = plot["panels"]
    assert [line["name"] for line in force["lines"]] == ["P", "R"]
    assert (force["lines"][0]["low"], force["lines"][0]["high"]) == ([10, 20], [30, 20])
    assert force["lines"][1]["high"] == []
    assert ratio["lines"][0]["x"] == pytest.approx([0.4, 0.5, 0.6])
    assert ratio["lines"][0]["low"] == [0.1, None, None]
    assert ratio["high"] == pytest.approx(0.1)
    assert speeds["id"] == "speed"
    events = {each["id"]: each for each in plot["events"]}
    assert events["contact"] == {
        "id": "contact",
        "time": 0.4,
        "least": 0.2,
        "most": pytest.approx(0.98),
    }
    assert events["toe off"] == {
        "id": "toe off",
        "time": 1.0,
        "least": pytest.approx(0.42),
        "most": 2.0,
    }
    assert events["gate"] == {"id": "gate", "time": pytest.approx(0.42), "panel": 1}
    assert events["rcof"] == {
        "id": "rcof", "time": pytest.approx(0.45), "panel": 1, "value": 0.5,
    }  # fmt: skip
    assert events["slip start"] == {"id": "slip start", "time": 0.5, "panel": 2}
    peak = {"id": "slip peak", "time": pytest.approx(0.6), "panel": 2, "value": 1.5}
    assert events["slip peak"] == peak
    assert "slip end" not in events
    step.by_hand = ("exclude",)
    still = trials_plots.step_plot(record, step, signals)["events"][:2]
    assert all("least" not in each for each in still)
    assert plot["bands"] == [
        {"id": 2, "verdict": "accepted", "begin": 0.4, "end": 1.0},
    ]  # fmt: skip


def test_a_run_without_steps_has_the_panels_of_its_kind_and_its_window():
    curve = {"time": [0.0, 1.0], "ratio": [0.2, 0.3], "normal": [5.0, 6.0], "shear": [1.0, 2.0],
             "begin": 0.25}  # fmt: skip
    plot = trials_plots.run_plot(SimpleNamespace(curves={"slide": [curve]}))  # type: ignore
    assert plot is not None
    assert [panel["id"] for panel in plot["panels"]] == ["force", "ratio"]
    assert [line["name"] for line in plot["panels"][0]["lines"]] == ["normal", "shear"]
    assert (plot["begin"], plot["end"], plot["bands"]) == (0.0, 1.0, [])
    assert plot["events"] == [{"id": "begin", "time": 0.25}]
    assert trials_plots.run_plot(SimpleNamespace(curves={})) is None  # type: ignore


@pytest.mark.parametrize(
    ("text", "expected", "refused"), [("new", "old", False), ("new", "other", True)]
)
def test_edits_are_put_back_only_where_nobody_changed_them(
    monkeypatch, text, expected, refused, tmp_path
):
    written = []
    monkeypatch.setattr(work_trials, "edit_text", lambda _: "old")
    monkeypatch.setattr(work_trials, "write_edit_text", lambda *given: written.append(given))
    if refused:
        with pytest.raises(InputError):
            work_trials.put_edits({"folder": str(tmp_path)}, text, expected)
        return
    work_trials.put_edits({"folder": str(tmp_path)}, text, expected)
    assert written == [(tmp_path, "new")]


def test_an_edit_by_its_time_is_of_the_step_that_is_nearest():
    steps = [SimpleNamespace(number=k, contact=t) for k, t in ((1, 0.5), (2, 2.0), (3, 3.1))]
    record: Any = SimpleNamespace(steps=steps)

    def number(step):
        edit: Any = SimpleNamespace(step=step)
        return work_trials._number(edit, record)

    assert [number(step) for step in (3, 0.1, 1.9, 2.7)] == [3, 1, 2, 3]
    record.steps = []
    assert number(2.0) == 2


def test_numbers_of_a_trial_are_in_their_units():
    record: Any = SimpleNamespace(
        main={"slip": True, "crossed_array": False, "slip_distance": 0.0834}
    )
    slip, crossed, distance = work_trials._numbers(record)
    assert slip.endswith(" yes")
    assert crossed.endswith(" no")
    assert distance.endswith(" 83.4 mm")
