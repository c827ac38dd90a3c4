"""Readings that a machine already made: pendulum, ramp, tribometers."""

import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError
from underfoot.core.remark import NOTHING, Message, join_lines

from ..recording.measurement import Measurement, caution
from ..recording.protocols import Protocol
from ..recording.tester_calibration import TesterCalibration
from ..statistics import drift, standard_deviation
from .condition_table import (
    LARGEST,
    QUANTITIES,
    TableColumns,
    coded_levels,
    first_text,
    numbers_of_columns,
    tables_of,
)
from .conditions import one_spelling
from .file_result import FileResult, FileResultDraft, Sample, refer_to
from .floor_classes import class_scheme

NOTED = {
    "slider": ("slider", "rubber", "gleiter"),
    "condition": ("condition", "contaminant", "fluid", "state", "zustand", "gleitmittel"),
    "direction": ("direction", "richtung"),
}
"""What a protocol can ask to be noted, with the headings that say it."""
_RUN = ("run", "type of run", "kind of run", "lauf")
_ZERO = re.compile(r"zero|null", re.IGNORECASE)
_CONDITIONING = re.compile(r"condition|warm|einlauf|vorlauf", re.IGNORECASE)
NO_CHECKS = Message("none in the table")
"""Convention of a sample without readings on check surfaces."""
NO_ZERO = Message("not measured")
"""Convention of a sample without zero runs."""
_CHECK = re.compile(r"check|verif|pr(ü|ue)f", re.IGNORECASE)
_NTH = re.compile(
    r"((swing|reading|test|run|value|messung|schwung|wert|lauf|versuch|ablesung|r|s)[ _.]?)?"
    r"#?\d{1,2}",
    re.I,
)
_SUMMARY = re.compile(
    r"mean|average|median|mw|mittel(wert)?|sd|std(ev)?|(standard deviation|standardabweichung)"
    r"|stabw|min(imum)?|max(imum)?",
    re.IGNORECASE,
)
"""Labels of rows below a table that hold no reading but a number of those above."""
_OUTCOME = re.compile(
    rf"(?<![^\W_])({_SUMMARY.pattern}|results?|verdict|pass|potential|ergebnis|urteil|bewertung)"
    r"(?![^\W_])",
    re.IGNORECASE,
)
"""Headings of what is computed from readings: they tell no samples apart."""
_REMARK = re.compile(
    r"(?<![^\W_])(remarks?|comments?|notes?|bemerkung(en)?|kommentar|notiz(en)?)(?![^\W_])",
    re.IGNORECASE,
)
"""Headings of what is said about single readings, where some have nothing."""
_FEWEST_BESIDE = 3  # numbered columns of a record sheet
_DRY = re.compile(r"dry|trocken", re.IGNORECASE)
_WALKERS = (
    "operator", "walker", "test person", "person", "subject", "tester", "prüfer", "prüferin",
    "prüfperson", "testperson", "begeher",
)  # fmt: skip
"""Headings of who walked on a ramp: two of them make one angle."""
_BOARD = (
    "standard angle", "board angle", "angle of the board", "sollwinkel", "standardwinkel",
)  # fmt: skip
"""Headings of the angle that a calibration board of the ramp has by its certificate."""
_READ_BY = {
    "operator": ("operator", "prüfer", "prüferin", "prüfperson", "bediener"),
    "machine": ("machine", "tribometer", "device", "instrument", "gerät", "maschine"),
    "laboratory": ("laboratory", "lab", "labor", "prüflabor"),
}
"""Headings of what reads a sample, by the name under which its readings are compared."""
HOW_READ = (*(h for heads in NOTED.values() for h in heads), *_WALKERS, "date",
            *(name for names in _READ_BY.values() for name in names))  # fmt: skip
