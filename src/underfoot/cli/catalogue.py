"""``underfoot catalogue``: entries to build cases from."""

from __future__ import annotations

from json import dumps
from typing import Annotated

import typer

from .options import AsJson, CatalogueFolders, catalogue_for
from .output import print_table


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
    from underfoot.core.presentation import Table

    known = catalogue_for(None, catalogue)
    if kind and kind.removesuffix("s") in KINDS:
        kind = kind.removesuffix("s")
    if kind and kind not in KINDS:
        raise unknown_name("kind of catalogue entry", kind, KINDS, where="catalogue")
    chosen = {group: known.names(group) for group in ([kind] if kind else KINDS)}
    if json:
        print(dumps(chosen, indent=2))
        return
    for group, names in chosen.items():
        entries = [known.entry(group, name) for name in names]
        rows = [
            (
                f"  {name}",
                entry.title + ("" if entry.origin == "built in" else f" ({entry.origin})"),
            )
            for name, entry in zip(names, entries, strict=True)
        ]
        print_table(Table(group, ("", ""), rows))


def _origin(origin: str) -> str:
    return "" if origin == "built in" else f"({origin})"
