"""Contacts with a force plate: when they begin and end, and which of them are steps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from .axes import Axes, DirectionSource, axes_of, heel_candidates, walking_direction
from .edits import TOGETHER, edited_contacts
from .plates import plate_axes
from .stance import CONTACT_FORCE, Stance, contacts
from .trial import Plate, Trial

_SHORTEST, _LONGEST = 0.35, 1.5  # s; runners are below, standing and two feet above
_FOOT_LENGTH, _FOOT_WIDTH = 0.36, 0.14  # m, the most that the centre of pressure of one foot moves
GRAVITY = 9.80665
_OUTSIDE = 0.05  # m; the marker sits behind the shoe, so a heel at the edge is a little outside
_STILL = 0.5  # s of quiet standing that give body weight
_STILL_SD, _STILL_SHEAR = 0.015, 0.03  # of the weight; walking varies by 20 % and pushes by 15 %


@dataclass(frozen=True, slots=True)
class BodyWeight:
    """Body weight (N) and where it comes from; ``standing`` when the record itself shows it."""

    newtons: float
    source: str
    standing: bool = False


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
    The trial's edits are applied first.

    Raises
    ------
    EditError
        An edit names no contact, changes nothing or contradicts another.
    """
    axes = axes or axes_of(trial)
    plates = {plate.name: plate for plate in trial.plates if plate.usable}
    found: list[Stance] = []
    for plate in plates.values():
        vertical = plate.force @ axes.up
        for start, stop in contacts(vertical, plate.rate, threshold):
            time = plate.start + np.array([start, stop]) / plate.rate
            peak = float(np.nanmax(vertical[start:stop]))
            found.append(Stance(plate.name, start, stop, float(time[0]), float(time[1]), peak))
    found.sort(key=lambda stance: stance.contact)
    found = [replace(stance, number=i) for i, stance in enumerate(found, start=1)]
    located = []
    for stance in found:
        plate = plates[stance.plate]
        way = walking_direction(trial, plate, stance.start, stance.stop, axes.up, walking)
        stance = replace(stance, direction=way)
        side, heel = _foot(trial, plate, stance, axes, heels)
        located.append(replace(stance, side=side, heel=heel))
    if trial.edits:
        located = edited_contacts(located, trial, axes.up)
        located = [_relocated(s, trial, plates[s.plate], axes, walking, heels) for s in located]
    weight = body_weight(trial, axes)
    judged = []
    for stance in located:
        others = [s for s in located if s.plate != stance.plate and not s.reason]
        peaks = [s.peak for s in located]
        reason = stance.reason or _reason(
            trial, plates[stance.plate], stance, others, peaks, axes, heels, weight
        )
        judged.append(replace(stance, reason=reason))
    return judged


def _relocated(
    stance: Stance,
    trial: Trial,
    plate: Plate,
    axes: Axes,
    walking: str | None,
    heels: Mapping[str, str] | None,
) -> Stance:
    """Return an edited contact with direction and heel of its new limits."""
    if not stance.by_hand or stance.reason:
        return stance
    way = walking_direction(trial, plate, stance.start, stance.stop, axes.up, walking)
    stance = replace(stance, direction=way)
    if "side" in stance.by_hand:
        names = heel_candidates(trial, heels)[stance.side]
        return replace(stance, heel=names[0] if names else "")
    side, heel = _foot(trial, plate, stance, axes, heels)
    return replace(stance, side=side, heel=heel)


