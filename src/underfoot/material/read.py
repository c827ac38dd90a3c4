"""Readers of relaxation tests, dynamic sweeps and Prony series."""

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, nearest_match, text, to_si

from .curves import DynamicSweep, RelaxationCurve
from .elastomer import young_from_shear
from .spectrum import RelaxationSpectrum

TIME = ("t", "time", "Zeit")
FREQUENCY = ("f", "freq", "frequency", "omega", "w", "angular frequency")
STORAGE = ("E_stor", "E'", "E1", "storage modulus", "G_stor", "G'", "E_storage")
LOSS = ("E_loss", "E''", 'E"', "E2", "loss modulus", "G_loss", "G''", 'G"')
RELAX = ("E_relax", "E", "E(t)", "relaxation modulus", "modulus", "G_relax", "G", "G(t)")
TEMPERATURE = ("T", "temp", "temperature")
SET = ("Set", "sweep", "run", "segment")
TAU = ("tau", "tau_i", "relaxation time", "relaxation_time", "time")
TERM = ("E_i", "G_i", "E", "G", "modulus", "term modulus")
FRACTION = ("e_i", "g_i", "alpha_i", "alpha", "fraction", "normalised modulus")
_NUMBER = re.compile(r"^[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?$")
_HEAD = re.compile(r"^\s*(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]\s*$")


@dataclass(frozen=True, slots=True)
class _Table:
    """Columns by name as printed, their units ("" where not given) and where they came from.

    ``stated`` gives units by column name or quantity where the file has none, or other ones.
    """

    columns: dict[str, np.ndarray]
    units: dict[str, str]
    stated: Mapping[str, str]
    where: str
    first_row: int

    def named(self, aliases: Sequence[str]) -> str | None:
        """Return the heading that is one of ``aliases``; case counts only for short symbols.

        t is a time and T a temperature, but "Time" and "TIME" are the same.
        """
        for alias in aliases:
            for name in self.columns:
                if name == alias or (len(alias) > 2 and name.casefold() == alias.casefold()):
                    return name
        return None

    def column(self, aliases: Sequence[str], unit: str, what: str) -> np.ndarray:
        """Return the column that has one of the ``aliases``, in SI ``unit``."""
        name = self.named(aliases)
        if name is None:
            near = (nearest_match(column, aliases) for column in self.columns)
            raise DataError(
                f"no column for {what} among {', '.join(self.columns)}",
                where=self.where,
                allowed=f"one named {', '.join(aliases[:6])}",
                nearest=next(filter(None, near), None),
            )
        values, where = self.complete(name), f"{self.where}, column {name}"
        written = (self.stated.get(name) or self.stated.get(what) or self.units[name]).strip()
        if written in ("", "-"):
            raise DataError(
                "no unit is given",
                where=where,
                allowed=f"a unit of {unit} in the heading, in a row below it, or as an argument",
            )
        if unit == "rad/s" and written.casefold() in ("hz", "khz", "1/s"):
            return values * (2.0 * np.pi * (1e3 if written.casefold() == "khz" else 1.0))
        try:
            zero, one = (to_si(f"{n} {written}", unit, where=where) for n in (0, 1))
        except InputError as error:
            raise DataError(
                error.what, where=where, allowed=error.allowed, nearest=error.nearest
            ) from error
        return values * (one - zero) + zero

    def complete(self, name: str) -> np.ndarray:
        """Return the numbers below a heading as written; refuse them where one is missing."""
        values = self.columns[name]
        missing = np.flatnonzero(~np.isfinite(values))
        if missing.size:
            raise DataError(
                f"{missing.size} of {values.size} values are missing in the column {name}, the "
                f"first in line {self.first_row + missing[0]}",
                where=self.where,
                remedy="Remove the rows, or repair them at their source",
            )
        return values


def _read_table(path: Path | str, units: Mapping[str, str] | None) -> _Table:
    """Return the first table of a text file with one row of headings.

    Separators may be comma, semicolon, tab or blanks; decimal commas are read where commas do
    not separate; a row of units may follow the headings, or units stand in brackets there.
    """
    where = str(path)
    lines = text.with_content(text.numbered_lines(path, "Export it as text"))
    if len(lines) < 2:
        raise DataError("the file holds no table", where=where, allowed="headings and rows")
    separator = next((s for s in (";", "\t", ",") if s in lines[0][1]), None)
    rows = [(i, text.cells_of(line, separator)) for i, line in lines]
    names, own_units, body = _headings(rows, where)
    comma = separator != "," and any("," in cell for _, row in body for cell in row)
    columns = np.empty((len(body), len(names)))
    for place, (i, row) in enumerate(body):
        if len(row) != len(names):
            hint = None
            if separator == "," and len(row) in (2 * len(names), 2 * len(names) - 1):
                hint = "Commas seem to be both separator and decimal sign: export with semicolons"
            raise DataError(
                f"line {i} has {len(row)} values for {len(names)} headings",
                where=where,
                remedy=hint,
            )
        columns[place] = text.row_of_numbers(row, comma, i, where)
    return _Table(
        dict(zip(names, columns.T, strict=True)),
        dict(zip(names, own_units, strict=True)),
        units or {},
        where,
        body[0][0],
    )


