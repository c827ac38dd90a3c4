"""Figures 29 and 30 of grant report G.4 from our readings, tread depth and open inputs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FLUID_COLOURS = {"glycerol": "#12355b", "detergent": "#9db8d2"}
PRINTED, TRUE_LOAD = "#c8553d", "#7fb3d5"
SMALL = 5.0
QUANTITIES = (
    ("fluid_load_sensor", "load by the sensor"),
    ("peak_fluid_pressure_sensor", "peak by the sensor"),
)


def save_g4_figures(data: Any, folder: Path) -> list[Path]:
    """Write every figure as PNG into an existing folder; return the paths.

    ``data`` holds ``results``, ``varied`` and ``depths`` of the study.
    """
    paths = []
    for name, figure in g4_figures(data).items():
        paths.append(folder / f"{name}.png")
        figure.savefig(paths[-1], dpi=150)
    return paths


def g4_figures(data: Any) -> dict[str, Figure]:
    """Return the figures by file name."""
    from .sensitivity_figure import sensitivity_figure

    results = data["results"]
    with_peak = [one for one in results if one.condition.printed_peak is not None]
    made = {"fig29": map_figure(with_peak), "fig30": load_figure(results)}
    if data["depths"]:
        made["tread_depth"] = depth_figure(data["depths"])
    for one in with_peak:
        if one.condition.name in data["varied"]:
            name = f"open_inputs_{one.condition.kind}"
            made[name] = sensitivity_figure(data["varied"][one.condition.name], QUANTITIES)
    return made


def map_figure(results: Sequence[Any]) -> Figure:
    """Return Fig. 29: fluid pressure as seven tracks read it, heel's back at the bottom."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.3 * len(results) + 0.6, 5.6), layout="constrained")
    panels = figure.subplots(1, len(results), squeeze=False, sharey=True)[0]
    highest = max(one.reading.pressure.max() for one in results) / 1e3
    image = None
    for axes, one in zip(panels, results, strict=True):
        found = one.reading
        x, y = 1e3 * found.x, 1e3 * found.y
        image = axes.pcolormesh(
            y, x, found.pressure / 1e3, vmin=0.0, vmax=highest, cmap="viridis", shading="nearest",
            rasterized=True,
        )  # fmt: skip
        axes.plot(
            1e3 * found.outline[:, 1], 1e3 * found.outline[:, 0], color="white", linewidth=1.2
        )
        place = found.place
        axes.plot(
            1e3 * place[1], 1e3 * place[0], marker="o", markersize=9, markerfacecolor="none",
            markeredgecolor="white", markeredgewidth=1.5,
        )  # fmt: skip
        axes.set_xlim(float(y.max() + 5), float(y.min() - 5))  # left of the shoe on the left
        axes.set_ylim(-8.0, min(float(x.max()), 60.0))
        axes.set_aspect("equal")
        axes.set_xlabel("across, left positive (mm)")
        load, printed = one.load.value, one.condition.printed_load
        peak, printed_peak = one.peak.value / 1e3, one.condition.printed_peak / 1e3
        axes.set_title(
            f"{one.condition.kind} shoe, {one.condition.tread}\n"
            f"{load:.0f} N, peak {peak:.0f} kPa (report {printed:.0f} N, {printed_peak:.0f} kPa)",
            fontsize=9.5,
        )
    panels[0].set_ylabel("from the back of the heel (mm)")
    if image is not None:
        bar = figure.colorbar(image, ax=list(panels), fraction=0.05, pad=0.02)
        bar.set_label("fluid pressure read by a 10 mm inlet (kPa)")
    figure.suptitle("Fig. 29: seven tracks 10 mm apart; ring: highest reading", fontsize=11)
    return figure


def load_figure(results: Sequence[Any]) -> Figure:
    """Return Fig. 30: load by the sensor with its 95 % band, report's values and 5 N beside it."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 4.6), layout="constrained")
    kinds = list(dict.fromkeys(one.condition.kind for one in results))
    panels = figure.subplots(1, len(kinds), squeeze=False, sharey=True)[0]
    for axes, kind in zip(panels, kinds, strict=True):
        some = [one for one in results if one.condition.kind == kind]
        _bars(axes, some)
        axes.set_title(f"{kind} shoe", fontsize=10)
    panels[0].set_ylabel("load carried by the fluid, by the sensor (N)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)
    figure.suptitle(
        "Fig. 30: tread, fluid and the load that the sensor reads, of 500 N", fontsize=11
    )
    return figure


def _bars(axes: Axes, some: Sequence[Any]) -> None:
    treads = list(dict.fromkeys(one.condition.tread for one in some))
    axes.set_yscale("symlog", linthresh=1.0, linscale=0.6)
    for one in some:
        condition = one.condition
        side = -0.2 if condition.fluid == "glycerol" else 0.2
        place = treads.index(condition.tread) + side
        first = condition.tread == treads[0]
        axes.bar(
            place, one.load.value, width=0.36, color=FLUID_COLOURS[condition.fluid],
            label=condition.fluid if first else None,
        )  # fmt: skip
        if one.load.has_band:
            axes.plot([place, place], [one.load.low, one.load.high], color="0.25", linewidth=1.3)
        if condition.printed_load is not None:
            axes.plot(
                place, condition.printed_load, marker="D", color=PRINTED, linestyle="none",
                label="report",
            )  # fmt: skip
    axes.axhline(
        SMALL, color=PRINTED, linestyle="--", linewidth=1.0, label="report: all others below"
    )
    axes.set_xticks(range(len(treads)), [tread.replace("_", " ") for tread in treads])
    axes.set_ylim(0.0, 700.0)
    axes.set_yticks([0, 1, 5, 10, 50, 100, 500], ["0", "1", "5", "10", "50", "100", "500"])
    axes.minorticks_off()
    axes.spines[["top", "right"]].set_visible(False)


def depth_figure(depths: Sequence[Any]) -> Figure:
    """Return load against depth of tread: by the sensor and under the sole."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.6, 4.2), layout="constrained")
    axes = figure.add_subplot()
    depth = np.array([1e3 * row.depth for row in depths])
    axes.plot(
        depth, [row.fluid_load for row in depths], marker="s", color=TRUE_LOAD,
        label="under the sole",
    )  # fmt: skip
    axes.plot(
        depth, [row.sensor_load for row in depths], marker="o", color=FLUID_COLOURS["glycerol"],
        label="by the 10 mm sensor",
    )  # fmt: skip
    axes.axhline(SMALL, color=PRINTED, linestyle="--", linewidth=1.0)
    axes.annotate(
        "5 N", (depth.max(), SMALL), xytext=(0, 3), textcoords="offset points", ha="right",
        color=PRINTED, fontsize=9,
    )  # fmt: skip
    axes.axvspan(1.5, 3.0, color="0.94", zorder=0)
    axes.annotate(
        "report: no change", (2.25, 1.0), xycoords=("data", "axes fraction"), xytext=(0, -14),
        textcoords="offset points", ha="center", color="0.35", fontsize=9,
    )  # fmt: skip
    axes.set_xlabel("depth of tread (mm)")
    axes.set_ylabel("load carried by the fluid (N)")
    axes.set_ylim(bottom=-6.0)
    axes.set_xlim(left=-0.05)
    axes.set_title("Half-treaded work shoe in glycerol, 500 N, 0.7 m/s", fontsize=10)
    axes.legend(frameon=False, loc="center right")
    axes.spines[["top", "right"]].set_visible(False)
    return figure
