"""Plates: what an amplifier adds before the first load is no force and no moment."""

import numpy as np
import pytest

from underfoot.trials.recording.plates import finished_plate

UP = np.array([0.0, 0.0, 1.0])
CORNERS = np.array([[0.3, 0.2, 0], [-0.3, 0.2, 0], [-0.3, -0.2, 0], [0.3, -0.2, 0]])
PLACE = np.array([0.05, -0.03, 0.0])


def stood_on(force=(0.0, 0.0, 0.0), moment=(0.0, 0.0, 0.0)):
    """Return a plate that bears 700 N at ``PLACE`` for a second, with what its zeros are off."""
    load = np.zeros((2000, 3))
    load[700:1700, 2] = 700 * np.sin(np.pi * np.arange(1000) / 1000)
    load[:, 0] = 0.1 * load[:, 2]
    return finished_plate(
        "P1",
        load + np.array(force),
        moment=np.cross(PLACE, load) + np.array(moment),
        rate=1000.0,
        up=UP,
        corners=CORNERS,
    )


@pytest.mark.parametrize("force", [(0, 0, 0), (4.0, -3.0, 9.0)])
@pytest.mark.parametrize("moment", [(0, 0, 0), (6.0, -8.0, 2.0)])
def test_zeros_that_are_off_move_neither_force_nor_centre_of_pressure(force, moment):
    plate = stood_on(force, moment)
    loaded = slice(900, 1500)
    assert plate.force[1200] == pytest.approx([70, 0, 700], abs=1e-6)
    assert plate.centre_of_pressure is not None
    np.testing.assert_allclose(
        plate.centre_of_pressure[loaded], np.tile(PLACE, (600, 1)), atol=1e-9
    )


@pytest.mark.parametrize("kind", ["f4", "f8"])
def test_what_a_caller_gives_is_not_written_to(kind):
    force, moment = np.ones((2000, 3), kind), np.ones((2000, 3), kind)
    force[700:1700, 2] = 700.0
    given = force.copy(), moment.copy()
    plate = finished_plate("P1", force, moment=moment, rate=1000.0, up=UP, corners=CORNERS)
    assert plate.force.dtype == float
    assert plate.force[1200, 2] == pytest.approx(699.0)
    np.testing.assert_array_equal(force, given[0])
    np.testing.assert_array_equal(moment, given[1])
