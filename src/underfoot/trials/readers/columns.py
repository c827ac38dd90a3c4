"""Plain tables (CSV, XLSX) as trials: columns by profile, or recognised by name."""

import re
from collections.abc import Iterator, Sequence

import numpy as np

from underfoot.core import DataError, nearest_match

from ..recording.axes import axis_vector
from ..recording.plates import plate_axes, refused_plate, up_from_normal
from ..recording.trial import Trial
from .draft import Draft
from .formats import nearest_format
from .profile import PlateColumns, Profile
from .sheet import Sheet, sheet_from
from .text import is_number, si_unit

_TIME = ("time", "t", "abs time", "time s", "zeit", "tiempo", "temps", "elapsed time", "timestamp")
_FORCE = re.compile(
    r"^(?P<before>(?:.*[^a-z])?)f(?:orce)?[ _.]?(?P<axis>[xyz])(?P<after>.*)$", re.I
)
_POINT = re.compile(r"^(?P<before>.*?)[ _.:]?(?P<axis>[xyz])$", re.I)
_NOT_POINTS = re.compile(r"^(f|force|m|moment|torque|a|v|acc|gyro|cop|.*force|.*moment)$", re.I)
_PREAMBLE = 2  # lines above the names of columns, from which a text has a format of its own
_RATE = re.compile(r"rate|frequency|hz", re.I)


def read_columns(draft: Draft) -> Trial:
    """Return the trial in a plain table.

    With the profile its columns are used; what it does not name is recognised: time, force
    triples (Fx, Fy, Fz with any ending), marker triples (name_x, name_y, name_z).
    """
    own = draft.profile
    sheet = sheet_from(draft.data, draft.name, own.sheet, own.delimiter, own.header_line)
    above = [line for line in sheet.header if line.strip()]
    if not own.name and not own.plates and not own.channels and len(above) > _PREAMBLE:
        words = f"text of an unknown system: {len(above)} lines stand above the table"
        remedy = "Name its columns in a profile, or export as C3D or as a plain table"
        nearest = nearest_format(above)
        raise DataError(words, where=draft.name, nearest=nearest, remedy=remedy)
    kinds = {b"PK\x03\x04": "XLSX table", b"\xd0\xcf\x11\xe0": "XLS table"}
    return trial_from_sheet(draft, sheet, kinds.get(draft.data[:4], "text table"))


def trial_from_sheet(draft: Draft, sheet: Sheet, source: str) -> Trial:
    """Return the trial in named columns."""
    profile = draft.profile
    draft.notes += sheet.notes
    if sheet.texts:
        names = ", ".join(list(sheet.texts)[:6])
        draft.notes.append(f"columns that hold text are left out: {names}")
    _clock(draft, sheet)
    for name, (column, unit, scale) in profile.channels.items():
        written, values = unit or sheet.units.get(column, ""), _column(sheet, column)
        draft.channel(name, values, written, scale=scale, note=f'column "{column}"')
    for name, values in sheet.numbers.items():
        if name not in draft.channels:
            draft.channel(name, values, sheet.units.get(name, ""))
    plates = profile.plates or _plate_columns(draft, sheet)
    if plates and draft.times is not None:
        draft.notes.append("samples are not equally spaced: no plates were made")
    for name, columns in plates.items() if draft.times is None else ():
        _plate(draft, name, columns, sheet)
    for name, (triple, unit) in _marker_columns(draft, sheet).items():
        factor = _factor(unit, "m", f"{sheet.name}, marker {name}")
        draft.marker(name, np.column_stack([_column(sheet, c) for c in triple]) * factor)
    return draft.trial(source)


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


def _factor(unit: str, dimension: str, where: str) -> float:
    known = si_unit(unit)
    if known is None or known[0] != dimension:
        raise DataError(f'"{unit}" is not a known unit of {dimension}', where=where)
    return known[1]


def _clock(draft: Draft, sheet: Sheet) -> None:
    profile = draft.profile
    if profile.rate is not None and profile.time is None:
        draft.rate = profile.rate
        return
    name = profile.time or next((key for key in sheet.numbers if _is_time(sheet, key)), None)
    if name is None:
        draft.rate = _rate_in(sheet.header)
        if not draft.rate:
            raise draft.error(
                "there is no time column and no sampling rate",
                allowed=f"a column called time; found {', '.join(sheet.columns[:8])}",
                remedy='Say rate = "1000 Hz" or time = "..." under [file] in a profile',
            )
        draft.notes.append(f"sampling rate {draft.rate:g} Hz from the header")
        return
    values = _column(sheet, name)
    written = profile.time_unit or sheet.units.get(name, "")
    unit = si_unit(written or "s")
    if unit is None or unit[0] != "s":
        raise draft.error(f'the time column has the unit "{written}"')
    if not written:
        draft.notes.append("time without a unit: taken as s")
    draft.clock(values * unit[1])


