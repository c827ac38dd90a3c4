"""How the fluid gets out from under each lug, and to which side a groove in it helps most.

A groove changes the fluid pressure by d, at the gap h as solved:

    div(h^3 grad d) = 0,  d = -p in the groove,  d = 0 in channels

and relieves the lug by -sum(d) of its film, d no lower than -p. Of straight grooves from the peak
of the pressure to the four sides the one counts that relieves most, or the shortest of those that
relieve nearly as much. Load and approach are left as they are.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask
from underfoot.core.presentation import percent, quantity_text
from underfoot.core.remark import NOTHING, Message
from underfoot.core.sparse import factorization

from ._kernels.regions import Labels, draining, pieces
from .geometry import SoleMap

OPEN = 0.1
"""Of the highest fluid pressure: a channel under more is backed up and lets nothing out."""
MATTERS = 0.05
"""Share of the load on the film from which a lug is named."""
GROOVE, NEARLY = 2e-3, 0.9
"""Width of the grooves compared (m; an odd number of cells, no wider), and the share of the largest
relief from which the shorter groove is taken."""
MIDDLE = 1e-3
"""m: a place nearer to the middle line is said to lie on it."""
TOP = 0.99
"""Of a lug's highest fluid pressure: it peaks in the middle of what bears more."""
SIDES = ("front", "rear", "left", "right")
"""Left and right as seen from above, looking forward."""
TO_SIDES = (
    Message("to the front"),
    Message("to the rear"),
    Message("to the left"),
    Message("to the right"),
)
"""Where fluid goes, by the number in ``SIDES``."""


@dataclass(frozen=True, slots=True)
class LugDrainage:
    """Film on the lugs of a sole, the most loaded first; arrays (lugs,), m and N.

    Attributes:
        load, share: On the film under the lug, and of that under the whole sole.
        x, y: Where the fluid pressure under it peaks: from the rear end, and to the left.
        way: From there straight to the nearest open place: a channel that channels join to the rim
            and whose own fluid pressure is below a tenth of the highest, or the rim itself.
        side: Number in ``SIDES`` of the side that this way mostly leads to.
        height: Of the lug, 0 where untreaded.
        groove, groove_side, relief: Length and side of the groove that relieves most, and the share
            of the lug's film that it relieves; nan and -1 where the lug bears less than 5 % of all.
    """

    load: Array
    share: Array
    x: Array
    y: Array
    way: Array
    side: NDArray[np.intp]
    height: Array
    groove: Array
    groove_side: NDArray[np.intp]
    relief: Array

    def advice(self) -> Message:
        """Return which lug drains worst and to which side to open it; empty where all bear little.

        Parts more slender than high bend over: where the way is no longer than the lug is high, no
        cut is advised.
        """
        if self.share[0] < MATTERS:
            return NOTHING
        way = self.way[0]
        advice = Message("no longer than the lug is high, leave it")
        if way > self.height[0]:
            groove = quantity_text(self.groove[0], "m")
            advice = Message(
                "open it {to}, a groove of {groove} relieves most",
                to=TO_SIDES[self.groove_side[0]], groove=groove,
            )  # fmt: skip
        return Message(
            "the lug {x} from the rear, {y}, carries {load} of film, {share} of {every}; its fluid "
            "has {way} to go {to}: {advice}",
            x=quantity_text(self.x[0], "m"), y=across_text(self.y[0]),
            load=quantity_text(self.load[0], "N"), share=percent(self.share[0]),
            every=quantity_text(self.load[0] / self.share[0], "N"), way=quantity_text(way, "m"),
            to=TO_SIDES[self.side[0]], advice=advice,
        )  # fmt: skip

    def fields(self) -> dict[str, tuple[str, Any, dict[str, str]]]:
        """Return the variables of a data set."""
        titles = {
            "load": ("N", "load on the film under the lug"),
            "share": ("1", "share of the load on the film"),
            "x": ("m", "peak of the fluid pressure under the lug, from the rear end"),
            "y": ("m", "peak of the fluid pressure under the lug, to the left"),
            "way": ("m", "from there to the nearest open channel or rim"),
            "side": ("1", "side of that way: front 0, rear 1, left 2, right 3"),
            "height": ("m", "height of the lug"),
            "groove": ("m", "length of the groove from the peak that relieves most"),
            "groove_side": ("1", "side of that groove, as in lug_side; -1 not sought"),
            "relief": ("1", "share of the lug's film that it relieves at the gap as solved"),
        }
        return {
            f"lug_{name}": ("lug", getattr(self, name), {"units": unit, "long_name": text})
            for name, (unit, text) in titles.items()
        }


