"""Figures of study g5: a slip, speed and pressure, what the pressure follows, wedge and squeeze."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from .slip_figure import slip_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UNTREADED, TREADED, PRINTED = "#1f6fb2", "#2e7d4f", "#b3472f"
COLOURS = {"untreaded": UNTREADED, "treaded": TREADED}
PRINTED_POINTS = {"untreaded": ((1.57, 0.80), (124, 75)), "treaded": ((0.063, 0.017), (1.1, 0.29))}


def g5_figures(data: Mapping[str, Any]) -> dict[str, Figure]:
    """Return the figures by file name; ``data`` is that of the study's result."""
    found = {"fig33_speed_pressure": speed_pressure_figure(data["slips"])}
    bare = data["slips"]["untreaded"]
    found["fig32_slip"] = slip_figure(bare)
    if data["passages"]["peak"].size:
        found["fig34_effects"] = effects_figure(data["passages"], bare.rows())
    if bare.sole is not None and bare.sole.viscosity:
        found["fig35_wedge_squeeze"] = wedge_squeeze_figure(bare.sole, data["passages"])
    return dict(sorted(found.items()))


def speed_pressure_figure(slips: Mapping[str, Any]) -> Figure:
    """Return peak slipping speed against peak sensor pressure of every person who crossed."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    axes = figure.add_subplot()
    for shoe, study in slips.items():
        crossed = np.array([one.seen.crossed for one in study.subjects])
        r = study.correlation()
        axes.scatter(
            study.of("peak_pressure")[crossed] / 1e3, study.of("peak_speed")[crossed], s=26,
            color=COLOURS[shoe], alpha=0.8,
            label=f"{shoe}, computed" + ("" if r is None else f" (r = {r:.2f})"),
        )  # fmt: skip
        (speed, speed_sd), (pressure, pressure_sd) = PRINTED_POINTS[shoe]
        axes.errorbar(
            pressure, speed, xerr=pressure_sd, yerr=speed_sd, color=PRINTED, capsize=3,
            marker="D" if shoe == "untreaded" else "s", markersize=6, linewidth=1.2,
            label=f"{shoe}, report (mean ± sd)",
        )  # fmt: skip
    axes.set(xlabel="peak pressure at the sensors (kPa)", ylabel="peak slipping speed (m/s)")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, fontsize=8)
    axes.set_title("Fig. 33: peak speed against peak pressure (report: r = 0.87)")
    _plain(axes)
    return figure


def effects_figure(passages: Mapping[str, np.ndarray], rows: np.ndarray) -> Figure:
    """Return pressure of single sensors against speed, lateral distance and row."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 3.8), layout="constrained")
    first, second, third = figure.subplots(1, 3, sharey=True)
    peak = passages["peak"] / 1e3
    for axes, name, factor, label in (
        (first, "speed", 1.0, "A: speed as the heel passes (m/s)"),
        (second, "lateral", 1e3, "B: distance from the heel's middle (mm)"),
    ):
        x = passages[name] * factor
        axes.scatter(x, peak, s=14, color=UNTREADED, alpha=0.6)
        if np.ptp(x) > 0:
            slope, level = np.polyfit(x, peak, 1)
            ends = np.array([x.min(), x.max()])
            axes.plot(ends, level + slope * ends, color="0.25", linewidth=1)
        axes.set_xlabel(label)
    numbers = np.unique(passages["row"])
    values = [peak[passages["row"] == n] for n in numbers]
    third.errorbar(
        numbers, [v.mean() for v in values], yerr=[v.std() for v in values], color=UNTREADED,
        marker="o", capsize=3,
    )  # fmt: skip
    third.set_xticks(numbers)
    third.set_xlabel("C: row of sensors (mean ± sd)")
    first.set_ylabel("peak pressure of a sensor (kPa)")
    first.set_ylim(bottom=0)
    figure.suptitle("Fig. 34: what the pressure at a sensor follows, untreaded, computed")
    for axes in (first, second, third):
        _plain(axes)
    return figure


