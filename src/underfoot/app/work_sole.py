"""What the page of a sole from a file asks."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.compute.result import Result
from underfoot.compute.sole import new_sole, sole_shape
from underfoot.core import InputError, Progress
from underfoot.core.fields import labelled_fields
from underfoot.core.files import checksum
from underfoot.core.remark import Message
from underfoot.report.outsole import OutsoleInspection, case_shoe
from underfoot.report.surface_mesh import surface_mesh
from underfoot.shoe import heel_map
from underfoot.shoe.files import FileSettings, outsole_from_mesh, read_mesh
from underfoot.shoe.geometry import CELLS_REFUSED
from underfoot.shoe.lug_drainage import GROOVE
from underfoot.shoe.tread_measures import channel_depth, tread_measures

from .inputs import GROOVES, grooves_of
from .work import LAND_SPACING, Drawn, presented, sole_html

DRAWN_SPACING = 0.75e-3
"""m between the cells of a file's sole as it is drawn."""
LAND_EQUAL = 0.005
"""The most by which equal shares of land differ."""
CHANNEL = "shoe.tread.channel_width"
STEP, WIDEST, HALVINGS = 1.1, 60e-3, 10
"""Ratio of the channel widths (m) tried one after the other until one lies beyond what is sought,
the widest of them, and how often what lies between is halved."""


