"""One made-up walk with a slip, told in other ways that change nothing: the same steps and slip."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.trials import read_trial, required_frictions, walkway_of
from underfoot.trials.simulator import Defects, SlipTruth, walk_c3d, walk_with_slip


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    path = tmp_path_factory.mktemp("walk") / "walk.c3d"
    recording = walk_with_slip(SlipTruth(), Defects(), np.random.default_rng(1))
    path.write_bytes(walk_c3d(recording))
    return read_trial(path)


def moved(trial, matrix, shift=(0.0, 0.0, 0.0)):
    """Return a trial in other axes of the laboratory; moments are axial vectors."""
    matrix, shift = np.asarray(matrix, float), np.asarray(shift, float)
    axial = np.linalg.det(matrix) * matrix
    plates = tuple(
        replace(
            plate,
            force=plate.force @ matrix.T,
            moment=None if plate.moment is None else plate.moment @ axial.T,
            centre_of_pressure=None
            if plate.centre_of_pressure is None
            else plate.centre_of_pressure @ matrix.T + shift,
            corners=plate.corners @ matrix.T + shift,
        )
        for plate in trial.plates
    )
    markers = {
        name: replace(marker, positions=marker.positions @ matrix.T + shift)
        for name, marker in trial.markers.items()
    }
    return replace(trial, plates=plates, markers=markers)


def turned(degrees):
    angle = np.radians(degrees)
    sine, cosine = np.sin(angle), np.cos(angle)
    return [[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]]


def other_foot(trial):
    """Return the mirror image: left is right."""
    image = moved(trial, np.diag([1.0, -1.0, 1.0]))
    other = {"L": "R", "R": "L"}
    return replace(
        image, markers={other[name[0]] + name[1:]: one for name, one in image.markers.items()}
    )


def later(trial):
    return replace(
        trial,
        plates=tuple(replace(one, start=one.start + 7.0) for one in trial.plates),
        markers={k: replace(one, start=one.start + 7.0) for k, one in trial.markers.items()},
    )


def heavier(trial):
    return replace(
        trial,
        plates=tuple(
            replace(one, force=1.25 * one.force, moment=one.moment * 1.25) for one in trial.plates
        ),
    )


def in_other_order(trial):
    return replace(
        trial,
        plates=trial.plates[::-1],
        markers=dict(reversed(trial.markers.items())),
        name="another name",
    )


def with_noise_beside(trial):
    """Return it with a marker on the wall, which nobody wears."""
    some = next(iter(trial.markers.values()))
    wall = np.array([3.0, 2.0, 1.0]) + np.random.default_rng(0).normal(0, 1e-3, (len(some.time), 3))
    return replace(trial, markers={**trial.markers, "WALL1": replace(some, positions=wall)})


TOLD = {
    "turned by 90 degrees": lambda t: moved(t, turned(90)),
    "turned by 180 degrees": lambda t: moved(t, turned(180)),
    "turned by 37 degrees": lambda t: moved(t, turned(37)),
    "its origin elsewhere": lambda t: moved(t, np.eye(3), (4.0, -2.0, 0.0)),
    "the other foot": other_foot,
    "seven seconds later": later,
    "a person a quarter heavier": heavier,
    "plates and markers in another order": in_other_order,
    "a marker on the wall": with_noise_beside,
}


EARLIER = {"a person a quarter heavier": 4e-3}
"""s: contact is found at a force, which comes earlier under a heavier person."""


def told(trial):
    """Return verdict, RCOF and its ±, its moment, the slip and its ± of each step, by time."""
    rows = []
    for one in sorted(required_frictions(walkway_of(trial)), key=lambda each: each.stance.contact):
        began, slid, spreads = one.stance.contact, one.slip, []
        numbers = [one.measurement.value, one.measurement.uncertainty, one.peak_time - began]
        if slid is not None:
            measured = slid.distance, slid.peak_speed, slid.start
            numbers += [each.value for each in measured[:2]]
            numbers += [None if slid.start.value is None else slid.start.value - began]
            spreads = [each.uncertainty for each in measured]
        rows.append((one.verdict, as_floats(numbers), as_floats(spreads)))
    return rows


def as_floats(numbers):
    return [np.nan if number is None else float(number) for number in numbers]


@pytest.mark.parametrize("how", TOLD)
def test_a_walk_told_otherwise_has_the_same_steps_and_slip(walk, how):
    own, other = told(walk), told(TOLD[how](walk))
    assert [verdict for verdict, *_ in other] == [verdict for verdict, *_ in own]
    assert sum(np.isfinite(numbers).sum() for _, numbers, _ in own) >= 8
    for (_, numbers, spreads), (_, again, their) in zip(own, other, strict=True):
        assert again == pytest.approx(numbers, rel=1e-5, abs=EARLIER.get(how, 1e-7), nan_ok=True)
        # noise is told of each axis of the laboratory, by as many frames
        assert their == pytest.approx(spreads, rel=0.1, nan_ok=True)
