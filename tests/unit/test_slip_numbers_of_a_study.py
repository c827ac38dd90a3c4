"""What a study of slips says in numbers, what a history is written as, and who differs how."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import ConvergenceError, InputError, SourcedValue, Status
from underfoot.slip import (
    RcofPopulation,
    ReportG6,
    mean_of_draws,
    needed_acof,
    slip_chances,
)
from underfoot.slip.dynamics import GaitHistory, observation, study
from underfoot.slip.dynamics.gait import history_from_lines, history_text
from underfoot.slip.dynamics.observation import Outcome, _pulses
from underfoot.slip.dynamics.sensors import FloorSensors
from underfoot.slip.dynamics.study import SlipStudy, _thin_motion, slip_study
from underfoot.slip.dynamics.walker import Population, Walker
from underfoot.slip.risk import LARGEST_ACOF, acof_draws


def fake(**parts) -> Any:
    return SimpleNamespace(**parts)


def seen(speed, pressure, *, crossed=True, rows=(4.0, 2.0), slipped=True, outcome=Outcome):
    kind = next(iter(outcome))
    return fake(peak_speed=speed, distance=0.1 * speed, peak_pressure=pressure, duration=None,
                crossed=crossed, row_peaks=rows, slipped=slipped, outcome=kind)  # fmt: skip


def study_of(*observed, **more):
    subjects = tuple(fake(seen=each, walker=None, **more) for each in observed)
    return SlipStudy(fake(), fake(), FloorSensors(2, 3), subjects, False)


def test_numbers_of_a_study_are_of_those_who_crossed_and_its_shares_of_all():
    people = [seen(1.0, 10.0), seen(2.0, 30.0, rows=(8.0, 2.0)), seen(4.0, 20.0, rows=(6.0, 5.0)),
              seen(9.0, 90.0, crossed=False, slipped=False)]  # fmt: skip
    made = study_of(*people)
    told = made.numbers()
    assert (told["peak_speed"], told["peak_speed_sd"]) == (
        pytest.approx(7 / 3), pytest.approx(np.std([1, 2, 4], ddof=1)),
    )  # fmt: skip
    assert told["distance"] == pytest.approx(0.7 / 3)
    assert told["duration"] is None
    assert told["duration_sd"] is None
    assert told["slipped"] == 0.75
    assert told["slipped_low"] == pytest.approx(0.3006, abs=1e-4)  # Wilson
    assert told["slipped_high"] == pytest.approx(0.9544, abs=1e-4)
    assert told["crossed"] == 0.75
    assert told["correlation"] == pytest.approx(np.corrcoef([1, 2, 4], [10, 30, 20])[0, 1])
    assert told["last_over_first_row"] == pytest.approx(3 / 6)
    assert told[str(next(iter(Outcome))).replace(" ", "_")] == 1
    first_still = study_of(seen(1.0, 1.0, rows=(0.0, 3.0)))
    assert first_still.numbers()["last_over_first_row"] is None
    last_still = study_of(seen(1.0, 1.0, rows=(3.0, 0.0)))
    assert last_still.numbers()["last_over_first_row"] == 0
    assert study_of(seen(1.0, 1.0), seen(2.0, 5.0)).correlation() is None
    assert study_of(*[seen(1.0, k) for k in range(3)]).correlation() is None
    assert study_of(*[seen(k, 1.0) for k in range(3)]).correlation() is None
    single = study_of(seen(1.0, 1.0)).mean("peak_speed", "m/s")
    assert (single.value, single.uncertainty) == (1.0, None)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_bounds_of_a_share_hold_the_spread_of_the_friction_from_two_walkers_on(count):
    draws = np.linspace(0.2, 0.6, 1001)
    asked = []

    def means_of(hits, number):
        asked.append(number)
        return draws

    made = study_of(*[seen(1.0, 1.0, slipped=k == 0) for k in range(count)])
    share, low, high = study.replace(made, by_friction=fake(means_of=means_of)).slip_share()
    if count == 1:
        assert (share, asked) == (1.0, [])
        assert math.isnan(low)
        assert math.isnan(high)
        return
    assert asked[0] == count
    assert share == pytest.approx(0.4)
    assert (low, high) == pytest.approx((0.21, 0.59))


def test_those_who_slip_tell_where_their_slips_begin_and_runs_how_high_a_sensor_reads():
    begins = [(0.1, 0.2), (0.3, 0.6), None, (9.0, 9.0)]
    subjects = tuple(
        fake(seen=seen(1.0, 1.0, slipped=k < 3), motion=fake(slip_start=begin))
        for k, begin in enumerate(begins)
    )
    made = SlipStudy(fake(), fake(), FloorSensors(), subjects, False)
    assert made.slip_start() == pytest.approx((0.2, 0.4))
    nobody = SlipStudy(fake(), fake(), FloorSensors(), subjects[3:], False)
    assert nobody.slip_start() is None


def test_a_motion_is_thinned_with_its_first_and_last_instant():
    count = 23
    columns: dict[str, Any] = {name: np.arange(float(count)) for name in study.COLUMNS}
    motion = study.SlipMotion(fake(), **columns, status=fake(), model="m")
    kept = _thin_motion(motion).time
    assert kept.tolist() == [0, 4, 8, 12, 16, 20, 22]
    begin: dict[str, Any] = {name: each[:5] for name, each in columns.items()}
    short = study.SlipMotion(fake(), **begin, status=fake(),
                             model="m")  # fmt: skip
    assert _thin_motion(short).speed.tolist() == [0, 4]


def test_a_study_takes_as_many_full_slips_as_are_asked_for_and_by_default_sixteen(monkeypatch):
    asked = []

    class Enough(Exception):
        pass

    def designed(population, count):
        asked.append(count)
        raise Enough

    monkeypatch.setattr(study, "design", designed)
    people = Population(subjects=2)
    options: tuple[dict[str, Any], ...] = ({}, {"fit_runs": 5, "held_out": 2})
    for more in options:
        with pytest.raises(Enough):
            slip_study(fake(viscosity=0.2), people, **more)
    assert asked == [16, 7]
    assert (study.FIT_RUNS, study.HELD_OUT) == (12, 4)


@pytest.mark.parametrize("solved", [0, 1, 3])
def test_a_full_study_is_of_those_who_were_solved_and_refused_without_any(monkeypatch, solved):
    runs = [fake(motion=fake(status=Status.CONVERGED if k < solved else Status.NOT_CONVERGED),
                 maps=k) for k in range(3)]  # fmt: skip
    monkeypatch.setattr(study, "full_runs", lambda *_, **__: runs)
    monkeypatch.setattr(study, "array_pressures", lambda motion, maps, array: maps)
    monkeypatch.setattr(study, "_subject", lambda motion, pressures, *more: pressures)
    monkeypatch.setattr(study, "_middle", lambda subjects: len(subjects) - 1)
    monkeypatch.setattr(study, "_breaches", lambda setting, good: (f"of {len(good)}",))
    people = Population(subjects=3)
    if not solved:
        with pytest.raises(ConvergenceError):
            slip_study(fake(viscosity=0.2), people, full=True)
        return
    made: Any = slip_study(fake(viscosity=0.2), people, full=True)
    assert made.subjects == tuple(range(solved))
    assert made.representative is runs[solved - 1]
    assert (made.failed, made.full) == (3 - solved, True)
    assert made.full_runs == tuple(runs[:solved])
    assert made.breaches == (f"of {solved}",)


def test_the_spread_of_a_contact_is_taken_at_500_newtons_on_20_square_centimetres(monkeypatch):
    asked = []

    def points(law, **place):
        asked.append((law, place))

    monkeypatch.setattr(study, "sampled_points", points)
    made = SlipStudy(fake(friction="own"), fake(), FloorSensors(), (), False, sole=fake())
    assert made.at_friction_draws() is None
    assert made.at_friction_draws(cast(Any, "other"), draws=7, seed=3) is None
    (own, first), (other, second) = asked
    assert (own, other) == ("own", "other")
    assert first["contact_pressure"] == pytest.approx(500 / 20e-4)
    assert first["speed"] == 0.2
    assert (first["samples"], first["seed"]) == (study.DRAWS, 0)
    assert (second["samples"], second["seed"]) == (7, 3)
    bare = SlipStudy(fake(), fake(), FloorSensors(), (), False)
    assert bare.at_friction_draws() is None
    with pytest.raises(InputError):
        bare.at_contact_friction(2.0)
    assert bare.peak_speed_at(mass=70.0) is None


def test_what_was_measured_of_people_is_not_assumed():
    people = Population()
    assumed = {name: getattr(people, name).assumed for name in (
        "mass", "rcof_step", "rcof", "walking_speed", "heel_speed", "shoe_angle", "brake_time",
    )}  # fmt: skip
    assert assumed == {"mass": False, "rcof_step": False, **dict.fromkeys(
        ("rcof", "walking_speed", "heel_speed", "shoe_angle", "brake_time"), True)}  # fmt: skip
    assert not people.recorded_angle
    assert (people.mass.mean, people.mass.sd) == (70.0, 11.8)  # of the report, G.5.1


# histories and sensors


def test_a_history_is_read_as_it_was_written():
    time = np.linspace(0, 0.6, 7)
    made = GaitHistory("a", time, 1 + 0.1 * time, 0.2 - time / 4, np.radians(20 * time), 1.31, 0.42,
                       0.3 - time / 2)  # fmt: skip
    notes = {"source": "a lab", "licence": "free", "body weight": "700 N", "hand": "left"}
    again = history_from_lines(history_text(made, notes).splitlines(), "a")
    for name in ("time", "normal", "ratio", "heel_velocity"):
        assert getattr(again, name) == pytest.approx(getattr(made, name), abs=6e-4)
    assert again.foot_angle == pytest.approx(made.foot_angle, abs=1e-3)
    assert (again.walking_speed, again.heel_speed) == (1.31, 0.42)
    assert again.source == "a lab; free; 700 N"
    bare = GaitHistory("b", time, 1 + time, 0.2 - time / 4)
    read = history_from_lines(["#source:no space", *history_text(bare, {}).splitlines()], "b")
    assert (read.foot_angle, read.heel_velocity, read.walking_speed) == (None, None, None)
    assert read.source == "no space"
    with pytest.raises(InputError, match="shear_ratio"):
        history_from_lines(["time_s,normal_per_body_weight", "0,1"], "c")


def test_a_sensor_reads_nothing_before_the_first_and_after_the_last_instant(monkeypatch):
    given = []

    def pulse(name, channel, at):
        given.append((name, channel))
        return fake(
            peak=SourcedValue(1e3 * (1 + len(given))), duration=SourcedValue(len(given) / 10)
        )

    monkeypatch.setattr(observation, "pressure_pulse", pulse)
    monkeypatch.setattr(observation, "BASELINE_SD", 0.0)
    motion: Any = fake(time=np.linspace(0, 0.2, 21))
    rows, duration, highest = _pulses(motion, np.full((21, 2, 2), 5e4), 0)
    assert [name for name, _ in given] == ["00", "01", "10", "11"]
    channel = given[0][1]
    times = channel.start + np.arange(channel.values.size) / channel.rate
    inside = (times > 1e-9) & (times < 0.2 - 1e-9)
    assert channel.values[inside] == pytest.approx(5e4)
    assert (channel.values[(times < -1e-9) | (times > 0.2 + 1e-9)] == 0).all()
    assert times[-1] == pytest.approx(0.25, abs=2 / channel.rate)
    assert (rows, duration, highest) == ((3e3, 5e3), 0.4, 5e3)


# how likely a person slips


def test_draws_of_people_lie_about_their_mean_and_end_at_what_can_be():
    people = RcofPopulation(0.2, 0.03, mean_deviation=0.05, sd_deviation=0.02)
    names = []

    def normal(name):
        names.append(name)
        return np.array([-9.0, -1.0, 0.0, 2.0, 99.0])

    mean, sd = people.draw_moments(normal)
    assert mean == pytest.approx([0, 0.15, 0.2, 0.3, 1.0])
    assert sd == pytest.approx([0, 0.01, 0.03, 0.07, 0.5])
    assert len(set(names)) == 2
    assert RcofPopulation(0.2, 0.03).draw_moments(normal) == (0.2, 0.03)


def test_chances_of_draws_are_those_of_their_frictions_and_models():
    model, people = ReportG6(log_slope_sd=0.3, fifty_percent_sd=0.1), RcofPopulation(0.2, 0.0)
    acof = np.array([0.1, 0.2, -1.0, 99.0])
    given = {"slope of the slip model": np.array([0.0, 1.0, 0.0, 0.0]),
             "even odds of the slip model": np.array([0.0, -1.0, 0.0, 0.0])}  # fmt: skip
    found = slip_chances(acof, people, model, given.__getitem__)
    slope = -49.2
    odds = [slope * (0.1 - 0.2 + 0.06), slope * math.exp(0.3) * (0.2 - 0.2 + 0.06 + 0.1),
            slope * (0 - 0.2 + 0.06), slope * (LARGEST_ACOF - 0.2 + 0.06)]  # fmt: skip
    assert found == pytest.approx(1 / (1 + np.exp(-np.array(odds))), abs=1e-9)
    known: Any = fake(population=lambda a, mean, sd: a + mean + sd)
    assert slip_chances(acof, people, known) == pytest.approx([0.3, 0.4, 0.2, 5.2])


def test_a_mean_of_draws_has_their_spread_and_95_percent_of_them():
    draws = np.random.default_rng(4).permutation(np.arange(1001) / 1000)
    found = mean_of_draws(draws, note="n")
    assert found.value == pytest.approx(0.5)
    assert found.uncertainty == pytest.approx(np.std(draws, ddof=1))
    assert found.interval == pytest.approx((0.025, 0.975))
    assert found.note == "n"


def test_draws_of_a_friction_are_evenly_likely_and_none_without_a_spread():
    draws = acof_draws(SourcedValue(0.3, uncertainty=0.05))
    assert draws is not None
    assert (draws.mean(), draws.std()) == (
        pytest.approx(0.3, abs=1e-6), pytest.approx(0.05, rel=2e-3),
    )  # fmt: skip
    below = (draws < 0.3 - 1.96 * 0.05).mean()
    assert below == pytest.approx(0.025, abs=1e-3)
    assert np.abs(np.corrcoef(draws[1:], draws[:-1])[0, 1]) < 0.1
    assert acof_draws(SourcedValue(0.3)) is None
    assert acof_draws(SourcedValue(0.3), [1, 2]) == pytest.approx([1, 2])  # type: ignore
    with pytest.raises(InputError):
        acof_draws(SourcedValue(0.3, uncertainty=math.inf))


def test_the_friction_that_is_needed_keeps_the_spread_of_the_present_one():
    model, people = ReportG6(log_slope_sd=0.0, fifty_percent_sd=0.0), RcofPopulation(0.2, 0.03)
    exact = needed_acof(0.05, rcof=people, model=model)
    assert model.population(exact, 0.2, 0.03) == pytest.approx(0.05, abs=1e-6)
    shares = np.array([0.8, 1.0, 1.2])
    wide = needed_acof(0.05, rcof=people, model=model, acof=SourcedValue(0.5), samples=0.5 * shares)
    chances = [model.population(wide * share, 0.2, 0.03) for share in shares]
    assert np.mean(chances) == pytest.approx(0.05, abs=1e-6)
    assert wide > exact
    for risk in (0.0, 1.0):
        with pytest.raises(InputError, match="risk"):
            needed_acof(risk)
    with pytest.raises(InputError, match="reached by no ACOF"):
        needed_acof(0.9999, rcof=RcofPopulation(0.0, 0.0), model=model)


@pytest.mark.parametrize(
    ("speed", "brake", "wanted"),
    [(None, "none", (1.0, 1.0)), (None, "constant", (1.0, math.exp(-2))),
     (None, "recorded", (1.0, 0.25)), (2.7, "recorded", (1.0, 0.0))],
)  # fmt: skip
def test_a_heel_on_a_dry_floor_is_braked_as_said(speed, brake, wanted):
    time = np.linspace(0, 0.4, 9)
    velocity = np.interp(time, [0, 0.1, 0.2, 0.4], [0.8, 0.2, 0.4, -0.1])
    history = GaitHistory("a", time, np.ones(9), np.full(9, 0.2), np.radians(30 - 50 * time), 1.35,
                          None, velocity)  # fmt: skip
    person = Walker(history, heel_speed=0.5, walking_speed=speed, heel_brake=brake,
                    brake_time=0.05, shoe_angle=0.2, recorded_angle=True)  # fmt: skip
    found = person.dry_speed(np.array([0.0, 0.1]))
    if speed:  # the step takes half as long: at 0.1 s its 0.2 s
        wanted = (1.0, 0.25)
    assert found == pytest.approx(0.5 * np.array(wanted))
    assert person.step.duration == pytest.approx(0.2 if speed else 0.4)
    normal, drive, angle = person.demands(np.array([0.0, 0.1]))
    assert normal == pytest.approx([70 * 9.80665] * 2)
    assert drive == pytest.approx(0.2 * normal)
    fall = np.radians(50 * 0.1 * (2 if speed else 1))
    assert angle == pytest.approx([0.2, max(0.2 - fall, 0)])


def test_a_step_that_never_brakes_ends_its_braking_at_once():
    time = np.linspace(0, 0.6, 9)
    assert GaitHistory("a", time, np.ones(9), np.full(9, -0.1)).end_of_braking == 0.0
