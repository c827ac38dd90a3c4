"""Plain tables (CSV, XLSX) as trials: columns by profile, or recognised by name."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from underfoot.core import DataError, nearest_match

from ..plates import finished_plate, plate_axes, refused_plate, up_from_normal
from ..trial import Channel, Marker, Plate, Trial
from .profile import PlateColumns, Profile
from .sheet import Sheet, sheet_from
from .text import is_number, rate_of
from .unit_factors import si_unit

_TIME = ("time", "t", "abs time", "time s", "zeit", "tiempo", "temps", "elapsed time", "timestamp")
_FORCE = re.compile(
    r"^(?P<before>(?:.*[^a-z])?)f(?:orce)?[ _.]?(?P<axis>[xyz])(?P<after>.*)$", re.I
)
_POINT = re.compile(r"^(?P<base>.*?)[ _.:]?(?P<axis>[xyz])$", re.I)
_NOT_POINTS = re.compile(r"^(f|force|m|moment|torque|a|v|acc|gyro|cop|.*force|.*moment)$", re.I)
_RATE = re.compile(r"rate|frequency|hz", re.I)


def read_columns(
    data: bytes, path: Path, checksum: str, profile: Profile, *, subtract_baseline: bool = True
) -> Trial:
    """Return the trial in a plain table.

    With ``profile`` its columns are used; what it does not name is recognised: time, force
    triples (Fx, Fy, Fz with any ending), marker triples (name_x, name_y, name_z).

    Raises
    ------
    DataError
        No table, no time and no rate, a column of the profile missing, unknown unit.
    """
    sheet = sheet_from(
        data,
        path,
        sheet=profile.sheet,
        delimiter=profile.delimiter,
        header_line=profile.header_line,
    )
    kinds = {b"PK\x03\x04": "XLSX table", b"\xd0\xcf\x11\xe0": "XLS table"}
    source = kinds.get(data[:4], "text table")
    return trial_from_sheet(
        sheet, checksum, profile, source=source, subtract_baseline=subtract_baseline
    )


def trial_from_sheet(
    sheet: Sheet, checksum: str, profile: Profile, *, source: str, subtract_baseline: bool = True
) -> Trial:
    """Return the trial in named columns; errors as ``read_columns``."""
    notes = list(sheet.notes)
    if sheet.texts:
        notes.append(f"columns that hold text are left out: {', '.join(list(sheet.texts)[:6])}")
    rate, start, times = _time(sheet, profile, notes)
    channels = _channels(sheet, profile, rate, start, times)
    plates: list[Plate] = []
    for name, columns in _plate_columns(sheet, profile, notes, plates).items():
        if times is not None:
            notes.append("samples are not equally spaced: no plates were made")
            break
        plates.append(_plate(name, columns, sheet, rate, start, profile, subtract_baseline))
    markers = {}
    for name, (triple, unit) in _marker_columns(sheet, profile, notes).items():
        factor = _factor(unit, "m", f"{sheet.name}, marker {name}")
        positions = np.column_stack([_column(sheet, c) for c in triple]) * factor
        markers[name] = Marker(positions, rate, start, times)
    return Trial(
        sheet.name,
        channels=channels,
        plates=tuple(plates),
        markers=markers,
        source=source,
        checksum=checksum,
        notes=tuple(notes),
    )


def _column(sheet: Sheet, name: str) -> np.ndarray:
    folded = {key.casefold().strip(): key for key in reversed(list(sheet.numbers))}
    key = name if name in sheet.numbers else folded.get(name.casefold().strip())
    if key is None:
        raise DataError(
            f'there is no column "{name}" of numbers',
            where=sheet.name,
            allowed=", ".join(list(sheet.numbers)[:12]),
            nearest=nearest_match(name, sheet.numbers),
            remedy="Correct the name in the profile",
        )
    return sheet.numbers[key]


def _unit_of(sheet: Sheet, name: str) -> str:
    return sheet.units.get(name, "")


def _factor(unit: str, dimension: str, where: str) -> float:
    known = si_unit(unit)
    if known is None or known[0] != dimension:
        raise DataError(f'"{unit}" is not a known unit of {dimension}', where=where)
    return known[1]


def _time(
    sheet: Sheet, profile: Profile, notes: list[str]
) -> tuple[float, float, np.ndarray | None]:
    if profile.rate is not None and profile.time is None:
        return profile.rate, 0.0, None
    name = profile.time
    if name is None:
        name = next((key for key in sheet.numbers if _is_time(sheet, key)), None)
    if name is None:
        rate = _rate_in(sheet.header)
        if rate is None:
            raise DataError(
                "there is no time column and no sampling rate",
                where=sheet.name,
                allowed=f"a column called time; found {', '.join(sheet.columns[:8])}",
                remedy='Say rate = "1000 Hz" or time = "..." under [file] in a profile',
            )
        notes.append(f"sampling rate {rate:g} Hz from the header")
        return rate, 0.0, None
    values = _column(sheet, name)
    written = profile.time_unit or _unit_of(sheet, name)
    unit = si_unit(written) if written else ("s", 1.0, 0.0)
    if unit is None or unit[0] != "s":
        raise DataError(f'the time column has the unit "{written}"', where=sheet.name)
    if not written:
        notes.append("time without a unit: taken as s")
    return rate_of(values * unit[1], sheet.name)


def _is_time(sheet: Sheet, name: str) -> bool:
    """A name for time whose unit, if there is one, is a unit of time (T may be temperature)."""
    written = _unit_of(sheet, name)
    unit = si_unit(written) if written else None
    if written and (unit is None or unit[0] != "s"):
        return False
    return name.casefold().replace("_", " ") in _TIME and (name != "T" or bool(written))


def _rate_in(header: Sequence[str]) -> float | None:
    for line in header:
        if not _RATE.search(line):
            continue
        for word in re.split(r"[\s=:,;]+", line):
            if is_number(word) and 0 < float(word) < 1e6:
                return float(word)
    return None


def _channels(
    sheet: Sheet, profile: Profile, rate: float, start: float, times: np.ndarray | None
) -> dict[str, Channel]:
    found = {}
    for name, (column, unit, scale) in profile.channels.items():
        written = unit or _unit_of(sheet, column)
        known = si_unit(written) if written else None
        si, factor, offset = known if known else ("", 1.0, 0.0)
        values = _column(sheet, column) * (scale * factor) + offset
        found[name] = Channel(values, si, rate, start, times, f'column "{column}"')
    for name, values in sheet.numbers.items():
        if name in found:
            continue
        written = _unit_of(sheet, name)
        known = si_unit(written) if written else None
        si, factor, offset = known if known else ("", 1.0, 0.0)
        note = f'in "{written}" in the file' if written else "no unit in the file"
        found[name] = Channel(values * factor + offset, si, rate, start, times, note)
    return found


def _plate_columns(
    sheet: Sheet, profile: Profile, notes: list[str], plates: list[Plate]
) -> dict[str, PlateColumns]:
    """Columns of the plates; triples whose unit is no force become refused plates."""
    if profile.plates:
        return dict(profile.plates)
    groups: dict[tuple[str, str], dict[str, str]] = {}
    for name in sheet.numbers:
        match = _FORCE.match(name)
        if match:
            key = (match["before"].casefold(), match["after"].casefold())
            groups.setdefault(key, {}).setdefault(match["axis"].casefold(), name)
    found = {}
    for triple in groups.values():
        if set(triple) != {"x", "y", "z"}:
            continue
        units = {_unit_of(sheet, triple[axis]) for axis in "xyz"}
        known = [si_unit(unit) for unit in units if unit]
        if len(units) > 1 or any(unit is None or unit[0] != "N" for unit in known):
            written = ", ".join(sorted(f'"{unit}"' for unit in units))
            names = f"{triple['x']}, {triple['y']}, {triple['z']}"
            plates.append(refused_plate(names, f"{written} is not one known unit of force"))
            continue
        unit = units.pop()
        if not unit:
            notes.append(f"{triple['x']}, {triple['y']}, {triple['z']}: taken as N")
        label = f"plate {len(found) + 1}"
        found[label] = PlateColumns((triple["x"], triple["y"], triple["z"]), unit=unit or "N")
        notes.append(
            f"{label} recognised from {triple['x']}, {triple['y']}, {triple['z']}, "
            "taken as the force on the foot: a profile can say otherwise"
        )
    return found


def _plate(
    name: str,
    columns: PlateColumns,
    sheet: Sheet,
    rate: float,
    start: float,
    profile: Profile,
    subtract_baseline: bool,
) -> Plate:
    where = f"{sheet.name}, plate {name}"
    turn = -1.0 if columns.force_is == "on the plate" else 1.0
    rows = len(next(iter(sheet.numbers.values())))
    force = np.column_stack(
        [
            _column(sheet, c) * _force_factor(sheet, c, columns.unit, where)
            if c
            else np.zeros(rows)
            for c in columns.force
        ]
    )
    force = force * turn * np.asarray(columns.sign)
    length = _factor(columns.length_unit, "m", where)
    corners = None if columns.corners is None else np.array(columns.corners) * length
    place = None
    if columns.centre_of_pressure:
        place = np.column_stack([_column(sheet, c) for c in columns.centre_of_pressure]) * length
    return finished_plate(
        name if name.startswith("plate") else f"plate {name}",
        force,
        rate=rate,
        start=start,
        up=_up(force, corners, profile),
        centre_of_pressure=place,
        corners=corners,
        kind="columns " + ", ".join(columns.force),
        subtract_baseline=subtract_baseline and profile.subtract_baseline,
    )


def _force_factor(sheet: Sheet, column: str, unit: str, where: str) -> float:
    """Factor to N: the unit of the profile, else the one in the heading, else N."""
    written = unit or _unit_of(sheet, column) or "N"
    return _factor(written, "N", where)


def _up(force: np.ndarray, corners: np.ndarray | None, profile: Profile) -> np.ndarray:
    up = np.zeros(3)
    if profile.vertical:
        up["xyz".index(profile.vertical[-1])] = -1.0 if profile.vertical[0] == "-" else 1.0
        return up
    if corners is not None:
        return up_from_normal(plate_axes(corners)[:, 2])
    load = np.nan_to_num(np.nanpercentile(np.abs(force), 95, axis=0)) if len(force) else up
    up[int(np.argmax(load))] = 1.0
    return up


def _marker_columns(
    sheet: Sheet, profile: Profile, notes: list[str]
) -> dict[str, tuple[tuple[str, str, str], str]]:
    found = dict(profile.markers)
    groups: dict[str, dict[str, str]] = {}
    for name in sheet.numbers:
        match = _POINT.match(name)
        if match and match["base"] and not _NOT_POINTS.match(match["base"]):
            groups.setdefault(match["base"], {}).setdefault(match["axis"].casefold(), name)
    for base, triple in groups.items():
        if set(triple) != {"x", "y", "z"} or base in found or _FORCE.match(triple["x"]):
            continue
        unit = _unit_of(sheet, triple["x"])
        if unit:
            known = si_unit(unit)
            if known is None or known[0] != "m":
                continue
        else:
            size = np.nanmedian(np.abs(sheet.numbers[triple["z"]]))
            unit = "mm" if size > 20.0 else "m"
            notes.append(f"marker {base} without a unit: taken as {unit} from its size")
        found[base] = ((triple["x"], triple["y"], triple["z"]), unit)
    return found
