"""Tables (CSV, XLSX) that lie beside a case file: opened, and columns taken out in SI."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError

from .beside import existing_file

if TYPE_CHECKING:
    from underfoot.trials.readers.sheet import Sheet

Array = NDArray[np.float64]


def opened_sheet(path: Path, where: str) -> Sheet:
    """Return the table in a file; ``where`` is the key of the case that names it."""
    from underfoot.core import DataError
    from underfoot.trials.readers.sheet import read_sheet

    existing_file(path, where, "*.csv")
    try:
        return read_sheet(path)
    except DataError as error:
        raise InputError(f"{path.name}: {error}", where=where) from error


def sheet_column(
    sheet: Sheet,
    name: str,
    unit: str,
    headings: tuple[str, ...],
    *,
    where: str,
    allowed: str,
    required: bool,
) -> Array | None:
    """Return a column in ``unit``, found by one of its headings; None when it may be missing.

    Units stand in the heading, as ``speed (mm/s)``; without one a column is in ``unit``.
    """
    from underfoot.trials.readers.unit_factors import si_unit

    plain = {_plain(key): key for key in reversed(list(sheet.numbers))}
    key = next((plain[one] for one in headings if one in plain), None)
    if key is None:
        if not required:
            return None
        raise InputError(
            f'{sheet.name} has no column "{name}" of numbers',
            where=where,
            allowed=f"{allowed}. Found: " + ", ".join(sheet.columns[:8]),
        )
    written = sheet.units.get(key, "")
    known = si_unit(written) if written else None
    factor = 1.0
    if known is not None and unit != "1":
        if known[0] not in (unit, unit.replace("*", " "), unit.replace("*", "·")):
            raise InputError(
                f'{sheet.name}: "{written}" is no unit of {name}', where=where, allowed=unit
            )
        factor = known[1]
    elif written and unit != "1":
        from underfoot.core import to_si

        factor = to_si(f"1 {written}", unit, where=f"{where}, {name}")
    return np.asarray(sheet.numbers[key], dtype=float) * factor


def _plain(heading: str) -> str:
    return " ".join(heading.casefold().replace("_", " ").split())
