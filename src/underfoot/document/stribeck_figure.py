"""Friction against speed and against viscosity x speed: curves, parts, intervals, points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#12355b", "#2e86ab", "#3c9d6d", "#b8860b", "#c8553d", "#7a3e6b", "#5b5b5b", "#9bb53c")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
PART_COLOURS = {"adhesion": "#c8553d", "hysteresis": "#2e86ab", "viscous": "#3c9d6d"}


class FluidCurve(Protocol):
    """COF of one fluid over speed (m/s), in its parts, with what was measured."""

    @property
    def label(self) -> str:
        """Name of the fluid."""
        ...

    @property
    def viscosity(self) -> float:
        """Pa s."""
        ...

    @property
    def speed(self) -> np.ndarray:
        """m/s."""
        ...

    @property
    def parts(self) -> dict[str, np.ndarray]:
        """Adhesion, hysteresis and viscous part of COF."""
        ...

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Bounds of the central 95 % of COF, if known."""
        ...

    @property
    def points(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Measured speeds and COF, if any."""
        ...

    @property
    def pair(self) -> str:
        """Sole and floor the points were measured on."""
        ...


def stribeck_figure(curves: Sequence[FluidCurve], title: str = "") -> Figure:
    """Return COF over speed, over viscosity x speed, and the parts of every fluid.

    Bands hold 95 %; points what was published for the fluid on its own pair.
    """
    from matplotlib.figure import Figure

    count = len(curves)
    columns = min(count, 4)
    rows = -(-count // columns)
    figure = Figure(figsize=(10.5, 4.6 + 2.4 * rows), layout="constrained")
    halves: Any = figure.subfigures(2, 1, height_ratios=(4.4, 2.4 * rows))
    above, below = halves
    axes = np.ravel(np.asarray(above.subplots(1, 2, sharey=True)))
    for index, curve in enumerate(curves):
        colour = COLOURS[index % len(COLOURS)]
        marker = MARKERS[index % len(MARKERS)]
        whole = _whole(curve)
        for ax, scale in ((axes[0], 1.0), (axes[1], curve.viscosity * 1e3)):
            place = curve.speed * scale
            ax.plot(place, whole, color=colour, label=curve.label, lw=1.8)
            if curve.interval is not None:
                ax.fill_between(place, *curve.interval, color=colour, alpha=0.10, lw=0)
            if curve.points is not None:
                speed, cof = curve.points
                ax.plot(
                    speed * scale, cof, marker, color=colour, ms=4.5, mfc="white", mew=1.2, ls=""
                )
    for ax, name in ((axes[0], "sliding speed (m/s)"), (axes[1], "viscosity × speed (mPa m)")):
        _log_axis(ax, name)
    axes[0].set_ylabel("COF")
    axes[0].set_ylim(bottom=0.0)
    notes = []
    pairs = dict.fromkeys(curve.pair for curve in curves if curve.points is not None)
    if pairs:
        notes.append(f"points: published, {', '.join(pairs)}")
    if any(curve.interval is not None for curve in curves):
        notes.append("bands: 95 % intervals")
    axes[1].legend(frameon=False, fontsize=8, title="\n".join(notes), title_fontsize=8)
    small = np.atleast_1d(below.subplots(rows, columns, sharey=True, squeeze=False)).ravel()
    for index, (ax, curve) in enumerate(zip(small, curves, strict=False)):
        values = [curve.parts[name] for name in PART_COLOURS]
        ax.stackplot(
            curve.speed, values, colors=list(PART_COLOURS.values()), labels=list(PART_COLOURS)
        )
        _log_axis(ax, "sliding speed (m/s)" if index >= count - columns else "")
        ax.set_title(curve.label, fontsize=9)
        ax.margins(x=0)
        if index % columns == 0:
            ax.set_ylabel("COF")
    for ax in small[count:]:
        ax.set_visible(False)
    handles, names = small[0].get_legend_handles_labels()
    below.legend(handles, names, frameon=False, fontsize=8, loc="outside lower center", ncols=3)
    if title:
        figure.suptitle(title)
    return figure


def master_figure(
    curves: Sequence[Any], master: tuple[np.ndarray, np.ndarray], residual: str
) -> Figure:
    """Return Fig. 16: all COF over viscosity x speed, one curve, and what is left beside it.

    ``curves`` have ``label``, ``viscosity``, ``speed``, ``published`` and ``kind``; ``master`` is
    viscosity x speed (Pa m) and COF; ``residual`` goes into the title.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.6, 6.2), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1.2))
    axes[0].plot(master[0] * 1e3, master[1], color="black", lw=1.5, label="one curve, all fluids")
    axes[1].axhline(0.0, color="black", lw=1.0)
    for index, curve in enumerate(curves):
        place = curve.viscosity * curve.speed
        fitted = np.interp(np.log(place), np.log(master[0]), master[1])
        mean = " (mean)" if curve.kind == "mean" else ""
        style: dict[str, Any] = {
            "color": COLOURS[index % len(COLOURS)], "marker": MARKERS[index % len(MARKERS)],
            "ms": 5, "mfc": "white", "mew": 1.3, "ls": "",
        }  # fmt: skip
        axes[0].plot(place * 1e3, curve.published, label=curve.label + mean, **style)
        axes[1].plot(place * 1e3, curve.published - fitted, **style)
    axes[0].set_ylabel("COF (published fits and means)")
    axes[0].set_ylim(bottom=0.0)
    axes[0].legend(frameon=False, fontsize=8)
    axes[0].set_title(f"All fluids over viscosity × speed: {residual}", fontsize=10)
    axes[1].set_ylabel("published − curve")
    _log_axis(axes[1], "viscosity × speed (mPa m)")
    axes[0].set_xscale("log")
    axes[0].grid(alpha=0.25)
    return figure


