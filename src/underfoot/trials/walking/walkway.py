"""A recording of walking with what is resolved once: axes, body weight, feet, belts."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar
from warnings import warn

import numpy as np

from underfoot.core.constants import GRAVITY

from ..recording.axes import (
    LEVEL,
    Axes,
    Direction,
    Ramp,
    axes_of,
    heel_candidates,
    marker_velocity,
    pelvis_markers,
    toe_candidates,
    walking_direction,
)  # fmt: skip
from ..recording.plates import plate_named
from ..recording.trial import Marker, Plate, Trial
from .belts import Belt, belts_of

_BESIDE = 15.0  # s of a marker's path before and after a step on a belt
_AT_ONCE = 200_000  # samples of a long record that are looked through for standing
_STILL = 0.5  # s of quiet standing that give body weight
_STILL_SD, _STILL_SHEAR = 0.015, 0.03  # of the weight; walking varies by 20 % and pushes by 15 %


@dataclass(frozen=True, slots=True)
class BodyWeight:
    """Body weight (N) and where it comes from; ``standing`` when the record itself shows it."""

    newtons: float
    source: str
    standing: bool = False


def body_mass(trial: Trial) -> float | None:
    """Return the subject's mass (kg) written in the trial's settings, or None."""
    try:
        return float(trial.settings["body mass (kg)"])
    except (KeyError, ValueError):
        return None


def body_weight(trial: Trial, axes: Axes | None = None) -> BodyWeight | None:
    """Return the body weight: from the mass in the settings, else from quiet standing, else None.

    Quiet standing: half a second in which the vertical forces of all plates together vary by less
    than 1.5 % and push across by less than 3 % (on plates that measure along a ramp of angle a:
    across by the tangent of a, and the weight is normal force / cos a); the heaviest such level
    counts.
    """
    mass = body_mass(trial)
    if mass is not None:
        return BodyWeight(mass * GRAVITY, f"{mass:g} kg")
    axes = axes or axes_of(trial)
    up, ramp = axes.up, axes.ramp
    tilt = abs(ramp.angle) if ramp.plate_frame == "surface" else 0.0
    usable = [plate for plate in trial.plates if plate.usable]
    if not usable or len({(p.rate, len(p.force), p.start) for p in usable}) > 1:
        return None
    count, samples = round(_STILL * usable[0].rate), len(usable[0].force)
    if count < 5 or samples < 2 * count:
        return None
    heaviest = 0.0
    for begin in range(0, samples - count + 1, _AT_ONCE):
        part = slice(begin, begin + _AT_ONCE + count - 1)
        force = np.nan_to_num(np.sum([plate.force[part] for plate in usable], axis=0, dtype=float))
        heaviest = max(heaviest, _heaviest_still(force, count, up, math.tan(tilt)))
    if not heaviest:
        return None
    return BodyWeight(heaviest / math.cos(tilt), "standing in this record", standing=True)


def _heaviest_still(force: np.ndarray, count: int, up: np.ndarray, slope: float) -> float:
    """Largest mean normal force (N) of ``count`` samples (n, 3) of quiet standing; 0 without."""
    normal = force @ up
    across = force - np.outer(normal, up)
    values = np.column_stack((normal, normal**2, across))
    total = np.concatenate((np.zeros((1, 5)), np.cumsum(values, axis=0)))
    rolling = (total[count:] - total[:-count]) / count
    mean, squares = rolling[:, 0], rolling[:, 1]
    spread = np.sqrt(np.maximum(squares - mean**2, 0.0))
    push = np.abs(np.linalg.norm(rolling[:, 2:], axis=1) - mean * slope)
    still = (mean > 200.0) & (spread < _STILL_SD * mean) & (push < _STILL_SHEAR * mean)
    return float(mean[still].max(initial=0.0))


@dataclass(frozen=True, slots=True, eq=False)
class Walkway:
    """A trial on its walkway; ``walkway_of`` makes one.

    ``axes``: vertical, walking direction over the whole recording, slope. ``weight``: of the body,
    None when nothing tells it. ``heels`` and ``toes``: name of the best-seen marker by side;
    ``pelvis``: side of each marker of the pelvis by its name. ``belts``: by the name of their
    plate, none on a floor. ``walking`` is the axis that a person set.
    """

    trial: Trial
    axes: Axes
    weight: BodyWeight | None
    heels: Mapping[str, str]
    toes: Mapping[str, str]
    pelvis: Mapping[str, str] = field(default_factory=dict)
    belts: Mapping[str, Belt] = field(default_factory=dict)
    walking: str | None = None

    @property
    def up(self) -> np.ndarray:
        """Vertical unit vector (3,)."""
        return self.axes.up

    def plate(self, name: str) -> Plate:
        """Return the plate of that name."""
        return plate_named(self.trial, name)

    def surface_velocity(self, plate: str, time: float) -> np.ndarray:
        """Return the velocity (3,) of a plate's surface at a time: zero but for belts (m/s)."""
        belt = self.belts.get(plate)
        return np.zeros(3) if belt is None else belt.velocity(time)

    def marker(self, name: str, plate: str, time: float) -> Marker:
        """Return a marker as seen from a plate's surface, in laboratory axes at ``time`` (s).

        On a belt the 15 s before and after.
        """
        marker = self.trial.marker(name)
        if plate not in self.belts:
            return marker
        near = marker.frames(time - _BESIDE, time + _BESIDE)
        moments, places = marker.time[near], marker.positions[near]
        begin = float(moments[0]) if len(moments) else marker.start
        return replace(
            marker,
            positions=places - np.outer(moments - time, self.surface_velocity(plate, time)),
            start=begin,
            times=None if marker.times is None else moments,
        )

    def body_velocity(
        self, plate: str, begin: float, end: float, *, climb: bool = False
    ) -> np.ndarray | None:
        """Return the velocity (3,) of the body over a plate's surface between two times (m/s).

        In the plane of the floor, or with its vertical part (``climb``); None without markers.
        """
        body = marker_velocity(self.trial, begin, end, None if climb else self.up)
        return None if body is None else body - self.surface_velocity(plate, begin)

    def surface(self, plate: str, time: float) -> dict[str, str]:
        """Return the surface under a plate's contact (level, a ramp, a belt), a belt's speed."""
        belt, ground = self.belts.get(plate), self.axes.ramp.description
        if belt is None:
            return {"surface": ground}
        return {"surface": f"treadmill belt, {ground}", "belt": belt.speed_text(time)}

    @property
    def surfaces(self) -> str:
        """The surface of every plate in words."""
        belts = [
            f"{plate}: treadmill belt at {belt.speed_text(belt.times.mean())}"
            for plate, belt in self.belts.items()
        ]
        return "; ".join([*belts, self.axes.ramp.description])

    def direction(self, plate: Plate, start: int, stop: int) -> Direction:
        """Return the walking direction during a contact and how it was found."""
        if plate.name in self.belts and not self.walking:
            return self.belts[plate.name].direction(plate.start + start / plate.rate)
        return walking_direction(self.trial, plate, start, stop, self.up, self.walking)


