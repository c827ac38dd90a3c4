"""The page of a wear series: the sole from new to worn on a slider, then figures and tables."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from underfoot.core.html import data_address
from underfoot.core.page import PageSection, Picture, remark_sections, table_sections
from underfoot.core.remark import Message
from underfoot.questions.wear import WearSeries

from .dispatch import files, sections
from .drawn_sole import DrawnSole
from .quantities import DrawnQuantity
from .surface_mesh import surface_mesh
from .viewer import history, listed_quantity, pane, scene, scene_section, viewer_script
from .writing import Writer, data_writers

CELL = 1e-3
"""m: side of the cells of the picture, or what the sole's own come nearest to it."""
LEAST = 1e-6
"""m lost below which land is drawn as not worn."""
LOST = DrawnQuantity("lost", "Thickness lost", 1e-3, "mm", "viridis")
LEFT = DrawnQuantity("left", "Tread left", 1e-3, "mm", "cividis")
PRESSURES = (
    DrawnQuantity("contact_pressure", "Contact pressure", 1e3, "kPa", stress=True),
    DrawnQuantity("fluid_pressure", "Fluid pressure", 1e3, "kPa", stress=True),
)
NONE = 0.1
"""kPa below which no pressure is drawn."""


@sections.register(WearSeries)
def _wear_sections(
    series: WearSeries, pictures: dict[str, bytes]
) -> tuple[Sequence[PageSection], str]:
    drawn = [
        PageSection("Over the wear", pictures=[Picture(name, data_address(data), True)])
        for name, data in pictures.items()
    ]
    parts = [*drawn, *table_sections(series), *remark_sections(series)]
    if not series.soles:
        return parts, ""
    sole = PageSection("The sole as it wears", html=scene_section(wear_scene(series)), stage=True)
    return [sole, *parts], viewer_script()


def wear_scene(series: WearSeries) -> dict[str, Any]:
    """Return the data of the viewer: one sole whose shape and colours follow the slider."""
    new = series.soles[0]
    every = max(1, round(CELL / new.spacing))
    thinned = (slice(None, None, every), slice(None, None, every))
    heights = [sole.height[thinned] for sole in series.soles]
    lands = [sole.land[thinned] for sole in series.soles]
    nx, ny = heights[0].shape
    everywhere = (slice(0, nx), slice(0, ny))
    shape = DrawnSole(
        new.x[::every], new.y[::every], every * new.spacing, heights[0], None, lands[0],
        everywhere, everywhere,
    )  # fmt: skip
    lost = np.stack(heights) - heights[0]
    lost = np.where(np.stack(lands) & (lost > LEAST), lost, np.nan) / LOST.factor
    left = [sole.tread_depth[thinned] for sole in series.soles]
    left = np.where(np.stack(lands), np.stack(left), np.nan) / LEFT.factor
    coloured = {LOST: lost, LEFT: left}
    for pressure in PRESSURES if series.maps else ():
        frames = np.stack([each[pressure.name][thinned] for each in series.maps]) / pressure.factor
        coloured[pressure] = np.where(frames > NONE, frames, np.nan)
    surfaces = [surface_mesh(each.x, each.y, each.height, each.land) for each in series.soles]
    labels = [_state(series, number) for number in range(len(series.soles))]
    shown = pane(
        series.name,
        shape,
        {quantity.name: frames[0] for quantity, frames in coloured.items()},
        surfaces[0],
        histories={quantity.name: history(labels, each) for quantity, each in coloured.items()},
        states=list(zip(heights, lands, surfaces, strict=True)),
    )
    listed = [listed_quantity(quantity, [frames]) for quantity, frames in coloured.items()]
    return scene([shown], listed, "Wear")


@files.register(WearSeries)
def _wear_files(series: WearSeries) -> dict[str, Writer]:
    fields = {"wear.nc": lambda path: series.fields().to_netcdf(path)} if series.soles else {}
    return {**data_writers(series), **fields}


def _state(series: WearSeries, number: int) -> Message:
    """Return what a state is called on the slider."""
    bare = number == len(series.points)
    outcome = series.untreaded if bare else series.points[number].outcome
    cof = math.nan if outcome is None else outcome.number("cof")
    friction = Message("no result") if math.isnan(cof) else Message("COF {cof:.3f}", cof=cof)
    if bare:
        return Message("no tread at all, {friction}", friction=friction)
    if not number:
        return Message("new, {friction}", friction=friction)
    lost = series.points[number].measures.removed_depth * 1e3
    return Message("{lost:.3g} mm lost, {friction}", lost=lost, friction=friction)
