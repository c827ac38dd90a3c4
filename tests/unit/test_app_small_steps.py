"""Steps of the app with a plain right answer: previews by odds, torn lines, undo, who is shown."""

import asyncio
import json
from types import SimpleNamespace
from typing import Any, cast

import pytest

from underfoot.app import session as session_module
from underfoot.app.pages.compare import _Compare
from underfoot.app.pages.trials_trial import TrialView
from underfoot.app.project import Project, append_line
from underfoot.app.run_preview import _move_number
from underfoot.app.session import SETTLED, Session
from underfoot.app.text import Text
from underfoot.app.work_table import _row
from underfoot.core import InputError


def test_a_preview_that_moved_nothing_says_what_the_run_said():
    assert _move_number(120.0, 90.0, 90.0, (500.0, 500.0)) == pytest.approx(120.0)


def test_a_preview_moves_the_odds_of_the_share_and_stays_below_what_carries_all():
    """Run 250 of 500 N (odds 1), preview from 100 (odds 1/4) to 200 N (odds 2/3): odds 8/3."""
    assert _move_number(250.0, 100.0, 200.0, (500.0, 500.0)) == pytest.approx(
        500 * (8 / 3) / (11 / 3)
    )
    assert _move_number(450.0, 100.0, 490.0, (500.0, 500.0)) < 500.0
    # of another load: the same share of it
    assert _move_number(250.0, 100.0, 120.0, (500.0, 600.0)) == pytest.approx(300.0)


@pytest.mark.parametrize(("run", "before", "after"), [(0.0, 1.0, 2.0), (1.0, 0.0, 2.0)])
def test_a_preview_of_nothing_is_the_preview_itself(run, before, after):
    assert _move_number(run, before, after, (10.0, 10.0)) == after
    assert _move_number(3.0, 2.0, 0.0, (10.0, 10.0)) == 0.0


def test_a_line_is_added_after_one_that_was_torn_and_after_a_whole_one(tmp_path):
    path = tmp_path / "log.jsonl"
    append_line(path, {"a": 1})
    append_line(path, {"b": "ü"})
    assert [json.loads(line) for line in path.read_text("utf-8").splitlines()] == [
        {"a": 1}, {"b": "ü"},
    ]  # fmt: skip
    with path.open("ab") as stream:
        stream.write(b'{"torn":')
    append_line(path, {"c": 3})
    *_, torn, last = path.read_text("utf-8").splitlines()
    assert (torn, json.loads(last)) == ('{"torn":', {"c": 3})


@pytest.mark.parametrize("problem", ["", "unreadable"])
def test_a_row_of_a_table_shows_inputs_only_of_a_case_that_is_one(problem):
    inputs = SimpleNamespace(
        problem=problem,
        texts={"motion.speed": "0.5 m/s", "shoe.sole.file": "/folder/sole.stl"},
        numbers={"motion.speed": 0.5},
    )
    row = _row("a", cast(Any, inputs), None, ["motion.speed", "shoe.sole.file"])
    if problem:
        assert "motion.speed" not in row
        assert row["state"] == "unreadable"
    else:
        assert (row["motion.speed"], row["motion.speed_text"]) == (0.5, "0.5 m/s")
        assert row["shoe.sole.file"] == "sole.stl"
        assert row["state"] == "not_computed"


def test_a_state_is_undone_back_to_the_first_since_the_variant_was_there(tmp_path):
    """A variant that was removed and brought back begins anew: nobody undoes to nothing."""
    project, told = Project(tmp_path), []

    def step(what, *more):
        getattr(project, what)("a", *more)
        told.append((project.can_undo("a"), project.can_redo("a")))

    step("add", "one")
    step("write", "two")
    step("undo")
    step("redo")
    assert told == [(False, False), (True, False), (False, True), (True, False)]
    project.remove("a")
    told.clear()
    step("restore")
    step("undo")
    step("write", "three")
    step("write", "four")
    step("undo")
    step("undo")
    step("undo")
    assert told == [
        (False, False), (False, False), (True, False), (True, False), (True, True), (False, True),
        (False, True),
    ]  # fmt: skip
    assert project.text("a") == "two"


