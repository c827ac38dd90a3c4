"""Maps on the outline of the sole: heel at the bottom, walking direction up, mm and kPa."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class MapStyle:
    """How one field is drawn."""

    field: str
    title: str
    factor: float
    unit: str
    colours: str
    logarithmic: bool = False


STYLES = {
    "contact_pressure": MapStyle("contact_pressure", "Contact pressure", 1e-3, "kPa", "viridis"),
    "fluid_pressure": MapStyle("fluid_pressure", "Fluid pressure", 1e-3, "kPa", "viridis"),
    "film_thickness": MapStyle("film_thickness", "Film thickness", 1e6, "µm", "magma_r", True),
}


def colour_limits(datasets: Sequence[xarray.Dataset], field: str) -> tuple[float, float]:
    """Return one colour scale for several results, so that they can be compared by eye."""
    style = STYLES[field]
    values = np.concatenate([_drawn(dataset, style).compressed() for dataset in datasets])
    values = values[np.isfinite(values)]
    if values.size == 0:
        return 0.0, 1.0
    if style.logarithmic:
        positive = values[values > 0]
        low = float(positive.min()) if positive.size else 1.0
        return low, max(float(values.max()), 1.01 * low)
    return 0.0, max(float(values.max()), 1e-9)


def draw_map(
    axes: Axes, dataset: xarray.Dataset, field: str, limits: tuple[float, float] | None = None
) -> None:
    """Draw one field of a result into ``axes`` with its colour bar and the sole's outline."""
    from matplotlib.colors import LogNorm, Normalize

    style = STYLES[field]
    low, high = limits or colour_limits([dataset], field)
    across, along = dataset["y"].values * 1e3, dataset["x"].values * 1e3
    norm = LogNorm(low, high) if style.logarithmic else Normalize(low, high)
    image = axes.pcolormesh(
        across,
        along,
        _drawn(dataset, style),
        cmap=style.colours,
        norm=norm,
        shading="nearest",
        rasterized=True,
    )
    if "outline_x" in dataset:
        rim = (dataset["outline_y"].values * 1e3, dataset["outline_x"].values * 1e3)
        axes.fill(*rim, color="0.93", zorder=0)
        axes.plot(*rim, color="0.25", linewidth=1.2)
    axes.set_aspect("equal")
    axes.set_title(style.title)
    axes.set_xlabel("across, y (mm)")
    axes.set_ylabel("from the back of the heel, x (mm)")
    bar = axes.figure.colorbar(image, ax=axes, fraction=0.05, pad=0.03)
    bar.ax.set_title(style.unit, fontsize="medium")
    if style.logarithmic:
        from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

        bar.ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        bar.ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        bar.ax.yaxis.set_minor_formatter(NullFormatter())


def map_figure(dataset: xarray.Dataset, field: str) -> Figure:
    """Return one map as a figure."""
    figure = _figure(1)
    draw_map(figure.add_subplot(), dataset, field)
    return figure


def overview_figure(dataset: xarray.Dataset) -> Figure:
    """Return the three maps side by side."""
    figure = _figure(len(STYLES))
    for number, field in enumerate(STYLES, start=1):
        axes = figure.add_subplot(1, len(STYLES), number)
        draw_map(axes, dataset, field)
        if number > 1:
            axes.set_ylabel("")
    return figure


def save_maps(dataset: xarray.Dataset, folder: Path) -> list[Path]:
    """Write one PNG per field and the overview; return their paths."""
    paths = []
    for field in STYLES:
        paths.append(folder / f"{field}.png")
        map_figure(dataset, field).savefig(paths[-1], dpi=150)
    paths.append(folder / "maps.png")
    overview_figure(dataset).savefig(paths[-1], dpi=150)
    return paths


def _figure(columns: int) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(4.3 * columns, 4.2), layout="constrained")


def _drawn(dataset: xarray.Dataset, style: MapStyle) -> np.ma.MaskedArray:
    values = np.asarray(dataset[style.field].values, dtype=float) * style.factor
    hidden = ~np.asarray(dataset["inside"].values, dtype=bool) | ~np.isfinite(values)
    if not style.logarithmic:
        hidden |= values < 1e-3 * np.max(values, initial=0.0, where=~hidden)
    return np.ma.masked_array(values, mask=hidden)
