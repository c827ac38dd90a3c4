"""Pin on disk: mean COF of the steady window, COF against speed, radius of the pin."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError
from underfoot.core.remark import NOTHING, Message

from ..recording.measurement import RATIOS, TOO_FEW, Flag, Measurement, caution
from ..recording.signals import runs
from ..recording.trial import Channel, Trial
from .slip_friction import speed_channel

BATCH = 5
_LATEST = 0.5
RULE = Message("MSER-5: run-in cut where the standard error of the rest is smallest (White 1997)")


@dataclass(frozen=True, slots=True)
class SteadyWindow:
    """Samples ``start`` to ``stop`` (excluded); ``steady`` is False when no run-in end is seen."""

    start: int
    stop: int
    steady: bool
    drift: float
    rule: Message


def steady_window(values: np.ndarray) -> SteadyWindow:
    """Return the part of a record after its run-in.

    Batch means of five samples; the first d of them are cut for the d that makes
    sum((x - mean)^2) / (n - d)^2 smallest. ``drift`` is the change of a straight line over the
    window in units of the scatter about it; a cut at half of the record, or a drift above 2,
    means that the record never became steady.

    DataError: fewer than 50 samples, or samples without a number.

    Source: K. P. White, Simulation 69 (1997) 323.
    """
    values = np.asarray(values, dtype=float)
    if len(values) < 10 * BATCH:
        raise DataError(
            Message("{count} samples", count=len(values)),
            where="steady window",
            allowed="50 or more",
        )
    if not np.isfinite(values).all():
        raise DataError("samples without a number", where="steady window")
    count = len(values) // BATCH
    means = values[: count * BATCH].reshape(count, BATCH).mean(axis=1)
    # Sums from the end give the variance of every possible rest at once.
    rest = np.arange(count, 0, -1)
    total = np.cumsum(means[::-1])[::-1]
    squares = np.cumsum((means[::-1] - means.mean()) ** 2)[::-1]
    spread = np.maximum(squares - (total - rest * means.mean()) ** 2 / rest, 0.0)
    latest = int(_LATEST * count)
    cut = int(np.argmin(spread[: latest + 1] / rest[: latest + 1] ** 2))
    start = cut * BATCH
    window = values[start:]
    x = np.linspace(-0.5, 0.5, len(window))
    slope = float(x @ (window - window.mean()) / (x @ x))
    scatter = float(np.std(window - window.mean() - slope * x))
    drift = abs(slope) / scatter if scatter > 0 else (np.inf if slope else 0.0)
    return SteadyWindow(start, len(values), cut < latest and drift <= 2.0, float(drift), RULE)


def correlated_error(values: np.ndarray) -> float | None:
    """Return the standard error of the mean of a correlated signal, from batch means.

    Twenty batches (or fewer of at least ten samples): their means scatter as the mean does.
    None with fewer than four batches.
    """
    batches = min(20, len(values) // 10)
    if batches < 4:
        return None
    size = len(values) // batches
    means = np.asarray(values[: batches * size]).reshape(batches, size).mean(axis=1)
    return float(means.std(ddof=1) / np.sqrt(batches))


NORMAL = (
    "normal force", "normal", "load", "fz", "fn", "force z", "daq.fz", "normalkraft", "last",
    "auflast", "normal load",
)  # fmt: skip
SHEAR = (
    "friction force", "shear force", "shear", "friction", "ff", "fx", "force x", "ft", "daq.fx",
    "reibkraft", "reibungskraft",
)  # fmt: skip
COF = (
    "cof", "friction coefficient", "traction coeff", "traction coefficient", "daq.cof", "µ", "mu",
    "reibwert", "reibungszahl",
)  # fmt: skip
_LIFTED = 0.1  # share of the load below which the pin has left the disk
_LONG = 30, 0.5  # samples and s that an unloaded stretch needs to be a zero
_KEPT = 0.2, 0.8  # part of such a stretch, away from where the pin touches and leaves
_STROKE = 0.25, 0.75  # part of a stroke, away from where it turns
_STROKES = Message("the middle half of each, in both directions")
_FEWEST_TURNS = 4
_LONGEST_REST = 0.45  # of the time: the middle half between rests slides
_OTHER_COF = 0.1  # relative; a log's COF that no filter of the machine makes of its forces
_REGULAR = 0.2  # relative scatter of the strokes of a machine


@dataclass(frozen=True, slots=True)
class FrictionPoint:
    """Mean COF of one run, with what a figure needs.

    ``cof``: mean COF of the window; its uncertainty is the standard error of a correlated signal.
    ``speed``: mean sliding speed in the window (m/s), or None. ``normal`` and ``shear``: mean
    forces in the window (N); None when the file holds only the COF. ``time`` and ``ratio``: shape
    (n,): the whole run. ``window``: (begin, end) in s.
    """

    trial: str
    cof: Measurement
    speed: float | None
    normal: float | None
    shear: float | None
    time: np.ndarray
    ratio: np.ndarray
    window: tuple[float, float]


def friction_point(
    trial: Trial, *, window: tuple[float, float] | None = None, speed: float | None = None
) -> FrictionPoint:
    """Return the mean COF of a pin-on-disk run.

    COF is the mean over the window of |shear| / |normal|, sample by sample; samples at which the
    pin has left the disk (below a tenth of the load) are left out. Where it stays off the disk for
    half a second, both forces have their zero: a line between the zeros before and after the load,
    the nearest one where there is one only; its error counts in the uncertainty. Of a pin that goes
    to and fro the middle half of each stroke counts: at the turning points nothing slides. Without
    forces the file's own COF column is used, and said.

    ``window``: (begin, end) in s; by default the steady part is found (see ``steady_window``).
    ``speed``: sliding speed (m/s) when the file has no such column.

    DataError: neither forces nor a COF column, no load, or nothing left in the window.
    """
    ratio, normal, shear, channel, choices, flags, zero_error = _ratio(trial)
    time = channel.time
    finite = np.isfinite(ratio)
    if window is None:
        if not finite.any():
            raise DataError("the run holds no COF", where=trial.name)
        steady = steady_window(ratio[finite])
        used = np.flatnonzero(finite)[steady.start : steady.stop]
        choices["window"] = steady.rule
        if not steady.steady:
            flags.append(
                caution("not steady: drifts by {times:.1f} times its scatter", times=steady.drift)
            )
    else:
        used = np.flatnonzero(finite & (time >= window[0]) & (time < window[1]))
        choices["window"] = Message("{begin:g} to {end:g} s, given", begin=window[0], end=window[1])
    if len(used) < 2:
        raise DataError("no samples in the window", where=trial.name)
    values = ratio[used]
    error = correlated_error(values)
    if values.mean() > 2.0:
        flags.append(caution("a COF above 2: are the force columns or units right?"))
    if normal is not None and (apart := _other_cof(trial, used)) is not None:
        flags.append(
            caution(
                "the log's own COF is {logged:.3g} where its forces give {forces:.3g}: which unit?",
                logged=apart[0],
                forces=apart[1],
            )
        )
    choices["average"] = RATIOS
    choices["uncertainty"] = Message("standard error of the mean from batch means")
    reason = TOO_FEW if error is None else NOTHING
    mean = float(values.mean())
    if error is not None and normal is not None and zero_error is not None:
        load = float(np.abs(normal[used]).mean())
        from_zero = float(np.hypot(zero_error[0], mean * zero_error[1])) / load
        error = float(np.hypot(error, from_zero))
        choices["uncertainty"] = Message(
            "{scatter}, and {zero:.2g} of the zero", scatter=choices["uncertainty"], zero=from_zero
        )
    measurement = Measurement("cof", mean, "1", error, reason, len(values), tuple(flags), choices)
    speed = _mean_speed(trial, used) if speed is None else speed
    forces = normal, shear
    load, push = (None if f is None else float(np.abs(f[used]).mean()) for f in forces)
    ends = float(time[used[0]]), float(time[used[-1]])
    return FrictionPoint(trial.name, measurement, speed, load, push, time, ratio, ends)


@dataclass(frozen=True, slots=True)
class ProfileRadius:
    """Reduced radius R' (m) of a pin from its profile, with its standard error."""

    radius: float
    standard_error: float
    curvature: float
    residual_rms: float


