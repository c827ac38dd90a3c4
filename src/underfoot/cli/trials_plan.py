"""``underfoot trials plan``: the run sheet of a test."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .guard import say
from .options import Overwrite, optional


def plan(
    factors: Annotated[
        list[str],
        typer.Argument(help='Conditions with their levels, as "shoe=A,B" "fluid=dry,water".'),
    ],
    out: Annotated[
        Path | None, optional("CSV to write: later the conditions.csv of the folder.")
    ] = None,
    repeats: Annotated[int, typer.Option(help="Of each combination.")] = 1,
    block: Annotated[
        str,
        typer.Option(help="What is complete before the next begins: repeat, or a condition."),
    ] = "repeat",
    together: Annotated[
        str, typer.Option(help="Condition that is slow to change: its runs stay together.")
    ] = "",
    seed: Annotated[int, typer.Option(help="Another seed gives another order.")] = 0,
    suffix: Annotated[str, typer.Option(help="Ending of the files to be recorded.")] = "csv",
    overwrite: Overwrite = False,
) -> None:
    """Write the run sheet of a test: every combination in a random order, in complete blocks.

    The sheet names a file for each run; saved as conditions.csv beside the recordings it tells
    `trials analyse` what each file is.
    """
    from underfoot.case.text import save
    from underfoot.trials.study.run_sheet import checked_suffix, factors_from, run_sheet

    sheet = run_sheet(
        factors_from(factors), repeats=repeats, blocks=block, together=together, seed=seed
    )
    text = sheet.csv_text(checked_suffix(suffix))
    if out is None:
        print(text, end="")
        return
    save(text, out, overwrite=overwrite)
    say(f"{len(sheet.runs)} runs in {out}, in blocks of one {block} each; seed {seed}")
