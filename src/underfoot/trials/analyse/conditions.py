"""What a laboratory noted about its files: a table with a column "file"."""

from __future__ import annotations

import csv
import io
import warnings
from pathlib import Path
from typing import Any

from underfoot.core import DataError, InputError, MissingExtraError, units, unknown_name

from ..readers.text import decoded, is_number, name_and_unit
from ..readers.unit_factors import si_unit

NAMES = ("conditions.csv", "conditions.xlsx")


def conditions_of(folder: Path, given: Path | None = None) -> dict[str, dict[str, Any]]:
    """Return the noted conditions by file name: numbers in SI where a unit is written, else text.

    The first line holds the headings, with units in brackets: ``file, shoe, viscosity (cP)``. A
    column counts as numbers when all its filled cells are numbers.

    Parameters
    ----------
    folder
        Searched for ``conditions.csv`` or ``conditions.xlsx`` when ``given`` is None.

    Errors
    ------
    InputError
        The table has no column "file", names a file twice, or can't be read.
    """
    path = given
    if path is None:
        path = next((folder / name for name in NAMES if (folder / name).is_file()), None)
    if path is None:
        return {}
    rows = [row for row in _rows(path) if any(cell for cell in row)]
    heads = [name_and_unit(cell) for cell in rows[0]] if rows else []
    names = [name.casefold() for name, _ in heads]
    if "file" not in names:
        raise InputError(
            'the table of conditions has no column "file"',
            where=path.name,
            allowed=", ".join(names) or "headings in the first line",
        )
    columns = {
        name: _column([row[i] if i < len(row) else "" for row in rows[1:]], unit, path.name, name)
        for i, (name, (_, unit)) in enumerate(zip(names, heads, strict=True))
        if name and name != "file"
    }
    found: dict[str, dict[str, Any]] = {}
    at = names.index("file")
    for number, row in enumerate(rows[1:]):
        file = row[at] if at < len(row) else ""
        if not file:
            continue
        if file in found:
            raise InputError(f'"{file}" is named twice', where=path.name)
        found[file] = {n: c[number] for n, c in columns.items() if c[number] not in ("", None)}
    return found


EVENTS = ("heel contact", "toe off")


def edits_of(folder: Path) -> dict[str, list[tuple[str, float, str]]]:
    """Return the events to be set by hand, by file: (event, time in s, why).

    Read from ``edits.csv`` (or ``.xlsx``) with the columns file, event, time (s), why. Every edit
    needs its reason: it goes to the edit log of the report.

    Errors
    ------
    InputError
        A column missing, an unknown event, a time that is no number, or no reason.
    """
    path = next((folder / n for n in ("edits.csv", "edits.xlsx") if (folder / n).is_file()), None)
    if path is None:
        return {}
    rows = [row for row in _rows(path) if any(row)]
    heads = [name_and_unit(cell) for cell in rows[0]] if rows else []
    names = [name.casefold() for name, _ in heads]
    for needed in ("file", "event", "time", "why"):
        if needed not in names:
            raise InputError(f'the edits have no column "{needed}"', where=path.name)
    at = {name: names.index(name) for name in ("file", "event", "time", "why")}
    factor, _ = _to_si(heads[at["time"]][1], f"{path.name}, column time")
    found: dict[str, list[tuple[str, float, str]]] = {}
    for number, row in enumerate(rows[1:], start=2):
        cells = {name: row[i] if i < len(row) else "" for name, i in at.items()}
        where = f"{path.name}, line {number}"
        event, time = cells["event"].casefold(), cells["time"].replace(",", ".")
        if event not in EVENTS:
            raise unknown_name("event", cells["event"], EVENTS, where=where)
        if not is_number(time):
            raise InputError(f'the time "{cells["time"]}" is no number', where=where)
        if not cells["why"]:
            raise InputError("an event set by hand needs its reason", where=where)
        found.setdefault(cells["file"], []).append((event, float(time) * factor, cells["why"]))
    return found


def _rows(path: Path) -> list[list[str]]:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"can't be read: {error.strerror or error}", where=str(path)) from error
    if data[:4] == b"PK\x03\x04":
        return _xlsx_rows(data, path.name)
    try:
        text = decoded(data, path.name)
    except DataError as error:
        raise InputError(error.what, where=path.name) from error
    first = text.split("\n", 1)[0]
    delimiter = max(",;\t", key=first.count)
    lines = csv.reader(io.StringIO(text), delimiter=delimiter)
    return [[cell.strip() for cell in row] for row in lines]


def _xlsx_rows(data: bytes, where: str) -> list[list[str]]:
    try:
        import openpyxl
    except ImportError as error:
        raise MissingExtraError("openpyxl", "trials", "reading a spreadsheet") from error
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            book = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
            rows = list(book.worksheets[0].iter_rows(values_only=True))
    except Exception as error:
        raise InputError(f"is no spreadsheet ({error})", where=where) from error
    return [["" if cell is None else str(cell).strip() for cell in row] for row in rows]


def _column(cells: list[str], unit: str, where: str, name: str) -> list[Any]:
    plain = [cell.replace(",", ".") if cell.count(",") == 1 else cell for cell in cells]
    if not any(plain) or not all(is_number(cell) for cell in plain if cell):
        return list(cells)
    factor, offset = _to_si(unit, f"{where}, column {name}")
    return [float(cell) * factor + offset if cell else None for cell in plain]


def _to_si(unit: str, where: str) -> tuple[float, float]:
    """Return factor and offset of a unit written in a heading; none leaves numbers as they are."""
    if not unit:
        return 1.0, 0.0
    known = si_unit(unit)
    # "g" is a force in tribometer logs and a mass here.
    if known and unit not in ("g", "mN", "MN"):
        return known[1], known[2]
    return units.to_si(f"1 {unit}", units.si_unit(f"1 {unit}", where=where), where=where), 0.0
