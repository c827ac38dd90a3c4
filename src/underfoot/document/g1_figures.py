"""Figures 3, 5 to 8, 10 and 11 of grant report G.1 from the numbers of its study."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FLOOR_COLOURS = ("#7fb3d5", "#2e75b6", "#12355b")
SHOE_STYLES = (("o", "-"), ("s", "--"))
SERIES_NAMES = {"report": "Report's parameters", "broad": "Assumed broad spectrum"}
NO_LOSS = 1e-3


class Row(Protocol):
    """One case: lengths in m, speed in m/s, ``area_per_force`` in m^2/N."""

    series: str
    material: str
    shoe_rz: float
    floor_rz: float
    speed: float
    cof_hysteresis: float
    area_per_force: float


def save_g1_figures(study: Any, folder: Path) -> list[Path]:
    """Write every figure as PNG into an existing folder; return the paths.

    ``study`` has ``rows`` (cases, as ``Row``) and ``histories`` (Fig. 3).
    """
    paths = []
    for name, figure in g1_figures(study).items():
        paths.append(folder / f"{name}.png")
        figure.savefig(paths[-1], dpi=150)
    return paths


def g1_figures(study: Any) -> dict[str, Figure]:
    """Return the figures by file name."""
    rows = study.rows
    made = {
        "fig05_hysteresis_roughness": roughness_figure(rows, "cof_hysteresis"),
        "fig06_hysteresis_speed": speed_figure(rows, "cof_hysteresis"),
        "fig07_area_speed": speed_figure(rows, "area_per_force"),
        "fig08_area_roughness": roughness_figure(rows, "area_per_force"),
        "fig10_area_speed_own": speed_figure(rows, "area_per_force", own=True),
        "fig11_area_roughness_own": roughness_figure(rows, "area_per_force", own=True),
    }
    if study.histories:
        made = {
            "fig03_history": history_figure(study.histories, study.settings.floor_wavelength),
            **made,
        }
    return made


def history_figure(
    histories: Sequence[Any],
    wavelength: float,
    title: str = "Fig. 3: rubber, high shoe roughness on the high floor",
) -> Figure:
    """Return Fig. 3: real contact area, normal and shear force against time, a column for each.

    ``histories`` have ``time`` (s), ``distance`` (m), ``normal_force``, ``shear_force`` (N),
    ``real_contact_area`` (m^2), ``series`` and ``speed`` (m/s); ``wavelength`` (m) is the floor's:
    the mean shear force is that over whole ones after the first.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.6 * len(histories) + 0.6, 6.4), layout="constrained")
    grid = figure.subplots(3, len(histories), sharex="col", sharey="row", squeeze=False)
    for column, history in enumerate(histories):
        time = history.time * 1e3
        sliding = time[history.distance > 0.0]
        panels = (
            ("Real contact area (mm²)", history.real_contact_area * 1e6, "#12355b"),
            ("Normal force (mN)", history.normal_force * 1e3, "#2e75b6"),
            ("Shear force (mN)", history.shear_force * 1e3, "#b04a2f"),
        )
        for row, (label, values, colour) in enumerate(panels):
            axes = grid[row, column]
            axes.plot(time, values, color=colour, linewidth=1.6)
            if sliding.size:
                axes.axvline(sliding[0], color="0.7", linewidth=0.8, linestyle=":")
            if column == 0:
                axes.set_ylabel(label)
            _plain(axes)
            if row < 2:
                # The columns share their axis: the limit must hold for what was drawn before.
                top = max(
                    1.06 * float(values.max(initial=0.0)), axes.get_ylim()[1] if column else 0
                )
                axes.set_ylim(0.0, top if top > 0.0 else 1.0)
            else:
                axes.axhline(0.0, color="0.6", linewidth=0.8)
                axes.set_xlabel("time (ms)")
                mean = _whole_wavelength_mean(history.distance, values, wavelength)
                if mean is None:
                    continue
                axes.axhline(mean, color=colour, linewidth=0.9, linestyle="--")
                axes.annotate(
                    f"mean over whole floor waves {0.0 if abs(mean) < 5e-3 else mean:.2f} mN",
                    (0.02, 0.96),
                    xycoords="axes fraction",
                    fontsize="small",
                    va="top",
                    color=colour,
                )
        name = SERIES_NAMES.get(history.series, history.series)
        grid[0, column].set_title(f"{name}, {history.speed:g} m/s", fontsize="medium")
        if sliding.size:
            grid[0, column].annotate(
                "sliding",
                (sliding[0], 0.03),
                xycoords=("data", "axes fraction"),
                xytext=(4, 0),
                textcoords="offset points",
                fontsize="small",
                color="0.4",
            )
    if title:
        figure.suptitle(title)
    return figure


