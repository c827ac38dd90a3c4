"""Text logs of instruments: tribometers (CETR UMT, PCS), insoles (Pedar, F-Scan)."""

import re

import numpy as np

from underfoot.core import DataError
from underfoot.core.remark import Message

from ..recording.trial import Trial
from .draft import RecordingDraft
from .text import is_number, line_of, name_and_unit, si_unit, split, truncation_error

_TEXT_COLUMNS = ("image file name", "comments")
# Speeds are written without a unit; the rolling speed beside them is in mm/s.
_SPEEDS = ("Ball Speed", "Disc Speed")


def read_cetr(draft: RecordingDraft) -> tuple[Trial, ...]:
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
        _cetr_step(lines, *span, RecordingDraft(b"", f"{draft.name}, step {n}"))
        for n, span in pairs
    )


def _all_steps(draft: RecordingDraft, starts: list[int], announced: str) -> None:
    if not starts:
        raise draft.error("truncated: there is no step")
    if announced.isdigit() and int(announced) > len(starts):
        words = Message(
            "truncated: {announced} steps announced, {count} found",
            announced=announced,
            count=len(starts),
        )
        raise truncation_error(words, draft.name)


def _cetr_step(lines: list[str], start: int, stop: int, step: RecordingDraft) -> Trial:
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


def read_pcs(draft: RecordingDraft) -> tuple[Trial, ...]:
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
            step = RecordingDraft(b"", f"{draft.name}, step {number}", settings=settings)
            trials.append(_pcs_step(lines, at, stop, step))
    if not trials:
        raise draft.error("no step holds a table")
    if without:
        note = Message("steps without a table: {without}", without=without)
        trials = [trial.with_notes(note) for trial in trials]
    return tuple(trials)


