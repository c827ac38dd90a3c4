"""Text measurement files: encoding, delimiter, decimal sign, units, tables with holes."""

import math
import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from underfoot.core import DataError
from underfoot.core.numbers_text import NumberForm, any_lost, number_forms
from underfoot.core.remark import Message
from underfoot.core.text import cells_of
from underfoot.core.typed import MINUS

_WITH_UNIT = re.compile(r"^(.*?\S)\s*[(\[]([^()\[\]]*)[)\]]$")
_BEHIND = re.compile(
    r"^(?P<name>.*?\S)(?:(?:\s*/\s*|,\s*|\s+in\s+)(?P<unit>[^\s/,_]+)"
    r"|_(?P<short>k?N|m?s|[cm]m|Nm|Nmm|lbf|kgf))$"
)
_BEHIND_UNITS = ("N", "N*m", "s", "m", "Pa", "V")
NOTHING = ("nan", "na", "n/a", "-", "--", "null", "none", "#n/a")
_NUMBER = re.compile(r"^\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?\s*$")
_CLOCK = re.compile(
    r"(?:[\d./-]{6,10}[T ]+)?(?P<h>\d{1,2}):(?P<m>[0-5]\d):(?P<s>[0-5]\d)(?:[.,:](?P<part>\d+))?"
    r" ?(?P<half>[ap]m)?(?:Z|[+-]\d\d:?\d\d)?",
    re.IGNORECASE,
)
_WRITTEN = re.compile(
    rf"[+{re.escape(MINUS)}]?[.,]?\d(?:[\d.,]|['’\s](?=\d))*(?:[eEdD][+{re.escape(MINUS)}]?\d+)?"
)


def lines_of(text: str) -> list[str]:
    """Return the lines without line ends; only CR and LF count as ends.

    Of a text in which every second line is empty (ends written twice) the others.
    """
    lines = text.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    twice = len(lines) > 4 and not any(map(str.strip, lines[1::2]))
    return lines[::2] if twice else lines


def is_number(cell: str) -> bool:
    """True when a cell is a plain number with a decimal point."""
    return bool(_NUMBER.match(cell))


def is_written_number(cell: str) -> bool:
    """True when a cell can be a number in some way of writing: "1,075", "1.075,5", "1'075"."""
    return bool(_WRITTEN.fullmatch(cell))


def name_and_unit(label: str) -> tuple[str, str]:
    """Return name and unit of a heading; the unit may be empty.

    "Fx (N)", "Fx [N]"; with a unit that is known also "Fx / N", "Fx, N", "Fx in N", "Fx_N".
    """
    match = _WITH_UNIT.match(label.strip())
    if match:
        return match[1].strip(), match[2].strip()
    match = _BEHIND.match(label.strip())
    unit = (match["unit"] or match["short"]) if match else ""
    if match and (force_unit(unit) or ("",))[0] in _BEHIND_UNITS:
        return match["name"].strip(), unit
    return label.strip(), ""


def delimiter_of(lines: Sequence[str]) -> str:
    """Return the delimiter (tab, semicolon, bar, comma or blank ``""``) that divides most lines."""
    sample = [line for line in lines if line.strip()][:60]
    for candidate in ("\t", ";", "|", ","):
        if sum(candidate in line for line in sample) > 0.5 * len(sample):
            return candidate
    return ""


def split(line: str, delimiter: str) -> list[str]:
    """Return the cells of a line, quotes and blanks around them removed."""
    return cells_of(line, delimiter or None)


def truncation_error(what: str, where: str) -> DataError:
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
    values = plain_numbers(rows, delimiter, notes)
    if values is None or values.shape[1] != columns:
        cells = [split(row, delimiter) for row in rows]
        check_rows(cells, columns, first_line, where)
        forms = written_forms(cells, columns, where, notes)
        values = np.full((len(rows), columns), np.nan)
        for i, row in enumerate(cells):
            for j, cell in enumerate(row[:columns]):
                if cell and j not in ignored:
                    values[i, j] = _number(cell, forms[j], where, first_line + i)
        counts = [min(len(row), columns) for row in cells]
        uneven = sum(count != max(counts) for count in counts)
        if uneven:
            notes.append(
                Message(
                    "{count} rows are shorter than the others: the missing cells have no value",
                    count=uneven,
                )
            )
    values = measurable(values, notes)
    if not np.isfinite(values).any():
        raise DataError("the table holds no number", where=where)
    return values


