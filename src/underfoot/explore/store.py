"""A study on disk: a folder that any number of processes add to.

    study.toml          the study as written
    base.toml           its base case, complete
    jobs.jsonl          what is to be computed, in closed batches, by the one process that leads
    cases-WORKER.jsonl  one line a finished case, each file by one process: the truth
    draws-WORKER.f4     the draws of COF of those cases
    packed-HASH.npz     ten thousand finished cases, of processes that ended
    claims/             who computes what now (``claims``)
    stop                the study is to stop: who works on it takes no further case
    alive/WORKER        touched while a process works; sessions.jsonl tells of those that ended

A case is finished when its line is written; every line has a check sum. Lines are only added, so
that a process killed at any time leaves at most one torn line, which is not read. All of it works
on a network file system, with or without locks of the kernel.
"""

from __future__ import annotations

import errno
import json
import os
import platform
import shutil
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4
from zlib import crc32

import numpy as np

from underfoot.case import Case
from underfoot.core import DataError, InputError, UnderfootError
from underfoot.core.fields import Fields, from_xarray
from underfoot.core.files import MARKER
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message
from underfoot.core.text import harmless

from .claims import Round, begin_round, clear, latest_round
from .jobs import BatchJobs, add_batch, jobs_at
from .lines import FORMAT, seal_line, whole_lines, write_all, write_file
from .plan import StudyPlan
from .record import CaseJob, Record
from .records import DRAWS, LINES, Records
from .study_file import read_plan

if TYPE_CHECKING:
    from pandas import DataFrame

BEAT, SILENT = 20.0, 120.0
"""s: a working process touches its file this often, and counts as dead after this long."""
COMMIT = 0.2
"""s: what is written goes to the disk together with all that was written since so long."""
SETTLED = 1.0
"""s within which two that take the lead from a dead process see each other, without locks."""
RESERVE = 1 << 18
"""Bytes kept free on the disk for the cases that end after it filled up."""
LED = ("base.toml", "study.toml", "sessions.jsonl", "jobs", "packed", "lead.claim")
"""Files that only the leading process writes."""
VIEWS = ("live.html", "report.html", "results.csv", "results.parquet", "surrogate.json")
"""Files made of the cases, by any process."""
STOP = "stop"
"""File that asks all who work on a study to stop."""
NO_SPACE = (errno.ENOSPC, errno.EDQUOT)


