"""Measured or generated heights along a line or on a square grid, and what they resolve."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self, cast

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError
from underfoot.core.checks import host_array
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres


class Heights:
    """What profiles and maps have in common."""

    __slots__ = ()
    axes: ClassVar[int]
    heights: np.ndarray
    spacing: float
    periodic: bool
    resolution: float | None
    processing: tuple[str, ...]

    def __post_init__(self) -> None:
        given = host_array(self.heights, "heights", "an array of NumPy")
        heights = np.array(given, dtype=float)
        if heights.ndim != self.axes or min(heights.shape) < 2:
            raise InputError(
                Message("heights of shape {shape}", shape=str(heights.shape)),
                where="heights",
                allowed=f"{'(n,)' if self.axes == 1 else '(nx, ny)'}, 2 or more",
            )
        check_heights(heights)
        for name in ("spacing", "spacing_y", "tip_radius", "resolution"):
            if (value := getattr(self, name, None)) is not None:
                check_length(name, value)
        heights.setflags(write=False)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "spacing", float(self.spacing))
        object.__setattr__(self, "processing", tuple(self.processing))

    @property
    def spacings(self) -> tuple[float, ...]:
        """Distance between points along each axis, m."""
        return (self.spacing,)

    def replace_heights(self, heights: np.ndarray, done: str, **changes: Any) -> Self:
        """Return the surface with new heights and one more line in ``processing``."""
        processing = (*self.processing, done)
        return replace(cast("Any", self), heights=heights, processing=processing, **changes)

    changed = renamed_member("changed", "replace_heights", gone="0.4")


@dataclass(frozen=True, slots=True, eq=False)
class HeightMap(Heights):
    """Heights of a surface on a grid of square or oblong cells.

    Parameters:
        heights: m, (nx, ny); axis 0 along sliding (x), axis 1 across (y), positive away from the
            solid.
        spacing: m, along x, and along y too where ``spacing_y`` is not given.
        periodic: True when the right edge continues at the left one and the far edge at the near
            one.
        resolution: m, shortest wavelength the instrument resolves; None when not known (then the
            grid decides).
        source: Instrument, file or generator.
        processing: What was done to the heights, in order.
        spacing_y: m, along y, of oblong cells; contact solvers need square ones
            (``underfoot.surface.square_cells``).

    Raises:
        InputError: Missing heights, not two-dimensional, fewer than 2 points a side, spacing not
            positive.
    """

    axes: ClassVar[int] = 2
    heights: np.ndarray
    spacing: float
    periodic: bool = False
    resolution: float | None = None
    source: str = ""
    processing: tuple[str, ...] = ()
    spacing_y: float | None = None

    @property
    def spacings(self) -> tuple[float, float]:
        """Distance between points along x and y, m."""
        return self.spacing, self.spacing if self.spacing_y is None else self.spacing_y

    @property
    def shape(self) -> tuple[int, int]:
        """Number of points along x and y."""
        return self.heights.shape[0], self.heights.shape[1]

    @property
    def size(self) -> tuple[float, float]:
        """Lengths covered along x and y, m: n times the spacing."""
        return self.shape[0] * self.spacings[0], self.shape[1] * self.spacings[1]

    @property
    def rms_height(self) -> float:
        """Standard deviation of the heights, m, about their own mean."""
        return float(np.std(self.heights))


@dataclass(frozen=True, slots=True, eq=False)
class Profile(Heights):
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

    axes: ClassVar[int] = 1
    heights: np.ndarray
    spacing: float
    tip_radius: float | None = None
    resolution: float | None = None
    periodic: bool = False
    source: str = ""
    processing: tuple[str, ...] = ()

    @property
    def positions(self) -> np.ndarray:
        """x from the first point, m, (n,)."""
        return self.spacing * np.arange(self.heights.size)

    @property
    def length(self) -> float:
        """Length covered, m: n times the spacing."""
        return self.heights.size * self.spacing

    def section(self, start: float, end: float) -> Self:
        """Return the part with start <= x <= end (m from the first point).

        Raises:
            InputError: A part outside the profile or with fewer than two points.
        """
        x, slack = self.positions, 1e-9 * self.spacing
        inside = (x >= start - slack) & (x <= end + slack)
        if start < -slack or end > x[-1] + 0.5 * self.spacing + slack or inside.sum() < 2:
            raise InputError(
                Message("part from {start} to {end}", start=metres(start), end=metres(end)),
                where="section",
                allowed=Message("within 0 m to {metres}, two points or more", metres=metres(x[-1])),
            )
        done = Message("cut to {low} to {high}", low=metres(start), high=metres(end))
        return self.replace_heights(self.heights[inside], done, periodic=False)


def check_heights(heights: np.ndarray) -> None:
    """Refuse missing or infinite heights, saying how many and where the first one is."""
    bad = ~np.isfinite(heights)
    if bad.any():
        first = tuple(int(i) for i in np.argwhere(bad)[0])
        raise InputError(
            Message(
                "{count} of {total} heights are missing or infinite, the first at {first}",
                count=int(bad.sum()),
                total=heights.size,
                first=str(first),
            ),
            where="heights",
            allowed="a finite height at every point",
            remedy="Fill them (underfoot.surface.fill_missing_heights) or cut them away; the "
            "result then says so",
        )


def check_length(name: str, value: float) -> None:
    """Refuse a length that is not a positive number."""
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{name} {metres(value)}", where=name, allowed="a length above 0 m")


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

    Parameters:
        positions: m, ascending, (n,).
        heights: m, (n,).
        resample: Interpolate uneven positions.
        rounding: Half the last printed digit of positions, m.
        tip_radius: Of the stylus, m; None where it is not known.
        source: Where the heights are from.

    Raises:
        DataError: Positions missing, not ascending, uneven without ``resample``, heights missing.
    """
    where = source or "profile"
    x, z = np.asarray(positions, dtype=float), np.asarray(heights, dtype=float)
    if x.ndim != 1 or x.shape != z.shape or x.size < 2:
        raise DataError(
            Message("{size} positions and {z_size} heights", size=x.size, z_size=z.size),
            where=where,
            allowed="the same number of each, two or more",
        )
    if not np.all(np.isfinite(x)):
        raise DataError(
            Message("{sum} positions are missing", sum=int(np.sum(~np.isfinite(x)))), where=where
        )
    steps = np.diff(x)
    if np.all(steps < 0.0):
        x, z, steps = x[::-1], z[::-1], -steps[::-1]
    if np.any(steps <= 0.0) and not (np.all(steps >= 0.0) and rounding > 0.0):
        i = int(np.flatnonzero(steps <= 0.0)[0])
        raise DataError(
            Message(
                "position {number} ({position}) does not follow {before}",
                number=i + 2,
                position=metres(x[i + 1]),
                before=metres(x[i]),
            ),
            where=where,
            allowed="ascending positions",
        )
    index = np.arange(x.size)
    # The ends alone would carry their rounding into every point.
    spacing, start = np.polyfit(index, x, 1) if x.size > 2 else (x[1] - x[0], x[0])
    off = float(np.abs(x - start - spacing * index).max())
    done: tuple[str, ...] = ()
    if off > max(0.01 * spacing, rounding * (1.0 + 1e-6)):
        if not resample:
            raise DataError(
                Message(
                    "positions are uneven: up to {most} off a grid of {spacing}",
                    most=metres(off),
                    spacing=metres(spacing),
                ),
                where=where,
                remedy="Export evenly spaced positions, or ask for resampling in Python "
                "(resample=True); the result then says so",
            )
        check_heights(z)
        even = np.linspace(x[0], x[-1], x.size)
        z, spacing = np.interp(even, x, z), even[1] - even[0]
        done = (
            Message(
                "resampled linearly to an even spacing of {spacing} (positions were up to "
                "{most} off)",
                spacing=metres(spacing),
                most=metres(off),
            ),
        )
    elif off > 0.01 * spacing:
        done = (
            Message(
                "positions, rounded in print to {step}, taken as even: {spacing}",
                step=metres(2.0 * rounding),
                spacing=metres(spacing),
            ),
        )
    return Profile(z, float(spacing), tip_radius=tip_radius, source=source, processing=done)


