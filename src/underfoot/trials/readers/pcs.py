"""PCS Instruments logs (MTM, EHD): several steps a file, units in the column names."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..trial import Channel, Trial
from .text import decoded, is_number, lines_of, name_and_unit, rate_of, split, table, unique_names
from .unit_factors import si_unit

_TEXT_COLUMNS = ("image file name", "comments")
# Speeds are written without a unit; the rolling speed beside them is in mm/s.
_SPEEDS = ("Ball Speed", "Disc Speed")


def is_pcs(text: str) -> bool:
    """True when a text begins as PCS logs do."""
    return "Test Data File" in text.split("\n", 1)[0]


def read_pcs(data: bytes, path: Path, checksum: str) -> tuple[Trial, ...]:
    """Return one trial for each step that holds a table.

    Columns that repeat the first two appear once; empty columns are left out.

    Raises
    ------
    DataError
        Not a PCS log, truncated, or no step holds a table.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    if not is_pcs(lines[0]):
        raise DataError("not a PCS log", where=where)
    starts = [i for i, line in enumerate(lines) if line.startswith("Step ") and "started" in line]
    if not starts:
        raise DataError("truncated: there is no step", where=where)
    general = _settings(lines[: starts[0]])
    done = general.get("Number of steps completed", "")
    if done.isdigit() and int(done) > len(starts):
        raise DataError(
            f"truncated: {done} steps announced, {len(starts)} found",
            where=where,
            remedy="Copy the file again",
        )
    trials, without = [], []
    stops = [*starts[1:], len(lines)]
    for number, (start, stop) in enumerate(zip(starts, stops, strict=True), start=1):
        trial = _step(lines, start, stop, number, where, checksum, general)
        if trial is None:
            without.append(str(number))
        else:
            trials.append(trial)
    if not trials:
        raise DataError("no step holds a table", where=where)
    if without:
        note = f"steps without a table: {', '.join(without)}"
        trials = [trial.with_notes(note) for trial in trials]
    return tuple(trials)


def _step(
    lines: list[str],
    start: int,
    stop: int,
    number: int,
    where: str,
    checksum: str,
    general: dict[str, str],
) -> Trial | None:
    name = f"{where}, step {number}"
    at = next((i for i in range(start + 1, stop) if lines[i].count("\t") > 8), None)
    if at is None:
        return None
    labels = split(lines[at].rstrip("\t "), "\t")
    ignored = frozenset(i for i, x in enumerate(labels) if x.casefold() in _TEXT_COLUMNS)
    rows = [line for line in lines[at + 1 : stop] if is_number(line.split("\t", 1)[0])]
    numbers, odd = table(rows, "\t", len(labels), name, first_line=at + 2, ignored=ignored)
    notes: list[str] = []
    filled = sum(line.count("\t") > 8 and bool(line.strip()) for line in lines[at + 1 : stop])
    if filled > len(rows):
        notes.append(
            f"{filled - len(rows)} rows do not begin with a number (as #REF!) and are left out"
        )
    columns = [
        i
        for i, x in enumerate(labels)
        if x and i not in ignored and np.isfinite(numbers[:, i]).any()
    ]
    # The first two columns are repeated further on.
    repeated = [i for i in columns[:2] if any(labels[j] == labels[i] for j in columns if j > i)]
    columns = [i for i in columns if i not in repeated]
    names = unique_names([name_and_unit(labels[i])[0] for i in columns], "column", notes)
    if "Step Time" not in names:
        raise DataError("there is no column Step Time", where=name)
    rate, begin, times = rate_of(numbers[:, columns[names.index("Step Time")]], name)
    channels = {}
    for label, i in zip(names, columns, strict=True):
        written = name_and_unit(labels[i])[1]
        if not written and label.startswith(_SPEEDS):
            written = "mm/s"
        unit = si_unit(written) if written else None
        si, factor, offset = unit if unit else ("", 1.0, 0.0)
        note = f'in "{written}" in the file' if written else ""
        channels[label] = Channel(numbers[:, i] * factor + offset, si, rate, begin, times, note)
    return Trial(
        name,
        channels=channels,
        source="PCS log",
        checksum=checksum,
        notes=(*notes, *odd),
        settings={**general, **_settings(lines[start:at])},
    )


def _settings(lines: list[str]) -> dict[str, str]:
    found = {}
    for line in lines:
        cells = [cell.strip() for cell in line.split("\t")]
        if len(cells) > 1:
            pairs = zip(cells[::2], cells[1::2], strict=False)
        else:
            pairs = [tuple(cell.strip() for cell in line.partition("="))[::2]]
        found.update({key.rstrip(":"): value for key, value in pairs if key and value})
    return found
