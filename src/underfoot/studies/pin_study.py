"""What the studies of the pin-on-disk return: tables, printed statements beside ours, words."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .verdict import Erratum, Verdict


@dataclass(frozen=True, slots=True)
class PinLine:
    """One printed or wanted statement beside ours; ``difference`` is ours against printed."""

    quantity: str
    source: str
    printed: str
    ours: str
    verdict: Verdict
    reason: str
    difference: str = ""


@dataclass(frozen=True, slots=True)
class PinTable:
    """A table: ``columns`` and ``rows`` of numbers (None where not available) or words."""

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str | float | None, ...], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """COF of one fluid at speeds (m/s), predicted and as published, with its interval."""

    label: str
    viscosity: float
    speed: np.ndarray
    published: np.ndarray
    kind: str
    predicted: np.ndarray | None = None
    low: np.ndarray | None = None
    high: np.ndarray | None = None


@dataclass(frozen=True, slots=True, eq=False)
class PinStudy:
    """Tables, lines, curves and what they say.

    ``master`` holds viscosity x speed (Pa m) and COF of the one curve fitted to all fluids.
    """

    name: str
    lines: tuple[PinLine, ...]
    tables: tuple[PinTable, ...]
    conclusions: tuple[str, ...]
    errata: tuple[Erratum, ...]
    notes: tuple[str, ...]
    seconds: float
    curves: tuple[Curve, ...] = ()
    master: tuple[np.ndarray, np.ndarray] | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON (SI units)."""
        return {
            "study": self.name,
            "lines": [{**asdict(line), "verdict": str(line.verdict)} for line in self.lines],
            "tables": [asdict(table) for table in self.tables],
            "conclusions": list(self.conclusions),
            "errata": [asdict(one) for one in self.errata],
            "notes": list(self.notes),
            "curves": [
                {
                    "label": c.label,
                    "viscosity": c.viscosity,
                    "speed": c.speed.tolist(),
                    "published": c.published.tolist(),
                    "kind": c.kind,
                    **{
                        key: None if value is None else value.tolist()
                        for key, value in (
                            ("predicted", c.predicted), ("low", c.low), ("high", c.high)
                        )
                    },
                }
                for c in self.curves
            ],
            "seconds": self.seconds,
        }  # fmt: skip
