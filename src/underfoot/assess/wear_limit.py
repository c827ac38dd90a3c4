"""At which wear a number passes a limit, with a band."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from underfoot.outsole.worn import WearMeasures

    from .wear import WearPoint

Array = NDArray[np.float64]
LEAST = 1e-3
"""N: loads below are taken as this on the logarithmic scale."""
WIDEST = 2.5
"""Standard deviations beyond which an input is not drawn: the runs lie at one."""
SHARES = (0.05, 0.95)
MEASURES: tuple[str, ...] = ("removed_depth", "tread_left", "mean_tread_left", "worn_patch_area")


@dataclass(frozen=True, slots=True)
class Passing:
    """Where a load passes its limit, for each measure of wear (SI).

    ``at`` is the value by interpolation between the computed states; ``low`` and ``high`` hold
    90 % of the draws; inf (-inf for tread left) where the limit is not passed within the range. All
    nan where no state was computed. ``passed`` is the share of draws that pass within the range,
    ``words`` says what ``at`` is: "passed", "passed when new" or "not passed within the range".
    """

    words: str
    passed: float
    at: dict[str, float]
    low: dict[str, float]
    high: dict[str, float]


def passing(
    points: Sequence[WearPoint],
    name: str,
    limit: float,
    *,
    draws: int,
    seed: int,
    between: Sequence[WearMeasures] = (),
) -> Passing:
    """Return where a number first rises above ``limit``.

    Each draw takes the inputs' standard normal deviates, moves the logarithm of every state's load
    by what the runs at one deviation moved it (linear to either side), and reads the place of the
    limit between two states on a scale somewhere between linear and logarithmic: that uncertainty
    is the interpolation's. Inputs are independent and the same at all states of a draw.
    ``between`` holds how worn the sole is from the first state to the last in even parts: a patch
    begins only where the tread ends, so that it can't be interpolated between far states.
    """
    known = [point for point in points if not math.isnan(point.outcome.number(name))]
    order = np.array(
        [
            number
            for number, point in enumerate(points)
            if not math.isnan(point.outcome.number(name))
        ],
        dtype=float,
    )
    states = list(between) or [point.measures for point in points]
    parts = np.linspace(0, len(points) - 1, len(states))
    measured = {each: np.array([getattr(state, each) for state in states]) for each in MEASURES}
    if len(known) < 2:
        nothing = dict.fromkeys(MEASURES, math.nan)
        return Passing("not determined", math.nan, nothing, dict(nothing), dict(nothing))
    loads = np.array([point.outcome.number(name) for point in known])
    centre = np.log(np.maximum(loads, LEAST))
    place = first_passing(centre[None, :], math.log(max(limit, LEAST)), np.full(1, 0.5))[0]
    rng = np.random.default_rng(seed)
    moved = np.repeat(centre[None, :], draws, axis=0)
    for index in range(len(known[0].variants)):
        deviate = np.clip(rng.standard_normal(draws), -WIDEST, WIDEST)
        low, high = (_departure(known, index, name, end, centre) for end in (False, True))
        moved += np.maximum(deviate, 0)[:, None] * high - np.minimum(deviate, 0)[:, None] * low
    places = first_passing(moved, math.log(max(limit, LEAST)), rng.uniform(size=draws))
    found = {each: _along(parts, values, order, places) for each, values in measured.items()}
    quantiles = {
        each: np.quantile(values, SHARES, method="nearest") for each, values in found.items()
    }
    at = {
        each: float(_along(parts, v, order, np.array([place]))[0]) for each, v in measured.items()
    }
    words = "passed"
    if math.isinf(place):
        words = "not passed within the range"
    elif place == 0.0:
        words = "passed when new"
    return Passing(
        words=words,
        passed=float(np.isfinite(places).mean()),
        at=at,
        low={each: float(pair[0]) for each, pair in quantiles.items()},
        high={each: float(pair[1]) for each, pair in quantiles.items()},
    )


def first_passing(logarithms: Array, limit: float, blend: Array) -> Array:
    """Return the place (in states, fractional) where each row first rises above ``limit``.

    ``logarithms`` (draws, states) and ``limit`` are natural logarithms; ``blend`` 0 interpolates
    the value itself, 1 its logarithm. inf where a row stays below, 0 where it starts above.
    """
    above = logarithms > limit
    first = np.argmax(above, axis=1)
    passed = above.any(axis=1)
    place = np.full(logarithms.shape[0], math.inf)
    place[passed & (first == 0)] = 0.0
    rows = np.flatnonzero(passed & (first > 0))
    if rows.size:
        low = logarithms[rows, first[rows] - 1]
        high = logarithms[rows, first[rows]]
        by_logarithm = (limit - low) / (high - low)
        by_value = (math.exp(limit) - np.exp(low)) / (np.exp(high) - np.exp(low))
        share = blend[rows] * by_logarithm + (1 - blend[rows]) * by_value
        place[rows] = first[rows] - 1 + share
    return place


def _departure(
    points: Sequence[WearPoint], index: int, name: str, high: bool, centre: Array
) -> Array:
    """Return what one end of one input adds to the logarithm at every state; 0 where not known."""
    pairs = [point.variants[index][1:] for point in points]
    ends = np.array([(pair[1] if high else pair[0]).number(name) for pair in pairs])
    moved = np.log(np.maximum(ends, LEAST)) - centre
    return np.where(np.isnan(moved), 0.0, moved)


def _along(parts: Array, values: Array, index: Array, places: Array) -> Array:
    """Return a measure at fractional places among the known states; beyond them +-inf."""
    beyond = math.inf if values[-1] >= values[0] else -math.inf
    inside = np.where(np.isfinite(places), places, 0.0)
    state = np.interp(inside, np.arange(index.size), index)
    return np.where(np.isfinite(places), np.interp(state, parts, values), beyond)
