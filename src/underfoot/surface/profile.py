"""A measured height profile."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError
from underfoot.core.units import metres

from .height_map import check_heights, check_length


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Heights of a surface along a line, evenly spaced.

    Parameters:
        heights: m, (n,), n >= 2, positive away from the solid.
        spacing: m.
        tip_radius: m, of the stylus, where known.
        resolution: m, shortest wavelength the instrument resolves, where known.
        periodic: True when the last point continues at the first one.
        source: Instrument or file.
        processing: What was done to the heights, in order.

    Raises:
        InputError: Missing heights, not one-dimensional, spacing not positive.
    """

    heights: np.ndarray
    spacing: float
    tip_radius: float | None = None
    resolution: float | None = None
    periodic: bool = False
    source: str = ""
    processing: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        heights = np.array(self.heights, dtype=float)
        if heights.ndim != 1 or heights.size < 2:
            raise InputError(
                f"heights of shape {heights.shape}", where="heights", allowed="(n,), 2 or more"
            )
        check_heights(heights)
        check_length("spacing", self.spacing)
        for name, value in (("tip_radius", self.tip_radius), ("resolution", self.resolution)):
            if value is not None:
                check_length(name, value)
        heights.setflags(write=False)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "spacing", float(self.spacing))
        object.__setattr__(self, "processing", tuple(self.processing))

    @property
    def positions(self) -> np.ndarray:
        """x from the first point, m, (n,)."""
        return self.spacing * np.arange(self.heights.size)

    @property
    def length(self) -> float:
        """Length covered, m: n times the spacing."""
        return self.heights.size * self.spacing

    def section(self, start: float, end: float) -> Profile:
        """Return the part with start <= x <= end (m from the first point).

        Raises:
            InputError: A part outside the profile or with fewer than two points.
        """
        x, slack = self.positions, 1e-9 * self.spacing
        inside = (x >= start - slack) & (x <= end + slack)
        if start < -slack or end > x[-1] + 0.5 * self.spacing + slack or inside.sum() < 2:
            raise InputError(
                f"part from {metres(start)} to {metres(end)}",
                where="section",
                allowed=f"within 0 m to {metres(x[-1])}, two points or more",
            )
        return self.changed(
            self.heights[inside],
            f"cut to {metres(start)} to {metres(end)}",
            periodic=False,
        )

    def changed(self, heights: np.ndarray, done: str, **changes: object) -> Profile:
        """Return a profile with new heights and one more line in ``processing``."""
        return replace(
            self,
            heights=heights,
            processing=(*self.processing, done),
            **changes,  # type: ignore[arg-type]  # field names are checked by replace itself
        )


def profile_from_positions(
    positions: ArrayLike,
    heights: ArrayLike,
    *,
    resample: bool = False,
    rounding: float = 0.0,
    tip_radius: float | None = None,
    source: str = "",
) -> Profile:
    """Return a profile from heights at given positions.

    Positions count as even when none is off an even grid by more than 1 % of the spacing, or by
    ``rounding`` (m, half the last printed digit). Uneven ones are refused, unless ``resample``:
    then heights are interpolated linearly to an even grid with as many points, and the profile
    says so.

    Raises:
        DataError: Positions missing, not ascending, uneven without ``resample``, heights missing.
    """
    x, z = np.asarray(positions, dtype=float), np.asarray(heights, dtype=float)
    if x.ndim != 1 or x.shape != z.shape or x.size < 2:
        raise DataError(
            f"{x.size} positions and {z.size} heights",
            where=source or "profile",
            allowed="the same number of each, two or more",
        )
    if not np.all(np.isfinite(x)):
        raise DataError(
            f"{int(np.sum(~np.isfinite(x)))} positions are missing", where=source or "profile"
        )
    steps = np.diff(x)
    if np.all(steps < 0.0):
        x, z, steps = x[::-1], z[::-1], -steps[::-1]
    if np.any(steps <= 0.0) and not (np.all(steps >= 0.0) and rounding > 0.0):
        i = int(np.flatnonzero(steps <= 0.0)[0])
        raise DataError(
            f"position {i + 2} ({metres(x[i + 1])}) does not follow {metres(x[i])}",
            where=source or "profile",
            allowed="ascending positions",
        )
    index = np.arange(x.size)
    # The ends alone would carry their rounding into every point.
    spacing, start = np.polyfit(index, x, 1) if x.size > 2 else (x[1] - x[0], x[0])
    off = float(np.abs(x - start - spacing * index).max())
    if off <= max(0.01 * spacing, rounding * (1.0 + 1e-6)):
        note = ()
        if off > 0.01 * spacing:
            note = (
                f"positions, rounded in print to {metres(2.0 * rounding)}, taken as even: "
                f"{metres(spacing)}",
            )
        return Profile(z, float(spacing), tip_radius=tip_radius, source=source, processing=note)
    if not resample:
        raise DataError(
            f"positions are uneven: up to {metres(off)} off a grid of {metres(spacing)}",
            where=source or "profile",
            remedy="Ask for resampling (resample=True); the result then says so",
        )
    check_heights(z)
    even = np.linspace(x[0], x[-1], x.size)
    return Profile(
        np.interp(even, x, z),
        float(even[1] - even[0]),
        tip_radius=tip_radius,
        source=source,
        processing=(
            f"resampled linearly to an even spacing of {metres(even[1] - even[0])} "
            f"(positions were up to {metres(off)} off)",
        ),
    )
