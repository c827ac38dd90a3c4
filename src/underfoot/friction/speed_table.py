"""Friction from a table of a user's own readings: COF against sliding speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from underfoot.core import InputError, SourcedValue, ValidityRange
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative
from underfoot.core.presentation import Table
from underfoot.core.remark import Message

from .law import FILM_RANGE, UncertainInputs, with_values


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SpeedTableLaw(UncertainInputs):
    """tau = COF(V) p_c from a table, linear in the logarithm of the speed; plus eta V / h.

    Beyond its lowest and highest speed the table keeps its end values, and says so.

    Parameters:
        speed: (n,), m/s, rising, above 0.
        cof: (n,), COF of the contact at these speeds, 1.
        source: Where the readings come from.
        cof_hysteresis: Friction left when adhesion is blocked, 1, at most COF; 0 counts all as
            adhesion.
        viscosity: Pa s; None leaves out the viscous part (or when the readings hold it already).
        cof_deviation: (n,) standard deviations; None when not known.
        pressure: Lowest and highest contact pressure of the readings, Pa.
        assumed: Further assumptions behind the readings, in words.

    Raises:
        InputError: Arrays that differ in length, speeds that do not rise, values that are negative
            or missing.
    """

    speed: Array
    cof: Array
    source: str
    cof_hysteresis: float = 0.0
    viscosity: float | None = None
    cof_deviation: Array | None = None
    pressure: tuple[float, float] | None = None
    assumed: tuple[Message, ...] = ()
    name: str = field(default="speed_table", init=False)

    def __post_init__(self) -> None:
        for label in ("speed", "cof", "cof_deviation"):
            values = getattr(self, label)
            if values is not None:
                object.__setattr__(self, label, np.asarray(values, dtype=float))
        speed, spread = self.speed, self.cof_deviation
        if speed.ndim != 1 or speed.size < 2 or self.cof.shape != speed.shape:
            raise InputError(
                f"{self.cof.shape} values at {speed.shape} speeds",
                where="cof",
                allowed="one value at each of two or more speeds",
            )
        if not (np.isfinite(speed).all() and speed[0] > 0 and (np.diff(speed) > 0).all()):
            raise InputError("the speeds do not rise", where="speed", allowed="above 0, rising")
        if not (np.isfinite(self.cof).all() and (self.cof >= 0).all()):
            raise InputError("a value is negative or missing", where="cof", allowed="0 or more")
        if spread is not None and not (
            spread.shape == speed.shape and np.isfinite(spread).all() and (spread >= 0).all()
        ):
            raise InputError(
                "a value is negative or missing", where="cof_deviation", allowed="0 or more"
            )
        not_negative(self.cof_hysteresis, "cof_hysteresis")
        if not self.source.strip():
            raise InputError("no source", where="source", remedy="Say who measured it, and on what")
        UncertainInputs.__post_init__(self)

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind."""
        return (Message("Contact friction is proportional to the contact pressure."), *self.assumed)

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        place = np.log(np.maximum(velocity, self.speed[0]))
        cof = np.interp(place, np.log(self.speed), self.cof)
        hysteresis = np.minimum(self.cof_hysteresis, cof)
        return (cof - hysteresis) * pressure, hysteresis * pressure

    def table(self) -> Table:
        """Return the readings."""
        spread = [None] * self.speed.size if self.cof_deviation is None else self.cof_deviation
        return Table(
            Message("Friction law {name} ({source})", name=self.name, source=self.source),
            ("speed m/s", "COF", "standard deviation"),
            list(zip(self.speed.tolist(), self.cof.tolist(), spread, strict=True)),
        )

    def __repr__(self) -> str:
        low, high = self.cof.min(), self.cof.max()
        return (
            f"SpeedTableLaw({self.speed.size} speeds {self.speed[0]:g} to {self.speed[-1]:g} m/s, "
            f"COF {low:.3g} to {high:.3g}, {self.source[:60]!r})"
        )

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """One draw for the whole table: readings of one device are off together."""
        deviation = None if self.cof_deviation is None else 1.0
        return {"readings": SourcedValue(0.0, "1", self.source, deviation)}

    def at(self, values: Mapping[str, float]) -> SpeedTableLaw:
        """Return the law with all readings moved by so many of their standard deviations."""
        law = with_values(self, {k: v for k, v in values.items() if k != "readings"})
        if "readings" not in values or self.cof_deviation is None:
            return law
        moved = np.maximum(self.cof + values["readings"] * self.cof_deviation, 0.0)
        return replace(law, cof=moved)

    @property
    def ranges(self) -> Mapping[str, ValidityRange]:
        speed = ValidityRange(float(self.speed[0]), float(self.speed[-1]), "m/s", self.source)
        ranges = {"sliding speed": speed}
        if self.pressure is not None:
            ranges["contact pressure"] = ValidityRange(*self.pressure, "Pa", self.source)
        return ranges | FILM_RANGE
