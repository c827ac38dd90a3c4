"""Friction laws from measured trials: what a tribometer read becomes a law of cases."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from underfoot.core import InputError, SourcedValue
from underfoot.core.remark import Message, Remark

if TYPE_CHECKING:
    from underfoot.friction import StribeckLaw
    from underfoot.trials.machines.stribeck_fit import FitParameter, StribeckFit


def stribeck_law_from_fit(
    fit: StribeckFit, *, source: str, viscosity: float | None = None, fluid: str = "the fluid"
) -> StribeckLaw:
    """Return Eq. 17 as a friction law from a fit of trials (``trials.stribeck_fit``).

    Standard errors become the law's uncertainties, the residuals of the fit its own error; what the
    fit did not identify in its range of speeds is kept with a note.

    Parameters:
        fit: Of COF against speed.
        source: Who measured it, and on what pair.
        viscosity: Pa s; None leaves out the viscous part.

    Errors:
        InputError: Friction did not fall with speed, by the report's rule (R^2 below 0.5) or as it
            rises.
    """
    from underfoot.friction import StribeckLaw

    if fit.tau.value is None or fit.asymptote.value is None or fit.raw[0] <= fit.raw[2]:
        raise InputError(
            f"COF does not fall with speed as Eq. 17 (R^2 {fit.r_squared:.2f})",
            where=f"stribeck_fit, {fluid}",
            remedy="Use SpeedTableLaw with the readings, or BoundaryLaw with their mean",
        )

    def sourced_value(parameter: FitParameter) -> SourcedValue:
        return SourcedValue(
            parameter.value,
            parameter.unit,
            source=source,
            uncertainty=parameter.standard_error,
            reason="" if parameter.standard_error is not None else "on the bound of the fit",
            note=parameter.remark,
        )

    notes = [
        Remark.of(p.name, Message("{remark}.", remark=p.remark))
        for p in (fit.boundary, fit.tau, fit.asymptote)
        if p.remark
    ]
    return StribeckLaw(
        sourced_value(fit.boundary),
        sourced_value(fit.tau),
        sourced_value(fit.asymptote),
        viscosity,
        assumed=tuple(notes),
        model_deviation=math.sqrt(fit.residual_sum / max(fit.n - 3, 1)),
    )
