"""``underfoot trials curves``: all that it says of two conditions, as text and as JSON."""

import json

import numpy as np
import pytest

from commands import said
from snapshot import held
from underfoot.cli import trials_curves
from underfoot.trials.statistics import paired_curve_test

RNG = np.random.default_rng(4)
FIRST = np.cumsum(RNG.normal(size=(9, 40)), axis=1)
SECOND = FIRST + 0.1 * np.cumsum(RNG.normal(size=(9, 40)), axis=1)
SECOND[:, 20:30] += 1.5
SECOND[:, 5] += 1
SECOND[:, 0] = FIRST[:, 0]


@pytest.fixture
def folder(tmp_path):
    np.savez(tmp_path / "both.npz", YA=FIRST, YB=SECOND)
    np.savez(tmp_path / "same.npz", YA=FIRST, YB=FIRST[::-1])
    vectors = np.stack([FIRST, SECOND], axis=2)
    np.savez(tmp_path / "vectors.npz", YA=vectors, YB=vectors[..., ::-1])
    np.save(tmp_path / "first.npy", FIRST)
    np.save(tmp_path / "second.npy", SECOND)
    np.save(tmp_path / "fewer.npy", SECOND[:8])
    return tmp_path


def test_what_is_said(file_regression, folder, wide):
    asked = {
        "both": ("both.npz",), "two files": ("first.npy", "second.npy"), "nowhere": ("same.npz",),
        "strict": ("both.npz", "--alpha", "0.001"), "first part": ("vectors.npz", "--component", 1),
        "no such part": ("vectors.npz", "--component", 3), "no part": ("vectors.npz",),
        "a part of curves": ("both.npz", "--component", 1), "one": ("first.npy",),
        "fewer": ("first.npy", "fewer.npy"), "alpha": ("both.npz", "--alpha", "1"),
        "three": ("both.npz", "first.npy"),
    }  # fmt: skip
    told = {name: said(folder, "trials", "curves", *words) for name, words in asked.items()}
    held(file_regression, told)


def test_the_json_is_the_test(folder):
    code, out, _ = said(folder, "trials", "curves", "both.npz", "--json")
    test = paired_curve_test(FIRST, SECOND, alpha=0.05)
    read = json.loads(out)
    assert code == 0
    assert {key: value for key, value in read.items() if key not in ("t", "clusters")} == {
        "format": 1, "kind": "curves", "persons": 9, "nodes": 40, "threshold": test.threshold,
        "fwhm": test.fwhm, "p": test.p, "still": [0],
    }  # fmt: skip
    assert read["t"][0] is None
    assert read["t"][1:] == test.t[1:].tolist()
    assert [(one["first_node"], one["last_node"], one["p"], one["p_peak"])
            for one in read["clusters"]] == [
                (one.start, one.stop, one.p, one.p_peak) for one in test.clusters]  # fmt: skip
    assert len(read["clusters"]) > 1


def test_a_vector_gives_the_component_that_is_asked_for():
    vectors = np.stack([FIRST, SECOND, FIRST + 1], axis=2)
    for number, part in ((1, FIRST), (2, SECOND), (3, FIRST + 1)):
        assert np.array_equal(trials_curves._component(vectors, number, "a"), part)
    assert np.array_equal(trials_curves._component(FIRST, 0, "a"), FIRST)
