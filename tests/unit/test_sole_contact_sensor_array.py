"""Sensors that stay in the floor: places, times, peaks, against what a moving patch must give."""

from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.compute import histories
from underfoot.compute.histories import Recorder
from underfoot.core import InputError
from underfoot.sole_contact import floor_sensor_reading
from underfoot.sole_contact.cost import refuse_too_large, solution_cost
from underfoot.sole_contact.reading import conductance_over_cube
from underfoot.sole_contact.sensor_array import SensorArray, array_reading

STEP = 1e-3
X = np.arange(61) * STEP
Y = (np.arange(61) - 30) * STEP
FILM = np.full((61, 61), 5e-5)


def patch(height=1e5, start=20e-3, end=40e-3, half=12e-3):
    inside = ((start < X) & (end > X))[:, None] & (np.abs(Y) < half)[None, :]
    return np.where(inside, height, 0.0)


def moved(array, pressures, way=0.2, **settings):
    count = len(pressures)
    return array_reading(
        X,
        Y,
        np.linspace(0, 0.2, count),
        np.linspace(0, way, count),
        pressures,
        [FILM] * count,
        array,
        **settings,
    )


def test_a_patch_passes_each_row_when_it_is_there():
    array = SensorArray(3, 1, 30e-3, 0.0, 60e-3)
    read = moved(array, [patch()] * 5, offsets=1)
    for row, place in enumerate(array.x):
        seen = read.time[read.pressure[:, row, 0] > 0.5e5]
        # at 1 m/s the patch is over a sensor from (place - end) to (place - start)
        assert seen[0] == pytest.approx(place - 40e-3, abs=2e-3)
        assert seen[-1] == pytest.approx(place - 20e-3, abs=2e-3)
    assert read.peak.value == pytest.approx(1e5, rel=1e-6)
    assert all(one.value == pytest.approx(1e5, rel=1e-6) for one in read.row_peaks)


def test_duration_and_peak_grow_in_time():
    array = SensorArray(1, 1, 30e-3, 4e-3, 100e-3)
    read = moved(array, [patch(height) for height in (0.0, 1e5, 2e5)], offsets=1)
    # over the sensor from 60 to 80 ms; the pressure then rises as 1e6 t
    assert read.duration.value == pytest.approx(20e-3, rel=0.35)
    assert 0.6e5 < read.peak.value < 0.82e5
    late = moved(array, [patch(height) for height in (0.0, 1e5, 2e5)], offsets=1, threshold=7.5e4)
    assert late.duration.value < 0.5 * read.duration.value


def test_a_compliant_array_lags_as_a_scan_does():
    array = SensorArray(1, 1, 30e-3, 1e-3, 100e-3)
    viscosity, lag = 0.219, 19e-3  # s, as long as the patch is over the sensor
    compliance = lag * 5e-5**3 * conductance_over_cube(1e-3, viscosity)
    read = moved(array, [patch()] * 5, offsets=1, compliance=compliance, viscosity=viscosity)
    assert read.peak.value == pytest.approx(1e5 * (1 - np.exp(-1)), rel=0.03)
    with pytest.raises(InputError, match="viscosity"):
        moved(array, [patch()] * 5, compliance=compliance)


def test_lateral_places_are_averaged():
    """A strip of half a spacing is met by a column at half of the lateral places."""
    strip = patch(half=7.5e-3)
    array = SensorArray(1, 3, 30e-3, 0.0, 100e-3)
    read = moved(array, [strip] * 3, offsets=31)
    assert read.peak.value == pytest.approx(0.5e5, rel=0.1)
    assert read.peak.uncertainty == pytest.approx(0.5e5, rel=0.1)


def test_a_sensor_of_the_array_reads_as_a_scan_does():
    pressure = 1e5 * np.exp(-((X[:, None] - 0.03) ** 2 + Y[None, :] ** 2) / 0.01**2)
    scan = floor_sensor_reading(X, Y, pressure, FILM, inlet_diameter=8e-3, scans=1, offsets=1)
    read = moved(SensorArray(1, 1, 30e-3, 8e-3, 100e-3), [pressure] * 2, offsets=1)
    assert read.peak.value == pytest.approx(scan.peak_pressure.value, rel=0.01)


def test_sensors_the_shoe_never_reaches_read_nothing():
    read = moved(SensorArray(2, 2, 30e-3, 4e-3, 1.0), [patch()] * 2)
    assert read.peak.value == 0.0
    assert read.duration.value == 0.0


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"rows": 0}, "array.rows"),
        ({"spacing": 0.0}, "array.spacing"),
        ({"inlet_diameter": -1e-3}, "array.inlet_diameter"),
        ({"position": float("nan")}, "array.position"),
    ],
)
def test_arrays_that_cannot_be_are_refused(change, where):
    given = {"rows": 3, "columns": 3, "spacing": 0.03, "inlet_diameter": 4e-3, "position": 0.0}
    with pytest.raises(InputError) as caught:
        SensorArray(**(given | change))
    assert caught.value.where == where


def test_time_must_rise():
    array = SensorArray(1, 1, 30e-3, 4e-3, 0.0)
    with pytest.raises(InputError, match="rise"):
        array_reading(X, Y, np.zeros(2), np.zeros(2), [FILM] * 2, [FILM] * 2, array)


def test_cost_is_refused_with_a_spacing_that_would_do():
    cost = solution_cost(36e-4, 5e-5)
    assert cost.memory > 6e9
    with pytest.raises(InputError, match="MB") as caught:
        refuse_too_large(cost, most_memory=2e9, where="numerics.grid_spacing", spacing=5e-5)
    assert "0.1" in caught.value.remedy
    refuse_too_large(
        solution_cost(36e-4, 0.11e-3), most_memory=2e9, where="grid_spacing", spacing=0.11e-3
    )


def test_an_array_without_a_place_lies_under_the_middle_of_the_sole_at_the_end(monkeypatch):
    x = np.linspace(0.02, 0.12, 51)
    inside = np.zeros((51, 3), bool)
    inside[5:46] = True  # 30 to 110 mm
    array = SimpleNamespace(position=None, rows=3, columns=2, spacing=0.01, inlet_diameter=1e-3)
    case = SimpleNamespace(sensor=SimpleNamespace(array=array, compliance=0.0))
    recorder = Recorder(case, None, SimpleNamespace(x=x, y=np.zeros(3), inside=inside), None)
    recorder.times, recorder.places = [0.0, 0.1], [0.0, 0.05]
    recorder.array_frames = [(np.zeros((51, 3)), np.zeros((51, 3)))] * 2
    monkeypatch.setattr(histories, "array_reading", lambda *given, **_: given[6])
    placed = recorder.array()
    middle_row = placed.position + placed.spacing * (placed.rows - 1) / 2
    assert middle_row == pytest.approx(0.05 + 0.07)
