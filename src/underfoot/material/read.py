"""Readers of relaxation tests, dynamic sweeps and Prony series."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, to_si

from ._tables import TestTable, read_table
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


def read_dynamic(path: Path | str, *, units: Mapping[str, str] | None = None) -> list[DynamicSweep]:
    """Return the frequency sweeps of a text table, one for each temperature, coldest first.

    Columns: frequency (Hz or rad/s), storage and loss modulus, and for more than one sweep the
    temperature, with a column ``Set`` that numbers them (without it, rows within 2 K of each
    other make a sweep). Units stand in the headings, in the row below, or in ``units`` by column
    name. The temperature of a sweep is the mean of its rows.

    Raises:
        DataError: Columns, units or values missing; values at or below zero; the file unreadable.
    """
    table, column_units = read_table(path), dict(units or {})
    w = table.required(FREQUENCY, "rad/s", column_units, "frequency")
    storage = table.required(STORAGE, "Pa", column_units, "storage modulus")
    loss = table.required(LOSS, "Pa", column_units, "loss modulus")
    return [
        DynamicSweep(w[rows], storage[rows], loss[rows], temperature, source=table.where)
        for rows, temperature in _sets(table, column_units, w.size)
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
    table, column_units = read_table(path), dict(units or {})
    time = table.required(TIME, "s", column_units, "time")
    modulus = table.required(RELAX, "Pa", column_units, "relaxation modulus")
    curves = []
    for rows, temperature in _sets(table, column_units, time.size):
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
    table, column_units = read_table(path), dict(units or {})
    tau = table.required(TAU, "s", column_units, "relaxation time")
    exact = set(table.columns)
    fraction_names = [name for name in FRACTION if name in exact]
    term_names = [name for name in TERM if name in exact]
    is_shear = any(name in exact for name in ("G_i", "g_i", "G"))
    if fraction_names:
        fractions, terms = table.columns[fraction_names[0]], None
    elif term_names:
        fractions, terms = None, table.required(term_names[:1], "Pa", column_units, "term modulus")
    else:
        raise DataError(
            f"no column of terms among {', '.join(table.columns)}",
            where=str(path),
            allowed="E_i or G_i (with unit), e_i or g_i (fractions)",
        )
    spectrum = _prony(
        tau, terms, fractions, instantaneous_modulus, equilibrium_modulus, str(path), str(path)
    )
    return (
        young_from_shear(spectrum, poisson_ratio)
        if (shear or (shear is None and is_shear))
        else spectrum
    )


def _prony(
    tau: np.ndarray,
    terms: np.ndarray | None,
    fractions: np.ndarray | None,
    instantaneous: float | None,
    equilibrium: float | None,
    where: str,
    source: str,
) -> RelaxationSpectrum:
    if (instantaneous is None) == (equilibrium is None):
        raise DataError(
            "a Prony series needs either the instantaneous or the equilibrium modulus",
            where=where,
            allowed="one of instantaneous_modulus and equilibrium_modulus",
        )
    if fractions is not None:
        total = float(np.sum(fractions))
        if not (
            np.all(np.isfinite(fractions)) and np.all(fractions >= 0.0) and total <= 1.0 + 1e-6
        ):
            raise DataError(
                f"fractions of the instantaneous modulus sum to {total:g}",
                where=where,
                allowed="fractions of 0 or more that sum to 1 at most",
                remedy="If they are fractions of the equilibrium modulus, give absolute terms",
            )
        if instantaneous is None:
            if total >= 1.0 - 1e-12:
                raise DataError(
                    "the fractions sum to 1, so the equilibrium modulus is zero",
                    where=where,
                    remedy="Give the instantaneous modulus",
                )
            assert equilibrium is not None  # exactly one of the two is given
            instantaneous = equilibrium / (1.0 - total)
        terms = fractions * instantaneous
        equilibrium = max(instantaneous * (1.0 - total), 0.0)
    assert terms is not None  # either terms or fractions are given by the callers
    if equilibrium is None:
        assert instantaneous is not None  # exactly one of the two is given
        equilibrium = instantaneous - float(np.sum(terms))
        if equilibrium < -1e-6 * instantaneous:
            raise DataError(
                f"the terms sum to {np.sum(terms):g} Pa, more than the instantaneous modulus "
                f"{instantaneous:g} Pa",
                where=where,
            )
        equilibrium = max(equilibrium, 0.0)
    return RelaxationSpectrum(equilibrium, terms, tau, source=source)


def _prony_toml(path: Path, poisson_ratio: float) -> RelaxationSpectrum:
    try:
        with path.open("rb") as stream:
            data = tomllib.load(stream)
    except FileNotFoundError:
        raise DataError("there is no such file", where=str(path)) from None
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
    tau = np.array(
        [
            to_si(_key(t, "relaxation_time", path, i), "s", where=f"term {i}.relaxation_time")
            for i, t in enumerate(items, 1)
        ]
    )
    with_fraction = ["fraction" in item for item in items]
    if any(with_fraction) and not all(with_fraction):
        raise DataError("some terms have a fraction and some a modulus", where=str(path))
    terms = fractions = None
    if all(with_fraction):
        fractions = np.array([float(item["fraction"]) for item in items])
    else:
        terms = np.array(
            [
                to_si(_key(t, "modulus", path, i), "Pa", where=f"term {i}.modulus")
                for i, t in enumerate(items, 1)
            ]
        )
    levels = {
        name: to_si(data[name], "Pa", where=name) if name in data else None
        for name in ("instantaneous_modulus", "equilibrium_modulus")
    }
    spectrum = _prony(
        tau,
        terms,
        fractions,
        levels["instantaneous_modulus"],
        levels["equilibrium_modulus"],
        str(path),
        str(data.get("source", path)),
    )
    if kind == "shear":
        return young_from_shear(spectrum, float(data.get("poisson_ratio", poisson_ratio)))
    return spectrum


def _key(item: Mapping[str, Any], key: str, path: Path, number: int) -> Any:
    if key not in item:
        raise DataError(f"term {number} has no {key}", where=str(path), allowed=f"{key} = text")
    return item[key]


def _sets(
    table: TestTable, units: Mapping[str, str], count: int
) -> list[tuple[np.ndarray, float | None]]:
    kelvin = table.column(TEMPERATURE, "K", units, "temperature")
    label = table.named(SET)
    if label is not None:
        numbers = table.columns[label]
        groups = [np.flatnonzero(numbers == n) for n in np.unique(numbers)]
    elif kelvin is not None:
        order = np.argsort(kelvin, kind="stable")
        cuts = np.flatnonzero(np.diff(kelvin[order]) > 2.0) + 1
        groups = [np.sort(group) for group in np.split(order, cuts)]
    else:
        groups = [np.arange(count)]
    sets = [(rows, None if kelvin is None else float(kelvin[rows].mean())) for rows in groups]
    return sorted(sets, key=lambda pair: pair[1] if pair[1] is not None else 0.0)
