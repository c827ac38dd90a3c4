"""The C3D file as bytes: header, parameters, points and analog samples (format of c3d.org).

Written here because the two public readers were found wanting on damaged files: one ends the
whole process on some corrupt parameter sections and reads truncated files as if they were whole.
Every size is checked against the file before anything is allocated.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core import DataError

from .text import truncated

BLOCK = 512
_ENDIAN = {84: "<", 85: "<", 86: ">"}
_VAX = 85
_POSSIBLE = 1e30  # no sample of any instrument in any unit is larger


@dataclass(frozen=True, slots=True)
class C3DFile:
    """Contents of a C3D file in its own units.

    ``points`` (frames, points, 3) is NaN where not seen; ``analog`` (samples, channels) is
    scaled; ``parameters`` maps GROUP to NAME to a list (or an array) of values.
    """

    points: np.ndarray
    analog: np.ndarray
    point_rate: float
    analog_rate: float
    first_frame: int
    parameters: dict[str, dict[str, Any]]

    def numbers(self, group: str, name: str) -> np.ndarray:
        """Return a parameter as floats in the file's shape; empty when absent or text."""
        value = self.parameters.get(group, {}).get(name)
        return value if isinstance(value, np.ndarray) else np.empty(0)

    def whole_numbers(self, group: str, name: str) -> np.ndarray:
        """Return a parameter as whole numbers; what can't be one is 0."""
        values = np.nan_to_num(self.numbers(group, name), nan=0.0, posinf=0.0, neginf=0.0)
        return np.where(np.abs(values) < 1e6, values, 0.0).astype(int)

    def number(self, group: str, name: str, default: float = 0.0) -> float:
        """Return the first number of a parameter."""
        values = self.numbers(group, name).ravel(order="F")
        return float(values[0]) if values.size and np.isfinite(values[0]) else default

    def texts(self, group: str, name: str) -> list[str]:
        """Return a text parameter with its continuations (LABELS, LABELS2, LABELS3 ...)."""
        found: list[str] = []
        for suffix in ("", *map(str, range(2, 20))):
            value = self.parameters.get(group, {}).get(name + suffix)
            if not isinstance(value, list):
                break
            found += value
        return found


