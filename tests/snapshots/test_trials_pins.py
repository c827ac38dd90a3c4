"""Pins on disks: zeros, strokes, rests and steady windows, each limit just below and just above."""

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.trials.machines import pin_on_disk as pins
from underfoot.trials.machines.pin_on_disk import (
    correlated_error,
    friction_point,
    reduced_radius,
    steady_window,
)
from underfoot.trials.recording.trial import Channel, Trial

RATE = 100.0


def flags(point):
    return [str(flag) for flag in point.cof.flags]


def trial(load, push, **more):
    channels = {
        "normal force": Channel(load, "N", RATE),
        "friction force": Channel(push, "N", RATE),
    }
    return Trial("a", channels | {name: Channel(v, "1", RATE) for name, v in more.items()})


NOISE = np.random.default_rng(1).normal(size=2000)


def test_a_steady_window_is_all_but_its_run_in():
    flat = 0.3 + 0.001 * NOISE[:500]
    assert steady_window(flat).start < 100
    assert steady_window(flat).steady
    run_in = flat.copy()
    run_in[:100] += 0.2
    found = steady_window(run_in)
    assert (found.start, found.stop, found.steady) == (100, 500, True)
    late = flat.copy()
    late[:251] += 0.2
    assert (steady_window(late).start, steady_window(late).steady) == (250, False)
    drifts = []
    for slope in np.linspace(0.0, 3.0, 61):
        x = np.linspace(-0.5, 0.5, 400)
        values = 0.3 + 0.001 * (NOISE[:400] + slope * x)
        made = steady_window(values)
        window = values[made.start :]
        x = np.linspace(-0.5, 0.5, len(window))
        line = np.polyfit(x, window, 1)
        assert made.drift == pytest.approx(abs(line[0]) / np.std(window - np.polyval(line, x)))
        assert made.steady == (made.start < 200 and made.drift <= 2.0)
        drifts.append((made.steady, made.drift))
    assert {steady for steady, _ in drifts} == {True, False}
    assert steady_window(np.full(50, 0.3)).drift == 0.0
    for wrong in (flat[:49], np.append(flat, np.nan)):
        with pytest.raises(DataError):
            steady_window(wrong)


def test_the_error_of_a_correlated_signal_is_that_of_its_batches():
    values = NOISE[:200]
    means = values.reshape(20, 10).mean(axis=1)
    assert correlated_error(values) == pytest.approx(means.std(ddof=1) / 20**0.5)
    four = NOISE[:43]
    assert correlated_error(four) == pytest.approx(
        four[:40].reshape(4, 10).mean(axis=1).std(ddof=1) / 2
    )
    assert correlated_error(NOISE[:39]) is None
    long = NOISE[:1015]
    assert correlated_error(long) == pytest.approx(
        long[:1000].reshape(20, 50).mean(axis=1).std(ddof=1) / 20**0.5
    )


def test_the_radius_of_a_parabola():
    x = np.linspace(-0.01, 0.02, 30)
    for sign in (1.0, -1.0):
        found = reduced_radius(x, sign * (5.0 * (x - 0.003) ** 2 + 0.2 * x + 0.1))
        assert found.radius == pytest.approx(0.1)
    reduced_radius(x[:10], 5.0 * x[:10] ** 2)
    with pytest.raises(DataError, match="ten complete points"):
        reduced_radius(x[:9], 5.0 * x[:9] ** 2)
    noise = 1e-4 * NOISE[:30]
    made = reduced_radius(x, 5.0 * x**2 + noise)
    # the curvature's error by the normal equations
    matrix = np.column_stack([np.ones(30), x, x**2])
    fit, residual = np.linalg.lstsq(matrix, 5.0 * x**2 + noise, rcond=None)[:2]
    error = np.sqrt(np.linalg.inv(matrix.T @ matrix)[2, 2] * residual[0] / 27)
    assert made.radius == pytest.approx(1 / (2 * fit[2]), rel=1e-6)
    assert made.standard_error == pytest.approx(made.radius * error / fit[2], rel=1e-6)
    for share, fits in ((2.1, True), (1.9, False)):
        line = share * error * x**2 + noise - matrix @ np.linalg.lstsq(matrix, noise, rcond=None)[0]
        if fits:
            reduced_radius(x, line)
        else:
            with pytest.raises(DataError, match="no curvature"):
                reduced_radius(x, line)


