"""What is read of a slip tester, a pin, a pressure map, a block of rubber and curves of speed."""

import datetime
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.trials.machines.compression import compression, compression_moduli
from underfoot.trials.machines.pin_on_disk import (
    correlated_error,
    friction_point,
    reduced_radius,
    steady_window,
)
from underfoot.trials.machines.pressure_map import pressure_map, pressure_scan
from underfoot.trials.machines.pressures import (
    PulseDefinition,
    _between,
    heel_track,
    passages,
    pressure_pulse,
    sensor_array_reading,
    sensor_rows,
)
from underfoot.trials.machines.relaxation_test import relaxation_reading
from underfoot.trials.machines.slip_friction import (
    apply_calibration,
    available_friction,
    available_frictions,
    mean_friction,
    slide_friction,
    slide_plate,
    speed_channel,
)
from underfoot.trials.machines.stribeck_fit import (
    best_decay,
    linear_part,
    master_curve,
    stribeck_fit,
)
from underfoot.trials.machines.tester_checks import log_kind, scan_flags, slide_flags
from underfoot.trials.recording import protocols, tester_calibration
from underfoot.trials.recording.axes import axes_of
from underfoot.trials.recording.plates import finished_plate, refused_plate
from underfoot.trials.recording.signals import LowPass
from underfoot.trials.recording.trial import Channel, Marker, Plate, Trial
from underfoot.trials.simulator.folder import SENSOR, ScanTruth, disk_run, relaxation, scan_columns
from underfoot.trials.simulator.walk import Defects, SlipTruth, walk_with_slip
from underfoot.trials.walking.slips import heel_motion, slip
from walk_forms import walk

UP = np.array([0.0, 0.0, 1.0])
protocol = cache(protocols.protocol)
RATE = 1000.0


def numbers(values):
    """Numbers of which some may be missing, without the noise of a zero."""
    return np.round(np.array([np.nan if v is None else v for v in values], dtype=float), 12) + 0.0


def said(flags):
    return [
        f"{'!' if f.matters else '-'} {f.name}: {f} "
        + " ".join(f"{v:.5g}" for v in (f.measured, f.limit) if v is not None)
        for f in flags
    ]


def short(m):
    """A measurement in few lines."""
    return {
        "is": f"{m.name} {m.unit} n {m.n} {m.reason}",
        "numbers": numbers([m.value, m.uncertainty]),
        "flags": said(m.flags),
        "conventions": m.conventions,
    }


def slid(change=lambda c: c, *, seed=3, speed=True, noise=1.0, **truth):
    """A made-up slide as a trial: force, marker, speed and pressure."""
    columns = scan_columns(ScanTruth(**truth), 0.004, np.random.default_rng(seed), noise=noise)
    columns["speed"] = (
        np.gradient(0.001 * columns["heel_x (mm)"], 1e-3)
        if noise == 0.0
        else np.where((columns["time (s)"] > 0.45) & (columns["time (s)"] < 0.95), 0.7, 0.0)
    )
    columns = change(columns)
    force = np.column_stack([columns[f"F{axis} (N)"] for axis in "xyz"])
    path = 1e-3 * np.column_stack([columns[f"heel_{axis} (mm)"] for axis in "xyz"])
    plate = finished_plate("plate", force, rate=RATE, up=UP)
    channels = {"pressure": Channel(1e3 * columns["pressure (kPa)"], "Pa", RATE)}
    if speed:
        channels["sliding speed"] = Channel(columns["speed"], "m/s", RATE)
    return Trial("slide", channels, (plate,), {"heel": Marker(path, RATE)})


def _with(name, value, rows=slice(None)):
    def change(columns):
        own = columns[name].copy()
        own[rows] = value(own[rows]) if callable(value) else value
        return {**columns, name: own}

    return change


def _all(value, rows=slice(None)):
    def change(columns):
        for axis in "xyz":
            columns = _with(f"F{axis} (N)", value, rows)(columns)
        return columns

    return change


def _stepped(size):
    return lambda v: size * np.round(v / size)


