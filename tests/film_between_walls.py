"""Films between given walls, written in one call."""

import numpy as np

from underfoot.film import Film, film_history, film_pressure

STEP = ("before", "time_step", "backend")


def solved_film(gap, **given):
    """Return ``film_pressure`` of ``Film(gap, ...)``; a step in time takes its own keywords."""
    step = {name: given.pop(name) for name in STEP if name in given}
    return film_pressure(Film(gap, **given), **step)


def film_in_time(gap_at, times, *, start_fraction=1.0, **given):
    """Return ``film_history`` from the gap at the first of ``times``."""
    start = Film(gap_at(times[0]), **given)
    return film_history(start, gap_at, times, start_fraction=start_fraction)


def closing_film(gap, speed, *, step=1e-6, **given):
    """Return the film of walls that close at ``speed`` (m/s) over a full film."""
    before = np.where(np.isfinite(gap), gap + speed * step, 0.0)
    return solved_film(gap, before=before, time_step=step, speed=0.0, **given)
