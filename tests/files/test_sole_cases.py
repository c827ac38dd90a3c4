"""Valid outsole files of known geometry: the right value from each, or a refusal that says why."""

import io
import json
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest

import sole_forms as made
from soles_solved import sole_of_file
from underfoot.core import DataError
from underfoot.shoe.files import FileSettings, Mesh, outsole_from_file, outsole_from_mesh, read_mesh
from underfoot.shoe.tread_measures import tread_measures

FOLDER = Path(__file__).parents[1] / "data" / "soles"
RIGHT = tomllib.loads((FOLDER / "right.toml").read_text())
TOUCHING = ("heel", "heel_of_hexagons", "heel_of_bars", "sole_of_bars", "inset_hexagons")
SLOW = ("ngon", "rel.", "tri.obj", "bare", "sole_components", "sole_half")
FINE = "f1_"  # its land is right within 1 % on the grid of the default alone
CASES = [
    pytest.param(kind, name, marks=[pytest.mark.slow] if name.startswith(SLOW) else [])
    for kind, truth in RIGHT.items()
    for name in truth["files"]
]  # fmt: skip


def test_every_file_has_its_right_value():
    named = {name for truth in RIGHT.values() for name in truth["files"]}
    assert named == {path.name for path in FOLDER.iterdir()} - {"README.md", "right.toml"}


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_a_file_gives_its_right_value(kind, name):
    if name.endswith("3dm"):
        pytest.importorskip("rhino3dm")
    truth = RIGHT[kind]
    fine = name.startswith(FINE)
    settings = None if fine else FileSettings(spacing=0.5e-3)
    solved, told = sole_of_file(FOLDER / name, settings)
    found, measures = solved.outsole, solved.measures
    assert (measures.length * 1e3, measures.width * 1e3) == pytest.approx(truth["size"], abs=0.7)
    assert measures.plan_area * 1e4 == pytest.approx(truth["plan"], rel=0.005)
    assert measures.land_ratio == pytest.approx(truth["land"], rel=truth.get("tolerance", 0.01))
    assert measures.channel_depth[1] * 1e3 == pytest.approx(truth["depth"], abs=0.05)
    assert measures.lug_count == pytest.approx(truth["lugs"], abs=truth.get("more_lugs", 0))
    assert found.forward == truth.get("forward", found.forward)
    text = " ".join((*found.surface.remarks, told))
    assert "ormals" not in text
    if kind in TOUCHING:  # the lugs of others reach into their base
        assert "tolerated" not in text.replace("tolerated, the lowest" * (name[0] == "e"), "")


# Bad input: what the format requires and the file lacks, named, with the remedy


def vertices_without_z():
    return made.package(made.model(made.whole().replace(' z="', ' w="', 1), made.item(1)))


def two_units():
    other = made.model(made.thing(1, made.mesh_xml(made.parts())), "", "inch")
    held = made.thing(3, made.components(made.component(1, path="/3D/a.model")))
    text = made.model(held, made.item(3), more=made.REQUIRED)
    return made.package(text, **{"3D/a.model": other})


def required_extension():
    more = ' xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"'
    more += ' requiredextensions="b"'
    return made.package(made.model(made.whole(), made.item(1), more=more))


def a_circle():
    one = made.thing(1, made.components(made.component(2)))
    two = made.thing(2, made.components(made.component(1)))
    return made.package(made.model(one + two, made.item(1)))


def unfolding():
    objects = made.thing(1, made.mesh_xml([made.lug(0, 0)]))
    for n in range(2, 40):
        objects += made.thing(n, made.components(made.component(n - 1), made.component(n - 1)))
    return made.package(made.model(objects, made.item(39)))


def packed_tightly():
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", b" " * 30_000_000)
    return stream.getvalue()


def a_glb(change):
    asset = made.plain()
    change(asset)
    return asset.glb()


def node_circle(asset):
    asset.json["nodes"][0]["children"] = [0]


def skinned(asset):
    asset.json["nodes"][0]["skin"] = 0


def packed(asset):
    asset.json["extensionsRequired"] = ["EXT_meshopt_compression"]


def packed_alone():
    asset, name = made.plain(), "EXT_meshopt_compression"
    for view in asset.json["bufferViews"]:
        view |= {"buffer": 1, "extensions": {name: {"buffer": 0, "byteLength": 9}}}
    asset.gltf("data:application/octet-stream;base64,AAAA")
    asset.json["buffers"] += [{"byteLength": 9999, "extensions": {name: {"fallback": True}}}]
    return json.dumps(asset.json).encode()


