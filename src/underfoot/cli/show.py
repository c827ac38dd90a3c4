"""Results on the terminal, in a person's units."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table

    from underfoot.assess.risk import RiskReport
    from underfoot.case.result import Result

_MOST_ASSUMPTIONS = 3
_LONGEST_ASSUMPTION = 64
LONGEST_VALUE = 34
_WEIGHTY = ("interface", "shoe.heel", "shoe.tread", "shoe.sole", "motion")
"""Sections named first: interface roughness and the shape of the sole decide the film."""


def show_result(result: Result, folder: Path | None, advice: RiskReport | None = None) -> None:
    """Print the verdict, the table, the weightiest assumptions, breaches, where the files are."""
    from rich.console import Console

    from underfoot.document import summary_rows, verdict
    from underfoot.document.risk_sentences import change_lines, limit_words

    console = Console(highlight=False)
    console.print(f"\n[bold]{_plain(result.name)}[/bold]", markup=True)
    console.print(verdict(result), markup=False)
    if result.status.usable:
        rows = [(row.label, row.value, row.remark) for row in summary_rows(result)]
        short = [row for row in rows if len(row[1]) <= LONGEST_VALUE]
        console.print(table((), fitting(short, console.width), remarks=True))
        for label, value, _ in (row for row in rows if row not in short):
            console.print(f"{label.strip().capitalize()}: {value}.", markup=False)
        console.print(f"\n{limit_words(result)}", markup=False)
    if advice is not None:
        console.print("What would help most, each computed:")
        for line in change_lines(advice):
            console.print(f"  - {line}", markup=False)
    if result.assumptions:
        count = len(result.assumptions)
        shown = weightiest(result.assumptions)
        many = f"{count} values or rules, all in the report"
        console.print(
            f"\nAssumed, with no measurement behind it: {many if count > 1 else '1 value'}. "
            + ("Measure first:" if count > len(shown) else ""),
            markup=False,
        )
        for line in shown:
            console.print(f"  - {line}", markup=False)
    if result.breaches:
        console.print("\nOutside a tested range:", markup=False)
        for line in result.breaches:
            console.print(f"  - {line}", markup=False)
    if folder is not None:
        console.print(f"\nFiles in {folder}; open {folder / 'report.html'}", markup=False)


def weightiest(assumptions: Sequence[str], most: int = _MOST_ASSUMPTIONS) -> list[str]:
    """Return the assumptions to look at first, one a section, without their reasons."""
    sections = [line.partition(":")[0] for line in assumptions]
    order = {name: number for number, name in enumerate(_WEIGHTY)}
    ranked = sorted(range(len(assumptions)), key=lambda k: (order.get(sections[k], len(order)), k))
    chosen: dict[str, str] = {}
    for k in ranked:
        chosen.setdefault(sections[k], _shortened(assumptions[k].partition(" (")[0]))
    return list(chosen.values())[:most]


def fitting(rows: Sequence[tuple[str, str, str]], width: int) -> list[tuple[str, str, str]]:
    """Return rows with the remarks that fit beside label and value, each said once.

    The report has all of them; wrapped into a narrow column they hide the numbers.
    """
    room = width - sum(max((len(row[k]) for row in rows), default=0) for k in (0, 1)) - 2
    kept, last = [], ""
    for label, value, remark in rows:
        shown = remark if remark != last and len(remark) <= room else ""
        last = remark
        kept.append((label, value, shown))
    return kept


def _shortened(line: str) -> str:
    """Return an assumption on one line of a terminal."""
    parts = line.split(", ")
    count = len(parts)
    while len(parts) > 1 and len(", ".join(parts)) > _LONGEST_ASSUMPTION:
        parts.pop()
    left = count - len(parts)
    return ", ".join(parts) + (f" and {left} more" if left else "")


def table(heads: Sequence[str], rows: Sequence[Sequence[str]], *, remarks: bool = False) -> Table:
    """Return a plain table; with ``remarks`` the last column is dim and alone may wrap."""
    from rich.table import Table

    made = Table(box=None, pad_edge=False, show_header=bool(heads))
    width = len(heads) or max(map(len, rows))
    for number in range(width):
        last = remarks and number == width - 1
        made.add_column(
            heads[number] if heads else "",
            no_wrap=remarks and number == 0,
            style="dim" if last else None,
        )
    for row in rows:
        made.add_row(*(_plain(cell) for cell in row))
    return made


def _plain(text: str) -> str:
    return text.replace("[", "\\[")
