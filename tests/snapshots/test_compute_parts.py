"""Parts of a run on small numbers: places, draws over them, errors, stated spreads, sentences."""

import math
from collections.abc import Iterable
from dataclasses import fields, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from outsole_bodies import grooved, heel_body, triangles, write_stl
from small_pads import BARS, STEP, TWO_GRIDS, pad
from snapshot import held, refusal
from underfoot.case import Case
from underfoot.compute import sole as soles
from underfoot.compute.contact_friction import film_warmth, leak_name, place_of_tread, sole_errors
from underfoot.compute.micro_contact import MicroContact
from underfoot.compute.numbers import (
    FILM_ERROR,
    INPUTS,
    SUCTION_SPREAD,
    ZERO,
    readings,
    regime,
    required_friction,
    slip_probability,
    slope_words,
    undetermined_numbers,
    with_film_spread,
    with_stated,
)
from underfoot.compute.numerical_error import (
    NumericalErrors,
    errors_by_steps,
    with_numerical_error,
)
from underfoot.compute.position_draws import (
    COF_PARTS,
    LOADS,
    ShoeAngles,
    TreadPlace,
    TreadPositions,
    UncertainBevel,
    log_film_odds,
)
from underfoot.compute.positions import (
    _reduce_periods,
    case_places,
    first_share,
    further_angles,
    has_lugs,
    places,
    position_count,
    remembers,
    shoe_angles,
    tread_positions,
)
from underfoot.compute.resolve import resolve_context, turn_context, youngs_modulus
from underfoot.compute.slips import slip_population, slip_sensors
from underfoot.compute.solve import (
    effect_places,
    pool_depth,
    solver_settings,
    start_film,
)
from underfoot.compute.stated_spreads import (
    StatedEffect,
    StatedEffects,
    friction_draws,
    log_moves,
    odds_changes,
    solved_effects,
    stated_paths,
    stated_spreads,
)
from underfoot.compute.summary import (
    beyond_tests,
    cautions,
    friction_limit,
    headline,
    in_words,
    notes,
    ranked_assumptions,
    steadiness,
    table,
    verdict,
    verdict_sentence,
)
from underfoot.core import SourcedValue, Status
from underfoot.core.remark import Message, Remark
from underfoot.friction import FrictionCoefficients
from underfoot.friction.sampled_cof import LawDraws, SampledCof

BEVEL = {
    "shoe.heel.profile": {"model": "facet", "angle": {"value": "5 deg", "assumed": True},
                          "length": "10 mm"}
}  # fmt: skip
LUGS = pad(BARS, {"numerics.tread_positions": 4})
CASES: dict[str, Case] = {
    "flat": pad(TWO_GRIDS, BEVEL),
    "bars": LUGS,
    "blocks": pad(BARS, {"shoe.tread.pattern": "grid", "shoe.tread.angle": "20 deg",
                         "numerics.tread_positions": 5}),
    "ends": LUGS.replace({"motion.duration": "60 ms"}),
    "history": pad(STEP, TWO_GRIDS),
    "one": pad(),
}  # fmt: skip


def test_places_of_a_run(file_regression):
    said: dict[str, Any] = {}
    for name, case in CASES.items():
        said[name] = {
            "lugs": has_lugs(case), "remembers": remembers(case),
            "further": rows(further_angles(case)), "bevel": UncertainBevel.of(case),
            "counts": [position_count(case, quick=way) for way in (True, False)],
            "first": [first_share(case, quick=way) for way in (True, False)],
            "effects": rows(effect_places(case)),
            "solver": [solver_settings(case, finer=n)
                       for n in ((1, 2) if name == "ends" else (1,))],
            "pool": (pool_depth(case), start_film(case, steady=True),
                     start_film(case, steady=False)),
        }  # fmt: skip
        if has_lugs(case):
            said[name]["places"] = [rows(case_places(case, quick=way)) for way in (True, False)]
            said[name]["tread"] = soles.landing_front(case), soles.tread_on_sole(case)[:2]
    periods = np.array([[0.008, 0.0], [0.001, 0.006]])
    said["lattices"] = [rows(places(periods, n)) for n in (1, 2, 5, 12)]
    said["begins"] = rows(places(periods[:1], 3, np.array([0.4])))
    said["angles"] = rows(shoe_angles())
    bevel = UncertainBevel.of(CASES["flat"])
    assert bevel is not None
    said["turns"] = bevel.turns(7), bevel.message
    stated = CASES["flat"].replace(
        "shoe.heel.profile.angle", {"value": "5 deg", "uncertainty": "0.5 deg"}
    )
    said["stated"] = UncertainBevel.of(stated)
    held(file_regression, said)
    # a period that points back is the same pattern as one that points ahead
    for ways in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        turned = np.array([[0.01, 0.0], [0.0, 0.02]]) * np.array(ways)[:, None]
        np.testing.assert_allclose(_reduce_periods(turned), [[0.01, 0.0], [0.0, 0.02]])


