"""Shapes that are no sole, and why."""

from dataclasses import dataclass

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import Message

from .._kernels.covering_discs import local_width
from .._kernels.regions import pieces, without_holes
from ..tread_measures import WIDEST_CHANNEL
from .carriers import span_mask
from .mesh import Unmet
from .view import Soundness

NARROWEST, WIDEST = 0.020, 0.150
"""Width of a sole or a piece of one, m."""
MOST_SLENDER = 7.0
"""Length over width."""
LEAST_SLENDER = 1.5
"""Length over width of what is longer than 200 mm."""
TALL = 0.75
"""Height over width beyond which a body must stand flat to be a shoe."""
STANDING = 0.35
"""Share of the plan form that is level with the floor under a shoe with its upper."""
TOUCHING = 0.08
"""The same under anything."""
THICK = 12e-3
"""An outsole without tread is no thicker where both its sides look alike, m."""
MOST_OPEN = 0.15
"""Share of holes in the plan form."""
ROUGHEST = 0.5e-3
"""Noise from cell to cell beyond which there is no surface, m."""
_ALL_LAND, _SEVERAL, _OPEN_AROUND = 0.99, 3, 0.08
_FLAT = 0.02e-3  # m: a plane
_LONG = 0.200


@dataclass(frozen=True, slots=True)
class Shape:
    """What the plausibility of a sole is judged by; lengths in m, shares 0 to 1.

    Parameters:
        height: (nx, ny) of the lower side, nan outside.
        spacing: Of its cells.
        thickness: Median of the body's thickness.
        tallness: Extent of the body upward.
        standing: Share of the plan form within 2 mm of the floor, gaps bridged.
        noise: Of the heights.
    """

    height: Array
    spacing: float
    thickness: float
    tallness: float
    standing: float
    noise: float


def check_sole(shape: Shape, where: str) -> None:
    """Refuse what can't be a sole or a piece of one.

    Raises:
        DataError: "this is no sole", with the first reason found.
    """
    reason = _reason(shape)
    if reason:
        raise _no_sole(reason, where)


def check_surface(sound: Soundness, where: str) -> None:
    """Refuse loose triangles.

    Raises:
        DataError: No two faces share an edge.
    """
    if sound.open_edges == 3 * (sound.faces - sound.degenerate - sound.not_finite):
        several = "no two of its faces share an edge, they make no surface"
        raise _no_sole(several if sound.faces > 1 else "it is one triangle", where)


def check_tread(shape: Shape, has_tread: bool, where: str) -> None:
    """Refuse a thick body without tread of which nothing tells the ground side.

    Raises:
        DataError: A block or a midsole, with the remedy for an outsole without tread.
    """
    if not has_tread and shape.thickness > THICK:
        raise DataError(
            Message(
                "it has no tread and is {thickness:.3g} mm thick, as a midsole or a block "
                "is, and both its sides look alike",
                thickness=shape.thickness * 1000.0,
            ),
            where=where,
            allowed=Message("a tread, or at most {thick:g} mm", thick=THICK * 1000.0),
            remedy='If it is an outsole without tread, state its ground side: --down "-z" (in a '
            'case: down = "-z")',
        )


def check_carried(
    inside: Mask, land: Mask, spacing: float, unmet: tuple[Unmet, ...], where: str
) -> None:
    """Refuse lugs without the body that carries them: all land, with open channels around.

    ``unmet``: what the file asks for that was not done, which may be that body.

    Raises:
        DataError: Three parts and more, all land, with gaps as narrow as channels between them.
    """
    if np.count_nonzero(land) < _ALL_LAND * np.count_nonzero(inside):
        return
    _, parts = pieces(inside, diagonal=True)
    gaps = span_mask(inside) & ~inside
    if parts < _SEVERAL or not gaps.any():
        return
    narrow = gaps & (local_width(gaps, spacing) < WIDEST_CHANNEL)
    share = np.count_nonzero(narrow) / np.count_nonzero(inside)
    if share > _OPEN_AROUND:
        what = Message(
            "its {parts} parts are all land, with open channels around: the body that carries them "
            "is not among those that were taken",
            parts=parts,
        )
        if unmet:
            lost = [each.what for each in unmet]
            what = Message("{what} (not read: {lost})", what=what, lost=lost)
        raise DataError(
            what,
            where=where,
            allowed="lugs that touch the body they hang on",
            remedy=unmet[0].remedy
            if unmet
            else "Export lugs and base together, touching or as one body; --solid takes all "
            "bodies whose name holds a word",
        )


def _no_sole(reason: str, where: str) -> DataError:
    return DataError(
        Message("this is no sole: {reason}", reason=reason),
        where=where,
        allowed=Message(
            "a sole or a piece of one, {narrowest:.0f} to {widest:.0f} mm wide, "
            "that stands on a floor",
            narrowest=NARROWEST * 1000.0,
            widest=WIDEST * 1000.0,
        ),
        remedy="Check that the file holds the outsole, its unit and where the ground is (--unit, "
        "--down)",
    )


def _reason(shape: Shape) -> str | None:
    inside = np.isfinite(shape.height)
    length, width = (
        float(np.ptp(np.nonzero(inside.any(axis=n))[0]) + 1) * shape.spacing for n in (1, 0)
    )
    size = Message("{length:.4g} x {width:.4g} mm", length=length * 1e3, width=width * 1e3)
    heights = shape.height[inside]
    if shape.thickness < _FLAT and float(np.ptp(heights)) < _FLAT:
        return "it is one flat face without thickness and without tread"
    if shape.noise > ROUGHEST:
        return Message(
            "its heights jump by {noise:.2g} mm from place to place, the faces make no surface",
            noise=shape.noise * 1000.0,
        )
    if width < NARROWEST:
        return Message("it is {size}, narrower than any", size=size)
    if width > WIDEST:
        return Message("it is {size}, wider than any", size=size)
    slender = length / width
    if slender > MOST_SLENDER or (length > _LONG and slender < LEAST_SLENDER):
        return Message("it is {size}, {times:.2g} times as long as wide", size=size, times=slender)
    holes = without_holes(inside) & ~inside
    open_share = np.count_nonzero(holes) / np.count_nonzero(inside | holes)
    if open_share > MOST_OPEN:
        return Message("holes take {open_share:.0%} of its plan form", open_share=open_share)
    tall = shape.tallness > TALL * width
    if shape.standing < (STANDING if tall else TOUCHING):
        standing = Message(
            "only {share:.0%} of its plan form lies within 2 mm of a floor", share=shape.standing
        )
        if not tall:
            return standing
        return Message(
            "it is {high:.3g} mm high, {width:.3g} mm wide, and {standing}",
            high=shape.tallness * 1e3,
            width=width * 1e3,
            standing=standing,
        )
    if tall and length < _LONG:
        high = shape.tallness * 1e3
        return Message("it is {high:.3g} mm high and only {size}", high=high, size=size)
    return None
