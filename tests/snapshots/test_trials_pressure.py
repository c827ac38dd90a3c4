"""Pressure under a shoe, line by line and as a map: exact loads, and each caution by its limit."""

import math

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.trials.machines import pressure_map as maps
from underfoot.trials.machines.pressure_map import PressureScan, pressure_map, pressure_scan
from underfoot.trials.recording.axes import Axes
from underfoot.trials.recording.trial import Channel, Marker, Trial

RATE = 1000.0
AXES = Axes(np.array([0.0, 0.0, 1.0]), "given", np.array([1.0, 0.0, 0.0]), "given")
POSITION = np.array([0.5, 0.2, 0.0])


def slid(speed=0.3, wait=0.3, *, change=0.0, bump=5e3, width=0.02, rest=7.0, lost=0, rate=RATE,
         lateral=0.03, far=0.2, **more):  # fmt: skip
    """A shoe that waits and slides along x over a sensor; a bump of pressure 40 mm from its back.

    ``change``: of the speed over the slide, over its mean. Its marker is at the heel's back.
    """
    duration = wait + far / speed
    time = np.arange(round(duration * rate)) / rate
    on = np.maximum(time - wait, 0.0)
    whole = duration - wait
    way = speed * (on * (1 - change / 2) + change * on**2 / (2 * whole))
    x = POSITION[0] - 0.15 + way
    path = np.column_stack([x, np.full(len(x), POSITION[1] - lateral), np.full(len(x), 0.05)])
    along = POSITION[0] - x
    if lost:
        at = int(np.argmin(np.abs(along - 0.06)))
        path[at : at + lost] = np.nan
    pressure = rest + bump * np.exp(-(((along - 0.04) / width) ** 2))
    ahead = np.array([1.0, 0.0, 0.0])
    given = {"position": POSITION, "sliding": ahead, "axes": AXES, "back": -0.01, "front": 0.12}
    given |= more
    return pressure_scan(Trial("a"), Channel(pressure, "Pa", rate), Marker(path, rate), **given)


def told(scan):
    return [str(flag) for flag in scan.flags]


def test_a_scan_has_the_line_load_of_its_bump():
    """Integral of p0 exp(-(x/w)^2) is p0 w sqrt(pi); the shoe's places fall with time."""
    scan = slid()
    assert told(scan) == []
    assert scan.sample_load == pytest.approx(5e3 * 0.02 * math.sqrt(math.pi), rel=0.01)
    assert scan.pressure.max() == pytest.approx(5e3, rel=1e-3)
    assert scan.along[int(scan.pressure.argmax())] == pytest.approx(0.04, abs=5e-4)
    assert (np.diff(scan.along) < 0).all()
    assert scan.along[[0, -1]] == pytest.approx([0.12, -0.01], abs=5e-4)
    assert (scan.speed, scan.lateral) == pytest.approx((0.3, 0.03), rel=1e-3)
    assert scan.speed_change < 0.01
    moved = slid(heel_back=0.01, heel_middle=0.005)
    assert moved.along[int(moved.pressure.argmax())] == pytest.approx(0.03, abs=5e-4)
    assert moved.lateral == pytest.approx(0.025, abs=1e-4)
    own = slid(sliding=None)
    assert own.sample_load == pytest.approx(scan.sample_load, rel=1e-6)
    noisy = slid(rest=7.0)
    assert noisy.baseline_sd == pytest.approx(0.0, abs=0.5)


def test_cautions_of_a_scan():
    for change, odd in ((0.24, False), (0.4, True)):
        scan = slid(change=change)
        assert scan.speed_change == pytest.approx(change * 0.13 / 0.2, rel=0.12)
        assert (
            any("the speed varies" in one for one in told(scan)) == (scan.speed_change > 0.2) == odd
        )
    # 30 mm of slide before the front is 100 samples at 0.3 m/s
    for front, odd in ((0.122, True), (0.118, False)):
        scan = slid(wait=0.0, front=front)
        assert any("baseline of" in one for one in told(scan)) == odd
    for front, odd in ((0.159, False), (0.162, True)):
        scan = slid(front=front)
        assert any("scanned from" in one for one in told(scan)) == odd
    for back, odd in ((-0.058, False), (-0.062, True)):
        scan = slid(back=back)
        assert any("mm only" in one for one in told(scan)) == odd
    bridged = slid(lost=10)
    assert told(bridged) == ["10 frames of the marker were bridged"]
    assert bridged.sample_load == pytest.approx(slid().sample_load, rel=1e-3)


def test_scans_that_are_none():
    with pytest.raises(DataError, match="never passes"):
        slid(front=-0.06, back=-0.07)
    with pytest.raises(DataError, match="marker is lost"):
        slid(lost=110)
    slid(lost=95)
    with pytest.raises(DataError, match="hardly moves"):
        slid(far=0.019, sliding=None)
    with pytest.raises(DataError, match="pressure is in"):
        pressure_scan(
            Trial("a"), Channel(np.zeros(9), "N", RATE), Marker(np.zeros((9, 3)), RATE),
            position=POSITION, axes=AXES,
        )  # fmt: skip


def scan(lateral, peak=5e3, noise=1.0, flags=(), low=-0.01, high=0.12, width=0.02, count=434):
    along = np.linspace(high, low, count)
    pressure = peak * np.exp(-(((along - 0.04) / width) ** 2))
    load = float(np.sum(pressure) * (high - low) / (count - 1))
    return PressureScan(f"s{lateral:g}", along, pressure, lateral, 0.3, 0.0, noise, load, flags)


def sheet(gap=0.005, count=9, half=0.008, **more):
    """Scans across a bump that is as wide as it is long."""
    places = gap * (np.arange(count) - (count - 1) / 2)
    return [scan(y, 5e3 * math.exp(-((y / half) ** 2)), **more) for y in places]


