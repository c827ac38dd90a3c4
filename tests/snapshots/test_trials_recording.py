"""What a recording is made of: axes, marker names, plates, filters, protocols, calibrations."""

import datetime
from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.core.remark import Message
from underfoot.trials.recording.axes import (
    PLATE_FRAMES,
    Ramp,
    axes_of,
    axis_name,
    axis_vector,
    body_markers,
    found_vertical,
    marker_velocity,
    moving_markers,
    ramp_from,
    walking_direction,
)
from underfoot.trials.recording.marker_names import (
    LANDMARKS,
    checked_landmark,
    heel_candidates,
    landmark,
    own_landmarks,
    pelvis_markers,
    toe_candidates,
)
from underfoot.trials.recording.measurement import Flag, Measurement, caution, mean_of, remark
from underfoot.trials.recording.plates import (
    CHANNELS,
    Contact,
    channel_forces,
    finished_plate,
    ordered_corners,
    plate_axes,
    plate_contacts,
    plate_named,
    plate_normal,
    plate_up,
    refused_plate,
)
from underfoot.trials.recording.protocols import KINDS, protocol, protocol_names
from underfoot.trials.recording.signals import (
    FILTERS,
    LowPass,
    along,
    bridge_gaps,
    contacts,
    enough,
    frames_between,
    is_saturated,
    longest_run,
    low_passed,
    low_passed_part,
    runs,
    unloaded_samples,
    velocity,
)
from underfoot.trials.recording.tester_calibration import day_of, read_calibration, written_day
from underfoot.trials.recording.trial import (
    Channel,
    Edit,
    Event,
    Marker,
    Plate,
    PlateAccuracy,
    Trial,
    Vertical,
    join_trials,
)

UP = np.array([0.0, 0.0, 1.0])
CORNERS = np.array([[0.6, 0.4, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.0], [0.6, 0.0, 0.0]])


def marker(speed=(0.0, 0.0, 0.0), place=(0.0, 0.0, 1.0), frames=60, rate=50.0, lost=(), wobble=0.0):
    time = np.arange(frames)[:, None] / rate
    path = np.array(place) + time * np.array(speed) + wobble * np.sin(9.0 * time)
    path[list(lost)] = np.nan
    return Marker(path, rate)


def step_force(rate=500.0, peak=700.0, seconds=2.0, begin=0.5, lasting=0.7, shear=0.2, level=0.0):
    time = np.arange(round(seconds * rate)) / rate
    share = np.clip((time - begin) / lasting, 0.0, 1.0)
    load = np.where(share < 1.0, peak * np.sin(np.pi * share), 0.0)
    ratio = 0.05 - shear * np.cos(np.pi * share)
    return np.column_stack((ratio * load, 0.1 * load, load)) + level


def parts(plate):
    """What was computed of a plate."""
    names = ("force", "moment", "centre_of_pressure", "baseline", "baseline_samples", "saturated")
    flags = [
        (flag.name, str(flag), flag.matters, flag.measured, flag.limit) for flag in plate.flags
    ]
    return {**{name: getattr(plate, name) for name in names}, "flags": flags}


def test_ramps(file_regression):
    walking = np.array([1.0, 0.0, 0.0])
    ramps = [
        Ramp(),
        ramp_from("10 deg", "surface"),
        ramp_from("-10 deg", "horizontal"),
        ramp_from("30 deg", "surface"),
        Ramp(0.0, "surface"),
    ]
    held(
        file_regression,
        {
            "ramps": [
                {
                    "ramp": one,
                    "name": one.name,
                    "said": one.description,
                    "surface": one.surface(UP, walking),
                    "gravity": one.gravity(UP, walking),
                }
                for one in ramps
            ],
            "frames": PLATE_FRAMES,
            "refused": [
                refusal(ramp_from, *x)
                for x in (
                    ("30.1 deg", "surface"),
                    ("-31 deg", "surface"),
                    ("10 deg",),
                    ("10 deg", "plate"),
                )
            ],
        },
    )


