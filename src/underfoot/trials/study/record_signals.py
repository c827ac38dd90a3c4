"""What a recording shows from its first sample to its last: loads of plates, speeds of heels."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from underfoot.core import UnderfootError

from ..readers import TrialsProfile
from ..recording.protocols import Protocol
from ..recording.trial import Trial
from ..walking.slips import heel_motion
from .steps import slip_definition, walkway


@dataclass(frozen=True, slots=True)
class Signal:
    """A quantity of the whole record: ``values`` (n,) from ``start`` (s) at ``rate`` (1/s)."""

    name: str
    values: np.ndarray
    rate: float
    start: float

    @property
    def end(self) -> float:
        """Time of the last sample (s)."""
        return self.start + (len(self.values) - 1) / self.rate

    def envelope(self, begin: float, end: float, count: int) -> "Envelope":
        """Return smallest and largest value in at most ``count`` equal parts of begin to end (s).

        Where there are fewer samples than parts, the samples. A part without a number is NaN.
        """
        first = max(0, int(np.floor((begin - self.start) * self.rate)))
        last = min(len(self.values), int(np.ceil((end - self.start) * self.rate)) + 1)
        part = self.values[first : max(first, last)]
        size = max(1, -(-len(part) // count))
        starts = np.arange(0, len(part), size)
        low, high = (f.reduceat(part, starts) if len(part) else part for f in (np.fmin, np.fmax))
        return Envelope(self.start + first / self.rate, size / self.rate, low, high)


@dataclass(frozen=True, slots=True)
class Envelope:
    """Smallest and largest values (n,) of parts of ``spacing`` (s), the first at ``start`` (s)."""

    start: float
    spacing: float
    low: np.ndarray
    high: np.ndarray


@dataclass(frozen=True, slots=True)
class RecordSignals:
    """``force``: upward force on each usable plate (N, not filtered), by the plate's name.

    ``heel_speed``: horizontal speed of the best-seen heel of each side (m/s), smoothed as the slip
    is judged; NaN where the marker was not seen.
    """

    force: Mapping[str, Signal]
    heel_speed: Mapping[str, Signal]


def record_signals(trial: Trial, protocol: Protocol, profile: TrialsProfile) -> RecordSignals:
    """Return the signals that steps and slips are found in, in the axes of the analysis.

    A heel whose speed can't be had (frames not equally spaced) is left out.
    """
    walk = walkway(trial, protocol, profile)
    force = {
        plate.name: Signal(plate.name, plate.force @ walk.up, plate.rate, plate.start)
        for plate in trial.plates
        if plate.usable
    }
    speed = {}
    for side, name in walk.heels.items():
        marker = trial.marker(name)
        try:
            motion = heel_motion(marker, walk.up, slip_definition(protocol))
        except UnderfootError:
            continue
        speed[side] = Signal(name, motion.speed, marker.rate, marker.start)
    return RecordSignals(force, speed)
