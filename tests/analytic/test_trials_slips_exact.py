"""Slips, pressures and friction windows against motions whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.trials import (
    Channel,
    LowPass,
    Marker,
    Plate,
    PulseDefinition,
    SlipDefinition,
    Trial,
    available_friction,
    available_frictions,
    contact_from_heel,
    heel_motion,
    heel_track,
    low_passed,
    mean_friction,
    passages,
    pressure_pulse,
    sensor_array_reading,
    sensor_rows,
    slip,
)

UP = np.array([0.0, 0.0, 1.0])
WALK = np.array([0.0, 1.0, 0.0])
CONTACT = 0.5


def slipping_heel(rate=250.0, peak=1.2, noise=0.0, seed=1, start_delay=0.03):
    """A heel that comes down at 1.5 m/s, nearly stops 30 ms later, slides and stops.

    Speed: linear to 0.15 m/s at slip start, half sine of 0.4 s up to ``peak``, then 0.1 m/s.
    Returns the marker, the slip start (s) and the distance of the slide (m).
    """
    time = np.arange(0.0, 2.0, 1e-4)
    start, length = CONTACT + start_delay, 0.4
    speed = np.where(time < CONTACT, 1.5, 0.15)
    ramp = (time >= CONTACT) & (time < start)
    speed[ramp] = 1.5 + (0.15 - 1.5) * (time[ramp] - CONTACT) / start_delay
    slide = (time >= start) & (time < start + length)
    speed[slide] = 0.15 + (peak - 0.15) * np.sin(np.pi * (time[slide] - start) / length)
    settle = time >= start + length
    speed[settle] = 0.15 + 0.2 * (1.0 - np.cos(4.0 * (time[settle] - start - length))) / 2.0
    place = np.concatenate(([0.0], np.cumsum((speed[1:] + speed[:-1]) * 0.5e-4)))
    frames = np.arange(0.0, 2.0, 1.0 / rate)
    along = np.interp(frames, time, place)
    height = 0.03 + 0.08 * np.clip((CONTACT - frames) / CONTACT, 0.0, None)
    path = np.column_stack((np.full(len(frames), 0.2), along, height))
    path += np.random.default_rng(seed).normal(0.0, noise, path.shape)
    distance = float(np.interp(start + length, time, place) - np.interp(start, time, place))
    return Marker(path, rate), start, distance


@pytest.mark.parametrize("rate", [100.0, 250.0, 1000.0])
@pytest.mark.parametrize("noise", [0.0, 3e-4])
@pytest.mark.parametrize("derivative", ["differences", "savitzky-golay"])
def test_peak_speed_within_3_percent_and_start_within_25_ms(rate, noise, derivative):
    """The bounds are those of the note on marker filters: 0.3 mm noise, 10 Hz."""
    for seed in range(5):
        marker, start, distance = slipping_heel(rate, noise=noise, seed=seed)
        definition = SlipDefinition(derivative=derivative)
        found = slip(marker, CONTACT, up=UP, walking=WALK, definition=definition)
        assert found.peak_speed.value == pytest.approx(1.2, rel=0.03)
        late = 0.025 if derivative == "differences" else 0.03
        assert found.start.value == pytest.approx(start, abs=late)
        assert found.distance.value == pytest.approx(distance, rel=0.06)
        assert found.slipped
        assert found.margin.value == pytest.approx(1.0, abs=0.04)
        assert found.peak_speed.conventions["search ends"] == "second local minimum"


@pytest.mark.parametrize("delay", [0.002, 0.01, 0.06])
def test_a_heel_that_slips_at_once_or_late(delay):
    """A stop within 2 ms is the worst that a 10 Hz filter can meet: 34 ms late."""
    for seed in range(10):
        marker, start, _ = slipping_heel(200.0, noise=3e-4, seed=seed, start_delay=delay)
        found = slip(marker, CONTACT, up=UP, walking=WALK)
        assert found.peak_speed.value == pytest.approx(1.2, rel=0.03)
        assert found.start.value == pytest.approx(start, abs=0.035)
        assert found.slipped


@pytest.mark.parametrize("start", [-0.004, 0.0, 0.004, 0.01])
def test_a_minimum_that_smoothing_moves_before_contact_is_not_lost(start):
    """Soft approach (half cosine of 0.3 s), fast slip (0.1 s): the minimum moves early."""
    rate = 200.0
    time = np.arange(0.0, 1.5, 1e-4)
    begin = CONTACT + start
    speed = np.where(time < begin, 2.0, 0.02)
    down = (time > begin - 0.3) & (time <= begin)
    speed[down] = 1.01 + 0.99 * np.cos(np.pi * (time[down] - begin + 0.3) / 0.3)
    slide = (time > begin) & (time < begin + 0.3)
    up = slide & (time < begin + 0.1)
    speed[slide] = 1.01 + 0.99 * np.cos(np.pi * (time[slide] - begin - 0.1) / 0.2)
    speed[up] = 1.01 - 0.99 * np.cos(np.pi * (time[up] - begin) / 0.1)
    speed[time >= begin + 0.3] += 0.1 * (time[time >= begin + 0.3] - begin - 0.3)
    place = np.cumsum(speed) * 1e-4
    frames = np.arange(0.0, 1.5, 1.0 / rate)
    path = np.column_stack(
        (np.zeros(len(frames)), np.interp(frames, time, place), np.full(len(frames), 0.03))
    )
    for seed in range(5):
        noise = np.random.default_rng(seed).normal(0.0, 3e-4, path.shape)
        found = slip(Marker(path + noise, rate), CONTACT, up=UP, walking=WALK)
        assert found.peak_speed.value == pytest.approx(2.0, rel=0.03)
        assert found.start.value == pytest.approx(begin, abs=0.025)


def test_speed_noise_is_what_scatter_shows():
    rate, sd = 250.0, 3e-4
    still = np.zeros((5000, 3))
    still += np.random.default_rng(3).normal(0.0, sd, still.shape)
    motion = heel_motion(Marker(still, rate), UP)
    assert motion.noise == pytest.approx(sd, rel=0.1)
    assert motion.velocity[100:-100, 0].std() == pytest.approx(motion.speed_noise, rel=0.15)


def test_three_dimensions_see_the_heel_lift():
    marker, *_ = slipping_heel()
    flat = heel_motion(marker, UP).speed
    full = heel_motion(marker, UP, SlipDefinition(plane="3d")).speed
    assert (full >= flat - 1e-12).all()
    assert full[50] == pytest.approx(np.hypot(1.5, 0.16), rel=1e-3)  # 0.08 m in 0.5 s


def test_a_small_motion_is_no_slip_and_has_its_margin():
    marker, _, distance = slipping_heel(peak=0.19)
    found = slip(marker, CONTACT, up=UP, walking=WALK)
    assert found.slipped is False
    assert -0.05 < found.margin.value < 0.0
    assert found.distance.value == pytest.approx(distance, rel=0.15)


@pytest.mark.parametrize("gap", [(120, 135), (124, 170), (0, 200)])
def test_missing_markers(gap):
    marker, *_ = slipping_heel(250.0)
    marker.positions[slice(*gap)] = np.nan
    found = slip(marker, CONTACT, up=UP)
    if gap == (120, 135):  # 60 ms are bridged
        assert found.peak_speed.estimated
        assert any("bridged" in flag.message for flag in found.peak_speed.flags)
    else:
        assert found.slipped is None
        assert "missing" in found.peak_speed.reason or "outside" in found.peak_speed.reason


def test_no_marker_and_no_contact():
    marker, *_ = slipping_heel()
    assert "no heel marker" in slip(None, 0.5, up=UP).start.reason
    assert "outside" in slip(marker, 5.0, up=UP).start.reason


def test_leaving_the_plate_ends_the_search():
    marker, start, _ = slipping_heel()
    found = slip(marker, CONTACT, up=UP, leaves=start + 0.15)
    assert found.peak_speed.conventions["search ends"] == "the foot leaves the plate"
    assert found.peak_speed.value < 1.2
    assert any("still grows" in flag.message for flag in found.peak_speed.flags)


def test_contact_from_the_heel_alone():
    marker, *_ = slipping_heel()
    path = marker.positions.copy()
    rise = np.clip(np.arange(len(path)) / marker.rate - 1.2, 0.0, None)
    path[:, 2] += 0.2 * rise
    found = contact_from_heel(Marker(path, marker.rate), UP)
    assert found == pytest.approx([CONTACT], abs=0.04)  # a sharp stop, blurred by 10 Hz


SENSORS = {
    f"P{row}{column}": (0.2 + 0.03 * (column - 2), 0.85 + 0.03 * (row - 1), 0.0)
    for row in (1, 2, 3)
    for column in (1, 2, 3)
}


def test_passages_of_a_uniform_motion_are_exact():
    time = np.arange(0.0, 2.0, 0.01)
    path = np.column_stack((0.205 + 0.01 * time, 0.7 * time, np.full(len(time), 0.03)))
    motion = heel_motion(Marker(path, 100.0), UP)
    found = passages(motion, SENSORS, up=UP, walking=WALK, contact=0.5, until=1.9)
    for one in found:
        x, y, _ = SENSORS[one.sensor]
        assert one.row == int(one.sensor[1])
        assert one.time == pytest.approx(y / 0.7, abs=1e-6)
        assert one.speed.value == pytest.approx(np.hypot(0.7, 0.01), rel=1e-4)
        # across = up x walking = -x: left of a walker along +y
        assert one.lateral.value == pytest.approx(x - 0.205 - 0.01 * y / 0.7, abs=1e-6)
    early = passages(motion, SENSORS, up=UP, walking=WALK, contact=0.5, until=1.23)
    assert {one.sensor[1] for one in early if one.speed.estimated} == {"1"}
    assert "stops" in next(one for one in early if one.sensor == "P31").speed.reason
    late = passages(motion, SENSORS, up=UP, walking=WALK, contact=1.24, until=1.9)
    assert "beyond" in next(one for one in late if one.sensor == "P12").lateral.reason
    track, crossed = heel_track(motion, SENSORS, up=UP, walking=WALK, contact=0.5, until=1.9)
    assert crossed
    assert track[0] == pytest.approx([0.35 - 0.88, -(0.205 + 0.005 - 0.2)], abs=1e-6)
    assert not heel_track(motion, SENSORS, up=UP, walking=WALK, contact=0.5, until=1.1)[1]


def test_an_array_reading_joins_pressures_and_passages():
    marker, *_ = slipping_heel(noise=2e-4)
    found = slip(marker, CONTACT, up=UP, walking=WALK)
    channels = {name: _pressure(contact=CONTACT + 0.05, peak=0.0) for name in SENSORS}
    channels["P22"] = _pressure(contact=CONTACT + 0.05)
    trial = Trial("slip", channels=channels)
    reading = sensor_array_reading(trial, found, SENSORS, up=UP, walking=WALK)
    assert reading.peak_sensor == "P22"
    assert reading.peak.value == pytest.approx(124e3, rel=0.02)
    assert reading.crossed
    one = reading.passages["P22"]
    truth = np.interp(one.time, found.motion.time, found.motion.speed)
    assert one.speed.value == pytest.approx(truth, rel=0.01)
    assert one.lateral.value == pytest.approx(0.0, abs=1e-3)
    with pytest.raises(DataError, match="no channel named Q"):
        sensor_array_reading(trial, found, {"Q": (0.0, 0.0, 0.0)}, up=UP, walking=WALK)


def test_rows_follow_the_walk():
    assert sensor_rows(SENSORS, -WALK)["P12"] == 3
    assert sensor_rows({"only": (0.0, 0.0, 0.0)}, WALK) == {"only": 1}


def _pressure(samples=3000, rate=1000.0, peak=124e3, sd=240.0, contact=1.0, seed=0):
    values = np.random.default_rng(seed).normal(500.0, sd, samples)
    time = np.arange(samples) / rate
    pulse = (time > contact + 0.1) & (time < contact + 0.175)
    values[pulse] += peak * np.sin(np.pi * (time[pulse] - contact - 0.1) / 0.075)
    return Channel(values, "Pa", rate)


def test_pressure_pulse_has_its_peak_and_duration():
    """The report's mean slip: 124 kPa, 75 ms, baseline standard deviation 0.24 kPa (G.5)."""
    found = pressure_pulse("P1", _pressure(), 1.0)
    assert found.peak.value == pytest.approx(124e3, rel=0.01)
    # a half sine of 124 kPa is above 5 x 0.24 kPa for all but 0.5 ms of its 75 ms
    assert found.duration.value == pytest.approx(0.075, abs=0.003)
    assert found.baseline == pytest.approx(500.0, abs=30.0)
    assert found.peak.flags == ()


