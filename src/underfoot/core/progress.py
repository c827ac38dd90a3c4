"""Progress that means something: a stage, a fraction done and the residual; cancel from outside."""

import sys
import time
from bisect import bisect_left
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

FIRST_LINE = 2.0  # s: shorter work says nothing
BETWEEN_LINES = 5.0  # s
LEAST_DONE = 0.1
"""Share of a stage that has to be done before the time left is estimated."""
STEADY = 2.0
"""Greatest ratio of the times of a stage's two halves at which its rate says what is left."""


class Progress(Protocol):
    """Receives progress; may raise ``Cancelled`` to stop the work."""

    def __call__(self, stage: str, fraction: float, residual: float | None = None) -> None:
        """Report that ``stage`` is done to ``fraction`` (0 to 1) with the solver's ``residual``."""
        ...


def silent(stage: str, fraction: float, residual: float | None = None) -> None:
    """Report nothing."""


def part(progress: Progress, low: float, high: float, name: str = "") -> Progress:
    """Return a receiver whose 0 to 1 is ``low`` to ``high`` of ``progress``.

    ``name`` stands in place of the names of its stages.

    Raises:
        ValueError: Not 0 <= ``low`` <= ``high`` <= 1 (to rounding).
    """
    if not -1e-9 <= low <= high + 1e-9 <= 1 + 2e-9:
        raise ValueError(f"{low:g} to {high:g} is no part of a progress")

    def report(stage: str, fraction: float, residual: float | None = None) -> None:
        progress(name or stage, low + (high - low) * fraction, residual)

    return report


class TimeLeft:
    """Estimate of the time left, from the rate since the present stage began.

    Known once a tenth of what was left as the stage began is done, and its two halves took times
    that differ by a factor of two at most: work that stalls or whose rate changes has no estimate.
    None is more than nine times what the stage has taken.
    """

    def __init__(self) -> None:
        self._stage: str | None = None
        self._times: list[float] = []
        self._fractions: list[float] = []

    def __call__(self, stage: str, fraction: float, now: float) -> float | None:
        """Return the seconds left at the time ``now``, or None while they can't be known."""
        fraction = min(fraction, 1.0)
        if stage != self._stage or fraction < self._fractions[-1]:
            self._stage, self._times, self._fractions = stage, [], []
        self._times.append(now)
        self._fractions.append(fraction)
        began, start = self._times[0], self._fractions[0]
        done = fraction - start
        if done < LEAST_DONE * (1.0 - start) or done <= 0.0:
            return None
        after = bisect_left(self._fractions, start + 0.5 * done)
        (t1, t2), (f1, f2) = (
            each[after - 1 : after + 1] for each in (self._times, self._fractions)
        )
        first = t1 + (t2 - t1) * (start + 0.5 * done - f1) / (f2 - f1) - began
        second = now - began - first
        steady = max(first, second) <= STEADY * min(first, second)
        return (now - began) * (1.0 - fraction) / done if steady else None


@contextmanager
def bar(title: str) -> Iterator[Progress]:
    """Yield a progress receiver for standard error: a bar on a terminal, else a line at times.

    Lines come from ``FIRST_LINE`` seconds on, at most one in ``BETWEEN_LINES`` seconds.
    """
    if not sys.stderr.isatty():
        yield _lines(title)
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar
    from rich.table import Column

    columns = (  # on a narrow terminal the name of the stage is cut, and no number
        TextColumn("{task.description}", table_column=Column(ratio=1, no_wrap=True)),
        BarColumn(bar_width=10),
        TextColumn("{task.percentage:>3.0f} %"),
        TextColumn("{task.fields[residual]}"),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
    )
    time_left = TimeLeft()
    console = Console(stderr=True)
    with Bar(*columns, console=console, transient=True, expand=True) as drawing:
        task = drawing.add_task(title, total=1.0, residual="", left="")

        def report(stage: str, fraction: float, residual: float | None = None) -> None:
            drawing.update(
                task,
                description=stage,
                completed=min(max(fraction, 0.0), 1.0),
                residual="" if residual is None else f"residual {residual:.1e}",
                left=_left_text(time_left(stage, fraction, time.monotonic())),
            )

        yield report


def _lines(title: str) -> Progress:
    began = time.monotonic()
    due = began + FIRST_LINE
    time_left = TimeLeft()

    def report(stage: str, fraction: float, residual: float | None = None) -> None:
        nonlocal due
        now = time.monotonic()
        left = _left_text(time_left(stage, fraction, now))
        if now < due:
            return
        due = now + BETWEEN_LINES
        text = f"{title}: {stage}, {100 * min(max(fraction, 0.0), 1.0):.0f} %"
        text += f", {now - began:.0f} s so far" + (f", {left}" if left else "")
        print(text, file=sys.stderr, flush=True)

    return report


def _left_text(seconds: float | None) -> str:
    return "" if seconds is None else f"about {time_text(max(1.0, seconds))} left"


def time_text(seconds: float) -> str:
    """Return a time in the unit that people read."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