def loaded(count=1000, load=50.0, cof=0.3, before=0, zero=(0.0, 0.0), noise=0.0):
    """A run under a load, with so many samples before it in which the pin is off the disk."""
    on = np.where(np.arange(count) < before, 0.0, 1.0)
    return (zero[0] + load * on + noise * NOISE[:count],
            zero[1] + cof * load * on + noise * NOISE[::-1][:count])  # fmt: skip


def test_forces_count_from_the_unloaded_pin():
    plain = friction_point(trial(*loaded()))
    assert (plain.cof.value, plain.normal, plain.shear) == pytest.approx((0.3, 50.0, 15.0))
    shifted = friction_point(trial(*loaded(before=200, zero=(2.0, -3.0))))
    assert (shifted.cof.value, shifted.normal) == pytest.approx((0.3, 50.0))
    assert "-3" in str(shifted.cof.conventions["zero"]).replace("−", "-")
    for samples, known in ((50, True), (49, False)):  # half a second and 30 samples
        found = friction_point(trial(*loaded(before=samples)))
        assert ("zero" in found.cof.conventions) == known
    for samples, known in ((30, True), (29, False)):
        channels = {"normal force": Channel(loaded(before=samples)[0], "N", 10.0),
                    "friction force": Channel(loaded(before=samples)[1], "N", 10.0)}  # fmt: skip
        assert ("zero" in friction_point(Trial("a", channels)).cof.conventions) == known
    # an unloaded level is nearer to nothing than 0.4 of the load
    assert pins._unloaded_stretches(np.where(np.arange(1000) < 200, 19.9, 50.0), RATE)
    assert not pins._unloaded_stretches(np.where(np.arange(1000) < 200, 20.1, 50.0), RATE)
    assert not pins._unloaded_stretches(np.where(np.arange(119) < 60, 0.0, 50.0), RATE)
    assert pins._unloaded_stretches(np.where(np.arange(120) < 60, 0.0, 50.0), RATE) == [(0, 60)]
    for noise, known in ((4.5, True), (5.5, False)):  # ten robust deviations
        load = np.where(np.arange(1000) < 300, 0.0, 50.0)
        load[300:] += noise * np.tile([1.0, -1.0], 350) / 1.4826 * 1.0
        assert bool(pins._unloaded_stretches(load, RATE)) == known


def test_zeros_go_from_one_rest_to_the_next():
    time = np.arange(1000) / RATE
    values = np.zeros(1000)
    values[:100], values[900:] = 2.0, 4.0
    values[:20] = values[80:100] = 99.0  # where the pin touches and leaves
    line, error = pins._zero_line(values, time, [(0, 100), (900, 1000)])
    assert line[[50, 950]] == pytest.approx([2.0, 4.0], abs=0.03)
    assert line[500] == pytest.approx(3.0, abs=0.02)
    assert error == pytest.approx(2.0 / np.sqrt(12))
    values[:] = np.nan
    line, error = pins._zero_line(values, time, [(0, 100)])
    assert (line.max(), error) == (0.0, 0.0)


def test_samples_with_hardly_any_load():
    load, push = loaded()
    for share, lost in ((0.101, 0), (0.099, 20)):
        light = load.copy()
        light[400:420] = share * 50
        found = friction_point(trial(light, push))
        told = [one for one in flags(found) if "hardly any load" in one]
        assert bool(told) == bool(lost)
        if told:
            assert told[0].startswith(f"{lost} samples")
            assert found.cof.value == pytest.approx(0.3)
    with pytest.raises(DataError, match="normal force is zero"):
        friction_point(trial(0 * load, push))


def strokes(count=12, length=80, push=15.0, middle=0.0, rest=0.0, turn=6):
    """A pin that goes to and fro; near its turns the friction changes evenly."""
    one = np.full(length, push)
    ramp = np.linspace(-1, 1, turn)
    values = []
    for n in range(count):
        sign = 1 if n % 2 == 0 else -1
        values += [sign * one, sign * push * -ramp]
    out = np.concatenate(values) + middle
    return out + rest * NOISE[: len(out)]


