"""Reference films of soft contacts, by other means than the coupled solver's.

Shares no line with ``underfoot``: graded grids that reach far out, dense influence matrices,
central differences for the gap (the solver: equal cells, Fourier transforms, gaps in series with
upwinding), a primal-dual active set with a dense factorization, Richardson's extrapolation.

``python tests/reference_soft_ehl.py`` writes ``tests/data/soft_ehl_reference.csv`` (2 minutes of
a core, 1.2 GB).

Sliding point contact, lengths X = x / a along, H = h R / a^2, P = p / p_Hertz:

    div(H^3 grad P) = lambda dH/dX where P > 0,  H = -D + (X^2 + Y^2) / 2 + (2 / pi^2) int P / r
    int P = 2 pi / 3,  lambda = 6 eta V R^2 / (a^3 p_Hertz) = (128 pi^3 / (3 M^4))^(1/3)
    M = F / (E' R^2) (eta V / (E' R))^(-3/4),  E' = 2 E*

so that one number M says all. The fluid comes from -X; Reynolds' condition at the exit.
"""

from __future__ import annotations

import csv
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.integrate import quad
from scipy.interpolate import RectBivariateSpline
from scipy.linalg import lu_factor, lu_solve
from scipy.optimize import minimize
from scipy.special import ellipkm1

LOADS = (100.0, 177.83, 300.0)
GRIDS = (12, 18, 27, 36)  # cells of the finest part in a contact radius
TABLE = Path(__file__).parent / "data" / "soft_ehl_reference.csv"


class PointContact(NamedTuple):
    """Central and least film H = h R / a^2, highest P, place of the least film (X, |Y|)."""

    central: float
    least: float
    peak: float
    place: tuple[float, float]
    cells: int
    steps: int
    fields: tuple  # X, Y, pressure, approach


def load_parameter(*, force, effective_modulus, radius, viscosity, speed):
    """Return M; ``effective_modulus`` is E' = 2 E*, ``speed`` the sum of both surfaces'."""
    moving = viscosity * speed / (effective_modulus * radius)
    return force / (effective_modulus * radius**2) * moving**-0.75


def speed_parameter(load):
    """Return lambda of M."""
    return (128 * np.pi**3 / (3 * load**4)) ** (1 / 3)


def graded_faces(start, end, finest, fine):
    """Return cell faces: ``finest`` in the interval ``fine``, growing gently out of it, more so
    outside the contact."""

    def ramp(beyond):
        return 0.05 * np.logaddexp(0.0, beyond / 0.05)

    x = np.linspace(start, end, 4001)
    away = np.maximum(fine[0] - x, x - fine[1])
    size = finest * (1 + 0.8 * ramp(away) + 2.2 * ramp(np.abs(x) - 1.2))
    count = np.concatenate([[0], np.cumsum(0.5 * (1 / size[1:] + 1 / size[:-1]) * np.diff(x))])
    return np.interp(np.linspace(0, count[-1], round(count[-1]) + 1), count, x)


def love(x, y, low_x, high_x, low_y, high_y):
    """Return the integral of 1/r over rectangles (Love 1929)."""

    def corner(a, b):
        r = np.hypot(a, b)
        return a * np.log(b + r) + b * np.log(a + r)

    a, b, c, d = x - low_x, x - high_x, y - low_y, y - high_y
    return corner(a, c) + corner(b, d) - corner(a, d) - corner(b, c)


def influence(faces_x, faces_y):
    """Return the deflections at cell centres by pressures on cells and their mirrors in Y = 0."""
    x, y = (0.5 * (f[1:] + f[:-1]) for f in (faces_x, faces_y))
    nx, ny = x.size, y.size
    out = np.empty((nx, ny, nx, ny))
    low, high = faces_y[:-1], faces_y[1:]
    for i in range(nx):
        at = (x[i], y[:, None, None], faces_x[:-1, None], faces_x[1:, None])
        out[i] = love(*at, low, high) + love(*at, -high, -low)
    return (2 / np.pi**2) * out.reshape(nx * ny, nx * ny)


class Operators(NamedTuple):
    """Sparse maps between cells and faces of a graded grid (one direction)."""

    slope: sp.csr_matrix  # pressure gradient on faces, 0 outside the grid
    middle: sp.csr_matrix  # gap on faces, linear between cells
    outflow: sp.csr_matrix  # faces to cells, times the width of the face


