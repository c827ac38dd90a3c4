"""``underfoot wear``: friction and film as a sole wears, and when it is worn out."""

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


def wear(
    case: CasePath,
    mode: Annotated[
        str | None,
        typer.Option(
            "--mode",
            help="archard (pressure times sliding; the default), plane (the default for an outsole "
            "from a file) or patch.",
            show_default=False,
        ),
    ] = None,
    steps: Annotated[int, typer.Option("--steps", help="Worn states to compute.", min=2)] = 6,
    limit: Annotated[
        str,
        typer.Option("--limit", help='Fluid load that counts as worn out: "5 N" or "20 %".'),
    ] = "5 N",
    to: Annotated[
        str | None,
        typer.Option(
            "--to", help='Last state: "2 mm" lost, or "1500 mm^2" of patch.', show_default=False
        ),
    ] = None,
    band: Annotated[
        bool, typer.Option("--band/--no-band", help="Vary the least known inputs (4 runs a state).")
    ] = True,
    seed: Annotated[int, typer.Option("--seed", help="Seed of the interval's draws.", min=0)] = 0,
    out: OutFolder = None,
    quick: Quick = True,
    set_: Settings = None,
    processes: Processes = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Wear the sole of a case step by step: friction, film, and when it is worn out.

    Every state is kept on disk: a stopped series continues.
    """
    from underfoot.questions.wear import deepest_wear, limit_load, wear_mode, wear_series

    given = loaded(case, catalogue, set_)
    chosen = wear_mode(mode, given)
    load = limit_load(limit, given.motion.normal_force)
    deepest = deepest_wear(to, chosen)
    answer(
        given.name,
        lambda progress: wear_series(
            given,
            mode=chosen,
            steps=steps,
            deepest=deepest,
            limit=load,
            band=band,
            seed=seed,
            quick=quick,
            processes=processes,
            progress=progress,
        ),
        out=out,
        overwrite=overwrite,
        json=json,
        everything=everything,
    )
