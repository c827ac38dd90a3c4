"""A study in its folder: run it, help with it, look at it; it goes on where it stopped."""

from __future__ import annotations

import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from underfoot.core import InputError, Progress, nearest_match, silent

from .computing import computed, crashed
from .engines import Engine, engine
from .plan import StudyPlan
from .proposals import next_batch
from .record import Job
from .result import StudyResult
from .store import Store
from .study_file import load_plan

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
        self._total = 0

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
        if not path.exists():
            raise InputError(
                f"there is no study {path}",
                where="STUDY",
                allowed="a study file, or the folder that underfoot study run made of it",
                nearest=nearest_match(path.name, [one.name for one in path.parent.glob("*")]),
            )
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
            self._compute(compute, count, progress, leads=True)
        return self.result()

    def work(self, workers: int | None = 1, progress: Progress = silent) -> int:
        """Take open cases from the folder until the study is done; return how many were computed.

        Any number of processes on any number of machines may do so, with or without one that
        leads: whoever finds nothing open leads for a moment and sets what comes next.
        """
        self.store = Store.made(self.store.folder)
        with self.store.leading() as leads:
            if leads:
                self.store.adopt(self.plan)
        return self._compute(*engine(None, workers), progress, leads=False)

    def result(self) -> StudyResult:
        """Return what the folder holds now; views of it are not written."""
        sessions = self.store.sessions() if self.store.exists else []
        return StudyResult(self.plan, self.store.jobs(), dict(self.store.records()), sessions)

    def _compute(self, compute: Engine, workers: int, progress: Progress, *, leads: bool) -> int:
        """Compute what nobody else does until the study is done; return how many cases."""
        count, function = 0, partial(computed, self.plan.base)
        with self.store.working(workers):
            try:
                for record in compute(function, self._claimed(leads), crashed):
                    self.store.add_record(record)
                    count += 1
                    progress(self._stage(), len(self.store.records()) / max(self._total, 1))
            except KeyboardInterrupt as stop:
                kept = "every finished case is kept; the same command goes on from there"
                raise type(stop)(kept) from None
        return count

    def _claimed(self, leads: bool) -> Iterator[Job | None]:
        """Yield open jobs that nobody else computes; None while the last ones of a batch run."""
        held: set[str] = set()
        try:
            while True:
                for job in self._open():
                    if job.key in held or job.key in self.store.records():
                        continue
                    held.add(job.key)  # first: Ctrl-C may come in the middle of the claim
                    if not self.store.claim(job.key):
                        held.remove(job.key)
                    elif job.key in self.store.records():  # finished between look and claim
                        self.store.release(job.key)
                    else:
                        yield job
                held -= self.store.records().keys()
                if held:
                    yield None
                elif self._open():
                    time.sleep(PAUSE)  # others compute them
                elif not self._advanced(leads):
                    return
        finally:
            for key in held:  # a finished one too: Ctrl-C may come before its claim is ended
                self.store.release(key)

    def _advanced(self, leads: bool) -> bool:
        """Return whether the study goes on, after setting its next batch if this process leads."""
        if not leads:
            with self.store.leading() as leads:
                if leads:
                    return bool(self._open()) or self._advanced(True)
            time.sleep(PAUSE)
            return True
        so_far = StudyResult(self.plan, self.store.jobs(), self.store.records())
        new = next_batch(self.plan, so_far)
        self.store.add_jobs(new)
        return bool(new)

    def _open(self) -> list[Job]:
        records = self.store.records()
        jobs = {job.key: job for job in self.store.jobs()}
        self._total = len(jobs)
        return [job for key, job in jobs.items() if key not in records]

    def _stage(self) -> str:
        failed = sum(not record.usable for record in self.store.records().values())
        return "Cases" + (f", {failed} without numbers" if failed else "")