class Store:
    """The folder of a study, as one process sees it.

    Attributes:
        name: Of the process: machine, process number and start.
        known: The finished cases that this process knows; ``records`` looks for those of others.
    """

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        self.name = f"{platform.node() or 'host'}-{os.getpid()}-{uuid4().hex[:6]}"
        self.known = Records(self.folder)
        self._round: Round | None = None
        self._held: dict[str, tuple[Round, int]] = {}
        self._left: dict[tuple[Round, int], int] = {}
        self._open: dict[Path, tuple[int, int]] = {}
        self._committed = 0.0
        self._touched: dict[Path, tuple[float, float]] = {}

    @classmethod
    def open_folder(cls, folder: Path | str) -> Store:
        """Return the store in a folder: a new one, or one that a study began.

        Raises:
            InputError: The folder holds something else.
        """
        store = cls(folder)
        place = store.folder
        if place.is_file():
            raise InputError(
                Message("{path} is a file", path=place), where="--out", allowed="a folder"
            )
        other = place.is_dir() and not store.exists and any(place.iterdir())
        if other and not (place / "claims").is_dir():  # made first: another process may begin it
            raise InputError(
                Message("the folder {place} holds no study", place=place),
                where="--out",
                remedy="Choose another folder, or empty this one yourself",
            )
        place.mkdir(parents=True, exist_ok=True)
        for name in ("claims", "alive"):
            (place / name).mkdir(exist_ok=True)
        (place / MARKER).touch()
        return store

    def adopt(self, plan: StudyPlan) -> None:
        """Write the plan; only the leading process does. What dead processes left is tidied.

        Where the folder has another plan its jobs are set aside; cases of both stay finished. An
        optimisation that only got a larger budget keeps them, and goes on.
        """
        self._tidy()
        base = f"{plan.base.to_toml(complete=True)}\n# hash: {plan.base.hash}\n"
        texts = {"base.toml": base.encode("utf-8"), "study.toml": plan.text.encode("utf-8")}
        paths = {self.folder / name: text for name, text in texts.items()}
        same = all(path.exists() and path.read_bytes() == text for path, text in paths.items())
        if same and self._set_by(plan):
            return
        if self._gets_longer(plan):
            write_file(self.folder / "study.toml", texts["study.toml"])
            return
        with suppress(FileNotFoundError):
            aside = f"jobs-before-{uuid4().hex[:8]}.jsonl"
            os.rename(self.folder / "jobs.jsonl", self.folder / aside)
        self.begin_round(BatchJobs(self.folder / "jobs.jsonl"), ended=False)
        for path, text in paths.items():
            write_file(path, text)

    def _gets_longer(self, plan: StudyPlan) -> bool:
        """Return whether a plan is that of the folder but for more designs of an optimisation."""
        if plan.method.kind not in ("optimise", "robust") or not self.exists:
            return False
        try:
            before = self.plan()
        except (UnderfootError, OSError):
            return False
        more = {"base": plan.base, "text": plan.text, "remarks": plan.remarks}
        method = before.method.model_copy(update={"budget": plan.method.budget})
        same = before.base.hash == plan.base.hash and replace(before, **more, method=method) == plan
        return same and plan.designs > before.designs

    @property
    def exists(self) -> bool:
        """Whether the folder holds a study."""
        return (self.folder / "study.toml").is_file() and (self.folder / "base.toml").is_file()

    def plan(self) -> StudyPlan:
        """Return the plan of the study in the folder."""
        if not self.exists:
            raise InputError(
                Message("{folder} holds no study", folder=self.folder),
                where="STUDY",
                allowed="a folder that underfoot study run made",
            )
        try:
            base = Case.load(self.folder / "base.toml")
            text = (self.folder / "study.toml").read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            raise DataError(
                Message("can't be read ({error})", error=error), where=str(self.folder)
            ) from error
        file = self.folder / "study.toml"
        plan = read_plan(text, self.folder, str(file), base=base)
        if not self._set_by(plan):
            raise InputError(
                "was changed after its designs were set",
                where=str(file),
                remedy=Message(
                    "Copy it to where your studies are and give underfoot study run "
                    "COPY.toml --out {folder}: designs are set anew, and cases that "
                    "both have are kept",
                    folder=self.folder,
                ),
            )
        return plan

    def _set_by(self, plan: StudyPlan) -> bool:
        """Return whether the first job that is set is one of a plan."""
        for _, _, body in whole_lines(self.folder / "jobs.jsonl"):
            if b'"point": ' not in body:
                continue  # closes a batch
            job = CaseJob.from_line(body)
            if not 0 <= job.condition < len(plan.states) or job.draw >= len(plan.draws):
                return False
            if len(job.point) not in (0, len(plan.dimensions)):
                return False
            own = plan.job(job.design, job.point, job.batch, job.condition, job.draw)
            return own.changes == job.changes
        return True

    # --- what is there ---

    def jobs(self) -> BatchJobs:
        """Return the jobs of the batches that were set, in their order."""
        return BatchJobs(self.folder / "jobs.jsonl")

    def records(self) -> Records:
        """Return the finished cases by key; only what is new is read again."""
        return self.known.look() if self.folder.is_dir() else self.known

    # --- what is added ---

    def add_batch(self, before: BatchJobs, jobs: Iterable[CaseJob]) -> int:
        """Set a batch behind those that are there; return its number of jobs.

        Only the leading process does. A batch that was cut off is written over.
        """
        try:
            return add_batch(self.folder / "jobs.jsonl", before.batches, jobs, before.end)
        except OSError as error:
            raise self._full(error) from error

    def close_batches(self, before: Iterable[CaseJob]) -> None:
        """Write jobs of version 1 anew, in closed batches."""
        whole = self.folder / f".jobs-{uuid4().hex}"
        whole.touch()
        unique = {(j.batch, j.design, j.condition, j.draw): j for j in before}.values()
        for batch, jobs in groupby(unique, lambda job: job.batch):
            add_batch(whole, batch, jobs, whole.stat().st_size)
        os.replace(whole, self.folder / "jobs.jsonl")

    def add_record(self, record: Record) -> None:
        """Add a finished case, its maps first.

        A full disk costs none: the reserve takes it, and then the study stops.

        Raises:
            DataError: The disk is full; this case is on it.
        """
        full = None
        try:
            if record.maps is not None:
                self._add_maps(record.key, record.maps)
        except OSError as error:
            if error.errno not in NO_SPACE:
                raise
            full = error
        try:
            self._write(record)
        except OSError as error:
            if error.errno not in NO_SPACE:
                raise
            self._reserve.unlink(missing_ok=True)
            self._write(record)
            full = error
        block = self._held.pop(record.key, None)
        if block is not None:
            self._left[block] -= 1
            if not self._left[block]:
                del self._left[block]
                block[0].finish(block[1])
        if full is not None:
            raise self._full(full) from full

    def _full(self, error: OSError) -> Exception:
        """Return what to raise for an error of the file system: our words for a full disk."""
        if error.errno not in NO_SPACE:
            return error
        return DataError(
            Message(
                "the disk of {folder} is full; every finished case is on it", folder=self.folder
            ),
            remedy="Free some space and give the same command again: it goes on from there",
        )

    def _write(self, record: Record) -> None:
        draws, path = record.packed_draws, self.folder / f"{LINES}{self.name}.jsonl"
        first = self._append(self.folder / f"{DRAWS}{self.name}.f4", draws) if draws else 0
        line = seal_line(record.line((first, len(draws) // 4, crc32(draws))))
        place = self._append(path, line)
        self.known.add(record.key, record.ending, path, place, place + len(line))
        if time.monotonic() - self._committed > COMMIT:
            self.commit()

    def _append(self, path: Path, data: bytes) -> int:
        """Append to a file of this process; return the first byte. All of it is written or none."""
        if path not in self._open:
            descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
            self._open[path] = descriptor, os.fstat(descriptor).st_size
        descriptor, end = self._open[path]
        try:
            write_all(descriptor, data)
        except OSError:
            os.ftruncate(descriptor, end)
            raise
        self._open[path] = descriptor, end + len(data)
        return end

    def commit(self) -> None:
        """See on the disk what was written."""
        for descriptor, _ in self._open.values():
            os.fsync(descriptor)
        self._committed = time.monotonic()

    def close(self) -> None:
        """Commit and close the files of this process."""
        try:
            self.commit()
        finally:
            while self._open:
                os.close(self._open.popitem()[1][0])

    def _add_maps(self, key: str, maps: Fields) -> None:
        optional_module("zarr", "study", "Keeping the maps of a study")
        place = self.folder / "fields.zarr" / key
        shutil.rmtree(place, ignore_errors=True)  # half of one, of a process that was killed
        maps.to_xarray().to_zarr(place, mode="w", consolidated=False)

    def maps(self, key: str) -> Fields | None:
        """Return the maps of a case, or None where they were not kept."""
        place = self.folder / "fields.zarr" / key
        if not place.is_dir():
            return None
        import xarray

        with xarray.open_zarr(place, consolidated=False) as dataset:
            return from_xarray(dataset.load())

    # --- who does what ---

    @contextmanager
    def leading(self) -> Iterator[bool]:
        """Yield whether this process leads the study: one at a time may set jobs.

        The lock ends with the process, however that ends; where the file system has none a file
        with the name of the process does instead.
        """
        path, claim = self.folder / "lead.lock", self.folder / "lead.claim"
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            locked = _lock_file(descriptor)
            if locked is False or (locked is None and not self._claim(claim)):
                yield False
                return
            os.ftruncate(descriptor, 0)
            write_all(descriptor, self.name.encode("utf-8"))
            yield True
        finally:
            os.close(descriptor)
            with suppress(OSError):
                if claim.read_text(encoding="utf-8") == self.name:
                    claim.unlink()

    def _claim(self, path: Path) -> bool:
        """Return whether this process has a claim: nobody else has it, or who had it is dead."""
        try:
            descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        except FileExistsError:
            owner = path.read_text(encoding="utf-8")
            if owner == self.name or self._alive(owner, path):
                return False
            write_file(path, self.name.encode("utf-8"))
            time.sleep(SETTLED)
            return path.read_text(encoding="utf-8") == self.name
        try:
            write_all(descriptor, self.name.encode("utf-8"))
        finally:
            os.close(descriptor)
        return True

    def leader(self) -> str:
        """Return the name of the process that leads, or led last."""
        with suppress(OSError):
            return (self.folder / "lead.lock").read_text(encoding="utf-8")
        return ""

    def begin_round(self, jobs: BatchJobs, *, ended: bool) -> int:
        """Give out the jobs that have no record; return their number.

        Only the leading process does. ``ended`` says that a round without jobs is the last one;
        otherwise there is none until the next begins.
        """
        records, seen = self.known, set[str]()
        places = [
            place
            for key, place in zip(jobs.keys, jobs.places.tolist(), strict=True)
            if not (key in records or key in seen or seen.add(key))
        ]
        claims = self.folder / "claims"
        if places or ended:
            self._round = begin_round(claims, np.array(places), len(set(jobs.keys)), self.name)
        else:
            clear(claims)
            self._round = None
        return len(places)

    @property
    def round(self) -> Round | None:
        """The latest round; None before the first."""
        latest = latest_round(self.folder / "claims", self.name, self._round)
        self._round = latest
        return latest

    def take(self, *, in_order: bool) -> list[CaseJob] | None:
        """Return jobs that this process is to compute now, [] where they are; None without any."""
        latest, claimed = self.round, None
        with suppress(FileNotFoundError):  # the round ended, or a leader looks whether it did
            claimed = latest and latest.claim(self._alive, in_order=in_order)
        if latest is None or claimed is None:
            return None
        number, places, owners = claimed
        if owners:
            self.known.look(owners)
        jobs = jobs_at(self.folder / "jobs.jsonl", places)
        jobs = [job for job in jobs if job.key not in self.known]
        block = latest, number
        self._held |= {job.key: block for job in jobs}
        self._left[block] = len(jobs)
        if not jobs:
            del self._left[block]
            latest.finish(number)
        return jobs

    @property
    def holds(self) -> bool:
        """Whether jobs that this process took have no record yet."""
        return bool(self._held)

    def end_round(self) -> bool:
        """Return whether no other living process computes cases of the round; then it is over.

        Only the leading process does.
        """
        latest = self.round
        return latest is None or latest.over(self._alive)

    @property
    def other(self) -> str:
        """Another living process that computes cases of the study; "" without."""
        latest = self.round
        return "" if latest is None else latest.other(self._alive)

    def stop(self) -> None:
        """Ask all who work on the study to take no further case."""
        write_file(self.folder / STOP, self.name.encode("utf-8"))

    def go_on(self) -> None:
        """Take that back."""
        (self.folder / STOP).unlink(missing_ok=True)

    @property
    def stopped(self) -> bool:
        """Whether the study is to stop."""
        return (self.folder / STOP).exists()

    @property
    def share(self) -> float:
        """Share of the jobs set so far that are finished."""
        if self._round is None:
            return 0.0
        done = self._round.share
        mine = {block for block in self._left if block[0] is self._round}
        sizes = sum(self._round.size(number) for _, number in mine)
        left = sum(self._left[block] for block in mine)
        return done + (sizes - left) / max(self._round.total, 1)

    @contextmanager
    def working(self, workers: int) -> Iterator[None]:
        """Show that this process works with so many workers, as long as the block lasts."""
        path, stop = self.folder / "alive" / self.name, threading.Event()
        start = {"began": time.time(), "workers": workers, "ended": None}
        write_file(path, json.dumps(start).encode("utf-8"))
        with suppress(OSError):
            self._reserve.write_bytes(os.urandom(RESERVE))

        def beat() -> None:
            while not stop.wait(BEAT):
                with suppress(OSError):
                    os.utime(path)

        thread = threading.Thread(target=beat, daemon=True)
        thread.start()
        try:
            yield
        finally:
            stop.set()
            thread.join()
            self.close()
            with suppress(OSError):
                self._reserve.unlink(missing_ok=True)
                write_file(path, json.dumps({**start, "ended": time.time()}).encode("utf-8"))

    def sessions(self) -> list[dict[str, Any]]:
        """Return when each process began and ended (None: still at work) and its workers."""
        tidied = whole_lines(self.folder / "sessions.jsonl")
        sessions = [json.loads(body)["session"] for _, _, body in tidied]
        for path in sorted((self.folder / "alive").glob("[!.]*")):
            with suppress(OSError, ValueError):
                plain = json.loads(path.read_text(encoding="utf-8"))
                if plain["ended"] is None and not self._alive(path.name, path):
                    plain["ended"] = path.stat().st_mtime
                sessions.append({"name": path.name, **plain})
        return sessions

    def _tidy(self) -> None:
        """Remove what processes left that ended or were killed, and keep their times."""
        ended = {
            session["name"]: session for session in self.sessions() if session["ended"] is not None
        }
        lines = [
            seal_line(json.dumps({"format": FORMAT, "session": one})) for one in ended.values()
        ]
        if lines:
            write_file(self.folder / "sessions.jsonl", b"".join(lines))
        for name in ended:
            (self.folder / "alive" / name).unlink(missing_ok=True)
        halves = [(path, path.name[1:-33]) for path in (self.folder / "alive").glob(".*-*")]
        for name in ("reserve", *VIEWS):
            begin = f".{name}-"
            halves += [(p, p.name.removeprefix(begin)) for p in self.folder.glob(f"{begin}*")]
        for path, owner in halves:
            if not self._alive(owner, path):
                path.unlink(missing_ok=True)
        for name in LED:  # halves: only who leads writes them
            for path in self.folder.glob(f".{name}*-*"):
                path.unlink(missing_ok=True)

    def _alive(self, owner: str, mark: Path | None = None) -> bool:
        """Return whether a process works: its file, or else ``mark``, was touched lately."""
        machine, _, number = owner.rpartition("-")[0].rpartition("-")
        here = machine == (platform.node() or "host") and number.isdigit()
        if here and not _runs(int(number)):
            return False
        own, there = (self.folder / "alive" / name for name in (self.name, owner))
        with suppress(OSError, ValueError):
            if owner and there.exists():
                mark = there
                if json.loads(there.read_text(encoding="utf-8") or "{}").get("ended") is not None:
                    return False
            if mark is None:
                return False
            clock = own if own.exists() else self.folder / "alive"
            if clock == own:
                os.utime(own)  # times of one clock, that of the file system
            moment = mark.stat().st_mtime
            silence = clock.stat().st_mtime - moment
            if silence < 0:  # the clock was set back: then by this process's own
                before, since = self._touched.get(mark, (None, 0.0))
                if moment != before:
                    since = time.monotonic()
                    self._touched[mark] = moment, since
                silence = time.monotonic() - since
            return silence < SILENT
        return False

    @property
    def _reserve(self) -> Path:
        return self.folder / f".reserve-{self.name}"

    # --- views ---

    @contextmanager
    def view(self, name: str) -> Iterator[Path]:
        """Yield a file that takes the place of one of ``VIEWS`` when the block ends well."""
        part = self.folder / f".{name}-{self.name}"
        try:
            yield part
            os.replace(part, self.folder / name)
        finally:
            part.unlink(missing_ok=True)

    def write_views(self, cases: DataFrame) -> None:
        """Write results.csv and, where DuckDB is installed, results.parquet."""
        table = self.folder / "results.csv"
        with self.view(table.name) as part:
            texts = cases.select_dtypes(exclude="number").columns
            cases.assign(**{name: cases[name].map(_cell) for name in texts}).to_csv(
                part, index=False
            )
        if find_spec("duckdb") is None:
            return
        import duckdb

        with self.view("results.parquet") as part, duckdb.connect() as database:
            database.read_csv(str(table), sample_size=-1).write_parquet(str(part))


def _cell(value: Any) -> Any:
    return harmless(value) if isinstance(value, str) else value


def _lock_file(descriptor: int) -> bool | None:
    """Return whether a file is locked for this process; None where it can't be."""
    try:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except (ImportError, OSError):  # Windows; NFS and Lustre without a lock service
        return None
    return True


def _runs(number: int) -> bool:
    """Return whether a process of this machine runs."""
    if os.name == "nt":
        return True  # no harmless way to ask: its claims end with its silence
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