def test_empty_records_seldom_alarm():
    """With 950 baseline samples at most 0.1 % of 2 s records pass 5 sd; three in a row: none."""
    alarms = 0
    for seed in range(200):
        found = pressure_pulse("P1", _pressure(peak=0.0, seed=seed), 1.0)
        alarms += found.duration.estimated
        assert "within the noise" in found.peak.flags[-1].message or found.duration.estimated
    assert alarms == 0


def test_short_baselines_are_flagged_or_refused():
    few = pressure_pulse("P1", _pressure(contact=0.2), 0.2)
    assert "151 samples" in few.peak.flags[0].message
    none = pressure_pulse("P1", _pressure(contact=0.06), 0.06)
    assert "no baseline" in none.peak.reason
    wrong = Channel(np.zeros(2000), "V", 1000.0)
    assert "not a pressure" in pressure_pulse("P1", wrong, 1.0).peak.reason
    single = _pressure(peak=0.0)
    single.values[1500] += 50e3
    assert not pressure_pulse("P1", single, 1.0).duration.estimated
    assert pressure_pulse(
        "P1", single, 1.0, definition=PulseDefinition(run=1)
    ).duration.value == pytest.approx(0.0)


def _slide(friction=0.18, target=250.0, rate=1000.0):
    time = np.arange(0.0, 1.0, 1.0 / rate)
    normal = np.clip((time - 0.3) / 0.2, 0.0, 1.0) * (target + 5.0)
    angle = 0.4
    shear = friction * normal
    force = np.column_stack((shear * np.sin(angle), -shear * np.cos(angle), normal))
    return Plate("plate 1", force, rate)


