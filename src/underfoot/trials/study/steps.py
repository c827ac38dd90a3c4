"""Analysis of one file by the kind of its protocol: steps, slides, disks, relaxation."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, fields, replace
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, UnderfootError, unknown_name
from underfoot.core.remark import NOTHING, Message, Remark
from underfoot.core.unit_text import plain_number

from ..machines.compression import compression
from ..machines.pin_on_disk import friction_point
from ..machines.pressure_map import pressure_scan
from ..machines.pressures import sensor_array_reading
from ..machines.relaxation_test import RelaxationReading, relaxation_reading
from ..machines.slip_friction import slide_friction, slide_plate
from ..machines.tester_checks import log_kind, scan_flags, slide_flags
from ..readers import TrialsProfile
from ..recording.axes import Ramp, axes_of
from ..recording.measurement import MEAN_OF_STEPS, Measurement, mean_of
from ..recording.protocols import KINDS, QUANTITIES, Protocol
from ..recording.signals import LowPass
from ..recording.trial import Trial
from ..walking.events import Stance, no_contact_reason, stances
from ..walking.gait import DEFINITIONS, RcofDefinition, RequiredFriction, stance_frictions
from ..walking.gait_context import gait_context, slip_course, stance_curves
from ..walking.plausibility import unseen
from ..walking.slips import OutcomeLimits, Slip, SlipDefinition, slip_of
from ..walking.walkway import Walkway, walkway_of
from .edit_table import edit_log
from .file_result import FileResultDraft, LoggedEdit, StepResult, rates, refer_to
from .person_measures import person_measures


def analysed_trial(
    trial: Trial, draft: FileResultDraft, protocol: Protocol, profile: TrialsProfile
) -> None:
    """Analyse one trial into ``draft`` by the kind of the protocol.

    An `UnderfootError` says what makes the whole file useless; single numbers that can't be
    measured are kept as "not estimated".
    """
    _check_kind(trial, protocol, profile)
    if protocol.kind in STEP_KINDS:
        analysed_steps(trial, draft, protocol, profile)
        return
    for edit in trial.edits:
        draft.refusals.append(Remark("excluded by hand", "{why}", why=edit.why))
        draft.edits.append(LoggedEdit(draft.file, edit.what, "used", "excluded", edit.why))
    _KINDS[protocol.kind](trial, draft, protocol, profile)


def _check_kind(trial: Trial, protocol: Protocol, profile: TrialsProfile) -> None:
    """Refuse a tester's slide as a walk, and a walk as a slide."""
    steps = protocol.kind in STEP_KINDS
    if not steps and protocol.kind != "slip_tester":
        return
    up = axes_of(trial, vertical=profile.vertical).up
    kinds = {log_kind(plate, up) for plate in trial.plates if plate.usable} - {""}
    if kinds == {"slide" if steps else "walk"}:
        meant = {"name": protocol.name, "kind": KINDS[protocol.kind]}
        what = Message("the forces are those of a walking step, and {name} is for {kind}", **meant)
        if steps:
            what = Message(
                "the forces are those of a slide of a slip tester, and {name} is for {kind}",
                **meant,
            )
        other = "en_iso_13287 or a protocol of your tester" if steps else "level_walking"
        raise DataError(
            what,
            where=trial.name,
            remedy=Message("Use --protocol {other}", other=other),
        )