def walkway_of(
    trial: Trial,
    *,
    vertical: str | None = None,
    walking: str | None = None,
    ramp: Ramp = LEVEL,
    landmarks: Mapping[str, str] | None = None,
) -> Walkway:
    """Return a trial with its axes, body weight, feet and belts resolved.

    ``vertical`` and ``walking`` are overrides such as ``"z"``, ``"+x"``; ``landmarks``
    are a laboratory's own names of markers with their places ("left heel"); ``ramp`` is the slope
    of the walkway. An axis that is none is an InputError, a place without marker a DataError.
    """
    axes = axes_of(trial, vertical=vertical, walking=walking, ramp=ramp)
    best = (
        {side: names[0] for side, names in found.items() if names}
        for found in (
            heel_candidates(trial, landmarks, axes.up),
            toe_candidates(trial, landmarks, axes.up),
        )
    )
    heel, toe = best
    feet = [trial.marker(name) for name in (*heel.values(), *toe.values())]
    belts = belts_of(trial, axes.up, [foot for foot in feet if foot.times is None])
    pelvis = pelvis_markers(trial, landmarks)
    return Walkway(trial, axes, body_weight(trial, axes), heel, toe, pelvis, belts, walking)


P = ParamSpec("P")
R = TypeVar("R")


def of_walkway(
    function: Callable[Concatenate[Walkway, P], R],
) -> Callable[Concatenate[Walkway, P], R]:
    """Let a function of a walkway take a trial too, with a warning, until version 0.5."""

    @wraps(function)
    def answer(walk: Walkway, *arguments: P.args, **options: P.kwargs) -> R:
        if isinstance(walk, Trial):
            call = f"{function.__name__}(walkway_of(trial))"
            warn(f"{call} resolves a trial once; a trial itself goes in 0.5", FutureWarning, 2)
            walk = walkway_of(walk)
        return function(walk, *arguments, **options)

    return answer
