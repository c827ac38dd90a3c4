"""Who computes what: the open jobs of a round, in blocks that processes claim.

    claims/ROUND/jobs.npy    first byte in jobs.jsonl of every job that was open as the round began
    claims/ROUND/BLOCK       claimed, by the process that it names
    claims/ROUND/BLOCK-N     taken over from a dead one, by its Nth owner after the first
    claims/ROUND/BLOCK.done  beside it: every job of it has a record

The one process that leads begins a round when the one before has ended; without jobs it is the
last. A block has a thousandth of the jobs that are left, at most ``LARGEST``: a million cases take
8,000 claims, and the last cases are claimed one by one, so that nobody waits for a large block.
Whether a case is finished its record alone says: a round that begins anew holds what lacks one.
"""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable, Sequence
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from uuid import uuid4

import numpy as np

from underfoot.core.arrays import AnyArray

from .lines import write_all, write_file

LARGEST = 1000
"""Jobs of a block at most."""
ASKED = 8
"""Claimed blocks whose owners are looked at, at random, by one that finds nothing open."""
REFUSED = 4
"""Blocks that others had first, one after another, after which the folder is listed again."""
DONE = ".done"
FIRST = 10_000_000
"""Numbers that a first round is drawn from."""
Alive = Callable[[str, Path | None], bool]
"""Whether a process works; one that has not written its name yet goes by the age of its claim."""


