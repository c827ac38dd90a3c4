"""The floor sensor's reading against closed forms."""

import math

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from underfoot.core import InputError
from underfoot.sole_contact import floor_sensor_reading
from underfoot.sole_contact.reading import (
    _rim_quarter,
    conductance_over_cube,
    lag_pressure,
    pocket_pressure,
)

MM = 1e-3


def grid(length=100.0, width=100.0, spacing=0.5):
    x = (np.arange(round(length / spacing)) + 0.5) * spacing * MM
    y = (np.arange(round(width / spacing)) - 0.5 * (round(width / spacing) - 1)) * spacing * MM
    return x, y, np.meshgrid(x, y, indexing="ij")


def test_uniform_patch_in_a_uniform_gap_keeps_its_load():
    """With one gap everywhere the rim mean is a moving average: the integral stays a b p."""
    x, y, (xx, yy) = grid()
    pressure = np.where((np.abs(xx - 50 * MM) < 20 * MM) & (np.abs(yy) < 15 * MM), 2e5, 0.0)
    reading = floor_sensor_reading(x, y, pressure, np.full_like(pressure, 1e-3))
    assert reading.load.value == pytest.approx(40 * 30 * MM**2 * 2e5, rel=2e-3)
    assert reading.peak_pressure.value == pytest.approx(2e5, rel=1e-9)
    assert reading.outermost_share == pytest.approx(0.0, abs=1e-12)


def test_patch_in_a_thin_film_vents_where_the_rim_leaves_it():
    """Film 20 um, surroundings open: only pockets wholly inside read, an area (a - D)(b - D)."""
    x, y, (xx, yy) = grid(spacing=0.25)
    inside = (np.abs(xx - 50 * MM) < 20 * MM) & (np.abs(yy) < 15 * MM)
    reading = floor_sensor_reading(
        x,
        y,
        np.where(inside, 2e5, 0.0),
        np.where(inside, 20e-6, 1e-3),
        scan_spacing=2 * MM,
        scans=30,
    )
    assert reading.load.value == pytest.approx(30 * 20 * MM**2 * 2e5, rel=0.03)


def test_reading_of_a_straight_film_edge():
    """Rim share inside a half plane at distance t from the centre: 1 - arccos(t / R) / pi."""
    x, y, (xx, _) = grid(spacing=0.1, length=40, width=40)
    pressure = np.where(xx < 20 * MM, 1e5, 0.0)
    reading = floor_sensor_reading(x, y, pressure, np.full_like(pressure, 1e-3), scans=1, offsets=1)
    t = 20 * MM - reading.x
    near = np.abs(t) < 4.5 * MM
    expected = 1e5 * (1 - np.arccos(t[near] / (5 * MM)) / math.pi)
    assert reading.pressure[near, 0] == pytest.approx(expected, abs=2e3)


def test_a_point_sensor_with_dense_scans_finds_the_true_load():
    """Inlet, spacing and grid to zero: the error falls with their square."""
    true = 2e5 * math.pi * (10 * MM) ** 2
    errors = []
    for inlet, spacing, cell in ((8.0, 4.0, 1.0), (4.0, 2.0, 0.5), (2.0, 1.0, 0.25), (0, 1, 0.25)):
        x, y, (xx, yy) = grid(spacing=cell)
        pressure = 2e5 * np.exp(-((xx - 48 * MM) ** 2 + (yy - 3 * MM) ** 2) / (10 * MM) ** 2)
        gap = 5e-6 + 1e-4 * ((xx - 48 * MM) ** 2 + yy**2) / (20 * MM) ** 2
        reading = floor_sensor_reading(
            x,
            y,
            pressure,
            gap,
            inlet_diameter=inlet * MM,
            scan_spacing=spacing * MM,
            scans=round(90 / spacing),
            sampling_step=0.5 * MM,
            offsets=3,
        )
        errors.append(abs(reading.load.value / true - 1))
    assert errors[0] > errors[1] > errors[2] > errors[3]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.35)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.35)
    assert errors[3] < 1.5e-3
    assert reading.peak_pressure.value == pytest.approx(2e5, rel=0.01)