def _headings(
    rows: list[tuple[int, list[str]]], where: str
) -> tuple[list[str], list[str], list[tuple[int, list[str]]]]:
    heads = rows[0][1]
    if all(_NUMBER.match(cell) for cell in heads if cell):
        raise DataError(
            "the first line holds numbers and no headings",
            where=where,
            remedy="Name the columns with their units, for example: f (Hz), E_stor (MPa)",
        )
    body = rows[1:]
    while len(heads) > 1 and heads[-1] == "" and all(row[-1] == "" for _, row in body):
        heads = heads[:-1]
        body = [(i, row[:-1]) for i, row in body]
    matched = [_HEAD.match(head) for head in heads]
    names = [m.group(1) if m else head for m, head in zip(matched, heads, strict=True)]
    units = [m.group(2) if m else "" for m in matched]
    if len(set(names)) < len(names):
        raise DataError(f"a heading occurs twice: {', '.join(names)}", where=where)
    second = body[0][1]
    if not any(_NUMBER.match(cell) for cell in second):
        if len(second) == len(names):
            units = [u or cell for u, cell in zip(units, second, strict=True)]
        body = body[1:]
    if not body:
        raise DataError("there are headings but no numbers", where=where)
    return names, units, body


def is_shear(path: Path | str) -> bool:
    """Return whether the headings of a table name moduli of shear (G', G_stor, G(t))."""
    columns = _read_table(path, None).columns
    return any(name.partition("_")[0].strip("'\"(t)") in ("G", "shear") for name in columns)


def read_dynamic(path: Path | str, *, units: Mapping[str, str] | None = None) -> list[DynamicSweep]:
    """Return the frequency sweeps of a text table, one for each temperature, coldest first.

    Columns: frequency (Hz or rad/s), storage and loss modulus, and for more than one sweep the
    temperature, with a column ``Set`` that numbers them (without it, rows within 2 K of each
    other make a sweep). Units stand in the headings, in the row below, or in ``units`` by column
    name. The temperature of a sweep is the mean of its rows.

    Raises:
        DataError: Columns, units or values missing; values at or below zero; the file unreadable.
    """
    table = _read_table(path, units)
    w = table.column(FREQUENCY, "rad/s", "frequency")
    storage = table.column(STORAGE, "Pa", "storage modulus")
    loss = table.column(LOSS, "Pa", "loss modulus")
    return [
        DynamicSweep(w[rows], storage[rows], loss[rows], temperature, source=table.where)
        for rows, temperature in _sets(table, w.size)
    ]


def read_relaxation(
    path: Path | str, *, units: Mapping[str, str] | None = None
) -> list[RelaxationCurve]:
    """Return the relaxation curves of a text table, one for each temperature, coldest first.

    Columns: time, relaxation modulus, and temperature and ``Set`` as in ``read_dynamic``. Rows
    of a set may run from late to early as a whole; otherwise times have to ascend.

    Raises:
        DataError: Columns, units or values missing; times neither ascending nor descending.
    """
    table = _read_table(path, units)
    time = table.column(TIME, "s", "time")
    modulus = table.column(RELAX, "Pa", "relaxation modulus")
    curves = []
    for rows, temperature in _sets(table, time.size):
        t, e = time[rows], modulus[rows]
        if t.size > 1 and np.all(np.diff(t) < 0.0):
            t, e = t[::-1], e[::-1]
        curves.append(RelaxationCurve(t, e, temperature, source=table.where))
    return curves


def read_prony(
    path: Path | str,
    *,
    instantaneous_modulus: float | None = None,
    equilibrium_modulus: float | None = None,
    shear: bool | None = None,
    poisson_ratio: float = 0.499,
    units: Mapping[str, str] | None = None,
) -> RelaxationSpectrum:
    """Return the spectrum of Young's modulus from a Prony series in CSV or TOML.

    CSV columns: ``tau`` and either absolute terms (``E_i`` or ``G_i``, with unit) or fractions of
    the instantaneous modulus (``e_i`` or ``g_i``). Absolute terms need the equilibrium or the
    instantaneous modulus (Pa), fractions need one of them. Columns ``G_i`` and ``g_i``, or
    ``shear=True``, mean shear moduli, turned into Young's with ``poisson_ratio``.

    TOML: ``modulus = "young"`` or ``"shear"``, ``equilibrium_modulus`` or
    ``instantaneous_modulus`` as text with unit, optional ``poisson_ratio`` and ``source``, and
    ``[[term]]`` tables with ``relaxation_time`` and ``modulus`` (text with unit) or ``fraction``.

    Raises:
        DataError: Nothing to fix the level by, fractions that sum to more than one, columns
            missing.
        InputError: Negative terms or times.
    """
    path = Path(path)
    if path.suffix.casefold() == ".toml":
        return _prony_toml(path, poisson_ratio)
    table = _read_table(path, units)
    tau = table.column(TAU, "s", "relaxation time")
    absolute = [name for name in TERM if name in table.columns]
    fractions = [name for name in FRACTION if name in table.columns]
    if not fractions and not absolute:
        raise DataError(
            f"no column of terms among {', '.join(table.columns)}",
            where=str(path),
            allowed="E_i or G_i (with unit), e_i or g_i (fractions)",
        )
    spectrum = _prony(
        tau,
        table.columns[fractions[0]]
        if fractions
        else table.column(absolute[:1], "Pa", "term modulus"),
        bool(fractions),
        instantaneous_modulus,
        equilibrium_modulus,
        str(path),
        str(path),
    )
    if shear is None:
        shear = any(name in table.columns for name in ("G_i", "g_i", "G"))
    return young_from_shear(spectrum, poisson_ratio) if shear else spectrum


