"""Required friction (RCOF) of a step, every convention named."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from underfoot.core import DataError, InputError, unknown_name

from .axes import Axes, axes_of
from .events import Stance, body_mass, stances
from .filters import FORCE_FILTER, LowPass, low_passed
from .measurement import Measurement
from .plates import baseline_words, plate_named
from .trial import Trial

PEAKS = {
    "largest-local-maximum": "largest local maximum",
    "first-local-maximum": "first local maximum",
    "after-10-percent": 'largest local maximum after 10 % of stance (the classical "peak 3")',
    "plain-maximum": "largest value, local maximum or not",
}
SHEARS = {
    "resultant": "resultant of both shear components",
    "anterior-posterior": "shear along the walking direction only",
}
GRAVITY = 9.80665


@dataclass(frozen=True, slots=True)
class RcofDefinition:
    """What "required coefficient of friction" means; each choice goes with every number.

    Parameters
    ----------
    filter
        Low-pass of the forces.
    gate
        The normal force must have passed this (N), or ``gate_body_weight`` (share of body
        weight) when that is given.
    shear
        A key of ``SHEARS``.
    peak
        A key of ``PEAKS``.
    braking
        Only while the floor pushes the foot backward (the foot pushes the floor forward).
    part
        Share of the stance, from contact, that is searched.
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
            raise InputError(f"part {self.part}", where="rcof.part", allowed="above 0, up to 1")
        if not self.gate > 0 or (self.gate_body_weight is not None and self.gate_body_weight <= 0):
            raise InputError("the gate must be above zero", where="rcof.gate")

    def conventions(self) -> dict[str, str]:
        """Return the choices in words."""
        gate = f"normal force above {self.gate:g} N"
        if self.gate_body_weight is not None:
            gate = f"normal force above {100 * self.gate_body_weight:g} % of body weight"
        direction = "while the reaction on the foot points backward (foot pushes forward)"
        return {
            "filter": str(self.filter),
            "gate": gate,
            "shear": SHEARS[self.shear],
            "peak": PEAKS[self.peak],
            "direction": direction if self.braking else "any",
            "searched": f"first {100 * self.part:g} % of the stance",
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


@dataclass(frozen=True, slots=True)
class RequiredFriction:
    """Required friction of one stance, with what a figure needs.

    ``time`` (n,), ``ratio`` (n,) and ``normal`` (n,) cover the stance; ``peak_time`` and
    ``gate_time`` are NaN when there is no value.
    """

    measurement: Measurement
    stance: Stance
    time: np.ndarray
    ratio: np.ndarray
    normal: np.ndarray
    peak_time: float = math.nan
    gate_time: float = math.nan


def required_friction(
    trial: Trial,
    stance: Stance,
    definition: RcofDefinition | None = None,
    *,
    axes: Axes | None = None,
) -> RequiredFriction:
    """Return the required friction (RCOF) of one stance: a peak of shear over normal force.

    A rejected stance gives "not estimated" with the reason of its rejection.

    Errors
    ------
    InputError
        The filter does not fit the sampling rate.

    Source: definitions collected from Redfern 2001, Chang 2011, Beschorner 2016 and others; the
    default is the grant report's (G.6.1) made unambiguous, see docs/physics/required_friction.md.
    """
    definition = definition or DEFINITIONS["default"]
    axes = axes or axes_of(trial)
    plate = plate_named(trial, stance.plate)
    said = {
        **definition.conventions(),
        "baseline": baseline_words(plate),
        "walking direction": stance.walking_from,
    }
    empty = np.empty(0)

    def without(reason: str) -> RequiredFriction:
        missing = Measurement.not_estimated("rcof", reason, conventions=said)
        return RequiredFriction(missing, stance, empty, empty, empty)

    if not stance.accepted or stance.walking is None:
        return without(stance.reason or "no walking direction")
    try:
        force = low_passed(plate.force, plate.rate, definition.filter)
    except DataError as error:
        return without(error.what)
    force = force[stance.start : stance.stop]
    normal = force @ axes.up
    shear = force - np.outer(normal, axes.up)
    along = shear @ stance.walking
    size = np.linalg.norm(shear, axis=1) if definition.shear == "resultant" else np.abs(along)
    gate = definition.gate
    if definition.gate_body_weight is not None:
        mass = body_mass(trial)
        if mass is None:
            return without("the gate is a share of body weight and the mass is not known")
        gate = definition.gate_body_weight * mass * GRAVITY
    ratio = np.where(normal > 1.0, size / np.maximum(normal, 1.0), np.nan)
    time = plate.start + np.arange(stance.start, stance.stop) / plate.rate
    passed = np.flatnonzero(normal > gate)
    if not len(passed):
        return without(f"the normal force never passes {gate:.0f} N")
    allowed = _allowed(definition, normal, along, gate)
    at = _peak(definition, ratio, allowed)
    if at is None:
        return without(f"no {PEAKS[definition.peak]} while the gate is passed")
    flags = tuple(note for note in plate.notes if "baseline" in note) + stance.flags
    after = 1e3 * (at - passed[0]) / plate.rate
    if after < 2.0:
        flags += (f"the peak lies {after:.0f} ms after the gate: the gate may have made it",)
    measurement = Measurement(
        "rcof",
        float(ratio[at]),
        reason="one step has no scatter: average several",
        flags=flags,
        conventions=said,
    )
    return RequiredFriction(
        measurement, stance, time, ratio, normal, float(time[at]), float(time[passed[0]])
    )


def required_frictions(
    trial: Trial,
    definition: RcofDefinition | None = None,
    *,
    axes: Axes | None = None,
    walking: str | None = None,
    heels: Mapping[str, str] | None = None,
) -> list[RequiredFriction]:
    """Return the required friction of every stance of a trial, rejected ones with the reason."""
    axes = axes or axes_of(trial, walking=walking)
    found = stances(trial, axes=axes, walking=walking, heels=heels)
    return [required_friction(trial, stance, definition, axes=axes) for stance in found]


def _allowed(
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
    if definition.peak == "plain-maximum":
        candidates = np.flatnonzero(allowed & np.isfinite(ratio))
    else:
        filled = np.nan_to_num(ratio, nan=0.0)
        top = np.zeros(len(ratio), dtype=bool)
        top[1:-1] = (filled[1:-1] > filled[:-2]) & (filled[1:-1] >= filled[2:])
        candidates = np.flatnonzero(allowed & top)
    if not len(candidates):
        return None
    if definition.peak == "first-local-maximum":
        return int(candidates[0])
    return int(candidates[np.argmax(ratio[candidates])])
