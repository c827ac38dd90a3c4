"""Sipes finer than the grid: geometry, compliance, closing and drainage of slits."""

import math

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.resolve import resolve_context
from underfoot.compute.run import run
from underfoot.compute.sole import sole_map
from underfoot.shoe import Heel, Sipes, Tread, heel_map, heel_surface, surface_map
from underfoot.shoe.slits import slits_of
from underfoot.sole_contact._kernels.elastic import (
    BONDED_END,
    block_compression,
    compression,
    free_share,
    slit_closing,
    slit_openness,
)
from underfoot.sole_contact.compliance import lug_height
from underfoot.sole_contact.slits import loaded_slits
from underfoot.sole_contact.solver import solve_sliding

MM = 1e-3
MODULUS, POISSON = 4e6, 0.49
HEIGHT = 4 * MM


def siped(angle=0.0, *, width=0.3 * MM, depth=2 * MM, pitch=4 * MM, size=16 * MM):
    """A square lug in the middle of a heel, parts of others around it."""
    sipes = Sipes(width, depth, pitch, angle) if depth else None
    tread = Tread("grid", size, 8 * MM, HEIGHT, sipes=sipes, offset=(12 * MM, 0.0))
    return Heel(40 * MM, 40 * MM, 0.0, 20 * MM, tread=tread)


def mapped(heel, spacing=0.5 * MM):
    return heel_map(heel, shoe_angle=0.0, spacing=spacing)


def give(sole):
    """Mean compression of the lugs under a uniform pressure, m/Pa."""
    edges = sole.cut.along, sole.cut.across
    field = block_compression(
        sole.land, sole.spacing, lug_height(sole), MODULUS, POISSON, edges, sole.slits
    )
    return float(np.average(field[sole.land], weights=sole.cut.area[sole.land]))


@pytest.mark.parametrize("degrees", [0, 17, 45, 90])
def test_slits_are_as_long_as_drawn_at_any_angle(degrees):
    sole, width, fine = mapped(siped(math.radians(degrees)), 0.8 * MM), 0.3 * MM, 0.02 * MM
    places = (np.arange(2000) + 0.5) * fine
    x, y = np.meshgrid(places, places - 20 * MM, indexing="ij")
    tread = siped(math.radians(degrees)).tread
    cut = (tread.slit_distance(x, y) > 0) & (tread.channel_distance(x, y) <= 0)
    drawn = np.count_nonzero(cut) * fine**2 / width
    assert sole.slits.covered.sum() * sole.spacing**2 / width == pytest.approx(drawn, rel=0.02)
    assert sole.slits.whole_length == pytest.approx(drawn, rel=0.04)


def test_slits_turned_by_a_right_angle_make_a_square_lug_as_soft():
    along, across = mapped(siped(0.0)), mapped(siped(math.pi / 2))
    assert give(along) == pytest.approx(give(across), rel=1e-9)
    assert give(along) > 1.03 * give(mapped(siped(depth=0.0)))


def test_a_slit_without_depth_is_none():
    plain = give(mapped(siped(depth=0.0)))
    gains = [give(mapped(siped(depth=depth * MM))) / plain - 1 for depth in (1e-3, 0.5, 1, 2, 4)]
    assert abs(gains[0]) < 1e-5
    assert (np.diff(gains) > 0).all()
    assert mapped(siped(depth=0.0)).slits is None


def test_compression_of_oblique_slits_converges_with_the_grid():
    values = [give(mapped(siped(0.3), spacing * MM)) for spacing in (1.0, 0.5, 0.25)]
    assert abs(values[2] - values[1]) < 0.5 * abs(values[1] - values[0])
    assert values[1] == pytest.approx(values[2], rel=0.01)