def _slip_tester(
    trial: Trial, draft: FileResultDraft, protocol: Protocol, profile: TrialsProfile
) -> None:
    axes, record = axes_of(trial, vertical=profile.vertical), profile.calibration
    slide = slide_friction(trial, protocol, axes, record)
    rates(trial, draft)
    cof = slide.cof
    if cof.value is not None:
        plate = slide_plate(trial, axes.up, record)
        cof = replace(cof, flags=(*cof.flags, *slide_flags(slide, plate, axes.up, record)))
    else:
        draft.refusals.append(Remark.of("no COF", cof.reason))
    draft.add("slide", cof, main="cof")
    refer_to(record, draft)
    for fact, value in slide.facts.items():
        draft.note(value, QUANTITIES[fact], fact=fact)
    series = {key: getattr(slide, key) for key in ("time", "normal", "shear", "ratio")}
    draft.curve("slide", **series, begin=slide.window[0], end=slide.window[1])
    if not profile.sensors or not trial.markers:
        return
    name, position = next(iter(profile.sensors.items()))
    marker = next(iter(trial.markers.values()))
    sensor = trial.channel(name)
    factor = record.channel("pressure").factor if record else 1.0
    sensor = replace(sensor, values=factor * sensor.values)
    try:
        scan = pressure_scan(trial, sensor, marker, position=position)
    except DataError as error:
        draft.cautions.append(Remark.of("no pressure scan", error.what))
        return
    draft.cautions += list(scan.flags)
    highest = float(scan.pressure.max())
    flags = scan_flags(scan, record)
    peak = Measurement("peak fluid pressure", highest, "Pa", scan.baseline_sd, flags=flags)
    draft.add("scan", peak, main="scan_peak_pressure")
    stored = {
        f.name: getattr(scan, f.name) for f in fields(scan) if f.name not in ("trial", "flags")
    }
    for name in ("along", "pressure"):
        stored[name] = [float(f"{v:.7g}") for v in stored[name]]
    draft.curves["scan"] = stored


def _pin_on_disk(
    trial: Trial, draft: FileResultDraft, protocol: Protocol, profile: TrialsProfile
) -> None:
    point, noted = friction_point(trial), draft.conditions.get("speed")
    speed = point.speed
    if isinstance(noted, float):
        if speed is not None and abs(noted - speed) > SPEEDS_APART * max(noted, speed):
            draft.cautions.append(
                Remark(
                    "sliding speed",
                    "{speed} m/s in the log, {noted} m/s is noted and counts",
                    speed=plain_number(speed),
                    noted=plain_number(noted),
                )
            )
        speed = noted
    draft.add(trial.name, point.cof, main="cof")
    draft.note(point.time[-1] - point.time[0], "s", fact="duration")
    if point.normal is not None:
        draft.note(point.normal, "N", fact="normal_force")
    if point.shear is not None:
        draft.note(point.shear, "N", main="friction_force")
    if speed is not None:
        draft.note(speed, "m/s", main="speed", fact="sliding_speed")
    begin, end = point.window
    cof = point.cof.value or np.nan
    draft.curve("run", time=point.time, ratio=point.ratio, begin=begin, end=end, cof=cof)


def _relaxation(
    trial: Trial, draft: FileResultDraft, protocol: Protocol, profile: TrialsProfile
) -> None:
    thickness = draft.conditions.get("thickness")
    if not isinstance(thickness, float):
        raise DataError(
            "the thickness of the block is not known",
            where=trial.name,
            remedy='Add a column "thickness (mm)" to conditions.csv',
        )
    reading = relaxation_reading(trial, thickness)
    for name in ("force_2_percent", "peak_force", "final_force"):
        draft.add("test", getattr(reading, name), main=name)
    for measurement in _moduli(reading, thickness, draft.conditions.get("area"), trial.name):
        draft.add("test", measurement, main=measurement.name)
    draft.note(reading.hold_time, "s", fact="hold_time")
    draft.note(reading.peak_displacement / (2.0 * thickness), "1", fact="compression")
    time, force = reading.hold
    log = np.unique(np.geomspace(1, len(time) - 1, 300).astype(int))
    draft.curve("hold", time=time[log], force=force[log], final=float(reading.final_force))


