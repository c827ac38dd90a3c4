"""What came of a study: its designs with their goals, the front, and how sure their order is."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case import unit_at
from underfoot.core.arrays import Array, Mask
from underfoot.core.presentation import Presentable, Table, percent, quantity_text
from underfoot.core.provenance import program_hash
from underfoot.friction.propagation import probability_higher

from .goals import Goal, output_array
from .plan import StudyPlan
from .record import Ending, Job, Record

if TYPE_CHECKING:
    import xarray

MOST_ROWS = 12
"""Designs of a table on the terminal."""


@dataclass(frozen=True, slots=True)
class Design:
    """One design: what it changes, and its records by (condition, draw)."""

    number: int
    point: tuple[float, ...]
    changes: Mapping[str, Any]
    quick: bool
    cases: int
    records: Mapping[tuple[int, int], Record] = field(default_factory=dict)

    @property
    def complete(self) -> bool:
        """Whether every case of it has ended."""
        return len(self.records) == self.cases

    @property
    def usable(self) -> bool:
        """Whether every case of it has numbers."""
        return self.complete and all(record.usable for record in self.records.values())

    @property
    def ending(self) -> str:
        """How it ended: computed, or what kept the first of its cases from it."""
        bad = [record.ending for record in self.records.values() if not record.usable]
        return str(bad[0]) if bad else str(Ending.COMPUTED) if self.complete else "open"

    @property
    def reason(self) -> str:
        """Why it has no numbers."""
        return next((r.reason for r in self.records.values() if not r.usable), "")

    def cof_draws(self) -> Array | None:
        """Return (conditions x draws x law's draws,) joint draws of COF; None without."""
        if not self.usable or any(r.draws.size == 0 for r in self.records.values()):
            return None
        states = sorted({state for state, _ in self.records})
        return output_array(self.records, states, "cof", law=True).ravel()


@dataclass(frozen=True)
class StudyResult(Presentable):
    """The designs of a study as far as they are computed.

    Attributes:
        plan: What was asked.
        jobs: What was set so far.
        records: What is finished, by key.
        sessions: When processes worked on it.
    """

    kind: ClassVar[str] = "study"

    plan: StudyPlan
    jobs: Sequence[Job]
    records: Mapping[str, Record]
    sessions: Sequence[Mapping[str, Any]] = ()

    def __repr__(self) -> str:
        return f"<StudyResult {self.plan.name!r:.80}: {len(self.designs)} designs>"

    def heading(self) -> str:
        """Return the name of the study."""
        return self.plan.name

    @cached_property
    def all_designs(self) -> list[Design]:
        """Every design on every grid, in the order in which they were set."""
        found: dict[tuple[int, bool], dict[tuple[int, int], Job]] = {}
        for job in self.jobs:
            found.setdefault((job.design, job.quick), {})[job.condition, job.draw] = job
        designs = []
        for (number, quick), jobs in sorted(found.items(), key=lambda one: (one[0][0], one[0][1])):
            first = next(iter(jobs.values()))
            records = {at: self.records[j.key] for at, j in jobs.items() if j.key in self.records}
            own = self.plan.design_changes(first.point)
            designs.append(Design(number, first.point, own, quick, len(jobs), records))
        return designs

    @cached_property
    def designs(self) -> list[Design]:
        """The designs on the grid of the study, by number."""
        return [one for one in self.all_designs if one.quick == self.plan.method.quick]

    @cached_property
    def shown(self) -> list[Design]:
        """The designs that the front is made of: those on the front's grid, where it has one."""
        return self._shown(self.all_designs)

    def _shown(self, designs: Sequence[Design]) -> list[Design]:
        method = self.plan.method
        quick = (method.front_grid or method.grid) == "quick"
        return [one for one in designs if one.quick == quick]

    def goal_values(self, designs: Sequence[Design]) -> Array:
        """Return (designs, goals) in SI; nan where a design has no numbers."""
        rows = [
            [
                goal.value(one.records, self.plan.states) if one.usable else math.nan
                for goal in self.plan.goals
            ]
            for one in designs
        ]
        return np.array(rows, dtype=float).reshape(len(designs), len(self.plan.goals))

    def margins(self, designs: Sequence[Design]) -> Array:
        """Return (designs, requirements): by how much each is met, SI; negative where not."""
        rows = [
            [
                each.margin(each.goal.value(one.records, self.plan.states))
                if one.usable
                else math.nan
                for each in self.plan.require
            ]
            for one in designs
        ]
        return np.array(rows, dtype=float).reshape(len(designs), len(self.plan.require))

    def allowed(self, designs: Sequence[Design]) -> Mask:
        """Return which designs have numbers and meet every requirement."""
        usable = np.array([one.usable for one in designs], dtype=bool)
        return usable & (self.margins(designs) >= 0).all(axis=1)

    def front_of(self, designs: Sequence[Design]) -> list[Design]:
        """Return the designs that no other beats in every goal, best in the first goal first."""
        if not self.plan.goals:
            return []
        values, good = self.goal_values(designs) * self.plan.signs, self.allowed(designs)
        kept = [k for k in np.flatnonzero(good).tolist() if not _beaten(values[k], values[good])]
        unique = {tuple(values[k]): k for k in reversed(kept)}
        return [designs[k] for k in sorted(unique.values(), key=lambda k: values[k, 0])]

    @cached_property
    def front(self) -> list[Design]:
        """The front; each of its designs was run in full, in every condition and draw."""
        return self.front_of(self.shown)

    def best(self, count: int = 5) -> list[Design]:
        """Return up to ``count`` designs of the front, spread along it.

        With one goal, the best ones in order.
        """
        if len(self.plan.goals) == 1:
            good = [one for one, ok in zip(self.shown, self.allowed(self.shown), strict=True) if ok]
            values = self.goal_values(good)[:, 0] * self.plan.signs[0]
            return [good[k] for k in np.argsort(values, kind="stable")[:count]]
        places = np.linspace(0, len(self.front) - 1, min(count, len(self.front))).round()
        return [self.front[int(k)] for k in dict.fromkeys(places)]

    def higher_cof(self, first: Design, second: Design) -> float | None:
        """Return the probability that the first design has the higher COF.

        Counted over the draws that both share: condition, uncertain inputs and the friction law's
        own. None where no uncertainty is known.
        """
        laws = {r.law for one in (first, second) for r in one.records.values()}
        values = [
            np.mean([r.number("cof") for r in one.records.values()]) for one in (first, second)
        ]
        spreads = [[r.spreads.get("cof") for r in one.records.values()] for one in (first, second)]
        known = [None if None in row else float(np.mean(np.array(row, float))) for row in spreads]
        return probability_higher(
            (float(values[0]), known[0], first.cof_draws()),
            (float(values[1]), known[1], second.cof_draws()),
            shared=laws == {"pair"},
        )

    # --- how it is shown ---

    @property
    def usable(self) -> bool:
        """Whether any design has numbers."""
        return any(one.usable for one in self.designs)

    @cached_property
    def endings(self) -> Counter[str]:
        """How many cases ended in each way, open ones too."""
        keys = {job.key for job in self.jobs}
        found = Counter(str(self.records[key].ending) for key in keys if key in self.records)
        if left := len(keys) - found.total():
            found["open"] = left
        return found

    def headline(self) -> tuple[str, ...]:
        """Return how far it is, and the best design."""
        total = self.endings.total()
        done = f"{total - self.endings['open']} of {total} cases"
        parts = [f"{count} {name}" for name, count in self.endings.items() if name != "open"]
        sentences = [
            f"{done} of {len(self.all_designs)} designs ended: {', '.join(parts) or 'none'}."
        ]
        if self.plan.goals and self.usable:
            best = self.best(2)
            if not best:
                sentences.append("No design meets every requirement.")
            elif len(self.plan.goals) == 1:
                sentences.append(f"Best: design {best[0].number}, {self._goals_text(best[0])}.")
                if len(best) > 1 and (chance := self.higher_cof(*best)) is not None:
                    sentences.append(
                        f"Its COF is higher than that of design {best[1].number} with a "
                        f"probability of {percent(chance)} (shared draws)."
                    )
            else:
                sentences.append(
                    f"The front has {len(self.front)} designs, each run in full: from "
                    f"{self._goals_text(self.front[0])} to {self._goals_text(self.front[-1])}."
                )
        return tuple(sentences)

    def cautions(self) -> tuple[str, ...]:
        """Return what keeps the numbers from being taken as they are."""
        reasons = list(self.plan.remarks)
        programs = {record.program for record in self.records.values()}
        if programs - {program_hash()[:16], ""}:
            reasons.append(
                f"Cases of {len(programs)} versions of the program are mixed: run the study in a "
                "new folder to compare them."
            )
        lost = sum(self.endings[str(e)] for e in Ending if e is not Ending.COMPUTED)
        if lost:
            reasons.append(f"{lost} cases have no numbers: underfoot study status tells why.")
        if self.plan.method.quick and self.plan.method.front_grid != "standard":
            reasons.append("Coarse grid: use the order of designs; check a chosen one in full.")
        return tuple(reasons)

    def table(self) -> Table:
        """Return the best designs, or the first ones where there is no goal."""
        designs = self.best(MOST_ROWS) if self.plan.goals else self.designs[:MOST_ROWS]
        return self.design_table(designs, "Best designs" if self.plan.goals else "Designs")

    def design_table(self, designs: Sequence[Design], title: str) -> Table:
        """Return inputs and outputs of some designs as people read them."""
        paths = list(dict.fromkeys(path for one in designs for path in one.changes))
        goals = list(self.plan.goals) or [Goal("cof", "1"), Goal("fluid_load", "N")]
        short = [
            ".".join(path.split(".")[-2:]) if _repeats(path, paths) else path.split(".")[-1]
            for path in paths
        ]
        rows = []
        for one in designs:
            inputs = [value_text(path, one.changes.get(path)) for path in paths]
            values = [
                quantity_text(goal.value(one.records, self.plan.states), goal.unit)
                if one.usable
                else one.ending
                for goal in goals
            ]
            rows.append([str(one.number), *inputs, *values])
        return Table(title, ("Design", *short, *map(str, goals)), rows)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return why cases have no numbers, the most frequent reason first."""
        reasons = Counter(r.reason for r in self.records.values() if not r.usable)
        return {"Without numbers": [f"{n} x {text}" for text, n in reasons.most_common()]}

    def to_dict(self) -> dict[str, Any]:
        """Return plain data: endings, and every design with inputs, goals and margins."""
        values, margins = self.goal_values(self.all_designs), self.margins(self.all_designs)
        front = {(one.number, one.quick) for one in self.front}
        return {
            "endings": dict(self.endings),
            "goals": [str(goal) for goal in self.plan.goals],
            "requirements": [str(each) for each in self.plan.require],
            "designs": [
                {
                    "design": one.number,
                    "grid": "quick" if one.quick else "standard",
                    "ending": one.ending,
                    "inputs": dict(one.changes),
                    "goals": row.tolist(),
                    "margins": margin.tolist(),
                    "front": (one.number, one.quick) in front,
                }
                for one, row, margin in zip(self.all_designs, values, margins, strict=True)
            ],
        }

    def to_xarray(self) -> xarray.Dataset:
        """Return every output over (design, condition, draw), with the inputs of each design."""
        import xarray

        designs, plan = self.designs, self.plan
        records = [r for one in designs for r in one.records.values()]
        names = list(dict.fromkeys(name for r in records for name in r.numbers))
        shape = len(designs), len(plan.states), len(plan.draws)
        values = {name: np.full(shape, np.nan) for name in names}
        endings = np.full(shape, "open", dtype=object)
        for k, one in enumerate(designs):
            for (state, draw), record in one.records.items():
                endings[k, state, draw] = str(record.ending)
                for name in names:
                    values[name][k, state, draw] = record.number(name)
        units = {name: unit for r in records for name, unit in r.units.items()}
        dims = ("design", "condition", "draw")
        data: dict[str, Any] = {
            name: (dims, array, {"units": units.get(name, "1")}) for name, array in values.items()
        }
        data["ending"] = (dims, endings.astype(str))
        paths = list(dict.fromkeys(path for one in designs for path in one.changes))
        coordinates: dict[str, Any] = {
            path: ("design", [one.changes.get(path) for one in designs], {"units": unit_at(path)})
            for path in paths
        }
        coordinates |= {"design": [one.number for one in designs]}
        coordinates |= {"condition": [state.label for state in plan.states]}
        return xarray.Dataset(data, coordinates, {"title": plan.name})

    def _goals_text(self, one: Design) -> str:
        values = self.goal_values([one])[0]
        pairs = zip(self.plan.goals, values, strict=True)
        return ", ".join(f"{goal} {quantity_text(value, goal.unit)}" for goal, value in pairs)


def value_text(path: str, value: Any) -> str:
    """Return an input as people read it."""
    if isinstance(value, float):
        return quantity_text(value, unit_at(path))
    return "" if value is None else str(value)


def _repeats(path: str, paths: Sequence[str]) -> bool:
    return sum(other.split(".")[-1] == path.split(".")[-1] for other in paths) > 1


def _beaten(values: Array, others: Array) -> bool:
    """Return whether another is at least as small everywhere and smaller somewhere."""
    return bool(((others <= values).all(axis=1) & (others < values).any(axis=1)).any())
