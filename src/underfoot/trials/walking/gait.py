"""Required friction (RCOF) of a step, every convention named."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, unknown_name
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import NOTHING, Message

from ..recording.axes import Ramp
from ..recording.measurement import Flag, Measurement, remark
from ..recording.signals import FILTERS, FORCE_FILTER, LowPass
from ..recording.trial import PlateAccuracy
from .events import Stance, stances
from .gait_context import push_off_flags
from .likelihood import impossible, unseen_gain
from .plausibility import baseline_error, other_foot_flags, rcof_flags, step_flags, unloaded_levels
from .slips import Outcome, Slip
from .slips import slip as heel_slip
from .step import Step
from .step_features import judged_features
from .walkway import Walkway, of_walkway

PEAKS = {
    "largest-local-maximum": Message("largest local maximum"),
    "first-local-maximum": Message("first local maximum"),
    "after-10-percent": Message(
        'largest local maximum after 10 % of stance (the classical "peak 3")'
    ),
    "plain-maximum": Message("largest value, local maximum or not"),
}
SHEARS = {
    "resultant": Message("resultant of both shear components"),
    "anterior-posterior": Message("shear along the walking direction only"),
}
_TILT = math.radians(1.0)  # plates are levelled better than that; it shifts the ratio by 0.017


@dataclass(frozen=True, slots=True)
class RcofDefinition:
    """What "required coefficient of friction" means; each choice goes with every number.

    ``filter``: low-pass of the forces. ``gate``: the normal force must have passed this (N), or
    ``gate_body_weight`` (share of body weight) when that is given. ``shear``: a key of ``SHEARS``.
    ``peak``: a key of ``PEAKS``. ``braking``: only while the floor pushes the foot backward (the
    foot pushes the floor forward). ``part``: share of the stance, from contact, that is searched.
    """

    filter: LowPass = field(default_factory=lambda: FORCE_FILTER)
    gate: float = 100.0
    gate_body_weight: float | None = None
    shear: str = "resultant"
    peak: str = "largest-local-maximum"
    braking: bool = True
    part: float = 0.5

    def __post_init__(self) -> None:
        if self.shear not in SHEARS:
            raise unknown_name("shear", self.shear, SHEARS, where="rcof.shear")
        if self.peak not in PEAKS:
            raise unknown_name("peak", self.peak, PEAKS, where="rcof.peak")
        if not 0 < self.part <= 1:
            raise InputError(
                Message("part {part}", part=self.part),
                where="rcof.part",
                allowed="above 0, up to 1",
            )
        if not self.gate > 0 or (self.gate_body_weight is not None and self.gate_body_weight <= 0):
            raise InputError("the gate must be above zero", where="rcof.gate")

    @property
    def other_filters(self) -> list[LowPass]:
        """What else the filter's name can mean, at the same cutoff; nothing without a filter."""
        kinds = set(FILTERS) - {"none", self.filter.kind} if self.filter.kind != "none" else ()
        return [replace(self.filter, kind=kind) for kind in kinds]

    def conventions(self) -> dict[str, Message]:
        """Return the choices, a line each."""
        gate = Message("{force:g} N", force=self.gate)
        if self.gate_body_weight is not None:
            gate = Message("{share:g} % of body weight", share=100 * self.gate_body_weight)
        backward = Message("while the reaction on the foot points backward (foot pushes forward)")
        return {
            "filter": self.filter.description,
            "gate": Message("normal force above {gate}", gate=gate),
            "shear": SHEARS[self.shear],
            "peak": PEAKS[self.peak],
            "direction": backward if self.braking else Message("any"),
            "searched": Message("first {share:g} % of the stance", share=100 * self.part),
        }


