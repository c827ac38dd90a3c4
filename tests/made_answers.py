"""Answers made by hand: a result, a comparison, a risk, a sensitivity, a series of wear."""

import dataclasses
import math
from typing import Any

import numpy as np

from small_soles import sole
from underfoot.case import Case
from underfoot.compute import summary
from underfoot.compute.result import Result
from underfoot.core import Provenance, Remark, SourcedValue, Status
from underfoot.questions.changes import Change
from underfoot.questions.effects import ChangeEffect
from underfoot.questions.outcomes import CaseOutcome
from underfoot.questions.risk import ModelRisk, RiskAssessment
from underfoot.questions.sensitivity import InputEffect, Sensitivity
from underfoot.questions.wear import WearSeries
from underfoot.questions.wear_limit import Crossing, LimitCrossing, WearPoint
from underfoot.shoe.worn import WearMeasures

CASE = Case.from_mapping(
    {
        "name": "worn <shoe>",
        "shoe": {
            "from": "work_shoe_untreaded",
            "heel": {"length": "30 mm", "width": "25 mm", "rear_radius": "10 mm"},
        },
        "floor": "vinyl_g4",
        "contaminant": "glycerol_90pct",
        "motion": {"from": "slip_tester_g4"},
        "numerics": {"grid_spacing": "4 mm", "quick_grid_spacing": "5 mm"},
    }
)


def scalars(cof=0.1, slip=0.6, fluid=100.0, note="", spread: float | None = 0.02):
    """Return the numbers of a run."""
    return {
        "cof": SourcedValue(cof, uncertainty=spread, reason="" if spread else "nobody knows"),
        "cof_adhesion": SourcedValue(0.4 * cof, uncertainty=0.01),
        "cof_hysteresis": SourcedValue(0.5 * cof, assumed=True),
        "cof_viscous": SourcedValue(0.1 * cof),
        "normal_force": SourcedValue(500.0, "N"),
        "fluid_load": SourcedValue(fluid, "N", uncertainty=5.0),
        "fluid_load_sensor": SourcedValue(fluid / 10, "N"),
        "peak_fluid_pressure": SourcedValue(2e5, "Pa", uncertainty=1e4),
        "peak_fluid_pressure_sensor": SourcedValue(1e5, "Pa"),
        "contact_area": SourcedValue(2.5e-4, "m^2"),
        "minimum_film_thickness": SourcedValue(1e-5, "m"),
        "slip_probability": SourcedValue(
            slip, interval=(max(slip - 0.2, 0), min(slip + 0.2, 1)), uncertainty=0.1, note=note
        ),
    }


def result(name="worn <shoe>", *, data: Any = None, case=CASE, **changes) -> Any:
    """Return a run that nobody made."""
    numbers = scalars(**{k: changes.pop(k) for k in ("cof", "slip", "fluid", "spread", "note")
                         if k in changes})  # fmt: skip
    origin = Provenance(
        changes.pop("case_hash", f"{name:a<30}"),
        {"friction": "stribeck", "slip": "report_g6"},
        ("Somebody 2020 <b>",),
        ("Eq. 3: 2, not 3",),
        {"whole": 1.0},
        {"underfoot": "1", "numpy": "2"},
        "2026-01-01",
    )
    made = Result(
        name, numbers, {"regime": "mixed"}, sole(side=4e-3, sensors=2) if data is None else data,
        Status.CONVERGED, (Remark("stribeck", "speed 4"),), (Remark("interface", "a = 1 (b)"),),
        origin, case.to_toml(),
    )  # fmt: skip
    return dataclasses.replace(made, **changes)


def outcome(cof=0.1, slip=0.6, fluid=100.0, note="", spread: float | None = 0.02, **changes):
    """Return what a question keeps of a run."""
    numbers = scalars(cof, slip, fluid, note, spread)
    made = CaseOutcome("Case", "hash", numbers, {}, Status.CONVERGED, "", (), (), 1.0)
    return dataclasses.replace(made, **changes)


FAILED = outcome(status=Status.NOT_CONVERGED)


def change(name, cof=0.2, slip=0.3, *, failure="", **more):
    """Return what a change of a case does."""
    given = {} if failure else outcome(cof, slip).scalars
    return ChangeEffect(Change(name, f"do {name}", "shoe", {}), given, failure, **more)


def assessment(*effects, missing: float | None = 0.1, present=None):
    """Return a risk by two models with the effects of changes."""
    present = outcome() if present is None else present
    models = (
        ModelRisk("a", "b", "As a.", 0.6, None, None, None),
        ModelRisk("c", "d", "Every c slips.", 0.5, 0.4, 0.6, 0.31),
    )
    limit = summary.friction_limit(scalars())
    return RiskAssessment("Case", present, models, limit, 0.05, missing, effects)


def sensitivity(nominal=None):
    """Return the effects of three inputs, one of which failed at an end."""
    inputs = (
        InputEffect("shoe.material.shore_a", "r", 50.0, 70.0, "1", outcome(0.06), outcome(0.14)),
        InputEffect("motion.speed", "r", 0.1, 0.5, "m/s", outcome(0.1), outcome(0.11)),
        InputEffect("floor.roughness.rq", "r", 1e-6, 4e-6, "m", FAILED, outcome(0.1)),
    )
    return Sensitivity(outcome() if nominal is None else nominal, inputs)


def wear(cofs=(0.1, 0.11, 0.12), crossing=Crossing.WITHIN, *, mode="plane", variants=(), **more):
    """Return a series of wear whose limit is crossed in the middle."""
    points = tuple(
        WearPoint(
            WearMeasures(k * 1e-3, (3 - k) * 1e-3, 3e-3, k * 1e-4, 0, 0, k * 1e-9),
            outcome(cof, fluid=30.0 + 30.0 * k) if cof else FAILED,
            variants,
        )
        for k, cof in enumerate(cofs)
    )
    at = {"removed_depth": 1e-3, "tread_left": 2e-3, "mean_tread_left": 2e-3,
          "worn_patch_area": 1e-4}  # fmt: skip
    low, high = dict(at, tread_left=1e-3), dict(at, tread_left=-math.inf)
    one = LimitCrossing(crossing, 0.5, at, low, high)
    crossings = {"fluid_load": one, "fluid_load_sensor": one}
    return WearSeries("Case", mode, 75.0, points, crossings, ("a",), **more)


def draws(values):
    """Return draws of COF as a result holds them."""
    return {"cof_draws": ("draw", np.asarray(values))}


def placeless(value: Any, *folders: Any) -> Any:
    """Return plain data without the folders of a test."""
    if isinstance(value, str):
        for folder in folders:
            value = value.replace(str(folder), "HERE")
        return value
    if isinstance(value, dict):
        return {key: placeless(one, *folders) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [placeless(one, *folders) for one in value]
    return value
