"""Liquid under the sole: conserved in time, carried through cavities, under suction."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.core import InputError, Status
from underfoot.film import Conductance, Film, film_operator, film_pressure, upwinding
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.shoe import Facet, Heel, Tread, heel_map
from underfoot.sole_contact.compliance import half_space_compliance, layered_compliance
from underfoot.sole_contact.march import GROWTH, March
from underfoot.sole_contact.solver import SolverSettings, solve_sliding

MODULUS, TEN = 5e6, math.radians(10)


def solved_heel(viscosity=0.1, speed=0.5, tread=None, watch=None, spacing=2e-3, **settings):
    heel = Heel(
        length=0.06,
        width=0.06,
        rear_radius=0.028,
        outsole_thickness=0.025,
        profile=Facet(TEN, 0.03),
        edge_radius=0.002,
        tread=tread,
    )
    sole = heel_map(heel, shoe_angle=TEN, spacing=spacing)
    body = layered_compliance(sole, modulus=MODULUS, poisson_ratio=0.49, thickness=0.025)
    law = ExponentialLaw(MODULUS, 0.5, 12e-6)
    solved = solve_sliding(
        sole,
        body,
        law,
        viscosity=viscosity,
        speed=speed,
        normal_force=400.0,
        settings=SolverSettings(**settings),
        watch=watch,
    )
    return SimpleNamespace(solved=solved, body=body, law=law)


def inner(mask):
    """Cells whose four neighbours lie in the mask too."""
    result = np.zeros_like(mask)
    result[1:-1, 1:-1] = (
        mask[1:-1, 1:-1] & mask[2:, 1:-1] & mask[:-2, 1:-1] & mask[1:-1, 2:] & mask[1:-1, :-2]
    )
    return result


LUGS = Tread("grid", lug_width=10e-3, channel_width=5e-3, depth=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "tread"), [(0.5, None), (-0.5, None), (0.5, LUGS)])
def test_each_cell_keeps_its_liquid_in_every_step(speed, tread):
    """What a cell gains in a step has come through its faces, in full film and in cavities."""
    viscosity, states = 0.02, []
    run = solved_heel(viscosity, speed, tread, watch=states.append, spacing=1e-3, tolerance=1e-6)
    assert run.solved.status is Status.CONVERGED
    spacing = run.solved.spacing
    judged = np.zeros(2, dtype=int)
    for earlier, before, after in zip(states, states[1:], states[2:], strict=False):
        gap, gaps = after.film_thickness, (earlier.film_thickness, before.film_thickness)
        # at the pool's depth the state does not tell the gap, which upwinding takes two cells from
        known = after.wet & before.wet & (np.maximum(gap, np.maximum(*gaps)) < 0.59e-3)
        cells = inner(inner(known))
        duration = after.time - before.time

        start = np.maximum(before.film_thickness, 2e-7)
        # faces lean by the gap that goes on as in the last step
        share = min(duration / (before.time - earlier.time), GROWTH)
        ahead = np.maximum(gaps[1] + share * (gaps[1] - gaps[0]), 2e-7)

        def conductance(gap, start):
            mean = 2 * start**2 * gap**2 / (start + gap)
            value = run.law.flow_factor(gap) * mean / (12 * viscosity)
            return Conductance(value, np.zeros_like(value))

        carried = 0.5 * abs(speed) * spacing * run.body.self_compliance
        operator = film_operator(
            np.maximum(gap, 2e-7),
            conductance(np.maximum(gap, 2e-7), start),
            conductance(np.maximum(gap, 2e-7), start),
            spacing=(spacing, spacing),
            speed=-0.5 * speed,
            storage=spacing**2 / duration,
            upwinding=upwinding(ahead, carried, conductance(ahead, ahead).value, from_a=speed > 0),
        )
        content = before.liquid_fraction * start
        left = operator.imbalance(after.fluid_pressure, after.liquid_fraction, content)
        moved = np.abs(operator.imbalance(np.zeros_like(gap), after.liquid_fraction, content))
        for kind, which in enumerate((cells & ~after.cavitated, cells & after.cavitated)):
            judged[kind] += which.sum()
            assert np.abs(left[which]).sum() < 1e-3 * moved[after.wet].sum()
    assert (judged > 100).all()


def test_liquid_fraction_is_complementary_to_the_pressure():
    solved = solved_heel().solved
    assert ((solved.liquid_fraction > 0) & (solved.liquid_fraction <= 1)).all()
    assert (solved.liquid_fraction[~solved.cavitated] == 1).all()
    assert solved.liquid_fraction[solved.cavitated].min() < 0.9
    assert (solved.fluid_pressure[solved.liquid_fraction < 1] == 0).all()


def wavy_slider(cells=48, length=0.01):
    """A nearly rigid slider whose waves rupture the film and let it form again."""
    x = (np.arange(cells) - cells / 2) * (length / cells)
    y = np.arange(9) * (length / cells)
    clearance = (
        8e-6 * (1 - np.cos(6 * np.pi * x / length))[:, None] + 5e-5 * (x / length)[:, None] ** 2
    )
    clearance = np.repeat(clearance - clearance.min(), 9, axis=1)
    everywhere = np.ones(clearance.shape, bool)
    return SimpleNamespace(
        x=x, y=y, clearance=clearance, inside=everywhere, land=everywhere,
        cut=None, slits=None, joint=None, cells=None, columns=1,
        tread_depth=np.zeros_like(clearance), spacing=length / cells,
    )  # fmt: skip


@pytest.mark.parametrize("suction", [0.0, 2e4])
def test_a_rigid_sole_has_the_film_of_given_walls(suction):
    """Coupled and rigid solution of one operator agree, across rupture and reformation.

    A cavity under suction is one at 0 beside a rim under pressure.
    """
    sole = wavy_slider()
    body = half_space_compliance(
        sole.clearance.shape, sole.spacing, modulus=1e12, poisson_ratio=0.0
    )
    solved = solve_sliding(
        sole,
        body,
        ExponentialLaw(1e6, 0.0, 1e-8),
        viscosity=0.05,
        speed=0.5,
        normal_force=2.0,
        settings=SolverSettings(
            pool_depth=1.0, start_film=2e-5, end_time=None, cavity_pressure=-suction
        ),
    )
    assert solved.status is Status.CONVERGED
    oil = {"viscosity": 0.05, "speed": 0.5, "mask": solved.wet}
    rigid = film_pressure(Film(solved.film_thickness, sole.spacing, rim_pressure=suction, **oil))
    line = rigid.cavitated[:, 4]
    assert np.count_nonzero(np.diff(line.astype(int)) == 1) >= 2  # more than one cavity
    peak = rigid.pressure.max()
    assert solved.fluid_pressure + suction == pytest.approx(rigid.pressure, abs=0.01 * peak)
    both = solved.cavitated & rigid.cavitated
    assert np.count_nonzero(solved.cavitated ^ rigid.cavitated) < 0.02 * line.size * 9
    assert solved.liquid_fraction[both] == pytest.approx(rigid.fraction[both], abs=0.01)


def test_suction_presses_the_contact():
    """A film that bears tension where it has ruptured adds that load to the contact."""
    plain, sucked = (solved_heel(0.02, cavity_pressure=-value).solved for value in (0.0, 5e4))
    assert sucked.status is Status.CONVERGED
    assert (sucked.fluid_pressure >= -5e4).all()
    assert sucked.fluid_pressure[sucked.cavitated] == pytest.approx(-5e4)
    assert (sucked.fluid_pressure[~sucked.wet] == 0).all()
    assert sucked.fluid_load + sucked.contact_load == pytest.approx(400.0, rel=2e-4)
    assert sucked.contact_load > plain.contact_load + 1.0
    with pytest.raises(InputError, match="cavity_pressure"):
        solved_heel(cavity_pressure=1.0)


def test_a_film_deeper_than_the_pool_keeps_its_liquid():
    gap = np.array([5e-5, 3e-4, 3e-4, 2e-2])
    march = SimpleNamespace(
        state=SimpleNamespace(gap=gap, fraction=np.array([1.0, 1.0, 0.5, 1.0])),
        film=np.array([True, True, True, False]),
        problem=SimpleNamespace(largest_gap=1e-2),
        _pool_depth=1e-4,
    )
    # film: what it holds; beyond it the pool as it lay
    assert March._content(march) == pytest.approx([5e-5, 3e-4, 1.5e-4, 1e-4])
