"""OpenSim motion and storage files (.mot, .sto): tables with a header; ground reactions in them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..plates import finished_plate
from ..trial import Channel, Plate, Trial
from .text import decoded, lines_of, rate_of, split, table, unique_names

# ground_force_vx, 1_ground_force_vx, R_ground_force_vx, ground_force_1_vx, FP1_vx ...
_GROUND = re.compile(r"^(?P<base>.*?)_?(?P<kind>[vp][xyz])$")
_REACTION = re.compile(r"ground|grf|force|fp|plate", re.IGNORECASE)
_UP = np.array([0.0, 1.0, 0.0])


def read_motion(data: bytes, path: Path, checksum: str, *, subtract_baseline: bool = True) -> Trial:
    """Return the table of a .mot or .sto file as a trial; ground reactions become plates.

    OpenSim's ground reactions are forces on the body in ground axes, y up, N and m.

    Errors
    ------
    DataError
        No header, no time column, truncated, or inconsistent with its own header.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    end = next((i for i, line in enumerate(lines[:200]) if _is_end(line)), None)
    if end is None:
        raise DataError("not a motion file", where=where, allowed="a header closed by endheader")
    header = _header(lines[:end])
    at = end + 1
    while at < len(lines) and not lines[at].strip():
        at += 1
    if at >= len(lines):
        raise DataError("truncated: the column names are missing", where=where)
    notes: list[str] = []
    delimiter = "\t" if "\t" in lines[at] else ""
    labels = split(lines[at].rstrip(), delimiter)
    if labels[0].casefold() not in ("time", "frame", "t"):
        raise DataError(f'the first column is "{labels[0]}", not time', where=where)
    names = unique_names(labels, "column", notes)
    rows = [line.strip() for line in lines[at + 1 :] if line.strip()]
    numbers, odd = table(rows, delimiter, len(labels), where, first_line=at + 2)
    for key, found in (("nrows", len(numbers)), ("ncolumns", len(labels))):
        if header.get(key, "").isdigit() and int(header[key]) != found:
            raise DataError(
                f"truncated or damaged: {key} is {header[key]}, the file holds {found}",
                where=where,
                remedy="Export or copy the file again",
            )
    rate, start, times = rate_of(numbers[:, 0], where)
    degrees = header.get("indegrees", "").casefold() in ("yes", "true", "1")
    channels = {
        name: Channel(numbers[:, i], "", rate, start, times, "angles in degrees" if degrees else "")
        for i, name in enumerate(names[1:], start=1)
    }
    if times is not None:
        notes.append("samples are not equally spaced: no plates were made")
        plates: tuple[Plate, ...] = ()
    else:
        plates = _plates(labels, numbers, rate, start, subtract_baseline)
    return Trial(
        where,
        channels=channels,
        plates=plates,
        source="OpenSim motion",
        checksum=checksum,
        notes=(*notes, *odd),
    )


def _is_end(line: str) -> bool:
    return line.strip().casefold().startswith("endheader")


def _header(lines: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for line in lines:
        key, separator, value = line.partition("=")
        if separator:
            found[key.strip().casefold()] = value.strip()
        else:  # the older form: "datarows 601"
            words = line.split()
            if len(words) == 2 and words[0].casefold() in ("datarows", "datacolumns"):
                key = {"datarows": "nrows", "datacolumns": "ncolumns"}[words[0].casefold()]
                found[key] = words[1]
    return found


def _plates(
    labels: list[str], numbers: np.ndarray, rate: float, start: float, subtract: bool
) -> tuple[Plate, ...]:
    groups: dict[str, dict[str, int]] = {}
    for i, label in enumerate(labels[1:], start=1):
        match = _GROUND.match(label)
        if match and _REACTION.search(match["base"]):
            groups.setdefault(match["base"], {}).setdefault(match["kind"], i)
    plates = []
    for columns in groups.values():
        if not {"vx", "vy", "vz"} <= columns.keys():
            continue
        force = numbers[:, [columns["vx"], columns["vy"], columns["vz"]]]
        place = None
        if {"px", "py", "pz"} <= columns.keys():
            place = numbers[:, [columns["px"], columns["py"], columns["pz"]]].copy()
            place[force[:, 1] < 20.0] = np.nan
        plates.append(
            finished_plate(
                f"plate {len(plates) + 1}",
                force,
                rate=rate,
                start=start,
                up=_UP,
                centre_of_pressure=place,
                kind=f"ground reaction ({labels[columns['vx']]})",
                subtract_baseline=subtract,
            )
        )
    return tuple(plates)