def test_axes(file_regression):
    walk = {f"M{i}": marker((1.2, 0.1 * i, 0.05), (0.1 * i, 0.0, 0.3 * i)) for i in range(5)}
    slow = {f"M{i}": marker((0.29, 0.0, 0.0), (0.1 * i, 0.0, 0.3 * i)) for i in range(5)}
    still = {"A": marker(place=(0, 0, 0.0)), "B": marker(place=(0.1, 2.0, 0.1), wobble=0.004)}
    plate = finished_plate("one", step_force(), rate=500.0, up=UP, corners=CORNERS)
    head = {
        "LHEE": marker((1, 0, 0), (0, 0, -0.1)),
        "RHEE": marker((1, 0, 0), (0, 0.2, -0.1)),
        "A": marker((1, 0, 0), (0, 0, -1.0)),
        "B": marker((1, 0, 0), (0, 0, -1.3)),
    }
    trials = {
        "walk": Trial("", markers=walk),
        "slow": Trial("", markers=slow),
        "still": Trial("", markers=still),
        "nothing": Trial(""),
        "plate": Trial("", plates=(plate,)),
        "both": Trial("", plates=(plate,), markers=walk),
        "told": Trial("", markers=walk, vertical=Vertical((0.0, 1.0, 0.0), "file")),
    }
    known = axes_of(trials["walk"], vertical="+z", walking="-y")
    forces = [step_force()[:, [2, 0, 1]], step_force()]
    low = [np.tile([0.0, 15.0, 3.0], (200, 1))]
    stated = Vertical((0.0, 0.0, -1.0), "stated")
    held(
        file_regression,
        {
            "axes": {name: axes_of(trial) for name, trial in trials.items()},
            "across": {name: axes_of(trial).across for name, trial in trials.items()},
            "given": known,
            "given across": known.across,
            "down": axes_of(trials["walk"], vertical="-z"),
            "names": [
                axis_name(v)
                for v in (
                    None,
                    UP,
                    -UP,
                    np.array([0.9997, 0.02, 0.0]),
                    np.array([0.6, 0.8, 0.0]),
                    np.array([0.99985, 0.017, 0.0]),
                )
            ],
            "vectors": [axis_vector(text).tolist() for text in ("x", "-x", "+y", "-z")],
            "vertical": [
                found_vertical("-y", markers={}),
                found_vertical(markers={}),
                found_vertical(markers={}, corners=[CORNERS[:, [2, 0, 1]]]),
                found_vertical(markers={}, forces=forces[:1]),
                found_vertical(markers={}, forces=forces),
                found_vertical(markers={}, forces=low),
                found_vertical(markers=walk, forces=low),
                found_vertical(markers=walk),
                found_vertical(markers=walk, stated=stated),
                found_vertical(markers=walk, forces=forces[1:], stated=stated),
                found_vertical(markers=head),
                found_vertical(markers=head, stated=stated),
                found_vertical(markers={}, forces=[np.full((9, 3), np.nan)]),
                found_vertical(markers={}, corners=[CORNERS * np.nan]),
            ],
            "velocity": [
                marker_velocity(trials["walk"], -np.inf, np.inf, None),
                marker_velocity(trials["walk"], -np.inf, np.inf, UP),
                marker_velocity(trials["walk"], 0.2, 0.4, UP),
                marker_velocity(trials["walk"], 0.2, 0.24, UP),
                marker_velocity(trials["still"], 0, 1, UP),
                marker_velocity(
                    Trial("", markers={k: marker((1.0, 0, 0), lost=range(1, 59)) for k in "abc"}),
                    -np.inf,
                    np.inf,
                    UP,
                ),
            ],
            "moving": [list(moving_markers(x)) for x in (still, {**walk, **still}, {})],
            "body": [list(body_markers(x)) for x in (still, {**walk, **still})],
            "refused": [
                refusal(axis_vector, "xy"),
                refusal(axis_vector, "w"),
                refusal(axes_of, trials["walk"], walking="+z"),
            ],
        },
    )


def test_walking_directions(file_regression):
    force = step_force(rate=200.0)
    place = np.column_stack((np.linspace(0, 0.5, 400), np.full(400, 0.2), np.zeros(400)))
    body = np.array([1.0, 0.0, 0.0])
    fast = {f"M{i}": marker((0.6, 0.8, 0.2), frames=100) for i in range(4)}
    slow = {f"M{i}": marker((0.0, 0.2, 0.0), frames=100) for i in range(4)}

    def said(markers, place, shear=1.0, walking=None, body=None):
        plate = Plate("one", force * [shear, shear, 1.0], 200.0, centre_of_pressure=place)
        contact = Contact(plate, 100, 240, UP, 700.0)
        way = walking_direction(Trial("", markers=markers), contact, walking, body)
        return [way.source, way.vector, way.explanation]

    held(
        file_regression,
        {
            "given": said(fast, place, walking="-x"),
            "markers": said(fast, place),
            "slow": said(slow, place),
            "slow of a walk": said(slow, place, body=body),
            "slow against a walk": said(slow, place, body=-body),
            "pressure": said({}, place),
            "pressure, short": said({}, 0.2 * place),
            "shear": said({}, None),
            "shear alone, weak": said({}, None, shear=0.01),
            "too short": said({}, 0.01 * place, 0.01),
        },
    )


