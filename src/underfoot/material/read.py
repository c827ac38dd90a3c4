"""Readers of relaxation tests, dynamic sweeps and Prony series."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, text, to_si
from underfoot.core.remark import Message

from .curves import DynamicSweep, RelaxationCurve
from .decks import is_deck, read_deck
from .elastomer import young_from_shear
from .spectrum import RelaxationSpectrum
from .tables import FileColumn, FileTable, read_tables

MODULI = ("modulus at once", "modulus at rest")
_TERMS = ("term", "relaxation modulus", "storage modulus")
FEWEST = 3
"""Frequencies of a sweep."""
SAME = 0.5
"""K: tests within it, and far closer than others, are at one temperature."""
OTHER_TANGENT = 1.2
"""Ratio of a loss factor to loss over storage modulus that no rounding makes."""
OTHER_STRAIN = 1.5
"""Ratio of two strains from which they are not one that the machine did not quite hold."""
_LEVELS = 'the modulus at once (--at-once "8 MPa") or at rest (--at-rest "0.8 MPa")'


@dataclass(frozen=True, slots=True)
class RubberTest:
    """What a file of a rubber holds: one of sweeps, curves and a Prony series, as in the file.

    ``shear`` says whether its moduli are those of shear, None where nothing tells; ``notes`` what
    was taken of it.
    """

    sweeps: tuple[DynamicSweep, ...] = ()
    curves: tuple[RelaxationCurve, ...] = ()
    series: RelaxationSpectrum | None = None
    shear: bool | None = None
    notes: tuple[str, ...] = ()


def read_rubber(
    path: Path | str,
    *,
    units: Mapping[str, str] | None = None,
    modulus_unit: str | None = None,
    instantaneous_modulus: float | None = None,
    equilibrium_modulus: float | None = None,
) -> RubberTest | None:
    """Return the test of a rubber in a file, told by its columns; None where there is none.

    Frequencies with moduli are sweeps, relaxation times with terms a series (so are TOML files
    and decks of LS-DYNA, Abaqus, CalculiX and FEBio), times with a modulus a relaxation.

    Parameters:
        units: By column name or quantity, where the file has none.
        modulus_unit: Of every modulus, where the file has none.
        instantaneous_modulus, equilibrium_modulus: Pa, one of them for a series that fixes no
            level by itself.

    Raises:
        DataError: The file is one of these and can't be used.
        InputError: Negative terms or times.
    """
    path = Path(path)
    levels = (instantaneous_modulus, equilibrium_modulus)
    if path.suffix.casefold() == ".toml":
        series, shear = _prony_toml(path)
        given = _given_ratio(path)
        if shear and given is not None:  # the file's own ratio goes before that of a command
            series, shear = young_from_shear(series, given), False
        return RubberTest(series=series, shear=shear)
    if is_deck(path):
        deck = read_deck(path, modulus_unit)
        return RubberTest(series=deck.series, shear=deck.shear, notes=deck.notes)
    stated = dict(units or {})
    if modulus_unit:
        for quantity in ("relaxation modulus", "storage modulus", "loss modulus", *MODULI,
                         "modulus magnitude", "term"):  # fmt: skip
            stated.setdefault(quantity, modulus_unit)
    tables = read_tables(path, stated)
    for has, made in (
        (_is_sweep, lambda t: RubberTest(sweeps=tuple(_sweeps(t)))),
        (_is_series, lambda t: RubberTest(series=_series(t[0], *levels))),
        (_is_relaxation, lambda t: RubberTest(curves=tuple(_curves(t)))),
    ):
        fitting = [table for table in tables if has(table)]
        if fitting:
            test = made(fitting)
            notes = ("moduli of a rheometer: taken as those of shear",)
            headed = any(one.headed_shear is not None for one in fitting)
            said = notes if fitting[0].rheometer and not headed else ()
            return RubberTest(test.sweeps, test.curves, test.series, fitting[0].shear, said)
    return None


def read_dynamic(path: Path | str, *, units: Mapping[str, str] | None = None) -> list[DynamicSweep]:
    """Return the frequency sweeps of a text file, one for each temperature, coldest first.

    Columns: frequency (Hz or rad/s), storage and loss modulus (or one of them and the loss
    factor; magnitude and phase; complex viscosity and phase; storage and loss compliance), and
    for more than one sweep the temperature. A column ``Set`` numbers the sweeps; without it they
    are found by their order, where frequencies start again, else as many as the machine held. Units
    stand in the headings, in the row below, or in ``units`` by column name. The temperature of a
    sweep is the mean of its rows.

    Raises:
        DataError: Columns, units or values missing; values at or below zero; the file unreadable.
    """
    tables = read_tables(path, units)
    return _sweeps([table for table in tables if _is_sweep(table)] or tables[:1])


def read_relaxation(
    path: Path | str, *, units: Mapping[str, str] | None = None
) -> list[RelaxationCurve]:
    """Return the relaxation curves of a text file, one for each temperature, coldest first.

    Columns: time, relaxation modulus, and temperature and ``Set`` as in ``read_dynamic``. Rows
    of a set may run from late to early as a whole; a time that starts again starts a curve.

    Raises:
        DataError: Columns, units or values missing; times neither ascending nor descending.
    """
    tables = read_tables(path, units)
    return _curves([table for table in tables if _is_relaxation(table)] or tables[:1])


def _is_sweep(table: FileTable) -> bool:
    return table.find_column("angular frequency", "frequency") is not None and any(
        table.find_column(name) is not None
        for name in ("storage modulus", "loss modulus", "modulus magnitude", "complex viscosity",
                     "storage compliance", "loss factor")
    )  # fmt: skip


def _is_series(table: FileTable) -> bool:
    timed = table.find_column("relaxation time", "decay rate") is not None
    if table.find_column("fraction", "term") is not None:
        return timed or table.find_column("time") is not None
    return timed


def _is_relaxation(table: FileTable) -> bool:
    return (
        table.find_column("time") is not None
        and table.find_column("relaxation modulus") is not None
    )


def _sweeps(tables: Sequence[FileTable]) -> list[DynamicSweep]:
    found = []
    for table in tables:
        w = table.angular_frequency()
        storage, loss = _moduli(table, w)
        _refuse_strains(table, w)
        if w.size > FEWEST and np.ptp(w) < 1e-3 * w.max():
            raise DataError(
                Message(
                    "one frequency, {frequency:.3g} Hz, in all {rows} rows: no spectrum",
                    frequency=w[0] / (2 * np.pi),
                    rows=w.size,
                ),
                where=table.where,
                allowed=Message("{fewest} frequencies or more at each temperature", fewest=FEWEST),
                remedy="Test several frequencies at each temperature of a ramp (multi-frequency)",
            )
        found += [
            DynamicSweep(w[rows], storage[rows], loss[rows], temperature, source=table.where)
            for rows, temperature in _sets(table, w)
        ]
    return sorted(found, key=lambda sweep: sweep.temperature or 0.0)


def _refuse_strains(table: FileTable, w: np.ndarray) -> None:
    """Refuse a table that repeats its frequencies at other strains.

    A filled rubber is softer the further it is strained (Payne): no spectrum fits them together.
    """
    column, hot = table.find_column("strain"), table.find_column("temperature")
    if column is None:
        return
    try:
        strain = np.abs(table.numbers(column))
    except DataError:  # a gap in a column that no modulus needs
        return
    kelvin = np.zeros_like(w) if hot is None else table.si(hot)
    places: dict[tuple[int, int], list[float]] = {}
    for row in zip(np.round(100 * np.log(w)), np.round(kelvin / SAME), strain, strict=True):
        places.setdefault((int(row[0]), int(row[1])), []).append(float(row[2]))
    repeated = [place for place in places.values() if len(place) > 1]
    if len(repeated) > 0.5 * len(places) and all(
        max(each) > OTHER_STRAIN * min(each) for each in repeated
    ):
        raise DataError(
            Message(
                "each frequency was tested at several strains, {name} {min:g} to {max:g}",
                name=column.name,
                min=strain.min(),
                max=strain.max(),
            ),
            where=table.where,
            allowed="one strain",
            remedy="Keep the rows of one strain, near that of use: a filled rubber is softer the "
            "further it is strained",
        )


def _moduli(table: FileTable, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return storage and loss modulus (Pa) from whatever pair of columns gives them."""

    def si(name: str) -> np.ndarray | None:
        column = table.find_column(name)
        return None if column is None else table.si(column)

    storage, loss, tangent = (si(n) for n in ("storage modulus", "loss modulus", "loss factor"))
    angle = si("phase angle")
    if tangent is None and angle is not None:
        tangent = np.tan(angle)
    if storage is not None and loss is not None and tangent is not None:
        _refuse_other_tangent(loss / storage, tangent, table.where)
    if storage is not None and (loss is not None or tangent is not None):
        return storage, storage * tangent if loss is None else loss
    if loss is not None and tangent is not None:
        return loss / tangent, loss
    size = si("modulus magnitude")
    if size is None and (viscosity := si("complex viscosity")) is not None:
        size = viscosity * w
    if size is not None and tangent is not None:
        storage = size / np.sqrt(1.0 + tangent**2)
        return storage, storage * tangent
    compliance, lost = si("storage compliance"), si("loss compliance")
    if compliance is not None and lost is not None:
        square = compliance**2 + lost**2
        return compliance / square, lost / square
    missing = ("loss modulus", "loss factor") if storage is not None else ("storage modulus",)
    if size is not None:
        missing = ("phase angle", "loss factor")
    table.require_column(*missing)
    raise AssertionError  # one of them would have been used


