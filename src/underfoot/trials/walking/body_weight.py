"""Body weight: from the mass that a recording names, or from quiet standing on its plates."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.constants import GRAVITY

from ..recording.axes import Axes, axes_of
from ..recording.trial import Trial

_AT_ONCE = 200_000  # samples of a long record that are looked through for standing
_STILL = 0.5  # s of quiet standing that give body weight
_STILL_SD, _STILL_SHEAR = 0.015, 0.03  # of the weight; walking varies by 20 % and pushes by 15 %


@dataclass(frozen=True, slots=True)
class BodyWeight:
    """Body weight (N) and where it comes from; ``standing`` when the record itself shows it."""

    newtons: float
    source: str
    standing: bool = False


def body_mass(trial: Trial) -> float | None:
    """Return the subject's mass (kg) written in the trial's settings, or None."""
    try:
        return float(trial.settings["body mass (kg)"])
    except (KeyError, ValueError):
        return None


def body_weight(trial: Trial, axes: Axes | None = None) -> BodyWeight | None:
    """Return the body weight: from the mass in the settings, else from quiet standing, else None.

    Quiet standing: half a second in which the vertical forces of all plates together vary by less
    than 1.5 % and push across by less than 3 % (on plates that measure along a ramp of angle a:
    across by the tangent of a, and the weight is normal force / cos a); the heaviest such level
    counts.
    """
    mass = body_mass(trial)
    if mass is not None:
        return BodyWeight(mass * GRAVITY, f"{mass:g} kg")
    axes = axes or axes_of(trial)
    up, ramp = axes.up, axes.ramp
    tilt = abs(ramp.angle) if ramp.plate_frame == "surface" else 0.0
    usable = [plate for plate in trial.plates if plate.usable]
    if not usable or len({(p.rate, len(p.force), p.start) for p in usable}) > 1:
        return None
    count, samples = round(_STILL * usable[0].rate), len(usable[0].force)
    if count < 5 or samples < 2 * count:
        return None
    heaviest = 0.0
    for begin in range(0, samples - count + 1, _AT_ONCE):
        part = slice(begin, begin + _AT_ONCE + count - 1)
        force = np.nan_to_num(np.sum([plate.force[part] for plate in usable], axis=0, dtype=float))
        heaviest = max(heaviest, _heaviest_still(force, count, up, math.tan(tilt)))
    if not heaviest:
        return None
    return BodyWeight(heaviest / math.cos(tilt), "standing in this record", standing=True)


def _heaviest_still(force: np.ndarray, count: int, up: np.ndarray, slope: float) -> float:
    """Largest mean normal force (N) of ``count`` samples (n, 3) of quiet standing; 0 without."""
    normal = force @ up
    across = force - np.outer(normal, up)
    values = np.column_stack((normal, normal**2, across))
    total = np.concatenate((np.zeros((1, 5)), np.cumsum(values, axis=0)))
    rolling = (total[count:] - total[:-count]) / count
    mean, squares = rolling[:, 0], rolling[:, 1]
    spread = np.sqrt(np.maximum(squares - mean**2, 0.0))
    push = np.abs(np.linalg.norm(rolling[:, 2:], axis=1) - mean * slope)
    still = (mean > 200.0) & (spread < _STILL_SD * mean) & (push < _STILL_SHEAR * mean)
    return float(mean[still].max(initial=0.0))