def parse(data: bytes, where: str) -> C3DFile:
    """Return what a C3D file holds; what is truncated or inconsistent is a DataError."""
    if len(data) < 2 * BLOCK or data[1] != 0x50 or data[0] == 0:
        raise DataError("not a C3D file", where=where, allowed="a file that begins as c3d.org says")
    start = (data[0] - 1) * BLOCK
    if start + 4 > len(data):
        raise DataError("truncated: the parameter section is missing", where=where)
    processor = data[start + 3]
    if processor not in _ENDIAN:
        raise DataError(
            f"unknown processor type {processor}",
            where=where,
            allowed="84 (Intel), 85 (DEC) or 86 (SGI/MIPS)",
            remedy="The file is damaged: export it again",
        )
    words = np.frombuffer(data, dtype=_ENDIAN[processor] + "u2", count=BLOCK // 2)
    scale, frame_rate = _floats(data[12:16] + data[20:24], processor)
    parameters = _parameters(data, start, processor, where)
    shell = C3DFile(np.empty(0), np.empty(0), 0.0, 0.0, 0, parameters)
    n_points, n_analog = int(words[1]), int(words[2])
    first, last = _frame_range(words, shell)
    per_frame = int(words[9])
    channels = n_analog // per_frame if per_frame else 0
    if per_frame and channels * per_frame != n_analog:
        words = f"{n_analog} analog values a frame in {per_frame} samples can't be"
        raise DataError(words, where=where)
    frames = last - first + 1
    data_start = (int(words[8]) - 1) * BLOCK
    real = bool(scale < 0)
    width = 4 * n_points + n_analog
    size = 4 if real else 2
    _check_size(len(data), data_start, frames, width * size, where)
    kind = "f4" if real else "i2"
    if real and processor == _VAX:
        raw = _floats(data[data_start : data_start + frames * width * 4], processor)
    else:
        raw = np.frombuffer(data, _ENDIAN[processor] + kind, frames * width, data_start)
    raw = raw.reshape(frames, width)
    with np.errstate(all="ignore"):  # damaged floats overflow; the sums are checked later
        points = _points(raw[:, : 4 * n_points].reshape(frames, n_points, 4), float(scale), real)
        samples = raw[:, 4 * n_points :].reshape(frames * per_frame, channels)
        analog = _scaled_analog(samples, shell, real)
    point_rate, analog_rate = _rates(float(frame_rate), per_frame, shell, where)
    return C3DFile(points, analog, point_rate, analog_rate, first, parameters)


def _check_size(length: int, start: int, frames: int, width: int, where: str) -> None:
    if width == 0 or frames < 1:
        raise DataError("holds neither points nor analog samples", where=where)
    if start < BLOCK or start >= length:
        raise DataError("truncated: the data section is missing", where=where)
    whole = (length - start) // width
    if whole < frames:
        words = f"truncated or damaged: the header says {frames} frames, the file holds {whole}"
        raise truncated(words, where)


def _frame_range(words: np.ndarray, shell: C3DFile) -> tuple[int, int]:
    """Header words hold 16 bits; longer recordings put the range in parameters."""
    first, last = int(words[3]), int(words[4])
    names = ("ACTUAL_START_FIELD", "ACTUAL_END_FIELD")
    ends = [shell.whole_numbers("TRIAL", name).ravel(order="F") % 65536 for name in names]
    if ends[0].size == 2 and ends[1].size == 2:
        low, high = (int(end[0]) + 65536 * int(end[1]) for end in ends)
        if high >= low and (high % 65536 == last or last == 65535):
            return low, high
    frames = int(shell.number("POINT", "LONG_FRAMES") or 0)
    if last == 65535 and frames > last - first + 1:
        return first, first + frames - 1
    return first, last


def _rates(frame_rate: float, per_frame: int, shell: C3DFile, where: str) -> tuple[float, float]:
    point = frame_rate if frame_rate > 0 else shell.number("POINT", "RATE")
    analog = shell.number("ANALOG", "RATE")
    if not point > 0 and analog > 0 and per_frame:
        point = analog / per_frame
    if not 0 < point < 1e6:
        raise DataError("the sampling rate is missing", where=where)
    return point, point * per_frame if per_frame else point


def _points(raw: np.ndarray, scale: float, real: bool) -> np.ndarray:
    positions = raw[:, :, :3].astype(np.float64)
    if not real:
        positions *= scale
    lost = (raw[:, :, 3] < 0) | (positions == 0.0).all(axis=2)
    positions[lost | ~(np.abs(positions) < _POSSIBLE).all(axis=2)] = np.nan
    return positions


def _scaled_analog(raw: np.ndarray, shell: C3DFile, real: bool) -> np.ndarray:
    n = raw.shape[1]
    unsigned = any(text.strip().upper() == "UNSIGNED" for text in shell.texts("ANALOG", "FORMAT"))
    if unsigned and not real:
        raw = raw.view(raw.dtype.str.replace("i", "u"))
    offset = shell.numbers("ANALOG", "OFFSET").ravel(order="F")
    if unsigned:
        offset = np.where(offset < 0, offset + 65536, offset)
    general = shell.number("ANALOG", "GEN_SCALE", 1.0)
    scale = shell.numbers("ANALOG", "SCALE").ravel(order="F")
    samples = (raw - _padded(offset, n, 0.0)) * (_padded(scale, n, 1.0) * general)
    return np.where(np.abs(samples) < _POSSIBLE, samples, np.nan)


def _padded(values: np.ndarray, n: int, fill: float) -> np.ndarray:
    padded = np.full(n, fill)
    padded[: min(n, values.size)] = values[:n]
    return padded


def _parameters(data: bytes, start: int, processor: int, where: str) -> dict[str, dict[str, Any]]:
    names: dict[int, str] = {}
    entries: list[tuple[int, str, Any]] = []
    blocks = data[start + 2]
    end = min(len(data), start + BLOCK * blocks) if blocks else len(data)
    at = start + 4
    order = "little" if _ENDIAN[processor] == "<" else "big"
    while at + 4 <= end:
        length = abs(int.from_bytes(data[at : at + 1], "little", signed=True))
        group = int.from_bytes(data[at + 1 : at + 2], "little", signed=True)
        if length == 0 or group == 0:
            break
        name = data[at + 2 : at + 2 + length].decode("latin-1").strip().upper()
        link = at + 2 + length
        if link + 2 > end:
            raise DataError("damaged: the parameter section ends inside an entry", where=where)
        following = int.from_bytes(data[link : link + 2], order)
        if group < 0:
            names[-group] = name
        else:
            entries.append((group, name, _value(data[link + 2 : end], processor, name, where)))
        if following == 0:
            break
        at = link + following
    found: dict[str, dict[str, Any]] = {name: {} for name in names.values()}
    for group, name, value in entries:
        found.setdefault(names.get(group, f"GROUP {group}"), {}).setdefault(name, value)
    return found


def _value(data: bytes, processor: int, name: str, where: str) -> Any:
    if len(data) < 2:
        raise DataError(f"damaged: parameter {name} has no value", where=where)
    kind = int.from_bytes(data[:1], "little", signed=True)
    shape = tuple(data[2 : 2 + data[1]])
    count = math.prod(shape)
    if data[1] > 7:  # the format's limit
        raise DataError(f"damaged: parameter {name} has {data[1]} dimensions", where=where)
    if kind not in (-1, 1, 2, 4):
        raise DataError(f"damaged: parameter {name} has the unknown type {kind}", where=where)
    body = data[2 + len(shape) : 2 + len(shape) + count * abs(kind)]
    if len(shape) != data[1] or len(body) < count * abs(kind):
        raise DataError(f"damaged: parameter {name} runs past its section", where=where)
    if kind == -1:
        width = shape[0] if shape else 1
        n = count // width if width else 0
        return [body[i * width : (i + 1) * width].decode("latin-1").strip("\0 ") for i in range(n)]
    if kind == 4:
        values = _floats(body, processor)
    else:
        values = np.frombuffer(body, _ENDIAN[processor] + f"i{kind}")
    return values.astype(np.float64).reshape(shape, order="F")


def _floats(data: bytes, processor: int) -> np.ndarray:
    """Four-byte floats; DEC's have swapped halves and an exponent two larger."""
    if processor != _VAX:
        return np.frombuffer(data, _ENDIAN[processor] + "f4")
    halves = np.frombuffer(data, "<u2").reshape(-1, 2)[:, ::-1]
    return np.ascontiguousarray(halves).view("<f4").ravel() / np.float32(4.0)
