"""What every slip obeys, whoever walks."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import truncnorm

from slip_floors import Floor, dry_sole, slippery_sole
from underfoot.case import Case
from underfoot.compute.slips import slips
from underfoot.core import InputError
from underfoot.slip.dynamics import (
    FloorSensors,
    GaitHistory,
    Outcome,
    OutcomeLimits,
    Population,
    Spread,
    Walker,
    observe_slip,
    packaged_histories,
    slip_motion,
)
from underfoot.slip.dynamics.study import _wilson

EXAMPLES = Path(__file__).parents[2] / "examples"
HISTORIES = packaged_histories()
people = st.builds(
    Walker,
    history=st.sampled_from(HISTORIES),
    mass=st.floats(30, 150),
    rcof=st.floats(0.05, 0.4),
    heel_speed=st.floats(0, 1.0),
    shoe_angle=st.floats(0.05, 0.35),
    walking_speed=st.floats(0.8, 2.0),
    rcof_step=st.floats(-0.05, 0.05),
    brake_time=st.floats(0.003, 0.05),
    effective_mass=st.floats(0.02, 1.0),
)


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(people, st.floats(0.0, 0.5), st.floats(0.0, 100.0))
def test_energy_is_kept(person, cof, drag):
    for motion in (
        slip_motion(person, Floor(cof=cof, drag=drag)),
        slippery_sole().motion(person),
        dry_sole(cof).motion(person),
    ):
        balance = motion.kinetic - motion.kinetic[0] - motion.work_in + motion.dissipated
        assert np.abs(balance).max() < 1e-9 * max(1.0, np.abs(motion.work_in).max())
        assert (motion.speed >= 0).all()
        assert (np.diff(motion.distance) >= 0).all()


@settings(max_examples=30, deadline=None)
@given(people, st.floats(0.0, 0.3), st.floats(0.01, 0.2))
def test_more_friction_never_slips_further(person, cof, more):
    less, most = dry_sole(cof).motion(person), dry_sole(cof + more).motion(person)
    assert most.distance[-1] <= less.distance[-1] + 1e-9
    assert most.speed.max() <= less.speed.max() + 1e-9


@settings(max_examples=30, deadline=None)
@given(people, st.floats(0.0, 0.5), st.sampled_from(["recorded", "constant"]))
def test_a_braked_heel_is_never_faster(person, cof, brake):
    free = dry_sole(cof).motion(replace(person, heel_brake="none")).speed
    held = dry_sole(cof).motion(replace(person, heel_brake=brake)).speed
    count = min(free.size, held.size)
    assert (held[:count] <= free[:count] + 1e-9).all()


@settings(max_examples=30, deadline=None)
@given(people, st.floats(0.0, 0.3), st.floats(0.0, 1.0))
def test_a_slipping_foot_bears_its_share_and_no_more_than_the_dry_one(person, cof, share):
    motion = dry_sole(cof).motion(replace(person, weight_transfer=share))
    dry, _, _ = person.demands(motion.time)
    assert (motion.normal <= dry + 1e-9).all()
    assert (motion.normal >= share * dry - 1e-9).all()
    loaded = dry > 1.0
    ratio = np.interp(motion.time, person.step.time, person.step.ratio)
    assert np.abs(motion.drive - ratio * motion.normal)[loaded].max() < 1e-9


@settings(max_examples=20, deadline=None)
@given(people)
def test_friction_above_the_demand_never_slips(person):
    still = replace(person, heel_speed=0.0)
    motion = dry_sole(1.01 * person.step.ratio.max()).motion(still)
    assert motion.speed.max() == 0.0
    assert motion.distance[-1] == 0.0


def test_a_heavy_foot_gains_speed_in_inverse_proportion():
    person = Walker(HISTORIES[10], rcof=0.2, heel_speed=0.0, effective_mass=0.1)
    gains = [
        dry_sole(0.05).motion(replace(person, effective_mass=m)).speed.max()
        for m in (0.1, 0.2, 1.0)
    ]
    assert gains[0] == pytest.approx(2 * gains[1], rel=1e-6)
    assert gains[0] == pytest.approx(10 * gains[2], rel=1e-6)


def test_a_light_foot_follows_the_balance_of_forces():
    """Without mass, drive equals friction at every instant: V = r F / drag."""
    person = Walker(HISTORIES[10], rcof=0.2, heel_speed=0.0, effective_mass=0.001)
    motion = slip_motion(person, Floor(drag=300.0), step=1e-3)
    firm = (motion.time > 0.1) & (motion.time < 0.25)
    assert np.abs(300.0 * motion.speed - motion.drive)[firm].max() < 0.02 * motion.drive.max()


def test_faster_means_thicker_film_and_less_friction():
    """The feedback of the report's G.5.3."""
    sole = slippery_sole()
    base = sole.motion(Walker(HISTORIES[10], rcof=0.2, heel_speed=0.3))
    count = base.time.size
    shares, frictions = [], []
    for speed in (0.1, 0.3, 1.0, 2.0):
        held = replace(base, speed=np.full(count, speed))
        fluid, friction = sole.carried_at(held)
        at = int(np.argmax(base.normal))
        shares.append(fluid[at] / base.normal[at])
        frictions.append(friction[at])
    assert (np.diff(shares) > 0).all()
    assert (np.diff(frictions[:3]) < 0).all()


