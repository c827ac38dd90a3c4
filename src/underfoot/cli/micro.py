"""``underfoot micro``: a rough rubber block pressed on a rough floor and slid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .guard import say
from .options import AsJson, Overwrite
from .output import NOT_USABLE, print_json, print_table

if TYPE_CHECKING:
    from underfoot.block import MicroResult
    from underfoot.block.command_input import MicroCase


COLUMNS = {
    "time_s": "time",
    "sliding_m": "distance",
    "normal_N": "normal_force",
    "shear_N": "shear_force",
    "lateral_N": "lateral_force",
    "area_m2": "real_contact_area",
    "height_m": "height",
}
"""Attribute of the result behind each column of a history."""


def micro(
    case: Annotated[Path | None, typer.Argument(help="Case of the block (TOML).")] = None,
    solver: Annotated[
        str | None,
        typer.Option(
            "--solver",
            help="condensed (seconds) or explicit (finite elements, minutes); the case's own "
            "by default.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Folder for histories and the picture."),
    ] = None,
    snapshots: Annotated[
        int,
        typer.Option(
            "--snapshots",
            min=0,
            help="VTU files of the slide for ParaView (explicit, with --out): open block.pvd.",
        ),
    ] = 0,
    template: Annotated[
        bool, typer.Option("--template", help="Print a commented case to start from.")
    ] = False,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Press a rough block on a rough floor and slide it: contact area, hysteresis, history.

    With --out: micro.json, history_SPEED.csv for each speed, history.png.

    A stopped explicit run goes on when the same command is given again.
    """
    import shutil
    import tempfile

    from underfoot.block.command_input import TEMPLATE, micro_case
    from underfoot.core import InputError
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar

    if template:
        print(TEMPLATE, end="")
        return
    if case is None:
        raise InputError(
            "no case",
            where="underfoot micro",
            remedy="underfoot micro --template > block.toml writes one to start from",
        )
    chosen = micro_case(case, solver=solver)
    if snapshots and (out is None or chosen.solver != "explicit"):
        raise InputError(
            f"{snapshots} snapshots",
            where="--snapshots",
            allowed="with --out and the explicit solver",
            remedy="Add --solver explicit --out FOLDER",
        )
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with tempfile.TemporaryDirectory() as pictures:
        try:
            with bar("micro model") as progress:
                results = [
                    chosen.result(
                        speed,
                        progress,
                        snapshots=snapshots,
                        folder=Path(pictures) / f"snapshots_{speed:g}",
                    )
                    for speed in chosen.speeds
                ]
        except KeyboardInterrupt:
            if chosen.solver == "explicit":
                say("its last state is kept: the same command goes on from there")
            raise
        content = as_data(chosen, results)
        if out is not None:
            with whole_folder(out, overwrite=overwrite) as staging:
                _write(staging, chosen, results, content)
                if snapshots:
                    shutil.copytree(pictures, staging, dirs_exist_ok=True)
    if json:
        print_json(content)
    else:
        _show(content, out)
    if not all(result.status.usable for result in results):
        raise typer.Exit(NOT_USABLE)


def as_data(chosen: MicroCase, results: list[MicroResult]) -> dict[str, Any]:
    """Return case and averages as plain data in SI; what is missing is None."""
    from dataclasses import asdict

    rows = []
    for speed, result in zip(chosen.speeds, results, strict=True):
        averages = result.averages if result.status.usable else None
        numbers = {} if averages is None else asdict(averages)
        rows.append(
            {
                "speed_m_per_s": speed,
                **{key: None if value != value else value for key, value in numbers.items()},
                "status": str(result.status),
                "steps": result.steps,
                "process_seconds": result.process_seconds,
                "notes": list(result.notes),
                "breaches": list(map(str, result.breaches)),
            }
        )
    return {
        "name": chosen.name,
        "solver": chosen.solver,
        "block": chosen.describe_case(),
        "assumed": list(chosen.assumed),
        "results": rows,
    }


def _write(
    folder: Path, chosen: MicroCase, results: list[MicroResult], content: dict[str, Any]
) -> None:
    import numpy as np
    import pandas

    from underfoot.report.study_figures import draw_figure
    from underfoot.report.writing import data_text
    from underfoot.studies.g1 import history_figure

    (folder / "micro.json").write_text(data_text(content), encoding="utf-8")
    histories = {}
    for speed, result in zip(chosen.speeds, results, strict=True):
        history = {name: np.asarray(getattr(result, name)) for name in COLUMNS.values()}
        table = pandas.DataFrame(dict(zip(COLUMNS, history.values(), strict=True)))
        table.to_csv(folder / f"history_{speed:g}.csv", index=False, lineterminator="\r\n")
        histories[chosen.name, speed] = history
    figure = draw_figure(history_figure(histories, chosen.floor.wavelength, chosen.name))
    figure.savefig(folder / "history.png", dpi=150)


def _show(content: dict[str, Any], out: Path | None) -> None:
    from rich.console import Console

    from underfoot.core.presentation import Table

    console = Console(highlight=False)
    console.print(f"\n{content['name']}", style="bold", markup=False)
    for line in content["block"]:
        console.print(line, markup=False)
    heads = ("speed", "COF", "mean |shear|", "A_c/F_N", "no edges", "pressure", "status")
    rows = []
    notes: list[str] = list(content["assumed"])
    for row in content["results"]:
        cells = ["-"] * 5
        if "cof_hysteresis" in row:
            without = row["area_per_force_corrected"]
            cells = [
                f"{row['cof_hysteresis']:.5f}",
                f"{row['cof_absolute']:.4f}",
                f"{row['area_per_force'] * 1e6:.4g} mm²/N",
                "-" if without is None else f"{without * 1e6:.4g} mm²/N",
                f"{row['mean_pressure'] * 1e-3:.4g} kPa",
            ]
        rows.append((f"{row['speed_m_per_s']:g} m/s", *cells, row["status"]))
        notes += [n for n in (*row["notes"], *row["breaches"]) if n not in notes]
    print_table(Table("", heads, rows))
    console.print(
        "COF is the signed mean of shear over whole floor wavelengths; mean |shear| (over normal "
        "force) is no friction. A_c counts whole cells of touching nodes, as finite elements do; "
        '"no edges" is the better estimate of the same area.',
        style="dim",
    )
    if notes:
        console.print("\nNotes:", markup=False)
        for note in notes:
            console.print(f"  - {note}", markup=False)
    if out is not None:
        console.print(f"\nFiles in {out}; open {out / 'history.png'}", markup=False)