def _refuse_other_tangent(ratio: np.ndarray, tangent: np.ndarray, where: str) -> None:
    """Refuse a loss modulus over the storage modulus that is not the loss factor beside them."""
    with np.errstate(divide="ignore", invalid="ignore"):  # zeros are refused as such, later
        apart = float(np.median(np.abs(np.log(ratio / tangent))))
    if apart > np.log(OTHER_TANGENT):
        raise DataError(
            Message(
                "loss over storage modulus is {quotient:.3g} in the middle, the loss factor "
                "beside them {loss_factor:.3g}",
                quotient=np.median(ratio),
                loss_factor=np.median(tangent),
            ),
            where=where,
            remedy="Correct the unit of the moduli or of the loss factor, or remove one column",
        )


def _curves(tables: Sequence[FileTable]) -> list[RelaxationCurve]:
    curves = []
    for table in tables:
        time = table.si(table.require_column("time"))
        modulus = table.si(table.require_column("relaxation modulus"))
        for rows, temperature in _sets(table, time):
            t, e = time[rows], modulus[rows]
            if t.size > 1 and np.all(np.diff(t) < 0.0):
                t, e = t[::-1], e[::-1]
            curves.append(RelaxationCurve(t, e, temperature, source=table.where))
    return sorted(curves, key=lambda curve: curve.temperature or 0.0)


