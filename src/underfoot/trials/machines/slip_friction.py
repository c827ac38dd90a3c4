"""Friction of loaded slides: available friction over a force plate, COF of a slip tester."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from underfoot.core import DataError, InputError, unknown_name
from underfoot.core.remark import NOTHING, Message

from ..recording.axes import Axes, axes_of
from ..recording.measurement import RATIOS, TOO_FEW, Measurement, caution
from ..recording.protocols import Protocol
from ..recording.signals import FILTERS, LowPass, low_passed, runs
from ..recording.tester_calibration import TesterCalibration
from ..recording.trial import Channel, Plate, Trial
from ..walking.gait import SHEARS

ACOF_WINDOWS = (0.002, 0.05, 0.1, 0.2)  # s


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

    ``normal`` and ``shear``: shape (n,), N; the shear as a resultant (not negative). ``rate``:
    samples per second. ``target``: normal force that opens the window (N). ``window``: length (s):
    0.2 in the grant report (G.6.1); 0.05 is enough by Iraqi et al. (PMC6922306).
    """
    normal, shear = np.asarray(normal, dtype=float), np.asarray(shear, dtype=float)
    choices = {
        "window": Message(
            "{window:g} ms from the first sample at or above {target:g} N",
            window=1e3 * window,
            target=target,
        ),
        "average": RATIOS,
    }
    if normal.shape != shear.shape or not target > 0 or not window > 0:
        raise InputError("normal and shear must match; target and window be positive", where=name)

    def without(reason: Message) -> Measurement:
        return Measurement.not_estimated(name, reason, conventions=choices)

    reached = np.flatnonzero(normal >= target)
    if not len(reached):
        top = float(np.nanmax(normal, initial=0.0))
        return without(
            Message(
                "the normal force reaches {top:.0f} N, not {target:g} N", top=top, target=target
            )
        )
    start = int(reached[0])
    count = max(1, round(window * rate))
    if start + count > len(normal):
        return without(Message("the recording ends inside the window"))
    part, across = normal[start : start + count], shear[start : start + count]
    if not (np.isfinite(part).all() and np.isfinite(across).all()):
        return without(Message("samples without a number inside the window"))
    fallen = caution("the normal force falls to {force:.0f} N in the window", force=part.min())
    if part.min() < 0.2 * target:
        return without(fallen.message)
    ratio = across / part
    flags = (fallen,) if part.min() < 0.9 * target else ()
    error = _standard_error(ratio)
    reason = TOO_FEW if error is None else NOTHING
    value = float(ratio.mean())
    return Measurement(name, value, "1", error, reason, count, flags, choices)


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

    ``up``: unit vector out of the floor, lab axes; by default the plate's normal, or z.
    """
    if not plate.usable:
        why = Message.plain(plate.problem) if plate.problem else Message("the plate has no samples")
        return Measurement.not_estimated("acof", why)
    if up is None:
        up = axes_of(Trial("", plates=(plate,))).up
    force = plate.force
    choices = {
        "shear": SHEARS["resultant"],
        "filter": (low_pass or LowPass("none")).description,
        "baseline": plate.baseline_text,
    }
    if low_pass is not None:
        try:
            force = low_passed(force, plate.rate, low_pass)
        except DataError as error:
            return Measurement.not_estimated("acof", Message.plain(error.what))
    normal = force @ up
    shear = np.linalg.norm(force - np.outer(normal, up), axis=1)
    cof = mean_friction(normal, shear, plate.rate, target=target, window=window)
    return replace(cof, conventions={**cof.conventions, **choices})


def available_frictions(
    plate: Plate, *, target: float, windows: Sequence[float] = ACOF_WINDOWS
) -> list[Measurement]:
    """Return the available friction in several windows (2, 50, 100 and 200 ms by default)."""
    return [available_friction(plate, target=target, window=window) for window in windows]


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


SPEED = ("sliding speed", "speed", "velocity", "max linear speed", "geschwindigkeit",
         "gleitgeschwindigkeit")  # fmt: skip
_MOVING = 0.05  # share of the top speed above which the shoe slides
_TOUCHING = 50.0  # N
_ONSET = 0.5  # share of the later friction at which sliding is taken to begin


@dataclass(frozen=True, slots=True)
class SlideFriction:
    """COF of one slide with its curves.

    ``time`` (s), ``normal``, ``shear`` (N) and ``ratio`` have shape (n,); ``window`` is
    (begin, end) in s; ``facts`` maps rule quantities to what was measured (SI). ``onset`` is the
    start of sliding (s), ``speed`` the sliding speed where it is known.
    """

    cof: Measurement
    time: np.ndarray
    normal: np.ndarray
    shear: np.ndarray
    ratio: np.ndarray
    window: tuple[float, float]
    facts: Mapping[str, float]
    onset: float | None = None
    speed: Channel | None = None


def slide_plate(trial: Trial, up: np.ndarray, record: TesterCalibration | None = None) -> Plate:
    """Return the plate of a tester's log, its forces multiplied by the factors on record.

    DataError: no usable force plate.
    """
    plate = next((plate for plate in trial.plates if plate.usable), None)
    if plate is None:
        reasons = "; ".join(p.problem for p in trial.plates) or "the file holds no force plate"
        raise DataError(reasons, where=trial.name, remedy="Name the force columns in a profile")
    if record is None:
        return plate
    normal = np.outer(plate.force @ up, up)
    factors = (record.channel(name).factor for name in ("normal", "friction"))
    return replace(plate, force=next(factors) * normal + next(factors) * (plate.force - normal))


UNCALIBRATED = Message("no record: the tester's gain is not in the uncertainty")
"""Convention of a COF whose tester has no calibration record."""


def apply_calibration(cof: Measurement, record: TesterCalibration | None) -> Measurement:
    """Return a COF with the calibration it refers to, and its uncertainty added."""
    if record is None:
        return replace(cof, conventions={**cof.conventions, "calibration": UNCALIBRATED})
    choices = {**cof.conventions, "calibration": record.description()}
    error = None
    if cof.value is not None and cof.uncertainty is not None:
        parts = (record.channel(name).uncertainty for name in ("normal", "friction"))
        error = math.hypot(cof.uncertainty, *(cof.value * part for part in parts))
    return replace(cof, uncertainty=error, conventions=choices)


def slide_friction(
    trial: Trial,
    protocol: Protocol,
    axes: Axes | None = None,
    record: TesterCalibration | None = None,
) -> SlideFriction:
    """Return the mean COF of a slide in the window its protocol sets.

    ``window_from = "force"``: from the first sample at the target force (grant report G.6);
    ``"sliding"``: from the start of sliding, seen in a speed channel, else in a marker's path,
    else in the rise of the shear force (half of its later level). Forces are those of the log times
    the factors of the calibration ``record``.

    DataError: no usable force plate, no load, or no sliding.
    """
    up = (axes or axes_of(trial)).up
    plate = slide_plate(trial, up, record)
    normal = plate.force @ up
    shear = np.linalg.norm(plate.force - np.outer(normal, up), axis=1)
    if not np.nanmax(normal, initial=0.0) > _TOUCHING:
        raise DataError("the shoe is never pressed on the plate", where=trial.name)
    ratio = np.where(normal > 20.0, shear / np.maximum(normal, 20.0), np.nan)
    facts: dict[str, float] = {}
    begin_after = protocol.number("window_begin", "s")
    length = protocol.number("window_end", "s") - begin_after
    onset, how, speed = _sliding(trial, plate, normal, shear)
    logged = speed_channel(trial)
    flags = (
        (caution("the log's speed has no known unit of speed: it is not used"),)
        if logged is not None and logged.unit != "m/s"
        else ()
    )
    kind = protocol.text("window_from", "sliding")
    if kind == "force":
        target = protocol.number("target_force", "N")
        cof = available_friction(plate, target=target, window=length, up=up)
        reached = np.flatnonzero(normal >= target)
        begin = plate.start + (int(reached[0]) if len(reached) else 0) / plate.rate
        cof = replace(cof, name="cof")
    elif kind == "sliding":
        if onset is None:
            raise DataError("the start of sliding is not found", where=trial.name)
        begin = onset + begin_after
        first = max(round((begin - plate.start) * plate.rate), 0)
        part = slice(first, first + max(1, round(length * plate.rate)) + 1)
        level = float(np.nanmedian(normal[part])) if len(normal[part]) else 0.0
        if level < _TOUCHING:
            why = Message("the shoe is not loaded in the window")
            cof = Measurement.not_estimated("cof", why)
        else:
            cof = mean_friction(
                normal[part], shear[part], plate.rate, target=0.5 * level, window=length, name="cof"
            )
        choices = {
            "window": Message(
                "{begin:g} to {end:g} ms after sliding starts",
                begin=1e3 * begin_after,
                end=1e3 * (begin_after + length),
            ),
            "sliding start": how,
            "shear": SHEARS["resultant"],
            "filter": FILTERS["none"],
            "baseline": plate.baseline_text,
        }
        cof = replace(cof, conventions={**cof.conventions, **choices})
    else:
        raise unknown_name("window", kind, ("force", "sliding"), where="method.window_from")
    cof = replace(cof, flags=(*cof.flags, *flags))
    end = begin + length
    inside = (plate.time >= begin) & (plate.time <= end)
    if inside.any():
        facts["normal_force"] = float(np.nanmean(normal[inside]))
    if speed is not None:
        near = (speed.time >= begin) & (speed.time <= end) & np.isfinite(speed.values)
        if near.any():
            facts["sliding_speed"] = float(np.abs(speed.values[near]).mean())
    touched = np.flatnonzero(normal > _TOUCHING)
    if onset is not None and len(touched):
        contact = plate.start + int(touched[0]) / plate.rate
        facts["static_contact_time"] = max(onset - contact, 0.0)
    curves = plate.time, normal, shear, ratio
    return SlideFriction(apply_calibration(cof, record), *curves, (begin, end), facts, onset, speed)


def _sliding(
    trial: Trial, plate: Plate, normal: np.ndarray, shear: np.ndarray
) -> tuple[float | None, Message, Channel | None]:
    """Return the start of sliding (s), how it was found, and the sliding speed if known."""
    speed, how = _speed_source(trial)
    if speed is not None:
        size = np.abs(np.nan_to_num(speed.values))
        top = float(np.percentile(size, 95))
        moving = np.flatnonzero(size > _MOVING * top) if top > 0.01 else np.empty(0, dtype=int)
        loaded = np.interp(speed.time, plate.time, np.nan_to_num(normal)) > _TOUCHING
        moving = moving[loaded[moving]]
        if len(moving):
            return float(speed.time[moving[0]]), how, speed
    # Mean over 10 ms: at a small load or COF the noise alone passes half of the level.
    count = max(1, round(0.01 * plate.rate))
    smooth = np.convolve(np.nan_to_num(shear), np.full(count, 1.0 / count), "same")
    pressed = np.nan_to_num(normal) > max(_TOUCHING, 0.2 * float(np.nanpercentile(normal, 95)))
    ratio = np.where(pressed, smooth / np.maximum(np.nan_to_num(normal), _TOUCHING), 0.0)
    loaded = normal > 0.9 * float(np.nanpercentile(normal, 95))
    level = float(np.median(ratio[loaded])) if loaded.sum() >= 10 else 0.0
    stretches = runs(ratio > _ONSET * level) if level > 0 else []
    if not stretches:
        return None, NOTHING, speed
    start = max(stretches, key=lambda run: run[1] - run[0])[0]
    how = Message("shear (mean over 10 ms) stays above half of its later level")
    return plate.start + start / plate.rate, how, speed


def speed_channel(trial: Trial) -> Channel | None:
    """Return the sliding speed in a log, in whatever unit, or None."""
    try:
        return trial.channel(*SPEED)
    except DataError:
        return None


def _speed_source(trial: Trial) -> tuple[Channel | None, Message]:
    share = 100 * _MOVING
    channel = speed_channel(trial)
    if channel is not None and channel.unit == "m/s":
        return channel, Message("speed channel above {share:g} % of its top", share=share)
    for name, marker in trial.markers.items():
        if marker.missing.any() or marker.times is not None or len(marker.positions) < 40:
            continue
        smooth = low_passed(marker.positions, marker.rate, LowPass(cutoff=20.0))
        velocity = np.linalg.norm(np.gradient(smooth, 1.0 / marker.rate, axis=0), axis=1)
        how = Message(
            "marker {name} (20 Hz) above {share:g} % of its top speed", name=name, share=share
        )
        return Channel(velocity, "m/s", marker.rate, marker.start), how
    return None, NOTHING
