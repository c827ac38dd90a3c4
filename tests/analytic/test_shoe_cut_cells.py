"""Outlines of lugs through square cells: areas, places of edges, and the film between them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.film import Conductance, film_operator
from underfoot.rough_contact import ExponentialLaw
from underfoot.shoe import Flat, Heel, Tread, heel_map, heel_surface, surface_map
from underfoot.shoe.cut_cells import LEAST_AREA
from underfoot.sole_contact.compliance import layered_compliance
from underfoot.sole_contact.solver import solve_sliding

MM = 1e-3


def heel(tread=None, **changes):
    plain = {"length": 60 * MM, "width": 60 * MM, "rear_radius": 0.0, "outsole_thickness": 25 * MM}
    return Heel(**(plain | changes), profile=Flat(), tread=tread)


@settings(deadline=None, max_examples=10)
@given(
    pattern=st.sampled_from(["transverse", "longitudinal", "grid", "hexagons", "circles"]),
    lug=st.floats(3.5, 9.0),
    shift=st.tuples(st.floats(0, 8), st.floats(0, 8)),
)
def test_cells_share_out_their_area_and_lugs_get_theirs(pattern, lug, shift):
    tread = Tread(pattern, lug * MM, 3 * MM, 3 * MM).moved((shift[0] * MM, shift[1] * MM))
    coarse, fine = (heel_map(heel(tread), shoe_angle=0.0, spacing=s * MM) for s in (1.0, 0.25))
    for area in (coarse.cut.area, coarse.cut.film_area):
        assert area.sum() == pytest.approx(area.size, rel=1e-12)
        assert (area > 0.1).all()  # no lug here is a sliver
    # the rim itself is not cut: a lug that ends just there may count half a cell too much
    assert coarse.land_ratio == pytest.approx(fine.land_ratio, abs=0.012)
    places = np.concatenate([coarse.cut.along.ravel(), coarse.cut.across.ravel()])
    assert ((places >= 0) & (places <= 1)).all()


def test_the_area_of_lugs_is_smooth_in_their_width():
    """Per 0.1 mm of width it grows evenly; counted cells jump by whole rows."""
    widths = np.arange(5.0, 6.51, 0.1)
    cut, counted = [], []
    for width in widths:
        tread = Tread("hexagons", width * MM, 3 * MM, 3 * MM, offset=(3.3 * MM, 0.2 * MM))
        sole = heel_map(heel(tread), shoe_angle=0.1, spacing=1 * MM)
        cut.append(sole.land_area)
        counted.append(np.count_nonzero(sole.land) * sole.spacing**2)
    smooth, jumps = (np.abs(np.diff(each, 2)).max() / each[0] for each in (cut, counted))
    assert smooth < 0.015  # the rim of the plan form is not cut
    assert smooth < 0.35 * jumps


def test_a_sole_without_lugs_is_not_cut():
    cut = heel_map(heel(), shoe_angle=0.1, spacing=1 * MM).cut
    assert (cut.along == 0.5).all()
    assert (cut.across == 0.5).all()
    assert (cut.area == 1).all()
    assert (cut.film_area == 1).all()


def test_a_height_map_is_cut_as_the_heel_it_shows():
    tread = Tread("grid", 6.3 * MM, 3.2 * MM, 3 * MM, offset=(0.4 * MM, 0.3 * MM))
    exact = heel_map(heel(tread), shoe_angle=0.15, spacing=1 * MM)
    surface = heel_surface(heel(tread), spacing=0.2 * MM)
    found = surface_map(surface, shoe_angle=0.15, spacing=1 * MM)
    assert found.land_area == pytest.approx(exact.land_area, rel=0.02)


def test_a_sliver_of_a_height_map_keeps_some_area():
    """A row of land as thin as the map's own cells, between the centres of coarser ones."""
    surface = heel_surface(heel(), spacing=0.25 * MM)
    land = np.zeros(surface.land.shape, dtype=bool)
    land[80:83], land[120:200] = True, True
    height = np.where(land, 0.0, 3 * MM)
    thin = replace(surface, land=land, height=height, tread_depth=3 * MM * land, base=0 * height)
    for spacing in (0.7 * MM, 1.0 * MM):
        cut = surface_map(thin, shoe_angle=0.1, spacing=spacing).cut
        assert cut.area.min() >= LEAST_AREA
        assert cut.film_area.min() >= LEAST_AREA


@pytest.mark.parametrize("place", [0.0, 0.2, 0.5, 0.9, 1.0])
def test_flow_through_a_step_is_exact_wherever_it_lies(place):
    """A thin film beside a groove: two pieces in series, with the wall's drag."""
    thin, deep, drop, speed, length = 20e-6, 400e-6, 5e4, 0.2, 1e-3
    gap = np.array([[thin], [deep]])
    conductance = gap**3 / (12 * 0.1)
    nil = np.zeros_like(gap)
    operator = film_operator(
        gap,
        Conductance(conductance, nil),
        Conductance(conductance, nil),
        spacing=(length, length),
        speed=speed,
        edges=(np.array([[place]]), 0.5),
    )
    flow = operator.flows(np.array([[drop], [0.0]]), np.ones_like(gap))[0].item()
    pieces = ((place * length, thin), ((1 - place) * length, deep))
    resistance = sum(s * 1.2 / h**3 for s, h in pieces)
    dragged = sum(s * 1.2 * speed / h**2 for s, h in pieces)
    assert flow / length == pytest.approx((drop + dragged) / resistance, rel=1e-12)


@pytest.fixture(scope="module")
def squeezed():
    """Load on the film under one bar against its width, 1 mm cells, and cells counted whole."""

    def load(width, cut):
        tread = Tread("transverse", width * MM, 30 * MM, 3 * MM)
        shape = heel(tread, length=24 * MM, width=24 * MM)
        sole = heel_map(shape, shoe_angle=0.0, spacing=1 * MM)
        if not cut:
            sole = replace(sole, cut=None)
        body = layered_compliance(sole, modulus=4e6, poisson_ratio=0.49, thickness=25 * MM)
        law = ExponentialLaw(4e6, 0.5, 15e-6)
        solved = solve_sliding(sole, body, law, viscosity=0.2, speed=0.1, normal_force=60.0)
        assert solved.status.usable
        assert solved.fluid_load + solved.contact_load == pytest.approx(60.0, rel=1e-3)
        return solved.fluid_load

    widths = np.arange(6.6, 8.61, 0.25)  # one cell crossed on each side
    return [np.array([load(w, cut) for w in widths]) for cut in (True, False)]


@pytest.mark.slow
def test_film_load_is_smooth_in_the_width_of_a_lug(squeezed):
    cut, counted = (np.abs(np.diff(each, 2)).max() / each.mean() for each in squeezed)
    assert cut < 0.3 * counted


def test_tilt_stretches_cells_not_lugs():
    tread = Tread("transverse", 5.3 * MM, 2.7 * MM, 3 * MM)
    flat, tilted = (
        heel_map(heel(tread), shoe_angle=math.radians(a), spacing=0.7 * MM) for a in (0, 15)
    )
    assert tilted.land_area == pytest.approx(flat.land_area * math.cos(math.radians(15)), rel=0.02)
