"""``underfoot stribeck``: friction of a case's pair against speed, for one or more fluids."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson, CasePath, CatalogueFolders, Overwrite, Settings

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
            show_default=False,
        ),
    ] = None,
    law: Annotated[
        str | None,
        typer.Option("--law", help="Friction law in place of the case's.", show_default=False),
    ] = None,
    pressure: Annotated[
        str, typer.Option("--pressure", help="Contact pressure under the sole.")
    ] = "266.1 kPa",
    slowest: Annotated[str, typer.Option("--slowest", help="Lowest speed.")] = "0.01 m/s",
    fastest: Annotated[str, typer.Option("--fastest", help="Highest speed.")] = "1 m/s",
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Folder for figure and table.", show_default=False),
    ] = None,
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

    from .options import loaded

    low, high = to_si(slowest, "m/s", where="--slowest"), to_si(fastest, "m/s", where="--fastest")
    if not 0 < low < high:
        raise InputError(f"{slowest} to {fastest}", where="--slowest", allowed="above 0, rising")
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    given = loaded(case, catalogue, settings)
    if law is not None:
        given = given.replace("friction.model", law)
    load = to_si(pressure, "Pa", where="--pressure")
    curves = [
        stribeck_curve(one, label, pressure=load, slowest=low, fastest=high)
        for one, label in _cases(given, fluid or [])
    ]
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_stribeck(curves, staging, f"{given.name}: {curves[0].law}, {pressure}")
    if json:
        import json as json_text

        content = {"pressure_Pa": load, "curves": [curve.as_dict() for curve in curves]}
        print(json_text.dumps(content, indent=2, ensure_ascii=False))
        return
    _show(curves, pressure, out)


def write_stribeck(curves: list[StribeckCurve], folder: Path, title: str) -> None:
    """Write stribeck.png and stribeck.csv into an existing folder."""
    import csv

    from underfoot.report.study_figures import stribeck_figure

    stribeck_figure(curves, title).savefig(folder / "stribeck.png", dpi=150)
    with (folder / "stribeck.csv").open("w", newline="", encoding="utf-8-sig") as stream:
        writer = csv.DictWriter(stream, list(curves[0].rows()[0]))
        writer.writeheader()
        for curve in curves:
            writer.writerows(curve.rows())


def _cases(given: Any, fluids: list[str]) -> list[tuple[Any, str]]:
    from underfoot.case.friction import measured_fluids

    if not fluids:
        return [(given, given.entries.get("contaminant", "the case's fluid"))]
    names: list[str] = []
    for name in fluids:
        if name == "measured":
            found = sorted(measured_fluids(given.catalogue), key=lambda one: one.viscosity)
            names += [one.fluid for one in found]
        else:
            names.append(name)
    return [(given.replace("contaminant", name), name) for name in dict.fromkeys(names)]


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
        for heading in (
            "speed\nm/s",
            "viscosity\nx speed\nmPa m",
            "COF",
            "95 %",
            "adhe-\nsion",
            "hyste-\nresis",
            "vis-\ncous",
            "lambda",
            "load on\nfluid",
        ):
            table.add_column(heading, justify="right", no_wrap=True)
        if curve.points is not None:
            table.add_column("pub-\nlished", justify="right")
        chosen = np.flatnonzero(np.isin(curve.speed, SPEEDS))
        if chosen.size < 5:
            chosen = np.unique(np.linspace(0, curve.speed.size - 1, 9).round().astype(int))
        chosen = np.union1d(chosen, [0, curve.speed.size - 1])
        for row in (curve.rows()[i] for i in chosen):
            low, published = row["cof_low_95"], row["published_cof"]
            ratio, share = row.get("lambda_ratio"), row.get("fluid_load_share")
            table.add_row(
                f"{row['speed_m_per_s']:.3g}",
                f"{1e3 * row['viscosity_times_speed_Pa_m']:.3g}",
                f"{row['cof']:.3f}",
                "-" if low is None else f"{low:.2f}-{row['cof_high_95']:.2f}",
                f"{row['adhesion']:.3f}",
                f"{row['hysteresis']:.3f}",
                f"{row['viscous']:.3f}",
                "-" if ratio is None else f"{ratio:.2g}",
                "-" if share is None else f"{share:.0%}",
                "" if published is None else f"{published:.3f}",
            )
        console.print(table)
        if curve.regimes is not None:
            for text in (*curve.regimes.sentences(), curve.regimes.why):
                if text:
                    console.print(f"  {text}", markup=False)
        for text in curve.notes:
            console.print(f"  {text}", markup=False, style="dim")
    if out is not None:
        console.print(f"\nFigure and table in {out}", markup=False)
