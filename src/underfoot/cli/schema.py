"""``underfoot schema``: the JSON Schema of case files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import Overwrite


def schema(
    out: Annotated[
        Path | None, typer.Option("--out", help="File to write instead.", show_default=False)
    ] = None,
    overwrite: Overwrite = False,
) -> None:
    """Print the JSON Schema of case files, for editors and other programs."""
    from underfoot.case.schema import schema_text
    from underfoot.case.text import save

    if out is None:
        print(schema_text(), end="")
        return
    save(schema_text(), out, overwrite=overwrite)
    print(f"wrote {out}")
