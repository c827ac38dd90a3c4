"""TRC files: marker paths as text (Cortex, OpenSim)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..trial import Marker, Trial
from .text import decoded, is_number, lines_of, rate_of, split, table, unique_names
from .unit_factors import si_unit


def read_trc(data: bytes, path: Path, checksum: str) -> Trial:
    """Return the markers of a TRC file as a trial.

    Raises
    ------
    DataError
        Not a TRC file, truncated, or inconsistent with its own header.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    if len(lines) < 6 or "PathFileType" not in lines[0]:
        raise DataError("not a TRC file", where=where, allowed="a first line with PathFileType")
    keys, values = split(lines[1], "\t"), split(lines[2], "\t")
    header = dict(zip(keys, values, strict=False))
    notes: list[str] = []
    labels = [cell for cell in split(lines[3], "\t")[2:] if cell]
    if not labels:
        raise DataError("no marker is named", where=f"{where}, line 4")
    announced = header.get("NumMarkers", "")
    if announced.isdigit() and int(announced) < len(labels):
        notes.append(f"NumMarkers is {announced}, the labels name {len(labels)}: all are read")
    else:
        _agrees(header, "NumMarkers", len(labels), where)
    first = _first_row(lines, where)
    rows = [line.rstrip(" \t") for line in lines[first:]]
    rows = [row for row in rows if row]
    columns = 2 + 3 * len(labels)
    rows = [row + "\t" * (columns - 1 - row.count("\t")) for row in rows]
    numbers, odd = table(rows, "\t", columns, where, first_line=first + 1)
    _agrees(header, "NumFrames", len(numbers), where)
    rate, start, times = rate_of(numbers[:, 1], where)
    unit = si_unit(header.get("Units", ""))
    if unit is None or unit[0] != "m":
        size = float(np.nanmedian(np.abs(numbers[:, 2:])))
        unit = ("m", 1e-3 if size > 20.0 else 1.0, 0.0)
        notes.append(
            f'unit "{header.get("Units", "")}" is not known: taken as '
            f"{'mm' if unit[1] < 1 else 'm'} from the size of the numbers"
        )
    positions = numbers[:, 2:].reshape(len(numbers), -1, 3) * unit[1]
    positions[(positions == 0.0).all(axis=2)] = np.nan
    markers = {
        name: Marker(positions[:, i], rate, start, times)
        for i, name in enumerate(unique_names(labels, "marker", notes))
    }
    return Trial(where, markers=markers, source="TRC", checksum=checksum, notes=(*notes, *odd))


def _first_row(lines: list[str], where: str) -> int:
    for i in range(4, min(len(lines), 12)):
        cells = split(lines[i], "\t")
        if len(cells) > 1 and is_number(cells[0].replace(",", ".")):
            return i
    raise DataError("truncated: there are no rows", where=where)


def _agrees(header: dict[str, str], key: str, found: int, where: str) -> None:
    written = header.get(key, "")
    if written.isdigit() and int(written) != found:
        raise DataError(
            f"truncated or damaged: {key} is {written}, the file holds {found}",
            where=where,
            remedy="Export or copy the file again",
        )
