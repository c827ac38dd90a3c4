"""How the sole of a case gives way under pressure, by the model it chooses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from underfoot.core import Cache, Progress, silent

if TYPE_CHECKING:
    from underfoot.outsole import SoleMap
    from underfoot.outsole.compliance import Compliance

    from .case import Case


def sole_compliance(
    case: Case, sole: SoleMap, modulus: float, progress: Progress = silent
) -> Compliance:
    """Return how the sole gives way under pressure.

    "layered": endless layers with free edges, by convolution. "finite_element": the real shape of
    sole, lugs and rim, condensed once and kept in the cache. "half_space": for comparison.
    """
    from underfoot.outsole.compliance import half_space_compliance, layered_compliance

    poisson_ratio = case.shoe.material.poisson_ratio
    if case.models.compliance == "half_space":
        shape = (sole.x.size, sole.y.size)
        return half_space_compliance(
            shape, sole.spacing, modulus=modulus, poisson_ratio=poisson_ratio
        )
    layers = case.shoe.sole
    if case.models.compliance == "finite_element":
        from underfoot.outsole.finite_element import finite_element_compliance

        return finite_element_compliance(
            sole,
            modulus=modulus,
            poisson_ratio=poisson_ratio,
            thickness=layers.outsole_thickness,
            shoe_angle=case.motion.shoe_angle,
            midsole_modulus=layers.midsole_modulus,
            midsole_thickness=layers.midsole_thickness,
            midsole_poisson_ratio=layers.midsole_poisson_ratio,
            cache=Cache("sole_compliance-1"),
            progress=progress,
        )
    return layered_compliance(
        sole,
        modulus=modulus,
        poisson_ratio=poisson_ratio,
        thickness=layers.outsole_thickness,
        shoe_angle=case.motion.shoe_angle,
        midsole_modulus=layers.midsole_modulus,
        midsole_thickness=layers.midsole_thickness,
        midsole_poisson_ratio=layers.midsole_poisson_ratio,
    )
