"""Which of two values is higher, by one rule: draws that both share, and what a tester sees."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from underfoot.core import SourcedValue
from underfoot.core.arrays import Array
from underfoot.friction.tread_error import READING

DECIDED = 0.75
"""Least probability at which an order, or that two are equal, is stated."""
SEEN = READING
"""Difference of two COF, of the lower one, below which readings of one tester can't tell them."""
STRATA = 1000


class OrderVerdict(StrEnum):
    """What is said of two values."""

    HIGHER = "higher"
    LOWER = "lower"
    EQUAL = "equal"
    OPEN = "open"


@dataclass(frozen=True, slots=True)
class Order:
    """How sure it is that the first of two values is the higher one, and that nobody could tell.

    ``within`` is the probability that they differ by less than a tester sees (``SEEN``).
    """

    higher: float
    within: float

    @property
    def verdict(self) -> OrderVerdict:
        """Equal where nobody could tell them apart; else the order, where it is sure enough."""
        if self.within >= DECIDED:
            return OrderVerdict.EQUAL
        if self.higher >= DECIDED:
            return OrderVerdict.HIGHER
        return OrderVerdict.LOWER if 1 - self.higher >= DECIDED else OrderVerdict.OPEN

    @property
    def told(self) -> float:
        """Probability of the likelier order, 0.5 to 1."""
        return max(self.higher, 1 - self.higher)


def order_of_draws(first: Array, second: Array) -> Order:
    """Return the order of two values by draws (n,) that they share."""
    higher = float(np.mean(first > second) + 0.5 * np.mean(first == second))
    return Order(higher, float(np.mean(_alike(first, second))))


def order_of_values(first: SourcedValue, second: SourcedValue) -> Order | None:
    """Return the order of two values that share nothing; None where a spread is not known.

    Each is drawn as wide as its interval is on either side of it, in its logarithm where it is
    positive; without an interval as a normal value.
    """
    both = [_strata(value) for value in (first, second)]
    if both[0] is None or both[1] is None:
        return None
    a, b = both[0][:, None], both[1]
    higher = float(np.mean(a > b) + 0.5 * np.mean(a == b))
    return Order(higher, float(np.mean(_alike(a, b))))


def certainty_after_reading(first: Array, second: Array, repeats: float) -> float:
    """Return the probability of the likelier order once both are read, in the mean of readings.

    Parameters:
        first, second: Draws (n,) of both, above 0.
        repeats: Standard deviation of ln of the ratio of two readings.
    """
    apart = np.log(np.maximum(first, 1e-9)) - np.log(np.maximum(second, 1e-9))
    noise = np.random.default_rng(0).standard_normal((8, apart.size))
    read = (apart + repeats * noise).ravel()
    bins = np.array_split(np.argsort(read), 40)
    higher = np.tile((apart > 0) + 0.5 * (apart == 0), 8)
    chances = [float(np.mean(higher[rows])) for rows in bins if rows.size]
    return float(np.mean([max(chance, 1 - chance) for chance in chances]))


def _alike(first: Array, second: Array) -> NDArray[np.bool_]:
    low, high = np.minimum(first, second), np.maximum(first, second)
    return high < (1 + SEEN) * np.maximum(low, 0.0)


def _strata(value: SourcedValue) -> Array | None:
    if value.value is None:
        return None
    normal = ndtri((np.arange(STRATA) + 0.5) / STRATA)
    if value.interval is not None:
        low, high = value.interval
        if low > 0 and value.value > 0:
            below, above = math.log(value.value / low), math.log(high / value.value)
            sides = np.where(normal < 0, max(below, 0.0), max(above, 0.0)) / 1.96
            return value.value * np.exp(sides * normal)
        sides = np.where(normal < 0, value.value - low, high - value.value) / 1.96
        return value.value + sides * normal
    return None if value.uncertainty is None else value.value + value.uncertainty * normal
