"""Required friction of real walking against the values seen by others and by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.trials import (
    DEFINITIONS,
    LowPass,
    Measurement,
    RcofDefinition,
    axes_of,
    axis_name,
    contact_from_heel,
    heel_candidates,
    join_trials,
    mean_of,
    read_trial,
    required_frictions,
    slip_of,
    stances,
    walkway_of,
)

DATA = Path(__file__).parents[1] / "data" / "trials"


def _trial(name: str):
    if name == "walk1":
        return join_trials(
            read_trial(DATA / "bmc" / "walk1.trc"), read_trial(DATA / "bmc" / "walk1.forces")
        )
    return read_trial(DATA / name)


def _rcof(trial, definition="default"):
    found = required_frictions(walkway_of(trial), DEFINITIONS[definition])
    return [f.measurement.value for f in found if f.measurement.estimated]


# Values and axes: description of the data sets, throw-away code of another hand, 2nd-order
# Butterworth forward and backward at 36 Hz, baseline subtracted, 100 N gate, braking, first half.
SEEN = [
    ("biomechzoo/HC030A05.c3d", [0.22, 0.25], "+z", "RL"),
    ("biomechzoo/HC036A23.c3d", [0.27], "+z", "R"),
    ("bmc/Gait.c3d", [0.26, 0.27], "+z", "RL"),
    ("opensim/walking5.c3d", [0.21], "+z", "R"),
    ("opensim/leg69_stance_grf.mot", [0.17], "+y", "?"),
    ("kineticstoolkit/c3d_sample.c3d", [0.22, 0.24, 0.22], "+y", "LRL"),
    ("btk/ADemo1_rewrite_c3d_pc_integer.c3d", [0.25], "+z", "R"),
    ("walk1", [0.18, 0.18, 0.21], "+y", "LRL"),
]


@pytest.mark.parametrize(("name", "values", "vertical", "feet"), SEEN)
def test_rcof_of_real_walking(name, values, vertical, feet):
    trial = _trial(name)
    found = required_frictions(walkway_of(trial))
    taken = [f for f in found if f.measurement.estimated]
    assert [f.measurement.value for f in taken] == pytest.approx(values, abs=0.01)
    assert axis_name(axes_of(trial).up) == vertical
    sides = {"left": "L", "right": "R", "unknown": "?"}
    assert "".join(sides[f.stance.side] for f in taken) == feet
    for f in taken:
        assert 0.01 < f.peak_time - f.stance.contact < 0.12  # 27-93 ms in most, 105 in one
        assert f.measurement.conventions["filter"].endswith("36 Hz")


def test_cut_stances_are_rejected_with_the_reason():
    found = required_frictions(walkway_of(_trial("opensim/leg69_stance_grf.mot")))
    reasons = [f.measurement.reason for f in found if not f.measurement.estimated]
    assert reasons == ["begins before the record", "ends after the record"]
    assert found[1].stance.direction.source == "treadmill"


def test_a_heel_beside_the_plate_is_a_partial_hit():
    """The left heel of this file lands 136 mm behind plate 1; its 0.18 is no required friction."""
    trial = _trial("opensim/walking5.c3d")
    first = required_frictions(walkway_of(trial))[0]
    assert first.measurement.reason == "a partial hit: the heel stands 136 mm outside the plate"
    blind = replace(trial, markers={})
    assert _rcof(blind) == pytest.approx([0.18, 0.21], abs=0.01)  # as seen without the markers


def test_the_baseline_moves_rcof_as_described():
    path = DATA / "bmc" / "Gait.c3d"
    raw = _rcof(read_trial(path, subtract_baseline=False))
    assert sorted(raw) == pytest.approx([0.28, 0.28], abs=0.01)  # "0.28, 0.28 as read"
    path = DATA / "opensim" / "walking5.c3d"
    raw = _rcof(read_trial(path, subtract_baseline=False))
    assert raw == pytest.approx([0.22], abs=0.01)
    plates = read_trial(DATA / "bmc" / "Gait.c3d").plates
    assert plates[0].baseline[1] == pytest.approx(10.5, abs=0.5)  # "10 N in Fy on plate 1"
    assert plates[1].baseline[2] == pytest.approx(-16.0, abs=0.5)
    assert any("shear baseline of 10.9 N" in flag.message for flag in plates[0].flags)


@pytest.mark.slow
def test_definitions_move_rcof_as_known():
    """Medians over 45 stances elsewhere: corrected +0.008, 8th order +0.009, none +0.019."""
    trials = [_trial(name) for name, *_ in SEEN]
    median = {
        name: float(np.median([value for trial in trials for value in _rcof(trial, name)]))
        for name in DEFINITIONS
        if name != "gate-body-weight"
    }
    assert 0.003 < median["corrected-cutoff"] - median["default"] < 0.02
    assert 0.003 < median["eighth-order"] - median["default"] < 0.02
    assert 0.008 < median["unfiltered"] - median["default"] < 0.04
    assert median["peak-3"] < median["default"]
    assert abs(median["anterior-posterior"] - median["default"]) < 0.012
    assert median["gate-50"] == pytest.approx(median["default"], abs=1e-9)


def test_forces_named_in_body_weight_need_the_mass():
    heavy = required_frictions(
        walkway_of(_trial("biomechzoo/HC030A05.c3d")), DEFINITIONS["gate-body-weight"]
    )
    assert all(f.measurement.estimated for f in heavy)
    none = required_frictions(walkway_of(_trial("bmc/Gait.c3d")), DEFINITIONS["gate-body-weight"])
    assert all("mass is not known" in f.measurement.reason for f in none)


def test_walking_direction_can_be_given_and_heels_are_found():
    trial = _trial("kineticstoolkit/c3d_sample.c3d")
    assert heel_candidates(trial)["right"] == ["r heel"]
    found = required_frictions(walkway_of(trial, walking="+x"))
    assert all(f.stance.direction.source == "given" for f in found)
    backward = required_frictions(walkway_of(trial, walking="-x"))
    assert all("no braking" in f.measurement.reason for f in backward)
    with pytest.raises(InputError, match="vertical axis"):
        axes_of(trial, walking="y")


def test_turned_laboratories_give_the_same_numbers():
    """RCOF must not depend on the laboratory's axes: rotate everything by 90 and by 33 degrees."""
    trial = _trial("biomechzoo/HC030A05.c3d")
    expected = _rcof(trial)
    for angle in (np.pi / 2, 0.576):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        plates = tuple(
            replace(p, force=p.force @ turn.T, corners=p.corners @ turn.T, centre_of_pressure=None)
            for p in trial.plates
        )
        markers = {
            name: replace(m, positions=m.positions @ turn.T) for name, m in trial.markers.items()
        }
        assert _rcof(replace(trial, plates=plates, markers=markers)) == pytest.approx(expected)