def written_forms(
    cells: Sequence[Sequence[str]], width: int, where: str, notes: list[str]
) -> list[NumberForm]:
    """Return how the numbers of each of ``width`` columns are written; what is odd is noted."""
    forms = number_forms([[row[i] for row in cells if i < len(row)] for i in range(width)], where)
    if any(form.decimal == "," for form in forms):
        notes.append(_COMMAS)
    if any(form.thousands for form in forms):
        notes.append("signs between thousands")
    return forms


def check_rows(rows: Sequence[Sequence[str]], width: int, first_line: int, where: str) -> None:
    """Refuse rows with more cells than the header, and a last row shorter than all others."""
    for i, row in enumerate(rows):
        if len(row) > width and any(row[width:]):
            raise DataError(
                Message(
                    "row {row} of the table has {count} cells, the header {width}",
                    row=i + 1,
                    count=len(row),
                    width=width,
                ),
                where=line_of(where, first_line + i),
            )
    lengths = [min(len(row), width) for row in rows]
    if len(rows) > 1 and lengths[-1] < min(lengths[:-1]):
        words = "truncated: the last row is shorter than the others"
        raise truncation_error(words, line_of(where, first_line + len(rows) - 1))


def line_of(file: str, line: int) -> Message:
    """Return a line of a file as the place of an error."""
    return Message("{file}, line {line}", file=file, line=line)


def measurable(values: np.ndarray, notes: list[str]) -> np.ndarray:
    """Return the values with infinite and impossibly large ones (above 1e30) as NaN, and say so."""
    absurd = ~(np.abs(values) < 1e30) & ~np.isnan(values)
    if absurd.any():
        notes.append(
            Message(
                "{count} infinite or impossibly large numbers are left out", count=int(absurd.sum())
            )
        )
        values = np.where(absurd, np.nan, values)
    return values


_COMMAS = "decimal commas"


def plain_numbers(rows: Sequence[str], delimiter: str, notes: list[str]) -> np.ndarray | None:
    """Return the numbers of a table that holds nothing else, or None.

    Decimal commas are understood, where nothing but a comma can be the decimal sign. None as well
    where a mark may stand between thousands: ``written_forms`` tells.
    """
    values = _load_numbers(rows, delimiter)
    comma = values is None and delimiter != "," and not any("." in row for row in rows)
    if comma:
        values = _load_numbers([row.replace(",", ".") for row in rows], delimiter)
    if values is None:
        return None
    broken = np.abs(values[np.isfinite(values) & (values != np.round(values))])
    thousandths = 1e3 * broken
    three = broken.size and (np.abs(thousandths - np.round(thousandths)) < 1e-6).all()
    if three and (broken >= 1.0).all() and (broken < 1e3).all():
        return None
    if comma:
        notes.append(_COMMAS)
    return values


def _load_numbers(rows: Sequence[str], delimiter: str) -> np.ndarray | None:
    try:
        values = np.loadtxt(rows, delimiter=delimiter or None, ndmin=2, comments=None)
    except (ValueError, OverflowError):
        return None
    return None if not values.all() and any_lost(rows) else values


def _number(cell: str, form: NumberForm, where: str, line: int) -> float:
    try:
        return form.number(cell)
    except ValueError:
        if cell.casefold() in NOTHING:
            return math.nan
        what = Message('"{cell}" is not a number', cell=cell[:40])
        raise DataError(what, where=line_of(where, line)) from None


def number_after(line: str, where: str, delimiter: str = "=") -> float:
    """Return the number behind ``delimiter`` in a header line; a DataError without one."""
    text = line.split(delimiter, 1)[-1].strip().replace(",", ".")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(Message('"{line}" holds no number', line=line.strip()[:60]), where=where)
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
        notes.append(
            Message("duplicate {kind} names, numbered #2, #3 ...: {shown}", kind=kind, shown=shown)
        )
    return list(names)


def clock_time(cell: str) -> float | None:
    """Return the seconds since midnight of "10:15:20.001" behind a date or not, None of others."""
    match = _CLOCK.fullmatch(cell.strip())
    if match is None:
        return None
    hours, minutes, seconds = (int(match[k]) for k in ("h", "m", "s"))
    if match["half"]:
        hours = hours % 12 + 12 * (match["half"].casefold() == "pm")
    return 3600.0 * hours + 60.0 * minutes + seconds + float(f"0.{match['part'] or 0}")


