"""Inputs of a law that have a spread, and the same law with other values of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, Self

from underfoot.core import SourcedValue

SMALLEST = 1e-3
"""Drawn values of a positive input are cut at this share of it: no law knows negative ones."""


class UncertainInputs:
    """Base of laws whose inputs are fields that hold a ``SourcedValue``.

    ``inputs`` are what sampling draws; ``at`` is the law at one draw. "viscosity" (Pa s) counts
    too where the law has one: its spread comes with the fluid.
    """

    __slots__ = ()

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """Inputs by name, each with its standard deviation (or without, when not known)."""
        return sourced_fields(self)

    @property
    def error_of_model(self) -> float | None:
        """Standard deviation of COF that stays with exact inputs; None when not known."""
        return None

    def at(self, values: Mapping[str, float]) -> Self:
        """Return the law with ``values`` (SI) in place of some of its inputs."""
        return with_values(self, values)


def sourced_fields(law: Any) -> dict[str, SourcedValue]:
    """Return the fields of a dataclass that hold a number with its spread."""
    given = {field.name: getattr(law, field.name) for field in fields(law)}
    return {
        name: value
        for name, value in given.items()
        if isinstance(value, SourcedValue) and value.value is not None
    }


def with_values(law: Any, values: Mapping[str, float]) -> Any:
    """Return a dataclass with other numbers in its fields, drawn ones not below 0."""
    changes: dict[str, Any] = {}
    for name, value in values.items():
        present = getattr(law, name, None)
        if isinstance(present, SourcedValue):
            changes[name] = replace(present, value=not_negative(value, present.value))
        elif isinstance(present, float):
            changes[name] = not_negative(value, present)
    return replace(law, **changes) if changes else law


def not_negative(value: float, centre: float | None) -> float:
    """Return a drawn value, cut where it would turn the sign of a positive one."""
    return max(float(value), SMALLEST * (centre or 0.0))
