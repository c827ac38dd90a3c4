"""Friction and slips of a shoe on each floor and in each fluid of a place, drawn."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.special import expit

from underfoot.case import Case
from underfoot.compute.contact_friction import place_of_tread, sole_errors
from underfoot.compute.continuation import Continuation
from underfoot.compute.positions import has_lugs, place_numbers, places
from underfoot.compute.prepare import prepare_case
from underfoot.compute.resolve import resolve_context
from underfoot.compute.sole import file_periods, sole_map
from underfoot.compute.solve import solved_at
from underfoot.compute.stated_spreads import ODDS, odds_changes, sum_of_draws
from underfoot.core import ConvergenceError, InputError
from underfoot.core.arrays import Array
from underfoot.friction import PairContactLaw
from underfoot.friction.pair_contact import CONTACT_PRESSURE, TERMS, ContactTerms, Pair
from underfoot.friction.shoe_class import SPEED, SlipTest
from underfoot.friction.tread_error import tread_error
from underfoot.slip import RcofPopulation, ReportG6, slip_chances

from .joint import PlaceDraws
from .place import Place, PlaceFloor, PlaceShoe

MODEL = ReportG6()
POSITIONS = 2
"""Places of a tread, half a period apart, whose film counts."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A shoe on a floor under a fluid: draws (count,) of the available friction."""

    acof: Array
    solved: float
    film_share: float


@dataclass(frozen=True)
class PlaceSolver:
    """Cells of a place: one march a sole, continued to every floor and fluid."""

    place: Place
    joint: PlaceDraws
    quick: bool
    read: Mapping[str, PlaceFloor]
    """Floors with the roughness that their readings leave, by name: what is solved."""
    marches: dict[tuple[str, bool], tuple[Continuation, Array]] = field(default_factory=dict)
    """What is continued of soles, new and worn, and their ``film_odds_over_positions``."""

    def cells(
        self, shoe: PlaceShoe, floors: Sequence[PlaceFloor], worn: bool
    ) -> dict[tuple[str, str], Cell]:
        """Return the cell of each floor and fluid, by their names."""
        wanted = [(floor, fluid) for floor in floors for fluid in floor.fluids if fluid != "dry"]
        solved_floors = {floor.name: self.read.get(floor.name, floor) for floor in floors}
        cases = [
            self.place.case(shoe, solved_floors[floor.name], fluid, worn) for floor, fluid in wanted
        ]
        # a thick film is where continuation begins from best
        order = sorted(
            range(len(cases)), key=lambda i: -(resolve_context(cases[i]).viscosity_value or 0)
        )
        sole, first = (shoe.name, worn), cases[order[0]]
        if sole not in self.marches:
            begun = Continuation(first, quick=self.quick)
            self.marches[sole] = begun, film_odds_over_positions(first)
        (march, moved), tread = self.marches[sole], tread_place(first)
        found = {}
        for number in order:
            case, (floor, fluid) = cases[number], wanted[number]
            solved = march
            if case.hash != march.case.hash:
                try:
                    section = dict(solved_floors[floor.name].section)
                    changes = {"floor": section, "contaminant": fluid}
                    values = march.continue_march(changes, drawn=False).values
                except (InputError, ConvergenceError):
                    solved = Continuation(case, quick=self.quick)
                    values = solved.values
            else:
                values = march.values
            pair = law_of_pair(self.place.case(shoe, floor, fluid, worn)).pair
            found[floor.name, fluid] = self._cell(
                case, values, solved, shoe, floor, pair, moved, tread
            )
        return found

    def _cell(
        self,
        case: Any,
        values: Mapping[str, float],
        march: Continuation,
        shoe: PlaceShoe,
        floor: PlaceFloor,
        pair: Pair,
        moved: Array,
        tread: Array,
    ) -> Cell:
        context = resolve_context(case)
        law = case.friction.build(context)
        assert isinstance(law, PairContactLaw)
        joint, viscosity = self.joint, law.viscosity
        drag = None if viscosity is None else viscosity * case.motion.speed
        film = 0.0
        if viscosity is not None:
            film = float(np.clip(values["fluid_load"] / case.motion.normal_force, 0.0, 0.999))
        viscous = max(values["cof_viscous"], 0.0) if film else 0.0
        terms = ContactTerms(*(np.asarray(law.medians[name]) for name in TERMS))
        reference = float(terms.adhesion(CONTACT_PRESSURE, drag) + terms.hysteresis)
        solved = max(values["cof"], 1e-4)
        factor = max(solved - viscous, 1e-4) / (1 - film) / reference
        mu = joint.contact_cof(
            pair, laboratory="the place", floor=floor.name, sole=shoe_name(shoe),
            pressure=CONTACT_PRESSURE, drag=drag,
        )  # fmt: skip
        errors = {
            name: joint.error(error, tread) for name, error in sole_errors(case, context).items()
        }
        stated = march.stated.of(case).draws(joint.normal) if film > 0 else {}
        share = np.zeros(joint.count)
        if film > 0:
            odds = math.log(film / (1 - film)) + errors["film_error"] + moved.mean()
            odds = odds + moved.std() * joint.normal(f"position of the tread of {shoe_name(shoe)}")
            for name, (less, more) in march.spreads.items():
                normal = joint.normal(f"{name} of the rough contact on {floor.name}")
                odds = odds + odds_changes(less, more, normal)
            share = expit(odds + sum_of_draws(stated, ODDS))
        acof = factor * mu * (1 - share) * np.exp(errors["tread_error"])
        if film > 0:
            acof = acof + viscous * np.exp(sum_of_draws(stated, "cof_viscous")) * share / film
        return Cell(np.clip(acof, 0.0, law.highest), solved, film)


