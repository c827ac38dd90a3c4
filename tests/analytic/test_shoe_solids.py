"""Solids of soles: volumes in closed form and against the height map, files read back."""

import math
from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.read import chamfer_remark
from underfoot.core import InputError
from underfoot.shoe import Facet, Heel, Sipes, Tread, heel_surface
from underfoot.shoe.grids import cut_heel
from underfoot.shoe.parametric import sole_solid, write_sole
from underfoot.shoe.parametric.modelling import lug_outlines
from underfoot.shoe.tread import Groove

OUTSOLES = Path(__file__).parents[2] / "examples" / "outsoles"
KIND = {"length": 0.06, "width": 0.06, "rear_radius": 0.028, "outsole_thickness": 0.025}


def map_volume(shape, spacing=2e-4):
    surface = heel_surface(shape, spacing=spacing)
    return float(np.nansum(shape.outsole_thickness - surface.height)) * spacing**2


def test_flat_sharp_heel_has_its_volume():
    heel = Heel(**KIND)
    assert sole_solid(heel).volume == pytest.approx(heel.plan_area * 0.025, rel=1e-9)


def test_facet_takes_its_wedge():
    # the wedge over the rear: integral of tan(a) (L - x) over the plan form, here by the map
    heel = Heel(**KIND, profile=Facet(math.radians(10), 0.03))
    assert sole_solid(heel).volume == pytest.approx(map_volume(heel), rel=1e-4)


def test_rounded_rim_takes_what_a_fillet_takes():
    # a sharp rectangle with straight sides loses (1 - pi/4) r^2 per length of rim, but for corners
    wide = {**KIND, "length": 0.2, "width": 0.2, "rear_radius": 0.05, "front_radius": 0.05}
    sharp, rounded = Heel(**wide), Heel(**wide, edge_radius=2e-3)
    rim = 2 * (0.1 + 0.1) + 2 * math.pi * 0.05
    lost = sole_solid(sharp).volume - sole_solid(rounded).volume
    assert lost == pytest.approx((1 - math.pi / 4) * 4e-6 * rim, rel=0.01)


@pytest.mark.parametrize(
    "tread",
    [
        Tread("chevrons", 5e-3, 2.4e-3, 2.5e-3, angle=math.radians(30), arm_length=12e-3),
        Tread(
            "bars",
            9e-3,
            3e-3,
            2e-3,
            angle=0.5,
            offset=(2e-3, 1e-3),
            sipes=Sipes(1e-3, 1e-3, 6e-3, angle=0.5),
        ),
        Tread("circles", 12e-3, 3e-3, 2.5e-3),
        pytest.param(
            Tread("waves", 8e-3, 4e-3, 2.5e-3, wave_length=20e-3, wave_height=6e-3),
            marks=pytest.mark.slow,
        ),
        Tread("rings", 14e-3, 4e-3, 2.5e-3, ring_width=3e-3),
        Tread("graded_circles", 12e-3, 3e-3, 2e-3, front_lug_width=6e-3, graded_length=50e-3),
        Tread(
            "hexagons",
            12e-3,
            3e-3,
            2e-3,
            grooves=(Groove((30e-3, 5e-3), 2e-3, 15e-3, 0.4), Groove((40e-3, 0.0), 3e-3)),
        ),
    ],
    ids=["chevrons", "bars and sipes", "circles", "waves", "rings", "graded circles", "grooves"],
)
def test_solid_and_map_are_one_description(tread):
    heel = Heel(**KIND, tread=tread)
    assert sole_solid(heel).volume == pytest.approx(map_volume(heel), rel=5e-4)


@pytest.mark.parametrize("kind", [".stl", ".step", ".obj"])
def test_files_read_back_as_the_same_sole(tmp_path, kind):
    heel = Heel(**KIND, edge_radius=2e-3, tread=Tread("hexagons", 14e-3, 4e-3, 3e-3))
    solid = sole_solid(heel)
    found = write_sole(heel, tmp_path / f"sole{kind}", solid=solid)
    assert found.lugs > 8
    if kind == ".step":
        assert found.read_volume == pytest.approx(solid.volume, rel=1e-8)
        return
    import trimesh

    mesh = trimesh.load_mesh(found.path)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume * 1e-9 == pytest.approx(solid.volume, rel=5e-3)
    assert mesh.extents == pytest.approx([60, 60, 25], abs=0.02)
    # the lowest face is the land
    assert mesh.bounds[0][2] == pytest.approx(0.0, abs=1e-6)


