"""The corpus: published measurements of friction, one file a source, with what was not printed.

A file names its reference, where it was read and the laboratory (its own name where none is given:
sources of one laboratory are scored together). It holds *conditions* (sole, floor, fluid, motion; a
value, or a range where the source leaves it open) with what was measured on each and the sentence
it stands in, and *effects* (a sign, a ratio, a slope, an order between conditions). A source from
memory is marked ``verified = false`` and is never scored.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, nearest_match, to_si
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

RQ_PER_RA = math.sqrt(math.pi / 2)
"""Rq / Ra of Gaussian heights: stands in where a source prints Ra."""
FLUIDS = ("dry", "water", "detergent", "aqueous", "oil")
NUMBERS = {
    "shore_a": "1",
    "sole_ra": "m",
    "sole_rq": "m",
    "floor_ra": "m",
    "floor_rq": "m",
    "viscosity": "Pa*s",
    "speed": "m/s",
    "pressure": "Pa",
    "load": "N",
    "shoe_angle": "rad",
    "loss_tangent": "1",
}
"""Numbers of a condition and their SI unit."""
WORDS = ("device", "compound", "floor", "fluid", "tread", "members", "wear", "quote")
HEAD = ("reference", "read")
KINDS = {
    "value": {"cof"},
    "mean_of": {"cof"},
    "lower": {"cof"},
    "upper": {"cof"},
    "range": {"low", "high"},
    "eq_17": {"cof_bl", "tau_hydro", "cof_asymptote", "speeds", "sd_ln"},
}
"""Kinds of a measured value and what each needs."""
EFFECTS = ("sign", "ratio", "slope", "order")
NEEDED = ("fluid", "viscosity", "speed", "shore_a", "sole_rq", "floor_rq")
"""What a condition must hold to be computed (viscosity not when dry)."""


@dataclass(frozen=True, slots=True)
class Span:
    """A number of a condition, SI: one value, or the range that the source leaves open."""

    low: float
    high: float
    note: str = ""
    assumed: bool = False

    @property
    def is_open(self) -> bool:
        """Whether the source leaves the number open."""
        return self.high > self.low

    def at(self, share: Array) -> Array:
        """Return the number at shares 0 to 1 of the range, evenly in its logarithm."""
        return self.low * (self.high / self.low) ** share


@dataclass(frozen=True, slots=True)
class PublishedReading:
    """One measured value: COF or its bounds, and its standard deviation in ln COF."""

    kind: str
    low: float
    high: float
    sd_ln: float
    derived: str = ""

    @property
    def is_censored(self) -> bool:
        """Whether only bounds are known."""
        return self.high > self.low


@dataclass(frozen=True, slots=True)
class PublishedCondition:
    """One condition of one source with what was measured on it."""

    source: str
    id: str
    numbers: Mapping[str, Span]
    labels: Mapping[str, Any]
    reading: PublishedReading
    members: tuple[PublishedCondition, ...] = ()
    laboratory: str = ""

    @property
    def fluid(self) -> str:
        """Family of the fluid."""
        return self.labels["fluid"]

    @property
    def curve(self) -> tuple[str, str]:
        """Name of the printed curve that the reading is a point of: a curve counts once."""
        return self.source, self.id

    @property
    def pair(self) -> str:
        """Name of compound, floor and fluid: what shares one error of the pair.

        Soles of one polymer share it whatever their hardness.
        """
        compound, floor, fluid = map(self.labels.get, ("compound", "floor", "fluid"))
        parts = (self.source, compound or self.numbers["shore_a"].low, floor, fluid)
        return "|".join(map(str, parts))


@dataclass(frozen=True, slots=True)
class PublishedEffect:
    """A published effect between conditions."""

    source: str
    id: str
    kind: str
    content: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Source:
    """One publication of the corpus."""

    name: str
    reference: str
    read: str
    laboratory: str
    verified: bool
    conditions: tuple[PublishedCondition, ...]
    effects: tuple[PublishedEffect, ...]


@cache
def corpus() -> tuple[Source, ...]:
    """Return every source of the packaged corpus, by name."""
    with resources.as_file(resources.files("underfoot") / "data" / "measurements") as folder:
        return read_corpus(folder)


def read_corpus(folder: Path) -> tuple[Source, ...]:
    """Return the sources in a folder of TOML files.

    Raises:
        DataError: A file that cannot be read, a missing unit, a value without a source, an unknown
            key, or a condition that cannot be computed: file and place are named.
    """
    return tuple(read_source(path) for path in sorted(folder.glob("*.toml")))


def read_source(path: Path) -> Source:
    """Return one source; see ``read_corpus``."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataError(
            Message("the file cannot be read ({strerror})", strerror=error), where=str(path)
        ) from error
    for key in HEAD:
        if not isinstance(table.get(key), str) or not table[key].strip():
            raise DataError(
                f"no {key} is given: every value needs its source",
                where=f"{path.name}: {key}",
                remedy=f'Write {key} = "..." at the head of the file',
            )
    _check_keys(
        table, (*HEAD, "laboratory", "verified", "conditions", "condition", "effect"), path.name
    )
    shared = table.get("conditions", {})
    laboratory = str(table.get("laboratory", path.stem))
    return Source(
        name=path.stem,
        reference=table["reference"],
        read=table["read"],
        laboratory=laboratory,
        verified=bool(table.get("verified", True)),
        conditions=tuple(
            replace(condition, laboratory=laboratory)
            for entry in table.get("condition", [])
            for condition in _conditions(path.stem, {**shared, **entry})
        ),
        effects=tuple(_effect(path.stem, entry) for entry in table.get("effect", [])),
    )


