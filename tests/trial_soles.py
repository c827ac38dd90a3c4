"""Outsoles as designers send them, made by code with their truth: patterns, scans, CAD, leftovers.

Lengths in mm. A sole is a slab with lugs sunk into it: several closed bodies that overlap, as
many exporters leave them. ``outsole_bodies`` has the soles in one closed surface.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import pytest
import shapely
import trimesh
from scipy.spatial.transform import Rotation
from shapely import Polygon, affinity

from outsole_bodies import WIDTHS, write_stl

LENGTH = 298.5
SUNK = 0.5
"""A lug reaches this far into the slab."""
SLAB = 6.0
_INCH = (
    "(CONVERSION_BASED_UNIT('INCH',#90001) LENGTH_UNIT() NAMED_UNIT(#90003))",
    "#90001=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#90002);\n"
    "#90002=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));\n"
    "#90003=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n",
)
_METRE = ("( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.) )", "")


def outline(length=LENGTH, right=True):
    """Plan form of a sole from heel (x = 0) to toe."""
    x = np.concatenate([[0.0, 0.01], np.linspace(0.03, 0.97, 60), [0.99, 1.0]])
    half = np.interp(x, *WIDTHS) * length / 298.5
    middle = np.interp(x, (0, 0.2, 0.45, 0.75, 1), (0, 0, -6, 0, 10)) * (1 if right else -1)
    there, back = (
        np.column_stack([x * length, middle - half]),
        np.column_stack([x * length, middle + half]),
    )
    return Polygon(np.concatenate([there, back[::-1]])).buffer(0)


def cap(polygon, z, up):
    """Triangles of a polygon at a height (number or function of x and y)."""
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(polygon))
    corners = np.stack([shapely.get_coordinates(part)[:3] for part in parts])
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    twice = ax * by - ay * bx
    wrong = (twice < 0) == up
    corners[wrong] = corners[wrong][:, ::-1]
    return np.dstack([corners, np.full(corners.shape[:2], float(z))])


def prism(polygon, low, high, draft=0.0):
    """A closed body over a polygon; ``draft`` (rad) makes it wider towards ``high``."""
    rings = [polygon.exterior, *polygon.interiors]
    rings = [np.asarray(ring.coords)[:-1] for ring in rings]
    rings = [ring if _area(ring) > 0 else ring[::-1] for ring in rings[:1]] + [
        ring if _area(ring) < 0 else ring[::-1] for ring in rings[1:]
    ]
    wide = [_offset(ring, (high - low) * np.tan(draft)) for ring in rings]
    parts = [
        cap(polygon, low, up=False),
        cap(Polygon(wide[0], wide[1:]), high, up=True),
    ]
    for ring, above in zip(rings, wide, strict=True):
        p, q = np.c_[ring, np.full(len(ring), low)], np.c_[above, np.full(len(ring), high)]
        following, over = np.roll(p, -1, axis=0), np.roll(q, -1, axis=0)
        parts += [np.stack([p, following, over], 1), np.stack([p, over, q], 1)]
    return np.concatenate(parts)


def _area(ring):
    x, y = ring.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _offset(ring, distance):
    """Corners of a ring moved outward so that each side moves by ``distance``."""
    if distance == 0:
        return ring
    side = np.roll(ring, -1, axis=0) - ring
    normal = np.column_stack([side[:, 1], -side[:, 0]])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    before = np.roll(normal, 1, axis=0)
    both = normal + before
    return ring + both * (2 * distance / (both**2).sum(axis=1))[:, None]


def slab(plan, low, high, step=2.0):
    """The body that carries the lugs, in strips along x, fine enough to be bent."""
    x0, _, x1, _ = plan.bounds
    places = np.arange(x0, x1, step)
    pieces = [plan.intersection(shapely.box(a, -1e3, a + step, 1e3)) for a in places]
    solid = [p for piece in pieces for p in _polygons(piece)]
    caps = [cap(p, z, up) for p in solid for z, up in ((low, False), (high, True))]
    ring = np.asarray(shapely.orient_polygons(shapely.union_all(solid)).exterior.coords)[:-1]
    p, q = np.c_[ring, np.full(len(ring), low)], np.c_[ring, np.full(len(ring), high)]
    following, over = np.roll(p, -1, axis=0), np.roll(q, -1, axis=0)
    walls = [np.stack([p, following, over], 1), np.stack([p, over, q], 1)]
    return np.concatenate(caps + walls)


def _polygons(shape) -> Iterable[Polygon]:
    return [p for p in shapely.get_parts(shape) if isinstance(p, Polygon) and p.area > 1e-3]


def hexagons(plan, width=8.0, channel=3.0):
    pitch = width + channel
    corner = np.radians(30 + 60 * np.arange(6))
    hexagon = np.column_stack([np.cos(corner), np.sin(corner)]) * width / np.sqrt(3)
    x0, y0, x1, y1 = plan.bounds
    lugs = []
    for row, y in enumerate(np.arange(y0, y1 + pitch, pitch * np.sqrt(3) / 2)):
        shift = pitch / 2 * (row % 2)
        lugs += [
            Polygon(hexagon + np.array([x, y])) for x in np.arange(x0 + shift, x1 + pitch, pitch)
        ]
    return lugs


def herringbone(plan, lug=5.0, channel=2.0, arm=15.0):
    x0, y0, x1, y1 = plan.bounds
    stretch = np.sqrt(2.0)
    lugs = []
    y = np.arange(y0 - arm, y1 + 2 * arm, arm)
    zigzag = np.where(np.arange(y.size) % 2 == 0, 0.0, arm)
    for x in np.arange(x0 - 2 * arm, x1 + arm, (lug + channel) * stretch):
        there = np.column_stack([x + zigzag, y])
        lugs.append(Polygon(np.concatenate([there, there[::-1] + np.array([lug * stretch, 0])])))
    return lugs


def bars(plan, lug=6.0, channel=4.0):
    x0, y0, x1, y1 = plan.bounds
    return [shapely.box(x, y0, x + lug, y1) for x in np.arange(x0, x1, lug + channel)]


def rings(plan, outer=24.0, inner=16.0, pitch=32.0):
    x0, y0, x1, y1 = plan.bounds
    centres = [(x, y) for x in np.arange(x0, x1, pitch) for y in np.arange(y0, y1, pitch)]
    return [
        shapely.Point(c).buffer(outer / 2).difference(shapely.Point(c).buffer(inner / 2))
        for c in centres
    ]


def odd_lugs(plan, seed=3):
    """Blocks, bars and triangles up to 30 mm apart, as on trail shoes and cleats."""
    rng = np.random.default_rng(seed)
    x0, y0, x1, y1 = plan.bounds
    lugs = []
    for x in np.arange(x0 + 8, x1, 29.0):
        for y in np.arange(y0 + 5, y1, 27.0):
            kind, size = rng.integers(3), rng.uniform(9, 17)
            block = shapely.box(-size / 2, -size / 2, size / 2, size / 2)
            if kind == 1:
                block = affinity.scale(block, 1.5, 0.7)
            if kind == 2:
                block = Polygon([(-size / 2, -size / 2), (size / 2, 0), (-size / 2, size / 2)])
            turned = affinity.rotate(block, rng.uniform(0, 90))
            lugs.append(affinity.translate(turned, x + rng.uniform(-3, 3), y + rng.uniform(-3, 3)))
    return lugs


def treaded(plan, lugs, depth, *, draft=0.0, high=SLAB, lowest=1.0):
    """Triangles of slab and lugs, lugs inside the plan form; land area in mm^2."""
    kept = [p for lug in lugs for p in _polygons(lug.intersection(plan)) if p.area > lowest]
    bodies = [prism(p.simplify(1e-3), 0.0, depth + SUNK, draft) for p in kept]
    body = np.concatenate([slab(plan, depth, depth + high), *bodies])
    return body, float(sum(p.area for p in kept))


def sprung(body, toe=18.0, bevel=8.0, length=LENGTH):
    """The body bent up at the toe and bevelled at the heel."""
    x = body[..., 0]
    lift = toe * np.clip((x / length - 0.70) / 0.30, 0, 1) ** 2
    lift = lift + np.clip(25.0 - x, 0, None) * np.tan(np.radians(bevel))
    return np.dstack([body[..., 0], body[..., 1], body[..., 2] + lift])


@dataclass(frozen=True)
class Truth:
    """What is known of a sole; None: not looked at. Lengths in mm, land 0 to 1."""

    land: float | None = None
    depth: float | None = None
    width: float | None = None
    length: float | None = None
    foot: str | None = None


@dataclass(frozen=True)
class Trial:
    """An outsole file: how it is written into a folder, and what it truly is."""

    name: str
    write: Callable
    truth: Truth


def stl(body):
    """A binary STL of triangles, or of those that a function makes."""

    def write(folder):
        corners = body() if callable(body) else body
        return write_stl(folder / "sole.stl", np.ascontiguousarray(corners, dtype=np.float32))

    return write


def by_trimesh(kind, *bodies, names=("outsole",), scale=1.0):
    """A file of one or several named bodies in a format that trimesh writes."""

    def write(folder):
        scene = trimesh.Scene()
        for name, body in zip(names, bodies, strict=True):
            body = body() if callable(body) else body
            corners = np.asarray(body).reshape(-1, 3) * scale
            mesh = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3))
            mesh.merge_vertices()
            scene.add_geometry(mesh, node_name=name, geom_name=name)
        path = folder / f"sole.{kind}"
        what = scene if kind in ("glb", "gltf", "3mf") else trimesh.util.concatenate(scene.dump())
        data = what.export(file_type=kind)
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return path

    return write


def obj_groups(bodies):
    """OBJ text with one object a body."""

    def write(folder):
        lines, count = [], 0
        for name, body in bodies.items():
            lines.append(f"o {name}")
            lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in np.asarray(body).reshape(-1, 3)]
            faces = range(count + 1, count + 3 * len(body), 3)
            lines += [f"f {n} {n + 1} {n + 2}" for n in faces]
            count += 3 * len(body)
        path = folder / "shoe.obj"
        path.write_text("\n".join(lines) + "\n")
        return path

    return write


def step(make, unit=None, brep=False):
    """STEP of the shapes that ``make(occ)`` returns; ``unit`` as the file states it."""

    def write(folder):
        occ = pytest.importorskip("netgen.occ")
        path = folder / ("sole.brep" if brep else "sole.step")
        shape = make(occ)
        if brep:
            shape.WriteBrep(str(path), True, True, 3, True)
            return path
        shape.WriteStep(str(path))
        if unit:
            restate_unit(path, *unit)
        return path

    return write


def restate_unit(path, line, further=""):
    """Make a STEP file state another unit, its numbers left as they are."""
    stated = re.compile(
        r"\(\s*LENGTH_UNIT\(\)\s*NAMED_UNIT\(\*\)\s*SI_UNIT\(\.MILLI\.,\.METRE\.\)\s*\)"
    )
    text, count = stated.subn(lambda _: line, path.read_text())
    assert count
    head, end, tail = text.rpartition("ENDSEC;")
    path.write_text(head + further + end + tail)


STEP_LAND = 0.8


def step_bars(occ, scale=1.0, fused=True, only_faces=False):
    """A sole 240 x 68 mm with 12 channels 4 mm wide and 4 mm deep."""
    base = occ.Box((0, -34, 4), (240, 34, 14))
    lugs = [occ.Box((20.0 * n, -34, 0), (20.0 * n + 16, 34, 4)) for n in range(12)]
    if fused:
        whole = base
        for lug in lugs:
            whole = whole + lug
        parts = [whole]
    else:
        parts = [base, *lugs]
    if only_faces:
        parts = [face for part in parts for face in part.faces]
    if scale != 1.0:
        parts = [part.Scale(occ.Pnt(0, 0, 0), scale) for part in parts]
    return occ.Compound(parts)


def step_assembly(occ, names=True):
    """Outsole, midsole and last, one above the other."""
    outsole = step_bars(occ).solids[0]
    midsole = occ.Box((-3, -37, 14), (243, 37, 40))
    last = occ.Box((0, -33, 40), (240, 33, 70)) + occ.Box((0, -30, 70), (90, 30, 140))
    for shape, name in ((outsole, "outsole"), (midsole, "midsole"), (last, "last")):
        shape.solids.name = name if names else "body"
    return occ.Compound([outsole, midsole, last])


def last_above(body, top):
    """A last as a stack of slabs that shrink upward: 100 mm high at the heel."""
    layers = [
        slab(outline().buffer(3 - 0.25 * z), top + z, top + z + 10.0, 4.0)
        for z in np.arange(0, 60, 10.0)
    ]
    shaft = affinity.translate(shapely.Point(0, 0).buffer(28), 45, 0)
    return np.concatenate([*layers, prism(shaft, top + 50, top + 110)])


def other_foot(body, shift=125.0):
    mirrored = (np.asarray(body) * (1, -1, 1))[:, ::-1]
    return mirrored + np.array([0, shift, 0])


def scanned(body, noise=0.08, side=0.9, holes=0, underside=False, seed=1):
    """Triangles of a scan of a body: sides up to ``side``, noise (mm) in z on every point."""
    corners = np.asarray(body, dtype=np.float64)
    points, faces = trimesh.remesh.subdivide_to_size(
        corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3), side
    )
    rng = np.random.default_rng(seed)
    keys = np.round(points * 1e3).astype(np.int64) @ np.array([1, 1 << 21, 1 << 42])
    _, same = np.unique(keys, return_inverse=True)
    points[:, 2] += rng.normal(0, noise, same.max() + 1)[same.ravel()]
    corners = points[faces]
    centres = corners.mean(axis=1)
    if underside:
        corners, centres = (each[centres[:, 2] < 4.0] for each in (corners, centres))
    low = np.flatnonzero(centres[:, 2] < 4.0)
    keep = np.ones(len(corners), bool)
    for place in centres[rng.choice(low, holes)]:
        keep[low] &= np.hypot(*(centres[low] - place)[:, :2].T) > rng.uniform(0.8, 2.0)
    return corners[keep]


def floor_plane(size=500.0, z=0.0, step=4.0, noise=0.0, seed=2):
    """A square of floor under everything."""
    places = np.arange(-size / 2, size / 2 + step, step)
    x, y = np.meshgrid(places + LENGTH / 2, places, indexing="ij")
    rng = np.random.default_rng(seed)
    points = np.stack([x, y, z + rng.normal(0, 1, x.shape) * noise], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    return np.concatenate([np.stack([a, b, c], -2), np.stack([a, c, d], -2)]).reshape(-1, 3, 3)


def draft_piece():
    """A block 70 x 66 mm of drafted bars across and a rim channel on one side."""
    plan = shapely.box(0, -33, 70, 33)
    lugs = [shapely.box(x, -27, x + 7, 27) for x in (2, 14, 26, 38, 50, 61)]
    body, _ = treaded(plan, lugs, 3.5, draft=np.radians(8))
    return body


def trials() -> list[Trial]:
    """The files, in the order of a designer's day."""
    plan = outline()
    hexes, hex_land = treaded(plan, hexagons(plan), 3.5)
    odd, odd_land = treaded(plan, odd_lugs(plan), 4.0)
    ring, ring_land = treaded(plan, rings(plan), 3.0)
    zigzag, zigzag_land = treaded(plan, herringbone(plan), 2.5)
    drafted, draft_land = treaded(plan, hexagons(plan), 3.5, draft=np.radians(8))
    sipes = shapely.union_all([shapely.box(x, -80, x + 0.6, 80) for x in np.arange(3, 298, 6.0)])
    siped = [p for lug in odd_lugs(plan) for p in _polygons(lug.difference(sipes))]
    sipe_body, sipe_land = treaded(plan, siped, 4.0, lowest=0.2)
    plan_small = outline(125.0)
    small, small_land = treaded(plan_small, hexagons(plan_small, 6.0, 2.0), 2.0)
    area = plan.area

    def of(land, depth=None, width=None, length=LENGTH, foot="right"):
        return Truth(land / area, depth, width, length, foot)

    hex_truth = of(hex_land, 3.5, 3.0)
    scan_truth = hex_truth
    on_head = Rotation.from_euler("xz", (180, 30), degrees=True).as_matrix().T
    left = other_foot(odd, 0.0)
    step_truth = Truth(STEP_LAND, 4.0, 4.0, 240.0)
    top = last_above(hexes, 9.5)
    pair = np.concatenate([hexes, other_foot(hexes)])

    def step_pair(occ):
        one = step_bars(occ).solids[0]
        return occ.Compound([one, one.Move((0, 110, 0))])

    return [
        Trial("hexagons, flat", stl(hexes), hex_truth),
        Trial("hexagons, toe spring and bevel", stl(sprung(hexes)), hex_truth),
        Trial("herringbone", stl(zigzag), of(zigzag_land, 2.5, 2.0)),
        Trial("suction rings", stl(ring), of(ring_land, 3.0)),
        Trial("smooth slab", stl(slab(plan, 0, 8)), of(area)),
        Trial("odd lugs up to 30 mm apart", stl(odd), of(odd_land, 4.0)),
        Trial("left shoe of it", stl(left), of(odd_land, 4.0, foot="left")),
        Trial("sipes through its lugs", stl(sipe_body), of(sipe_land, 4.0)),
        Trial("draft of 8 degrees", stl(drafted), of(draft_land, 3.5)),
        Trial(
            "drafted piece 70 x 66", stl(draft_piece()), Truth(6 * 7 * 54 / 4620, 3.5, None, 70.0)
        ),
        Trial("scan", stl(lambda: scanned(hexes)), scan_truth),
        Trial(
            "scan with 40 holes, PLY",
            by_trimesh("ply", lambda: scanned(hexes, holes=40)),
            scan_truth,
        ),
        Trial(
            "underside alone, holes",
            stl(lambda: scanned(hexes, holes=40, underside=True)),
            scan_truth,
        ),
        Trial("on its head, 30 degrees, metres", stl(hexes @ on_head / 1e3), hex_truth),
        Trial("y up", stl(hexes[..., [0, 2, 1]] * (1, 1, -1)), hex_truth),
        Trial("200 m off", stl(hexes + np.array([2e5, 0, 0])), hex_truth),
        Trial("floor plane apart", stl(np.concatenate([hexes, floor_plane()])), hex_truth),
        Trial(
            "floor plane of a scan",
            stl(lambda: np.concatenate([scanned(hexes), floor_plane(z=9.4, noise=0.05)])),
            scan_truth,
        ),
        Trial("STEP mm", step(step_bars), step_truth),
        Trial("STEP inch", step(lambda o: step_bars(o, 1 / 25.4), _INCH), step_truth),
        Trial("STEP m", step(lambda o: step_bars(o, 1e-3), _METRE), step_truth),
        Trial("STEP, unfused solids", step(lambda o: step_bars(o, fused=False)), step_truth),
        Trial("STEP, faces alone", step(lambda o: step_bars(o, only_faces=True)), step_truth),
        Trial("STEP of an assembly", step(step_assembly), step_truth),
        Trial("STEP of an assembly, no names", step(lambda o: step_assembly(o, False)), step_truth),
        Trial("OBJ with the last above", obj_groups({"a": hexes, "b": top}), hex_truth),
        Trial("STL with the last above", stl(np.concatenate([hexes, top])), hex_truth),
        Trial("pair, STL", stl(pair), hex_truth),
        Trial("pair, STEP", step(step_pair), step_truth),
        Trial(
            "GLB in metres",
            by_trimesh("glb", hexes[..., [0, 2, 1]] * (1, 1, -1), scale=1e-3),
            hex_truth,
        ),
        Trial("3MF", by_trimesh("3mf", hexes), hex_truth),
        Trial("OFF", by_trimesh("off", hexes), hex_truth),
        Trial("BREP", step(step_bars, brep=True), step_truth),
        Trial(
            "small child's sole, 125 mm",
            stl(small),
            Truth(small_land / plan_small.area, 2.0, 2.0, 125.0, "right"),
        ),
    ]


