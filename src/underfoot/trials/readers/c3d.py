"""C3D files (format of c3d.org): markers, analog channels, force plates and events.

Parsed here: of the two public readers one ends the whole process on some corrupt parameter sections
and reads truncated files as if they were whole. Sizes are checked before anything is allocated.
"""

import math
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from underfoot.core import DataError
from underfoot.core.remark import Message

from ..recording import plates
from ..recording.axes import axis_vector
from ..recording.measurement import Flag
from ..recording.trial import Event, Trial, Vertical
from .draft import RecordingDraft
from .file_bytes import FileBytes
from .text import force_unit, si_unit, truncation_error

BLOCK = 512
_ENDIAN = {84: "<", 85: "<", 86: ">"}
_VAX = 85
_POSSIBLE = 1e30  # no sample of any instrument in any unit is larger
_READ = 16_000_000  # bytes that are read at a time
_PLATE_SAMPLES = 100_000  # of a long file's plate that are worked out at a time


@dataclass(frozen=True, slots=True)
class C3DFile:
    """Contents of a C3D file in its own units.

    ``points`` (frames, points, 3) is NaN where not seen; ``analog`` (samples, channels) is
    scaled; ``parameters`` maps GROUP to NAME to a list (or an array) of values. ``rotations``
    (frames, segments, 4, 4) are poses of segments, NaN where not known, ``rotation_rate`` in Hz.
    ``notes`` tell what of the file is damaged and not needed.
    """

    points: np.ndarray
    analog: np.ndarray
    point_rate: float
    analog_rate: float
    first_frame: int
    parameters: dict[str, dict[str, Any]]
    notes: tuple[str, ...] = ()
    rotations: np.ndarray = field(default_factory=lambda: np.empty((0, 0, 4, 4)))
    rotation_rate: float = 0.0

    def numbers(self, group: str, name: str) -> np.ndarray:
        """Return a parameter as floats in the file's shape; empty when absent or text."""
        value = self.parameters.get(group, {}).get(name)
        return value if isinstance(value, np.ndarray) else np.empty(0)

    def parameter_numbers(self, group: str, name: str) -> np.ndarray:
        """Return a parameter of numbers with its continuations (TIMES, TIMES2 ...)."""
        parts = [self.numbers(group, name)]
        for number in range(2, 20):
            part = self.numbers(group, f"{name}{number}")
            if not part.size or part.shape[:-1] != parts[0].shape[:-1]:
                break
            parts.append(part)
        return np.concatenate(parts, axis=-1) if len(parts) > 1 else parts[0]

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


