"""Columns of a table of conditions or readings: its cells, units, numbers and levels."""

import csv
import io
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from underfoot.core import DataError, InputError, units
from underfoot.core.numbers_text import NumberForm, column_place, number_forms
from underfoot.core.remark import Message
from underfoot.core.text import decode_text

from ..readers.sheet import is_workbook, workbook_sheets
from ..readers.text import is_number, is_written_number, name_and_unit, si_unit
from ..recording.tester_calibration import written_day

SHEET = "sheet"
MASS = ("mass", "body mass", "weight", "body weight", "masse", "körpermasse", "gewicht",
        "körpergewicht")  # fmt: skip
QUANTITIES = {
    "ptv": ("ptv", "srv", "bpn", "pendulum test value", "pendulum", "pendelwert", "srt-wert",
            "ptv wet", "ptv dry"),
    "angle": ("angle", "ramp angle", "acceptance angle", "angle of slip", "winkel",
              "akzeptanzwinkel", "neigungswinkel"),
    "cof": (
        "cof", "dcof", "scof", "coefficient of friction", "friction", "slip resistance", "mu", "μ",
        "slip index", "reibwert", "reibzahl", "gleitreibwert", "gleitreibungskoeffizient",
        "gleitreibwert μ",
    ),
}  # fmt: skip
LARGEST = {"ptv": 150.0, "angle": 45.0, "cof": 3.0}  # no ramp goes beyond 45 deg
_FRICTIONS = ("acof", "rcof", *QUANTITIES["cof"])
_RANGES = {
    **dict.fromkeys(MASS, (10.0, 300.0, "kg", "(kg), (lb)")),
    **dict.fromkeys(("height", "body height", "körpergröße"), (0.5, 2.5, "m", "(m), (cm)")),
    **dict.fromkeys(_FRICTIONS, (0.0, LARGEST["cof"], "", "(%)")),
    **dict.fromkeys(QUANTITIES["ptv"], (0.0, LARGEST["ptv"], "", "(PTV)")),
}
"""Least and largest number, its unit, and headings with a unit, by the name of a column."""
_COMPUTED = {"viscosity": "(cP)", "thickness": "(mm)", "area": "(mm^2)"}
"""Columns from which numbers are computed, so that a unit decides them; their usual headings."""
_SI_UNITS = {
    **{name: si or "1" for name, (_, _, si, _) in _RANGES.items()},
    "viscosity": "Pa*s",
    "thickness": "m",
    "area": "m^2",
    "speed": "m/s",
    "walking speed": "m/s",
}
"""SI unit of what a column holds by its name: a unit of something else is refused."""
_ANGLES = QUANTITIES["angle"]
_SCALE = re.compile(
    r"(shore|asker)[ -]?(a|am|b|c|d|do|e|m|o|oo|0|00|000)?|irhd|ptv|srv|bpn|hr[a-z]|points?|scores?"
    r"|count|#|no|nr",
    re.IGNORECASE,
)
"""Scales that have no SI unit: their numbers stay as they are."""
_EMPTY = ("", "?", "-", "--", "–", "—", ".", "n/a", "#n/a", "n.a.", "n. a.", "na", "nan", "null",
          "missing", "unknown", "unbekannt", "tbd", "k.a.", "k. a.", "keine angabe",
          "fehlt")  # fmt: skip
_DAYS = re.compile(r"(^|[\W_])(date|day|tag)([\W_]|$)|datum$", re.IGNORECASE)
# Names of conditions that number trials: never factors of a test.
NUMBERS = ("n", "no", "nr", "trial", "number", "rep", "repeat", "repetition", "run", "take")
ORDERS = (*NUMBERS, "order", "sequence", "reihenfolge")
COUNTED = (*ORDERS, "reading", "swing", "test", "value", "pass", "cycle", "messung", "schwung",
           "wert", "versuch", "lauf", "wiederholung")  # fmt: skip
"""Columns that number the readings of a sample."""
_MEASURED = ("age", "alter", "temperature", "temp", "temperatur", "humidity", "feuchte",
             "luftfeuchte", "speed", "walking speed", "geschwindigkeit", "bmi", "size", "shoe size",
             "eu size", "schuhgröße", "years", "experience", "jahre", "falls", "slip", "slipped",
             "fall", "fell", "outcome", "gerutscht", "sturz", "ergebnis")  # fmt: skip
"""Columns whose numbers, equal or not, were measured or seen: their values are no levels."""
MOST_LEVELS = 6
"""Different numbers of a column that may be the codes of levels; assumed."""

TableColumns = tuple[list[tuple[str, str, list[str]]], list[int]]
"""(Heading, unit, cells) of each column of a table, and the line number of each row."""


def table_columns(path: Path, needed: Sequence[str]) -> TableColumns:
    """Return the columns of the one table of a file that has a column ``needed``.

    Where none has, those of the first of ``tables_of``. InputError: two of them have it.
    """
    tables = tables_of(path)
    wanted = [
        name
        for name, (columns, _) in tables.items()
        if any(head.casefold() in needed for head, _, _ in columns)
    ]
    if len(wanted) > 1:
        raise InputError(
            Message(
                "several sheets hold such a table, with other headings: {names}",
                names=", ".join(wanted),
            ),
            where=path.name,
            remedy="Write the same headings in each sheet, or keep one",
        )
    return tables[next(iter([*wanted, *tables]))]


