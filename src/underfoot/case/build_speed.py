"""Friction laws of a case that come from a mechanism: films, stiffening rubber, shear strength."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from underfoot.core import InputError, SourcedValue

from . import build

if TYPE_CHECKING:
    from underfoot.friction import AsperityScale, BoundaryFriction, FrictionLaw

    from .case import Case

PIN = ("setup", "pin_on_disk_g2")


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

    modulus = build.youngs_modulus(case)[0].value
    assert modulus is not None
    poisson_ratio = case.shoe.material.poisson_ratio
    law = asperity_ehl_law(
        asperity_scale(case),
        modulus=modulus,
        poisson_ratio=poisson_ratio,
        viscosity=viscosity,
        friction=own,
        cof_hysteresis=hysteresis,
        fine_roughness=case.interface.fine_roughness,
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
        effect, law.cof_boundary, law.cof_hysteresis, viscosity, None, law.assumed
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
