"""Parts of the sole solver by the values that they must have: layers, hats, means, films, steps."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import convolve2d

from small_pads import pad
from snapshot import held
from underfoot.compute.prepare import Prepared, prepare_case
from underfoot.core import Status
from underfoot.film import Conductance
from underfoot.rough_contact import ExponentialLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact import stepping
from underfoot.sole_contact._kernels.brick_elements import PLACES, shape_functions
from underfoot.sole_contact._kernels.elastic import Convolution
from underfoot.sole_contact.compliance import BoxedCompliance, compliance_within
from underfoot.sole_contact.finite_element.compliance import hats_on_cells, sole_land, sole_prisms
from underfoot.sole_contact.finite_element.elasticity import LandCompliance
from underfoot.sole_contact.finite_element.mesh import Layers
from underfoot.sole_contact.lug_inlet import REACH, _mean_behind
from underfoot.sole_contact.newton import _cycling
from underfoot.sole_contact.problem import Problem
from underfoot.sole_contact.sole_state import SolverSettings
from underfoot.sole_contact.stepping import SlidingSole

CELL = 0.5e-3


def square(side: int, *, channel: slice | None = None, depth: float = 0.0) -> SoleMap:
    """Return a flat square sole of cells with a margin of two, one channel across if any."""
    count = side + 4
    at = (np.arange(count) - (count - 1) / 2) * CELL
    inside = np.zeros((count, count), bool)
    inside[2:-2, 2:-2] = True
    land = inside.copy()
    if channel is not None:
        land[channel] = False
    half = side * CELL / 2
    ends = np.array([-half, half, half, -half, -half])
    return SoleMap(
        x=at, y=at, clearance=np.where(inside, np.where(land, 0.0, depth), np.inf), inside=inside,
        land=land, tread_depth=np.where(land, depth, 0.0), spacing=CELL,
        outline=np.column_stack([ends, np.roll(ends, 1)]),
    )  # fmt: skip


def test_layers_that_bulge_nowhere_add_up_where_they_are_stacked():
    """Poisson's ratios of 0: a uniform pressure sinks by T / E of each; the work is told."""
    told: list[tuple[str, float]] = []
    land = sole_land(
        square(8), modulus=4e6, poisson_ratio=0.0, thickness=4e-3, shoe_angle=0.0,
        midsole_modulus=1e6, midsole_thickness=10e-3, midsole_poisson_ratio=0.0,
        progress=lambda stage, share, *_: told.append((stage, share)),
    )  # fmt: skip
    rise = land.work @ np.ones(land.area.size) / land.area
    assert rise == pytest.approx(4e-3 / 4e6 + 10e-3 / 1e6, rel=1e-6)
    assert told == [("Condensing the sole to its land", share) for share in (0.0, 0.3, 0.9)]


def test_prisms_of_a_treaded_sole_on_foam(file_regression):
    """Levels lie where lug, rubber and foam end; foam is what lies above the rubber."""
    sole = square(8, channel=np.s_[5:8, :], depth=1e-3)
    said: dict[str, Any] = {}
    for foam, far in ((0.0, 2e-3), (3e-3, 2e-3), (15e-3, 2e-3), (15e-3, 4e-3)):
        made = sole_prisms(sole, Layers(5e-3, foam, 0.0), far_element=far, lug_layers=2)
        heights = np.unique(made.nodes[:, 2].round(9))
        assert heights[0] == 0.0
        assert 1e-3 in heights  # the lug's base
        assert heights[-1] == pytest.approx(5e-3 + foam)
        rubber = made.nodes[made.prisms[made.material == 0].ravel(), 2].max()
        assert rubber == pytest.approx(5e-3)
        above = heights[heights > 5e-3 + 1e-9]
        steps = {0.0: 0, 3e-3: 2, 15e-3: 3 if far == 2e-3 else 2}[foam]
        np.testing.assert_allclose(above, 5e-3 + foam * (1 + np.arange(steps)) / max(steps, 1))
        said[f"{foam} {far}"] = heights, made.land.shape, made.foot.shape, made.prisms.shape
    held(file_regression, said)


