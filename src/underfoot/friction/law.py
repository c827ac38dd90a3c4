"""What the sole asks of friction: shear stress, in parts, at every place; what all laws share."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Protocol, Self, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, SourcedValue, ValidityRange, breaches
from underfoot.core.arrays import Array
from underfoot.core.checks import positive
from underfoot.core.presentation import AssumingModel, Presentable, Table
from underfoot.core.remark import Message

SMALLEST_FILM = 2e-7
"""m: the viscous part counts no film thinner than this; mean gaps of rough soles are micrometres
(Rq of the report's soles 4 to 9 um), so the bound acts on no converged result of theirs."""
REPORT = "final progress report on shoe-floor friction"
PIN_PRESSURE = 266.1e3
"""Pa: 20.9 N on a pin of 10 mm, the one load of the report's pin-on-disk studies (G.2.1, G.3.1)."""
FILM_RANGE = {
    "film thickness": ValidityRange(SMALLEST_FILM, math.inf, "m", "bound of the viscous part")
}
PIN_RANGES = {
    "contact pressure": ValidityRange(
        0.0, PIN_PRESSURE, "Pa", f"{REPORT}, G.2.1: one load; lower assumed"
    ),
    "sliding speed": ValidityRange(0.05, 1.0, "m/s", f"{REPORT}, G.2.1"),
    **FILM_RANGE,
}
"""What the pin-on-disk tests of G.2.1 cover, and what bounds the viscous part."""
SMALLEST = 1e-3
"""Drawn values of a positive input are cut at this share of it: no law knows negative ones."""


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
class FrictionLaw(AssumingModel, Protocol):
    """Local friction of the pair and fluid, vectorised; computed, fitted or measured."""

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
        """Return what leaves the range on which the law was measured.

        Parameters:
            contact_pressure: Of the solid contact, Pa.
            speed: Of sliding, m/s.
            film_thickness: m.
        """
        ...


class UncertainInputs(Presentable):
    """Base of laws: a contact with inputs that hold a ``SourcedValue``, and eta V / h.

    ``inputs`` are what sampling draws; ``at`` is the law at one draw. "viscosity" (Pa s) counts
    too where the law has one: its spread comes with the fluid.
    """

    __slots__ = ()

    def __post_init__(self) -> None:
        law: Any = self
        for name, value in sourced_fields(law, missing=True).items():
            coefficient(value, name)
        if law.viscosity is not None:
            positive(law.viscosity, "viscosity", "Pa s")

    @abstractmethod
    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        """Return the stresses of adhesion and hysteresis (Pa), and the contact fraction if known.

        At contact pressure (Pa) and speed (m/s, 0 or more), of one shape.
        """

    def __call__(
        self, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> FrictionParts:
        """Return the shear stresses in Pa."""
        law: Any = self
        pressure, velocity, film = check_arguments(contact_pressure, speed, film_thickness)
        adhesion, hysteresis, *fraction = self.contact_shear(pressure, velocity)
        viscous = viscous_shear(law.viscosity, velocity, film)
        return FrictionParts(adhesion, hysteresis, viscous, *fraction)

    @property
    def ranges(self) -> Mapping[str, ValidityRange]:
        """What the law was measured on, and what bounds its viscous part."""
        return FILM_RANGE

    def breaches(
        self, *, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> list[Breach]:
        """Return what leaves ``ranges``.

        The contact pressure is the mean that the load sees (sum p^2 / sum p): single cells may go
        above it.

        Parameters:
            contact_pressure: Of the solid contact, Pa.
            speed: Of sliding, m/s.
            film_thickness: m.
        """
        law: Any = self
        pressure, velocity, film = check_arguments(contact_pressure, speed, film_thickness)
        total = float(pressure.sum())
        values: dict[str, ArrayLike] = {"sliding speed": velocity}
        if total > 0:
            values["contact pressure"] = float((pressure**2).sum()) / total
        if law.viscosity is not None:
            values |= {"film thickness": film, "viscosity": law.viscosity}
            values["viscosity x speed"] = law.viscosity * velocity
        return breaches(law.name, self.ranges, values)

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """Inputs by name, each with its standard deviation (or without, when not known)."""
        return sourced_fields(self)

    @property
    def error_of_model(self) -> float | None:
        """Standard deviation of COF that stays with exact inputs; None when not known."""
        return getattr(self, "model_deviation", None)

    def at(self, values: Mapping[str, float]) -> Self:
        """Return the law with ``values`` (SI) in place of some of its inputs."""
        return with_values(self, values)

    def table(self) -> Table:
        """Return the inputs of the law with their spread and source."""
        law: Any = self
        inputs = dict(law.inputs)
        if law.viscosity is not None:
            inputs.setdefault("viscosity", SourcedValue(law.viscosity, "Pa*s"))
        rows = [
            (name, value.value, value.uncertainty, value.unit, value.assumed, value.source)
            for name, value in inputs.items()
        ]
        rows.append(("error of the law", None, law.error_of_model, "1", False, ""))
        return Table(
            Message("Friction law {name} ({source})", name=law.name, source=law.source),
            ("input", "value", "standard deviation", "unit", "assumed", "source"),
            rows,
        )

    def __repr__(self) -> str:
        law: Any = self
        values = ", ".join(f"{name} = {value}" for name, value in law.inputs.items())
        return f"{type(self).__name__}({values or law.name})"[:199]


def sourced_fields(law: Any, *, missing: bool = False) -> dict[str, SourcedValue]:
    """Return the fields of a dataclass that hold a number with its spread, ``missing`` ones too."""
    return {
        field.name: value
        for field in fields(law)
        if isinstance(value := getattr(law, field.name), SourcedValue)
        and (missing or value.value is not None)
    }


def with_values(law: Any, values: Mapping[str, float]) -> Any:
    """Return a dataclass with other numbers in its fields, drawn ones not below 0."""
    changes: dict[str, Any] = {}
    for name, value in values.items():
        present = getattr(law, name, None)
        if isinstance(present, SourcedValue):
            changes[name] = replace(present, value=drawn_value(value, present.value))
        elif isinstance(present, float):
            changes[name] = drawn_value(value, present)
    return replace(law, **changes) if changes else law


def drawn_value(value: float, centre: float | None) -> float:
    """Return a drawn value, cut where it would turn the sign of a positive one."""
    return max(float(value), SMALLEST * (centre or 0.0))


def check_arguments(
    contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
) -> tuple[Array, Array, Array]:
    """Return the arguments of a law as arrays of one shape; the speed as its magnitude."""
    arrays = {
        "contact_pressure": np.asarray(contact_pressure, dtype=float),
        "speed": np.asarray(speed, dtype=float),
        "film_thickness": np.asarray(film_thickness, dtype=float),
    }
    for name, array in arrays.items():
        if np.isnan(array).any():
            raise InputError("a value is not a number", where=name)
    if (arrays["contact_pressure"] < 0).any():
        raise InputError(
            Message("contact pressure down to {min:.3g} Pa", min=arrays["contact_pressure"].min()),
            where="contact_pressure",
            allowed="0 or more",
        )
    pressure, velocity, film = np.broadcast_arrays(*arrays.values())
    return pressure, np.abs(velocity), film


def viscous_shear(viscosity: float | None, speed: Array, film_thickness: Array) -> Array:
    """Return eta V / h in Pa, the film taken as at least ``SMALLEST_FILM``; 0 without a fluid."""
    if viscosity is None:
        return np.zeros_like(film_thickness)
    return viscosity * speed / np.maximum(film_thickness, SMALLEST_FILM)


def coefficient(value: SourcedValue, where: str) -> float:
    """Return the number of a friction coefficient, refused when missing, negative or not finite."""
    if value.value is None:
        raise InputError(
            Message("was not measured: {reason}", reason=value.reason),
            where=where,
            remedy="Give a measured value of your own, or choose another friction law",
        )
    if not (np.isfinite(value.value) and value.value >= 0):
        raise InputError(f"{value.value:g}", where=where, allowed="a finite number, 0 or more")
    return value.value
