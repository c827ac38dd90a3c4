"""Edges of lugs: the closed forms against finite elements with film, their limits, the geometry."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from underfoot.case import Case
from underfoot.case.friction import PairOption
from underfoot.compute.prepare import prepare_case
from underfoot.compute.resolve import resolve_context
from underfoot.compute.run import run
from underfoot.compute.sole import sole_map
from underfoot.core.catalogue import Catalogue
from underfoot.friction import FrictionLaw
from underfoot.rough_contact import ContactTable, ExponentialLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact import layered_compliance, solve_sliding
from underfoot.sole_contact import lug_edges as module
from underfoot.sole_contact.lug_edges import (
    EdgedLaw,
    LugEdges,
    LugInlet,
    let_in,
    lug_edges,
    lug_friction,
)
from underfoot.sole_contact.solver import SolverSettings
from underfoot.surface import rms_slope, self_affine

# A block 10 mm long and 5 mm high of 3 MPa at 100 kPa, pair of Rq 2 um, contact COF 0.3, full
# suction: plane-strain elements coupled with Reynolds and rough contact, in time.
# (viscosity x speed, film share, suction share, COF) by edge radius in mm
COUPLED = {
    0.11: [
        (0.003, 0.003, 0.927, 0.585),
        (0.01, 0.011, 0.955, 0.612),
        (0.03, 0.03, 0.952, 0.69),
        (0.1, 0.338, 0.102, 0.559),
        (0.3, 0.964, 0.052, 0.6),
    ],
    0.83: [
        (0.003, 0.031, 0.791, 0.541),
        (0.01, 0.334, 0.002, 0.23),
        (0.03, 0.967, 0.003, 0.055),
        (0.1, 1.005, 0.006, 0.074),
        (0.3, 1.01, 0.01, 0.119),
    ],
}


def one_lug(length=0.01, width=1.0, height=0.005, edge=1e-4, fed=1.0):
    arrays = (np.array([value]) for value in (length, width, height, edge, fed))
    return LugEdges(np.array([[1]]), np.ones((1, 1)), *arrays)


def friction(
    edges=None, pressure=1e5, cof=0.3, drag=0.01, suction=1e5, rq=2e-6, modulus=3e6, film_load=0.0
):
    return lug_friction(
        edges or one_lug(),
        np.array([[pressure]]),
        np.array([cof]),
        ExponentialLaw(modulus, 0.5, rq),
        modulus=modulus,
        viscosity=drag,
        speed=1.0,
        suction=suction,
        film_load=film_load,
    )


def block(spacing, length=10e-3, height=5e-3):
    """Return one lug across a sole 40 mm wide, a groove before and behind it."""
    nx, ny = round(2 * length / spacing), round(0.04 / spacing)
    x, y = ((np.arange(n) - 0.5 * (n - 1)) * spacing for n in (nx, ny))
    land = np.broadcast_to((np.abs(x) < 0.5 * length)[:, None], (nx, ny)).copy()
    depth, inside = np.full((nx, ny), height), np.ones((nx, ny), dtype=bool)
    clearance = np.where(land, 0.0, height)
    return SoleMap(x, y, clearance, inside, land, depth, spacing, np.zeros((4, 2)))


@cache
def block_film(radius, drag, spacing=1e-3):
    """Return the share of its load that the film bears under the block of the finite elements."""
    sole = block(spacing)
    edges = lug_edges(sole, radius, worn_edge_radius=0.0)
    load = 1e5 * np.count_nonzero(sole.land) * spacing**2
    solved = solve_sliding(
        sole,
        layered_compliance(sole, modulus=3e6, poisson_ratio=0.49, thickness=0.02),
        ExponentialLaw(3e6, 0.5, 2e-6),
        viscosity=drag,
        speed=1.0,
        normal_force=load,
        settings=SolverSettings(end_time=0.3),
        inlet=LugInlet(edges, 0.3, 3e6),
    )
    return solved.fluid_load / load


@pytest.mark.slow
def test_film_and_friction_of_blocks_of_the_coupled_finite_elements():
    """Film within 0.13 of the load; suction within 6 % of friction where the edge wipes."""
    for radius, rows in COUPLED.items():
        for drag, film, pull, _ in rows:
            borne = block_film(radius * 1e-3, drag)
            assert borne == pytest.approx(min(film, 1.0), abs=0.13)
            if film < 0.05:
                factor = friction(one_lug(edge=radius * 1e-3), drag=drag).factor.item()
                assert (1 - borne) * factor == pytest.approx(1 - film + pull, rel=0.06)


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "drag"), [(0.11e-3, 0.1), (0.83e-3, 0.01)])
def test_film_under_a_block_does_not_depend_on_the_cells(radius, drag):
    assert block_film(radius, drag, 0.5e-3) == pytest.approx(block_film(radius, drag), abs=0.03)


def test_film_under_a_block_is_that_of_its_mirror_image_slid_back():
    sole, law = block(1e-3), ExponentialLaw(3e6, 0.5, 2e-6)
    body = layered_compliance(sole, modulus=3e6, poisson_ratio=0.49, thickness=0.02)
    forth, back = (
        solve_sliding(
            sole,
            body,
            law,
            viscosity=0.1,
            speed=speed,
            normal_force=40.0,
            inlet=LugInlet(lug_edges(sole, 1e-4, worn_edge_radius=0.0), 0.3, 3e6),
        )
        for speed in (1.0, -1.0)
    )
    np.testing.assert_allclose(
        back.fluid_pressure[::-1], forth.fluid_pressure, atol=1e-3 * forth.fluid_pressure.max()
    )


@pytest.mark.slow
def test_ribs_along_the_sliding_have_no_edge_that_lets_a_film_in():
    case = tread("longitudinal", **SIZES).replace("numerics.tread_positions", 1)
    with_edges, without = (
        run(one, quick=True).value("fluid_load")
        for one in (case, case.replace("film.lug_edges", False))
    )
    assert with_edges == pytest.approx(without, rel=1e-9)


@pytest.mark.slow
def test_sharp_edges_grip_more_than_round_ones_under_thick_fluid():
    """Ishizako et al. 2022: 0.11 mm above 0.83 mm."""
    for drag in (0.01, 0.03, 0.1):
        sharp, rounded = (
            (1 - block_film(r, drag)) * friction(one_lug(edge=r), drag=drag).factor.item()
            for r in (0.11e-3, 0.83e-3)
        )
        assert sharp > 1.3 * rounded


def test_a_lug_that_the_film_bears_has_no_suction():
    pressed = {"pressure": 3e4, "drag": 0.05, "rq": 2e-6}
    alone, afloat = (friction(film_load=film, **pressed).suction.item() for film in (0.0, 4e5))
    assert alone > 0.3
    assert afloat < 0.05


def test_relaxation_by_aitkens_rule_ends_where_small_even_steps_do(monkeypatch):
    """A block at which 200 even steps had not settled: its factor was 1.07."""
    edges = one_lug(edge=0.83e-3)
    quick = friction(edges, drag=0.01).factor.item()
    monkeypatch.setattr(module, "RELAXATION", (0.02, 0.02))
    monkeypatch.setattr(module, "STEPS", 5000)
    monkeypatch.setattr(module, "STILL", 1e-9)
    assert quick == pytest.approx(friction(edges, drag=0.01).factor.item(), rel=1e-5)


def test_mean_pressure_of_a_lug_does_not_ask_which_cells_were_solved():
    """An asperity law never quite ends: what counted was where the solver had set it to 0."""
    edges = LugEdges(np.ones((2, 2), dtype=int), np.ones((2, 2)), *(
        np.array([value]) for value in (0.01, 1.0, 0.005, 1e-4, 1.0)
    ))  # fmt: skip
    asperities = ExponentialLaw(3e6, 0.5, 2e-6)
    constants = {"modulus": 3e6, "viscosity": 0.01, "speed": 1.0, "suction": 1e5}

    def factor(tail):
        pressure = np.array([[4e5, 1e5], [tail, tail]])
        return lug_friction(edges, pressure, np.array([0.3]), asperities, **constants).factor

    assert factor(0.0) == pytest.approx(factor(1e-30), rel=1e-12)


def test_fluid_from_the_sides_takes_two_parabolas_of_the_suction():
    """From either side it comes as far in as from behind, less towards the leading edge."""
    edges = (one_lug(height=1e-3, width=width) for width in (10.0, 2e-3))
    wide, narrow = (friction(each, drag=3e-3, suction=1e4) for each in edges)
    asperities = ExponentialLaw(3e6, 0.5, 2e-6)
    most = 1e5 * (1 + wide.suction.item())
    dry = brentq(lambda gap: float(asperities.pressure(gap)) - most, 1e-9, 1e-4)
    back = dry**2 * 1e4 / (6 * module.LACKING * 3e-3)
    left = 1 - 4 / 3 * math.sqrt(back * 0.01) / 2e-3
    assert 0.6 < left < 0.8
    assert narrow.suction.item() / wide.suction.item() == pytest.approx(left, abs=0.01)


def test_a_lug_longer_than_twice_its_height_wipes_no_better():
    edges = (one_lug(length=length, height=2e-3) for length in (2e-3, 0.02, 0.04))
    short, long, longer = (each.reach.item() for each in edges)
    assert short < long == longer


def test_limits():
    slow = friction(drag=1e-9)
    assert slow.suction.item() == pytest.approx(0.0, abs=1e-6)  # fluid is drawn back in
    assert friction(suction=0.0).factor.item() == 1.0
    assert friction(one_lug(fed=0.0)).factor.item() == 1.0  # no groove ahead of it
    assert friction(pressure=1e3).factor.item() == 1.0  # hardly bears
    assert friction(suction=1e5).factor.item() > friction(suction=5e4).factor.item()
    most = friction(drag=0.01, pressure=1e5, suction=1e5)
    assert most.suction.item() <= 1.0  # at most a vacuum over the whole face


def tread(pattern, **more):
    return Case(
        shoe={"from": "work_shoe_full_tread", "tread": {"pattern": pattern, **more}},
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion={"from": "slip_tester_g4", "speed": 0.3},
        numerics={"grid_spacing": "0.5 mm", "quick_grid_spacing": "1 mm"},
    )


WORN = 0.15e-3
SIZES = {"depth": "3 mm", "lug_width": "5 mm", "channel_width": "2.5 mm"}


@pytest.mark.parametrize("forward", [True, False])
def test_lugs_of_a_sole(forward):
    edges = lug_edges(
        sole_map(tread("grid", **SIZES), 5e-4), 0.0, worn_edge_radius=WORN, forward=forward
    )
    whole = edges.length * edges.width > 22e-6
    assert np.count_nonzero(whole) > 40
    np.testing.assert_allclose(edges.length[whole], 5e-3, rtol=0.12)
    np.testing.assert_allclose(edges.width[whole], 5e-3, rtol=0.12)
    np.testing.assert_allclose(edges.height[whole], 3e-3, rtol=1e-6)
    assert np.mean(edges.fed[whole]) > 0.8
    along = lug_edges(
        sole_map(tread("longitudinal", **SIZES), 5e-4), 0.0, worn_edge_radius=WORN, forward=forward
    )
    assert np.max(along.fed) < 0.2  # ribs along the sliding have no leading face
    assert lug_edges(sole_map(tread("none"), 5e-4), 0.0, worn_edge_radius=WORN) is None


@pytest.mark.slow
def test_a_run_says_what_the_edges_do():
    case = tread("transverse", **SIZES).replace("numerics.tread_positions", 1)
    with_edges, without = (
        run(one, quick=True) for one in (case, case.replace("film.lug_edges", False))
    )
    assert "lug_edges" in with_edges.labels
    assert "lug_edges" not in without.labels
    assert with_edges.value("cof") > without.value("cof")
    assert with_edges.value("fluid_load") != pytest.approx(without.value("fluid_load"), rel=0.01)
    low, high = with_edges.scalars["cof"].interval
    assert low < with_edges.value("cof") < high


def test_wear_makes_the_edges_of_the_lugs_that_it_meets():
    case = Case(
        shoe="work_shoe_full_tread",
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion={"from": "slip_tester_g4"},
    )
    wear = {"mode": "walk", "depth": "1 mm"}
    new, worn = (sole_map(each, 1e-3) for each in (case, case.replace({"shoe.wear": wear})))
    before, after = (lug_edges(each, 0.0, worn_edge_radius=WORN) for each in (new, worn))
    assert (before.edge == 0.1e-3).all()
    assert after.edge.max() == pytest.approx(WORN)
    assert np.count_nonzero(after.edge == 0.1e-3) > 5  # in front nothing wears
    moulded = lug_edges(worn, 0.4e-3, worn_edge_radius=WORN).edge
    assert moulded.min() < 0.2e-3  # wear takes a moulded round off
    assert moulded.max() == 0.4e-3
    let = let_in(0.03, np.full(2, 1e5), np.array([before.edge.max(), after.edge.max()]), 3e6, 0.0)
    assert let[1] > let[0]


@pytest.mark.parametrize(("forward", "fed"), [(True, 1.0), (False, 0.0)])
def test_a_lug_is_fed_by_the_groove_that_it_slides_into(forward, fed):
    """One lug across the sole, the groove before it (x up), the rim behind it."""
    rows = np.arange(10)[:, None] + np.zeros(4)
    inside, land = rows > 0, (rows > 0) & (rows < 5)
    depth = np.where(land, 3e-3, 0.0)
    x, y = 1e-3 * np.arange(10), 1e-3 * np.arange(4)
    sole = SoleMap(x, y, np.where(inside, 0.0, np.inf), inside, land, depth, 1e-3, np.zeros((4, 2)))
    edges = lug_edges(sole, 0.0, worn_edge_radius=WORN, forward=forward)
    assert edges.fed == pytest.approx([fed])
    assert edges.length == pytest.approx([4e-3])
    assert edges.width == pytest.approx([4e-3])


WATER = 3e-4
"""Viscosity times speed of water at 0.3 m/s, Pa m."""


def probability(lug=None, drag=WATER, rq=2e-6, full_contact=7e5, dewetting=0.2, **more):
    """Of the wiped state of one lug; full contact of a pair of Rq 2 um."""
    states = {"cof_wiped": np.array([0.5]), "full_contact": full_contact, "dewetting": dewetting}
    numbers = {"suction": 7e4, "modulus": 4e6, "viscosity": drag, "speed": 1.0} | states
    lug = lug or one_lug(length=5e-3, width=5e-3, height=2.5e-3)
    pair = ExponentialLaw(4e6, 0.5, rq)
    found = lug_friction(lug, np.array([[3e5]]), np.array([0.15]), pair, **numbers | more)
    assert 0 <= found.wiped.item() <= 1
    return found.wiped.item()


def test_a_contact_is_wiped_behind_an_edge_in_thin_fluids_on_smooth_pairs():
    assert probability() > 0.5
    assert probability(dewetting=0.0) == 0.0
    assert probability(one_lug(length=5e-3, width=5e-3, fed=0.0)) == 0.0  # no edge
    assert probability(drag=0.066) < 1e-9  # 90 % glycerol: the spots do not dry in time
    assert probability(drag=WATER / 1e6) == 0.0  # so slow that the gap fills from behind
    rough = {"rq": 18e-6, "full_contact": 3e6}  # of a rough sole: fluid is drawn back
    assert probability(**rough) < 0.1
    longer = one_lug(length=10e-3, width=20e-3)
    assert probability(longer) > probability()  # it passes for longer


def test_flow_through_the_gap_is_that_of_solved_contacts():
    """At a twentieth and a fifth of E* h': a third of a smooth gap's, then sealed."""
    surfaces = [
        self_affine(128, 4.7e-6, 5e-6, 0.8, 600e-6, 18.8e-6, seed=seed, roll_off=150e-6)
        for seed in (1, 2)
    ]
    slope = np.mean([rms_slope(one) for one in surfaces])
    stiff = 4.4e6 / 0.75 * slope
    nodes = np.array([0.02, 0.05, 0.1, 0.2]) * stiff
    table = ContactTable.from_surfaces(surfaces, 4.4e6, nodes, [0.3])
    flow = sum(table.values[f"flow_factor_{way}"][:, 0] for way in ("along", "across")) / 2
    known = np.interp(nodes / stiff, module.PRESSING, module.FLOW)
    np.testing.assert_allclose(flow, known, atol=0.08)


@pytest.mark.parametrize(
    ("pattern", "least", "most"), [("transverse", 0.5, 1.0), ("longitudinal", 0.0, 0.02)]
)
def test_draws_and_map_hold_the_mean_of_both_states(pattern, least, most):
    """Grooves across wipe, grooves along do not; the law for draws has the sum of the map."""
    smooth = {"contaminant.viscosity": "1 cP", "shoe.roughness.ra": "1 um"}
    case = tread(pattern, **SIZES).replace({**smooth, "interface.roughness_beyond_cutoff": 1.0})
    parts = prepare_case(case, 1e-3, {})
    law = parts.local_law
    pressure = np.where(parts.sole.land, 3e5, 0.0)
    film = np.full_like(pressure, 1e-3)
    lugs = law.lugs(pressure, 0.3, film)
    assert least <= np.average(lugs.wiped, weights=lugs.load) < most
    both, plain = law(pressure, 0.3, film), law.law(pressure, 0.3, film)
    drawn = law.with_mean_state(pressure, 0.3, film)
    sums = [
        float((one.adhesion * weight * law.edges.area).sum())
        for one, weight in ((both, 1.0), (drawn(pressure, 0.3, film), lugs.factor_map()))
    ]
    assert sums[0] == pytest.approx(sums[1], rel=1e-9)
    if pattern == "transverse":
        assert both.adhesion.sum() > 1.2 * plain.adhesion.sum()
        assert isinstance(drawn, FrictionLaw)
        spread = drawn.joint_draws(100, 0)
        assert drawn.at({name: float(value[0]) for name, value in spread.items()}).share > 0
        np.testing.assert_array_equal(both.hysteresis, plain.hysteresis * lugs.factor_map())
    none = replace(law, dewetting=0.0)
    assert not none.lugs(pressure, 0.3, film).wiped.any()
    assert none.with_mean_state(pressure, 0.3, film) is law.law


def test_laws_that_hold_no_real_area_have_one_state():
    case = tread("transverse", **SIZES).replace(
        {"friction.model": "stribeck", "contaminant": "water"}
    )
    law = prepare_case(case, 1e-3, {}).local_law
    pressure = np.where(law.edges.label > 0, 3e5, 0.0)
    assert not law.lugs(pressure, 0.3, np.full_like(pressure, 1e-3)).wiped.any()


@pytest.mark.parametrize("fluid", ["water", "detergent", "glycerol_50pct", "canola_oil"])
@pytest.mark.parametrize("floor", Catalogue.load().names("floor"))
def test_no_floor_of_the_catalogue_grips_more_wet_than_dry_behind_an_edge(floor, fluid):
    """Wiped, with suction: a lug of the sharpest edge."""
    parts = {"shoe": "work_shoe_full_tread", "floor": floor, "motion": "slip_tester_g4"}
    wet, dry = (resolve_context(Case(**parts, contaminant=name)) for name in (fluid, "none"))
    lug = one_lug(length=5e-3, width=5e-3, height=2.5e-3)
    plain = PairOption().build(wet)
    edged = EdgedLaw(
        plain,
        lug,
        ExponentialLaw(wet.youngs_modulus, 0.49, wet.rq_value),
        wet.youngs_modulus,
        wet.viscosity_value,
        suction=70e3,
        dewetting=0.2,
    )
    pressure, film = np.array([[3e5]]), np.array([[1e-3]])
    limit = PairOption().build(dry)(pressure, 0.3, film)
    for speed in (0.03, 0.3, 1.0):
        found = edged(pressure, speed, film)
        assert found.adhesion + found.hysteresis <= limit.adhesion + limit.hysteresis


@pytest.mark.parametrize("slender", [0.5, 1.0, 1.5])
@pytest.mark.parametrize("drag", [3e-4, 1e-3])
def test_a_lug_that_leans_presses_what_does_not_lift_off_closer(slender, drag):
    """A sharp edge lets no film in: the fixed point of suction and friction, one after the other.

    The resultant moves forward by e; beyond 0.12 of the length the rear lifts by 1.9 of the rest,
    what stays bears all, and the emptied gap there is that of the law at this pressure.
    """
    p, suction, law = 1e5, 1e5, ExponentialLaw(3e6, 0.5, 2e-6)
    edges = one_lug(edge=1e-9, length=5e-3, height=5e-3 * slender)
    shift = 0.5 - 0.012 / slender**2 + 0.12 / math.sqrt(slender)
    mu, pull = 0.3, 0.0
    for _ in range(3000):
        lifted = max(1 - 1.9 * max(min(shift * mu * slender, 0.47) - 0.12, 0.0), 0.12)
        pressed = p * (1 + pull) / lifted
        gap = brentq(lambda one, most=pressed: float(law.pressure(one)) / most - 1, 0.0, 1e-4)
        back = gap**2 * suction / (6 * 0.25 * drag)
        kept = max(1 - back / 5e-3, 0.0)
        kept *= max(1 - 4 / 3 * math.sqrt(back * 5e-3) / edges.width.item(), 0.0)
        emptied = lifted * kept
        sheared = drag / gap * (lifted - 0.5 * emptied) / p
        step = 0.3 * (1 + pull) + sheared - mu, emptied * suction / p - pull
        mu, pull = mu + 0.1 * step[0], pull + 0.1 * step[1]
        if max(map(abs, step)) < 1e-9:
            break
    told = friction(edges, drag=drag)
    assert told.suction.item() == pytest.approx(pull, abs=2e-3)
    assert lifted < 1.0
