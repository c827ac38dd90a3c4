"""Blind predictions: calibrate a mechanism on some fluids, predict the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError

from .least_squares import Calibration
from .speed_effects import Mechanism, calibrated_mechanism, predicted
from .stribeck_points import CofPoints, Pin, fluid_points

if TYPE_CHECKING:
    from underfoot.friction import BoundaryFriction


@dataclass(frozen=True, slots=True)
class Prediction:
    """One fluid (or roughness) predicted without having been seen."""

    points: CofPoints
    cof: NDArray[np.float64]

    @property
    def error(self) -> float:
        """Mean absolute error over the speeds."""
        return float(np.mean(np.abs(self.cof - self.points.cof)))


@dataclass(frozen=True, slots=True)
class BlindTest:
    """A mechanism calibrated on ``fluid`` and its predictions of the rest.

    ``own_boundary``: COF_BL of each fluid was an input where measured as a limit at low speed.
    """

    mechanism: Mechanism
    calibration: Calibration
    predictions: tuple[Prediction, ...]
    own_boundary: bool

    @property
    def error(self) -> float:
        """Mean absolute error over fluids and speeds, each fluid counted alike."""
        return float(np.mean([one.error for one in self.predictions]))

    @property
    def deviation(self) -> float:
        """Root mean square error over fluids and speeds: the model's standard deviation."""
        return float(
            np.sqrt(np.mean([np.mean((p.cof - p.points.cof) ** 2) for p in self.predictions]))
        )


def blind_test(
    chosen: Mechanism,
    calibration_points: CofPoints,
    others: Sequence[CofPoints],
    pin: Pin,
    *,
    own_boundary: bool,
) -> BlindTest:
    """Return the predictions of ``others`` by a mechanism calibrated on one set of points alone."""
    fit = calibrated_mechanism(chosen, (calibration_points,), pin)
    return BlindTest(
        chosen,
        fit,
        tuple(
            Prediction(one, predicted(chosen, fit.values, one, pin, own_boundary=own_boundary))
            for one in others
        ),
        own_boundary,
    )


def leave_one_out(
    chosen: Mechanism, points: Sequence[CofPoints], pin: Pin
) -> tuple[Prediction, ...]:
    """Return each fluid predicted from its viscosity by the mechanism calibrated on all others."""
    if len(points) < 2:
        raise InputError(f"{len(points)} fluid", where="points", allowed="2 or more")
    found = []
    for left_out in points:
        rest = tuple(one for one in points if one is not left_out)
        fit = calibrated_mechanism(chosen, rest, pin)
        found.append(
            Prediction(left_out, predicted(chosen, fit.values, left_out, pin, own_boundary=False))
        )
    return tuple(found)


def stribeck_left_out(fluids: Sequence[BoundaryFriction], pin: Pin) -> tuple[Prediction, ...]:
    """Return each fluid predicted by ``stribeck_law_at`` from the others: the peer to beat."""
    from underfoot.friction import stribeck_law_at

    found = []
    for one in fluids:
        law = stribeck_law_at(one.viscosity, [other for other in fluids if other is not one])
        points = fluid_points(one, rq=pin.sole_rq)
        # a film of 1 m: the viscous part is no part of what Eq. 17 fits
        shear = law(pin.pressure, points.speed, 1.0)
        found.append(Prediction(points, (shear.adhesion + shear.hysteresis) / pin.pressure))
    return tuple(found)
