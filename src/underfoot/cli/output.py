"""Answers on the terminal: one way to compute, write and print for every command."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path, PurePath
from textwrap import shorten, wrap
from typing import TYPE_CHECKING, Any

import typer

from .guard import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from underfoot.core import Progress
    from underfoot.core.presentation import Presentable, Table
    from underfoot.questions.risk import RiskAssessment
    from underfoot.report import Written
    from underfoot.report.writing import Writer

NOT_USABLE = 4
"""Exit code where a computation did not end with a result."""
MOST_RECORDS, MOST_ROWS = 40, 12
"""Rows of a wide table on the terminal; ``--all`` prints all."""
SHORT = 12
"""Longest text of a second column that names a row together with the first."""
MOST_LINES = 3
"""Lines of a list of remarks on the terminal; ``--all`` prints all."""
REMARKS = ("", "Remark", "Source", "Basis", "origin")
"""Heads of last columns that are set dim: they explain, they are no result."""
LONGEST_LINE = 110
NARROWEST = 24
"""Characters of the last column below which the other columns wrap too."""
LONGEST_VALUE, LONGEST_PATH = 36, 24
"""Characters of a cell above which the terminal prints it on a line of its own; of a path's end."""


def answer(
    title: str,
    compute: Callable[[Progress], Presentable],
    *,
    out: Path | None = None,
    overwrite: bool = False,
    json: bool = False,
    everything: bool = False,
    further: Callable[[Any, Path], dict[str, Writer]] | None = None,
) -> None:
    """Compute with progress, write ``out`` if given, print; exit with what the result deserves.

    ``further`` returns more data files of the result for the folder ``out``.
    """
    from underfoot.core.files import check_writable_folder
    from underfoot.core.progress import bar

    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with bar(title) as progress:
        result = compute(progress)
    written = None
    if out is not None:
        from underfoot.report import write_report

        more = {} if further is None else {"further": further(result, out)}
        written = write_report(result, out, overwrite=overwrite, **more)
    finish(result, written, json=json, everything=everything)


def finish(
    result: Presentable,
    written: Written | None,
    *,
    json: bool,
    everything: bool = False,
    advice: RiskAssessment | None = None,
) -> None:
    """Print an answer as tables or JSON, and where its files are; exit with its code.

    The most effective changes of ``advice`` follow the answer.
    """
    from underfoot.report.writing import WRITTEN_IN_PART, json_text

    if json:
        print(json_text(result, advice=advice), end="")
    else:
        show(result, everything=everything)
        if advice is not None:
            print(f"\n{advice.table().title}:")
            for line in advice.change_sentences():
                print(f"  - {line}")
    if written is not None:
        first, *failures = written.lines()
        if not json:
            print(f"\n{first}")
        for failure in failures:
            say(f"error: {failure}")
        if failures:
            say("The results were computed; they are written in part.")
            raise typer.Exit(WRITTEN_IN_PART)
    if not result.usable:
        raise typer.Exit(NOT_USABLE)


def print_json(content: Any) -> None:
    """Print data as JSON."""
    from underfoot.report.writing import data_text

    print(data_text(content), end="")


def show(shown: Presentable, *, everything: bool = False) -> None:
    """Print headline, cautions, tables and remarks."""
    from rich.console import Console

    console = Console(highlight=False)
    console.print(f"\n[bold]{escape_markup(shown.heading())}[/bold]")
    for sentence in shown.headline():
        console.print(sentence, markup=False)
    for caution in shown.cautions():
        console.print(f"[yellow]Caution:[/yellow] {escape_markup(caution)}")
    for table in shown.tables():
        if table.rows:
            console.print()
            print_table(table, everything=everything)
    for title, lines in shown.remarks().items():
        if not lines:
            continue
        count = f" ({len(lines)})" if len(lines) > 1 else ""
        console.print(f"\n{title}{count}:", markup=False)
        told = lines if everything else lines[:MOST_LINES]
        for line in told:
            console.print(f"  - {line if everything else shorten_remark(line)}", markup=False)
        if len(told) < len(lines):
            console.print(f"  … {len(lines) - len(told)} more: --all", markup=False)


def shorten_remark(line: str) -> str:
    """Return a remark without the source or reason in brackets, on one line of a terminal."""
    return shorten(line.partition(" (")[0], LONGEST_LINE, placeholder=" …")


