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


def test_the_density_of_a_scan_is_as_measured_and_goes_on_with_its_power_law(tmp_path):
    made = self_affine(128, 4e-6, 2e-6, 0.7, 512e-6, 32e-6, 4)
    write_surface(made, tmp_path / "map.sdf")
    scan = read_scan(tmp_path / "map.sdf", cutoff=0.08e-3)
    known = scan.spectrum
    low, high = known.reliable
    inside = (known.wavenumber > low) & (known.wavenumber < high)
    np.testing.assert_allclose(
        scan.density(known.wavenumber[inside]), known.density[inside], rtol=1e-9
    )
    beyond = scan.density(high * np.array([2.0, 4.0]))
    assert beyond[1] / beyond[0] == pytest.approx(2 ** (-2 * (1 + scan.hurst.value)))
    longer = scan.density(low / np.array([2.0, 4.0]))
    steep = 2 ** (2 * (1 + scan.hurst.value))
    assert longer[1] / longer[0] == pytest.approx(1.0 if scan.roll_off else steep)
