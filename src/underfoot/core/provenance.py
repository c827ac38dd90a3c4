"""Where a result comes from: versions, closures, citations, errata and timings."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from .cache import content_hash


def package_version(name: str) -> str:
    """Return the version of a package, "unknown" where it is not recorded.

    An application that was frozen, or a folder on the path, carries no record of versions.
    """
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "unknown"


def version() -> str:
    """Return the version of this package."""
    return package_version("underfoot")


@cache
def program_hash() -> str:
    """Return a hash of the package's own text: numbers of another code are not ours."""
    return files_hash((str(Path(__file__).parents[1]),))


def files_hash(folders: Sequence[str]) -> str:
    """Return a hash of the program and data files in folders."""
    paths = (path for folder in folders for path in sorted(Path(folder).rglob("*")))
    texts = (path for path in paths if path.suffix in (".py", ".toml", ".csv"))
    return content_hash(*(path.read_text(encoding="utf-8", errors="replace") for path in texts))


@dataclass(frozen=True, slots=True)
class Provenance:
    """Everything needed to make a result again."""

    case_hash: str
    closures: dict[str, str] = field(default_factory=dict)
    citations: tuple[str, ...] = ()
    errata: tuple[str, ...] = ()
    timings: dict[str, float] = field(default_factory=dict)
    versions: dict[str, str] = field(default_factory=dict)
    created: str = ""
    objects: dict[str, str] = field(default_factory=dict)
    """slot: object given to ``run`` in place of the case's option"""

    @classmethod
    def now(cls, case_hash: str, *, closures: dict[str, str], **given: Any) -> Provenance:
        """Return a provenance stamped with the present time and the versions in use."""
        versions = {name: package_version(name) for name in ("underfoot", "numpy", "scipy")}
        versions["python"] = platform.python_version()
        created = datetime.now(UTC).isoformat(timespec="seconds")
        return cls(case_hash, closures, versions=versions, created=created, **given)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return asdict(self)
