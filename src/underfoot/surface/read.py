"""Profiles and maps from text, Dektak files and the formats of instruments."""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, UnderfootError, text
from underfoot.core.numbers_text import (
    NumberForm,
    any_lost,
    column_numbers,
    number_forms,
    one_unit,
)
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres

from .arrays import SPACING, is_array, read_array
from .heights import HeightMap, Profile, profile_from_positions
from .instruments import (
    complete,
    is_instrument,
    is_text,
    length_factor,
    read_instrument,
    spacings_of,
)

_QUANTITY = re.compile(r"([+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?)\s*([A-Za-zµμ]+)?")
_FORMS = (NumberForm(), NumberForm(",", True), NumberForm(".", True))
_NAMES = {".csv", ".txt", ".xyz", ".asc", ".dat", ".prf", ".tsv"}
"""Files of text that no instrument's format has."""
_AXIS = re.compile(r"(?<![a-z/])([xyz])(?![a-z])")
_NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?![\w.])")
_LENGTH = re.compile(
    r"(?<![A-Za-zµμ])(nm|um|µm|μm|micrometers?|micrometres?|microns?|[cm]m|m|inch(?:es)?|mils?|[uµμ]in"
    r"|Å|angstroms?|(?<=[\[(])in(?=[\])]))(?![A-Za-z])",
    re.I,
)


@dataclass(frozen=True, slots=True)
class TextNumbers:
    """Rows of numbers (missing ones NaN), the lines above them, and how they were read."""

    rows: np.ndarray
    header: tuple[str, ...]
    decimals: tuple[int, ...]
    first_line: int
    notes: tuple[str, ...]
    where: str

    def units(self) -> list[str]:
        """Return the length units of the headings, in order; none where headings name none."""
        return _units(self.header, self.where)


def _units(header: tuple[str, ...], where: str) -> list[str]:
    """Return the units of the last two lines above the numbers that hold no digits.

    A line such as "Length 12.5 mm" says nothing about the columns.
    """
    lines = (line for line in reversed(header[-2:]) if not re.search(r"\d", line))
    said = list(filter(None, map(_LENGTH.findall, lines)))
    if len({len(units) for units in said}) > 1:
        return said[0]  # the nearest line

    def same(first: str, other: str) -> bool:
        return length_factor(first, where) == length_factor(other, where)

    return [one_unit(units, same, where) for units in zip(*said, strict=True)]


def read_numbers(path: Path | str) -> TextNumbers:
    """Return the numbers of a text file below its header.

    Separators comma, semicolon, tab or blanks; decimal commas where commas do not separate.

    Raises:
        DataError: No such file, a binary file, no numbers, rows of different length.
    """
    where = str(path)
    lines = text.numbered_lines(path, "Read it as an instrument's format")
    start = next((i for i, (_, line) in enumerate(lines) if _is_row(line)), None)
    if start is None:
        raise DataError("the file holds no rows of numbers", where=where)
    header = tuple(line.lstrip("#").strip() for _, line in lines[:start] if line.strip())
    body = text.with_content(lines[start:])
    separator = _separator([line for _, line in body[:50]])
    rows = [text.cells_of(line, separator) for _, line in body]
    while len(rows[0]) > 1 and all(len(row) > 1 and row[-1] == "" for row in rows):
        rows = [row[:-1] for row in rows]  # instruments close their lines with separators
    count = len(rows)
    while len(rows) > 2 and not any(_holds(rows[-1][0], form) for form in _FORMS):
        rows, body = rows[:-1], body[:-1]  # words below the numbers
    width = len(rows[0])
    for (i, _), row in zip(body, rows, strict=True):
        if len(row) != width:
            raise DataError(
                Message(
                    "line {line} has {count} values, the first row has {width}",
                    line=i,
                    count=len(row),
                    width=width,
                ),
                where=where,
                remedy="Values are missing or a decimal comma is taken for a separator",
            )
    values, forms = _plain_numbers([line for _, line in body], separator), [NumberForm()] * width
    if values is None or values.shape[1] != width:
        columns = list(zip(*rows, strict=True))
        forms = number_forms(columns, where)
        values = np.empty((len(rows), width))
        for c, (cells, form) in enumerate(zip(columns, forms, strict=True)):
            try:
                values[:, c] = column_numbers(cells, form)
            except ValueError:
                k, cell = next((k, cell) for k, cell in enumerate(cells) if not _holds(cell, form))
                raise DataError(
                    Message(
                        '"{text}" in line {line} is not a number',
                        text=text.excerpt(cell),
                        line=body[k][0],
                    ),
                    where=where,
                    allowed="numbers",
                ) from None
    numbered = _is_numbered(values, len(_units(header, where)))
    decimals = tuple(
        max(len(form.plain(cell).partition(".")[2]) for cell in cells)
        if not any("e" in cell.lower() for cell in cells)
        else 17
        for cells, form in zip(zip(*rows[:200], strict=True), forms, strict=True)
    )
    left = count - len(rows)
    of_words = Message("lines of words below the numbers left out: {count}", count=left)
    said = {
        "decimal commas read as decimal points": any(form.decimal == "," for form in forms),
        "signs between thousands left out": any(form.thousands for form in forms),
        of_words: left > 0,
        "the first column counts the rows: left out": numbered,
    }
    notes = tuple(note for note, holds in said.items() if holds)
    first = 1 if numbered else 0
    return TextNumbers(values[:, first:], header, decimals[first:], start + 1, notes, where)


