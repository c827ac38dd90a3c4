"""Figures 18 to 20, 22 and 24 of the pin-on-disk studies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#12355b", "#2e86ab", "#3c9d6d", "#b8860b", "#c8553d", "#7a3e6b")
FLUIDS = {
    "water_g2": "water",
    "detergent_g2": "detergent",
    "glycerol_25pct": "25 % glycerol",
    "glycerol_50pct": "50 % glycerol",
    "glycerol_75pct": "75 % glycerol",
    "canola_oil": "canola",
}


def pin_figures(study: Any) -> dict[str, Figure]:
    """Return further figures of study g2 or g3 by file name."""
    if study.name == "g2":
        return {"fig18_20_levels": levels_figure(), "fig19_film": film_figure()}
    tables = {table.name: table for table in study.tables}
    return {
        "fig22_contact_area": bars_figure(
            tables["contact_area"], "Fig. 22: in its place the share of real contact (Persson)",
            "real over apparent contact",
        ),
        "fig24_adhesion": bars_figure(
            tables["eq26"], "Fig. 24: adhesion left under each fluid by Eq. 26", "adhesion (N)"
        ),
    }  # fmt: skip


def levels_figure() -> Figure:
    """Return friction at rest and decay speed of the fluids, printed and from viscosity alone."""
    from matplotlib.figure import Figure

    from underfoot.case.build import measured_fluids
    from underfoot.core.catalogue import Catalogue
    from underfoot.friction import viscous_decay

    measured = {one.fluid: one for one in measured_fluids(Catalogue.load())}
    decay = viscous_decay([one for one in measured.values() if one.tau_hydro is not None])
    figure = Figure(figsize=(10.5, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for k, (name, label) in enumerate(FLUIDS.items()):
        one = measured[name]
        left.bar(k, one.cof_boundary.value or 0.0, 0.7, color=COLOURS[k])
        left.errorbar(
            k, one.cof_boundary.value or 0.0, yerr=one.cof_boundary.uncertainty, color="0.1",
            capsize=3,
        )  # fmt: skip
        if one.tau_hydro is not None:
            right.errorbar(
                1e3 * one.viscosity, one.tau_hydro.value or 0.0, yerr=one.tau_hydro.uncertainty,
                color=COLOURS[k], marker="o", capsize=3, label=label,
            )  # fmt: skip
    left.set_xticks(range(len(FLUIDS)), list(FLUIDS.values()), rotation=25, ha="right", fontsize=8)
    left.set_ylabel("COF at rest (printed ± sd)")
    x = np.geomspace(0.4, 8, 50)
    right.plot(
        x, 1e3 * (decay.value or 0.0) / x, color="0.3", linewidth=1,
        label=f"viscosity x tau = {1e3 * (decay.value or 0):.2f} mPa m",
    )  # fmt: skip
    right.set(xlabel="viscosity (mPa s)", ylabel="decay speed tau (m/s)", xscale="log")
    right.set_xticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
    right.minorticks_off()
    right.set_ylim(bottom=0)
    right.legend(frameon=False, fontsize=8)
    figure.suptitle("Fig. 18 and 20: friction at rest and decay speed; one product fits all four")
    for axes in (left, right):
        _plain(axes)
    return figure


def film_figure() -> Figure:
    """Return film thickness over roughness against speed on the pin (Eq. 18), six fluids."""
    from matplotlib.figure import Figure

    from underfoot.calibrate import pin_on_disk
    from underfoot.case.build import measured_fluids
    from underfoot.core.catalogue import Catalogue
    from underfoot.reference import soft_ehl_film

    catalogue = Catalogue.load()
    pin = pin_on_disk(catalogue)
    measured = {one.fluid: one for one in measured_fluids(catalogue)}
    sigma = float(np.hypot(pin.sole_rq, pin.floor_rq))
    speed = np.geomspace(0.05, 1.0, 30)
    figure = Figure(figsize=(6.6, 4.4), layout="constrained")
    axes = figure.add_subplot()
    for k, (name, label) in enumerate(FLUIDS.items()):
        films = [
            soft_ehl_film(
                viscosity=measured[name].viscosity, entrainment_speed=float(v),
                load=pin.normal_force, radius=pin.radius, effective_modulus=pin.modulus,
            )[1] / sigma
            for v in speed
        ]  # fmt: skip
        axes.plot(speed, films, color=COLOURS[k], label=label)
    axes.axhline(1.0, color="0.5", linestyle="--", linewidth=1)
    axes.text(0.052, 1.03, "mixed above, boundary below", fontsize=8, color="0.35")
    axes.set(xlabel="speed (m/s)", ylabel="film over roughness, lambda")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, fontsize=8)
    axes.set_title("Fig. 19: film of the pin by Eq. 18 (W = w / (E' R'^2), R' in mm)", fontsize=10)
    _plain(axes)
    return figure


def bars_figure(table: Any, title: str, label: str) -> Figure:
    """Return grouped bars of a table, one group a row."""
    from matplotlib.figure import Figure

    names = [str(row[0]) for row in table.rows]
    groups = [(str(head), [float(row[i + 1]) for row in table.rows])
              for i, head in enumerate(table.columns[1:])]  # fmt: skip
    figure = Figure(figsize=(8.2, 4.2), layout="constrained")
    axes = figure.add_subplot()
    width = 0.8 / len(groups)
    for k, (head, values) in enumerate(groups):
        place = np.arange(len(names)) + (k - 0.5 * (len(groups) - 1)) * width
        axes.bar(place, values, 0.92 * width, color=COLOURS[k], label=head)
    axes.set_xticks(
        range(len(names)), [n.replace("_", " ") for n in names], rotation=15, fontsize=8
    )
    axes.set_ylabel(label)
    axes.set_title(title, fontsize=10)
    axes.legend(frameon=False, fontsize=8)
    _plain(axes)
    return figure


def _plain(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