def test_lugs_with_rounded_edges_lose_what_a_fillet_takes():
    sharp = Heel(**KIND, tread=Tread("blocks", 12e-3, 4e-3, 3e-3, lug_length=8e-3))
    soft = Heel(**KIND, tread=Tread("blocks", 12e-3, 4e-3, 3e-3, 0.5e-3, lug_length=8e-3))
    made = sole_solid(soft)
    lost = sole_solid(sharp).volume - made.volume
    one = (1 - math.pi / 4) * 0.25e-6 * (2 * (12e-3 + 8e-3) - 4 * 0.5e-3)
    corners = [lug.points for lug in lug_outlines(soft, soft.tread)]
    whole = sum(soft.inward_distance(*points.T).min() > 1e-3 for points in corners)
    assert whole > 5
    assert lost == pytest.approx(whole * one, rel=0.05)
    assert any("stay sharp" in remark for remark in made.remarks)


def test_chamfered_lugs_lose_a_prism_along_each_edge_in_solid_and_map():
    width = 0.5e-3
    lugs = {"pattern": "blocks", "lug_width": 12e-3, "channel_width": 4e-3, "depth": 3e-3}
    flat = Heel(**KIND, tread=Tread(**lugs, lug_length=8e-3, edge_chamfer=width))
    sharp = Heel(**KIND, tread=Tread(**lugs, lug_length=8e-3))
    # a prism c^2 / 2 along each edge, mitred at the corners
    one = width**2 / 2 * 2 * (12e-3 + 8e-3) - 4 / 3 * width**3
    corners = [lug.points for lug in lug_outlines(flat, flat.tread)]
    whole = sum(flat.inward_distance(*points.T).min() > 2 * width for points in corners)
    assert whole > 5
    lost = sole_solid(sharp).volume - sole_solid(flat).volume
    assert lost == pytest.approx(whole * one, rel=1e-4)
    spacing = 2.5e-5
    rows = np.arange(0, 8e-3, spacing) + spacing / 2
    columns = np.arange(-6e-3, 6e-3, spacing) + spacing / 2
    x, y = np.meshgrid(rows, columns, indexing="ij")
    rise = cut_heel(flat, x, y)[0] - cut_heel(sharp, x, y)[0]
    assert rise.sum() * spacing**2 == pytest.approx(one, rel=1e-3)
    with pytest.raises(InputError, match="chamfer"):
        Tread(**lugs, lug_length=8e-3, edge_radius=1e-4, edge_chamfer=1e-4)
    with pytest.raises(InputError, match="edge_chamfer"):
        Tread(**lugs, lug_length=8e-3, edge_chamfer=5e-3)


@pytest.mark.parametrize(
    ("heel", "words"),
    [
        (Heel(**KIND, tread=Tread("grid", 0.2e-3, 2e-3, 2e-3)), "printed"),
        (
            Heel(**KIND, tread=Tread("grid", 9e-3, 2e-3, 2e-3, sipes=Sipes(2e-4, 1e-3, 3e-3))),
            "sipe",
        ),
        (Heel(**{**KIND, "outsole_thickness": 0.006}, profile=Facet(0.3, 0.03)), "through"),
    ],
)
def test_soles_that_can_not_be_made(heel, words):
    with pytest.raises(InputError, match=words):
        sole_solid(heel)


def test_unknown_kind_of_file(tmp_path):
    with pytest.raises(InputError, match=r"\.step"):
        write_sole(Heel(**KIND), tmp_path / "sole.doc")


def test_a_chamfer_says_what_its_film_counts_as():
    case = Case.load(OUTSOLES / "heel_hexagons_glycerol.toml")
    assert chamfer_remark(case) == ""
    assert "sharp" in chamfer_remark(case.replace("shoe.tread.edge_chamfer", "0.3 mm"))
    assert chamfer_remark(case.replace("shoe.tread.pattern", "none")) == ""
