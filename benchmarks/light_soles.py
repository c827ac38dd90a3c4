"""Soles for other programs: how large is the GLB, and how far are its edges from those of CAD?

``python -m benchmarks light_soles``: five treads on a heel and one on a whole sole, each run on a
coarse grid, by its lengths and from its file. Prints the size of the GLB, and the distance in plan
from the drawn edges of lugs to the upright faces of the solid that ``underfoot export --to step``
would write.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray

from underfoot import Case, run
from underfoot.compute.sole import drawn_file, new_sole, sole_map
from underfoot.report.drawn_sole import drawn_sole
from underfoot.report.light_mesh import spacing_for
from underfoot.report.results import designed_surface, map_fields
from underfoot.report.sole_export import export_result
from underfoot.shoe.parametric import write_sole

PATTERNS = ("grid", "hexagons", "circles", "longitudinal", "transverse")
WHOLE = {
    "plan": "sole", "side": "right", "length": "290 mm", "width": "68 mm",
    "waist_width": "58 mm", "ball_width": "102 mm", "edge_radius": "2 mm",
}  # fmt: skip
COARSE = {
    "numerics.grid_spacing": "1.2 mm",
    "numerics.quick_grid_spacing": "1.2 mm",
    "numerics.tread_positions": 1,
}
LARGEST, WITHIN = 3.0, 0.05
"""MB of a file, mm of an edge: the figures that are aimed at."""


def soles() -> dict[str, Case]:
    """Return the cases by what stands in the first column."""
    entries = {"floor": "vinyl_g4", "contaminant": "glycerol_90pct", "motion": "slip_tester_g4"}
    base = Case.from_mapping({"shoe": "work_shoe_full_tread", **entries}).replace(COARSE)
    made = {f"heel, {name}": base.replace("shoe.tread.pattern", name) for name in PATTERNS}
    made["whole sole"] = made["heel, hexagons"].replace({"shoe.heel": WHOLE})
    return made


def of_file(case: Case, file: Path) -> Case:
    """Return the case with its sole as a file, which is written where it is not there."""
    if not file.exists():
        write_sole(new_sole(case), file)
    parts = {"shoe.heel": None, "shoe.tread": None}
    return case.replace({**parts, "shoe.outsole": {"file": str(file)}})


def edge_errors(case: Case, file: Path) -> NDArray[np.float64]:
    """Return how far (mm, in plan) the drawn edges of lugs are from the solid's upright faces."""
    level, begin = case.replace("motion.shoe_angle", "0 deg"), np.zeros(2)
    solid = trimesh.load_mesh(file)
    upright = solid.triangles[np.abs(solid.face_normals[:, 2]) < 0.02][:, :, :2]
    sides = np.stack([upright, np.roll(upright, -1, axis=1)], axis=2).reshape(-1, 2, 2)
    faces = shapely.STRtree(shapely.linestrings(sides))
    sole = drawn_sole(map_fields(sole_map(level, 1e-3)))
    spacing = spacing_for(sole, designed=case.shoe.outsole is None)
    surface = designed_surface(level, spacing)
    if case.shoe.outsole is not None:  # counts from its rear end and its middle
        _, (_, rim) = drawn_file(level, spacing)
        low, high = 1e3 * rim.min(axis=(0, 1)), 1e3 * rim.max(axis=(0, 1))
        begin = np.array([low[0], (low[1] + high[1]) / 2])
        begin -= solid.bounds[0, 0], solid.bounds[:, 1].mean()
    walls = surface.walls[surface.land[surface.walls[:, 0]] != surface.land[surface.walls[:, 2]]]
    ends = 1e3 * surface.points[walls[:, :2], :2] - begin
    points = np.concatenate([ends[:, 0], ends.mean(axis=1)])
    _, away = faces.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    return away


def main() -> None:
    """Print size and edges of each sole, drawn by its lengths and from its file."""
    print(
        f"{'sole':<32}{'GLB (MB)':>9}{'corners':>9}  edges off by (mm): median, 95 %, most; "
        "share beyond the aim"
    )
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for name, case in soles().items():
            file = folder / f"{name}.stl"
            for kind, one in ((name, case), (f"{name}, its file", of_file(case, file))):
                glb = folder / "sole.glb"
                export_result(run(one, quick=True), glb)
                (mesh,) = trimesh.load(glb, process=False).geometry.values()
                size, off = glb.stat().st_size / 1e6, edge_errors(one, file)
                median, most = np.quantile(off, [0.5, 0.95])
                told = "" if size < LARGEST and off.max() <= WITHIN else "  above the aim"
                print(
                    f"{kind:<32}{size:9.2f}{len(mesh.vertices):9d}  {median:.3f} {most:.3f} "
                    f"{off.max():.3f} {np.mean(off > WITHIN):.2%}{told}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
