"""Pose systems' JSON: body points in space over time (OpenPose, Theia, OpenCap and alike)."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from underfoot.core.remark import Message
from underfoot.core.text import decode_text

from ..recording.trial import Event, Trial
from .draft import RecordingDraft

_RATE = ("fps", "frame_rate", "framerate", "frequency", "rate", "sampling_rate")
_POINTS = ("markers", "keypoints", "points", "joints", "landmarks")
# BODY_25 of OpenPose: the points that matter for steps.
_BODY_25 = {
    8: "MidHip", 9: "RHip", 11: "RAnkle", 12: "LHip", 14: "LAnkle", 19: "LBigToe", 21: "LHeel",
    22: "RBigToe", 24: "RHeel",
}  # fmt: skip
_MOST = 5_000_000


def read_pose_json(draft: RecordingDraft) -> Trial:
    """Return the points of a JSON file as markers.

    Understood: ``{"fps": 100, "unit": "m", "markers": {"LHeel": [[x, y, z], ...]}}`` (also
    "keypoints", "points", "joints"); a list "frames" of ``{"time": t, "markers": {"LHeel": [x, y,
    z]}}``; gait events ("events", or "heel_strikes" and "toe_offs"); OpenPose frames with
    ``pose_keypoints_3d``. Points in pixels are refused: without a length there is no speed.
    """
    try:
        content: Any = json.loads(decode_text(draft.data, draft.name))
    except (ValueError, RecursionError) as error:
        raise draft.error("not valid JSON", remedy="Export it again") from error
    top: Mapping[str, Any] = content if isinstance(content, Mapping) else {"frames": content}
    if "people" in top:
        raise draft.error(
            "a single frame of OpenPose holds no motion",
            remedy="Join the frames in one file, in space (three coordinates)",
        )
    points, times = _points(top), None
    draft.events = _events(draft, top)
    if points is None and draft.events and "frames" not in top:
        return draft.trial("JSON of events")
    if points is None:
        points, times = _from_frames(draft, top.get("frames"))
    rate = next((float(top[k]) for k in _RATE if isinstance(top.get(k), int | float)), None)
    if times is not None and len(times) > 1:
        draft.clock(times)
    elif rate is None or not 0 < rate < 1e6:
        raise draft.error("no frame rate and no times", allowed='"fps": 100')
    else:
        draft.rate = rate
    places = {}
    for name, path_of in points.items():
        try:
            rows = [[np.nan] * 3 if v is None else list(v)[:3] for v in path_of]
            values = np.array(rows, dtype=float)
        except (TypeError, ValueError):  # a coordinate is missing, or a word
            values = np.empty((0, 0))
        if values.ndim != 2 or values.shape[1] != 3 or values.size > _MOST:
            raise draft.error(Message("{name} has no three coordinates a frame", name=name))
        places[str(name)] = values
    if len({len(v) for v in places.values()}) != 1:
        raise draft.error("points have different numbers of frames")
    written = str(top.get("unit", top.get("units", "")))
    factor = draft.length_unit(written, np.concatenate(list(places.values()) or [np.empty((0, 3))]))
    for name, place in places.items():
        draft.marker(name, place * factor)
    return draft.trial("JSON")


_EVENTS = {
    "heel strike": "heel contact", "hs": "heel contact", "initial contact": "heel contact",
    "ic": "heel contact", "foot strike": "heel contact", "heel contact": "heel contact",
    "toe off": "toe off", "to": "toe off", "foot off": "toe off", "final contact": "toe off",
}  # fmt: skip


def _events(draft: RecordingDraft, top: Mapping[str, Any]) -> tuple[Event, ...]:
    """Return gait events: a list of objects, or lists of times by kind (heel_strikes ...).

    An object has "time" (s), or "frame" with a rate in the file; "type", "event" or "name"; "side".
    """
    rate = next((float(top[k]) for k in _RATE if isinstance(top.get(k), int | float)), None)
    listed: list[Mapping[str, Any]] = []
    for key, value in {**top, **(e if isinstance(e := top.get("events"), Mapping) else {})}.items():
        kind = key.replace("_", " ").casefold().removesuffix("s").strip()
        if isinstance(value, list) and kind in {*_EVENTS, "event"}:
            listed += [
                {"type": kind, **one} if isinstance(one, Mapping) else {"type": kind, "time": one}
                for one in value
            ]
    found = []
    for number, one in enumerate(listed, start=1):
        written = next((str(one[k]) for k in ("event", "name", "type") if k in one), "")
        name = _EVENTS.get(written.replace("_", " ").casefold(), written)
        when = one.get("time", one.get("time_s"))
        if when is None and rate and isinstance(one.get("frame"), int | float):
            when = float(one["frame"]) / rate
        if not isinstance(when, int | float) or not np.isfinite(when):
            raise draft.error(
                Message("event {number} has no time", number=number),
                allowed='"time" in s, or "frame" and "fps"',
            )
        side = str(one.get("side", one.get("foot", ""))).casefold()
        side = {"l": "left", "r": "right"}.get(side, side)
        found.append(Event(name, float(when), side, f'file, "{written}"'))
    return tuple(sorted(found, key=lambda event: event.time))


def _points(content: Mapping[str, Any]) -> Mapping[str, Any] | None:
    return next((content[k] for k in _POINTS if isinstance(content.get(k), Mapping)), None)


def _from_frames(
    draft: RecordingDraft, frames: Any
) -> tuple[dict[str, list[Any]], np.ndarray | None]:
    if not isinstance(frames, Sequence) or not frames or isinstance(frames, str):
        raise draft.error("no points and no frames", allowed=", ".join(_POINTS))
    points: dict[str, list[Any]] = {}
    times = []
    for number, frame in enumerate(frames):
        if not isinstance(frame, Mapping):
            raise draft.error(Message("frame {number} is no object", number=number + 1))
        own = _points(frame)
        if own is None:
            own = _open_pose(draft, frame)
        for name in own:
            points.setdefault(str(name), [None] * number)
        for name, path_of in points.items():
            path_of.append(own.get(name))
        if isinstance(frame.get("time"), int | float):
            times.append(float(frame["time"]))
    return points, np.array(times) if len(times) == len(frames) else None


def _open_pose(draft: RecordingDraft, frame: Mapping[str, Any]) -> dict[str, Any]:
    people = frame.get("people")
    person = people[0] if isinstance(people, list) and people else {}
    flat = person.get("pose_keypoints_3d") if isinstance(person, Mapping) else None
    if isinstance(people, list) and not people:
        return {}
    if not flat:
        remedy = "Export points in space (pose_keypoints_3d)"
        raise draft.error("the points are in pixels of one picture", remedy=remedy)
    rows = [flat[i : i + 4] for i in range(0, len(flat) - 3, 4)]
    seen = {name: rows[i] for i, name in _BODY_25.items() if i < len(rows)}
    return {name: row[:3] if row[3] > 0 else None for name, row in seen.items()}
