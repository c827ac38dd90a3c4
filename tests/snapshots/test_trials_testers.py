"""Checks of a slip tester's log: what each measures and its limit, just below and just above."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.trials.machines import tester_checks as check
from underfoot.trials.machines.tester_checks import log_kind, scan_flags, slide_flags
from underfoot.trials.recording.measurement import Flag

UP, RATE, LOAD, COF = np.array([0.0, 0.0, 1.0]), 1000.0, 500.0, 0.3
NOISE = np.random.default_rng(5).normal(size=(3000, 3))
TIME = np.arange(3000) / RATE
LOADED = (TIME >= 1.0) & (TIME < 2.0)


def log(normal=None, along=None, noise=1.0, change=None):
    """Forces of a slide of 1 s between two rests: 500 N and a COF of 0.3."""
    normal = LOAD * LOADED if normal is None else normal
    along = COF * normal if along is None else along
    force = np.column_stack([along, 0 * along, normal]) + noise * NOISE
    if change:
        change(force)
    return force


def flags(force=None, *, speed=None, onset=1.0, window=(1.3, 1.9), record=None, cof=None, **more):
    force = log(**more) if force is None else force
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = force[:, 0] / force[:, 2]
    inside = (window[0] <= TIME) & (window[1] >= TIME)
    slide: Any = SimpleNamespace(
        time=TIME, normal=force[:, 2], window=window, ratio=ratio, onset=onset, speed=speed,
        cof=SimpleNamespace(value=float(np.nanmean(ratio[inside])) if cof is None else cof),
    )  # fmt: skip
    plate: Any = SimpleNamespace(force=force, rate=RATE, flags=())
    return {flag.name: flag for flag in slide_flags(slide, plate, UP, record)}


def test_a_plain_slide_has_no_flag():
    assert flags() == {}


def test_flags_of_the_plate_go_before_and_saturation_is_judged_here():
    def of(*given, force=None):
        force = log() if force is None else force
        slide: Any = SimpleNamespace(
            time=TIME, normal=force[:, 2], window=(1.3, 1.3045), ratio=TIME, onset=1.0, speed=None,
            cof=SimpleNamespace(value=0.3),
        )  # fmt: skip
        plate: Any = SimpleNamespace(force=force, rate=RATE, flags=given)
        return [str(flag) for flag in slide_flags(slide, plate, UP)]

    words = "5 samples in the window: are clock and rate right?"
    told = Flag("a", "told", False), Flag("saturated", "full"), Flag("b", "doubtful")
    assert of(*told) == ["doubtful", words]
    lost = log()
    lost[7, 2] = np.nan
    assert of(*told, force=lost) == ["doubtful"]
    assert flags(window=(1.3, 1.3085))["rate"].measured == 9
    assert "rate" not in flags(window=(1.3, 1.3095))


@pytest.mark.parametrize(("level", "told"), [(0.0045, False), (0.0055, True)])
def test_a_zero_that_moves_the_ratio(level, told):
    shift = level * LOAD
    for along, normal in ((shift, 0.0), (0.0, shift / COF)):
        force = log() + np.array([along, 0.0, normal])
        found = flags(force, cof=COF)
        assert ("zero" in found) == told
        if told:
            assert found["zero"].measured == pytest.approx(level, rel=0.1)
    # half of a change from before to after
    force = log()
    force[2000:, 0] += 2 * shift
    assert ("zero" in flags(force, cof=COF)) == told


def test_a_zero_that_creeps_back():
    for size, told in ((3.3, False), (4.4, True)):
        force = log()
        force[2000:, 0] += size * (3.0 - TIME[2000:])
        assert ("zero" in flags(force, cof=COF)) == told


@pytest.mark.parametrize(
    ("cof", "name"),
    [(0.0205, None), (0.0195, "COF"), (1.19, None), (1.21, "COF"), (1e-4, "dead channel")],
)
def test_sizes_of_a_ratio(cof, name):
    found = flags(along=cof * LOAD * LOADED, cof=cof)
    assert [one for one in ("COF", "dead channel") if one in found] == ([name] if name else [])


def test_samples_that_no_instrument_gives():
    def held(force):
        force[1500:1504] = force[1500]

    assert flags(change=held)["held samples"].measured == pytest.approx(4 / RATE)

    def three(force):
        force[1500:1503] = force[1500]

    assert "held samples" not in flags(change=three)

    def still(force):
        force[LOADED, 1] = 3.0

    assert "scatter" in flags(change=still)

    def dead(force):
        force[~LOADED, 0] = 0.0

    assert "one number" in str(flags(change=dead)["scatter"])
    for share, told in ((0.018, False), (0.022, True)):

        def clipped(force, share=share):
            top = np.quantile(force[LOADED, 2], 1 - share)
            force[:, 2] = np.minimum(force[:, 2], top)

        assert ("saturation" in flags(change=clipped)) == told
    for count, told in ((21, False), (24, True)):

        def line(force, count=count):
            force[1400 : 1400 + count, 0] = 150 + 3.0 * np.arange(count) / count

        assert ("interpolated" in flags(change=line)) == told
    for size, told in ((40.0, False), (60.0, True)):

        def wraps(force, size=size):
            force[1600, 0] = -size

        assert ("range" in flags(change=wraps)) == (told and size > 0.3 * 153)


def test_steps_of_a_converter():
    def stepped(step):
        def change(force):
            force[:, 0] = step * np.round(force[:, 0] / step)

        return change

    for step, told in ((3.9, False), (4.1, True), (8.0, True)):
        found = flags(change=stepped(step), noise=0.22 * step)
        assert ("resolution" in found) == told
        if told:
            assert found["resolution"].measured == pytest.approx(0.5 * step / LOAD, rel=0.02)


def test_means_that_do_not_stand_for_their_window():
    for change, told in ((0.24, False), (0.26, True)):
        ramp = COF * LOAD * (1 + change * (TIME - 1.6) / 0.6)
        assert ("steadiness" in flags(along=ramp * LOADED)) == told
    for swing, told in ((0.095, False), (0.105, True)):
        normal = LOAD * LOADED * (1 + math.sqrt(2) * swing * np.sin(2 * math.pi * 10 * TIME))
        found = flags(normal=normal)
        assert ("normal force" in found) == told
        if told:
            assert found["normal force"].measured == pytest.approx(swing, rel=0.02)
    for share, told in ((0.035, False), (0.045, True)):

        def leaps(force, share=share):
            force[1300:1900:10, 0] += 10 * share / (1 - share) * COF * LOAD

        assert ("outliers" in flags(change=leaps)) == told


def test_friction_that_adds_nothing_to_the_noise_of_its_channel():
    for noise, told in ((0.85, True), (0.95, False)):  # 1.7 noises below 1 % of 150 N
        assert ("scatter" in flags(noise=noise)) == told
    rough = 1.3 * np.random.default_rng(7).normal(size=3000) * LOADED
    assert "scatter" not in flags(along=COF * LOAD * LOADED + rough, noise=0.85)


def speeds(values, rate=RATE):
    return SimpleNamespace(values=values, time=np.arange(len(values)) / rate, rate=rate)


def test_the_course_of_a_slide():
    moving = np.where((TIME > 1.1) & (TIME < 1.95), 0.3, 0.0)
    assert flags(speed=speeds(moving)) == {}
    for lowest, told in ((0.51, False), (0.49, True)):
        size = moving.copy()
        size[1500] = lowest * 0.3
        assert ("sliding" in flags(speed=speeds(size))) == told
    for length, told in ((1.49, False), (1.51, True)):
        size = moving * length / (moving[LOADED].sum() / RATE)
        assert ("slide" in flags(speed=speeds(size))) == told
    two = moving.copy()
    two[1500:1600] = 0.0
    assert flags(speed=speeds(two))["slides"].measured == 2
    two[1530:1600] = 0.3  # a stop of 30 ms is none
    assert "slides" not in flags(speed=speeds(two))
    for gap, told in ((60, True), (40, False)):
        normal = LOAD * LOADED
        normal[1950 : 1950 + gap] = 0.0
        normal[1950 + gap : 2200] = LOAD
        assert ("slides" in flags(normal=normal, window=(1.3, 1.9))) == told


def test_friction_in_proportion_to_the_load_before_it_slides():
    for share, told in ((0.0095, False), (0.0105, True), (-0.0105, True)):
        lowered = LOAD * np.clip((TIME - 1.0) / 0.2, 0, 1) * LOADED
        along = np.where(TIME > 1.25, COF, share) * lowered
        found = flags(normal=lowered, along=along, onset=1.25, noise=0.2, window=(1.35, 1.9))
        assert ("crosstalk" in found) == told
        if told:
            assert found["crosstalk"].measured == pytest.approx(abs(share), rel=0.02)
        bent = np.where(TIME > 1.25, COF, 0.05 * lowered / LOAD) * lowered
        assert "crosstalk" not in flags(normal=lowered, along=bent, onset=1.25, noise=0.2)
        assert "crosstalk" not in flags(normal=lowered, along=along, onset=1.06, noise=0.2)


def record(**channels) -> Any:
    usual = {"range": None, "factor": 2.0, "highest": 1e6, "noise": None}
    return SimpleNamespace(
        channel=lambda name: SimpleNamespace(**(usual | channels.get(name, {})))
    )  # fmt: skip


def test_what_a_record_of_a_calibration_contradicts():
    top = np.percentile(np.abs(log()[LOADED, 2]), 99)
    for share, told in ((0.97, False), (0.99, True)):
        found = flags(record=record(normal={"range": top / share / 2.0}))
        assert ("saturation" in found) == told
    for over, told in ((1.09, False), (1.11, True)):
        found = flags(record=record(normal={"highest": top / over}))
        assert ("calibration" in found) == told
    for ratio, told in ((2.4, False), (2.6, True), (1 / 2.4, False), (1 / 2.6, True)):
        known = 1.0 / ratio / 2.0
        assert ("noise" in flags(record=record(normal={"noise": known}))) == told
        assert ("noise" in flags(record=record(friction={"noise": known}))) == told


def scan(peak=5e3, least=0.0, noise=10.0) -> Any:
    return SimpleNamespace(pressure=np.array([least, 0.0, peak]), baseline_sd=noise)


def test_size_and_sign_of_pressures():
    def words(*given, **more):
        return [str(flag) for flag in scan_flags(*given, **more)]

    assert words(scan()) == []
    for peak, told in ((999.0, True), (1001.0, False), (81.0, True), (79.0, False)):
        assert bool(words(scan(peak))) == told
    for least, told in ((-199.0, False), (-201.0, True)):
        assert any("wrong sign" in one for one in words(scan(100.0, least, 1.0))) == told
    for least, told in ((-79.0, False), (-81.0, True)):
        assert any("wrong sign" in one for one in words(scan(10.0, least))) == told
    for ratio, told in ((2.4, False), (2.6, True), (1 / 2.6, True)):
        known = record(pressure={"noise": 10.0 / ratio / 2.0})
        assert bool(words(scan(), known)) == told
    assert words(scan(noise=0.0), record(pressure={"noise": 1.0})) == []


def shown(normal, along):
    force = np.column_stack([along, 0 * along, normal])
    return log_kind(SimpleNamespace(force=force), UP)  # pyright: ignore[reportArgumentType]


def test_walks_and_slides_are_told_apart():
    x = np.linspace(0, 1, 701)
    rest = np.zeros(100)

    def course(load, push):
        return shown(np.concatenate([rest, load, rest]), np.concatenate([rest, push, rest]))

    steady, step = np.full(701, 500.0), 700 * np.minimum(1, 4 * np.minimum(x, 1 - x))
    step *= 1 - 0.4 * np.exp(-(((x - 0.5) / 0.2) ** 2))
    both = np.where(x < 0.5, -100.0, 100.0)
    assert course(step, both) == "walk"
    for share, kind in ((0.26, "walk"), (0.24, "")):
        driving = np.where(x < 0.5, -100.0, 100.0 * share * 351 / 350)
        assert course(step, driving) == kind
    assert course(steady, 0.3 * steady) == "slide"
    for cof, kind in ((0.021, "slide"), (0.019, "")):
        assert course(steady, cof * steady) == kind
    for share, kind in ((0.12, "slide"), (0.13, "")):
        back = np.where(np.arange(701) % 2 == 0, 100.0, -100.0 * share * 351 / 350)
        assert course(steady, back) in (kind, "")
    assert course(steady, both) == ""
    assert course(0.099 * steady, 0.03 * steady) == ""
    assert course(0.101 * steady, 0.03 * steady) == "slide"
    assert shown(np.zeros(0), np.zeros(0)) == ""
    assert shown(np.append(rest, np.full(19, 500.0)), np.append(rest, np.full(19, 90.0))) == ""
    assert shown(np.append(rest, np.full(20, 500.0)), np.append(rest, np.full(20, 90.0))) == "slide"


def test_runs_with_short_gaps_are_one():
    assert check._join_runs([(0, 5), (8, 10), (14, 20)], 3) == [(0, 10), (14, 20)]
    assert check._join_runs([(0, 5), (8, 10), (14, 20)], 4) == [(0, 20)]
    assert check._join_runs([], 4) == []
