"""Readings drawn from what the open inputs of a case do to them, taken together."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError

from .sensitivity import Sensitivity

LARGEST = 2.0
"""Standard deviations up to which an input's effect is carried on from one."""


def sampled(
    found: Sensitivity,
    name: str,
    *,
    value: float | None = None,
    factors: Sequence[float] = (),
    least: float,
    draws: int = 20_000,
    seed: int = 0,
) -> NDArray[np.float64]:
    """Return draws (draws,) of a positive number over all open inputs together.

    ln N = ln N_0 + sum_i f_i(z_i), each z_i standard normal and cut at 2, f_i linear on either
    side through the two computed ends of input i: effects are taken as factors that multiply, so
    a reading near zero stays positive and one that a single degree multiplies by ten has a long
    upper tail. Interactions beyond that are not looked for.

    Parameters
    ----------
    found
        Nominal outcome and the effects of the inputs.
    name
        Scalar of the outcomes.
    value
        N_0; None takes the nominal outcome's (another grid's value may be given).
    factors
        Further causes, each as the factor of one standard deviation (grid, place of the tracks).
    least
        Smaller numbers count as this one: no reading tells them apart.
    draws, seed
        Number of draws and where they start; the same seed gives the same draws.

    Errors
    ------
    InputError
        ``least`` or a factor that is not positive.
    """
    if not least > 0:
        raise InputError(f"{least:g}", where="least", allowed="above 0")
    if any(not factor > 0 for factor in factors):
        raise InputError(f"{list(factors)}", where="factors", allowed="above 0")
    centre = _log(found.nominal.number(name), least)
    start = centre if value is None else _log(value, least)
    if math.isnan(start) or math.isnan(centre):
        return np.full(draws, np.nan)
    random = np.random.default_rng(seed)
    total = np.full(draws, start)
    for effect in found.effects:
        z = np.clip(random.standard_normal(draws), -LARGEST, LARGEST)
        low = _log(effect.low.number(name), least) - centre
        high = _log(effect.high.number(name), least) - centre
        if math.isnan(low) and math.isnan(high):
            continue
        low = -high if math.isnan(low) else low
        high = -low if math.isnan(high) else high
        total += np.where(z < 0, -z * low, z * high)
    for factor in factors:
        total += np.clip(random.standard_normal(draws), -LARGEST, LARGEST) * math.log(factor)
    return np.maximum(np.exp(total), least)


def _log(value: float, least: float) -> float:
    return value if math.isnan(value) else math.log(max(value, least))
