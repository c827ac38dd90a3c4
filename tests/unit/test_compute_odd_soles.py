"""Soles at the edge of what can be computed: an answer, or an error with its remedy."""

from types import SimpleNamespace

import pytest

from underfoot import Case, run
from underfoot.compute.numbers import no_result_words
from underfoot.core import Breach, InputError, ValidityRange

BARS = {"pattern": "transverse", "depth": "3 mm", "lug_width": "6 mm", "channel_width": "4 mm"}
SMALL = {
    "shoe.tread": {"pattern": "none"},
    "shoe.heel.profile": {"model": "flat"},
    "shoe.heel.edge_radius": "0 mm",
    "motion.shoe_angle": "0 deg",
    "motion.normal_force": "5 N",
    "numerics.tread_positions": 1,
}


def case(settings):
    return Case(
        shoe={"from": "work_shoe_full_tread"},
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion="slip_tester_g4",
    ).replace(settings)


@pytest.mark.parametrize(
    ("settings", "answer"),
    [
        (
            {"shoe.tread": BARS | {"lug_width": "3 mm"}, "numerics.quick_grid_spacing": "2 mm"},
            "3 mm is too narrow for the grid of 2 mm.*four cells",
        ),
        ({"shoe.tread": BARS | {"channel_width": "0.5 mm"}}, "too narrow for the grid"),
        (
            {"shoe.heel.profile": {"model": "facet", "angle": "89 deg", "length": "20 mm"}},
            "from 0 deg to 60 deg",
        ),
        ({"motion.shoe_angle": "89 deg"}, "from -30 deg to 60 deg"),
        ({"motion.normal_force": "0 N"}, "from 1 N to 10 kN"),
        (
            SMALL | {f"shoe.heel.{n}": "1 mm" for n in ("length", "width")},
            "does not fit the plan form",
        ),
        (
            SMALL | {"shoe.heel.rear_radius": "0.2 mm"}
            | {f"shoe.heel.{n}": "1 mm" for n in ("length", "width")},
            "the plan form is 1 mm small, the grid spacing 1 mm",
        ),
    ],
)  # fmt: skip
def test_what_can_not_be_computed_is_refused_with_its_remedy(settings, answer):
    with pytest.raises(InputError, match=f"(?s){answer}"):
        run(case(settings), quick=True)


@pytest.mark.parametrize(
    "settings",
    [
        SMALL
        | {"shoe.heel.rear_radius": "1 mm"}
        | {f"shoe.heel.{n}": "8 mm" for n in ("length", "width")},
        # water so thin that no film is thicker than the roughness
        {"contaminant.viscosity": "0.05 cP", "numerics.tread_positions": 1},
    ],
)
def test_odd_soles_have_an_answer(settings):
    result = run(case(settings), quick=True)
    assert result.usable
    assert 0 < result.value("cof") < 1.5


def test_a_march_without_a_result_names_the_physics():
    contact = SimpleNamespace(fluid_load=300.0, normal_force=400.0, time=0.0255)
    limit = ValidityRange(0.0, 0.01, "1", "rubber")
    crushed = no_result_words(contact, [Breach("compliance", "share", 0.39, 0.39, limit)])
    assert crushed.startswith("lugs crushed: 39% of the load")
    assert "25.5 ms, where the film carried 75% of 400 N" in crushed
    assert no_result_words(contact, []).startswith("film and contact change places")
    floating = SimpleNamespace(fluid_load=390.0, normal_force=400.0, time=0.1)
    assert no_result_words(floating, []).startswith("the sole floats")
