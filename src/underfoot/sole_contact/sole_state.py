"""What is solved at one instant of a sole on a flooded floor, and how it is solved."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Status
from underfoot.core.arrays import Array, Mask
from underfoot.film import FilmModel
from underfoot.shoe.cut_cells import CutCells

FAINT = 1.0
"""Pa: less is the tail of an asperity law far from the floor, which no cell bears."""


@dataclass(frozen=True, slots=True)
class SolverSettings:
    """How the sole meets the floor and how exactly it is solved.

    Parameters:
        pool_depth: Depth of the fluid on the floor, m; deeper gaps hold no film. 0.6 mm is 150 ml
            on 0.4 m x 0.6 m (report, G.6.1).
        start_film: Height of the lowest point above the floor when the load starts to rise, m
            (assumed).
        rise_time: Time over which the load rises linearly to its full value, s (report, G.4.1: 30
            ms).
        end_time: Time at which the result is taken, s; None goes on until nothing moves.
        tolerance: Largest relative imbalance of volume, of load and of the cavitation condition.
        time_resolution: Steps at least that the rise takes, that the rest takes, and that the floor
            takes to pass six pieces of land (the lugs of a tread) in.
        backend: Sparse factorization: "pardiso", "superlu" or None for the fastest installed.
        cavity_pressure: Pressure of ruptured film, Pa above that of the air, 0 or less: 0 where air
            finds its way in, down to -1e5 where nothing does (the default is the former).
        film: How the film flows; None as a Newtonian fluid.
    """

    pool_depth: float = 0.6e-3
    start_film: float = 50e-6
    rise_time: float = 0.03
    end_time: float | None = 0.12
    tolerance: float = 1e-4
    backend: str | None = None
    most_newton: int = 40
    most_time_steps: int = 400
    krylov_tolerance: float = 1e-3
    time_resolution: float = 8.0
    cavity_pressure: float = 0.0
    film: FilmModel | None = None


@dataclass(frozen=True, slots=True)
class CellState:
    """Pressures and film on cells that are finer than the map's; arrays (n,), SI.

    ``area`` and ``film_area`` are what a cell stands for in cells of the map, of contact and shear
    and of the fluid's pressure; ``square`` is the flat index of the map's cell that it lies in.
    """

    contact_pressure: Array
    fluid_pressure: Array
    film_thickness: Array
    wet: Mask
    area: Array
    film_area: Array
    square: NDArray[np.intp]

    @property
    def areas(self) -> dict[str, Any]:
        """What each cell stands for, as ``friction.cof`` and ``sampled_cof`` take it."""
        return {"area": self.area, "film_area": self.film_area}


@dataclass(frozen=True, slots=True)
class SoleState:
    """Pressures and film under the sole at one instant; arrays (nx, ny), SI.

    Pressures are those at the centres of cells, or means over the finer ``cells`` where such were
    solved. Of the area of a cell that an outline cuts, the contact presses on ``cut.area`` and the
    fluid on ``cut.film_area``: loads are sums over these. ``film_thickness`` is the mean gap, at
    most the pool depth; ``liquid_fraction`` the share of it that holds liquid, below 1 where the
    film has ruptured. ``wet`` marks the film (cavitated cells included, see ``cavitated``).
    ``approach`` is how far the rigid foot has come down since the lowest point touched the floor.
    ``status`` other than CONVERGED: not a result, see ``remedy``.
    """

    x: Array
    y: Array
    spacing: float
    contact_pressure: Array
    fluid_pressure: Array
    film_thickness: Array
    liquid_fraction: Array
    wet: Mask
    cavitated: Mask
    cut: CutCells
    cells: CellState | None
    approach: float
    normal_force: float
    speed: float
    shoe_angle: float
    time: float
    status: Status
    remedy: str
    residuals: tuple[float, ...]

    @property
    def fluid_load(self) -> float:
        """Load carried by the fluid, N."""
        return float((self.fluid_pressure * self.cut.film_area).sum()) * self.spacing**2

    @property
    def contact_load(self) -> float:
        """Load carried by asperities, N."""
        return float((self.contact_pressure * self.cut.area).sum()) * self.spacing**2

    @property
    def total_pressure(self) -> Array:
        """Fluid and contact pressure together, Pa."""
        return self.fluid_pressure + self.contact_pressure

    @property
    def cell_load(self) -> Array:
        """Load on each cell per area of a whole cell, Pa: what a ``Compliance`` takes."""
        return self.fluid_pressure * self.cut.film_area + self.contact_pressure * self.cut.area

    @property
    def finest(self) -> "SoleState | CellState":
        """Pressures and film on the finest cells that were solved: what friction is summed on."""
        return self.cells or self

    @property
    def areas(self) -> dict[str, Any]:
        """What each cell of the map stands for, as ``friction.cof`` takes it."""
        return {"area": self.cut.area, "film_area": self.cut.film_area}
