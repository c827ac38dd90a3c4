"""Numbers as people write them: which sign marks decimals and which thousands, column by column."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from .errors import DataError
from .remark import Message
from .text import MISSING
from .typed import is_lost, plain_signs

_GAP = re.compile(r"(?<=\d)['’ ](?=\d{3}(?!\d))")
_NO_GROUP = re.compile(r"[+-]?0+['’ ]")
"""Begin of what has no thousands: "0 500" is no number."""
_NUMBER = re.compile(r"([+-]?)([\d.,]*\d[\d.,]*)([eEdD][+-]?\d+)?")
_PLAIN = re.compile(r"\d+|\d*[.,]\d+|\d+[.,]")
_GROUPED = {mark: re.compile(rf"[1-9]\d{{0,2}}([{mark}]\d{{3}})+") for mark in ".,"}
_OTHER = {",": ".", ".": ","}
_WITH_UNIT = re.compile(
    rf"({_NUMBER.pattern})\s*(%|[a-zµμ°²][a-zµμ°²³⁻¹/*·.^\d-]{{0,9}})", re.IGNORECASE
)
_TINY = re.compile(r"([\d.]*[1-9][\d.]*)[eE]-\d{3,}")
_TINY_END = re.compile(r"[eE]-\d{3}")
"""Looked for first: it takes a hundredth of the time."""
FEWEST = 3
"""Numbers with three digits behind a point that make it one of thousands beside whole numbers."""


def any_lost(rows: Iterable[str]) -> bool:
    """Return whether rows of plain numbers hold one that ``is_lost``."""
    small = (match for row in rows if _TINY_END.search(row) for match in _TINY.finditer(row))
    return any(float(match[0]) == 0.0 for match in small)


def _close_gaps(cell: str) -> str:
    """Return a cell without the gaps between thousands."""
    return cell if _NO_GROUP.match(cell) else _GAP.sub("", cell)


@dataclass(frozen=True, slots=True)
class NumberForm:
    """How the numbers of a column are written: decimal sign ("." or ","), and thousands or not."""

    decimal: str = "."
    thousands: bool = False

    def plain(self, cell: str) -> str:
        """Return the text of a number as ``float`` takes it; other text comes back as it is.

        >>> NumberForm(",", True).plain("1.075,5")
        '1075.5'
        """
        cell = cell.strip()
        match = _NUMBER.fullmatch(_close_gaps(plain_signs(cell)))
        if match is None:
            return cell
        sign, body, exponent = match.group(1), match.group(2), match.group(3) or ""
        whole, _, rest = body.partition(self.decimal)
        mark = _OTHER[self.decimal]
        if mark in whole and self.thousands and _GROUPED[mark].fullmatch(whole):
            whole = whole.replace(mark, "")
        if mark in whole or not (rest.isdigit() or not rest):
            return cell
        text = f"{sign}{whole}{'.' if self.decimal in body else ''}{rest}{exponent}"
        return text.replace("d", "e").replace("D", "e")

    def number(self, cell: str) -> float:
        """Return the number in a cell; a ValueError where it holds none that can be held."""
        plain = self.plain(cell)
        number = float(plain)
        if is_lost(number, plain):
            raise ValueError(f"{cell} is too small to be told from 0")
        return number


@dataclass(slots=True)
class _Evidence:
    """What the numbers of a column say: marks that can only be one thing, and those that can't."""

    decimals: set[str]
    groups: set[str]
    open: dict[str, str]
    """By mark, the first number that can be read either way."""
    opened: int = 0
    long_whole: bool = False
    short_whole: bool = False
    gaps: bool = False

    @classmethod
    def of(cls, cells: Iterable[str]) -> "_Evidence":
        found = cls(set(), set(), {})
        for cell in cells:
            found._add(plain_signs(cell).strip())
        return found

    def _add(self, cell: str) -> None:
        closed = _close_gaps(cell)
        match = _NUMBER.fullmatch(closed)
        if match is None:
            return
        body = match.group(2)
        marks = [mark for mark in ".," if mark in body]
        self.gaps |= closed != cell
        if not marks:
            self.long_whole |= len(body) > 3 and closed == cell and body[0] != "0"
            self.short_whole |= len(body) == 3 and body[0] != "0"
        elif len(marks) == 2:
            last = max(marks, key=body.rfind)
            if _GROUPED[_OTHER[last]].fullmatch(body.partition(last)[0]):
                self.decimals.add(last)
                self.groups.add(_OTHER[last])
        elif body.count(marks[0]) > 1:
            if _GROUPED[marks[0]].fullmatch(body):  # else a date
                self.groups.add(marks[0])
        elif closed == cell and not match.group(3) and _GROUPED[marks[0]].fullmatch(body):
            self.open.setdefault(marks[0], cell)
            self.opened += 1
        elif _PLAIN.fullmatch(body):
            self.decimals.add(marks[0])


