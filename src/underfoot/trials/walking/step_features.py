"""Features of a step: ratios, shares and times that hold for any mass, force and person."""

import math

import numpy as np

from underfoot.core.constants import GRAVITY

from ..recording.signals import LowPass, frames_between, low_passed, low_passed_part
from ..recording.trial import MADE_UP
from .step import Step

_PENDULUM = 0.8  # slope of the force line of recorded steps in the plane of walking
VERTICAL = (
    "peak over mean", "second peak over first", "valley over peaks", "time of first peak",
    "time of second peak", "dwell at the normal peak",
)  # fmt: skip
"""Features of the normal force's shape over the stance."""
BUMP = "bump of the "
"""How names of features begin that a filter leaves nothing of."""
_LOADED = (0.06, 0.94)  # share of the stance in which the ratio of the forces is sure
_SINGLE = (0.18, 0.82)  # share of the stance in which the other foot swings
_SLOW = LowPass(cutoff=20.0)
_BODY = LowPass(cutoff=6.0)

FASTEST = 1.8  # m/s
USUAL_DURATION = 0.65  # s; the longest stance of the recorded steps
USUAL_SPEED = 1.3  # m/s; of the people whose RCOF and steps the limits are of
_FLAT = math.log(0.9)  # of the valley over the peaks
_PEAK_TIMES = {"time of first peak", "time of second peak"}
_ONSETS = {"shear after normal at contact", "shear after normal at toe off"}  # s
_LEAKS = {"shear in the sideways force", "shear in the mass"}
_SHEAR_BY_SPEED = {"braking impulse": True, "driving impulse": True, "both impulses": True,
                   "driving ratio": False}  # logarithm or not  # fmt: skip


def judged_features(step: Step) -> dict[str, float]:
    """Return the features of a step that recorded steps can be compared with: on level ground.

    Those of the normal force up to 1.8 m/s: of the recorded steps of ten persons (Pataky et al.
    2008) up to it fewer than 1 % look unlikely by one of them (none of 25 below 0.9 m/s), of
    faster ones a half. The shear of slower people is taken to the speed of those compared with: it
    grows with the step's length, as the root of the speed.
    """
    walk, speed = step.walk, step.speed
    if walk.axes.ramp.angle or walk.trial.settings.get("software") == MADE_UP:
        return {}
    features = step_features(step)
    for name in _ONSETS & features.keys():  # longer, as the stance is
        features[name] /= max(step.stance.duration / USUAL_DURATION, 1.0)
    if speed is None:
        return features
    if speed > FASTEST:
        return {name: value for name, value in features.items() if name not in VERTICAL}
    share = math.sqrt(min(speed, USUAL_SPEED) / USUAL_SPEED)
    for name in _LEAKS & features.keys():  # told the worse, the smaller the shear
        features[name] *= share
    if features.get("valley over peaks", -1.0) > _FLAT:  # two peaks that don't stand out
        features = {name: value for name, value in features.items() if name not in _PEAK_TIMES}
    for name in _SHEAR_BY_SPEED.keys() & features.keys() if share > 0.3 else ():
        logarithm = _SHEAR_BY_SPEED[name]
        features[name] = features[name] - math.log(share) if logarithm else features[name] / share
    return features


def step_features(step: Step) -> dict[str, float]:
    """Return the features of an accepted step by name; one that can't be had is left out.

    Ratios, shares and times, so that they hold for any mass and force. Those that need a mass,
    markers of the pelvis or a centre of pressure are there only with them.
    """
    walk, stance, raw, rate = step.walk, step.stance, step.force, step.plate.rate
    if stance.walking is None:
        return {}
    up, forward = walk.axes.ramp.gravity(walk.up, stance.walking)
    across = np.cross(up, forward)
    if 2.3 * _SLOW.cutoff > rate or len(raw) < 40:
        return {}
    force = step.filtered_force[LowPass(cutoff=min(36.0, 0.44 * rate))]
    normal, along, beside = (force @ axis for axis in (up, forward, across))
    found = _shapes(normal, along, beside)
    found |= _samples(raw @ up, raw @ forward, raw @ across, rate, float(normal.mean()))
    found |= _force_line(step, across)
    return {name: value for name, value in found.items() if math.isfinite(value)}


def _shapes(normal: np.ndarray, along: np.ndarray, beside: np.ndarray) -> dict[str, float]:
    """Impulses and instants of the filtered forces (n,) over one stance."""
    count, mean = len(normal), float(normal.mean())
    third, half = count // 3, count // 2
    pushes = np.maximum(-along[: 2 * third], 0.0).sum(), np.maximum(along[third:], 0.0).sum()
    braking, driving = (max(float(push) / (count * mean), 1e-6) for push in pushes)
    first, second = float(normal[:half].max()), float(normal[half:].max())
    valley = float(normal[third : 2 * third].min())
    ratio = along / np.maximum(normal, 0.05 * mean)
    low, high = int(np.argmin(along[:half])), half + int(np.argmax(along[half:]))
    crossing = low + int(np.argmax(along[low:] > 0.0))
    size = np.hypot(along, beside) / np.maximum(normal, 1e-3 * mean)
    landed, left = np.flatnonzero(normal > 0.3 * mean)[[0, -1]]
    inner = slice(round(0.1 * count), round(0.9 * count))
    return {
        "braking impulse": math.log(braking),
        "driving impulse": math.log(driving),
        "both impulses": 0.5 * math.log(braking * driving),
        "net impulse": driving - braking,
        "peak over mean": math.log(max(first, second) / mean),
        "second peak over first": math.log(second / first),
        "valley over peaks": math.log(max(valley, 1e-3 * mean) / (0.5 * (first + second))),
        "time of first peak": int(np.argmax(normal[:half])) / count,
        "time of second peak": (half + int(np.argmax(normal[half:]))) / count,
        "time of braking peak": low / count,
        "time of driving peak": high / count,
        "time of zero shear": crossing / count,
        "driving ratio": float(ratio[inner].max()),
        "ratio at landing": math.log(float(size[landed]) + 0.05),
        "ratio at leaving": math.log(float(size[left]) + 0.05),
        "sideways ratio": abs(float(beside[inner].mean())) / mean,
        "dwell at the braking peak": math.log(float((along < 0.9 * along[low]).mean()) + 0.01),
        "dwell at the driving peak": math.log(float((along > 0.9 * along[high]).mean()) + 0.01),
        "dwell at the normal peak": math.log(float((normal > 0.97 * max(first, second)).mean())),
    }


