"""One recording as read: channels, plates, markers, events, where it came from, its edits."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache, wraps
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, Self, TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from underfoot.core import DataError, InputError, nearest_match, unknown_name
from underfoot.core.errors import first_names
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message

from .measurement import Flag

_T = TypeVar("_T")
_P = ParamSpec("_P")


def once_a_record(
    function: Callable[Concatenate[Any, _P], _T],
) -> Callable[Concatenate[Any, _P], _T]:
    """Return a function of a marker or plate that works each answer out once, as every step asks.

    An answer stays as long as the marker or plate does. ``function``: takes it, then what can be a
    key of a dictionary; nobody may write to what it returns.
    """
    answers: WeakKeyDictionary[Any, dict[Any, _T]] = WeakKeyDictionary()

    @wraps(function)
    def answer(record: Any, *args: _P.args, **kwargs: _P.kwargs) -> _T:
        of_record = answers.setdefault(record, {})
        key = args, tuple(sorted(kwargs.items()))
        if key not in of_record:
            of_record[key] = function(record, *args, **kwargs)
        return of_record[key]

    return answer


@dataclass(frozen=True, slots=True)
class Channel:
    """A measured quantity against time.

    ``values`` (n,) are in ``unit``, NaN where nothing was measured: a SI unit, ``"1"`` when
    dimensionless, ``""`` when unknown (raw numbers of the file). ``rate`` is in samples per second
    (the median one when ``times`` is given), ``start`` the time of the first sample (s). ``times``
    (n,), s, is there only when the samples are not equally spaced. ``note`` says what was done on
    reading, for example the unit in the file.
    """

    values: np.ndarray
    unit: str
    rate: float
    start: float = 0.0
    times: np.ndarray | None = None
    note: str = ""

    @property
    def time(self) -> np.ndarray:
        """Time of each sample (s), shape (n,)."""
        return _time(len(self.values), self.rate, self.start, self.times)


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False)
class Marker:
    """Path of one motion-capture marker in the laboratory's axes.

    ``positions`` (n, 3) are in m, NaN where the marker was not seen; the rest as in ``Channel``.
    """

    positions: np.ndarray
    rate: float
    start: float = 0.0
    times: np.ndarray | None = None
    note: str = ""

    @property
    def time(self) -> np.ndarray:
        """Time of each frame (s), shape (n,)."""
        return _time(len(self.positions), self.rate, self.start, self.times)

    @property
    def missing(self) -> np.ndarray:
        """True where the marker was not seen, shape (n,); not to be written to."""
        return _missing(self)


@once_a_record
def _missing(marker: Marker) -> np.ndarray:
    lost = np.asarray(~np.isfinite(marker.positions @ np.ones(3)))  # faster than all()
    lost.setflags(write=False)
    return lost


@dataclass(frozen=True, slots=True)
class PlateAccuracy:
    """Limits of a force plate's errors, as in its data sheet, and where they come from.

    ``gain`` is the largest relative error of a force component, ``crosstalk`` the largest shear
    that a vertical force makes by itself, as a share of it.
    """

    gain: float = 0.01
    crosstalk: float = 0.01
    source: str = "assumed: usual limits of data sheets, from memory, not verified"

    def __post_init__(self) -> None:
        if not (0 <= self.gain < 1 and 0 <= self.crosstalk < 1):
            raise InputError("gain and crosstalk are shares", where="accuracy", allowed="0 to 1")


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False)
class Plate:
    """One force plate: the force of the floor **on the foot**, in the laboratory's axes.

    ``force`` (n, 3), N, has its baseline subtracted and is empty when ``problem`` says why the
    plate can't be used. ``moment`` (n, 3), N m, is about the centre of the plate's surface;
    ``centre_of_pressure`` (n, 3), m, is NaN where the plate is unloaded; ``corners`` (4, 3), m.
    Each is None when the file does not hold it. ``rate`` (samples per second) and ``start`` (s)
    give the time. ``baseline`` (3,), N, is what was subtracted, None when nothing was, and
    ``baseline_samples`` the number of unloaded samples it is the mean of. ``kind`` is the plate's
    type in words, ``notes`` what reading assumed (units, ZERO ...), ``flags`` what a reader must
    know (baseline, saturation, unlikely size ...); ``saturated`` is True when a channel is cut flat
    at its extreme, ``accuracy`` what the specification says about the errors.
    """

    name: str
    force: np.ndarray
    rate: float
    start: float = 0.0
    moment: np.ndarray | None = None
    centre_of_pressure: np.ndarray | None = None
    corners: np.ndarray | None = None
    baseline: np.ndarray | None = None
    baseline_samples: int = 0
    kind: str = ""
    problem: str = ""
    notes: tuple[str, ...] = ()
    saturated: bool = False
    flags: tuple[Flag, ...] = ()
    accuracy: PlateAccuracy = PlateAccuracy()

    @property
    def time(self) -> np.ndarray:
        """Time of each sample (s), shape (n,)."""
        return _time(len(self.force), self.rate, self.start, None)

    @property
    def usable(self) -> bool:
        """True when the plate has forces."""
        return not self.problem and len(self.force) > 0

    @property
    def baseline_text(self) -> Message:
        """What was done about the baseline."""
        if self.baseline is None:
            return Message("not subtracted")
        here = Message(
            " ({count} {count:sample|samples}: {size} N)",
            count=self.baseline_samples,
            size=[f"{component:.1f}" for component in self.baseline],
        )
        return Message("mean force of the unloaded plate subtracted{here}", here=here)


@dataclass(frozen=True, slots=True)
class Event:
    """An instant with a name: ``"heel contact"``, ``"toe off"``, ``"slip start"`` ..."""

    name: str
    time: float
    side: str = ""
    source: str = "found"


@dataclass(frozen=True, slots=True)
class Vertical:
    """The axis that is up in a laboratory, and what told it.

    ``axis`` is a unit vector (3,) out of the floor, ``source`` is in words.
    """

    axis: tuple[float, float, float]
    source: str


REVERSED = "signs reversed"
"""Name of the flag of a plate whose file holds the force on the plate."""
MADE_UP = "underfoot trials simulate"
"""The software that a made-up recording names."""
EDITS = ("contact", "toe off", "exclude", "side", "plate")


@dataclass(frozen=True, slots=True)
class Edit:
    """A change by hand to one step.

    ``step`` is the number of the contact as ``describe`` prints it (int), or a time within it
    (float, s); ``what`` one of ``EDITS``; ``value`` the new time (s) for "contact" and "toe off",
    "left" or "right", the plate's name, or None for "exclude". ``why``, the reason, goes to the
    edit log; ``where`` is file and line of the edit, for messages. An unknown kind of edit, a value
    that does not fit it and a missing reason are InputErrors.
    """

    step: int | float
    what: str
    value: float | str | None
    why: str
    where: str = "edit"

    def __post_init__(self) -> None:
        if self.what not in EDITS:
            raise unknown_name("edit", self.what, EDITS, where=self.where)
        if not self.why.strip():
            raise InputError("an edit by hand needs its reason", where=self.where)
        if self.what in ("contact", "toe off") and not isinstance(self.value, float):
            raise InputError(
                Message("{what} needs a time", what=self.what),
                where=self.where,
                allowed='as "3.06 s"',
            )
        if self.what == "side" and self.value not in ("left", "right"):
            raise unknown_name("side", str(self.value), ("left", "right"), where=self.where)
        if self.what == "plate" and not self.value:
            raise InputError("plate needs the name of a plate", where=self.where)
        if self.what == "exclude" and self.value not in (None, ""):
            raise InputError(
                Message('exclude takes no value, not "{given}"', given=self.value), where=self.where
            )

    @property
    def step_words(self) -> str:
        """The step as the edit names it."""
        if isinstance(self.step, int):
            return Message("step {number}", number=self.step)
        return Message("step at {time:g} s", time=self.step)


@dataclass(frozen=True, slots=True, repr=False)
class Trial(Presentable):
    """One recording. Frozen: changes return a new trial.

    ``name`` is the file's without folder, with the step for files that hold several. ``channels``
    are by the name in the file (made unique); ``channel`` is a forgiving look-up. ``plates`` and
    ``markers`` are empty for tribometer logs. ``source`` names format and reader; ``checksum`` is
    the SHA-256 of the file's bytes (hex). ``notes`` tell what reading found or did (units
    converted, duplicates renamed, plates refused), ``events`` are those written in the file,
    ``edits`` the changes by hand that ``stances`` applies, ``settings`` facts of the header as text
    (set load, step type, subject mass in kg ...). ``vertical`` is the axis in which the plates were
    worked out, None where reading found none.
    """

    name: str
    channels: Mapping[str, Channel] = field(default_factory=dict)
    plates: tuple[Plate, ...] = ()
    markers: Mapping[str, Marker] = field(default_factory=dict)
    source: str = ""
    checksum: str = ""
    notes: tuple[str, ...] = ()
    events: tuple[Event, ...] = ()
    edits: tuple[Edit, ...] = ()
    settings: Mapping[str, str] = field(default_factory=dict)
    vertical: Vertical | None = None

    def channel(self, *names: str) -> Channel:
        """Return the first channel that has one of ``names`` (capitals and blanks ignored).

        A DataError, with what there is and the nearest match, when none of them is there.
        """
        return _find_name("channel", names, self.channels, self.name)

    def marker(self, *names: str) -> Marker:
        """Return the first marker that has one of ``names``, as ``channel`` does."""
        return _find_name("marker", names, self.markers, self.name)

    def with_edits(self, *edits: Edit) -> Self:
        """Return the trial with further edits; ``stances`` applies them or raises."""
        return replace(self, edits=(*self.edits, *edits))

    def with_notes(self, *notes: str) -> Self:
        """Return the trial with further notes."""
        return replace(self, notes=(*self.notes, *notes))

    def __repr__(self) -> str:
        parts = [f"{len(self.plates)} plates", f"{len(self.markers)} markers"]
        parts += [f"{len(self.channels)} channels", f"{len(self.events)} events"]
        parts += [f"{len(self.edits)} edits"] if self.edits else []
        return f"<Trial {self.name[:80]}: {self.source[:40]}, {', '.join(parts)}>"

    def table(self) -> Table:
        """Return plates, markers and channels: kind, samples, rate, remarks."""
        rows: list[tuple[str, str, int, float, str]] = []
        for p in self.plates:
            remarks = p.problem or "; ".join(map(str, p.flags))
            rows.append(("plate", p.name, len(p.force), p.rate, remarks))
        for name, m in self.markers.items():
            lost = Message("{sum} frames missing", sum=int(m.missing.sum()))
            rows.append(("marker", name, len(m.positions), m.rate, lost))
        for name, c in self.channels.items():
            rows.append(("channel", name, len(c.values), c.rate, c.unit or "unit not known"))
        return Table(self.name, ("kind", "name", "samples", "rate (Hz)", "remarks"), rows)


def join_trials(first: Trial, second: Trial) -> Trial:
    """Return one trial from two files of the same recording, for example .trc and .forces.

    Both must count time from the same instant and be in the same axes. Names that both use get the
    ending `` (2)``. Which end of the vertical is up the file with the markers tells: their feet.
    """

    def both(base: Mapping[str, _T], added: Mapping[str, _T]) -> dict[str, _T]:
        return {**base, **{f"{n} (2)" if n in base else n: value for n, value in added.items()}}

    pair, notes = [first, second], list(second.notes)
    told = next((trial.vertical for trial in pair if trial.plates), first.vertical)
    ends = [trial.vertical for trial in pair if trial.vertical]
    if len(ends) == 2 and not (first.markers and second.markers):
        along = sum(a * b for a, b in zip(ends[0].axis, ends[1].axis, strict=True))
        if along < -0.5:
            told = next((trial.vertical for trial in pair if trial.markers), told)
            pair = [trial if trial.vertical == told else _other_end_up(trial) for trial in pair]
        elif along < 0.5:
            notes.append("the two files find another axis vertical: are they in the same axes?")
    first, second = pair
    return replace(
        first.with_notes(*notes).with_edits(*second.edits),
        name=f"{first.name} + {second.name}",
        channels=both(first.channels, second.channels),
        plates=(*first.plates, *second.plates),
        markers=both(first.markers, second.markers),
        source=f"{first.source} + {second.source}",
        checksum=hashlib.sha256(f"{first.checksum}{second.checksum}".encode()).hexdigest(),
        events=(*first.events, *second.events),
        settings={**first.settings, **second.settings},
        vertical=told,
    )


def _other_end_up(trial: Trial) -> Trial:
    """The trial with forces that point the other way: its plates were read upside down."""

    def other(plate: Plate) -> Plate:
        moment = None if plate.moment is None else -plate.moment
        baseline = None if plate.baseline is None else -plate.baseline
        flags = tuple(flag for flag in plate.flags if flag.name != REVERSED)
        return replace(plate, force=-plate.force, moment=moment, baseline=baseline, flags=flags)

    return replace(trial, plates=tuple(other(plate) for plate in trial.plates))


def file_checksum(path: Path) -> str:
    """Return the SHA-256 of a file's bytes (hex)."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _find_name(kind: str, names: tuple[str, ...], known: Mapping[str, _T], where: str) -> _T:
    folded: dict[str, _T] = {}
    for name in names:
        if name in known:
            return known[name]
        folded = folded or {_fold_name(key): value for key, value in reversed(list(known.items()))}
        if _fold_name(name) in folded:
            return folded[_fold_name(name)]
    listed = list(known)
    raise DataError(
        Message("no {kind} named {names}", kind=kind, names=" or ".join(names)),
        where=where,
        allowed=first_names(listed) or Message("the trial has no {kind}s", kind=kind),
        nearest=nearest_match(names[0], listed) if names else None,
        remedy="Name the columns in a profile file",
    )


def _fold_name(name: str) -> str:
    return "".join(letter for letter in name.casefold() if letter.isalnum())


def _time(n: int, rate: float, start: float, times: np.ndarray | None) -> np.ndarray:
    return _even_times(n, rate, start) if times is None else times


@lru_cache(maxsize=64)  # asked for hundreds of times a recording
def _even_times(n: int, rate: float, start: float) -> np.ndarray:
    times = start + np.arange(n) / rate
    times.setflags(write=False)
    return times
