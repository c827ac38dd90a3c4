"""Where a fit of the reduced slip begins, what it makes small, and what it ends with."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.optimize

from slip_floors import slippery_sole, walker
from underfoot.core import InputError
from underfoot.friction import FrictionParts
from underfoot.rough_contact import ExponentialLaw
from underfoot.slip.dynamics import GaitHistory, reduced_model
from underfoot.slip.dynamics._kernels import reduced as kernel
from underfoot.slip.dynamics.reduced_model import (
    NAMES,
    POINTS,
    SIGNED,
    STARTS,
    FittedRange,
    _residual,
    at_bounds,
    fitted_reduced,
)

AREA = (1.5e-3, 0.4, 2.0)
ANGLE = float(np.radians(10))
FREE = [k for k in range(kernel.COUNT) if k > kernel.AREA_ANGLE]


class Law:
    """Friction that falls with speed."""

    def __call__(self, pressure, speed, film):
        return FrictionParts(0.2 / (1 + speed) * pressure, 0.05 * pressure, 0 * pressure)


def setting(viscosity: float | None = 0.219, edged=None) -> Any:
    return SimpleNamespace(
        friction=Law(), viscosity=viscosity, shoe_angle=ANGLE, edged=edged,
        settings=SimpleNamespace(pool_depth=6e-4, start_film=1e-4),
        asperities=ExponentialLaw(2e6, 0.5, 4e-6),
    )  # fmt: skip


def slips(count):
    time = np.linspace(0, 0.3, 31)
    made = []
    for k in range(count):
        history = GaitHistory("h", time, 0.6 + 0.1 * k + time, 0.1 + 0.3 * time)
        person = walker(history, history.rcof, heel_speed=0.4 + 0.1 * k, shoe_angle=ANGLE)
        made.append(slippery_sole().motion(person))
    return made


def areas():
    return [(load, angle, AREA[0] * (load / 500) ** AREA[1] * math.exp(AREA[2] * (angle - ANGLE)))
            for load in (200.0, 400.0, 900.0) for angle in (0.1, 0.2)]  # fmt: skip


def in_place(values):
    """Return constants as the fit moves them: logarithms but of those that may turn their sign."""
    return np.array([values[k] if k in SIGNED else math.log(values[k]) for k in FREE])


@pytest.fixture
def fitted(monkeypatch):
    asked, told = [], []
    costs = iter([5.0, 2.0, 9.0, 3.0, 1.0])

    def least_squares(residual, x0, **more):
        asked.append((residual, np.array(x0), more))
        moved = np.array(x0) + 0.01 * len(asked)
        if len(asked) == len(STARTS) + 1:  # the last drives one to its bound
            moved[NAMES.index("length") - 3] = more["bounds"][1][NAMES.index("length") - 3]
        return SimpleNamespace(x=moved, cost=next(costs))

    monkeypatch.setattr(scipy.optimize, "least_squares", least_squares)
    runs, apart = slips(3), slips(4)[3:]

    def progress(stage: str, fraction: float, residual: float | None = None) -> None:
        told.append((stage, fraction, residual))

    fit = fitted_reduced(setting(), runs, apart, areas(), progress=progress)
    return fit, asked, told, runs, apart


def test_a_fit_begins_from_four_places_and_goes_on_from_the_best(fitted):
    fit, asked, told, *_ = fitted
    pressure, side = 500 / AREA[0], math.sqrt(AREA[0])
    guess = dict(zip(NAMES, [
        *AREA, 5 * pressure, 2e-6, 12 * 2.4 / AREA[0], 0.0, 30.0, 0.0, side, 1e-4, 1.0, 0.0, 0.0,
    ], strict=True))  # fmt: skip
    assert len(asked) == len(STARTS) + 1
    for (_, x0, more), (leak, decay, wedge) in zip(asked, STARTS, strict=False):
        start = guess | {"leak": leak * guess["leak"], "decay": decay * guess["decay"],
                         "wedge": wedge * guess["wedge"]}  # fmt: skip
        assert x0 == pytest.approx(in_place([start[name] for name in NAMES]), abs=2e-6)
        assert more["max_nfev"] == reduced_model.FIRST_LOOK
    _, last, more = asked[-1]
    assert last == pytest.approx(asked[1][1] + 0.02)  # of the least cost
    assert more["max_nfev"] == reduced_model.POLISH
    low, high = more["bounds"]
    values = {name: (low[k], high[k]) for k, name in enumerate(NAMES[3:])}
    assert values["leak"] == pytest.approx(
        (math.log(guess["leak"] * 1e-3), math.log(guess["leak"] * 1e3))
    )
    assert values["decay"] == pytest.approx(
        (math.log(guess["decay"] / 20), math.log(guess["decay"] * 20))
    )
    assert values["length"] == pytest.approx((math.log(side / 30), math.log(side * 30)))
    assert values["start_film"] == pytest.approx((math.log(1e-6), math.log(6e-4)))
    assert values["shear"] == pytest.approx((math.log(0.05), math.log(20)))
    assert values["leak_angle"] == values["wedge_angle"] == (-40, 40)
    assert values["leak_bend"] == values["wedge_bend"] == (-400, 400)
    assert [share for _, share, _ in told] == pytest.approx([0, 0.15, 0.3, 0.45, 0.6])
    wanted = last + 0.05
    constants = np.array([fit.sole.constants[k] for k in FREE])
    free = [k for k, name in enumerate(NAMES[3:]) if name != "length"]
    assert in_place(fit.sole.constants)[free] == pytest.approx(wanted[free])
    assert constants[NAMES.index("length") - 3] == pytest.approx(side * 30)
    assert fit.at_bound == ("length",)
    assert fit.sole.constants[:3] == pytest.approx(AREA)


def test_a_fit_makes_small_what_its_runs_and_it_differ_by(fitted):
    fit, asked, _, runs, apart = fitted
    residual, x0, _ = asked[0]
    found = residual(x0)
    assert found.size == 2 * POINTS * len(runs)
    blank = fit.sole.constants.copy()
    blank[FREE] = [v if k in SIGNED else math.exp(v) for k, v in zip(FREE, x0, strict=True)]
    again: Any = reduced_model.replace(fit.sole, constants=blank, fitted=None)
    assert found == pytest.approx(_residual(again, runs))
    run = runs[1]
    at = np.unique(np.linspace(1, run.time.size - 1, POINTS).astype(int))
    fluid, _ = again.carried_at(run)
    share = (fluid[at] - run.fluid_load[at]) / np.maximum(run.normal[at], 30) / math.sqrt(POINTS)
    assert found[2 * POINTS : 3 * POINTS] == pytest.approx(share)
    motion = again.motion(run.walker, step=1e-3)
    speed = np.interp(run.time[at], motion.time, motion.speed, right=0.0)
    apart_by = (speed - run.speed[at]) / 0.2 / math.sqrt(POINTS)
    assert found[3 * POINTS : 4 * POINTS] == pytest.approx(apart_by)
    assert np.abs(_residual(slippery_sole(), runs)).max() < 0.05
    assert fit.sole.fitted == FittedRange.of(0.219, [*runs, *apart])
    assert (fit.fitted.runs, fit.held_out.runs) == (3, 1)
    speeds = fit.sole.speeds
    assert fit.sole.cofs == pytest.approx(0.2 / (1 + np.maximum(speeds, 1e-3)) + 0.05)


def test_edges_of_lugs_raise_the_friction_of_a_fit_and_a_dry_one_needs_none(monkeypatch):
    monkeypatch.setattr(scipy.optimize, "least_squares", None)
    asked = []

    def factor(pressure, speed):
        asked.append((pressure, speed))
        return 2.0

    runs = slips(3)
    for run in runs:
        run.fluid_load[:] = 0
    edged = SimpleNamespace(mean_factor=factor)
    fit = fitted_reduced(setting(None, edged), runs, [], areas())
    assert fit.sole.cofs == pytest.approx(
        2 * (0.2 / (1 + np.maximum(fit.sole.speeds, 1e-3)) + 0.05)
    )
    assert [pressure for pressure, _ in asked] == pytest.approx([500 / AREA[0]] * len(asked))
    assert min(speed for _, speed in asked) == 1e-3
    assert fit.at_bound == ()
    assert math.isnan(fit.held_out.speed)
    for few in ((runs[:2], areas()), (runs, areas()[:2])):
        with pytest.raises(InputError, match="3 or more"):
            fitted_reduced(setting(None), few[0], [], few[1])


def test_what_lies_within_a_thousandth_of_a_bound_is_stuck():
    low, high = np.zeros(4), np.full(4, 10.0)
    values = np.array([0.009, 0.011, 9.989, 9.991])
    assert at_bounds(values, low, high).tolist() == [True, False, False, True]
