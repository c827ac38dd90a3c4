"""Which side of an outsole is the ground's, which end the heel's, and which foot it is for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.outsole._kernels.pieces import shrunk, without_specks

from .settings import DIRECTIONS, FileSettings
from .view import View

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_TREAD_SHARE = 0.03  # of the plan form: fewer channels tell nothing
_TREAD_RATIO = 1.5  # channels on the ground's side against the other
_RIM_RISE = 0.5e-3  # m by which a ground side's rim must turn up more than the other's
_SHEET = 0.05e-3  # m between both sides: a scan of one side
_OFF_CENTRE = 0.005  # of the length: less tells nothing
_BEND = 0.006  # of the length


@dataclass(frozen=True, slots=True)
class Found:
    """A decision: its sign (1 keep, -1 turn) and how it came about, in words."""

    sign: int
    words: str


def ground_side(seen: View, settings: FileSettings) -> Found:
    """Return whether the ground is below the view (1) or above it (-1).

    In turn: the side the user names; the side with more channels (by area, narrower than 16 mm, 0.3
    to 12 mm deep); the side whose rim turns away (rounded edges, toe spring, side walls); for a
    surface without thickness the side its normals point to; else the file's own lower side.
    """
    if settings.down in DIRECTIONS:
        return Found(-1, "")
    found = _ground_side(seen)
    if settings.down == "flip":
        return Found(-found.sign, "The ground side was turned over, as asked.")
    return found


def _ground_side(seen: View) -> Found:
    below, above = seen.lowest, -seen.highest
    covered = seen.covered
    thin = np.median((seen.highest - seen.lowest)[covered]) < _SHEET
    turned = float(np.count_nonzero(seen.facing > 0)) / max(1, np.count_nonzero(covered))
    rise = _rim_rise(below) - _rim_rise(above)
    if not thin:
        shares = [channel_share(height, seen.spacing) for height in (below, above)]
        most, least = max(shares), min(shares)
        if most > _TREAD_SHARE and most > _TREAD_RATIO * least:
            sign = 1 if shares[0] > shares[1] else -1
            return Found(
                sign,
                f"The ground side was found by its tread: channels over {most:.0%} of it, "
                f"{least:.0%} on the other side.",
            )
    if abs(rise) > _RIM_RISE:
        words = "The ground side was found by its rim, which turns up from the floor."
        return Found(1 if rise > 0 else -1, words)
    if thin and abs(turned - 0.5) > 0.25:
        words = "The ground side was taken as the one the normals of the scan point to."
        return Found(1 if turned < 0.5 else -1, words)
    return Found(
        1 if _file_side(seen) else -1,
        "Assumed: the ground side is the lower one of the file; both sides look alike.",
    )


def _file_side(seen: View) -> bool:
    """Return whether the view's down is the file's -z, -y or -x (its largest component)."""
    up = seen.axes[2]
    return bool(up[int(np.argmax(np.abs(up)))] > 0)


def channel_share(height: Array, spacing: float) -> float:
    """Return the share of the plan form that is channel: narrower than 16 mm, 0.3 to 12 mm deep."""
    from underfoot.outsole.tread_map import tread_map

    filled = np.where(np.isfinite(height), height, np.nan)
    found = tread_map(filled, spacing)
    depth = np.where(np.isfinite(filled), filled - found.base, 0.0)
    inside = np.isfinite(filled)
    channel = inside & ~found.land & (depth < 12e-3)
    return float(np.count_nonzero(channel)) / max(1, np.count_nonzero(inside))


def _rim_rise(height: Array) -> float:
    """Return how much higher the outermost ring is than the land within, m."""
    inside = without_specks(np.isfinite(height), 50)
    core = shrunk(inside, 2)
    ring = inside & ~core
    if not core.any() or not ring.any():
        return 0.0
    # the same low percentile on both: a ring half of channels is no rim that turns up
    return float(np.percentile(height[ring], 20) - np.percentile(height[core], 20))


def toe_end(plan: Mask, settings: FileSettings) -> Found:
    """Return whether the toe is at the far end of axis 0 (1) or at the near one (-1).

    The toe side is the heavier one: the area's centroid lies beyond the middle, both on a whole
    sole (the forepart is broader) and on a heel piece (its rear is rounded).
    """
    if settings.forward in DIRECTIONS:
        return Found(1, "")
    offset = off_centre(plan, 0)
    if settings.forward == "flip":
        return Found(-1 if offset > 0 else 1, "Heel and toe were swapped, as asked.")
    if abs(offset) < _OFF_CENTRE:
        return Found(1, "Assumed: which end is the heel; both look alike.")
    return Found(
        1 if offset > 0 else -1,
        "The heel end was found by the plan form, which is rounder or narrower there.",
    )


def off_centre(plan: Mask, axis: int) -> float:
    """Return the offset of the plan form's centroid from its middle, in lengths along ``axis``."""
    counts = plan.sum(axis=1 - axis).astype(float)
    places = np.nonzero(counts)[0]
    middle = (places[0] + places[-1]) / 2
    centroid = float((np.arange(counts.size) * counts).sum() / counts.sum())
    return (centroid - middle) / (places[-1] - places[0] + 1)


def shown_foot(plan: Mask, spacing: float, settings: FileSettings) -> tuple[str, str]:
    """Return "left", "right" or "" (can't be told) and how it was found.

    The middle line of a sole bends towards the inner side of the foot: c, the coefficient of
    y = a + b x + c x^2 through the middles of its rows (x along, y to the left), is positive for a
    right foot. Told when the sagitta |c| L^2 / 4 is more than 0.6 % of the length L.
    """
    if settings.foot != "auto":
        return settings.foot, ""
    rows = np.nonzero(plan.any(axis=1))[0]
    rows = rows[int(0.03 * rows.size) : rows.size - int(0.03 * rows.size)]
    y = np.arange(plan.shape[1], dtype=float)
    middle = [(y[plan[row]].min() + y[plan[row]].max()) / 2 for row in rows]
    length = float(rows[-1] - rows[0])
    bend = float(np.polyfit(rows / length, middle, 2)[0]) / 4 / length
    if abs(bend) < _BEND:
        return "", "Which foot it is for can't be told: the plan form is nearly symmetric."
    foot = "right" if bend > 0 else "left"
    return foot, f"It is for the {foot} foot, by the bend of the plan form."