DEFINITIONS: dict[str, RcofDefinition] = {
    "default": RcofDefinition(),
    "first-maximum": RcofDefinition(peak="first-local-maximum"),
    "peak-3": RcofDefinition(peak="after-10-percent"),
    "anterior-posterior": RcofDefinition(shear="anterior-posterior"),
    "plain-maximum": RcofDefinition(peak="plain-maximum", braking=False),
    "gate-50": RcofDefinition(gate=50.0),
    "gate-body-weight": RcofDefinition(gate_body_weight=0.15),
    "corrected-cutoff": RcofDefinition(filter=LowPass("butterworth-4-zero-phase-corrected")),
    "eighth-order": RcofDefinition(filter=LowPass("butterworth-8-zero-phase")),
    "one-pass": RcofDefinition(filter=LowPass("butterworth-4-one-pass")),
    "unfiltered": RcofDefinition(filter=LowPass("none")),
}


@dataclass(frozen=True, slots=True, repr=False)
class RequiredFriction(Presentable):
    """Required friction of one stance, with what a figure needs.

    ``time`` (n,), ``ratio`` (n,) and ``normal`` (n,) cover the stance; ``peak_time`` and
    ``gate_time`` are NaN when there is no value. ``slip`` is what the heel did, None without its
    marker.
    """

    measurement: Measurement
    stance: Stance
    time: np.ndarray
    ratio: np.ndarray
    normal: np.ndarray
    peak_time: float = math.nan
    gate_time: float = math.nan
    slip: Slip | None = None

    @property
    def verdict(self) -> str:
        """ "accepted", "caution" (a flag matters) or "rejected"."""
        if self.measurement.value is None:
            return "rejected"
        return "caution" if self.measurement.caution_flags else "accepted"

    def __repr__(self) -> str:
        value = self.measurement.value
        number = self.measurement.reason[:60] if value is None else f"RCOF {value:.3f}"
        return f"<RequiredFriction {self.stance.label}: {number}, {self.verdict}>"

    def headline(self) -> tuple[Message, ...]:
        """Return the step's RCOF or why it has none."""
        verdict = Message("{step}: {verdict}.", step=self.stance.label, verdict=self.verdict)
        return verdict, *self.measurement.headline()

    def cautions(self) -> tuple[Message, ...]:
        """Return the flags of the number that matter, in words."""
        return self.measurement.cautions()

    def table(self) -> Table:
        """Return the step with its number, flags and conventions."""
        stance, table = self.stance, self.measurement.table()
        rows: list[tuple[Any, ...]] = [
            ("verdict", self.verdict),
            ("contact (s)", stance.contact),
            ("toe off (s)", stance.toe_off),
            ("foot", stance.side),
            ("peak force (N)", stance.peak),
            ("peak of the ratio (s after contact)", self.peak_time - stance.contact),
        ]
        return Table(Message("RCOF, {step}", step=stance.label), ("", ""), [*rows, *table.rows])


