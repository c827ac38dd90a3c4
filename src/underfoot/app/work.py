"""What the computing processes are asked: each function takes and returns plain data.

The server names these functions and never imports this module, which brings all of the package.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from underfoot.case import Case
from underfoot.compute.result import Result
from underfoot.compute.run import run as result_of
from underfoot.core import Progress
from underfoot.core.fields import Fields
from underfoot.core.presentation import Presentable
from underfoot.report import write_report
from underfoot.report.results import sole_fields
from underfoot.report.viewer import scene_section, viewer_scene

FINEST_DRAWN = 20_000
"""Cells of a sole that is drawn while sliders move."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """Fields on a sole under a name."""

    name: str
    data: Fields


def case_of(path: str, changes: Mapping[str, Any] | None = None) -> Case:
    """Return the case of a file with changes."""
    case = Case.load(path)
    return case.replace(changes) if changes else case


def sole(path: str, changes: Mapping[str, Any], *, progress: Progress) -> dict[str, Any]:
    """Return the sole of a case as drawn (``scene``) and as a part of a page (``html``)."""
    case = case_of(path, changes)
    fields = sole_fields(case, case.numerics.grid_spacing)
    if fields["inside"].size > FINEST_DRAWN:
        fields = sole_fields(case)
    return _shown(Drawn(case.name, fields))


def computed(path: str, folder: str, quick: bool = False, *, progress: Progress) -> list[str]:
    """Compute a case as ``underfoot run --out`` does; return its headline."""
    result = result_of(Case.load(path), quick=quick, progress=progress)
    write_report(result, Path(folder), overwrite=True)
    return list(result.headline())


def answer(folder: str, *, progress: Progress) -> dict[str, Any]:
    """Return a stored result in words, tables and as a part of a page."""
    result = Result.load(folder)
    return {**said(result), **_shown(result)}


def said(shown: Presentable) -> dict[str, Any]:
    """Return what an object says of itself as plain data."""
    tables = [
        {"title": table.title, "columns": list(table.columns), "rows": table.cells()}
        for table in shown.tables()
        if table.rows
    ]
    return {
        "heading": shown.heading(),
        "usable": shown.usable,
        "headline": list(shown.headline()),
        "cautions": list(shown.cautions()),
        "tables": tables,
        "remarks": {title: list(lines) for title, lines in shown.remarks().items() if lines},
    }


def _shown(drawn: Drawn | Result) -> dict[str, Any]:
    scene = viewer_scene([drawn])
    return {"scene": scene, "html": scene_section(scene)}
