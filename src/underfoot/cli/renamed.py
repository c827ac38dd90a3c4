"""Old names of options, which answer with a note for one version."""

from __future__ import annotations

from typing import Any

from typer.core import TyperCommand

from .guard import say

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
    """A command that takes the old names of its options."""

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
