"""What a study of whole shoes or people returns: statements, tables, words, data for figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from .pin_study import PinLine, PinTable
from .verdict import Erratum


@dataclass(frozen=True, slots=True, eq=False)
class StudyResult:
    """Statements beside ours and what they stand on.

    ``data`` holds the objects that the study's figures draw; it is not part of ``as_dict``.
    """

    name: str
    lines: tuple[PinLine, ...]
    tables: tuple[PinTable, ...]
    conclusions: tuple[str, ...]
    errata: tuple[Erratum, ...]
    notes: tuple[str, ...]
    assumptions: tuple[str, ...]
    seconds: float
    process_seconds: float
    data: Mapping[str, Any] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON (SI units)."""
        return {
            "study": self.name,
            "lines": [{**asdict(line), "verdict": str(line.verdict)} for line in self.lines],
            "tables": [asdict(table) for table in self.tables],
            "conclusions": list(self.conclusions),
            "errata": [asdict(one) for one in self.errata],
            "notes": list(self.notes),
            "assumptions": list(self.assumptions),
            "seconds": self.seconds,
            "process_seconds": self.process_seconds,
        }
