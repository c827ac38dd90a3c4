"""``underfoot test``: predicted result of a standard test method."""

from __future__ import annotations

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
from .output import answer


def by_method(
    case: CasePath,
    method: Annotated[
        str,
        typer.Option(
            "--method",
            help="iso13287, astmf2913, report-slip-tester, report-whole-shoe or a set-up of the "
            "catalogue.",
        ),
    ] = "iso13287",
    keep: Annotated[
        list[str] | None,
        typer.Option(
            "--keep",
            help="Keep a part of the case against the method: floor, contaminant, normal_force, "
            "shoe_angle or speed; may be repeated.",
            show_default=False,
        ),
    ] = None,
    out: OutFolder = None,
    quick: Quick = False,
    set_: Settings = None,
    processes: Processes = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Predict the result of a standard test method: COF and probability of passing.

    Angle, load, speed, floor, contaminant and averaging window are the method's, each listed with
    its source. With --quick the uncertainty is that of the friction law alone.
    """
    from underfoot.questions.method import method_prediction

    given = loaded(case, catalogue, set_)
    answer(
        given.name,
        lambda progress: method_prediction(
            given,
            method,
            keep=keep or (),
            with_band=not quick,
            quick=quick,
            processes=processes,
            progress=progress,
        ),
        out=out,
        overwrite=overwrite,
        json=json,
        everything=everything,
    )
