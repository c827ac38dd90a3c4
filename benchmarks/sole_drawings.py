"""One tread in other clothes: are COF and load on the film those of the tread, not of its file?

``python -m benchmarks sole_drawings``: bars drawn at five places along a heel as STL files, and
one of them mirrored, turned, in inches and as a scan with 0.1 mm of noise, each by a default run.
Prints the largest difference beside what is allowed.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import trimesh

from underfoot import Case, run
from underfoot.compute.sole import new_sole
from underfoot.shoe.parametric import write_sole

from .tread_widths import bars

PLACES = (0.0, 2e-3, 4e-3, 6e-3, 8e-3)
"""m along the heel; a period of the bars is 10 mm."""
TURN, NOISE, SEED = np.radians(37.0), 0.1, 5
"""Angle of the turned file; noise of the scan, mm."""
ALLOWED = {  # relative: COF, load on the film
    "places": (0.02, 0.10),
    "mirrored": (0.005, 0.005),
    "turned": (0.005, 0.005),
    "inches": (0.001, 0.001),
    "scan": (0.03, 0.10),
}


def numbers(base: Case, path: Path, **how: object) -> tuple[float, float]:
    """Return COF and load on the film, N, of a default run of a file."""
    parts = {"shoe.heel": None, "shoe.tread": None, "shoe.sole": None}
    result = run(base.replace({**parts, "shoe.outsole": {"file": str(path), **how}}))
    return result.value("cof"), result.value("fluid_load")


def dressed(path: Path) -> Iterator[tuple[str, Path, dict[str, object]]]:
    """Yield (what, file, how it is read) of one sole in other clothes."""
    mesh = trimesh.load_mesh(path)

    def written(name: str, changed: trimesh.Trimesh) -> Path:
        place = path.with_name(f"{name}.stl")
        changed.export(place)
        return place

    flip = mesh.copy()
    flip.apply_transform(np.diag([1.0, -1.0, 1.0, 1.0]))
    yield "mirrored", written("mirrored", flip), {}
    turned = mesh.copy()
    turned.apply_transform(trimesh.transformations.rotation_matrix(TURN, [0, 0, 1]))
    yield "turned", written("turned", turned), {}
    inches = mesh.copy()
    inches.apply_scale(1 / 25.4)
    yield "inches", written("inches", inches), {"unit": "inch"}
    points, faces = trimesh.remesh.subdivide_to_size(mesh.vertices, mesh.faces, 0.8)
    scan = trimesh.Trimesh(points, faces)
    away = NOISE * np.random.default_rng(SEED).standard_normal(len(scan.vertices))
    scan.vertices = scan.vertices + away[:, None] * scan.vertex_normals
    yield "scan", written("scan", scan), {}


def main() -> None:
    """Print the numbers of each drawing and the largest differences."""
    base = bars({})
    shape = new_sole(base)
    assert shape.tread is not None
    tread, seen, began = shape.tread, {}, time.process_time()

    def told(kind: str, name: str, values: tuple[float, float]) -> None:
        seen.setdefault(kind, []).append(values)
        print(f"{name:<24}COF {values[0]:.4f}  film {values[1]:7.2f} N", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        drawn = Path(folder) / "drawn.stl"
        for place in PLACES:
            drawn.unlink(missing_ok=True)
            write_sole(replace(shape, tread=tread.shift_grooves((place, 0.0))), drawn)
            told("places", f"{1e3 * place:g} mm further on", numbers(base, drawn))
        own = seen["places"][-1]
        for kind, path, how in dressed(drawn):
            told(kind, kind, numbers(base, path, **how))
            seen[kind].append(own)
    for kind, values in seen.items():
        low, high = np.min(values, axis=0), np.max(values, axis=0)
        cof, film = high / low - 1
        most = " and ".join(f"{share:.1%}" for share in ALLOWED[kind])
        print(f"{kind:<12}COF within {cof:.2%}, film within {film:.2%} ({most} allowed)")
    print(f"{time.process_time() - began:.0f} s of CPU")


if __name__ == "__main__":
    main()