def reduced_radius(position: ArrayLike, height: ArrayLike) -> ProfileRadius:
    """Return R' = 1 / (2 B) of h(r) = B r^2 (Eq. 19, 20).

    The vertex and a tilt are fitted too (h = h0 + s x + B x^2): a profile is never recorded
    exactly from its vertex. B counts positive whichever way the instrument counts heights.

    ``position`` and ``height``: shape (n,), m.

    DataError: fewer than ten points, missing values, or no curvature within two standard errors.
    """
    x, h = np.asarray(position, dtype=float), np.asarray(height, dtype=float)
    if x.shape != h.shape or len(x) < 10 or not (np.isfinite(x).all() and np.isfinite(h).all()):
        raise DataError("a profile needs ten complete points", where="reduced_radius")
    scale = float(np.ptp(x)) or 1.0
    u = (x - x.mean()) / scale
    matrix = np.column_stack((np.ones_like(u), u, u**2))
    solution, _, rank, _ = np.linalg.lstsq(matrix, h, rcond=None)
    if rank < 3:
        raise DataError("the positions do not vary", where="reduced_radius")
    residual = h - matrix @ solution
    variance = float(residual @ residual) / (len(x) - 3)
    error = float(np.sqrt(np.linalg.inv(matrix.T @ matrix)[2, 2] * variance)) / scale**2
    curvature = abs(float(solution[2])) / scale**2
    if curvature <= 2.0 * error:
        raise DataError(
            "the profile shows no curvature beyond its scatter",
            where="reduced_radius",
            remedy="Scan a longer profile, or treat the pin as flat",
        )
    radius = 1.0 / (2.0 * curvature)
    return ProfileRadius(radius, radius * error / curvature, curvature, float(residual.std()))


