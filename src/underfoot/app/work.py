"""What the computing processes are asked: each function takes and returns plain data.

The server names these functions and never imports this module, which brings all of the package.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import mkdtemp
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np

from underfoot.case import Case
from underfoot.compute.numbers import slip_probability
from underfoot.compute.result import Result
from underfoot.compute.run import run as result_of
from underfoot.compute.sole import bottom_surface, file_outsole, sole_shape
from underfoot.compute.summary import friction_limit
from underfoot.core import Progress, SourcedValue
from underfoot.core.fields import Fields
from underfoot.core.presentation import Presentable, quantity_text
from underfoot.questions.comparison import Comparison, compare
from underfoot.questions.order import OrderVerdict
from underfoot.questions.risk import risk_assessment
from underfoot.questions.sensitivity import sensitivity
from underfoot.questions.walked import worn_pair
from underfoot.questions.wear import wear_mode, wear_series
from underfoot.report import write_report
from underfoot.report.results import (
    DESIGNED,
    designed_surface,
    map_fields,
    sole_fields,
    surface_of_result,
)
from underfoot.report.surface_mesh import SurfaceMesh
from underfoot.report.viewer import scene_section, viewer_scene
from underfoot.report.writing import write_text
from underfoot.shoe import heel_surface
from underfoot.shoe.ball_joint import BallJoint
from underfoot.shoe.tread_measures import tread_measures
from underfoot.sole_contact.stepping import rolled_clearance, rolled_sole

from .run_preview import preview_of_run
from .text import put_language

SHAPED = 30_000
"""Cells from which the surface of a sole is made while sliders move."""
UNREAD = {"sensor.scans": 1}
"""Spares a preview the reading of floor sensors, which it does not show: 50 ms."""
LAND_SPACING = 0.25e-3
"""Of the cells that land is counted on, m."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """Fields on a sole under a name."""

    name: str
    data: Fields


def case_of(path: str, changes: Mapping[str, Any] | None = None) -> Case:
    """Return the case of a file with changes."""
    case = Case.load(path)
    return case.replace(changes) if changes else case


def zipped(folder: str, *, progress: Progress) -> str:
    """Write a project as a ZIP into a folder of its own; return the file. Trial runs stay out."""
    project = Path(folder)
    file = Path(mkdtemp(prefix="underfoot-")) / f"{project.name}.zip"
    parts = [part for part in sorted(project.rglob("*")) if part.is_file()]
    with ZipFile(file, "w", ZIP_DEFLATED) as archive:
        for number, part in enumerate(parts, 1):
            place = part.relative_to(project)
            if not any(name.startswith(".") for name in place.parts) and not part.is_symlink():
                archive.write(part, Path(project.name) / place)
            progress("packing", number / len(parts))
    return str(file)


def compound(path: str, *, progress: Progress) -> str:
    """Write the compound of a rubber's test beside it; return the name of its file."""
    from underfoot.calibrate.compound import compound_from_files

    test = Path(path)
    write_text(compound_from_files([test]).toml())(test.with_suffix(".toml"))
    return test.with_suffix(".toml").name


def sole(path: str, changes: Mapping[str, Any], *, progress: Progress) -> dict[str, Any]:
    """Return the sole of a case as a part of a page (``html``), and its measures."""
    case = case_of(path, changes)
    fields = sole_fields(case)
    new_file = case.shoe.outsole is not None and case.shoe.wear.depth == 0
    walls = file_outsole(case).edges if new_file else None
    measures = tread_measures(bottom_surface(case), walls)
    land = measures.land_ratio
    if case.shoe.outsole is None:  # the coarse grid is off by points, and another than a command's
        land = heel_surface(sole_shape(case), spacing=LAND_SPACING).land_ratio
    words = {
        "length": f"{1e3 * measures.length:.0f}",
        "width": f"{1e3 * measures.width:.0f}",
        "land": f"{100 * land:.0f}",
        "lugs": f"{measures.lug_count}",
    }
    surface = designed_surface(case, _moving_spacing(fields) if changes else DESIGNED)
    return {"html": sole_html(Drawn(case.name, fields), surface), "measures": words}


def effects(path: str, folder: str, *, progress: Progress) -> None:
    """Write what each open input of a case does to its results, as ``underfoot sensitivity``."""
    case = Case.load(path)
    shown = sensitivity(case, progress=progress)
    further = {"case-hash.txt": write_text(case.hash)}
    put_language(write_report(shown, folder, overwrite=True, further=further).page)


def computed(
    path: str,
    folder: str,
    changes: Mapping[str, Any] | None = None,
    quick: bool = False,
    *,
    progress: Progress,
) -> float | None:
    """Compute a case as ``underfoot run --out`` does; return its COF."""
    result = result_of(case_of(path, changes), quick=quick, progress=progress)
    put_language(write_report(result, folder, overwrite=True).page)
    return result.scalars["cof"].value if result.usable else None


def worn(path: str, folder: str, pair: str, *, progress: Progress) -> None:
    """Write how a case wears, as ``underfoot wear --no-band`` does; ``shown.json`` is for the page.

    ``pair`` is a worn one of the same make, as "1.2 mm after 5 months".
    """
    case, worn_shoe = Case.load(path), worn_pair(pair)
    mode = wear_mode(None, case)
    series = wear_series(case, mode=mode, band=False, pair=worn_shoe, progress=progress)
    further = {"shown.json": write_text(json.dumps({**presented(series), "hash": case.hash}))}
    put_language(write_report(series, folder, overwrite=True, further=further).page)