def read_prony(
    path: Path | str,
    *,
    instantaneous_modulus: float | None = None,
    equilibrium_modulus: float | None = None,
    shear: bool | None = None,
    poisson_ratio: float = 0.499,
    units: Mapping[str, str] | None = None,
) -> RelaxationSpectrum:
    """Return the spectrum of Young's modulus from a Prony series in CSV, TOML or a solver's deck.

    CSV columns: ``tau`` (or decay rates ``beta`` = 1 / tau) and either absolute terms (``E_i`` or
    ``G_i``, with unit) or fractions of the instantaneous modulus (``e_i``, ``g_i``, ``alpha_i``).
    A row with tau = inf or beta = 0 is the modulus at rest; a column ``E_0`` (as pyvisco writes
    it) the instantaneous, ``E_inf`` that at rest. A series that names neither needs one of
    ``instantaneous_modulus`` and ``equilibrium_modulus`` (Pa). Columns of shear, or
    ``shear=True``, are turned into Young's with ``poisson_ratio``.

    TOML: ``modulus = "young"`` or ``"shear"``, ``equilibrium_modulus`` or
    ``instantaneous_modulus`` as text with unit, optional ``poisson_ratio`` and ``source``, and
    ``[[term]]`` tables with ``relaxation_time`` and ``modulus`` (text with unit) or ``fraction``.

    A series that leaves (next to) nothing at rest flows under load: ``RelaxationSpectrum.cautions``
    says so.

    Raises:
        DataError: Nothing to fix the level by, fractions that sum to more than one, columns
            missing.
        InputError: Negative terms or times.
    """
    path = Path(path)
    if path.suffix.casefold() == ".toml":
        spectrum, of_shear = _prony_toml(path)
        given = _given_ratio(path)
        poisson_ratio = poisson_ratio if given is None else given
    elif is_deck(path):
        deck = read_deck(path, (units or {}).get("modulus"))
        spectrum, of_shear = deck.series, deck.shear
    else:
        tables = read_tables(path, units)
        table = next((table for table in tables if _is_series(table)), tables[0])
        spectrum = _series(table, instantaneous_modulus, equilibrium_modulus)
        of_shear = bool(table.shear)
    return young_from_shear(spectrum, poisson_ratio) if (
        of_shear if shear is None else shear
    ) else spectrum  # fmt: skip


