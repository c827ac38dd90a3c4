"""A user's own friction readings: a table file beside the case becomes part of the case."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import InputError

from .table_file import opened_sheet, sheet_column

if TYPE_CHECKING:
    from underfoot.friction import SpeedTableLaw

    from .case import Case
    from .places import Places

COLUMNS = {
    "speed": ("m/s", ("speed", "sliding speed", "velocity")),
    "cof": ("1", ("cof", "coefficient of friction", "friction coefficient")),
    "sd": ("1", ("sd", "cof sd", "standard deviation", "cof standard deviation")),
    "pressure": ("Pa", ("pressure", "contact pressure")),
    "viscosity": ("Pa*s", ("viscosity",)),
}
"""Quantity: SI unit, and the headings by which a column is known."""
SAME_VISCOSITY = 0.01
"""Relative difference up to which two viscosities are the same fluid."""


def with_friction_table(
    mapping: Mapping[str, Any], folder: Path, places: Places
) -> Mapping[str, Any]:
    """Return a case's mapping with the readings of ``interface.friction_table`` in it.

    The file is looked for from ``folder``, that of the case file.
    """
    interface = mapping.get("interface")
    name = interface.get("friction_table") if isinstance(interface, Mapping) else None
    if not isinstance(name, str):
        return mapping
    assert isinstance(interface, Mapping)
    where = places("interface.friction_table")
    if "friction_readings" in interface:
        raise InputError(
            "a table and readings are given",
            where=where,
            remedy="Keep friction_table or friction_readings",
        )
    readings, source = read_friction_table(folder / name, where)
    changed = {**interface, "friction_readings": readings}
    changed.setdefault("friction_source", source)
    return {**mapping, "interface": changed}


def read_friction_table(path: Path, where: str) -> tuple[list[dict[str, str | float]], str]:
    """Return the readings of a table (CSV, XLSX) as a case file writes them, and their source.

    Columns ``speed`` and ``cof``; optional ``sd``, ``pressure``, ``viscosity``; units stand in the
    heading, as ``speed (m/s)``, else SI. A line ``# source: ...`` above says where they come from.

    Errors
    ------
    InputError
        No file, no table, a column missing, fewer than two speeds, a value missing or negative.
    """
    sheet = opened_sheet(path, where)
    columns = {
        name: sheet_column(
            sheet,
            name,
            *COLUMNS[name],
            where=where,
            allowed="speed and cof; also sd, pressure, viscosity",
            required=name in ("speed", "cof"),
        )
        for name in COLUMNS
    }
    count = len(next(iter(sheet.numbers.values()), ()))
    readings: list[dict[str, str | float]] = []
    for row in range(count):
        entry: dict[str, str | float] = {}
        for name, values in columns.items():
            if values is None:
                continue
            value = float(values[row])
            if not (np.isfinite(value) and value >= 0):
                raise InputError(
                    f"row {row + 1} of {path.name}: {name} is "
                    + ("missing" if np.isnan(value) else f"{value:g}"),
                    where=where,
                    allowed="a number, 0 or more",
                )
            unit = COLUMNS[name][0]
            entry[name] = value if unit == "1" else f"{value:.12g} {unit}"
        readings.append(entry)
    source = next((line for line in map(_said, _first_lines(path)) if line), "")
    return readings, source or path.name


def _first_lines(path: Path) -> list[str]:
    try:
        with path.open(encoding="utf-8-sig") as stream:
            return [line for _, line in zip(range(20), stream, strict=False)]
    except UnicodeDecodeError:
        return []  # a spreadsheet


def _said(line: str) -> str:
    name, _, text = line.lstrip("#; ").partition(":")
    return text.strip() if name.strip().casefold() == "source" else ""


def table_law(case: Case, viscosity: float | None) -> SpeedTableLaw:
    """Return the law of the case's own readings, ``models.friction = "table"``.

    Repeated speeds are averaged; their scatter joins the standard deviation. Readings under
    another viscosity than the case's (or several) count at equal viscosity x speed, as the report
    finds for its fluids (Fig. 16); that is said.
    """
    from underfoot.friction import SpeedTableLaw

    readings = case.interface.friction_readings or ()
    speed = np.array([one.speed for one in readings])
    cof = np.array([one.cof for one in readings])
    given = np.array([np.nan if one.sd is None else one.sd for one in readings])
    pressures = [one.pressure for one in readings if one.pressure is not None]
    notes = []
    thick = np.array([np.nan if one.viscosity is None else one.viscosity for one in readings])
    if viscosity is not None and np.isfinite(thick).all():
        ratio = thick / viscosity
        if (np.abs(ratio - 1) > SAME_VISCOSITY).any():
            speed = speed * ratio
            notes.append("Readings under another viscosity count at equal viscosity x speed.")
    places, group = np.unique(np.round(speed, 12), return_inverse=True)
    counts = np.bincount(group)
    mean = np.bincount(group, cof) / counts
    scatter = np.bincount(group, (cof - mean[group]) ** 2) / np.maximum(counts - 1, 1)
    deviation = None
    if np.isfinite(given).all():
        deviation = np.sqrt(np.bincount(group, given**2) / counts + scatter)
    elif (counts > 1).all():
        deviation = np.sqrt(scatter)
    left = case.interface.hysteresis_cof
    notes += [] if left is not None else ["All of the friction read counts as adhesion."]
    return SpeedTableLaw(
        places,
        mean,
        source=case.interface.friction_source or "readings given in the case",
        cof_hysteresis=left or 0.0,
        viscosity=viscosity,
        cof_deviation=deviation,
        pressure=(min(pressures), max(pressures)) if pressures else None,
        assumed=tuple(notes),
    )
