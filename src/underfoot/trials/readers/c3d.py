"""C3D files: markers, analog channels, force plates and events as a trial."""

import numpy as np

from underfoot.core import DataError

from .. import plates
from ..measurement import Flag
from ..trial import Event, Trial
from .c3d_bytes import C3DFile, parse
from .draft import Draft
from .unit_factors import si_unit

_COMPUTED = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS")
_EVENT_NAMES = {
    "foot strike": "heel contact", "heel strike": "heel contact", "foot off": "toe off",
    "toe off": "toe off",
}  # fmt: skip


def read_c3d(draft: Draft) -> Trial:
    """Return the trial in a C3D file.

    A plate that can't be worked out is kept with its reason; the rest of the file is read.
    """
    raw = parse(draft.data, draft.name)
    unit = (raw.texts("POINT", "UNITS") or [""])[0]
    size = np.nanmedian(np.abs(raw.points)) if np.isfinite(raw.points).any() else 1000.0
    unknown = f'unit of the markers "{unit}" is not known'
    scale = draft.length_unit(unit, float(size), unknown, "their size")
    draft.start = (raw.first_frame - 1) / raw.point_rate if raw.first_frame > 0 else 0.0
    units = raw.texts("ANALOG", "UNITS")
    draft.rate = raw.analog_rate
    for index in range(_plate_count(raw)):
        _plate(draft, raw, index, units, scale)
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
            draft.marker(name, raw.points[:, i] * scale)
    left_out = sum(label in computed for label in labels)
    if left_out:
        draft.notes.append(f"{left_out} points are computed angles, forces or powers: left out")
    draft.events, draft.settings = _events(raw), _settings(raw)
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


def _plate(draft: Draft, raw: C3DFile, index: int, units: list[str], scale: float) -> None:
    name = f"plate {index + 1}"
    kinds = raw.whole_numbers("FORCE_PLATFORM", "TYPE").ravel(order="F")
    kind = int(kinds[index]) if index < kinds.size else 0
    words = plates.KINDS.get(kind, f"type {kind}")
    try:
        if kind not in plates.CHANNELS:
            raise DataError(f"plate type {kind} is not supported", allowed="types 1 to 4")
        numbers = _of_plate(raw.whole_numbers("FORCE_PLATFORM", "CHANNEL"), index, "CHANNEL", 1)
        columns = numbers[: plates.CHANNELS[kind]] - 1
        if len(columns) < plates.CHANNELS[kind]:
            raise DataError(f"{words} needs {plates.CHANNELS[kind]} channels")
        most = raw.analog.shape[1]
        if columns.max() >= most:
            raise DataError(f"it names channel {int(columns.max()) + 1} of {most}")
        if columns.min() < 0:
            raise DataError("it names a channel below 1")
        corners = _of_plate(raw.numbers("FORCE_PLATFORM", "CORNERS"), index, "CORNERS", 2, (3, 4)).T
        corners, crossed = plates.ordered_corners(corners * scale)
        flag = Flag("corners", "its corners come in crossed order: re-ordered")
        axes = plates.plate_axes(corners)
        origin = _of_plate(raw.numbers("FORCE_PLATFORM", "ORIGIN"), index, "ORIGIN", 1) * scale
        if origin.shape != (3,) or not np.isfinite(origin).all():
            raise DataError("ORIGIN is damaged")
        signals = raw.analog[:, columns]
        notes: list[str] = []
        if kind == 4:
            matrix = raw.numbers("FORCE_PLATFORM", "CAL_MATRIX")
            matrix = _of_plate(matrix, index, "CAL_MATRIX", 2, (6, 6))
            force, moment = plates.channel_forces(kind, signals, origin, matrix)
            # The matrix turns raw counts into N and N times the file's unit of length.
            lever = np.cross(-origin if origin[2] > 0 else origin, force)
            moment = (moment + lever) * scale - lever
        else:
            known = _in_si(signals, columns, units, kind, scale, notes)
            force, moment = plates.channel_forces(kind, known, origin, None)
        if not np.isfinite(force).any() or np.abs(force[np.isfinite(force)]).max() > 1e9:
            raise DataError("its forces are not numbers of any possible size")
        zero = raw.numbers("FORCE_PLATFORM", "ZERO").ravel(order="F")
        if zero.size == 2 and zero[1] > zero[0] > 0:
            notes.append(f"ZERO names samples {int(zero[0])} to {int(zero[1])}")
        draft.plate(
            force @ axes.T,
            name,
            up=plates.up_from_normal(axes[:, 2]),
            moment=moment @ axes.T,
            corners=corners,
            raw=signals,
            kind=words,
            notes=tuple(notes),
            flags=(flag,) if crossed else (),
        )
    except DataError as error:
        reason = error.what + (f" ({error.allowed})" if error.allowed else "")
        draft.plates.append(plates.refused_plate(name, reason, rate=raw.analog_rate, kind=words))


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
        si, factors[i] = kinds[letter]
        unit = si_unit(written)
        if unit and unit[0] == si:
            factors[i] = unit[1]
        else:
            unknown.add(f'"{written}" as {si}')
    if unknown:
        notes.append("units assumed: " + ", ".join(sorted(unknown)))
    return signals * factors


def _of_plate(
    values: np.ndarray, index: int, name: str, dimensions: int, shape: tuple[int, ...] | None = None
) -> np.ndarray:
    """Part of a parameter that is one plate's; files with one plate may leave out the last axis."""
    if values.ndim == dimensions and index == 0 and values.size:
        values = values[..., None]
    wanted = shape or values.shape[:-1]
    if len(wanted) != dimensions or values.shape[:-1] != wanted or index >= values.shape[-1]:
        raise DataError(f"FORCE_PLATFORM:{name} does not describe it")
    return values[..., index]


def _events(raw: C3DFile) -> tuple[Event, ...]:
    times = raw.numbers("EVENT", "TIMES")
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
    found = {}
    for group in ("PROCESSING", "SUBJECTS"):
        for name in ("BODYMASS", "MASS"):
            mass = raw.number(group, name)
            if 5.0 < mass < 300.0:
                found["body mass (kg)"] = f"{mass:.6g}"
    company = raw.texts("MANUFACTURER", "COMPANY")
    if company and company[0]:
        found["made by"] = company[0]
    return found
