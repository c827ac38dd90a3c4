"""Wear at which a load exceeds its limit, with its 90 % interval."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from underfoot.shoe.worn import WearMeasures

from .outcomes import CaseOutcome

Array = NDArray[np.float64]
LEAST = 1e-3
"""N: loads below are taken as this on the logarithmic scale."""
WIDEST = 2.5
"""Standard deviations beyond which an input is not drawn: the runs lie at one."""
SHARES = (0.05, 0.95)
MEASURES: tuple[str, ...] = ("removed_depth", "tread_left", "mean_tread_left", "worn_patch_area")


class Crossing(StrEnum):
    """Whether a load exceeds its limit as the sole wears."""

    WITHIN = "exceeded within the range"
    FROM_NEW = "exceeded from new"
    NEVER = "not exceeded within the range"
    UNKNOWN = "not determined"


@dataclass(frozen=True, slots=True)
class WearPoint:
    """One state of wear: how worn it is, its outcome, and those at the ends of open inputs.

    ``variants`` holds (path, low, high) for each open input that was varied; empty without a band.
    """

    measures: WearMeasures
    outcome: CaseOutcome
    variants: tuple[tuple[str, CaseOutcome, CaseOutcome], ...] = ()


@dataclass(frozen=True, slots=True)
class LimitCrossing:
    """Wear at which a load exceeds its limit, by each measure of wear (SI).

    ``at`` is the value by interpolation between the computed states; ``low`` and ``high`` hold
    90 % of the draws; inf (-inf for tread left) where the limit is not exceeded within the range.
    All nan where no state was computed. ``share`` is that of the draws that exceed it within the
    range.
    """

    crossing: Crossing
    share: float
    at: dict[str, float]
    low: dict[str, float]
    high: dict[str, float]


def limit_crossing(
    points: Sequence[WearPoint],
    name: str,
    limit: float,
    *,
    draws: int,
    seed: int,
    between: Sequence[WearMeasures] = (),
) -> LimitCrossing:
    """Return the wear at which a number first rises above ``limit``.

    Each draw takes the inputs' standard normal deviates, moves the logarithm of every state's load
    by what the runs at one deviation moved it (linear to either side), and reads the place of the
    limit between two states on a scale somewhere between linear and logarithmic: that uncertainty
    is the interpolation's. Inputs are independent and the same at all states of a draw.
    ``between`` holds how worn the sole is from the first state to the last in even parts: a patch
    begins only where the tread ends, so that it can't be interpolated between far states.
    """
    all_loads = np.array([point.outcome.number(name) for point in points])
    order = np.flatnonzero(~np.isnan(all_loads))
    known = [points[number] for number in order.tolist()]
    states = list(between) or [point.measures for point in points]
    parts = np.linspace(0, len(points) - 1, len(states))
    measured = {each: np.array([getattr(state, each) for state in states]) for each in MEASURES}
    if len(known) < 2:
        nothing = dict.fromkeys(MEASURES, math.nan)
        return LimitCrossing(Crossing.UNKNOWN, math.nan, nothing, dict(nothing), dict(nothing))
    centre, bound = np.log(np.maximum(all_loads[order], LEAST)), math.log(max(limit, LEAST))
    place = first_exceeding(centre[None, :], bound, np.full(1, 0.5))
    rng = np.random.default_rng(seed)
    moved = np.repeat(centre[None, :], draws, axis=0)
    for index in range(len(known[0].variants)):
        deviate = np.clip(rng.standard_normal(draws), -WIDEST, WIDEST)
        low, high = (_departure(known, index, name, end, centre) for end in (0, 1))
        moved += np.maximum(deviate, 0)[:, None] * high - np.minimum(deviate, 0)[:, None] * low
    places = first_exceeding(moved, bound, rng.uniform(size=draws))
    at, low, high = {}, {}, {}
    for each, values in measured.items():
        at[each] = float(_along(parts, values, order, place)[0])
        drawn = _along(parts, values, order, places)
        low[each], high[each] = map(float, np.quantile(drawn, SHARES, method="nearest"))
    crossing = Crossing.WITHIN
    if math.isinf(place[0]):
        crossing = Crossing.NEVER
    elif place[0] == 0.0:
        crossing = Crossing.FROM_NEW
    return LimitCrossing(crossing, float(np.isfinite(places).mean()), at, low, high)


def first_exceeding(logarithms: Array, limit: float, blend: Array) -> Array:
    """Return the place (in states, fractional) where each row first rises above ``limit``.

    ``logarithms`` (draws, states) and ``limit`` are natural logarithms; ``blend`` 0 interpolates
    the value itself, 1 its logarithm. inf where a row stays below, 0 where it starts above.
    """
    above = logarithms > limit
    first = np.argmax(above, axis=1)
    exceeded = above.any(axis=1)
    place = np.full(logarithms.shape[0], math.inf)
    place[exceeded & (first == 0)] = 0.0
    rows = np.flatnonzero(exceeded & (first > 0))
    if rows.size:
        low = logarithms[rows, first[rows] - 1]
        high = logarithms[rows, first[rows]]
        by_logarithm = (limit - low) / (high - low)
        by_value = (math.exp(limit) - np.exp(low)) / (np.exp(high) - np.exp(low))
        share = blend[rows] * by_logarithm + (1 - blend[rows]) * by_value
        place[rows] = first[rows] - 1 + share
    return place


def _departure(
    points: Sequence[WearPoint], index: int, name: str, end: int, centre: Array
) -> Array:
    """Return what one end of one input adds to the logarithm at every state; 0 where not known."""
    ends = np.array([point.variants[index][1:][end].number(name) for point in points])
    moved = np.log(np.maximum(ends, LEAST)) - centre
    return np.where(np.isnan(moved), 0.0, moved)


def _along(parts: Array, values: Array, index: NDArray[np.intp], places: Array) -> Array:
    """Return a measure at fractional places among the known states; beyond them +-inf."""
    beyond = math.inf if values[-1] >= values[0] else -math.inf
    inside = np.where(np.isfinite(places), places, 0.0)
    state = np.interp(inside, np.arange(index.size), index)
    return np.where(np.isfinite(places), np.interp(state, parts, values), beyond)
