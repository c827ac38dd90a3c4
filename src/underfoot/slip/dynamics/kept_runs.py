"""Full runs kept on disk, so that a stopped series goes on where it was."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Cache, Progress, Status, content_hash, silent

from .motion import STEP, Instant, SlipMotion, slip_motion
from .sensors import MAP_X, MAP_Y, sensor_map
from .sole_contact import Setting, SoleFoot, SoleInstant
from .walker import Walker

Array = NDArray[np.float64]
ROOM = "slip-3"
_FIELDS = (
    "time", "speed", "distance", "normal", "drive", "friction", "fluid_load", "shoe_angle",
    "work_in", "dissipated",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class FullRun:
    """A full slip with what sensors and drawings need.

    ``maps`` (n, len(MAP_X), len(MAP_Y)) is the pressure that a floor sensor reads at places of the
    sole's frame at ``motion.time``; ``areas`` (n,) the loaded area; ``profiles`` (n, nx) the film
    along the centre line at ``profile_x``; ``peaks`` (n,) the highest film pressure anywhere;
    ``extremes`` (2,) the highest contact pressure (Pa) and the thinnest film under load (m).
    """

    motion: SlipMotion
    maps: NDArray[np.float32]
    areas: Array
    peaks: Array
    profiles: NDArray[np.float32]
    profile_x: Array
    extremes: Array

    def area_rows(self) -> list[tuple[float, float, float]]:
        """Return (load, shoe angle, area) of every instant under load."""
        motion = self.motion
        return [
            (float(f), float(a), float(s))
            for f, a, s in zip(motion.normal, motion.shoe_angle, self.areas, strict=True)
            if f > 0 and s > 0
        ]


def full_run(
    setting: Setting,
    walker: Walker,
    *,
    inlet_diameter: float = 4e-3,
    step: float = STEP,
    cache: Cache | None = None,
    progress: Progress = silent,
) -> FullRun:
    """Return one slip with contact and film carried under the whole sole.

    With a ``cache`` and a ``setting.key`` a run that was done before is read back.
    """
    # who walks, not where the sensors lie
    person = replace(walker, landing=0.0, lateral=0.0, name="")
    key = content_hash(setting.key, person, inlet_diameter, step)[:40]
    if cache is not None and setting.key:
        stored = cache.load(key)
        if stored is not None:
            return _restored(stored, walker)
    found = _computed(setting, walker, inlet_diameter, step, progress)
    if cache is not None and setting.key and found.motion.status is Status.CONVERGED:
        cache.store(key, _stored(found))
    return found


def full_runs(
    setting: Setting,
    walkers: Sequence[Walker],
    *,
    inlet_diameter: float = 4e-3,
    step: float = STEP,
    cache: Cache | None = None,
    progress: Progress = silent,
) -> list[FullRun]:
    """Return the full slips of several walkers, one after the other, kept as they come."""
    found = []
    for number, walker in enumerate(walkers):

        def told(
            stage: str, fraction: float, residual: float | None = None, n: int = number
        ) -> None:
            progress(f"Slip {n + 1} of {len(walkers)}", (n + fraction) / len(walkers), residual)

        found.append(
            full_run(
                setting, walker, inlet_diameter=inlet_diameter, step=step, cache=cache,
                progress=told,
            )
        )  # fmt: skip
    return found


def _computed(
    setting: Setting, walker: Walker, inlet: float, step: float, progress: Progress
) -> FullRun:
    zero = np.zeros((MAP_X.size, MAP_Y.size), dtype=np.float32)
    line = int(np.argmin(np.abs(setting.sole.y)))
    empty = np.full(setting.sole.x.size, np.nan, dtype=np.float32)
    maps, areas, peaks, profiles = [zero], [0.0], [0.0], [empty]
    extremes = np.array([0.0, np.inf])

    def seen(time: float, instant: Instant) -> None:
        assert isinstance(instant, SoleInstant)
        state = instant.state
        maps.append(sensor_map(state, inlet).astype(np.float32))
        total = state.total_pressure
        square = float((total**2).sum())
        areas.append(float(total.sum()) ** 2 / square * state.spacing**2 if square > 0 else 0.0)
        peaks.append(float(state.fluid_pressure.max()))
        profiles.append(state.film_thickness[:, line].astype(np.float32))
        extremes[0] = max(extremes[0], float(state.contact_pressure.max()))
        extremes[1] = min(extremes[1], float(state.film_thickness[setting.sole.inside].min()))

    load = float(walker.step.normal.max() * walker.mass * 9.80665)
    motion = slip_motion(
        walker,
        SoleFoot(setting, walker.shoe_angle, load),
        step=step,
        seen=seen,
        progress=progress,
    )
    count = motion.time.size
    return FullRun(
        motion,
        np.array(maps[:count]),
        np.array(areas[:count]),
        np.array(peaks[:count]),
        np.array(profiles[:count]),
        np.asarray(setting.sole.x),
        extremes,
    )


def _stored(run: FullRun) -> dict[str, object]:
    motion = run.motion
    return {
        **{name: getattr(motion, name) for name in _FIELDS},
        "maps": run.maps.astype(np.float32),
        "areas": run.areas,
        "peaks": run.peaks,
        "profiles": run.profiles,
        "profile_x": run.profile_x,
        "notes": np.array(motion.notes, dtype=str),
        "extremes": run.extremes,
    }


def _restored(stored: dict[str, np.ndarray], walker: Walker) -> FullRun:
    motion = SlipMotion(
        walker,
        **{name: stored[name] for name in _FIELDS},
        status=Status.CONVERGED,
        model="full",
        notes=tuple(str(n) for n in stored["notes"]),
    )
    return FullRun(
        motion, stored["maps"], stored["areas"], stored["peaks"], stored["profiles"],
        stored["profile_x"], stored["extremes"],
    )  # fmt: skip
