"""One recording as read: channels, plates, markers, events, where it came from, its edits."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from underfoot.core import DataError, InputError, nearest_match, unknown_name
from underfoot.core.presentation import Presentable, Table

from .measurement import Flag

_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class Channel:
    """A measured quantity against time.

    Parameters
    ----------
    values
        Shape (n,), in ``unit``; NaN where nothing was measured.
    unit
        SI unit; ``"1"`` dimensionless, ``""`` unknown (raw numbers of the file).
    rate
        Samples per second (the median one when ``times`` is given).
    start
        Time of the first sample (s).
    times
        Shape (n,), s; only when the samples are not equally spaced.
    note
        What was done on reading, for example the unit in the file.
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


@dataclass(frozen=True, slots=True)
class Marker:
    """Path of one motion-capture marker in the laboratory's axes.

    Parameters
    ----------
    positions
        Shape (n, 3), m; NaN where the marker was not seen.
    rate, start, times
        As for ``Channel``.
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
        """True where the marker was not seen, shape (n,)."""
        return np.asarray(~np.isfinite(self.positions).all(axis=1))


@dataclass(frozen=True, slots=True)
class PlateAccuracy:
    """Limits of a force plate's errors, as in its data sheet.

    Parameters
    ----------
    gain
        Largest relative error of a force component.
    crosstalk
        Largest shear that a vertical force makes by itself, as a share of it.
    source
        Where both come from.
    """

    gain: float = 0.01
    crosstalk: float = 0.01
    source: str = "assumed: usual limits of data sheets, from memory, not verified"

    def __post_init__(self) -> None:
        if not (0 <= self.gain < 1 and 0 <= self.crosstalk < 1):
            raise InputError("gain and crosstalk are shares", where="accuracy", allowed="0 to 1")


@dataclass(frozen=True, slots=True)
class Plate:
    """One force plate: the force of the floor **on the foot**, in the laboratory's axes.

    Parameters
    ----------
    name
        For example ``"plate 1"``.
    force
        Shape (n, 3), N; empty when ``problem`` is set. Baseline already subtracted.
    moment
        Shape (n, 3), N m, about the centre of the plate's surface, or None.
    centre_of_pressure
        Shape (n, 3), m, NaN where the plate is unloaded, or None.
    rate, start
        Samples per second and time of the first sample (s).
    corners
        Shape (4, 3), m, or None when the file does not hold them.
    baseline
        Force that was subtracted (N), shape (3,), laboratory axes; None when nothing was.
    baseline_samples
        Number of unloaded samples it is the mean of.
    kind
        Plate type in words.
    problem
        Why this plate can't be used; empty when it can.
    notes
        What reading assumed: units, ZERO ...
    saturated
        True when a channel is cut flat at its extreme.
    flags
        What a reader must know: baseline, saturation, unlikely size ...
    accuracy
        What the plate's specification says about its errors.
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


@dataclass(frozen=True, slots=True)
class Event:
    """An instant with a name: ``"heel contact"``, ``"toe off"``, ``"slip start"`` ..."""

    name: str
    time: float
    side: str = ""
    source: str = "found"


EDITS = ("contact", "toe off", "exclude", "side", "plate")


