"""The one place where a computed quantity is judged against a printed statement.

The rules are the same for every study; no study holds a threshold of its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from pydantic import TypeAdapter

from underfoot.core import InputError, unknown_name

from .statements import Claim, Statement, StatementKind

MORE_LIKELY_THAN_NOT = 0.5
LEAST_OVERLAP = 0.2
"""Probability of agreement below which an interval that reaches the printed value tells nothing."""
GRID_SHARE = 1.0 / 3.0
"""Part of the tolerance that the last refinement of the grid may move a value by."""
QUANTILES = np.linspace(0.0, 1.0, 401)


class Verdict(StrEnum):
    """How our quantity stands against the printed one."""

    AGREES = "agrees"
    OVERLAPS = "overlaps"
    TREND_ONLY = "trend only"
    UNDECIDED = "undecided"
    DISAGREES = "disagrees"
    NOT_CONVERGED = "not converged"
    NOT_COMPARABLE = "not comparable"

    @property
    def step(self) -> int | None:
        """Return its place from agreement (0) to disagreement (3); None: no judgement."""
        steps = {
            Verdict.AGREES: 0,
            Verdict.OVERLAPS: 1,
            Verdict.TREND_ONLY: 1,
            Verdict.UNDECIDED: 2,
            Verdict.NOT_CONVERGED: 2,
            Verdict.DISAGREES: 3,
        }
        return steps.get(self)

    @property
    def rule(self) -> str:
        """Return what the verdict means."""
        return {
            Verdict.AGREES: "every computed value lies within the tolerance of the printed one, "
            "and is more likely inside than outside where a probability is known",
            Verdict.OVERLAPS: "the computed 95 % interval (or the values over the conditions) "
            "reaches into the tolerance of the printed one, with a probability of 0.2 or more. It "
            "is no wider than half the scale (100 points of a share; twice the printed value)",
            Verdict.TREND_ONLY: "a change of the printed sign in every condition, of another size",
            Verdict.UNDECIDED: "the computed interval reaches into the tolerance, but is too wide "
            "or too improbable there to say that they agree",
            Verdict.DISAGREES: "none of these",
            Verdict.NOT_CONVERGED: "no two grids whose values differ by less than a third of the "
            "tolerance, no steady approach to extrapolate, and no known error of a quick grid",
            Verdict.NOT_COMPARABLE: "no number is printed, or the model has no such quantity",
        }[self]


@dataclass(frozen=True, slots=True)
class ComputedQuantity:
    """A computed quantity, SI.

    Parameters:
        values: One number, or one for each condition that the printed range runs over.
        unit: SI unit.
        quantiles: Of its distribution at ``QUANTILES``; empty where none is known.
        levels: (spacing in m, values) of the same numbers on grids from coarse to fine.
        on_grid: True for a solver's number: without two grids it can't be judged.
        names, chance: Of the values, for an order, and the probability of the printed order where
            it is known.
        missing: Why there is no number; ``unconverged`` where the solver did not end.
    """

    values: tuple[float, ...]
    unit: str
    quantiles: tuple[float, ...] = ()
    levels: tuple[tuple[float, tuple[float, ...]], ...] = ()
    on_grid: bool = False
    names: tuple[str, ...] = ()
    chance: float | None = None
    missing: str = ""
    unconverged: bool = False

    @classmethod
    def of(
        cls,
        values: float | Sequence[float] | np.ndarray,
        unit: str = "1",
        *,
        deviation: float | None = None,
        scale: Literal["linear", "log", "logit"] = "linear",
        draws: ArrayLike | None = None,
        levels: Sequence[tuple[float, ArrayLike]] | None = None,
        names: Sequence[str] = (),
        chance: float | None = None,
    ) -> ComputedQuantity:
        """Return a quantity; a ``deviation`` stands for a normal distribution, ``draws`` for any.

        On the "log" ``scale`` of a positive quantity and the "logit" one of a share it is that of
        the value itself, to first order; the interval then stays above 0, or within 0 and 1.
        ``levels`` (also empty) mark a number that a grid enters. Values that are not finite make
        the quantity missing, not converged.
        """
        numbers = tuple(float(v) for v in np.atleast_1d(np.asarray(values, dtype=float)))
        if not numbers or not np.isfinite(numbers).all():
            return cls((), unit, missing="the solver gave no result", unconverged=True)
        quantiles: tuple[float, ...] = ()
        if draws is not None:
            finite = np.asarray(draws, dtype=float)
            finite = finite[np.isfinite(finite)]
            if finite.size:
                quantiles = tuple(float(q) for q in np.quantile(finite, QUANTILES))
        elif deviation is not None and deviation > 0.0:
            from scipy.stats import norm

            places = np.clip(QUANTILES, 1e-4, 1.0 - 1e-4)
            quantiles = tuple(
                map(float, _step_on_scale(numbers[0], deviation * norm.ppf(places), scale))
            )
        grids = tuple(
            (float(h), tuple(np.atleast_1d(np.asarray(v, float)).tolist())) for h, v in levels or ()
        )
        return cls(numbers, unit, quantiles, grids, levels is not None, tuple(names), chance)

    @classmethod
    def none(cls, reason: str, unit: str = "1") -> ComputedQuantity:
        """Return a quantity that the model does not have, with the reason."""
        return cls((), unit, missing=reason)

    @property
    def interval(self) -> tuple[float, float]:
        """Central 95 %, joined with the values over the conditions."""
        ends = list(self.values)
        if self.quantiles:
            ends += np.interp([0.025, 0.975], QUANTILES, self.quantiles).tolist()
        return (min(ends), max(ends)) if ends else (math.nan, math.nan)

    def probability(self, low: float, high: float) -> float | None:
        """Return the probability that it lies from ``low`` to ``high``; None where not known.

        Of values over several conditions without a distribution: their share that lies there.
        """
        if not self.quantiles:
            inside = [low <= value <= high for value in self.values]
            return sum(inside) / len(inside) if len(inside) > 1 else None
        below = np.interp([low, high], self.quantiles, QUANTILES, left=0.0, right=1.0)
        return float(below[1] - below[0])

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> ComputedQuantity:
        """Return the quantity that ``to_dict`` wrote."""
        return TypeAdapter(cls).validate_python(content)


def _step_on_scale(value: float, step: np.ndarray, scale: str) -> np.ndarray:
    """Return the value with a step of its own unit, taken on a scale that has no bound."""
    if scale == "log" and value > 0.0:
        return value * np.exp(step / value)
    if scale == "logit" and 0.0 < value < 1.0:
        odds = math.log(value / (1.0 - value)) + step / (value * (1.0 - value))
        return 1.0 / (1.0 + np.exp(-odds))
    return value + step


@dataclass(frozen=True, slots=True)
class Judgement:
    """A statement with its verdict; texts in the printed unit."""

    statement: Statement
    verdict: Verdict
    ours: str
    difference: str
    probability: float | None
    reason: str

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON and CSV."""
        s = self.statement
        return {
            "statement": s.name,
            "text": s.text,
            "place": s.place,
            "kind": str(s.kind),
            "of": s.of,
            "printed": s.printed,
            "tolerance": s.tolerance_reason,
            "ours": self.ours,
            "difference": self.difference,
            "verdict": str(self.verdict),
            "probability": self.probability,
            "reason": self.reason,
        }


