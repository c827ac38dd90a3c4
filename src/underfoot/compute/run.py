"""From a case to its result."""

import re
import time
from collections.abc import Iterable, Mapping
from itertools import chain
from typing import Any

import numpy as np

from underfoot.case import Case, Option, assumptions
from underfoot.core import (
    InputError,
    Progress,
    Provenance,
    Status,
    content_hash,
    display,
    silent,
    unknown_name,
)
from underfoot.core.fields import Fields, labelled
from underfoot.friction import FrictionLaw
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe import SoleMap
from underfoot.shoe.lug_drainage import lug_drainage
from underfoot.sole_contact import SensorReading
from underfoot.sole_contact.cost import refuse_too_large
from underfoot.sole_contact.edge_peak import peak_pressure
from underfoot.sole_contact.lug_edges import EdgedLaw
from underfoot.sole_contact.slits import slit_words
from underfoot.sole_contact.solver import SoleContact

from . import numbers
from .contact import (
    Recorder,
    blind_sensor,
    chamfer_words,
    cost,
    edged_law,
    history_fields,
    scanned,
    solved_motion,
)
from .contact_friction import contact_friction
from .pictured import pictured_fields
from .positions import Place, tread_positions
from .resolve import resolved, turned
from .result import Result
from .sole import (
    compression_breaches,
    forefoot_breaches,
    outsole_notes,
    overload_breaches,
    sole_map,
)
from .summary import FILM_MATTERS

CELL_AREAS = (
    "what a cell stands for of contact and shear, in cells",
    "what a cell stands for of the fluid's pressure, in cells",
)
OBJECTS = ("friction", "rough_contact", "compliance", "risk")
"""Slots that take an object of physics in place of an option."""


