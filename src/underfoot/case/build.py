"""From the values of a case to the objects the physics works with, one function a slot."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import Breach, Cache, InputError, Progress, SourcedValue, silent

if TYPE_CHECKING:
    from underfoot.asperity.law import PressureGapLaw
    from underfoot.core.catalogue import Catalogue
    from underfoot.friction import BoundaryFriction, FrictionLaw
    from underfoot.material import Elastomer
    from underfoot.outsole import SoleMap
    from underfoot.outsole.compliance import Compliance

    from .case import Case

HARDNESS_SPREAD = 0.3
"""Relative standard deviation of a modulus from hardness (assumed: tens of percent)."""
TABLE_CELLS, TABLE_SURFACES, TABLE_WAVES = 128, 4, 4
"""Contact table: cells along a side, surfaces, longest waves along a side."""
TABLE_PRESSURES = (1e3, 2e6)
"""Contact table: lowest and highest nominal pressure, Pa."""


def youngs_modulus(case: Case) -> tuple[SourcedValue, list[Breach]]:
    """Return the outsole's Young's modulus: measured, or from hardness by the chosen relation."""
    from underfoot import material

    if case.shoe.material.modulus is not None:
        return case.sourced("shoe.material.modulus"), []
    hardness = case.shoe.material.shore_a
    assert hardness is not None  # the case checks that one of the two is there
    if case.models.hardness == "gent":
        value, found = material.youngs_modulus_gent(hardness), material.gent_breaches(hardness)
        source = "Gent 1958 from Shore A"
    else:
        value, found = material.youngs_modulus_ruess(hardness), material.ruess_breaches(hardness)
        source = "Ruess from Shore A"
    modulus = SourcedValue(
        float(value),
        "Pa",
        source=f"{source} {hardness:g}",
        uncertainty=HARDNESS_SPREAD * float(value),
        note="static modulus from hardness, good to tens of percent",
    )
    return modulus, found


def viscosity(case: Case) -> SourcedValue | None:
    """Return the contaminant's viscosity in Pa s; None on a dry floor."""
    fluid = case.contaminant
    if fluid is None:
        return None
    if fluid.viscosity is not None:
        return case.sourced("contaminant.viscosity")
    from underfoot.fluid import glycerol_water

    assert fluid.glycerol_fraction is not None  # the case checks that one of the two is there
    return glycerol_water(
        fluid.glycerol_fraction, fluid.temperature, fluid.fraction_basis or "mass"
    ).viscosity


def sole_map(case: Case, spacing: float, progress: Progress = silent) -> SoleMap:
    """Return the tilted heel of the case on a grid of ``spacing`` (m)."""
    from underfoot import outsole

    if case.shoe.outsole.file is not None:
        from .build_outsole import file_sole_map

        return file_sole_map(case, spacing)
    from .build_sole import sole_shape

    sole = outsole.heel_map(
        sole_shape(case, progress), shoe_angle=case.motion.shoe_angle, spacing=spacing
    )
    if case.shoe.heel.plan == "heel":
        return sole
    from .build_outsole import trimmed

    return trimmed(sole, case.shoe.outsole.reach)


def compliance(
    case: Case, sole: SoleMap, modulus: float, progress: Progress = silent
) -> Compliance:
    """Return how the sole gives way under pressure."""
    from .build_compliance import sole_compliance

    return sole_compliance(case, sole, modulus, progress)


def asperity_law(case: Case, modulus: float, progress: Progress = silent) -> PressureGapLaw:
    """Return how the rough interface carries load and lets fluid through.

    "exponential": one formula, no flow factor. "contact_table": self-affine surfaces of the
    interface's effective Rq in sliding contact with the outsole's rubber, with the flow factors of
    their own gaps; computed once and cached.
    """
    rq = case.effective_rq.value
    assert rq is not None  # effective_rq raises when it is not known
    poisson_ratio = case.shoe.material.poisson_ratio
    if case.models.asperity == "exponential":
        from underfoot.asperity import ExponentialLaw

        return ExponentialLaw(modulus, poisson_ratio, rq)
    from underfoot.asperity import ContactTable
    from underfoot.surface import self_affine

    waves = case.interface
    side = TABLE_WAVES * waves.longest_wave
    spacing = min(side / TABLE_CELLS, waves.shortest_wave / 2)
    cells = 2 * math.ceil(side / spacing / 2)
    surfaces = [
        self_affine(
            cells, side / cells, rq, waves.hurst, waves.longest_wave, waves.shortest_wave, seed
        )
        for seed in range(TABLE_SURFACES)
    ]
    speed = case.motion.speed
    table = ContactTable.from_surfaces(
        surfaces,
        outsole_rubber(case, modulus),
        np.geomspace(*TABLE_PRESSURES, 14),
        np.array([0.5 * speed, speed, 2.0 * speed]),
        poisson_ratio=poisson_ratio,
        cache=Cache("contact_table"),
        description=f"self-affine interface, Rq {rq * 1e6:.3g} um",
        progress=progress,
    )
    return table.law(speed)


def outsole_rubber(case: Case, modulus: float) -> Elastomer:
    """Return the outsole's compound: its relaxation spectrum where given, else elastic."""
    from underfoot import material

    relaxation = case.shoe.material.relaxation
    poisson_ratio = case.shoe.material.poisson_ratio
    if relaxation is None:
        return material.Elastomer(modulus, poisson_ratio)
    shear = material.RelaxationSpectrum(
        relaxation.equilibrium_shear_modulus,
        np.array([term.shear_modulus for term in relaxation.terms]),
        np.array([term.time for term in relaxation.terms]),
    )
    return material.Elastomer(material.young_from_shear(shear, poisson_ratio), poisson_ratio)