def test_slits_through_the_whole_height_part_a_bar_into_strips():
    """q = cosh(k x) / cosh(k b / 2) between walls b apart, k^2 = c / d^2."""
    pitch = 5 * MM
    tread = Tread("grid", 110 * MM, 8 * MM, HEIGHT, sipes=Sipes(0.3 * MM, HEIGHT, pitch))
    sole = mapped(Heel(110 * MM, 110 * MM, 0.0, 20 * MM, tread=tread), 0.5 * MM)
    block = sole.land, sole.spacing, lug_height(sole), POISSON
    share = free_share(*block, (sole.cut.along, sole.cut.across), sole.slits)
    k = math.sqrt(1.5 / (1 + POISSON)) / HEIGHT
    part = math.tanh(k * pitch / 2)
    # two strips, far from the rim
    middle = (np.abs(sole.x - 55 * MM) < pitch)[:, None] & (np.abs(sole.y) < pitch)
    assert share[middle].mean() == pytest.approx(part / (k * pitch / 2), rel=0.03)
    closing = slit_closing(share, sole.slits, lug_height(sole), MODULUS, POISSON)
    assert closing == pytest.approx(
        2 * BONDED_END * part / (k * MODULUS), rel=0.08
    )  # rims move less


def strip_compression(width, slit):
    """Mean compression (m Pa / Pa) of a layer 1 high with slits ``width`` apart, plane strain."""
    pytest.importorskip("ngsolve")
    import ngsolve as ng
    from netgen.geom2d import SplineGeometry

    shape = SplineGeometry()
    points = [(0, 0), (width / 2, 0), (width / 2, 1 - slit), (width / 2, 1), (0, 1)]
    names = ["base", "held", "side", "face", "middle"]
    if slit in (0, 1):
        points.pop(2)
        names.remove("held" if slit else "side")
    nodes = [shape.AppendPoint(*point) for point in points]
    for number, name in enumerate(names):
        ends = nodes[number], nodes[(number + 1) % len(nodes)]
        shape.Append(["line", *ends], bc=name, maxh=0.15)
    mesh = ng.Mesh(shape.GenerateMesh(maxh=0.2))
    space = ng.H1(mesh, order=4, dirichlet="base|middle|held") * ng.H1(
        mesh, order=4, dirichlet="base"
    )
    (u, w), (v, z) = space.TnT()
    shear = 1 / (2 * (1 + POISSON))
    first = POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    (ux, uz), (wx, wz), (vx, vz), (zx, zz) = (ng.grad(each) for each in (u, w, v, z))
    energy = first * (ux + wz) * (vx + zz) + 2 * shear * (ux * vx + wz * zz)
    form = ng.BilinearForm((energy + shear * (uz + wx) * (vz + zx)) * ng.dx).Assemble()
    load = ng.LinearForm(-z * ng.ds("face")).Assemble()
    found = ng.GridFunction(space)
    found.vec.data = form.mat.Inverse(space.FreeDofs(), "umfpack") * load.vec
    face = mesh.Boundaries("face")
    return -2 / width * ng.Integrate(found.components[1], mesh, ng.BND, definedon=face)


@pytest.mark.parametrize(("width", "within"), [(1.5, 0.06), (3.0, 0.03), (6.0, 0.03)])
def test_depth_of_a_slit_counts_as_finite_elements_find(width, within):
    none, whole = strip_compression(width, 0), strip_compression(width, 1)
    k = math.sqrt(1.5 / (1 + POISSON))
    part = math.tanh(k * width / 2)
    for depth in (0.15, 0.3, 0.5, 0.7, 0.85):
        gain = (strip_compression(width, depth) - none) / (whole - none)
        b = float(slit_openness(np.array(depth)))
        assert 1 / (1 + k * part / b) == pytest.approx(gain, abs=within)


def test_rubber_closes_narrow_slits_and_lugs_then_give_no_further():
    kind = {"modulus": MODULUS, "poisson_ratio": POISSON}
    widths = (0.05, 0.1, 0.2, 0.4, 0.8)
    soles = [mapped(siped(width=width * MM)) for width in widths]
    pressed = [loaded_slits(sole, pressure=300e3, **kind) for sole in soles]
    # 300 kPa on 4 MPa moves the walls of these by 0.07 mm
    assert [bool(sole.slits.drained.any()) for sole in pressed] == [False, False, True, True, True]
    assert (np.diff([sole.slits.drainage.max() for sole in pressed]) >= 0).all()
    gains = [sole.slits.further_give for sole in pressed]
    assert (np.diff(gains) >= -1e-3).all()
    assert gains[0] < 0.8 * gains[-1]
    unpressed = loaded_slits(soles[0], pressure=0.0, **kind)
    assert unpressed.slits.openness == 1.0
    assert unpressed.cut.area == pytest.approx(soles[0].cut.area, abs=1e-12)
    # walls that have met leave the land as it was
    assert pressed[0].land_area == pytest.approx(mapped(siped(depth=0.0)).land_area, rel=1e-9)


