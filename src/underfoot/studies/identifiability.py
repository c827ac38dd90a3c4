"""Which parameters data can fix: profiles of the misfit, intervals, and what stays open."""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError

Array = NDArray[np.float64]
RISE = 3.841458820694124
"""Rise of chi-square that bounds 95 % for one parameter."""


class Fixed(StrEnum):
    """How far data fix a parameter."""

    FIXED = "fixed"
    LOWER_BOUND = "lower bound only"
    UPPER_BOUND = "upper bound only"
    NOT_IDENTIFIABLE = "not identifiable"
    REFUTED = "no value fits"


@dataclass(frozen=True, slots=True)
class MisfitProfile:
    """A parameter's least misfit over all others.

    ``best`` is None where the data leave both sides open or refute every value: then there is no
    number. ``low`` and ``high`` bound 95 %; None where open within the grid. ``misfit`` is the
    least chi-square, ``data`` the number of data behind it.
    """

    name: str
    unit: str
    best: float | None
    low: float | None
    high: float | None
    misfit: float
    data: int
    grid: Array
    profile: Array

    @property
    def fixed(self) -> Fixed:
        """Return how far the data fix it."""
        if self.best is None and self.misfit > limit(self.data):
            return Fixed.REFUTED
        if self.low is not None and self.high is not None:
            return Fixed.FIXED
        if self.low is not None:
            return Fixed.LOWER_BOUND
        if self.high is not None:
            return Fixed.UPPER_BOUND
        return Fixed.NOT_IDENTIFIABLE

    def text(self, scale: float = 1.0, unit: str | None = None) -> str:
        """Return the outcome in words, values divided by ``scale``."""
        name = self.unit if unit is None else unit
        tail = "" if name in ("", "1") else f" {name}"
        low, high = (None if v is None else v / scale for v in (self.low, self.high))
        match self.fixed:
            case Fixed.FIXED:
                assert self.best is not None
                return f"{self.best / scale:.3g} ({low:.3g} to {high:.3g}){tail}"
            case Fixed.LOWER_BOUND:
                return f"above {low:.3g}{tail}"
            case Fixed.UPPER_BOUND:
                return f"below {high:.3g}{tail}"
            case Fixed.REFUTED:
                return "no value fits"
            case _:
                return "not identifiable"


def limit(data: int) -> float:
    """Return the chi-square that ``data`` values exceed in 5 % of cases if the model is right."""
    from scipy.stats import chi2

    return float(chi2.ppf(0.95, max(data, 1)))


def chi_square(model: ArrayLike, data: ArrayLike, deviation: ArrayLike) -> Array:
    """Return sum ((model - data) / deviation)^2 over the last axis; inf where there is none."""
    spread = np.asarray(deviation, dtype=float)
    if not (spread > 0).all():
        raise InputError("must be above 0", where="deviation")
    found = (((np.asarray(model, float) - np.asarray(data, float)) / spread) ** 2).sum(axis=-1)
    return np.where(np.isfinite(found), found, np.inf)


def profile(
    name: str, unit: str, grid: ArrayLike, misfit: ArrayLike, *, data: int
) -> MisfitProfile:
    """Return a parameter's interval from chi-square on a grid.

    Parameters:
        grid: (n,) values, rising, three or more.
        misfit: (n, ...) chi-square; the least over all further axes (other parameters) is taken.
        data: How many values stand behind the chi-square.

    The bounds lie where the profile has risen by 3.84 over its least (linear in between); a side
    where it does not rise so far within the grid is open. Where even the least is above the 95 %
    point of chi-square, no value is given: the model is wrong there, not the parameter.

    Errors:
        InputError: A grid that does not rise or does not match.
    """
    places = np.asarray(grid, dtype=float)
    values = np.asarray(misfit, dtype=float)
    if places.ndim != 1 or places.size < 3 or (np.diff(places) <= 0).any():
        raise InputError("needs three or more rising values", where=f"{name}.grid")
    if values.shape[:1] != places.shape:
        raise InputError(f"{values.shape} for {places.size} values", where=f"{name}.misfit")
    flat = values.reshape(places.size, -1).min(axis=1)
    least = int(flat.argmin())
    lowest = float(flat[least])
    if not math.isfinite(lowest) or lowest > limit(data):
        return MisfitProfile(name, unit, None, None, None, lowest, data, places, flat)
    low = _crossing(places[: least + 1][::-1], flat[: least + 1][::-1], lowest + RISE)
    high = _crossing(places[least:], flat[least:], lowest + RISE)
    best = float(places[least]) if low is not None and high is not None else None
    return MisfitProfile(name, unit, best, low, high, lowest, data, places, flat)


def _crossing(places: Array, values: Array, level: float) -> float | None:
    """Return where values first reach the level, going away from the least; None if they don't."""
    above = np.flatnonzero(values >= level)
    if not above.size:
        return None
    k = int(above[0])
    if not math.isfinite(values[k]):
        return float(places[k])
    share = (level - values[k - 1]) / (values[k] - values[k - 1])
    return float(places[k - 1] + share * (places[k] - places[k - 1]))


def model_error(predicted: ArrayLike, observed: ArrayLike) -> tuple[float, float]:
    """Return mean and root mean square of ln(predicted / observed) on data that were not fitted.

    The second is what a prediction of the same kind carries as its relative standard deviation.

    Errors:
        InputError: Values that are not positive.
    """
    ours, theirs = np.asarray(predicted, float), np.asarray(observed, float)
    if not ((ours > 0).all() and (theirs > 0).all()):
        raise InputError("needs positive values", where="model_error")
    ratio = np.log(ours / theirs)
    return float(ratio.mean()), float(np.sqrt(np.mean(ratio**2)))