SLIDES = {
    "sound": lambda c: c,
    "dead": _with("Fx (N)", lambda v: 0.02 * v),
    "low": _with("Fx (N)", lambda v: 0.2 * v),
    "high": _with("Fx (N)", lambda v: 16.0 * v),
    "one level": _with("Fx (N)", -40.0),
    "clipped": _with("Fx (N)", lambda v: np.maximum(v, -38.0)),
    "drift": _with("Fx (N)", lambda v: v + np.linspace(0, 40, len(v))),
    "another zero": _with("Fx (N)", lambda v: v + 12.0, slice(1200, None)),
    "coarse": _all(_stepped(20.0)),
    "fine steps": _all(_stepped(0.5)),
    "coarse normal": _with("Fz (N)", _stepped(50.0)),
    "held": _all(lambda v: v[0], slice(560, 575)),
    "held long": _all(lambda v: v[0], slice(560, 640)),
    "straight": _with(
        "Fx (N)", lambda v: np.interp(np.arange(len(v)), np.arange(len(v))[::9], v[::9])
    ),
    "outliers": _with("Fx (N)", -900.0, slice(600, 612)),
    "trend": _with("Fx (N)", lambda v: v * np.linspace(0.2, 3.5, len(v))),
    "swing": _with("Fz (N)", lambda v: v * (1 + 0.25 * np.sin(0.06 * np.arange(len(v))))),
    "wrapped": _with("Fx (N)", lambda v: (v + 30.0) % 60.0 - 30.0),
    "zeroed": _all(lambda v: np.where(np.abs(v) < 12.0, 0.0, v)),
    "smooth": _with("Fx (N)", lambda v: np.where(np.abs(v - 2) > 20, -38.0, v)),
    "crosstalk": lambda c: {**c, "Fx (N)": c["Fx (N)"] - 0.03 * c["Fz (N)"]},
    "little crosstalk": lambda c: {**c, "Fx (N)": c["Fx (N)"] - 0.009 * c["Fz (N)"]},
    "no scatter": (lambda c: c, {"noise": 0.2}),
    "slow": (lambda c: c, {"rise": 0.2}),
    "two slides": _with("speed", 0.0, slice(600, 700)),
    "stops": _with("speed", 0.1, slice(620, 640)),
    "long": _with("speed", lambda v: 8.0 * v),
    "lost": _with("Fx (N)", np.nan, slice(600, 602)),
    "light": _all(lambda v: 0.05 * v),
    "sideways": lambda c: {**c, "Fx (N)": c["Fy (N)"], "Fy (N)": c["Fx (N)"]},
    "falling": _with("Fz (N)", lambda v: 0.15 * v, slice(560, 700)),
    "a little less": _with("Fz (N)", lambda v: 0.8 * v, slice(560, 600)),
    "reversed": _with("Fx (N)", lambda v: -v, slice(700, None)),
}
RECORD = tester_calibration.TesterCalibration(
    "tester",
    "certificate 1",
    datetime.date(2026, 1, 5),
    None,
    0.02,
    {
        "normal": tester_calibration.ChannelCalibration(1.02, 0.004, 400.0, 520.0, 3.0),
        "friction": tester_calibration.ChannelCalibration(0.98, 0.006, 30.0, 39.0, 0.1),
        "pressure": tester_calibration.ChannelCalibration(1.1, 0.01, 2e5, None, 40.0),
    },
)


def read(trial, way="report_g4", record=None, **settings):
    """The slide of a trial with its flags, or why it has none."""
    chosen = protocol(way).with_settings(settings)
    try:
        one = slide_friction(trial, chosen, axes_of(trial, vertical="+z"), record)
    except Exception as error:  # which one is held
        return f"{type(error).__name__}: {error}"
    plate = slide_plate(trial, UP, record)
    cof = one.cof
    return {
        "is": f"{cof.name} n {cof.n} {cof.reason}",
        "numbers": numbers(
            [cof.value, cof.uncertainty, *one.window, one.onset, *one.facts.values()]
        ),
        "flags": said((*cof.flags, *slide_flags(one, plate, UP, record))),
    }


@pytest.mark.parametrize("part", range(2))
def test_slides(file_regression, part):
    names = list(SLIDES)[part::2]
    made = {
        name: SLIDES[name] if isinstance(SLIDES[name], tuple) else (SLIDES[name], {})
        for name in names
    }
    held(
        file_regression,
        {name: read(slid(change, **options)) for name, (change, options) in made.items()},
        f"slides_{part}",
    )