def _is_numbered(values: np.ndarray, units: int) -> bool:
    """Whether the first column counts the rows, beside positions and heights or a matrix."""
    rows, width = values.shape
    if rows < 10 or width < 3 or units >= width or (np.diff(values[:, 0]) != 1.0).any():
        return False
    steps = np.diff(values[:, 1])
    even = bool((np.abs(steps - steps.mean()) < 0.5 * abs(steps.mean())).all())
    return values[0, 0] in (0.0, 1.0) and (width > 3 or even)


def _plain_numbers(lines: list[str], separator: str | None) -> np.ndarray | None:
    """Return the numbers of a table that holds nothing but plain ones; None of another."""
    if any('"' in line or (separator != "," and "," in line) for line in lines):
        return None
    try:
        values = np.loadtxt(lines, delimiter=separator, ndmin=2, comments=None)
    except (ValueError, OverflowError):
        return None
    return None if not values.all() and any_lost(lines) else values


def _holds(cell: str, form: NumberForm) -> bool:
    try:
        column_numbers([cell], form)
    except ValueError:
        return False
    return True


def _is_row(line: str) -> bool:
    """Return whether a line holds numbers, in any form, and nothing else but missing ones."""
    cells = text.cells_of(line, _separator([line]))
    holds = [any(_holds(cell, form) for form in _FORMS) for cell in cells]
    return all(holds) and any(cell.casefold() not in text.MISSING for cell in cells)


def _separator(lines: list[str]) -> str | None:
    joined = re.sub(r'"[^"]*"', "0", "\n".join(lines))  # what stands between quotes is one cell
    for candidate in (";", "\t"):
        if candidate in joined:
            return candidate
    if "," not in joined:
        return None
    # Blanks between and commas within numbers: "0,10 1,25" is two numbers with decimal commas.
    between = all(
        re.fullmatch(r"[+-]?\d+(,\d+)?([eE][+-]?\d+)?", cell)
        for line in joined.splitlines()
        for cell in line.split()
    )
    if between and any(len(line.split()) > 1 for line in joined.splitlines()):
        return None
    return ","


def read_profile(
    path: Path | str,
    *,
    length_unit: str | None = None,
    height_unit: str | None = None,
    spacing: float | None = None,
    tip_radius: float | None = None,
    resample: bool = False,
    fill_missing: bool = False,
) -> Profile:
    """Return a profile from a text file with positions and heights, or heights alone.

    Units are taken from the heading ("x [mm]; z [um]") unless given. One column needs
    ``spacing`` (m). Positions may be uneven by their rounding; more needs ``resample``. Missing
    heights are refused unless ``fill_missing`` (then up to 5 % are interpolated). Both are said
    in ``processing``.

    Parameters:
        path: Text file.
        length_unit: Of positions; None takes that of the heading.
        height_unit: Of heights; None takes that of the heading.
        spacing: m, of one column of heights.
        tip_radius: Of the stylus, m.
        resample: Interpolate uneven positions.
        fill_missing: Interpolate up to 5 % of the heights.

    Raises:
        DataError: Unreadable, units missing, positions uneven, heights missing.
    """
    data = _as_named(read_numbers(path), "xz")
    columns = data.rows.shape[1]
    if columns > 2:
        raise DataError(
            Message("the file has {columns} columns", columns=columns),
            where=data.where,
            allowed="positions and heights, or heights alone",
            remedy="A map is read with read_map",
        )
    units = data.units()
    _refuse_one_for_all(units, columns, length_unit, height_unit, data)
    to_height = _factor(height_unit, units[-1:], data, "height_unit")
    heights, notes = complete(
        data.rows[:, -1] * to_height, fill_missing, data.where, data.first_line
    )
    if columns == 1:
        if spacing is None:
            raise DataError(
                "one column of heights and no spacing", where=data.where, remedy=SPACING
            )
        profile = Profile(heights, spacing, tip_radius=tip_radius, source=data.where)
    else:
        to_length = _factor(length_unit, units[:1], data, "length unit")
        profile = profile_from_positions(
            data.rows[:, 0] * to_length,
            heights,
            resample=resample,
            rounding=0.5 * 10.0 ** -data.decimals[0] * to_length,
            tip_radius=tip_radius,
            source=data.where,
        )
    for note in (*data.notes, *notes):
        profile = profile.replace_heights(profile.heights, note)
    return profile


