"""Files of joint draws and what a crash has taken, by their values."""

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.explore.computing import crashed
from underfoot.explore.inputs import read_joint_draws
from underfoot.explore.record import Ending, Job

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
