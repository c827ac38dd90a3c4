"""``edits.csv``: the edits by hand of a folder, read, written and logged."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from underfoot.core import InputError, nearest_match, to_si

from ..events import EditError
from ..readers.text import is_number
from ..trial import Edit
from .conditions import named_file, table_columns

NAMES = ("edits.csv", "edits.xlsx")
COLUMNS = ("file", "step", "edit", "value", "why")
EDIT_COLUMNS = (
    "step", "what", "before", "after", "quantity", "number before", "number after", "why"
)  # fmt: skip


def edits_of(folder: Path, labels: Sequence[str], *, others: bool = False) -> dict[str, list[Edit]]:
    """Return the edits by file from ``edits.csv`` (or ``.xlsx``) in a folder.

    Columns: file; step (its number, or a time within it as ``3.02 s``); edit (one of ``EDITS``);
    value (``3.060 s``, ``left``, ``plate 2``, empty for exclude); why. ``labels`` are the
    recordings of the folder: an edit for another file is an error, or left aside with ``others``.
    An `EditError` with the line says that a column is missing, a value does not fit, or there is no
    reason.
    """
    path = next((folder / name for name in NAMES if (folder / name).is_file()), None)
    if path is None:
        return {}
    columns, lines = table_columns(path)
    cells = {name.casefold(): (unit, own) for name, unit, own in columns}
    lacking = [name for name in COLUMNS if name not in cells]
    if lacking:
        raise EditError(
            f'there is no column "{lacking[0]}"', where=path.name, allowed=", ".join(COLUMNS)
        )
    found: dict[str, list[Edit]] = {}
    rows = zip(*(cells[name][1] for name in COLUMNS), strict=True)
    for line, (name, step, what, value, why) in zip(lines, rows, strict=True):
        where = f"{path.name}, line {line}"
        file = named_file(name, labels)
        if file is None and others:
            continue
        if file is None:
            nearest = nearest_match(name, labels)
            raise EditError(f'there is no file "{name}"', where=where, nearest=nearest)
        edit = edit_from(step, what, value, why, where, cells["value"][0])
        found.setdefault(file, []).append(edit)
    return found


def edit_from(step: str, what: str, value: str, why: str, where: str, unit: str = "") -> Edit:
    """Return an edit from text; ``unit`` is that of a heading ``value (s)``.

    What can't be understood is an `EditError`.
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
        text, allowed, nearest = error.what, error.allowed, error.nearest
        raise EditError(text, where=where, allowed=allowed, nearest=nearest) from error


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
    edits: Sequence[Edit], before: Sequence[dict[str, Any]], after: Sequence[dict[str, Any]]
) -> list[dict[str, Any]]:
    """Return one row per edit: the event and the number before and after it.

    ``before`` and ``after`` are the steps of a ``Draft`` without and with the edits.
    """
    rows = []
    for edit in edits:
        if isinstance(edit.step, int):
            old = next(step for step in before if step["number"] == edit.step)
        else:
            at = float(edit.step)
            old = min(before, key=lambda step: abs(step["contact"] - at))
        new = next(step for step in after if step["number"] == old["number"])
        quantity = "peak slipping speed" if "peak_slipping_speed" in old else "rcof"
        key = quantity.replace(" ", "_")
        events = _event(edit.what, old), _event(edit.what, new)
        row = (old["item"], edit.what, *events, quantity, old[key], new[key], edit.why)
        rows.append(dict(zip(EDIT_COLUMNS, row, strict=True)))
    return rows


def _event(what: str, step: dict[str, Any]) -> str:
    if what in ("contact", "toe off"):
        return f"{step[what.replace(' ', '_')]:.4f} s"
    if what == "side":
        return str(step["side"])
    return "no step: " + step["reason"] if step["reason"] else "step"