@of_walkway
def required_friction(
    walk: Walkway,
    stance: Stance,
    definition: RcofDefinition | None = None,
    *,
    checked: bool = True,
) -> RequiredFriction:
    """Return the required friction (RCOF) of one stance: a peak of shear over normal force.

    A rejected stance gives "not estimated" with the reason of its rejection, and so does a step
    whose heel slides: there the ratio is the available friction. The uncertainty holds the
    baseline, the readings of the filter's name and the plate's specification.

    ``checked``: look whether the heel slides and whether signals and result are plausible; without
    it only the number is taken.

    InputError: the filter does not fit the sampling rate.

    Source: definitions collected from Redfern 2001, Chang 2011, Beschorner 2016 and others; the
    default is the grant report's (G.6.1) made unambiguous, see docs/physics/required_friction.md.
    """
    definition, step = definition or DEFINITIONS["default"], Step(walk, stance)
    axes, weight, plate = walk.axes, walk.weight, step.plate
    choices = {
        **definition.conventions(),
        "baseline": plate.baseline_text,
        "walking direction": stance.direction.explanation,
        **step.surface_text,
    }
    slip: Slip | None = None

    def without(reason: Message) -> RequiredFriction:
        missing, empty = Measurement.not_estimated("rcof", reason, conventions=choices), np.empty(0)
        return RequiredFriction(missing, stance, empty, empty, empty, slip=slip)

    if not stance.accepted or stance.walking is None:
        return without(stance.reason or Message("no walking direction"))
    if checked and stance.heel:
        up, forward = step.surface  # a heel slides along it
        slip = heel_slip(step.heel, stance.contact, up=up, walking=forward, leaves=stance.toe_off)
        if slip.slides:
            text = Message(
                "the heel slides at {peak:.2f} m/s over {way:.0f} mm: the ratio is available "
                "friction (ACOF), not required",
                peak=float(slip.peak_speed), way=1e3 * float(slip.distance),
            )  # fmt: skip
            return without(text)
    gate = definition.gate
    if definition.gate_body_weight is not None:
        if weight is None:
            return without(Message("the gate is a share of body weight and the mass is not known"))
        gate = definition.gate_body_weight * weight.newtons
    speed = step.speed if checked else None
    features = judged_features(step) if checked else {}
    reason = impossible(features, speed=speed)
    if reason:
        return without(reason)
    try:
        curves = _curves(step.filtered_force[definition.filter], step.surface, definition.shear)
    except DataError as error:
        return without(Message.plain(error.what))
    normal, ratio, along = curves
    time = plate.start + np.arange(stance.start, stance.stop) / plate.rate
    passed = np.flatnonzero(normal > gate)
    if not len(passed):
        return without(Message("the normal force never passes {gate:.0f} N", gate=gate))
    at = _peak(definition, ratio, _allowed_samples(definition, normal, along, gate))
    if at is None:
        text = Message("no {peak} while the gate is passed", peak=PEAKS[definition.peak])
        return without(text)
    value = float(ratio[at])
    flags = plate.flags + stance.flags + _tilt_flags(step.slope, axes.ramp)
    after = 1e3 * (at - passed[0]) / plate.rate
    if after < 2.0:
        flags += (
            remark(
                "the peak lies {time:.0f} ms after the gate: the gate may have made it", time=after
            ),
        )
    uncertainty, parts = None, Message("not estimated")
    if checked:
        levels = unloaded_levels(step)
        flags += step_flags(step, definition.filter, features, levels)
        flags += rcof_flags(value, axes.ramp, speed)
        flags += push_off_flags(step)
        flags += unseen_gain(features, value, mass=weight is not None, speed=speed)
        if slip is not None and slip.outcome is Outcome.MICROSLIP:
            flags += tuple(f for f in slip.peak_speed.flags if f.name == "speed against distance")
        filtering = [value]
        for other in definition.other_filters:
            load, curve, push = _curves(step.filtered_force[other], step.surface, definition.shear)
            top = _peak(definition, curve, _allowed_samples(definition, load, push, gate))
            if top is not None:
                filtering.append(float(curve[top]))
        baseline = baseline_error(levels, step.surface[0], float(normal[at]), value)
        uncertainty, parts = _uncertainty(value, baseline, filtering, plate.accuracy)
    unasked = NOTHING if checked else Message("not asked for")
    choices["uncertainty"] = parts
    once = tuple(dict.fromkeys(flags))
    measurement = Measurement(
        "rcof", value, "1", uncertainty, unasked, flags=once, conventions=choices
    )
    instants = float(time[at]), float(time[passed[0]])
    return RequiredFriction(measurement, stance, time, ratio, normal, *instants, slip)


@of_walkway
def required_frictions(
    walk: Walkway, definition: RcofDefinition | None = None
) -> list[RequiredFriction]:
    """Return the required friction of every stance of a trial, rejected ones with the reason."""
    return stance_frictions(walk, stances(walk), definition)


