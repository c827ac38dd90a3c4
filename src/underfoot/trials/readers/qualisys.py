"""Qualisys TSV exports: marker paths, and one force plate a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..plates import finished_plate
from ..trial import Channel, Marker, Trial
from .text import decoded, is_number, lines_of, rate_of, split, table, unique_names

_CORNERS = ("POSX_POSY", "NEGX_POSY", "NEGX_NEGY", "POSX_NEGY")


def read_qualisys(
    data: bytes, path: Path, checksum: str, *, subtract_baseline: bool = True
) -> Trial:
    """Return the markers or the force plate of a Qualisys TSV file as a trial.

    Lengths are mm. Forces are taken as exported, in laboratory axes (QTM can also export plate
    axes: choose "global" there).

    Raises
    ------
    DataError
        No rate, truncated, or inconsistent with its own header.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    header: dict[str, list[str]] = {}
    at = 0
    while at < len(lines) and (cells := split(lines[at], "\t")) and not is_number(cells[0]):
        header.setdefault(cells[0].upper(), cells[1:])
        at += 1
    rate = float((header.get("FREQUENCY") or ["nan"])[0] or "nan")
    if not 0 < rate < 1e6:
        raise DataError("the header has no FREQUENCY", where=where)
    rows = [line.rstrip("\t ") for line in lines[at:] if line.strip()]
    if not rows:
        raise DataError("truncated: there are no rows", where=where)
    width = max(row.count("\t") for row in rows) + 1
    numbers, odd = table(rows, "\t", width, where, first_line=at + 1)
    for key in ("NO_OF_FRAMES", "NO_OF_SAMPLES"):
        count = (header.get(key) or [""])[0]
        if count.isdigit() and int(count) != len(numbers):
            raise DataError(
                f"truncated or damaged: {key} is {count}, the file holds {len(numbers)}",
                where=where,
                remedy="Export or copy the file again",
            )
    notes = list(odd)
    if "MARKER_NAMES" in header:
        names = unique_names([n for n in header["MARKER_NAMES"] if n], "marker", notes)
        extra = width - 3 * len(names)
        if extra not in (0, 1, 2):
            raise DataError(f"{width} columns for {len(names)} markers", where=where)
        start, times = 0.0, None
        if extra == 2:
            rate, start, times = rate_of(numbers[:, 1], where)
        places = numbers[:, extra:].reshape(len(numbers), -1, 3) * 1e-3
        places[(places == 0.0).all(axis=2)] = np.nan
        markers = {n: Marker(places[:, i], rate, start, times) for i, n in enumerate(names)}
        return Trial(
            where, markers=markers, source="Qualisys TSV", checksum=checksum, notes=tuple(notes)
        )
    labels = [cell.upper().replace(" ", "_") for cell in split(lines[at - 1], "\t")]
    at_force = [labels.index(f"FORCE_{a}") if f"FORCE_{a}" in labels else -1 for a in "XYZ"]
    if min(at_force) < 0:
        raise DataError("no columns Force_X, Force_Y, Force_Z and no markers", where=where)
    corners = np.array(
        [
            [float((header.get(f"FORCE_PLATE_CORNER_{c}_{a}") or ["nan"])[0]) for a in "XYZ"]
            for c in _CORNERS
        ]
    ) * 1e-3  # fmt: skip
    place = None
    if all(f"COP_{a}" in labels for a in "XYZ"):
        place = numbers[:, [labels.index(f"COP_{a}") for a in "XYZ"]] * 1e-3
    name = " ".join(header.get("FORCE_PLATE_NAME", [])) or "1"
    force = numbers[:, at_force]
    plate = finished_plate(
        name if name.startswith("plate") else f"plate {name}",
        force,
        rate=rate,
        up=np.array([0.0, 0.0, 1.0]),
        centre_of_pressure=place,
        corners=corners if np.isfinite(corners).all() else None,
        kind="Qualisys TSV, taken as laboratory axes",
        subtract_baseline=subtract_baseline,
    )
    channels = {
        label: Channel(numbers[:, i], "N" if label.startswith("FORCE") else "", rate)
        for i, label in enumerate(unique_names(labels, "column", notes)[:width])
    }
    return Trial(
        where,
        channels=channels,
        plates=(plate,),
        source="Qualisys TSV",
        checksum=checksum,
        notes=tuple(notes),
    )