def rows(these: Iterable[TreadPlace]) -> list[str]:
    """Return places a line each."""
    return [f"{one.shift} {one.turn} {one.yaw} {one.finer}" for one in these]


def numbers_of(place: TreadPlace, spacing: float) -> dict[str, float]:
    """Return made-up numbers of a place that depend on where, how turned and how fine it is."""
    film = 12 + 4 * math.sin(700 * place.shift[0]) + 60 * place.turn
    film += 900 * (spacing - 1e-3) * (1 + 80 * place.shift[0] + 30 * place.turn)
    film += 0.3 * (place.finer - 1)
    parts = {"cof_adhesion": 0.1 - 0.003 * film, "cof_hysteresis": 0.02 - 0.0003 * film,
             "cof_viscous": 0.004 * film}  # fmt: skip
    return {"fluid_load": film, "contact_load": 50 - film, **parts, "cof": sum(parts.values()),
            "peak_fluid_pressure": 1e4 * film, "fluid_load_sensor": 0.8 * film,
            "peak_fluid_pressure_sensor": 9e3 * film}  # fmt: skip


def run_places(case: Case, *, quick: bool = False, lost: int = -1) -> TreadPositions:
    """Return the positions of a case by the made-up numbers; one place may be lost."""
    spacing = case.numerics.quick_grid_spacing if quick else case.numerics.grid_spacing

    def at_places(asked):
        for k, (place, h) in enumerate(asked):
            yield k, None if k == lost else numbers_of(place, h)

    own = {TreadPlace(): numbers_of(TreadPlace(), spacing)}
    return tread_positions(case, own, at_places, spacing=spacing, quick=quick)


def friction_of() -> tuple[FrictionCoefficients, SampledCof]:
    rng = np.random.default_rng(3)
    draws = {name: 1 + 0.1 * rng.normal(size=60) for name in ("adhesion", "hysteresis", "viscous")}
    law = LawDraws(**draws, odds=0.3 * rng.normal(size=60))
    drawn = law.at(0.7, adhesion=0.07, hysteresis=0.02, viscous=0.03)
    sampled = SampledCof(**drawn, share={"a": 0.7, "b": 0.3}, left_out=(), confidence=0.95, seed=0,
                         law=law)  # fmt: skip
    whole, rest = SourcedValue(0.12, uncertainty=0.01), SourcedValue(0.04, uncertainty=0.01)
    return FrictionCoefficients(whole, rest, rest, SourcedValue(0.04, reason="none"), 6.0, 50.0,
                                15.0), sampled  # fmt: skip


MADE: dict[str, tuple[str, dict[str, Any]]] = {
    "flat": ("flat", {}), "bars": ("bars", {}),
    "bars quick": ("bars", {"quick": True}), "lost": ("bars", {"lost": 2}),
    "turned lost": ("bars", {"lost": 1}), "ends": ("ends", {}),
    "flat lost": ("flat", {"lost": 3}),
}  # fmt: skip


@pytest.mark.parametrize("name", MADE)
def test_numbers_over_places(file_regression, name):
    which, more = MADE[name]
    made = run_places(CASES[which], **more)
    friction, sampled = friction_of()
    scalars = {
        "cof": friction.cof, "normal_force": SourcedValue(50.0, "N"),
        **{key: SourcedValue(value, "N", reason="x")
           for key, value in numbers_of(TreadPlace(), 1e-3).items() if key not in COF_PARTS},
    }  # fmt: skip
    over, drawn = made.friction(friction, sampled)
    values = made.average_numbers(scalars)
    stated = {"p": {"odds": np.linspace(-0.1, 0.1, 60), "whole": np.full(60, 0.02),
                    "peak_fluid_pressure": np.linspace(0, 0.1, 60),
                    "fluid_load": np.full(60, 0.01)}}  # fmt: skip
    spread = with_film_spread(values, np.linspace(-1, 1, 60), made.draw_scalar, stated)
    said = {
        "it": {one.name: getattr(made, one.name) for one in fields(made)
               if one.name not in ("places", "at_own_place")},
        "places": rows(made.places), "answers": {key: made.answer(key) for key in made.values},
        "drawn": {
            key: made.draw_scalar(key, 30) for key in ("fluid_load", "cof", "fluid_load_sensor")
        },
        "over": over, "draws": drawn, "plain": made.friction(friction, None)[0].cof,
        "averaged": values, "labels": made.labels(), "assumes": made.assumptions(),
        "fields": made.fields(),
        "spread": {name: spread[name] for name in ("fluid_load", "peak_fluid_pressure")},
        "by steps": errors_by_steps(made, ("cof", "fluid_load", "peak_fluid_pressure"), 50.0),
    }  # fmt: skip
    held(file_regression, said, f"places {name}")
    assert isinstance(made, ShoeAngles) is (which == "flat")


