"""A tread, not one position of it: the answer averaged over where its lugs happen to lie."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any, ClassVar

import numpy as np

from underfoot.case import Case
from underfoot.core import SourcedValue, content_hash, display
from underfoot.core.arrays import Array
from underfoot.core.remark import Remark
from underfoot.friction import FrictionCoefficients, SampledCof
from underfoot.friction.propagation import normal_draws
from underfoot.shoe import Tread
from underfoot.sole_contact.cost import Cost
from underfoot.sole_contact.solver import SoleContact

from .contact_friction import friction_sums
from .cost import cost
from .numbers import scalars
from .prepare import Prepared
from .sensors import scanned
from .sole import bottom_surface, file_surface, landing_front, tread_on_sole
from .steadiness import later_numbers

ANGLE_BAND = math.radians(1)
"""The shoe angle lies evenly within this of the case's, rad; assumed: how well an upper is held."""
ANGLE_DEVIATION = ANGLE_BAND / math.sqrt(3)
"""Standard deviation of that band, rad."""
FACET_DEVIATION = math.radians(1)
"""Standard deviation of the angle of a heel's bevel that nobody measured, rad; assumed: ground or
worn by hand, as ``underfoot sensitivity`` varies it."""
FURTHER = 1.5
"""Standard deviations of such a bevel to which its film is solved: beyond, films hardly change."""
YAW = math.radians(1)
"""Angle of a tread against the corner of its heel, to either side, rad; assumed: neither a mould,
a grinder nor wear holds it better. No standard says it."""
GOLDEN = (math.sqrt(5) - 1) / 2
ACROSS = 6.0
"""How much less a wave of the places across the shoe matters than one along it: lugs side by side
have all its phases."""
HANDED = 0.02
"""Share of a tread's walls that leans to one side more than to the other, from which it tells a
tread from its mirror image."""
FINEST = 0.25e-3
"""Cells that numbers under lugs are carried on to, m: the finest they were compared with."""
LOADS = ("fluid_load", "contact_load")
ON_CONTACT = ("cof_adhesion", "cof_hysteresis")
COF_PARTS = (*ON_CONTACT, "cof_viscous")
FAINT = 1e-6
"""Share of the load that film and contact have at least where the odds of one are asked for."""
CLOSEST = 1.25
"""Cells of two grids, coarser over finer, from which their difference says how far both are off."""
USUAL_STEP = 2 / 3
"""(coarser - finer) / finer of the grids of a case as they are by default."""
RATES = {1: 1.0, 2: 0.75}
"""Rate of the rule of positions by the number of periods of the tread, where the film jumps with
the place (docs/physics/coupled_contact.md)."""
_HELD = "spread of the friction law, its inputs and the"


@dataclass(frozen=True, slots=True)
class Place:
    """Where a tread lies: its pattern shifted by (x, y), m, and turned by ``yaw``, rad.

    ``turn``, rad, is added to the shoe angle.
    """

    shift: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0
    yaw: float = 0.0


@dataclass(frozen=True, slots=True)
class UnmeasuredBevel:
    """The bevel of a heel whose angle nobody measured: steeper, the film sees the shoe toe down.

    Attributes:
        deviation: Standard deviation of its angle, rad.
        heel: Name of the heel: its draws are one in all results.
        seed: Of the draws.
    """

    deviation: float
    heel: str
    seed: int

    @classmethod
    def of(cls, case: Case) -> "UnmeasuredBevel | None":
        """Return that of a case; None where the angle counts as exact or there is no bevel."""
        path = "shoe.heel.profile.angle"
        if path in case.idle_paths or not case.value(path):
            return None
        angle = case.sourced(path)
        deviation = angle.uncertainty or FACET_DEVIATION * angle.assumed
        paths = (row[0] for row in case.rows())
        heel = [(one, case.value(one)) for one in paths if one.startswith("shoe.heel.")]
        return cls(deviation, content_hash(heel), case.numerics.seed) if deviation else None

    def turns(self, count: int) -> Array:
        """Return by how much the shoe is turned against its bevel in each draw, (count,), rad."""
        return self.deviation * normal_draws(self.seed, f"bevel of heel {self.heel}", count)

    @property
    def told(self) -> str:
        """What is drawn, in words."""
        return f"±{display(math.degrees(self.deviation), '1')} deg"


