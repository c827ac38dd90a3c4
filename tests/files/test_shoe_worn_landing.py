"""The angles at which walking wears a sole are those of the packaged steps."""

import numpy as np

from underfoot.shoe.worn.walking import LANDING
from underfoot.slip.dynamics import packaged_histories


def test_shares_of_load_at_landing_are_those_of_the_recorded_steps():
    angles = np.degrees([angle for angle, _ in LANDING])
    edges = np.append(angles - 0.5, angles[-1] + 0.5)
    laboratories: dict[str, list[np.ndarray]] = {}
    for step in packaged_histories():
        if step.foot_angle is None:
            continue
        time = np.arange(0.0, step.duration / 2, 2e-4)
        angle = np.degrees(np.interp(time, step.time, step.foot_angle))
        load = np.interp(time, step.time, step.normal)
        found, _ = np.histogram(np.minimum(angle, edges[-1] - 0.01), edges, weights=load)
        laboratories.setdefault(step.name.split("_")[0], []).append(found / found.sum())
    assert (len(laboratories), sum(map(len, laboratories.values()))) == (4, 10)
    mean = np.mean([np.mean(steps, axis=0) for steps in laboratories.values()], axis=0)
    assert np.allclose(mean, [share for _, share in LANDING], atol=1e-3)
