"""What a case becomes before it is solved: its sole on a grid, the physics of its slots."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from underfoot.case import Case, Option
from underfoot.case.context import Context
from underfoot.core import InputError, Progress, content_hash, silent, unknown_name
from underfoot.core.identity import attributes
from underfoot.core.remark import Message
from underfoot.film import FilmModel, NewtonianFilm
from underfoot.friction import FrictionLaw
from underfoot.friction.film_shear import FilmShearLaw
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe import SoleMap
from underfoot.slip.model import SlipModel
from underfoot.sole_contact.compliance import Compliance
from underfoot.sole_contact.lug_edges import EdgedLaw, lug_edges

from .contact_friction import of_known_class, with_known_tread
from .resolve import resolve_context, turn_context
from .sole import sole_map

PROTOCOLS: Mapping[str, type] = {
    "friction": FrictionLaw,
    "rough_contact": PressureGapLaw,
    "compliance": Compliance,
    "film": FilmModel,
    "risk": SlipModel,
}
"""Slots that take an object of physics in place of an option, and what it must be able to do."""


@dataclass(frozen=True, slots=True)
class Prepared:
    """A case on one grid, ready to be solved.

    Attributes:
        sole: Undeformed, on cells of ``spacing`` (m).
        law: Local friction; ``local_law`` is the same with what the edges of the sole's lugs do.
        film: None where no fluid builds up pressure.
        objects: Slot: object that was given in place of the case's option.
    """

    case: Case
    context: Context
    spacing: float
    sole: SoleMap
    compliance: Compliance
    asperities: PressureGapLaw
    law: FrictionLaw
    local_law: FrictionLaw | EdgedLaw
    slip_model: SlipModel
    film: FilmModel | None
    objects: Mapping[str, Any] = field(default_factory=dict)

    @property
    def viscosity(self) -> float | None:
        """Viscosity of the film, Pa s; None where no fluid builds up pressure."""
        return None if self.film is None else self.film.viscosity

    def on(
        self,
        sole: SoleMap | None = None,
        *,
        turn: float = 0.0,
        asperities: PressureGapLaw | None = None,
    ) -> Prepared:
        """Return the case on another map of the sole or on other asperities.

        ``turn`` (rad) turns the shoe of another map; a compliance that was given stays.
        """
        compliance = self.compliance
        if sole is not None and "compliance" not in self.objects:
            context = turn_context(self.context, turn)
            compliance = self.case.compliance.rebuilt(self.compliance, context, sole)
        sole = self.sole if sole is None else sole
        asperities = self.asperities if asperities is None else asperities
        edged = edged_law(self.case, self.context, self.law, sole, asperities)
        return replace(
            self,
            spacing=sole.spacing,
            sole=sole,
            compliance=compliance,
            asperities=asperities,
            local_law=edged or self.law,
        )


def prepare_case(
    case: Case,
    spacing: float,
    objects: Mapping[str, Any] | None = None,
    *,
    geometry: tuple[SoleMap, Compliance] | None = None,
    progress: Progress = silent,
) -> Prepared:
    """Return a case on cells of ``spacing`` (m).

    Parameters:
        objects: As ``case_and_objects`` returns them.
        geometry: Sole and compliance, where they are known already.
    """
    objects = dict(objects or {})
    context = resolve_context(case, progress)

    def build_slot(slot: str, build: Callable[[], Any]) -> Any:
        return objects[slot] if slot in objects else with_members(slot, build(), f"{slot}.model")

    film = objects["film"] if "film" in objects else case.film.build(context)
    law = build_slot("friction", lambda: case.friction.build(context))
    sole = geometry[0] if geometry else sole_map(case, spacing, progress)
    if "friction" not in objects:
        law = of_known_class(law, case, sole)
    law = with_known_tread(law, case, context, sole)
    if film is not None and not isinstance(film, NewtonianFilm):
        law = FilmShearLaw(law, with_members("film", film, "film.model"))
    asperities = build_slot("rough_contact", lambda: case.rough_contact.build(context))

    def compliance() -> Compliance:
        return geometry[1] if geometry else case.compliance.build(context, sole)

    return Prepared(
        case=case,
        context=context,
        spacing=spacing,
        sole=sole,
        compliance=build_slot("compliance", compliance),
        asperities=asperities,
        law=law,
        local_law=edged_law(case, context, law, sole, asperities) or law,
        slip_model=build_slot("risk", case.risk.build),
        film=film,
        objects=objects,
    )


def case_and_objects(case: Case, given: Mapping[str, Any]) -> tuple[Case, dict[str, Any]]:
    """Return the case with the options among what is given by slot, and the objects of physics.

    Raises:
        InputError: A slot that is none, an object that lacks a member or holds nan.
    """
    objects: dict[str, Any] = {}
    for slot, item in given.items():
        if slot == "viscosity":
            case = case.replace("contaminant.viscosity", item)
        elif isinstance(item, str | Mapping | Option):
            case = case.replace(slot, item)
        elif slot not in PROTOCOLS:
            raise unknown_name("slot", slot, (*PROTOCOLS, "viscosity"), where=f"run(..., {slot}=)")
        else:
            objects[slot] = checked_object(slot, item)
    return case, objects


def checked_object(slot: str, item: Any) -> Any:
    """Return an object of physics; refuse one that lacks a member or holds nan."""
    where = f"run(..., {slot}=)"
    for name, value in attributes(with_members(slot, item, where)).items():
        if isinstance(value, np.ndarray) and value.dtype.kind == "f" and np.isnan(value).any():
            raise InputError(
                Message(
                    "{owner}.{name} holds nan at {place}",
                    owner=type(item).__name__,
                    name=name,
                    place=str(np.argwhere(np.isnan(value))[0]),
                ),
                where=where,
                allowed="numbers",
            )
    return item


def with_members(slot: str, item: Any, where: str) -> Any:
    """Return an object of physics; refuse one that lacks a member of its slot's protocol."""
    protocol = PROTOCOLS[slot]
    if not isinstance(item, protocol):
        names = [name for name in dir(protocol) if not name.startswith("_")]
        missing = [name for name in names if not hasattr(item, name)]
        raise InputError(
            Message(
                "{name} is no {protocol}: it has no {missing}",
                name=type(item).__name__,
                protocol=protocol.__name__,
                missing=missing or ["__call__"],
            ),
            where=where,
            allowed=Message("an object with {names}", names=", ".join(names)),
        )
    return item


