"""``underfoot explain``: a formula, a catalogue entry, a key of case files or a term."""

from __future__ import annotations

from typing import Annotated

import typer

from .options import CatalogueFolders, catalogue_for


def explain(
    name: Annotated[
        str,
        typer.Argument(
            help="A formula (glycerol_water_viscosity), a catalogue entry (canola_oil), "
            'a key (contaminant.viscosity), a term (acof) or an equation ("Eq. 17").',
            show_default=False,
        ),
    ],
    everything: Annotated[
        bool, typer.Option("--all", help="Also parameters, notes and errors of a formula.")
    ] = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Explain a formula, an equation of the report, a catalogue entry, a key or a term.

    The short form has formula, equation of the report, tested range and source.
    """
    from underfoot.questions.explanation import explanation

    print(explanation(name, catalogue_for(None, catalogue), full=everything))
