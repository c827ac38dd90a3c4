"""The undeformed sole over the floor: what every source of geometry produces."""

from dataclasses import dataclass, field

import numpy as np

from underfoot.core import Breach, InputError
from underfoot.core.arrays import Array, Mask

CELLS_REFUSED = 2.0
"""A channel or lug of fewer cells is refused: its width would be wrong by half or more."""
CELLS_WANTED = 4.0
"""A channel or lug of fewer cells is listed as a breach."""


@dataclass(frozen=True, slots=True)
class SoleMap:
    """The undeformed sole in the floor's frame, sampled at the centres of square cells.

    Axes: x forward (towards the toe), y across, both in the floor; arrays have shape (nx, ny).

    Parameters:
        x, y: Cell centres in m, (nx,) and (ny,). x = 0 is the rear end of the sole.
        clearance: Height above the floor after tilting, m; its smallest value is 0, inf outside the
            sole.
        inside: True within the plan form (lugs and channels).
        land: True where the sole can touch the floor: on a lug or an untreaded surface, not in a
            channel.
        tread_depth: Height of the lug at this node in m, normal to the sole; 0 where untreaded or
            in a channel.
        spacing: Side of a cell, m.
        outline: (n, 2) closed polygon of the plan form in m, for drawings.
        breaches: What the grid resolves too coarsely to be trusted.
    """

    x: Array
    y: Array
    clearance: Array
    inside: Mask
    land: Mask
    tread_depth: Array
    spacing: float
    outline: Array
    breaches: tuple[Breach, ...] = field(default=())

    def __post_init__(self) -> None:
        shape = (self.x.size, self.y.size)
        for name in ("clearance", "inside", "land", "tread_depth"):
            actual = np.shape(getattr(self, name))
            if actual != shape:
                raise InputError(
                    f"{name} has shape {actual}", where=f"sole.{name}", allowed=f"{shape}"
                )
        if not self.inside.any():
            raise InputError(
                "no cell centre lies within the plan form",
                where="sole.inside",
                remedy="Use a finer grid, or check the unit of the plan form",
            )
        if not self.land.any():
            raise InputError(
                "the sole has no land: nothing can touch the floor",
                where="sole.land",
                remedy="Check lug and channel width against the plan form",
            )
        if not np.isfinite(self.clearance[self.inside]).all():
            raise InputError(
                "the clearance is not finite everywhere inside the plan form",
                where="sole.clearance",
            )
        if (self.land & ~self.inside).any():
            raise InputError("land lies outside the plan form", where="sole.land")

    @property
    def plan_area(self) -> float:
        """Area of the plan form as the grid sees it, m^2 (projected on the floor)."""
        return float(np.count_nonzero(self.inside)) * self.spacing**2

    @property
    def land_area(self) -> float:
        """Area that can touch the floor, m^2."""
        return float(np.count_nonzero(self.land)) * self.spacing**2

    @property
    def land_ratio(self) -> float:
        """Land area / plan area, 0 to 1."""
        return self.land_area / self.plan_area