def test_ways_to_read_a_slide(file_regression):
    whole = slid(rise=0.3)
    bare = slid(speed=False, rise=0.3)
    still = replace(bare, markers={})
    gaps = {"heel": replace(bare.markers["heel"], times=bare.markers["heel"].time)}
    knots = replace(
        whole, channels={"speed": Channel(whole.channels["sliding speed"].values, "", RATE)}
    )
    one = slide_friction(whole, protocol("report_g4"))
    plate = whole.plates[0]
    held(
        file_regression,
        {
            "ways": {
                name: read(whole, name)
                for name in ("report_g4", "report_g6_tester", "en_iso_13287")
            },
            "force": read(whole, "report_g6_tester", target_force="400 N", window_end="90 ms"),
            "too much": read(whole, "report_g6_tester", target_force="900 N"),
            "late window": read(whole, window_begin="1 s", window_end="1.2 s"),
            "at the end": read(whole, window_begin="0.6 s", window_end="0.8 s"),
            "calibrated": read(whole, record=RECORD),
            "slow marker": read(bare),
            "no marker": read(still),
            "gaps": read(replace(bare, markers=gaps)),
            "unit of speed": read(knots),
            "no plate": read(Trial("empty")),
            "refused plate": read(Trial("bad", plates=(refused_plate("p", "no corners"),))),
            "unloaded": read(slid(normal_force=40.0)),
            "another window": read(whole, window_from="time"),
            "without friction": read(
                replace(
                    still,
                    plates=(replace(still.plates[0], force=still.plates[0].force * [0, 0, 1.0]),),
                )
            ),
            "conventions": one.cof.conventions,
            "curves": [one.time, one.normal, one.shear, one.ratio],
            "by force": slide_friction(whole, protocol("report_g6_tester")).cof.conventions,
            "calibration": [
                apply_calibration(one.cof, None).conventions["calibration"],
                apply_calibration(replace(one.cof, uncertainty=None), RECORD).uncertainty,
            ],
            "plate": slide_plate(whole, UP, RECORD).force,
            "speed": [speed_channel(whole).unit, speed_channel(bare)],
            "kinds": [
                log_kind(p, UP)
                for p in (
                    plate,
                    walk().plates[0],
                    replace(plate, force=plate.force * 0.05),
                    replace(plate, force=plate.force[:0]),
                    replace(plate, force=plate.force * [0, 0, 1]),
                )
            ],
            "ends of windows": [short(m) for m in available_frictions(plate, target=100.0)],
            "filtered": short(
                available_friction(plate, target=100.0, up=UP, low_pass=LowPass(cutoff=20.0))
            ),
            "no plate's": [
                available_friction(x, target=9.0).reason
                for x in (refused_plate("p", "why"), Plate("p", np.empty((0, 3)), 9.0))
            ],
            "not filtered": available_friction(
                replace(plate, force=np.where(plate.force > 480, np.nan, plate.force)),
                target=9.0,
                up=UP,
                low_pass=LowPass(),
            ).reason,
        },
    )


def test_mean_friction(file_regression):
    time = np.arange(400) / 1000.0
    load = np.clip(5000.0 * time, 0, 500.0)
    push = 0.1 * load * (1 + 0.05 * np.sin(300 * time))
    dip, low = load.copy(), load.copy()
    dip[150:160], low[150:160] = 440.0, 90.0
    hole = push.copy()
    hole[120] = np.nan
    held(
        file_regression,
        {
            "plain": short(mean_friction(load, push, 1000.0, target=500.0)),
            "dip": short(mean_friction(dip, push, 1000.0, target=500.0)),
            "no dip": short(mean_friction(np.maximum(dip, 451.0), push, 1000.0, target=500.0)),
            "low": short(mean_friction(low, push, 1000.0, target=500.0)),
            "short": short(mean_friction(load, push, 1000.0, target=500.0, window=0.003)),
            "one": short(mean_friction(load, push, 1000.0, target=500.0, window=1e-9)),
            "even": short(mean_friction(load, 0.1 * load, 1000.0, target=500.0, name="cof")),
            "never": short(mean_friction(load, push, 1000.0, target=501.0)),
            "ends": short(mean_friction(load, push, 1000.0, target=500.0, window=0.31)),
            "hole": short(mean_friction(load, hole, 1000.0, target=500.0)),
            "nothing": short(mean_friction([], [], 1000.0, target=5.0)),
            "refused": [
                refusal(mean_friction, load, push[1:], 9.0, target=1.0),
                refusal(mean_friction, load, push, 9.0, target=0.0),
                refusal(mean_friction, load, push, 9.0, target=1.0, window=0.0),
            ],
        },
    )


def scanned(lateral, change=lambda t: t, **options):
    truth = ScanTruth(rise=0.05)
    columns = scan_columns(truth, lateral, np.random.default_rng([5, round(1e4 * (lateral + 1))]))
    path = 1e-3 * np.column_stack([columns[f"heel_{axis} (mm)"] for axis in "xyz"])
    sensor = Channel(1e3 * columns["pressure (kPa)"], "Pa", RATE)
    sensor, marker = change((sensor, Marker(path, RATE)))
    trial = Trial(f"scan {1e3 * lateral:g}", {"p": sensor}, (), {"heel": marker})
    axes = axes_of(trial, vertical="+z")
    return pressure_scan(trial, sensor, marker, position=SENSOR, axes=axes, **options)