def parse(data: bytes | FileBytes, where: str) -> C3DFile:
    """Return what a C3D file holds; what is truncated or inconsistent is a DataError.

    Of a long file (``FileBytes``) all samples are kept in single precision.
    """
    if len(data) < 2 * BLOCK or data[1] != 0x50 or data[0] == 0:
        raise DataError("not a C3D file", where=where, allowed="a file that begins as c3d.org says")
    start = (data[0] - 1) * BLOCK
    if start + 4 > len(data):
        raise DataError("truncated: the parameter section is missing", where=where)
    processor = data[start + 3]
    if processor not in _ENDIAN:
        raise DataError(
            Message("unknown processor type {processor}", processor=processor),
            where=where,
            allowed="84 (Intel), 85 (DEC) or 86 (SGI/MIPS)",
            remedy="The file is damaged: export it again",
        )
    words = np.frombuffer(data[:BLOCK], dtype=_ENDIAN[processor] + "u2")
    scale, frame_rate = _floats(data[12:16] + data[20:24], processor)
    data_start = (int(words[8]) - 1) * BLOCK
    parameters, notes = _parameters(data, start, data_start, processor, where)
    shell = C3DFile(np.empty(0), np.empty(0), 0.0, 0.0, 0, parameters)
    n_points, n_analog = int(words[1]), int(words[2])
    per_frame = int(words[9])
    channels = n_analog // per_frame if per_frame else 0
    if per_frame and channels * per_frame != n_analog:
        words = Message(
            "{n_analog} analog values a frame in {per_frame} samples can't be",
            n_analog=n_analog,
            per_frame=per_frame,
        )
        raise DataError(words, where=where)
    real = bool(scale < 0)
    width = 4 * n_points + n_analog
    size = 4 if real else 2
    used = int(shell.number("ROTATION", "USED"))
    end = min([at for at in _later_sections(shell, used, start) if at > data_start] + [len(data)])
    first, counts = _frame_counts(words, shell)
    if width or not used > 0:
        if width == 0 or not any(counts.values()):
            raise DataError("holds neither points nor analog samples", where=where)
        if data_start < BLOCK or data_start >= len(data):
            raise DataError("truncated: the data section is missing", where=where)
        frames, said = _frames(data, data_start, end, width * size, counts, where)
        notes += said
    else:
        frames = max(counts.values())
    if n_points != (points_used := shell.number("POINT", "USED", n_points)):
        notes.append(
            Message(
                "the header counts {n_points} points, POINT:USED {points_used:g}",
                n_points=n_points,
                points_used=points_used,
            )
        )
    count = frames if width else 0
    # Each marker and each channel lies in one piece.
    long = isinstance(data, FileBytes)
    points = np.empty((n_points, count, 3), "f4" if real or long else float).swapaxes(0, 1)
    kept = "f4" if long else float
    analog = np.empty((channels, count * per_frame), kept).T
    step = max(_READ // (width * size), 1) if width else 1
    for first_read in range(0, count, step):
        last_read = min(first_read + step, count)
        part = data[data_start + first_read * width * size : data_start + last_read * width * size]
        raw = _floats(part, processor) if real else np.frombuffer(part, _ENDIAN[processor] + "i2")
        raw = raw.reshape(last_read - first_read, width)
        with np.errstate(all="ignore"):  # damaged floats overflow; the sums are checked later
            places = raw[:, : 4 * n_points].reshape(len(raw), n_points, 4)
            _points(places, float(scale), real, points[first_read:last_read])
            samples = raw[:, 4 * n_points :].reshape(len(raw) * per_frame, channels)
            scaled = _scaled_analog(samples, shell, real)
            analog[first_read * per_frame : last_read * per_frame] = scaled
    point_rate, analog_rate = _rates(float(frame_rate), per_frame, shell, where)
    poses, rate = _rotations(data, shell, used, frames, point_rate, processor, where)
    read = points, analog, point_rate, analog_rate, first, parameters
    return C3DFile(*read, tuple(notes), poses, rate)


@np.errstate(invalid="ignore")  # a damaged float may signal when it is cast
def _rotations(
    data: bytes | FileBytes,
    shell: C3DFile,
    used: int,
    frames: int,
    rate: float,
    processor: int,
    where: str,
) -> tuple[np.ndarray, float]:
    """Return the poses (frames, segments, 4, 4) of the ROTATION group: by columns, a mark each.

    Source: C-Motion, ROTATION data type (as Theia writes it).
    """
    start = (int(shell.number("ROTATION", "DATA_START")) - 1) * BLOCK
    if used <= 0 or start < BLOCK:
        return np.empty((0, 0, 4, 4)), 0.0
    ratio = shell.number("ROTATION", "RATIO") or shell.number("ROTATION", "RATE") / rate
    count = frames * max(round(ratio), 1)
    if start + count * used * 17 * 4 > len(data):
        raise truncation_error(
            Message(
                "truncated: {count} frames of {used} rotations are not there",
                count=count,
                used=used,
            ),
            where,
        )
    raw = _floats(data[start : start + count * used * 68], processor).astype(float)
    raw = raw.reshape(count, used, 17)
    poses = raw[..., :16].reshape(count, used, 4, 4).swapaxes(2, 3).copy()
    poses[(raw[..., 16] < 0) | ~(np.abs(raw) < _POSSIBLE).all(axis=2)] = np.nan
    return poses, rate * max(round(ratio), 1)


def _later_sections(shell: C3DFile, rotations: int, parameters: int) -> list[int]:
    """Where other sections of the file begin (bytes)."""
    poses = (int(shell.number("ROTATION", "DATA_START")) - 1) * BLOCK
    return [parameters, poses] if rotations > 0 else [parameters]


def _frame_counts(header: np.ndarray, shell: C3DFile) -> tuple[int, dict[str, int]]:
    """Return the number of the first frame, and how many frames each place of the file counts.

    Words of the header hold 16 bits, and so do whole numbers of parameters: newer places hold more.
    """
    first, last = int(header[3]), int(header[4])
    counts = {"POINT:FRAMES": int(shell.number("POINT", "FRAMES"))}
    counts["POINT:FRAMES"] += 65536 * (counts["POINT:FRAMES"] < 0)
    counts["POINT:LONG_FRAMES"] = int(shell.number("POINT", "LONG_FRAMES"))
    names = ("ACTUAL_START_FIELD", "ACTUAL_END_FIELD")
    ends = [shell.whole_numbers("TRIAL", name).ravel(order="F") for name in names]
    if ends[0].size == 2 and ends[1].size == 2:
        low, high = (int(end[0] % 65536) + 65536 * int(end[1] % 65536) for end in ends)
        counts["TRIAL"] = high - low + 1
        if first in (low % 65536, 65535):
            first = low
    if last < 65535 or not any(count > 0 for count in counts.values()):
        counts["the header"] = last - int(header[3]) + 1
    counts = {place: count for place, count in counts.items() if count > 0}
    return max(first, 1), counts


def _frames(
    data: bytes | FileBytes, begin: int, end: int, width: int, counts: dict[str, int], where: str
) -> tuple[int, list[str]]:
    """Return how many frames of ``width`` bytes a data section holds, and what else was said.

    Its bytes decide: the count that fills its last block, else all frames down to the last byte
    that is not zero. Fewer bytes than every place counts: the file is cut short, a DataError.
    """
    size = end - begin
    whole = size // width
    fewest = max(size - BLOCK, 0) // width + 1
    fitting = [count for count in counts.values() if fewest <= count <= whole]
    largest = max(counts.values())
    if fitting:
        frames = fitting[0]
    elif largest > whole:
        words = Message(
            "truncated or damaged: {counted} frames are counted, the file holds {count}",
            counted=largest,
            count=whole,
        )
        raise truncation_error(words, where)
    else:
        content = begin + whole * width
        while content > begin and not data[max(content - BLOCK, begin) : content].strip(b"\0"):
            content = max(content - BLOCK, begin)
        content -= BLOCK - len(data[content - BLOCK : content].rstrip(b"\0"))
        frames = max(largest, -(-(content - begin) // width))
    told = {
        place: count
        for place, count in counts.items()
        if count != frames and count != frames % 65536 and not (count == 65535 < frames)
    }
    if not told:
        return frames, []
    listed = [Message("{place} {count}", place=place, count=n) for place, n in told.items()]
    return frames, [
        Message(
            "frames are counted in two ways ({listed}): the data hold {frames}, all read",
            listed=listed, frames=frames,
        )
    ]  # fmt: skip


def _rates(frame_rate: float, per_frame: int, shell: C3DFile, where: str) -> tuple[float, float]:
    point = frame_rate if frame_rate > 0 else shell.number("POINT", "RATE")
    analog = shell.number("ANALOG", "RATE")
    if not point > 0 and analog > 0 and per_frame:
        point = analog / per_frame
    if not 0 < point < 1e6:
        raise DataError("the sampling rate is missing", where=where)
    return point, point * per_frame if per_frame else point


def _points(raw: np.ndarray, scale: float, real: bool, positions: np.ndarray) -> None:
    """Fill positions (frames, points, 3) from the file's numbers (frames, points, 4)."""
    positions[:] = raw[:, :, :3] if real else raw[:, :, :3] * scale
    x, y, z = np.moveaxis(positions, 2, 0)  # numpy's all over three takes several times as long
    lost = (raw[:, :, 3] < 0) | ((x == 0.0) & (y == 0.0) & (z == 0.0))
    for one in (x, y, z):
        lost |= ~(np.abs(one) < _POSSIBLE)
    positions[lost] = np.nan


def _scaled_analog(raw: np.ndarray, shell: C3DFile, real: bool) -> np.ndarray:
    n = raw.shape[1]
    unsigned = any(text.strip().upper() == "UNSIGNED" for text in shell.texts("ANALOG", "FORMAT"))
    if unsigned and not real:
        raw = raw.view(raw.dtype.str.replace("i", "u"))
    offset = shell.parameter_numbers("ANALOG", "OFFSET").ravel(order="F")
    if unsigned:
        offset = np.where(offset < 0, offset + 65536, offset)
    general = shell.number("ANALOG", "GEN_SCALE", 1.0)
    scale = shell.parameter_numbers("ANALOG", "SCALE").ravel(order="F")
    samples = (raw - _pad(offset, n, 0.0)) * (_pad(scale, n, 1.0) * general)
    return np.where(np.abs(samples) < _POSSIBLE, samples, np.nan)


def _pad(values: np.ndarray, n: int, fill: float) -> np.ndarray:
    padded = np.full(n, fill)
    padded[: min(n, values.size)] = values[:n]
    return padded


_NEEDED = ("POINT", "ANALOG", "FORCE_PLATFORM", "ROTATION")


def _parameters(
    data: bytes | FileBytes, start: int, data_start: int, processor: int, where: str
) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """Return the parameters by group, and notes on damaged ones that no number depends on."""
    names: dict[int, str] = {}
    entries: list[tuple[int, str, Any]] = []
    damaged: list[tuple[int, str, DataError]] = []
    blocks = data[start + 2]
    # Some systems count too few blocks: the section ends where the data begin.
    end = max(start + BLOCK * blocks, data_start) if blocks else len(data)
    data = data[: min(len(data), end)]
    end = len(data)
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
            try:
                entries.append((group, name, _value(data[link + 2 : end], processor, name, where)))
            except DataError as error:
                damaged.append((group, name, error))
        if following == 0:
            break
        at = link + following
    found: dict[str, dict[str, Any]] = {name: {} for name in names.values()}
    for group, name, value in entries:
        found.setdefault(names.get(group, f"GROUP {group}"), {}).setdefault(name, value)
    notes = []
    for group, name, error in damaged:
        if names.get(group) in _NEEDED and not name.startswith("DESCRIPTION"):
            raise error
        notes.append(
            Message(
                "{group}:{name} is left out, {error}",
                group=names.get(group, "a group"), name=name, error=error.what,
            )
        )  # fmt: skip
    return found, notes


@np.errstate(invalid="ignore")
def _value(data: bytes, processor: int, name: str, where: str) -> Any:
    if len(data) < 2:
        raise DataError(Message("damaged: parameter {name} has no value", name=name), where=where)
    kind = int.from_bytes(data[:1], "little", signed=True)
    shape = tuple(data[2 : 2 + data[1]])
    count = math.prod(shape)
    if data[1] > 7:  # the format's limit
        raise DataError(
            Message("damaged: parameter {name} has {data} dimensions", name=name, data=data[1]),
            where=where,
        )
    if kind not in (-1, 1, 2, 4):
        raise DataError(
            Message("damaged: parameter {name} has the unknown type {kind}", name=name, kind=kind),
            where=where,
        )
    body = data[2 + len(shape) : 2 + len(shape) + count * abs(kind)]
    if len(shape) != data[1] or len(body) < count * abs(kind):
        raise DataError(
            Message("damaged: parameter {name} runs past its section", name=name), where=where
        )
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


_COMPUTED = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS")
_EVENT_NAMES = {
    "foot strike": "heel contact", "heel strike": "heel contact", "foot off": "toe off",
    "toe off": "toe off",
}  # fmt: skip


def read_c3d(draft: RecordingDraft) -> Trial:
    """Return the trial in a C3D file.

    A plate that can't be worked out is kept with its reason; the rest of the file is read.
    """
    raw = parse(draft.file or draft.data, draft.name)
    unit = (raw.texts("POINT", "UNITS") or [""])[0]
    places = raw.points if raw.points.size else raw.rotations[..., :3, 3]
    scale = draft.length_unit(unit, places if np.isfinite(places).any() else np.array(1000.0))
    draft.start = (raw.first_frame - 1) / raw.point_rate if raw.first_frame > 0 else 0.0
    units = raw.texts("ANALOG", "UNITS")
    draft.rate = raw.analog_rate
    for index in range(_plate_count(raw)):
        _plate(draft, raw, index, units, scale)
    draft.notes += _unused_plates(raw)
    labels = _labels(raw, "ANALOG", "channel", raw.analog.shape[1])
    counts = _raw_columns(raw)
    for i, name in enumerate(draft.names(labels, "channel")):
        if i in counts:  # the unit belongs to what the plate's calibration matrix makes of them
            draft.channel(name, raw.analog[:, i], note="before the plate's calibration")
        else:
            draft.channel(name, raw.analog[:, i], units[i] if i < len(units) else "")
    draft.rate = raw.point_rate
    labels = _labels(raw, "POINT", "point", raw.points.shape[1])
    computed = {label for group in _COMPUTED for label in raw.texts("POINT", group)}
    for i, name in enumerate(draft.names(labels, "marker")):
        if labels[i] not in computed:
            path = raw.points[:, i]
            if draft.file is None:
                path = path.astype(float)
            path *= path.dtype.type(scale)
            draft.marker(name, path)
    draft.rate = raw.rotation_rate
    poses = raw.texts("ROTATION", "LABELS")
    for i in range(raw.rotations.shape[1]):
        name = (poses[i] if i < len(poses) else f"segment {i + 1}").removesuffix("_4X4")
        if name not in draft.markers:
            draft.marker(name, raw.rotations[:, i, :3, 3] * scale)
    if raw.rotations.shape[1]:
        draft.notes.append(
            Message("origins of {count} segments stand as markers", count=raw.rotations.shape[1])
        )
    draft.notes += raw.notes
    left_out = sum(label in computed for label in labels)
    if left_out:
        draft.notes.append(
            Message(
                "{count} points are computed angles, forces or powers: left out",
                count=left_out,
            )
        )
    draft.events, draft.settings = _events(raw), _settings(raw)
    screen = (raw.texts("POINT", "Y_SCREEN") or [""])[0]
    if re.fullmatch("[+-][XYZxyz]", screen):
        x, y, z = axis_vector(screen.lower()).tolist()
        draft.up = Vertical((x, y, z), "upward on the screen, POINT:Y_SCREEN")
    return draft.trial("C3D")


def _labels(raw: C3DFile, group: str, kind: str, count: int) -> list[str]:
    labels = raw.texts(group, "LABELS")[:count]
    return labels + [f"{kind} {i + 1}" for i in range(len(labels), count)]


def _raw_columns(raw: C3DFile) -> set[int]:
    kinds = raw.whole_numbers("FORCE_PLATFORM", "TYPE").ravel(order="F")
    columns = raw.whole_numbers("FORCE_PLATFORM", "CHANNEL")
    if columns.ndim != 2:
        return set()
    plates = [i for i in range(min(len(kinds), columns.shape[1])) if kinds[i] == 4]
    return {int(column) - 1 for i in plates for column in columns[:, i]}


def _plate_count(raw: C3DFile) -> int:
    used = raw.number("FORCE_PLATFORM", "USED")
    kinds = raw.numbers("FORCE_PLATFORM", "TYPE").size
    return int(min(max(used, 0), max(kinds, used if used < 32 else 0)))


def _unused_plates(raw: C3DFile) -> list[str]:
    """Return a note on plates that have a type and corners, and that USED leaves out."""
    used = _plate_count(raw)
    kinds = raw.whole_numbers("FORCE_PLATFORM", "TYPE").ravel(order="F")[used:]
    corners = raw.numbers("FORCE_PLATFORM", "CORNERS").ravel(order="F")[12 * used :]
    left = sum(
        int(kind in plates.CHANNELS and bool(corners[12 * i : 12 * i + 12].any()))
        for i, kind in enumerate(kinds)
    )
    said = Message(
        "FORCE_PLATFORM:USED is {used}: {left} more that are described are left out",
        used=used, left=left,
    )  # fmt: skip
    return [said] if left else []


def _plate(draft: RecordingDraft, raw: C3DFile, index: int, units: list[str], scale: float) -> None:
    name = f"plate {index + 1}"
    kinds = raw.whole_numbers("FORCE_PLATFORM", "TYPE").ravel(order="F")
    kind = int(kinds[index]) if index < kinds.size else 0
    text = plates.KINDS.get(kind, Message("type {kind}", kind=kind))
    try:
        if kind not in plates.CHANNELS:
            raise DataError(
                Message("plate type {kind} is not supported", kind=kind), allowed="types 1 to 4"
            )
        numbers = _of_plate(raw.whole_numbers("FORCE_PLATFORM", "CHANNEL"), index, "CHANNEL", 1)
        columns = numbers[: plates.CHANNELS[kind]] - 1
        if len(columns) < plates.CHANNELS[kind]:
            raise DataError(
                Message(
                    "{text} needs {channels} channels", text=text, channels=plates.CHANNELS[kind]
                )
            )
        most = raw.analog.shape[1]
        if columns.max() >= most:
            raise DataError(
                Message("it names channel {max} of {most}", max=int(columns.max()) + 1, most=most)
            )
        if columns.min() < 0:
            raise DataError("it names a channel below 1")
        places = raw.numbers("FORCE_PLATFORM", "CORNERS")
        corners = _of_plate(places, index, "CORNERS", 2, (3, 4)).T * scale
        corners, crossed = plates.ordered_corners(corners, down=_z_points_down(places))
        flag = Flag("corners", Message("its corners come in crossed order: re-ordered"))
        axes = plates.plate_axes(corners)
        origin = _of_plate(raw.numbers("FORCE_PLATFORM", "ORIGIN"), index, "ORIGIN", 1) * scale
        if origin.shape != (3,) or not np.isfinite(origin).all():
            raise DataError("ORIGIN is damaged")
        notes: list[str] = []
        matrix, factors = None, np.ones(len(columns))
        if kind == 4:
            matrix = raw.numbers("FORCE_PLATFORM", "CAL_MATRIX")
            matrix = _of_plate(matrix, index, "CAL_MATRIX", 2, (6, 6))
        else:
            factors = _to_si(columns, units, kind, scale, notes)
        samples, largest = len(raw.analog), -1.0
        forces, moments = (np.empty((samples, 3), raw.analog.dtype) for _ in range(2))
        step = _PLATE_SAMPLES if draft.file else max(samples, 1)
        for part in (slice(at, at + step) for at in range(0, samples, step)):
            signals = raw.analog[part, columns].astype(float) * factors
            force, moment = plates.channel_forces(kind, signals, origin, matrix)
            if kind == 4:  # its matrix gives N and N times the file's unit of length
                lever = np.cross(-origin if origin[2] > 0 else origin, force)
                moment = (moment + lever) * scale - lever
            sizes = np.abs(force[np.isfinite(force)])
            largest = max(largest, float(sizes.max(initial=-1.0)))
            forces[part], moments[part] = force @ axes.T, moment @ axes.T
        if not 0.0 <= largest <= 1e9:
            raise DataError("its forces are not numbers of any possible size")
        zero = raw.numbers("FORCE_PLATFORM", "ZERO").ravel(order="F")
        if zero.size == 2 and zero[1] > zero[0] > 0:
            notes.append(
                Message(
                    "ZERO names samples {first} to {last}", first=int(zero[0]), last=int(zero[1])
                )
            )
        draft.plate(
            forces,
            name,
            moment=moments,
            corners=corners,
            raw=_columns(raw.analog, columns),
            kind=text,
            notes=tuple(notes),
            flags=(flag,) if crossed else (),
        )
    except DataError as error:
        reason = error.what + (f" ({error.allowed})" if error.allowed else "")
        draft.plates.append(plates.refused_plate(name, reason, rate=raw.analog_rate, kind=text))


def _z_points_down(places: np.ndarray) -> bool:
    """Whether the z axes of the plates (3, 4, n) with corners in order point into the floor.

    So they do by the format, and where no plate tells it.
    """
    for corners in np.moveaxis(places, -1, 0) if places.ndim == 3 else ():
        try:
            if not plates.ordered_corners(corners.T)[1]:
                z = plates.plate_axes(corners.T)[:, 2]
                return bool(z[int(np.argmax(np.abs(z)))] < 0)
        except DataError:
            continue
    return True


_COUNTS = ("adc", "adu", "bit", "bits", "count", "counts", "lsb", "unknown", "none", "n/a", "-")
"""What stands for the unit of a channel before its SCALE: the numbers are in the plate's unit."""


def _columns(table: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Columns of a table (n, k): those that stand beside each other without a copy."""
    first, count = int(columns[0]), len(columns)
    beside = (columns == np.arange(first, first + count)).all()
    return table[:, first : first + count] if beside else table[:, columns]


def _to_si(
    columns: np.ndarray, units: list[str], kind: int, scale: float, notes: list[str]
) -> np.ndarray:
    """Factors (k,) that make a plate's channels SI; units that are assumed become a note."""
    wanted = {1: "FFFLLM", 2: "FFFMMM", 3: "FFFFFFFF"}[kind]
    kinds = {"F": ("N", 1.0), "L": ("m", scale), "M": ("N*m", scale)}
    factors = np.ones(len(columns))
    assumed = set()
    for i, (column, letter) in enumerate(zip(columns, wanted, strict=True)):
        written = units[column].strip() if column < len(units) else ""
        si, factors[i] = kinds[letter]
        unit = force_unit(written) if si == "N" else si_unit(written)
        if unit and unit[0] == si:
            factors[i] = unit[1]
        elif written and written.casefold() not in _COUNTS:
            words = Message(
                'the unit of its channel {channel} is "{unit}", which is no known {kind}',
                channel=column + 1,
                unit=written,
                kind=si,
            )
            raise DataError(words)
        else:
            assumed.add(f'"{written}" as {si}')
    if assumed:
        notes.append(Message("units assumed: {units}", units=sorted(assumed)))
    return factors


def _of_plate(
    values: np.ndarray, index: int, name: str, dimensions: int, shape: tuple[int, ...] | None = None
) -> np.ndarray:
    """Part of a parameter that is one plate's; files with one plate may leave out the last axis."""
    if values.ndim == dimensions and index == 0 and values.size:
        values = values[..., None]
    wanted = shape or values.shape[:-1]
    if len(wanted) != dimensions or values.shape[:-1] != wanted or index >= values.shape[-1]:
        raise DataError(Message("FORCE_PLATFORM:{name} does not describe it", name=name))
    return values[..., index]


def _events(raw: C3DFile) -> tuple[Event, ...]:
    times = raw.parameter_numbers("EVENT", "TIMES")
    if times.ndim == 1 and times.size == 2:
        times = times[:, None]
    if times.ndim != 2 or times.shape[0] != 2:
        return ()
    labels, sides = raw.texts("EVENT", "LABELS"), raw.texts("EVENT", "CONTEXTS")
    found = []
    for i, when in enumerate(times[0] * 60.0 + times[1]):
        if np.isfinite(when):
            label = labels[i] if i < len(labels) else "event"
            side = sides[i].casefold() if i < len(sides) else ""
            name = _EVENT_NAMES.get(label.casefold(), label)
            found.append(Event(name, float(when), side, source=f'file, "{label}"'))
    return tuple(sorted(found, key=lambda event: event.time))


def _settings(raw: C3DFile) -> dict[str, str]:
    settings = {}
    for group in ("PROCESSING", "SUBJECTS"):
        for name in ("BODYMASS", "MASS"):
            mass = raw.number(group, name)
            if 5.0 < mass < 300.0:
                settings["body mass (kg)"] = f"{mass:.6g}"
    company = raw.texts("MANUFACTURER", "COMPANY")
    if company and company[0]:
        settings["made by"] = company[0]
    software = raw.texts("MANUFACTURER", "SOFTWARE")
    if software and software[0]:
        settings["software"] = software[0]
    return settings
