"""XSENSOR's CSV (PRO): frames of pressure of one sensor or two insoles."""

import numpy as np

from underfoot.core import DataError
from underfoot.core.remark import Message

from ..recording.trial import Trial
from .draft import RecordingDraft
from .text import is_number, line_of, si_unit


def read_xsensor(draft: RecordingDraft) -> Trial:
    """Return force, largest pressure and its centre of each sensor as channels.

    Each frame is a block of "key:,value" lines (Frame, Time, Sensor, Rows, Columns, Units) and of
    rows of cells. The force is the sum of pressure times the area of a cell, where the file gives
    the size of its cells.
    """
    sensors: dict[str, list[tuple[float, np.ndarray]]] = {}
    header: dict[str, str] = {}
    block: list[list[float]] = []
    sheets: list[tuple[str, float, list[list[float]]]] = []
    for number, line in enumerate(draft.lines(), start=1):
        cells = [cell.strip().strip('"') for cell in line.split(",")]
        if len(cells) > 2 and all(is_number(c) for c in cells if c) and any(cells):
            block.append([float(c) if c else np.nan for c in cells if c])
            continue
        if block:
            sheets.append((header.get("sensor", "sensor"), _seconds(header, draft, number), block))
            block = []
        if cells[0]:
            header[cells[0].rstrip(":").casefold()] = next((c for c in cells[1:] if c), "")
    if block:
        sheets.append((header.get("sensor", "sensor"), _seconds(header, draft, 0), block))
    rows = header.get("rows", "")
    for name, when, cells in sheets:
        if len({len(row) for row in cells}) > 1 or (rows.isdigit() and len(cells) != int(rows)):
            raise draft.error(
                Message(
                    "truncated: a frame of {name} has {count} of {rows} rows",
                    name=name,
                    count=len(cells),
                    rows=rows,
                )
            )
        sensors.setdefault(name, []).append((when, np.array(cells)))
    unit = si_unit(header.get("units", header.get("pressure units", "")))
    if not sensors or unit is None or unit[0] != "Pa":
        raise draft.error("no frames in a unit of pressure", allowed='"Units:,kPa"')
    sizes = [header.get(f"sensel {key} (cm)", header.get(f"{key} spacing (cm)", ""))
             for key in ("width", "height")]  # fmt: skip
    area = float(np.prod([1e-2 * float(s) for s in sizes])) if all(map(is_number, sizes)) else None
    if area is None:
        draft.notes.append("the file does not give the size of a cell: no forces")
    for name, frames in sensors.items():
        draft.clock(np.array([when for when, _ in frames]) - sheets[0][1])
        pressure = np.array([cells for _, cells in frames]) * unit[1]
        whole = np.nansum(pressure, axis=(1, 2))
        draft.channel(f"{name}, largest pressure", np.nanmax(pressure, axis=(1, 2)), unit="Pa",
                      note="")  # fmt: skip
        if area is not None:
            draft.channel(f"{name}, force", whole * area, unit="N", note="")
    return draft.trial("XSENSOR")


def _seconds(header: dict[str, str], draft: RecordingDraft, line: int) -> float:
    text = header.get("time", header.get("frame time", ""))
    parts = text.split(":")
    try:
        return sum(float(part) * 60.0**i for i, part in enumerate(reversed(parts)))
    except ValueError:
        raise DataError(
            Message('"{text}" is no time', text=text), where=line_of(draft.name, line)
        ) from None
