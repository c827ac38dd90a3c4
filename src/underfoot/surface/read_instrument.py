"""Instrument formats, read through the package SurfaceTopography."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError
from underfoot.core.optional import optional_module
from underfoot.core.units import metres

from ._text import length_factor, read_numbers
from .height_map import HeightMap
from .prepare import filled
from .profile import Profile, profile_from_positions
from .read_dektak import is_dektak, read_dektak
from .read_text import read_map, read_profile

TEXT = {".csv", ".txt", ".xyz", ".asc", ".dat", ".prf", ".tsv"}


def read_instrument(
    path: Path | str,
    *,
    length_unit: str | None = None,
    resample: bool = False,
    fill_missing: bool = False,
) -> Profile | HeightMap:
    """Return the first topography of an instrument's file as a profile or a map.

    Formats: those of SurfaceTopography (SDF, X3P, SUR, PLUX, OPD, OPDx, AL3D, VK4, DATX, Nanoscope,
    Gwyddion and others). ``length_unit`` is needed where the file has none.

    Raises:
        MissingExtraError: SurfaceTopography is not installed.
        DataError: Not a format it reads, no unit, heights missing without ``fill_missing``, cells
            not square, uneven positions without ``resample``.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError("there is no such file", where=str(path))
    package = optional_module("SurfaceTopography", "instruments", "Reading this format")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            topography: Any = package.read_topography(str(path))
            heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan)
            positions = topography.positions() if topography.dim == 1 else None
    except Exception as error:  # its readers raise many kinds
        raise DataError(
            f"this file can't be read as an instrument's format ({error})",
            where=str(path),
            remedy="Export it as x, y, z text, SDF or X3P",
        ) from error
    unit = length_unit or topography.unit
    if not unit:
        raise DataError(
            "the file names no unit of length", where=str(path), remedy="Give the length unit"
        )
    factor = length_factor(str(unit), str(path))
    notes: tuple[str, ...] = ("read through SurfaceTopography",)
    heights = heights * factor
    if not np.all(np.isfinite(heights)):
        if not fill_missing:
            raise DataError(
                f"{int((~np.isfinite(heights)).sum())} of {heights.size} heights are missing",
                where=str(path),
                remedy="Ask for interpolation (fill_missing=True); the result then says so",
            )
        heights, note = filled(heights)
        notes = (*notes, note)
    if topography.dim == 1:
        profile = profile_from_positions(
            np.asarray(positions, dtype=float) * factor,
            heights,
            resample=resample,
            source=str(path),
        )
        return (
            profile.changed(profile.heights, notes[0])
            if len(notes) == 1
            else profile.changed(profile.heights, "; ".join(notes))
        )
    spacings = [
        s * factor / n for s, n in zip(topography.physical_sizes, heights.shape, strict=True)
    ]
    if abs(spacings[0] / spacings[1] - 1.0) > 0.005:
        raise DataError(
            f"cells of {metres(spacings[0])} by {metres(spacings[1])}",
            where=str(path),
            allowed="square cells",
            remedy="Export with the same spacing along x and y",
        )
    return HeightMap(
        heights,
        float(np.sqrt(spacings[0] * spacings[1])),
        periodic=bool(topography.is_periodic),
        source=str(path),
        processing=notes,
    )


def read_surface(path: Path | str, **settings: Any) -> Profile | HeightMap:
    """Return a profile or map from any file that can be read.

    Dektak CSV, text with one or two columns (``read_profile``), three columns or a matrix
    (``read_map``); every other file goes to ``read_instrument``. ``settings`` are passed on.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError("there is no such file", where=str(path))
    if is_dektak(path):
        return read_dektak(path)[0]
    if path.suffix.casefold() in TEXT:
        columns = read_numbers(path).rows.shape[1]
        return read_profile(path, **settings) if columns <= 2 else read_map(path, **settings)
    return read_instrument(path, **settings)
