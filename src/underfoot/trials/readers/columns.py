"""Plain tables (CSV, XLSX) as trials: columns by profile, or recognised by name."""

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from underfoot.core import DataError, nearest_match
from underfoot.core.errors import first_names
from underfoot.core.remark import Message

from ..recording.plates import refused_plate
from ..recording.trial import Trial
from .draft import RecordingDraft
from .formats import nearest_format
from .profile import PlateColumns
from .sheet import Sheet, is_workbook, sheet_from, workbook_sheets
from .text import clock_time, force_unit, is_number, is_written_number, si_unit

_TIME = ("time", "t", "abs time", "time s", "zeit", "tiempo", "temps", "elapsed time", "timestamp")
_CLOCK_UNITS = ("s", "ms", "sec", "msec", "us")
"""What a column of times is called where its unit stands alone."""
_BODY_AXES = {
    "x": r"medio[ -]?lateral|lateral|ml|m-l",
    "y": r"anterior[ -]?posterior|antero[ -]?posterior|ap|a-p",
    "z": r"vertical|vert",
}
"""Axes of a plate in words of the body; which way they count is found as of any plate."""
_PLATE = re.compile(
    r"^(?:(?P<before>(?:.*[^a-z])?)(?P<kind>f|grf|force|kraft|fuerza|forza|m|mom|moment|t|torque|a|p|"
    r"cop|cent(?:re|er)[ _]?of[ _]?pressure)[ _.]?(?P<number>\d*)[ _.]?"
    r"|(?P<ground>.*(?:ground|grf).*[^a-z])(?P<vector>[vp]))(?P<axis>[xyz])(?P<after>.*)$",
    re.I,
)
"""Fx1, Force_x, FP1_Fx, F1X (AMTI), GRF1x, ground_force_1_vx (OpenSim)."""
# Names of a tribometer's columns, letters only.
_NORMAL = {"normalforce", "normalload", "normalkraft", "fz", "fn", "load", "last", "auflast"}
_SHEAR = {
    "frictionforce",
    "shearforce",
    "tangentialforce",
    "reibkraft",
    "reibungskraft",
    "fx",
    "ft",
}
_COF = {"cof", "\u03bc", "frictioncoefficient", "coefficientoffriction", "reibwert", "reibungszahl"}
_WHAT = re.compile(r"(forces?|moments?|torques?|cop|centre|center)[ _.:]*$", re.I)
_DAY = 86_400.0  # s
_FAR = 5.0  # m; no plate lies further from the origin: larger numbers are mm
_POINT = re.compile(r"^(?P<before>.*?)[ _.:]?(?P<axis>[xyz])$", re.I)
_NOT_POINTS = re.compile(r"^(f|force|m|moment|torque|a|v|acc|gyro|cop|.*force|.*moment)$", re.I)
_INDEX = re.compile(r":,(\d)")
"""What kineticstoolkit writes behind a name: heel[:,0] is x of the heel, heel[:,3] always 1."""
_AXIS_FIRST = re.compile(r"^(?P<axis>[xyz])_(?P<base>.+)$")
"""x_heel, as pyomeca writes it."""
_PREAMBLE = 2  # lines above the names of columns, from which a text has a format of its own
_RATE = re.compile(r"rate|frequency|hz", re.I)


def read_columns(draft: RecordingDraft) -> tuple[Trial, ...]:
    """Return the trial in a plain table, of a workbook one for each sheet with the same columns.

    With the profile its columns are used; what it does not name is recognised: time, force
    triples (Fx, Fy, Fz with any ending), marker triples (name_x, name_y, name_z).
    """
    profile = draft.profile
    form = profile.delimiter, profile.header_line
    read = sheet_from(draft.data, draft.name, profile.sheet, *form)
    alike = {}
    if profile.sheet is None and is_workbook(draft.data):
        names = workbook_sheets(draft.data, draft.name)
        for name in names if len(names) > 1 else ():
            with suppress(DataError):  # a sheet without a table
                other = sheet_from(draft.data, f"{draft.name}, {name}", name, *form)
                if other.columns == read.columns:
                    alike[name] = other
    sheet = _with_axes_behind(read)
    above = [line for line in sheet.header if line.strip()]
    named = profile.name or profile.plates or profile.channels or _is_known(sheet)
    if not named and len(above) > _PREAMBLE:
        words = Message(
            "text of an unknown system: {count} lines stand above the table", count=len(above)
        )
        remedy = "Name its columns in a profile, or export as C3D or as a plain table"
        nearest = nearest_format(above)
        raise DataError(words, where=draft.name, nearest=nearest, remedy=remedy)
    kinds = {b"PK\x03\x04": "XLSX table", b"\xd0\xcf\x11\xe0": "XLS table"}
    kind = kinds.get(draft.data[:4], "text table")
    if len(alike) < 2:
        return (trial_from_sheet(draft, sheet, kind),)
    return tuple(
        trial_from_sheet(
            RecordingDraft(b"", one.name, profile, draft.subtract_baseline),
            _with_axes_behind(one),
            kind,
        )
        for one in alike.values()
    )


