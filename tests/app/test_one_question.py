"""Pages that answer one question agree: how often a person slips here, and by which friction.

Twenty cases go through ``run``, ``risk``, ``slip``, ``choose`` and ``test`` on the coarse grid,
five of them, with each place, on every change. The walkers of ``slip`` are left out: their share is
told as that of another model.
"""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.core.presentation import value_text
from underfoot.places.choice import choose_shoe
from underfoot.places.place import place_of
from underfoot.questions.method import MethodPrediction, method_prediction
from underfoot.questions.risk import risk_assessment
from underfoot.questions.slips import SlipPopulation, slip_population
from underfoot.slip import MODELS, slip_chances, slip_model

SOLES = ("work_shoe_untreaded", "work_shoe_full_tread")
PLACES = (
    ("water", "vinyl_g4", {}),
    ("detergent", "quarry_tile", {"slope": "4 deg"}),
    ("glycerol_90pct", "vinyl_g4", {}),
    ("canola_oil", "quarry_tile", {}),
    ("none", "vinyl_g4", {"slope": "6 deg"}),
)
PEOPLE = ({}, {"rcof_mean": 0.26, "rcof_sd": 0.05})
CASES = [
    pytest.param(
        SOLES[sole], *place, PEOPLE[people],
        marks=pytest.mark.slow if (sole, people) == (at % 2, at // 2 % 2) else pytest.mark.study,
    )
    for sole in (0, 1) for at, place in enumerate(PLACES) for people in (0, 1)
]  # fmt: skip
CHANCE, COF = 0.04, 0.03
"""Difference of two pages by their numbers of draws and by a continued contact: of a probability,
and of ln COF; fixed before the first run."""


def made(sole, fluid, floor, slope, people):
    return Case(
        shoe=sole,
        floor={"from": floor, **slope},
        contaminant=fluid,
        motion="whole_shoe_g6",
        friction={"model": "pair"},
        risk=people,
        numerics={"tread_positions": 1},
    )


@pytest.fixture(autouse=True)
def _own_cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path_factory.getbasetemp() / "one_question"))


@pytest.mark.parametrize(("sole", "fluid", "floor", "slope", "people"), CASES)
def test_pages_agree_on_how_often_a_person_slips(sole, fluid, floor, slope, people, monkeypatch):
    case = made(sole, fluid, floor, slope, people)
    result = run(case, quick=True)
    slip, cof = result.scalars["slip_probability"], result.scalars["cof"]
    assert slip.interval[0] <= slip.value <= slip.interval[1]

    # run and risk: one number, and sentences that follow from it
    told = risk_assessment(case, result=result, changes=[])
    assert told.outcome.scalars["slip_probability"] == slip
    own = next(one for one in told.models if one.name == case.risk.name)
    assert (own.probability, own.low, own.high) == (slip.value, *slip.interval)
    assert value_text("slip_probability", slip) in told.headline()[0]
    enough = told.headline()[-1].startswith("Friction is sufficient")
    assert enough == (slip.value <= told.target)
    if own.needed_acof is not None:
        assert enough == (own.needed_acof <= cof.value * (1 + 1e-6))

    # slip: the same number beside that of its walkers, once, with the reason
    monkeypatch.setattr("underfoot.questions.slips.slips", lambda *a, **k: None)
    page = slip_population(case, quick=True)
    assert page.predicted == slip
    (sentence,) = SlipPopulation._other_model(page)
    assert value_text("slip_probability", slip) in sentence

    # test: the friction of a method that keeps everything of the case is that of the run
    keep = ("floor", "contaminant", "normal_force", "shoe_angle", "speed")
    method = method_prediction(case, "whole_shoe_g6", keep=keep, with_band=False, quick=True)
    assert isinstance(method, MethodPrediction)
    (condition,) = method.conditions
    assert math.log(condition.cof.value / cof.value) == pytest.approx(0, abs=COF)
    for end, whole in zip((condition.low, condition.high), cof.interval, strict=True):
        assert math.log(end / whole) == pytest.approx(0, abs=2 * COF)

    # choose: a place of this floor and fluid alone
    if fluid == "none":
        return
    one = choose_shoe(place_of(place(case, floor, slope, fluid, people)))
    (answer,) = one.shoes
    assert answer.slips.value == pytest.approx(slip.value, abs=CHANCE)
    for end, whole in zip(answer.slips.interval, slip.interval, strict=True):
        assert end == pytest.approx(whole, abs=3 * CHANCE)
    words = " ".join((*one.headline(), *one.summary().splitlines()))
    assert not re.search(r"\d,\d{3},\d{3}", words)


def place(case, floor, slope, fluid, people):
    shoe = {"name": "shoe", "from": case.entries["shoe"]}
    return {
        "people": people,
        "fluids": {"dry": 0.5, fluid: 0.5},
        "floor": [{"name": "floor", "from": floor, **slope}],
        "shoe": [shoe],
    }


@pytest.mark.parametrize("name", sorted(MODELS))
@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_a_step_down_a_ramp_slips_oftener_by_every_model(name, slope):
    from underfoot.slip import RcofPopulation

    acof = np.linspace(0.1, 0.5, 200)
    level, model = RcofPopulation(0.2, 0.03), slip_model(name)
    here = slip_chances(acof, level.on_slope(slope), model)
    flat = slip_chances(acof, level, model)
    assert (here >= flat - 1e-12).all()
    assert (here > flat).any() == (slope > 0)


def test_a_slope_is_in_the_run_its_words_and_its_name():
    case = made("work_shoe_untreaded", "none", "vinyl_g4", {}, {})
    ramp = case.replace("floor.slope", "6 deg")
    flat, down = (run(each, quick=True) for each in (case, ramp))
    assert down.value("cof") == flat.value("cof")
    assert down.value("slip_probability") > flat.value("slip_probability")
    assert "0.31 here" in down.labels["slope"]
    assert ramp.hash != case.hash