def across_text(y: float) -> Message:
    """Return how far to the left (y, m) a place lies."""
    if abs(y) < MIDDLE:
        return Message("in the middle")
    return Message("{way} {to}", way=quantity_text(abs(y), "m"), to=TO_SIDES[2 if y >= 0 else 3])


def lug_drainage(sole: SoleMap, fluid_pressure: Array, film_thickness: Array) -> LugDrainage | None:
    """Return how the lugs of a sole drain; None without channels or without a film on land.

    A lug is a connected piece of land; untreaded land counts as one where the sole has channels.

    Args:
        sole: Map; its rim is open.
        fluid_pressure: (nx, ny) as solved, Pa, 0 or more.
        film_thickness: (nx, ny) as solved, m.
    """
    from scipy.ndimage import maximum

    pressure = np.where(sole.land, fluid_pressure, 0.0)
    if sole.land.sum() == sole.inside.sum() or not pressure.any():
        return None
    numbers, count = pieces(sole.land)
    area = np.ones(pressure.shape) if sole.cut is None else sole.cut.film_area
    sums = np.bincount(numbers.ravel(), (pressure * area).ravel(), count + 1).astype(np.float64)
    order = np.argsort(-sums, kind="stable")
    order = order[sums[order] > 0]
    highest = np.zeros(count + 1)
    highest[order] = maximum(pressure, numbers, order)
    top = (pressure > 0) & (pressure >= TOP * highest[numbers])
    peaks = np.array([_middle(np.argwhere(top & (numbers == number)), sole.y) for number in order])
    clear = draining(sole.inside, sole.inside & ~sole.land) & (
        fluid_pressure < OPEN * pressure.max()
    )
    wide = max(GROOVE / sole.spacing, 1.0)
    # beyond the array lies the rim, too
    goals = np.argwhere(np.pad(~sole.inside | clear, 1, constant_values=True)) - 1
    ways = [_way_out(goals - peak, float(sole.y[peak[1]])) for peak in peaks]
    i, j = peaks.T
    share = sums[order] / float((fluid_pressure * area).sum())
    film = sums, pressure, film_thickness**3, area
    named = order[share >= MATTERS]
    grooves = _best_grooves(numbers, named, peaks, ~sole.inside | clear, film, wide, sole.y)
    grooves += [(np.nan, -1, np.nan)] * (len(order) - len(grooves))
    return LugDrainage(
        load=sums[order] * sole.spacing**2,
        share=share,
        x=sole.x[i],
        y=sole.y[j],
        # to the edge between the last closed centre and the first open one
        way=np.array([(cells - 0.5) * sole.spacing for cells, _ in ways]),
        side=np.array([side for _, side in ways]),
        height=np.asarray(maximum(sole.tread_depth, numbers, order)),
        groove=np.array([(cells - 0.5) * sole.spacing for cells, _, _ in grooves]),
        groove_side=np.array([side for _, side, _ in grooves]),
        relief=np.array([relief for _, _, relief in grooves]),
    )


def _middle(cells: NDArray[np.intp], y: Array) -> NDArray[np.intp]:
    """Return the cell, of ``cells`` (n, 2), that is nearest to their centroid.

    A tie goes to the cell farthest from the middle line: mirrored lugs have mirrored peaks.
    """
    away = np.hypot(*(cells - cells.mean(axis=0)).T)
    return cells[np.lexsort((-np.abs(y[cells[:, 1]]), away.round(6)))[0]]


def _way_out(offsets: NDArray[np.intp], y: float) -> tuple[float, int]:
    """Return length (cells) and side of the shortest of the ways to ``offsets`` (n, 2), cells.

    Of ways equal within half a cell: the first of ``_preferred``.
    """
    length = np.hypot(*offsets.T)
    shortest = float(length.min())
    along, across = offsets[length <= shortest + 0.5].T
    lengthwise = np.abs(along) >= np.abs(across)
    sides = np.where(lengthwise, np.where(along > 0, 0, 1), np.where(across > 0, 2, 3))
    return shortest, next(side for side in _side_order(y) if side in sides)


