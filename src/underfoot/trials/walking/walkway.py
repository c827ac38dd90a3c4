"""A recording of walking with what is resolved once: axes, body weight, feet, belts, contacts."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar
from warnings import warn

import numpy as np

from ..recording.axes import (
    LEVEL,
    Axes,
    Direction,
    Ramp,
    axes_of,
    marker_velocity,
)
from ..recording.marker_names import heel_candidates, pelvis_markers, toe_candidates
from ..recording.plates import Contact, plate_contacts, plate_named
from ..recording.trial import Marker, Plate, Trial
from .belts import Belt, belts_of, contact_direction
from .body_weight import BodyWeight, body_weight


@dataclass(frozen=True, slots=True, eq=False)
class Walkway:
    """A trial on its walkway; ``walkway_of`` makes one.

    ``axes``: vertical, walking direction over the whole recording, slope. ``weight``: of the body,
    None when nothing tells it. ``heels`` and ``toes``: name of the best-seen marker by side;
    ``pelvis``: side of each marker of the pelvis by its name. ``belts``: by the name of their
    plate, none on a floor. ``walking`` is the axis that a person set. ``contacts``: with each
    usable plate, and the walking direction in each.
    """

    trial: Trial
    axes: Axes
    weight: BodyWeight | None
    heels: Mapping[str, str]
    toes: Mapping[str, str]
    pelvis: Mapping[str, str] = field(default_factory=dict)
    belts: Mapping[str, Belt] = field(default_factory=dict)
    walking: str | None = None
    contacts: Mapping[Plate, tuple[tuple[Contact, Direction], ...]] = field(default_factory=dict)

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
        marker, belt = self.trial.marker(name), self.belts.get(plate)
        return marker if belt is None else belt.carry_back(marker, time)

    def body_velocity(
        self, plate: str, begin: float, end: float, *, climb: bool = False
    ) -> np.ndarray | None:
        """Return the velocity (3,) of the body over a plate's surface between two times (m/s).

        In the plane of the floor, or with its vertical part (``climb``); None without markers.
        """
        body = marker_velocity(self.trial, begin, end, None if climb else self.up)
        return None if body is None else body - self.surface_velocity(plate, begin)

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
        contact = Contact(plate, start, stop, self.up)
        more = self.belts, self.walking, self.axes.body
        return contact_direction(self.trial, contact, *more)

    def contacts_above(
        self, plate: Plate, threshold: float
    ) -> tuple[tuple[Contact, Direction], ...]:
        """Return the ``contacts`` with a plate above another vertical force (N)."""
        contacts, more = plate_contacts(plate, self.up, threshold), (self.belts, self.walking)
        return tuple(
            (contact, contact_direction(self.trial, contact, *more, self.axes.body))
            for contact in contacts
        )


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
    heel, toe = (
        {side: names[0] for side, names in candidates.items() if names}
        for candidates in (
            heel_candidates(trial, landmarks, axes.up),
            toe_candidates(trial, landmarks, axes.up),
        )
    )
    pelvis = pelvis_markers(trial, landmarks)
    feet = [trial.markers[name] for name in (*heel.values(), *toe.values())]
    usable = [plate for plate in trial.plates if plate.usable]
    contacts = {plate: plate_contacts(plate, axes.up) for plate in usable}
    weight = body_weight(trial, axes)
    belts = belts_of(contacts, axes.body, [foot for foot in feet if foot.times is None])
    told = belts, walking, axes.body
    directed = {
        plate: tuple((each, contact_direction(trial, each, *told)) for each in found)
        for plate, found in contacts.items()
    }
    return Walkway(trial, axes, weight, heel, toe, pelvis, belts, walking, directed)


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
