"""Soles for other programs: how large is the GLB, and how far are its edges from those of CAD?

``python -m benchmarks light_soles``: five treads on a heel and one on a whole sole, each run on a
coarse grid. Prints the size of the file, and the distance in plan from the drawn edges of lugs to
the upright faces of the solid that ``underfoot export --to step`` would write.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray

from underfoot import Case, run
from underfoot.compute.sole import new_sole, sole_map
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


def edge_errors(case: Case, folder: Path) -> NDArray[np.float64]:
    """Return how far (mm, in plan) the drawn edges of lugs are from the solid's upright faces."""
    level = case.replace("motion.shoe_angle", "0 deg")
    file = folder / "sole.stl"
    file.unlink(missing_ok=True)
    write_sole(new_sole(level), file)
    solid = trimesh.load_mesh(file)
    upright = solid.triangles[np.abs(solid.face_normals[:, 2]) < 0.02][:, :, :2]
    sides = np.stack([upright, np.roll(upright, -1, axis=1)], axis=2).reshape(-1, 2, 2)
    faces = shapely.STRtree(shapely.linestrings(sides))
    sole = drawn_sole(map_fields(sole_map(level, 1e-3)))
    surface = designed_surface(level, spacing_for(sole))
    walls = surface.walls[surface.land[surface.walls[:, 0]] != surface.land[surface.walls[:, 2]]]
    ends = 1e3 * surface.points[walls[:, :2], :2]
    points = np.concatenate([ends[:, 0], ends.mean(axis=1)])
    _, away = faces.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    return away


def main() -> None:
    """Print size and edges of each sole."""
    print(f"{'sole':<18}{'GLB (MB)':>9}{'corners':>9}  edges off by (mm): median, 95 %, most")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for name, case in soles().items():
            file = folder / "sole.glb"
            export_result(run(case, quick=True), file)
            (mesh,) = trimesh.load(file, process=False).geometry.values()
            size, off = file.stat().st_size / 1e6, edge_errors(case, folder)
            median, most = np.quantile(off, [0.5, 0.95])
            told = "" if size < LARGEST and off.max() <= WITHIN else "  above the aim"
            print(
                f"{name:<18}{size:9.2f}{len(mesh.vertices):9d}  {median:.3f} {most:.3f} "
                f"{off.max():.3f}{told}",
                flush=True,
            )


if __name__ == "__main__":
    main()