"""Headings of how, when and by whom a sample was read: they do not name it."""
_LABELS = (*HOW_READ, "sample")
_UNITS = {
    "ptv": {"": 1.0, "1": 1.0, "ptv": 1.0, "srv": 1.0, "bpn": 1.0},
    "angle": {"": 1.0, "deg": 1.0, "°": 1.0, "grad": 1.0, "rad": 180.0 / math.pi},
    "cof": {"": 1.0, "1": 1.0, "-": 1.0, "%": 0.01},
}
# All readings in this range: another quantity or unit than the heading says.
_MISTAKEN = {
    "ptv": (0.0, 2.0, "a coefficient of friction? A pendulum reads whole numbers"),
    "angle": (0.0, 1.6, "radians? Write angle (rad)"),
    "cof": (1.2, 3.0, "wrong quantity or unit?"),
}
_SLIDERS = {"fours": "96", "4s": "96", "trl": "55", "trrl": "55"}
_SURFACES = {
    "glass": {"96": (5, 10), "55": (5, 10)},
    "lapping": {"96": (59, 64)},
    "pavigr": {"96": (32, 36), "55": (13, 19)},
}
"""PTV that a pendulum must read on check surfaces, by slider. Source: UKSRG Guidelines, Issue 4.0
(2016), as listed by the maker (munroinstruments.com, verifying the pendulum tester)."""


@dataclass(frozen=True, slots=True)
class _Check:
    """Mean of the readings on a check surface with one slider, and why it fails, or ""."""

    slider: str
    description: Message
    failed: bool


def reading_results(
    name: str,
    path: Path,
    checksum: str,
    noted: Mapping[str, Any],
    protocol: Protocol,
    record: TesterCalibration | None = None,
) -> list[FileResult]:
    """Return one result for each sample of the tables of readings in a file (one reading a row).

    Sheets of a workbook with the same headings are one table. Every text column is a condition, but
    for verdicts, means and remarks about some of the readings; rows that agree in all of them are
    readings of one sample (of one direction, with one slider). A column "run" may say "zero" (the
    mean of these readings is taken off the sample's others), "conditioning" (left out) or "check"
    (a surface of known PTV: a failed check refuses the readings of its slider). Of a ramp a row
    with a "standard angle" is a calibration board, which shows how far its operator reads off. The
    protocol may leave out the first readings (``conditioning``) where more than ``readings`` are
    given. A table in which no column can be recognised as readings, impossible values and one
    condition in two spellings are a `DataError` or `InputError`.
    """
    tables = tables_of(path)
    known = {protocol.text("column").casefold()}.union(*QUANTITIES.values())
    wanted = [sheet for sheet, table in tables.items() if _holds_readings(table, known)]
    results = []
    for sheet in wanted or list(tables)[:1]:
        label = f"{name}, {sheet}" if len(wanted) > 1 else name
        results += _table_results(label, tables[sheet], checksum, noted, protocol, record)
    return results


def _holds_readings(table: TableColumns, known: Collection[str]) -> bool:
    heads = [head.casefold() for head, _, _ in table[0]]
    beside = sum(bool(_NTH.fullmatch(head)) for head in heads)
    return beside >= _FEWEST_BESIDE or any(head in known for head in heads)