@dataclass(frozen=True, slots=True)
class GridValue:
    """A value freed of its grid: ``error`` of an extrapolation, ``note`` on how it was taken."""

    value: float
    error: float = 0.0
    converged: bool = True
    note: str = ""


def grid_value(levels: Sequence[tuple[float, float]], tolerance: float) -> GridValue:
    """Return the value of the finest grid, or its extrapolation, or that it did not converge.

    Converged where the last refinement moved it by less than a third of the ``tolerance``.
    Elsewhere the first-order Richardson value with the distance to the finest grid as its error,
    where three grids approach it from one side in shrinking steps, and it is less than half of the
    finest grid's value away: further off a straight line is no correction.
    """
    if len(levels) < 2:
        return GridValue(levels[-1][1] if levels else math.nan, 0.0, False, "one grid only")
    (coarse, before), (fine, last) = levels[-2:]
    step = last - before
    if abs(step) < GRID_SHARE * tolerance:
        return GridValue(last)
    if len(levels) > 2:
        earlier = before - levels[-3][1]
        if step * earlier > 0.0 and abs(step) < abs(earlier):
            error = abs(step) / (coarse / fine - 1.0)
            value = last + math.copysign(error, step)
            if error < abs(last) / 2:
                return GridValue(value, error, True, "Richardson value of three grids")
    return GridValue(last, 0.0, False, f"the last refinement moved it by {step:+.3g}")


