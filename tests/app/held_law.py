"""A friction law that waits as long as a test keeps a folder: its case is unfinished till then.

No test imports it, or the law would stand in the schema; ``web_app.held`` names it.
"""

import time
from hashlib import sha256
from pathlib import Path
from typing import ClassVar

from underfoot.case.friction import PairOption
from underfoot.case.quantity import optional


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
