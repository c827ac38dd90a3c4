"""From a case to its result: geometry, compliance, film and contact, friction, slip."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import (
    Breach,
    Progress,
    Provenance,
    SourcedValue,
    Status,
    silent,
)

from . import build
from .build_motion import Recorder, history_fields, refuse_too_large, scanned, solved_motion
from .build_outsole import compression_breaches
from .describe import assumptions, given_in_vain
from .grid_error import grid_errors, grid_words, readings, with_grid_errors
from .result import Result
from .scalars import regime, scalars, spread_origin, undetermined

if TYPE_CHECKING:
    import xarray

    from underfoot.asperity.law import PressureGapLaw
    from underfoot.outsole import SensorReading, SoleMap
    from underfoot.outsole.solver import SoleContact

    from .case import Case


def run(case: Case, *, quick: bool = False, progress: Progress = silent) -> Result:
    """Return the friction of a case with everything that explains it.

    Parameters
    ----------
    case
        What to compute.
    quick
        Use the coarse grid of the case: a first look.
    progress
        Receives stage, fraction and residual; an exception it raises stops the work.

    Errors
    ------
    InputError
        A case whose parts don't fit together on this grid.
    ConvergenceError
        Not even the first contact could be solved.
    """
    from underfoot.friction import cof, sampled_cof
    from underfoot.outsole.edge_peak import peak_pressure

    started = time.perf_counter()
    spacing = case.numerics.quick_grid_spacing if quick else case.numerics.grid_spacing
    named = "numerics.quick_grid_spacing" if quick else "numerics.grid_spacing"
    refuse_too_large(case, spacing, named)
    law = build.friction_law(case, case.catalogue)
    modulus, found = build.youngs_modulus(case)
    fluid = build.viscosity(case)
    assert modulus.value is not None
    sole = build.sole_map(case, spacing, progress)
    asperities = build.asperity_law(case, modulus.value, progress)
    motion = case.motion
    recorder = Recorder(case, law, sole)
    prepared = time.perf_counter()
    contact = solved_motion(
        case,
        sole,
        build.compliance(case, sole, modulus.value, progress),
        asperities,
        viscosity=None if fluid is None else fluid.value,
        watch=recorder,
        progress=progress,
    )
    solved = time.perf_counter()
    local = {
        "contact_pressure": contact.contact_pressure,
        "speed": motion.speed,
        "film_thickness": contact.film_thickness,
    }
    parts = law(**local)
    sampled = sampled_cof(
        law,
        contact.contact_pressure,
        contact.fluid_pressure,
        contact.film_thickness,
        speed=motion.speed,
        wet=contact.wet,
        fluid_inputs={} if fluid is None else {"viscosity": fluid},
        seed=case.numerics.seed,
    )
    friction = cof(
        parts,
        contact.contact_pressure,
        contact.fluid_pressure,
        spacing=sole.spacing,
        wet=contact.wet,
        sampled=sampled,
        source=f"{law.name} law: {law.source}",
    )
    sensor = scanned(case, sole, contact)
    usable = contact.status.usable
    numbers, risk = (
        scalars(case, contact, friction, sensor, sampled)
        if usable
        else (undetermined(case, contact.status), None)
    )
    labels = {**regime(contact), **spread_origin(sampled)} if usable else {}
    if usable:
        if aside := given_in_vain(case):
            labels["given_in_vain"] = "; ".join(aside)
        if remark := peak_pressure(sole, contact.total_pressure).remark:
            labels["edge_peak"] = remark
        numbers |= recorder.array_scalars()
        coarse_spacing = case.numerics.quick_grid_spacing
        if case.numerics.grid_check and not quick and coarse_spacing > spacing:
            coarse = _readings_on(case, coarse_spacing, modulus.value, asperities, fluid, progress)
            if coarse is not None:
                errors = grid_errors(readings(contact, sensor), coarse, coarse_spacing / spacing)
                numbers = with_grid_errors(numbers, errors)
                labels["grid_error"] = grid_words(numbers, errors, spacing, coarse_spacing)
    found = [
        *found,
        *sole.breaches,
        *compression_breaches(case, contact.approach),
        *asperities.breaches(pressure=contact.contact_pressure.max(), speed=motion.speed),
        *law.breaches(**local),
        *(risk.breaches if risk else ()),
    ]
    status = contact.status
    if status is Status.CONVERGED and found:
        status = Status.OUT_OF_RANGE
    return Result(
        name=case.name,
        scalars=numbers,
        labels=labels,
        fields=_fields(
            sole,
            contact,
            sensor,
            parts.total - np.where(contact.wet, 0.0, parts.viscous),
            history_fields(contact, recorder),
        ),
        status=status,
        breaches=_words(found),
        assumptions=tuple(
            dict.fromkeys(
                (*assumptions(case), *law.assumptions, *(risk.assumptions if risk else ()))
            )
        ),
        provenance=Provenance.now(
            case.hash,
            closures=_closures(case, law.name, asperities.name, modulus, case.risk.model, spacing),
            citations=tuple(
                dict.fromkeys((law.source, asperities.source, modulus.source, _source(numbers)))
            ),
            errata=_errata(case),
            timings={
                "preparation_s": prepared - started,
                "solution_s": solved - prepared,
                "evaluation_s": time.perf_counter() - solved,
            },
        ),
        case_text=case.to_toml(complete=True),
    )


def _readings_on(
    case: Case,
    spacing: float,
    modulus: float,
    asperities: PressureGapLaw,
    fluid: SourcedValue | None,
    progress: Progress,
) -> dict[str, float] | None:
    """Return the readings of the case on another grid; None where that did not converge."""
    sole = build.sole_map(case, spacing)
    contact = solved_motion(
        case,
        sole,
        build.compliance(case, sole, modulus),
        asperities,
        viscosity=None if fluid is None else fluid.value,
        progress=progress,
    )
    return readings(contact, scanned(case, sole, contact)) if contact.status.usable else None


def _closures(
    case: Case, friction: str, asperity: str, modulus: SourcedValue, slip: str, spacing: float
) -> dict[str, str]:
    cavitation = "Reynolds equation with cavitation, wedge and squeeze (Eq. 4, 5)"
    return {
        "friction": friction,
        "asperity contact": asperity,
        "film": cavitation if case.contaminant else "none: dry floor",
        "compliance": case.models.compliance,
        "modulus": modulus.source,
        "slip": slip,
        "grid": f"{spacing * 1e3:g} mm",
    }


def _source(numbers: dict[str, SourcedValue]) -> str:
    return numbers["slip_probability"].source


def _words(found: list[Breach]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(str(breach) for breach in found))


def _errata(case: Case) -> tuple[str, ...]:
    """Return the notes on printed values that the case uses in corrected form."""
    notes = [
        f"{path}: {origin.leaf.note}"
        for path, origin in case.origins.items()
        if "printed as" in origin.leaf.note and case.value(path) is not None
    ]
    return tuple(dict.fromkeys(notes))


def _fields(
    sole: SoleMap,
    contact: SoleContact,
    sensor: SensorReading,
    shear: object,
    in_time: tuple[dict[str, Any], dict[str, Any]],
) -> xarray.Dataset:
    import xarray

    def on_sole(values: object, unit: str, name: str) -> tuple[tuple[str, str], object, dict]:
        return (("x", "y"), values, {"units": unit, "long_name": name})

    histories, times = in_time
    return xarray.Dataset(
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
            "sensor_pressure": (
                ("sensor_x", "sensor_y"),
                sensor.pressure,
                {"units": "Pa", "long_name": "fluid pressure as floor sensors read it"},
            ),
            "outline_x": ("outline", sole.outline[:, 0], {"units": "m"}),
            "outline_y": ("outline", sole.outline[:, 1], {"units": "m"}),
            **histories,
        },
        coords={
            "x": ("x", sole.x, {"units": "m", "long_name": "along the walking direction"}),
            "y": ("y", sole.y, {"units": "m", "long_name": "across"}),
            **times,
            "sensor_x": ("sensor_x", sensor.x, {"units": "m"}),
            "sensor_y": ("sensor_y", sensor.scan_y, {"units": "m"}),
        },
    )