def test_errors_and_spreads_of_numbers(file_regression):
    _, sampled = friction_of()
    values = {
        "cof": SourcedValue(0.12, uncertainty=0.01, interval=(0.1, 0.14)),
        "fluid_load": SourcedValue(20.0, "N", uncertainty=2.0, interval=(16.0, 25.0), note="of"),
        "fluid_load_sensor": SourcedValue(15.0, "N", reason="r"),
        "peak_fluid_pressure": SourcedValue(1e5, "Pa", uncertainty=1e4, interval=(8e4, 2e5)),
        "peak_fluid_pressure_sensor": SourcedValue(None, "Pa", reason="none"),
        "normal_force": SourcedValue(50.0, "N"), "contact_area": SourcedValue(1e-4, "m^2"),
        "minimum_film_thickness": SourcedValue(2e-6, "m", note="thin"),
    }  # fmt: skip
    grid = {"cof": 0.01, "fluid_load": 3.0, "fluid_load_sensor": 1.0,
            "peak_fluid_pressure": 2e4, "peak_fluid_pressure_sensor": 1e3}  # fmt: skip
    errors = NumericalErrors(grid, {"cof": 0.005, "fluid_load": 1.0}, Message("why"))
    only = NumericalErrors({"cof": 0.01}, {}, Message("why"))
    odds = np.linspace(-1.5, 1.5, 101)
    stated = {"a": {"contact_area": 0.1 * odds, "odds": 0.2 * odds, "normal": odds},
              "b": {"minimum_film_thickness": 0 * odds, "whole": 0.05 * odds}}  # fmt: skip
    film = with_film_spread(values, odds, None, stated)
    said = {
        "added": errors.widen_numbers(values), "sentence": errors.sentence(values),
        "only": only.sentence(values), "deviations": [errors.deviation(n) for n in grid],
        "drawn": [with_numerical_error(sampled, e, cof=0.12, sole="a").cof
                  for e in (0.0, 0.01, 0.1)],
        "shares": with_numerical_error(sampled, 0.01, cof=0.12, sole="a").share,
        "contact": with_numerical_error(sampled, 0.1, cof=0.12, sole="b").contact,
        "film": film, "no film": with_film_spread({**values, "fluid_load": SourcedValue(
            0.0, "N")}, odds)["fluid_load"],
        "most": with_film_spread(values, 5 + odds)["fluid_load"],
        "stated": with_stated(values, stated),
        "odds": [float(log_film_odds(*one)) for one in ((1.0, 3.0), (0.0, 1.0), (1.0, 0.0))],
        "constants": (FILM_ERROR, SUCTION_SPREAD, ZERO, INPUTS),
    }  # fmt: skip
    held(file_regression, said)