NAMES = [
    "LHEE",
    "RHEE",
    "L_Heel",
    "heel_R",
    "Anna:LHEE",
    "L.Heel",
    "lheel2",
    "RCAL",
    "LCA",
    "RHB",
    "FersseL",
    "FerseLinks",
    "talon_g",
    "TalonDroit",
    "calcagno_d",
    "LTOE",
    "RTOE",
    "LMT5",
    "R_MT1",
    "hallux_l",
    "LMT2",
    "ZehRechts",
    "orteil_d",
    "RMTH1",
    "LASI",
    "RPSI",
    "L_ASIS",
    "r.PSIS",
    "SACR",
    "V_Sacral",
    "KreuzbeinL",
    "Becken_vorne_r",
    "RIAS",
    "LForce",
    "HeelMoment",
    "LAnkleAngle",
    "pelvis",
    "C7",
    "",
    "Heel",
    "TOE",
    "right heel",
    "LeftHeel",
    "RightToe",
    "left.toe_tip",
    "heelDist_L",
    "upper_heel_r",
    "LHEELL",
    "my_heel",
    "HEE",
    "xTOE",
    "fooL_MT2",
    "waist_l_front",
    "lwaistback",
]


def test_marker_names(file_regression):
    low, high = marker(place=(0, 0, 0.05)), marker(place=(0, 0, 1.0))
    names = {
        "LHEE": low,
        "RHEE": marker(lost=range(60)),
        "LHE": low,
        "RHE": low,
        "RCA": high,
        "LTOE": low,
        "HEEL": low,
        "RPSI": high,
        "SACR": high,
        "left mark": low,
        "Heel2": marker(place=(0, 0, 0.1), lost=(3, 4)),
    }
    trial = Trial("walk", markers=names)
    own = {"left mark": "left heel", "RCA": "right toe", "SACR": "pelvis"}
    held(
        file_regression,
        {
            "landmarks": {name: landmark(name) for name in NAMES},
            "heels": [
                heel_candidates(trial),
                heel_candidates(trial, up=UP),
                heel_candidates(trial, up=-UP),
                heel_candidates(trial, own, UP),
            ],
            "toes": [toe_candidates(trial, up=UP), toe_candidates(trial, own)],
            "pelvis": [pelvis_markers(trial), pelvis_markers(trial, own)],
            "own": own_landmarks(own, names, where="walk"),
            "places": [checked_landmark(name, "here") for name in LANDMARKS],
            "refused": [
                refusal(
                    own_landmarks, {"LHEEL": "left heel", "LH": "left heel"}, names, where="walk"
                ),
                refusal(own_landmarks, {"LHEEL": "left heel"}, [], where="walk"),
                refusal(checked_landmark, 3, "here"),
                refusal(checked_landmark, "left heal", "here"),
            ],
        },
    )


def test_measurements(file_regression):
    flag, note = caution("a doubt of {n}", n=2), remark("a remark")
    plain = Measurement("cof", 0.2, uncertainty=0.01)
    flagged = Measurement("cof", 0.3, flags=(flag, note), reason=Message("no scatter"))
    lost = Measurement.not_estimated("cof", Message("lost"), flags=(flag,), n=3)
    many = Measurement(
        "cof",
        0.25,
        uncertainty=0.01,
        n=4,
        spread=0.02,
        conventions={"filter": Message("none"), "baseline": Message("zero")},
    )
    other = Measurement(
        "cof",
        0.27,
        uncertainty=0.01,
        conventions={"filter": Message("none"), "baseline": Message("ten")},
    )
    every = {"plain": plain, "flagged": flagged, "lost": lost, "many": many}
    held(
        file_regression,
        {
            **every,
            "text": {k: str(v) for k, v in every.items()},
            "repr": {k: repr(v) for k, v in every.items()},
            "table": {k: v.table() for k, v in every.items()},
            "cautions": {k: v.cautions() for k, v in every.items()},
            "headline": {k: v.headline() for k, v in every.items()},
            "dict": {k: v.as_dict() for k, v in every.items()},
            "estimated": {k: v.estimated for k, v in every.items()},
            "mean": [
                mean_of([plain, plain]),
                mean_of([many, other]),
                mean_of([plain, lost], "mean"),
                mean_of([lost]),
                mean_of([plain]),
                mean_of([plain, Measurement("cof", 0.3)]),
            ],
            "flag": Flag("name", Message("text"), measured=2.0, limit=1.0, unit="N", source="book"),
            "refused": [
                refusal(Measurement, "cof", None),
                refusal(Measurement, "cof", None, uncertainty=0.1, reason=Message("x")),
                refusal(Measurement, "cof", np.inf),
                refusal(Measurement, "cof", 1.0, uncertainty=-0.1),
                refusal(Measurement, "cof", 1.0, uncertainty=np.inf),
                refusal(mean_of, []),
                refusal(mean_of, [plain, many]),
                refusal(mean_of, [plain, Measurement("f", 1.0, "N", uncertainty=0.1)]),
            ],
        },
    )