def test_a_slit_that_reaches_no_channel_drains_nothing():
    sole = mapped(siped())
    assert sole.slits.drained.any()
    land = np.ones_like(sole.land)
    x, y = sole.x[:, None], sole.y[None, :]
    middle = (np.abs(x - 20 * MM) < 5 * MM) & (np.abs(y) < 5 * MM)
    blind = slits_of(
        middle,
        land,
        land,
        sole.spacing,
        lambda i, j, along, across: siped().tread.slit_distance(
            sole.x[i] + along * sole.spacing, sole.y[j] + across * sole.spacing
        ),
        depth=np.full(land.shape, 2 * MM),
        width=np.full(land.shape, 0.3 * MM),
        tangent=(np.zeros(land.shape), np.ones(land.shape)),
    )
    assert blind.covered.any()
    assert not blind.drained.any()


def test_slits_of_a_height_map_are_those_of_the_drawing():
    angle = 0.4
    drawn = mapped(siped(angle, width=0.6 * MM), 1.0 * MM)
    surface = heel_surface(siped(angle, width=0.6 * MM), spacing=0.15 * MM)
    read = surface_map(surface, shoe_angle=0.0, spacing=1.0 * MM)
    assert read.slits.whole_length == pytest.approx(drawn.slits.whole_length, rel=0.08)
    assert np.median(read.slits.width) == pytest.approx(0.6 * MM, rel=0.2)
    assert np.median(read.slits.depth) == pytest.approx(2 * MM, rel=1e-6)
    assert read.land_area == pytest.approx(drawn.land_area, rel=0.02)
    assert lug_height(read)[read.land].max() == pytest.approx(HEIGHT)
    assert give(read) == pytest.approx(give(drawn), rel=0.02)


SHOE = {"pattern": "grid", "depth": "4 mm", "lug_width": "12 mm", "channel_width": "4 mm"}


def slipping(width, grid):
    cuts = {"width": f"{width} mm", "depth": "4 mm", "spacing": "6 mm"}
    return Case(
        shoe={"from": "work_shoe_full_tread", "tread": {**SHOE, "sipes": cuts}},
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion="slip_tester_g4",
        numerics={"tread_positions": 1, "quick_grid_spacing": f"{grid} mm"},
    )


@pytest.mark.slow
def test_slits_work_as_the_same_slits_resolved_by_the_grid():
    found = []
    for grid in (0.5, 0.55):  # two cells across a sipe of 1 mm, and just not
        case = slipping(1.0, grid)
        sole, context = sole_map(case, grid * MM), resolve_context(case)
        assert (sole.slits is None) == (grid == 0.5)
        found.append(
            solve_sliding(
                sole,
                case.compliance.build(context, sole),
                case.rough_contact.build(context),
                viscosity=case.film.build(context).viscosity,
                speed=case.motion.speed,
                normal_force=case.motion.normal_force,
            )
        )
    resolved_, slits = found
    assert slits.approach == pytest.approx(resolved_.approach, rel=0.03)
    assert slits.fluid_load == pytest.approx(resolved_.fluid_load, rel=0.15)


def test_a_run_says_what_its_sipes_do():
    result = run(slipping(0.4, 1.25), quick=True)
    words = result.labels["sipes"]
    assert "sipes finer than the grid" in words
    assert "the lugs give way" in words
    assert words in " ".join(result.remarks()["Notes"])
    assert not [line for line in result.breaches if "sipe" in line]


def test_compression_has_its_limits():
    confined = (1 + POISSON) * (1 - 2 * POISSON) / (1 - POISSON)
    height = np.array(1.0)
    assert compression(np.array(1.0), height, 1.0, POISSON) == pytest.approx(BONDED_END)
    assert compression(np.array(0.0), height, 1.0, POISSON) == pytest.approx(BONDED_END * confined)
