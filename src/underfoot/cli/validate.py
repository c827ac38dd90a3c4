"""``underfoot validate``: closed forms beside what the program computes."""

from __future__ import annotations

import typer

from .options import AsJson


def validate(json: AsJson = False) -> None:
    """Compute cases with a known exact answer and print the errors."""
    from underfoot.case.validation import checks

    rows = []
    for name, computed, exact, error, tolerance, source in checks():
        rows.append((name, computed, exact, error, tolerance, source))
    failed = [row[0] for row in rows if not row[3] <= row[4]]
    if json:
        import json as json_text

        keys = ("name", "computed", "exact", "relative_error", "tolerance", "source")
        print(json_text.dumps([dict(zip(keys, row, strict=True)) for row in rows], indent=2))
    else:
        _shown(rows)
        print(f"{len(rows) - len(failed)} of {len(rows)} within their tolerance")
    if failed:
        from .guard import say

        say(f"error: outside the tolerance: {', '.join(failed)}")
        raise typer.Exit(1)


def _shown(rows: list[tuple[str, float, float, float, float, str]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for heading in ("check", "computed", "exact", "error", "allowed", "source"):
        table.add_column(heading)
    for name, computed, exact, error, tolerance, source in rows:
        mark = "" if error <= tolerance else "[red]"
        table.add_row(
            f"{mark}{name}",
            f"{computed:.6g}",
            f"{exact:.6g}",
            f"{mark}{100 * error:.2g} %",
            f"{100 * tolerance:.2g} %",
            source.replace("[", "\\["),
        )
    Console(highlight=False).print(table)
