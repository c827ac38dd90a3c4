"""Small steps of a run by their values: rates beyond a compound's test, what is cut off a sole."""

import math
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import load
from underfoot.compute import read, sole, solve
from underfoot.compute.prepare import prepared
from underfoot.compute.resolve import _untested_rates
from underfoot.compute.sole import trimmed
from underfoot.core import SourcedValue
from underfoot.film import NewtonianFilm
from underfoot.friction.film_shear import FilmShearLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact.solver import SolverSettings

HEEL = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


def with_compound(speed: float, slowest: float | None, fastest: float | None) -> Any:
    material = SimpleNamespace(relaxation=object(), slowest_tested=slowest, fastest_tested=fastest)
    return SimpleNamespace(
        shoe=SimpleNamespace(material=material), motion=SimpleNamespace(speed=speed)
    )


@pytest.mark.parametrize("speed", [0.5, -0.5])
def test_asperities_work_the_rubber_at_rates_of_the_waves_of_a_stylus(speed):
    least, most = (2 * math.pi * 0.5 / wave for wave in (0.8e-3, 2.5e-6))
    (breach,) = _untested_rates(with_compound(speed, None, 1e5))
    assert (breach.low, breach.high) == pytest.approx((least, most))
    assert (breach.range.low, breach.range.high) == (0.0, 1e5)
    assert _untested_rates(with_compound(speed, None, 1.001 * most)) == []
    assert _untested_rates(with_compound(speed, 0.999 * least, 1.001 * most)) == []
    assert len(_untested_rates(with_compound(speed, 1.001 * least, 1.001 * most))) == 1
    assert _untested_rates(with_compound(speed, 1.0, None)) == []


def sloping() -> SoleMap:
    """Return a sole of 20 x 12 cells of 1 mm, 0.1 mm higher with each row; its sides are out."""
    x, y = 1e-3 * np.arange(20), 1e-3 * np.arange(12)
    inside = np.zeros((20, 12), bool)
    inside[:, 3:9] = True
    clearance = np.where(inside, 1e-4 * np.arange(20)[:, None], np.inf)
    depth = np.zeros((20, 12))
    return SoleMap(x, y, clearance, inside, inside.copy(), depth, 1e-3, np.zeros((4, 2)))


@pytest.mark.parametrize(
    ("padding", "rows", "columns"), [(2e-3, 8, (1, 11)), (2.5e-3, 9, (0, 12)), (0.0, 7, (2, 10))]
)
def test_a_trimmed_sole_keeps_what_comes_within_reach_and_its_padding(padding, rows, columns):
    whole = sloping()
    part = trimmed(whole, 5.5e-4, padding=padding)  # rows 0 to 5 stand that low
    np.testing.assert_array_equal(part.x, whole.x[:rows])
    np.testing.assert_array_equal(part.y, whole.y[slice(*columns)])
    cut = (slice(rows), slice(*columns))
    for name in ("clearance", "inside", "land", "tread_depth"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[cut])
    assert part.whole is whole


def test_a_sole_that_rolls_keeps_what_any_angle_brings_down():
    whole = sloping()
    flat = math.atan(-0.1)  # toe down by the slope of the sole: every row lies on the floor
    assert trimmed(whole, 5.5e-4, flat).x.size == 20
    assert trimmed(whole, 5.5e-4, cast(Any, [0.0, flat])).x.size == 20
    assert trimmed(whole, 5.5e-4, 0.0).x.size == 10  # 6 rows and 4 of padding


@dataclass(frozen=True)
class HalfSheared:
    """A film that shears its walls half as much as a Newtonian one."""

    viscosity: float
    name: str = "half_sheared"
    source: str = "made for this test"

    def flow_factor(self, gap, speed):
        return np.ones_like(gap), np.zeros_like(gap)

    def shear(self, speed, film_thickness):
        return 0.5 * self.viscosity * np.asarray(speed) / np.asarray(film_thickness)


def test_only_a_film_of_another_shear_takes_the_place_of_eta_v_over_h():
    case = load(HEEL)
    viscosity, at = 0.2, ([1e5], 0.5, [2e-5])

    first = prepared(case, 4e-3, {"film": NewtonianFilm(viscosity)})

    def law_with(film):
        return prepared(case, 4e-3, {"film": film}, geometry=(first.sole, first.compliance)).law

    plain = first.law
    assert not isinstance(plain, FilmShearLaw)
    assert not isinstance(law_with(None), FilmShearLaw)
    halved = law_with(HalfSheared(viscosity))
    assert halved(*at).viscous == pytest.approx(0.5 * viscosity * 0.5 / 2e-5)
    assert halved(*at).adhesion == pytest.approx(plain(*at).adhesion)


