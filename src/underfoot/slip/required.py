"""Required coefficient of friction (RCOF) of a population."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from underfoot.core import RangeError

from ._checks import deviation, required

_SOURCE = (
    "derived from final progress report on shoe-floor friction, G.6: median ACOF - RCOF of "
    "-0.033 (risk 21 %) at a mean ACOF of 0.167; extreme risks of 0.6 % and 92.5 %"
)


@dataclass(frozen=True, slots=True)
class RcofPopulation:
    """Normally distributed RCOF of the persons concerned.

    Normal fits the RCOF of single feet in 85.5 % of cases (Chang et al. 2012, 50 walkers).

    Parameters:
        mean, sd: 1; the standard deviation between persons.
        source: Where they come from.
        assumed: True when they were not measured on these persons.
    """

    mean: float
    sd: float
    source: str = ""
    assumed: bool = False

    def __post_init__(self) -> None:
        required(self.mean, "rcof_mean")
        deviation(self.sd, "rcof_sd")
        if self.sd > 0.5:
            raise RangeError(
                f"{self.sd:g}", where="rcof_sd", allowed="at most 0.5 (it is about 0.03)"
            )

    def on_slope(self, slope: float) -> RcofPopulation:
        """Return what the same persons need to walk down a slope (rad).

        Who needs r on the level needs tan(slope + atan r): the load leans that much more against
        the floor. Linear in r around the mean, 0.001 off at 15 degrees and two standard deviations.
        """
        if not slope:
            return self
        needed = math.tan(slope + math.atan(self.mean))
        stretch = (1 + needed**2) / (1 + self.mean**2)
        return replace(self, mean=needed, sd=stretch * self.sd)


ADULTS_LEVEL_WALKING = RcofPopulation(mean=0.20, sd=0.03, source=_SOURCE, assumed=True)
"""Adults on level floor, rounded: see docs/physics/slip_probability.md."""
