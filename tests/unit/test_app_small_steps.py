"""Steps of the app with a plain right answer: previews by odds, lines that were torn, sliders."""

import json
from types import SimpleNamespace
from typing import Any, cast

import pytest

from underfoot.app.project import append_line
from underfoot.app.run_preview import _moved
from underfoot.app.work_table import _row


def test_a_preview_that_moved_nothing_says_what_the_run_said():
    assert _moved(120.0, 90.0, 90.0, (500.0, 500.0)) == pytest.approx(120.0)


def test_a_preview_moves_the_odds_of_the_share_and_stays_below_what_carries_all():
    """Run 250 of 500 N (odds 1), preview from 100 (odds 1/4) to 200 N (odds 2/3): odds 8/3."""
    assert _moved(250.0, 100.0, 200.0, (500.0, 500.0)) == pytest.approx(500 * (8 / 3) / (11 / 3))
    assert _moved(450.0, 100.0, 490.0, (500.0, 500.0)) < 500.0
    # of another load: the same share of it
    assert _moved(250.0, 100.0, 120.0, (500.0, 600.0)) == pytest.approx(300.0)


@pytest.mark.parametrize(("run", "before", "after"), [(0.0, 1.0, 2.0), (1.0, 0.0, 2.0)])
def test_a_preview_of_nothing_is_the_preview_itself(run, before, after):
    assert _moved(run, before, after, (10.0, 10.0)) == after
    assert _moved(3.0, 2.0, 0.0, (10.0, 10.0)) == 0.0


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