def _ratio(
    trial: Trial,
) -> tuple[
    np.ndarray,
    np.ndarray | None,
    np.ndarray | None,
    Channel,
    dict[str, Message],
    list[Flag],
    tuple[float, float] | None,
]:
    """Return the COF of every sample, both forces, their channel, choices, flags, the zero's error.

    The last holds what the zeros of shear and normal force are known to (N), None without a zero.
    """
    try:
        normal, shear = trial.channel(*NORMAL), trial.channel(*SHEAR)
    except DataError as problem:
        channel = _channel(trial, COF)
        if channel is None:
            raise problem from None
        choices, values = {"cof": Message("column of the file")}, channel.values.astype(float)
        size = np.abs(values)
        away = [
            (a, b)
            for a, b in _unloaded_stretches(size, channel.rate)
            if size[a:b].max() < _LIFTED * np.nanpercentile(size, 99)
        ]
        for start, stop in away:
            values[start:stop] = np.nan
        if away:
            choices["unloaded"] = Message(
                "{count} samples without friction left out", count=sum(b - a for a, b in away)
            )
        ratio = np.abs(values)
        if (strokes := _strokes(values, zeroed=False)) is not None:
            choices["strokes"] = _STROKES
            ratio = np.where(strokes[0], np.abs(values - strokes[1]), np.nan)
        return ratio, None, None, channel, choices, [], None
    if len(normal.values) != len(shear.values):
        raise DataError("normal and shear force differ in length", where=trial.name)
    choices, flags = {"cof": Message("|shear| / |normal|")}, []
    load, push, zero_error = normal.values, shear.values, None
    stretches = _unloaded_stretches(load, normal.rate)
    if stretches:
        time = normal.time
        zeros = [_zero_line(values, time, stretches) for values in (push, load)]
        (push_zero, push_error), (load_zero, load_error) = zeros
        push, load, zero_error = push - push_zero, load - load_zero, (push_error, load_error)
        choices["zero"] = Message(
            "of the unloaded pin ({parts: and }): {size:.3g} {unit} of shear",
            parts=[
                Message("{begin:.3g} to {end:.3g} s", begin=time[a], end=time[b - 1])
                for a, b in stretches[:4]
            ],
            size=np.nanmean(push_zero),
            unit=shear.unit,
        )
    size = np.abs(load)
    loaded = np.isfinite(size)
    for start, stop in stretches:
        loaded[start:stop] = False
    level = float(np.median(size[loaded])) if loaded.any() else 0.0
    if not level > 0:
        raise DataError("the normal force is zero", where=trial.name)
    pressed = size > _LIFTED * level
    strokes = _strokes(np.where(pressed, push, np.nan), zeroed=zero_error is not None)
    if strokes is not None:
        sliding, middle = strokes
        if zero_error is None:
            push = push - middle
        choices["strokes"] = _STROKES
        ratio = np.where(pressed & sliding, np.abs(push) / np.where(pressed, size, 1.0), np.nan)
    else:
        ratio = np.where(pressed, np.abs(push) / np.where(pressed, size, 1.0), np.nan)
    lifted = ~pressed
    for start, stop in stretches:
        lifted[start:stop] = False
    inside = np.flatnonzero(pressed)
    if lost := int(lifted[inside[0] : inside[-1]].sum()):
        flags.append(caution("{count} samples with hardly any load left out", count=lost))
    if normal.unit != shear.unit:
        flags.append(
            caution(
                'units differ: normal "{normal}", shear "{shear}"',
                normal=normal.unit,
                shear=shear.unit,
            )
        )
    return ratio, load, push, normal, choices, flags, zero_error


def _unloaded_stretches(load: np.ndarray, rate: float) -> list[tuple[int, int]]:
    """Return (start, stop) of the stretches in which the pin was off the disk for long enough.

    The record has two levels of load, or it was never unloaded. Of the two the unloaded one is
    nearer to zero: a channel's own zero is small against the load.
    """
    finite = load[np.isfinite(load)]
    if len(finite) < 4 * _LONG[0]:
        return []
    low, high = np.percentile(finite, (1, 99))
    if not high > low:
        return []
    middle = 0.5 * (low + high)
    levels = [float(np.median(finite[side])) for side in (finite < middle, finite >= middle)]
    spreads = [
        1.4826 * float(np.median(np.abs(finite[side] - level)))
        for side, level in zip((finite < middle, finite >= middle), levels, strict=True)
    ]
    empty, full = sorted(levels, key=abs)
    if abs(full - empty) < max(0.6 * abs(full), 10.0 * max(spreads)):
        return []
    off = np.abs(load - empty) < _LIFTED * abs(full - empty)
    fewest = max(_LONG[0], round(_LONG[1] * rate))
    return [(a, b) for a, b in runs(off) if b - a >= fewest]


