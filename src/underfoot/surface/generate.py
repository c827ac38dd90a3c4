"""Surfaces that are generated: waves, checkerboards, self-affine ones, ones of a given spectrum."""

import math
from collections.abc import Callable

import numpy as np

from underfoot.core import InputError, RangeError
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres

from .heights import HeightMap, check_length
from .spectrum import IsotropicSpectrum

CELL_PARTS = 5
"""Points along a side by which the density is averaged over a cell of wave numbers."""


def sinusoidal(
    shape: int | tuple[int, int], spacing: float, amplitude: float, wavelength: float
) -> HeightMap:
    """Return a wave along x: heights amplitude cos(2 pi x / wavelength), periodic.

    Raises:
        InputError: Wavelength that does not fit into the length a whole number of times.

    >>> sinusoidal(64, 1e-6, 2e-6, 32e-6).heights.shape
    (64, 64)
    """
    nx, ny = _points(shape)
    _check_wave(nx, spacing, wavelength, "x")
    line = amplitude * np.cos(2.0 * np.pi * spacing * np.arange(nx) / wavelength)
    size = f"amplitude {metres(amplitude)} and wavelength {metres(wavelength)}"
    note = f"generated wave of {size} along x"
    return _generated_map(np.repeat(line[:, None], ny, axis=1), spacing, wavelength, note)


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

    Parameters:
        shape: Number of points, one for both axes or (nx, ny).
        spacing: m.
        peak_to_valley: m.
        wavelength: m; a whole number of them fits the lengths.
        form: "cosine" or "triangular".

    Raises:
        InputError: Wavelength that does not fit into both lengths a whole number of times, another
            form.

    >>> checkerboard(64, 1e-6, 2e-6, 32e-6).heights.shape
    (64, 64)
    """
    nx, ny = _points(shape)
    for n, name in ((nx, "x"), (ny, "y")):
        _check_wave(n, spacing, wavelength, name)
    if form not in ("cosine", "triangular"):
        raise InputError(f'"{form}"', where="form", allowed='"cosine" or "triangular"')

    def wave(n: int) -> np.ndarray:
        phase = spacing * np.arange(n) / wavelength
        if form == "cosine":
            return np.cos(2.0 * np.pi * phase)
        return 4.0 * np.abs(np.mod(phase, 1.0) - 0.5) - 1.0

    note = (
        f"generated {form} checkerboard, peak to valley {metres(peak_to_valley)}, "
        f"wavelength {metres(wavelength)}"
    )
    heights = 0.5 * peak_to_valley * np.outer(wave(nx), wave(ny))
    return _generated_map(heights, spacing, wavelength if form == "cosine" else None, note)


def _generated_map(
    heights: np.ndarray, spacing: float, resolution: float | None, *done: str
) -> HeightMap:
    return HeightMap(heights, spacing, True, resolution, source="generated", processing=done)


def _points(shape: int | tuple[int, int]) -> tuple[int, int]:
    return (shape, shape) if isinstance(shape, int | np.integer) else shape


def _wave_numbers(shape: int | tuple[int, int], spacing: float, stretch: float) -> np.ndarray:
    """Return the wave numbers (rad/m) of a real transform, those along x times ``stretch``."""
    nx, ny = _points(shape)
    check_length("spacing", spacing)
    if min(nx, ny) < 4:
        raise InputError(f"grid of {nx} x {ny}", where="shape", allowed="4 x 4 or more")
    qx = 2.0 * np.pi * np.fft.fftfreq(nx, spacing)[:, None] * stretch
    return np.hypot(qx, 2.0 * np.pi * np.fft.rfftfreq(ny, spacing)[None, :])


def _check_wave(n: int, spacing: float, wavelength: float, axis: str) -> None:
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
            allowed=Message("at least two spacings, {metres}", metres=metres(2.0 * spacing)),
        )


def self_affine(
    shape: int | tuple[int, int],
    spacing: float,
    rms_height: float,
    hurst: float,
    long_cutoff: float,
    short_cutoff: float,
    seed: int,
    roll_off: float | None = None,
    *,
    anisotropy: float = 1.0,
) -> HeightMap:
    """Return a periodic random self-affine surface with exactly the rms height asked for.

    Isotropic spectrum C(q) ~ q^(-2 (1 + H)) for 2 pi / roll_off < q < 2 pi / short_cutoff,
    constant for 2 pi / long_cutoff < q < 2 pi / roll_off, zero elsewhere; amplitudes are those
    of the spectrum, phases random (Persson et al. 2005, J. Phys.: Condens. Matter 17, R1).

    Parameters:
        shape: Points along x and y (one number: square).
        spacing: m.
        rms_height: m, about the mean plane; zero gives a flat surface.
        hurst: 0 to 1; 0.8 is common for worn or sand-blasted surfaces.
        long_cutoff: Longest wavelength, m, at most the shorter side.
        short_cutoff: Shortest wavelength, m, at least twice the spacing.
        seed: Same seed, same surface.
        roll_off: Wavelength, m, where the spectrum turns flat; by default ``long_cutoff`` (no flat
            part).
        anisotropy: Stretch of the pattern along x relative to y: 3 gives ridges along the sliding
            direction three times longer than wide. Cut-offs then hold along y.

    Raises:
        RangeError, InputError: Wavelengths that the grid can't hold or in the wrong order, Hurst
            exponent outside 0 to 1.

    >>> round(float(self_affine(64, 1e-6, 2e-6, 0.8, 64e-6, 4e-6, seed=1).heights.std()) * 1e6, 3)
    2.0
    """
    turn = long_cutoff if roll_off is None else roll_off
    if not (np.isfinite(anisotropy) and anisotropy > 0.0):
        raise InputError(f"anisotropy {anisotropy:g}", where="anisotropy", allowed="above 0")
    q = _wave_numbers(shape, spacing, anisotropy)
    lengths = {"long_cutoff": long_cutoff, "short_cutoff": short_cutoff, "roll_off": turn}
    for name, value in lengths.items():
        check_length(name, value)
    if not (np.isfinite(rms_height) and rms_height >= 0.0):
        raise InputError(
            f"rms height {metres(rms_height)}", where="rms_height", allowed="0 m or more"
        )
    if not 0.0 <= hurst <= 1.0:
        raise RangeError(f"Hurst exponent {hurst:g}", where="hurst", allowed="0 to 1")
    nx, ny = _points(shape)
    side, slack = min(nx, ny) * spacing, 1e-9
    if long_cutoff > side * (1.0 + slack):
        raise RangeError(
            f"longest wavelength {metres(long_cutoff)} on a side of {metres(side)}",
            where="long_cutoff",
            allowed=Message("at most {most}", most=metres(side)),
            remedy="Take more points, or a shorter longest wavelength",
        )
    if short_cutoff < 2.0 * spacing * (1.0 - slack):
        raise RangeError(
            f"shortest wavelength {metres(short_cutoff)} on a grid of {metres(spacing)}",
            where="short_cutoff",
            allowed=f"at least two grid spacings, {metres(2.0 * spacing)}",
        )
    if not short_cutoff <= turn <= long_cutoff * (1.0 + slack):
        raise RangeError(
            f"roll-off {metres(turn)}",
            where="roll_off",
            allowed=f"between the cut-offs {metres(short_cutoff)} and {metres(long_cutoff)}",
        )
    low, high = (2.0 * np.pi / cutoff for cutoff in (long_cutoff, short_cutoff))
    band = (q >= low * (1.0 - slack)) & (q <= high * (1.0 + slack))
    if not band.any():
        raise RangeError(
            "no wave of the grid lies between the cut-offs",
            where="long_cutoff, short_cutoff",
            remedy="Widen the band or take a larger grid",
        )
    amplitude = np.zeros_like(q)
    amplitude[band] = np.maximum(q[band], 2.0 * np.pi / turn) ** (-(1.0 + hurst))
    heights = random_phases(amplitude, (nx, ny), seed)
    heights *= rms_height / np.sqrt(np.mean(heights**2))
    note = (
        f"generated self-affine, Hurst {hurst:g}, wavelengths {metres(short_cutoff)} to "
        f"{metres(long_cutoff)}, roll-off {metres(turn)}, anisotropy {anisotropy:g}, seed {seed}"
    )
    return _generated_map(heights, spacing, short_cutoff, note)


def random_phases(amplitude: np.ndarray, shape: tuple[int, int], seed: int) -> np.ndarray:
    """Return a real field whose real-FFT amplitudes are ``amplitude`` with random phases.

    The phases are those of white noise, so the symmetry of a real field holds by itself.
    """
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal(shape))
    size = np.abs(noise)
    noise /= np.where(size > 0.0, size, 1.0)
    noise *= amplitude
    noise[0, 0] = 0.0
    return np.fft.irfft2(noise, s=shape)


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
    q = _wave_numbers(shape, spacing, 1.0)
    nx, ny = _points(shape)
    low, high = spectrum.reliable
    use = (
        (spectrum.density > 0.0)
        & (spectrum.wavenumber >= low * (1.0 - 1e-9))
        & (spectrum.wavenumber <= high * (1.0 + 1e-9))
    )
    if not use.any():
        raise InputError("the spectrum is zero where it is reliable", where="spectrum")
    q_known, c_known = spectrum.wavenumber[use], spectrum.density[use]
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
    total = float(np.sum(c_known * spectrum.area[use]))
    shortest, longest = 2.0 * np.pi / q[band].max(), 2.0 * np.pi / q[band].min()
    note = (
        f"generated from a spectrum, wavelengths {metres(shortest)} to {metres(longest)}, "
        f"{100.0 * float(np.mean(heights**2)) / total:.3g} % of its mean square height, "
        f"periodic, nothing extrapolated, seed {seed}"
    )
    return _generated_map(heights, spacing, shortest, *spectrum.notes, note)


def surface_of_density(
    density: Callable[[np.ndarray], np.ndarray],
    waves: tuple[float, float],
    shape: int | tuple[int, int],
    spacing: float,
    seed: int,
) -> HeightMap:
    """Return a periodic Gaussian surface with the waves of an isotropic spectrum in a range.

    ``density`` gives C(q) (m^4) of wave numbers (rad/m), <h^2> = 2 pi int q C dq; ``waves`` are the
    longest and the shortest, m. A wave of the grid has the mean of the density over its cell of
    wave numbers, as far as that lies in the range: heights and slopes are those of the range within
    about 1 %.

    Parameters:
        density: C(q) in m^4 of wave numbers in rad/m.
        waves: Longest and shortest, m.
        shape: Number of points, one for both axes or (nx, ny).
        spacing: m.
        seed: Of the random numbers: equal seeds give equal draws.
    """
    nx, ny = _points(shape)
    low, high = (2.0 * np.pi / wave for wave in waves)
    steps = [2.0 * np.pi / (n * spacing) for n in (nx, ny)]
    qx, qy = 2.0 * np.pi * np.fft.fftfreq(nx, spacing), 2.0 * np.pi * np.fft.rfftfreq(ny, spacing)
    parts = (np.arange(CELL_PARTS) + 0.5) / CELL_PARTS - 0.5
    power = np.zeros((nx, qy.size))
    for x in parts * steps[0]:
        for y in parts * steps[1]:
            q = np.hypot(qx[:, None] + x, qy[None, :] + y)
            band = (q >= low) & (q <= high)
            power[band] += density(q[band])
    if not power.any():
        raise RangeError(
            f"no wave of {metres(waves[1])} to {metres(waves[0])} on a grid of {nx} x {ny} points "
            f"{metres(spacing)} apart",
            where="waves",
        )
    power *= math.prod(steps) / CELL_PARTS**2
    heights = random_phases(np.sqrt(power) * (nx * ny), (nx, ny), seed)
    note = f"generated from a spectrum, waves {metres(waves[1])} to {metres(waves[0])}, seed {seed}"
    return _generated_map(heights, spacing, waves[1], note)
