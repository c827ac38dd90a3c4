"""Classes of a slip by the way that the heel slides."""

from dataclasses import dataclass
from enum import StrEnum

from underfoot.core import InputError


class Outcome(StrEnum):
    """Class of a step by the distance that the heel slipped.

    It is not what "slipped" means: a slip is a peak heel speed above 0.2 m/s (report G.6.1,
    ``SlipDefinition``).
    """

    NO_SLIP = "no slip"
    MICROSLIP = "microslip"
    SLIDE = "slide"
    LONG_SLIDE = "long slide"


@dataclass(frozen=True, slots=True)
class OutcomeLimits:
    """Distances (m) up to which a step counts as no slip, microslip and slide; long slide beyond.

    30 and 100 mm: Leamon and Li 1990 (from memory, not verified; the four classes are those of
    Liu et al. 2013, PLoS ONE 8:e68989, who call the last one "slip"). 13 mm: the most that a heel
    moved in the recorded steps of dry walking between slip start and slip end (assumed).
    """

    no_slip: float = 0.013
    microslip: float = 0.03
    slide: float = 0.10

    def __post_init__(self) -> None:
        if not 0 < self.no_slip < self.microslip < self.slide:
            raise InputError("limits do not rise", where="slip.limits")

    def outcome(self, distance: float) -> Outcome:
        """Return the class of a distance in m."""
        if distance <= self.no_slip:
            return Outcome.NO_SLIP
        if distance <= self.microslip:
            return Outcome.MICROSLIP
        return Outcome.SLIDE if distance <= self.slide else Outcome.LONG_SLIDE
