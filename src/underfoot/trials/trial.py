"""One recording as read: channels, plates, markers, events, where it came from, what was edited."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from underfoot.core import DataError, nearest_match

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
        Cautions: a large baseline, saturated samples ...
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


@dataclass(frozen=True, slots=True)
class Edit:
    """One manual change, kept with the trial."""

    what: str
    before: str
    after: str
    why: str


@dataclass(frozen=True, slots=True)
class Trial:
    """One recording. Frozen: changes return a new trial and are written to ``edits``.

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
        Events written in the file or set by hand.
    edits
        The edit log.
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

        Errors
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

        Errors
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

    def with_event(self, event: Event, *, why: str) -> Trial:
        """Return the trial with ``event`` set by hand in place of those of its name and side."""
        same = [e for e in self.events if (e.name, e.side) == (event.name, event.side)]
        others = tuple(e for e in self.events if e not in same)
        before = ", ".join(f"{e.time:.6f} s ({e.source})" for e in same) or "absent"
        edit = Edit(f"event {event.name} {event.side}".strip(), before, f"{event.time:.6f} s", why)
        moved = replace(event, source="set by hand")
        return replace(self, events=(*others, moved), edits=(*self.edits, edit))

    def with_notes(self, *notes: str) -> Trial:
        """Return the trial with further notes."""
        return replace(self, notes=(*self.notes, *notes))


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
