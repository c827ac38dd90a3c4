"""Fourier symbols of the sliding half-space or layer on a periodic grid."""

from __future__ import annotations

import numpy as np

from underfoot.core.arrays import AnyArray


def wavenumbers(shape: tuple[int, int], spacing: tuple[float, float]) -> tuple[AnyArray, AnyArray]:
    """Return (qx (nx, 1), qy (1, ny//2+1)) in rad/m of the real FFT over axis 1."""
    qx = 2.0 * np.pi * np.fft.fftfreq(shape[0], spacing[0])
    qy = 2.0 * np.pi * np.fft.rfftfreq(shape[1], spacing[1])
    return qx[:, None], qy[None, :]


def odd_wavenumbers(shape: tuple[int, int], spacing: tuple[float, float]) -> AnyArray:
    """Return qx (nx, 1) with the Nyquist row zeroed: a real field has no derivative there."""
    qx, _ = wavenumbers(shape, spacing)
    if shape[0] % 2 == 0:
        qx = qx.copy()
        qx[shape[0] // 2] = 0.0
    return qx


def sliding_moduli(table: AnyArray, length: float, forward: bool, qx: AnyArray) -> AnyArray:
    """Return E*(qx v) (nx, 1): the conjugate for waves met backwards, real on the Nyquist row.

    ``table`` holds E* of the waves 0, 1, 2, ... to the cell of ``length``; coarser grids hold the
    same waves. Real when nothing is lost.
    """
    if not np.any(table.imag):
        table = table.real
    wave = np.rint(np.abs(qx) * (length / (2.0 * np.pi))).astype(int)
    values = table[wave]
    rows = np.where((qx < 0.0) == forward, np.conj(values), values)
    if qx.shape[0] % 2 == 0:
        # the Nyquist wave is its own mirror image: only the in-phase compliance acts
        row = qx.shape[0] // 2
        rows[row] = 1.0 / np.real(1.0 / rows[row])
    return rows


def unit_compliance(q: AnyArray, thickness: float | None, poisson_ratio: float) -> AnyArray:
    """Return the compliance symbol c(q) of a body with Young's modulus 1 (m), 0 at q = 0.

    Half-space 2 (1-nu^2) / q; layer of ``thickness`` on a rigid base (Bentall and Johnson 1968):
    2 (1-nu^2)/q [(3-4nu) sinh 2k - 2k] / [(3-4nu) cosh 2k + 2k^2 + 5 - 12nu + 8nu^2], k = q T.
    """
    safe = np.where(q > 0.0, q, 1.0)
    half_space = 2.0 * (1.0 - poisson_ratio**2) / safe
    if thickness is None:
        return np.where(q > 0.0, half_space, 0.0)
    k = np.minimum(safe * thickness, 30.0)  # beyond, the half-space to 1e-24
    a = 3.0 - 4.0 * poisson_ratio
    top = a * np.sinh(2.0 * k) - 2.0 * k
    bottom = a * np.cosh(2.0 * k) + 2.0 * k**2 + 5.0 - 12.0 * poisson_ratio + 8.0 * poisson_ratio**2
    return np.where(q > 0.0, half_space * top / bottom, 0.0)