def read_map(
    path: Path | str,
    *,
    length_unit: str | None = None,
    height_unit: str | None = None,
    spacing: float | None = None,
    fill_missing: bool = False,
) -> HeightMap:
    """Return a map from a text file: x, y, z in three columns, or a matrix of heights.

    A matrix needs ``spacing`` (m), or the size that Gwyddion writes above it; its lines run along
    x. Three columns have to form a full grid, whose cells may be oblong. Units come from the
    heading unless given: the last for z; of two the first for x and y.

    Parameters:
        path: Text file.
        length_unit: Of x and y; None takes that of the heading.
        height_unit: Of z; None takes that of the heading.
        spacing: m, of a matrix.
        fill_missing: Interpolate up to 5 % of the heights.

    Raises:
        DataError: Unreadable, units missing, no full grid, heights missing.
    """
    data = _as_named(read_numbers(path), "xyz")
    units, size = data.units(), _gwyddion_size(data)
    if data.rows.shape[1] == 3 and size is None:
        _refuse_one_for_all(units, 3, length_unit, height_unit, data)
    to_height = _factor(height_unit, units[-1:] if size is None else [size[2]], data, "height_unit")
    spacing_y = None
    if data.rows.shape[1] == 3 and data.rows.shape[0] > 3 and size is None:
        along = _factor(length_unit, units[:1], data, "length unit")
        across = _factor(length_unit, units[1:2], data, "length unit") if len(units) > 2 else along
        heights, (spacing, spacing_y) = _grid(data, (along, across))
    elif data.rows.shape[1] < 2:
        raise DataError(
            "one column only", where=data.where, remedy="A profile is read with read_profile"
        )
    else:
        heights = data.rows.T  # a line of the file runs along x
        axes = None if size is not None else _axes(data)
        if axes is not None:
            heights, notes_of = axes[0], ("the first row and column are positions: left out",)
            data = replace(data, notes=(*data.notes, *notes_of))
            if spacing is None:
                to_length = _factor(length_unit, units[:1], data, "length unit")
                spacing, spacing_y = spacings_of([to_length * step for step in axes[1]])
        if spacing is None and size is not None:
            sides = [side / n for side, n in zip(size[:2], heights.shape, strict=True)]
            spacing, spacing_y = spacings_of(sides)
        if spacing is None:
            raise DataError("a matrix of heights and no spacing", where=data.where, remedy=SPACING)
    heights, notes = complete(heights * to_height, fill_missing, data.where)
    return HeightMap(
        heights,
        spacing,
        spacing_y=spacing_y,
        source=data.where,
        processing=(*data.notes, *notes),
    )


def _gwyddion_size(data: TextNumbers) -> tuple[float, float, str] | None:
    """Return width and height (m) and the unit of heights that Gwyddion writes above a matrix.

    Its words are those of the user's language, so their order tells: a line "name: number unit"
    for the width, one for the height, then "name: unit".
    """
    said = [line.partition(":")[2].strip() for line in data.header]
    for first, second, unit in zip(said, said[1:], said[2:], strict=False):
        sides = [_QUANTITY.fullmatch(side) for side in (first, second)]
        if all(side and side.group(2) for side in sides) and _LENGTH.fullmatch(unit):
            width, height = (_length(side, data.where) for side in (first, second))
            return width, height, unit
    return None


