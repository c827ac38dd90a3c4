"""Surrogates, indices, fronts and the order of designs, on functions whose answers are known."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

from underfoot.case import load
from underfoot.core import DataError, RangeError
from underfoot.explore.effects import effects
from underfoot.explore.inputs import Choice, Distribution, Range
from underfoot.explore.proposals import next_batch
from underfoot.explore.record import Ending, Record
from underfoot.explore.result import StudyResult
from underfoot.explore.study_file import read_plan
from underfoot.explore.surrogate import Model, Runs, Surrogate, fit_surrogate
from underfoot.friction.propagation import probability_higher

DEPTH = Range("shoe.tread.depth", 1e-3, 4e-3)
SPEED = Range("motion.speed", 0.1, 1.0, True)
PATTERN = Choice("shoe.tread.pattern", ("grid", "hexagons", "transverse"))


def bend(x):
    return np.sin(3 * x[:, 0]) + x[:, 1] ** 2 + 0.5 * (x[:, 2] > 2 / 3)


@pytest.fixture(scope="module")
def model():
    points = qmc.Sobol(3, rng=1).random(64)
    return fit_surrogate("cof", "1", (DEPTH, SPEED, PATTERN), points, bend(points))


@settings(max_examples=30, deadline=None)
@given(st.floats(0.5, 3), st.floats(1.05, 2))
def test_quantiles_of_distributions_are_those_of_their_names(median, factor):
    one = Distribution("x", "lognormal", median, factor)
    assert one.value(0.5) == pytest.approx(median)
    sample = np.log([one.value(share) for share in np.linspace(0.0005, 0.9995, 1000)])
    assert np.std(sample) == pytest.approx(math.log(factor), rel=0.03)
    assert Distribution("x", "lognormal", median, factor, high=median).value(0.9) == median


def test_what_was_left_out_was_predicted_without_it(model):
    """A run that is far from all others moves the model, not its own prediction."""
    values = model.runs.values.copy()
    values[17] += 50.0
    other = fit_surrogate("cof", "1", model.dimensions, model.runs.points, values)
    assert other.error > 50.0 / np.sqrt(64) * 0.9
    assert other.q2 < 0.1


def smooth(x):
    return 0.2 * np.exp(0.6 * x[:, 0] - 0.5 * x[:, 1] * x[:, 2] + 0.2 * x[:, 3] ** 2)


def wavy(x):
    return 2 + np.sin(5 * x[:, 0]) + x[:, 1] ** 2 + 0.5 * np.cos(7 * x[:, 2] * x[:, 3])


def stepped(x):
    return 1 + 0.5 * np.tanh(8 * (x[:, 0] - 0.4)) * x[:, 1] + 0.2 * x[:, 2] + 0 * x[:, 3]


@pytest.mark.slow
@pytest.mark.parametrize(("function", "noise"), [(smooth, 0.01), (wavy, 0.1), (stepped, 0.03)])
@pytest.mark.parametrize("tells", [True, False])
def test_stated_errors_are_those_of_fresh_runs(function, noise, tells):
    """Five splits: 60 runs fitted, 50 held out; noise differs from run to run, which tells it."""
    stated, held, inside = [], [], []
    four = tuple(Range(f"p{k}", 0.0, 1.0) for k in range(4))
    for seed in range(5):
        generator = np.random.default_rng(seed)
        points = generator.random((110, 4))
        errors = noise * np.exp(0.5 * generator.standard_normal(110))
        values = function(points) + errors * generator.standard_normal(110)
        stated_errors = 2 * errors[:60] if tells else None  # half of it is common to all runs
        one = fit_surrogate("cof", "1", four, points[:60], values[:60], stated_errors)
        mean, deviation = one.prediction(points[60:])
        rest = values[60:] - mean
        stated.append(one.q2)
        held.append(1 - np.sum(rest**2) / np.sum((values[60:] - values[60:].mean()) ** 2))
        inside.append(np.mean(np.abs(rest) < 1.96 * deviation))
    assert np.median(np.subtract(stated, held)) == pytest.approx(0, abs=0.05)
    assert 0.92 < np.mean(inside) < 0.98  # 93 to 97 % and what 250 runs leave open


@pytest.mark.slow
def test_a_run_counts_by_its_noise():
    """A third of the runs are noisy; where they say so, the mean is nearer to the truth."""
    points, fresh = qmc.Sobol(2, rng=5).random(64), qmc.Sobol(2, rng=6).random(256)
    true = np.sin(4 * fresh[:, 0]) + fresh[:, 1]
    errors = np.where(np.arange(64) % 3 == 0, 0.5, 0.02)
    missed, inside = [], []
    for seed in range(3):
        noise = errors * np.random.default_rng(seed).standard_normal(64)
        values = np.sin(4 * points[:, 0]) + points[:, 1] + noise
        blind, told = (
            fit_surrogate("cof", "1", (DEPTH, SPEED), points, values, one) for one in (None, errors)
        )
        missed.append([np.mean((one.mean(fresh) - true) ** 2) for one in (blind, told)])
        deviation = told.prediction(fresh, noise=False)[1]
        inside.append(np.abs(true - told.mean(fresh)) < 1.96 * deviation)
    blind, told = np.mean(missed, axis=0)
    assert told < 0.5 * blind
    assert np.mean(inside) > 0.9


def test_runs_on_a_finer_grid_move_the_surrogate_to_it():
    points, fresh = qmc.Sobol(2, rng=7).random(64), qmc.Sobol(2, rng=8).random(64)
    again = np.vstack([points, points[::8]])
    finer = np.arange(72) >= 64
    values = np.sin(4 * again[:, 0]) + again[:, 1] - 0.3 * finer
    one = fit_surrogate("cof", "1", (DEPTH, SPEED), again, values, None, finer)
    assert one.mean(fresh) == pytest.approx(np.sin(4 * fresh[:, 0]) + fresh[:, 1] - 0.3, abs=0.05)
    assert one.q2 > 0.98
    again = Surrogate.from_dict(one.to_dict(), one.dimensions)
    assert np.allclose(again.mean(fresh), one.mean(fresh))


def test_the_process_is_that_of_scikit_learn():
    from sklearn.gaussian_process import GaussianProcessRegressor, kernels

    generator = np.random.default_rng(8)
    features, fresh, noise = generator.random((40, 2)), generator.random((20, 2)), np.full(40, 0.3)
    values = np.sin(5 * features[:, 0]) + noise * generator.standard_normal(40)
    made = Model("process", features, Runs(features, values, noise, np.zeros(40, dtype=bool)))
    linear, _, matern = np.exp(2 * made.theta[:3])
    kernel = kernels.ConstantKernel(matern) * kernels.Matern(2 * np.exp(made.theta[4:]), nu=2.5)
    kernel += kernels.ConstantKernel(linear) * kernels.DotProduct(1.0)
    peer = GaussianProcessRegressor(kernel, alpha=made.noise, optimizer=None)
    peer.fit(2 * features - 1, (values - made.level) / made.scale)
    mean, deviation = peer.predict(2 * fresh - 1, return_std=True)
    assert made.mean(fresh) == pytest.approx(made.level + made.scale * mean, abs=1e-5)
    without = made.prediction(fresh, noise=False)[1]
    assert without == pytest.approx(made.scale * deviation, rel=1e-4)
    assert made.prediction(fresh)[1] ** 2 == pytest.approx(
        without**2 + made.scale**2 * made.noise, rel=1e-9
    )
    drawn = made.joint_draws(fresh, generator.standard_normal((4000, 20)))
    assert drawn.mean(axis=0) == pytest.approx(made.mean(fresh), abs=0.02)
    assert drawn.std(axis=0) == pytest.approx(without, rel=0.1)


@pytest.mark.parametrize("share", [0.3, 1.0, 2.0])
def test_how_much_of_the_stated_error_is_noise_is_learned(share):
    generator = np.random.default_rng(9)
    features = generator.random((80, 2))
    errors = np.exp(0.5 * generator.standard_normal(80)) * 0.1
    values = np.sin(5 * features[:, 0]) + share * errors * generator.standard_normal(80)
    made = Model("process", features, Runs(features, values, errors, np.zeros(80, dtype=bool)))
    assert math.exp(made.theta[3]) == pytest.approx(share, rel=0.25)


def test_the_form_is_that_of_the_function():
    points = qmc.Sobol(2, rng=4).random(32)
    two = (DEPTH, SPEED)
    power = fit_surrogate("cof", "1", two, points, np.exp(points[:, 0] - 2 * points[:, 1]))
    waves = fit_surrogate(
        "cof", "1", two, points, np.sin(6 * points[:, 0]) + np.cos(5 * points[:, 1])
    )
    assert power.model.form != "process"
    assert waves.model.form != "quadratic"
    assert min(power.q2, waves.q2) > 0.95


def test_indices_are_wider_where_the_surrogate_knows_less():
    halves = []
    for noise in (0.0, 0.3):
        generator = np.random.default_rng(3)

        def function(x, y, noise=noise, generator=generator):
            error = noise * generator.standard_normal()
            return {"cof": 4 + 2 * x + y + error, "rubber_volume": 1.0, "land": 1.0}

        result = played('kind = "sensitivity"\nbudget = 40', function)
        halves.append(effects(result, result.plan.goals[0]).total_half)
    assert (halves[1] > 1.5 * halves[0]).all()


def test_error_is_honest_on_new_points_and_grows_with_noise(model):
    fresh = qmc.Sobol(3, rng=2).random(256)
    true = float(np.sqrt(np.mean((model.mean(fresh) - bend(fresh)) ** 2)))
    assert true < 2 * model.error
    assert model.q2 > 0.98
    noisy = bend(model.runs.points) + np.random.default_rng(0).normal(0, 0.5, 64)
    rough = fit_surrogate("cof", "1", model.dimensions, model.runs.points, noisy)
    assert rough.q2 < 0.9
    assert "too much to rank designs by" in rough.reliability


def test_data_bring_the_same_surrogate_back(model):
    again = Surrogate.from_dict(model.to_dict(), model.dimensions)
    points = qmc.Sobol(3, rng=3).random(16)
    assert np.allclose(again.mean(points), model.mean(points), rtol=1e-9)


def test_a_surrogate_refuses_what_lies_outside_its_box_and_too_few_runs(model):
    mean, deviation = model.prediction(np.array([[1 / 3, 0.4, 0.1]]))
    assert deviation[0] < 0.3
    assert math.isfinite(mean[0])
    with pytest.raises(RangeError, match=r"shoe.tread.depth.*ends before 5 mm.*1 mm to 4 mm"):
        model.mean(np.array([[4 / 3, 0.4, 0.1]]))
    with pytest.raises(DataError, match="too few"):
        fit_surrogate("cof", "1", model.dimensions, model.runs.points[:9], model.runs.values[:9])


def test_shared_draws_decide_an_order_that_wide_intervals_hide():
    common = np.random.default_rng(1).normal(0, 0.05, 2000)
    first, second = (0.21, 0.05, 0.21 + common), (0.2, 0.05, 0.2 + common)
    assert probability_higher(first, second, shared=True) == 1.0
    assert probability_higher(second, first, shared=True) == 0.0
    assert probability_higher(first, second, shared=False) == pytest.approx(0.556, abs=0.01)
    assert probability_higher((0.2, None, None), second, shared=False) is None


# --- whole studies of a made-up function ---

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDY = """\
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
"shoe.tread.lug_width" = { from = "3 mm", to = "8 mm" }
[outputs]
maximise = ["cof"]
minimise = ["rubber_volume"]
require = ["land > 0.2"]
[method]
"""


def played(method, function):
    """Return the result of a study whose cases are numbers of ``function`` (x, y in 0 to 1)."""
    base = load(EXAMPLES / "work_shoe_full_tread_glycerol.toml")
    plan = read_plan(STUDY + method, base=base, folder=".")
    jobs, records = [], {}
    while batch := list(next_batch(plan, StudyResult(plan, jobs, records))):
        jobs += batch
        for job in batch:
            numbers = function(*(job.point or (0.5, 0.5)))
            exact = dict.fromkeys(numbers, 0.0)
            records[job.key] = Record(job.key, Ending.COMPUTED, numbers=numbers, errors=exact)
    return StudyResult(plan, jobs, records)


def trade(x, y):
    """Front: y = 0.4, cof = 1 - x^2 against volume 1 + 0.8 sqrt(1 - x); land cuts x + y < 0.5."""
    volume = (1 + (y - 0.4) ** 2) * (1 + 0.8 * math.sqrt(1 - x))
    return {"cof": 1 - x**2, "rubber_volume": volume, "land": 0.4 * (x + y)}


@pytest.mark.slow
def test_an_optimisation_finds_the_front_of_a_dense_grid():
    import moocore

    result = played('kind = "optimise"\nbudget = 40\nbatch = 6', trade)
    grid = [trade(x, y) for x in np.linspace(0, 1, 101) for y in np.linspace(0, 1, 101)]
    every = np.array([(-g["cof"], g["rubber_volume"]) for g in grid if g["land"] >= 0.2])
    found = result.goal_values(result.front) * result.plan.signs
    low, high = every.min(axis=0), every.max(axis=0)
    volumes = [
        moocore.hypervolume((each - low) / (high - low), ref=[1.1, 1.1]) for each in (every, found)
    ]
    assert volumes[1] / volumes[0] > 0.98
    assert (result.margins(result.front) >= 0).all()
    assert len(result.designs) == 40


def test_nothing_on_the_front_is_beaten_and_the_same_study_proposes_the_same():
    first, second = (played('kind = "sweep"\nbudget = 16', trade) for _ in range(2))
    assert [one.point for one in first.designs] == [one.point for one in second.designs]
    values = first.goal_values(first.front) * first.plan.signs
    allowed = (
        first.goal_values(first.designs)[first.meets_requirements(first.designs)] * first.plan.signs
    )
    for row in values:
        assert not ((allowed <= row).all(axis=1) & (allowed < row).any(axis=1)).any()


def test_active_points_lie_where_the_surrogate_knows_least():
    result = played('kind = "sweep"\nbudget = 24\nactive = 0.4\nbatch = 5', trade)
    assert len(result.designs) == 24
    first = StudyResult(result.plan, result.jobs[:14], result.records)
    (surrogate,) = first.surrogates(result.plan.goals[:1])
    every = qmc.Sobol(2, rng=1).random(512)
    _, deviation = surrogate.prediction(every, noise=False)
    _, chosen = surrogate.prediction(np.array([result.designs[14].point]), noise=False)
    assert chosen[0] > 0.95 * deviation.max()


@pytest.mark.parametrize(
    ("analysis", "on"), [("sobol", "runs"), ("sobol", "surrogate"), ("morris", "runs")]
)
def test_indices_of_an_additive_function_are_its_shares(analysis, on):
    budget = 256 if on == "runs" else 40
    method = f'kind = "sensitivity"\nanalysis = "{analysis}"\non = "{on}"\nbudget = {budget}'
    result = played(method, lambda x, y: {"cof": 2 * x + y, "rubber_volume": 1.0, "land": 1.0})
    found = effects(result, result.plan.goals[0])
    wanted = (0.8, 0.2) if analysis == "sobol" else (2.0, 1.0)
    assert found.total == pytest.approx(wanted, abs=0.1)
    assert found.paths[0] in found.headline()[0]
    assert ("Q2" in found.basis) == (on == "surrogate")
