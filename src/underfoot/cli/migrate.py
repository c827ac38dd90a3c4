"""``underfoot migrate``: case files of an older version in the present one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import CasePath, CatalogueFolders, Overwrite, loaded


def migrate(
    case: CasePath,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="File to write; default: the case itself.", show_default=False),
    ] = None,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Write a case file in the present version of the format; comments are kept."""
    read = loaded(case, catalogue, None)
    if read.to_toml() == case.read_text(encoding="utf-8") and out is None:
        print(f"{case} is up to date")
        return
    target = case if out is None else out
    read.save(target, overwrite=overwrite)
    for change in read.changes:
        print(change)
    print(f"wrote {target}")
