"""A history of load, speed and shoe angle: a table beside the case becomes part of the case."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import InputError

from .table_file import opened_sheet, sheet_column

if TYPE_CHECKING:
    from underfoot.outsole.motion_history import MotionHistory

    from .case import Case
    from .places import Places

COLUMNS = {
    "time": ("s", ("time", "t")),
    "normal_force": ("N", ("normal force", "force", "load", "vertical force")),
    "speed": ("m/s", ("speed", "sliding speed", "velocity")),
    "shoe_angle": ("rad", ("shoe angle", "angle", "foot angle")),
}
"""Quantity: SI unit, and the headings by which a column is known."""
SLOWEST = 1e-3
"""m/s, speed at the end below which ``motion.speed`` says this much."""


def with_motion_history(
    mapping: Mapping[str, Any], folder: Path, places: Places
) -> Mapping[str, Any]:
    """Return a case's mapping with the points of ``motion.history`` in it.

    The last point becomes ``motion.normal_force``, ``speed``, ``shoe_angle`` and ``duration``,
    unless the section writes them itself. The file is looked for from ``folder``.
    """
    motion = mapping.get("motion")
    if not isinstance(motion, Mapping):
        return mapping
    name, points = motion.get("history"), motion.get("history_points")
    if name is None and points is None:
        return mapping
    changed = dict(motion)
    if isinstance(name, str):
        where = places("motion.history")
        if points is not None:
            raise InputError(
                "a table and points are given",
                where=where,
                remedy="Keep history or history_points",
            )
        points = read_motion_table(folder / name, where)
        changed["history_points"] = points
    if isinstance(points, list) and points and isinstance(points[-1], Mapping):
        last = points[-1]
        for key, point in (("normal_force", "normal_force"), ("duration", "time")):
            if point in last:
                changed.setdefault(key, last[point])
        changed.setdefault("force_rise_time", changed.get("duration", "30 ms"))
        if "speed" in last:
            changed.setdefault("speed", _positive(last["speed"]))
        if "shoe_angle" in last:
            changed.setdefault("shoe_angle", last["shoe_angle"])
    return {**mapping, "motion": changed}


def read_motion_table(path: Path, where: str) -> list[dict[str, str]]:
    """Return the points of a table (CSV, XLSX) as a case file writes them.

    Columns ``time``, ``normal_force``, ``speed`` and, where the shoe turns, ``shoe_angle``; units
    stand in the heading, as ``time (ms)``, else SI.

    Errors
    ------
    InputError
        No file, no table, a column missing, a value missing.
    """
    sheet = opened_sheet(path, where)
    columns = {
        name: sheet_column(
            sheet,
            name,
            *COLUMNS[name],
            where=where,
            allowed="time, normal_force and speed; also shoe_angle",
            required=name != "shoe_angle",
        )
        for name in COLUMNS
    }
    found = {name: values for name, values in columns.items() if values is not None}
    for name, values in found.items():
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            raise InputError(
                f"row {wrong[0] + 1} of {path.name}: {name} is missing",
                where=where,
                allowed="a number",
            )
    count = found["time"].size
    if count < 2:
        raise InputError(f"{path.name} has {count} rows", where=where, allowed="2 or more")
    return [
        {name: f"{values[row]:.12g} {COLUMNS[name][0]}" for name, values in found.items()}
        for row in range(count)
    ]


def _positive(speed: Any) -> Any:
    """Return the size of a speed as text, at least ``SLOWEST``."""
    if not isinstance(speed, str):
        return speed
    from underfoot.core import to_si

    return f"{max(abs(to_si(speed, 'm/s', where='motion.history_points')), SLOWEST):.12g} m/s"


def motion_history(case: Case) -> MotionHistory | None:
    """Return the history that the case follows; None when load and speed are held."""
    from underfoot.outsole.motion_history import MotionHistory

    points = case.motion.history_points
    if points is None:
        return None
    angle = case.motion.shoe_angle
    return MotionHistory(
        np.array([one.time for one in points]),
        np.array([one.normal_force for one in points]),
        np.array([one.speed for one in points]),
        np.array([angle if one.shoe_angle is None else one.shoe_angle for one in points]),
    )