def _sensor(change):
    return lambda pair: (replace(pair[0], values=change(pair[0].values.copy())), pair[1])


def _marker(change):
    return lambda pair: (pair[0], replace(pair[1], positions=change(pair[1].positions.copy())))


def _lost(values, rows):
    values[rows] = np.nan
    return values


def test_pressure_scans(file_regression):
    def told(scan):
        return {
            **{n: getattr(scan, n) for n in ("along", "pressure", "flags", "trial")},
            "numbers": numbers(
                [scan.lateral, scan.speed, scan.speed_change, scan.baseline_sd, scan.sample_load]
            ),
            "checks": said(scan_flags(scan)),
            "on record": said(scan_flags(scan, RECORD)),
        }

    changes = {
        "bridged": _marker(lambda v: _lost(v, slice(500, 520))),
        "saturated": _sensor(lambda v: np.minimum(v, 1.2e5)),
        "falling": _sensor(lambda v: -v),
        "small": _sensor(lambda v: 0.002 * v + 0.2 * np.sin(np.arange(len(v)))),
        "quiet": _sensor(lambda v: np.where(np.arange(len(v)) < 480, 800.0, v)),
        "lost samples": _sensor(lambda v: _lost(v, slice(0, 420))),
        "no baseline": _sensor(lambda v: _lost(v, slice(0, 520))),
    }
    wrong = {
        "unit": lambda pair: (replace(pair[0], unit="V"), pair[1]),
        "lost": _marker(lambda v: _lost(v, slice(500, 700))),
        "few": _marker(lambda v: _lost(v, slice(29, None))),
        "still": _marker(lambda v: v * 0.0 + 0.01),
        "beside": _marker(lambda v: v + np.array([5.0, 0, 0])),
    }
    held(
        file_regression,
        {
            "plain": told(scanned(0.004)),
            **{name: told(scanned(0.004, x)) for name, x in changes.items()},
            "placed": told(scanned(0.0, heel_back=0.01, heel_middle=0.005, back=-0.02, front=0.1)),
            "along y": told(scanned(0.0, sliding=np.array([0.96, 0.28, 0.0]))),
            "wrong": {name: refusal(scanned, 0.004, x) for name, x in wrong.items()},
        },
    )


def test_pressure_maps(file_regression):
    places = np.array([-0.02, -0.01, 0.0, 0.01, 0.02])
    scans = [scanned(place) for place in places]

    def told(one):
        return {
            "grid": [one.lateral, one.along, one.pressure, one.line_loads],
            "numbers": numbers([one.outer_share, one.half_spacing_change]),
            **{n: short(getattr(one, n)) for n in ("load", "peak")},
            "places": [
                numbers([m.value, m.uncertainty]) for m in (one.peak_along, one.peak_lateral)
            ],
        }

    odd = [replace(scans[0], lateral=x) for x in (0.0, 0.0)]
    held(
        file_regression,
        {
            "whole": told(pressure_map(scans)),
            "given": told(pressure_map(scans[::-1], spacing=0.01, inlet_diameter=0.01, step=0.002)),
            "other spacing": told(pressure_map(scans, spacing=0.012)),
            "gap": told(pressure_map([*scans[:2], *scans[3:]])),
            "two": told(pressure_map(scans[1:3])),
            "narrow inlet": told(pressure_map(scans[1:3], inlet_diameter=0.001)),
            "noise": told(
                pressure_map(
                    [replace(s, pressure=s.pressure * 1e-3, sample_load=1e-6) for s in scans]
                )
            ),
            "flagged": told(
                pressure_map([scans[0], scanned(0.01, _sensor(lambda v: np.minimum(v, 1e5)))])
            ),
            "refused": [
                refusal(pressure_map, scans[:1]),
                refusal(pressure_map, odd),
                refusal(pressure_map, scans, spacing=-1.0),
                refusal(pressure_map, scans, step=0.0),
            ],
        },
    )


