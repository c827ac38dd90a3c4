"""Results side by side: which has the highest friction, how sure the order is, what differs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case import Case
from underfoot.compute import summary
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.core import InputError, Progress, SourcedValue, nearest_match, silent
from underfoot.core.presentation import Presentable, Table, drawn_probability_text, value_text
from underfoot.core.progress import part
from underfoot.friction.propagation import probability_higher
from underfoot.friction.tread_error import READING

if TYPE_CHECKING:
    from underfoot.core.catalogue import Catalogue

LETTERS = "ABCDEFGHIJKL"
DECIDED = 0.75
"""Least probability at which an order is stated."""
REPEATS = math.sqrt(2) * READING
"""Standard deviation of ln of the ratio of two readings of one tester."""
COMPARED = {"shoe": "soles", "floor": "floors", "contaminant": "fluids", "motion": "motions"}
Z95 = 1.96
_FILE, _CHECKSUM = "shoe.outsole.file", "shoe.outsole.sha256"
LONGEST_CELL = 34
"""Characters of an input in a table; longer ones (paths, checksums) keep their end."""


@dataclass(frozen=True, slots=True)
class Rank:
    """Place of one result by COF; ``better_than_next`` is the probability of that order."""

    letter: str
    name: str
    cof: SourcedValue
    interval: tuple[float, float] | None
    better_than_next: float | None


@dataclass(frozen=True, slots=True)
class ComparedQuantity:
    """One quantity of all results.

    ``different`` has the letters of the results that differ from the first by more than 1.96
    standard deviations of the difference; None where no uncertainty is known.
    """

    name: str
    label: str
    values: tuple[SourcedValue | None, ...]
    different: tuple[str, ...] | None


@dataclass(frozen=True, slots=True)
class Comparison(Presentable):
    """Two to twelve results side by side."""

    kind: ClassVar[str] = "comparison"

    results: tuple[Result, ...]
    ranking: tuple[Rank, ...]
    quantities: tuple[ComparedQuantity, ...]
    differences: tuple[tuple[str, ...], ...]
    reasons: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<Comparison of {len(self.results)} results: {self.headline()[0]:.120}>"

    @property
    def usable(self) -> bool:
        return all(result.status.usable for result in self.results)

    def heading(self) -> str:
        return "Comparison of friction"

    def label(self, letter: str) -> str:
        """Return the name of a result, with its letter where names repeat."""
        names = [result.name for result in self.results]
        name = names[LETTERS.index(letter)]
        return name if names.count(name) == 1 else f"{letter} ({name})"

    def headline(self) -> tuple[str, ...]:
        for result in self.results:
            if not result.status.usable:
                return (f"No comparison: {result.name} is {result.status}. {result.status.remedy}",)
        if len({result.provenance.case_hash for result in self.results}) == 1:
            return ("The cases are the same; the results differ by grid or version only.",)
        first, second = self.ranking[:2]
        lead = (first.cof.value or 0.0) - (second.cof.value or 0.0)
        better, other = self.label(first.letter), self.label(second.letter)
        chance = first.better_than_next
        sure = f"probability {_chance(chance, 'not estimated')}"
        if lead == 0.0 or (chance is not None and chance < DECIDED):
            order = f"The order of {better} and {other} is not decided: COF higher by {lead:.3f}"
            return (f"{order} ({sure}).", self._telling(first.letter, second.letter))
        else:
            order = f"{better} has the higher COF than {other}, by {lead:.3f}"
            if len(self.results) > 2:
                order = f"{better} has the highest COF, {lead:.3f} above {other}"
        return (f"{order} ({sure}).", self._different())

    def _telling(self, *letters: str) -> str:
        """Return the measurement that would tell the order of two, or that none can."""
        at = [LETTERS.index(letter) for letter in letters]
        known = (self.results[k].data.get("cof_draws") for k in at)
        draws = [np.log(each.values) for each in known if each is not None]
        spread = float(np.std(draws[0] - draws[1])) if len(draws) == 2 else math.inf
        if spread < REPEATS:
            return (
                f"No reading would tell: they lie within {spread:.0%}, and readings of one tester "
                f"repeat within {READING:.0%}. Take them as equal."
            )
        apart = {
            row[0].split(".")[0] for row in self.differences if row[1 + at[0]] != row[1 + at[1]]
        }
        both = next((subject for part, subject in COMPARED.items() if part in apart), "cases")
        return f"One measurement would tell: COF of both {both} on one tester, all else alike."

    def cautions(self) -> tuple[str, ...]:
        return self.reasons

    def table(self) -> Table:
        rows = []
        for quantity in self.quantities:
            texts = ["" if v is None else value_text(quantity.name, v) for v in quantity.values]
            remark = ""
            if quantity.different is not None:
                named = ", ".join(quantity.different) if len(self.results) > 2 else "yes"
                remark = named if quantity.different else "no"
            rows.append((quantity.label, *texts, remark))
        return Table("Results", ("Quantity", *self.letters, "Differs from A"), rows)

    def tables(self) -> tuple[Table, ...]:
        ranking = Table(
            "Ranking by COF",
            ("", "Case", "COF", "95 % interval", "Higher than the next"),
            [
                (
                    rank.letter,
                    rank.name,
                    value_text("cof", rank.cof),
                    "{:.3f} to {:.3f}".format(*rank.interval) if rank.interval else "",
                    _chance(rank.better_than_next, ""),
                )
                for rank in self.ranking
            ],
        )
        rows = [tuple(map(_shortened, row)) for row in _with_short_names(self.differences)]
        inputs = Table("Inputs that differ", ("Input", *self.letters), rows)
        return (*((ranking,) if self.ranking else ()), self.table(), inputs)

    @property
    def letters(self) -> str:
        """Return A, B, ... for the results."""
        return LETTERS[: len(self.results)]

    def to_dict(self) -> dict[str, Any]:
        return {
            "ranking": [
                {"letter": rank.letter, "name": rank.name, "cof": rank.cof.to_dict()}
                | {"interval_95": rank.interval, "higher_than_next": rank.better_than_next}
                for rank in self.ranking
            ],
            "quantities": [
                {
                    "name": quantity.name,
                    "values": [None if v is None else v.to_dict() for v in quantity.values],
                    "different_from_first": quantity.different,
                }
                for quantity in self.quantities
            ],
            "differences": [
                {"path": path, "values": list(values)} for path, *values in self.differences
            ],
            "results": [result.to_dict() for result in self.results],
        }

    def data_tables(self) -> dict[str, Table]:
        quantities = [
            (q.name, next((v.unit for v in q.values if v), ""), *(v and v.value for v in q.values))
            for q in self.quantities
        ]
        return {
            "quantities": Table("", ("quantity", "unit", *self.letters), quantities),
            "differences": Table("", ("path", *self.letters), self.differences),
        }

    def _different(self) -> str:
        labels, parent = [], ""
        for quantity in self.quantities:
            label = quantity.label.strip()
            if not quantity.label.startswith(" "):
                parent = label
            if quantity.different:
                labels.append((label if label == parent else f"{parent} {label}").lower())
        if not labels:
            return "No quantity differs beyond its 95 % interval."
        return f"Beyond the 95 % intervals differ: {'; '.join(labels).replace('cof', 'COF')}."


def compare(
    *items: Result | Case,
    quick: bool = False,
    catalogue: Catalogue | None = None,
    progress: Progress = silent,
) -> Comparison:
    """Return results side by side, ranked by COF; cases are computed first.

    Parameters:
        *items: Two to twelve results or cases.
        quick: Compute cases on the coarse grid.
        catalogue: Where the stored cases of results find their entries; the built-in one by
            default.
        progress: Receives stage, fraction and residual.

    The probability that one COF is higher than another is the share of the joint draws in which it
    is: what two cases have in common (laboratory, compound, floor, law) is drawn once for both and
    cancels; the errors of film and tread do as far as both treads are alike. Results without draws,
    or of different laws or seeds, count as independent: Phi(d / s), d their difference and
    s = sqrt(s1^2 + s2^2).

    Raises:
        InputError: Fewer than two or more than twelve items.
    """
    _check_count(len(items))
    results = tuple(
        item
        if isinstance(item, Result)
        else run(item, quick=quick, progress=part(progress, k / len(items), (k + 1) / len(items)))
        for k, item in enumerate(items)
    )
    cases = [
        Case.from_text(item.case_text, catalogue=catalogue) if isinstance(item, Result) else item
        for item in items
    ]
    return Comparison(
        results,
        _ranking(results),
        _quantities(results),
        tuple(case_differences(cases)),
        _reasons(results),
    )


def check_paths(paths: Sequence[Path]) -> None:
    """Refuse what is no result folder and no case file, before anything is computed."""
    _check_count(len(paths))
    for path in paths:
        if path.is_dir() and not (path / "result.json").is_file():
            raise InputError(
                f"the folder {path} holds no result (there is no result.json in it)",
                where="compare",
                allowed="folders that underfoot run made, or case files",
            )
        if not path.exists():
            beside = path.parent.iterdir() if path.parent.is_dir() else ()
            near = nearest_match(path.name, [entry.name for entry in beside])
            raise InputError(
                f"there is no result folder or case file {path}",
                where="compare",
                nearest=None if near is None else str(path.parent / near),
                remedy="Give folders that underfoot run made, or case files",
            )


def case_differences(cases: Sequence[Case]) -> list[tuple[str, ...]]:
    """Return (path, value in each case) of the inputs in which the cases are not all alike."""
    tables = [{path: value for path, value, _ in case.rows()} for case in cases]
    paths = dict.fromkeys(path for table in tables for path in table)
    rows = [(path, *(table.get(path, "-") for table in tables)) for path in paths]
    return [row for row in rows if len(set(row[1:])) > 1]


def _check_count(count: int) -> None:
    if not 2 <= count <= len(LETTERS):
        raise InputError(
            f"{count} result{'' if count == 1 else 's'} to compare",
            where="compare",
            allowed=f"2 to {len(LETTERS)}",
        )


def _ranking(results: Sequence[Result]) -> tuple[Rank, ...]:
    if not all(result.status.usable for result in results):
        return ()
    order = sorted(zip(LETTERS, results, strict=False), key=lambda one: -one[1].value("cof"))
    ranks = []
    for place, (letter, result) in enumerate(order, start=1):
        cof = result.scalars["cof"]
        chance = chance_higher(result, order[place][1]) if place < len(order) else None
        ranks.append(Rank(letter, result.name, cof, _interval(cof), chance))
    return tuple(ranks)


def chance_higher(first: Result, second: Result) -> float | None:
    """Return the probability that the first COF is higher, from shared draws where there are."""
    laws = {result.provenance.closures.get("friction") for result in (first, second)}
    both = []
    for result in (first, second):
        cof, draws = result.scalars["cof"], result.data.get("cof_draws")
        if cof.value is None:
            return None
        both.append((cof.value, cof.uncertainty, None if draws is None else draws.values))
    return probability_higher(*both, shared=laws == {"pair"})


def _interval(scalar: SourcedValue) -> tuple[float, float] | None:
    if scalar.interval is not None:
        return scalar.interval
    if scalar.value is None or scalar.uncertainty is None:
        return None
    half = Z95 * scalar.uncertainty
    return max(scalar.value - half, 0.0), scalar.value + half


def _quantities(results: Sequence[Result]) -> tuple[ComparedQuantity, ...]:
    rows = []
    for name, (label, _) in summary.QUANTITIES.items():
        values = tuple(result.scalars.get(name) for result in results)
        if any(value is not None for value in values):
            rows.append(ComparedQuantity(name, label, values, _different_from_first(values)))
    return tuple(rows)


def _different_from_first(values: Sequence[SourcedValue | None]) -> tuple[str, ...] | None:
    first = values[0]
    if first is None or first.value is None or first.uncertainty is None:
        return None
    differs = {
        letter: abs(other.value - first.value)
        > Z95 * math.hypot(first.uncertainty, other.uncertainty)
        for letter, other in zip(LETTERS[1:], values[1:], strict=False)
        if other is not None and other.value is not None and other.uncertainty is not None
    }
    return tuple(letter for letter in differs if differs[letter]) if differs else None


def _reasons(results: Sequence[Result]) -> tuple[str, ...]:
    reasons = []
    sides = [float(np.median(np.diff(result.data["x"].values))) for result in results]
    if max(sides) > 1.01 * min(sides):
        grids = ", ".join(
            f"{letter} {side * 1e3:.3g} mm" for letter, side in zip(LETTERS, sides, strict=False)
        )
        reasons.append(
            f"The grids differ ({grids}): part of the difference may be discretisation error. "
            "Compute all with --quick or all without."
        )
    versions = {result.provenance.versions.get("underfoot", "") for result in results}
    if len(versions) > 1:
        reasons.append(f"Computed with different versions: {', '.join(sorted(versions))}.")
    for letter, result in zip(LETTERS, results, strict=False):
        if result.status.usable and result.breaches:
            models = dict.fromkeys(line.partition(":")[0] for line in result.breaches)
            reasons.append(f"{letter}: {summary.beyond_tests(models)}")
    return tuple(reasons)


def _chance(probability: float | None, unknown: str) -> str:
    if probability is None:
        return unknown
    return drawn_probability_text(probability)


def _with_short_names(rows: Sequence[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Return rows with files by their names; a checksum only where the names do not tell.

    Result files keep both in full.
    """
    files = next((row[1:] for row in rows if row[0] == _FILE), ())
    names = [Path(file).name for file in files]
    told = bool(files) and len(set(names)) == len(set(files))
    short: list[tuple[str, ...]] = []
    for path, *values in rows:
        if path == _FILE and told:
            short.append((path, *names))
        elif path != _CHECKSUM or not told:
            short.append((path, *(v[:8] if path == _CHECKSUM else v for v in values)))
    return short


def _shortened(text: str) -> str:
    return text if len(text) <= LONGEST_CELL else f"…{text[1 - LONGEST_CELL :]}"
