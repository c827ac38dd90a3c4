"""Everything an analysis of trials leaves: one page, tables, a spreadsheet, figures.

The same folder gives the same bytes: no clock, no random numbers, sorted files, fixed dates
inside archives.
"""

from __future__ import annotations

import base64
import io
import math
import re
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from underfoot.core import Progress, display, silent
from underfoot.core.files import check_writable_folder

from .page import environment
from .trials_figures import TrialFigure, trial_figures
from .trials_tables import csv_text, write_spreadsheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from underfoot.trials.analyse import FolderAnalysis, Table

STORE = ".files"
_MARK = "analysis.txt"
_LONG = 60  # rows of a table shown on the page; the spreadsheet has all


def write_trials_report(
    analysis: FolderAnalysis,
    folder: Path,
    *,
    details: int = 4,
    vector: bool = True,
    progress: Progress = silent,
) -> list[Path]:
    """Write report.html, trials.xlsx, tables/*.csv, figures/*.png and *.svg; return the paths.

    Parameters
    ----------
    details
        Number of single trials drawn in detail.
    vector
        Write the figures of the study and of single trials as SVG too.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = [folder / _MARK]
    written[0].write_text(
        f"Analysis of trials by the protocol {analysis.protocol.name}.\n"
        "report.html: all on one page. trials.xlsx and tables/: every number. figures/: pictures.\n"
        f"{STORE}/: results of single files, so that an interrupted analysis can go on.\n",
        encoding="utf-8",
    )
    for name in ("tables", "figures"):
        (folder / name).mkdir(exist_ok=True)
        for old in (folder / name).iterdir():
            old.unlink()
    for table in analysis.tables:
        written.append(folder / "tables" / f"{table.name}.csv")
        written[-1].write_text(csv_text(table), encoding="utf-8")
    written.append(folder / "trials.xlsx")
    write_spreadsheet(analysis.tables, analysis.methods, written[-1])
    progress("drawing", 0.1)
    figures = trial_figures(analysis, details=details)
    pictures = []
    for number, one in enumerate(figures, start=1):
        png = _png(one.figure, 110 if one.chapter == "sheets" else 130)
        pictures.append((one, png))
        written.append(folder / "figures" / f"{one.name}.png")
        written[-1].write_bytes(png)
        if vector and one.chapter != "sheets":
            written.append(folder / "figures" / f"{one.name}.svg")
            _svg(one.figure, written[-1])
        progress("drawing", 0.1 + 0.85 * number / len(figures))
    written.append(folder / "report.html")
    written[-1].write_text(trials_page(analysis, pictures), encoding="utf-8")
    progress("drawing", 1.0)
    return written


def check_report_folder(folder: Path, *, overwrite: bool = False) -> None:
    """Refuse a folder that holds something else than an earlier analysis of trials."""
    if (folder / _MARK).is_file() or (folder / STORE).is_dir():
        return
    check_writable_folder(folder, overwrite=overwrite)


def trials_page(analysis: FolderAnalysis, pictures: list[tuple[TrialFigure, bytes]]) -> str:
    """Return the page of an analysis as HTML text; it opens without a network."""
    counts = Counter(one.verdict for one in analysis.files)
    tables = {table.name: table for table in analysis.tables}
    findings = [
        {"title": f.title, "table": _page_table(f.table), "cautions": f.cautions}
        for f in analysis.study.findings
    ]
    chapters: dict[str, list[dict[str, str]]] = {"study": [], "trials": [], "sheets": []}
    for one, png in pictures:
        source = "data:image/png;base64," + base64.b64encode(png).decode("ascii")
        chapters[one.chapter].append(
            {
                "caption": one.caption,
                "source": source,
                "name": one.name,
                "width": f"{5.3 * one.figure.get_figwidth():.1f}",
            }
        )
    return (
        environment()
        .get_template("trials.html")
        .render(
            analysis=analysis,
            counts=counts,
            lead=_lead(analysis),
            files=_page_table(tables["files"], limit=10_000),
            edits=_page_table(tables["edits"]) if "edits" in tables else None,
            study=[_page_table(table) for table in analysis.study.tables],
            findings=findings,
            figures=chapters,
        )
    )


def _lead(analysis: FolderAnalysis) -> str:
    """One sentence with what a reader came for."""
    usable = [one for one in analysis.files if one.usable]
    kind = analysis.protocol.kind
    if not usable:
        return "No file gave usable numbers: see the reasons below."
    if kind == "human_slip":
        judged = [one.main["slip"] for one in usable if "slip" in one.main]
        slips = int(sum(judged))
        rcof = [one.main["rcof"] for one in usable if "rcof" in one.main]
        text = f"{slips} slips in {len(judged)} trials"
        if judged:
            text += f" ({100 * slips / len(judged):.0f} %)"
        doubtful = sum(one.verdict == "caution" for one in usable if "slip" in one.main)
        if doubtful:
            text += f", {doubtful} of them with a caution (read the reasons)"
        if rcof:
            text += f"; required friction {min(rcof):.2f} to {max(rcof):.2f}"
        return text + "."
    if kind in ("slip_tester", "pin_on_disk", "boundary"):
        values = [one.main["cof"] for one in usable if "cof" in one.main]
        if not values:
            return "No file gave a COF: see the reasons below."
        text = f"COF {min(values):.3f} to {max(values):.3f} in {len(values)} usable runs"
        loads = [m["load"] for m in analysis.study.curves.get("maps", [])]
        if loads:
            text += f"; the fluid carries {min(loads):.3g} to {max(loads):.3g} N"
        return text + "."
    if kind == "gait":
        rcof = [one.main["rcof"] for one in usable if "rcof" in one.main]
        mean = sum(rcof) / len(rcof) if rcof else math.nan
        return f"Required friction {mean:.3f} on average of {len(rcof)} trials."
    return f"{len(usable)} usable tests."


def _page_table(table: Table, *, limit: int = _LONG) -> dict[str, Any]:
    kept = table.rows[:limit]
    # Columns that say nothing in any row are noise on a page; the spreadsheet keeps them.
    filled = [
        i for i in range(len(table.columns)) if any(row[i] not in (None, "") for row in table.rows)
    ]
    notes = list(table.notes)
    if len(table.rows) > limit:
        notes.append(f"{len(table.rows) - limit} more rows are in the spreadsheet.")
    return {
        "name": table.name,
        "title": table.title,
        "columns": [table.columns[i] for i in filled],
        "rows": [[_shown(row[i], table.columns[i]) for i in filled] for row in kept],
        "numbers": [
            all(isinstance(row[i], int | float) or row[i] in (None, "") for row in table.rows)
            for i in filled
        ],
        "notes": notes,
    }


def _shown(value: Any, column: str) -> str:
    if value is None or value == "":
        return "–"
    if isinstance(value, str):
        return value
    if column in ("p", "p adjusted"):
        return "< 0.0001" if value < 1e-4 else f"{value:.4f}"
    if isinstance(value, int):
        return str(value)
    if column in ("slip", "heel crossed the array"):
        return "yes" if value else "no"
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    return display(value, "1", 4)


def _png(figure: Figure, dpi: int) -> bytes:
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=dpi, metadata={"Software": None})
    return stream.getvalue()


def _svg(figure: Figure, path: Path) -> None:
    import matplotlib as mpl

    # The layout was worked out for the PNG and takes most of the drawing time.
    figure.set_layout_engine("none")
    with mpl.rc_context({"svg.hashsalt": "underfoot"}):
        figure.savefig(path, format="svg", metadata={"Date": None, "Creator": None})
    # matplotlib names clip paths after memory addresses; in order of appearance they repeat
    text = path.read_text(encoding="utf-8")
    seen: dict[str, str] = {}
    text = re.sub(
        r"\bp[0-9a-f]{10}\b", lambda found: seen.setdefault(found[0], f"clip{len(seen)}"), text
    )
    path.write_text(text, encoding="utf-8")
