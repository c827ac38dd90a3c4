"""Boundary lubrication: adhesion and hysteresis apart (Eq. 22-25), what a fluid leaves (Eq. 26)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError
from underfoot.core.remark import NOTHING, Message

from .. import statistics
from ..recording.measurement import NO_SCATTER, Flag, Measurement, remark

_SAID = {
    "hysteresis": Message("friction with the blocking oil, all adhesion taken as blocked (Eq. 23)"),
    "uncertainty": Message("standard errors of the means added in squares"),
}


@dataclass(frozen=True, slots=True)
class FrictionSplit:
    """Friction forces of one shoe-floor pair (N): dry, hysteresis, adhesion dry and by fluid."""

    dry: Measurement
    hysteresis: Measurement
    adhesion: Measurement
    lubricated_adhesion: Mapping[str, Measurement]


def friction_split(
    dry: Sequence[float],
    blocked: Sequence[float],
    lubricated: Mapping[str, Sequence[float]] | None = None,
) -> FrictionSplit:
    """Return adhesion and hysteresis of one shoe-floor pair from repeated friction forces.

    F_hysteresis = F with the blocking oil (Eq. 23), F_adhesion = F_dry - F_hysteresis (Eq. 24),
    F_adhesion(lubricated) = F_lubricated - F_hysteresis (Eq. 25). Standard errors add in squares;
    all adhesions of a pair share the error of its hysteresis and are therefore correlated.

    ``dry`` and ``blocked``: friction forces (N) dry and with the oil that blocks adhesion (SAE
    75W-140 in the report). ``lubricated``: friction forces (N) by fluid.

    DataError: no values, or values that are not finite.
    """
    total = _mean("dry friction", dry)
    hysteresis = _mean("hysteresis friction", blocked)
    return FrictionSplit(
        total,
        hysteresis,
        _difference("adhesion friction", total, hysteresis),
        {
            fluid: _difference(
                Message("adhesion friction with {fluid}", fluid=fluid),
                _mean(fluid, forces),
                hysteresis,
            )
            for fluid, forces in (lubricated or {}).items()
        },
    )


@dataclass(frozen=True, slots=True)
class FluidCoefficients:
    """Eq. 26 of one fluid: alpha (N) and beta with standard errors from the pooled residual."""

    fluid: str
    alpha: float
    beta: float
    alpha_error: float
    beta_error: float
    n: int


@dataclass(frozen=True, slots=True)
class AlphaBeta:
    """Eq. 26 for all fluids: coefficients, quality, and both analyses of variance.

    ``type_two`` and ``type_three`` can differ hugely for the fluid: type III compares the fluids
    at a dry adhesion of zero, type II at their common slope.
    """

    fluids: tuple[FluidCoefficients, ...]
    model: statistics.LinearModel
    type_two: statistics.AnovaTable
    type_three: statistics.AnovaTable
    comparisons: tuple[statistics.LevelDifference, ...]
    mean_absolute_residual: float

    def __getitem__(self, fluid: str) -> FluidCoefficients:
        return next(row for row in self.fluids if row.fluid == fluid)


def alpha_beta(
    fluid: Sequence[str], dry_adhesion: ArrayLike, lubricated_adhesion: ArrayLike
) -> AlphaBeta:
    """Return Eq. 26, F_adhesion(lubricated) = alpha + beta F_adhesion(dry), for every fluid.

    One regression with a slope and an intercept for each fluid and one residual variance; the
    fluids are compared (Tukey) at the mean dry adhesion.

    ``fluid``, ``dry_adhesion``, ``lubricated_adhesion``: shape (n,): name, N, N.

    DataError: as ``linear_model``; a fluid with fewer than two different dry adhesions.
    """
    names = [str(name) for name in fluid]
    x = np.asarray(dry_adhesion, dtype=float)
    y = np.asarray(lubricated_adhesion, dtype=float)
    predictors = {
        "fluid": statistics.predictor("fluid", names),
        "dry adhesion": statistics.predictor("dry adhesion", x),
    }
    terms = ("fluid", "dry adhesion", "fluid:dry adhesion")
    for name in dict.fromkeys(names):
        if np.ptp(x[[n == name for n in names]]) == 0:
            raise DataError("one dry adhesion only: no slope", where=name)
    response = "lubricated adhesion"
    model = statistics.linear_model(y, predictors, terms, name=response)
    rows = []
    for i, name in enumerate(predictors["fluid"].levels):
        at = model.design.rows({"fluid": np.array([i, i]), "dry adhesion": np.array([0.0, 1.0])})
        contrasts = np.array([at[0], at[1] - at[0]])
        values = contrasts @ model.coefficients
        errors = np.sqrt(np.einsum("ij,jk,ik->i", contrasts, model.covariance, contrasts))
        numbers = map(float, (*values, *errors))
        rows.append(FluidCoefficients(name, *numbers, n=names.count(name)))
    two, three = (
        statistics.analysis_of_variance(y, predictors, terms, ss_type=kind, name=response)
        for kind in (2, 3)
    )
    tukey, residual = tuple(statistics.tukey_hsd(model, "fluid")), np.abs(y - model.fitted).mean()
    return AlphaBeta(tuple(rows), model, two, three, tukey, float(residual))


def _mean(name: str, values: Sequence[float]) -> Measurement:
    forces = np.asarray(values, dtype=float)
    if not len(forces) or not np.isfinite(forces).all():
        raise DataError("no finite forces", where=name)
    error = float(forces.std(ddof=1) / np.sqrt(len(forces))) if len(forces) > 1 else None
    return _force(name, float(forces.mean()), error, len(forces))


def _difference(name: str, first: Measurement, second: Measurement) -> Measurement:
    assert first.value is not None
    assert second.value is not None
    value = first.value - second.value
    error = None
    if first.uncertainty is not None and second.uncertainty is not None:
        error = float(np.hypot(first.uncertainty, second.uncertainty))
    negative = remark("negative: the oil does not block more adhesion than this condition")
    return _force(name, value, error, min(first.n, second.n), (negative,) if value < 0 else ())


def _force(
    name: str, value: float, error: float | None, n: int, flags: tuple[Flag, ...] = ()
) -> Measurement:
    reason = NO_SCATTER if error is None else NOTHING
    return Measurement(name, value, "N", error, reason, n, flags, _SAID)
