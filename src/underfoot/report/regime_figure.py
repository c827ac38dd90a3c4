"""Picture of lubrication regimes: lambda against speed for fluids, and a map over viscosity."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError
from underfoot.core.html import new_figure
from underfoot.core.remark import Message
from underfoot.film import RegimeMap
from underfoot.film.regimes import LAMBDA_LIMITS, SHARE_LIMITS

from .dispatch import plot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BANDS = ("#e9d8c4", "#f3efe6", "#d5e4ec")
INK = ("#7a1f1f", "#b5651d", "#c9a227", "#4f7942", "#1f5c7a", "#3b2a6b", "#666666", "#111111")


@plot.register(RegimeMap)
def regime_figure(
    regimes: RegimeMap, fluids: Mapping[str, float] | None = None, title: str = ""
) -> Figure:
    """Return two panels: lambda against speed for each fluid, and the regimes over viscosity.

    ``regimes`` is what ``film.regime_map`` gives, over at least two viscosities and two
    speeds; ``fluids`` names viscosities (Pa s) to draw, between the map's ends. Where the map
    holds the fluid's load share, its limits are drawn over those of lambda. Bands and limits are
    those of ``film.regimes`` (``LAMBDA_LIMITS``, ``SHARE_LIMITS``); assumptions and breaches stand
    below.
    """
    if min(regimes.lambda_ratio.shape) < 2:
        raise InputError(
            "a map needs two viscosities and two speeds", where="regimes", allowed="2 x 2 or more"
        )
    fluids = dict(fluids or {})
    low, high = float(regimes.viscosity.min()), float(regimes.viscosity.max())
    for name, viscosity in fluids.items():
        if not low <= viscosity <= high:
            raise InputError(
                Message(
                    "{name} ({viscosity:.3g} mPa s) is not on the map",
                    name=name,
                    viscosity=viscosity * 1000.0,
                ),
                where="fluids",
                allowed=Message(
                    "{low:.3g} to {high:.3g} mPa s", low=low * 1000.0, high=high * 1000.0
                ),
                remedy="Draw the map over more viscosities.",
            )
    figure = new_figure(10.5, 5.2)
    left, right = figure.subplots(1, 2)
    _by_speed(left, regimes, fluids)
    _map(right, regimes, fluids)
    for axes in (left, right):
        axes.set(xscale="log", yscale="log", xlabel="sliding speed (m/s)")
        axes.set_xlim(regimes.speed.min(), regimes.speed.max())
    if title:
        figure.suptitle(title)
    notes = [*regimes.assumptions, *(str(breach) for breach in regimes.breaches)]
    figure.supxlabel("\n".join(notes), fontsize=7, color="#555555")
    return figure


def _by_speed(ax: Axes, regimes: RegimeMap, fluids: Mapping[str, float]) -> None:
    curves = {name: _interpolate_lambda(regimes, fluids[name]) for name in fluids}
    shown = np.concatenate(list(curves.values())) if curves else regimes.lambda_ratio.ravel()
    floor = min(float(shown.min()) / 1.5, LAMBDA_LIMITS[0] / 2)
    ceiling = max(float(shown.max()) * 1.5, LAMBDA_LIMITS[1] * 2)
    edges = (floor, *LAMBDA_LIMITS, ceiling)
    names = ("boundary", "mixed", "full film")
    for start, end, colour, name in zip(edges[:-1], edges[1:], BANDS, names, strict=True):
        ax.axhspan(start, end, color=colour, zorder=0)
        ax.text(0.02, end / 1.12, name, transform=ax.get_yaxis_transform(), va="top")
    for number, (name, curve) in enumerate(curves.items()):
        ax.loglog(regimes.speed, curve, color=INK[number % len(INK)], label=name)
    ax.set(ylim=(floor, ceiling), ylabel="film over roughness, λ", title="λ against speed")
    if curves:
        ax.legend(fontsize=8, loc="lower right")


def _map(ax: Axes, regimes: RegimeMap, fluids: Mapping[str, float]) -> None:
    from matplotlib.colors import ListedColormap
    from matplotlib.lines import Line2D

    speed, viscosity = regimes.speed, regimes.viscosity * 1e3
    parts = np.digitize(regimes.lambda_ratio, LAMBDA_LIMITS).astype(float)
    scale: dict[str, Any] = {"cmap": ListedColormap(BANDS), "vmin": -0.5, "vmax": 2.5}
    ax.pcolormesh(speed, viscosity, parts, shading="nearest", **scale)
    lines = _limits(ax, speed, viscosity, regimes.lambda_ratio, LAMBDA_LIMITS, "solid")
    text = f"λ = {LAMBDA_LIMITS[0]:g} and {LAMBDA_LIMITS[1]:g}"
    keys = [Line2D([], [], color="#333333", label=text)]
    if regimes.fluid_share is not None:
        lines |= _limits(ax, speed, viscosity, regimes.fluid_share, SHARE_LIMITS, "dashed")
        low, high = SHARE_LIMITS
        text = Message("fluid carries {low:.0%} and {high:.0%}", low=low, high=high)
        keys.append(Line2D([], [], color="#333333", linestyle="dashed", label=text))
    box = {"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 1.0}
    style: dict[str, Any] = {"va": "center", "bbox": box, "transform": ax.get_yaxis_transform()}
    for index, (name, value) in enumerate(sorted(fluids.items(), key=lambda item: item[1])):
        colour = INK[list(fluids).index(name) % len(INK)]
        ax.axhline(value * 1e3, color=colour, linewidth=0.8)
        place, side = ((0.02, "left"), (0.98, "right"))[index % 2]  # neighbours do not overlap
        ax.text(place, value * 1e3, name, color=colour, fontsize=7, ha=side, **style)
    ax.set_ylim(viscosity.min(), viscosity.max())
    ax.set(ylabel="viscosity (mPa s)", title="boundary, mixed and full film")
    if lines:
        ax.legend(handles=keys, fontsize=8, loc="lower right")


def _limits(
    ax: Axes, x: ArrayLike, y: ArrayLike, field: np.ndarray, limits: tuple[float, ...], style: str
) -> bool:
    """Draw the limits that the map crosses and return whether there is one."""
    crossed = [limit for limit in limits if field.min() < limit < field.max()]
    if crossed:
        ax.contour(x, y, field, levels=crossed, colors="#333333", linestyles=style)
    return bool(crossed)


def _interpolate_lambda(regimes: RegimeMap, viscosity: float) -> np.ndarray:
    """Return lambda over speed at one viscosity: a power law between the map's rows."""
    rows = np.log(regimes.viscosity)
    order = np.argsort(rows)
    table = np.log(regimes.lambda_ratio)[order]
    return np.exp([np.interp(np.log(viscosity), rows[order], column) for column in table.T])
