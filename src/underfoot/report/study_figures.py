"""The one drawer of the studies' figures: panels and series from ``studies.figure``."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from underfoot.studies.figure import Figure as FigureData
    from underfoot.studies.figure import Layer, Panel


def drawn(figure: FigureData) -> Figure:
    """Return the picture of a figure's data."""
    from matplotlib.figure import Figure

    rows = math.ceil(len(figure.panels) / figure.columns)
    size = (figure.size[0] * figure.columns, figure.size[1] * rows + 0.5)
    picture = Figure(figsize=size, layout="constrained")
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
        columns = min(len(labels), 6 if len(labels) < 6 else 3)
        picture.legend(
            labels.values(),
            labels.keys(),
            loc="outside lower center",
            ncols=columns,
            frameon=False,
            fontsize=8,
        )
    if figure.title:
        picture.suptitle(figure.title, fontsize=11)
    return picture


def _draw(axes: Axes, panel: Panel, highest: float, *, legend: bool) -> Any:
    axes.set_xscale(panel.x_scale)
    if panel.y_scale == "symlog":
        axes.set_yscale("symlog", linthresh=1.0, linscale=0.6)
    else:
        axes.set_yscale(panel.y_scale)
    image = None
    stacked: list[Layer] = [layer for layer in panel.layers if layer.mark == "stack"]
    if stacked:
        axes.stackplot(
            stacked[0].x,
            *(layer.y for layer in stacked),
            colors=[s.colour for s in stacked],
            labels=[s.label for s in stacked],
        )
    for layer in panel.layers:
        if layer.mark == "map":
            image = axes.pcolormesh(
                layer.x,
                layer.y,
                np.asarray(layer.z).T,
                vmin=0.0,
                vmax=highest,
                cmap="viridis",
                shading="nearest",
                rasterized=True,
            )
            axes.set_aspect("equal")
        elif layer.mark != "stack":
            _MARKS[layer.mark](axes, layer)
    axes.set_title(panel.title, fontsize=9.5)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    for limits, put in ((panel.x_limits, axes.set_xlim), (panel.y_limits, axes.set_ylim)):
        put(*limits)
    for ticks, axis in ((panel.x_ticks, axes.xaxis), (panel.y_ticks, axes.yaxis)):
        if ticks:
            long = axis is axes.xaxis and max(len(name) for _, name in ticks) > 12
            turned: dict[str, Any] = {"rotation": 20, "ha": "right"} if long else {}
            axis.set_ticks(
                [place for place, _ in ticks], [n for _, n in ticks], fontsize=8, **turned
            )
            axis.set_minor_locator(_no_ticks())
    if panel.note:
        axes.set_xticks([])
        axes.text(
            0.5, 0.5, panel.note, transform=axes.transAxes, ha="center", va="center", color="0.35"
        )
    if legend and panel.legend and axes.get_legend_handles_labels()[0]:
        place: Any = panel.legend
        axes.legend(frameon=False, fontsize=8, loc=place)
    axes.spines[["top", "right"]].set_visible(False)
    return image


def _no_ticks() -> Any:
    from matplotlib.ticker import NullLocator

    return NullLocator()


def _line(axes: Axes, s: Layer) -> None:
    axes.plot(
        s.x,
        s.y,
        linestyle=s.style,
        color=s.colour,
        marker=s.marker or None,
        markersize=4.5,
        linewidth=1.5,
        label=s.label or None,
    )


def _points(axes: Axes, s: Layer) -> None:
    if s.low:
        error = np.abs(np.array([np.subtract(s.y, s.low), np.subtract(s.high, s.y)]))
        axes.errorbar(
            s.x, s.y, yerr=error, linestyle="none", color=s.colour, capsize=3, linewidth=1
        )
    filled = s.marker in (".", "s", "D")
    axes.plot(
        s.x,
        s.y,
        linestyle="none",
        marker=s.marker or "o",
        color=s.colour,
        label=s.label or None,
        markersize=5.5,
        markerfacecolor=s.colour if filled else "none",
        markeredgewidth=1.3,
    )


def _bars(axes: Axes, s: Layer) -> None:
    axes.bar(
        s.x, s.y, s.width, color=s.colour, label=s.label or None, edgecolor="0.35", linewidth=0.6
    )
    if s.low:
        for x, low, high in zip(s.x, s.low, s.high, strict=True):
            axes.plot([x, x], [low, high], color="white", linewidth=3.0)
            axes.plot([x, x], [low, high], color="0.2", linewidth=1.2)


def _across(axes: Axes, s: Layer) -> None:
    axes.barh(s.y, s.x, s.width, color=s.colour, label=s.label or None)


def _band(axes: Axes, s: Layer) -> None:
    axes.fill_between(
        s.x, s.low, s.high, color=s.colour, alpha=0.15, linewidth=0, label=s.label or None
    )


def _level(axes: Axes, s: Layer) -> None:
    for y in s.y:
        axes.axhline(y, color=s.colour, linestyle=s.style, linewidth=1.0, label=s.label or None)


def _limit(axes: Axes, s: Layer) -> None:
    for x in s.x:
        axes.axvline(x, color=s.colour, linestyle=s.style, linewidth=1.0, label=s.label or None)


def _span(axes: Axes, s: Layer) -> None:
    put = axes.axhspan if s.style == "horizontal" else axes.axvspan
    put(
        s.low[0],
        s.high[0],
        color=s.colour,
        alpha=0.25,
        linewidth=0,
        label=s.label or None,
        zorder=0,
    )


def _text(axes: Axes, s: Layer) -> None:
    axes.text(s.x[0], s.y[0], s.label, color=s.colour, fontsize=8)


def _outline(axes: Axes, s: Layer) -> None:
    axes.plot(s.x, s.y, color=s.colour, linewidth=1.2)


_MARKS: dict[str, Callable[[Axes, Layer], None]] = {
    "line": _line,
    "points": _points,
    "bars": _bars,
    "across": _across,
    "band": _band,
    "level": _level,
    "limit": _limit,
    "span": _span,
    "text": _text,
    "outline": _outline,
}
