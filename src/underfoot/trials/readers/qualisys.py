"""Qualisys TSV exports: marker paths, and one force plate a file."""

import numpy as np

from ..trial import Trial
from .draft import Draft
from .text import is_number, split

_CORNERS = ("POSX_POSY", "NEGX_POSY", "NEGX_NEGY", "POSX_NEGY")


def read_qualisys(draft: Draft) -> Trial:
    """Return the markers or the force plate of a Qualisys TSV file as a trial.

    Lengths are mm. Forces are taken as exported, in laboratory axes (QTM can also export plate
    axes: choose "global" there).
    """
    lines = draft.lines()
    header: dict[str, list[str]] = {}
    at = 0
    while at < len(lines) and (cells := split(lines[at], "\t")) and not is_number(cells[0]):
        header.setdefault(cells[0].upper(), cells[1:])
        at += 1

    def first(key: str) -> str:
        return (header.get(key) or [""])[0]

    draft.rate = float(first("FREQUENCY") or "nan")
    if not 0 < draft.rate < 1e6:
        raise draft.error("the header has no FREQUENCY")
    rows = [line.rstrip("\t ") for line in lines[at:] if line.strip()]
    if not rows:
        raise draft.error("truncated: there are no rows")
    width = max(row.count("\t") for row in rows) + 1
    numbers = draft.table(rows, "\t", width, at + 1)
    for key in ("NO_OF_FRAMES", "NO_OF_SAMPLES"):
        draft.count(first(key), len(numbers), key)
    if "MARKER_NAMES" in header:
        names = draft.names([n for n in header["MARKER_NAMES"] if n], "marker")
        extra = width - 3 * len(names)
        if extra not in (0, 1, 2):
            raise draft.error(f"{width} columns for {len(names)} markers")
        if extra == 2:
            draft.clock(numbers[:, 1])
        places = numbers[:, extra:].reshape(len(numbers), -1, 3) * 1e-3
        places[(places == 0.0).all(axis=2)] = np.nan
        for i, name in enumerate(names):
            draft.marker(name, places[:, i])
        return draft.trial("Qualisys TSV")
    labels = [cell.upper().replace(" ", "_") for cell in split(lines[at - 1], "\t")]

    def triple(kind: str) -> np.ndarray | None:
        wanted = [f"{kind}_{axis}" for axis in "XYZ"]
        known = set(wanted) <= set(labels)
        return numbers[:, [labels.index(label) for label in wanted]] if known else None

    force, place = triple("FORCE"), triple("COP")
    if force is None:
        raise draft.error("no columns Force_X, Force_Y, Force_Z and no markers")
    keys = [[f"FORCE_PLATE_CORNER_{corner}_{axis}" for axis in "XYZ"] for corner in _CORNERS]
    corners = 1e-3 * np.array([[float((header.get(k) or ["nan"])[0]) for k in row] for row in keys])
    name = " ".join(header.get("FORCE_PLATE_NAME", [])) or "1"
    draft.plate(
        force,
        name if name.startswith("plate") else f"plate {name}",
        up=np.eye(3)[2],
        centre_of_pressure=None if place is None else place * 1e-3,
        corners=corners if np.isfinite(corners).all() else None,
        kind="Qualisys TSV, taken as laboratory axes",
    )
    for i, label in enumerate(draft.names(labels, "column")[:width]):
        draft.channel(label, numbers[:, i], unit="N" if label.startswith("FORCE") else "")
    return draft.trial("Qualisys TSV")
