"""Text tables of instruments: separators, decimal commas, unit rows, what is missing."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from underfoot.core import DataError, InputError, nearest_match, to_si

_NUMBER = re.compile(r"^[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?$")
_HEAD = re.compile(r"^\s*(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]\s*$")
_MISSING = {"", "nan", "na", "n/a", "null", "none", "-", "--", "#n/a"}


@dataclass(frozen=True, slots=True)
class TestTable:
    """Columns by name as printed, their units ("" where not given) and where they came from."""

    columns: dict[str, np.ndarray]
    units: dict[str, str]
    where: str
    first_row: int
    notes: tuple[str, ...]

    def column(
        self, aliases: Sequence[str], unit: str, units: Mapping[str, str], what: str
    ) -> np.ndarray | None:
        """Return the column that has one of the ``aliases``, in SI ``unit``; None if none has.

        ``units`` gives units by column name where the file has none, or other ones.
        """
        name = self.named(aliases)
        if name is None:
            return None
        unit_text = units.get(name) or units.get(what) or self.units[name]
        values = self.columns[name]
        self._refuse_missing(name, values)
        return in_si(values, unit_text, unit, where=f"{self.where}, column {name}")

    def named(self, aliases: Sequence[str]) -> str | None:
        """Return the heading that is one of ``aliases``; case counts only for short symbols.

        t is a time and T a temperature, but "Time" and "TIME" are the same.
        """
        for alias in aliases:
            for name in self.columns:
                same = name.casefold() == alias.casefold() if len(alias) > 2 else name == alias
                if same:
                    return name
        return None

    def required(
        self, aliases: Sequence[str], unit: str, units: Mapping[str, str], what: str
    ) -> np.ndarray:
        """Return ``column``; refuse the file when there is none."""
        values = self.column(aliases, unit, units, what)
        if values is None:
            raise DataError(
                f"no column for {what} among {', '.join(self.columns)}",
                where=self.where,
                allowed=f"one named {', '.join(aliases[:6])}",
                nearest=next(
                    (n for n in (nearest_match(c, aliases) for c in self.columns) if n), None
                ),
            )
        return values

    def _refuse_missing(self, name: str, values: np.ndarray) -> None:
        missing = np.flatnonzero(~np.isfinite(values))
        if missing.size:
            raise DataError(
                f"{missing.size} of {values.size} values are missing in the column {name}, the "
                f"first in line {self.first_row + missing[0]}",
                where=self.where,
                remedy="Remove the rows, or repair them at their source",
            )


def in_si(values: np.ndarray, unit_text: str, unit: str, *, where: str) -> np.ndarray:
    """Return values in the SI ``unit``; refuse a missing or wrong unit."""
    if unit_text.strip() in ("", "-"):
        raise DataError(
            "no unit is unit_text",
            where=where,
            allowed=f"a unit of {unit} in the heading, in a row below it, or as an argument",
        )
    text = unit_text.strip().replace("°C", "degC")
    if unit == "rad/s" and text.casefold() in ("hz", "khz", "1/s"):
        factor = 2.0 * np.pi * (1e3 if text.casefold() == "khz" else 1.0)
        return values * factor
    try:
        zero = to_si(f"0 {text}", unit, where=where)
        one = to_si(f"1 {text}", unit, where=where)
    except InputError as error:
        raise DataError(
            error.what, where=where, allowed=error.allowed, nearest=error.nearest
        ) from error
    return values * (one - zero) + zero


def read_table(path: Path | str) -> TestTable:
    """Return the first table of a text file with one row of headings.

    Separators may be comma, semicolon, tab or blanks; decimal commas are read where commas do
    not separate; a row of units may follow the headings, or units stand in brackets there.

    Raises:
        DataError: No headings, no numbers, rows of different length, text among the numbers.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError("there is no such file", where=str(path))
    raw = path.read_bytes()
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip()]
    lines = [(i, line) for i, line in lines if not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise DataError("the file holds no table", where=str(path), allowed="headings and rows")
    separator = next((s for s in (";", "\t", ",") if s in lines[0][1]), None)
    rows = [(i, _cells(line, separator)) for i, line in lines]
    names, units, body = _headings(rows, path)
    notes: list[str] = []
    decimal_comma = separator != "," and any("," in cell for _, row in body for cell in row)
    if decimal_comma:
        notes.append("decimal commas read as decimal points")
    columns = np.empty((len(body), len(names)))
    for place, (i, row) in enumerate(body):
        if len(row) != len(names):
            hint = None
            if separator == "," and len(row) in (2 * len(names), 2 * len(names) - 1):
                hint = "Commas seem to be both separator and decimal sign: export with semicolons"
            raise DataError(
                f"line {i} has {len(row)} values for {len(names)} headings",
                where=str(path),
                remedy=hint,
            )
        columns[place] = [_number(cell, decimal_comma, i, path) for cell in row]
    return TestTable(
        {name: columns[:, k] for k, name in enumerate(names)},
        dict(zip(names, units, strict=True)),
        str(path),
        body[0][0],
        tuple(notes),
    )


def _headings(
    rows: list[tuple[int, list[str]]], path: Path
) -> tuple[list[str], list[str], list[tuple[int, list[str]]]]:
    heads = rows[0][1]
    if all(_NUMBER.match(cell) for cell in heads if cell):
        raise DataError(
            "the first line holds numbers and no headings",
            where=str(path),
            remedy="Name the columns with their units, for example: f (Hz), E_stor (MPa)",
        )
    body = rows[1:]
    while len(heads) > 1 and heads[-1] == "" and all(row[-1] == "" for _, row in body):
        heads = heads[:-1]
        body = [(i, row[:-1]) for i, row in body]
    matched = [_HEAD.match(head) for head in heads]
    names = [m.group(1) if m else head for m, head in zip(matched, heads, strict=True)]
    units = [m.group(2) if m else "" for m in matched]
    if len(set(names)) < len(names):
        raise DataError(f"a heading occurs twice: {', '.join(names)}", where=str(path))
    second = body[0][1]
    if not any(_NUMBER.match(cell) for cell in second):
        if len(second) == len(names):
            units = [u or cell for u, cell in zip(units, second, strict=True)]
        body = body[1:]
    if not body:
        raise DataError("there are headings but no numbers", where=str(path))
    return names, units, body


def _cells(line: str, separator: str | None) -> list[str]:
    cells = line.split() if separator is None else line.split(separator)
    return [cell.strip().strip('"') for cell in cells]


def _number(cell: str, decimal_comma: bool, line: int, path: Path) -> float:
    if cell.casefold() in _MISSING:
        return np.nan
    text = cell.replace(",", ".") if decimal_comma else cell
    try:
        return float(text)
    except ValueError:
        raise DataError(
            f'"{cell}" in line {line} is not a number', where=str(path), allowed="numbers"
        ) from None
