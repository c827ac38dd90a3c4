"""Finite elements of a sole: condensation, single blocks, dry contact, the compliance they give."""

import numpy as np
import pytest

from finite_element_dry_contact import dry_contact
from underfoot.core import Cache, InputError
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact._kernels.elastic import block_compression
from underfoot.sole_contact.compliance import layered_compliance
from underfoot.sole_contact.finite_element import finite_element_compliance, sole_land
from underfoot.sole_contact.solver import solve_sliding

MODULUS, RATIO, CELL = 4e6, 0.49, 0.5e-3


def block(side, lug=0, channel=0, depth=0.0, crown=np.inf):
    """Square sole of ``side`` cells, lugs and channels in cells, bulged by a radius."""
    count = side + 4
    at = (np.arange(count) - (count - 1) / 2) * CELL
    inside = np.zeros((count, count), bool)
    inside[2:-2, 2:-2] = True
    row = np.zeros(count, bool)
    row[2:-2] = np.mod(np.arange(side), lug + channel) < lug if lug else True
    land = row[:, None] & row[None, :]
    clearance = (at[:, None] ** 2 + at[None, :] ** 2) / (2 * crown)
    clearance = np.where(land, clearance, clearance + depth)
    half = side * CELL / 2
    ends = np.array([-half, half, half, -half, -half])
    return SoleMap(
        x=at,
        y=at,
        clearance=np.where(inside, clearance - clearance[inside].min(), np.inf),
        inside=inside,
        land=land,
        tread_depth=np.where(land, depth, 0.0),
        spacing=CELL,
        outline=np.column_stack([ends, np.roll(ends, 1)]),
    )


@pytest.mark.parametrize("height", [1.5e-3, 3e-3])
def test_block_compression_is_that_of_finite_elements(height):
    """Single lug of 5 mm: mean within 3 %, and no free column gives way more."""
    sole = block(10)
    sides = {"element": 0.7e-3, "far_element": 0.7e-3}
    land = sole_land(
        sole, modulus=MODULUS, poisson_ratio=RATIO, thickness=height, shoe_angle=0.0, **sides
    )
    mean = land.work.sum() / land.area.sum()
    assert land.area.sum() == pytest.approx(25e-6, rel=1e-9)
    closed = block_compression(sole.land, CELL, np.array(height), MODULUS, RATIO)
    assert closed[sole.land].mean() == pytest.approx(mean, rel=0.03)
    assert mean < height / MODULUS
    assert np.linalg.eigvalsh(land.work).min() > 0


def test_a_sole_free_to_bulge_nowhere_is_confined():
    """For nu = 0 sides do not matter: a uniform pressure compresses by p T / E."""
    land = sole_land(block(10), modulus=MODULUS, poisson_ratio=0.0, thickness=4e-3, shoe_angle=0.0)
    rise = land.work @ np.ones(land.area.size) / land.area
    assert rise == pytest.approx(4e-3 / MODULUS, rel=1e-6)


@pytest.fixture(scope="module")
def treaded():
    sole = block(24, lug=10, channel=4, depth=2e-3, crown=0.15)
    given = {"modulus": MODULUS, "poisson_ratio": RATIO, "thickness": 8e-3, "shoe_angle": 0.0}
    fine = sole_land(sole, **given, element=0.9e-3, far_element=1.5e-3, lug_layers=2)
    return sole, given, fine


def test_dry_contact_is_unilateral_and_carries_the_load(treaded):
    contact = dry_contact(treaded[2], 20.0)
    assert contact.pressure.min() >= 0
    assert contact.gap.min() > -1e-12
    assert np.abs(contact.pressure * contact.gap).max() < 1e-9 * contact.pressure.max()
    assert contact.piece_loads.sum() == pytest.approx(20.0)
    # four equal lugs (the mesh is not exactly symmetric)
    assert contact.piece_loads == pytest.approx(5.0, rel=0.01)


def test_treaded_sole_by_solver_and_by_finite_elements(treaded):
    """Dry contact of four lugs: the solver against finer direct elements, solved on their own.

    The layers are 14 % too stiff on so small a sole (lugs stand on rubber, not on a rigid base);
    on a heel of 60 mm they are within 1 % (docs/physics/sole_compliance.md).
    """
    sole, given, fine = treaded
    law = ExponentialLaw(MODULUS, RATIO, 6e-6)
    direct = dry_contact(fine, 20.0, law)
    for body, close in (
        (finite_element_compliance(sole, **given), 0.03),
        (layered_compliance(sole, **given), 0.16),
    ):
        solved = solve_sliding(sole, body, law, viscosity=None, speed=0.1, normal_force=20.0)
        area = (solved.contact_pressure > 1e4).sum() * CELL**2
        assert solved.approach == pytest.approx(direct.approach, rel=close)
        assert area == pytest.approx(direct.contact_area(), rel=0.03)
        quarter = solved.contact_pressure[:14, :14].sum() * CELL**2
        assert quarter == pytest.approx(direct.piece_loads.min(), rel=0.03)


def test_finite_element_compliance_is_reciprocal_and_positive(treaded):
    sole, given, _ = treaded
    body = finite_element_compliance(sole, **given)
    rng = np.random.default_rng(2)
    one, two = rng.standard_normal((2, *sole.land.shape)) * sole.land
    assert (one * body.apply(two)).sum() == pytest.approx((two * body.apply(one)).sum())
    for _ in range(20):
        noise = rng.standard_normal(sole.land.shape) * sole.land
        assert (noise * body.apply(noise)).sum() > 0
    assert (body.self_compliance > 0).all()
    point = np.zeros(sole.land.shape)
    point[6, 6] = 1.0
    assert body.apply(point)[6, 6] == pytest.approx(body.self_compliance[6, 6], rel=0.3)


def test_the_land_is_kept_in_the_cache(tmp_path, treaded):
    sole, given, _ = treaded
    cache = Cache("sole_compliance", tmp_path)
    first = sole_land(sole, **given, cache=cache)
    stiffer = sole_land(sole, **(given | {"modulus": 2 * MODULUS}), cache=cache)
    assert len(list(cache.folder.iterdir())) == 1
    assert stiffer.work == pytest.approx(first.work / 2)


def test_locking_and_thin_soles_are_refused():
    with pytest.raises(InputError, match="lock"):
        sole_land(block(10), modulus=MODULUS, poisson_ratio=0.5, thickness=4e-3, shoe_angle=0.0)
    deep = block(24, lug=10, channel=4, depth=4e-3)
    with pytest.raises(InputError, match="through"):
        sole_land(deep, modulus=MODULUS, poisson_ratio=0.49, thickness=4e-3, shoe_angle=0.0)
