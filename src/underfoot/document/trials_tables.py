"""Tables of an analysis as CSV and as one spreadsheet whose bytes depend on the numbers alone."""

from __future__ import annotations

import csv
import io
import math
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from underfoot.core import MissingExtraError

if TYPE_CHECKING:
    from underfoot.trials.analyse import Table

_DATE = (1980, 1, 1, 0, 0, 0)  # the oldest a zip archive can hold
_STAMP = "1980-01-01T00:00:00Z"
_WIDEST = 60


def csv_text(table: Table) -> str:
    """Return a table as CSV text: UTF-8, comma, decimal point, full precision."""
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(table.columns)
    for row in table.rows:
        writer.writerow([_cell(value) for value in row])
    return stream.getvalue()


def write_spreadsheet(tables: Sequence[Table], methods: Sequence[str], path: Path) -> None:
    """Write all tables into one XLSX file, one sheet each, and the methods text on the first.

    Errors
    ------
    MissingExtraError
        The package openpyxl is not installed.
    """
    try:
        from openpyxl import Workbook
        from openpyxl.styles import Alignment, Font
        from openpyxl.utils import get_column_letter
    except ImportError as error:
        raise MissingExtraError("openpyxl", "trials", "writing a spreadsheet") from error
    book = Workbook()
    first: Any = book.active
    first.title = "methods"
    first.column_dimensions["A"].width = 110
    for text in methods:
        first.append([_safe(text)])
        first.cell(first.max_row, 1).alignment = Alignment(wrap_text=True, vertical="top")
    used = {"methods"}
    for table in tables:
        sheet = book.create_sheet(_sheet_name(table.name, used))
        sheet.append([table.title])
        sheet.cell(1, 1).font = Font(bold=True, size=13)
        sheet.append([_safe(name) for name in table.columns])
        for cell in sheet[2]:
            cell.font = Font(bold=True)
        for row in table.rows:
            sheet.append([_number_or_text(value) for value in row])
        for note in table.notes:
            sheet.append([_safe(note)])
        for i, name in enumerate(table.columns, start=1):
            longest = max([len(name), *(len(_cell(row[i - 1])) for row in table.rows[:200])])
            sheet.column_dimensions[get_column_letter(i)].width = min(longest + 2, _WIDEST)
        sheet.freeze_panes = "A3"
    raw = io.BytesIO()
    book.save(raw)
    path.write_bytes(_without_dates(raw.getvalue()))


def _without_dates(data: bytes) -> bytes:
    """Return the archive with fixed dates, inside its properties too."""
    import re

    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(out, "w") as new:
        for name in sorted(old.namelist()):
            content = old.read(name)
            if name == "docProps/core.xml":
                content = re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", _STAMP.encode(), content)
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
    return str(value)


def _number_or_text(value: Any) -> Any:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return None
    if isinstance(value, float):
        return float(f"{value:.10g}")
    return value if isinstance(value, int) else _safe(str(value))


def _safe(text: str) -> str:
    """Text that a spreadsheet would run as a formula is kept as text."""
    cleaned = "".join(letter for letter in text if letter.isprintable() or letter in "\n\t")
    return "'" + cleaned if cleaned.startswith(("=", "+", "@")) else cleaned


def _sheet_name(name: str, used: set[str]) -> str:
    plain = "".join("_" if letter in "[]:*?/\\" else letter for letter in name)[:28]
    chosen, number = plain, 2
    while chosen.casefold() in used:
        chosen, number = f"{plain} {number}", number + 1
    used.add(chosen.casefold())
    return chosen
