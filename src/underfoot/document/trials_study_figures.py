"""Figures over all trials of a folder: fits, maps, risk curves, groups."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from underfoot.trials.analyse import FolderAnalysis

_NAMES = {
    "acof": "available friction, ACOF",
    "rcof": "required friction, RCOF",
    "acof_minus_rcof": "ACOF − RCOF",
    "cof": "COF",
    "peak_slipping_speed": "peak slipping speed (m/s)",
    "peak_force": "peak force (N)",
    "cof_bl": "COF_BL",
    "tau_hydro": "tau_hydro (m/s)",
    "cof_asymptote": "COF_asymptote",
}


def study_figures(analysis: FolderAnalysis) -> list[tuple[str, str, Figure]]:
    """Return (name, caption, figure) of what the folder says as a whole."""
    curves = analysis.study.curves
    made: list[tuple[str, str, Figure]] = []
    if curves.get("risk"):
        words = (
            "Slip outcomes (points, spread a little for the eye) and logistic curves, 95 % bands"
        )
        made.append(("risk", words, _risk(curves["risk"])))
    if curves.get("maps"):
        words = "Fluid pressure under the shoe; white lines are the scans, the cross is the peak"
        made.append(("maps", words, _maps(curves["maps"])))
    if curves.get("fits"):
        words = "COF against sliding speed with the fit of Eq. 17, and its residuals"
        made.append(("stribeck", words, _fits(curves["fits"])))
    if curves.get("master"):
        words = "All COF against viscosity × speed, and one falling curve through them"
        made.append(("master_curve", words, _master(curves["master"])))
    if curves.get("line"):
        words = "Peak slipping speed against the largest pressure of a trial"
        made.append(("speed_pressure", words, _line(curves["line"])))
    if curves.get("alpha_beta"):
        words = "Adhesion with a fluid against dry adhesion, lines of Eq. 26"
        made.append(("alpha_beta", words, _alpha_beta(curves["alpha_beta"])))
    made += _groups(analysis)
    return made


def _new(width: float, height: float) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _plain(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)


def _risk(risk: Sequence[dict[str, Any]]) -> Figure:
    figure = _new(3.4 * len(risk), 3.1)
    grid: Any = figure.subplots(1, len(risk), squeeze=False, sharey=True)
    for axes, one in zip(grid[0], risk, strict=True):
        axes.fill_between(one["grid"], one["low"], one["high"], color="tab:blue", alpha=0.18, lw=0)
        axes.plot(one["grid"], one["risk"], color="tab:blue")
        y = np.array(one["y"], dtype=float)
        # A fixed pattern instead of random numbers: the same folder gives the same picture.
        shift = 0.035 * ((np.arange(len(y)) * 0.618034) % 1.0)
        axes.plot(
            one["x"], np.where(y > 0.5, y + shift, y - shift), "o", ms=3.5, color="0.2", alpha=0.6
        )
        axes.set_xlabel(_NAMES.get(one["name"], one["name"]))
        slope = f"slope {one['slope']:.1f}"
        inside = one["grid"][0] < one["half"] < one["grid"][-1]
        axes.set_title(slope + (f", 50 % at {one['half']:.3f}" if inside else ""), fontsize=9)
        axes.set_ylim(-0.06, 1.06)
        _plain(axes)
    grid[0][0].set_ylabel("slip (1) or not (0), risk")
    return figure


def _maps(maps: Sequence[dict[str, Any]]) -> Figure:
    figure = _new(3.3 * len(maps) + 0.6, 4.6)
    grid: Any = figure.subplots(1, len(maps), squeeze=False, sharey=True)
    top = max(1e-3 * float(np.max(one["pressure"])) for one in maps)
    image = None
    for axes, one in zip(grid[0], maps, strict=True):
        lateral, along = 1e3 * np.array(one["lateral"]), 1e3 * np.array(one["along"])
        pressure = 1e-3 * np.array(one["pressure"])
        # Each scan stands for the strip around it: no smoothing between scans.
        image = axes.pcolormesh(
            -lateral,
            along,
            pressure.T,
            cmap="viridis",
            vmin=0,
            vmax=top,
            shading="nearest",
            rasterized=True,
        )
        for x in -lateral:
            axes.axvline(x, color="white", linewidth=0.4, alpha=0.6)
        axes.plot(-1e3 * one["peak_lateral"], 1e3 * one["peak_along"], "+", color="red", ms=9)
        words = f"{one['load']:.3g} N, peak {1e-3 * one['peak']:.3g} kPa"
        axes.set_title(f"{one['label']}\n{words}", fontsize=9)
        axes.set_aspect("equal")
        axes.set_xlabel("right of the heel's middle (mm)")
    grid[0][0].set_ylabel("forward of the heel's back (mm)")
    if image is not None:
        figure.colorbar(image, ax=grid[0].tolist(), label="fluid pressure (kPa)", shrink=0.8)
    return figure


def _fits(fits: Sequence[dict[str, Any]]) -> Figure:
    groups = list(dict.fromkeys(one["group"] for one in fits))
    across = min(3, len(groups))
    down = -(-len(groups) // across)
    figure = _new(3.3 * across, 3.3 * down)
    outer: Any = figure.subfigures(down, across, squeeze=False)
    highest = max(max(one["cof"]) for one in fits)
    for i, group in enumerate(groups):
        inner: Any = outer[i // across][i % across].subplots(
            2, 1, sharex=True, height_ratios=(2.6, 1)
        )
        for number, one in enumerate(f for f in fits if f["group"] == group):
            colour = f"C{number % 10}"
            speed, cof = np.array(one["speed"]), np.array(one["cof"])
            grid = np.linspace(0, 1.02 * speed.max(), 120)
            inner[0].plot(grid, _curve(one, grid), color=colour, linewidth=0.9)
            inner[0].plot(speed, cof, "o", ms=2.6, color=colour)
            inner[1].plot(speed, cof - _curve(one, speed), "o", ms=2.2, color=colour)
        verdicts = [f["verdict"] for f in fits if f["group"] == group]
        words = ", ".join(f"{verdicts.count(v)} {v}" for v in dict.fromkeys(verdicts))
        inner[0].set_title(f"{group or 'all files'} ({words})", fontsize=9)
        inner[0].set_ylim(0, 1.1 * highest)
        inner[1].axhline(0, color="0.7", linewidth=0.8)
        inner[1].set_xlabel("sliding speed (m/s)", fontsize=8)
        if i % across == 0:
            inner[0].set_ylabel("COF", fontsize=8)
            inner[1].set_ylabel("residual", fontsize=8)
        for axes in inner:
            axes.tick_params(labelsize=7)
            _plain(axes)
    return figure


def _curve(one: dict[str, Any], speed: np.ndarray) -> np.ndarray:
    if one["verdict"] == "mean":
        return np.full(len(speed), one["mean"])
    boundary, tau, asymptote = one["raw"]
    return asymptote + (boundary - asymptote) * np.exp(-speed / tau)


def _master(master: dict[str, Any]) -> Figure:
    figure = _new(6.2, 3.6)
    axes = figure.add_subplot()
    product, cof = np.array(master["product"]), np.array(master["cof"])
    labels = np.array(master["label"])
    for number, label in enumerate(dict.fromkeys(master["label"])):
        mine = labels == label
        axes.semilogx(product[mine], cof[mine], "o", ms=3, color=f"C{number % 10}", label=label)
    axes.semilogx(master["grid"], master["fitted"], color="black", linewidth=1.2, label="one curve")
    axes.set_xlabel("viscosity × speed (N/m)")
    axes.set_ylabel("COF")
    axes.set_ylim(bottom=0)
    words = f"R² {master['r_squared']:.3f}, residual sd {master['residual_sd']:.3f}"
    axes.set_title(words, fontsize=9)
    axes.legend(frameon=False, fontsize=7)
    _plain(axes)
    return figure


def _line(line: dict[str, Any]) -> Figure:
    figure = _new(4.4, 3.2)
    axes = figure.add_subplot()
    x = np.array(line["x"])
    axes.plot(x, line["y"], "o", ms=4, color="0.2")
    ends = np.array([0.0, 1.05 * x.max()])
    axes.plot(ends, line["intercept"] + line["slope"] * ends, color="tab:blue")
    axes.set_xlabel("peak pressure (kPa)")
    axes.set_ylabel("peak slipping speed (m/s)")
    axes.set_ylim(bottom=0)
    axes.set_title(f"r = {line['r']:.2f}", fontsize=9)
    _plain(axes)
    return figure


def _alpha_beta(found: dict[str, Any]) -> Figure:
    figure = _new(5.4, 3.4)
    axes = figure.add_subplot()
    fluids, dry, wet = np.array(found["fluid"]), np.array(found["dry"]), np.array(found["wet"])
    ends = np.array([dry.min(), dry.max()])
    for number, (fluid, alpha, beta) in enumerate(found["lines"]):
        colour = f"C{number % 10}"
        axes.plot(dry[fluids == fluid], wet[fluids == fluid], "o", ms=4, color=colour, label=fluid)
        axes.plot(ends, alpha + beta * ends, color=colour)
    axes.set_xlabel("dry adhesion (N)")
    axes.set_ylabel("adhesion with the fluid (N)")
    axes.legend(frameon=False, fontsize=8)
    _plain(axes)
    return figure


def _groups(analysis: FolderAnalysis) -> list[tuple[str, str, Figure]]:
    """Bars of group means with their points and Tukey's letters, where a factor was tested."""
    made = []
    for finding in analysis.study.findings:
        if not finding.marks:
            continue
        response, factor, letters = finding.response, finding.factor, finding.marks
        values = _values(analysis, response, factor)
        if len(values) < 2:
            continue
        figure = _new(max(3.2, 1.05 * len(values) + 1.3), 3.1)
        axes = figure.add_subplot()
        names = list(values)
        for i, name in enumerate(names):
            points = np.array(values[name])
            axes.bar(i, points.mean(), width=0.62, color="tab:blue", alpha=0.35)
            spread = points.std(ddof=1) if len(points) > 1 else 0.0
            axes.errorbar(i, points.mean(), spread, color="0.2", capsize=3, linewidth=1)
            shift = 0.3 * ((np.arange(len(points)) * 0.618034) % 1.0) - 0.15
            axes.plot(i + shift, points, "o", ms=2.6, color="0.2", alpha=0.5)
            height = max(points.max(), points.mean() + spread)
            axes.annotate(
                letters.get(name, ""),
                (i, height),
                textcoords="offset points",
                xytext=(0, 5),
                ha="center",
                weight="bold",
            )
        axes.set_xticks(range(len(names)), [name.replace(", ", "\n") for name in names])
        longest = max(len(part) for name in names for part in name.split(", "))
        axes.tick_params(axis="x", labelsize=9 if longest < 14 else 7)
        axes.set_ylabel(_NAMES.get(response, response.replace("_", " ")))
        axes.margins(y=0.14)
        axes.set_ylim(bottom=0)
        _plain(axes)
        words = (
            f"{_NAMES.get(response, response)} by {factor}: means, standard deviations, points; "
            "groups that share a letter do not differ (Tukey, 0.05)"
        )
        made.append((f"groups_{response}_{factor}", words, figure))
    return made


def _values(analysis: FolderAnalysis, response: str, factor: str) -> dict[str, list[float]]:
    found: dict[str, list[float]] = {}
    parameters = analysis.study.curves.get("parameters", {})
    if response in parameters:
        for group, value in parameters[response]:
            found.setdefault(group, []).append(value)
        return found
    for one in analysis.files:
        if one.usable and response in one.main and factor in one.conditions:
            found.setdefault(str(one.conditions[factor]), []).append(one.main[response])
    return found
