"""What a film does beside a Newtonian fluid between two walls: its flow and its shear stress."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core.arrays import Array
from underfoot.core.presentation import SourcedModel

from .operator import Conductance


@runtime_checkable
class FilmModel(SourcedModel, Protocol):
    """A film between sole and floor: shear thinning, slip at a wall, a porous floor."""

    @property
    def viscosity(self) -> float:
        """Viscosity (Pa s) that its flow is measured against; edges of lugs and sensors take it."""
        ...

    def flow_factor(self, gap: Array, speed: float) -> Conductance:
        """Return k in the conductance k h^3 / (12 eta), m^3/(Pa s), and dk/dh (1/m).

        At gaps h (m) and a sliding speed (m/s, 0 or more); 1 and 0 for a Newtonian fluid. What the
        walls carry stays V h / 2, and pores of a floor are taken as full: their content does not
        change.
        """
        ...

    def shear(self, speed: ArrayLike, film_thickness: ArrayLike) -> Array:
        """Return the shear stress (Pa) of the film on the sole."""
        ...


@dataclass(frozen=True, slots=True)
class NewtonianFilm:
    """h^3 / (12 eta) and eta V / h."""

    viscosity: float
    name: str = "Newtonian"
    source: str = "Reynolds 1886"

    def flow_factor(self, gap: Array, speed: float) -> Conductance:
        """Return 1 and 0."""
        return Conductance(np.ones_like(gap), np.zeros_like(gap))

    def shear(self, speed: ArrayLike, film_thickness: ArrayLike) -> Array:
        """Return eta V / h, Pa."""
        return self.viscosity * np.asarray(speed) / np.asarray(film_thickness)
