"""Two results side by side: what differs in the cases, what differs in the numbers."""

from __future__ import annotations

from dataclasses import dataclass
from math import erf, hypot, sqrt
from typing import TYPE_CHECKING

from .sentences import summary_rows

if TYPE_CHECKING:
    from underfoot.case.result import Result


@dataclass(frozen=True, slots=True)
class ComparedRow:
    """One quantity of two results."""

    label: str
    first: str
    second: str


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two results side by side with a sentence on which grips better."""

    verdict: str
    rows: tuple[ComparedRow, ...]


def comparison(first: Result, second: Result) -> Comparison:
    """Return the summary tables side by side and how sure the order of the two COFs is.

    The chance that the second grips better is Phi(d / s) with d the difference of the COFs and
    s = sqrt(s1^2 + s2^2); errors common to both (the same floor, the same closures) cancel in
    part, so s is an upper bound for alike cases.
    """
    left = {row.label: row.value for row in summary_rows(first)}
    right = {row.label: row.value for row in summary_rows(second)}
    labels = [*left, *(label for label in right if label not in left)]
    rows = tuple(
        ComparedRow(label, left.get(label, "-"), right.get(label, "-")) for label in labels
    )
    return Comparison(_order(first, second), rows)


def _order(first: Result, second: Result) -> str:
    for result in (first, second):
        if not result.status.usable:
            return f"No comparison: {result.name} is {result.status}. {result.status.remedy}"
    if first.provenance.case_hash == second.provenance.case_hash:
        return "Both are the same case; what differs is the grid."
    a, b = first.scalars["cof"], second.scalars["cof"]
    difference = second.value("cof") - first.value("cof")
    better = second.name if difference > 0 else first.name
    text = f"{better} grips better by {abs(difference):.3f} in COF"
    if a.uncertainty is None or b.uncertainty is None:
        return text + "; how sure that is was not estimated."
    spread = hypot(a.uncertainty, b.uncertainty)
    if spread == 0.0:
        return text + "."
    chance = 0.5 * (1.0 + erf(abs(difference) / spread / sqrt(2.0)))
    shown = "above 99 %" if chance > 0.99 else f"{100.0 * chance:.0f} %"
    return text + f" (chance that the order is right, by the friction law's spread: {shown})."
