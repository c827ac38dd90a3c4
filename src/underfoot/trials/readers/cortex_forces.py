"""Cortex .forces files: force and centre of pressure of several plates as text."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..plates import finished_plate
from ..trial import Channel, Trial
from .text import decoded, lines_of, number_after, split, table, unique_names

_LENGTH = 1e-3  # Cortex writes positions in mm, moments in N mm
_COLUMNS = ("FX", "FY", "FZ", "X", "Y", "Z", "MZ")


def read_cortex_forces(
    data: bytes, path: Path, checksum: str, *, subtract_baseline: bool = True
) -> Trial:
    """Return the plates of a Cortex .forces file as a trial.

    The forces are those on the foot in laboratory axes. The vertical axis is the one that
    carries the load.

    Errors
    ------
    DataError
        Not such a file, truncated, or inconsistent with its own header.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    if len(lines) < 6 or "[force data]" not in lines[0].casefold():
        raise DataError("not a Cortex file", where=where, allowed="a first line [Force Data]")
    header = {line.split("=")[0].strip().casefold(): line for line in lines[1:20] if "=" in line}
    for key in ("samplerate", "numberofsamples"):
        if key not in header:
            raise DataError(f"the header has no {key}", where=where)
    rate = number_after(header["samplerate"], where)
    expected = number_after(header["numberofsamples"], where)
    if not 0 < rate < 1e6:
        raise DataError(f"SampleRate is {rate:g}", where=where, allowed="a positive rate in Hz")
    at = next((i for i, line in enumerate(lines[:30]) if line.startswith("#")), None)
    if at is None:
        raise DataError("truncated: the column names are missing", where=where)
    notes: list[str] = []
    labels = split(lines[at].lstrip("#"), "\t")
    numbers, odd = table(
        [line for line in lines[at + 1 :] if line.strip()],
        "\t",
        len(labels),
        where,
        first_line=at + 2,
    )
    if len(numbers) != int(expected):
        raise DataError(
            f"truncated or damaged: {int(expected)} samples announced, {len(numbers)} found",
            where=where,
            remedy="Export or copy the file again",
        )
    index = {label.upper(): i for i, label in enumerate(labels)}
    suffixes = [m[1] for m in (re.match(r"^FX(\d+)$", label.upper()) for label in labels) if m]
    complete = [s for s in suffixes if all(name + s in index for name in _COLUMNS)]
    if not complete:
        raise DataError("no plate has all of FX FY FZ X Y Z MZ", where=where)
    forces = {s: numbers[:, [index[name + s] for name in _COLUMNS[:3]]] for s in complete}
    load = np.nansum([np.abs(force).sum(axis=0) for force in forces.values()], axis=0)
    up = np.zeros(3)
    up[int(np.argmax(load))] = 1.0
    plates = []
    for s in complete:
        place = numbers[:, [index[name + s] for name in _COLUMNS[3:6]]] * _LENGTH
        place[~(np.abs(forces[s] @ up) > 20.0)] = np.nan
        plates.append(
            finished_plate(
                f"plate {s}",
                forces[s],
                rate=rate,
                up=up,
                centre_of_pressure=place,
                kind="Cortex force and centre of pressure",
                subtract_baseline=subtract_baseline,
            )
        )
    names = unique_names(labels, "column", notes)
    channels = {
        name: Channel(numbers[:, i], "N" if name.upper().startswith("F") else "", rate)
        for i, name in enumerate(names)
        if i > 0
    }
    return Trial(
        where,
        channels=channels,
        plates=tuple(plates),
        source="Cortex forces",
        checksum=checksum,
        notes=(*notes, *odd),
    )
