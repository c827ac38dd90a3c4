"""Plausible faults of a recording: the number stays right, or a caution, or no number at all.

A real walk (two plates, 45.8 kg) is written as a table with one fault each; its true RCOF are 0.216
and 0.252. Marker faults act on a made-up slip.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import UnderfootError
from underfoot.trials import (
    LowPass,
    Marker,
    Trial,
    low_passed,
    read_trial,
    required_frictions,
    slip_of,
    stances,
    walkway_of,
)
from underfoot.trials.simulator import Defects, SlipTruth, walk_c3d, walk_with_slip
from underfoot.trials.walking.slips import Outcome

DATA = Path(__file__).parents[1] / "data" / "trials"
TRUTH = {"plate 2": 0.216, "plate 1": 0.252}
TOLERANCE = 0.015
_AXES = "xyz"
PROFILE = """
[subject]
mass = "45.8 kg"
[plates.1]
force = ["Fx1", "Fy1", "Fz1"]
centre_of_pressure = ["Px1", "Py1", "Pz1"]
unit = "{unit}"
[plates.2]
force = ["Fx2", "Fy2", "Fz2"]
centre_of_pressure = ["Px2", "Py2", "Pz2"]
unit = "{unit}"
"""
Columns = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def walk() -> Columns:
    """Time, forces and centres of pressure of both plates, 2.2 s to 5 s."""
    trial = read_trial(DATA / "biomechzoo" / "HC030A05.c3d", subtract_baseline=False)
    window = (trial.plates[0].time >= 2.2) & (trial.plates[0].time <= 5.0)
    columns: Columns = {"time": trial.plates[0].time[window] - 2.2}
    for number, plate in enumerate(trial.plates, start=1):
        assert plate.centre_of_pressure is not None
        place = np.nan_to_num(plate.centre_of_pressure)
        for i, axis in enumerate(_AXES):
            columns[f"F{axis}{number}"] = plate.force[window, i]
            columns[f"P{axis}{number}"] = place[window, i]
    return columns


def _each(columns: Columns, names: str, change: Callable[[np.ndarray], np.ndarray]) -> Columns:
    """Columns whose name begins with F and an axis in ``names``, changed on both plates."""
    return {
        name: change(values.copy()) if name[0] == "F" and name[1] in names else values
        for name, values in columns.items()
    }


def _gain(names: str, factor: float) -> Callable[[Columns], Columns]:
    return lambda columns: _each(columns, names, lambda values: factor * values)


def _added(names: str, course: Callable[[np.ndarray], np.ndarray]) -> Callable[[Columns], Columns]:
    return lambda columns: _each(columns, names, lambda values: values + course(columns["time"]))


def _drift(names: str, size: float) -> Callable[[Columns], Columns]:
    return _added(names, lambda time: size * (time / time[-1] - 0.5))


def _clock(factor: float) -> Callable[[Columns], Columns]:
    return lambda columns: {**columns, "time": factor * columns["time"]}


def _thinned(step: int) -> Callable[[Columns], Columns]:
    return lambda columns: {name: values[::step] for name, values in columns.items()}


def _filtered(cutoff: float) -> Callable[[Columns], Columns]:
    return lambda columns: _each(
        columns, _AXES, lambda v: low_passed(v, 1000.0, LowPass(cutoff=cutoff))
    )


def _renamed(pairs: dict[str, str]) -> Callable[[Columns], Columns]:
    """Columns under other names: what stood under the value stands under the key."""

    def change(columns: Columns) -> Columns:
        moved = {
            f"{kind}{new}{n}": columns[f"{kind}{old}{n}"]
            for new, old in pairs.items()
            for n in (1, 2)
            for kind in "FP"
        }
        return {**columns, **moved}

    return change


def _around_peaks(
    change: Callable[[np.ndarray, int], None], names: str = _AXES, after: int = 40
) -> Callable[[Columns], Columns]:
    """Change columns in place ``after`` ms behind each contact, where the ratio peaks."""

    def faulty(columns: Columns) -> Columns:
        out = {name: values.copy() for name, values in columns.items()}
        for number in (1, 2):
            contact = int(np.argmax(out[f"Fz{number}"] > 20.0))
            for axis in names:
                change(out[f"F{axis}{number}"], contact + after)
        return out

    return faulty


def _hold(count: int) -> Callable[[np.ndarray, int], None]:
    def change(values: np.ndarray, at: int) -> None:
        values[at : at + count] = values[at]

    return change


def _zeros(count: int) -> Callable[[np.ndarray, int], None]:
    def change(values: np.ndarray, at: int) -> None:
        values[at : at + count] = 0.0

    return change


def _spike(size: float) -> Callable[[np.ndarray, int], None]:
    def change(values: np.ndarray, at: int) -> None:
        values[at] += size

    return change


def _lost(values: np.ndarray, at: int) -> None:
    values[at : at + 5] = np.nan


def _same_plate(columns: Columns) -> Columns:
    return {**columns, **{n[:2] + "1": columns[n[:2] + "2"] for n in columns if n.endswith("2")}}


def _exchanged_shear(columns: Columns) -> Columns:
    """The shear channels of the plates are exchanged."""
    swapped = {f"F{a}{n}": columns[f"F{a}{3 - n}"] for a in "xy" for n in (1, 2)}
    return {**columns, **swapped}


def _one_plate(names: str, factor: float) -> Callable[[Columns], Columns]:
    return lambda c: {**c, **{f"F{a}1": factor * c[f"F{a}1"] for a in names}}


def _swing(time: np.ndarray) -> np.ndarray:
    return 15.0 * np.sin(2 * np.pi * 20.0 * time)


FAULTS: dict[str, Callable[[Columns], Columns]] = {
    "none": lambda columns: columns,
    "kN called N": _gain(_AXES, 1e-3),
    "lbf called N": _gain(_AXES, 1 / 4.4482),
    "kgf called N": _gain(_AXES, 1 / 9.80665),
    "time in ms called s": _clock(1e3),
    "rate 2000 Hz for 1000 Hz": _clock(0.5),
    "rate 500 Hz for 1000 Hz": _clock(2.0),
    "rate 1500 Hz for 1000 Hz": _clock(1 / 1.5),
    "normal clipped": lambda c: _each(c, "z", lambda v: np.minimum(v, 400.0)),
    "shear clipped": lambda c: _each(c, "xy", lambda v: np.clip(v, -40.0, 40.0)),
    "time reversed": lambda c: {n: v if n == "time" else v[::-1] for n, v in c.items()},
    "the same plate twice": _same_plate,
    "constant zero": _gain(_AXES, 0.0),
    "20 Hz": _thinned(50),
    "50 Hz": _thinned(20),
    "100 Hz": _thinned(10),
    "500 Hz": _thinned(2),
    "x and y exchanged": _renamed({"x": "y", "y": "x"}),
    "y and z exchanged": _renamed({"y": "z", "z": "y"}),
    "x turned": _gain("x", -1.0),
    "y turned": _gain("y", -1.0),
    "shear turned": _gain("xy", -1.0),
    "all turned": _gain(_AXES, -1.0),
    "normal offset of 20 N": _added("z", lambda time: 20.0 + 0.0 * time),
    "shear offset of 20 N": _added("xy", lambda time: 20.0 + 0.0 * time),
    "x component x 10": _gain("x", 10.0),
    "y component x 10": _gain("y", 10.0),
    "normal halved": _gain("z", 0.5),
    "normal gain 1.25": _gain("z", 1.25),
    "normal gain 0.8": _gain("z", 0.8),
    "shear gain 1.5": _gain("xy", 1.5),
    "shear halved on one plate": _one_plate("xy", 0.5),
    "normal gain 1.5 on one plate": _one_plate("z", 1.5),
    "shear channels of the plates exchanged": _exchanged_shear,
    "normal drifts by 40 N": _drift("z", 40.0),
    "normal drifts by 100 N": _drift("z", 100.0),
    "shear drifts by 10 N": _drift("xy", 10.0),
    "shear drifts by 20 N": _drift("xy", 20.0),
    "shear drifts by 40 N": _drift("xy", 40.0),
    "spike of 150 N in the shear": _around_peaks(_spike(150.0), "xy"),
    "spike of 400 N in the normal force": _around_peaks(_spike(-400.0), "z"),
    "6 ms held": _around_peaks(_hold(6), after=30),
    "30 ms of zeros": _around_peaks(_zeros(30), after=20),
    "5 samples lost": _around_peaks(_lost),
    "vibration of 15 N at 20 Hz": _added("xy", _swing),
    "filtered at 6 Hz": _filtered(6.0),
    "filtered at 10 Hz": _filtered(10.0),
    "filtered at 20 Hz": _filtered(20.0),
}


def _outcomes(columns: Columns, folder: Path, unit: str = "N") -> list[tuple[str, str, float]]:
    """Plate, verdict and RCOF of every step of a table; nothing when it is refused."""
    path, profile = folder / "walk.csv", folder / "profile.toml"
    data = np.column_stack(list(columns.values()))
    head = ",".join(["time (s)", *list(columns)[1:]])
    np.savetxt(path, data, delimiter=",", header=head, comments="", fmt="%.7g")
    profile.write_text(PROFILE.format(unit=unit))
    try:
        steps = required_frictions(walkway_of(read_trial(path, profile)))
    except UnderfootError:
        return []
    return [
        (s.stance.plate, s.verdict, s.measurement.value)
        for s in steps
        if s.measurement.value is not None
    ]


def test_the_walk_itself_is_accepted(walk, tmp_path):
    found = _outcomes(walk, tmp_path)
    assert [(plate, verdict) for plate, verdict, _ in found] == [
        ("plate 2", "accepted"),
        ("plate 1", "accepted"),
    ]
    for plate, _, value in found:
        assert value == pytest.approx(TRUTH[plate], abs=1e-3)


@pytest.mark.parametrize("fault", [name for name in FAULTS if name != "none"])
def test_no_fault_is_accepted_with_a_wrong_number(walk, tmp_path, fault):
    for plate, verdict, value in _outcomes(FAULTS[fault](walk), tmp_path):
        assert verdict == "caution" or abs(value - TRUTH[plate]) <= TOLERANCE


@pytest.mark.parametrize(
    "fault", ["x turned", "x and y exchanged", "all turned", "normal offset of 20 N", "500 Hz"]
)
def test_what_is_no_fault_is_read_rightly(walk, tmp_path, fault):
    found = _outcomes(FAULTS[fault](walk), tmp_path)
    assert len(found) == 2
    for plate, _, value in found:
        assert value == pytest.approx(TRUTH[plate], abs=0.005)


def test_a_unit_that_is_named_is_converted(walk, tmp_path):
    found = _outcomes(FAULTS["kN called N"](walk), tmp_path, unit="kN")
    assert [verdict for _, verdict, _ in found] == ["accepted", "accepted"]


# ---------------------------------------------------------------------------------- markers

TRUE_SPEED, TRUE_DISTANCE = 0.612, 0.137


@pytest.fixture(scope="module")
def slipped(tmp_path_factory) -> Trial:
    truth = SlipTruth(peak_speed=TRUE_SPEED, rise=0.18, fall=0.25)
    recording = walk_with_slip(truth, Defects(), np.random.default_rng(4))
    path = tmp_path_factory.mktemp("slip") / "slip.c3d"
    path.write_bytes(walk_c3d(recording))
    return read_trial(path)


def _with_heel(trial: Trial, change: Callable[[np.ndarray, Callable[[float], int]], None]) -> Trial:
    heel = trial.markers["LHEE"]
    path = heel.positions.copy()
    change(path, lambda time: round((time - heel.start) * heel.rate))
    return replace(trial, markers={**trial.markers, "LHEE": replace(heel, positions=path)})


def _slip_of_plate_2(trial: Trial):
    stance = next(s for s in stances(walkway_of(trial)) if s.plate == "plate 2")
    return slip_of(walkway_of(trial), stance)


def test_the_slip_itself_is_right(slipped):
    one = _slip_of_plate_2(slipped)
    assert one.peak_speed.value == pytest.approx(TRUE_SPEED, rel=0.02)
    assert one.distance.value == pytest.approx(TRUE_DISTANCE, rel=0.05)
    assert (one.slipped, one.outcome, one.way) == (True, Outcome.LONG_SLIDE, "forward")
    assert not one.peak_speed.caution_flags


@pytest.mark.parametrize("count", [1, 2])
def test_a_marker_that_leaps_is_bridged_and_said(slipped, count):
    def leap(path, at):
        path[at(2.35) : at(2.35) + count] += [0.05, 0.0, 0.0]

    one = _slip_of_plate_2(_with_heel(slipped, leap))
    assert one.peak_speed.value == pytest.approx(TRUE_SPEED, rel=0.03)
    assert one.distance.value == pytest.approx(TRUE_DISTANCE, rel=0.06)
    assert "marker jumps" in [flag.name for flag in one.peak_speed.caution_flags]


def test_frames_at_zero_are_missing_frames(slipped):
    def zero(path, at):
        path[at(2.4) : at(2.4) + 5] = 0.0

    one = _slip_of_plate_2(_with_heel(slipped, zero))
    assert one.peak_speed.value == pytest.approx(TRUE_SPEED, rel=0.03)
    assert one.peak_speed.caution_flags


def test_a_long_gap_gives_no_number(slipped):
    def gap(path, at):
        path[at(2.22) : at(2.42)] = np.nan

    one = _slip_of_plate_2(_with_heel(slipped, gap))
    assert one.slipped is None
    assert "missing" in one.peak_speed.reason


def test_exchanged_heels_contradict_the_events_of_the_file():
    trial = read_trial(DATA / "biomechzoo" / "HC030A05.c3d")
    left, right = trial.markers["LHEE"], trial.markers["RHEE"]
    exchanged = replace(trial, markers={**trial.markers, "LHEE": right, "RHEE": left})
    for step in required_frictions(walkway_of(exchanged)):
        assert "side" in [flag.name for flag in step.measurement.caution_flags]


@pytest.mark.parametrize("late", [0.15, 1.0])
def test_forces_that_are_late_are_a_caution(late):
    trial = read_trial(DATA / "biomechzoo" / "HC030A05.c3d")
    plates = tuple(replace(plate, start=plate.start + late) for plate in trial.plates)
    steps = required_frictions(walkway_of(replace(trial, plates=plates)))
    assert all(step.verdict != "accepted" for step in steps)


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_forces_turned_against_the_markers_are_no_steps(turns):
    trial = read_trial(DATA / "biomechzoo" / "HC030A05.c3d")
    c, s = [(0, 1), (-1, 0), (0, -1)][turns - 1]
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    plates = tuple(replace(plate, force=plate.force @ turn.T) for plate in trial.plates)
    for step in required_frictions(walkway_of(replace(trial, plates=plates))):
        assert step.verdict != "accepted"


def test_a_marker_of_noise_alone_does_not_leap():
    from underfoot.trials.walking.slips import marker_jumps

    still = np.random.default_rng(0).normal(0.0, 3e-4, (4000, 3)) + 0.5
    assert not marker_jumps(still).any()
    assert not marker_jumps(Marker(still, 100.0).positions).any()
