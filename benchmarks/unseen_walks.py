"""Walks that no limit was set by: slow people, belts, and faults of kinds found silent in review.

``python -m benchmarks unseen_walks`` prints how many sound steps carry a caution and how many
faulty ones are noticed. Recorded steps are made slow: clocks and step length by the root of the
speed (a constant walk ratio, Sekiya et al. 1996, from memory), the normal force that of slow steps
of other people (Pataky et al. 2008, down to 0.68 m/s, of the package spm1d). The pelvis moves by
the same forces. Nobody walked so here: real slow walkers are not at hand.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from importlib.util import find_spec

import numpy as np
from scipy.ndimage import gaussian_filter1d, uniform_filter1d

from benchmarks.walk_screen import MOVED, finished, recordings
from underfoot.core.constants import GRAVITY
from underfoot.trials import Marker, Trial, required_frictions, walkway_of
from underfoot.trials.recording.plates import plate_contacts

SEED, DRAWS = 4711, 3
USUAL = 1.3  # m/s
_EDGE, _NEAREST = 0.12, 25  # share of the stance, number of recorded steps
_DUTY, _LIGHTER = 1.2, 0.96  # body weight over the mean force of a stance; slow stances last longer
Change = Callable[[np.ndarray, float, np.random.Generator], np.ndarray]


@cache
def _slow_forces() -> tuple[np.ndarray, np.ndarray]:
    """Speeds (n,) of recorded steps and normal forces (n, 101) over their mean."""
    from spm1d.data.uv1d.regress import SpeedGRF

    people = list(map(SpeedGRF, range(10)))
    force = np.vstack([one.Y for one in people])
    return np.concatenate([one.x for one in people]), force / force.mean(axis=1, keepdims=True)


def slow(trial: Trial, speed: float, rng: np.random.Generator, step: float = 1.0) -> Trial:
    """The trial of a person who walks at ``speed`` (m/s).

    ``step``: length of the steps over that of the young, which old people have shorter.
    """
    pace = math.sqrt(speed / USUAL / step)
    walk = walkway_of(trial)
    up, forward = walk.up, walk.axes.walking
    assert forward is not None
    speeds, known = _slow_forces()
    known = known[np.argsort(np.abs(speeds - speed))[:_NEAREST]]
    forces, pushed = [], []  # (time, time, change of the normal force over body weight)
    for plate in trial.plates:
        normal, shape = plate.force @ up, np.ones(len(plate.force))
        for contact in plate_contacts(plate, up):
            start, stop = contact.start, contact.stop
            here, share = normal[start:stop], np.linspace(0.0, 1.0, stop - start)
            edge = np.clip(np.minimum(share, 1.0 - share) / _EDGE, 0.0, 1.0)  # own impact and end
            drawn = np.interp(share, np.linspace(0.0, 1.0, 101), known[rng.integers(len(known))])
            drawn *= here.mean() * rng.normal(_LIGHTER, 0.02)
            rough = here - uniform_filter1d(here, 25)
            made = edge * (drawn + rough) + (1.0 - edge) * here
            shape[start:stop] = made / np.maximum(here, 1.0)
            ends = plate.start + np.array((start, stop)) / plate.rate
            pushed.append((*ends, (made - here) / (_DUTY * here.mean())))
        stood = np.outer(normal, up)
        sheared = uniform_filter1d(shape, 15)[:, None] * (plate.force - stood)
        forces.append(shape[:, None] * stood + pace * step * sheared)
    slower = finished(trial, forces, pace)
    markers = {}
    for name, m in trial.markers.items():
        place = m.positions + np.outer((pace * step - 1.0) * (m.positions @ forward), forward)
        if name in walk.pelvis:
            # the same forces in more time lift the body more; then the other forces
            rise = (pace**-2 - 1.0) * ((place - np.nanmean(place, axis=0)) @ up)
            place = place + np.outer(rise + _lifted(m, pushed, pace), up)
        markers[name] = replace(m, positions=place, rate=m.rate * pace, start=m.start / pace)
    events = tuple(replace(event, time=event.time / pace) for event in trial.events)
    plates = []
    for plate in slower.plates:
        centre = plate.centre_of_pressure
        if centre is not None:
            centre = centre + np.outer((pace * step - 1.0) * (centre @ forward), forward)
        plates.append(replace(plate, corners=None, centre_of_pressure=centre))
    return replace(slower, markers=markers, events=events, plates=tuple(plates))


def _lifted(
    marker: Marker, pushed: Sequence[tuple[float, float, np.ndarray]], pace: float
) -> np.ndarray:
    """Rise (m) of a body by changed forces while one foot stands, from and back to 0."""
    rise = np.zeros(len(marker.positions))
    for start, stop, force in pushed:
        inside = np.flatnonzero((marker.time > start) & (marker.time < stop))
        if len(inside) < 10:
            continue
        share = np.linspace(0.0, 1.0, len(inside))
        smooth = gaussian_filter1d(force, 0.03 * len(force))
        push = np.interp(share, np.linspace(0.0, 1.0, len(force)), smooth)
        push *= GRAVITY * np.clip(np.minimum(share, 1.0 - share) / _EDGE, 0.0, 1.0)
        for _ in range(2):
            push = np.cumsum(push - push.mean()) / (marker.rate * pace)
        rise[inside] += push - np.linspace(push[0], push[-1], len(push))
    return rise


def on_belt(trial: Trial, speed: float) -> Trial:
    """The trial as on a belt that carries the walk backward at ``speed`` (m/s)."""
    walk = walkway_of(trial)
    assert walk.axes.walking is not None
    way = -speed * walk.axes.walking
    markers = {
        name: replace(m, positions=m.positions + np.outer(m.time, way))
        for name, m in trial.markers.items()
    }
    plates = []
    for plate in trial.plates:
        centre = plate.centre_of_pressure
        moved = None if centre is None else centre + np.outer(plate.time, way)
        plates.append(replace(plate, centre_of_pressure=moved, corners=None))
    return replace(trial, markers=markers, plates=tuple(plates))


def _boxcar(values: np.ndarray, count: int) -> np.ndarray:
    kernel = np.full(count, 1.0 / count)
    return np.column_stack([np.convolve(column, kernel, "same") for column in values.T])


def _banded(values: np.ndarray, width: float) -> np.ndarray:
    return np.sign(values) * np.maximum(np.abs(values) - width, 0.0)


_FORCES: dict[str, tuple[bool, Change]] = {
    "moving average of all": (False, lambda f, q, r: _boxcar(f, round(r.uniform(0.03, 0.15) * q))),
    "moving average of the shear": (
        True, lambda f, q, r: _boxcar(f, round(r.uniform(0.03, 0.12) * q))
    ),
    "dead band of the shear": (True, lambda f, _, r: _banded(f, r.uniform(6.0, 40.0))),
    "gain of the shear, small": (True, lambda f, _, r: f * r.uniform(0.75, 0.9)),
    "shear compressed": (
        True,
        lambda f, _, r: f / (1.0 + r.uniform(0.3, 0.6) * np.abs(f) / max(np.abs(f).max(), 1.0)),
    ),
}  # fmt: skip


def of_forces(trial: Trial, rng: np.random.Generator, name: str) -> Trial:
    """The trial with one fault on all plates."""
    shear_only, change = _FORCES[name]
    up = walkway_of(trial).up
    shear = [i for i in range(3) if not up[i]]
    chosen = shear if shear_only else list(range(3))
    state, forces = int(rng.integers(2**32)), []
    for plate in trial.plates:
        force = plate.force.copy()
        force[:, chosen] = change(force[:, chosen], plate.rate, np.random.default_rng(state))
        forces.append(force)
    return finished(trial, forces)


def slid(trial: Trial, rng: np.random.Generator, *, toe: bool, unknown: bool = False) -> Trial:
    """The trial with heels (at landing) or toes (at push-off) that slide by 40 to 70 mm.

    ``unknown``: under a name that nobody knows.
    """
    walk = walkway_of(trial)
    markers, way = dict(trial.markers), rng.uniform(0.04, 0.07)
    for step in required_frictions(walk):
        one = step.stance
        name = (walk.toes if toe else walk.heels).get(one.side)
        if name is None or one.walking is None or not one.accepted:
            continue
        begin = one.contact + (0.6 * one.duration if toe else 0.03)
        span = 0.25 * one.duration if toe else 0.15
        marker = markers[name]
        share = np.clip((marker.time - begin) / span, 0.0, 1.0)
        moved = np.outer(
            0.5 * way * (1.0 - np.cos(np.pi * share)), (-1 if toe else 1) * one.walking
        )
        markers[name] = replace(marker, positions=marker.positions + moved)
    if unknown:
        heels = set(walk.heels.values())
        markers = {f"M{i}" if n in heels else n: m for i, (n, m) in enumerate(markers.items())}
    return replace(trial, markers=markers)


def _steps(trial: Trial) -> Iterator[tuple[tuple[str, int], float | None, bool, float, list[str]]]:
    """Place, RCOF, whether a caution, the bound of unseen gains, the cautions' names."""
    seen: dict[str, int] = defaultdict(int)
    for step in required_frictions(walkway_of(trial)):
        seen[step.stance.plate] += 1
        own = step.measurement
        bound = [f.measured for f in own.flags if f.name == "unseen gain"]
        names = [flag.name for flag in own.caution_flags]
        place = step.stance.plate, seen[step.stance.plate]
        yield place, own.value, bool(names), bound[0] or 0.0 if bound else 0.0, names