def rate_of(times: np.ndarray, where: str) -> tuple[float, float, np.ndarray | None]:
    """Return (rate, start, times or None) of a time column; times only when unequally spaced.

    Times that are missing, that do not increase or fewer than two are a DataError.
    """
    if len(times) < 2 or not np.isfinite(times).all():
        raise DataError("the time column has holes or fewer than two rows", where=where)
    steps = np.diff(times)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 2
        raise DataError(Message("time does not increase at row {row}", row=row), where=where)
    step = float(np.median(steps))
    # Rounded time stamps differ by one last digit, dropped samples by a whole step.
    mean = float((times[-1] - times[0]) / (len(times) - 1))
    grid = times[0] + mean * np.arange(len(times))
    even = float(np.abs(times - grid).max()) < 0.1 * step
    return (1.0 / mean, float(times[0]), None) if even else (1.0 / step, float(times[0]), times)


def without_restarts(times: np.ndarray) -> tuple[np.ndarray, int]:
    """Return times whose clock begins anew with each step of a machine as one clock, and how often.

    A restart goes back to about the first time of all; other steps backward stay as they are.
    """
    steps = np.diff(times)
    forward = steps[steps > 0]
    usual = float(np.median(forward)) if forward.size else 0.0
    at = np.flatnonzero((steps <= 0) & (times[1:] <= times[0] + 1.5 * usual)) + 1
    if not len(at) or len(at) > 0.1 * len(times):
        return times, 0
    joined = times.copy()
    for index in at:
        joined[index:] += joined[index - 1] + usual - joined[index]
    return joined, len(at)


_GRAVITY = 9.80665
# A table instead of a unit library: files are read by the hundred, and instruments write few units.
# Masses used as forces follow standard gravity.
_POUND = 4.4482216152605  # N
_FORCES = {
    "N": 1.0,
    "kN": 1e3,
    "mN": 1e-3,
    "MN": 1e6,
    "daN": 10.0,
    "dyn": 1e-5,
    "gf": _GRAVITY * 1e-3,
    "kgf": _GRAVITY,
    "lbf": _POUND,
    "ozf": _POUND / 16.0,
    "kip": 1e3 * _POUND,
}
_LENGTHS = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "nm": 1e-9,
    "km": 1e3,
    "in": 0.0254,
    "ft": 0.3048,
    "yd": 0.9144,
}
_MOMENTS = {
    f"{force}*{length}": ours * arm
    for force, ours in _FORCES.items()
    for length, arm in _LENGTHS.items()
}
# One spelling of a unit for each word that instruments write. Plurals are found by their s.
_WORDS: dict[str, str] = {
    word: unit
    for unit, words in {
        "N": "newton",
        "kN": "kilonewton",
        "daN": "dan decanewton dekanewton",
        "dyn": "dyne",
        "kgf": "kp kilopond kilogram-force kilogramforce kgforce",
        "gf": "g pond gram-force gramforce",
        "lbf": "pound-force poundforce",
        "m": "meter metre",
        "dm": "decimeter decimetre dezimeter",
        "cm": "centimeter centimetre zentimeter",
        "mm": "millimeter millimetre",
        "um": "micron micrometer micrometre mikrometer",
        "nm": "nanometer nanometre",
        "km": "kilometer kilometre",
        "in": 'inch inche zoll "',
        "ft": "foot feet fuss '",
        "yd": "yard",
        "s": "sec second sekunde",
        "ms": "msec millisec millisecond millisekunde",
        "us": "usec microsecond",
        "min": "minute",
        "h": "hr hour std stunde",
        "m/s": "m/sec meter/s meter/sec",
        "mm/s": "mm/sec",
        "cm/s": "cm/sec",
        "in/s": "in/sec inch/s ips",
        "ft/s": "ft/sec fps",
        "ft/min": "fpm",
        "Pa": "pascal",
        "kPa": "kilopascal",
        "deg": "degree grad",
        "rad": "radian",
        "rpm": "r/min rev/min u/min 1/min",
        "Hz": "hertz",
        "V": "volt",
    }.items()
    for word in words.split()
}
_WEIGHTS = {
    word: unit
    for unit, words in {
        "kgf": "kg kilo kilogram kilogramme",
        "gf": "g gram gramme",
        "lbf": "lb lbm pound",
        "ozf": "oz ounce",
    }.items()
    for word in words.split()
}
"""Units of mass that stand for their weight where a force is measured."""
_FACTORS: dict[str, tuple[str, float]] = {
    name: (si, factor)
    for si, units in {
        "N": _FORCES,
        "m": _LENGTHS,
        "N*m": _MOMENTS,
        "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
        "m/s": {
            "m/s": 1.0,
            "mm/s": 1e-3,
            "cm/s": 1e-2,
            "um/s": 1e-6,
            "km/h": 1.0 / 3.6,
            "m/min": 1.0 / 60.0,
            "in/s": 0.0254,
            "ft/s": 0.3048,
            "ft/min": 0.3048 / 60.0,
        },
        "Pa": {
            "Pa": 1.0,
            "kPa": 1e3,
            "MPa": 1e6,
            "mPa": 1e-3,
            "GPa": 1e9,
            "hPa": 1e2,
            "bar": 1e5,
            "mbar": 1e2,
            "psi": 6894.757293168361,
            "N/mm2": 1e6,
            "N/cm2": 1e4,
            "N/m2": 1.0,
        },
        "rad": {"deg": math.pi / 180.0, "rad": 1.0, "mrad": 1e-3},
        "rad/s": {"rpm": math.pi / 30.0, "rad/s": 1.0, "deg/s": math.pi / 180.0},
        "Hz": {"Hz": 1.0, "kHz": 1e3},
        "V": {"V": 1.0, "mV": 1e-3},
        "1": {"%": 1e-2, "-": 1.0, "1": 1.0},
        "K": {"K": 1.0},
    }.items()
    for name, factor in units.items()
}
# Without regard to capitals, but where they decide between two units (mN and MN).
_ANY_CASE: dict[str, str] = {}
for _name in (*_FACTORS, *_WORDS, *_WEIGHTS):
    _ANY_CASE.setdefault(_name.casefold(), _name)
