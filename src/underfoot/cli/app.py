"""The commands, each a thin module that imports what it needs when it runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import typer

from .calibrate import calibrate_app
from .catalogue import catalogue
from .check import check
from .compare import compare
from .contact import contact
from .doctor import doctor
from .explain import explain
from .guard import guarded
from .method import by_method
from .micro import micro
from .migrate import migrate
from .new import new
from .outsole import outsole_app
from .renamed import Command
from .risk import risk
from .run import run
from .schema import schema
from .sensitivity import sensitivity
from .slip import slip
from .stribeck import stribeck
from .studies import studies_app
from .trials import trials_app
from .validate import validate
from .wear import wear

app = typer.Typer(
    name="underfoot",
    help="Friction between a shoe, a floor and what is spilled on it.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)


def _add(*commands: Callable[..., None]) -> None:
    for command in commands:
        app.command(cls=Command)(guarded(command))


_add(
    new,
    check,
    run,
    slip,
    compare,
    sensitivity,
    risk,
    wear,
    stribeck,
    contact,
    micro,
    explain,
    catalogue,
    schema,
    migrate,
    validate,
    doctor,
)
app.command("test", cls=Command)(guarded(by_method))
app.add_typer(trials_app)
app.add_typer(calibrate_app)
app.add_typer(studies_app)
app.add_typer(outsole_app)


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
) -> None:
    """Friction between a shoe, a floor and what is spilled on it."""