def case_hash(case: Case, objects: Mapping[str, Any]) -> str:
    """Return the hash of a case with what was given in place of its options."""
    return content_hash(case.hash, dict(objects))[:32] if objects else case.hash


def object_texts(objects: Mapping[str, Any]) -> dict[str, str]:
    """Return class, name and content of each object, by slot."""
    return {
        slot: f"{type(item).__module__}.{type(item).__qualname__} "
        f"{getattr(item, 'name', '')} [{content_hash(item)[:12]}]"
        for slot, item in objects.items()
    }


def edged_law(
    case: Case, context: Context, law: FrictionLaw, sole: SoleMap, asperities: PressureGapLaw
) -> EdgedLaw | None:
    """Return the law with what the edges of lugs do; None without lugs or without a film."""
    viscosity, film = context.viscosity_value, case.film
    if viscosity is None or not getattr(film, "lug_edges", False):
        return None
    moulded, worn = getattr(case.shoe.tread, "edge_radius", 0.0), case.shoe.wear.edge_radius
    edges = lug_edges(sole, moulded, worn_edge_radius=worn, forward=case.motion.forward)
    if edges is None:
        return None
    pull = case.value("film.suction"), case.value("film.dewetting")
    return EdgedLaw(law, edges, asperities, context.youngs_modulus, viscosity, *pull)