def print_table(table: Table, *, everything: bool = True) -> None:
    """Print a table; without ``everything`` long remarks in its last column lose their sources."""
    from rich.console import Console
    from rich.table import Table as RichTable

    console = Console(highlight=False)
    if table.title:
        console.print(table.title, style="bold", markup=False)
    cells = table.cells()
    last = len(table.columns) - 1
    if not everything and last > 1:
        ends = [c if len(c) <= LONGEST_VALUE else shorten_remark(c) for *_, c in cells]
        cells = [[*map(narrow_cell, row[:-1]), end] for row, end in zip(cells, ends, strict=True)]
    widths = [
        max(len(line) for cell in column for line in cell.split("\n"))
        for column in zip(table.columns, *cells, strict=True)
    ]
    if sum(widths) + 2 * last > console.width:
        if sum(width > LONGEST_VALUE for width in widths) > 1:
            _print_records(console, table, cells, everything=everything)
            return
        longest = [
            max(len(word) for cell in column for word in cell.split() or [""])
            for column in zip(table.columns, *cells, strict=True)
        ]
        if sum(longest) + 2 * last > console.width:
            _print_blocks(console, table, cells, widths, everything=everything)
            return
    roomy = sum(widths[:last]) + NARROWEST <= console.width
    short = widths[0] <= LONGEST_VALUE  # a row's level is its indent, which a second line lacks
    drawn = RichTable(box=None, pad_edge=False, show_header=any(table.columns))
    for number, name in enumerate(table.columns):
        drawn.add_column(
            escape_markup(name),
            no_wrap=number != last and (roomy or last == 1 or (number == 0 and short)),
            overflow="fold",
            style="dim" if number == last > 1 and name in REMARKS else None,
        )
    for row in cells:
        drawn.add_row(*map(escape_markup, row))
    console.print(drawn)


def narrow_cell(cell: str) -> str:
    """Return a long path by its end, a checksum by its beginning, a dotted name on two lines."""
    if len(cell) <= LONGEST_VALUE or re.search(r"\s", cell):
        return cell
    if re.fullmatch("[0-9a-f]{64}", cell):
        return f"{cell[:SHORT]}…"
    if len(names := PurePath(cell).parts) > 1:
        return "…" + "/".join(names)[1 - LONGEST_PATH :]
    first, dot, last = cell.rpartition(".")
    return f"{first}.\n  {last}" if dot else cell


def _print_records(
    console: Console, table: Table, cells: Sequence[Sequence[str]], *, everything: bool
) -> None:
    """Print each row as a heading with a line a column: sentences do not fit beside each other."""
    label = max(map(len, table.columns[1:]))
    rows = cells if everything else cells[:MOST_RECORDS]
    for heading, *row in rows:
        console.print(heading.replace("\n  ", ""), markup=False)
        for name, cell in zip(table.columns[1:], row, strict=True):
            if cell and cell != "-":
                text = f"\n{' ' * (label + 4)}".join(wrap(cell, console.width - label - 4))
                console.print(f"  {name:{label}}  {text}", markup=False)
    _say_rest(console, len(cells) - len(rows))


def _print_blocks(
    console: Console,
    table: Table,
    cells: Sequence[Sequence[str]],
    widths: Sequence[int],
    *,
    everything: bool,
) -> None:
    """Print a table of many columns as blocks that fit, the columns that name a row before each."""
    rows = cells if everything else cells[:MOST_ROWS]
    worded = all(row[1] and not row[1][0].isdigit() and len(row[1]) <= SHORT for row in cells)
    keys = range(2 if worded and len(widths) > 3 else 1)
    blocks: list[list[int]] = [[]]
    start = sum(widths[k] + 2 for k in keys) - 2
    used = start
    for number in range(len(keys), len(widths)):
        if blocks[-1] and used + 2 + widths[number] > console.width:
            blocks.append([])
            used = start
        blocks[-1].append(number)
        used += 2 + widths[number]
    for count, block in enumerate(blocks):
        if count:
            console.print()
        for line in (table.columns, *rows):
            texts = {k: line[k].replace("\n  ", "") for k in (*keys, *block)}
            shown = [f"{text:{min(widths[k], console.width)}}" for k, text in texts.items()]
            console.print("  ".join(shown).rstrip(), markup=False)
    _say_rest(console, len(cells) - len(rows))


def _say_rest(console: Console, rest: int) -> None:
    if rest > 0:
        console.print(f"  … {rest} more rows: --all, or the CSV of --out", markup=False)


def escape_markup(text: str) -> str:
    """Return text with brackets that are not taken for markup."""
    return text.replace("[", "\\[")
