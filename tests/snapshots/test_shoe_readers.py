"""Soles in every format as they are read, and what a damaged or odd file is answered."""

import struct
from pathlib import Path

import numpy as np
import pytest

import sole_forms as made
from snapshot import held, refusal, tried
from underfoot.shoe.files.gltf import read_gltf, strip_faces
from underfoot.shoe.files.mesh import FileBody, MeshFile, Unmet, assemble_mesh
from underfoot.shoe.files.ply import read_ply
from underfoot.shoe.files.polygons import triangulate_polygons
from underfoot.shoe.files.read import read_mesh
from underfoot.shoe.files.rhino import read_rhino
from underfoot.shoe.files.stl import looks_like_stl, read_stl
from underfoot.shoe.files.text_meshes import read_obj, read_off
from underfoot.shoe.files.threemf import read_3mf

HERE = Path()
ENDINGS = sorted({ending for ending, _ in made.FORMS.values()} - {"3dm"})
PATH = r"(?<=is no XML )\(.*"
"""What the parser says."""


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    """Errors name files without the folder of this run."""
    monkeypatch.chdir(tmp_path)


def written(folder, ending, data):
    folder.mkdir(exist_ok=True)
    for name, content in (data if isinstance(data, dict) else {"": data}).items():
        (folder / (name or f"sole.{ending}")).write_bytes(content)
    return folder / f"sole.{ending}"


@pytest.mark.parametrize("ending", ENDINGS)
def test_forms(file_regression, ending):
    answers = {}
    for number, (name, (kind, make)) in enumerate(made.FORMS.items()):
        if kind == ending and "draco" not in name:
            mesh = read_mesh(written(HERE / str(number), kind, make()))
            answers[name] = {
                "read": mesh, "corner": mesh.triangles[3, 1], "bodies": sorted(mesh.bodies)[:5]
            }  # fmt: skip
    held(file_regression, answers, f"forms {ending}")


