"""What tables of variants and results ask the computing processes: one row a variant."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from underfoot.case import Case
from underfoot.case.parts import unit_at
from underfoot.compute.result import Result
from underfoot.core import Progress, SourcedValue
from underfoot.core.errors import UnderfootError, error_text
from underfoot.core.presentation import value_text
from underfoot.questions.comparison import (
    compared_values,
    differences,
    interval_95,
    with_short_names,
)
from underfoot.report.thumbnail import thumbnail
from underfoot.trials.pages.report import csv_text, write_spreadsheet
from underfoot.trials.study.tables import TrialTable

NUMBERS = ("cof", "slip_probability", "fluid_load", "peak_fluid_pressure", "contact_area")
"""Numbers of a result that a table of variants has."""
UNITS = {"cof": "1", "slip_probability": "1", "fluid_load": "N", "peak_fluid_pressure": "Pa",
         "contact_area": "m^2"}  # fmt: skip
NOTES = (
    "A row is a variant: the inputs in which variants differ, as its case file says now, and its "
    "results with the ends of their 95 % intervals. Units stand in the headings.",
    "A variant without a result of its present inputs has no numbers: its state says so.",
)
Entries = Sequence[Sequence[str]]
"""Of each row: name, case file, folder of the result."""


@dataclass(frozen=True, slots=True)
class _Inputs:
    """What a case holds: ``values`` with how sure they are, as text, and numbers for sorting."""

    hash: str
    texts: dict[str, str]
    values: dict[str, Any]
    numbers: dict[str, float]
    problem: str = ""
    files: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class _Outcome:
    hash: str
    status: str
    usable: bool
    verdict: tuple[str, str]
    scalars: dict[str, SourcedValue]


def rows(entries: Entries, *, progress: Progress) -> dict[str, Any]:
    """Return the inputs that differ (path, unit), and what is known of each variant.

    ``state`` is current, earlier, not_computed, unusable or unreadable; ``remark`` says more of the
    last two. Inputs and numbers stand in SI for sorting, with ``_text`` as people read them.
    """
    known = [(name, *_of_case(case, folder)) for name, case, folder in entries]
    cases = [inputs for _, inputs, _ in known if not inputs.problem]
    paths = [row[0] for row in differences([inputs.values for inputs in cases])]
    texts = [(path, *(inputs.texts.get(path, "-") for inputs in cases)) for path in paths]
    shown = [row[0] for row in with_short_names(texts)]
    table = [_row(name, inputs, outcome, paths) for name, inputs, outcome in known]
    return {"inputs": [(path, _unit(path)) for path in shown], "rows": table}


def written(entries: Entries, title: str, kind: str, *, progress: Progress) -> str:
    """Write the table as "csv" or "xlsx" into a folder of its own; return the file."""
    made = rows(entries, progress=progress)
    columns = ["variant", "state", "verdict"]
    columns += [path if unit == "1" else f"{path} ({unit})" for path, unit in made["inputs"]]
    for name in NUMBERS:
        columns += [f"{name} ({UNITS[name]})"]
        columns += [f"{name}, 95 % {end} ({UNITS[name]})" for end in ("low", "high")]
    lines = []
    for row in made["rows"]:
        line = [row["name"], row["state"], row["verdict"] if row["state"] == "current" else None]
        line += [row.get(path) for path, _ in made["inputs"]]
        for name in NUMBERS:
            ends = row.get(f"{name}_interval") or (None, None)
            known = row["state"] == "current"
            line += [row.get(name), *ends] if known else [None, None, None]
        lines.append(tuple(line))
    table = TrialTable.of("variants", title, columns, lines)
    file = Path(mkdtemp(prefix="underfoot-")) / f"{title}.{kind}"
    if kind == "csv":
        file.write_text(csv_text(table), encoding="utf-8")
    else:
        write_spreadsheet([table], NOTES, file)
    return str(file)


def picture(case: str, *, progress: Progress) -> str:
    """Return the small picture (SVG) of a case's sole; an empty one where there is no sole."""
    try:
        return thumbnail(Case.load(case))
    except UnderfootError:  # what is wrong with it stands beside the picture
        return '<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"/>'


def _row(name: str, inputs: _Inputs, outcome: _Outcome | None, paths: list[str]) -> dict[str, Any]:
    row: dict[str, Any] = {"name": name, "verdict": "", "steps": "", "remark": inputs.problem}
    for path in paths if not inputs.problem else ():
        text = inputs.texts.get(path, "")
        row[f"{path}_text"] = Path(text).name if path.endswith(".file") else text
        row[path] = inputs.numbers.get(path, row[f"{path}_text"])
    if outcome is None:
        row["state"] = "unreadable" if inputs.problem else "not_computed"
        return row
    row["state"] = "current" if outcome.hash == inputs.hash else "earlier"
    if inputs.problem:
        row["state"] = "unreadable"
    elif not outcome.usable:
        row |= {"state": "unusable" if row["state"] == "current" else "earlier"}
        row["remark"] = outcome.status
        return row
    row["verdict"], row["steps"] = outcome.verdict
    for number, scalar in outcome.scalars.items():
        row[number], row[f"{number}_text"] = scalar.value, value_text(number, scalar)
        row[f"{number}_interval"] = interval_95(scalar)
    return row


def _unit(path: str) -> str:
    try:
        return unit_at(path)
    except UnderfootError:  # a key that only another version knows
        return "1"


_kept: dict[str, tuple[list[tuple[int, int]], Any]] = {}


def _of_case(case: str, folder: str) -> tuple[_Inputs, _Outcome | None]:
    return _of_file(Path(case), _inputs), _of_file(Path(folder) / "result.json", _outcome)


def _of_file(path: Path, read: Callable[[Path], Any]) -> Any:
    """Return what is read of a file, anew where it or a file that it names has changed."""
    seen = _kept.get(str(path))
    if seen is None or seen[0] != _stamps(path, seen[1]):
        found = read(path)
        _kept[str(path)] = seen = _stamps(path, found), found
    return seen[1]


def _stamps(path: Path, content: Any) -> list[tuple[int, int]]:
    stamps = []
    for each in (path, *map(Path, getattr(content, "files", ()))):
        try:
            stamps.append((each.stat().st_mtime_ns, each.stat().st_size))
        except OSError:
            stamps.append((0, 0))
    return stamps


def _inputs(path: Path) -> _Inputs:
    try:
        case = Case.load(path)
        texts = {path: text for path, text, _ in case.rows()}
        values = {path: case.value(path) for path in texts}
    except UnderfootError as error:
        return _Inputs("", {}, {}, {}, error_text(error))
    numbers: dict[str, float] = {
        path: value
        for path, value in values.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    }
    files = tuple(str(values[path]) for path in values if path.endswith(".file"))
    return _Inputs(case.hash, texts, compared_values(case), numbers, files=files)


def _outcome(path: Path) -> _Outcome | None:
    if not path.exists():
        return None
    try:
        result = Result.load(path.parent, with_fields=False)
    except UnderfootError:
        return None
    scalars = {name: result.scalars[name] for name in NUMBERS if name in result.scalars}
    status = str(result.status)
    hash_ = result.provenance.case_hash
    return _Outcome(hash_, status, result.usable, result.verdict(), scalars)