def operators(faces, widths, axis, *, mirror):
    """Return the maps for one direction; ``mirror`` closes the first face."""
    centre = 0.5 * (faces[1:] + faces[:-1])
    n = centre.size
    slope, middle = (sp.lil_matrix((n + 1, n)) for _ in range(2))
    for f in range(1, n):
        gap = centre[f] - centre[f - 1]
        slope[f, f - 1], slope[f, f] = -1 / gap, 1 / gap
        share = (faces[f] - centre[f - 1]) / gap
        middle[f, f - 1], middle[f, f] = 1 - share, share
    for f, c in ((0, 0), (n, n - 1)):
        middle[f, c] = 1.0
        if not (mirror and f == 0):
            slope[f, c] = (1 if f == 0 else -1) / abs(faces[f] - centre[c])
    out = sp.diags([-1.0, 1.0], [0, 1], shape=(n, n + 1))
    here = sp.identity(widths.size)
    if axis == 0:
        along = [sp.kron(m, here) for m in (slope, middle)]
        return Operators(*map(sp.csr_matrix, along), sp.csr_matrix(sp.kron(out, sp.diags(widths))))
    along = [sp.kron(here, m) for m in (slope, middle)]
    return Operators(*map(sp.csr_matrix, along), sp.csr_matrix(sp.kron(sp.diags(widths), out)))


def point_contact(
    load,
    finest,
    *,
    inlet=5.0,
    outlet=2.0,
    aside=4.0,
    rigid=False,
    start=None,
    most=60,
    tell=None,
):
    """Return the film of the sliding point contact at M = ``load``; ``finest`` cell of a = 1.

    ``start`` is a solution on a coarser grid. ``rigid`` leaves the deflection out; with ``outlet``
    0 the solution is then Kapitza's half, P = -(lambda / 5) X / H^2 for a sphere.
    """
    faces_x = graded_faces(-inlet, outlet, finest, (0.1, 1.15))
    faces_y = graded_faces(0.0, aside, finest, (0.6, 1.1))
    x, y = (0.5 * (f[1:] + f[:-1]) for f in (faces_x, faces_y))
    dx, dy = np.diff(faces_x), np.diff(faces_y)
    area = np.outer(dx, dy).ravel()
    bend = influence(faces_x, faces_y)
    if rigid:
        bend = np.zeros_like(bend)
    own = np.diagonal(bend).copy()
    along = operators(faces_x, dy, 0, mirror=False)
    across = operators(faces_y, dx, 1, mirror=True)
    rate = speed_parameter(load)
    shape = ((x[:, None] ** 2 + y**2) / 2).ravel()
    pressure = np.sqrt(np.maximum(0.0, 1 - 2 * shape))
    film = 0.4 * rate**0.6  # a guess
    approach = float((shape + bend @ pressure)[np.argmin(shape)] - film)
    if start is not None:
        old_x, old_y, old, approach = start.fields
        spline = RectBivariateSpline(old_x, old_y, old, kx=1, ky=1)
        pressure = np.maximum(spline(x, y), 0.0).ravel()
    change = np.inf
    for step in range(most):
        gap = shape - approach + bend @ pressure
        flow, by_gap, by_pressure = 0.0, 0.0, 0.0
        for maps, moving in ((along, rate), (across, 0.0)):
            face, drop = maps.middle @ gap, maps.slope @ pressure
            flux = -(face**3) * drop
            slope_gap = sp.diags(-3 * face**2 * drop) @ maps.middle
            if moving:
                flux = flux + moving * face
                slope_gap = slope_gap + moving * maps.middle
            flow = flow + maps.outflow @ flux
            by_gap = by_gap + maps.outflow @ slope_gap
            by_pressure = by_pressure - maps.outflow @ sp.diags(face**3) @ maps.slope
        by_gap, by_pressure = sp.csr_matrix(by_gap), sp.csr_matrix(by_pressure)
        scale = by_pressure.diagonal() + np.abs(by_gap.diagonal()) * own
        film = pressure - flow / scale > 0
        wrong = np.abs(flow[film]).sum() / (rate * 2 * dy.sum()) + np.abs(pressure[~film]).max(
            initial=0.0
        )
        short = np.pi / 3 - area @ pressure
        if tell:
            tell(f"  {step:3d} {wrong:.2e} {short:+.2e} {change:.2e} {film.sum()}")
        if max(wrong, abs(short), change) < 1e-8:
            break
        # the void's pressures go to 0 at once, the film's follow
        rest = np.where(film, 0.0, -pressure)
        active = np.flatnonzero(film)
        matrix = np.empty((active.size + 1, active.size + 1))
        rows = by_gap[active]
        matrix[:-1, :-1] = rows @ bend[:, active]
        matrix[:-1, :-1] += by_pressure[active][:, active].toarray()
        matrix[:-1, -1] = -np.asarray(rows.sum(axis=1)).ravel()
        matrix[-1, :-1] = area[active]
        matrix[-1, -1] = 0.0
        right = -flow[active] - rows @ (bend @ rest) - (by_pressure @ rest)[active]
        right = np.append(right, short - area @ rest)
        size = np.append(scale[active], 1.0)
        found = lu_solve(
            lu_factor(matrix / size[:, None], overwrite_a=True, check_finite=False), right / size
        )
        delta = rest.copy()
        delta[active] = found[:-1]
        rise = bend @ delta - found[-1]
        share = min(1.0, float((0.6 * gap / np.maximum(-rise, 1e-30)).min()))
        share = min(share, float((3 * gap / np.maximum(rise, 1e-30)).min()))
        pressure = pressure + share * delta
        approach += share * found[-1]
        change = float(np.abs(delta).max()) if share == 1 else np.inf
    else:
        raise RuntimeError(f"the reference at M = {load} did not converge")
    fields = (x, y, pressure.reshape(x.size, -1), approach)
    return _measured(gap.reshape(x.size, -1), fields, step)


