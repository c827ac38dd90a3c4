"""Faults that leave a plausible number: averages, dead bands, toes that slide, one plate's gain."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.trials import Marker, finished_plate, read_trial, required_frictions, walkway_of
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study.file_result import FileResult, StepResult
from underfoot.trials.study.study_guard import study_doubts
from underfoot.trials.walking.likelihood import Reference, references, unseen_gain
from underfoot.trials.walking.plausibility import rcof_flags
from underfoot.trials.walking.slips import contact_from_heel

DATA = Path(__file__).parents[1] / "data" / "trials"
WALKS = ["biomechzoo/HC030A05.c3d", "bmc/Gait.c3d", "kineticstoolkit/c3d_sample.c3d"]


def changed(trial, change):
    """The trial with ``change`` (values, rate) on each shear component of its plates."""
    up = walkway_of(trial).up
    plates = []
    for plate in trial.plates:
        force = plate.force.copy()
        for axis in np.flatnonzero(up == 0.0):
            force[:, axis] = change(force[:, axis], plate.rate)
        centre = plate.centre_of_pressure
        plates.append(
            finished_plate(
                plate.name, force, rate=plate.rate, start=plate.start, up=up,
                corners=plate.corners, centre_of_pressure=centre,
            )
        )  # fmt: skip
    return replace(trial, plates=tuple(plates))


def cautions(trial):
    steps = [step.measurement for step in required_frictions(walkway_of(trial))]
    kept = [{flag.name for flag in one.caution_flags} for one in steps if one.estimated]
    assert kept
    return kept


@pytest.mark.parametrize("name", WALKS)
@pytest.mark.parametrize("window", [0.04, 0.073, 0.11])
def test_a_moving_average_of_the_shear_is_noticed(name, window):
    def mean(values, rate):
        count = round(window * rate)
        return np.convolve(values, np.full(count, 1.0 / count), "same")

    trial = read_trial(DATA / name, subtract_baseline=False)
    assert not any("moving average" in names for names in cautions(trial))
    assert all("moving average" in names for names in cautions(changed(trial, mean)))


@pytest.mark.parametrize("name", WALKS)
def test_a_dead_band_is_noticed_and_a_coarse_converter_is_none(name):
    trial = read_trial(DATA / name, subtract_baseline=False)

    def band(values, _):
        return np.sign(values) * np.maximum(np.abs(values) - 20.0, 0.0)

    assert all("dead band" in names for names in cautions(changed(trial, band)))
    coarse = changed(trial, lambda values, _: np.round(values))
    assert not any("dead band" in names for names in cautions(coarse))


def test_a_toe_that_slides_at_push_off_is_a_caution():
    trial = read_trial(DATA / WALKS[0])
    walk = walkway_of(trial)
    (stance, *_) = [step.stance for step in required_frictions(walk) if step.stance.accepted]
    name = walk.toes[stance.side]
    marker = trial.markers[name]
    share = np.clip((marker.time - stance.contact - 0.6 * stance.duration) / 0.12, 0.0, 1.0)
    moved = np.outer(0.05 * share, -stance.walking)
    slid = replace(marker, positions=marker.positions + moved)
    found = cautions(replace(trial, markers={**trial.markers, name: slid}))
    assert "toe slip" in found[0]
    assert not any("toe slip" in names for names in cautions(trial))


def study(gain):
    rng = np.random.default_rng(3)
    files = []
    for i in range(10):
        own = rng.normal(0.2, 0.02)
        steps = tuple(
            StepResult(plate=plate, rcof=own * factor * rng.normal(1.0, 0.05), peak_force=700.0)
            for plate, factor in (("plate 1", gain), ("plate 2", 1.0))
        )
        files.append(FileResult(f"{i}.c3d", steps=steps))
    return [
        d.message for d in study_doubts(files, protocol("level_walking")) if "plate" in d.message
    ]


def test_a_plate_of_another_gain_is_a_doubt_of_the_study():
    (words,) = study(0.8)
    assert "RCOF is -2" in words
    assert "plate 1 against plate 2 in 10 recordings" in words
    assert not study(1.0)


def test_the_bound_of_unseen_gains_is_that_of_the_narrowest_features():
    """0.2 and limits of 20 and 10 %, as squares: 0.2 (exp(0.206) - 1)."""
    log = math.log

    def narrow(feature, reach):
        one = Reference(feature, 0.0, 1.0, 1000, 1000, True, True, "", "")
        return replace(one, sd=log(1.0 + reach) / one.limit(1e-12))

    known = narrow("slope of the force line", 0.2), narrow("mass by acceleration", 0.1)
    features = dict.fromkeys([one.feature for one in known], 0.0)
    (flag,) = unseen_gain(features, 0.2, mass=True, known=known)
    both = math.hypot(log(1.2), log(1.1))
    assert flag.measured == pytest.approx(0.2 * (math.exp(both) - 1.0), rel=1e-3)
    assert not flag.matters
    (wider,) = unseen_gain({known[0].feature: 0.0}, 0.2, mass=False, known=known)
    assert (wider.measured or 0.0) > (flag.measured or 1.0)


def test_a_gain_that_drifts_within_a_step_is_bound_by_the_half_that_brakes():
    """A gain of 0.45 at contact and 1 at toe off hides in the impulse of both halves."""
    known = [one for one in references() if one.logarithm]
    features = {one.feature: one.mean for one in known}
    (flag,) = unseen_gain(features, 0.13, mass=True)
    (even,) = unseen_gain(
        {n: v for n, v in features.items() if "braking" not in n}, 0.13, mass=True
    )
    braking = next(one for one in known if one.feature == "braking impulse")
    reach = braking.limit(braking.mean + 1e-9) - braking.mean
    assert flag.measured == pytest.approx(0.13 * math.expm1(math.hypot(reach, 0.14)), rel=1e-3)
    assert (flag.measured or 0.0) > 1.5 * (even.measured or 1.0)


def test_a_slow_walk_may_need_less_friction():
    assert rcof_flags(0.08)
    assert rcof_flags(0.08, speed=1.3)
    assert not rcof_flags(0.08, speed=0.6)
    assert rcof_flags(0.02, speed=0.6)


def test_a_heel_that_hovers_lands_where_it_stands():
    """A slow foot stops 4 mm above the floor, rises by 2 mm and lands 0.16 s later."""
    time = np.arange(300) / 100.0
    knots = {0.0: 60, 0.9: 60, 1.2: 4, 1.28: 6, 1.36: 0.2, 1.44: 2, 1.5: 1, 3.0: 1}
    height = np.interp(time, list(knots), list(knots.values())) / 1000.0
    marker = Marker(np.column_stack((0.5 * time, 0.0 * time, height)), 100.0)
    (landing,) = contact_from_heel(marker, np.array([0.0, 0.0, 1.0]))
    assert landing == pytest.approx(1.36, abs=0.02)
