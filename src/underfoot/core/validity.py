"""Validity ranges as data: what a closure was tested on, and what leaves that range."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .remark import Amount, Message, Remark


@dataclass(frozen=True, slots=True)
class ValidityRange:
    """Tested interval of one input, in SI."""

    low: float
    high: float
    unit: str = "1"
    source: str = ""


@dataclass(frozen=True, slots=True)
class Breach:
    """One input of one closure outside its tested range."""

    closure: str
    quantity: str
    low: float
    high: float
    range: ValidityRange

    @property
    def remark(self) -> Remark:
        """The breach as a line of a result, about its closure."""
        low, high, first, last = (
            Amount(end, self.range.unit)
            for end in (self.low, self.high, self.range.low, self.range.high)
        )
        tested = Message("{low} to {high}", low=first, high=last)
        if self.range.high == float("inf"):
            tested = Message("{low} or more", low=first)
        return Remark(
            self.closure,
            "{quantity} {given} is outside the tested range {tested}{source}",
            quantity=self.quantity,
            given=low if self.high == self.low else Message("{low} to {high}", low=low, high=high),
            tested=tested,
            source=Message(" ({source})", source=self.range.source) if self.range.source else "",
        )

    def __str__(self) -> str:
        return str(self.remark)


def breaches(
    closure: str, ranges: Mapping[str, ValidityRange], values: Mapping[str, ArrayLike]
) -> list[Breach]:
    """Return which ``values`` leave the tested ``ranges`` (relative slack 1e-9)."""
    exceeded = []
    for quantity, allowed in ranges.items():
        if quantity not in values:
            continue
        array = np.asarray(values[quantity], dtype=float)
        if array.size == 0:
            continue
        low, high = float(array.min()), float(array.max())
        ends = [abs(end) for end in (allowed.low, allowed.high) if np.isfinite(end)]
        slack = 1e-9 * max(ends, default=0.0)
        if low < allowed.low - slack or high > allowed.high + slack:
            exceeded.append(Breach(closure, quantity, low, high, allowed))
    return exceeded