def tables_of(path: Path) -> dict[str, TableColumns]:
    """Return the columns of each table of a file, by the first sheet that it stands in.

    Sheets of a workbook with the same headings are one table, with a column "sheet". Empty lines
    and columns without a heading are left out; the first line holds the headings; cells such as
    "n.a.", "-" and "k.A." are empty. Days in a column that says so ("date", "Datum") are written
    one way (2026-03-05). A row with more cells than headings, and two columns of one name, are an
    `InputError`.
    """
    filled = {
        sheet: [(line, row) for line, row in enumerate(rows, start=1) if any(row)]
        for sheet, rows in _sheets(path).items()
    }
    alike: dict[tuple[str, ...], list[str]] = {}
    for sheet, lines in filled.items():
        if lines or len(filled) == 1:
            alike.setdefault(tuple(lines[0][1]) if lines else (), []).append(sheet)
    return {
        sheets[0]: _columns(list(heads), {sheet: filled[sheet][1:] for sheet in sheets}, path.name)
        for heads, sheets in alike.items()
    } or {"": ([], [])}


def _columns(
    headings: list[str], sheets: Mapping[str, list[tuple[int, list[str]]]], where: str
) -> TableColumns:
    heads = [name_and_unit(cell) for cell in headings]
    lines = [pair for rows in sheets.values() for pair in rows]
    for line, row in lines:
        if any(row[len(heads) :]):
            raise InputError(
                Message(
                    "line {line} has {count} cells, the headings are {width}",
                    line=line,
                    count=len(row),
                    width=len(heads),
                ),
                where=where,
                remedy='A comma within a cell ("0,45") needs quotes, or semicolons between cells',
            )
    folded = [name.casefold() for name, _ in heads if name]
    twice = next((name for name in folded if folded.count(name) > 1), "")
    if twice:
        raise InputError(Message('two columns are called "{twice}"', twice=twice), where=where)
    columns = [
        (
            name,
            unit,
            [
                _cell(row[i], days=bool(_DAYS.search(name))) if i < len(row) else ""
                for _, row in lines
            ],
        )
        for i, (name, unit) in enumerate(heads)
        if name
    ]
    if len(sheets) > 1 and SHEET not in folded:
        columns.append((SHEET, "", [sheet for sheet, rows in sheets.items() for _ in rows]))
    return columns, [line for line, _ in lines]


def _cell(text: str, *, days: bool) -> str:
    """Return a cell as the rest of a table is read: nothing where it says nothing, a day as one."""
    if text.casefold() in _EMPTY:
        return ""
    day = written_day(text) if days else None
    return text if day is None else day.isoformat()


def numbers_of_columns(
    cells: Mapping[str, Sequence[str]], where: str
) -> dict[str, list[float | None]]:
    """Return the numbers of each column, None where a cell is empty or holds no finite one.

    DataError: a number can be two and nothing in the table decides.
    """
    numeric = {n: own for n, own in cells.items() if all(map(is_written_number, filter(None, own)))}
    forms = dict(zip(numeric, number_forms(list(numeric.values()), where), strict=True))
    return {n: [_number(c, forms.get(n, NumberForm())) for c in own] for n, own in cells.items()}


def coded_levels(
    name: str,
    unit: str,
    numbers: Sequence[float | None],
    persons: Sequence[str] = (),
    *,
    most: int = MOST_LEVELS,
    fewest: int = 2,
) -> list[str] | None:
    """Return the levels that a column of numbers stands for (shoe 1, 2, 3; hardness 45, 60).

    None where it holds measured numbers: a quantity with a unit or a known range, numbers that are
    not whole, more than ``most`` of them, or one that comes less than ``fewest`` times (among
    several persons: that fewer persons have).

    Parameters:
        name: Heading of the column, in small letters.
        unit: Its unit as written, or nothing; numbers on a scale (Shore A) can be levels.
        numbers: One a row, None in an empty cell.
        persons: Who walked in each row; empty where nobody is named.
        most: Different numbers that can be levels.
        fewest: Rows, or persons, of each.
    """
    quantities = {*_RANGES, *_ANGLES, *_MEASURED, *COUNTED, *_COMPUTED}
    if name in quantities or (unit and not _SCALE.fullmatch(unit)):
        return None
    rows: dict[float, list[int]] = {}
    for i, number in enumerate(numbers):
        if number is not None:
            rows.setdefault(number, []).append(i)
    several = len(set(persons)) > 1
    units_of = [len({persons[i] for i in own} if several else own) for own in rows.values()]
    if not 1 < len(rows) <= most or min(units_of) < fewest or any(number % 1 for number in rows):
        return None
    return ["" if number is None else f"{number:g} {unit}".strip() for number in numbers]


