"""A random surface with a given spectrum."""

import numpy as np

from underfoot.core import InputError, RangeError
from underfoot.core.units import metres

from .height_map import HeightMap, check_length
from .self_affine import random_phases
from .spectrum import IsotropicSpectrum


def surface_from_spectrum(
    spectrum: IsotropicSpectrum, shape: int | tuple[int, int], spacing: float, seed: int
) -> HeightMap:
    """Return a periodic Gaussian surface with random phases and the given isotropic spectrum.

    Only wave numbers that the spectrum has (its reliable ones) and the grid can hold get an
    amplitude; between the values the spectrum is interpolated over its logarithm. Nothing is
    extrapolated: the processing line states which wavelengths are in, and which share of the
    spectrum's mean square height that is.

    ``shape`` points along x and y, ``spacing`` m, ``seed``: same seed, same surface.

    Raises:
        RangeError: No wave of the grid lies within the spectrum.
        InputError: Grid below 4 x 4; all densities zero.
    """
    nx, ny = (shape, shape) if isinstance(shape, int | np.integer) else shape
    check_length("spacing", spacing)
    if min(nx, ny) < 4:
        raise InputError(f"grid of {nx} x {ny}", where="shape", allowed="4 x 4 or more")
    low, high = spectrum.reliable
    use = (
        (spectrum.density > 0.0)
        & (spectrum.wavenumber >= low * (1.0 - 1e-9))
        & (spectrum.wavenumber <= high * (1.0 + 1e-9))
    )
    if not use.any():
        raise InputError("the spectrum is zero where it is reliable", where="spectrum")
    q_known, c_known = spectrum.wavenumber[use], spectrum.density[use]
    qx = 2.0 * np.pi * np.fft.fftfreq(nx, spacing)[:, None]
    qy = 2.0 * np.pi * np.fft.rfftfreq(ny, spacing)[None, :]
    q = np.hypot(qx, qy)
    # A first or last value stands for its whole ring, out to the limits of what is reliable.
    first, last = max(low, 0.0), min(high, 1.5 * q_known[-1])
    band = (q >= first * (1.0 - 1e-9)) & (q <= last * (1.0 + 1e-9)) & (q > 0.0)
    if not band.any():
        raise RangeError(
            f"waves of {metres(2 * np.pi / q_known[-1])} to {metres(2 * np.pi / q_known[0])} on a "
            f"grid of {nx} x {ny} points {metres(spacing)} apart",
            where="spacing",
            remedy="Take a grid that holds some of these waves",
        )
    density = np.zeros_like(q)
    density[band] = np.exp(np.interp(np.log(q[band]), np.log(q_known), np.log(c_known)))
    cell = (2.0 * np.pi) ** 2 / (nx * ny * spacing**2)
    amplitude = np.sqrt(density * cell) * (nx * ny)
    heights = random_phases(amplitude, (nx, ny), seed)
    total = float(np.sum(spectrum.density[use] * spectrum.area[use]))
    shortest, longest = 2.0 * np.pi / q[band].max(), 2.0 * np.pi / q[band].min()
    note = (
        f"generated from a spectrum, wavelengths {metres(shortest)} to {metres(longest)}, "
        f"{100.0 * float(np.mean(heights**2)) / total:.3g} % of its mean square height, "
        f"periodic, nothing extrapolated, seed {seed}"
    )
    return HeightMap(
        heights,
        spacing,
        periodic=True,
        resolution=shortest,
        source="generated",
        processing=(*spectrum.notes, note),
    )
