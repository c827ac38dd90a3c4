"""A measured or generated height map."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from underfoot.core import InputError
from underfoot.core.units import metres


@dataclass(frozen=True, slots=True, eq=False)
class HeightMap:
    """Heights of a surface on a square grid.

    Parameters:
        heights: m, (nx, ny); axis 0 along sliding (x), axis 1 across (y), positive away from the
            solid.
        spacing: m, the same along both axes.
        periodic: True when the right edge continues at the left one and the far edge at the near
            one.
        resolution: m, shortest wavelength the instrument resolves; None when not known (then the
            grid decides).
        source: Instrument, file or generator.
        processing: What was done to the heights, in order.

    Raises:
        InputError: Missing heights, not two-dimensional, fewer than 2 points a side, spacing not
            positive.
    """

    heights: np.ndarray
    spacing: float
    periodic: bool = False
    resolution: float | None = None
    source: str = ""
    processing: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        heights = np.array(self.heights, dtype=float)
        if heights.ndim != 2 or min(heights.shape) < 2:
            raise InputError(
                f"heights of shape {heights.shape}", where="heights", allowed="(nx, ny), 2 or more"
            )
        check_heights(heights)
        check_length("spacing", self.spacing)
        if self.resolution is not None:
            check_length("resolution", self.resolution)
        heights.setflags(write=False)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "spacing", float(self.spacing))
        object.__setattr__(self, "processing", tuple(self.processing))

    @property
    def shape(self) -> tuple[int, int]:
        """Number of points along x and y."""
        return self.heights.shape[0], self.heights.shape[1]

    @property
    def size(self) -> tuple[float, float]:
        """Lengths covered along x and y, m: n times the spacing."""
        return self.shape[0] * self.spacing, self.shape[1] * self.spacing

    @property
    def rms_height(self) -> float:
        """Standard deviation of the heights, m, about their own mean."""
        return float(np.std(self.heights))

    def changed(self, heights: np.ndarray, done: str, **changes: object) -> HeightMap:
        """Return a map with new heights and one more line in ``processing``."""
        return replace(
            self,
            heights=heights,
            processing=(*self.processing, done),
            **changes,  # type: ignore[arg-type]  # field names are checked by replace itself
        )


def check_heights(heights: np.ndarray) -> None:
    """Refuse missing or infinite heights, saying how many and where the first one is."""
    bad = ~np.isfinite(heights)
    if bad.any():
        first = tuple(int(i) for i in np.argwhere(bad)[0])
        raise InputError(
            f"{int(bad.sum())} of {heights.size} heights are missing or infinite, "
            f"the first at {first}",
            where="heights",
            allowed="a finite height at every point",
            remedy="Fill them (underfoot.surface.filled) or cut them away; the result then says so",
        )


def check_length(name: str, value: float) -> None:
    """Refuse a length that is not a positive number."""
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{name} {metres(value)}", where=name, allowed="a length above 0 m")
