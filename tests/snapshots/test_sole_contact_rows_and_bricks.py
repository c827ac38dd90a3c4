"""Fine cells on a half-space rise as rectangles of Love; curves, squares and bricks are exact."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from small_pads import pad
from snapshot import held
from underfoot.compute.prepare import prepare_case
from underfoot.sole_contact.compliance import half_space_compliance
from underfoot.sole_contact.long_waves import SoleBody, _bricks, _layer_shares
from underfoot.sole_contact.row_compliance import (
    REACH,
    _home,
    _stencils,
    rectangle_deflection,
    row_compliance,
)

CUT = {
    "shoe.tread": {"pattern": "bars", "depth": "3 mm", "lug_width": "5.3 mm",
                   "channel_width": "3.9 mm"},
    "shoe.heel.length": "15 mm", "shoe.heel.width": "6 mm", "contaminant.viscosity": "500 cP",
    "motion.shoe_angle": "0 deg", "numerics.grid_spacing": "1 mm",
    "numerics.quick_grid_spacing": "1 mm", "numerics.cells_along": 4,
}  # fmt: skip


def test_near_cells_of_a_half_space_are_exact():
    """A pressure on one cell raises those within three squares along and one across exactly."""
    sole = prepare_case(pad(CUT), 1e-3).sole
    cells = sole.cells
    assert cells is not None
    modulus = 5e6
    body = half_space_compliance(cells.shape, 1e-3, modulus=modulus, poisson_ratio=0.0)
    rows = row_compliance(body, cells, sole.land & sole.inside)
    i, j = np.divmod(cells.parent, cells.shape[1])
    x = 1e-3 * (i + cells.offset)
    at_home = cells.land & (_home(cells, sole.land & sole.inside) == cells.parent)
    fine = np.flatnonzero((cells.width < 0.9) & cells.land)
    wide = np.flatnonzero((cells.width == 1.0) & cells.land)
    assert fine.size > 20
    assert wide.size > 5
    for one in (*fine[:: fine.size // 8], *wide[:: wide.size // 3]):
        pressure = np.zeros(cells.size)
        pressure[one] = 1.0
        risen = rows.apply(pressure)
        near = (np.abs(i - i[one]) <= REACH[0]) & (np.abs(j - j[one]) <= REACH[1]) & cells.land
        exact = rectangle_deflection(
            x - x[one], 1e-3 * (j - j[one]), np.full(x.size, 5e-4 * cells.width[one]), 5e-4, modulus
        )
        np.testing.assert_allclose(risen[near], exact[near], rtol=1e-9)
        # far away a part of a square acts from its middle, on land alone
        far = ~near & at_home & (cells.width[one] == 1.0) & at_home[one]
        np.testing.assert_allclose(risen[far], exact[far], rtol=0.05)


def test_a_cell_beside_the_land_of_squares_belongs_to_the_nearest_of_it():
    """First to the square on its own side, else to that on the other; else it stays."""
    land = np.array([[0, 1, 0, 0, 1, 0, 0, 0]], bool).T.repeat(2, axis=1)
    place = np.array([0, 2, 2, 3, 3, 5, 6, 1, 7])
    offset = np.array([0.3, -0.3, 0.3, -0.3, 0.3, 0.3, 0.0, 0.1, 0.4])
    cells: Any = SimpleNamespace(
        shape=(8, 2), parent=2 * place + 1, offset=offset, land=np.ones(9, bool)
    )
    home = _home(cells, land)
    assert ((home - 1) // 2).tolist() == [1, 1, 1, 4, 4, 4, 6, 1, 7]
    cells.land[:] = False
    assert _home(cells, land).tolist() == cells.parent.tolist()


def test_curves_through_squares_are_cubics_inside_and_parabolas_at_ends():
    """Within land of seven squares; of two squares a line, of one a level, beside it itself."""
    land = np.array([1] * 7 + [0, 1, 1, 0, 1, 0], bool)[:, None]
    place = np.repeat(np.arange(13), 3)
    offset = np.tile([-0.4, 0.1, 0.45], 13)
    cells: Any = SimpleNamespace(shape=(13, 1), parent=place, offset=offset)
    squares, weights = _stencils(cells, land, place)
    np.testing.assert_allclose(weights.sum(axis=0), 1.0)
    x = np.arange(13.0)
    at = place + offset

    def curve(values: np.ndarray) -> np.ndarray:
        return (weights * values[squares]).sum(axis=0)

    inside = (at >= 0) & (at <= 6)
    np.testing.assert_allclose(curve(x**3)[inside], at[inside] ** 3)
    ends = ~inside & (place < 7)
    assert ends.sum() == 3
    np.testing.assert_allclose(curve(x**2)[ends], at[ends] ** 2, atol=1e-12)
    assert not np.allclose(curve(x**3)[ends], at[ends] ** 3, atol=1e-3)
    two = (place == 8) | (place == 9)
    np.testing.assert_allclose(curve(x)[two], at[two])
    lone = np.isin(place, [7, 10, 11, 12])
    np.testing.assert_allclose(curve(x)[lone], place[lone])


@pytest.mark.parametrize("foam", [None, (1e6, 0.3, 9e-3)])
def test_bricks_grow_from_the_floor_and_foam_stands_on_them(file_regression, foam):
    """The lowest layer of bricks is as thick to the others as the net is wide to its doubles."""
    parts = prepare_case(
        pad({"shoe.heel.length": "48 mm", "shoe.heel.width": "40 mm", "numerics.cells_along": 1}),
        4e-3,
    )
    sole = parts.sole
    body = SoleBody(sole, np.full(sole.land.shape, 0.02), 0.0, 4e6, 0.5, foam)
    made, splines = _bricks(body, sole.land)
    heights = made.nodes[2, 2, :, 2] - made.nodes[2, 2, 0, 2]
    side = made.nodes[2, 2, 0, 0] - made.nodes[0, 2, 0, 0]
    shares = _layer_shares(0.02, side)
    layers = shares.size - 1
    np.testing.assert_allclose(heights[: 2 * layers + 1 : 2], 0.02 * shares, atol=1e-12)
    assert heights[-1] == pytest.approx(0.02 + (9e-3 if foam else 0.0))
    assert made.modulus.tolist()[:layers] == [4e6] * layers
    held(
        file_regression,
        [heights, made.cover.shape, made.pressed.sum(), made.modulus, splines.size, side],
        f"bricks {'on foam' if foam else 'alone'}",
    )


@pytest.mark.parametrize(("thickness", "side", "ends"), [
    (1e-3, 4e-3, [0, 1 / 3, 1]), (12e-3, 4e-3, [0, 1 / 3, 1]),
    (12.1e-3, 4e-3, [0, 1 / 7, 3 / 7, 1]), (29e-3, 4e-3, [0, 1 / 15, 3 / 15, 7 / 15, 1]),
])  # fmt: skip
def test_layers_of_bricks_double_until_they_fill_the_thickness(thickness, side, ends):
    np.testing.assert_allclose(_layer_shares(thickness, side), ends)
