"""Slip risk from required friction: Beschorner et al. (2016)."""

import math
from dataclasses import dataclass, field

from underfoot.core import InputError, ValidityRange
from underfoot.core.remark import Message

from ._checks import FIFTY_PERCENT_SD, LOG_SLOPE_SD, LogisticModel
from .report_g6 import FIFTY_PERCENT_AT

SOURCE = (
    "Beschorner et al., Required coefficient of friction during level walking is "
    "predictive of slipping, Gait & Posture 48 (2016) 256-260, abstract"
)
ODDS_RATIO = 1.7
"""Per 0.01 of RCOF."""
RISKS = (0.03, 0.95)
"""Predicted risks of the subjects with the lowest and the highest RCOF."""


@dataclass(frozen=True, slots=True, repr=False)
class Beschorner2016(LogisticModel):
    """P = 1 / (1 + exp(-s (RCOF - ACOF + x50))), s = ln(1.7) / 0.01 = 53.1 per unit of RCOF.

    The study gives how the odds grow with RCOF (31 subjects), without ACOF and without the RCOF
    of even odds in its abstract. Here the curve is hung at the even-odds point of ``ReportG6``
    (ACOF - RCOF = -0.06), an assumption.

    Parameters:
        odds_ratio: Growth of the odds per 0.01 of RCOF, above 1.
        fifty_percent_at: ACOF - RCOF at which half of the steps slip (assumed).
        log_slope_sd, fifty_percent_sd: How far publications differ in ln slope and in that.
    """

    odds_ratio: float = ODDS_RATIO
    fifty_percent_at: float = FIFTY_PERCENT_AT
    log_slope_sd: float = LOG_SLOPE_SD
    fifty_percent_sd: float = FIFTY_PERCENT_SD
    name: str = field(default="beschorner_2016", init=False)
    source: str = field(default=SOURCE, init=False)
    assumptions: tuple[Message, ...] = field(
        default=(
            Message(
                "The study gives the effect of RCOF alone; the point of even odds is that of the "
                "report's G.6, and ACOF acts as strongly as RCOF."
            ),
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

    @property
    def log_odds_slope(self) -> float:
        return -self.slope

    @property
    def tested(self) -> ValidityRange:
        """ACOF - RCOF at which the predicted risk is that of the study's subjects, 3 to 95 %.

        A risk P belongs to ACOF - RCOF = x50 - ln(P / (1 - P)) / slope: the highest risk to the
        lowest difference.
        """
        lowest, highest = (math.log(risk / (1 - risk)) / self.slope for risk in RISKS)
        return ValidityRange(
            self.fifty_percent_at - highest,
            self.fifty_percent_at - lowest,
            "1",
            f"{SOURCE}: predicted risks of 95 % and 3 %",
        )
