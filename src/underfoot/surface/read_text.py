"""Profiles and maps from text files."""

from pathlib import Path

import numpy as np

from underfoot.core import DataError
from underfoot.core.units import metres

from ._text import TextNumbers, length_factor, read_numbers
from .height_map import HeightMap
from .prepare import filled
from .profile import Profile, profile_from_positions


def read_profile(
    path: Path | str,
    *,
    position_unit: str | None = None,
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

    Raises:
        DataError: Unreadable, units missing, positions uneven, heights missing.
    """
    data = read_numbers(path)
    columns = data.rows.shape[1]
    if columns > 2:
        raise DataError(
            f"the file has {columns} columns",
            where=data.where,
            allowed="positions and heights, or heights alone",
            remedy="A map is read with read_map",
        )
    units = data.units()
    _refuse_one_for_all(units, columns, position_unit, height_unit, data)
    to_height = _factor(height_unit, units[-1:], data, 0)
    heights, notes = _complete(data.rows[:, -1] * to_height, fill_missing, data)
    if columns == 1:
        if spacing is None:
            raise DataError(
                "one column of heights and no spacing",
                where=data.where,
                remedy="Give the spacing in metres",
            )
        profile = Profile(heights, spacing, tip_radius=tip_radius, source=data.where)
    else:
        to_length = _factor(position_unit, units[:1], data, 1)
        rounding = 0.5 * 10.0 ** -data.decimals[0] * to_length
        profile = profile_from_positions(
            data.rows[:, 0] * to_length,
            heights,
            resample=resample,
            rounding=rounding,
            tip_radius=tip_radius,
            source=data.where,
        )
    for note in (*data.notes, *notes):
        profile = profile.changed(profile.heights, note)
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

    A matrix needs ``spacing`` (m); its rows run along x. Three columns have to form a full grid
    with square cells. Units come from the heading unless given: the first for x and y, the last
    for z.

    Raises:
        DataError: Unreadable, units missing, no full grid, cells not square, heights missing.
    """
    data = read_numbers(path)
    units = data.units()
    if data.rows.shape[1] == 3:
        _refuse_one_for_all(units, 3, length_unit, height_unit, data)
    to_height = _factor(height_unit, units[-1:], data, 0)
    if data.rows.shape[1] == 3 and data.rows.shape[0] > 3:
        to_length = _factor(length_unit, units[:1], data, 1)
        heights, spacing = _grid(data, to_length)
    elif data.rows.shape[1] < 2:
        raise DataError(
            "one column only", where=data.where, remedy="A profile is read with read_profile"
        )
    elif spacing is None:
        raise DataError(
            "a matrix of heights and no spacing",
            where=data.where,
            remedy="Give the spacing in metres",
        )
    else:
        heights = data.rows
    heights, notes = _complete(heights * to_height, fill_missing, data)
    return HeightMap(heights, spacing, source=data.where, processing=(*data.notes, *notes))


def _grid(data: TextNumbers, to_length: float) -> tuple[np.ndarray, float]:
    x, y, z = data.rows.T
    if not (np.all(np.isfinite(x)) and np.all(np.isfinite(y))):
        raise DataError("positions are missing", where=data.where)
    places, spacings = [], []
    for name, values, decimals in (("x", x, data.decimals[0]), ("y", y, data.decimals[1])):
        rounding = 0.5 * 10.0**-decimals
        levels = np.unique(values)
        jumps = np.diff(levels)
        levels = levels[np.concatenate([[True], jumps > 1e-6 * max(np.ptp(values), 1e-300)])]
        if levels.size < 2:
            raise DataError(f"all points have the same {name}", where=data.where)
        step = (levels[-1] - levels[0]) / (levels.size - 1)
        place = np.rint((values - levels[0]) / step).astype(int)
        off = np.abs(values - levels[0] - place * step).max()
        if off > max(0.01 * step, rounding * (1.0 + 1e-6)):
            raise DataError(
                f"{name} is uneven: up to {metres(off * to_length)} off a grid of "
                f"{metres(step * to_length)}",
                where=data.where,
                remedy="Export the measurement on a regular grid",
            )
        places.append(place)
        spacings.append(step * to_length)
    if abs(spacings[0] / spacings[1] - 1.0) > 0.005:
        raise DataError(
            f"cells of {metres(spacings[0])} by {metres(spacings[1])}",
            where=data.where,
            allowed="square cells",
            remedy="Export with the same spacing along x and y",
        )
    shape = (int(places[0].max()) + 1, int(places[1].max()) + 1)
    filled_in = np.zeros(shape, dtype=int)
    np.add.at(filled_in, (places[0], places[1]), 1)
    if np.any(filled_in > 1):
        raise DataError("a point is given more than once", where=data.where)
    heights = np.full(shape, np.nan)
    heights[places[0], places[1]] = z
    return heights, float(np.sqrt(spacings[0] * spacings[1]))


def _complete(
    heights: np.ndarray, fill_missing: bool, data: TextNumbers
) -> tuple[np.ndarray, tuple[str, ...]]:
    missing = ~np.isfinite(heights)
    if not missing.any():
        return heights, ()
    if not fill_missing:
        line = ""
        if heights.ndim == 1:
            line = f", the first in line {data.first_line + int(np.flatnonzero(missing)[0])}"
        raise DataError(
            f"{int(missing.sum())} of {heights.size} heights are missing{line}",
            where=data.where,
            remedy="Ask for interpolation (fill_missing=True); the result then says so",
        )
    complete, note = filled(heights)
    return complete, (note,)


def _refuse_one_for_all(
    units: list[str], columns: int, length: str | None, height: str | None, data: TextNumbers
) -> None:
    """Refuse to guess which column a lone unit belongs to."""
    if columns > 1 and len(units) == 1 and (length is None or height is None):
        raise DataError(
            f'one unit ("{units[0]}") for {columns} columns',
            where=data.where,
            allowed="a unit for positions and one for heights, as in: x [mm]; z [um]",
            remedy="Give both units",
        )


def _factor(unit: str | None, heading_units: list[str], data: TextNumbers, which: int) -> float:
    name = ("height_unit", "length unit")[which]
    if unit is not None:
        return length_factor(unit, name)
    if not heading_units:
        raise DataError(
            "no unit of length in the heading",
            where=data.where,
            allowed="for example: x [mm]; z [um]",
            remedy=f"Give the {name.replace('_', ' ')}",
        )
    return length_factor(heading_units[0], data.where)
