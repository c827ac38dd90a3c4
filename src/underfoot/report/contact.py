"""Pictures of one rough contact: heights, pressure, contact patches and gap."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.questions.contact import RoughContact

from .dispatch import FigureMakers, figures, files
from .writing import Writer, data_writers

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@figures.register(RoughContact)
def _figures(shown: RoughContact) -> FigureMakers:
    if not shown.usable:
        return {}
    floor = shown.floor
    title = shown.headline()[0].partition(" (")[0]
    return {"contact": partial(contact_figure, floor.heights, floor.spacing, shown.contact, title)}


@files.register(RoughContact)
def _files(shown: RoughContact) -> dict[str, Writer]:
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
        if name.startswith("Gap") and touching.all():
            ax.clear()
            ax.set(xticks=[], yticks=[], box_aspect=1)
            ax.text(0.5, 0.5, "full contact:\nno gap anywhere", ha="center", va="center")
            continue
        if name.startswith("Gap"):
            ax.set_facecolor("#a9bfd1")  # contact, apart from small gaps
        ax.set(xlabel="across, y (µm)", ylabel="sliding, x (µm)")
        if unit:
            figure.colorbar(image, ax=ax, fraction=0.046, pad=0.03).set_label(unit)
        else:
            ax.set_title(f"{name}: {100.0 * np.mean(touching):.3g} % of the grid")
    if title:
        figure.suptitle(title)
    return figure
