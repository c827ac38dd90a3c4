"""Uncertainty of a computed number from those of its inputs and of the model, by sampling."""

import math
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from underfoot.core import InputError, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

LOGNORMAL_ABOVE = 1.0 / 3.0
"""Relative spread from which a positive quantity is drawn from a log-normal: a normal one would
put more than 0.1 % of its draws below zero."""


@dataclass(frozen=True, slots=True)
class Propagated:
    """Outcome of sampling; arrays have the shape of what the function returns.

    Parameters:
        value: The function at the values given.
        deviation: Standard deviation of the draws.
        low, high: Bounds of the central interval that holds ``confidence``.
        share: Variance due to each input alone over the sum of these variances, averaged over the
            result, 1; "model" is the model's own. First order: interactions count with none. Empty
            when not asked for.
        left_out: Inputs without a known spread, taken as exact.
        draws, drawn: (samples, ...) the results, and (samples,) what was drawn of each input.
    """

    value: Array
    deviation: Array
    low: Array
    high: Array
    confidence: float
    samples: int
    seed: int
    share: Mapping[str, float]
    left_out: tuple[str, ...]
    draws: Array
    drawn: Mapping[str, Array]


def propagate_spread(
    function: Callable[[Mapping[str, float]], object],
    inputs: Mapping[str, SourcedValue],
    *,
    model_deviation: float | None = None,
    confidence: float = 0.95,
    samples: int = 1000,
    seed: int = 0,
    shares: bool = True,
    joint: Mapping[str, Array] | None = None,
) -> Propagated:
    """Return the spread of ``function`` of ``inputs`` with that of the model on top.

    Inputs are drawn independently, each once from every of ``samples`` equally likely strata
    (Latin hypercube; McKay, Beckman and Conover 1979): normal, or log-normal with the same mean and
    spread where a positive value spreads by more than a third of itself. The model's own error is
    one normal draw for the whole result (a model is off in one direction), ``model_deviation`` in
    the unit of the result. The same ``seed`` gives the same numbers.

    Parameters:
        function: Of a mapping name -> number; returns a number or an array, always of one shape.
        inputs: Values with their standard deviations; one without is taken as exact and listed.
        model_deviation: From residuals of a calibration or of blind predictions; None counts none.
        shares: False leaves out which input causes how much: it takes draws of each input alone.
        joint: (samples,) draws of inputs that depend on each other, by name; they are not drawn
            anew.

    Raises:
        InputError: An input without a value, fewer than 100 samples, a result that is not finite.
    """
    if samples < 100:
        raise InputError(f"{samples}", where="samples", allowed="100 or more")
    if not 0 < confidence < 1:
        raise InputError(f"{confidence:g}", where="confidence", allowed="above 0, below 1")
    centre: dict[str, float] = {}
    for name, quantity in inputs.items():
        if quantity.value is None or not math.isfinite(quantity.value):
            raise InputError(Message("has no value: {reason}", reason=quantity.reason), where=name)
        centre[name] = quantity.value
    generator = np.random.default_rng(seed)
    drawn = dict(joint or {}) | {
        name: _draws(centre[name], quantity.uncertainty, samples, generator)
        for name, quantity in inputs.items()
        if quantity.uncertainty and name not in (joint or {})
    }
    value = _result(function, centre)
    points = ({k: float(draws[i]) for k, draws in drawn.items()} for i in range(samples))
    results = np.array([_result(function, {**centre, **point}) for point in points])
    variance = {}
    for name, draws in drawn.items() if shares else ():
        few = draws[: max(100, samples // 5)]
        alone = np.array([_result(function, {**centre, name: x}) for x in few])
        variance[name] = float(np.mean(np.var(alone, axis=0, ddof=1)))
    if model_deviation:
        shift = generator.normal(0.0, model_deviation, samples)
        results = results + shift.reshape(-1, *([1] * value.ndim))
        if shares:
            variance["model"] = model_deviation**2
    total = sum(variance.values())
    tail = 0.5 * (1 - confidence)
    low, high = np.quantile(results, [tail, 1 - tail], axis=0)
    return Propagated(
        value=value,
        deviation=np.std(results, axis=0, ddof=1),
        low=low,
        high=high,
        confidence=confidence,
        samples=samples,
        seed=seed,
        share={name: (part / total if total > 0 else 0.0) for name, part in variance.items()},
        left_out=tuple(name for name in inputs if name not in drawn),
        draws=results,
        drawn=drawn,
    )


def probability_higher(
    first: tuple[float, float | None, Array | None],
    second: tuple[float, float | None, Array | None],
    *,
    shared: bool,
) -> float | None:
    """Return the probability that the first of two values is the higher one; None if not estimated.

    Each is its value, its standard deviation and its draws. ``shared`` draws are counted pair by
    pair, so that what both have in common cancels: P = (n(a > b) + n(a = b) / 2) / n. Otherwise the
    values count as independent: Phi((a - b) / sqrt(s_a^2 + s_b^2)).
    """
    (a, spread_a, draws_a), (b, spread_b, draws_b) = first, second
    if shared and draws_a is not None and draws_b is not None and draws_a.size == draws_b.size:
        return float(np.mean(draws_a > draws_b) + 0.5 * np.mean(draws_a == draws_b))
    if spread_a is None or spread_b is None:
        return None
    spread = math.hypot(spread_a, spread_b)
    if spread == 0.0:
        return 0.5 * (1.0 + float(np.sign(a - b)))
    return 0.5 * (1.0 + math.erf((a - b) / spread / math.sqrt(2.0)))


def named_shares(seed: int, name: str, samples: int) -> Array:
    """Return (samples,) shares between 0 and 1 of a cause, one from each stratum.

    The same seed and name give the same numbers: what two cases have in common.
    """
    return _strata(np.random.default_rng([seed, zlib.crc32(name.encode())]), samples)


def normal_draws(seed: int, name: str, samples: int) -> Array:
    """Return (samples,) standard normal draws of a cause, the same for the same seed and name."""
    return ndtri(named_shares(seed, name, samples))


def _strata(generator: np.random.Generator, samples: int) -> Array:
    shares = (generator.permutation(samples) + generator.random(samples)) / samples
    return np.clip(shares, 1e-12, 1 - 1e-12)


def _draws(
    value: float, deviation: float | None, samples: int, generator: np.random.Generator
) -> Array:
    spread = deviation or 0.0
    normal = ndtri(_strata(generator, samples))
    if value > 0 and spread > LOGNORMAL_ABOVE * value:
        width = math.sqrt(math.log1p((spread / value) ** 2))
        return value * np.exp(width * (normal - 0.5 * width))
    return value + spread * normal


def _result(
    function: Callable[[Mapping[str, float]], object], values: Mapping[str, float]
) -> Array:
    result = np.asarray(function(values), dtype=float)
    if not np.isfinite(result).all():
        raise InputError(
            "the result is not finite for a draw of the inputs",
            where="propagated",
            remedy=Message(
                "Check the spreads: {spreads}",
                spreads=[f"{name} = {value:.3g}" for name, value in values.items()],
            ),
        )
    return result
