"""Probability of slipping over a population, with its band; the friction that a risk needs."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri

from underfoot.core import Breach, InputError, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message
from underfoot.friction.propagation import normal_draws

from ._checks import LARGEST_ACOF
from .model import SlipModel
from .report_g6 import ReportG6
from .required import ADULTS_LEVEL_WALKING, RcofPopulation

DRAWS = 4000
"""Of an available friction that comes with a standard deviation alone."""


@dataclass(frozen=True, slots=True, repr=False)
class SlipRisk(Presentable):
    """Probability that a step of the population slips.

    ``probability`` is the mean over draws of the ACOF and of the model's constants, its uncertainty
    their standard deviation. ``low`` and ``high`` bound 95 % of them; None when the ACOF came
    without uncertainty. ``at_best_estimate`` is the probability at the best estimate of all.
    """

    probability: SourcedValue
    low: float | None
    high: float | None
    at_best_estimate: float
    model: str
    rcof: RcofPopulation
    assumptions: tuple[Message, ...]
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


def slip_chances(
    acof: Array,
    rcof: RcofPopulation,
    model: SlipModel,
    normal: Callable[[str], Array] | None = None,
) -> Array:
    """Return the slip probability of the population in each draw of what is not known, (n,).

    Every answer to "how often does a person slip here" averages these: ``run``, ``risk``, ``slip``
    and ``choose``.

    Parameters:
        acof: Draws (n,) of the available friction; below 0 counts as 0, beyond what any sole has
            as the most it has.
        rcof: Required friction of the population, on a slope ``rcof.on_slope``.
        model: A slip model. One without ``draw_probability`` is taken as exact.
        normal: Standard normal draws (n,) by name, of the model's constants and of what the
            population is off by; None draws them.
    """
    drawn = np.clip(np.asarray(acof, dtype=float), 0.0, LARGEST_ACOF)
    normal = normal or _draws_by_name(drawn.size)
    people = rcof.draw_moments(normal)
    known = getattr(model, "draw_probability", None)
    if known is None:
        return np.asarray(model.population(drawn, *people))
    return known(drawn, *people, normal)


def mean_of_draws(chances: Array, **rest: Any) -> SourcedValue:
    """Return a probability as the mean of its draws (n,), with their spread and 95 % interval."""
    low, high = (float(end) for end in np.quantile(chances, [0.025, 0.975]))
    spread = float(np.std(chances, ddof=1))
    return SourcedValue(
        float(np.mean(chances)), "1", uncertainty=spread, interval=(low, high), **rest
    )


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

    The band holds the uncertainty of ACOF (cut at 0), how far publications differ in the model's
    constants, and what the population's mean and standard deviation are off by, where known.

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
        raise InputError(
            Message("the available friction was not determined: {reason}", reason=acof.reason),
            where="acof",
        )
    most = min(
        float(acof.value), LARGEST_ACOF
    )  # as of draws: what a stiff fluid shears with is more
    middle = float(chosen.population(most, rcof.mean, rcof.sd))
    assumptions = list(chosen.assumptions)
    if rcof.assumed:
        assumptions.append(
            Message(
                "Required friction {mean:g} with a standard deviation of {sd:g} ({source}).",
                mean=rcof.mean,
                sd=rcof.sd,
                source=rcof.source,
            )
        )
    about: dict[str, Any] = {
        "source": chosen.source,
        "assumed": acof.assumed or rcof.assumed,
        "note": "spread of the available friction and of the model's constants",
    }
    drawn = acof_draws(acof, samples)
    if drawn is None:
        reason = "the available friction came without one"
        probability = SourcedValue(middle, "1", reason=reason, **about)
    else:
        probability = mean_of_draws(slip_chances(drawn, rcof, chosen), **about)
    return SlipRisk(
        probability=probability,
        low=probability.interval and probability.interval[0],
        high=probability.interval and probability.interval[1],
        at_best_estimate=middle,
        model=chosen.name,
        rcof=rcof,
        assumptions=tuple(assumptions),
        breaches=tuple(chosen.breaches(acof.value, rcof.mean)),
    )


def acof_draws(acof: SourcedValue, samples: ArrayLike | None = None) -> Array | None:
    """Return draws (n,) of an available friction; None where its spread is not known.

    Without ``samples`` it is normal, by one value of each of ``DRAWS`` equally likely strata.
    """
    if samples is not None:
        return np.asarray(samples, dtype=float)
    if acof.uncertainty is None or acof.value is None:
        return None
    if not math.isfinite(acof.uncertainty):
        raise InputError("the uncertainty is not finite", where="acof")
    middle = ndtri((np.arange(DRAWS) + 0.5) / DRAWS)
    order = np.random.default_rng(0).permutation(DRAWS)
    return acof.value + acof.uncertainty * middle[order]


def _draws_by_name(count: int) -> Callable[[str], Array]:
    return lambda name: normal_draws(0, name, count)


def needed_acof(
    risk: float,
    *,
    rcof: RcofPopulation = ADULTS_LEVEL_WALKING,
    model: SlipModel | None = None,
    acof: SourcedValue | None = None,
    samples: ArrayLike | None = None,
) -> float:
    """Return the ACOF at which a step of the population slips with probability ``risk``.

    Solves P(ACOF) = risk, where P falls with ACOF; to 1e-9. An ``acof`` with a spread keeps it, as
    a share of its value: P is then the mean over its draws, as ``slip_risk`` gives it.

    Parameters:
        risk: Target probability, above 0 and below 1.
        rcof: Required friction of the population.
        model: A published model; None takes ``ReportG6``.
        acof, samples: The present friction as ``slip_risk`` takes it; None is known exactly.

    Raises:
        InputError: A risk outside (0, 1), or one that not even no friction (or a COF of 5) reaches.

    >>> round(needed_acof(0.05), 3)
    0.218
    """
    from scipy.optimize import root_scalar  # heavy, and only this function needs it

    if not 0 < risk < 1:
        raise InputError(f"{risk:g}", where="risk", allowed="above 0 and below 1")
    chosen: SlipModel = ReportG6() if model is None else model
    drawn = None if acof is None or not acof.value else acof_draws(acof, samples)
    shares = None if drawn is None or acof is None else drawn / float(acof.value or 1.0)

    def excess(value: float) -> float:
        if shares is None:
            return float(chosen.population(value, rcof.mean, rcof.sd)) - risk
        scaled = np.clip(value * shares, 0.0, LARGEST_ACOF)
        return float(np.mean(slip_chances(scaled, rcof, chosen))) - risk

    if excess(0.0) < 0 or excess(LARGEST_ACOF) > 0:
        raise InputError(
            Message(
                "a risk of {risk:g} is reached by no ACOF between 0 and {largest_acof:g}",
                risk=risk,
                largest_acof=LARGEST_ACOF,
            ),
            where="risk",
            remedy="Check the required friction of the population",
        )
    return float(root_scalar(excess, bracket=(0.0, LARGEST_ACOF), method="brentq", xtol=1e-9).root)
