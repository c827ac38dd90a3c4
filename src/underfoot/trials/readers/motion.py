"""OpenSim motion and storage files (.mot, .sto): tables with a header; ground reactions in them."""

import re

import numpy as np

from ..trial import Trial
from .draft import Draft
from .text import split

# ground_force_vx, 1_ground_force_vx, R_ground_force_vx, ground_force_1_vx, FP1_vx ...
_GROUND = re.compile(r"^(?P<base>.*?)_?(?P<kind>[vp][xyz])$")
_REACTION = re.compile(r"ground|grf|force|fp|plate", re.IGNORECASE)


def read_motion(draft: Draft) -> Trial:
    """Return the table of a .mot or .sto file as a trial; ground reactions become plates.

    OpenSim's ground reactions are forces on the body in ground axes, y up, N and m.
    """
    lines = draft.lines()
    ends = (i for i, x in enumerate(lines[:200]) if x.strip().casefold().startswith("endheader"))
    end = next(ends, None)
    if end is None:
        raise draft.error("not a motion file", allowed="a header closed by endheader")
    header = _header(lines[:end])
    at = next((i for i in range(end + 1, len(lines)) if lines[i].strip()), None)
    if at is None:
        raise draft.error("truncated: the column names are missing")
    delimiter = "\t" if "\t" in lines[at] else ""
    labels = split(lines[at].rstrip(), delimiter)
    if labels[0].casefold() not in ("time", "frame", "t"):
        raise draft.error(f'the first column is "{labels[0]}", not time')
    names = draft.names(labels, "column")
    rows = [line.strip() for line in lines[at + 1 :]]
    numbers = draft.table(rows, delimiter, len(labels), at + 2)
    draft.count(header.get("nrows", ""), len(numbers), "nrows")
    draft.count(header.get("ncolumns", ""), len(labels), "ncolumns")
    draft.clock(numbers[:, 0])
    degrees = header.get("indegrees", "").casefold() in ("yes", "true", "1")
    for i, name in enumerate(names[1:], start=1):
        draft.channel(name, numbers[:, i], note="angles in degrees" if degrees else "")
    if draft.times is None:
        _plates(draft, labels, numbers)
    else:
        draft.notes.append("samples are not equally spaced: no plates were made")
    return draft.trial("OpenSim motion")


def _header(lines: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for line in lines:
        key, separator, value = line.partition("=")
        words = line.split()
        if separator:
            found[key.strip().casefold()] = value.strip()
        elif len(words) == 2 and words[0].casefold() in ("datarows", "datacolumns"):
            found["n" + words[0].casefold().removeprefix("data")] = words[1]  # the older form
    return found


def _plates(draft: Draft, labels: list[str], numbers: np.ndarray) -> None:
    groups: dict[str, dict[str, int]] = {}
    for i, label in enumerate(labels[1:], start=1):
        match = _GROUND.match(label)
        if match and _REACTION.search(match["base"]):
            groups.setdefault(match["base"], {}).setdefault(match["kind"], i)
    for columns in groups.values():
        if not {"vx", "vy", "vz"} <= columns.keys():
            continue
        force = numbers[:, [columns["vx"], columns["vy"], columns["vz"]]]
        place = None
        if {"px", "py", "pz"} <= columns.keys():
            place = numbers[:, [columns["px"], columns["py"], columns["pz"]]]
            place[force[:, 1] < 20.0] = np.nan
        kind = f"ground reaction ({labels[columns['vx']]})"
        draft.plate(force, up=np.eye(3)[1], centre_of_pressure=place, kind=kind)
