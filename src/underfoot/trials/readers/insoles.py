"""Pressure insoles as text: Pedar (novel) and F-Scan (Tekscan)."""

import re

import numpy as np

from underfoot.core import DataError

from ..trial import Trial
from .draft import Draft
from .text import is_number, name_and_unit, split
from .unit_factors import si_unit

_SENSORS = 99  # of one Pedar insole
_MOST_CELLS = 50_000_000


def read_pedar(draft: Draft) -> Trial:
    """Return the pressures of a Pedar text export (.asc, .fgt) as channels.

    Files with 99 or 198 sensors become ``left 1`` to ``right 99`` (Pa), with the largest and the
    mean pressure of each insole; other columns keep their names. Forces need the sensors' areas,
    which the file does not hold.
    """
    lines = draft.lines()
    at = next((i for i, line in enumerate(lines[:60]) if line.casefold().startswith("time")), None)
    if at is None:
        raise draft.error("no column of times", allowed='a heading "time[secs]"')
    labels = split(lines[at].rstrip("\t "), "\t")
    rows = [x.rstrip("\t ") for x in lines[at + 1 :] if is_number(x.split("\t")[0])]
    numbers = draft.table(rows, "\t", len(labels), at + 2)
    draft.clock(numbers[:, 0])
    text = "\n".join(lines[:at]).casefold()
    written = next((u for u in ("kpa", "n/cm2", "n/cm^2") if u in text), "")
    count = len(labels) - 1
    if count not in (_SENSORS, 2 * _SENSORS):
        pairs = [name_and_unit(label) for label in labels]
        names = draft.names([name for name, _ in pairs], "column")
        for i in range(1, len(labels)):
            draft.channel(names[i], numbers[:, i], pairs[i][1])
        return draft.trial("Pedar")
    if not written:
        draft.notes.append("no unit of pressure in the header: taken as kPa")
    scale = 1e4 if "n/cm" in written else 1e3
    for foot in range(count // _SENSORS):
        side, first = ("left", "right")[foot], 1 + foot * _SENSORS
        pressure = numbers[:, first : first + _SENSORS]
        named = {f"{side} {i + 1}": pressure[:, i] for i in range(_SENSORS)}
        named[f"{side} insole, largest pressure"] = pressure.max(axis=1)
        named[f"{side} insole, mean pressure"] = pressure.mean(axis=1)
        for name, values in named.items():
            draft.channel(name, values, unit="Pa", scale=scale, note="")
    if count == _SENSORS:
        draft.notes.append("one insole: called left, the file does not say which")
    return draft.trial("Pedar")


def read_fscan(draft: Draft) -> Trial:
    """Return force, largest pressure and its centre of an F-Scan ASCII movie (.asf) as channels.

    The force is the sum of pressure times the area of a cell; saturated cells ("B") have no
    value and are counted.
    """
    lines = draft.lines()
    begins = [i for i, line in enumerate(lines) if re.match(r"frame\s+\d+", line, re.I)]
    if not begins:
        raise draft.error("no frame", allowed='lines "Frame 1"')
    header: dict[str, list[str]] = {}
    for line in lines[: begins[0]]:
        words = line.split()
        if len(words) > 1:
            header.setdefault(words[0].upper(), words[1:])
    try:
        rows, columns = int(header["ROWS"][0]), int(header["COLS"][0])
        spacing = [float(header[f"{k}_SPACING"][0]) for k in ("ROW", "COL")]
        step = float(header["SECONDS_PER_FRAME"][0])
    except (KeyError, ValueError) as error:
        raise draft.error(f"the header lacks {error}") from error
    unit = si_unit((header.get("UNITS") or [""])[0])
    if unit is None or unit[0] != "Pa":
        raise draft.error(
            f'the unit is "{" ".join(header.get("UNITS", []))}"',
            allowed="a unit of pressure",
            remedy="Calibrate, and export pressures",
        )
    if not 0 < rows * columns < 1e5 or not 0 < step < 10:
        raise draft.error(f"{rows} x {columns} cells, {step} s")
    if len(begins) * rows * columns > _MOST_CELLS:
        raise draft.error("larger than any recording")
    saturated, frames = 0, []
    for number, at in enumerate(begins, start=1):
        body = lines[at + 1 : at + 1 + rows]
        cells = [[c.strip() for c in line.split(",")][:columns] for line in body]
        if len(cells) < rows or any(len(row) < columns for row in cells):
            where = f"{draft.name}, line {at + 1}"
            raise DataError(f"truncated: frame {number} is not complete", where=where)
        saturated += sum(cell.upper() == "B" for row in cells for cell in row)
        frames.append([[float(c) if is_number(c) else np.nan for c in row] for row in cells])
    pressure = np.array(frames) * unit[1]
    scale = 1e-3 if spacing[0] > 0.5 else 1.0
    area = float(np.prod(np.array(spacing) * scale))
    load = np.nansum(pressure, axis=(1, 2))
    y, x = (np.arange(n) * s * scale for n, s in zip((rows, columns), spacing, strict=True))
    with np.errstate(invalid="ignore", divide="ignore"):
        centre_y = np.nansum(pressure * y[:, None], axis=(1, 2)) / load
        centre_x = np.nansum(pressure * x, axis=(1, 2)) / load
    draft.rate = 1.0 / step
    for name, values, si in (
        ("force", load * area, "N"),
        ("largest pressure", np.nanmax(pressure, axis=(1, 2)), "Pa"),
        ("centre along rows", centre_y, "m"),
        ("centre along columns", centre_x, "m"),
    ):
        draft.channel(f"insole, {name}", values, unit=si, note="")
    if saturated:
        draft.notes.append(f"{saturated} saturated cells have no value")
    return draft.trial("F-Scan")