def test_pulses_and_passages(file_regression):
    made = walk_with_slip(
        SlipTruth(), Defects(dropped_samples=4), np.random.default_rng(8), duration=3.6
    )
    up, walking = UP, np.array([1.0, 0.0, 0.0])
    heel = Marker(made.markers["LHEE"], 200.0)
    motion = heel_motion(heel, up)
    channels = {n: Channel(v, "Pa", 1000.0) for n, v in made.pressures.items()}
    trial = Trial("slip", channels, (), {"LHEE": heel})
    one = slip(heel, 2.2, up=up, walking=walking)
    contact = 2.2

    def told(pulse):
        return {
            "peak": short(pulse.peak),
            "duration": short(pulse.duration),
            "numbers": numbers(
                [pulse.baseline, pulse.deviation, pulse.peak_time, pulse.first, pulse.last]
            ),
        }

    def passed(all_of):
        return {
            p.sensor: [p.row, p.time, p.speed.value, p.speed.reason, p.lateral.value]
            for p in all_of
        }

    p = channels["P22"]
    clean = replace(p, values=np.nan_to_num(p.values, nan=900.0))
    array = sensor_array_reading(trial, one, made.sensors, up=up, walking=walking)
    far = {n: (x + 0.4, y, z) for n, (x, y, z) in made.sensors.items()}
    near = {n: (x - 0.3, y, z) for n, (x, y, z) in made.sensors.items()}
    span = {"up": up, "walking": walking, "contact": contact, "until": 2.6}
    lost = replace(motion, position=motion.position * np.nan)
    held(
        file_regression,
        {
            "pulse": told(pressure_pulse("P22", clean, contact)),
            "holes": told(pressure_pulse("P22", p, contact, until=2.5)),
            "strict": told(
                pressure_pulse("P22", clean, contact, definition=PulseDefinition(400.0, 0.5, 90))
            ),
            "long run": told(
                pressure_pulse("P22", clean, contact, definition=PulseDefinition(run=2000))
            ),
            "short baseline": told(pressure_pulse("P22", clean, 0.3)),
            "none": told(pressure_pulse("P22", clean, 0.069)),
            "least": told(pressure_pulse("P22", clean, 0.071)),
            "still high": told(pressure_pulse("P22", clean, contact, until=2.27)),
            "saturated": told(
                pressure_pulse("P22", replace(clean, values=np.minimum(clean.values, 5e4)), contact)
            ),
            "volts": told(pressure_pulse("P22", replace(p, unit="V"), contact)),
            "after the end": told(pressure_pulse("P22", clean, 9.0)),
            "conventions": PulseDefinition().conventions(),
            "rows": [sensor_rows(made.sensors, w) for w in (walking, np.array([0.0, 1.0, 0.0]))],
            "one row": sensor_rows({"a": (0.0, 0.0, 0.0)}, walking),
            "near rows": sensor_rows(
                {"a": (0.0, 0, 0), "b": (0.01, 0, 0), "c": (0.05, 0, 0)}, walking
            ),
            "passages": passed(passages(motion, made.sensors, **span)),
            "far": passed(passages(motion, far, **span)),
            "near": passed(passages(motion, near, **span)),
            "lost": passed(passages(lost, made.sensors, **span)),
            "noted": passages(
                motion, {"P": made.sensors["P22"]}, conventions={"x": one.peak_speed.reason}, **span
            ),
            "refused": refusal(passages, motion, made.sensors, **{**span, "until": contact}),
            "track": heel_track(motion, made.sensors, **span),
            "far track": heel_track(motion, far, **span)[1],
            "array": [
                array.peak_sensor,
                array.crossed,
                array.track,
                short(array.peak),
                list(array.pulses),
            ],
            "of the array": passed(array.passages.values()),
            "without a motion": sensor_array_reading(
                trial, replace(one, motion=None), made.sensors, up=up, walking=walking
            ).track.shape,
            "no sensor": refusal(sensor_array_reading, trial, one, {}, up=up, walking=walking),
        },
    )


def pin(change=lambda c: c, seed=2, **run):
    columns = disk_run(
        run.pop("cof", 0.3), run.pop("speed", 0.5), np.random.default_rng(seed), **run
    )
    columns = change(dict(columns))
    units = {"normal force (N)": "N", "friction force (N)": "N", "sliding speed (m/s)": "m/s"}
    channels = {
        n.partition(" (")[0]: Channel(v, units.get(n, ""), 100.0)
        for n, v in columns.items()
        if n != "time (s)"
    }
    return Trial("pin", channels)


def _pin(name, value, rows=slice(None)):
    return _with(f"{name} (N)", value, rows)


def _joined(*changes):
    def change(columns):
        for one in changes:
            columns = one(columns)
        return columns

    return change


