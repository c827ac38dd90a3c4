"""Everything an analysis of trials leaves: one page, tables, a spreadsheet, figures.

The same folder gives the same bytes: no clock, no random numbers, sorted files, fixed dates
inside archives.
"""

from __future__ import annotations

import csv
import io
import math
import re
import zipfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from underfoot.core import Progress, silent
from underfoot.core.files import check_writable_folder
from underfoot.core.html import data_address, environment, png
from underfoot.core.pool import in_processes
from underfoot.core.presentation import p_text
from underfoot.core.progress import part
from underfoot.core.remark import NOTHING, Message, join_lines
from underfoot.core.text import harmless
from underfoot.core.unit_text import plain_number

from ..study.tables import Role
from .figures import SheetPage, TrialFigure, contact_sheets, sheets, trial_figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..study import FileResult, FolderAnalysis, TrialTable
    from ..study.tables import TrialColumn

STORE = ".files"
_MARK = "analysis.txt"
_LONG = 60  # rows of a table shown on the page; the spreadsheet has all
_DATE = (1980, 1, 1, 0, 0, 0)  # the oldest a zip archive can hold
_STAMP = b"1980-01-01T00:00:00Z"
_WIDEST = 60
_MANY = 24  # figures from which other processes draw faster than this one alone


def write_trials_report(
    analysis: FolderAnalysis,
    folder: Path,
    *,
    details: int = 4,
    processes: int | None = None,
    progress: Progress = silent,
) -> list[Path]:
    """Write report.html, trials.xlsx, tables/, figures/ and models/; return the paths.

    ``details`` single trials are drawn in detail. Figures of the study and of single trials are
    written as PNG and SVG, contact sheets as SVG. ``processes`` (by default one a processor) draw.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []

    def write(name: str, text: str) -> None:
        written.append(folder / name)
        written[-1].write_text(text, encoding="utf-8")

    write(
        _MARK,
        f"Analysis of trials by the protocol {analysis.protocol.name}.\n"
        "report.html: all on one page. trials.xlsx and tables/: every number. figures/: pictures.\n"
        "models/: data and scripts of R and Python that find the mixed models again.\n"
        f"{STORE}/: results of single files, so that an interrupted analysis can go on.\n",
    )
    models = {
        name: text for finding in analysis.study.findings for name, text in finding.files.items()
    }
    for name in ("tables", "figures", "models"):
        (folder / name).mkdir(exist_ok=True)
        for old in (folder / name).iterdir():
            old.unlink()
    if not models:
        (folder / "models").rmdir()
    cautions = {f.table.name: f.cautions for f in analysis.study.findings}
    tables = analysis.tables
    for table in tables:
        write(f"tables/{table.name}.csv", csv_text(table, cautions.get(table.name, ())))
    for name, text in models.items():
        write(f"models/{name}", text)
    figures = trial_figures(analysis, details=details)
    pages = [page for sheet in sheets(analysis.files) for page in contact_sheets(sheet)]
    for page in pages:
        write(f"figures/{page.name}.svg", page.svg)
    jobs: list[tuple[Any, ...]] = [(tables, analysis.methods, folder / "trials.xlsx")]
    jobs += [(figure, folder / "figures") for figure in figures]
    count = processes if len(jobs) >= _MANY else 1
    drawing = part(progress, 0.0, 0.95)
    for _, paths in sorted(
        in_processes(_write_file, jobs, count, progress=drawing, stage="drawing")
    ):
        written += paths
    pictures = [
        (figure, (folder / "figures" / f"{figure.name}.png").read_bytes()) for figure in figures
    ]
    write("report.html", trials_page(analysis, tables, pictures, pages))
    progress("drawing", 1.0)
    return written


def _write_file(job: tuple[Any, ...]) -> list[Path]:
    """Write the spreadsheet (tables, methods, path) or a figure (figure, folder)."""
    if not isinstance(job[0], TrialFigure):
        write_spreadsheet(*job)
        return [job[2]]
    one, folder = job
    paths = [folder / f"{one.name}{suffix}" for suffix in (".png", ".svg")]
    paths[0].write_bytes(png(one.figure, 130))
    _svg(one.figure, paths[1])
    return paths


def check_report_folder(folder: Path, *, overwrite: bool = False) -> None:
    """Refuse a folder that holds something else than an earlier analysis of trials."""
    if (folder / _MARK).is_file() or (folder / STORE).is_dir():
        return
    check_writable_folder(folder, overwrite=overwrite)


def trials_page(
    analysis: FolderAnalysis,
    all_tables: Sequence[TrialTable],
    pictures: list[tuple[TrialFigure, bytes]],
    pages: Sequence[SheetPage] = (),
) -> str:
    """Return the page of an analysis as HTML text; it opens without a network."""
    chapters: dict[str, list[dict[str, str]]] = {"study": [], "trials": []}
    for figure, picture in pictures:
        width = f"{5.3 * figure.figure.get_figwidth():.1f}"
        chapters[figure.chapter].append(
            {"caption": figure.caption, "source": data_address(picture), "width": width}
        )
    tables = {table.name: table for table in all_tables}
    return environment(__package__ or "").get_template("trials.html").render(
        analysis=analysis,
        number=_count_text(len(analysis.files), "files"),
        **study_parts(analysis),
        first=chapters["study"][:1],
        figures={**chapters, "study": chapters["study"][1:]},
        sheets=[page.svg for page in pages],
        files=page_table(_without_conditions(tables["files"]), limit=10_000),
        edits=page_table(tables["edits"]) if "edits" in tables else None,
        doubts=page_table(tables["doubts"]) if "doubts" in tables else None,
    )  # fmt: skip


def study_parts(analysis: FolderAnalysis) -> dict[str, Any]:
    """Return what a page says of a folder as a whole, as plain data.

    ``lead``: one sentence; ``counts``: files by verdict; ``reasons``: the most frequent ones with
    their number; ``summary`` (or None), ``study`` and ``findings``: tables with title, columns,
    rows of text, long text below each row, which columns are numbers, and notes; findings have
    cautions too.
    """
    study = list(analysis.study.tables)
    summary = study.pop(0) if study and study[0].name not in ("steps",) else None
    reasons = Counter(
        kind
        for file in analysis.files
        for kind in file.kinds or file.reasons
        if file.verdict != "accepted"
    )
    findings = analysis.study.findings
    return {
        "lead": lead_sentence(analysis),
        "counts": Counter(file.verdict for file in analysis.files),
        "reasons": reasons.most_common(4),
        "summary": None if summary is None else page_table(_compact(summary)),
        "study": [page_table(_compact(table)) for table in study],
        "findings": [page_table(f.table) | {"cautions": f.cautions} for f in findings],
    }


def lead_sentence(analysis: FolderAnalysis) -> Message:
    """Return what a reader came for: mean, spread, interval and how many."""
    usable = [file for file in analysis.files if file.usable]
    kind = analysis.protocol.kind
    if not usable:
        return Message("No file gave usable numbers: see the reasons below.")
    cautions, count = sum(result.verdict == "caution" for result in usable), len(usable)
    tail = NOTHING
    if cautions:
        tail = Message(
            " {cautions} of {count} usable {count:file|files} {cautions:carries|carry} a caution.",
            cautions=cautions, count=count,
        )  # fmt: skip
    tables = {table.name: table for table in analysis.study.tables}
    if kind == "human_slip":
        return Message("{slips}.{tail}", slips=_slips(usable), tail=tail)
    loads = [m["load"] for m in analysis.study.curves.get("maps", [])]
    if loads:
        carried = {"low": min(loads), "high": max(loads), "tail": tail}
        tail = Message(" The fluid carries {low:.3g} to {high:.3g} N.{tail}", **carried)
    table = tables.get("conditions")
    # Floors and shoes on a tester are no sample of one population: no mean over all of them.
    if table is not None and (kind == "gait" or len(table.rows) == 1):
        row = [*zip(table.heads, table.rows[-1], strict=True)]
        cells = {(head.quantity, head.role): cell for head, cell in row}
        mean = next(
            head
            for name in usable[0].main
            for head, cell in row
            if head.quantity == name and head.role is Role.MEAN and isinstance(cell, float)
        )
        places = _places(mean)
        label = {"rcof": "Required friction (RCOF)"}.get(mean.quantity, mean.name)
        roles = {"average": Role.MEAN, "spread": Role.SD, "low": Role.LOW, "high": Role.HIGH}
        ends = {name: cells.get((mean.quantity, role)) for name, role in roles.items()}
        shown = {name: f"{x:.{places}f}" for name, x in ends.items() if isinstance(x, float)}
        average, more = shown.pop("average"), NOTHING
        if "low" in shown and "high" in shown:
            more = Message(", SD {spread}, 95 % {low} to {high}", **shown)
        counted = [
            _count_text(cell, head.name) for head, cell in row if head.role is Role.COUNT and cell
        ]
        return Message(
            "{label} {average}{more} ({counted}).{tail}",
            label=label, average=average, more=more, counted=counted, tail=tail,
        )  # fmt: skip
    samples = tables.get("samples")
    if samples is not None:
        counted = _count_text(len(samples.rows), "samples")
        return Message("{counted}.{tail}", counted=counted, tail=tail)
    cof = [result.main["cof"] for result in usable if "cof" in result.main]
    if cof:
        return Message(
            "COF {low:.3f} to {high:.3f} in {count} usable {count:run|runs}.{tail}",
            low=min(cof), high=max(cof), count=len(cof), tail=tail,
        )  # fmt: skip
    return Message("{count} usable {count:test|tests}.{tail}", count=count, tail=tail)


def _slips(usable: Sequence[FileResult]) -> Message:
    """Return how many of the trials were slips, how near the limit, at which required friction."""
    judged = [result for result in usable if "slip" in result.main]
    share = close = friction = NOTHING
    slips = int(sum(result.main["slip"] for result in judged))
    if judged:
        share = Message(" ({share:.0f} %)", share=100 * slips / len(judged))
    near = sum(abs(result.main.get("slip_margin", 1.0)) < 0.05 for result in judged)
    if near:
        close = Message(", {near} of them within 0.05 m/s of the limit", near=near)
    rcof = [result.main["rcof"] for result in usable if "rcof" in result.main]
    if rcof:
        ends = {"low": min(rcof), "high": max(rcof)}
        friction = Message("; required friction {low:.2f} to {high:.2f}", **ends)
    return Message(
        "{slips} {slips:slip|slips} in {count} {count:trial|trials}{share}{close}{friction}",
        slips=slips, count=len(judged), share=share, close=close, friction=friction,
    )  # fmt: skip


def _count_text(number: object, things: str) -> Message:
    """Return a number with what it counts: 1 file, 2 files."""
    return Message(
        "{number} {things}", number=number, things=things if number != 1 else things[:-1]
    )


def _places(head: TrialColumn) -> int:
    """Return the decimals of a mean on a page."""
    return 3 if head.decimals is None else head.decimals


def _without_conditions(table: TrialTable) -> TrialTable:
    """Return the table of files with the columns that a page has room for; files keep all."""
    heads = [*enumerate(table.heads)]
    keep = [i for i, head in heads if head.role is not Role.CONDITION][:9]
    return table.only([i for i, head in heads if i in keep or head.role is Role.LONG])


def _compact(table: TrialTable) -> TrialTable:
    """Return a table of several quantities with mean, SD and interval of each in one cell."""
    cells = [(head.quantity, head.role) for head in table.heads]
    starts = [
        i
        for i, (quantity, role) in enumerate(cells)
        if role is Role.MEAN and (quantity, Role.HIGH) in cells
    ]
    if len(starts) < 2:
        return table
    inside = {i + k for i in starts for k in (1, 2, 3)}
    shown = [i for i in range(len(cells)) if i not in inside]

    def cell(row: Sequence[Any], i: int) -> Any:
        if i not in starts:
            return row[i]
        texts = [
            f"{v:.{_places(table.heads[i])}f}" for v in row[i : i + 4] if isinstance(v, int | float)
        ]
        if len(texts) < 4:
            return "".join(texts[:1])
        return f"{texts[0]} ({texts[1]}), {texts[2]} to {texts[3]}"

    heads = (
        replace(head, name=Message("{quantity}: mean (SD), 95 %", quantity=head.name))
        if i in starts
        else head
        for i, head in enumerate(table.heads)
        if i in shown
    )
    rows = tuple(tuple(cell(row, i) for i in shown) for row in table.rows)
    return replace(table, heads=tuple(heads), rows=rows)


def page_table(table: TrialTable, *, limit: int = _LONG) -> dict[str, Any]:
    """Return a table as a page shows it: filled columns, texts, long text below its row, notes."""
    rows = table.rows[:limit]
    # Columns that say nothing in any row are noise on a page; the spreadsheet keeps them.
    below = [i for i in table.filled_columns() if table.heads[i].role is Role.LONG]
    filled = [i for i in table.filled_columns() if i not in below]
    notes = list(table.notes)
    if len(table.rows) > limit:
        notes.append(
            Message("{count} more rows are in the spreadsheet.", count=len(table.rows) - limit)
        )
    return {
        "title": table.title,
        "columns": [table.columns[i] for i in filled],
        "rows": [[_cell_text(row[i], table.heads[i]) for i in filled] for row in rows],
        "below": [join_lines(row[i] for i in below if row[i]) for row in rows],
        "numbers": [
            all(isinstance(row[i], int | float) or row[i] in (None, "") for row in table.rows)
            for i in filled
        ],
        "notes": notes,
    }


def _cell_text(value: Any, head: TrialColumn) -> str:
    if value is None or value == "":
        return "–"
    if isinstance(value, str):
        return value
    if head.role is Role.CHANCE:
        return p_text(value)
    if isinstance(value, int):
        return str(value)
    if head.role is Role.ANSWER:
        return "yes" if value else "no"
    if head.decimals is not None:
        return f"{value:.{head.decimals}f}"
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    return plain_number(value)


def _svg(figure: Figure, path: Path) -> None:
    import matplotlib as mpl

    # The layout was worked out for the PNG and takes most of the drawing time.
    figure.set_layout_engine("none")
    stream = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "underfoot"}):
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    # matplotlib names clip paths after memory addresses; in order of appearance they repeat
    seen: dict[str, str] = {}
    text = re.sub(
        r"\bp[0-9a-f]{10}\b",
        lambda found: seen.setdefault(found[0], f"clip{len(seen)}"),
        stream.getvalue(),
    )
    path.write_text(text, encoding="utf-8")


def csv_text(table: TrialTable, cautions: Sequence[str] = ()) -> str:
    """Return a table as CSV text: UTF-8, comma, decimal point, full precision.

    ``cautions`` of the whole table stand in a last column of their own, so that a table that
    travels alone keeps them.
    """
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([*table.columns, *(["cautions"] if cautions else [])])
    extra = ["; ".join(cautions)] if cautions else []
    writer.writerows([*map(_cell, row), *extra] for row in table.rows)
    return stream.getvalue()


def write_spreadsheet(tables: Sequence[TrialTable], methods: Sequence[str], path: Path) -> None:
    """Write all tables into one XLSX file, one sheet each, and the methods text on the first."""
    from openpyxl import Workbook
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.styles import Alignment, Font
    from openpyxl.utils import get_column_letter

    book = Workbook(write_only=True)  # cells go to the file at once: a tenth of the memory

    def style_cell(sheet: Any, text: str, **style: Any) -> Any:
        cell = WriteOnlyCell(sheet, text)
        for name, value in style.items():
            setattr(cell, name, value)
        return cell

    first = book.create_sheet("methods")
    first.column_dimensions["A"].width = 110
    wrapped = Alignment(wrap_text=True, vertical="top")
    for text in methods:
        first.append([style_cell(first, _safe(text), alignment=wrapped)])
    used = {"methods"}
    for table in tables:
        sheet = book.create_sheet(_sheet_name(table.name, used))
        sheet.freeze_panes = "A3"
        for i, name in enumerate(table.columns, start=1):
            longest = max([len(name), *(len(_cell(row[i - 1])) for row in table.rows[:200])])
            sheet.column_dimensions[get_column_letter(i)].width = min(longest + 2, _WIDEST)
        sheet.append([style_cell(sheet, table.title, font=Font(bold=True, size=13))])
        bold = Font(bold=True)
        sheet.append([style_cell(sheet, _safe(name), font=bold) for name in table.columns])
        for row in table.rows:
            sheet.append([_number_or_text(value) for value in row])
        for note in table.notes:
            sheet.append([_safe(note)])
    raw = io.BytesIO()
    book.save(raw)
    path.write_bytes(_without_dates(raw.getvalue()))


def _without_dates(data: bytes) -> bytes:
    """Return the archive with fixed dates, inside its properties too."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(out, "w") as new:
        for name in sorted(old.namelist()):
            content = old.read(name)
            if name == "docProps/core.xml":
                content = re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", _STAMP, content)
            entry = zipfile.ZipInfo(name, _DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            new.writestr(entry, content)
    return out.getvalue()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.10g}" if math.isfinite(value) else ""
    return harmless(str(value))


def _number_or_text(value: Any) -> Any:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return None
    if isinstance(value, float):
        return float(f"{value:.10g}")
    return value if isinstance(value, int) else _safe(str(value))


def _safe(text: str) -> str:
    """Text that a spreadsheet would run as a formula is kept as text."""
    cleaned = "".join(letter for letter in text if letter.isprintable() or letter in "\n\t")
    return harmless(cleaned)


def _sheet_name(name: str, used: set[str]) -> str:
    plain = "".join("_" if letter in "[]:*?/\\" else letter for letter in name)[:28]
    chosen, number = plain, 2
    while chosen.casefold() in used:
        chosen, number = f"{plain} {number}", number + 1
    used.add(chosen.casefold())
    return chosen
