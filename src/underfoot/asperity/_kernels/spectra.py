"""Sums over the half spectra of real fields (Parseval)."""

from __future__ import annotations

from typing import Any

Array = Any


def half_sum(terms: Array, columns: int) -> float:
    """Return the sum over the whole spectrum of real ``terms`` given on its half.

    ``columns`` is the length of axis 1 in real space: inner columns stand for two waves.
    """
    total = 2.0 * float(terms.sum()) - float(terms[:, 0].sum())
    if columns % 2 == 0:
        total -= float(terms[:, -1].sum())
    return total


def slope_numbers(
    spectrum: Array, q_squared: Array, shape: tuple[int, int], limit: float
) -> tuple[float, float]:
    """Return (rms slope, share of its square in waves beyond the wavenumber ``limit``)."""
    power = (spectrum.real**2 + spectrum.imag**2) * q_squared
    total = half_sum(power, shape[1])
    short = half_sum(power * (q_squared > limit**2), shape[1])
    return total**0.5 / (shape[0] * shape[1]), short / total if total > 0.0 else 0.0


def work_against_slope(pressure: Array, height: Array, qx: Array, shape: tuple[int, int]) -> float:
    """Return <p dh/dx> from the half spectra of p and h; qx is 0 on the Nyquist row."""
    terms = (pressure.imag * height.real - pressure.real * height.imag) * qx
    return half_sum(terms, shape[1]) / (shape[0] * shape[1]) ** 2


def dissipation(
    pressure: Array, unit: Array, moduli: Array, qx: Array, shape: tuple[int, int]
) -> float:
    """Return <p du/dx>, the energy lost per area and sliding distance (Pa).

    u = unit p / moduli; the work of a wave is qx unit |p|^2 E''/|E*|^2. ``unit`` is in m/1.
    """
    loss = moduli.imag / (moduli.real**2 + moduli.imag**2) * qx
    terms = (pressure.real**2 + pressure.imag**2) * unit
    terms *= loss
    return half_sum(terms, shape[1]) / (shape[0] * shape[1]) ** 2