@dataclass(frozen=True, slots=True)
class TreadPositions:
    """Numbers of a run at some positions of the tread.

    Attributes:
        places: Of the pattern and the shoe.
        values: Name of a result's scalar: its value at each place, SI.
        left_out: Number of positions that did not converge.
        at_own_place: The scalars at the case's own place, on the grid of the run.
        between: Name of a scalar: what the difference of two grids leaves unknown of its mean.
        by_angle: Name of a scalar: what ``ANGLE_DEVIATION``, toe up, adds to its value at the
            case's own place; empty where that is not known or in the values.
        film_by_angle: What it adds to ln F / (W - F), F the load on the film of W.
        bevel: Of the heel, where nobody measured its angle.
        further: Scalars by name at turns (rad) that only such a bevel reaches; not in the means.
        uncompared: Cells, m, where no other grid was compared with; else 0.
    """

    origin: ClassVar[str] = "tread_position"
    held: ClassVar[str] = "position of the tread"
    several: ClassVar[str] = "positions of the tread"

    places: tuple[Place, ...]
    values: Mapping[str, Array]
    left_out: int
    at_own_place: Mapping[str, float]
    between: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    by_angle: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    film_by_angle: float = field(default=0.0, kw_only=True)
    bevel: UnmeasuredBevel | None = field(default=None, kw_only=True)
    further: Mapping[float, Mapping[str, float]] = field(default_factory=dict, kw_only=True)
    uncompared: float = field(default=0.0, kw_only=True)

    def answer(self, name: str) -> float:
        """Return the scalar of the result: its mean over the places."""
        return float(self.values[name].mean())

    def drawn(self, name: str, count: int) -> Array:
        """Return the scalar (count,) at each place in turn, drawn over the angle and the bevel.

        The angle moves the load on the film by its odds, and adds to other numbers.
        """
        if name != "fluid_load":
            return self._beside_film(name, count)
        film, contact = (self._each(load, count) for load in LOADS)
        more = film * np.exp(self._more_odds(count))
        return more * (film + contact) / (more + contact)

    def _each(self, name: str, count: int) -> Array:
        """Return the scalar (count,) at each place in turn, at the angle of the case."""
        return self.values[name][np.arange(count) % len(self.places)]

    def _turns(self, count: int, *, bevel: bool = True) -> Array:
        """Return turns (count,) evenly over the band of the angle, in its standard deviations.

        ``bevel``: with that of the heel, where it was not measured.
        """
        turns = math.sqrt(3) * (2 * np.mod(GOLDEN * np.arange(count), 1) - 1)
        if self.bevel and bevel:
            turns = turns + self.bevel.turns(count) / ANGLE_DEVIATION
        return turns

    def _more_odds(self, count: int, *, bevel: bool = True) -> Array:
        """Return what the angle adds to ln F / (W - F) of the places in turn, (count,)."""
        return self.film_by_angle * self._turns(count, bevel=bevel)

    def _beside_film(self, name: str, count: int) -> Array:
        """Return draws (count,) of a scalar other than the load on the film."""
        more = self.by_angle.get(name, 0.0) * self._turns(count)
        return np.maximum(self._each(name, count) + more, 0)

    def friction(
        self, friction: FrictionCoefficients, sampled: SampledCof | None
    ) -> tuple[FrictionCoefficients, SampledCof | None]:
        """Return COF and its draws over the positions, which the draws take in turn.

        Each draw of the law meets the contact and the film of a place, turned by an angle.
        """
        values = {name: values for name, values in self.values.items() if name.startswith("cof")}
        new = {name: replace(getattr(friction, name), value=self.answer(name)) for name in values}
        if sampled is not None:
            count = sampled.cof.size
            film, contact = (self._each(load, count) for load in LOADS)
            parts = {name.removeprefix("cof_"): self._each(name, count) for name in COF_PARTS}
            as_measured, draws = (
                sampled.law.at(
                    contact / (film + contact),
                    **parts,
                    more_odds=self._more_odds(count, bevel=bevel),
                )
                for bevel in (False, True)
            )
            more = {self.origin: float(np.var(values["cof"]))}
            if self.by_angle:
                more["shoe_angle"] = self.by_angle["cof"] ** 2
            if self.bevel:
                more["bevel"] = float(np.var(draws["cof"] - as_measured["cof"]))
            law_variance = float(np.var(sampled.cof))
            whole = law_variance + sum(more.values())
            share = {name: each * law_variance / whole for name, each in sampled.share.items()}
            share |= {name: each / whole for name, each in more.items()}
            sampled = replace(sampled, share=share, **draws)
            for name, value in new.items():
                if value.uncertainty is not None:  # what the law leaves open stays open
                    new[name] = sampled.sourced(name.removeprefix("cof_"), value)
            new["cof"] = replace(new["cof"], note=f"{_HELD} {self.held}")
        load = self.answer("fluid_load")
        force = self.answer("cof") * friction.normal_force
        return replace(friction, **new, fluid_load=load, friction_force=force), sampled

    def averaged(self, numbers: Mapping[str, SourcedValue]) -> dict[str, SourcedValue]:
        """Return the numbers with means over the positions, and the spread of COF over them."""
        means = dict(numbers)
        if len(self.places) == 1:
            return means
        for name in self.values:
            if name in numbers and not name.startswith("cof"):
                means[name] = replace(numbers[name], value=self.answer(name))
        over = f"over {len(self.places)} {self.several}"
        means["fluid_load"] = replace(
            means["fluid_load"], note=f"{self._range('fluid_load', 'N')} {over}"
        )
        means[f"cof_{self.origin}"] = SourcedValue(
            float(np.std(self.values["cof"])),
            source=f"contact and film at another {self.held}",
            reason="itself a standard deviation",
            note=f"{self._range('cof')} {over}",
        )
        if self.by_angle:
            means["cof_shoe_angle"] = SourcedValue(
                abs(self.by_angle["cof"]),
                source="contact and film with the shoe turned",
                reason="itself a standard deviation",
            )
        return means

    def labels(self) -> dict[str, str]:
        """Return what was averaged in words."""
        failed = f"{self.left_out} did not converge and are left out" if self.left_out else ""
        told = {}
        if failed:
            told["positions_left_out"] = (
                f"{self.left_out} of {self.left_out + len(self.places)} positions of the tread did "
                "not converge. Most such positions float: COF may be lower and the load on the "
                "film higher than the means over the others."
            )
        told |= self._bevel_label()
        if len(self.places) == 1:
            return {"tread_position": f"as the case describes it; {failed} of the average", **told}
        cof, load = self.at_own_place["cof"], self.at_own_place["fluid_load"]
        if not self.by_angle:
            told["angle_as_exact"] = (
                "The shoe could not be solved turned: its angle counts as exact, and the interval "
                "is too narrow."
            )
        else:
            up = display(math.degrees(ANGLE_DEVIATION), "1")
            more, film = (self.by_angle[name] for name in ("cof", "fluid_load"))
            told["shoe_angle"] = (
                f"{up} deg toe up, one standard deviation of it, moves COF by "
                f"{display(more, '1')} and the load on the film by {display(film, 'N')}"
            )
        return {
            "tread_position": f"COF {self._range('cof')}, load on the film "
            f"{self._range('fluid_load', 'N')} over {len(self.places)} positions of the tread. "
            f"Numbers are means over them; maps and histories show the position that the case "
            f"describes (COF {display(cof, '1')}, {display(load, 'N')} on the film)"
            + (f"; {failed}" if failed else ""),
            **told,
        }

    def _bevel_label(self) -> dict[str, str]:
        """Return that the bevel of the heel is drawn; empty where its angle counts as exact."""
        return {"heel_bevel": f"not measured: angle drawn {self.bevel.told}"} if self.bevel else {}

    def assumptions(self) -> tuple[Remark, ...]:
        """Return the band of the shoe angle, where it was used, and that of the heel's bevel."""
        angle = bool(self.by_angle) or any(place.turn for place in self.places)
        yaw = any(place.yaw for place in self.places)
        bevel = self.bevel and Remark("shoe.heel.profile", f"angle {self.bevel.told}, drawn")
        return (
            *((bevel,) if bevel else ()),
            *(Remark("motion.shoe_angle", "±1 deg"),) * angle,
            *(Remark("shoe.tread", "turned ±1 deg against the heel's corner"),) * yaw,
        )

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: where the positions are, COF and load there."""

        def at(values: Any, unit: str, name: str, **more: float) -> tuple[str, Any, dict[str, Any]]:
            return ("tread_position", values, {"units": unit, "long_name": name, **more})

        cof, film = ({"as_described": self.at_own_place[n]} for n in ("cof", "fluid_load"))
        shift = np.array([place.shift for place in self.places])
        yaw = [place.yaw for place in self.places]
        return {
            "position_yaw": at(yaw, "rad", "turn of the tread's pattern, anticlockwise"),
            "position_shift_x": at(shift[:, 0], "m", "shift of the tread's pattern, forward"),
            "position_shift_y": at(shift[:, 1], "m", "shift of the tread's pattern, across"),
            "position_cof": at(self.values["cof"], "1", "coefficient of friction", **cof),
            "position_fluid_load": at(self.values["fluid_load"], "N", "load on the film", **film),
        }

    def _range(self, name: str, unit: str = "1") -> str:
        values = self.values[name]
        return f"{display(values.min(), unit)} to {display(values.max(), unit)}"


@dataclass(frozen=True, slots=True)
class ShoeAngles(TreadPositions):
    """Numbers of a run of a sole without lugs at its own shoe angle and beside it."""

    origin = "shoe_angle"
    held = "shoe angle"
    several = "shoe angles"

    def _more_odds(self, count: int, *, bevel: bool = True) -> Array:
        """Return what the bevel adds: the odds at its turn less those at the place's own."""
        if not (self.bevel and bevel):
            return np.zeros(count)
        film, contact = (self._over_angle(load) for load in LOADS)
        least = FAINT * (film[1] + contact[1])
        odds = np.log(np.maximum(film[1], least) / np.maximum(contact[1], least))
        before, after = (np.interp(turn, film[0], odds) for turn in self._turns_beside(count))
        return after - before

    def _beside_film(self, name: str, count: int) -> Array:
        """Return the scalar (count,) at the turn of its angle and bevel."""
        if not self.bevel:
            return self._each(name, count)
        return np.interp(self._turns_beside(count)[1], *self._over_angle(name))

    def _turns_beside(self, count: int) -> tuple[Array, Array]:
        """Return the turns of the places in turn, (count,), rad, without the bevel and with it."""
        turn = np.array([place.turn for place in self.places])[np.arange(count) % len(self.places)]
        return turn, turn + (self.bevel.turns(count) if self.bevel else 0.0)

    def _over_angle(self, name: str) -> tuple[Array, Array]:
        """Return all turns that were solved, rising, rad, and the scalar there."""
        turn = np.array([*(place.turn for place in self.places), *self.further])
        values = np.array([*self.values[name], *(one[name] for one in self.further.values())])
        order = np.argsort(turn)
        return turn[order], values[order]

    def labels(self) -> dict[str, str]:
        """Return what the interval holds in words."""
        if len(self.places) == 1:
            return {}
        least, most = (math.degrees(bound([p.turn for p in self.places])) for bound in (min, max))
        cof, load = self.at_own_place["cof"], self.at_own_place["fluid_load"]
        return {
            "shoe_angle": f"COF {self._range('cof')}, load on the film "
            f"{self._range('fluid_load', 'N')} from {least:.1f} to +{most:.1f} deg beside the "
            "case's angle. Numbers are means over them; maps and histories show the case's angle "
            f"(COF {display(cof, '1')}, {display(load, 'N')} on the film)",
            **self._bevel_label(),
        }

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: the angles, COF and load there."""
        fields = super(ShoeAngles, self).fields()
        turn = [place.turn for place in self.places]
        about = {"units": "rad", "long_name": "change of the shoe angle"}
        kept = {
            name: each for name, each in fields.items() if "shift" not in name and "yaw" not in name
        }
        return {"position_turn": ("tread_position", turn, about), **kept}


def further_angles(case: Case) -> tuple[Place, ...]:
    """Return the angles beyond ``shoe_angles`` that the interval of a case without lugs needs.

    One to each side, as far as the angle of a bevel that nobody measured goes; else none.
    """
    bevel = None if treaded(case) else UnmeasuredBevel.of(case)
    return (
        (Place(turn=FURTHER * bevel.deviation), Place(turn=-FURTHER * bevel.deviation))
        if (bevel)
        else ()
    )


def shoe_angles() -> tuple[Place, ...]:
    """Return the case's own shoe angle and one on each side, of the variance of ``ANGLE_BAND``."""
    turn = ANGLE_BAND / math.sqrt(2)
    return Place(), Place(turn=turn), Place(turn=-turn)