def run(case: Case, *, quick: bool = False, progress: Progress = silent, **objects: Any) -> Result:
    """Return the friction of a case with everything that explains it.

    Parameters:
        case: What to compute.
        quick: Use the coarse grid of the case: a first look.
        progress: Receives stage, fraction and residual; an exception it raises stops the work.
        objects: Slot: what to take in place of the case's option. An option, its name or a mapping
            changes the case; an object of physics is used as it is: ``friction`` a ``FrictionLaw``,
            ``rough_contact`` a ``PressureGapLaw``, ``compliance`` a ``Compliance`` on the grid of
            the run, ``risk`` a ``SlipModel``. ``viscosity`` takes Pa s or text. The result names
            such objects, and its hash holds them.

    Raises:
        InputError: A case whose parts don't fit together on this grid, a slot that is none.
        ConvergenceError: Not even the first contact could be solved.
    """
    case, own = _with_objects(case, objects)
    started = time.perf_counter()
    spacing = case.numerics.quick_grid_spacing if quick else case.numerics.grid_spacing
    refuse_too_large(
        cost(case, spacing),
        most_memory=case.numerics.most_memory,
        where="numerics.quick_grid_spacing" if quick else "numerics.grid_spacing",
        spacing=spacing,
    )
    context = resolved(case, progress)
    law = own.get("friction") or case.friction.build(context)
    slip = own.get("risk") or case.risk.build()
    sole = sole_map(case, spacing, progress)
    asperities = own.get("rough_contact") or case.rough_contact.build(context)
    compliance = own.get("compliance") or case.compliance.build(context, sole)
    viscosity = case.film.build(context)

    def on_sole(there: SoleMap) -> FrictionLaw | EdgedLaw:
        return edged_law(case, context, law, there, asperities) or law

    local_law = on_sole(sole)
    recorder = Recorder(case, local_law, sole, viscosity)
    prepared = time.perf_counter()
    common: dict[str, Any] = {"viscosity": viscosity, "progress": progress}
    contact = solved_motion(case, sole, compliance, asperities, watch=recorder, **common)
    solved = time.perf_counter()
    speed = case.motion.speed
    local = {
        "contact_pressure": contact.contact_pressure,
        "speed": speed,
        "film_thickness": contact.film_thickness,
    }
    found = contact_friction(case, context, local_law, sole, contact)
    parts, lugs, friction, sampled = found.parts, found.lugs, found.sums, found.sampled
    sensor = scanned(case, sole, contact, viscosity=viscosity)

    def solved_quick(
        case: Case, place: Place, progress: Progress, finer: float = 1
    ) -> tuple[SoleMap, SoleContact]:
        where = {"shift": place.shift, "turn": place.turn, "direction": place.direction}
        there = sole_map(case, case.numerics.quick_grid_spacing, **where)
        body = case.compliance.build(turned(context, place.turn), there)
        return there, solved_motion(
            case, there, body, asperities, viscosity=viscosity, finer=finer, progress=progress
        )

    overload = overload_breaches(contact, context.youngs_modulus)
    values, risk, labels = numbers.undetermined(case, contact.status), None, {}
    positions = drainage = None
    if contact.status.usable:
        if "compliance" not in own:
            at = (case, on_sole, sole, contact, solved_quick)
            positions = tread_positions(*at, quick=quick, **common)
        solved = time.perf_counter()
        if positions:
            friction, sampled = positions.friction(friction, sampled)
        values, risk = numbers.scalars(case, contact, friction, sensor, sampled, slip)
        values |= recorder.array_scalars()
        if positions:
            values = positions.averaged(values)
        share = (values["fluid_load"].value or 0.0) / contact.normal_force
        if contact.fluid_load > FILM_MATTERS * contact.normal_force:
            drainage = lug_drainage(sole, contact.fluid_pressure, contact.film_thickness)
        remarks = {
            "lug_edges": "" if lugs is None else lugs.words() + chamfer_words(case),
            "drainage": drainage.words() if drainage else "",
            "sipes": ""
            if sole.slits is None or not sole.slits.length.any()
            else slit_words(sole.slits, giving="compliance" not in own and case.compliance.cut),
            "cof_spread_basis": getattr(law, "spread_basis", ""),
            **(positions.labels() if positions else {}),
            "overload": numbers.overload_words(overload),
            "instant": _last_instant(case),
            "edge_peak": peak_pressure(
                sole, contact.total_pressure, cell_load=contact.cell_load
            ).remark,
            "sensor": blind_sensor(case, sensor, contact),
        }
        labels = numbers.regime(share) | numbers.spread_origin(sampled)
        labels |= {name: remark for name, remark in remarks.items() if remark}
        coarse_spacing = case.numerics.quick_grid_spacing
        if case.numerics.grid_check and not quick and coarse_spacing > spacing:
            if "compliance" in own:
                raise InputError(
                    "an own compliance holds for one grid",
                    where="numerics.grid_check",
                    remedy="Set numerics.grid_check = false",
                )
            on_quick = (case, Place(), progress)
            coarse = (positions and positions.coarse) or solved_quick(*on_quick)
            # a dry contact has no memory: its steps are not steps in time
            stepped = None if viscosity is None else solved_quick(*on_quick, finer=2)

            def read(there: tuple[SoleMap, SoleContact]) -> dict[str, float]:
                return numbers.readings(there[1], scanned(case, *there, viscosity=viscosity))

            if coarse[1].status.usable and (stepped is None or stepped[1].status.usable):
                own, there = numbers.readings(contact, sensor), read(coarse)
                errors = (
                    numbers.grid_errors(own, there, coarse_spacing / spacing),
                    numbers.step_errors(there, read(stepped)) if stepped else {},
                )
                values = numbers.with_discretisation_errors(values, *errors)
                labels["grid_error"] = numbers.discretisation_words(
                    values, *errors, spacing, coarse_spacing
                )
            else:
                labels["grid_error"] = (
                    f"not estimated: a march on {coarse_spacing * 1e3:g} mm did not converge"
                )
    breaches = [
        *context.modulus_breaches,
        *overload,
        *sole.breaches,
        *compression_breaches(case, contact.approach),
        *forefoot_breaches(case, sole),
        *asperities.breaches(pressure=numbers.bearing_pressure(contact), speed=speed),
        *law.breaches(**local),
        *(risk.breaches if risk else ()),
    ]
    status = contact.status
    if status is Status.CONVERGED and breaches:
        status = Status.OUT_OF_RANGE
    identities = {slot: _identity(item) for slot, item in own.items()}
    if identities:
        labels["objects"] = "; ".join(f"{slot}: {text}" for slot, text in identities.items())
    return Result(
        name=case.name,
        scalars=values,
        labels=labels,
        data=_fields(
            sole,
            contact,
            sensor,
            parts.total - np.where(contact.wet, 0.0, parts.viscous),
            (
                history_fields(contact, recorder),
                pictured_fields(sole, contact, compliance, _map_angle(case)),
            ),
            None if sampled is None else sampled.cof,
        ).assign(
            (positions.fields() if positions else {}) | (drainage.fields() if drainage else {})
        ),
        status=status,
        breaches=_unique(map(str, breaches)),
        assumptions=_unique(
            assumptions(case),
            outsole_notes(case),
            law.assumptions,
            risk.assumptions if risk else (),
            positions.assumptions() if positions else (),
            (f"{slot}: an object given to run, {text}" for slot, text in identities.items()),
        ),
        provenance=Provenance.now(
            content_hash(case.hash, identities)[:32] if identities else case.hash,
            closures={
                "friction": law.name,
                "asperity contact": asperities.name,
                "film": case.film.closure if case.contaminant else "none: dry floor",
                "compliance": identities.get("compliance", case.compliance.name),
                "modulus": context.modulus.source,
                "slip": slip.name if "risk" in own else case.risk.name,
                "grid": f"{spacing * 1e3:g} mm",
            },
            citations=_unique(
                each.source
                for each in (law, asperities, context.modulus, values["slip_probability"])
            ),
            errata=tuple(
                f"{path}: {origin.leaf.erratum}"
                for path, origin in case.origins.items()
                if origin.leaf.erratum
            ),
            timings={
                "preparation_s": prepared - started,
                "solution_s": solved - prepared,
                "evaluation_s": time.perf_counter() - solved,
            },
            objects=identities,
        ),
        case_text=case.to_toml(complete=True),
    )


