"""One sole in every form of every mesh format, written here byte by byte.

A plate of 80 x 64 x 5 mm with twenty lugs, 4 mm high and L-shaped (concave), that touch it; in mm,
down is -z. Land is 20 x 75 of 5120 mm^2. Faces are polygons: caps have six corners.
"""

import base64
import io
import json
import struct
import zipfile

import numpy as np

LAND, DEPTH, LUGS = 20 * 75 / (80 * 64), 4.0, 20
L_SHAPE = np.array([(0, 0), (10, 0), (10, 5), (5, 5), (5, 10), (0, 10)], dtype=float)
FORMS = {}


def form(ending, name=None):
    """Register a form: a function that returns bytes, or {name beside: bytes} with "" itself."""

    def add(make):
        FORMS[f"{ending}: {(name or make.__name__).replace('_', ' ')}"] = (ending, make)
        return make

    return add


def prism(ring, low, high):
    """Vertices and outward polygon faces over an anticlockwise ring."""
    n = len(ring)
    points = np.concatenate([np.c_[ring, np.full(n, low)], np.c_[ring, np.full(n, high)]])
    walls = [[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
    return points, [list(range(n))[::-1], [n + k for k in range(n)], *walls]


def base():
    return prism(np.array([(0, -32), (80, -32), (80, 32), (0, 32)], dtype=float), 4.0, 9.0)


def lug(i, j):
    return prism(L_SHAPE + np.array([3 + 15 * i, -30 + 15 * j]), 0.0, 4.0)


def all_lugs():
    return [lug(i, j) for i in range(5) for j in range(4)]


def parts():
    return [base(), *all_lugs()]


def joined(bodies):
    points, faces, count = [], [], 0
    for own, polygons in bodies:
        points.append(own)
        faces += [[n + count for n in face] for face in polygons]
        count += len(own)
    return np.concatenate(points), faces


def cut(points, faces):
    """Triangles of the faces: an L from its inner corner, all others from the first."""
    made = []
    for face in faces:
        ring = list(face)
        if len(ring) == 6:
            corner = points[ring]
            a, b = corner - np.roll(corner, 1, 0), np.roll(corner, -1, 0) - corner
            turn = np.cross(a, b)[:, 2]
            inner = int(np.argmin(turn * np.sign(turn.sum())))
            ring = ring[inner:] + ring[:inner]
        made += [[ring[0], ring[n], ring[n + 1]] for n in range(1, len(ring) - 1)]
    return np.array(made)


def triangles(bodies=None):
    points, faces = joined(bodies or parts())
    return points[cut(points, faces)]


def tall_last():
    """A block far too high for a sole, 9 mm above the ground and wider than the sole."""
    return prism(np.array([(-10, -40), (90, -40), (90, 40), (-10, 40)], dtype=float), 9.0, 80.0)


def floor():
    """A block larger than the sole, on which its lugs stand."""
    return prism(np.array([(-30, -60), (110, -60), (110, 60), (-30, 60)], dtype=float), -9.0, 0.0)


def cavity(x, y, z):
    """The faces of a hollow within a body, turned inward."""
    ring = np.array([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])], dtype=float)
    points, faces = prism(ring, *z)
    return points, [face[::-1] for face in faces]


def hollow_base():
    return joined([base(), cavity((2, 78), (-30, 30), (5.0, 8.0))])


def hollow_lugs(top, roof):
    """Lugs that reach up to ``top`` within the base, their hollows up to ``roof``."""
    places = [(3 + 15 * i, -30 + 15 * j) for i in range(5) for j in range(4)]
    return [
        joined([
            prism(L_SHAPE + np.array([x, y]), 0.0, top),
            cavity((x + 1, x + 9), (y + 1, y + 4), (1.0, roof)),
        ])
        for x, y in places
    ]  # fmt: skip


# OBJ


def obj(bodies=None, *, start=0, relative=False, number="{:.4f}".format, head="", corner="{}",
        more="", group=None, tail="", newline="\n", shift=(0, 0, 0), before="",
        gap=" "):  # fmt: skip
    lines, count = [head] if head else [], 0
    for n, (points, faces) in enumerate(bodies or parts()):
        if group:
            lines.append(group(n))
        lines += [
            before + "v" + gap + gap.join(map(number, p)) + more for p in points + np.array(shift)
        ]
        for face in faces:
            turned = face[start % len(face) :] + face[: start % len(face)]
            numbers = [k - len(points) if relative else k + count + 1 for k in turned]
            lines.append(before + "f" + gap + gap.join(corner.format(k) for k in numbers))
        count += len(points)
    return (newline.join([*lines, tail]) + newline).encode()


for _start in range(6):
    form("obj", f"polygons from corner {_start}")(lambda s=_start: obj(start=s))
