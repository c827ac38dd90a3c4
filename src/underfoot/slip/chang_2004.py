"""A step slips when it needs more friction than there is: Chang (2004)."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtr

from underfoot.core import Breach
from underfoot.core.arrays import Array, scalar_or_array
from underfoot.core.remark import Message

from ._checks import PresentableModel, available, check_required_friction, deviation

SOURCE = (
    "Chang, A statistical model to estimate the probability of slip and fall incidents, "
    "Safety Science 42 (2004) 779-789"
)


@dataclass(frozen=True, slots=True, repr=False)
class Chang2004(PresentableModel):
    """P = Phi((mean RCOF - ACOF) / sd of RCOF): required against available friction, no curve.

    A person of known RCOF slips if RCOF > ACOF (probability 1/2 if equal). With a normally
    distributed RCOF the mean over the population is closed; a normal ACOF adds its variance. No
    slip was measured for it: what people can make up for is left out.
    """

    name: str = field(default="chang_2004", init=False)
    source: str = field(default=SOURCE, init=False)
    assumptions: tuple[Message, ...] = field(
        default=(Message("Every step that needs more friction than there is slips."),), init=False
    )

    def __call__(self, acof: ArrayLike, rcof: ArrayLike) -> Any:
        return scalar_or_array(np.heaviside(check_required_friction(rcof) - available(acof), 0.5))

    def population(self, acof: ArrayLike, rcof_mean: ArrayLike, rcof_sd: ArrayLike) -> Any:
        a, mean, sd = np.broadcast_arrays(
            available(acof),
            check_required_friction(rcof_mean, "rcof_mean"),
            deviation(rcof_sd, "rcof_sd"),
        )
        with np.errstate(over="ignore"):  # of a spread next to nothing: 0 or 1
            certain = ndtr((mean - a) / np.where(sd > 0, sd, 1.0))
        return scalar_or_array(np.where(sd > 0, certain, np.heaviside(mean - a, 0.5)))

    def draw_probability(
        self, acof: Array, rcof_mean: ArrayLike, rcof_sd: ArrayLike, normal: Callable[[str], Array]
    ) -> Array:
        """Return the probability in draws (n,) of ACOF: the model has no constants to draw."""
        return np.asarray(self.population(acof, rcof_mean, rcof_sd))

    def breaches(self, acof: ArrayLike, rcof: ArrayLike) -> list[Breach]:
        return []
