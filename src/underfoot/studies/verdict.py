"""How a computed range stands against a printed one, by rules that are the same everywhere."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from underfoot.core import InputError

ROUNDING = 0.005
"""Half a percentage point: what a printed whole percentage leaves open."""


class Verdict(StrEnum):
    """How our numbers stand against the printed ones."""

    REPRODUCED = "reproduced"
    WITHIN_SCATTER = "within scatter"
    TREND_ONLY = "trend only"
    DISAGREES = "disagrees"
    NOT_AVAILABLE = "can't be had"

    @property
    def rule(self) -> str:
        """Return what the verdict means."""
        return {
            Verdict.REPRODUCED: "all our values lie in the printed range",
            Verdict.WITHIN_SCATTER: "our range and the printed range overlap",
            Verdict.TREND_ONLY: "same sign in every pair, another size",
            Verdict.DISAGREES: "another sign or no effect, in some pair at least",
            Verdict.NOT_AVAILABLE: "not printed, or beyond what the model can give",
        }[self]


@dataclass(frozen=True, slots=True)
class Erratum:
    """Where the printed text was not taken as it stands."""

    where: str
    printed: str
    used: str
    why: str


@dataclass(frozen=True, slots=True)
class ComparedLine:
    """One printed statement beside ours.

    Parameters
    ----------
    series
        Which of our parameter sets.
    quantity, condition
        What, and between what.
    source
        Section or figure.
    printed
        (lowest, highest) as fractions, or None where only words are printed.
    printed_text
        As a reader sees it.
    ours
        Fractions, one for each pair of conditions; empty when not available.
    verdict, reason
        The outcome and why it is so.
    """

    series: str
    quantity: str
    condition: str
    source: str
    printed: tuple[float, float] | None
    printed_text: str
    ours: tuple[float, ...]
    verdict: Verdict
    reason: str

    @property
    def ours_text(self) -> str:
        """Our range as a reader sees it."""
        return percent_range(self.ours)

    def as_dict(self) -> dict[str, object]:
        """Return plain data for JSON and CSV."""
        return {
            "series": self.series,
            "quantity": self.quantity,
            "condition": self.condition,
            "source": self.source,
            "printed": self.printed_text,
            "ours": self.ours_text,
            "verdict": str(self.verdict),
            "reason": self.reason,
        }


def percent_range(values: Iterable[float]) -> str:
    """Return "-29 to -16 %" for fractions, rounded to whole percentages; "-" where one is NaN."""
    given = list(values)
    if not given or any(value != value for value in given):
        return "-"
    each = [round(100.0 * value) for value in given]
    low, high = min(each), max(each)
    return f"{low:+d} %" if low == high else f"{low:+d} to {high:+d} %"


def compared_range(printed: tuple[float, float], ours: Iterable[float]) -> Verdict:
    """Return the verdict on changes (fractions) against the range that is printed.

    Errors
    ------
    InputError
        A printed range whose ends are exchanged.
    """
    low, high = printed
    if low > high:
        raise InputError(f"{low:g} to {high:g}", where="printed", allowed="lowest first")
    values = list(ours)
    if not values or any(value != value for value in values):
        return Verdict.NOT_AVAILABLE
    least, most = min(values), max(values)
    if least >= low - ROUNDING and most <= high + ROUNDING:
        return Verdict.REPRODUCED
    if least <= high + ROUNDING and most >= low - ROUNDING:
        return Verdict.WITHIN_SCATTER
    upwards = low >= 0.0 and least > ROUNDING
    downwards = high <= 0.0 and most < -ROUNDING
    return Verdict.TREND_ONLY if upwards or downwards else Verdict.DISAGREES


def compared_sign(printed: int, ours: Iterable[float]) -> Verdict:
    """Return the verdict on changes (fractions) where only a direction (+1 or -1) is printed."""
    values = list(ours)
    if not values or any(value != value for value in values):
        return Verdict.NOT_AVAILABLE
    agrees = all(printed * value > ROUNDING for value in values)
    return Verdict.REPRODUCED if agrees else Verdict.DISAGREES


def compared_mean(
    printed: float, deviation: float, count: int, ours: float, *, trend: bool | None = None
) -> Verdict:
    """Return the verdict on a mean against a printed mean with its standard deviation.

    Reproduced within 1.96 standard errors of the printed mean, within scatter within one standard
    deviation of it. Beyond, ``trend`` says whether the direction against a second condition holds;
    None where there is none.

    Errors
    ------
    InputError
        A negative deviation, fewer than two values behind the mean.
    """
    if deviation < 0 or count < 2:
        raise InputError(
            f"{deviation:g} of {count}", where="printed", allowed="a deviation of two or more"
        )
    if ours != ours:
        return Verdict.NOT_AVAILABLE
    off = abs(ours - printed)
    if off <= 1.96 * deviation / count**0.5:
        return Verdict.REPRODUCED
    if off <= deviation:
        return Verdict.WITHIN_SCATTER
    return Verdict.TREND_ONLY if trend else Verdict.DISAGREES
