"""``underfoot slip``: people step on the floor of a case; who slips, how fast, how far."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .guard import say
from .options import AsJson, CasePath, CatalogueFolders, Overwrite, Settings, loaded

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.slip.dynamics import GaitHistory, SlipStudy


def slip(
    case: CasePath,
    subjects: Annotated[
        int | None,
        typer.Option("--subjects", min=1, help="How many people step.", show_default=False),
    ] = None,
    full: Annotated[
        bool, typer.Option("--full", help="Everybody through the full model: seconds each.")
    ] = False,
    fine: Annotated[
        bool, typer.Option("--fine", help="The case's fine grid: several times slower.")
    ] = False,
    history: Annotated[
        list[Path] | None,
        typer.Option(
            "--history",
            help="Steps of your own instead of the packaged ones: a force-plate recording or a "
            "table; may be given several times.",
            show_default=False,
        ),
    ] = None,
    rcof_from: Annotated[
        Path | None,
        typer.Option(
            "--rcof-from",
            help="measurements.csv of `underfoot trials analyse`: its RCOF replace risk.rcof_*.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", help="Folder for the results; out/CASE_slip by default.", show_default=False
        ),
    ] = None,
    json: AsJson = False,
    set_: Settings = None,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Let people step on the floor of a case: slip or not, speed, distance, pressures in time.

    Writes slip.html (page with the moving picture), slip.png, subjects.csv, motion.csv, slip.json.
    A stopped run goes on where it was.
    """
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.document.slip_page import write_slip_outputs
    from underfoot.document.slip_words import slip_data

    settings = list(set_ or ())
    if rcof_from is not None:
        mean, sd = measured_rcof(rcof_from)
        settings += [f"risk.rcof_mean={mean:.6g}", f"risk.rcof_sd={sd:.6g}"]
    found = loaded(case, catalogue, settings)
    folder = out if out is not None or json else Path("out") / f"{case.stem}_slip"
    if folder is not None:
        check_writable_folder(folder, overwrite=overwrite)
    steps = [step for path in history or () for step in own_histories(path)]
    study = computed(found, subjects, steps, full=full, fine=fine)
    if folder is not None:
        with whole_folder(folder, overwrite=overwrite) as staging:
            write_slip_outputs(study, found.name, staging)
    if json:
        import json as json_text

        print(json_text.dumps(slip_data(study), indent=2, ensure_ascii=False))
    else:
        _show(study, found.name, folder)


def own_histories(path: Path) -> list[GaitHistory]:
    """Return the steps in a table of ours, or those of a recording."""
    from underfoot.slip.dynamics import load_history, recorded_histories
    from underfoot.slip.dynamics.gait import COLUMNS

    if path.suffix.lower() == ".csv" and path.is_file():
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
        if any(line.startswith(COLUMNS[0]) for line in lines[:50]):
            return [load_history(path)]
    return recorded_histories(path)


def measured_rcof(path: Path) -> tuple[float, float]:
    """Return mean and standard deviation of the RCOF in a table of ``underfoot trials analyse``."""
    import csv

    import numpy as np

    from underfoot.core import InputError

    try:
        with path.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
    except FileNotFoundError:
        raise InputError("there is no such file", where=str(path)) from None
    values = []
    for row in rows:
        if row.get("quantity") == "rcof" and row.get("value"):
            try:
                values.append(float(row["value"]))
            except ValueError:
                continue
    if not values:
        raise InputError(
            "holds no RCOF",
            where=str(path),
            allowed='rows with quantity "rcof" and a value, as in measurements.csv',
        )
    return float(np.mean(values)), float(np.std(values, ddof=1)) if len(values) > 1 else 0.0


def computed(
    case: Case, subjects: int | None, steps: list[GaitHistory], *, full: bool, fine: bool
) -> SlipStudy:
    """Return the study, with a progress bar when a person is watching."""
    import sys

    from underfoot.case.build_slip import slips
    from underfoot.core.progress import bar

    options = {"subjects": subjects, "histories": steps or None, "full": full, "fine": fine}
    if not sys.stderr.isatty():
        say(f"computing: {case.name}")
        return slips(case, **options)
    with bar(case.name) as progress:
        return slips(case, progress=progress, **options)


def _show(study: SlipStudy, name: str, folder: Path | None) -> None:
    from rich.console import Console
    from rich.table import Table

    from underfoot.document.slip_words import slip_cautions, slip_rows, slip_sentence

    console = Console(highlight=False)
    console.print(f"\n{name}", style="bold", markup=False)
    console.print(slip_sentence(study), markup=False)
    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column()
    table.add_column(no_wrap=True)
    table.add_column(style="dim")
    for row in slip_rows(study):
        table.add_row(row.label, row.value, row.remark)
    console.print(table)
    console.print("\nTo know:", markup=False)
    for line in slip_cautions(study):
        console.print(f"  - {line}", markup=False)
    if folder is not None:
        console.print(f"\nFiles in {folder}; open {folder / 'slip.html'}", markup=False)
