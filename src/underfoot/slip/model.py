"""What a slip model answers, and the models there are."""

from collections.abc import Callable
from typing import Any, Protocol, runtime_checkable

from numpy.typing import ArrayLike

from underfoot.core import Breach, unknown_name
from underfoot.core.presentation import AssumingModel

from .beschorner_2016 import Beschorner2016
from .chang_2004 import Chang2004
from .report_g6 import ReportG6


@runtime_checkable
class SlipModel(AssumingModel, Protocol):
    """Probability that a step slips, from available (ACOF) and required friction (RCOF)."""

    def __call__(self, acof: ArrayLike, rcof: ArrayLike) -> Any:
        """Return the probability for persons of known ``rcof``."""
        ...

    def population(self, acof: ArrayLike, rcof_mean: ArrayLike, rcof_sd: ArrayLike) -> Any:
        """Return the mean probability over persons with normally distributed RCOF."""
        ...

    def breaches(self, acof: ArrayLike, rcof: ArrayLike) -> list[Breach]:
        """Return what leaves the range of the study."""
        ...


MODELS: dict[str, Callable[[], SlipModel]] = {
    "report_g6": ReportG6,
    "beschorner_2016": Beschorner2016,
    "chang_2004": Chang2004,
}
"""Published models by name."""


def slip_model(name: str) -> SlipModel:
    """Return a published model by name; an unknown name is answered with the nearest one.

    >>> slip_model("report_g6").name
    'report_g6'
    """
    if name not in MODELS:
        raise unknown_name("slip model", name, MODELS, where="risk.model")
    return MODELS[name]()
