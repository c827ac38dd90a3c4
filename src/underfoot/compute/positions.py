"""A tread, not one position of it: the answer averaged over where its lugs happen to lie."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from underfoot.case import Case
from underfoot.core.arrays import Array
from underfoot.shoe import Tread
from underfoot.sole_contact.cost import Cost
from underfoot.sole_contact.solver import SoleContact

from .contact_friction import friction_sums
from .cost import cost
from .numbers import scalars
from .position_draws import (
    ANGLE_BAND,
    ANGLE_DEVIATION,
    COF_PARTS,
    LOADS,
    ON_CONTACT,
    ShoeAngles,
    TreadPlace,
    TreadPositions,
    UncertainBevel,
    log_film_odds,
)
from .prepare import Prepared
from .sensors import scan_reading
from .sole import bottom_surface, file_surface, landing_front, tread_on_sole
from .steadiness import later_numbers

FURTHER = 1.5
"""Standard deviations of a heel's bevel to which its film is solved: films hardly change beyond."""
YAW = math.radians(1)
"""Angle of a tread against the corner of its heel, to either side, rad; assumed: neither a mould,
a grinder nor wear holds it better. No standard says it."""
ACROSS = 6.0
"""How much less a wave of the places across the shoe matters than one along it: lugs side by side
have all its phases."""
HANDED = 0.02
"""Share of a tread's walls that leans to one side more than to the other, from which it tells a
tread from its mirror image."""
FINEST = 0.25e-3
"""Cells that numbers under lugs are carried on to, m: the finest they were compared with."""
CLOSEST = 1.25
"""Cells of two grids, coarser over finer, from which their difference says how far both are off."""
USUAL_STEP = 2 / 3
"""(coarser - finer) / finer of the grids of a case as they are by default."""
WITHOUT_LUGS = 5.0
"""How many times as long a sole without lugs takes: on the report's four, five times as many cells
are wet as on its eight with lugs."""
FINER_MARCH = 1.5
"""How many times as long a march with twice the steps in time takes."""
RATES = {1: 1.0, 2: 0.75}
"""Rate of the rule of positions by the number of periods of the tread, where the film jumps with
the place (docs/physics/coupled_contact.md)."""


def further_angles(case: Case) -> tuple[TreadPlace, ...]:
    """Return the angles beyond ``shoe_angles`` that the interval of a case without lugs needs.

    One to each side, as far as the angle of its bevel may go; none where that counts as exact.
    """
    bevel = None if has_lugs(case) else UncertainBevel.of(case)
    if bevel is None:
        return ()
    return TreadPlace(turn=FURTHER * bevel.deviation), TreadPlace(turn=-FURTHER * bevel.deviation)


def shoe_angles() -> tuple[TreadPlace, ...]:
    """Return the case's own shoe angle and one on each side, of the variance of ``ANGLE_BAND``."""
    turn = ANGLE_BAND / math.sqrt(2)
    return TreadPlace(), TreadPlace(turn=turn), TreadPlace(turn=-turn)


TURNED = (TreadPlace(turn=ANGLE_DEVIATION), TreadPlace(turn=-ANGLE_DEVIATION))
"""The shoe turned toe up and toe down, the tread as it lies."""


def places(periods: Array, count: int, begin: Array | None = None) -> tuple[TreadPlace, ...]:
    """Return ``count`` places of a pattern with the periods (n, 2), m.

    The first at ``begin``, shares (n,) of the periods; at rest without. Even along the first period
    and along a second, on the lattice whose shortest wave that it can't tell from none is
    longest; one across the shoe counts ``ACROSS`` times its length. All at the shoe angle of the
    case: the film under bars is a saw-tooth along their period whose teeth the angle moves, and
    positions that have other angles leave a larger error of its mean.
    """
    periods, at = np.asarray(periods, dtype=float), np.arange(count)
    shares = np.column_stack([at, at * _step(periods, count)])[:, : len(periods)] / count
    shares = np.mod(shares + (0.0 if begin is None else begin), 1)
    return tuple(TreadPlace((float(x), float(y))) for x, y in shares @ periods)


