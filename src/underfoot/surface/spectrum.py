"""Spectra, moments and autocorrelation of profiles and maps; what of them can be believed."""

import math
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from scipy.special import digamma

from underfoot.core import InputError, SourcedValue
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres

from .heights import HeightMap, Heights, check_heights, shortest_reliable_wavelength
from .prepare import level_surface

WINDOWS = ("none", "hann")
POINTS_PER_DECADE = 12


class _Spectrum:
    """What the spectra of profiles and of maps have in common."""

    __slots__ = ()
    wavenumber: np.ndarray
    density: np.ndarray
    reliable: tuple[float, float]
    notes: tuple[str, ...]
    area: Any
    moment_shares: ClassVar[tuple[float, float, float]]

    def __post_init__(self) -> None:
        q, c = np.asarray(self.wavenumber), np.asarray(self.density)
        if q.ndim != 1 or q.shape != c.shape or q.size < 1:
            raise InputError(
                f"wave numbers of shape {q.shape}, densities of shape {c.shape}",
                where="spectrum",
                allowed="two one-dimensional arrays of the same length",
            )
        if not (np.all(np.isfinite(q)) and np.all(np.diff(q) > 0.0) and q[0] > 0.0):
            raise InputError("wave numbers", where="spectrum", allowed="ascending, above 0 rad/m")
        if not (np.all(np.isfinite(c)) and np.all(c >= 0.0)):
            raise InputError(
                "a density is negative or missing", where="spectrum", allowed="0 or more"
            )


@dataclass(frozen=True, slots=True, eq=False)
class ProfileSpectrum(_Spectrum):
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
    moment_shares: ClassVar[tuple[float, float, float]] = (1.0, 1.0, 1.0)

    @property
    def area(self) -> np.ndarray:
        """Part of the wave number axis that each value stands for, both signs, rad/m, (m,)."""
        q = self.wavenumber
        return 2.0 * (np.gradient(q) if q.size > 1 else q)


