"""Files of surface instruments, told by what they hold: GSF, X3P, SDF, and those of a library."""

import re
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, text, to_si
from underfoot.core.missing import mask_of_codes
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres

from .heights import HeightMap, Profile, profile_from_positions
from .prepare import fill_missing_heights

GSF = b"Gwyddion Simple Field 1."
_SDF = re.compile(rb"[ab](ISO|BCR|NIST)-\d")
LARGEST = 1.0
"""Side (m) that no scan of a floor or sole has: its unit is not that of the file."""
MOST_UNPACKED = 64e6
"""Bytes that any archive may unpack to; a larger one to 200 times its size."""
UNREADABLE = (zipfile.BadZipFile, NotImplementedError, ValueError)
"""What zipfile raises of an archive that is damaged or packed in a way it does not know."""
_OTHER_THINGS = {
    b"%PDF": "a PDF document",
    b"\x89PNG": "a picture (PNG)",
    b"\xff\xd8\xff": "a picture (JPEG)",
    b"BM": "a picture (BMP)",
    b"GIF8": "a picture (GIF)",
    b"glTF": "a model (GLB)",
    b"solid ": "a model (STL)",
}
_EXPORTS = "X3P, SDF, GSF, or x, y, z as text"
UNIT_OPTIONS = "Name it: --length-unit um (length_unit in a case)"


def length_factor(unit: str, where: str) -> float:
    """Return metres per ``unit``."""
    name = unit.strip().replace("µ", "u").replace("μ", "u")
    if re.fullmatch(r"micro(n|meter|metre)s?", name, re.I):
        name = "um"
    if name.casefold() in ("um", "nm", "mm", "cm", "uin", "inch", "inches", "mil", "mils", "å",
                           "angstrom", "angstroms"):  # fmt: skip
        name = name.casefold().removesuffix("es").removesuffix("s").replace("å", "angstrom")
    try:
        return to_si(f"1 {name}", "m", where=where)
    except InputError as error:
        raise DataError(
            Message('"{unit}" is no unit of length', unit=unit.strip()[:20])
            if len(unit.strip()) > 20
            else error.what,
            where=where,
            allowed="a unit of length: nm, um, mm, m",
            nearest=error.nearest,
            remedy=UNIT_OPTIONS,
        ) from error


def spacings_of(sides: list[float]) -> tuple[float, float | None]:
    """Return spacing along x, and along y where cells are oblong (by more than 0.5 %)."""
    along, across = (float(side) for side in sides)
    if abs(along / across - 1.0) > 0.005:
        return along, across
    return float(np.sqrt(along * across)), None


