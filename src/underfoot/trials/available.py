"""Available friction (ACOF) of a loaded slide over a force plate."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from underfoot.core import DataError, InputError

from .axes import axes_of
from .filters import LowPass, low_passed
from .gait import SHEARS
from .measurement import Measurement, caution
from .plates import baseline_words
from .trial import Plate, Trial

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
    said = {
        "window": f"{1e3 * window:g} ms from the first sample at or above {target:g} N",
        "average": "mean of the ratios of the samples",
    }
    if normal.shape != shear.shape or not target > 0 or not window > 0:
        raise InputError("normal and shear must match; target and window be positive", where=name)

    def without(reason: str) -> Measurement:
        return Measurement.not_estimated(name, reason, conventions=said)

    reached = np.flatnonzero(normal >= target)
    if not len(reached):
        top = float(np.nanmax(normal, initial=0.0))
        return without(f"the normal force reaches {top:.0f} N, not {target:g} N")
    start = int(reached[0])
    count = max(1, round(window * rate))
    if start + count > len(normal):
        return without("the recording ends inside the window")
    part, across = normal[start : start + count], shear[start : start + count]
    if not (np.isfinite(part).all() and np.isfinite(across).all()):
        return without("samples without a number inside the window")
    falls = f"the normal force falls to {part.min():.0f} N in the window"
    if part.min() < 0.2 * target:
        return without(falls)
    ratio = across / part
    flags = (caution(falls),) if part.min() < 0.9 * target else ()
    error = _standard_error(ratio)
    reason = "" if error is not None else "too few samples for a scatter"
    value = float(ratio.mean())
    return Measurement(name, value, "1", error, reason, count, flags, said)


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
    said = {"shear": SHEARS["resultant"], "filter": words, "baseline": baseline_words(plate)}
    return replace(found, conventions={**found.conventions, **said})


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