def _measured(gap, fields, steps):
    x, y, pressure, _ = fields
    both = np.concatenate([-y[::-1], y])
    film = RectBivariateSpline(x, both, np.concatenate([gap[:, ::-1], gap], axis=1), kx=3, ky=3)
    press = RectBivariateSpline(x, both, np.concatenate([pressure[:, ::-1], pressure], axis=1))
    i, j = np.unravel_index(np.argmin(gap), gap.shape)
    least = minimize(lambda at: film(*at)[0, 0], (x[i], y[j]), method="Nelder-Mead", tol=1e-10)
    i, j = np.unravel_index(np.argmax(pressure), gap.shape)
    peak = minimize(lambda at: -press(*at)[0, 0], (x[i], y[j]), method="Nelder-Mead", tol=1e-10)
    place = (float(least.x[0]), abs(float(least.x[1])))
    central = float(film(0.0, 0.0)[0, 0])
    return PointContact(central, float(least.fun), -float(peak.fun), place, gap.size, steps, fields)


def ring_influence(faces, plane_modulus):
    """Return the deflection of a half-space at ring centres by unit pressure on rings, m/Pa.

    w(r) = 4 / (pi E*) int p(s) s K(m) / (r + s) ds,  m = 4 r s / (r + s)^2  (Johnson 1985, 3.8)
    """
    centre = 0.5 * (faces[1:] + faces[:-1])

    def kernel(s, r):
        return s / (r + s) * ellipkm1(((r - s) / (r + s)) ** 2)

    nodes, weights = np.polynomial.legendre.leggauss(8)
    half = 0.5 * np.diff(faces)
    points = centre + half * nodes[:, None]
    out = np.einsum("g,gij->ij", weights, kernel(points[:, None, :], centre[:, None])) * half
    for i, r in enumerate(centre):
        for j in range(max(0, i - 1), min(centre.size, i + 2)):
            parts = sorted({faces[j], faces[j + 1], r} if i == j else {faces[j], faces[j + 1]})
            ends = pairwise(parts)
            out[i, j] = sum(quad(kernel, *pair, args=(r,), epsrel=1e-10)[0] for pair in ends)
    return 4 / (np.pi * plane_modulus) * out


