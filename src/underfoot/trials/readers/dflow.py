"""Text exports of D-Flow (Motek treadmills): markers, plates and analog channels in one table."""

import re

import numpy as np

from ..recording.trial import Trial, Vertical
from .draft import RecordingDraft
from .text import split

_COLUMN = re.compile(r"^(?P<name>.+)\.(?P<kind>Pos|Cop|For|Mom)(?P<axis>[XYZ])$")
_UP = Vertical((0.0, 1.0, 0.0), "y as D-Flow has it")


def read_dflow(draft: RecordingDraft) -> Trial:
    """Return markers (m), plates (N, m) and channels of D-Flow's mocap module as a trial.

    D-Flow stamps each frame when it arrives, a few ms early or late, sometimes several at once;
    the frames themselves are even. So time is the frame's number over the mean rate, and a frame
    that is missing has no numbers. D-Flow repeats the last place of a marker that it lost: what
    stands still to the last digit from one frame of the cameras to the next was not seen.

    Source: documentation of GaitAnalysisToolKit 0.2, Motek module.
    """
    lines = [line for line in draft.lines() if line.strip()]
    labels = split(lines[0].lstrip("% "), "\t")
    rows = [line.rstrip("\t ") for line in lines[1:]]
    numbers = draft.table(rows, "\t", len(labels), 2)
    stamps = numbers[:, 0]
    frames = np.arange(float(len(numbers)))
    if labels[1].casefold() == "framenumber":
        frames = numbers[:, 1] - numbers[0, 1]
        if (np.diff(frames) < 1).any():
            raise draft.error("the frame numbers do not increase")
        if len(frames) <= frames[-1]:
            count = int(frames[-1]) + 1 - len(frames)
            draft.notes.append(f"{count} frames are not in the file: they have no numbers")
            whole = np.full((int(frames[-1]) + 1, numbers.shape[1]), np.nan)
            whole[frames.astype(int)] = numbers
            numbers = whole
    if len(frames) < 2 or not stamps[-1] > stamps[0]:
        raise draft.error("the time stamps do not increase")
    draft.rate, draft.start = float(frames[-1] / (stamps[-1] - stamps[0])), float(stamps[0])
    draft.notes.append("time from the frame numbers: D-Flow stamps frames when they arrive")
    places: dict[tuple[str, str], dict[str, np.ndarray]] = {}
    for i, label in enumerate(labels):
        match = _COLUMN.match(label)
        if match:
            places.setdefault((match["name"], match["kind"]), {})[match["axis"]] = numbers[:, i]
        elif i > 1 or label.casefold() not in ("timestamp", "framenumber"):
            draft.channel(label, numbers[:, i])
    known = {
        key: np.column_stack([t[a] for a in "XYZ"]) for key, t in places.items() if len(t) == 3
    }
    draft.up, draft.every_repeat = _UP, True
    for (name, kind), values in known.items():
        if kind == "Pos":
            draft.marker(name, values)
        elif kind == "For":
            place = known.get((name, "Cop"))
            draft.plate(values, name, centre_of_pressure=place, kind="D-Flow")
    left = sorted({name for (name, kind), t in places.items() if len(t) < 3})
    if left:
        draft.notes.append(f"without three components, left out: {', '.join(left)}")
    return draft.trial("D-Flow text")
