"""Highest pressure under a sole: whether a finer grid would change it, and rubber could bear it."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError, ValidityRange
from underfoot.core.arrays import Array
from underfoot.core.remark import NOTHING, Message
from underfoot.shoe.geometry import SoleMap

AVERAGING_AREA = 10e-6
"""m^2; about the face of half a lug, and of a small pressure sensor (assumed)."""


MOST_OVERLOADED = ValidityRange(
    0.0, 0.01, "1", "rubber under its own modulus is strained by about 1"
)
"""Share of the load that may lie on cells pressed harder than Young's modulus: sharp edges alone
(assumed)."""


def overloaded_share(pressure: Array, cell_load: Array, modulus: float) -> float:
    """Return the share of the load (0 to 1) on cells whose pressure exceeds Young's modulus (Pa).

    ``pressure`` is that of contact and fluid together and ``cell_load`` the load per area of a
    whole cell, (nx, ny), Pa. A punch as wide as a cell sinks in by its width under such a pressure
    (half-space: w = 1.1 p a / E*, Love 1929): linear elasticity does not hold, rubber gives way.
    """
    load = float(cell_load.sum())
    return float(cell_load[pressure > modulus].sum()) / load if load > 0 else 0.0


@dataclass(frozen=True, slots=True)
class PeakPressure:
    """Highest pressure of a cell (Pa), highest mean over a disc of ``area`` (m^2), and where.

    ``at_edge``: the highest cell lies within one cell of an edge of the land. There a sharp edge on
    a flat floor has no highest pressure: the value grows as the grid gets finer, the mean does not.
    """

    highest: float
    mean: float
    area: float
    position: tuple[float, float]
    at_edge: bool

    @property
    def remark(self) -> Message:
        """What to say beside the highest pressure; empty where it can be trusted."""
        if not self.at_edge:
            return NOTHING
        return Message(
            "the highest pressure of contact and fluid together, {highest:.0f} kPa, lies at the "
            "edge of a lug or of the sole and grows on a finer grid; its mean over {area:.0f} mm2 "
            "is {mean:.0f} kPa",
            highest=self.highest / 1e3, area=self.area * 1e6, mean=self.mean / 1e3,
        )  # fmt: skip


def peak_pressure(
    sole: SoleMap,
    pressure: Array,
    *,
    cell_load: Array | None = None,
    averaging_area: float = AVERAGING_AREA,
) -> PeakPressure:
    """Return the highest pressure of a field (nx, ny) in Pa, as a cell and as a mean over a disc.

    The mean is over a disc of ``averaging_area`` (m^2) anywhere under the sole, at least one cell,
    of ``cell_load`` (nx, ny), the load per area of a whole cell, Pa; None: the pressure.
    """
    from scipy.ndimage import binary_erosion

    if pressure.shape != sole.land.shape:
        raise InputError(
            Message("pressure has shape {shape}", shape=str(pressure.shape)),
            where="pressure",
            allowed=f"{sole.land.shape}",
        )
    reach = math.sqrt(averaging_area / math.pi) / sole.spacing
    count = math.floor(reach)
    along = np.arange(-count, count + 1)
    disc = (along[:, None] ** 2 + along[None, :] ** 2 <= reach**2).astype(float)
    mean = np.zeros_like(pressure)
    padded = np.pad(pressure if cell_load is None else cell_load, count)
    for i, j in np.argwhere(disc):
        mean += padded[i : i + pressure.shape[0], j : j + pressure.shape[1]]
    mean /= disc.sum()
    at = np.unravel_index(int(pressure.argmax()), pressure.shape)
    within = np.asarray(binary_erosion(sole.land, np.ones((3, 3), dtype=bool)))
    return PeakPressure(
        float(pressure[at]),
        float(mean.max()),
        float(disc.sum()) * sole.spacing**2,
        (float(sole.x[at[0]]), float(sole.y[at[1]])),
        not bool(within[at]),
    )