def test_nobody_slips_in_dry_walking():
    """Speed peak between the first two minima: 0.03-0.08 m/s in this set (its description)."""
    trial = _trial("biomechzoo/HC030A05.c3d")
    for stance in stances(walkway_of(trial)):
        slip = slip_of(walkway_of(trial), stance)
        assert slip.slipped is False
        assert 0.03 <= slip.peak_speed.value < 0.085
        assert slip.margin.value == pytest.approx(slip.peak_speed.value - 0.2)
        assert 0.0005 < slip.distance.value < 0.016  # "dry: 1-16 mm"


def test_contacts_from_heels_alone_agree_with_the_plates():
    for name in ("biomechzoo/HC030A05.c3d", "kineticstoolkit/c3d_sample.c3d", "walk1"):
        trial = _trial(name)
        axes = axes_of(trial)
        for stance in stances(walkway_of(trial)):
            found = contact_from_heel(trial.marker(stance.heel), axes.up)
            assert min(abs(time - stance.contact) for time in found) < 0.025


def test_mean_of_steps():
    found = [
        f.measurement
        for f in required_frictions(walkway_of(_trial("kineticstoolkit/c3d_sample.c3d")))
    ]
    mean = mean_of(found)
    values = [m.value for m in found]
    assert mean.value == pytest.approx(np.mean(values))
    assert mean.uncertainty == pytest.approx(np.std(values, ddof=1) / np.sqrt(3))
    other = required_frictions(
        walkway_of(_trial("bmc/Gait.c3d")), RcofDefinition(filter=LowPass(cutoff=20.0))
    )
    with pytest.raises(InputError, match="different conventions"):
        mean_of([*found, other[0].measurement])
    none = mean_of([Measurement.not_estimated("rcof", "cut"), Measurement("rcof", 0.2)])
    assert none.uncertainty is None
    assert "1 of 2" in none.flags[0].message