def _series(
    table: FileTable, instantaneous: float | None, equilibrium: float | None
) -> RelaxationSpectrum:
    """Return the series of a table, moduli as headed."""
    where, tau = table.where, _times(table)
    fraction, term = table.find_column("fraction"), table.find_column(*_TERMS)
    terms = fraction or term
    if terms is None:
        raise DataError(
            Message(
                "no column of terms among {columns}",
                columns=[text.excerpt(column.name) for column in table.columns],
            ),
            where=where,
            allowed="E_i or G_i (with unit), e_i or g_i (fractions)",
        )
    values = table.si(terms)
    wrong = np.flatnonzero(values < 0.0)
    if wrong.size and fraction is None:
        raise InputError(
            Message(
                "term {wrong} (line {line}) is negative",
                wrong=wrong[0] + 1,
                line=table.lines[wrong[0]],
            ),
            where=where,
            allowed="terms of 0 or more",
            remedy="Fit the series again with terms of 0 or more: a negative one stores energy",
        )
    resting = np.isinf(tau)
    stands = {name: _constant(table, table.find_column(name)) for name in MODULI}
    at_once, at_rest = stands["modulus at once"], stands["modulus at rest"]
    if at_once is not None and at_rest is not None:
        at_once = None  # they say the same; the one at rest needs no sum
    if resting.any():
        if fraction is None:
            at_once, at_rest = None, float(values[resting].sum())
        tau, values = tau[~resting], values[~resting]
    if instantaneous is not None or equilibrium is not None:
        at_once, at_rest = instantaneous, equilibrium
    return _prony(tau, values, fraction is not None, at_once, at_rest, where, where)


def _constant(table: FileTable, column: FileColumn | None) -> float | None:
    """Return the modulus (Pa) that a column holds, in every row or in the first alone."""
    if column is None:
        return None
    cells = [cell for cell in column.cells if cell.casefold() not in text.MISSING]
    whole = FileTable(
        (FileColumn(column.name, column.quantity, column.unit, tuple(cells), column.form),),
        table.lines,
        table.where,
        stated=table.stated,
    )
    values = whole.si(whole.columns[0])
    if values.size == 0 or np.ptp(values) > 1e-9 * abs(values[0]):
        raise DataError(
            Message("the column {name} holds more than one modulus", name=column.name),
            where=table.where,
        )
    return float(values[0])


def _times(table: FileTable) -> np.ndarray:
    """Return relaxation times (s), infinite for the modulus at rest."""
    column = table.find_column("relaxation time", "decay rate") or table.find_column("time")
    if column is None:
        column = table.require_column("relaxation time", "decay rate")
    if column.quantity == "decay rate":
        rate = table.si(column)
        with np.errstate(divide="ignore"):
            tau = np.where(rate == 0.0, np.inf, 1.0 / rate)
    else:
        tau = table.si(column, infinite=True)
    wrong = np.flatnonzero(~(tau > 0.0))
    if wrong.size:
        raise InputError(
            Message(
                "{name} {cell} in line {line}",
                name=column.name,
                cell=column.cells[wrong[0]],
                line=table.lines[wrong[0]],
            ),
            where=table.where,
            allowed="relaxation times above 0, inf for the modulus at rest",
        )
    return tau


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
            allowed="one of instantaneous_modulus and equilibrium_modulus, a row tau = inf, or a "
            "column E_0 or E_inf",
            remedy=f"Give {_LEVELS}",
        )
    total = float(np.sum(terms))
    if fractions:
        if not (np.all(np.isfinite(terms)) and np.all(terms >= 0.0) and total <= 1.0 + 1e-6):
            raise DataError(
                Message("fractions of the instantaneous modulus sum to {total:g}", total=total),
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
                Message(
                    "the terms sum to {total:g} Pa, more than the instantaneous modulus "
                    "{level:g} Pa",
                    total=total,
                    level=level,
                ),
                where=where,
            )
        level = max(level - total, 0.0)
    return RelaxationSpectrum(level, terms, tau, source=source)


