"""What each member of a registry must satisfy: fluids, laws, numbers of a result, tread patterns.

Who adds one finds here what it may not do: a fluid a thousand times too thick, N for kN, a pattern
whose solid is another than its map.
"""

import json
import typing
from itertools import pairwise

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.case.contaminant import ContaminantSection
from underfoot.case.parts import unit_at
from underfoot.case.section import quantity_of
from underfoot.case.sole import TreadPattern, usual_tread
from underfoot.compute.sole import new_sole
from underfoot.core.catalogue import catalogue
from underfoot.report.writing import json_text
from underfoot.shoe import heel_surface
from underfoot.shoe.parametric import sole_solid

THIN, THICK = 0.3e-3, 15.0  # Pa s: petrol and honey; nothing beyond them is spilled and slid on
CATALOGUE = catalogue()
WARM = [name for name, one in ContaminantSection.options().items()
        if "temperature" in one.model_fields]  # fmt: skip


def middle_inputs(option):
    """Return every input that an option asks for, in the middle of its range."""
    given = {}
    for name, field in option.model_fields.items():
        if not field.is_required():
            continue
        if quantity := quantity_of(field):
            value = 0.5 * (quantity.low + quantity.high)
            given[name] = value if quantity.unit == "1" else f"{value} {quantity.unit}"
        else:
            given[name] = typing.get_args(field.annotation)[0]
    return given


def spilled(contaminant):
    """Return the viscosity of a contaminant of a case."""
    place = {"shoe": "work_shoe_untreaded", "floor": "vinyl_g4", "motion": "slip_tester_g4"}
    return Case(**place, contaminant=contaminant).contaminant.build()


@pytest.mark.parametrize("name", WARM)
def test_every_fluid_is_one_that_is_spilled_and_thins_with_warmth(name):
    inputs = middle_inputs(ContaminantSection.options()[name])
    fluids = [
        spilled({"model": name, **inputs, "temperature": f"{warm} degC"})
        for warm in (10, 20, 30, 40)
    ]
    assert {fluid.unit for fluid in fluids} == {unit_at("contaminant.viscosity")}
    assert all(fluid.source for fluid in fluids)
    assert all(THIN <= fluid.value <= THICK for fluid in fluids)
    # 1 to 10 % a kelvin: liquids between water and glycerol
    falls = [1 - (after.value / before.value) ** 0.1 for before, after in pairwise(fluids)]
    assert all(0.01 < fall < 0.1 for fall in falls), falls


@pytest.mark.parametrize("name", CATALOGUE.names("fluid"))
def test_every_fluid_of_the_catalogue_is_one_that_is_spilled(name):
    assert THIN <= spilled(name).value <= THICK


UNITS = {
    "force": "N", "load": "N", "pressure": "Pa", "area": "m^2", "thickness": "m", "depth": "m",
    "cof": "1", "probability": "1", "share": "1", "ratio": "1", "time": "s", "distance": "m",
    "slide": "m", "speed": "m/s", "temperature": "K", "viscosity": "Pa*s", "angle": "rad",
}  # fmt: skip


def test_every_number_has_the_unit_and_the_size_of_its_quantity(worn_shoe_result):
    load = worn_shoe_result.value("normal_force")
    area = worn_shoe_result.value("contact_area")
    for name, number in worn_shoe_result.scalars.items():
        words = [word for word in name.split("_") if word in UNITS]
        assert words, f"{name}: which of {', '.join(UNITS)} is it?"
        assert number.unit == UNITS[words[0]], name
        if number.value is None:
            assert number.reason, name
        elif number.unit == "N":  # what a force of the contact is, in N and not in kN
            assert number.value == 0 or load / 100 <= number.value <= load * (1 + 1e-9), name
        elif number.unit == "Pa":  # a peak bears no less than the mean
            assert load / 100 <= number.value * area, name
        elif number.unit == "1":
            assert 0 <= number.value <= 2, name
        elif number.unit == "m":
            assert 1e-9 < number.value < 1, name


def test_every_number_stands_in_json_and_frame(worn_shoe_result):
    told = json.loads(json_text(worn_shoe_result))
    frame = worn_shoe_result.to_frame()
    for name, number in worn_shoe_result.scalars.items():
        assert told[name]["unit"] == number.unit == frame.loc[name, "unit"]
        assert told[name]["value"] == number.value
        assert frame.loc[name, "value"] == number.value or np.isnan(frame.loc[name, "value"])


LONG = ("waves", "lettering")
PATTERNS = [pytest.param(name, marks=pytest.mark.slow if name in LONG else ())
            for name in TreadPattern.options() if name != "none"]  # fmt: skip


@pytest.mark.parametrize("pattern", PATTERNS)
def test_land_and_volume_of_a_pattern_are_those_of_its_solid(pattern):
    small = {"plan": "heel", "length": "24 mm", "width": "24 mm", "rear_radius": "10 mm"}
    small["edge_radius"] = "2 mm" if pattern in ("hexagons", "rings") else "0 mm"
    tread = {"pattern": pattern, **usual_tread(pattern), "angle": "20 deg"}
    case = Case(shoe={"from": "work_shoe_full_tread", "heel": small, "tread": tread},
                floor="vinyl_g4", contaminant="water", motion="slip_tester_g4")  # fmt: skip
    heel, cell = new_sole(case), 1.5e-4
    below = heel.outsole_thickness - heel_surface(heel, spacing=cell).height
    cut = heel.plan_area * heel.outsole_thickness - np.array(
        [float(np.nansum(below)) * cell**2, sole_solid(heel).volume]
    )
    assert cut[1] == pytest.approx(cut[0], rel=0.01)
