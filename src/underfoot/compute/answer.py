"""The result of a case from what was prepared, solved and read: words, maps and provenance."""

from collections.abc import Iterable, Mapping
from itertools import chain
from typing import Any

from underfoot.case import assumptions
from underfoot.core import Breach, Provenance, Status
from underfoot.core.fields import Fields, labelled_fields
from underfoot.core.remark import Message, Remark, join_lines, remarks
from underfoot.film import NewtonianFilm

from . import numbers
from .histories import history_fields
from .pictured import pictured_fields
from .position_draws import TreadPositions
from .prepare import Prepared, case_hash, object_texts
from .read import ResultNumbers
from .result import Result
from .sole import compression_breaches, forefoot_breaches, outsole_notes, tread_breaches
from .solve import Solution

CELL_AREAS = (
    "what a cell stands for of contact and shear, in cells",
    "what a cell stands for of the fluid's pressure, in cells",
)


def answer(
    parts: Prepared,
    solution: Solution,
    positions: TreadPositions | None,
    reading: ResultNumbers,
    timings: Mapping[str, float],
) -> Result:
    """Return the result of a case."""
    case, status = parts.case, solution.contact.status
    breaches = _breaches(parts, solution, reading)
    if status is Status.CONVERGED and breaches:
        status = Status.OUT_OF_RANGE
    objects = object_texts(parts.objects)
    labels = dict(reading.labels)
    if objects:
        labels["objects"] = join_lines(Remark.of(slot, text) for slot, text in objects.items())
    risk = reading.risk
    return Result(
        name=case.name,
        scalars=reading.values,
        labels=labels,
        data=_fields(parts, solution, positions, reading),
        status=status,
        breaches=remarks(getattr(breach, "remark", breach) for breach in breaches),
        assumptions=remarks(
            (
                *assumptions(case),
                *outsole_notes(case),
                *parts.law.assumptions,
                *(risk.assumptions if risk else ()),
                *(positions.assumptions() if positions else ()),
                *(
                    Remark(slot, "an object given to run, {text}", text=text)
                    for slot, text in objects.items()
                ),
            )
        ),
        provenance=_provenance(parts, reading, objects, timings),
        case_text=case.to_toml(complete=True),
    )


def _breaches(parts: Prepared, solution: Solution, reading: ResultNumbers) -> list[Breach | str]:
    """Return what left the range on which it was tested."""
    case, contact, speed = parts.case, solution.contact, parts.case.motion.speed
    return [
        *parts.context.modulus_breaches,
        *reading.overload,
        *parts.sole.breaches,
        *compression_breaches(case, contact.approach),
        *forefoot_breaches(case, parts.sole),
        *tread_breaches(parts.sole, parts.context.rq_value),
        *parts.asperities.breaches(pressure=numbers.bearing_pressure(contact), speed=speed),
        *parts.law.breaches(
            contact_pressure=contact.contact_pressure,
            speed=speed,
            film_thickness=contact.film_thickness,
        ),
        *(reading.risk.breaches if reading.risk else ()),
    ]


def _provenance(
    parts: Prepared,
    reading: ResultNumbers,
    objects: Mapping[str, str],
    timings: Mapping[str, float],
) -> Provenance:
    case, modulus = parts.case, parts.context.modulus
    cited = (parts.law, parts.asperities, modulus, reading.values["slip_probability"])
    return Provenance.now(
        case_hash(case, parts.objects),
        grid=parts.spacing,
        closures={
            "friction": parts.law.name,
            "asperity contact": parts.asperities.name,
            "film": _film_closure(parts),
            "compliance": objects.get("compliance", case.compliance.name),
            "modulus": modulus.source,
            "slip": parts.slip_model.name if "risk" in parts.objects else case.risk.name,
            "grid": f"{parts.spacing * 1e3:g} mm",
        },
        citations=_unique(each.source for each in cited),
        errata=tuple(
            Message("{path}: {erratum}", path=path, erratum=origin.leaf.erratum)
            for path, origin in case.origins.items()
            if origin.leaf.erratum
        ),
        timings=dict(timings),
        objects=dict(objects),
    )


def _film_closure(parts: Prepared) -> str:
    """Return the equation of the film."""
    if parts.case.contaminant is None:
        return "none: no fluid"
    film, closure = parts.film, parts.case.film.closure
    return closure if film is None or isinstance(film, NewtonianFilm) else film.source


def _unique(*texts: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(chain(*texts)))


def _fields(
    parts: Prepared, solution: Solution, positions: TreadPositions | None, reading: ResultNumbers
) -> Fields:
    """Return maps, histories and draws with their axes."""
    sole, contact, sampled = parts.sole, solution.contact, reading.sampled
    # a steady motion is solved on the map as it is
    rolls_from = 0.0 if parts.case.motion.build() is None else parts.case.motion.shoe_angle
    pictured = pictured_fields(sole, contact, parts.compliance, rolls_from)
    variables, coordinates = (
        earlier | later
        for earlier, later in zip(history_fields(contact, solution.recorder), pictured, strict=True)
    )
    sensor, metres = solution.sensor, {"units": "m"}
    if sampled is not None:
        drawn = {"units": "1", "long_name": "draws of COF"}
        variables["cof_draws"] = ("draw", sampled.cof, drawn)
    data = labelled_fields(
        {
            **_sole_maps(parts, solution),
            "sensor_pressure": (
                ("sensor_x", "sensor_y"),
                sensor.pressure,
                {"units": "Pa", "long_name": "fluid pressure as floor sensors read it"},
            ),
            "outline_x": ("outline", sole.outline[:, 0], metres),
            "outline_y": ("outline", sole.outline[:, 1], metres),
            **variables,
        },
        {
            "x": ("x", sole.x, {"units": "m", "long_name": "along the walking direction"}),
            "y": ("y", sole.y, {"units": "m", "long_name": "across"}),
            **coordinates,
            "sensor_x": ("sensor_x", sensor.x, metres),
            "sensor_y": ("sensor_y", sensor.scan_y, metres),
        },
    )
    at_positions = positions.fields() if positions else {}
    return data.assign(at_positions | (reading.drainage.fields() if reading.drainage else {}))


def _sole_maps(parts: Prepared, solution: Solution) -> dict[str, tuple[tuple[str, str], Any, dict]]:
    """Return the maps of contact, film and sole on (x, y)."""
    sole, contact, shear = parts.sole, solution.contact, solution.friction.parts
    maps = {
        "contact_pressure": (contact.contact_pressure, "Pa", "asperity contact pressure"),
        "fluid_pressure": (contact.fluid_pressure, "Pa", "fluid pressure"),
        "film_thickness": (contact.film_thickness, "m", "mean gap, at most the pool"),
        "shear_stress": (shear.total, "Pa", "shear stress on the sole"),
        "clearance": (sole.clearance, "m", "height of the undeformed sole"),
        "inside": (sole.inside, "1", "within the plan form"),
        "land": (sole.land, "1", "can touch the floor"),
        "wet": (contact.wet, "1", "within the film"),
        **{
            f"cell_{name}": (share, "1", meaning)
            for (name, share), meaning in zip(contact.areas.items(), CELL_AREAS, strict=True)
        },
    }
    return {
        name: (("x", "y"), values, {"units": unit, "long_name": meaning})
        for name, (values, unit, meaning) in maps.items()
    }
