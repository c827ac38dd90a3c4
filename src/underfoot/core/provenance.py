"""Where a result comes from: versions, closures, citations, errata and timings."""

from __future__ import annotations

import platform
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from typing import Any

from .fourier import fourier_library
from .identity import content_hash, package_version, program_hash
from .sparse import back_end
from .threads import threads_in_use


def version() -> str:
    """Return the version of this package."""
    return package_version("underfoot")


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
    result_hash: str = ""
    """Of all that made the numbers: the case, the grid, this program and its libraries."""
    threads: int = 0
    """Of the libraries of linear algebra; the numbers don't depend on it. 0: not recorded."""

    @classmethod
    def now(
        cls, case_hash: str, *, grid: float, closures: dict[str, str], **given: Any
    ) -> Provenance:
        """Return a provenance stamped with the present time and the versions in use.

        ``grid`` is the spacing (m) of the cells.
        """
        versions = {name: package_version(name) for name in ("underfoot", "numpy", "scipy")}
        libraries = [versions["numpy"], versions["scipy"], back_end(), fourier_library()]
        versions["python"] = platform.python_version()
        return cls(
            case_hash,
            closures,
            versions=versions,
            created=datetime.now(UTC).isoformat(timespec="seconds"),
            result_hash=content_hash(case_hash, grid, program_hash(), libraries)[:32],
            threads=threads_in_use(),
            **given,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return asdict(self)
