"""Gaussian filter of ISO 16610-21 (profiles) and, along both axes, ISO 16610-61 (maps)."""

import numpy as np

from underfoot.core import DataError, InputError
from underfoot.core.units import metres

from ._kernels.gaussian import mean_line, weights
from .height_map import check_length
from .prepare import Surface
from .profile import Profile

ENDS = ("drop", "regression", "periodic")


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
    long, _ = _split(surface, cutoff, ends)
    return long


def short_waves(surface: Surface, cutoff: float, ends: str = "drop") -> Surface:
    """Return the part of the surface with wavelengths below ``cutoff`` (m): see ``long_waves``."""
    _, short = _split(surface, cutoff, ends)
    return short


def _split(surface: Surface, cutoff: float, ends: str) -> tuple[Surface, Surface]:
    check_length("cutoff", cutoff)
    if ends not in ENDS:
        raise InputError(f'"{ends}"', where="ends", allowed=", ".join(ENDS))
    if ends == "periodic" and not surface.periodic:
        raise InputError("the surface is not periodic", where="ends", allowed="drop or regression")
    if cutoff < 2.0 * surface.spacing * (1.0 - 1e-9):
        raise InputError(
            f"cut-off {metres(cutoff)} on a spacing of {metres(surface.spacing)}",
            where="cutoff",
            allowed=f"at least two spacings, {metres(2.0 * surface.spacing)}",
        )
    lost = weights(surface.spacing, cutoff, 0.5).size // 2 if ends == "drop" else 0
    for n in surface.heights.shape:
        if n - 2 * lost < 2 or n * surface.spacing < cutoff * (1.0 - 1e-9):
            raise DataError(
                f"a length of {metres(n * surface.spacing)} is too short for the cut-off "
                f"{metres(cutoff)}",
                where="cutoff",
                allowed=f"more than {(2.0 if ends == 'drop' else 1.0) * cutoff:g} m",
                remedy='Take a shorter cut-off, a longer measurement, or ends="regression"',
            )
    long = surface.heights
    for axis in range(long.ndim):
        moved = np.moveaxis(long, axis, 0)
        long = np.moveaxis(mean_line(moved, surface.spacing, cutoff, ends), 0, axis)
    inner = tuple(slice(lost, n - lost) for n in surface.heights.shape)
    short = surface.heights[inner] - long
    changes: dict[str, object] = {} if ends == "periodic" else {"periodic": False}
    name = "ISO 16610-21" if isinstance(surface, Profile) else "ISO 16610-61"
    how = f"Gaussian filter ({name}), cut-off {metres(cutoff)}, ends: {ends}"
    return (
        surface.changed(long, f"long waves kept, {how}", **changes),
        surface.changed(short, f"short waves kept, {how}", **changes),
    )
