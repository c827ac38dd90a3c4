"""Maps of several results in one colour scale, and what differs between them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .common_grid import CommonGrid, common_grid, difference, on_grid, sole_on_grid
from .comparison import LETTERS
from .maps import colour_scale, draw_field, draw_map, draw_shape, frame_sole
from .quantities import Quantity, Scale, inside, quantities

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from underfoot.case.result import Result

_REACH = 0.995
"""Quantile of the differences at which their colour scale ends: single cells at edges beyond."""


def comparison_figures(results: Sequence[Result]) -> Iterator[tuple[Quantity, Figure]]:
    """Yield a figure for each quantity: every result in one scale, then each less the first.

    Where the grids differ, the differences are taken on cells of the coarser one, as means that
    keep the load. A quantity on a logarithmic scale is compared by its ratio.
    """
    datasets = [result.fields for result in results]
    grid = common_grid(datasets)
    for quantity in quantities(datasets):
        yield quantity, _figure(results, quantity, grid)


def grid_note(results: Sequence[Result]) -> str:
    """Return in words on which grid the differences are taken."""
    grid = common_grid([result.fields for result in results])
    if not grid.resampled:
        return "All results have the same grid; nothing was resampled."
    return (
        f"The grids are not the same: differences are taken on cells of {grid.spacing * 1e3:.3g} mm"
        ", each the mean over the cells it covers (which keeps the load)."
    )


def _figure(results: Sequence[Result], quantity: Quantity, grid: CommonGrid) -> Figure:
    from matplotlib.figure import Figure

    datasets = [result.fields for result in results]
    limits = colour_scale(datasets, quantity)
    count = len(results)
    first = datasets[0]
    there = inside(first)
    tall = np.ptp(first["x"].values[there.any(axis=1)]) + 0.015
    wide = np.ptp(first["y"].values[there.any(axis=0)])
    columns = 2 * count - 1
    height = float(np.clip(2.9 * tall / max(wide, 1e-6), 2.6, 7.0)) + 0.6
    figure = Figure(figsize=(3.4 * columns, height), layout="constrained")
    axes = np.atleast_1d(np.asarray(figure.subplots(1, columns)))
    for number, dataset in enumerate(datasets):
        draw_map(axes[number], dataset, quantity, limits, bar=number == count - 1, sensors=False)
        axes[number].set_title(f"{LETTERS[number]}: {quantity.title.lower()}", fontsize="medium")
    base = on_grid(first, quantity, grid)
    changes = [
        difference(on_grid(dataset, quantity, grid), base, quantity) for dataset in datasets[1:]
    ]
    style, scale = _difference_style(changes, quantity)
    x, y = grid.x * 1e3, grid.y * 1e3
    for number, change in enumerate(changes, start=1):
        ax = axes[count - 1 + number]
        draw_field(ax, x, y, change, style, scale, bar=number == len(changes))
        draw_shape(ax, datasets[number])
        frame_sole(ax, x, y, sole_on_grid(first, grid) | sole_on_grid(datasets[number], grid))
        sign = "over" if quantity.logarithmic else "less"
        ax.set_title(f"{LETTERS[number]} {sign} A", fontsize="medium")
    for ax in axes:
        ax.set_xticks([])
        ax.set_yticks([])
    return figure


def _difference_style(changes: Sequence[np.ndarray], quantity: Quantity) -> tuple[Quantity, Scale]:
    known = np.concatenate([change[np.isfinite(change)] for change in changes])
    if quantity.logarithmic:
        sizes = np.exp(np.abs(np.log(known))) if known.size else np.array([1.0])
        reach = max(float(np.quantile(sizes, _REACH)), 1.05)
        style = Quantity("ratio", "", 1.0, "ratio", "RdBu_r", logarithmic=True)
        return style, Scale(1.0 / reach, reach, reach)
    sizes = np.abs(known) if known.size else np.zeros(1)
    largest = float(sizes.max())
    moved = sizes[sizes > 1e-3 * largest]
    reach = (float(np.quantile(moved, _REACH)) if moved.size else 0.0) or 1.0
    unit = "% points" if quantity.unit == "%" else quantity.unit
    return Quantity("difference", "", 1.0, unit, "RdBu_r"), Scale(-reach, reach, reach)
