"""The full model: the sole's own contact and film under a slipping foot, and its runs on disk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Cache, Progress, Status, content_hash, silent
from underfoot.core.arrays import Array
from underfoot.core.constants import GRAVITY
from underfoot.core.remark import Message
from underfoot.friction import FrictionLaw
from underfoot.rough_contact import PressureGapLaw
from underfoot.shoe.geometry import SoleMap
from underfoot.sole_contact.compliance import Compliance
from underfoot.sole_contact.lug_edges import EdgedLaw
from underfoot.sole_contact.sole_state import SoleState, SolverSettings
from underfoot.sole_contact.stepping import SlidingSole, rolled_sole

from .motion import COLUMNS, STEP, Instant, SlipMotion, slip_motion
from .sensors import MAP_X, MAP_Y, sensor_map
from .walker import Walker

TYPICAL_SPEED = 0.5  # m/s, of a slip: the friction that turns edges of lugs is that at it
LOWEST_SPEED = 1e-3
"""m/s; slower than that friction is taken as at this speed."""


@dataclass(frozen=True, slots=True)
class Setting:
    """Everything about shoe, floor and fluid that a slip needs; nothing about the person.

    ``sole`` is the undeformed sole at ``shoe_angle``; ``viscosity`` None is a dry floor. ``edged``
    is ``friction`` with what the edges of lugs do; None without lugs or film.
    """

    sole: SoleMap
    compliance: Compliance
    asperities: PressureGapLaw
    friction: FrictionLaw
    viscosity: float | None
    settings: SolverSettings
    shoe_angle: float
    key: str = ""
    edged: EdgedLaw | None = None


@dataclass(frozen=True, slots=True)
class SoleInstant:
    """Contact and film of the whole sole at an instant."""

    state: SoleState
    law: FrictionLaw | EdgedLaw

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
        slow = max(speed, LOWEST_SPEED)
        at = state.finest
        law = self.law.on(at) if isinstance(self.law, EdgedLaw) else self.law
        parts = law(at.contact_pressure, slow, at.film_thickness)
        area, touching = at.areas["area"], at.contact_pressure > 0
        solid = ((parts.adhesion + parts.hysteresis) * area)[touching].sum()
        viscous = (parts.viscous * area)[at.wet].sum() * (speed / slow)
        return float(solid + viscous) * state.spacing**2


class SoleFoot:
    """A fresh sole above the floor, at a walker's shoe angle."""

    def __init__(self, setting: Setting, shoe_angle: float, load: float = 500.0) -> None:
        sole = rolled_sole(setting.sole, shoe_angle - setting.shoe_angle)
        self._law = setting.edged or setting.friction
        self._sliding = SlidingSole(
            sole,
            setting.compliance,
            setting.asperities,
            viscosity=setting.viscosity,
            settings=setting.settings,
            shoe_angle=shoe_angle,
            typical_force=load,
            inlet=setting.edged and setting.edged.inlet(load, TYPICAL_SPEED),
        )

    def advance(
        self, duration: float, *, normal_force: float, speed: float, shoe_angle: float
    ) -> SoleInstant:
        """Carry contact and film on."""
        state = self._sliding.advance(
            duration, normal_force=normal_force, speed=speed, shoe_angle=shoe_angle
        )
        return SoleInstant(state, self._law)

    def settle_load(self, *, normal_force: float, speed: float) -> SoleInstant:
        """Carry on at constant load and speed until nothing moves."""
        return SoleInstant(self._sliding.settle(normal_force=normal_force, speed=speed), self._law)


ROOM = "slip-6"


@dataclass(frozen=True, slots=True)
class FullRun:
    """A full slip with what sensors and drawings need.

    ``maps`` (n, len(MAP_X), len(MAP_Y)) is the pressure that a floor sensor reads at places of the
    sole's frame at ``motion.time``; ``areas`` (n,) the loaded area; ``profiles`` (n, nx) the film
    along the centre line at ``profile_x``; ``peaks`` (n,) the highest film pressure anywhere;
    ``extremes`` (2,) the highest contact pressure (Pa) and the thinnest film under load (m).
    """

    motion: SlipMotion
    maps: NDArray[np.float32]
    areas: Array
    peaks: Array
    profiles: NDArray[np.float32]
    profile_x: Array
    extremes: Array

    def area_rows(self) -> list[tuple[float, float, float]]:
        """Return (load, shoe angle, area) of every instant under load."""
        motion = self.motion
        return [
            (float(f), float(a), float(s))
            for f, a, s in zip(motion.normal, motion.shoe_angle, self.areas, strict=True)
            if f > 0 and s > 0
        ]


