"""BioWare text exports (Kistler): force plates as text, force on the plate in plate axes."""

import numpy as np

from ..trial import Trial
from .draft import Draft
from .text import is_number, split

_CENTRE = ("AX", "AY")


def read_bioware(draft: Draft) -> Trial:
    """Return the plates of a BioWare text export as a trial.

    BioWare writes the force **on the plate** in Kistler's axes (z into the floor). On the foot
    that is -Fx, -Fy and Fz upward; Fx and Fy are turned here, which a C3D export of the same
    recording confirms.
    """
    lines = [line.rstrip("\t ") for line in draft.lines()]
    heads = (i for i, line in enumerate(lines[:80]) if line.casefold().startswith("abs time"))
    at = next(heads, None)
    if at is None:
        raise draft.error("not a BioWare export", allowed='a column "abs time (s)"')
    labels = split(lines[at], "\t")
    first, units = at + 1, [""] * len(labels)
    if first < len(lines):
        cells = split(lines[first], "\t")
        if cells and not is_number(cells[0].replace(",", ".")):
            units = (cells + units)[: len(labels)]
            first += 1
    names = draft.names(labels, "column")
    numbers = draft.table(lines[first:], "\t", len(labels), first + 1)
    draft.clock(numbers[:, 0])
    if draft.times is not None:
        raise draft.error("the samples are not equally spaced")
    for i in range(1, len(labels)):
        default = "N" if labels[i].strip("|").upper().startswith("F") else "m"
        draft.channel(names[i], numbers[:, i], units[i], unit=default)
    kinds = [label.upper()[:2] for label in labels]
    for i in range(1, len(labels) - 2):
        if kinds[i : i + 3] != ["FX", "FY", "FZ"]:
            continue
        columns = [draft.channels[name].values for name in names[i : i + 3]]
        force = np.column_stack((-columns[0], -columns[1], columns[2]))
        following = kinds[i + 3 : i + 6]
        place = None
        if set(_CENTRE) <= set(following):
            x, y = (draft.channels[names[i + 3 + following.index(a)]].values for a in _CENTRE)
            place = np.column_stack((x, y, np.zeros(len(x))))
            place[~(np.abs(force[:, 2]) > 20.0)] = np.nan
        kind = "BioWare text, force on the plate turned to the foot, plate axes"
        draft.plate(force, up=np.eye(3)[2], centre_of_pressure=place, kind=kind)
    if not draft.plates:
        raise draft.error("no plate has Fx, Fy and Fz")
    return draft.trial("BioWare text")
