"""``underfoot compare``: results side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import (
    AsJson,
    CatalogueFolders,
    OutFolder,
    Overwrite,
    Quick,
    Settings,
    ShowAll,
    catalogue_for,
    loaded,
)
from .output import answer


def compare(
    paths: Annotated[
        list[Path],
        typer.Argument(
            metavar="A B [C ...]", help="Result folders or case files.", show_default=False
        ),
    ],
    out: OutFolder = None,
    quick: Quick = False,
    set_: Settings = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Rank two to eight results or cases by friction, with the probability of the order.

    With --out: the soles side by side, one colour scale, maps of the differences. --set and
    --quick apply to case files.
    """
    from underfoot.compute.result import Result
    from underfoot.questions.comparison import check_paths
    from underfoot.questions.comparison import compare as compared

    check_paths(paths)
    items = [
        Result.load(path) if path.is_dir() else loaded(path, catalogue, set_) for path in paths
    ]
    known = catalogue_for(None, catalogue)
    answer(
        " and ".join(item.name for item in items),
        lambda progress: compared(*items, quick=quick, catalogue=known, progress=progress),
        out=out,
        overwrite=overwrite,
        json=json,
        everything=everything,
    )
