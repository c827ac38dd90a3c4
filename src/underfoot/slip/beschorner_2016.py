"""Slip risk from required friction: Beschorner et al. (2016)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, Range, breaches

from ._checks import available, deviation, required
from ._logistic import logistic, normal_mean_of_logistic
from .report_g6 import FIFTY_PERCENT_AT

SOURCE = (
    "Beschorner et al., Required coefficient of friction during level walking is "
    "predictive of slipping, Gait & Posture 48 (2016) 256-260, abstract"
)
ODDS_RATIO = 1.7
"""Per 0.01 of RCOF."""
RISKS = (0.03, 0.95)
"""Predicted risks of the subjects with the lowest and the highest RCOF."""


@dataclass(frozen=True, slots=True)
class Beschorner2016:
    """P = 1 / (1 + exp(-s (RCOF - ACOF + x50))), s = ln(1.7) / 0.01 = 53.1 per unit of RCOF.

    The study gives how the odds grow with RCOF (31 subjects), without ACOF and without the RCOF
    of even odds in its abstract. Here the curve is hung at the even-odds point of ``ReportG6``
    (ACOF - RCOF = -0.06), an assumption.

    Parameters
    ----------
    odds_ratio
        Growth of the odds per 0.01 of RCOF, above 1.
    fifty_percent_at
        ACOF - RCOF at which half of the steps slip (assumed).
    """

    odds_ratio: float = ODDS_RATIO
    fifty_percent_at: float = FIFTY_PERCENT_AT
    name: str = field(default="beschorner_2016", init=False)
    source: str = field(default=SOURCE, init=False)
    assumptions: tuple[str, ...] = field(
        default=(
            "The study gives the effect of RCOF alone; the point of even odds is that of the "
            "report's G.6, and ACOF acts as strongly as RCOF.",
        ),
        init=False,
    )

    def __post_init__(self) -> None:
        if not (math.isfinite(self.odds_ratio) and self.odds_ratio > 1):
            raise InputError(f"{self.odds_ratio:g}", where="odds_ratio", allowed="above 1")
        if not math.isfinite(self.fifty_percent_at):
            raise InputError("is not finite", where="fifty_percent_at")

    @property
    def slope(self) -> float:
        """Change of the log odds per unit of RCOF."""
        return math.log(self.odds_ratio) / 0.01

    def __call__(self, acof: ArrayLike, rcof: ArrayLike) -> Any:
        """Return the probability of a slip for persons of known RCOF (arrays broadcast)."""
        found = logistic(self._log_odds(available(acof), required(rcof)))
        return float(found) if np.ndim(found) == 0 else found

    def population(self, acof: ArrayLike, rcof_mean: ArrayLike, rcof_sd: ArrayLike) -> Any:
        """Return the mean probability over RCOF ~ normal(mean, sd) (arrays broadcast)."""
        a, mean, sd = np.broadcast_arrays(
            available(acof), required(rcof_mean, "rcof_mean"), deviation(rcof_sd, "rcof_sd")
        )
        found = normal_mean_of_logistic(self._log_odds(a, mean), self.slope * sd)
        return float(found) if np.ndim(found) == 0 else found

    def breaches(self, acof: ArrayLike, rcof: ArrayLike) -> list[Breach]:
        """Return whether the predicted risk leaves that of the study's subjects (3 to 95 %)."""
        low, high = (math.log(risk / (1 - risk)) / self.slope for risk in RISKS)
        tested = Range(
            -high + self.fifty_percent_at,
            -low + self.fifty_percent_at,
            "1",
            f"{SOURCE}: predicted risks of 95 % and 3 %",
        )
        difference = np.asarray(acof, dtype=float) - np.asarray(rcof, dtype=float)
        return breaches(self.name, {"ACOF - RCOF": tested}, {"ACOF - RCOF": difference})

    def _log_odds(self, acof: Any, rcof: Any) -> Any:
        return self.slope * (rcof - acof + self.fifty_percent_at)