def _is_time(sheet: Sheet, name: str) -> bool:
    """A name for time whose unit, if there is one, is a unit of time (T may be temperature)."""
    written = sheet.units.get(name, "")
    if written and (si_unit(written) or ("",))[0] != "s":
        return False
    return name.casefold().replace("_", " ") in _TIME and (name != "T" or bool(written))


def _rate_in(header: Sequence[str]) -> float:
    lines = (line for line in header if _RATE.search(line))
    words = (word for line in lines for word in re.split(r"[\s=:,;]+", line))
    return next((float(w) for w in words if is_number(w) and 0 < float(w) < 1e6), 0.0)


def _triples(sheet: Sheet, pattern: re.Pattern[str]) -> Iterator[tuple[str, tuple[str, str, str]]]:
    """Names of columns x, y, z that are alike but for the axis, with what stands before it."""
    groups: dict[tuple[str, str], dict[str, str]] = {}
    for name in sheet.numbers:
        match = pattern.match(name)
        if match:
            parts = match.groupdict()
            folded = parts["before"].casefold() if "after" in parts else parts["before"]
            key = folded, parts.get("after", "").casefold()
            groups.setdefault(key, {}).setdefault(parts["axis"].casefold(), name)
    for (before, _), triple in groups.items():
        if len(triple) == 3:
            yield before, (triple["x"], triple["y"], triple["z"])


def _plate_columns(draft: Draft, sheet: Sheet) -> dict[str, PlateColumns]:
    """Columns of the plates; triples whose unit is no force become refused plates."""
    plates: dict[str, PlateColumns] = {}
    for _, triple in _triples(sheet, _FORCE):
        names = ", ".join(triple)
        units = {sheet.units.get(name, "") for name in triple}
        if len(units) > 1 or any((si_unit(unit) or ("",))[0] != "N" for unit in units if unit):
            written = ", ".join(sorted(f'"{unit}"' for unit in units))
            draft.plates.append(refused_plate(names, f"{written} is not one known unit of force"))
            continue
        unit = units.pop()
        if not unit:
            draft.notes.append(f"{names}: taken as N")
        label = f"plate {len(plates) + 1}"
        plates[label] = PlateColumns(triple, unit=unit or "N")
        draft.notes.append(
            f"{label} recognised from {names}, "
            "taken as the force on the foot: a profile can say otherwise"
        )
    return plates


def _plate(draft: Draft, name: str, columns: PlateColumns, sheet: Sheet) -> None:
    where = f"{sheet.name}, plate {name}"
    force = np.zeros((len(next(iter(sheet.numbers.values()))), 3))
    for i, column in enumerate(columns.force):
        if column:  # unit of the profile, else the one in the heading, else N
            unit = columns.unit or sheet.units.get(column, "") or "N"
            force[:, i] = _column(sheet, column) * _factor(unit, "N", where)
    force *= (-1.0 if columns.force_is == "on the plate" else 1.0) * np.asarray(columns.sign)
    length = _factor(columns.length_unit, "m", where)
    corners = None if columns.corners is None else np.array(columns.corners) * length
    place = None
    if columns.centre_of_pressure:
        place = np.column_stack([_column(sheet, c) for c in columns.centre_of_pressure]) * length
    draft.plate(
        force,
        name if name.startswith("plate") else f"plate {name}",
        up=_up(force, corners, draft.profile),
        centre_of_pressure=place,
        corners=corners,
        kind="columns " + ", ".join(columns.force),
    )


def _up(force: np.ndarray, corners: np.ndarray | None, profile: Profile) -> np.ndarray:
    if profile.vertical:
        return axis_vector(profile.vertical)
    if corners is not None:
        return up_from_normal(plate_axes(corners)[:, 2])
    load = np.nan_to_num(np.nanpercentile(np.abs(force), 95, axis=0)) if len(force) else [0.0]
    return np.eye(3)[int(np.argmax(load))]


def _marker_columns(draft: Draft, sheet: Sheet) -> dict[str, tuple[tuple[str, str, str], str]]:
    markers = dict(draft.profile.markers)
    for base, triple in _triples(sheet, _POINT):
        if not base or _NOT_POINTS.match(base) or base in markers or _FORCE.match(triple[0]):
            continue
        unit = sheet.units.get(triple[0], "")
        if not unit:
            size = float(np.nanmedian(np.abs(sheet.numbers[triple[2]])))
            words = f"marker {base} without a unit"
            unit = "m" if draft.length_unit("", size, words, "its size") == 1.0 else "mm"
        if (si_unit(unit) or ("",))[0] == "m":
            markers[base] = (triple, unit)
    return markers
