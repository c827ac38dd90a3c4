"""``underfoot validate``: closed forms beside what the program computes."""

from __future__ import annotations

from dataclasses import asdict
from json import dumps

import typer

from .guard import say
from .options import AsJson
from .output import print_table


def validate(json: AsJson = False) -> None:
    """Compute cases with a known exact solution and print the errors."""
    from underfoot.core.presentation import Table
    from underfoot.questions.validation import checks

    rows = list(checks())
    failed = [check.name for check in rows if not check.passed]
    if json:
        print(
            dumps(
                [asdict(check) | {"relative_error": check.relative_error} for check in rows],
                indent=2,
            )
        )
    else:
        cells = [
            (
                check.name,
                f"{check.computed:.6g}",
                f"{check.exact:.6g}",
                f"{100 * check.relative_error:.2g} %",
                f"{100 * check.tolerance:.2g} %",
                "yes" if check.passed else "no",
                check.source,
            )
            for check in rows
        ]
        heads = ("Check", "Computed", "Exact", "Error", "Tolerance", "Within", "Source")
        print_table(Table("", heads, cells))
        print(f"{len(rows) - len(failed)} of {len(rows)} within their tolerance")
    if failed:
        say(f"error: outside the tolerance: {', '.join(failed)}")
        raise typer.Exit(1)
