"""Vicon Nexus CSV exports: a block of devices and a block of trajectories in one file."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..plates import finished_plate
from ..trial import Channel, Marker, Plate, Trial
from .text import decoded, is_number, lines_of, split, table, unique_names
from .unit_factors import si_unit

BLOCKS = ("devices", "trajectories", "model outputs", "joints", "segments")
_PLATE = re.compile(r"^(?P<device>.*?)\s*-\s*(?P<what>force|moment|cop)$", re.IGNORECASE)


def read_vicon_csv(
    data: bytes, path: Path, checksum: str, *, subtract_baseline: bool = True
) -> Trial:
    """Return devices (force plates, channels) and trajectories of a Nexus export as one trial.

    Raises
    ------
    DataError
        No block, a block without rate or rows.
    """
    where = path.name
    lines = lines_of(decoded(data, where))
    starts = [i for i, line in enumerate(lines) if line.strip(' ,"').casefold() in BLOCKS]
    if not starts:
        raise DataError("no block of devices or trajectories", where=where)
    channels: dict[str, Channel] = {}
    plates: list[Plate] = []
    markers: dict[str, Marker] = {}
    notes: list[str] = []
    for start, stop in zip(starts, [*starts[1:], len(lines)], strict=True):
        kind = lines[start].strip(' ,"').casefold()
        rate, names, axes, units, numbers = _block(lines[start:stop], where, start, notes)
        if kind == "devices":
            _devices(names, axes, units, numbers, rate, channels, plates, notes, subtract_baseline)
        elif kind == "trajectories":
            for name in dict.fromkeys(names):
                at = [i for i, n in enumerate(names) if n == name]
                if not name or len(at) != 3:
                    continue
                unit = si_unit(units[at[0]]) or ("m", 1e-3, 0.0)
                markers[name.rsplit(":", 1)[-1]] = Marker(numbers[:, at] * unit[1], rate)
        else:
            notes.append(f"the block of {kind} was left out")
    return Trial(
        where,
        channels=channels,
        plates=tuple(plates),
        markers=markers,
        source="Vicon CSV",
        checksum=checksum,
        notes=tuple(dict.fromkeys(notes)),
    )


def _block(
    lines: list[str], where: str, start: int, notes: list[str]
) -> tuple[float, list[str], list[str], list[str], np.ndarray]:
    rate = split(lines[1], ",")[0] if len(lines) > 1 else ""
    if not is_number(rate) or not 0 < float(rate) < 1e6 or len(lines) < 6:
        raise DataError("a block has no rate or no rows", where=f"{where}, line {start + 2}")
    names, axes, units = (split(line, ",") for line in lines[2:5])
    rows = [line for line in lines[5:] if line.strip(" ,")]
    width = len(axes)
    padded = [(row + [""] * width)[:width] for row in (names, units)]
    for i in range(1, width):
        # A name stands over the first of its columns only.
        if not padded[0][i] and i > 2:
            padded[0][i] = padded[0][i - 1]
    numbers, odd = table(rows, ",", width, where, first_line=start + 6)
    notes += odd
    return float(rate), padded[0], axes, padded[1], numbers


def _devices(
    names: list[str],
    axes: list[str],
    units: list[str],
    numbers: np.ndarray,
    rate: float,
    channels: dict[str, Channel],
    plates: list[Plate],
    notes: list[str],
    subtract_baseline: bool,
) -> None:
    labels = unique_names(
        [f"{name} {axis}".strip() for name, axis in zip(names, axes, strict=True)], "column", notes
    )
    groups: dict[str, dict[str, list[int]]] = {}
    values = numbers.copy()
    for i in range(2, len(labels)):
        unit = si_unit(units[i]) if units[i] else None
        si, factor, offset = unit if unit else ("", 1.0, 0.0)
        values[:, i] = numbers[:, i] * factor + offset
        channels[labels[i]] = Channel(values[:, i], si, rate)
        match = _PLATE.match(names[i])
        if match:
            groups.setdefault(match["device"], {}).setdefault(match["what"].casefold(), []).append(
                i
            )
    for device, parts in groups.items():
        if len(parts.get("force", [])) != 3:
            continue
        place = parts.get("cop", [])
        force = values[:, parts["force"]]
        plates.append(
            finished_plate(
                f"plate {len(plates) + 1}",
                force,
                rate=rate,
                up=np.eye(3)[int(np.argmax(np.nansum(np.abs(force), axis=0)))],
                centre_of_pressure=values[:, place] if len(place) == 3 else None,
                kind=f"Vicon CSV, {device}",
                subtract_baseline=subtract_baseline,
            )
        )