form("obj", "relative indices")(lambda: obj(relative=True))
form("obj", "relative, other corner")(lambda: obj(relative=True, start=2))
form("obj", "exponents")(lambda: obj(number="{:.8e}".format))
form("obj", "capital exponents, plus signs")(lambda: obj(number="{:+.6E}".format))
form("obj", "colours")(lambda: obj(more=" 0.5 0.5 0.5"))
form("obj", "weights")(lambda: obj(more=" 1.0"))
form("obj", "v/vt")(lambda: obj(corner="{}/1", head="vt 0 0"))
form("obj", "v//vn")(lambda: obj(corner="{}//1", head="vn 0 0 1"))
form("obj", "v/vt/vn")(lambda: obj(corner="{}/1/1", head="vt 0 0\nvn 0 0 1"))
form("obj", "windows lines")(lambda: obj(newline="\r\n"))
form("obj", "old mac lines")(lambda: obj(newline="\r"))
form("obj", "tabs and blanks")(lambda: obj(before=" ", gap="\t"))
form("obj", "a long heading")(lambda: obj(head="# made by hand\n" * 900))
form("obj", "free-form words at the head")(
    lambda: obj(head="mg 1 0.1\nvp 0.2 0.3\ncstype bspline\nbevel on\nlod 3\nshadow_obj a.obj")
)
form("obj", "words of its own at the head")(lambda: obj(head="exported by hand\nversion 3"))
form("obj", "lines and points")(lambda: obj(tail="l 1 2 3\np 4"))
form("obj", "lines that go on")(lambda: obj(gap=" \\\n "))
form("obj", "comments behind faces")(lambda: obj(corner="{}", more=" # a corner"))
form("obj", "in UTM millimetres")(lambda: obj(shift=(4.5e8, 5.4e9, 1.2e5), number="{:.3f}".format))
form("obj", "in UTM metres")(
    lambda: obj(
        [(p / 1e3, f) for p, f in parts()], shift=(4.5e5, 5.4e6, 120), number="{:.6f}".format
    )
)
form("obj", "every lug an object")(lambda: obj(group=lambda n: f"o part{n}"))
form("obj", "base and lugs")(lambda: obj([base(), joined(all_lugs())], group="o body{}".format))
form("obj", "a last by its group")(
    lambda: obj([*parts(), tall_last()], group=lambda n: "g last" if n == 21 else "g outsole")
)
for _name in ("Floor", "a body of no known name"):
    form("obj", f"{_name} below")(
        lambda n=_name: obj([*parts(), floor()], group=lambda k: f"g {n}" if k == 21 else "g sole")
    )


def halves():
    """Heel and forepart of the sole, each with its lugs."""
    made = []
    for low, high, columns in ((0, 48, range(3)), (48, 80, range(3, 5))):
        ring = np.array([(low, -32), (high, -32), (high, 32), (low, 32)], dtype=float)
        made.append(
            joined([prism(ring, 4.0, 9.0), *(lug(i, j) for i in columns for j in range(4))])
        )
    return made


form("obj", "heel and forepart under a midsole")(
    lambda: obj(
        [*halves(), prism(np.array([(0, -32), (80, -32), (80, 32), (0, 32)], float), 9.0, 25.0)],
        group="o part{}".format,
    )
)
form("obj", "a last above, a floor below")(
    lambda: obj(
        [*parts(), tall_last(), floor()],
        group=lambda k: {21: "g Last", 22: "g Ground"}.get(k, "g Outsole"),
    )
)


# STL


def stl(corners, head=b"outsole", tail=b""):
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
    records = np.zeros(len(corners), dtype=record)
    records["corners"] = corners
    return head.ljust(80) + np.uint32(len(corners)).tobytes() + records.tobytes() + tail


def text_stl(solids, newline="\n", upper=False, end=True):
    lines = []
    for name, corners in solids.items():
        lines.append(f"solid {name}")
        for one in corners:
            lines += ["  facet normal 0 0 0", "    outer loop"]
            lines += [f"      vertex {x:.6e} {y:.6e} {z:.6e}" for x, y, z in one]
            lines += ["    endloop", "  endfacet"]
        lines += [f"endsolid {name}"] if end else []
    text = newline.join(lines) + newline
    return (text.upper() if upper else text).encode()


form("stl", "binary")(lambda: stl(triangles()))
form("stl", "solid at the head")(lambda: stl(triangles(), b"solid by hand"))
form("stl", "bytes behind")(lambda: stl(triangles(), tail=b"\0\0\0"))
form("stl", "solid at the head and bytes behind")(lambda: stl(triangles(), b"solid", b"\0\0"))
form("stl", "solid, zeros, bytes behind")(lambda: stl(triangles(), b"solid\0a".ljust(80, b"\0"),
                                                      b"end"))  # fmt: skip
form("stl", "text")(lambda: text_stl({"a": triangles()}))
form("stl", "text without its end mark")(lambda: text_stl({"a": triangles()}, end=False))
form("stl", "text in capitals")(lambda: text_stl({"a": triangles()}, upper=True))
form("stl", "text of windows")(lambda: text_stl({"a": triangles()}, newline="\r\n"))
form("stl", "solids outsole and last")(
    lambda: text_stl({"Outsole": triangles(), "Last": triangles([tall_last()])})
)
form("stl", "solids base and lugs")(
    lambda: text_stl({"one": triangles([base()]), "two": triangles(all_lugs())})
)


