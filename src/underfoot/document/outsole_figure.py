"""An outsole from a file as a picture: heights, and what was taken for land and channels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from underfoot.outsole.tread_measures import TreadMeasures, channel_depth, draining

from .maps import frame_sole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from underfoot.outsole import SoleSurface

_HIGHEST = 98.0  # percentile of the heights at which colours end: walls and welts go beyond
_PATCH, _CLOSED = "#e3c16f", "#c8553d"


def outsole_figure(surface: SoleSurface, measures: TreadMeasures) -> Figure:
    """Return height, channel depth and parts of the tread beside each other, as seen from below.

    The heel is at the bottom and the toe at the top, like all maps of results.
    """
    from matplotlib.figure import Figure

    tall = float(np.clip(4.0 * surface.length / max(surface.width, 1e-6), 4.5, 10.0))
    figure = Figure(figsize=(12.5, tall), layout="constrained")
    heights, depths, parts = figure.subplots(1, 3)
    millimetres = surface.height * 1e3
    shown = millimetres[surface.inside]
    high = max(float(np.percentile(shown, _HIGHEST)), float(shown.min()) + 0.1)
    _field(heights, surface, millimetres, "viridis", (float(shown.min()), high), "mm")
    heights.set_title("Height above the sole plane")
    depth = channel_depth(surface) * 1e3
    deepest = max(float(np.nanmax(depth)), 0.1)
    depth = np.where(surface.land | ~surface.inside, np.nan, depth)
    _field(depths, surface, depth, "Blues", (0.0, deepest), "mm")
    depths.set_title("Depth of the channels")
    _parts(parts, surface, measures)
    for axes in (heights, depths, parts):
        rim = surface.outline * 1e3
        axes.plot(rim[:, 1], rim[:, 0], color="0.25", linewidth=1.0)
        frame_sole(axes, surface.x * 1e3, surface.y * 1e3, surface.inside)
        axes.set_xticks([])
        axes.set_yticks([])
    figure.suptitle(f"{surface.name}, seen from below", fontsize="large")
    return figure


def _field(
    axes: Axes,
    surface: SoleSurface,
    values: np.ndarray,
    colours: str,
    limits: tuple[float, float],
    unit: str,
) -> None:
    image = axes.pcolormesh(
        surface.y * 1e3, surface.x * 1e3, np.ma.masked_invalid(values), cmap=colours,
        vmin=limits[0], vmax=limits[1], shading="nearest", rasterized=True,
    )  # fmt: skip
    bar = axes.figure.colorbar(image, ax=axes, fraction=0.05, pad=0.03)
    bar.ax.set_title(unit, fontsize="small")


def _parts(axes: Axes, surface: SoleSurface, measures: TreadMeasures) -> None:
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    from underfoot.outsole.tread_measures import largest_patch

    channel = surface.inside & ~surface.land
    closed = channel & ~draining(surface)
    parts = np.full(surface.height.shape, np.nan)
    parts[surface.land] = 0
    parts[channel] = 1
    parts[closed] = 2
    parts[largest_patch(surface)] = 3
    colours = ["0.72", "#dfeaf3", _CLOSED, _PATCH]
    axes.pcolormesh(
        surface.y * 1e3, surface.x * 1e3, np.ma.masked_invalid(parts),
        cmap=ListedColormap(colours), vmin=-0.5, vmax=3.5, shading="nearest", rasterized=True,
    )  # fmt: skip
    names = ["land", "channels open to the rim", "closed channels"]
    names.append(f"largest untreaded patch, {measures.patch_area * 1e6:.3g} mm²")
    present = [(parts == number).any() for number in range(4)]
    handles = [
        Patch(facecolor=colour, edgecolor="0.5", linewidth=0.5, label=name)
        for colour, name, there in zip(colours, names, present, strict=True)
        if there
    ]
    axes.legend(
        handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), frameon=False, fontsize=8
    )
    axes.set_title(f"Land {measures.land_ratio:.0%} of the plan form")
