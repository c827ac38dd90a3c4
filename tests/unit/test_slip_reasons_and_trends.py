"""Why no step can be used; a trend of three states."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import load
from underfoot.core import InputError
from underfoot.questions.changes import possible_changes
from underfoot.questions.wear import _rank
from underfoot.slip.dynamics import recorded
from underfoot.slip.dynamics.walker import Walker

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_each_step_says_why_it_is_none(monkeypatch):
    steps = [
        SimpleNamespace(
            stance=SimpleNamespace(reason=a), measurement=SimpleNamespace(value=None, reason=b)
        )
        for a, b in (("partial", ""), ("", "no peak"), ("partial", "no peak"))
    ]
    monkeypatch.setattr(recorded, "read_trial", lambda path: None)
    monkeypatch.setattr(recorded, "walkway_of", lambda trial: None)
    monkeypatch.setattr(recorded, "required_frictions", lambda walk: steps)
    with pytest.raises(InputError, match="no step can be used: partial; no peak"):
        recorded.recorded_histories("walk.c3d")
    steps.clear()
    with pytest.raises(InputError, match="no contact"):
        recorded.recorded_histories("walk.c3d")


@pytest.mark.parametrize("states", [2, 3, 5])
def test_three_states_tell_a_trend_and_two_do_not(states):
    x = np.arange(6.0)
    y = np.where(np.arange(6) < states, x**2, np.nan)
    rising, falling = (_rank(cast(Any, "one"), x, y, sign) for sign in (1, -1))
    told = (pytest.approx(1.0), True) if states > 2 else (None, None)
    assert (rising.correlation, rising.agrees) == told
    assert falling.agrees is (False if states > 2 else None)


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("mass", 5.0, 400.0), ("rcof", 0.0, 1.0), ("heel_speed", 0.0, 6.0),
        ("effective_mass", 1e-3, 1.0), ("walking_speed", 0.1, 6.0), ("rcof_step", -1.0, 1.0),
        ("brake_time", 1e-3, 1.0), ("weight_transfer", 0.0, 1.0),
    ],
)  # fmt: skip
def test_a_walker_is_one_within_the_limits_that_are_told(name, low, high):
    usual = Walker(mass=70.0, rcof=0.2, history=cast(Any, None), heel_speed=0.3)
    for value, fits in ((low, True), (high, True), (low - 0.05, False), (1.01 * high, False)):
        if fits:
            assert getattr(replace(usual, **{name: value}), name) == value
        else:
            with pytest.raises(InputError, match=rf"walker.{name}: .* Allowed: .* to "):
                replace(usual, **{name: value})


def test_changes_of_a_sole_are_as_large_as_they_say(monkeypatch):
    case = load(EXAMPLES / "work_shoe_full_tread_glycerol.toml")
    case = case.replace({"shoe.tread.channel_width": "4 mm", "shoe.material.shore_a": 68})
    changes = {one.name: one for one in possible_changes(case)}
    assert changes["wider_channels"].values == {"shoe.tread.channel_width": pytest.approx(6e-3)}
    assert changes["wider_channels"].action == "channels 50 % wider (6 mm)"
    monkeypatch.setenv("UNDERFOOT_UNITS", "us")
    in_inches = {one.name: one.action for one in possible_changes(case)}
    assert in_inches["wider_channels"] == "channels 50 % wider (0.236 in)"
    hardness = case.shoe.material.shore_a
    assert changes["softer_compound"].values == {"shoe.material.shore_a": hardness - 15}
    rq = case.shoe.roughness.rq_or_estimate
    assert changes["abraded_sole"].values["shoe.roughness.rq"] == pytest.approx(2 * rq)


@pytest.mark.parametrize(
    ("rate", "missing", "has"),
    [(100.0, (), True), (100.0, (0.4,), False), (100.0, (0.55,), False), (5.0, (), False)],
    ids=["seen", "lost while flat", "lost later", "too slow"],
)
def test_a_foot_turns_from_where_it_lies_flat(monkeypatch, rate, missing, has):
    """From 20 to 0 deg in the first 0.18 s of a stance of 0.6 s; its markers' line falls by 5 deg.

    At 5 pictures a second there is none in 0.3 to 0.5 of the stance, which is flat.
    """
    seen = np.arange(0.92, 1.82, 1 / rate)
    turned = np.radians(20.0) * np.clip(1 - (seen - 1.0) / 0.18, 0.0, None)
    at = turned - np.radians(5.0)
    at[[np.abs(seen - 1.0 - when).argmin() for when in missing]] = np.nan
    walking, up = np.array([0.6, 0.8, 0.0]), np.array([0.0, 0.0, 1.0])
    heel_at = np.outer(seen, walking)
    heel, toe = (
        SimpleNamespace(time=seen, positions=positions)
        for positions in (
            heel_at,
            heel_at + 0.2 * (np.outer(np.cos(at), walking) + np.outer(np.sin(at), up)),
        )
    )
    stance = SimpleNamespace(contact=1.0, duration=0.6, walking=walking)
    walk = SimpleNamespace(up=up)
    monkeypatch.setattr(recorded, "_heel_and_toe", lambda *_: (heel, toe))
    time = np.arange(0.0, 0.6, 0.05)
    angle = recorded._foot_angle(cast(Any, walk), cast(Any, stance), time)
    if not has:
        assert angle is None
        return
    expected = np.interp(time + 1.0, seen, turned)
    np.testing.assert_allclose(angle, expected, atol=1e-9)
    for pair in ((None, toe), (heel, None)):
        monkeypatch.setattr(recorded, "_heel_and_toe", lambda *_, pair=pair: pair)
        assert recorded._foot_angle(cast(Any, walk), cast(Any, stance), time) is None
