"""On-disk cache of arrays, keyed by the content of what they were computed from."""

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from .files import whole_file


def content_hash(*parts: Any) -> str:
    """Return a hash of numbers, text, arrays, mappings, sequences and dataclasses.

    Equal content gives equal hashes on every machine and in every session.
    """
    digest = hashlib.sha256()
    for part in parts:
        _feed(digest, part)
    return digest.hexdigest()


class Cache:
    """Arrays stored under a content key; a damaged or missing entry is simply computed again.

    ``room`` names the part of the program that owns the entries; raise its version suffix
    (``"contact_table-2"``) when the numbers behind a key change. Entries lie in ``folder``, by
    default that of ``default_folder()``.
    """

    def __init__(self, room: str, folder: Path | None = None) -> None:
        self.folder = Path(folder or default_folder()) / room

    def load(self, key: str) -> dict[str, np.ndarray] | None:
        """Return the arrays stored under ``key``, or None."""
        path = self.folder / f"{key}.npz"
        try:
            with path.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
                return {name: stored[name] for name in stored.files}
        except FileNotFoundError:
            return None
        except (OSError, ValueError, EOFError, KeyError, BadZipFile):
            path.unlink(missing_ok=True)
            return None

    def store(self, key: str, arrays: Mapping[str, Any]) -> None:
        """Store arrays under ``key``; readers never see a half-written entry."""
        plain: dict[str, Any] = {key: np.asarray(value) for key, value in arrays.items()}
        with whole_file(self.folder / f"{key}.npz") as part, part.open("wb") as stream:
            np.savez_compressed(stream, **plain)


def default_folder() -> Path:
    """Return the cache folder: ``UNDERFOOT_CACHE`` if set, else the user's cache folder."""
    if chosen := os.environ.get("UNDERFOOT_CACHE"):
        return Path(chosen)
    from platformdirs import user_cache_path

    return user_cache_path("underfoot")


def _feed(digest: Any, part: Any) -> None:
    if isinstance(part, np.ndarray):
        array = np.ascontiguousarray(part)
        digest.update(f"array{array.dtype.str}{array.shape}".encode())
        digest.update(array.tobytes())
    elif is_dataclass(part) and not isinstance(part, type):
        _feed(digest, [type(part).__name__, asdict(part)])
    elif isinstance(part, Mapping):
        digest.update(b"{")
        for key in sorted(part):
            _feed(digest, key)
            _feed(digest, part[key])
        digest.update(b"}")
    elif isinstance(part, list | tuple):
        digest.update(b"[")
        for item in part:
            _feed(digest, item)
        digest.update(b"]")
    elif isinstance(part, np.generic):
        _feed(digest, part.item())
    elif isinstance(part, float):
        digest.update(f"float{part.hex()};".encode())
    elif part is None or isinstance(part, bool | int | str | complex):
        digest.update(f"{type(part).__name__}{json.dumps(str(part))};".encode())
    else:
        raise TypeError(f"content of type {type(part).__name__} can't be hashed")