def _samples(
    normal: np.ndarray, along: np.ndarray, beside: np.ndarray, rate: float, mean: float
) -> dict[str, float]:
    """Bumps and onsets of the unfiltered forces (n,) over one stance."""
    features = {}
    count = len(normal)
    if rate > 150.0:
        forces = {"normal": normal, "shear": along, "sideways force": beside}
        for name, values in forces.items():
            rough = np.abs(values - low_passed(values, rate, LowPass(cutoff=25.0))) / mean
            for part_name, begin, end in (("landing", 0.02, 0.15), ("flat foot", 0.15, 0.85)):
                top = float(rough[round(begin * count) : round(end * count)].max())
                features[f"{BUMP}{name}, {part_name}"] = math.log(top + 1e-3)
    size = np.abs(along)
    for name, flip in (("contact", 1), ("toe off", -1)):
        onset = [
            int(np.argmax(half > 0.25 * half.max()))
            for half in (values[::flip][: count // 2] for values in (size, normal))
        ]
        features[f"shear after normal at {name}"] = (onset[0] - onset[1]) * flip / rate
    return features


def _force_line(step: Step, across: np.ndarray) -> dict[str, float]:
    """How the force points from the centre of pressure to the pelvis while one foot stands.

    In walking the force passes near the body's centre: shear over normal = slope x (pelvis ahead of
    the centre of pressure over its height above it) + offset; sideways (``across``) with the slope
    of the plane of walking. The vertical force over g plus the pelvis's vertical acceleration is
    the mass.
    """
    walk, stance, plate = step.walk, step.stance, step.plate
    pelvis = {step.markers[name]: side for name, side in walk.pelvis.items()}
    pelvis = {m: side for m, side in pelvis.items() if m.times is None and not m.missing.all()}
    markers = list(pelvis)
    begin, end = (stance.start + round(s * (stance.stop - stance.start)) for s in _LOADED)
    if len(markers) < 2 or stance.walking is None or markers[0].rate < 40.0:
        return {}
    time = plate.start + np.arange(begin, end) / plate.rate
    near = frames_between(markers[0].time, time[0] - 0.3, time[-1] + 0.3)
    paths = np.array([marker.positions[near] for marker in markers])
    seen = np.flatnonzero(np.isfinite(paths).all(axis=(1, 2)))
    whole = paths[seen]
    if len(whole) < 2 or whole.shape[1] < 30:
        return {}
    sides = [list(pelvis.values())[i] for i in seen]
    balanced = sides.count("left") == sides.count("right")
    rate, frames = markers[0].rate, markers[0].time[near]
    body = low_passed(whole.mean(axis=0), rate, _BODY)
    rise = np.gradient(np.gradient(body @ walk.up, 1.0 / rate), 1.0 / rate)
    force = low_passed_part(plate.force, plate.rate, _SLOW, begin, end)
    normal = force @ walk.up
    share = np.linspace(*_LOADED, len(time))
    single = (share > _SINGLE[0]) & (share < _SINGLE[1])
    mass = (normal / (GRAVITY + np.interp(time, frames, rise)))[single]
    features = {"steadiness of the mass": math.log(float(mass.std() / mass.mean()) + 1e-3)}
    if walk.weight is not None:
        features["mass by acceleration"] = math.log(mass.mean() * GRAVITY / walk.weight.newtons)
    if plate.centre_of_pressure is None:
        return features
    carried = np.outer(time - stance.contact, step.surface_velocity)
    place = np.column_stack([np.interp(time, frames, body[:, i]) for i in range(3)])
    arm = place - (plate.centre_of_pressure[begin:end] - carried)
    height = arm @ walk.up
    geometry, ratio = (arm @ stance.walking) / height, (force @ stance.walking) / normal
    if not np.isfinite(geometry).all() or np.ptp(geometry[single]) < 0.05:
        return features
    slope, offset = np.polyfit(geometry[single], ratio[single], 1)
    line = slope * geometry + offset
    left = (ratio - line)[single]
    # What one channel takes of another goes with the shear, which the force line does not.
    aside = (force @ across) / normal - _PENDULUM * (arm @ across) / height
    leaks = np.polyfit(ratio[single], np.column_stack((aside[single], mass / mass.mean())), 1)[0]
    if balanced:
        features["sideways offset of the force line"] = float(aside[single].mean())
    top = int(np.argmin(ratio[share < 0.35]))
    features["braking peak over the force line"] = float(ratio[top] / line[top])
    features["shear in the sideways force"], features["shear in the mass"] = leaks.tolist()
    return features | {
        "slope of the force line": math.log(max(float(slope), 0.01)),
        "offset of the force line": float(offset),
        "scatter of the force line": math.log(float(left.std()) + 1e-3),
    }
