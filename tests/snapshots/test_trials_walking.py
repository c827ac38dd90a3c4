"""Steps and slips: a recorded walk and made-up ones, each with one thing changed.

Of ``underfoot.trials.walking.belts``.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.core.remark import Message
from underfoot.trials import DEFINITIONS
from underfoot.trials.readers.profile import TrialsProfile
from underfoot.trials.recording.axes import Ramp, axes_of
from underfoot.trials.recording.plates import finished_plate
from underfoot.trials.recording.signals import LowPass, low_passed
from underfoot.trials.recording.trial import MADE_UP, Edit, Event, Marker, Plate, Trial
from underfoot.trials.simulator.activities import ACTIVITIES, activity
from underfoot.trials.simulator.treadmill import treadmill_walk
from underfoot.trials.simulator.walk import Defects, SlipTruth, walk_with_slip
from underfoot.trials.walking.body_weight import body_mass, body_weight
from underfoot.trials.walking.describe import describe_trial, described_file
from underfoot.trials.walking.events import no_contact_reason, stances
from underfoot.trials.walking.gait import RcofDefinition, required_friction, required_frictions
from underfoot.trials.walking.gait_context import (
    foot_angle,
    gait_context,
    heel_speed,
    slip_course,
    stance_curves,
)
from underfoot.trials.walking.likelihood import impossible, references, unlikely_flags, unseen_gain
from underfoot.trials.walking.plausibility import other_foot_flags, rcof_flags, unseen
from underfoot.trials.walking.processed import comb_depth, comb_depths, dead_time
from underfoot.trials.walking.slips import (
    OutcomeLimits,
    SlipDefinition,
    contact_from_heel,
    heel_motion,
    marker_jumps,
    slip,
    slip_of,
)
from underfoot.trials.walking.step import Step
from underfoot.trials.walking.step_features import judged_features, step_features
from underfoot.trials.walking.walkway import walkway_of
from walk_forms import SHORT, walk

UP = np.array([0.0, 0.0, 1.0])


def beside(*features):
    """Features of several steps, each in one line."""
    names = dict.fromkeys(name for one in features for name in one)
    return {name: np.array([one.get(name, np.nan) for one in features]) for name in names}


def numbers(*values):
    return "" if values[0] is None else " ".join("-" if v is None else f"{v:.5g}" for v in values)


def told(step):
    """What is said of one step."""
    m, stance = step.measurement, step.stance
    flags = [
        f"{'!' if flag.matters else '-'} {flag.name}: {flag} {numbers(flag.measured, flag.limit)}"
        for flag in m.flags
        if flag.name != "unseen gain"
    ]
    gains = [flag.measured for flag in m.flags if flag.name == "unseen gain"]
    own = (
        m.value,
        m.uncertainty,
        stance.contact,
        stance.toe_off,
        step.peak_time,
        step.gate_time,
    )
    return {
        "is": f"{step.verdict}, {stance.side} {stance.heel}, {m.reason}",
        "numbers": np.array((*own, stance.peak, *gains), dtype=float),
        "way": [stance.walking, stance.direction.explanation],
        "flags": flags,
    }


def slid(one):
    """What is said of one slip."""
    four = (one.start, one.peak_speed, one.distance, one.margin)
    assert all(m.flags == one.start.flags for m in four)
    return {
        "is": f"{one.slipped} {one.outcome} {one.way} {one.slides} {one.peak_speed.reason}",
        "numbers": np.array(
            [
                one.contact,
                one.end,
                one.peak_time,
                *(m.value for m in four),
                *(m.uncertainty for m in four),
            ],
            dtype=float,
        ),
        "flags": [
            f"{f.name} {f.matters}: {f} {numbers(f.measured, f.limit)}" for f in one.start.flags
        ],
        "search": [one.start.conventions.get(key) for key in ("search ends", "slip start")],
    }


def steps_of(trial, definition=None, **options):
    return {
        step.stance.label: told(step)
        for step in required_frictions(walkway_of(trial, **options), definition)
    }


def changed(change, plates=(0, 1), trial=None):
    """The walk with other forces on some of its plates."""
    trial = trial or walk()
    made = [
        replace(p, force=change(p.force.copy(), p.rate)) if i in plates else p
        for i, p in enumerate(trial.plates)
    ]
    return replace(trial, plates=tuple(made))


def marked(change, trial=None):
    """The walk with other markers."""
    trial = trial or walk()
    return replace(trial, markers=change(dict(trial.markers)))


def recorded(made, *, mass=70.0):
    """A made-up walk as a trial."""
    plates = []
    for i, (force, centre, corners) in enumerate(
        zip(made.force, made.centre, made.corners, strict=True), 1
    ):
        moment = np.cross(centre - corners.mean(axis=0), force)
        plates.append(
            finished_plate(f"plate {i}", force, rate=1000.0, up=UP, moment=moment, corners=corners)
        )
    markers = {name: Marker(path, 200.0) for name, path in made.markers.items()}
    settings = {"body mass (kg)": f"{mass:g}"} if mass else {}
    settings["software"] = MADE_UP
    return Trial("made up", plates=tuple(plates), markers=markers, settings=settings)


@cache
def slipping(**truth):
    made = walk_with_slip(SlipTruth(**truth), Defects(), np.random.default_rng(1), duration=3.6)
    return recorded(made)


def _at(force, row, size, axis=2):
    force[row, axis] += size
    return force


def _between(force, begin, stop, value):
    force[begin:stop] = value
    return force


def _slow(force, rate, less):
    time = np.arange(len(force))
    return np.column_stack([np.interp(time, time[::less], part[::less]) for part in force.T])


def _averaged(force, rate, count):
    kernel = np.full(count, 1.0 / count)
    return np.column_stack([np.convolve(part, kernel, "same") for part in force.T])


def _late(force, samples, axes=(0, 1, 2)):
    for axis in axes:
        force[:, axis] = np.roll(force[:, axis], samples)
    return force


FORCES = {
    "as recorded": lambda f, r: f,
    "a spike": lambda f, r: _at(f, 700, 200.0),
    "a small spike": lambda f, r: _at(f, 700, 100.0),
    "a spike of shear": lambda f, r: _at(f, 700, 50.0, 0),
    "a step": lambda f, r: f * np.where(np.arange(len(f)) > 700, 1.08, 1.0)[:, None],
    "held": lambda f, r: _between(f, 690, 700, f[690]),
    "held short": lambda f, r: _between(f, 690, 693, f[690]),
    "averaged": lambda f, r: _averaged(f, r, 50),
    "rounded to zero": lambda f, r: np.where(np.abs(f) < 12.0, 0.0, f),
    "a line": lambda f, r: _between(f, 660, 710, np.linspace(f[660], f[710], 50)),
    "slow": lambda f, r: _slow(f, r, 12),
    "a drop-out": lambda f, r: _between(f, 690, 694, 0.0),
    "drift": lambda f, r: f + np.linspace(0.0, 30.0, len(f))[:, None] * [1.0, 0.0, 0.0],
    "vibration": lambda f, r: f + 9.0 * np.sin(0.2 * np.arange(len(f)))[:, None] * [0, 1.0, 0],
    "filtered": lambda f, r: low_passed(f, r, LowPass(cutoff=8.0)),
    "half the force": lambda f, r: 0.5 * f,
    "twice the force": lambda f, r: 2.0 * f,
    "more shear": lambda f, r: f * [1.7, 1.7, 1.0],
    "less shear": lambda f, r: f * [0.4, 0.4, 1.0],
    "late shear": lambda f, r: _late(f, 25, (0, 1)),
    "late": lambda f, r: _late(f, 120),
    "ringing": lambda f, r: (
        f * (1.0 + 0.3 * np.sin(0.25 * np.arange(len(f))))[:, None] ** [1, 1, 0]
    ),
    "sideways": lambda f, r: f + np.outer(f[:, 2], [0.25, 0.0, 0.0]),
    "turned": lambda f, r: f @ np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
    "a lost sample": lambda f, r: _between(f, 700, 701, np.nan),
    "a hump": lambda f, r: (
        f * (1 + 0.5 * np.exp(-(((np.arange(len(f)) - 750) / 60.0) ** 2)))[:, None]
    ),
}


@pytest.mark.parametrize("part", range(3))
def test_forces(file_regression, part):
    names = list(FORCES)[part::3]
    held(
        file_regression, {name: steps_of(changed(FORCES[name])) for name in names}, f"forces_{part}"
    )


def _without(markers, *words):
    return {name: m for name, m in markers.items() if not any(word in name for word in words)}


def _moved(markers, change, *words):
    return {
        name: replace(m, positions=change(m.positions.copy(), m))
        if any(word in name for word in words)
        else m
        for name, m in markers.items()
    }


def _path(markers, change):
    return _moved(markers, change, "")


MARKERS = {
    "none": lambda m: {},
    "no heel": lambda m: _without(m, "HEE"),
    "no pelvis": lambda m: _without(m, "ASI", "PSI", "SAC", "pelvis"),
    "exchanged": lambda m: {
        n.translate(str.maketrans("LR", "RL")) if n[1:] == "HEE" else n: x for n, x in m.items()
    },
    "heel leaps": lambda m: _moved(m, lambda p, _: _at(p, 80, 0.05, 0), "HEE"),
    "heel lost": lambda m: _moved(m, lambda p, _: _between(p, 60, 80, np.nan), "HEE"),
    "heel lost short": lambda m: _moved(m, lambda p, _: _between(p, 70, 76, np.nan), "HEE"),
    "climbing": lambda m: _path(m, lambda p, x: p + np.outer(x.time, [0, 0, 0.3])),
    "fast": lambda m: _path(m, lambda p, x: p + np.outer(x.time, [0, 1.5, 0])),
    "slow": lambda m: _path(m, lambda p, x: p - np.outer(x.time, [0, 0.6, 0])),
    "standing": lambda m: _path(m, lambda p, x: p - np.outer(x.time, [0, 1.1, 0])),
    "sliding": lambda m: _moved(
        m, lambda p, x: p + np.outer(np.clip(x.time - 0.6, 0, 0.3), [0, 0.5, 0]), "HEE"
    ),
    "outside": lambda m: _moved(m, lambda p, x: p + np.array([0.4, 0.0, 0.0]), "HEE"),
    "toes uneven": lambda m: {
        n: x if "HEE" in n else replace(x, times=x.time * 1.0) for n, x in m.items()
    },
}


def test_markers(file_regression):
    made = {name: marked(change) for name, change in MARKERS.items()}
    held(
        file_regression,
        {
            name: {"steps": steps_of(trial), "unseen": [str(f) for f in unseen(walkway_of(trial))]}
            for name, trial in made.items()
        }
        | {
            "uneven": refusal(
                steps_of,
                marked(lambda m: {n: replace(x, times=x.time * 1.0) for n, x in m.items()}),
            )
        },
    )


def test_settings_of_a_walk(file_regression):
    whole = walk()
    plates = whole.plates
    bare = [replace(p, centre_of_pressure=None, corners=None, moment=None) for p in plates]
    told_events = (Event("heel contact", 0.55, "left"), Event("heel contact", 0.55, "right"))
    trials = {
        "no mass": replace(whole, settings={}),
        "heavy": replace(whole, settings={"body mass (kg)": "120"}),
        "light": replace(whole, settings={"body mass (kg)": "35"}),
        "child": replace(changed(lambda f, r: 0.5 * f), settings={"body mass (kg)": "30.15"}),
        "events": replace(whole, events=told_events),
        "bare plates": replace(whole, plates=tuple(bare)),
        "bare, no markers": replace(whole, plates=tuple(bare), markers={}),
        "one plate": replace(whole, plates=plates[:1]),
        "made up": replace(
            whole, settings={**whole.settings, "software": "underfoot trials simulate"}
        ),
        "higher": replace(
            whole,
            plates=(
                plates[0],
                replace(plates[1], corners=plates[1].corners + np.array([0, 0, 0.05])),
            ),
        ),
        "saturated": replace(whole, plates=tuple(replace(p, saturated=True) for p in plates)),
        "cut": replace(
            whole,
            plates=tuple(
                replace(p, force=p.force[400:1100], start=0.4, centre_of_pressure=None)
                for p in plates
            ),
        ),
    }
    ways = {
        "given": {"walking": "+y"},
        "against": {"walking": "-y"},
        "across": {"walking": "+x"},
        "ramp": {"ramp": Ramp(0.1, "horizontal")},
        "steep": {"ramp": Ramp(-0.2, "surface")},
    }
    held(
        file_regression,
        {
            **{name: steps_of(trial) for name, trial in trials.items()},
            **{name: steps_of(whole, **way) for name, way in ways.items()},
        },
    )


def test_definitions(file_regression):
    way = walkway_of(walk())
    first = stances(way)[0]
    own = {
        "half": RcofDefinition(part=0.2),
        "high gate": RcofDefinition(gate=5000.0),
        "share": RcofDefinition(gate_body_weight=0.5),
        "any way": RcofDefinition(braking=False, part=1.0),
        "first of all": RcofDefinition(peak="first-local-maximum", gate=20.0),
    }
    nobody = walkway_of(replace(walk(), settings={}, plates=walk().plates[:1]))
    held(
        file_regression,
        {
            "defaults": DEFINITIONS,
            "steps": {
                name: [
                    (s.measurement.value, s.measurement.uncertainty, s.peak_time, s.gate_time)
                    for s in required_frictions(way, one)
                ]
                for name, one in {**DEFINITIONS, **own}.items()
            },
            "conventions": {
                name: one.conventions()
                for name, one in {**DEFINITIONS, **own}.items()
                if name in ("default", "share", "any way", "peak-3")
            },
            "others": {
                name: sorted(str(x) for x in one.other_filters) for name, one in DEFINITIONS.items()
            },
            "whole": required_friction(way, first).table(),
            "repr": repr(required_friction(way, first)),
            "headline": required_friction(way, first).headline(),
            "rejected": repr(required_friction(way, first, own["high gate"])),
            "unchecked": told(required_friction(way, first, checked=False)),
            "without a weight": told(required_friction(nobody, stances(nobody)[0], own["share"])),
            "refused": [
                refusal(RcofDefinition, **x)
                for x in (
                    {"shear": "x"},
                    {"peak": "x"},
                    {"part": 0.0},
                    {"part": 1.1},
                    {"gate": 0.0},
                    {"gate_body_weight": 0.0},
                )
            ],
        },
    )


@pytest.mark.parametrize("part", range(3))
def test_activities(file_regression, part):
    rng = np.random.default_rng(2)
    found = {}
    for name in list(ACTIVITIES)[part::3]:
        trial = recorded(activity(name, rng))
        way = walkway_of(trial)
        found[name] = {
            "steps": steps_of(trial),
            "weight": body_weight(replace(trial, settings={})),
            "context": [gait_context(way, s, stances(way)) for s in stances(way)],
        }
    if part == 0:
        bare = recorded(activity("walk", rng, markers=False), mass=0.0)
        found["without markers"] = steps_of(replace(bare, markers={}))
        found["a fixed marker"] = steps_of(bare)
    held(file_regression, found, f"activities_{part}")


SLIPS = {
    "plain": {},
    "none": {"peak_speed": 0.05, "rise": 0.09, "fall": 0.1},
    "near": {"peak_speed": 0.22, "rise": 0.1, "fall": 0.1},
    "sideways": {"angle": 1.4},
    "fast": {"peak_speed": 2.4, "rise": 0.12},
    "late": {"slip_start": 0.2, "peak_speed": 0.5},
}


def test_slips(file_regression):
    found = {}
    for name, truth in SLIPS.items():
        way = walkway_of(slipping(**truth))
        last = stances(way)[-1]
        one = slip_of(way, last)
        found[name] = {
            "steps": [told(s) for s in required_frictions(way)],
            "slip": slid(one),
            "course": slip_course(way, last, one),
        }
    held(file_regression, found)


def test_slip_options(file_regression):
    way = walkway_of(slipping())
    last, trial = stances(way)[-1], way.trial
    heel = trial.markers["LHEE"]
    hole, short = heel.positions.copy(), heel.positions.copy()
    hole[445:475], short[470:478] = np.nan, np.nan
    late = heel.positions.copy()
    late[500:540] = np.nan
    leap = heel.positions.copy()
    leap[470] += 0.05
    given = {"up": UP, "walking": np.array([1.0, 0.0, 0.0])}
    contact = last.contact
    kinds = {
        "high threshold": SlipDefinition(threshold=1.5),
        "3d": SlipDefinition(plane="3d"),
        "savitzky-golay": SlipDefinition(derivative="savitzky-golay"),
        "sharper": SlipDefinition(filter=LowPass(cutoff=25.0)),
        "unfiltered": SlipDefinition(filter=LowPass("none")),
        "low lift": SlipDefinition(heel_lift=0.001),
        "prominent": SlipDefinition(prominence=5.0),
        "no bridge": SlipDefinition(longest_gap=0.0),
    }
    bodies = {
        "falls": lambda p, x: p - np.outer(np.clip(x.time - 2.3, 0, 0.6), [0, 0, 0.5]),
        "stays low": lambda p, x: p - np.outer(np.clip(x.time - 2.3, 0, 0.6), [0, 0, 0.25]),
        "comes back": lambda p, x: p - np.outer(0.12 * np.exp(-(((x.time - 2.7) / 0.1) ** 2)), UP),
        "is lost": lambda p, x: p * np.where(x.time < 2.1, 1.0, np.nan)[:, None],
        "is never seen": lambda p, x: p * np.nan,
    }
    courses = {}
    for name, change in bodies.items():
        other = walkway_of(marked(lambda m, c=change: _moved(m, c, "ASI", "PSI"), trial))
        courses[name] = slip_course(other, last, slip_of(other, last))
    bare = walkway_of(marked(lambda m: _without(m, "ASI", "PSI", "TOE"), trial))
    drag = walkway_of(
        marked(
            lambda m: _moved(
                m, lambda p, x: p + np.outer(np.clip(x.time - 2.25, 0, 0.3), [0.4, 0, 0]), "RTOE"
            ),
            trial,
        )
    )
    held(
        file_regression,
        {
            "kinds": {
                name: slid(slip_of(way, last, definition=one)) for name, one in kinds.items()
            },
            "conventions": {name: one.conventions() for name, one in kinds.items()},
            "limits": [
                OutcomeLimits(0.1, 0.2, 0.3).outcome(x) for x in (0.1, 0.11, 0.2, 0.21, 0.3, 0.31)
            ],
            "wide": slid(slip_of(way, last, limits=OutcomeLimits(0.1, 0.5, 0.9))),
            "lost": {
                name: slid(slip(replace(heel, positions=path, note="why"), contact, **given))
                for name, path in (
                    ("hole", hole),
                    ("bridged", short),
                    ("later", late),
                    ("leap", leap),
                )
            },
            "none": slid(slip(None, contact, **given)),
            "whole": slip(None, contact, **given),
            "outside": slid(slip(heel, 9.0, **given)),
            "before": slid(slip(heel, -1.0, **given)),
            "left at once": slid(slip(heel, contact, leaves=contact + 0.01, **given)),
            "no way": slid(slip(heel, contact, up=UP)),
            "backward": slid(slip(heel, contact, up=UP, walking=-given["walking"])),
            "motion": heel_motion(heel, UP),
            "landings": contact_from_heel(heel, UP),
            "jumps": [int(marker_jumps(x).sum()) for x in (leap, leap[:6], leap * 0.0, hole)],
            "few": marker_jumps(np.array([[0.0, 0, 0], [1, 1, 1]])),
            "courses": courses,
            "bare": slip_course(bare, last, slip_of(bare, last)),
            "drag": slip_course(drag, last, slip_of(drag, last)),
            "strict": slip_course(way, last, slip_of(way, last), OutcomeLimits(1e-4, 2e-4, 3e-4)),
            "refused": [
                *(
                    refusal(SlipDefinition, **x)
                    for x in (
                        {"plane": "x"},
                        {"derivative": "x"},
                        {"longest_gap": -1.0},
                        {"prominence": -0.1},
                        {"threshold": 0.0},
                        {"heel_lift": 0.0},
                    )
                ),
                refusal(OutcomeLimits, 0.2, 0.1),
                refusal(OutcomeLimits, 0.0),
                refusal(heel_motion, replace(heel, times=heel.time), UP),
            ],
        },
        hide=r"0x[0-9a-f]+",
    )


def test_treadmills(file_regression):
    rng = np.random.default_rng(4)
    whole = recorded(treadmill_walk(rng, stances=6, slip=0.05))
    split = recorded(treadmill_walk(rng, stances=5, speeds=(0.9, 1.3)))
    bare = replace(whole, markers={})
    found = {}
    for name, trial in (("one speed", whole), ("two speeds", split), ("without markers", bare)):
        way = walkway_of(trial)
        found[name] = {
            "belts": way.belts,
            "surfaces": way.surfaces,
            "steps": dict(list(steps_of(trial).items())[1:4]),
            "context": [gait_context(way, s, stances(way)) for s in stances(way)[1:3]],
        }
    way = walkway_of(whole)
    belt, heel = next(iter(way.belts.values())), whole.markers["LHEE"]
    held(
        file_regression,
        {
            **found,
            "belt": [
                belt.velocity(1.0),
                belt.speed(1.0),
                belt.speed_text(1.0),
                belt.direction(1.0),
            ],
            "carried": belt.carry_back(heel, 1.2),
            "uneven": belt.carry_back(replace(heel, times=heel.time), 1.2),
            "given": list(steps_of(whole, walking="+x").values())[2],
            "marker": way.marker("LHEE", "plate 1", 1.0).start,
            "body": [
                way.body_velocity("plate 1", 1.0, 2.0),
                way.body_velocity("plate 2", 1.0, 2.0, climb=True),
            ],
            "surface": [way.surface_velocity("plate 1", 1.0), way.surface_velocity("none", 1.0)],
        },
    )


def test_edits(file_regression):
    whole = walk()
    first = stances(walkway_of(whole))
    plate = whole.plates[0].name
    both = replace(whole, plates=(whole.plates[0], replace(whole.plates[0], name="other")))
    edits = {
        "exclude": [Edit(1, "exclude", None, "slipped")],
        "contact": [Edit(1, "contact", first[0].contact + 0.02, "late")],
        "toe off": [Edit(first[0].contact + 0.1, "toe off", first[0].toe_off - 0.03, "early")],
        "side": [Edit(2, "side", "left" if first[1].side == "right" else "right", "seen")],
        "all": [
            Edit(1, "contact", first[0].contact + 0.02, "late"),
            Edit(2, "exclude", None, "no"),
        ],
    }
    wrong = {
        "step": Edit(9, "exclude", None, "x"),
        "time": Edit(99.0, "exclude", None, "x"),
        "same": Edit(1, "contact", first[0].contact, "x"),
        "same end": Edit(1, "toe off", first[0].toe_off, "x"),
        "outside": Edit(1, "contact", 99.0, "x"),
        "before": Edit(1, "contact", -0.1, "x"),
        "turned": Edit(1, "contact", first[0].toe_off + 0.1, "x"),
        "side": Edit(1, "side", first[0].side, "x"),
        "plate": Edit(1, "plate", "none", "x"),
        "alone": Edit(1, "plate", plate, "x"),
    }
    twice = [Edit(1, "exclude", None, "x"), Edit(1, "side", "left", "x")]
    held(
        file_regression,
        {
            "stances": first,
            **{
                name: [
                    replace(s, direction=None) for s in stances(walkway_of(whole.with_edits(*own)))
                ]
                for name, own in edits.items()
            },
            "both plates": [(s.label, s.reason, s.by_hand) for s in stances(walkway_of(both))],
            "one of both": [
                (s.label, s.reason, s.by_hand)
                for s in stances(walkway_of(both.with_edits(Edit(1, "plate", plate, "video"))))
            ],
            "above": [
                (s.start, s.stop, s.peak) for s in stances(walkway_of(whole), threshold=60.0)
            ],
            "wrong": {
                name: refusal(stances, walkway_of(whole.with_edits(one)))
                for name, one in wrong.items()
            },
            "twice": refusal(stances, walkway_of(whole.with_edits(*twice))),
            "none": refusal(stances, walkway_of(Trial("e", edits=tuple(twice[:1])))),
        },
    )


def test_no_contact(file_regression):
    from underfoot.trials.recording.plates import refused_plate
    from underfoot.trials.recording.trial import Channel

    idle = Plate("one", np.zeros((900, 3)), 300.0)
    channel = Channel(np.zeros(9), "N", 100.0)
    trials = {
        "idle": Trial("", plates=(idle, replace(idle, name="two", rate=500.0))),
        "refused": Trial("", plates=(refused_plate("one", "no corners"),)),
        "friction": Trial("", {"COF": channel, "x": channel}),
        "columns": Trial("", {"a": channel}),
        "nothing": Trial(""),
    }
    held(file_regression, {name: no_contact_reason(walkway_of(t)) for name, t in trials.items()})


def test_contexts_and_features(file_regression):
    way = walkway_of(walk())
    every = stances(way)
    ones = [Step(way, one) for one in every]
    ramp = walkway_of(walk(), ramp=Ramp(0.1, "horizontal"))
    angle = foot_angle(way, every[0])
    ratio = required_friction(way, every[0]).ratio
    features = [judged_features(one) for one in ones]
    slow = walkway_of(marked(MARKERS["slow"]))
    fast = walkway_of(marked(MARKERS["fast"]))
    held(
        file_regression,
        {
            "context": [gait_context(way, one, every) for one in every],
            "speeds": [heel_speed(way, one) for one in every],
            "angle": angle,
            "curves": stance_curves(way, every[0], ratio, LowPass()),
            "features": beside(*map(step_features, ones)),
            "judged": beside(
                *features, *(judged_features(Step(w, stances(w)[0])) for w in (ramp, slow, fast))
            ),
            "body": [one.body for one in ones],
            "slope": [one.slope for one in ones],
            "flags": [
                [
                    (f.name, str(f), f.likelihood, f.limit)
                    for f in unlikely_flags(
                        {k: v + shift for k, v in features[0].items()}, speed=1.2
                    )
                ]
                for shift in (0.0, 0.4, -0.4)
            ],
            "impossible": [
                impossible({k: v + shift for k, v in features[0].items()})
                for shift in (0.0, 3.0, -3.0)
            ],
            "gain": [
                unseen_gain(x, 0.2, mass=mass, speed=v)
                for x, mass, v in (
                    (features[0], True, 1.2),
                    (features[0], False, 0.4),
                    ({}, True, None),
                    ({"x": 1.0}, True, 1.0),
                    ({"x": 1.0}, False, None),
                )
            ],
            "known": references()[:3],
            "count": len(references()),
            "likelihood": [
                [r.likelihood(r.mean + k * r.sd, v) for k in (0, 1, 5)]
                for r in references()[:2]
                for v in (None, 0.1, 1.2, 3.0)
            ],
            "limit": [r.limit(r.mean + k, 1.0) for r in references()[:3] for k in (1, -1)],
        },
    )


def test_limits(file_regression):
    held(
        file_regression,
        {
            "rcof": {
                f"{value} {speed} {ramp.angle}": [
                    (f.name, str(f)) for f in rcof_flags(value, ramp, speed)
                ]
                for value in (0.02, 0.0999, 0.1001, 0.2, 0.2999, 0.3001, 0.45)
                for speed in (None, 0.5, 1.3, 2.0)
                for ramp in (Ramp(), Ramp(0.1, "surface"))
                if rcof_flags(value, ramp, speed)
            },
            "other foot": [
                [(str(f), f.limit) for f in other_foot_flags(a, b, w)]
                for a, b, w in (
                    (0.2, [], None),
                    (0.2, [0.2, 0.31, 0.4], None),
                    (0.31, [0.2], None),
                    (0.2, [0.0], None),
                    (0.31, [0.2], body_weight(Trial("", settings={"body mass (kg)": "39"}))),
                    (0.41, [0.2], body_weight(Trial("", settings={"body mass (kg)": "39"}))),
                    (0.31, [0.2], body_weight(Trial("", settings={"body mass (kg)": "41"}))),
                )
            ],
        },
    )


def test_body_weight(file_regression):
    still = np.tile([0.0, 0.0, 350.0], (2000, 1))
    still[:600] = 0.0
    sway = still + np.outer(4.0 * np.sin(0.02 * np.arange(2000)), [1.0, 0.0, 0.5])

    def weigh(force, ramp=Ramp(), rate=1000.0, **change):  # noqa: B008 - a level floor
        plates = (Plate("one", force, rate), Plate("two", force, rate, **change))
        return body_weight(Trial("", plates=plates), axes_of(Trial("", plates=plates), ramp=ramp))

    held(
        file_regression,
        {
            "mass": [
                body_mass(Trial("", settings={"body mass (kg)": x})) for x in ("70.5", "heavy")
            ],
            "none": body_mass(Trial("")),
            "told": body_weight(Trial("", settings={"body mass (kg)": "70"})),
            "still": weigh(still),
            "swaying": weigh(sway),
            "shaking": weigh(still * np.where(np.arange(2000) % 40 < 20, 1.02, 0.98)[:, None]),
            "pushing": weigh(still + np.array([22.0, 0, 0])),
            "leaning": weigh(still + np.array([10.0, 0, 0])),
            "light": weigh(0.28 * still),
            "just heavy": weigh(0.29 * still),
            "ramp": weigh(still + np.array([35.0, 0, 0]), Ramp(0.1, "surface")),
            "horizontal ramp": weigh(still, Ramp(0.1, "horizontal")),
            "short": weigh(still[:999]),
            "slow": weigh(still[::125], rate=8.0),
            "two clocks": weigh(still, start=0.1),
            "nothing": body_weight(Trial("")),
        },
    )


def test_processed(file_regression):
    rng = np.random.default_rng(3)
    time = np.arange(900) / 1000.0
    load = np.column_stack((np.sin(5 * time), np.sin(7 * time), 10 * np.sin(4 * time)))
    load = load + rng.normal(0, 0.5, load.shape)
    smooth = _averaged(load, 1000.0, 40)

    def rest(end):
        still = (time < 0.25) | ((time > 0.5) & (time < end))
        return np.where(still, 3.0, 100.0 * np.sin(time * 9))

    held(
        file_regression,
        {
            "depth": [comb_depth(x, r) for x in (load, smooth) for r in (1000.0, 300.0, 40.0)],
            "depths": [
                comb_depths(smooth, 1000.0, *x, UP) for x in ((300, 600), (0, 30), (310, 330))
            ],
            "lost": comb_depths(smooth * np.nan, 1000.0, 300, 600, UP),
            "dead": [
                dead_time(rest(0.52), 1000.0, *x) for x in ((260, 800), (260, 515), (10, 300))
            ],
            "alive": dead_time(load[:, 0], 1000.0, 300, 800),
            "short": [dead_time(rest(end), 1000.0, 260, 800) for end in (0.5145, 0.5155)],
        },
    )


def test_descriptions(file_regression):
    whole = describe_trial(walk())
    edited = walk().with_edits(
        Edit(1, "exclude", None, "slipped"), Edit(2.0, "toe off", 1.5, "late")
    )
    few = replace(walk(), markers={f"M{i}": m for i, m in enumerate(walk().markers.values())})
    noted = walk().with_notes("one", "two")
    both = described_file(
        SHORT,
        profile=TrialsProfile(walking="-y"),
        vertical="+z",
        definition="first-maximum",
        subtract_baseline=False,
    )
    held(
        file_regression,
        {
            "text": whole.text(),
            "data": whole.as_dict(),
            "edits": refusal(describe_trial, edited),
            "few": describe_trial(few).text().splitlines()[:30],
            "noted": describe_trial(noted).text().splitlines()[-4:],
            "bare": describe_trial(Trial("bare")).text(),
            "file": both[0].text().splitlines()[-30:],
            "slip": describe_trial(
                slipping(), walking="+x", definition=DEFINITIONS["peak-3"]
            ).text(),
            "refused": [refusal(described_file, SHORT, definition="x")],
        },
    )


def test_step_of_the_mirrored_walk_needs_the_same_friction():
    turn = np.diag([-1.0, 1.0, 1.0])
    plates = [
        replace(
            p,
            force=p.force @ turn,
            centre_of_pressure=p.centre_of_pressure @ turn,
            moment=None,
            corners=p.corners[[1, 0, 3, 2]] @ turn,
        )
        for p in walk().plates
    ]
    other = {name: replace(m, positions=m.positions @ turn) for name, m in walk().markers.items()}
    mirrored = replace(walk(), plates=tuple(plates), markers=other)
    one, two = (required_frictions(walkway_of(trial)) for trial in (walk(), mirrored))
    values = [[s.measurement.value for s in steps] for steps in (one, two)]
    assert values[0] == pytest.approx(values[1], rel=1e-9)
    assert Message("x") == "x"
