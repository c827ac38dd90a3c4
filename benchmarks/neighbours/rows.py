"""What the field's programs do with valid input of known truth: each row of a page, run.

``python rows.py PAGE`` runs every row in an environment of its own (``requirements.txt``), prints
what differs from the page and ends with 1 where anything does; ``--write`` writes the page's table.
No input here makes a program crash or hang.
"""

import importlib.metadata
import re
import sys
import tempfile
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

HAND = ("a sole", "a recording", "a scan or a surface", "a rubber or a fluid", "a study")
HEAD = "| program | given | it gives | right, and how known | ours | do |"
MARK = "<!-- rows: written by make neighbours -->"


@dataclass(frozen=True)
class Row:
    """A behaviour: ``run`` returns what the program gives, in words with numbers."""

    hand: str
    package: str
    given: str
    right: str
    ours: str
    do: str
    run: Callable[[], str]

    @property
    def version(self) -> str:
        return importlib.metadata.version(self.package)

    def cells(self, seen: str) -> list[str]:
        return [f"{self.package} {self.version}", self.given, seen, self.right, self.ours, self.do]


ROWS: list[Row] = []


def row(hand: str, package: str, given: str, right: str, ours: str, do: str):
    """Register a function as a row."""

    def add(run: Callable[[], str]) -> Callable[[], str]:
        assert hand in HAND
        ROWS.append(Row(hand, package, given, right, ours, do, run))
        return run

    return add


def written(name: str, content: str) -> str:
    path = Path(tempfile.mkdtemp()) / name
    path.write_text(content)
    return str(path)


# A sole

L_FACE = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)]
TURNED = "by the first corner that the file names"


def _areas(write: Callable[[list[int]], str], name: str) -> str:
    import trimesh

    areas = {
        round(float(trimesh.load(written(name, write([(k + n) % 6 for k in range(6)]))).area), 3)
        for n in range(6)
    }
    return f"{' or '.join(f'{one:g}' for one in sorted(areas))}, {TURNED}"


_CONCAVE = ("7 (by hand)", "7 from each corner", "Export triangles, or take pymeshlab")


@row("a sole", "trimesh", "An OBJ: one L-shaped face of area 7", *_CONCAVE)
def _() -> str:
    corners = "".join(f"v {x} {y} 0\n" for x, y in L_FACE)
    return _areas(lambda o: corners + "f " + " ".join(str(k + 1) for k in o) + "\n", "a.obj")


