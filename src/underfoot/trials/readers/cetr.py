"""CETR UMT tribometer logs: a free header and several steps a file."""

from __future__ import annotations

from pathlib import Path

from underfoot.core import DataError

from ..trial import Channel, Trial
from .text import decoded, is_number, lines_of, rate_of, split, table, unique_names
from .unit_factors import si_unit


def is_cetr(text: str) -> bool:
    """True when a text begins as CETR logs do."""
    return "CETR" in text[:200]


def read_cetr(data: bytes, path: Path, checksum: str) -> tuple[Trial, ...]:
    """Return one trial for each step of a CETR log.

    Forces come in grams-force and become N; the sign of Fz (negative under load) is kept.

    Errors
    ------
    DataError
        Not a CETR log, truncated, or no step holds data.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    if not is_cetr("\n".join(lines[:4])):
        raise DataError("not a CETR log", where=where)
    starts = [i for i, line in enumerate(lines) if line.strip().startswith("Step No")]
    if not starts:
        raise DataError("truncated: there is no step", where=where)
    announced = _settings(lines[: starts[0]]).get("Total number of steps", "")
    if announced.isdigit() and int(announced) > len(starts):
        raise DataError(
            f"truncated: {announced} steps announced, {len(starts)} found",
            where=where,
            remedy="Export or copy the file again",
        )
    stops = [*starts[1:], len(lines)]
    return tuple(
        _step(lines, start, stop, number, where, checksum)
        for number, (start, stop) in enumerate(zip(starts, stops, strict=True), start=1)
    )


def _step(lines: list[str], start: int, stop: int, number: int, where: str, checksum: str) -> Trial:
    name = f"{where}, step {number}"
    first = next(
        (
            i
            for i in range(start + 1, stop)
            if len(cells := split(lines[i], ",")) > 2 and is_number(cells[0])
        ),
        None,
    )
    heads = [i for i in range(start + 1, first or stop) if lines[i].count(",") > 2]
    if first is None or len(heads) < 2:
        raise DataError("truncated: the step holds no table", where=name)
    notes: list[str] = []
    labels, units = split(lines[heads[-2]], ","), split(lines[heads[-1]], ",")
    rows = [line for line in lines[first:stop] if line.strip()]
    numbers, odd = table(rows, ",", len(labels), name, first_line=first + 1)
    settings = _settings(lines[start : heads[-2]])
    count = settings.get("Data Count", "")
    if count.isdigit() and int(count) != len(numbers):
        raise DataError(
            f"truncated or damaged: {count} samples announced, {len(numbers)} found",
            where=name,
            remedy="Export or copy the file again",
        )
    names = unique_names(labels, "column", notes)
    if "T" not in names:
        raise DataError("there is no time column T", where=name)
    rate, begin, times = rate_of(numbers[:, names.index("T")], name)
    channels = {}
    for i, label in enumerate(names):
        written = units[i] if i < len(units) else ""
        unit = si_unit(written) if written else ("1" if label == "COF" else "", 1.0, 0.0)
        si, factor, offset = unit if unit else ("", 1.0, 0.0)
        note = f'in "{written}" in the file' if written else ""
        channels[label] = Channel(numbers[:, i] * factor + offset, si, rate, begin, times, note)
    if "Fz" in channels and channels["Fz"].values.mean() < 0:
        notes.append("Fz is negative under load, as in the file")
    return Trial(
        name,
        channels=channels,
        source="CETR log",
        checksum=checksum,
        notes=(*notes, *odd),
        settings=settings,
    )


def _settings(lines: list[str]) -> dict[str, str]:
    found = {}
    for line in lines:
        for sign in ("=", ":", " - "):
            key, separator, value = line.partition(sign)
            if separator and key.strip() and value.strip():
                found[key.strip()] = value.strip()
                break
    return found