def _back_and_forth(values):
    return values * np.where(np.arange(len(values)) // 100 % 2, 1.0, -1.0)


def _cof(columns):
    return {"COF": columns["friction force (N)"] / columns["normal force (N)"]}


PINS = {
    "plain": lambda c: c,
    "heavy": _pin("normal force", lambda v: 0.1 * v),
    "unloaded before": _joined(
        *(
            _pin(n, lambda v: 0.01 * v + 0.3, slice(0, 150))
            for n in ("normal force", "friction force")
        )
    ),
    "unloaded twice": _joined(
        *(
            _pin(n, lambda v: 0.01 * v + 0.2, rows)
            for n in ("normal force", "friction force")
            for rows in (slice(0, 120), slice(900, None))
        )
    ),
    "lifted": _pin("normal force", 0.1, slice(500, 520)),
    "back and forth": _pin("friction force", _back_and_forth),
    "back and forth, off": _pin("friction force", lambda v: _back_and_forth(v) + 9.0),
    "size of both ways": _pin(
        "friction force",
        lambda v: np.abs(
            _back_and_forth(v) * np.sin(0.5 * np.pi * np.clip((np.arange(len(v)) % 100) / 10, 0, 1))
        ),
    ),
    "cof alone": _cof,
    "cof, both ways": lambda c: {"mu": _back_and_forth(_cof(c)["COF"])},
    "cof, unloaded": lambda c: {"COF": np.where(np.arange(1000) < 200, 0.001, _cof(c)["COF"])},
    "another cof": lambda c: {**c, "COF": 100.0 * _cof(c)["COF"]},
    "drifting": _pin("friction force", lambda v: v * np.linspace(0.5, 2.0, len(v))),
    "lost samples": _pin("friction force", np.nan, slice(300, 340)),
    "no load": _pin("normal force", 0.0),
    "nothing": lambda c: {"x (N)": c["normal force (N)"]},
    "negative": _joined(_pin("normal force", lambda v: -v), _pin("friction force", lambda v: -v)),
}


def test_pins(file_regression):
    def told(trial, **options):
        try:
            one = friction_point(trial, **options)
        except Exception as error:  # which one is held
            return f"{type(error).__name__}: {error}"
        return {
            **short(one.cof),
            "of": numbers([one.speed, one.normal, one.shear, *one.window]),
            "ratio": one.ratio,
            "trial": one.trial,
        }

    whole = pin()
    other = replace(
        whole,
        channels={
            **whole.channels,
            "friction force": replace(whole.channels["friction force"], unit="kgf"),
        },
    )
    ragged = replace(
        whole,
        channels={
            **whole.channels,
            "friction force": Channel(whole.channels["friction force"].values[:-1], "N", 100.0),
        },
    )
    fast = replace(
        whole,
        channels={
            **whole.channels,
            "sliding speed": replace(whole.channels["sliding speed"], unit="rpm"),
        },
    )
    held(
        file_regression,
        {
            **{name: told(pin(change)) for name, change in PINS.items()},
            "window": told(whole, window=(2.0, 3.0), speed=0.9),
            "empty window": told(whole, window=(99.0, 100.0)),
            "short window": told(whole, window=(2.0, 2.3)),
            "another unit": told(other),
            "ragged": told(ragged),
            "another unit of speed": told(fast),
            "little load": told(pin(load=0.5)),
            "no cof": told(Trial("x", {"COF": Channel(np.full(60, np.nan), "", 9.0)})),
        },
    )


def test_steady_windows(file_regression):
    rng = np.random.default_rng(4)
    flat = 0.3 + 0.01 * rng.standard_normal(200)
    fall = flat + 0.3 * np.exp(-np.arange(200) / 15.0)
    x = np.linspace(-0.01, 0.02, 30)
    held(
        file_regression,
        {
            "steady": [
                steady_window(v)
                for v in (
                    flat,
                    fall,
                    flat + 0.001 * np.arange(200),
                    fall[:50],
                    np.full(60, 0.3),
                    flat[:103] + np.linspace(0, 1, 103),
                )
            ],
            "errors": [correlated_error(v) for v in (flat, fall, flat[:39], flat[:40], flat[:205])],
            "radius": [
                reduced_radius(x, 3.0 * x**2 + 0.1 * x + 1e-6 * np.cos(9e3 * x)),
                reduced_radius(x, -5.0 * (x - 0.001) ** 2 + 1e-5 * np.sin(1e4 * x)),
            ],
            "refused": [refusal(steady_window, v) for v in (flat[:49], np.append(flat, np.nan))],
            "no radius": [
                refusal(reduced_radius, *v)
                for v in (
                    (x[:9], x[:9]),
                    (x, np.full(30, np.nan)),
                    (0 * x, x),
                    (x, 1e-3 * np.sin(1e4 * x)),
                )
            ],
        },
    )


def test_relaxation(file_regression):
    rng = np.random.default_rng(6)
    columns = {name: values[::20] for name, values in relaxation(rng).items()}
    force, travel = columns["force (N)"], 1e-3 * columns["displacement (mm)"]

    def block(force=force, travel=travel, unit="N", rate=2.5, names=("force", "displacement")):
        channels = {names[0]: Channel(force, unit, rate), names[1]: Channel(travel, "m", rate)}
        return Trial("block", channels)

    def told(trial, thickness=0.0055, **options):
        try:
            one = relaxation_reading(trial, thickness, **options)
        except Exception as error:  # which one is held
            return f"{type(error).__name__}: {error}"
        return {
            "force": [
                numbers([m.value, m.uncertainty, m.n])
                for m in (one.force_2_percent, one.peak_force, one.final_force)
            ],
            "flags": said(one.final_force.flags),
            "numbers": numbers(
                [one.hold_start, one.peak_displacement, one.ramp_time, one.hold_time, one.thickness]
            ),
            "notes": one.notes,
            "curves": [one.time, one.displacement, one.force, *one.hold],
        }

    fine = relaxation(rng, rate=0.1)
    fine = {name: values[:3000] for name, values in fine.items()}
    whole = block(fine["force (N)"], 1e-3 * fine["displacement (mm)"], rate=50.0)
    slow = {name: values[:3000] for name, values in relaxation(rng, rate=0.02).items()}
    hole = fine["force (N)"].copy()
    hole[200:205] = np.nan
    reading = relaxation_reading(whole, 0.0055)
    held(
        file_regression,
        {
            "coarse": told(block()),
            "whole": told(whole),
            "turned": told(
                block(-fine["force (N)"] + 20.0, -1e-3 * fine["displacement (mm)"], rate=50.0)
            ),
            "holes": told(block(hole, 1e-3 * fine["displacement (mm)"], rate=50.0)),
            "named": told(
                block(
                    fine["force (N)"], 1e-3 * fine["displacement (mm)"], rate=50.0, names=("a", "b")
                ),
                force="a",
                displacement="b",
            ),
            "thick": told(whole, 0.09),
            "no thickness": told(whole, 0.0),
            "volts": told(block(unit="V")),
            "short": told(block(force[:19], travel[:19])),
            "ragged": told(block(force[:-1], travel)),
            "flat": told(block(0 * force + np.sin(np.arange(len(force))), travel)),
            "no loading": told(
                block(
                    np.append(force[:20] * 0, fine["force (N)"][149:]),
                    np.append(travel[:20] * 0, 1e-3 * fine["displacement (mm)"][149:]),
                    rate=50.0,
                )
            ),
            "still falling": told(
                block(slow["force (N)"], 1e-3 * slow["displacement (mm)"], rate=50.0)
            ),
            "no hold": told(
                block(fine["force (N)"][:155], 1e-3 * fine["displacement (mm)"][:155], rate=50.0)
            ),
            "moduli": compression_moduli(5.0, 800.0, 500.0, 0.0055, 1.6e-4),
            "other travel": compression_moduli(0.0, 800.0, 800.0, 0.0055, 1.6e-4, travel=0.1),
            "compression": (x := compression(reading, 0.0055, 1.61e-4, "neolite")).moduli,
            "shape": (x.shape_factor, x.factor, x.deviation, x.name),
            "refused": [
                refusal(compression_moduli, *v)
                for v in (
                    (5.0, 800.0, 500.0, 0.0, 1.0),
                    (5.0, 800.0, 500.0, 1.0, -1.0),
                    (5.0, 400.0, 500.0, 1.0, 1.0),
                    (500.0, 800.0, 500.0, 1.0, 1.0),
                    (-1.0, 800.0, 500.0, 1.0, 1.0),
                )
            ],
            "no travel": refusal(compression_moduli, 5.0, 8.0, 6.0, 1.0, 1.0, travel=0.0),
        },
    )


SPEED = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9, 1.0])
FALL = 0.1 + 0.4 * np.exp(-SPEED / 0.2) + 0.01 * np.sin(40 * SPEED)


