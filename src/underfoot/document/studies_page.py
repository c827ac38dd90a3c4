"""One offline page: every study's printed numbers beside ours, its tables and its figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from .page import embedded, environment

COLOURS = {
    "reproduced": "good",
    "within scatter": "good",
    "trend only": "half",
    "disagrees": "bad",
    "can't be had": "none",
}


def studies_page(
    runs: Sequence[Any],
    lines: Sequence[Any],
    *,
    counts: Mapping[str, Mapping[str, int]],
    rules: Mapping[str, str],
    figures: Sequence[tuple[int, str, str, str]],
    remarks: Mapping[tuple[str, str], str],
    images: Mapping[tuple[str, str], bytes],
    quick: bool = False,
) -> str:
    """Return the page as HTML text that needs no network.

    Parameters
    ----------
    runs, lines
        Of ``studies.summary``: what was run, and every statement.
    counts, rules
        Verdicts by study, and what each verdict means.
    figures, remarks
        ``studies.figure_list``: which of ours shows which of the report's, and what differs.
    images
        PNG by (study, name).
    """
    sections = []
    for run in runs:
        result = run.result
        sections.append(
            {
                "study": run.study,
                "error": run.error,
                "seconds": run.seconds,
                "lines": [line for line in lines if line.study == run.study.name],
                "tables": [_table(one) for one in getattr(result, "tables", ())],
                "conclusions": list(getattr(result, "conclusions", ())),
                "notes": list(getattr(result, "notes", ())),
                "assumptions": list(getattr(result, "assumptions", ())),
                "errata": list(getattr(result, "errata", ())),
                "images": [
                    (name, embedded(picture), remarks.get((study, name), ""))
                    for (study, name), picture in images.items()
                    if study == run.study.name
                ],
            }
        )
    return (
        environment()
        .get_template("studies.html")
        .render(
            sections=sections,
            counts=counts,
            rules=rules,
            colours=COLOURS,
            figures=figures,
            quick=quick,
        )
    )


def _table(one: Any) -> dict[str, Any]:
    return {
        "title": one.title,
        "columns": one.columns,
        "rows": [[_cell(value) for value in row] for row in one.rows],
    }


def _cell(value: Any) -> tuple[str, bool]:
    """Return a cell's text and whether it is a number."""
    if value is None or value != value:
        return "-", True
    if isinstance(value, (bool, str)):
        return str(value), False
    number = float(value)
    if number == 0 or 1e-3 <= abs(number) < 1e5:
        return f"{number:.4g}", True
    return f"{number:.3g}", True
