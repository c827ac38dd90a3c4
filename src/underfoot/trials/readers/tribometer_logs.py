"""Logs of tribometers with several steps a file: CETR UMT and PCS Instruments (MTM, EHD)."""

import numpy as np

from ..trial import Trial
from .draft import Draft
from .text import is_number, name_and_unit, split, truncated

_TEXT_COLUMNS = ("image file name", "comments")
# Speeds are written without a unit; the rolling speed beside them is in mm/s.
_SPEEDS = ("Ball Speed", "Disc Speed")


def read_cetr(draft: Draft) -> tuple[Trial, ...]:
    """Return one trial for each step of a CETR log.

    Forces come in grams-force and become N; the sign of Fz (negative under load) is kept.
    """
    lines = draft.lines()
    if "CETR" not in "\n".join(lines[:4])[:200]:
        raise draft.error("not a CETR log")
    starts = [i for i, line in enumerate(lines) if line.strip().startswith("Step No")]
    general = _cetr_settings(lines[: starts[0]] if starts else [])
    _all_steps(draft, starts, general.get("Total number of steps", ""))
    stops = [*starts[1:], len(lines)]
    pairs = enumerate(zip(starts, stops, strict=True), start=1)
    return tuple(
        _cetr_step(lines, *span, Draft(b"", f"{draft.name}, step {n}")) for n, span in pairs
    )


def _all_steps(draft: Draft, starts: list[int], announced: str) -> None:
    if not starts:
        raise draft.error("truncated: there is no step")
    if announced.isdigit() and int(announced) > len(starts):
        words = f"truncated: {announced} steps announced, {len(starts)} found"
        raise truncated(words, draft.name)


def _cetr_step(lines: list[str], start: int, stop: int, step: Draft) -> Trial:
    tables = (
        i
        for i in range(start + 1, stop)
        if len(cells := split(lines[i], ",")) > 2 and is_number(cells[0])
    )
    first = next(tables, stop)
    heads = [i for i in range(start + 1, first) if lines[i].count(",") > 2]
    if first == stop or len(heads) < 2:
        raise step.error("truncated: the step holds no table")
    labels, units = split(lines[heads[-2]], ","), split(lines[heads[-1]], ",")
    names = step.names(labels, "column")
    numbers = step.table(lines[first:stop], ",", len(labels), first + 1)
    step.settings = _cetr_settings(lines[start : heads[-2]])
    step.count(step.settings.get("Data Count", ""), len(numbers))
    if "T" not in names:
        raise step.error("there is no time column T")
    step.clock(numbers[:, names.index("T")])
    for i, label in enumerate(names):
        written = units[i] if i < len(units) else ""
        step.channel(label, numbers[:, i], written, unit="1" if label == "COF" else "")
    if "Fz" in step.channels and step.channels["Fz"].values.mean() < 0:
        step.notes.append("Fz is negative under load, as in the file")
    return step.trial("CETR log")


def _cetr_settings(lines: list[str]) -> dict[str, str]:
    found = {}
    for line in lines:
        for sign in ("=", ":", " - "):
            key, separator, value = line.partition(sign)
            if separator and key.strip() and value.strip():
                found[key.strip()] = value.strip()
                break
    return found


def read_pcs(draft: Draft) -> tuple[Trial, ...]:
    """Return one trial for each step that holds a table.

    Columns that repeat the first two appear once; empty columns are left out.
    """
    lines = draft.lines()
    if "Test Data File" not in lines[0]:
        raise draft.error("not a PCS log")
    starts = [i for i, line in enumerate(lines) if line.startswith("Step ") and "started" in line]
    general = _pcs_settings(lines[: starts[0]] if starts else [])
    _all_steps(draft, starts, general.get("Number of steps completed", ""))
    trials, without = [], []
    stops = [*starts[1:], len(lines)]
    for number, (start, stop) in enumerate(zip(starts, stops, strict=True), start=1):
        at = next((i for i in range(start + 1, stop) if lines[i].count("\t") > 8), None)
        if at is None:
            without.append(str(number))
        else:
            settings = general | _pcs_settings(lines[start:at])
            step = Draft(b"", f"{draft.name}, step {number}", settings=settings)
            trials.append(_pcs_step(lines, at, stop, step))
    if not trials:
        raise draft.error("no step holds a table")
    if without:
        note = f"steps without a table: {', '.join(without)}"
        trials = [trial.with_notes(note) for trial in trials]
    return tuple(trials)


def _pcs_step(lines: list[str], at: int, stop: int, step: Draft) -> Trial:
    labels = split(lines[at].rstrip("\t "), "\t")
    ignored = frozenset(i for i, x in enumerate(labels) if x.casefold() in _TEXT_COLUMNS)
    rows = [line for line in lines[at + 1 : stop] if is_number(line.split("\t", 1)[0])]
    numbers = step.table(rows, "\t", len(labels), at + 2, ignored)
    filled = sum(line.count("\t") > 8 and bool(line.strip()) for line in lines[at + 1 : stop])
    if filled > len(rows):
        step.notes.append(
            f"{filled - len(rows)} rows do not begin with a number (as #REF!) and are left out"
        )
    seen = np.flatnonzero(np.isfinite(numbers).any(axis=0))
    columns = [int(i) for i in seen if labels[i] and i not in ignored]
    # The first two columns are repeated further on.
    repeated = [i for i in columns[:2] if any(labels[j] == labels[i] for j in columns if j > i)]
    columns = [i for i in columns if i not in repeated]
    names = step.names([name_and_unit(labels[i])[0] for i in columns], "column")
    if "Step Time" not in names:
        raise step.error("there is no column Step Time")
    step.clock(numbers[:, columns[names.index("Step Time")]])
    for label, i in zip(names, columns, strict=True):
        written = name_and_unit(labels[i])[1]
        if not written and label.startswith(_SPEEDS):
            written = "mm/s"
        step.channel(label, numbers[:, i], written)
    return step.trial("PCS log")


def _pcs_settings(lines: list[str]) -> dict[str, str]:
    found = {}
    for line in lines:
        cells = [cell.strip() for cell in line.split("\t")]
        if len(cells) > 1:
            pairs = zip(cells[::2], cells[1::2], strict=False)
        else:
            pairs = [tuple(cell.strip() for cell in line.partition("="))[::2]]
        found.update({key.rstrip(":"): value for key, value in pairs if key and value})
    return found
