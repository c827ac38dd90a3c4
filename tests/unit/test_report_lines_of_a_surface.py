"""Parts of the surface that pages draw: chains of places, lines through them, levels, triangles."""

import numpy as np
import pytest

from underfoot.report import surface_mesh as made
from underfoot.report.surface_mesh import _Grid


def grid_of(height, land=None, side=1.0):
    """A grid with its empty rim."""
    height = np.asarray(height, float)
    land = np.isfinite(height) if land is None else np.asarray(land, bool)
    return _Grid.of(np.pad(height, 1, constant_values=np.nan), np.pad(land, 1), side)


def test_chains_run_between_branchings_and_back_to_where_a_ring_begins():
    #  0 - 1 - 2 - 3   with 2 - 4 - 5, and the ring 6 7 8
    links = np.array([[0, 1], [2, 1], [2, 3], [4, 2], [4, 5], [6, 7], [7, 8], [8, 6]])
    chains = made._chains(links, 9)
    ends = {tuple(sorted((tuple(chain), tuple(chain[::-1])))[0]) for chain in chains}
    assert len(chains) == 4
    assert {chain for chain in ends if 6 not in chain} == {(0, 1, 2), (2, 3), (2, 4, 5)}
    (ring,) = [chain for chain in chains if 6 in chain]
    assert ring[0] == ring[-1]
    assert sorted(ring[:-1]) == [6, 7, 8]
    between = np.array([[0, 1], [1, 2], [0, 3], [3, 2], [0, 4]])  # two ways from 0 to 2, one off
    several = sorted(tuple(chain) for chain in made._chains(between, 5))
    assert sorted(len(chain) for chain in several) == [2, 5]


def test_the_fewest_corners_are_kept_of_a_path():
    bent = np.array([[0, 0], [1, 0.3], [2, -0.3], [3, 0], [3.2, 1], [3, 2], [3, 3]], float)
    assert made._corners_of(bent, 0.75).tolist() == [0, 3, 6]
    assert made._corners_of(bent, 0.29).tolist()[:2] == [0, 1]
    assert made._corners_of(bent, 5.0).tolist() == [0, 6]
    ring = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], float)
    assert made._corners_of(ring, 0.5).tolist() == [0, 1, 2, 3, 4]
    assert made._corners_of(bent[:2], 0.0).tolist() == [0, 1]


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.2, 2.2])
def test_a_line_is_fitted_through_the_places_between_its_ends(angle):
    rng = np.random.default_rng(1)
    way, across = (
        np.array([np.cos(angle), np.sin(angle)]),
        np.array([-np.sin(angle), np.cos(angle)]),
    )
    along = np.arange(40.0)
    noise = rng.normal(scale=0.05, size=40)
    path = 3 + along[:, None] * way + noise[:, None] * across
    path = np.concatenate([path, path[-1] + np.arange(1, 3)[:, None] * across])
    normal, offset = made._fit_lines(path, np.array([0, 39, 41]))
    inner = path[1:39]
    centred = inner - inner.mean(axis=0)
    exact = np.linalg.svd(centred)[2][1]
    assert abs(normal[0] @ exact) == pytest.approx(1, abs=1e-9)
    assert offset[0] == pytest.approx(normal[0] @ inner.mean(axis=0))
    # a short one is that through its ends
    assert abs(normal[1] @ across) == pytest.approx(0, abs=1e-9)
    assert offset[1] == pytest.approx(normal[1] @ path[39])


def test_a_staircase_becomes_the_line_that_it_stands_for_with_its_corner():
    """Middles between cells of two lines at a right angle, turned by 0.3 rad."""
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    corner = np.array([20.0, 10.0])
    one = corner + np.linspace(-18, 0, 37)[:, None] * turn[:, 0]
    two = corner + np.linspace(0, 18, 37)[1:, None] * turn[:, 1]
    path = np.concatenate([one, two])
    path = np.round(2 * path) / 2  # half cells
    places = path.copy()
    lines = made._straighten_chain(places, list(range(len(path))))
    assert len(lines) == 2
    met = places[lines[0, 1]]
    assert np.hypot(*(met - corner)) < 0.35
    assert lines[0, 0] == 0
    assert lines[1, 1] == len(path) - 1
    assert (places[0] == path[0]).all()