def flags(made):
    return [str(flag) for flag in made.load.flags]


def test_a_map_carries_the_volume_of_its_pressure():
    made = pressure_map(sheet()[::-1])
    volume = 5e3 * 0.02 * math.sqrt(math.pi) * 0.008 * math.sqrt(math.pi)
    assert made.load.value == pytest.approx(volume, rel=2e-3)
    assert flags(made) == []
    assert (np.diff(made.lateral) > 0).all()
    assert (made.peak.value, made.peak_along.value, made.peak_lateral.value) == pytest.approx(
        (5e3, 0.04, 0.0), rel=1e-3, abs=4e-4
    )
    assert made.peak_lateral.uncertainty == pytest.approx(0.005 / math.sqrt(12))
    assert made.peak_along.uncertainty == 1e-3
    assert made.pressure.shape == (9, len(made.along))
    assert np.diff(made.along) == pytest.approx(1e-3)
    # noise of a sample, its width and its way, of so many samples
    one = 1.0 * (0.13 / 433) * math.sqrt(434) * 0.005
    assert made.load.uncertainty == pytest.approx(one * 3.0, rel=1e-6)
    assert made.half_spacing_change == pytest.approx(0.0, abs=0.06)
    assert "covered width" in made.load.conventions
    assert "40 mm" in str(made.load.conventions["covered width"])
    assert "8 mm" in str(made.load.conventions["hidden"])


def test_cautions_of_a_map():
    for share, odd in ((0.0195, False), (0.0205, True)):
        scans = [scan(0.0, 5e3), scan(0.01, 5e3), scan(0.02, 5e3)]
        rim = 15e3 * share / 2 / (1 - share)
        scans = [scan(-0.01, rim), *scans, scan(0.03, rim)]
        made = pressure_map(scans)
        assert made.outer_share == pytest.approx(share, rel=1e-6)
        assert any("outermost" in one for one in flags(made)) == odd
    for spacing, odd in ((0.00526, False), (0.00528, True), (0.00477, False), (0.00475, True)):
        made = pressure_map(sheet(), spacing=spacing)
        assert any("scans lie 5.0 mm apart" in one for one in flags(made)) == odd
        assert made.load.value == pytest.approx(pressure_map(sheet()).load.value * spacing / 0.005)
    for wide, odd in ((0.0074, False), (0.0076, True)):
        scans = [scan(0.0), scan(0.005), scan(0.01), scan(0.01 + wide)]
        assert any("one may be missing" in one for one in flags(pressure_map(scans))) == odd
    for peak, odd in ((4.9, True), (5.1, False)):
        made = pressure_map([scan(0.0, peak), scan(0.01, 1.0)])
        assert any("within the noise" in str(flag) for flag in made.peak.flags) == odd
    said = pressure_map([scan(0.0, flags=(maps._SATURATED,)), scan(0.01)])
    assert ["saturated" in str(flag) for flag in said.peak.flags] == [True]
    assert flags(said)[0] == "s0: the sensor is saturated: the peak is a lower bound"


def test_maps_that_are_none():
    with pytest.raises(DataError, match="1 scans are no map"):
        pressure_map([scan(0.0)])
    with pytest.raises(DataError, match="same place"):
        pressure_map([scan(0.0), scan(0.99e-4)])
    assert pressure_map([scan(0.0), scan(1.01e-4)]).half_spacing_change is None
    for wrong in ({"spacing": 0.0}, {"step": 0.0}):
        with pytest.raises(InputError):
            pressure_map(sheet(), **wrong)


def test_what_every_second_scan_would_have_told():
    lateral, loads = 0.01 * np.arange(5), np.array([1.0, 2.0, 4.0, 2.0, 1.0])
    whole = 0.01 * loads.sum()
    found = maps._half_spacing(lateral, loads, whole)
    halves = 0.02 * np.array([6.0, 4.0])
    assert found == pytest.approx(np.abs(halves / whole - 1).max())
    assert maps._half_spacing(lateral[:4], loads[:4], 1.0) is None
    assert maps._half_spacing(lateral, loads, 0.0) is None
    assert maps._widths(np.array([1.0, 3.0])) == pytest.approx([1.0, 2.0, 3.0])


def test_what_an_inlet_takes_off_a_peak():
    grid = np.arange(-0.01, 0.12, 1e-3)
    bend = 4e6
    line = np.array([5e3 - 0.5 * bend * (grid - 0.04) ** 2])
    lost = maps._inlet_loss(line, 0, grid, 0.04, 6e-3)
    assert lost == pytest.approx(2 * bend * 6e-3**2 / 32)
    assert maps._inlet_loss(-line, 0, grid, 0.04, 6e-3) == 0.0
    assert maps._inlet_loss(line, 0, grid, 0.04, 2.9e-3) is None
    assert maps._inlet_loss(line, 0, grid, 0.04, 4.1e-3) is not None
    line[0, 3] = np.nan
    assert maps._inlet_loss(line, 0, grid, 0.04, 6e-3) is None
    made = pressure_map(sheet(), inlet_diameter=6e-3)
    assert "6 mm wide" in str(made.peak.conventions["inlet"])


def test_a_map_knows_nothing_where_a_scan_did_not_reach():
    made = pressure_map([scan(0.0), scan(0.01, low=0.02, high=0.1, count=267)])
    known = np.isfinite(made.pressure[1])
    assert made.along[known].min() == pytest.approx(0.019, abs=1e-3)
    assert made.along[known].max() == pytest.approx(0.101, abs=1e-3)
    assert np.isfinite(made.pressure[0]).all()