PLY = """ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
0 0 0
4 0 0
4 3 0
0 3 0
2 1 5
4 0 1 2 3
3 0 1 4
"""
OFF = "OFF\n5 2 0\n0 0 0\n4 0 0\n4 3 0\n0 3 0\n2 1 5\n4 0 1 2 3\n3 0 1 4\n"
OBJ = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 2 1 5\nf 1 2 3 4\nf 1 2 5\n"
STL = """solid heel
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 4 0 0
vertex 4 3 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 2.5e0 3 0
vertex 1 2 -5
endloop
endfacet
endsolid heel
"""
TEXTS = {
    "ply": (PLY, {
        "as it is": ("", ""), "no vertices": ("property float z", "property float w"),
        "fewer lines": ("3 0 1 4\n", ""), "a vertex too many": ("3 0 1 4", "3 0 1 5"),
        "no number": ("4 3 0\n", "4 x 0\n"), "a list longer": ("3 0 1 4", "4 0 1 4"),
        "a list of less": ("3 0 1 4", "-3 0 1 4"), "no faces": ("element face 2", "element face 0"),
        "two corners": ("3 0 1 4", "2 0 1"), "another name": ("vertex_indices", "corners"),
        "no format": ("ascii", "text"), "no end": ("end_header", "end"),
        "of no type": ("float x", "long x"), "another element": (
            "element face 2", "element edge 1\nproperty int a\nelement face 2"),
        "crossing": ("4 0 1 2 3", "4 0 2 1 3"), "concave": ("2 1 5\n4 0 1 2 3", "1 1 0\n4 0 1 4 3"),
        "strips": ("element face 2", "element tristrips 2"),
    }),
    "off": (OFF, {
        "as it is": ("", ""), "binary": ("OFF", "OFF BINARY"), "no counts": ("5 2 0\n", ""),
        "fewer": ("3 0 1 4\n", ""), "less than none": ("5 2 0", "-5 2 0"),
        "no faces": ("5 2 0", "5 0 0"),
        "fewer corners": ("3 0 1 4", "4 0 1 4"), "no number": ("4 3 0", "4 a 0"),
        "a vertex too many": ("3 0 1 4", "3 0 1 9"), "dimension": ("OFF", "nOFF\n4"),
        "no word": ("OFF\n", ""), "of three": ("OFF", "nOFF 3"),
        "colours": ("3 0 1 4", "3 0 1 4 255 0 0"),
        "blank lines": ("\n", "\n\n# more\n"), "counts beside": ("OFF\n", "OFF "),
    }),
    "obj": (OBJ, {
        "as it is": ("", ""), "vertex 0": ("f 1 2 5", "f 0 2 5"), "before": ("f 1 2 5", "f -6 2 5"),
        "relative": ("f 1 2 5", "f -5 -4 -1"), "too many": ("f 1 2 5", "f 1 2 6"),
        "no number": ("v 4 3 0", "v 4 b 0"), "comma": ("v 4 3 0", "v 4 3,5 0"),
        "two numbers": ("v 4 3 0", "v 4 3"), "five numbers": ("v 4 3 0", "v 4 3 0 1 1"),
        "weights": ("v 4 3 0", "v 4 3 0 1"), "underscores": ("v 4 3 0", "v 4 3_0 0"),
        "faces of letters": ("f 1 2 5", "f 1 b 5"), "faces of parts": ("f 1 2 5", "f 1 2.5 5"),
        "no faces": ("f ", "l "), "no points": ("v ", "# "), "surfaces": ("f 1 2 5", "surf 0 1 2"),
        "unknown words": ("f 1 2 5", "f 1 2 5\nzebra 3\nape 1"), "fo": ("f 1 2 5", "fo 1 2 5"),
        "objects": ("f 1 2 5", "o heel\ng a\nf 1 2 5\ng b\nf 2 3 5"),
        "group": ("f 1", "g sole\nf 1"),
        "names": ("f 1 2 5", "g\nf 1/2/3 2//4 5/7"), "comments": ("v 4 3 0", "v 4 3 0 # here"),
        "lines that go on": ("v 4 3 0", "v 4 \\\n3 0"), "crossing": ("f 1 2 3 4", "f 1 3 2 4"),
        "two corners": ("f 1 2 5", "f 1 2"),
    }),
    "stl": (STL, {
        "as it is": ("", ""), "cut short": ("endfacet\nendsolid heel\n", ""),
        "no end": ("endsolid heel\n", ""), "commas": ("4 3 0", "4,5 3,1 0,2"),
        "no number": ("4 3 0", "4 u 0"), "odd number": ("4 3 0", "4-+e 3 0"),
        "capitals": ("facet normal", "FACET NORMAL"),
        "two solids": ("facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2.5e0",
                       "endsolid\nsolid  toe \nfacet normal 0 0 1\nouter loop\n"
                       "vertex 0 0 0\nvertex 2.5e0"),
        "a corner more": ("vertex 1 2 -5", "vertex 1 2 -5\nvertex 1 2 -6"),
        "empty": (STL[11:-14], ""),
        "nan": ("4 3 0", "nan 3 0"),
    }),
}  # fmt: skip
READERS = {"ply": read_ply, "off": read_off, "obj": read_obj, "stl": read_stl}


@pytest.mark.parametrize("kind", TEXTS)
def test_small_texts(file_regression, kind):
    text, changes = TEXTS[kind]
    answers = {}
    for name, (old, new) in changes.items():
        assert old in text
        path = written(HERE, kind, text.replace(old, new).encode())
        answers[name] = _answer(path, READERS[kind])
    held(file_regression, answers, f"texts {kind}", hide=PATH)


def _answer(path, reader):
    try:
        file = reader(path)
    except Exception as error:  # which one is held
        answer = {"refused": f"{type(error).__name__}: {error}"}
    else:
        answer = {"file": [file.format, file.unit, file.remarks, file.unmet]}
        answer["bodies"] = [(body.label, body.size, body) for body in file.bodies]
    try:
        mesh = read_mesh(path)
        answer["mesh"] = (mesh.bodies, mesh.remarks, mesh.triangles)
    except Exception as error:
        told = f"{type(error).__name__}: {error}"
        if told != answer.get("refused"):
            answer["no mesh"] = told
    return answer


def _binary_ply(order, rows, head=PLY):
    kind = "binary_little_endian" if order == "<" else "binary_big_endian"
    return head.partition("end_header")[0].replace("ascii", kind).encode() + b"end_header\n" + rows


