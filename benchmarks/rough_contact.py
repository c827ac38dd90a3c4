"""Rough contact: our elastic and sliding solves beside tamaas and aspher, one thread each.

    python -m benchmarks.rough_contact --sizes 256 512 --peers peers/bin/python
    python -m benchmarks.rough_contact --device cuda --sizes 1024 2048 --peers peers/bin/python
    python -m benchmarks.rough_contact --libraries --sizes 1024 2048

The second prints wall seconds on tensors of a device beside tamaas on all threads of the machine;
the third steps, products and memory on the arrays of each library that is installed.

Self-affine surfaces (Hurst 0.8, waves from L/4 to 8 spacings, so that finer grids carry more
scales), plane-strain modulus 1, rms slope 1; the sliding rubber has the relaxed modulus 1 and 30
relaxation times over nine decades (E' rises about twelvefold, tan delta about 0.2). Times are
process CPU seconds of the best of a few runs; every pressure field is judged in one norm, computed
here: the larger of the deepest penetration and the pressure-weighted mean |gap|, over rms height.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

os.environ["OMP_NUM_THREADS"] = "1"
os.environ["MKL_NUM_THREADS"] = "1"
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np

from benchmarks._table import Row
from underfoot.core.device import described_card, on_card
from underfoot.core.mkl import mkl_library
from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import SlidingSettings, SteadySliding, steady_sliding

TIMES = np.logspace(-9.0, 0.0, 30)
RUBBER = RelaxationSpectrum(1.0, 0.025 * TIMES**-0.25, TIMES)
SPEEDS = (0.01, 0.1, 1.0)
PEERS = ("tamaas", "ContactMechanics", "aspher")
LENGTH = 1e-3
"""m, side of the patch in the sliding runs; only speed over length matters."""


def self_affine(n: int, seed: int = 1, shortest: float | None = None) -> np.ndarray:
    """Return heights over a unit square with rms slope 1, down to n/8 waves or ``shortest``."""
    q = np.hypot(np.fft.fftfreq(n, 1 / n)[:, None], np.fft.rfftfreq(n, 1 / n)[None, :])
    band = (q >= 4) & (q <= (shortest or n / 8))
    amplitude = np.where(band, np.where(band, q, 1.0) ** -1.8, 0.0)
    spectrum = np.fft.rfft2(np.random.default_rng(seed).standard_normal((n, n))) * amplitude
    weights = np.full(q.shape, 2.0)
    weights[:, 0] = weights[:, -1] = 1.0
    slope = np.sqrt(np.sum(weights * (2 * np.pi * q * np.abs(spectrum)) ** 2)) / n**2
    return np.fft.irfft2(spectrum, s=(n, n)) / slope


def elastic_error(pressure: np.ndarray, height: np.ndarray) -> float:
    """Return the complementarity error of an elastic pressure field (E* = 1, unit square)."""
    n = height.shape[0]
    q = 2 * np.pi * np.hypot(np.fft.fftfreq(n, 1 / n)[:, None], np.fft.rfftfreq(n, 1 / n))
    q[0, 0] = np.inf
    p = np.maximum(pressure, 0.0)
    gap = np.fft.irfft2(2.0 / q * np.fft.rfft2(p), s=height.shape) - height
    gap -= gap[p > 0.0].mean()
    return max(-gap.min(), np.sum(np.abs(gap) * p) / p.sum()) / height.std()


def ours(height: Any, pressure: float, speed: float, fft: str, **settings: Any) -> SteadySliding:
    modulus = 1.0 if speed == 0.0 else RUBBER
    return steady_sliding(
        height,
        1.0 / height.shape[0],
        modulus,
        speed / LENGTH,
        pressure,
        0.0,
        settings=SlidingSettings(fft=fft, **settings),
    )


def timed(height: np.ndarray, pressure: float, speed: float, fft: str, repeats: int):
    best = float("inf")
    for _ in range(repeats):
        start = time.process_time()
        result = ours(height, pressure, speed, fft)
        best = min(best, time.process_time() - start)
    return best, result


def timed_on(device: str, n: int, pressure: float, speed: float, tamaas: float | None) -> str:
    """Return a line of the table of a device: seconds and its limit, products by transforms.

    ``tamaas`` are the seconds of its elastic contact there.
    """
    torch = import_module("torch")
    wait = torch.cuda.synchronize if device == "cuda" else lambda: None
    height = torch.asarray(self_affine(n), device=device)
    field = torch.zeros((n, n), dtype=torch.float32, device=device)

    def best_of(job: Callable[[], Any]) -> tuple[float, Any]:
        best, result = math.inf, None
        for _ in range(2):
            wait()
            start = time.perf_counter()
            result = job()
            wait()
            best = min(best, time.perf_counter() - start)
        return best, result

    solve, result = best_of(lambda: ours(height, pressure, speed, "auto"))
    both, _ = best_of(lambda: torch.fft.irfft2(torch.fft.rfft2(field), s=(n, n)))
    products = result.operator_applications
    return (
        f"{n:6d} {pressure:5.2f} {speed:5.2f} {solve:8.3f} {products * both:8.3f} {products:8.0f} "
        f"{result.iterations:5d}" + ("" if speed else f" {cell(tamaas)} {ratio(tamaas, solve)}")
    )


def device_table(options: argparse.Namespace) -> None:
    """Print wall seconds on a device, its limit, and tamaas on all threads of this machine."""
    name = described_card() if on_card(options.device, 0) else "the processor"
    threads = os.cpu_count()
    print(f"wall seconds on {name}; limit: products times the transform's time; tamaas: the")
    print(f"elastic contact alone, on the {threads} threads of this machine, and its ratio to ours")
    print("  size     p speed    solve    limit products steps   tamaas      x")
    with tempfile.TemporaryDirectory() as folder:
        height = str(Path(folder) / "height.npy")
        task = {"height": height, "out": str(Path(folder) / "pressure.npy"), "repeats": 2}
        for n in options.sizes:
            np.save(height, self_affine(n))
            python = options.peers if n <= options.tamaas_up_to else None
            for p in options.pressures:
                task |= {"pressure": p, "tolerance": 1e-6, "threads": threads}
                tamaas, _ = peer(python, "tamaas", task)
                for speed in (0.0, *SPEEDS):
                    print(timed_on(options.device, n, p, speed, tamaas), flush=True)


LIBRARIES = {"numpy mkl": "mkl", "numpy": "scipy", "array_api_strict": "auto", "torch": "auto"}
"""Fourier library of the arrays of each library; "numpy mkl" is NumPy with Intel's."""
CASES = ((0.02, 0.1), (0.1, 1.0), (0.3, 0.0), (0.1, 0.01))
"""(Pressure, speed) of the comparison of libraries."""
SPREAD = 0.1
"""Largest difference of products between libraries, over the most."""


