"""Files from the browser into the project: streamed, bounded, whole or not at all."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from uuid import uuid4

from underfoot.core import InputError
from underfoot.core.files import checksum, named_for
from underfoot.core.remark import Message

from .gate import too_large
from .project import Project

MOST_BYTES = 300_000_000
"""Of one file: a scan of a sole has some 100 MB."""
PLACES = ("soles", "measured", "trials", "studies", "places")
"""Folders of a project that take files."""
_PART = re.compile(r"(?![\s.])[^/\\:*?\"<>|\x00-\x1f]{1,120}(?<![\s.])")
_DEVICE = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_REVISION = re.compile(r"(?P<name>.+), revision (?P<number>\d+)")


def upload_path(project: Project, place: str) -> Path:
    """Return where a file "soles/heel.stl" goes.

    Raises:
        InputError: A folder that takes no files, a name that is none, a way out of the project.
    """
    folder, *names = place.split("/")
    if folder not in PLACES or not names:
        raise InputError(
            Message('"{place}" is no place for a file', place=place),
            where="upload",
            allowed=", ".join(PLACES),
        )
    for name in names:
        if not _PART.fullmatch(name) or _DEVICE.fullmatch(name):
            raise InputError(
                Message('"{name}" can\'t be the name of a file on every system', name=name),
                where="upload",
                allowed='1 to 120 characters without / \\ : * ? " < > |, no dot or space first or '
                "last, not CON, PRN, AUX, NUL, COM1, LPT1",
                remedy="Rename the file and drop it again",
            )
    return project.inside(folder, *names)


def revision(path: Path) -> tuple[Path, int]:
    """Return the first path of a file and its number: 3 of "heel, revision 3.stl"."""
    later = _REVISION.fullmatch(path.stem)
    if not later:
        return path, 1
    return path.with_name(later["name"] + path.suffix), int(later["number"])


def revisions(path: Path) -> list[Path]:
    """Return the files that came under one name, the oldest first."""
    first = revision(path)[0]
    same = [each for each in first.parent.glob("[!.]*") if revision(each)[0] == first]
    return sorted(same, key=lambda each: revision(each)[1])


async def receive_file(project: Project, place: str, stream: AsyncIterator[bytes]) -> Path:
    """Write a file as it arrives and return its path.

    No file is replaced: what has the name already but other content makes this one its next
    revision, "heel, revision 2.stl"; of the same content there is one file.

    Raises:
        InputError: No place for a file; more than ``MOST_BYTES``; nothing in it.
    """
    path, size, digest = upload_path(project, place), 0, sha256()
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{uuid4().hex}")
    try:
        with part.open("wb") as target:
            async for chunk in stream:
                size += len(chunk)
                if size > MOST_BYTES:
                    raise InputError(too_large(size, MOST_BYTES), where=path.name)
                digest.update(chunk)
                target.write(chunk)
        if not size:
            raise InputError("the file is empty", where=path.name, remedy="Export it again")
        present = revisions(path)
        for each in present:
            if each.stat().st_size == size and checksum(each) == digest.hexdigest():
                return each
        if present:
            first, newest = revision(present[-1])
            path = first.with_name(f"{first.stem}, revision {newest + 1}{first.suffix}")
        part.replace(path)
    except OSError as error:
        raise named_for(error, path) from error
    finally:
        with suppress(OSError):  # a disk that can only be read refuses even what is not there
            part.unlink(missing_ok=True)
    return path
