"""``jobs.jsonl``: what a study set, batch by batch, written by the one process that leads.

A batch counts when its closing line is there and agrees with the lines before it in number and
hash; what follows the last whole batch was never set. Jobs of version 1 have no closing lines.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from hashlib import blake2b
from itertools import islice
from pathlib import Path
from typing import overload

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import AnyArray
from underfoot.core.remark import Message

from .lines import CURRENT, FORMAT, KEY, KEYED, seal_line, unseal_line, whole_lines, write_all
from .record import CaseJob

TOGETHER = 1000
"""Lines that are written at a time."""


class BatchJobs(Sequence[CaseJob]):
    """The jobs of the whole batches of a file, in their order; each is read when it is asked for.

    Attributes:
        keys: Of each job.
        places: (jobs,) its first byte.
        batches: Number of whole batches.
        end: Byte after the last of them.
        closed: Whether every batch has its closing line; False of version 1.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.keys: list[str] = []
        places: list[int] = []
        self.batches, self.end, self.closed = 0, 0, True
        first, hashed = 0, blake2b(digest_size=8)
        for start, end, body in whole_lines(path):
            if body.startswith(KEYED, len(CURRENT)):
                self.keys.append(body[KEY : body.index(b'"', KEY)].decode())
                places.append(start)
                hashed.update(body)
                if not body.startswith(CURRENT):
                    self.closed = False
                continue
            closing = json.loads(body)
            if (closing["count"], closing["hash"]) != (len(places) - first, hashed.hexdigest()):
                break
            first, self.batches, self.end = len(places), self.batches + 1, end
            hashed = blake2b(digest_size=8)
        if self.closed:
            del self.keys[first:], places[first:]
        self.places: AnyArray = np.array(places, dtype=np.int64)

    def __len__(self) -> int:
        return len(self.keys)

    @overload
    def __getitem__(self, index: int) -> CaseJob: ...
    @overload
    def __getitem__(self, index: slice) -> list[CaseJob]: ...
    def __getitem__(self, index: int | slice) -> CaseJob | list[CaseJob]:
        if isinstance(index, slice):
            return jobs_at(self._path, self.places[index])
        return jobs_at(self._path, [self.places[index]])[0]

    def at(self, indices: Iterable[int]) -> list[CaseJob]:
        """Return the jobs of some indices."""
        return jobs_at(self._path, self.places[np.fromiter(indices, dtype=np.int64)])

    def __iter__(self) -> Iterator[CaseJob]:
        places = set(self.places.tolist())
        for start, _, body in whole_lines(self._path):
            if start in places:
                yield CaseJob.from_line(body)


def jobs_at(path: Path, places: Iterable[int]) -> list[CaseJob]:
    """Return the jobs whose lines begin at some bytes.

    Raises:
        DataError: A line is damaged.
    """
    jobs = []
    with path.open("rb") as stream:
        for place in places:
            stream.seek(int(place))
            body = unseal_line(stream.readline().removesuffix(b"\n"))
            if body is None:
                raise DataError(
                    Message("the job at byte {place} is damaged", place=place),
                    where=str(path),
                    remedy="Give underfoot study run again: it sets that batch anew",
                )
            jobs.append(CaseJob.from_line(body))
    return jobs


def add_batch(path: Path, batch: int, jobs: Iterable[CaseJob], end: int) -> int:
    """Write a batch behind byte ``end`` and close it; return its number of jobs.

    An empty batch is not written.
    """
    lines, count, hashed = (job.line() for job in jobs), 0, blake2b(digest_size=8)
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT, 0o644)
    try:
        os.ftruncate(descriptor, end)
        os.lseek(descriptor, end, os.SEEK_SET)
        try:
            while some := list(islice(lines, TOGETHER)):
                for line in some:
                    hashed.update(line.encode("utf-8"))
                write_all(descriptor, b"".join(map(seal_line, some)))
                count += len(some)
            if count:
                closing = {"format": FORMAT, "closes": batch, "count": count}
                text = json.dumps({**closing, "hash": hashed.hexdigest()})
                write_all(descriptor, seal_line(text))
                os.fsync(descriptor)
        except OSError:
            os.ftruncate(descriptor, end)
            raise
    finally:
        os.close(descriptor)
    return count
