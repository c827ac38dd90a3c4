"""Plain tables: what ends in CSV, spreadsheet and page."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

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


# Name in words, unit shown, and what an SI value is multiplied by for it.
_WORDS: dict[str, tuple[str, str, float]] = {
    "rcof": ("RCOF", "", 1.0),
    "acof": ("ACOF", "", 1.0),
    "acof_minus_rcof": ("ACOF - RCOF", "", 1.0),
    "cof": ("COF", "", 1.0),
    "cof_bl": ("COF_BL", "", 1.0),
    "tau_hydro": ("tau_hydro", "m/s", 1.0),
    "cof_asymptote": ("COF_asymptote", "", 1.0),
    "slip": ("slip", "", 1.0),
    "crossed_array": ("heel crossed the array", "", 1.0),
    "peak_slipping_speed": ("peak slipping speed", "m/s", 1.0),
    "slip_distance": ("slip distance", "mm", 1e3),
    "slip_margin": ("slip margin", "m/s", 1.0),
    "peak_pressure": ("peak pressure", "kPa", 1e-3),
    "scan_peak_pressure": ("peak pressure of the scan", "kPa", 1e-3),
    "friction_force": ("friction force", "N", 1.0),
    "speed": ("speed", "m/s", 1.0),
    "force_2_percent": ("force at 2 %", "N", 1.0),
    "peak_force": ("peak force", "N", 1.0),
    "final_force": ("final force", "N", 1.0),
}


def words(name: str) -> str:
    """Return a quantity's name as people write it."""
    return _WORDS.get(name, (name.replace("_", " "), "", 1.0))[0]


def heading(name: str) -> str:
    """Return a column heading with its unit."""
    text, unit, _ = _WORDS.get(name, (name.replace("_", " "), "", 1.0))
    return f"{text} ({unit})" if unit else text


def scaled(name: str, value: float | None) -> float | None:
    """Return an SI value in the unit of its heading."""
    return None if value is None else value * _WORDS.get(name, ("", "", 1.0))[2]


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
            *(scaled(name, one.main.get(name)) for name in numbers),
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


def edit_table(files: Iterable[FileResult]) -> Table | None:
    """Return the edit log: every event that was set by hand, or None."""
    rows = tuple(
        (one.file, e["what"], e["before"], e["after"], e["why"]) for one in files for e in one.edits
    )
    if not rows:
        return None
    return Table("edits", "Events set by hand", ("file", "what", "before", "after", "why"), rows)


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
        cells: list[Cell] = [*group, len(members)]
        for name in numbers:
            values = np.array([scaled(name, m.main[name]) for m in members if name in m.main])
            cells.append(float(values.mean()) if len(values) else None)
            if name != "slip":
                cells.append(float(values.std(ddof=1)) if len(values) > 1 else None)
        rows.append(tuple(cells))
    columns = [*keys, "files"]
    for name in numbers:
        columns += ["share of slips"] if name == "slip" else [heading(name), f"sd {words(name)}"]
    return Table(
        "groups",
        "Means by " + ", ".join(keys),
        tuple(columns),
        tuple(rows),
        ("Refused files are left out; sd is the standard deviation between files.",),
    )