def _table_results(
    name: str,
    table: TableColumns,
    checksum: str,
    noted: Mapping[str, Any],
    protocol: Protocol,
    record: TesterCalibration | None,
) -> list[FileResult]:
    columns, lines = _one_a_row(*table, protocol.text("quantity"))
    cells = {head: column for head, _, column in columns}
    units = {head: unit for head, unit, _ in columns}
    read = numbers_of_columns(cells, name)
    numbers = {
        head: np.array(read[head], dtype=float)
        for head, own in cells.items()
        if any(own) and first_text(own, read[head]) is None
    }
    column, quantity = _value_column(list(numbers), name, protocol, cells, read, lines)
    unit = units[column].casefold()
    if unit not in _UNITS[quantity]:
        allowed = ", ".join(u for u in _UNITS[quantity] if u)
        raise DataError(
            Message('{column} is in "{unit}"', column=column, unit=units[column]),
            where=name,
            allowed=allowed,
        )
    values = numbers[column] * _UNITS[quantity][unit]
    top = LARGEST[quantity]
    wrong = np.flatnonzero((values < (-0.1 * top)) | (values > top))
    if len(wrong):
        text = Message(
            "line {line}: {column} is {value:g}",
            line=lines[wrong[0]],
            column=column,
            value=values[wrong[0]],
        )
        raise DataError(text, where=name, allowed=f"0 to {top:g}")
    runs = next((cells[c] for c in cells if c.casefold() in _RUN), [""] * len(values))
    texts = {
        k.casefold(): v
        for k, v in cells.items()
        if k.casefold() not in _RUN
        and k != column
        and _names_samples(k, cells[k])
        and (k not in numbers or k.casefold() in _LABELS)
    }
    # floors 1, 2, 3 are samples, not one sample with a number beside its readings
    coded = {
        k.casefold(): coded_levels(k.casefold(), units[k], read[k], most=len(values) - 1, fewest=1)
        for k in numbers
        if k != column
        and k.casefold() not in (*texts, *_RUN, *_BOARD)
        and _names_samples(k, cells[k])
    }
    texts |= {name: levels for name, levels in coded.items() if levels is not None}
    walker = next((k for k in texts if k in _WALKERS), "") if quantity == "angle" else ""
    if walker:
        texts = {"operator" if k == walker else k: v for k, v in texts.items()}
    for by, heads in _READ_BY.items():
        called = [head for head in heads if head in texts]
        if len(called) == 1 and not (by == "operator" and walker):
            texts = {by if head == called[0] else head: v for head, v in texts.items()}
    for i, labels in enumerate(zip(*texts.values(), strict=True)):
        label = next(filter(None, labels), "")
        if np.isfinite(values[i]) and _SUMMARY.fullmatch(label):
            raise DataError(
                Message(
                    'line {line}: "{label}" is no sample but a number of others',
                    line=lines[i],
                    label=label,
                ),
                where=name,
                remedy="Leave rows of means and standard deviations out: they are computed",
            )
    one_spelling([{k: v[i] for k, v in texts.items() if v[i]} for i in range(len(values))], False)
    board = next((cell for cell in cells if cell.casefold() in _BOARD), None)
    boards = None
    if quantity == "angle" and board is not None:
        _check_numbers(board, cells[board], read[board], lines, name)
        standards = np.array(read[board], dtype=float)
        standards *= _UNITS["angle"].get(units[board].casefold(), 1.0)
        boards = _boards(name, board, standards, texts, values)
    checks: dict[tuple[str, str], list[int]] = {}
    rows: dict[tuple[str, ...], list[int]] = {}
    for i, run in enumerate(runs):
        if boards is not None and i in boards.rows:
            continue
        key = tuple(text[i] for text in texts.values())
        if quantity == "ptv" and _CHECK.search(run):
            checks.setdefault(
                (_slider(dict(zip(texts, key, strict=True))), " ".join((run, *key))), []
            ).append(i)
        else:
            rows.setdefault(key, []).append(i)
    checked = [_check(name, *key, values[members]) for key, members in checks.items()]
    results = []
    for key, members in rows.items():
        label = ", ".join(part for part in key if part)
        conditions = {k: v for k, v in zip(texts, key, strict=True) if v}
        file = f"{name}: {label}" if label and len(rows) > 1 else name
        draft = FileResultDraft(file, {**noted, **conditions}, checksum)
        refer_to(record, draft)
        used = [c for c in checked if _slider(conditions) in ("", c.slider)]
        draft.refusals += [c.description for c in used if c.failed]
        check_surfaces = join_lines(c.description for c in used) if used else NO_CHECKS
        kinds = [runs[i] for i in members]
        _one_sample(draft, values[members], kinds, quantity, protocol, check_surfaces)
        if boards is not None:
            on_boards = boards.read.get(conditions.get("operator", ""), ())
            draft.sample = replace(draft.sample, boards=on_boards)
        draft.sample = replace(draft.sample, source=name)
        results.append(draft.finish_result(protocol))
    return results


def _names_samples(head: str, cells: Sequence[str]) -> bool:
    """Whether a column can tell samples apart: no outcome, and no remark about some readings."""
    return not _OUTCOME.search(head) and (all(cells) or not _REMARK.search(head))