def test_plate_geometry(file_regression):
    tilted = CORNERS + np.outer(CORNERS[:, 0], [0.0, 0.0, 0.2])
    crossed = CORNERS[[0, 2, 1, 3]]
    held(
        file_regression,
        {
            "axes": [plate_axes(CORNERS), plate_axes(tilted), plate_axes(CORNERS[::-1])],
            "ordered": [
                ordered_corners(x, down=down)
                for x, down in (
                    (CORNERS, True),
                    (crossed, True),
                    (crossed, False),
                    (CORNERS[[0, 3, 1, 2]], True),
                    (CORNERS[:3], True),
                    (CORNERS * np.nan, True),
                    (CORNERS[[0, 1, 3, 2]], True),
                )
            ],
            "normal": [plate_normal(x) for x in (CORNERS, None, CORNERS * 0.0)],
            "up": [plate_up(x, UP) for x in (CORNERS, None, tilted, CORNERS[:, [2, 0, 1]])],
            "refused": [
                refusal(plate_axes, x)
                for x in (CORNERS[:3], CORNERS + np.inf, CORNERS * 0.01, crossed)
            ],
        },
    )


def test_channel_forces(file_regression):
    six, eight = (
        np.array([[10.0, 20.0, 300.0, 4.0, 5.0, 6.0], [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]]),
        (np.array([[1.0, 2.0, 3.0, 4.0, 50.0, 60.0, 70.0, 80.0]])),
    )
    origin = np.array([0.12, 0.2, -0.05])
    held(
        file_regression,
        {
            "channels": CHANNELS,
            "forces": {
                f"{kind} {sign}": channel_forces(
                    kind,
                    eight if kind == 3 else six,
                    origin * [1, 1, sign],
                    np.eye(6) + 0.01 * np.arange(36).reshape(6, 6) if kind == 4 else None,
                )
                for kind in (1, 2, 3, 4)
                for sign in (1, -1)
            },
            "refused": [
                refusal(channel_forces, *x)
                for x in (
                    (5, six, origin, None),
                    (3, six, origin, None),
                    (4, six, origin, None),
                    (4, six, origin, np.eye(3)),
                )
            ],
        },
    )


PLATES = {
    "plain": {},
    "reversed": {"sign": -1.0},
    "offset": {"level": [3.0, 1.0, 12.0]},
    "kept offset": {"level": [3.0, 1.0, 12.0], "subtract_baseline": False},
    "always loaded": {"level": [0.0, 0.0, 300.0]},
    "standing": {"peak": 0.0, "level": [0.0, 0.0, 800.0]},
    "hanging": {"peak": 0.0, "level": [0.0, 0.0, -800.0]},
    "huge": {"peak": 10001.0},
    "large": {"peak": 9999.0},
    "light": {"peak": 19.0},
    "idle": {"peak": 0.04},
    "half idle": {"peak": 0.06},
    "lost": {"lost": 7},
    "cut": {"cut": 600.0},
    "with a moment": {"moment": True},
    "reversed, with a moment": {"moment": True, "sign": -1.0, "level": [0.5, 0.0, 5.0]},
    "with a place": {"place": True},
    "shear": {"level": [1.5, 1.2, 0.0]},
    "less shear": {"level": [1.5, 1.3, 9.0]},
}