def _toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(text.decode_text(text.existing(path).read_bytes(), str(path)))
    except tomllib.TOMLDecodeError as error:
        raise DataError(Message("not valid TOML: {error}", error=error), where=str(path)) from error


def _given_ratio(path: Path) -> float | None:
    """Return Poisson's ratio that a series in TOML names."""
    given = _toml(path).get("poisson_ratio")
    return None if given is None else to_si(given, "1", where=f"{path}, poisson_ratio")


def _prony_toml(path: Path) -> tuple[RelaxationSpectrum, bool]:
    """Return the series of a TOML file as it is, and whether it is of shear."""
    data = _toml(path)
    kind = data.get("modulus", "young")
    if kind not in ("young", "shear"):
        raise InputError(
            Message('"{kind}" is not a kind of modulus', kind=kind),
            where="modulus",
            allowed='"young" or "shear"',
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
                raise DataError(
                    Message("term {term} has no {name}", term=i, name=key),
                    where=str(path),
                    allowed=f"{key} = text",
                )
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
        values("fraction", "1") if all(with_fraction) else values("modulus", "Pa"),
        all(with_fraction),
        instantaneous,
        equilibrium,
        str(path),
        str(data.get("source", path)),
    )
    return spectrum, kind == "shear"


def _sets(table: FileTable, axis: np.ndarray) -> list[tuple[np.ndarray, float | None]]:
    """Return the rows of each test of a table and its temperature (K), coldest first.

    ``axis`` is what runs within a test: frequency or time.
    """
    column, label = table.find_column("temperature"), table.find_column("set")
    kelvin = None if column is None else table.si(column)
    if label is not None:
        numbers = table.numbers(label)
        groups = [np.flatnonzero(numbers == n) for n in np.unique(numbers)]
    else:
        groups = _test_rows(axis, kelvin)
    sets = [(rows, table.kelvin if kelvin is None else float(kelvin[rows].mean()))
            for rows in groups]  # fmt: skip
    return sorted(sets, key=lambda pair: pair[1] if pair[1] is not None else 0.0)


def _test_rows(axis: np.ndarray, kelvin: np.ndarray | None) -> list[np.ndarray]:
    """Return the rows of each test by what the machine did: runs of the axis that start again.

    Runs at the temperature of the run before (a sweep up and down, a repeated one) are one test.
    Where the axis does not run (each frequency over all temperatures), the rows are parted at the
    widest steps between their temperatures, into as many tests as the commonest frequency has rows.
    """
    whole = [np.arange(axis.size)]
    runs = _runs(axis)
    if kelvin is None:
        up = all(axis[run[-1]] > axis[run[0]] for run in runs)
        return runs if len(runs) > 1 and up and min(map(len, runs)) > FEWEST else whole
    if np.ptp(kelvin) < SAME:
        return whole
    if sum(len(run) for run in runs if len(run) >= FEWEST) < 0.8 * axis.size:
        order = np.argsort(kelvin, kind="stable")
        _, count = np.unique(np.round(np.log(axis), 3), return_counts=True)
        steps = np.diff(kelvin[order])
        cuts = np.sort(np.argsort(steps)[steps.size - (count.max() - 1) :]) + 1
        return [np.sort(group) for group in np.split(order, cuts)]
    means = [float(kelvin[run].mean()) for run in runs]
    steps = np.abs(np.diff(means))
    wide = steps[steps > SAME]
    same = min(SAME, 0.3 * float(np.median(wide))) if wide.size else SAME
    if not wide.size and np.ptp(means) > 2 * SAME:
        same = 0.0  # a slow ramp: every run is a test of its own
    order = np.argsort(means, kind="stable")
    groups: list[list[int]] = []
    for k in order:
        if groups and means[k] - means[groups[-1][0]] <= same:
            groups[-1].append(int(k))
        else:
            groups.append([int(k)])
    return [np.sort(np.concatenate([runs[k] for k in group])) for group in groups]


def _runs(axis: np.ndarray) -> list[np.ndarray]:
    """Return the rows of each run of values that only rise or only fall."""
    starts, sign = [0], 0.0
    for k, step in enumerate(np.sign(np.diff(axis)), 1):
        if step == 0.0 or (sign and step != sign):
            starts.append(k)
            sign = 0.0
        else:
            sign = step
    return np.split(np.arange(axis.size), starts[1:])