def test_stated_spreads_of_cases(file_regression):
    with_spreads = pad(
        {
            "contaminant.viscosity": {"value": "30 cP", "uncertainty": "12 cP"},
            "shoe.material.shore_a": {"value": 65, "uncertainty": 3},
            "motion.speed": {"value": "0.3 m/s", "uncertainty": "0.03 m/s"},
            "shoe.sole.outsole_thickness": {"value": "10 mm", "uncertainty": "1 mm"},
            "risk.rcof_mean": {"value": 0.2, "uncertainty": 0.02},
        }
    )
    spreads = stated_spreads(with_spreads)

    def stepped(case: Case) -> dict[str, float] | None:
        if case.shoe.sole.outsole_thickness != with_spreads.shoe.sole.outsole_thickness:
            return None
        speed, shore = case.motion.speed, case.shoe.material.shore_a or 0.0
        film = 40 * speed + 100 * (case.contaminant.viscosity if case.contaminant else 0.0)
        return {"fluid_load": film, "contact_load": 50 - film, "cof": 0.1, "cof_adhesion": 0.05,
                "cof_hysteresis": 0.001 * shore, "cof_viscous": 0.1 * speed}  # fmt: skip

    def marched(cases):
        return [numbers_of(TreadPlace((c.shoe.sole.outsole_thickness - 0.01, 0.0)), 1e-3)
                for c in cases]  # fmt: skip

    effects = solved_effects(with_spreads, stepped, marched)
    failed = solved_effects(with_spreads, stepped, lambda cases: [None] * len(cases))
    thick = numbers_of(TreadPlace((1e-3, 0.0)), 1e-3)
    lower = [numbers_of(TreadPlace(), 1e-3), None, thick]
    half = solved_effects(with_spreads, stepped, lambda cases: lower[: len(cases)])
    ordered = [replace(one, moves=dict(sorted(one.moves.items()))) for one in effects.effects]
    sample = {path: np.linspace(-2, 2, 9) for path in ("x",)}["x"]
    drawn = effects.draws(lambda name: sample)
    before, after = numbers_of(TreadPlace(), 1e-3), numbers_of(TreadPlace((1e-3, 0.0)), 1e-3)
    said = {
        "spreads": spreads, "paths": list(stated_paths(with_spreads)), "effects": ordered,
        "labels": (effects.labels(), failed.labels(), half.labels()),
        "left out": (failed.left_out, half.left_out),
        "draws": {path: dict(sorted(each.items())) for path, each in drawn.items()},
        "friction": friction_draws({p: e for p, e in drawn.items() if "cof_viscous" in e}),
        "exact": effects.exact(with_spreads).sourced_value("motion.speed"),
        "of": [one.path for one in effects.of(with_spreads.replace("motion.speed", 0.3)).effects],
        "moves": dict(sorted(log_moves(before, after).items())),
        "odds": odds_changes(-1.0, 2.0, sample), "none": StatedEffects().labels(),
        "idle": StatedEffects((StatedEffect("a", "b", 0.0, {"cof": (0.0, 1e-12)}),)).labels(),
        "contexts": (youngs_modulus(with_spreads), leak_name(resolve_context(with_spreads)),
                     turn_context(resolve_context(with_spreads), 0.1).motion.shoe_angle),
    }  # fmt: skip
    held(file_regression, said)
    assert set(LOADS) <= set(before)


def scalars(**changes: Any) -> dict[str, SourcedValue]:
    given = {
        "cof": SourcedValue(0.12, uncertainty=0.02, interval=(0.08, 0.17)),
        "cof_viscous": SourcedValue(0.02), "fluid_load": SourcedValue(200.0, "N"),
        "normal_force": SourcedValue(500.0, "N"),
        "minimum_film_thickness": SourcedValue(2e-6, "m"),
        "slip_probability": SourcedValue(0.3, interval=(0.1, 0.5)),
    }  # fmt: skip
    return given | changes


