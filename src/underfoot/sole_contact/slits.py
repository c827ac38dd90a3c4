"""What a load does to the slits in lugs, and what these do to the lugs."""

from dataclasses import replace

import numpy as np

from underfoot.core.presentation import quantity_text
from underfoot.core.remark import Message
from underfoot.shoe.cut_cells import CutCells
from underfoot.shoe.geometry import SoleMap
from underfoot.shoe.slits import Slits

from ._kernels.elastic import compression, free_share, slit_closing
from .compliance import lug_height, mean_lug_depth


def loaded_slits(
    sole: SoleMap, *, modulus: float, poisson_ratio: float, pressure: float
) -> SoleMap:
    """Return the sole with its slits as far closed as a mean pressure on the lugs closes them.

    The walls move together by what the rubber that the pressure displaces brings in from both sides
    (``slit_closing``), the mean over all slits and over their depth; the same pressure everywhere,
    so slits beside the most loaded lugs are rather more closed, others less. Once the walls meet
    they bear on each other and the lug gives way no further.

    Args:
        sole: Map with its slits open; one without slits or without lugs comes back as it is.
        modulus, poisson_ratio: Of the rubber, Pa and 1.
        pressure: Mean over the land that bears, Pa.
    """
    slits = sole.slits
    if slits is None or mean_lug_depth(sole) == 0:
        return sole
    cut = sole.cut or CutCells.none(sole.land.shape)
    height = lug_height(sole)
    block = sole.land, sole.spacing, height, poisson_ratio, (cut.along, cut.across)
    plain, wide_open = free_share(*block), free_share(*block, slits)
    closing = pressure * slit_closing(wide_open, slits, height, modulus, poisson_ratio)
    closed = slits.closed_by(closing)
    cut_share = plain + closed.openness * (wide_open - plain)
    before, after = (
        np.average(compression(share, height, modulus, poisson_ratio)[sole.land])
        for share in (plain, cut_share)
    )
    freed = slits.covered - closed.covered
    return replace(
        sole,
        slits=replace(closed, further_give=float(after / before) - 1),
        cut=replace(cut, area=cut.area + freed, film_area=cut.film_area + freed),
    )


def slit_words(slits: Slits, *, giving: bool) -> Message:
    """Return in one sentence how much of sipes was computed and what they change.

    ``giving``: whether the compliance knows them, or only the film.
    """
    width = float(np.average(slits.width, weights=slits.length.sum(axis=0)))
    left = max(width - slits.closing, 0.0)
    wide = {"width": quantity_text(width, "m"), "left": quantity_text(left, "m")}
    pressed = Message("{width} wide, pressed to {left}", **wide)
    if not slits.drained.any():
        pressed = Message("{width} wide, {left} under load: shut", **wide)
    effect = Message("they only drain")
    if giving:
        effect = Message("the lugs give way {share:.0%} more", share=slits.further_give)
    return Message(
        "{count} sipes finer than the grid, {length} in all, computed as slits: {pressed}; "
        "{effect}",
        count=slits.count, length=quantity_text(slits.whole_length, "m"), pressed=pressed,
        effect=effect,
    )  # fmt: skip
