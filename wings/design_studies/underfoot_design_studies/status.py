"""How far a study is while it runs, as seen from any process that can read its folder."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from underfoot.core.presentation import Table
from underfoot.core.progress import time_text

from .record import Ending
from .result import StudyResult
from .study import Study


@dataclass(frozen=True)
class StudyStatus(StudyResult):
    """A study's result with its progress, throughput and time left at a moment (s since 1970)."""

    kind: ClassVar[str] = "study_status"

    now: float = 0.0

    @cached_property
    def _alive(self) -> list[Any]:
        return [one for one in self.sessions if one["ended"] is None]

    @property
    def working(self) -> int:
        """Workers of the processes that are alive."""
        return sum(one["workers"] for one in self._alive)

    @cached_property
    def case_seconds(self) -> float:
        """Sum over the finished cases of the seconds each took."""
        return sum(record.seconds for record in self.records.values())

    @cached_property
    def worker_seconds(self) -> float:
        """Time that workers had, all processes together, to now."""
        ends = [(one, one["ended"] or self.now) for one in self.sessions]
        return sum(one["workers"] * (end - one["began"]) for one, end in ends)

    @property
    def busy(self) -> float:
        """Share of the workers' time that went into cases."""
        return self.case_seconds / self.worker_seconds if self.worker_seconds else 0.0

    @cached_property
    def _ended(self) -> int:
        """Cases that ended since the processes began that are alive, or were."""
        began = min((one["began"] for one in self._alive or self.sessions), default=self.now)
        return sum(record.ended >= began for record in self.records.values())

    @cached_property
    def per_minute(self) -> float:
        """Cases that end in a minute, over the processes that are alive, or were."""
        counted = self._alive or self.sessions
        if not counted:
            return 0.0
        began = min(one["began"] for one in counted)
        elapsed = max(one["ended"] or self.now for one in counted) - began
        return 60 * self._ended / max(elapsed, 1e-9)

    @property
    def seconds_left(self) -> float | None:
        """Time left of the cases set so far, at that rate; None before each worker ended one."""
        known = self._alive and self._ended >= max(1, self.working)
        return 60 * self.endings[Ending.OPEN] / self.per_minute if known else None

    def headline(self) -> tuple[str, ...]:
        """Return how far it is, how fast, and when it ends."""
        at_work = f"{self.working} workers at work" if self.working else "Nobody works on it"
        rate = f"{at_work}; {self.per_minute:.3g} cases a minute, workers {self.busy:.0%} busy"
        seconds = self.seconds_left
        left = "" if seconds is None else f", about {time_text(seconds)} left"
        return (super().headline()[0], f"{rate}{left}.")

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
    result = study.result()
    return StudyStatus(result.plan, result.jobs, result.records, result.sessions, time.time())