def _step(periods: Array, count: int) -> int:
    """Return by how many parts of the second period a place lies beyond the one before it."""
    if len(periods) == 1 or count == 1:
        return 1
    waves = np.array([h for h in product(range(-count, count + 1), repeat=2) if any(h)])
    along, across = np.linalg.pinv(periods) @ waves.T
    length = np.round(np.hypot(along, ACROSS * across) * np.abs(periods).max(), 6)
    met = [length[waves @ (1, step) % count == 0].min() for step in range(1, count)]
    return 1 + int(np.argmax(met))


def case_places(case: Case, *, quick: bool) -> tuple[TreadPlace, ...]:
    """Return the places of a run of a treaded sole.

    The pattern begins at the front of what lands first, where the teeth of its film lie: so all
    treads meet them in nearly one phase, wherever they were drawn and however wide their lugs are.
    There it is turned by ``YAW``, to either side alike: lugs that meet a
    corner of the heel all at once are a tooth of the film that no real sole has. A mirrored sole
    has the mirrored places.
    """
    periods, begin = tread_on_sole(case)[:2]
    hand = _hand(case)
    mirror = np.array([1, hand])
    origin = (np.array([landing_front(case), 0.0]) - begin @ periods) * mirror
    ahead = _reduce_periods(periods * mirror)
    lie = places(ahead, position_count(case, quick=quick), origin @ np.linalg.pinv(ahead))
    signs = (1, -1, -1, 1)
    return tuple(
        TreadPlace((place.shift[0], hand * place.shift[1]), yaw=hand * signs[k % 4] * YAW)
        for k, place in enumerate(lie)
    )


def _reduce_periods(periods: Array) -> Array:
    """Return periods of the same pattern whose mirror images have the mirrored ones."""
    first, *more = (each * (1 if tuple(each[::way]) > (0, 0) else -1)
                    for each, way in zip(np.round(periods, 12), (1, -1), strict=False))  # fmt: skip
    return np.array(
        [
            first,
            *(each - math.floor(each @ first / (first @ first) + 1e-6) * first for each in more),
        ]
    )


def tread_positions(
    case: Case,
    known: Mapping[TreadPlace, Mapping[str, float]],
    at_places: Callable[
        [Sequence[tuple[TreadPlace, float]]], Iterator[tuple[int, Mapping[str, float] | None]]
    ],
    *,
    spacing: float,
    quick: bool,
) -> TreadPositions:
    """Return the numbers of a run at more positions of its tread, or shoe angles without a tread.

    All places are solved on the quick grid, every other one, of shoe angles the own, on the grid of
    the run too. The ratio of the means on both takes all to the grid of the run, and under lugs on
    to that of ``FINEST``, where numbers move by the first order of the cells (``carry_to_finer``).
    What the angle adds under a tread is half the difference of the shoe turned up and down, at the
    case's own position. A motion that ends is solved at the first place on the quick grid with
    twice the steps in time too.

    ``known`` are the numbers at the case's own place, and what is
    known of others, on the grid of the run, of ``spacing`` (m); ``at_places`` solves places,
    each on a grid (m), and gives the index of each with its numbers as they end, None where a
    contact did not converge.
    """
    lugs, own = has_lugs(case), known[TreadPlace()]
    all_places, on_run_grid, coarse = _places_on_grids(case, spacing, quick=quick)
    angles = TURNED * lugs
    asked = [(place, spacing) for place in (*on_run_grid, *angles) if place not in known]
    asked += [(place, coarse) for place in all_places if coarse != spacing]
    further = further_angles(case)
    asked += [(place, coarse) for place in further]
    both = [(place, coarse) for place in (all_places[0], replace(all_places[0], finer=2))]
    asked += both[1:] * remembers(case)
    ended = dict(at_places(asked))
    at = {(place, spacing): numbers for place, numbers in known.items()}
    at |= {one: numbers for k, one in enumerate(asked) if (numbers := ended[k]) is not None}
    pairs = [p for p in on_run_grid if (p, spacing) in at and (p, coarse) in at]
    if not pairs:  # nothing compares the grids
        pairs = [place for place in on_run_grid if (place, spacing) in at] or [TreadPlace()]
        coarse = spacing
    answers = {p: at[p, coarse] for p in all_places if (p, coarse) in at} or {TreadPlace(): own}
    failed = {*all_places} - {*answers} | {p for p in on_run_grid if (p, spacing) not in at}
    each = _arrays(own, answers.values())
    before, after = (_arrays(own, [at[p, h] for p in pairs]) for h in (coarse, spacing))
    compared = coarse > spacing
    onward = max(spacing - FINEST, 0.0) / (coarse - spacing) if lugs and compared else 0.0
    rate = RATES[len(tread_on_sole(case)[0])] if lugs else 1.0
    values, near = (carry_to_finer(each, before, after, order) for order in (onward, 0.0))
    # of a flat sole the first order of the cells, as the quick grid and that of a run tell it
    onto = 1 + onward if lugs else USUAL_STEP * spacing / (coarse - spacing) if compared else 0.0
    between = {}
    for name in own:
        apart = after[name] - before[name]
        scatter = float(np.std(apart, ddof=1)) if len(pairs) > 1 else abs(float(apart[0]))
        onward_part = float((values[name] - near[name]).mean())
        further_on = onto if name in (*LOADS, *COF_PARTS) or not lugs else 1.0
        between[name] = math.hypot(onward_part / 2, further_on * scatter / len(pairs) ** rate)
    between["cof"] = sum(between[name] for name in COF_PARTS)
    by_angle, by_film = {}, 0.0
    if lugs and all((place, spacing) in at for place in angles):
        up, down = (at[place, spacing] for place in angles)
        by_angle = {name: (up[name] - down[name]) / 2 for name in own}
        odds = [log_film_odds(*(one[load] for load in LOADS)) for one in (up, down)]
        by_film = float(odds[0] - odds[1]) / 2
    if not all((place, coarse) in at for place in further):
        further = ()
    beyond = carry_to_finer(_arrays(own, [at[p, coarse] for p in further]), before, after, onward)
    bevel_known = by_angle if lugs else further
    return (TreadPositions if lugs else ShoeAngles)(
        tuple(answers),
        values,
        len(failed),
        own,
        between=between,
        by_angle=by_angle,
        film_by_angle=by_film,
        bevel=UncertainBevel.of(case) if bevel_known else None,
        further={
            place.turn: {n: v[k] for n, v in beyond.items()} for k, place in enumerate(further)
        },
        uncompared=0.0 if compared else spacing,
        in_time=tuple(at[one] for one in both) if all(one in at for one in both) else (),
    )


