"""``underfoot stribeck``: friction of a case's pair against speed, for one or more fluids."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from underfoot.core.remark import Message

from .options import AsJson, CasePath, CatalogueFolders, Overwrite, Settings, load_case
from .output import print_json

if TYPE_CHECKING:
    from underfoot.calibrate.stribeck_curve import StribeckCurve


def stribeck(
    case: CasePath,
    fluid: Annotated[
        list[str] | None,
        typer.Option(
            "--fluid",
            help="Fluid of the catalogue in place of the case's; may be given several times. "
            '"measured" takes all that were measured.',
        ),
    ] = None,
    law: Annotated[
        str | None,
        typer.Option("--law", help="Friction law in place of the case's."),
    ] = None,
    pressure: Annotated[
        str, typer.Option("--pressure", help="Contact pressure under the sole.")
    ] = "266.1 kPa",
    slowest: Annotated[str, typer.Option("--slowest", help="Lowest speed.")] = "0.01 m/s",
    fastest: Annotated[str, typer.Option("--fastest", help="Highest speed.")] = "1 m/s",
    out: Annotated[Path | None, typer.Option("--out", help="Folder for figure and table.")] = None,
    settings: Settings = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Show COF against speed and against viscosity x speed, in its parts.

    The friction of sole on floor at one contact pressure, as on a pin; the film that a whole shoe
    builds up is not in it (underfoot run). With --out: stribeck.png and stribeck.csv.
    """
    from underfoot.calibrate.stribeck_curve import stribeck_curve
    from underfoot.core import InputError, to_si
    from underfoot.core.files import check_writable_folder, whole_folder

    low, high = to_si(slowest, "m/s", where="--slowest"), to_si(fastest, "m/s", where="--fastest")
    if not 0 < low < high:
        raise InputError(
            Message("{low} to {high}", low=slowest, high=fastest),
            where="--slowest",
            allowed="above 0, rising",
        )
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    given = load_case(case, catalogue, settings)
    if law is not None:
        given = given.replace("friction.model", law)
    load = to_si(pressure, "Pa", where="--pressure")
    curves = [
        stribeck_curve(one, label, pressure=load, slowest=low, fastest=high)
        for one, label in _cases(given, fluid or [])
    ]
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            _write(curves, staging, f"{given.name}: {curves[0].law}, {pressure}")
    if json:
        content = {"pressure_Pa": load, "curves": [curve.to_dict() for curve in curves]}
        print_json(content)
        return
    _show(curves, pressure, out)


def _write(curves: list[StribeckCurve], folder: Path, title: str) -> None:
    import pandas

    from underfoot.report.study_figures import stribeck_figure

    stribeck_figure(curves, title).savefig(folder / "stribeck.png", dpi=150)
    rows = pandas.DataFrame([row for curve in curves for row in curve.rows()])
    path = folder / "stribeck.csv"
    rows.to_csv(path, index=False, encoding="utf-8-sig", lineterminator="\r\n")


def _cases(given: Any, fluids: list[str]) -> list[tuple[Any, str]]:
    from underfoot.case.friction import measured_fluids

    if not fluids:
        return [(given, given.entries.get("contaminant", "the case's fluid"))]
    known = sorted(measured_fluids(given.catalogue), key=lambda one: one.viscosity)
    measured = [one.fluid for one in known]
    names = (each for name in fluids for each in (measured if name == "measured" else [name]))
    return [(given.replace("contaminant", name), name) for name in dict.fromkeys(names)]


COLUMNS = (
    ("speed\nm/s", "speed_m_per_s", 1.0, ".3g"),
    ("viscosity\nx speed\nmPa m", "viscosity_times_speed_Pa_m", 1e3, ".3g"),
    ("COF", "cof", 1.0, ".3f"),
    ("95 %", "cof_low_95", 1.0, ".2f"),
    ("adhe-\nsion", "adhesion", 1.0, ".3f"),
    ("hyste-\nresis", "hysteresis", 1.0, ".3f"),
    ("vis-\ncous", "viscous", 1.0, ".3f"),
    ("lambda", "lambda_ratio", 1.0, ".2g"),
    ("load on\nfluid", "fluid_load_share", 1.0, ".0%"),
)
"""Heading, key of a curve's row, factor and format."""


def _show(curves: list[StribeckCurve], pressure: str, out: Path | None) -> None:
    import numpy as np
    from rich.console import Console
    from rich.table import Table

    from underfoot.calibrate.stribeck_points import SPEEDS
    from underfoot.core import display

    console = Console(highlight=False)
    console.print(f"COF at {pressure}, {curves[0].law} law", style="bold", markup=False)
    for curve in curves:
        console.print(f"\n{curve.label}, {display(curve.viscosity, 'Pa*s')}", markup=False)
        table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))
        for heading, *_ in COLUMNS:
            table.add_column(heading, justify="right", no_wrap=True)
        if curve.points is not None:
            table.add_column("pub-\nlished", justify="right")
        chosen = np.flatnonzero(np.isin(curve.speed, SPEEDS))
        if chosen.size < 5:
            chosen = np.unique(np.linspace(0, curve.speed.size - 1, 9).round().astype(int))
        chosen = np.union1d(chosen, [0, curve.speed.size - 1])
        for row in (curve.rows()[i] for i in chosen):
            cells = []
            for _, key, scale, style in COLUMNS:
                value = row.get(key)
                cells.append("-" if value is None else format(scale * value, style))
                if key == "cof_low_95" and value is not None:
                    cells[-1] += f"-{row['cof_high_95']:.2f}"
            published = row["published_cof"]
            table.add_row(*cells, "" if published is None else f"{published:.3f}")
        console.print(table)
        if curve.regimes is not None:
            for text in (*curve.regimes.sentences(), curve.regimes.why):
                if text:
                    console.print(f"  {text}", markup=False)
        for text in curve.notes:
            console.print(f"  {text}", markup=False, style="dim")
    if out is not None:
        console.print(f"\nFigure and table in {out}", markup=False)
