"""The undeformed sole over the floor: what every source of geometry produces."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from underfoot.core import Breach, InputError
from underfoot.core.arrays import Array, Mask
from underfoot.core.checks import positive
from underfoot.core.remark import Message

from ._kernels.regions import carried_on
from .ball_joint import BallJoint
from .cut_cells import CutCells
from .row_cells import RowCells
from .slits import Slits

CELLS_REFUSED = 2.0
"""A channel or lug of fewer cells is refused: its width would be wrong by half or more."""
CELLS_WANTED = 4.0
"""A channel or lug of fewer cells is listed as a breach."""

BESIDE_A_WALL = 1e-3
"""Reach of a channel's wall, m: the deepest within it is the channel's floor."""


def centred_places(count: int, spacing: float) -> Array:
    """Return ``count`` places ``spacing`` apart, symmetric about 0."""
    return (np.arange(count, dtype=np.float64) - (count - 1) / 2) * spacing


class _Areas:
    """What maps of a sole on square cells have in common."""

    __slots__ = ()
    x: Array
    y: Array
    inside: Any
    land: Mask
    spacing: float
    cut: CutCells | None

    def _check_shapes(self, where: str, *names: str) -> None:
        shape = (self.x.size, self.y.size)
        for name in names:
            value = getattr(self, name)
            if value is not None and np.shape(value) != shape:
                what = Message("{name} has shape {shape}", name=name, shape=str(np.shape(value)))
                raise InputError(what, where=f"{where}.{name}", allowed=f"{shape}")

    @property
    def plan_area(self) -> float:
        """Area of the plan form as its cells see it, m^2."""
        return float(np.count_nonzero(self.inside)) * self.spacing**2

    @property
    def land_area(self) -> float:
        """Area that can touch the floor, m^2."""
        cells = np.count_nonzero(self.land) if self.cut is None else self.cut.area[self.land].sum()
        return float(cells) * self.spacing**2

    @property
    def land_ratio(self) -> float:
        """Land area / plan area, 0 to 1."""
        return self.land_area / self.plan_area


@dataclass(frozen=True, slots=True)
class SoleMap(_Areas):
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
        cut: How the outlines of lugs cut the cells; None: not at all.
        whole: The map that this one is a part of, on the same cells; None where it is all.
        removed: Thickness of the land that wear has taken, m; None for a new sole.
        slits: Sipes narrower than two cells: land to the map; None where there are none.
        joint: Where the sole bends as it rolls; None: it stays straight.
        columns: Cells along x in one spacing, 1 for square cells.
        cells: Finer cells that the film is solved on; None: those of the map.
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
    cut: CutCells | None = None
    whole: "SoleMap | None" = field(default=None, repr=False, compare=False)
    removed: Array | None = None
    slits: Slits | None = None
    joint: BallJoint | None = None
    columns: int = 1
    cells: RowCells | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        self._check_shapes("sole", "clearance", "inside", "land", "tread_depth", "removed")
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


@dataclass(frozen=True, slots=True)
class SoleSurface(_Areas):
    """The bottom of a sole as a height map in its own, untilted frame.

    Axes: x from the rear end towards the toe, y across, positive to the left as seen from above
    looking forward, z up into the shoe. Arrays have shape (nx, ny), values at cell centres.

    Parameters:
        x, y: Cell centres in m, (nx,) and (ny,), evenly spaced by ``spacing``.
        height: Height above the sole plane in m; nan outside the plan form.
        land: True where the sole can touch the floor: on a lug or an untreaded surface.
        tread_depth: Height of the lug at this cell, m; 0 in channels and where untreaded.
        spacing: Side of a cell, m.
        outline: (n, 2) closed polygon of the plan form, m.
        name: What it was made from, for people.
        remarks: Decisions and repairs on the way, a sentence each.
        base: (nx, ny) height in m that the land would have without its channels; None to carry the
            land on across them (linear between the land on both sides).
        removed: Thickness of the land that wear has taken, m; None for a new sole.
    """

    x: Array
    y: Array
    height: Array
    land: Mask
    tread_depth: Array
    spacing: float
    outline: Array
    name: str = "sole"
    remarks: tuple[Message, ...] = field(default=())
    base: Array | None = None
    cut: CutCells | None = None
    removed: Array | None = None

    def __post_init__(self) -> None:
        positive(self.spacing, "surface.spacing")
        self._check_shapes("surface", "height", "land", "tread_depth", "base", "removed")
        if not self.inside.any():
            raise InputError(
                "the sole has no height anywhere",
                where="surface.height",
                allowed="heights in m, nan outside the plan form",
            )
        if (self.land & ~self.inside).any():
            raise InputError("land lies outside the plan form", where="surface.land")

    @property
    def inside(self) -> Mask:
        """True within the plan form (lugs and channels)."""
        return np.isfinite(self.height)

    @property
    def length(self) -> float:
        """Extent of the plan form along the shoe, m."""
        return float(np.ptp(self.outline[:, 0]))

    @property
    def width(self) -> float:
        """Extent of the plan form across the shoe, m."""
        return float(np.ptp(self.outline[:, 1]))

    @property
    def land_base(self) -> Array:
        """Height (nx, ny) in m of the land carried on across the channels; nan outside."""
        return carried_on(self.height, self.land) if self.base is None else self.base