TURNED = (Place(turn=ANGLE_DEVIATION), Place(turn=-ANGLE_DEVIATION))
"""The shoe turned toe up and toe down, the tread as it lies."""


def places(periods: Array, count: int, begin: Array | None = None) -> tuple[Place, ...]:
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
    return tuple(Place((float(x), float(y))) for x, y in shares @ periods)


def _step(periods: Array, count: int) -> int:
    """Return by how many parts of the second period a place lies beyond the one before it."""
    if len(periods) == 1 or count == 1:
        return 1
    waves = np.array([h for h in product(range(-count, count + 1), repeat=2) if any(h)])
    along, across = np.linalg.pinv(periods) @ waves.T
    length = np.round(np.hypot(along, ACROSS * across) * np.abs(periods).max(), 6)
    met = [length[waves @ (1, step) % count == 0].min() for step in range(1, count)]
    return 1 + int(np.argmax(met))


def case_places(case: Case, *, quick: bool) -> tuple[Place, ...]:
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
    ahead = _reduced(periods * mirror)
    lie = places(ahead, position_count(case, quick=quick), origin @ np.linalg.pinv(ahead))
    signs = (1, -1, -1, 1)
    return tuple(
        Place((place.shift[0], hand * place.shift[1]), yaw=hand * signs[k % 4] * YAW)
        for k, place in enumerate(lie)
    )


