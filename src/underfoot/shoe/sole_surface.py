"""The bottom of a sole in its own frame: what files, generators and wear produce and consume."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Breach, InputError, Range, breaches
from underfoot.core.arrays import Array, Mask
from underfoot.core.checks import between, not_negative, positive

from ._kernels.land import carried_on, nearest_true
from ._kernels.local_width import local_width
from ._kernels.tilt import tilted_rows
from .geometry import CELLS_REFUSED, CELLS_WANTED, SoleMap

HALF, NARROW = 50.0, 10.0
"""Percentiles of the local width by area: what is refused, and what is listed."""


@dataclass(frozen=True, slots=True)
class SoleSurface:
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
    """

    x: Array
    y: Array
    height: Array
    land: Mask
    tread_depth: Array
    spacing: float
    outline: Array
    name: str = "sole"
    remarks: tuple[str, ...] = field(default=())
    base: Array | None = None

    def __post_init__(self) -> None:
        positive(self.spacing, "surface.spacing")
        shape = (self.x.size, self.y.size)
        for name in ("height", "land", "tread_depth", "base"):
            value = getattr(self, name)
            if value is not None and np.shape(value) != shape:
                raise InputError(
                    f"{name} has shape {np.shape(value)}",
                    where=f"surface.{name}",
                    allowed=f"{shape}",
                )
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
    def plan_area(self) -> float:
        """Area of the plan form, m^2."""
        return float(np.count_nonzero(self.inside)) * self.spacing**2

    @property
    def land_area(self) -> float:
        """Area that can touch the floor, m^2."""
        return float(np.count_nonzero(self.land)) * self.spacing**2

    @property
    def land_ratio(self) -> float:
        """Land area / plan area, 0 to 1."""
        return self.land_area / self.plan_area

    @property
    def land_base(self) -> Array:
        """Height (nx, ny) in m of the land carried on across the channels; nan outside."""
        if self.base is not None:
            return self.base
        return carried_on(self.height, self.land)


def surface_map(
    surface: SoleSurface, *, shoe_angle: float, spacing: float, padding: float = 0.004
) -> SoleMap:
    """Return the surface, tilted by the shoe angle, on square cells in the floor's frame.

    A point (x, z) of the sole goes to x' = x cos a - z sin a, z' = x sin a + z cos a. The map
    follows the land (bilinear between cells) exactly, of several points over one cell the lowest;
    a channel keeps its depth straight above the land it cuts, as in ``heel_map``.

    Parameters:
        surface: The sole in its own frame.
        shoe_angle: a, rad, toe up positive, -30 to 60 deg.
        spacing: Side of a cell, m.
        padding: Free margin around the plan form, m.

    Raises:
        InputError: Grid too coarse for the plan form or for most of the channels; angle out of
            range.
    """
    positive(spacing, "grid.spacing")
    not_negative(padding, "grid.padding")
    between(shoe_angle, math.radians(-30), math.radians(60), "shoe_angle", "-30 deg to 60 deg")
    smallest = min(surface.length, surface.width)
    if smallest < 4 * spacing:
        raise InputError(
            f"the plan form is {smallest * 1e3:g} mm small, the grid spacing {spacing * 1e3:g} mm",
            where="grid.spacing",
            allowed=f"at most {smallest / 4 * 1e3:.3g} mm for this plan form",
        )
    cosine, sine = math.cos(shoe_angle), math.sin(shoe_angle)
    inside, base = surface.inside, surface.land_base
    base = base[nearest_true(np.isfinite(base))]
    outline = surface.outline.copy()
    rim = _cells(surface, outline[:, 0], outline[:, 1])
    outline[:, 0] = outline[:, 0] * cosine - base[rim] * sine
    rear = float(outline[:, 0].min())
    outline[:, 0] -= rear
    margin = max(1, math.ceil(padding / spacing - 1e-9))
    count_x = math.ceil(float(outline[:, 0].max()) / spacing - 1e-9) + 2 * margin
    low, high = float(outline[:, 1].min()), float(outline[:, 1].max())
    count_y = math.ceil((high - low) / spacing - 1e-9) + 2 * margin
    x = (np.arange(count_x, dtype=np.float64) + 0.5 - margin) * spacing
    y = (low + high) / 2 + (np.arange(count_y, dtype=np.float64) - (count_y - 1) / 2) * spacing
    clearance, origin = tilted_rows(
        (surface.x, surface.y), base, inside, (x + rear, y), cosine, sine
    )
    covered = np.isfinite(clearance)
    cells = _cells(
        surface, np.where(covered, origin, surface.x[0]), np.broadcast_to(y, x.shape + y.shape)
    )
    above = np.where(inside, surface.height - base, 0.0)
    clearance = np.where(covered, clearance + above[cells] * cosine, np.inf)
    if covered.any():
        clearance -= clearance.min()
    land = covered & surface.land[cells]
    return SoleMap(
        x=x,
        y=y,
        clearance=clearance,
        inside=covered,
        land=land,
        tread_depth=np.where(land, surface.tread_depth[cells], 0.0),
        spacing=float(spacing),
        outline=outline,
        breaches=tuple(resolution_breaches(surface, spacing)),
    )


def _cells(surface: SoleSurface, x: Array, y: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the indices of the cells that hold the points (x, y), the nearest where none does."""
    indices = []
    for value, centres in ((x, surface.x), (y, surface.y)):
        place = np.rint((value - centres[0]) / surface.spacing).astype(np.intp)
        indices.append(np.clip(place, 0, centres.size - 1))
    return indices[0], indices[1]


def resolution_breaches(surface: SoleSurface, spacing: float) -> list[Breach]:
    """Return what a grid of ``spacing`` (m) resolves with too few cells.

    By local width (the largest disc that covers a place), because a sole has no single channel
    width: listed when more than a tenth of the area of channels or of lugs is narrower than 4
    cells.

    Raises:
        InputError: More than half of the channels' or of the lugs' area is narrower than 2 cells.
    """
    channel = surface.inside & ~surface.land
    if not channel.any():
        return []
    unresolved: list[Breach] = []
    tested = Range(CELLS_WANTED, math.inf, "1", "grid refinement of the tread")
    for name, mask in (("channel", channel), ("lug", surface.land)):
        widths = local_width(mask, surface.spacing)[mask]
        narrow, half = (float(value) for value in np.percentile(widths, (NARROW, HALF)))
        # the width itself is known within half a cell of the height map
        if half + surface.spacing / 2 < CELLS_REFUSED * spacing * (1 - 1e-9):
            raise InputError(
                f"half of the {name} area of {surface.name} is narrower than {half * 1e3:.2g} mm, "
                f"{half / spacing:.2g} cells of {spacing * 1e3:g} mm",
                where="grid.spacing",
                allowed=f"at least {CELLS_REFUSED:g} cells, {CELLS_WANTED:g} for a result to trust",
                remedy=f"Use a grid spacing of {half / CELLS_WANTED * 1e3:.2g} mm or less",
            )
        cells = (narrow + surface.spacing / 2) / spacing
        quantity = f"cells across the narrowest tenth of the {name}s"
        unresolved += breaches("grid", {quantity: tested}, {quantity: cells})
    return unresolved
