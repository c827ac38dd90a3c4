"""Lines of text that carry a check sum, and files that are whole or absent.

Every byte that a study writes goes through ``os``, so that a test can stop it at each call.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO
from uuid import uuid4
from zlib import crc32

from underfoot.core import DataError
from underfoot.core.remark import Message

FORMAT = 2
"""Version of the lines that this package writes; newer ones are refused, version 1 is read."""
_HEAD = b'{"format": '
CURRENT = b'{"format": %d, ' % FORMAT
"""How lines of this version begin."""
KEYED = b'"key": "'
KEY = len(CURRENT + KEYED)
"""What stands next in the line of a case, and the first byte of its key, in version 1 too."""
AT_ONCE = 1 << 16
"""Bytes that are read together."""
SEAL = 10
"""Bytes of a line behind its text: tab, check sum, end of line."""


def seal_line(text: str) -> bytes:
    """Return a line: the text (JSON), a tab, its CRC-32 in hexadecimal digits."""
    body = text.encode("utf-8")
    return b"%s\t%08x\n" % (body, crc32(body))


def unseal_line(line: bytes) -> bytes | None:
    """Return the text of a line without its end; None of a torn or damaged one.

    Lines of version 1 have no check sum and are taken as they are.

    Raises:
        NewerFormat: The line is of a later version.
    """
    if line.startswith(CURRENT):
        body = line[: 1 - SEAL]
        return body if line[1 - SEAL :] == b"\t%08x" % crc32(body) else None
    version = line[len(_HEAD) : line.find(b",")]
    if not line.startswith(_HEAD) or not version.isdigit():
        return None
    if int(version) > FORMAT:
        raise NewerFormat(int(version))
    return line if int(version) == 1 and line.endswith(b"}") else None


def whole_lines(path: Path, start: int = 0) -> Iterator[tuple[int, int, bytes]]:
    """Yield (first byte, byte after, text) of each undamaged line from a place on.

    Raises:
        NewerFormat: A line of a later version.
    """
    try:
        stream = path.open("rb", buffering=AT_ONCE)
    except FileNotFoundError:
        return
    with stream:
        stream.seek(start)
        for line in stream:
            end = start + len(line)
            if line.startswith(CURRENT):  # a million of them: as few steps as it takes
                body = line[:-SEAL]
                if line[-SEAL:] == b"\t%08x\n" % crc32(body):
                    yield start, end, body
                start = end
                continue
            try:
                body = unseal_line(line[:-1]) if line.endswith(b"\n") else None
            except NewerFormat as error:
                raise DataError(error.what, where=str(path), **error.parts) from None
            if body is not None:
                yield start, end, body
            start = end


def line_of(stream: BinaryIO, place: int) -> bytes | None:
    """Return the text of the line of a file that begins at a byte; None where it is damaged."""
    stream.seek(place)
    return unseal_line(stream.readline().removesuffix(b"\n"))


def write_all(descriptor: int, data: bytes) -> None:
    """Write every byte.

    Raises:
        OSError: The disk took a part only.
    """
    view = memoryview(data)
    while view:
        written = os.write(descriptor, view)
        if not written:
            raise OSError(errno.ENOSPC, "no space left on the disk")
        view = view[written:]


def write_file(path: Path, data: bytes) -> None:
    """Put a file in its place, whole and on the disk."""
    part = path.with_name(f".{path.name}-{uuid4().hex}")
    descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
    try:
        try:
            write_all(descriptor, data)
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
        os.replace(part, path)
    except BaseException:
        with suppress(OSError):
            os.unlink(part)
        raise


class NewerFormat(DataError):
    """A line of a newer version of the program."""

    def __init__(self, version: int) -> None:
        super().__init__(
            Message("the study was written by a newer version (format {version})", version=version),
            allowed=Message("format {format} or older", format=FORMAT),
            remedy="Update underfoot, or run the study in another folder",
        )
