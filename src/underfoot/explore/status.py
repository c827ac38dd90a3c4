"""How far a study is while it runs, as seen from any process that can read its folder."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from underfoot.core.presentation import Presentable, Table

from .result import StudyResult
from .study import Study


@dataclass(frozen=True, slots=True)
class StudyStatus(Presentable):
    """Progress, throughput and failures of a study.

    Attributes:
        working: Workers of the processes that are alive.
        case_seconds: Sum over the finished cases of the seconds each took.
        worker_seconds: Time that workers had, all processes together, to now.
        per_minute: Cases that ended in a minute, over the processes that are alive, or were.
        seconds_left: At that rate, of the cases set so far; None while nothing is known.
    """

    kind: ClassVar[str] = "study_status"

    result: StudyResult
    working: int
    case_seconds: float
    worker_seconds: float
    per_minute: float
    seconds_left: float | None

    def heading(self) -> str:
        """Return the name of the study."""
        return self.result.plan.name

    @property
    def busy(self) -> float:
        """Share of the workers' time that went into cases."""
        return self.case_seconds / self.worker_seconds if self.worker_seconds else 0.0

    def headline(self) -> tuple[str, ...]:
        """Return how far it is, how fast, and when it ends."""
        at_work = f"{self.working} workers at work" if self.working else "nobody works on it"
        rate = f"{at_work}; {self.per_minute:.3g} cases a minute, workers {self.busy:.0%} busy"
        left = "" if self.seconds_left is None else f", about {_time(self.seconds_left)} left"
        return (self.result.headline()[0], f"{rate[0].upper()}{rate[1:]}{left}.")

    def cautions(self) -> tuple[str, ...]:
        """Return those of the result."""
        return self.result.cautions()

    def table(self) -> Table:
        """Return how many cases ended in each way."""
        rows = [(name, str(count)) for name, count in sorted(self.result.endings.items())]
        return Table("Cases", ("Ended as", "Number"), rows)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return why cases have no numbers."""
        return self.result.remarks()

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "endings": dict(self.result.endings),
            "working": self.working,
            "busy": self.busy,
            "cases_per_minute": self.per_minute,
            "seconds_left": self.seconds_left,
            "case_seconds": self.case_seconds,
            "worker_seconds": self.worker_seconds,
        }


def study_status(study: Study) -> StudyStatus:
    """Return how far a study in its folder is."""
    result, now = study.result(), time.time()
    alive = [one for one in result.sessions if one["ended"] is None]
    seconds = sum(record.seconds for record in result.records.values())
    had = sum(one["workers"] * ((one["ended"] or now) - one["began"]) for one in result.sessions)
    counted = alive or result.sessions
    elapsed = max(
        (max(one["ended"] or now for one in counted) - min(one["began"] for one in counted))
        if counted
        else 0.0,
        1e-9,
    )
    began = min((one["began"] for one in counted), default=now)
    ended = sum(record.ended >= began for record in result.records.values())
    rate = ended / elapsed if counted else 0.0
    left = result.endings["open"] / rate if alive and rate else None
    working = sum(one["workers"] for one in alive)
    return StudyStatus(result, working, seconds, had, 60 * rate, left)


def _time(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
