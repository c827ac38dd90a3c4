"""A figure as data: panels of series with printed values beside them; ``report`` draws it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

PRINTED, OURS, SECOND, GREY = "#b3472f", "#12355b", "#7fb3d5", "#5b5b5b"
COLOURS = (OURS, "#2e86ab", "#3c9d6d", "#b8860b", "#c8553d", "#7a3e6b", GREY, "#9bb53c")
Mark = Literal[
    "line",
    "points",
    "bars",
    "across",
    "band",
    "level",
    "limit",
    "span",
    "stack",
    "map",
    "text",
    "outline",
]


@dataclass(frozen=True, slots=True)
class Layer:
    """One series of a panel.

    Parameters
    ----------
    mark
        "line", "points", "bars", "across" (bars from the left), "band" (low to high), "level" and
        "limit" (a line at y or x), "span" (from low to high, the whole width), "stack" (on those
        before it), "map" (z over x and y), "text" (label at x, y), "outline" (of a map).
    x, y, z, low, high
        Numbers in the panel's units; low and high are the ends of a band or of error bars.
    width
        Of bars.
    """

    mark: Mark
    x: Sequence[float] = ()
    y: Sequence[float] = ()
    z: Sequence[Sequence[float]] = ()
    low: Sequence[float] = ()
    high: Sequence[float] = ()
    label: str = ""
    colour: str = OURS
    style: str = "-"
    marker: str = ""
    width: float = 0.8


@dataclass(frozen=True, slots=True)
class Panel:
    """Series on one pair of axes; ticks are (place, label)."""

    layers: tuple[Layer, ...]
    x_label: str = ""
    y_label: str = ""
    title: str = ""
    x_scale: str = "linear"
    y_scale: str = "linear"
    x_limits: tuple[float | None, float | None] = (None, None)
    y_limits: tuple[float | None, float | None] = (None, None)
    x_ticks: tuple[tuple[float, str], ...] = ()
    y_ticks: tuple[tuple[float, str], ...] = ()
    legend: str = "best"
    """Matplotlib's place of the legend; "" for none."""
    note: str = ""
    """Text in the middle of a panel that has nothing to show."""


@dataclass(frozen=True, slots=True)
class Figure:
    """Panels in rows of ``columns``, each ``size`` (width, height) in inches."""

    panels: tuple[Panel, ...]
    title: str = ""
    columns: int = 1
    size: tuple[float, float] = (4.2, 3.2)
    share_x: bool = False
    share_y: bool = False
    colour_bar: str = ""
    legend_below: bool = False

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Figure:
        """Return the figure that ``as_dict`` wrote."""
        panels = []
        for panel in content["panels"]:
            layers = tuple(Layer(**layer) for layer in panel["layers"])
            ticks = {k: tuple((v, t) for v, t in panel[k]) for k in ("x_ticks", "y_ticks")}
            limits = {k: tuple(panel[k]) for k in ("x_limits", "y_limits")}
            panels.append(Panel(**{**panel, **ticks, **limits, "layers": layers}))
        return cls(**{**content, "panels": tuple(panels), "size": tuple(content["size"])})

    def rows(self) -> list[tuple[str, str, float, float, float | None, float | None]]:
        """Return (panel, series, x, y, low, high) of every point that is drawn."""
        found = []
        for panel in self.panels:
            for layer in panel.layers:
                name = layer.label or layer.mark
                if layer.mark == "map":
                    for x, column in zip(layer.x, layer.z, strict=True):
                        found += [
                            (panel.title, f"map at y {y:g}", x, z, None, None)
                            for y, z in zip(layer.y, column, strict=True)
                        ]
                elif layer.mark not in ("text", "span"):
                    count = max(len(layer.x), len(layer.y))
                    nothing = [float("nan")] * count
                    low, high = (list(ends) or [None] * count for ends in (layer.low, layer.high))
                    x, y = layer.x or nothing, layer.y or nothing
                    found += [
                        (panel.title, name, *point) for point in zip(x, y, low, high, strict=True)
                    ]
        return found


def numbers(values: ArrayLike) -> list[float]:
    """Return an array as plain floats."""
    return np.asarray(values, dtype=float).tolist()


def line(x: ArrayLike, y: ArrayLike, label: str = "", **style: Any) -> Layer:
    """Return a line through points (x, y)."""
    return Layer("line", numbers(x), numbers(y), label=label, **style)


def points(x: ArrayLike, y: ArrayLike, label: str = "", **style: Any) -> Layer:
    """Return markers at (x, y), with error bars where ``low`` and ``high`` are given."""
    ends = {k: numbers(style.pop(k)) for k in ("low", "high") if k in style}
    return Layer("points", numbers(x), numbers(y), label=label, **ends, **style)


def grouped_bars(
    groups: Mapping[str, Sequence[float]],
    *,
    colours: Sequence[str] = COLOURS,
    low: Mapping[str, Sequence[float]] | None = None,
    high: Mapping[str, Sequence[float]] | None = None,
) -> tuple[Layer, ...]:
    """Return bars side by side: one series a group, one place for each of its values."""
    width = 0.8 / len(groups)
    layers = []
    for k, (label, values) in enumerate(groups.items()):
        places = [i + (k - 0.5 * (len(groups) - 1)) * width for i in range(len(values))]
        layers.append(
            Layer(
                "bars",
                places,
                numbers(values),
                label=label,
                colour=colours[k % len(colours)],
                width=0.92 * width,
                low=numbers(low[label]) if low else (),
                high=numbers(high[label]) if high else (),
            )
        )
    return tuple(layers)


def names_as_ticks(names: Sequence[str]) -> tuple[tuple[float, str], ...]:
    """Return ticks at 0, 1, 2 ... with these names."""
    return tuple((float(i), name) for i, name in enumerate(names))
