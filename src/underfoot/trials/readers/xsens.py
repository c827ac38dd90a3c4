"""Xsens MVNX: segments of the body by inertial sensors, with the heels and toes of the feet."""

from collections.abc import Iterator
from xml.etree import ElementTree

import numpy as np

from underfoot.core.remark import Message

from ..recording.trial import Trial, Vertical
from .draft import RecordingDraft


def read_mvnx(draft: RecordingDraft) -> Trial:
    """Return the origins of segments and the points of both feet as markers (m, z up).

    A point of a foot is origin + R(q) p, with its place p in the segment and the quaternion q
    (w, x, y, z) of sensor to laboratory. Frames of calibration (identity, T pose) are left out.
    """
    if b"<!ENTITY" in draft.data:
        raise draft.error("holds XML entities, which no MVNX needs")
    try:
        root = ElementTree.fromstring(draft.data)
    except ElementTree.ParseError as error:
        raise draft.error(f"not valid XML ({error})", remedy="Export it again") from error

    def every(place: ElementTree.Element, name: str) -> Iterator[ElementTree.Element]:
        return (element for element in place.iter() if element.tag.rpartition("}")[2] == name)

    subject = next(every(root, "subject"), None)
    frames = [f for f in every(root, "frame") if f.get("type", "normal") == "normal"]
    segments = list(every(root, "segment"))
    if subject is None or not frames or not segments:
        raise draft.error("holds no frames of a subject")
    try:
        draft.rate = float(subject.get("frameRate", "nan"))
    except ValueError:
        draft.rate = np.nan
    if not 0 < draft.rate < 1e4:
        raise draft.error("the subject has no frameRate")

    def numbers(text: str, count: int, what: str) -> np.ndarray:
        try:
            row = np.array(text.split(), dtype=float)
        except ValueError:
            row = np.empty(0)
        if row.size != count:
            raise draft.error(
                Message("damaged: {what} is not {count} numbers", what=what, count=count),
                remedy="Export it again",
            )
        return row

    def values(name: str, width: int) -> np.ndarray:
        texts = [next((element.text or "" for element in every(f, name)), "") for f in frames]
        what = Message("{name} of a frame", name=name)
        rows = [numbers(text, width * len(segments), what) for text in texts]
        return np.array(rows).reshape(len(rows), len(segments), width)

    draft.up = Vertical((0.0, 0.0, 1.0), "z as MVN has it")
    position = values("position", 3)
    turn = values("orientation", 4) if any(True for _ in every(frames[0], "orientation")) else None
    for i, segment in enumerate(segments):
        label = segment.get("label", f"segment {i + 1}")
        draft.marker(label, position[:, i])
        for point in every(segment, "point") if "Foot" in label else ():
            place = next(every(point, "pos_b"), None)
            if turn is not None and place is not None and place.text:
                what = Message("pos_b of a point of {label}", label=label)
                q, p = turn[:, i], numbers(place.text, 3, what)
                twice = 2.0 * np.cross(q[:, 1:], p)
                moved = p + q[:, :1] * twice + np.cross(q[:, 1:], twice)
                name = f"{label.removesuffix('Foot')} {point.get('label', '').removeprefix('p')}"
                draft.marker(name.strip(), position[:, i] + moved)
    return draft.trial("Xsens MVNX")
