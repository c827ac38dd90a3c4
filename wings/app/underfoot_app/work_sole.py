"""What the page of a sole from a file asks."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import InputError, Progress
from underfoot.core.fields import labelled
from underfoot.core.files import checksum
from underfoot.report.outsole import OutsoleInspection
from underfoot.report.surface_mesh import surface_mesh
from underfoot.shoe.files import FileSettings, outsole_from_mesh, read_mesh
from underfoot.shoe.tread_measures import channel_depth, tread_measures

from .work import Drawn, presented, sole_html

DRAWN_SPACING = 0.75e-3
"""m between the cells of a file's sole as it is drawn."""


def inspected_sole(path: str, settings: Mapping[str, Any], *, progress: Progress) -> dict[str, Any]:
    """Return an outsole file as it is read with ``settings``: in words and as a part of a page.

    Raises:
        InputError, DataError: As ``outsole_from_file``; the file changed while it was read.
    """
    file, chosen = Path(path), FileSettings(**settings)
    progress("reading the file", 0.05)
    before = checksum(path)
    mesh = read_mesh(file, chosen.unit)
    progress("finding the sole in it", 0.5)
    outsole = outsole_from_mesh(mesh, chosen, name=file.name, where=path)
    progress("measuring its tread", 0.75)
    inspection = OutsoleInspection(file, chosen, outsole, tread_measures(outsole.surface))
    progress("drawing", 0.9)
    surface = inspection.outsole.surface
    step = max(1, round(DRAWN_SPACING / surface.spacing))
    thinned = (slice(None, None, step), slice(None, None, step))
    depth = np.where(surface.land, np.nan, channel_depth(surface))
    axes = ("x", "y")
    fields = labelled(
        {
            "height": (axes, surface.height[thinned], {"units": "m", "long_name": "height"}),
            "channel_depth": (
                axes, depth[thinned], {"units": "m", "long_name": "depth of the channels"}
            ),
            "inside": (axes, surface.inside[thinned]),
            "land": (axes, surface.land[thinned]),
        },
        {"x": ("x", surface.x[::step]), "y": ("y", surface.y[::step])},
    )  # fmt: skip
    if checksum(path) != before:
        raise InputError(
            "the file changed while it was read",
            where=file.name,
            remedy="Wait until the program that writes it is done, then drop it again",
        )
    whole = surface_mesh(surface.x, surface.y, surface.height, surface.land)
    html = sole_html(Drawn(inspection.file.name, fields), whole)
    return {**presented(inspection), "html": html, "sha256": before}
