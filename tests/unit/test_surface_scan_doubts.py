"""What a scan holds beside its roughness: joints, heights that are no heights, a rounded length."""

import math
import re
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core.units import to_si
from underfoot.surface.heights import HeightMap, Profile
from underfoot.surface.prepare import held_level
from underfoot.surface.scan import Scan, _numbers, read_scan


def rough(count: int, spacing: float, seed: int = 4) -> np.ndarray:
    """Return heights (count,), m, of Rq 2 µm: Hurst exponent 0.8, flat above 200 µm."""
    noise = np.fft.rfft(np.random.default_rng(seed).standard_normal(count))
    q = 2 * np.pi * np.maximum(np.fft.rfftfreq(count, spacing), 1 / 200e-6)
    z = np.fft.irfft(noise * q**-1.3, count)
    return 2e-6 * z / z.std()


def scan_of(path, z: np.ndarray, spacing: float = 1e-6, unit: str = "mm") -> Scan:
    """Write a profile and return it as it is read; heights in µm with four decimals."""
    x = np.arange(len(z)) * spacing / to_si(f"1 {unit}", "m", where="unit")
    rows = "".join(f"{a:.9g};{1e6 * b:.4f}\n" for a, b in zip(x, z, strict=True))
    path.write_text(f"x [{unit}];z [um]\n{rows}")
    return read_scan(path)


@pytest.fixture(scope="module")
def plain() -> np.ndarray:
    return rough(12_500, 1e-6)


def test_the_error_is_that_of_the_sections_of_which_the_numbers_are(tmp_path, plain):
    """The five sections in the middle; the ends of the profile are ten times as rough."""
    place = np.arange(12_500) * 1e-6
    ends = plain * np.where((place < 3e-3) | (place > 9.5e-3), 10.0, 1.0)
    inside, whole = scan_of(tmp_path / "a.txt", plain), scan_of(tmp_path / "b.txt", ends)
    for name in ("rq", "rz"):
        assert whole.values[name].value == pytest.approx(inside.values[name].value, rel=0.02)
        found, true = whole.values[name].uncertainty, inside.values[name].uncertainty
        assert found == pytest.approx(true, rel=0.1)


@pytest.mark.parametrize("shape", ["step", "groove"])
def test_a_joint_within_a_scan_is_a_doubt_and_widens_the_error(tmp_path, plain, shape):
    """A step of 200 µm made 18 µm ± 1 µm of an Rq of 2 µm, without a word."""
    place = np.arange(12_500) * 1e-6
    joint = (place > 6e-3) & ((place < 6.3e-3) | (shape == "step"))
    scan = scan_of(tmp_path / "a.txt", plain - 200e-6 * joint)
    assert len(scan.doubts) == 1
    assert scan.doubts[0].startswith("few sections carry the roughness")
    rq = scan.values["rq"]
    assert rq.assumed
    assert rq.uncertainty > 0.3 * rq.value


def test_sound_profiles_and_smooth_waves_carry_no_doubt(tmp_path):
    for seed in range(12):
        assert scan_of(tmp_path / "a.txt", rough(12_500, 1e-6, seed)).doubts == ()
    wave = 2e-6 * np.sin(2 * np.pi * np.arange(12_500) * 1e-6 / 100e-6)
    assert scan_of(tmp_path / "a.txt", wave).doubts == ()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda z: np.where(np.arange(z.size) % 12_500 < 1000, 0.0, z), "8.0 % .*one number, 0 m"),
        (lambda z: np.minimum(z, 2e-6), "the heights are one number, 2 um"),
        (lambda z: np.maximum(z, -2.5e-6), "the heights are one number, -2.5 um"),
    ],
)
def test_heights_that_are_one_number_are_a_doubt(tmp_path, plain, change, words):
    (doubt,) = scan_of(tmp_path / "a.txt", change(plain)).doubts
    assert re.search(words, doubt)


@pytest.mark.parametrize("step", [1e-8, 1e-7, 5e-7])
def test_the_steps_of_an_instrument_are_heights(plain, step):
    assert held_level(np.round(plain / step) * step) == (0.0, 0.0)
    assert held_level(np.where(np.arange(200) % 20 < 2, 1e-6, 0.0)) == (0.0, 0.0)  # grooves drawn


@pytest.mark.parametrize("unit", ["mm", "um", "in", "mil"])
def test_a_scan_as_long_as_a_cut_off_holds_it_in_any_unit(tmp_path, unit):
    """800 points of 1 µm took 0.8 mm in inches and 0.25 mm in millimetres: Rq by a third."""
    scan = scan_of(tmp_path / "a.txt", rough(800, 1e-6), unit=unit)
    assert scan.cutoff == 0.8e-3


def test_the_waves_of_a_scan_are_the_longest_and_the_shortest_of_its_spectrum():
    spectrum = SimpleNamespace(reliable=(2 * np.pi / 0.8e-3, 2 * np.pi / 5e-6))
    waves = Scan.waves.fget(cast(Any, SimpleNamespace(spectrum=spectrum)))
    assert waves == pytest.approx((0.8e-3, 5e-6))


@pytest.mark.parametrize(("angle", "lines"), [(0.0, 2), (math.pi / 2, 4), (math.atan2(1, 2), 2)])
def test_lines_along_a_lay_see_as_many_surfaces_as_are_wide_across_it(angle, lines):
    """A map 16 mm by 8 mm, lays 2 mm long: 4 or 2 of its ten lines, whichever side is across."""
    rng = np.random.default_rng(1)
    heights = 1e-6 * rng.standard_normal((1600, 10))
    surface = HeightMap(heights, 10e-6, spacing_y=0.8e-3)
    along = [Profile(column, 10e-6) for column in heights.T]
    lay: Any = SimpleNamespace(across=angle, length=2e-3, bounded=False)
    values, count, _ = _numbers(along, along, 2.5e-3, 60e-6, lay, surface)
    alone, *_ = _numbers(along, along, 2.5e-3, 60e-6, None, surface)
    found, one = (each["rq"].uncertainty for each in (values, alone))
    assert found is not None
    assert one is not None
    few = max(1, round(16e-3 / 2.5e-3))  # without a lay lines a cut-off apart
    most = 10 * count
    expected = math.sqrt(min(most, count * few) / min(most, count * lines))
    assert found / one == pytest.approx(expected, rel=1e-9)
