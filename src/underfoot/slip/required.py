"""Required coefficient of friction (RCOF) of a population."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from underfoot.core import RangeError
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

from ._checks import check_required_friction, deviation

_SOURCE = (
    "derived from final progress report on shoe-floor friction, G.6: median ACOF - RCOF of "
    "-0.033 (risk 21 %) at a mean ACOF of 0.167; extreme risks of 0.6 % and 92.5 %"
)
LARGEST, LARGEST_SD = 1.0, 0.5
"""Largest mean and standard deviation of a required friction."""


@dataclass(frozen=True, slots=True)
class RcofPopulation:
    """Normally distributed RCOF of the persons concerned.

    Normal fits the RCOF of single feet in 85.5 % of cases (Chang et al. 2012, 50 walkers).

    Parameters:
        mean, sd: 1; the standard deviation between persons.
        source: Where they come from.
        assumed: True when they were not measured on these persons.
        mean_deviation, sd_deviation: Standard deviations of what mean and sd are off by.
    """

    mean: float
    sd: float
    source: str = ""
    assumed: bool = False
    mean_deviation: float = 0.0
    sd_deviation: float = 0.0

    def __post_init__(self) -> None:
        check_required_friction(self.mean, "rcof_mean")
        deviation(self.sd, "rcof_sd")
        if self.sd > LARGEST_SD:
            raise RangeError(
                f"{self.sd:g}",
                where="rcof_sd",
                allowed=Message("at most {largest_sd:g} (it is about 0.03)", largest_sd=LARGEST_SD),
            )

    def on_slope(self, slope: float, deviation: float = 0.0) -> RcofPopulation:
        """Return what the same persons need to walk down a slope (rad) known to ``deviation``.

        Who needs r on the level needs tan(slope + atan r): the load leans that much more against
        the floor. Linear in r around the mean, 0.001 off at 15 degrees and two standard deviations.
        """
        if not (slope or deviation):
            return self
        needed = math.tan(slope + math.atan(self.mean))
        stretch = (1 + needed**2) / (1 + self.mean**2)
        return replace(
            self,
            mean=needed,
            sd=stretch * self.sd,
            mean_deviation=math.hypot(stretch * self.mean_deviation, (1 + needed**2) * deviation),
            sd_deviation=stretch * self.sd_deviation,
        )

    def draw_moments(self, normal: Callable[[str], Array]) -> tuple[Any, Any]:
        """Return mean and sd, each (n,) draws where it is not exact; ``normal`` as a model's."""
        mean, sd = self.mean, self.sd
        if self.mean_deviation:
            off = self.mean_deviation * normal("mean of the required friction")
            mean = np.clip(mean + off, 0.0, LARGEST)
        if self.sd_deviation:
            off = self.sd_deviation * normal("sd of the required friction")
            sd = np.clip(sd + off, 0.0, LARGEST_SD)
        return mean, sd


ADULTS_LEVEL_WALKING = RcofPopulation(mean=0.20, sd=0.03, source=_SOURCE, assumed=True)
"""Adults on level floor, rounded: see docs/physics/slip_probability.md."""