def _as_named(data: TextNumbers, order: str) -> TextNumbers:
    """Return columns that the heading calls x, y and z, each once, in this order."""
    line = data.header[-1] if data.header else ""
    names = _AXIS.findall(line.casefold())
    if "".join(names) == order or sorted(names) != sorted(order):
        return data
    if data.rows.shape[1] != len(order):
        return data
    place = [names.index(name) for name in order]
    parts = _AXIS.split(line.casefold())[2::2]
    header = "; ".join(f"{name} {parts[k]}" for name, k in zip(order, place, strict=True))
    return replace(
        data,
        rows=data.rows[:, place],
        decimals=tuple(data.decimals[k] for k in place),
        header=(*data.header[:-1], header),
    )


def _axes(data: TextNumbers) -> tuple[np.ndarray, tuple[float, float]] | None:
    """Return heights (nx, ny) and steps along x and y of a matrix that begins with its positions.

    Those of y are the first column; those of x the first row, or the last line above. None of a
    matrix of heights alone.
    """
    rows = data.rows
    above = [float(cell) for cell in _NUMBER.findall(data.header[-1])] if data.header else []
    if len(above) == rows.shape[1] - 1:
        x, y, heights = np.array(above), rows[:, 0], rows[:, 1:]
    else:
        x, y, heights = rows[0, 1:], rows[1:, 0], rows[1:, 1:]
    if min(heights.shape) < 4 or not (_is_even(x) and _is_even(y)):
        return None
    if _is_even(heights[0]) or _is_even(heights[:, 0]):
        return None  # a plane
    return heights.T, (abs(float(np.diff(x).mean())), abs(float(np.diff(y).mean())))


def _is_even(values: np.ndarray) -> bool:
    steps = np.diff(values)
    mean = float(steps.mean())
    return mean != 0.0 and bool((np.abs(steps - mean) < 1e-3 * abs(mean)).all())


def _grid(
    data: TextNumbers, to_lengths: tuple[float, float]
) -> tuple[np.ndarray, tuple[float, float | None]]:
    x, y, z = data.rows.T
    if not (np.all(np.isfinite(x)) and np.all(np.isfinite(y))):
        raise DataError("positions are missing", where=data.where)
    places, spacings = [], []
    for name, values, decimals, to_length in zip(
        "xy", (x, y), data.decimals[:2], to_lengths, strict=True
    ):
        rounding = 0.5 * 10.0**-decimals
        levels = np.unique(values)
        jumps = np.diff(levels)
        levels = levels[np.concatenate([[True], jumps > 1e-6 * max(np.ptp(values), 1e-300)])]
        if levels.size < 2:
            raise DataError(Message("all points have the same {name}", name=name), where=data.where)
        step = (levels[-1] - levels[0]) / (levels.size - 1)
        place = np.rint((values - levels[0]) / step).astype(int)
        off = np.abs(values - levels[0] - place * step).max()
        if off > max(0.01 * step, rounding * (1.0 + 1e-6)):
            raise DataError(
                Message(
                    "{name} is uneven: up to {most} off a grid of {spacing}",
                    name=name,
                    most=metres(off * to_length),
                    spacing=metres(step * to_length),
                ),
                where=data.where,
                remedy="Export the measurement on a regular grid",
            )
        places.append(place)
        spacings.append(step * to_length)
    shape = (int(places[0].max()) + 1, int(places[1].max()) + 1)
    filled_in = np.zeros(shape, dtype=int)
    np.add.at(filled_in, (places[0], places[1]), 1)
    if np.any(filled_in > 1):
        raise DataError("a point is given more than once", where=data.where)
    if z.size < 0.5 * filled_in.size:
        raise DataError(
            Message(
                "x, y and z of {size} points are no map: a grid of their places has "
                "{filled_in_size}",
                size=z.size,
                filled_in_size=filled_in.size,
            ),
            where=data.where,
            remedy="For a profile export positions and heights alone",
        )
    heights = np.full(shape, np.nan)
    heights[places[0], places[1]] = z
    return heights, spacings_of(spacings)


def _refuse_one_for_all(
    units: list[str], columns: int, length: str | None, height: str | None, data: TextNumbers
) -> None:
    """Refuse to guess which column a lone unit belongs to."""
    if columns > 1 and len(units) == 1 and (length is None or height is None):
        raise DataError(
            Message('one unit ("{unit}") for {columns} columns', unit=units[0], columns=columns),
            where=data.where,
            allowed="a unit for positions and one for heights, as in: x [mm]; z [um]",
            remedy="Give both units",
        )