def roughness_figure(rows: Sequence[Row], quantity: str, *, own: bool = False) -> Figure:
    """Return Fig. 5 or 8 (or 11, ``own`` shoe roughness only) at the lowest speed: bars."""
    slow = min(row.speed for row in rows)
    chosen = [row for row in rows if row.speed == slow]

    def bars(axes: Axes, some: list[Row]) -> None:
        floors = sorted({row.floor_rz for row in some})
        shoes = sorted({row.shoe_rz for row in some})
        width = 0.8 / len(shoes)
        for number, shoe in enumerate(shoes):
            values = [
                next(
                    getattr(row, quantity) * _factor(quantity)
                    for row in some
                    if (row.shoe_rz, row.floor_rz) == (shoe, floor)
                )
                for floor in floors
            ]
            axes.bar(
                np.arange(len(floors)) + (number - 0.5 * (len(shoes) - 1)) * width,
                values,
                0.92 * width,
                color=("#9db8cc", "#12355b")[number] if len(shoes) > 1 else "#2e75b6",
                label=f"shoe Rz {shoe * 1e6:g} µm",
            )
        axes.set_xticks(range(len(floors)), [f"{floor * 1e6:g}" for floor in floors])
        axes.set_xlabel("floor Rz (µm)")
        axes.set_ylim(bottom=0.0)
        axes.legend(frameon=False, fontsize="small")

    number = {"cof_hysteresis": "5", "area_per_force": "11" if own else "8"}[quantity]
    return _panels(chosen, quantity, own, bars, number, f" at {slow:g} m/s", shared=False)


def speed_figure(rows: Sequence[Row], quantity: str, *, own: bool = False) -> Figure:
    """Return Fig. 6 or 7 (or 10, ``own`` shoe roughness only): lines against speed."""

    def lines(axes: Axes, some: list[Row]) -> None:
        floors = sorted({row.floor_rz for row in some})
        shoes = sorted({row.shoe_rz for row in some})
        for j, shoe in enumerate(shoes):
            for i, floor in enumerate(floors):
                line = sorted(
                    (row for row in some if (row.shoe_rz, row.floor_rz) == (shoe, floor)),
                    key=lambda row: row.speed,
                )
                marker, style = SHOE_STYLES[j % 2]
                label = f"floor {floor * 1e6:g}"
                axes.plot(
                    [row.speed for row in line],
                    [getattr(row, quantity) * _factor(quantity) for row in line],
                    marker=marker,
                    linestyle=style,
                    markersize=4.5,
                    color=FLOOR_COLOURS[i % 3],
                    label=label if own else f"{label}, shoe {shoe * 1e6:g}",
                )
        axes.set_xlabel("sliding speed (m/s)")
        axes.set_xlim(left=0.0)
        highest = max(getattr(row, quantity) for row in some) * _factor(quantity)
        axes.set_ylim(0.0, 1.08 * highest if highest > 0.0 else 1.0)

    number = {"cof_hysteresis": "6", "area_per_force": "10" if own else "7"}[quantity]
    return _panels(rows, quantity, own, lines, number, "", shared=True)


