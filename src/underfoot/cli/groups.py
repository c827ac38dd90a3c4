"""Commands and groups of commands; those that other packages offer are loaded when asked for."""

import sys
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from underfoot.core import InputError
from underfoot.core.registry import find_offer, offers

from .guard import guard_command, say

RENAMED = {
    "risk": {"--wanted": "--target"},
    "slip": {"--fine": "--full"},
    "explain": {"--full": "--all"},
    "run": {"--no-changes": "--no-advice"},
}
"""New name of each old option, by command."""
NOTES = {
    ("slip", "--full"): "--full now selects the fine grid; --full-model simulates every walker "
    "with the full model."
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
                say(f"note: {option} is now {renamed[option]}; the old name ends with 0.4.")
                option = renamed[option]
            elif (self.name, option) in NOTES:
                say(f"note: {NOTES[self.name or '', option]}")
            current.append(option + sign + value)
        return super().parse_args(ctx, current)


class Group(TyperGroup):
    """A group whose commands may come from other packages: ``NAME``, or ``GROUP.NAME`` in one."""

    @property
    def _prefix(self) -> str:
        return "" if self.name == "underfoot" else f"{self.name}."

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command; the program ends with a sentence where its package is missing."""
        if cmd_name not in self.commands:
            try:
                if (command := self._find_command(cmd_name)) is not None:
                    return command
            except InputError as error:
                say(f"error: {error}")
                sys.exit(2)
            self.list_commands(ctx)  # what was meant may be of another package
        return super().get_command(ctx, cmd_name)

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of all commands; those that can't be loaded are told and left out."""
        names = [offer.removeprefix(self._prefix) for offer in offers("commands")
                 if offer.startswith(self._prefix)]  # fmt: skip
        for name in names:
            if name in self.commands or "." in name:
                continue
            try:
                self.commands[name] = self._find_command(name)
            except InputError as error:
                say(f"caution: {error}")
        return super().list_commands(ctx)

    def _find_command(self, name: str) -> Any:
        """Return a command that another package offers as a function or group, or None."""
        item = find_offer("commands", self._prefix + name)
        if item is None:
            return None
        if not isinstance(item, typer.Typer):
            function, item = item, typer.Typer(add_completion=False)
            item.command(name, cls=Command)(guard_command(function))
        command = get_command(item)
        command.name = name
        return command