def test_finished_plates(file_regression):
    made = {}
    for name, change in PLATES.items():
        force = step_force(peak=change.get("peak", 700.0)) + change.get("level", 0.0)
        force = np.minimum(force, change.get("cut", np.inf)) * change.get("sign", 1.0)
        force[: change.get("lost", 0)] = np.nan
        options = {key: change[key] for key in ("subtract_baseline",) if key in change}
        if "moment" in change:
            options["moment"] = np.cross([0.02, 0.03, 0.0], force)
        if "place" in change:
            options["centre_of_pressure"] = np.tile([0.2, 0.1, 0.0], (len(force), 1))
        made[name] = finished_plate(name, force, rate=500.0, up=UP, corners=CORNERS, **options)
    one = made["offset"]
    trial = Trial("walk", plates=(one, refused_plate("bad", "no corners", kind="type 9")))
    path = one.force[:, :1] * [[0.0, 0.0, 0.0]] + np.linspace(0, 0.3, 1000)[:, None]
    walked = Plate("p", one.force, 500.0, centre_of_pressure=path)
    held(
        file_regression,
        {
            **{name: parts(plate) for name, plate in made.items()},
            "whole": one,
            "text": {name: plate.baseline_text for name, plate in made.items()},
            "usable": {plate.name: plate.usable for plate in trial.plates},
            "bad": trial.plates[1],
            "named": plate_named(trial, "offset").name,
            "contacts": [(c.start, c.stop, c.peak) for c in plate_contacts(one, UP)],
            "above": [(c.start, c.stop, c.peak) for c in plate_contacts(one, UP, 120.0)],
            "of a contact": [
                (x.pressure_path, x.shear_swing)
                for x in (
                    Contact(walked, 260, 590, UP),
                    Contact(walked, 260, 274, UP),
                    Contact(walked, 260, 275, UP),
                    Contact(one, 260, 265, UP),
                    Contact(one, 260, 266, UP),
                )
            ],
            "refused": [
                refusal(plate_named, trial, "one"),
                refusal(plate_named, Trial("empty"), "one"),
            ],
        },
    )


def test_signals(file_regression):
    rate = 500.0
    load = step_force(level=[0.0, 0.0, 6.0])[:, 2]
    noisy = load + 3.0 * np.sin(50.0 * np.arange(len(load)))
    lost = noisy.copy()
    lost[10:14] = np.nan
    gaps = {
        "short": 9,
        "at the limit": 10,
        "longer": 11,
    }
    two = np.zeros(1000)
    two[100:114] = two[200:216] = 150.0
    for name, size in gaps.items():
        start = 400 + 150 * list(gaps).index(name)
        two[start : start + 40] = 150.0
        two[start + 40 : start + 40 + size] = 0.0
        two[start + 40 + size : start + 90] = 101.0
    low = two.copy()
    low[two == 150.0] = 99.0
    path = np.column_stack((np.sin(0.1 * np.arange(60.0)), np.arange(60.0), np.zeros(60)))
    holes = path.copy()
    holes[[3, 4, 5, 20, 21, 22, 23, 59]] = np.nan
    flat = np.minimum(load, 500.0)
    coarse = np.round(load / 50.0) * 50.0
    masks = {
        "plain": unloaded_samples(load, rate),
        "noisy": unloaded_samples(noisy, rate),
        "lost": unloaded_samples(lost, rate),
        "few": unloaded_samples(load[:49], rate),
        "enough": unloaded_samples(load[:50], rate),
        "high": unloaded_samples(load + 101.0, rate),
        "below high": unloaded_samples(load + 93.0, rate),
        "flat": unloaded_samples(0 * load, rate),
        "flat, high": unloaded_samples(0 * load + 101.0, rate),
        "swing": unloaded_samples(np.linspace(0, 29, 300), rate),
        "wide": unloaded_samples(np.linspace(0, 31, 300), rate),
        "never": unloaded_samples(load[300:500], rate),
    }
    held(
        file_regression,
        {
            "along": [along(path, UP + 0.5), along(path.astype(np.float32), UP + 0.5)],
            "unloaded": {
                name: (int(mask.sum()), runs(mask), enough(mask)) for name, mask in masks.items()
            },
            "frames": [
                str(frames_between(np.arange(10.0), *x, beside=k))
                for x, k in (((2.0, 5.0), 0), ((-3.0, 4.5), 2), ((8.5, 99.0), 1))
            ],
            "saturated": [
                is_saturated(x, rate)
                for x in (
                    load,
                    flat,
                    -flat,
                    flat[:15],
                    0 * load,
                    np.where(np.arange(1000) < 15, 9.0, noisy),
                    coarse,
                    np.minimum(load, 699.0),
                    np.append(flat, np.nan),
                )
            ],
            "saturated, slow": [is_saturated(np.minimum(load, x), 50.0) for x in (300.0, 690.0)],
            "cut flat for so many samples": {
                str(hertz): [
                    n for n in range(1, 60) if is_saturated(np.minimum(ramp, 60.0 - n), hertz)
                ]
                for ramp in [np.arange(61.0)]
                for hertz in (100.0, 1000.0, 2000.0)
            },
            "longest": [
                longest_run(np.array([0, 1, 1, 0, 1], bool)),
                longest_run(np.zeros(3, bool)),
            ],
            "runs": [runs(np.array(x, bool)) for x in ([1, 0, 1, 1], [0, 1, 0], [])],
            "contacts": [
                contacts(two, rate),
                contacts(low, rate),
                contacts(two, rate, 90.0),
                contacts(two, 1000.0),
                contacts(np.append(np.full(40, 150.0), two), rate),
            ],
            "bridged": [bridge_gaps(holes, longest) for longest in (3, 4, 2)],
            "not bridged": bridge_gaps(holes[3:7], 9)[1],
            "whole": bridge_gaps(path, 9)[1],
        },
    )