def test_binary_ply(file_regression):
    points = [(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0), (2, 1, 5)]
    answers = {}
    for order in "<>":
        rows = b"".join(struct.pack(order + "3f", *one) for one in points)
        faces = [(0, 1, 2, 3), (0, 1, 4)]
        uneven = b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)
        even = b"".join(struct.pack(f"{order}B3i", 3, *f[:3]) for f in faces)
        for name, data in {
            "uneven": rows + uneven, "even": rows + even, "cut points": rows[:-3],
            "cut faces": rows + uneven[:-1], "cut at a length": rows + uneven[:17],
            "cut within": rows + even[:-2], "more": rows + even + b"xyz",
        }.items():  # fmt: skip
            path = written(HERE, "ply", _binary_ply(order, data))
            answers[f"{order} {name}"] = _answer(path, read_ply)
    held(file_regression, answers, hide=PATH)


def _gltf(change=lambda asset: None):
    asset = made.Asset()
    points = np.array([[0, 0, 0], [0.2, 0, 0], [0.2, 0.1, 0], [0, 0.1, 0.01]], dtype="<f4")
    order = np.array([0, 1, 2, 0, 2, 3], dtype="<u2")
    mesh = asset.mesh(asset.accessor(points), asset.accessor(order))
    asset.node(mesh=mesh, name="sole")
    change(asset)
    return asset


def _set(*path):
    *keys, last, value = path

    def change(asset):
        place = asset.json
        for key in keys:
            place = place[key]
        place[last] = value

    return change


GLTF = {
    "as it is": _set("asset", "version", "2.0"),
    "version 1": _set("asset", "version", "1.0"),
    "no asset": _set("asset", {}),
    "nodes in themselves": _set("nodes", 0, "children", [0]),
    "no scene": _set("scenes", []),
    "another scene": _set("scene", 3),
    "no such mesh": _set("nodes", 0, "mesh", 4),
    "a skin": _set("nodes", 0, "skin", 0),
    "hidden": _set("nodes", 0, "extensions", {"KHR_node_visibility": {"visible": False}}),
    "required": _set("extensionsRequired", ["EXT_of_mine", "KHR_materials_unlit"]),
    "used": _set("extensionsUsed", ["EXT_of_mine", "KHR_texture_x"]),
    "meshopt": _set("extensionsRequired", ["EXT_meshopt_compression"]),
    "moved": _set("nodes", 0, "translation", [1, 2, 3]),
    "turned": _set("nodes", 0, "rotation", [0.5, 0.5, 0.5, 0.5]),
    "turned by little": _set("nodes", 0, "rotation", [0.1, 0.2, 0.3, 0.927361849]),
    "scaled": _set("nodes", 0, "scale", [2, 1, -1]),
    "matrix": _set("nodes", 0, "matrix", [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]),
    "large": _set("nodes", 0, "scale", [20, 20, 20]),
    "small": _set("nodes", 0, "scale", [0.05, 0.05, 0.05]),
    "a strip": _set("meshes", 0, "primitives", 0, "mode", 5),
    "a fan": _set("meshes", 0, "primitives", 0, "mode", 6),
    "lines": _set("meshes", 0, "primitives", 0, "mode", 3),
    "mode 7": _set("meshes", 0, "primitives", 0, "mode", 7),
    "without places": _set("meshes", 0, "primitives", 0, "attributes", {}),
    "without indices": lambda a: a.json["meshes"][0]["primitives"][0].pop("indices"),
    "of another type": _set("accessors", 0, "type", "VEC2"),
    "of unknown numbers": _set("accessors", 0, "componentType", 1),
    "too many": _set("accessors", 0, "count", 100_000_000),
    "less than none": _set("accessors", 0, "count", -1),
    "more than there are": _set("accessors", 0, "count", 40),
    "a buffer too short": _set("bufferViews", 0, "byteLength", 4000),
    "behind": _set("bufferViews", 1, "byteOffset", -4),
    "normalised": _set("accessors", 1, "normalized", True),
    "no accessor": _set("accessors", []),
    "a list": _set("nodes", {}),
    "parents": lambda a: a.json["nodes"].append({"children": [0], "name": "shoe"}),
    "sparse": _set("accessors", 0, "sparse", {
        "count": 1, "indices": {"bufferView": 1, "componentType": 5123},
        "values": {"bufferView": 0, "byteOffset": 12},
    }),
    "two instances": _set("nodes", 0, "extensions", {
        "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0, "SCALE": 0}}
    }),
    "targets": lambda a: a.json["meshes"][0].update(
        weights=[0.5, 0.0], primitives=[{**a.json["meshes"][0]["primitives"][0],
                                         "targets": [{"POSITION": 0}, {"POSITION": 0}]}]),
}  # fmt: skip