def test_lines_of_a_ring_meet_where_it_is_closed_too():
    square = []
    corners = np.array([[0, 0], [20, 0], [20, 20], [0, 20]], float)
    for a, b in zip(corners, np.roll(corners, -1, 0), strict=True):
        square += [a + (b - a) * share for share in np.linspace(0, 1, 20, endpoint=False)]
    places = np.array(square)
    places[[0, 20, 40, 60]] += [[0.4, 0.4], [-0.4, 0.4], [-0.4, -0.4], [0.4, -0.4]]  # cut corners
    chain = [*range(80), 0]
    lines = made._straighten_chain(places, chain)
    met = places[np.unique(lines)]
    off = np.abs(met[:, None] - corners).max(axis=2).min(axis=0)
    assert off.max() < 0.1
    assert (lines[:-1, 1] == lines[1:, 0]).all()
    assert lines[0, 0] == lines[-1, 1]


@pytest.mark.parametrize("scale", [1.0, 3.0])
def test_lines_meet_in_a_corner_and_those_that_hardly_turn_do_not(scale):
    path = scale * np.array([[0, 0], [1, 0], [3, 1], [3, 4]], float)
    met = made._meeting(path, np.array([0, 1]), np.array([3, 2]))
    assert met == pytest.approx(scale * np.array([3, 0]))
    for slope, meets in ((0.4, False), (0.7, True)):
        turned = np.array([[0, 0], [1, 0], [4, 0], [5, slope]], float)
        found = made._meeting(turned, np.array([0, 1]), np.array([3, 2]))
        assert (found is not None) is meets


def test_long_lines_are_halved_until_none_is_longer():
    places, lines = np.array([[0, 0], [10, 0], [10, 3]], float), np.array([[0, 1], [1, 2]])
    ends, parts = made._divide_lines(places, lines, 3.0)
    length = np.hypot(*(ends[parts[:, 0]] - ends[parts[:, 1]]).T)
    assert np.sort(length) == pytest.approx([2.5] * 4 + [3.0])
    assert len(ends) == 6
    assert ends[:3].tolist() == places.tolist()
    same = made._divide_lines(places, lines, 10.0)
    assert same[1].tolist() == lines.tolist()


def test_points_of_a_lattice_are_inside_and_not_beside_lines():
    height = np.zeros((20, 12))
    height[10:] = np.nan
    ends = np.array([[4.0, 4.0]])
    inner = made._lattice(grid_of(height), ends, 2.0, 1.5)
    assert (inner[:, 0] <= 10.5).all()  # rows 1 to 10 behind the rim of empty cells
    assert (np.hypot(*(inner - ends).T) > 1.5).all()
    whole = made._lattice(grid_of(height), np.array([[99.0, 99.0]]), 2.0, 1.5)
    assert {tuple(each) for each in whole} == {
        (x, y) for x in (1.0, 3.0, 5.0, 7.0, 9.0) for y in (1.0, 3.0, 5.0, 7.0, 9.0, 11.0)
    }
    assert len(inner) < len(whole)


def test_levels_are_of_land_channels_and_what_a_wall_parts():
    height = np.zeros((12, 6))
    height[:4] = 3.0
    land = np.zeros((12, 6), bool)
    land[4:] = True
    flat = grid_of(height, land)
    inner = (slice(1, -1), slice(1, -1))
    assert (flat.level[inner] == np.where(land, 2, 1)).all()
    assert flat.level[0].sum() == 0
    assert flat.is_land.tolist() == [False, False, True]
    assert not flat.steep.any()
    step = np.where(np.arange(12)[:, None] < 6, 0.0, 2.5) * np.ones((12, 6))
    parted = grid_of(step)
    levels = parted.level[inner]
    assert np.unique(levels[:6]).size == np.unique(levels[6:]).size == 1
    assert levels[0, 0] != levels[-1, 0]
    assert parted.is_land[levels].all()
    assert np.flatnonzero(parted.steep[inner].any(axis=1)).tolist() == [5, 6]
    gentle = grid_of(np.where(np.arange(12)[:, None] < 6, 0.0, 1.9) * np.ones((12, 6)))
    assert np.unique(gentle.level[inner]).size == 1


def test_heights_at_places_have_the_slope_of_the_nearest_cell_of_their_level():
    x, y = np.meshgrid(np.arange(10.0), np.arange(8.0), indexing="ij")
    height = 0.3 * x - 0.1 * y
    land = x < 5
    height = np.where(land, height, height + 50)
    grid = grid_of(height, land)
    places = np.array([[3.25, 4.0], [2.0, 5.75], [9.0, 3.3], [10.0, 8.0]])  # one further: the rim
    levels = np.where(places[:, 0] < 5.5, 2, 1)
    wanted = 0.3 * (places[:, 0] - 1) - 0.1 * (places[:, 1] - 1) + 50 * (levels == 1)
    assert grid.heights(places, levels) == pytest.approx(wanted)
    # of land asked beyond the channel's edge: the nearest land, carried on
    beyond = grid.heights(np.array([[5.9, 4.0], [6.8, 4.0]]), np.array([2, 2]))
    assert beyond == pytest.approx(0.3 * np.array([4.9, 5.8]) - 0.3)
    i, j = grid.at(np.array([[-3.0, 99.0], [2.4, 2.6]]))
    assert (i.tolist(), j.tolist()) == ([0, 2], [9, 3])