def _with_objects(case: Case, objects: Mapping[str, Any]) -> tuple[Case, dict[str, Any]]:
    """Return the case with the options among the objects, and the objects of physics."""
    own: dict[str, Any] = {}
    for slot, item in objects.items():
        if slot == "viscosity":
            case = case.replace("contaminant.viscosity", item)
        elif isinstance(item, str | Mapping | Option):
            case = case.replace(slot, item)
        elif slot not in OBJECTS:
            raise unknown_name("slot", slot, (*OBJECTS, "viscosity"), where=f"run(..., {slot}=)")
        else:
            own[slot] = item
    for slot, protocol in (("friction", FrictionLaw), ("rough_contact", PressureGapLaw)):
        if slot in own and not isinstance(own[slot], protocol):
            names = [name for name in dir(protocol) if not name.startswith("_")]
            missing = [name for name in names if not hasattr(own[slot], name)]
            raise InputError(
                f"{type(own[slot]).__name__} is no {protocol.__name__}: it has no "
                + ", ".join(missing or ["__call__"]),
                where=f"run(..., {slot}=)",
                allowed=f"an object with {', '.join(names)}",
            )
    return case, own


def _map_angle(case: Case) -> float:
    """Return the angle from which the sole rolls: a steady motion is solved on the map as it is."""
    return 0.0 if case.motion.build() is None else case.motion.shoe_angle


def _last_instant(case: Case) -> str:
    """Return when and at which angle a motion that turns ends; empty where the angle is held."""
    history = case.motion.build()
    if history is None or not np.ptp(history.shoe_angle):
        return ""
    time, angle = display(history.time[-1], "s"), display(history.shoe_angle[-1], "rad")
    return f"at the end of the motion ({time}, shoe angle {angle})"


def _identity(item: Any) -> str:
    """Return a text that stands for an object in a hash: its class and what its repr says."""
    cls = f"{type(item).__module__}.{type(item).__qualname__}"
    name, text = getattr(item, "name", ""), repr(item)
    if re.search(r" at 0x[0-9a-f]+", text):  # the repr of no class of its own
        text = f"{name} (without a repr of its own)".strip()
    return f"{cls}: {text}"


def _unique(*texts: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(chain(*texts)))


def _fields(
    sole: SoleMap,
    contact: SoleContact,
    sensor: SensorReading,
    shear: object,
    further: Iterable[tuple[dict[str, Any], dict[str, Any]]],
    draws: np.ndarray | None,
) -> Fields:
    def on_sole(values: object, unit: str, name: str) -> tuple[tuple[str, str], object, dict]:
        return (("x", "y"), values, {"units": unit, "long_name": name})

    drawn = {"units": "1", "long_name": "draws of COF"}
    variables = {name: each for more, _ in further for name, each in more.items()}
    coordinates = {name: each for _, more in further for name, each in more.items()}
    return labelled(
        {
            "contact_pressure": on_sole(
                contact.contact_pressure, "Pa", "asperity contact pressure"
            ),
            "fluid_pressure": on_sole(contact.fluid_pressure, "Pa", "fluid pressure"),
            "film_thickness": on_sole(contact.film_thickness, "m", "mean gap, at most the pool"),
            "shear_stress": on_sole(shear, "Pa", "shear stress on the sole"),
            "clearance": on_sole(sole.clearance, "m", "height of the undeformed sole"),
            "inside": on_sole(sole.inside, "1", "within the plan form"),
            "land": on_sole(sole.land, "1", "can touch the floor"),
            "wet": on_sole(contact.wet, "1", "within the film"),
            **{
                f"cell_{name}": on_sole(share, "1", words)
                for (name, share), words in zip(contact.areas.items(), CELL_AREAS, strict=True)
            },
            "sensor_pressure": (
                ("sensor_x", "sensor_y"),
                sensor.pressure,
                {"units": "Pa", "long_name": "fluid pressure as floor sensors read it"},
            ),
            "outline_x": ("outline", sole.outline[:, 0], {"units": "m"}),
            "outline_y": ("outline", sole.outline[:, 1], {"units": "m"}),
            **variables,
            **({} if draws is None else {"cof_draws": ("draw", draws, drawn)}),
        },
        {
            "x": ("x", sole.x, {"units": "m", "long_name": "along the walking direction"}),
            "y": ("y", sole.y, {"units": "m", "long_name": "across"}),
            **coordinates,
            "sensor_x": ("sensor_x", sensor.x, {"units": "m"}),
            "sensor_y": ("sensor_y", sensor.scan_y, {"units": "m"}),
        },
    )