def test_filters(file_regression):
    rate, time = 200.0, np.arange(120) / 200.0
    values = np.column_stack((np.sin(20 * time), np.cos(90 * time), time > 0.3)).astype(float)
    lost = values.copy()
    lost[[10, 100]] = np.nan
    every = {kind: LowPass(kind) for kind in FILTERS}
    held(
        file_regression,
        {
            "said": {
                kind: [one.description, str(LowPass(kind, 12.5))] for kind, one in every.items()
            },
            "filtered": {kind: low_passed(values, rate, one) for kind, one in every.items()},
            "low": {kind: low_passed(values, rate, LowPass(kind, 6.0)) for kind in FILTERS},
            "one signal": {
                kind: low_passed(values[:, 0], rate, one) for kind, one in every.items()
            },
            "near the top": low_passed(
                values, rate, LowPass("butterworth-4-zero-phase-corrected", 89.9)
            ),
            "thirty": low_passed(values[:30], rate, LowPass()),
            "default": LowPass(),
            "few, one pass": low_passed(values[:9], rate, every["butterworth-4-one-pass"]),
            "part": [
                low_passed_part(values, rate, LowPass(), 40, 70),
                low_passed_part(lost, rate, LowPass(), 40, 70),
                low_passed_part(lost, rate, LowPass(cutoff=5.0), 11, 99),
            ],
            "velocity": velocity(values, rate, LowPass(cutoff=10.0)),
            "refused": [
                refusal(LowPass, "butter"),
                refusal(LowPass, cutoff=0.0),
                refusal(LowPass, cutoff=np.inf),
                refusal(low_passed, lost, rate, LowPass()),
                refusal(low_passed, values[:29], rate, LowPass()),
                refusal(low_passed, values, rate, LowPass(cutoff=90.1)),
                refusal(low_passed_part, lost, rate, LowPass(), 5, 20),
            ],
        },
    )


def test_trials(file_regression):
    force = step_force()
    plate = finished_plate("one", -force, rate=500.0, up=UP, moment=force, corners=CORNERS)
    down = Plate("two", force, 500.0, moment=force, baseline=np.ones(3))
    channel = Channel(np.arange(4.0), "Pa", 2.0, 1.0)
    uneven = Marker(np.zeros((3, 3)), 10.0, times=np.array([0.0, 0.1, 0.3]))
    edits = [
        Edit(1, "exclude", None, "slipped"),
        Edit(1.25, "contact", 1.3, "late"),
        Edit(2, "side", "left", "seen"),
        Edit(3, "plate", "one", "video"),
    ]
    first = Trial(
        "a",
        {"p": channel},
        (plate,),
        {"M": marker()},
        "C3D",
        "12",
        ("note",),
        (Event("heel contact", 1.0, "left"),),
        settings={"x": "1"},
        vertical=Vertical((0.0, 0.0, 1.0), "plates"),
    )
    second = Trial(
        "b",
        {"p": channel, "q": channel},
        (),
        {"M": uneven},
        "TRC",
        "34",
        ("more",),
        edits=tuple(edits[:1]),
        settings={"x": "2", "y": "3"},
    )
    turned = Trial("c", plates=(down,), vertical=Vertical((0.0, 0.0, -1.0), "load"))
    aside = Trial("d", plates=(down,), vertical=Vertical((0.0, 1.0, 0.0), "load"))
    marked = Trial("e", markers={"M": marker()}, vertical=Vertical((0.0, 0.0, 1.0), "markers"))
    joined = {
        "both": join_trials(first, second),
        "turned": join_trials(marked, turned),
        "turned, other order": join_trials(turned, marked),
        "aside": join_trials(marked, aside),
        "plates of both": join_trials(first, turned),
        "no vertical": join_trials(second, second),
        "alike": join_trials(marked, first),
    }
    many = Trial("many", {f"c{i:02d}": channel for i in range(14)})
    held(
        file_regression,
        {
            **{
                name: {"plates": [parts(p) for p in one.plates], "trial": replace(one, plates=())}
                for name, one in joined.items()
            },
            "repr": [repr(x) for x in (first, second, first.with_edits(*edits), many)],
            "table": [
                first.table(),
                second.table(),
                Trial(
                    "u", {"c": Channel(np.ones(2), "", 1.0)}, (refused_plate("bad", "why"),)
                ).table(),
            ],
            "time": [channel.time, uneven.time, first.markers["M"].time[:3], plate.time[:3]],
            "missing": [marker(lost=(2,)).missing.sum(), uneven.missing],
            "named": [first.channel("Q", "P").unit, first.marker("m").rate],
            "noted": first.with_notes("x", "y").notes,
            "edits": [one.step_words for one in edits],
            "accuracy": PlateAccuracy(),
            "refused": [
                refusal(first.channel, "r"),
                refusal(many.channel, "c1", "d1"),
                refusal(Trial("e").marker, "M"),
                refusal(PlateAccuracy, 1.0),
                refusal(PlateAccuracy, 0.1, -0.1),
                *(
                    refusal(Edit, *x)
                    for x in (
                        (1, "moved", None, "why"),
                        (1, "exclude", None, " "),
                        (1, "contact", None, "why"),
                        (1, "side", "up", "why"),
                        (1, "plate", "", "why"),
                        (1, "exclude", "2", "why"),
                        (1, "toe off", "2 s", "why"),
                    )
                ),
            ],
        },
    )


