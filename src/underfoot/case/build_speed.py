"""Friction laws of a case that come from a mechanism: films, stiffening rubber, shear strength."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from underfoot.core import InputError, SourcedValue

from . import build
from .sections import RQ_PER_RA

if TYPE_CHECKING:
    from underfoot.friction import AsperityScale, BoundaryFriction, FrictionLaw

    from .case import Case

PIN = ("setup", "pin_on_disk_g2")
RIVAL_DEVIATION = {"mean_film_sharing": 0.095, "viscoelastic_area": 0.241}
"""Root mean square error of COF of five fluids predicted blind from 50 % glycerol with their COF_BL
(docs/studies/g2.md); what stands behind ``asperity_ehl`` is in ``friction.asperity_ehl_law``."""


def asperity_scale(case: Case) -> AsperityScale:
    """Return the asperities of sole and floor: self-affine from the effective Rq of the interface,
    its longest wave and its Hurst exponent, down to the resolution of a stylus.
    """
    from underfoot.friction import self_affine_scale
    from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION

    rq = case.effective_rq.value
    assert rq is not None  # effective_rq raises when it is not known
    return self_affine_scale(
        STYLUS_RESOLUTION,
        rq=rq,
        longest_wave=case.interface.longest_wave,
        hurst=min(case.interface.hurst, 0.99),
    )


def roughness_deviation(case: Case) -> float | None:
    """Return the standard deviation of the interface's Rq over itself; None when not given."""
    whole = case.effective_rq
    if case.interface.effective_rq is not None:
        return None if whole.uncertainty is None else whole.uncertainty / (whole.value or 1.0)
    squares, found = 0.0, []
    for path in ("shoe.roughness", "floor.roughness"):
        name = "rq" if case.value(f"{path}.rq") is not None else "ra"
        one = case.sourced(f"{path}.{name}")
        scale = 1.0 if name == "rq" else RQ_PER_RA
        squares += (scale * (one.value or 0.0)) ** 2
        if one.uncertainty is not None:
            found.append(scale**2 * (one.value or 0.0) * one.uncertainty)
    return math.hypot(*found) / squares if found and squares > 0 else None


def speed_friction(
    case: Case,
    viscosity: float,
    own: BoundaryFriction | None,
    hysteresis: SourcedValue | None,
) -> FrictionLaw:
    """Return the law of a mechanism that makes friction fall with speed.

    "asperity_ehl": films at single asperities. "mean_film_sharing": the film of the report's pin
    against the floor's roughness, on top of which the film under the shoe acts.
    "viscoelastic_area": the compound's relaxation spectrum. The last two take the levels of the
    first.
    """
    from underfoot.friction import (
        MeanFilmSharing,
        SpeedEffectLaw,
        ViscoelasticArea,
        asperity_ehl_law,
        modulus_exponent,
    )

    stiff = build.youngs_modulus(case)[0]
    modulus = stiff.value
    assert modulus is not None
    poisson_ratio = case.shoe.material.poisson_ratio
    fine = None
    if case.interface.fine_roughness is not None:
        fine = case.sourced("interface.fine_roughness")
    law = asperity_ehl_law(
        asperity_scale(case),
        modulus=modulus,
        poisson_ratio=poisson_ratio,
        viscosity=viscosity,
        friction=own,
        cof_hysteresis=hysteresis,
        fine_roughness=fine,
        modulus_deviation=stiff.uncertainty,
        roughness_deviation=roughness_deviation(case),
    )
    if case.models.friction == "asperity_ehl":
        return law
    if case.models.friction == "mean_film_sharing":
        pin = case.catalogue.entry(*PIN)
        rq = case.floor.roughness.rq_or_estimate
        if rq is None:
            raise InputError(
                "the floor's own roughness is not given",
                where="floor.roughness.rq",
                remedy="Give it, or choose models.friction = asperity_ehl",
            )
        stiffness = modulus / (1 - poisson_ratio**2)
        effect = MeanFilmSharing(
            radius=pin.sourced("method.reduced_radius", "m").value or 0.0,
            normal_force=pin.sourced("method.normal_force", "N").value or 0.0,
            effective_modulus=2 * stiffness,
            rq=rq,
            stiffness=stiffness,
        )
    else:
        rubber = build.outsole_rubber(case, modulus)
        wave = case.interface.shortest_wave
        rest = ViscoelasticArea(0.0).rest_speed
        fast = max(case.motion.speed, 2 * rest)
        exponent = modulus_exponent(
            rubber.complex_modulus, 2 * math.pi * rest / wave, 2 * math.pi * fast / wave
        )
        effect = ViscoelasticArea(exponent)
    return SpeedEffectLaw(
        effect,
        law.cof_boundary,
        law.cof_hysteresis,
        viscosity,
        RIVAL_DEVIATION[case.models.friction],
        law.assumed,
    )


def area_friction(case: Case, viscosity: float | None) -> FrictionLaw:
    """Return shear strength times real contact area, at the interface's shortest wave.

    The area is that of elastic contact on the self-affine interface down to
    ``interface.shortest_wave`` (Persson 2001); finer waves would lower it further.
    """
    import numpy as np

    from underfoot.friction import BowdenTaborLaw, ShearStrength, self_affine_scale

    given = case.interface
    assert given.shear_strength is not None  # checked with the case
    modulus = build.youngs_modulus(case)[0].value
    rq = case.effective_rq.value
    assert modulus is not None
    assert rq is not None
    stiffness = modulus / (1 - case.shoe.material.poisson_ratio**2)
    scale = self_affine_scale(
        given.shortest_wave,
        rq=rq,
        longest_wave=given.longest_wave,
        hurst=min(given.hurst, 0.99),
    )
    sourced = case.sourced("interface.shear_strength")
    return BowdenTaborLaw(
        ShearStrength(given.shear_strength, sourced.source, deviation=sourced.uncertainty),
        lambda pressure, _speed: scale.contact_fraction(np.asarray(pressure) / stiffness),
        given.hysteresis_cof or 0.0,
        viscosity,
        contact_source="Persson 2001, elastic contact area",
    )
