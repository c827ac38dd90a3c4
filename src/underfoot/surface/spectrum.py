"""Power spectra of profiles and maps, with the wavelengths that can be believed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError

from .height_map import HeightMap, check_heights
from .prepare import levelled
from .profile import Profile
from .resolution import shortest_reliable_wavelength

WINDOWS = ("none", "hann")


@dataclass(frozen=True, slots=True, eq=False)
class ProfileSpectrum:
    """One-dimensional power spectral density.

    Two-sided, C(q) = 1/(2 pi) int <h(x) h(0)> exp(-i q x) dx, given for q > 0 only: the mean
    square height is 2 int_0^inf C dq.

    Parameters:
        wavenumber: 2 pi / wavelength, rad/m, ascending, (m,).
        density: m^3, (m,).
        reliable: Lowest and highest wave number, rad/m, that can be believed.
        notes: Window, form removed, averaging, what limits it.
    """

    wavenumber: np.ndarray
    density: np.ndarray
    reliable: tuple[float, float]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        _check_spectrum(self.wavenumber, self.density)

    @property
    def mean_square(self) -> float:
        """2 sum C dq, m^2: the mean square height of the heights used, window included."""
        return float(2.0 * np.sum(self.density * _steps(self.wavenumber)))


@dataclass(frozen=True, slots=True, eq=False)
class IsotropicSpectrum:
    """Radially averaged two-dimensional power spectral density.

    C(q) = 1/(2 pi)^2 int <h(x) h(0)> exp(-i q x) d^2x (Persson's convention): the mean square
    height is 2 pi int_0^inf q C dq.

    Parameters:
        wavenumber: rad/m, ascending, (m,).
        density: m^4, (m,).
        area: Part of the wave number plane that each value stands for, rad^2/m^2, (m,): the mean
            square height is sum C area.
        reliable: Lowest and highest wave number that can be believed, rad/m.
        notes: Window, form removed, inversion, what limits it.
    """

    wavenumber: np.ndarray
    density: np.ndarray
    area: np.ndarray
    reliable: tuple[float, float]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        _check_spectrum(self.wavenumber, self.density)

    @property
    def mean_square(self) -> float:
        """Sum of C over the wave number plane, m^2."""
        return float(np.sum(self.density * self.area))

    def within(self, low: float, high: float) -> IsotropicSpectrum:
        """Return the part from ``low`` to ``high`` (rad/m)."""
        inside = (self.wavenumber >= low * (1 - 1e-12)) & (self.wavenumber <= high * (1 + 1e-12))
        if not inside.any():
            raise InputError(
                f"no wave number from {low:g} to {high:g} rad/m",
                where="within",
                allowed=f"{self.wavenumber[0]:g} to {self.wavenumber[-1]:g} rad/m",
            )
        return IsotropicSpectrum(
            self.wavenumber[inside],
            self.density[inside],
            self.area[inside],
            (max(low, self.reliable[0]), min(high, self.reliable[1])),
            (*self.notes, f"cut to {low:g} to {high:g} rad/m"),
        )


def profile_spectrum(
    surface: Profile | HeightMap, *, window: str | None = None, axis: int = 0
) -> ProfileSpectrum:
    """Return the power spectral density along a profile, or averaged over a map's lines.

    ``window``: "none" for periodic surfaces (the default for them), "hann" for others (their
    default), after removing the straight line; the density is divided by the mean square of the
    window, so that its level is kept while single values are not. Maps are cut along ``axis``.

    Believed from two waves in the length (one for periodic surfaces) up to the wave number of
    ``shortest_reliable_wavelength``.
    """
    lines = surface.heights[:, None] if isinstance(surface, Profile) else surface.heights
    lines = np.moveaxis(lines, axis, 0) if isinstance(surface, HeightMap) else lines
    lines, shape, notes = _windowed(lines, window, surface.periodic, (0,))
    n = lines.shape[0]
    length = n * surface.spacing
    transform = np.fft.rfft(lines * shape, axis=0)
    density = np.mean(np.abs(transform) ** 2, axis=1) * length / (2.0 * np.pi * n**2)
    density /= np.mean(shape**2)
    q = 2.0 * np.pi * np.fft.rfftfreq(n, surface.spacing)
    if n % 2 == 0:
        density[-1] *= 0.5  # the highest wave of an even grid stands for both signs
    return ProfileSpectrum(
        q[1:], density[1:], _reliable(surface, length), (*surface.processing, *notes)
    )


def isotropic_spectrum(surface: HeightMap, *, window: str | None = None) -> IsotropicSpectrum:
    """Return the radially averaged power spectral density of a map.

    Rings are as wide as the larger wave number step of the grid; corners beyond the highest wave
    along the axes are kept (so that the sum is the mean square height) but not believed. Windows
    as in ``profile_spectrum``, after removing the plane.
    """
    flat = surface if surface.periodic else levelled(surface, 1)
    z, shape, notes = _windowed(flat.heights, window, surface.periodic, (0, 1))
    nx, ny = z.shape
    lx, ly = surface.size
    transform = np.abs(np.fft.fft2(z * shape)) ** 2
    density = transform * (lx * ly) / ((2.0 * np.pi) ** 2 * (nx * ny) ** 2) / np.mean(shape**2)
    qx = 2.0 * np.pi * np.fft.fftfreq(nx, surface.spacing)[:, None]
    qy = 2.0 * np.pi * np.fft.fftfreq(ny, surface.spacing)[None, :]
    q = np.hypot(qx, qy)
    step = 2.0 * np.pi / min(lx, ly)
    ring = np.rint(q / step).astype(int).ravel()
    ring[0] = 0
    ring[1:] = np.maximum(ring[1:], 1)  # only the mean itself belongs to wave number zero
    count = np.bincount(ring)
    used = np.flatnonzero(count[1:]) + 1
    mean_q = np.bincount(ring, q.ravel())[used] / count[used]
    mean_density = np.bincount(ring, density.ravel())[used] / count[used]
    cell = (2.0 * np.pi) ** 2 / (lx * ly)
    return IsotropicSpectrum(
        mean_q,
        mean_density,
        count[used] * cell,
        _reliable(surface, min(lx, ly)),
        (*flat.processing, *notes),
    )


def _windowed(
    heights: np.ndarray, window: str | None, periodic: bool, axes: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, tuple[str, ...]]:
    check_heights(heights)
    chosen = window if window is not None else ("none" if periodic else "hann")
    if chosen not in WINDOWS:
        raise InputError(f'"{chosen}"', where="window", allowed=", ".join(WINDOWS))
    notes = [f"window: {chosen}"]
    z = heights - heights.mean(axis=axes, keepdims=True)
    if not periodic and axes == (0,):
        x = np.linspace(-1.0, 1.0, z.shape[0])
        z = z - x[:, None] * ((x @ z) / (x @ x))
        notes.insert(0, "straight line removed")
    if not periodic and chosen == "none":
        notes.append("not periodic and not windowed: the jump at the ends adds short waves")
    shape = np.ones([1] * z.ndim)
    if chosen == "hann":
        for axis in axes:
            n = z.shape[axis]
            one = 0.5 - 0.5 * np.cos(2.0 * np.pi * (np.arange(n) + 0.5) / n)
            shape = shape * one.reshape([-1 if a == axis else 1 for a in range(z.ndim)])
        z = z - np.sum(z * shape, axis=axes, keepdims=True) / np.sum(shape)
    return z, shape, tuple(notes)


def _reliable(surface: Profile | HeightMap, length: float) -> tuple[float, float]:
    waves = 1.0 if surface.periodic else 2.0
    return (
        2.0 * np.pi * waves / length,
        2.0 * np.pi / shortest_reliable_wavelength(surface).wavelength,
    )


def _steps(q: np.ndarray) -> np.ndarray:
    return np.gradient(q) if q.size > 1 else q


def _check_spectrum(wavenumber: np.ndarray, density: np.ndarray) -> None:
    q, c = np.asarray(wavenumber), np.asarray(density)
    if q.ndim != 1 or q.shape != c.shape or q.size < 1:
        raise InputError(
            f"wave numbers of shape {q.shape}, densities of shape {c.shape}",
            where="spectrum",
            allowed="two one-dimensional arrays of the same length",
        )
    if not (np.all(np.isfinite(q)) and np.all(np.diff(q) > 0.0) and q[0] > 0.0):
        raise InputError("wave numbers", where="spectrum", allowed="ascending, above 0 rad/m")
    if not (np.all(np.isfinite(c)) and np.all(c >= 0.0)):
        raise InputError("a density is negative or missing", where="spectrum", allowed="0 or more")