def test_what_is_said_of_numbers(file_regression):
    dry = SourcedValue(None, "m", reason="none")
    worlds = {
        "film": scalars(), "shear": scalars(cof_viscous=SourcedValue(0.11),
                                            fluid_load=SourcedValue(450.0, "N")),
        "boundary": scalars(fluid_load=SourcedValue(24.0, "N")),
        "boundary at 5 %": scalars(fluid_load=SourcedValue(25.0, "N")),
        "floats": scalars(fluid_load=SourcedValue(500.0, "N")),
        "dry": scalars(minimum_film_thickness=dry, fluid_load=SourcedValue(0.0, "N")),
        "slides": scalars(steady_slide=SourcedValue(0.51, "m")),
        "stops": scalars(steady_slide=SourcedValue(0.5, "m")),
        "later": scalars(later_cof=SourcedValue(0.1), later_time=SourcedValue(0.2, "s"),
                         later_fluid_load=SourcedValue(250.0, "N"),
                         cof_tread_position=SourcedValue(0.01)),
        "grips": scalars(slip_probability=SourcedValue(1e-5, interval=(0.0, 9.9e-4))),
        "overloaded": scalars(slip_probability=SourcedValue(1e-5, interval=(0.0, 9.9e-4))),
        "slips": scalars(slip_probability=SourcedValue(0.9, interval=(0.051, 1.0), note="far")),
        "doubtful": scalars(slip_probability=SourcedValue(0.9, interval=(0.05, 1.0))),
        "unknown": scalars(slip_probability=SourcedValue(None, reason="none")),
    }  # fmt: skip
    assumed = ("risk", "shoe.heel", "interface", "motion", "shoe.heel.profile", "interface")
    assumptions = [Remark.of(where, "a") for where in assumed]
    breaches = [Remark.of(name, "b") for name in ("pair", "report_g6", "mine", "pair")]
    said: dict[str, Any] = {}
    for name, world in worlds.items():
        labels = {"overload": Message("too much")} if name == "overloaded" else {}
        limit = friction_limit(world)
        said[name] = {
            "limit": (limit, limit.kind, str(limit), limit.sentence("mixed")),
            "verdict": (verdict(world, labels), verdict_sentence(world, labels)),
            "headline": headline(Status.CONVERGED, world, labels), "steady": steadiness(world),
            "table": table(world, {"regime": "mixed"})
            if name in ("film", "dry", "later", "slides", "slips", "unknown") else None,
            "cautions": cautions(Status.CONVERGED, world, breaches, assumptions, "report_g6",
                                 labels),
        }  # fmt: skip
    told = {"film_spread_basis": "x", "film_heel_basis": "x", "film_inlet": Message("square"),
            "positions_left_out": Message("lost"), "grid_error": Message("grid"),
            "slope": Message("down")}  # fmt: skip
    said["known"] = cautions(Status.CONVERGED, worlds["film"], [], assumptions, "", told)
    said["failed"] = [
        headline(Status.NOT_CONVERGED, worlds["film"], {"no_result": Message("afloat")}),
        headline(Status.NOT_CONVERGED, worlds["film"], {}),
        cautions(Status.NOT_CONVERGED, worlds["film"], breaches, assumptions),
    ]
    said["instant"] = headline(Status.CONVERGED, worlds["film"], {"instant": Message("at the end")})
    said["ranked"] = ranked_assumptions(assumptions)
    said["words"] = in_words(breaches), beyond_tests(["pair", "mine"]), notes(told)
    said["regimes"] = [regime(share) for share in (-0.1, 0.05, 0.1, 0.5, 0.9, 0.95, 1.2)]
    case = pad({"floor.slope": {"value": "4 deg", "uncertainty": "1 deg"},
                "risk.rcof_mean": {"value": 0.18, "uncertainty": 0.01}})  # fmt: skip
    said["people"] = required_friction(case), slope_words(case), required_friction(pad())
    said["level"] = slope_words(pad())
    said["risk"] = slip_probability(case, worlds["film"]["cof"])
    said["nothing"] = undetermined_numbers(case, Status.NOT_CONVERGED)
    contact: Any = SimpleNamespace(fluid_load=3.0, fluid_pressure=np.array([1.0, 5.0]))
    sensor: Any = SimpleNamespace(load=SourcedValue(3.0), peak_pressure=SourcedValue(4.0))
    said["readings"] = readings(contact, 0.2, sensor)
    population = slip_population(case)
    said["population"] = replace(population, histories=population.histories[:1])
    said["sensors"] = slip_sensors(case)
    said["people refused"] = [
        refusal(slip_population, case.replace(one))
        for one in ({"risk.rcof_mean": 1.01}, {"slip.landing_from": "30 mm"},
                    {"slip.weight_transfer_from": 0.9})
    ]  # fmt: skip
    held(file_regression, said)


class Flat:
    """A table of a rough contact that is the same everywhere."""

    description = "made"
    realizations = np.array([[4]])

    def real_contact_fraction(self, *at: Any) -> float:
        return 0.8

    def cof_hysteresis(self, *at: Any) -> float:
        return 0.05

    def mean_gap(self, *at: Any) -> float:
        return 2e-6

    def flow_factor(self, *at: Any, outside: str = "") -> float:
        return -1e-3