def test_stribeck_fits(file_regression):
    rng = np.random.default_rng(9)
    curves = {
        "fall": (SPEED, FALL),
        "rise": (SPEED, 0.6 - FALL),
        "straight": (SPEED, 0.5 - 0.3 * SPEED),
        "noise": (SPEED, 0.3 + 0.03 * rng.standard_normal(9)),
        "rough": (SPEED, FALL + 0.06 * np.cos(30 * SPEED)),
        "below zero": (SPEED, 0.5 * np.exp(-SPEED / 0.1) - 0.02 + 0.003 * np.sin(40 * SPEED)),
        "twice": (np.tile(SPEED, 2), np.append(FALL, FALL + 0.01)),
    }
    tau = np.array([0.01, 0.2, 3.0])
    held(
        file_regression,
        {
            "fits": {name: stribeck_fit(*xy) for name, xy in curves.items()},
            "simplex": {
                name: stribeck_fit(*curves[name], method="nelder_mead").raw
                for name in ("fall", "rough")
            },
            "given": stribeck_fit(SPEED, FALL, boundary=0.45),
            "narrow": stribeck_fit(SPEED, FALL, confidence=0.5).tau,
            "given, simplex": stribeck_fit(SPEED, FALL, boundary=0.45, method="nelder_mead").raw,
            "curve": [
                stribeck_fit(*curves[name]).curve(np.array([0.0, 0.3]))
                for name in ("fall", "noise")
            ],
            "linear": [
                linear_part(SPEED, y, tau, a, b)
                for y in (FALL, -FALL, FALL - 0.2)
                for a, b in ((None, None), (0.5, None), (None, 0.1), (0.5, 0.1))
            ],
            "best": [
                best_decay(SPEED, FALL, 0.01, 10.0),
                best_decay(SPEED, FALL, 0.01, 10.0, end=0.0),
                best_decay(SPEED, FALL, 0.01, 10.0, start=0.5, points=9),
            ],
            "refused": [
                refusal(stribeck_fit, *x, **k)
                for x, k in (
                    ((SPEED, FALL), {"method": "x"}),
                    ((SPEED[:3], FALL[:3]), {}),
                    ((SPEED, 0 * FALL), {}),
                    ((-SPEED, FALL), {}),
                    ((0 * SPEED, FALL), {}),
                    ((SPEED, FALL[1:]), {}),
                    ((SPEED, FALL * np.nan), {}),
                    ((SPEED[:2], FALL[:2]), {"boundary": 0.4}),
                )
            ],
            "three speeds, given": stribeck_fit(
                SPEED[[0, 2, 5, 8]], FALL[[0, 2, 5, 8]], boundary=0.4
            ).raw,
        },
    )


