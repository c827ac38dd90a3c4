"""``underfoot compare``: two results side by side."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .options import AsJson, CatalogueFolders

if TYPE_CHECKING:
    from underfoot.case.result import Result

_Either = Annotated[Path, typer.Argument(help="Result folder or case file.", show_default=False)]


def compare(
    first: _Either,
    second: _Either,
    quick: Annotated[bool, typer.Option("--quick", help="For case files: coarser grid.")] = False,
    json: AsJson = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Say which of two grips better, how sure that is, and in what their cases differ."""
    from underfoot.case import Case
    from underfoot.case.describe import differences
    from underfoot.document import comparison

    from .options import catalogue_for

    results = [_result(path, quick, catalogue) for path in (first, second)]
    known = catalogue_for(None, catalogue)
    cases = [Case.from_text(result.case_text, catalogue=known) for result in results]
    changed = differences(cases[0], cases[1])
    side_by_side = comparison(*results)
    if json:
        import json as json_text

        content = {
            "verdict": side_by_side.verdict,
            "differences": [
                dict(zip(("path", "first", "second"), row, strict=True)) for row in changed
            ],
            "first": results[0].as_dict(),
            "second": results[1].as_dict(),
        }
        print(json_text.dumps(content, indent=2, ensure_ascii=False))
        return
    _shown(results, changed, side_by_side)


def _shown(
    results: list[Result], changed: list[tuple[str, str, str]], side_by_side: object
) -> None:
    from rich.console import Console
    from rich.table import Table

    from underfoot.document.comparison import Comparison

    assert isinstance(side_by_side, Comparison)
    console = Console(highlight=False)
    console.print(side_by_side.verdict, markup=False)
    for title, rows in (
        ("Cases differ in", changed),
        ("Results", [(row.label, row.first, row.second) for row in side_by_side.rows]),
    ):
        table = Table(box=None, pad_edge=False)
        for heading in (title, results[0].name, results[1].name):
            table.add_column(heading)
        for row in rows:
            table.add_row(*(cell.replace("[", "\\[") for cell in row))
        console.print()
        console.print(table)


def _result(path: Path, quick: bool, catalogue: list[Path] | None) -> Result:
    if path.is_dir():
        from underfoot.case.result import Result

        return Result.load(path)
    from .options import loaded
    from .run import computed

    return computed(loaded(path, catalogue, None), quick=quick)
