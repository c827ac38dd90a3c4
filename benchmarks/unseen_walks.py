"""Walks that no limit was set by: slow people, belts, and faults of kinds found silent in review.

``python -m benchmarks unseen_walks`` prints how many sound steps carry a caution and how many
faulty ones are noticed. Recorded steps are made slow: clocks and step length by the root of the
speed (a constant walk ratio, Sekiya et al. 1996, from memory), the normal force flatter as in slow
walking: 341 steps of ten persons at 0.68 to 1.5 m/s (Pataky et al. 2008, in spm1d), the logarithm
of force over mean against the speed, within persons. The pelvis moves by the same forces. Nobody
walked so here: real slow walkers are not at hand.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from benchmarks.walk_screen import MOVED, finished, recordings
from underfoot.trials import Marker, Trial, required_frictions, walkway_of
from underfoot.trials.recording.plates import plate_contacts

SEED, DRAWS = 4711, 3
USUAL = 1.3  # m/s
_OF_SPEED = (
    1.019, 0.715, 0.621, 0.36, 0.149, -0.087, -0.33, -0.508, -0.61, -0.634, -0.534, -0.33, -0.118,
    0.016, 0.063, 0.075, 0.093, 0.14, 0.267,
)  # of ln(normal force / its mean) a m/s, at 5, 10 ... 95 % of the stance
_SINGLE = np.array([0.2, 0.8])  # of the stance
Change = Callable[[np.ndarray, float, np.random.Generator], np.ndarray]


def slow(trial: Trial, speed: float) -> Trial:
    """The trial of a person who walks at ``speed`` (m/s)."""
    pace = math.sqrt(speed / USUAL)
    walk = walkway_of(trial)
    up, forward, forces = walk.up, walk.axes.walking, []
    swings = np.zeros(2)  # of the normal force while one foot stands, before and after
    for plate in trial.plates:
        shape, normal = np.ones(len(plate.force)), plate.force @ up
        for start, stop in plate_contacts(plate, up):
            share = np.linspace(0.0, 1.0, stop - start)
            slope = np.interp(share, np.linspace(0.05, 0.95, len(_OF_SPEED)), _OF_SPEED)
            rise = np.exp(slope * (speed - USUAL))
            part = normal[start:stop]
            shape[start:stop] = rise * part.sum() / (rise * part).sum()
            single = slice(*(start + np.rint((stop - start) * _SINGLE).astype(int)))
            swings += np.std((normal[single], (shape * normal)[single]), axis=1)
        stood = np.outer(normal, up)
        forces.append(shape[:, None] * (stood + pace * (plate.force - stood)))
    slower = finished(trial, forces, pace)
    assert forward is not None
    lift = swings[1] / swings[0] / pace**2  # the same forces in more time lift the body more
    markers = {
        name: replace(m, positions=_shortened(m, forward, up, pace, name in walk.pelvis, lift),
                      rate=m.rate * pace, start=m.start / pace)
        for name, m in trial.markers.items()
    }  # fmt: skip
    events = tuple(replace(event, time=event.time / pace) for event in trial.events)
    plates = []
    for plate in slower.plates:
        centre = plate.centre_of_pressure
        if centre is not None:
            centre = centre + np.outer((pace - 1.0) * (centre @ forward), forward)
        plates.append(replace(plate, corners=None, centre_of_pressure=centre))
    return replace(slower, markers=markers, events=events, plates=tuple(plates))


def _shortened(
    marker: Marker, forward: np.ndarray, up: np.ndarray, pace: float, pelvis: bool, lift: float
) -> np.ndarray:
    """Positions whose way along the walk is shorter; a pelvis that rises ``lift`` times as far."""
    place = marker.positions + np.outer((pace - 1.0) * (marker.positions @ forward), forward)
    if not pelvis:
        return place
    rise = (place - np.nanmean(place, axis=0)) @ up
    return place + np.outer((lift - 1.0) * rise, up)


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
    for step in required_frictions(trial):
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
    kinds += [(f"slow, {v} m/s", lambda t, v=v: slow(t, v)) for v in (0.9, 0.75, 0.6)]
    kinds += [("on a belt", lambda t: on_belt(t, USUAL))]
    kinds += [("slow on a belt", lambda t: on_belt(slow(t, 0.7), 0.7))]
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
