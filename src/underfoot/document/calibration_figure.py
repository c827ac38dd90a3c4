"""Profiles of the misfit: which parameters the report's data fix."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RISE = 3.841458820694124


def calibration_figures(data: Mapping[str, Any]) -> dict[str, Figure]:
    """Return the figure by file name; ``data`` is that of the study's result."""
    return {"profiles": profile_figure(data["profiles"])}


def profile_figure(profiles: Any) -> Figure:
    """Return chi-square over its least against each parameter; below the line lies 95 %."""
    from matplotlib.figure import Figure

    columns = 2
    rows = math.ceil(len(profiles) / columns)
    figure = Figure(figsize=(9.6, 3.1 * rows + 0.4), layout="constrained")
    panels = np.atleast_2d(figure.subplots(rows, columns)).ravel()
    for axes, one in zip(panels, profiles, strict=False):
        axes.plot(one.grid, np.minimum(one.profile, 1e3), marker="o", color="#1f6fb2")
        axes.axhline(one.misfit + RISE, color="0.5", linestyle="--", linewidth=1)
        if one.low is not None:
            axes.axvline(one.low, color="#b3472f", linewidth=1)
        if one.high is not None:
            axes.axvline(one.high, color="#b3472f", linewidth=1)
        axes.set_yscale("symlog", linthresh=1.0)
        axes.set_ylim(bottom=0)
        axes.set_xlabel(one.name + ("" if one.unit == "1" else f" ({one.unit})"))
        axes.set_ylabel("least chi-square")
        axes.set_title(f"{one.fixed}: {one.text()}", fontsize=9)
        axes.spines[["top", "right"]].set_visible(False)
    for axes in panels[len(profiles) :]:
        axes.set_visible(False)
    figure.suptitle("What the report's data fix; dashed: 95 % below it")
    return figure
