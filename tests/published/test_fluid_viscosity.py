"""Viscosities of water and glycerol-water against published tables."""

from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.core import InputError, RangeError, SourcedValue
from underfoot.fluid import (
    Contaminant,
    compared_viscosity,
    glycerol_mass_fraction,
    glycerol_water,
    glycerol_water_breaches,
    glycerol_water_density,
    glycerol_water_viscosity,
    water_viscosity,
)

ROOT = Path(__file__).parents[2]
# Cheng (2008) evaluated by an independent code (github.com/H-Cox/PhD-MatLab-Scripts, with
# Cheng's own densities); mPa s at 20, 22 and 25 degC.
TABLE = {
    ("mass", 0.0): (1.005, 0.957, 0.893),
    ("mass", 0.25): (2.05, 1.94, 1.79),
    ("mass", 0.5): (6.00, 5.57, 5.00),
    ("mass", 0.75): (36.3, 32.5, 27.7),
    ("mass", 0.9): (223.8, 193.2, 156.4),
    ("volume", 0.25): (2.43, 2.29, 2.10),
    ("volume", 0.5): (8.40, 7.74, 6.88),
    ("volume", 0.75): (55.5, 49.3, 41.5),
    ("volume", 0.9): (303.6, 260.5, 208.7),
}


@pytest.mark.parametrize(("basis", "fraction"), TABLE)
def test_cheng_table(basis, fraction):
    got = glycerol_water_viscosity(fraction, np.array([20.0, 22.0, 25.0]) + 273.15, basis)
    np.testing.assert_allclose(got * 1e3, TABLE[basis, fraction], rtol=3e-3)


@pytest.mark.parametrize(
    ("path", "value", "spread", "ends"),
    [
        ("temperature", "22.5 degC", "2.5 degC", (41.5, 55.5)),  # 20 and 25 degC of the table
        ("glycerol_fraction", "75 %", "0.1 %", None),
        ("glycerol_fraction", "100 %", "0.1 %", None),
    ],
)
def test_what_is_not_known_of_a_mixture_is_in_its_viscosity(path, value, spread, ends):
    mixture = {"glycerol_fraction": "75 %", "fraction_basis": "volume", "temperature": "20 degC"}
    case = Case.load(ROOT / "examples" / "work_shoe_untreaded_glycerol.toml")
    changed = {"contaminant": mixture | {path: {"value": value, "uncertainty": spread}}}
    viscosity = case.replace(changed).contaminant.build()
    exact = case.replace({"contaminant": mixture | {path: value}}).contaminant.build()
    assert viscosity.value == exact.value
    if ends is None:
        share, step = case.replace(changed).contaminant.glycerol_fraction, 1e-3
        ends = [
            1e3 * glycerol_water_viscosity(share + at, 293.15, "volume")
            for at in (-step, step if share < 1 else 0.0)
        ]
        ends[0] = ends[1] - (ends[1] - ends[0]) * (1 if share < 1 else 2)
    expected = np.hypot(exact.uncertainty, 1e-3 * (ends[1] - ends[0]) / 2)
    assert viscosity.uncertainty == pytest.approx(expected, rel=0.01)


def test_water_against_reference_values():
    # IAPWS 2008 / CRC Handbook, mPa s.
    celsius = np.array([0.0, 10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0])
    reference = [1.792, 1.306, 1.0016, 0.8900, 0.7972, 0.6527, 0.5465, 0.4660, 0.3540, 0.2817]
    np.testing.assert_allclose(water_viscosity(celsius + 273.15) * 1e3, reference, rtol=0.011)


def test_glycerol_against_segur_oberstar():
    # Segur & Oberstar, Ind. Eng. Chem. 43 (1951) 2117, at 20 degC by mass, mPa s; Cheng claims 5 %.
    fraction = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
    measured = [1.31, 1.76, 2.50, 3.72, 6.00, 10.8, 22.5, 60.1, 219.0, 1410.0]
    got = glycerol_water_viscosity(fraction, 293.15) * 1e3
    np.testing.assert_allclose(got, measured, rtol=0.05)


