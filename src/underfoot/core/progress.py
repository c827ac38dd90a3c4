"""Progress that means something: a stage, a fraction done and the residual; cancel from outside."""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

FIRST_LINE = 2.0  # s: shorter work says nothing
BETWEEN_LINES = 5.0  # s


class Progress(Protocol):
    """Receives progress; may raise ``Cancelled`` to stop the work."""

    def __call__(self, stage: str, fraction: float, residual: float | None = None) -> None:
        """Report that ``stage`` is done to ``fraction`` (0 to 1) with the solver's ``residual``."""
        ...


def silent(stage: str, fraction: float, residual: float | None = None) -> None:
    """Report nothing."""


def part(progress: Progress, low: float, high: float) -> Progress:
    """Return a receiver whose 0 to 1 is ``low`` to ``high`` of ``progress``."""

    def report(stage: str, fraction: float, residual: float | None = None) -> None:
        progress(stage, low + (high - low) * fraction, residual)

    return report


class TimeLeft:
    """Estimate of the time left in a stage, from the rate since the stage began."""

    def __init__(self) -> None:
        self._stage: str | None = None
        self._began = (0.0, 0.0)

    def __call__(self, stage: str, fraction: float, now: float) -> float | None:
        """Return the seconds left at the time ``now``, or None while nothing is known."""
        if stage != self._stage or fraction < self._began[1]:
            self._stage, self._began = stage, (now, fraction)
        began, start = self._began
        if fraction <= start:
            return None
        return (now - began) * (1.0 - min(fraction, 1.0)) / (fraction - start)


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

    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=28),
        TextColumn("{task.percentage:>3.0f} %"),
        TextColumn("{task.fields[residual]}"),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
    )
    time_left = TimeLeft()
    with Bar(*columns, console=Console(stderr=True), transient=True) as drawing:
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
    if seconds is None:
        return ""
    if seconds < 90:
        return f"about {max(1.0, seconds):.0f} s left"
    if seconds < 5400:
        return f"about {seconds / 60:.0f} min left"
    return f"about {seconds / 3600:.1f} h left"
