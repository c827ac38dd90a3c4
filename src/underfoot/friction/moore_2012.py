"""Measured fall of friction with speed within boundary lubrication: Moore et al. (2012), Eq. 17."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, SourcedValue, ValidityRange
from underfoot.core.arrays import Array, scalar_or_array
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message

from .law import PIN_RANGES, REPORT, UncertainInputs, coefficient
from .measured import AT_BOUND, BoundaryFriction, boundary_friction_at, friction_left, viscous_decay

SOURCE = (
    f"Moore, Menezes, Lovell, Beschorner, J. Tribology 134 (2012) 041104; {REPORT}, G.2, Eq. 17"
)
LEFT_OUT_DEVIATION = 0.051
"""Root mean square error of COF when ``stribeck_law_at`` predicts each of the report's six fluids
from the other five, at the 11 speeds."""


def stribeck_cof(
    speed: ArrayLike, cof_boundary: float, tau_hydro: float, cof_asymptote: float
) -> Any:
    """Return COF = COF_asymptote + (COF_BL - COF_asymptote) exp(-v / tau_hydro) (Eq. 17).

    ``speed`` and ``tau_hydro`` in m/s; fitted from 0.05 to 1 m/s at 266.1 kPa on a pin of 10 mm.

    Parameters:
        speed: Of sliding, m/s.
        cof_boundary: COF_BL, at rest.
        tau_hydro: Speed over which the COF falls, m/s.
        cof_asymptote: At high speed.

    >>> round(float(stribeck_cof(0.3, 0.2, 0.2, 0.05)), 3)
    0.083
    """
    decay = np.exp(-np.abs(np.asarray(speed, dtype=float)) / tau_hydro)
    cof = cof_asymptote + (cof_boundary - cof_asymptote) * decay
    return scalar_or_array(cof)


@dataclass(frozen=True, slots=True, repr=False)
class StribeckLaw(UncertainInputs):
    """tau = COF(V) p_c with COF(V) of Eq. 17, plus eta V / h.

    What it means: Eq. 17 was measured on a pin of 10 mm. There the mean-film theory (Eq. 18)
    leaves all fluids with a fit in boundary lubrication at every speed, so the report reads the
    fall as "a speed effect within boundary lubrication": something that happens between the
    asperities. Used locally under a shoe, that effect is kept and the film on the scale of the
    shoe comes on top. If part of the fall was a film under the pin after all, that part is counted
    twice. The report leaves the question open. For 50 % glycerol at 0.3 m/s the law gives 0.19;
    treaded boots without fluid pressure had 0.159 to 0.182 (G.6.2), where COF_BL alone is 0.47.

    Parameters:
        cof_boundary, tau_hydro, cof_asymptote: Of Eq. 17: 1, m/s, 1.
        viscosity: Pa s; None leaves out the viscous part.
        cof_hysteresis: Friction left when adhesion is blocked; None takes cof_asymptote. Needed for
            fluids whose asymptote lies at the bound of the fit (0.001 for water and detergent).
        assumed: Further assumptions behind the numbers, in words.
        model_deviation: Standard deviation of COF beyond that of the fitted numbers, 1; None when
            not known (the report does not print the residuals of its fits).
    """

    cof_boundary: SourcedValue
    tau_hydro: SourcedValue
    cof_asymptote: SourcedValue
    viscosity: float | None = None
    cof_hysteresis: SourcedValue | None = None
    assumed: tuple[Message, ...] = ()
    model_deviation: float | None = None
    name: str = field(default="stribeck", init=False)
    source: str = field(default=SOURCE, init=False)

    def __post_init__(self) -> None:
        UncertainInputs.__post_init__(self)
        if self.tau_hydro.value == 0:
            raise InputError("0 m/s", where="tau_hydro", allowed="above 0")

    @classmethod
    def from_measured(
        cls,
        friction: BoundaryFriction,
        *,
        cof_hysteresis: SourcedValue | None = None,
        others: tuple[BoundaryFriction, ...] = (),
    ) -> StribeckLaw:
        """Return the law of a fluid that has the fit.

        ``cof_hysteresis`` is the measured hysteresis of the pair. Without it, and when the
        fluid's own asymptote lies at the bound of its fit, that of ``others`` on the same pair is
        taken (``friction_left``): it moves friction between the parts, not their sum.

        Raises:
            InputError: No fit of Eq. 17 for this fluid (75 % glycerol and canola oil have none).
        """
        if friction.tau_hydro is None or friction.cof_asymptote is None:
            raise InputError(
                f"Eq. 17 was not fitted for {friction.fluid}",
                where="friction.tau_hydro",
                remedy="Choose friction.model = boundary, or give tau_hydro and cof_asymptote",
            )
        notes: list[Message] = []
        if friction.pair:
            notes.append(Message("Friction was measured on {pair}.", pair=friction.pair))
        if friction.cof_boundary.assumed:
            level = Message("COF_BL of {fluid} is assumed.", fluid=friction.fluid)
            notes.append(Message.plain(friction.cof_boundary.note or level))
        at_bound = float(friction.cof_asymptote) < AT_BOUND
        if cof_hysteresis is None and at_bound and others:
            cof_hysteresis = friction_left(others)
            notes.append(
                Message(
                    "Hysteresis is the friction that stays at high speed under glycerol, at most "
                    "COF."
                )
            )
        return cls(
            friction.cof_boundary,
            friction.tau_hydro,
            friction.cof_asymptote,
            friction.viscosity,
            cof_hysteresis,
            tuple(notes),
        )

    measured = classmethod(renamed_member("measured", "from_measured", gone="0.4"))

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind."""
        return (
            Message("Contact friction is proportional to the contact pressure."),
            Message(
                "The fall with speed of a pin happens between the asperities, not in a film under "
                "it."
            ),
            *self.assumed,
        )

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        constants = (self.cof_boundary, self.tau_hydro, self.cof_asymptote)
        cof = stribeck_cof(velocity, *(coefficient(constant, "Eq. 17") for constant in constants))
        left = coefficient(self.cof_hysteresis or self.cof_asymptote, "cof_hysteresis")
        hysteresis = np.minimum(left, cof)
        return (cof - hysteresis) * pressure, hysteresis * pressure

    @property
    def ranges(self) -> Mapping[str, ValidityRange]:
        return PIN_RANGES