def _arrays(names: Iterable[str], numbers: Iterable[Mapping[str, float]]) -> dict[str, Array]:
    listed = list(numbers)
    return {name: np.array([each[name] for each in listed]) for name in names}


def carry_to_finer(
    each: Mapping[str, Array], coarse: Mapping[str, Array], fine: Mapping[str, Array], onward: float
) -> dict[str, Array]:
    """Return numbers (n,) of a coarse grid on a finer one by name, by some of both (m,).

    The odds of the loads on film and contact move as those of their means do, and ``onward`` times
    as far again, and so does what a newton of the contact and the film have of friction; so contact
    and film bear the load at each place. Other numbers move as their means do. What grows with
    finer cells grows evenly, of what shrinks the inverse does.
    """

    def total(numbers: Mapping[str, Array], name: str) -> float:
        force = sum(numbers[load] for load in LOADS) if name in COF_PARTS else 1.0
        return float((numbers[name] * force).sum())

    def factor(name: str, over: str = "", order: float = 0.0) -> float:
        before, after = (total(numbers, name) for numbers in (coarse, fine))
        if over:
            before, after = before * total(fine, over), after * total(coarse, over)
        if not (before > 0 and after > 0):  # it is there on one grid alone, or on none
            return 1.0
        step = after / before
        return step + order * (step - 1) if step > 1 else step / (1 + order * (1 - step))

    film, contact = (each[load] for load in LOADS)
    more = film * factor(*LOADS, onward)
    onto = (film + contact) / (more + contact)
    result = {"fluid_load": more * onto, "contact_load": contact * onto}
    for name in each.keys() - {*LOADS, "cof"}:
        if name in ON_CONTACT:
            result[name] = each[name] * onto * factor(name, "contact_load", onward)
        else:
            result[name] = each[name] * factor(name, order=onward if name in COF_PARTS else 0.0)
    result["cof"] = np.sum([result[name] for name in COF_PARTS], axis=0)
    return {name: result[name] for name in each}