def _panels(
    rows: Sequence[Row],
    quantity: str,
    own: bool,
    draw: Callable[[Axes, list[Row]], None],
    number: str,
    when: str,
    *,
    shared: bool,
) -> Figure:
    """Return a grid of panels: a row for each series, a column for each material."""
    from matplotlib.figure import Figure

    series = list(dict.fromkeys(row.series for row in rows))
    materials = sorted({row.material for row in rows})
    figure = Figure(
        figsize=(4.1 * len(materials) + (1.6 if shared else 0.0), 3.1 * len(series) + 0.6),
        layout="constrained",
    )
    friction = quantity == "cof_hysteresis"  # materials compare; their areas differ tenfold
    grid = figure.subplots(len(series), len(materials), squeeze=False, sharey=friction)
    for i, name in enumerate(series):
        for j, material in enumerate(materials):
            some = [row for row in rows if row.series == name and row.material == material]
            if own:
                some = [row for row in some if row.shoe_rz == _own_roughness(material, some)]
            axes = grid[i, j]
            draw(axes, some)
            _plain(axes)
            shoe = f", shoe Rz {some[0].shoe_rz * 1e6:g} µm" if own else ""
            title = f"{SERIES_NAMES.get(name, name)}: {material}{shoe}"
            axes.set_title(title, fontsize="small" if own else "medium")
            if j == 0 or not friction:
                axes.set_ylabel(_label(quantity))
            largest = max(abs(getattr(row, quantity)) for row in some)
            if quantity == "cof_hysteresis" and largest < NO_LOSS:
                _no_loss(axes, largest)
            if own and not shared and axes.get_legend() is not None:
                axes.get_legend().remove()
    if friction:
        largest = max(abs(row.cof_hysteresis) for row in rows)
        grid[0, 0].set_ylim(0.0, 1.05 * max(largest, NO_LOSS))
    if shared:
        handles, labels = grid[-1, 0].get_legend_handles_labels()
        figure.legend(
            handles,
            labels,
            loc="outside right center",
            frameon=False,
            fontsize="small",
            title="Rz (µm)",
        )
    text = {"cof_hysteresis": "hysteresis COF", "area_per_force": "real contact area per force"}
    extra = ", own shoe roughness" if own else ""
    figure.suptitle(f"Fig. {number}: {text[quantity]}{when}{extra}")
    return figure


def _own_roughness(material: str, rows: Sequence[Row]) -> float:
    """Return the roughness a material had in the tests: neolite the low one, rubber the high."""
    values = [row.shoe_rz for row in rows]
    return min(values) if material == "neolite" else max(values)


def _no_loss(axes: Axes, largest: float) -> None:
    """Say that there is nothing to see, on an axis that does not magnify rounding."""
    for artist in (*axes.lines, *axes.patches):
        artist.set_visible(False)
    legend = axes.get_legend()
    if legend is not None:
        legend.remove()
    axes.text(
        0.5,
        0.5,
        f"no hysteresis friction:\n|COF| at most {largest:.0e}",
        transform=axes.transAxes,
        ha="center",
        va="center",
        color="0.35",
    )


def _whole_wavelength_mean(
    distance: np.ndarray, values: np.ndarray, wavelength: float
) -> float | None:
    """Return the mean over the whole wavelengths after the first (of one: over it), or None."""
    slid = np.flatnonzero(distance > 0.0)
    whole = int(distance[-1] / wavelength * (1.0 + 1e-6)) if slid.size else 0
    if whole < 1:
        return None
    start = wavelength * min(1, whole - 1)
    end = min(wavelength * whole, float(distance[-1]))
    places = np.linspace(start, end, 4001)
    x = np.concatenate([[0.0], distance[slid]])
    y = np.concatenate([values[slid[:1]], values[slid]])
    return float(np.trapezoid(np.interp(places, x, y), places) / (end - start))


def _factor(quantity: str) -> float:
    return 1e6 if quantity == "area_per_force" else 1.0


def _label(quantity: str) -> str:
    return "$A_c / F_N$ (mm²/N)" if quantity == "area_per_force" else "hysteresis COF"


def _plain(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
