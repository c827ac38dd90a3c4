"""Readings that a machine already made (pendulum, ramp, tribometers), and classes of floors."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, unknown_name

from ..measurement import Measurement, caution
from ..protocols import Protocol
from ..readers.text import is_number
from .conditions import table_columns
from .file_result import Draft, FileResult

QUANTITIES = {
    "ptv": ("ptv", "srv", "bpn", "pendulum test value", "pendulum", "pendelwert"),
    "angle": ("angle", "ramp angle", "acceptance angle", "angle of slip", "winkel"),
    "cof": (
        "cof", "dcof", "scof", "coefficient of friction", "friction", "slip resistance", "mu", "µ",
        "slip index", "reibwert", "reibzahl", "gleitreibwert", "gleitreibungskoeffizient",
    ),
}  # fmt: skip
_RUN = ("run", "type of run", "kind of run", "lauf")
_ZERO = re.compile(r"zero|null", re.IGNORECASE)
_CONDITIONING = re.compile(r"condition|warm|einlauf|vorlauf", re.IGNORECASE)
_LARGEST = {"ptv": 150.0, "angle": 90.0, "cof": 3.0}


def reading_results(
    name: str, path: Path, checksum: str, noted: Mapping[str, Any], protocol: Protocol
) -> list[FileResult]:
    """Return one result for each sample of a table of readings (one reading a row).

    Every text column is a condition; rows that agree in all of them are readings of one sample.
    A column "run" may say "zero" (the mean of these readings is taken off the sample's others)
    or "conditioning" (left out). The protocol may leave out the first readings of each sample
    (``conditioning``) and keep the last ones (``readings``). A table in which no column can be
    recognised as readings, and impossible values, are a `DataError`.
    """
    columns, lines = table_columns(path)
    cells = {head: column for head, _, column in columns}
    numbers = {
        head: column
        for head, column in cells.items()
        if any(column) and all(is_number(c.replace(",", ".")) for c in column if c)
    }
    column, quantity = _value_column(list(numbers), name, protocol)
    values = np.array([float(c.replace(",", ".")) if c else np.nan for c in numbers[column]])
    top = _LARGEST[quantity]
    wrong = np.flatnonzero((values < (-0.1 * top)) | (values > top))
    if len(wrong):
        text = f"line {lines[wrong[0]]}: {column} is {values[wrong[0]]:g}"
        raise DataError(text, where=name, allowed=f"0 to {top:g}")
    runs = next((cells[c] for c in cells if c.casefold() in _RUN), None)
    texts = {
        k: v
        for k, v in cells.items()
        if k.casefold() not in _RUN
        and k != column
        and (k not in numbers or k.casefold() in ("direction", "operator", "laboratory", "sample"))
    }
    rows: dict[tuple[str, ...], list[int]] = {}
    for i in range(len(values)):
        rows.setdefault(tuple(text[i] for text in texts.values()), []).append(i)
    results = []
    for key, members in rows.items():
        label = ", ".join(part for part in key if part)
        own = {k.casefold(): v for k, v in zip(texts, key, strict=True) if v}
        file = f"{name}: {label}" if label and len(rows) > 1 else name
        draft = Draft(file, {**noted, **own}, checksum)
        words = [runs[i] if runs else "" for i in members]
        _one_sample(draft, values[members], words, quantity, protocol)
        results.append(draft.finished(protocol))
    return results


def _one_sample(
    draft: Draft, values: np.ndarray, runs: Sequence[str], quantity: str, protocol: Protocol
) -> None:
    zero = np.array([bool(_ZERO.search(text)) for text in runs])
    first = np.array([bool(_CONDITIONING.search(text)) for text in runs])
    offset = float(np.nanmean(values[zero])) if np.isfinite(values[zero]).any() else 0.0
    counted = values[~zero & ~first & np.isfinite(values)]
    drop = int(protocol.number("conditioning", "1", 0.0)) if not first.any() else 0
    last = int(protocol.number("readings", "1", 0.0))
    readings = counted[drop:][-last:] if last else counted[drop:]
    draft.facts["repeats"] = float(len(readings))
    if not len(readings):
        draft.refusals.append("no reading is left after zero and conditioning runs")
        return
    flags = []
    if quantity == "ptv" and abs(offset) > 1.0:
        flags.append(caution(f"the zero run reads {offset:.1f}: the pendulum was not at zero"))
    spread = float(readings.std(ddof=1)) if len(readings) > 1 else None
    conventions = {
        "readings": f"mean of {len(readings)} of {len(values)}",
        "left out": f"{int(first.sum()) + drop} conditioning, {int(zero.sum())} zero runs",
        "zero": f"mean of the zero runs, {offset:.4g}, taken off" if zero.any() else "not measured",
    }
    value = float(readings.mean()) - offset
    scatter = (None, "a single reading has no scatter")
    if spread is not None:
        scatter = (spread / float(np.sqrt(len(readings))), "")
    unit = "deg" if quantity == "angle" else "1"
    noted = (len(readings), tuple(flags), conventions, spread)
    draft.add("sample", Measurement(quantity, value, unit, *scatter, *noted), main=quantity)
    draft.curves["readings"] = [float(v) for v in readings - offset]
    name = protocol.text("classes")
    if name:
        scheme = class_scheme(name)
        if scheme.quantity != quantity:
            draft.cautions.append(f"{scheme.title} is about {scheme.quantity}, not {quantity}")
        else:
            draft.curves["class"] = scheme.class_of(value)


def _value_column(names: list[str], where: str, protocol: Protocol) -> tuple[str, str]:
    quantity, named = protocol.text("quantity"), protocol.text("column")
    folded = {name.casefold().strip(): name for name in names}
    if named and named.casefold() in folded:
        return folded[named.casefold()], quantity or "cof"
    for candidate in (quantity,) if quantity else QUANTITIES:
        column = next((folded[n] for n in QUANTITIES[candidate] if n in folded), None)
        if column and not named:
            return column, candidate
    raise DataError(
        "no column of readings was recognised",
        where=where,
        allowed=", ".join(names) or "a column of numbers",
        remedy='Name it in the protocol: column = "..."',
    )


@dataclass(frozen=True, slots=True)
class ClassScheme:
    """Classes in rising order: (smallest value, name). Below the first there is no class.

    ``quantity``: ``"ptv"`` (pendulum test value), ``"angle"`` (degrees), ``"cof"``. ``above``: True
    where a value must exceed a limit, False where reaching it is enough. ``whole``: True where
    readings are rounded to whole numbers first.
    """

    name: str
    title: str
    quantity: str
    limits: tuple[tuple[float, str], ...]
    source: str
    above: bool = False
    whole: bool = False

    def class_of(self, value: float) -> str:
        """Return the class of a value; ``"none"`` below the lowest."""
        if self.whole:
            value = float(round(value))
        name = "none"
        for limit, label in self.limits:
            if value > limit or (value == limit and not self.above):
                name = label
        return name


_MEMORY = "from memory, not verified against the text"
SCHEMES: dict[str, ClassScheme] = {
    scheme.name: scheme
    for scheme in (
        ClassScheme(
            "uksrg_pendulum", "Slip potential by pendulum (UKSRG)", "ptv",
            tuple((ptv, f"{risk} slip potential") for ptv, risk in
                  ((0, "high"), (25, "moderate"), (36, "low"))),
            f"UK Slip Resistance Group: 0-24 high, 25-35 moderate, 36 and more low; {_MEMORY}",
            whole=True,
        ),
        ClassScheme(
            "din_51130", "Shod ramp with oil (DIN 51130, EN 16165 annex B)", "angle",
            ((6, "R9"), (10, "R10"), (19, "R11"), (27, "R12"), (35, "R13")),
            "DIN 51130: R9 above 6 deg, R10 above 10, R11 above 19, R12 above 27, R13 above 35; "
            + _MEMORY, above=True,
        ),
        ClassScheme(
            "din_51097", "Barefoot ramp with soapy water (DIN 51097, EN 16165 annex A)", "angle",
            ((12, "A"), (18, "B"), (24, "C")),
            f"DIN 51097: A from 12 deg, B from 18, C from 24; {_MEMORY}",
        ),
        ClassScheme(
            "dguv_tribometer", "Sliding friction of floors (DIN 51131, EN 16165 annex D)", "cof",
            ((0, "unsafe"), (0.30, "conditionally safe"), (0.45, "safe")),
            f"DGUV Information 208-041: below 0.30 unsafe, from 0.45 safe; {_MEMORY}",
        ),
        ClassScheme(
            "ansi_a326_3", "Wet dynamic COF of tiles (ANSI A326.3, BOT-3000E)", "cof",
            ((0, "below the limit"), (0.42, "at or above 0.42")),
            f"ANSI A326.3: wet DCOF of 0.42 or greater for level interior floors; {_MEMORY}",
        ),
    )
}  # fmt: skip


def class_scheme(name: str) -> ClassScheme:
    """Return a scheme of classes.

    InputError: unknown name, with the nearest one.
    """
    if name not in SCHEMES:
        raise unknown_name("scheme of classes", name, SCHEMES, where="classes")
    return SCHEMES[name]


def cof_of_pendulum(ptv: float) -> float:
    """Return the COF of a pendulum test value, 3 PTV / (330 - PTV).

    Range: PTV from 0 to 150. Source: the pendulum's energy balance (C. G. Giles, B. E. Sabey,
    K. H. F. Cardew, Road Research Technical Paper 66, 1964; from memory, not verified).
    """
    return 3.0 * ptv / (330.0 - ptv)
