"""Default answers of soles against finer grids and more positions: are they within their error?

``python -m benchmarks.sole_resolution [PART ...]``: examples of G.4, human slips, outsoles from
files, soles drawn at random; hours for all. The reference has cells of 0.25 mm and eight positions
of the tread; without lugs 16 cells along the sliding on 0.45 mm, at the same three shoe angles.
Prints how many lie within ``COF_WITHIN`` and ``LOAD_WITHIN``, and within their own 95 %.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from underfoot import Case, run
from underfoot.compute.positions import has_lugs
from underfoot.core import UnderfootError, to_si

ROOT = Path(__file__).resolve().parents[1]
FINE = {
    "numerics.grid_spacing": "0.25 mm",
    "numerics.quick_grid_spacing": "0.25 mm",  # all positions on it
    "numerics.tread_positions": 8,
}
FINE_WITHOUT_LUGS = {"numerics.grid_spacing": "0.45 mm", "numerics.cells_along": 16}
COF_WITHIN, LOAD_WITHIN, LOAD_LEAST = 0.02, 0.05, 2.0  # relative, relative, N
FILES = ("heel_blocks", "heel_hexagons", "heel_chevrons")
DRAWN, SEED = 20, 2026


class Numbers(NamedTuple):
    """COF and load on the film (N), and the standard deviation of the numerical error of each."""

    cof: float
    load: float
    cof_error: float
    load_error: float

    @classmethod
    def of(cls, case: Case) -> Numbers:
        """Return the numbers of a run; nan without an answer."""
        result = run(case)
        if not result.usable:
            return cls(*4 * (float("nan"),))
        values = [result["cof"], result["fluid_load"]]
        errors = [
            to_si(v.note.rpartition("numerical error ")[2], v.unit, where="note") for v in values
        ]
        return cls(*(float(v.value or 0.0) for v in values), *errors)


def examples(names: str) -> Iterator[tuple[str, Case]]:
    """Yield the cases of the examples whose names match."""
    for path in sorted((ROOT / "examples").glob(names)):
        yield path.stem, Case.load(path)


def from_files(folder: Path) -> Iterator[tuple[str, Case]]:
    """Yield outsoles of the examples as STL files under the conditions of their own cases."""
    for name in FILES:
        file = folder / f"{name}.stl"
        sole = ROOT / "examples" / "outsoles" / f"{name}.toml"
        command = Path(sys.executable).with_name("underfoot")
        make = [command, "outsole", "make", sole, "--out", file]
        subprocess.run(make, check=True, capture_output=True)
        case = Case.load(sole.with_name(f"{name}_glycerol.toml"))
        text = {"file": str(file)}
        yield (
            f"{name}.stl",
            case.replace(
                {"shoe.heel": None, "shoe.tread": None, "shoe.sole": None, "shoe.outsole": text}
            ),
        )


def drawn() -> Iterator[tuple[str, Case]]:
    """Yield cases drawn at random, with the positions and the angle band of a default run."""
    sys.path.insert(0, str(ROOT / "tests"))
    from random_cases import drawn_case  # pyright: ignore[reportMissingImports]

    rng, number = np.random.default_rng(SEED), 0
    while number < DRAWN:
        try:
            case = drawn_case(rng).replace("numerics.tread_positions", 6)
        except UnderfootError:
            continue
        number += 1
        yield f"drawn {number}", case


def main(parts: Sequence[str] = ()) -> None:
    """Print the table of the chosen parts, of all without any."""
    with tempfile.TemporaryDirectory() as folder:
        cases = {
            "g4": lambda: examples("*_shoe_*_[gd][le]*.toml"),
            "slips": lambda: examples("human_slip_*.toml"),
            "files": lambda: from_files(Path(folder)),
            "drawn": drawn,
        }
        print(f"{'':<34}{'COF':>16}{'finer':>8}{'film N':>16}{'finer':>8}{'CPU s':>12}")
        within, covered, count = np.zeros(2, int), np.zeros(2, int), 0
        for part in parts or cases:
            for name, case in cases[part]():
                began = time.process_time()
                own = Numbers.of(case)
                middle = time.process_time()
                fine = Numbers.of(case.replace(FINE if has_lugs(case) else FINE_WITHOUT_LUGS))
                seconds = f"{middle - began:.0f}, {time.process_time() - middle:.0f}"
                print(
                    f"{name:<34}{own.cof:>8.4f} ±{own.cof_error:6.4f}{fine.cof:>8.4f}"
                    f"{own.load:>8.1f} ±{own.load_error:6.1f}{fine.load:>8.1f}{seconds:>12}",
                    flush=True,
                )
                if np.isnan([*own, *fine]).any():
                    continue
                off = np.abs(np.subtract(own[:2], fine[:2]))
                most = COF_WITHIN * fine.cof, max(LOAD_WITHIN * fine.load, LOAD_LEAST)
                within += off < most
                covered += off < 1.96 * np.array(own[2:])
                count += 1
        print(f"COF within {COF_WITHIN:.0%} in {within[0]} of {count}, ", end="")
        print(f"film within {LOAD_WITHIN:.0%} or {LOAD_LEAST:g} N in {within[1]}")
        print(f"COF within its own 95 % in {covered[0]} of {count}, film in {covered[1]}")


if __name__ == "__main__":
    main(sys.argv[1:])