def following(monkeypatch):
    """Return a page that follows a state: what it shows, how to look at it, and what was shown."""
    clock, state, busy, shows = [100.0], ["one"], [False], []
    timers: list[Any] = []
    monkeypatch.setattr(session_module, "time", SimpleNamespace(monotonic=lambda: clock[0]))
    ui = SimpleNamespace(timer=lambda _, look: timers.append(look))
    monkeypatch.setattr(session_module, "ui", ui)
    take = Session.follow(
        cast(Any, None), lambda: state[0], lambda: shows.append(state[0]), lambda: busy[0]
    )

    def look():
        asyncio.run(timers[0]())
        return list(shows)

    return SimpleNamespace(clock=clock, state=state, busy=busy, look=look, take=take)


def test_a_page_is_shown_anew_once_when_another_one_did_something_and_it_is_not_busy(monkeypatch):
    page = following(monkeypatch)
    assert page.look() == []
    page.state[0], page.busy[0] = "two", True
    assert page.look() == []
    page.busy[0] = False
    assert page.look() == page.look() == ["two"]


@pytest.mark.parametrize(
    ("other", "waits", "shown"),
    [(False, False, []), (True, False, ["own"]), (True, True, ["other", "own"]),
     (False, True, [])],
)  # fmt: skip
def test_what_a_page_did_itself_is_not_shown_anew_but_what_another_one_did_before_is(
    monkeypatch, other, waits, shown
):
    """``waits``: the page was filled anew just before, so what a person did may be of the old."""
    page = following(monkeypatch)
    if other:
        page.state[0] = "other"
    if waits:
        page.look()
    page.take(lambda: page.state.__setitem__(0, "own"))
    assert page.look() == shown
    page.clock[0] += SETTLED + 1
    page.take(lambda: page.state.__setitem__(0, "again"))
    assert page.look() == shown
    page.state[0] = "of nobody"
    page.take()
    assert page.look() == shown


@pytest.mark.parametrize("refused", [False, True])
def test_an_edit_is_tried_without_being_written_and_written_when_it_is_kept(refused):
    asked, told, filled, change = [], [], [], {"what": "onset", "value": "0.2 s"}

    async def ask(function, *given, change, keep):
        asked.append((given, change, keep))
        if refused:
            raise InputError("no such step")
        return {"file": "a", "chosen": 1, "before": "old", "after": "new"}

    async def discard():
        told.append("discarded")

    page: Any = SimpleNamespace(
        session=SimpleNamespace(ask=ask, tell=told.append), pending=None, _fill=filled.append,
        study=SimpleNamespace(asked="asked", done=[], undone=["one"]), _discard=discard,
        view={"file": "a", "chosen": 1},
    )  # fmt: skip
    page._ask_change = lambda *given, **more: TrialView._ask_change(page, *given, **more)
    asyncio.run(TrialView.try_change(page, change))
    assert page.pending == (None if refused else change)
    asyncio.run(TrialView._keep_edit(page, change))
    assert asked == [(("asked", "a", 1), change, keep) for keep in (False, True)]
    assert page.study.done == ([] if refused else [("old", "new")])
    assert page.study.undone == (["one"] if refused else [])
    assert page.pending is None
    assert len(filled) == (0 if refused else 2)
    assert told.count("discarded") == 2 * refused


@pytest.mark.parametrize(
    ("chosen", "current", "refused"),
    [(["a", "b"], {"a", "b"}, ""), (["a"], {"a"}, "two"), (["a", "b", "c"], {"a", "b"}, "two"),
     (["a", "b"], {"a"}, "anew"), (["a", "b"], {"b"}, "anew"), (["a", "b"], set(), "anew")],
)  # fmt: skip
def test_equal_land_is_asked_for_two_variants_whose_results_are_of_their_files(
    chosen, current, refused
):
    class Asked(Exception):
        pass

    async def ask(function, *files):
        raise Asked(*files)

    project = SimpleNamespace(is_current=lambda name: name in current, path=lambda name: name)
    session = SimpleNamespace(project=project, ask=ask)
    page: Any = SimpleNamespace(
        session=session, choice=SimpleNamespace(value=chosen), text=Text("en")
    )
    with pytest.raises(InputError if refused else Asked) as told:
        asyncio.run(_Compare._equal_land(page))
    if refused:
        remedy = {"two": "compare.equal_two", "anew": "compare.equal_anew"}[refused]
        lacks = next((name for name in chosen if name not in current), "")
        assert page.text(remedy, name=lacks) in str(told.value)
    else:
        assert told.value.args == ("a", "b")
