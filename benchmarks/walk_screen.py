"""The screen of walks: false cautions on sound steps, faults noticed, each laboratory left out.

``python -m benchmarks walk_screen`` scores; ``python -m benchmarks.walk_screen --learn`` writes the
packaged reference. Steps recorded by others are few: 16 sound ones of 8 persons in 5 laboratories
(tests/data/trials); sound variants of them are simulated. A step and its faults are judged by the
reference of the *other* laboratories, by levels that were set before any fault was made.
"""

import csv
import itertools
import math
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from unittest.mock import patch

import numpy as np

from benchmarks._drawn_walk_faults import FIRST_DRAWN_FAULTS, SECOND_DRAWN_FAULTS
from benchmarks._instrument_walk_faults import INSTRUMENT_FAULTS
from benchmarks._laboratory_walk_faults import LABORATORY_FAULTS
from benchmarks._more_walk_faults import MORE_FAULTS, TrialFault
from benchmarks._untuned_walk_faults import UNTUNED_FAULTS
from underfoot.trials import (
    LowPass,
    Trial,
    finished_plate,
    join_trials,
    low_passed,
    read_trial,
    required_frictions,
    walkway_of,
)
from underfoot.trials.walking.likelihood import UNLIKELY, Reference, references
from underfoot.trials.walking.step import Step
from underfoot.trials.walking.step_features import VERTICAL, _shapes, step_features

REPOSITORY = Path(__file__).parents[1]
DATA = REPOSITORY / "tests" / "data" / "trials"
TABLE = REPOSITORY / "src" / "underfoot" / "data" / "step_features.csv"
RECORDINGS = (
    ("biomechzoo", "HC030A05.c3d"), ("biomechzoo", "HC032A03.c3d"), ("biomechzoo", "HC036A10.c3d"),
    ("kineticstoolkit", "c3d_sample.c3d"), ("btk", "ADemo1_rewrite_c3d_pc_integer.c3d"),
    ("bmc", "Gait.c3d"), ("bmc", "walk1.trc"), ("opensim", "walking5.c3d"),
)  # fmt: skip
MOVED = 0.015
DRAWS, VARIANTS = 8, 12
_LINEAR = (
    "net impulse", "time of first peak", "time of second peak", "time of braking peak",
    "time of driving peak", "time of zero shear", "driving ratio", "sideways ratio",
    "shear after normal at contact", "shear after normal at toe off",
    "offset of the force line", "sideways offset of the force line",
    "braking peak over the force line", "shear in the sideways force", "shear in the mass",
)  # fmt: skip
_BOUND = ("mass by acceleration", "slope of the force line")
_PELVIS_WORDS = ("force line", "shear in the")
_NEEDS = {"mass by acceleration": "mass"}
_SPEED = "speed (m/s)"
Fault = Callable[[np.ndarray, float, np.random.Generator], np.ndarray]


def recordings() -> Iterator[tuple[str, Trial]]:
    """Laboratory and trial; of the markers only those that the analysis looks at."""
    for laboratory, name in RECORDINGS:
        trial = read_trial(DATA / laboratory / name, subtract_baseline=False)
        if name.endswith(".trc"):
            forces = read_trial(DATA / laboratory / "walk1.forces", subtract_baseline=False)
            trial = join_trials(trial, forces)
        walk = walkway_of(trial)
        feet = {*walk.heels.values(), *walk.toes.values()}
        kept = {n: m for n, m in trial.markers.items() if n in feet or n in walk.pelvis}
        yield laboratory, replace(trial, markers=kept, channels={})


def finished(
    trial: Trial,
    forces: Sequence[np.ndarray],
    rate: float = 1.0,
    centres: Sequence[np.ndarray | None] | None = None,
) -> Trial:
    """The trial with other raw forces, finished as a reader does; all clocks ``rate`` faster."""
    centres = centres or [plate.centre_of_pressure for plate in trial.plates]
    up = walkway_of(trial).up
    plates = tuple(
        finished_plate(
            plate.name, force, rate=plate.rate * rate, start=plate.start / rate, up=up,
            centre_of_pressure=centre, corners=plate.corners,
        )
        for plate, force, centre in zip(trial.plates, forces, centres, strict=True)
    )  # fmt: skip
    return replace(trial, plates=plates)


