"""How much friction keeps the chance of a slip below a wanted one."""

from __future__ import annotations

from underfoot.core import InputError

from .model import SlipModel
from .report_g6 import ReportG6
from .required import ADULTS_LEVEL_WALKING, RequiredFriction

_MOST = 5.0


def needed_acof(
    risk: float,
    *,
    rcof: RequiredFriction = ADULTS_LEVEL_WALKING,
    model: SlipModel | None = None,
) -> float:
    """Return the ACOF at which a step of the population slips with probability ``risk``.

    Solves P(ACOF) = risk, where P falls with ACOF; to 1e-12.

    Parameters
    ----------
    risk
        Wanted probability, above 0 and below 1.
    rcof
        Required friction of the population.
    model
        A published model; None takes ``ReportG6``.

    Errors
    ------
    InputError
        A risk outside (0, 1), or one that not even no friction (or a COF of 5) reaches.
    """
    from scipy.optimize import root_scalar

    if not 0 < risk < 1:
        raise InputError(f"{risk:g}", where="risk", allowed="above 0 and below 1")
    chosen: SlipModel = ReportG6() if model is None else model

    def excess(acof: float) -> float:
        return float(chosen.population(acof, rcof.mean, rcof.sd)) - risk

    if excess(0.0) < 0 or excess(_MOST) > 0:
        raise InputError(
            f"a risk of {risk:g} is reached by no ACOF between 0 and {_MOST:g}",
            where="risk",
            remedy="Check the required friction of the population",
        )
    return float(root_scalar(excess, bracket=(0.0, _MOST), method="brentq", xtol=1e-12).root)
