"""Readings of a user's own tester, or a certificate, and what they teach of a pair's friction.

The draws of the law of the pair are weighted by how well each predicts the readings, each computed
as the whole case that describes it (contact and film as solved), and drawn anew by weight. The
errors of the laboratory, of each pair, and of the film and the tread of each sole become known as
far as the readings go; other pairs of the same laboratory profit too, other treads as far as they
are alike. A reading has an error of its own, as fitted between the sources, which teaches nothing.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from scipy.stats import norm

from underfoot.case import Case
from underfoot.case import text as toml
from underfoot.compute.contact_friction import (
    contact_friction,
    leak_name,
    place_of_tread,
    sole_errors,
)
from underfoot.compute.prepare import prepare_case
from underfoot.compute.resolve import resolve_context
from underfoot.compute.sole import sole_map
from underfoot.compute.solve import average_positions, solve_case
from underfoot.core import ConvergenceError, DataError, InputError, Progress, silent, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.presentation import Presentable, Table
from underfoot.core.progress import part
from underfoot.core.remark import Message
from underfoot.friction import PairContactLaw, PairDraws, packaged_pair_draws
from underfoot.friction.pair_contact import DRY_PART, LABORATORY, even_rows
from underfoot.friction.propagation import normal_draws
from underfoot.friction.sampled_cof import LEAK
from underfoot.friction.tread_error import READING

REPEATS = 20
"""Draws of the errors for each draw of the constants."""
COUNT = 1000
"""Draws that are kept."""
FEWEST = 50
"""Effective draws below which the readings are too far from the law to be weighed."""
KINDS = ("value", "lower", "upper")
KEYS = ("case", "cof", "sd", "kind")


@dataclass(frozen=True, slots=True)
class PairReading:
    """COF that was read under the conditions of a case, or a bound of it ("lower", "upper")."""

    case: Case
    cof: float
    sd: float | None = None
    kind: str = "value"

    def __str__(self) -> str:
        """Return "0.24" or "at least 0.31"."""
        return {"lower": "at least ", "upper": "at most "}.get(self.kind, "") + f"{self.cof:.3g}"

    def log_weight(self, cof: Array, error: Array) -> Array:
        """Return the logarithm of the likelihood of the reading at predicted COF (draws,).

        ``error`` (draws,) is the standard deviation of ln COF by which readings miss beyond their
        repeats, as fitted between the sources.
        """
        deviation = np.hypot(READING if self.sd is None else self.sd / self.cof, error)
        rest = (np.log(np.maximum(cof, 1e-6)) - np.log(self.cof)) / deviation
        if self.kind == "value":
            return norm.logpdf(rest) - np.log(deviation)
        return norm.logcdf(rest if self.kind == "lower" else -rest)


@dataclass(frozen=True, slots=True)
class PairCalibration(Presentable):
    """Draws of the law calibrated to readings, and what each reading's case was and is.

    ``before`` and ``after`` are (readings, 3): COF at 2.5, 50 and 97.5 %. ``errors`` names each
    error of ln COF with its standard deviation before and after. ``effective`` is the number of
    equal draws that the weighted ones are worth. ``not_begun`` names the cases that have draws of
    their own, with which the readings did not begin.
    """

    kind: ClassVar[str] = "pair_calibration"

    readings: tuple[PairReading, ...]
    draws: PairDraws
    before: Array
    after: Array
    errors: tuple[tuple[str, float, float], ...]
    effective: float
    not_begun: tuple[str, ...] = ()

    def heading(self) -> str:
        """Return the title."""
        return "Friction of a pair, calibrated to readings"

    def headline(self) -> tuple[Message, ...]:
        """Return what the readings are worth."""
        count = len(self.readings)
        names = Message("one reading")
        if count > 1:
            names = Message("{count} readings", count=count)
        before, after = (np.sqrt(rows[0, 2] / rows[0, 0]) for rows in (self.before, self.after))
        return (
            Message(
                "Law of the pair calibrated to {names}: the 95 % interval of the first went from a "
                "factor of {before:.2g} to one of {after:.2g} either way.",
                names=names, before=before, after=after,
            ),
            Message(
                "It was taken from {errors} (standard deviations of logarithms). Another tread "
                "keeps its own error.",
                errors=[
                    Message("{name} ({then:.2f} to {now:.2f})", name=name, then=then, now=now)
                    for name, then, now in self._smaller_errors()
                ],
            ),
            *self._contradictions(),
        )  # fmt: skip

    def cautions(self) -> tuple[Message, ...]:
        """Return the cases whose own draws are not those that the readings begin with."""
        return tuple(
            Message(
                "friction.draws_file of {name} is not begun with: what it says is not in the file "
                "of these readings. Give all readings of this tester at once; what a machine read "
                'of the floor stays in a case with friction.model = "pair_read".',
                name=name,
            )
            for name in self.not_begun
        )

    def _contradictions(self) -> list[Message]:
        """Return each reading that lies outside what all readings together leave."""
        return [
            Message(
                "{reading} of {case} lies outside what all readings together leave ({low:.3f} to "
                "{high:.3f}): it contradicts the others or the law, and one of smaller scatter "
                "weighs more. Check it before you use the file.",
                reading=reading, case=reading.case.name, low=low, high=high,
            )
            for reading, (low, _, high) in zip(self.readings, self.after, strict=True)
            if (reading.kind != "upper" and reading.cof > high)
            or (reading.kind != "lower" and reading.cof < low)
        ]  # fmt: skip

    def _smaller_errors(self) -> list[tuple[str, float, float]]:
        """Return the errors that the readings made smaller, the most first."""
        smaller = [error for error in self.errors if error[2] < 0.95 * error[1]]
        most = max(self.errors, key=lambda each: each[1] ** 2 - each[2] ** 2)
        return sorted(smaller or [most], key=lambda each: each[2] ** 2 - each[1] ** 2)

    def tables(self) -> tuple[Table, ...]:
        """Return the readings, and which errors they made smaller."""
        rows = [(name, f"{then:.2f}", f"{now:.2f}") for name, then, now in self.errors]
        heads = ("Error of", "sd of ln COF before", "after")
        return self.table(), Table("Where the interval comes from", heads, rows)

    def table(self) -> Table:
        """Return each reading beside the prediction before and after."""
        rows = [
            (
                reading.case.name,
                str(reading),
                *(
                    Message("{cof:.3f} ({low:.3f} to {high:.3f})", low=low, cof=cof, high=high)
                    for low, cof, high in (before, after)
                ),
            )
            for reading, before, after in zip(self.readings, self.before, self.after, strict=True)
        ]
        return Table("Readings", ("case", "measured COF", "predicted before", "after"), rows)


def read_pair_readings(path: Path) -> tuple[PairReading, ...]:
    """Return the readings in a TOML file of tables ``[[reading]]``.

    Each has ``case`` (file, from the folder of this one) and ``cof``; ``sd`` and ``kind``
    ("value", "lower", "upper") where known.

    Raises:
        InputError: No such file, no reading, an unknown key, a value that is missing or no COF.
    """
    table = toml.parse_toml(toml.read_text(path), str(path))
    entries = table.pop("reading", None)
    if table or not isinstance(entries, list) or not entries:
        raise InputError(
            f"{path.name} holds no table [[reading]]" if not table else f"unknown: {[*table]}",
            where=str(path),
            allowed="tables [[reading]] alone",
            remedy='Write [[reading]], case = "my_case.toml", cof = 0.24, sd = 0.02',
        )
    return tuple(
        _reading(
            entry, path.parent, Message("{file}, reading {number}", file=path.name, number=number)
        )
        for number, entry in enumerate(entries, start=1)
    )


def _reading(entry: Any, folder: Path, where: str) -> PairReading:
    if not isinstance(entry, dict):
        raise InputError(
            Message("{entry} is no table", entry=repr(entry)), where=where, allowed=", ".join(KEYS)
        )
    for key in entry:
        if key not in KEYS:
            raise unknown_name("key", key, KEYS, where=where)
    kind = entry.get("kind", "value")
    if kind not in KINDS:
        raise unknown_name("kind", str(kind), KINDS, where=f"{where}.kind")
    numbers: dict[str, float] = {}
    for key in ("cof", "sd"):
        value = entry.get(key)
        if value is None and key == "sd":
            continue
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < 5:
            raise InputError(f"{value!r}", where=f"{where}.{key}", allowed="above 0, below 5")
        numbers[key] = float(value)
    if not isinstance(entry.get("case"), str):
        raise InputError("is missing", where=f"{where}.case", allowed="the path of a case file")
    return PairReading(Case.load(folder / entry["case"]), kind=kind, **numbers)


def calibrated_pair(
    readings: Sequence[PairReading],
    *,
    draws: PairDraws | None = None,
    quick: bool = True,
    seed: int = 0,
    progress: Progress = silent,
) -> PairCalibration:
    """Return the law of the pair calibrated to readings of one laboratory.

    Parameters:
        readings: Each with the case that describes it; cases of one sole, floor and fluid share its
            error.
        draws: Those to begin with; the packaged ones by default.
        quick: Solve the cases on the coarse grid.
        seed: Of the draws.

    Raises:
        InputError: A case that is dry or has another law of friction; bounds of one case that
            exclude each other; readings so far from the law that fewer than 50 effective draws are
            left.
    """
    for low, high in itertools.permutations(readings, 2):
        bounds = (low.kind, high.kind) == ("lower", "upper") and low.cof > high.cof
        if bounds and low.case.hash == high.case.hash:
            raise InputError(
                f"{low} and {high} of {low.case.name} exclude each other",
                where="READINGS",
                remedy="Take out the bound that is wrong, or give each the case it was read in",
            )
    start = packaged_pair_draws() if draws is None else draws
    wide = start.rows(np.tile(np.arange(start.count), REPEATS))
    laws: list[PairContactLaw] = []
    for reading in readings:
        law = reading.case.friction.build(resolve_context(reading.case))
        if not isinstance(law, PairContactLaw):
            raise InputError(
                f'the law of {reading.case.name} is "{law.name}"',
                where="friction.model",
                allowed='"pair"',
            )
        laws.append(law)
    own = {each.case.name for each in readings if getattr(each.case.friction, "draws_file", None)}
    words = {LABORATORY: "the laboratory", DRY_PART: "its dry-like part"}
    errors = {**wide.errors}
    errors[LABORATORY] = wide.error(LABORATORY, wide.sd_laboratory, seed)
    errors[DRY_PART] = wide.error(DRY_PART, wide.sd_dry_part, seed)
    grid = "numerics.quick_grid_spacing" if quick else "numerics.grid_spacing"
    for reading, law in zip(readings, laws, strict=True):
        case, name = reading.case, law.pair.compound_and_floor
        context = resolve_context(case)
        words[name] = Message("the pair of {case}", case=case.name)
        errors[name] = wide.error(name, wide.sd_pair, seed)
        place = place_of_tread(case, sole_map(case, case.value(grid)))
        if context.leak_deviation:
            normal = normal_draws(seed, f"{LEAK} of the rough contact", wide.count)
            errors.setdefault(leak_name(context), context.leak_deviation * normal)
            words[leak_name(context)] = Message(
                "the roughness that lets fluid leak under {case}", case=case.name
            )
        for subject, error in sole_errors(case, context).items():
            name = error.name(place)
            part_of = {"subject": subject.removesuffix("_error"), "case": case.name}
            words[name] = Message("the {subject} of {case}", **part_of)
            errors[name] = error.draws(place, samples=wide.count, seed=seed, known=errors)
    wide = replace(wide, errors=errors)
    predicted = np.empty((len(readings), wide.count))
    for row, (reading, law) in enumerate(zip(readings, laws, strict=True)):
        here = part(progress, row / len(readings), (row + 1) / len(readings))
        drawn = PairContactLaw(law.pair, law.viscosity, wide)
        predicted[row] = _whole_cof(reading.case, drawn, quick, here)
    log_weight = sum(
        reading.log_weight(row, wide.sd_reading)
        for reading, row in zip(readings, predicted, strict=True)
    )
    weight = np.exp(log_weight - np.max(log_weight))
    weight /= weight.sum()
    effective = float(1 / (weight**2).sum())
    if effective < FEWEST:
        raise InputError(
            f"the readings lie so far from what the law allows that only {effective:.0f} of "
            f"{wide.count} draws agree with them",
            where="READINGS",
            remedy="Check COF, sd, and the conditions in the cases; readings that contradict each "
            'other, or a friction of their own, belong to friction.model = "table"',
        )
    generator = np.random.default_rng(seed)
    rows = generator.permutation(even_rows(weight, COUNT, generator.random()))
    names = "; ".join(f"{reading.case.name}: {reading.cof:g}" for reading in readings)
    source = f"{start.source}; calibrated to readings of one laboratory ({names})"
    levels = (0.025, 0.5, 0.975)
    pair_draws = replace(wide.rows(rows), source=source)
    spreads = {
        name: (float(np.std(errors[name])), float(np.std(pair_draws.errors[name])))
        for name in words
    }
    return PairCalibration(
        tuple(readings),
        pair_draws,
        np.quantile(predicted, levels, axis=1).T,
        np.quantile(predicted[:, rows], levels, axis=1).T,
        tuple((words[name], *each) for name, each in spreads.items() if each[0] > 0),
        effective,
        tuple(sorted(own)) if draws is None else (),
    )


def _whole_cof(case: Case, law: PairContactLaw, quick: bool, progress: Progress) -> Array:
    """Return COF (draws,) of the whole sole at each draw of the law, contact and film solved once.

    Over the positions of its tread, as ``run`` has it.
    """
    spacing = case.numerics.quick_grid_spacing if quick else case.numerics.grid_spacing
    parts = prepare_case(case, spacing, {"friction": law})
    solution = solve_case(parts, part(progress, 0.0, 0.5))
    contact = solution.contact
    if not contact.status.usable:
        raise ConvergenceError(
            f"the case {case.name} gave no result: {contact.status}", history=(), where=case.name
        )
    on = case, parts.context, parts.local_law, parts.sole, contact
    friction = contact_friction(
        *on, samples=law.draws.count, spreads=solution.spreads, stated=solution.stated
    )
    sums, sampled = friction.sums, friction.sampled
    positions = average_positions(parts, solution, quick=quick, progress=part(progress, 0.5, 1.0))
    if positions is not None:
        sums, sampled = positions.friction(sums, sampled)
    if sampled is None:
        raise DataError("the law of the pair has no spread", where=case.name)
    return sampled.cof
