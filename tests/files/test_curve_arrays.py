"""Curves of two conditions as arrays of spm1d's users: the same numbers from every form."""

import json

import numpy as np
import pytest
from scipy.io import savemat

from commands import called
from underfoot.core import DataError
from underfoot.trials.readers.curve_arrays import read_curves
from underfoot.trials.statistics import paired_curve_test

NODES = np.linspace(0, 1, 101)
SECOND = np.array([np.sin(3 * NODES * (1 + 0.1 * i)) for i in range(8)])
FIRST = SECOND + [
    0.1 * np.cos(7 * NODES + i) + 0.4 * np.exp(-(((NODES - 0.5) / 0.1) ** 2)) for i in range(8)
]


def german(values):
    return "\n".join(";".join(str(one).replace(".", ",") for one in row) for row in values)


def written(folder, form):
    paths = [folder / f"{name}.{form}" for name in ("YA", "YB")]
    match form:
        case "npy":
            for path, values in zip(paths, (FIRST, SECOND), strict=True):
                np.save(path, values)
        case "csv":
            np.savetxt(paths[0], FIRST, delimiter=",", fmt="%.17g")
            paths[1].write_text(german(SECOND))
        case "txt":
            for path, values in zip(paths, (FIRST, SECOND), strict=True):
                np.savetxt(path, values, fmt="%.17g")
        case "npz":
            np.savez(paths[0], YA=FIRST, YB=SECOND, SUBJ=np.arange(8))
            return paths[:1]
        case "mat":
            savemat(paths[0], {"YA": FIRST, "YB": SECOND, "A": np.arange(8.0)})
            return paths[:1]
    return paths


@pytest.mark.parametrize("form", ["npy", "npz", "mat", "csv", "txt"])
def test_every_form_has_the_same_test(tmp_path, form):
    done = called("trials", "curves", *map(str, written(tmp_path, form)), "--json")
    assert done.returncode == 0, done.stderr
    found, right = json.loads(done.stdout), paired_curve_test(FIRST, SECOND)
    assert (found["persons"], found["nodes"]) == (8, 101)
    np.testing.assert_allclose(found["t"], right.t)
    assert (found["threshold"], found["fwhm"]) == pytest.approx((right.threshold, right.fwhm))
    (one,) = found["clusters"]
    assert (one["first_node"], one["last_node"]) == (
        right.clusters[0].start,
        right.clusters[0].stop,
    )


def test_half_a_file_is_damaged(tmp_path):
    (path,) = written(tmp_path, "npz")
    path.write_bytes(path.read_bytes()[:4000])
    with pytest.raises(DataError, match="damaged"):
        read_curves(path)


def test_a_component_of_vectors_is_named(tmp_path):
    path = tmp_path / "both.npz"
    np.savez(path, YA=np.stack([SECOND, FIRST], 2), YB=np.stack([FIRST, SECOND], 2))
    asked = called("trials", "curves", str(path))
    assert asked.returncode == 2
    assert "1 to 2" in asked.stderr
    done = called("trials", "curves", str(path), "--component", "2", "--json")
    assert json.loads(done.stdout)["t"][50] == pytest.approx(paired_curve_test(FIRST, SECOND).t[50])


def test_what_is_no_pair_of_conditions_is_told(tmp_path):
    np.savez(tmp_path / "groups.npz", YA=FIRST, YB=SECOND[:5])
    told = called("trials", "curves", str(tmp_path / "groups.npz"))
    assert told.returncode != 0
    assert "8 and 5 curves" in told.stderr
    np.save(tmp_path / "one.npy", FIRST)
    assert "1 arrays" in called("trials", "curves", str(tmp_path / "one.npy")).stderr


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (FIRST.T, "Transpose"),
        (np.arange(5.0), "no array of curves"),
        ("1,2,3\n4,5\n", "line 2 has 2 values"),
        ("0 %,50 %,100 %\n1,2,3\n", "headings"),
    ],
)
def test_arrays_that_are_no_curves(tmp_path, content, says):
    path = tmp_path / "curves.npy"
    if isinstance(content, str):
        path = path.with_suffix(".csv")
        path.write_text(content)
    else:
        np.save(path, content)
    with pytest.raises(DataError, match=says):
        read_curves(path)
    path.write_bytes(b"\x93NUMPY\x01")
    with pytest.raises(DataError):
        read_curves(path)
