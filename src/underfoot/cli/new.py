"""``underfoot new``: a commented case file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import CatalogueFolders, Overwrite


def new(
    file: Annotated[Path, typer.Argument(help="File to write.", show_default=False)],
    shoe: Annotated[str, typer.Option(help="Shoe of the catalogue.")] = "work_shoe_half_tread",
    floor: Annotated[str, typer.Option(help="Floor of the catalogue.")] = "vinyl_g4",
    fluid: Annotated[
        str, typer.Option(help='Fluid of the catalogue, or "none".')
    ] = "glycerol_90pct",
    setup: Annotated[
        str, typer.Option(help="Set-up that gives speed, force, angle.")
    ] = "slip_tester_g4",
    name: Annotated[str, typer.Option(help="Name of the case.")] = "",
    catalogue: CatalogueFolders = None,
    overwrite: Overwrite = False,
) -> None:
    """Write a new case file, with comments, from parts of the catalogue."""
    from underfoot.case.template import template
    from underfoot.case.text import save

    from .options import catalogue_for

    text = template(
        shoe=shoe,
        floor=floor,
        contaminant=fluid,
        motion=setup,
        catalogue=catalogue_for(file, catalogue),
        name=name,
        file=file.name,
    )
    save(text, file, overwrite=overwrite)
    print(f"wrote {file}; next: underfoot check {file}")
