"""A result on the sole as it was designed: fine cells of the file or the shape, loads kept."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core.fields import Fields

from .drawn_sole import DrawnSole, drawn_sole
from .quantities import AREAS, inside, raw, spacing

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.shoe import SoleMap

Floats = NDArray[np.float64]
FINEST = 0.4e-3
"""m: side of a fine cell, at most."""
_ROUNDS = 6
_NOTHING = 1e-6  # of the largest load: what carries less is left as it is
_KEPT = 5
"""Cells of the solver across, over which a load is kept where it is."""


@dataclass(frozen=True)
class DesignedSole:
    """The sole of a case on cells of 0.4 mm or less, whose ends of lugs are those of the design.

    Fields of the solver's cells (``dataset``) are interpolated between cells of the same kind (lug
    or channel). Pressures, weighted by what a cell stands for, are then scaled so that their
    integral over the fine cells is the load: over each neighbourhood of five cells of the solver,
    and in all.
    """

    dataset: Fields
    fine: SoleMap

    @classmethod
    def of_case(cls, dataset: Fields, case: Case) -> DesignedSole:
        """Return the sole of a case as it lies under a result's fields.

        Raises:
            InputError, DataError: The sole of the case can't be made: its file is not there.
        """
        from underfoot.compute.sole import drawn_map

        side = spacing(dataset)
        return cls(dataset, drawn_map(case, side / math.ceil(side / FINEST)))

    @cached_property
    def drawn(self) -> DrawnSole:
        """The fine sole with its heights, undeformed and pressed (m)."""
        whole = self.fine.whole or self.fine
        height = np.where(whole.inside, whole.clearance, np.nan)
        everywhere = slice(0, whole.x.size), slice(0, whole.y.size)
        return DrawnSole(
            whole.x, whole.y, whole.spacing, height, self._pressed_heights(whole), whole.land,
            everywhere, everywhere,
        )  # fmt: skip

    def _pressed_heights(self, whole: SoleMap) -> Floats | None:
        """Return the heights under load: those of the design, moved as the solver's cells are."""
        from scipy.ndimage import distance_transform_edt, map_coordinates

        cells = drawn_sole(self.dataset)
        if cells.pressed is None:
            return None
        moved = cells.pressed - cells.height
        nearest = distance_transform_edt(
            np.isnan(moved), return_distances=False, return_indices=True
        )
        places = [(to - at[0]) / cells.spacing for to, at in
                  ((whole.x, cells.x), (whole.y, cells.y))]  # fmt: skip
        grid = np.meshgrid(*places, indexing="ij")
        fine = map_coordinates(moved[*np.asarray(nearest)], grid, order=1, mode="nearest")
        return np.where(whole.inside, np.maximum(whole.clearance + fine, 0.0), np.nan)

    def field(self, name: str) -> Floats:
        """Return a field (SI) on the fine cells, nan where there is none."""
        values, where = raw(self.dataset, name), inside(self.dataset)
        if name not in AREAS or AREAS[name] not in self.dataset:
            return self._between(values, where & np.isfinite(values))
        share = np.where(where, raw(self.dataset, AREAS[name]), 0.0)
        load = np.where(share > 0, values, 0.0) * share * spacing(self.dataset) ** 2
        fine = self._between(values, share > 0, share)
        return self._with_load(fine, load)

    def _with_load(self, pressure: Floats, load: Floats) -> Floats:
        """Return a pressure scaled so that it carries the loads (N) of the solver's cells."""
        from scipy.ndimage import uniform_filter

        area = self.drawn.spacing**2
        rows, columns = (np.clip(np.rint(p), 0, n - 1).astype(int) for p, n in
                         zip(self._places(), load.shape, strict=True))  # fmt: skip
        cell = rows[:, None] * load.shape[1] + columns
        wanted = uniform_filter(load, _KEPT, mode="constant")
        for _ in range(_ROUNDS):
            carried = np.bincount(cell.ravel(), np.nan_to_num(pressure).ravel() * area, load.size)
            has = uniform_filter(carried.reshape(load.shape), _KEPT, mode="constant")
            ratio = np.where(has > _NOTHING * has.max(), wanted / np.maximum(has, 1e-300), 1.0)
            pressure = pressure * uniform_filter(ratio, _KEPT, mode="nearest").ravel()[cell]
        total = float(np.nansum(pressure)) * area
        return pressure * (float(load.sum()) / total) if total > 0 else pressure

    def _places(self) -> tuple[Floats, Floats]:
        """Return where the fine cells lie among those of the solver, in cells from its first."""
        x, y = (
            (fine - self.dataset[name].values[0]) / spacing(self.dataset)
            for name, fine in (("x", self.drawn.x), ("y", self.drawn.y))
        )
        return x, y

    def _between(
        self, values: Floats, known: NDArray[np.bool_], weight: Floats | float = 1.0
    ) -> Floats:
        """Return values between the known cells of the same kind, linear, times their weights."""
        land = np.asarray(self.dataset["land"].transpose("x", "y").values, bool)
        drawn, (rows, columns) = self.drawn, self._places()
        weight = np.where(known, weight, 0.0)
        sums = np.zeros((2, 2, rows.size, columns.size))  # of channel and lug: value, weight
        i, j = np.floor(rows).astype(int), np.floor(columns).astype(int)
        for a, b in ((0, 0), (0, 1), (1, 0), (1, 1)):
            m, n = i + a, j + b
            share = np.outer(*(np.maximum(1 - np.abs(d), 0.0) for d in (rows - m, columns - n)))
            share *= np.outer((m >= 0) & (m < land.shape[0]), (n >= 0) & (n < land.shape[1]))
            at = np.ix_(np.clip(m, 0, land.shape[0] - 1), np.clip(n, 0, land.shape[1] - 1))
            share *= weight[at]
            for kind in (0, 1):
                part = np.where(land[at] == bool(kind), share, 0.0)
                sums[kind] += part * np.where(known, values, 0.0)[at], part
        value, total = np.where(drawn.land, sums[1], sums[0])
        present = np.isfinite(drawn.height) & (total > 1e-9)
        return np.where(present, value / np.where(present, total, 1.0), np.nan)