def _conditions(source: str, entry: dict[str, Any]) -> Iterator[PublishedCondition]:
    name = entry.pop("id", None)
    if not isinstance(name, str):
        raise DataError("a condition has no id", where=f"{source}.toml: condition")
    where = f"{source}.toml: {name}"
    measured = entry.pop("measured", None)
    if not isinstance(measured, dict):
        raise DataError("nothing was measured on this condition", where=where)
    for speed, reading in _readings(measured, where):
        at = entry if speed is None else {**entry, "speed": speed}
        yield _condition(source, name, at, reading, where)


def _condition(
    source: str, name: str, entry: dict[str, Any], reading: PublishedReading, where: str
) -> PublishedCondition:
    _check_keys(entry, (*NUMBERS, *WORDS), where)
    members = tuple(
        _condition(
            source,
            f"{name} {number}",
            {key: item for key, item in {**entry, **member}.items() if key != "members"},
            reading,
            f"{where}, member {number}",
        )
        for number, member in enumerate(entry.get("members", []), start=1)
    )
    numbers = {key: _span(entry[key], key, where) for key in NUMBERS if key in entry}
    for part in ("sole", "floor"):
        if f"{part}_ra" in numbers and f"{part}_rq" not in numbers:
            ra = numbers[f"{part}_ra"]
            numbers[f"{part}_rq"] = Span(RQ_PER_RA * ra.low, RQ_PER_RA * ra.high, ra.note)
    labels = {key: entry[key] for key in WORDS if key in entry}
    if isinstance(labels.get("fluid"), dict):
        labels["fluid"] = labels["fluid"]["one_of"][0]
    if not members:
        needed = [key for key in NEEDED if key not in numbers and key not in labels]
        if labels.get("fluid") == "dry" and "viscosity" in needed:
            needed.remove("viscosity")
        if needed:
            raise DataError(
                f"the condition cannot be computed: {', '.join(needed)} missing",
                where=where,
                remedy="Write the value, or the range that the source leaves open: "
                'floor_rq = { range = ["0.3 um", "4 um"], note = "not printed" }',
            )
        if labels["fluid"] not in FLUIDS:
            raise _unknown(f'fluid "{labels["fluid"]}"', labels["fluid"], FLUIDS, f"{where}.fluid")
    return PublishedCondition(source, name, numbers, labels, reading, members)


