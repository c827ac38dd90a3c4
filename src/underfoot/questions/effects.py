"""What a change of a case does to its friction, by the least computation that tells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from underfoot.compute.continuation import Continuation, Preview
from underfoot.compute.numbers import slip_probability
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

from .changes import Change
from .outcomes import outcomes

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.compute.result import Result

MOST_ERROR = 0.01
"""COF that a continuation may miss by its own estimate; half of the COF's own spread if more."""
STAGE = "Simulating changes"
_DRAWS = "cof_draws"
_ONE_POSITION = {"numerics.tread_positions": 1}
_OF_THE_PLAN = ("heel", "tread", "sole", "outsole")


@dataclass(frozen=True, slots=True)
class ChangeEffect:
    """A change and what it leads to: ``cof``, ``fluid_load`` and ``slip_probability``.

    ``reason`` says why there are none. ``error`` is the computation's own on COF, estimated, where
    the change was continued; its spread is that of the friction law.
    """

    change: Change
    scalars: Mapping[str, SourcedValue]
    reason: str = ""
    error: float | None = None

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
    def of_preview(cls, seen: Preview) -> _Friction:
        load = SourcedValue(seen.values["fluid_load"], "N", reason="not estimated")
        return cls(seen.cof, seen.cof_draws, load)

    def widened(self, deviation: float) -> _Friction:
        """Return the friction with a further relative deviation in its draws, log-normal."""
        if self.draws is None or not deviation:
            return self
        width = math.sqrt(math.log1p(deviation**2))
        normal = normal_draws(0, "what a preview leaves out", self.draws.size)
        return replace(self, draws=self.draws * np.exp(width * normal - width**2 / 2))

    def moved(self, start: _Level, own: _Level) -> _Friction:
        """Return a changed friction as from ``own``, the unchanged one, instead of ``start``."""
        cof, load = self.cof.value or 0.0, self.fluid_load.value or 0.0
        left = min(1.0, load / start.fluid_load) if start.fluid_load else 1.0
        more, more_load = (left * (b - a) for a, b in zip(start, own, strict=True))
        factor = max(1.0 + more / cof, 0.0) if cof else 1.0
        return _Friction(
            self.cof.scaled(factor),
            None if self.draws is None else factor * self.draws,
            replace(self.fluid_load, value=max(load + more_load, 0.0)),
        )

    def effect(self, change: Change, variant: Case, error: float | None = None) -> ChangeEffect:
        """Return what a change leads to that has this friction."""
        slip, _ = slip_probability(variant, self.cof, self.draws)
        scalars = {"cof": self.cof, "fluid_load": self.fluid_load, "slip_probability": slip}
        return ChangeEffect(change, scalars, error=error)


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

    A change of who walks takes the friction that is there. With ``quick``, others go on from one
    march of the case on its coarse grid at the tread's own position (``Continuation``). What that
    can't tell within ``MOST_ERROR``, and another rubber, is run there; another plan of the sole at
    the positions of a quick run; with a motion history all are, in up to ``processes`` processes.
    What the coarse grid and the one position miss is known of the unchanged case, and carried over
    in proportion to the load that is left on the film:

        x(changed) = x_1(changed) + (x - x_1) min(1, F_1(changed) / F_1)

    x_1 as computed for the change, F the load on the film, x the mean of the present result (for
    another plan, which has positions of its own: the present result at its first). Without
    ``quick`` each change is a run on the grid of the case.
    """
    effects: dict[int, ChangeEffect] = {}
    variants: dict[int, Case] = {}
    for number, change in enumerate(changes):
        try:
            variant = case.replace(change.values)
        except UnderfootError as error:
            effects[number] = ChangeEffect(change, {}, str(error))
            continue
        if all(path.split(".")[0] == "risk" for path in change.values):
            effects[number] = _Friction.of(present.scalars, present.data).effect(change, variant)
        else:
            variants[number] = variant
    if not variants:
        return tuple(effects.values())
    mean, own = _levels(present)
    march = start = None
    left_out = 0.0
    if quick:
        march = _march(case, part(progress, 0.0, 0.3))
    if march is not None:
        start = _Level(march.values["cof"], march.values["fluid_load"])
        left_out = _further_deviation(_Friction.of(present.scalars, present.data), march.cof_draws)
        for number, variant in variants.items():
            progress(STAGE, 0.3 + 0.3 * number / len(changes))
            if variant.shoe.material != case.shoe.material:
                continue  # a rubber that gives way otherwise: most steps to it cost a march or fail
            seen = _continued(march, changes[number])
            if seen is not None:
                there = _Friction.of_preview(seen).moved(start, mean).widened(left_out)
                error = seen.errors["cof"]
                effects[number] = there.effect(changes[number], variant, error)
    alike = {number for number, each in variants.items() if quick and _same_plan(case, each)}
    # shoe angles of a sole without lugs leave its value and belong to its draws
    one_position = _ONE_POSITION if treaded(case) else {}
    runs = {
        number: each.replace(one_position) if number in alike else each
        for number, each in variants.items()
        if number not in effects
    }
    unchanged = [case.replace(one_position)] if quick and march is None else []
    found = outcomes(
        [*unchanged, *runs.values()],
        quick=quick,
        maps=(_DRAWS,),
        processes=1 if march else processes,  # few are left: started workers would cost more
        progress=part(progress, 0.6, 1.0),
        stage=STAGE,
    )
    if unchanged and (first := found.pop(0)).usable:
        start = _Level(first.number("cof"), first.number("fluid_load"))
    for (number, each), outcome in zip(runs.items(), found, strict=True):
        if not outcome.usable:
            effects[number] = ChangeEffect(changes[number], {}, str(outcome.status))
            continue
        there = _Friction.of(outcome.scalars, outcome.maps)
        if start is not None:
            there = there.moved(start, mean if number in alike else own)
        effects[number] = there.effect(changes[number], each)
    return tuple(effects[number] for number in range(len(changes)))


def _continued(march: Continuation, change: Change) -> Preview | None:
    """Return a change by continuation; None where it can't be made or may be too far off."""
    try:
        seen = march.continued(change.values)
    except (InputError, ConvergenceError):
        return None
    most = max(MOST_ERROR, 0.5 * (seen.cof.uncertainty or 0.0))
    return seen if seen.errors["cof"] <= most else None


def _levels(present: Result) -> tuple[_Level, _Level]:
    """Return the mean of a result over the positions of its tread, and its first position."""
    mean = _Level(present.value("cof"), present.value("fluid_load"))
    if "position_cof" not in present.data:
        return mean, mean
    first = (np.asarray(present.data[f"position_{name}"])[0] for name in _Level._fields)
    return mean, _Level(*map(float, first))


def _further_deviation(friction: _Friction, draws: Array | None) -> float:
    """Return the relative deviation of a friction beyond that of ``draws``: angle, position, grid.
    """
    if friction.draws is None or draws is None:
        return 0.0
    whole, part = (float(np.std(each) / np.mean(each)) for each in (friction.draws, draws))
    return math.sqrt(max(whole**2 - part**2, 0.0))


def _march(case: Case, progress: Progress) -> Continuation | None:
    """Return the case marched on its quick grid, if it can be continued from there."""
    if case.motion.build() is not None:
        return None
    try:
        return Continuation(case, progress=progress)
    except ConvergenceError:
        return None


def _same_plan(case: Case, variant: Case) -> bool:
    return all(getattr(case.shoe, name) == getattr(variant.shoe, name) for name in _OF_THE_PLAN)
