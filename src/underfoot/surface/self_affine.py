"""Random self-affine surfaces with roll-off and cut-offs."""

import numpy as np

from underfoot.core import InputError, RangeError
from underfoot.core.units import metres

from .height_map import HeightMap, check_length


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
    """
    nx, ny = (shape, shape) if isinstance(shape, int | np.integer) else shape
    turn = long_cutoff if roll_off is None else roll_off
    _check(nx, ny, spacing, rms_height, hurst, long_cutoff, short_cutoff, turn, anisotropy)
    qx = 2.0 * np.pi * np.fft.fftfreq(nx, spacing)[:, None] * anisotropy
    qy = 2.0 * np.pi * np.fft.rfftfreq(ny, spacing)[None, :]
    q = np.hypot(qx, qy)
    slack = 1e-9
    band = (q >= 2.0 * np.pi / long_cutoff * (1.0 - slack)) & (
        q <= 2.0 * np.pi / short_cutoff * (1.0 + slack)
    )
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
    return HeightMap(
        heights,
        spacing,
        periodic=True,
        resolution=short_cutoff,
        source="generated",
        processing=(note,),
    )


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


def _check(
    nx: int,
    ny: int,
    spacing: float,
    rms_height: float,
    hurst: float,
    long_cutoff: float,
    short_cutoff: float,
    turn: float,
    anisotropy: float,
) -> None:
    if min(nx, ny) < 4:
        raise InputError(f"grid of {nx} x {ny}", where="shape", allowed="4 x 4 or more")
    for name, value in (
        ("spacing", spacing),
        ("long_cutoff", long_cutoff),
        ("short_cutoff", short_cutoff),
        ("roll_off", turn),
    ):
        check_length(name, value)
    if not (np.isfinite(rms_height) and rms_height >= 0.0):
        raise InputError(
            f"rms height {metres(rms_height)}", where="rms_height", allowed="0 m or more"
        )
    if not 0.0 <= hurst <= 1.0:
        raise RangeError(f"Hurst exponent {hurst:g}", where="hurst", allowed="0 to 1")
    if not (np.isfinite(anisotropy) and anisotropy > 0.0):
        raise InputError(f"anisotropy {anisotropy:g}", where="anisotropy", allowed="above 0")
    side, slack = min(nx, ny) * spacing, 1e-9
    if long_cutoff > side * (1.0 + slack):
        raise RangeError(
            f"longest wavelength {metres(long_cutoff)} on a side of {metres(side)}",
            where="long_cutoff",
            allowed=f"at most {metres(side)}",
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
