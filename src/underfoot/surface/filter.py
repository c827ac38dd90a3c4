"""Gaussian filter of ISO 16610-21 (profiles) and, along both axes, ISO 16610-61 (maps)."""

import numpy as np

from underfoot.core import DataError, InputError
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres

from .heights import HeightMap, check_length
from .prepare import Surface

ENDS = ("drop", "regression", "periodic")
ALPHA = np.sqrt(np.log(2.0) / np.pi)
ROUNDED = 1e-5
"""Relative rounding of positions that a file prints; a length within it of a cut-off holds it."""


def holds(length: float, cutoff: float) -> bool:
    """Return whether a length (m) holds a cut-off (m)."""
    return length >= cutoff * (1.0 - ROUNDED)


def long_waves(surface: Surface, cutoff: float, ends: str = "drop") -> Surface:
    """Return the part of the surface with wavelengths above ``cutoff`` (m).

    Gaussian weights exp(-pi (x / (alpha cutoff))^2), alpha = sqrt(ln 2 / pi): a wave of the
    cut-off length passes by 50 % (ISO 16610-21:2011). On maps along both axes.

    ``ends`` says what happens where the weights reach over the end:

    - "drop": half a cut-off is lost at each end, where the weights (out to half a cut-off, which
      alters the transmission by up to 0.011) are not covered. The result is shorter.
    - "regression": a straight line is fitted under the weights, so that nothing is lost and
      lines pass unchanged (first order regression filter, ISO 16610-31 without its robust
      weights).
    - "periodic": the surface is continued by itself; only for surfaces that say they are
      periodic.

    Raises:
        InputError: Another ``ends``; "periodic" for a surface that is not; cut-off below two
            spacings.
        DataError: Surface shorter than the cut-off needs.
    """
    return _split(surface, cutoff, ends)[0]


def short_waves(surface: Surface, cutoff: float, ends: str = "drop") -> Surface:
    """Return the part of the surface with wavelengths below ``cutoff`` (m): see ``long_waves``."""
    return _split(surface, cutoff, ends)[1]


def within_cutoffs(flat: HeightMap, short: float, cutoff: float) -> HeightMap:
    """Return a level map without the waves outside both cut-offs (m), where it holds them.

    Half a long cut-off is left out at each end of a side that keeps as much.
    """
    if not holds(min(flat.size), cutoff):
        return flat
    if short < cutoff / 4:
        flat = long_waves(flat, short, "regression")
    rough = short_waves(flat, cutoff, "regression")
    rims = [
        round(0.5 * cutoff / h) if holds(n * h, 1.5 * cutoff) else 0
        for n, h in zip(rough.shape, rough.spacings, strict=True)
    ]
    inner = tuple(slice(rim, n - rim) for n, rim in zip(rough.shape, rims, strict=True))
    return rough.replace_heights(rough.heights[inner], "cut to what the filter covers")


def _split(surface: Surface, cutoff: float, ends: str) -> tuple[Surface, Surface]:
    check_length("cutoff", cutoff)
    if ends not in ENDS:
        raise InputError(f'"{ends}"', where="ends", allowed=", ".join(ENDS))
    if ends == "periodic" and not surface.periodic:
        raise InputError("the surface is not periodic", where="ends", allowed="drop or regression")
    coarsest = max(surface.spacings)
    if cutoff < 2.0 * coarsest * (1.0 - 1e-9):
        raise InputError(
            Message(
                "cut-off {cutoff} on a spacing of {spacing}",
                cutoff=metres(cutoff),
                spacing=metres(coarsest),
            ),
            where="cutoff",
            allowed=Message("at least two spacings, {metres}", metres=metres(2.0 * coarsest)),
        )
    drop = ends == "drop"
    lost = [weights(h, cutoff, 0.5).size // 2 if drop else 0 for h in surface.spacings]
    for n, h, rim in zip(surface.heights.shape, surface.spacings, lost, strict=True):
        if n - 2 * rim < 2 or not holds(n * h, cutoff):
            raise DataError(
                Message(
                    "a length of {length} is too short for the cut-off {cutoff}",
                    length=metres(n * h),
                    cutoff=metres(cutoff),
                ),
                where="cutoff",
                allowed=Message(
                    "more than {cutoff:g} m", cutoff=(2.0 if ends == "drop" else 1.0) * cutoff
                ),
                remedy='Take a shorter cut-off, a longer measurement, or ends="regression"',
            )
    long = surface.heights
    for axis, h in enumerate(surface.spacings):
        moved = np.moveaxis(long, axis, 0)
        long = np.moveaxis(mean_line(moved, h, cutoff, ends), 0, axis)
    inner = tuple(slice(rim, n - rim) for n, rim in zip(surface.heights.shape, lost, strict=True))
    short = surface.heights[inner] - long
    periodic = ends == "periodic"
    name = f"ISO 16610-{21 if surface.axes == 1 else 61}"
    how = {"name": name, "cutoff": metres(cutoff), "ends": ends}
    long_kept = Message(
        "long waves kept, Gaussian filter ({name}), cut-off {cutoff}, ends: {ends}", **how
    )
    short_kept = Message(
        "short waves kept, Gaussian filter ({name}), cut-off {cutoff}, ends: {ends}", **how
    )
    return (
        surface.replace_heights(long, long_kept, periodic=periodic),
        surface.replace_heights(short, short_kept, periodic=periodic),
    )


def weights(spacing: float, cutoff: float, reach: float) -> np.ndarray:
    """Return the Gaussian weights, sum 1, out to ``reach`` cut-offs either side, (2 m + 1,)."""
    m = max(int(np.floor(reach * cutoff / spacing * (1.0 + 1e-9))), 1)
    u = np.arange(-m, m + 1) * spacing / (ALPHA * cutoff)
    w = np.exp(-np.pi * u * u)
    return w / w.sum()


def mean_line(heights: np.ndarray, spacing: float, cutoff: float, ends: str) -> np.ndarray:
    """Return the long-wave part along axis 0.

    ``ends``: "periodic"; "regression" (a weighted straight line is fitted at every point, which
    is the plain filter in the middle); "drop" (only points that the weights out to half a
    cut-off fully cover come back).
    """
    from scipy.signal import fftconvolve, oaconvolve

    n, column = heights.shape[0], (-1,) + (1,) * (heights.ndim - 1)
    if ends == "periodic":
        response = np.exp(-np.pi * (ALPHA * cutoff * np.fft.rfftfreq(n, spacing)) ** 2)
        return np.fft.irfft(np.fft.rfft(heights, axis=0) * response.reshape(column), n, axis=0)
    w = weights(spacing, cutoff, 0.5 if ends == "drop" else 1.0).reshape(column)
    if ends == "drop":
        return oaconvolve(heights, w, mode="valid", axes=0)
    m = w.size // 2
    u = (np.arange(-m, m + 1) / m).reshape(column)
    # Convolution turns the kernel round: odd weights change their sign.
    kernels = (w, -w * u, w * u * u)
    ones = np.ones(n).reshape(column)
    m0, m1, m2 = (fftconvolve(ones, kernel, axes=0)[m : m + n] for kernel in kernels)
    b0, b1 = (oaconvolve(heights, kernel, axes=0)[m : m + n] for kernel in kernels[:2])
    return (m2 * b0 - m1 * b1) / (m0 * m2 - m1 * m1)
