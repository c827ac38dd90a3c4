"""Gait histories: the packaged tables, recordings, tables of one's own."""

import re
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.slip.dynamics import history_text, load_history, packaged_histories
from underfoot.slip.dynamics.recorded import recorded_histories

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


def test_defaults_of_the_population_are_those_of_the_steps():
    heel = np.array([h.heel_speed for h in PACKAGED.values() if h.heel_speed is not None])
    pace = np.array([h.walking_speed for h in PACKAGED.values() if h.walking_speed is not None])
    angle = np.array([h.foot_angle[0] for h in PACKAGED.values() if h.foot_angle is not None])
    assert len(heel) == len(pace) == 13
    assert (heel.mean(), heel.std(ddof=1)) == pytest.approx((0.33, 0.12), abs=0.006)
    assert (pace.mean(), pace.std(ddof=1)) == pytest.approx((1.35, 0.18), abs=0.006)
    assert np.degrees(angle.std(ddof=1)) == pytest.approx(4.0, abs=0.3)


def test_a_table_is_read_as_it_was_written(tmp_path):
    history = PACKAGED["bmc_gait_plate_1"]
    path = tmp_path / "own.csv"
    path.write_text(history_text(history, {"source": "me"}), encoding="utf-8")
    found = load_history(path)
    assert np.abs(found.ratio - history.ratio).max() < 1e-9
    assert found.walking_speed == history.walking_speed
    assert found.source == "me"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("time_s,normal_per_body_weight\n0,1\n", "shear_ratio is missing"),
        ("time_s,normal_per_body_weight,shear_ratio\n0,1,x\n", "no number"),
        ("time_s,normal_per_body_weight,shear_ratio\n0,1,0.2\n0.1,1,0.2\n", "5 or more"),
        ("", "is missing"),
    ],
)
def test_tables_that_are_none_say_why(tmp_path, text, says):
    path = tmp_path / "own.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=says):
        load_history(path)


def test_a_recording_without_a_step_says_why():
    with pytest.raises(InputError, match="no step can be used"):
        recorded_histories(DATA / "bmc" / "walk1.trc")