def separated(folders: Sequence[str], *, progress: Progress) -> dict[str, Any]:
    """Return the order of stored results in words and what would tell it where it is open.

    That is computed under other fluids, angles and worn, as ``underfoot compare`` does.
    """
    return compared(folders, separate=True, progress=progress)[1]


def compared(
    folders: Sequence[str], *, separate: bool, progress: Progress
) -> tuple[Comparison, dict[str, Any]]:
    """Return the comparison of stored results, and its words and tables beside that of numbers."""
    # a result has the name of its folder: a variant that was renamed keeps what was computed
    results = [replace(Result.load(folder), name=Path(folder).name) for folder in folders]
    comparison = compare(*results, separate=separate, progress=progress)
    words = presented(comparison)
    return comparison, {
        "headline": words["headline"],
        "cautions": words["cautions"],
        # numbers stand in a table of rows
        "tables": words["tables"][1 + bool(comparison.ranking) :],
        "open": comparison.order is not None and comparison.order.verdict is OrderVerdict.OPEN,
    }


def advised(path: str, folder: str, *, progress: Progress) -> None:
    """Add what would help to a stored result of a case, as ``underfoot run`` does after it."""
    result, case = Result.load(folder), Case.load(path)
    if result.usable and result.provenance.case_hash == case.hash:
        advice = risk_assessment(case, result=result, progress=progress)
        put_language(write_report(result, folder, overwrite=True, advice=advice).page)


def answer(folder: str, *, progress: Progress) -> dict[str, Any]:
    """Return a stored result in words, tables and as a part of a page."""
    result = Result.load(folder)
    cof, slip = result.scalars["cof"], result.scalars.get("slip_probability")
    numbers = {
        "verdict": result.verdict()[0],
        "cof": cof.value,
        "interval": cof.interval,
        "slip": None if slip is None else slip.value,
        "slip_interval": None if slip is None else slip.interval,
        "extrapolated": slip is not None and bool(slip.note),
        "limit": str(friction_limit(result.scalars)) if result.usable else "",
    }
    advised: list[int] = []
    if "lug_way" in result.data:  # thinner parts than high bend over
        advised = np.flatnonzero(
            result.data["lug_way"].values > result.data["lug_height"].values
        ).tolist()
    html = sole_html(result, surface_of_result(result))
    return {**presented(result), **numbers, "advised": advised, "html": html}


def previewed(
    path: str, folder: str, changes: Mapping[str, Any], *, progress: Progress
) -> dict[str, Any]:
    """Return what changes of a case make of its stored result, by continuation: a preview.

    The numbers are those of the stored run, moved by what the continuation says of the change.
    """
    case = Case.load(path).replace(UNREAD)
    changed = case.replace(changes) if changes else case
    stored = json.loads((Path(folder) / "result.json").read_text(encoding="utf-8"))
    whole = {
        name: SourcedValue(stored[name]["value"], numerical=stored[name].get("numerical"))
        for name in ("cof", "fluid_load")
    }
    seen = preview_of_run(case, changes, whole, progress=progress)
    angle = case.motion.shoe_angle
    turn, level = changed.motion.shoe_angle - angle, changed.replace("motion.shoe_angle", angle)
    contact = seen.total_pressure - seen.fluid_pressure
    slip, axes = slip_probability(changed, seen.cof, seen.cof_draws)[0], ("x", "y")
    fields = map_fields(rolled_sole(seen.sole, turn)).assign(
        {
            "contact_pressure": (axes, contact, {"units": "Pa"}),
            "fluid_pressure": (axes, seen.fluid_pressure, {"units": "Pa"}),
            "film_thickness": (axes, seen.film_thickness, {"units": "m"}),
        }
    )
    # as the run beside it where the tread is the same, else as fast as a slider moves
    same = changed.shoe.tread == case.shoe.tread
    surface = designed_surface(level, DESIGNED if same else _moving_spacing(fields))
    surface = rolled_surface(surface, turn, seen.sole.joint)
    return {
        "cof": seen.cof.value,
        "error": seen.errors["cof"],
        "fluid_load": quantity_text(seen.values["fluid_load"], "N", seen.errors["fluid_load"]),
        "slip": slip.value,
        "slip_interval": slip.interval,
        "extrapolated": bool(slip.note),
        "html": sole_html(Drawn(changed.name, fields), surface),
    }


def rolled_surface(surface: SurfaceMesh, turn: float, joint: BallJoint | None) -> SurfaceMesh:
    """Return a surface rolled by ``turn`` (rad, toe up): one made at that angle takes 0.1 s."""
    x, _, height = surface.points.T
    rolled = rolled_clearance(x, height[:, None], turn, joint)
    return replace(surface, points=np.column_stack([surface.points[:, :2], rolled]))


def presented(shown: Presentable) -> dict[str, Any]:
    """Return what an object says of itself as plain data."""
    tables = [
        {
            "title": table.title,
            "columns": list(table.columns),
            "rows": table.cells(),
            "shows": table.shows,
        }
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


def _moving_spacing(fields: Fields) -> float:
    """Return the cells' side (m) from which a surface is made while sliders move."""
    box = np.prod([np.ptp(fields[axis].values) for axis in ("x", "y")])
    return max(DESIGNED, float(np.sqrt(box / SHAPED)))


def sole_html(drawn: Drawn | Result, surface: SurfaceMesh | None) -> str:
    """Return fields on a sole as a part of a page, drawn on a surface."""
    return scene_section(viewer_scene([drawn], [surface]))