POINTS_PER_WAVE = 5
"""ISO 3274:1996 pairs a short cut-off of 2.5 um with a spacing of at most 0.5 um."""


@dataclass(frozen=True, slots=True)
class Resolution:
    """Shortest wavelength, m, that can be believed, and why not a shorter one."""

    wavelength: float
    reason: str


def shortest_reliable_wavelength(surface: Heights) -> Resolution:
    """Return the shortest wavelength that can be believed: the largest of three limits.

    - five points to a wave (ISO 3274), or two where the resolution is known;
    - the instrument's own resolution, where the surface knows it;
    - the tip: the scale below which the sharpest peak met at that scale is sharper than half the
      curvature of the stylus, where its radius is known (criterion of Sanner et al., Appl. Surf.
      Sci. Adv. 7 (2022) 100190: shortest stencil from which on the largest negative second
      difference stays below 1 / (2 R)).

    >>> from underfoot.surface import sinusoidal
    >>> shortest_reliable_wavelength(sinusoidal(64, 1e-6, 1e-6, 32e-6)).wavelength
    3.2e-05
    """
    known = surface.resolution
    limits = [_sampling(surface, POINTS_PER_WAVE if known is None else 2)]
    if known is not None:
        limits.append(Resolution(known, "resolution of the instrument"))
    radius = surface.tip_radius if isinstance(surface, Profile) else None
    if radius is not None:
        reason = Message(
            "radius of the tip, {radius:.4g} m: sharper peaks are rounded", radius=radius
        )
        limits.append(Resolution(_tip_limit(surface.heights, surface.spacing, radius), reason))
    return max(limits, key=lambda limit: limit.wavelength)


def shortest_derivable_wavelength(surface: Heights) -> Resolution:
    """Return the limit for slopes and curvatures by differences: five points to a wave at least."""
    limits = (shortest_reliable_wavelength(surface), _sampling(surface, POINTS_PER_WAVE))
    return max(limits, key=lambda limit: limit.wavelength)


def _sampling(surface: Heights, points: int) -> Resolution:
    spacing = max(surface.spacings)  # the coarser axis decides for waves in every direction
    reason = Message(
        "{points} points to a wave at a spacing of {metres}", points=points, metres=metres(spacing)
    )
    return Resolution(points * spacing, reason)


def _tip_limit(heights: np.ndarray, spacing: float, radius: float) -> float:
    reaches = np.unique(np.geomspace(1, max(heights.size // 3, 1), 60).astype(int))
    limit = 0.0
    for k, following in zip(reaches, [*reaches[1:], reaches[-1]], strict=True):
        second = (heights[2 * k :] - 2.0 * heights[k:-k] + heights[: -2 * k]) / (k * spacing) ** 2
        if second.size and float(-second.min()) > 0.5 / radius:
            limit = 2.0 * float(following) * spacing
    return limit