def test_gltf(file_regression):
    answers = {
        name: _answer(written(HERE, "glb", _gltf(change).glb()), read_gltf)
        for name, change in GLTF.items()
    }
    whole = _gltf().glb()
    for name, data in {
        "version 1 of GLB": whole[:4] + struct.pack("<I", 1) + whole[8:],
        "cut short": whole[:-8],
        "cut in a chunk": whole[:8] + struct.pack("<I", len(whole) - 9) + whole[12:-9],
        "a heading alone": whole[:16],
        "no JSON": whole.replace(b'{"asset"', b'["asset"'),
    }.items():
        answers[name] = _answer(written(HERE, "glb", data), read_gltf)
    asset = _gltf()
    for name, where in {
        "beside": "data.bin", "not there": "other.bin", "damaged": "data:;base64,!!", "within":
        "data:;base64,AAAA",
    }.items():  # fmt: skip
        files = {"": asset.gltf(where), "data.bin": asset.data}
        answers[name] = _answer(written(HERE, "gltf", files), read_gltf)
    answers["strip"] = strip_faces(np.array([0, 1, 2, 2, 3, 4, 1]))
    held(file_regression, answers, hide=PATH)


MESH = made.mesh_xml([made.lug(0, 0)])
CUT = made.mesh_xml([made.lug(1, 1)])


def _model(objects=made.thing(1, MESH), items=made.item(1), **options):  # noqa: B008
    return made.package(made.model(objects, items, **options))


def _named(old, new):
    """Return a package with other words in its text."""
    text = made.model(made.thing(1, MESH), made.item(1))
    assert old in text
    return made.package(text.replace(old, new))


def _bambu_turned():
    """Return a package whose settings name the second of two components first."""
    other = made.model(made.thing(1, MESH) + made.thing(2, CUT), "")
    parts = [made.component(n, path="/3D/a.model") for n in (1, 2)]
    settings = (
        '<config><object id="3"><part id="2" subtype="negative_part">'
        '<metadata key="name" value="cut"/></part><part id="1" subtype="normal_part">'
        '<metadata key="name" value="lug"/></part></object></config>'
    )
    files = {"3D/a.model": other, "Metadata/model_settings.config": settings}
    root = made.model(made.thing(3, made.components(*parts)), made.item(3), more=made.REQUIRED)
    return made.package(root, **files)


THREEMF = {
    "as it is": lambda: _model(),
    "no build": lambda: _named("build>", "built>"),
    "empty build": lambda: _model(items=""),
    "no such object": lambda: _model(items=made.item(7)),
    "no id": lambda: _named('objectid="1"', 'object="1"'),
    "in furlongs": lambda: _model(unit="furlong"),
    "in feet": lambda: _model(unit="foot"),
    "no vertices": lambda: _named("vertices>", "corners>"),
    "no triangles": lambda: _named("triangles>", "faces>"),
    "a vertex without z": lambda: _named(' z="4"', ""),
    "a vertex of letters": lambda: _named(' z="4"', ' z="four"'),
    "a triangle of parts": lambda: _named('v1="0"', 'v1="0.5"'),
    "a triangle beyond": lambda: _named('v1="0"', 'v1="99"'),
    "an object of no type": lambda: _named('<object id="1"', '<object id="1" type="brick"'),
    "a support": lambda: _named('<object id="1"', '<object id="1" type="support"'),
    "two with one id": lambda: _model(made.thing(1, MESH) + made.thing(1, CUT)),
    "an object without id": lambda: _named('<object id="1"', "<object"),
    "an empty object": lambda: _named("mesh>", "mash>"),
    "objects that hold each other": lambda: _model(
        made.thing(1, made.components(made.component(2)))
        + made.thing(2, made.components(made.component(1)))
    ),
    "components": lambda: _model(
        made.thing(1, MESH, 'name="lug"') + made.thing(
            2, made.components(made.component(1), made.component(1, f"{made.ONE} 30 0 1")),
            'name="all"'),
        made.item(2),
    ),
    "an unknown extension": lambda: _model(more=' requiredextensions="q"'),
    "a required extension": lambda: _model(
        more=' requiredextensions="q" xmlns:q="http://schemas.microsoft.com/3dmanufacturing/'
        'slice/2015/07"'
    ),
    "a recommended extension": lambda: _model(
        more=' recommendedextensions="q" xmlns:q="http://mine.example/q"'
    ),
    "not printed": lambda: _model(items=made.item(1, more=' printable="0"')),
    "moved": lambda: _model(items=made.item(1, "2 0 0 0 1 0 0 0 -1 7 8 9")),
    "moved by eleven": lambda: _model(items=made.item(1, "2 0 0 0 1 0 0 0 -1 7 8")),
    "moved by letters": lambda: _model(items=made.item(1, "2 0 0 0 1 0 0 0 -1 7 8 x")),
    "no XML": lambda: _named("</build>", "</bild>"),
    "a document type": lambda: _named("<model", "<!DOCTYPE a><model"),
    "another root": lambda: made.package("<a/>"),
    "a part that is not there": lambda: _model(
        made.thing(1, made.components(made.component(1, path="/3D/b.model")))
    ),
    "Cura's cut": lambda: _model(made.thing(
        1, '<metadatagroup><metadata name="cura:cutting_mesh">true</metadata></metadatagroup>'
        + MESH)),
    "Prusa's part": lambda: made.prusa("ModelPart"),
    "Prusa's cut": lambda: made.prusa("NegativeVolume"),
    "Prusa's other": lambda: made.prusa("Wax"),
    "Bambu's cut": lambda: made.bambu("negative_part"),
    "Bambu's parts in another order": lambda: _bambu_turned(),
}  # fmt: skip


