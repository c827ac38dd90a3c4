"""Probability of slipping over a population, with its band."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, SourcedValue

from .model import SlipModel
from .report_g6 import ReportG6
from .required import ADULTS_LEVEL_WALKING, RequiredFriction

_Z95 = 1.959963984540054
_NODES = 201


@dataclass(frozen=True, slots=True)
class SlipRisk:
    """Probability that a step of the population slips.

    ``probability`` is that at the best estimate of ACOF, its uncertainty the standard deviation
    that the ACOF's uncertainty makes. ``low`` and ``high`` bound 95 % of it; None when the ACOF
    came without uncertainty. ``expected`` is the mean over the uncertain ACOF.
    """

    probability: SourcedValue
    low: float | None
    high: float | None
    expected: float | None
    model: str
    rcof: RequiredFriction
    assumptions: tuple[str, ...]
    breaches: tuple[Breach, ...]


def slip_risk(
    acof: SourcedValue,
    *,
    rcof: RequiredFriction = ADULTS_LEVEL_WALKING,
    model: SlipModel | None = None,
    samples: ArrayLike | None = None,
) -> SlipRisk:
    """Return how likely a step slips: the mean of P(ACOF, RCOF) over the population's RCOF.

    Parameters
    ----------
    acof
        Available coefficient of friction, with its standard deviation if known.
    rcof
        Normally distributed required friction of the population.
    model
        A published model; None takes ``ReportG6``.
    samples
        (n,) draws of ACOF, as ``friction.sampled_cof`` gives them; None takes it as normal.

    Notes
    -----
    The band holds the uncertainty of ACOF (cut at 0) alone: not that of the model, whose
    standard errors the report does not print, nor that of the population.

    Errors
    ------
    InputError
        ACOF not determined, negative or not finite.
    """
    chosen: SlipModel = ReportG6() if model is None else model
    if acof.value is None:
        raise InputError(f"the available friction was not determined: {acof.reason}", where="acof")
    middle = float(chosen.population(acof.value, rcof.mean, rcof.sd))
    low = high = expected = spread = None
    if samples is not None:
        drawn = np.maximum(np.asarray(samples, dtype=float), 0.0)
        values = chosen.population(drawn, rcof.mean, rcof.sd)
        low, high = (float(p) for p in np.quantile(values, [0.025, 0.975]))
        expected, spread = float(np.mean(values)), float(np.std(values, ddof=1))
    elif acof.uncertainty is not None:
        if not math.isfinite(acof.uncertainty):
            raise InputError("the uncertainty is not finite", where="acof")
        ends = np.maximum(acof.value + _Z95 * acof.uncertainty * np.array([1.0, -1.0]), 0.0)
        low, high = (float(p) for p in chosen.population(ends, rcof.mean, rcof.sd))
        z = np.linspace(-6.0, 6.0, _NODES)
        weight = np.exp(-0.5 * z**2) / np.exp(-0.5 * z**2).sum()
        values = chosen.population(
            np.maximum(acof.value + acof.uncertainty * z, 0.0), rcof.mean, rcof.sd
        )
        expected = float(values @ weight)
        spread = math.sqrt(max(float((values - expected) ** 2 @ weight), 0.0))
    assumptions = list(chosen.assumptions)
    if rcof.assumed:
        assumptions.append(
            f"Required friction {rcof.mean:g} with a standard deviation of {rcof.sd:g} "
            f"({rcof.source})."
        )
    return SlipRisk(
        probability=SourcedValue(
            middle,
            "1",
            source=chosen.source,
            uncertainty=spread,
            reason="" if spread is not None else "the available friction came without one",
            assumed=acof.assumed or rcof.assumed,
            note="spread of the available friction alone",
            interval=None if low is None or high is None else (low, high),
        ),
        low=low,
        high=high,
        expected=expected,
        model=chosen.name,
        rcof=rcof,
        assumptions=tuple(assumptions),
        breaches=tuple(chosen.breaches(acof.value, rcof.mean)),
    )
