"""What each open input does to a case's numbers, as bars about the nominal value."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from underfoot.core import display

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from underfoot.assess.sensitivity import Sensitivity

MOST = 6
LOW, HIGH = "#4477aa", "#ee7733"
SCALES = {"Pa": (1e-3, "kPa")}


def save_sensitivity(
    found: Sensitivity, quantities: Sequence[tuple[str, str]], folder: Path
) -> None:
    """Write sensitivity.png and sensitivity.csv into an existing folder."""
    sensitivity_figure(found, quantities).savefig(folder / "sensitivity.png", dpi=130)
    with (folder / "sensitivity.csv").open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream)
        table.writerow(
            "quantity unit nominal input low_input high_input input_unit at_low at_high deviation "
            "reason".split()
        )
        for name, _ in quantities:
            unit = found.nominal.scalars[name].unit
            for effect in found.ranked(name):
                numbers = (effect.low.number(name), effect.high.number(name))
                table.writerow(
                    [name, unit, repr(found.nominal.number(name)), effect.path]
                    + [repr(effect.low_value), repr(effect.high_value), effect.unit]
                    + [repr(each) for each in numbers]
                    + [repr(effect.deviation(name, found.nominal)), effect.reason]
                )


def sensitivity_figure(found: Sensitivity, quantities: Sequence[tuple[str, str]]) -> Figure:
    """Return one panel a quantity: bars from the nominal value to that at either end."""
    from matplotlib.figure import Figure

    rows = math.ceil(len(quantities) / 2)
    figure = Figure(figsize=(11.5, 0.6 + 2.9 * rows), layout="constrained")
    figure.suptitle(
        f"{found.nominal.name}\nblue: at the low value, orange: at the high one", fontsize=10
    )
    for number, (name, label) in enumerate(quantities):
        axes = figure.add_subplot(rows, 2, number + 1)
        _panel(axes, found, name, label)
    return figure


def _panel(axes: Axes, found: Sensitivity, name: str, label: str) -> None:
    unit = found.nominal.scalars[name].unit
    scale, shown = SCALES.get(unit, (1.0, "" if unit == "1" else unit))
    centre = found.nominal.number(name) * scale
    effects = found.ranked(name)[:MOST][::-1]
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
    band = found.band(name)
    axes.set_title(
        f"{label}: {display(band.value, unit, 3)} ± {display(band.deviation, unit, 2)}",
        fontsize=9.5,
        loc="left",
    )
    axes.set_xlabel(shown)
    axes.margins(y=0.03)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