def inspected_sole(
    path: str, settings: Mapping[str, Any], folder: str = "", *, progress: Progress
) -> dict[str, Any]:
    """Return an outsole file as it is read with ``settings``: in words and as a part of a page.

    ``shoe`` is that of a case in ``folder``, as ``underfoot outsole inspect --out`` writes it.

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
    measures = tread_measures(outsole.surface, outsole.edges)
    inspection = OutsoleInspection(file, chosen, outsole, measures)
    progress("drawing", 0.9)
    surface = inspection.outsole.surface
    step = max(1, round(DRAWN_SPACING / surface.spacing))
    thinned = (slice(None, None, step), slice(None, None, step))
    depth = np.where(surface.land, np.nan, channel_depth(surface))
    axes = ("x", "y")
    fields = labelled_fields(
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
    shoe = case_shoe(inspection, Path(folder or file.parent))
    return {**presented(inspection), "html": html, "shoe": shoe}


def equal_land(
    path: str, other: str, *, progress: Progress
) -> tuple[dict[str, str], dict[str, str]]:
    """Return the changes of the case ``other`` that give it the share of land of ``path``.

    That is another channel width, found by bisection from the present one; none where the shares
    are within ``LAND_EQUAL``. Then both shares, and the widths before and after, in words. Land is
    that of the new sole, over all of its plan form, sipes narrower than two cells left aside.

    Raises:
        InputError: A sole from a file or a tread without channel width; no width gives that share.
    """
    one, case = Case.load(path), Case.load(other)
    for each in (one, case):
        if each.shoe.outsole is not None:
            raise InputError(
                Message(
                    "the sole of {name} comes from a file: its channels have no width to set",
                    name=each.name,
                ),
                where="shoe.outsole.file",
                remedy="Compare at equal land two soles with a tread of the app's own, or change "
                "the file in CAD and compute it again",
            )
    width = case.value(CHANNEL)
    if width is None or case.value("shoe.tread.land") is not None:
        raise InputError(
            Message("no channel width sets the share of land of {name}", name=case.name),
            where="shoe.tread.pattern",
            remedy="Choose a pattern of lugs and channels"
            + (", or set shoe.tread.land" if width else ""),
        )
    sought, before = _land_share(one), _land_share(case)
    words = {"before": _width_text(width), "land": _percent(sought), "had": _percent(before)}
    if abs(before - sought) <= LAND_EQUAL:
        return {}, words

    def off(wide: float) -> float:
        """Return by how much the share of land is too large with channels of a width (m)."""
        progress("finding the channel width", 0.5)
        return _land_share(case.replace(CHANNEL, _width_text(wide))) - sought

    more = before > sought  # wider channels leave less land
    near = far = width
    least = 2 * max(case.numerics.grid_spacing, case.numerics.quick_grid_spacing)
    while (off(far) > 0) == more:
        near, last = far, far
        far = float(np.clip(far * (STEP if more else 1 / STEP), least, WIDEST))
        if far == last:
            reached = _percent(sought + off(far))
            raise InputError(
                Message(
                    "channels of {width} leave {name} {land} of land, {other} has {wanted}",
                    width=_width_text(far),
                    name=case.name,
                    land=reached,
                    other=one.name,
                    wanted=_percent(sought),
                ),
                where=CHANNEL,
                allowed=Message(
                    "{narrowest} (two cells of the grid) to {widest}",
                    narrowest=_width_text(least),
                    widest=_width_text(WIDEST),
                ),
                remedy="Change shoe.tread.lug_width of one of them, then compare again",
            )
    for _ in range(HALVINGS):
        middle = (near + far) / 2
        near, far = (middle, far) if (off(middle) > 0) == more else (near, middle)
    found = _width_text((near + far) / 2)
    share = _land_share(case.replace(CHANNEL, found))
    if abs(share - sought) > LAND_EQUAL:  # a row of lugs came onto the sole or left it
        raise InputError(
            Message(
                "no channel width near {near} gives {name} {wanted} of land, the nearest {nearest}",
                near=found,
                name=case.name,
                wanted=_percent(sought),
                nearest=_percent(share),
            ),
            where=CHANNEL,
            remedy="Change shoe.tread.lug_width a little, then compare again",
        )
    return {CHANNEL: found}, {**words, "after": found}


WAYS = ((1, 0), (-1, 0), (0, 1), (0, -1))
"""Directions (x, y) of the sides of a lug as ``lug_groove_side`` counts them."""


def advised_groove(path: str, folder: str, lug: int, *, progress: Progress) -> dict[str, Any]:
    """Return the change that cuts the groove that a case's result advises for a lug.

    From half its width behind the peak of the fluid's pressure to one cell beyond the lug's wall,
    as wide as those that were compared and two cells at least; on the sole as it lay at the case's
    own place and angle.
    """
    case, data = Case.load(path), Result.load(folder).data
    x, y, length, side = (
        float(data[f"lug_{name}"].values[lug]) for name in ("x", "y", "groove", "groove_side")
    )
    cells = case.numerics.grid_spacing, case.numerics.quick_grid_spacing
    width, step = max(GROOVE, CELLS_REFUSED * max(cells)), float(np.ptp(data["x"].values[:2]))
    u, v = WAYS[int(side)]
    shape, angle = sole_shape(case), case.motion.shoe_angle
    line = np.linspace(0.0, shape.length, 4001)
    height_there = shape.land_height(line, np.full_like(line, y))
    rear = float(shape.land_height(np.zeros(1), np.zeros(1))[0]) * np.sin(angle)
    on_floor = line * np.cos(angle) - height_there * np.sin(angle) + rear
    ends = np.array([-width / 2, length + step])
    along, across = np.interp(x + u * ends, on_floor, line), y + v * ends
    new = {
        "along": _width_text(along.mean()),
        "across": _width_text(across.mean()),
        "width": _width_text(width),
        "length": _width_text(np.ptp(along) + np.ptp(across)),
        "angle": "90 deg" if u else "0 deg",
    }
    return {GROOVES: [*grooves_of(case), new]}


def _width_text(width: float) -> str:
    return f"{round(1e3 * width, 6) + 0.0:.4g} mm"  # no rounding of zero, no sign of it


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def _land_share(case: Case) -> float:
    """Return land / plan form of a case's new sole."""
    return heel_map(new_sole(case), shoe_angle=0.0, spacing=LAND_SPACING).land_ratio
