"""Small soles solved in contact and film, and the parts that solve them: values and refusals.

Of ``underfoot.sole_contact.film_balance``, ``underfoot.sole_contact.finite_element.compliance``,
``underfoot.sole_contact.finite_element.elasticity``,
``underfoot.sole_contact.finite_element.mesh``, ``underfoot.sole_contact.finite_element.plan``,
``underfoot.sole_contact.long_waves``, ``underfoot.sole_contact.lug_inlet``.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from small_pads import BARS, DRY, STEP, pad
from snapshot import held, refusal
from underfoot.compute.prepare import Prepared, prepare_case
from underfoot.compute.sole import trim_map
from underfoot.rough_contact import ExponentialLaw
from underfoot.shoe.row_division import row_cells
from underfoot.sole_contact._kernels.brick_elements import shape_functions
from underfoot.sole_contact._kernels.elastic import (
    Convolution,
    attenuation,
    balanced_weights,
    block_compression,
    bonded_layer_symbol,
    fast_length,
    free_sided_symbol,
    half_space_influence,
    influence_from_symbol,
    slit_openness,
    wavenumbers,
)
from underfoot.sole_contact._kernels.splines import Splines
from underfoot.sole_contact._solver_checks import check_demand, check_setup, check_times
from underfoot.sole_contact.compliance import (
    body_thickness,
    compliance_within,
    half_space_compliance,
    layered_compliance,
    lug_height,
    mean_lug_depth,
)
from underfoot.sole_contact.cost import Cost, megabytes, refuse_too_large, solution_cost
from underfoot.sole_contact.edge_peak import overloaded_share, peak_pressure
from underfoot.sole_contact.gmres import krylov_solution
from underfoot.sole_contact.lug_edges import EdgedLaw, gap_table, let_in, lug_edges, lug_friction
from underfoot.sole_contact.march import _calm_start
from underfoot.sole_contact.motion_history import MotionHistory, solve_history
from underfoot.sole_contact.newton import _cycling, _hopeless, _step_share, _stuck
from underfoot.sole_contact.preconditioner import pole_fit
from underfoot.sole_contact.problem import State
from underfoot.sole_contact.reading import (
    conductance_over_cube,
    floor_sensor_reading,
    lag_pressure,
    pocket_pressure,
    seen_share,
)
from underfoot.sole_contact.row_compliance import rectangle_deflection, row_compliance
from underfoot.sole_contact.sensor_array import SensorArray, array_reading
from underfoot.sole_contact.slits import loaded_slits, slit_words
from underfoot.sole_contact.sole_state import SolverSettings
from underfoot.sole_contact.solver import (
    SoleContact,
    longest_step,
    passing_time,
    solve_on,
    solve_sliding,
)
from underfoot.sole_contact.stepping import (
    SlidingSole,
    asperity_scale,
    rolled_clearance,
    rolled_sole,
)

EXACT = SolverSettings(tolerance=1e-6, end_time=0.05)
SIPES = {"shoe.tread": {"pattern": "bars", "depth": "3 mm", "lug_width": "8 mm",
                        "channel_width": "4 mm",
                        "sipes": {"width": "0.4 mm", "spacing": "4 mm", "depth": "2 mm"}}
}  # fmt: skip


@pytest.fixture(scope="module")
def flat() -> Prepared:
    return prepare_case(pad({"numerics.cells_along": 2, "contaminant.viscosity": "20 cP"}), 2e-3)


@pytest.fixture(scope="module")
def barred() -> Prepared:
    return prepare_case(pad(BARS, {"contaminant.viscosity": "20 cP"}), 1e-3)


def told(contact: SoleContact) -> dict[str, Any]:
    """Return a solved contact without what its solver keeps of it."""
    names = (
        "contact_pressure", "fluid_pressure", "film_thickness", "liquid_fraction", "wet",
        "cavitated", "approach", "normal_force", "speed", "shoe_angle", "time", "status", "remedy",
        "fluid_load", "contact_load", "areas", "cells",
    )  # fmt: skip
    return {
        **{name: getattr(contact, name) for name in names},
        "history": {
            name: getattr(contact.history, name)
            for name in ("time", "load", "fluid_load", "approach", "speed", "shoe_angle")
        },
        "steps": (contact.counts.time_steps, contact.counts.rejected, contact.counts.cells),
        "later": contact.later and (contact.later.fluid_load, contact.later.time),
    }


SOLVED: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    "ends": ("flat", {}, {}),
    "steady": ("flat", {"end_time": None}, {}),
    "back": ("flat", {"end_time": None}, {"speed": -0.2}),
    "squeeze": ("flat", {"pool_depth": 1e-4, "start_film": 8e-5}, {"speed": 0.0}),
    "vapour": ("flat", {"cavity_pressure": -3e4, "rise_time": 0.02}, {}),
    "dry": ("flat", {}, {"viscosity": None}),
    "shallow": ("barred", {"pool_depth": 2e-4, "end_time": None}, {}),
    "lugs": ("barred", {}, {}),
    "gives up": ("flat", {"most_newton": 2, "most_time_steps": 3}, {}),
}


COSTS = {
    "ends": (71, 312), "steady": (89, 412), "back": (109, 447), "squeeze": (102, 350),
    "vapour": (73, 323), "dry": (55, 282), "shallow": (75, 278), "lugs": (66, 250),
}  # fmt: skip
"""Newton steps and products of each: a worse step or preconditioner finds the same by more."""


@pytest.mark.parametrize("name", SOLVED)
def test_contacts(file_regression, request, name):
    which, settings, change = SOLVED[name]
    parts = request.getfixturevalue(which)
    given: dict[str, Any] = {"viscosity": 0.02, "speed": 0.3, "normal_force": 50.0} | change
    seen: list[float] = []
    stages: list[Any] = []
    edged = parts.local_law if isinstance(parts.local_law, EdgedLaw) else None
    try:
        made = solve_sliding(
            parts.sole, parts.compliance, parts.asperities,
            settings=replace(EXACT, **settings), watch=lambda state: seen.append(state.time),
            progress=lambda stage, share, _=None: stages.append((stage, round(share, 6))),
            inlet=edged and edged.inlet(50.0, 0.3), **given,
        )  # fmt: skip
    except Exception as error:  # a march that gives up says why
        held(file_regression, f"{type(error).__name__}: {error}", f"contact_{name}")
        return
    stages = list(dict.fromkeys(stages))
    held(file_regression, {**told(made), "seen": seen, "stages": stages}, f"contact_{name}")
    newton, krylov = COSTS[name]
    assert made.counts.newton == pytest.approx(newton, rel=0.06)
    assert made.counts.krylov == pytest.approx(krylov, rel=0.08)


def test_histories_and_contacts_that_go_on(file_regression, flat, barred):
    on = flat.sole, flat.compliance, flat.asperities
    history = MotionHistory([0.0, 0.02, 0.05], [20.0, 60.0, 40.0], [0.1, 0.3, -0.1],
                            [0.09, 0.05, 0.03])  # fmt: skip
    moved = solve_history(
        *on, history, viscosity=0.02, settings=replace(EXACT, tolerance=1e-6), map_angle=0.06
    )
    begun = solve_sliding(*on, viscosity=0.02, speed=0.3, normal_force=50.0,
                          settings=replace(EXACT, end_time=None))  # fmt: skip
    later = solve_on(begun, *on, viscosity=0.03, speed=0.25, normal_force=60.0, turn=0.01,
                     duration=0.05, steps=2, settings=EXACT)  # fmt: skip
    said: dict[str, Any] = {
        "history": told(moved),
        "on": [told(one) for one in later],
        "passing": [passing_time(one.sole, v) for one in (flat, barred) for v in (0.3, -0.1, 0.0)],
        "longest": [longest_step(*one) for one in ((0.1, 1e-4), (0.1, 5e-3), (0.1, 1.0))],
    }
    sole = SlidingSole(*on, viscosity=0.02, settings=EXACT)
    said["angle"] = refusal(
        sole.advance, 0.01, normal_force=10.0, speed=0.1, shoe_angle=math.radians(50)
    )
    for force in (0.0, 5.0):
        state = sole.advance(2e-3, normal_force=force, speed=0.1)
        said[f"under {force}"] = state.time, state.approach, state.fluid_load, state.contact_load
    said["way"] = sole.sliding_time(0.5)
    said["grid"] = refusal(solve_on, begun, barred.sole, barred.compliance, barred.asperities,
                           viscosity=0.02, speed=0.3, normal_force=50.0, duration=0.1)  # fmt: skip
    held(file_regression, said)
    # a foot in the air before it lands
    waits = MotionHistory([0.0, 0.01, 0.03], [0.0, 0.0, 50.0], [0.1, 0.3, 0.2], [0.05, 0.05, 0.05])
    landed = solve_history(*on, waits, viscosity=None, map_angle=0.05)
    assert landed.contact_load == pytest.approx(50.0, rel=1e-3)


def test_compliances(file_regression, flat, barred):
    rng = np.random.default_rng(3)
    said: dict[str, Any] = {}
    sipes = prepare_case(pad(SIPES, {"numerics.grid_spacing": "1 mm",
                                     "numerics.quick_grid_spacing": "1 mm"}), 1e-3)  # fmt: skip
    waves = np.array([0.0, 50.0, 500.0, 5000.0])
    elastic: dict[str, Any] = {"modulus": 4e6, "poisson_ratio": 0.49, "thickness": 8e-3}
    for name, parts in (("flat", flat), ("bars", barred), ("sipes", sipes)):
        sole = parts.sole
        pressure = 1e5 * rng.random(sole.land.shape) * sole.land
        box = np.s_[2:7, 1:6]
        for kind, more in (
            ("plain", {"free_edges": False}),
            ("free", {}),
            ("midsole", {"midsole_modulus": 1e6, "midsole_thickness": 0.01, "shoe_angle": 0.05}),
        ):
            made = layered_compliance(sole, **elastic, **more)
            said[f"{name} {kind}"] = (
                made.apply(pressure), made.self_compliance, made.symbol(waves), made.short_waves,
                made.within(box).apply(pressure[box]),
                pole_fit(made, 0.05, sole.spacing),
            )  # fmt: skip
        rows = row_compliance(parts.compliance, sole.cells or row_cells(sole), sole.land)
        load = 1e5 * rng.random(rows.self_compliance.size)
        some = np.arange(3, 40)
        said[f"{name} rows"] = (
            rows.apply(load), rows.self_compliance, rows.symbol(waves),
            rows.within(some).apply(load[some]), rows.within(some).self_compliance,
        )  # fmt: skip
        said[f"{name} body"] = (
            body_thickness(sole, 9e-3, 0.05), mean_lug_depth(sole), lug_height(sole),
        )  # fmt: skip
        if sole.slits is not None:
            wide = loaded_slits(sole, modulus=4e6, poisson_ratio=0.49, pressure=1e5)
            said[f"{name} pressed"] = wide.slits, wide.cut
            said[f"{name} words"] = [slit_words(wide.slits, giving=way) for way in (True, False)]
            shut = loaded_slits(sole, modulus=4e5, poisson_ratio=0.49, pressure=9e5)
            said[f"{name} shut"] = shut.slits, slit_words(shut.slits, giving=True)
    half = half_space_compliance((6, 5), 1e-3, modulus=4e6, poisson_ratio=0.3)
    said["half-space"] = half.apply(1e5 * rng.random((6, 5))), half.symbol(waves)
    boxed = compliance_within(half, np.s_[1:4, 2:5])
    said["boxed"] = boxed.apply(np.full((3, 3), 1e5)), boxed.self_compliance
    said["rectangle"] = rectangle_deflection(
        np.array([0.0, 1e-3, 3e-3]), np.array([0.0, 5e-4, 0.0]), np.full(3, 5e-4), 5e-4, 4e6
    )
    said["refused"] = [
        refusal(layered_compliance, flat.sole, **(elastic | change))
        for change in ({"thickness": 0.0}, {"modulus": math.nan}, {"poisson_ratio": 0.51},
                       {"poisson_ratio": -0.01}, {"midsole_modulus": 1e6},
                       {"midsole_thickness": 1e-3},
                       {"midsole_modulus": 1e6, "midsole_thickness": 0.0},
                       {"midsole_modulus": -1.0, "midsole_thickness": 1e-3})
    ]  # fmt: skip
    held(file_regression, said)


def test_long_waves_of_a_heel(file_regression):
    """A heel that is large enough that its body is meshed."""
    case = pad({"shoe.heel.length": "48 mm", "shoe.heel.width": "40 mm",
                "shoe.heel.profile": {"model": "facet", "angle": "8 deg", "length": "20 mm"},
                "numerics.cells_along": 1, "motion.normal_force": "200 N"})  # fmt: skip
    parts = prepare_case(case, 4e-3)
    body = parts.compliance.body
    assert body is not None
    splines = body.splines
    other = prepare_case(case, 2e-3)
    on = body.on(other.sole)
    pressure = 1e5 * np.random.default_rng(1).random(other.sole.land.shape) * other.sole.land
    soft = layered_compliance(
        parts.sole, modulus=4e6, poisson_ratio=0.5, thickness=8e-3, midsole_modulus=1e6,
        midsole_thickness=0.01, shoe_angle=0.05,
    )  # fmt: skip
    known = layered_compliance(
        other.sole, modulus=4e6, poisson_ratio=0.5, thickness=8e-3, shoe_angle=0.05, known=body
    )
    places = np.linspace(-0.01, 0.06, 5)
    said = {
        "splines": (splines, splines.count, splines.end, splines.size),
        "body": (body.chosen, body.by_bricks, body.matrix, body.spacing),
        "on": (on.apply(pressure), on.self_compliance(pressure.shape),
               on.within(pressure.shape, np.s_[2:9, 3:12]).apply(pressure[2:9, 3:12])),
        "applied": other.compliance.apply(pressure),
        "midsole": soft.apply(1e5 * parts.sole.land), "known": known.apply(pressure),
        "waves": splines.at(places, places).toarray(),
    }  # fmt: skip
    held(file_regression, said)


def test_kernels_of_elasticity(file_regression):
    waves = np.array([0.0, 1e-2, 50.0, 500.0, 5000.0, 1e6])
    mask = np.zeros((7, 6), bool)
    mask[1:6, 1:5] = True
    heights = np.full((7, 6), 4e-3)
    said = {
        "layer": [bonded_layer_symbol(waves, 4e6, nu, 8e-3) for nu in (0.0, 0.3, 0.5)],
        "free": free_sided_symbol(waves, 4e6, 0.49, 2e-9),
        "block": [block_compression(mask, 1e-3, heights, 4e6, nu) for nu in (0.3, 0.5)],
        "edges": block_compression(mask, 1e-3, heights, 4e6, 0.49, (0.3, 0.7)),
        "slit": slit_openness(np.array([0.0, 0.3, 0.9, 1.0, 2.0])),
        "reaches": attenuation(waves, 3e-3),
        "waves": wavenumbers(8, 1e-3),
        "influence": influence_from_symbol(
            free_sided_symbol(wavenumbers(16, 1e-3), 4e6, 0.49, 2e-9), (4, 3)),
        "half-space": half_space_influence((4, 3), 1e-3, 5e6),
        "lengths": [fast_length(n) for n in (1, 7, 13, 31)],
        "shapes": shape_functions(np.array([[0.1, -0.3, 0.7], [-1.0, 1.0, 0.0]])),
        "splines": Splines((0.0, 1e-3), (2e-3, 3e-3), (3, 2)).at(
            np.array([-1e-3, 0.0, 3e-3, 9e-3]), np.array([0.0, 1e-3, 5e-3, 9e-3])).toarray(),
    }  # fmt: skip
    influence = half_space_influence((7, 6), 1e-3, 5e6)
    said["weights"] = balanced_weights(influence, mask, np.full((7, 6), 3e-9))
    said["cut"] = balanced_weights(influence, mask, np.full((7, 6), 3e-9), 0.5 + 0.5 * mask)
    field = np.random.default_rng(2).random((7, 6))
    convolution = Convolution(influence, (7, 6))
    said["convolved"] = convolution(field), convolution.within((3, 4))(field[:3, :4])
    held(file_regression, said)
    direct = sum(
        field[i, j] * influence[6 - i : 13 - i, 5 - j : 11 - j] for i in range(7) for j in range(6)
    )
    np.testing.assert_allclose(convolution(field), direct, rtol=1e-10)


def test_lugs_with_edges(file_regression, barred):
    sole = barred.sole
    said: dict[str, Any] = {}
    rng = np.random.default_rng(4)
    pressure = 3e5 * rng.random(sole.land.shape) * sole.land
    film = np.full(sole.land.shape, 1e-5)
    for forward in (True, False):
        edges = lug_edges(sole, 0.2e-3, worn_edge_radius=0.0, forward=forward)
        assert edges is not None
        said[f"edges {forward}"] = edges, edges.reach, edges.map(np.arange(edges.length.size), -1.0)
    worn = lug_edges(sole, 0.2e-3, worn_edge_radius=1e-3, forward=True)
    said["worn"] = worn and worn.edge
    law = EdgedLaw(barred.law, edges, barred.asperities, 4e6, 0.02, 5e4, 2.0)
    lugs = law.lugs(pressure, 0.3, film)
    parts = law(pressure, 0.3, film)
    said["law"] = (lugs, parts, lugs.factor_map(), lugs.suction_share(parts))
    said["mean"] = [law.mean_factor(2e5, v) for v in (0.05, 0.5)]
    said["inlet"] = law.inlet(50.0, 0.3).cof, law.inlet(50.0, 0.3).modulus
    said["state"] = getattr(law.with_mean_state(pressure, 0.3, film), "share", None)
    dull = replace(law, dewetting=0.0)
    said["dull"] = dull.lugs(pressure, 0.3, film), type(dull.with_mean_state(pressure, 0.3, film))
    count = edges.length.size
    given: dict[str, Any] = {"modulus": 4e6, "viscosity": 0.02, "suction": 5e4}
    for name, cof, more in (
        ("slow", 0.3, {"speed": 0.01}),
        ("fast", 0.3, {"speed": 3.0}),
        ("back", 1.2, {"speed": -0.3}),
        ("wiped", 0.3, {"speed": 0.05, "cof_wiped": np.full(count, 0.8), "full_contact": 2e6,
                        "dewetting": 5.0}),
        ("film", 0.3, {"speed": 0.3, "film_load": np.full(count, 2e5)}),
        ("none", 0.3, {"speed": 0.3, "suction": 0.0}),
    ):  # fmt: skip
        said[name] = lug_friction(
            edges, pressure, np.full(count, cof), barred.asperities, **(given | more)
        )
    said["idle"] = lug_friction(edges, 1e-3 * pressure, np.full(count, 0.3), barred.asperities,
                                speed=0.3, **given)  # fmt: skip
    said["let in"] = let_in(0.006, np.array([1e4, 3e5]), np.array([2e-4, 1e-3]), 4e6,
                            np.array([0.5, 9.0]))  # fmt: skip
    said["gaps"] = gap_table(barred.asperities)
    held(file_regression, said)


def test_sensors_in_the_floor(file_regression):
    x, y = 1e-3 * np.arange(20), 1e-3 * (np.arange(16) - 7.5)
    rng = np.random.default_rng(6)
    pressure = np.where(rng.random((20, 16)) < 0.7, 1e5 * rng.random((20, 16)), 0.0)
    gap = 1e-5 * np.exp(2 * rng.normal(size=(20, 16)))
    maps = x, y, pressure, gap
    small: dict[str, Any] = {"inlet_diameter": 3e-3, "scan_spacing": 3e-3, "scans": 3,
                             "offsets": 3}  # fmt: skip
    said: dict[str, Any] = {}
    for name, more in (
        ("usual", {}),
        ("small", small),
        ("point", small | {"inlet_diameter": 0.0, "sampling_step": 1e-3, "gap_cap": 1e-3}),
        ("one", small | {"scans": 1, "offsets": 1}),
        ("gives", small | {"compliance": 1e-16, "viscosity": 0.1, "speed": 0.3}),
    ):
        made = floor_sensor_reading(*maps, **more)
        said[name] = (
            made.load, made.peak_pressure, made.peak_position, made.outermost_share, made.loads,
            made.peaks, made.pressure, made.x, made.scan_y, made.seen,
        )  # fmt: skip
    nothing = floor_sensor_reading(x, y, 0 * pressure, gap, **small)
    said["nothing"] = nothing.load, nothing.outermost_share, nothing.seen
    said["lag"] = lag_pressure(pressure[:5, :2], np.full((5, 2), 30.0), 0.02)
    said["conductance"] = [conductance_over_cube(d, 0.1) for d in (1e-3, 1e-2, 0.1)]
    said["seen"] = seen_share(np.array([1.0, 2, -1, 4]), np.array([0.5, 0.99, 0, 5]))
    said["pocket"] = pocket_pressure(
        *maps, np.array([-5e-3, 3.3e-3, 25e-3]), np.array([0.0, 7.6e-3]),
        inlet_diameter=2e-3, gap_cap=3e-4, spacing=1e-3,
    )  # fmt: skip
    array = SensorArray(2, 3, 4e-3, 2e-3, 15e-3)
    time, place = np.array([0.0, 2e-3, 6e-3]), np.array([0.0, 2e-3, 9e-3])
    many = [pressure, 0.5 * pressure, pressure[::-1]], [gap, gap, 2 * gap]
    said["array"] = (
        array.x, array.y, array_reading(x, y, time, place, *many, array),
        array_reading(x, y, time, place, *many, array, threshold=3e4, sampling_interval=5e-4,
                      offsets=3, compliance=1e-16, viscosity=0.1),
    )  # fmt: skip
    said["refused"] = [
        refusal(floor_sensor_reading, *maps, **change)
        for change in ({"inlet_diameter": -1.0}, {"scan_spacing": 0.0}, {"sampling_step": 0.0},
                       {"gap_cap": 0.0}, {"compliance": -1.0}, {"scans": 0}, {"scans": 1.5},
                       {"offsets": 2}, {"offsets": 0}, {"compliance": 1e-16, "viscosity": 0.0},
                       {"compliance": 1e-16, "viscosity": 0.1},
                       {"compliance": 1e-16, "viscosity": 0.1, "speed": 1, "inlet_diameter": 0.0})
    ]  # fmt: skip
    said["maps"] = [
        refusal(floor_sensor_reading, *one)
        for one in ((x[:1], y, pressure[:1], gap[:1]), (x, 2 * y, pressure, gap),
                    (x, y, pressure[:5], gap), (x, y, np.nan * pressure, gap),
                    (x, y, pressure, np.nan * gap), (-x, y, pressure, gap))
    ]  # fmt: skip
    said["arrays"] = [
        *(refusal(replace, array, **one) for one in ({"rows": 0}, {"columns": 0}, {"spacing": 0.0},
          {"inlet_diameter": -1.0}, {"position": math.nan})),
        *(refusal(array_reading, x, y, *one, array) for one in (
            (time[::-1], place, *many), (time[:1], place[:1], *many), (time, place[:2], *many),
            (time, place, many[0][:2], many[1]))),
        *(refusal(array_reading, x, y, time, place, *many, array, **one) for one in (
            {"offsets": 2}, {"threshold": 0.0}, {"sampling_interval": 0.0}, {"compliance": -1.0},
            {"compliance": 1e-16})),
    ]  # fmt: skip
    held(file_regression, said)


def test_small_parts(file_regression, flat, barred):
    cost = solution_cost(2e-3, 5e-4)
    said: dict[str, Any] = {
        "cost": (cost, str(cost), megabytes(123456789), solution_cost(1e-4, 2e-3)),
        "too large": [refusal(refuse_too_large, cost, most_memory=most, where="a", spacing=5e-4)
                      for most in (1e7, 1.4e8)],
        "enough": refuse_too_large(cost, most_memory=cost.memory, where="a", spacing=5e-4),
        "text": str(Cost(3, (0.4, 1.6), 2.5e9)),
    }  # fmt: skip
    land = barred.sole.land
    pressure = np.where(land, 1e5, 0.0)
    i, j = np.argwhere(land)[5]
    pressure[i, j] = 7e5
    for area in (1e-6, 10e-6, 50e-6):
        peak = peak_pressure(barred.sole, pressure, averaging_area=area)
        said[f"peak {area}"] = peak, peak.remark
    inner = np.zeros_like(flat.sole.land, dtype=float)
    inner[5, 4] = 1e5
    said["inner"] = peak_pressure(flat.sole, inner, cell_load=0.5 * inner)
    said["no peak"] = refusal(peak_pressure, flat.sole, inner[:3])
    said["over"] = [overloaded_share(pressure, pressure, m) for m in (1e4, 1e5, 9e5)]
    said["none"] = overloaded_share(0 * pressure, 0 * pressure, 1e5)
    said["scale"] = [
        asperity_scale(one.asperities, p) for one in (flat, barred) for p in (1e4, 1e6)
    ]
    x, heights = flat.sole.x, flat.sole.clearance
    said["rolled"] = [rolled_clearance(x, heights, a, None) for a in (-0.02, 0.0, 0.05)]
    said["sole"] = rolled_sole(flat.sole, 0.03).clearance, rolled_sole(flat.sole, 0.03).cells
    said["trimmed"] = trim_map(barred.sole, 1e-4).clearance
    rng = np.random.default_rng(9)
    matrix = np.eye(12) + 0.2 * rng.normal(size=(12, 12))
    right = rng.normal(size=12)
    said["krylov"] = krylov_solution(lambda v: matrix @ v, lambda v: v, right, tolerance=1e-10)
    said["few"] = krylov_solution(lambda v: matrix @ v, lambda v: 2 * v, right, tolerance=1e-3,
                                  most=4)  # fmt: skip
    said["zero"] = krylov_solution(lambda v: v, lambda v: v, 0 * right, tolerance=1e-3)
    said["broken"] = krylov_solution(lambda v: 0 * v, lambda v: v, right, tolerance=1e-3)
    falling, level = [1.0, 0.1, 0.01], [1.0] * 40
    turns = [1.0, 0.2, 0.7] * 12
    said["hopeless"] = [_hopeless(one) for one in (falling[:2], falling, level, [1.0, 2.0, 1e4])]
    said["stuck"] = [_stuck(one) for one in (falling, level, level[:5])]
    said["cycling"] = [_cycling(one) for one in (falling, level, turns, turns[:4], [1.0, 0.2] * 9)]
    held(file_regression, said)
    np.testing.assert_allclose(matrix @ said["krylov"][0], right, atol=1e-9)


def test_what_is_refused(file_regression, flat):
    sole, own = flat.sole, flat.compliance.self_compliance
    good = SolverSettings()
    said: dict[str, Any] = {}

    def setup(name, *, sole=sole, own=own, viscosity=0.1, force=10.0, **settings):
        said[name] = refusal(check_setup, sole, own, viscosity, force, replace(good, **settings))

    setup("force", force=0.0)
    setup("viscosity", viscosity=-1.0)
    for name in ("pool_depth", "start_film", "rise_time", "tolerance"):
        setup(name, **{name: 0.0})
    for name in ("most_newton", "most_time_steps"):
        setup(name, **{name: 0})
    setup("cavity", cavity_pressure=1.0)
    setup("no cavity", cavity_pressure=-math.inf)
    setup("backend", backend="none such")
    setup("below", sole=replace(sole, clearance=sole.clearance - 1e-3))
    setup("shape", own=own[:3])
    setup("stiff", own=0 * own)
    setup("infinite", own=own + math.inf)
    for name, one in (("rise", {"rise_time": 0.0}), ("end", {"end_time": 0.0}),
                      ("early", {"rise_time": 0.03, "end_time": 0.0299})):  # fmt: skip
        said[f"times {name}"] = refusal(check_times, replace(good, **one))
    demands = {
        "time": (0.0, 1.0, 0.1, None), "force": (1.0, -1.0, 0.1, None),
        "speed": (1.0, 1.0, math.nan, None), "angle": (1.0, 1.0, 0.1, 1.05),
        "other angle": (1.0, 1.0, 0.1, -1.05),
    }  # fmt: skip
    said |= {f"demand {name}": refusal(check_demand, *one) for name, one in demands.items()}
    said["rising"] = refusal(check_demand, 1.0, 0.0, 0.1, None, rising=True)
    assert check_demand(1.0, 0.0, 0.1, 1.04) is None
    rows = np.array([0.0, 1.0])
    histories = {
        "shape": ([0.0], [1.0], [1.0], [0.0]), "nan": (rows, rows * math.nan, rows, rows),
        "late": (rows + 1, rows, rows, rows), "falls": (-rows, rows, rows, rows),
        "pulls": (rows, -rows, rows, rows), "nothing": (rows, 0 * rows, rows, rows),
        "lengths": (rows, rows[:1], rows, rows),
    }  # fmt: skip
    said |= {f"history {name}": refusal(MotionHistory, *one) for name, one in histories.items()}
    held(file_regression, said)


def test_steps_that_swing_are_calmed(file_regression, flat):
    def state(*values: float) -> State:
        row = np.array(values)
        return State(1e5 * row, 0.0, 1e-5 * row, 1e4 * row, row, row > 9, row)

    said = {
        "calm": _calm_start((state(1, 1, 1, 1), state(3, 2, 1, 1.5)), (state(3, 2, 1, 1.5),
                        state(1.2, 2.5, 1, 4))),
        "share": [_step_share(replace_problem(flat), 1e-6 * np.array([0.1, 2.0, 500.0]),
                              1e-6 * np.array(rise))
                  for rise in ([0.0, 0.0, 0.0], [-0.2, 0.1, 9.0], [0.1, -9.0, 0.0], [90.0, 0, 0])],
        "thick": _step_share(replace_problem(flat), np.full(2, 1e-3), np.full(2, 1.0)),
    }  # fmt: skip
    held(file_regression, said)


def replace_problem(parts: Prepared) -> Any:
    """Return the problem of a small sole."""
    sliding = SlidingSole(parts.sole, parts.compliance, parts.asperities, viscosity=0.02)
    return sliding.bookmark().march[0]


def test_rough_walls_under_a_pad(file_regression):
    case = pad(STEP, DRY)
    assert case.motion.build() is not None
    law = ExponentialLaw(2e6, 0.5, 4e-6)
    parts = prepare_case(pad(DRY), 2e-3)
    made = solve_sliding(parts.sole, parts.compliance, law, viscosity=None, speed=0.1,
                         normal_force=30.0)  # fmt: skip
    held(file_regression, told(made))
    assert made.contact_load == pytest.approx(30.0, rel=1e-3)
