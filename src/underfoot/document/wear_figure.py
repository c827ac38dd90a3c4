"""A wear series as figure, table and page."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .page import embedded, environment, png

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from underfoot.assess.wear import WearSeries

FILM, SENSOR, FRICTION = "#1f5c7a", "#ee7733", "#333333"
COLUMNS = (
    ("removed_depth", "mm", 1e3, "thickness lost"),
    ("tread_left", "mm", 1e3, "tread left, least"),
    ("mean_tread_left", "mm", 1e3, "tread left, mean"),
    ("worn_patch_area", "mm2", 1e6, "worn patch"),
    ("removed_volume", "mm3", 1e9, "volume removed"),
)
NUMBERS = (
    ("cof", "1", 1.0, "COF"),
    ("fluid_load", "N", 1.0, "fluid load"),
    ("fluid_load_sensor", "N", 1.0, "by sensor"),
    ("peak_fluid_pressure", "kPa", 1e-3, "peak"),
    ("peak_fluid_pressure_sensor", "kPa", 1e-3, "peak by sensor"),
)


def save_wear(series: WearSeries, folder: Path) -> None:
    """Write wear.csv, wear.png and report.html into an existing folder."""
    figure = wear_figure(series)
    picture = png(figure)
    (folder / "wear.png").write_bytes(picture)
    write_table(series, folder / "wear.csv")
    page = wear_page(series, picture)
    (folder / "report.html").write_text(page, encoding="utf-8")


def write_table(series: WearSeries, path: Path) -> None:
    """Write one line per state of wear: measures, numbers and their ends over the open inputs."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream)
        heads = [f"{name}_{unit}" for name, unit, _, _ in COLUMNS]
        for name, unit, _, _ in NUMBERS:
            heads += [f"{name}_{unit}", f"{name}_low", f"{name}_high"]
        table.writerow([*heads, "status"])
        ends = {name: series.ends(name) for name, *_ in NUMBERS}
        for number, point in enumerate(series.points):
            row: list[str] = [
                f"{getattr(point.measures, name) * scale:.6g}" for name, _, scale, _ in COLUMNS
            ]
            for name, _, scale, _ in NUMBERS:
                values = (point.outcome.number(name), *(end[number] for end in ends[name]))
                row += ["" if math.isnan(value) else f"{value * scale:.6g}" for value in values]
            table.writerow([*row, str(point.outcome.status)])