def _one_a_row(
    columns: list[tuple[str, str, list[str]]], lines: list[int], quantity: str
) -> tuple[list[tuple[str, str, list[str]]], list[int]]:
    """Return a record sheet ("Swing 1", "Swing 2" ... beside each other) with a reading a row.

    They are COF where the protocol names no ``quantity`` (COF as a machine gives it).
    """
    wide = [column for column in columns if _NTH.fullmatch(column[0])]
    beside = [column for column in columns if not _NTH.fullmatch(column[0])]
    names = [name for one in ([quantity] if quantity else QUANTITIES) for name in QUANTITIES[one]]
    named = any(head.casefold() in names for head, _, _ in beside)
    if len(wide) < _FEWEST_BESIDE or named:
        return columns, lines
    every = len(wide)
    readings = [cell for row in zip(*(cells for _, _, cells in wide), strict=True) for cell in row]
    repeated = [(head, unit, [c for c in cells for _ in wide]) for head, unit, cells in beside]
    return [*repeated, (quantity or "cof", wide[0][1], readings)], [
        n for n in lines for _ in range(every)
    ]


@dataclass(frozen=True, slots=True)
class _Boards:
    """Rows of calibration boards; by operator (standard angle, angle read, its u), degrees."""

    rows: frozenset[int]
    read: Mapping[str, tuple[tuple[float, ...], ...]]


def _boards(
    name: str,
    head: str,
    standards: np.ndarray,
    texts: Mapping[str, Sequence[str]],
    values: np.ndarray,
) -> _Boards:
    rows = np.flatnonzero(np.isfinite(standards) & np.isfinite(values)).tolist()
    if "operator" not in texts:
        raise DataError(
            Message('"{head}" tells calibration boards, but nobody walks on them', head=head),
            where=name,
            allowed="a column operator",
            remedy="Name the walker of each reading",
        )
    own: dict[str, dict[float, list[float]]] = {}
    for i in rows:
        of_one = own.setdefault(texts["operator"][i], {})
        of_one.setdefault(float(standards[i]), []).append(float(values[i]))
    read = {
        operator: tuple(
            (
                standard,
                float(np.mean(angles)),
                float(np.std(angles, ddof=1) / np.sqrt(len(angles))) if len(angles) > 1 else 0.0,
            )
            for standard, angles in sorted(angles_of.items())
        )
        for operator, angles_of in own.items()
    }
    return _Boards(frozenset(rows), read)


def board_correction(
    angle: float, boards: Sequence[Sequence[float]], share: float
) -> tuple[float, float]:
    """Return what is added to an angle that a walker read, and its standard uncertainty, degrees.

    ``share`` of the walker's deviation on the calibration boards, on straight lines between the
    angles that the walker read there, that of the nearest board beyond them.

    ``boards``: (standard angle, angle read, u of that) each.
    """
    if not len(boards):
        return 0.0, 0.0
    standard, read, error = np.array(sorted(map(list, boards), key=lambda one: one[1])).T
    return share * float(np.interp(angle, read, standard - read)), share * float(error.max())


def _slider(noted: Mapping[str, Any]) -> str:
    text = " ".join(str(noted.get(name, "")) for name in NOTED["slider"]).strip()
    known = next((s for s in ("96", "55", "57") if s in text), "")
    return known or _SLIDERS.get(re.sub(r"[\s_-]|slider", "", text.casefold()), text)


def _check(name: str, slider: str, label: str, values: np.ndarray) -> _Check:
    surface = next((s for s in _SURFACES if s in label.casefold()), None)
    if surface is None:
        raise DataError(
            Message('a check on an unknown surface: "{label}"', label=label.strip()),
            where=name,
            allowed="float glass, lapping film, Pavigres tile",
        )
    mean = float(np.nanmean(values))
    low, high = _SURFACES[surface].get(slider, (0, 0))
    if not high:
        text = Message(
            "{surface} read {mean:.1f} with an unknown slider", surface=surface, mean=mean
        )
        return _Check(slider, text, True)
    failed = not low - 0.5 <= mean <= high + 0.5
    text = Message(
        "slider {slider} on {surface} read {mean:.1f} ({low} to {high})",
        slider=slider,
        surface=surface,
        mean=mean,
        low=low,
        high=high,
    )
    return _Check(slider, Message("check failed: {text}", text=text) if failed else text, failed)


