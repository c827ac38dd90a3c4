"""A small C3D writer: markers, analog channels, type-2 force plates."""

import struct
from collections.abc import Mapping, Sequence

import numpy as np

from underfoot.core import InputError

from ..recording.trial import MADE_UP

_INTEL = 84


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
    no markers. Rates that are no whole multiple, and lengths that do not fit, are an `InputError`.
    """
    per_frame = round(analog_rate / marker_rate)
    frames = len(next(iter(markers.values()))) if frames is None else frames
    if abs(per_frame * marker_rate - analog_rate) > 1e-9 or frames > 65535:
        raise InputError("analog rate must be a multiple of the marker rate", where="c3d")
    if any(len(values) != frames * per_frame for values, _ in analog.values()):
        raise InputError("analog channels must cover the frames exactly", where="c3d")
    names, count = list(analog), len(analog)
    groups: dict[str, dict[str, bytes]] = {
        "POINT": {
            "USED": _integers([len(markers)]), "FRAMES": _integers([frames]),
            "DATA_START": _integers([0]), "SCALE": _floats([-1.0]), "RATE": _floats([marker_rate]),
            "UNITS": _texts(["mm"], single=True), "LABELS": _texts(list(markers)),
            "DESCRIPTIONS": _texts([description] * len(markers)),
        },
        "ANALOG": {
            "USED": _integers([count]), "GEN_SCALE": _floats([1.0]), "RATE": _floats([analog_rate]),
            "SCALE": _floats([1.0] * count, vector=True),
            "OFFSET": _integers([0] * count, vector=True),
            "UNITS": _texts([unit for _, unit in analog.values()]), "LABELS": _texts(names),
            "DESCRIPTIONS": _texts([description] * count),
        },
    }  # fmt: skip
    if plates:
        channels = [[names.index(name) + 1 for name in own] for *_, own in plates]
        groups["FORCE_PLATFORM"] = {
            "USED": _integers([len(plates)]),
            "ZERO": _integers([0, 0], vector=True),
            "TYPE": _integers([2] * len(plates), vector=True),
            "CORNERS": _array(np.array([1e3 * corners for corners, _, _ in plates])),
            "ORIGIN": _array(np.array([1e3 * origin for _, origin, _ in plates])),
            "CHANNEL": _array(np.array(channels), "<i2"),
        }
    groups["MANUFACTURER"] = {"SOFTWARE": _texts([software], single=True)}
    if mass:
        groups["PROCESSING"] = {"Bodymass": _floats([mass])}
    if events:
        labels, contexts, times = (list(part) for part in zip(*events, strict=True))
        minutes = np.array([[time // 60.0, time % 60.0] for time in times])
        groups["EVENT"] = {
            "USED": _integers([len(events)]),
            "CONTEXTS": _texts(contexts),
            "LABELS": _texts(labels),
            "TIMES": _array(minutes),
        }
    body = _parameters(groups)
    blocks = -(-(len(body) + 4) // 512)
    first_data = 2 + blocks
    at = body.index(b"DATA_START") + len(b"DATA_START") + 2 + 1 + 1
    body = body[:at] + struct.pack("<h", first_data) + body[at + 2 :]
    parameters = (struct.pack("<BBBB", 1, 0x50, blocks, _INTEL) + body).ljust(512 * blocks, b"\0")
    counts = (len(markers), count * per_frame, first_frame, first_frame + frames - 1)
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


def _integers(values: Sequence[int], *, vector: bool = False) -> bytes:
    return _content(2, [len(values)] if vector else [], struct.pack(f"<{len(values)}H", *values))


def _floats(values: Sequence[float], *, vector: bool = False) -> bytes:
    return _content(4, [len(values)] if vector else [], struct.pack(f"<{len(values)}f", *values))


def _array(values: np.ndarray, kind: str = "<f4") -> bytes:
    """C order with the last axis fastest is the format's order with dimensions reversed."""
    return _content(int(kind[2]), list(values.shape[::-1]), values.astype(kind).tobytes())


def _texts(values: Sequence[str], *, single: bool = False) -> bytes:
    width = max(1, *(len(value) for value in values)) if values else 1
    content = b"".join(value.ljust(width).encode("ascii", "replace") for value in values)
    return _content(-1, [width] if single else [width, len(values)], content)


def _content(kind: int, dimensions: list[int], data: bytes) -> bytes:
    return struct.pack("<bB", kind, len(dimensions)) + bytes(dimensions) + data
