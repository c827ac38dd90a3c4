"""What one file gave: numbers, rules kept or broken, a verdict, and curves for the figures."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Self

import numpy as np

from ..measurement import Measurement
from ..protocols import Protocol
from ..trial import Trial

ACCEPTED, CAUTION, REFUSED = "accepted", "caution", "refused"
_POINTS = 400
MEAN_OF_STEPS = "mean of the steps"  # the item that stands for all steps of a file


@dataclass(frozen=True, slots=True)
class FileResult:
    """Outcome of one file.

    ``file`` and ``checksum``: name and SHA-256. ``verdict``: "accepted", "caution" (read the
    reasons before using the numbers) or "refused". ``reasons``: why, in words. ``measurements``:
    one entry per number: item (trial, step, sensor), then as ``Measurement.as_dict``. ``main``: the
    numbers that stand for the file in tables: name to SI value. ``facts``: what the rules were
    checked against. ``curves``: series for figures, thinned. ``conditions``: what the laboratory
    noted about the file. ``edits``: the edit log: step, what, before, after, rcof before and after,
    why. ``steps``: one entry per contact with a plate: number, plate, side, contact, toe off, RCOF
    or the reason of its rejection, verdict, flags, and the gait around it.
    """

    file: str
    checksum: str = ""
    verdict: str = ACCEPTED
    reasons: tuple[str, ...] = ()
    measurements: tuple[Mapping[str, Any], ...] = ()
    main: Mapping[str, float] = field(default_factory=dict)
    facts: Mapping[str, float] = field(default_factory=dict)
    curves: Mapping[str, Any] = field(default_factory=dict)
    conditions: Mapping[str, Any] = field(default_factory=dict)
    edits: tuple[Mapping[str, Any], ...] = ()
    steps: tuple[Mapping[str, Any], ...] = ()

    @property
    def usable(self) -> bool:
        """True when the numbers may enter the tables of the study."""
        return self.verdict != REFUSED

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Return the result written by ``as_dict``."""
        plain: dict[str, Any] = {
            key: tuple(v) if isinstance(v, list) else v for key, v in data.items()
        }
        return cls(**plain)


class Draft:
    """Collects what one file gives while it is analysed."""

    def __init__(self, file: str, conditions: Mapping[str, Any], checksum: str = "") -> None:
        self.file, self.checksum = file, checksum
        self.conditions = dict(conditions)
        self.main: dict[str, float] = {}
        self.facts: dict[str, float] = {}
        self.curves: dict[str, Any] = {}
        self.cautions: list[str] = []
        self.refusals: list[str] = []
        self.measurements: list[dict[str, Any]] = []
        self.edits: list[dict[str, Any]] = []
        self.steps: list[dict[str, Any]] = []

    def add(self, item: str, measurement: Measurement, *, main: str = "") -> None:
        """Keep a number; ``main`` names it as the file's own number of that kind."""
        self.measurements.append({"item": item, **measurement.as_dict()})
        if main and measurement.value is not None:
            self.main[main] = measurement.value

    def curve(self, name: str, **series: Any) -> None:
        """Keep curves for a figure, all thinned to at most 400 points in the same way."""
        out: dict[str, Any] = {}
        for key, values in series.items():
            if isinstance(values, np.ndarray):
                step = max(1, math.ceil(len(values) / _POINTS))
                out[key] = [_rounded(v) for v in np.asarray(values, dtype=float)[::step].tolist()]
            else:
                out[key] = _rounded(values) if isinstance(values, float) else values
        self.curves.setdefault(name, []).append(out)

    def finished(self, protocol: Protocol) -> FileResult:
        """Check the rules and return the result with its verdict."""
        for rule in protocol.rules:
            broken = rule.quantity in self.facts and rule.broken_by(self.facts[rule.quantity])
            if broken:
                (self.refusals if rule.severity == "refuse" else self.cautions).append(broken)
        for entry in self.measurements:
            self.cautions += [
                f"{entry['item']}: {flag['words']}" for flag in entry["flags"] if flag["matters"]
            ]
        verdict = REFUSED if self.refusals else CAUTION if self.cautions else ACCEPTED
        reasons = dict.fromkeys([*self.refusals, *self.cautions])
        own = {k: v for k, v in vars(self).items() if k not in ("cautions", "refusals")}
        return FileResult.from_dict({**own, "verdict": verdict, "reasons": list(reasons)})


def rates(trial: Trial, draft: Draft) -> None:
    """Note the sampling rates of forces and markers, which rules are about."""
    found = [plate.rate for plate in trial.plates if plate.usable]
    if found:
        draft.facts["force_rate"] = float(min(found))
    if trial.markers:
        draft.facts["marker_rate"] = float(next(iter(trial.markers.values())).rate)


def _rounded(value: float) -> float | None:
    """Seven digits are more than any instrument gives; NaN is not JSON."""
    return float(f"{value:.7g}") if math.isfinite(value) else None
