"""The commands; each imports what it needs when it runs."""

import os
from collections.abc import Callable
from enum import StrEnum
from typing import Annotated

import typer

from . import app_command, cases, export, material, micro, places, tools
from .calibrate import calibrate_app
from .contact import contact
from .groups import Command, Group
from .guard import guard_command
from .outsole import outsole_app
from .stribeck import stribeck
from .studies import studies_app
from .study import study_app
from .surface import surface
from .trials import trials_app

app = typer.Typer(
    name="underfoot",
    cls=Group,
    help="Friction between a shoe, a floor and what is spilled on it.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)
COMMANDS: tuple[Callable[..., None], ...] = (
    tools.new,
    cases.check,
    cases.run,
    cases.ask,
    cases.slip,
    cases.compare,
    cases.sensitivity,
    cases.risk,
    cases.wear,
    places.choose,
    places.machine,
    places.machines,
    stribeck,
    surface,
    material.material,
    contact,
    micro.micro,
    export.export,
    app_command.app,
    tools.explain,
    tools.catalogue,
    tools.schema,
    tools.migrate,
    tools.validate,
    tools.doctor,
)
for command in COMMANDS:
    app.command(cls=Command)(guard_command(command))
app.command("test", cls=Command)(guard_command(cases.by_method))


for group in (trials_app, calibrate_app, studies_app, study_app, outsole_app):
    app.add_typer(group)


class Units(StrEnum):
    """Units of output."""

    SI = "si"
    US = "us"


def _version(requested: bool) -> None:
    if requested:
        from underfoot.core.provenance import version

        print(f"underfoot {version()}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
    units: Annotated[
        Units | None,
        typer.Option(help="Units of output: si, or us (in, psi, lbf)."),
    ] = None,
) -> None:
    """Friction between a shoe, a floor and what is spilled on it."""
    from underfoot.core.unit_text import UNITS_VARIABLE

    if units is not None:
        os.environ[UNITS_VARIABLE] = units
