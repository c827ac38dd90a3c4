"""Pressure insoles as text: Pedar (novel) and F-Scan (Tekscan)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..trial import Channel, Trial
from .text import decoded, is_number, lines_of, name_and_unit, rate_of, split, table, unique_names
from .unit_factors import si_unit

_SENSORS = 99  # of one Pedar insole
_MOST_CELLS = 50_000_000


def read_pedar(data: bytes, path: Path, checksum: str) -> Trial:
    """Return the pressures of a Pedar text export (.asc, .fgt) as channels.

    Files with 99 or 198 sensors become ``left 1`` to ``right 99`` (Pa), with the largest and the
    mean pressure of each insole; other columns keep their names. Forces need the sensors' areas,
    which the file does not hold.

    Raises
    ------
    DataError
        No table with a time column, truncated.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    at = next((i for i, line in enumerate(lines[:60]) if line.casefold().startswith("time")), None)
    if at is None:
        raise DataError("no column of times", where=where, allowed='a heading "time[secs]"')
    labels = split(lines[at].rstrip("\t "), "\t")
    rows = [x.rstrip("\t ") for x in lines[at + 1 :] if x.strip() and is_number(x.split("\t")[0])]
    notes: list[str] = []
    numbers, odd = table(rows, "\t", len(labels), where, first_line=at + 2)
    rate, start, times = rate_of(numbers[:, 0], where)
    text = "\n".join(lines[:at]).casefold()
    written = next((u for u in ("kpa", "n/cm2", "n/cm^2") if u in text), "kpa")
    factor = 1e3 if written == "kpa" else 1e4
    channels: dict[str, Channel] = {}
    count = len(labels) - 1
    if count in (_SENSORS, 2 * _SENSORS):
        if written == "kpa" and "kpa" not in text:
            notes.append("no unit of pressure in the header: taken as kPa")
        for foot in range(count // _SENSORS):
            side = ("left", "right")[foot]
            first = 1 + foot * _SENSORS
            pressure = numbers[:, first : first + _SENSORS] * factor
            for i in range(_SENSORS):
                channels[f"{side} {i + 1}"] = Channel(pressure[:, i], "Pa", rate, start, times)
            for name, values in (
                ("largest", pressure.max(axis=1)),
                ("mean", pressure.mean(axis=1)),
            ):
                label = f"{side} insole, {name} pressure"
                channels[label] = Channel(values, "Pa", rate, start, times)
        if count == _SENSORS:
            notes.append("one insole: called left, the file does not say which")
    else:
        pairs = [name_and_unit(label) for label in labels]
        names = unique_names([name for name, _ in pairs], "column", notes)
        for i in range(1, len(labels)):
            unit = si_unit(pairs[i][1]) if pairs[i][1] else None
            si, scale, offset = unit if unit else ("", 1.0, 0.0)
            channels[names[i]] = Channel(numbers[:, i] * scale + offset, si, rate, start, times)
    return Trial(where, channels=channels, source="Pedar", checksum=checksum, notes=(*notes, *odd))


def read_fscan(data: bytes, path: Path, checksum: str) -> Trial:
    """Return force, largest pressure and its centre of an F-Scan ASCII movie (.asf) as channels.

    The force is the sum of pressure times the area of a cell; saturated cells ("B") have no
    value and are counted.

    Raises
    ------
    DataError
        A header without rows, columns, spacing or time of a frame; raw values; truncated.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    first = next((i for i, line in enumerate(lines) if re.match(r"frame\s+\d+", line, re.I)), None)
    if first is None:
        raise DataError("no frame", where=where, allowed='lines "Frame 1"')
    header: dict[str, list[str]] = {}
    for line in lines[:first]:
        words = line.split()
        if len(words) > 1:
            header.setdefault(words[0].upper(), words[1:])
    try:
        rows, columns = int(header["ROWS"][0]), int(header["COLS"][0])
        spacing = [float(header[f"{k}_SPACING"][0]) for k in ("ROW", "COL")]
        step = float(header["SECONDS_PER_FRAME"][0])
    except (KeyError, ValueError) as error:
        raise DataError(f"the header lacks {error}", where=where) from error
    unit = si_unit((header.get("UNITS") or [""])[0])
    if unit is None or unit[0] != "Pa":
        raise DataError(
            f'the unit is "{" ".join(header.get("UNITS", []))}"',
            where=where,
            allowed="a unit of pressure",
            remedy="Calibrate, and export pressures",
        )
    frames: list[np.ndarray] = []
    if not 0 < rows * columns < 1e5 or not 0 < step < 10:
        raise DataError(f"{rows} x {columns} cells, {step} s", where=where)
    saturated = 0
    at = first
    while at < len(lines):
        if not re.match(r"frame\s+\d+", lines[at], re.I):
            at += 1
            continue
        body = lines[at + 1 : at + 1 + rows]
        cells = [[c.strip() for c in line.split(",")][:columns] for line in body]
        if len(cells) < rows or any(len(row) < columns for row in cells):
            raise DataError(
                f"truncated: frame {len(frames) + 1} is not complete",
                where=f"{where}, line {at + 1}",
            )
        if (len(frames) + 1) * rows * columns > _MOST_CELLS:
            raise DataError("larger than any recording", where=where)
        saturated += sum(cell.upper() == "B" for row in cells for cell in row)
        frames.append(
            np.array([[float(c) if is_number(c) else np.nan for c in row] for row in cells])
        )
        at += 1 + rows
    pressure = np.array(frames) * unit[1]
    scale = 1e-3 if spacing[0] > 0.5 else 1.0
    area = float(np.prod(np.array(spacing) * scale))
    load = np.nansum(pressure, axis=(1, 2))
    y, x = (np.arange(n) * s * scale for n, s in zip((rows, columns), spacing, strict=True))
    with np.errstate(invalid="ignore", divide="ignore"):
        centre_y = np.nansum(pressure * y[:, None], axis=(1, 2)) / load
        centre_x = np.nansum(pressure * x, axis=(1, 2)) / load
    rate = 1.0 / step
    notes = (f"{saturated} saturated cells have no value",) if saturated else ()
    return Trial(
        where,
        channels={
            "insole, force": Channel(load * area, "N", rate),
            "insole, largest pressure": Channel(np.nanmax(pressure, axis=(1, 2)), "Pa", rate),
            "insole, centre along rows": Channel(centre_y, "m", rate),
            "insole, centre along columns": Channel(centre_x, "m", rate),
        },
        source="F-Scan",
        checksum=checksum,
        notes=notes,
    )
