"""Periodic maps: symbols of the sliding body, sums over half spectra, shifts, contact area."""

import math
from typing import Any

import numpy as np

from underfoot.core.arrays import AnyArray
from underfoot.core.threads import namespace

_STAIRCASE = (math.pi - 1.0 + math.log(2.0)) / 24.0


def half_sum(terms: AnyArray, columns: int) -> float:
    """Return the sum over the whole spectrum of real ``terms`` given on its half.

    ``columns`` is the length of axis 1 in real space: inner columns stand for two waves.
    """
    xp = namespace(terms)
    total = 2.0 * float(xp.sum(terms)) - float(xp.sum(terms[..., 0]))
    if columns % 2 == 0:
        total -= float(xp.sum(terms[..., -1]))
    return total


def slope_numbers(
    spectrum: AnyArray, q_squared: AnyArray, shape: tuple[int, int], limit: float
) -> tuple[float, float]:
    """Return (rms slope, share of its square in waves beyond the wavenumber ``limit``)."""
    xp = namespace(spectrum)
    power = _squared_modulus(spectrum) * q_squared
    total = half_sum(power, shape[1])
    short = half_sum(xp.where(q_squared > limit**2, power, xp.zeros_like(power)), shape[1])
    return total**0.5 / (shape[0] * shape[1]), short / total if total > 0.0 else 0.0


def work_against_slope(
    pressure: AnyArray, height: AnyArray, qx: AnyArray, shape: tuple[int, int]
) -> float:
    """Return <p dh/dx> from the half spectra of p and h; qx is 0 on the Nyquist row."""
    xp = namespace(pressure)
    turned = xp.imag(pressure) * xp.real(height) - xp.real(pressure) * xp.imag(height)
    terms = turned * qx
    return half_sum(terms, shape[1]) / (shape[0] * shape[1]) ** 2


def dissipation(
    pressure: AnyArray, unit: AnyArray, moduli: AnyArray, qx: AnyArray, shape: tuple[int, int]
) -> float:
    """Return <p du/dx>, the energy lost per area and sliding distance (Pa).

    u = unit p / moduli; the work of a wave is qx unit |p|^2 E''/|E*|^2. ``unit`` is in m/1.
    """
    loss = namespace(moduli).imag(moduli) / _squared_modulus(moduli) * qx
    terms = _squared_modulus(pressure) * unit
    terms *= loss
    return half_sum(terms, shape[1]) / (shape[0] * shape[1]) ** 2


def _squared_modulus(values: AnyArray) -> AnyArray:
    xp = namespace(values)
    return xp.real(values) ** 2 + xp.imag(values) ** 2


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
    """Return the compliance symbol c(q), q > 0, of a body with Young's modulus 1 (m).

    Half-space 2 (1-nu^2) / q; layer of ``thickness`` on a rigid base (Bentall and Johnson 1968):
    2 (1-nu^2)/q [(3-4nu) sinh 2k - 2k] / [(3-4nu) cosh 2k + 2k^2 + 5 - 12nu + 8nu^2], k = q T.
    """
    xp = namespace(q)
    compliance = 2.0 * (1.0 - poisson_ratio**2) / q
    if thickness is not None:
        k = xp.clip(q * thickness, None, 30.0)  # beyond, the half-space to 1e-24
        a = 3.0 - 4.0 * poisson_ratio
        compliance *= a * xp.sinh(2.0 * k) - 2.0 * k
        constant = 5.0 - 12.0 * poisson_ratio + 8.0 * poisson_ratio**2
        compliance /= a * xp.cosh(2.0 * k) + 2.0 * k**2 + constant
    return compliance


class ShiftedMap:
    """A periodic map read at x + distance, exact for every wave below Nyquist."""

    def __init__(self, heights: AnyArray, spacing: float) -> None:
        self._shape = heights.shape
        self._spectrum = np.fft.rfft2(heights)
        self._qx = wavenumbers(self._shape, (spacing, spacing))[0]
        self._odd = odd_wavenumbers(self._shape, (spacing, spacing))

    def at(self, distance: float) -> AnyArray:
        """Return the heights at x + ``distance``."""
        return np.fft.irfft2(self._moved_spectrum(distance), s=self._shape)

    def slope_at(self, distance: float) -> AnyArray:
        """Return the slope along axis 0 at x + ``distance``."""
        return np.fft.irfft2(self._moved_spectrum(distance) * 1j * self._odd, s=self._shape)

    def _moved_spectrum(self, distance: float) -> AnyArray:
        # the Nyquist wave, whose odd wave number is 0, has no direction: only in phase
        phase = np.exp(1j * self._odd * distance) * np.cos((self._qx - self._odd) * distance)
        return self._spectrum * phase


def boundary_length(contact: AnyArray, spacing: tuple[float, float], xp: Any) -> float:
    """Return the length of the grid lines between contact and no contact, periodic (m)."""
    along = int(xp.count_nonzero(contact != xp.roll(contact, 1, axis=0)))
    across = int(xp.count_nonzero(contact != xp.roll(contact, 1, axis=1)))
    return along * spacing[1] + across * spacing[0]


def contact_fractions(
    contact: AnyArray, spacing: tuple[float, float], xp: Any
) -> tuple[float, float]:
    """Return the fraction of nodes in contact, plain and corrected for its boundary.

    A' = A - (pi - 1 + ln 2)/24 * S * spacing, S the grid length of the boundary: on average a node
    counted as contact at the edge of a spot covers less than its cell.
    Source: Yastrebov, Anciaux and Molinari (2017) J. Mech. Phys. Solids 107:469 (arXiv 1701.02727).
    """
    nodes = contact.shape[0] * contact.shape[1]
    plain = float(xp.count_nonzero(contact)) / nodes
    width = math.sqrt(spacing[0] * spacing[1])
    excess = _STAIRCASE * boundary_length(contact, spacing, xp) * width
    area = nodes * spacing[0] * spacing[1]
    return plain, max(plain - excess / area, 0.0)
