"""A friction law under a film whose shear stress is not that of a Newtonian fluid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, SourcedValue
from underfoot.film.film_model import FilmModel

from .law import SMALLEST_FILM, FrictionLaw, FrictionParts


@dataclass(frozen=True, slots=True)
class FilmShearLaw:
    """The contact friction of ``law`` with the shear stress of ``film`` in place of eta V / h.

    A drawn viscosity scales that stress in proportion: ``viscosity_ratio`` is drawn over nominal.
    """

    law: FrictionLaw
    film: FilmModel
    viscosity_ratio: float = 1.0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.law, name)

    @property
    def name(self) -> str:
        """Of the law."""
        return self.law.name

    @property
    def source(self) -> str:
        """Of both."""
        return f"{self.law.source}; {self.film.source}"

    @property
    def assumptions(self) -> tuple[str, ...]:
        """Of the law."""
        return self.law.assumptions

    @property
    def inputs(self) -> Mapping[str, SourcedValue]:
        """Of the law."""
        return self.law.inputs

    @property
    def error_of_model(self) -> float | None:
        """Of the law."""
        return self.law.error_of_model

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

    def breaches(
        self, *, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> list[Breach]:
        """Return what leaves the range on which the law was measured."""
        return self.law.breaches(
            contact_pressure=contact_pressure, speed=speed, film_thickness=film_thickness
        )
