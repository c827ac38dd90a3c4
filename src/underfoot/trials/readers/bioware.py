"""BioWare text exports (Kistler): force plates as text, force on the plate in plate axes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..plates import finished_plate
from ..trial import Channel, Trial
from .text import decoded, is_number, lines_of, rate_of, split, table, unique_names
from .unit_factors import si_unit

_UP = np.array([0.0, 0.0, 1.0])
_CENTRE = ("AX", "AY")


def read_bioware(
    data: bytes, path: Path, checksum: str, *, subtract_baseline: bool = True
) -> Trial:
    """Return the plates of a BioWare text export as a trial.

    BioWare writes the force **on the plate** in Kistler's axes (z into the floor). On the foot
    that is -Fx, -Fy and Fz upward; Fx and Fy are turned here, which a C3D export of the same
    recording confirms.

    Errors
    ------
    DataError
        Not such a file, truncated, or no complete plate.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    at = next(
        (i for i, line in enumerate(lines[:80]) if line.casefold().startswith("abs time")), None
    )
    if at is None:
        raise DataError("not a BioWare export", where=where, allowed='a column "abs time (s)"')
    notes: list[str] = []
    labels = split(lines[at].rstrip("\t "), "\t")
    first, units = at + 1, [""] * len(labels)
    if first < len(lines):
        cells = split(lines[first].rstrip("\t "), "\t")
        if cells and not is_number(cells[0].replace(",", ".")):
            units = (cells + units)[: len(labels)]
            first += 1
    rows = [line.rstrip("\t ") for line in lines[first:] if line.strip()]
    numbers, odd = table(rows, "\t", len(labels), where, first_line=first + 1)
    rate, start, times = rate_of(numbers[:, 0], where)
    if times is not None:
        raise DataError("the samples are not equally spaced", where=where)
    names = unique_names(labels, "column", notes)
    channels: dict[str, Channel] = {}
    for i in range(1, len(labels)):
        default = "N" if labels[i].strip("|").upper().startswith("F") else "m"
        unit = si_unit(units[i]) if units[i] else (default, 1.0, 0.0)
        si, factor, offset = unit if unit else ("", 1.0, 0.0)
        channels[names[i]] = Channel(numbers[:, i] * factor + offset, si, rate, start)
    plates = []
    for i in range(1, len(labels) - 2):
        if [label.upper()[:2] for label in labels[i : i + 3]] != ["FX", "FY", "FZ"]:
            continue
        columns = [channels[name].values for name in names[i : i + 3]]
        force = np.column_stack((-columns[0], -columns[1], columns[2]))
        following = [label.upper()[:2] for label in labels[i + 3 : i + 6]]
        place = None
        if set(_CENTRE) <= set(following):
            x, y = (channels[names[i + 3 + following.index(name)]].values for name in _CENTRE)
            place = np.column_stack((x, y, np.zeros(len(x))))
            place[~(np.abs(force[:, 2]) > 20.0)] = np.nan
        plates.append(
            finished_plate(
                f"plate {len(plates) + 1}",
                force,
                rate=rate,
                start=start,
                up=_UP,
                centre_of_pressure=place,
                kind="BioWare text, force on the plate turned to the foot, plate axes",
                subtract_baseline=subtract_baseline,
            )
        )
    if not plates:
        raise DataError("no plate has Fx, Fy and Fz", where=where)
    return Trial(
        where,
        channels=channels,
        plates=tuple(plates),
        source="BioWare text",
        checksum=checksum,
        notes=(*notes, *odd),
    )
