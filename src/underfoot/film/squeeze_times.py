"""How long a flat pad takes to press a film out (no sliding)."""

import math

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import positive, positive_array

_TERMS = 60


def squeeze_time_disc(
    *, viscosity: ArrayLike, radius: float, load: ArrayLike, start_gap: float, end_gap: ArrayLike
) -> Array:
    """Return the time (s) a flat disc takes to sink from one gap to another under a constant load.

    t = 3 pi eta R^4 / (4 F) (1 / h2^2 - 1 / h1^2)

    Parameters:
        viscosity, load: Pa s, N; scalars or arrays.
        radius, start_gap, end_gap: m; h1 > h2 > 0.

    Rigid, smooth, parallel, fully flooded, no inertia; a soft sole traps a thicker pocket in its
    middle and takes longer to empty it. Source: Stefan 1874.

    >>> pad = {"radius": 0.01, "load": 10.0, "start_gap": 1e-4, "end_gap": 1e-5}
    >>> round(float(squeeze_time_disc(viscosity=0.1, **pad)), 3)
    2.333
    """
    shape = 0.5 * math.pi * positive(radius, "radius") ** 4
    return _time(shape, viscosity, load, start_gap, end_gap)


def squeeze_time_rectangle(
    *,
    viscosity: ArrayLike,
    length: float,
    width: float,
    load: ArrayLike,
    start_gap: float,
    end_gap: ArrayLike,
) -> Array:
    """Return the time (s) a flat rectangular pad (a lug) takes to sink, as ``squeeze_time_disc``.

    t = 3 eta J / (2 F) (1 / h2^2 - 1 / h1^2), J the torsion constant of the pad's outline: the
    pressure obeys the equation of Prandtl's torsion function. J = a b^3 [1/3 - (64 / pi^5) (b / a)
    sum tanh(n pi a / 2b) / n^5 over odd n], a >= b. A disc has J = pi R^4 / 2.

    Source: Hays 1961 for the square plate; torsion after Saint-Venant (Timoshenko and Goodier).

    >>> pad = {"length": 0.01, "width": 0.01, "load": 10.0}
    >>> round(float(squeeze_time_rectangle(viscosity=0.1, **pad, start_gap=1e-4, end_gap=1e-5)), 3)
    0.209
    """
    sides = positive(length, "length"), positive(width, "width")
    return _time(rectangle_torsion_constant(*sides), viscosity, load, start_gap, end_gap)


def squeeze_gap(
    time: ArrayLike, *, viscosity: float, torsion_constant: float, load: float, start_gap: float
) -> Array:
    """Return the gap (m) of a flat pad after ``time`` (s) under a constant load.

    1 / h^2 = 1 / h1^2 + 2 F t / (3 eta J); J (m^4) of the outline, pi R^4 / 2 for a disc,
    ``rectangle_torsion_constant`` for a lug. Validity as ``squeeze_time_disc``.

    Parameters:
        time: s, any shape.
        viscosity: Pa s.
        torsion_constant: J of the outline, m^4.
        load: Constant force, N.
        start_gap: h1 at time 0, m.
    """
    t = positive_array(time, "time", zero=True)
    shape = positive(torsion_constant, "torsion_constant")
    eta = positive(viscosity, "viscosity")
    start = positive(start_gap, "start_gap")
    return (start**-2 + 2 * positive(load, "load") * t / (3 * eta * shape)) ** -0.5


def rectangle_torsion_constant(length: float, width: float) -> float:
    """Return Saint-Venant's torsion constant J (m^4) of a rectangle; 0.1406 a^4 for a square.

    >>> round(rectangle_torsion_constant(0.02, 0.01) * 1e9, 3)
    4.574
    """
    a, b = max(length, width), min(length, width)
    n = np.arange(1, 2 * _TERMS, 2)
    series = float((np.tanh(0.5 * n * math.pi * a / b) / n**5.0).sum())
    return a * b**3 * (1 / 3 - 64 / math.pi**5 * (b / a) * series)


def _time(
    shape: float, viscosity: ArrayLike, load: ArrayLike, start_gap: float, end_gap: ArrayLike
) -> Array:
    eta, force = positive_array(viscosity, "viscosity"), positive_array(load, "load")
    start, end = positive_array(start_gap, "start_gap"), positive_array(end_gap, "end_gap")
    if (end > start).any():
        raise InputError(
            "the pad would have to rise", where="end_gap", allowed="at most the start gap"
        )
    return np.asarray(1.5 * eta * shape / force * (end**-2 - start**-2))
