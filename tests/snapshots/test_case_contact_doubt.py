"""What is unsure of a contact table, and a pair's law that is built of one."""

import dataclasses
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.special import erfinv

from underfoot.case import Case
from underfoot.case.friction import SHORTEST_WAVE_DEVIATION, contact_deviation
from underfoot.compute.resolve import resolve_context
from underfoot.core import RangeError
from underfoot.friction.pair_contact import CONTACT_PRESSURE
from underfoot.rough_contact import ContactTable
from underfoot.rough_contact.contact_table import QUANTITIES

NODES = np.geomspace(1e4, 1e6, 4), np.array([0.3])
ONES = np.ones((4, 1))


def table(area=0.1, scatter=0.04, loss=0.06, count=4):
    values = dict.fromkeys(QUANTITIES, area * ONES) | {"cof_hysteresis": loss * ONES}
    deviation = dict.fromkeys(QUANTITIES, scatter * ONES)
    numbers = np.full((4, 1), count)
    numbers[0] = 2 * count  # the fewest count
    return ContactTable(*NODES, values, deviation, numbers)


@pytest.mark.parametrize(
    ("area", "scatter", "count", "rq", "between"),
    [(0.1, 0.04, 4, 0.2, 0.2), (0.1, 0.04, 16, 0.2, 0.1), (0.4, 0.04, 1, None, 0.1),
     (0.5, 0.0, 4, 0.1, 0.0)],
)  # fmt: skip
def test_the_deviation_of_a_table_is_that_of_its_mean(area, scatter, count, rq, between):
    context: Any = SimpleNamespace(rq_deviation=rq)
    found = contact_deviation(table(area, scatter, count=count), 1e5, 0.3, context)
    assert found == pytest.approx(math.hypot(between, rq or 0.0, SHORTEST_WAVE_DEVIATION), rel=1e-6)


def pair_of(folder, made, **more):
    made.save(folder / "rubber.npz")
    case = Case(
        shoe="work_shoe_full_tread", floor="vinyl_g4", contaminant="none",
        motion={"from": "slip_tester_g4", "speed": 0.3},
        friction={"model": "pair", "contact_table": str(folder / "rubber.npz"), **more},
    )  # fmt: skip
    context = resolve_context(case)
    return case.friction.build(context).pair, context


def test_a_pair_takes_area_loss_and_doubt_of_its_table(tmp_path):
    pair, context = pair_of(tmp_path, table())
    assert pair.full_contact == pytest.approx(CONTACT_PRESSURE / erfinv(0.1), rel=1e-9)
    assert pair.hysteresis == pytest.approx(0.06)
    assert pair.hysteresis_origin == "rubber.npz"
    assert pair.contact_deviation == pytest.approx(
        math.hypot(0.2, context.rq_deviation or 0.0, SHORTEST_WAVE_DEVIATION), rel=1e-6
    )


@pytest.mark.parametrize(("loss", "taken"), [(0.99e-4, False), (1.01e-4, True)])
def test_a_table_without_loss_is_that_of_an_elastic_compound(tmp_path, loss, taken):
    pair, _ = pair_of(tmp_path, table(loss=loss))
    assert (pair.hysteresis_origin == "rubber.npz") == taken
    if taken:
        assert pair.hysteresis == pytest.approx(loss)


def test_a_table_loses_where_any_of_its_nodes_does(tmp_path):
    made = table(loss=0.0)
    made.values["cof_hysteresis"][-1] = 0.05
    assert pair_of(tmp_path, made)[0].hysteresis_origin == "rubber.npz"


def test_a_whole_contact_is_bounded(tmp_path):
    pair, _ = pair_of(tmp_path, table(area=1.0))
    assert pair.full_contact == pytest.approx(CONTACT_PRESSURE / erfinv(1 - 1e-9))


@pytest.mark.parametrize(("falling", "enough"), [(3, True), (2, False)])
def test_a_law_of_a_table_needs_three_pressures_with_an_open_gap(falling, enough):
    """Each node of the finer grid below the one before by more than a millionth of the first."""
    gap = np.full(4, 1e-6)
    made = table()
    fine = 1e-6 * (1 - 0.1 * np.arange(100))
    drop = dataclasses.replace(made, values={**made.values, "mean_gap": gap[:, None]})
    seen = fine[:falling].tolist()

    def mean_gap(self, pressure, speed, outside):
        return np.array([*seen, *[seen[-1]] * (len(pressure) - len(seen))])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ContactTable, "mean_gap", mean_gap)
        if enough:
            assert drop.law(0.3).gap.size == 3
        else:
            with pytest.raises(RangeError, match="only 2 pressures"):
                drop.law(0.3)