# OFF


def off(head="OFF\n", row="{:.4f} {:.4f} {:.4f}", tail="", points=None):
    own, faces = joined(parts())
    own = own if points is None else points(own)
    lines = [head + f"{len(own)} {len(faces)} 0", *(row.format(*p) for p in own)]
    lines += [f"{len(f)} {' '.join(map(str, f))}{tail}" for f in faces]
    return ("\n".join(lines) + "\n").encode()


form("off", "polygons")(off)
form("off", "a comment first")(lambda: off("# by hand\nOFF # more\n\n"))
form("off", "counts on its first line")(lambda: off("OFF "))
form("off", "colours of faces")(lambda: off(tail=" 0.5 0.5 0.5"))
form("off", "COFF")(lambda: off("COFF\n", "{:.4f} {:.4f} {:.4f} 255 0 0 255"))
form("off", "NOFF")(lambda: off("NOFF\n", "{:.4f} {:.4f} {:.4f} 0 0 1"))
form("off", "4OFF")(lambda: off("4OFF\n", "{:.4f} {:.4f} {:.4f} 2", points=lambda p: 2 * p))
form("off", "without a word at its head")(lambda: off(""))
form("off", "nOFF")(lambda: off("nOFF\n3\n"))


# PLY


def ply(order="ascii", kind="float", lists="uchar int", faces=None, vertex="", face="", shift=0.0,
        name="vertex_indices", element="face"):  # fmt: skip
    points, polygons = joined(parts())
    points = points + shift
    polygons = polygons if faces is None else faces(points, polygons)
    more = "".join(f"property uchar {w}\n" for w in vertex.split())
    own = "".join(f"property uchar {w}\n" for w in face.split())
    head = (
        f"ply\nformat {order} 1.0\ncomment by hand\nelement vertex {len(points)}\n"
        + "".join(f"property {kind} {a}\n" for a in "xyz") + more
        + f"element {element} {len(polygons)}\n{own}property list {lists} {name}\nend_header\n"
    )  # fmt: skip
    extra, flags = len(vertex.split()), len(face.split())
    if order == "ascii":
        rows = [" ".join([*(f"{v:.4f}" for v in p), *["7"] * extra]) for p in points]
        rows += [" ".join([*["1"] * flags, str(len(f)), *map(str, f)]) for f in polygons]
        return (head + "\n".join(rows) + "\n").encode()
    mark = "<" if "little" in order else ">"
    codes = {"uchar": "B", "int": "i", "uint": "I", "ushort": "H", "short": "h", "float": "f",
             "double": "d"}  # fmt: skip
    length, index = (codes[word] for word in lists.split())
    data = b"".join(struct.pack(f"{mark}3{codes[kind]}", *p) + b"\7" * extra for p in points)
    for one in polygons:
        data += b"\1" * flags + struct.pack(f"{mark}{length}{len(one)}{index}", len(one), *one)
    return head.encode() + data


def strips(points, faces):
    """All triangles in one strip, parted by -1."""
    return [[n for one in cut(points, faces) for n in (*one, -1)]]


form("ply", "text, polygons")(ply)
form("ply", "text, triangles")(lambda: ply(faces=lambda p, f: cut(p, f).tolist()))
form("ply", "text, colours and flags")(lambda: ply(vertex="red green blue", face="flag"))
form("ply", "little endian, polygons")(lambda: ply("binary_little_endian"))
form("ply", "big endian, triangles, colours")(
    lambda: ply("binary_big_endian", vertex="red", faces=lambda p, f: cut(p, f).tolist())
)
form("ply", "other types, flags")(
    lambda: ply("binary_little_endian", "double", "ushort uint", face="flag more")
)
form("ply", "double, 30 km off")(lambda: ply("binary_little_endian", "double", shift=3e7))
form("ply", "vertex_index")(lambda: ply(name="vertex_index"))
form("ply", "strips")(
    lambda: ply("binary_little_endian", lists="int int", faces=strips, element="tristrips")
)


