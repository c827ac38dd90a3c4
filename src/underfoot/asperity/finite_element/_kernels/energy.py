"""Energies of all elements at one moment: a plain loop, for samples and checks."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from .generate import LANES, VISCOUS_ROWS
from .names import BULK, G0, HOURGLASS, HOURGLASS_LOSS, LEAST_J, LOSS_RATE, STRAIN

SIGNS = (
    (-1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0),
    (-1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0),
    (-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0),
)


@njit(cache=True, error_model="numpy")
def element_energies(u, mesh, E, Q, control, terms, viscous, state):
    """Put strain and hourglass energy, rate of loss, lost energy and the least J into ``state``.

    Strain energy W0 - sum Q_i:S / (2 G0) + sum Q_i:Q_i / (4 G_i) and loss sum b_i |g_i S - Q_i|^2 /
    (2 G_i): exact for small distortions, and exact at any for the part that has not relaxed.
    ``terms`` is (n, 2): G_i and b_i.
    """
    offsets, real = mesh[0], mesh[10]
    stride = u.size // 3
    first = VISCOUS_ROWS if viscous else 0
    g0, bulk = control[G0], control[BULK]
    strain = hourglass = rate = lost = 0.0
    least = 1e300
    m = np.zeros((3, 7))
    h = np.zeros((3, 3))
    for e in real:
        c, lane = e // LANES, e % LANES
        for i in range(3):
            for q in range(7):
                m[i, q] = 0.0
            for a in range(8):
                w = u[i * stride + e + offsets[a]]
                x, y, z = SIGNS[0][a], SIGNS[1][a], SIGNS[2][a]
                m[i, 0] += w * x
                m[i, 1] += w * y
                m[i, 2] += w * z
                m[i, 3] += w * y * z
                m[i, 4] += w * x * z
                m[i, 5] += w * x * y
                m[i, 6] += w * x * y * z
            for j in range(3):
                h[i, j] = 0.0
                for q in range(7):
                    h[i, j] += m[i, q] * E[c, (7 * j + q) * LANES + lane]
        volume = float(E[c, 33 * LANES + lane])
        dj = (
            h[0, 0]
            + h[1, 1]
            + h[2, 2]
            + h[0, 0] * h[1, 1]
            - h[0, 1] * h[1, 0]
            + h[0, 0] * h[2, 2]
            - h[0, 2] * h[2, 0]
            + h[1, 1] * h[2, 2]
            - h[1, 2] * h[2, 1]
            + h[0, 0] * (h[1, 1] * h[2, 2] - h[1, 2] * h[2, 1])
            - h[0, 1] * (h[1, 0] * h[2, 2] - h[1, 2] * h[2, 0])
            + h[0, 2] * (h[1, 0] * h[2, 1] - h[1, 1] * h[2, 0])
        )
        jac = 1.0 + dj
        # Written so that a NaN is taken as an inverted element.
        if not jac > 0.0:
            least = min(least, -1.0)
            continue
        least = min(least, jac)
        trace = h[0, 0] + h[1, 1] + h[2, 2]
        square = 0.0
        for i in range(3):
            for j in range(3):
                square += h[i, j] * h[i, j]
        i1 = 3.0 + 2.0 * trace + square
        y2 = math.exp(-2.0 / 3.0 * math.log1p(dj))
        strain += volume * (0.5 * g0 * (y2 * i1 - 3.0) + 0.5 * bulk * dj * dj)
        energy = 0.0
        for i in range(3):
            for a in range(4):
                d = 0.125 * m[i, 3 + a]
                for j in range(3):
                    d -= E[c, (21 + 3 * a + j) * LANES + lane] * h[i, j]
                energy += d * d
        hourglass += 0.5 * E[c, 34 * LANES + lane] * energy
        if viscous:
            lost += Q[c, 13 * LANES + lane]
        if terms.shape[0] == 0:
            continue
        f00, f11, f22 = 1.0 + h[0, 0], 1.0 + h[1, 1], 1.0 + h[2, 2]
        c00 = f11 * f22 - h[1, 2] * h[2, 1]
        c01 = h[1, 2] * h[2, 0] - h[1, 0] * f22
        c02 = h[1, 0] * h[2, 1] - f11 * h[2, 0]
        c10 = h[0, 2] * h[2, 1] - h[0, 1] * f22
        c11 = f00 * f22 - h[0, 2] * h[2, 0]
        c12 = h[0, 1] * h[2, 0] - f00 * h[2, 1]
        c20 = h[0, 1] * h[1, 2] - h[0, 2] * f11
        c21 = h[0, 2] * h[1, 0] - f00 * h[1, 2]
        c22 = f00 * f11 - h[0, 1] * h[1, 0]
        alpha = g0 * y2
        gamma = alpha * i1 / (3.0 * jac * jac)
        s = (
            alpha - gamma * (c00 * c00 + c10 * c10 + c20 * c20),
            alpha - gamma * (c01 * c01 + c11 * c11 + c21 * c21),
            alpha - gamma * (c02 * c02 + c12 * c12 + c22 * c22),
            -gamma * (c00 * c01 + c10 * c11 + c20 * c21),
            -gamma * (c00 * c02 + c10 * c12 + c20 * c22),
            -gamma * (c01 * c02 + c11 * c12 + c21 * c22),
        )
        for term in range(terms.shape[0]):
            modulus, decay = terms[term, 0], terms[term, 1]
            share = modulus / g0
            mixed = own = over = 0.0
            for n in range(6):
                twice = 1.0 if n < 3 else 2.0
                q = Q[c, (first + 6 * term + n) * LANES + lane]
                d = share * s[n] - q
                mixed += twice * q * s[n]
                own += twice * q * q
                over += twice * d * d
            strain += volume * (0.25 * own / modulus - 0.5 * mixed / g0)
            rate += volume * 0.5 * decay * over / modulus
    state[STRAIN] = strain
    state[HOURGLASS] = hourglass
    state[LOSS_RATE] = rate
    state[HOURGLASS_LOSS] = lost
    state[LEAST_J] = least
