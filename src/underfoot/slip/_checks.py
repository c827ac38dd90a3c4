"""Checks of coefficients of friction; the logistic curve and its mean over persons."""

import math
from abc import abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, RangeError, ValidityRange, breaches
from underfoot.core.arrays import Array, scalar_or_array
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message

LARGEST_ACOF = 5.0
LOG_SLOPE_SD, FIFTY_PERCENT_SD = 0.2, 0.05
"""Standard deviation between publications of ln of a logistic's slope and of its ACOF - RCOF at
even odds (report, G.6.3: slopes of -41.2 to -54.7; -0.06 and -0.11)."""
LEFT_OVER = "available less required friction"
_HALF_WIDTH = 9.0
_WIDEST_STEP, _STEP_OVER_STRIP = 0.25, 0.79


def available(acof: ArrayLike) -> Array:
    """Return available friction as an array; refuse what no sole on a floor can have."""
    return _within(acof, LARGEST_ACOF, "acof")


def check_required_friction(rcof: ArrayLike, where: str = "rcof") -> Array:
    """Return required friction as an array; refuse what no walking needs."""
    return _within(rcof, 1.0, where)


def deviation(value: ArrayLike, where: str) -> Array:
    """Return a standard deviation of friction as an array; refuse a negative one."""
    return _within(value, 1.0, where)


def _within(value: ArrayLike, largest: float, where: str) -> Array:
    array = np.asarray(value, dtype=float)
    if not np.isfinite(array).all():
        raise InputError("a value is not a finite number", where=where)
    if ((array < 0) | (array > largest)).any():
        raise RangeError(
            Message("{low:g} to {high:g}", low=array.min(), high=array.max()),
            where=where,
            allowed=f"0 to {largest:g}",
        )
    return array


class PresentableModel(Presentable):
    """How a slip model presents itself: the probability over ACOF - RCOF."""

    __slots__ = ()

    def table(self) -> Table:
        """Return the probability of a slip for persons of RCOF 0.2 at ACOF 0 to 0.4."""
        model: Any = self
        acof = np.linspace(0.0, 0.4, 17)
        rows = zip(acof.tolist(), (acof - 0.2).tolist(), model(acof, 0.2).tolist(), strict=True)
        columns = ("ACOF", "ACOF - RCOF", "probability of a slip")
        title = Message("Slip model {name} ({source})", name=model.name, source=model.source)
        return Table(title, columns, list(rows))

    def __repr__(self) -> str:
        model: Any = self
        return f"{type(self).__name__}({model.source})"[:199]


class LogisticModel(PresentableModel):
    """P = logistic(slope (ACOF - RCOF - x50)); a subclass has ``log_odds_slope`` and x50."""

    __slots__ = ()
    name: str
    fifty_percent_at: float
    log_slope_sd: float
    fifty_percent_sd: float

    @property
    @abstractmethod
    def log_odds_slope(self) -> float:
        """Change of the log odds per unit of ACOF - RCOF; negative."""

    @property
    @abstractmethod
    def tested(self) -> ValidityRange:
        """ACOF - RCOF of the study."""

    def __call__(self, acof: ArrayLike, rcof: ArrayLike) -> Any:
        """Return the probability of a slip for persons of known RCOF (arrays broadcast)."""
        return scalar_or_array(
            logistic(self._log_odds(available(acof), check_required_friction(rcof)))
        )

    def population(self, acof: ArrayLike, rcof_mean: ArrayLike, rcof_sd: ArrayLike) -> Any:
        """Return the mean probability over RCOF ~ normal(mean, sd) (arrays broadcast)."""
        a, mean, sd = np.broadcast_arrays(
            available(acof),
            check_required_friction(rcof_mean, "rcof_mean"),
            deviation(rcof_sd, "rcof_sd"),
        )
        spread = -self.log_odds_slope * sd
        return scalar_or_array(normal_mean_of_logistic(self._log_odds(a, mean), spread))

    def draw_probability(
        self, acof: Array, rcof_mean: ArrayLike, rcof_sd: ArrayLike, normal: Callable[[str], Array]
    ) -> Array:
        """Return the mean probability over persons in draws (n,) of ACOF and of slope and x50.

        ``normal`` gives (n,) standard normal draws by name.
        """
        slope = self.log_odds_slope * np.exp(self.log_slope_sd * normal("slope of the slip model"))
        even = self.fifty_percent_at + self.fifty_percent_sd * normal("even odds of the slip model")
        odds = slope * (available(acof) - check_required_friction(rcof_mean, "rcof_mean") - even)
        return normal_mean_of_logistic(odds, -slope * deviation(rcof_sd, "rcof_sd"))

    def breaches(self, acof: ArrayLike, rcof: ArrayLike) -> list[Breach]:
        """Return whether ACOF - RCOF leaves that of the study (``tested``)."""
        difference = np.asarray(acof, dtype=float) - np.asarray(rcof, dtype=float)
        return breaches(self.name, {LEFT_OVER: self.tested}, {LEFT_OVER: difference})

    def _log_odds(self, acof: Any, rcof: Any) -> Any:
        return self.log_odds_slope * (acof - rcof - self.fifty_percent_at)


def logistic(log_odds: Array) -> Array:
    """Return 1 / (1 + exp(-log_odds)) without overflow."""
    return 0.5 * (1.0 + np.tanh(0.5 * log_odds))


def normal_mean_of_logistic(mean: Array, deviation: Array) -> Array:
    """Return the mean of ``logistic`` over normally distributed log odds.

    Trapezoidal rule over nine standard deviations, which converges exponentially for smooth,
    decaying integrands: the poles of the logistic lie pi / deviation off the axis, and the step
    follows them, so that deviations of up to 100 log odds are exact to 1e-10.
    """
    widest = float(np.max(deviation, initial=0.0))
    step = min(_WIDEST_STEP, _STEP_OVER_STRIP / max(widest, 1e-9))
    z = np.linspace(-_HALF_WIDTH, _HALF_WIDTH, 2 * math.ceil(_HALF_WIDTH / step) + 1)
    weight = np.exp(-0.5 * z**2)
    weight /= weight.sum()
    return logistic(mean[..., None] + deviation[..., None] * z) @ weight