def test_master_curves(file_regression):
    viscosity = np.repeat([0.001, 0.1, 1.0], 3)
    speed = np.tile([0.1, 0.5, 1.0], 3)
    cof = np.array([0.5, 0.48, 0.49, 0.4, 0.3, 0.32, 0.2, 0.12, 0.1])
    one = master_curve(viscosity, speed, cof)
    held(
        file_regression,
        {
            "steps": one,
            "spline": master_curve(viscosity, speed, cof, method="spline"),
            "at": one(np.array([1e-5, 0.05, 0.3, 9.0])),
            "flat": master_curve(viscosity, speed, 0 * cof),
            "same products": master_curve([1, 1, 1, 1, 2, 2], [1, 1, 2, 2, 1, 1], cof[:6]),
            "refused": [
                refusal(master_curve, *x, **k)
                for x, k in (
                    ((viscosity, speed, cof), {"method": "x"}),
                    ((viscosity[:5], speed[:5], cof[:5]), {}),
                    ((viscosity, speed[1:], cof), {}),
                    ((-viscosity, speed, cof), {}),
                    ((viscosity, 0 * speed, cof), {}),
                    ((viscosity, speed, cof * np.nan), {}),
                    (([1, 1, 1, 1, 2, 2], [1, 1, 2, 2, 1, 1], cof[:6]), {"method": "spline"}),
                )
            ],
        },
    )


def test_turned_tester_reads_the_same_friction():
    """A tester knows no north: axes turned about the vertical leave the COF."""
    whole = slid()
    turn = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    plate = replace(whole.plates[0], force=whole.plates[0].force @ turn)
    values = [
        slide_friction(replace(whole, plates=(one,)), protocol("report_g4")).cof.value
        for one in (whole.plates[0], plate)
    ]
    assert values[0] == pytest.approx(values[1], rel=1e-9)
    assert values[0] == pytest.approx(0.08, abs=0.004)


def test_a_value_between_frames_is_on_the_line_up_to_the_last():
    values = np.array([0.0, 1.0, 5.0])
    assert [_between(values, *at) for at in ((0, 0.5), (1, 0.25), (2, 0.0))] == [0.5, 2.0, 5.0]
