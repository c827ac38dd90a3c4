"""Contacts with a force plate: when they begin and end, and which of them are steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from .axes import TREADMILL, Axes, axes_of, heel_candidates, walking_direction
from .baseline import runs
from .plates import plate_axes
from .trial import Plate, Trial

CONTACT_FORCE = 20.0  # N
_SHORTEST, _LONGEST = 0.35, 1.5  # s; runners are below, standing and two feet above
_TOGETHER = 0.1  # s; two contacts of a walk begin half a second apart
_FOOT_LENGTH, _FOOT_WIDTH = 0.36, 0.14  # m, the most that the centre of pressure of one foot moves
_GRAVITY = 9.80665
_OUTSIDE = 0.05  # m; the marker sits behind the shoe, so a heel at the edge is a little outside


@dataclass(frozen=True, slots=True)
class Stance:
    """One contact with one plate; ``reason`` says why it is no step, and is empty when it is.

    ``start`` and ``stop`` are sample numbers of the plate (stop excluded), ``contact`` and
    ``toe_off`` the times (s). ``walking`` is the direction (3,) or None.
    """

    plate: str
    start: int
    stop: int
    contact: float
    toe_off: float
    peak: float
    reason: str = ""
    side: str = "unknown"
    heel: str = ""
    walking: np.ndarray | None = None
    walking_from: str = ""
    flags: tuple[str, ...] = ()

    @property
    def accepted(self) -> bool:
        """True when the contact is one whole step."""
        return not self.reason

    @property
    def duration(self) -> float:
        """Length of the contact (s)."""
        return self.toe_off - self.contact


def contacts(
    vertical: np.ndarray, rate: float, threshold: float = CONTACT_FORCE
) -> list[tuple[int, int]]:
    """Return (start, stop) of the stretches in which a plate is stood on, shape of samples.

    A stretch begins where the vertical force (n,), N, passes ``threshold`` and counts when it
    lasts 30 ms and reaches five times the threshold; interruptions below 20 ms are bridged.
    """
    loaded = np.nan_to_num(vertical, nan=0.0) > threshold
    for start, stop in runs(~loaded):
        if start > 0 and stop < len(loaded) and stop - start < 0.02 * rate:
            loaded[start:stop] = True
    return [
        (start, stop)
        for start, stop in runs(loaded)
        if stop - start >= 0.03 * rate and np.nanmax(vertical[start:stop]) > 5.0 * threshold
    ]


def stances(
    trial: Trial,
    *,
    axes: Axes | None = None,
    walking: str | None = None,
    heels: Mapping[str, str] | None = None,
    threshold: float = CONTACT_FORCE,
) -> list[Stance]:
    """Return every contact with every usable plate, each accepted or rejected with a reason.

    Rejected are contacts cut by the record, too short or too long, two that begin together (a
    jump, or one foot on two plates), two feet on one plate, partial hits, impacts, saturated
    plates, samples without numbers, and contacts without a braking phase or while nobody walks.
    """
    axes = axes or axes_of(trial)
    found: list[tuple[Plate, Stance]] = []
    for plate in trial.plates:
        if not plate.usable:
            continue
        vertical = plate.force @ axes.up
        for start, stop in contacts(vertical, plate.rate, threshold):
            direction, how = walking_direction(trial, plate, start, stop, axes.up, walking)
            found.append(
                (
                    plate,
                    Stance(
                        plate.name,
                        start,
                        stop,
                        plate.start + start / plate.rate,
                        plate.start + stop / plate.rate,
                        float(np.nanmax(vertical[start:stop])),
                        walking=direction,
                        walking_from=how,
                    ),
                )
            )
    found.sort(key=lambda pair: pair[1].contact)
    whole = [s.peak for _, s in found]
    judged = []
    for plate, stance in found:
        side, heel = _foot(trial, plate, stance, axes, heels)
        stance = replace(stance, side=side, heel=heel)
        others = [s for _, s in found if s is not stance and s.plate != stance.plate]
        reason = _reason(trial, plate, stance, others, whole, axes, heels)
        judged.append(replace(stance, reason=reason))
    return judged


def _reason(
    trial: Trial,
    plate: Plate,
    stance: Stance,
    others: list[Stance],
    peaks: list[float],
    axes: Axes,
    heels: Mapping[str, str] | None,
) -> str:
    part = plate.force[stance.start : stance.stop]
    vertical = part @ axes.up
    if stance.start == 0:
        return "begins before the record"
    if stance.stop == len(plate.force):
        return "ends after the record"
    if not np.isfinite(part).all():
        return "samples without a number"
    if any("saturated" in note for note in plate.notes):
        return "the plate is saturated"
    if stance.duration < _SHORTEST:
        return f"lasts {1e3 * stance.duration:.0f} ms: too short for a walking step"
    if stance.duration > _LONGEST:
        return f"lasts {stance.duration:.2f} s: standing, or more than one foot"
    near = [o for o in others if abs(o.contact - stance.contact) < _TOGETHER]
    if near:
        gap = 1e3 * abs(near[0].contact - stance.contact)
        return f"begins {gap:.0f} ms from one on {near[0].plate}: one foot on both, or a jump"
    mass = body_mass(trial)
    expected = mass * _GRAVITY if mass else 0.9 * float(np.median(peaks))
    if stance.peak < 0.7 * expected:
        of = "body weight" if mass else "the usual peak"
        return f"peak {stance.peak:.0f} N is {100 * stance.peak / expected:.0f} % of {of}: partial"
    ratio = stance.peak / float(vertical.mean())
    if ratio > 2.2 or (mass and stance.peak > 2.0 * expected):
        return (
            f"peak {stance.peak:.0f} N, {ratio:.1f} times the mean: an impact, not a walking step"
        )
    two = _two_feet(trial, plate, stance, axes, heels)
    if two:
        return two
    outside = _heel_outside(trial, plate, stance, axes, heels)
    if outside > _OUTSIDE:
        return f"the heel stands {1e3 * outside:.0f} mm outside the plate: a partial hit"
    if stance.walking is None:
        return f"no walking direction: {stance.walking_from}"
    along = part @ stance.walking
    braking = -float(np.minimum(along[: len(along) // 2], 0.0).sum()) / plate.rate
    if braking < 0.01 * stance.peak * stance.duration:
        return "no braking in its first half: not a heel-first step"
    return ""


def body_mass(trial: Trial) -> float | None:
    """Return the subject's mass (kg) written in the trial's settings, or None."""
    try:
        return float(trial.settings["body mass (kg)"])
    except (KeyError, ValueError):
        return None


def _two_feet(
    trial: Trial, plate: Plate, stance: Stance, axes: Axes, heels: Mapping[str, str] | None
) -> str:
    seen = _heels_on_plate(trial, plate, stance, axes, heels)
    if "left" in seen and "right" in seen:
        return "both heels are on the plate"
    place = plate.centre_of_pressure
    if place is None or stance.walking is None or stance.walking_from == TREADMILL:
        return ""
    vertical = plate.force[stance.start : stance.stop] @ axes.up
    firm = vertical > 0.2 * stance.peak
    inside = place[stance.start : stance.stop][firm]
    inside = inside[np.isfinite(inside).all(axis=1)]
    if len(inside) < 10:
        return ""
    along = float(np.ptp(inside @ stance.walking))
    sideways = float(np.ptp(inside @ np.cross(axes.up, stance.walking)))
    if along > _FOOT_LENGTH or sideways > _FOOT_WIDTH + 0.5 * along * _turning(trial):
        return (
            f"the centre of pressure moves {1e3 * along:.0f} mm along and {1e3 * sideways:.0f} mm "
            "across: more than one foot"
        )
    return ""


def _turning(trial: Trial) -> float:
    """A foot set down at an angle to the path lets the centre of pressure move across."""
    return 1.0 if trial.markers else 0.5


def _heels_on_plate(
    trial: Trial, plate: Plate, stance: Stance, axes: Axes, heels: Mapping[str, str] | None
) -> dict[str, tuple[str, float]]:
    """Sides whose heel marker stays over the plate, low and slow, for 100 ms of the stance."""
    if plate.corners is None:
        return {}
    # In the plate's own axes: a plate that stands askew in the laboratory is no larger for it.
    own = plate_axes(plate.corners)[:, :2]
    middle = plate.corners.mean(axis=0)
    reach = np.abs((plate.corners - middle) @ own).max(axis=0) + 0.02
    found = {}
    for side, names in heel_candidates(trial, heels).items():
        for name in names[:1]:
            marker = trial.marker(name)
            time, at = marker.time, marker.positions
            height = at @ axes.up
            if not np.isfinite(height).any():
                continue
            inside = (time >= stance.contact) & (time <= stance.toe_off) & ~marker.missing
            inside &= (np.abs((at - middle) @ own) <= reach).all(axis=1)
            inside &= height < np.nanmin(height) + 0.06
            speed = np.linalg.norm(np.gradient(at, 1.0 / marker.rate, axis=0), axis=1)
            inside &= np.nan_to_num(speed, nan=9.0) < 0.8
            if inside.sum() >= 0.1 * marker.rate:
                found[side] = (name, float(inside.sum()))
    return found


def _foot(
    trial: Trial, plate: Plate, stance: Stance, axes: Axes, heels: Mapping[str, str] | None
) -> tuple[str, str]:
    seen = _heels_on_plate(trial, plate, stance, axes, heels)
    if seen:
        side = max(seen, key=lambda key: seen[key][1])
        return side, seen[side][0]
    landing = _landing_heel(trial, plate, stance, axes, heels)
    if landing[1]:
        return landing
    place = plate.centre_of_pressure
    if place is None:
        return "unknown", ""
    # Without corners: the heel nearest to where the centre of pressure begins.
    early = place[stance.start : stance.start + max(5, (stance.stop - stance.start) // 5)]
    early = early[np.isfinite(early).all(axis=1)]
    best, distance = ("unknown", ""), 0.15
    for side, names in heel_candidates(trial, heels).items():
        for name in names[:1]:
            marker = trial.marker(name)
            inside = (marker.time >= stance.contact) & (marker.time <= stance.contact + 0.2)
            inside &= ~marker.missing
            if len(early) and inside.any():
                gap = np.median(marker.positions[inside], axis=0) - np.median(early, axis=0)
                away = float(np.linalg.norm(gap - (gap @ axes.up) * axes.up))
                if away < distance:
                    best, distance = (side, name), away
    return best


def _heel_outside(
    trial: Trial, plate: Plate, stance: Stance, axes: Axes, heels: Mapping[str, str] | None
) -> float:
    """How far outside the plate (m) a heel stands within a foot's length of the first pressure.

    Zero when a heel stands on the plate, or when nothing is known. Standing: low and slow for
    40 ms from contact.
    """
    place = plate.centre_of_pressure
    if plate.corners is None or place is None or _heels_on_plate(trial, plate, stance, axes, heels):
        return 0.0
    early = place[stance.start : stance.start + max(5, round(0.05 * plate.rate))]
    early = early[np.isfinite(early).all(axis=1)]
    if not len(early):
        return 0.0
    own = plate_axes(plate.corners)[:, :2]
    middle = plate.corners.mean(axis=0)
    half = np.abs((plate.corners - middle) @ own).max(axis=0)
    found = 0.0
    for names in heel_candidates(trial, heels).values():
        for name in names[:1]:
            marker = trial.marker(name)
            at = marker.positions
            inside = (marker.time >= stance.contact) & (marker.time <= stance.contact + 0.04)
            inside &= ~marker.missing
            if inside.sum() < 2:
                continue
            stand = np.median(at[inside], axis=0)
            speed = float(np.linalg.norm(np.ptp(at[inside], axis=0))) / 0.04
            low = float(stand @ axes.up - np.nanmin(at @ axes.up)) < 0.06
            gap = stand - np.median(early, axis=0)
            near = float(np.linalg.norm(gap - (gap @ axes.up) * axes.up)) < _FOOT_LENGTH
            if speed < 0.8 and low and near:
                beyond = np.abs((stand - middle) @ own) - half
                found = max(found, float(np.linalg.norm(np.maximum(beyond, 0.0))))
    return found


def _landing_heel(
    trial: Trial, plate: Plate, stance: Stance, axes: Axes, heels: Mapping[str, str] | None
) -> tuple[str, str]:
    """The lower of the heels that are low over the plate at contact: a slipping heel is fast."""
    if plate.corners is None:
        return "unknown", ""
    own = plate_axes(plate.corners)[:, :2]
    middle = plate.corners.mean(axis=0)
    reach = np.abs((plate.corners - middle) @ own).max(axis=0) + 0.1
    best, lowest = ("unknown", ""), 0.06
    for side, names in heel_candidates(trial, heels).items():
        for name in names[:1]:
            marker = trial.marker(name)
            near = np.abs(marker.time - stance.contact) < max(0.03, 1.0 / marker.rate)
            near &= ~marker.missing
            if not near.any():
                continue
            place = np.median(marker.positions[near], axis=0)
            lift = float(place @ axes.up - np.nanmin(marker.positions @ axes.up))
            if lift < lowest and (np.abs((place - middle) @ own) <= reach).all():
                best, lowest = (side, name), lift
    return best
