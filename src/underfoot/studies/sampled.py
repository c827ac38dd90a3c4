"""Readings drawn from what the open inputs of a case do to them, taken together."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError
from underfoot.questions.sensitivity import Sensitivity

LARGEST = 1.0
"""Standard deviations at which an input was computed; beyond, its effect is held, not carried on:
that of a heel's angle, the largest of all, does not go on growing."""


def sample_inputs(
    sensitivity: Sensitivity,
    name: str,
    *,
    value: float | None = None,
    factors: Sequence[float] = (),
    least: float,
    most: float = math.inf,
    draws: int = 20_000,
    seed: int = 0,
) -> NDArray[np.float64]:
    """Return draws (draws,) of a positive number over all open inputs together.

    g(N) = g(N_0) + sum_i f_i(z_i), each z_i standard normal and held at its computed ends (1), f_i
    linear on either side through them; g(N) = ln N, or ln N / (M - N) where N can't pass M.
    Effects are factors that multiply, so a reading near zero stays positive and one that a single
    degree multiplies by ten has a long upper tail. Interactions beyond that are not looked for.

    Parameters:
        sensitivity: Nominal outcome and the effects of the inputs.
        name: Scalar of the outcomes.
        value: N_0; None takes the nominal outcome's (another grid's value may be given).
        factors: Further causes, each as the factor of one standard deviation (grid, place of the
            tracks).
        least: Smaller numbers count as this one: no reading tells them apart.
        most: M, which the number can't pass (a load: the normal force); none by default.
        draws, seed: Number of draws and where they start; the same seed gives the same draws.

    Raises:
        InputError: ``least`` or a factor that is not positive, ``most`` not above ``least``.
    """
    if not most > least:
        raise InputError(f"{most:g}", where="most", allowed="above least")
    if not least > 0:
        raise InputError(f"{least:g}", where="least", allowed="above 0")
    if any(not factor > 0 for factor in factors):
        raise InputError(f"{list(factors)}", where="factors", allowed="above 0")
    nominal = sensitivity.nominal.number(name)
    centre = _logit(nominal, least, most)
    start = centre if value is None else _logit(value, least, most)
    if math.isnan(start) or math.isnan(centre):
        return np.full(draws, np.nan)
    random = np.random.default_rng(seed)
    total = np.full(draws, start)
    for effect in sensitivity.effects:
        z = np.clip(random.standard_normal(draws), -LARGEST, LARGEST)
        low = _logit(effect.low.number(name), least, most) - centre
        high = _logit(effect.high.number(name), least, most) - centre
        if math.isnan(low) and math.isnan(high):
            continue
        low = -high if math.isnan(low) else low
        high = -low if math.isnan(high) else high
        total += np.where(z < 0, -z * low, z * high)
    for factor in factors:
        total += random.standard_normal(draws) * math.log(factor)
    odds = np.exp(total)
    return np.maximum(odds if math.isinf(most) else most * odds / (1.0 + odds), least)


def _logit(value: float, least: float, most: float) -> float:
    """Return ln N, or ln N / (M - N), of a number held between both bounds; nan of nan."""
    if math.isnan(value):
        return value
    value = max(value, least)
    if math.isinf(most):
        return math.log(value)
    value = min(value, (1.0 - 1e-6) * most)
    return math.log(value / (most - value))
