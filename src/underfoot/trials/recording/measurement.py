"""A number from a trial that carries what made it: uncertainty, flags and conventions."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import Any, Self

import numpy as np

from underfoot.core import DataError, InputError
from underfoot.core.deprecation import renamed_member
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import NOTHING, Amount, Message

MEAN_OF_STEPS = "mean of the steps"
"""The item of a table that stands for all steps of a file."""


RATIOS = Message("mean of the ratios of the samples")
"""Convention of a COF that is averaged sample by sample."""
TOO_FEW = Message("too few samples for a scatter")
NO_SCATTER = Message("a single value has no scatter")


@dataclass(frozen=True, slots=True)
class Flag:
    """Something a reader must know beside a number: the check's name and what was seen.

    ``matters`` is True when the number needs caution: the step and its file are then no longer
    "accepted". ``measured`` and ``limit``, in ``unit``, are what was seen and what is allowed (None
    where the check has no number); ``source`` says where the limit comes from. ``likelihood`` is
    the share of sound recordings that lie as far out as this one (0 to 1), None where it is not
    known.
    """

    name: str
    message: Message
    matters: bool = True
    measured: float | None = None
    limit: float | None = None
    unit: str = ""
    source: str = ""
    likelihood: float | None = None

    def __str__(self) -> str:
        return self.message

    words = property(renamed_member("words", "message", gone="0.4"))


UNNAMED = "caution"
"""Name of a flag of no check: what it says is all that it is."""


def caution(code: str, /, **values: Any) -> Flag:
    """Return a flag that makes a number a caution, of a template and its values."""
    return Flag(UNNAMED, Message(code, **values))


def remark(code: str, /, **values: Any) -> Flag:
    """Return a flag that is told and changes no verdict, of a template and its values."""
    return remark_of(Message(code, **values))


def remark_of(message: Message) -> Flag:
    """Return the flag that tells a message and changes no verdict."""
    return Flag("remark", message, matters=False)


@dataclass(frozen=True, slots=True, repr=False)
class Measurement(Presentable):
    """One measured number, or the reason why there is none.

    ``value`` is in ``unit`` (SI, ``"1"`` when dimensionless) and None when it could not be
    determined. ``uncertainty`` is the standard uncertainty of the value (of a mean: its standard
    error), None when not estimated. ``reason`` says why either is missing. ``n`` counts the
    samples, steps or trials behind the value, ``spread`` is the standard deviation between the
    ``n`` values of a mean. ``flags`` are what a reader must see beside the number; those that
    matter make it a caution. ``conventions`` are the choices that made the number (filter, gate,
    definition ...), each a message. A value
    that is not finite, a negative uncertainty, or neither value nor reason is a ValueError.
    """

    name: str
    value: float | None
    unit: str = "1"
    uncertainty: float | None = None
    reason: Message = NOTHING
    n: int = 1
    flags: tuple[Flag, ...] = ()
    conventions: Mapping[str, Message] = field(default_factory=dict)
    spread: float | None = None

    def __post_init__(self) -> None:
        if self.value is None and not self.reason:
            raise ValueError(f"{self.name} has neither a value nor a reason")
        if self.value is None and self.uncertainty is not None:
            raise ValueError(f"{self.name} has an uncertainty but no value")
        if self.value is not None and not math.isfinite(self.value):
            raise ValueError(f"{self.name} is {self.value}; use None and a reason")
        if self.uncertainty is None:
            if not self.reason:
                object.__setattr__(self, "reason", Message("uncertainty not estimated"))
        elif not self.uncertainty >= 0 or not math.isfinite(self.uncertainty):
            raise ValueError(f"{self.name}: uncertainty {self.uncertainty} is not allowed")

    def __float__(self) -> float:
        if self.value is None:
            reason = Message("was not determined: {reason}", reason=self.reason)
            raise DataError(reason, where=self.name)
        return float(self.value)

    @classmethod
    def not_estimated(
        cls,
        name: str,
        reason: Message,
        *,
        unit: str = "1",
        n: int = 0,
        flags: tuple[Flag, ...] = (),
        conventions: Mapping[str, Message] | None = None,
    ) -> Self:
        """Return a measurement without a value, saying why."""
        choices = dict(conventions or {})
        return cls(name, None, unit, reason=reason, n=n, flags=flags, conventions=choices)

    @property
    def estimated(self) -> bool:
        """True when there is a value."""
        return self.value is not None

    def headline(self) -> tuple[Message, ...]:
        """Return the number with unit and uncertainty, or why there is none."""
        return (self._number(),)

    def cautions(self) -> tuple[Message, ...]:
        """Return the flags that matter, in words."""
        return tuple(flag.message for flag in self.caution_flags)

    @property
    def caution_flags(self) -> tuple[Flag, ...]:
        """The flags that make the number a caution."""
        return tuple(flag for flag in self.flags if flag.matters)

    def __repr__(self) -> str:
        return f"<Measurement {str(self)[:180]}>"

    def __str__(self) -> str:
        flags = "" if self.value is None else "; ".join(map(str, self.flags))
        return self._number() + (f" [{flags}]" if flags else "")

    def _number(self) -> Message:
        if self.value is None:
            return Message("{name}: not estimated ({reason})", name=self.name, reason=self.reason)
        off = NOTHING
        if self.spread is not None:
            spread = Amount(self.spread, self.unit, 2)
            off = Message(" (mean of {count}, SD {spread})", count=self.n, spread=spread)
        elif self.uncertainty is not None:
            off = Message(" ± {off}", off=Amount(self.uncertainty, self.unit, 2))
        value = Amount(self.value, self.unit)
        return Message("{name}: {value}{off}", name=self.name, value=value, off=off)

    def table(self) -> Table:
        """Return value, uncertainty, flags and conventions, a row each."""
        none = Message("not estimated: {reason}", reason=self.reason)
        rows: list[tuple[str, Any]] = [
            ("value", none if self.value is None else self.value),
            ("unit", self.unit),
            ("standard uncertainty", self.uncertainty),
            ("n", self.n),
        ]
        if self.spread is not None:
            rows.append(("standard deviation", self.spread))
        rows += [("caution" if flag.matters else "remark", flag.message) for flag in self.flags]
        return Table(self.name, ("", ""), [*rows, *self.conventions.items()])

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON and tables."""
        return {
            **{part.name: getattr(self, part.name) for part in fields(self)},
            "flags": [{**asdict(flag), "message": flag.message} for flag in self.flags],
            "conventions": dict(self.conventions),
        }


