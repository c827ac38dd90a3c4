"""How far the mean over a few positions of a tread lies from that over many.

``python -m benchmarks.tread_places [--run-grid]``: bars in glycerol at 48 even positions along
their period; means over 4, 6, 8 and 12 of them, begun at each place; blocks, of two periods, at 12
random origins of the rule of a run. Then the shoe turned by one standard deviation of its angle:
the two steps that a run makes against the march. The quick grid takes five minutes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from benchmarks.tread_widths import bars
from underfoot import Case
from underfoot.compute.position_draws import TreadPlace
from underfoot.compute.positions import TURNED, place_numbers, places
from underfoot.compute.prepare import Prepared, prepare_case
from underfoot.compute.sole import tread_on_sole
from underfoot.compute.solve import continue_contact, solved_at
from underfoot.core import ConvergenceError
from underfoot.core.arrays import Array

BARS = ((6.0, 4.0), (5.0, 3.0), (8.0, 4.0), (4.0, 6.0))
"""Widths of lugs and channels, mm."""
BLOCKS = {
    "pattern": "grid",
    "depth": "3 mm",
    "lug_width": "6 mm",
    "channel_width": "4 mm",
}
EVEN, COUNTS, ORIGINS = 48, (4, 6, 8, 12), 12


def film_loads(parts: Prepared, at: Sequence[tuple[float, float]]) -> Array:
    """Return the load on the film at shifts of the tread, N; nan where none converged."""
    loads = []
    for shift in at:
        try:
            here, contact = solved_at(parts, TreadPlace(shift), parts.spacing)
            usable = contact.status.usable
            loads.append(place_numbers(here, contact)["fluid_load"] if usable else math.nan)
        except ConvergenceError:
            loads.append(math.nan)
    return np.array(loads)


def rows(parts: Prepared, name: str) -> None:
    """Print the errors of means over a few positions of bars."""
    (period,) = tread_on_sole(parts.case)[0]
    loads = film_loads(parts, [tuple(period * k / EVEN) for k in range(EVEN)])
    mean, spread = np.nanmean(loads), np.nanstd(loads)
    for count in COUNTS:
        means = np.nanmean(loads.reshape(count, EVEN // count), axis=0)
        off = np.sqrt(np.mean((means - mean) ** 2))
        print(
            f"{name:<22}{mean:>8.1f}{spread:>8.1f}{count:>6}{off:>8.2f}{off / mean:>8.1%}"
            f"{spread / count:>8.2f}{spread / math.sqrt(count):>8.2f}",
            flush=True,
        )


def of_blocks(parts: Prepared) -> None:
    """Print the errors of means over positions of blocks, by the rule of a run."""
    periods, rng = tread_on_sole(parts.case)[0], np.random.default_rng(0)
    count = 6
    shifts = np.array([place.shift for place in places(periods, count)])
    origins = rng.random((ORIGINS, 2)) @ periods
    loads = np.array([film_loads(parts, [tuple(s) for s in shifts + o]) for o in origins])
    mean, spread = np.nanmean(loads), np.nanstd(loads)
    off = np.nanstd(np.nanmean(loads, axis=1), ddof=1)
    print(
        f"{'blocks 6, 4 mm':<22}{mean:>8.1f}{spread:>8.1f}{count:>6}{off:>8.2f}{off / mean:>8.1%}"
        f"{spread / count**0.75:>8.2f}{spread / math.sqrt(count):>8.2f}",
        flush=True,
    )


def of_turned(parts: Prepared, name: str) -> None:
    """Print what turning the shoe does to the film, in two steps and in the march."""
    (period,) = tread_on_sole(parts.case)[0]
    for share in (0.0, 1 / 3, 2 / 3):
        shift = tuple(period * share)
        here, contact = solved_at(parts, TreadPlace(shift), parts.spacing)
        for turned in TURNED:
            (end,) = continue_contact(contact, here, turn=turned.turn)[-1:]
            _, march = solved_at(parts, TreadPlace(shift, turned.turn), parts.spacing)
            print(
                f"{name:<22}{share:>8.2f}{math.degrees(turned.turn):>+8.2f}"
                f"{contact.fluid_load:>8.1f}{end.fluid_load:>8.1f}{march.fluid_load:>8.1f}",
                flush=True,
            )


def main(arguments: Sequence[str] = ()) -> None:
    """Print the tables, on the quick grid or that of a run."""
    treads = {
        f"bars {lug:g}, {channel:g} mm": bars(
            {
                "shoe.tread.lug_width": f"{lug} mm",
                "shoe.tread.channel_width": f"{channel} mm",
            }
        )
        for lug, channel in BARS
    }

    def ready(case: Case) -> Prepared:
        numerics = case.numerics
        fine = "--run-grid" in arguments
        return prepare_case(case, numerics.grid_spacing if fine else numerics.quick_grid_spacing)

    print(f"{'':<22}{'film N':>8}{'s N':>8}{'n':>6}{'rms N':>8}{'':>8}{'rule N':>8}{'s/√n':>8}")
    for name, case in treads.items():
        rows(ready(case), name)
    of_blocks(ready(bars({}).replace("shoe.tread", BLOCKS)))
    print(f"\n{'':<22}{'place':>8}{'deg':>8}{'film N':>8}{'steps':>8}{'march':>8}")
    for name, case in treads.items():
        of_turned(ready(case), name)


if __name__ == "__main__":
    import sys

    main(sys.argv[1:])