def test_what_lies_beside_another_level_is_found_within_two_cells():
    level = np.zeros((12, 12), int)
    level[:, 6:] = 1
    beside = made._beside_another(level, np.zeros((12, 12), bool))
    assert beside[6].nonzero()[0].tolist() == [3, 4, 5, 6, 7, 8]
    steep = np.zeros((12, 12), bool)
    steep[5, 5] = True
    alone = made._beside_another(np.ones((12, 12), int), steep)
    assert alone.sum() == 13  # a diamond of two cells about it


def test_triangles_have_all_lines_as_edges_and_the_level_of_their_area():
    height = np.zeros((20, 20))
    land = np.zeros((20, 20), bool)
    land[:, :10] = True
    grid = grid_of(height, land)
    corners = np.array([[0.5, 0.5], [20.5, 0.5], [20.5, 10.5], [20.5, 20.5], [0.5, 20.5],
                        [0.5, 10.5]])  # fmt: skip
    lines = np.array([[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [2, 5]])
    inner = made._lattice(grid, corners, 4.0, 1.0)
    ends, parts, triangles, levels = made._triangles(grid, corners, lines, inner)
    places = np.concatenate([ends, inner])
    a, b, c = places[triangles].transpose(1, 0, 2)
    area = np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1))) / 2
    assert area.sum() == pytest.approx(400)
    assert area[levels == 2].sum() == pytest.approx(200)
    edges = {tuple(sorted(pair)) for t in triangles.tolist() for pair in
             zip(t, t[1:] + t[:1], strict=True)}  # fmt: skip
    assert {tuple(sorted(line)) for line in parts.tolist()} <= edges
    middle = (a + b + c) / 3
    assert (levels == np.where(middle[:, 1] < 10.5, 2, 1)).all()


def test_triangles_that_miss_their_cells_are_found_one_in_a_box():
    x, y = np.meshgrid(np.arange(21.0), np.arange(21.0), indexing="ij")
    height = 1e-3 * np.exp(-((x - 10) ** 2 + (y - 10) ** 2) / 20)
    grid = grid_of(height, side=1e-3)
    ends = np.array([[0.6, 0.6], [21.4, 0.6], [21.4, 21.4], [0.6, 21.4]])
    triangles, levels = np.array([[0, 1, 2], [0, 2, 3]]), np.array([2, 2])
    none = np.empty((0, 2))
    missed = made._most_missed_cells(grid, ends, none, triangles, levels, 100.0)
    assert len(missed) == 1
    assert np.hypot(*(missed[0] - 11)) < 6  # where the hill is
    assert len(made._most_missed_cells(grid, ends, none, triangles, levels, 2.0)) > 1
    flat = grid_of(np.zeros((21, 21)), side=1e-3)
    assert not len(made._most_missed_cells(flat, ends, none, triangles, levels, 100.0))
    plane = grid_of(1e-3 * (x - 2 * y), side=1e-3)
    assert not len(made._most_missed_cells(plane, ends, none, triangles, levels, 100.0))


def test_walls_stand_between_levels_and_sides_at_the_rim():
    #  two triangles of level 1 and one of level 2 beside them
    triangles = np.array([[0, 1, 2], [1, 3, 2], [1, 4, 3]])
    corners = np.array([[0, 1, 2], [1, 3, 2], [4, 5, 6]])  # points of the surface
    levels = np.array([1, 1, 2])
    walls, sides = made._upright(triangles, corners, levels, np.empty((0, 2), int), 5)
    assert len(walls) == 1
    ends = {tuple(sorted(walls[0, :2])), tuple(sorted(walls[0, 2:]))}
    assert ends == {(1, 3), (4, 6)}
    first, second = walls[0, :2].tolist(), walls[0, 2:].tolist()
    below = {1: 1, 3: 3, 4: 1, 6: 3}  # place of each point
    assert [below[each] for each in first] == [below[each] for each in second]
    assert {tuple(sorted(side)) for side in sides.tolist()} == {
        (0, 1), (0, 2), (2, 3), (4, 5), (5, 6),
    }  # fmt: skip
    assert made._edge(np.array([[3, 1], [1, 3], [1, 4]]), 5).tolist() == [8, 8, 9]
