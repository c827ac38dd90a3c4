"""The friction of a solved contact: the local law on its maps, the sum, and draws of its spread."""

from dataclasses import dataclass, replace

from underfoot.case import Case
from underfoot.case.context import Context
from underfoot.friction import (
    FrictionCoefficients,
    FrictionLaw,
    FrictionParts,
    SampledCof,
    cof,
    sampled_cof,
)
from underfoot.shoe import SoleMap
from underfoot.sole_contact.lug_edges import EdgedLaw, LugFriction
from underfoot.sole_contact.solver import SoleContact

from . import numbers


@dataclass(frozen=True, slots=True)
class ContactFriction:
    """Shear stresses on the sole, what edges of lugs do to them, their sum and its draws."""

    parts: FrictionParts
    lugs: LugFriction | None
    sums: FrictionCoefficients
    sampled: SampledCof | None


def contact_friction(
    case: Case,
    context: Context,
    law: FrictionLaw | EdgedLaw,
    sole: SoleMap,
    contact: SoleContact,
) -> ContactFriction:
    """Return the friction of a contact by the local law, drawn over the spread of its inputs."""
    maps = contact.contact_pressure, case.motion.speed, contact.film_thickness
    parts, lugs, suction, plain = law(*maps), None, None, law
    if isinstance(law, EdgedLaw):
        plain, lugs = law.law, law.lugs(*maps)
        pull = case.sourced("film.suction")
        pull = pull if pull.uncertainty else replace(pull, uncertainty=numbers.SUCTION_SPREAD)
        suction = pull, lugs.suction_share(parts)
    assert isinstance(plain, FrictionLaw)
    pressures = contact.contact_pressure, contact.fluid_pressure
    sampled = sampled_cof(
        plain,
        *pressures,
        contact.film_thickness,
        speed=case.motion.speed,
        wet=contact.wet,
        **contact.areas,
        fluid_inputs={} if context.viscosity is None else {"viscosity": context.viscosity},
        film_error=numbers.FILM_ERROR,
        sole=numbers.sole_name(case),
        contact_factor=1.0 if lugs is None else lugs.factor_map(),
        suction=suction,
        seed=case.numerics.seed,
    )
    sums = cof(
        parts,
        *pressures,
        spacing=sole.spacing,
        wet=contact.wet,
        **contact.areas,
        sampled=sampled,
        source=f"{plain.name} law: {plain.source}",
    )
    return ContactFriction(parts, lugs, sums, sampled)
