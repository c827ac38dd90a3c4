"""Composite surfaces against a time march of two rough bodies, and where they are exact."""

import numpy as np
import pytest

from underfoot.material import power_law_spectrum
from underfoot.rough_contact import steady_sliding
from underfoot.rough_contact.composite import PLAIN, RESTING, composite_surface
from underfoot.studies.transient import transient_sliding
from underfoot.surface import checkerboard, self_affine

RUBBER = power_law_spectrum(3 * 0.44e6, 0.12, terms_per_decade=1)
PRESSURE, SPEED = 160e3, 0.1


def board(peak_to_valley, wavelength):
    return checkerboard(80, 2e-3 / 80, peak_to_valley, wavelength)


PAIRS = {
    "report": (board(16.6e-6, 0.4e-3), board(35.1e-6, 0.5e-3)),
    "random": tuple(self_affine(48, 8e-6, 4e-6, 0.8, 192e-6, 64e-6, seed) for seed in (0, 7)),
}


def slide(surface):
    contact = steady_sliding(surface.heights, surface.spacing, RUBBER, SPEED, PRESSURE)
    assert contact.status.usable
    return contact


@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
def test_march_lies_where_the_composites_say(pair):
    floor, shoe = pair
    march = transient_sliding(
        floor.heights, floor.spacing, RUBBER, SPEED, pressure=PRESSURE, shoe_height=shoe.heights
    )
    assert march.status.usable
    last = slice(-floor.shape[0], None)
    gap, area = march.mean_gap[last].mean(), march.real_contact_fraction[last].mean()
    plain, resting = (
        slide(composite_surface(floor, shoe)),
        slide(composite_surface(floor, shoe, RUBBER, SPEED)),
    )
    assert resting.mean_gap < gap < plain.mean_gap
    assert resting.mean_gap == pytest.approx(gap, rel=0.19)
    assert resting.real_contact_fraction == pytest.approx(area, rel=0.1)
    alone = slide(floor).cof_hysteresis
    assert 0.87 < march.cof_hysteresis / alone < 1.0
    assert plain.cof_hysteresis > 1.3 * alone


def test_resting_waves_give_the_full_contact_pressure_of_both():
    floor, shoe = (self_affine(32, 1e-5, 1e-6, 0.8, 320e-6, 80e-6, seed=seed) for seed in (1, 2))
    both = composite_surface(floor, shoe, RUBBER, SPEED)
    contact = steady_sliding(both.heights, both.spacing, RUBBER, SPEED, 1e8)
    assert contact.full_contact
    q = 2 * np.pi * np.fft.fftfreq(32, 1e-5)
    qx, qy = np.meshgrid(q, q, indexing="ij")
    moving = RUBBER(np.abs(qx * SPEED))
    moving = np.where(qx < 0, moving.conj(), moving) / 0.75
    rest = RUBBER(0.0).real / 0.75
    waves = np.hypot(qx, qy) / 2
    spectrum = waves * (moving * np.fft.fft2(floor.heights) + rest * np.fft.fft2(shoe.heights))
    expected = 1e8 + np.fft.ifft2(spectrum).real
    np.testing.assert_allclose(contact.pressure, expected, atol=1e-5 * np.std(expected))


def test_elastic_or_at_rest_it_is_the_sum_and_it_tells_its_limits():
    floor, shoe = PAIRS["random"]
    total = floor.heights + shoe.heights
    plain = composite_surface(floor, shoe)
    np.testing.assert_array_equal(plain.heights, total)
    assert plain.processing[-1] == PLAIN
    elastic = composite_surface(floor, shoe, 5e6, SPEED)
    np.testing.assert_allclose(elastic.heights, total, atol=1e-18)
    assert elastic.processing[-1] == RESTING
    assert composite_surface(floor, shoe, RUBBER, 0.0).processing[-1] == PLAIN
