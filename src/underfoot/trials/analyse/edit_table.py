"""``edits.csv``: the edits by hand of a folder, read, written and logged."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from underfoot.core import InputError, nearest_match, to_si

from ..edits import EditError
from ..readers.text import is_number, name_and_unit
from ..trial import EDITS, Edit
from .conditions import named_file, table_rows

NAMES = ("edits.csv", "edits.xlsx")
COLUMNS = ("file", "step", "edit", "value", "why")


def edits_of(folder: Path, labels: Sequence[str], *, others: bool = False) -> dict[str, list[Edit]]:
    """Return the edits by file from ``edits.csv`` (or ``.xlsx``) in a folder.

    Columns: file; step (its number, or a time within it as ``3.02 s``); edit (one of ``EDITS``);
    value (``3.060 s``, ``left``, ``plate 2``, empty for exclude); why.

    Parameters
    ----------
    labels
        The recordings of the folder; an edit for another file is an error.
    others
        Leave edits for other files aside instead.

    Raises
    ------
    EditError
        A column missing, a value that does not fit, no reason, or a file that is not there; with
        the line.
    """
    path = next((folder / name for name in NAMES if (folder / name).is_file()), None)
    if path is None:
        return {}
    rows = table_rows(path)
    heads = [name_and_unit(cell) for cell in rows[0]] if rows else []
    names = [name.casefold() for name, _ in heads]
    lacking = [name for name in COLUMNS if name not in names]
    if lacking:
        raise EditError(
            f'there is no column "{lacking[0]}"', where=path.name, allowed=", ".join(COLUMNS)
        )
    at = {name: names.index(name) for name in COLUMNS}
    unit = heads[at["value"]][1]
    found: dict[str, list[Edit]] = {}
    for number, row in enumerate(rows[1:], start=2):
        if not any(row):
            continue
        cells = {name: row[i] if i < len(row) else "" for name, i in at.items()}
        where = f"{path.name}, line {number}"
        file = named_file(cells["file"], labels)
        if file is None and others:
            continue
        if file is None:
            raise EditError(
                f'there is no file "{cells["file"]}"',
                where=where,
                nearest=nearest_match(cells["file"], labels),
            )
        edit = edit_from(cells["step"], cells["edit"], cells["value"], cells["why"], where, unit)
        found.setdefault(file, []).append(edit)
    return found


def edit_from(step: str, what: str, value: str, why: str, where: str, unit: str = "") -> Edit:
    """Return an edit from text; ``unit`` is that of a heading ``value (s)``.

    Raises
    ------
    EditError
        What can't be understood.
    """
    what = what.strip().casefold()
    try:
        named: int | float = int(step) if step.strip().isdigit() else _time(step, "", where)
        new: float | str | None = value.strip() or None
        if what in ("contact", "toe off"):
            new = _time(value, unit, where)
        elif what == "side" and new:
            new = str(new).casefold()
        return Edit(named, what, new, why, where)
    except EditError:
        raise
    except InputError as error:
        raise EditError(
            error.what, where=where, allowed=error.allowed, nearest=error.nearest
        ) from error


def _time(text: str, unit: str, where: str) -> float:
    plain = text.strip().replace(",", ".")
    if unit and is_number(plain):
        plain = f"{plain} {unit}"
    try:
        return to_si(plain, "s", where=where)
    except InputError as error:
        allowed = 'a time with its unit, as "3.06 s"; a step also by its number'
        raise EditError(f'"{text}" is no time', where=where, allowed=allowed) from error


def with_edit_row(text: str, row: Sequence[str]) -> str:
    """Return the text of ``edits.csv`` with one more row; the headings when it is empty."""
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    if not text.strip():
        writer.writerow(COLUMNS)
    writer.writerow(row)
    joint = "" if not text or text.endswith("\n") else "\n"
    return text + joint + stream.getvalue()


def edit_log(
    edits: Sequence[Edit],
    before: Sequence[dict[str, Any]],
    after: Sequence[dict[str, Any]],
) -> list[dict[str, Any]]:
    """Return one row per edit: the event and the number before and after it.

    ``before`` and ``after`` are the steps of a ``Draft`` without and with the edits.
    """
    rows = []
    for edit in edits:
        old = _step_named(edit, before)
        new = next(step for step in after if step["number"] == old["number"])
        quantity = "peak slipping speed" if "peak_slipping_speed" in old else "rcof"
        key = quantity.replace(" ", "_")
        rows.append(
            {
                "step": old["item"],
                "what": edit.what,
                "before": _event(edit.what, old),
                "after": _event(edit.what, new),
                "quantity": quantity,
                "number before": old[key],
                "number after": new[key],
                "why": edit.why,
            }
        )
    return rows


def _step_named(edit: Edit, steps: Sequence[dict[str, Any]]) -> dict[str, Any]:
    if isinstance(edit.step, int):
        return next(step for step in steps if step["number"] == edit.step)
    return min(steps, key=lambda step: abs(step["contact"] - float(edit.step)))


def _event(what: str, step: dict[str, Any]) -> str:
    if what in ("contact", "toe off"):
        return f"{step[what.replace(' ', '_')]:.4f} s"
    if what == "side":
        return str(step["side"])
    return "no step: " + step["reason"] if step["reason"] else "step"


__all__ = ["COLUMNS", "EDITS", "edit_from", "edit_log", "edits_of", "with_edit_row"]