@dataclass(frozen=True, slots=True, eq=False)
class IsotropicSpectrum(_Spectrum):
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
        levelled_rises: Largest relative change of a profile's density where it rose with q and was
            levelled; 0 where it fell everywhere.
    """

    wavenumber: np.ndarray
    density: np.ndarray
    area: np.ndarray
    reliable: tuple[float, float]
    notes: tuple[str, ...] = ()
    levelled_rises: float = 0.0
    moment_shares: ClassVar[tuple[float, float, float]] = (1.0, 0.5, 0.375)

    def within(self, low: float, high: float) -> Self:
        """Return the part from ``low`` to ``high`` (rad/m)."""
        inside = (self.wavenumber >= low * (1 - 1e-12)) & (self.wavenumber <= high * (1 + 1e-12))
        if not inside.any():
            raise InputError(
                Message("no wave number from {low:g} to {high:g} rad/m", low=low, high=high),
                where="within",
                allowed=Message(
                    "{low:g} to {high:g} rad/m", low=self.wavenumber[0], high=self.wavenumber[-1]
                ),
            )
        return replace(
            self,
            wavenumber=self.wavenumber[inside],
            density=self.density[inside],
            area=self.area[inside],
            reliable=(max(low, self.reliable[0]), min(high, self.reliable[1])),
            notes=(*self.notes, Message("cut to {low:g} to {high:g} rad/m", low=low, high=high)),
        )


def profile_spectrum(
    surface: Heights, *, window: str | None = None, axis: int = 0
) -> ProfileSpectrum:
    """Return the power spectral density along a profile, or averaged over a map's lines.

    ``window``: "none" for periodic surfaces (the default for them), "hann" for others (their
    default), after removing the straight line; the density is divided by the mean square of the
    window, so that its level is kept while single values are not. Maps are cut along ``axis``.

    Believed from two waves in the length (one for periodic surfaces) up to the wave number of
    ``shortest_reliable_wavelength``.
    """
    lines, shape, notes = _window_heights(
        _lines(surface.heights, axis), window, surface.periodic, (0,)
    )
    n, spacing = lines.shape[0], surface.spacings[axis]
    length = n * spacing
    power = np.mean(np.abs(np.fft.rfft(lines * shape, axis=0)) ** 2, axis=1)
    density = power * length / (2.0 * np.pi * n**2) / np.mean(shape**2)
    q = 2.0 * np.pi * np.fft.rfftfreq(n, spacing)
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
    return level_spectrum(surface if surface.periodic else level_surface(surface, 1), window=window)


def level_spectrum(surface: HeightMap, *, window: str | None = None) -> IsotropicSpectrum:
    """Return the ``isotropic_spectrum`` of a map whose plane was removed, or of a periodic one."""
    z, shape, notes = _window_heights(surface.heights, window, surface.periodic, (0, 1))
    nx, ny = z.shape
    lx, ly = surface.size
    transform = np.abs(np.fft.fft2(z * shape)) ** 2
    density = transform * (lx * ly) / ((2.0 * np.pi) ** 2 * (nx * ny) ** 2) / np.mean(shape**2)
    qx = 2.0 * np.pi * np.fft.fftfreq(nx, surface.spacings[0])[:, None]
    qy = 2.0 * np.pi * np.fft.fftfreq(ny, surface.spacings[1])[None, :]
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
        (*surface.processing, *notes),
    )


def _lines(heights: np.ndarray, axis: int) -> np.ndarray:
    return heights[:, None] if heights.ndim == 1 else np.moveaxis(heights, axis, 0)


def _window_heights(
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


def _reliable(surface: Heights, length: float) -> tuple[float, float]:
    longest = length / (1.0 if surface.periodic else 2.0)
    return 2.0 * np.pi / longest, 2.0 * np.pi / shortest_reliable_wavelength(surface).wavelength


def isotropic_from_profile(spectrum: ProfileSpectrum) -> IsotropicSpectrum:
    """Return C(q) of the isotropic surface whose profiles have the given spectrum.

    C1(q) = int C(sqrt(q^2 + k^2)) dk over all k, inverted by Abel's formula
    C(q) = -1/pi int_q^inf C1'(k) / sqrt(k^2 - q^2) dk.

    The profile spectrum is first averaged over a twelfth of a decade, cut to what is reliable,
    and made to fall by isotonic regression (a profile of an isotropic surface can't have a rising
    spectrum). Beyond the last wave number the power law of the last half decade is taken on.
    The notes say so.

    Raises:
        InputError: Less than half a decade of reliable wave numbers.
    """
    from scipy.optimize import isotonic_regression

    q, c, count = average_by_band(spectrum)
    falling = isotonic_regression(c, weights=count, increasing=False).x
    changed = float(np.max(np.abs(1.0 - falling / c)))
    tail = q >= q[-1] / np.sqrt(10.0)
    exponent = float(min(np.polyfit(np.log(q[tail]), np.log(falling[tail]), 1)[0], -1.05))
    density = np.array([_abel(one, q, falling, exponent) for one in q])
    edges = np.concatenate([[q[0]], np.sqrt(q[1:] * q[:-1]), [q[-1]]])
    notes = (
        *spectrum.notes,
        "isotropy assumed: two-dimensional spectrum by Abel inversion",
        Message(
            "extrapolated beyond {q:.4g} rad/m with the power {exponent:.3g} for the inversion",
            q=q[-1],
            exponent=exponent,
        ),
    )
    if changed > 0.0:
        notes += (rises_text(changed),)
    area = np.pi * np.diff(edges**2)
    return IsotropicSpectrum(q, density, area, (float(q[0]), float(q[-1])), notes, changed)


def rises_text(levelled: float) -> Message:
    """Return by how much rises were levelled; ``levelled`` is the largest relative change."""
    if levelled < 10.0:
        most = 100 * levelled
        return Message("rises of the profile spectrum levelled (by up to {most:.0f} %)", most=most)
    return Message("rises of the profile spectrum levelled (by more than tenfold)")


def average_by_band(
    spectrum: ProfileSpectrum | IsotropicSpectrum,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the reliable wave numbers and densities averaged over a twelfth of a decade, and how
    many values stand behind each.

    Raises:
        InputError: Less than half a decade of reliable wave numbers.
    """
    low, high = spectrum.reliable
    inside = (spectrum.wavenumber >= low) & (spectrum.wavenumber <= high) & (spectrum.density > 0.0)
    q, c = spectrum.wavenumber[inside], spectrum.density[inside]
    if q.size < 4 or q[-1] < q[0] * np.sqrt(10.0):
        raise InputError(
            "less than half a decade of reliable wave numbers",
            where="spectrum",
            remedy="Measure a longer profile, or with a smaller spacing",
        )
    place = np.floor(np.log10(q / q[0]) * POINTS_PER_DECADE).astype(int)
    _, place = np.unique(place, return_inverse=True)
    count = np.bincount(place)
    mean_q = np.exp(np.bincount(place, np.log(q)) / count)
    return mean_q, np.bincount(place, c) / count, count


def spectrum_by_decades(spectrum: IsotropicSpectrum) -> IsotropicSpectrum:
    """Return the reliable part of a map's spectrum, averaged over a twelfth of a decade."""
    q, density, _ = average_by_band(spectrum)
    edges = np.concatenate([[q[0]], np.sqrt(q[1:] * q[:-1]), [q[-1]]])
    return replace(spectrum, wavenumber=q, density=density, area=np.pi * np.diff(edges**2))