@pytest.mark.parametrize(("spacing", "low", "high"), [(10.0, 0.01, 0.02), (5.0, 0.21, 0.23)])
def test_coverage_counts_more_than_spacing(spacing, low, high):
    """Seven scans over exp(-(r / 20 mm)^2): 10 mm lose 1 to 2 %, 5 mm 22 %.

    Closed form: a coverage of 7 spacings keeps erf(3.5 spacing / 20 mm).
    """
    x, y, (xx, yy) = grid(160, 160, 1.0)
    pressure = 1e5 * np.exp(-((xx - 80 * MM) ** 2 + yy**2) / (20 * MM) ** 2)
    reading = floor_sensor_reading(
        x,
        y,
        pressure,
        np.full_like(pressure, 1e-3),
        inlet_diameter=0.0,
        scan_spacing=spacing * MM,
        offsets=21,
    )
    lost = 1 - reading.load.value / (1e5 * math.pi * (20 * MM) ** 2)
    assert low < lost < high
    assert lost == pytest.approx(1 - math.erf(3.5 * spacing / 20), abs=2e-3)
    assert reading.outermost_share > 0.02


def test_a_mirrored_film_reads_the_same():
    rng = np.random.default_rng(7)
    x, y, (xx, _) = grid(60, 60, 1.0)
    pressure = np.where(np.abs(xx - 30 * MM) < 20 * MM, rng.uniform(0, 1e5, xx.shape), 0.0)
    gap = rng.uniform(5e-6, 5e-4, xx.shape)
    one = floor_sensor_reading(x, y, pressure, gap)
    other = floor_sensor_reading(x, y, pressure[:, ::-1], gap[:, ::-1])
    assert other.load.value == pytest.approx(one.load.value, rel=1e-12)
    assert other.load.uncertainty == pytest.approx(one.load.uncertainty, rel=1e-9)
    assert other.peak_pressure.value == pytest.approx(one.peak_pressure.value, rel=1e-12)
    assert other.pressure == pytest.approx(one.pressure[:, ::-1], rel=1e-9)
    assert other.peak_position[1] == pytest.approx(-one.peak_position[1])


def test_position_of_the_peak():
    x, y, (xx, yy) = grid(60, 80, 0.5)
    pressure = 2e5 * np.exp(-((xx - 20 * MM) ** 2 + (yy - 10 * MM) ** 2) / (15 * MM) ** 2)
    reading = floor_sensor_reading(x, y, pressure, np.full_like(pressure, 1e-3))
    assert reading.peak_position == pytest.approx((20 * MM, 10 * MM), abs=0.7 * MM)


def test_a_pocket_over_channels_reads_next_to_nothing():
    """Lugs of 5 mm between channels of 2.4 mm: a 10 mm rim always meets a channel, a 4 mm not."""
    x, y, (xx, yy) = grid(60, 60, 0.4)
    lug = ((xx / MM) % 7.4 < 5.0) & ((np.abs(yy) / MM + 2.5) % 7.4 < 5.0)
    pressure, gap = np.where(lug, 2e5, 0.0), np.where(lug, 20e-6, 3e-3)
    wide = floor_sensor_reading(x, y, pressure, gap)
    narrow = floor_sensor_reading(
        x, y, pressure, gap, inlet_diameter=4 * MM, scan_spacing=1 * MM, scans=60
    )
    assert wide.peak_pressure.value < 0.01 * 2e5
    assert narrow.peak_pressure.value > 0.5 * 2e5
    assert wide.seen == 0.0
    assert 0.0 < narrow.seen < 0.3  # only where the whole rim lies on the lug


def test_reading_is_the_mean_of_points_on_the_rim():
    """SciPy's bilinear interpolation at each point of the rim, the cap beyond the grid."""
    x, y, (xx, _) = grid(30, 24, 1.0)
    rng = np.random.default_rng(3)
    pressure, gap = rng.uniform(0, 1e5, xx.shape), rng.uniform(1e-6, 6e-4, xx.shape)
    places, lanes = np.linspace(-5e-3, 35e-3, 30), np.linspace(-15e-3, 15e-3, 7)
    pocket = {"inlet_diameter": 7e-3, "gap_cap": 3e-4, "spacing": 1e-3}
    read, mean_cube = pocket_pressure(x, y, pressure, gap, places, lanes, **pocket)
    cubes, cap = np.minimum(gap, 3e-4) ** 3, 2.7e-11
    quarter = _rim_quarter(7e-3, 1e-3)
    flow, weight = np.zeros((2, places.size, lanes.size))
    for step in np.concatenate([quarter * signs for signs in ((1, 1), (1, -1), (-1, 1), (-1, -1))]):
        along, across = (places + step[0] - x[0]) / MM, (lanes + step[1] - y[0]) / MM
        at = np.meshgrid(along, across, indexing="ij")
        flow += map_coordinates(cubes * pressure, at, order=1, mode="constant")
        weight += map_coordinates(cubes, at, order=1, mode="constant", cval=cap)
    assert read == pytest.approx(flow / weight, rel=1e-9)
    assert mean_cube == pytest.approx(weight / (4 * len(quarter)), rel=1e-9)
    assert np.hypot(*quarter.T) == pytest.approx(3.5e-3)