def judge(statement: Statement, quantities: Mapping[str, ComputedQuantity]) -> Judgement:
    """Return the verdict on one statement.

    Raises:
        InputError: A quantity that the study does not compute, or one of another unit.
    """
    if statement.not_comparable:
        return _judgement(statement, Verdict.NOT_COMPARABLE, statement.not_comparable)
    if statement.quantity not in quantities:
        raise unknown_name("quantity", statement.quantity, quantities, where=statement.name)
    quantity = quantities[statement.quantity]
    if quantity.missing:
        verdict = Verdict.NOT_CONVERGED if quantity.unconverged else Verdict.NOT_COMPARABLE
        return _judgement(statement, verdict, quantity.missing)
    if quantity.unit != statement.si_unit:
        raise InputError(quantity.unit, where=statement.name, allowed=statement.si_unit)
    if statement.claim is Claim.ORDER:
        return _judged_order(statement, quantity)
    low, high = statement.accepted
    values, error, note = list(quantity.values), 0.0, ""
    if quantity.on_grid and len(quantity.levels) == 1 and statement.quick_error:
        error = max(map(statement.quick_error_of, values))
        size = f"{number_text(error, statement)} {statement.unit}".strip()
        note = f"one coarse grid, whose error is taken as {size}"
    elif quantity.on_grid:
        on_grids = [
            grid_value(
                [(spacing, level[i]) for spacing, level in quantity.levels],
                # half the accepted interval's width, or the distance to its one edge
                0.5 * (high - low)
                if math.isfinite(high - low)
                else abs(value - (low if math.isfinite(low) else high)),
            )
            for i, value in enumerate(values)
        ]
        note = next((grid.note for grid in on_grids if not grid.converged), "")
        if note:
            return _judgement(statement, Verdict.NOT_CONVERGED, note, quantity)
        values, error = [grid.value for grid in on_grids], max(grid.error for grid in on_grids)
        note = next((grid.note for grid in on_grids if grid.note), "")
    chance = quantity.probability(low, high)
    ours_low, ours_high = quantity.interval
    ours_low, ours_high = min(ours_low, *values) - error, max(ours_high, *values) + error
    if (
        min(values) - error >= low
        and max(values) + error <= high
        and (chance is None or chance >= MORE_LIKELY_THAN_NOT)
    ):
        verdict = Verdict.AGREES
    elif ours_low <= high and ours_high >= low:
        likely = chance is None or chance >= LEAST_OVERLAP
        narrow = ours_high - ours_low - 2.0 * error <= statement.half_scale
        verdict = Verdict.OVERLAPS if likely and narrow else Verdict.UNDECIDED
    elif statement.effect and min(statement.effect * v for v in values) > statement.tolerance:
        verdict = Verdict.TREND_ONLY
    else:
        verdict = Verdict.DISAGREES
    return _judgement(statement, verdict, note, quantity, values, chance)


