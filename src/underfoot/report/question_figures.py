"""Figures of sensitivity, wear and one rough contact."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import display
from underfoot.core.html import new_figure
from underfoot.core.presentation import quantity_text
from underfoot.questions.contact import RoughContact
from underfoot.questions.sensitivity import QUANTITIES, Sensitivity
from underfoot.questions.wear import WearSeries

from .dispatch import FigureMakers, figures, files
from .writing import Writer, data_writers

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Quantities = Mapping[str, str] | Iterable[tuple[str, str]]
MOST = 6
LOW, HIGH = "#4477aa", "#ee7733"
FILM, SENSOR, FRICTION = "#1f5c7a", "#ee7733", "#333333"
SCALES = {"Pa": (1e-3, "kPa")}


@figures.register(Sensitivity)
def _sensitivity(shown: Sensitivity) -> FigureMakers:
    return {"sensitivity": lambda: sensitivity_figure(shown)} if shown.usable else {}


@figures.register(WearSeries)
def _wear(shown: WearSeries) -> FigureMakers:
    return {"wear": lambda: wear_figure(shown)} if shown.usable else {}


def sensitivity_figure(shown: Sensitivity, quantities: Quantities = QUANTITIES) -> Figure:
    """Return one panel a quantity: bars from the nominal value to that at either end."""
    panels = dict(quantities)
    rows = math.ceil(len(panels) / 2)
    figure = new_figure(11.5, 0.6 + 2.9 * rows)
    figure.suptitle(
        f"{shown.nominal.name}\nblue: at the low value, orange: at the high one", fontsize=10
    )
    for number, (name, label) in enumerate(panels.items()):
        axes = figure.add_subplot(rows, 2, number + 1)
        _panel(axes, shown, name, label)
    return figure


def _panel(axes: Axes, shown: Sensitivity, name: str, label: str) -> None:
    unit = shown.nominal.scalars[name].unit
    scale, label_unit = SCALES.get(unit, (1.0, "" if unit == "1" else unit))
    centre = shown.nominal.number(name) * scale
    effects = shown.ranked_effects(name)[:MOST][::-1]
    for row, effect in enumerate(effects):
        for end, colour in ((effect.low, LOW), (effect.high, HIGH)):
            value = end.number(name) * scale
            if not math.isnan(value):
                axes.barh(row, value - centre, left=centre, height=0.62, color=colour, alpha=0.85)
    names = [effect.path.rpartition(".")[2].replace("_", " ") for effect in effects]
    ends = [
        f"{name}\n{display(effect.low_value, effect.unit, 3)} | "
        f"{display(effect.high_value, effect.unit, 3)}"
        for name, effect in zip(names, effects, strict=True)
    ]
    axes.set_yticks(range(len(effects)), ends, fontsize=7.5)
    axes.axvline(centre, color="0.25", linewidth=0.9)
    band = shown.band(name)
    title = f"{label}: {quantity_text(band.value, unit, band.deviation)}"
    axes.set_title(title, fontsize=9.5, loc="left")
    axes.set_xlabel(label_unit)
    axes.margins(y=0.03)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(axis="y", length=0)


def wear_figure(series: WearSeries) -> Figure:
    """Return three panels over wear: fluid load with its limit, peak pressure and COF."""
    figure = new_figure(12.0, 4.6)
    load, peak, friction = figure.subplots(1, 3)
    if series.mode == "patch":
        place, label = series.wear_measures("worn_patch_area") * 1e6, "worn patch (mm²)"
    else:
        place = series.wear_measures("removed_depth") * 1e3
        label = "thickness lost at the most worn place (mm)"
    worn = zip(
        series.wear_measures("tread_left"), series.wear_measures("worn_patch_area"), strict=True
    )
    labels = [f"{left * 1e3:.2g} mm\n{patch * 1e6:.0f} mm²" for left, patch in worn]
    every = math.ceil(len(labels) / 4)  # more would run into one another
    top = load.secondary_xaxis("top")
    top.set_xticks(place[::-every], labels[::-every], fontsize=7)
    top.set_xlabel("tread left where it is least, worn patch", fontsize=8)
    for axes, name, text, colour, scale in (
        (load, "fluid_load", "under the sole", FILM, 1.0),
        (load, "fluid_load_sensor", "as floor sensors read it", SENSOR, 1.0),
        (peak, "peak_fluid_pressure", "under the sole", FILM, 1e-3),
        (peak, "peak_fluid_pressure_sensor", "as a floor sensor reads it", SENSOR, 1e-3),
        (friction, "cof", "", FRICTION, 1.0),
    ):
        low, high = series.ends(name)
        axes.fill_between(place, low * scale, high * scale, color=colour, alpha=0.18, linewidth=0)
        style = {"color": colour, "marker": "o", "markersize": 4}
        axes.plot(place, series.values(name) * scale, label=text, **style)
        if series.untreaded is not None:  # as worn, without any tread
            end = series.curve(name)[-2:] * scale
            axes.plot(place[[-1, -1]], end, color=colour, linestyle=":", linewidth=1)
            bare = "no tread at all" if axes is friction else ""
            axes.plot(place[-1], end[-1], "o", mfc="white", color=colour, label=bare)
    load.axhline(series.limit, color="0.4", linestyle="--", linewidth=1)
    style = {"va": "bottom", "fontsize": 8, "color": "0.3"}
    corner = (0.02, series.limit)
    load.annotate(f"limit {series.limit:g} N", corner, xycoords=("axes fraction", "data"), **style)
    for axes, title in (
        (load, "load carried by the fluid (N)"),
        (peak, "peak fluid pressure (kPa)"),
        (friction, "coefficient of friction"),
    ):
        axes.set(xlabel=label, ylabel=title)
        axes.set_ylim(bottom=0)
        axes.spines["right"].set_visible(False)
        axes.spines["top"].set_visible(axes is load)
        if axes is not friction or series.untreaded is not None:
            axes.legend(frameon=False, fontsize=8)
    return figure


@figures.register(RoughContact)
def _contact(shown: RoughContact) -> FigureMakers:
    if not shown.usable:
        return {}
    floor, title = shown.floor, shown.answer
    return {"contact": partial(contact_figure, floor.heights, floor.spacing, shown.contact, title)}


@files.register(RoughContact)
def _contact_files(shown: RoughContact) -> dict[str, Writer]:
    def write_fields(path: Path) -> None:
        floor, contact = shown.floor, shown.contact
        fields: dict[str, Any] = {"pressure": contact.pressure, "gap": contact.gap}
        np.savez_compressed(path, heights=floor.heights, spacing=floor.spacing, **fields)

    return data_writers(shown) | ({"contact.npz": write_fields} if shown.usable else {})


def contact_figure(heights: np.ndarray, spacing: float, contact: Any, title: str = "") -> Figure:
    """Return four maps of a contact: surface, pressure, patches of contact, gap.

    ``heights`` (m, (nx, ny), axis 0 along sliding), ``spacing`` (m) and a result with ``pressure``
    (Pa) and ``gap`` (m) on the same grid, as ``steady_sliding`` returns it. Sliding is drawn
    upwards. The gap's colours end at the 99 % quantile of where it is open.
    """
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    figure = Figure(figsize=(9.4, 8.0), layout=ConstrainedLayoutEngine(rect=(0.02, 0, 0.97, 1)))
    axes = figure.subplots(2, 2)
    nx, ny = heights.shape
    extent = (0.0, ny * spacing * 1e6, 0.0, nx * spacing * 1e6)
    touching = contact.pressure > 0.0
    open_gap = np.ma.masked_array(contact.gap * 1e6, mask=touching)
    carried = np.ma.masked_array(contact.pressure * 1e-6, mask=~touching)
    highest = 1e6 * float(np.quantile(contact.gap[~touching], 0.99)) if not touching.all() else 0.0
    panels = (
        ("Surface", (heights - heights.mean()) * 1e6, "height (µm)", "cividis", (None, None)),
        ("Contact pressure", carried, "pressure (MPa)", "viridis", (0.0, None)),
        ("Contact patches", touching, "", ListedColormap(["#f2efe9", "#7a1f1f"]), (0.0, 1.0)),
        ("Gap (contact in blue-grey)", open_gap, "gap (µm)", "magma_r", (0.0, max(highest, 1e-9))),
    )
    for ax, (name, field, unit, colours, (low, high)) in zip(axes.flat, panels, strict=True):
        style: dict[str, Any] = {"origin": "lower", "extent": extent, "interpolation": "nearest"}
        image = ax.imshow(field, cmap=colours, vmin=low, vmax=high, **style)
        ax.set_title(name)
        if field is open_gap and touching.all():
            ax.clear()
            ax.set(xticks=[], yticks=[], box_aspect=1)
            ax.text(0.5, 0.5, "full contact:\nno gap anywhere", ha="center", va="center")
            continue
        if field is open_gap:
            ax.set_facecolor("#a9bfd1")  # contact, apart from small gaps
        ax.set(xlabel="across, y (µm)", ylabel="sliding, x (µm)")
        if unit:
            figure.colorbar(image, ax=ax, fraction=0.046, pad=0.03).set_label(unit)
        else:
            ax.set_title(f"{name}: {100.0 * np.mean(touching):.3g} % of the grid")
    if title:
        figure.suptitle(title)
    return figure
