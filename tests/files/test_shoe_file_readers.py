"""Outsole files of every kind and every defect, made here and read back."""

import numpy as np
import pytest
import trimesh

from outsole_bodies import (
    flat,
    grooved,
    heel_body,
    sole_body,
    triangles,
    turned,
    write_stl,
)
from soles_solved import sole_of_file, sole_of_mesh
from underfoot.core import DataError, InputError
from underfoot.shoe import surface_map
from underfoot.shoe.files import FileSettings, Mesh, outsole_from_file
from underfoot.shoe.files.read import read_mesh
from underfoot.shoe.tread_measures import tread_measures

COARSE = FileSettings(spacing=0.5e-3)


@pytest.fixture(scope="module")
def heel():
    return triangles(heel_body())


@pytest.fixture(scope="module")
def sole():
    return triangles(sole_body())


@pytest.fixture(scope="module")
def plain_heel(heel):
    return read(heel)


@pytest.fixture(scope="module")
def plain_sole(sole):
    return read(sole)


def read(corners, settings=COARSE, unit=None):
    mesh = Mesh(np.asarray(corners, np.float32), "made here", unit)
    return sole_of_mesh(mesh, settings).outsole


def said(outsole):
    return " ".join(outsole.surface.remarks)


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "obj", "ply"])
def test_every_mesh_format_holds_the_same_outsole(tmp_path, heel, plain_heel, kind):
    path = tmp_path / f"heel.{kind.removesuffix('_ascii')}"
    mesh = trimesh.Trimesh(heel.reshape(-1, 3), np.arange(heel.size // 3).reshape(-1, 3))
    if kind == "stl":
        write_stl(path, heel)
    else:
        path.write_bytes(_exported(mesh, kind))
    found = sole_of_file(path, COARSE)[0].outsole
    assert found.faces == heel.shape[0]
    height = plain_heel.surface.height
    assert found.surface.height.shape == height.shape
    assert np.allclose(found.surface.height, height, atol=2e-6, equal_nan=True)


def _exported(mesh, kind):
    data = mesh.export(file_type=kind)
    return data if isinstance(data, bytes) else data.encode()


def test_height_map_is_the_body_it_was_made_from(heel):
    surface = read(heel, FileSettings(spacing=0.25e-3)).surface
    x, y = np.meshgrid(surface.x, surface.y, indexing="ij")
    exact = grooved()(x, y)
    # before the round rear, and away from walls, which one row of triangles makes slanted
    clear = surface.inside & (x > 27e-3)
    for value, pitch in ((x, 10e-3), (y + 3e-3, 10e-3)):
        place = np.mod(value, pitch)
        clear &= (np.minimum(place, pitch - place) > 6e-4) & (np.abs(place - 6e-3) > 6e-4)
    assert clear.sum() > 10_000
    assert np.abs(surface.height - exact)[clear].max() < 2e-6
    assert np.array_equal(surface.land[clear], exact[clear] == 0)
    assert surface.length == pytest.approx(0.060, abs=0.3e-3)
    assert surface.width == pytest.approx(0.060, abs=0.3e-3)


@pytest.mark.parametrize(("unit", "metres"), [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0)])
def test_unit_is_found_from_the_length(sole, unit, metres):
    found = read(sole * (1e-3 / metres), FileSettings(spacing=1e-3))
    assert found.unit == metres
    assert f"unit {unit} (" in said(found)
    assert found.whole_length == pytest.approx(0.28, abs=1e-3)


def test_inches_are_found_and_can_be_overruled(sole):
    inches = sole / 25.4
    assert read(inches, FileSettings(spacing=1e-3)).unit == pytest.approx(0.0254)
    with pytest.raises(InputError, match=r"in m the sole is 11\.0. m long.*in inch"):
        read(inches, FileSettings(unit="m", spacing=5e-4))


def test_length_of_no_sole_in_any_unit_is_refused(sole):
    with pytest.raises(InputError, match=r"no unit makes it a sole.*110 to 350 mm"):
        read(sole * 7.0)


@pytest.mark.parametrize("angles", [(np.pi, 0, 0), (0.4, -0.7, 2.0), (2.6, 0.5, -1.1)])
def test_lie_in_the_file_does_not_matter(sole, plain_sole, angles):
    plain, found = plain_sole, read(turned(sole, angles))
    assert found.foot == "right"
    assert tread_measures(found.surface).land_ratio == pytest.approx(
        tread_measures(plain.surface).land_ratio, abs=0.02
    )
    assert found.surface.length == pytest.approx(plain.surface.length, abs=2e-3)
    assert found.surface.width == pytest.approx(plain.surface.width, abs=2e-3)
    # the toe spring stays: the plane is that of the lowest lugs, not a fit to everything
    for one in (plain, found):
        land = np.where(one.surface.land, one.surface.height, np.nan)
        assert np.nanmax(land[-20:]) > 6e-3
        assert abs(np.nanmedian(land[: land.shape[0] // 2])) < 0.1e-3


def test_left_and_right_are_told_apart_and_mirrored():
    left = read(triangles(sole_body(right=False)), FileSettings(spacing=1e-3))
    assert left.foot == "left"
    other = read(triangles(sole_body()), FileSettings(spacing=1e-3, mirror=True))
    assert other.foot == "left"
    assert np.mean(left.surface.inside != other.surface.inside) < 0.01


def test_upside_down_by_hand_is_smooth_and_said(heel):
    found = read(heel, FileSettings(down="flip", spacing=5e-4))
    assert "turned over" in said(found)
    assert found.surface.land_ratio == 1.0
    assert read(heel, FileSettings(down="+z", spacing=5e-4)).surface.land_ratio == 1.0
    assert read(heel, FileSettings(down="-z", spacing=5e-4)).surface.land_ratio < 0.6


def test_heel_and_forepart_are_cut_from_a_whole_sole(sole):
    heel = read(sole, FileSettings(region="heel", spacing=5e-4))
    assert heel.surface.length == pytest.approx(0.3 * 0.28, abs=1e-3)
    assert "Cut to the rear" in said(heel)
    toe = read(sole, FileSettings(region="forepart", region_length=0.1, spacing=5e-4))
    assert toe.surface.length == pytest.approx(0.1, abs=1e-3)
    assert np.nanmax(toe.surface.height) > 6e-3
    with pytest.raises(InputError, match="the sole only 280 mm"):
        read(sole, FileSettings(region="heel", region_length=0.4, spacing=1e-3))


def test_heel_piece_has_no_forepart(heel):
    with pytest.raises(InputError, match="no forepart"):
        read(heel, FileSettings(region="forepart", spacing=5e-4))


def test_holes_of_a_scan_are_filled_and_said(heel, plain_heel):
    centre = heel.mean(axis=1)
    hole = (np.hypot(centre[:, 0] - 33, centre[:, 1]) < 2) & (centre[:, 2] < 10)
    plain, found = plain_heel, read(heel[~hole])
    assert "open edges were tolerated" in said(found)
    # through the hole one sees the far side of the body: it is no gap in the height map of a body
    scan = heel[(heel[:, :, 2] < 10).all(axis=1) & ~hole]
    open_scan = read(scan, FileSettings(down="-z", spacing=5e-4))
    assert "filled from the surface around" in said(open_scan)
    assert open_scan.surface.inside.sum() == plain.surface.inside.sum()
    assert open_scan.thickness is None


def test_inverted_normals_are_tolerated_and_said(heel, plain_heel):
    found = read(heel[:, ::-1])
    assert "normals point inward" in said(found)
    assert np.array_equal(found.surface.land, plain_heel.surface.land)


def test_crossing_bodies_are_tolerated_and_said(heel, plain_heel):
    shifted = heel + np.float32([2.0, 1.0, 3.5])
    found = read(np.concatenate([heel, shifted]))
    assert "crosses itself, or bodies overlap" in said(found)
    assert "crosses itself" not in said(plain_heel)


@pytest.mark.parametrize("shared", ["a corner", "an edge", "a face"])
def test_overlapping_bodies_may_share_corners_edges_and_faces(shared):
    """A plate and bars sunk into it, each a closed body: no surface crosses itself."""
    first = {"a corner": (60, 12), "an edge": (70, 12), "a face": (70, 8)}[shared]
    boxes = [((0, 0, 4), (76, 70, 12)), ((0, 0, 0), (6, first[0], first[1]))]
    boxes += [((x, 0, 0), (x + 6, 70, 9)) for x in range(10, 80, 10)]
    if shared == "a face":
        boxes.append(((0, 0, 8), (6, 70, 12)))
    bodies = [trimesh.creation.box(bounds=each).triangles for each in boxes]
    outsole = read(np.concatenate(bodies))
    assert "bodies overlap, on" in said(outsole)
    land = sum((b[0] - a[0]) * (b[1] - a[1]) for a, b in boxes if a[2] == 0) / (76 * 70)
    assert outsole.surface.land_ratio == pytest.approx(land, abs=0.005)


def test_a_mesh_whose_corners_are_mixed_up_is_refused():
    corners, faces = heel_body()
    part = faces[: len(faces) // 3]
    part[:] = np.minimum(part + 300, len(corners) - 1)
    with pytest.raises(DataError, match="the surface crosses itself on 1"):
        read(1e3 * corners[faces])


def test_copies_slivers_and_broken_corners_are_counted(heel):
    broken = heel[:2].copy()
    broken[0, 0] = np.nan
    broken[1, 1] = broken[1, 0]
    found = read(np.concatenate([heel, heel[5:8], broken]))
    assert found.soundness.duplicates == 3
    assert found.soundness.degenerate == 1
    assert found.soundness.not_finite == 1
    assert {"there twice", "without area", "not a number"} <= {
        words for words in ("there twice", "without area", "not a number") if words in said(found)
    }


def test_stray_pieces_and_spikes_do_not_carry_the_sole(heel):
    far = np.float32([[[30, 45, 0], [31, 45, 0], [30, 46, 0]]])
    spike = np.float32([[[30, 0, -6], [30.3, 0, 1], [30, 0.3, 1]]])
    found = read(np.concatenate([heel, far, spike]), FileSettings(unit="mm", spacing=0.1e-3))
    assert "beside the sole left out" in said(found)
    assert np.nanmin(found.surface.height) > -0.2e-3


def test_ledge_of_a_welt_is_no_part_of_the_plan_form():
    def welted(x, y):
        return np.where(np.abs(y) > 27e-3, 8e-3, grooved()(x, y))

    found = read(triangles(heel_body(welted)))
    assert "ledge along the rim" in said(found)
    assert found.surface.width == pytest.approx(0.054, abs=1.5e-3)


def test_step_solid_and_surfaces_only(tmp_path):
    occ = pytest.importorskip("netgen.occ")
    body = occ.Box((0, 0, 0), (64, 60, 15))
    for start in (10, 25, 40):
        body = body - occ.Box((start, -1, -1), (start + 4, 61, 3))
    solid, faces = tmp_path / "solid.step", tmp_path / "faces.stp"
    body.WriteStep(str(solid))
    occ.Compound(list(body.faces)).WriteStep(str(faces))
    for path, words in ((solid, "1 solid"), (faces, "no solid")):
        found = outsole_from_file(path, FileSettings(spacing=0.5e-3))
        assert words in said(found)
        assert found.unit == 1e-3
        measures = tread_measures(found.surface)
        assert measures.land_ratio == pytest.approx(1 - 12 / 64, abs=0.01)
        assert measures.channel_depth[1] == pytest.approx(3e-3, abs=1e-5)
        assert measures.channel_width[1] == pytest.approx(4e-3, abs=0.26e-3)
    lines = occ.Compound(list(body.edges))
    curves = tmp_path / "curves.step"
    lines.WriteStep(str(curves))
    with pytest.raises(DataError, match=r"no surfaces|can't be read"):
        read_mesh(curves)


def test_step_in_metres_is_converted(tmp_path):
    occ = pytest.importorskip("netgen.occ")
    path = tmp_path / "metres.step"
    occ.Box((0, 0, 0), (0.064, 0.06, 0.015)).WriteStep(str(path))
    text = path.read_text()
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    path.write_text(text.replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"))
    assert outsole_from_file(path, COARSE).surface.length == pytest.approx(0.064, abs=1e-3)


def test_content_decides_not_the_ending(tmp_path, heel):
    path = tmp_path / "heel.obj"
    write_stl(path, heel)
    found = outsole_from_file(path, COARSE)
    assert "named .obj but holds STL" in said(found)
    bare = tmp_path / "heel"
    write_stl(bare, heel)
    assert read_mesh(bare).format == "STL (binary)"


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("empty.stl", b"", "the file is empty"),
        ("letter.stl", b"Dear Sir, please find enclosed our new sole.\n" * 9, "holds no STL"),
        ("notes.txt", b"v is for victory\n" * 9, "is not read"),
        ("bare.step", b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\n", "STEP"),
        ("points.ply", b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
         b"property float y\nproperty float z\nend_header\n0 0 0\n1 1 1\n", "points and no faces"),
        ("cut.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 900\n"
         b"property float x\nproperty float y\nproperty float z\nelement face 300\n"
         b"property list uchar int vertex_indices\nend_header\n\0\0\0\0", "PLY"),
        ("wrong.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "OBJ"),
        ("none.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces"),
        ("nothing.stl", b"solid x\nendsolid x\n", "no faces"),
        ("number.stl", b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\nvertex 1 0 0\n"
         b"vertex 0 1 0\nendloop\nendfacet\nendsolid x\n", "line .* 4: vertex 0 zero 0"),
    ],
)  # fmt: skip
def test_files_that_hold_no_outsole_are_refused_in_words(tmp_path, name, content, words):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises((DataError, InputError), match=words) as caught:
        read_mesh(path)
    assert name in str(caught.value)


def test_truncated_stl_tells_how_much_is_there(tmp_path, heel):
    whole = write_stl(tmp_path / "whole.stl", heel).read_bytes()
    cut = tmp_path / "cut.stl"
    cut.write_bytes(whole[: 84 + 50 * 1000 + 7])
    with pytest.raises(DataError, match=rf"promises {heel.shape[0]} faces and holds 1000"):
        read_mesh(cut)
    text = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {a} {b} {c}\n" for a, b, c in one)
        + "endloop\nendfacet\n"
        for one in heel[:50]
    )
    (tmp_path / "text.stl").write_text("solid x\n" + text[: text.rindex("vertex") + 9])
    with pytest.raises(DataError, match="cut short"):
        read_mesh(tmp_path / "text.stl")


def test_mesh_without_area_and_missing_file(tmp_path):
    with pytest.raises(DataError, match="none of its 4 faces has an area"):
        read(np.ones((4, 3, 3)))
    (tmp_path / "my_sole.stl").write_bytes(b"x")
    with pytest.raises(InputError, match=r'there is no file.*Did you mean "my_sole.stl"'):
        read_mesh(tmp_path / "my_soel.stl")
    with pytest.raises(InputError, match="is a folder"):
        read_mesh(tmp_path)


def test_settings_that_contradict_themselves():
    with pytest.raises(InputError, match="lie on one axis"):
        FileSettings(down="-z", forward="+z")
    with pytest.raises(InputError, match=r'unknown unit "milimeter".*mm'):
        FileSettings(unit="milimeter")
    with pytest.raises(InputError, match="finer than any tread"):
        FileSettings(spacing=1e-6)


def test_channels_below_the_grid_are_refused_or_marked():
    surface = read(
        triangles(heel_body(grooved(width=2e-3, pitch=6e-3), step=0.25e-3)),
        FileSettings(spacing=0.25e-3),
    ).surface
    with pytest.raises(InputError, match=r"channel area.*at least 2 cells"):
        surface_map(surface, shoe_angle=0.1, spacing=1.4e-3)
    marked = surface_map(surface, shoe_angle=0.1, spacing=0.7e-3)
    assert any("channels" in breach.quantity for breach in marked.breaches)
    assert not surface_map(surface, shoe_angle=0.1, spacing=0.4e-3).breaches


def test_untreaded_sole_says_what_it_assumed():
    found = read(triangles(heel_body(flat)))
    assert "Assumed: the ground side is the lower one of the file" in said(found)
    measures = tread_measures(found.surface)
    assert measures.land_ratio == 1.0
    assert measures.channel_width is None
    assert measures.drained_share is None


@pytest.mark.slow
def test_five_million_faces_are_read(tmp_path):
    rows, columns = 2500, 1000
    x, y = np.meshgrid(np.linspace(0, 0.3, rows), np.linspace(-0.05, 0.05, columns), indexing="ij")
    rng = np.random.default_rng(1)
    z = grooved()(x, y) + rng.normal(0, 20e-6, x.shape)
    points = (np.stack([x, y, z], axis=-1) * 1e3).astype(np.float32)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    corners = np.concatenate([np.stack([a, d, c], -2), np.stack([a, c, b], -2)])
    path = write_stl(tmp_path / "large.stl", corners.reshape(-1, 3, 3))
    found = outsole_from_file(path)
    assert found.faces == 2 * (rows - 1) * (columns - 1) > 4.9e6
    # the map holds the noise of the scan, whose heights it takes at points
    assert "noise of" in said(found)
    measures = tread_measures(found.surface)
    assert measures.land_ratio == pytest.approx(0.36, abs=0.01)
    assert 4e-3 < measures.channel_width[1] < 4.5e-3  # wider where channels cross