def test_3mf(file_regression):
    answers = {}
    for name, make in THREEMF.items():
        answers[name] = _answer(written(HERE, "3mf", make()), read_3mf)
    held(file_regression, answers, hide=PATH)


def test_rhino(file_regression):
    rhino = pytest.importorskip("rhino3dm")
    answers = {}
    for unit in ("Inches", "None", "Feet"):
        file = rhino.File3dm()
        file.Settings.ModelUnitSystem = getattr(rhino.UnitSystem, unit)
        off = made.rhino_layer(rhino, file, "Off", visible=False)
        on = made.rhino_layer(rhino, file, "On")
        file.Objects.AddMesh(
            made.rhino_mesh(rhino, [made.base()]), made.rhino_attributes(rhino, "base", on)
        )
        file.Objects.AddMesh(
            made.rhino_mesh(rhino, [made.lug(1, 1)]), made.rhino_attributes(rhino, "", off)
        )
        sphere = rhino.Sphere(rhino.Point3d(0, 0, 0), 2).ToBrep()
        if unit == "Feet":
            file.Objects.AddBrep(sphere, made.rhino_attributes(rhino, "ball"))
        path = HERE / "sole.3dm"
        assert file.Write(str(path), 7)
        answers[unit] = _answer(path, read_rhino)
    bare = rhino.File3dm()
    bare.Objects.AddBrep(sphere, made.rhino_attributes(rhino, "ball"))
    assert bare.Write(str(path), 7)
    answers["without meshes"] = _answer(path, read_rhino)
    assert rhino.File3dm().Write(str(path), 7)
    answers["empty"] = _answer(path, read_rhino)
    held(file_regression, answers, hide=PATH)


HEADS = {
    "x.stl": b"", "x.txt": b"hello\n", "x.obj": b"hello\n", "x.ply": b"\0\1\2", "x.step": b"ISO",
    "x.fbx": b"Kaydara FBX Binary", "x.3mf": b"PK\3\4 cut", "x.dwg": b"AC1032", "x": OFF.encode(),
    "x.stp": OBJ.encode(), "x.glb": STL.encode(), "x.iges": b"%PDF-1.4", "x.off": b"OFF BINARY",
    "x.gltf": b"{", "x.json": b"{}", "x.zip": b"7z\xbc\xaf\x27\x1c", "x.xyz": PLY.encode(),
    "x.3dm": b"3D Geometry File Format ",
    "x.bom.obj": b"\xef\xbb\xbf" + OBJ.encode(), "x.bom.off": b"\xff\xfe" + OFF.encode("utf-16-le"),
    "x.nan.stl": STL.replace("4 3 0", "nan 3 0").encode(),
}  # fmt: skip


def test_what_a_file_holds(file_regression):
    answers = {}
    for name, data in HEADS.items():
        (HERE / name).write_bytes(data)
        try:
            mesh = read_mesh(HERE / name)
            answers[name] = (mesh.format, mesh.remarks, len(mesh.triangles))
        except Exception as error:  # which one is held
            answers[name] = f"{type(error).__name__}: {error}"
    answers["folder"] = refusal(read_mesh, HERE)
    answers["not there"] = refusal(read_mesh, HERE / "x.stll")
    answers["nothing near"] = refusal(read_mesh, HERE / "sub" / "other.stl")
    held(file_regression, answers)