def _readings(
    measured: dict[str, Any], where: str
) -> Iterator[tuple[str | None, PublishedReading]]:
    kind = measured.get("kind")
    if kind not in KINDS:
        raise _unknown(f"kind of measurement {kind!r}", kind, KINDS, f"{where}.measured.kind")
    lacking = KINDS[kind] - measured.keys()
    if lacking:
        raise DataError(f"{', '.join(sorted(lacking))} missing", where=f"{where}.measured")
    _check_keys(
        measured, (*KINDS[kind], "kind", "sd", "sd_ln", "cof_bl_se", "derived"), f"{where}.measured"
    )
    derived = str(measured.get("derived", ""))
    if kind == "eq_17":
        tau = _number(measured["tau_hydro"], "m/s", f"{where}.measured.tau_hydro")
        level, end = float(measured["cof_bl"]), float(measured["cof_asymptote"])
        for text in measured["speeds"]:
            speed = _number(text, "m/s", f"{where}.measured.speeds")
            cof = end + (level - end) * math.exp(-speed / tau)
            yield text, PublishedReading("value", cof, cof, float(measured["sd_ln"]), derived)
    elif kind == "range":
        low, high = (_cof(measured[end], where) for end in ("low", "high"))
        yield None, PublishedReading(kind, low, high, float(measured.get("sd_ln", 0.1)), derived)
    else:
        cof = _cof(measured["cof"], where)
        spread = float(measured.get("sd_ln", measured.get("sd", 0.08 * cof) / cof))
        low = 0.0 if kind == "upper" else cof
        high = math.inf if kind == "lower" else cof
        yield None, PublishedReading(kind, low, high, spread, derived)


def _cof(item: Any, where: str) -> float:
    """Return COF, of a pendulum's test value ("36 PTV") 3 PTV / (330 - PTV).

    It gives the pairs that a test house prints, 31 and 0.31, 36 and 0.37, 50 and 0.54, 82 and 1.00
    (safetydirectamerica.com, COF vs. Pendulum Test Value), to 0.01.
    """
    if not isinstance(item, str):
        return float(item)
    number, _, unit = item.partition(" ")
    if unit != "PTV" or not number.isdigit() or not 0 < int(number) <= 150:
        raise DataError(
            f'"{item}" is no friction', where=where, allowed='a COF or "1 PTV" to "150 PTV"'
        )
    return 3 * int(number) / (330 - int(number))


def _span(item: Any, key: str, where: str) -> Span:
    unit, place = NUMBERS[key], f"{where}.{key}"
    if not isinstance(item, dict):
        value = _number(item, unit, place)
        return Span(value, value)
    _check_keys(item, ("value", "range", "note", "assumed"), place)
    note, assumed = str(item.get("note", "")), bool(item.get("assumed", False))
    if "range" in item:
        low, high = (_number(end, unit, place) for end in item["range"])
        if not 0 < low < high:
            raise DataError("the range does not ascend from above 0", where=place)
        return Span(low, high, note, assumed)
    value = _number(item.get("value"), unit, place)
    return Span(value, value, note, assumed)


def _number(item: Any, unit: str, where: str) -> float:
    try:
        return to_si(item, unit, where=where)
    except InputError as error:
        raise DataError(
            error.what, where=where, allowed=error.allowed, nearest=error.nearest
        ) from error


def _effect(source: str, entry: dict[str, Any]) -> PublishedEffect:
    name, kind = entry.pop("id", None), entry.pop("kind", None)
    if not isinstance(name, str) or kind not in EFFECTS:
        raise DataError(
            "an effect needs an id and a kind",
            where=f"{source}.toml: {name or 'effect'}",
            allowed=", ".join(EFFECTS),
        )
    return PublishedEffect(source, name, kind, entry)


def _check_keys(table: Mapping[str, Any], keys: tuple[str, ...], where: str) -> None:
    for key in table:
        if key not in keys:
            raise _unknown(f'key "{key}"', key, keys, where)


def _unknown(what: str, given: object, known: Iterable[str], where: str) -> DataError:
    known = tuple(known)
    near = nearest_match(str(given), known)
    return DataError(f"unknown {what}", where=where, allowed=", ".join(known), nearest=near)


def sampled_numbers(
    condition: PublishedCondition, shares: Array, unknown: Mapping[str, Span] | None = None
) -> dict[str, Array]:
    """Return the numbers of a condition at ``shares`` (draws, numbers), open ones over their range.

    The columns belong to the names of ``NUMBERS`` in their order; values in SI, shape (draws,).
    A number of another name has one value. ``unknown`` are the ranges of numbers that a condition
    does not name.
    """
    numbers = {**(unknown or {}), **condition.numbers}
    columns = dict(zip(NUMBERS, shares.T, strict=True))
    return {
        key: span.at(columns[key]) if span.is_open else np.full(shares.shape[0], span.low)
        for key, span in numbers.items()
    }
