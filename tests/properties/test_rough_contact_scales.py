"""Contact tables over more waves than a grid holds: beside one grid, and where theory is exact."""

import numpy as np
import pytest

from underfoot.core import Cache, InputError
from underfoot.material import power_law_spectrum
from underfoot.rough_contact import ContactTable, table_over_scales
from underfoot.rough_contact.persson import persson_growth
from underfoot.rough_contact.scales import RATIO
from underfoot.surface import HeightMap, rms_slope, surface_of_density

LONGEST, RQ, MODULUS = 2e-3, 8e-6, 5e6
PRESSURE = np.array([3e4, 1e5, 3e5, 6e5])


def density(q):
    """Self-affine, Hurst exponent 0.8, Rq 8 um in three decades of waves."""
    first = 2 * np.pi / LONGEST
    level = RQ**2 / (2 * np.pi * first**2 / 1.6)
    return level * (q / first) ** -3.6


def long_waves(surface, shortest):
    """Return the waves down to the shortest on a grid four times as coarse."""
    q = 2 * np.pi * np.fft.fftfreq(surface.shape[0], surface.spacing)
    long = np.hypot(q[:, None], q) <= 2 * np.pi / shortest * 1.0001
    heights = np.fft.ifft2(np.where(long, np.fft.fft2(surface.heights), 0)).real[::4, ::4]
    return HeightMap(heights.copy(), 4 * surface.spacing, periodic=True, resolution=shortest)


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return Cache("scales", tmp_path_factory.mktemp("scales"))


def test_a_generated_band_has_the_height_and_slope_of_its_spectrum():
    waves = (1e-3, 1e-4)
    surface = surface_of_density(density, waves, 128, 3e-3 / 128, seed=1)
    q = np.geomspace(2 * np.pi / waves[0], 2 * np.pi / waves[1], 400)
    height, slope = (
        np.sqrt(2 * np.pi * np.trapezoid(q ** (1 + order) * density(q), q)) for order in (0, 2)
    )
    assert surface.rms_height == pytest.approx(height, rel=0.015)
    assert rms_slope(surface) == pytest.approx(slope, rel=0.015)


@pytest.mark.slow
def test_two_nested_grids_agree_with_one_that_holds_all_waves(cache):
    """The same long waves; area within 15 %, gap within 10 % above 0.1 um, flow within a half."""
    points, side, turn, last = 512, 2 * LONGEST, LONGEST / RATIO, LONGEST / RATIO**2
    whole = [
        surface_of_density(density, (LONGEST, last), points, side / points, n) for n in range(2)
    ]
    options = {"modulus": MODULUS, "speed": [0.3], "poisson_ratio": 0.49, "cache": cache}
    single = ContactTable.from_surfaces(whole, pressure=PRESSURE, **options)
    coarse = [long_waves(one, turn) for one in whole]
    fine = [
        surface_of_density(density, (turn, last), 128, 3 * turn / 128, 50 + n) for n in range(2)
    ]
    finer = ContactTable.from_surfaces(fine, pressure=np.geomspace(5e3, 5e6, 9), **options)
    nested = ContactTable.from_surfaces(coarse, pressure=PRESSURE, finer=finer, **options)
    rigid = ContactTable.from_surfaces(coarse, pressure=PRESSURE, **options)

    def ratio(table, name, part=slice(None)):
        return table.values[name][part, 0] / single.values[name][part, 0]

    assert np.abs(ratio(nested, "real_contact_fraction") - 1).max() < 0.15
    assert np.abs(ratio(nested, "mean_gap", slice(0, 3)) - 1).max() < 0.10
    flow = [np.mean([t.values[f"flow_factor_{way}"][:2, 0] for way in ("along", "across")], axis=0)
            for t in (nested, single, rigid)]  # fmt: skip
    assert np.abs(flow[0] / flow[1] - 1).max() < 0.5
    assert flow[2][1] < 0.5 * flow[1][1]  # the long waves alone let less through
    assert ratio(rigid, "real_contact_fraction")[:3].min() > 1.3


@pytest.mark.slow
def test_hysteresis_of_nested_grids_agrees_with_one_that_holds_all_waves(cache):
    """The same long waves on a viscoelastic rubber: within 12 % from light to full contact."""
    rubber, points, side = power_law_spectrum(1.3e6, 0.12), 512, 2 * LONGEST
    turn, last = LONGEST / RATIO, LONGEST / RATIO**2

    def lower(q):
        return density(q) / 4

    options = {"modulus": rubber, "speed": [0.3], "poisson_ratio": 0.49, "cache": cache}
    whole = surface_of_density(lower, (LONGEST, last), points, side / points, 0)
    single = ContactTable.from_surfaces([whole], pressure=PRESSURE, **options)
    fine = [surface_of_density(lower, (turn, last), 128, 3 * turn / 128, 50 + n) for n in range(2)]
    finer = ContactTable.from_surfaces(fine, pressure=np.geomspace(2e4, 2e7, 9), **options)
    coarse = [long_waves(whole, turn)]
    nested = ContactTable.from_surfaces(coarse, pressure=PRESSURE, finer=finer, **options)
    rigid = ContactTable.from_surfaces(coarse, pressure=PRESSURE, **options)
    loss = [table.values["cof_hysteresis"][:, 0] for table in (nested, single, rigid)]
    assert np.abs(loss[0] / loss[1] - 1).max() < 0.12
    assert (loss[2] / loss[1]).max() < 0.5


def test_hysteresis_in_full_contact_is_the_sum_over_all_waves(cache):
    """Every wave loses its own energy there (Persson 2001): exact whatever range it stands in."""
    rubber, speed = power_law_spectrum(1.3e6, 0.12), 0.3
    waves, smooth = (1e-3, 2e-5), lambda q: 0.04 * density(q)
    full = 2e7 * np.array([0.25, 0.5, 0.75, 1.0])
    table = table_over_scales(
        smooth, waves, rubber, full, [speed], poisson_ratio=0.5, surfaces=1, cache=cache
    )
    q = np.geomspace(2 * np.pi / waves[0], 2 * np.pi / waves[1], 400)
    exact = persson_growth(full, q, smooth(q), rubber, speed, gamma=1.0)[1][:, -1]
    assert table.values["real_contact_fraction"][-1, 0] == pytest.approx(1.0, abs=1e-6)
    # one random surface a range: its waves along the motion scatter by some percent
    assert table.values["cof_hysteresis"][-1, 0] == pytest.approx(exact[-1], rel=0.06)


def test_an_elastic_table_scales_with_heights_and_modulus(cache):
    options = {"waves": (1e-3, 1e-4), "speed": [1.0], "cache": cache, "surfaces": 1}
    nodes = np.geomspace(1e3, 1e6, 5)
    table = table_over_scales(density, modulus=MODULUS, pressure=nodes, **options)
    stiffer = table_over_scales(density, modulus=3 * MODULUS, pressure=3 * nodes, **options)
    scaled = table.scale_contact(1.0, 3.0, 1.0)
    for name in ("real_contact_fraction", "mean_gap", "flow_factor_along"):
        assert scaled.values[name] == pytest.approx(stiffer.values[name], rel=1e-3, abs=1e-9)
    assert table.scale_contact(1.0, 1.0, 0.3).breaches(pressure=1e4, speed=0.3) == []


def test_waves_in_the_wrong_order_are_refused(cache):
    with pytest.raises(InputError, match="the longest, then a shorter one"):
        table_over_scales(density, (1e-5, 1e-3), MODULUS, PRESSURE, [0.3], cache=cache)
