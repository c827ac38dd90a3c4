"""The finished cases of a study: what its files hold, known by key, read when they are asked for.

    cases-WORKER.jsonl  a line a case, by one process
    draws-WORKER.f4     its draws of COF, float32
    packed-HASH.npz     many finished cases of processes that ended

Of each case its key, ending and place are in memory (0.3 kB); the last cases read are too.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import cache, lru_cache, partial
from hashlib import blake2b
from io import BytesIO
from itertools import groupby
from pathlib import Path
from typing import BinaryIO
from zipfile import BadZipFile
from zlib import crc32

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import AnyArray

from .lines import CURRENT, KEY, line_of, whole_lines, write_file
from .record import Ending, Record, draws_place

RECENT = 4096
"""Records that stay in memory after they were read."""
PACK = 10_000
"""Cases of a packed file, and finished cases in lines from which on they are packed."""
ENDINGS = tuple(Ending)
BETWEEN = len(b'", "ending": "')
"""Bytes between key and ending in a line."""
ENDED = {ending.encode(): k for k, ending in enumerate(ENDINGS)}
LINES, DRAWS, PACKED = "cases-", "draws-", "packed-"
AT = (1 << 48) - 1
"""Of a place in memory: where in its file."""
DrawsAt = Callable[[int, int, int], bytes]
"""Reads the draws that a line names by first byte, number and check sum."""


class Records(Mapping[str, Record]):
    """The finished cases of a folder by key, as of the last ``look``."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._files: list[Path] = []
        self._numbers: dict[Path, int] = {}
        self._places: dict[str, int] = {}
        self._sizes: dict[str, int] = {}
        self._counts = [0] * len(ENDINGS)
        self._record = lru_cache(RECENT)(self._read)
        self._packed = lru_cache(4)(_packed_columns)

    def __len__(self) -> int:
        return len(self._places)

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __contains__(self, key: object) -> bool:
        return key in self._places

    def __getitem__(self, key: str) -> Record:
        try:
            return self._record(self._places[key] >> 3)
        except FileNotFoundError:  # packed since the last look
            self.look()
            return self._record(self._places[key] >> 3)

    @property
    def endings(self) -> Counter[Ending]:
        """How many cases ended in each way."""
        return Counter(dict(zip(ENDINGS, self._counts, strict=True)))

    def ending(self, key: str) -> Ending:
        """Return how a case ended; ``OPEN`` of one that is not finished. Nothing is read."""
        place = self._places.get(key)
        return Ending.OPEN if place is None else ENDINGS[place & 7]

    def ending_places(self, keys: Iterable[str]) -> AnyArray:
        """Return the place in ``ENDINGS`` of how each case ended; 0 is open."""
        places = self._places
        return np.array([places.get(key, 0) & 7 for key in keys], dtype=np.int64)

    def endings_of(self, keys: Iterable[str]) -> dict[str, int]:
        """Return how many of some cases ended in each way."""
        counts = np.bincount(self.ending_places(keys), minlength=len(ENDINGS))
        return {str(name): int(n) for name, n in zip(ENDINGS, counts, strict=True) if n}

    def lines(self, keys: Iterable[str]) -> Iterator[tuple[int, bytes, DrawsAt]]:
        """Yield (index, line, what reads its draws) of those of some cases that are finished.

        File by file, not in the order of the keys; damaged lines are left out.

        Raises:
            FileNotFoundError: The files were packed since the last look.
        """
        known = ((self._places.get(key), k) for k, key in enumerate(keys))
        places = sorted((place >> 3, k) for place, k in known if place is not None)
        for number, some in groupby(places, lambda one: one[0] >> 48):
            with self._open(self._files[number]) as (line_at, draws_at):
                for place, k in some:
                    if (body := line_at(place & AT)) is not None:
                        yield k, body, draws_at

    def look(self, owners: Sequence[str] | None = None) -> Records:
        """Read what is new in the files of some processes, by default of all; return this.

        Files are opened only where their size has changed.
        """
        with os.scandir(self.folder) as entries:
            files = sorted(entries, key=lambda one: (not one.name.startswith(PACKED), one.name))
        if self._sizes.keys() - {file.name for file in files}:  # packed: places are others now
            self.__init__(self.folder)
        for one in files:
            path = Path(one.path)
            if path.suffix == ".npz" and one.name.startswith(PACKED):
                if one.name not in self._sizes:
                    self._sizes[one.name] = 0
                    self._add_packed(path)
            elif path.suffix == ".jsonl" and one.name.startswith(LINES):
                wanted = owners is None or path.stem.removeprefix(LINES) in owners
                if wanted and one.stat().st_size > self._sizes.get(one.name, 0):
                    self._add_lines(path)
        return self

    def add(self, key: str, ending: Ending, path: Path, place: int, end: int) -> None:
        """Take in a case of this process that has just been written."""
        self._put(key, ENDINGS.index(ending), self._number(path), place)
        self._sizes[path.name] = end

    def pack(self, order: Sequence[str]) -> None:
        """Put what is in lines into packed files, in an order of keys, and remove the lines.

        Only for a study that is done. A kill in between leaves cases in both, which are equal.
        """
        texts = [path for path in self._files if path.suffix == ".jsonl"]
        own = {k for k, path in enumerate(self._files) if path.suffix == ".jsonl"}
        loose = [key for key, place in self._places.items() if place >> 51 in own]
        if not texts or 0 < len(loose) < PACK:
            return
        rank = {key: k for k, key in enumerate(order)}
        loose.sort(key=lambda key: rank.get(key, len(rank)))
        for first in range(0, len(loose), PACK):
            data = self._packed_bytes(loose[first : first + PACK])
            name = f"{PACKED}{first // PACK:05}-{blake2b(data, digest_size=8).hexdigest()}.npz"
            write_file(self.folder / name, data)
        for path in texts:
            with suppress(PermissionError):  # Windows, where a process has it open
                path.unlink()
                _draws_of(path).unlink(missing_ok=True)
        self.look()

    def _packed_bytes(self, keys: Sequence[str]) -> bytes:
        lines, draws = [], bytearray()
        for key in keys:
            record = self[key]
            packed = record.packed_draws
            place = (len(draws), len(packed) // 4, crc32(packed))
            lines.append(record.line(place).encode("utf-8"))
            draws += packed
        stream = BytesIO()
        np.savez_compressed(
            stream,
            allow_pickle=False,
            keys=np.array(keys, dtype=np.str_),
            endings=np.array([ENDINGS.index(self.ending(key)) for key in keys], dtype=np.uint8),
            lines=np.frombuffer(b"\n".join(lines), dtype=np.uint8),
            draws=np.frombuffer(bytes(draws), dtype=np.uint8),
        )
        return stream.getvalue()

    def _number(self, path: Path) -> int:
        if path not in self._numbers:
            self._numbers[path] = len(self._files)
            self._files.append(path)
        return self._numbers[path]

    def _put(self, key: str, ending: int, number: int, place: int) -> None:
        if key not in self._places:
            self._places[key] = (number << 48 | place) << 3 | ending
            self._counts[ending] += 1

    def _add_lines(self, path: Path) -> None:
        number, draws, size = self._number(path), _draws_of(path), -1
        end = self._sizes.get(path.name, 0)
        for start, after, body in whole_lines(path, end):
            end = after
            close = body.index(b'"', KEY)
            ending = close + BETWEEN
            if body.startswith(CURRENT):
                first, count, _ = draws_place(body)
                last = first + 4 * count
                if last > size:
                    size = draws.stat().st_size if draws.exists() else 0
                if last > size:
                    continue  # a folder that was copied in part
            name = body[ending : body.index(b'"', ending)]
            self._put(body[KEY:close].decode(), ENDED[name], number, start)
        self._sizes[path.name] = end

    def _add_packed(self, path: Path) -> None:
        number = self._number(path)
        try:
            with path.open("rb") as stream, np.load(stream, allow_pickle=False) as columns:
                keys, endings = columns["keys"].tolist(), columns["endings"].tolist()
        except (OSError, ValueError, KeyError, BadZipFile):
            return  # damaged: its cases are open again
        for place, (key, ending) in enumerate(zip(keys, endings, strict=True)):
            self._put(key, ending, number, place)

    def _read(self, place: int) -> Record:
        path = self._files[place >> 48]
        with self._open(path) as (line_at, draws_at):
            body = line_at(place & AT)
            if body is None:
                raise _damage_error(path)
            return Record.from_line(body, draws_at)

    @contextmanager
    def _open(self, path: Path) -> Iterator[tuple[Callable[[int], bytes | None], DrawsAt]]:
        """Yield what reads a line of a file at its place, and what reads the draws of a line."""
        if path.suffix == ".npz":
            lines, draws = self._packed(path)
            yield lines.__getitem__, lambda first, count, _: draws[first : first + 4 * count]
            return
        with ExitStack() as stack:
            stream = stack.enter_context(path.open("rb"))

            @cache
            def beside() -> BinaryIO:
                return stack.enter_context(_draws_of(path).open("rb"))

            def draws_at(first: int, count: int, check: int) -> bytes:
                if not count:
                    return b""
                beside().seek(first)
                packed = beside().read(4 * count)
                if crc32(packed) != check:
                    raise _damage_error(_draws_of(path))
                return packed

            yield partial(line_of, stream), draws_at


def _draws_of(path: Path) -> Path:
    return path.with_name(path.name.replace(LINES, DRAWS, 1)).with_suffix(".f4")


def _packed_columns(path: Path) -> tuple[list[bytes], bytes]:
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as columns:
            return columns["lines"].tobytes().split(b"\n"), columns["draws"].tobytes()
    except FileNotFoundError:
        raise
    except (OSError, ValueError, KeyError, BadZipFile) as error:
        raise _damage_error(path) from error


def _damage_error(path: Path) -> DataError:
    return DataError(
        "a finished case is damaged",
        where=str(path),
        remedy="Remove this file and give underfoot study run again: it computes its cases anew",
    )
