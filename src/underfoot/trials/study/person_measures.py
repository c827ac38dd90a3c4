"""What a recording shows of the person's body: weight, height, distances between markers."""

from collections.abc import Sequence

import numpy as np

from ..recording.axes import Axes
from ..recording.plates import plate_named
from ..recording.trial import Trial
from ..walking.events import Stance

FORCE, HEIGHT = "mean force in stance (N)", "height of the highest marker (m)"
_MARKERS = 24  # the first ones by name: pairs grow with the square
_FRAMES = 80  # spread over the recording: a distance that is kept needs no more
_RIGID = 0.015  # standard deviation over mean of a distance on one segment
_SHORTEST = 0.05  # m


def person_measures(trial: Trial, stances: Sequence[Stance], axes: Axes) -> dict[str, float]:
    """Return what the body decides, by name in SI; what is not recorded is left out.

    The mean normal force of complete contacts (0.76 to 0.86 of the weight in walking), the mean
    height of the highest marker, and the mean distance of markers that keep it (on one segment).
    """
    measures: dict[str, float] = {}
    forces = [
        float(np.mean(plate_named(trial, s.plate).force[s.start : s.stop] @ axes.up))
        for s in stances
        if s.accepted
    ]
    if forces:
        measures[FORCE] = float(np.median(forces))
    names = [n for n, m in sorted(trial.markers.items()) if m.missing.mean() < 0.3][:_MARKERS]
    paths = [trial.markers[name].positions for name in names]
    if not paths or len({len(path) for path in paths}) > 1:
        return measures
    places = np.stack([path[:: max(1, len(path) // _FRAMES)] for path in paths])
    places = places[:, np.isfinite(places).all(axis=(0, 2))]
    if places.shape[1] < 20:
        return measures
    measures[HEIGHT] = float((places @ axes.up).mean(axis=1).max())
    for i, name in enumerate(names):
        distances = np.linalg.norm(places[i + 1 :] - places[i], axis=2)
        means, scatter = distances.mean(axis=1), distances.std(axis=1)
        for other, mean, sd in zip(names[i + 1 :], means, scatter, strict=True):
            if mean > _SHORTEST and sd < _RIGID * mean:
                measures[f"{name} to {other} (m)"] = float(mean)
    return measures