def sound(trial: Trial, rng: np.random.Generator) -> Trial:
    """A sound variant: another pace, mass, force of the push-off, noise of the plates."""
    pace, mass, push = np.exp(rng.normal(0.0, [0.05, 0.15, 0.05]))
    walk = walkway_of(trial)
    up, forces = walk.up, []
    for plate in trial.plates:
        normal = np.outer(plate.force @ up, up)
        force = mass * (normal + push * (plate.force - normal))
        forces.append(force + rng.normal(0.0, rng.uniform(0.2, 1.0), force.shape))
    made = finished(trial, forces, pace)
    markers = {}
    for name, m in trial.markers.items():
        place = m.positions
        if name in walk.pelvis:
            # The same forces lift the body as fast: in less time by less.
            rise = (place - np.nanmean(place, axis=0)) @ up
            place = place + np.outer((pace**-2 - 1.0) * rise, up)
        markers[name] = replace(m, positions=place, rate=m.rate * pace, start=m.start / pace)
    settings = dict(trial.settings)
    if "body mass (kg)" in settings:
        settings["body mass (kg)"] = f"{mass * float(settings['body mass (kg)']):g}"
    events = tuple(replace(event, time=event.time / pace) for event in trial.events)
    return replace(made, markers=markers, settings=settings, events=events)


def learned(rows: Sequence[tuple[int, dict[str, float]]]) -> tuple[Reference, ...]:
    """References of each feature from (person, features and speed) of sound steps."""
    values: dict[str, list[tuple[int, float]]] = defaultdict(list)
    for person, features in rows:
        for name, value in features.items():
            values[name].append((person, value))
    speeds = [speed for _, speed in values.pop(_SPEED)]
    walked = min(speeds), max(speeds), float(np.std(speeds, ddof=1))
    found = []
    for name, pairs in values.items():
        numbers = np.array([value for _, value in pairs])
        persons = len({person for person, _ in pairs})
        need = "pelvis" if any(part in name for part in _PELVIS_WORDS) else _NEEDS.get(name, "")
        if len(numbers) > 2:
            found.append(
                Reference(
                    name, float(numbers.mean()), float(numbers.std(ddof=1)), persons, len(numbers),
                    name not in _LINEAR, name in _BOUND, need,
                    f"{len(numbers)} recorded steps of {persons} persons", *walked,
                )
            )  # fmt: skip
    return tuple(found)


def features_of(trial: Trial) -> list[dict[str, float]]:
    """Features and speed of the steps of a trial, whatever the packaged reference says of them."""
    walk = walkway_of(trial)
    with patch("underfoot.trials.walking.likelihood.references", tuple):
        steps = required_frictions(walk)
    found = []
    for friction in steps:
        step = Step(walk, friction.stance)
        if friction.measurement.value is not None and step.speed is not None:
            found.append(step_features(step) | {_SPEED: step.speed})
    return found


