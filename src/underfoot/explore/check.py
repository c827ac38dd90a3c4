"""A study before it runs: how many cases, what they cost, where, which of them can't be built."""

from __future__ import annotations

import math
import shutil
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from underfoot.compute.positions import run_cost
from underfoot.core import InputError
from underfoot.core.pool import available_processors
from underfoot.core.presentation import Presentable, Table
from underfoot.core.progress import time_text
from underfoot.core.remark import NOTHING, Message

from .computing import status_bytes
from .cost import StudyCost, study_cost
from .plan import StudyPlan
from .proposals import first_points
from .result import value_text
from .store import Store

MOST_BUILT = 300
"""Cases that are built to see which can't be; 0.03 s each."""
LONG = 12 * 3600.0
"""s of one machine above which more of them are worth their trouble ..."""
TASK = 2 * 3600.0
"""... and that a task of theirs may take."""
DASK_RATE = 50.0
"""Cases a second that 100 workers, their scheduler and its client finished on one processor
(``UNDERFOOT_BENCH=saturation python -m benchmarks design_studies``)."""


@dataclass(frozen=True, slots=True)
class Computer:
    """What a study finds here: processors, and bytes of memory (0: not known) and of disk."""

    processors: int
    memory: float
    disk: float


def this_machine(folder: Path) -> Computer:
    """Return what is free for a study in a folder, which may not be there yet."""
    place = next(path for path in (folder, *folder.absolute().parents) if path.is_dir())
    memory = status_bytes("/proc/meminfo", "MemAvailable:")
    return Computer(available_processors(), memory, shutil.disk_usage(place).free)


