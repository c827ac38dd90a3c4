"""Cells fine along the sliding: areas, mirror images, exact faces, compliance, converged films."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from underfoot.case import Case
from underfoot.compute.position_draws import TreadPlace
from underfoot.compute.positions import place_numbers
from underfoot.compute.prepare import prepare_case
from underfoot.compute.solve import solved_at
from underfoot.core import InputError
from underfoot.film import Conductance
from underfoot.film.face_operator import Faces, face_operator
from underfoot.shoe import Facet, Heel, Tread, heel_map
from underfoot.shoe.row_division import row_cells
from underfoot.shoe.tread import Sipes
from underfoot.sole_contact import half_space_compliance
from underfoot.sole_contact.row_compliance import rectangle_deflection, row_compliance

EXAMPLES = Path(__file__).parents[2] / "examples"
MM = 1e-3


def heel(**tread) -> Heel:
    lugs = {"pattern": "hexagons", "lug_width": 6 * MM, "channel_width": 3 * MM, "depth": 3 * MM}
    return Heel(
        length=30 * MM,
        width=24 * MM,
        outsole_thickness=25 * MM,
        rear_radius=8 * MM,
        front_radius=4 * MM,
        profile=Facet(angle=math.radians(8), length=12 * MM),
        tread=Tread(**(lugs | tread)),
    )


def maps(sole: Heel, columns: int = 16):
    angle = math.radians(6)
    return (
        heel_map(sole, shoe_angle=angle, spacing=1 * MM),
        heel_map(sole, shoe_angle=angle, spacing=1 * MM, columns=columns),
    )


def test_cells_fill_the_squares_and_keep_the_area_of_the_land():
    square, fine = maps(heel())
    cells = row_cells(square, fine)
    assert cells.sums(cells.width) == pytest.approx(np.ones(cells.shape))
    assert cells.width.min() == 1 / 16
    # half and more of the cells are whole squares: fine ones stand beside rims and corners alone
    assert np.count_nonzero(cells.width == 1) > 0.5 * cells.shape[0] * cells.shape[1]
    land = float(cells.area[cells.land].sum())
    assert land == pytest.approx(square.land_area / MM**2, rel=0.01)


def test_square_cells_are_those_of_the_map():
    square, _ = maps(heel())
    cells = row_cells(square)
    assert cells.size == square.clearance.size
    assert square.cut is not None
    assert cells.of(square.cut.area) == pytest.approx(cells.area)
    assert cells.of(square.land).tolist() == cells.land.tolist()


def test_cells_of_a_symmetric_sole_are_symmetric():
    square, fine = maps(heel(pattern="transverse"))
    cells = row_cells(square, fine)
    count = cells.sums(np.ones(cells.size))
    assert (count == count[:, ::-1]).all()
    heights = cells.means(np.where(np.isfinite(cells.clearance), cells.clearance, 0), cells.width)
    assert heights == pytest.approx(heights[:, ::-1], abs=1e-12)


def test_sipes_finer_than_the_cells_need_square_ones():
    sipes = Sipes(width=0.3 * MM, depth=2 * MM, spacing=2.5 * MM, angle=0.0)
    with pytest.raises(InputError, match="square cells") as refused:
        row_cells(*maps(heel(sipes=sipes), columns=2))
    assert refused.value.where == "numerics.cells_along"


@given(corner=st.floats(0.3, 8.7), slope=st.floats(0.01, 0.3), width=st.floats(0.2, 1.0))
def test_pressures_between_rigid_walls_are_exact_wherever_the_corner_lies(corner, slope, width):
    """One row of cells under a flat part and a wedge: the closed-form integrals, to rounding."""
    count, spacing, viscosity, speed, least = 10, width * MM, 0.2, -0.35, 15e-6
    centres = np.arange(count, dtype=float)

    def height(x):
        return least + slope * spacing * np.maximum(x - corner, 0.0)

    west = np.arange(count - 1)
    inside = (corner > west) & (corner < west + 1)
    node = np.where(inside, corner - west, 0.5)
    gap = height(centres)
    straight = (1 - node) * gap[:-1] + node * gap[1:]
    rise = height(west + node) - straight
    none, empty = np.zeros(0, dtype=int), np.zeros(0)
    faces = Faces(
        count, count, spacing, west, west + 1, np.ones(count - 1), node, np.stack([node, node]),
        np.stack([rise, rise]), none, none, empty, empty,
    )  # fmt: skip

    def conductance(h, before):
        return Conductance(h**3 / (12 * viscosity), h**2 / (4 * viscosity))

    operator = face_operator(faces, gap, conductance, before=None, limits=(1e-9, 1.0), speed=speed)
    matrix = operator.by_pressure.matrix().toarray()[1:-1, 1:-1]
    carried = operator.imbalance(np.zeros(count), np.ones(count), 0.0)[1:-1]
    pressure = np.zeros(count)
    pressure[1:-1] = np.linalg.solve(matrix, -carried)

    def integral(power, until):
        ends = sorted({0.0, float(np.clip(corner, 0.0, until)), until})
        parts = [
            quad(lambda x: float(height(x)) ** -power, a, b, epsabs=0, epsrel=1e-12)[0]
            for a, b in pairwise(ends)
        ]
        return spacing * sum(parts)

    last = count - 1.0
    flow = speed * integral(2, last) / integral(3, last)
    exact = [
        12 * viscosity * (speed * integral(2, x) - flow * integral(3, x)) for x in centres[1:-1]
    ]
    assert pressure[1:-1] == pytest.approx(exact, rel=1e-7, abs=1e-7 * max(map(abs, exact)))


def test_the_deflection_of_fine_cells_is_that_of_rectangles_on_a_half_space():
    square, fine = maps(heel())
    cells = row_cells(square, fine)
    plane = 6e6
    body = half_space_compliance(cells.shape, 1 * MM, modulus=plane, poisson_ratio=0.0)
    everywhere = np.ones(cells.shape, dtype=bool)
    compliance = row_compliance(
        body, replace(cells, land=everywhere.ravel()[cells.parent]), everywhere
    )
    i, j = np.divmod(cells.parent, cells.shape[1])
    x, y = (i + cells.offset) * MM, j * MM
    middle = np.array(cells.shape) // 2
    # a pressure that rises from 0 within half a millimetre, as it does in an inlet
    near = (np.abs(i - middle[0]) < 4) & (np.abs(j - middle[1]) < 3)
    pressure = np.where(near, 1e5 * (1 - np.exp(-(x - x[near].min()) / (0.2 * MM))), 0.0)
    exact = np.zeros(cells.size)
    for k in np.flatnonzero(near):
        half = 0.5 * cells.width[k] * MM
        exact += pressure[k] * rectangle_deflection(x - x[k], y - y[k], half, 0.5 * MM, plane)
    found = compliance.apply(pressure)
    assert np.abs(found - exact)[near].max() < 0.006 * exact.max()


@cache
def numbers(shoe: str, spacing: float, cells_along: int) -> dict[str, float]:
    case = Case.load(EXAMPLES / f"{shoe}_shoe_untreaded_glycerol.toml")
    case = case.replace("numerics.cells_along", cells_along)
    parts = prepare_case(case, spacing)
    _, contact = solved_at(parts, TreadPlace(), spacing)
    assert contact.status.usable
    mirrored = contact.fluid_pressure[:, ::-1]
    assert np.abs(contact.fluid_pressure - mirrored).max() < 1e-3 * contact.fluid_pressure.max()
    return place_numbers(parts, contact)


@pytest.mark.slow
@pytest.mark.parametrize("shoe", ["work", "athletic"])
def test_film_and_friction_of_an_untreaded_heel_do_not_depend_on_the_spacing(shoe):
    """Square cells of 1, 0.6 and 0.3 mm differ by 40 % in COF under the work shoe."""
    coarse, fine = (numbers(shoe, spacing, 16) for spacing in (1 * MM, 0.7 * MM))
    assert coarse["fluid_load"] == pytest.approx(fine["fluid_load"], rel=0.03)
    assert coarse["cof"] == pytest.approx(fine["cof"], rel=0.04)


@pytest.mark.slow
@pytest.mark.parametrize(
    "shoe",
    [
        "work",
        pytest.param(
            "athletic",
            marks=pytest.mark.xfail(
                strict=True,
                reason="36.3, 34.7, 36.6 N of 500 with 8, 16, 32 cells: at the rear edge the film "
                "grows with every finer cell, elsewhere it does not",
            ),
        ),
    ],
)
def test_film_and_friction_of_an_untreaded_heel_converge_with_the_cells_along(shoe):
    """8, 16, 32 cells in a spacing: at least the first order; 16 leave what a result may miss."""
    found = [numbers(shoe, 1 * MM, cells) for cells in (8, 16, 32)]
    for name, most in (("fluid_load", 0.05), ("cof", 0.02)):
        eighth, own, finer = (each[name] for each in found)
        assert own == pytest.approx(finer, rel=most)
        settled = abs(eighth - finer) < 0.005 * finer
        assert settled or abs(own - finer) < 0.6 * abs(eighth - own)
