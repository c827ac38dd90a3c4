"""Numbers with units as pydantic fields: text at the door, SI floats inside, ranges checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationInfo
from pydantic.fields import FieldInfo
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from underfoot.core import InputError, display, to_si

DOOR = {"door": True}
"""Validation context of user files: numbers must carry their unit."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """SI unit and physical range of a field; ``open_low``/``open_high`` exclude the bound."""

    unit: str
    low: float
    high: float
    open_low: bool = False
    open_high: bool = False

    def allowed(self) -> str:
        """Return the range in words."""
        low, high = display(self.low, self.unit), display(self.high, self.unit)
        return (
            f"{'above' if self.open_low else 'from'} {low} "
            f"{'to below' if self.open_high else 'to'} {high}"
        )

    def parse(self, given: Any, info: ValidationInfo) -> float:
        """Return ``given`` in SI, checked against the range."""
        if info.context is None and isinstance(given, float | int) and not isinstance(given, bool):
            value = float(given)
        else:
            try:
                value = to_si(given, self.unit, where="")
            except InputError as error:
                raise refusal("input", error) from error
        inside = self.low <= value <= self.high
        inside &= not (self.open_low and value == self.low)
        inside &= not (self.open_high and value == self.high)
        if not inside:
            text = given if isinstance(given, str) else f"{given:g}"
            nearest = self._likely(text) if isinstance(given, str) else None
            raise refusal(
                "range",
                InputError(
                    f"{text} is outside the physical range",
                    allowed=self.allowed(),
                    nearest=nearest,
                ),
            )
        return value

    def _likely(self, text: str) -> str | None:
        """Return the same number with the prefix that brings it into range, if only one does."""
        number, _, unit = text.strip().partition(" ")
        if unit != "m":
            return None
        for other in ("mm", "um"):
            try:
                value = to_si(f"{number} {other}", self.unit, where="")
            except InputError:
                return None
            if self.low < value < self.high:
                return f"{number} {other}"
        return None

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(
            self.parse, serialization=core_schema.plain_serializer_function_ser_schema(float)
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        kinds = ["number", "string"] if self.unit == "1" else ["string"]
        return {
            "type": kinds,
            "unit": self.unit,
            "minimum_si": self.low,
            "maximum_si": self.high,
        }


def refusal(kind: Literal["input", "range"], error: InputError) -> PydanticCustomError:
    """Return the pydantic error that carries our message through validation."""
    context = {
        "what": error.what,
        "allowed": error.allowed,
        "nearest": error.nearest,
        "remedy": error.remedy,
    }
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
    """Return a pydantic field with a sourced default; ``value`` is ``text`` in SI."""
    extra = {"default_text": text, "source": source, "assumed": assumed}
    return Field(default=value, json_schema_extra=extra)


def default_of(field: FieldInfo) -> Default | None:
    """Return the sourced default of a field; None when it has none or is simply absent."""
    extra = field.json_schema_extra
    if not isinstance(extra, dict) or "default_text" not in extra:
        return None
    return Default(extra["default_text"], str(extra["source"]), bool(extra["assumed"]))
