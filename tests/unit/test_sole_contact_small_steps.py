"""Costs and steps of the sole solver by their values: what is refused, how long a step may be."""

import math
import re
from dataclasses import astuple
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.shoe import Flat, Heel, SoleMap, heel_map
from underfoot.sole_contact._kernels.splines import Splines
from underfoot.sole_contact.compliance import layered_compliance
from underfoot.sole_contact.cost import AT_REST, refuse_too_large, solution_cost
from underfoot.sole_contact.long_waves import (
    ALIKE,
    FAINT,
    SIDE,
    WAVE,
    _compliance,
    net_over,
    splines_over,
)
from underfoot.sole_contact.march import Counts, _calm_start, _film_mask
from underfoot.sole_contact.problem import State
from underfoot.sole_contact.solver import longest_step, passing_time


def test_a_finer_grid_costs_more_than_its_cells_and_never_less_than_a_program_at_rest():
    coarse, fine = solution_cost(3.6e-3, 1e-3), solution_cost(3.6e-3, 0.5e-3)
    assert coarse.cells == 3600
    assert fine.cells == 4 * coarse.cells
    assert AT_REST < coarse.memory < fine.memory < 4 * coarse.memory
    for few, many in zip(coarse.seconds, fine.seconds, strict=True):
        assert many / few == pytest.approx(4**1.2)
    assert coarse.seconds[0] < coarse.seconds[1]


@pytest.mark.parametrize("most", [200e6, 600e6])
def test_the_spacing_that_is_advised_is_allowed_and_hardly_coarser_than_it_must_be(most):
    fine = solution_cost(0.02, 0.2e-3)
    with pytest.raises(InputError) as told:
        refuse_too_large(fine, most_memory=most, where="numerics.grid_spacing", spacing=0.2e-3)
    spacing = 1e-3 * float(re.search(r"spacing of ([\d.]+) mm", str(told.value))[1])
    refuse_too_large(solution_cost(0.02, spacing), most_memory=most, where="", spacing=spacing)
    with pytest.raises(InputError):
        refuse_too_large(
            solution_cost(0.02, 0.8 * spacing), most_memory=most, where="", spacing=0.8 * spacing
        )


def striped(*lengths: int) -> SoleMap:
    """Return three rows across of land of so many cells of 1 mm each, one cell apart."""
    row = np.concatenate([[False], *([*[True] * length, False] for length in lengths)])
    x, y = 1e-3 * np.arange(row.size), 1e-3 * np.arange(5)
    land = np.zeros((row.size, 5), bool)
    land[:, 1:4] = row[:, None]
    inside = np.zeros_like(land)
    inside[:, 1:4] = True
    clear = np.where(land, 0.0, 1e-3)
    return SoleMap(x, y, clear, inside, land, np.zeros(land.shape), 1e-3, np.zeros((4, 2)))


def test_the_floor_passes_a_piece_of_land_in_its_length_over_the_speed():
    assert passing_time(striped(4), 0.5) == pytest.approx(4e-3 / 0.5)
    # of the cells of a long and a short piece: 6 of 8 lie in 6 mm, 2 in 2 mm
    assert passing_time(striped(6, 2), -0.5) == pytest.approx((6 * 6 + 2 * 2) / 8 * 1e-3 / 0.5)
    assert passing_time(striped(4), 0.0) == math.inf


def test_a_step_is_no_longer_than_its_stage_and_no_finer_than_its_eighth():
    stage = 0.08
    assert longest_step(stage, math.inf) == stage
    assert longest_step(stage, 1e-9) == pytest.approx(stage / 8)
    assert longest_step(stage, 0.5 * stage / 6) == pytest.approx(0.5 * stage)


@pytest.mark.parametrize(("cells", "count"), [(4, 1), (7, 1), (8, 2), (12, 2), (58, 8)])
def test_waves_share_the_land_and_have_no_kink(cells, count):
    """Splines of second order: they sum to one, lines are exact, parabolas off by one number."""
    sole = striped(cells + 1)
    splines = splines_over(sole, sole.land)
    assert WAVE * SIDE == 8e-3
    assert splines.squares[0] == count
    waves = splines.on(sole.x, sole.y, sole.land).toarray()
    land = sole.land.ravel()
    np.testing.assert_allclose(waves[land].sum(axis=1), 1.0)
    assert not waves[~land].any()
    side = splines.sides[0]
    middles = splines.start[0] + side * (np.arange(count + 2) - 0.5)
    middles = np.repeat(middles, splines.squares[1] + 2)
    x = np.repeat(sole.x, sole.y.size)[land]
    np.testing.assert_allclose((waves @ middles)[land], x, atol=1e-12)
    np.testing.assert_allclose((waves @ middles**2)[land] - x**2, side**2 / 4, rtol=1e-9)


