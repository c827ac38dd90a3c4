"""What a result says of the start and the end of a motion that ends."""

import pytest

from small_pads import pad
from underfoot.compute.read import _last_instant


def motion(loads, angles=("3 deg", "3 deg"), speeds=("0.3 m/s", "0.3 m/s"), **more):
    times = ("0 s", "40 ms")
    points = [
        dict(zip(("time", "normal_force", "shoe_angle", "speed"), point, strict=True))
        for point in zip(times, loads, angles, speeds, strict=True)
    ]
    return pad({"motion": {"history_points": points, "shoe_angle": "3 deg", **more}})


@pytest.mark.parametrize(
    ("load", "rise", "within"),
    [("60 N", "4 ms", "4 ms"), ("500 mN", "10 ms", "10 ms"), ("60 N", "30 ms", "10 ms")],
)
def test_a_load_that_is_there_at_once_comes_up_within_its_rise_or_a_step(load, rise, within):
    text = str(_last_instant(motion((load, "50 N"), force_rise_time=rise)))
    assert f"where {load} come up within {within}" in text
    assert text.startswith("at 40 ms")


def test_a_load_that_begins_at_nothing_has_no_rise_of_its_own():
    assert "come up" not in str(_last_instant(motion(("0 N", "50 N"))))


def test_the_angle_is_told_where_it_turns_and_rest_where_the_shoe_ends_so():
    text = str(_last_instant(motion(("0 N", "50 N"), angles=("6 deg", "2 deg"))))
    assert text.startswith("at the end of the motion (40 ms, shoe angle 2")
    assert "at rest" not in text
    still = motion(("0 N", "50 N"), speeds=("0.3 m/s", "0 m/s"))
    assert "where the shoe is at rest" in str(_last_instant(still))
