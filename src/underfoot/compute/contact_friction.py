"""The friction of a solved contact: the local law on its maps, the sum, and draws of its spread."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import lambertw

from underfoot.case import Case
from underfoot.case.context import Context
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.fluid.temperature import ROOM_DEVIATION, sliding_heat, viscosity_slope
from underfoot.friction import (
    FrictionCoefficients,
    FrictionLaw,
    FrictionParts,
    PairContactLaw,
    SampledCof,
    cof,
    sampled_cof,
)
from underfoot.friction.propagation import named_shares, normal_draws
from underfoot.friction.sampled_cof import LEAK, SAMPLES
from underfoot.friction.shoe_class import of_class
from underfoot.friction.tread_error import SharedError, tread_error
from underfoot.shoe import SoleMap
from underfoot.shoe.tread_place import tread_place
from underfoot.sole_contact.lug_edges import EdgedLaw, LugFriction
from underfoot.sole_contact.sole_state import CellState, SoleState
from underfoot.sole_contact.solver import SoleContact

from . import numbers
from .sole import sole_map
from .stated_spreads import VISCOSITY, StatedEffects, friction_draws, odds_changes


@dataclass(frozen=True, slots=True)
class ContactFriction:
    """Shear stresses on the sole, what edges of lugs do to them, their sum and its draws.

    ``parts`` are maps (nx, ny), the viscous part 0 outside the film; ``film_odds`` (samples,) draws
    of the error of ln F / (W - F), F the load on the film, W the whole; ``stated`` those of what
    the case states with a spread, by path and name (``StatedEffects``).
    """

    parts: FrictionParts
    lugs: LugFriction | None
    sums: FrictionCoefficients
    sampled: SampledCof | None
    film_odds: Array
    stated: Mapping[str, Mapping[str, Array]]


def contact_friction(
    case: Case,
    context: Context,
    law: FrictionLaw | EdgedLaw,
    sole: SoleMap,
    contact: SoleContact,
    *,
    samples: int = SAMPLES,
    spreads: Mapping[str, tuple[float, float]] | None = None,
    stated: StatedEffects | None = None,
    drawn_law: FrictionLaw | EdgedLaw | None = None,
) -> ContactFriction:
    """Return the friction of a contact by the local law, drawn over the spread of its inputs.

    Parameters:
        spreads: What a standard deviation less and more of a part of the rough contact adds to the
            logarithm of the film's odds (``film_spreads``); between and beyond in proportion.
        stated: Of what the case states with a spread.
        drawn_law: The law without what ``stated`` holds, which it would draw once more; None takes
            ``law``.
    """
    maps = law_on(law, contact)(contact.contact_pressure, case.motion.speed, contact.film_thickness)
    at = contact.finest
    law = law_on(law, at)
    values = at.contact_pressure, case.motion.speed, at.film_thickness
    parts = maps if at is contact else law(*values)
    if isinstance(at, CellState):
        maps = _on_squares(parts, at, contact)
    else:
        maps = replace(maps, viscous=np.where(contact.wet, maps.viscous, 0.0))
    lugs, suction = None, None
    plain = law if drawn_law is None else law_on(drawn_law, at)
    if isinstance(law, EdgedLaw):
        lugs = law.lugs(*values)
        pull = case.sourced_value("film.suction")
        pull = pull if pull.uncertainty else replace(pull, uncertainty=numbers.SUCTION_SPREAD)
        suction = pull, lugs.suction_share(parts)
    if isinstance(plain, EdgedLaw):
        plain = plain.with_mean_state(*values)
    assert isinstance(plain, FrictionLaw)
    place, seed = place_of_tread(case, sole), case.numerics.seed
    known: Mapping[str, Array] = getattr(plain, "known_errors", lambda _: {})(samples)
    errors = {
        name: error.draws(place, samples=samples, seed=seed, known=known)
        for name, error in sole_errors(case, context).items()
    }
    rough = {}
    for name, (less, more) in (spreads or {}).items():
        normal = normal_draws(seed, f"{name} of the rough contact", samples)
        if name == LEAK and (leak := known.get(leak_name(context))) is not None:
            normal = leak / context.leak_deviation
        rough[name] = odds_changes(less, more, normal)
    pressures = at.contact_pressure, at.fluid_pressure
    on_cells = {"spacing": sole.spacing, "wet": at.wet, **at.areas}
    source = f"{plain.name} law: {plain.source}"
    exact = cof(parts, *pressures, **on_cells, source=source)
    of_film, whole = (float(number) for number in (exact.cof_viscous, exact.cof))
    film_shear = film_warmth(
        case, context, whole, contact, film_share=of_film / (whole or 1.0), samples=samples
    )
    of_case = (stated or StatedEffects()).draws(lambda name: normal_draws(seed, name, samples))
    fluid = {"viscosity": context.viscosity} if context.viscosity is not None else {}
    if VISCOSITY in of_case:
        fluid = {}
    sampled = sampled_cof(
        plain,
        *pressures,
        at.film_thickness,
        speed=case.motion.speed,
        wet=at.wet,
        **at.areas,
        fluid_inputs=fluid,
        film_error=errors["film_error"],
        rough_errors=rough,
        tread_error=errors["tread_error"],
        stated=friction_draws(of_case),
        film_shear=film_shear,
        zero=numbers.ZERO * normal_draws(seed, "zero of the cell", samples),
        contact_factor=1.0 if lugs is None else lugs.factor_map(),
        suction=suction,
        samples=samples,
        seed=seed,
    )
    sums = cof(parts, *pressures, **on_cells, sampled=sampled, source=source)
    film_odds = errors["film_error"] + sum(rough.values())
    return ContactFriction(maps, lugs, sums, sampled, film_odds, of_case)


def film_warmth(
    case: Case,
    context: Context,
    cof: float,
    contact: SoleContact,
    *,
    film_share: float,
    samples: int,
) -> Array | None:
    """Return draws (samples,) of ln of a film's shear stress over that computed; None when dry.

    ln y = -b T - x (1 - s + s y), x = b u dT: b how fast the fluid thins, T the laboratory beside
    22.5 C, dT what all heat of sliding at the ``cof`` warms the faces by, u a share of it between 0
    and 1, s the ``film_share`` of the COF, whose heat falls with the film's own shear. The fluid's
    own spread is drawn with its viscosity. All cases share one draw of the laboratory's
    temperature.
    """
    viscosity = context.viscosity_value
    if viscosity is None or case.contaminant is None:
        return None
    loaded, seed = contact.total_pressure > 0, case.numerics.seed
    pressure = case.motion.normal_force / (float(loaded.sum()) * contact.spacing**2)
    length = float(loaded.sum() / max(loaded.any(axis=0).sum(), 1)) * contact.spacing
    slope = viscosity_slope(viscosity, oil=case.contaminant.chemistry == "oil")
    warm = ROOM_DEVIATION * normal_draws(seed, "temperature of the laboratory", samples)
    heat = sliding_heat(cof, pressure, abs(case.motion.speed), length)
    hot = slope * heat * named_shares(seed, "share of the heat of sliding", samples)
    own = film_share * hot
    return -slope * warm - (hot - own) - lambertw(own * np.exp(own - hot)).real


def place_of_tread(case: Case, sole: SoleMap) -> Array:
    """Return where the tread of a case lies among treads; all 0 without one."""
    moulded = getattr(case.shoe.tread, "edge_radius", 0.0)
    return tread_place(sole, max(moulded, case.shoe.wear.edge_radius or 0.0))


def sole_errors(case: Case, context: Context) -> dict[str, SharedError]:
    """Return the errors of film load and tread of a case, as ``sampled_cof`` names them.

    Soles of one heel share that of the film as far as their treads are alike.
    """
    film = SharedError(
        Message("film load, {heel_name}", heel_name=numbers.heel_name(case)), numbers.FILM_ERROR
    )
    return {"film_error": film, "tread_error": tread_error(context.viscosity_value)}


def leak_name(context: Context) -> str:
    """Return the name of the error of ln of the Rq that lets fluid leak between two surfaces."""
    sole, floor = (part.roughness.rq_or_estimate or 0.0 for part in (context.shoe, context.floor))
    return f"{LEAK}: Rq {sole:.3g} m on {floor:.3g} m"


def of_known_class(law: FrictionLaw, case: Case, sole: SoleMap) -> FrictionLaw:
    """Return the law of the pair with what the slip class and certificates of the shoe say."""
    known = case.shoe.known_class()
    if known is None or not isinstance(law, PairContactLaw):
        return law
    if case.shoe.wear.depth > 0:  # the new sole was tested
        case = case.replace("shoe.wear.depth", 0.0)
        sole = sole_map(case, sole.spacing)
    return of_class(law, known, place_of_tread(case, sole), case.numerics.seed).law


def with_known_tread(law: FrictionLaw, case: Case, context: Context, sole: SoleMap) -> FrictionLaw:
    """Return the law with the median of the tread's error, where readings determined some."""
    if not isinstance(law, PairContactLaw) or not law.draws.errors:
        return law
    error, place = sole_errors(case, context)["tread_error"], place_of_tread(case, sole)
    drawn = {"samples": law.draws.count, "seed": case.numerics.seed, "known": law.draws.errors}
    factor = float(np.exp(np.median(error.draws(place, **drawn))))
    return replace(law, medians={**law.medians, "pair": factor * law.medians["pair"]})


def _on_squares(parts: FrictionParts, at: CellState, contact: SoleContact) -> FrictionParts:
    """Return the shear stresses of finer cells, averaged over their squares, (nx, ny)."""
    area = contact.areas["area"]

    def mean(stress: Array, weight: Array) -> Array:
        sums = np.bincount(at.square, stress * weight, area.size)
        return sums.reshape(area.shape) / area

    return FrictionParts(
        mean(parts.adhesion, at.area),
        mean(parts.hysteresis, at.area),
        mean(parts.viscous, at.area * at.wet),
    )


def law_on(law: FrictionLaw | EdgedLaw, state: SoleState | CellState) -> FrictionLaw | EdgedLaw:
    """Return the local friction on the cells of a state."""
    return law.on(state) if isinstance(law, EdgedLaw) else law


def friction_sums(
    law: FrictionLaw | EdgedLaw, state: SoleState, speed: float
) -> FrictionCoefficients:
    """Return the friction of an instant, without its spread."""
    at = state.finest
    shear = law_on(law, at)(at.contact_pressure, speed, at.film_thickness)
    pressures = at.contact_pressure, at.fluid_pressure
    return cof(shear, *pressures, spacing=state.spacing, wet=at.wet, **at.areas)
