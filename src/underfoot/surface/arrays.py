"""Heights that programs hand on as arrays: files of NumPy, fields that tamaas dumped."""

import json
import zipfile
import zlib
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, text
from underfoot.core.remark import Message

from .heights import HeightMap, Profile
from .instruments import UNIT_OPTIONS, UNREADABLE, complete, length_factor, spacings_of

_NUMPY, _HDF5 = b"\x93NUMPY", b"\x89HDF\r\n\x1a\n"
_HEIGHTS = ("surface", "heights", "topography")
SPACING = 'Give it: --spacing "4 um", spacing in a case or (in metres) in Python'


def read_array(
    path: Path | str,
    *,
    spacing: float | None = None,
    height_unit: str | None = None,
    length_unit: str | None = None,
    fill_missing: bool = False,
) -> Profile | HeightMap:
    """Return heights that NumPy saved (``.npy``, ``.npz``) or tamaas dumped with other fields.

    (n,) is a profile, (nx, ny) a map with x along axis 0. Among several fields the one called
    ``surface``, ``heights`` or ``topography`` is taken.

    Parameters:
        path: File of NumPy, of tamaas' ``NumpyDumper`` or of its ``H5Dumper``.
        spacing: m; needed where the file says no size.
        height_unit: Of the heights; no such file says it.
        length_unit: Of the size that a dump says; says nothing beside ``spacing``.
        fill_missing: Interpolate up to 5 % of the heights.

    Raises:
        DataError: Damaged; several fields of which none is called so; not numbers of one or two
            axes; spacing, unit or heights missing.
    """
    path = text.existing(path)
    where = str(path)
    fields, size = _fields(path)
    flat = {name: field for name, field in fields.items() if field.ndim in (1, 2)} or fields
    named = [name for name in flat if name.casefold() in _HEIGHTS] or list(flat)
    if len(named) != 1:
        raise DataError(
            Message("fields of a model: {flat}", flat=", ".join(flat) or "none of numbers"),
            where=where,
            allowed=Message("one called {heights}, or one alone", heights=", ".join(_HEIGHTS)),
            remedy='Dump the heights as well: model["surface"] = surface',
        )
    (name,) = named
    heights, spacing_y = flat[name], None
    if heights.ndim not in (1, 2) or heights.dtype.kind not in "fiu":
        raise DataError(
            Message(
                "an array of shape {shape} and kind {dtype}",
                shape=str(heights.shape),
                dtype=heights.dtype,
            ),
            where=where,
            allowed="real heights, (n,) or (nx, ny)",
        )
    if spacing is None and size is not None and len(size) == heights.ndim:
        if length_unit is None:
            raise DataError("a size without a unit of length", where=where, remedy=UNIT_OPTIONS)
        factor = length_factor(length_unit, where)
        sides = [factor * side / n for side, n in zip(size, heights.shape, strict=True)]
        spacing, spacing_y = spacings_of(sides) if len(sides) == 2 else (sides[0], None)
    if spacing is None:
        raise DataError("an array of heights and no spacing", where=where, remedy=SPACING)
    if height_unit is None:
        raise DataError(
            "an array of heights without a unit", where=where, remedy="Give it: --height-unit m"
        )
    found, notes = complete(
        heights.astype(float) * length_factor(height_unit, where), fill_missing, where
    )
    processing = (
        Message('read as the field "{name}"', name=name) if name else "read as an array of NumPy",
        *notes,
    )
    if found.ndim == 1:
        return Profile(found, spacing, source=where, processing=processing)
    return HeightMap(found, spacing, spacing_y=spacing_y, source=where, processing=processing)


def is_array(path: Path) -> bool:
    """Return whether a file is an array of NumPy, an archive of them alone, or a dump of tamaas.

    A damaged archive is what its name says; damaged HDF5 counts as a dump: ``read_array`` tells.
    """
    with path.open("rb") as stream:
        begin = stream.read(len(_HDF5))
    if begin.startswith(_NUMPY):
        return True
    if begin == _HDF5:
        import h5py

        try:
            with h5py.File(path, "r") as file:
                return str(file.attrs.get("program", "")).startswith("Tamaas")
        except OSError:
            return True
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except UNREADABLE:
        return path.suffix.casefold() == ".npz"
    return bool(names) and all(name.endswith(".npy") for name in names)


def _fields(path: Path) -> tuple[dict[str, np.ndarray], list[float] | None]:
    """Return the arrays of a file by name, "" for one alone, and the size of its model if said."""
    data = path.read_bytes()
    attributes: dict[str, Any] = {}
    try:
        if data.startswith(_HDF5):
            import h5py

            with h5py.File(BytesIO(data), "r") as file:
                attributes = dict(file.attrs)
                fields = {name: np.asarray(dataset) for name, dataset in file.items()
                          if isinstance(dataset, h5py.Dataset)}  # fmt: skip
        elif data.startswith(_NUMPY):
            fields = {"": np.load(BytesIO(data), allow_pickle=False)}
        else:
            with np.load(BytesIO(data), allow_pickle=False) as file:
                fields = {name: file[name] for name in file.files if file[name].dtype.kind in "fiu"}
                if "attrs" in file.files:
                    attributes = json.loads(str(file["attrs"]))
        size = attributes.get("system_size")
        return fields, None if size is None else [float(side) for side in size]
    except (ValueError, EOFError, OSError, KeyError, zlib.error, *UNREADABLE) as error:
        raise DataError(
            "damaged, or no array of numbers", where=str(path), remedy="Save it again"
        ) from error
