"""Viscosities of mixtures, what fluids leave of adhesion, how they warm; what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.core import SourcedValue
from underfoot.fluid import cheng_2008, contaminant, strobel_2012, temperature
from underfoot.fluid.cheng_2008 import (
    glycerol_mass_fraction,
    glycerol_water_breaches,
    glycerol_water_density,
    glycerol_water_viscosity,
    water_viscosity,
)
from underfoot.fluid.contaminant import Contaminant, compared_viscosity, glycerol_water
from underfoot.fluid.strobel_2012 import (
    BLOCKING,
    AdhesionBlocking,
    adhesion_blocking,
    strobel_breaches,
)
from underfoot.fluid.temperature import sliding_heat, viscosity_slope

SHARES = np.array([0.0, 0.25, 0.5, 0.75, 0.9, 1.0])
KELVIN = np.array([[273.15], [293.15], [333.0], [373.15]])


def test_mixtures(file_regression):
    answers = {
        "viscosity": list(glycerol_water_viscosity(SHARES, KELVIN)),
        "by volume": list(glycerol_water_viscosity(SHARES, KELVIN, "volume")),
        "water": water_viscosity(KELVIN[:, 0]), "one": water_viscosity(300.0),
        "density": list(glycerol_water_density(SHARES, KELVIN)),
        "density by volume": list(glycerol_water_density(SHARES, KELVIN, "volume")),
        "mass": list(glycerol_mass_fraction(SHARES, KELVIN)),
        "breaches": [glycerol_water_breaches(*each) for each in (
            (0.5, 293.0), (1.01, 293.0), (-0.01, 273.0), ([0.1, 1.2], 373.2))],
        "ranges": cheng_2008.RANGES,
        "refused": [refusal(glycerol_water_viscosity, *each) for each in (
            (0.5, 293.15, "weight"), (np.nan, 293.15), (0.5, np.inf), (1.001, 293.15),
            (-0.001, 293.15), (0.5, 273.1), (0.5, 373.2))],
    }  # fmt: skip
    held(file_regression, answers)
    assert type(water_viscosity(300.0)) is float


def _value(number=0.2, unit="Pa*s", **more):
    return SourcedValue(number, unit, source="a viscometer", **more)


def test_contaminants(file_regression):
    measured = _value(0.219, uncertainty=0.01, note="at 23 C")
    answers = {
        "computed": glycerol_water(0.9, 293.15),
        "by volume": glycerol_water(0.9, 295.0, "volume", blocking=BLOCKING["glycerol 75 %"]),
        "measured": glycerol_water(0.9, 293.15, measured_viscosity=measured),
        "compared": [], "bare": Contaminant("oil", _value(0.06)),
    }  # fmt: skip
    for value, share in ((0.219, 0.9), (0.16, 0.9), (0.5, 0.9), (1.0e-3, 0.0), (0.2355, 0.9)):
        one = compared_viscosity(_value(value), share, 293.15)
        answers["compared"].append((one, one.closer_basis, one.deviation, one.explained, str(one)))
    bare = answers["bare"]
    answers["refused"] = [
        refusal(Contaminant, "x", _value(unit="cP")), refusal(Contaminant, "x", _value(0.0)),
        refusal(replace, bare, density=_value(1000.0, "g/cm^3")),
        refusal(replace, bare, density=_value(-1.0, "kg/m^3")),
        refusal(replace, bare, temperature=0.0),
        refusal(compared_viscosity, _value(0.0), 0.5, 293.15),
        refusal(glycerol_water, 0.9, 293.15, measured_viscosity=_value(unit="s")),
        refusal(Contaminant, "x", SourcedValue(None, "Pa*s", reason="not measured")),
    ]  # fmt: skip
    replace(bare, density=_value(1e-9, "kg/m^3"), temperature=1e-3)
    replace(bare, viscosity=_value(unit="Pa s"))
    held(file_regression, answers)
    assert contaminant.CHENG_DEVIATION == 0.05
    edge = contaminant.ViscosityComparison(1.0, 1.0499, 0.9501)
    assert edge.closer_basis == "mass"
    assert edge.explained
    assert not contaminant.ViscosityComparison(1.0, 1.051, 0.9).explained


def test_adhesion_under_fluids(file_regression):
    water = adhesion_blocking("water")
    answers = {
        "table": {name: (one, one.crossover) for name, one in BLOCKING.items()},
        "left": water.lubricated_adhesion(np.array([0.0, 4.0, 20.0])),
        "cof": water.lubricated_adhesion_cof(np.array([0.0, 0.2, 1.0])),
        "estimates": [water.estimate(force) for force in (4.5, 4.6, 12.0)],
        "all through": AdhesionBlocking(1.0, 1.0).crossover,
        "breaches": [strobel_breaches(normal_force=a, speed=b, viscosity=c) for a, b, c in (
            (20.9, 0.01, 1e-3), (21.0, 0.02, 0.1), (20.9, 0.01, 0.5e-3))],
        "refused": [
            refusal(adhesion_blocking, "watre"), refusal(AdhesionBlocking, -0.1, 0.1),
            refusal(AdhesionBlocking, 0.1, -0.1), refusal(AdhesionBlocking, np.nan, 0.1),
            refusal(AdhesionBlocking, 0.1, 0.1, normal_force=0.0),
            refusal(water.lubricated_adhesion, [-1.0]), refusal(water.lubricated_adhesion, np.inf),
        ],
    }  # fmt: skip
    AdhesionBlocking(0.0, 0.0)
    held(file_regression, answers)
    assert strobel_2012.MEAN_ERROR == 1.05
    assert water.lubricated_adhesion(water.crossover) == pytest.approx(water.crossover)


def test_warmth(file_regression):
    answers = {
        "slopes": [viscosity_slope(v) for v in (1e-4, 9.4e-4, 0.05, 0.2, 5.0)],
        "oil": viscosity_slope(0.06, oil=True),
        "heat": [sliding_heat(*each) for each in (
            (0.5, 2e5, 0.3, 0.02), (1.0, 2e5, 0.3, 0.02), (0.5, 2e5, 1.2, 0.02))],
        "faces": (temperature.SOLE, temperature.FLOOR, temperature.ROOM_DEVIATION),
    }  # fmt: skip
    held(file_regression, answers)
    heats = answers["heat"]
    assert heats[1] == pytest.approx(2 * heats[0])
    assert heats[2] == pytest.approx(2 * heats[0])
