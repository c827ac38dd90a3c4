"""Coverage of each kind of interval that a page prints, on made-up worlds whose truth is known.

Each world is drawn from a seed, measured or computed with the error that the interval speaks of,
and counted where it holds the truth. Bounds are those of the binomial law with a tail of 1e-4 at
each side, of what the interval says itself; where its method is an approximation, of two percent
less and more. That the count can fail is part of the test: of the same worlds, intervals of half
and of twice the width do not hold what they say.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from scipy.stats import binom, norm

from underfoot.calibrate import Parameter, calibrate_model
from underfoot.compute.numbers import GRID_NAMES, with_film_spread
from underfoot.core import SourcedValue
from underfoot.explore.inputs import Range
from underfoot.explore.surrogate import fit_surrogate
from underfoot.friction.propagation import propagate_spread
from underfoot.places.joint import PlaceDraws
from underfoot.places.joint import interval as interval_of_draws
from underfoot.places.machines import FLUIDS, machine
from underfoot.slip import Chang2004, RcofPopulation, slip_risk
from underfoot.trials.statistics import (
    bland_altman,
    intraclass_correlation,
    mean_interval,
    share_interval,
)

TAIL = 1e-4


class Told(NamedTuple):
    """What is true, what a page prints, and the ends of its interval."""

    truth: float
    value: float
    low: float
    high: float

    def holds(self, width: float = 1.0) -> bool:
        low, high = (self.value + width * (end - self.value) for end in (self.low, self.high))
        return low <= self.truth <= high


def mean_of_readings(rng, confidence):
    values = rng.normal(0.2, 0.03, 8)
    return Told(0.2, values.mean(), *mean_interval(values, confidence=confidence))


def mean_of_what_is_above_zero(rng, confidence):
    values = rng.lognormal(0.0, 0.15, 8)
    ends = mean_interval(values, positive=True, confidence=confidence)
    return Told(math.exp(0.15**2 / 2), values.mean(), *ends)


def share_of_slips(rng, confidence):
    """Of persons who differ: three trials each of 24."""
    own = rng.beta(2.0, 4.0, 24)
    slips = rng.binomial(3, own)
    ends = share_interval(slips, np.full(24, 3), confidence=confidence)
    return Told(2 / 6, slips.sum() / 72, *ends)


def consistency_of_machines(rng, confidence):
    values = rng.normal(0, 1.0, (15, 1)) + rng.normal(0, 0.7, (15, 3)) + [0.0, 0.4, -0.2]
    found = intraclass_correlation(values, "ICC(C,1)", confidence=confidence)
    return Told(1 / (1 + 0.7**2), found.value, found.low, found.high)


def agreement_of_machines(rng, confidence):
    """Machines are drawn too."""
    values = rng.normal(0, 1.0, (20, 1)) + rng.normal(0, 0.3, (1, 6)) + rng.normal(0, 0.5, (20, 6))
    found = intraclass_correlation(values, "ICC(A,1)", confidence=confidence)
    return Told(1 / (1 + 0.3**2 + 0.5**2), found.value, found.low, found.high)


def upper_limit_of_agreement(rng, confidence):
    who = np.repeat(np.arange(12), 2)
    apart = rng.normal(0, 1, 12)[who] + rng.normal(0, 0.7, 24)
    found = bland_altman(apart, np.zeros(24), who, confidence=confidence)
    return Told(1.96 * math.sqrt(1.49), found.upper, *found.upper_interval)


def bias_of_two_machines(rng, confidence):
    apart = rng.normal(0.03, 0.02, 10)
    found = bland_altman(apart, np.zeros(10), confidence=confidence)
    return Told(0.03, found.bias, *found.bias_interval)


def calibrated_parameter(rng, confidence):
    x = np.linspace(0.0, 1.0, 12)
    start = {name: Parameter(0.5, -10.0, 10.0) for name in ("start", "slope")}
    data = 0.3 - 1.7 * x + rng.normal(0, 0.05, x.size)
    found = calibrate_model(lambda v: v["start"] + v["slope"] * x, data, start, deviation=0.05)
    slope = found.parameters["slope"]
    reach = norm.ppf(0.5 + confidence / 2) * slope.uncertainty
    return Told(-1.7, slope.value, slope.value - reach, slope.value + reach)


def cof_of_its_inputs(rng, confidence):
    """Two inputs that were measured, one above zero and wide, and the law's own error."""

    def law(inputs):
        return 0.1 + 0.5 * inputs["roughness"] + 0.3 * inputs["hardness"]

    spread = {"roughness": 0.02, "hardness": 0.05}
    measured = {
        name: SourcedValue(0.5 + rng.normal(0, sd), uncertainty=sd) for name, sd in spread.items()
    }
    truth = law({"roughness": 0.5, "hardness": 0.5}) + rng.normal(0, 0.01)
    told = propagate_spread(
        law, measured, model_deviation=0.01, confidence=confidence, samples=400,
        seed=int(rng.integers(1 << 30)), shares=False,
    )  # fmt: skip
    return Told(truth, float(told.value), float(told.low), float(told.high))


