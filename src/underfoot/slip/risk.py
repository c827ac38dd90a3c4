"""Probability of slipping over a population, with its band; the friction that a risk needs."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, SourcedValue
from underfoot.core.presentation import Presentable, Table

from ._checks import LARGEST_ACOF
from .model import SlipModel
from .report_g6 import ReportG6
from .required import ADULTS_LEVEL_WALKING, RcofPopulation

_Z95 = 1.959963984540054
_NODES = 201


@dataclass(frozen=True, slots=True, repr=False)
class SlipRisk(Presentable):
    """Probability that a step of the population slips.

    ``probability`` is the mean over the uncertain ACOF, its uncertainty the standard deviation
    that the ACOF's uncertainty makes. ``low`` and ``high`` bound 95 % of it; None when the ACOF
    came without uncertainty. ``at_best_estimate`` is the probability at the best estimate of ACOF.
    """

    probability: SourcedValue
    low: float | None
    high: float | None
    at_best_estimate: float
    model: str
    rcof: RcofPopulation
    assumptions: tuple[str, ...]
    breaches: tuple[Breach, ...]

    def table(self) -> Table:
        """Return probability, its 95 % interval, the population, and what it rests on."""
        rows: list[tuple[str, object]] = [
            ("probability of a slip", self.probability.value),
            ("95 % interval, low", self.low),
            ("95 % interval, high", self.high),
            ("at the best estimate of ACOF", self.at_best_estimate),
            ("RCOF, mean of the population", self.rcof.mean),
            ("RCOF, standard deviation", self.rcof.sd),
            ("model", self.model),
        ]
        rows += [("outside the tested range", str(breach)) for breach in self.breaches]
        rows += [("assumption", assumption) for assumption in self.assumptions]
        return Table("Slip risk", ("quantity", "value"), rows)

    def __repr__(self) -> str:
        band = "" if self.low is None else f", 95 % interval {self.low:.3g} to {self.high:.3g}"
        outside = ", outside the tested range" if self.breaches else ""
        return f"SlipRisk({self.probability.value:.3g}{band}, model {self.model}{outside})"


def slip_risk(
    acof: SourcedValue | ArrayLike,
    *,
    rcof: RcofPopulation = ADULTS_LEVEL_WALKING,
    model: SlipModel | None = None,
    samples: ArrayLike | None = None,
) -> Any:
    """Return how likely a step slips: the mean of P(ACOF, RCOF) over the population's RCOF.

    Parameters:
        acof: Available coefficient of friction: a ``SourcedValue`` with its standard deviation if
            known, a number, or an array of numbers.
        rcof: Normally distributed required friction of the population.
        model: A published model; None takes ``ReportG6``.
        samples: (n,) draws of ACOF, as ``friction.sampled_cof`` gives them; None takes it as
            normal.

    Returns:
        SlipRisk: For one ACOF; for an array a list of them, nested as the array is.

    The band holds the uncertainty of ACOF (cut at 0) alone: not that of the model, whose
    standard errors the report does not print, nor that of the population.

    Raises:
        InputError: ACOF not determined, negative or not finite.

    >>> 0 < slip_risk(0.2).probability.value < 1
    True
    """
    if not isinstance(acof, SourcedValue):
        if np.ndim(acof):
            if samples is not None:
                raise InputError(
                    "draws of one ACOF with several ACOF", where="samples", allowed="one ACOF"
                )
            return [slip_risk(value, rcof=rcof, model=model) for value in np.asarray(acof)]
        acof = SourcedValue(float(np.asarray(acof, dtype=float)))
    chosen: SlipModel = ReportG6() if model is None else model
    if acof.value is None:
        raise InputError(f"the available friction was not determined: {acof.reason}", where="acof")
    middle = float(chosen.population(acof.value, rcof.mean, rcof.sd))
    low = high = spread = None
    expected = middle
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
            expected,
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
        at_best_estimate=middle,
        model=chosen.name,
        rcof=rcof,
        assumptions=tuple(assumptions),
        breaches=tuple(chosen.breaches(acof.value, rcof.mean)),
    )


def needed_acof(
    risk: float, *, rcof: RcofPopulation = ADULTS_LEVEL_WALKING, model: SlipModel | None = None
) -> float:
    """Return the ACOF at which a step of the population slips with probability ``risk``.

    Solves P(ACOF) = risk, where P falls with ACOF; to 1e-12.

    Parameters:
        risk: Target probability, above 0 and below 1.
        rcof: Required friction of the population.
        model: A published model; None takes ``ReportG6``.

    Raises:
        InputError: A risk outside (0, 1), or one that not even no friction (or a COF of 5) reaches.

    >>> round(needed_acof(0.05), 3)
    0.218
    """
    from scipy.optimize import root_scalar  # heavy, and only this function needs it

    if not 0 < risk < 1:
        raise InputError(f"{risk:g}", where="risk", allowed="above 0 and below 1")
    chosen: SlipModel = ReportG6() if model is None else model

    def excess(acof: float) -> float:
        return float(chosen.population(acof, rcof.mean, rcof.sd)) - risk

    if excess(0.0) < 0 or excess(LARGEST_ACOF) > 0:
        raise InputError(
            f"a risk of {risk:g} is reached by no ACOF between 0 and {LARGEST_ACOF:g}",
            where="risk",
            remedy="Check the required friction of the population",
        )
    return float(root_scalar(excess, bracket=(0.0, LARGEST_ACOF), method="brentq", xtol=1e-12).root)
