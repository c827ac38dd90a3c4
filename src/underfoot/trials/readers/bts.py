"""BTS Bioengineering's ASCII (.emt): point tracks, force and EMG tracks, events."""

import numpy as np

from underfoot.core.remark import Message

from ..recording.trial import Event, Trial, Vertical
from .columns import trial_from_sheet
from .draft import RecordingDraft
from .sheet import Sheet
from .text import is_number, split

_EVENTS = {"RHS": ("heel contact", "right"), "LHS": ("heel contact", "left"),
           "RTO": ("toe off", "right"), "LTO": ("toe off", "left")}  # fmt: skip


def read_bts(draft: RecordingDraft) -> Trial:
    """Return the tracks of an .emt file as channels, plates and markers, or its events.

    Tracks ``name.X``, ``name.Y``, ``name.Z`` in a unit of length are markers, of force a plate;
    the measure unit of the header is that of all tracks. y is up.
    """
    lines = draft.lines()
    at = next((i for i, line in enumerate(lines) if i and _heads(line)), None)
    if at is None:
        raise draft.error("truncated: the column names are missing")
    pairs = [line.partition(":") for line in lines[:at] if ":" in line]
    header = {key.strip().casefold(): value.strip() for key, _, value in pairs}
    labels = split(lines[at].rstrip("\t "), "\t")
    rows = [line.rstrip("\t ") for line in lines[at + 1 :] if line.strip()]
    numbers = draft.table(rows, "\t", len(labels), at + 2)
    named = dict(zip(draft.names(labels, "track"), numbers.T, strict=True))
    if any(label.lstrip("e") in _EVENTS for label in labels):
        events = [
            Event(*_named_event(label, float(when)))
            for label, column in named.items()
            if label.lstrip("e") in _EVENTS
            for when in column[np.isfinite(column)]
        ]
        draft.events = tuple(sorted(events, key=lambda event: event.time))
        return draft.trial("BTS events")
    if "Time" not in named:
        kind = header.get("type", "table")
        raise draft.error(
            Message('"{kind}" is no recording in time', kind=kind), remedy="Export tracks"
        )
    draft.count(header.get("frames", ""), len(numbers), "Frames")
    draft.up = Vertical((0.0, 1.0, 0.0), "y as BTS has it")
    unit = header.get("measure unit", "")
    tracks = {key: column for key, column in named.items() if key.casefold() != "frame"}
    units = {key: "s" if key == "Time" else unit for key in tracks}
    return trial_from_sheet(draft, Sheet(draft.name, tracks, {}, units), "BTS ASCII")


def _heads(line: str) -> bool:
    cells = split(line, "\t")
    return len(cells) > 1 and ":" not in cells[0] and bool(cells[0]) and not is_number(cells[0])


def _named_event(label: str, when: float) -> tuple[str, float, str, str]:
    name, side = _EVENTS[label.lstrip("e")]
    return name, when, side, f'file, "{label}"'