def _zero_line(
    values: np.ndarray, time: np.ndarray, stretches: list[tuple[int, int]]
) -> tuple[np.ndarray, float]:
    """Return the zero of a channel against time (n,), and its standard uncertainty.

    The mean of each unloaded stretch, straight lines between. Its error is that of the means and
    the scatter of a zero that may go from one to the next at any time.
    """
    means, errors, times = [], [], []
    for start, stop in stretches:
        a, b = (start + round(share * (stop - start)) for share in _KEPT)
        part = values[a:b][np.isfinite(values[a:b])]
        if not len(part):
            continue
        means.append(float(part.mean()))
        spread = float(part.std()) / np.sqrt(len(part))
        errors.append(max(correlated_error(part) or 0.0, spread))
        times.append(float(time[a:b].mean()))
    if not means:
        return np.zeros(len(values)), 0.0
    wander = np.abs(np.diff(means)).max(initial=0.0) / np.sqrt(12.0)
    return np.interp(time, times, means), float(np.hypot(max(errors), wander))


def _strokes(push: np.ndarray, *, zeroed: bool) -> tuple[np.ndarray, float] | None:
    """Return the samples (n,) in the middle of strokes, and the mean of both directions (N).

    ``push``: friction (n,), NaN without load. ``zeroed``: its zero is known. None where the pin
    neither goes to and fro nor rests between strokes: then the friction neither changes its sign at
    even times nor falls to nothing at even times.
    """
    seen = np.flatnonzero(np.isfinite(push))
    if len(seen) < 40:
        return None
    values = push[seen]
    low, high = np.percentile(values, (10, 90))
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    both = np.mean(np.abs(np.abs(values - middle) - half) < 0.5 * half) > 0.7 and half > 0
    # one level at zero is a pin that rests between its strokes
    both &= abs(middle) < 0.5 * half if zeroed else abs(abs(middle) - half) > _LIFTED * half
    turns = _changes(values - middle, 0.3 * half) if both else np.zeros(0, dtype=int)
    if not _even(turns):
        size = np.abs(values)
        usual = float(np.percentile(size, 75))
        turns, middle = (
            np.array([(a + b) // 2 for a, b in runs(size < 0.5 * usual)], dtype=int),
            0.0,
        )
        narrow = np.mean(size < 0.5 * usual) < _LONGEST_REST
        deep = all(size[max(t - 2, 0) : t + 3].min() < 0.3 * usual for t in turns)
        if not (_even(turns) and narrow and deep):
            return None
    sliding = np.zeros(len(push), dtype=bool)
    for start, stop in pairwise(turns):
        a, b = (start + round(share * (stop - start)) for share in _STROKE)
        sliding[seen[a : b + 1]] = True
    return sliding, float(middle)


def _changes(values: np.ndarray, limit: float) -> np.ndarray:
    """Indices at which values (n,) go from below -limit to above limit, or back."""
    sides = np.flatnonzero(np.abs(values) > limit)
    at = np.flatnonzero(np.diff(np.sign(values[sides])))
    return (sides[at] + sides[at + 1]) // 2


def _even(turns: np.ndarray) -> bool:
    gaps = np.diff(turns)
    return len(turns) >= _FEWEST_TURNS and bool(gaps.std() < _REGULAR * gaps.mean() + 1.0)


def _channel(trial: Trial, names: tuple[str, ...]) -> Channel | None:
    try:
        return trial.channel(*names)
    except DataError:
        return None


def _other_cof(trial: Trial, used: np.ndarray) -> tuple[float, float] | None:
    """Return the median COF that a log holds and that of its forces as read, where they differ."""
    logged = _channel(trial, COF)
    if logged is None or len(logged.values) <= used[-1]:
        return None
    normal, shear = (trial.channel(*names).values[used] for names in (NORMAL, SHEAR))
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.abs(logged.values[used]), np.abs(shear / normal)
    middle = [float(np.nanmedian(values)) for values in both]
    differ = abs(middle[0] - middle[1]) > _OTHER_COF * max(middle)
    return (middle[0], middle[1]) if differ else None


def _mean_speed(trial: Trial, used: np.ndarray) -> float | None:
    channel = speed_channel(trial)
    if channel is None or channel.unit != "m/s":
        return None
    values = channel.values[used[used < len(channel.values)]]
    return float(np.nanmean(np.abs(values))) if len(values) else None
