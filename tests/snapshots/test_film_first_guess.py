"""A large film begins from the full cells of one half as fine: it settles in few sets."""

import numpy as np
import pytest

from underfoot.film.pressure import FEWEST_CELLS, Film, film_pressure


def bearing(cells):
    """A film that narrows and widens: a fifth of it cavitates."""
    x = np.linspace(0, 1, cells)
    gap = np.outer(20e-6 - 15e-6 * np.sin(2 * np.pi * x), np.ones(cells))
    return film_pressure(Film(gap, 0.02 / cells, 0.1, 0.5))


def test_cavities_of_a_coarse_film_are_nearly_those_of_a_fine_one():
    bare, first, second = map(bearing, (FEWEST_CELLS - 1, FEWEST_CELLS, 2 * FEWEST_CELLS))
    assert 0.1 < second.cavitated.mean() < 0.3
    assert second.load == pytest.approx(bare.load, rel=0.1)
    # from cells that are all full it takes five
    assert (bare.iterations, first.iterations, second.iterations) == (5, 3, 3)
