"""Required friction of a step and available friction of a loaded slide, every convention named."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from underfoot.core import DataError, InputError, unknown_name

from .axes import Axes, axes_of
from .events import Stance, body_mass, stances
from .filters import FORCE_FILTER, LowPass, low_passed
from .measurement import Measurement
from .trial import Plate, Trial

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
ACOF_WINDOWS = (0.002, 0.05, 0.1, 0.2)  # s


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


def mean_of(measurements: Sequence[Measurement], name: str | None = None) -> Measurement:
    """Return the mean of several measurements with its standard error, sd / sqrt(n).

    Those without a value are left out and counted in a flag. Conventions must agree.

    Errors
    ------
    InputError
        Nothing given, or different units or conventions.
    """
    if not measurements:
        raise InputError("nothing to average", where="mean_of")
    first = measurements[0]
    ignored = ("baseline", "walking direction")
    kept = {k: v for k, v in first.conventions.items() if k not in ignored}
    for other in measurements:
        theirs = {k: v for k, v in other.conventions.items() if k not in ignored}
        if other.unit != first.unit or theirs != kept:
            raise InputError("measurements of different conventions can't be averaged")
    values = np.array([m.value for m in measurements if m.value is not None])
    name = name or first.name
    lost = len(measurements) - len(values)
    flags = (f"{lost} of {len(measurements)} without a value are left out",) if lost else ()
    if not len(values):
        return Measurement.not_estimated(
            name, first.reason, unit=first.unit, flags=flags, conventions=kept
        )
    deviation = float(values.std(ddof=1) / math.sqrt(len(values))) if len(values) > 1 else None
    return Measurement(
        name,
        float(values.mean()),
        first.unit,
        deviation,
        "" if deviation is not None else "a single value has no scatter",
        len(values),
        flags,
        {**kept, "uncertainty": "standard error of the mean"},
    )


def mean_friction(
    normal: np.ndarray,
    shear: np.ndarray,
    rate: float,
    *,
    target: float,
    window: float = 0.2,
    name: str = "acof",
) -> Measurement:
    """Return the mean of shear over normal force in a window after the target force is reached.

    ``mean(shear / normal)`` over ``window`` seconds from the first sample at which ``normal``
    reaches ``target``. The uncertainty is the standard error with the number of samples lowered
    for their correlation, n (1 - r) / (1 + r) with r the correlation of neighbours.

    Parameters
    ----------
    normal, shear
        Shape (n,), N; the shear as a resultant (not negative).
    rate
        Samples per second.
    target
        Normal force that opens the window (N).
    window
        Length (s): 0.2 in the grant report (G.6.1); 0.05 is enough by Iraqi et al. (PMC6922306).
    """
    normal, shear = np.asarray(normal, dtype=float), np.asarray(shear, dtype=float)
    said = {
        "window": f"{1e3 * window:g} ms from the first sample at or above {target:g} N",
        "average": "mean of the ratios of the samples",
    }
    if normal.shape != shear.shape or not target > 0 or not window > 0:
        raise InputError("normal and shear must match; target and window be positive", where=name)
    reached = np.flatnonzero(normal >= target)
    if not len(reached):
        top = float(np.nanmax(normal, initial=0.0))
        return Measurement.not_estimated(
            name, f"the normal force reaches {top:.0f} N, not {target:g} N", conventions=said
        )
    start = int(reached[0])
    count = max(1, round(window * rate))
    if start + count > len(normal):
        return Measurement.not_estimated(
            name, "the recording ends inside the window", conventions=said
        )
    part, across = normal[start : start + count], shear[start : start + count]
    if not (np.isfinite(part).all() and np.isfinite(across).all()):
        return Measurement.not_estimated(
            name, "samples without a number inside the window", conventions=said
        )
    if part.min() < 0.2 * target:
        return Measurement.not_estimated(
            name, f"the normal force falls to {part.min():.0f} N in the window", conventions=said
        )
    ratio = across / part
    flags = ()
    if part.min() < 0.9 * target:
        flags = (f"the normal force falls to {part.min():.0f} N in the window",)
    error = _standard_error(ratio)
    return Measurement(
        name,
        float(ratio.mean()),
        uncertainty=error,
        reason="" if error is not None else "too few samples for a scatter",
        n=count,
        flags=flags,
        conventions=said,
    )


def available_friction(
    plate: Plate,
    *,
    target: float,
    window: float = 0.2,
    up: np.ndarray | None = None,
    low_pass: LowPass | None = None,
) -> Measurement:
    """Return the available friction (ACOF) of a loaded slide over a force plate.

    Resultant shear over normal force, see ``mean_friction``. Not filtered unless ``low_pass``
    is given: the average does that.

    Parameters
    ----------
    up
        Unit vector out of the floor, lab axes; by default the plate's normal, or z.
    """
    if not plate.usable:
        return Measurement.not_estimated("acof", plate.problem or "the plate has no samples")
    if up is None:
        up = axes_of(Trial("", plates=(plate,))).up
    force = plate.force
    words = "no filter"
    if low_pass is not None:
        words = str(low_pass)
        try:
            force = low_passed(force, plate.rate, low_pass)
        except DataError as error:
            return Measurement.not_estimated("acof", error.what)
    normal = force @ up
    shear = np.linalg.norm(force - np.outer(normal, up), axis=1)
    found = mean_friction(normal, shear, plate.rate, target=target, window=window)
    said = {
        **found.conventions,
        "shear": SHEARS["resultant"],
        "filter": words,
        "baseline": baseline_words(plate),
    }
    return replace(found, conventions=said)


def available_frictions(
    plate: Plate, *, target: float, windows: Sequence[float] = ACOF_WINDOWS
) -> list[Measurement]:
    """Return the available friction in several windows (2, 50, 100 and 200 ms by default)."""
    return [available_friction(plate, target=target, window=window) for window in windows]


def plate_named(trial: Trial, name: str) -> Plate:
    """Return the plate called ``name``.

    Errors
    ------
    DataError
        There is none.
    """
    for plate in trial.plates:
        if plate.name == name:
            return plate
    raise DataError(
        f"no plate named {name}",
        where=trial.name,
        allowed=", ".join(p.name for p in trial.plates) or "the trial has no plates",
    )


def baseline_words(plate: Plate) -> str:
    """Return what was done about a plate's baseline."""
    if plate.baseline is None:
        return "not subtracted"
    size = ", ".join(f"{component:.1f}" for component in plate.baseline)
    return f"mean of {plate.baseline_samples} unloaded samples subtracted ({size} N)"


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


def _standard_error(values: np.ndarray) -> float | None:
    if len(values) < 4:
        return None
    deviation = values - values.mean()
    power = float(deviation @ deviation)
    if power == 0.0:
        return 0.0
    correlation = float(np.clip(deviation[1:] @ deviation[:-1] / power, 0.0, 0.99))
    independent = max(2.0, len(values) * (1.0 - correlation) / (1.0 + correlation))
    return float(math.sqrt(power / (len(values) - 1) / independent))
