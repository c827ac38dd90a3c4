"""Maps on the outline of the sole: heel at the bottom, walking direction up, lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .quantities import Quantity, Scale, drawn, inside, quantities, scale

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FEW_SENSORS = 12
"""More readings than this along x are a scanned track, fewer an array of sensors."""
_SENSED = "fluid_pressure"


def colour_scale(datasets: Sequence[xarray.Dataset], quantity: Quantity) -> Scale:
    """Return one colour scale for several results, so that they can be compared by eye."""
    return scale([drawn(dataset, quantity) for dataset in datasets], quantity)


def draw_map(
    axes: Axes,
    dataset: xarray.Dataset,
    quantity: Quantity,
    limits: Scale | None = None,
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
    values = drawn(dataset, quantity)
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
    quantity: Quantity,
    limits: Scale,
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


def draw_shape(axes: Axes, dataset: xarray.Dataset) -> None:
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


def map_figure(dataset: xarray.Dataset, quantity: Quantity) -> Figure:
    """Return one map as a figure."""
    figure = _figure(1, 1, dataset)
    axes = figure.add_subplot()
    draw_map(axes, dataset, quantity)
    axes.set_xlabel("across, y (mm)")
    axes.set_ylabel("from the back of the heel, x (mm)")
    return figure


def overview_figure(dataset: xarray.Dataset) -> Figure:
    """Return the maps of all quantities, three in a row."""
    found = quantities([dataset])
    columns = min(3, len(found))
    rows = -(-len(found) // columns)
    figure = _figure(rows, columns, dataset)
    for number, quantity in enumerate(found, start=1):
        axes = figure.add_subplot(rows, columns, number)
        draw_map(axes, dataset, quantity)
        axes.set_xticks([])
        axes.set_yticks([])
    return figure


def save_maps(dataset: xarray.Dataset, folder: Path) -> list[Path]:
    """Write one PNG per quantity (named after it) and the overview; return their paths."""
    paths = []
    for quantity in quantities([dataset]):
        paths.append(folder / f"{quantity.name}.png")
        map_figure(dataset, quantity).savefig(paths[-1], dpi=120)
    paths.append(folder / "maps.png")
    overview_figure(dataset).savefig(paths[-1], dpi=120)
    return paths


def _figure(rows: int, columns: int, dataset: xarray.Dataset) -> Figure:
    from matplotlib.figure import Figure

    there = inside(dataset)
    tall = np.ptp(dataset["x"].values[there.any(axis=1)]) + 0.015
    wide = np.ptp(dataset["y"].values[there.any(axis=0)])
    height = float(np.clip(3.4 * tall / max(wide, 1e-6), 3.0, 8.0))
    return Figure(figsize=(4.4 * columns, (height + 0.7) * rows), layout="constrained")


def _draw_sensors(axes: Axes, dataset: xarray.Dataset) -> None:
    if "sensor_x" not in dataset or "sensor_y" not in dataset:
        return
    along, across = dataset["sensor_x"].values * 1e3, dataset["sensor_y"].values * 1e3
    inlet = dataset["sensor_pressure"].attrs.get("inlet_diameter") if (
        "sensor_pressure" in dataset
    ) else None  # fmt: skip
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
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], there: NDArray[np.bool_]
) -> None:
    """Frame the sole with room for a scale bar below and the walking direction above."""
    ends_x, ends_y = x[there.any(axis=1)][[0, -1]], y[there.any(axis=0)][[0, -1]]
    size = float(np.ptp(ends_x))
    axes.set_aspect("equal")
    axes.set_xlim(ends_y[0] - 0.06 * size, ends_y[1] + 0.06 * size)
    axes.set_ylim(ends_x[0] - 0.16 * size, ends_x[1] + 0.2 * size)
    middle = float(ends_y.mean())
    axes.annotate(
        "", (middle, ends_x[1] + 0.16 * size), (middle, ends_x[1] + 0.05 * size),
        arrowprops={"arrowstyle": "-|>", "color": "0.3"},
    )  # fmt: skip
    axes.text(
        middle + 0.03 * size, ends_x[1] + 0.1 * size, "walking", fontsize=7, color="0.3",
        va="center",
    )  # fmt: skip
    length = 10.0 if size < 150 else 50.0
    right, low = ends_y[1], ends_x[0] - 0.08 * size
    axes.plot([right - length, right], [low, low], color="0.2", linewidth=2.5)
    axes.text(
        right - 0.5 * length, low - 0.015 * size, f"{length:g} mm", fontsize=7, ha="center",
        va="top",
    )  # fmt: skip
    for side in ("top", "right", "left", "bottom"):
        axes.spines[side].set_visible(False)
