"""What the mean required friction is off by, within one walker and between several."""

import math

import numpy as np
import pytest

from underfoot.questions.slips import measured_rcof
from underfoot.slip import RcofPopulation, slip_risk

HEADS = "file,person,item,quantity,value,caution"


def measured(tmp_path, *rows: str):
    path = tmp_path / "measurements.csv"
    path.write_text("\n".join([HEADS, *(f"{row}," for row in rows), ""]))
    return measured_rcof(path)


def test_steps_of_two_persons_are_no_four_persons(tmp_path):
    steps = ("a,A,1,rcof,0.18", "b,A,2,rcof,0.20", "c,B,1,rcof,0.24", "d,B,2,rcof,0.26")
    read = measured(tmp_path, *steps, "e,,1,rcof,0.9")
    assert read.persons == 2
    assert (read.mean, read.sd) == pytest.approx((0.22, 0.06 / math.sqrt(2)))
    assert read.within == pytest.approx(0.02 / math.sqrt(2))
    assert read.mean_deviation == pytest.approx(0.03)
    assert read.sd_deviation == pytest.approx(0.03)
    assert "1 steps of no named person are left out" in read.text


def test_one_walker_differs_from_nobody(tmp_path):
    read = measured(tmp_path, "a,,1,rcof,0.20", "a,,2,rcof,0.24")
    steps = {each.partition("=")[0]: each for each in read.settings(steps=True)}
    assert "value = 0," in steps["risk.rcof_sd"]
    assert steps["slip.rcof_step_sd"] == "slip.rcof_step_sd=0.0282843"
    assert "value = 0.0282843" in read.settings(steps=False)[1]


def test_an_unknown_mean_widens_the_interval():
    acof = np.full(4000, 0.14)
    known, unknown = (
        slip_risk(0.14, rcof=RcofPopulation(0.2, 0.03, mean_deviation=off), samples=acof)
        for off in (0.0, 0.03)
    )
    assert unknown.low < known.low < known.high < unknown.high


def test_a_slope_that_is_off_moves_the_mean():
    """d tan(s + atan r) / ds = 1 + needed^2."""
    level = RcofPopulation(0.2, 0.03)
    needed = level.on_slope(0.05, 0.01)
    assert needed.mean_deviation == pytest.approx(0.01 * (1 + needed.mean**2))
    assert needed.mean == level.on_slope(0.05).mean
