"""How slow this machine is: limits of time hold for a usual one, and are longer on a slower."""

import os
import subprocess
import sys
from functools import cache

IMPORTS, USUAL = "import numpy, scipy.sparse, scipy.ndimage, pydantic", 0.44
"""What a process loads first, and the CPU s of it where README's example takes 12 (``--quick``);
where that took 27, this took 0.96."""


@cache
def slowness() -> float:
    """Return how many times longer than on a usual machine a process takes here, at least 1."""
    return max(min(_seconds() for _ in range(3)) / USUAL, 1.0)


def _seconds() -> float:
    before = sum(os.times()[2:4])
    subprocess.run([sys.executable, "-c", IMPORTS], check=True)
    return sum(os.times()[2:4]) - before
