"""Rival speed effect: rubber stiffens with speed and touches on less area, fluid or not."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError

from . import speed_effect

RANGES = speed_effect.RANGES
REST_SPEED = 0.01
"""m/s: speed of the report's boundary tests (G.3.1), below which area counts as that at rest."""


def modulus_exponent(modulus: Callable[[Any], Any], low: float, high: float) -> float:
    """Return n of |E*| ~ frequency^n between two angular frequencies (rad/s), at least 0.

    n = ln(|E*(high)| / |E*(low)|) / ln(high / low). ``modulus``: complex modulus of an angular
    frequency, as a relaxation spectrum has it.
    """
    if not 0 < low < high:
        raise InputError(
            f"{low:g} to {high:g} rad/s", where="modulus_exponent", allowed="0 < low < high"
        )
    ratio = np.abs(modulus(np.array([low, high])))
    return max(float(np.log(ratio[1] / ratio[0])) / math.log(high / low), 0.0)


@dataclass(frozen=True, slots=True)
class ViscoelasticArea:
    """Real contact area falls as the modulus rises: a = (1 + V / V0)^-n, whatever the fluid.

    At light load A = p / (E* slope) up to a constant (Persson 2001); a broad relaxation spectrum
    has |E*| ~ frequency^n, and frequency is proportional to the sliding speed.

    Parameters
    ----------
    exponent
        n of the modulus, 1; ``modulus_exponent`` takes it from a relaxation spectrum. A power law
        has tan delta = tan(n pi / 2): a loss tangent of 0.1 to 0.5 is n of 0.06 to 0.3. The
        report's own model loses 12 to 29 % of area from 0.1 to 1 m/s (G.1.2), n = 0.06 to 0.15.
    rest_speed
        V0, m/s.
    """

    exponent: float
    rest_speed: float = REST_SPEED
    name: str = field(default="viscoelastic_area", init=False)
    source: str = field(default="Persson 2001, J. Chem. Phys. 115:3840-3861", init=False)
    assumptions: tuple[str, ...] = field(
        default=("The fall with speed is that of the real contact area of a stiffening rubber.",),
        init=False,
    )

    def __post_init__(self) -> None:
        if not (math.isfinite(self.exponent) and self.exponent >= 0):
            raise InputError(f"{self.exponent:g}", where="exponent", allowed="0 or more")
        if not (math.isfinite(self.rest_speed) and self.rest_speed > 0):
            raise InputError(f"{self.rest_speed:g} m/s", where="rest_speed", allowed="above 0")

    def adhesion_left(
        self, *, viscosity: float | None, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> NDArray[np.float64]:
        """Return the share of adhesion left; viscosity and pressure do not enter."""
        shape = np.broadcast_shapes(np.shape(speed), np.shape(contact_pressure))
        moving = np.abs(np.asarray(speed, dtype=float))
        return np.broadcast_to((1 + moving / self.rest_speed) ** -self.exponent, shape)
