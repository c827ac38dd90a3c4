"""Order of the load of the mass-conserving film in the cell size."""

import numpy as np
import pytest

from film_between_walls import solved_film

LENGTH, H0 = 0.01, 10e-6


def gap(cells, dimples):
    place = np.arange(cells + 1) / cells
    x, y = np.meshgrid(place, place, indexing="ij")
    profile = H0 * (1 + 4 * (2 * x - 1) ** 2)
    if not dimples:
        return profile
    u, v = (dimples * x) % 1 - 0.5, (dimples * y) % 1 - 0.5
    return profile + 2 * H0 * np.clip(1 - (u * u + v * v) / 0.35**2, 0, None) ** 2


@pytest.mark.parametrize("dimples", [0, 3])
def test_load_is_second_order_across_rupture_and_reformation(dimples):
    """Errors beside the load on the finest grid; a third of the film cavitates."""
    sizes = (24, 32, 48, 64, 96)
    given = {"viscosity": 0.1, "speed": 0.5}
    found = [solved_film(gap(n, dimples), spacing=LENGTH / n, **given) for n in (*sizes, 320)]
    assert found[-1].cavitated.mean() > 0.25
    error = np.abs(np.array([film.load for film in found[:-1]]) / found[-1].load - 1)
    order = -np.polyfit(np.log(sizes), np.log(error), 1)[0]
    assert 1.8 < order < 2.6
    assert error[-1] < 3e-3
    assert max(film.mass_residual for film in found) < 1e-12
