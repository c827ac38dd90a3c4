"""CPU time of making a case: from a file, by replace, and its hash, beside parsing its TOML."""

from __future__ import annotations

import time
import tomllib
from collections.abc import Callable
from pathlib import Path

import tomlkit

from underfoot.case import Case

EXAMPLE = Path(__file__).parents[1] / "examples" / "work_shoe_half_tread_detergent.toml"
REPEATS = 50


def milliseconds(work: Callable[[], object]) -> float:
    """Return the mean CPU time of a call, ms."""
    work()
    began = time.process_time()
    for _ in range(REPEATS):
        work()
    return 1e3 * (time.process_time() - began) / REPEATS


def main() -> None:
    """Print the table."""
    case, text = Case.load(EXAMPLE), EXAMPLE.read_text()
    rows = {
        "Case.load, catalogue warm": lambda: Case.load(EXAMPLE),
        "case.replace, one number": lambda: case.replace("contaminant.viscosity", 0.01),
        "case.replace and its hash": lambda: case.replace("contaminant.viscosity", 0.01).hash,
        "tomllib, the same text": lambda: tomllib.loads(text),
        "tomlkit, the same text": lambda: tomlkit.parse(text),
    }
    for name, work in rows.items():
        print(f"{name:28} {milliseconds(work):7.2f} ms")


if __name__ == "__main__":
    main()
