"""Fall of adhesion with speed by a mechanism: what a mechanism is, and the law made of one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import Breach, InputError, Range, SourcedValue, breaches

from ._shared import (
    PIN_PRESSURE,
    REPORT,
    checked,
    checked_viscosity,
    coefficient,
    law_breaches,
    viscous_shear,
)
from .law import FrictionParts
from .uncertain_inputs import UncertainInputs, sourced_fields, with_values

RANGES = {
    "contact pressure": Range(0.0, PIN_PRESSURE, "Pa", f"{REPORT}, G.2.1: one load; lower assumed"),
    "sliding speed": Range(0.05, 1.0, "m/s", f"{REPORT}, G.2.1"),
}


@runtime_checkable
class SpeedEffect(Protocol):
    """A mechanism that takes adhesion away as the sliding speed grows."""

    @property
    def name(self) -> str:
        """Short name for tables."""
        ...

    @property
    def source(self) -> str:
        """Papers and equations."""
        ...

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What no measurement stands behind, in words."""
        ...

    def adhesion_left(
        self, *, viscosity: float | None, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> NDArray[np.float64]:
        """Return the share of adhesion left (1 at rest) at Pa s, m/s and Pa, broadcast."""
        ...


def cof_with_speed(
    effect: SpeedEffect,
    *,
    viscosity: float | None,
    speed: ArrayLike,
    cof_boundary: float,
    cof_hysteresis: float,
    contact_pressure: ArrayLike = PIN_PRESSURE,
) -> Any:
    """Return COF = COF_hysteresis + (COF_BL - COF_hysteresis) a, a the share of adhesion left.

    Without the viscous part; ``viscosity`` Pa s or None for a dry floor, ``speed`` m/s,
    ``contact_pressure`` Pa. COF_BL is the friction at rest, and all of it is hysteresis where it
    is below ``cof_hysteresis``.
    """
    left = effect.adhesion_left(viscosity=viscosity, speed=speed, contact_pressure=contact_pressure)
    floor = min(cof_hysteresis, cof_boundary)
    found = floor + (cof_boundary - floor) * left
    return float(found) if np.ndim(found) == 0 else found


@dataclass(frozen=True, slots=True)
class SpeedEffectLaw(UncertainInputs):
    """tau = (COF_hysteresis + (COF_BL - COF_hysteresis) a) p_c + eta V / h.

    a is the share of adhesion that the mechanism ``effect`` leaves at the local speed and contact
    pressure: 1 at rest, where the friction is COF_BL, and 0 at high speed, where hysteresis and
    the viscous part are left.

    Parameters
    ----------
    effect
        ``AsperityEHL``, ``MeanFilmSharing`` or ``ViscoelasticArea``.
    cof_boundary, cof_hysteresis
        Friction of the pair with this fluid at rest, and what is left when all adhesion is gone.
    viscosity
        Pa s; None for a dry floor: only what does not need a fluid acts.
    model_deviation
        Standard deviation of the mechanism's blind predictions of COF, 1; None when not estimated.
    assumed
        Further assumptions behind the numbers, in words.
    effect_inputs
        Numbers of ``effect`` by field name, with their standard deviations.
    calibrated_product
        Viscosity x speed of the data behind the levels, Pa m; None when not known.

    Errors
    ------
    InputError
        A coefficient that was not measured or is negative, a viscosity that is not positive.
    """

    effect: SpeedEffect
    cof_boundary: SourcedValue
    cof_hysteresis: SourcedValue
    viscosity: float | None = None
    model_deviation: float | None = None
    assumed: tuple[str, ...] = ()
    effect_inputs: Mapping[str, SourcedValue] = field(default_factory=dict)
    calibrated_product: Range | None = None

    def __post_init__(self) -> None:
        coefficient(self.cof_boundary, "cof_boundary")
        coefficient(self.cof_hysteresis, "cof_hysteresis")
        checked_viscosity(self.viscosity)
        if self.model_deviation is not None and not self.model_deviation >= 0:
            raise InputError(
                f"{self.model_deviation:g}", where="model_deviation", allowed="0 or more"
            )

    @property
    def name(self) -> str:
        """Name of the mechanism."""
        return self.effect.name

    @property
    def source(self) -> str:
        """Of the mechanism, then of the boundary friction."""
        return "; ".join(dict.fromkeys((self.effect.source, self.cof_boundary.source)))

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What no measurement stands behind."""
        levels = [
            value.note
            for value in (self.cof_boundary, self.cof_hysteresis)
            if value.assumed and value.note
        ]
        return (
            "Contact friction at rest is proportional to the contact pressure.",
            *self.effect.assumptions,
            *levels,
            *self.assumed,
        )

    @property
    def error_of_model(self) -> float | None:
        """Of the mechanism's blind predictions."""
        return self.model_deviation

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """Levels of friction and the numbers of the mechanism."""
        return {**sourced_fields(self), **self.effect_inputs}

    def at(self, values: Mapping[str, float]) -> SpeedEffectLaw:
        """Return the law at other levels and numbers of the mechanism."""
        law = with_values(self, {k: v for k, v in values.items() if k not in self.effect_inputs})
        own = {k: values[k] for k in self.effect_inputs if k in values}
        if not own:
            return law
        given: Any = self.effect
        changed = given.at(own) if hasattr(given, "at") else with_values(given, own)
        return replace(law, effect=changed)

    def __call__(
        self, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> FrictionParts:
        """Return the shear stresses in Pa."""
        pressure, velocity, film = checked(contact_pressure, speed, film_thickness)
        boundary = coefficient(self.cof_boundary, "cof_boundary")
        floor = min(coefficient(self.cof_hysteresis, "cof_hysteresis"), boundary)
        left = self._left(pressure, velocity)
        return FrictionParts(
            (boundary - floor) * left * pressure,
            floor * pressure,
            viscous_shear(self.viscosity, velocity, film),
        )

    def breaches(
        self, *, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> list[Breach]:
        """Return what leaves the tests behind the calibration: 0.05 to 1 m/s, up to 266.1 kPa."""
        found = law_breaches(
            self.name, RANGES, self.viscosity, contact_pressure, speed, film_thickness
        )
        if self.viscosity is None or self.calibrated_product is None:
            return found
        product = {"viscosity x speed": self.viscosity * np.abs(np.asarray(speed, dtype=float))}
        return found + breaches(self.name, {"viscosity x speed": self.calibrated_product}, product)

    def _left(self, pressure: NDArray[np.float64], speed: NDArray[np.float64]) -> Any:
        return self.effect.adhesion_left(
            viscosity=self.viscosity, speed=speed, contact_pressure=pressure
        )
