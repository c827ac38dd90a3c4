"""What one file gave: numbers, rules kept or broken, a verdict, and curves for the figures."""

import math
from array import array
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Literal, Self

import numpy as np

from underfoot.core.remark import NOTHING, Message, subjects

from ..recording.measurement import UNNAMED, Flag, Measurement
from ..recording.protocols import Protocol
from ..recording.tester_calibration import FAILED, TesterCalibration
from ..recording.trial import Trial
from ..walking.gait_context import GaitContext

ACCEPTED, CAUTION, REFUSED = "accepted", "caution", "refused"
_POINTS = 400


@dataclass(frozen=True, slots=True, repr=False)
class Number(Measurement):
    """One number of a file: a measurement, what it was measured on and what it counts as.

    ``item``: trial, step or sensor; "" for a number of the whole file, which stands in no table of
    measurements. ``main``: name under which it stands for the file in tables. ``fact``: name under
    which the rules of a protocol judge it. Both are "" where it does neither.
    """

    item: str = ""
    main: str = ""
    fact: str = ""

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Return the number written by ``as_dict``."""
        return cls(**{**data, "flags": tuple(Flag(**flag) for flag in data["flags"])})


@dataclass(frozen=True, slots=True, kw_only=True)
class StepResult(GaitContext):
    """One contact with a plate: its numbers (SI), verdict and the walk around it.

    ``number``, ``plate``, ``side``, ``contact``, ``toe_off``, ``by_hand``: as of its ``Stance``;
    ``item``: its name in tables. ``rcof``: None where ``reason`` says why it is rejected.
    ``judged_for_slip``: True for
    the contact of a trial whose slip was measured. What follows is of this contact alone:
    ``slipped``, None where it could not be judged, ``outcome`` in words, ``slip_direction``, and
    what ``SlipCourse`` tells.
    """

    number: int = 0
    item: str = ""
    plate: str = ""
    side: str = "unknown"
    contact: float = 0.0
    toe_off: float = 0.0
    stance_time: float = 0.0
    peak_force: float = 0.0
    rcof: float | None = None
    rcof_uncertainty: float | None = None
    verdict: str = "rejected"
    reason: Message = NOTHING
    cautions: tuple[str, ...] = ()
    by_hand: tuple[str, ...] = ()
    judged_for_slip: bool = False
    slipped: bool | None = None
    peak_slipping_speed: float | None = None
    slip_start: float | None = None
    slip_distance: float | None = None
    outcome: str | None = None
    slip_direction: str = ""
    recovery_or_fall: str = ""
    recovery_or_fall_reason: Message = NOTHING
    toe_slip: float | None = None
    trailing_slip: float | None = None
    misstep: Message = NOTHING


@dataclass(frozen=True, slots=True)
class LoggedEdit:
    """An edit by hand and what it did: event and number, before and after, and why.

    ``step``: its name, of a file without steps the file's. ``quantity``: what the numbers (SI, None
    where there is none) are of; "" where no number was followed.
    """

    step: str
    what: str
    before: str
    after: str
    why: str
    quantity: str = ""
    number_before: float | None = None
    number_after: float | None = None


@dataclass(frozen=True, slots=True)
class Sample:
    """Readings of one sample of a table.

    ``source``: name of the table that it stands in. ``readings``: those that count, less that of
    zero. ``scheme``: name of the classes that they
    belong to, or "". ``boards``: (standard angle, angle read, its u) in degrees of each calibration
    board that the walker of a ramp read.
    """

    source: str = ""
    readings: tuple[float, ...] = ()
    scheme: str = ""
    boards: tuple[tuple[float, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class FileResult:
    """Outcome of one file.

    ``file`` and ``checksum``: name and SHA-256. ``run``: place among the results of its recording,
    from 1. ``verdict``: "accepted", "caution" (read the
    reasons before using the numbers) or "refused". ``reasons``: why, in words; ``kinds``: the same
    without the numbers and places of this file, each once. ``numbers``: all numbers of the file, a
    row each. ``curves``: series for figures, thinned. ``conditions``: what the laboratory noted
    about the file. ``edits``: the edit log. ``steps``: the contacts with plates, rejected ones too.
    ``body``: what ``person_measures`` tells of who walked. ``sample``: readings of a machine.

    Taken from the numbers: ``main`` holds those that stand for the file in tables, ``facts`` what
    the rules were checked against, both as SI value by name.
    """

    file: str
    checksum: str = ""
    verdict: str = ACCEPTED
    reasons: tuple[str, ...] = ()
    kinds: tuple[str, ...] = ()
    numbers: tuple[Number, ...] = ()
    curves: Mapping[str, Any] = field(default_factory=dict)
    conditions: Mapping[str, Any] = field(default_factory=dict)
    edits: tuple[LoggedEdit, ...] = ()
    steps: tuple[StepResult, ...] = ()
    body: Mapping[str, float] = field(default_factory=dict)
    sample: Sample = Sample()
    run: int = 1
    main: Mapping[str, float] = field(init=False, repr=False, compare=False)
    facts: Mapping[str, float] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "main", _values(self.numbers, "main"))
        object.__setattr__(self, "facts", _values(self.numbers, "fact"))

    @property
    def usable(self) -> bool:
        """True when the numbers may enter the tables of the study."""
        return self.verdict != REFUSED

    @property
    def measurements(self) -> tuple[Number, ...]:
        """Numbers measured on an item of the file."""
        return tuple(number for number in self.numbers if number.item)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data; curves are arrays of numbers, NaN where there is a gap."""
        rows = {kind: [*map(parts, getattr(self, kind))] for kind in ("edits", "steps")}
        rows["numbers"] = [number.as_dict() for number in self.numbers]
        return {**parts(self), **rows, "sample": parts(self.sample)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Return the result written by ``as_dict``."""
        numbers = tuple(map(Number.from_dict, data["numbers"]))
        steps = tuple(StepResult(**_with_tuples(step)) for step in data["steps"])
        edits = tuple(LoggedEdit(**edit) for edit in data["edits"])
        readings = _with_tuples(data["sample"])
        sample = Sample(**{**readings, "boards": tuple(map(tuple, readings["boards"]))})
        rows = {"numbers": numbers, "edits": edits, "steps": steps, "sample": sample}
        return cls(**{**_with_tuples(data), **rows, "curves": _pack_curves(data["curves"])})


def parts(row: FileResult | LoggedEdit | Measurement | Sample | StepResult) -> dict[str, Any]:
    """Return what a row was made of, by name."""
    return {part.name: getattr(row, part.name) for part in fields(row) if part.init}


def _with_tuples(data: Mapping[str, Any]) -> dict[str, Any]:
    return {key: tuple(v) if isinstance(v, list) else v for key, v in data.items()}


def _values(numbers: Iterable[Number], role: Literal["main", "fact"]) -> dict[str, float]:
    """Return the SI values of the numbers that have a name in a ``role``, by this name."""
    names = ((getattr(number, role), number.value) for number in numbers)
    return {name: value for name, value in names if name and value is not None}


class FileResultDraft:
    """Collects what one file gives while it is analysed."""

    def __init__(self, file: str, conditions: Mapping[str, Any], checksum: str = "") -> None:
        self.file, self.checksum = file, checksum
        self.conditions = dict(conditions)
        self.numbers: list[Number] = []
        self.curves: dict[str, Any] = {}
        self.cautions: list[Message] = []
        self.refusals: list[Message] = []
        self.edits: list[LoggedEdit] = []
        self.steps: list[StepResult] = []
        self.body: dict[str, float] = {}
        self.sample = Sample()

    def add(self, item: str, measurement: Measurement, *, main: str = "") -> None:
        """Keep a number; ``main`` names it as the file's own number of that kind."""
        self.numbers.append(Number(**parts(measurement), item=item, main=main))

    def note(self, value: float, unit: str, *, main: str = "", fact: str = "") -> None:
        """Keep a number of the whole file under its name among the main ones, the facts or both."""
        if math.isfinite(value):
            self.numbers.append(Number(main or fact, float(value), unit, main=main, fact=fact))

    @property
    def main(self) -> dict[str, float]:
        """The numbers that stand for the file so far."""
        return _values(self.numbers, "main")

    def curve(self, name: str, **series: Any) -> None:
        """Keep curves for a figure, all thinned to at most 400 points in the same way."""
        out: dict[str, Any] = {}
        for key, values in series.items():
            if isinstance(values, np.ndarray):
                step = max(1, math.ceil(len(values) / _POINTS))
                out[key] = array("d", _round_values(np.asarray(values, dtype=float)[::step]))
            elif isinstance(values, float):
                out[key] = float(_round_values(np.array(values))) if math.isfinite(values) else None
            else:
                out[key] = values
        self.curves.setdefault(name, []).append(out)

    def finish_result(self, protocol: Protocol) -> FileResult:
        """Check the rules and return the result with its verdict."""
        kinds = list(subjects([*self.refusals, *self.cautions]))
        facts = _values(self.numbers, "fact")
        for rule in protocol.rules:
            broken = rule.broken_by(facts[rule.quantity]) if rule.quantity in facts else None
            if broken:
                kinds.append(rule.statement())
                (self.refusals if rule.severity == "refuse" else self.cautions).append(broken)
        for number in self.numbers:
            flags = number.caution_flags
            self.cautions += [
                Message("{item}: {message}", item=number.item, message=flag.message)
                for flag in flags
            ]
            kinds += [flag.message if flag.name == UNNAMED else flag.name for flag in flags]
        verdict = REFUSED if self.refusals else CAUTION if self.cautions else ACCEPTED
        return FileResult(
            self.file,
            self.checksum,
            verdict,
            reasons=tuple(dict.fromkeys([*self.refusals, *self.cautions])),
            kinds=tuple(dict.fromkeys(kinds)),
            numbers=tuple(self.numbers),
            curves=_pack_curves(self.curves),
            conditions=self.conditions,
            edits=tuple(self.edits),
            steps=tuple(self.steps),
            body=self.body,
            sample=self.sample,
        )


def rates(trial: Trial, draft: FileResultDraft) -> None:
    """Note the sampling rates of forces and markers, which rules are about."""
    found = [plate.rate for plate in trial.plates if plate.usable]
    if found:
        draft.note(min(found), "Hz", fact="force_rate")
    if trial.markers:
        draft.note(next(iter(trial.markers.values())).rate, "Hz", fact="marker_rate")


def refer_to(record: TesterCalibration | None, draft: FileResultDraft) -> None:
    """Note what the calibration record says of the day a file was made; a failed check refuses."""
    for flag in () if record is None else record.flags(draft.conditions.get("date")):
        (draft.refusals if flag.name == FAILED else draft.cautions).append(flag.message)


def _round_values(values: np.ndarray) -> np.ndarray:
    """Seven digits are more than any instrument gives."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        scale = 10.0 ** (6.0 - np.floor(np.log10(np.abs(values))))
        rounded = np.round(values * scale) / scale
    return np.where(np.isfinite(rounded), rounded, np.where(values == 0.0, 0.0, np.nan))


def _pack_curves(value: Any) -> Any:
    """Return stored curves with their lists of numbers as arrays: a quarter of the memory."""
    if isinstance(value, dict):
        return {key: _pack_curves(one) for key, one in value.items()}
    if not isinstance(value, list):
        return value
    if value and all(one is None or type(one) is float for one in value):
        return array("d", [math.nan if one is None else one for one in value])
    return [_pack_curves(one) for one in value]
