"""CSV and XLSX as named columns: where the header is, which units, numbers or text."""

import io
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from itertools import chain, zip_longest
from math import nan
from pathlib import Path

import numpy as np

from underfoot.core import DataError
from underfoot.core.numbers_text import (
    NumberForm,
    column_place,
    one_unit,
    units_in_cells,
    without_units,
)
from underfoot.core.remark import Message
from underfoot.core.text import decode_text

from . import text
from .text import force_unit, si_unit

_MOST_CELLS = 50_000_000
_FOOT = 40  # lines below the table
_HEAD = 300  # lines in which the table must begin
_NOTHING = (*text.NOTHING, "", "#div/0!", "#value!")


@dataclass(frozen=True, slots=True)
class Sheet:
    """Columns of a table; numbers as float arrays (NaN where empty), the rest as text.

    ``units`` are as written in the file; ``header`` holds the lines above the table.
    """

    name: str
    numbers: Mapping[str, np.ndarray]
    texts: Mapping[str, tuple[str, ...]]
    units: Mapping[str, str]
    header: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def columns(self) -> list[str]:
        """Names of all columns, numbers first."""
        return [*self.numbers, *self.texts]


def read_sheet(
    path: Path,
    *,
    sheet: str | None = None,
    delimiter: str | None = None,
    header_line: int | None = None,
) -> Sheet:
    """Return a CSV, text or XLSX table as named columns, with text columns kept as text.

    The worksheet is the first one, delimiter and line (from 1) of the column names are found,
    where they are not given. What can't be read or holds no regular table is a DataError.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise DataError(
            Message("can't be read: {strerror}", strerror=error.strerror), where=path.name
        ) from error
    return sheet_from(data, path.name, sheet, delimiter, header_line)


def sheet_from(
    data: bytes,
    where: str,
    sheet: str | None = None,
    delimiter: str | None = None,
    header_line: int | None = None,
) -> Sheet:
    """Return the table in a file's bytes; see ``read_sheet``."""
    notes: list[str] = []
    if is_workbook(data):
        rows = workbook_rows(data, where, sheet, notes)
        inside = units_in_cells(rows, _is_known_unit)
        rows = [without_units(row, inside) for row in rows] if inside else rows
        table = _layout(rows, header_line, where)
        return _sheet(rows, table, rows[table.first :], None, inside, where, notes)
    lines = text.lines_of(decode_text(data, where))
    while lines and not lines[-1].strip():
        lines.pop()
    body = lines[len(lines) // 2 :]  # a free header may hold other signs: the body decides
    if delimiter is None:
        delimiter = text.delimiter_of(body)
    rows = [text.split(line, delimiter) for line in lines[: max(_HEAD, header_line or 0) + 2]]
    inside = units_in_cells(rows, _is_known_unit)
    rows = [without_units(row, inside) for row in rows] if inside else rows
    table = _layout(rows, header_line, where)
    lines = _without_footer(lines, table.first, delimiter, notes)
    values = text.plain_numbers(lines[table.first :], delimiter, notes)
    if values is not None and (table.head is None or values.shape[1] == len(rows[table.head])):
        return _sheet(rows, table, [], values, inside, where, notes)
    rest = [without_units(text.split(line, delimiter), inside) for line in lines[table.first :]]
    return _sheet(rows, table, rest, None, inside, where, notes)


def _without_footer(lines: list[str], first: int, delimiter: str, notes: list[str]) -> list[str]:
    """Lines up to the last row: what follows begins with no number and is no row of the table."""
    end = len(lines)
    if first >= end or not text.is_written_number(text.split(lines[first], delimiter)[0]):
        return lines  # rows begin with text: it ends no table
    while end > first + 1 and len(lines) - end < _FOOT:
        cells = text.split(lines[end - 1], delimiter)
        filled = [cell for cell in cells if cell]
        numbers = sum(text.is_written_number(cell) for cell in filled)
        if filled and (text.is_written_number(cells[0]) or numbers >= 0.5 * len(filled)):
            break
        end -= 1
    else:
        return lines
    words = [line.strip() for line in lines[end:] if line.strip(" \t;,")]
    if words:
        notes.append(Message("below the table, left out: {names}", names="; ".join(words)[:80]))
    return lines[:end]


@dataclass(frozen=True, slots=True)
class _Layout:
    """Indices of the header, the units line and the first row of numbers."""

    head: int | None
    units: int | None
    first: int


def _sheet(
    rows: list[list[str]],
    table: _Layout,
    body: list[list[str]],
    values: np.ndarray | None,
    inside: Mapping[int, str],
    where: str,
    notes: list[str],
) -> Sheet:
    labels = list(rows[table.head]) if table.head is not None else []
    while labels and not labels[-1]:
        labels.pop()
    body = [row for row in body if any(row)]
    if values is None and labels:
        text.check_rows(body, len(labels), table.first + 1, where)
    width = len(labels) or (values.shape[1] if values is not None else max(map(len, body)))
    if not labels:
        labels = [f"column {i + 1}" for i in range(width)]
        notes.append("the table has no column names: numbered")
    pairs = [text.name_and_unit(label) for label in labels]
    written = rows[table.units] if table.units is not None else []
    numbers: dict[str, np.ndarray] = {}
    texts: dict[str, tuple[str, ...]] = {}
    units: dict[str, str] = {}
    forms = text.written_forms(body, width, where, notes) if values is None else []
    for i, name in enumerate(text.unique_names([name for name, _ in pairs], "column", notes)):
        below = written[i] if i < len(written) else ""
        said = (pairs[i][1], below, inside.get(i, ""))
        units[name] = one_unit(said, _same, column_place(where, name))
        if values is not None:
            numbers[name] = text.measurable(values[:, i], notes)
            continue
        cells = [row[i] if i < len(row) else "" for row in body]
        column = _numeric(cells, forms[i])
        if column is None:
            texts[name] = tuple(cells)
        else:
            numbers[name] = text.measurable(column, notes)
    above = rows[: table.head if table.head is not None else table.first]
    header = tuple(" ".join(cell for cell in row if cell) for row in above)
    return Sheet(where, numbers, texts, units, header, tuple(notes))


def _numeric(cells: list[str], form: NumberForm) -> np.ndarray | None:
    try:
        plain = [nan if cell.casefold() in _NOTHING else form.number(cell) for cell in cells]
        return np.array(plain, dtype=float)
    except ValueError:
        return None


def _layout(rows: list[list[str]], header_line: int | None, where: str) -> _Layout:
    if not rows:
        raise DataError("empty", where=where)
    if header_line is not None:
        head = header_line - 1
        if head >= len(rows) - 1:
            raise DataError(
                Message(
                    "there is no line {header_line} with rows below it", header_line=header_line
                ),
                where=where,
            )
        if _are_units(rows[head + 1]) and head + 2 < len(rows):
            return _Layout(head, head + 1, head + 2)
        return _Layout(head, None, head + 1)
    columns = _columns_of_numbers(rows)
    first = next((i for i in range(min(len(rows), _HEAD)) if _is_row(rows, i, columns)), None)
    if first is None:
        raise DataError("no table of numbers was found", where=where)
    above = [i for i in range(first) if any(rows[i])]
    width = len([cell for cell in rows[first] if cell])
    if not above:
        return _Layout(None, None, first)
    head, units = above[-1], None
    if _are_units(rows[head]) and len(above) > 1 and _is_head(rows[above[-2]], width):
        head, units = above[-2], head
    return (
        _Layout(head, units, first) if _is_head(rows[head], width) else _Layout(None, None, first)
    )


def _columns_of_numbers(rows: list[list[str]]) -> list[int]:
    """Columns in which most cells of the later half of the rows are numbers."""
    later = rows[len(rows) // 2 :]
    cells = zip_longest(*later, fillvalue="")
    shares = [[text.is_written_number(cell) for cell in column if cell] for column in cells]
    return [i for i, numbers in enumerate(shares) if 2 * sum(numbers) > len(numbers)]


def _is_row(rows: list[list[str]], i: int, columns: list[int]) -> bool:
    """A row with numbers in most cells, where the table has them, like the row after it."""
    pair = rows[i : i + 2]
    there = [rows[i][k] for k in columns if k < len(rows[i]) and rows[i][k]]
    words = [cell for cell in there if not text.is_written_number(cell)]
    if 2 * sum(cell.casefold() not in _NOTHING for cell in words) >= max(1, len(there)):
        return False  # a word and its value above the table
    shares = [[text.is_written_number(cell) for cell in row if cell] for row in pair]
    if not any(shares[0]) or abs(len(pair[-1]) - len(pair[0])) > 1:
        return False
    return all(sum(numbers) >= 0.5 * len(numbers) for numbers in shares)


def _is_head(row: list[str], width: int) -> bool:
    filled = [cell for cell in row if cell]
    return len(filled) >= max(1, 0.6 * width) and not any(
        text.is_written_number(cell) for cell in filled
    )


def _are_units(row: list[str]) -> bool:
    filled = [cell for cell in row if cell]
    return bool(filled) and all(si_unit(cell) for cell in filled)


def _is_known_unit(word: str) -> bool:
    return force_unit(word) is not None


def _same(first: str, other: str) -> bool:
    known = force_unit(first), force_unit(other)
    return None in known or known[0] == known[1]


def is_workbook(data: bytes) -> bool:
    """True for the bytes of an XLSX or XLS file."""
    return data[:4] in (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")


def workbook_rows(data: bytes, where: str, sheet: str | None, notes: list[str]) -> list[list[str]]:
    """Return the cells of one sheet of an XLSX or XLS file as text.

    By default the first one that holds half as many numbers as any other; which, is noted.
    """
    sheets = workbook_sheets(data, where, sheet)
    counts = {name: sum(map(text.is_written_number, chain(*rows))) for name, rows in sheets.items()}
    most = max(counts.values())
    name = next(name for name, count in counts.items() if 2 * count >= most)
    if len(sheets) > 1:
        notes.append(Message('sheet "{name}" of {sheets}', name=name, sheets=", ".join(sheets)))
    return sheets[name]


def workbook_sheets(
    data: bytes, where: str, sheet: str | None = None
) -> dict[str, list[list[str]]]:
    """Return the cells of each sheet of an XLSX or XLS file, or of ``sheet`` alone, as text.

    Empty rows at the end of a sheet are left out.
    """
    read = _xlsx if data[:4] == b"PK\x03\x04" else _xls
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # styles and extensions that do not matter here
            sheets = read(data, where, sheet)
    except DataError:
        raise
    except Exception as error:  # both packages raise whatever their parsers meet
        raise DataError(
            "the workbook is damaged", where=where, remedy="Save it again, or export it as CSV"
        ) from error
    for rows in sheets.values():
        while rows and not any(rows[-1]):
            rows.pop()
    return sheets


def _xlsx(data: bytes, where: str, sheet: str | None) -> dict[str, list[list[str]]]:
    from openpyxl import load_workbook

    book = load_workbook(BytesIO(data), read_only=True, data_only=True)
    names = _choose_sheets([worksheet.title for worksheet in book.worksheets], sheet, where)
    return {name: _texts(book[name].iter_rows(values_only=True), where) for name in names}


def _xls(data: bytes, where: str, sheet: str | None) -> dict[str, list[list[str]]]:
    import xlrd

    book = xlrd.open_workbook(file_contents=data, on_demand=True, logfile=io.StringIO())
    tables = (book.sheet_by_name(name) for name in _choose_sheets(book.sheet_names(), sheet, where))
    return {
        table.name: _texts((table.row_values(i) for i in range(table.nrows)), where)
        for table in tables
    }


def _choose_sheets(names: Sequence[str], sheet: str | None, where: str) -> Sequence[str]:
    """Return the sheet asked for, or all of them."""
    if not names:
        raise DataError("the workbook has no sheet", where=where)
    if sheet is not None and sheet not in names:
        raise DataError(
            Message('no sheet named "{sheet}"', sheet=sheet), where=where, allowed=", ".join(names)
        )
    return names if sheet is None else [sheet]


def _texts(rows: Iterable[Sequence[object]], where: str) -> list[list[str]]:
    texts: list[list[str]] = []
    cells = 0
    for row in rows:
        cells += len(row)
        if cells > _MOST_CELLS:
            raise DataError("the sheet is larger than any recording", where=where)
        texts.append(["" if cell is None else _cell_text(cell) for cell in row])
    return texts


def _cell_text(cell: object) -> str:
    """Text of a cell; a number with a last zero, so that its point marks no thousands."""
    text = str(cell).strip()
    return f"{text}0" if isinstance(cell, float) and "." in text and "e" not in text else text