def _with_axes_behind(sheet: Sheet) -> Sheet:
    """Return the columns of points and vectors called name_x, name_y and name_z.

    Matrices of kineticstoolkit (``[:,0,0]``) are left out; its index is the time.
    """
    names: dict[str, str] = {}
    triples: dict[str, dict[str, str]] = {}
    for name in sheet.numbers:
        unit = sheet.units.get(name, "")
        if index := _INDEX.fullmatch(unit):
            base = re.sub(r" #\d+$", "", name)
            names[name] = f"{base}_{'xyz'[int(index[1])]}" if int(index[1]) < len("xyz") else ""
        elif unit.startswith(":,"):
            names[name] = ""
        elif match := _AXIS_FIRST.match(name):
            triples.setdefault(match["base"], {})[match["axis"]] = name
    if names and (first := next(iter(sheet.numbers))) not in names:
        names[first] = "time"
    for base, columns in triples.items():
        if len(columns) == len("xyz"):
            names |= {name: f"{base}_{axis}" for axis, name in columns.items()}
    new = {name: names.get(name, name) for name in sheet.numbers}
    return replace(
        sheet,
        numbers={new[name]: values for name, values in sheet.numbers.items() if new[name]},
        units={
            new.get(name, name): unit
            for name, unit in sheet.units.items()
            if not unit.startswith(":,")
        },
    )


def _is_known(sheet: Sheet) -> bool:
    """Whether the columns tell by themselves what they are: a time, and forces or a COF."""
    folded = {_fold_name(name) for name in sheet.numbers}
    forces = folded & _NORMAL and folded & _SHEAR
    return any(_is_time(sheet, name) for name in sheet.numbers) and bool(
        forces or folded & _COF or _plate_groups(sheet)
    )


def _fold_name(name: str) -> str:
    return re.sub("^daq|[^a-z\u03bc]", "", name.casefold())


def trial_from_sheet(draft: RecordingDraft, sheet: Sheet, source: str) -> Trial:
    """Return the trial in named columns."""
    profile = draft.profile
    draft.notes += sheet.notes
    left = [name for name in sheet.texts if not _is_time(sheet, name)]
    if left:
        names = ", ".join(left[:6])
        draft.notes.append(Message("columns that hold text are left out: {names}", names=names))
    _clock(draft, sheet)
    for name, (column, unit, scale) in profile.channels.items():
        written, values = unit or sheet.units.get(column, ""), _column(sheet, column)
        draft.channel(
            name, values, written, scale=scale, note=Message('column "{column}"', column=column)
        )
    for name, values in sheet.numbers.items():
        if name in draft.channels:
            continue
        written = sheet.units.get(name, "")
        force = force_unit(written) if _fold_name(name) in _NORMAL | _SHEAR else None
        if force and not si_unit(written):  # a mass, which stands for its weight
            note = Message('in "{written}" in the file', written=written)
            draft.channel(name, values, unit="N", scale=force[1], note=note)
        else:
            draft.channel(name, values, written)
    plates = profile.plates or _plate_columns(draft, sheet)
    if plates and draft.times is not None:
        draft.notes.append("samples are not equally spaced: no plates were made")
    for name, columns in plates.items() if draft.times is None else ():
        _plate(draft, name, columns, sheet)
    for name, (triple, unit) in _marker_columns(draft, sheet).items():
        factor = _factor(
            unit, "m", Message("{file}, marker {marker}", file=sheet.name, marker=name)
        )
        draft.marker(name, np.column_stack([_column(sheet, c) for c in triple]) * factor)
    return draft.trial(source)


def _column(sheet: Sheet, name: str) -> np.ndarray:
    folded = {key.casefold().strip(): key for key in reversed(list(sheet.numbers))}
    key = name if name in sheet.numbers else folded.get(name.casefold().strip())
    if key is None:
        raise DataError(
            Message('there is no column "{name}" of numbers', name=name),
            where=sheet.name,
            allowed=first_names(sheet.numbers),
            nearest=nearest_match(name, sheet.numbers),
            remedy="Correct the name in the profile",
        )
    return sheet.numbers[key]