class Round:
    """A round as one process sees it.

    Attributes:
        number: Of the round, one above that of the round before.
        places: (jobs,) first bytes.
        total, before: Jobs that were set, and of these finished, as it began.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self.folder, self.number, self._name = folder, int(folder.name), name
        head = np.load(folder / "jobs.npy", allow_pickle=False)
        self.total, self.before = map(int, head[:2])
        self.places: AnyArray = head[2:]
        self._edges = block_edges(len(self.places))
        self._done: set[int] = set()
        self._free: list[int] = []
        self._unsaid: set[int] = set()

    @property
    def share(self) -> float:
        """Share of all jobs that were finished as this process looked last."""
        done = sum(map(self.size, self._done))
        return (self.before + done) / max(self.total, 1)

    @property
    def ended(self) -> bool:
        """Whether every block was done as this process looked last."""
        return len(self._done) == len(self._edges) - 1

    def claim(self, alive: Alive, *, in_order: bool) -> tuple[int, AnyArray, list[str]] | None:
        """Return a block, the places of its jobs and who had it before; None where none is open.

        ``in_order`` takes the first open one; many processes begin at places of their own instead.
        """
        for block in list(self._unsaid):
            self.finish(block)
        block = self._free_block(in_order)
        if block is not None:
            return block, self._jobs(block), []
        names = set(os.listdir(self.folder))
        self._done = {int(name.removesuffix(DONE)) for name in names if name.endswith(DONE)}
        left = [k for k in range(len(self._edges) - 1) if k not in self._done]
        self._free = [k for k in left if str(k) not in names]
        block = self._free_block(in_order)
        if block is not None:
            return block, self._jobs(block), []
        for block in random.sample(left, min(len(left), ASKED)):
            with suppress(FileNotFoundError):
                path, owners = self._owners(block)
                if owners[-1] == self._name or alive(owners[-1], None if owners[-1] else path):
                    continue
                if self._claim(f"{block}-{len(owners)}"):
                    return block, self._jobs(block), owners
        return None

    def _free_block(self, in_order: bool) -> int | None:
        """Return a block that nobody had as this process looked last, claimed; None without."""
        refused = 0
        while self._free and refused < REFUSED:
            place = 0 if in_order else random.randrange(min(len(self._free), LARGEST))
            block = self._free.pop(place)
            if self._claim(str(block)):
                return block
            refused += 1
        return None

    def _claim(self, name: str) -> bool:
        """Return whether this process makes the file of a name: no other has. Its own goes in."""
        try:
            descriptor = os.open(self.folder / name, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        except FileExistsError:
            return False
        try:
            write_all(descriptor, self._name.encode("utf-8"))
        finally:
            os.close(descriptor)
        return True

    def _owners(self, block: int) -> tuple[Path, list[str]]:
        """Return the last claim of a block, and all who have had it in their order."""
        path = self.folder / str(block)
        owners = path.read_text(encoding="utf-8").split("\n")  # of before 0.3: all in one file
        while (after := self.folder / f"{block}-{len(owners)}").exists():
            path, owners = after, [*owners, after.read_text(encoding="utf-8")]
        return path, owners

    def size(self, block: int) -> int:
        """Return the number of jobs of a block."""
        return self._edges[block + 1] - self._edges[block]

    def finish(self, block: int) -> None:
        """Say that every job of a block has a record."""
        try:
            os.close(os.open(self.folder / f"{block}{DONE}", os.O_WRONLY | os.O_CREAT, 0o644))
        except FileNotFoundError:  # the round is over, or a leader looks whether it is
            self._unsaid.add(block)
            return
        self._unsaid.discard(block)
        self._done.add(block)

    def over(self, alive: Alive) -> bool:
        """Return whether no other living process computes a block of it; then it is gone.

        It is set aside while it is looked at, so that nobody claims a block that was free.
        """
        place, aside = self.folder, self.folder.with_name(f".{self.number}-{uuid4().hex}")
        os.rename(place, aside)
        self.folder = aside
        if not self.other(alive):
            return True
        os.rename(aside, place)
        self.folder = place
        return False

    def other(self, alive: Alive) -> str:
        """Return another living process that computes a block of it; "" without."""
        names = set(os.listdir(self.folder))
        for name in names:
            if name.isdigit() and name + DONE not in names:
                with suppress(OSError):
                    path, owners = self._owners(int(name))
                    if owners[-1] != self._name and alive(owners[-1], None if owners[-1] else path):
                        return owners[-1] or path.name
        return ""

    def _jobs(self, block: int) -> AnyArray:
        return self.places[self._edges[block] : self._edges[block + 1]]


def block_edges(count: int) -> Sequence[int]:
    """Return where the blocks of so many jobs begin, and the end of the last."""
    edges = [0]
    while edges[-1] < count:
        edges.append(edges[-1] + min(-(-(count - edges[-1]) // LARGEST), LARGEST))
    return edges


def latest_round(claims: Path, name: str, known: Round | None) -> Round | None:
    """Return the latest round of a study for a process; it may be known.

    None before the first, and where a leader is just about to begin the next.
    """
    number = max(_rounds(claims), default=None)
    if number is None or (known is not None and known.number == number):
        return known if number is not None else None
    with suppress(OSError, ValueError, EOFError):
        return Round(claims / str(number), name)
    return None


def _rounds(claims: Path) -> list[int]:
    return [int(one) for one in os.listdir(claims) if one.isdigit() and len(one) < 9]


def begin_round(claims: Path, places: AnyArray, total: int, name: str) -> Round:
    """Begin the next round with the open jobs of a study and remove the earlier ones."""
    # where none is left a number of its own: who knows an earlier round takes no other for it
    number = max(_rounds(claims), default=random.randrange(FIRST)) + 1
    stream = BytesIO()
    head = [total, total - len(places)]
    np.save(stream, np.concatenate([head, places]).astype(np.int64), allow_pickle=False)
    made = claims / f".{number}-{uuid4().hex}"
    os.mkdir(made)
    write_file(made / "jobs.npy", stream.getvalue())
    os.rename(made, claims / str(number))
    clear(claims, keep=str(number))
    return Round(claims / str(number), name)


def clear(claims: Path, *, keep: str = "") -> None:
    """Remove all rounds but one, and claims of version 1."""
    for name in set(os.listdir(claims)) - {keep}:
        place = claims / name
        if not place.is_dir():
            place.unlink(missing_ok=True)
            continue
        if name.isdigit():  # first: half a round is none
            aside = claims / f".{name}-{uuid4().hex}"
            os.rename(place, aside)
            place = aside
        shutil.rmtree(place, ignore_errors=True)
