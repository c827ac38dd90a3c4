"""Vicon Nexus CSV exports: a block of devices and a block of trajectories in one file."""

import re

import numpy as np

from underfoot.core import DataError

from ..trial import Trial
from .draft import Draft
from .text import is_number, split
from .unit_factors import si_unit

BLOCKS = ("devices", "trajectories", "model outputs", "joints", "segments")
_PLATE = re.compile(r"^(?P<device>.*?)\s*-\s*(?P<what>force|moment|cop)$", re.IGNORECASE)


def read_vicon_csv(draft: Draft) -> Trial:
    """Return devices (force plates, channels) and trajectories of a Nexus export as one trial."""
    lines = draft.lines()
    kinds = [line.strip(' ,"').casefold() for line in lines]
    starts = [i for i, kind in enumerate(kinds) if kind in BLOCKS]
    if not starts:
        raise draft.error("no block of devices or trajectories")
    for start, stop in zip(starts, [*starts[1:], len(lines)], strict=True):
        names, axes, units, numbers = _block(draft, lines[start:stop], start)
        if kinds[start] == "devices":
            _devices(draft, names, axes, units, numbers)
        elif kinds[start] == "trajectories":
            for name in dict.fromkeys(names):
                at = [i for i, n in enumerate(names) if n == name]
                if name and len(at) == 3:
                    unit = si_unit(units[at[0]]) or ("m", 1e-3, 0.0)
                    draft.marker(name.rsplit(":", 1)[-1], numbers[:, at] * unit[1])
        else:
            draft.notes.append(f"the block of {kinds[start]} was left out")
    return draft.trial("Vicon CSV")


def _block(
    draft: Draft, lines: list[str], start: int
) -> tuple[list[str], list[str], list[str], np.ndarray]:
    rate = split(lines[1], ",")[0] if len(lines) > 1 else ""
    if not is_number(rate) or not 0 < float(rate) < 1e6 or len(lines) < 6:
        where = f"{draft.name}, line {start + 2}"
        raise DataError("a block has no rate or no rows", where=where)
    draft.rate = float(rate)
    names, axes, units = (split(line, ",") for line in lines[2:5])
    width = len(axes)
    names, units = ((row + [""] * width)[:width] for row in (names, units))
    for i in range(3, width):
        names[i] = names[i] or names[i - 1]  # a name stands over the first of its columns only
    return names, axes, units, draft.table(lines[5:], ",", width, start + 6)


def _devices(
    draft: Draft, names: list[str], axes: list[str], units: list[str], numbers: np.ndarray
) -> None:
    whole = [f"{name} {axis}".strip() for name, axis in zip(names, axes, strict=True)]
    labels = draft.names(whole, "column")
    groups: dict[str, dict[str, list[np.ndarray]]] = {}
    for i in range(2, len(labels)):
        draft.channel(labels[i], numbers[:, i], units[i])
        match = _PLATE.match(names[i])
        if match:
            parts = groups.setdefault(match["device"], {})
            parts.setdefault(match["what"].casefold(), []).append(draft.channels[labels[i]].values)
    for device, parts in groups.items():
        if len(parts.get("force", [])) != 3:
            continue
        place = parts.get("cop", [])
        force = np.column_stack(parts["force"])
        draft.plate(
            force,
            up=np.eye(3)[int(np.argmax(np.nansum(np.abs(force), axis=0)))],
            centre_of_pressure=np.column_stack(place) if len(place) == 3 else None,
            kind=f"Vicon CSV, {device}",
        )
