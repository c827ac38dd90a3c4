"""Friction against speed and against viscosity x speed: curves, parts, intervals, points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.studies.figure import COLOURS, MARKERS, Figure, Layer, Panel, line, points

from .study_figures import drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

    from underfoot.calibrate import StribeckCurve

PART_COLOURS = {"adhesion": "#c8553d", "hysteresis": "#2e86ab", "viscous": "#3c9d6d"}


def stribeck_figure(curves: Sequence[StribeckCurve], title: str = "") -> Picture:
    """Return COF over speed, over viscosity x speed, and the parts of every fluid.

    Bands hold 95 %; points what was published for the fluid on its own pair.
    """
    notes = []
    pairs = dict.fromkeys(curve.pair for curve in curves if curve.points is not None)
    if pairs:
        notes.append(f"points: published, {', '.join(pairs)}")
    if any(curve.interval is not None for curve in curves):
        notes.append("bands: 95 % intervals")
    axes: dict[str, Any] = {"x_scale": "log", "y_limits": (0.0, None)}
    panels = []
    for name, product in (("sliding speed (m/s)", False), ("viscosity × speed (mPa m)", True)):
        layers: list[Layer] = []
        for index, curve in enumerate(curves):
            style: dict[str, Any] = {"colour": COLOURS[index % len(COLOURS)]}
            scale = curve.viscosity * 1e3 if product else 1.0
            whole = np.sum([curve.parts[part] for part in PART_COLOURS], axis=0)
            layers.append(line(curve.speed * scale, whole, curve.label, **style))
            if curve.interval is not None:
                low, high = curve.interval
                layers.append(Layer("band", curve.speed * scale, low=low, high=high, **style))
            if curve.points is not None:
                speed, cof = curve.points
                style["marker"] = MARKERS[index % len(MARKERS)]
                layers.append(points(speed * scale, cof, **style))
        note, legend = ("; ".join(notes), "best") if product else ("", "")
        panels.append(Panel(layers, name, "COF", note, legend=legend, **axes))
    for curve in curves:
        parts = [
            Layer("stack", curve.speed, curve.parts[part], label=part, colour=colour)
            for part, colour in PART_COLOURS.items()
        ]
        name = f"{curve.label}, in its parts"
        panels.append(Panel(parts, "sliding speed (m/s)", "COF", name, **axes))
    return drawn(Figure(panels, title, columns=2 if len(curves) < 3 else 3, size=(4.8, 3.4)))