@of_walkway
def stance_frictions(
    walk: Walkway, chosen: list[Stance], definition: RcofDefinition | None = None
) -> list[RequiredFriction]:
    """Return the required friction of the stances given, each compared with the others."""
    steps = [required_friction(walk, stance, definition) for stance in chosen]
    values = [(s.stance.plate, s.measurement.value) for s in steps]
    for i, step in enumerate(steps):
        friction, here = step.measurement, step.stance.plate
        if friction.value is not None:
            others = [v for plate, v in values if v is not None and plate != here]
            more = other_foot_flags(friction.value, others, walk.weight)
            steps[i] = replace(step, measurement=replace(friction, flags=friction.flags + more))
    return steps


def _tilt_flags(slope: float | None, ramp: Ramp) -> tuple[Flag, ...]:
    """Caution where a plate's corners slope along the walk (rad) and the ramp says otherwise."""
    stated = ramp.angle if ramp.plate_frame == "horizontal" else 0.0
    if slope is None or abs(slope - stated) <= _TILT:
        return ()
    text = Message(
        "the plate's corners slope by {slope:.1f} deg along the walk and its forces are taken as "
        "on a slope of {stated:.1f} deg: check the angle of the ramp",
        slope=math.degrees(slope), stated=math.degrees(stated),
    )  # fmt: skip
    return (Flag("plate slope", text, True, abs(slope - stated), _TILT, "rad"),)


def _curves(
    force: np.ndarray, surface: tuple[np.ndarray, np.ndarray], counted: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return normal force, ratio and shear along the walk over the stance, (n,) each.

    ``force`` (n, 3) is filtered; ``surface`` holds normal and forward tangent of the walking
    surface; ``counted`` is a key of ``SHEARS``.
    """
    up, forward = surface
    normal = force @ up
    shear = force - np.outer(normal, up)
    along = shear @ forward
    size = np.linalg.norm(shear, axis=1) if counted == "resultant" else np.abs(along)
    return normal, np.where(normal > 1.0, size / np.maximum(normal, 1.0), np.nan), along


def _uncertainty(
    value: float, baseline: float, readings: Sequence[float], accuracy: PlateAccuracy
) -> tuple[float, Message]:
    """Return the standard uncertainty of one step's RCOF ``value``, and a line of its parts.

    Baseline: the largest effect of the unloaded level before or after the step. Filter: the range
    of the ``readings`` by the four filters that "4th order Butterworth" can mean, as a rectangle.
    Plate: gain of shear and of normal force, and crosstalk, each a rectangle of its specification.
    """
    plate = math.hypot(math.sqrt(2.0) * accuracy.gain * value, accuracy.crosstalk) / math.sqrt(3.0)
    filtering = (max(readings) - min(readings)) / math.sqrt(12.0)
    parts = Message(
        "baseline {baseline:.4f}, readings of the filter's name {filtering:.4f}, plate {plate:.4f} "
        "(gain {gain:g} %, crosstalk {crosstalk:g} %, {source})",
        baseline=baseline, filtering=filtering, plate=plate, gain=100 * accuracy.gain,
        crosstalk=100 * accuracy.crosstalk, source=accuracy.source,
    )  # fmt: skip
    return math.hypot(baseline, filtering, plate), parts


def _allowed_samples(
    definition: RcofDefinition, normal: np.ndarray, along: np.ndarray, gate: float
) -> np.ndarray:
    allowed = normal > gate
    allowed[round(definition.part * len(normal)) :] = False
    if definition.peak == "after-10-percent":
        allowed[: round(0.1 * len(normal))] = False
    if definition.braking:
        allowed &= along < 0
    return allowed


def _peak(definition: RcofDefinition, ratio: np.ndarray, allowed: np.ndarray) -> int | None:
    top = np.isfinite(ratio)
    if definition.peak != "plain-maximum":
        filled = np.nan_to_num(ratio, nan=0.0)
        top = np.zeros(len(ratio), dtype=bool)
        top[1:-1] = (filled[1:-1] > filled[:-2]) & (filled[1:-1] >= filled[2:])
    candidates = np.flatnonzero(allowed & top)
    if not len(candidates):
        return None
    first = definition.peak == "first-local-maximum"
    return int(candidates[0 if first else np.argmax(ratio[candidates])])
