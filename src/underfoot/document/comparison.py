"""Results side by side: which grips best, how sure that is, what differs beyond its band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import erf, hypot, sqrt
from typing import TYPE_CHECKING

from underfoot.core import SourcedValue

from .quantities import spacing
from .sentences import _ROWS, percent, summary_rows, value_text

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.case.result import Result

LETTERS = "ABCDEFGH"
_NAMES = {label: name for name, label, _ in _ROWS}
_TOLD_APART = 0.75
"""Least chance at which an order is stated."""
_BAND = 1.96
"""Half width of a 95 % band in standard deviations."""


@dataclass(frozen=True, slots=True)
class ComparedRow:
    """One quantity of all results, and whether any differs from the first beyond its band."""

    label: str
    values: tuple[str, ...]
    beyond: str


@dataclass(frozen=True, slots=True)
class Rank:
    """One result's place by COF."""

    letter: str
    name: str
    cof: str
    interval: str
    chance: str


@dataclass(frozen=True, slots=True)
class Comparison:
    """Results side by side; the first sentence says which grips best."""

    verdict: str
    cautions: tuple[str, ...]
    ranking: tuple[Rank, ...]
    rows: tuple[ComparedRow, ...]

    @property
    def beyond(self) -> str:
        """What differs beyond its band, in one sentence."""
        if not self.ranking:
            return ""
        found, parent = [], ""
        for row in self.rows:
            part = row.label.startswith("  ")
            parent = parent if part else _lower(row.label)
            if row.beyond.startswith("beyond"):
                found.append(f"{parent} {row.label.strip()}" if part else parent)
        if not found:
            return "No number differs beyond its 95 % band."
        return f"Different beyond the 95 % bands: {'; '.join(found)}."


def comparison(*results: Result) -> Comparison:
    """Return the summary tables side by side, ranked by COF, and how sure the order is.

    The chance that one grips better than another is Phi(d / s) with d the difference of the COFs
    and s = sqrt(s1^2 + s2^2); a difference is beyond its band when d > 1.96 s. Errors common to
    both (the same floor, the same closures) cancel in part, so s is an upper bound for alike
    cases.
    """
    tables = [{row.label: row.value for row in summary_rows(result)} for result in results]
    labels = list(dict.fromkeys(label for table in tables for label in table))
    rows = tuple(
        ComparedRow(
            label, tuple(table.get(label, "-") for table in tables), _beyond(label, results)
        )
        for label in labels
    )
    return Comparison(_order(results), _cautions(results), _ranking(results), rows)


def case_differences(cases: Sequence[Case]) -> list[tuple[str, ...]]:
    """Return (path, value in each case) of the values in which the cases are not all alike."""
    from underfoot.case.describe import rows

    tables = [{path: value for path, value, _ in rows(case)} for case in cases]
    paths = dict.fromkeys(path for table in tables for path in table)
    found = [(path, *(table.get(path, "-") for table in tables)) for path in paths]
    return [row for row in found if len(set(row[1:])) > 1]


def letters(results: Sequence[Result]) -> list[str]:
    """Return A, B, ... for the results."""
    return list(LETTERS[: len(results)])


def _order(results: Sequence[Result]) -> str:
    for result in results:
        if not result.status.usable:
            return f"No comparison: {result.name} is {result.status}. {result.status.remedy}"
    if len({result.provenance.case_hash for result in results}) == 1:
        return "Both are the same case; what differs is the grid or the version."
    ranked = _ranked(results)
    best, second = (results[number] for number in ranked[:2])
    lead = best.value("cof") - second.value("cof")
    chance = _chance(best.scalars["cof"], second.scalars["cof"])
    if lead == 0.0 or (chance is not None and chance < _TOLD_APART):
        sure = "" if chance is None else f" (chance that it is the better one: {_percent(chance)})"
        return (
            f"{_named(results, ranked[0])} and {_named(results, ranked[1])} can't be told apart: "
            f"the first is ahead by {lead:.3f} in COF{sure}."
        )
    if len(results) == 2:
        text = f"{_named(results, ranked[0])} grips better by {lead:.3f} in COF"
    else:
        text = (
            f"{_named(results, ranked[0])} grips best, by {lead:.3f} in COF before "
            f"{_named(results, ranked[1])}"
        )
    if chance is None:
        return text + "; how sure that is was not estimated."
    return (
        text
        + f" (chance that the order is right, by the friction law's spread: {_percent(chance)})."
    )


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]


