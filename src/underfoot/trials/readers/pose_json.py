"""Pose systems' JSON: body points in space over time (OpenPose, Theia, OpenCap and alike)."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError

from ..trial import Marker, Trial
from .text import decoded, rate_of
from .unit_factors import si_unit

_RATE = ("fps", "frame_rate", "framerate", "frequency", "rate", "sampling_rate")
_POINTS = ("markers", "keypoints", "points", "joints", "landmarks")
# BODY_25 of OpenPose: the points that matter for steps.
_BODY_25 = {
    8: "MidHip", 9: "RHip", 11: "RAnkle", 12: "LHip", 14: "LAnkle", 19: "LBigToe", 21: "LHeel",
    22: "RBigToe", 24: "RHeel",
}  # fmt: skip
_MOST = 5_000_000


def read_pose_json(data: bytes, path: Path, checksum: str) -> Trial:
    """Return the points of a JSON file as markers.

    Understood: ``{"fps": 100, "unit": "m", "markers": {"LHeel": [[x, y, z], ...]}}`` (also
    "keypoints", "points", "joints"); a list "frames" of ``{"time": t, "markers": {"LHeel": [x, y,
    z]}}``; OpenPose frames with ``pose_keypoints_3d``. Points in pixels are refused: without a
    length there is no speed.

    Raises
    ------
    DataError
        No JSON, no points in space, no rate.
    """
    where = path.name
    try:
        content: Any = json.loads(decoded(data, where))
    except (ValueError, RecursionError) as error:
        raise DataError("not valid JSON", where=where, remedy="Export it again") from error
    top: Mapping[str, Any] = content if isinstance(content, Mapping) else {"frames": content}
    if "people" in top:
        raise DataError(
            "a single frame of OpenPose holds no motion",
            where=where,
            remedy="Join the frames in one file, in space (three coordinates)",
        )
    points = next((top[k] for k in _POINTS if isinstance(top.get(k), Mapping)), None)
    times: np.ndarray | None = None
    if points is None:
        points, times = _from_frames(top.get("frames"), where)
    rate = next((float(top[k]) for k in _RATE if isinstance(top.get(k), int | float)), None)
    if times is not None and len(times) > 1:
        rate, start, uneven = rate_of(times, where)
    elif rate is None or not 0 < rate < 1e6:
        raise DataError("no frame rate and no times", where=where, allowed='"fps": 100')
    else:
        start, uneven = 0.0, None
    written = str(top.get("unit", top.get("units", "")))
    notes = []
    places = {}
    for name, path_of in points.items():
        values = np.array(
            [[np.nan] * 3 if v is None else list(v)[:3] for v in path_of], dtype=float
        )
        if values.ndim != 2 or values.shape[1] != 3 or values.size > _MOST:
            raise DataError(f"{name} has no three coordinates a frame", where=where)
        places[str(name)] = values
    if len({len(v) for v in places.values()}) != 1:
        raise DataError("points have different numbers of frames", where=where)
    unit = si_unit(written)
    if unit is None or unit[0] != "m":
        # Height above the floor is below 3 in m, above it in mm.
        size = float(np.nanmedian([np.nanmax(np.abs(v)) for v in places.values()]))
        unit = ("m", 1e-3 if size > 20.0 else 1.0, 0.0)
        notes.append(f"no unit of length: taken as {'mm' if unit[1] < 1 else 'm'} from the size")
    markers = {n: Marker(v * unit[1], rate, start, uneven) for n, v in places.items()}
    return Trial(where, markers=markers, source="JSON", checksum=checksum, notes=tuple(notes))


def _from_frames(frames: Any, where: str) -> tuple[dict[str, list[Any]], np.ndarray | None]:
    if not isinstance(frames, Sequence) or not frames or isinstance(frames, str):
        raise DataError("no points and no frames", where=where, allowed=", ".join(_POINTS))
    points: dict[str, list[Any]] = {}
    times = []
    for number, frame in enumerate(frames):
        if not isinstance(frame, Mapping):
            raise DataError(f"frame {number + 1} is no object", where=where)
        own = next((frame[k] for k in _POINTS if isinstance(frame.get(k), Mapping)), None)
        if own is None:
            own = _open_pose(frame, where)
        for name in own:
            points.setdefault(str(name), [None] * number)
        for name, path_of in points.items():
            path_of.append(own.get(name))
        if isinstance(frame.get("time"), int | float):
            times.append(float(frame["time"]))
    return points, np.array(times) if len(times) == len(frames) else None


def _open_pose(frame: Mapping[str, Any], where: str) -> dict[str, Any]:
    people = frame.get("people")
    person = people[0] if isinstance(people, list) and people else {}
    flat = person.get("pose_keypoints_3d") if isinstance(person, Mapping) else None
    if isinstance(people, list) and not people:
        return {}
    if not flat:
        raise DataError(
            "the points are in pixels of one picture",
            where=where,
            remedy="Export points in space (pose_keypoints_3d)",
        )
    rows = [flat[i : i + 4] for i in range(0, len(flat) - 3, 4)]
    return {
        name: rows[i][:3] if rows[i][3] > 0 else None
        for i, name in _BODY_25.items()
        if i < len(rows)
    }
