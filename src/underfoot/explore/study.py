"""A study in its folder: run it, help with it, look at it; it goes on where it stopped."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from underfoot.core import InputError, Progress, nearest_match, silent
from underfoot.core.errors import Cancelled
from underfoot.core.remark import Message

from .claims import Round
from .computing import compute_job, crash_record
from .cost import spread_jobs
from .engines import PATIENCE, Engine, engine
from .plan import StudyPlan
from .proposals import first_points, next_batch
from .record import CaseJob, Ending
from .result import StudyResult
from .store import SILENT, STOP, Store
from .study_file import load_plan

PAUSE, LONGEST_PAUSE = 1.0, 16.0
"""s between two looks for work while others work, at first and at most."""


class Stopped(Cancelled):
    """A person stopped a study from another process."""


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
        if not path.exists():
            raise InputError(
                Message("there is no study {path}", path=path),
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
            Stopped: ``underfoot study stop``, or the app.
            DataError: A full disk; what is finished is on it.
        """
        self.store = Store.open_folder(self.store.folder)
        with self.store.leading() as leads:
            if not leads:
                raise InputError(
                    Message(
                        "the study in {folder} is being run by {leader}",
                        folder=self.store.folder,
                        leader=self.store.leader(),
                    ),
                    where="STUDY",
                    remedy=Message(
                        "To help it: underfoot study work {folder}", folder=self.store.folder
                    ),
                )
            self.store.go_on()
            self.store.adopt(self.plan)
            compute, count = engine(on, workers, self._waiting_line(progress))
            self._compute(compute, count, progress, leads=True)
        return self.result()

    def work(self, workers: int | None = 1, progress: Progress = silent) -> int:
        """Take open cases from the folder until the study is done; return how many were computed.

        Any number of processes on any number of machines may do so, with or without one that
        leads: whoever finds nothing open leads for a moment and sets what comes next.
        """
        self.store = Store.open_folder(self.store.folder)
        with self.store.leading() as leads:
            if leads:
                self.store.adopt(self.plan)
                latest = self.store.round
                if latest is None or not len(latest.places):
                    self._begin_next()  # not begun, or finished: is every case still there?
        compute, count = engine(None, workers, self._waiting_line(progress))
        return self._compute(compute, count, progress, leads=False)

    def compute_some(self, count: int, progress: Progress = silent) -> None:
        """Compute a few cases, spread over the first batch, and keep them.

        Where another process leads the study none is computed: those that it finished tell enough.
        """
        self.store = Store.open_folder(self.store.folder)
        jobs = list(spread_jobs(self.plan, count))
        with self.store.leading() as leads, self.store.working(1):
            if leads:
                self.store.adopt(self.plan)
            known = self.store.records()
            for done, job in enumerate(jobs if leads else [], start=1):
                if job.key not in known:
                    self.store.add_record(compute_job(self.plan.base, job))
                progress("Timing cases", done / len(jobs))

    def result(self) -> StudyResult:
        """Return what the folder holds now; views of it are not written."""
        sessions = self.store.sessions() if self.store.exists else []
        return StudyResult(self.plan, self.store.jobs(), self.store.records(), sessions)

    def _waiting_line(self, progress: Progress) -> Callable[[str], None]:
        """Return what takes in why the study waits."""
        return lambda text: progress(text, self.store.share)

    def _compute(self, compute: Engine, workers: int, progress: Progress, *, leads: bool) -> int:
        """Compute what nobody else does until the study is done; return how many cases."""
        count, function = 0, partial(compute_job, self.plan.base)
        with self.store.working(workers):
            try:
                for record in compute(
                    function, self._claim_jobs(leads, self._waiting_line(progress)), crash_record
                ):
                    self.store.add_record(record)
                    count += 1
                    progress(self._stage(), self.store.share)
                self._end_if_stopped()
            except KeyboardInterrupt as stop:
                kept = "every finished case is kept; the same command goes on from there"
                raise type(stop)(kept) from None
        return count

    def _claim_jobs(self, leads: bool, told: Callable[[str], None]) -> Iterator[CaseJob | None]:
        """Yield jobs that nobody else computes; None while the last ones of a batch run."""
        if leads and self.store.end_round():
            self._begin_next()
        pause, waited, looked = PAUSE, 0.0, -math.inf
        while not self.store.stopped:
            jobs = self.store.take(in_order=leads)
            if jobs is not None:
                for job in jobs:
                    if time.monotonic() - looked > PAUSE:
                        looked = time.monotonic()
                        if self.store.stopped:
                            return
                    yield job
                pause, waited = PAUSE, 0.0
            elif self.store.holds:
                yield None
            elif (latest := self.store.round) is not None and not latest.ended:
                time.sleep(pause)  # others compute them
                waited += pause
                if waited >= PATIENCE and (other := self.store.other):
                    told(
                        Message(
                            "Waiting for {other}: taken over after {minutes:.0f} min of silence",
                            other=other,
                            minutes=SILENT / 60,
                        )
                    )
                pause = min(2 * pause, LONGEST_PAUSE)
            elif not self._advance(latest, leads):
                return

    def _advance(self, ended: Round | None, leads: bool) -> bool:
        """Return whether the study goes on after a round, and begin the next where none has."""
        if ended is not None and not len(ended.places):
            return False
        if leads:
            return self._begin_next()
        with self.store.leading() as leads:
            if leads and self.store.round is ended:
                return self._begin_next()
        if not leads:
            time.sleep(PAUSE)
        return True

    def _end_if_stopped(self) -> None:
        if self.store.stopped:
            raise Stopped(
                "the study was stopped",
                where=str(self.store.folder),
                remedy=Message(
                    "every finished case is kept; underfoot study run goes on from "
                    "there (without one: remove {folder}, then underfoot study work)",
                    folder=self.store.folder / STOP,
                ),
            )

    def _begin_next(self) -> bool:
        """Give out what has no record, or else the next batch; return whether there was any."""
        records, jobs = self.store.records(), self.store.jobs()
        if not jobs.closed:  # of version 1: whole where no design of the first batch is missing
            first = {job.design for job in jobs if job.batch == 0}
            self.store.close_batches(jobs if len(first) == len(first_points(self.plan)) else [])
            jobs = self.store.jobs()
        while not self.store.begin_round(jobs, ended=False):
            batch = next_batch(self.plan, StudyResult(self.plan, jobs, records))
            if not self.store.add_batch(jobs, batch):
                self.store.begin_round(jobs, ended=True)
                records.pack(jobs.keys)
                return False
            jobs = self.store.jobs()
        return True

    def _stage(self) -> str:
        endings = self.store.known.endings
        failed = endings.total() - endings[Ending.COMPUTED]
        return Message("Cases, {count} without numbers", count=failed) if failed else "Cases"