def test_hats_tell_a_plane_and_what_they_leave_out_takes_the_nearest_node():
    sole = square(4)
    ends = 1.9 * CELL * np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)])
    whole = LandCompliance(ends, np.zeros(4), np.array([(0, 1, 2), (0, 2, 3)]), np.eye(4), 0)
    plane = 3.0 + 2e3 * ends[:, 0] - 5e3 * ends[:, 1]
    told = (hats_on_cells(whole, sole) @ plane).reshape(8, 8)
    x, y = np.meshgrid(sole.x, sole.y, indexing="ij")
    np.testing.assert_allclose(told[sole.land], (3 + 2e3 * x - 5e3 * y)[sole.land])
    assert not told[~sole.land].any()
    small = LandCompliance(
        0.2 * ends + [0.55 * CELL, 0.1 * CELL], np.zeros(4), np.array([(0, 1, 2), (0, 2, 3)]),
        np.eye(4), 0,
    )  # fmt: skip
    told = (hats_on_cells(small, sole) @ np.array([1.0, 2.0, 3.0, 4.0])).reshape(8, 8)
    corners = told[2, 2], told[5, 2], told[5, 5], told[2, 5]
    assert corners == pytest.approx((1, 2, 3, 4))
    # the map may end where the land does: no cell beyond it is looked for
    few = square(4)
    cut = {name: getattr(few, name)[2:6, 2:6] for name in
           ("clearance", "inside", "land", "tread_depth")}  # fmt: skip
    tight = SoleMap(few.x[2:6], few.y[2:6], **cut, spacing=CELL, outline=few.outline)
    told = (hats_on_cells(whole, tight) @ plane).reshape(4, 4)
    np.testing.assert_allclose(told, (3 + 2e3 * x - 5e3 * y)[2:6, 2:6])


@pytest.mark.parametrize("library", ["scipy", "mkl"])
def test_a_convolution_is_the_sum_of_its_parts_by_either_library(monkeypatch, library):
    from underfoot.core.fourier import fourier_library

    try:
        fourier_library(library)
    except ImportError:
        pytest.skip("not installed")
    monkeypatch.setenv("UNDERFOOT_FFT", library)
    rng = np.random.default_rng(3)
    influence, field = rng.random((2, 9, 7)), rng.random((2, 5, 4))
    made = Convolution(influence, (5, 4))
    exact = [
        convolve2d(one, part, mode="full")[4:9, 3:7]
        for one, part in zip(field, influence, strict=True)
    ]
    np.testing.assert_allclose(made(field), exact)
    small = made.within((3, 2), np.float64)
    np.testing.assert_allclose(
        small(field[:, :3, :2]),
        [convolve2d(one[:3, :2], part[2:7, 2:5])[2:5, 1:3]
         for one, part in zip(field, influence, strict=True)],
    )  # fmt: skip


class Springs:
    """Cells that give way on their own, and a little with the sum of all."""

    self_compliance = 1e-9 * (1 + np.arange(12.0).reshape(4, 3))

    def symbol(self, wavenumber):
        return 1 / (1 + wavenumber)

    def apply(self, pressure):
        return self.self_compliance * pressure + 1e-10 * pressure.sum()


def test_a_box_of_any_body_gives_way_as_the_whole_with_nothing_beside():
    body: Any = Springs()
    box = np.s_[1:3, 0:2]
    made = compliance_within(body, box)
    assert isinstance(made, BoxedCompliance)
    pressure = np.array([[1.0, 2.0], [3.0, 5.0]])
    np.testing.assert_allclose(
        made.apply(pressure), body.self_compliance[box] * pressure + 1e-10 * 11.0
    )
    np.testing.assert_array_equal(made.self_compliance, body.self_compliance[box])
    assert made.symbol(3.0) == 0.25


def test_shapes_of_a_brick_are_one_at_their_node_and_sum_to_one_everywhere():
    assert len(PLACES) == 20
    value, _ = shape_functions(PLACES - 1.0)
    np.testing.assert_allclose(value, np.eye(20), atol=1e-12)
    points = np.random.default_rng(1).uniform(-1, 1, (6, 3))
    value, gradient = shape_functions(points)
    np.testing.assert_allclose(value.sum(axis=1), 1.0)
    np.testing.assert_allclose(value @ (PLACES - 1.0), points, atol=1e-12)
    ahead, _ = shape_functions(points + np.array([1e-6, 0, 0]))
    np.testing.assert_allclose((ahead - value) / 1e-6, gradient[:, :, 0], atol=1e-5)


class Thinning:
    """A film whose flow grows with the gap and with the speed."""

    def flow_factor(self, gap, speed):
        return Conductance(1 + 2e4 * gap + speed, np.full(gap.shape, 2e4))


class Rough(ExponentialLaw):
    """Walls between which a part of the flow is left."""

    def flow_factor(self, gap):
        return 1 - 0.4 * np.exp(-gap / 1e-5)

    def flow_factor_slope(self, gap):
        return 0.4 / 1e-5 * np.exp(-gap / 1e-5)


@pytest.mark.parametrize("film", [None, Thinning()])
@pytest.mark.parametrize("speed", [0.3, -0.3])
def test_what_flows_at_a_gap_and_how_it_grows(film, speed):
    """phi k h^3 / (12 eta), and its slope; over a step 2 h0^2 h^2 / (h0 + h) in place of h^3."""
    nothing: Any = None
    problem = Problem(
        nothing, nothing, nothing, Rough(3e6, 0.5, 1e-5), 0.02, speed, 1e-3, 1e-6,
        SolverSettings(film=film),
    )  # fmt: skip
    gap, before = np.array([3e-6, 2e-5, 2e-4]), np.array([5e-6, 1e-5, 3e-4])
    factor = (1 - 0.4 * np.exp(-gap / 1e-5)) * (1 if film is None else 1.3 + 2e4 * gap)
    made = problem.conductance(gap)
    np.testing.assert_allclose(made.value, factor * gap**3 / 0.24)
    mean = 2 * before**2 * gap**2 / (before + gap)
    stepped = problem.conductance(gap, before)
    np.testing.assert_allclose(stepped.value, factor * mean / 0.24)
    small = 1e-5 * gap
    for one, more in ((made, {}), (stepped, {"before": before})):
        high, low = (problem.conductance(gap + step, **more).value for step in (small, -small))
        np.testing.assert_allclose((high - low) / (2 * small), one.slope, rtol=1e-6)