def chance_of_a_slip(rng, confidence):
    """COF was measured with a known spread; a step slips by the people's need alone."""
    model, people = Chang2004(), RcofPopulation(0.2, 0.03, "made up")
    acof = SourcedValue(0.22 + rng.normal(0, 0.02), uncertainty=0.02)
    found = slip_risk(acof, rcof=people, model=model)
    truth = float(model.population(0.22, people.mean, people.sd))
    return Told(truth, found.at_best_estimate, found.low, found.high)


def of_the_film(name):
    def told(rng, confidence):
        """The odds of the film's share err by a factor known to 41 %; the grid's error beside."""
        sd, whole, share = 0.34, 500.0, 0.4
        odds = math.log(share / (1 - share)) + rng.normal(0, sd)
        computed = 1 / (1 + math.exp(-odds))
        grid = {"fluid_load_sensor": 0.1, "peak_fluid_pressure": 0.3}.get(name, 0.0)
        scale = math.exp(rng.normal(0, grid)) if grid else 1.0
        true = dict.fromkeys(GRID_NAMES[1:], 2.0 * whole * share) | {"fluid_load": whole * share}
        values = {
            one: SourcedValue(number * computed / share * scale, uncertainty=None)
            for one, number in true.items()
        } | {"normal_force": SourcedValue(whole)}
        values["fluid_load"] = SourcedValue(whole * computed)
        if grid:
            own = values[name]
            values[name] = SourcedValue(own.value, uncertainty=grid * own.value)
        found = with_film_spread(values, rng.normal(0, sd, 2000))[name]
        return Told(true[name], found.value, *found.interval)

    return told


@cache
def readings_of_worlds():
    """Return a machine's readings of 1,000 worlds, and what is foretold of them."""
    device, span = machine("pendulum-96"), (0.3e-6, 20e-6)
    worlds, told = (
        device.draw_readings(PlaceDraws(count=count, seed=seed), "hall", span, FLUIDS["water"])
        for count, seed in ((1000, 11), (4000, 12))
    )
    return iter(worlds.tolist()), interval_of_draws(told)


def reading_of_a_machine(rng, confidence):
    worlds, (low, middle, high) = readings_of_worlds()
    return Told(next(worlds), middle, low, high)


@cache
def surrogate_of_runs():
    rng = np.random.default_rng(3)
    points = rng.random((60, 2))

    def runs(places):
        true = np.sin(5 * places[:, 0]) + places[:, 1] ** 2
        return true + rng.normal(0, 0.05, len(places))

    one = fit_surrogate(
        "cof", "1", (Range("a", 0.0, 1.0), Range("b", 0.0, 1.0)), points, runs(points)
    )
    fresh = rng.random((1000, 2))
    mean, deviation = one.prediction(fresh)
    return iter(zip(runs(fresh), mean, deviation, strict=True))


def run_foretold_by_a_surrogate(rng, confidence):
    truth, mean, deviation = next(surrogate_of_runs())
    reach = norm.ppf(0.5 + confidence / 2) * deviation
    return Told(truth, mean, mean - reach, mean + reach)


class Kind(NamedTuple):
    """A kind of interval: how a world is told, at which confidences, and by how much it may err."""

    told: Callable[..., Told]
    confidences: tuple[float, ...] = (0.5, 0.95)
    allowance: float = 0.0


KINDS = {
    "mean of readings": Kind(mean_of_readings),
    "mean above zero": Kind(mean_of_what_is_above_zero, allowance=0.02),
    "slip share": Kind(share_of_slips, allowance=0.02),
    "consistency": Kind(consistency_of_machines),
    "agreement": Kind(agreement_of_machines, allowance=0.02),
    "upper limit": Kind(upper_limit_of_agreement, allowance=0.02),
    "bias": Kind(bias_of_two_machines),
    "calibration": Kind(calibrated_parameter),
    "COF": Kind(cof_of_its_inputs, allowance=0.01),  # of 400 draws
    "slip probability": Kind(chance_of_a_slip, (0.95,)),
    "load on the film": Kind(of_the_film("fluid_load"), (0.95,)),
    "sensor's load": Kind(of_the_film("fluid_load_sensor"), (0.95,)),
    "peak": Kind(of_the_film("peak_fluid_pressure"), (0.95,)),
    "machine's reading": Kind(reading_of_a_machine, (0.95,)),
    "surrogate": Kind(run_foretold_by_a_surrogate, (0.95,), allowance=0.02),
}


@pytest.mark.parametrize("name", KINDS)
def test_an_interval_holds_the_truth_as_often_as_it_says(name):
    kind, worlds = KINDS[name], 400
    for confidence in kind.confidences:
        rng = np.random.default_rng([7, round(100 * confidence)])
        told = [kind.told(rng, confidence) for _ in range(worlds)]

        def held(width, told=told):
            return sum(one.holds(width) for one in told)

        least = binom.ppf(TAIL, worlds, confidence - kind.allowance)
        most = binom.ppf(1 - TAIL, worlds, confidence + kind.allowance)
        print(f"{name}, {confidence:.0%}: {held(1)} of {worlds}; half {held(0.5)}, twice {held(2)}")
        assert least <= held(1.0) <= most
        assert held(0.5) < least
        assert held(2.0) > most
