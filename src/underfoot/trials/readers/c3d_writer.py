"""A small C3D writer: markers, analog channels, type-2 force plates."""

import struct
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from underfoot.core import InputError
from underfoot.core.remark import Message

from ..recording.trial import MADE_UP

_INTEL = 84
_MOST = 65535  # frames that 16 bits count
_LONGEST = 255  # entries of a parameter: its sizes are bytes


def c3d_bytes(
    markers: Mapping[str, np.ndarray],
    marker_rate: float,
    analog: Mapping[str, tuple[np.ndarray, str]],
    analog_rate: float,
    plates: Sequence[tuple[np.ndarray, np.ndarray, Sequence[str]]],
    *,
    events: Sequence[tuple[str, str, float]] = (),
    mass: float = 0.0,
    software: str = MADE_UP,
    description: str = "synthetic",
    first_frame: int = 1,
    frames: int | None = None,
) -> bytes:
    """Return a C3D file (Intel, floating point; source: the C3D file format, c3d.org).

    ``markers`` are (n, 3) each in m; NaN writes a missing point (zeros, residual -1). ``analog``
    holds values (n * analog_rate / marker_rate,) and the unit to be written, ``plates`` corners (4,
    3) and origin (3,) in m and the six channel names, ``events`` label ("Foot Strike"), context
    ("Left") and time (s). ``mass`` (kg) of the person is left out at zero. ``first_frame`` is the
    number of the first frame (time 0 is that of frame 1), ``frames`` their number where there are
    no markers. Lists of more than 255 go on in LABELS2 and so on; frames beyond the 65,535 of the
    header are counted in LONG_FRAMES and TRIAL. Rates that are no whole multiple, and lengths that
    do not fit, are an `InputError`.
    """
    per_frame = round(analog_rate / marker_rate)
    frames = len(next(iter(markers.values()))) if frames is None else frames
    if abs(per_frame * marker_rate - analog_rate) > 1e-9 * analog_rate:
        raise InputError("analog rate must be a multiple of the marker rate", where="c3d")
    if any(len(values) != frames * per_frame for values, _ in analog.values()):
        raise InputError("analog channels must cover the frames exactly", where="c3d")
    names, count = list(analog), len(analog)
    last_frame = first_frame + frames - 1
    groups: dict[str, dict[str, bytes]] = {
        "POINT": {
            "USED": _integers([len(markers)]), "FRAMES": _integers([min(frames, _MOST)]),
            "DATA_START": _integers([0]), "SCALE": _floats([-1.0]), "RATE": _floats([marker_rate]),
            "UNITS": _texts(["mm"], single=True),
            **_continue_parameter("LABELS", list(markers), _texts),
            **_continue_parameter("DESCRIPTIONS", [description] * len(markers), _texts),
        },
        "ANALOG": {
            "USED": _integers([count]), "GEN_SCALE": _floats([1.0]), "RATE": _floats([analog_rate]),
            **_continue_parameter("SCALE", [1.0] * count, _float_vector),
            **_continue_parameter("OFFSET", [0] * count, _integer_vector),
            **_continue_parameter("UNITS", [unit for _, unit in analog.values()], _texts),
            **_continue_parameter("LABELS", names, _texts),
            **_continue_parameter("DESCRIPTIONS", [description] * count, _texts),
        },
    }  # fmt: skip
    if last_frame > _MOST:
        groups["POINT"]["LONG_FRAMES"] = _floats([frames])
        groups["TRIAL"] = {
            "ACTUAL_START_FIELD": _integer_vector([first_frame % 65536, first_frame // 65536]),
            "ACTUAL_END_FIELD": _integer_vector([last_frame % 65536, last_frame // 65536]),
        }
    if plates:
        channels = [[names.index(name) + 1 for name in own] for *_, own in plates]
        groups["FORCE_PLATFORM"] = {
            "USED": _integers([len(plates)]),
            "ZERO": _integer_vector([0, 0]),
            "TYPE": _integer_vector([2] * len(plates)),
            "CORNERS": _array(np.array([1e3 * corners for corners, _, _ in plates])),
            "ORIGIN": _array(np.array([1e3 * origin for _, origin, _ in plates])),
            "CHANNEL": _array(np.array(channels), "<i2"),
        }
    groups["MANUFACTURER"] = {"SOFTWARE": _texts([software], single=True)}
    if mass:
        groups["PROCESSING"] = {"Bodymass": _floats([mass])}
    if events:
        labels, contexts, times = (list(part) for part in zip(*events, strict=True))
        minutes = [[time // 60.0, time % 60.0] for time in times]
        groups["EVENT"] = {
            "USED": _integers([len(events)]),
            **_continue_parameter("CONTEXTS", contexts, _texts),
            **_continue_parameter("LABELS", labels, _texts),
            **_continue_parameter("TIMES", minutes, lambda part: _array(np.array(part))),
        }
    body = _parameters(groups)
    blocks = -(-(len(body) + 4) // 512)
    first_data = 2 + blocks
    at = body.index(b"DATA_START") + len(b"DATA_START") + 2 + 1 + 1
    body = body[:at] + struct.pack("<h", first_data) + body[at + 2 :]
    if blocks > 255:
        words = Message("the names and descriptions fill {blocks} blocks", blocks=blocks)
        raise InputError(words, where="c3d", allowed="255 blocks of 512 bytes")
    parameters = (struct.pack("<BBBB", 1, 0x50, blocks, _INTEL) + body).ljust(512 * blocks, b"\0")
    ends = min(first_frame, _MOST), min(last_frame, _MOST)
    counts = (len(markers), count * per_frame, *ends)
    header = struct.pack(
        "<BBHHHHHfHHf", 2, 0x50, *counts, 0, -1.0, first_data, per_frame, marker_rate
    )
    points = np.zeros((frames, len(markers), 4), dtype="<f4")
    for i, positions in enumerate(markers.values()):
        lost = np.asarray(~np.isfinite(positions).all(axis=1))
        points[:, i, :3] = 1e3 * np.where(lost[:, None], 0.0, positions)
        points[:, i, 3] = np.where(lost, -1.0, 0.0)
    signals = np.array([values for values, _ in analog.values()], dtype="<f4")
    signals = signals.reshape(len(analog), frames, per_frame).transpose(1, 2, 0)
    rows = np.concatenate((points.reshape(frames, -1), signals.reshape(frames, -1)), axis=1)
    data = np.ascontiguousarray(rows).tobytes()
    return header.ljust(512, b"\0") + parameters + data + b"\0" * (-len(data) % 512)


def _parameters(groups: Mapping[str, Mapping[str, bytes]]) -> bytes:
    out = b""
    for number, (group, parameters) in enumerate(groups.items(), start=1):
        name = group.encode("ascii")
        out += struct.pack("<bb", len(name), -number) + name + struct.pack("<hB", 3, 0)
        for label, content in parameters.items():
            text = label.encode("ascii")
            out += struct.pack("<bb", len(text), number) + text
            out += struct.pack("<h", len(content) + 3) + content + b"\0"
    return out + b"\0\0"


def _continue_parameter(
    name: str, values: Sequence[Any], content: Callable[[Sequence[Any]], bytes]
) -> dict[str, bytes]:
    """A list as one parameter, or as several of 255 entries: LABELS, LABELS2, LABELS3 ..."""
    parts = [values[i : i + _LONGEST] for i in range(0, max(len(values), 1), _LONGEST)]
    return {f"{name}{i if i > 1 else ''}": content(part) for i, part in enumerate(parts, start=1)}


def _integers(values: Sequence[int]) -> bytes:
    return _content(2, [], struct.pack(f"<{len(values)}H", *values))


def _integer_vector(values: Sequence[int]) -> bytes:
    return _content(2, [len(values)], struct.pack(f"<{len(values)}H", *values))


def _floats(values: Sequence[float]) -> bytes:
    return _content(4, [], struct.pack(f"<{len(values)}f", *values))


def _float_vector(values: Sequence[float]) -> bytes:
    return _content(4, [len(values)], struct.pack(f"<{len(values)}f", *values))


def _array(values: np.ndarray, kind: str = "<f4") -> bytes:
    """C order with the last axis fastest is the format's order with dimensions reversed."""
    return _content(int(kind[2]), list(values.shape[::-1]), values.astype(kind).tobytes())


def _texts(values: Sequence[str], *, single: bool = False) -> bytes:
    width = max(1, *(len(value) for value in values)) if values else 1
    content = b"".join(value.ljust(width).encode("ascii", "replace") for value in values)
    return _content(-1, [width] if single else [width, len(values)], content)


def _content(kind: int, dimensions: list[int], data: bytes) -> bytes:
    return struct.pack("<bB", kind, len(dimensions)) + bytes(dimensions) + data
