"""A figure as data: panels of series with printed values beside them; ``report`` draws it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

PRINTED, OURS, SECOND, GREY = "#b3472f", "#12355b", "#7fb3d5", "#5b5b5b"
COLOURS = (OURS, "#2e86ab", "#3c9d6d", "#b8860b", "#c8553d", "#7a3e6b", GREY, "#9bb53c")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
Mark = Literal[
    "line", "points", "bars", "across", "band", "level", "limit", "span", "stack", "map", "outline"
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Layer:
    """One series of a panel.

    Parameters:
        mark: "line", "points", "bars", "across" (bars from the left), "band" (low to high), "level"
            and "limit" (a line at y or x), "span" (from low to high, the whole width), "stack" (on
            those before it), "map" (z over x and y), "outline" (of a map).
        x, y, z, low, high: Numbers in the panel's units, array_like, kept as lists; low and high
            are the ends of a band or of error bars.
        width: Of bars.
    """

    mark: Mark
    x: Any = ()
    y: Any = ()
    z: Any = ()
    low: Any = ()
    high: Any = ()
    label: str = ""
    colour: str = OURS
    style: str = "-"
    marker: str = ""
    width: float = 0.8

    def __post_init__(self) -> None:
        for name in ("x", "y", "z", "low", "high"):
            values = np.atleast_1d(np.asarray(getattr(self, name), dtype=float))
            object.__setattr__(self, name, values.tolist())


@dataclass(frozen=True, slots=True)
class Panel:
    """Series on one pair of axes; ticks are places, or names of the places 0, 1, 2 ..."""

    layers: Sequence[Layer]
    x_label: str = ""
    y_label: str = ""
    title: str = ""
    x_scale: str = "linear"
    y_scale: str = "linear"
    x_limits: tuple[float | None, float | None] = (None, None)
    y_limits: tuple[float | None, float | None] = (None, None)
    x_ticks: Sequence[str] | Sequence[float] = ()
    y_ticks: Sequence[str] | Sequence[float] = ()
    legend: str = "best"
    """Matplotlib's place of the legend; "" for none."""
    note: str = ""
    """Text in the middle of a panel that has nothing to show."""


@dataclass(frozen=True, slots=True)
class Figure:
    """Panels in rows of ``columns``, each ``size`` (width, height) in inches."""

    panels: Sequence[Panel]
    title: str = ""
    columns: int = 1
    size: tuple[float, float] = (4.2, 3.2)
    share_x: bool = False
    share_y: bool = False
    colour_bar: str = ""
    legend_below: bool = False

    def rows(self) -> list[tuple[str, str, float, float, float | None, float | None]]:
        """Return (panel, series, x, y, low, high) of every point that is drawn."""
        rows = []
        for title, layer in (
            (panel.title, layer) for panel in self.panels for layer in panel.layers
        ):
            if layer.mark == "map":
                rows += [
                    (title, f"map at y {y:g}", x, z, None, None)
                    for x, column in zip(layer.x, layer.z, strict=True)
                    for y, z in zip(layer.y, column, strict=True)
                ]
            elif layer.mark != "span":
                count = max(len(layer.x), len(layer.y))
                x, y = (values or [float("nan")] * count for values in (layer.x, layer.y))
                low, high = (ends or [None] * count for ends in (layer.low, layer.high))
                name = layer.label or layer.mark
                rows += [(title, name, *point) for point in zip(x, y, low, high, strict=True)]
        return rows


def line(x: ArrayLike, y: ArrayLike, label: str = "", **style: Any) -> Layer:
    """Return a line through points (x, y)."""
    return Layer("line", x, y, label=label, **style)


def points(x: ArrayLike, y: ArrayLike, label: str = "", **style: Any) -> Layer:
    """Return markers at (x, y), with error bars where ``low`` and ``high`` are given."""
    return Layer("points", x, y, label=label, **style)


def level(y: ArrayLike, label: str = "", **style: Any) -> Layer:
    """Return lines at y over the whole width."""
    return Layer("level", y=y, label=label, **style)


def grouped_bars(
    groups: Mapping[str, ArrayLike],
    *,
    colours: Sequence[str] = COLOURS,
    low: Mapping[str, ArrayLike] | None = None,
    high: Mapping[str, ArrayLike] | None = None,
) -> list[Layer]:
    """Return bars side by side: one series a group, one place for each of its values."""
    width = 0.8 / len(groups)
    return [
        Layer(
            "bars",
            [i + (k - 0.5 * (len(groups) - 1)) * width for i in range(np.size(values))],
            values,
            low=low[label] if low else (),
            high=high[label] if high else (),
            label=label,
            colour=colours[k % len(colours)],
            width=0.92 * width,
        )
        for k, (label, values) in enumerate(groups.items())
    ]
