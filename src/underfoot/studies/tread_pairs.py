"""Published pairs of treads beside what is computed of them: what the error of the tread model is
learned from (``underfoot.friction.tread_error``).

    python -m underfoot.studies.tread_pairs src/underfoot/data/friction/tread_pairs.csv
"""

import csv
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.stats import norm

from underfoot.case import Case
from underfoot.compute.contact_friction import place_of_tread
from underfoot.compute.resolve import resolve_context
from underfoot.compute.run import run
from underfoot.compute.sole import sole_map
from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.friction.tread_error import TreadPair, fluid_class, tread_error

from .corpus_cases import Contrast, Stand, contrasts, whole_shoe_stands
from .sources import corpus

TREAD = {"groove direction", "depth", "tread area", "edge radius", "wear"}
"""What an effect of the tread alone is about."""
FITTED = ("blanchette_2015", "report_g6")
"""Sources that the two states under a lug were fitted to (``lug_states``): a tread in water that
grips four times another's, where wiping is most seen, and two outsoles in 50 % glycerol, where the
pair is known. Both named before the fit."""


def tread_contrasts() -> list[Contrast]:
    """Return the published effects of treads that can be computed."""
    every = (contrast for source in corpus() if source.verified for contrast in contrasts(source))
    return [
        contrast
        for contrast in every
        if set(contrast.topic.split(", ")) <= TREAD and not contrast.reason
    ]


def cof_and_draws(case: Case) -> Array:
    """Return COF of a case on the quick grid, and its draws (1 + draws,)."""
    result = run(case, quick=True)
    return np.append(result.value("cof"), result.data["cof_draws"].values)


def computed_pairs(of_case: Callable[[Case], Array] = cof_and_draws) -> Iterator[TreadPair]:
    """Yield each published pair with its computed ln ratio, from ``of_case``.

    Then each reading of a treaded shoe beside the COF computed of it, as the ratio to a sole
    without tread that is known: the second place is 0. The extremes of many treads count as a pair
    alone, means over several fluids do not count. Its spread is without the error of the tread
    model itself: of contact law, film and suction. Sources that the two states of lugs were fitted
    to are computed with one: a fit makes no error smaller.
    """
    for contrast in tread_contrasts():
        stands = (_without_fit(stand, contrast.source) for stand in (contrast.over, contrast.under))
        over, under = (_draw_cof(stand, of_case) for stand in stands)
        ends = _published_bounds(contrast, under[0])
        second = _place(contrast.under.cases[0])
        names, case = (contrast.source, contrast.effect), contrast.over.cases[0]
        yield _pair(*names, case, ends, over / under, second, contrast.extremes_of)
    paired = {contrast.source for contrast in tread_contrasts()}
    for source in corpus():
        shoes = whole_shoe_stands(source) if source.verified and source.name not in paired else []
        for condition, stand in shoes:
            if not condition.members and not stand.reason:
                names, reading = (source.name, condition.id), condition.reading
                with np.errstate(divide="ignore"):
                    ends = tuple(np.log((reading.low, reading.high)))
                try:
                    drawn = _draw_cof(_without_fit(stand, source.name), of_case)
                except DataError as error:  # a march without an answer
                    print(f"left out: {source.name} {condition.id}: {error}", file=sys.stderr)
                    continue
                yield _pair(*names, stand.cases[0], ends, drawn, np.zeros(6))


def _without_fit(stand: Stand, source: str) -> Stand:
    if source not in FITTED:
        return stand
    return replace(stand, cases=tuple(case.replace("film.dewetting", 0.0) for case in stand.cases))


def _pair(
    source: str,
    effect: str,
    case: Case,
    ends: tuple[float, ...],
    drawn: Array,
    second: Array,
    extremes_of: int = 2,
) -> TreadPair:
    """Return a pair from the case of its first tread and the ratio computed and drawn."""
    fluid = fluid_class(resolve_context(case).viscosity_value)
    # by quantiles: draws that the law bounds hold less of the error than was taken off
    spread = np.ptp(np.quantile(np.log(drawn[1:]), norm.cdf([-1, 1]))) / 2
    low, high, ratio = map(float, (*ends, np.log(drawn[0])))
    first, sd = _place(case), float(spread)
    return TreadPair(source, effect, fluid, low, high, ratio, sd, first, second, extremes_of)


def _draw_cof(stand: Stand, of_case: Callable[[Case], Array]) -> Array:
    """Return COF of what stands for a condition, and its draws (1 + draws,)."""
    rows = []
    for case in stand.cases:
        (cof, *draws), error = of_case(case), tread_error(resolve_context(case).viscosity_value)
        off = error.draws(_place(case), samples=len(draws), seed=case.numerics.seed)
        rows.append(np.append(cof, draws * np.exp(-off)))
    return np.mean(rows, axis=0) * stand.contact_time


def _place(case: Case) -> Array:
    return place_of_tread(case, sole_map(case, case.numerics.quick_grid_spacing))


def _published_bounds(contrast: Contrast, cof: float) -> tuple[float, float]:
    """Return the bounds of the published ln ratio; a slope is over the computed COF."""
    ends = np.array([contrast.low, contrast.high])
    if np.isnan(contrast.low):
        return (0.0, np.inf) if contrast.rises else (-np.inf, 0.0)
    ratios = ends if np.isnan(contrast.step) else 1 + ends * contrast.step / cof
    low, high = np.log(ratios)
    return float(low), float(high)


def write(path: Path) -> None:
    """Write the pairs as CSV."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(TreadPair.__dataclass_fields__)
        for pair in computed_pairs():
            places = (" ".join(f"{x:.4f}" for x in each) for each in (pair.first, pair.second))
            numbers = (f"{x:.5g}" for x in (pair.low, pair.high, pair.computed, pair.sd))
            words = (pair.source, pair.effect, pair.fluid)
            table.writerow((*words, *numbers, *places, pair.extremes_of))


if __name__ == "__main__":
    write(Path(sys.argv[1]))
