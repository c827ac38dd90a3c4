"""What the film and the outsole ask of a rough interface."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import Breach


@runtime_checkable
class PressureGapLaw(Protocol):
    """Mean-field law of a rough interface: pressure and permeability against the mean gap.

    ``pressure`` decreases with the gap and continues linearly (once differentiable) below zero, so
    that a Newton iteration that overshoots meets a finite, growing pressure.
    """

    @property
    def name(self) -> str:
        """Short name for reports."""
        ...

    @property
    def source(self) -> str:
        """Paper and equation, or the computation the law comes from."""
        ...

    def pressure(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return the asperity pressure (Pa) at mean gap ``gap`` (m)."""
        ...

    def stiffness(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return -d pressure / d gap (Pa/m), never negative."""
        ...

    def flow_factor(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return the pressure flow factor phi that multiplies h^3 / (12 eta); 1 when smooth."""
        ...

    def flow_factor_slope(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return d phi / d gap (1/m)."""
        ...

    def breaches(self, *, pressure: ArrayLike, speed: ArrayLike) -> list[Breach]:
        """Return what leaves the tested range at these pressures (Pa) and speeds (m/s)."""
        ...