def test_the_middle_half_of_strokes_counts():
    push = strokes()
    sliding, middle = pins._strokes(push, zeroed=False)
    assert middle == pytest.approx(0.0, abs=1e-9)
    # of the eleven strokes between twelve turns the middle half
    assert sliding.sum() == 11 * 43
    assert np.abs(push[sliding]).min() == 15.0
    shifted, middle = pins._strokes(push + 5.0, zeroed=False)
    assert middle == pytest.approx(5.0)
    assert np.array_equal(shifted, sliding)
    found = friction_point(trial(np.full(len(push), 50.0), push + 5.0))
    assert found.cof.value == pytest.approx(0.3)
    assert str(found.cof.conventions["strokes"]) == str(pins._STROKES)
    # a zero that is known leaves a middle up to half of the friction
    assert pins._strokes(push + 7.4, zeroed=True) is not None
    assert pins._strokes(push + 7.6, zeroed=True) is None
    # without one a level at nothing is a rest
    assert pins._strokes(push + 13.4, zeroed=False) is not None
    few = strokes(count=3)
    assert pins._strokes(few, zeroed=False) is None
    assert pins._strokes(strokes(count=4), zeroed=False) is not None
    assert pins._strokes(np.full(39, 1.0), zeroed=False) is None
    assert pins._strokes(np.full(400, 15.0), zeroed=False) is None


def test_strokes_between_rests():
    def rests(share, count=8, deep=0.0):
        stroke, rest = round(100 * (1 - share)), round(100 * share)
        return np.tile(np.concatenate([np.full(stroke, 15.0), np.full(rest, deep)]), count)

    for share, found in ((0.2, True), (0.44, True), (0.46, False)):
        assert (pins._strokes(rests(share), zeroed=True) is not None) == found, share
    for deep, found in ((4.4, True), (4.6, False)):
        assert (pins._strokes(rests(0.2, deep=deep), zeroed=True) is not None) == found
    assert pins._strokes(rests(0.2, 3), zeroed=True) is None
    assert pins._strokes(rests(0.2, 4), zeroed=True) is not None


def test_turns_that_come_evenly():
    assert pins._even(np.array([0, 100, 200, 300]))
    assert not pins._even(np.array([0, 100, 200]))
    for gap, even in ((1.19, True), (1.25, False)):
        gaps = 100 * np.array([gap, 2 - gap, gap, 2 - gap])
        assert pins._even(np.concatenate([[0], gaps.cumsum()])) == (gaps.std() < 21.0) == even
    values = np.array([1.0, 0.2, -0.2, -1.0, -0.3, 0.2, 1.0, 1.0, -1.0])
    assert pins._changes(values, 0.5).tolist() == [1, 4, 7]
    assert pins._changes(values, 0.1).tolist() == [1, 4, 7]


def test_a_log_that_holds_another_cof():
    load, push = loaded()
    used = np.arange(100, 900)
    for factor, differs in ((1.0, False), (0.91, False), (0.89, True), (1.1, False), (1.12, True)):
        logged = np.full(1000, 0.3 * factor)
        found = pins._other_cof(trial(load, push, COF=logged), used)
        assert (found is not None) == differs, factor
        if found:
            assert found == pytest.approx((0.3 * factor, 0.3))
    assert pins._other_cof(trial(load, push, COF=np.full(899, 9.0)), used) is None
    assert pins._other_cof(trial(load, push, COF=np.full(900, 9.0)), used) is not None
    assert pins._other_cof(trial(load, push), used) is None


def test_speeds_of_a_log():
    channels = {"sliding speed": Channel(np.linspace(-1, 1, 100), "m/s", RATE)}
    assert pins._mean_speed(Trial("a", channels), np.arange(100)) == pytest.approx(0.505, abs=1e-3)
    assert pins._mean_speed(Trial("a", channels), np.arange(50, 300)) == pytest.approx(
        0.505, abs=1e-3
    )
    assert pins._mean_speed(Trial("a", channels), np.arange(100, 300)) is None
    turns = {"sliding speed": Channel(np.ones(100), "rpm", RATE)}
    assert pins._mean_speed(Trial("a", turns), np.arange(100)) is None
