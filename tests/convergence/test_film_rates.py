"""Orders of convergence of the film solver."""

import numpy as np

from film_between_walls import closing_film, solved_film
from underfoot.reference import lubrication

LENGTH, H0 = 0.01, 20e-6
OIL = {"viscosity": 0.1, "speed": 0.5}


def orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_inclined_bearing_is_second_order():
    exact = lubrication.inclined_bearing_load(
        **OIL, length=LENGTH, leading_gap=2.5 * H0, trailing_gap=H0
    )
    errors = []
    for cells in (16, 32, 64, 128):
        gap = np.repeat(H0 * (1 + 1.5 * np.linspace(0, 1, cells + 1))[:, None], 3, axis=1)
        film = np.ones(gap.shape, bool)
        film[[0, -1]] = False
        spacing = LENGTH / cells
        load = solved_film(gap, spacing=spacing, mask=film, **OIL).load / (3 * spacing)
        errors.append(abs(load / exact - 1))
    found = orders(errors)
    assert (np.diff(found) > 0).all()
    assert found[-1] > 1.9
    assert errors[-1] < 2e-3


def test_wedge_with_leakage_converges():
    loads = []
    for cells in (16, 32, 64):
        gap = np.repeat(H0 * (1 + np.linspace(0, 1, cells + 1))[:, None], cells + 1, axis=1)
        loads.append(solved_film(gap, spacing=LENGTH / cells, **OIL).load)
    ratio = (loads[1] - loads[0]) / (loads[2] - loads[1])
    assert 3.3 < ratio < 4.7  # second order


def test_squeeze_disc_converges():
    # the staircase rim makes the error of a disc irregular, at best of first order
    errors = []
    for cells in (24, 48, 96, 192):
        radius = 0.01
        spacing = 2 * radius / cells
        place = (np.arange(cells + 4) - (cells + 3) / 2) * spacing
        film = np.hypot(place[:, None], place[None, :]) < radius
        gap = np.where(film, 1e-4, np.inf)
        solved = closing_film(gap, 1e-3, spacing=spacing, viscosity=0.2, mask=film)
        exact = lubrication.squeeze_disc_load(
            viscosity=0.2, radius=radius, gap=1e-4, closing_speed=1e-3
        )
        errors.append(abs(solved.load / exact - 1))
    assert np.polyfit(np.log([24, 48, 96, 192]), np.log(errors), 1)[0] < -0.7
    assert errors[-1] < 0.015
