"""Flows through the faces between cells of constant gap, with their derivatives by the two gaps.

``a`` and ``b`` are the cells on the far and the near side of a face along its axis. A face is two
half-cells in series, exact for a step in the gap: with conductances K_a, K_b (m^3/(Pa s)),

    k = 2 K_a K_b / (K_a + K_b)            pressure flow per unit pressure difference
    h_c = (a K_b + b K_a) / (K_a + K_b)    gap that carries the shear flow

Taking the gap linear between cell centres instead doubles the film under a lug beside a channel.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from underfoot.core.arrays import Array

SMOOTH, STEP = 1.0, 2.0
"""|ln| of the ratio of neighbouring gaps: up to SMOOTH the film varies, from STEP it is a step."""


class FaceValue(NamedTuple):
    """A quantity of each face and its derivatives by the gaps a and b."""

    value: Array
    by_a: Array
    by_b: Array


class Upwinding(NamedTuple):
    """How far the shear gap of each x face, (nx - 1, ny), leans upstream."""

    strength: Array  # 0 central to 1 upwind
    correction: Array  # m, added to the upstream gap


def series_conductance(ka: Array, kb: Array, dka: Array, dkb: Array) -> FaceValue:
    """Return the conductance of two half-cells in series; ``dka`` is dK_a/da."""
    total = ka + kb
    return FaceValue(2 * ka * kb / total, 2 * (kb / total) ** 2 * dka, 2 * (ka / total) ** 2 * dkb)


def shear_gap(a: Array, b: Array, ka: Array, kb: Array, dka: Array, dkb: Array) -> FaceValue:
    """Return the gap that carries the shear flow through a face."""
    total = ka + kb
    gap = (a * kb + b * ka) / total
    return FaceValue(gap, (kb + (b - gap) * dka) / total, (ka + (a - gap) * dkb) / total)


def upwind_blend(
    a: Array, b: Array, shear: FaceValue, lean: Upwinding, *, from_a: bool
) -> FaceValue:
    """Return the shear gap drawn towards the upstream cell where the film is compliant.

    Central values wiggle where the gap answers to the pressure faster than the pressure flow can
    smooth it (cell Peclet number above 1). A rigid film keeps the series-exact gap, and so does a
    step in the sole, with no remainder: a channel 2 mm deep beside a film of 5 um would otherwise
    feed the lug with a flow it doesn't have.
    """
    gap, by_a, by_b = shear
    smooth, slope = _smoothness(a, b)
    weight = lean.strength * smooth
    excess = (a if from_a else b) + lean.correction - gap
    turn = lean.strength * slope * excess
    by_a = (1 - weight) * by_a + turn / a
    by_b = (1 - weight) * by_b - turn / b
    if from_a:
        by_a = by_a + weight
    else:
        by_b = by_b + weight
    return FaceValue(gap + weight * excess, by_a, by_b)


def upwinding(gap: Array, carried: Array, conductance: Array, *, from_a: bool) -> Upwinding:
    """Return how far the x faces lean upstream, from a known gap (that of the last time step).

    Parameters:
        gap, conductance: (nx, ny) m and m^3/(Pa s).
        carried: |U| times spacing times deflection per pressure, (nx, ny), m^3/(Pa s): what the
            shear flow carries of a pressure change. Over the conductance it is the cell Peclet
            number.
        from_a: True when the flow comes from +x.

    The correction is half the limited slope (van Leer) of the upstream cell: second order without
    widening the Newton matrix.
    """
    ratio = carried / conductance
    peclet = np.maximum(ratio[1:], ratio[:-1])
    step = gap[1:] - gap[:-1]
    before = np.zeros_like(step)
    if from_a:
        before[:-1] = step[1:]
    else:
        before[1:] = step[:-1]
    product = before * step
    limited = np.where(product > 0, product / np.where(product > 0, before + step, 1.0), 0.0)
    return Upwinding(peclet**2 / (1 + peclet**2), -limited if from_a else limited)


def _smoothness(a: Array, b: Array) -> tuple[Array, Array]:
    """Return 1 between gaps alike, 0 across a step, and the derivative by ln(a / b)."""
    ratio = np.log(a / b)
    place = np.clip((np.abs(ratio) - SMOOTH) / (STEP - SMOOTH), 0.0, 1.0)
    value = 1 - place * place * (3 - 2 * place)
    return value, -6 * place * (1 - place) / (STEP - SMOOTH) * np.sign(ratio)