def _reduced(periods: Array) -> Array:
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
    known: Mapping[Place, Mapping[str, float]],
    at_places: Callable[
        [Sequence[tuple[Place, float]]], Iterator[tuple[int, Mapping[str, float] | None]]
    ],
    *,
    spacing: float,
    quick: bool,
) -> TreadPositions:
    """Return the numbers of a run at more positions of its tread, or shoe angles without a tread.

    All places are solved on the quick grid, every other one, of shoe angles the own, on the grid of
    the run too. The ratio of the means on both takes all to the grid of the run, and under lugs on
    to that of ``FINEST``, where numbers move by the first order of the cells (``carried``).
    What the angle adds under a tread is half the difference of the shoe turned up and down, at the
    case's own position.

    ``known`` are the numbers at the case's own place, and what is
    known of others, on the grid of the run, of ``spacing`` (m); ``at_places`` solves places,
    each on a grid (m), and gives the index of each with its numbers as they end, None where a
    contact did not converge.
    """
    lugs, own = treaded(case), known[Place()]
    all_places, on_run_grid, coarse = _places_on_grids(case, spacing, quick=quick)
    angles = TURNED * lugs
    asked = [(place, spacing) for place in (*on_run_grid, *angles) if place not in known]
    asked += [(place, coarse) for place in all_places if coarse != spacing]
    asked += [(place, coarse) for place in further_angles(case)]
    ended = dict(at_places(asked))
    at = {(place, spacing): numbers for place, numbers in known.items()}
    at |= {one: numbers for k, one in enumerate(asked) if (numbers := ended[k]) is not None}
    pairs = [p for p in on_run_grid if (p, spacing) in at and (p, coarse) in at]
    if not pairs:  # nothing compares the grids
        pairs = [place for place in on_run_grid if (place, spacing) in at] or [Place()]
        coarse = spacing
    answers = {p: at[p, coarse] for p in all_places if (p, coarse) in at} or {Place(): own}
    failed = {*all_places} - {*answers} | {p for p in on_run_grid if (p, spacing) not in at}
    each = _arrays(own, answers.values())
    before, after = (_arrays(own, [at[p, h] for p in pairs]) for h in (coarse, spacing))
    compared = coarse > spacing
    onward = max(spacing - FINEST, 0.0) / (coarse - spacing) if lugs and compared else 0.0
    rate = RATES[len(tread_on_sole(case)[0])] if lugs else 1.0
    values, near = (carried(each, before, after, order) for order in (onward, 0.0))
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
        by_film = (_film_odds(up) - _film_odds(down)) / 2
    further = [place for place in further_angles(case) if (place, coarse) in at]
    beyond = carried(_arrays(own, [at[p, coarse] for p in further]), before, after, onward)
    kind, known_beyond = (TreadPositions, bool(by_angle)) if lugs else (ShoeAngles, bool(further))
    return kind(
        tuple(answers),
        values,
        len(failed),
        own,
        between=between,
        by_angle=by_angle,
        film_by_angle=by_film,
        bevel=UnmeasuredBevel.of(case) if known_beyond else None,
        further={
            place.turn: {n: v[k] for n, v in beyond.items()} for k, place in enumerate(further)
        },
        uncompared=0.0 if compared else spacing,
    )


