"""Height and slope of a rough face at one point; both from the same polynomials, so they agree."""

import numpy as np
from numba import njit


@njit(cache=True, inline="always")
def _wave(turns):
    """Return cos and sin of 2 pi ``turns`` by Taylor series on an eighth turn (error 2e-16)."""
    t = turns - np.rint(turns)
    quarter = np.rint(4.0 * t)
    a = 2.0 * np.pi * (t - 0.25 * quarter)
    b = a * a
    s = -1.0 / 39916800.0 + b * (1.0 / 6227020800.0)
    s = 1.0 / 362880.0 + b * s
    s = -1.0 / 5040.0 + b * s
    s = -1.0 / 6.0 + b * (1.0 / 120.0 + b * s)
    s = a * (1.0 + b * s)
    c = 1.0 / 479001600.0 + b * (-1.0 / 87178291200.0)
    c = -1.0 / 3628800.0 + b * c
    c = 1.0 / 40320.0 + b * c
    c = 1.0 / 24.0 + b * (-1.0 / 720.0 + b * c)
    c = 1.0 + b * (-0.5 + b * c)
    # quarter is -2 to 2; "odd" is 1 for a quarter turn, "turned" is -1 for half a turn.
    square = quarter * quarter
    odd = square * (4.0 - square) / 3.0
    turned = 1.0 - square * (square - 1.0) / 6.0
    even = (1.0 - odd) * turned
    return even * c - odd * quarter * s, even * s + odd * quarter * c


@njit(cache=True, inline="always")
def _triangle(turns):
    """Return the straight-flanked wave of height 1 (peak at 0) and its slope a turn."""
    t = turns - np.floor(turns)
    return (1.0 - 4.0 * t, -4.0) if t < 0.5 else (4.0 * t - 3.0, 4.0)


@njit(cache=True, inline="always")
def _weights(t):
    r = 1.0 - t
    w0 = r * r * r / 6.0
    w1 = (4.0 + t * t * (3.0 * t - 6.0)) / 6.0
    w2 = (4.0 + r * r * (3.0 * r - 6.0)) / 6.0
    w3 = t * t * t / 6.0
    d0 = -0.5 * r * r
    d1 = 0.5 * t * (3.0 * t - 4.0)
    d2 = -0.5 * r * (3.0 * r - 4.0)
    d3 = 0.5 * t * t
    return (w0, w1, w2, w3), (d0, d1, d2, d3)


@njit(cache=True)
def _spline(x, y, coefficients):
    """Return the periodic cubic spline and its slopes; x and y in grid steps."""
    nx, ny = coefficients.shape
    ix, iy = np.floor(x), np.floor(y)
    wx, dx = _weights(x - ix)
    wy, dy = _weights(y - iy)
    i0, j0 = int(ix) - 1, int(iy) - 1
    h = hx = hy = 0.0
    for a in range(4):
        i = (i0 + a) % nx
        row = slope = 0.0
        for b in range(4):
            c = coefficients[i, (j0 + b) % ny]
            row += wy[b] * c
            slope += dy[b] * c
        h += wx[a] * row
        hx += dx[a] * row
        hy += wx[a] * slope
    return h, hx, hy


@njit(cache=True, inline="always")
def cosine_floor(x, y, numbers):
    """Return height and slopes of the checkerboard of two cosines."""
    a, rate = numbers[0], numbers[1]
    cx, sx = _wave((x - numbers[2]) * rate)
    cy, sy = _wave((y - numbers[3]) * rate)
    k = 2.0 * np.pi * rate
    return a * cx * cy, -a * k * sx * cy, -a * k * cx * sy


@njit(cache=True, inline="always")
def floor_height(x, y, form, numbers, coefficients):
    """Return height and both slopes at (x, y); forms as in ``surface.FORMS``."""
    if form == 1:
        return cosine_floor(x, y, numbers)
    a, rate = numbers[0], numbers[1]
    x = x - numbers[2]
    y = y - numbers[3]
    if form == 2:
        tx, dx = _triangle(x * rate)
        ty, dy = _triangle(y * rate)
        return a * tx * ty, a * rate * dx * ty, a * rate * tx * dy
    if form == 3:
        cx, sx = _wave(x * rate)
        return a * cx, -a * 2.0 * np.pi * rate * sx, 0.0
    if form == 4:
        c = numbers[4]
        return -0.5 * c * (x * x + y * y), -c * x, -c * y
    if form == 5:
        h, hx, hy = _spline(x / numbers[5], y / numbers[6], coefficients)
        return h, hx / numbers[5], hy / numbers[6]
    return 0.0, 0.0, 0.0


@njit(cache=True)
def floor_at_points(x, y, form, numbers, coefficients):
    """Return height and slopes, (3, n), at points (n,)."""
    out = np.empty((3, x.size))
    for n in range(x.size):
        out[0, n], out[1, n], out[2, n] = floor_height(x[n], y[n], form, numbers, coefficients)
    return out