def _factor(unit: str, dimension: str, where: str) -> float:
    known = force_unit(unit) if dimension == "N" else si_unit(unit)
    if known is None or known[0] != dimension:
        raise DataError(
            Message('"{unit}" is not a known unit of {dimension}', unit=unit, dimension=dimension),
            where=where,
        )
    return known[1]


def _clock(draft: RecordingDraft, sheet: Sheet) -> None:
    profile = draft.profile
    if profile.rate is not None and profile.time is None:
        draft.rate = profile.rate
        return
    name = profile.time or next((key for key in sheet.columns if _is_time(sheet, key)), None)
    if name is not None and name in sheet.texts:
        draft.clock(_clock_times(sheet, name), restarts=True)
        return
    if name is None:
        draft.rate = _rate_in(sheet.header)
        if not draft.rate:
            raise draft.error(
                "there is no time column and no sampling rate",
                allowed=Message(
                    "a column called time; found {column}", column=", ".join(sheet.columns[:8])
                ),
                remedy='Say rate = "1000 Hz" or time = "..." under [file] in a profile. A table of '
                "readings, a number a run, needs a protocol of readings: --protocol machine_cof",
            )
        draft.notes.append(Message("sampling rate {rate:g} Hz from the header", rate=draft.rate))
        return
    values = _column(sheet, name)
    written = profile.time_unit or sheet.units.get(name, "") or name * (name in _CLOCK_UNITS)
    unit = si_unit(written or "s")
    if unit is None or unit[0] != "s":
        raise draft.error(Message('the time column has the unit "{written}"', written=written))
    if not written:
        draft.notes.append("time without a unit: taken as s")
    draft.clock(values * unit[1], restarts=True)


def _clock_times(sheet: Sheet, name: str) -> np.ndarray:
    """Return the seconds of a column of clock times: "10:15:20.001", with a date or without."""
    cells = sheet.texts[name]
    times = [clock_time(cell) for cell in cells]
    wrong = [cell for cell, time in zip(cells, times, strict=True) if time is None]
    if wrong:
        # of a column of seconds, the cell that made it a column of text
        cell = next((cell for cell in wrong if not is_written_number(cell)), wrong[0])
        raise DataError(
            Message('"{text}" in the column "{name}" is no time', text=cell, name=name),
            where=sheet.name,
            allowed='seconds, or a clock as "10:15:20.001"',
        )
    seconds = np.array(times, dtype=float)
    nights = np.cumsum(np.diff(seconds, prepend=seconds[0]) < -0.5 * _DAY)
    return seconds - seconds[0] + _DAY * nights


def _is_time(sheet: Sheet, name: str) -> bool:
    """A name for time whose unit, if there is one, is a unit of time (T may be temperature)."""
    written = sheet.units.get(name, "")
    if written and (si_unit(written) or ("",))[0] != "s":
        return False
    if not written and name in _CLOCK_UNITS:
        return True
    return name.casefold().replace("_", " ") in _TIME and (name != "T" or bool(written))


def _rate_in(header: Sequence[str]) -> float:
    lines = (line for line in header if _RATE.search(line))
    words = (word for line in lines for word in re.split(r"[\s=:,;]+", line))
    return next((float(w) for w in words if is_number(w) and 0 < float(w) < 1e6), 0.0)


def _with_axis(name: str) -> str:
    """Return "Force z 1" of "Vertical force 1": axes in words of the body as letters."""
    for axis, words in _BODY_AXES.items():
        word = rf"(?:^|(?<=[\s_.-]))(?:{words})(?:$|(?=[\s_.-]))"
        rest = re.sub(word, "", name, flags=re.IGNORECASE)
        if rest != name:
            return re.sub(
                r"(?i)(?<![a-z])(force|grf)[\s_.-]*", rf"\1 {axis} ", rest.strip(" _.-"), count=1
            )
    return name


def _plate_groups(sheet: Sheet) -> dict[tuple[str, str], dict[str, dict[str, str]]]:
    """Names of columns by plate (what stands before and behind), quantity (f, m, c) and axis."""
    groups: dict[tuple[str, str], dict[str, dict[str, str]]] = {}
    for name in sheet.numbers:
        match = _PLATE.match(_with_axis(name))
        if match:
            letter = (match["kind"] or match["vector"])[0].casefold()
            kind = {"f": "f", "g": "f", "k": "f", "v": "f", "m": "m", "t": "m"}.get(letter, "c")
            before = match["ground"] or match["before"] + match["number"]
            key = _WHAT.sub("", before.casefold()), match["after"].casefold()
            columns = groups.setdefault(key, {}).setdefault(kind, {})
            columns.setdefault(match["axis"].casefold(), name)
    return {key: kinds for key, kinds in groups.items() if len(kinds.get("f", {})) == 3}


