"""Parts of trials and their statistics that are worked out by hand."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.trials.machines.pin_on_disk import _unloaded_stretches
from underfoot.trials.readers.formats import file_format
from underfoot.trials.recording.plates import finished_plate
from underfoot.trials.simulator.folder import relaxation
from underfoot.trials.statistics import intraclass_correlation
from underfoot.trials.statistics.logistic import _FLIPS, _flipped_p
from underfoot.trials.study.body_doubts import bodies_measured

UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("in_place", [False, True])
def test_an_unloaded_plate_reads_no_force_and_no_moment(in_place):
    """Drift of both is taken off; the centre of pressure is where the load stood."""
    force, moment = np.zeros((2, 2000, 3))
    force[800:1400, 2] = 700.0
    place = np.array([0.05, -0.02, 0.0])
    moment[:] = np.cross(place, force)
    corners = np.array([[-0.3, -0.2, 0], [0.3, -0.2, 0], [0.3, 0.2, 0], [-0.3, 0.2, 0.0]])
    drift = np.array([3.0, -2.0, 5.0]), np.array([4.0, -6.0, 2.0])
    plate = finished_plate(
        "one", force + drift[0], rate=1000.0, up=UP, moment=moment + drift[1], corners=corners,
        in_place=in_place,
    )  # fmt: skip
    assert plate.baseline == pytest.approx(drift[0])
    assert plate.force == pytest.approx(force, abs=1e-9)
    assert plate.moment == pytest.approx(moment, abs=1e-9)
    assert plate.centre_of_pressure[1000] == pytest.approx(place, abs=1e-6)


def test_an_error_of_agreement_holds_what_raters_differ_by():
    """Shrout and Fleiss 1979, Table 2: mean squares 11.24, 32.49 (judges), 1.02 of 6 subjects."""
    ratings = [[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]]
    agreement = intraclass_correlation(ratings, "ICC(A,1)")
    consistency = intraclass_correlation(ratings, "ICC(C,1)")
    assert agreement.value == pytest.approx(0.2898, abs=1e-4)
    assert consistency.error**2 == pytest.approx(1.0194, abs=1e-4)
    assert agreement.error**2 == pytest.approx(1.0194 + (32.4861 - 1.0194) / 6, abs=1e-3)


def test_what_was_seen_is_one_of_the_flips():
    """p of an effect that no random flip reaches is that of one flip of all, never 0."""
    groups = np.repeat(np.arange(40), 5)
    x = np.repeat(np.arange(40) % 2, 5).astype(float)
    y = np.where(np.arange(200) % 5 == 0, 1.0 - x, x)
    matrix = np.column_stack([np.ones(200), x - x.mean()])
    assert _flipped_p(y, matrix, groups, 1) == 1 / _FLIPS


@pytest.mark.parametrize(("moved", "told"), [(1, False), (2, True), (5, True)])
def test_another_person_shows_in_more_than_three_in_ten_distances_of_markers(moved, told):
    names = ["thigh", "shank", "foot", "arm", "trunk"]
    sizes = dict(zip(names, (0.42, 0.40, 0.21, 0.30, 0.50), strict=True))
    bodies = [dict(sizes) for _ in range(6)]
    for name in names[:moved]:
        bodies[-1][name] *= 1.3
    files = [
        SimpleNamespace(file=f"{k}.c3d", body=body, conditions={"person": "S1"})
        for k, body in enumerate(bodies)
    ]
    doubts = list(bodies_measured(cast(Any, files), "person"))
    assert [one.files for one in doubts] == [("5.c3d",)] * told


def test_a_rubber_pair_is_pressed_held_for_240_s_and_let_go():
    test = relaxation(np.random.default_rng(0), thickness=5e-3, peak=800.0, share=0.35, rate=0.025)
    time, travel, force = test.values()

    def at(when, values):
        return float(values[np.abs(time - when) < 0.05].mean())

    assert [at(when, travel) for when in (1.0, 2.5, 3.5, 242.5, 243.5, 245.0)] == pytest.approx(
        [0.0, 0.5, 1.0, 1.0, 0.5, 0.0], abs=1e-3
    )
    expected = [800 * (0.65 + 0.35 * np.exp(-0.025 * (when - 3))) for when in (3.5, 43.0, 242.5)]
    assert [at(when, force) for when in (3.5, 43.0, 242.5)] == pytest.approx(expected, abs=1.0)
    assert [at(when, force) for when in (1.0, 245.0)] == pytest.approx([0.0, 0.0], abs=1.0)


@pytest.mark.parametrize("first", [1, 2, 127])
def test_a_c3d_is_known_by_its_first_bytes_under_any_name(first):
    head = bytes([first, 0x50]) + bytes(510)
    assert file_format(head, Path("walk.txt")).name == file_format(head, Path("walk.c3d")).name
    for text in (b"TPoints\n1 2", b"\xffP\0\0", b"\0P\0\0"):
        assert file_format(text, Path("walk.txt")).name != file_format(head, Path("x.c3d")).name


def test_one_spike_of_the_load_leaves_the_stretches_without_load():
    rate = 100.0
    load = np.repeat([0.0, 40.0, 0.0, 40.0, 0.0], 500) + np.random.default_rng(0).normal(
        0, 0.1, 2500
    )
    spiked = load.copy()
    spiked[700] = 5e3
    stretches = _unloaded_stretches(load, rate)
    assert len(stretches) == 3
    assert _unloaded_stretches(spiked, rate) == stretches
