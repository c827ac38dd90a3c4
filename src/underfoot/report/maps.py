"""Maps on the outline of the sole, of one result or of several with their differences.

The heel is at the bottom, the walking direction points up, lengths are in mm.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.fields import Fields
from underfoot.core.html import new_figure
from underfoot.core.remark import Message
from underfoot.questions.comparison import LETTERS

from .common_grid import common_grid, difference, on_grid, sole_on_grid
from .quantities import ColourScale, DrawnQuantity, drawn_values, inside, quantities, scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FEW_SENSORS = 12
"""More readings than this along x are a scanned track, fewer an array of sensors."""
_SENSED = "fluid_pressure"
_REACH = 0.995
"""Quantile of the differences at which their colour scale ends: single cells at edges beyond."""


def colour_scale(datasets: Sequence[Fields], quantity: DrawnQuantity) -> ColourScale:
    """Return one colour scale for several results, so that they can be compared by eye."""
    return scale([drawn_values(dataset, quantity) for dataset in datasets], quantity)


def draw_map(
    axes: Axes,
    dataset: Fields,
    quantity: DrawnQuantity,
    limits: ColourScale | None = None,
    *,
    bar: bool = True,
    sensors: bool = True,
) -> None:
    """Draw one field of a result into ``axes``.

    With the sole's outline and its lugs, where the floor's sensors run (on the fluid pressure),
    a scale bar, the walking direction and the colour bar with its unit.
    """
    limits = limits or colour_scale([dataset], quantity)
    x, y = dataset["x"].values * 1e3, dataset["y"].values * 1e3
    values = drawn_values(dataset, quantity)
    draw_field(axes, x, y, values, quantity, limits, bar=bar)
    draw_shape(axes, dataset)
    if sensors and quantity.name == _SENSED:
        _draw_sensors(axes, dataset)
    frame_sole(axes, x, y, inside(dataset))
    axes.set_title(quantity.title)


def draw_field(
    axes: Axes,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    values: NDArray[np.float64],
    quantity: DrawnQuantity,
    limits: ColourScale,
    *,
    bar: bool = True,
) -> None:
    """Draw values (nx, ny) at x, y (mm) in the quantity's colours, with its colour bar."""
    from matplotlib.colors import LogNorm, Normalize

    make = LogNorm if quantity.logarithmic else Normalize
    image = axes.pcolormesh(
        y, x, np.ma.masked_invalid(values), cmap=quantity.colours,
        norm=make(limits.low, limits.high), shading="nearest", rasterized=True,
    )  # fmt: skip
    if not bar:
        return
    colour_bar = axes.figure.colorbar(
        image, ax=axes, fraction=0.05, pad=0.03, extend="max" if limits.cut else "neither"
    )
    unit = quantity.unit or "1"
    peak = f"\npeak {limits.peak:.3g}" if limits.cut else ""
    colour_bar.ax.set_title(unit + peak, fontsize="small")
    if quantity.logarithmic:
        from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

        colour_bar.ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
        colour_bar.ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        colour_bar.ax.yaxis.set_minor_formatter(NullFormatter())


def draw_shape(axes: Axes, dataset: Fields) -> None:
    """Draw the outline of the sole and of its lugs."""
    x, y = dataset["x"].values * 1e3, dataset["y"].values * 1e3
    if "land" in dataset:
        land = np.asarray(dataset["land"].transpose("x", "y").values, dtype=float)
        if 0.0 < land.sum() < inside(dataset).sum():
            axes.contour(y, x, land, levels=[0.5], colors="0.45", linewidths=0.6)
    if "outline_x" in dataset:
        rim = (dataset["outline_y"].values * 1e3, dataset["outline_x"].values * 1e3)
        axes.fill(*rim, color="0.93", zorder=0)
        axes.plot(*rim, color="0.25", linewidth=1.2)


def map_figure(dataset: Fields, quantity: DrawnQuantity) -> Figure:
    """Return one map as a figure."""
    figure = _sole_figure(1, 1, dataset)
    axes = figure.add_subplot()
    draw_map(axes, dataset, quantity)
    axes.set(xlabel="across, y (mm)", ylabel="from the back of the heel, x (mm)")
    return figure


