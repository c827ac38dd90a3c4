"""A number that knows its unit, its source, how sure it is and whether it was assumed."""

from dataclasses import dataclass, replace
from typing import Any

from underfoot.core.deprecation import renamed_member

from .errors import DataError
from .remark import Message
from .unit_text import display


@dataclass(frozen=True, slots=True)
class SourcedValue:
    """A value in SI with what a reader must know to trust it.

    ``value`` is None when it could not be determined, ``uncertainty`` (one standard deviation) when
    it was not estimated: then ``reason`` says why. ``unit`` is "1" when dimensionless. ``source``
    is a paper and table, a measurement, or the model that computed it; ``assumed`` is True when no
    measurement or publication stands behind it; ``note`` holds an erratum, convention or caution.
    ``interval`` bounds the central 95 % of the sampled values, None when it was not sampled;
    ``numerical`` is the part of the uncertainty by grid, steps and positions of a tread.
    """

    value: float | None
    unit: str = "1"
    source: str = ""
    uncertainty: float | None = None
    reason: str = ""
    assumed: bool = False
    note: str = ""
    interval: tuple[float, float] | None = None
    numerical: float | None = None

    def __post_init__(self) -> None:
        if self.uncertainty is None and not self.reason:
            object.__setattr__(self, "reason", "uncertainty not estimated")
        if self.interval is not None:
            object.__setattr__(self, "interval", tuple(self.interval))  # JSON gives a list
        if self.uncertainty is not None and self.uncertainty < 0:
            raise ValueError(f"uncertainty {self.uncertainty} is negative")

    def __float__(self) -> float:
        if self.value is None:
            raise DataError(Message("was not determined: {reason}", reason=self.reason))
        return float(self.value)

    def __str__(self) -> str:
        if self.value is None:
            return f"not estimated ({self.reason})"
        text = display(self.value, self.unit)
        if self.uncertainty is not None:
            text += f" ± {display(self.uncertainty, self.unit, 2)}"
        return text + (" (assumed)" if self.assumed else "")

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON and CSV."""
        return {name: getattr(self, name) for name in self.__slots__}

    def scale_value(self, factor: float) -> "SourcedValue":
        """Return the value, its uncertainties and its interval times a factor, 0 or more."""
        ends = self.interval
        numbers = {name: getattr(self, name) for name in ("value", "uncertainty", "numerical")}
        return replace(
            self,
            **{
                name: None if number is None else factor * number
                for name, number in numbers.items()
            },
            interval=None if ends is None else (factor * ends[0], factor * ends[1]),
        )

    scaled = renamed_member("scaled", "scale_value", gone="0.4")
