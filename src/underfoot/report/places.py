"""Pictures of the choice of a shoe."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from underfoot.core.html import new_figure
from underfoot.places.choice import ShoeChoice

from .dispatch import FigureMakers, figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@figures.register(ShoeChoice)
def _(shown: ShoeChoice) -> FigureMakers:
    return {"slips": lambda: slips_figure(shown)}


def slips_figure(choice: ShoeChoice) -> Figure:
    """Return slips of every shoe with their interval, and the chance that it is best."""
    shoes = sorted(choice.shoes, key=lambda each: each.best)
    figure = new_figure(7.0, 1.2 + 0.45 * len(shoes))
    axes = figure.subplots()
    at = np.arange(len(shoes))
    low, high = 100 * np.array([shoe.slips.interval for shoe in shoes]).T
    axes.hlines(at, low, high, color="C0", lw=2)
    axes.plot([100 * float(shoe.slips) for shoe in shoes], at, "o", color="C0")
    axes.set_yticks(at, [f"{shoe.shoe.name} ({100 * shoe.best:.0f} %)" for shoe in shoes])
    axes.set(xlim=(0, 100), xlabel="steps in a fluid that slip, %: mean, 95 % (chance of best)")
    axes.set_ylim(-0.6, len(shoes) - 0.4)
    return figure
