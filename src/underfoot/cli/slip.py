"""``underfoot slip``: simulated slips of a population of walkers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .guard import say
from .options import (
    AsJson,
    CasePath,
    CatalogueFolders,
    OutFolder,
    Overwrite,
    Quick,
    Settings,
    ShowAll,
    loaded,
)
from .output import answer


def slip(
    case: CasePath,
    subjects: Annotated[
        int | None,
        typer.Option("--subjects", min=1, help="Number of walkers.", show_default=False),
    ] = None,
    full_model: Annotated[
        bool,
        typer.Option("--full-model", help="Full model for every walker: seconds each."),
    ] = False,
    history: Annotated[
        list[Path] | None,
        typer.Option(
            "--history",
            help="Steps of your own instead of the packaged ones: a force-plate recording or a "
            "table; may be repeated.",
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
    out: OutFolder = None,
    quick: Quick = True,
    set_: Settings = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Simulate slips for a population of walkers: who slips, speed, distance, pressures.

    Data, figure and animated report.html go to --out, by default out/CASE_slip. A stopped run
    continues.
    """
    from underfoot.questions.slips import measured_rcof, own_histories, slip_population

    settings = list(set_ or ())
    if rcof_from is not None:
        mean, sd, words = measured_rcof(rcof_from)
        say(words)
        settings += [f"risk.rcof_mean={mean:.6g}", f"risk.rcof_sd={sd:.6g}"]
    given = loaded(case, catalogue, settings)
    steps = [step for path in history or () for step in own_histories(path)]
    answer(
        given.name,
        lambda progress: slip_population(
            given,
            subjects=subjects,
            histories=steps,
            full_model=full_model,
            quick=quick,
            progress=progress,
        ),
        out=out if out is not None or json else Path("out") / f"{case.stem}_slip",
        overwrite=overwrite,
        json=json,
        everything=everything,
    )