def squeeze(
    *, radius, plane_modulus, viscosity, force, rise_time, end_time, start, outer, rings, steps
):
    """Return centre and least film (m) under a sphere pressed on a flooded half-space at the end.

    12 eta dh/dt = (1 / r) d(r h^3 dp/dr)/dr, p = 0 at ``outer``; the force rises linearly.
    Second-order backward differences of equal steps, the first one Euler's.
    """
    faces = np.linspace(0.0, outer, rings + 1)
    centre, area = 0.5 * (faces[1:] + faces[:-1]), np.pi * np.diff(faces**2)
    bend = ring_influence(faces, plane_modulus)
    slope = sp.diags([1.0, -1.0], [1, 0], shape=(rings - 1, rings)).toarray() / np.diff(faces)[0]
    slope = np.vstack([np.zeros(rings), slope, np.zeros(rings)])
    slope[-1, -1] = -2 / np.diff(faces)[0]
    middle = abs(slope) * 0.5 * np.diff(faces)[0]
    middle[-1, -1] = 1.0
    out = sp.diags([-1.0, 1.0], [0, 1], shape=(rings, rings + 1)).toarray()
    out = out * (2 * np.pi * faces) / (12 * viscosity)
    shape = start + centre**2 / (2 * radius)
    pressure, approach, gap, older = np.zeros(rings), 0.0, shape, shape
    step = end_time / steps
    for count in range(1, steps + 1):
        lead = 1.0 if count == 1 else 1.5
        past = gap if count == 1 else 2 * gap - 0.5 * older
        older = gap
        load = force * min(1.0, count * step / rise_time)
        for _ in range(40):
            gap = shape - approach + bend @ pressure
            face, drop = middle @ gap, slope @ pressure
            wrong = (lead * gap - past) * area / step - out @ (face**3 * drop)
            by_gap = np.diag(lead * area / step) - out @ ((3 * face**2 * drop)[:, None] * middle)
            by_pressure = by_gap @ bend - out @ (face[:, None] ** 3 * slope)
            matrix = np.block([[by_pressure, -by_gap.sum(axis=1)[:, None]], [area[None], 0.0]])
            found = np.linalg.solve(matrix, np.append(-wrong, load - area @ pressure))
            rise = bend @ found[:-1] - found[-1]
            share = min(1.0, float((0.7 * gap / np.maximum(-rise, 1e-30)).min()))
            pressure = pressure + share * found[:-1]
            approach += share * found[-1]
            if share == 1.0 and np.abs(rise).max() < 1e-10 * np.abs(gap).max():
                break
        else:
            raise RuntimeError("the reference squeeze film did not converge")
        gap = shape - approach + bend @ pressure
    return float(gap[0]), float(gap.min())


def extrapolated(rows):
    """Return central and least film for cells of size 0 and how far the coarser grids are off.

    ``rows``: (cells in a radius, central, least). Richardson's extrapolation of the three finest
    grids with the order that they show, at least 2 and at most 3; the uncertainty is the distance
    to what the second order would give.
    """
    (a, *coarse), (b, *middle), (c, *fine) = sorted(rows)[-3:]
    best, unsure = [], []
    for f, g, h in zip(coarse, middle, fine, strict=True):
        orders = np.linspace(2, 3, 1001)
        ratio = (a**-orders - b**-orders) / (b**-orders - c**-orders)
        order = orders[np.argmin(np.abs(ratio - (g - f) / (h - g)))]
        limits = [h + (h - g) / ((c / b) ** power - 1) for power in (order, 2.0)]
        best.append(limits[0])
        unsure.append(abs(limits[1] / limits[0] - 1))
    return np.array(best), np.array(unsure)


def table():
    """Return {M: [(cells in a radius, central, least), ...]} as stored."""
    found = {}
    with TABLE.open(newline="") as file:
        for row in csv.DictReader(file):
            values = (int(row["cells_in_radius"]), float(row["central"]), float(row["least"]))
            found.setdefault(float(row["load_parameter"]), []).append(values)
    return found


def write_table():
    """Compute and write the table."""
    with TABLE.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["load_parameter", "cells_in_radius", "central", "least", "peak"])
        for load in LOADS:
            start = None
            for grid in GRIDS:
                start = point_contact(load, 1 / grid, start=start)
                films = (f"{v:.8g}" for v in (start.central, start.least, start.peak))
                out.writerow([repr(load), grid, *films])
                file.flush()


if __name__ == "__main__":
    write_table()
