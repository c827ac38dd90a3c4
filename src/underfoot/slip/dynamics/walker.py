"""A person who takes a step, and a population of them."""

import math
from dataclasses import dataclass, field

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.constants import GRAVITY
from underfoot.core.remark import Message

from .gait import GaitHistory, packaged_histories

REFERENCE_SPEED = 1.35
"""m/s, mean walking speed of the recorded steps that know it; taken for those that don't."""

HEEL_BRAKES = ("recorded", "constant", "none")
BRAKE_TIME = 0.011
"""s, in which a landing heel loses its speed by e: mean of the ten recorded steps that tell."""


@dataclass(frozen=True, slots=True)
class Walker:
    """One person's step onto the floor; SI.

    Parameters:
        history: Load and shear ratio against time of a dry step.
        mass: Of the body, kg.
        rcof: Required coefficient of friction as measured over several steps, 0 to 1.
        rcof_step: What this step asks more than ``rcof``, 1; the history's ratio is scaled to their
            sum.
        heel_speed: Forward speed of the heel at contact, m/s.
        shoe_angle: rad, toe up positive.
        walking_speed: m/s; the history is stretched in time to it. None keeps its length.
        effective_mass: Share of the body's mass that moves with the slipping heel, 1.
        landing: Distance of the heel's rear end behind the first row of sensors at contact, m.
        lateral: Place of the heel's centre line to the left of the sensors' middle column, m.
        recorded_angle: Let the shoe angle fall as in the history (where it has one) instead of
            holding it.
        heel_brake: How the body stops the landing heel: "recorded", as in the history (where its
            heel velocity is known), "constant", with a time constant, or "none", not at all.
        brake_time: That time constant, s.
        weight_transfer: Share of the dry step's load that a slipping foot takes on, 0 to 1.

    Raises:
        InputError: A mass that is not positive, an RCOF outside 0 to 1, a negative heel speed.
    """

    history: GaitHistory
    mass: float = 70.0
    rcof: float = 0.20
    heel_speed: float = 0.34
    shoe_angle: float = math.radians(10)
    walking_speed: float | None = None
    effective_mass: float = 0.114
    landing: float = 0.01
    lateral: float = 0.0
    recorded_angle: bool = False
    rcof_step: float = 0.0
    heel_brake: str = "recorded"
    brake_time: float = BRAKE_TIME
    weight_transfer: float = 1.0
    name: str = "walker"

    def __post_init__(self) -> None:
        for label, value, low, high, allowed in (
            ("mass", self.mass, 5.0, 400.0, "5 to 400 kg"),
            ("rcof", self.rcof, 0.0, 1.0, "0 to 1"),
            ("heel_speed", self.heel_speed, 0.0, 6.0, "0 to 6 m/s"),
            ("effective_mass", self.effective_mass, 1e-3, 1.0, "0.001 to 1"),
            ("walking_speed", self.walking_speed or 1.0, 0.1, 6.0, "0.1 to 6 m/s"),
            ("rcof_step", self.rcof_step, -1.0, 1.0, "-1 to 1"),
            ("brake_time", self.brake_time, 1e-3, 1.0, "0.001 to 1 s"),
            ("weight_transfer", self.weight_transfer, 0.0, 1.0, "0 to 1"),
        ):
            if not low <= value <= high:
                raise InputError(f"{value:g}", where=f"walker.{label}", allowed=allowed)
        if self.heel_brake not in HEEL_BRAKES:
            raise unknown_name("brake", self.heel_brake, HEEL_BRAKES, where="walker.heel_brake")

    @property
    def moving_mass(self) -> float:
        """Mass of the slipping foot, kg."""
        return self.mass * self.effective_mass

    @property
    def step(self) -> GaitHistory:
        """The history as this person walks it: own RCOF, own length."""
        scaled = self.history.asking(min(max(self.rcof + self.rcof_step, 0.0), 1.0))
        if self.walking_speed is None:
            return scaled
        recorded_speed = self.history.walking_speed or REFERENCE_SPEED
        # the same step length: a faster walker is over the foot in less time
        return scaled.lasting(self.history.duration * recorded_speed / self.walking_speed)

    def demands(self, times: Array) -> tuple[Array, Array, Array]:
        """Return dry load (N), drive r F (N) and shoe angle (rad) at times since contact (s)."""
        step = self.step
        normal = np.interp(times, step.time, step.normal) * self.mass * GRAVITY
        drive = np.interp(times, step.time, step.ratio) * normal
        angle = np.full(np.shape(times), self.shoe_angle)
        if self.recorded_angle and step.foot_angle is not None:
            fall = np.interp(times, step.time, step.foot_angle) - step.foot_angle[0]
            angle = np.maximum(self.shoe_angle + fall, 0.0)
        return normal, drive, angle

    def dry_speed(self, times: Array) -> Array:
        """Return the heel's forward speed (m/s) on a dry floor at times since contact (s)."""
        step = self.step
        if self.heel_brake == "none":
            return np.full(np.shape(times), self.heel_speed)
        if self.heel_brake == "recorded" and step.landing is not None:
            return self.heel_speed * np.interp(times, step.time, step.landing)
        return self.heel_speed * np.exp(-times / self.brake_time)


