"""``underfoot run``: one case from file to friction."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import (
    AsJson,
    CasePath,
    CatalogueFolders,
    OutFolder,
    Overwrite,
    Processes,
    Quick,
    Settings,
    ShowAll,
    loaded,
)
from .output import finish


def run(
    case: CasePath,
    out: OutFolder = None,
    quick: Quick = False,
    no_advice: Annotated[
        bool,
        typer.Option(
            "--no-advice", help="Do not simulate possible changes (never done with --quick)."
        ),
    ] = False,
    set_: Settings = None,
    processes: Processes = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Compute the friction of a case, then the effect of possible changes on the coarse grid.

    Data, maps and report.html go to --out, by default out/CASE. With --json and no --out nothing
    is written.
    """
    from underfoot.compute.run import run as result_of
    from underfoot.core.files import check_writable_folder
    from underfoot.core.progress import bar
    from underfoot.questions.risk import risk_assessment
    from underfoot.report import write_report

    given = loaded(case, catalogue, set_)
    folder = out if out is not None or json else Path("out") / case.stem
    if folder is not None:
        check_writable_folder(folder, overwrite=overwrite)
    with bar(given.name) as progress:
        result = result_of(given, quick=quick, progress=progress)
    advice = None
    if result.usable and not (quick or no_advice):
        with bar("effect of possible changes") as progress:
            advice = risk_assessment(given, processes=processes, progress=progress)
    written = None
    if folder is not None:
        written = write_report(result, folder, overwrite=overwrite, advice=advice)
    finish(result, written, json=json, everything=everything, advice=advice)
