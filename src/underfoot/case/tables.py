"""Tables (CSV, XLSX) beside a case file: friction readings and motion histories, in SI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, InputError, to_si
from underfoot.core.errors import missing_file
from underfoot.core.files import checksum
from underfoot.core.remark import Message
from underfoot.core.units import refuse_percent

from .section import origin_of

if TYPE_CHECKING:
    from underfoot.trials.readers.sheet import Sheet

Array = NDArray[np.float64]
Columns = Mapping[str, tuple[str, tuple[str, ...]]]
"""Quantity: SI unit, and the headings by which a column is known."""


def existing_file(path: Path, where: str, pattern: str = "*") -> Path:
    """Return ``path``; an error names the nearest file of ``pattern`` in its folder."""
    if path.is_file():
        return path
    remedy = "The path counts from the folder of the case file"
    raise missing_file(path, pattern, where=where, remedy=remedy)


def plain(given: Any) -> Any:
    """Return a given value without its origin."""
    origin = origin_of(given)
    return given if origin is None else origin.leaf.given


def with_checksum(
    table: dict[str, Any], key: str, folder: Path, where: str, *, checksum_key: str = "sha256"
) -> dict[str, Any]:
    """Return the table with the full path under ``key`` and the checksum of that file.

    Raises:
        InputError: No such file, or another one than the checksum in the table means.
    """
    name, meant = plain(table.get(key)), plain(table.get(checksum_key))
    if not isinstance(name, str):
        return table
    path = (folder / name).resolve()
    existing_file(path, f"{where}.{key}")
    try:
        present = checksum(path)
    except OSError as error:
        raise InputError(
            Message("{path} can't be read ({strerror})", path=path, strerror=error.strerror),
            where=f"{where}.{key}",
        ) from error
    if isinstance(meant, str) and meant.lower() != present:
        raise InputError(
            Message(
                "{file} is not the file that the case means: its checksum is {present}..., not "
                "{meant}...",
                file=path.name,
                present=present[:12],
                meant=meant[:12],
            ),
            where=f"{where}.{key}",
            remedy=Message(
                "Bring back that file, or remove {checksum_key} to take this one",
                checksum_key=checksum_key,
            ),
        )
    return {**table, key: str(path), checksum_key: present}


@contextmanager
def meant_file(path: str, sha256: str | None, where: str) -> Iterator[Path]:
    """Give the path of a file while it is read; refuse one that is not what the case was made of.

    Raises:
        InputError: No such file; another content, now or when it has been read.
    """
    _refuse_changed(Path(path), sha256, where)
    yield Path(path)
    _refuse_changed(Path(path), sha256, where)


def _refuse_changed(path: Path, sha256: str | None, where: str) -> None:
    if checksum(existing_file(path, where)) != sha256:
        raise InputError(
            Message("{path} has changed since the case was made", path=path),
            where=where,
            remedy="Load the case again to take the file as it is now",
        )


def table_columns(
    path: Path,
    columns: Columns,
    where: str,
    *,
    needed: tuple[str, ...],
    lowest: float | None = None,
) -> dict[str, Array]:
    """Return the columns of a table in SI; units stand in a heading, as ``speed (mm/s)``.

    Raises:
        InputError: No file, no table, a column of ``needed`` missing, a value missing or below
            ``lowest``; a workbook with several such tables.
    """
    existing_file(path, where, "*.csv")
    headings = [columns[name][1] for name in needed]
    try:
        sheet = _one_sheet(path, headings, where)
    except DataError as error:
        raise InputError(
            Message("{name}: {error}", name=path.name, error=error), where=where
        ) from error
    optional = [name for name in columns if name not in needed]
    read = {}
    for name, (unit, headings) in columns.items():
        values = _column(sheet, unit, headings, f"{where}, {name}")
        if values is not None:
            read[name] = values
        elif name in needed:
            raise InputError(
                Message('{file} has no column "{column}" of numbers', file=sheet.name, column=name),
                where=where,
                allowed=Message(
                    "{needed}; also {optional}. Present: {present}",
                    needed=needed,
                    optional=optional,
                    present=sheet.columns[:8],
                ),
            )
    for name, values in read.items():
        wrong = ~np.isfinite(values)
        if lowest is not None:
            wrong |= values < lowest
        for row in np.flatnonzero(wrong)[:1]:
            state = "missing" if np.isnan(values[row]) else f"{values[row]:g}"
            raise InputError(
                Message(
                    "row {row} of {file}: {name} is {state}",
                    row=row + 1,
                    file=path.name,
                    name=name,
                    state=state,
                ),
                where=where,
                allowed="a number" if lowest is None else f"a number, {lowest:g} or more",
            )
    return read


def _one_sheet(path: Path, headings: Sequence[tuple[str, ...]], where: str) -> Sheet:
    """Return the table of a file; of a workbook the one sheet that has all ``headings``."""
    from underfoot.trials.readers.sheet import is_workbook, read_sheet, workbook_sheets

    usual, data = read_sheet(path), path.read_bytes()
    names = workbook_sheets(data, path.name) if is_workbook(data) else {}
    fitting = []
    for name in names if len(names) > 1 else ():
        with suppress(DataError):  # a sheet without a table
            sheet = read_sheet(path, sheet=name)
            known = {_plain(head) for head in sheet.numbers}
            if all(known.intersection(heading) for heading in headings):
                fitting.append((name, sheet))
    if len(fitting) > 1:
        raise InputError(
            Message(
                "several sheets of {name} hold such a table: {fitting}",
                name=path.name,
                fitting=", ".join((name for name, _ in fitting)),
            ),
            where=where,
            remedy="Keep the one that is meant in a file of its own",
        )
    return fitting[0][1] if fitting else usual


def as_written(read: Mapping[str, Array], columns: Columns) -> list[dict[str, str | float]]:
    """Return the rows of a table as a case file writes them."""
    units = [columns[name][0] for name in read]
    return [
        {
            name: float(value) if unit == "1" else f"{value:.12g} {unit}"
            for name, unit, value in zip(read, units, row, strict=True)
        }
        for row in zip(*read.values(), strict=True)
    ]


def table_source(path: Path) -> str:
    """Return what a line ``# source: ...`` at the head of a table says, else the file's name."""
    try:
        with path.open(encoding="utf-8-sig") as stream:
            head = [line for _, line in zip(range(20), stream, strict=False)]
    except UnicodeDecodeError:  # a spreadsheet
        return path.name
    for line in head:
        name, _, text = line.lstrip("#; ").partition(":")
        if name.strip().casefold() == "source" and text.strip():
            return text.strip()
    return path.name


def _column(sheet: Sheet, unit: str, headings: tuple[str, ...], where: str) -> Array | None:
    plain = {_plain(key): key for key in reversed(list(sheet.numbers))}
    key = next((plain[heading] for heading in headings if heading in plain), None)
    if key is None:
        return None
    written, factor = sheet.units.get(key, ""), 1.0
    if written == "%" or (written and unit != "1"):
        try:
            if unit == "1":
                refuse_percent(written, where=where)
            factor = to_si(f"1 {written}", unit, where=where)
        except InputError as error:
            what = Message(
                '{name}: "{written}" is no unit of {column}',
                name=sheet.name,
                written=written,
                column=where.rpartition(", ")[2],
            )
            raise InputError(what, where=where, allowed=unit) from error
    return np.asarray(sheet.numbers[key], dtype=float) * factor


def _plain(heading: str) -> str:
    return " ".join(heading.casefold().replace("_", " ").split())
