"""Files of joint draws, what a crash has taken and what comes next, by their values."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.explore import proposals
from underfoot.explore.computing import crashed
from underfoot.explore.inputs import Choice, Range, read_joint_draws
from underfoot.explore.record import Ending, Job
from underfoot.explore.surrogate import featured

HEAD = "# a posterior\ncontaminant.viscosity,motion.speed\n"


def draws_of(tmp_path, rows):
    path = tmp_path / "draws.csv"
    path.write_text(HEAD + "".join(f"{a},{b}\n" for a, b in rows))
    return read_joint_draws(path)


def test_joint_draws_are_the_rows_of_their_file(tmp_path):
    draws = draws_of(tmp_path, [(0.1, 0.5), (0.2, 0.7)])
    assert draws.paths == ("contaminant.viscosity", "motion.speed")
    np.testing.assert_array_equal(draws.values, [[0.1, 0.5], [0.2, 0.7]])
    both = {"contaminant.viscosity": 0.2, "motion.speed": 0.7}
    assert draws.rows(2)[1] == both
    # evenly from the first to the last
    many = draws_of(tmp_path, [(0.1 * k, 0.5) for k in range(1, 10)])
    taken = [row["contaminant.viscosity"] for row in many.rows(3)]
    assert taken == pytest.approx([0.1, 0.5, 0.9])


@pytest.mark.parametrize(
    "rows", [[], [(0.1, 0.5)], [(0.1, 0.5), (0.2, "")], [(0.1, 0.5), ("inf", 0.5)], [("a", 1)] * 2]
)
def test_one_draw_or_one_that_is_no_number_makes_no_posterior(tmp_path, rows):
    with pytest.raises(InputError, match=r"draws\.csv"):
        draws_of(tmp_path, rows)


def test_a_case_that_crashed_has_no_number_and_took_no_time_that_is_known():
    record = crashed(Job("k", 0, 0, 0, 0, (0.5,), {}))
    assert record.ending is Ending.CRASHED
    assert not record.usable
    assert (record.seconds, record.cpu_seconds, record.memory) == (0.0, 0.0, 0.0)
    assert np.isnan(record.number("cof"))


@pytest.mark.parametrize(
    ("kind", "active", "run", "batch", "then"),
    [
        ("optimise", 0.0, 6, 3, ("promising", 3)),
        ("robust", 0.0, 8, 3, ("promising", 2)),  # of ten
        ("sweep", 0.5, 6, 9, ("least known", 4)),
        ("sweep", 0.0, 6, 9, "again"),  # its places do not follow from results
        ("optimise", 0.0, 10, 3, "again"),
        ("sweep", 0.5, 10, 3, "again"),
        ("sensitivity", 0.0, 10, 3, "again"),
    ],
)
@pytest.mark.parametrize("ended", [False, True])
def test_what_comes_next_follows_from_the_kind_and_from_what_is_left(
    monkeypatch, kind, active, run, batch, then, ended
):
    asked = []

    def asks(name):
        return lambda so_far, count: asked.append((name, count)) or [(0.5,)] * count

    monkeypatch.setattr(proposals, "_promising", asks("promising"))
    monkeypatch.setattr(proposals, "_least_known", asks("least known"))
    plan = SimpleNamespace(
        designs=10,
        goals=("cof",),
        method=SimpleNamespace(
            kind=kind, active=active, batch=batch, again=1, again_on="full", quick=True
        ),
        jobs=lambda number, point, batch, again=False: [(number, point, batch, again)],
    )
    best = SimpleNamespace(number=4, point=(0.4,))
    so_far = SimpleNamespace(
        # the start on the finer grid is what a study ends with
        jobs=[SimpleNamespace(batch=2, design=run - 1, point=() if ended else (0.1,), quick=True)],
        designs=[None] * run,
        again=[],
        best=lambda count: [best] * count,
    )
    jobs = list(proposals.next_batch(cast(Any, plan), cast(Any, so_far)))
    if then == "again":
        assert not asked
        again = [(4, (0.4,), 3, True), (run, (), 3, True)]
        assert jobs == ([] if ended and run == 10 else again)
    else:
        assert asked == [then]
        assert jobs == [(run + k, (0.5,), 3, False) for k in range(then[1])]


def test_a_name_has_a_column_a_value_and_a_number_its_share_of_the_range():
    dimensions = (
        Range("shoe.tread.depth", 1e-3, 4e-3),
        Choice("shoe.tread.pattern", ("grid", "bars", "none")),
        Choice("shoe.material.shore_a", (50.0, 55.0, 70.0)),
    )
    points = np.array([[0.2, 0.1, 0.1], [0.7, 0.5, 0.5], [1.0, 1.0, 1.0]])
    np.testing.assert_allclose(
        featured(dimensions, points),
        [[0.2, 1, 0, 0, 0.0], [0.7, 0, 1, 0, 0.25], [1.0, 0, 0, 1, 1.0]],
    )
    alone = Choice("shoe.material.shore_a", (60.0,))
    np.testing.assert_array_equal(featured((alone,), np.array([[0.5]])), [[0.0]])
