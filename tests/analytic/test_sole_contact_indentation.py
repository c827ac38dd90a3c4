"""The coupled solver against closed forms: dry contact, squeeze film, soft EHL."""

from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.core import Status
from underfoot.film import Conductance, film_operator, upwinding
from underfoot.reference import contact, lubrication
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.sole_contact._kernels.elastic import BONDED_END, block_compression
from underfoot.sole_contact.compliance import (
    body_thickness,
    half_space_compliance,
    layered_compliance,
)
from underfoot.sole_contact.solver import SolverSettings, solve_sliding


def flat_map(x, y, clearance):
    ones = np.ones(clearance.shape, bool)
    return SimpleNamespace(
        whole=None,
        x=x,
        y=y,
        clearance=clearance - clearance.min(),
        inside=ones,
        land=ones,
        cut=None,
        slits=None,
        joint=None,
        cells=None,
        columns=1,
        tread_depth=np.zeros_like(clearance),
        spacing=float(x[1] - x[0]),
    )


def sphere(radius, spacing, behind, ahead, aside):
    x = np.arange(-round(behind / spacing), round(ahead / spacing) + 1) * spacing
    y = np.arange(-round(aside / spacing), round(aside / spacing) + 1) * spacing
    return flat_map(x, y, (x[:, None] ** 2 + y[None, :] ** 2) / (2 * radius))


def test_dry_sphere_is_hertzian():
    radius, modulus, load = 0.02, 2e6, 5.0
    exact = contact.hertz_point(load, radius, modulus)
    spacing = exact.half_width / 16
    sole = sphere(radius, spacing, *[1.6 * exact.half_width] * 3)
    body = half_space_compliance(sole.clearance.shape, spacing, modulus=modulus, poisson_ratio=0.0)
    law = ExponentialLaw(modulus, 0.0, 2e-7)
    solved = solve_sliding(sole, body, law, viscosity=None, speed=0.3, normal_force=load)
    assert solved.status is Status.CONVERGED
    assert solved.fluid_load == 0.0
    assert solved.contact_load == pytest.approx(load, rel=1e-4)
    assert solved.contact_pressure.max() == pytest.approx(exact.peak_pressure, rel=0.01)
    area = (solved.contact_pressure > 0.02 * exact.peak_pressure).sum() * spacing**2
    assert area == pytest.approx(np.pi * exact.half_width**2, rel=0.03)
    # the asperities of 0.2 um hold the surfaces apart by well below 1 % of the approach
    assert solved.approach == pytest.approx(exact.approach, rel=0.01)


