"""The sole of a result as it is drawn and exported: heights on one grid, whole where it is held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core.fields import Fields

from .quantities import HEIGHT_NAMES, inside, raw, spacing

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class DrawnSole:
    """Heights (nx, ny) in m at the centres ``x``, ``y`` (m) of square cells, nan outside the sole.

    ``pressed`` is the height under load, or None where the result does not hold it. ``computed``
    are the rows and columns in which the contact was solved; ``in_data`` those of the data set that
    lie there.
    """

    x: Floats
    y: Floats
    spacing: float
    height: Floats
    pressed: Floats | None
    land: NDArray[np.bool_]
    computed: tuple[slice, slice]
    in_data: tuple[slice, slice]

    @property
    def in_part(self) -> bool:
        """Whether the contact was solved on a part of the sole only."""
        return any(
            each.stop - each.start < size
            for each, size in zip(self.computed, self.height.shape, strict=True)
        )

    @property
    def plane(self) -> tuple[float, float, float]:
        """Return (a, b, c) of the plane a + b x + c y (m) through the land, least squares."""
        known = self.land & np.isfinite(self.height)
        if np.count_nonzero(known) < 3:
            known = np.isfinite(self.height)
        along, across = np.meshgrid(self.x, self.y, indexing="ij")
        design = np.stack([np.ones(known.sum()), along[known], across[known]], axis=1)
        a, b, c = np.linalg.lstsq(design, self.height[known], rcond=None)[0]
        return float(a), float(b), float(c)

    def place_field(self, values: Floats) -> Floats:
        """Return a field of the data set, (..., nx, ny), on this grid, nan beside it."""
        placed = np.full((*values.shape[:-2], *self.height.shape), np.nan)
        placed[(..., *self.computed)] = values[(..., *self.in_data)]
        return placed


def drawn_sole(dataset: Fields) -> DrawnSole:
    """Return the sole of a result's fields, cut to the rows and columns where there is sole."""
    mask = inside(dataset)
    name = next((name for name in HEIGHT_NAMES if name in dataset), None)
    height = np.zeros(mask.shape) if name is None else raw(dataset, name)
    height = np.where(mask & np.isfinite(height), height, np.nan)
    land = np.asarray(dataset["land"].transpose("x", "y"), bool) if "land" in dataset else mask
    pressed = raw(dataset, "pressed_height") if "pressed_height" in dataset else None
    x, y, side = dataset["x"].values, dataset["y"].values, spacing(dataset)
    along, across, solved = x, y, (slice(0, x.size), slice(0, y.size))
    if "whole_clearance" in dataset:
        along, across = dataset["whole_x"].values, dataset["whole_y"].values
        begin = (round((x[0] - along[0]) / side), round((y[0] - across[0]) / side))
        solved = (slice(begin[0], begin[0] + x.size), slice(begin[1], begin[1] + y.size))
        height = _set_in(dataset, "whole_clearance", solved, height)
        land = _set_in(dataset, "whole_land", solved, land)
        if pressed is not None:
            pressed = _set_in(dataset, "whole_pressed_height", solved, pressed)
    rows, columns = (np.nonzero(np.isfinite(height).any(axis=axis))[0] for axis in (1, 0))
    shown = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    both = [
        (max(part.start, keep.start), min(part.stop, keep.stop))
        for part, keep in zip(solved, shown, strict=True)
    ]

    def counted_from(begins: tuple[slice, slice]) -> tuple[slice, slice]:
        (low, high), (left, right) = both
        first, second = (begin.start for begin in begins)
        return slice(low - first, high - first), slice(left - second, right - second)

    return DrawnSole(
        along[shown[0]],
        across[shown[1]],
        side,
        height[shown],
        None if pressed is None else pressed[shown],
        land[shown].astype(bool),
        counted_from(shown),
        counted_from(solved),
    )


def _set_in(
    dataset: Fields, name: str, part: tuple[slice, slice], values: np.ndarray
) -> np.ndarray:
    """Return a field of the whole sole with the values of the part that was solved."""
    field = np.array(dataset[name].transpose("whole_x", "whole_y"), dtype=float)
    field[part] = values
    return field
