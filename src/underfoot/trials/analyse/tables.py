"""Plain tables: what ends in CSV, spreadsheet and page."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core import display

from .file_result import FileResult

Cell = str | float | int | None


@dataclass(frozen=True, slots=True)
class Table:
    """Rows under headings; ``notes`` stand below. ``name`` is a file name without ending."""

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()


UNITS = {
    "rcof": "1",
    "acof": "1",
    "acof_minus_rcof": "1",
    "cof": "1",
    "slip": "1",
    "crossed_array": "1",
    "peak_slipping_speed": "m/s",
    "slip_distance": "m",
    "slip_margin": "m/s",
    "peak_pressure": "Pa",
    "scan_peak_pressure": "Pa",
    "friction_force": "N",
    "speed": "m/s",
    "force_2_percent": "N",
    "peak_force": "N",
    "final_force": "N",
}


def heading(name: str) -> str:
    """Return a column heading with its unit."""
    unit = UNITS.get(name, "1")
    words = name.replace("_", " ")
    return words if unit == "1" else f"{words} ({unit})"


def file_table(files: Iterable[FileResult]) -> Table:
    """Return one row per file: verdict, main numbers, conditions, reasons."""
    files = list(files)
    numbers = list(dict.fromkeys(name for one in files for name in one.main))
    noted = list(dict.fromkeys(name for one in files for name in one.conditions))
    # A number that the analysis took over from the conditions is shown once.
    noted = [name for name in noted if name not in numbers]
    rows = [
        (
            one.file,
            one.verdict,
            *(one.main.get(name) for name in numbers),
            *(one.conditions.get(name) for name in noted),
            "; ".join(one.reasons),
        )
        for one in files
    ]
    columns = ("file", "verdict", *map(heading, numbers), *noted, "reasons")
    return Table("files", "Every file with its verdict", columns, tuple(rows))


def measurement_table(files: Iterable[FileResult]) -> Table:
    """Return one row per number with uncertainty, reason, flags and conventions."""
    rows = []
    for one in files:
        for m in one.measurements:
            conventions = "; ".join(f"{key}: {value}" for key, value in m["conventions"].items())
            rows.append(
                (
                    one.file,
                    m["item"],
                    m["name"],
                    m["value"],
                    m["unit"],
                    m["uncertainty"],
                    m["reason"],
                    m["n"],
                    "; ".join(m["flags"]),
                    conventions,
                )
            )
    columns = (
        "file",
        "item",
        "quantity",
        "value",
        "unit",
        "standard uncertainty",
        "not estimated because",
        "n",
        "flags",
        "conventions",
    )
    return Table("measurements", "Every number with its conventions", columns, tuple(rows))


def group_table(
    files: Iterable[FileResult], keys: tuple[str, ...], numbers: tuple[str, ...]
) -> Table | None:
    """Return mean, standard deviation and n of the main numbers by group of conditions."""
    groups: dict[tuple[str, ...], list[FileResult]] = {}
    for one in files:
        if one.usable and all(key in one.conditions for key in keys):
            groups.setdefault(tuple(str(one.conditions[k]) for k in keys), []).append(one)
    if not groups or not keys:
        return None
    rows = []
    for group, members in groups.items():
        cells: list[Cell] = [*group]
        for name in numbers:
            values = np.array([m.main[name] for m in members if name in m.main])
            cells += [
                len(values),
                float(values.mean()) if len(values) else None,
                float(values.std(ddof=1)) if len(values) > 1 else None,
            ]
        rows.append(tuple(cells))
    columns = [*keys]
    for name in numbers:
        columns += [f"n {name}".replace("_", " "), f"mean {heading(name)}", f"sd {heading(name)}"]
    return Table(
        "groups",
        "Means by " + ", ".join(keys),
        tuple(columns),
        tuple(rows),
        ("Refused files are left out; sd is the standard deviation between files.",),
    )


def shown(value: Any) -> str:
    """Return a cell as text for a page."""
    if value is None:
        return "–"
    if isinstance(value, float):
        return display(value, "1", 4)
    return str(value)