def _reason(
    trial: Trial,
    plate: Plate,
    stance: Stance,
    others: list[Stance],
    peaks: list[float],
    axes: Axes,
    heels: Mapping[str, str] | None,
    weight: BodyWeight | None,
) -> str:
    part = plate.force[stance.start : stance.stop]
    vertical = part @ axes.up
    if stance.start == 0 and "contact" not in stance.by_hand:
        return "begins before the record"
    if stance.stop == len(plate.force):
        return "ends after the record"
    if not np.isfinite(part).all():
        return "samples without a number"
    if plate.saturated:
        return "the plate is saturated"
    if stance.duration < _SHORTEST:
        return f"lasts {1e3 * stance.duration:.0f} ms: too short for a walking step"
    if stance.duration > _LONGEST:
        return f"lasts {stance.duration:.2f} s: standing, or more than one foot"
    near = [o for o in others if abs(o.contact - stance.contact) < TOGETHER]
    if near:
        gap = 1e3 * abs(near[0].contact - stance.contact)
        return f"begins {gap:.0f} ms from one on {near[0].plate}: one foot on both, or a jump"
    expected = weight.newtons if weight else 0.9 * float(np.median(peaks))
    if stance.peak < 0.7 * expected:
        of = "body weight" if weight else "the usual peak"
        return f"peak {stance.peak:.0f} N is {100 * stance.peak / expected:.0f} % of {of}: partial"
    ratio = stance.peak / float(vertical.mean())
    if ratio > 2.2 or (weight and stance.peak > 2.0 * expected):
        times = f"{stance.peak / expected:.1f} times body weight" if weight else ""
        times = times or f"{ratio:.1f} times the mean"
        return f"peak {stance.peak:.0f} N, {times}: an impact, not a walking step"
    two = _two_feet(trial, plate, stance, axes, heels)
    if two:
        return two
    outside = _heel_outside(trial, plate, stance, axes, heels)
    if outside > _OUTSIDE:
        return f"the heel stands {1e3 * outside:.0f} mm outside the plate: a partial hit"
    if stance.walking is None:
        return f"no walking direction: {stance.direction.words}"
    # Walking up a slope, gravity along the surface hides the braking: it is sought horizontally.
    along = part @ axes.ramp.gravity(axes.up, stance.walking)[1]
    braking = -float(np.minimum(along[: len(along) // 2], 0.0).sum()) / plate.rate
    if braking < 0.01 * stance.peak * stance.duration:
        return "no braking in its first half: not a heel-first step"
    return ""


def no_contact_reason(trial: Trial, axes: Axes) -> str:
    """Return why a trial has no contact with a force plate: which of four causes it is."""
    usable = [plate for plate in trial.plates if plate.usable]
    if usable:
        peak = max(float(np.nanmax(plate.force @ axes.up, initial=0.0)) for plate in usable)
        rates = ", ".join(sorted({f"{plate.rate:g} Hz" for plate in usable}))
        return (
            f"nobody steps on a force plate: the largest vertical force is {peak:.3g} N and a step "
            f"needs {5 * CONTACT_FORCE:g} N for 30 ms (at {rates}; is the unit right?)"
        )
    problems = [f"{plate.name}: {plate.problem}" for plate in trial.plates if plate.problem]
    if problems:
        return "no force plate can be used: " + "; ".join(problems)
    names = ", ".join(list(trial.channels)[:8])
    if any("cof" in name.casefold() or "friction" in name.casefold() for name in trial.channels):
        return f"a log of friction ({names}) without force plates: choose a protocol for testers"
    if names:
        return f"no columns are recognised as force plates ({names}): name them in a profile"
    return "the file holds no force plate"


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
    force = np.nan_to_num(np.sum([plate.force for plate in usable], axis=0))
    count = round(_STILL * usable[0].rate)
    if len(force) < 2 * count:
        return None
    normal = force @ up
    across = force - np.outer(normal, up)

    def rolling(values: np.ndarray) -> np.ndarray:
        total = np.concatenate(([0.0], np.cumsum(values)))
        return (total[count:] - total[:-count]) / count

    mean = rolling(normal)
    spread = np.sqrt(np.maximum(rolling(normal**2) - mean**2, 0.0))
    push = np.sqrt(sum(rolling(across[:, i]) ** 2 for i in range(3)))
    push = np.abs(push - mean * math.tan(tilt))
    still = (mean > 200.0) & (spread < _STILL_SD * mean) & (push < _STILL_SHEAR * mean)
    if not still.any():
        return None
    newtons = float(mean[still].max()) / math.cos(tilt)
    return BodyWeight(newtons, "standing in this record", standing=True)


def _two_feet(
    trial: Trial, plate: Plate, stance: Stance, axes: Axes, heels: Mapping[str, str] | None
) -> str:
    seen = _heels_on_plate(trial, plate, stance, axes, heels)
    if "left" in seen and "right" in seen:
        return "both heels are on the plate"
    place = plate.centre_of_pressure
    if (
        place is None
        or stance.walking is None
        or stance.direction.source is DirectionSource.TREADMILL
    ):
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