def test_population_is_seeded_and_its_first_persons_stay():
    one, more = Population(subjects=5, seed=3), Population(subjects=9, seed=3)
    for a, b in zip(one.walkers(), more.walkers(), strict=False):
        assert (a.mass, a.rcof, a.heel_speed, a.landing) == (
            b.mass,
            b.rcof,
            b.heel_speed,
            b.landing,
        )
    assert Population(subjects=5, seed=4).walkers()[0].mass != one.walkers()[0].mass


def test_population_has_the_spread_it_was_asked_for():
    values = np.array([w.rcof for w in Population(subjects=800).walkers()])
    assert values.mean() == pytest.approx(0.20, abs=0.004)
    assert values.std() == pytest.approx(0.03, abs=0.003)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Population(subjects=0),
        lambda: Population(histories=()),
        lambda: Population(rcof=Spread(0.2, 0.03, -0.5, 1.0)),
        lambda: Spread(0.2, -0.1),
        lambda: Spread(2.0, 0.1, 0.0, 1.0),
        lambda: FloorSensors(rows=0),
        lambda: OutcomeLimits(0.2, 0.1, 0.3),
    ],
)
def test_populations_and_sensors_that_cannot_be_are_refused(make):
    with pytest.raises(InputError):
        make()


def test_histories_are_checked():
    time = np.linspace(0, 0.6, 50)
    good = {"time": time, "normal": np.ones(50), "ratio": np.full(50, 0.2)}
    GaitHistory("good", **good)
    for bad in (
        {"normal": -np.ones(50)},
        {"normal": np.full(50, 700.0)},
        {"time": time[::-1]},
        {"ratio": np.full(50, math.nan)},
        {"ratio": np.ones(49)},
    ):
        with pytest.raises(InputError):
            GaitHistory("bad", **(good | bad))
    with pytest.raises(InputError, match="braking"):
        _ = GaitHistory("pushing", time, np.ones(50), np.full(50, -0.2)).rcof


def test_outcomes_follow_the_distance_and_the_speed():
    array = FloorSensors()
    person = Walker(HISTORIES[10], rcof=0.2, heel_speed=0.3)
    outcomes = []
    for cof in (0.5, 0.0):
        seen = observe_slip(dry_sole(cof).motion(person), None, array)
        outcomes.append((seen.outcome, seen.slipped))
    assert outcomes == [(Outcome.NO_SLIP, False), (Outcome.LONG_SLIDE, True)]
    limits = OutcomeLimits()
    assert [limits.outcome(d) for d in (0.005, 0.02, 0.05, 0.5)] == list(Outcome)


