"""Wear of a sole that is known by its heights."""

from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from underfoot.core.arrays import Array

from ..geometry import SoleSurface
from ..shape import SoleShape, SoleWear, WearOnSole, fit_wear


def worn_surface(surface: SoleSurface, wear: SoleWear | WearOnSole) -> SoleSurface:
    """Return the surface with the material that ``wear`` removes taken off.

    The land wears to z' = wear(z); a channel keeps its floor until the land has come down to it,
    then it is land, too. Lugs lose what their land loses.

    Raises:
        InputError: A patch larger than the sole or beside it.
    """
    base = surface.land_base
    known = np.where(np.isfinite(base), base, 0.0)
    shape = cast(SoleShape, _Extent(surface, known))
    x, y = np.meshgrid(surface.x, surface.y, indexing="ij")
    worn = fit_wear(wear, shape).worn_height(x, y, known, shape)
    inside = surface.inside
    height = np.where(inside, np.maximum(surface.height, worn), np.nan)
    # what stood over the land (texture, rounded edges) is gone where the wear is deeper
    land = surface.land | (inside & (np.where(inside, surface.height, -np.inf) <= worn))
    lugs = np.where(land, np.maximum(surface.tread_depth - (worn - known), 0.0), 0.0)
    removed = np.where(inside, np.maximum(worn - known, 0.0), 0.0)
    return replace(
        surface,
        height=height,
        land=land,
        tread_depth=np.where(surface.land, lugs, 0.0),
        base=np.where(inside, np.maximum(worn, known), np.nan),
        removed=removed,
        remarks=(*surface.remarks, f"Worn by up to {removed.max() * 1e3:.3g} mm."),
    )


@dataclass(frozen=True, slots=True)
class _Extent:
    """What wear asks of a shape: its extent, its rim and its centre line."""

    surface: SoleSurface
    base: Array

    @property
    def length(self) -> float:
        return self.surface.length

    @property
    def width(self) -> float:
        return self.surface.width

    def inward_distance(self, x: Array, y: Array) -> Array:
        """Return 1 inside the plan form and -1 outside: wear asks for the side alone."""
        surface = self.surface
        i = np.rint((x - surface.x[0]) / surface.spacing).astype(int)
        j = np.rint((y - surface.y[0]) / surface.spacing).astype(int)
        within = (i >= 0) & (i < surface.x.size) & (j >= 0) & (j < surface.y.size)
        i, j = np.clip(i, 0, surface.x.size - 1), np.clip(j, 0, surface.y.size - 1)
        return np.where(within & surface.inside[i, j], 1.0, -1.0)

    def centre_line(self) -> tuple[Array, Array]:
        """Return x and height along the row nearest to y = 0, where the sole is."""
        row = int(np.argmin(np.abs(self.surface.y)))
        inside = self.surface.inside[:, row]
        if not inside.any():
            inside = self.surface.inside.any(axis=1)
        return self.surface.x[inside], self.base[inside, row]
