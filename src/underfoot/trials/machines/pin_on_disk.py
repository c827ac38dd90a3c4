"""Pin on disk: mean COF of the steady window, COF against speed, radius of the pin."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError

from ..recording.measurement import Measurement, caution
from ..recording.trial import Channel, Trial

BATCH = 5
_LATEST = 0.5
RULE = "MSER-5: run-in cut where the standard error of the rest is smallest (White 1997)"


@dataclass(frozen=True, slots=True)
class SteadyWindow:
    """Samples ``start`` to ``stop`` (excluded); ``steady`` is False when no run-in end is seen."""

    start: int
    stop: int
    steady: bool
    drift: float
    rule: str


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
        raise DataError(f"{len(values)} samples", where="steady window", allowed="50 or more")
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


NORMAL = ("normal force", "normal", "load", "fz", "fn", "force z")
SHEAR = ("friction force", "shear force", "shear", "friction", "ff", "fx", "force x", "ft")
SPEED = ("sliding speed", "speed", "velocity")
COF = ("cof", "friction coefficient", "traction coeff", "traction coefficient")
_LIFTED = 0.1  # share of the median load below which the pin has left the disk


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
    pin has left the disk (below a tenth of the median load) are left out and counted. Without
    forces the file's own COF column is used, and said.

    ``window``: (begin, end) in s; by default the steady part is found (see ``steady_window``).
    ``speed``: sliding speed (m/s) when the file has no such column.

    DataError: neither forces nor a COF column, no load, or nothing left in the window.
    """
    ratio, normal, shear, channel, choices, flags = _ratio(trial)
    time = channel.time
    finite = np.isfinite(ratio)
    if window is None:
        if not finite.any():
            raise DataError("the run holds no COF", where=trial.name)
        steady = steady_window(ratio[finite])
        used = np.flatnonzero(finite)[steady.start : steady.stop]
        choices["window"] = steady.rule
        if not steady.steady:
            flags.append(f"not steady: drifts by {steady.drift:.1f} times its scatter")
    else:
        used = np.flatnonzero(finite & (time >= window[0]) & (time < window[1]))
        choices["window"] = f"{window[0]:g} to {window[1]:g} s, given"
    if len(used) < 2:
        raise DataError("no samples in the window", where=trial.name)
    values = ratio[used]
    error = correlated_error(values)
    if values.mean() > 2.0:
        flags.append("a COF above 2: are the force columns or units right?")
    choices["average"] = "mean of the ratios of the samples"
    choices["uncertainty"] = "standard error of the mean from batch means"
    reason = "" if error is not None else "too few samples for a scatter"
    mean, seen = float(values.mean()), tuple(map(caution, flags))
    measurement = Measurement("cof", mean, "1", error, reason, len(values), seen, choices)
    speed = _speed(trial, used) if speed is None else speed
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
) -> tuple[np.ndarray, np.ndarray | None, np.ndarray | None, Channel, dict[str, str], list[str]]:
    try:
        normal, shear = trial.channel(*NORMAL), trial.channel(*SHEAR)
    except DataError as problem:
        channel = _channel(trial, COF)
        if channel is None:
            raise problem from None
        return np.abs(channel.values), None, None, channel, {"cof": "column of the file"}, []
    if len(normal.values) != len(shear.values):
        raise DataError("normal and shear force differ in length", where=trial.name)
    load = np.abs(normal.values)
    level = float(np.nanmedian(load))
    if not level > 0:
        raise DataError("the normal force is zero", where=trial.name)
    pressed = load > _LIFTED * level
    ratio = np.where(pressed, np.abs(shear.values) / np.where(pressed, load, 1.0), np.nan)
    flags = []
    lifted = int((~pressed).sum())
    if lifted:
        flags.append(f"{lifted} samples with hardly any load left out")
    if normal.unit != shear.unit:
        flags.append(f'units differ: normal "{normal.unit}", shear "{shear.unit}"')
    return ratio, normal.values, shear.values, normal, {"cof": "|shear| / |normal|"}, flags


def _channel(trial: Trial, names: tuple[str, ...]) -> Channel | None:
    try:
        return trial.channel(*names)
    except DataError:
        return None


def _speed(trial: Trial, used: np.ndarray) -> float | None:
    channel = _channel(trial, SPEED)
    if channel is None or channel.unit != "m/s":
        return None
    values = channel.values[used[used < len(channel.values)]]
    return float(np.nanmean(np.abs(values))) if len(values) else None
