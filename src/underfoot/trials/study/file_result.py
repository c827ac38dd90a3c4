"""What one file gave: numbers, rules kept or broken, a verdict, and curves for the figures."""

import math
from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Self

import numpy as np

from underfoot.core.remark import remarks, subjects

from ..recording.measurement import UNNAMED, Choice, Measurement
from ..recording.protocols import Protocol
from ..recording.tester_calibration import FAILED, TesterCalibration
from ..recording.trial import Trial

ACCEPTED, CAUTION, REFUSED = "accepted", "caution", "refused"
_POINTS = 400


@dataclass(frozen=True, slots=True)
class FileResult:
    """Outcome of one file.

    ``file`` and ``checksum``: name and SHA-256. ``verdict``: "accepted", "caution" (read the
    reasons before using the numbers) or "refused". ``reasons``: why, in words; ``kinds``: the same
    without the numbers and places of this file, each once. ``measurements``:
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
    kinds: tuple[str, ...] = ()
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
        """Return plain data; curves are arrays of numbers, NaN where there is a gap."""
        data = {one.name: getattr(self, one.name) for one in fields(self)}
        return {**data, "measurements": [_with_choices(m, _parts) for m in self.measurements]}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Return the result written by ``as_dict``."""
        plain: dict[str, Any] = {
            key: tuple(v) if isinstance(v, list) else v for key, v in data.items()
        }
        numbers = tuple(_with_choices(m, _whole) for m in plain.get("measurements", ()))
        curves = _packed(plain.get("curves", {}))
        return cls(**{**plain, "measurements": numbers, "curves": curves})


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
                out[key] = array("d", _rounded(np.asarray(values, dtype=float)[::step]))
            elif isinstance(values, float):
                out[key] = float(_rounded(np.array(values))) if math.isfinite(values) else None
            else:
                out[key] = values
        self.curves.setdefault(name, []).append(out)

    def finished(self, protocol: Protocol) -> FileResult:
        """Check the rules and return the result with its verdict."""
        kinds = list(subjects(remarks([*self.refusals, *self.cautions])))
        for rule in protocol.rules:
            broken = rule.quantity in self.facts and rule.broken_by(self.facts[rule.quantity])
            if broken:
                kinds.append(rule.statement())
                (self.refusals if rule.severity == "refuse" else self.cautions).append(broken)
        for entry in self.measurements:
            flags = [flag for flag in entry["flags"] if flag["matters"]]
            self.cautions += [f"{entry['item']}: {flag['message']}" for flag in flags]
            kinds += [
                flag["message"] if flag["name"] == UNNAMED else flag["name"] for flag in flags
            ]
        verdict = REFUSED if self.refusals else CAUTION if self.cautions else ACCEPTED
        reasons = dict.fromkeys([*self.refusals, *self.cautions])
        own = {k: v for k, v in vars(self).items() if k not in ("cautions", "refusals")}
        whole = {**own, "reasons": list(reasons), "kinds": list(dict.fromkeys(kinds))}
        return FileResult.from_dict({**whole, "verdict": verdict})


def rates(trial: Trial, draft: Draft) -> None:
    """Note the sampling rates of forces and markers, which rules are about."""
    found = [plate.rate for plate in trial.plates if plate.usable]
    if found:
        draft.facts["force_rate"] = float(min(found))
    if trial.markers:
        draft.facts["marker_rate"] = float(next(iter(trial.markers.values())).rate)


def refer_to(record: TesterCalibration | None, draft: Draft) -> None:
    """Note what the calibration record says of the day a file was made; a failed check refuses."""
    for flag in () if record is None else record.flags(draft.conditions.get("date")):
        (draft.refusals if flag.name == FAILED else draft.cautions).append(flag.message)


def _with_choices(
    measurement: Mapping[str, Any], change: Callable[[Any], Any]
) -> Mapping[str, Any]:
    """Return a stored number with each of its conventions changed."""
    conventions = measurement.get("conventions", {})
    return {**measurement, "conventions": {key: change(one) for key, one in conventions.items()}}


def _parts(convention: str) -> str | list[Any]:
    """Return what a file holds of a convention."""
    if not isinstance(convention, Choice):
        return convention
    return [convention.kind, list(convention.numbers), str(convention)]


def _whole(stored: Any) -> str:
    """Return the convention that a file holds in parts."""
    return Choice.stored(stored) if isinstance(stored, list) else stored


def _rounded(values: np.ndarray) -> np.ndarray:
    """Seven digits are more than any instrument gives."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        scale = 10.0 ** (6.0 - np.floor(np.log10(np.abs(values))))
        rounded = np.round(values * scale) / scale
    return np.where(np.isfinite(rounded), rounded, np.where(values == 0.0, 0.0, np.nan))


def _packed(value: Any) -> Any:
    """Return stored curves with their lists of numbers as arrays: a quarter of the memory."""
    if isinstance(value, dict):
        return {key: _packed(one) for key, one in value.items()}
    if not isinstance(value, list):
        return value
    if value and all(one is None or type(one) is float for one in value):
        return array("d", [math.nan if one is None else one for one in value])
    return [_packed(one) for one in value]