def film_odds_over_positions(case: Case) -> Array:
    """Return ln of the odds of the film's share of the load, less that at the tread's own place.

    (places,), the first 0: places half a period of the tread apart, on the quick grid. Of a sole
    without tread or film 0 alone.
    """
    if not has_lugs(case) or case.contaminant is None:
        return np.zeros(1)
    tread = case.shoe.tread and case.shoe.tread.build()
    spacing = case.numerics.quick_grid_spacing
    parts, odds = prepare_case(case, spacing), []
    for place in places(tread.periods if tread else file_periods(case), POSITIONS):
        load = place_numbers(*solved_at(parts, place, spacing))["fluid_load"]
        share = float(np.clip(load / case.motion.normal_force, 1e-6, 0.999))
        odds.append(math.log(share / (1 - share)))
    return np.array(odds) - odds[0]


def tread_place(case: Case) -> Array:
    """Return the place of a case's tread, (6,), on the quick grid (``place_of_tread``)."""
    return place_of_tread(case, sole_map(case, case.value("numerics.quick_grid_spacing")))


def shoe_name(shoe: PlaceShoe) -> str:
    """Return the name of a sole's errors: the same sole twice has the same."""
    return repr((sorted(shoe.section.items()), shoe.known_class, shoe.readings))


def tested_cof(
    joint: PlaceDraws, case: Any, law: PairContactLaw, shoe: PlaceShoe, test: SlipTest
) -> Array:
    """Return draws (count,) of the COF that a test house reads of the new sole of a case."""
    pair = replace(law.pair, floor_rq=test.floor_rq, family=test.family, floor_slope=None)
    cof = joint.contact_cof(
        pair, laboratory=f"test house of {shoe.name}", floor=test.name, sole=shoe_name(shoe),
        pressure=CONTACT_PRESSURE, drag=test.viscosity * SPEED,
    )  # fmt: skip
    return cof * np.exp(joint.error(tread_error(test.viscosity), tread_place(case)))


def law_of_pair(case: Any) -> PairContactLaw:
    """Return the law of the pair of a case."""
    law = case.friction.build(resolve_context(case))
    assert isinstance(law, PairContactLaw)
    return law


def slip_share(acof: Array, rcof: float, sd: float, slope: float, joint: PlaceDraws) -> Array:
    """Return the share (count,) of steps that slip, as ``run`` has it.

    Parameters:
        acof: Draws (count,) of the available friction.
        rcof, sd: Required friction on the level, mean and standard deviation between people.
        slope: Of the floor, rad; the friction that a step needs there is tan(slope + atan r).
    """
    people = RcofPopulation(rcof, sd).on_slope(slope)
    return slip_chances(acof, people, MODEL, joint.normal)


def slips_in_cells(
    place: Place, joint: PlaceDraws, cells: Mapping[tuple[str, str], Cell]
) -> dict[tuple[str, str], Array]:
    """Return the share of all steps that slip on each floor under each fluid, (count,)."""
    shares = {}
    for floor in place.floors:
        for fluid, often in floor.fluids.items():
            if fluid == "dry":
                continue
            at, steps = cells[floor.name, fluid].acof, floor.share * often
            shares[floor.name, fluid] = sum(
                steps * task.share * slip_share(at, task.rcof, place.rcof_sd, floor.slope, joint)
                for task in place.tasks
            )
    return shares


def sum_of_shares(shares: Mapping[tuple[str, str], Array]) -> Array:
    """Return the sum of shares in the order of names, whatever that of floors in the file."""
    return np.sum([shares[key] for key in sorted(shares)], axis=0)