@pytest.mark.parametrize("backward", [False, True])
def test_the_mean_behind_an_edge_reaches_half_a_millimetre(backward):
    """Cells of 0.2 mm: two and a half of the lug; one lug ends after 0.3 mm, at its last cell."""
    assert REACH == 0.5e-3
    land = np.array([[0, 1, 1, 1, 1, 0, 0, 1, 1, 0]]).repeat(2, axis=0).ravel() > 0
    area = np.full(20, 0.2)
    area[[8, 18]] = 0.1
    parent = np.arange(20) // 10
    rows: Any = SimpleNamespace(
        parent=parent, shape=(1, 2), spacing=1e-3, area=area, land=land, size=20
    )
    first = np.array([4, 8, 14] if backward else [1, 7, 11])
    means = _mean_behind(rows, first, backward=backward).toarray()
    exact = np.zeros((3, 20))
    way = -1 if backward else 1
    for row, at in ((0, first[0]), (2, first[2])):
        exact[row, at + way * np.arange(3)] = 0.4, 0.4, 0.2
    exact[1, [7, 8]] = 2 / 3, 1 / 3
    np.testing.assert_allclose(means, exact)


@pytest.mark.parametrize("period", [2, 3, 4])
def test_balances_that_come_again_are_a_cycle_once_three_of_them_do(period):
    wave = [1.0, 0.5, 0.7, 0.8][:period]
    many = wave * 4
    for count in range(1, 4 * period):
        assert _cycling(many[:count]) == (count >= period + 3)
    assert not _cycling([1 + 0.19 * one for one in many[: period + 3]])
    assert not _cycling([one * 1.06**k for k, one in enumerate(many)])


@pytest.fixture(scope="module")
def small() -> Prepared:
    changes = {"numerics.cells_along": 1, "contaminant.viscosity": "200 cP",
               "shoe.heel.length": "16 mm", "shoe.heel.width": "8 mm"}  # fmt: skip
    return prepare_case(pad(changes), 2e-3)


def sliding(parts: Prepared, **settings: Any) -> SlidingSole:
    return SlidingSole(parts.sole, parts.compliance, parts.asperities, viscosity=0.2,
                       settings=SolverSettings(**settings), shoe_angle=0.05)  # fmt: skip


def test_a_sole_that_rolls_takes_its_film_along(small):
    """What dips into the pool within a step is wet in it already."""
    sole = sliding(small, pool_depth=2e-4)
    sole.advance(5e-3, normal_force=10.0, speed=0.1)
    begun = sole.advance(5e-3, normal_force=10.0, speed=0.1)
    turned = sole.advance(1e-3, normal_force=10.0, speed=0.1, shoe_angle=0.02, longest_step=1e-3)
    assert turned.wet.sum() > begun.wet.sum() + 4


def test_a_load_that_nothing_bears_ends_where_it_was(small):
    """Not converged, at the last good instant; with no history nothing says that it rests."""
    sole = sliding(small)
    begun = sole.advance(5e-3, normal_force=10.0, speed=0.0)
    assert begun.status is Status.CONVERGED
    assert begun.speed == 0.0
    state = sole.advance(5e-3, normal_force=1e13, speed=0.0, most_steps=40)
    assert state.status is Status.NOT_CONVERGED
    assert state.time < 10e-3
    assert state.remedy
    few = sliding(small).advance(0.05, normal_force=10.0, speed=0.3, most_steps=1)
    assert few.status is Status.NOT_CONVERGED
    assert few.time < 0.05


@pytest.mark.parametrize(("viscosity", "rests"), [(0.2, False), (2e3, True)])
def test_a_film_that_never_rests_is_given_up_as_steady_where_it_hovers(
    small, monkeypatch, viscosity, rests
):
    """At the longest time ten steps must lie within a hundredth; what loses its load moves."""
    monkeypatch.setattr(stepping, "LONGEST_TIME", 0.5)
    monkeypatch.setattr(stepping, "STEADY_CHANGE", 0.0)
    sole = SlidingSole(small.sole, small.compliance, small.asperities, viscosity=viscosity,
                       settings=SolverSettings(rise_time=5e-3), shoe_angle=0.05)  # fmt: skip
    state = sole.settle(normal_force=10.0, speed=0.0)
    assert state.time == pytest.approx(0.5)
    assert (state.status is Status.CONVERGED) == rests
