"""Lengths that a recording may have: each limit just below and just above, and how it is told."""

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.trials.readers.draft import RecordingDraft, _fitting, _in_words

STEPS = np.linspace(0.0, 1.0, 101)
"""Of a marker that goes on evenly: one in a hundred of its places is left out at either end."""


def recording(**paths):
    made = RecordingDraft(b"", "a.dat")
    made.rate = 100.0
    for name, path in paths.items():
        made.marker(name, np.column_stack([path, 0 * path + 0.01, 0 * path + 0.02]))
    return made


@pytest.mark.parametrize(("size", "fits"), [(0.0301, True), (0.0299, False), (299.9, True),
                                            (300.1, False)])  # fmt: skip
def test_markers_are_apart_as_a_body_is_but_for_one_place_in_a_hundred(size, fits):
    along = size / 1.98 * STEPS + 1e-6
    made = recording(A=along, B=-along)
    if fits:
        made.trial("x")
        return
    with pytest.raises(DataError, match="the unit of length can't be right") as told:
        made.trial("x")
    assert ("29.9 mm" in str(told.value)) == (size < 1)


def test_one_marker_and_markers_of_two_places_have_no_size():
    recording(A=1e-5 * STEPS + 1e-6).trial("x")
    few = np.full(101, np.nan)
    few[:2] = 1e-3, 2e-3
    recording(A=few, B=2 * few).trial("x")
    few[2] = 3e-3
    with pytest.raises(DataError, match="the markers are"):
        recording(A=few, B=2 * few).trial("x")


@pytest.mark.parametrize("side", ["L", "R"])
@pytest.mark.parametrize(("size", "fits"), [(0.0601, True), (0.0599, False), (0.799, True),
                                            (0.801, False)])  # fmt: skip
def test_a_foot_is_as_long_as_a_foot(side, size, fits):
    heel = 2 * STEPS
    made = recording(**{f"{side}HEE": heel, f"{side}TOE": heel + size})
    if fits:
        made.trial("x")
        return
    with pytest.raises(DataError, match=f"{side}HEE and {side}TOE are"):
        made.trial("x")


def test_numbers_without_a_unit_are_millimetres_where_one_in_ten_is_above_twenty():
    numbers = np.full((2, 101), 0.0)
    numbers[0], numbers[1] = np.arange(101) / 100, np.nan
    for highest, unit in ((20.01, 1e-3), (19.99, 1.0)):
        made = recording()
        assert made.length_unit("", -highest / 0.9 * numbers) == unit
        assert made.metres == unit
        assert len(made.notes) == 1


def test_lengths_in_words():
    assert [_in_words(size) for size in (0.1, 0.0999, 2.0, 1e-3)] == [
        "0.1 m", "99.9 mm", "2 m", "1 mm"
    ]  # fmt: skip
    for number, unit in ((250.0, "mm"), (25.0, "cm"), (0.25, "m"), (9.0, "inch")):
        assert str(_fitting(number, 0.06, 0.8)) == f"As {unit} it would fit"
    assert _fitting(0.0, 0.06, 0.8) == "Check the markers"
    assert _fitting(np.nan, 0.06, 0.8) == "Check the markers"
