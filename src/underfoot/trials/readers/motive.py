"""OptiTrack Motive's CSV: markers and rigid bodies under five or six rows of headings."""

import csv

from ..recording.trial import Trial, Vertical
from .draft import RecordingDraft

_KINDS = ("marker", "bone marker", "rigid body marker", "rigid body", "bone")


def read_motive(draft: RecordingDraft) -> Trial:
    """Return markers, and the origins of rigid bodies and bones, of a Motive export as markers.

    Where labelled and solved markers have one name the labelled one counts. Motive's y axis is up
    unless it was exported otherwise.
    """
    lines = draft.lines()
    cells = next(csv.reader(lines[:1]))
    header = {
        k.strip().casefold(): v.strip() for k, v in zip(cells[::2], cells[1::2], strict=False)
    }
    rows = [(i, [c.strip() for c in row]) for i, row in enumerate(csv.reader(lines[1:20]), 2)]
    at = next((i for i, row in rows if [c.casefold() for c in row[:1]] == ["frame"]), None)
    if at is None:
        raise draft.error("truncated: the row of axes (Frame, Time) is missing")
    heads = [row for i, row in rows if i < at and any(row)]
    axes = next(row for i, row in rows if i == at)
    width = len(axes)
    heads = [(row + [""] * width)[:width] for row in heads]

    def row_with(*headings: str) -> list[str]:
        rows = (row for row in heads if any(c.casefold() in headings for c in row))
        return next(rows, [""] * width)

    kinds, what = row_with(*_KINDS), row_with("position")
    names = row_with("name") if any("Name" in row[:2] for row in heads) else [""] * width
    if not any(names):  # older versions leave the heads of the rows empty: names follow the kinds
        place = heads.index(kinds) + 1 if kinds in heads else 0
        names = heads[place] if place < len(heads) else names
    numbers = draft.table(lines[at:], ",", width, at + 1)
    draft.clock(numbers[:, 1])
    places = [i for i in range(2, width) if what[i].casefold() == "position"]
    scale = draft.length_unit(header.get("length units", ""), numbers[:, places])
    groups: dict[tuple[str, str], dict[str, int]] = {}
    for i in range(2, width):
        if what[i].casefold() == "position" and kinds[i].casefold() in _KINDS:
            key = kinds[i].casefold(), names[i]
            groups.setdefault(key, {}).setdefault(axes[i].upper(), i)
    for (_, name), at_axis in sorted(groups.items(), key=lambda one: _KINDS.index(one[0][0])):
        label = name.rsplit(":", 1)[-1]
        label = name if label in draft.markers else label
        if set("XYZ") <= at_axis.keys() and label not in draft.markers:
            draft.marker(label, numbers[:, [at_axis[a] for a in "XYZ"]] * scale)
    if not draft.markers:
        raise draft.error("no marker has a position", remedy="Export markers with their positions")
    draft.count(header.get("total exported frames", ""), len(numbers), "Total Exported Frames")
    draft.up = Vertical((0.0, 1.0, 0.0), "y as Motive has it")
    draft.settings["take"] = header.get("take name", "")
    return draft.trial("OptiTrack Motive CSV")
