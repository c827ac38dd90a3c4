"""Who slips in a case, and what a preview keeps of the case that it goes on from."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute import continuation
from underfoot.compute.micro_contact import MicroContact
from underfoot.compute.position_draws import UncertainBevel
from underfoot.compute.read import _last_instant
from underfoot.compute.slips import slip_population

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


@pytest.fixture(scope="module")
def case():
    return Case.load(EXAMPLE)


@pytest.mark.parametrize(
    ("angle", "low"), [(13.0, 5.0), (9.5, 1.5), (7.0, 1.0), (1.0, 1.0), (0.5, 0.5), (0.0, 0.0)]
)
def test_shoe_angles_of_people_reach_8_degrees_to_either_side_but_not_below_1(case, angle, low):
    spread = slip_population(case.replace("motion.shoe_angle", f"{angle} deg")).shoe_angle
    assert [math.degrees(end) for end in (spread.low, spread.mean, spread.high)] == pytest.approx(
        [low, angle, angle + 8.0]
    )


@pytest.mark.parametrize(
    ("changes", "kept"),
    [
        ({}, True),
        ({"motion.normal_force": "400 N"}, True),
        ({"contaminant.viscosity": "41 cP"}, True),
        ({"shoe.wear.depth": "1 mm"}, False),
        ({"shoe.material.shore_a": 55}, False),
        ({"numerics.grid_spacing": "1 mm"}, False),
    ],
)
def test_a_preview_keeps_the_sole_where_nothing_makes_another(case, monkeypatch, changes, kept):
    asked = {}
    monkeypatch.setattr(
        continuation, "prepare_case", lambda *_, geometry: asked.update(at=geometry)
    )
    parts: Any = SimpleNamespace(case=case, spacing=1e-3, sole="sole", compliance="compliance")
    continuation._change_case(parts, case.replace(changes))
    assert asked["at"] == (("sole", "compliance") if kept else None)


@pytest.mark.parametrize(("angle", "uncertain"), [("8 deg", True), ("0 deg", False)])
def test_a_bevel_is_uncertain_where_there_is_one(case, angle, uncertain):
    path = "shoe.heel.profile.angle"
    assumed = case.replace(path, {"value": angle, "assumed": True})
    assert (UncertainBevel.of(assumed) is not None) is uncertain
    own = case.replace(path, {"value": angle, "uncertainty": "1 deg"})
    bevel = UncertainBevel.of(own)
    if uncertain:
        assert bevel is not None
        assert math.degrees(bevel.deviation) == pytest.approx(1.0)
        assert not bevel.assumed
    else:
        assert bevel is None


def test_shares_of_a_rough_contact_end_at_one_and_its_gap_does_not():
    table: Any = SimpleNamespace(
        description="made", real_contact_fraction=lambda *_: 0.9, cof_hysteresis=lambda *_: 0.05,
        mean_gap=lambda *_: 3.0, flow_factor=lambda *_, outside: 0.8,
    )  # fmt: skip
    found = MicroContact(table, 2e5, 0.3, 0.4, 0.4, 0.4).scalars()
    factor = math.exp(1.96 * 0.4)
    ends = {name: one.interval for name, one in found.items()}
    assert ends["micro_contact"] == pytest.approx((0.9 / factor, 1.0))
    assert ends["micro_flow"] == pytest.approx((0.8 / factor, 1.0))
    assert ends["micro_hysteresis"] == pytest.approx((0.05 / factor, 0.05 * factor))
    assert ends["micro_gap"] == pytest.approx((3.0 / factor, 3.0 * factor))


def test_a_motion_that_turns_tells_the_angle_at_its_end():
    history = SimpleNamespace(
        shoe_angle=np.radians([20.0, 9.0, 4.0]), speed=np.array([1.0, 0.6, 0.5])
    )
    made: Any = SimpleNamespace(
        motion=SimpleNamespace(build=lambda: history, end_time=0.2), contaminant=None
    )
    assert _last_instant(made) == "at the end of the motion (200 ms, shoe angle 4 deg)"


@pytest.mark.parametrize(
    ("name", "mean", "sd"),
    [("mass", 15.0, 2.0), ("mass", 230.0, 20.0), ("walking_speed", 0.45, 0.05)],
)
def test_people_unlike_adults_are_drawn_about_their_own_mean(case, name, mean, sd):
    asked = case.replace({f"slip.{name}_mean": mean, f"slip.{name}_sd": sd})
    drawn = getattr(slip_population(asked), name).draw(4000, np.random.default_rng(0))
    assert drawn.mean() == pytest.approx(mean, abs=4 * sd / 4000**0.5)
    assert drawn.std() == pytest.approx(sd, rel=0.05)
