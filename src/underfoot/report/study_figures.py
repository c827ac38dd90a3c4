"""The one drawer of figures that are data (``studies.figure``), and friction against speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core.html import new_figure
from underfoot.studies.figure import COLOURS, MARKERS, Layer, Panel, line, points
from underfoot.studies.figure import Figure as FigureData

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from underfoot.calibrate import StribeckCurve

PART_COLOURS = {"adhesion": "#c8553d", "hysteresis": "#2e86ab", "viscous": "#3c9d6d"}


def draw_figure(figure: FigureData) -> Figure:
    """Return the picture of a figure's data."""
    rows = math.ceil(len(figure.panels) / figure.columns)
    picture = new_figure(figure.size[0] * figure.columns, figure.size[1] * rows + 0.5)
    grid = picture.subplots(
        rows, figure.columns, squeeze=False, sharex=figure.share_x, sharey=figure.share_y
    ).ravel()
    # one colour scale for all maps of a figure
    maps = [layer for panel in figure.panels for layer in panel.layers if layer.mark == "map"]
    highest = max((float(np.max(layer.z)) for layer in maps), default=1.0)
    image = None
    for axes, panel in zip(grid, figure.panels, strict=False):
        image = _draw(axes, panel, highest, legend=not figure.legend_below) or image
    for axes in grid[len(figure.panels) :]:
        axes.set_visible(False)
    if figure.share_y:
        for axes in grid:
            axes.label_outer(remove_inner_ticks=False)
    if image is not None:
        picture.colorbar(image, ax=list(grid), fraction=0.05, label=figure.colour_bar)
    if figure.legend_below:
        labels: dict[str, Any] = {}
        for axes in grid:
            labels |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
        columns = len(labels) if len(labels) < 6 else 3
        place: Any = {"loc": "outside lower center", "ncols": columns}
        picture.legend(labels.values(), labels.keys(), frameon=False, fontsize=8, **place)
    if figure.title:
        picture.suptitle(figure.title, fontsize=11)
    return picture


def _draw(axes: Axes, panel: Panel, highest: float, *, legend: bool) -> Any:
    """Draw a panel and return the image of its map, if it has one."""
    axes.set_xscale(panel.x_scale)
    symmetric = {"linthresh": 1.0, "linscale": 0.6} if panel.y_scale == "symlog" else {}
    axes.set_yscale(panel.y_scale, **symmetric)
    stack = [layer for layer in panel.layers if layer.mark == "stack"]
    if stack:
        axes.stackplot(
            stack[0].x,
            *(layer.y for layer in stack),
            colors=[layer.colour for layer in stack],
            labels=[layer.label for layer in stack],
        )
    images = [_draw_layer(axes, layer, highest) for layer in panel.layers]
    axes.set_title(panel.title, fontsize=9.5)
    axes.set(xlabel=panel.x_label, ylabel=panel.y_label)
    axes.set(xlim=panel.x_limits, ylim=panel.y_limits)
    for ticks, axis in ((panel.x_ticks, axes.xaxis), (panel.y_ticks, axes.yaxis)):
        if ticks:
            _set_ticks(axis, ticks, turn=axis is axes.xaxis)
    if panel.note:
        axes.set_xticks([])
        place: Any = {"transform": axes.transAxes, "ha": "center", "va": "center"}
        axes.text(0.5, 0.5, panel.note, color="0.35", **place)
    if legend and panel.legend and axes.get_legend_handles_labels()[0]:
        where: Any = panel.legend
        axes.legend(frameon=False, fontsize=8, loc=where)
    axes.spines[["top", "right"]].set_visible(False)
    return next((image for image in images if image is not None), None)


def _set_ticks(axis: Any, ticks: Sequence[str] | Sequence[float], *, turn: bool) -> None:
    """Put names at 0, 1, 2 ..., or numbers at their places; long names are turned."""
    from matplotlib.ticker import NullLocator

    named = isinstance(ticks[0], str)
    names = [tick if isinstance(tick, str) else f"{tick:g}" for tick in ticks]
    turned = {"rotation": 20, "ha": "right"} if turn and max(map(len, names)) > 12 else {}
    axis.set_ticks(range(len(ticks)) if named else ticks, names, fontsize=8, **turned)
    axis.set_minor_locator(NullLocator())


