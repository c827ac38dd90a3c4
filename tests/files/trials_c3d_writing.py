"""A small C3D writer for the tests: every processor and storage form, any parameters."""

from __future__ import annotations

import struct

import numpy as np

ORDER = {84: "<", 85: "<", 86: ">"}


def floats(values, processor: int) -> bytes:
    """Four-byte floats of a processor; DEC's halves are swapped and scaled by 4."""
    array = np.asarray(values, dtype="<f4")
    if processor == 86:
        return array.astype(">f4").tobytes()
    if processor == 85:
        halves = np.ascontiguousarray(array * np.float32(4.0)).view("<u2").reshape(-1, 2)
        return np.ascontiguousarray(halves[:, ::-1]).tobytes()
    return array.tobytes()


def parameter(group: int, name: str, value, processor: int) -> bytes:
    order = ORDER[processor]
    if isinstance(value, list):
        width = max((len(text) for text in value), default=1)
        body = "".join(text.ljust(width) for text in value).encode("latin-1")
        kind, shape = -1, (width, len(value))
    elif np.asarray(value).dtype.kind == "f":
        array = np.asarray(value)
        body, kind, shape = floats(array.ravel(order="F"), processor), 4, array.shape
    else:
        array = np.asarray(value)
        body = array.ravel(order="F").astype(order + "i2").tobytes()
        kind, shape = 2, array.shape
    content = struct.pack("bB", kind, len(shape)) + bytes(shape) + body + b"\0"
    head = struct.pack("bb", len(name), group) + name.encode()
    return head + struct.pack(order + "h", len(content) + 2) + content


def c3d_bytes(
    points: np.ndarray,
    analog: np.ndarray,
    *,
    groups: dict[str, dict[str, object]],
    processor: int = 84,
    real: bool = True,
    point_rate: float = 100.0,
    scale: float = 0.1,
    first_frame: int = 1,
) -> bytes:
    """Bytes of a C3D file: points (frames, n, 3), NaN = lost; analog (samples, channels)."""
    order = ORDER[processor]
    frames, count = points.shape[:2]
    per_frame = len(analog) // frames if frames and analog.size else 0
    body = b""
    for number, (group, entries) in enumerate(groups.items(), start=1):
        body += struct.pack("bb", len(group), -number) + group.encode()
        body += struct.pack(order + "h", 3) + b"\0"
        for name, value in entries.items():
            body += parameter(number, name, value, processor)
    body += b"\0\0"
    blocks = -(-(len(body) + 4) // 512)
    section = (bytes([1, 0x50, blocks, processor]) + body).ljust(512 * blocks, b"\0")
    channels = analog.shape[1] if analog.size else 0
    words = struct.pack(
        order + "5H", count, channels * per_frame, first_frame, first_frame + frames - 1, 10
    )
    header = bytes([2, 0x50]) + words + floats([-scale if real else scale], processor)
    header += struct.pack(order + "2H", 2 + blocks, per_frame) + floats([point_rate], processor)
    lost = ~np.isfinite(points).all(axis=2)
    residual = np.where(lost, -1.0, 0.0)
    placed = np.where(lost[..., None], 0.0, points)
    samples = analog.reshape(frames, -1) if channels else np.empty((frames, 0))
    if not real:
        placed = np.round(placed / scale)
    rows = np.concatenate(
        (np.concatenate((placed, residual[..., None]), axis=2).reshape(frames, -1), samples), axis=1
    )
    data = floats(rows.ravel(), processor) if real else rows.astype(order + "i2").tobytes()
    return header.ljust(512, b"\0") + section + data