def full_run(
    setting: Setting,
    walker: Walker,
    *,
    inlet_diameter: float = 4e-3,
    step: float = STEP,
    cache: Cache | None = None,
    progress: Progress = silent,
) -> FullRun:
    """Return one slip with contact and film carried under the whole sole.

    With a ``cache`` and a ``setting.key`` a run that was done before is read back.
    """
    # who walks, not where the sensors lie
    person = replace(walker, landing=0.0, lateral=0.0, name="")
    key = content_hash(setting.key, person, inlet_diameter, step)[:40]
    if cache is not None and setting.key:
        stored = cache.load(key)
        if stored is not None:
            return _run_of_arrays(stored, walker)
    run = _compute_run(setting, walker, inlet_diameter, step, progress)
    if cache is not None and setting.key and run.motion.status is Status.CONVERGED:
        cache.store(key, _arrays_of_run(run))
    return run


def full_runs(
    setting: Setting,
    walkers: Sequence[Walker],
    *,
    inlet_diameter: float = 4e-3,
    step: float = STEP,
    cache: Cache | None = None,
    progress: Progress = silent,
) -> list[FullRun]:
    """Return the full slips of several walkers, one after the other, each stored when done."""

    def progress_of(number: int) -> Progress:
        def report(stage: str, fraction: float, residual: float | None = None) -> None:
            done = (number + fraction) / len(walkers)
            slip = Message("Slip {number} of {count}", number=number + 1, count=len(walkers))
            progress(slip, done, residual)

        return report

    return [
        full_run(
            setting,
            walker,
            inlet_diameter=inlet_diameter,
            step=step,
            cache=cache,
            progress=progress_of(number),
        )
        for number, walker in enumerate(walkers)
    ]


def pressed_area(load: Array, pressure: Array, spacing: float) -> float:
    """Return the area (m^2) that would bear a sole's load evenly at its mean pressure.

    The mean is over the load: ``load`` (Pa, per area of a whole cell of ``spacing`` m) weights
    ``pressure`` (Pa); 0 of no load.
    """
    square = float((load * pressure).sum())
    return float(load.sum()) ** 2 / square * spacing**2 if square > 0 else 0.0


def _compute_run(
    setting: Setting, walker: Walker, inlet: float, step: float, progress: Progress
) -> FullRun:
    zero = np.zeros((MAP_X.size, MAP_Y.size), dtype=np.float32)
    line = int(np.argmin(np.abs(setting.sole.y)))
    empty = np.full(setting.sole.x.size, np.nan, dtype=np.float32)
    maps, areas, peaks, profiles = [zero], [0.0], [0.0], [empty]
    extremes = np.array([0.0, np.inf])

    def observe(time: float, instant: Instant) -> None:
        assert isinstance(instant, SoleInstant)
        state = instant.state
        maps.append(sensor_map(state, inlet).astype(np.float32))
        areas.append(pressed_area(state.cell_load, state.total_pressure, state.spacing))
        peaks.append(float(state.fluid_pressure.max()))
        profiles.append(state.film_thickness[:, line].astype(np.float32))
        extremes[0] = max(extremes[0], float(state.contact_pressure.max()))
        extremes[1] = min(extremes[1], float(state.film_thickness[setting.sole.inside].min()))

    load = float(walker.step.normal.max() * walker.mass * GRAVITY)
    motion = slip_motion(
        walker,
        SoleFoot(setting, walker.shoe_angle, load),
        step=step,
        observe=observe,
        progress=progress,
    )
    count = motion.time.size
    return FullRun(
        motion,
        np.array(maps[:count]),
        np.array(areas[:count]),
        np.array(peaks[:count]),
        np.array(profiles[:count]),
        np.asarray(setting.sole.x),
        extremes,
    )


def _arrays_of_run(run: FullRun) -> dict[str, object]:
    motion = run.motion
    return {
        **{name: getattr(motion, name) for name in COLUMNS},
        "maps": run.maps.astype(np.float32),
        "areas": run.areas,
        "peaks": run.peaks,
        "profiles": run.profiles,
        "profile_x": run.profile_x,
        "notes": np.array(motion.notes, dtype=str),
        "extremes": run.extremes,
    }


def _run_of_arrays(stored: dict[str, np.ndarray], walker: Walker) -> FullRun:
    motion = SlipMotion(
        walker,
        **{name: stored[name] for name in COLUMNS},
        status=Status.CONVERGED,
        model="full",
        notes=tuple(str(n) for n in stored["notes"]),
    )
    names = ("maps", "areas", "peaks", "profiles", "profile_x", "extremes")
    return FullRun(motion, **{name: stored[name] for name in names})
