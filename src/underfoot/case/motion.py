"""Slot for what the foot does, and the section for the sensors in the floor."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from underfoot.core import InputError, RangeError, display, to_si
from underfoot.core.remark import Amount, Message

from .quantity import Flag, Force, Length, Quantity, Speed, default, optional
from .section import DEFAULT, CaseView, Leaf, Option, Origin, Section
from .tables import as_written, plain, table_columns

if TYPE_CHECKING:
    from underfoot.sole_contact.motion_history import MotionHistory

_TESTER = "final progress report on shoe-floor friction, G.4.1"
_mm = 1e-3
ShoeAngle = Annotated[float, Quantity("rad", math.radians(-30), math.radians(60))]
RolledAngle = Annotated[float, Quantity("rad", math.radians(-70), math.radians(60))]
Time = Annotated[float, Quantity("s", 0.0, 60.0, open_low=True)]
Instant = Annotated[float, Quantity("s", 0.0, 60.0)]
AnySpeed = Annotated[float, Quantity("m/s", -20.0, 20.0)]
AnyForce = Annotated[float, Quantity("N", 0.0, 1e4)]
Count = Annotated[int, Field(ge=1, le=200, strict=True)]
COLUMNS = {
    "time": ("s", ("time", "t")),
    "normal_force": ("N", ("normal force", "force", "load", "vertical force")),
    "speed": ("m/s", ("speed", "sliding speed", "velocity")),
    "shoe_angle": ("rad", ("shoe angle", "angle", "foot angle")),
}
SLOWEST = 1e-3
"""m/s, speed at the end below which ``motion.speed`` says this much."""


class Motion(Option):
    """How the heel meets the floor."""

    slot: ClassVar[str] = "motion"
    usual: ClassVar[str | None] = "held"

    speed: Speed
    normal_force: Force
    shoe_angle: ShoeAngle = Field(description="toe up positive")
    force_rise_time: Time = default(0.03, "30 ms", _TESTER)
    duration: Time | None = optional("when the result is taken; default: when sliding is steady")
    start_film: Annotated[float, Quantity("m", 1e-6, 0.01)] | None = optional(
        "lowest point above the floor when loading starts; default: the pool's surface, 0.2 mm at "
        "most (steady sliding forgets it)"
    )

    @property
    def end_time(self) -> float | None:
        """When the result is taken, s; None when sliding is steady."""
        return self.duration

    @property
    def forward(self) -> bool:
        """Whether the shoe slides towards its toe when the result is taken."""
        return True

    @property
    def sliding_speed(self) -> float:
        """Speed along +x when the result is taken, m/s; negative backward."""
        return self.speed if self.forward else -self.speed

    def build(self) -> MotionHistory | None:
        return None


class HeldMotion(Motion):
    """One load and speed held."""

    name: ClassVar[str] = "held"

    steady: Flag | None = optional(
        "the result is taken when sliding is steady; default: where no duration is given"
    )
    backward: Flag = default(False, False, "the shoe slides heel first, as in push-off")

    @property
    def end_time(self) -> float | None:
        return None if self.steady else self.duration

    @property
    def forward(self) -> bool:
        return not self.backward

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        return ("duration",) if self.steady else ()

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        remedy = "Leave motion.duration out: the march then goes on until sliding is steady"
        if self.end_time is not None and self.end_time < self.force_rise_time:
            yield RangeError(
                f"{display(self.end_time, 's')} ends before the force has risen",
                where=f"{where}.duration",
                allowed=Message(
                    "at least {least} ({what})",
                    least=Amount(self.force_rise_time, "s"),
                    what="motion.force_rise_time",
                ),
                remedy=remedy,
            )
        if self.end_time is None and self.steady is False:
            yield InputError(
                "is false, but no duration says when the result is taken",
                where=f"{where}.steady",
                allowed="false with motion.duration",
                remedy='Write motion.duration = "0.3 s", or leave motion.steady out',
            )


class MotionPoint(Section):
    """One instant of a history; straight lines lead from one to the next."""

    time: Instant
    normal_force: AnyForce
    speed: AnySpeed = Field(description="of the shoe, forward positive")
    shoe_angle: RolledAngle | None = optional("toe up positive; default: motion.shoe_angle")


class MotionFromHistory(Motion):
    """A history of load, speed and shoe angle; the result is its last instant."""

    name: ClassVar[str] = "history"
    chosen_by: ClassVar[tuple[str, ...]] = ("history", "history_points")
    replaced: ClassVar[tuple[str, ...]] = ("history",)

    history: str | None = optional(
        "file (CSV, XLSX) with columns time, normal_force, speed and, where it turns, "
        "shoe_angle; the path counts from the case file's folder"
    )
    history_points: tuple[MotionPoint, ...] = Field(
        description="the same points written in the case"
    )

    @property
    def end_time(self) -> float | None:
        return self.history_points[-1].time

    @property
    def forward(self) -> bool:
        return self.history_points[-1].speed >= 0

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        table = dict(table)
        name, points = plain(table.get("history")), plain(table.get("history_points"))
        if isinstance(name, str):
            if points is not None:
                raise InputError(
                    "a table and points are given",
                    where=f"{where}.history",
                    remedy="Keep history or history_points",
                )
            points = read_motion_table(folder / name, f"{where}.history")
            table["history_points"] = points
        if isinstance(points, list | tuple) and points and isinstance(points[-1], dict):
            last = points[-1]
            force = last.get("normal_force")
            if isinstance(force, str) and to_si(force, "N", where=f"{where}.history_points") < 1.0:
                raise InputError(
                    f"the history ends with {force}",
                    where=f"{where}.{'history_points' if name is None else 'history'}",
                    allowed="1 N or more at the end, where the result is taken",
                )
            for key, point in (("normal_force", "normal_force"), ("duration", "time")):
                if point in last:
                    table.setdefault(key, last[point])
            rise = Leaf(plain(table.get("duration")) or "30 ms", source="the history")
            table.setdefault("force_rise_time", Origin(DEFAULT, rise))
            if isinstance(last.get("speed"), str):
                speed = abs(to_si(last["speed"], "m/s", where=f"{where}.history_points"))
                table.setdefault("speed", f"{max(speed, SLOWEST):.12g} m/s")
            if "shoe_angle" in last:
                table.setdefault("shoe_angle", last["shoe_angle"])
        return table

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        return ("force_rise_time",)  # the history tells how the force rises

    def build(self) -> MotionHistory | None:
        from underfoot.sole_contact.motion_history import MotionHistory

        points = [(p.time, p.normal_force, p.speed, p.shoe_angle) for p in self.history_points]
        time, force, speed, angle = np.array(points, dtype=float).reshape(-1, 4).T.copy()
        return MotionHistory(time, force, speed, np.where(np.isnan(angle), self.shoe_angle, angle))

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        listed = f"{where}.{'history' if self.history else 'history_points'}"
        try:
            history = self.build()
        except InputError as error:
            yield InputError(error.what, where=listed, allowed=error.allowed, remedy=error.remedy)
            return
        assert history is not None
        last, force = float(history.time[-1]), history.normal_force[-1]
        for name, what, differs in (
            ("duration", f"lasts {display(last, 's')}", abs(last - (self.duration or last)) > 1e-9),
            ("normal_force", f"ends with {force:g} N", abs(force - self.normal_force) > 1e-6),
        ):
            if differs:
                remedy = f"Leave motion.{name} out: the history says it"
                yield InputError(f"the history {what}", where=f"{where}.{name}", remedy=remedy)


def read_motion_table(path: Path, where: str) -> list[dict[str, str | float]]:
    """Return the points of a table (CSV, XLSX) as a case file writes them.

    Columns ``time``, ``normal_force``, ``speed`` and, where the shoe turns, ``shoe_angle``; units
    stand in the heading, as ``time (ms)``, else SI.

    Raises:
        InputError: No file, no table, a column or value missing, fewer than two rows.
    """
    read = table_columns(path, COLUMNS, where, needed=("time", "normal_force", "speed"))
    if read["time"].size < 2:
        raise InputError(
            f"{path.name} has {read['time'].size} rows", where=where, allowed="2 or more"
        )
    return as_written(read, COLUMNS)


class FloorArray(Section):
    """Sensors that stay in place in the floor."""

    rows: Count = Field(description="along the walking direction (G.5.1: 3)")
    columns: Count = Field(description="across (G.5.1: 3)")
    spacing: Length = Field(description="between rows and between columns (G.5.1: 30 mm)")
    inlet_diameter: Length = Field(description="of each sensor (G.5.1: 4 mm)")
    position: Annotated[float, Quantity("m", -5.0, 5.0)] | None = optional(
        "of the first row, ahead of the shoe's rear end at time 0; default: the shoe "
        "has the array under its middle at the end"
    )

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        return _without_film(self, case)


def _without_film(sensors: Section, case: CaseView) -> tuple[str, ...]:
    """Return the fields of sensors that no film reaches: all of them."""
    film = case.contaminant is not None and case.film.bears
    return () if film else tuple(type(sensors).model_fields)


class Sensor(Section):
    """Fluid-pressure sensors in the floor: the scans of one, and an array that stays in place."""

    inlet_diameter: Length = default(10 * _mm, "10 mm", _TESTER)
    scan_spacing: Length = default(10 * _mm, "10 mm", _TESTER)
    scans: Count = default(7, 7, _TESTER)
    compliance: Annotated[float, Quantity("m^3/Pa", 0.0, 1e-12)] = default(
        0.0,
        "0 mm^3/MPa",
        "no instrument of the report prints its own: the readings then follow the film at once and "
        "are upper bounds of what it shows",
        assumed=True,
    )
    array: FloorArray | None = None

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        return _without_film(self, case)
