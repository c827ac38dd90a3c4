"""A study in its folder: run it, help with it, look at it; it goes on where it stopped."""

from __future__ import annotations

import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from underfoot.core import InputError, Progress, silent
from underfoot.core.pool import available_processors

from .computing import computed, crashed
from .engines import Engine, engine
from .plan import StudyPlan, load_plan
from .proposals import next_batch
from .record import Job
from .result import StudyResult
from .store import Store

PAUSE = 1.0
"""s between two looks for work while others work."""


class Study:
    """A plan and the folder that its cases are kept in.

    Parameters:
        plan: What is to be done.
        folder: Where; made when the study runs.
    """

    def __init__(self, plan: StudyPlan, folder: Path | str) -> None:
        self.plan = plan
        self.store = Store(folder)

    def __repr__(self) -> str:
        return f"<Study {self.plan.name!r:.80} in {str(self.store.folder)!r:.80}>"

    @classmethod
    def load(cls, path: Path | str, folder: Path | str | None = None) -> Study:
        """Return the study of a file, or of a folder that one runs in.

        Parameters:
            path: The study file or the folder.
            folder: Where a file's study is kept; by default out/NAME.

        Raises:
            InputError: No such file, and everything that is wrong with it.
        """
        path = Path(path)
        if path.is_dir():
            return cls(Store(path).plan(), path)
        return cls(load_plan(path), folder or Path("out") / path.stem)

    def run(
        self, on: str | None = None, workers: int | None = None, progress: Progress = silent
    ) -> StudyResult:
        """Compute what is not finished and return what came of all.

        Parameters:
            on: Engine, as ``engines.engine`` takes it.
            workers: Processes; None for one a processor. With more than one, a script needs
                ``if __name__ == "__main__":`` around its work.
            progress: Receives the share of the cases set so far; an exception that it raises stops
                the study, and what is finished is kept.

        Raises:
            InputError: Another process leads the study.
            DataError: A full disk; what is finished is on it.
        """
        self.store = Store.made(self.store.folder)
        with self.store.leading() as leads:
            if not leads:
                raise InputError(
                    f"the study in {self.store.folder} is being run by {self.store.leader()}",
                    where="STUDY",
                    remedy=f"To help it: underfoot study work {self.store.folder}",
                )
            self.store.adopt(self.plan)
            compute, count = engine(on, workers)
            with self.store.working(count):
                while self._advanced():
                    self._compute_open(compute, progress)
        return self.result()

    def work(self, workers: int | None = 1, progress: Progress = silent) -> int:
        """Take open cases from the folder until the study is done; return how many were computed.

        Any number of processes on any number of machines may do so, with or without one that
        leads: whoever finds nothing open leads for a moment and sets what comes next.
        """
        self.store = Store.made(self.store.folder)
        compute, done = engine(None, workers)[0], 0
        with self.store.leading() as leads:
            if leads:
                self.store.adopt(self.plan)
        with self.store.working(workers or available_processors()):
            while True:
                taken = self._compute_open(compute, progress)
                done += taken
                if taken:
                    continue
                if not self._open():
                    with self.store.leading() as leads:
                        if leads and not self._advanced():
                            return done
                        if leads:
                            continue
                time.sleep(PAUSE)

    def result(self) -> StudyResult:
        """Return what the folder holds now; views of it are not written."""
        sessions = self.store.sessions() if self.store.exists else []
        return StudyResult(self.plan, self.store.jobs(), dict(self.store.records()), sessions)

    def _advanced(self) -> bool:
        """Return whether anything is open, after setting the next batch where nothing was."""
        if self._open():
            return True
        jobs = self.store.jobs()
        new = next_batch(self.plan, StudyResult(self.plan, jobs, self.store.records()))
        self.store.add_jobs(new)
        return bool(new)

    def _open(self) -> list[Job]:
        records = self.store.records()
        return list({job.key: job for job in self.store.jobs() if job.key not in records}.values())

    def _compute_open(self, compute: Engine, progress: Progress) -> int:
        """Compute the open cases that nobody else does; return how many."""
        jobs, count = self._open(), 0
        total = len({job.key for job in self.store.jobs()})
        for record in compute(partial(computed, self.plan.base), self._claimed(jobs), crashed):
            self.store.add_record(record)
            count += 1
            progress(self._stage(), len(self.store.records()) / max(total, 1))
        if jobs and not count:
            time.sleep(PAUSE)
        return count

    def _claimed(self, jobs: list[Job]) -> Iterator[Job]:
        claimed = []
        try:
            for job in jobs:
                if job.key in self.store.records() or not self.store.claim(job.key):
                    continue
                claimed.append(job.key)
                if job.key in self.store.records():  # finished between the look and the claim
                    self.store.release(job.key)
                    continue
                yield job
        finally:
            for key in claimed:
                if key not in self.store.records():
                    self.store.release(key)

    def _stage(self) -> str:
        failed = sum(not record.usable for record in self.store.records().values())
        return "Cases" + (f", {failed} without numbers" if failed else "")