def first_text(cells: Sequence[str], numbers: Sequence[float | None]) -> int | None:
    """Return the place of a column's first filled cell that holds no number."""
    pairs = enumerate(zip(cells, numbers, strict=True))
    return next((i for i, (cell, number) in pairs if cell and number is None), None)


def _number(cell: str, form: NumberForm) -> float | None:
    try:
        number = form.number(cell)
    except ValueError:
        return None
    return number if is_number(form.plain(cell)) and math.isfinite(number) else None


def _sheets(path: Path) -> dict[str, list[list[str]]]:
    """Return the cells of each sheet of a CSV or XLSX file, row by row; errors as `InputError`."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(
            Message("can't be read: {strerror}", strerror=error.strerror or error), where=str(path)
        ) from error
    if is_workbook(data):
        try:
            return workbook_sheets(data, path.name)
        except DataError as error:
            raise InputError(error.what, where=path.name) from error
    try:
        text = decode_text(data, path.name)
    except DataError as error:
        raise InputError(error.what, where=path.name) from error
    lines = csv.reader(io.StringIO(text), delimiter=table_delimiter(text))
    return {"": [[cell.strip() for cell in row] for row in lines]}


def table_delimiter(text: str) -> str:
    """Return what divides the headings of a CSV table: comma, semicolon or tab."""
    return max(",;\t", key=text.split("\n", 1)[0].count)


def column_values(
    cells: list[str],
    numbers: Sequence[float | None],
    unit: str,
    lines: Sequence[int],
    where: str,
    name: str,
) -> list[Any]:
    """Return a column in SI, or as text where not every cell is a number."""
    bad = first_text(cells, numbers)
    if bad is not None and not unit and name in _SI_UNITS and name not in _RANGES:
        written = _quantities(cells, _SI_UNITS[name])
        return list(cells) if written is None else written
    if bad is not None and (name in MASS or si_unit(unit) or _is_si(unit)):
        raise InputError(
            Message('line {line}: {name} is "{cell}"', line=lines[bad], name=name, cell=cells[bad]),
            where=where,
            allowed="a number; its unit stands in the heading, as in mass (kg)",
        )
    if bad is not None or not any(cells):
        return list(cells)
    if name in _COMPUTED and not unit:
        raise InputError(
            Message("{name} has no unit", name=name),
            where=where,
            remedy=Message(
                "Write the unit in the heading: {name} {unit}", name=name, unit=_COMPUTED[name]
            ),
        )
    place = column_place(where, name)
    if unit and name in _SI_UNITS:
        _refuse_other_unit(unit, _SI_UNITS[name], place)
    factor, offset = _to_si(unit, place)
    values = [None if number is None else number * factor + offset for number in numbers]
    low, high, si, headings = _RANGES.get(name, (-math.inf, math.inf, "", ""))
    if name in _ANGLES:
        high = math.radians(LARGEST["angle"]) if unit else LARGEST["angle"]
        low, si, headings = -high, "rad" if unit else "deg", "(deg), (rad)"
    for i, value in enumerate(values):
        if value is not None and not low <= value <= high:
            raise InputError(
                Message('line {line}: {name} is "{cell}"', line=lines[i], name=name, cell=cells[i]),
                where=where,
                allowed=f"{low:g} to {high:g} {si}".strip(),
                remedy=Message(
                    "Write the unit in the heading: {headings}",
                    headings=headings.replace("(", f"{name} ("),
                ),
            )
    return values


def _quantities(cells: Sequence[str], si: str) -> list[float | None] | None:
    """Return cells that each hold a number with its unit ("6 cP"); None where one is a word."""
    try:
        return [units.to_si(cell, si, where="") if cell else None for cell in cells]
    except InputError:
        return None


def _refuse_other_unit(unit: str, si: str, where: str) -> None:
    """Refuse a unit of something else than the column holds (an area in mm, a mass in cm)."""
    if _SCALE.fullmatch(unit):
        return
    known = si_unit(unit)
    plain = known[0] if known and unit not in ("g", "mN", "MN") else unit
    if plain == si:
        return
    try:
        units.to_si(f"1 {plain}", si, where=where)
    except InputError as error:
        allowed = "a number" if si == "1" else Message("a unit of {si}", si=si)
        raise InputError(
            Message('is in "{unit}"', unit=unit), where=where, allowed=allowed
        ) from error


def _is_si(unit: str) -> bool:
    try:
        return units.si_unit(f"1 {unit}", where="") != "1"
    except InputError:  # of a scale, or no unit but a word of the heading
        return False


def _to_si(unit: str, where: str) -> tuple[float, float]:
    """Return factor and offset of a unit written in a heading; none leaves numbers as they are."""
    if not unit or _SCALE.fullmatch(unit):
        return 1.0, 0.0
    known = si_unit(unit)
    # "g" is a force in tribometer logs and a mass here.
    if known and unit not in ("g", "mN", "MN"):
        return known[1], known[2]
    return units.to_si(f"1 {unit}", units.si_unit(f"1 {unit}", where=where), where=where), 0.0
