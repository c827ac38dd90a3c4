"""Shear stress that a film puts on both walls."""

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import positive


def wall_shear(
    pressure: ArrayLike,
    gap: ArrayLike,
    *,
    spacing: float,
    viscosity: float,
    speed: float,
    fraction: ArrayLike = 1.0,
) -> tuple[Array, Array]:
    """Return the shear stress (Pa) on the lower wall and on the upper wall, each (nx, ny).

    lower = theta eta V / h - (h / 2) dp/dx,   upper = theta eta V / h + (h / 2) dp/dx

    Both positive when the film holds the walls back: the lower one is dragged along +x, the upper
    one, which slides at V along +x, along -x. Where the film has ruptured, the streamers that are
    left shear over the share theta of the area.

    Parameters:
        pressure, gap, fraction: (nx, ny) Pa, m, theta; as ``film_pressure`` gives them. An open gap
            (inf) has no shear.
        spacing: Cell size along x, m.
        viscosity, speed: Pa s; sliding speed V, m/s.

    Newtonian fluid, no slip at the walls, smooth. Second order inside, first at the array's ends.
    Source: Reynolds 1886.
    """
    p, h = np.asarray(pressure, dtype=float), np.asarray(gap, dtype=float)
    theta = np.asarray(fraction, dtype=float)
    if p.ndim != 2 or p.shape != h.shape or theta.shape not in ((), p.shape):
        raise InputError("pressure and gap do not go together", where="gap", allowed="(nx, ny)")
    if p.shape[0] < 2:
        raise InputError("one row has no slope", where="pressure", allowed="two cells along x")
    if not (np.isfinite(p).all() and np.isfinite(theta).all() and np.isfinite(speed)):
        raise InputError("a value is not finite", where="pressure, fraction or speed")
    if not (h > 0).all():
        raise InputError("the gap is not positive everywhere", where="gap", allowed="above 0, in m")
    slope = np.gradient(p, positive(spacing, "spacing"), axis=0)
    along = theta * positive(viscosity, "viscosity") * speed / h
    push = 0.5 * np.where(np.isfinite(h), h, 0.0) * slope
    return along - push, along + push