def test_available_friction_is_the_resultant_over_the_normal():
    for one, window in zip(
        available_frictions(_slide(), target=250.0), (2, 50, 100, 200), strict=True
    ):
        assert one.value == pytest.approx(0.18, rel=1e-9)
        assert one.n == window
        assert f"{window} ms" in one.conventions["window"]
    late = available_friction(_slide(), target=250.0, window=0.9)
    assert "ends inside the window" in late.reason
    assert "not 400 N" in available_friction(_slide(), target=400.0).reason
    bad = Plate("p", np.empty((0, 3)), 1000.0, problem="no channels")
    assert available_friction(bad, target=250.0).reason == "no channels"


def test_the_standard_error_knows_about_correlation():
    """AR(1) noise: the scatter of means over many runs against the stated uncertainty."""
    random = np.random.default_rng(5)
    means, stated = [], []
    for _ in range(300):
        noise = np.zeros(200)
        for i in range(1, 200):
            noise[i] = 0.8 * noise[i - 1] + random.normal(0.0, 0.005)
        one = mean_friction(np.full(200, 300.0), 300.0 * (0.2 + noise), 1000.0, target=250.0)
        means.append(one.value)
        stated.append(one.uncertainty)
    assert np.mean(stated) == pytest.approx(np.std(means), rel=0.2)


