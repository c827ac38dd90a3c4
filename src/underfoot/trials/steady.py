"""The steady part of a noisy record, and the mean of a correlated signal with its error."""

from dataclasses import dataclass

import numpy as np

from underfoot.core import DataError

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
