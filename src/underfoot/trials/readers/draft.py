"""A trial in the making: what every reader fills, and the checks that readers share."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from underfoot.core import DataError, nearest_match
from underfoot.core.deprecation import package_names
from underfoot.core.missing import mask_of_codes
from underfoot.core.remark import NOTHING, Message, join_lines
from underfoot.core.text import decode_text

from ..recording.axes import found_vertical
from ..recording.marker_names import heel_candidates, toe_candidates
from ..recording.plates import finished_plate, plate_up
from ..recording.trial import Channel, Event, Marker, Plate, Trial, Vertical
from .file_bytes import FileBytes
from .profile import TrialsProfile
from .seen import KINDS, camera_clock, coded_forces, unseen
from .text import (
    in_si,
    known_units,
    lines_of,
    rate_of,
    si_unit,
    table,
    truncation_error,
    unique_names,
    without_restarts,
)

_BODY = 0.03, 300.0  # m: markers of a body lie further apart, and no walkway is longer
_FOOT = 0.06, 0.8  # m from the heel to the toes of any foot
_NAMED = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "inch": 0.0254}


@dataclass(frozen=True, slots=True)
class _RawPlate:
    """A plate as the file holds it; ``more`` as ``finished_plate`` takes it."""

    force: np.ndarray
    more: dict[str, Any]

    @property
    def corners(self) -> np.ndarray | None:
        """Corners (4, 3) in m."""
        return self.more.get("corners")


@dataclass
class RecordingDraft:
    """One recording while it is read; rate, start and times (s) are those of what is added next.

    ``up`` is the axis that the format says is up, for where neither plates nor markers tell it.
    ``every_repeat``: the system repeats the place of a marker that it lost. ``metres``: in one unit
    of length of the file. ``file``: a long file, read in parts; ``data`` is empty then.
    """

    data: bytes
    name: str
    profile: TrialsProfile = field(default_factory=TrialsProfile)
    subtract_baseline: bool = True
    rate: float = 0.0
    start: float = 0.0
    times: np.ndarray | None = None
    channels: dict[str, Channel] = field(default_factory=dict)
    plates: list[Plate | _RawPlate] = field(default_factory=list)
    markers: dict[str, Marker] = field(default_factory=dict)
    events: tuple[Event, ...] = ()
    notes: list[str] = field(default_factory=list)
    settings: dict[str, str] = field(default_factory=dict)
    up: Vertical | None = None
    every_repeat: bool = False
    metres: float = 1.0
    file: FileBytes | None = None

    def lines(self) -> list[str]:
        """Return the lines of a text file."""
        return lines_of(decode_text(self.data, self.name))

    def error(self, what: str, **more: str | None) -> DataError:
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

    def clock(self, times: np.ndarray, *, restarts: bool = False) -> None:
        """Take rate, start and times from a column of times (s).

        ``restarts``: the clock may begin anew with each step of a machine.
        """
        if restarts:
            times, count = without_restarts(times)
            if count:
                self.notes.append(
                    Message(
                        "the clock begins anew {count} times: the parts follow each other",
                        count=count,
                    )
                )
        self.rate, self.start, self.times = rate_of(times, self.name)

    def count(self, written: str, counted: int, key: str = "", *, rows: bool = False) -> None:
        """Note that the header announces another number of samples than the file holds.

        Fewer than announced are refused as cut short, but where they are ``rows`` of a format whose
        programs write the number before they drop or cut rows.
        """
        if not written.isdigit() or int(written) == counted:
            return
        told = Message("{written} samples are announced", written=written)
        if key:
            told = Message("{key} is {written}", key=key, written=written)
        less = counted < int(written)
        if less and not rows:
            raise truncation_error(
                Message(
                    "truncated or damaged: {announced}, the file holds {count}",
                    announced=told,
                    count=counted,
                ),
                self.name,
            )
        more = Message(": was the file cut short?") if less else NOTHING
        self.notes.append(
            Message(
                "{told}, the file holds {counted}: all of them are read{more}",
                told=told,
                counted=counted,
                more=more,
            )
        )

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
            note = Message('in "{written}" in the file', written=written) if written else note
        if (scale * factor, offset) != (1.0, 0.0):
            # What was read of a long file is not held twice.
            values = np.multiply(values, scale * factor, out=values if self.file else None)
            values += offset
        if si == "N" and (lost := mask_of_codes(values, least=1.0)).any():
            values = np.where(lost, np.nan, values)
            self.notes.append(
                Message(
                    "{name}: {count} samples that hold a code are left out",
                    name=name,
                    count=int(lost.sum()),
                )
            )
        self.channels[name] = Channel(values, si, self.rate, self.start, self.times, note)

    def marker(self, name: str, positions: np.ndarray) -> None:
        """Add the path (n, 3) of a marker in m; exact zeros are a marker that was not seen."""
        zero = (positions == 0.0).all(axis=1)
        if zero.any():
            positions = np.where(zero[:, None], np.nan, positions)
        self.markers[name] = Marker(positions, self.rate, self.start, self.times)

    def plate(self, force: np.ndarray, name: str = "", **more: Any) -> None:
        """Add a force plate (n, 3), N; ``more`` as ``finished_plate`` takes it but ``up``."""
        more = {"start": self.start, "subtract_baseline": self.subtract_baseline, **more}
        more |= {"name": name or f"plate {len(self.plates) + 1}", "rate": self.rate}
        force = np.asarray(force, dtype=float if self.file is None else "f4")
        coded = coded_forces(force)
        if coded.any():
            force = np.where(coded[:, None], np.nan, force)
            self.notes.append(
                Message(
                    "{name}: {count} samples hold a number that stands for a lost one: "
                    "taken as not measured",
                    name=more["name"],
                    count=int(coded.sum()),
                )
            )
        self.plates.append(_RawPlate(force, more))

    def length_unit(self, written: str, places: np.ndarray, of: str = "the markers") -> float:
        """Return the factor to m of a unit; without one that which the numbers (...) tell.

        DataError: a unit word that is not known.
        """
        stated = self.profile.length_unit
        unit = si_unit(stated or written)
        if unit and unit[0] == "m":
            self.metres = unit[1]
            return unit[1]
        if written.strip():
            raise self.error(
                Message(
                    'the unit of {name} is "{unit}", which is no known length',
                    name=of,
                    unit=written,
                ),
                allowed="m, cm, mm, inch, ft ...",
                nearest=nearest_match(written, known_units("m")),
                remedy=_STATE,
            )
        seen = np.abs(places[np.isfinite(places)])
        millimetres = seen.size > 0 and float(np.percentile(seen, 90)) > 20.0
        taken = "mm" if millimetres else "m"
        self.notes.append(f"{of} without a unit: taken as {taken} from the size of the numbers")
        self.metres = _NAMED[taken]
        return self.metres

    def trial(self, source: str) -> Trial:
        """Return the trial: markers where they were seen, plates in the vertical found once."""
        self.markers = self._seen_markers()
        self._check_lengths()
        raw = [plate for plate in self.plates if isinstance(plate, _RawPlate)]
        up = found_vertical(
            self.profile.vertical,
            corners=[plate.corners for plate in raw if plate.corners is not None],
            forces=[plate.force for plate in raw],
            markers=self.markers,
            stated=self.up,
        )
        del raw
        for i, one in enumerate(self.plates):  # the raw ones go as they are done
            if isinstance(one, _RawPlate):
                out = plate_up(one.corners, np.array(up.axis))
                self.plates[i] = finished_plate(
                    force=one.force, up=out, in_place=self.file is not None, **one.more
                )
        return Trial(
            self.name,
            self.channels,
            tuple(plate for plate in self.plates if isinstance(plate, Plate)),
            self.markers,
            source,
            notes=tuple(dict.fromkeys(self.notes)),
            events=self.events,
            settings=self.settings,
            vertical=up,
        )

    def _seen_markers(self) -> dict[str, Marker]:
        """Markers at the cameras' rate, NaN where they were not seen; what was lost is noted."""
        markers = dict(self.markers)
        first = next(iter(markers.values()), None)
        even = first is not None and all(
            one.times is None and (one.rate, one.start) == (first.rate, first.start)
            for one in markers.values()
        )
        clock = camera_clock({n: m.positions for n, m in markers.items()}) if even else None
        if clock is not None and first is not None:
            rate = first.rate / clock.rows_a_frame
            start = first.start + clock.first / first.rate
            self.notes.append(
                Message(
                    "markers are held for {rows:.3g} rows: cameras at {rate:.4g} Hz",
                    rows=clock.rows_a_frame,
                    rate=rate,
                )
            )
            markers = {
                name: Marker(clock.blank_unseen(one.positions), rate, start)
                for name, one in markers.items()
            }
        seen: dict[str, list[Message]] = {}
        for name, marker in markers.items():
            lost = unseen(marker.positions, every_repeat=self.every_repeat)
            if not lost:
                continue
            mask = np.any(list(lost.values()), axis=0)
            gaps: list[Message] = []
            for kind, where in lost.items():
                frames = np.flatnonzero(where)
                start, end = marker.time[frames[[0, -1]]].tolist()
                gap = Message(
                    "{count} frames ({start:.2f} to {end:.2f} s)",
                    count=len(frames),
                    start=start,
                    end=end,
                )
                gaps.append(Message("{gap} {kind}", gap=gap, kind=KINDS[kind]))
                seen.setdefault(kind, []).append(Message("{name} {gap}", name=name, gap=gap))
            note = join_lines(gaps)
            positions = np.where(mask[:, None], np.nan, marker.positions)
            markers[name] = replace(marker, positions=positions, note=note)
        for kind, names in seen.items():
            more = NOTHING
            if len(names) > 6:
                more = Message(" and {count} more markers", count=len(names) - 6)
            self.notes.append(
                Message(
                    "taken as not seen, they {kind}: {markers}{more}",
                    kind=KINDS[kind],
                    markers=names[:6],
                    more=more,
                )
            )
        return markers

    def _check_lengths(self) -> None:
        """Refuse markers whose unit can't be: a body of a millimetre, a foot of three metres."""
        ends = [
            np.percentile(m.positions[~m.missing], (1, 99), axis=0)
            for m in self.markers.values()
            if (~m.missing).sum() > 2
        ]
        if not ends:
            return
        low, high = (
            np.min([end[0] for end in ends], axis=0),
            np.max([end[1] for end in ends], axis=0),
        )
        sizes = [("the markers", float((high - low).max()), _BODY)] if len(ends) > 1 else []
        trial = Trial(self.name, markers=self.markers)
        heels, toes = heel_candidates(trial), toe_candidates(trial)
        for side in ("left", "right"):
            if heels[side] and toes[side]:
                heel, toe = self.markers[heels[side][0]], self.markers[toes[side][0]]
                if heel.positions.shape == toe.positions.shape:
                    apart = np.linalg.norm(heel.positions - toe.positions, axis=1)
                    size = float(np.median(apart[np.isfinite(apart)] if apart.size else 1.0))
                    sizes.append((f"{heels[side][0]} and {toes[side][0]}", size, _FOOT))
        for what, size, (least, most) in sizes:
            if not least <= size <= most:
                raise self.error(
                    f"{what} are {_in_words(size)} apart: the unit of length can't be right",
                    allowed=f"{_in_words(least)} to {_in_words(most)}",
                    remedy=f"{_fitting(size / self.metres, least, most)}. {_STATE}",
                )


_STATE = 'State the unit: length_unit = "mm" (or "m", "cm" ...) under [file] in a profile'


def _in_words(size: float) -> str:
    return f"{size:.3g} m" if size >= 0.1 else f"{1e3 * size:.3g} mm"


def _fitting(number: float, least: float, most: float) -> str:
    """Which unit makes a length that can be of a number of the file."""
    if not number > 0:
        return "Check the markers"
    usual = (least * most) ** 0.5
    misfit = {name: abs(np.log(number * unit / usual)) for name, unit in _NAMED.items()}
    return Message(
        "As {misfit} it would fit", misfit=min(misfit, key=lambda name: float(misfit[name]))
    )


__getattr__ = package_names(__name__, gone="0.5", Draft="RecordingDraft")  # plug-ins import it
