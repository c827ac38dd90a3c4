"""What a change of a case does to its friction, by the least computation that tells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from underfoot.compute.continuation import Continuation, Preview
from underfoot.compute.numbers import slip_probability
from underfoot.compute.positions import has_lugs
from underfoot.core import (
    ConvergenceError,
    InputError,
    Progress,
    SourcedValue,
    UnderfootError,
    silent,
)
from underfoot.core.arrays import Array
from underfoot.core.fields import Fields
from underfoot.core.progress import part
from underfoot.friction.propagation import normal_draws, probability_higher

from .changes import Change
from .outcomes import outcomes

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.compute.result import Result

MOST_ERROR = 0.01
"""COF that a continuation may miss by its own estimate; with lugs half of its spread if more."""
STAGE = "Simulating changes"
_DRAWS = "cof_draws"
_ONE_POSITION = {"numerics.tread_positions": 1}
_OF_THE_PLAN = ("heel", "tread", "sole", "outsole")


@dataclass(frozen=True, slots=True)
class ChangeEffect:
    """A change and what it leads to: ``cof``, ``fluid_load`` and ``slip_probability``.

    ``reason`` says why there are none. ``error`` is the computation's own on COF, estimated, where
    the change was continued; its spread is that of the friction law. ``higher`` is the probability
    that it raises COF, None where no spread is known.
    """

    change: Change
    scalars: Mapping[str, SourcedValue]
    reason: str = ""
    error: float | None = None
    higher: float | None = None

    @property
    def computed(self) -> bool:
        """Whether the change gave a result."""
        return bool(self.scalars)

    def number(self, name: str) -> float:
        """Return a number of the changed case; nan where it could not be computed."""
        value = self.scalars[name].value if self.computed else None
        return float("nan") if value is None else value


@dataclass(frozen=True, slots=True)
class _Friction:
    """Friction of a sole, draws of its spread (n,) or None, and the load on its film, N."""

    cof: SourcedValue
    draws: Array | None
    fluid_load: SourcedValue

    @classmethod
    def of(cls, scalars: Mapping[str, SourcedValue], maps: Mapping[str, Any] | Fields) -> _Friction:
        draws = np.asarray(maps[_DRAWS]) if _DRAWS in maps else None
        return cls(scalars["cof"], draws, scalars["fluid_load"])

    @classmethod
    def of_march(cls, made: Continuation | Preview) -> _Friction:
        load = SourcedValue(made.values["fluid_load"], "N", reason="not estimated")
        return cls(made.cof, made.cof_draws, load)

    def film_left(self, start: _Level) -> float:
        """Return the load on the film as a share of that of ``start``, at most 1."""
        load = float(self.fluid_load)
        return min(1.0, load / start.fluid_load) if start.fluid_load else 1.0

    def widen_draws(self, beyond: _Spread, share: float) -> _Friction:
        """Return the friction with ``share`` of a further shift and spread in its draws."""
        if self.draws is None:
            return self
        normal = normal_draws(0, "what a preview leaves out", self.draws.size)
        further = beyond.shift + beyond.deviation * normal
        return replace(self, draws=self.draws * np.exp(share * further))

    def move_start(self, start: _Level, unchanged: _Level) -> _Friction:
        """Return a changed friction as from ``unchanged`` instead of ``start``."""
        cof, load = float(self.cof), float(self.fluid_load)
        left = self.film_left(start)
        more, more_load = (left * (b - a) for a, b in zip(start, unchanged, strict=True))
        factor = max(1.0 + more / cof, 0.0) if cof else 1.0
        return _Friction(
            self.cof.scale_value(factor),
            None if self.draws is None else factor * self.draws,
            replace(self.fluid_load, value=max(load + more_load, 0.0)),
        )

    def effect(
        self, change: Change, variant: Case, present: Result, error: float | None = None
    ) -> ChangeEffect:
        """Return what a change of the ``present`` result leads to that has this friction."""
        slip, _ = slip_probability(variant, self.cof, self.draws)
        scalars = {"cof": self.cof, "fluid_load": self.fluid_load, "slip_probability": slip}
        before = _Friction.of(present.scalars, present.data)
        known = [(float(one.cof), one.cof.uncertainty, one.draws) for one in (self, before)]
        higher = probability_higher(*known, shared=True)
        return ChangeEffect(change, scalars, error=error, higher=higher)


class _Spread(NamedTuple):
    """Mean and standard deviation of the logarithm of COF around its value."""

    shift: float = 0.0
    deviation: float = 0.0

    @classmethod
    def beyond(cls, whole: _Friction, part: _Friction) -> _Spread:
        """Return what the draws of ``whole`` hold beyond those of ``part``: grid and positions."""
        drawn = [np.log(e.draws / float(e.cof)) for e in (whole, part) if e.draws is not None]
        if len(drawn) < 2:
            return cls()
        of_whole, of_part = drawn
        variance = float(np.var(of_whole) - np.var(of_part))
        return cls(float(np.mean(of_whole) - np.mean(of_part)), math.sqrt(max(variance, 0.0)))


class _Level(NamedTuple):
    """COF and load on the film (N) of the unchanged case."""

    cof: float
    fluid_load: float


def change_effects(
    case: Case,
    present: Result,
    changes: Sequence[Change],
    *,
    quick: bool = True,
    processes: int | None = 1,
    progress: Progress = silent,
) -> tuple[ChangeEffect, ...]:
    """Return what each change makes of the ``present`` result of a case, in order.

    A change of who walks takes the friction that is there. With ``quick``, others go on from a
    march of the case on its coarse grid at the case's own position (``Continuation``). What that
    can't tell within ``MOST_ERROR``, and another rubber, is run there (without lugs at every shoe
    angle); another plan of the sole at the positions of a quick run; with a motion history all are,
    in up to ``processes`` processes.
    What the coarse grid and the one position miss is known of the unchanged case, and carried over
    in proportion to the load that is left on the film:

        x(changed) = x_1(changed) + (x - x_1) min(1, F_1(changed) / F_1)

    x_1 as computed for the change, F the load on the film, x the mean of the present result (for
    another plan, which has positions of its own: the present result at its first). Without
    ``quick`` each change is a run on the grid of the case.

    Parameters:
        case: The case as it is.
        present: Its result.
        changes: What is tried, each by itself.
        quick: Go on from the coarse grid; else a run each.
        processes: Changes that are run at the same time.
        progress: Called with stage, fraction and residual; an exception it raises stops the work.
    """
    effects: dict[int, ChangeEffect] = {}
    variants: dict[int, Case] = {}
    for number, change in enumerate(changes):
        if change.reason:
            effects[number] = ChangeEffect(change, {}, change.reason)
            continue
        try:
            variant = case.replace(change.values)
        except UnderfootError as error:
            effects[number] = ChangeEffect(change, {}, error.message)
            continue
        if all(path.split(".")[0] == "risk" for path in change.values):
            effects[number] = _Friction.of(present.scalars, present.data).effect(
                change, variant, present
            )
        else:
            variants[number] = variant
    if not variants:
        return tuple(effects.values())
    mean, level = _levels(present)
    march, start, lugs = None, None, has_lugs(case)
    left_out = _Spread()
    if quick:
        march = _march(case, part(progress, 0.0, 0.3))
    if march is not None:
        start = _Level(march.values["cof"], march.values["fluid_load"])
        whole = _Friction.of(present.scalars, present.data)
        left_out = _Spread.beyond(whole, _Friction.of_march(march))
        for number, variant in variants.items():
            progress(STAGE, 0.3 + 0.3 * number / len(changes))
            if variant.shoe.material != case.shoe.material:
                continue  # a rubber that gives way otherwise: most steps to it cost a march or fail
            seen = _continue_march(march, changes[number], lugs)
            if seen is not None:
                there = _Friction.of_march(seen)
                there = there.move_start(start, mean).widen_draws(left_out, there.film_left(start))
                effects[number] = there.effect(
                    changes[number], variant, present, seen.errors["cof"]
                )
    plans = {n: [getattr(v.shoe, part) for part in _OF_THE_PLAN] for n, v in variants.items()}
    plan = [getattr(case.shoe, part) for part in _OF_THE_PLAN]
    alike = {number for number, each in plans.items() if quick and each == plan}
    one_position = _ONE_POSITION if lugs else {}
    runs = {
        number: each.replace(one_position) if number in alike else each
        for number, each in variants.items()
        if number not in effects
    }
    again = [case.replace(one_position)] if quick and march is None else []
    found = outcomes(
        [*again, *runs.values()],
        quick=quick,
        maps=(_DRAWS,),
        # few are left under lugs: started workers would cost more
        processes=1 if march and lugs else processes,
        progress=part(progress, 0.6, 1.0),
        stage=STAGE,
    )
    if again and (first := found.pop(0)).usable:
        start = _Level(first.number("cof"), first.number("fluid_load"))
    elif start is not None and not lugs:  # the ratio of the angles is that of the coarse grid
        start = _Level(*(s * m / o if o else s for s, m, o in zip(start, mean, level, strict=True)))
    for (number, each), outcome in zip(runs.items(), found, strict=True):
        if not outcome.usable:
            effects[number] = ChangeEffect(changes[number], {}, str(outcome.status))
            continue
        there = _Friction.of(outcome.scalars, outcome.maps)
        if start is not None:
            there = there.move_start(start, mean if number in alike or not lugs else level)
        effects[number] = there.effect(changes[number], each, present)
    return tuple(effects[number] for number in range(len(changes)))


def _levels(present: Result) -> tuple[_Level, _Level]:
    """Return the mean of a result over the positions of its tread, and its own position."""
    mean = _Level(present.value("cof"), present.value("fluid_load"))
    if "position_cof" not in present.data:
        return mean, mean
    generator = (present.data[f"position_{name}"].attrs["as_described"] for name in _Level._fields)
    return mean, _Level(*generator)


def _march(case: Case, progress: Progress) -> Continuation | None:
    """Return the case marched on its quick grid, if it can be continued from there."""
    if case.motion.build() is not None:
        return None
    try:
        return Continuation(case, progress=progress)
    except ConvergenceError:
        return None


def _continue_march(march: Continuation, change: Change, lugs: bool) -> Preview | None:
    """Return a change by continuation; None where it can't be made or may be too far off."""
    try:
        seen = march.continue_march(change.values)
    except (InputError, ConvergenceError):
        return None
    spread = 0.5 * (seen.cof.uncertainty or 0.0)
    # a large change of a film under a plain sole changes what a degree of shoe angle does to it
    most = max(MOST_ERROR, spread) if lugs else MOST_ERROR
    return seen if seen.errors["cof"] <= most else None
