"""The commands; each imports what it needs when it runs."""

import os
import sys
from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import Annotated, Any

import typer
from typer.core import TyperCommand
from typer.main import get_group

from underfoot.core import InputError
from underfoot.core.registry import offered, offers

from . import cases, tools
from .calibrate import calibrate_app
from .contact import contact
from .export import export
from .guard import guarded, say
from .outsole import outsole_app
from .stribeck import stribeck
from .studies import studies_app
from .study import study_app
from .trials import trials_app
from .web_app import app as web_app

RENAMED = {
    "risk": {"--wanted": "--target"},
    "slip": {"--fine": "--full"},
    "explain": {"--full": "--all"},
    "run": {"--no-changes": "--no-advice"},
}
"""New name of each old option, by command."""
NOTES = {
    ("slip", "--full"): "--full now selects the fine grid; --full-model simulates every walker "
    "with the full model.",
}
"""What to know of an option whose meaning has changed."""


class Command(TyperCommand):
    """A command that takes the old names of its options, with a note, for one version."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Replace old names, with a note for each on standard error."""
        renamed = RENAMED.get(self.name or "", {})
        current = []
        for text in args:
            option, sign, value = text.partition("=")
            if option in renamed:
                say(f"note: {option} is now {renamed[option]}; the old name ends with 0.3.")
                option = renamed[option]
            elif (self.name, option) in NOTES:
                say(f"note: {NOTES[self.name or '', option]}")
            current.append(option + sign + value)
        return super().parse_args(ctx, current)


app = typer.Typer(
    name="underfoot",
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
    export,
    stribeck,
    contact,
    tools.explain,
    tools.catalogue,
    tools.schema,
    tools.migrate,
    tools.validate,
    tools.doctor,
)
for command in COMMANDS:
    app.command(cls=Command)(guarded(command))
app.command("test", cls=Command)(guarded(cases.by_method))
app.command("app", cls=Command)(guarded(web_app))


def add_offered(arguments: Sequence[str]) -> None:
    """Add the commands of other packages: the one asked for, or all of them where none is."""
    asked = next((each for each in arguments if not each.startswith("-")), "")
    if asked in get_group(app).commands:
        return
    for name in [asked] if asked else offers("commands"):
        try:
            if (function := offered("commands", name)) is not None:
                app.command(name, cls=Command)(guarded(function))
        except InputError as error:
            say(f"{'error' if asked else 'caution'}: {error}")
            if asked:
                sys.exit(2)


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
        typer.Option(help="Units of output: si, or us (in, psi, lbf).", show_default=False),
    ] = None,
) -> None:
    """Friction between a shoe, a floor and what is spilled on it."""
    from underfoot.core.units import UNITS_VARIABLE

    if units is not None:
        os.environ[UNITS_VARIABLE] = units
