"""Cortex .forces files: force and centre of pressure of several plates as text."""

import re

import numpy as np

from ..trial import Trial
from .draft import Draft
from .text import number_after, split

_LENGTH = 1e-3  # Cortex writes positions in mm, moments in N mm
_COLUMNS = ("FX", "FY", "FZ", "X", "Y", "Z", "MZ")


def read_cortex_forces(draft: Draft) -> Trial:
    """Return the plates of a Cortex .forces file as a trial.

    The forces are those on the foot in laboratory axes. The vertical axis is the one that
    carries the load.
    """
    lines = draft.lines()
    if len(lines) < 6 or "[force data]" not in lines[0].casefold():
        raise draft.error("not a Cortex file", allowed="a first line [Force Data]")
    header = {line.split("=")[0].strip().casefold(): line for line in lines[1:20] if "=" in line}
    for key in ("samplerate", "numberofsamples"):
        if key not in header:
            raise draft.error(f"the header has no {key}")
    draft.rate = number_after(header["samplerate"], draft.name)
    expected = number_after(header["numberofsamples"], draft.name)
    if not 0 < draft.rate < 1e6:
        raise draft.error(f"SampleRate is {draft.rate:g}", allowed="a positive rate in Hz")
    at = next((i for i, line in enumerate(lines[:30]) if line.startswith("#")), None)
    if at is None:
        raise draft.error("truncated: the column names are missing")
    labels = split(lines[at].lstrip("#"), "\t")
    names = draft.names(labels, "column")
    numbers = draft.table(lines[at + 1 :], "\t", len(labels), at + 2)
    draft.count(str(int(expected)), len(numbers))
    index = {label.upper(): i for i, label in enumerate(labels)}
    suffixes = [m[1] for m in (re.match(r"^FX(\d+)$", label.upper()) for label in labels) if m]
    complete = [s for s in suffixes if all(name + s in index for name in _COLUMNS)]
    if not complete:
        raise draft.error("no plate has all of FX FY FZ X Y Z MZ")
    forces = {s: numbers[:, [index[name + s] for name in _COLUMNS[:3]]] for s in complete}
    load = np.nansum([np.abs(force).sum(axis=0) for force in forces.values()], axis=0)
    up = np.eye(3)[int(np.argmax(load))]
    for s, force in forces.items():
        place = numbers[:, [index[name + s] for name in _COLUMNS[3:6]]] * _LENGTH
        place[~(np.abs(force @ up) > 20.0)] = np.nan
        kind = "Cortex force and centre of pressure"
        draft.plate(force, f"plate {s}", up=up, centre_of_pressure=place, kind=kind)
    for i, name in enumerate(names[1:], start=1):
        draft.channel(name, numbers[:, i], unit="N" if name.upper().startswith("F") else "")
    return draft.trial("Cortex forces")
