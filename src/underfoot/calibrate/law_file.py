"""From analysed trials to a friction table that a case refers to: where evidence becomes a law."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, InputError, nearest_match
from underfoot.core.errors import first_names
from underfoot.core.remark import Message, Remark

Array = NDArray[np.float64]
FORMS = ("fit", "readings")
POINTS = 21
ENOUGH = 6
"""Repeats from which their own scatter is taken for that of a speed."""
_NOT_CONDITIONS = {"file", "verdict", "COF", "friction force (N)", "speed (m/s)", "reasons"}
_ONE_OF = ("fluid", "contaminant", "shoe", "sole", "material", "floor", "surface")
"""Conditions in which one law holds for one value only."""


@dataclass(frozen=True, slots=True, eq=False)
class TrialReadings:
    """Usable readings of one pair and fluid: ``speed`` (m/s) and ``cof``, (n,); their origin.

    ``viscosity`` Pa s, None where the conditions don't hold one; ``left_out`` files refused.
    """

    speed: Array
    cof: Array
    viscosity: float | None
    left_out: int
    origin: str


@dataclass(frozen=True, slots=True, eq=False)
class LawTable:
    """COF with its standard deviation at rising speeds, (m,); ``notes`` say what it rests on."""

    speed: Array
    cof: Array
    deviation: Array
    viscosity: float | None
    source: str
    notes: tuple[str, ...]


def trial_readings(folder: Path, chosen: Mapping[str, str] | None = None) -> TrialReadings:
    """Return the readings in a folder that ``underfoot trials analyse`` wrote.

    Parameters:
        folder: With ``tables/files.csv``: COF and speed of each file and its conditions.
        chosen: Conditions and the value that counts, as {"fluid": "water"}.

    Errors:
        InputError: No such folder, an unknown condition or value, several fluids or soles left.
        DataError: No COF or speed, fewer than two speeds.
    """
    from underfoot.trials.readers.sheet import read_sheet

    path = folder / "tables" / "files.csv"
    if not path.is_file():
        raise InputError(
            f"{folder} is no folder of analysed trials",
            where="FOLDER",
            allowed="a folder with tables/files.csv",
            remedy="Make one with: underfoot trials analyse TRIALS --protocol report_g2 "
            f"--out {folder}",
        )
    sheet = read_sheet(path)
    numbers = {name.casefold(): name for name in sheet.numbers}
    missing = [name for name in ("cof", "speed") if name not in numbers]
    if missing:
        raise DataError(
            f"the trials have no {' and no '.join(missing)}",
            where=str(path),
            remedy="A law of speed needs pin-on-disk runs at two or more speeds",
        )
    cof, speed = sheet.numbers[numbers["cof"]], sheet.numbers[numbers["speed"]]
    kept = np.isfinite(cof) & np.isfinite(speed) & (speed > 0)
    texts = {name: np.array(values) for name, values in sheet.texts.items()}
    refused = texts["verdict"] == "refused" if "verdict" in texts else np.zeros(cof.size, bool)
    conditions = {name: column for name, column in texts.items() if name not in _NOT_CONDITIONS}
    for name, value in (chosen or {}).items():
        kept &= _rows(conditions, name, value)
    for name in _ONE_OF:
        column = conditions.get(name)
        values = [] if column is None else sorted({str(one) for one in column[kept]})
        if len(values) > 1:
            raise InputError(
                f"the trials hold {len(values)} values of {name}: {', '.join(values[:8])}",
                where="--where",
                remedy=f"Choose one law at a time: --where {name}={values[0]}",
            )
    left_out = int(np.count_nonzero(kept & refused))
    kept &= ~refused
    if np.unique(speed[kept]).size < 2:
        raise DataError(
            f"{np.count_nonzero(kept)} usable readings at {np.unique(speed[kept]).size} speeds",
            where=str(path),
            allowed="two or more speeds",
        )
    thick = sheet.numbers.get("viscosity")
    known = [] if thick is None else sorted(set(thick[kept][np.isfinite(thick[kept])].tolist()))
    words = ", ".join(f"{name} = {value}" for name, value in (chosen or {}).items())
    origin = f"trials analysed in {folder.name}" + (f", {words}" if words else "")
    return TrialReadings(
        speed[kept], cof[kept], known[0] if len(known) == 1 else None, left_out, origin
    )


def _rows(conditions: Mapping[str, NDArray], name: str, value: str) -> NDArray[np.bool_]:
    if name not in conditions:
        raise InputError(
            Message('the trials have no condition "{name}"', name=name),
            where="--where",
            allowed=", ".join(conditions) or "none: leave --where out",
            nearest=nearest_match(name, conditions),
        )
    found = conditions[name] == value
    if not found.any():
        known = sorted({str(one) for one in conditions[name]})
        raise InputError(
            Message('no trial has {name} = "{value}"', name=name, value=value),
            where="--where",
            allowed=first_names(known),
            nearest=nearest_match(value, known),
        )
    return found


def law_table(readings: TrialReadings, *, form: str = "fit") -> LawTable:
    """Return COF over speed from readings, as a law's table.

    "fit": Eq. 17 by least squares at speeds within those read; its standard deviation joins that of
    the fitted numbers (linearised, with their covariance) and the residual one, so that a new
    reading falls within. "readings": means at each speed read, with the scatter of its repeats
    (below ``ENOUGH`` of them, that of all speeds pooled).

    Errors:
        DataError: "fit" where COF does not fall with speed, by the report's rule (R^2 below 0.5) or
            because it rises, or where there are too few speeds; "readings" without any repeat.
    """
    from underfoot.core import unknown_name
    from underfoot.trials.machines.stribeck_fit import stribeck_fit

    if form not in FORMS:
        raise unknown_name("form", form, FORMS, where="--form")
    speed, cof = readings.speed, readings.cof
    notes: list[Message] = []
    if readings.left_out:
        notes.append(Message("{count} refused files left out", count=readings.left_out))
    if form == "readings":
        return _means(readings, notes)
    fit = stribeck_fit(speed, cof)
    if fit.verdict == "mean" or fit.raw[0] <= fit.raw[2]:
        raise DataError(
            f"COF does not fall with speed as Eq. 17 (R^2 {fit.r_squared:.2f})",
            where="--form fit",
            remedy="Use --form readings",
        )
    boundary, tau, left = fit.raw
    places = np.geomspace(float(speed.min()), float(speed.max()), POINTS)
    residual = fit.residual_sum / max(fit.n - 3, 1)

    def slopes(at: Array) -> Array:
        decay = np.exp(-at / tau)
        return np.stack([decay, (boundary - left) * decay * at / tau**2, 1 - decay], axis=1)

    normal = slopes(speed)
    covariance = residual * np.linalg.pinv(normal.T @ normal)
    own = np.einsum("ij,jk,ik->i", slopes(places), covariance, slopes(places))
    parts = fit.boundary, fit.tau, fit.asymptote
    notes += [
        Message(
            "Eq. 17: COF_BL {boundary:.4g}, tau_hydro {tau:.4g} m/s, COF_asymptote {left:.4g}, "
            "R^2 {r_squared:.3f}, {count} readings",
            boundary=boundary, tau=tau, left=left, r_squared=fit.r_squared, count=fit.n,
        ),
        *(Remark.of(part.name, part.remark) for part in parts if part.remark),
    ]  # fmt: skip
    return LawTable(
        places,
        np.maximum(fit.curve(places), 0.0),
        np.sqrt(np.maximum(own, 0.0) + residual),
        readings.viscosity,
        f"{readings.origin}; fit of Eq. 17",
        tuple(notes),
    )


def _means(readings: TrialReadings, notes: list[Message]) -> LawTable:
    places, group = np.unique(readings.speed, return_inverse=True)
    counts = np.bincount(group)
    mean = np.bincount(group, readings.cof) / counts
    squares = np.bincount(group, (readings.cof - mean[group]) ** 2)
    freedom = int(np.sum(counts - 1))
    if freedom == 0:
        raise DataError(
            "every speed was read once: there is no scatter to tell an uncertainty from",
            where="--form readings",
            remedy="Repeat runs, or use --form fit",
        )
    pooled = float(squares.sum()) / freedom
    own = np.where(counts >= ENOUGH, squares / np.maximum(counts - 1, 1), pooled)
    count = {"count": readings.cof.size, "speeds": places.size}
    notes = [*notes, Message("means of {count} readings at {speeds} speeds", **count)]
    return LawTable(
        places, mean, np.sqrt(own), readings.viscosity, f"{readings.origin}; means", tuple(notes)
    )


def law_file_text(table: LawTable, *, pressure: float | None = None) -> str:
    """Return the file that ``friction.table_file`` of a case reads (SI, source and notes)."""
    columns = ["speed (m/s)", "cof", "sd"]
    fixed = []
    for heading, value in (("pressure (Pa)", pressure), ("viscosity (Pa s)", table.viscosity)):
        if value is not None:
            columns.append(heading)
            fixed.append(f"{value:.6g}")
    lines = [f"# source: {table.source}", *(f"# {note}" for note in table.notes)]
    lines.append(",".join(columns))
    for speed, cof, deviation in zip(table.speed, table.cof, table.deviation, strict=True):
        lines.append(",".join([f"{speed:.6g}", f"{cof:.6g}", f"{deviation:.4g}", *fixed]))
    return "\n".join(lines) + "\n"
