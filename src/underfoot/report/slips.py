"""Pictures of slips: heel over the sensors, pressures, speeds, forces; and the animated page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core.html import data_address, environment, new_figure
from underfoot.core.page import PageSection, Picture, remark_sections, table_sections
from underfoot.core.remark import Message
from underfoot.questions.slips import SlipPopulation, shown_motion
from underfoot.slip.dynamics import array_pressures
from underfoot.slip.dynamics.sensors import MAP_X, MAP_Y

from .dispatch import FigureMakers, figures, sections

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from underfoot.slip.dynamics import SlipMotion, SlipStudy

FRAMES = 110
FLUID, LOAD, DRIVE, FRICTION = "#1f6fb2", "0.35", "#b3472f", "#2e7d4f"


@figures.register(SlipPopulation)
def _figures(shown: SlipPopulation) -> FigureMakers:
    return {"slip": partial(slip_figure, shown.study)}


@sections.register(SlipPopulation)
def _sections(
    shown: SlipPopulation, pictures: dict[str, bytes]
) -> tuple[Sequence[PageSection], str]:
    data = json.dumps(animation_data(shown.study), separators=(",", ":")).replace("<", "\\u003c")
    walker = shown_motion(shown.study).walker
    player = (
        environment(__package__ or "")
        .get_template("slip.html")
        .render(data=data, wet=shown.wet, walker=walker)
    )
    drawn = [
        Picture("Heel path, pressures, speed and forces of one slip", data_address(p), True)
        for p in pictures.values()
    ]
    parts = [
        PageSection(Message("The slip of {name}, ten times slower", name=walker.name), html=player),
        *table_sections(shown),
        PageSection("Speed, forces and pressures over time", pictures=drawn),
        *remark_sections(shown),
    ]
    return parts, ""


def slip_figure(study: SlipStudy) -> Figure:
    """Return the median walker's slip as the report draws one (Fig. 32), with speeds and forces.

    Top: heel path over the array (forward is up) and each sensor's pressure at its place in the
    array; bottom: heel speed over the population's band, forces. Without fluid only the bottom.
    """
    motion = shown_motion(study)
    wet = study.setting.viscosity is not None and study.representative is not None
    figure = new_figure(10.5, 8.6 if wet else 4.0)
    below: Figure | SubFigure = figure
    if wet:
        halves: Any = figure.subfigures(2, 1, height_ratios=[1.35, 1.0])
        below = halves[1]
        left, right = halves[0].subfigures(1, 2, width_ratios=[1.0, 2.2])
        _draw_path(left.subplots(), study, motion)
        _draw_pressures(right, study, motion)
    speeds, forces = below.subplots(1, 2)
    _draw_speeds(speeds, study, motion)
    _draw_forces(forces, motion, wet)
    return figure


def _draw_path(axes: Axes, study: SlipStudy, motion: SlipMotion) -> None:
    walker, array = motion.walker, study.array
    x, y = array.places(walker)
    columns, rows = np.meshgrid(y + walker.lateral, x - walker.landing)
    axes.plot(
        1e3 * columns.ravel(), 1e3 * rows.ravel(), "x", color="0.2", ms=9, mew=1.8, label="sensor"
    )
    way = 1e3 * (motion.distance - walker.landing)
    side = np.full(way.size, 1e3 * walker.lateral)
    end = float(1e3 * (x[-1] - walker.landing) + 25)
    axes.plot(side, way, color=FLUID, lw=3, label="heel's rear end", solid_capstyle="butt")
    axes.plot(side[0], way[0], "o", color=FLUID, ms=9, mfc="white", mew=2, label="heel contact")
    if way[-1] > end:
        axes.annotate("", (side[0], end), (side[0], end - 12),
                      arrowprops={"arrowstyle": "-|>", "color": FLUID, "lw": 2})  # fmt: skip
    axes.set(
        xlim=(1e3 * columns.max() + 22, 1e3 * columns.min() - 22) if y.size > 1 else (40, -40),
        ylim=(-35, end),
        xlabel="across (mm, left of the walk positive)",
        ylabel="along the walk (mm)",
        aspect="equal",
    )
    axes.set_title("Heel path over the sensors", fontsize=10)
    axes.legend(frameon=False, fontsize=8, loc="lower center", ncols=2, bbox_to_anchor=(0.5, -0.36))


def _draw_pressures(figure: SubFigure, study: SlipStudy, motion: SlipMotion) -> None:
    run, array = study.representative, study.array
    assert run is not None
    pressures = array_pressures(motion, run.maps, array) / 1e3
    grid = figure.subplots(array.rows, array.columns, sharex=True, sharey=True, squeeze=False)
    busy = np.flatnonzero(pressures.max(axis=(1, 2)) > 1.0)
    over = float(motion.time[busy[-1]]) if busy.size else 0.1
    last = min(1e3 * float(motion.time[-1]), 1e3 * over + 40)
    for i in range(array.rows):
        for j in range(array.columns):
            axes = grid[array.rows - 1 - i][j]
            axes.fill_between(1e3 * motion.time, pressures[:, i, j], color=FLUID, alpha=0.35, lw=0)
            axes.plot(1e3 * motion.time, pressures[:, i, j], color=FLUID, lw=1.3)
            axes.text(0.95, 0.85, f"{pressures[:, i, j].max():.0f} kPa", ha="right", fontsize=8,
                      transform=axes.transAxes)  # fmt: skip
            axes.set_xlim(0, last)
            axes.set_ylim(0, max(1.15 * pressures.max(), 5.0))
            axes.spines[["top", "right"]].set_visible(False)
            axes.tick_params(labelsize=8)
    figure.supxlabel("time after heel contact (ms)", fontsize=9)
    figure.supylabel("fluid pressure (kPa)", fontsize=9)
    figure.suptitle("Pressure at each sensor, at its place in the array", fontsize=10)


def _draw_speeds(axes: Axes, study: SlipStudy, motion: SlipMotion) -> None:
    if len(study.subjects) > 4:
        last = max(s.motion.time[-1] for s in study.subjects)
        time = np.linspace(0, last, 200)
        speeds = np.array(
            [np.interp(time, s.motion.time, s.motion.speed, right=s.motion.speed[-1])
             for s in study.subjects]
        )  # fmt: skip
        low, middle, high = np.percentile(speeds, [5, 50, 95], axis=0)
        axes.fill_between(1e3 * time, low, high, color="0.88", label="90 % of the walkers")
        axes.plot(1e3 * time, middle, color="0.55", lw=1, label="median")
    axes.plot(1e3 * motion.time, motion.speed, color=FLUID, lw=2, label=motion.walker.name)
    axes.axhline(0.2, color=DRIVE, lw=1, ls=":", label="slip above 0.2 m/s")
    axes.set(xlabel="time after heel contact (ms)", ylabel="heel speed (m/s)", xlim=(0, None),
             ylim=(0, None))  # fmt: skip
    axes.legend(frameon=False, fontsize=8, loc="upper left")
    axes.spines[["top", "right"]].set_visible(False)


def _draw_forces(axes: Axes, motion: SlipMotion, wet: bool) -> None:
    time = 1e3 * motion.time
    axes.plot(time, motion.normal, color=LOAD, lw=1.5, label="load on the foot")
    if wet:
        axes.plot(time, motion.fluid_load, color=FLUID, lw=1.5, label="carried by the film")
    axes.plot(time, motion.drive, color=DRIVE, lw=1.5, label="drive, r F")
    axes.plot(time, motion.friction, color=FRICTION, lw=1.5, label="friction")
    axes.axhline(0, color="0.6", lw=0.6)
    axes.set(xlabel="time after heel contact (ms)", ylabel="force (N)", xlim=(0, None))
    axes.legend(frameon=False, fontsize=8)
    axes.spines[["top", "right"]].set_visible(False)


def animation_data(study: SlipStudy) -> dict[str, Any]:
    """Return what the moving picture draws, rounded: SI but for film (um) and pressure (kPa)."""
    motion = shown_motion(study)
    run = study.representative
    times = np.linspace(0.0, float(motion.time[-1]), FRAMES)

    def at(values: np.ndarray, digits: int) -> list[float]:
        return np.round(np.interp(times, motion.time, values), digits).tolist()

    walker = motion.walker
    x, _ = study.array.places(walker)
    data: dict[str, Any] = {
        "time": np.round(times, 4).tolist(),
        "speed": at(motion.speed, 4),
        "distance": at(motion.distance, 5),
        "normal": at(motion.normal, 1),
        "film_load": at(motion.fluid_load, 1),
        "friction": at(motion.friction, 1),
        "drive": at(motion.drive, 1),
        "angle": at(motion.shoe_angle, 4),
        "sensors": np.round(x, 4).tolist(),
        "wet": study.setting.viscosity is not None,
        "pool": 1e6 * study.setting.settings.pool_depth,
    }
    if run is not None:
        nearest = np.clip(np.searchsorted(motion.time, times), 1, motion.time.size - 1)
        every = max(run.profile_x.size // 90, 1)
        films = 1e6 * run.profiles[nearest][:, ::every].astype(float)
        middle = int(np.argmin(np.abs(MAP_Y)))
        pressure = run.maps[nearest][:, :, middle].astype(float) / 1e3
        data |= {
            "sole_x": np.round(run.profile_x[::every], 4).tolist(),
            "films": [[None if v != v else round(v, 1) for v in row] for row in films],
            "map_x": np.round(MAP_X, 4).tolist(),
            "pressures": np.round(pressure, 1).tolist(),
            "highest": round(float(pressure.max()), 1),
        }
    return data
