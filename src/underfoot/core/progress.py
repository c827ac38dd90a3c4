"""Progress that means something: a stage, a fraction done and the residual; cancel from outside."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol


class Progress(Protocol):
    """Receives progress; may raise ``Cancelled`` to stop the work."""

    def __call__(self, stage: str, fraction: float, residual: float | None = None) -> None:
        """Report that ``stage`` is done to ``fraction`` (0 to 1) with the solver's ``residual``."""
        ...


def silent(stage: str, fraction: float, residual: float | None = None) -> None:
    """Report nothing."""


@contextmanager
def bar(title: str) -> Iterator[Progress]:
    """Yield a progress receiver that draws one line on the terminal's standard error."""
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=28),
        TextColumn("{task.percentage:>3.0f} %"),
        TextColumn("{task.fields[residual]}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=Console(stderr=True), transient=True) as drawing:
        task = drawing.add_task(title, total=1.0, residual="")

        def report(stage: str, fraction: float, residual: float | None = None) -> None:
            text = "" if residual is None else f"residual {residual:.1e}"
            drawing.update(
                task, description=stage, completed=min(max(fraction, 0.0), 1.0), residual=text
            )

        yield report