def _moduli(
    reading: RelaxationReading, thickness: float, area: object, name: str
) -> Iterator[Measurement]:
    """Yield stiffness and modulus at short and long time (Eq. 13 to 16), and Young's moduli."""
    if not isinstance(area, float):
        reason = Message(
            'the area of the block is not known: add a column "area (mm^2)" to conditions.csv'
        )
        for each in ("short-time modulus", "long-time modulus"):
            yield Measurement.not_estimated(each, reason, unit="Pa")
        return
    test = compression(reading, thickness, area, name)
    meant = {"modulus": Message("of the pair, apparent (Eq. 13 to 16)")}
    forces = reading.force_2_percent, reading.peak_force, reading.final_force
    low, peak, final = ((float(force), force.uncertainty or 0.0) for force in forces)
    for time, (high, noise) in (("short", peak), ("long", final)):
        spread = math.hypot(noise, low[1]) / (high - low[0])
        stiffness = getattr(test.moduli, f"{time}_time_stiffness")
        modulus = getattr(test.moduli, f"{time}_time_modulus")
        yield Measurement(f"{time}-time stiffness", stiffness, "N/m", spread * stiffness,
                          conventions=meant)  # fmt: skip
        yield Measurement(f"{time}-time modulus", modulus, "Pa", spread * modulus,
                          conventions=meant)  # fmt: skip
        young = modulus / test.factor
        yield Measurement(
            f"{time}-time Young's modulus",
            young,
            "Pa",
            young * math.hypot(spread, test.deviation),
            conventions={
                "shape": Message(
                    "apparent over {factor:.3g}, bonded square block", factor=test.factor
                )
            },
        )


_KINDS: Mapping[str, Callable[[Trial, FileResultDraft, Protocol, TrialsProfile], None]] = {
    "slip_tester": _slip_tester,
    "pin_on_disk": _pin_on_disk,
    "boundary": _pin_on_disk,
    "relaxation": _relaxation,
}


SPEEDS_APART = 0.1
"""Relative difference of the speed in a log and the one noted from which it is told; assumed."""
STEP_KINDS = ("gait", "human_slip")
_SETTINGS = ("filter", "gate", "gate_body_weight", "shear", "peak", "braking", "part")


def rcof_definition(protocol: Protocol) -> RcofDefinition:
    """Return the definition of RCOF that a protocol sets.

    ``definition`` names one of ``DEFINITIONS``; ``force_cutoff`` and ``rcof_filter``,
    ``rcof_gate``, ``rcof_gate_body_weight``, ``rcof_shear``, ``rcof_peak``, ``rcof_braking``,
    ``rcof_part`` change single choices. An unknown name or setting is an `InputError`.
    """
    where = protocol.where
    known = [f"rcof_{key}" for key in _SETTINGS]
    for key in protocol.method:
        if key.startswith("rcof_") and key not in known:
            raise unknown_name("setting", key, known, where=where)
    name = protocol.text("definition", "default")
    if name not in DEFINITIONS:
        raise unknown_name("RCOF definition", name, DEFINITIONS, where=where)
    base = DEFINITIONS[name]
    changes: dict[str, Any] = {
        "filter": LowPass(
            protocol.text("rcof_filter", base.filter.kind),
            protocol.number("force_cutoff", "Hz", base.filter.cutoff),
        ),
        "gate": protocol.number("rcof_gate", "N", base.gate),
        "shear": protocol.text("rcof_shear", base.shear),
        "peak": protocol.text("rcof_peak", base.peak),
        "part": protocol.number("rcof_part", "1", base.part),
    }
    if "rcof_gate_body_weight" in protocol.method:
        changes["gate_body_weight"] = protocol.number("rcof_gate_body_weight", "1")
    if "rcof_braking" in protocol.method:
        changes["braking"] = protocol.text("rcof_braking").casefold() in ("true", "yes", "1")
    return replace(base, **changes)


def slip_definition(protocol: Protocol) -> SlipDefinition:
    """Return the definition of a slip that a protocol sets: ``slip_threshold``, ``marker_cutoff``.

    What it does not say is the standard definition's.
    """
    standard = SlipDefinition()
    return SlipDefinition(
        threshold=protocol.number("slip_threshold", "m/s", standard.threshold),
        filter=LowPass(cutoff=protocol.number("marker_cutoff", "Hz", standard.filter.cutoff)),
    )


def protocol_ramp(protocol: Protocol) -> Ramp:
    """Return the slope of the walkway that a protocol sets (``ramp``, ``plate_frame``).

    No angle, and a slope without the axes of its plates, are an `InputError`.
    """
    return Ramp(protocol.number("ramp", "rad", 0.0), protocol.text("plate_frame"))