def test_a_wave_overlaps_itself_by_its_size():
    fine = 0.05e-3 * (np.arange(1000) + 0.5)
    splines = Splines((0.0, 0.0), (10e-3, 10e-3), (5, 5))
    along = splines.at(fine, np.full(1000, 25e-3)).toarray().reshape(1000, 7, 7)[:, 3, 3]
    middle = splines.at(np.full(1, 25e-3), np.full(1, 25e-3)).toarray().reshape(7, 7)[3, 3]
    one = (along**2).sum() * 0.05e-3 / middle
    assert one**2 == pytest.approx(splines.size, rel=1e-5)


def test_columns_of_a_net_end_at_the_rim():
    """A disc: within 2 % of the radius but at its ends, the area within 1 %."""
    radius = 30e-3
    centres = 1e-3 * np.arange(-32, 33)
    inside = np.hypot(centres[:, None], centres) < radius
    disc = cast(
        Any,
        SimpleNamespace(
            x=centres, y=centres, inside=inside, spacing=1e-3, whole=None,
        ),
    )  # fmt: skip
    net = net_over(disc, splines_over(disc, inside))
    rim = np.sqrt(np.maximum(radius**2 - net.x**2, 0.0))
    np.testing.assert_allclose(net.high[2:-2], rim[2:-2], atol=0.02 * radius)
    np.testing.assert_allclose(net.low, -net.high, atol=1e-9)
    ends, middles = (net.high - net.low)[::2], (net.high - net.low)[1::2]
    area = (net.x[2] - net.x[0]) / 6 * (ends[:-1] + 4 * middles + ends[1:]).sum()
    assert area == pytest.approx(np.pi * radius**2, rel=0.01)


def test_nothing_is_counted_before_the_first_step():
    assert set(astuple(Counts())) == {0}


def test_rubber_that_keeps_its_volume_has_a_compliance():
    """At Poisson's ratio 0.5 the elements of its long waves take 0.499: within 3 % of 0.499."""
    sole = heel_map(
        Heel(length=40e-3, width=40e-3, rear_radius=10e-3, outsole_thickness=15e-3, profile=Flat()),
        shoe_angle=0.0,
        spacing=1e-3,
    )
    pressure = np.where(sole.inside, 1e5, 0.0)
    rise, near = (
        layered_compliance(
            sole, modulus=4e6, poisson_ratio=ratio, thickness=15e-3, shoe_angle=0.0
        ).apply(pressure)[sole.inside]
        for ratio in (0.5, 0.499)
    )
    assert near.min() > 0
    assert np.abs(rise / near - 1).max() < 0.03


@pytest.mark.parametrize("slope", [0.5, -0.5, -1.0, -2.0, -4.0])
def test_steps_that_swing_end_where_they_start(slope):
    """Each of them overshoots: with half a step back those of slope -4 went round in circles."""
    rest = np.array([0.0, 3e-5, 2.0])

    def state(values):
        return State(values, 0.0, values, values, values, values > 0, np.ones(3))

    starts = [state(np.array([1e-5, 1e-5, 1e5])), state(np.array([2e-5, 4e-5, -1e5]))]
    steps = [(start, state(rest + slope * (start.gap - rest))) for start in starts]
    for _ in range(40):
        start = _calm_start(*steps[-2:])
        steps.append((start, state(rest + slope * (start.gap - rest))))
    for name in ("pressure", "gap", "fluid"):
        np.testing.assert_allclose(getattr(steps[-1][1], name), rest, atol=1e-4)


def test_a_pool_that_reaches_no_cell_wets_those_that_are_lowest():
    clearance = np.array([1e-3, 1.01e-3, 1.03e-3, 2e-3, 1.0])
    at_rim = np.zeros(5, dtype=bool)
    problem = SimpleNamespace(
        clearance=clearance, drained=None, cells=SimpleNamespace(at_rim=at_rim)
    )
    wet = _film_mask(cast(Any, problem), clearance, 1e-4, None)
    assert wet.tolist() == [True, True, False, False, False]
    reached = _film_mask(cast(Any, problem), clearance - 0.95e-3, 1e-4, at_rim)
    assert reached.tolist() == [True, True, True, False, False]


@pytest.mark.parametrize("left", [1.0, 0.5, 0.0])
def test_a_wave_that_is_cut_off_fades_by_what_is_missing_of_it(left):
    """1 / (its overlap, a tenth of what is missing and a thousandth of the whole)^2 of its work."""
    size = 8e-6
    (rise,) = _compliance(np.eye(1), np.array([[left * size]]), size).ravel()
    assert rise == pytest.approx(1 / (size * (left + FAINT * (1 - left) + ALIKE)) ** 2)