def _side_order(y: float) -> tuple[int, ...]:
    """Return the sides in the order in which equal ways are taken from a place at ``y`` (m).

    Along the shoe, to the front, then away from the middle line: mirrored lugs get mirrored advice.
    """
    return (0, 1, 2, 3) if y > -MIDDLE else (0, 1, 3, 2)


def _best_grooves(
    numbers: Labels,
    lugs: NDArray[np.intp],
    peaks: NDArray[np.intp],
    open_: Mask,
    film: tuple[Array, Array, Array, Array],
    wide: float,
    y: Array,
) -> list[tuple[float, int, float]]:
    """Return length (cells), side and relief of the groove that each of ``lugs`` should have.

    ``film``: load by number, and pressure, conductance and area of the cells. Of grooves equal
    within a cell (a peak between two cells lies in one): that of ``_preferred``.
    """
    load, pressure, conductance, area = film
    full = np.isin(numbers, lugs) & (pressure > 0)
    rows, columns = np.ogrid[: open_.shape[0], : open_.shape[1]]
    lengths, reliefs = np.zeros((2, len(SIDES), len(lugs)))
    for side in range(len(SIDES)):
        cut = np.zeros(open_.shape, dtype=np.bool_)
        for k, (number, (i, j)) in enumerate(zip(lugs, peaks, strict=False)):
            along, across = rows - i, columns - j
            line = (open_[i + 1 :, j], open_[:i, j][::-1], open_[i, j + 1 :], open_[i, :j][::-1])
            lengths[side, k] = np.append(line[side], True).argmax() + 1
            forward, aside = (along, -along, across, -across)[side], (across, along)[side // 2]
            within = (forward > -wide / 2) & (forward < lengths[side, k])
            cut |= within & (np.abs(aside) < wide / 2) & (numbers == number)
        # lugs don't touch: one system holds them all
        fallen = _pressure_fall(full & ~cut, cut, pressure, conductance)
        relieved = np.bincount(numbers.ravel(), (fallen * area).ravel(), load.size)
        reliefs[side] = relieved[lugs] / load[lugs]
    grooves = []
    for length, relief, place in zip(lengths.T, reliefs.T, y[peaks[:, 1]], strict=False):
        best = relief >= NEARLY * relief.max()
        best &= length <= length[best].min() + 1
        side = next(side for side in _side_order(float(place)) if best[side])
        grooves.append((float(length[side]), side, float(relief[side])))
    return grooves


def _pressure_fall(free: Mask, groove: Mask, pressure: Array, conductance: Array) -> Array:
    """Return -d (nx, ny), 0 beyond the free cells and the groove."""
    from scipy.sparse import csr_matrix

    drops = np.where(groove, pressure, 0.0)
    if not free.any():
        return drops
    cells = np.argwhere(free)
    number = np.full(np.array(free.shape) + 2, -1)
    number[1:-1, 1:-1][free] = np.arange(len(cells))
    flows, drop = np.pad(conductance, 1, mode="edge"), np.pad(drops, 1)
    scale = float(conductance[free].mean())
    diagonal, right = np.zeros(len(cells)), np.zeros(len(cells))
    rows, columns, values = [], [], []
    for step in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        here, there = tuple((cells + 1).T), tuple((cells + 1 + step).T)
        flow = 0.5 * (flows[here] + flows[there]) / scale
        beside = number[there] >= 0
        diagonal += flow
        right += flow * drop[there]
        rows.append(np.flatnonzero(beside))
        columns.append(number[there][beside])
        values.append(-flow[beside])
    rows.append(np.arange(len(cells)))
    columns.append(np.arange(len(cells)))
    values.append(diagonal)
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    matrix = csr_matrix(entries, shape=(len(cells), len(cells)))
    matrix.sort_indices()
    fallen = factorization(matrix, kind="positive definite", where="grooves").solve(right)
    drops[free] = np.minimum(fallen, pressure[free])
    return drops
