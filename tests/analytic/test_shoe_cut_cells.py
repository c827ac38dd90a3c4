"""Outlines of lugs through square cells: areas, places of edges, and the film between them."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import label

from underfoot.film import Conductance, film_operator
from underfoot.friction import FrictionParts, cof
from underfoot.rough_contact import ExponentialLaw
from underfoot.shoe import Flat, Heel, Tread, heel_map, heel_surface, surface_map
from underfoot.shoe.cut_cells import LEAST_AREA
from underfoot.sole_contact import floor_sensor_reading
from underfoot.sole_contact.compliance import layered_compliance
from underfoot.sole_contact.solver import solve_sliding

MM = 1e-3
LOAD, VISCOSITY, SPEED = 60.0, 0.2, 0.1


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
    tread = Tread(pattern, lug * MM, 3 * MM, 3 * MM).shift_grooves((shift[0] * MM, shift[1] * MM))
    coarse, fine = (heel_map(heel(tread), shoe_angle=0.0, spacing=s * MM) for s in (1.0, 0.25))
    for area in (coarse.cut.area, coarse.cut.film_area):
        assert area.sum() == pytest.approx(area.size, rel=1e-12)
        assert (area > 0.1).all()  # no lug here is a sliver
    # the rim itself is not cut: a lug that ends just there may count half a cell too much, and
    # lugs take up three quarters of four sides at most
    assert coarse.land_ratio == pytest.approx(fine.land_ratio, abs=3 * 0.5 / 60)
    places = np.concatenate([coarse.cut.along.ravel(), coarse.cut.across.ravel()])
    assert ((places >= 0) & (places <= 1)).all()


@pytest.mark.parametrize("shift", [(0.0, 0.0), (3.3, 0.2), (0.4, 5.7)])
def test_a_hexagon_has_its_area_on_any_cells(shift):
    """Each cut cell is known within half of one of its 16 samples, evenly either way."""
    for width in np.arange(5.0, 6.51, 0.1):
        tread = Tread("hexagons", width * MM, 3 * MM, 3 * MM, offset=(shift[0] * MM, shift[1] * MM))
        sole = heel_map(heel(tread), shoe_angle=0.0, spacing=1 * MM)
        lugs, _ = label(sole.land)
        middle = lugs == lugs[np.unravel_index(_far_inside(sole.land).argmax(), lugs.shape)]
        cut_cells = math.sqrt(12) * width  # its perimeter over the side of a cell
        exact = math.sqrt(3) / 2 * width**2
        assert sole.cut.area[middle].sum() == pytest.approx(exact, abs=3 * cut_cells**0.5 / 32)


def _far_inside(land):
    """Return the land far from the rim of the map, nearest to its middle highest."""
    i, j = np.indices(land.shape)
    away = np.hypot(i - land.shape[0] / 2, j - land.shape[1] / 2)
    return np.where(land, -away, -np.inf)


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


@cache
def squeezed(width, spacing=1.0, cut=True):
    """Contact and film under one bar of a width (mm) on cells of a spacing (mm)."""
    tread = Tread("transverse", width * MM, 30 * MM, 3 * MM, offset=(4 * MM, 0.0))
    shape = heel(tread, length=24 * MM, width=24 * MM)
    sole = heel_map(shape, shoe_angle=0.0, spacing=spacing * MM)
    if not cut:
        sole = replace(sole, cut=None)
    body = layered_compliance(sole, modulus=4e6, poisson_ratio=0.49, thickness=25 * MM)
    law = ExponentialLaw(4e6, 0.5, 15e-6)
    solved = solve_sliding(sole, body, law, viscosity=VISCOSITY, speed=SPEED, normal_force=LOAD)
    assert solved.status.usable
    assert solved.fluid_load + solved.contact_load == pytest.approx(LOAD, rel=1e-3)
    return sole, solved


WIDTHS = np.arange(6.6, 8.61, 0.25)  # the edge crosses two cells
ROW = 1 / 7.6
"""What a row of cells more or less changes, of the whole."""


@pytest.mark.slow
@pytest.mark.xfail(
    strict=True,
    reason="uneven by 7.2 % of the mean, below 6.6 % asked; by 2.6 % with rubber 100 times as "
    "stiff: a partly covered cell presses on rubber as a whole one",
)
def test_film_load_is_smooth_in_the_width_of_a_lug():
    cut, counted = (
        np.array([squeezed(width, cut=cut)[1].fluid_load for width in WIDTHS])
        for cut in (True, False)
    )
    unevenness = [np.abs(np.diff(each, 2)).max() / each.mean() for each in (cut, counted)]
    assert unevenness[0] < ROW / 2
    assert unevenness[1] > ROW / 2


def bar_numbers(width, spacing=1.0):
    """Highest pressure of the film, as a sensor reads it, mean pressure, and shear force."""
    sole, solved = squeezed(width, spacing)
    read = floor_sensor_reading(
        solved.x, solved.y, solved.fluid_pressure, solved.film_thickness, inlet_diameter=4 * MM
    )
    under = solved.cut.area[sole.land]
    mean = solved.cell_load.sum() / under.sum()
    assert mean == pytest.approx(LOAD / (width * 24 * MM**2), rel=0.01)  # the rim is a cell's edge
    parts = FrictionParts(*np.zeros((2, *sole.land.shape)), viscous=drag(solved, sole.land))
    pressures = solved.contact_pressure, solved.fluid_pressure
    sheared = cof(parts, *pressures, spacing=solved.spacing, wet=solved.wet, **solved.areas)
    assert sheared.normal_force == pytest.approx(solved.fluid_load + solved.contact_load, rel=1e-12)
    return solved.fluid_pressure.max(), read.peaks.mean(), mean, sheared.friction_force


def drag(solved, land):
    return np.where(land, VISCOSITY * SPEED / np.maximum(solved.film_thickness, 1e-7), 0.0)


def test_what_is_read_under_a_lug_is_continuous_as_its_edge_moves_through_a_cell():
    """Loads of cut cells are not pressures: an edge through a cell would double or halve them."""
    series = np.array([bar_numbers(width) for width in WIDTHS])
    uneven = np.abs(np.diff(series, 2, axis=0)).max(axis=0) / series.mean(axis=0)
    assert (uneven < ROW / 3).all()  # of a whole row that came or went


def test_what_is_read_under_a_lug_is_that_of_a_fine_grid():
    for width in (6.6, 7.6, 8.6):
        coarse, fine = np.array(bar_numbers(width)), np.array(bar_numbers(width, 0.4))
        # first order in the share that one row of cells has of the bar
        assert np.abs(coarse / fine - 1).max() < 1 / width + 0.05


def test_tilt_stretches_cells_not_lugs():
    tread = Tread("transverse", 5.3 * MM, 2.7 * MM, 3 * MM)
    flat, tilted = (
        heel_map(heel(tread), shoe_angle=math.radians(a), spacing=0.7 * MM) for a in (0, 15)
    )
    assert tilted.land_area == pytest.approx(flat.land_area * math.cos(math.radians(15)), rel=0.02)