def walkway(trial: Trial, protocol: Protocol, profile: TrialsProfile) -> Walkway:
    """Return a trial on its walkway: what the profile gives, the protocol's ramp."""
    given = {key: getattr(profile, key) for key in ("vertical", "walking", "landmarks")}
    return walkway_of(trial, **given, ramp=protocol_ramp(protocol))


def check_ramp(protocol: Protocol) -> None:
    """Refuse a ramp that can't be one, or that a protocol without steps is given."""
    if protocol.kind in STEP_KINDS:
        protocol_ramp(protocol)
    elif "ramp" in protocol.method or "plate_frame" in protocol.method:
        raise InputError(
            Message("a ramp has no meaning in a protocol of the kind {kind}", kind=protocol.kind),
            where=protocol.where,
            allowed="only walking and human slips take ramp and plate_frame",
        )


def analysed_steps(
    trial: Trial, draft: FileResultDraft, protocol: Protocol, profile: TrialsProfile
) -> None:
    """Analyse a walk or a slip into ``draft``; edits are applied and logged.

    A recording without contact is a `DataError` with the cause, an edit by hand that can't be
    applied an `EditError`.
    """
    analysis = {"gait": _gait, "human_slip": _human_slip}[protocol.kind]
    walk = walkway(trial, protocol, profile)
    analysis(_Walk(walk, draft, protocol, profile))
    if trial.edits:
        before = FileResultDraft(draft.file, draft.conditions)
        unedited = replace(walk, trial=replace(trial, edits=()))
        analysis(_Walk(unedited, before, protocol, profile))
        draft.edits += edit_log(trial.edits, before.steps, draft.steps)


class _Walk:
    """A recording with its contacts, analysed into a draft."""

    def __init__(
        self, way: Walkway, draft: FileResultDraft, protocol: Protocol, profile: TrialsProfile
    ) -> None:
        self.way, self.trial, self.draft, self.axes = way, way.trial, draft, way.axes
        self.protocol, self.profile = protocol, profile
        self.stances = stances(way)
        if not self.stances:
            raise DataError(no_contact_reason(way), where=self.trial.name)
        rates(self.trial, draft)
        draft.cautions += [flag.message for flag in unseen(way)]
        draft.body = person_measures(self.trial, self.stances, self.axes)


def _gait(walk: _Walk) -> None:
    if not _add_rcof(walk, walk.stances):
        reasons = dict.fromkeys(step.reason for step in walk.draft.steps if step.reason)
        why = [*reasons] or [Message("no peak found")]
        walk.draft.refusals.append(Remark("no clean step", "{reasons:; }", reasons=why))


def _human_slip(walk: _Walk) -> None:
    draft, protocol = walk.draft, walk.protocol
    name = str(draft.conditions.get("slip plate") or protocol.text("slip_plate"))
    on_plate = [s for s in walk.stances if not name or s.plate == name]
    if not on_plate:
        raise DataError(
            Message("no contact with the slippery plate ({name})", name=name), where=walk.trial.name
        )
    _add_rcof(walk, [s for s in walk.stances if s not in on_plate])
    definition = slip_definition(protocol)
    standard = OutcomeLimits()
    limits = OutcomeLimits(
        protocol.number("no_slip_distance", "m", standard.no_slip),
        protocol.number("microslip_distance", "m", standard.microslip),
        protocol.number("slide_distance", "m", standard.slide),
    )
    usable = [s for s in on_plate if "exclude" not in s.by_hand]
    for stance in on_plate:
        if stance not in usable[:1]:
            reason = stance.reason or Message("a later contact with the slippery plate")
            draft.steps.append(_step(walk, stance, reason=reason))
    if not usable:
        draft.refusals.append(on_plate[0].reason)
        return
    stance = usable[0]
    side = str(draft.conditions.get("side", "")).casefold()
    if side in ("left", "right") and "side" not in stance.by_hand:
        stance = replace(stance, side=side, heel="")
    slip = slip_of(walk.way, stance, definition=definition, limits=limits)
    _slip_numbers(walk, stance, slip, limits)
    _ratio_curve(walk, stance, "slipping")
    if slip.motion is not None:
        motion = slip.motion
        near = (motion.time > slip.contact - 0.15) & (motion.time < slip.contact + 0.9)
        times = {
            "time": motion.time[near], "start": slip.start.value or np.nan, "end": slip.end,
            "peak_time": slip.peak_time,
        }  # fmt: skip
        after = {key: time - slip.contact for key, time in times.items()}
        speeds = {"speed": motion.speed[near], "peak": slip.peak_speed.value or np.nan}
        draft.curve("heel", **after, **speeds, threshold=definition.threshold)
    if walk.profile.sensors and stance.walking is not None:
        _sensors(walk, slip, stance.walking)
    acof = draft.conditions.get("acof")
    if isinstance(acof, float) and "rcof" in draft.main:
        draft.note(acof, "1", main="acof")
        draft.note(acof - draft.main["rcof"], "1", main="acof_minus_rcof")