def _named(results: Sequence[Result], number: int) -> str:
    names = [result.name for result in results]
    name = names[number]
    return name if names.count(name) == 1 else f"{LETTERS[number]} ({name})"


def _ranked(results: Sequence[Result]) -> list[int]:
    return sorted(range(len(results)), key=lambda number: -results[number].value("cof"))


def _ranking(results: Sequence[Result]) -> tuple[Rank, ...]:
    if not all(result.status.usable for result in results):
        return ()
    ranked = _ranked(results)
    made = []
    for place, number in enumerate(ranked):
        cof = results[number].scalars["cof"]
        interval = _interval(cof)
        if place + 1 == len(ranked):
            chance = ""
        else:
            other = results[ranked[place + 1]].scalars["cof"]
            share = _chance(cof, other)
            chance = "not estimated" if share is None else _percent(share)
        made.append(
            Rank(
                LETTERS[number],
                results[number].name,
                value_text("cof", cof),
                "not estimated" if interval is None else f"{interval[0]:.3f} to {interval[1]:.3f}",
                chance,
            )
        )
    return tuple(made)


def _interval(scalar: SourcedValue) -> tuple[float, float] | None:
    if scalar.interval is not None:
        return scalar.interval
    if scalar.value is None or scalar.uncertainty is None:
        return None
    half = _BAND * scalar.uncertainty
    return max(scalar.value - half, 0.0), scalar.value + half


def _chance(first: SourcedValue, second: SourcedValue) -> float | None:
    """Return the chance that the larger one is larger, 0.5 to 1; None if not estimated."""
    if first.value is None or second.value is None:
        return None
    if first.uncertainty is None or second.uncertainty is None:
        return None
    spread = hypot(first.uncertainty, second.uncertainty)
    if spread == 0.0:
        return 1.0 if first.value != second.value else 0.5
    return 0.5 * (1.0 + erf(abs(first.value - second.value) / spread / sqrt(2.0)))


def _percent(chance: float) -> str:
    return "above 99 %" if chance > 0.99 else percent(chance)


def _beyond(label: str, results: Sequence[Result]) -> str:
    name = _NAMES.get(label)
    if name is None:
        return ""
    found = [result.scalars.get(name) for result in results]
    if found[0] is None or found[0].value is None:
        return ""
    outside, known = [], False
    for number, other in enumerate(found[1:], start=1):
        if other is None or other.value is None:
            continue
        if found[0].uncertainty is None or other.uncertainty is None:
            continue
        known = True
        spread = hypot(found[0].uncertainty, other.uncertainty)
        if abs(other.value - found[0].value) > _BAND * spread:
            outside.append(LETTERS[number])
    if not known:
        return "no band estimated"
    if not outside:
        return "within the band"
    return "beyond the band" + (f": {', '.join(outside)}" if len(results) > 2 else "")


def _cautions(results: Sequence[Result]) -> tuple[str, ...]:
    found = []
    sides = [spacing(result.fields) for result in results]
    if max(sides) > 1.01 * min(sides):
        listed = ", ".join(
            f"{letter} {side * 1e3:.3g} mm"
            for letter, side in zip(letters(results), sides, strict=True)
        )
        found.append(
            f"The grids differ ({listed}): a part of the difference may be the grid's. "
            "Run all on the same grid (all with --quick or none) before deciding."
        )
    versions = {result.provenance.versions.get("underfoot", "") for result in results}
    if len(versions) > 1:
        found.append(f"Computed with different versions: {', '.join(sorted(versions))}.")
    left = [
        f"{letter} ({len(result.breaches)})"
        for letter, result in zip(letters(results), results, strict=True)
        if result.status.usable and result.breaches
    ]
    if left:
        found.append(f"Outside a tested range, with the number of remarks: {', '.join(left)}.")
    return tuple(found)