def wedge_squeeze_figure(sole: Any, passages: Mapping[str, np.ndarray]) -> Figure:
    """Return film load against dwell time, viscosity, lateral distance and speed (500 N)."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 6.4), layout="constrained")
    panels = figure.subplots(2, 2)
    time = np.linspace(0.0, 0.3, 601)
    shown = ((219e-3, "-"), (20e-3, "--"), (1.89e-3, ":"))
    longer = np.linspace(0.0, 3.0, 6001)
    for viscosity, style in shown:
        load = held_load(replace(sole, viscosity=viscosity), longer, 0.5)
        panels[0, 0].plot(
            1e3 * longer[1:],
            load[1:] / 5,
            style,
            color=UNTREADED,
            label=f"{1e3 * viscosity:g} mPa s",
        )
    panels[0, 0].set(xlabel="dwell time at 0.5 m/s (ms)", ylabel="load on the film (%)")
    panels[0, 0].set_xscale("log")
    panels[0, 0].set_xlim(1, 3000)
    panels[0, 0].legend(frameon=False, fontsize=8, loc="lower left")
    viscosities = np.geomspace(1e-3, 0.5, 25)
    for instant, style in ((0.05, "--"), (0.2, "-")):
        loads = [
            held_load(replace(sole, viscosity=float(v)), time, 0.5)[np.searchsorted(time, instant)]
            for v in viscosities
        ]
        panels[0, 1].plot(
            1e3 * viscosities, np.array(loads) / 5, style, color=UNTREADED,
            label=f"0.5 m/s, after {1e3 * instant:.0f} ms",
        )  # fmt: skip
    for name, value in (
        ("water", 1.0),
        ("detergent", 1.89),
        ("canola", 74.6),
        ("90 % glycerol", 219),
    ):
        panels[0, 1].axvline(value, color="0.7", linewidth=0.8)
        panels[0, 1].text(value, 1, name, rotation=90, fontsize=7, va="bottom", ha="right")
    panels[0, 1].set(xlabel="viscosity (mPa s)", ylabel="load on the film (%)", xscale="log")
    panels[0, 1].legend(frameon=False, fontsize=8, loc="upper left")
    if passages["peak"].size:
        edges = np.arange(0.0, 0.05, 0.005)
        middle, level = [], []
        for low, high in pairwise(edges):
            inside = (passages["lateral"] >= low) & (passages["lateral"] < high)
            if inside.any():
                middle.append(500 * (low + high))
                level.append(passages["peak"][inside].mean() / 1e3)
        panels[1, 0].plot(middle, level, marker="o", color=UNTREADED)
    panels[1, 0].set(xlabel="distance from the heel's middle (mm)", ylabel="sensor's peak (kPa)")
    panels[1, 0].set_ylim(bottom=0)
    speeds = np.linspace(0.0, 3.0, 31)
    for viscosity, style in shown:
        thin = replace(sole, viscosity=viscosity)
        loads = [held_load(thin, time, float(v))[np.searchsorted(time, 0.2)] for v in speeds]
        panels[1, 1].plot(
            speeds, np.array(loads) / 5, style, color=UNTREADED, label=f"{1e3 * viscosity:g} mPa s"
        )
    panels[1, 1].set(xlabel="sliding speed, held for 200 ms (m/s)", ylabel="load on the film (%)")
    panels[1, 1].legend(frameon=False, fontsize=8)
    figure.suptitle("Fig. 35: wedge and squeeze, untreaded heel under 500 N, computed")
    for axes in panels.flat:
        _plain(axes)
    for axes in (panels[0, 0], panels[0, 1], panels[1, 1]):
        axes.set_ylim(0, 100)
    return figure


def held_load(sole: Any, time: np.ndarray, speed: float, force: float = 500.0) -> np.ndarray:
    """Return the film's load (n,) N under a force and speed that are held from contact on."""
    from types import SimpleNamespace

    motion = SimpleNamespace(
        time=time,
        normal=np.full(time.size, force),
        drive=np.zeros(time.size),
        shoe_angle=np.full(time.size, sole.shoe_angle),
        speed=np.full(time.size, speed),
        walker=SimpleNamespace(moving_mass=8.0),
    )
    load, _ = sole.carried_at(motion)
    return np.asarray(load)


def _plain(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
