"""``edits.csv``: the edits by hand of a folder, read, written and logged."""

import csv
import io
from collections.abc import Collection, Sequence
from pathlib import Path

from underfoot.core import InputError, nearest_match, to_si
from underfoot.core.files import whole_file
from underfoot.core.remark import Message
from underfoot.core.text import decode_text

from ..readers.text import name_and_unit
from ..recording.trial import Edit
from ..walking.events import EditError
from .condition_table import table_columns, table_delimiter
from .conditions import named_file
from .file_result import LoggedEdit, StepResult

NAMES = ("edits.csv", "edits.xlsx")
COLUMNS = ("file", "step", "edit", "value", "why")


def edits_of(folder: Path, labels: Sequence[str], *, others: bool = False) -> dict[str, list[Edit]]:
    """Return the edits by file from ``edits.csv`` (or ``.xlsx``) in a folder.

    Columns: file; step (its number, or a time within it as ``3.02 s``); edit (one of ``EDITS``);
    value (``3.060 s``, ``left``, ``plate 2``, empty for exclude); why. ``labels`` are the
    recordings of the folder: an edit for another file is an error, or left aside with ``others``.
    An `EditError` with the line says that a column is missing, a value does not fit, or there is no
    reason.
    """
    found: dict[str, list[Edit]] = {}
    for _, file, edit in edit_rows(folder, labels, others=others):
        found.setdefault(file, []).append(edit)
    return found


def edit_rows(
    folder: Path, labels: Sequence[str], *, others: bool = False
) -> list[tuple[int, str, Edit]]:
    """Return line, file and edit of each row of ``edits.csv``, otherwise as ``edits_of``."""
    path = next((folder / name for name in NAMES if (folder / name).is_file()), None)
    if path is None:
        return []
    columns, lines = table_columns(path, ("file",))
    cells = {name.casefold(): (unit, own) for name, unit, own in columns}
    lacking = [name for name in COLUMNS if name not in cells]
    if lacking:
        raise EditError(
            Message('there is no column "{lacking}"', lacking=lacking[0]),
            where=path.name,
            allowed=", ".join(COLUMNS),
        )
    edits: list[tuple[int, str, Edit]] = []
    rows = zip(*(cells[name][1] for name in COLUMNS), strict=True)
    for line, (name, step, what, value, why) in zip(lines, rows, strict=True):
        where = Message("{file}, line {line}", file=path.name, line=line)
        file = named_file(name, labels)
        if file is None and others:
            continue
        if file is None:
            nearest = nearest_match(name, labels)
            what = Message('there is no file "{name}"', name=name)
            raise EditError(what, where=where, nearest=nearest)
        edit = edit_from(step, what, value, why, where, cells["value"][0])
        edits.append((line, file, edit))
    return edits


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
    try:
        return to_si(text, "s", where=where, usual=unit)
    except InputError as error:
        allowed = 'a time with its unit, as "3.06 s"; a step also by its number'
        what = Message('"{text}" is no time: {what}', text=text, what=error.what)
        raise EditError(what, where=where, allowed=allowed) from error


def edit_text(folder: Path) -> str:
    """Return the text of a folder's ``edits.csv``, empty where there is none.

    EditError: the edits stand in a workbook, which is not written.
    """
    path = folder / NAMES[0]
    if path.is_file():
        return decode_text(path.read_bytes(), path.name) if path.stat().st_size else ""
    if (folder / NAMES[1]).is_file():
        raise EditError(
            "the edits of this folder stand in a workbook, which is not written",
            where=NAMES[1],
            remedy=Message("Save it as {names} and take it away", names=NAMES[0]),
        )
    return ""


def write_edit_text(folder: Path, text: str) -> None:
    """Make ``text`` the folder's ``edits.csv``, whole or not at all; without text there is none."""
    path = folder / NAMES[0]
    if not text:
        path.unlink(missing_ok=True)
        return
    with whole_file(path) as part:
        part.write_text(text, encoding="utf-8", newline="")


def with_edit_row(text: str, row: Sequence[str] = (), without: Collection[int] = ()) -> str:
    """Return the text of ``edits.csv`` with one more row and without the lines ``without``.

    ``row`` has the cells of ``COLUMNS``; the columns and the delimiter of the text are kept. An
    empty text gets the headings.
    """
    delimiter = table_delimiter(text)
    rows = list(csv.reader(io.StringIO(text), delimiter=delimiter))
    heads = [name_and_unit(head)[0].casefold() for head in next(filter(any, rows), COLUMNS)]
    made = io.StringIO(newline="")
    writer = csv.writer(made, delimiter=delimiter, lineterminator="\n")
    if not text.strip():
        writer.writerow(COLUMNS)
    if without:
        writer.writerows(row for line, row in enumerate(rows, start=1) if line not in without)
        text = ""
    if row:
        cells: dict[str, str] = dict(zip(COLUMNS, row, strict=True))
        writer.writerow([cells.get(head, "") for head in heads])
    return text + ("" if not text or text.endswith("\n") else "\n") + made.getvalue()


def edit_log(
    edits: Sequence[Edit], before: Sequence[StepResult], after: Sequence[StepResult]
) -> list[LoggedEdit]:
    """Return one row per edit: the event and the number before and after it.

    ``before`` and ``after`` are the steps of a ``Draft`` without and with the edits.
    """
    rows = []
    for edit in edits:
        if isinstance(edit.step, int):
            old = next(step for step in before if step.number == edit.step)
        else:
            at = float(edit.step)
            old = min(before, key=lambda step: abs(step.contact - at))
        new = next(step for step in after if step.number == old.number)
        events = _event(edit.what, old), _event(edit.what, new)
        # a contact that was excluded is no slip any more and has no speed
        quantity, numbers = "rcof", (old.rcof, new.rcof)
        if old.judged_for_slip:
            quantity = "peak slipping speed"
            numbers = old.peak_slipping_speed, new.peak_slipping_speed
        rows.append(LoggedEdit(old.item, edit.what, *events, edit.why, quantity, *numbers))
    return rows


def _event(what: str, step: StepResult) -> str:
    if what in ("contact", "toe off"):
        return f"{step.contact if what == 'contact' else step.toe_off:.4f} s"
    if what == "side":
        return step.side
    return Message("no step: {reason}", reason=step.reason) if step.reason else "step"