def friction_law(case: Case, catalogue: Catalogue) -> FrictionLaw:
    """Return the local friction law of the pair and fluid that the case chooses.

    "stribeck" takes the measured fall with speed (Eq. 17) where the fluid has the fit, the measured
    mean over speeds where the report found no fall, and the curve of viscosity times speed for a
    fluid that was not measured; "boundary" takes COF_BL at every speed. "asperity_ehl" and its
    rivals: ``build_speed``.
    """
    from underfoot.friction import (
        AdhesionBlockingLaw,
        BoundaryLaw,
        ConstantLaw,
        StribeckLaw,
        boundary_friction_at,
        stribeck_law_at,
    )

    fluid = viscosity(case)
    thickness = None if fluid is None else fluid.value
    given = case.interface
    hysteresis = None
    if given.hysteresis_cof is not None:
        hysteresis = case.sourced("interface.hysteresis_cof")
    if case.models.friction == "constant":
        whole = given.constant_cof
        assert whole is not None  # the case checks that the constant model has its number
        left = min(given.hysteresis_cof or 0.0, whole)
        source = case.sourced("interface.constant_cof")
        return ConstantLaw(whole - left, left, source.source, thickness, source.uncertainty)
    if case.models.friction == "table":
        from .friction_table import table_law

        return table_law(case, thickness)
    if case.models.friction == "bowden_tabor":
        from .build_speed import area_friction

        return area_friction(case, thickness)
    measured = measured_fluids(catalogue)
    own = measured_friction(case, thickness)
    if case.contaminant is None or thickness is None:
        raise _no_dry_friction()
    if case.models.friction in ("asperity_ehl", "mean_film_sharing", "viscoelastic_area"):
        from .build_speed import speed_friction

        return speed_friction(case, thickness, own, hysteresis)
    fitted = own is not None and own.tau_hydro is not None and own.cof_asymptote is not None
    if case.models.friction == "stribeck" and own is not None and fitted:
        return StribeckLaw.measured(own, cof_hysteresis=hysteresis, others=measured)
    if case.models.friction == "adhesion_blocking":
        from underfoot.fluid import AdhesionBlocking

        boundary = case.contaminant.boundary
        assert boundary.alpha is not None  # checked with the case, like beta
        assert boundary.beta is not None
        source = case.sourced("contaminant.boundary.alpha").source
        return AdhesionBlockingLaw(
            AdhesionBlocking(boundary.alpha, boundary.beta, source),
            case.sourced("interface.dry_adhesion_cof"),
            case.sourced("interface.hysteresis_cof"),
            thickness,
        )
    if case.models.friction == "stribeck" and own is None:
        return stribeck_law_at(thickness, measured, fluid=_fluid_name(case))
    if own is None:
        own = boundary_friction_at(thickness, measured, fluid=_fluid_name(case))
    return BoundaryLaw.measured(own, cof_hysteresis=hysteresis, others=measured)


def measured_fluids(catalogue: Catalogue) -> tuple[BoundaryFriction, ...]:
    """Return every fluid of the catalogue whose own boundary friction was measured."""
    from underfoot.friction import BoundaryFriction

    found = []
    for name in catalogue.names("fluid"):
        entry = catalogue.entry("fluid", name)
        leaf = entry.values.get("boundary.cof_bl")
        if leaf is None or leaf.assumed or entry.parents or "boundary.pair" not in entry.values:
            continue
        optional = {
            key: entry.sourced(f"boundary.{path}", unit)
            for key, path, unit in (
                ("tau_hydro", "tau_hydro", "m/s"),
                ("cof_asymptote", "cof_asymptote", "1"),
            )
            if f"boundary.{path}" in entry.values
        }
        thickness = entry.sourced("viscosity", "Pa*s").value
        assert thickness is not None
        found.append(
            BoundaryFriction(
                fluid=name,
                pair=entry.text("boundary.pair"),
                viscosity=thickness,
                cof_boundary=entry.sourced("boundary.cof_bl", "1"),
                **optional,
            )
        )
    return tuple(found)


def measured_friction(case: Case, thickness: float | None) -> BoundaryFriction | None:
    """Return the friction that the case itself holds for its fluid, if any."""
    from underfoot.friction import BoundaryFriction

    fluid = case.contaminant
    if fluid is None or thickness is None or fluid.boundary.cof_bl is None:
        return None
    boundary = fluid.boundary

    def optional(name: str) -> SourcedValue | None:
        path = f"contaminant.boundary.{name}"
        return case.sourced(path) if getattr(boundary, name) is not None else None

    return BoundaryFriction(
        fluid=_fluid_name(case),
        pair=boundary.pair or "",
        viscosity=thickness,
        cof_boundary=case.sourced("contaminant.boundary.cof_bl"),
        tau_hydro=optional("tau_hydro"),
        cof_asymptote=optional("cof_asymptote"),
    )


def _fluid_name(case: Case) -> str:
    return case.entries.get("contaminant", "the fluid")


def _no_dry_friction() -> InputError:
    return InputError(
        "the dry friction of this pair is not known: no publication in the catalogue prints it",
        where="models.friction",
        remedy='Measure it and write models.friction = "constant" with interface.constant_cof '
        "(and interface.hysteresis_cof, its hysteresis part)",
    )
