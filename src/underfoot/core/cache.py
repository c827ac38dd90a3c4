"""On-disk cache of arrays, keyed by the content of what they were computed from."""

import os
import shutil
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from .files import whole_file
from .identity import program_hash

FORGOTTEN = 30 * 86400.0
"""s without a new entry, after which the next program removes what another one stored."""


class Cache:
    """Arrays stored under a content key; a damaged or missing entry is simply computed again.

    ``room`` names the part of the program that owns the entries. An entry is of the program that
    stored it: no other version finds it. Entries lie in ``folder``, by default that of
    ``default_folder()``.
    """

    def __init__(self, room: str, folder: Path | None = None) -> None:
        self.folder = Path(folder or default_folder()) / room / program_hash()[:16]

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
        if not self.folder.is_dir():
            self._forget_others()
        with whole_file(self.folder / f"{key}.npz") as part, part.open("wb") as stream:
            np.savez_compressed(stream, **plain)

    def _forget_others(self) -> None:
        """Remove what programs stored that have not been used for long."""
        oldest = time.time() - FORGOTTEN
        for other in self.folder.parent.glob("*"):
            with suppress(OSError):
                if other.is_file() or other.stat().st_mtime < oldest:
                    shutil.rmtree(other) if other.is_dir() else other.unlink()


def default_folder() -> Path:
    """Return the cache folder: ``UNDERFOOT_CACHE`` if set, else the user's cache folder."""
    if chosen := os.environ.get("UNDERFOOT_CACHE"):
        return Path(chosen)
    from platformdirs import user_cache_path

    return user_cache_path("underfoot")