def blind_figure(curves: Sequence[Any], calibrated_on: str) -> Figure:
    """Return predictions of each fluid with their intervals beside the published points.

    ``curves`` as in ``master_figure``, with ``predicted``, ``low`` and ``high``.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 6.0), layout="constrained")
    axes = figure.subplots(-(-len(curves) // 3), 3, sharex=True, sharey=True).ravel()
    for index, (ax, curve) in enumerate(zip(axes, curves, strict=False)):
        own = curve.label == calibrated_on
        colour = "#5b5b5b" if own else "#12355b"
        if curve.low is not None:
            ax.fill_between(curve.speed, curve.low, curve.high, color=colour, alpha=0.15, lw=0)
        ax.plot(curve.speed, curve.predicted, color=colour, lw=1.8)
        ax.plot(curve.speed, curve.published, "o", color="#c8553d", ms=4.5, mfc="white", mew=1.3)
        error = float(np.mean(np.abs(curve.predicted - curve.published)))
        what = "calibrated on" if own else f"blind, error {error:.3f}"
        mean = ", published mean" if curve.kind == "mean" else ""
        ax.set_title(f"{curve.label}: {what}{mean}", fontsize=9)
        ax.grid(alpha=0.25)
        ax.set_ylim(bottom=0.0)
        if index % 3 == 0:
            ax.set_ylabel("COF")
        if index >= len(curves) - 3:
            ax.set_xlabel("sliding speed (m/s)")
    for ax in axes[len(curves) :]:
        ax.set_visible(False)
    figure.suptitle("Films at asperities: line and 95 % interval; points: published fits of Eq. 17")
    return figure


def error_figure(names: Sequence[str], errors: Sequence[tuple[float, float]]) -> Figure:
    """Return blind errors of all mechanisms: with COF_BL as input, and from viscosity alone."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.2, 0.9 + 0.45 * len(names)), layout="constrained")
    ax = figure.subplots()
    place = np.arange(len(names))[::-1]
    with_own, alone = np.transpose(errors)
    ax.barh(place + 0.19, with_own, 0.36, color="#12355b", label="with COF_BL where measured")
    ax.barh(place - 0.19, alone, 0.36, color="#9dc3dc", label="viscosity only")
    ax.axvline(0.05, color="#c8553d", lw=1.2, ls="--")
    ax.annotate("0.05", (0.05, len(names) - 0.45), color="#c8553d", fontsize=8, ha="left")
    ax.set_yticks(place, names)
    ax.set_xlabel("mean absolute error of COF, five fluids predicted blind")
    ax.grid(axis="x", alpha=0.25)
    ax.set_axisbelow(True)
    ax.legend(frameon=False, fontsize=8)
    return figure


def _whole(curve: FluidCurve) -> np.ndarray:
    return np.sum([curve.parts[name] for name in PART_COLOURS], axis=0)


def _log_axis(ax: Axes, name: str) -> None:
    ax.set_xscale("log")
    ax.set_xlabel(name)
    ax.grid(alpha=0.25)
