"""Decisions at the edge: even positions, a counter of rows, words below the numbers."""

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.surface.filter import within_cutoffs
from underfoot.surface.heights import HeightMap, profile_from_positions
from underfoot.surface.read import _is_numbered, _plain_numbers, read_numbers
from underfoot.surface.spectrum import ProfileSpectrum, isotropic_from_profile


@pytest.mark.parametrize(("off", "even"), [(0.008, True), (0.014, False)])
def test_positions_are_even_to_a_hundredth_of_their_spacing(off, even):
    places = 1e-6 * np.arange(101.0)
    places[50] += off * 1e-6
    if even:
        assert profile_from_positions(places, np.sin(places * 1e5)).spacing == pytest.approx(1e-6)
    else:
        with pytest.raises(DataError, match="uneven"):
            profile_from_positions(places, np.sin(places * 1e5))


COUNT = np.arange(12.0)
WAVE = np.sin(COUNT)


@pytest.mark.parametrize(
    ("columns", "numbered"),
    [
        ((COUNT, 0.5 * COUNT, WAVE), True),  # counter, even positions, heights
        ((COUNT + 1, 0.5 * COUNT, WAVE), True),
        ((COUNT + 2, 0.5 * COUNT, WAVE), False),  # begins with neither 0 nor 1
        ((COUNT, WAVE, WAVE), False),  # three columns without even positions
        ((COUNT, WAVE, WAVE, WAVE), True),  # a matrix beside its counter
        ((COUNT + 5, WAVE, WAVE, WAVE), False),
        ((2 * COUNT, 0.5 * COUNT, WAVE), False),
        ((COUNT, 0.5 * COUNT), False),
    ],
)
def test_a_counter_of_rows_is_told_from_positions(columns, numbered):
    assert _is_numbered(np.column_stack(columns), 1) is numbered


@pytest.mark.parametrize("rows", [2, 3, 5])
def test_words_below_the_numbers_are_left_out(tmp_path, rows):
    path = tmp_path / "a.txt"
    path.write_text("".join(f"{k} {k * k}\n" for k in range(rows)) + "end of data\n")
    read = read_numbers(path)
    assert read.rows.tolist() == [[k, k * k] for k in range(rows)]
    assert any(note.endswith(": 1") for note in read.notes)


def test_a_profile_goes_on_by_the_power_of_its_last_half_decade():
    """A spectrum that falls by q^-2, and by q^-5 over a little more than the last half decade."""
    q = np.geomspace(1e3, 1e6, 3000)
    kink = 1e6 / np.sqrt(10.0) / 1.15
    density = np.where(q < kink, (q / kink) ** -2.0, (q / kink) ** -5.0)
    shown = isotropic_from_profile(ProfileSpectrum(q, 1e-18 * density, (1e3, 1e6)))
    (power,) = [note.split()[-4] for note in shown.notes if "extrapolated" in note]
    assert float(power) == pytest.approx(-5.0, abs=0.02)


@pytest.mark.parametrize(
    ("lines", "separator", "plain"),
    [
        (["1;2", "3;4.5"], ";", True), (["1,2", "3,4.5"], ",", True), (["1 2"], None, True),
        (["1,5;2"], ";", False), (['"1";2'], ";", False), (["1;a"], ";", False),
    ],
)  # fmt: skip
def test_plain_numbers_are_read_the_short_way_and_no_others(lines, separator, plain):
    assert (_plain_numbers(lines, separator) is not None) == plain


@pytest.mark.parametrize("unit", [1 - 1e-12, 1.0, 1 + 1e-12])
def test_a_side_of_one_and_a_half_cut_offs_is_cut_in_any_unit(unit):
    """120 places of 10 um are 1.5 cut-offs of 0.8 mm, whatever their product is rounded to."""
    heights = 1e-6 * np.random.default_rng(5).normal(size=(120, 120))
    level = HeightMap(heights, 1e-5 * unit)
    assert within_cutoffs(level, 0.8e-3, 0.8e-3).heights.shape == (40, 40)