def test_viscosity_rises_with_glycerol_and_falls_with_temperature():
    fraction = np.linspace(0.0, 1.0, 51)[:, None]
    temperature = np.linspace(273.15, 373.15, 41)[None, :]
    for basis in ("mass", "volume"):
        got = glycerol_water_viscosity(fraction, temperature, basis)
        assert np.all(np.diff(got, axis=0) > 0)
        assert np.all(np.diff(got, axis=1) < 0)


def test_mass_and_volume_agree_at_the_ends_and_through_the_mass_fraction():
    for end in (0.0, 1.0):
        assert glycerol_water_viscosity(end, 295.0, "volume") == pytest.approx(
            glycerol_water_viscosity(end, 295.0, "mass"), rel=1e-12
        )
    mass = glycerol_mass_fraction(0.4, 295.0)
    assert 0.4 < mass < 0.5
    assert glycerol_water_viscosity(0.4, 295.0, "volume") == pytest.approx(
        glycerol_water_viscosity(mass, 295.0, "mass"), rel=1e-12
    )
    # 20 degC: 998.2 and 1264 kg/m^3, within the 0.1 % of Cheng's density fits.
    assert glycerol_water_density(0.0, 293.15) == pytest.approx(998.2, rel=2e-3)
    assert glycerol_water_density(1.0, 293.15) == pytest.approx(1261.0, rel=4e-3)


def test_bad_input_is_refused_with_the_remedy():
    with pytest.raises(RangeError, match="0\\.25"):
        glycerol_water_viscosity(25, 293.15)
    with pytest.raises(RangeError, match="kelvin"):
        glycerol_water_viscosity(0.25, 20.0)
    with pytest.raises(InputError, match="mass"):
        glycerol_water_viscosity(0.25, 293.15, "weight")
    with pytest.raises(InputError, match="not finite"):
        glycerol_water_viscosity(np.nan, 293.15)
    assert glycerol_water_breaches(0.5, 293.15) == []
    assert "temperature" in str(glycerol_water_breaches(0.5, 260.0)[0])
    assert "fraction" in str(glycerol_water_breaches(1.2, 293.15)[0])


@pytest.mark.parametrize(
    ("viscosity", "fraction", "celsius", "basis", "explained"),
    [
        (1.9e-3, 0.25, 22.0, "mass", True),  # G.2
        (5.54e-3, 0.50, 22.0, "mass", True),  # G.2
        (41e-3, 0.75, 25.0, "volume", True),  # G.2
        (219e-3, 0.90, 20.0, "mass", True),  # G.4
        (0.52e-3, 0.0, 22.0, "mass", False),  # G.2: no water of that temperature is so thin
    ],
)
def test_the_mixed_percentages_of_the_report_are_shown(
    viscosity, fraction, celsius, basis, explained
):
    measured = SourcedValue(viscosity, "Pa*s", source="grant report", reason="not given")
    comparison = compared_viscosity(measured, fraction, celsius + 273.15)
    assert comparison.closer_basis == basis
    assert comparison.explained is explained
    text = str(comparison)
    assert "measured" in text
    assert ("neither fits" in text) is not explained
    fluid = glycerol_water(fraction, celsius + 273.15, measured_viscosity=measured)
    assert fluid.viscosity.value == viscosity  # the measurement counts, the computed one is shown
    assert text in fluid.viscosity.note


def test_contaminant_refuses_nonsense():
    water = SourcedValue(1e-3, "Pa*s", source="test", reason="test")
    assert Contaminant("water", water).density is None
    computed = glycerol_water(0.5, 295.15)
    assert computed.viscosity.value == pytest.approx(5.57e-3, rel=1e-3)
    assert computed.viscosity.uncertainty is not None
    for value in (None, 0.0, -1e-3, float("nan")):
        with pytest.raises(RangeError, match="viscosity"):
            Contaminant("x", SourcedValue(value, "Pa*s", reason="test"))
    with pytest.raises(InputError, match="unit"):
        Contaminant("x", SourcedValue(1.0, "cP", reason="test"))
    with pytest.raises(RangeError, match="temperature"):
        Contaminant("x", water, temperature=-1.0)


@pytest.mark.parametrize(("fraction", "kelvin"), [([0.5, 1.01], 293.0), (0.5, [293.0, 374.0])])
def test_one_value_beyond_its_range_is_refused_among_others(fraction, kelvin):
    with pytest.raises(RangeError):
        glycerol_water_viscosity(fraction, kelvin)