def of_library(height: np.ndarray, name: str) -> Any:
    return height if name.startswith("numpy") else import_module(name).asarray(height)


def library_table(sizes: Sequence[int]) -> None:
    """Print steps and products of each library, and the memory of the last size.

    Exits with a message where products differ by more than SPREAD.
    """
    installed = [name for name in LIBRARIES if " " not in name and find_spec(name) is not None]
    if mkl_library() is not None:
        installed.insert(0, "numpy mkl")
    print("steps, products: " + ", ".join(installed) + "; then the spread of products")
    worst = 0.0
    for n in sizes:
        height = self_affine(n)
        for p, v in CASES:
            made = [ours(of_library(height, name), p, v, LIBRARIES[name]) for name in installed]
            products = [result.operator_applications for result in made]
            spread = 1.0 - min(products) / max(products)
            worst = max(worst, spread)
            cells = " ".join(f"{r.iterations:3d} {r.operator_applications:6.1f}" for r in made)
            print(f"{n:5d} {p:5.2f} {v:5.2f}  {cells}  {100 * spread:4.1f} %", flush=True)
    n = sizes[-1]
    for p, v in CASES:
        arrays = [memory_in_arrays(n, p, v, LIBRARIES[name], name) for name in installed]
        print(
            f"{n:5d} {p:5.2f} {v:5.2f}  arrays {' '.join(f'{a:6.1f}' for a in arrays)}", flush=True
        )
    if worst > SPREAD:
        sys.exit(f"products differ by {100 * worst:.0f} %")