# ------------------------------------------------------------- faults of forces (n, 3), z up
def _part(change: Callable[[np.ndarray, np.random.Generator], np.ndarray], axes: str) -> Fault:
    def fault(force: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
        out = force.copy()
        chosen = [0, 1] if axes == "shear" else [2] if axes == "normal" else [0, 1, 2]
        out[:, chosen] = change(out[:, chosen], rng)
        return out

    return fault


def _either(low: tuple[float, float], high: tuple[float, float]) -> Callable:
    return lambda rng: float(rng.uniform(*(low if rng.random() < 0.5 else high)))


_GAIN = _either((0.4, 0.75), (1.35, 2.2))


def _contacts(force: np.ndarray) -> list[int]:
    on = force[:, 2] > 20.0
    return [int(i) + 1 for i in np.flatnonzero(np.diff(on.astype(int)) == 1)]


def _near(change: Callable[[np.ndarray, int, float, np.random.Generator], np.ndarray]) -> Fault:
    """A change 25 to 60 ms after each contact, where the ratio peaks."""

    def fault(force: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
        out = force.copy()
        for at in _contacts(force):
            out = change(out, at + round(rng.uniform(0.025, 0.06) * rate), rate, rng)
        return out

    return fault


def _span(rate: float, rng: np.random.Generator, low: float, high: float) -> int:
    return max(3, round(rng.uniform(low, high) * rate))


def _held(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    f[at : at + _span(rate, rng, 0.01, 0.06)] = f[at]
    return f


def _zeros(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    f[at : at + _span(rate, rng, 0.006, 0.04)] = 0.0
    return f


def _line(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    n = _span(rate, rng, 0.03, 0.09)
    at -= n // 2
    f[at : at + n] = np.linspace(f[at], f[at + n], n)
    return f


def _lost(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    n = _span(rate, rng, 0.015, 0.06)
    f[at:-n] = f[at + n :].copy()
    return f


def _twice(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    n = _span(rate, rng, 0.015, 0.06)
    f[at + n :] = f[at:-n].copy()
    return f


def _spike(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    f[at, :2] += rng.uniform(60.0, 400.0) * rng.choice([-1, 1], 2)
    return f


def _bump(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    n = _span(rate, rng, 0.004, 0.015)
    f[at : at + n, :2] += (rng.uniform(30, 120) * np.hanning(n))[:, None] * rng.choice([-1, 1], 2)
    return f


def _dip(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    n = _span(rate, rng, 0.008, 0.03)
    f[at : at + n, 2] *= 1.0 - rng.uniform(0.2, 0.6) * np.hanning(n)
    return f


def _jump(f: np.ndarray, at: int, rate: float, rng: np.random.Generator) -> np.ndarray:
    f[at:, :2] += rng.uniform(8.0, 40.0) * rng.choice([-1, 1], 2)
    return f


def _shifted(f: np.ndarray, rate: float, seconds: float) -> np.ndarray:
    return np.roll(f, round(seconds * rate), axis=0)


def _one_way(f: np.ndarray, rate: float, cutoff: float) -> np.ndarray:
    return low_passed(f, rate, LowPass("butterworth-4-one-pass", cutoff))


def _zero_phase(f: np.ndarray, rate: float, cutoff: float) -> np.ndarray:
    return low_passed(f, rate, LowPass(cutoff=cutoff))


def _drawn(f: np.ndarray, rate: float, slow: float) -> np.ndarray:
    time = np.arange(len(f)) / rate
    at = np.arange(0.0, time[-1], 1.0 / slow)
    return np.column_stack([np.interp(time, at, np.interp(at, time, c)) for c in f.T])


def _turned(f: np.ndarray, angle: float, axis: int) -> np.ndarray:
    out, cos, sin = f.copy(), math.cos(angle), math.sin(angle)
    out[:, axis] = cos * f[:, axis] - sin * f[:, 2]
    out[:, 2] = cos * f[:, 2] + sin * f[:, axis]
    return out


def _shear(shear: np.ndarray, normal: np.ndarray) -> np.ndarray:
    return np.column_stack((shear[:, :2], normal[:, 2]))


def _cut(f: np.ndarray, rng: np.random.Generator, axes: list[int], noise: float) -> np.ndarray:
    out, share = f.copy(), rng.uniform(0.45, 0.8)
    for axis in axes:
        top = share * np.abs(f[:, axis]).max()
        out[:, axis] = np.clip(f[:, axis], -top, top) + noise * rng.normal(0, 1, len(f))
    return out


def _sine(f: np.ndarray, rate: float, size: float, hertz: float, phase: float) -> np.ndarray:
    wave = size * np.sin(2 * np.pi * hertz * np.arange(len(f)) / rate + phase)
    return f + np.outer(wave, [1.0, 0.5, 0.5])


def _leak(f: np.ndarray, rate: float, seconds: float) -> np.ndarray:
    """A charge amplifier with a short time constant: high-pass of the first order."""
    from scipy.signal import lfilter

    decay = math.exp(-1.0 / (rate * seconds))
    return np.asarray(lfilter([1.0, -1.0], [1.0, -decay], f, axis=0))


FAULTS: dict[str, Fault] = {
    "gain of the shear": _part(lambda v, r: v * _GAIN(r), "shear"),
    "gain of the normal force": _part(lambda v, r: v * _GAIN(r), "normal"),
    "one component times 10": lambda f, _, r: f * np.where(np.arange(3) == r.integers(2), 10, 1),
    "one component lost": lambda f, _, r: f * np.where(np.arange(3) == r.integers(2), 0, 1),
    "x turned": lambda f, _, r: f * [-1, 1, 1],
    "y turned": lambda f, _, r: f * [1, -1, 1],
    "shear turned": lambda f, _, r: f * [-1, -1, 1],
    "x and y exchanged": lambda f, _, r: f[:, [1, 0, 2]],
    "shear in lbf, normal in N": _part(lambda v, r: v / 4.448, "shear"),
    "normal in lbf, shear in N": _part(lambda v, r: v / 4.448, "normal"),
    "shear late": lambda f, q, r: _shear(_shifted(f, q, r.uniform(0.008, 0.04)), f),
    "shear early": lambda f, q, r: _shear(_shifted(f, q, -r.uniform(0.008, 0.04)), f),
    "shear low-passed one way": lambda f, q, r: _shear(_one_way(f, q, r.uniform(4, 15)), f),
    "shear low-passed": lambda f, q, r: _shear(_zero_phase(f, q, r.uniform(3, 12)), f),
    "normal low-passed": lambda f, q, r: _shear(f, _zero_phase(f, q, r.uniform(3, 10))),
    "all low-passed": lambda f, q, r: _zero_phase(f, q, r.uniform(4, 15)),
    "low-passed, then noise": lambda f, q, r: (
        _zero_phase(f, q, r.uniform(4, 12)) + r.normal(0, 1.5, f.shape)
    ),
    "drawn out from a low rate": lambda f, q, r: _drawn(f, q, r.uniform(25, 80)),
    "held samples": _near(_held),
    "samples at zero": _near(_zeros),
    "gap filled by a line": _near(_line),
    "samples missing without a trace": _near(_lost),
    "samples repeated": _near(_twice),
    "spike": _near(_spike),
    "bump of some ms": _near(_bump),
    "dip of the normal force": _near(_dip),
    "jump of the shear's zero": _near(_jump),
    "shear clipped": lambda f, _, r: _cut(f, r, [0, 1], 0.0),
    "shear clipped, then noise": lambda f, _, r: _cut(f, r, [0, 1], 1.0),
    "normal clipped": lambda f, _, r: _cut(f, r, [2], 0.0),
    "normal clipped, then noise": lambda f, _, r: _cut(f, r, [2], 1.0),
    "drift": lambda f, _, r: (
        f + np.outer(np.linspace(-0.5, 0.5, len(f)), r.uniform(20, 80) * r.choice([-1, 1], 3))
    ),
    "mains hum": lambda f, q, r: (
        _sine(f, q, r.uniform(5, 40), r.choice([16.7, 25.0, 30.0]), r.uniform(0, 6))
    ),
    "vibration": lambda f, q, r: _sine(f, q, r.uniform(8, 40), r.uniform(6, 25), r.uniform(0, 6)),
    "plate tilted": lambda f, _, r: (
        _turned(f, math.radians(r.uniform(2, 6) * r.choice([-1, 1])), int(r.integers(2)))
    ),
    "crosstalk of the normal force": lambda f, _, r: (
        f + np.outer(f[:, 2], r.uniform(0.03, 0.1) * r.choice([-1, 1], 3) * [1, 1, 0])
    ),
    "coarse converter": lambda f, _, r: np.round(f / (q := r.uniform(15, 50))) * q,
    "time reversed": lambda f, _, r: f[::-1],
    "charge leaks away": lambda f, q, r: _leak(f, q, r.uniform(0.15, 0.8)),
    "a hand on the rail": lambda f, _, r: (
        f * [1, 1, 1 - r.uniform(0.15, 0.4)] + np.outer(f[:, 2], [r.uniform(-0.1, 0.1), 0, 0])
    ),
}  # fmt: skip


_OF_ROWS = [
    FAULTS[name]
    for name in (
        "held samples", "samples missing without a trace", "samples repeated", "time reversed"
    )
]  # they take the centre of pressure along  # fmt: skip


def faulty(trial: Trial, rng: np.random.Generator, *, fault: Fault) -> Trial:
    """The trial with one fault on all plates; forces are turned so that z is up meanwhile."""
    up = walkway_of(trial).up
    order = [i for i in range(3) if not up[i]] + [int(np.argmax(np.abs(up)))]
    back = np.argsort(order)
    state, forces, centres = int(rng.integers(2**32)), [], []
    for plate in trial.plates:
        rows, centre = plate.force[:, order], plate.centre_of_pressure
        if fault in _OF_ROWS and centre is not None:
            rows = np.column_stack((rows, centre))
        # The same draw on every plate: one amplifier, one filter, one export.
        made = fault(rows, plate.rate, np.random.default_rng(state))
        forces.append(made[:, back])
        centres.append(made[:, 3:] if made.shape[1] > 3 else centre)
    return finished(trial, forces, centres=centres)


Verdicts = dict[tuple[str, int], tuple[float | None, frozenset[str], float, float]]


def _verdicts(trial: Trial) -> Verdicts:
    """RCOF, names of the cautions, contact, bound of unseen gains; by plate and contact on it."""
    found = {}
    seen: dict[str, int] = defaultdict(int)
    for step in required_frictions(walkway_of(trial)):
        own, plate = step.measurement, step.stance.plate
        seen[plate] += 1
        names = frozenset(flag.name for flag in own.caution_flags)
        bound = max((f.measured or 0.0 for f in own.flags if f.name == "unseen gain"), default=0.0)
        found[plate, seen[plate]] = own.value, names, step.stance.contact, bound
    return found


_FAMILIES: dict[str, dict[str, TrialFault]] = {
    "kinds that features were chosen with": {
        name: partial(faulty, fault=fault) for name, fault in FAULTS.items()
    },
    "further kinds": MORE_FAULTS,
    "kinds that the checks were not tuned on": {
        name: partial(faulty, fault=fault) for name, fault in UNTUNED_FAULTS.items()
    },
    "kinds of a laboratory": LABORATORY_FAULTS,
    "kinds of instruments, exports and feet": INSTRUMENT_FAULTS,
    "first half of forty drawn kinds": FIRST_DRAWN_FAULTS,
    "second half of forty drawn kinds": SECOND_DRAWN_FAULTS,
}


def main(seeds: Sequence[int] = (2031, 2033)) -> None:
    """Print the share of sound steps with a caution and of faults that were noticed.

    Features and limits were chosen with seeds 101 and 5 to 7.
    """
    cases = [(lab, finished(t, [p.force for p in t.plates])) for lab, t in recordings()]
    rows = [(lab, i, f) for i, (lab, t) in enumerate(cases) for f in features_of(t)]
    print(f"{len(rows)} recorded sound steps of {len(cases)} persons, "
          f"{len({lab for lab, _ in cases})} laboratories; each judged by the others")  # fmt: skip
    flagged = {"recorded": [0, 0], "simulated from them": [0, 0]}
    why: dict[str, int] = defaultdict(int)
    told = {family: {name: [0, 0, 0, 0] for name in kinds} for family, kinds in _FAMILIES.items()}
    draws = {seed: np.random.default_rng(seed) for seed in seeds}
    for seed, (index, (laboratory, trial)) in itertools.product(seeds, enumerate(cases)):
        rng = draws[seed]
        others = learned([(person, f) for lab, person, f in rows if lab != laboratory])
        with patch("underfoot.trials.walking.likelihood.references", lambda known=others: known):
            plain = _verdicts(trial)
            for kind, made in (
                ("recorded", [trial] if seed == seeds[0] else []),
                ("simulated from them", [sound(trial, rng) for _ in range(VARIANTS)]),
            ):
                for one in made:
                    for value, names, *_ in (plain if one is trial else _verdicts(one)).values():
                        if value is not None:
                            flagged[kind][0] += bool(names)
                            flagged[kind][1] += 1
                            for name in names:
                                why[name] += 1
            for family, kinds in _FAMILIES.items():
                for number, (name, fault) in enumerate(kinds.items()):
                    if (number + index) % len(cases) < DRAWS:
                        told_of = _noticed(plain, _verdicts(fault(trial, rng=rng)))
                        told[family][name] = [
                            *map(sum, zip(told[family][name], told_of, strict=True))
                        ]
    for kind, (bad, count) in flagged.items():
        print(f"sound steps with a caution, {kind}: {bad} of {count} ({100 * bad / count:.1f} %)")
    print("  by", dict(sorted(why.items(), key=lambda item: -item[1])))
    pressure_plate_steps()
    sums = [0, 0, 0]
    for family, kinds in told.items():
        print(f"\n{family:<42}{'steps':>7}{'moved':>7}{'noticed':>9}{'within':>9}")
        for name, (count, moved, noticed, within) in kinds.items():
            mark = "" if noticed == moved else "  <"
            print(f"{name:<42}{count:>7}{moved:>7}{noticed:>9}{within:>9}{mark}")
        count, moved, noticed, within = map(sum, zip(*kinds.values(), strict=True))
        print(f"{len(kinds)} kinds, {count} faulty steps, {moved} moved by more than {MOVED} or "
              f"lost, {noticed} noticed ({100 * noticed / max(moved, 1):.1f} %), {within} of the "
              f"others within the bound of unseen gains")  # fmt: skip
        sums = [a + b for a, b in zip(sums, (moved, noticed, within), strict=True)]
    print(f"\nall: {sums[1]} of {sums[0]} noticed ({100 * sums[1] / max(sums[0], 1):.1f} %), "
          f"{sums[2]} of the others within the bound")  # fmt: skip


def pressure_plate_steps() -> None:
    """Print how many of 600 steps of ten persons look unlikely by the shape of the normal force.

    They were not used to learn: T. C. Pataky et al., J. Biomech. 41 (2008) 1987, in spm1d.
    """
    try:
        from spm1d.data.uv1d.regress import SpeedGRF
    except ImportError:
        print("the steps that come with spm1d are not judged: it is not installed")
        return
    known = [one for one in references() if one.feature in VERTICAL]
    count: dict[bool, list[bool]] = {False: [], True: []}
    for data in map(SpeedGRF, range(10)):
        for speed, force in zip(data.x, data.Y, strict=True):
            normal = np.interp(np.linspace(0.0, 100.0, 700), np.arange(101), force)
            shear = -0.1 * normal * np.sin(np.linspace(0.0, 2.0 * np.pi, 700))
            found = _shapes(normal, shear, 0.0 * shear)
            unlikely = any(one.likelihood(found[one.feature]) < UNLIKELY for one in known)
            count[bool(speed > 1.8)].append(unlikely)
    for fast, of in count.items():
        print(f"steps of spm1d {'above' if fast else 'up to'} 1.8 m/s, unlikely by the normal "
              f"force: {sum(of)} of {len(of)}")  # fmt: skip


def _noticed(plain: Verdicts, after: Verdicts) -> tuple[int, int, int, int]:
    """Number of steps; of those whose RCOF moved or was lost; of those noticed among them.

    And of the others that moved by no more than the bound that is printed beside RCOF.
    """
    count = moved = noticed = within = 0
    for key, (value, names, contact, _) in plain.items():
        if value is None:
            continue
        near = [a for k, a in after.items() if k[0] == key[0] and abs(a[2] - contact) < 0.1]
        # With other clocks the contact has another time: the plate's contact of that number.
        lost = (None, frozenset(), 0.0, 0.0)
        now, cautions, _, bound = near[0] if near else after.get(key, lost)
        count += 1
        off = math.inf if now is None else abs(now - value)
        if off > MOVED:
            moved += 1
            told = now is None or bool(cautions - names)
            noticed += told
            within += not told and off <= bound
    return count, moved, noticed, within


def learn() -> None:
    """Write the reference of all recorded steps, which the package ships."""
    rows = [
        (i, f)
        for i, (_, t) in enumerate(recordings())
        for f in features_of(finished(t, [p.force for p in t.plates]))
    ]
    with TABLE.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        names = list(Reference.__dataclass_fields__)
        writer.writerow(names)
        for one in learned(rows):
            cells = [getattr(one, name) for name in names]
            writer.writerow(
                f"{c:.4g}"
                if isinstance(c, float)
                else {True: "yes", False: "no"}[c]
                if isinstance(c, bool)
                else c
                for c in cells
            )


if __name__ == "__main__":
    learn() if "--learn" in sys.argv else main()
