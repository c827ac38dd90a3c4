"""A trial in the making: what every reader fills, and the checks that readers share."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from underfoot.core import DataError
from underfoot.core.text import decoded

from ..recording.plates import finished_plate
from ..recording.trial import Channel, Event, Marker, Plate, Trial
from .profile import Profile
from .text import in_si, lines_of, rate_of, si_unit, table, truncated, unique_names


@dataclass
class Draft:
    """One recording while it is read; rate, start and times (s) are those of what is added next."""

    data: bytes
    name: str
    profile: Profile = field(default_factory=Profile)
    subtract_baseline: bool = True
    rate: float = 0.0
    start: float = 0.0
    times: np.ndarray | None = None
    channels: dict[str, Channel] = field(default_factory=dict)
    plates: list[Plate] = field(default_factory=list)
    markers: dict[str, Marker] = field(default_factory=dict)
    events: tuple[Event, ...] = ()
    notes: list[str] = field(default_factory=list)
    settings: dict[str, str] = field(default_factory=dict)

    def lines(self) -> list[str]:
        """Return the lines of a text file."""
        return lines_of(decoded(self.data, self.name))

    def error(self, what: str, **more: str) -> DataError:
        """Return the error that names this file."""
        return DataError(what, where=self.name, **more)

    def table(
        self,
        lines: Sequence[str],
        delimiter: str,
        columns: int,
        first_line: int,
        ignored: frozenset[int] = frozenset(),
    ) -> np.ndarray:
        """Return the numbers of a table; what is odd about it becomes a note."""
        return table(lines, delimiter, columns, self.name, self.notes, first_line, ignored)

    def names(self, labels: Sequence[str], kind: str) -> list[str]:
        """Return unique names; duplicates become a note."""
        return unique_names(labels, kind, self.notes)

    def clock(self, times: np.ndarray) -> None:
        """Take rate, start and times from a column of times (s)."""
        self.rate, self.start, self.times = rate_of(times, self.name)

    def count(self, written: str, counted: int, key: str = "") -> None:
        """Refuse a file whose header announces another number of samples than it holds."""
        if written.isdigit() and int(written) != counted:
            text = f"{key} is {written}, the file holds {counted}"
            text = text if key else f"{written} samples announced, {counted} found"
            raise truncated(f"truncated or damaged: {text}", self.name)

    def channel(
        self,
        name: str,
        values: np.ndarray,
        written: str = "",
        *,
        unit: str = "",
        scale: float = 1.0,
        note: str | None = None,
    ) -> None:
        """Add a channel; its unit is the one ``written`` in the file, or ``unit`` without one."""
        si, factor, offset = in_si(written) if written else (unit, 1.0, 0.0)
        if note is None:
            note = "" if unit else "no unit in the file"
            note = f'in "{written}" in the file' if written else note
        values = values * (scale * factor) + offset
        self.channels[name] = Channel(values, si, self.rate, self.start, self.times, note)

    def marker(self, name: str, positions: np.ndarray) -> None:
        """Add the path (n, 3) of a marker in m."""
        self.markers[name] = Marker(positions, self.rate, self.start, self.times)

    def plate(self, force: np.ndarray, name: str = "", **more: Any) -> None:
        """Add a force plate; ``more`` as ``finished_plate`` takes it."""
        more = {"start": self.start, "subtract_baseline": self.subtract_baseline, **more}
        name = name or f"plate {len(self.plates) + 1}"
        self.plates.append(finished_plate(name, force, rate=self.rate, **more))

    def length_unit(self, written: str, size: float, unknown: str, of: str) -> float:
        """Return the factor to m of a unit, or the one that the size of the numbers tells."""
        unit = si_unit(written)
        if unit and unit[0] == "m":
            return unit[1]
        millimetres = size > 20.0
        self.notes.append(f"{unknown}: taken as {'mm' if millimetres else 'm'} from {of}")
        return 1e-3 if millimetres else 1.0

    def trial(self, source: str) -> Trial:
        """Return the trial."""
        return Trial(
            self.name,
            self.channels,
            tuple(self.plates),
            self.markers,
            source,
            notes=tuple(dict.fromkeys(self.notes)),
            events=self.events,
            settings=self.settings,
        )
