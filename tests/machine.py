"""What this machine has: its browser, and its speed, by which limits of time are longer."""

import os
import subprocess
import sys
from functools import cache

IMPORTS, USUAL = "import numpy, scipy.sparse, scipy.ndimage, pydantic", 0.44
"""What a process loads first, and the CPU s of it where README's example takes 12 (``--quick``);
where that took 27, this took 0.96."""

CHROMIUM = ("chromium", "chromium-browser", "google-chrome", "chrome")
"""Names that a browser for the tests of pages has."""


def cpu_seconds() -> float:
    """Return the CPU s of this process and of those it waited for."""
    return sum(os.times()[:4])


@cache
def slowness() -> float:
    """Return how many times longer than on a usual machine a process takes here, at least 1."""
    return max(min(_seconds() for _ in range(3)) / USUAL, 1.0)


def _seconds() -> float:
    before = sum(os.times()[2:4])
    subprocess.run([sys.executable, "-c", IMPORTS], check=True)
    return sum(os.times()[2:4]) - before
