"""A sole converges at any speed, load and viscosity that a foot meets, treaded like plain."""

import dataclasses
import functools
import math

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from underfoot.core import Status
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.shoe import Facet, Heel, Tread, heel_map
from underfoot.sole_contact.compliance import layered_compliance
from underfoot.sole_contact.solver import SolverSettings, solve_sliding

MODULUS = 5e6


@functools.cache
def body(treaded):
    heel = Heel(
        length=0.06,
        width=0.06,
        rear_radius=0.028,
        outsole_thickness=0.025,
        profile=Facet(math.radians(10), 0.03),
        edge_radius=0.002,
        tread=Tread("grid", lug_width=8e-3, channel_width=4e-3, depth=2e-3) if treaded else None,
    )
    sole = heel_map(heel, shoe_angle=math.radians(10), spacing=2e-3)
    return sole, layered_compliance(sole, modulus=MODULUS, poisson_ratio=0.49, thickness=0.025)


@pytest.mark.slow
@pytest.mark.parametrize("treaded", [False, True])
@settings(max_examples=8, deadline=None, phases=[Phase.explicit, Phase.generate])
@given(
    speed=st.floats(-2.0, math.log10(3)),
    force=st.floats(1.0, math.log10(2000)),
    viscosity=st.floats(math.log10(5e-4), math.log10(2)),
    back=st.booleans(),
)
def test_any_speed_load_and_viscosity(treaded, speed, force, viscosity, back):
    sole, compliance = body(treaded)
    load = 10**force
    solved = solve_sliding(
        sole,
        compliance,
        ExponentialLaw(MODULUS, 0.5, 10e-6),
        viscosity=10**viscosity,
        speed=-(10**speed) if back else 10**speed,
        normal_force=load,
    )
    assert solved.status is Status.CONVERGED
    assert solved.fluid_load + solved.contact_load == pytest.approx(load, rel=2e-3)
    assert solved.counts.time_steps < 100
    assert solved.counts.rejected < 20


@pytest.mark.slow
def test_time_steps_of_a_tread_are_fine_enough_wherever_its_lugs_lie():
    """Mean load on the film over positions within 5 % of that of steps four times finer."""
    heel = Heel(
        length=0.06,
        width=0.04,
        rear_radius=0.02,
        outsole_thickness=0.025,
        profile=Facet(0.17, 0.03),
    )
    loads = []
    for resolution in (8.0, 32.0):
        for share in range(4):
            shift = (share * 7.5e-3 / 4, 0.0)
            lugs = Tread("grid", lug_width=5e-3, channel_width=2.5e-3, depth=3e-3, offset=shift)
            sole = heel_map(dataclasses.replace(heel, tread=lugs), shoe_angle=0.17, spacing=1e-3)
            solved = solve_sliding(
                sole,
                layered_compliance(sole, modulus=MODULUS, poisson_ratio=0.49, thickness=0.025),
                ExponentialLaw(MODULUS, 0.5, 10e-6),
                viscosity=0.219,
                speed=0.7,
                normal_force=300.0,
                settings=SolverSettings(time_resolution=resolution, end_time=0.12),
            )
            loads.append(solved.fluid_load)
    default, fine = sum(loads[:4]), sum(loads[4:])
    assert default == pytest.approx(fine, rel=0.05)
