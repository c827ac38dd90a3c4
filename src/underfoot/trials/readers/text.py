"""Text measurement files: encoding, delimiter, decimal sign, units, tables with holes."""

import math
import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from underfoot.core import DataError

_COMMA_NUMBER = re.compile(r"(?<![\d.,])[+-]?\d+,\d+(?:[eE][+-]?\d+)?(?![\d.,])")
_WITH_UNIT = re.compile(r"^(.*?\S)\s*[(\[]([^()\[\]]*)[)\]]$")
NOTHING = ("nan", "na", "n/a", "-", "--", "null", "none", "#n/a")
_NUMBER = re.compile(r"^\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?\s*$")


def lines_of(text: str) -> list[str]:
    """Return the lines without line ends; only CR and LF count as ends."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def is_number(cell: str) -> bool:
    """True when a cell is a plain number with a decimal point."""
    return bool(_NUMBER.match(cell))


def name_and_unit(label: str) -> tuple[str, str]:
    """Return the name and the unit in ``"Fx (N)"`` or ``"Fx [N]"``; the unit may be empty."""
    match = _WITH_UNIT.match(label.strip())
    return (match[1].strip(), match[2].strip()) if match else (label.strip(), "")


def delimiter_of(lines: Sequence[str]) -> str:
    """Return the delimiter (tab, semicolon, comma or blank ``""``) that divides most lines."""
    sample = [line for line in lines if line.strip()][:60]
    for candidate in ("\t", ";", ","):
        if sum(candidate in line for line in sample) > 0.5 * len(sample):
            return candidate
    return ""


def split(line: str, delimiter: str) -> list[str]:
    """Return the cells of a line, quotes and blanks around them removed."""
    cells = line.split(delimiter) if delimiter else line.split()
    return [cell.strip().strip('"').strip() for cell in cells]


def uses_decimal_comma(lines: Sequence[str], delimiter: str) -> bool:
    """True when numbers are written with a comma (never when the comma is the delimiter)."""
    if delimiter == ",":
        return False
    return any(_COMMA_NUMBER.search(line) for line in lines[:50])


def truncated(what: str, where: str) -> DataError:
    """Return the error for a file that holds less, or more, than it should."""
    return DataError(what, where=where, remedy="Export or copy the file again")


def table(
    lines: Sequence[str],
    delimiter: str,
    columns: int,
    where: str,
    notes: list[str],
    first_line: int = 1,
    ignored: frozenset[int] = frozenset(),
) -> np.ndarray:
    """Return the numbers (rows, columns) of a table; what is odd about it is added to ``notes``.

    Empty cells become NaN, decimal commas are understood, short rows are filled with NaN;
    ``ignored`` columns hold text and become NaN. A cell that is no number, a row longer than the
    header and a table without rows are DataErrors.
    """
    rows = [line for line in lines if line.strip(" \t;,")]
    if not rows:
        raise DataError("the table has no rows", where=where)
    if uses_decimal_comma(rows, delimiter):
        rows = [row.replace(",", ".") for row in rows]
        notes.append("decimal commas")
    values = plain_numbers(rows, delimiter)
    if values is None or values.shape[1] != columns:
        cells = [split(row, delimiter) for row in rows]
        check_rows(cells, columns, first_line, where)
        values = np.full((len(rows), columns), np.nan)
        for i, row in enumerate(cells):
            for j, cell in enumerate(row[:columns]):
                if cell and j not in ignored:
                    values[i, j] = _number(cell, f"{where}, line {first_line + i}")
        counts = [min(len(row), columns) for row in cells]
        uneven = sum(count != max(counts) for count in counts)
        if uneven:
            notes.append(
                f"{uneven} rows are shorter than the others: the missing cells have no value"
            )
    values = measurable(values, notes)
    if not np.isfinite(values).any():
        raise DataError("the table holds no number", where=where)
    return values


def check_rows(rows: Sequence[Sequence[str]], width: int, first_line: int, where: str) -> None:
    """Refuse rows with more cells than the header, and a last row shorter than all others."""
    for i, row in enumerate(rows):
        if len(row) > width and any(row[width:]):
            raise DataError(
                f"row {i + 1} of the table has {len(row)} cells, the header {width}",
                where=f"{where}, line {first_line + i}",
            )
    lengths = [min(len(row), width) for row in rows]
    if len(rows) > 1 and lengths[-1] < min(lengths[:-1]):
        words = "truncated: the last row is shorter than the others"
        raise truncated(words, f"{where}, line {first_line + len(rows) - 1}")


def measurable(values: np.ndarray, notes: list[str]) -> np.ndarray:
    """Return the values with infinite and impossibly large ones (above 1e30) as NaN, and say so."""
    absurd = ~(np.abs(values) < 1e30) & ~np.isnan(values)
    if absurd.any():
        notes.append(f"{int(absurd.sum())} infinite or impossibly large numbers are left out")
        values = np.where(absurd, np.nan, values)
    return values


def plain_numbers(rows: Sequence[str], delimiter: str) -> np.ndarray | None:
    """Return the numbers of a table that holds nothing else, or None."""
    try:
        return np.loadtxt(rows, delimiter=delimiter or None, ndmin=2, comments=None)
    except (ValueError, OverflowError):
        return None


def _number(cell: str, where: str) -> float:
    try:
        return float(cell)
    except ValueError:
        if cell.casefold() in NOTHING:
            return math.nan
        raise DataError(f'"{cell[:40]}" is not a number', where=where) from None


def number_after(line: str, where: str, delimiter: str = "=") -> float:
    """Return the number behind ``delimiter`` in a header line; a DataError without one."""
    text = line.split(delimiter, 1)[-1].strip().replace(",", ".")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f'"{line.strip()[:60]}" holds no number', where=where)
    return value


def unique_names(labels: Sequence[str], kind: str, notes: list[str]) -> list[str]:
    """Return the labels made unique (``name #2``); unnamed ones are numbered."""
    seen: Counter[str] = Counter()
    names: dict[str, None] = {}
    for i, label in enumerate(labels):
        base = label.strip() or f"{kind} {i + 1}"
        seen[base] += 1
        while (name := f"{base} #{seen[base]}" if seen[base] > 1 else base) in names:
            seen[base] += 1
        names[name] = None
    repeated = [name for name, count in seen.items() if count > 1]
    if repeated:
        shown = ", ".join(repeated[:5]) + (" ..." if len(repeated) > 5 else "")
        notes.append(f"duplicate {kind} names, numbered #2, #3 ...: {shown}")
    return list(names)


def rate_of(times: np.ndarray, where: str) -> tuple[float, float, np.ndarray | None]:
    """Return (rate, start, times or None) of a time column; times only when unequally spaced.

    Times that are missing, that do not increase or fewer than two are a DataError.
    """
    if len(times) < 2 or not np.isfinite(times).all():
        raise DataError("the time column has holes or fewer than two rows", where=where)
    steps = np.diff(times)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 2
        raise DataError(f"time does not increase at row {row}", where=where)
    step = float(np.median(steps))
    # Rounded time stamps differ by one last digit, dropped samples by a whole step.
    mean = float((times[-1] - times[0]) / (len(times) - 1))
    grid = times[0] + mean * np.arange(len(times))
    even = float(np.abs(times - grid).max()) < 0.1 * step
    return (1.0 / mean, float(times[0]), None) if even else (1.0 / step, float(times[0]), times)


_GRAVITY = 9.80665
# A table instead of a unit library: files are read by the hundred, and instruments write few units.
# Masses used as forces follow standard gravity.
_FACTORS: dict[str, tuple[str, float]] = {
    name: (si, factor)
    for si, spellings in {
        "N": {
            "n newton newtons": 1.0, "kn": 1e3, "mn": 1e-3, "g gf": _GRAVITY * 1e-3,
            "kgf": _GRAVITY, "lbf": 4.4482216152605,
        },
        "N*m": {"nm n*m": 1.0, "nmm n*mm": 1e-3, "ncm": 1e-2},
        "m": {
            "m meter meters": 1.0, "cm": 1e-2, "mm": 1e-3, "um micron": 1e-6, "in inch": 0.0254,
        },
        "s": {
            "s sec second seconds": 1.0, "ms msec": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0,
        },
        "m/s": {"m/s m/sec": 1.0, "mm/s mm/sec": 1e-3, "cm/s": 1e-2},
        "Pa": {
            "pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "bar": 1e5, "mbar": 1e2,
            "psi": 6894.757293168361,
        },
        "rad": {"deg": math.pi / 180.0, "rad": 1.0},
        "rad/s": {"rpm": math.pi / 30.0},
        "Hz": {"hz": 1.0, "khz": 1e3},
        "V": {"v": 1.0, "mv": 1e-3},
        "1": {"%": 1e-2, "-": 1.0, "1": 1.0},
        "K": {"k": 1.0},
    }.items()
    for names, factor in spellings.items()
    for name in names.split()
}  # fmt: skip
# Spellings in which capitals decide between two units.
_EXACT: dict[str, tuple[str, float]] = {
    "MN": ("N", 1e6),
    "nm": ("m", 1e-9),
    "mPa": ("Pa", 1e-3),
    "Nm": ("N*m", 1.0),
    "NM": ("N*m", 1.0),
}
_CELSIUS = {"degc", "c", "deg c", "celsius"}


def si_unit(text: str) -> tuple[str, float, float] | None:
    """Return (SI unit, factor, offset) of a unit as written in a file, or None if unknown.

    ``si = factor * value + offset``.
    """
    plain = text.strip().strip("[]()").replace("µ", "u").replace("μ", "u").replace("°", "deg")
    plain = plain.replace("Â", "").replace("·", "*").replace(".", "*").replace("−", "-")
    if plain in _EXACT:
        return (*_EXACT[plain], 0.0)
    lowered = plain.casefold().replace("^", "").replace(" ", "")
    if lowered in _CELSIUS:
        return "K", 1.0, 273.15
    found = _FACTORS.get(lowered)
    return (*found, 0.0) if found else None


def in_si(text: str) -> tuple[str, float, float]:
    """Return what ``si_unit`` does; an unknown unit is empty and keeps the numbers."""
    return si_unit(text) or ("", 1.0, 0.0)


def known_units() -> list[str]:
    """Return the spellings understood, for messages."""
    return sorted({*_FACTORS, *_EXACT, "degC"})
