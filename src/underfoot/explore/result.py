"""What came of a study: its designs with their goals, the front, and how sure their order is.

A run has noise: its grid, and where the lugs of a tread lie. The best of many runs is then the
luckiest. So designs are ranked by what their surrogate believes of them, a mean over the noise of
all runs, and the best are run again on new positions of the tread.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case import unit_at
from underfoot.core import DataError
from underfoot.core.arrays import Array, Mask
from underfoot.core.deprecation import renamed_member
from underfoot.core.presentation import Presentable, Table, quantity_text
from underfoot.core.remark import NOTHING, Message, join_lines
from underfoot.friction.propagation import probability_higher

from .goals import AnyGoal, Goal, output_array
from .jobs import BatchJobs
from .plan import StudyPlan
from .record import CaseJob, Ending, Record, program
from .records import Records
from .surrogate import FEWEST, Surrogate, fit_surrogate

if TYPE_CHECKING:
    import xarray
    from pandas import DataFrame

PLACE = ("design", "condition", "draw", "grid", "ending")
MOST_ROWS = 12
"""Designs of a table on the terminal."""
DECIDED = 0.95
"""Share of draws from which on a design is said to be above the start."""


class DesignRecords(Mapping[tuple[int, int], Record]):
    """The records of a design by (condition, draw), each read when it is asked for."""

    def __init__(self, keys: Mapping[tuple[int, int], str], records: Mapping[str, Record]) -> None:
        self._keys, self._records = keys, records

    def __getitem__(self, place: tuple[int, int]) -> Record:
        key = self._keys[place]
        return self._records.get(key) or Record(key, Ending.OPEN)

    def ending(self, place: tuple[int, int]) -> Ending:
        """Return how a case ended; in a study on disk nothing is read for it."""
        if isinstance(self._records, Records):
            return self._records.ending(self._keys[place])
        return self[place].ending

    @property
    def key(self) -> str:
        """Of its first case."""
        return next(iter(self._keys.values()))

    def __iter__(self) -> Iterator[tuple[int, int]]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)


ENDED: dict[str, Message] = {
    Ending.COMPUTED: Message("computed"),
    Ending.NOT_CONVERGED: Message("not converged"),
    Ending.INFEASIBLE: Message("infeasible"),
    Ending.CRASHED: Message("crashed"),
    Ending.FAILED: Message("failed"),
}
"""What is said of a case that ended so."""


@dataclass(frozen=True, slots=True)
class Design:
    """One design: what it changes, and its records by (condition, draw), open ones too.

    ``again`` tells a second run of it, on new positions of the tread and the grid for that.
    """

    number: int
    point: tuple[float, ...]
    changes: Mapping[str, Any]
    quick: bool
    again: bool
    records: DesignRecords

    @property
    def usable(self) -> bool:
        """Whether every case of it has numbers."""
        return self.ending == Ending.COMPUTED

    @property
    def ending(self) -> str:
        """How it ended: computed, or what kept the first of its cases from it."""
        endings = map(self.records.ending, self.records)
        return str(
            next((ending for ending in endings if ending != Ending.COMPUTED), Ending.COMPUTED)
        )

    @property
    def reason(self) -> str:
        """Why it has no numbers."""
        bad = (place for place in self.records if self.records.ending(place) != Ending.COMPUTED)
        return next((self.records[place].reason for place in bad), "")

    @property
    def states(self) -> list[int]:
        """The conditions that it was run in."""
        return sorted({state for state, _ in self.records})

    def cof_draws(self, states: Sequence[int]) -> Array | None:
        """Return (conditions x draws x law's draws,) joint draws of COF; None without."""
        if not self.usable or any(r.draws.size == 0 for r in self.records.values()):
            return None
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
    jobs: Sequence[CaseJob]
    records: Mapping[str, Record]
    sessions: Sequence[Mapping[str, Any]] = ()

    def __repr__(self) -> str:
        return f"<StudyResult {self.plan.name!r:.80}: {len(self.designs)} designs>"

    def heading(self) -> str:
        """Return the name of the study."""
        return self.plan.name

    def record(self, job: CaseJob) -> Record:
        """Return what came of a job; where nothing did yet, that it is open."""
        return self.records.get(job.key) or Record(job.key, Ending.OPEN)

    @cached_property
    def all_designs(self) -> list[Design]:
        """Every design by number, after its first run the second."""
        keys: dict[tuple[int, int], dict[tuple[int, int], str]] = {}
        first: dict[tuple[int, int], CaseJob] = {}
        for job in self.jobs:
            run = job.design, job.batch
            keys.setdefault(run, {})[job.condition, job.draw] = job.key
            first.setdefault(run, job)
        return self._designs_of(first.values(), keys)

    def _designs_of(
        self, jobs: Iterable[CaseJob], keys: Mapping[tuple[int, int], Mapping[tuple[int, int], str]]
    ) -> list[Design]:
        """Return the designs of a job each; ``keys`` are those of all, by (design, batch)."""
        first = {(job.design, job.batch): job for job in jobs}
        begun = dict(sorted(keys, reverse=True))
        return [
            Design(
                number,
                first[number, batch].point,
                self.plan.design_changes(first[number, batch].point),
                first[number, batch].quick,
                batch != begun[number] or not first[number, batch].point,
                DesignRecords(keys[number, batch], self.records),
            )
            for number, batch in sorted(keys)
        ]

    @cached_property
    def designs(self) -> list[Design]:
        """The first run of every design, by number."""
        return [design for design in self.all_designs if not design.again]

    @cached_property
    def start(self) -> Design | None:
        """The base case as it is, run beside the best designs; None before."""
        return next(
            (design for design in self.all_designs if not design.point and design.usable), None
        )

    @cached_property
    def again(self) -> list[Design]:
        """The second run of those that had one, and have numbers."""
        return [
            design for design in self.all_designs if design.again and design.point and design.usable
        ]

    @cached_property
    def shown(self) -> list[Design]:
        """The last run of every design; those run again alone where no surrogate joins both."""
        if self.again and sum(design.usable for design in self.designs) < FEWEST * len(
            self.plan.vary
        ):
            return self.again
        last = {design.number: design for design in self.again}
        return [last.get(design.number, design) for design in self.designs]

    def values(self, designs: Sequence[Design], goals: Sequence[AnyGoal]) -> Array:
        """Return (designs, goals) in SI; nan where a design has no numbers."""
        rows = [
            [
                goal.value(design.records, self.plan.states) if design.usable else math.nan
                for goal in goals
            ]
            for design in designs
        ]
        return np.array(rows, dtype=float).reshape(len(designs), len(goals))

    def goal_values(self, designs: Sequence[Design]) -> Array:
        """Return (designs, goals) of the plan's goals, as ``values``."""
        return self.values(designs, self.plan.goals)

    def surrogates(self, goals: Sequence[AnyGoal]) -> list[Surrogate]:
        """Return the surrogate of each goal over what is varied, from all runs of designs.

        Raises:
            DataError: Too few usable runs.
        """
        return [self._surrogate(goal) for goal in goals]

    def _surrogate(self, goal: AnyGoal) -> Surrogate:
        if goal not in self._fitted:
            known = [design for design in self.all_designs if design.point and design.usable]
            runs = list({design.records.key: design for design in reversed(known)}.values())[::-1]
            dimensions = self.plan.dimensions
            points = np.array([run.point for run in runs]).reshape(len(runs), len(dimensions))
            errors = np.array([goal.error(run.records, self.plan.states) for run in runs])
            finer = np.array([run.again for run in runs], dtype=bool)
            own = points, self.values(runs, [goal])[:, 0], errors, finer
            self._fitted[goal] = fit_surrogate(str(goal), goal.unit, dimensions, *own)
        return self._fitted[goal]

    @cached_property
    def _fitted(self) -> dict[AnyGoal, Surrogate]:
        return {}

    def goal_estimates(
        self, designs: Sequence[Design], goals: Sequence[AnyGoal]
    ) -> tuple[Array, Array]:
        """Return mean and standard deviation (designs, goals) of what runs scatter about, SI.

        By the surrogate of all runs, on the finest grid; nan where a design has no numbers. An
        output without numerical error is as it was run, and so is any where runs are too few for a
        surrogate, with an unknown deviation (nan).
        """
        means = self.values(designs, goals)
        deviations = np.full_like(means, np.nan)
        points = np.array([design.point for design in designs])
        for k, goal in enumerate(goals):
            errors = [
                goal.error(design.records, self.plan.states) for design in designs if design.usable
            ]
            if not np.any(errors):  # not of nan
                deviations[:, k] = 0.0
                continue
            with suppress(DataError):
                mean, deviation = self._surrogate(goal).prediction(points, noise=False)
                known = np.isfinite(means[:, k])
                means[known, k], deviations[known, k] = mean[known], deviation[known]
        return means, deviations

    believed = renamed_member("believed", "goal_estimates", gone="0.4")

    def margins(self, designs: Sequence[Design]) -> Array:
        """Return (designs, requirements): by how much each is met, SI; negative where not.

        As run or as believed, whichever is less.
        """
        goals = [each.goal for each in self.plan.require]
        both = zip(
            self.values(designs, goals).T, self.goal_estimates(designs, goals)[0].T, strict=True
        )
        columns = [
            np.minimum(each.margin(run), each.margin(believed))
            for each, (run, believed) in zip(self.plan.require, both, strict=True)
        ]
        return np.array(columns, dtype=float).reshape(len(goals), len(designs)).T

    def meets_requirements(self, designs: Sequence[Design]) -> Mask:
        """Return which designs have numbers and meet every requirement."""
        usable = np.array([design.usable for design in designs], dtype=bool)
        return usable & (self.margins(designs) >= 0).all(axis=1)

    allowed = renamed_member("allowed", "meets_requirements", gone="0.4")

    def front_of(self, designs: Sequence[Design]) -> list[Design]:
        """Return the designs that no other beats in every goal, best in the first goal first."""
        if not self.plan.goals:
            return []
        values = self.goal_estimates(designs, self.plan.goals)[0] * self.plan.signs
        return [designs[k] for k in front_places(values, self.meets_requirements(designs))]

    @cached_property
    def front(self) -> list[Design]:
        """The front; each of its designs was run in full, in every condition and draw."""
        return self.front_of(self.shown)

    def best(self, count: int = 5) -> list[Design]:
        """Return up to ``count`` designs of the front, spread along it.

        With one goal, the best ones in order. Of those that were run again, where any were.
        """
        runs = self.again or self.designs
        if len(self.plan.goals) == 1:
            good = [run for run, ok in zip(runs, self.meets_requirements(runs), strict=True) if ok]
            values = self.goal_estimates(good, self.plan.goals)[0][:, 0] * self.plan.signs[0]
            return [good[k] for k in np.argsort(values, kind="stable")[:count]]
        front = self.front_of(runs)
        places = np.linspace(0, len(front) - 1, min(count, len(front))).round()
        return [front[int(k)] for k in dict.fromkeys(places)]

    def higher_cof(
        self, first: Design, second: Design, states: Sequence[int] | None = None
    ) -> float | None:
        """Return the probability that the first design has the higher COF in some conditions.

        Counted over the draws that both share: condition, uncertain inputs and the friction law's
        own; the numerical errors of both and the error of the tread model are in them. None where
        no uncertainty is known.
        """
        states = first.states if states is None else states
        both = [
            [r for (state, _), r in design.records.items() if state in states]
            for design in (first, second)
        ]
        values = [float(np.mean([r.number("cof") for r in records])) for records in both]
        spreads = [[r.spreads.get("cof") for r in records] for records in both]
        known = [None if None in row else float(np.mean(np.array(row, float))) for row in spreads]
        return probability_higher(
            (values[0], known[0], first.cof_draws(states)),
            (values[1], known[1], second.cof_draws(states)),
            shared={r.law for records in both for r in records} == {"pair"},
        )

    def above_start(self) -> Message:
        """Return in a sentence whether a design run again has a higher COF than the start.

        In every condition, with ``DECIDED`` of the draws; empty where the start was not run.
        """
        if self.start is None:
            return NOTHING
        chances = {}
        for design, ok in zip(self.again, self.meets_requirements(self.again), strict=True):
            each = [
                self.higher_cof(design, self.start, [state]) for state in design.states * bool(ok)
            ]
            known = [chance for chance in each if chance is not None]
            if known and len(known) == len(each):
                chances[design.number] = min(known)
        if not chances:
            return Message("Whether a design has a higher COF than the start is not estimated.")
        number = max(chances, key=chances.__getitem__)
        labels = [state.label for state in self.plan.states if state.label]
        where = NOTHING
        if labels:
            where = Message(" in each condition ({labels:; })", labels=labels)
        values = {"number": number, "share": of_100(chances[number]), "where": where}
        if chances[number] >= DECIDED:
            return Message(
                "Design {number} has a higher COF than the start in {share} draws{where}; the "
                "errors of the tread model and of the runs are in the draws.",
                **values,
            )
        return Message(
            "No design has a higher COF than the start in {decided} draws{where}: at most in "
            "{share} (design {number}); the errors of the tread model and of the runs are in the "
            "draws.",
            **values, decided=of_100(DECIDED),
        )  # fmt: skip

    # --- how it is shown ---

    @property
    def usable(self) -> bool:
        """Whether any design has numbers."""
        return any(design.usable for design in self.designs)

    @property
    def keys(self) -> Sequence[str]:
        """Keys of the cases that were set so far, in order."""
        return (
            self.jobs.keys if isinstance(self.jobs, BatchJobs) else [job.key for job in self.jobs]
        )

    @cached_property
    def endings(self) -> Counter[str]:
        """How many cases ended in each way, open ones too."""
        keys = dict.fromkeys(self.keys)  # each once, in the order that they lie in memory
        if isinstance(self.records, Records):
            return Counter(self.records.endings_of(keys))
        known = {key: self.records[key].ending for key in keys.keys() & self.records.keys()}
        return Counter(str(known.get(key, Ending.OPEN)) for key in keys)

    def ended_text(self, left: int, of: Message | None = None) -> Message:
        """Return how many cases ended and how, where ``left`` are open; ``of`` names the cases."""
        ended = {name: n for name, n in self.endings.items() if name != Ending.OPEN}
        done = sum(ended.values())
        parts = [
            Message("{count} {name}", count=n, name=ENDED.get(name, name))
            for name, n in ended.items()
        ]
        return Message(
            "{done} of {all} {cases} ended: {parts}",
            done=done, all=done + left, cases=of or Message("cases"),
            parts=parts or Message("none"),
        )  # fmt: skip

    def headline(self) -> tuple[Message, ...]:
        """Return how far it is, and the best design."""
        of = Message("cases of {count} designs", count=len(self.designs))
        ended = self.ended_text(self.endings[Ending.OPEN], of)
        sentences = [Message("{ended}.", ended=ended)]
        if self.plan.goals and self.usable:
            best = self.best(2)
            if not best:
                unmet = self._unmet_text()
                sentences.append(
                    Message("No design meets every requirement: {unmet}.", unmet=unmet)
                )
            elif len(self.plan.goals) == 1:
                goals = {"number": best[0].number, "goals": self._goals_text(best[0])}
                sentences.append(Message("Best: design {number}, {goals}.", **goals))
                if len(best) > 1 and (chance := self.higher_cof(best[0], best[1])) is not None:
                    sentences.append(
                        Message(
                            "Its COF is higher than that of design {number} in {share} draws that "
                            "both share.",
                            number=best[1].number,
                            share=of_100(chance),
                        )
                    )
            else:
                sentences.append(
                    Message(
                        "The front has {count} designs, each run in full: from {first} to {last}.",
                        count=len(self.front),
                        first=self._goals_text(self.front[0]),
                        last=self._goals_text(self.front[-1]),
                    )
                )
            sentences += filter(None, [self.above_start()])
        return tuple(sentences)

    @property
    def programs(self) -> Collection[str]:
        """Versions of the program that computed the cases."""
        return {record.program for record in self.records.values()} - {""}

    def _unmet_text(self) -> Message:
        """Return which requirements no design meets, and how near one comes."""
        designs = [design for design in self.all_designs if design.point and design.usable]
        texts = []
        for each, margins in zip(self.plan.require, self.margins(designs).T, strict=True):
            margins = np.nan_to_num(margins, nan=-np.inf)
            nearest = int(np.argmax(margins))
            if margins[nearest] < 0:
                value = quantity_text(each.bound + each.sense * margins[nearest], each.goal.unit)
                texts.append(
                    Message(
                        "{requirement} is {value} at best (design {number})",
                        requirement=str(each), value=value, number=designs[nearest].number,
                    )
                )  # fmt: skip
        return join_lines(texts) if texts else Message("some meet each, none meets all")

    @property
    def lost_text(self) -> Message:
        """How many cases have no numbers, and where to look why."""
        lost = self.endings.total() - self.endings[Ending.COMPUTED] - self.endings[Ending.OPEN]
        if not lost:
            return NOTHING
        return Message(
            "{count} {count:case has|cases have} no numbers: underfoot study status tells why.",
            count=lost,
        )

    def cautions(self) -> tuple[Message, ...]:
        """Return what keeps the numbers from being taken as they are."""
        reasons = list(self.plan.remarks)
        programs = self.programs
        if set(programs) - {program()}:
            older = Message(
                "The cases were computed by another version of the program: run the study in a new "
                "folder to have all by this one."
            )
            mixed = Message(
                "Cases of {count} versions of the program are mixed: run the study in a new folder "
                "to have all by this one.",
                count=len(programs),
            )
            reasons.append(mixed if len(programs) > 1 else older)
        reasons += filter(None, [self.lost_text])
        same = 0
        if self.jobs and not self.jobs[-1].point and not self.plan.again_is_the_same:
            first = {design.records.key for design in self.designs}
            same = sum(design.records.key in first for design in self.again)
        if same:
            reasons.append(
                Message(
                    "{same} of the {count} best designs were not run again: on the same grid a "
                    "sole without lugs, or one position of a tread, gives the same run. The best "
                    "may be the luckiest: check it with a smaller numerics.grid_spacing.",
                    same=same,
                    count=len(self.again),
                )
            )
        if self.plan.method.quick and self.plan.method.again_on != "standard":
            reasons.append(
                Message("Coarse grid: use the order of designs; check a chosen one in full.")
            )
        return tuple(reasons)

    def table(self) -> Table:
        """Return the best designs, or the first ones where there is no goal."""
        designs = self.best(MOST_ROWS) if self.plan.goals else self.designs[:MOST_ROWS]
        return self.design_table(designs, "Best designs" if self.plan.goals else "Designs")

    def design_table(self, designs: Sequence[Design], title: str) -> Table:
        """Return inputs and outputs of some designs as people read them."""
        paths = list(dict.fromkeys(path for design in designs for path in design.changes))
        goals = list(self.plan.goals) or [Goal("cof", "1"), Goal("fluid_load", "N")]
        short = [
            ".".join(path.split(".")[-2:]) if _repeats(path, paths) else path.split(".")[-1]
            for path in paths
        ]
        rows = []
        units = [goal.unit for goal in goals]
        for design, *values in zip(designs, *self.goal_estimates(designs, goals), strict=True):
            inputs = [value_text(path, design.changes.get(path)) for path in paths]
            texts = (
                map(_goal_text, *values, units) if design.usable else [design.ending] * len(goals)
            )
            rows.append([str(design.number), *inputs, *texts])
        return Table(title, ("Design", *short, *(goal.phrase for goal in goals)), rows)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return why cases have no numbers, the most frequent reason first."""
        reasons = Counter(r.reason for r in self.records.values() if not r.usable)
        return {
            "Without numbers": [
                Message("{count} x {reason}", count=n, reason=text)
                for text, n in reasons.most_common()
            ]
        }

    def to_dict(self) -> dict[str, Any]:
        """Return plain data: endings, and every run of a design with inputs, goals and margins.

        Goals as they were run, and what is believed of them with its standard deviation.
        """
        runs = [design for design in self.all_designs if design.point]
        values, margins = self.goal_values(runs), self.margins(runs)
        believed, deviations = self.goal_estimates(runs, self.plan.goals)
        front = {(design.number, design.again) for design in self.front}
        return {
            "endings": dict(self.endings),
            "goals": [str(goal) for goal in self.plan.goals],
            "requirements": [str(each) for each in self.plan.require],
            "designs": [
                {
                    "design": run.number,
                    "grid": "quick" if run.quick else "standard",
                    "ending": run.ending,
                    "inputs": dict(run.changes),
                    "again": run.again,
                    "goals": rows[0].tolist(),
                    "believed": rows[1].tolist(),
                    "believed_sd": rows[2].tolist(),
                    "margins": rows[3].tolist(),
                    "front": (run.number, run.again) in front,
                }
                for run, *rows in zip(runs, values, believed, deviations, margins, strict=True)
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
        """Return every output of first runs over (design, condition, draw), with their inputs."""
        frame, plan = self.cases(), self.plan
        units = {name: r.units.get(name, "1") for r in self.records.values() for name in r.numbers}
        place, numbers = list(PLACE[:3]), [design.number for design in self.designs]
        first = frame["design"].isin(numbers) & ~frame[place].duplicated()
        own = frame[first].set_index(place)
        table = own[[*units, "ending"]].astype(dict.fromkeys(units, float)).to_xarray()
        for name, unit in units.items():
            table[name].attrs["units"] = unit
        paths = dict.fromkeys(path for design in self.designs for path in design.changes)
        inputs = {
            path: (
                "design",
                [design.changes[path] for design in self.designs],
                {"units": unit_at(path)},
            )
            for path in paths
        }
        labels = [plan.states[k].label for k in table["condition"].values]
        table = table.assign_coords({"condition": labels, **inputs})
        return table.assign(ending=table["ending"].astype(str)).assign_attrs(title=plan.name)

    def _goals_text(self, design: Design) -> list[Message]:
        means, deviations = self.goal_estimates([design], self.plan.goals)
        return [
            Message(
                "{phrase} {value}",
                phrase=goal.phrase, value=_goal_text(mean, deviation, goal.unit),
            )
            for goal, mean, deviation in zip(self.plan.goals, means[0], deviations[0], strict=True)
        ]  # fmt: skip


def of_100(share: float) -> Message:
    """Return a share of draws as "n of 100", rounded down."""
    return Message("{count} of 100", count=math.floor(100 * share + 1e-9))


def _goal_text(value: float, deviation: float, unit: str) -> str:
    return quantity_text(value, unit, deviation if deviation > 0 else None)


def value_text(path: str, value: Any) -> str:
    """Return an input as people read it."""
    if isinstance(value, float):
        return quantity_text(value, unit_at(path))
    return "" if value is None else str(value)


def _repeats(path: str, paths: Sequence[str]) -> bool:
    return sum(other.split(".")[-1] == path.split(".")[-1] for other in paths) > 1


def front_places(values: Array, allowed: Mask) -> list[int]:
    """Return which rows of goals to be small no allowed one beats, the least in the first first.

    One beats another that is at least as small in every goal and smaller in one; of equal rows the
    first is taken, and none with a goal that is not determined.
    """
    left = np.flatnonzero(allowed & np.isfinite(values).all(axis=1))
    left = left[np.lexsort(values[left].T[::-1])]  # nobody is beaten by one that comes later
    front = []
    while len(left):
        front.append(int(left[0]))
        left = left[(values[left] < values[left[0]]).any(axis=1)]
    return front
