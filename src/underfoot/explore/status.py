"""How far a study is while it runs, as seen from any process that can read its folder."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from underfoot.core.presentation import Table
from underfoot.core.progress import time_text

from .record import Ending
from .records import Records
from .result import StudyResult
from .scan import DesignScan, scan_cases
from .study import Study

USUAL = (Ending.OPEN, Ending.COMPUTED)
AHEAD = 60.0
"""s by which the clocks of two machines may differ."""
MOST_REASONS = 5000
"""Cases without numbers whose reasons are read."""


@dataclass(frozen=True)
class StudyStatus(StudyResult):
    """A study's result with its progress, throughput and time left at a moment (s since 1970)."""

    kind: ClassVar[str] = "study_status"

    records: Records
    now: float = 0.0

    @cached_property
    def _alive(self) -> list[Any]:
        return [session for session in self.sessions if session["ended"] is None]

    @property
    def working(self) -> int:
        """Workers of the processes that are alive."""
        return sum(one["workers"] for one in self._alive)

    @cached_property
    def scan(self) -> DesignScan:
        """Numbers of all finished cases."""
        return scan_cases(self.records)

    @property
    def case_seconds(self) -> float:
        """Sum over the finished cases of the seconds each took."""
        return float(np.nansum(self.scan.case["seconds"]))

    @cached_property
    def worker_seconds(self) -> float:
        """Time that workers had, all processes together, to now."""
        ends = [(session, session["ended"] or self.now) for session in self.sessions]
        return sum(one["workers"] * max(end - one["began"], 0.0) for one, end in ends)

    @property
    def clock_went_back(self) -> bool:
        """Whether a process began, or ended a case, later than it is now: no rate is known."""
        ended = np.nan_to_num(self.scan.case["ended"])
        latest = max((session["began"] for session in self.sessions), default=0.0)
        return max(latest, float(ended.max(initial=0.0))) > self.now + AHEAD

    @property
    def busy(self) -> float:
        """Share of the workers' time that went into cases."""
        return self.case_seconds / self.worker_seconds if self.worker_seconds else 0.0

    @cached_property
    def _ended(self) -> int:
        """Cases that ended since the processes began that are alive, or were."""
        began = min((one["began"] for one in self._alive or self.sessions), default=self.now)
        return int(np.count_nonzero(self.scan.case["ended"] >= began))

    @cached_property
    def per_minute(self) -> float:
        """Cases that end in a minute, over the processes that are alive, or were."""
        counted = self._alive or self.sessions
        if not counted or self.clock_went_back:
            return 0.0
        began = min(one["began"] for one in counted)
        elapsed = max(one["ended"] or self.now for one in counted) - began
        return 60 * self._ended / max(elapsed, 1e-9)

    @cached_property
    def cases_left(self) -> int:
        """Cases that the study still takes, those not yet proposed with them."""
        plan, total = self.plan, self.endings.total()
        planned = plan.designs * plan.cases_per_design
        ends_with_start = bool(self.jobs) and not self.jobs[-1].point
        if plan.goals and plan.method.again_on and not ends_with_start:
            planned += (min(plan.method.again, plan.designs) + 1) * plan.cases_per_design
        return max(planned, total) - (total - self.endings[Ending.OPEN])

    @property
    def seconds_left(self) -> float | None:
        """Time left at that rate; None before each worker ended a case."""
        known = self._alive and self.per_minute and self._ended >= max(1, self.working)
        return 60 * self.cases_left / self.per_minute if known else None

    @property
    def programs(self) -> Collection[str]:
        """Versions of the program that computed the cases."""
        return self.scan.programs

    def headline(self) -> tuple[str, ...]:
        """Return how far it is, how fast, and when it ends."""
        count, seconds = self.working, self.seconds_left
        at_work = f"{count} worker{'s' * (count > 1)} at work" if count else "Nobody works on it"
        rate = f"{at_work}; {self.per_minute:.3g} cases a minute, workers {self.busy:.0%} busy"
        if not self.per_minute:
            rate = at_work
        left = "" if seconds is None else f", about {time_text(seconds)} left"
        return (f"{self.ended_text(self.cases_left)}.", f"{rate}{left}.")

    def cautions(self) -> tuple[str, ...]:
        """Return what keeps the numbers from being taken as they are."""
        texts = super().cautions()
        if self.clock_went_back:
            texts = (*texts, "The clock was set back as it ran: rates and times are not known.")
        return texts

    @property
    def lost_text(self) -> str:
        """Nothing: the remarks tell why."""
        return ""

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return why cases have no numbers, the most frequent reason first."""
        bad = [key for key in self.keys if self.records.ending(key) not in USUAL]
        reasons = Counter(
            self.records[key].reason for key in bad[:: max(1, -(-len(bad) // MOST_REASONS))]
        )
        title = "Without numbers"
        if len(bad) > reasons.total():
            title += f" ({reasons.total()} of {len(bad)}, evenly taken)"
        return {title: [f"{n} x {text}" for text, n in reasons.most_common()]}

    def table(self) -> Table:
        """Return how many cases ended in each way."""
        rows = [(name, str(count)) for name, count in sorted(self.endings.items())]
        return Table("Cases", ("Ended as", "Number"), rows)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "endings": dict(self.endings),
            "working": self.working,
            "busy": self.busy,
            "cases_per_minute": self.per_minute,
            "seconds_left": self.seconds_left,
            "case_seconds": self.case_seconds,
            "worker_seconds": self.worker_seconds,
        }


def study_status(study: Study) -> StudyStatus:
    """Return how far a study in its folder is."""
    store = study.store
    return StudyStatus(study.plan, store.jobs(), store.records(), store.sessions(), time.time())
