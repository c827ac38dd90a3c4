"""Logistic slip model of the report: ACOF minus RCOF (G.6)."""

import math
from dataclasses import dataclass, field

from underfoot.core import InputError, ValidityRange
from underfoot.core.remark import Message

from ._checks import FIFTY_PERCENT_SD, LOG_SLOPE_SD, LogisticModel

SOURCE = "final progress report on shoe-floor friction, G.6.2 and G.6.3"
SLOPE = -49.2
FIFTY_PERCENT_AT = -0.06
TESTED = ValidityRange(-0.111, 0.044, "1", f"{SOURCE}: predicted risks of 92.5 % and 0.6 %")
"""ACOF - RCOF of the pairs of subject and outsole in the study, from their printed extreme risks
(computed with the published slope and 50 % point)."""


@dataclass(frozen=True, slots=True, repr=False)
class ReportG6(LogisticModel):
    """P = 1 / (1 + exp(-slope (ACOF - RCOF - x50))), slope -49.2, x50 -0.06.

    From unexpected slips of 29 young adults on vinyl with 50 % glycerol, three outsoles of one
    tread (ACOF 0.159 to 0.182 measured at 250 N, 0.3 m/s, 7 deg); a slip is a heel speed above
    0.2 m/s. The report prints no standard errors. Two slips of each person were taken as
    independent.

    Parameters:
        slope: Change of the log odds per unit of ACOF - RCOF; negative.
        fifty_percent_at: ACOF - RCOF at which half of the steps slip.
        log_slope_sd, fifty_percent_sd: How far publications differ in both.
    """

    slope: float = SLOPE
    fifty_percent_at: float = FIFTY_PERCENT_AT
    log_slope_sd: float = LOG_SLOPE_SD
    fifty_percent_sd: float = FIFTY_PERCENT_SD
    name: str = field(default="report_g6", init=False)
    source: str = field(default=SOURCE, init=False)
    assumptions: tuple[Message, ...] = field(
        default=(
            Message(
                "The available friction was found under the conditions of the study's slip tester "
                "(250 N, 0.3 m/s, 7 deg), or means the same."
            ),
        ),
        init=False,
    )

    def __post_init__(self) -> None:
        if not (math.isfinite(self.slope) and self.slope < 0):
            raise InputError(f"{self.slope:g}", where="slope", allowed="a number below 0")
        if not math.isfinite(self.fifty_percent_at):
            raise InputError("is not finite", where="fifty_percent_at")

    @property
    def log_odds_slope(self) -> float:
        return self.slope

    @property
    def tested(self) -> ValidityRange:
        return TESTED