def _pcs_step(lines: list[str], at: int, stop: int, step: RecordingDraft) -> Trial:
    labels = split(lines[at].rstrip("\t "), "\t")
    ignored = frozenset(i for i, x in enumerate(labels) if x.casefold() in _TEXT_COLUMNS)
    rows = [line for line in lines[at + 1 : stop] if is_number(line.split("\t", 1)[0])]
    numbers = step.table(rows, "\t", len(labels), at + 2, ignored)
    filled = sum(line.count("\t") > 8 and bool(line.strip()) for line in lines[at + 1 : stop])
    if filled > len(rows):
        step.notes.append(
            Message(
                "{count} rows do not begin with a number (as #REF!) and are left out",
                count=filled - len(rows),
            )
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


_SENSORS = 99  # of one Pedar insole
_MOST_CELLS = 50_000_000


def read_pedar(draft: RecordingDraft) -> Trial:
    """Return the pressures of a Pedar text export (.asc, .fgt) as channels.

    Files with 99 or 198 sensors become ``left 1`` to ``right 99`` (Pa), with the largest and the
    mean pressure of each insole; other columns keep their names. Forces need the sensors' areas,
    which the file does not hold.
    """
    lines = draft.lines()
    at = next((i for i, line in enumerate(lines[:60]) if line.casefold().startswith("time")), None)
    if at is None:
        raise draft.error("no column of times", allowed='a heading "time[secs]"')
    labels = split(lines[at].rstrip("\t "), "\t")
    rows = [x.rstrip("\t ") for x in lines[at + 1 :] if is_number(x.split("\t")[0])]
    numbers = draft.table(rows, "\t", len(labels), at + 2)
    draft.clock(numbers[:, 0])
    text = "\n".join(lines[:at]).casefold()
    written = next((u for u in ("kpa", "n/cm2", "n/cm^2") if u in text), "")
    count = len(labels) - 1
    if count not in (_SENSORS, 2 * _SENSORS):
        pairs = [name_and_unit(label) for label in labels]
        names = draft.names([name for name, _ in pairs], "column")
        for i in range(1, len(labels)):
            draft.channel(names[i], numbers[:, i], pairs[i][1])
        return draft.trial("Pedar")
    if not written:
        draft.notes.append("no unit of pressure in the header: taken as kPa")
    scale = 1e4 if "n/cm" in written else 1e3
    for foot in range(count // _SENSORS):
        side, first = ("left", "right")[foot], 1 + foot * _SENSORS
        pressure = numbers[:, first : first + _SENSORS]
        named = {f"{side} {i + 1}": pressure[:, i] for i in range(_SENSORS)}
        named[f"{side} insole, largest pressure"] = pressure.max(axis=1)
        named[f"{side} insole, mean pressure"] = pressure.mean(axis=1)
        for name, values in named.items():
            draft.channel(name, values, unit="Pa", scale=scale, note="")
    if count == _SENSORS:
        draft.notes.append("one insole: called left, the file does not say which")
    return draft.trial("Pedar")


def read_fscan(draft: RecordingDraft) -> Trial:
    """Return force, largest pressure and its centre of an F-Scan ASCII movie (.asf) as channels.

    The force is the sum of pressure times the area of a cell; saturated cells ("B") have no
    value and are counted.
    """
    lines = draft.lines()
    begins = [i for i, line in enumerate(lines) if re.match(r"frame\s+\d+", line, re.I)]
    if not begins:
        raise draft.error("no frame", allowed='lines "Frame 1"')
    header: dict[str, list[str]] = {}
    for line in lines[: begins[0]]:
        words = line.split()
        if len(words) > 1:
            header.setdefault(words[0].upper(), words[1:])
    try:
        rows, columns = int(header["ROWS"][0]), int(header["COLS"][0])
        spacing = [float(header[f"{k}_SPACING"][0]) for k in ("ROW", "COL")]
        step = float(header["SECONDS_PER_FRAME"][0])
    except (KeyError, ValueError) as error:
        raise draft.error(Message("the header lacks {error}", error=error)) from error
    unit = si_unit((header.get("UNITS") or [""])[0])
    if unit is None or unit[0] != "Pa":
        raise draft.error(
            Message('the unit is "{header}"', header=" ".join(header.get("UNITS", []))),
            allowed="a unit of pressure",
            remedy="Calibrate, and export pressures",
        )
    if not 0 < rows * columns < 1e5 or not 0 < step < 10:
        raise draft.error(
            Message("{rows} x {columns} cells, {step} s", rows=rows, columns=columns, step=step)
        )
    if len(begins) * rows * columns > _MOST_CELLS:
        raise draft.error("larger than any recording")
    saturated, frames = 0, []
    for number, at in enumerate(begins, start=1):
        body = lines[at + 1 : at + 1 + rows]
        cells = [[c.strip() for c in line.split(",")][:columns] for line in body]
        if len(cells) < rows or any(len(row) < columns for row in cells):
            where = line_of(draft.name, at + 1)
            raise DataError(
                Message("truncated: frame {number} is not complete", number=number), where=where
            )
        saturated += sum(cell.upper() == "B" for row in cells for cell in row)
        frames.append([[float(c) if is_number(c) else np.nan for c in row] for row in cells])
    pressure = np.array(frames) * unit[1]
    scale = 1e-3 if spacing[0] > 0.5 else 1.0
    area = float(np.prod(np.array(spacing) * scale))
    load = np.nansum(pressure, axis=(1, 2))
    y, x = (np.arange(n) * s * scale for n, s in zip((rows, columns), spacing, strict=True))
    with np.errstate(invalid="ignore", divide="ignore"):
        centre_y = np.nansum(pressure * y[:, None], axis=(1, 2)) / load
        centre_x = np.nansum(pressure * x, axis=(1, 2)) / load
    draft.rate = 1.0 / step
    for name, values, si in (
        ("force", load * area, "N"),
        ("largest pressure", np.nanmax(pressure, axis=(1, 2)), "Pa"),
        ("centre along rows", centre_y, "m"),
        ("centre along columns", centre_x, "m"),
    ):
        draft.channel(f"insole, {name}", values, unit=si, note="")
    if saturated:
        draft.notes.append(Message("{count} saturated cells have no value", count=saturated))
    return draft.trial("F-Scan")
