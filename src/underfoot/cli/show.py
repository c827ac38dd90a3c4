"""Results on the terminal, in a person's units."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from underfoot.case.result import Result


def show_result(result: Result, folder: Path | None) -> None:
    """Print the verdict, the table, what was assumed, what is out of range, where the files are."""
    from rich.console import Console
    from rich.table import Table

    from underfoot.document import summary_rows, verdict

    console = Console(highlight=False)
    console.print(f"\n[bold]{result.name}[/bold]", markup=True)
    console.print(verdict(result), markup=False)
    if result.status.usable:
        table = Table(show_header=False, box=None, pad_edge=False)
        for row in summary_rows(result):
            table.add_row(row.label, row.value, f"[dim]{_plain(row.remark)}[/dim]")
        console.print(table)
    for title, lines in (
        ("Assumed, with no measurement behind it", result.assumptions),
        ("Outside a tested range", result.breaches),
    ):
        if lines:
            console.print(f"\n{title}:", markup=False)
            for line in lines:
                console.print(f"  - {line}", markup=False)
    if folder is not None:
        console.print(f"\nFiles in {folder}; open {folder / 'report.html'}", markup=False)


def _plain(text: str) -> str:
    return text.replace("[", "\\[")
