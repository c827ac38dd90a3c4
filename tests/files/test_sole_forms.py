"""One sole in every form of its format: the same land and depth, and nothing to be warned of."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import sole_forms as made
from soles_solved import sole_of_file
from underfoot.core import DataError
from underfoot.shoe.files import FileSettings, outsole_from_file, read_mesh
from underfoot.shoe.files.polygons import triangulate_polygons
from underfoot.shoe.tread_measures import tread_measures

HALF = FileSettings(spacing=0.5e-3)


def written(folder, ending, data):
    data = data(folder) if callable(data) else data
    files = data if isinstance(data, dict) else {"": data}
    for name, content in files.items():
        (folder / (name or f"sole.{ending}")).write_bytes(content)
    return folder / f"sole.{ending}"


def form(folder, name):
    ending, make = made.FORMS[name]
    if ending == "3dm":
        pytest.importorskip("rhino3dm")
    if "draco" in name:
        pytest.importorskip("DracoPy")
    return written(folder, ending, make(folder) if ending == "3dm" else make())


@pytest.mark.parametrize("name", made.FORMS)
def test_every_form_of_a_sole_is_the_same_sole(tmp_path, name):
    solved, told = sole_of_file(form(tmp_path, name), HALF)
    found, measures = solved.outsole, solved.measures
    assert measures.land_ratio == pytest.approx(made.LAND, rel=0.01)
    assert measures.channel_depth[1] * 1e3 == pytest.approx(made.DEPTH, abs=0.05)
    assert measures.lug_count == made.LUGS
    assert (measures.length, measures.width) == pytest.approx((0.080, 0.064), abs=0.5e-3)
    assert found.thickness == pytest.approx(9e-3, abs=0.05e-3)
    text = " ".join((*found.surface.remarks, told))
    assert "tolerated" not in text
    assert "ignored" not in text


@pytest.mark.parametrize(
    ("joined_lugs", "top", "roof", "as_bodies"),
    [
        (False, 5.0, 3.0, False),
        (True, 5.0, 4.5, True),
        (False, 7.5, 6.0, True),
        (True, 7.5, 6.0, False),
    ],
)
def test_hollow_bodies_that_reach_into_each_other_are_one_sole(
    tmp_path, joined_lugs, top, roof, as_bodies
):
    lugs = made.hollow_lugs(top, roof)
    bodies = [made.hollow_base(), *([made.joined(lugs)] if joined_lugs else lugs)]
    data = made.obj(bodies, group="o body{}".format) if as_bodies else made.stl(
        made.triangles(bodies)
    )  # fmt: skip
    found = outsole_from_file(written(tmp_path, "obj" if as_bodies else "stl", data), HALF)
    measures = tread_measures(found.surface)
    assert measures.land_ratio == pytest.approx(made.LAND, rel=0.01)
    assert measures.channel_depth[1] * 1e3 == pytest.approx(made.DEPTH, abs=0.05)
    assert measures.lug_count == made.LUGS
    assert found.thickness == pytest.approx(9e-3, abs=0.05e-3)
    assert "plate" not in " ".join(found.surface.remarks)


def test_a_midsole_says_where_the_ground_is_though_the_back_has_ribs(tmp_path):
    ribs = [made.prism(np.array([(x, -30), (x + 3, -30), (x + 3, 30), (x, 30)], float), 9.0, 12.0)
            for x in range(4, 76, 9)]  # fmt: skip
    slab = made.prism(np.array([(0, -32), (80, -32), (80, 32), (0, 32)], float), 12.0, 25.0)
    bodies = [made.joined([made.base(), *ribs]), slab]
    for name, down in (("Midsole", "-z"), ("Floor", "+z")):
        data = made.obj(bodies, group=lambda n, other=name: f"o {('Outsole', other)[n]}")
        found = outsole_from_file(written(tmp_path, "obj", data), HALF)
        assert found.down == down
        flipped = outsole_from_file(
            tmp_path / "sole.obj", FileSettings(spacing=0.5e-3, down="flip")
        )
        assert flipped.down != down


def test_sixty_forms_and_more():
    assert len(made.FORMS) > 90


# lib3mf is an oracle for what it reads; what slicers say beside the format is not its business
SLICERS = ("Prusa", "Bambu", "Cura", "printed")
REFUSED = ("3mf: UTF-16", "3mf: a path on the item")
ORACLE = [
    name
    for name in made.FORMS
    if name.startswith("3mf") and name not in REFUSED and not any(one in name for one in SLICERS)
]


@pytest.mark.parametrize("name", REFUSED)
def test_what_the_library_of_3mf_refuses_is_still_that(tmp_path, name):
    lib3mf = pytest.importorskip("lib3mf")
    reader = lib3mf.get_wrapper().CreateModel().QueryReader("3mf")
    with pytest.raises(lib3mf.ELib3MFException):
        reader.ReadFromFile(str(form(tmp_path, name)))


@pytest.mark.parametrize("name", ORACLE)
def test_3mf_holds_what_its_own_library_reads(tmp_path, name):
    lib3mf = pytest.importorskip("lib3mf")
    path = form(tmp_path, name)
    library = lib3mf.get_wrapper()
    model = library.CreateModel()
    reader = model.QueryReader("3mf")
    reader.ReadFromFile(str(path))
    low, high, count = np.full(3, np.inf), np.full(3, -np.inf), 0
    items = model.GetBuildItems()
    while items.MoveNext():
        one = items.GetCurrent()
        each = one.GetObjectResource()
        if each.GetType() != lib3mf.ObjectType.Model:
            continue
        for mesh, place in _unfolded(lib3mf, each, _matrix(one.GetObjectTransform())):
            points = np.array([v.Coordinates for v in mesh.GetVertices()])
            points = points @ place[:3] + place[3]
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
            count += mesh.GetTriangleCount()
    mesh = read_mesh(path)
    assert mesh.triangles.shape[0] == count
    corners = mesh.triangles.reshape(-1, 3)
    assert np.ptp(corners, axis=0) == pytest.approx(high - low, rel=1e-5)


def _matrix(transform):
    return np.array([list(row) for row in transform.Fields])


def _unfolded(lib3mf, each, place):
    if each.IsMeshObject():
        yield each, place
        return
    for n in range(each.GetComponentCount()):
        one = each.GetComponent(n)
        inner = _matrix(one.GetTransform()) if one.HasTransform() else np.eye(4, 3, 0)
        own = np.vstack([inner[:3] @ place[:3], inner[3] @ place[:3] + place[3]])
        yield from _unfolded(lib3mf, one.GetObjectResource(), own)


@st.composite
def stars(draw):
    """A plane polygon that does not cross itself, anywhere in space, and its area."""
    radii = draw(st.lists(st.floats(0.2, 1.0), min_size=4, max_size=40))
    angle = np.arange(len(radii)) * 2 * np.pi / len(radii)
    ring = np.array(radii)[:, None] * np.c_[np.cos(angle), np.sin(angle)]
    x, y = ring.T
    area = (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2
    turn = np.linalg.qr(np.array(draw(st.lists(st.floats(-1, 1), min_size=9, max_size=9))
                                 ).reshape(3, 3) + 3 * np.eye(3))[0]  # fmt: skip
    return np.c_[ring, np.zeros(len(ring))] @ turn.T + draw(st.floats(-1e3, 1e3)), area


def _area(points, faces):
    sides = points[faces][:, 1:] - points[faces][:, :1]
    return np.cross(sides[:, 0], sides[:, 1]) / 2


@settings(max_examples=60, deadline=None)
@given(star=stars(), start=st.integers(0, 40), back=st.booleans())
def test_a_polygon_has_its_area_whichever_corner_comes_first(star, start, back):
    points, area = star
    ring = np.roll(np.arange(len(points)), start)[:: -1 if back else 1]
    faces = triangulate_polygons(points, np.array([len(ring)]), ring, "OBJ", "made here")
    own = _area(points, faces)
    assert len(faces) == len(ring) - 2
    assert np.linalg.norm(own, axis=1).sum() == pytest.approx(area, rel=1e-6)
    # the faces look where the polygon does
    whole = np.cross(points[ring], np.roll(points[ring], -1, axis=0)).sum(axis=0) / 2
    assert own.sum(axis=0) == pytest.approx(whole, abs=1e-6 * max(1, np.abs(whole).max()))


def test_corners_that_do_not_turn_keep_their_edges():
    points = np.array([(0, 0), (1, 0), (2, 0), (4, 0), (4, 4), (2, 4), (0, 4), (0, 2)], float)
    points = np.c_[points, np.zeros(8)]
    faces = triangulate_polygons(points, np.array([8]), np.arange(8), "OFF", "made here")
    edges = {tuple(sorted(edge)) for a, b, c in faces for edge in ((a, b), (b, c), (c, a))}
    assert all(tuple(sorted((k, (k + 1) % 8))) in edges for k in range(8))
    assert (np.linalg.norm(_area(points, faces), axis=1) > 0).all()


KEYHOLE = np.array([(0, 0), (10, 0), (10, 10), (0, 10), (0, 0), (3, 3), (3, 6), (6, 6), (6, 3),
                    (3, 3)], float)  # fmt: skip


def test_a_polygon_around_a_hole_is_cut_around_it():
    points = np.c_[KEYHOLE, np.zeros(10)]
    faces = triangulate_polygons(points, np.array([10]), np.arange(10), "OBJ", "made here")
    assert np.linalg.norm(_area(points, faces), axis=1).sum() == pytest.approx(91)


@pytest.mark.parametrize(
    "ring",
    [
        [(0, 0), (2, 2), (2, 0), (0, 2)],
        [(0, 0), (4, 0), (4, 4), (1, -1), (0, 4)],
        [(np.cos(a), np.sin(a)) for a in 4 * np.pi / 5 * np.arange(5)],
    ],
)
def test_a_polygon_that_crosses_itself_is_named(ring):
    points = np.c_[np.array(ring, float), np.zeros(len(ring))]
    with pytest.raises(DataError, match=rf"face 1, a polygon of {len(ring)} corners, crosses"):
        triangulate_polygons(
            points, np.array([len(ring)]), np.arange(len(ring)), "OBJ", "made here"
        )


@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    start=st.integers(0, 5),
    relative=st.booleans(),
    number=st.sampled_from(["{:.4f}", "{:.7e}", "{:+.5E}", "{:g}"]),
    corner=st.sampled_from(["{}", "{}/1", "{}//1", "{}/1/1"]),
    more=st.sampled_from(["", " 1.0", " 0.5 0.5 0.5"]),
    newline=st.sampled_from(["\n", "\r\n", "\r"]),
    gap=st.sampled_from([" ", "  ", "\t", " \\\n"]),
    grouped=st.booleans(),
)
def test_an_obj_of_any_style_has_the_same_faces(
    tmp_path, start, relative, number, corner, more, newline, gap, grouped
):
    head = "vt 0 0" + newline + "vn 0 0 1"
    group = (lambda n: f"g part{n}") if grouped else None
    data = made.obj(start=start, relative=relative, number=number.format, corner=corner, more=more,
                    newline=newline, gap=gap, group=group, head=head)  # fmt: skip
    mesh = read_mesh(written(tmp_path, "obj", data))
    sides = mesh.triangles[:, 1:] - mesh.triangles[:, :1]
    normal = np.cross(sides[:, 0], sides[:, 1]) / 2
    assert len(mesh.triangles) == len(made.triangles())
    # base: both sides; lugs: both sides of an L of 75 mm^2
    assert np.abs(normal[:, 2]).sum() == pytest.approx(2 * 5120 + 20 * 2 * 75, rel=1e-5)
    assert normal.sum(axis=0) == pytest.approx([0, 0, 0], abs=1e-2)
