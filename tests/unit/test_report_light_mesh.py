"""A sole as few triangles: loads of the cells, edges of the design, walls that carry nothing."""

import numpy as np
import pytest

from underfoot.report.drawn_sole import DrawnSole
from underfoot.report.light_mesh import SMALL, _shares, light_mesh, spacing_for
from underfoot.report.surface_mesh import TOLERANCE, surface_mesh

SIDE = 0.4e-3
EVERYWHERE = slice(None), slice(None)


def bars(side):
    """Return axes, heights and land of bars of 6 mm and channels of 4 mm, 30 by 20 mm."""
    x, y = (np.arange(side / 2, length, side) for length in (30e-3, 20e-3))
    land = np.broadcast_to((x % 10e-3 < 6e-3)[:, None], (x.size, y.size))
    return x, y, np.where(land, 0.0, 3e-3), land


@pytest.fixture(scope="module")
def light():
    x, y, height, land = bars(SIDE)
    sole = DrawnSole(x, y, SIDE, height, height + 1e-5, land, EVERYWHERE, EVERYWHERE)
    peak = np.exp(-(((x[:, None] - 13e-3) / 2e-3) ** 2) - ((y - 8e-3) / 2e-3) ** 2)
    values = {
        "contact_pressure": np.where(land, 1e6 * peak, np.nan),
        "fluid_pressure": np.where(land, np.nan, 2e4),
        "film_thickness": np.where(land, 1e-6 * (1 + x[:, None] / 30e-3), np.nan),
    }
    fine = bars(0.1e-3)
    return sole, values, light_mesh(surface_mesh(*fine), sole, values)


def test_pressure_times_area_is_the_load_over_corners_and_over_triangles(light):
    sole, values, mesh = light
    corners = mesh.points[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    seen = -normal[:, 2] / 2
    assert (seen > -1e-15).all(), "what is seen from below turns down"
    assert mesh.area.sum() == pytest.approx(30e-3 * 20e-3, rel=0.02)
    for name in ("contact_pressure", "fluid_pressure"):
        load = np.nansum(values[name]) * sole.spacing**2
        assert mesh.fields[name] @ mesh.area == pytest.approx(load, rel=1e-9)
        means = mesh.fields[name][mesh.triangles].mean(axis=1)
        assert means @ seen == pytest.approx(load, rel=1e-9)


def test_peaks_and_smooth_fields_are_those_of_the_cells(light):
    _, values, mesh = light
    assert mesh.fields["contact_pressure"].max() == pytest.approx(1e6, rel=0.05)
    film = mesh.fields["film_thickness"][: mesh.below]
    on_land = mesh.points[: mesh.below, 2] < 1e-3
    wanted = 1e-6 * (1 + mesh.points[: mesh.below, 0][on_land] / 30e-3)
    slope = 1e-6 / 30e-3  # a corner of the rim has the mean of a triangle on one side of it
    assert np.abs(film[on_land] - wanted).max() <= slope * SMALL
    assert (film[~on_land] == 0).all(), "none of the channels' cells has a film"
    assert film.max() <= np.nanmax(values["film_thickness"]) * (1 + 1e-12)


def test_walls_are_apart_and_stand_where_the_design_has_them(light):
    _, _, mesh = light
    walls = mesh.points[mesh.below :]
    assert all((each[mesh.below :] == 0).all() for each in (mesh.area, *mesh.fields.values()))
    rim = (walls[:, :2] < 1e-3) | (walls[:, :2] > [29e-3, 19e-3])
    inner = walls[~rim.any(axis=1), 0]
    assert inner.size
    off = np.minimum(np.abs(inner % 10e-3 - 6e-3), np.abs(inner % 10e-3 - 10e-3))
    assert off.max() <= TOLERANCE * 0.1e-3


def test_cells_of_a_small_sole_are_those_of_the_bound(light):
    assert TOLERANCE * spacing_for(light[0]) <= 0.05e-3


def test_a_cell_is_shared_by_the_corners_of_the_triangle_of_its_kind_that_holds_it():
    """Two triangles of land make a square; a third, of channel, lies beside it."""
    x = np.arange(0.5, 12.0)
    land = np.broadcast_to((x < 6.0)[:, None], (12, 6))
    flat = np.zeros(land.shape)
    sole = DrawnSole(x, x[:6], 1.0, flat, flat, land, EVERYWHERE, EVERYWHERE)
    corners = [(0, 0), (6, 0), (0, 6), (6, 6), (6, 0), (12, 0), (6, 6)]
    points = np.array([(*place, 0.0) for place in corners])
    kinds = np.array([True] * 4 + [False] * 3)
    triangles = np.array([[0, 1, 2], [1, 3, 2], [4, 5, 6]])
    cells, owners, weights = _shares(sole, kinds, points, triangles)
    assert (kinds[owners] == land.ravel()[cells]).all()
    count = np.bincount(cells, weights)
    assert count.min() == pytest.approx(1.0)  # two of a cell on the edge between two triangles
    places = [np.bincount(cells, weights * points[owners, k]) / count for k in (0, 1)]
    i, j = np.divmod(np.arange(72), 6)
    # the upper half of the channel is in no triangle: its cells have the nearest corner
    held = (i < 6) | (x[i] + x[j] <= 12)
    np.testing.assert_allclose(np.array(places)[:, held], np.stack([x[i], x[j]])[:, held])
