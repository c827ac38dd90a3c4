"""Regular surfaces: waves and the checkerboard of the grant report."""

import numpy as np

from underfoot.core import InputError
from underfoot.core.units import metres

from .height_map import HeightMap, check_length


def sinusoidal(
    shape: int | tuple[int, int], spacing: float, amplitude: float, wavelength: float
) -> HeightMap:
    """Return a wave along x: heights amplitude cos(2 pi x / wavelength), periodic.

    Raises:
        InputError: Wavelength that does not fit into the length a whole number of times.
    """
    nx, ny = _shape(shape)
    _check(nx, spacing, wavelength, "x")
    x = spacing * np.arange(nx)
    line = amplitude * np.cos(2.0 * np.pi * x / wavelength)
    note = f"wave of amplitude {metres(amplitude)} and wavelength {metres(wavelength)} along x"
    return _pattern(np.repeat(line[:, None], ny, axis=1), spacing, wavelength, note)


def checkerboard(
    shape: int | tuple[int, int],
    spacing: float,
    peak_to_valley: float,
    wavelength: float,
    *,
    form: str = "cosine",
) -> HeightMap:
    """Return peaks and valleys in alternation along x and y, +- half ``peak_to_valley`` (m).

    ``form``: "cosine" (product of two cosines) or "triangular" (straight between peaks and
    valleys, as linear elements that are moved up and down at every other node make it: grant
    report G.1.1). Periodic.

    Raises:
        InputError: Wavelength that does not fit into both lengths a whole number of times, another
            form.
    """
    nx, ny = _shape(shape)
    for n, name in ((nx, "x"), (ny, "y")):
        _check(n, spacing, wavelength, name)
    if form not in ("cosine", "triangular"):
        raise InputError(f'"{form}"', where="form", allowed='"cosine" or "triangular"')

    def one(n: int) -> np.ndarray:
        phase = spacing * np.arange(n) / wavelength
        if form == "cosine":
            return np.cos(2.0 * np.pi * phase)
        return 4.0 * np.abs(np.mod(phase, 1.0) - 0.5) - 1.0

    note = (
        f"{form} checkerboard, peak to valley {metres(peak_to_valley)}, "
        f"wavelength {metres(wavelength)}"
    )
    heights = 0.5 * peak_to_valley * np.outer(one(nx), one(ny))
    return _pattern(heights, spacing, wavelength if form == "cosine" else None, note)


def _pattern(heights: np.ndarray, spacing: float, resolution: float | None, note: str) -> HeightMap:
    return HeightMap(
        heights,
        spacing,
        periodic=True,
        resolution=resolution,
        source="generated",
        processing=(f"generated {note}",),
    )


def _shape(shape: int | tuple[int, int]) -> tuple[int, int]:
    return (shape, shape) if isinstance(shape, int | np.integer) else shape


def _check(n: int, spacing: float, wavelength: float, axis: str) -> None:
    check_length("spacing", spacing)
    check_length("wavelength", wavelength)
    waves = n * spacing / wavelength
    whole = max(round(waves), 1)
    if abs(waves - whole) > 1e-6 * whole:
        raise InputError(
            f"{waves:.6g} waves of {metres(wavelength)} in {metres(n * spacing)} along {axis}",
            where="wavelength",
            allowed="a whole number of waves, so that the surface is periodic",
            nearest=f"{metres(n * spacing / whole)}",
        )
    if wavelength < 2.0 * spacing * (1.0 - 1e-9):
        raise InputError(
            f"wavelength {metres(wavelength)} on a spacing of {metres(spacing)}",
            where="wavelength",
            allowed=f"at least two spacings, {metres(2.0 * spacing)}",
        )
