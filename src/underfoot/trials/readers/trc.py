"""TRC files: marker paths as text (Cortex, OpenSim)."""

import numpy as np

from underfoot.core import DataError

from ..trial import Trial
from .draft import Draft
from .text import is_number, split


def read_trc(draft: Draft) -> Trial:
    """Return the markers of a TRC file as a trial."""
    lines = draft.lines()
    if len(lines) < 6 or "PathFileType" not in lines[0]:
        raise draft.error("not a TRC file", allowed="a first line with PathFileType")
    header = dict(zip(split(lines[1], "\t"), split(lines[2], "\t"), strict=False))
    labels = [cell for cell in split(lines[3], "\t")[2:] if cell]
    if not labels:
        raise DataError("no marker is named", where=f"{draft.name}, line 4")
    announced = header.get("NumMarkers", "")
    if announced.isdigit() and int(announced) < len(labels):
        draft.notes.append(
            f"NumMarkers is {announced}, the labels name {len(labels)}: all are read"
        )
    else:
        draft.count(announced, len(labels), "NumMarkers")
    candidates = ((i, split(lines[i], "\t")) for i in range(4, min(len(lines), 12)))
    first = next((i for i, c in candidates if len(c) > 1 and is_number(c[0].replace(",", "."))), 0)
    if not first:
        raise draft.error("truncated: there are no rows")
    columns = 2 + 3 * len(labels)
    rows = [row for line in lines[first:] if (row := line.rstrip(" \t"))]
    rows = [row + "\t" * (columns - 1 - row.count("\t")) for row in rows]
    numbers = draft.table(rows, "\t", columns, first + 1)
    draft.count(header.get("NumFrames", ""), len(numbers), "NumFrames")
    draft.clock(numbers[:, 1])
    unit = header.get("Units", "")
    size, unknown = float(np.nanmedian(np.abs(numbers[:, 2:]))), f'unit "{unit}" is not known'
    factor = draft.length_unit(unit, size, unknown, "the size of the numbers")
    positions = numbers[:, 2:].reshape(len(numbers), -1, 3) * factor
    positions[(positions == 0.0).all(axis=2)] = np.nan
    for i, name in enumerate(draft.names(labels, "marker")):
        draft.marker(name, positions[:, i])
    return draft.trial("TRC")
