"""A friction law that waits as long as a test keeps a folder: its case is unfinished till then."""

import time
from hashlib import sha256
from pathlib import Path
from typing import ClassVar

from underfoot.case.friction import PairOption
from underfoot.case.quantity import optional

MODEL = "held_law:Held"
"""How a case file names it; an app that a test serves finds it."""


def held(folder, free):
    """Return the changes that hold a case up as long as a folder is, but for ``free`` cases."""
    folder.mkdir()
    return {"friction.model": MODEL, "friction.hold": str(folder), "friction.free": str(free)}


class Held(PairOption):
    """The usual law; while the folder ``hold`` is, all cases but the ``free`` first ones wait."""

    name: ClassVar[str] = "held"

    hold: str | None = optional("folder that holds cases up")
    free: str | None = optional("number of cases that are not held up")

    def build(self, context):
        folder = Path(self.hold)
        parts = (context.shoe, context.floor, context.contaminant, context.motion)
        mark = folder / sha256(repr(parts).encode()).hexdigest()
        while folder.exists() and not mark.exists():
            if len(list(folder.iterdir())) < int(self.free):
                mark.touch()
            time.sleep(0.02)
        return super().build(context)