def _slip_numbers(walk: _Walk, stance: Stance, slip: Slip, limits: OutcomeLimits) -> None:
    draft = walk.draft
    course = slip_course(walk.way, stance, slip, limits)
    item = f"slip on {stance.plate}"
    draft.add(item, slip.start)
    draft.add(item, slip.peak_speed, main="peak_slipping_speed")
    draft.add(item, slip.distance, main="slip_distance")
    draft.add(item, slip.margin, main="slip_margin")
    draft.cautions += [
        Message("{item}: {message}", item=item, message=flag.message)
        for flag in course.flags
        if flag.matters
    ]
    if slip.slipped is None:
        draft.refusals.append(slip.peak_speed.reason)
    else:
        draft.note(slip.slipped, "1", main="slip")
    step = replace(
        _step(walk, stance),
        item=item,
        verdict="not estimated" if slip.slipped is None else "accepted",
        judged_for_slip=True,
        peak_slipping_speed=slip.peak_speed.value,
        slip_start=slip.start.value,
        slip_distance=slip.distance.value,
        slipped=slip.slipped,
        outcome=None if slip.outcome is None else str(slip.outcome),
        slip_direction=slip.way,
        recovery_or_fall=course.body,
        recovery_or_fall_reason=course.body_reason,
        **{key: getattr(course, key) for key in ("toe_slip", "trailing_slip", "misstep")},
    )
    draft.steps.append(step)


