"""Made-up recordings: what each maker writes, and the walks inside."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.simulator.activities import ACTIVITIES, activity, activity_c3d
from underfoot.trials.simulator.c3d_file import NOTICE, walk_c3d
from underfoot.trials.simulator.folder import (
    KINDS,
    NAMES,
    SHOES,
    ScanTruth,
    disk_run,
    relaxation,
    scan_columns,
    simulated_study,
    slip_truth,
)
from underfoot.trials.simulator.treadmill import treadmill_walk
from underfoot.trials.simulator.walk import (
    Defects,
    SlipTruth,
    foot_markers,
    heel_path,
    plate_corners,
    raised_cosines,
    stance_load,
    stance_ratio,
    walk_with_slip,
)

NOISELESS = Defects(0.0, 0.0, 0.0, 0.0, 0.0)


def rng():
    return np.random.default_rng(5)


def test_parts_of_a_walk(file_regression):
    time = np.linspace(0.0, 2.0, 21)
    knots = [(0.2, 1.0), (0.5, 3.0), (1.5, 0.5)]
    share = np.linspace(-0.1, 1.1, 13)
    heel = heel_path(time, 0.6, np.array([1.0, 2.0, 0.3]), knots, [(0.0, 0.0), (1.0, 0.1)], 0.5)
    marks = foot_markers({"R": heel[:2], "L": heel[2:4]}, heel[:2], (0.2, 0.1, 0.02), 0.1, 0.05)
    held(
        file_regression,
        {
            "cosines": raised_cosines(time, knots).tolist(),
            "heel": heel,
            "landing": heel[6],
            "corners": [plate_corners(0.5).tolist(), plate_corners(0.0, 0.45, 0.17).tolist()],
            "load": stance_load(share).tolist(),
            "load, weaker": stance_load(share, 0.5).tolist(),
            "ratio": stance_ratio(share).tolist(),
            "markers": marks,
            "at rest": raised_cosines(np.array([0.0, 0.2, 1.5, 9.0]), knots).tolist(),
        },
    )


@pytest.mark.parametrize("name", ["plain", "noisy", "slow"])
def test_walk_with_slip(file_regression, name):
    truth, defects = {
        "plain": (SlipTruth(), NOISELESS),
        "noisy": (
            SlipTruth(angle=0.2, lateral=-0.01),
            Defects(missing_frames=6, dropped_samples=9),
        ),
        "slow": (replace(SlipTruth(), peak_speed=0.05, rise=0.4, fall=0.5, mass=50.0), NOISELESS),
    }[name]
    made = walk_with_slip(truth, defects, rng(), duration=3.6)
    held(file_regression, made, f"walk_{name}")


def test_treadmill(file_regression):
    held(
        file_regression,
        {
            "even": treadmill_walk(rng(), stances=5),
            "split": treadmill_walk(
                rng(), stances=7, speeds=(0.9, 1.4), rcof=0.3, mass=50.0, slip=0.06
            ),
            "whole": {name: path.shape for name, path in treadmill_walk(rng()).markers.items()},
        },
    )


def test_activities(file_regression):
    made = {name: activity(name, rng()) for name in ACTIVITIES}
    parts = {
        name: {
            "force": one.force,
            "centre": one.centre,
            "corners": one.corners,
            "heel": one.markers["LHEE"],
            "pelvis": one.markers["RASI"],
        }
        for name, one in made.items()
    }
    bare = activity("walk", rng(), mass=50.0, markers=False)
    held(file_regression, {**parts, "without markers": bare})


def test_tester_columns(file_regression):
    truth = ScanTruth()
    other = ScanTruth(0.2, 2000.0, (0.01, 0.02), (0.03, -0.01), 250.0, 0.3, 0.1)
    held(
        file_regression,
        {
            "truth": truth,
            "load": (truth.load, other.load),
            "covered": (
                truth.covered_load(np.array([-0.02, 0.01, 0.03]), 0.01),
                other.covered_load(np.array([0.0]), 0.02, 0.0, 0.05),
            ),
            "scan": scan_columns(truth, 0.004, rng(), noise=0.0),
            "noisy": scan_columns(other, -0.004, rng()),
            "disk": disk_run(0.3, 0.5, rng()),
            "loaded": disk_run(0.1, 0.05, rng(), load=5.0),
            "block": relaxation(rng()),
            "other block": relaxation(rng(), thickness=0.004, peak=100.0, share=0.2, rate=0.1),
        },
    )


def test_slip_truth(file_regression):
    held(
        file_regression,
        {
            "kinds": KINDS,
            "names": NAMES,
            "shoes": SHOES,
            "activities": ACTIVITIES,
            "notice": NOTICE,
            "truth": [slip_truth(number, 3) for number in range(9)],
        },
    )


@pytest.mark.parametrize("kind", [*KINDS, "persons"])
def test_folder(file_regression, tmp_path, kind):
    told = []

    def progress(stage, share, residual=None):
        told.append((stage, round(share, 3)))

    if kind == "persons":
        paths = simulated_study(tmp_path, persons=1, trials=1, seed=4, progress=progress)
    else:
        paths = simulated_folder(kind, tmp_path, count=1, seed=2, progress=progress)
    tables = {}
    for path in sorted({*tmp_path.iterdir()} - {*paths}):
        tables[path.name] = path.read_text(encoding="utf-8")
        if path.suffix == ".csv":
            with path.open(encoding="utf-8") as stream:
                tables[path.name] = list(csv.DictReader(stream))[:9]
    texts = [path for path in paths if path.suffix == ".csv"]
    held(
        file_regression,
        {
            "files": [path.name for path in paths],
            "tables": tables,
            "told": [told[0], told[-1]],
            "sizes": [path.stat().st_size for path in paths if path.suffix == ".c3d"],
            "lines": [path.read_text().splitlines()[::500][:4] for path in texts[:2]],
        },
        f"folder_{kind}",
    )


def test_refused(file_regression, tmp_path):
    held(
        file_regression,
        [
            refusal(simulated_folder, "slip", tmp_path),
            refusal(simulated_folder, "slips", tmp_path, count=0),
        ],
    )


def test_c3d_of_a_walk(file_regression, tmp_path):
    from underfoot.trials import read_trial

    made = walk_with_slip(SlipTruth(), NOISELESS, rng(), duration=3.6)
    files = {
        "walk": walk_c3d(made),
        "heavy": walk_c3d(made, mass=81.5, origin=0.0),
        "crossed": activity_c3d(activity("jump", rng()), crossed=True),
        "jump": activity_c3d(activity("jump", rng()), mass=70.0),
    }
    read = {}
    for name, data in files.items():
        path = tmp_path / f"{name}.c3d"
        path.write_bytes(data)
        trial = read_trial(path)
        read[name] = {
            "settings": trial.settings,
            "notes": trial.notes,
            "plates": trial.plates,
            "heel": trial.markers["LHEE"].positions,
            "pressure": trial.channels["P21"].values if "P21" in trial.channels else None,
            "plate axes": {key: one.values for key, one in list(trial.channels.items())[:6]},
        }
    held(file_regression, read)


def test_defects_of_many_slips(file_regression):
    many = [slip_truth(number, 5) for number in range(60)]
    held(
        file_regression,
        {
            "missing": " ".join(str(defects.missing_frames) for _, defects, _ in many),
            "dropped": " ".join(str(defects.dropped_samples) for _, defects, _ in many),
            "rcof": np.array([truth.rcof for truth, *_ in many]),
            "speed": np.array([truth.peak_speed for truth, *_ in many]),
        },
    )
