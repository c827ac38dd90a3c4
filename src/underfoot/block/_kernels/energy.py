"""Energies of all elements at one moment: a plain loop, for samples and checks."""

import math

import numpy as np
from numba import njit

from . import names as at
from .generate import LANES, SYMMETRIC, VISCOUS_ROWS
from .hexahedron import SIGNS


@njit(cache=True, inline="always")
def _cofactors(matrix, out):
    for i in range(3):
        a, b = (i + 1) % 3, (i + 2) % 3
        for j in range(3):
            k, m = (j + 1) % 3, (j + 2) % 3
            out[i, j] = matrix[a, k] * matrix[b, m] - matrix[a, m] * matrix[b, k]


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
    g0, bulk = control[at.G0], control[at.BULK]
    strain = hourglass = rate = lost = 0.0
    least = 1e300
    m = np.zeros((3, 7))
    h = np.zeros((3, 3))
    c = np.zeros((3, 3))
    s = np.zeros(6)
    for e in real:
        chunk, lane = e // LANES, e % LANES
        for i in range(3):
            for q in range(7):
                m[i, q] = 0.0
            for a in range(8):
                w = u[i * stride + e + offsets[a]]
                x, y, z = SIGNS[a, 0], SIGNS[a, 1], SIGNS[a, 2]
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
                    h[i, j] += m[i, q] * E[chunk, (7 * j + q) * LANES + lane]
        volume = float(E[chunk, 33 * LANES + lane])
        # J - 1 = trace + sum of minors + determinant of H: exact also where H is tiny
        _cofactors(h, c)
        trace = h[0, 0] + h[1, 1] + h[2, 2]
        dj = trace + c[0, 0] + c[1, 1] + c[2, 2]
        dj += h[0, 0] * c[0, 0] + h[0, 1] * c[0, 1] + h[0, 2] * c[0, 2]
        jac = 1.0 + dj
        # Written so that a NaN is taken as an inverted element.
        if not jac > 0.0:
            least = min(least, -1.0)
            continue
        least = min(least, jac)
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
                    d -= E[chunk, (21 + 3 * a + j) * LANES + lane] * h[i, j]
                energy += d * d
        hourglass += 0.5 * E[chunk, 34 * LANES + lane] * energy
        if viscous:
            lost += Q[chunk, 13 * LANES + lane]
        if terms.shape[0] == 0:
            continue
        for i in range(3):
            h[i, i] += 1.0
        _cofactors(h, c)
        alpha = g0 * y2
        gamma = alpha * i1 / (3.0 * jac * jac)
        for n in range(6):
            i, j = SYMMETRIC[n]
            inner = c[0, i] * c[0, j] + c[1, i] * c[1, j] + c[2, i] * c[2, j]
            s[n] = (alpha if i == j else 0.0) - gamma * inner
        for term in range(terms.shape[0]):
            modulus, decay = terms[term, 0], terms[term, 1]
            share = modulus / g0
            mixed = own = over = 0.0
            for n in range(6):
                twice = 1.0 if n < 3 else 2.0
                q = Q[chunk, (first + 6 * term + n) * LANES + lane]
                d = share * s[n] - q
                mixed += twice * q * s[n]
                own += twice * q * q
                over += twice * d * d
            strain += volume * (0.25 * own / modulus - 0.5 * mixed / g0)
            rate += volume * 0.5 * decay * over / modulus
    state[at.STRAIN] = strain
    state[at.HOURGLASS] = hourglass
    state[at.LOSS_RATE] = rate
    state[at.HOURGLASS_LOSS] = lost
    state[at.LEAST_J] = least
