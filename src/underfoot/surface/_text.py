"""Numbers and headings of text files."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from underfoot.core import DataError, InputError, to_si

MISSING = {"", "nan", "na", "n/a", "null", "none", "-", "--", "***", "bad", "no data", "1.#qnan"}
_LENGTH = re.compile(
    r"(?<![A-Za-zµμ])(nm|um|µm|μm|micrometers?|micrometres?|microns?|mm|m)(?![A-Za-z])", re.I
)


@dataclass(frozen=True, slots=True)
class TextNumbers:
    """Rows of numbers (missing ones NaN), the lines above them, and how they were read."""

    rows: np.ndarray
    header: tuple[str, ...]
    decimals: tuple[int, ...]
    first_line: int
    notes: tuple[str, ...]
    where: str

    def units(self) -> list[str]:
        """Return the length units of the headings, in order; none where headings name none.

        Only the last two lines above the numbers count, and only if they hold no digits: a line
        such as "Length 12.5 mm" says nothing about the columns.
        """
        for line in reversed(self.header[-2:]):
            units = _LENGTH.findall(line)
            if units and not re.search(r"\d", line):
                return units
        return []


def read_numbers(path: Path | str) -> TextNumbers:
    """Return the numbers of a text file below its header.

    Separators comma, semicolon, tab or blanks; decimal commas where commas do not separate.

    Raises:
        DataError: No such file, a binary file, no numbers, rows of different length.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError("there is no such file", where=str(path))
    raw = path.read_bytes()
    if b"\x00" in raw[:4096]:
        raise DataError(
            "this is a binary file", where=str(path), remedy="Read it as an instrument's format"
        )
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    lines = text.splitlines()
    start = next((i for i, line in enumerate(lines) if _is_row(line)), None)
    if start is None:
        raise DataError("the file holds no rows of numbers", where=str(path))
    header = tuple(line.lstrip("#").strip() for line in lines[:start] if line.strip())
    body = [(i, line) for i, line in enumerate(lines[start:], start + 1) if line.strip()]
    body = [(i, line) for i, line in body if not line.lstrip().startswith("#")]
    separator = _separator([line for _, line in body[:50]])
    comma = separator != "," and any("," in line for _, line in body[:50])
    rows = [_cells(line, separator) for _, line in body]
    while len(rows[0]) > 1 and all(len(row) > 1 and row[-1] == "" for row in rows):
        rows = [row[:-1] for row in rows]  # instruments close their lines with separators
    width = len(rows[0])
    values = np.empty((len(rows), width))
    for k, ((i, _), row) in enumerate(zip(body, rows, strict=True)):
        if len(row) != width:
            raise DataError(
                f"line {i} has {len(row)} values, the first row has {width}",
                where=str(path),
                remedy="Values are missing or a decimal comma is taken for a separator",
            )
        values[k] = [_number(cell, comma, i, path) for cell in row]
    decimals = tuple(
        max(len(row[c].replace(",", ".").partition(".")[2]) for row in rows[:200])
        if not any("e" in row[c].lower() for row in rows[:200])
        else 17
        for c in range(width)
    )
    notes = ("decimal commas read as decimal points",) if comma else ()
    return TextNumbers(values, header, decimals, start + 1, notes, str(path))


def length_factor(unit: str, where: str) -> float:
    """Return metres per ``unit``."""
    text = unit.strip().replace("µ", "u").replace("μ", "u")
    if re.fullmatch(r"micro(n|meter|metre)s?", text, re.I):
        text = "um"
    if text.casefold() in ("um", "nm", "mm"):
        text = text.casefold()
    try:
        return to_si(f"1 {text}", "m", where=where)
    except InputError as error:
        raise DataError(
            error.what,
            where=where,
            allowed="a unit of length: nm, um, mm, m",
            nearest=error.nearest,
        ) from error


def _is_row(line: str) -> bool:
    cells = _cells(line, _separator([line]))
    plain = [cell.replace(",", ".") for cell in cells]
    numbers = 0
    for cell in plain:
        if cell.casefold() in MISSING:
            continue
        try:
            float(cell)
        except ValueError:
            return False
        numbers += 1
    return numbers > 0


def _separator(lines: list[str]) -> str | None:
    joined = "\n".join(lines)
    for candidate in (";", "\t"):
        if candidate in joined:
            return candidate
    if "," not in joined:
        return None
    # Blanks between and commas within numbers: "0,10 1,25" is two numbers with decimal commas.
    between = all(
        re.fullmatch(r"[+-]?\d+(,\d+)?([eE][+-]?\d+)?", cell)
        for line in lines
        for cell in line.split()
    )
    if between and any(len(line.split()) > 1 for line in lines):
        return None
    return ","


def _cells(line: str, separator: str | None) -> list[str]:
    if separator is None:
        return line.split()
    return [cell.strip().strip('"') for cell in line.split(separator)]


def _number(cell: str, comma: bool, line: int, path: Path) -> float:
    if cell.casefold() in MISSING:
        return np.nan
    try:
        return float(cell.replace(",", ".") if comma else cell)
    except ValueError:
        raise DataError(
            f'"{cell}" in line {line} is not a number', where=str(path), allowed="numbers"
        ) from None