@pytest.mark.parametrize(
    ("kind", "power"),
    [
        ("butterworth-4-zero-phase", 0.5),  # two passes: half the amplitude at the cutoff
        ("butterworth-4-zero-phase-corrected", np.sqrt(0.5)),
        ("butterworth-8-zero-phase", 0.5),
        ("butterworth-4-one-pass", np.sqrt(0.5)),
        ("none", 1.0),
    ],
)
def test_filters_have_the_gain_their_name_says(kind, power):
    time = np.arange(0.0, 4.0, 1e-3)
    wave = np.sin(2 * np.pi * 36.0 * time)
    passed = low_passed(wave, 1000.0, LowPass(kind))[1000:3000]
    assert passed.max() == pytest.approx(power, rel=0.01)
    np.testing.assert_allclose(low_passed(np.full(200, 7.0), 1000.0, LowPass(kind)), 7.0)


def test_filters_refuse_what_they_cannot_do():
    with pytest.raises(InputError, match="too high"):
        low_passed(np.zeros(100), 60.0, LowPass())
    with pytest.raises(DataError, match="without a number"):
        low_passed(np.array([0.0, np.nan] * 40), 1000.0, LowPass())
    with pytest.raises(InputError, match='Did you mean "butterworth-4-one-pass"'):
        LowPass("butterworth-4-onepass")
    with pytest.raises(InputError):
        LowPass(cutoff=0.0)