_ANY_CASE |= {"mn": "mN", "mpa": "MPa", "nm": "N*m", "mn*m": "mN*m"}
_CELSIUS = {"degc", "c", "deg c", "celsius", "degcelsius", "gradcelsius"}
_SUFFIXES = re.compile(r"[\s*·⋅×x.-]+")


def si_unit(text: str) -> tuple[str, float, float] | None:
    """Return (SI unit, factor, offset) of a unit as written in a file, or None if unknown.

    ``si = factor * value + offset``. A mass is no unit of a recording but as a force
    (``force_unit``).
    """
    plain = text.strip().strip("[](){}").strip().replace("µ", "u").replace("μ", "u")
    plain = plain.replace("°", "deg").replace("Â", "").replace("−", "-").replace("²", "2")
    plain = plain.replace("^", "")
    if plain.casefold().replace(" ", "") in _CELSIUS:
        return "K", 1.0, 273.15
    name = _unit_name(plain)
    if name in _WEIGHTS:
        return None
    if name is None:  # a moment: a force and an arm, in either order, with any sign between
        parts = [part for part in _SUFFIXES.split(plain) if part]
        names = [_WEIGHTS.get(n := _unit_name(part) or "", n) for part in parts]
        if len(parts) == 1:
            names = _glued_units(plain)
        if len(names) == 2:
            name = next(
                (f"{a}*{b}" for a, b in (names, names[::-1]) if f"{a}*{b}" in _MOMENTS), None
            )
    return None if name is None else (*_FACTORS[name], 0.0)


def _unit_name(word: str) -> str | None:
    """The one spelling of a unit: as it stands, in other capitals, a word, its plural."""
    for plain in (word, word.replace(" ", "").replace(".", "")):
        for one in (plain, re.sub("[sS]$", "", plain) if len(plain) > 2 else plain):
            known = one in _FACTORS or one in _WORDS or one in _WEIGHTS
            found = one if known else _ANY_CASE.get(one.casefold())
            if found is not None:
                return _WORDS.get(found, found)
    return None


def force_unit(text: str) -> tuple[str, float, float] | None:
    """Return what ``si_unit`` does of the unit of a force; a mass ("kg", "lb") is its weight."""
    name = _unit_name(text.strip().strip("[](){}").strip())
    return ("N", _FORCES[_WEIGHTS[name]], 0.0) if name in _WEIGHTS else si_unit(text)


def _glued_units(word: str) -> list[str]:
    """Force and arm of a moment written as one word: Nmm, kNm, lbft, kgfcm, inlbf."""
    parts = ((word[:i], word[i:]) for i in range(len(word) - 1, 0, -1))
    pairs = ([_WEIGHTS.get(n := _unit_name(p) or "", n) for p in two] for two in parts)
    return next(
        (p for p in pairs if f"{p[0]}*{p[1]}" in _MOMENTS or f"{p[1]}*{p[0]}" in _MOMENTS), []
    )


def in_si(text: str) -> tuple[str, float, float]:
    """Return what ``si_unit`` does; an unknown unit is empty and keeps the numbers."""
    return si_unit(text) or ("", 1.0, 0.0)


def known_units(dimension: str = "") -> list[str]:
    """Return the spellings understood, for messages; of one dimension ("m", "N") where told."""
    known = {**_FACTORS, "degC": ("K", 1.0)}
    return sorted(name for name, (si, _) in known.items() if dimension in ("", si))