@pytest.mark.parametrize("history", [False, True])
def test_a_motion_is_solved_in_as_many_steps_as_are_asked_for_and_by_default_in_its_own(
    monkeypatch, history
):
    case, taken = load(HEEL), []
    motion = SimpleNamespace(
        **dict.fromkeys(("shoe_angle", "sliding_speed", "normal_force", "end_time"), 1.0),
        force_rise_time=0.1, start_film=None, build=lambda: "history" if history else None,
    )  # fmt: skip
    parts: Any = SimpleNamespace(
        case=SimpleNamespace(motion=motion, contaminant=None, numerics=case.numerics), sole=None,
        compliance=None, asperities=None, viscosity=0.1, film=None, local_law=None,
    )  # fmt: skip
    for name in ("solve_history", "solve_sliding"):
        monkeypatch.setattr(
            solve, name, lambda *_, settings, name=name, **__: taken.append((name, settings))
        )
    solve.solved_motion(parts)
    for finer in (1, 2, 3):
        solve.solved_motion(parts, finer=finer)
    assert {name for name, _ in taken} == {"solve_history" if history else "solve_sliding"}
    steps = [settings.time_resolution for _, settings in taken]
    own = SolverSettings().time_resolution * (solve.HISTORY_FINER if history else 1)
    assert steps == pytest.approx([own, own, 2 * own, 3 * own])


@pytest.mark.parametrize(("degrees", "angles"), [(6.0, [7, 10, 13]), (0.0, [10])])
def test_a_sole_is_worn_step_by_step_at_its_angle_and_half_the_range_to_either_side(
    monkeypatch, degrees, angles
):
    wear = {"mode": "archard", "angle": "10 deg", "angle_range": f"{degrees} deg"}
    depth = 2.5 * sole.WEAR_STEP
    case = load(HEEL).replace("shoe.wear", {**wear, "depth": f"{depth} m"})
    calls = []

    def wears(new, *, angles, depth, begin, **_):
        calls.append((np.degrees(angles), depth, begin))
        worn = SimpleNamespace(x=np.zeros(1), y=np.zeros(1), removed=np.zeros((1, 1)))
        return SimpleNamespace(worn=worn, sliding_distance=depth)

    store = SimpleNamespace(load=lambda _: None, store=lambda *_: None)
    monkeypatch.setattr(sole, "archard_wear", wears)
    monkeypatch.setattr(sole, "Cache", lambda _: store)
    end = sole.archard_state(case)
    assert end.sliding_distance == pytest.approx(depth)
    step = sole.WEAR_STEP
    assert [each for _, each, _ in calls] == pytest.approx([step, 2 * step, depth])
    assert calls[0][2] is None
    assert [begin.sliding_distance for *_, begin in calls[1:]] == pytest.approx([step, 2 * step])
    for each, *_ in calls:
        assert each == pytest.approx(angles)


@pytest.mark.parametrize("depth", [0.0, 1e-3])
@pytest.mark.parametrize(
    ("shift", "yaw", "moves"),
    [
        ((0.0, 0.0), 0.0, False),
        ((1e-3, 0.0), 0.0, True),
        ((0.0, -1e-3), 0.0, True),
        ((0.0, 0.0), 0.1, True),
    ],
)
def test_a_tread_of_a_file_is_moved_and_turned_where_that_is_asked_and_then_worn(
    monkeypatch, depth, shift, yaw, moves
):
    def moved(surface, by, periods, *, yaw, pivot):
        return f"{surface} by {by} of {periods} and {yaw} about {pivot}"

    fakes = {
        "file_outsole": lambda _: SimpleNamespace(surface="new"), "file_periods": lambda _: 9,
        "landing_front": lambda _: 0.05, "worn_surface": lambda surface, by: f"{surface}, {by}",
    }  # fmt: skip
    for name, fake in fakes.items():
        monkeypatch.setattr(sole, name, fake)
    monkeypatch.setattr("underfoot.shoe.tread_shift.moved_tread", moved)
    wear = SimpleNamespace(depth=depth, build=lambda: "worn")
    case: Any = SimpleNamespace(shoe=SimpleNamespace(wear=wear))
    surface: Any = sole.file_surface(case, shift, yaw)
    where = f"new by {shift} of 9 and {yaw} about (0.05, 0.0)" if moves else "new"
    assert surface == where + (", worn" if depth else "")


def test_the_error_of_a_run_is_spread_about_its_own_cof(monkeypatch):
    class Asked(Exception):
        pass

    def asked(sampled, error, *, cof, sole):
        raise Asked(sampled, error, cof, sole)

    errors = read.NumericalErrors.__new__(read.NumericalErrors)
    monkeypatch.setattr(read.NumericalErrors, "deviation", lambda _, name: {"cof": 0.01}[name])
    monkeypatch.setattr(read, "numerical_errors", lambda *_, **__: errors)
    monkeypatch.setattr(read, "overload_breaches", lambda *_: [])
    monkeypatch.setattr(read, "with_numerical_error", asked)
    monkeypatch.setattr(read.numbers, "sole_name", lambda _: "a")
    friction = SimpleNamespace(sums=SimpleNamespace(cof=SourcedValue(0.12, "1")), sampled="draws")
    contact = SimpleNamespace(status=SimpleNamespace(usable=True))
    parts: Any = SimpleNamespace(case=None, context=SimpleNamespace(youngs_modulus=5e6))
    solution: Any = SimpleNamespace(contact=contact, friction=friction)
    with pytest.raises(Asked) as told:
        read.readings(parts, solution, None, quick=True)
    assert told.value.args == ("draws", 0.01, 0.12, "a")