def _factor(unit: str | None, heading_units: list[str], data: TextNumbers, name: str) -> float:
    if unit is not None:
        return length_factor(unit, name)
    if not heading_units:
        raise DataError(
            "no unit of length in the heading",
            where=data.where,
            allowed="for example: x [mm]; z [um]",
            remedy=Message("Give the {name}", name=name.replace("_", " ")),
        )
    return length_factor(heading_units[0], data.where)


@dataclass(frozen=True, slots=True)
class InstrumentResult:
    """A number that the instrument printed: over which part (m), in m or without unit."""

    name: str
    start: float
    end: float
    value: float
    unit: str


def is_dektak(path: Path | str) -> bool:
    """Return whether the file looks like a Dektak CSV export."""
    with Path(path).open("rb") as stream:
        return stream.read(64).lstrip(b"\xef\xbb\xbf").startswith(b"Scan Parameters")


def read_dektak(path: Path | str) -> tuple[Profile, tuple[InstrumentResult, ...]]:
    """Return the profile of a Dektak CSV file and the results in its header.

    Spacing and tip radius come from the header; printed positions are rounded and only checked
    against it.

    Raises:
        DataError: No such file, another format, heights missing.
    """
    path = text.existing(path)
    lines = path.read_bytes().decode("latin-1").splitlines()
    start = next((i for i, line in enumerate(lines) if line.startswith("Lateral")), None)
    if not is_dektak(path) or start is None:
        raise DataError("this is not a Dektak CSV file", where=str(path))
    lateral, vertical = (
        length_factor(
            "".join(cell.split()[-1:]), Message("{file}, line {line}", file=path, line=start + 1)
        )
        for cell in f"{lines[start]},".split(",")[:2]
    )
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(lines[start + 1 :], start + 2):
        cells = line.split(",")
        if not line.strip(" ,"):
            continue
        try:
            rows.append((float(cells[0]), float(cells[1])))
        except (ValueError, IndexError):
            raise DataError(
                Message(
                    'no position and height in line {number}: "{line}"',
                    number=number,
                    line=line[:40],
                ),
                where=str(path),
            ) from None
    x, z = np.array(rows).T
    radius = next((line for line in lines[:start] if line.startswith("Stylus")), "")
    match = re.search(r"Radius:\s*(.*)", radius)
    profile = profile_from_positions(
        x * lateral,
        z * vertical,
        rounding=0.05 * lateral,
        tip_radius=_length(match.group(1), str(path)) if match else None,
        source=str(path),
    )
    return profile, _results(lines[:start], str(path))


def _results(header: list[str], where: str) -> tuple[InstrumentResult, ...]:
    start = next((i for i, line in enumerate(header) if line.startswith("Function,")), None)
    if start is None:
        return ()
    results = []
    for line in header[start + 1 :]:
        cells = [cell.strip() for cell in line.split(",")]
        if len(cells) < 6:
            break
        match = _QUANTITY.match(cells[5])
        if match is None:
            continue
        unit = "m" if match.group(2) else "1"
        value = _length(cells[5], where) if match.group(2) else float(match.group(1))
        results.append(
            InstrumentResult(
                cells[0], _length(cells[1], where), _length(cells[3], where), value, unit
            )
        )
    return tuple(results)


def _length(text: str, where: str) -> float:
    match = _QUANTITY.match(text)
    if match is None or not match.group(2):
        raise DataError(Message('"{text}" is not a length', text=text), where=where)
    return float(match.group(1).replace(",", ".")) * length_factor(match.group(2), where)


def read_surface(path: Path | str, **settings: Any) -> Profile | HeightMap:
    """Return a profile or map from any file that can be read.

    What a file is, its content says and not its name: Dektak CSV; arrays of NumPy, fields of tamaas
    (``read_array``); GSF, X3P and SDF (``instruments``); text with one or two columns
    (``read_profile``), three columns or a matrix (``read_map``); every other file goes to
    ``read_instrument``. ``settings`` are passed on.
    """
    path = text.existing(path)
    if is_dektak(path):
        return read_dektak(path)[0]
    if is_array(path):
        return read_array(path, **settings)
    if is_text(path) and not is_instrument(path):
        try:
            columns = read_numbers(path).rows.shape[1]
        except DataError as error:
            if path.suffix.casefold() in _NAMES:
                raise
            try:
                return read_instrument(path)  # a format that is text
            except UnderfootError:
                raise error from None
        return read_profile(path, **settings) if columns <= 2 else read_map(path, **settings)
    if "spacing" in settings:
        raise InputError("spacing given, which the file says itself", where=str(path))
    return read_instrument(path, **settings)
