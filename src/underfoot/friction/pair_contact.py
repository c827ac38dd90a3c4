"""Contact friction of a sole, a floor and a fluid from what is known of the pair.

Where sole and floor touch under a fluid, friction has a part that a boundary film leaves, a
hysteresis part, and a dry-like part that fades as the fluid is dragged in faster than it can leave
the spots of contact:

    mu_c = [film + hysteresis + dry exp(-eta V / kappa)] (E / E_60)^-c
    kappa = kappa_0 (R / 8.3 um)^n,  R^2 = Rq_sole^2 + Rq_floor^2
    hysteresis = min(0.0125 (loss tangent / 0.2) Rq_floor / um, 0.15)

The form is the film at single asperities (rougher pairs shed it at higher eta V); its constants
are calibrated on published measurements, see ``underfoot.calibrate.pair_law``. They are
measurements of no single pair.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core.arrays import Array

ROUGHNESS = 8.3e-6
"""Rq (m) of the pair at which ``kappa_0`` holds: the report's polyurethane pin on vinyl."""
HYSTERESIS = 0.0125 / 1e-6
"""Hysteresis COF per metre of floor Rq at a loss tangent of 0.2: Persson theory, Hurst exponent
0.8, waves 2.5 um to 0.8 mm, roll-off 0.2 mm; the solved contact is 6 to 31 % higher."""
MOST_HYSTERESIS = 0.15
GENT_SLOPE = 0.045
"""d ln E / d Shore A near 65 (Gent 1958)."""
REFERENCE_HARDNESS = 60.0


@dataclass(frozen=True, slots=True)
class PairConstants:
    """Constants of the law, each of one shape (draws,); SI.

    ``film`` by family of fluid: what a boundary film leaves; ``dry``: the dry-like part at rest;
    ``kappa_0`` in Pa m; ``roughness_exponent`` n and ``hardness_exponent`` c.
    """

    film_aqueous: Array
    film_oil: Array
    dry: Array
    kappa_0: Array
    roughness_exponent: Array
    hardness_exponent: Array


def contact_parts(
    constants: PairConstants, numbers: Mapping[str, ArrayLike], *, oil: bool
) -> tuple[Array, Array, Array]:
    """Return the parts (film, hysteresis, dry-like) of the contact friction of a pair.

    Parameters
    ----------
    constants
        Draws of the constants, each (draws,).
    numbers
        ``viscosity`` (Pa s), ``speed`` (m/s), ``sole_rq`` and ``floor_rq`` (m), ``shore_a`` and
        ``loss_tangent`` of the compound; each a number or (points,).
    oil
        Whether the fluid is an oil; else water, detergent or an aqueous mixture.

    Returns
    -------
    tuple
        Three arrays (draws, points).
    """
    drag = np.asarray(numbers["viscosity"]) * np.abs(numbers["speed"])
    floor = np.asarray(numbers["floor_rq"])
    roughness = np.hypot(numbers["sole_rq"], floor)
    loss = np.asarray(numbers.get("loss_tangent", 0.2))
    kappa = (
        constants.kappa_0[:, None]
        * (roughness / ROUGHNESS) ** (constants.roughness_exponent[:, None])
    )
    softness = np.exp(
        -constants.hardness_exponent[:, None]
        * GENT_SLOPE
        * (np.asarray(numbers["shore_a"]) - REFERENCE_HARDNESS)
    )
    film = constants.film_oil if oil else constants.film_aqueous
    hysteresis = np.minimum(HYSTERESIS * loss / 0.2 * floor, MOST_HYSTERESIS)
    return (
        film[:, None] * softness,
        hysteresis * softness,
        constants.dry[:, None] * np.exp(-drag / kappa) * softness,
    )
