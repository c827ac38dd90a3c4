"""Lubrication regimes, by film over roughness and by who carries the load."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import between, not_negative, positive, positive_array
from underfoot.core.remark import Message

from .soft_ehl import lambda_ratio, soft_ehl

LAMBDA_LIMITS = (1.0, 3.0)
"""Boundary below the first, full film above the second (the report, Fig. 19; Hamrock 1991)."""

SHARE_LIMITS = (0.1, 0.9)
"""Fluid's share of the load: boundary below the first, full film above the second (assumed)."""


class Lubrication(StrEnum):
    """What separates the surfaces: fluid, solid contact, or both."""

    BOUNDARY = "boundary"
    MIXED = "mixed"
    FULL_FILM = "full film"


class GapPressure(Protocol):
    """The part of a rough interface's law that the load share needs."""

    def pressure(self, gap: ArrayLike) -> Array:
        """Return the asperity pressure (Pa) at a mean gap (m)."""
        ...


@dataclass(frozen=True, slots=True)
class RegimeComparison:
    """One operating point, judged both ways; ``why`` says what the two look at."""

    lambda_ratio: float
    fluid_share: float
    by_lambda: Lubrication
    by_load_share: Lubrication
    why: str

    @property
    def agree(self) -> bool:
        """True when both name the same regime."""
        return self.by_lambda == self.by_load_share


@dataclass(frozen=True, slots=True)
class RegimeMap:
    """Regimes over viscosity (Pa s) and speed (m/s); arrays (viscosities, speeds)."""

    viscosity: Array
    speed: Array
    lambda_ratio: Array
    fluid_share: Array | None
    assumptions: tuple[Message, ...]
    breaches: tuple[Breach, ...]


def lubrication_by_lambda(lambda_ratio: float) -> Lubrication:
    """Return the regime by lambda: boundary below 1, mixed to 3, full film above.

    Lambda is a smooth film over undeformed roughness (``lambda_ratio``). Rules of thumb from steel:
    soft asperities flatten under the film, so rubber runs on a full film at lambda below 3.
    Source: the report, text to Fig. 19.

    >>> str(lubrication_by_lambda(0.5))
    'boundary'
    """
    return _regime_at(not_negative(lambda_ratio, "lambda_ratio"), LAMBDA_LIMITS)


def lubrication_by_load_share(fluid_share: float) -> Lubrication:
    """Return the regime by the fluid's share of the load: boundary below 0.1, full film above 0.9.

    The limits are assumed. ``fluid_share`` 0 to 1, from a coupled solution or ``fluid_load_share``.

    >>> str(lubrication_by_load_share(0.5))
    'mixed'
    """
    return _regime_at(between(fluid_share, 0.0, 1.0, "fluid_share"), SHARE_LIMITS)


def fluid_load_share(film_thickness: ArrayLike, law: GapPressure, mean_pressure: float) -> Array:
    """Return the share of the load that the fluid carries, 1 - P(h) / p, at least 0.

    P(h) is the asperity pressure of ``law`` at a mean gap equal to the film of smooth walls
    ``film_thickness`` (m, any shape; the central one, which holds most of the contact), p the mean
    pressure (Pa). A first estimate: the film is not fed back what the asperities take over.

    Source: load sharing after Johnson, Greenwood and Poon (1972) Wear 19:91-108.
    """
    thickness = positive_array(film_thickness, "film_thickness", zero=True)
    carried = np.asarray(law.pressure(thickness)) / positive(mean_pressure, "mean_pressure")
    return 1 - np.clip(carried, 0.0, 1.0)


def compare_regimes(lambda_ratio: float, fluid_share: float) -> RegimeComparison:
    """Return the regime by lambda and by load share, and why they differ where they do.

    >>> compare_regimes(0.5, 0.5).by_load_share
    <Lubrication.MIXED: 'mixed'>
    """
    first, second = lubrication_by_lambda(lambda_ratio), lubrication_by_load_share(fluid_share)
    given = (
        f"lambda {lambda_ratio:.2g} says {first}, the fluid's {fluid_share:.0%} of the load says "
        f"{second}"
    )
    order = list(Lubrication)
    if first == second:
        why = f"{given}: they agree."
    elif order.index(second) > order.index(first):
        why = (
            f"{given}. Lambda sets the thinnest place of a smooth film against roughness as it "
            "was measured. The load is carried over the whole contact, where the film is thicker, "
            "and soft asperities flatten or are held apart by a mean pressure far below their own "
            "stiffness."
        )
    else:
        why = (
            f"{given}. Lambda counts mean heights: a film as thick as three standard deviations is "
            "still crossed by the highest summits and by waves longer than the cut-off of Rq, "
            "and those can carry the load where the mean pressure is low."
        )
    return RegimeComparison(float(lambda_ratio), float(fluid_share), first, second, why)


def regime_map(
    viscosity: ArrayLike,
    speed: ArrayLike,
    *,
    load: float,
    radius: float,
    effective_modulus: float,
    rq_first: float,
    rq_second: float,
    speed_is: str = "entrainment",
    ellipticity: float = 1.0,
    law: GapPressure | None = None,
    mean_pressure: float | None = None,
) -> RegimeMap:
    """Return lambda (and the fluid's load share, given a ``law``) over viscosities and speeds.

    ``viscosity`` (n,) Pa s, ``speed`` (m,) m/s; the rest as ``soft_ehl``, ``lambda_ratio`` and
    ``fluid_load_share``. Lambda takes the minimum film, the load share the central one.

    Parameters:
        viscosity: Pa s, (n,).
        speed: m/s, (m,).
        load: N.
        radius: Reduced radius along the motion, m.
        effective_modulus: Pa, as ``soft_ehl`` takes it.
        rq_first: Rq of one wall, m.
        rq_second: Rq of the other wall, m.
        speed_is: "entrainment" or "sliding", as ``soft_ehl`` takes it.
        ellipticity: k, 1 for a circle.
        law: Pressure of the rough walls over their gap; None leaves the load share out.
        mean_pressure: Pa; given where ``law`` is, and only there.
    """
    if (law is None) != (mean_pressure is None):
        raise InputError(
            "a load share needs a law and the mean pressure",
            where="law" if law is None else "mean_pressure",
            remedy="Give both or neither.",
        )
    eta = np.atleast_1d(positive_array(viscosity, "viscosity"))
    v = np.atleast_1d(positive_array(speed, "speed"))
    film = soft_ehl(
        viscosity=eta[:, None],
        speed=v[None, :],
        load=load,
        radius=radius,
        effective_modulus=effective_modulus,
        ellipticity=ellipticity,
        speed_is=speed_is,
    )
    share = None
    assumptions = [Message("film of a smooth soft contact, {speed_is} speed", speed_is=speed_is)]
    if law is not None and mean_pressure is not None:
        share = fluid_load_share(film.central, law, mean_pressure)
        assumptions.append(
            Message("load share at the film of smooth walls, limits 0.1 and 0.9 assumed")
        )
    return RegimeMap(
        viscosity=eta,
        speed=v,
        lambda_ratio=lambda_ratio(film.minimum, rq_first, rq_second),
        fluid_share=share,
        assumptions=tuple(assumptions),
        breaches=film.breaches,
    )


def _regime_at(value: float, limits: tuple[float, float]) -> Lubrication:
    if value < limits[0]:
        return Lubrication.BOUNDARY
    return Lubrication.MIXED if value <= limits[1] else Lubrication.FULL_FILM
