"""Sums over the half spectra of real fields (Parseval)."""

from __future__ import annotations

from underfoot.core.arrays import AnyArray
from underfoot.core.threads import namespace


def half_sum(terms: AnyArray, columns: int) -> float:
    """Return the sum over the whole spectrum of real ``terms`` given on its half.

    ``columns`` is the length of axis 1 in real space: inner columns stand for two waves.
    """
    xp = namespace(terms)
    total = 2.0 * float(xp.sum(terms)) - float(xp.sum(terms[:, 0]))
    if columns % 2 == 0:
        total -= float(xp.sum(terms[:, -1]))
    return total


def slope_numbers(
    spectrum: AnyArray, q_squared: AnyArray, shape: tuple[int, int], limit: float
) -> tuple[float, float]:
    """Return (rms slope, share of its square in waves beyond the wavenumber ``limit``)."""
    xp = namespace(spectrum)
    power = _squared(spectrum) * q_squared
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
    loss = namespace(moduli).imag(moduli) / _squared(moduli) * qx
    terms = _squared(pressure) * unit
    terms *= loss
    return half_sum(terms, shape[1]) / (shape[0] * shape[1]) ** 2


def _squared(values: AnyArray) -> AnyArray:
    xp = namespace(values)
    return xp.real(values) ** 2 + xp.imag(values) ** 2
