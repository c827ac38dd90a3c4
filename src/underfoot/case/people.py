"""Sections for the people: the slip model with their required friction, and how they walk."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic import Field

from .quantity import Friction, FrictionSpread, Quantity, default
from .section import CaseView, Option, Section

if TYPE_CHECKING:
    from underfoot.slip import SlipModel

_REPORT = "final progress report on shoe-floor friction"
_SLIPS = (
    f"largest load in unexpected slips 0.40 to 0.85 of body weight ({_REPORT}, G.4.1), 1.1 in dry "
    "steps"
)
_STEPS = "recorded steps of dry walking that come with the package, see slip dynamics"
_ADULTS = "adults on level floor; derived from G.6, see slip probability"
_MARKERS = "ten recorded steps with heel and toe markers"
_LANDING = "heel directly behind the first row of sensors"
Count = Annotated[int, Field(ge=1, le=20, strict=True)]
Mass = Annotated[float, Quantity("kg", 5.0, 400.0)]
MassSpread = Annotated[float, Quantity("kg", 0.0, 100.0)]
Pace = Annotated[float, Quantity("m/s", 0.3, 4.0)]
SpeedSpread = Annotated[float, Quantity("m/s", 0.0, 2.0)]
HeelSpeed = Annotated[float, Quantity("m/s", 0.0, 5.0)]
AngleSpread = Annotated[float, Quantity("rad", 0.0, math.radians(20))]
Share = Annotated[float, Quantity("1", 0.001, 1.0)]
Place = Annotated[float, Quantity("m", -0.5, 0.5)]
Width = Annotated[float, Quantity("m", 0.0, 0.5)]
Spacing = Annotated[float, Quantity("m", 1e-3, 0.5)]
Inlet = Annotated[float, Quantity("m", 0.0, 0.05)]
Time = Annotated[float, Quantity("s", 1e-3, 0.2)]
TimeSpread = Annotated[float, Quantity("s", 0.0, 0.1)]
Transfer = Annotated[float, Quantity("1", 0.0, 1.0)]
Step = Annotated[float, Quantity("s", 1e-4, 0.02)]


class Risk(Option):
    """Who walks: the required friction of the people concerned, and the slip model."""

    slot: ClassVar[str] = "risk"
    usual: ClassVar[str | None] = "report_g6"

    rcof_mean: Friction = default(0.20, 0.20, _ADULTS, assumed=True)
    rcof_sd: FrictionSpread = default(0.03, 0.03, _ADULTS, assumed=True)

    @abstractmethod
    def build(self) -> SlipModel:
        """Return the slip model."""


class _Published(Risk):
    def build(self) -> SlipModel:
        from underfoot.slip import slip_model

        return slip_model(self.name)


class ReportRisk(_Published):
    """Logistic of the report's human slips."""

    name: ClassVar[str] = "report_g6"
    source: ClassVar[str] = f"{_REPORT}, G.6.3"


class BeschornerRisk(_Published):
    """Logistic of Beschorner et al. 2016."""

    name: ClassVar[str] = "beschorner_2016"
    source: ClassVar[str] = "Beschorner et al. 2016"


class ChangRisk(_Published):
    """Available against required friction, Chang 2004."""

    name: ClassVar[str] = "chang_2004"
    source: ClassVar[str] = "Chang 2004"


class Walkers(Section):
    """A population's steps; the required friction is that of ``risk``, the angle of ``motion``."""

    without_spread: ClassVar[str] = "what differs between people is the sd beside it"

    subjects: Annotated[int, Field(ge=1, le=10_000, strict=True)] = default(
        40, 40, "enough for a share to within 15 %"
    )
    seed: Annotated[int, Field(ge=0, le=2**31, strict=True)] = default(1, 1, "any")
    mass_mean: Mass = default(70.0, "70 kg", f"{_REPORT}, G.5.1")
    mass_sd: MassSpread = default(11.8, "11.8 kg", f"{_REPORT}, G.5.1")
    effective_mass: Share = default(
        0.114,
        0.114,
        "8 kg of 70: between foot and shank (0.06) and the whole leg (0.17)",
        assumed=True,
    )
    walking_speed_mean: Pace = default(1.35, "1.35 m/s", _STEPS, assumed=True)
    walking_speed_sd: SpeedSpread = default(0.18, "0.18 m/s", _STEPS, assumed=True)
    heel_speed_mean: HeelSpeed = default(0.33, "0.33 m/s", _STEPS, assumed=True)
    heel_speed_sd: SpeedSpread = default(0.12, "0.12 m/s", _STEPS, assumed=True)
    heel_brake: Literal["recorded", "constant", "none"] = default(
        "recorded",
        "recorded",
        "the leg stops the landing heel as in a dry step; constant: all by slip.brake_time_mean; "
        "none: friction alone stops it",
    )
    brake_time_mean: Time = default(0.011, "11 ms", _MARKERS, assumed=True)
    brake_time_sd: TimeSpread = default(0.007, "7 ms", _MARKERS, assumed=True)
    rcof_step_sd: FrictionSpread = default(
        0.015, 0.015, "14 steps of six persons about their own mean (95 %: 0.010 to 0.030)"
    )
    weight_transfer_from: Transfer = default(0.35, 0.35, _SLIPS, assumed=True)
    weight_transfer_to: Transfer = default(0.75, 0.75, _SLIPS, assumed=True)
    shoe_angle_sd: AngleSpread = default(
        math.radians(4.0), "4 deg", f"angle at heel contact in the {_STEPS}", assumed=True
    )
    shoe_angle: Literal["held", "recorded"] = default(
        "held",
        "held",
        f"the heel stays on the floor and the foot inclined throughout a slip ({_REPORT}, G.5.1)",
        assumed=True,
    )
    sensor_rows: Count = default(3, 3, f"{_REPORT}, G.5.1")
    sensor_columns: Count = default(3, 3, f"{_REPORT}, G.5.1")
    sensor_spacing: Spacing = default(30e-3, "30 mm", f"{_REPORT}, G.5.1")
    sensor_inlet: Inlet = default(4e-3, "4 mm", f"{_REPORT}, G.5.1")
    landing_from: Place = default(0.0, "0 mm", _LANDING, assumed=True)
    landing_to: Place = default(0.02, "20 mm", _LANDING, assumed=True)
    lateral_sd: Width = default(0.01, "10 mm", "how well a step hits a line", assumed=True)
    time_step: Step = default(
        8e-3, "8 ms", "halving it moves peak speed by 0.5 %, peak pressure by 3 %"
    )
    fit_runs: Annotated[int, Field(ge=4, le=200, strict=True)] = default(
        12, 12, "full slips that the reduced model is fitted to"
    )
    test_runs: Annotated[int, Field(ge=1, le=100, strict=True)] = default(
        4, 4, "further full slips that it is tested on"
    )

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        return ("brake_time_mean", "brake_time_sd") if self.heel_brake == "none" else ()
