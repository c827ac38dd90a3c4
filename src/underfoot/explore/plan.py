"""What a study is made of: base case, what varies, conditions, outputs and method."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from scipy.stats import qmc

from underfoot.case import Case
from underfoot.case.quantity import Flag
from underfoot.case.section import Section
from underfoot.compute.positions import has_lugs, position_count
from underfoot.core import InputError, content_hash
from underfoot.core.arrays import Array

from .goals import AnyGoal, Condition, Goal, Requirement
from .inputs import Distribution, Follow, Input
from .record import CaseJob

Count = Annotated[int, Field(ge=1, le=10**6, strict=True)]
POSITIONS, MOST_POSITIONS = "numerics.tread_positions", 64


class Method(Section):
    """How a study is done.

    Attributes:
        kind: sweep, sensitivity, optimise or robust (optimise over draws).
        budget: Full runs at most; None where lists and steps say it all.
        design: grid, sobol or lhs; None for a grid where lists and steps make one, else sobol.
        analysis: morris or sobol, of a sensitivity.
        on: runs or surrogate, of a sensitivity.
        active: Share of the runs of a sweep that go where the surrogate is worst.
        draws: Of the uncertain inputs, the same for every design.
        batch: Designs that are proposed together.
        grid: Of the runs.
        again: Best designs that are run again, on new positions of the tread and on ``front_grid``:
            by default the standard grid after an optimisation, "none" after anything else.
        fields: Keep maps.
        seed: Of designs and draws.
    """

    kind: Literal["sweep", "sensitivity", "optimise", "robust"] = "sweep"
    budget: Count | None = None
    design: Literal["grid", "sobol", "lhs"] | None = None
    analysis: Literal["morris", "sobol"] = "sobol"
    on: Literal["runs", "surrogate"] = "surrogate"
    active: Annotated[float, Field(ge=0, le=0.9)] = 0.0
    draws: Count = 8
    batch: Count = 8
    grid: Literal["quick", "standard"] = "quick"
    again: Count = 10
    front_grid: Literal["none", "quick", "standard"] | None = None
    fields: Flag = False
    seed: Annotated[int, Field(ge=0, le=2**31, strict=True)] = 0

    @property
    def quick(self) -> bool:
        """Whether the runs are on the coarse grid."""
        return self.grid == "quick"

    @property
    def again_on(self) -> Literal["quick", "standard"] | None:
        """Grid on which the best designs are run again; None where they are not."""
        if self.front_grid is None:
            return "standard" if self.kind in ("optimise", "robust") else None
        return None if self.front_grid == "none" else self.front_grid


@dataclass(frozen=True, slots=True)
class Reading:
    """What was measured in one condition: an output, its value and standard deviation, SI."""

    output: str
    unit: str
    value: float
    sd: float


@dataclass(frozen=True)
class StudyPlan:
    """Everything a study is made of.

    Attributes:
        base: The case that is changed.
        vary: Ranges and lists of the designer, and of a sensitivity the uncertain inputs.
        follow: Values that keep their ratio to a varied one.
        fixed: Values that all designs share, the start of the study not: lists of one.
        draws: Changes of each common draw of the uncertain inputs.
        states: Conditions that every design is run in.
        remarks: What reading the file decided, in words.
        text: The study file.
        readings: Of a calibration: what was measured in each state.
    """

    name: str
    base: Case
    vary: tuple[Input, ...]
    follow: tuple[Follow, ...]
    uncertain: tuple[Distribution, ...]
    draws: tuple[Mapping[str, Any], ...]
    states: tuple[Condition, ...]
    maximise: tuple[AnyGoal, ...]
    minimise: tuple[AnyGoal, ...]
    require: tuple[Requirement, ...]
    method: Method
    remarks: tuple[str, ...]
    text: str
    readings: tuple[Reading, ...] = ()
    fixed: Mapping[str, Any] = field(default_factory=dict)

    @property
    def dimensions(self) -> tuple[Input | Distribution, ...]:
        """What the unit cube of a design stands for."""
        if self.method.kind == "sensitivity":
            return (*self.vary, *self.uncertain)
        return self.vary

    @property
    def goals(self) -> tuple[AnyGoal, ...]:
        """What is to be large, then what is to be small."""
        return (*self.maximise, *self.minimise)

    @property
    def shown_goals(self) -> tuple[AnyGoal, ...]:
        """The goals and what is required; COF and the load on the film where nothing is."""
        required = (each.goal for each in self.require)
        unique = tuple(dict.fromkeys((*self.goals, *required)))
        return unique or (Goal("cof", "1"), Goal("fluid_load", "N"))

    @property
    def signs(self) -> Array:
        """1 for goals to be small, -1 for those to be large."""
        return np.array([-1.0] * len(self.maximise) + [1.0] * len(self.minimise))

    @property
    def cases_per_design(self) -> int:
        """Full runs that one design takes."""
        return len(self.states) * len(self.draws)

    @property
    def designs(self) -> int:
        """Number of designs: of the grid, or that the budget allows."""
        if self.method.design == "grid":
            return math.prod(len(one.shares()) for one in self.vary)
        return (self.method.budget or 0) // self.cases_per_design

    def grid_points(self) -> list[tuple[float, ...]]:
        """Return the points of the full grid of lists and steps."""
        return list(product(*(one.shares() for one in self.vary)))

    def sampled_points(self, count: int) -> list[tuple[float, ...]]:
        """Return ``count`` places of the unit cube, evenly spread."""
        size, seed = len(self.dimensions), self.method.seed
        if self.method.design == "lhs":
            rows = qmc.LatinHypercube(size, rng=seed).random(count)
        else:
            rows = qmc.Sobol(size, rng=seed).random_base2(math.ceil(math.log2(max(count, 2))))
        return list(map(tuple, rows[:count].tolist()))

    def design_changes(self, point: Sequence[float]) -> dict[str, Any]:
        """Return what a point of the unit cube changes in the case, followers included.

        Without a point it is the case itself, where a study starts.
        """
        if not point:
            return {}
        changes = {
            dimension.path: dimension.value(share)
            for dimension, share in zip(self.dimensions, point, strict=True)
        }
        followers = {follow.path: follow.times * changes[follow.of] for follow in self.follow}
        return {**self.fixed, **changes, **followers}

    def jobs(
        self, design: int, point: Sequence[float], batch: int, *, again: bool = False
    ) -> Iterator[CaseJob]:
        """Yield the jobs of a design: every condition with every draw; ``again``: ``job``."""
        for state, draw in product(range(len(self.states)), range(len(self.draws))):
            yield self.job(design, point, batch, state, draw, again=again)

    def job(
        self,
        design: int,
        point: Sequence[float],
        batch: int,
        state: int,
        draw: int,
        *,
        again: bool = False,
    ) -> CaseJob:
        """Return the job of a design in one condition with one draw.

        ``again`` takes the grid of ``Method.again_on``, and other positions of the tread where it
        has any: else, on the same grid, it is the same job.
        """
        own, place = self.design_changes(point), tuple(map(float, point))
        quick, fields = self.method.quick, self.method.fields
        changes = {**own, **self.draws[draw], **self.states[state].changes}
        if again:
            quick = self.method.again_on == "quick"
            changes |= self._elsewhere(changes, quick)
        key = self._key(changes, quick)
        return CaseJob(key, design, state, draw, batch, place, changes, quick, fields)

    def _elsewhere(self, changes: Mapping[str, Any], quick: bool) -> dict[str, Any]:
        """Return the number of positions whose lattice shares the first alone with a first run's.

        Nothing for a sole without lugs, and for the tread as it lies (1 position).
        """
        try:
            case = self.base.replace(changes)
        except InputError:  # no case: its record will say why
            return {}
        count = case.numerics.tread_positions
        if count == 1 or not has_lugs(case):
            return {}
        step = 1 if count < MOST_POSITIONS - 1 else -1
        first = position_count(case, quick=self.method.quick)
        others = ({POSITIONS: count + step}, {POSITIONS: count + 2 * step})  # a quick run halves it
        return next(o for o in others if position_count(case.replace(o), quick=quick) != first)

    @property
    def again_is_the_same(self) -> bool:
        """Whether the base case run again would be the run that it had."""
        first, second = (self.job(0, (), 0, 0, 0, again=again) for again in (False, True))
        return first.key == second.key

    def _key(self, changes: Mapping[str, Any], quick: bool) -> str:
        try:
            return job_key(self.base.replace(changes), quick)
        except InputError:  # no case: its record will say why
            return content_hash(self.base.hash, changes, quick)[:24]


def job_key(case: Case, quick: bool) -> str:
    """Return the key of a job: what decides its numbers."""
    return content_hash(case.hash, quick)[:24]