def test_protocols(file_regression, tmp_path):
    def told(one):
        return {
            "one": one,
            "standing": one.standing(),
            "rules": [r.statement() for r in one.rules],
            "broken": {
                r.quantity: [
                    r.broken_by(v)
                    for v in (
                        (r.low or r.high) * s
                        for s in (0.5, 1 - 2e-6, 1 - 5e-7, 1 + 5e-7, 1 + 2e-6, 2.0)
                    )
                ]
                for r in one.rules
            },
        }

    bad = {
        "kind": 'kind = "gate"',
        "quantity": 'kind = "gait"\n[rules.weight]\nlow = "1 N"',
        "key": 'kind = "gait"\n[rules.duration]\nleast = "1 s"',
        "limit": 'kind = "gait"\n[rules.duration]\nseverity = "refuse"',
        "severity": 'kind = "gait"\n[rules.duration]\nlow = "1 s"\nseverity = "hard"',
    }
    own = 'kind = "gait"\n[method]\nrcof_gate = "80 N"\ntests = ["fisher", "line"]\n'
    own += 'compare = "shoe"\n'
    own += '[rules.duration]\nlow = "2 s"\nhigh = "4 s"\n[rules.force_rate]\nhigh = "2 kHz"\n'
    for name, text in {**{f"bad_{key}": text for key, text in bad.items()}, "mine": own}.items():
        entry = f'[protocol.{name}]\ntitle = "{name}"\nsource = "a bench"\n'
        body = text.replace("[rules", f"[protocol.{name}.rules").replace(
            "[method", f"[protocol.{name}.method"
        )
        (tmp_path / f"{name}.toml").write_text(entry + body, encoding="utf-8")
    names = protocol_names()
    refused = {}
    for name in bad:
        folder = tmp_path / name
        folder.mkdir()
        (tmp_path / f"bad_{name}.toml").rename(folder / "one.toml")
        refused[name] = refusal(protocol, f"bad_{name}", [folder])
    mine = protocol("mine", [tmp_path])
    held(
        file_regression,
        {
            "names": names,
            "kinds": KINDS,
            "mine": told(mine),
            "en_iso_13287": told(protocol("en_iso_13287")),
            "standing": {
                name: protocol(name).standing() for name in ("report_g6", "en_16165_pendulum")
            },
            "number": [mine.number("rcof_gate", "N"), mine.number("force_cutoff", "Hz", 3.0)],
            "text": [
                mine.text("rcof_gate"),
                mine.text("none"),
                mine.text("none", "x"),
                mine.texts("tests"),
                mine.texts("compare"),
                mine.texts("none"),
            ],
            "changed": mine.with_settings({"rcof_gate": "90 N", "slip_plate": "two"}).method,
            "another key": mine.key != mine.with_settings({"rcof_gate": "90 N"}).key,
            "same key": mine.key == mine.with_settings({"rcof_gate": "80 N"}).key,
            "refused": {
                **refused,
                "name": refusal(protocol, "level_waking"),
                "number": refusal(mine.number, "gate", "N"),
            },
        },
    )