def stribeck_law_at(
    viscosity: float, measured: Sequence[BoundaryFriction], *, fluid: str = ""
) -> StribeckLaw:
    """Return an assumed Eq. 17 for a fluid of which only the viscosity is known.

    tau_hydro = (mean of viscosity x tau_hydro over the fitted fluids) / viscosity, COF_asymptote
    the friction left of the fitted fluids, COF_BL by ``boundary_friction_at`` among the fitted
    fluids. The report states that all its data fall on one curve of viscosity x speed (Fig. 16),
    but publishes no such fit.
    """
    fitted = [m for m in measured if m.tau_hydro is not None and m.cof_asymptote is not None]
    decay = viscous_decay(fitted)
    between = boundary_friction_at(viscosity, fitted, fluid=fluid)
    tau = float(decay) / viscosity
    left = friction_left(fitted)
    return StribeckLaw(
        cof_boundary=between.cof_boundary,
        tau_hydro=SourcedValue(
            tau,
            "m/s",
            source=decay.source,
            uncertainty=(None if decay.uncertainty is None else decay.uncertainty / viscosity),
            assumed=True,
            note=decay.note,
        ),
        cof_asymptote=left,
        viscosity=viscosity,
        assumed=(
            Message("{note}.", note=between.cof_boundary.note),
            Message(
                "One constant viscosity x tau_hydro holds for all fluids of the pair "
                "({decay:.3g} mPa m).",
                decay=1e3 * (decay.value or math.nan),
            ),
        ),
        model_deviation=LEFT_OUT_DEVIATION,
    )