def _sensors(walk: _Walk, slip: Slip, walking: np.ndarray) -> None:
    trial, draft, sensors, up = walk.trial, walk.draft, walk.profile.sensors, walk.axes.up
    try:
        reading = sensor_array_reading(trial, slip, sensors, up=up, walking=walking)
    except UnderfootError as error:
        draft.cautions.append(Remark.of("pressures", error.what))
        return
    draft.add("sensor array", reading.peak, main="peak_pressure")
    draft.note(float(reading.crossed), "1", main="crossed_array")
    across = np.cross(up, walking)
    places = {n: (float(np.dot(p, walking)), float(np.dot(p, across))) for n, p in sensors.items()}
    middle = np.mean([[min(c), max(c)] for c in zip(*places.values(), strict=True)], axis=1)
    pulses = []
    for name, pulse in reading.pulses.items():
        draft.add(f"sensor {name}", pulse.peak)
        draft.add(f"sensor {name}", pulse.duration)
        channel = trial.channel(name)
        near = (channel.time > slip.contact - 0.1) & (channel.time < slip.contact + 0.6)
        step = max(1, int(near.sum()) // 150)
        kilopascal = 1e-3 * (channel.values[near] - pulse.baseline)
        along, beside = (float(p - m) for p, m in zip(places[name], middle, strict=True))
        times = [round(float(t), 4) for t in (channel.time[near] - slip.contact)[::step]]
        shown = [None if np.isnan(v) else round(float(v), 3) for v in kilopascal[::step]]
        pulse_of = {"sensor": name, "along": along, "across": beside, "time": times, "kPa": shown}
        pulses.append(pulse_of)
        passage = reading.passages.get(name)
        if passage is not None:
            draft.add(f"sensor {name}", passage.speed)
            draft.add(f"sensor {name}", passage.lateral)
            if passage.speed.value is not None and pulse.peak.value is not None:
                speeds = {"irss": passage.speed.value, "ml": float(passage.lateral)}
                facts = {"row": passage.row, "pressure": pulse.peak.value, **speeds}
                draft.curve("sensor_rows", sensor=name, **facts)
    if pulses:
        quiet = trial.channel(next(iter(reading.pulses)))
        before = float(np.sum(quiet.time < slip.contact - 0.05))
        draft.note(before, "1", fact="baseline_samples")
        track = reading.track if len(reading.track) else np.full((1, 2), np.nan)
        draft.curve("track", along=track[:, 0], across=track[:, 1], pulses=pulses)


def _add_rcof(walk: _Walk, chosen: list[Stance]) -> list[Measurement]:
    """Add the RCOF of the chosen contacts."""
    draft, axes = walk.draft, walk.axes
    definition = rcof_definition(walk.protocol)
    steps = stance_frictions(walk.way, chosen, definition)
    values = []
    for step in steps:
        stance, rcof = step.stance, step.measurement
        draft.add(stance.label, rcof)
        draft.steps.append(_step(walk, stance, step))
        if rcof.value is None:
            _ratio_curve(walk, stance, "rejected")
            continue
        values.append(rcof)
        assert stance.walking is not None  # an RCOF has one
        force = walk.way.plate(stance.plate).force[stance.start : stance.stop]
        series: dict[str, Any] = {
            "time": step.time - stance.contact, "ratio": step.ratio, "normal": step.normal,
            "along": force @ axes.ramp.surface(axes.up, stance.walking)[1],
            "across": force @ np.cross(axes.up, stance.walking),
            "gate": step.gate_time - stance.contact,
            "peak_time": step.peak_time - stance.contact, "peak": rcof.value,
        }  # fmt: skip
        named = {"step": stance.label, "number": stance.number}
        draft.curve("steps", **named, **series, verdict=step.verdict)
        curves = stance_curves(walk.way, stance, step.ratio, definition.filter)
        draft.curve("normalised", step=stance.label, **curves)
    draft.note(len(values), "1", fact="steps")
    cautious = sum(bool(rcof.caution_flags) for rcof in values)
    draft.note(cautious, "1", fact="steps_with_caution")
    if values:
        draft.add(MEAN_OF_STEPS, mean_of(values), main="rcof")
    return values


def _ratio_curve(walk: _Walk, stance: Stance, kind: str) -> None:
    """Keep the plain ratio of a contact without a required friction: rejected, or slipping."""
    plate, axes = walk.way.plate(stance.plate), walk.axes
    force = plate.force[stance.start : stance.stop]
    up = axes.up if stance.walking is None else axes.ramp.surface(axes.up, stance.walking)[0]
    normal = force @ up
    shear = np.linalg.norm(force - np.outer(normal, up), axis=1)
    time, ratio = np.arange(len(force)) / plate.rate, shear / np.maximum(normal, 1.0)
    named = {"step": stance.label, "number": stance.number, "reason": stance.reason}
    walk.draft.curve(kind, time=time, normal=normal, ratio=ratio, **named)


def _step(
    walk: _Walk,
    stance: Stance,
    friction: RequiredFriction | None = None,
    *,
    reason: Message = NOTHING,
) -> StepResult:
    rcof = None if friction is None else friction.measurement
    why = reason or stance.reason or (rcof.reason if rcof and rcof.value is None else NOTHING)
    shared = ("number", "plate", "side", "contact", "toe_off", "by_hand")
    return StepResult(
        **{key: getattr(stance, key) for key in shared},
        item=stance.label,
        stance_time=stance.duration,
        peak_force=stance.peak,
        rcof=None if rcof is None else rcof.value,
        rcof_uncertainty=None if rcof is None else rcof.uncertainty,
        verdict="rejected" if friction is None else friction.verdict,
        reason=why,
        cautions=() if rcof is None else rcof.cautions(),
        **asdict(gait_context(walk.way, stance, walk.stances)),
    )
