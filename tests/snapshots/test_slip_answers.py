"""Slips and their risk: models, draws, people, motions, what sensors see, studies, refusals."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.optimize

from slip_floors import Floor, constant, dry_sole, slippery_sole, walker
from small_pads import pad
from snapshot import held, refusal
from underfoot.compute.slips import slip_population, slip_sensors, slip_setting, slips
from underfoot.core import Cache, SourcedValue
from underfoot.slip import Beschorner2016, Chang2004, ReportG6
from underfoot.slip._checks import (
    available,
    check_required_friction,
    deviation,
    logistic,
    normal_mean_of_logistic,
)
from underfoot.slip.dynamics._kernels import reduced as kernel
from underfoot.slip.dynamics.full_model import SoleFoot, full_run, full_runs, pressed_area
from underfoot.slip.dynamics.gait import (
    GaitHistory,
    history_from_lines,
    history_text,
    load_history,
    packaged_histories,
)
from underfoot.slip.dynamics.motion import slip_motion
from underfoot.slip.dynamics.observation import heel_marker, judge_slip, observe_slip
from underfoot.slip.dynamics.reduced_model import (
    FittedRange,
    ReducedSole,
    at_bounds,
    cof_table,
    design,
    error_of,
    error_text,
    fitted_reduced,
)
from underfoot.slip.dynamics.sensors import (
    FloorSensors,
    array_pressures,
    pressure_shape,
    sensor_map,
)
from underfoot.slip.dynamics.study import FrictionDraws, SlipStudy, _wilson, slip_study
from underfoot.slip.dynamics.walker import Population, Spread, Walker
from underfoot.slip.model import MODELS, slip_model
from underfoot.slip.required import ADULTS_LEVEL_WALKING, RcofPopulation
from underfoot.slip.risk import acof_draws, mean_of_draws, needed_acof, slip_chances, slip_risk

ACOF = np.array([0.0, 0.05, 0.12, 0.2, 0.3, 0.6, 5.0])


def normal(name: str) -> np.ndarray:
    """Return six draws that differ with their name."""
    return np.linspace(-2.0, 2.0, 6) + 0.01 * len(name)


def step(duration: float = 0.6, **more: Any) -> GaitHistory:
    """Return a step that lands, brakes and pushes off."""
    time = np.linspace(0.0, duration, 61)
    share = time / duration
    load = np.maximum(1.1 * np.sin(np.pi * share) ** 0.7 - 0.05 * np.sin(5 * np.pi * share), 0)
    ratio = 0.22 * np.cos(np.pi * share)
    angle = 0.3 * np.exp(-8 * share) - 0.2 * share
    return GaitHistory("made", time, load, ratio, **({"foot_angle": angle} | more))


def test_models(file_regression):
    said: dict[str, Any] = {}
    for name in MODELS:
        model = slip_model(name)
        said[name] = {
            "at": model(ACOF, 0.2),
            "one": model(0.15, 0.2),
            "people": model.population(ACOF, 0.2, np.array([0.0, 0.03, 0.1, 0.03, 0.5, 1.0, 0.0])),
            "exact": model.population(ACOF, 0.2, 0.0),
            "one of people": model.population(0.15, 0.2, 0.03),
            "drawn": model.draw_probability(np.linspace(0.05, 0.3, 6), 0.2, 0.03, normal),
            "beyond": [model.breaches(a, 0.2) for a in ACOF[:-1]],
            "table": model.table(),
            "short": repr(model),
            "it": model,
            "assumes": model.assumptions,
        }
    said["tested"] = Beschorner2016().tested, ReportG6().tested, Beschorner2016(2.0, -0.1).tested
    said["curve"] = logistic(np.array([-1000.0, -2.0, 0.0, 0.5, 1000.0]))
    said["mean"] = [
        normal_mean_of_logistic(np.array([-3.0, 0.2, 4.0]), np.full(3, width))
        for width in (0.0, 0.5, 3.0, 40.0)
    ]
    held(file_regression, said)


REFUSED: list[tuple[Callable[..., Any], tuple[Any, ...]]] = [
    (ReportG6, (0.0,)),
    (ReportG6, (math.nan,)),
    (ReportG6, (-1.0, math.inf)),
    (Beschorner2016, (1.0,)),
    (Beschorner2016, (math.inf,)),
    (Beschorner2016, (1.5, math.nan)),
    (available, ([0.1, -1e-9],)),
    (available, (5.001,)),
    (available, (math.nan,)),
    (check_required_friction, (1.001,)),
    (check_required_friction, ([0.2, math.nan],)),
    (check_required_friction, (-0.001, "there")),
    (deviation, (-0.001, "there")),
    (deviation, (1.001, "there")),
    (slip_model, ("report_g5",)),
    (RcofPopulation, (1.01, 0.1)),
    (RcofPopulation, (0.2, 0.501)),
    (RcofPopulation, (0.2, -0.01)),
    (slip_risk, (SourcedValue(None, reason="no contact"),)),
    (slip_risk, (-0.1,)),
    (slip_risk, (SourcedValue(0.2, uncertainty=math.inf),)),
    (needed_acof, (0.0,)),
    (needed_acof, (1.0,)),
    (needed_acof, (0.9999999999,)),
]


def test_what_is_refused(file_regression):
    time = np.linspace(0, 0.5, 6)
    flat, good = np.ones(6), step()
    histories = {
        "short": (time[:4], flat[:4], flat[:4]),
        "shapes": (time, flat[:5], 0.1 * flat),
        "nan": (time, flat, np.nan * flat),
        "late": (time + 0.1, flat, 0.1 * flat),
        "back": (time[::-1] - time[-1], flat, 0.1 * flat),
        "pull": (time, -flat, 0.1 * flat),
        "heavy": (time, 4.01 * flat, 0.1 * flat),
        "steep": (time, flat, -1.51 * flat),
    }
    said = {f"{call.__qualname__} {args}": refusal(call, *args) for call, args in REFUSED}
    said |= {name: refusal(GaitHistory, name, *one) for name, one in histories.items()}
    said["several"] = refusal(slip_risk, [0.1, 0.2], samples=[0.1])
    said["level"] = refusal(lambda: GaitHistory("a", time, 0.1 * flat, 0.1 * flat).rcof)
    said["push"] = refusal(lambda: GaitHistory("a", time, flat, -0.1 * flat).rcof)
    for rcof in (-0.01, 1.01):
        said[f"asking {rcof}"] = refusal(good.asking, rcof)
    for length in (0.0, math.inf):
        said[f"lasting {length}"] = refusal(good.lasting, length)
    ends = {
        "mass": (4.9, 400.1), "rcof": (-0.01, 1.01), "heel_speed": (-0.01, 6.01),
        "effective_mass": (9e-4, 1.01), "walking_speed": (0.09, 6.01),
        "rcof_step": (-1.01, 1.01), "brake_time": (9e-4, 1.01), "weight_transfer": (-0.01, 1.01),
    }  # fmt: skip
    for name, both in ends.items():
        for value in both:
            said[f"{name} {value}"] = refusal(Walker, good, **{name: value})
    said["brake"] = refusal(Walker, good, heel_brake="recordet")
    for args in ((math.nan, 1.0), (0.0, -1.0), (0.0, math.inf), (2.0, 1.0, 0.0, 1.0)):
        said[f"spread {args}"] = refusal(Spread, *args)
    for more in ({"subjects": 0}, {"subjects": 1.5}, {"histories": ()},
                 {"mass": Spread(1.0, 1.0, 0.0, 2.0)}, {"rcof": Spread(0.2, 1, -0.1, 1)},
                 {"rcof": Spread(0.2, 1, 0.1, 1.1)}):  # fmt: skip
        said[f"people {list(more)} {more.get('subjects')}"] = refusal(Population, **more)
    for args in ((0, 1), (1, 0), (1, 1, 0.0), (1, 1, 0.1, -1e-3)):
        said[f"sensors {args}"] = refusal(FloorSensors, *args)
    sole = slippery_sole()
    for length in (0.0, math.nan, 0.0601):
        said[f"step {length}"] = (
            refusal(sole.motion, Walker(good), step=length),
            refusal(slip_motion, Walker(good), Floor(), step=length),
        )
    said["constants"] = refusal(replace, sole, constants=np.ones(13))
    said["finite"] = refusal(replace, sole, constants=np.full(14, np.nan))
    other = FittedRange(0.1, (0, 1), (0, 1), (0, 1))
    said["fluid"] = refusal(replace, sole, fitted=other)
    said["few"] = refusal(fitted_reduced, None, [1, 2], [], [(1, 1, 1)] * 3)
    held(file_regression, said)


def test_risks(file_regression):
    known = SourcedValue(0.2, uncertainty=0.03, assumed=True)
    people = RcofPopulation(0.25, 0.05, "here", True, 0.02, 0.01)
    said: dict[str, Any] = {}
    for model in (None, Beschorner2016(), Chang2004()):
        made = slip_risk(known, model=model, rcof=people)
        said[made.model] = made, repr(made), made.table()
    said["number"] = slip_risk(0.2), repr(slip_risk(0.2)), slip_risk(0.2).table()
    said["several"] = slip_risk([[0.1, 0.2], [0.3, 0.6]])
    said["sampled"] = slip_risk(known, samples=np.linspace(-0.1, 0.4, 50))
    said["sticky"] = slip_risk(7.0)
    said["draws"] = acof_draws(known), acof_draws(SourcedValue(0.2))
    said["chances"] = slip_chances(np.linspace(-0.1, 6.0, 8), people, ReportG6(),
                                   lambda _: np.linspace(-2, 2, 8))  # fmt: skip
    said["own"] = slip_chances(np.linspace(0.1, 0.3, 8), people, ReportG6())
    said["mean"] = mean_of_draws(np.linspace(0, 1, 11) ** 2, source="here")
    said["needed"] = [needed_acof(risk) for risk in (1e-3, 0.05, 0.5, 0.9)]
    said["spread"] = [
        needed_acof(0.05, acof=known, model=model, rcof=people) for model in (None, Chang2004())
    ]
    said["sampled need"] = needed_acof(0.1, acof=known, samples=np.linspace(0.15, 0.25, 9))
    said["exact need"] = needed_acof(0.1, acof=SourcedValue(0.2))
    slopes = [(0.0, 0.0), (0.1, 0.0), (0.0, 0.02), (-0.1, 0.01)]
    said["slopes"] = [people.on_slope(*one) for one in slopes]
    said["drawn"] = people.draw_moments(lambda _: np.array([-40.0, -1.0, 2.0, 60.0]))
    said["adults"] = ADULTS_LEVEL_WALKING, ADULTS_LEVEL_WALKING.draw_moments(normal)
    said["bounds"] = [_wilson(*one) for one in ((0, 10), (10, 10), (3, 10), (1, 2), (1, 1))]
    held(file_regression, said)


def test_steps_and_people(file_regression, tmp_path):
    packed = packaged_histories()
    fast = step(heel_velocity=np.linspace(0.5, -0.1, 61) ** 3 * 8, walking_speed=1.1,
                heel_speed=0.4)  # fmt: skip
    slow = replace(fast, heel_velocity=np.full(61, 0.049))
    text = history_text(fast, {"source": "here", "licence": "free", "body weight": "700 N"})
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    people = Population(subjects=3)
    times = np.linspace(0, 0.7, 9)
    walkers = [
        Walker(fast), Walker(slow), Walker(step(), heel_brake="none"),
        Walker(fast, heel_brake="constant", walking_speed=1.6, recorded_angle=True),
        Walker(step(), walking_speed=1.0, rcof=0.99, rcof_step=0.4, recorded_angle=True),
        Walker(fast, rcof=0.1, rcof_step=-0.3), *people.walkers(),
    ]  # fmt: skip
    said = {
        "packed": [(one.name, one.rcof, one.duration, one.end_of_braking) for one in packed],
        "fast": (fast, fast.landing, fast.rcof, fast.end_of_braking),
        "slow": slow.landing,
        "text": text,
        "plain text": history_text(step(foot_angle=None), {}),
        "read": load_history(tmp_path / "a.csv"),
        "people": people,
        "walkers": walkers,
        "demands": [one.demands(times) for one in walkers],
        "dry": [one.dry_speed(times) for one in walkers],
        "mass": [one.moving_mass for one in walkers],
        "draws": Spread(0.0, 1.0, -0.5, 0.7).draw(40, np.random.default_rng(3)),
        "narrow": Spread(0.0, 1.0, -1e-9, 0.0).draw(4, np.random.default_rng(3)),
        "design": design(people, 5),
        "another": [one.mass for one in design(people, 5, seed=8)],
        "cut": history_from_lines(
            ["# source: a", "# licence: b", "# nothing", text.splitlines()[-62],
             *(f"{t},1,0.1,," for t in (0, 0.1, 0.2, 0.3, 0.4))], "cut"),
        "no column": refusal(history_from_lines, ["time_s,a", "0,1"], "b"),
        "empty": refusal(history_from_lines, [], "b"),
        "no number": refusal(
            history_from_lines,
            ["time_s,normal_per_body_weight,shear_ratio", "0,x,1"], "b"),
    }  # fmt: skip
    held(file_regression, said)


@dataclass
class Curved(Floor):
    """A floor whose friction does not grow evenly with the speed."""

    def advance(self, duration, *, normal_force, speed, shoe_angle):
        return Curved(self.cof, self.drag, normal_force)

    def friction(self, speed):
        return self.cof * self.load * (1 - 0.8 * min(speed, 0.5)) + self.drag * speed**3


MOVING: dict[str, Floor] = {
    "grips": Floor(cof=0.5),
    "slips": Floor(cof=0.12, drag=20.0),
    "curved": Curved(cof=0.12, drag=60.0),
    "ice": Floor(cof=0.0),
}


def test_feet_on_floors_of_known_friction(file_regression):
    said: dict[str, Any] = {}
    for name, floor in MOVING.items():
        for person in (walker(step(), 0.2, heel_speed=0.4), Walker(step(), weight_transfer=0.4)):
            motion = slip_motion(person, floor)
            said[f"{name} {person.name} {person.heel_speed}"] = (
                motion, motion.kinetic, motion.still_sliding, motion.peak_speed, motion.slip_start
            )  # fmt: skip
    seen = []
    broken = slip_motion(Walker(constant(0.2)), Floor(usable=True), step=0.05, model="mine",
                         observe=lambda time, _: seen.append(time))  # fmt: skip
    said["observed"] = seen, broken.model
    sole = slippery_sole()
    for person in (Walker(step()), Walker(step(), weight_transfer=0.4, heel_speed=0.8),
                   Walker(step(), shoe_angle=0.1, recorded_angle=True, rcof=0.05)):  # fmt: skip
        motion = sole.motion(person)
        said[f"reduced {person.rcof} {person.weight_transfer}"] = (
            motion, motion.slip_start, sole.carried_at(motion), heel_marker(motion),
            judge_slip(motion), observe_slip(motion, None, FloorSensors()),
        )  # fmt: skip
    for cof in (0.05, 0.15, 0.4):
        motion = dry_sole(cof).motion(Walker(step(), heel_speed=0.5))
        said[f"dry {cof}"] = motion, observe_slip(motion, None, FloorSensors(1, 1))
    limits = FittedRange(0.219, (0.0, 500.0), (0.0, 0.5), (0.1, 0.2))
    narrow = replace(sole, fitted=limits)
    said["beyond"] = narrow.motion(Walker(step(), heel_speed=0.7)).notes
    said["refused"] = refusal(narrow.carried_at, sole.motion(Walker(step(), heel_speed=0.7)))
    runs = [sole.motion(Walker(step(), heel_speed=0.2 + 0.1 * k)) for k in range(3)]
    said["range"] = FittedRange.of(0.219, runs)
    other = replace(sole, cofs=1.1 * sole.cofs)
    said["error"] = error_of(other, runs), str(error_of(other, runs)), error_of(other, [])
    said["texts"] = [error_text(value, "m/s") for value in (0.0, 9.9e-4, 1e-3, 0.0234)]
    held(file_regression, said)


@dataclass
class Asked(Floor):
    """A floor without friction that writes down what it is asked."""

    asked: list[tuple[float, float, float, float]] = field(default_factory=list)

    def advance(self, duration, *, normal_force, speed, shoe_angle):
        self.asked.append((duration, normal_force, speed, shoe_angle))
        return self

    def friction(self, speed):
        return 0.0


def test_a_contact_is_asked_for_what_the_end_of_each_step_demands():
    person, floor = Walker(step(), shoe_angle=0.1, recorded_angle=True, heel_speed=0.4), Asked()
    motion = slip_motion(person, floor, step=0.01)
    durations, loads, speeds, angles = np.transpose(floor.asked)
    times = np.cumsum(durations)
    assert times == pytest.approx(motion.time[1:])
    demanded = person.demands(times)
    assert loads == pytest.approx(demanded[0])
    assert angles == pytest.approx(demanded[2])
    assert np.ptp(angles) > 0.05
    assert speeds[1:] == pytest.approx(motion.speed[2:], abs=0.05)


def test_the_compiled_steps_of_a_slip(file_regression):
    c = np.array([1.5e-3, 0.4, 2.0, 6e5, 4e-5, 2e5, 3.0, 90.0, -2.0, 0.05, 1.2e-4, 1.7, 9.0, -6.0])
    speeds, cofs = np.array([0.0, 0.5, 2.0]), np.array([0.25, 0.2, 0.12])
    said: dict[str, Any] = {
        "pressure": [kernel._contact_pressure(h, 1e5, 6e5, 4e-5) for h in (1e-6, 5e-5, 3e-4, 1.0)],
        "rate": [kernel._film_rate(h, v, 1e5, 0.1, c, 0.2, 7e-4)
                 for h in (1e-5, 1e-4) for v in (-1.0, 0.0, 0.5)],
        "height": [kernel._solved_height(base, 1e-3, v, 1e5, 0.1, c, 0.2, 7e-4)
                   for base in (-1e-5, 1e-5, 1e-4, 1e-2) for v in (0.0, 0.5)],
        "area": [kernel._area(load, 0.1, c) for load in (0.0, 0.5, 1.0, 500.0, 800.0)],
        "friction": [kernel._friction(v, 1e-4, 400.0, 0.1, c, eta, speeds, cofs)
                     for v in (0.0, 0.7) for eta in (0.0, 0.2)],
        "speed": [kernel._solved_speed(v, 1e-3, push, 1e-4, 400.0, 0.1, c, 0.2, speeds, cofs)
                  for v in (0.0, 0.1, 0.7) for push in (-200.0, 50.0, 300.0)],
    }  # fmt: skip
    times = np.linspace(0, 0.2, 41)
    loads = 300 + 2000 * times
    for name, ask, eta, given in (
        ("wet", 0.25, 0.2, np.nan), ("dry", 0.25, 0.0, np.nan), ("rests", 0.02, 0.2, np.nan),
        ("held", 0.25, 0.2, 0.4), ("starts", 0.4, 0.2, np.nan), ("starts dry", 0.4, 0.0, np.nan),
    ):  # fmt: skip
        asked = np.sin(20 * times - 0.4) if "starts" in name else np.cos(20 * times)
        said[name] = kernel.carry_slip(
            times, loads, ask * loads * asked, 0.1 - 0.9 * times,
            0.3 * np.exp(-times / 0.01), 0.6, np.full(41, given), 8.0, c, eta, 7e-4, speeds, cofs,
            0.1,
        )  # fmt: skip
    held(file_regression, said)


@pytest.fixture(scope="module")
def wet():
    return pad({"numerics.quick_grid_spacing": "4 mm", "numerics.cells_along": 1,
                "motion.normal_force": "200 N", "numerics.tolerance": 1e-6})  # fmt: skip


def test_slips_of_a_small_sole(file_regression, tmp_path, wet):
    setting = slip_setting(wet)
    people = replace(slip_population(wet, subjects=3), mass=Spread(25, 3, 20, 30))
    said: dict[str, Any] = {
        "setting": replace(setting, friction=None, asperities=None, compliance=None),
        "people": replace(people, histories=people.histories[:1]),
        "sensors": slip_sensors(wet),
        "table": cof_table(setting.friction, 2e5),
    }
    store = Cache("slips", tmp_path)
    runs = full_runs(setting, people.walkers()[:2], step=0.03, cache=store)
    again = full_run(setting, people.walkers()[0], step=0.03, cache=store)
    np.testing.assert_array_equal(again.maps, runs[0].maps)
    np.testing.assert_array_equal(again.motion.speed, runs[0].motion.speed)
    array = FloorSensors(2, 2, 5e-3, 2e-3)
    shape = pressure_shape(runs, setting.shoe_angle)
    foot = SoleFoot(setting, 0.06, 200.0)
    at = foot.advance(0.02, normal_force=100.0, speed=0.3, shoe_angle=0.06)
    said |= {
        "runs": runs,
        "rows": [one.area_rows() for one in runs],
        "pressures": [array_pressures(one.motion, one.maps, array) for one in runs],
        "seen": [
            observe_slip(one.motion, array_pressures(one.motion, one.maps, array), array)
            for one in runs
        ],
        "shape": shape,
        "maps": shape.maps(runs[1].motion),
        "none": pressure_shape([], 0.1).parts.shape,
        "foot": (at.fluid_load, at.usable, [at.friction(v) for v in (0.0, 1e-4, 1e-3, 0.3)]),
        "map": sensor_map(at.state, 2e-3),
        "settled": foot.settle_load(normal_force=100.0, speed=0.3).fluid_load,
        "area": pressed_area(np.array([1e5, 2e5]), np.array([1e5, 3e5]), 1e-3),
        "no area": pressed_area(np.zeros(2), np.zeros(2), 1e-3),
    }
    held(file_regression, said)


def test_where_a_fit_starts(file_regression, monkeypatch, wet):
    """A fit looks from each start at the same errors; least squares itself is left out."""
    said: dict[str, Any] = {"looks": []}

    def only_looks(residual, z, bounds, **how):
        seen = residual(z)
        said["looks"].append((z, how, seen))
        said["bounds"] = bounds
        return SimpleNamespace(x=z, cost=float(np.sum(seen**2)))

    monkeypatch.setattr(scipy.optimize, "least_squares", only_looks)
    setting = slip_setting(wet)
    runs = [slippery_sole().motion(Walker(step(), heel_speed=0.2 + 0.2 * k)) for k in range(3)]
    areas = [(20.0, 0.1, 1e-4), (100.0, 0.1, 3e-4), (300.0, 0.15, 5e-4), (500.0, 0.12, 6e-4)]
    fit = fitted_reduced(setting, runs, runs[:1], areas)
    said |= {"constants": fit.sole.constants.tolist(), "fit": fit, "dry": fitted_reduced(
        replace(setting, viscosity=None), runs, [], areas[1:])}  # fmt: skip
    said["edges"] = at_bounds(np.array([0.0, 0.0009, 0.5, 0.9991]), np.zeros(4), np.ones(4))
    held(file_regression, said)


def told(study: SlipStudy) -> dict[str, Any]:
    """Return what a study answers."""
    return {
        "numbers": study.numbers(),
        "shares": {name: np.round(each, 9) for name, each in study.shares().items()},
        "slipped": study.slip_share(),
        "rows": study.rows(),
        "start": study.slip_start(),
        "passages": study.sensor_passages(),
        "correlation": study.correlation(),
        "highest": study.highest_seen(),
        "mean": study.mean("duration", "s"),
        "speeds": study.peak_speed_at(heel_brake="none"),
        "fit": study.fit,
        "error": study.pressure_error,
        "breaches": study.breaches,
        "failed": study.failed,
        "full": study.full,
        "seen": [one.seen for one in study.subjects],
        "draws": study.by_friction and {
            "nearest": study.by_friction.nearest, "cof": study.by_friction.cof,
            "means": study.by_friction.means("peak_speed", 3),
            "crossed": study.by_friction.means("peak_speed", 3, crossed=True),
        },
    }  # fmt: skip


def test_studies_of_slips(file_regression, wet, tmp_path):
    dry = wet.replace({"contaminant": "none"})
    said = {"dry": told(slips(dry, subjects=4))}
    people = replace(slip_population(wet, subjects=3), mass=Spread(25, 3, 20, 30))
    full = slip_study(slip_setting(wet), people, full=True, step=0.03, cache=Cache("a", tmp_path))
    said["full"] = told(full)
    said["no reduced"] = refusal(full.at_contact_friction, 1.1), full.at_friction_draws()
    held(file_regression, said)
    assert isinstance(slips(dry, subjects=2).by_friction, FrictionDraws | None)
    assert isinstance(slippery_sole(), ReducedSole)
