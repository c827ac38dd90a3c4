"""Figures of study g6: friction and risk of the outsoles, slips with their logistic curves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SOLE_COLOURS = {"hard": "#e08a2e", "medium": "#e8c93c", "soft": "#f4f1ea"}
"""Those of the report's Fig. 36."""
LAW_LABELS = {
    "stribeck": "pin's friction as it is",
    "asperity_ehl": "films at asperities",
    "bowden_tabor": "real contact area",
}
OURS, PRINTED = "#1f6fb2", "#b3472f"


def g6_figures(data: Mapping[str, Any]) -> dict[str, Figure]:
    """Return the figures by file name; ``data`` is that of the study's result."""
    return {"fig36_outsoles": outsole_figure(data), "fig37_logistic": logistic_figure(data)}


def outsole_figure(data: Mapping[str, Any]) -> Figure:
    """Return slip risk (left) and friction (right) of the outsoles, printed and by each law."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    printed, soles = data["printed_risk"], list(data["printed_acof"])
    groups = [("report", [printed[s] for s in soles])]
    groups += [
        (label.replace("ACOF as printed, ", "computed steps,\n"), [one.share[s] for s in soles])
        for label, one in data["steps"].items()
    ]
    for place, (_, values) in enumerate(groups):
        for k, (sole, value) in enumerate(zip(soles, values, strict=True)):
            left.bar(
                place + 0.27 * (k - 1), 100 * value, 0.25, color=SOLE_COLOURS[sole],
                edgecolor="0.3", linewidth=0.8, label=sole if place == 0 else None,
            )  # fmt: skip
    left.set_xticks(range(len(groups)), [label for label, _ in groups], fontsize=8)
    left.set_ylabel("steps that slip (%)")
    left.legend(frameon=False, title="outsole")
    laws = list(dict.fromkeys(one.law for one in data["frictions"]))
    right.axhspan(0.159, 0.182, color=PRINTED, alpha=0.18, label="report, hard to soft")
    for place, law in enumerate(laws):
        chosen = {one.sole: one for one in data["frictions"] if one.law == law}
        for k, sole in enumerate(soles):
            one = chosen[sole]
            right.bar(
                place + 0.27 * (k - 1), one.cof, 0.25, color=SOLE_COLOURS[sole], edgecolor="0.3",
                linewidth=0.8,
            )  # fmt: skip
            right.errorbar(
                place + 0.27 * (k - 1), one.cof,
                yerr=[[max(one.cof - one.low, 0)], [max(one.high - one.cof, 0)]],
                color="0.15", capsize=2, linewidth=1,
            )  # fmt: skip
    right.set_xticks(range(len(laws)), [LAW_LABELS.get(law, law) for law in laws], fontsize=8)
    right.set_ylabel("available friction (ACOF)")
    right.legend(frameon=False, fontsize=8, loc="upper left")
    figure.suptitle("Fig. 36: slip risk and friction by outsole; bars on the right: hardness ± 5")
    for axes in (left, right):
        _plain(axes)
    return figure


def logistic_figure(data: Mapping[str, Any]) -> Figure:
    """Return simulated slips over ACOF - RCOF with fitted and printed logistic curves."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 4.0), layout="constrained")
    panels = figure.subplots(1, len(data["steps"]), sharey=True)
    slopes, halves = data["drawn"]
    for axes, (label, found) in zip(np.atleast_1d(panels), data["steps"].items(), strict=True):
        difference = found.acof - found.rcof
        noise = np.random.default_rng(0).uniform(-0.02, 0.02, difference.size)
        axes.scatter(difference, found.slipped + noise, s=8, color="0.45", alpha=0.5)
        x = np.linspace(min(difference.min(), -0.13), max(difference.max(), 0.06), 201)
        curves = _curve(x[:, None], slopes[None, :], halves[None, :])
        low, high = np.percentile(curves, [2.5, 97.5], axis=1)
        axes.fill_between(
            x,
            low,
            high,
            color=PRINTED,
            alpha=0.15,
            linewidth=0,
            label="52 trials of that curve, 95 %",
        )
        axes.plot(x, _curve(x, -49.2, -0.06), color=PRINTED, label="report: slope -49.2")
        fit = found.fit
        axes.plot(
            x, _curve(x, fit.slope, fit.half), color=OURS, label=f"steps: slope {fit.slope:.0f}"
        )
        axes.set_title(label, fontsize=10)
        axes.set_xlabel("ACOF - RCOF")
        axes.legend(frameon=False, fontsize=8)
        _plain(axes)
    np.atleast_1d(panels)[0].set_ylabel("chance of a slip")
    figure.suptitle("Fig. 37 C: computed slips and logistic curves")
    return figure


def _curve(x: Any, slope: Any, half: Any) -> np.ndarray:
    return 0.5 * (1 + np.tanh(0.5 * slope * (x - half)))


def _plain(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