def mean_of(measurements: Sequence[Measurement], name: str | None = None) -> Measurement:
    """Return the mean of several measurements: standard error sd / sqrt(n), and the sd as spread.

    Those without a value are left out and counted in a flag. Units and conventions must agree.
    """
    if not measurements:
        raise InputError("nothing to average", where="mean_of")
    first, ignored = measurements[0], ("baseline", "walking direction", "belt", "uncertainty")
    choices = [{k: v for k, v in m.conventions.items() if k not in ignored} for m in measurements]
    shared = choices[0]
    if any(m.unit != first.unit for m in measurements) or any(
        choice != shared for choice in choices
    ):
        raise InputError("measurements of different conventions can't be averaged")
    values = np.array([m.value for m in measurements if m.value is not None])
    name = name or first.name
    lost = len(measurements) - len(values)
    flags = (
        (
            remark(
                "{lost} of {count} without a value are left out", lost=lost, count=len(measurements)
            ),
        )
        if lost
        else ()
    )
    if not len(values):
        return Measurement.not_estimated(
            name, first.reason, unit=first.unit, flags=flags, conventions=shared
        )
    spread = float(values.std(ddof=1)) if len(values) > 1 else None
    return Measurement(
        name,
        float(values.mean()),
        first.unit,
        None if spread is None else spread / math.sqrt(len(values)),
        NO_SCATTER if spread is None else NOTHING,
        len(values),
        flags,
        {**shared, "uncertainty": Message("standard error of the mean")},
        spread,
    )
