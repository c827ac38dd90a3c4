"""Repairs of a height map from a file, each with a remark: stray parts, holes, spikes, ledges."""

import numpy as np

from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import Message

from .._kernels.covering_discs import local_width
from .._kernels.regions import carried_on, distance_to, grow_mask, pieces, rim, without_holes

LARGEST_HOLE = 1e-4
"""A hole of more area is an opening of the sole, not a gap of the scan, m^2."""
SMALLEST_PART = 0.02
"""A part of less of the whole area lies there by accident."""
SPIKE_HEIGHT = 1e-3
"""A single low cell stands out by at least this, m."""
_SPIKE_CELLS = 3
_WALL = 2.0  # rise over run: steeper is a wall
_FAR_SIDE = 1.5e-3  # m above the next two cells
_LEDGE = 1e-3  # m above what lies beside it
_WIDEST_LEDGE = 12e-3  # m
_BESIDE = 2e-3  # m from its edge
_ALONG = 0.35  # of the sides of a ledge: along the rim
_MOST_LEDGE = 0.4  # of the plan form: more is no ledge


def clean_height_map(height: Array, spacing: float) -> tuple[Array, list[Message]]:
    """Return the height map without stray parts, small holes and spikes, and a remark for each."""
    remarks: list[Message] = []
    height, new = _without_stray_parts(height, spacing)
    remarks += new
    height, new = _without_holes(height, spacing)
    remarks += new
    height, new = _without_spikes(height)
    return height, remarks + new


def _without_stray_parts(height: Array, spacing: float) -> tuple[Array, list[Message]]:
    inside = np.isfinite(height)
    parts, count = pieces(inside, diagonal=True)
    if count <= 1:
        return height, []
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    # many parts alike are no accident
    keep = (sizes >= min(SMALLEST_PART * sizes.sum(), sizes.max() / 2)) & (sizes > 0)
    gone = int(count - np.count_nonzero(keep))
    area = float(sizes[~keep].sum()) * spacing**2 * 1e6
    height = np.where(keep[parts], height, np.nan)
    remarks = []
    if gone:
        remarks.append(
            Message(
                "{count} separate {count:piece|pieces} of {area:.3g} mm² beside the sole left out.",
                count=gone,
                area=area,
            )
        )
    if np.count_nonzero(keep) > 1:
        remarks.append(
            Message("The sole has {count} separate parts.", count=np.count_nonzero(keep))
        )
    return height, remarks


def _without_holes(height: Array, spacing: float) -> tuple[Array, list[Message]]:
    inside = np.isfinite(height)
    holes = without_holes(inside) & ~inside
    if not holes.any():
        return height, []
    numbers, count = pieces(holes)
    sizes = np.bincount(numbers.ravel()) * spacing**2
    small = sizes <= LARGEST_HOLE
    small[0] = False
    fill = small[numbers]
    remarks = []
    if fill.any():
        bridged = carried_on(np.where(fill, 0.0, height), inside)
        height = np.where(fill, bridged, height)
        area = float(sizes[small].sum()) * 1e6
        many = int(np.count_nonzero(small))
        remarks.append(
            Message(
                "{count} hole{count:|s} of {area:.3g} mm² in all filled from the surface around.",
                count=many,
                area=area,
            )
        )
    large = int(count - np.count_nonzero(small))
    if large:
        area = float(sizes[1:][~small[1:]].sum()) * 1e6
        remarks.append(
            Message(
                "{count} hole{count:|s} larger than 100 mm² ({area:.3g} mm² in "
                "all) kept as openings of the sole.",
                count=large,
                area=area,
            )
        )
    return height, remarks


def _without_spikes(height: Array) -> tuple[Array, list[Message]]:
    from scipy.ndimage import grey_closing

    inside = np.isfinite(height)
    # a lug's thin end at the rim is narrow one way only, and beside the rim nothing is known
    filled = np.where(inside, height, np.inf)
    closed = np.minimum(
        grey_closing(filled, (_SPIKE_CELLS, 1)), grey_closing(filled, (1, _SPIKE_CELLS))
    )
    known = inside & ~rim(inside, 2) & np.isfinite(closed)
    spikes = np.zeros_like(inside)
    spikes[known] = closed[known] - height[known] > SPIKE_HEIGHT
    if not spikes.any():
        return height, []
    count = int(np.count_nonzero(spikes))
    return np.where(spikes, closed, height), [
        Message(
            "{count} cell{count:|s} that stood out by more than 1 mm (narrower "
            "than {cells} cells) levelled as spikes of the scan.",
            count=count,
            cells=_SPIKE_CELLS,
        )
    ]