CALIBRATION = """
[tester]
name = "Tester 3"
certificate = "4711"
date = 2026-01-10
valid_until = 2026-12-31
tolerance = "3 %"
[channels.normal]
reference = ["10 kg", "50 kg"]
reading = ["99 N", "490 N"]
uncertainty = "0.2 %"
range = "2 kN"
noise = "0.5 N"
[channels.friction]
reference = ["10 N", "100 N", "200 N"]
reading = ["11 N", "109 N", "221 N"]
uncertainty = "0.3 %"
[[checks]]
date = "2026-03-05"
channel = "normal"
reference = "20 kg"
reading = "195 N"
[[checks]]
date = "05.03.2026"
channel = "crosstalk"
reference = "200 N"
reading = "1 N"
[[checks]]
date = "6.3.26"
channel = "friction"
reference = "100 N"
reading = "140 N"
"""
BROKEN = {
    "key": ('certificate = "4711"', 'certify = "4711"'),
    "channel": ("channels.friction", "channels.shear"),
    "date": ("date = 2026-01-10", 'date = "in May"'),
    "lengths": ('"99 N", ', ""),
    "one point": ('["10 N", "100 N", "200 N"]', '["10 N", "10 N", "10 N"]'),
    "no uncertainty": ('uncertainty = "0.3 %"', ""),
    "falling": ('["99 N", "490 N"]', '["490 N", "99 N"]'),
    "off the line": ('"109 N"', '"139 N"'),
    "no table": ("[tester]\n", "tester = 3\n[other]\n"),
    "check": ('channel = "crosstalk"', 'channel = "cross"'),
    "nothing": ('reference = "200 N"\nreading', 'reference = "0 N"\nreading'),
    "day of a check": ('date = "6.3.26"', 'date = "6.13.26"'),
    "list": ('["99 N", "490 N"]', '"99 N"'),
}


def test_tester_calibrations(file_regression, tmp_path):
    path = tmp_path / "calibration.toml"
    path.write_text(CALIBRATION, encoding="utf-8")
    record = read_calibration(path)

    def shown(one, day):
        return [
            (flag.name, str(flag).replace("-", "/"), flag.measured, flag.limit, flag.unit)
            for flag in one.flags(day)
        ]

    days = [
        None,
        "",
        "2026-01-09",
        "2026-01-10",
        "2026-12-31",
        "2027-01-01",
        "2026-03-05",
        "2026-03-06",
        "2026-03-07",
        datetime.date(2026, 3, 5),
    ]
    refused = {}
    for name, (old, new) in BROKEN.items():
        assert CALIBRATION.count(old) >= 1
        path.write_text(CALIBRATION.replace(old, new), encoding="utf-8")
        refused[name] = refusal(read_calibration, path)
    path.write_text('[tester]\ndate = "2026-01-10"\n', encoding="utf-8")
    least = read_calibration(path)
    texts = [
        "2026-3-5",
        "2026/03/05",
        "2026.03.05",
        "2026-03/05",
        "5.3.2026",
        "5. 3. 26",
        "05.03.99",
        "2026-02-30",
        "2026-03-05 10:15",
        "2026-03-05T10:15:30.5",
        "soon",
        "3/5/2026",
    ]
    held(
        file_regression,
        {
            "record": record,
            "said": record.description(),
            "least": least,
            "least said": least.description(),
            "flags": {str(day): shown(record, day) for day in days},
            "least flags": [shown(least, "2026-01-09"), shown(least, "2036-01-10")],
            "dates": [f"{day:%d %m %Y}" for day in (record.date, record.valid_until, least.date)],
            "missing": record.channel("pressure"),
            "refused": refused,
            "days": [written_day(text) and f"{written_day(text):%d %m %Y}" for text in texts],
            "day": [
                f"{day_of(x, where='w'):%d %m %Y}"
                for x in (datetime.datetime(2026, 3, 5, 1), datetime.date(2026, 3, 6), "7.3.2026")
            ],
            "no day": refusal(day_of, "x", where="here"),
        },
    )


def test_mirrored_walk_goes_the_mirrored_way():
    for speed in ((1.2, 0.1, 0.0), (-0.7, 0.9, 0.0)):
        found = [
            axes_of(
                Trial(
                    "",
                    markers={
                        f"M{i}": marker(np.multiply(speed, flip), (0, 0, 0.3 * i)) for i in range(4)
                    },
                )
            ).walking
            for flip in ([1, 1, 1], [-1, 1, 1])
        ]
        assert found[0] * [-1, 1, 1] == pytest.approx(found[1])
        assert found[0] == pytest.approx(np.array(speed) / np.linalg.norm(speed), abs=1e-5)
