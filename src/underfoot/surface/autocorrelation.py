"""Autocorrelation along a profile or across a map, and the length over which it falls."""

import numpy as np

from underfoot.core import InputError
from underfoot.core.units import metres

from .height_map import HeightMap
from .prepare import levelled
from .profile import Profile


def autocorrelation(
    surface: Profile | HeightMap, *, axis: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """Return (lag in m, autocorrelation) with 1 at lag 0; of a map, the mean over its lines.

    Line or plane are removed from surfaces that are not periodic; their value at a lag is the
    mean over the pairs that exist, up to half the length. Periodic ones are continued.

    Raises:
        InputError: A flat surface.
    """
    z = surface.heights
    if not surface.periodic:
        flat: Profile | HeightMap = levelled(surface)  # type: ignore[type-var]  # a union of both
        z = flat.heights
    z = z - z.mean()
    lines = z[:, None] if z.ndim == 1 else np.moveaxis(z, axis, 0)
    n = lines.shape[0]
    size = n if surface.periodic else 2 * n
    power = np.mean(np.abs(np.fft.rfft(lines, size, axis=0)) ** 2, axis=1)
    half = n // 2 + 1
    pairs = np.full(half, float(n)) if surface.periodic else n - np.arange(half)
    covariance = np.fft.irfft(power, size)[:half] / pairs
    if covariance[0] <= 0.0:
        raise InputError("the surface is flat", where="autocorrelation")
    return surface.spacing * np.arange(half), covariance / covariance[0]


def correlation_length(
    surface: Profile | HeightMap, level: float = float(np.exp(-1.0)), *, axis: int = 0
) -> float:
    """Return the lag, m, at which the autocorrelation first falls to ``level``.

    1/e by default; 0.2 is the level of Sal in ISO 25178-2.

    Raises:
        InputError: Level outside 0 to 1, or not reached within half the length.
    """
    if not 0.0 < level < 1.0:
        raise InputError(f"level {level:g}", where="level", allowed="between 0 and 1")
    lag, value = autocorrelation(surface, axis=axis)
    below = np.flatnonzero(value <= level)
    if below.size == 0:
        raise InputError(
            f"the autocorrelation stays above {level:g} up to {metres(lag[-1])}",
            where="correlation_length",
            remedy="Measure a longer part, or filter the waviness away",
        )
    i = int(below[0])
    share = (value[i - 1] - level) / (value[i - 1] - value[i])
    return float(lag[i - 1] + share * (lag[i] - lag[i - 1]))