@dataclass(frozen=True, slots=True)
class Spread:
    """Normal distribution, cut at ``low`` and ``high``, with its source."""

    mean: float
    sd: float
    low: float = -math.inf
    high: float = math.inf
    source: str = ""
    assumed: bool = True

    def __post_init__(self) -> None:
        if not (math.isfinite(self.mean) and math.isfinite(self.sd) and self.sd >= 0):
            raise InputError(f"{self.mean:g} ± {self.sd:g}", where="spread", allowed="sd 0 or more")
        if not self.low <= self.mean <= self.high:
            raise InputError(
                Message("a mean of {mean:g}", mean=self.mean),
                where="spread",
                allowed=Message("{low:g} to {high:g}", low=self.low, high=self.high),
            )

    def draw(self, count: int, generator: np.random.Generator) -> Array:
        """Return ``count`` values; those beyond the cuts are drawn again."""
        values = generator.normal(self.mean, self.sd, count)
        for _ in range(100):
            beyond = (values < self.low) | (values > self.high)
            if not beyond.any():
                break
            values[beyond] = generator.normal(self.mean, self.sd, int(beyond.sum()))
        return np.clip(values, self.low, self.high)


WEIGHT_TRANSFER = (0.35, 0.75)
"""Largest load in unexpected slips, 0.40 to 0.85 body weights, over that of dry steps, 1.1."""
_STEPS = "13 steps of dry walking with heel markers that come with the package (slip_dynamics.md)"


@dataclass(frozen=True, slots=True)
class Population:
    """Who walks: distributions of what differs between persons, drawn independently.

    ``mass``, ``rcof``, ``walking_speed``, ``heel_speed`` and ``shoe_angle`` are normal and cut;
    so are ``rcof_step`` and ``brake_time``. ``history`` is drawn from ``histories``; ``landing``
    and ``weight_transfer`` are uniform. ``effective_mass`` is one number for all (assumed).
    """

    subjects: int = 40
    seed: int = 1
    histories: tuple[GaitHistory, ...] = field(default_factory=packaged_histories)
    mass: Spread = Spread(
        70.0, 11.8, 35.0, 140.0, "final progress report on shoe-floor friction, G.5.1", False
    )
    rcof: Spread = Spread(0.20, 0.03, 0.05, 1.0, "see slip_probability.md")
    walking_speed: Spread = Spread(1.35, 0.18, 0.7, 2.2, _STEPS)
    heel_speed: Spread = Spread(0.33, 0.12, 0.02, 1.0, _STEPS)
    shoe_angle: Spread = Spread(
        math.radians(10), math.radians(4), math.radians(2), math.radians(18)
    )
    landing: tuple[float, float] = (0.0, 0.02)
    lateral: Spread = Spread(0.0, 0.01, -0.03, 0.03, "assumption")
    effective_mass: float = 0.114
    recorded_angle: bool = False
    rcof_step: Spread = Spread(0.0, 0.015, -0.2, 0.2, "14 steps of six persons", False)
    brake_time: Spread = Spread(BRAKE_TIME, 0.007, 0.004, 0.04, "10 steps with heel and toe")
    heel_brake: str = "recorded"
    weight_transfer: tuple[float, float] = WEIGHT_TRANSFER

    def __post_init__(self) -> None:
        if self.subjects < 1 or int(self.subjects) != self.subjects:
            raise InputError(
                Message("{subjects} subjects", subjects=self.subjects),
                where="slip.subjects",
                allowed="1 or more",
            )
        if not self.histories:
            raise InputError("no gait history", where="slip.histories", allowed="1 or more")
        if self.mass.low <= 0 or not 0 <= self.rcof.low <= self.rcof.high <= 1:
            raise InputError("mass above 0, RCOF 0 to 1", where="slip")

    def walkers(self) -> tuple[Walker, ...]:
        """Return the persons; the same seed gives the same, and more subjects the same first."""
        return tuple(self.walker(i) for i in range(self.subjects))

    def walker(self, index: int) -> Walker:
        """Return one person."""
        generator = np.random.default_rng([self.seed, index])

        def draw_value(spread: Spread) -> float:
            return float(spread.draw(1, generator)[0])

        return Walker(
            history=self.histories[int(generator.integers(len(self.histories)))],
            mass=draw_value(self.mass),
            rcof=draw_value(self.rcof),
            walking_speed=draw_value(self.walking_speed),
            heel_speed=draw_value(self.heel_speed),
            shoe_angle=draw_value(self.shoe_angle),
            landing=float(generator.uniform(*self.landing)),
            lateral=draw_value(self.lateral),
            effective_mass=self.effective_mass,
            recorded_angle=self.recorded_angle,
            rcof_step=draw_value(self.rcof_step),
            brake_time=draw_value(self.brake_time),
            heel_brake=self.heel_brake,
            weight_transfer=float(generator.uniform(*self.weight_transfer)),
            name=f"subject {index + 1}",
        )