def peer(python: str | None, name: str, task: dict) -> tuple[float | None, np.ndarray | None]:
    if python is None:
        return None, None
    script = str(Path(__file__).with_name("_rough_contact_peers.py"))
    task = {**task, "peer": name}
    answer = subprocess.run(
        [python, script, json.dumps(task)], capture_output=True, text=True, check=False
    )
    if answer.returncode:
        print(answer.stderr[-500:], file=sys.stderr)
        return None, None
    reply = json.loads(answer.stdout.strip().splitlines()[-1])
    if "missing" in reply:
        return None, None
    return reply["seconds"], np.load(task["out"])


def memory_in_arrays(
    n: int, pressure: float, speed: float, fft: str, library: str = "numpy"
) -> float:
    """Return the peak memory of one solve beyond its start, in double arrays of the grid."""
    code = (
        "import resource, sys; sys.path.insert(0, sys.argv[1]); import rough_contact as r\n"
        "h = r.of_library(r.self_affine(64), sys.argv[7]); r.ours(h, 0.1, 1.0, sys.argv[5])\n"
        "n = int(sys.argv[2]); h = r.of_library(r.np.load(sys.argv[6]), sys.argv[7])\n"
        "base = r.resident()\n"
        "r.ours(h, float(sys.argv[3]), float(sys.argv[4]), sys.argv[5])\n"
        "print((r.peak() - base) / (8 * n * n))"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "height.npy"
        np.save(path, self_affine(n))
        here = str(Path(__file__).parent)
        arguments = [here, str(n), str(pressure), str(speed), fft, str(path), library]
        answer = subprocess.run(
            [sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True
        )
    return float(answer.stdout)


def resident() -> float:
    """Return the resident memory of this process now, bytes (Linux)."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return float(pages * resource.getpagesize())


def peak() -> float:
    """Return the largest resident memory of this process so far, bytes (Linux)."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM"):
            return float(line.split()[1]) * 1024.0
    raise RuntimeError("no VmHWM in /proc/self/status")


def cell(seconds: float | None) -> str:
    return f"{'missing':>8}" if seconds is None else f"{seconds:8.3f}"


def ratio(reference: float | None, seconds: float) -> str:
    return "     -" if reference is None else f"{reference / seconds:6.1f}"


def row(n: int, pressure: float, options: argparse.Namespace, folder: Path) -> dict:
    height = self_affine(n)
    path, out = folder / f"{n}.npy", folder / "pressure.npy"
    np.save(path, height)
    repeats = 5 if n <= 512 else 2 if n <= 1024 else 1
    elastic, result = timed(height, pressure, 0.0, options.fft, repeats)
    sliding = [timed(height, pressure, v, options.fft, repeats) for v in SPEEDS]
    task = {
        "height": str(path),
        "out": str(out),
        "pressure": pressure,
        "tolerance": 1e-6,
        "repeats": repeats if n <= 512 else 1,
    }
    largest = options.tamaas_up_to
    tamaas, tamaas_field = peer(options.peers if n <= largest else None, "tamaas", task)
    aspher, aspher_field = peer(options.peers, "aspher", task)
    fields = [result.pressure, tamaas_field, aspher_field]
    areas = [None if f is None else float((f > 0).mean()) for f in fields]
    errors = [None if f is None else elastic_error(f, height) for f in fields]
    worst = max(seconds for seconds, _ in sliding)
    print(
        f"{n:5d} {pressure:5.2f} {cell(elastic)} "
        + " ".join(cell(seconds) for seconds, _ in sliding)
        + f" {cell(tamaas)} {cell(aspher)} {ratio(tamaas, worst)} {ratio(aspher, elastic)}  "
        + " ".join("   -    " if e is None else f"{e:8.1e}" for e in errors)
        + f" {max(r.complementarity_error for _, r in sliding):8.1e}  "
        + " ".join("   -   " if a is None else f"{a:7.5f}" for a in areas)
        + " "
        + " ".join(f"{r.operator_applications:5.0f}" for r in [result, *(r for _, r in sliding)]),
        flush=True,
    )
    return {
        "size": n,
        "pressure": pressure,
        "elastic": elastic,
        "sliding": [seconds for seconds, _ in sliding],
        "tamaas": tamaas,
        "aspher": aspher,
        "areas": areas,
        "errors": errors,
        "sliding_errors": [r.complementarity_error for _, r in sliding],
        "applications": [result.operator_applications]
        + [r.operator_applications for _, r in sliding],
    }


def rows() -> list[Row]:
    """Return the jobs of rough contact, beside those peers that UNDERFOOT_PEERS (a python) has."""
    n, pressure, python = 512, 0.1, os.environ.get("UNDERFOOT_PEERS")
    height = self_affine(n)
    ours(self_affine(64), pressure, 1.0, "auto")
    elastic, result = timed(height, pressure, 0.0, "auto", 3)
    sliding, _ = timed(height, pressure, SPEEDS[1], "auto", 3)
    found = [Row(f"elastic rough contact, {n} x {n}", elastic)]
    area = float((result.pressure > 0).mean())
    with tempfile.TemporaryDirectory() as folder:
        path, out = Path(folder) / "height.npy", Path(folder) / "pressure.npy"
        np.save(path, height)
        task = {"height": str(path), "out": str(out), "pressure": pressure}
        for name in PEERS:
            seconds, field = peer(python, name, {**task, "tolerance": 1e-6, "repeats": 3})
            if seconds is not None and field is not None:
                off = 100 * (float((field > 0).mean()) / area - 1)
                job = f"the same by {name}"
                found.append(Row(job, seconds, error=off, reference="our contact area"))
    return [*found, Row(f"sliding rough contact, {n} x {n}", sliding)]


def growth(rows: list[dict]) -> str:
    """Return the exponents of the FFT products over the number of nodes."""
    nodes = np.log([float(r["size"]) ** 2 for r in rows])
    counts = np.log([r["applications"] for r in rows])
    return " ".join(f"{np.polyfit(nodes, column, 1)[0]:5.2f}" for column in counts.T)


def main(arguments: Sequence[str] = ()) -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[256, 512])
    parser.add_argument("--pressures", type=float, nargs="+", default=[0.02, 0.1, 0.3, 1.0])
    parser.add_argument("--peers", help="python of an environment with tamaas and aspher")
    parser.add_argument("--tamaas-up-to", type=int, default=1024, help="largest size for tamaas")
    parser.add_argument("--fft", choices=["auto", "mkl", "scipy"], default="auto")
    parser.add_argument("--device", choices=["cpu", "cuda"], help="tensors there, wall seconds")
    parser.add_argument("--libraries", action="store_true", help="the same on arrays of each")
    parser.add_argument("--out", type=Path, help="JSON file for the numbers")
    options = parser.parse_args(arguments)
    if options.libraries:
        return library_table(options.sizes)
    if options.device:
        return device_table(options)
    print(
        "CPU seconds, one thread; p in E* h'; sliding at 0.01, 0.1 and 1 m/s; x: tamaas over our "
        "slowest sliding, aspher over our elastic"
    )
    print(
        " size     p  elastic    0.01      0.1      1.0   tamaas   aspher x tamaas x asph "
        "  err ours  tamaas   aspher  sliding  areas (ours, tamaas, aspher)  FFT products"
    )
    ours(self_affine(64), 0.1, 1.0, options.fft)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for n in options.sizes:
            for pressure in options.pressures:
                rows.append(row(n, pressure, options, Path(folder)))
    n = max(512, min(options.sizes[-1], 1024))
    memory = {
        str((p, v)): memory_in_arrays(n, p, v, options.fft)
        for p, v in ((0.02, 0.1), (1.0, 0.0), (1.0, 1.0))
    }
    for case, arrays in memory.items():
        print(f"peak memory at {n}^2, (p, speed) {case}: {arrays:.1f} arrays of the grid")
    if len(options.sizes) > 1:
        print("FFT products grow as nodes^x (side^2x), x for elastic, " + "0.01, 0.1, 1 m/s")
        for p in options.pressures:
            picked = [r for r in rows if r["pressure"] == p]
            print(f"  more roughness with each grid, p {p}: {growth(picked)}")
        for p in options.pressures:
            picked = [
                {
                    "size": n,
                    "applications": [
                        ours(
                            self_affine(n, shortest=options.sizes[0] / 8), p, v, options.fft
                        ).operator_applications
                        for v in (0.0, *SPEEDS)
                    ],
                }
                for n in options.sizes
                if n <= 1024
            ]
            print(f"  the same surface on each grid, p {p}: {growth(picked)}")
    if options.out:
        options.out.write_text(json.dumps({"rows": rows, "memory": memory}, indent=1))


if __name__ == "__main__":
    main(sys.argv[1:])
