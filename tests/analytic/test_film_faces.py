"""The balance of a film on faces: its derivatives are those of the balance itself."""

import numpy as np
import pytest

from underfoot.film.face_operator import Conductance, Faces, Inlet, Upwinding, face_operator
from underfoot.film.operator import Pattern, series_conductance
from underfoot.film.pressure import _finer, _halve_field

COUNT, VISCOSITY, SPACING = 6, 0.1, 1e-3
"""Two rows of three cells."""


def faces(random):
    along = np.array([0, 1, 3, 4]), np.array([1, 2, 4, 5])
    across = np.array([0, 1, 2]), np.array([3, 4, 5])
    return Faces(
        COUNT, COUNT, SPACING, *along, random.uniform(0.5, 1.5, 4), random.uniform(0.2, 0.8, 4),
        random.uniform(0.2, 0.8, (2, 4)), random.uniform(-5e-6, 5e-6, (2, 4)), *across,
        random.uniform(0.3, 1.0, 3), random.uniform(0.3, 0.7, 3),
    )  # fmt: skip


def conductance(gap, before):
    return Conductance(gap**3 / (12 * VISCOSITY), gap**2 / (4 * VISCOSITY))


@pytest.mark.parametrize("speed", [0.3, -0.3])
@pytest.mark.parametrize("edges", [False, True])
def test_the_jacobian_of_a_balance_on_faces_is_its_derivative(speed, edges):
    random = np.random.default_rng(46)
    cells = faces(random)
    gap = random.uniform(3e-5, 9e-5, COUNT)
    pressure, fraction = random.uniform(0, 1e4, COUNT), random.uniform(0.4, 1.0, COUNT)
    content, storage = random.uniform(1e-5, 2e-5, COUNT), 2e-4
    given = {}
    if edges:
        given["upstream"] = Upwinding(random.uniform(0, 1, 4), random.uniform(-5e-6, 5e-6, 4))
        given["inlet"] = Inlet(
            random.uniform(1e-5, 4e-5, 4), random.uniform(0, 1, 4), random.uniform(0, 1, 4)
        )

    def operator(gap):
        return face_operator(
            cells, gap, conductance, before=None, limits=(1e-9, 1.0), speed=speed,
            storage=storage, **given,
        )  # fmt: skip

    def derivative(balance, at, step):
        return np.transpose(
            [(balance(at + one) - balance(at - one)) / (2 * step) for one in step * np.eye(COUNT)]
        )

    now = operator(gap)
    for shown, balance, at, step in (
        (now.by_gap(pressure, fraction),
         lambda h: operator(h).imbalance(pressure, fraction, content), gap, 1e-9),
        (now.by_pressure, lambda p: now.imbalance(p, fraction, content), pressure, 1.0),
        (now.by_fraction, lambda s: now.imbalance(pressure, s, content), fraction, 1e-3),
    ):  # fmt: skip
        expected = derivative(balance, at, step)
        assert shown.matrix().toarray() == pytest.approx(
            expected, rel=1e-6, abs=1e-7 * np.abs(expected).max()
        )


def test_a_pair_of_blocks_stands_side_by_side():
    cells = faces(np.random.default_rng(1))
    entries = np.arange(1.0, 1 + cells.layout[0].size)
    both = cells.pair.matrix(np.concatenate([entries, -entries])).toarray()
    single = cells.sparse.matrix(entries).toarray()
    assert np.array_equal(both, np.hstack([single, -single]))
    film = Pattern(np.array([[True, True, False], [True, True, True]]))
    entries = np.arange(1.0, 26.0).reshape(5, 5)
    both = film.pair.matrix(np.concatenate([entries, -entries])).toarray()
    single = film.matrix(entries).toarray()
    assert np.array_equal(both, np.hstack([single, -single]))


def test_a_coarse_field_holds_the_means_of_its_cells():
    field = np.arange(15.0).reshape(5, 3) ** 2
    along, both = _halve_field(field, (0,)), _halve_field(field, (0, 1))
    halves = (field[0] + field[1]) / 2, (field[2] + field[3]) / 2, field[4]
    assert along == pytest.approx(np.array(halves))
    assert both == pytest.approx(np.column_stack([(along[:, 0] + along[:, 1]) / 2, along[:, 2]]))


@pytest.mark.parametrize("shape", [(5, 3), (5, 6), (10, 3), (9, 5), (10, 6)])
def test_a_coarse_field_is_linear_between_its_cells_and_level_in_the_half_at_a_wall(shape):
    """A coarse cell has the middles of its halves a quarter of it before and after its own."""
    coarse = 1.0 + 2.0 * np.arange(5)[:, None] - 0.5 * np.arange(3)

    def places(count, size):
        if count == size:
            return np.arange(size)
        return np.clip((np.arange(count) - 0.5) / 2, 0, size - 1)

    x, y = places(shape[0], 5), places(shape[1], 3)
    assert _finer(coarse, shape) == pytest.approx(1.0 + 2.0 * x[:, None] - 0.5 * y)


def test_two_halves_in_series_conduct_as_their_harmonic_mean():
    a, b, step = np.array([2e-4, 5e-5]), np.array([1e-4, 3e-4]), 1e-9

    def value(a, b, *place):
        return series_conductance(a**3, b**3, 3 * a**2, 3 * b**2, *place)

    found = value(a, b)
    assert found.value == pytest.approx(2 / (a**-3 + b**-3))
    for place in ((), (0.3,)):
        slopes = value(a, b, *place)[1:]
        moved = (value(a + step, b, *place), value(a - step, b, *place)), (
            value(a, b + step, *place), value(a, b - step, *place),
        )  # fmt: skip
        for slope, (up, down) in zip(slopes, moved, strict=True):
            assert slope == pytest.approx((up.value - down.value) / (2 * step), rel=1e-6)