@dataclass(frozen=True, slots=True)
class StudyCheck(Presentable):
    """What a study will take.

    Attributes:
        designs, cases: At most, over the whole study.
        seconds: CPU seconds of all cases together, low and high.
        again, again_seconds: The same of the cases that are run again after those.
        memory: Bytes of a worker.
        built: Cases that were built.
        infeasible: Why cases can't be built: how many of those built.
        ended: Cases that are finished.
        cost: Of a case, from finished ones; None without.
        machine: Where it would run.
    """

    kind: ClassVar[str] = "study_check"

    plan: StudyPlan
    designs: int
    cases: int
    seconds: tuple[float, float]
    again: int
    again_seconds: tuple[float, float]
    memory: float
    built: int
    infeasible: Mapping[str, int]
    ended: int = 0
    cost: StudyCost | None = None
    machine: Computer = field(default_factory=lambda: this_machine(Path()))

    @property
    def cpu_seconds(self) -> float:
        """CPU seconds of all cases together: the estimate, or the middle without one."""
        low, high = self.seconds
        return self.cases * self.cost.cpu_seconds if self.cost else math.sqrt(low * high)

    @property
    def workers(self) -> int:
        """Processes that this machine has processors and memory for."""
        fit = self.machine.memory // self.memory if self.machine.memory else math.inf
        return max(1, int(min(self.machine.processors, fit)))

    @property
    def seconds_left(self) -> float:
        """Time by the clock that the open cases take on this machine."""
        share = max(self.cases - self.ended, 0) / max(self.cases, 1)
        clock = self.cost.seconds / self.cost.cpu_seconds if self.cost else 1.0
        return share * clock * self.cpu_seconds / self.workers

    @property
    def tasks(self) -> int:
        """Tasks of an array job that end in two hours each; 1 where this machine does."""
        if self.seconds_left <= LONG:
            return 1
        return max(2, min(math.ceil(self.seconds_left * self.workers / TASK), self.cases // 10))

    def heading(self) -> str:
        """Return the name of the study."""
        return self.plan.name

    def headline(self) -> tuple[Message, ...]:
        """Return the number of cases and their cost."""
        states, draws = len(self.plan.states), len(self.plan.draws)
        by_state = by_draw = NOTHING
        if states > 1:
            by_state = Message(" x {count} conditions", count=states)
        if draws > 1:
            by_draw = Message(" x {count} draws", count=draws)
        low, high = map(time_text, self.seconds)
        cost = Message("{low} to {high} of one processor", low=low, high=high)
        if self.cost:
            cost = Message(
                "{time} of one processor (95 %: {low} to {high}, by {count} finished cases)",
                time=time_text(self.cpu_seconds), low=low, high=high, count=self.cost.cases,
            )  # fmt: skip
        sentences = [
            Message(
                "{designs} designs{states}{draws}: {cases} cases at most, about {cost}.",
                designs=self.designs, states=by_state, draws=by_draw, cases=self.cases, cost=cost,
            )
        ]  # fmt: skip
        if self.again:
            least, most = map(time_text, self.again_seconds)
            sentences.append(
                Message(
                    "The best {best} and the start are then run again on the {grid} grid: {cases} "
                    "cases at most, about {low} to {high} of one processor.",
                    best=self.plan.method.again, grid=self.plan.method.again_on, cases=self.again,
                    low=least, high=most,
                )
            )  # fmt: skip
        if bad := sum(self.infeasible.values()):
            counts = {"bad": bad, "count": self.built}
            sentences.append(
                Message("{bad} of {count} cases of the first designs can't be built.", **counts)
            )
        else:
            sentences.append(Message("All {count} cases tried can be built.", count=self.built))
        return *sentences, *self._where()

    def _where(self) -> tuple[Message, ...]:
        """Return what the study takes here, and which engine fits."""
        left, disk = Message("All of it"), NOTHING
        if self.ended:
            left = Message("{count} open cases", count=self.cases - self.ended)
        if self.cost:
            disk = Message(", {disk} of disk", disk=size_text(self.cases * self.cost.disk))
        here = Message(
            "{left} on this machine, {workers} {workers:worker|workers} of {memory}: about "
            "{time}{disk}.",
            left=left, workers=self.workers, memory=size_text(self.memory),
            time=time_text(self.seconds_left), disk=disk,
        )  # fmt: skip
        if self.tasks == 1:
            return (here,)
        case = self.cpu_seconds / self.cases
        array = Message(
            "An array job of {tasks} tasks takes about {time}: underfoot study work in each; a "
            "Dask cluster keeps up to {workers} workers busy.",
            tasks=self.tasks, time=time_text(self.seconds_left * self.workers / self.tasks),
            workers=max(1, round(DASK_RATE * case)),
        )  # fmt: skip
        return here, array

    def cautions(self) -> tuple[Message, ...]:
        """Return what reading the file decided, and what this machine lacks."""
        texts = list(self.plan.remarks)
        if not self.cost:
            texts.append(
                Message("The cost is a guess by the size of the grid until a case has ended.")
            )
        elif self.cases * self.cost.disk > self.machine.disk:
            need, free = (size_text(x) for x in (self.cases * self.cost.disk, self.machine.disk))
            texts.append(
                Message("The disk has {free} free, the study takes {need}.", free=free, need=need)
            )
        if self.machine.memory and self.memory > self.machine.memory:
            free = size_text(self.machine.memory)
            needed = size_text(self.memory)
            texts.append(
                Message("A worker takes {needed}, and {free} are free.", needed=needed, free=free)
            )
        return tuple(texts)

    def table(self) -> Table:
        """Return what is varied, uncertain and asked for."""
        plan, rows = self.plan, []
        for one in plan.vary:
            ends = [value_text(one.path, one.value(share)) for share in (0.0, 1.0)]
            options = getattr(one, "options", None)
            listed = [value_text(one.path, option) for option in options or ()]
            rows.append(("vary", one.path, ", ".join(listed) or " to ".join(ends)))
        rows += [("fixed", path, value_text(path, value)) for path, value in plan.fixed.items()]
        rows += [
            ("follows", each.path, Message("{times:g} x {of}", times=each.times, of=each.of))
            for each in plan.follow
        ]
        for each in plan.uncertain:
            ends = [value_text(each.path, each.value(share)) for share in (0.025, 0.975)]
            rows.append(("uncertain", each.path, Message("{ends: to } (95 %)", ends=ends)))
        rows += [("condition", state.label, "") for state in plan.states if state.label]
        rows += [("maximise", str(goal), "") for goal in plan.maximise]
        rows += [("minimise", str(goal), "") for goal in plan.minimise]
        rows += [("require", str(each), "") for each in plan.require]
        return Table("Study", ("", "What", "Range"), rows)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return why cases can't be built or have no numbers, the most frequent reason first."""
        reasons = sorted(self.infeasible.items(), key=lambda one: -one[1])
        lost = self.cost.failures if self.cost else {}
        return {
            "Can't be built": [
                Message("{count} x {reason}", count=count, reason=reason)
                for reason, count in reasons
            ],
            "Without numbers among the finished": [
                Message("{count} x {reason}", count=count, reason=reason)
                for reason, count in lost.items()
            ],
        }

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "designs": self.designs,
            "cases": self.cases,
            "cpu_seconds": list(self.seconds),
            "again": self.again,
            "again_cpu_seconds": list(self.again_seconds),
            "estimate": {
                "cases_timed": self.cost.cases if self.cost else 0,
                "cpu_seconds": self.cpu_seconds,
                "seconds_left": self.seconds_left,
                "workers": self.workers,
                "worker_memory": self.memory,
                "disk": self.cases * self.cost.disk if self.cost else None,
                "array_tasks": self.tasks,
                "failures": dict(self.cost.failures) if self.cost else {},
            },
            "built": self.built,
            "infeasible": dict(self.infeasible),
        }


def study_check(plan: StudyPlan, most: int = MOST_BUILT, store: Store | None = None) -> StudyCheck:
    """Return what a study will take; nothing is computed, about ``most`` cases are built.

    Finished cases of its folder tell the cost.
    """
    designs, method = plan.designs, plan.method
    guess = run_cost(plan.base, quick=method.quick)
    cases = designs * plan.cases_per_design
    again, (least, most_again) = 0, (0.0, 0.0)
    if plan.goals and method.again_on:
        again = (min(method.again, designs) + 1) * plan.cases_per_design
        (job, *_) = plan.jobs(0, (), 0, again=True)
        least, most_again = run_cost(plan.base.replace(job.changes), quick=job.quick).seconds
    reasons: Counter[str] = Counter()
    built = 0
    points = first_points(plan)
    step = max(1, len(points) * plan.cases_per_design // most)
    for number, point in enumerate(points[::step]):
        for job in plan.jobs(number, point, 0):
            built += 1
            try:
                plan.base.replace(job.changes)
            except InputError as error:
                reasons[str(error)] += 1
    cost = study_cost(plan, store) if store else None
    low, high = cost.interval if cost else guess.seconds
    return StudyCheck(
        plan,
        designs,
        cases,
        (low * cases, high * cases),
        again,
        (least * again, most_again * again),
        (cost and cost.memory) or guess.memory,
        built,
        dict(reasons),
        len(store.known) if store else 0,
        cost,
        this_machine(store.folder if store else Path()),
    )


def size_text(size: float) -> str:
    """Return bytes in the unit that people read."""
    for unit, factor in (("GB", 1e9), ("MB", 1e6)):
        if size >= factor:
            return f"{float(f'{size / factor:.2g}'):g} {unit}"
    return f"{size / 1e3:.0f} kB"