def _judged_order(statement: Statement, quantity: ComputedQuantity) -> Judgement:
    """Return the verdict on an order: the sign of each step from one name to the next."""
    by_name = dict(zip(quantity.names, quantity.values, strict=True))
    steps = [by_name[a] - by_name[b] for a, b in pairwise(statement.names)]
    chance = quantity.chance
    holds = all(step > statement.tolerance for step in steps)
    if holds and (chance is None or chance >= MORE_LIKELY_THAN_NOT):
        verdict = Verdict.AGREES
    elif chance is not None and chance >= LEAST_OVERLAP:
        verdict = Verdict.OVERLAPS
    elif chance is not None and chance > 0.025:
        verdict = Verdict.UNDECIDED
    else:
        verdict = Verdict.DISAGREES
    ordered = sorted(by_name, key=lambda name: -by_name[name])
    ours = " > ".join(f"{name} {by_name[name]:.3g}" for name in ordered)
    return _judgement(statement, verdict, "", chance=chance, ours=ours)


def judge_study(
    statements: Iterable[Statement], quantities: Mapping[str, ComputedQuantity]
) -> list[Judgement]:
    """Return the verdicts of a study."""
    return [judge(statement, quantities) for statement in statements]


def counts(judgements: Iterable[Judgement]) -> dict[Verdict, int]:
    """Return how many *independent* statements got each verdict; no other kind is counted."""
    number = dict.fromkeys(Verdict, 0)
    for judgement in judgements:
        if judgement.statement.kind is StatementKind.INDEPENDENT:
            number[judgement.verdict] += 1
    return number


def tables_by_kind(judgements: Sequence[Judgement]) -> list[tuple[StatementKind, list[Judgement]]]:
    """Return the statements of each kind that there is, independent ones first."""
    groups = [(kind, [j for j in judgements if j.statement.kind is kind]) for kind in StatementKind]
    return [(kind, some) for kind, some in groups if some]


def _judgement(
    statement: Statement,
    verdict: Verdict,
    note: str,
    quantity: ComputedQuantity | None = None,
    values: Sequence[float] = (),
    chance: float | None = None,
    ours: str = "",
) -> Judgement:
    difference = ""
    if quantity is not None:
        shown = list(values or quantity.values)
        interval = quantity.interval if quantity.quantiles else None
        ours = values_text(shown, statement, interval)
        low, high = statement.accepted
        beyond = [v - (low if v < low else high) for v in shown if not low <= v <= high]
        if beyond and verdict is not Verdict.NOT_CONVERGED:
            farthest = max(beyond, key=abs) / statement.factor
            unit = "points" if statement.unit == "%" else statement.unit
            difference = f"{farthest:+.2g} {unit}".strip()
    likely = ""
    if chance is not None:
        text = "above 0.99" if chance > 0.995 else "below 0.01" if chance < 0.005 else ""
        likely = f"probability of agreement {text or f'{chance:.2f}'}"
    reason = "; ".join(filter(None, (note, likely, statement.remark)))
    return Judgement(statement, verdict, ours or "-", difference, chance, reason)


def values_text(
    values: Sequence[float], statement: Statement, interval: tuple[float, float] | None = None
) -> str:
    """Return values and their 95 % interval in the statement's printed unit."""

    def number(value: float) -> str:
        return number_text(value, statement, signed=True)

    low, high = number(min(values)), number(max(values))
    text = low if low == high else f"{low} to {high}"
    if interval is not None:
        text += f" ({number(interval[0])} to {number(interval[1])})"
    return f"{text} {statement.unit}".strip()


def number_text(value: float, statement: Statement, *, signed: bool = False) -> str:
    """Return a number in the statement's printed unit, without it."""
    change = statement.effect or statement.claim in (Claim.RISES, Claim.FALLS)
    sign = "+" if signed and change else ""
    scaled = value / statement.factor
    digits = ".0f" if statement.unit == "%" or abs(scaled) >= 100 else ".3g"
    text = f"{scaled:{sign}{digits}}"
    return "0" if text in ("-0", "+0") else text