@dataclass(frozen=True, slots=True)
class Edit:
    """A change by hand to one step.

    Parameters
    ----------
    step
        Number of the contact as ``describe`` prints it (int), or a time within it (float, s).
    what
        One of ``EDITS``.
    value
        New time (s) for "contact" and "toe off"; "left" or "right"; the plate's name; None for
        "exclude".
    why
        The reason; it goes to the edit log.
    where
        File and line of the edit, for messages.

    Raises
    ------
    InputError
        An unknown kind of edit, a value that does not fit it, no reason.
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
            raise InputError(f"{self.what} needs a time", where=self.where, allowed='as "3.06 s"')
        if self.what == "side" and self.value not in ("left", "right"):
            raise unknown_name("side", str(self.value), ("left", "right"), where=self.where)
        if self.what == "plate" and not self.value:
            raise InputError("plate needs the name of a plate", where=self.where)
        if self.what == "exclude" and self.value not in (None, ""):
            raise InputError(f'exclude takes no value, not "{self.value}"', where=self.where)

    @property
    def step_words(self) -> str:
        """The step as the edit names it."""
        return f"step {self.step}" if isinstance(self.step, int) else f"step at {self.step:g} s"


@dataclass(frozen=True, slots=True, repr=False)
class Trial(Presentable):
    """One recording. Frozen: changes return a new trial.

    Parameters
    ----------
    name
        File name without folder, with the step for files that hold several.
    channels
        By the name in the file (made unique); see ``channel`` for a forgiving look-up.
    plates, markers
        Force plates and marker paths; empty for tribometer logs.
    source
        Format and reader in words.
    checksum
        SHA-256 of the file's bytes (hex).
    notes
        What reading found or did: units converted, duplicates renamed, plates refused.
    events
        Events written in the file.
    edits
        Changes by hand; ``stances`` applies them.
    settings
        Facts of the header as text (set load, step type, subject mass in kg ...).
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

    def channel(self, *names: str) -> Channel:
        """Return the first channel that has one of ``names`` (capitals and blanks ignored).

        Raises
        ------
        DataError
            None of them is there: names what is, and the nearest match.
        """
        folded = {_folded(name): name for name in reversed(list(self.channels))}
        for name in names:
            if name in self.channels:
                return self.channels[name]
            if _folded(name) in folded:
                return self.channels[folded[_folded(name)]]
        raise missing("channel", names, self.channels, self.name)

    def marker(self, *names: str) -> Marker:
        """Return the first marker that has one of ``names`` (capitals and blanks ignored).

        Raises
        ------
        DataError
            None of them is there: names what is, and the nearest match.
        """
        folded = {_folded(name): name for name in reversed(list(self.markers))}
        for name in names:
            if name in self.markers:
                return self.markers[name]
            if _folded(name) in folded:
                return self.markers[folded[_folded(name)]]
        raise missing("marker", names, self.markers, self.name)

    def with_edits(self, *edits: Edit) -> Trial:
        """Return the trial with further edits; ``stances`` applies them or raises."""
        return replace(self, edits=(*self.edits, *edits))

    def with_notes(self, *notes: str) -> Trial:
        """Return the trial with further notes."""
        return replace(self, notes=(*self.notes, *notes))

    def __repr__(self) -> str:
        parts = [f"{len(self.plates)} plates", f"{len(self.markers)} markers"]
        parts += [f"{len(self.channels)} channels", f"{len(self.events)} events"]
        parts += [f"{len(self.edits)} edits"] if self.edits else []
        return f"<Trial {self.name[:80]}: {self.source[:40]}, {', '.join(parts)}>"

    def table(self) -> Table:
        """Return plates, markers and channels: kind, samples, rate, remarks."""
        rows = [
            ("plate", p.name, len(p.force), p.rate, p.problem or "; ".join(map(str, p.flags)))
            for p in self.plates
        ]
        rows += [
            ("marker", name, len(m.positions), m.rate, f"{int(m.missing.sum())} frames missing")
            for name, m in self.markers.items()
        ]
        rows += [
            ("channel", name, len(c.values), c.rate, c.unit or "unit not known")
            for name, c in self.channels.items()
        ]
        return Table(self.name, ("kind", "name", "samples", "rate (Hz)", "remarks"), rows)


def joined(first: Trial, second: Trial) -> Trial:
    """Return one trial from two files of the same recording, for example .trc and .forces.

    Both must count time from the same instant. Names that both use get the ending `` (2)``.
    """
    return Trial(
        name=f"{first.name} + {second.name}",
        channels={**first.channels, **_other_names(second.channels, first.channels)},
        plates=(*first.plates, *second.plates),
        markers={**first.markers, **_other_names(second.markers, first.markers)},
        source=f"{first.source} + {second.source}",
        checksum=hashlib.sha256(f"{first.checksum}{second.checksum}".encode()).hexdigest(),
        notes=(*first.notes, *second.notes),
        events=(*first.events, *second.events),
        edits=(*first.edits, *second.edits),
        settings={**first.settings, **second.settings},
    )


def _other_names(added: Mapping[str, _T], present: Mapping[str, object]) -> dict[str, _T]:
    return {f"{name} (2)" if name in present else name: value for name, value in added.items()}


def file_checksum(path: Path) -> str:
    """Return the SHA-256 of a file's bytes (hex)."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def missing(
    kind: str, names: tuple[str, ...], known: Mapping[str, object], where: str
) -> DataError:
    """Return the error for a channel or marker that is not in a trial."""
    listed = list(known)
    shown = ", ".join(listed[:12]) + (f" and {len(listed) - 12} more" if len(listed) > 12 else "")
    return DataError(
        f"no {kind} named {' or '.join(names)}",
        where=where,
        allowed=shown or f"the trial has no {kind}s",
        nearest=nearest_match(names[0], listed) if names else None,
        remedy="Name the columns in a profile file",
    )


def _folded(name: str) -> str:
    return "".join(letter for letter in name.casefold() if letter.isalnum())


def _time(n: int, rate: float, start: float, times: np.ndarray | None) -> np.ndarray:
    return start + np.arange(n) / rate if times is None else times