def main() -> None:
    """Print sound steps with a caution, faults noticed, and those within the printed bound."""
    rng = np.random.default_rng(SEED)
    cases = [(lab, finished(t, [p.force for p in t.plates])) for lab, t in recordings()]
    kinds = [("as recorded", lambda t: t)]
    kinds += [("on a belt", lambda t: on_belt(t, USUAL))]
    if find_spec("spm1d") is None:
        print("no slow walks: spm1d is not installed")
    else:
        kinds += [(f"slow, {v} m/s", lambda t, v=v: slow(t, v, rng)) for v in (0.9, 0.75, 0.6)]
        kinds += [("old, 0.8 m/s", lambda t: slow(t, 0.8, rng, step=0.85))]
        kinds += [("slow on a belt", lambda t: on_belt(slow(t, 0.7, rng), 0.7))]
    for name, change in kinds:
        kept, lost = [], 0
        for trial in (t for _, t in cases if t.markers):  # steps that are sound as recorded
            sound = {step[0] for step in _steps(trial) if step[1] is not None}
            found = [step for step in _steps(change(trial)) if step[0] in sound]
            kept += [step for step in found if step[1] is not None]
            lost += len(sound) - sum(step[1] is not None for step in found)
        why: dict[str, int] = defaultdict(int)
        for step in kept:
            for flag in step[4]:
                why[flag] += 1
        print(f"sound, {name}: {sum(s[2] for s in kept)} of {len(kept)} with a caution "
              f"({lost} lost)  {dict(why)}")  # fmt: skip
    faults: dict[str, Callable[[Trial], Trial]] = {
        **{name: (lambda t, name=name: of_forces(t, rng, name)) for name in _FORCES},
        "toe slips": lambda t: slid(t, rng, toe=True),
        "heel slips": lambda t: slid(t, rng, toe=False),
        "heel slips, name unknown": lambda t: slid(t, rng, toe=False, unknown=True),
    }
    for name, fault in faults.items():
        wrong = noticed = bounded = 0
        for _, trial in cases:
            plain = {place: (value, cautions) for place, value, _, _, cautions in _steps(trial)}
            for _ in range(DRAWS):
                for place, value, _, bound, cautions in _steps(fault(trial)):
                    before, known = plain.get(place, (None, []))
                    if before is None:
                        continue
                    off = math.inf if value is None else abs(value - before)
                    if off <= MOVED and "slips" not in name:
                        continue
                    wrong += 1
                    told = value is None or bool(set(cautions) - set(known))
                    noticed += told
                    bounded += not told and off <= bound
        print(f"{name:<30}{wrong:>5} wrong{noticed:>5} noticed{bounded:>5} within the bound")


if __name__ == "__main__":
    main()