def _with_lists(order, uneven=0):
    """A camera first; a list in each vertex (of ``uneven`` more in every second), two in a face."""
    points, polygons = joined(parts())
    head = (
        f"ply\nformat {order} 1.0\nelement camera 2\nproperty double a\n"
        "property list uchar short w\n"
        f"element vertex {len(points)}\nproperty double x\nproperty list uchar float more\n"
        f"property double y\nproperty double z\nelement face {len(polygons)}\n"
        "property list uchar ushort vertex_indices\nproperty list uchar float texcoord\n"
        "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    )
    rows = [("dB3h", (1, 3, 1, 2, 3)), ("dB", (1, 0))]
    for n, (x, y, z) in enumerate(points):
        count = 1 + n % 2 * uneven
        rows.append((f"dB{count}fdd", (x, count, *[9] * count, y, z)))
    for one in polygons:
        n = len(one)
        rows.append((f"B{n}HB{2 * n}f", (n, *one, 2 * n, *[0] * 2 * n)))
    rows.append(("2i", (0, 1)))
    if order == "ascii":
        return (head + "\n".join(" ".join(map(str, row)) for _, row in rows) + "\n").encode()
    return head.encode() + b"".join(struct.pack(">" + code, *row) for code, row in rows)


for _order in ("ascii", "binary_big_endian"):
    for _uneven in (0, 2):
        form("ply", f"{_order}, lists, {_uneven} uneven")(
            lambda order=_order, uneven=_uneven: _with_lists(order, uneven)
        )


# glTF


class Asset:
    """A glTF asset: bytes grow as views and accessors are added."""

    def __init__(self):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [],
                     "meshes": [], "nodes": [], "scenes": [{"nodes": []}], "scene": 0}  # fmt: skip

    def view(self, data, **more):
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more}
        self.json["bufferViews"].append(view)
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, **more):
        codes = {"f4": 5126, "u1": 5121, "u2": 5123, "u4": 5125, "i2": 5122, "i1": 5120}
        shape = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}[1 if values.ndim == 1 else values.shape[1]]
        entry = {"componentType": codes[values.dtype.str[1:]], "count": len(values), "type": shape}
        if "bufferView" not in more and "sparse" not in more:
            more = {"bufferView": self.view(values.tobytes()), **more}
        more = {k: v for k, v in more.items() if v is not None}
        self.json["accessors"].append({**entry, **more})
        return len(self.json["accessors"]) - 1

    def mesh(self, position, indices=None, mode=4, **more):
        primitive = {"attributes": {"POSITION": position}, "mode": mode, **more}
        if indices is not None:
            primitive["indices"] = indices
        self.json["meshes"].append({"primitives": [primitive]})
        return len(self.json["meshes"]) - 1

    def node(self, shown=True, **node):
        self.json["nodes"].append(node)
        number = len(self.json["nodes"]) - 1
        if shown:
            self.json["scenes"][0]["nodes"].append(number)
        return number

    def glb(self):
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + b"\0" * (-len(self.data) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        chunks += struct.pack("<II", len(data), 0x004E4942) + data
        return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks

    def gltf(self, uri):
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        return json.dumps(self.json).encode()


UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], dtype=float)
"""From z up to y up."""


def metres(bodies=None):
    points, faces = joined(bodies or parts())
    return (points @ UP.T / 1e3).astype("<f4"), cut(points, faces).astype("<u2")


def plain(asset=None, bodies=None, **node):
    asset = asset or Asset()
    points, faces = metres(bodies)
    mesh = asset.mesh(asset.accessor(points), asset.accessor(faces.ravel()))
    asset.node(mesh=mesh, **node)
    return asset


form("glb", "indices of two bytes")(lambda: plain().glb())


@form("glb")
def indices_of_four_bytes():
    asset, (points, faces) = Asset(), metres()
    asset.node(mesh=asset.mesh(asset.accessor(points), asset.accessor(faces.ravel().astype("<u4"))))
    return asset.glb()


@form("glb")
def without_indices():
    asset, (points, faces) = Asset(), metres()
    asset.node(mesh=asset.mesh(asset.accessor(points[faces].reshape(-1, 3))))
    return asset.glb()


@form("glb")
def strips_and_fans():
    asset, (points, faces) = Asset(), metres()
    position = asset.accessor(points)
    half = len(faces) // 2
    strip = np.concatenate([[a, a, a, b, c, c] for a, b, c in faces[:half]])
    asset.node(mesh=asset.mesh(position, asset.accessor(strip.astype("<u2")), mode=5))
    for one in faces[half:]:
        asset.node(mesh=asset.mesh(position, asset.accessor(one.copy()), mode=6))
    return asset.glb()


@form("glb")
def sparse_positions():
    asset, (points, faces) = Asset(), metres()
    low = np.flatnonzero(points[:, 1] < 1e-3)  # the bottoms of the lugs
    flat = points.copy()
    flat[low] = 0
    sparse = {
        "count": len(low),
        "indices": {"bufferView": asset.view(low.astype("<u2").tobytes()), "componentType": 5123},
        "values": {"bufferView": asset.view(points[low].tobytes())},
    }
    view = asset.view(flat.tobytes())
    position = asset.accessor(points, sparse=sparse, bufferView=view)
    asset.node(mesh=asset.mesh(position, asset.accessor(faces.ravel())))
    return asset.glb()


@form("glb")
def sparse_positions_without_a_view():
    asset, (points, faces) = Asset(), metres()
    sparse = {
        "count": len(points),
        "indices": {
            "bufferView": asset.view(np.arange(len(points)).astype("<u2").tobytes()),
            "componentType": 5123,
        },
        "values": {"bufferView": asset.view(points.tobytes())},
    }
    position = asset.accessor(points, sparse=sparse)
    asset.node(mesh=asset.mesh(position, asset.accessor(faces.ravel())))
    return asset.glb()


