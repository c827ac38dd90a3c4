"""Gait histories: the packaged tables, recordings, tables of one's own."""

import re
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.slip.dynamics import Population, history_text, load_history, packaged_histories
from underfoot.slip.dynamics.recorded import heel_over_floor, recorded_histories
from underfoot.trials.walking.slips import HeelMotion

DATA = Path(__file__).parents[1] / "data" / "trials"
RECORDINGS = {
    "biomechzoo": "HC030A05.c3d",
    "bmc": "Gait.c3d",
    "kineticstoolkit": "c3d_sample.c3d",
    "btk": "ADemo1_rewrite_c3d_pc_integer.c3d",
}
PACKAGED = {history.name: history for history in packaged_histories()}


def test_packaged_steps_are_walking():
    assert len(PACKAGED) == 17
    rcof = np.array([h.rcof for h in PACKAGED.values()])
    assert 0.15 < rcof.min() < rcof.max() < 0.3
    for history in PACKAGED.values():
        assert 0.9 < history.normal.max() < 1.5
        assert 0.4 < history.duration < 0.85
        assert 0.4 < history.end_of_braking / history.duration < 0.65
        assert "github.com" in history.source
        assert history.heel_speed is None or 0.15 < history.heel_speed < 0.7


@pytest.mark.parametrize("folder", RECORDINGS)
def test_packaged_tables_are_what_the_recordings_give(folder):
    for found in recorded_histories(DATA / folder / RECORDINGS[folder]):
        stem = re.sub(r"[^a-z0-9]+", "_", found.name.lower().replace("_rewrite_c3d_pc_integer", ""))
        kept = PACKAGED[f"{folder}_{stem}"]
        assert np.abs(found.time - kept.time).max() < 1e-9
        assert np.abs(found.normal - kept.normal).max() < 1e-4
        assert np.abs(found.ratio - kept.ratio).max() < 1e-4
        if found.foot_angle is not None:
            assert kept.foot_angle is not None
            assert np.abs(found.foot_angle - kept.foot_angle).max() < 2e-4
        if found.heel_velocity is not None:
            assert kept.heel_velocity is not None
            assert np.abs(found.heel_velocity - kept.heel_velocity).max() < 6e-4


def test_defaults_of_the_population_are_those_of_the_steps():
    heel = np.array([h.heel_speed for h in PACKAGED.values() if h.heel_speed is not None])
    pace = np.array([h.walking_speed for h in PACKAGED.values() if h.walking_speed is not None])
    angle = np.array([h.foot_angle[0] for h in PACKAGED.values() if h.foot_angle is not None])
    assert len(heel) == len(pace) == 13
    assert (heel.mean(), heel.std(ddof=1)) == pytest.approx((0.33, 0.12), abs=0.006)
    assert (pace.mean(), pace.std(ddof=1)) == pytest.approx((1.35, 0.18), abs=0.006)
    assert np.degrees(angle.std(ddof=1)) == pytest.approx(4.0, abs=0.3)


def test_defaults_of_the_brake_are_those_of_the_steps():
    told = [(h.time, h.landing) for h in PACKAGED.values()]
    told = [(time, left) for time, left in told if left is not None]
    times, late = [], []
    for time, left in told:
        assert left[0] == 1.0
        assert (np.diff(left) <= 0).all()
        assert left[-1] == 0.0
        times.append(np.trapezoid(left, time))
        late.append(time[np.argmax(left < 0.1)])
    assert len(told) == 10
    assert (np.mean(times), np.std(times, ddof=1)) == pytest.approx((0.011, 0.007), abs=5e-4)
    assert np.mean(late) == pytest.approx(0.028, abs=1e-3)  # slips start at 0.02 s: Iraqi 2018


def test_default_load_in_slips_is_the_published_one_over_the_steps_own():
    largest = np.mean([history.normal.max() for history in PACKAGED.values()])
    low, high = Population().weight_transfer
    assert (low * largest, high * largest) == pytest.approx((0.40, 0.85), abs=0.01)


def test_default_spread_of_steps_is_that_of_repeated_steps():
    persons = ("biomechzoo_hc030", "biomechzoo_hc032", "biomechzoo_hc036", "bmc_gait", "bmc_walk1",
               "kineticstoolkit")  # fmt: skip
    rcof = [[h.rcof for name, h in PACKAGED.items() if name.startswith(p)] for p in persons]
    squares = sum(len(each) * np.var(each) for each in rcof)
    freedom = sum(len(each) - 1 for each in rcof)
    assert (sum(map(len, rcof)), freedom) == (14, 8)
    assert Population().rcof_step.sd == pytest.approx(np.sqrt(squares / freedom), abs=5e-4)


def test_a_heel_that_rolls_on_the_floor_does_not_slide():
    """A rigid foot turns about its heel's rear edge; heel marker 30 mm up, 10 mm behind it."""
    time, rate = np.linspace(0, 0.1, 11), -4.0
    up, walking = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])

    def marker(behind, height, sliding):
        angle = 0.3 + rate * time
        cos, sin = np.cos(angle), np.sin(angle)
        place = np.column_stack(
            [behind * cos - height * sin, 0 * time, behind * sin + height * cos]
        )
        speed = rate * np.column_stack([-place[:, 2], 0 * time, place[:, 0]])
        still = np.zeros(time.size)
        return HeelMotion(
            time, place, speed + sliding * walking, still, still > 0, 0.0, 0.0, still > 0
        )

    for sliding in (0.0, 0.25):
        heel, toe = marker(-0.01, 0.03, sliding), marker(0.2, 0.05, sliding)
        found = heel_over_floor(heel, toe, up, walking, 0.0)
        assert np.abs(found - sliding).max() < 1e-12


def test_a_table_is_read_as_it_was_written(tmp_path):
    history = PACKAGED["bmc_gait_plate_1"]
    path = tmp_path / "own.csv"
    path.write_text(history_text(history, {"source": "me"}), encoding="utf-8")
    found = load_history(path)
    assert np.abs(found.ratio - history.ratio).max() < 1e-9
    assert found.heel_velocity is not None
    assert history.heel_velocity is not None
    assert np.abs(found.heel_velocity - history.heel_velocity).max() < 1e-9
    assert found.walking_speed == history.walking_speed
    assert found.source == "me"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("time_s,normal_per_body_weight\n0,1\n", "shear_ratio is missing"),
        ("time_s,normal_per_body_weight,shear_ratio\n0,1,x\n", "no number"),
        ("time_s,normal_per_body_weight,shear_ratio\n0,1,0.2\n0.1,1,0.2\n", "5 or more"),
        ("", "empty"),
    ],
)
def test_tables_that_are_none_say_why(tmp_path, text, says):
    path = tmp_path / "own.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises((InputError, DataError), match=says):
        load_history(path)


def test_a_recording_without_a_step_says_why():
    with pytest.raises(InputError, match="no step can be used"):
        recorded_histories(DATA / "bmc" / "walk1.trc")
