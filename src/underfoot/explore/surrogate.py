"""A surrogate in place of runs, with its error on runs that it did not see.

A Gaussian process of values y over the features x of the inputs, from -1 to 1 (a name is one column
a value), with noise of each run (Rasmussen and Williams 2006, chapters 2
and 5)::

    k(x, x') = l^2 (1 + x.x') + q^2 p(x).p(x') + m^2 Matern_5/2(x, x') + g^2 t t',
    noise^2 = (c s)^2

p(x) are squares and products. t is 1 on a finer grid, which may lie anywhere above or below the
coarse one and differ in form by little (after Kennedy and O'Hagan 2000). s is the numerical error
that a run states (1 where none does), c how much of it differs from run to run: what a grid adds to
all alike is no noise. Three forms:

    quadratic   of ln y, without the Matern part
    process     of y, without p
    both        of ln y, all parts

(y itself where a value is not positive.) Amplitudes, lengths and c are the most probable under the
data and wide log-normal priors. Runs are left out in ``FOLDS`` parts, ``REPEATS`` times, all of one
place together, and each form is fitted anew without them, hyperparameters and all; the form with
the least squared error e of what was left out is taken, and

    Q2 = 1 - sum e^2 / sum (y - mean y)^2

The deviation of a fresh run that a form states, its noise included, is multiplied by the factor
with which 95 % of what was left out lies within 1.96 of it (conformal, with its correction for n
runs: the quantile at 0.95 (1 + 1/n); Vovk 2015, Barber et al. 2021).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular
from scipy.optimize import minimize
from scipy.spatial.distance import cdist

from underfoot.case import unit_at
from underfoot.core import DataError, RangeError, display
from underfoot.core.arrays import AnyArray, Array, Mask
from underfoot.core.deprecation import renamed_member
from underfoot.core.presentation import quantity_text
from underfoot.core.remark import Message
from underfoot.core.threads import threads_limited

from .inputs import Choice, Distribution, Input

FEWEST = 5
"""Runs for each input below which no surrogate is made."""
MOST = 400
"""Runs of a surrogate; of more it takes so many, evenly: its cost grows as their cube."""
TRUSTED = 0.9
"""Q2 below which a surrogate is named with a caution."""
FORMS = ("quadratic", "process", "both")
FOLDS, REPEATS = 8, 2
INSIDE, NORMAL = 0.95, 1.959964
"""Share of fresh runs within a band, and its half width in deviations."""
AMPLITUDES = math.log(0.5), 1.0
"""Mean and deviation of ln l, ln q and ln m, of standardised values (assumed)."""
STATED, UNSTATED = (math.log(0.5), 1.0), (math.log(0.1), 1.5)
"""The same of ln c, for errors that runs state and for runs that state none (assumed)."""
LENGTHS = math.sqrt(2), math.sqrt(3)
"""The same of the logarithm of a length; the mean grows by half of that of the number of features
(Hvarfner, Hellsten and Nardi 2024)."""
BETWEEN, FORM = 1.0, 0.1
"""g, of standardised values, and the feature of a finer grid, whose range in another would be 1:
what grids differ by changes over the box by a fifth of what the values do (assumed)."""
SHORT = math.log(0.5)
"""Logarithm of the lengths of a second start."""
WIDEST = 4.0
"""Deviations of its prior within which a hyperparameter is sought."""
JITTER = 1e-8
"""Variance of standardised values that keeps the covariance regular."""
Dimension = Input | Distribution


@dataclass(frozen=True, eq=False)
class Runs:
    """Runs of designs as a surrogate takes them.

    Attributes:
        points: (runs, inputs) places in the unit cube.
        values: (runs,) the output, SI.
        errors: (runs,) its numerical errors, nan where a run states none.
        finer: (runs,) which are on the finer grid.
    """

    points: Array
    values: Array
    errors: Array
    finer: Mask

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, which: AnyArray) -> Runs:
        """Return some of the runs, by index or mask."""
        return Runs(self.points[which], self.values[which], self.errors[which], self.finer[which])

    @property
    def deviations(self) -> Array:
        """Values without the mean of those on the same grid."""
        result = self.values.copy()
        for grid in (self.finer, ~self.finer):
            result[grid] -= result[grid].mean() if grid.any() else 0.0
        return result


class Model:
    """A form fitted to runs.

    Parameters:
        form: One of ``FORMS``.
        features: (runs, features) from 0 to 1.
        theta: Hyperparameters to begin at; with ``fit`` False, to take.

    Attributes:
        logarithm: Whether it is of ln y; ``level`` and ``scale`` make y or ln y standard.
        theta: Logarithms of l, q, m, c and the length of each feature.
    """

    def __init__(
        self,
        form: str,
        features: Array,
        runs: Runs,
        theta: Array | None = None,
        *,
        fit: bool = True,
    ) -> None:
        values = runs.values
        self.logarithm = form != "process" and bool((values > 0).all())
        wanted = np.log(values) if self.logarithm else values
        self.level, self.scale = float(wanted.mean()), float(wanted.std()) or 1.0
        self.form, self.features = form, features
        self.between = runs.finer.any() * (BETWEEN / FORM) ** 2
        standard = (wanted - self.level) / self.scale
        stated = runs.errors / (self.scale * (values if self.logarithm else 1.0))
        known = bool((stated > 0).all())
        variances, size = stated**2 if known else np.ones(len(values)), features.shape[1]
        lengths = LENGTHS[0] + 0.5 * math.log(size), LENGTHS[1]
        prior = np.array([*[AMPLITUDES] * 3, STATED if known else UNSTATED, *[lengths] * size])
        if theta is None:
            starts = [prior[:, 0], np.append(prior[:4, 0], np.full(size, SHORT))]
        else:
            starts = [theta]
        self.theta = starts[0]
        if fit:
            grids = self.between * np.outer(features[:, -1], features[:, -1])
            self.theta = _most_probable(form, features, standard, variances, grids, prior, starts)
        noise = math.exp(2 * self.theta[3]) * variances
        self.noise = float(noise.mean())
        covariance = self._covariance(features, features) + np.diag(noise + JITTER)
        self.factor = cholesky(covariance, lower=True)
        self.weights = cho_solve((self.factor, True), standard)

    def mean(self, features: Array) -> Array:
        """Return the mean (n,), SI."""
        return self._in_si(self._covariance(features, self.features) @ self.weights)

    def prediction(self, features: Array, *, noise: bool = True) -> tuple[Array, Array]:
        """Return mean and standard deviation (n,), SI, of a run, or without its ``noise``."""
        mean, variance = self._conditional(features, alone=True)
        middle = self._in_si(mean)
        deviation = self.scale * np.sqrt(np.maximum(variance, 0.0) + noise * self.noise)
        return middle, middle * deviation if self.logarithm else deviation

    def joint_draws(self, features: Array, normal: Array) -> Array:
        """Return joint draws (draws, n) without noise, SI, of standard normal ones (draws, n)."""
        mean, covariance = self._conditional(features, alone=False)
        values, vectors = np.linalg.eigh(covariance)
        return self._in_si(mean + normal * np.sqrt(np.maximum(values, 0.0)) @ vectors.T)

    def _conditional(self, features: Array, *, alone: bool) -> tuple[Array, Array]:
        """Return mean and covariance, standardised; ``alone`` its diagonal."""
        across = self._covariance(features, self.features)
        known = solve_triangular(self.factor, across.T, lower=True)
        if alone:
            rest = self._variance(features) - np.sum(known**2, axis=0)
        else:
            rest = self._covariance(features, features) - known.T @ known
        return across @ self.weights, rest

    def _covariance(self, first: Array, second: Array) -> Array:
        linear, quadratic, matern = _amplitudes(self.form, self.theta)
        lengths = np.exp(self.theta[4:])
        apart: Any = cdist(first / lengths, second / lengths)
        return (
            linear * (1 + _centre(first) @ _centre(second).T)
            + quadratic * _products(first) @ _products(second).T
            + matern * _matern(math.sqrt(5) * apart)
            + self.between * first[:, -1:] @ second[:, -1:].T
        )

    def _variance(self, features: Array) -> Array:
        linear, quadratic, matern = _amplitudes(self.form, self.theta)
        first, second = (np.sum(of(features) ** 2, axis=1) for of in (_centre, _products))
        return (
            linear * (1 + first) + quadratic * second + matern + self.between * features[:, -1] ** 2
        )

    def _in_si(self, standard: Array) -> Array:
        value = self.level + self.scale * standard
        return np.exp(value) if self.logarithm else value


def _most_probable(
    form: str,
    features: Array,
    standard: Array,
    variances: Array,
    grids: Array,
    prior: Array,
    starts: Sequence[Array],
) -> Array:
    """Return the hyperparameters of the highest posterior density, from the best of some starts."""
    linear = 1 + _centre(features) @ _centre(features).T
    quadratic = _products(features) @ _products(features).T
    apart = 5 * (features.T[:, :, None] - features.T[:, None, :]) ** 2
    centre, width = prior.T

    def negative_log_density(theta: Array) -> tuple[float, Array]:
        """Return -ln p and its gradient."""
        first, second, third = _amplitudes(form, theta)
        scaled = apart * np.exp(-2 * theta[4:, None, None])
        distance = np.sqrt(scaled.sum(axis=0))
        matern, noise = third * _matern(distance), np.exp(2 * theta[3]) * variances
        covariance = first * linear + second * quadratic + matern + grids
        covariance.flat[:: len(standard) + 1] += noise + JITTER
        factor = cholesky(covariance, lower=True)
        weights = cho_solve((factor, True), standard)
        inner = np.outer(weights, weights) - cho_solve((factor, True), np.eye(len(standard)))
        slope = third / 6 * inner * (1 + distance) * np.exp(-distance)
        gradient = [
            first * np.sum(inner * linear),
            second * np.sum(inner * quadratic),
            np.sum(inner * matern),
            np.diag(inner) @ noise,
            *np.tensordot(scaled, slope, 2),
        ]
        z = (theta - centre) / width
        value = 0.5 * (standard @ weights + z @ z) + np.log(np.diag(factor)).sum()
        return float(value), z / width - np.array(gradient)

    bounds = np.column_stack([centre - WIDEST * width, centre + WIDEST * width])
    ends = [
        minimize(negative_log_density, start, jac=True, method="L-BFGS-B", bounds=bounds)
        for start in starts
    ]
    return min(ends, key=lambda end: end.fun).x


def _amplitudes(form: str, theta: Array) -> Array:
    """Return l^2, q^2, m^2 of a form."""
    return np.exp(2 * theta[:3]) * [1.0, form != "process", form != "quadratic"]


def _matern(distance: Array) -> Array:
    """Return the correlation at distances in lengths times the root of 5."""
    return (1 + distance + distance**2 / 3) * np.exp(-distance)


def _centre(features: Array) -> Array:
    return 2.0 * features - 1.0


def _products(features: Array) -> Array:
    """Return (n, terms) squares and products of the features from -1 to 1."""
    centred = _centre(features)
    first, second = np.triu_indices(centred.shape[1])
    return centred[:, first] * centred[:, second]


@dataclass(frozen=True, eq=False)
class Surrogate:
    """A fitted model of one output over the unit cube of the inputs, on the finest grid run.

    Attributes:
        name, unit: Of the output.
        runs, model: What was fitted, and to which runs.
        q2: 1 - squared error of what was left out over the variance of the runs.
        error: Root mean square error of what was left out, SI.
        stretch: Factor of the deviation that the model states.
        without: The model fitted anew without each of the parts of the runs.
    """

    name: str
    unit: str
    dimensions: tuple[Dimension, ...]
    runs: Runs
    model: Model
    q2: float
    error: float
    stretch: float
    without: tuple[Model, ...] = ()

    @property
    def reliability(self) -> Message:
        """Its error as it stands wherever the surrogate is used."""
        error = quantity_text(self.error, self.unit)
        runs = Message(
            "a formula through {count} computed designs ({form})",
            count=len(self.runs),
            form=self.model.form,
        )
        told = Message(
            "{runs} misses designs left out by {error} (Q2 {q2:.3f})",
            runs=runs,
            error=error,
            q2=self.q2,
        )
        if self.q2 >= TRUSTED:
            return told
        return Message("{told}: too much to rank designs by", told=told)

    def prediction(self, points: Array, *, noise: bool = True) -> tuple[Array, Array]:
        """Return mean and standard deviation (n,) at places (n, inputs) of the unit cube, SI.

        95 % of fresh runs lie within 1.96 of these deviations; without ``noise`` they are those of
        what the runs scatter about.

        Raises:
            RangeError: A place outside the cube: there the surrogate knows nothing.
        """
        mean, deviation = self.model.prediction(self._features(points), noise=noise)
        return mean, self.stretch * deviation

    predicted = renamed_member("predicted", "prediction", gone="0.4")

    def mean(self, points: Array) -> Array:
        """Return the mean (n,) alone, which costs less; otherwise as ``prediction``."""
        return self.model.mean(self._features(points))

    def joint_draws(self, points: Array, normal: Array) -> Array:
        """Return joint draws (draws, n) of what runs at places scatter about, SI.

        Made of standard normal draws (draws, n).
        """
        return self.model.joint_draws(self._features(points), self.stretch * normal)

    drawn = renamed_member("drawn", "joint_draws", gone="0.4")

    def means_without(self, points: Array) -> list[Array]:
        """Return the mean (n,) of the surrogate without each part of the runs."""
        features = self._features(points)
        return [model.mean(features) for model in self.without]

    def _features(self, points: Array) -> Array:
        points = np.atleast_2d(np.asarray(points, dtype=float))
        outside = np.argwhere((points < -1e-9) | (points > 1 + 1e-9))
        if outside.size:
            row, column = outside[0]
            one, share = self.dimensions[column], float(points[row, column])
            raise RangeError(
                Message(
                    "the surrogate of {study} ends before {design}",
                    study=self.name,
                    design=_text(one, share),
                ),
                where=one.path,
                allowed=" to ".join(_text(one, end) for end in (0.0, 1.0)),
                remedy="Widen the range of the study and run it again, or run the case itself",
            )
        return _features(self.dimensions, points, self.runs.finer.any() * np.ones(len(points)))

    def with_point(self, point: Array) -> Surrogate:
        """Return the surrogate that believes its own prediction at a further place."""
        runs = Runs(
            np.vstack([self.runs.points, point]),
            np.append(self.runs.values, self.mean(point)),
            np.append(self.runs.errors, self.runs.errors.mean()),
            np.append(self.runs.finer, self.runs.finer.any()),
        )
        features = _features(self.dimensions, runs.points, runs.finer)
        model = Model(self.model.form, features, runs, self.model.theta, fit=False)
        return replace(self, runs=runs, model=model)

    def to_dict(self) -> dict[str, Any]:
        """Return data and hyperparameters as plain data."""
        return {
            "output": self.name,
            "unit": self.unit,
            "inputs": [dimension.path for dimension in self.dimensions],
            "points": self.runs.points.tolist(),
            "values": self.runs.values.tolist(),
            "errors": [None if math.isnan(one) else one for one in self.runs.errors.tolist()],
            "finer": self.runs.finer.tolist(),
            "form": self.model.form,
            "theta": self.model.theta.tolist(),
            "q2": self.q2,
            "error": self.error,
            "stretch": self.stretch,
        }

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any], dimensions: Sequence[Dimension]) -> Surrogate:
        """Return the surrogate of ``to_dict``; no hyperparameter is fitted anew."""
        data = (np.array(plain[name], dtype=float) for name in ("points", "values", "errors"))
        runs = Runs(*data, finer=np.array(plain["finer"], dtype=bool))
        features = _features(dimensions, runs.points, runs.finer)
        model = Model(plain["form"], features, runs, np.array(plain["theta"]), fit=False)
        numbers = (plain[name] for name in ("q2", "error", "stretch"))
        return cls(plain["output"], plain["unit"], tuple(dimensions), runs, model, *numbers)


@threads_limited(1)
def fit_surrogate(
    name: str,
    unit: str,
    dimensions: Sequence[Dimension],
    points: Array,
    values: Array,
    errors: Array | None = None,
    finer: Mask | None = None,
) -> Surrogate:
    """Return the surrogate of an output from runs at places of the unit cube.

    Parameters:
        errors: (runs,) numerical errors of the runs, SI, nan where one states none.
        finer: (runs,) which are on the finer grid; the surrogate is then of that grid.

    Raises:
        DataError: Fewer than five usable runs an input.
    """
    good = np.flatnonzero(np.isfinite(values))
    least = FEWEST * len(dimensions)
    if len(good) < least:
        raise DataError(
            Message(
                "{count} usable runs are too few for a surrogate of {name}",
                count=len(good),
                name=name,
            ),
            allowed=Message(
                "at least {least} ({fewest} for each of {count} inputs)",
                least=least,
                fewest=FEWEST,
                count=len(dimensions),
            ),
            remedy="Raise the budget of the study",
        )
    if len(good) > MOST:
        good = good[np.linspace(0, len(good) - 1, MOST).round().astype(int)]
    errors = np.full(len(values), np.nan) if errors is None else errors
    finer = np.zeros(len(values), dtype=bool) if finer is None else finer
    runs = Runs(points, values, errors, finer)[good]
    features = _features(dimensions, runs.points, runs.finer)
    made = {form: Model(form, features, runs) for form in FORMS}
    left_out = {form: _left_out(model, runs) for form, model in made.items()}
    squares = {form: float(np.mean(one[0] ** 2)) for form, one in left_out.items()}
    form = min(FORMS, key=squares.__getitem__)
    error, deviation, without = left_out[form]
    spread = float(np.mean(runs.deviations**2))
    q2 = 1.0 - squares[form] / spread if spread else 1.0
    ratios = np.abs(error) / np.maximum(deviation, 1e-9 * (np.sqrt(spread) or 1.0))
    share = min(INSIDE * (1 + 1 / len(runs)), 1.0)
    stretch = float(np.quantile(ratios, share)) / NORMAL or 1.0
    numbers = (q2, math.sqrt(squares[form]), stretch, tuple(without))
    return Surrogate(name, unit, tuple(dimensions), runs, made[form], *numbers)


def _left_out(made: Model, runs: Runs) -> tuple[Array, Array, list[Model]]:
    """Return error and stated deviation (repeats x runs,) of what was left out, and the models.

    The models are those of the first division into parts.
    """
    missed, deviations, models = [], [], []
    _, place = np.unique(runs.points, axis=0, return_inverse=True)
    for repeat in range(REPEATS):
        order = np.random.default_rng(repeat).permutation(place.max() + 1)
        for part in np.array_split(order, FOLDS):
            out = np.isin(place.ravel(), part)
            model = Model(made.form, made.features[~out], runs[~out], made.theta)
            mean, deviation = model.prediction(made.features[out])
            missed.append(runs.values[out] - mean)
            deviations.append(deviation)
            models.append(model)
    return np.concatenate(missed), np.concatenate(deviations), models[:FOLDS]


def _features(dimensions: Sequence[Dimension], points: Array, finer: AnyArray) -> Array:
    """Return the features of places, with a column for the grid where any is on the finer one."""
    features = feature_columns(dimensions, points)
    return np.column_stack([features, FORM * finer]) if np.any(finer) else features


def feature_columns(dimensions: Sequence[Dimension], points: Array) -> Array:
    """Return what the process sees: a range as its share, a name as one column a value."""
    columns = []
    for dimension, share in zip(dimensions, np.asarray(points, dtype=float).T, strict=True):
        if not isinstance(dimension, Choice):
            columns.append(share)
            continue
        at = np.minimum((share * len(dimension.options)).astype(int), len(dimension.options) - 1)
        if isinstance(dimension.options[0], float):
            values = np.array(dimension.options)
            columns.append((values[at] - values.min()) / (np.ptp(values) or 1.0))
        else:
            columns += [np.where(at == k, 1.0, 0.0) for k in range(len(dimension.options))]
    return np.column_stack(columns)


def _text(dimension: Dimension, share: float) -> str:
    value = dimension.value(min(max(share, 0.0), 1.0) if isinstance(dimension, Choice) else share)
    return display(value, unit_at(dimension.path)) if isinstance(value, float) else str(value)
