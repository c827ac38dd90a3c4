"""A study on disk: a folder of text lines that any number of processes add to.

    study.toml          the study as written
    base.toml           its base case, complete
    jobs.jsonl          what is to be computed, in batches, by the one process that leads
    cases-WORKER.jsonl  one line a finished case, each file by one process: the truth
    claims/KEY          who computes a case now
    alive/WORKER        touched while a process works

A case is finished when its line is on disk. Lines are only added, so that a process killed at any
time leaves at most one torn line, which is not read. All of it works on a network file system.
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
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from underfoot.case import Case
from underfoot.core import DataError, InputError, MissingExtraError
from underfoot.core.fields import Fields, from_xarray
from underfoot.core.files import MARKER, whole_file
from underfoot.core.optional import optional_module

from .plan import StudyPlan
from .record import Job, NewerFormat, Record
from .study_file import read_plan

if TYPE_CHECKING:
    from pandas import DataFrame

BEAT, SILENT = 20.0, 120.0
"""s: a working process touches its file this often, and counts as dead after this long."""
RESERVE = 1 << 18
"""Bytes kept free on the disk for the cases that end after it filled up."""
NO_SPACE = (errno.ENOSPC, errno.EDQUOT)


class Store:
    """The folder of a study, as one process sees it.

    ``name`` is that of the process: machine, process number and start.
    """

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        self.name = f"{platform.node() or 'host'}-{os.getpid()}-{uuid4().hex[:6]}"
        self._records: dict[str, Record] = {}
        self._read: dict[Path, int] = {}

    @classmethod
    def made(cls, folder: Path | str) -> Store:
        """Return the store in a folder: a new one, or one that a study began.

        Raises:
            InputError: The folder holds something else.
        """
        store = cls(folder)
        place = store.folder
        if place.is_file():
            raise InputError(f"{place} is a file", where="--out", allowed="a folder")
        other = place.is_dir() and not store.exists and any(place.iterdir())
        if other and not (place / "claims").is_dir():  # made first: another process may begin it
            raise InputError(
                f"the folder {place} holds no study",
                where="--out",
                remedy="Choose another folder, or empty this one yourself",
            )
        place.mkdir(parents=True, exist_ok=True)
        for name in ("claims", "alive"):
            (place / name).mkdir(exist_ok=True)
        (place / MARKER).touch()
        return store

    def adopt(self, plan: StudyPlan) -> None:
        """Write the plan; only the leading process does.

        Where the folder has another one its jobs are set aside; cases that both have stay finished.
        """
        base = f"{plan.base.to_toml(complete=True)}\n# hash: {plan.base.hash}\n"
        texts = {"base.toml": base, "study.toml": plan.text}
        paths = {self.folder / name: text for name, text in texts.items()}
        if all(path.exists() and path.read_text("utf-8") == text for path, text in paths.items()):
            return
        with suppress(FileNotFoundError):
            jobs = self.folder / "jobs.jsonl"
            jobs.rename(self.folder / f"jobs-before-{int(time.time())}.jsonl")
        for path, text in paths.items():
            with whole_file(path) as part:
                part.write_text(text, encoding="utf-8")

    @property
    def exists(self) -> bool:
        """Whether the folder holds a study."""
        return (self.folder / "study.toml").is_file() and (self.folder / "base.toml").is_file()

    def plan(self) -> StudyPlan:
        """Return the plan of the study in the folder."""
        if not self.exists:
            raise InputError(
                f"{self.folder} holds no study",
                where="STUDY",
                allowed="a folder that underfoot study run made",
            )
        try:
            base = Case.load(self.folder / "base.toml")
            text = (self.folder / "study.toml").read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            raise DataError(f"can't be read ({error})", where=str(self.folder)) from error
        return read_plan(text, self.folder, str(self.folder / "study.toml"), base=base)

    # --- what is there ---

    def jobs(self) -> list[Job]:
        """Return the jobs that were set, in their order, each once."""
        jobs: dict[tuple[str, int], Job] = {}
        path = self.folder / "jobs.jsonl"
        for line in _whole_lines(path, 0)[0]:
            job = _parsed(Job, line, path)
            if job is not None:
                jobs.setdefault((job.key, job.design), job)
        return list(jobs.values())

    def records(self) -> dict[str, Record]:
        """Return the finished cases by key; only what is new is read again."""
        for path in sorted(self.folder.glob("cases-*.jsonl")):
            lines, self._read[path] = _whole_lines(path, self._read.get(path, 0))
            for line in lines:
                record = _parsed(Record, line, path)
                if record is not None:
                    self._records.setdefault(record.key, record)
        return self._records

    # --- what is added ---

    def add_jobs(self, jobs: Iterable[Job]) -> None:
        """Append jobs; only the leading process does."""
        _append(self.folder / "jobs.jsonl", "".join(f"{job.line()}\n" for job in jobs))

    def add_record(self, record: Record) -> None:
        """Append a finished case, its maps first, and end the claim on it.

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
        path, line = self.folder / f"cases-{self.name}.jsonl", f"{record.line()}\n"
        try:
            _append(path, line)
        except OSError as error:
            if error.errno not in NO_SPACE:
                raise
            self._reserve.unlink(missing_ok=True)
            _append(path, line)
            full = error
        self._records[record.key] = record
        self.release(record.key)
        if full is not None:
            raise DataError(
                f"the disk of {self.folder} is full; every finished case is on it",
                remedy="Free some space and give the same command again: it goes on from there",
            ) from full

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

        The lock ends with the process, however that ends.
        """
        path = self.folder / "lead.lock"
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            if not _locked(descriptor):
                yield False
                return
            os.truncate(descriptor, 0)
            os.write(descriptor, self.name.encode())
            yield True
        finally:
            os.close(descriptor)

    def leader(self) -> str:
        """Return the name of the process that leads, or led last."""
        with suppress(OSError):
            return (self.folder / "lead.lock").read_text(encoding="utf-8")
        return ""

    @contextmanager
    def working(self, workers: int) -> Iterator[None]:
        """Show that this process works with so many workers, as long as the block lasts."""
        path, stop = self.folder / "alive" / self.name, threading.Event()
        start = {"began": time.time(), "workers": workers, "ended": None}
        path.write_text(json.dumps(start), encoding="utf-8")
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
            with suppress(OSError):
                self._reserve.unlink(missing_ok=True)
                path.write_text(json.dumps({**start, "ended": time.time()}), encoding="utf-8")

    def claim(self, key: str) -> bool:
        """Return whether this process may compute a case: nobody else does, or who did is dead."""
        path = self.folder / "claims" / key
        for _ in range(2):
            try:
                descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
            except FileExistsError:
                pass
            else:
                os.write(descriptor, self.name.encode())
                os.close(descriptor)
                return True
            try:
                owner = path.read_text(encoding="utf-8")
                if owner == self.name or self._alive(owner, path):
                    return False
                # of several that see a dead owner one can take the claim away
                aside = path.with_name(f".{key}-{self.name}")
                path.rename(aside)
                aside.unlink()
            except FileNotFoundError:
                continue
        return False

    def release(self, key: str) -> None:
        """End the claim of this process on a case, a half-made one too."""
        path = self.folder / "claims" / key
        with suppress(FileNotFoundError):
            if path.read_text(encoding="utf-8") in (self.name, ""):
                path.unlink()

    def sessions(self) -> list[dict[str, Any]]:
        """Return when each process began and ended (None: still at work) and its workers."""
        sessions = []
        for path in sorted((self.folder / "alive").glob("*")):
            with suppress(OSError, ValueError):
                plain = json.loads(path.read_text(encoding="utf-8"))
                seen = path.stat().st_mtime
                if plain["ended"] is None and not self._alive(path.name, path):
                    plain["ended"] = seen
                sessions.append({"name": path.name, **plain})
        return sessions

    def _alive(self, owner: str, claim: Path) -> bool:
        machine, _, number = owner.rpartition("-")[0].rpartition("-")
        here = machine == (platform.node() or "host") and number.isdigit()
        if here and not _runs(int(number)):
            return False
        now = self.folder / "alive" / self.name
        clock = now if now.exists() else self.folder / "alive"
        with suppress(OSError):
            if clock == now:
                os.utime(now)  # times of one clock, that of the file system
            there = self.folder / "alive" / owner
            seen = (there if there.exists() else claim).stat().st_mtime
            return clock.stat().st_mtime - seen < SILENT
        return False

    @property
    def _reserve(self) -> Path:
        return self.folder / f".reserve-{self.name}"

    # --- views ---

    def write_views(self, cases: DataFrame) -> list[str]:
        """Write results.csv and, where DuckDB is installed, results.parquet; return remarks."""
        table = self.folder / "results.csv"
        with whole_file(table) as part:
            cases.to_csv(part, index=False)
        try:
            duckdb = optional_module("duckdb", "study", "results.parquet")
        except MissingExtraError as error:
            return [str(error)]
        with whole_file(table.with_suffix(".parquet")) as part, duckdb.connect() as database:
            database.read_csv(str(table), sample_size=-1).write_parquet(str(part))
        return []


def _append(path: Path, text: str) -> None:
    """Append whole lines and see them on the disk; take a torn one back where it is full."""
    data = text.encode("utf-8")
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    try:
        before = os.fstat(descriptor).st_size
        if before and not _ends_with_line(path, before):
            data = b"\n" + data  # after the torn line of a leader that was killed
        try:
            written = os.write(descriptor, data)
            if written < len(data):
                raise OSError(errno.ENOSPC, "no space left on the disk", str(path))
            os.fsync(descriptor)
        except OSError:
            os.truncate(path, before)
            raise
    finally:
        os.close(descriptor)


def _ends_with_line(path: Path, size: int) -> bool:
    with path.open("rb") as stream:
        stream.seek(size - 1)
        return stream.read(1) == b"\n"


def _whole_lines(path: Path, start: int) -> tuple[list[str], int]:
    """Return the lines from a place on that have an end, and the place after them."""
    try:
        with path.open("rb") as stream:
            stream.seek(start)
            data = stream.read()
    except FileNotFoundError:
        return [], start
    end = data.rfind(b"\n") + 1
    return data[:end].decode("utf-8", errors="replace").split("\n")[:-1], start + end


def _parsed(kind: Any, line: str, path: Path) -> Any:
    """Return the job or record of a line; None of a torn one."""
    try:
        return kind.from_line(line)
    except NewerFormat as error:
        raise DataError(error.what, where=str(path), **error.parts) from None
    except (ValueError, KeyError, TypeError, DataError):
        return None


def _locked(descriptor: int) -> bool:
    try:
        import fcntl
    except ImportError:  # Windows
        import msvcrt

        lock: Any = msvcrt
        try:
            lock.locking(descriptor, lock.LK_NBLCK, 1)
        except OSError:
            return False
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
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