def number_forms(columns: Sequence[Sequence[str]], where: str) -> list[NumberForm]:
    """Return how the numbers of each column are written.

    A number that can only be read one way decides: "0,5", "1.075,5", "1,075,200". "1,075" alone
    can be 1.075 or 1075: the rest of its column decides (1234 without a mark: no thousands are
    marked; 998 beside 1,002: they are), then the other columns. Text that is no number is left
    out of it.

    Parameters:
        columns: Cells of each column, quotes removed.
        where: File, for errors.

    Raises:
        DataError: A sign that marks decimals and thousands in one column; numbers that nothing
            decides.
    """
    evidences = [_Evidence.of(cells) for cells in columns]
    decimals = set[str]().union(*(evidence.decimals for evidence in evidences))
    groups = set[str]().union(*(evidence.groups for evidence in evidences))
    return [_form(evidence, decimals, groups, where) for evidence in evidences]


def _form(seen: _Evidence, decimals: set[str], groups: set[str], where: str) -> NumberForm:
    if seen.decimals & seen.groups or len(seen.decimals) > 1 or len(seen.groups) > 1:
        raise DataError(
            "one column writes decimals in two ways, or marks decimals and thousands with one sign",
            where=where,
            allowed="one decimal sign, and another sign or none between thousands",
            remedy="Export the numbers with a decimal point and without thousands separators",
        )
    if seen.decimals:
        (decimal,) = seen.decimals
        return NumberForm(decimal, bool(seen.groups or seen.open.keys() - {decimal} or seen.gaps))
    if seen.groups:
        (mark,) = seen.groups
        return NumberForm(_OTHER[mark], True)
    if not seen.open:
        return NumberForm(thousands=seen.gaps)
    if len(seen.open) == 1:
        ((mark, example),) = seen.open.items()
        if _marks_decimals(seen, mark, decimals, groups, example, where):
            return NumberForm(mark, seen.gaps)
        return NumberForm(_OTHER[mark], True)
    raise _undecided_error(", ".join(f'"{cell}"' for cell in seen.open.values()), where)


def _marks_decimals(
    seen: _Evidence, mark: str, decimals: set[str], groups: set[str], example: str, where: str
) -> bool:
    """Return whether the one mark of a column, always before three digits, marks decimals."""
    if len(decimals) == 1 and not (seen.long_whole and mark not in decimals):
        return mark in decimals
    if mark in groups or (seen.short_whole and (mark == "," or seen.opened >= FEWEST)):
        return False
    if not decimals and (mark == "." or seen.long_whole):
        return True
    raise _undecided_error(f'"{example}"', where)


def _undecided_error(examples: str, where: str) -> DataError:
    return DataError(
        Message(
            "{examples} can be a decimal number or one with its thousands marked, a "
            "thousand times as much; nothing in the file decides",
            examples=examples,
        ),
        where=where,
        remedy="Export with a decimal point and without thousands separators",
    )


def column_numbers(cells: Sequence[str], form: NumberForm) -> list[float]:
    """Return the numbers of a column, NaN where one is missing; a ValueError names other text."""
    return [math.nan if cell.casefold() in MISSING else form.number(cell) for cell in cells]


def units_in_cells(rows: Sequence[Sequence[str]], known: Callable[[str], bool]) -> dict[int, str]:
    """Return the units of the columns in which most cells are a number and one unit: "45 %".

    Parameters:
        known: Whether a word is a unit.

    >>> units_in_cells([["a", "45 %"], ["b", "50 %"]], lambda word: word == "%")
    {1: '%'}
    """
    units: dict[int, str] = {}
    for column in range(max(map(len, rows), default=0)):
        cells = [row[column] for row in rows if column < len(row) and row[column]]
        found = [match[5] for cell in cells if (match := _WITH_UNIT.fullmatch(cell))]
        if 2 * len(found) > len(cells) and len(set(found)) == 1 and known(found[0]):
            units[column] = found[0]
    return units


def without_units(cells: Sequence[str], units: Mapping[int, str]) -> list[str]:
    """Return a row with the units of its columns taken out of the cells.

    >>> without_units(["a", "45 %"], {1: "%"})
    ['a', '45']
    """
    bare = list(cells)
    for column, unit in units.items():
        match = _WITH_UNIT.fullmatch(bare[column]) if column < len(bare) else None
        if match and match[5] == unit:
            bare[column] = match[1]
    return bare


def column_place(file: str, column: str) -> Message:
    """Return a column of a file as the place of an error."""
    return Message("{file}, column {column}", file=file, column=column)


def one_unit(units: Sequence[str], same: Callable[[str, str], bool], where: str) -> str:
    """Return the unit of a column from all places that name one (heading, row below, cells).

    Raises:
        DataError: Two that ``same`` holds for different.
    """
    named = [word for word in units if word.strip("[](){} -")]
    for word in named[1:]:
        if not same(named[0], word):
            raise DataError(
                Message(
                    'two units that contradict each other, "{first}" and "{second}"',
                    first=named[0],
                    second=word,
                ),
                where=where,
                remedy="Keep the one that the numbers are in",
            )
    return next(iter(named), next(iter(filter(None, units)), ""))