def _plate_columns(draft: RecordingDraft, sheet: Sheet) -> dict[str, PlateColumns]:
    """Columns of the plates; triples whose unit is no force become refused plates."""
    plates: dict[str, PlateColumns] = {}
    for kinds in _plate_groups(sheet).values():
        x, y, z = (kinds["f"][axis] for axis in "xyz")
        names = f"{x}, {y}, {z}"
        units = {sheet.units.get(name, "") for name in (x, y, z)}
        if len(units) > 1 or any((force_unit(unit) or ("",))[0] != "N" for unit in units if unit):
            written = ", ".join(sorted(f'"{unit}"' for unit in units))
            draft.plates.append(
                refused_plate(names, Message("{unit} is not one known unit of force", unit=written))
            )
            continue
        unit = units.pop()
        if not unit:
            draft.notes.append(Message("{names}: taken as N", names=names))
        label = f"plate {len(plates) + 1}"
        place, length = _pressure_columns(draft, sheet, kinds.get("c", {}), label)
        plates[label] = PlateColumns(
            (x, y, z), unit=unit or "N", centre_of_pressure=place, length_unit=length
        )
        draft.notes.append(
            Message(
                "{label} recognised from {names}, taken as the force on the foot: a "
                "profile can say otherwise",
                label=label,
                names=names,
            )
        )
    return plates


def _pressure_columns(
    draft: RecordingDraft, sheet: Sheet, columns: dict[str, str], label: str
) -> tuple[tuple[str, str, str] | None, str]:
    """Columns of a centre of pressure, in two axes or three, and their unit."""
    if len(columns) < 2:
        return None, "m"
    x, y, z = (columns.get(axis, "") for axis in "xyz")
    units = {sheet.units.get(name, "") for name in columns.values()}
    unit = units.pop()
    if units or (unit and (si_unit(unit) or ("",))[0] != "m"):
        draft.notes.append(
            Message(
                "{label}: the centre of pressure has no one unit of length: left out", label=label
            )
        )
        return None, "m"
    if not unit:
        values = np.abs(np.concatenate([sheet.numbers[name] for name in columns.values()]))
        far = np.isfinite(values).any() and float(np.nanpercentile(values, 90)) > _FAR
        unit = "mm" if far else "m"
        draft.notes.append(
            Message(
                "{label}: centre of pressure taken as {unit} from its size", label=label, unit=unit
            )
        )
    return (x, y, z), unit


def _plate(draft: RecordingDraft, name: str, columns: PlateColumns, sheet: Sheet) -> None:
    where = Message("{file}, plate {plate}", file=sheet.name, plate=name)
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
        zero = np.zeros(len(force))
        axes = [_column(sheet, c) if c else zero for c in columns.centre_of_pressure]
        place = np.column_stack(axes) * length
    draft.plate(
        force,
        name if name.startswith("plate") else f"plate {name}",
        centre_of_pressure=place,
        corners=corners,
        kind=Message("columns {names}", names=columns.force),
    )


def _marker_columns(
    draft: RecordingDraft, sheet: Sheet
) -> dict[str, tuple[tuple[str, str, str], str]]:
    markers = dict(draft.profile.markers)
    plates = _plate_groups(sheet).values()
    forces = {name for kinds in plates for columns in kinds.values() for name in columns.values()}
    groups: dict[str, dict[str, str]] = {}
    for name in sheet.numbers:
        match = _POINT.match(name)
        if match and name not in forces:
            columns = groups.setdefault(match["before"], {})
            columns.setdefault(match["axis"].casefold(), name)
    without: dict[str, tuple[str, str, str]] = {}
    for base, columns in groups.items():
        if len(columns) < 3 or not base or _NOT_POINTS.match(base) or base in markers:
            continue
        triple = columns["x"], columns["y"], columns["z"]
        unit = sheet.units.get(triple[0], "")
        if not unit:
            without[base] = triple
        elif (si_unit(unit) or ("",))[0] == "m":
            markers[base] = (triple, unit)
    if without:
        columns = [sheet.numbers[name] for triple in without.values() for name in triple]
        metres = draft.length_unit("", np.array(columns), ", ".join(list(without)[:4]))
        unit = {1.0: "m", 1e-2: "cm", 1e-3: "mm"}.get(metres, draft.profile.length_unit or "m")
        markers |= {base: (triple, unit) for base, triple in without.items()}
    return markers
