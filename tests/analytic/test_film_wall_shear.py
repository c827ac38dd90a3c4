"""Shear of the film on its walls against closed forms."""

import math

import numpy as np
import pytest

from film_between_walls import solved_film
from underfoot.core import InputError
from underfoot.film import wall_shear

ETA, SPEED, LENGTH, H0 = 0.1, 0.5, 0.01, 2e-5


def test_drag_of_the_inclined_bearing():
    """eta u l / h0 [4 ln(1 + m) / m - 6 / (2 + m)] on the flat wall; both walls by the wedge."""
    cells, m = 400, 1.0
    place = np.arange(cells + 1) / cells
    gap = np.repeat((H0 * (1 + m * place))[:, None], 3, axis=1)
    film = np.ones(gap.shape, bool)
    film[[0, -1]] = False
    spacing = LENGTH / cells
    given = {"spacing": spacing, "viscosity": ETA, "speed": SPEED}
    solved = solved_film(gap, mask=film, **given)
    lower, upper = wall_shear(solved.pressure, gap, fraction=solved.fraction, **given)
    unit = ETA * SPEED * LENGTH / H0
    flat = unit * (4 * math.log(1 + m) / m - 6 / (2 + m))
    drag = [np.trapezoid(stress[:, 1], dx=spacing) for stress in (lower, upper)]
    assert drag[0] == pytest.approx(flat, rel=1e-3)
    # the pressure on the tilted wall makes up the difference
    load = solved.load / (3 * spacing)
    assert drag[0] - drag[1] == pytest.approx(load * m * H0 / LENGTH, rel=5e-3)


def test_ruptured_and_open_film():
    gap = np.full((6, 4), H0)
    gap[:2] = np.inf
    lower, upper = wall_shear(
        np.zeros((6, 4)), gap, spacing=1e-3, viscosity=ETA, speed=SPEED, fraction=0.3
    )
    assert (lower[:2] == 0).all()
    assert lower[2:] == pytest.approx(0.3 * ETA * SPEED / H0)
    assert upper == pytest.approx(lower)


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"gap": np.zeros((6, 4))}, "gap"),
        ({"gap": np.ones((6, 3))}, "gap"),
        ({"pressure": np.full((6, 4), np.nan)}, "pressure, fraction or speed"),
        ({"pressure": np.where(np.eye(6, 4) > 0, np.inf, 0.0)}, "pressure, fraction or speed"),
        ({"pressure": np.where(np.eye(6, 4) > 0, np.nan, 0.0)}, "pressure, fraction or speed"),
        ({"viscosity": 0.0}, "viscosity"),
        ({"spacing": math.inf}, "spacing"),
    ],
)
def test_bad_input_is_refused(change, where):
    given = {
        "pressure": np.zeros((6, 4)),
        "gap": np.full((6, 4), H0),
        "spacing": 1e-3,
        "viscosity": ETA,
        "speed": SPEED,
    } | change
    with pytest.raises(InputError) as caught:
        wall_shear(given.pop("pressure"), given.pop("gap"), **given)
    assert caught.value.where == where
