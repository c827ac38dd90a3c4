"""Friction of a contact that is sealed under a film or wiped nearly dry, as the mean of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from numpy.typing import ArrayLike

from underfoot.core.arrays import Array

from .law import FrictionParts
from .law_around import LawAround


def between_states(
    sealed: FrictionParts, wiped: FrictionParts, share: Array | float
) -> FrictionParts:
    """Return the mean adhesion of two states; ``share`` is the probability of the wiped one."""
    return replace(sealed, adhesion=sealed.adhesion + share * (wiped.adhesion - sealed.adhesion))


@dataclass(frozen=True, slots=True)
class TwoStateLaw(LawAround):
    """``law``, whose wiped state is its contact at rest, with the probability ``share`` of it."""

    share: float

    def __call__(
        self, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> FrictionParts:
        """Return the shear stresses in Pa."""
        sealed, wiped = (self.law(contact_pressure, v, film_thickness) for v in (speed, 0.0))
        return between_states(sealed, wiped, self.share)

    def at(self, values: Mapping[str, float]) -> TwoStateLaw:
        """Return the law with other values of its inputs."""
        return TwoStateLaw(self.law.at(values), self.share)
