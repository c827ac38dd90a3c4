"""A surrogate in place of runs, with its error on runs that it did not see.

Three forms, of values y over the features x of the inputs (a name is one column a value)::

    quadratic   ln y = b0 + b.x + x.B.x + noise, weights and noise by evidence (MacKay 1992)
    process     y a Gaussian process: Matern (nu = 5/2) with a length for each input, a linear
                trend, noise; by maximum likelihood (Rasmussen and Williams 2006, chapters 2, 5)
    both        the process on what the quadratic leaves

(y itself where a value is not positive.) Runs are left out in ``FOLDS`` parts, ``REPEATS`` times,
and each form is fitted anew without them, hyperparameters and all; the form with the least squared
error e of what was left out is taken, and

    Q2 = 1 - sum e^2 / sum (y - mean y)^2

The deviation that a form states is multiplied by the factor with which 95 % of what was left out
lies within 1.96 of it (conformal; Vovk 2015, Barber et al. 2021). Noise of the runs, fitted
and not taken from their numerical error, is a part of each form and of its deviation.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from underfoot.case import unit_at
from underfoot.core import DataError, RangeError, display
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.core.presentation import quantity_text
from underfoot.core.threads import threads_limited

from .inputs import Choice, Distribution, Input

FEWEST = 5
"""Runs for each input below which no surrogate is made."""
TRUSTED = 0.9
"""Q2 below which a surrogate is named with a caution."""
FORMS = ("quadratic", "process", "both")
FOLDS, REPEATS = 8, 2
INSIDE, NORMAL = 0.95, 1.959964
"""Share of fresh runs within a band, and its half width in deviations."""
Dimension = Input | Distribution


@dataclass(frozen=True, eq=False)
class Model:
    """A fitted form over features.

    Attributes:
        logarithm: Whether it is of ln y; ``level`` and ``scale`` make y or ln y standard.
        trend: The quadratic, or None. ``process``: the Gaussian process, or None.
    """

    form: str
    logarithm: bool
    level: float
    scale: float
    trend: Any
    process: Any

    @property
    def theta(self) -> Array:
        """Hyperparameters of the process, none of a quadratic."""
        return np.empty(0) if self.process is None else np.asarray(self.process.kernel_.theta)

    def predicted(self, features: Array) -> tuple[Array, Array]:
        """Return mean and standard deviation (n,) of a run, SI."""
        mean, variance = np.zeros(len(features)), np.zeros(len(features))
        if self.trend is not None:
            mean, deviation = self.trend.predict(_quadratic(features), return_std=True)
            variance = deviation**2 - (self.process is not None) / self.trend.alpha_
        if self.process is not None:
            rest, deviation = self.process.predict(features, return_std=True)
            mean, variance = mean + rest, variance + deviation**2
        middle, deviation = self._in_si(mean), self.scale * np.sqrt(np.maximum(variance, 0.0))
        return middle, middle * deviation if self.logarithm else deviation

    def mean(self, features: Array) -> Array:
        """Return the mean (n,) alone, which costs a tenth."""
        mean = np.zeros(len(features))
        if self.trend is not None:
            mean += self.trend.predict(_quadratic(features))
        if self.process is not None:
            mean += self.process.predict(features)
        return self._in_si(mean)

    def _in_si(self, standard: Array) -> Array:
        value = self.level + self.scale * standard
        return np.exp(value) if self.logarithm else value


@dataclass(frozen=True, eq=False)
class Surrogate:
    """A fitted model of one output over the unit cube of the inputs.

    Attributes:
        name, unit: Of the output.
        points: (runs, inputs) places of the runs in the unit cube; ``values`` (runs,) SI.
        q2: 1 - squared error of what was left out over the variance of the runs.
        error: Root mean square error of what was left out, SI.
        stretch: Factor of the deviation that the model states.
        without: The model fitted anew without each of the parts of the runs.
    """

    name: str
    unit: str
    dimensions: tuple[Dimension, ...]
    points: Array
    values: Array
    model: Model
    q2: float
    error: float
    stretch: float
    without: tuple[Model, ...] = ()

    @property
    def reliability(self) -> str:
        """Its error as it stands wherever the surrogate is used."""
        error = quantity_text(self.error, self.unit)
        mark = "" if self.q2 >= TRUSTED else ", too rough to rank designs by"
        runs = f"surrogate of {len(self.values)} designs ({self.model.form})"
        return f"{runs}: Q2 {self.q2:.3f}, error {error} (runs left out){mark}"

    def predicted(self, points: Array) -> tuple[Array, Array]:
        """Return mean and standard deviation (n,) at places (n, inputs) of the unit cube, SI.

        95 % of fresh runs lie within 1.96 of these deviations.

        Raises:
            RangeError: A place outside the cube: there the surrogate knows nothing.
        """
        mean, deviation = self.model.predicted(self._features(points))
        return mean, self.stretch * deviation

    def mean(self, points: Array) -> Array:
        """Return the mean (n,) alone, which costs a tenth; otherwise as ``predicted``."""
        return self.model.mean(self._features(points))

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
                f"the surrogate of {self.name} ends before {_text(one, share)}",
                where=one.path,
                allowed=" to ".join(_text(one, end) for end in (0.0, 1.0)),
                remedy="Widen the range of the study and run it again, or run the case itself",
            )
        return featured(self.dimensions, points)

    def with_point(self, point: Array) -> Surrogate:
        """Return the surrogate that believes its own prediction at a further place."""
        points = np.vstack([self.points, point])
        values = np.append(self.values, self.mean(point))
        return replace(self, points=points, values=values, model=self._again(points, values))

    def _again(self, points: Array, values: Array) -> Model:
        features = featured(self.dimensions, points)
        return _model(self.model.form, features, values, self.model.theta, fit=False)

    def to_dict(self) -> dict[str, Any]:
        """Return data and hyperparameters as plain data."""
        return {
            "output": self.name,
            "unit": self.unit,
            "inputs": [one.path for one in self.dimensions],
            "points": self.points.tolist(),
            "values": self.values.tolist(),
            "form": self.model.form,
            "theta": self.model.theta.tolist(),
            "q2": self.q2,
            "error": self.error,
            "stretch": self.stretch,
        }

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any], dimensions: Sequence[Dimension]) -> Surrogate:
        """Return the surrogate of ``to_dict``; no hyperparameter is fitted anew."""
        points, values = np.array(plain["points"]), np.array(plain["values"])
        features = featured(dimensions, points)
        model = _model(plain["form"], features, values, np.array(plain["theta"]), fit=False)
        numbers = (plain[name] for name in ("q2", "error", "stretch"))
        return cls(
            plain["output"], plain["unit"], tuple(dimensions), points, values, model, *numbers
        )


@threads_limited(1)
def fitted(
    name: str, unit: str, dimensions: Sequence[Dimension], points: Array, values: Array
) -> Surrogate:
    """Return the surrogate of an output from runs at places of the unit cube.

    Raises:
        DataError: Fewer than five usable runs an input.
    """
    good = np.isfinite(values)
    least = FEWEST * len(dimensions)
    if np.count_nonzero(good) < least:
        raise DataError(
            f"{np.count_nonzero(good)} usable runs are too few for a surrogate of {name}",
            allowed=f"at least {least} ({FEWEST} for each of {len(dimensions)} inputs)",
            remedy="Raise the budget of the study",
        )
    points, values = points[good], values[good]
    features = featured(dimensions, points)
    made = {form: _model(form, features, values, None, fit=True) for form in FORMS}
    left_out = {form: _left_out(made[form], features, values) for form in FORMS}
    errors = {form: float(np.mean(one[0] ** 2)) for form, one in left_out.items()}
    form = min(FORMS, key=errors.__getitem__)
    error, deviation, without = left_out[form]
    spread = float(np.var(values))
    q2 = 1.0 - errors[form] / spread if spread else 1.0
    ratios = np.abs(error) / np.maximum(deviation, 1e-9 * (np.sqrt(spread) or 1.0))
    stretch = float(np.quantile(ratios, INSIDE)) / NORMAL or 1.0
    own = (made[form], q2, math.sqrt(errors[form]), stretch, tuple(without))
    return Surrogate(name, unit, tuple(dimensions), points, values, *own)


def _left_out(made: Model, features: Array, values: Array) -> tuple[Array, Array, list[Model]]:
    """Return error and stated deviation (repeats x runs,) of what was left out, and the models.

    The models are those of the first division into parts.
    """
    errors, deviations, models = [], [], []
    for repeat in range(REPEATS):
        order = np.random.default_rng(repeat).permutation(len(values))
        for part in np.array_split(order, FOLDS):
            rest = np.setdiff1d(order, part)
            model = _model(made.form, features[rest], values[rest], made.theta, fit=True)
            mean, deviation = model.predicted(features[part])
            errors.append(values[part] - mean)
            deviations.append(deviation)
            models.append(model)
    return np.concatenate(errors), np.concatenate(deviations), models[:FOLDS]


def _model(form: str, features: Array, values: Array, theta: Array | None, *, fit: bool) -> Model:
    """Return a form fitted to runs; with ``theta`` from there, or as it is unless ``fit``."""
    logarithm = form != "process" and bool((values > 0).all())
    wanted = np.log(values) if logarithm else values
    level, scale = float(wanted.mean()), float(wanted.std()) or 1.0
    standard, trend, process = (wanted - level) / scale, None, None
    if form != "process":
        linear = optional_module("sklearn.linear_model", "study", "A surrogate")
        trend = linear.BayesianRidge().fit(_quadratic(features), standard)
        standard = standard - trend.predict(_quadratic(features))
    if form != "quadratic":
        process = _process(features, standard, theta, fit=fit)
    return Model(form, logarithm, level, scale, trend, process)


def _process(features: Array, standard: Array, theta: Array | None, *, fit: bool) -> Any:
    process = optional_module("sklearn.gaussian_process", "study", "A surrogate")
    kernels = process.kernels
    size, lengths = kernels.ConstantKernel(1.0, (1e-4, 1e3)), np.ones(features.shape[1])
    kernel = (
        size * kernels.Matern(lengths, (0.05, 50.0), nu=2.5)
        + size * kernels.DotProduct(1.0, (1e-2, 1e2))
        + kernels.WhiteKernel(1e-3, (1e-8, 1.0))
    )
    options: dict[str, Any] = {"n_restarts_optimizer": 3, "random_state": 0}
    if theta is not None:
        kernel, options = kernel.clone_with_theta(theta), {} if fit else {"optimizer": None}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # lengths at a bound: an input without effect
        return process.GaussianProcessRegressor(kernel, **options).fit(features, standard)


def _quadratic(features: Array) -> Array:
    """Return (n, terms) of the features from -1 to 1, their squares and products."""
    centred = 2.0 * features - 1.0
    first, second = np.triu_indices(centred.shape[1])
    return np.hstack([centred, centred[:, first] * centred[:, second]])


def featured(dimensions: Sequence[Dimension], points: Array) -> Array:
    """Return what the process sees: a range as its share, a name as one column a value."""
    columns = []
    for one, share in zip(dimensions, np.asarray(points, dtype=float).T, strict=True):
        if not isinstance(one, Choice):
            columns.append(share)
            continue
        at = np.minimum((share * len(one.options)).astype(int), len(one.options) - 1)
        if isinstance(one.options[0], float):
            values = np.array(one.options)
            columns.append((values[at] - values.min()) / (np.ptp(values) or 1.0))
        else:
            columns += [np.where(at == k, 1.0, 0.0) for k in range(len(one.options))]
    return np.column_stack(columns)


def _text(dimension: Dimension, share: float) -> str:
    value = dimension.value(min(max(share, 0.0), 1.0) if isinstance(dimension, Choice) else share)
    return display(value, unit_at(dimension.path)) if isinstance(value, float) else str(value)