def _one_sample(
    draft: FileResultDraft,
    values: np.ndarray,
    runs: Sequence[str],
    quantity: str,
    protocol: Protocol,
    checked: Message,
) -> None:
    zero = np.array([bool(_ZERO.search(text)) for text in runs])
    first = np.array([bool(_CONDITIONING.search(text)) for text in runs])
    offset = float(np.nanmean(values[zero])) if np.isfinite(values[zero]).any() else 0.0
    counted = values[~zero & ~first & np.isfinite(values)]
    last = int(protocol.number("readings", "1", 0.0))
    drop = 0 if first.any() else int(protocol.number("conditioning", "1", 0.0))
    # A report prints the readings that count; a record sheet has those of conditioning too.
    readings = counted[-last:] if last and len(counted) > last else counted
    draft.note(len(readings), "1", fact="repeats")
    if not len(readings):
        draft.refusals.append(Message("no reading is left after zero and conditioning runs"))
        return
    flags = []
    if last and len(counted) not in (last, last + drop):
        more = {"all": last + drop, "conditioning": drop}
        several = Message(" or {all} with the {conditioning} of conditioning", **more)
        flags.append(
            caution(
                "{count} {count:reading|readings}, {used} of them used; expected are "
                "{last}{several}",
                count=len(counted),
                used=len(readings),
                last=last,
                several=several if drop else "",
            )
        )
    fewest = int(protocol.number("fewest", "1", 0.0))
    if len(readings) < fewest:
        flags.append(
            caution(
                "{count} readings; expected are {fewest} of each walker",
                count=len(readings),
                fewest=fewest,
            )
        )
    low, high, words = _MISTAKEN[quantity]
    if low <= float(readings.min()) and float(readings.max()) < high and high > 0:
        text = Message(
            "readings of {low:g} to {high:g}: {what}",
            low=readings.min(),
            high=readings.max(),
            what=words,
        )
        (draft.cautions if quantity == "cof" else draft.refusals).append(text)
    widest = protocol.number("widest", "1", 0.0)
    if widest and float(np.ptp(readings)) > widest:
        flags.append(
            caution(
                "readings differ by {range:g}, expected at most {widest:g}",
                range=np.ptp(readings),
                widest=widest,
            )
        )
    rise = drift(readings)
    if rise is not None:
        flags.append(
            caution(
                "readings {way} by {change:.0f} % from the first to the last: is the floor "
                "cleaned, does the fluid dry, does it wear?",
                way=Message("rise") if rise > 0 else Message("fall"),
                change=100 * abs(rise),
            )
        )
    missing = [
        asked
        for asked in protocol.texts("noted")
        if not any(heading in draft.conditions for heading in NOTED.get(asked, (asked,)))
    ]
    if missing:
        flags.append(caution("not noted: {names}", names=missing))
    if quantity == "ptv" and _slider(draft.conditions) not in ("", "96", "55", "57"):
        flags.append(
            caution('unknown slider "{slider}": 96 or 55?', slider=_slider(draft.conditions))
        )
    if quantity == "ptv" and abs(offset) > 1.0:
        flags.append(
            caution("the zero run reads {offset:.1f}: the pendulum was not at zero", offset=offset)
        )
    spread = standard_deviation(readings)
    value, middle = float(readings.mean()) - offset, float(np.median(readings)) - offset
    if value < 0.0 or (value == 0.0 and quantity == "cof"):
        draft.refusals.append(
            Message(
                "a mean of {value:g}: no floor reads that; sign, zero or decimals?", value=value
            )
        )
    away = [f"{v:g}" for v in counted[: len(counted) - len(readings)]]
    conventions = {
        "readings": Message(
            "mean of {used} of {count}; median {middle:.4g}",
            used=len(readings),
            count=len(counted),
            middle=middle,
        ),
        "left out": Message(
            "{first} conditioning, {zero} zero runs{before}",
            first=int(first.sum()),
            zero=int(zero.sum()),
            before=Message("; before those that count: {away}", away=away) if away else NOTHING,
        ),
        "zero": Message("mean of the zero runs, {offset:.4g}, taken off", offset=offset)
        if zero.any()
        else NO_ZERO,
    }
    if quantity == "ptv":
        conventions["check surfaces"] = checked
    part = protocol.number("calibration_uncertainty", "1", 0.0) * abs(value)
    error, why = None, Message("equal readings scatter by less than their resolution")
    if len(readings) < 2:
        why = Message("a single reading has no scatter")
    if spread is not None:
        error, why = math.hypot(spread / math.sqrt(len(readings)), part), NOTHING
        if part:
            conventions["uncertainty"] = Message(
                "scatter of the mean and {part:.2g} of the calibration", part=part
            )
    name = protocol.text("classes")
    if name:
        state = " ".join(str(draft.conditions.get(key, "")) for key in NOTED["condition"])
        scheme = class_scheme(name, dry=bool(_DRY.search(state)))
        if scheme.quantity != quantity:
            draft.cautions.append(
                Message(
                    "{scheme} is about {about}, not {quantity}",
                    scheme=scheme.title,
                    about=scheme.quantity,
                    quantity=quantity,
                )
            )
        else:
            draft.sample = Sample(scheme=scheme.name)
            if scheme.class_of(middle) != scheme.class_of(value):
                flags.append(
                    caution(
                        "{middle} by the median, {mean} by the mean",
                        middle=scheme.class_of(middle),
                        mean=scheme.class_of(value),
                    )
                )
    unit = "deg" if quantity == "angle" else "1"
    about = (len(readings), tuple(flags), conventions, spread)
    draft.add("sample", Measurement(quantity, value, unit, error, why, *about), main=quantity)
    draft.sample = replace(draft.sample, readings=tuple((readings - offset).tolist()))


