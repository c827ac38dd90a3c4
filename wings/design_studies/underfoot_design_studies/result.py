"""What came of a study: its designs with their goals, the front, and how sure their order is."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case import unit_at
from underfoot.core.arrays import Array, Mask
from underfoot.core.presentation import Presentable, Table, percent, quantity_text
from underfoot.friction.propagation import probability_higher

from .goals import AnyGoal, Goal, output_array
from .jobs import Jobs
from .plan import StudyPlan
from .record import Ending, Job, Record, program
from .records import Records

if TYPE_CHECKING:
    import xarray
    from pandas import DataFrame

PLACE = ("design", "condition", "draw", "grid", "ending")
MOST_ROWS = 12
"""Designs of a table on the terminal."""


class DesignRecords(Mapping[tuple[int, int], Record]):
    """The records of a design by (condition, draw), each read when it is asked for."""

    def __init__(self, keys: Mapping[tuple[int, int], str], records: Mapping[str, Record]) -> None:
        self._keys, self._records = keys, records

    def __getitem__(self, place: tuple[int, int]) -> Record:
        key = self._keys[place]
        return self._records.get(key) or Record(key, Ending.OPEN)

    def __iter__(self) -> Iterator[tuple[int, int]]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)


@dataclass(frozen=True, slots=True)
class Design:
    """One design: what it changes, and its records by (condition, draw), open ones too."""

    number: int
    point: tuple[float, ...]
    changes: Mapping[str, Any]
    quick: bool
    records: Mapping[tuple[int, int], Record]

    @property
    def usable(self) -> bool:
        """Whether every case of it has numbers."""
        return all(record.usable for record in self.records.values())

    @property
    def ending(self) -> str:
        """How it ended: computed, or what kept the first of its cases from it."""
        bad = (record.ending for record in self.records.values() if not record.usable)
        return str(next(bad, Ending.COMPUTED))

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

    def record(self, job: Job) -> Record:
        """Return what came of a job; where nothing did yet, that it is open."""
        return self.records.get(job.key) or Record(job.key, Ending.OPEN)

    @cached_property
    def all_designs(self) -> list[Design]:
        """Every design on every grid, in the order in which they were set."""
        keys: dict[tuple[int, bool], dict[tuple[int, int], str]] = {}
        points: dict[int, tuple[float, ...]] = {}
        for job in self.jobs:
            keys.setdefault((job.design, job.quick), {})[job.condition, job.draw] = job.key
            points[job.design] = job.point
        return [
            Design(
                number,
                points[number],
                self.plan.design_changes(points[number]),
                quick,
                DesignRecords(keys[number, quick], self.records),
            )
            for number, quick in sorted(keys)
        ]

    @cached_property
    def designs(self) -> list[Design]:
        """The designs on the grid of the study, by number."""
        return [one for one in self.all_designs if one.quick == self.plan.method.quick]

    @cached_property
    def shown(self) -> list[Design]:
        """The designs that the front is made of: those on the front's grid, where it has one."""
        quick = (self.plan.method.front_grid or self.plan.method.grid) == "quick"
        return [one for one in self.all_designs if one.quick == quick]

    def values(self, designs: Sequence[Design], goals: Sequence[AnyGoal]) -> Array:
        """Return (designs, goals) in SI; nan where a design has no numbers."""
        rows = [
            [
                goal.value(one.records, self.plan.states) if one.usable else math.nan
                for goal in goals
            ]
            for one in designs
        ]
        return np.array(rows, dtype=float).reshape(len(designs), len(goals))

    def goal_values(self, designs: Sequence[Design]) -> Array:
        """Return (designs, goals) of the plan's goals, as ``values``."""
        return self.values(designs, self.plan.goals)

    def margins(self, designs: Sequence[Design]) -> Array:
        """Return (designs, requirements): by how much each is met, SI; negative where not."""
        values = self.values(designs, [each.goal for each in self.plan.require])
        columns = [
            each.margin(column) for each, column in zip(self.plan.require, values.T, strict=True)
        ]
        return np.array(columns, dtype=float).reshape(values.shape[::-1]).T

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
        keys = set(self.jobs.keys if isinstance(self.jobs, Jobs) else (j.key for j in self.jobs))
        if isinstance(self.records, Records):
            return Counter(self.records.endings_of(keys))
        known = {key: self.records[key].ending for key in keys & self.records.keys()}
        return Counter(str(known.get(key, Ending.OPEN)) for key in keys)

    def headline(self) -> tuple[str, ...]:
        """Return how far it is, and the best design."""
        total = self.endings.total()
        done = f"{total - self.endings[Ending.OPEN]} of {total} cases"
        parts = [f"{count} {name}" for name, count in self.endings.items() if name != Ending.OPEN]
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
        programs = {record.program for record in self.records.values()} - {""}
        if programs - {program()}:
            mixed = f"Cases of {len(programs)} versions of the program are mixed"
            older = "The cases were computed by another version of the program"
            advice = "run the study in a new folder to have all by this one"
            reasons.append(f"{mixed if len(programs) > 1 else older}: {advice}.")
        lost = self.endings.total() - self.endings[Ending.COMPUTED] - self.endings[Ending.OPEN]
        if lost:
            have = "1 case has" if lost == 1 else f"{lost} cases have"
            reasons.append(f"{have} no numbers: underfoot study status tells why.")
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
        for one, values in zip(designs, self.values(designs, goals), strict=True):
            inputs = [value_text(path, one.changes.get(path)) for path in paths]
            units = [goal.unit for goal in goals]
            texts = map(quantity_text, values, units) if one.usable else [one.ending] * len(goals)
            rows.append([str(one.number), *inputs, *texts])
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

    def cases(self) -> DataFrame:
        """Return a row a case: its place in the study, inputs and outputs in SI, how it ended."""
        import pandas

        rows: list[dict[str, Any]] = []
        inputs: dict[str, None] = {}
        outputs: dict[str, None] = {}
        for job in self.jobs:
            record, grid = self.record(job), "quick" if job.quick else "standard"
            row = {name: getattr(job, name) for name in ("design", "condition", "draw")}
            row |= {"grid": grid, "ending": str(record.ending), **job.changes}
            for name, value in record.numbers.items():
                row |= {name: value, f"{name} sd": record.spreads.get(name)}
                outputs |= dict.fromkeys((name, f"{name} sd"))
            inputs |= dict.fromkeys(job.changes)
            rows.append(row | {"seconds": record.seconds, "reason": record.reason, "key": job.key})
        columns = (*PLACE, *inputs, *outputs, "seconds", "reason", "key")
        return pandas.DataFrame(rows, columns=list(columns))

    def to_xarray(self) -> xarray.Dataset:
        """Return every output over (design, condition, draw), with the inputs of each design."""
        frame, plan = self.cases(), self.plan
        units = {name: r.units.get(name, "1") for r in self.records.values() for name in r.numbers}
        own = frame[frame["grid"] == plan.method.grid].set_index(list(PLACE[:3]))
        table = own[[*units, "ending"]].astype(dict.fromkeys(units, float)).to_xarray()
        for name, unit in units.items():
            table[name].attrs["units"] = unit
        paths = dict.fromkeys(path for one in self.designs for path in one.changes)
        inputs = {
            path: ("design", [one.changes[path] for one in self.designs], {"units": unit_at(path)})
            for path in paths
        }
        labels = [plan.states[k].label for k in table["condition"].values]
        table = table.assign_coords({"condition": labels, **inputs})
        return table.assign(ending=table["ending"].astype(str)).assign_attrs(title=plan.name)

    def _goals_text(self, design: Design) -> str:
        values = self.goal_values([design])[0]
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
