"""What a study leaves on disk: its folder, and one offline page of it or of all studies."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from underfoot.core.html import data_address, environment

from .study_figures import draw_figure

if TYPE_CHECKING:
    from underfoot.studies.runner import PublishedStudyResult

COLOURS = {
    "agrees": "good",
    "overlaps": "half",
    "trend only": "half",
    "undecided": "none",
    "disagrees": "bad",
    "not converged": "none",
    "not comparable": "none",
}


BROAD = 2.6
"""Width over height from which a figure stands alone."""


def write_study(result: PublishedStudyResult, folder: Path) -> list[str]:
    """Write study.json, tables, statements and figures (PNG and their data) into a folder.

    Returns the figures' names.
    """
    content = json.dumps(result.to_dict(figures=True), indent=1, ensure_ascii=False)
    (folder / "study.json").write_text(content, encoding="utf-8")
    for table in result.computed.tables:
        _write_csv(folder / f"{table.name}.csv", table.columns, table.rows)
    rows = [judgement.to_dict() for judgement in result.judgements]
    _write_csv(folder / "verdicts.csv", list(rows[0]), [list(row.values()) for row in rows])
    _write_csv(folder / "errata.csv", ("where", "printed", "used", "why"), result.study.errata)
    columns = ("panel", "series", "x", "y", "low", "high")
    for name, figure in result.computed.figures.items():
        draw_figure(figure).savefig(folder / f"{name}.png", dpi=130)
        _write_csv(folder / f"{name}.csv", columns, figure.rows())
    return sorted(result.computed.figures)


def studies_page(
    results: Sequence[PublishedStudyResult],
    images: Mapping[tuple[str, str], bytes],
    *,
    quick: bool = False,
) -> str:
    """Return the page as HTML text that needs no network; ``images`` are PNG by (study, name)."""
    from underfoot.studies.summary import figure_rows, headline
    from underfoot.studies.verdict import Verdict, tables_by_kind

    names = {r.study.name: [name for s, name in images if s == r.study.name] for r in results}
    remarks = {
        (r.study.name, file): remark for r in results for _, _, file, remark in r.study.figures
    }
    sections = [
        {
            "result": result,
            "study": result.study,
            "tables": result.computed.tables,
            "kinds": [
                (kind.heading, some, number == 0)
                for number, (kind, some) in enumerate(tables_by_kind(result.judgements))
            ],
            "remarks": result.remarks(),
            "images": [
                (name, data_address(data), remarks.get((study, name), ""), _broad(data))
                for (study, name), data in images.items()
                if study == result.study.name
            ],
        }
        for result in results
    ]
    several = len(results) > 1
    page = environment(__package__ or "").get_template("studies.html")
    return page.render(
        title="Printed and computed numbers" if several else results[0].study.title,
        several=several,
        sections=sections,
        headline=headline(results),
        rules={str(verdict): verdict.rule for verdict in Verdict},
        colours=COLOURS,
        figures=figure_rows(results, names),
        cell=_cell,
        quick=quick,
    )


def _broad(png: bytes) -> bool:
    """Return whether a picture needs the page's whole width: its header has width and height."""
    width, height = (int.from_bytes(png[at : at + 4], "big") for at in (16, 20))
    return width > BROAD * height


def _write_csv(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    with path.open("w", newline="", encoding="utf-8-sig") as stream:
        writer = csv.writer(stream)
        writer.writerow(columns)
        writer.writerows(rows)


def _cell(value: Any) -> tuple[str, bool]:
    """Return a cell's text and whether it is a number."""
    if value is None or value != value:
        return "-", True
    if isinstance(value, bool | str):
        return str(value), False
    digits = 4 if value == 0 or 1e-3 <= abs(value) < 1e5 else 3
    return f"{float(value):.{digits}g}", True