def overview_figure(dataset: Fields) -> Figure:
    """Return the maps of all quantities, three in a row."""
    fields = quantities([dataset])
    columns = min(3, len(fields))
    rows = -(-len(fields) // columns)
    figure = _sole_figure(rows, columns, dataset)
    for number, quantity in enumerate(fields, start=1):
        axes = figure.add_subplot(rows, columns, number)
        draw_map(axes, dataset, quantity)
        axes.set(xticks=[], yticks=[])
    return figure


def comparison_figure(datasets: Sequence[Fields], quantity: DrawnQuantity) -> Figure:
    """Return the maps of several results in one scale, then each less the first.

    Where the grids differ, the differences are taken on cells of the coarser one, as means that
    keep the load. A quantity on a logarithmic scale is compared by its ratio.
    """
    grid = common_grid(datasets)
    limits = colour_scale(datasets, quantity)
    count = len(datasets)
    first = datasets[0]
    columns = 2 * count - 1
    height = float(np.clip(2.9 * _tallness(first), 2.6, 7.0)) + 0.6
    figure = new_figure(3.4 * columns, height)
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
        ax.set(xticks=[], yticks=[])
    return figure


def _difference_style(
    changes: Sequence[np.ndarray], quantity: DrawnQuantity
) -> tuple[DrawnQuantity, ColourScale]:
    known = np.concatenate([change[np.isfinite(change)] for change in changes])
    if quantity.logarithmic:
        sizes = np.exp(np.abs(np.log(known))) if known.size else np.array([1.0])
        reach = max(float(np.quantile(sizes, _REACH)), 1.05)
        style = DrawnQuantity("ratio", "", 1.0, "ratio", "RdBu_r", logarithmic=True)
        return style, ColourScale(1.0 / reach, reach, reach)
    sizes = np.abs(known) if known.size else np.zeros(1)
    largest = float(sizes.max())
    moved = sizes[sizes > 1e-3 * largest]
    reach = (float(np.quantile(moved, _REACH)) if moved.size else 0.0) or 1.0
    return DrawnQuantity("difference", "", 1.0, quantity.unit, "RdBu_r"), ColourScale(
        -reach, reach, reach
    )


def grid_note(datasets: Sequence[Fields]) -> str:
    """Return on which grid differences are taken."""
    grid = common_grid(datasets)
    if not grid.resampled:
        return "All results have the same grid."
    return Message(
        "The grids differ: differences are taken on cells of {spacing:.3g} mm, each the "
        "mean over the cells it covers.",
        spacing=grid.spacing * 1000.0,
    )


def _sole_figure(rows: int, columns: int, dataset: Fields) -> Figure:
    height = float(np.clip(3.4 * _tallness(dataset), 3.0, 8.0))
    return new_figure(4.4 * columns, (height + 0.7) * rows)


def _tallness(dataset: Fields) -> float:
    """Return the sole's length, with room for the scale bar, over its width."""
    covered = inside(dataset)
    tall = np.ptp(dataset["x"].values[covered.any(axis=1)]) + 0.015
    return tall / max(np.ptp(dataset["y"].values[covered.any(axis=0)]), 1e-6)


def _draw_sensors(axes: Axes, dataset: Fields) -> None:
    if "sensor_x" not in dataset or "sensor_y" not in dataset:
        return
    along, across = dataset["sensor_x"].values * 1e3, dataset["sensor_y"].values * 1e3
    sensed = dataset.get("sensor_pressure")
    inlet = None if sensed is None else sensed.attrs.get("inlet_diameter")
    style = {"color": "#c8553d", "linewidth": 0.9}
    if along.size > _FEW_SENSORS:
        axes.vlines(across, along.min(), along.max(), linestyles=":", **style)
        axes.plot([], [], linestyle=":", label="tracks of the sensors", **style)
    else:
        from matplotlib.patches import Circle

        radius = 0.5e3 * float(inlet) if inlet else 2.0
        for x in along:
            for y in across:
                axes.add_patch(Circle((y, x), radius, fill=False, **style))
        axes.plot([], [], label="inlets of the sensors", **style)
    axes.legend(loc="lower left", frameon=False, fontsize=7)


def frame_sole(
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], covered: NDArray[np.bool_]
) -> None:
    """Frame the sole with room for a scale bar below and the walking direction above."""
    ends_x, ends_y = x[covered.any(axis=1)][[0, -1]], y[covered.any(axis=0)][[0, -1]]
    size = float(np.ptp(ends_x))
    axes.set_aspect("equal")
    axes.set_xlim(ends_y[0] - 0.06 * size, ends_y[1] + 0.06 * size)
    axes.set_ylim(ends_x[0] - 0.16 * size, ends_x[1] + 0.2 * size)
    middle = float(ends_y.mean())
    toe = ends_x[1]
    arrow = {"arrowstyle": "-|>", "color": "0.3"}
    axes.annotate("", (middle, toe + 0.16 * size), (middle, toe + 0.05 * size), arrowprops=arrow)
    style: dict[str, Any] = {"fontsize": 7, "color": "0.3", "va": "center"}
    axes.text(middle + 0.03 * size, toe + 0.1 * size, "walking", **style)
    length = 10.0 if size < 150 else 50.0
    right, low = ends_y[1], ends_x[0] - 0.08 * size
    axes.plot([right - length, right], [low, low], color="0.2", linewidth=2.5)
    style = {"fontsize": 7, "ha": "center", "va": "top"}
    axes.text(right - 0.5 * length, low - 0.015 * size, f"{length:g} mm", **style)
    axes.spines[:].set_visible(False)
