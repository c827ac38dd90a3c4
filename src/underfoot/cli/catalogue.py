"""``underfoot catalogue``: what there is to build cases from."""

from __future__ import annotations

from typing import Annotated

import typer

from .options import AsJson, CatalogueFolders


def catalogue(
    kind: Annotated[
        str,
        typer.Argument(
            help="fluid, floor, material, setup, shoe or published.", show_default=False
        ),
    ] = "",
    catalogue: CatalogueFolders = None,
    json: AsJson = False,
) -> None:
    """List the entries of the catalogue; underfoot explain NAME shows one with its sources."""
    from underfoot.core.catalogue import KINDS
    from underfoot.core.errors import unknown_name

    from .options import catalogue_for

    known = catalogue_for(None, catalogue)
    if kind and kind.removesuffix("s") in KINDS:
        kind = kind.removesuffix("s")
    if kind and kind not in KINDS:
        raise unknown_name("kind of catalogue entry", kind, KINDS, where="catalogue")
    chosen = {one: known.names(one) for one in ([kind] if kind else KINDS)}
    if json:
        import json as json_text

        print(json_text.dumps(chosen, indent=2))
        return
    from rich.console import Console
    from rich.table import Table

    for one, names in chosen.items():
        table = Table(title=one, title_justify="left", show_header=False, box=None, pad_edge=False)
        for name in names:
            entry = known.entry(one, name)
            own = "" if entry.origin == "built in" else f"({entry.origin})"
            table.add_row(f"  {name}", f"{entry.title} {own}".strip())
        Console(width=None, highlight=False).print(table)
