"""A few numbers of every finished case of a study, without taking its lines apart whole.

A line of a case has forty numbers, and a page of a hundred thousand cases asks for four of them:
they are looked up in the text that ``Record.line`` wrote.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import AnyArray, Array

from .lines import CURRENT
from .record import Record, draws_place
from .records import DrawsAt, Records

CASE = ("seconds", "cpu_seconds", "ended")
"""Numbers of a case itself, by their names in a record."""
_CASE = re.compile(
    rb'"seconds": ([^,]+), "cpu_seconds": ([^,]+), .*?"program": "([^"]*)", '
    rb'.*?"ended": ([-+.0-9eE]+)'
)
MOST_DRAWS = 10_000_000
"""Draws of COF that are held, float32; of more every second, third ... of each case is."""


@dataclass(frozen=True, slots=True)
class DesignScan:
    """Columns over the finished cases and, last, one that is not; nan where there is no number.

    Attributes:
        rows: Of a case, by key.
        case: (cases,) by name: ``CASE``.
        outputs, errors: (cases,) by output: its number and its numerical error, SI.
        draws: (cases, law's draws) of COF, its number where the law has none; None if not asked.
        every: Of so many draws of a case one is among ``draws``.
        programs: Versions of the program that computed them.
    """

    rows: Mapping[str, int]
    case: Mapping[str, Array]
    outputs: Mapping[str, Array]
    errors: Mapping[str, Array]
    draws: AnyArray | None
    every: int
    programs: Collection[str]


def scan_cases(
    records: Records, outputs: Collection[str] = (), *, draws: bool = False
) -> DesignScan:
    """Return some outputs of all finished cases, and with ``draws`` those of COF.

    Raises:
        DataError: Draws that are damaged.
    """
    try:
        return _scan_records(records, outputs, draws)
    except FileNotFoundError:  # packed since the last look
        return _scan_records(records.look(), outputs, draws)


def _scan_records(records: Records, outputs: Collection[str], draws: bool) -> DesignScan:
    keys = list(records)
    case, numbers, errors = (
        {name: np.full(len(keys) + 1, np.nan) for name in names}
        for names in (CASE, outputs, outputs)
    )
    marks = [(_pattern(name), numbers[name], errors[name]) for name in outputs]
    programs, every = set[str](), 1
    table = np.full((len(keys) + 1 if draws else 0, 1), np.nan, np.float32)
    for k, line, draws_at in records.lines(keys):
        start = line.find(b'"numbers": {')
        end = line.find(b"}", start)
        second = line.find(b'"errors": {', end)  # lines of version 1 have none
        last = line.find(b"}", second) if second >= 0 else second
        for pattern, values, deviations in marks:
            if known := pattern.search(line, start, end):
                values[k] = known[1]
            if known := pattern.search(line, second, last):
                deviations[k] = known[1]
        if known := _CASE.search(line, end):
            for column, text in zip(case.values(), known.group(1, 2, 4), strict=True):
                column[k] = text
            programs.add(known[3].decode())
        if draws:
            row = _draws(line, draws_at)
            if row.size * len(keys) > MOST_DRAWS:
                every = max(every, -(-row.size * len(keys) // MOST_DRAWS))
            row = row[::every] if row.size else np.array([numbers["cof"][k]], np.float32)
            if row.size > 1 and table.shape[1] == 1:
                table = np.repeat(table[:, :1], row.size, axis=1)  # the first that has draws
            table[k] = row if row.size == table.shape[1] else row.mean()
    rows = {key: k for k, key in enumerate(keys)}
    return DesignScan(rows, case, numbers, errors, table if draws else None, every, programs - {""})


def _pattern(name: str) -> re.Pattern[bytes]:
    """Return what a number of a name looks like in a line: no text in it has a bare quote."""
    return re.compile(b'"%s": ([-+.0-9eE]+)' % re.escape(name.encode()))


def _draws(line: bytes, draws_at: DrawsAt) -> AnyArray:
    if not line.startswith(CURRENT):
        return Record.from_line(line, draws_at).draws.astype(np.float32)
    return np.frombuffer(draws_at(*draws_place(line)), "<f4")