def _draw_layer(axes: Axes, s: Layer, highest: float) -> Any:
    """Draw one series and return the image of a map."""
    common: dict[str, Any] = {"color": s.colour, "label": s.label or None}
    match s.mark:
        case "line" | "outline":
            width = 1.5 if s.mark == "line" else 1.2
            marker = {"marker": s.marker or None, "markersize": 4.5}
            axes.plot(s.x, s.y, linestyle=s.style, linewidth=width, **marker, **common)
        case "points":
            if s.low:
                error = np.abs([np.subtract(s.y, s.low), np.subtract(s.high, s.y)])
                bars = {"linestyle": "none", "capsize": 3, "linewidth": 1}
                axes.errorbar(s.x, s.y, yerr=error, color=s.colour, **bars)
            fill = s.colour if s.marker in (".", "s", "D") else "none"
            edge = {"markersize": 5.5, "markerfacecolor": fill, "markeredgewidth": 1.3}
            axes.plot(s.x, s.y, linestyle="none", marker=s.marker or "o", **edge, **common)
        case "bars":
            axes.bar(s.x, s.y, s.width, edgecolor="0.35", linewidth=0.6, **common)
            for x, low, high in zip(s.x if s.low else (), s.low, s.high, strict=True):
                axes.plot([x, x], [low, high], color="white", linewidth=3.0)
                axes.plot([x, x], [low, high], color="0.2", linewidth=1.2)
        case "across":
            axes.barh(s.y, s.x, s.width, **common)
        case "band":
            axes.fill_between(s.x, s.low, s.high, alpha=0.15, linewidth=0, **common)
        case "level" | "limit":
            for put, places in ((axes.axhline, s.y), (axes.axvline, s.x)):
                for place in places:
                    put(place, linestyle=s.style, linewidth=1.0, **common)
        case "span":
            put = axes.axhspan if s.style == "horizontal" else axes.axvspan
            put(s.low[0], s.high[0], alpha=0.25, linewidth=0, zorder=0, **common)
        case "map":
            axes.set_aspect("equal")
            scale: Any = {"vmin": 0.0, "vmax": highest, "cmap": "viridis"}
            return axes.pcolormesh(
                s.x, s.y, np.transpose(s.z), shading="nearest", rasterized=True, **scale
            )
    return None


def stribeck_figure(curves: Sequence[StribeckCurve], title: str = "") -> Figure:
    """Return COF over speed, over viscosity x speed, and the parts of every fluid.

    Bands hold 95 %; points what was published for the fluid on its own pair.
    """
    notes = []
    pairs = dict.fromkeys(curve.pair for curve in curves if curve.points is not None)
    if pairs:
        notes.append(f"points: published, {', '.join(pairs)}")
    if any(curve.interval is not None for curve in curves):
        notes.append("bands: 95 % intervals")
    axes: dict[str, Any] = {"x_scale": "log", "y_limits": (0.0, None)}
    panels = []
    for name, product in (("sliding speed (m/s)", False), ("viscosity × speed (mPa m)", True)):
        layers: list[Layer] = []
        for index, curve in enumerate(curves):
            style: dict[str, Any] = {"colour": COLOURS[index % len(COLOURS)]}
            scale = curve.viscosity * 1e3 if product else 1.0
            whole = np.sum([curve.parts[part] for part in PART_COLOURS], axis=0)
            layers.append(line(curve.speed * scale, whole, curve.label, **style))
            if curve.interval is not None:
                low, high = curve.interval
                layers.append(Layer("band", curve.speed * scale, low=low, high=high, **style))
            if curve.points is not None:
                speed, cof = curve.points
                style["marker"] = MARKERS[index % len(MARKERS)]
                layers.append(points(speed * scale, cof, **style))
        note, legend = ("; ".join(notes), "best") if product else ("", "")
        panels.append(Panel(layers, name, "COF", note, legend=legend, **axes))
    for curve in curves:
        parts = [
            Layer("stack", curve.speed, curve.parts[part], label=part, colour=colour)
            for part, colour in PART_COLOURS.items()
        ]
        name = f"{curve.label}, in its parts"
        panels.append(Panel(parts, "sliding speed (m/s)", "COF", name, **axes))
    return draw_figure(
        FigureData(panels, title, columns=2 if len(curves) < 3 else 3, size=(4.8, 3.4))
    )
