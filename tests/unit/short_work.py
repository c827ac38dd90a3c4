"""Work of a moment for workers, in a module that each loads at once."""

import os
import signal
from pathlib import Path


def squared(number):
    return number**2


def fatal(number):
    if number == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def wrong(number):
    raise ValueError(f"number {number}")


def threads(_):
    return os.environ["OMP_NUM_THREADS"]


def fatal_once(place):
    if not Path(place).exists():
        Path(place).write_text("")
        os.kill(os.getpid(), signal.SIGKILL)
    return "second try"