@row("a sole", "trimesh", "The same face as PLY", *_CONCAVE)
def _() -> str:
    head = (
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    corners = "".join(f"{x} {y} 0\n" for x, y in L_FACE)
    return _areas(lambda o: head + corners + "6 " + " ".join(map(str, o)) + "\n", "a.ply")


@row("a sole", "trimesh", "The same face as OFF", *_CONCAVE)
def _() -> str:
    corners = "".join(f"{x} {y} 0\n" for x, y in L_FACE)
    return _areas(lambda o: "OFF\n6 1 0\n" + corners + "6 " + " ".join(map(str, o)) + "\n", "a.off")


RELATIVE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 10 0 0\nv 14 0 0\nv 10 3 0\nf -3 -2 -1\n"
_RELATIVE = ("An OBJ whose two parts name their corners backward: areas 0.5 and 6",
             "0.5 and 6 (-1 is the last vertex so far)", "0.5 and 6",
             "Export absolute indices")  # fmt: skip


def _triangles(points: np.ndarray, faces: np.ndarray) -> str:
    a, b, c = (points[faces[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return " and ".join(f"{one:.3g}" for one in areas)


@row("a sole", "trimesh", *_RELATIVE)
def _() -> str:
    import trimesh

    mesh = trimesh.load(written("a.obj", RELATIVE), process=False)
    return _triangles(np.asarray(mesh.vertices), np.asarray(mesh.faces))


@row("a sole", "meshio", *_RELATIVE)
def _() -> str:
    import meshio

    mesh = meshio.read(written("a.obj", RELATIVE))
    return _triangles(mesh.points, np.concatenate([block.data for block in mesh.cells]))


@row(
    "a sole",
    "meshio",
    "A brick of eight corners, written as Abaqus input",
    "C3D8",
    "bricks are not written",
    "Change the names of the elements; CalculiX refuses them",
)
def _() -> str:
    import meshio

    grid = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
    path = written("a.inp", "")
    meshio.write(path, meshio.Mesh(grid, [("hexahedron", [list(range(8))])]))
    return re.search(r"TYPE=(\w+)", Path(path).read_text(), re.IGNORECASE)[1]


_INPUT = "*NODE\n" + "".join(f"{k + 1}, {k}., {k % 2}., 0.\n" for k in range(6))


@row(
    "a sole",
    "meshio",
    "Abaqus input: a node set made of two sets of 4 and 2 nodes",
    "6 nodes",
    "not read",
    "Name the nodes of the set themselves",
)
def _() -> str:
    import meshio

    text = _INPUT + "*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n"
    text += "*NSET, NSET=HEEL\n1, 2, 3, 4\n*NSET, NSET=TOE\n5, 6\n*NSET, NSET=GRIP\nHEEL, TOE\n"
    return f"{len(meshio.read(written('a.inp', text)).point_sets['GRIP'])} nodes"


@row(
    "a sole",
    "meshio",
    "Abaqus input: a node set given in two blocks of 2 nodes",
    "4 nodes",
    "not read",
    "Give each set once",
)
def _() -> str:
    import meshio

    text = _INPUT + "*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n*NSET, NSET=A\n1, 2\n*NSET, NSET=A\n5, 6\n"
    return f"{len(meshio.read(written('a.inp', text)).point_sets['A'])} nodes"


@row(
    "a sole",
    "triangle",
    "A unit square, triangles of at most 1e-05 (as Python prints it)",
    "largest 1e-05",
    "own meshes",
    'Write the limit as f"{area:.10f}"',
)
def _() -> str:
    import triangle

    square = {"vertices": [(0, 0), (1, 0), (1, 1), (0, 1)],
              "segments": [(0, 1), (1, 2), (2, 3), (3, 0)]}  # fmt: skip
    made = triangle.triangulate(square, f"pqa{1e-05}")
    points, faces = made["vertices"], made["triangles"]
    u, v = points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    return f"{len(faces)} triangles, largest {area.max():.2g}"


@row(
    "a sole",
    "rhino3dm",
    "A sphere of radius 10 turned by 45° about z: its box",
    "10 in x",
    "10 (of its triangles)",
    "Take the box of a mesh of it",
)
def _() -> str:
    import rhino3dm

    solid = rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 10.0).ToBrep()
    turn = rhino3dm.Transform.Rotation(
        np.pi / 4, rhino3dm.Vector3d(0, 0, 1), rhino3dm.Point3d(0, 0, 0)
    )
    solid.Transform(turn)
    return f"{solid.GetBoundingBox().Max.X:.2f} in x"


# A recording


def _c3d():
    import ezc3d

    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["A"]
    return file


@row(
    "a recording",
    "ezc3d",
    "70,000 frames of one marker, written and read again",
    "70000 frames",
    "70000 (LONG_FRAMES, TRIAL)",
    "Cut the recording at 65,535 frames",
)
def _() -> str:
    import ezc3d

    file = _c3d()
    points = np.ones((4, 1, 70_000))
    points[0, 0] = np.arange(70_000)
    file["data"]["points"] = points
    path = written("a.c3d", "")
    file.write(path)
    return f"{ezc3d.c3d(path)['data']['points'].shape[2]} frames"


@row(
    "a recording",
    "ezc3d",
    "A point seen by five cameras with residual 0.8 mm, as integers of the format",
    "0.8 mm",
    "below 0: not seen; else not used",
    "Exchange residuals and camera masks",
)
def _() -> str:
    import ezc3d

    path = Path(written("a.c3d", ""))
    path.write_bytes(_point_file())
    return f"{float(ezc3d.c3d(str(path))['data']['meta_points']['residuals'].ravel()[0]):.2g} mm"


def _parameters(groups: dict[str, dict[str, tuple[int, list[int], bytes]]]) -> bytes:
    """The parameter section of a C3D: by group and name the type, dimensions and bytes."""
    parts = b""
    for number, (group, entries) in enumerate(groups.items(), start=1):
        parts += bytes([len(group), 256 - number]) + group.encode() + b"\x03\x00\x00"
        for name, (kind, sizes, data) in entries.items():
            body = bytes([kind % 256, len(sizes), *sizes]) + data + b"\x00"
            parts += bytes([len(name), number]) + name.encode()
            parts += (len(body) + 2).to_bytes(2, "little") + body
    parts = b"\x01\x50\x00\x54" + parts + b"\x00" * 4
    blocks = -(-len(parts) // 512)
    return (parts[:2] + bytes([blocks]) + parts[3:]).ljust(512 * blocks, b"\0")


def _whole(value: int) -> bytes:
    return int(value).to_bytes(2, "little", signed=value < 0)


def _c3d_file(frames: bytes, count: int, points: int, channels: dict[str, object]) -> bytes:
    """A C3D of whole numbers: ``channels`` holds OFFSET and FORMAT of analog channels."""
    scale = np.float32(0.1).tobytes()
    used = len(channels.get("OFFSET", ()))
    groups = {
        "POINT": {
            "USED": (2, [], _whole(points)), "SCALE": (4, [], scale),
            "RATE": (4, [], np.float32(100).tobytes()),
            "DATA_START": (2, [], _whole(0)), "FRAMES": (2, [], _whole(count)),
            "LABELS": (-1, [4, points], b"A   " * points), "UNITS": (-1, [2], b"mm"),
        },
        "ANALOG": {
            "USED": (2, [], _whole(used)), "GEN_SCALE": (4, [], np.float32(1).tobytes()),
            "RATE": (4, [], np.float32(100).tobytes()),
        },
        "FORCE_PLATFORM": {"USED": (2, [], _whole(0))},
    }  # fmt: skip
    if used:
        groups["ANALOG"] |= {
            "LABELS": (-1, [4, used], b"Fz  " * used),
            "SCALE": (4, [used], np.full(used, 0.01, "<f4").tobytes()),
            "OFFSET": (2, [used], b"".join(map(_whole, channels["OFFSET"]))),
            "FORMAT": (-1, [8], str(channels["FORMAT"]).ljust(8).encode()),
        }
    section = _parameters(groups)
    start = 2 + len(section) // 512
    at = section.index(b"DATA_START") + 10 + 4
    section = section[:at] + _whole(start) + section[at + 2 :]
    head = np.zeros(256, dtype="<u2")
    head[0] = 0x5002
    head[1:5] = points, used, 1, count
    head[8:10] = start, (1 if used else 0)
    data = head.tobytes()
    data = data[:12] + scale + data[16:20] + np.float32(100).tobytes() + data[24:]
    return data + section + frames.ljust(512 * -(-len(frames) // 512), b"\0")


def _point_file() -> bytes:
    one = np.array([100, 200, 300], "<i2").tobytes() + bytes([8, 0b00011111])
    return _c3d_file(one * 4, 4, 1, {})


def _analog(stored: list[int], offset: int, form: str) -> str:
    import ezc3d

    point = np.array([100, 200, 300, 0], "<i2").tobytes()
    frames = b"".join(point + np.array([one], "<i4").astype("<i2").tobytes() for one in stored)
    channels = {"OFFSET": [offset], "FORMAT": form}
    path = Path(written("a.c3d", ""))
    path.write_bytes(_c3d_file(frames, len(stored), 1, channels))
    values = ezc3d.c3d(str(path))["data"]["analogs"].ravel()
    return ", ".join(f"{one:.2f}" for one in values) + " N"


@row(
    "a recording",
    "ezc3d",
    "Stored counts 950, 0 at an OFFSET of -50, SCALE 0.01 N",
    "10.00, 0.50 N ((stored - OFFSET) SCALE)",
    "10.00, 0.50 N",
    "Zero the amplifier, not the file",
)
def _() -> str:
    return _analog([950, 0], -50, "SIGNED")


@row(
    "a recording",
    "ezc3d",
    "Unsigned samples 32767, 40000 at an OFFSET of 32768",
    "-0.01, 72.32 N",
    "-0.01, 72.32 N",
    "Export as floating point",
)
def _() -> str:
    return _analog([32767, 40000], 32768, "UNSIGNED")


@row(
    "a recording",
    "whittaker-eilers",
    "A ramp from 1 to 7 in 600 samples at 1 kHz, times in s, order 2",
    "the ramp (its second difference is 0)",
    "own filters",
    "Give times in samples, or none",
)
def _() -> str:
    from whittaker_eilers import WhittakerSmoother

    x = np.arange(600) / 1000.0
    y = np.linspace(1.0, 7.0, 600)
    made = WhittakerSmoother(lmbda=2e4, order=2, data_length=600, x_input=x.tolist())
    return f"off by {np.abs(np.array(made.smooth(y.tolist())) - y).max():.1f}"


@row(
    "a recording",
    "whittaker-eilers",
    "One noisy record, strength 500, order 2: with times 0, 1, 2 ... and without",
    "the same curve",
    "own filters",
    "Multiply the strength by (order!)²",
)
def _() -> str:
    from whittaker_eilers import WhittakerSmoother

    y = np.sin(np.arange(200) / 9.0) + np.random.default_rng(1).normal(0, 0.5, 200)
    plain = WhittakerSmoother(lmbda=500, order=2, data_length=200)
    timed = WhittakerSmoother(
        lmbda=500, order=2, data_length=200, x_input=np.arange(200.0).tolist()
    )
    apart = np.abs(np.array(plain.smooth(y.tolist())) - timed.smooth(y.tolist())).max()
    return f"{apart:.2f} apart"


# A scan or a surface


def _wave(n: int, k: int, sign: int) -> np.ndarray:
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    return np.cos(2 * np.pi * k * (x + sign * y) / n)


def _rough(n: int, finest: int) -> np.ndarray:
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    spectrum = tm.Isopowerlaw2D()
    spectrum.q0, spectrum.q1, spectrum.q2, spectrum.hurst = 4, 4, finest, 0.8
    maker = tm.SurfaceGeneratorFilter2D([n, n])
    maker.spectrum, maker.random_seed = spectrum, 1
    return np.array(maker.buildSurface())


@row(
    "a scan or a surface",
    "tamaas",
    "An oblique wave of 8 samples and its mirror image: rms slope by finite differences",
    "one number for both",
    "one number (`rms_slope`)",
    "Use computeSpectralRMSSlope",
)
def _() -> str:
    import tamaas as tm

    one, other = (tm.Statistics2D.computeFDRMSSlope(_wave(64, 8, s)) for s in (1, -1))
    return f"the mirror image has {min(one, other) / max(one, other):.3f} of it"


@row(
    "a scan or a surface",
    "tamaas",
    "Moments and slope of one rough surface: slope² over 2 m2",
    "1 (Nayak)",
    "slopes and curvatures in radians",
    "Multiply m2 by (2π)², m4 by (2π)⁴",
)
def _() -> str:
    import tamaas as tm

    z = _rough(128, 32)
    slope = tm.Statistics2D.computeSpectralRMSSlope(z)
    return f"{slope**2 / (2 * tm.Statistics2D.computeMoments(z)[1]):.2f}"


@row(
    "a scan or a surface",
    "tamaas",
    "Mean of a constant 1 over 16 angles (radial_average)",
    "1",
    "no such mean",
    "endpoint=True, with angles without 2π",
)
def _() -> str:
    from tamaas.utils import radial_average

    x = np.linspace(-1, 1, 33)
    angles = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    made = radial_average(x, x, np.ones((33, 33)), np.array([0.3, 0.5]), angles)
    return f"{float(np.ravel(made)[0]):.4f}"


@row(
    "a scan or a surface",
    "tamaas",
    "hertz_surface([1, 2], [32, 64], 1): the shape of its array",
    "(32, 64)",
    "own bodies",
    "Make the paraboloid by hand",
)
def _() -> str:
    from tamaas.utils import hertz_surface

    return str(tuple(np.shape(hertz_surface([1, 2], [32, 64], 1.0))))


@row(
    "a scan or a surface",
    "tamaas",
    "A model of 6 MPa, written by NumpyDumper and read again: its E",
    "6000000",
    "a result keeps its case",
    "Keep E and ν beside the file",
)
def _() -> str:
    import os

    import tamaas as tm
    from tamaas.dumpers import NumpyDumper

    folder, here = tempfile.mkdtemp(), Path.cwd()
    os.chdir(folder)
    try:
        model = tm.Model(tm.model_type.basic_2d, [1.0, 1.0], [16, 16])
        model.E, model.nu = 6e6, 0.5
        dumper = NumpyDumper("a", "traction")
        dumper << model
        path = next(Path(folder).rglob("*.np*"))
        return f"{NumpyDumper.read(str(path)).E:g}"
    finally:
        os.chdir(here)


@row(
    "a scan or a surface",
    "tamaas",
    "A rough half-space at one load, driven by its gap: share of pressure above 0",
    "0.018 (pressure-driven; points without gap)",
    "driven by the load",
    "Count the points without gap",
)
def _() -> str:
    import tamaas as tm

    model = tm.Model(tm.model_type.basic_2d, [1.0, 1.0], [64, 64])
    kind = tm.PolonskyKeerRey
    z = 0.01 * _rough(64, 16)
    kind(model, z, 1e-9, primal_type=kind.gap, constraint_type=kind.pressure).solve(0.02)
    share = float(np.mean(np.asarray(model.traction) > 0))
    return f"{share:.3f}; without gap {float(np.mean(np.asarray(model['gap']) == 0)):.3f}"


@row(
    "a scan or a surface",
    "gstools",
    "A stable field (length 8, α 1.5), 10,000 modes: correlation of neighbours",
    "0.957 (the model's)",
    "own surfaces",
    "Use Matern or Gaussian",
)
def _() -> str:
    import gstools

    model = gstools.Stable(dim=2, var=1.0, len_scale=8.0, alpha=1.5)
    seen = []
    for seed in range(3):
        z = gstools.SRF(model, seed=seed, mode_no=10_000).structured([np.arange(64.0)] * 2)
        seen.append(np.corrcoef(z[1:].ravel(), z[:-1].ravel())[0, 1])
    return f"{float(np.mean(seen)):.2f}"


# A rubber or a fluid


def _viscosity(name: str, kelvin: float) -> str:
    from thermo import Chemical

    return f"{1e3 * Chemical(name, T=kelvin).mu:.3g} mPa s"


@row(
    "a rubber or a fluid",
    "thermo",
    "90 % glycerol in water, 20 °C",
    "219 mPa s (Segur and Oberstar 1951)",
    "224 mPa s",
    "Take a table, or Cheng's formula",
)
def _() -> str:
    from thermo import Mixture

    return f"{1e3 * Mixture(['glycerol', 'water'], ws=[0.9, 0.1], T=293.15).mu:.3g} mPa s"


@row(
    "a rubber or a fluid",
    "thermo",
    "60 % glycerol in water, 20 °C",
    "10.8 mPa s (Segur and Oberstar 1951)",
    "10.9 mPa s",
    "Take a table, or Cheng's formula",
)
def _() -> str:
    from thermo import Mixture

    return f"{1e3 * Mixture(['glycerol', 'water'], ws=[0.6, 0.4], T=293.15).mu:.3g} mPa s"


for _name, _kelvin, _measured in (("oleic acid", 298.15, "27.6"), ("squalane", 293.15, "28 to 36"),
                                  ("dibutyl phthalate", 298.15, "16.6")):  # fmt: skip
    row("a rubber or a fluid", "thermo", f"{_name.capitalize()}, {_kelvin - 273.15:.0f} °C",
        f"{_measured} mPa s (measured)", "a viscosity that is given", "Give a measured viscosity"
        )(lambda n=_name, k=_kelvin: _viscosity(n, k))  # fmt: skip


def _tension(material, stretch: float) -> str:
    """Nominal stress; the transverse one is taken off as pressure: the volume is kept."""
    f = np.diag([stretch, stretch**-0.5, stretch**-0.5]).reshape(3, 3, 1, 1)
    p = np.asarray(material.jacobian(f)).reshape(3, 3)
    return f"{p[0, 0] - p[1, 1] * stretch**-1.5:.3f} MPa"


@row("a rubber or a fluid", "hypermat", "Yeoh's rubber 0.5, -0.01, 0.2 MPa at twice its length",
     "10.010 MPa (by hand; its Biderman agrees)", "no such rubber",
     "Use Biderman with C01 = 0")  # fmt: skip
def _() -> str:
    from hypermat import Yeoh

    return _tension(Yeoh(C10=0.5, C20=-0.01, C30=0.2, K=2000), 2.0)


@row("a rubber or a fluid", "hypermat", "Isihara's rubber 0.4, 0.02, 0.2 MPa at twice its length",
     "2.030 MPa (by hand; its Biderman agrees)", "no such rubber",
     "Use Biderman with C30 = 0")  # fmt: skip
def _() -> str:
    from hypermat import Isihara

    return _tension(Isihara(C10=0.4, C20=0.02, C01=0.2, K=2000), 2.0)


@row("a rubber or a fluid", "pyvisq", "Spring 2 and springpot (1, 0.5) in series: G at t = 1",
     "0.511 (closed form; its FracMaxwell agrees)", "series of exponentials",
     "Use FracMaxwell with an exponent of 0")  # fmt: skip
def _() -> str:
    from pyvisq.models.elements import SpringParams, SpringpotParams
    from pyvisq.models.maxwell import FracSpringMaxwell, FracSpringMaxwellParams

    pot, spring = SpringpotParams(e=0.5, ce=1.0), SpringParams(k=2.0)
    return f"{FracSpringMaxwell(FracSpringMaxwellParams(springpot=pot, spring=spring)).G(1.0):.3f}"


@row("a rubber or a fluid", "pyvisq", "A power law solid, 10 at once, 1 at rest: creep at once",
     "0.1 (G J is 1 at once)", "of the same series as the modulus",
     "Compute the creep from G")  # fmt: skip
def _() -> str:
    from pyvisq.models.powerlaw import Powerlaw, PowerlawParams

    body = Powerlaw(PowerlawParams(modulus_0=10.0, modulus_inf=1.0, tau=1.0, e=0.5))
    return f"{body.J(0.0):g}, and {body.J(1e6):g} after 1e6 times"


# A study


@row(
    "a study",
    "spm1d",
    "Curves of 6 (SD 3) and of 30 (SD 1), unequal variances: t at one node",
    "Welch's",
    "curves of pairs only",
    "Keep groups of equal size",
)
def _() -> str:
    import spm1d
    from scipy.stats import ttest_ind

    rng = np.random.default_rng(3)
    a, b = rng.normal(0, 3, (6, 101)).cumsum(1), rng.normal(0, 1, (30, 101)).cumsum(1)
    t = spm1d.stats.ttest2(a, b, equal_var=False).z[50]
    pooled, welch = (float(ttest_ind(a[:, 50], b[:, 50], equal_var=e)[0]) for e in (True, False))
    kind = "pooled" if abs(t - pooled) < abs(t - welch) else "Welch's"
    return f"the {kind} t ({t:.3f}; Welch's {welch:.3f})"


_PEF = np.array([(494, 512), (395, 430), (516, 520), (434, 428), (476, 500), (557, 600), (413, 364),
                 (442, 380), (650, 658), (433, 445), (417, 432), (656, 626), (267, 260), (478, 477),
                 (178, 259), (423, 350), (427, 451)], float)  # fmt: skip
_AGREE = ("Limits of agreement of two peak flow meters, 17 subjects (Bland and Altman 1986)",
          "s 38.8, as published", "38.8", "Multiply the limits by sqrt(n / (n - 1))")  # fmt: skip


@row("a study", "pyCompare", *_AGREE)
def _() -> str:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import pyCompare

    _, axes = plt.subplots()
    pyCompare.blandAltman(*_PEF.T, confidenceInterval=None, ax=axes)
    levels = sorted({float(line.get_ydata()[0]) for line in axes.get_lines()})
    return f"s {(levels[-1] - levels[0]) / (2 * 1.96):.1f}"


@row(
    "a study",
    "SALib",
    "Sensitivity of x²: half-width of dgsm with x in mm and in µm",
    "the same: dgsm has no unit",
    "no such index",
    "Bootstrap it yourself",
)
def _() -> str:
    from SALib.analyze import dgsm
    from SALib.sample import finite_diff

    seen = []
    for scale in (1.0, 1e3):
        problem = {"num_vars": 1, "names": ["x"], "bounds": [[0.0, 10.0 * scale]]}
        x = finite_diff.sample(problem, 500, delta=0.01, seed=1)
        y = (x[:, 0] / scale) ** 2
        made = dgsm.analyze(problem, x, y, seed=1)
        seen.append(f"{float(made['dgsm'][0]):.3g} ± {float(made['dgsm_conf'][0]):.2g}")
    return " and ".join(seen)


@row(
    "a study",
    "SALib",
    "Mean square slope of x², x normal (10, 2), steps of 1 %",
    "416",
    "no such index",
    "Use uniform inputs",
)
def _() -> str:
    from SALib.analyze import dgsm
    from SALib.sample import finite_diff

    problem = {"num_vars": 1, "names": ["x"], "bounds": [[10.0, 2.0]], "dists": ["norm"]}
    x = finite_diff.sample(problem, 2000, delta=0.01, seed=1)
    return f"{float(dgsm.analyze(problem, x, x[:, 0] ** 2, seed=1)['vi'][0]):.3g}"


@row(
    "a study",
    "SALib",
    "First index of one table of 300 rows (delta.analyze), seeds 1 to 3",
    "one number: nothing is drawn for it",
    "no such index",
    "Compute it without resampling",
)
def _() -> str:
    from SALib.analyze import delta

    rng = np.random.default_rng(1)
    x = rng.random((300, 2))
    y = np.sin(3 * x[:, 0]) + 0.3 * x[:, 1]
    problem = {"num_vars": 2, "names": ["a", "b"], "bounds": [[0, 1]] * 2}
    return ", ".join(
        f"{float(delta.analyze(problem, x, y, seed=s)['S1'][0]):.3f}" for s in (1, 2, 3)
    )


def _rank(x: np.ndarray) -> str:
    k = x.shape[1]
    terms = [np.ones(len(x)), *x.T, *(x[:, i] * x[:, j] for i in range(k) for j in range(i, k))]
    return f"rank {np.linalg.matrix_rank(np.column_stack(terms))} of {len(terms)} coefficients"


@row(
    "a study",
    "pydoe",
    "Doehlert's design of three factors (doehlert_shell_design)",
    "rank 10 of 10 coefficients, every factor varied",
    "other designs",
    "Write it by hand",
)
def _() -> str:
    import pydoe

    x = np.asarray(pydoe.doehlert_shell_design(3))
    return f"{_rank(x)}, the third factor {np.abs(x[:, 2]).max():.0f} in every run"


@row(
    "a study",
    "pydoe",
    "Doehlert's simplex design of two factors: distance from the centre",
    "1",
    "other designs",
    "Write it by hand",
)
def _() -> str:
    import pydoe

    far = np.linalg.norm(np.asarray(pydoe.doehlert_simplex_design(2)), axis=1)
    far = far[far > 1e-9]
    return f"{far.min():.3f} to {far.max():.3f}"


@row(
    "a study",
    "pydoe",
    "1024 points of Niederreiter's sequence: different values of the first factor",
    "1024",
    "Sobol' points",
    "Use scipy.stats.qmc",
)
def _() -> str:
    import pydoe

    return str(len(np.unique(np.asarray(pydoe.niederreiter_sequence(1024, 2))[:, 0])))


@row(
    "a study",
    "pydoe",
    "Small composite design of five factors",
    "rank 21 of 21 coefficients (Hartley 1959)",
    "other designs",
    "Take a half fraction with stars",
)
def _() -> str:
    import pydoe

    return _rank(np.asarray(pydoe.small_composite_design(5)))


@row(
    "a study",
    "pydoe",
    "Clenshaw and Curtis' points of one factor, level 3",
    "0, 0.038, 0.146, 0.309, 0.5, 0.691, 0.854, 0.962, 1",
    "no sparse grids",
    "Use chaospy",
)
def _() -> str:
    import pydoe

    made = np.unique(np.round(np.asarray(pydoe.doe_sparse_grid(3, 1, "clenshaw_curtis")), 3))
    return ", ".join(f"{one:g}" for one in made.ravel())


@row(
    "a study",
    "pydoe",
    'Taguchi\'s array "L36(3^23)": columns of three levels',
    "23 by its name",
    "other designs",
    "Take L27 or L54",
)
def _() -> str:
    import pydoe

    made = np.asarray(pydoe.get_orthogonal_array("L36(3^23)"))
    levels = [len(np.unique(column)) for column in made.T]
    return f"{levels.count(3)}, {levels.count(2)} of two"


@row(
    "a study",
    "chaospy",
    "Fejér's second rule, order 2: sum of its weights",
    "1",
    "no such rule",
    'Use "fejer_1" or "clenshaw_curtis"',
)
def _() -> str:
    import chaospy

    return f"{chaospy.generate_quadrature(2, chaospy.Uniform(0, 1), rule='fejer_2')[1].sum():.4f}"


@row(
    "a study",
    "chaospy",
    "A normal (0, 1) within -1 and 2: its mean, and that of its quantiles",
    "0.2296 both",
    "no such cut",
    "Use TruncNormal",
)
def _() -> str:
    import chaospy

    made = chaospy.Trunc(chaospy.Normal(0, 1), lower=-1, upper=2)
    p = (np.arange(20_000) + 0.5) / 20_000
    return f"{float(chaospy.E(made)):.4f} and {float(np.mean(made.inv(p))):.4f}"


@row(
    "a study",
    "openturns",
    "LogUniform (0, 1): kurtosis",
    "1.930 (by quadrature)",
    "no such number",
    "Integrate it",
)
def _() -> str:
    import openturns

    return f"{openturns.LogUniform(0.0, 1.0).getKurtosis()[0]:.3f}"


@row(
    "a study",
    "pymannkendall",
    "400 records of 30 independent readings, tested for a trend at 5 % (Yue and Wang)",
    "5 % found",
    "not used",
    "Give lag=1, or the plain test",
)
def _() -> str:
    import pymannkendall

    rng = np.random.default_rng(1)
    found = [pymannkendall.yue_wang_modification_test(rng.normal(size=30)).h for _ in range(400)]
    return f"{np.mean(found):.0%} found"


@row(
    "a study",
    "permute",
    "Rank correlation of 3, 1, 2, 5, 4, 7, 6 with 2, 4, 1, 3, 7, 5, 6",
    "as scipy, of the ranks",
    "not used",
    "Use scipy.stats.spearmanr",
)
def _() -> str:
    from permute.core import spearman_corr
    from scipy.stats import spearmanr

    x, y = np.array([3, 1, 2, 5, 4, 7, 6]), np.array([2, 4, 1, 3, 7, 5, 6])
    return f"{float(spearman_corr(x, y, reps=10)[0]):.3f}; scipy {float(spearmanr(x, y)[0]):.3f}"


@row(
    "a study",
    "astropy",
    "12 angles in five groups, their counts as weights: Rayleigh's p",
    "p of the same angles one by one",
    "angles one by one",
    "Write the angles out",
)
def _() -> str:
    from astropy.stats import rayleightest

    angles, counts = np.radians([10.0, 20.0, 30.0, 60.0, 200.0]), np.array([3, 4, 2, 2, 1])
    grouped = float(rayleightest(angles, weights=counts))
    single = float(rayleightest(np.repeat(angles, counts)))
    return f"{grouped:.3f}; one by one {single:.4f}"


@row(
    "a study",
    "statsmodels",
    "15 slips in 40 and 7 in 35: interval of the difference by scores",
    "-0.034 to 0.368",
    "-0.034 to 0.368",
    "Use Newcombe's method",
)
def _() -> str:
    from statsmodels.stats.proportion import confint_proportions_2indep

    try:
        low, high = confint_proportions_2indep(15, 40, 7, 35, method="score", compare="diff")
    except ValueError as error:
        return f"refused: {error}"
    return f"{low:.3f} to {high:.3f}"


@row(
    "a study",
    "statsmodels",
    "56 slips in 70 and 48 in 80: the same interval",
    "0.0528 to 0.3382 (published)",
    "0.0528 to 0.3382",
    "Use Newcombe's method",
)
def _() -> str:
    from statsmodels.stats.proportion import confint_proportions_2indep

    low, high = confint_proportions_2indep(56, 70, 48, 80, method="score", compare="diff")
    return f"{low:.4f} to {high:.4f}"


@row(
    "a study",
    "scoringrules",
    "Weighted interval score of a forecast 0.30 ± 0.05 of 0.30",
    "0.0167 (its own formula)",
    "not used",
    "Subtract the median yourself",
)
def _() -> str:
    from scoringrules import weighted_interval_score

    made = weighted_interval_score(0.30, 0.30, np.array([0.25]), np.array([0.35]), np.array([0.5]))
    return f"{float(made):.4f}"


@row(
    "a study",
    "metrolopy",
    "A U-shaped input of half-width 2: its standard uncertainty",
    "1.414 (GUM, 2 / sqrt 2)",
    "no such input",
    "Give the limits, and do not simulate",
)
def _() -> str:
    import metrolopy

    return f"{float(metrolopy.gummy(metrolopy.ArcSinDist(center=20, half_width=2)).u):.4f}"


@row(
    "a study",
    "pwlf",
    "Standard errors of a weighted line, weights 1 / sd and 10 / sd",
    "the same: a unit changes nothing",
    "no such fit",
    "Bootstrap them",
)
def _() -> str:
    import pwlf

    x = np.linspace(0, 10, 40)
    y = 1 + 2 * x + np.random.default_rng(1).normal(0, 0.3, 40)
    seen = []
    for factor in (1.0, 10.0):
        fit = pwlf.PiecewiseLinFit(x, y, weights=np.full(40, factor / 0.3))
        fit.fit_with_breaks([0.0, 5.0, 10.0])
        seen.append(float(fit.standard_errors()[1]))
    return f"{seen[0]:.2g} and {seen[1]:.2g}"


def main() -> int:
    page, write = Path(sys.argv[1]), "--write" in sys.argv
    text = page.read_text(encoding="utf-8")
    before, _, _ = text.partition(MARK)
    lines, changed = [], 0
    for hand in HAND:
        lines += [f"## You have {hand}", "", HEAD, "|---|---|---|---|---|---|"]
        for one in (one for one in ROWS if one.hand == hand):
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    seen = one.run()
            except Exception as error:
                print(f"could not run: {one.package}, {one.given}: {type(error).__name__}: {error}")
                changed += 1
                continue
            line = f"| {' | '.join(one.cells(seen))} |"
            if line not in text:
                changed += 1
                print(f"changed: {line}")
            lines.append(line)
        lines.append("")
    if write:
        page.write_text(f"{before}{MARK}\n\n" + "\n".join(lines).rstrip() + "\n", encoding="utf-8")
    print(f"{len(ROWS)} rows, {changed} changed")
    return int(changed > 0 and not write)


if __name__ == "__main__":
    sys.exit(main())