def wear_figure(series: WearSeries) -> Figure:
    """Return three panels over wear: fluid load with its limit, peak pressure and COF."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 4.6), layout="constrained")
    load, peak, friction = figure.subplots(1, 3)
    place, label = _axis(series)
    wears = zip(series.measured("tread_left"), series.measured("worn_patch_area"), strict=True)
    words = [f"{left * 1e3:.2g} mm\n{patch * 1e6:.0f} mm²" for left, patch in wears]
    top = load.secondary_xaxis("top")
    top.set_xticks(place, words, fontsize=7)
    top.set_xlabel("tread left where it is least, worn patch", fontsize=8)
    for axes in (load, peak, friction):
        axes.set_xlabel(label)
        axes.spines["right"].set_visible(False)
        axes.spines["top"].set_visible(axes is load)
    _curve(load, series, place, "fluid_load", "under the sole", FILM, 1.0)
    _curve(load, series, place, "fluid_load_sensor", "as floor sensors read it", SENSOR, 1.0)
    load.axhline(series.limit, color="0.4", linestyle="--", linewidth=1)
    load.annotate(
        f"limit {series.limit:g} N",
        (0.02, series.limit),
        xycoords=("axes fraction", "data"),
        va="bottom",
        fontsize=8,
        color="0.3",
    )
    load.set_ylabel("load carried by the fluid (N)")
    load.set_ylim(bottom=0)
    load.legend(frameon=False, fontsize=8)
    _curve(peak, series, place, "peak_fluid_pressure", "under the sole", FILM, 1e-3)
    _curve(
        peak,
        series,
        place,
        "peak_fluid_pressure_sensor",
        "as a floor sensor reads it",
        SENSOR,
        1e-3,
    )
    peak.set_ylabel("peak fluid pressure (kPa)")
    peak.set_ylim(bottom=0)
    peak.legend(frameon=False, fontsize=8)
    _curve(friction, series, place, "cof", "", FRICTION, 1.0)
    friction.set_ylabel("coefficient of friction")
    friction.set_ylim(bottom=0)
    return figure


def wear_page(series: WearSeries, picture: bytes) -> str:
    """Return the page of a wear series as HTML text."""
    from underfoot.assess.wear_trends import trends

    rows = []
    for point in series.points:
        cells = [_short(getattr(point.measures, name) * scale) for name, _, scale, _ in COLUMNS]
        for name, _, scale, _ in NUMBERS:
            value = point.outcome.number(name) * scale
            cells.append("not determined" if math.isnan(value) else _short(value))
        rows.append(cells)
    template = environment().get_template("wear.html")
    return template.render(
        series=series,
        sentences=wear_sentences(series),
        heads=[
            f"{label} ({unit})" if unit != "1" else label
            for _, unit, _, label in (*COLUMNS, *NUMBERS)
        ],
        rows=rows,
        figure=embedded(picture),
        trends=trends(series),
    )


def wear_sentences(series: WearSeries) -> list[str]:
    """Return in words when the fluid's load passes its limit, by the film and by the sensors."""
    found = []
    for name, who in (
        ("fluid_load_sensor", "As floor sensors read it"),
        ("fluid_load", "Under the sole"),
    ):
        passing = series.passings[name]
        lead = f"{who}, the fluid's load"
        if passing.words == "not determined":
            found.append(f"{lead} could not be determined.")
            continue
        if passing.words == "passed when new":
            found.append(
                f"{lead} is above {series.limit:g} N from the start: no wear brings it there."
            )
            continue
        if passing.words != "passed":
            found.append(
                f"{lead} does not pass {series.limit:g} N within the range computed"
                f"{_share(series, passing.passed)}."
            )
            continue
        at, low, high = passing.at, passing.low, passing.high
        tread = _interval(at["tread_left"], low["tread_left"], high["tread_left"], 1e3, "mm")
        area = (at["worn_patch_area"], low["worn_patch_area"], high["worn_patch_area"])
        patch = "no patch worn through yet"
        if any(each > 0 for each in area):
            patch = f"a worn patch of {_interval(*area, 1e6, 'mm2')}"
        found.append(
            f"{lead} passes {series.limit:g} N with {tread} of tread left at the most worn "
            f"place and {patch}{_share(series, passing.passed)}."
        )
    return found


def _short(value: float) -> str:
    """Return a number with three figures, whole where it is large."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def _interval(value: float, low: float, high: float, scale: float, unit: str) -> str:
    ends = []
    for end in (low, high):
        ends.append("beyond the range" if math.isinf(end) else _short(end * scale))
    return f"{_short(value * scale)} {unit} (90 %: {ends[0]} to {ends[1]})"


def _share(series: WearSeries, passed: float) -> str:
    if not series.points[0].variants:
        return ""
    return f"; {passed * 100:.0f} % of the draws pass it within the range"


def _axis(series: WearSeries) -> tuple[NDArray[np.float64], str]:
    """Return where the states lie on the axis of wear, and its label."""
    if series.mode == "patch":
        return series.measured("worn_patch_area") * 1e6, "worn patch (mm²)"
    return series.measured("removed_depth") * 1e3, "thickness lost at the most worn place (mm)"


def _curve(
    axes: Axes,
    series: WearSeries,
    place: NDArray[np.float64],
    name: str,
    label: str,
    colour: str,
    scale: float,
) -> None:
    low, high = series.ends(name)
    axes.fill_between(place, low * scale, high * scale, color=colour, alpha=0.18, linewidth=0)
    axes.plot(
        place, series.values(name) * scale, color=colour, marker="o", markersize=4, label=label
    )