def test_rough_contacts_and_warm_films(file_regression):
    table: Any = Flat()
    micro = MicroContact(table, 2e5, 0.3, 0.2, 0.1, 0.5)
    case = pad({"contaminant.viscosity": "200 cP"})
    context = resolve_context(case)
    pressure = np.zeros((9, 7))
    pressure[2:6, 1:6] = 1e5
    contact: Any = SimpleNamespace(total_pressure=pressure, spacing=2e-3)
    warm = film_warmth(case, context, 0.3, contact, film_share=0.4, samples=50)
    oil = pad({"contaminant": "canola_oil"})
    sole = soles.sole_map(LUGS, 1e-3)
    said = {
        "micro": micro.scalars(), "warm": warm,
        "oil": film_warmth(oil, resolve_context(oil), 0.3, contact, film_share=1.0, samples=50),
        "cold": film_warmth(case, context, 0.0, contact, film_share=0.0, samples=50),
        "place": (place_of_tread(LUGS, sole), place_of_tread(
            LUGS.replace("shoe.wear.edge_radius", "1 mm"), sole)),
        "errors": sole_errors(LUGS, resolve_context(LUGS)),
        "bottom": soles.bottom_surface(LUGS).height, "rolls": soles.rolls(CASES["history"]),
        "moved": soles.sole_map(LUGS, 1e-3, shift=(1e-3, 5e-4), turn=0.02, yaw=0.1).clearance,
        "drawn": soles.drawn_map(CASES["flat"], 2e-3).clearance,
        "cells": [soles.cells_along(one, soles.sole_map(one, 2e-3)) for one in (
            CASES["flat"], LUGS, pad({"contaminant": "none", "friction": {
                "model": "constant", "cof": 0.5}}), pad({"numerics.cells_along": 4}))],
    }  # fmt: skip
    held(file_regression, said)


def test_soles_of_files(file_regression, tmp_path):
    path = tmp_path / "heel.stl"
    write_stl(path, triangles(heel_body(grooved(3e-3, 12e-3, 4e-3), step=1e-3)))
    case = Case.from_text(f"""
file_version = 2
floor = "vinyl_g4"
contaminant = "glycerol_90pct"
motion = "slip_tester_g4"
[shoe]
material.shore_a = 65
roughness = {{ra = "2 um", cutoff = "0.8 mm"}}
[shoe.outsole]
file = "{path}"
unit = "mm"
[shoe.sole]
outsole_thickness = "15 mm"
[numerics]
grid_spacing = "2 mm"
quick_grid_spacing = "2 mm"
""")
    sole = soles.file_sole_map(case, 2e-3)
    moved = soles.file_sole_map(case, 2e-3, shift=(2e-3, 1e-3), yaw=0.05, turn=0.01)
    worn = case.replace({"shoe.wear": {"mode": "plane", "depth": "1 mm", "angle": "2 deg"}})
    lines = soles.drawn_file(case, 2e-3)[1]
    said = {
        "sole": (sole.clearance, sole.land, sole.tread_depth, sole.x, sole.y),
        "moved": (moved.clearance, moved.land), "periods": soles.file_periods(case),
        "front": soles.landing_front(case), "lugs": has_lugs(case),
        "worn": soles.file_surface(worn).height, "lines": [one.shape for one in lines],
        "spring": soles.spring_contact(case, sole), "places": rows(case_places(case, quick=True)),
        "notes": [str(one).replace(str(tmp_path), "") for one in soles.outsole_notes(case)],
        "bottoms": refusal(soles.file_sole_map, case.replace("motion.normal_force", "9 kN"), 2e-3),
        "thin": refusal(soles.file_sole_map, case.replace("shoe.sole.outsole_thickness", "2 mm"),
                        2e-3).replace(str(tmp_path), ""),
        "no file": refusal(soles.file_outsole, pad()), "new": refusal(soles.new_sole, case),
    }  # fmt: skip
    held(file_regression, said)


OUTSOLE = """
name = "a"
[heel]
length = "40 mm"
width = "30 mm"
rear_radius = "0 mm"
profile = {model = "flat"}
[tread]
pattern = "bars"
depth = "3 mm"
lug_width = "6 mm"
channel_width = "4 mm"
"""


def test_outsoles_alone(file_regression, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(OUTSOLE, encoding="utf-8")
    one = soles.read_outsole(path)
    other = soles.read_outsole(path, {"tread.depth": "2 mm"})
    said: dict[str, Any] = {"read": one, "shape": one.shape().tread, "changed": other.tread.depth}
    for name, text in {
        "case": "[shoe]\nname = 'a'", "unit": OUTSOLE.replace('"3 mm"', '"3 s"'),
        "deep": OUTSOLE.replace('"3 mm"', '"30 mm"'), "no tread": "[heel]\nlength = '4 mm'",
        "key": OUTSOLE + "lugs = 3",
    }.items():  # fmt: skip
        path.write_text(text, encoding="utf-8")
        said[name] = refusal(soles.read_outsole, path).replace(str(tmp_path), "")
    held(file_regression, said)