def quantised(kind):
    asset, (points, faces) = Asset(), metres()
    top = np.iinfo(kind).max
    values = np.rint((points + 0.04 * ("u" in kind)) / 0.13 * top).astype(kind)
    padded = np.zeros((len(values), 4), dtype=values.dtype)
    padded[:, :3] = values
    view = asset.view(padded.tobytes(), byteStride=padded.itemsize * 4)
    position = asset.accessor(values, bufferView=view, normalized=True)
    asset.node(mesh=asset.mesh(position, asset.accessor(faces.ravel())), scale=[0.13] * 3)
    asset.json["extensionsUsed"] = asset.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    return asset.glb()


form("glb", "normalised unsigned integers")(lambda: quantised("<u2"))
form("glb", "normalised signed integers")(lambda: quantised("<i2"))


@form("glb")
def plain_integers_scaled_by_the_node():
    asset, (points, faces) = Asset(), metres()
    values = np.rint(points * 1e4).astype("<i2")
    position = asset.accessor(values)
    asset.node(mesh=asset.mesh(position, asset.accessor(faces.ravel())), scale=[1e-4] * 3)
    return asset.glb()


@form("glb")
def interleaved_with_normals():
    asset, (points, faces) = Asset(), metres()
    both = np.concatenate([np.zeros_like(points), points], axis=1)
    view = asset.view(both.tobytes(), byteStride=24)
    position = asset.accessor(points, bufferView=view, byteOffset=12)
    asset.node(mesh=asset.mesh(position, asset.accessor(faces.ravel())))
    return asset.glb()


@form("glb")
def mirrored_node():
    asset, (points, faces) = Asset(), metres()
    mirrored = points * np.float32([1, 1, -1])
    mesh = asset.mesh(asset.accessor(mirrored), asset.accessor(faces[:, ::-1].ravel().copy()))
    asset.node(mesh=mesh, scale=[1, 1, -1])
    return asset.glb()


@form("glb")
def nodes_in_nodes():
    asset = plain(Asset(), matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.1, 0, 0, 1])
    asset.json["scenes"][0]["nodes"] = []
    half = np.sqrt(0.5)
    inner = asset.node(False, children=[0], rotation=[0, half, 0, half], translation=[0, 0.2, 0])
    asset.node(children=[inner], scale=[1, 1, 1])
    return asset.glb()


