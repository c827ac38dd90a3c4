"""Limits of checks and readers, each from both sides: what lies between was seen by no test."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from trial_exports import fscan
from underfoot.trials import read_trial, stances
from underfoot.trials.walking import step_features
from underfoot.trials.walking.plausibility import LATE, _marker_flags
from underfoot.trials.walking.processed import dead_time
from underfoot.trials.walking.step import Step
from underfoot.trials.walking.walkway import walkway_of

WALK = Path(__file__).parents[1] / "data" / "trials" / "biomechzoo" / "HC030A05.c3d"


@pytest.fixture(scope="module")
def walk():
    return walkway_of(read_trial(WALK))


@pytest.mark.parametrize(
    ("late", "duration", "told"),
    [
        (0.05, 0.62, False), (0.07, 0.62, True), (0.05, 0.40, False), (0.07, 0.40, True),
        (0.11, 1.30, False), (0.13, 1.30, True),
    ],
)  # fmt: skip
def test_slow_feet_may_land_as_slowly(walk, late, duration, told):
    """0.06 s between heel and force; twice as much in a stance of twice 0.65 s, never less."""
    stance = stances(walk)[0]
    landed = next(
        flag.measured for flag in _marker_flags(Step(
            walk, replace(stance, contact=stance.contact + 0.2, toe_off=stance.contact + 0.8)
        )) if flag.name == LATE.name
    )  # fmt: skip
    contact = stance.contact + 0.2 - landed + late
    shifted = replace(stance, contact=contact, toe_off=contact + duration)
    flags = [flag for flag in _marker_flags(Step(walk, shifted)) if flag.name == LATE.name]
    assert [flag.measured for flag in flags] == ([pytest.approx(late)] if told else [])


def test_a_step_s_features_need_no_more_of_the_markers_than_is_looked_at(walk, monkeypatch):
    """0.3 s on both sides let the filter settle; more of the record changes nothing."""
    contacts = stances(walk)
    near = [step_features.step_features(Step(walk, stance)) for stance in contacts]
    monkeypatch.setattr(step_features, "frames_between", lambda *given, **more: slice(None))
    for stance, features in zip(contacts, near, strict=True):
        assert "slope of the force line" in features
        assert features == pytest.approx(
            step_features.step_features(Step(walk, stance)), rel=0, abs=1e-4
        )


@pytest.mark.parametrize(("share", "told"), [(1.0, True), (0.9, True), (0.89, False)])
def test_a_level_of_rest_is_that_of_nine_samples_in_ten(share, told):
    """A force of 1 kHz that rests 60 ms at its level while it is loaded."""
    rng, rate = np.random.default_rng(0), 1000.0
    force = np.zeros(2000)
    force[1000:1600] = 100.0 + rng.normal(0, 1, 600)
    force[1200:1260] = 0.0
    looked = slice(700, 980)  # from 0.3 s to 0.02 s before the contact
    other = rng.permutation(280)[: round((1.0 - share) * 280)]
    force[looked][other] = 0.5
    assert (dead_time(force, rate, 1000, 1600) == pytest.approx(0.06, abs=0.002)) == told


@pytest.mark.parametrize(
    ("lengths", "kept"),
    [((50, 100, 100, 100, 200), 100), ((200, 200, 100, 50), 200), ((100, 100, 200, 200), 100)],
)
def test_arrays_of_the_commonest_length_are_a_trial(tmp_path, lengths, kept):
    names = [f"M{i}" for i in range(len(lengths))]
    arrays = {name: np.ones((n, 3)) for name, n in zip(names, lengths, strict=True)}
    used = {name for name, n in zip(names, lengths, strict=True) if n == kept}
    for order in (1, -1):
        out = io.BytesIO()
        savemat(out, {"rate": 100.0, **{name: arrays[name] for name in names[::order]}})
        (tmp_path / "a.mat").write_bytes(out.getvalue())
        trial = read_trial(tmp_path / "a.mat")
        assert set(trial.markers) == used
        assert {len(marker.positions) for marker in trial.markers.values()} == {kept}
        (note,) = (note for note in trial.notes if "of another length" in note)
        assert all((name in note) == (name not in used) for name in names)


@pytest.mark.parametrize(
    ("rows", "columns", "metres"),
    [(5.08, 4.0, 1e-3), (0.7, 0.4, 1e-3), (0.00508, 0.004, 1.0), (0.4, 0.3, 1.0)],
)
def test_cells_are_in_millimetres_above_half_of_one(tmp_path, rows, columns, metres):
    text = fscan().decode().replace("ROW_SPACING 5.08", f"ROW_SPACING {rows}")
    text = text.replace("COL_SPACING 5.08", f"COL_SPACING {columns}")
    (tmp_path / "anna.asf").write_text(text)
    force = read_trial(tmp_path / "anna.asf").channel("insole, force").values
    area = rows * columns * metres**2
    assert force == pytest.approx([10e3 * i * area for i in range(20)])
