"""Matrices with positions that are even or not; lengths that just hold a cut-off."""

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.surface import HeightMap
from underfoot.surface.filter import holds, long_waves, short_waves
from underfoot.surface.read import read_map

UM = 1e-6
HEIGHTS = np.random.default_rng(3).normal(size=(6, 5)).round(3)
"""Lines of a file: 6 along y, 5 along x."""


def matrix(folder, x, y, heights=HEIGHTS, head="", corner="0"):
    """Write heights with their positions, or with those of x in the line above."""
    first = [head or f"{corner} " + " ".join(f"{each:.9g}" for each in x)]
    rows = [" ".join(f"{each:.9g}" for each in (at, *line))
            for at, line in zip(y, heights, strict=True)]  # fmt: skip
    path = folder / "map.txt"
    path.write_text("\n".join([*first, *rows, ""]))
    return path


def read(path, **more):
    return read_map(path, length_unit="mm", height_unit="um", **more)


@pytest.mark.parametrize("off", [0.0, 0.9e-3, -0.9e-3])
def test_positions_in_even_steps_are_left_out(tmp_path, off):
    """Each step within a thousandth of their mean, of either direction."""
    x, y = 0.2 * np.arange(5.0), 1.0 + 0.1 * np.arange(6.0)
    x[1:] += 0.2 * off * np.arange(4) / 3  # the mean moves with the last
    for along, across in ((x, y), (x[::-1], y), (x, y[::-1])):
        made = read(matrix(tmp_path, along, across))
        assert made.heights == pytest.approx(UM * HEIGHTS.T)
        assert made.spacings == pytest.approx((0.2e-3, 0.1e-3), rel=1e-3)
        assert any("positions: left out" in note for note in made.processing)
    assert read(matrix(tmp_path, np.arange(5.0), y)).spacings == pytest.approx((1e-3, 1e-4))
    given = read(matrix(tmp_path, x, y), spacing=5e-5)
    assert given.heights.shape == (5, 6)
    assert given.spacings == (5e-5, 5e-5)


@pytest.mark.parametrize("which", ["x", "y"])
def test_one_step_off_by_more_is_a_height(tmp_path, which):
    """One of the positions lies 1.5 thousandths of a step off, or they do not move."""
    for off in (1.5e-3, 1.0):
        x, y = 0.2 * np.arange(5.0), 1.0 + 0.1 * np.arange(6.0)
        (x if which == "x" else y)[2] += off * (0.2 if which == "x" else 0.1)
        made = read(matrix(tmp_path, x, y), spacing=5e-5)
        assert made.heights.shape == (6, 7)
        assert made.spacings == (5e-5, 5e-5)
    still = np.full(5, 0.2), 1.0 + 0.1 * np.arange(6.0)
    assert read(matrix(tmp_path, *still), spacing=5e-5).heights.shape == (6, 7)


def test_few_lines_and_a_plane_have_no_positions(tmp_path):
    x, y = 0.2 * np.arange(5.0), 0.1 * np.arange(6.0)
    small = [HEIGHTS[:4, :4], HEIGHTS[:3], HEIGHTS[:, :3]]
    shapes = []
    for heights in small:
        path = matrix(tmp_path, x[: heights.shape[1]], y[: heights.shape[0]], heights)
        shapes.append(read(path, spacing=5e-5).heights.shape)
    assert shapes == [(4, 4), (6, 4), (4, 7)]
    plane = 0.3 * np.arange(6.0)[:, None] + 0.7 * np.arange(5.0)
    assert read(matrix(tmp_path, x, y, plane), spacing=5e-5).heights.shape == (6, 7)
    along, across = HEIGHTS.copy(), HEIGHTS.copy()
    along[0], across[:, 0] = 0.7 * np.arange(5.0), 0.3 * np.arange(6.0)
    for one in (along, across):  # one line that is even is enough
        assert read(matrix(tmp_path, x, y, one), spacing=5e-5).heights.shape == (6, 7)


def test_positions_of_x_may_stand_in_the_heading(tmp_path):
    x, y = 0.2 * np.arange(5.0), 1.0 + 0.1 * np.arange(6.0)
    head = "y / x: " + " ".join(f"{each:g} mm" for each in x)
    made = read_map(matrix(tmp_path, x, y, head=head), height_unit="um", length_unit="mm")
    assert made.heights == pytest.approx(UM * HEIGHTS.T)
    assert made.spacings == pytest.approx((0.2e-3, 0.1e-3))


def test_a_length_holds_a_cut_off():
    assert holds(1.0, 1.0)
    assert holds(1.0 - 1e-12, 1.0)
    assert not holds(0.999, 1.0)


@pytest.mark.parametrize("side", [0, 1])
def test_sides_that_are_just_long_enough(side):
    """Of 8 cells and a cut-off of 8; where half a cut-off is dropped two heights must stay."""
    for ends, cutoff, shape in (("regression", 8 * UM, (8, 8)), ("drop", 6 * UM, (2, 2)),
                                ("drop", 4 * UM, (4, 4))):  # fmt: skip
        kept = list(shape)
        heights = np.random.default_rng(1).normal(size=(8, 8)) * UM
        made = HeightMap(heights, UM)
        long, short = long_waves(made, cutoff, ends), short_waves(made, cutoff, ends)
        assert [*long.heights.shape] == [*short.heights.shape] == kept
        rim = (8 - kept[0]) // 2
        inner = heights[rim : 8 - rim, rim : 8 - rim]
        assert long.heights + short.heights == pytest.approx(inner, abs=1e-18)
    size = [24, 24]
    for cells, ends, cutoff in (
        (7, "regression", 8 * UM),
        (7, "drop", 6 * UM),
        (8, "drop", 7.99 * UM),
    ):
        size[side] = cells
        heights = np.zeros(size)
        if ends == "drop" and cells == 8:
            assert long_waves(HeightMap(heights, UM), cutoff, ends).heights.shape[side] == 2
            continue
        with pytest.raises(DataError, match="too short for the cut-off"):
            long_waves(HeightMap(heights, UM), cutoff, ends)
