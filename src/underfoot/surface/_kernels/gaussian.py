"""Gaussian profile filter as a convolution along one axis; pure functions of arrays."""

import numpy as np

ALPHA = np.sqrt(np.log(2.0) / np.pi)


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

    n = heights.shape[0]
    if ends == "periodic":
        q = np.fft.rfftfreq(n, spacing)
        response = np.exp(-np.pi * (ALPHA * cutoff * q) ** 2)
        shape = (-1,) + (1,) * (heights.ndim - 1)
        return np.fft.irfft(np.fft.rfft(heights, axis=0) * response.reshape(shape), n, axis=0)
    w = weights(spacing, cutoff, 0.5 if ends == "drop" else 1.0)
    kernel = w.reshape((-1,) + (1,) * (heights.ndim - 1))
    if ends == "drop":
        return oaconvolve(heights, kernel, mode="valid", axes=0)
    m = w.size // 2
    u = np.arange(-m, m + 1) / m
    column = np.ones(n)
    # Convolution turns the kernel round: odd weights change their sign.
    m0 = fftconvolve(column, w, mode="full")[m : m + n]
    m1 = fftconvolve(column, -w * u, mode="full")[m : m + n]
    m2 = fftconvolve(column, w * u * u, mode="full")[m : m + n]
    odd = (-w * u).reshape(kernel.shape)
    b0 = oaconvolve(heights, kernel, mode="full", axes=0)[m : m + n]
    b1 = oaconvolve(heights, odd, mode="full", axes=0)[m : m + n]
    shape = (-1,) + (1,) * (heights.ndim - 1)
    m0, m1, m2 = (a.reshape(shape) for a in (m0, m1, m2))
    return (m2 * b0 - m1 * b1) / (m0 * m2 - m1 * m1)