def test_heads_of_stl():
    path = HERE / "a.stl"
    for data, like in {
        b"solid a\nfacet": True, b"solid a\nendsolid": True, b"  SOLID a\nFACET": True,
        b"solid a\nother": False, b"short": False, b"x" * 134: False,
        b"x" * 80 + b"\1\0\0\0" + b"x" * 50: True, b"x" * 80 + b"\2\0\0\0" + b"x" * 60: True,
    }.items():  # fmt: skip
        path.write_bytes(data)
        assert looks_like_stl(data, path) == like, data
    path.rename(HERE / "a.bin")
    assert not looks_like_stl(data, HERE / "a.bin")


RING = np.array([[0, 0, 0], [4, 0, 1], [4, 4, 2], [2, 1, 0.75], [0, 4, 1]])
POLYGONS = {
    "concave": (RING, [5], [0, 1, 2, 3, 4]),
    "convex": (RING, [4], [0, 1, 2, 4]),
    "both": (RING, [3, 5, 4, 3], [0, 1, 2, 0, 1, 2, 3, 4, 0, 1, 2, 4, 2, 3, 4]),
    "flat corner": (np.vstack([RING, [2, 0, 0.5]]), [5], [0, 5, 1, 2, 4]),
    "two corners": (RING, [2, 3], [0, 1, 0, 1, 2]),
    "crossing": (RING, [4], [0, 2, 1, 4]),
    "beyond": (RING, [3], [0, 1, 5]),
    "before": (RING, [3], [0, -1, 2]),
    "on a line": (np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]), [4], [0, 1, 2, 3]),
    "of nan": (np.vstack([RING, [np.nan, 0, 0]]), [4], [0, 1, 2, 5]),
    "twice round": (RING, [8], [0, 1, 2, 4, 0, 1, 2, 4]),
    "a corner twice": (RING, [5], [0, 1, 1, 2, 4]),
    "none": (RING, [], []),
}


def test_polygons(file_regression):
    answers = {}
    for name, (points, counts, corners) in POLYGONS.items():
        given = (
            points.astype(float),
            np.array(counts, int),
            np.array(corners, int),
            "OBJ",
            "a.obj",
        )
        answers[name] = tried(triangulate_polygons, *given)
    held(file_regression, answers)


def _body(shift=0.0, dtype=np.float64, **options):
    points = np.array([[0, 0, 0], [9, 0, 0], [0, 5, 1], [0, 0, 2]]) + shift
    return FileBody(points.astype(dtype), np.array([[0, 1, 2], [0, 3, 1]]), **options)


def test_bodies_of_a_file(file_regression):
    mirror = np.diag([1.0, -2.0, 1.0, 1.0])
    files = {
        "one": [_body()], "named": [_body(name="sole")],
        "layers": [_body(name="a", layer="x/y"), _body(name="b", layer="x/z"), _body(layer="x")],
        "hidden": [_body(name="a"), _body(name="b", visible=False), _body(kind="support")],
        "modifiers": [_body(), *[_body(name=f"m{n}", kind="modifier") for n in range(6)]],
        "none shown": [_body(visible=False, name="a"), _body(kind="modifier")],
        "none": [FileBody(np.zeros((0, 3)))], "mirrored": [_body(placement=mirror)],
        "far": [_body(shift=1e4)], "coarse": [_body(shift=6000.0, dtype=np.float32)],
        "not so far": [_body(shift=100.0)], "too coarse": [_body(shift=9e4, dtype=np.float32)],
        "soup": [FileBody(np.arange(18.0).reshape(6, 3))], "nan": [_body(shift=np.nan)],
        "beyond": [FileBody(np.zeros((2, 3)), np.array([[0, 1, 2]]))],
    }  # fmt: skip
    unmet = (Unmet("colours", False), Unmet("curves", False, "Mesh it"))
    answers = {}
    for name, bodies in files.items():
        answers[name] = tried(assemble_mesh, MeshFile("OBJ", bodies, 1e-3, unmet[:1]), "a.obj")
    needs = (Unmet("curves", True, "Mesh it"), Unmet("nurbs", True), *unmet)
    answers["needs"] = refusal(assemble_mesh, MeshFile("OBJ", [_body()], None, needs), "a.obj")
    held(file_regression, answers)