def without_ledges(
    height: Array, land: Mask, base: Array, spacing: float, channel_depth: float
) -> tuple[Array, Mask, list[Message]]:
    """Return the height map without ledges along the rim, which of them are channels, and remarks.

    A ledge is land at the rim that stands more than 1 mm over what lies beside it: it never meets
    the floor. At the depth of the channels (``channel_depth``, m; 20 % more at most) it is a
    channel that the rim cuts open; higher it is a side wall, a welt or a midsole that overhangs,
    which counted as plan form would spoil land ratio and widths. So is what lies deeper than the
    channels, along the rim and narrower than 12 mm.

    Parameters:
        land, base: Of the tread: what meets the floor, and the height (m) that its depth is from.
    """
    from scipy.ndimage import find_objects, maximum_filter, minimum_filter

    inside = np.isfinite(height)
    # over the last cells of the rim a body may show nothing but its far side
    sliver = np.zeros_like(inside)
    for part, step in ((land, _FAR_SIDE), (inside, max(_FAR_SIDE, 1.2 * channel_depth))):
        lowest = minimum_filter(np.where(part, height, np.inf), 5)
        last = rim(inside, 2) & part
        sliver[last] |= height[last] - lowest[last] > step
    height = np.where(sliver, np.nan, height)
    inside, land = inside & ~sliver, land & ~sliver
    high = maximum_filter(np.where(inside, height, -np.inf), 3)
    low = minimum_filter(np.where(inside, height, np.inf), 3)
    even = land & (high - low <= max(_WALL * spacing, 0.3e-3))
    numbers, _ = pieces(even)
    at_rim = np.setdiff1d(numbers[rim(inside, 3)], [0])
    reach = max(2, round(_BESIDE / spacing))
    gone, cut_open = np.zeros_like(inside), np.zeros_like(inside)
    boxes = find_objects(numbers)
    for number in at_rim:
        box = boxes[number - 1]
        around = tuple(slice(max(s.start - reach, 0), s.stop + reach) for s in box)
        piece = numbers[around] == number
        beside = grow_mask(piece, reach) & inside[around] & ~piece
        if not beside.any():
            continue
        heights = height[around]
        level = float(np.median(heights[piece]))
        other = float(np.percentile(heights[beside], 25))  # some of it is the ledge itself
        if level - other > _LEDGE:
            into = cut_open if level - other <= 1.2 * channel_depth else gone
            into[around] |= piece | (beside & (heights > (level + other) / 2))
    with np.errstate(invalid="ignore"):
        high_up = inside & ~land & (height - base > 1.2 * channel_depth + _LEDGE)
    high_up &= local_width(high_up, spacing) < _WIDEST_LEDGE
    numbers, _ = pieces(high_up)
    # along a ledge is as much rim as tread; channels that open at the rim have lugs on both sides
    count = int(numbers.max()) + 1
    open_sides = np.bincount(numbers[rim(inside, 1)], minlength=count)
    walls = np.bincount(numbers[distance_to(land) <= 1.0], minlength=count)
    ledge = (open_sides > _ALONG * (open_sides + walls)) & (open_sides > 0)
    ledge[0] = False
    gone |= ledge[numbers]
    share = np.count_nonzero(gone) / np.count_nonzero(inside)
    cut_open &= land & ~gone
    if share == 0 or share > _MOST_LEDGE:
        return height, cut_open, []
    area = np.count_nonzero(gone) * spacing**2 * 1e6
    return (
        np.where(gone, np.nan, height),
        cut_open,
        [
            Message(
                "A ledge along the rim, more than 1 mm above the sole beside it "
                "({area:.3g} mm²), was left out of the plan form: it never meets "
                "the floor.",
                area=area,
            )
        ],
    )


def plan_outline(inside: Mask, x: Array, y: Array, spacing: float) -> Array:
    """Return the closed polygon (n, 2) around the rows of a plan form, anticlockwise, m."""
    rows = np.nonzero(inside.any(axis=1))[0]
    first = np.argmax(inside[rows], axis=1)
    last = inside.shape[1] - 1 - np.argmax(inside[rows][:, ::-1], axis=1)
    ends = np.concatenate([[x[rows[0]] - spacing / 2], x[rows], [x[rows[-1]] + spacing / 2]])
    first, last = (np.concatenate([[n[0]], n, [n[-1]]]) for n in (first, last))
    right = np.column_stack([ends, y[first] - spacing / 2])
    left = np.column_stack([ends, y[last] + spacing / 2])
    return np.concatenate([right, left[::-1], right[:1]])
