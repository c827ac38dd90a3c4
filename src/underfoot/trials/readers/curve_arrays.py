"""Curves of persons as arrays, as users of spm1d hold them: a row a curve, a column a node."""

import re
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from underfoot.core import DataError, text
from underfoot.core.numbers_text import column_numbers, number_forms

from .matlab import matlab_arrays

_DECIMAL_COMMA = re.compile(r"[+-]?\d+(,\d+)?([eE][+-]?\d+)?")
_ROUGHER = 10.0
"""Nodes of one curve lie closer than curves of several persons do: by so much the axes are told."""


def read_curves(path: Path | str) -> dict[str, np.ndarray]:
    """Return the arrays of curves in a file by their names: (curves, nodes), or (curves, nodes,
    components) of vectors.

    NumPy (.npy, .npz), MATLAB (.mat), or text without a heading: comma, semicolon, tab or blanks,
    decimal commas. Arrays of one axis (conditions, persons) are left out.

    DataError: no such file or array; a damaged file; rows of different length; nodes along the
    rows.
    """
    path = text.existing(path)
    where, ending = str(path), path.suffix.casefold()
    if ending in (".npy", ".npz"):
        try:
            content = np.load(BytesIO(path.read_bytes()), allow_pickle=False)
            arrays = dict(content) if ending == ".npz" else {path.stem: content}
        except (ValueError, EOFError, OSError, BadZipFile) as error:
            raise DataError(
                "damaged, or no arrays of numbers", where=where, remedy="Save them with np.save"
            ) from error
    elif ending == ".mat":
        arrays = dict(matlab_arrays(path.read_bytes(), where))
    else:
        arrays = {path.stem: _text_rows(path)}
    curves = {name: np.asarray(values, dtype=float) for name, values in arrays.items()
              if values.ndim in (2, 3) and values.dtype.kind in "fiu"}  # fmt: skip
    if not curves:
        raise DataError(
            "no array of curves",
            where=where,
            allowed="numbers of two axes: a row a curve, a column a node",
        )
    _refuse_turned(curves, where)
    return curves


def _text_rows(path: Path) -> np.ndarray:
    where = str(path)
    lines = text.with_content(text.numbered_lines(path, "Save the curves as text"))
    joined = "\n".join(line for _, line in lines)
    separator = next((sign for sign in ";\t" if sign in joined), None)
    if separator is None and "," in joined:
        blanks = all(_DECIMAL_COMMA.fullmatch(word) for word in joined.split())
        separator = None if blanks and any(" " in line.strip() for _, line in lines) else ","
    rows = [text.cells_of(line, separator) for _, line in lines]
    for (number, _), row in zip(lines, rows, strict=True):
        if len(row) != len(rows[0]):
            raise DataError(
                f"line {number} has {len(row)} values, the first {len(rows[0])}", where=where
            )
    columns = list(zip(*rows, strict=True))
    try:
        numbers = [column_numbers(cells, form) for cells, form in
                   zip(columns, number_forms(columns, where), strict=True)]  # fmt: skip
    except ValueError as error:
        raise DataError(
            "a cell is no number", where=where, remedy="Leave headings out: curves are numbers"
        ) from error
    return np.array(numbers).T


def _refuse_turned(curves: Mapping[str, np.ndarray], where: str) -> None:
    """Refuse arrays whose rows follow one another as the nodes of a curve do."""
    for name, values in curves.items():
        steps = [float(np.nanmean(np.diff(values, axis=axis) ** 2)) for axis in (0, 1)
                 if values.shape[axis] > 1]  # fmt: skip
        if len(steps) == 2 and steps[1] > _ROUGHER * steps[0]:
            raise DataError(
                f'the rows of "{name}" follow one another like nodes of a curve',
                where=where,
                allowed="a row a curve, a column a node",
                remedy="Transpose it",
            )