def iges_block(low, high, unit):
    """IGES text of a block of six bilinear B-spline faces (entity 128); ``unit`` is its flag."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    corners = np.array([[(x, y, z) for z in (z0, z1)] for y in (y0, y1) for x in (x0, x1)])
    a, b, c, d = corners[0], corners[1], corners[2], corners[3]
    faces = [
        (a[0], b[0], c[0], d[0]),
        (a[1], b[1], c[1], d[1]),
        (a[0], b[0], a[1], b[1]),
        (c[0], d[0], c[1], d[1]),
        (a[0], c[0], a[1], c[1]),
        (b[0], d[0], b[1], d[1]),
    ]
    start = [f"{'A block of six faces':72}S{1:7}"]
    fields = "1H,,1H;,4Hsole,8Hsole.igs,4Hhand,4Hhand,32,38,6,308,15,4Hsole,1.,"
    fields += (
        f"{unit},2HCM,1,0.01,15H20260101.000000,1E-6,100.,4Hhand,4Hhand,11,0,15H20260101.000000;"
    )
    glob = [fields[n : n + 72] for n in range(0, len(fields), 72)]
    glob = [f"{line:72}G{n:7}" for n, line in enumerate(glob, start=1)]
    directory, parameters = [], []
    for face in faces:
        points = ",".join(f"{value:.6f}" for corner in face for value in corner)
        text = f"128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,{points},0.,1.,0.,1.;"
        rows, row = [], ""
        for part in re.findall(r"[^,;]*[,;]", text):
            if len(row) + len(part) > 64:
                rows.append(row)
                row = ""
            row += part
        rows.append(row)
        entry, first = len(directory) + 1, len(parameters) + 1
        numbers = [128, first, 0, 0, 0, 0, 0, 0]
        directory.append("".join(f"{n:8}" for n in numbers) + f"{'00000000':>8}D{entry:7}")
        numbers = [128, 0, 0, len(rows), 0]
        tail = f"{'':8}{'':8}{'':8}{0:8}"
        directory.append("".join(f"{n:8}" for n in numbers) + tail + f"D{entry + 1:7}")
        for row in rows:
            parameters.append(f"{row:64}{entry:8}P{len(parameters) + 1:7}")
    end = f"S{len(start):7}G{len(glob):7}D{len(directory):7}P{len(parameters):7}"
    lines = [*start, *glob, *directory, *parameters, f"{end:72}T{1:7}"]
    return "\n".join(lines) + "\n"
