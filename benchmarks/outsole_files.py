"""A scanned STL of 3 million faces to a height map: time against memory bandwidth and a peer."""

import resource
import tempfile
import time
from pathlib import Path

import numpy as np

from underfoot.shoe._kernels.height_buffer import height_buffer
from underfoot.shoe.files import FileSettings, outsole_from_mesh, read_mesh
from underfoot.shoe.tread_measures import tread_measures

ROWS, COLUMNS = 2122, 708
TIME_LIMIT, MEMORY_LIMIT = 2.0, 2e9


def main() -> None:
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "scan.stl"
        faces = _scan(path)
        size = path.stat().st_size / 1e6
        print(f"scan of 300 x 100 mm, {faces} faces, {size:.0f} MB, noise 20 um, channels 3 mm")
        _whole(path)  # compiles, or loads what was compiled
        print(f"{'':<52}{'wall s':>8}{'CPU s':>8}")
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        mesh, *reading = _timed(lambda: read_mesh(path))
        found, *mapping = _timed(lambda: outsole_from_mesh(mesh, FileSettings()))
        _, *measuring = _timed(lambda: tread_measures(found.surface))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        total = [a + b for a, b in zip(reading, mapping, strict=True)]
        _row("read", reading)
        _row("mesh checked, sides found, levelled, mapped, repaired", mapping)
        _row("file to height map, 0.25 mm (limit 2)", total)
        _row("measures of the tread", measuring)
        triangles = mesh.triangles
        copied, *copying = _timed(triangles.copy)
        _row("limit: copying the triangles once in memory", copying)
        del copied
        axes = np.eye(3) * 1e-3
        _, *drawing = _timed(
            lambda: height_buffer(triangles, axes, (0.0, -0.05), 0.25e-3, (1200, 400))
        )
        _row("height buffer alone, 480 000 cells", drawing)
        print(f"  {drawing[1] / max(copying[1], 1e-9):.1f} times the copy")
        _peers(path, triangles, drawing[1] / 480_000)
        print(f"largest memory {peak / 1e3:.0f} MB (before {before / 1e3:.0f} MB, limit 2000 MB)")
        good = total[1] < TIME_LIMIT and peak * 1e3 < MEMORY_LIMIT
        print(("within the limits" if good else "TOO MUCH") + " (by CPU seconds)")


def _whole(path: Path) -> None:
    tread_measures(outsole_from_mesh(read_mesh(path), FileSettings()).surface)


def _peers(path: Path, triangles: np.ndarray, own: float) -> None:
    """Reading by trimesh; heights by scipy's linear interpolation on a tenth of the scan."""
    import trimesh
    from scipy.interpolate import griddata

    _, *reading = _timed(lambda: trimesh.load(path, process=False))
    _row("peer: trimesh reads the same file", reading)
    points = triangles[(triangles[:, :, 0] < 30).all(axis=1)][:, 0]
    x, y = np.meshgrid(np.arange(1, 29, 0.25), np.arange(-49, 49, 0.25), indexing="ij")
    _, *interpolating = _timed(lambda: griddata(points[:, :2], points[:, 2], (x, y)))
    _row("peer: scipy griddata, a tenth of the scan", interpolating)
    print(f"  {interpolating[1] / x.size / own:.0f} times the height buffer, per cell")


def _scan(path: Path) -> int:
    x = np.linspace(0, 0.3, ROWS)
    y = np.linspace(-0.05, 0.05, COLUMNS)
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    channel = (np.mod(grid_x, 9e-3) > 6e-3) | (np.mod(grid_y + 3e-3, 9e-3) > 6e-3)
    height = 3e-3 * channel + 10e-3 * np.clip((grid_x - 0.21) / 0.09, 0, 1) ** 2
    height += np.random.default_rng(0).normal(0, 20e-6, height.shape)
    points = (np.stack([grid_x, grid_y, height], axis=-1) * 1e3).astype(np.float32)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    corners = np.stack([np.stack([a, d, c], -2), np.stack([a, c, b], -2)], axis=2)
    corners = corners.reshape(-1, 3, 3)
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
    records = np.zeros(corners.shape[0], dtype=record)
    records["corners"] = corners
    with path.open("wb") as stream:
        stream.write(b"scan".ljust(80) + np.uint32(corners.shape[0]).tobytes())
        records.tofile(stream)
    return corners.shape[0]


def _timed(work):
    begin, before = time.perf_counter(), time.process_time()
    found = work()
    return found, time.perf_counter() - begin, time.process_time() - before


def _row(name: str, seconds) -> None:
    wall, cpu = seconds
    print(f"{name:<52}{wall:>8.2f}{cpu:>8.2f}")


if __name__ == "__main__":
    main()