def of_two_numbers(asset):
    position = asset.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    asset.json["accessors"][position]["type"] = "VEC2"


def cut_short(asset):
    asset.json["bufferViews"][0]["byteLength"] += 100_000


BAD = {
    "a vertex lacks z": ("3mf", vertices_without_z, r"vertex 0 of .* lacks one of x, y, z"),
    "two units": ("3mf", two_units, r'contradict each other on the unit: "millimeter" in .*"inch"'),
    "a unit that is none": (
        "3mf",
        lambda: made.package(made.model(made.whole(), made.item(1), "milimeter")),
        r'"milimeter" is no unit.*millimeter',
    ),
    "a required extension": ("3mf", required_extension, "needs the 3MF extension beamlattice"),
    "objects in a circle": ("3mf", a_circle, "hold each other: 1 in 2 in 1"),
    "components that double": ("3mf", unfolding, "unfolds to more than"),
    "an archive that unpacks to a thousand times": ("3mf", packed_tightly, "200 times its size"),
    "no such object": (
        "3mf",
        lambda: made.package(made.model(made.whole(), made.item(7))),
        "has no object 7",
    ),
    "no such part": (
        "3mf",
        lambda: made.package(made.model(made.whole(), made.item(1, path="/3D/b.model"))),
        r'no part "/3D/b.model"',
    ),
    "no objectid": (
        "3mf",
        lambda: made.package(made.model(made.whole(), "<item/>")),
        "no objectid",
    ),
    "a negative volume of Prusa": ("3mf", lambda: made.prusa("NegativeVolume"), "takes material"),
    "a negative part of Bambu": ("3mf", lambda: made.bambu("negative_part"), "takes material"),
    "a kind of volume that is not known": ("3mf", lambda: made.prusa("Magic"), '"magic"'),
    "nothing to be built": ("3mf", lambda: made.package(made.model(made.whole(), "")), "is empty"),
    "only supports": (
        "3mf",
        lambda: made.package(
            made.model(made.thing(1, made.mesh_xml(made.parts()), 'type="support"'), made.item(1))
        ),
        "shows no model: 1 support body",
    ),
    "a required compression": ("glb", lambda: a_glb(packed), "EXT_meshopt_compression"),
    "a compression with a stand-in": ("gltf", packed_alone, "EXT_meshopt_compression"),
    "nodes in a circle": ("glb", lambda: a_glb(node_circle), "its nodes hold each other"),
    "a skin": ("glb", lambda: a_glb(skinned), "a skin that bends the mesh"),
    "a view beyond its buffer": ("glb", lambda: a_glb(cut_short), "reaches beyond its buffer"),
    "corners of two numbers": ("glb", lambda: a_glb(of_two_numbers), "no vectors of three"),
    "a property of no type": (
        "ply",
        lambda: made.ply("ascii").replace(b"property float y", b"property"),
        'the PLY heading has "property"',
    ),
    "numbers that are not there": ("gltf", lambda: made.plain().gltf("a.bin"), '"a.bin" is not'),
    "free-form surfaces": (
        "obj",
        lambda: made.obj(tail="surf 0 1 0 1 1 2 3 4"),
        r"free-form surfaces \(surf\)",
    ),
    "a relative index too far back": ("obj", lambda: made.obj(tail="f -9999 -1 -2"), "-9999"),
    "vertex 0": ("obj", lambda: made.obj(tail="f 0 1 2"), "vertex 0; they count from 1"),
    "decimal commas": (
        "obj",
        lambda: made.obj().replace(b".", b","),
        "no OBJ|comma is no decimal point",
    ),
    "a face that crosses itself": (
        "obj",
        lambda: made.obj().replace(b"f 4 3 2 1", b"f 4 2 3 1", 1),
        "crosses itself",
    ),
    "a binary OFF": ("off", lambda: made.off("OFF BINARY\n"), "binary OFF"),
    "an OFF cut short": ("off", lambda: made.off()[:-200], "promises 248 vertices"),
    "a PLY cut short": ("ply", lambda: made.ply("binary_little_endian")[:-50], "it ends within"),
    "a PLY with a nan that signals": (
        "ply",
        lambda: made.ply("binary_little_endian").replace(
            np.float32(32).tobytes(), b"\x01\x00\xa0\x7f", 1
        ),
        "is no number",
    ),
    "a text STL with decimal commas": (
        "stl",
        lambda: made.text_stl({"a": made.triangles()}).replace(b".", b","),
        "decimal commas",
    ),
    "a text STL cut short between facets": (
        "stl",
        lambda: made.text_stl({"a": made.triangles()}, end=False).rpartition(b"  facet normal")[0],
        "endsolid, and they leave its surface open",
    ),
    "single precision far off": (
        "stl",
        lambda: made.stl(made.triangles() + 3e7),
        "single precision loses the tread",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_named_with_the_remedy(tmp_path, name):
    ending, make, words = BAD[name]
    path = tmp_path / f"sole.{ending}"
    path.write_bytes(make())
    with pytest.raises(DataError, match=words) as caught:
        outsole_from_file(path)
    assert caught.value.remedy
    assert [each.name for each in tmp_path.iterdir()] == [path.name]


def test_what_a_file_may_do_without_is_told_in_a_field(tmp_path):
    asset = made.plain()
    asset.json["extensionsUsed"] = ["VENDOR_folded_mesh"]
    path = tmp_path / "sole.glb"
    path.write_bytes(asset.glb())
    (unmet,) = read_mesh(path).unmet
    assert unmet.what == "extension VENDOR_folded_mesh"
    assert not unmet.required


# What is a sole among bodies


def found(bodies, **options):
    corners = [made.triangles(one) for one in bodies.values()]
    owner = np.repeat(np.arange(len(corners)), [len(one) for one in corners])
    mesh = Mesh(np.concatenate(corners).astype(np.float32), "made here", 1e-3,
                bodies=tuple(bodies), body=owner.astype(np.int32))  # fmt: skip
    return outsole_from_mesh(mesh, FileSettings(spacing=0.5e-3, **options))


def block(low, high, margin=0.0):
    ring = [(-margin, -32 - margin), (80 + margin, -32 - margin), (80 + margin, 32 + margin),
            (-margin, 32 + margin)]  # fmt: skip
    return made.prism(np.array(ring, float), low, high)


def half_base(side):
    low, high = (0, 40) if side == 0 else (40, 80)
    ring = [(low, -32), (high, -32), (high, 32), (low, 32)]
    return made.prism(np.array(ring, float), 4.0, 9.0)


def shifted(bodies, z):
    return [(points + np.array([0, 0, z]), faces) for points, faces in bodies]


EACH = {f"l{n}": [one] for n, one in enumerate(made.all_lugs())}
BODIES = {
    "base and lugs": {"a": [made.base()], "b": made.all_lugs()},
    "base and each lug": {"a": [made.base()], **EACH},
    "lugs named rubber": {"base TPU": [made.base()], "lugs rubber": made.all_lugs()},
    "lugs named outsole on a midsole": {"Midsole": [made.base()], "Outsole": made.all_lugs()},
    "lugs 0.05 mm off": {"a": [made.base()], "b": shifted(made.all_lugs(), -0.05)},
    "lugs sunk in": {"a": [made.base()], "b": shifted(made.all_lugs(), 0.3)},
    "lugs of two colours": {
        "a": [made.base()], "b": made.all_lugs()[:10], "c": made.all_lugs()[10:],
    },
    "base of two colours": {"a": [half_base(0)], "b": [half_base(1)], "c": made.all_lugs()},
    "on a table": {"a": [made.base()], "b": made.all_lugs(), "c": [block(-20, 0, 60)]},
    "each lug, on a table": {
        "a": [made.base()], "c": [block(-20, 0, 60)], **EACH,
    },
    "one sole on a table": {"a": made.parts(), "c": [block(-20, 0, 60)]},
    "with a midsole above": {"a": [made.base()], "b": made.all_lugs(), "c": [block(9, 30)]},
    "all in layers, no names": {
        "a": [made.base()], "b": made.all_lugs(), "c": [block(9, 30)], "d": [block(30, 45)],
    },
}  # fmt: skip


ON_ITS_HEAD = ("base and each lug", "one sole on a table", "all in layers, no names")


@pytest.mark.parametrize(
    ("name", "turned"), [*((n, False) for n in BODIES), *((n, True) for n in ON_ITS_HEAD)]
)
def test_a_sole_among_bodies_is_told_by_contact(name, turned):
    bodies = BODIES[name]
    if turned:  # on its head: down is +z of the file
        bodies = {
            key: [(points * (1, -1, -1), faces) for points, faces in one]
            for key, one in bodies.items()
        }
    outsole = found(bodies)
    measures = tread_measures(outsole.surface)
    deep = {"lugs 0.05 mm off": 4.05, "lugs sunk in": 3.7}.get(name, 4.0)
    assert measures.land_ratio == pytest.approx(made.LAND, rel=0.01)
    assert measures.channel_depth[1] * 1e3 == pytest.approx(deep, abs=0.05)
    assert measures.lug_count == made.LUGS
    assert outsole.down == ("+z" if turned else "-z")


def test_lugs_alone_are_no_answer():
    with pytest.raises(DataError, match=r"20 parts are all land, with open channels around"):
        found({"a": made.all_lugs()})
    with pytest.raises(DataError, match=r"20 parts are all land, with open channels around"):
        found({"a": [made.base()], "b": made.all_lugs()}, solid="b")


def fans():
    """The faces of a sole, cut as if concave polygons were convex."""
    points, faces = made.joined(made.parts())
    turned = [face[1:] + face[:1] if len(face) == 6 else face for face in faces]
    return points[[[f[0], f[n], f[n + 1]] for f in turned for n in range(1, len(f) - 1)]]


def of_faces(corners):
    return outsole_from_mesh(
        Mesh(np.asarray(corners, dtype=np.float32), "made here", 1e-3), FileSettings(spacing=0.5e-3)
    )


def at(corners, height):
    return (corners[:, :, 2] == height).all(axis=1)


def mixed_corners(corners):
    generator = np.random.default_rng(1)
    points = corners.reshape(-1, 3).copy()
    some = generator.choice(len(points), len(points) // 10, replace=False)
    points[some] = points[generator.permutation(some)]
    return points.reshape(-1, 3, 3)


def one_turned(corners):
    return np.concatenate([corners[:1, ::-1], corners[1:]])


WHOLE = made.triangles()
GROUND = np.flatnonzero(at(WHOLE, 0))
UNSOUND = {
    "fans": (fans(), "faces lie double"),
    "fans, a face twice": (np.concatenate([fans(), fans()[:1]]), "faces lie double"),
    "fans, a face turned": (one_turned(fans()), "faces lie double"),
    "fans, open above": (fans()[~at(fans(), 9)], "faces lie double"),
    "half the ground": (np.delete(WHOLE, GROUND[::2], 0), "ground side are missing"),
    "two lugs without ground": (np.delete(WHOLE, GROUND[:8], 0), "ground side are missing"),
    "the same, inside out": (np.delete(WHOLE, GROUND[:8], 0)[:, ::-1], "ground side are missing"),
    "mixed corners, faces twice": (
        np.concatenate([mixed_corners(WHOLE), mixed_corners(WHOLE)[:5]]), "lines through it",
    ),
}  # fmt: skip
HEALTHY = {
    "twice": np.concatenate([WHOLE, WHOLE]),
    "twice, once turned": np.concatenate([WHOLE, WHOLE[:, ::-1]]),
    "every second face turned": np.where(np.arange(len(WHOLE))[:, None, None] % 2, WHOLE,
                                         WHOLE[:, ::-1]),
    "ground turned": np.where(at(WHOLE, 0)[:, None, None], WHOLE[:, ::-1], WHOLE),
    "open above": WHOLE[~at(WHOLE, 9)],
    "no walls": WHOLE[np.ptp(WHOLE[:, :, 2], axis=1) == 0],
}  # fmt: skip


@pytest.mark.parametrize("name", UNSOUND)
def test_a_sole_whose_parts_disagree_is_refused(name):
    corners, words = UNSOUND[name]
    with pytest.raises(DataError, match=words) as caught:
        of_faces(corners)
    assert caught.value.remedy


@pytest.mark.parametrize("name", HEALTHY)
def test_turned_repeated_and_open_faces_change_nothing(name):
    measures = tread_measures(of_faces(HEALTHY[name]).surface)
    assert measures.land_ratio == pytest.approx(made.LAND, rel=0.01)
    assert measures.channel_depth[1] == pytest.approx(4e-3, abs=0.05e-3)