def _arrays(names: Iterable[str], numbers: Iterable[Mapping[str, float]]) -> dict[str, Array]:
    listed = list(numbers)
    return {name: np.array([each[name] for each in listed]) for name in names}


def _film_odds(numbers: Mapping[str, float]) -> float:
    """Return ln F / (W - F) of the load on the film."""
    film, contact = (numbers[load] for load in LOADS)
    least = FAINT * (film + contact)
    return math.log(max(film, least) / max(contact, least))


def carried(
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
) -> tuple[tuple[Place, ...], tuple[Place, ...], float]:
    """Return the places of a run, those that the grid of the run solves, and that of all, m."""
    coarse = case.numerics.quick_grid_spacing
    if treaded(case):
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
    if not treaded(case):
        return len(shoe_angles())
    return math.ceil(count / 2) if quick else count


def treaded(case: Case) -> bool:
    """Return whether the sole of a case has lugs."""
    if case.shoe.outsole is None:
        return _tread(case) is not None
    return float(file_surface(case).tread_depth.max()) > 0


def first_share(case: Case, *, quick: bool) -> float:
    """Return the share of a run's work that its march at the case's own place takes."""
    count, lugs, numerics = position_count(case, quick=quick), treaded(case), case.numerics
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
    return 1 / marches


def run_cost(case: Case, *, quick: bool) -> Cost:
    """Return what a run will take, all places together."""
    numerics = case.numerics
    one = cost(case, numerics.quick_grid_spacing if quick else numerics.grid_spacing)
    share = first_share(case, quick=quick)
    low, high = (seconds / share for seconds in one.seconds)
    return replace(one, seconds=(low, high))


def _tread(case: Case) -> Tread | None:
    tread = None if case.shoe.tread is None else case.shoe.tread.build()
    return tread if tread and tread.depth > 0 else None


def place_numbers(parts: Prepared, contact: SoleContact) -> dict[str, float]:
    """Return the numbers of a result that depend on where the tread lies."""
    case, sole = parts.case, parts.sole
    friction = friction_sums(parts.local_law, contact, case.motion.speed)
    sensor = scanned(case, sole, contact, viscosity=parts.viscosity)
    numbers, _ = scalars(case, contact, friction, sensor)
    numbers |= later_numbers(parts, contact)
    values = {
        name: each.value
        for name, each in numbers.items()
        if each.value is not None and name not in ("normal_force", "slip_probability")
    }
    return {**values, "contact_load": friction.normal_force - friction.fluid_load}