@pytest.mark.parametrize("poisson_ratio", [0.3, 0.49])
def test_layer_symbol_and_uniform_pressure(poisson_ratio):
    n, spacing = 96, 1e-3
    sole = flat_map(np.arange(n) * spacing, np.arange(n) * spacing, np.zeros((n, n)))
    layer = layered_compliance(
        sole, modulus=4e6, poisson_ratio=poisson_ratio, thickness=3e-3, free_edges=False
    )
    k = np.geomspace(50, 3000, 20)
    expected = contact.bonded_layer_compliance(k, 3e-3, 4e6, poisson_ratio)
    assert layer.symbol(k) == pytest.approx(expected, rel=1e-6)
    # far from the rim a thin layer under uniform pressure compresses as in one dimension
    nu = poisson_ratio
    middle = layer.apply(np.full((n, n), 1e5))[n // 2, n // 2]
    uniform = 1e5 * 3e-3 * (1 + nu) * (1 - 2 * nu) / (4e6 * (1 - nu))
    assert middle == pytest.approx(uniform, rel=0.01)


def test_free_sided_lugs_compress_as_blocks():
    spacing, depth, modulus = 0.5e-3, 3e-3, 4e6
    x = (np.arange(60) + 0.5) * spacing
    lug = np.mod(np.arange(60), 15) < 10  # 5 mm lugs, 2.5 mm channels
    land = lug[:, None] & lug[None, :]
    sole = flat_map(x, x, np.zeros((60, 60)))
    sole.land = land
    sole.tread_depth = np.where(land, depth, 0.0)
    with_lugs = layered_compliance(sole, modulus=modulus, poisson_ratio=0.49, thickness=0.02)
    weights = with_lugs._weights
    compressed = weights[-1] * with_lugs._convolution(weights * 1e5)[-1]
    expected = block_compression(land, spacing, np.array(depth), modulus, 0.49) * 1e5
    assert compressed[land] == pytest.approx(expected[land], rel=2e-3)
    assert (compressed[~land] == 0).all()
    # a free side gives way more than the middle; none more than a free column
    assert compressed[7, 7] > compressed[4, 4]
    assert compressed[land].max() < 1e5 * depth / modulus


def test_block_of_a_strip_follows_its_closed_form():
    """Between two free sides q = cosh(k x) / cosh(k a); E f / d = 0.945 (q + (1 - q) E / M)."""
    spacing, height, modulus, nu = 0.1e-3, 3e-3, 4e6, 0.5
    mask = np.zeros((62, 400), bool)
    mask[1:-1] = True
    found = block_compression(mask, spacing, np.array(height), modulus, nu)[1:-1, 200]
    x = (np.arange(60) - 29.5) * spacing
    exact = np.cosh(x / height) / np.cosh(30 * spacing / height)
    assert found * modulus / height == pytest.approx(BONDED_END * exact, rel=2e-3)


def test_compliance_is_reciprocal():
    rng = np.random.default_rng(1)
    sole = flat_map(np.arange(30) * 1e-3, np.arange(24) * 1e-3, np.zeros((30, 24)))
    layer = layered_compliance(sole, modulus=4e6, poisson_ratio=0.49, thickness=0.02)
    one, two = rng.random((2, 30, 24))
    assert (one * layer.apply(two)).sum() == pytest.approx((two * layer.apply(one)).sum())
    assert (one * layer.apply(one)).sum() > 0


def test_rigid_disc_sinks_at_the_closed_form_rate_in_steps_of_any_length():
    radius, viscosity, load, start = 8e-3, 0.2, 20.0, 100e-6
    n = 33
    x = (np.arange(n) - n // 2) * (2 * radius / 28)
    distance = np.hypot(x[:, None], x[None, :])
    sole = flat_map(x, x, np.where(distance < radius, 0.0, np.inf))
    rigid = half_space_compliance((n, n), sole.spacing, modulus=1e13, poisson_ratio=0.0)
    area = (distance < radius).sum() * sole.spacing**2
    same_area = (area / np.pi) ** 0.5
    errors = []
    for resolution in (1.0, 8.0, 64.0):
        settings = SolverSettings(
            start_film=start,
            rise_time=1e-4,
            end_time=2e-2,
            pool_depth=1e-3,
            time_resolution=resolution,
        )
        solved = solve_sliding(
            sole,
            rigid,
            ExponentialLaw(1e6, 0.5, 1e-7),
            viscosity=viscosity,
            speed=0.0,
            normal_force=load,
            settings=settings,
        )
        exact = lubrication.squeeze_disc_gap(
            2e-2 - 0.5e-4, viscosity=viscosity, radius=same_area, start_gap=start, load=load
        )
        errors.append(float(solved.film_thickness[n // 2, n // 2] / exact - 1))
    assert exact < 0.7 * start
    assert abs(errors[-1]) < 0.005  # what the grid leaves
    # the mean mobility of a step is exact for a squeezed plate; the cube at its end is 5 % off
    assert np.ptp(errors) < 1e-3


@pytest.fixture(scope="module")
def soft_ehl():
    radius, modulus, speed = 23.3e-3, 2e6, 0.7
    effective = 2 * modulus
    load = 1e-3 * effective * radius**2
    viscosity = 5e-8 * effective * radius / (speed / 2)
    half_width = contact.hertz_point(load, radius, modulus).half_width
    spacing = half_width / 16
    sole = sphere(radius, spacing, 1.7 * half_width, 2.6 * half_width, 1.8 * half_width)
    body = half_space_compliance(sole.clearance.shape, spacing, modulus=modulus, poisson_ratio=0.0)
    law = ExponentialLaw(modulus, 0.0, 5e-8)
    solved = solve_sliding(
        sole,
        body,
        law,
        viscosity=viscosity,
        speed=speed,
        normal_force=load,
        settings=SolverSettings(pool_depth=1.0, start_film=2e-5, end_time=None),
    )
    film = lubrication.soft_ehl_film(
        viscosity=viscosity,
        entrainment_speed=speed / 2,
        load=load,
        radius=radius,
        effective_modulus=effective,
    )
    return SimpleNamespace(
        sole=sole,
        body=body,
        law=law,
        solved=solved,
        film=film,
        viscosity=viscosity,
        speed=speed,
    )


def test_soft_ehl_point_contact(soft_ehl):
    solved, (central, least) = soft_ehl.solved, soft_ehl.film
    assert solved.status is Status.CONVERGED
    assert solved.contact_load < 1e-6 * solved.normal_force
    i, j = np.argmin(np.abs(soft_ehl.sole.x)), np.argmin(np.abs(soft_ehl.sole.y))
    assert solved.film_thickness[i, j] == pytest.approx(central, rel=0.05)
    assert solved.film_thickness.min() == pytest.approx(least, rel=0.05)
    # the constriction lies behind the centre and the lobes beside it
    where = np.unravel_index(np.argmin(solved.film_thickness), solved.film_thickness.shape)
    assert soft_ehl.sole.x[where[0]] < 0


def test_soft_ehl_is_symmetric_across(soft_ehl):
    fluid = soft_ehl.solved.fluid_pressure
    assert fluid == pytest.approx(fluid[:, ::-1], abs=1e-4 * fluid.max())


def test_coupled_volume_is_conserved(soft_ehl):
    """At rest what flows into each cell flows out of it, in full film and in the cavity."""
    solved, sole = soft_ehl.solved, soft_ehl.sole
    gap = np.minimum(solved.film_thickness, 5e-3)
    conductance = Conductance(gap**3 / (12 * soft_ehl.viscosity), np.zeros_like(gap))
    carried = 0.5 * soft_ehl.speed * sole.spacing * soft_ehl.body.self_compliance
    operator = film_operator(
        gap,
        conductance,
        conductance,
        spacing=(sole.spacing, sole.spacing),
        speed=-0.5 * soft_ehl.speed,
        upwinding=upwinding(gap, carried, conductance.value, from_a=True),
    )
    left = np.abs(operator.imbalance(solved.fluid_pressure, solved.liquid_fraction))
    through = np.abs(operator.imbalance(np.zeros_like(gap), solved.liquid_fraction))
    assert solved.cavitated.any()
    assert left[solved.wet].sum() < 3e-3 * through[solved.wet].sum()
    assert left[solved.cavitated].sum() < 3e-3 * through[solved.wet].sum()


def test_body_is_thinner_where_the_profile_rises_from_its_plane():
    """A step of 4 mm in the height, seen along the normal of a plane at 30 deg."""
    x, y, angle = np.arange(20) * 1e-3, np.arange(6) * 1e-3, np.pi / 6
    clearance = np.repeat((np.tan(angle) * x + np.where(x > 9e-3, 4e-3, 0.0))[:, None], 6, axis=1)
    body = body_thickness(flat_map(x, y, clearance), 0.02, angle)
    assert body[0, 0] == pytest.approx(0.02)
    assert body[-1, -1] == pytest.approx(0.02 - 4e-3 * np.cos(angle))
