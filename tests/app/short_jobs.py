"""Jobs of a moment, in a module that a worker loads at once: the tests load NiceGUI beside them."""

import os
import time

from underfoot.core import InputError


def doubled(number, progress):
    progress("half way", 0.5)
    return 2 * number


def deaf(seconds, progress):
    progress("deaf", 0.1)
    time.sleep(seconds)


def refused(progress):
    raise InputError("too fast", where="motion.speed", allowed="at most 5 m/s")


def killed(progress):
    os._exit(1)