def complete(
    heights: np.ndarray, fill_missing: bool, where: str, first_line: int | None = None
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the heights without gaps and what was done, if anything."""
    missing = ~np.isfinite(heights) | mask_of_codes(heights)
    if not missing.any():
        return heights, ()
    if not fill_missing:
        count, total = int(missing.sum()), heights.size
        what = Message("{count} of {total} heights are missing", count=count, total=total)
        if heights.ndim == 1 and first_line is not None:
            line = first_line + int(np.flatnonzero(missing)[0])
            what = Message("{missing}, the first in line {line}", missing=what, line=line)
        raise DataError(
            what,
            where=where,
            remedy="Ask for interpolation (fill_missing=True); the result then says so",
        )
    whole, note = fill_missing_heights(np.where(missing, np.nan, heights))
    return whole, (note,)


def is_text(path: Path) -> bool:
    """Return whether a file holds text and nothing else, in any encoding that is read."""
    data = path.read_bytes()
    if text.utf16_of(data):
        return True
    return not re.search(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]", data)


def is_instrument(path: Path) -> bool:
    """Return whether a file names itself as one of an instrument that may also be text."""
    with path.open("rb") as stream:
        head = stream.read(len(GSF))
    return head == GSF or _SDF.match(head) is not None


def read_instrument(
    path: Path | str,
    *,
    length_unit: str | None = None,
    height_unit: str | None = None,
    resample: bool = False,
    fill_missing: bool = False,
) -> Profile | HeightMap:
    """Return the topography of an instrument's file as a profile or a map.

    GSF (Gwyddion Simple Field), X3P of ISO 25178-72 and its amendment of 2020 (surfaces and
    profiles), SDF of ISO 25178-71 (ISO 1.0 and 2.0, BCR 1.0); else the first topography of a
    format that SurfaceTopography reads (SUR, PLUX, OPD, OPDx, AL3D, VK4, DATX, Zygo .dat,
    Nanoscope, Gwyddion and others). Cells may be oblong. ``length_unit`` and ``height_unit`` are
    needed where the file has none.

    Raises:
        MissingExtraError: SurfaceTopography is not installed.
        DataError: Not a format it reads, damaged, no unit, heights missing without
            ``fill_missing``, uneven positions without ``resample``.
        InputError: ``height_unit`` of a file that says it itself.
    """
    path = text.existing(path)
    with path.open("rb") as stream:
        head = stream.read(32)
    if head.startswith(GSF):
        return _gsf(path, length_unit, height_unit, fill_missing)
    if height_unit:
        raise InputError("height_unit given, which the file says itself", where=str(path))
    if _SDF.match(head):
        return _sdf(path, fill_missing)
    if head.startswith(b"PK\x03\x04") and (found := _x3p(path, resample, fill_missing)):
        return found
    known = next((name for magic, name in _OTHER_THINGS.items() if head.startswith(magic)), None)
    if known:
        raise DataError(
            Message("the file is {known}: no heights of a surface", known=known),
            where=str(path),
            remedy=f"Export the scan as {_EXPORTS}",
        )
    return _by_library(path, length_unit, resample, fill_missing)


def _measured_surface(
    heights: np.ndarray, sides: list[float], how: str, fill_missing: bool, path: Path, **known: Any
) -> Profile | HeightMap:
    """Return heights (m), (nx,) or (nx, ny), at distances ``sides`` (m) as a profile or a map."""
    where = str(path)
    if not all(np.isfinite(side) and side > 0.0 for side in sides):
        raise DataError("the file gives no distance between its points", where=where)
    reach = max(n * side for n, side in zip(heights.shape, sides, strict=True))
    if reach > LARGEST:
        raise DataError(
            Message("the scan is {metres} long", metres=metres(reach)),
            where=where,
            allowed=Message("up to {most}", most=metres(LARGEST)),
            remedy=UNIT_OPTIONS,
        )
    heights, notes = complete(heights, fill_missing, where)
    processing = (how, *notes)
    if heights.ndim == 1:
        return Profile(heights, sides[0], source=where, processing=processing)
    spacing, spacing_y = spacings_of(sides)
    return HeightMap(
        heights, spacing, spacing_y=spacing_y, source=where, processing=processing, **known
    )


def _gsf(
    path: Path, length_unit: str | None, height_unit: str | None, fill_missing: bool
) -> Profile | HeightMap:
    """Return a Gwyddion Simple Field: a head of text, then 32-bit floats row by row."""
    where = str(path)
    data = path.read_bytes()
    end = data.index(b"\0") if b"\0" in data else len(data)
    head = data[:end].decode("utf-8", "replace").splitlines()[1:]
    fields = {key.strip(): value.strip() for key, _, value in (one.partition("=") for one in head)}
    try:
        columns, rows = int(fields["XRes"]), int(fields["YRes"])
        size = [float(fields.get(name, "1")) for name in ("XReal", "YReal")]
    except (KeyError, ValueError) as error:
        raise DataError(
            "its head names no XRes and YRes, or a number there is none", where=where,
            remedy="Export it again",
        ) from error  # fmt: skip
    start = end + 4 - end % 4  # one to four zero bytes fill the head up
    if columns < 2 or rows < 1 or len(data) - start != 4 * columns * rows:
        raise DataError(
            Message(
                "cut short or damaged: {count} bytes of heights for {columns} by {rows} "
                "points of 4 bytes",
                count=len(data) - start,
                columns=columns,
                rows=rows,
            ),
            where=where,
            remedy="Copy or export it again",
        )
    factors = []
    for name, option, given in (
        ("XYUnits", "--length-unit", length_unit),
        ("ZUnits", "--height-unit", height_unit),
    ):
        unit = given or fields.get(name)
        if not unit:
            raise DataError(
                Message("its head has no {name}", name=name),
                where=where,
                remedy=Message("Name it: {option} um", option=option),
            )
        factors.append(length_factor(unit, where))
    field = np.frombuffer(data, "<f4", columns * rows, start).reshape(rows, columns)
    heights = field.astype(float).T * factors[1]
    sides = [factors[0] * size[0] / columns, factors[0] * size[1] / rows]
    if rows == 1:
        heights, sides = heights[:, 0], sides[:1]
    return _measured_surface(heights, sides, "read as GSF", fill_missing, path)


def _sdf(path: Path, fill_missing: bool) -> Profile | HeightMap:
    import sdfio

    found = _read_by_library(lambda: sdfio.read(path), "SDF", path)
    sides = [float(found.header.x_scale), float(found.header.y_scale)]
    heights = np.asarray(found.data, dtype=float).T
    if heights.shape[1] == 1:
        heights, sides = heights[:, 0], sides[:1]
    how = Message("read as SDF ({value})", value=found.header.revision.value)
    return _measured_surface(heights, sides, how, fill_missing, path)


def _x3p(path: Path, resample: bool, fill_missing: bool) -> Profile | HeightMap | None:
    """Return the profile or map of an X3P file; None of another archive."""
    import x3pio

    try:
        with zipfile.ZipFile(path) as archive:
            if not any(name.casefold() == "main.xml" for name in archive.namelist()):
                return None
            unpacked = sum(part.file_size for part in archive.infolist())
    except UNREADABLE as error:
        raise DataError("a damaged archive", where=str(path), remedy="Copy it again") from error
    if unpacked > max(MOST_UNPACKED, 200 * path.stat().st_size):
        raise DataError(
            Message(
                "the archive unpacks to {size:.0f} MB, {times:.0f} times its size: no scan",
                size=unpacked / 1000000.0,
                times=unpacked / path.stat().st_size,
            ),
            where=str(path),
            remedy="Export it again",
        )
    how = ["read as X3P"]
    try:
        found: Any = x3pio.read(path)
    except x3pio.X3pChecksumError:
        # The archive's own checksums hold, so it is as it was written: some programs write the
        # sum of another part.
        found = _read_by_library(lambda: x3pio.read(path, verify=False), "X3P", path)
        how.append("its own checksum is not that of its content")
    except Exception as error:
        raise _unread("X3P", path) from error
    if isinstance(found, x3pio.PointCloud):
        raise DataError(
            "an X3P of loose points (PCL), which have no order",
            where=str(path),
            remedy="Export it as a surface (SUR) or a profile (PRF)",
        )
    if len(found.layers) > 1:
        how.append(Message("the first of {count} layers", count=len(found.layers)))
    layer = found.layers[0]
    heights = np.asarray(layer.z, dtype=float)
    if isinstance(found, x3pio.Profile):
        return _x3p_profile(layer, heights, "; ".join(how), resample, fill_missing, path)
    if not layer.is_regular_grid:
        raise DataError(
            "an X3P whose points are on no grid (absolute axes)",
            where=str(path),
            remedy="Export it on a regular grid",
        )
    sides, heights = list(layer.spacing), heights.T
    if heights.shape[1] == 1:
        sides, heights = sides[:1], heights[:, 0]
    return _measured_surface(heights, sides, "; ".join(how), fill_missing, path)


def _x3p_profile(
    layer: Any, heights: np.ndarray, how: str, resample: bool, fill_missing: bool, path: Path
) -> Profile | HeightMap:
    if layer.is_regular_grid:
        spacing = layer.spacing[0] if isinstance(layer.spacing, tuple) else layer.spacing
        return _measured_surface(heights, [float(spacing)], how, fill_missing, path)
    points = np.asarray(layer.points(), dtype=float).reshape(-1, 3)
    whole, notes = complete(points[:, 2], fill_missing, str(path))
    profile = profile_from_positions(points[:, 0], whole, resample=resample, source=str(path))
    return profile.replace_heights(profile.heights, "; ".join((how, *notes)))


def _read_by_library(read: Callable[[], Any], name: str, path: Path) -> Any:
    """Return what a library reads; its errors, which may hold parts of the file, stay its own."""
    try:
        return read()
    except Exception as error:
        raise _unread(name, path) from error


def _unread(name: str, path: Path) -> DataError:
    others = _EXPORTS.replace(f"{name}, ", "")
    return DataError(
        Message(
            "a damaged {name} file, or one with a part that the format does not allow", name=name
        ),
        where=str(path),
        remedy=Message("Copy or export it again, or as {others}", others=others),
    )


def _by_library(
    path: Path, length_unit: str | None, resample: bool, fill_missing: bool
) -> Profile | HeightMap:
    package = optional_module("SurfaceTopography", "instruments", "Reading this format")
    where = str(path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            topography: Any = package.read_topography(where)
            heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan)
            positions = topography.positions() if topography.dim == 1 else None
    except Exception as error:  # its readers raise many kinds, with bytes of the file among them
        raise DataError(
            "this file can't be read as one of an instrument: its format is not known, or it is "
            "damaged",
            where=where,
            remedy=f"Export it as {_EXPORTS}",
        ) from error
    unit = length_unit or topography.unit
    if not unit:
        raise DataError("the file names no unit of length", where=where, remedy=UNIT_OPTIONS)
    factor = length_factor(str(unit), where)
    how = "read through SurfaceTopography"
    if topography.dim == 1:
        heights, notes = complete(heights * factor, fill_missing, where)
        x = np.asarray(positions, dtype=float) * factor
        profile = profile_from_positions(x, heights, resample=resample, source=where)
        return profile.replace_heights(profile.heights, "; ".join((how, *notes)))
    sizes = zip(topography.physical_sizes, heights.shape, strict=True)
    sides = [float(size) * factor / n for size, n in sizes]
    periodic = bool(topography.is_periodic)
    return _measured_surface(heights * factor, sides, how, fill_missing, path, periodic=periodic)
