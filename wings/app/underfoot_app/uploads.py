"""Files from the browser into the project: streamed, bounded, whole or not at all."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from pathlib import Path

from underfoot.core import InputError
from underfoot.core.files import whole_file

from .gate import too_large
from .project import Project

MOST_BYTES = 300_000_000
"""Of one file: a scan of a sole has some 100 MB."""
PLACES = ("soles", "measured", "trials", "studies")
"""Folders of a project that take files."""
_PART = re.compile(r"[^\W.][^/\\:*?\"<>|\x00-\x1f]{0,120}")


def upload_path(project: Project, place: str) -> Path:
    """Return where a file "soles/heel.stl" goes.

    Raises:
        InputError: A folder that takes no files, a name that is none, a way out of the project.
    """
    folder, *names = place.split("/")
    if folder not in PLACES or not names or not all(map(_PART.fullmatch, names)):
        raise InputError(
            f'"{place}" is no place for a file',
            where="upload",
            allowed=f"a name in {', '.join(PLACES)}",
        )
    return project.inside(folder, *names)


async def received(project: Project, place: str, stream: AsyncIterator[bytes]) -> Path:
    """Write a file as it arrives and return its path; an older one of its name is replaced.

    Raises:
        InputError: No place for a file; more than ``MOST_BYTES``; nothing in it.
    """
    path = upload_path(project, place)
    size = 0
    with whole_file(path) as part, part.open("wb") as target:
        async for chunk in stream:
            size += len(chunk)
            if size > MOST_BYTES:
                raise InputError(too_large(size, MOST_BYTES), where=path.name)
            target.write(chunk)
        if not size:
            raise InputError("the file is empty", where=path.name, remedy="Export it again")
    return path
