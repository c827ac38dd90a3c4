"""Finite volumes of a film that may be partly filled: pressure flow, carried flow, coarser grids.

Arrays are (nx, ny); x faces (nx - 1, ny), y faces (nx, ny - 1). Pressure p and liquid fraction
theta share one equation per cell; the flow through an x face is

    q = c theta_upstream - k (p_east - p_west),   c = dy w_c

with the conductance k of two half-cells in series and w_c, the flow the walls carry (m^2/s),
weighted as the gap is in ``flux``. Both operators lose nothing: the columns of their matrices sum
to what leaves the film, so any mixture of their columns is an M-matrix and can be factorised
without pivoting.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .flux import Stencil, series_conductance, shear_gap

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Film:
    """Everything that fixes the film of one instant; arrays (nx, ny)."""

    gap: Array  # m, finite and positive everywhere
    along: Array  # phi_x h^3 / (12 eta), m^3/(Pa s)
    across: Array  # phi_y h^3 / (12 eta)
    carried: Array  # flow per width that the walls carry along +x when full, m^2/s
    mask: NDArray[np.bool_]  # True where the film is solved for
    rim_pressure: Array  # Pa, used where not mask
    rim_fraction: Array  # 1
    dx: float
    dy: float
    storage: Array | None  # area over time step, m^2/s; None for a steady film
    content: Array  # liquid of the step before, m


@dataclass(frozen=True, slots=True)
class Operators:
    """Face coefficients and five-point stencils of pressure and of liquid fraction."""

    kx: Array
    ky: Array
    carry: Array  # m^3/s through each x face at fraction 1
    by_pressure: Stencil
    by_fraction: Stencil


def operators(film: Film) -> Operators:
    """Return the discrete flows of ``film``."""
    nil = np.zeros_like(film.gap)
    kx = _series(film.along[1:], film.along[:-1]) * (film.dy / film.dx)
    ky = _series(film.across[:, 1:], film.across[:, :-1]) * (film.dx / film.dy)
    a, b = film.carried[1:], film.carried[:-1]
    ka, kb = film.along[1:], film.along[:-1]
    carry = film.dy * shear_gap(a, b, ka, kb, nil[1:], nil[1:])[0]

    centre, east, west, north, south = (np.zeros_like(film.gap) for _ in range(5))
    centre[1:] += kx
    centre[:-1] += kx
    centre[:, 1:] += ky
    centre[:, :-1] += ky
    east[:-1], west[1:] = -kx, -kx
    north[:, :-1], south[:, 1:] = -ky, -ky
    by_pressure = Stencil(centre, east, west, north, south)

    forward, backward = np.maximum(carry, 0.0), np.minimum(carry, 0.0)
    centre, east, west = (np.zeros_like(film.gap) for _ in range(3))
    centre[:-1] += forward
    centre[1:] -= backward
    west[1:] = -forward
    east[:-1] = backward
    if film.storage is not None:
        centre += film.storage * film.gap
    return Operators(kx, ky, carry, by_pressure, Stencil(centre, east, west, nil, nil))


def net_outflow(film: Film, parts: Operators, pressure: Array, fraction: Array) -> Array:
    """Return what leaves each cell plus what it stores, m^3/s: 0 where volume is conserved."""
    upstream = np.where(parts.carry > 0, fraction[:-1], fraction[1:])
    flux_x = parts.carry * upstream - parts.kx * (pressure[1:] - pressure[:-1])
    flux_y = -parts.ky * (pressure[:, 1:] - pressure[:, :-1])
    outflow = np.zeros_like(film.gap)
    outflow[:-1] += flux_x
    outflow[1:] -= flux_x
    outflow[:, :-1] += flux_y
    outflow[:, 1:] -= flux_y
    if film.storage is not None:
        outflow += film.storage * (film.gap * fraction - film.content)
    return outflow


def largest_flow(film: Film, parts: Operators, pressure: Array, fraction: Array) -> float:
    """Return the largest flow (m^3/s) into a face or store: the scale of an imbalance."""
    sizes = [np.abs(parts.carry), np.abs(parts.kx * (pressure[1:] - pressure[:-1]))]
    sizes.append(np.abs(parts.ky * (pressure[:, 1:] - pressure[:, :-1])))
    if film.storage is not None:
        sizes.append(film.storage * film.gap)
        sizes.append(film.storage * film.content)
    return max(float(part.max(initial=0.0)) for part in sizes)


def coarser(film: Film, fewest: int) -> Film | None:
    """Return the film on cells twice as large, or None when no axis can lose half its cells."""
    axes = tuple(axis for axis in (0, 1) if film.gap.shape[axis] >= fewest)
    if not axes:
        return None

    def halved(field: Array) -> Array:
        for axis in axes:
            if field.shape[axis] % 2:
                field = np.concatenate([field, np.take(field, [-1], axis)], axis=axis)
            pairs = [slice(None), slice(None)]
            odd = list(pairs)
            pairs[axis], odd[axis] = slice(None, None, 2), slice(1, None, 2)
            field = 0.5 * (field[tuple(pairs)] + field[tuple(odd)])
        return field

    mask = halved(film.mask.astype(float)) > 0.5
    if not mask.any():
        return None
    scale = 2.0 ** len(axes)
    return replace(
        film,
        gap=halved(film.gap),
        along=halved(film.along),
        across=halved(film.across),
        carried=halved(film.carried),
        mask=mask,
        rim_pressure=halved(film.rim_pressure),
        rim_fraction=halved(film.rim_fraction),
        dx=film.dx * (2 if 0 in axes else 1),
        dy=film.dy * (2 if 1 in axes else 1),
        storage=None if film.storage is None else halved(film.storage) * scale,
        content=halved(film.content),
    )


def finer(field: Array, shape: tuple[int, ...]) -> Array:
    """Return a coarse ``field`` on the grid of ``shape``, linear between cell centres."""
    for axis in (0, 1):
        if field.shape[axis] == shape[axis]:
            continue
        size = field.shape[axis]
        before = np.take(field, np.maximum(np.arange(size) - 1, 0), axis)
        after = np.take(field, np.minimum(np.arange(size) + 1, size - 1), axis)
        pair = np.stack([0.75 * field + 0.25 * before, 0.75 * field + 0.25 * after], axis + 1)
        field = pair.reshape(*field.shape[:axis], 2 * size, *field.shape[axis + 1 :])
    return field[: shape[0], : shape[1]]


def _series(ka: Array, kb: Array) -> Array:
    nil = np.zeros_like(ka)
    return series_conductance(ka, kb, nil, nil)[0]
