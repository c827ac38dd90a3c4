"""Validity ranges as data: what a closure was tested on, and what leaves that range."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .remark import Remark
from .units import display


@dataclass(frozen=True, slots=True)
class Range:
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
    range: Range

    @property
    def remark(self) -> Remark:
        """The breach as a line of a result, about its closure."""
        unit = self.range.unit
        given = display(self.low, unit)
        if self.high != self.low:
            given += f" to {display(self.high, unit)}"
        tested = f"{display(self.range.low, unit)} to {display(self.range.high, unit)}"
        if self.range.high == float("inf"):
            tested = f"{display(self.range.low, unit)} or more"
        source = f" ({self.range.source})" if self.range.source else ""
        what = f"{self.quantity} {given} is outside the tested range {tested}{source}"
        return Remark(self.closure, what)

    def __str__(self) -> str:
        return str(self.remark)


def breaches(
    closure: str, ranges: Mapping[str, Range], values: Mapping[str, ArrayLike]
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
