"""``underfoot risk``: slip probability, what limits the friction, effect of changes."""

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


def risk(
    case: CasePath,
    target: Annotated[
        str, typer.Option("--target", help="Slip probability to aim at, as 5 % or 0.05.")
    ] = "5 %",
    out: OutFolder = None,
    quick: Quick = True,
    set_: Settings = None,
    processes: Processes = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Predict the slip probability, what limits the friction and the effect of changes.

    Every change (tread, compound, floor, cleaning, shorter steps) is simulated with the whole
    model.
    """
    from underfoot.core import to_si
    from underfoot.questions.risk import risk_assessment

    share = to_si(target, "1", where="--target")
    given = loaded(case, catalogue, set_)
    answer(
        given.name,
        lambda progress: risk_assessment(
            given, target=share, quick=quick, processes=processes, progress=progress
        ),
        out=out,
        overwrite=overwrite,
        json=json,
        everything=everything,
    )