def test_the_observed_peak_is_the_motion_s_own():
    """Filter and marker move the peak speed of a slip by little."""
    person = Walker(HISTORIES[10], rcof=0.2, heel_speed=0.3)
    motion = dry_sole(0.03).motion(person)
    seen = observe_slip(motion, None, FloorSensors())
    assert seen.peak_speed == pytest.approx(motion.peak_speed, rel=0.03)
    assert seen.start is not None
    assert -0.02 < seen.start < 0.08


def test_bounds_of_a_share_are_wilsons():
    """Both bounds p solve (share - p)^2 = 1.96^2 p (1 - p) / n; one person has none."""
    for hits, count in ((9, 40), (0, 24), (24, 24), (1, 3)):
        low, high = _wilson(hits, count)
        assert 0.0 <= low < high <= 1.0
        assert low - 1e-12 <= hits / count <= high + 1e-12
        for bound in (low, high):
            distance = (hits / count - bound) ** 2
            exact = 1.959963984540054**2 * bound * (1.0 - bound) / count
            assert distance == pytest.approx(exact, abs=1e-12)
    for count in range(2, 100):  # none and all leave no rounding at their end
        assert (_wilson(0, count)[0], _wilson(count, count)[1]) == (0.0, 1.0)
    assert all(np.isnan(_wilson(1, 1)))


def test_sensors_lie_to_the_right_of_a_heel_that_lands_to_their_left():
    x, y = FloorSensors(columns=3, spacing=0.03).places(
        Walker(HISTORIES[10], landing=0.01, lateral=0.005)
    )
    assert x == pytest.approx([0.01, 0.04, 0.07])
    assert y == pytest.approx([0.025, -0.005, -0.035])


@pytest.mark.slow
def test_the_share_who_slip_holds_the_spread_of_the_contact_friction():
    case = Case.load(EXAMPLES / "work_shoe_full_tread_dry.toml")
    case = case.replace({"friction.model": "pair", "risk.rcof_mean": 0.5})
    study = slips(case, subjects=60)
    assert study.by_friction is not None
    same = study.at_contact_friction(1.0)
    assert same.of("peak_speed") == pytest.approx(study.of("peak_speed"))
    shares = [level.of("slipped").mean() for level in study.by_friction.levels]
    assert (np.diff(shares) <= 0).all()
    assert shares[0] > shares[-1]
    _, low, high = study.slip_share()
    _, narrow_low, narrow_high = replace(study, by_friction=None).slip_share()
    assert high - low > narrow_high - narrow_low
    # levels stand 15 to the draws' range: the drawn share is that of the levels weighted
    weights = np.bincount(study.by_friction.nearest, minlength=len(shares)) / 1000
    drawn = study.by_friction.means("slipped", 60)
    assert drawn.mean() == pytest.approx(weights @ shares, abs=0.01)


def test_each_person_has_a_brake_time_of_their_own():
    spread = Population().brake_time
    times = np.array([w.brake_time for w in Population(subjects=400).walkers()])
    exact = truncnorm(*((np.array([spread.low, spread.high]) - spread.mean) / spread.sd))
    assert times.mean() == pytest.approx(spread.mean + spread.sd * exact.mean(), rel=0.05)
    assert times.std() == pytest.approx(spread.sd * exact.std(), rel=0.1)


def test_a_walker_is_slowed_stretched_and_turned_as_said():
    history = next(h for h in HISTORIES if h.foot_angle is not None)
    walker = Walker(history, heel_brake="constant", brake_time=0.01, recorded_angle=True)
    assert walker.moving_mass == pytest.approx(70.0 * 0.114)
    times = np.array([0.0, 0.01, 0.02])
    speeds = walker.heel_speed * np.exp(-np.arange(3.0))
    assert walker.dry_speed(times) == pytest.approx(speeds)
    leaning = replace(history, foot_angle=history.foot_angle + 0.2)
    for each in (history, leaning):  # the fall counts, not where it began
        angle = replace(walker, history=each).demands(times)[2]
        assert angle[0] == pytest.approx(walker.shoe_angle)
    slow, fast = (replace(walker, walking_speed=v).step.duration for v in (1.0, 2.0))
    assert slow == pytest.approx(2 * fast)
