"""Steps inside the laws of friction with a right value of their own: cuts, classes, bounds."""

import numpy as np
import pytest

from underfoot.core import RangeError
from underfoot.friction.asperity_scale import self_affine_scale
from underfoot.friction.law import drawn_value
from underfoot.friction.pair_contact import even_rows
from underfoot.friction.sampled_cof import CLASSES, _classes


@pytest.mark.parametrize("hurst", [-0.1, 0.0, 1.0, 1.4])
def test_no_surface_is_rougher_or_smoother_than_self_affine(hurst):
    with pytest.raises(RangeError, match=r"above 0, below 1"):
        self_affine_scale(5e-6, rq=8e-6, longest_wave=0.8e-3, hurst=hurst)


def test_a_draw_keeps_the_sign_of_what_it_is_drawn_about():
    assert drawn_value(0.3, 0.2) == 0.3
    assert 0 < drawn_value(-0.1, 0.2) < 1e-2 * 0.2  # a positive one stays so, and next to nothing
    for centre in (0.0, None):
        assert drawn_value(-0.1, centre) == 0.0
        assert drawn_value(1e-9, centre) == 1e-9


@pytest.mark.parametrize("cells", [30, 1000])
def test_classes_hold_pressure_shear_and_cells_of_what_they_were_made_of(cells):
    generator = np.random.default_rng(2)
    contact = generator.uniform(0, 1e6, cells)
    film = generator.uniform(1e-6, 1e-4, cells)
    wet = generator.random(cells) < 0.7
    counted = generator.integers(1, 4, cells).astype(float)
    pressure, gap, counts, wet_counts = _classes(contact, film, wet, counted)
    assert pressure.size == min(cells, CLASSES)
    assert counts.sum() == counted.sum()
    assert wet_counts.sum() == (counted * wet).sum()
    assert pressure @ counts == pytest.approx(contact @ counted)
    assert wet_counts @ (1 / gap) == pytest.approx((counted * wet) @ (1 / film))  # of eta V / h
    assert np.all(np.diff(pressure) >= 0)


def test_cells_of_one_film_have_a_class_of_that_film():
    wet = np.arange(200) % 3 > 0
    _, gap, *_ = _classes(np.linspace(0, 1e6, 200), np.full(200, 2e-5), wet, np.ones(200))
    np.testing.assert_allclose(gap, 2e-5, rtol=1e-12)


@pytest.mark.parametrize("begin", [1e-3, 0.25, 0.5, 0.999])
@pytest.mark.parametrize("count", [7, 1000])
def test_rows_are_as_many_as_their_share_of_the_weight_to_within_one(begin, count):
    """A draw without weight, at either end too, is never taken."""
    weight = np.random.default_rng(3).exponential(size=400)
    weight[[0, 1, 50, 398, 399]] = 0.0
    weight /= weight.sum()
    rows = even_rows(weight, count, begin)
    taken = np.bincount(rows, minlength=400)
    assert taken.sum() == count
    assert np.abs(taken - count * weight).max() < 1
    assert not taken[weight == 0].any()
    assert (even_rows(np.full(10, 0.1), 20, begin) == np.repeat(np.arange(10), 2)).all()
