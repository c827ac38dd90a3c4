"""A friction law that waits as long as a test keeps a file: its case is unfinished till then."""

import time
from pathlib import Path
from typing import ClassVar

from underfoot.case.friction import PairOption
from underfoot.case.quantity import Speed, optional

MODEL = "held_law:Held"
"""How a case file names it; an app that a test serves finds it."""


class Held(PairOption):
    """The usual law; a case that slides faster than ``free`` waits while the file ``hold`` is."""

    name: ClassVar[str] = "held"

    hold: str | None = optional("file that holds a case up")
    free: Speed | None = optional("speed up to which none is held up")

    def build(self, context):
        while self.hold and context.motion.speed > (self.free or 0) and Path(self.hold).exists():
            time.sleep(0.02)
        return super().build(context)
