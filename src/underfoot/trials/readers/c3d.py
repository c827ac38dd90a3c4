"""C3D files: markers, analog channels, force plates and events as a trial."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ..measurement import Flag
from ..plates import (
    CHANNELS,
    KINDS,
    channel_forces,
    finished_plate,
    ordered_corners,
    plate_axes,
    refused_plate,
    up_from_normal,
)
from ..trial import Channel, Event, Marker, Plate, Trial
from .c3d_bytes import C3DFile, parse
from .text import unique_names
from .unit_factors import si_unit

_COMPUTED = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS")
_EVENT_NAMES = {
    "foot strike": "heel contact",
    "heel strike": "heel contact",
    "foot off": "toe off",
    "toe off": "toe off",
}


def read_c3d(data: bytes, path: Path, checksum: str, *, subtract_baseline: bool = True) -> Trial:
    """Return the trial in a C3D file.

    A plate that can't be worked out is kept with its reason; the rest of the file is read.

    Raises
    ------
    DataError
        Not a C3D file, truncated or damaged.
    """
    where = path.name
    raw = parse(data, where)
    notes: list[str] = []
    scale = _length_unit(raw, notes)
    start = (raw.first_frame - 1) / raw.point_rate if raw.first_frame > 0 else 0.0
    units = raw.texts("ANALOG", "UNITS")
    plates = tuple(
        _plate(raw, index, units, scale, start, subtract_baseline)
        for index in range(_plate_count(raw))
    )
    return Trial(
        name=where,
        channels=_channels(raw, units, start, notes),
        plates=plates,
        markers=_markers(raw, scale, start, notes),
        source="C3D",
        checksum=checksum,
        notes=tuple(notes),
        events=_events(raw),
        settings=_settings(raw),
    )


def _length_unit(raw: C3DFile, notes: list[str]) -> float:
    written = (raw.texts("POINT", "UNITS") or [""])[0]
    unit = si_unit(written) if written else None
    if unit and unit[0] == "m":
        return unit[1]
    size = np.nanmedian(np.abs(raw.points)) if np.isfinite(raw.points).any() else 1000.0
    factor = 1e-3 if size > 20.0 else 1.0
    notes.append(
        f'unit of the markers "{written}" is not known: taken as {"mm" if factor < 1 else "m"} '
        "from their size"
    )
    return factor


def _markers(raw: C3DFile, scale: float, start: float, notes: list[str]) -> dict[str, Marker]:
    count = raw.points.shape[1]
    labels = raw.texts("POINT", "LABELS")[:count]
    labels += [f"point {i + 1}" for i in range(len(labels), count)]
    computed = {label for group in _COMPUTED for label in raw.texts("POINT", group)}
    names = unique_names(labels, "marker", notes)
    left_out = sum(label in computed for label in labels)
    if left_out:
        notes.append(f"{left_out} points are computed angles, forces or powers: left out")
    return {
        name: Marker(raw.points[:, i] * scale, raw.point_rate, start)
        for i, (name, label) in enumerate(zip(names, labels, strict=True))
        if label not in computed
    }


def _channels(raw: C3DFile, units: list[str], start: float, notes: list[str]) -> dict[str, Channel]:
    count = raw.analog.shape[1]
    labels = raw.texts("ANALOG", "LABELS")[:count]
    labels += [f"channel {i + 1}" for i in range(len(labels), count)]
    channels = {}
    counts = _raw_columns(raw)
    for i, name in enumerate(unique_names(labels, "channel", notes)):
        written = units[i] if i < len(units) else ""
        unit = si_unit(written) if written else None
        if i in counts:  # the unit belongs to what the plate's calibration matrix makes of them
            channels[name] = Channel(
                raw.analog[:, i], "", raw.analog_rate, start, note="before the plate's calibration"
            )
            continue
        si, factor, offset = unit if unit else ("", 1.0, 0.0)
        note = f'in "{written}" in the file' if written else "no unit in the file"
        channels[name] = Channel(
            raw.analog[:, i] * factor + offset, si, raw.analog_rate, start, note=note
        )
    return channels


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


def _plate(
    raw: C3DFile, index: int, units: list[str], scale: float, start: float, subtract: bool
) -> Plate:
    name = f"plate {index + 1}"
    kinds = raw.whole_numbers("FORCE_PLATFORM", "TYPE").ravel(order="F")
    kind = int(kinds[index]) if index < kinds.size else 0
    words = KINDS.get(kind, f"type {kind}")
    try:
        if kind not in CHANNELS:
            raise DataError(f"plate type {kind} is not supported", allowed="types 1 to 4")
        numbers = _column(raw.whole_numbers("FORCE_PLATFORM", "CHANNEL"), index, "CHANNEL")
        columns = numbers[: CHANNELS[kind]] - 1
        if len(columns) < CHANNELS[kind]:
            raise DataError(f"{words} needs {CHANNELS[kind]} channels")
        if columns.min() < 0 or columns.max() >= raw.analog.shape[1]:
            raise DataError(
                f"it names channel {int(columns.max()) + 1} of {raw.analog.shape[1]}"
                if columns.max() >= raw.analog.shape[1]
                else "it names a channel below 1"
            )
        corners, crossed = ordered_corners(_corners(raw, index) * scale)
        flags = (
            (Flag("corners", "its corners come in crossed order: re-ordered"),) if crossed else ()
        )
        axes = plate_axes(corners)
        origin = _column(raw.numbers("FORCE_PLATFORM", "ORIGIN"), index, "ORIGIN") * scale
        if origin.shape != (3,) or not np.isfinite(origin).all():
            raise DataError("ORIGIN is damaged")
        signals = raw.analog[:, columns]
        notes: list[str] = []
        force, moment = channel_forces(
            kind,
            signals if kind == 4 else _in_si(signals, columns, units, kind, scale, notes),
            origin,
            _calibration(raw, index) if kind == 4 else None,
        )
        if kind == 4:
            # The matrix turns raw counts into N and N times the file's unit of length.
            moment = _rescaled_type_4(force, moment, origin, scale)
        if not np.isfinite(force).any() or np.abs(force[np.isfinite(force)]).max() > 1e9:
            raise DataError("its forces are not numbers of any possible size")
        zero = raw.numbers("FORCE_PLATFORM", "ZERO").ravel(order="F")
        if zero.size == 2 and zero[1] > zero[0] > 0:
            notes.append(f"ZERO names samples {int(zero[0])} to {int(zero[1])}")
        return finished_plate(
            name,
            force @ axes.T,
            rate=raw.analog_rate,
            start=start,
            up=up_from_normal(axes[:, 2]),
            moment=moment @ axes.T,
            corners=corners,
            raw=signals,
            kind=words,
            notes=tuple(notes),
            flags=flags,
            subtract_baseline=subtract,
        )
    except DataError as error:
        reason = error.what + (f" ({error.allowed})" if error.allowed else "")
        return refused_plate(name, reason, rate=raw.analog_rate, kind=words)


def _in_si(
    signals: np.ndarray,
    columns: np.ndarray,
    units: list[str],
    kind: int,
    scale: float,
    notes: list[str],
) -> np.ndarray:
    wanted = {1: "FFFLLM", 2: "FFFMMM", 3: "FFFFFFFF"}[kind]
    kinds = {"F": ("N", 1.0), "L": ("m", scale), "M": ("N*m", scale)}
    factors = np.ones(len(columns))
    unknown = set()
    for i, (column, letter) in enumerate(zip(columns, wanted, strict=True)):
        written = units[column] if column < len(units) else ""
        unit = si_unit(written) if written else None
        si, assumed = kinds[letter]
        if unit and unit[0] == si:
            factors[i] = unit[1]
        else:
            factors[i] = assumed
            unknown.add(f'"{written}" as {"N" if letter == "F" else si}')
    if unknown:
        notes.append("units assumed: " + ", ".join(sorted(unknown)))
    return signals * factors


def _rescaled_type_4(
    force: np.ndarray, moment: np.ndarray, origin: np.ndarray, scale: float
) -> np.ndarray:
    to_surface = -origin if origin[2] > 0 else origin
    lever = np.cross(np.broadcast_to(to_surface, force.shape), force)
    return (moment + lever) * scale - lever


def _column(values: np.ndarray, index: int, name: str) -> np.ndarray:
    if values.ndim == 1 and index == 0 and values.size:
        return values
    if values.ndim != 2 or index >= values.shape[1]:
        raise DataError(f"FORCE_PLATFORM:{name} does not describe it")
    return values[:, index]


def _corners(raw: C3DFile, index: int) -> np.ndarray:
    values = raw.numbers("FORCE_PLATFORM", "CORNERS")
    if values.ndim == 2 and values.shape == (3, 4) and index == 0:
        return values.T
    if values.ndim != 3 or values.shape[:2] != (3, 4) or index >= values.shape[2]:
        raise DataError("FORCE_PLATFORM:CORNERS does not describe it")
    return values[:, :, index].T


def _calibration(raw: C3DFile, index: int) -> np.ndarray:
    values = raw.numbers("FORCE_PLATFORM", "CAL_MATRIX")
    if values.ndim == 2 and index == 0:
        values = values[:, :, None]
    if values.ndim != 3 or values.shape[:2] != (6, 6) or index >= values.shape[2]:
        raise DataError("FORCE_PLATFORM:CAL_MATRIX does not describe it")
    return values[:, :, index]


def _events(raw: C3DFile) -> tuple[Event, ...]:
    times = raw.numbers("EVENT", "TIMES")
    if times.ndim == 1 and times.size == 2:
        times = times[:, None]
    if times.ndim != 2 or times.shape[0] != 2:
        return ()
    labels, sides = raw.texts("EVENT", "LABELS"), raw.texts("EVENT", "CONTEXTS")
    found = []
    for i in range(times.shape[1]):
        when = float(times[0, i] * 60.0 + times[1, i])
        if not np.isfinite(when):
            continue
        label = labels[i] if i < len(labels) else "event"
        side = sides[i].casefold() if i < len(sides) else ""
        name = _EVENT_NAMES.get(label.casefold(), label)
        found.append(Event(name, when, side, source=f'file, "{label}"'))
    return tuple(sorted(found, key=lambda event: event.time))


def _settings(raw: C3DFile) -> dict[str, str]:
    found = {}
    for group in ("PROCESSING", "SUBJECTS"):
        for name in ("BODYMASS", "MASS", "WEIGHT"):
            mass = raw.number(group, name)
            if 5.0 < mass < 300.0 and name != "WEIGHT":
                found["body mass (kg)"] = f"{mass:.6g}"
    company = raw.texts("MANUFACTURER", "COMPANY")
    if company and company[0]:
        found["made by"] = company[0]
    return found