def smooth_spectrum(spectrum: IsotropicSpectrum) -> IsotropicSpectrum:
    """Return the spectrum with q^2 C averaged over five values: one profile leaves gaps in it."""
    power = np.pad(spectrum.wavenumber**2 * spectrum.density, 2, mode="edge")
    mean = np.convolve(power, np.full(5, 0.2), "valid") / spectrum.wavenumber**2
    return replace(spectrum, density=mean)


def power_law(
    measured: ProfileSpectrum | IsotropicSpectrum, spectrum: IsotropicSpectrum
) -> tuple[SourcedValue, float | None, tuple[float, float]]:
    """Return the Hurst exponent, roll-off (m) and C (m^4) at both ends, least squares in ln C.

    C = level for q below the roll-off, level (q / q_r)^(-2 (1 + H)) above, (q / q_r)^(-1 - 2 H)
    of a profile; roll-offs within the longest half of the decades are tried, none included. Values
    of few waves count less, and their mean logarithm is corrected.
    """
    q, c, count = average_by_band(measured)
    log_q, log_c = np.log(q), np.log(c) - digamma(count) + np.log(count)
    weight = np.sqrt(np.minimum(count, 30))
    best: tuple[float, float, float, float] | None = None
    for turn in [log_q[0], *log_q[1 : max(2, q.size // 2)]]:
        basis = np.column_stack([np.ones(q.size), np.maximum(log_q - turn, 0.0)])
        solved = np.linalg.lstsq(basis * weight[:, None], log_c * weight, rcond=None)[0]
        rest = float(np.sum((weight * (log_c - basis @ solved)) ** 2))
        if best is None or rest < 0.9 * best[0]:
            inverse = np.linalg.inv((basis * weight[:, None]).T @ (basis * weight[:, None]))
            error = math.sqrt(rest / max(q.size - 3, 1) * inverse[1, 1]) / 2
            best = (rest, turn, float(solved[1]), error)
    assert best is not None
    _, turn, slope, error = best
    exponent = -(slope + (1 if isinstance(measured, ProfileSpectrum) else 2)) / 2
    bounded = min(max(exponent, 0.0), 1.0)
    note = Message("of the power law that continues the spectrum")
    if bounded != exponent:
        note = Message(
            "{note}; the fit gives {exponent:.2f}, which no self-affine surface has",
            note=note,
            exponent=exponent,
        )
    hurst = SourcedValue(bounded, "1", source="fit to the spectrum", uncertainty=error, note=note)
    log_q = np.log(spectrum.wavenumber)
    shape = -2 * (1 + bounded) * np.maximum(log_q - turn, 0.0)
    away = np.log(np.maximum(spectrum.density, 1e-99)) - shape
    ends = math.exp(np.mean(away[:5]) + shape[0]), math.exp(np.mean(away[-5:]) + shape[-1])
    return hurst, None if turn == np.log(q[0]) else 2 * math.pi / math.exp(turn), ends


def _abel(q: float, nodes: np.ndarray, values: np.ndarray, exponent: float) -> float:
    # With k = q cosh u the singular root goes away: C = -1/pi int C1'(q cosh u) du.
    u = np.linspace(0.0, np.arccosh(max(1e3 * nodes[-1] / q, 2.0)), 2000)
    k = q * np.cosh(u)
    log_k, log_nodes, log_values = np.log(k), np.log(nodes), np.log(values)
    slopes = np.concatenate([np.diff(log_values) / np.diff(log_nodes), [exponent]])
    inside = np.interp(log_k, log_nodes, log_values)
    beyond = log_k > log_nodes[-1]
    inside[beyond] = log_values[-1] + exponent * (log_k[beyond] - log_nodes[-1])
    # Slopes between nodes are joined linearly, so that the integrand has no steps.
    middles = np.concatenate([0.5 * (log_nodes[1:] + log_nodes[:-1]), [log_nodes[-1]]])
    power = np.interp(log_k, middles, slopes)
    return float(-np.trapezoid(np.exp(inside) / k * power, u) / np.pi)


def autocorrelation(surface: Heights, *, axis: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Return (lag in m, autocorrelation) with 1 at lag 0; of a map, the mean over its lines.

    Line or plane are removed from surfaces that are not periodic; their value at a lag is the
    mean over the pairs that exist, up to half the length. Periodic ones are continued.

    Raises:
        InputError: A flat surface.
    """
    z = (surface if surface.periodic else level_surface(surface)).heights
    lines = _lines(z - z.mean(), axis)
    n = lines.shape[0]
    size = n if surface.periodic else 2 * n
    power = np.mean(np.abs(np.fft.rfft(lines, size, axis=0)) ** 2, axis=1)
    half = n // 2 + 1
    pairs = np.full(half, float(n)) if surface.periodic else n - np.arange(half)
    covariance = np.fft.irfft(power, size)[:half] / pairs
    if covariance[0] <= 0.0:
        raise InputError("the surface is flat", where="autocorrelation")
    return surface.spacings[axis] * np.arange(half), covariance / covariance[0]


def correlation_length(
    surface: Heights, level: float = float(np.exp(-1.0)), *, axis: int = 0
) -> float:
    """Return the lag, m, at which the autocorrelation first falls to ``level``.

    1/e by default; 0.2 is the level of Sal in ISO 25178-2.

    Parameters:
        surface: Profile or map.
        level: Of the autocorrelation, 0 to 1.
        axis: Of a map: 0 for x, 1 for y.

    Raises:
        InputError: Level outside 0 to 1, or not reached within half the length.
    """
    if not 0.0 < level < 1.0:
        raise InputError(
            Message("level {level:g}", level=level), where="level", allowed="between 0 and 1"
        )
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


@dataclass(frozen=True, slots=True)
class SpectralMoments:
    """Profile moments m0 (m^2), m2 (1) and m4 (1/m^2): mean squares of height, slope, curvature.

    They depend on the band of wave numbers ``band`` (rad/m), m4 almost entirely on its upper end.
    """

    m0: float
    m2: float
    m4: float
    band: tuple[float, float]

    @property
    def bandwidth(self) -> float:
        """Nayak's alpha = m0 m4 / m2^2, at least 1.5 for an isotropic random surface."""
        return self.m0 * self.m4 / self.m2**2


@dataclass(frozen=True, slots=True)
class Asperities:
    """Summits of an isotropic Gaussian surface as spheres of one radius.

    ``density`` (1/m^2), ``radius`` (m), ``height_sd`` (m) of the summits, ``mean_height`` (m) of
    the summits above the mean plane.
    """

    density: float
    radius: float
    height_sd: float
    mean_height: float
    source: str = (
        "J. I. McCool, Relating profile instrument measurements to the functional performance of "
        "rough surfaces, J. Tribology 109 (1987) 264-270; Nayak (1971)"
    )


def spectral_moments(
    spectrum: ProfileSpectrum | IsotropicSpectrum, band: tuple[float, float] | None = None
) -> SpectralMoments:
    """Return the moments of the profiles of a surface over ``band`` (rad/m; default: reliable).

    From a profile spectrum m_n = 2 int q^n C dq; from an isotropic one
    m_n = int cos^n(phi) q^n C d^2q, so m0, m2 / 2 and 3 m4 / 8 of the radial integrals.

    Raises:
        InputError: No wave number in the band, or no roughness there.
    """
    low, high = band if band is not None else spectrum.reliable
    q = spectrum.wavenumber
    inside = (q >= low * (1 - 1e-12)) & (q <= high * (1 + 1e-12))
    weight, q = (spectrum.density * spectrum.area)[inside], q[inside]
    if not (weight.size and weight.sum() > 0.0):
        least, most = spectrum.wavenumber[[0, -1]]
        raise InputError(
            Message("no roughness between {low:g} and {high:g} rad/m", low=low, high=high),
            where="band",
            allowed=Message("within {least:g} to {most:g} rad/m", least=least, most=most),
        )
    shares = zip(spectrum.moment_shares, (0, 2, 4), strict=True)
    m0, m2, m4 = (share * float(np.sum(weight * q**n)) for share, n in shares)
    return SpectralMoments(m0, m2, m4, (float(low), float(high)))


def asperities(moments: SpectralMoments) -> Asperities:
    """Return the summits that Greenwood and Williamson's model needs, after McCool (1987).

    density = m4 / (6 pi sqrt(3) m2), radius = 3 sqrt(pi) / (8 sqrt(m4)),
    height_sd^2 = (1 - 0.8968 / alpha) m0, mean_height = 4 sqrt(m0 / (pi alpha)).

    Raises:
        InputError: alpha below 1.5: not an isotropic random surface.
    """
    alpha = moments.bandwidth
    if alpha < 1.5 * (1.0 - 1e-6):
        raise InputError(
            Message("bandwidth parameter {alpha:.3g}", alpha=alpha),
            where="moments",
            allowed="1.5 or more, as every isotropic random surface has",
            remedy="A wave or a ridged surface has no summits in this sense",
        )
    return Asperities(
        density=moments.m4 / (6.0 * math.pi * math.sqrt(3.0) * moments.m2),
        radius=3.0 * math.sqrt(math.pi) / (8.0 * math.sqrt(moments.m4)),
        height_sd=math.sqrt((1.0 - 0.8968 / alpha) * moments.m0),
        mean_height=4.0 * math.sqrt(moments.m0 / (math.pi * alpha)),
    )