def test_an_empty_film_reads_zero():
    x, y, (xx, _) = grid(20, 20, 1.0)
    reading = floor_sensor_reading(x, y, np.zeros_like(xx), np.zeros_like(xx))
    assert reading.load.value == 0.0
    assert reading.peak_pressure.value == 0.0
    assert reading.outermost_share == 0.0


def test_a_lagging_pocket_follows_a_step_and_a_ramp_as_it_should():
    rate, interval = 40.0, 2e-3
    time = interval * np.arange(80)
    ones = np.ones_like(time)
    assert lag_pressure(ones, rate * ones, interval) == pytest.approx(
        1 - np.exp(-rate * time), abs=1e-12
    )
    ramp = 5.0 * time
    exact = ramp - 5.0 / rate * (1 - np.exp(-rate * time))
    assert lag_pressure(ramp, rate * ones, interval) == pytest.approx(exact, abs=1e-12)
    assert lag_pressure(ramp, 1e9 * ones, interval) == pytest.approx(ramp, abs=1e-6)
    assert np.abs(lag_pressure(ramp, 0.0 * ones, interval)).max() < 1e-10


def test_a_compliant_instrument_loses_peak_and_keeps_load_in_an_even_film():
    """Patch of 40 mm in one gap: the pocket rises as 1 - exp(-K t / C) while it is over it."""
    x, y, (xx, yy) = grid(400)
    pressure = np.where((np.abs(xx - 320 * MM) < 20 * MM) & (np.abs(yy) < 20 * MM), 2e5, 0.0)
    gap, inlet, speed, viscosity = 50e-6, 2 * MM, 0.5, 0.219
    conductance = gap**3 * conductance_over_cube(inlet, viscosity)
    settings = {
        "inlet_diameter": inlet, "sampling_step": 0.25 * MM, "viscosity": viscosity, "speed": speed,
    }  # fmt: skip
    film = np.full_like(pressure, gap)
    at_once = floor_sensor_reading(x, y, pressure, film, **settings)
    for share in (0.25, 1.0):
        lag = share * 40 * MM / speed
        slow = floor_sensor_reading(x, y, pressure, film, compliance=lag * conductance, **settings)
        assert slow.peak_pressure.value == pytest.approx(2e5 * (1 - np.exp(-1 / share)), rel=0.02)
        assert slow.load.value == pytest.approx(at_once.load.value, rel=2e-2)
        # read after the patch has passed: the sensor meets the shoe's front first
        assert slow.peak_position[0] < 320 * MM - 15 * MM


@pytest.mark.parametrize("missing", ["inlet_diameter", "viscosity", "speed"])
def test_a_compliant_instrument_needs_fluid_speed_and_inlet(missing):
    x, y, (xx, _) = grid(20, 20, 1.0)
    settings = {"inlet_diameter": 4 * MM, "viscosity": 0.2, "speed": 0.7} | {missing: 0.0}
    with pytest.raises(InputError, match=missing):
        floor_sensor_reading(x, y, np.ones_like(xx), xx, compliance=1e-16, **settings)


@pytest.mark.parametrize("turned", ["x", "y", "both"])
def test_cell_centres_are_two_rows(turned):
    x, y, (xx, _) = grid(20, 20, 1.0)
    along, across = (
        row[:, None] if turned in (name, "both") else row for name, row in (("x", x), ("y", y))
    )
    with pytest.raises(InputError, match="at least 2 cell centres"):
        floor_sensor_reading(along, across, np.zeros_like(xx), np.ones_like(xx))
