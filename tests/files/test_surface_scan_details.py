"""Details of scans with a plain right answer: which number, which heading, how small a grid."""

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.surface import HeightMap, self_affine, write_surface
from underfoot.surface.read import _units
from underfoot.surface.scan import read_scan


@pytest.mark.parametrize(("width", "areal"), [(80, True), (50, False)])
def test_a_strip_narrower_than_the_cut_off_is_told_by_its_lines(tmp_path, width, areal):
    """Grooves across x on 1.6 mm by 0.32 or 0.2 mm, cut-off 0.25 mm."""
    x = 4e-6 * np.arange(400)
    wave = 2e-6 * np.sin(2 * np.pi * x / 50e-6)
    rough = 0.05e-6 * np.random.default_rng(3).normal(size=(400, width))
    write_surface(HeightMap(wave[:, None] + rough, 4e-6), tmp_path / "strip.sdf")
    rq = read_scan(tmp_path / "strip.sdf", cutoff=0.25e-3).values["rq"]
    assert rq.source.startswith("ISO 25178") == areal
    assert rq.value == pytest.approx(2e-6 / np.sqrt(2), rel=0.15)  # short waves are filtered


def test_columns_take_the_units_of_the_line_that_stands_nearest():
    assert _units(("Scan in nm", "x (mm), z (um)"), "a file") == ["mm", "um"]
    assert _units(("x (mm), z (um)", "all in nm"), "a file") == ["nm"]
    assert _units(("x (mm), z (um)", "Length 12.5 mm"), "a file") == ["mm", "um"]
    assert _units(("x (mm), z (um)", "x (mm), z (um)", "without a unit"), "a file") == ["mm", "um"]


@pytest.mark.parametrize("shape", [3, (4, 3), (3, 8)])
def test_a_surface_of_waves_has_at_least_four_points_a_side(shape):
    with pytest.raises(InputError, match="4 x 4 or more"):
        self_affine(shape, 1e-6, 1e-6, 0.8, 4e-6, 2e-6, 1)


def test_four_points_a_side_are_enough():
    assert self_affine(4, 1e-6, 1e-6, 0.8, 4e-6, 2e-6, 1).heights.std() == pytest.approx(1e-6)
