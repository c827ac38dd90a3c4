"""Exponential pressure-gap law of a rough interface (Persson's low-load form)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import Breach, InputError, Range, breaches


@dataclass(frozen=True, slots=True)
class ExponentialLaw:
    """P(h) = p0 exp(-h / u0) with p0 = 0.375 E / (1 - nu^2) and u0 = 0.5 Rq; phi = 1.

    Below h = 0 the pressure continues along its tangent, p0 (1 - h / u0).

    Parameters
    ----------
    modulus
        Young's modulus of the softer body at the rate of the asperities, Pa.
    poisson_ratio
        Of the softer body; 0.5 for rubber.
    rq
        Root-mean-square roughness of the two surfaces together, m.

    Notes
    -----
    Persson, Physical Review Letters 99 (2007) 125502: p = beta E* exp(-u/u0), beta
    about 0.375 and u0 = gamma h_rms, gamma about 0.5 for a self-affine surface of Hurst exponent
    0.8. Low squeezing pressure: tested below 0.1 E* (assumed limit). The gap enters the flow
    uncorrected (phi = 1), which overrates the permeability at small gaps.
    """

    modulus: float
    poisson_ratio: float
    rq: float
    name: str = field(default="exponential", init=False)
    source: str = field(default="Persson 2007, Phys. Rev. Lett. 99:125502", init=False)

    def __post_init__(self) -> None:
        for label, value in (("modulus", self.modulus), ("rq", self.rq)):
            if not (math.isfinite(value) and value > 0):
                raise InputError(
                    f"{label} {value} of the pressure-gap law is not positive",
                    where=label,
                    allowed="a finite value above 0",
                )
        if not 0 <= self.poisson_ratio <= 0.5:
            raise InputError(
                f"Poisson ratio {self.poisson_ratio} is outside the physical range",
                where="poisson_ratio",
                allowed="0 to 0.5",
            )

    @property
    def reference_pressure(self) -> float:
        """p0, the pressure at zero mean gap, Pa."""
        return 0.375 * self.modulus / (1 - self.poisson_ratio**2)

    @property
    def decay_length(self) -> float:
        """u0, the gap over which the pressure falls by e, m."""
        return 0.5 * self.rq

    def pressure(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return p0 exp(-h/u0), continued linearly below h = 0, in Pa."""
        reduced = np.asarray(gap, dtype=float) / self.decay_length
        falling = np.exp(-np.maximum(reduced, 0.0))
        return self.reference_pressure * np.where(reduced > 0, falling, 1 - reduced)

    def stiffness(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return -dP/dh in Pa/m."""
        reduced = np.asarray(gap, dtype=float) / self.decay_length
        return self.reference_pressure / self.decay_length * np.exp(-np.maximum(reduced, 0.0))

    def flow_factor(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return 1: the mean gap carries the flow."""
        return np.ones_like(np.asarray(gap, dtype=float))

    def flow_factor_slope(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return 0."""
        return np.zeros_like(np.asarray(gap, dtype=float))

    def breaches(self, *, pressure: ArrayLike, speed: ArrayLike) -> list[Breach]:
        """Return the breach of the low-load range, if any (the law does not know the speed)."""
        limit = 0.1 * self.modulus / (1 - self.poisson_ratio**2)
        ranges = {"pressure": Range(0.0, limit, "Pa", self.source)}
        return breaches(self.name, ranges, {"pressure": pressure})