def _prony(
    tau: np.ndarray,
    terms: np.ndarray,
    fractions: bool,
    instantaneous: float | None,
    equilibrium: float | None,
    where: str,
    source: str,
) -> RelaxationSpectrum:
    """Return the spectrum of terms in Pa, or in ``fractions`` of the instantaneous modulus."""
    level, from_start = (equilibrium, False) if instantaneous is None else (instantaneous, True)
    if level is None or (from_start and equilibrium is not None):
        raise DataError(
            "a Prony series needs either the instantaneous or the equilibrium modulus",
            where=where,
            allowed="one of instantaneous_modulus and equilibrium_modulus",
        )
    total = float(np.sum(terms))
    if fractions:
        if not (np.all(np.isfinite(terms)) and np.all(terms >= 0.0) and total <= 1.0 + 1e-6):
            raise DataError(
                f"fractions of the instantaneous modulus sum to {total:g}",
                where=where,
                allowed="fractions of 0 or more that sum to 1 at most",
                remedy="If they are fractions of the equilibrium modulus, give absolute terms",
            )
        if not from_start and total >= 1.0 - 1e-12:
            raise DataError(
                "the fractions sum to 1, so the equilibrium modulus is zero",
                where=where,
                remedy="Give the instantaneous modulus",
            )
        start = level if from_start else level / (1.0 - total)
        terms, level = terms * start, max(start * (1.0 - total), 0.0)
    elif from_start:
        if level - total < -1e-6 * level:
            raise DataError(
                f"the terms sum to {total:g} Pa, more than the instantaneous modulus {level:g} Pa",
                where=where,
            )
        level = max(level - total, 0.0)
    return RelaxationSpectrum(level, terms, tau, source=source)


def _prony_toml(path: Path, poisson_ratio: float) -> RelaxationSpectrum:
    try:
        data = tomllib.loads(text.decoded(text.existing(path).read_bytes(), str(path)))
    except tomllib.TOMLDecodeError as error:
        raise DataError(f"not valid TOML: {error}", where=str(path)) from error
    kind = data.get("modulus", "young")
    if kind not in ("young", "shear"):
        raise InputError(
            f'"{kind}" is not a kind of modulus', where="modulus", allowed='"young" or "shear"'
        )
    items: list[dict[str, Any]] = data.get("term", [])
    if not items:
        raise DataError("there are no [[term]] tables", where=str(path))
    with_fraction = ["fraction" in item for item in items]
    if any(with_fraction) and not all(with_fraction):
        raise DataError("some terms have a fraction and some a modulus", where=str(path))

    def values(key: str, unit: str) -> np.ndarray:
        for i, item in enumerate(items, 1):
            if key not in item:
                raise DataError(f"term {i} has no {key}", where=str(path), allowed=f"{key} = text")
        return np.array(
            [to_si(t[key], unit, where=f"term {i}.{key}") for i, t in enumerate(items, 1)]
        )

    tau = values("relaxation_time", "s")
    instantaneous, equilibrium = (
        to_si(data[name], "Pa", where=name) if name in data else None
        for name in ("instantaneous_modulus", "equilibrium_modulus")
    )
    spectrum = _prony(
        tau,
        np.array([float(item["fraction"]) for item in items])
        if all(with_fraction)
        else values("modulus", "Pa"),
        all(with_fraction),
        instantaneous,
        equilibrium,
        str(path),
        str(data.get("source", path)),
    )
    if kind == "shear":
        return young_from_shear(spectrum, float(data.get("poisson_ratio", poisson_ratio)))
    return spectrum


def _sets(table: _Table, count: int) -> list[tuple[np.ndarray, float | None]]:
    tested = table.named(TEMPERATURE) is not None
    kelvin = table.column(TEMPERATURE, "K", "temperature") if tested else None
    label = table.named(SET)
    if label is not None:
        numbers = table.complete(label)
        groups = [np.flatnonzero(numbers == n) for n in np.unique(numbers)]
    elif kelvin is not None:
        order = np.argsort(kelvin, kind="stable")
        cuts = np.flatnonzero(np.diff(kelvin[order]) > 2.0) + 1
        groups = [np.sort(group) for group in np.split(order, cuts)]
    else:
        groups = [np.arange(count)]
    sets = [(rows, None if kelvin is None else float(kelvin[rows].mean())) for rows in groups]
    return sorted(sets, key=lambda pair: pair[1] if pair[1] is not None else 0.0)
