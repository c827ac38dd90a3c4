"""A friction law under a film whose shear stress is not that of a Newtonian fluid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from underfoot.film.film_model import FilmModel

from .law import SMALLEST_FILM, FrictionParts
from .law_around import LawAround


@dataclass(frozen=True, slots=True)
class FilmShearLaw(LawAround):
    """The contact friction of ``law`` with the shear stress of ``film`` in place of eta V / h.

    A drawn viscosity scales that stress in proportion: ``viscosity_ratio`` is drawn over nominal.
    """

    film: FilmModel
    viscosity_ratio: float = 1.0

    @property
    def source(self) -> str:
        """Sources of the film shear and of the law."""
        return f"{self.law.source}; {self.film.source}"

    def __call__(
        self, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> FrictionParts:
        """Return the shear stresses in Pa."""
        parts = self.law(contact_pressure, speed, film_thickness)
        shear = self.film.shear(speed, np.maximum(film_thickness, SMALLEST_FILM))
        viscous = self.viscosity_ratio * np.broadcast_to(shear, parts.adhesion.shape)
        return replace(parts, viscous=viscous)

    def at(self, values: Mapping[str, float]) -> FilmShearLaw:
        """Return the law with other values of its inputs."""
        drawn = values.get("viscosity", self.film.viscosity)
        return FilmShearLaw(self.law.at(values), self.film, drawn / self.film.viscosity)
