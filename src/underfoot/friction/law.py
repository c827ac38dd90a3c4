"""What the outsole asks of friction: shear stress, in parts, at every place under the sole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import Breach, SourcedValue

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FrictionParts:
    """Shear stress against sliding in Pa, in its parts; all arrays of one shape.

    ``real_contact_fraction`` (1) and ``mean_gap`` (m) are None when the law does not know them.
    """

    adhesion: Array
    hysteresis: Array
    viscous: Array
    real_contact_fraction: Array | None = None
    mean_gap: Array | None = None

    @property
    def total(self) -> Array:
        """Sum of the parts, Pa."""
        return self.adhesion + self.hysteresis + self.viscous


@runtime_checkable
class FrictionLaw(Protocol):
    """Local friction of the pair and fluid, vectorised; computed, fitted or measured."""

    @property
    def name(self) -> str:
        """Short name for reports."""
        ...

    @property
    def source(self) -> str:
        """Paper and equation, measurement, or the computation the law comes from."""
        ...

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What no measurement stands behind, in words."""
        ...

    def __call__(
        self, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> FrictionParts:
        """Return the shear stresses at contact pressure (Pa), speed (m/s) and film (m)."""
        ...

    @property
    def inputs(self) -> Mapping[str, SourcedValue]:
        """What the law was given, by name, with standard deviations where known."""
        ...

    @property
    def error_of_model(self) -> float | None:
        """Standard deviation of COF left with exact inputs, one for the sole; None if unknown."""
        ...

    def at(self, values: Mapping[str, float]) -> FrictionLaw:
        """Return the law with other values (SI) of its inputs: what sampling draws."""
        ...

    def breaches(
        self, *, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> list[Breach]:
        """Return what leaves the range on which the law was measured."""
        ...
