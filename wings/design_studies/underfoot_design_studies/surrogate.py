"""A Gaussian process in place of runs, with its error by leaving out one run after the other.

Covariance K: Matern (nu = 5/2) with a length for each input, a linear trend, and noise;
hyperparameters by maximum likelihood (Rasmussen and Williams 2006, chapters 2 and 5). A name is
one coordinate for each of its values. Leaving one run out in closed form (Eqs. 5.10 and 5.11):

    mu_i = y_i - [K^-1 y]_i / [K^-1]_ii,    s_i^2 = 1 / [K^-1]_ii

    Q2 = 1 - sum (y_i - mu_i)^2 / sum (y_i - mean y)^2
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
Dimension = Input | Distribution


@dataclass(frozen=True, eq=False)
class Surrogate:
    """A fitted process of one output over the unit cube of the inputs.

    Attributes:
        name, unit: Of the output.
        points: (runs, inputs) places of the runs in the unit cube; ``values`` (runs,) SI.
        left_out: (runs,) what the other runs predict for each, SI; ``left_out_sd`` its deviation.
    """

    name: str
    unit: str
    dimensions: tuple[Dimension, ...]
    points: Array
    values: Array
    theta: Array
    left_out: Array
    left_out_sd: Array
    process: Any

    @property
    def q2(self) -> float:
        """1 - squared error of leaving one out over the variance of the runs."""
        total = float(np.sum((self.values - self.values.mean()) ** 2))
        return 1.0 - float(np.sum((self.values - self.left_out) ** 2)) / total if total else 1.0

    @property
    def error(self) -> float:
        """Root mean square error of leaving one out, SI."""
        return float(np.sqrt(np.mean((self.values - self.left_out) ** 2)))

    @property
    def reliability(self) -> str:
        """Its error as it stands wherever the surrogate is used."""
        error = quantity_text(self.error, self.unit)
        mark = "" if self.q2 >= TRUSTED else ", too rough to rank designs by"
        runs = f"surrogate of {len(self.values)} designs"
        return f"{runs}: Q2 {self.q2:.3f}, error {error} (leave one out){mark}"

    def predicted(self, points: Array) -> tuple[Array, Array]:
        """Return mean and standard deviation (n,) at places (n, inputs) of the unit cube, SI.

        Raises:
            RangeError: A place outside the cube: there the surrogate knows nothing.
        """
        features = self._features(points)
        level, scale = self._scale
        mean, deviation = self.process.predict(features, return_std=True)
        return level + scale * mean, scale * deviation

    def mean(self, points: Array) -> Array:
        """Return the mean (n,) alone, which costs a tenth; otherwise as ``predicted``."""
        level, scale = self._scale
        return level + scale * self.process.predict(self._features(points))

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
        """Return the process that believes its own prediction at a further place."""
        points = np.vstack([self.points, point])
        values = np.append(self.values, self.predicted(point)[0])
        return _fitted(self.name, self.unit, self.dimensions, points, values, self.theta)

    def to_dict(self) -> dict[str, Any]:
        """Return data and hyperparameters as plain data."""
        return {
            "output": self.name,
            "unit": self.unit,
            "inputs": [one.path for one in self.dimensions],
            "points": self.points.tolist(),
            "values": self.values.tolist(),
            "theta": self.theta.tolist(),
            "q2": self.q2,
            "error": self.error,
        }

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any], dimensions: Sequence[Dimension]) -> Surrogate:
        """Return the surrogate of ``to_dict``; nothing is fitted anew."""
        points, values = np.array(plain["points"]), np.array(plain["values"])
        theta = np.array(plain["theta"])
        return _fitted(plain["output"], plain["unit"], tuple(dimensions), points, values, theta)

    @property
    def _scale(self) -> tuple[float, float]:
        return float(self.values.mean()), float(self.values.std()) or 1.0


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
    return _fitted(name, unit, tuple(dimensions), points[good], values[good], None)


def _fitted(
    name: str,
    unit: str,
    dimensions: tuple[Dimension, ...],
    points: Array,
    values: Array,
    theta: Array | None,
) -> Surrogate:
    process = optional_module("sklearn.gaussian_process", "study", "A surrogate")
    kernels = process.kernels
    features = featured(dimensions, points)
    scaled = (values - values.mean()) / (values.std() or 1.0)
    size, lengths = kernels.ConstantKernel(1.0, (1e-4, 1e3)), np.ones(features.shape[1])
    kernel = (
        size * kernels.Matern(lengths, (0.05, 50.0), nu=2.5)
        + size * kernels.DotProduct(1.0, (1e-2, 1e2))
        + kernels.WhiteKernel(1e-3, (1e-8, 1.0))
    )
    options: dict[str, Any] = {"n_restarts_optimizer": 3, "random_state": 0}
    if theta is not None:
        kernel, options = kernel.clone_with_theta(theta), {"optimizer": None}
    made = process.GaussianProcessRegressor(kernel, **options)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # lengths at a bound: an input without effect
        made.fit(features, scaled)
    inverse = np.linalg.inv(made.kernel_(features))
    diagonal = np.diag(inverse)
    scale = values.std() or 1.0
    return Surrogate(
        name,
        unit,
        dimensions,
        points,
        values,
        np.asarray(made.kernel_.theta),
        values - scale * (inverse @ scaled) / diagonal,
        scale / np.sqrt(diagonal),
        made,
    )


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
