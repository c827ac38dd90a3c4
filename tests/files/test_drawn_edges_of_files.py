"""The lugs of a file are drawn where its faces end, whichever way it lies and is cut."""

import itertools
from dataclasses import replace
from math import radians

import numpy as np
import pytest
import trimesh

from underfoot.report.surface_mesh import surface_mesh
from underfoot.shoe import Flat, Heel, SoleSurface, Tread, floor_lines, surface_map
from underfoot.shoe.drawn_surface import drawn_surface, rounded_rims
from underfoot.shoe.files import FileSettings, outsole_from_file
from underfoot.shoe.parametric import write_sole
from underfoot.shoe.tread_measures import tread_map, tread_measures

HEEL = Heel(
    length=0.07, width=0.062, rear_radius=0.03, outsole_thickness=0.012, profile=Flat(),
    tread=Tread("hexagons", 7e-3, 3e-3, 3e-3),
)  # fmt: skip


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The heel by its lengths, and the same with the solid turned and moved."""
    folder = tmp_path_factory.mktemp("soles")
    plain, turned = folder / "plain.stl", folder / "turned.stl"
    write_sole(HEEL, plain)
    solid = trimesh.load_mesh(plain)
    turn = trimesh.transformations.euler_matrix(0.4, -0.3, 2.1)
    solid.apply_transform(turn)
    solid.apply_translation([120.0, -40.0, 15.0])
    solid.export(turned)
    return plain, turned


def lug_edges(file, angle=0.0, spacing=0.2e-3, **given):
    """Places on the drawn edges of lugs, (n, 2), in m from the rear end and the middle."""
    outsole = outsole_from_file(file, FileSettings(**given))
    chosen = {"shoe_angle": angle, "spacing": spacing}
    surface = drawn_surface(outsole.surface)
    sole = surface_map(surface, **chosen)
    lugs, sides = floor_lines(surface, (outsole.edges, outsole.sides), **chosen)
    height = np.where(sole.inside, sole.clearance, np.nan)
    mesh = surface_mesh(sole.x, sole.y, height, sole.land, edges=lugs, rim=sides, reach=0.4e-3)
    walls = mesh.walls[mesh.land[mesh.walls[:, 0]] != mesh.land[mesh.walls[:, 2]]][:, :2]
    ends = mesh.points[walls][:, :, :2]
    rim = sides.reshape(-1, 2)
    begin = rim[:, 0].min(), (rim[:, 1].min() + rim[:, 1].max()) / 2
    return np.concatenate([ends[:, 0], ends.mean(axis=1)]) - begin, outsole


def off_the_design(places, heel):
    inner = heel.inward_distance(*places.T) > 1e-3
    assert np.count_nonzero(inner) > 200
    return np.abs(heel.tread.channel_distance(*places[inner].T))


def test_edges_of_lugs_are_those_of_the_faces(files):
    places, outsole = lug_edges(files[0])
    assert off_the_design(places, HEEL).max() < 0.02e-3
    rim = outsole.sides.reshape(-1, 2)
    assert np.abs(HEEL.inward_distance(*rim.T)).max() < 0.1e-3  # chords of the file's arcs


def test_edges_turn_with_the_file_and_its_mirror(files):
    """A hexagonal tread of a symmetric heel is its own mirror image."""
    for file, given in ((files[1], {}), (files[0], {"mirror": True})):
        places, _ = lug_edges(file, **given)
        assert np.quantile(off_the_design(places, HEEL), 0.95) < 0.03e-3


def test_edges_lie_where_a_tilted_sole_has_them(files):
    angle = radians(8)
    places, _ = lug_edges(files[0], angle=angle)
    flat = np.column_stack([places[:, 0] / np.cos(angle), places[:, 1]])
    assert np.quantile(off_the_design(flat, HEEL), 0.95) < 0.03e-3


def test_a_cut_keeps_the_edges_of_its_part(files):
    places, _ = lug_edges(files[0], region="heel", region_length=0.04)
    assert places[:, 0].max() < 0.0405
    inner = places[places[:, 0] < 0.038]
    assert off_the_design(inner, HEEL).max() < 0.02e-3


def test_lugs_reach_the_rounded_rim_and_end_at_their_walls(tmp_path):
    heel = replace(HEEL, edge_radius=2e-3, tread=Tread("longitudinal", 7e-3, 3e-3, 3e-3))
    write_sole(heel, tmp_path / "rounded.stl")
    places, outsole = lug_edges(tmp_path / "rounded.stl")
    surface = outsole.surface
    x, y = np.meshgrid(surface.x, surface.y, indexing="ij")
    lug = (heel.tread.channel_distance(x, y) < -0.3e-3) & (heel.inward_distance(x, y) > 0)
    assert np.mean(surface.land[lug]) < 0.98
    assert np.mean(drawn_surface(surface).land[lug]) > 0.999
    channel = heel.tread.channel_distance(x, y) > 0.3e-3
    assert not drawn_surface(surface).land[channel].any()
    assert heel.inward_distance(*places.T).min() < 0.1e-3  # of the walls; none along the rim
    off = np.abs(heel.tread.channel_distance(*places.T))
    assert np.quantile(off, 0.99) < 0.02e-3
    assert off.max() < 0.25e-3  # a cell of the map, where the rim is cut short


def test_a_floor_beside_the_rim_and_a_groove_along_it_are_no_rims():
    x = y = (np.arange(120) + 0.5) * 0.25e-3
    height = np.zeros((120, 120))
    height[:, 100:110] = np.interp(np.arange(10), [0, 4.5, 9], [0, 2e-3, 0])  # along the rim
    height[60:70] = 3e-3  # runs out at the rim
    away = np.maximum(2e-3 - (x[-1] + 0.125e-3 - x), 0.0)  # a rim rounded by 2 mm
    height += (2e-3 - np.sqrt(4e-6 - away**2))[:, None]
    tread = tread_map(height, 0.25e-3)
    land = tread.land & (x < x[-3])[:, None]
    surface = SoleSurface(
        x, y, height, land, np.where(land, tread.tread_depth, 0.0), 0.25e-3,
        np.array([[0, 0], [0.03, 0], [0.03, 0.03], [0, 0.03], [0, 0]]), base=tread.base,
    )  # fmt: skip
    rims = rounded_rims(surface)
    assert rims[-3:, :60].all()
    assert not rims[:-3].any()
    assert not rims[:, 101:109].any()


@pytest.mark.parametrize(
    ("width", "phase"),
    [(0.6, 0.0), (0.6, 0.16), (0.8, 0.07), (0.8, 0.1), (0.8, 0.22), (1.1, 0.1)],
)
def test_sipes_are_as_wide_as_their_walls_wherever_the_cells_lie(tmp_path, width, phase):
    """Each lies alike on cells of 0.25 mm, three or four of which they cut for 0.8 mm."""
    edges = np.concatenate([[0.0], np.arange(phase + 3, 72, 6), [72.0]])
    boxes = [((0, 0, 3), (72, 60, 9))]
    for before, after in itertools.pairwise(edges):
        begin = before + width * (before > 0)
        boxes.append(((begin, 0, 0), (after, 60, 3)))
    bodies = [trimesh.creation.box(bounds=each) for each in boxes]
    trimesh.util.concatenate(bodies).export(tmp_path / "sipes.stl")
    outsole = outsole_from_file(tmp_path / "sipes.stl", FileSettings(down="-z", forward="+x"))
    measures = tread_measures(outsole.surface, outsole.edges)
    assert measures.channel_width == pytest.approx([1e-3 * width] * 3, abs=0.02e-3)
    assert measures.sipe_count == len(edges) - 2
    assert measures.land_ratio == pytest.approx(1 - width * (len(edges) - 2) / 72, abs=0.002)


def test_a_scan_and_a_plain_sole_have_no_lines(tmp_path):
    plain = tmp_path / "plain.stl"
    write_sole(replace(HEEL, tread=None), plain)
    assert not len(outsole_from_file(plain).edges)
    scan = trimesh.load_mesh(plain).subdivide_to_size(1.0)
    noise = np.random.default_rng(3).normal(0.0, 0.05, scan.vertices.shape)
    scan.vertices = scan.vertices + noise
    scan.export(tmp_path / "scan.stl")
    outsole = outsole_from_file(tmp_path / "scan.stl")
    assert not len(outsole.edges)
    assert not len(outsole.sides)
