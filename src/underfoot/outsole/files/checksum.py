"""Checksum of a file, so that a case knows which outsole it was computed with."""

from __future__ import annotations

import hashlib
from pathlib import Path


def checksum(path: Path | str) -> str:
    """Return the SHA-256 of a file as 64 hexadecimal digits."""
    with Path(path).open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
