"""A number from a trial that carries what made it: uncertainty, flags and conventions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from underfoot.core import InputError, display


@dataclass(frozen=True, slots=True)
class Measurement:
    """One measured number, or the reason why there is none.

    Parameters
    ----------
    name
        What was measured, for example ``"rcof"``.
    value
        In ``unit``; None when it could not be determined (then ``reason`` says why).
    unit
        SI unit, ``"1"`` when dimensionless.
    uncertainty
        Standard deviation in ``unit``; None when not estimated (then ``reason`` says why).
    reason
        Why the value or its uncertainty is missing.
    n
        Number of samples, steps or trials behind the value.
    flags
        Cautions a reader must see beside the number.
    conventions
        The choices that made the number (filter, gate, definition ...), in words.

    Errors
    ------
    ValueError
        A value that is not finite, a negative uncertainty, or no value and no reason.
    """

    name: str
    value: float | None
    unit: str = "1"
    uncertainty: float | None = None
    reason: str = ""
    n: int = 1
    flags: tuple[str, ...] = ()
    conventions: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.value is None:
            if not self.reason:
                raise ValueError(f"{self.name} has neither a value nor a reason")
            if self.uncertainty is not None:
                raise ValueError(f"{self.name} has an uncertainty but no value")
        elif not math.isfinite(self.value):
            raise ValueError(f"{self.name} is {self.value}; use None and a reason")
        if self.uncertainty is None:
            if not self.reason:
                object.__setattr__(self, "reason", "uncertainty not estimated")
        elif not self.uncertainty >= 0 or not math.isfinite(self.uncertainty):
            raise ValueError(f"{self.name}: uncertainty {self.uncertainty} is not allowed")

    @classmethod
    def not_estimated(
        cls,
        name: str,
        reason: str,
        *,
        unit: str = "1",
        n: int = 0,
        flags: tuple[str, ...] = (),
        conventions: Mapping[str, str] | None = None,
    ) -> Measurement:
        """Return a measurement without a value, saying why."""
        return cls(
            name, None, unit, reason=reason, n=n, flags=flags, conventions=dict(conventions or {})
        )

    @property
    def estimated(self) -> bool:
        """True when there is a value."""
        return self.value is not None

    def __str__(self) -> str:
        if self.value is None:
            return f"{self.name}: not estimated ({self.reason})"
        text = f"{self.name}: {display(self.value, self.unit)}"
        if self.uncertainty is not None:
            text += f" ± {display(self.uncertainty, self.unit, 2)}"
        return text + (f" [{'; '.join(self.flags)}]" if self.flags else "")

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON and tables."""
        return {
            "name": self.name,
            "value": self.value,
            "unit": self.unit,
            "uncertainty": self.uncertainty,
            "reason": self.reason,
            "n": self.n,
            "flags": list(self.flags),
            "conventions": dict(self.conventions),
        }


def mean_of(measurements: Sequence[Measurement], name: str | None = None) -> Measurement:
    """Return the mean of several measurements with its standard error, sd / sqrt(n).

    Those without a value are left out and counted in a flag. Conventions must agree.

    Errors
    ------
    InputError
        Nothing given, or different units or conventions.
    """
    if not measurements:
        raise InputError("nothing to average", where="mean_of")
    first = measurements[0]
    ignored = ("baseline", "walking direction")
    kept = {k: v for k, v in first.conventions.items() if k not in ignored}
    for other in measurements:
        theirs = {k: v for k, v in other.conventions.items() if k not in ignored}
        if other.unit != first.unit or theirs != kept:
            raise InputError("measurements of different conventions can't be averaged")
    values = np.array([m.value for m in measurements if m.value is not None])
    name = name or first.name
    lost = len(measurements) - len(values)
    flags = (f"{lost} of {len(measurements)} without a value are left out",) if lost else ()
    if not len(values):
        return Measurement.not_estimated(
            name, first.reason, unit=first.unit, flags=flags, conventions=kept
        )
    deviation = float(values.std(ddof=1) / math.sqrt(len(values))) if len(values) > 1 else None
    return Measurement(
        name,
        float(values.mean()),
        first.unit,
        deviation,
        "" if deviation is not None else "a single value has no scatter",
        len(values),
        flags,
        {**kept, "uncertainty": "standard error of the mean"},
    )
