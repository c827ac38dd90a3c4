"""What a case states with a standard deviation, and what contact and film make of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from underfoot.case import Case
from underfoot.core import InputError, SourcedValue, content_hash
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.friction.propagation import LOGNORMAL_ABOVE

from .position_draws import COF_PARTS, LOADS, ON_CONTACT, UncertainBevel, log_film_odds
from .resolve import resolve_context

ODDS, WHOLE, NORMAL = "odds", "whole", "normal"
"""Names in the draws of a stated spread, beside those of a result: what it adds to ln F / (W - F),
F the load on the film of W, what to ln W, and the standard normal draws behind both."""
NOT_SOLVED = ("numerics", "risk", "slip")
"""Sections that neither contact nor film knows."""
VISCOSITY = "contaminant.viscosity"
EXACT_VISCOSITY = 0.01
"""Relative spread of a viscosity up to which the law's draws are enough: the film follows it, and
is unknown by some 50 % of its odds without."""
DRAWN_WITHOUT = (
    *("shoe.roughness.ra", "shoe.roughness.rq", "shoe.roughness.rz", "shoe.roughness.rp"),
    *("floor.roughness.ra", "floor.roughness.rq", "floor.roughness.rz", "floor.roughness.rp"),
    *("shoe.roughness.rt", "floor.roughness.rt", "interface.roughness_beyond_cutoff"),
    *("interface.effective_rq", "shoe.material.loss_tangent", "film.suction"),
)
"""What is drawn with the roughness that lets fluid leak (``film_spreads``), with the law's inputs,
or behind the edges of lugs."""
ROUNDING = 1e-9
HARDNESS = "shoe.material.shore_a"


@dataclass(frozen=True, slots=True)
class StatedSpread:
    """A number of a case with its standard deviation.

    Attributes:
        path: Of the number in the case; of the contaminant that of its viscosity.
        subject: Name of its draws: cases of one subject share them.
        offset: Where the number lies among the standard normal draws.
        changes: What to replace in the case at one standard deviation less and at one more.
    """

    path: str
    subject: str
    offset: float
    changes: tuple[Mapping[str, object], ...]


@dataclass(frozen=True, slots=True)
class StatedEffect:
    """What a stated spread does to the numbers of a result.

    ``moves``: by name, what one standard deviation less and more adds to the logarithm of a number,
    of friction on the contact to that of one newton of it; ``ODDS`` and ``WHOLE`` too.
    """

    path: str
    subject: str
    offset: float
    moves: Mapping[str, tuple[float, float]]

    @property
    def acts(self) -> bool:
        """Whether a number moves by more than rounding."""
        return any(abs(end) > ROUNDING for ends in self.moves.values() for end in ends)

    def draws(self, normal: Callable[[str], Array]) -> dict[str, Array]:
        """Return (n,) draws by name; between and beyond both ends in proportion.

        ``normal`` gives (n,) standard normal draws by the name of what they are of.
        """
        own = normal(self.subject)
        apart = own - self.offset
        drawn = {name: odds_changes(*ends, apart) for name, ends in self.moves.items()}
        return {**drawn, NORMAL: own}


@dataclass(frozen=True, slots=True)
class StatedEffects:
    """The effects of all stated spreads of a case, and the paths that could not be solved."""

    effects: tuple[StatedEffect, ...] = ()
    left_out: tuple[str, ...] = ()

    def of(self, case: Case) -> StatedEffects:
        """Return the effects of what a changed case still states."""
        still = {spread.subject: spread.path for spread in stated_spreads(case)}
        return StatedEffects(
            tuple(effect for effect in self.effects if effect.subject in still),
            tuple(path for path in self.left_out if path in still.values()),
        )

    def draws(self, normal: Callable[[str], Array]) -> dict[str, dict[str, Array]]:
        """Return (n,) draws by path and name; ``normal`` as for one effect."""
        return {effect.path: effect.draws(normal) for effect in self.effects}

    def labels(self) -> dict[str, str]:
        """Return what was solved for, what changes nothing, and what is left out, in words."""
        idle = [effect.path for effect in self.effects if not effect.acts]
        acting = [effect.path for effect in self.effects if effect.acts]
        told = {}
        if acting:
            told["stated_spreads"] = Message(
                "{paths}: contact and film at one standard deviation to either side", paths=acting
            )
        if idle:
            told["stated_idle"] = Message(
                "{paths}: no number moves within what is stated", paths=idle
            )
        if self.left_out:
            told["stated_left_out"] = Message(
                "The intervals leave out what is stated of {paths}: contact and film could not be "
                "solved there.",
                paths=self.left_out,
            )
        return told

    def exact(self, case: Case) -> Case | None:
        """Return the case without the spreads that these effects hold; None where all are left.

        For the friction law, which would draw them once more. That of the viscosity stays: it is
        no input of the law.
        """
        paths = [effect.path for effect in self.effects if effect.path != VISCOSITY]
        return case.replace({path: exactly(case, path) for path in paths}) if paths else None


def odds_changes(less: float, more: float, normal: Array) -> Array:
    """Return what standard normal draws add: ``less`` at -1, ``more`` at 1."""
    return np.where(normal > 0, more, -less) * normal


def sum_of_draws(draws: Mapping[str, Mapping[str, Array]], name: str) -> Array | float:
    """Return the sum of the draws of a name over all paths; 0 without any."""
    return sum((draw[name] for draw in draws.values() if name in draw), 0.0)


def exactly(case: Case, path: str) -> SourcedValue:
    """Return the number of a case as one without a spread."""
    return replace(case.sourced_value(path), uncertainty=0.0, assumed=False)


def stated_paths(case: Case) -> Iterator[str]:
    """Yield the paths of the numbers of a case with a standard deviation that is not 0."""
    for path, origin in case.origins.items():
        number = isinstance(origin.value, float | int) and not isinstance(origin.value, bool)
        if origin.uncertainty and number and path not in case.idle_paths:
            yield path


def stated_spreads(case: Case) -> tuple[StatedSpread, ...]:
    """Return the spreads of a case that contact and film are to be solved for.

    Not those that are drawn without: of the friction law's own inputs, of the roughness that lets
    fluid leak, of the heel's bevel. What makes the viscosity counts as one.
    """
    fluid = case.contaminant
    viscosity = None if fluid is None else fluid.build()
    fluid_paths = {f"contaminant.{name}" for name in ("viscosity", *_of_viscosity(case))}
    spreads = []
    value, deviation = 0.0, 0.0
    if viscosity is not None:
        value, deviation = float(viscosity), viscosity.uncertainty or 0.0
    if fluid is not None and deviation > EXACT_VISCOSITY * value:
        ends, offset = _ends(value, deviation)
        about = {"family": fluid.chemistry, "pool_depth": fluid.pool_depth}
        spreads.append(
            StatedSpread(
                VISCOSITY,
                f"viscosity {value:.6g} {deviation:.6g}",
                offset,
                tuple({"contaminant": {"viscosity": end, **about}} for end in ends),
            )
        )
    for path in stated_paths(case):
        section = path.partition(".")[0]
        if section in NOT_SOLVED or path in fluid_paths or _drawn_without(case, path):
            continue
        value, deviation = float(case.value(path)), case.sourced_value(path).uncertainty or 0.0
        ends, offset = _ends(value, deviation)
        changed = tuple({path: end} for end in ends)
        spreads.append(StatedSpread(path, _subject(case, path), offset, changed))
    return tuple(spreads)


Numbers = Mapping[str, float]
"""Numbers of a place by name, SI (``place_numbers``)."""


def solved_effects(
    case: Case,
    stepped: Callable[[Case], Numbers | None],
    marched: Callable[[Sequence[Case]], Sequence[Numbers | None]],
) -> StatedEffects:
    """Return the effects of all stated spreads of a case.

    Parameters:
        case: What states them.
        stepped: Numbers of a case, itself too, from its finished contact in steps; None where they
            can't lead there.
        marched: Those of cases from the start, of the case itself first; None where one has none.
    """
    spreads = stated_spreads(case)
    if not spreads:
        return StatedEffects()
    own = stepped(case)
    solved: dict[str, list[Numbers | None]] = {}
    cases = {
        stated_spread.path: [_change_case(case, change) for change in stated_spread.changes]
        for stated_spread in spreads
    }
    for path, ends in cases.items():
        numbers = [None if own is None or end is None else stepped(end) for end in ends]
        if not any(each is None and end for each, end in zip(numbers, ends, strict=True)):
            solved[path] = [own, *numbers]
    rest = {path: ends for path, ends in cases.items() if path not in solved}
    asked = [end for ends in rest.values() for end in ends if end is not None]
    if asked:
        begun, *answers = marched([case, *asked])
        later = iter(answers)
        for path, ends in rest.items():
            solved[path] = [begun, *(None if end is None else next(later) for end in ends)]
    effects, left_out = [], []
    for spread in spreads:
        before, *after = solved.get(spread.path, [None])
        moves = [log_moves(before, one) for one in after if before is not None and one is not None]
        if not moves:
            left_out.append(spread.path)
            continue
        alone = len(moves) == 1  # the other end is as far the other way
        less, more = moves * 2 if alone else moves
        down, up = (-1 if alone and one is None else 1 for one in after)
        pairs = {name: (down * less[name], up * more[name]) for name in less.keys() & more.keys()}
        effects.append(StatedEffect(spread.path, spread.subject, spread.offset, pairs))
    return StatedEffects(tuple(effects), tuple(left_out))


def _change_case(case: Case, change: Mapping[str, object]) -> Case | None:
    """Return a changed case; None beyond what is physical, or against another number of it."""
    try:
        return case.replace(change)
    except InputError:
        return None


def log_moves(before: Numbers, after: Numbers) -> dict[str, float]:
    """Return what is added to the logarithms of the numbers of a place, as ``StatedEffect`` has it.

    A number that one of both lacks stays.
    """

    def logarithms(numbers: Numbers) -> dict[str, float]:
        film, contact = (numbers[load] for load in LOADS)
        whole = film + contact
        logs = {name: _log(value) for name, value in numbers.items()}
        logs |= {name: logs[name] + _log(whole) - _log(contact) for name in ON_CONTACT}
        return {**logs, ODDS: float(log_film_odds(film, contact)), WHOLE: _log(whole)}

    end = logarithms(after)
    apart = {name: end[name] - log for name, log in logarithms(before).items() if name in end}
    return {name: one if math.isfinite(one) else 0.0 for name, one in apart.items()}


def friction_draws(draws: Mapping[str, Mapping[str, Array]]) -> dict[str, dict[str, Array]]:
    """Return the draws by path as ``sampled_cof`` takes them."""
    return {
        path: {
            **{name.removeprefix("cof_"): each[name] for name in COF_PARTS},
            **{name: each[name] for name in (ODDS, NORMAL)},
        }
        for path, each in draws.items()
    }


def _log(value: float) -> float:
    return math.log(value) if value > 0 else math.nan


def _ends(value: float, deviation: float) -> tuple[tuple[float, float], float]:
    """Return a number at one standard deviation less and more, and its place among normal draws.

    As ``propagated`` draws it: log-normal where it is positive and spreads by more than a third.
    """
    if value > 0 and deviation > LOGNORMAL_ABOVE * value:
        width = math.sqrt(math.log1p((deviation / value) ** 2))
        return (value * math.exp(-width), value * math.exp(width)), width / 2
    return (value - deviation, value + deviation), 0.0


def _of_viscosity(case: Case) -> tuple[str, ...]:
    """Return the fields of the contaminant that its viscosity is made of."""
    fields = ("glycerol_fraction", "temperature")
    return tuple(name for name in fields if hasattr(case.contaminant, name))


def _subject(case: Case, path: str) -> str:
    """Return the name of the draws of a number: that of a shoe's part is one with its neighbours.

    Hardness: that of the durometer, as ``Pair`` names it.
    """
    if path == HARDNESS:
        return f"hardness {case.shoe.material.polymer}"
    value, deviation = case.value(path), case.sourced_value(path).uncertainty
    name = f"{path} {value:.6g} {deviation:.6g}"
    if not path.startswith("shoe."):
        return name
    owner = path.rpartition(".")[0]
    return f"{name} of {content_hash(case.named_values(f'{owner}.'))}"


def _drawn_without(case: Case, path: str) -> bool:
    """Return whether a stated spread is drawn without another contact."""
    if path in DRAWN_WITHOUT:
        return True
    exact = case.replace(path, exactly(case, path))
    if path.startswith("friction."):
        laws = (one.friction.build(resolve_context(one)) for one in (case, exact))
        with_spread, without = (
            {name: each.uncertainty for name, each in law.inputs.items()} for law in laws
        )
        return with_spread != without
    bevel = UncertainBevel.of(case), UncertainBevel.of(exact)
    return case.numerics.tread_positions > 1 and bevel[0] != bevel[1]
