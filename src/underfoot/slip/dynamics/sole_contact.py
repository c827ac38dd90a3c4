"""The sole's own contact and film under a slipping foot (the full model)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import Status

if TYPE_CHECKING:
    from underfoot.asperity.law import PressureGapLaw
    from underfoot.friction import FrictionLaw
    from underfoot.outsole.compliance import Compliance
    from underfoot.outsole.geometry import SoleMap
    from underfoot.outsole.sole_state import SoleState, SolverSettings

LOWEST_SPEED = 1e-3
"""m/s; slower than that friction is taken as at this speed."""


@dataclass(frozen=True, slots=True)
class Setting:
    """Everything about shoe, floor and fluid that a slip needs; nothing about the person.

    ``sole`` is the undeformed sole at ``shoe_angle``; ``viscosity`` None is a dry floor.
    """

    sole: SoleMap
    compliance: Compliance
    asperities: PressureGapLaw
    friction: FrictionLaw
    viscosity: float | None
    settings: SolverSettings
    shoe_angle: float
    key: str = ""


@dataclass(frozen=True, slots=True)
class SoleInstant:
    """Contact and film of the whole sole at an instant."""

    state: SoleState
    law: FrictionLaw

    @property
    def fluid_load(self) -> float:
        """Load carried by the fluid, N."""
        return self.state.fluid_load

    @property
    def usable(self) -> bool:
        """False when the solver gave up."""
        return self.state.status is Status.CONVERGED

    def friction(self, speed: float) -> float:
        """Return the friction force at a sliding speed with pressures and film as they are, N."""
        state = self.state
        felt = state.wet | (state.contact_pressure > 0)
        parts = self.law(
            state.contact_pressure[felt], max(speed, LOWEST_SPEED), state.film_thickness[felt]
        )
        solid = parts.adhesion + parts.hysteresis
        viscous = np.where(state.wet[felt], parts.viscous, 0.0) * (speed / max(speed, LOWEST_SPEED))
        return float((solid + viscous).sum()) * state.spacing**2


class SoleFoot:
    """A fresh sole above the floor, at a walker's shoe angle."""

    def __init__(self, setting: Setting, shoe_angle: float, load: float = 500.0) -> None:
        from underfoot.outsole.stepping import SlidingSole, rolled_clearance

        rolled = rolled_clearance(setting.sole, shoe_angle - setting.shoe_angle)
        sole = replace(setting.sole, clearance=rolled)
        self._law = setting.friction
        self._sliding = SlidingSole(
            sole,
            setting.compliance,
            setting.asperities,
            viscosity=setting.viscosity,
            settings=setting.settings,
            shoe_angle=shoe_angle,
            typical_force=load,
        )

    def advance(
        self, duration: float, *, normal_force: float, speed: float, shoe_angle: float
    ) -> SoleInstant:
        """Carry contact and film on."""
        state = self._sliding.advance(
            duration, normal_force=normal_force, speed=speed, shoe_angle=shoe_angle
        )
        return SoleInstant(state, self._law)

    def settled(self, *, normal_force: float, speed: float) -> SoleInstant:
        """Carry on at constant load and speed until nothing moves."""
        return SoleInstant(self._sliding.settle(normal_force=normal_force, speed=speed), self._law)