def _check_numbers(
    head: str,
    cells: Sequence[str],
    read: Sequence[float | None],
    lines: Sequence[int],
    where: str,
) -> None:
    """Refuse a column with a filled cell that holds no number."""
    bad = first_text(cells, read)
    if bad is not None:
        text = Message(
            'line {line}: {head} is "{cell}"', line=lines[bad], head=head, cell=cells[bad]
        )
        raise DataError(text, where=where, allowed="a number alone, or nothing")


def _value_column(
    names: list[str],
    where: str,
    protocol: Protocol,
    cells: Mapping[str, Sequence[str]],
    read: Mapping[str, Sequence[float | None]],
    lines: Sequence[int],
) -> tuple[str, str]:
    quantity, named = protocol.text("quantity"), protocol.text("column")
    folded = {name.casefold().strip(): name for name in names}
    if named and named.casefold() in folded:
        return folded[named.casefold()], quantity or "cof"
    remedy = 'Name it in the protocol: column = "..."'
    for candidate in (quantity,) if quantity else QUANTITIES:
        for head, column in cells.items():
            if head.casefold() not in QUANTITIES[candidate] or head in names:
                continue
            _check_numbers(head, column, read[head], lines, where)
        found = [folded[n] for n in QUANTITIES[candidate] if n in folded]
        if len(found) > 1:
            text = Message("several columns of readings: {names}", names=", ".join(found))
            raise DataError(text, where=where, remedy=remedy)
        if found and not named:
            return found[0], candidate
    heads = list(QUANTITIES[quantity]) if quantity else [one[0] for one in QUANTITIES.values()]
    raise DataError(
        Message(
            "no column of readings was recognised among {names}", names=", ".join(names) or "none"
        ),
        where=where,
        allowed=", ".join(heads),
        remedy=f"Write one reading a row, with what it is of in columns of words, or several "
        f'beside each other as "run 1", "run 2", "run 3". {remedy}',
    )
