"""The named gait history is the mean of the recorded steps that the package ships."""

from __future__ import annotations

from importlib import resources

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.run import run

TEXT = """
shoe = "work_shoe_half_tread"
floor = "vinyl_g4"
contaminant = "glycerol_50pct"
motion = "heel_strike_to_flat"
numerics.quick_grid_spacing = "1.2 mm"
"""
BODY_WEIGHT = 70 * 9.80665


def _tables() -> list[np.ndarray]:
    folder = resources.files("underfoot") / "data" / "gait"
    found = []
    for path in sorted(folder.iterdir(), key=lambda one: one.name):
        rows = [row for row in path.read_text(encoding="utf-8").splitlines() if row[:1] != "#"]
        body = [[float(cell or "nan") for cell in row.split(",")] for row in rows[1:]]
        found.append(np.array(body))
    return found


def test_the_history_is_the_mean_of_the_recorded_steps() -> None:
    motion = Case.from_text(TEXT).motion
    assert motion.history_points is not None
    points = motion.history_points[1:]  # the first has no load yet: the film is there before it
    times = np.array([point.time for point in points])
    tables = _tables()
    loads = np.mean([np.interp(times, t[:, 0], t[:, 1]) for t in tables], axis=0) * BODY_WEIGHT
    np.testing.assert_allclose([p.normal_force for p in points], loads, atol=0.6)
    angled = [t for t in tables if t.shape[1] > 3 and np.isfinite(t[:, 3]).all()]
    assert len(tables) == 17
    assert len(angled) == 10
    angles = np.mean([np.interp(times, t[:, 0], t[:, 3]) for t in angled], axis=0)
    np.testing.assert_allclose(np.degrees([p.shoe_angle or 0.0 for p in points]), angles, atol=0.06)


def test_a_case_with_a_history_survives_its_text() -> None:
    case = Case.from_text(TEXT)
    for complete in (False, True):
        again = Case.from_text(case.to_toml(complete=complete))
        assert again.hash == case.hash
        assert again.motion.history_points is not None
        assert case.motion.history_points is not None
        for ours, theirs in zip(
            case.motion.history_points, again.motion.history_points, strict=True
        ):
            assert theirs.normal_force == pytest.approx(ours.normal_force)
            assert theirs.shoe_angle == pytest.approx(ours.shoe_angle)


@pytest.mark.slow
def test_a_heel_strikes_and_rolls_flat() -> None:
    result = run(Case.from_text(TEXT), quick=True)
    assert result.status.usable
    time = result.fields["time"].values
    load = result.fields["load_history"].values
    assert time[-1] == pytest.approx(0.15)
    assert load[-1] == pytest.approx(713, rel=1e-3)
    assert np.all(np.isfinite(result.fields["cof_history"].values))
    fluid = result.fields["fluid_load_history"].values
    assert np.all(fluid <= load * 1.001)
