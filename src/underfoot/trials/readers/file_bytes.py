"""A long file as bytes that are read when they are asked for."""

from pathlib import Path
from typing import overload


class FileBytes:
    """Stands for the bytes of a file: its length, a byte, a slice; nothing is kept.

    ``path``: a file that stays as it is while it is read. OSError: it can't be read.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("rb")
        self._size = path.stat().st_size

    def __len__(self) -> int:
        return self._size

    @overload
    def __getitem__(self, at: int) -> int: ...
    @overload
    def __getitem__(self, at: slice) -> bytes: ...
    def __getitem__(self, at: int | slice) -> int | bytes:
        if isinstance(at, int):
            return self[at : at + 1][0]
        start, stop, _ = at.indices(self._size)
        self._file.seek(start)
        return self._file.read(max(stop - start, 0))

    def close(self) -> None:
        """Close the file."""
        self._file.close()
