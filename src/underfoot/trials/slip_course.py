"""What happens around a slip: recovery or fall, the toe, the trailing foot, missteps."""

import re
from dataclasses import dataclass

import numpy as np

from .axes import Axes, toe_candidates
from .filters import MARKER_FILTER, bridged, low_passed
from .gait_context import foot_angle
from .measurement import Flag
from .outcome import OutcomeLimits
from .slips import Slip
from .stance import Stance
from .trial import Marker, Trial

FALL = 0.8  # of the pelvis's height before contact; assumed: a recovering walker squats less
_RISEN = 0.93  # of it, at which the walker stands again; assumed
_AFTER = 1.5  # s looked at after contact
_TOE_FIRST = np.radians(-5.0)
_PELVIS = re.compile(r"asis?$|psis?$|pelv|sacr|troch|hip$|(^|[ _.:\-])[lr]?v?sac", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class SlipCourse:
    """How a slip went on; lengths in m, None where markers don't tell.

    ``body`` is "recovery", "fall" or empty, with the reason in ``body_reason``; ``toe_slip`` the
    way of the toe between 40 and 80 % of a stance whose heel did not slide, ``trailing_slip``
    that of the other foot while it stood, between contact and the slip's end; ``misstep`` says in
    words how the foot came down wrongly.
    """

    body: str = ""
    body_reason: str = ""
    toe_slip: float | None = None
    trailing_slip: float | None = None
    misstep: str = ""
    flags: tuple[Flag, ...] = ()


def slip_course(
    trial: Trial, stance: Stance, one: Slip, axes: Axes, limits: OutcomeLimits | None = None
) -> SlipCourse:
    """Return what happened around a slip (or a step without one)."""
    limits = limits or OutcomeLimits()
    body, why = _body(trial, one, axes)
    toe = None if one.slides else _toe_way(trial, stance, axes)
    trailing = _trailing_way(trial, stance, one, axes)
    misstep = _misstep(trial, stance, axes)
    flags = []
    for name, way, words in (
        ("toe slip", toe, "the toe slides by {:.0f} mm: a toe slip"),
        ("trailing foot", trailing, "the trailing foot slides by {:.0f} mm"),
    ):
        if way is not None and way > limits.microslip:
            flags.append(Flag(name, words.format(1e3 * way), True, way, limits.microslip, "m"))
    if misstep:
        flags.append(Flag("misstep", f"misstep: {misstep}"))
    return SlipCourse(body, why, toe, trailing, misstep, tuple(flags))


def _body(trial: Trial, one: Slip, axes: Axes) -> tuple[str, str]:
    """Recovery or fall by the height of the pelvis's markers."""
    if not one.slides:
        return "", "no slide to recover from"
    markers = [
        marker
        for name, marker in trial.markers.items()
        if _PELVIS.search(name.rsplit(":", 1)[-1].strip()) and marker.times is None
    ]
    if not markers:
        return "", "no marker of the pelvis"
    time = markers[0].time
    heights = np.array([m.positions @ axes.up for m in markers if len(m.positions) == len(time)])
    seen = np.isfinite(heights).any(axis=0)
    if not seen.any():
        return "", "no marker of the pelvis is seen"
    height = np.full(len(time), np.nan)
    height[seen] = np.nanmean(heights[:, seen], axis=0)
    before = height[(time > one.contact - 0.6) & (time < one.contact)]
    after = height[(time >= one.contact) & (time < one.contact + _AFTER)]
    if not (np.isfinite(before).any() and np.isfinite(after).any()):
        return "", "the pelvis is not seen before and after contact"
    usual, lowest = float(np.nanmedian(before)), float(np.nanmin(after))
    share = f"the pelvis goes down to {100 * lowest / usual:.0f} % of its height"
    if lowest < FALL * usual:
        return "fall", f"{share}; a fall below {100 * FALL:.0f} % (assumed)"
    if float(after[np.isfinite(after)][-1]) < _RISEN * usual:
        return "", f"{share} and is not up again when the record ends"
    return "recovery", share


def _toe_way(trial: Trial, stance: Stance, axes: Axes) -> float | None:
    marker = _toe(trial, stance.side)
    begin, end = (stance.contact + share * stance.duration for share in (0.4, 0.8))
    return None if marker is None else _way(marker, begin, end, axes)


def _toe(trial: Trial, side: str) -> Marker | None:
    toes = toe_candidates(trial)[side] if side != "unknown" else []
    return trial.marker(toes[0]) if toes else None


def _trailing_way(trial: Trial, stance: Stance, one: Slip, axes: Axes) -> float | None:
    marker = _toe(trial, {"left": "right", "right": "left"}.get(stance.side, "unknown"))
    if marker is None or not np.isfinite(one.end):
        return None
    # The trailing foot stands on its toe until it lifts.
    height = marker.positions @ axes.up
    inside = (marker.time >= stance.contact) & (marker.time <= one.end)
    known = inside & np.isfinite(height)
    if known.sum() < 3:
        return None
    up = known & (height > np.nanmin(height[known]) + 0.03)
    end = float(marker.time[up][0]) if up.any() else one.end
    return _way(marker, stance.contact, end, axes)


def _way(marker: Marker, begin: float, end: float, axes: Axes) -> float | None:
    """Largest displacement (m) in the floor's plane from ``begin`` until ``end``."""
    if marker.times is not None:
        return None
    path, _ = bridged(marker.positions, round(0.1 * marker.rate))
    near = (marker.time > begin - 0.3) & (marker.time < end + 0.3)
    path, time = path[near], marker.time[near]
    if len(path) < 30 or not np.isfinite(path).all() or marker.rate < 2.3 * MARKER_FILTER.cutoff:
        return None
    path = low_passed(path, marker.rate, MARKER_FILTER)
    flat = path - np.outer(path @ axes.up, axes.up)
    inside = (time >= begin) & (time <= end)
    if inside.sum() < 2:
        return None
    return float(np.linalg.norm(flat[inside] - flat[inside][0], axis=1).max())


def _misstep(trial: Trial, stance: Stance, axes: Axes) -> str:
    angle = foot_angle(trial, stance, axes)
    if angle is not None and angle[1][0] < _TOE_FIRST:
        return f"the toe comes down first ({np.degrees(angle[1][0]):.0f} deg)"
    return ""
