"""Analysis of one file by the kind of its protocol."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from underfoot.core import DataError, UnderfootError

from ..axes import axes_of
from ..events import Stance, stances
from ..filters import LowPass
from ..gait import RcofDefinition, plate_named, required_friction
from ..measurement import Measurement, mean_of
from ..pin_on_disk import friction_point
from ..protocols import Protocol
from ..readers import Profile
from ..relaxation_test import relaxation_reading
from ..sensor_array import sensor_array_reading
from ..slide_friction import slide_friction
from ..slip_tester import pressure_scan
from ..slips import SlipDefinition, slip_of
from ..trial import Trial
from .file_result import Draft


def analysed_trial(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    """Analyse one trial into ``draft`` by the kind of the protocol.

    Errors
    ------
    UnderfootError
        What makes the whole file useless; single numbers that can't be had are kept as
        "not estimated".
    """
    draft.edits = [
        {"what": e.what, "before": e.before, "after": e.after, "why": e.why} for e in trial.edits
    ]
    _KINDS[protocol.kind](trial, draft, protocol, profile)


def _gait(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    axes = axes_of(trial, vertical=profile.vertical, walking=profile.walking)
    found = stances(trial, axes=axes, walking=profile.walking, heels=profile.heels)
    if not found:
        raise DataError("no contact with a force plate", where=trial.name)
    _rates(trial, draft)
    values = _required(trial, draft, protocol, found, axes)
    if not values:
        draft.refusals.append("no clean step: " + "; ".join(_why(found)))


def _human_slip(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    axes = axes_of(trial, vertical=profile.vertical, walking=profile.walking)
    found = stances(trial, axes=axes, walking=profile.walking, heels=profile.heels)
    _rates(trial, draft)
    wanted = str(draft.conditions.get("slip plate") or protocol.text("slip_plate"))
    slipping = [s for s in found if not wanted or s.plate == wanted]
    if not slipping:
        raise DataError(f"no contact with the slippery plate ({wanted})", where=trial.name)
    dry = [s for s in found if s not in slipping]
    _required(trial, draft, protocol, dry, axes)
    definition = SlipDefinition(
        threshold=protocol.number("slip_threshold", "m/s", 0.2),
        filter=LowPass(cutoff=protocol.number("marker_cutoff", "Hz", 10.0)),
    )
    stance = _by_hand(_with_side(slipping[0], draft.conditions), trial)
    one = slip_of(trial, stance, axes=axes, definition=definition, heels=profile.heels)
    item = f"slip on {stance.plate}"
    draft.add(item, one.start)
    draft.add(item, one.peak_speed, main="peak_slipping_speed")
    draft.add(item, one.distance, main="slip_distance")
    draft.add(item, one.margin, main="slip_margin")
    if one.slipped is None:
        draft.refusals.append(one.peak_speed.reason)
    else:
        draft.main["slip"] = float(one.slipped)
    if one.motion is not None:
        motion = one.motion
        near = (motion.time > one.contact - 0.15) & (motion.time < one.contact + 0.9)
        draft.curve(
            "heel",
            time=motion.time[near] - one.contact,
            speed=motion.speed[near],
            start=(one.start.value or np.nan) - one.contact,
            end=one.end - one.contact,
            peak_time=one.peak_time - one.contact,
            peak=one.peak_speed.value or np.nan,
            threshold=definition.threshold,
        )
    if profile.sensors and stance.walking is not None:
        _sensors(trial, draft, one, profile, axes.up, stance.walking)
    if "acof" in draft.conditions and "rcof" in draft.main:
        acof = draft.conditions["acof"]
        if isinstance(acof, float):
            draft.main["acof"] = acof
            draft.main["acof_minus_rcof"] = acof - draft.main["rcof"]


def _sensors(
    trial: Trial, draft: Draft, one: Any, profile: Profile, up: np.ndarray, walking: np.ndarray
) -> None:
    try:
        reading = sensor_array_reading(trial, one, profile.sensors, up=up, walking=walking)
    except UnderfootError as error:
        draft.cautions.append(f"pressures: {error.what}")
        return
    draft.add("sensor array", reading.peak, main="peak_pressure")
    draft.main["crossed_array"] = float(reading.crossed)
    across = np.cross(up, walking)
    places = {
        n: (float(np.dot(p, walking)), float(np.dot(p, across))) for n, p in profile.sensors.items()
    }
    middle = np.mean([[min(c), max(c)] for c in zip(*places.values(), strict=True)], axis=1)
    pulses = []
    for name, pulse in reading.pulses.items():
        draft.add(f"sensor {name}", pulse.peak)
        draft.add(f"sensor {name}", pulse.duration)
        channel = trial.channel(name)
        near = (channel.time > one.contact - 0.1) & (channel.time < one.contact + 0.6)
        step = max(1, int(near.sum()) // 150)
        kilopascal = 1e-3 * (channel.values[near] - pulse.baseline)
        pulses.append(
            {
                "sensor": name,
                "along": places[name][0] - float(middle[0]),
                "across": places[name][1] - float(middle[1]),
                "time": [round(float(t), 4) for t in (channel.time[near] - one.contact)[::step]],
                "kPa": [None if np.isnan(v) else round(float(v), 3) for v in kilopascal[::step]],
            }
        )
        passage = reading.passages.get(name)
        if passage is not None:
            draft.add(f"sensor {name}", passage.speed)
            draft.add(f"sensor {name}", passage.lateral)
            if passage.speed.value is not None and pulse.peak.value is not None:
                draft.curve(
                    "sensor_rows",
                    sensor=name,
                    row=passage.row,
                    pressure=float(pulse.peak.value),
                    irss=float(passage.speed.value),
                    ml=float(passage.lateral.value or 0.0),
                )
    if pulses:
        quiet = trial.channel(next(iter(reading.pulses)))
        draft.facts["baseline_samples"] = float(np.sum(quiet.time < one.contact - 0.05))
        track = reading.track if len(reading.track) else np.full((1, 2), np.nan)
        draft.curve("track", along=track[:, 0], across=track[:, 1], pulses=pulses)


def _slip_tester(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    found = slide_friction(trial, protocol, axes_of(trial, vertical=profile.vertical))
    _rates(trial, draft)
    draft.add("slide", found.cof, main="cof")
    draft.facts.update(found.facts)
    draft.curve(
        "slide",
        time=found.time,
        normal=found.normal,
        shear=found.shear,
        ratio=found.ratio,
        begin=found.window[0],
        end=found.window[1],
    )
    if not profile.sensors or not trial.markers:
        return
    name, position = next(iter(profile.sensors.items()))
    sensor = trial.channel(name)
    marker = next(iter(trial.markers.values()))
    try:
        scan = pressure_scan(trial, sensor, marker, position=position)
    except DataError as error:
        draft.cautions.append(f"no pressure scan: {error.what}")
        return
    draft.cautions += list(scan.flags)
    draft.add(
        "scan",
        Measurement("peak fluid pressure", float(scan.pressure.max()), "Pa", scan.baseline_sd),
        main="scan_peak_pressure",
    )
    draft.curves["scan"] = {
        "along": [float(f"{v:.7g}") for v in scan.along],
        "pressure": [float(f"{v:.7g}") for v in scan.pressure],
        "lateral": scan.lateral,
        "speed": scan.speed,
        "speed_change": scan.speed_change,
        "baseline_sd": scan.baseline_sd,
        "sample_load": scan.sample_load,
    }


def _pin_on_disk(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    speed = draft.conditions.get("speed")
    point = friction_point(trial, speed=speed if isinstance(speed, float) else None)
    draft.add(trial.name, point.cof, main="cof")
    draft.facts["duration"] = float(point.time[-1] - point.time[0])
    if point.normal is not None:
        draft.facts["normal_force"] = point.normal
    if point.shear is not None:
        draft.main["friction_force"] = point.shear
    if point.speed is not None:
        draft.facts["sliding_speed"] = draft.main["speed"] = point.speed
    draft.curve(
        "run",
        time=point.time,
        ratio=point.ratio,
        begin=point.window[0],
        end=point.window[1],
        cof=point.cof.value or np.nan,
    )


def _relaxation(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    thickness = draft.conditions.get("thickness")
    if not isinstance(thickness, float):
        raise DataError(
            "the thickness of the block is not known",
            where=trial.name,
            remedy='Add a column "thickness (mm)" to conditions.csv',
        )
    found = relaxation_reading(trial, thickness)
    draft.add("test", found.force_2_percent, main="force_2_percent")
    draft.add("test", found.peak_force, main="peak_force")
    draft.add("test", found.final_force, main="final_force")
    draft.facts["hold_time"] = found.hold_time
    draft.facts["compression"] = found.peak_displacement / (2.0 * thickness)
    time, force = found.hold
    log = np.unique(np.geomspace(1, len(time) - 1, 300).astype(int))
    draft.curve("hold", time=time[log], force=force[log], final=found.final_force.value or 0.0)


_KINDS: Mapping[str, Callable[[Trial, Draft, Protocol, Profile], None]] = {
    "gait": _gait,
    "human_slip": _human_slip,
    "slip_tester": _slip_tester,
    "pin_on_disk": _pin_on_disk,
    "boundary": _pin_on_disk,
    "relaxation": _relaxation,
}


def _required(
    trial: Trial, draft: Draft, protocol: Protocol, found: list[Stance], axes: Any
) -> list[Measurement]:
    definition = RcofDefinition(
        filter=LowPass(cutoff=protocol.number("force_cutoff", "Hz", 36.0)),
        gate=protocol.number("rcof_gate", "N", 100.0),
    )
    values = []
    for number, stance in enumerate(found, start=1):
        one = required_friction(trial, stance, definition, axes=axes)
        draft.add(f"step {number} on {stance.plate}", one.measurement)
        if one.measurement.value is None:
            continue
        values.append(one.measurement)
        force = plate_named(trial, stance.plate).force[stance.start : stance.stop]
        assert stance.walking is not None
        draft.curve(
            "steps",
            step=f"step {number} on {stance.plate}",
            time=one.time - stance.contact,
            ratio=one.ratio,
            normal=one.normal,
            along=force @ stance.walking,
            across=force @ np.cross(axes.up, stance.walking),
            gate=one.gate_time - stance.contact,
            peak_time=one.peak_time - stance.contact,
            peak=one.measurement.value,
        )
    if values:
        draft.add("mean of the steps", mean_of(values), main="rcof")
    return values


def _rates(trial: Trial, draft: Draft) -> None:
    rates = [plate.rate for plate in trial.plates if plate.usable]
    if rates:
        draft.facts["force_rate"] = float(min(rates))
    if trial.markers:
        draft.facts["marker_rate"] = float(next(iter(trial.markers.values())).rate)


def _with_side(stance: Stance, conditions: Mapping[str, Any]) -> Stance:
    side = str(conditions.get("side", "")).casefold()
    return replace(stance, side=side, heel="") if side in ("left", "right") else stance


def _by_hand(stance: Stance, trial: Trial) -> Stance:
    """Return the stance with the instants that were set by hand near it."""
    for event in trial.events:
        if event.source != "set by hand":
            continue
        if event.name == "heel contact" and abs(event.time - stance.contact) < 0.3:
            stance = replace(stance, contact=event.time)
        elif event.name == "toe off" and event.time > stance.contact:
            stance = replace(stance, toe_off=event.time)
    return stance


def _why(found: list[Stance]) -> list[str]:
    return list(dict.fromkeys(s.reason for s in found if s.reason)) or ["no peak found"]