@form("glb")
def instances_of_a_lug():
    asset = plain(bodies=[base()])
    (points, faces), places = metres([lug(0, 0)]), []
    for i in range(5):
        places += [np.array([15 * i, 15 * j, 0]) @ UP.T / 1e3 for j in range(4)]
    mesh = asset.mesh(asset.accessor(points), asset.accessor(faces.ravel()))
    moved = asset.accessor(np.array(places, dtype="<f4"))
    extension = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": moved}}}
    asset.node(mesh=mesh, extensions=extension)
    asset.json["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]
    return asset.glb()


@form("glb")
def a_shape_target_in_full():
    asset, (points, faces) = Asset(), metres()
    flat = points.copy()
    flat[points[:, 1] < 1e-3, 1] = 3e-3
    target = {"POSITION": asset.accessor(points - flat)}
    mesh = asset.mesh(asset.accessor(flat), asset.accessor(faces.ravel()), targets=[target])
    asset.json["meshes"][mesh]["weights"] = [1.0]
    asset.node(mesh=mesh)
    return asset.glb()


@form("glb")
def another_scene_and_a_hidden_node():
    asset = plain()
    points, faces = metres([tall_last()])
    mesh = asset.mesh(asset.accessor(points), asset.accessor(faces.ravel()))
    other = asset.node(False, mesh=mesh)
    asset.json["scenes"].append({"nodes": [other]})
    asset.node(mesh=mesh, extensions={"KHR_node_visibility": {"visible": False}})
    asset.json["extensionsUsed"] = ["KHR_node_visibility", "KHR_materials_unlit"]
    asset.json["extensionsRequired"] = ["KHR_materials_unlit"]
    return asset.glb()


@form("glb")
def lines_beside():
    asset = plain()
    position = asset.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    asset.json["meshes"][0]["primitives"].append({"attributes": {"POSITION": position}, "mode": 1})
    return asset.glb()


@form("glb")
def packed_by_draco():
    import DracoPy

    asset, (points, faces) = Asset(), metres()
    data = DracoPy.encode(points, faces=faces.astype(np.uint32), quantization_bits=16)
    position = asset.accessor(points, bufferView=None)
    indices = asset.accessor(faces.ravel(), bufferView=None)
    said = {"bufferView": asset.view(data), "attributes": {"POSITION": 0}}
    mesh = asset.mesh(position, indices, extensions={"KHR_draco_mesh_compression": said})
    for accessor in asset.json["accessors"]:
        accessor.pop("bufferView", None)
    asset.node(mesh=mesh)
    asset.json["extensionsUsed"] = asset.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    return asset.glb()


@form("glb")
def meshopt_beside_its_numbers():
    asset = plain()
    packing = {"buffer": 0, "byteLength": 9, "byteStride": 12, "mode": "ATTRIBUTES", "count": 1}
    for view in asset.json["bufferViews"]:
        view["extensions"] = {"EXT_meshopt_compression": packing}
    asset.json["extensionsUsed"] = ["EXT_meshopt_compression"]
    return asset.glb()


@form("gltf")
def numbers_within():
    asset = plain()
    text = base64.b64encode(asset.data).decode()
    return asset.gltf(f"data:application/octet-stream;base64,{text}")


@form("gltf")
def numbers_beside():
    asset = plain()
    return {"": asset.gltf("my%20sole.bin"), "my sole.bin": asset.data}


# 3MF

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
KIND = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
ONE = "1 0 0 0 1 0 0 0 1"
TYPES = (
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" '
    'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel'
    '+xml"/><Default Extension="config" ContentType="text/xml"/></Types>'
)


def mesh_xml(bodies, scale=1.0, flipped=False, prefix="", face=""):
    points, faces = joined(bodies)
    order = cut(points, faces)[:, :: -1 if flipped else 1]
    rows = "".join(f'<{prefix}vertex x="{x * scale:.7g}" y="{y * scale:.7g}" z="{z * scale:.7g}"/>'
                   for x, y, z in points)  # fmt: skip
    lists = "".join(f'<{prefix}triangle v1="{a}" v2="{b}" v3="{c}"{face}/>' for a, b, c in order)
    return (
        f"<{prefix}mesh><{prefix}vertices>{rows}</{prefix}vertices>"
        f"<{prefix}triangles>{lists}</{prefix}triangles></{prefix}mesh>"
    )


def model(objects, items, unit="millimeter", more="", encoding="UTF-8"):
    space = f'xmlns="{CORE}" xmlns:p="{PRODUCTION}"'
    return (
        f'<?xml version="1.0" encoding="{encoding}"?><model unit="{unit}" {space}{more}>'
        f"<resources>{objects}</resources><build>{items}</build></model>"
    )


def package(text, start="3D/3dmodel.model", **others):
    stream = io.BytesIO()
    relation = f'<Relationship Target="/{start}" Id="r" Type="{KIND}"/>'
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        relations = f'<Relationships xmlns="{RELATIONS}">{relation}</Relationships>'
        archive.writestr("[Content_Types].xml", TYPES)
        archive.writestr("_rels/.rels", relations)
        archive.writestr(start, text)
        parts = [name for name in others if name.endswith(".model")]
        if parts:
            held = "".join(
                f'<Relationship Target="/{name}" Id="r{n}" Type="{KIND}"/>'
                for n, name in enumerate(parts)
            )
            beside = f'<Relationships xmlns="{RELATIONS}">{held}</Relationships>'
            archive.writestr("3D/_rels/3dmodel.model.rels", beside)
        for name, data in others.items():
            archive.writestr(name, data)
    return stream.getvalue()


def thing(number, inside, more=""):
    return f'<object id="{number}" {more}>{inside}</object>'


def component(number, place=None, path=None):
    place = "" if place is None else f' transform="{place}"'
    path = "" if path is None else f' p:path="{path}"'
    return f'<component objectid="{number}"{place}{path}/>'


def components(*inside):
    return f"<components>{''.join(inside)}</components>"


def item(number, place=None, path=None, more=""):
    place = "" if place is None else f' transform="{place}"'
    path = "" if path is None else f' p:path="{path}"'
    return f'<item objectid="{number}"{place}{path}{more}/>'


def whole(**options):
    return thing(1, mesh_xml(parts(), **options))


for _unit, _size in (("micron", 1e3), ("millimeter", 1.0), ("centimeter", 0.1),
                     ("inch", 1 / 25.4), ("foot", 1 / 304.8), ("meter", 1e-3)):  # fmt: skip
    form("3mf", f"in {_unit}")(lambda u=_unit, s=_size: package(model(whole(scale=s), item(1), u)))
form("3mf", "item scaled and moved")(
    lambda: package(model(whole(scale=0.5), item(1, "2 0 0 0 2 0 0 0 2 128 128 0")))
)
form("3mf", "item mirrored")(lambda: package(model(whole(), item(1, "-1 0 0 0 1 0 0 0 1 0 0 0"))))
form("3mf", "far from the origin")(
    lambda: package(model(whole(), item(1, f"{ONE} 40000000 50000000 0")))
)
form("3mf", "attributes of its own on faces")(
    lambda: package(model(whole(face=' pid="1" paint_color="8"'), item(1)))
)
form("3mf", "comments")(
    lambda: package(model("<!-- <vertices> -->" + whole(), item(1)).replace(
        "<triangles>", "<triangles><!-- all of them -->"))
)  # fmt: skip
form("3mf", "UTF-16")(lambda: package(model(whole(), item(1), encoding="UTF-16").encode("utf-16")))
form("3mf", "another start part")(
    lambda: package(model(whole(), item(1)), start="3D/my%20sole.model")
)


@form("3mf")
def prefixed_elements():
    text = f'<c:model unit="millimeter" xmlns:c="{CORE}"><c:resources><c:object id="1">'
    text += mesh_xml(parts(), prefix="c:")
    text += '</c:object></c:resources><c:build><c:item objectid="1"/></c:build></c:model>'
    return package(text)


@form("3mf")
def attributes_in_another_order():
    swapped = whole().replace("<triangle v1=", "<triangle  v1 = ").replace('"/>', '" />')
    text = model(swapped.replace("<vertex x", "<vertex\nx"), item(1))
    return package(text.replace('"', "'").replace("version='1.0'", 'version="1.0"'))


def lug_places():
    return [f"{ONE} {15 * i} {15 * j} 0" for i in range(5) for j in range(4)]


@form("3mf")
def a_lug_twenty_times():
    objects = thing(1, mesh_xml([base()])) + thing(2, mesh_xml([lug(0, 0)]))
    held = components(component(1), *(component(2, place) for place in lug_places()))
    return package(model(objects + thing(3, held), item(3)))


@form("3mf")
def a_mirrored_lug_and_a_plain_one():
    points, faces = lug(0, 0)
    mirrored = [(points * (-1, 1, 1), [face[::-1] for face in faces])]
    objects = thing(1, mesh_xml([base()])) + thing(2, mesh_xml(mirrored))
    places = [f"-1 0 0 0 1 0 0 0 1 {15 * i} {15 * j} 0" for i in range(5) for j in range(4)]
    held = components(component(1), *(component(2, place) for place in places))
    return package(model(objects + thing(3, held), item(3)))


@form("3mf")
def items_of_base_and_lugs():
    objects = thing(1, mesh_xml([base()]), 'name="TPU"')
    objects += thing(2, mesh_xml(all_lugs()), 'name="Rubber lugs"')
    return package(model(objects, item(1) + item(2)))


REQUIRED = ' requiredextensions="p"'


@form("3mf")
def a_part_with_other_objects():
    other = model(thing(1, mesh_xml(parts())) + thing(2, mesh_xml([tall_last()])), "")
    held = thing(3, components(component(1, path="/3D/Objects/a.model")))
    return package(model(held, item(3), more=REQUIRED), **{"3D/Objects/a.model": other})


@form("3mf")
def two_parts_with_the_same_ids():
    one, two = model(thing(1, mesh_xml([base()])), ""), model(thing(1, mesh_xml(all_lugs())), "")
    held = components(component(1, path="/3D/a.model"), component(1, path="/3D/b.model"))
    text = model(thing(1, held), item(1), more=REQUIRED)
    return package(text, **{"3D/a.model": one, "3D/b.model": two})


@form("3mf")
def moved_parts_of_one_part():
    objects = thing(1, mesh_xml([base()])) + thing(2, mesh_xml(
        [(p - (40, 0, 2), f) for p, f in all_lugs()]))  # fmt: skip
    held = components(
        component(1, path="/3D/a.model"), component(2, f"{ONE} 40 0 2", "/3D/a.model")
    )
    text = model(thing(9, held), item(9, f"{ONE} 128 128 0"), more=REQUIRED)
    return package(text, **{"3D/a.model": model(objects, "")})


@form("3mf")
def a_path_on_the_item():
    other = model(thing(5, mesh_xml(parts())), "")
    text = model(thing(5, mesh_xml([tall_last()])), item(5, path="/3D/A.model"), more=REQUIRED)
    return package(text, **{"3D/a.model": other})


def beside(kind="", inside="", more=""):
    held = thing(2, inside + mesh_xml([tall_last()]), kind)
    return package(model(whole() + held, item(1) + item(2, more=more)))


for _kind in ("support", "solidsupport", "other"):
    form("3mf", f"an object of type {_kind}")(lambda k=_kind: beside(f'type="{k}"'))
form("3mf", "an item not to be printed")(lambda: beside(more=' printable="0"'))
for _word in ("support_mesh", "infill_mesh", "anti_overhang_mesh"):
    form("3mf", f"Cura's {_word}")(
        lambda w=_word: beside(
            inside=f'<metadatagroup><metadata name="cura:{w}">True</metadata></metadatagroup>'
        )
    )


def prusa(kind, own="1"):
    count = len(triangles())
    last = count + len(triangles([tall_last()])) - 1
    text = (
        f'<config><object id="1"><volume firstid="0" lastid="{count - 1}"><metadata type="volume" '
        f'key="volume_type" value="ModelPart"/></volume><volume firstid="{count}" lastid="{last}">'
        f'<metadata type="volume" key="volume_type" value="{kind}"/></volume></object></config>'
    )
    objects = thing(1, mesh_xml([*parts(), tall_last()]))
    return package(model(objects, item(1)), **{"Metadata/Slic3r_PE_model.config": text})


def bambu(kind):
    other = model(thing(1, mesh_xml(parts())) + thing(2, mesh_xml([tall_last()])), "")
    held = components(component(1, path="/3D/a.model"), component(2, path="/3D/a.model"))
    text = (
        '<config><object id="3"><metadata key="name" value="sole"/><part id="1" '
        'subtype="normal_part"/><part id="2" '
        f'subtype="{kind}"><metadata key="name" value="x"/></part></object></config>'
    )
    parted = {"3D/a.model": other, "Metadata/model_settings.config": text}
    return package(model(thing(3, held), item(3), more=REQUIRED), **parted)


for _kind in ("ParameterModifier", "SupportBlocker", "SupportEnforcer"):
    form("3mf", f"Prusa's {_kind}")(lambda k=_kind: prusa(k))
for _kind in ("modifier_part", "support_blocker", "support_enforcer"):
    form("3mf", f"Bambu's {_kind}")(lambda k=_kind: bambu(k))


# 3DM


def rhino_mesh(rhino, bodies, scale=1.0):
    points, faces = joined(bodies)
    mesh = rhino.Mesh()
    for point in points * scale:
        mesh.Vertices.Add(*map(float, point))
    four = [face for face in faces if len(face) == 4]
    for face in four:
        mesh.Faces.AddFace(*face)
    for face in cut(points, [face for face in faces if len(face) != 4]).tolist():
        mesh.Faces.AddFace(*face)
    return mesh


def rhino_file(fill, unit="Millimeters"):
    def make(folder):
        import rhino3dm as rhino

        file = rhino.File3dm()
        file.Settings.ModelUnitSystem = getattr(rhino.UnitSystem, unit)
        fill(rhino, file)
        path = folder / "made.3dm"
        assert file.Write(str(path), 7)
        return path.read_bytes()

    make.__name__ = fill.__name__
    return make


def rhino_layer(rhino, file, name, visible=True, parent=None):
    layer = rhino.Layer()
    layer.Name, layer.Visible = name, visible
    if parent is not None:
        layer.ParentLayerId = file.Layers[parent].Id
    return file.Layers.Add(layer)


def rhino_attributes(rhino, name="", layer=None, visible=True):
    attributes = rhino.ObjectAttributes()
    attributes.Name, attributes.Visible = name, visible
    if layer is not None:
        attributes.LayerIndex = layer
    return attributes


def rhino_block(file, rhino, name, meshes, attributes):
    return file.InstanceDefinitions.Add(
        name, "", "", "", rhino.Point3d(0, 0, 0), tuple(meshes), tuple(attributes)
    )


for _unit, _size in (("Millimeters", 1.0), ("Inches", 1 / 25.4), ("Mils", 1 / 0.0254)):
    form("3dm", f"in {_unit}")(
        rhino_file(lambda r, f, s=_size: f.Objects.AddMesh(
            rhino_mesh(r, parts(), s), rhino_attributes(r)), _unit)
    )  # fmt: skip


@form("3dm")
@rhino_file
def hidden_layers_and_objects(rhino, file):
    rhino_layer(rhino, file, "Default")
    off = rhino_layer(rhino, file, "Old", visible=False)
    below = rhino_layer(rhino, file, "Below it", parent=off)
    file.Objects.AddMesh(rhino_mesh(rhino, parts()), rhino_attributes(rhino, "sole"))
    block = rhino_mesh(rhino, [tall_last()])
    file.Objects.AddMesh(block, rhino_attributes(rhino, "a", off))
    file.Objects.AddMesh(block, rhino_attributes(rhino, "b", below))
    file.Objects.AddMesh(block, rhino_attributes(rhino, "c", visible=False))


@form("3dm")
@rhino_file
def a_block_with_layers(rhino, file):
    layers = [rhino_layer(rhino, file, name) for name in ("Outsole", "Last")]
    off = rhino_layer(rhino, file, "Construction", visible=False)
    meshes = [rhino_mesh(rhino, one) for one in (parts(), [tall_last()], [tall_last()])]
    told = [rhino_attributes(rhino, "x", layer) for layer in (*layers, off)]
    number = rhino_block(file, rhino, "shoe", meshes, told)
    place = rhino.Transform.Translation(100.0, 50.0, 0.0)
    identity = file.InstanceDefinitions.FindIndex(number).Id
    file.Objects.AddInstanceObject(
        rhino.InstanceReference(identity, place), rhino_attributes(rhino)
    )


@form("3dm")
@rhino_file
def a_block_of_a_lug_in_a_block(rhino, file):
    inner = rhino_block(
        file, rhino, "lug", [rhino_mesh(rhino, [lug(0, 0)])], [rhino_attributes(rhino)]
    )
    identity = file.InstanceDefinitions.FindIndex(inner).Id
    held = [rhino.InstanceReference(identity, rhino.Transform.Translation(15.0 * i, 15.0 * j, 0.0))
            for i in range(5) for j in range(4)]  # fmt: skip
    held.append(rhino_mesh(rhino, [base()]))
    outer = rhino_block(file, rhino, "sole", held, [rhino_attributes(rhino)] * len(held))
    identity = file.InstanceDefinitions.FindIndex(outer).Id
    reference = rhino.InstanceReference(identity, rhino.Transform.Identity())
    file.Objects.AddInstanceObject(reference, rhino_attributes(rhino))
