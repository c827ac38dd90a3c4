"""Numbers with units as fields: text at the door, SI floats inside, ranges checked."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, ValidationInfo
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from underfoot.core import InputError, display, to_si
from underfoot.core.remark import Message
from underfoot.core.units import refuse_percent

DOOR = {"door": True}
"""Validation context of files: numbers must carry their unit."""


@lru_cache(maxsize=8192)
def si_of_text(text: str, unit: str) -> float:
    """Return a text with a unit in SI; each text is parsed once."""
    return to_si(text, unit, where="")


@dataclass(frozen=True, slots=True)
class Quantity:
    """SI unit and physical range of a field; ``open_low``/``open_high`` exclude the bound.

    ``remedy``: what to do instead of a value outside. ``percent`` False refuses percent: of a
    standard deviation they can be of the value beside it.
    """

    unit: str
    low: float
    high: float
    open_low: bool = False
    open_high: bool = False
    remedy: str | None = None
    percent: bool = True

    def range_text(self) -> str:
        """Return the range as a person reads it."""
        low, high = display(self.low, self.unit), display(self.high, self.unit)
        return (
            f"{'above' if self.open_low else 'from'} {low} "
            f"{'to below' if self.open_high else 'to'} {high}"
        )

    def parse(self, given: Any, info: ValidationInfo) -> float:
        """Return ``given`` in SI, checked against the range."""
        number = isinstance(given, float | int) and not isinstance(given, bool)
        if number and not info.context and math.isfinite(given):
            value = float(given)
        else:
            try:
                if isinstance(given, str):
                    if not self.percent:
                        refuse_percent(given, where="")
                    value = si_of_text(given, self.unit)
                else:
                    value = to_si(given, self.unit, where="")
            except InputError as error:
                raise refusal("input", error) from error
        inside = self.low <= value <= self.high
        inside &= not (self.open_low and value == self.low)
        inside &= not (self.open_high and value == self.high)
        if not inside:
            text = given if isinstance(given, str) else f"{given:g}"
            raise refusal(
                "range",
                InputError(
                    Message("{text} is outside the physical range", text=text),
                    allowed=self.range_text(),
                    nearest=self._likely(text) if isinstance(given, str) else None,
                    remedy=self.remedy,
                ),
            )
        return value

    def _likely(self, text: str) -> str | None:
        """Return the same number with the prefix that brings it into range, if only one does."""
        number, _, unit = text.strip().partition(" ")
        for other in {"m": ("mm", "um"), "mN": ("N",), "Pa": ("MPa",)}.get(unit, ()):
            try:
                value = to_si(f"{number} {other}", self.unit, where="")
            except InputError:
                return None
            if self.low <= value <= self.high:
                return f"{number} {other}"
        return None

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.parse)


_DRAWN_IN = {"m": (1e3, "mm"), "rad": (180 / math.pi, "deg")}


def one_spelling(value: Any, unit: str) -> Any:
    """Return a value (SI) as a drawing has it, the same however it was spelled.

    >>> one_spelling(0.075, "m"), one_spelling(7.5 * 0.01, "m"), one_spelling("grid", "1")
    ('75 mm', '75 mm', 'grid')
    """
    if isinstance(value, bool) or not isinstance(value, float | int):
        return value
    factor, name = _DRAWN_IN.get(unit, (1.0, unit))
    number = f"{value * factor:.12g}"
    return number if name == "1" else f"{number} {name}"


def one_value(value: Any, unit: str) -> Any:
    """Return a value (SI) as ``one_spelling`` of it is read: free of the last digit's rounding."""
    return si_of_text(one_spelling(value, unit), unit) if isinstance(value, float) else value


def refusal(kind: Literal["input", "range"], error: InputError) -> PydanticCustomError:
    """Return the validation error that carries our message."""
    context = {"what": error.what, **error.parts}
    if kind == "range":
        return PydanticCustomError("underfoot_range", "{what}", context)
    return PydanticCustomError("underfoot_input", "{what}", context)


@dataclass(frozen=True, slots=True)
class Default:
    """A default value: its text, where it comes from and whether it is an assumption."""

    text: Any
    source: str
    assumed: bool = False


def default(value: Any, text: Any, source: str, *, assumed: bool = False) -> Any:
    """Return a field with a sourced default; ``value`` is ``text`` in SI."""
    extra = {"default_text": text, "source": source, "assumed": assumed}
    return Field(default=value, json_schema_extra=extra)


def required(
    description: str = "", *, missing: str = "is missing", remedy: str | None = None
) -> Any:
    """Return a field without default; ``missing`` and ``remedy`` are the answer to its absence."""
    return Field(description=description, json_schema_extra={"missing": missing, "remedy": remedy})


def optional(description: str) -> Any:
    """Return a field that may be left out: None."""
    return Field(default=None, description=description)


def default_of(field: FieldInfo) -> Default | None:
    """Return the sourced default of a field; None when it has none or is simply absent."""
    extra = field.json_schema_extra
    if not isinstance(extra, dict) or "default_text" not in extra:
        return None
    return Default(extra["default_text"], str(extra["source"]), bool(extra["assumed"]))


FrictionSpread = Annotated[float, Quantity("1", 0.0, 5.0, percent=False)]
Length = Annotated[float, Quantity("m", 0.0, 0.5, open_low=True)]
Depth = Annotated[float, Quantity("m", 0.0, 0.05)]
Rounding = Annotated[float, Quantity("m", 0.0, 0.1)]
LargeRadius = Annotated[float, Quantity("m", 1e-3, 10.0)]
Angle = Annotated[float, Quantity("rad", 0.0, math.radians(60))]
Force = Annotated[float, Quantity("N", 1.0, 1e4)]
Speed = Annotated[
    float,
    Quantity(
        "m/s",
        0.0,
        20.0,
        open_low=True,
        remedy="At rest nothing slides: 1 mm/s is sliding off, motion.backward the other way",
    ),
]
Pressure = Annotated[float, Quantity("Pa", 0.0, 1e8, open_low=True)]
Viscosity = Annotated[float, Quantity("Pa*s", 1e-5, 1e3)]
Friction = Annotated[float, Quantity("1", 0.0, 5.0)]
Flag = Annotated[bool, Field(strict=True)]