def _hand(case: Case) -> int:
    """Return 1, of the mirrored case -1: where the walls of a tread lean to, else its plan form."""
    surface = bottom_surface(case)
    land, inside = surface.land, surface.inside
    up, down = (
        np.count_nonzero((land[a] != land[b]) & inside[a] & inside[b])
        for a, b in ((np.s_[1:, 1:], np.s_[:-1, :-1]), (np.s_[1:, :-1], np.s_[:-1, 1:]))
    )
    lean = (up - down) / max(up + down, 1)
    if abs(lean) < HANDED:
        x, y = np.meshgrid(surface.x - surface.x.mean(), surface.y, indexing="ij")
        lean = float((x * y)[inside].sum() + 1e-3 * (x * y)[land].sum())
    return 1 if lean >= 0 else -1


def _places_on_grids(
    case: Case, spacing: float, *, quick: bool
) -> tuple[tuple[TreadPlace, ...], tuple[TreadPlace, ...], float]:
    """Return the places of a run, those that the grid of the run solves, and that of all, m."""
    coarse = case.numerics.quick_grid_spacing
    if has_lugs(case):
        all_places = case_places(case, quick=quick)
        if quick or coarse < CLOSEST * spacing:
            return all_places, all_places, spacing
        return all_places, all_places[::2], coarse
    if quick or coarse < CLOSEST * spacing:
        return shoe_angles(), shoe_angles(), spacing
    return shoe_angles(), shoe_angles()[:1], coarse


def position_count(case: Case, *, quick: bool) -> int:
    """Return at how many positions of its tread, or shoe angles, a run is solved.

    On the quick grid half as many positions.
    """
    count = case.numerics.tread_positions
    if count == 1:
        return 1
    if not has_lugs(case):
        return len(shoe_angles())
    return math.ceil(count / 2) if quick else count


def has_lugs(case: Case) -> bool:
    """Return whether the sole of a case has lugs."""
    if case.shoe.outsole is None:
        return _tread(case) is not None
    return float(file_surface(case).tread_depth.max()) > 0


def remembers(case: Case) -> bool:
    """Return whether the result of a case hangs on the steps in time that led to it."""
    return case.motion.end_time is not None and case.contaminant is not None


def first_share(case: Case, *, quick: bool) -> float:
    """Return the share of a run's work that its march at the case's own place takes."""
    count, lugs, numerics = position_count(case, quick=quick), has_lugs(case), case.numerics
    if count == 1:
        return 1.0
    share = numerics.grid_spacing / numerics.quick_grid_spacing
    further = len(further_angles(case))
    if quick or (lugs and share >= 1):
        marches = float(count + lugs + further)
    else:
        marches = 1 + math.ceil(count / 2) * lugs + (count + further) * share**2
    if lugs:  # a history of the motion is marched at both angles
        marches += len(TURNED) * (case.motion.build() is not None)
    marches += FINER_MARCH * (1.0 if quick else share**2) * remembers(case)
    return 1 / marches


def run_cost(case: Case, *, quick: bool) -> Cost:
    """Return what a run will take, all places together."""
    numerics = case.numerics
    one = cost(case, numerics.quick_grid_spacing if quick else numerics.grid_spacing)
    times = (1.0 if has_lugs(case) else WITHOUT_LUGS) / first_share(case, quick=quick)
    low, high = (seconds * times for seconds in one.seconds)
    return replace(one, seconds=(low, high))


def _tread(case: Case) -> Tread | None:
    tread = None if case.shoe.tread is None else case.shoe.tread.build()
    return tread if tread and tread.depth > 0 else None


def place_numbers(parts: Prepared, contact: SoleContact) -> dict[str, float]:
    """Return the numbers of a result that depend on where the tread lies."""
    case, sole = parts.case, parts.sole
    friction = friction_sums(parts.local_law, contact, case.motion.speed)
    sensor = scan_reading(case, sole, contact, viscosity=parts.viscosity)
    numbers, _ = scalars(case, contact, friction, sensor)
    numbers |= later_numbers(parts, contact)
    values = {
        name: each.value
        for name, each in numbers.items()
        if each.value is not None and name not in ("normal_force", "slip_probability")
    }
    return {**values, "contact_load": friction.normal_force - friction.fluid_load}
