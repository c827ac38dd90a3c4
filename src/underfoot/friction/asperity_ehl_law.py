"""The law of films at single asperities with the numbers calibrated on the report's fluids."""

from __future__ import annotations

from dataclasses import dataclass

from underfoot.core import Range, SourcedValue

from .asperity_ehl import AsperityEHL
from .asperity_scale import AsperityScale
from .measured import BoundaryFriction
from .speed_effect import SpeedEffectLaw

_PAIR = "polyurethane on vinyl (G.2.2)"


@dataclass(frozen=True, slots=True)
class CalibratedLevels:
    """Numbers that belong together: they come from one least-squares fit.

    ``deviation`` is the root mean square error of COF: blind where it says so in the docs;
    ``product`` the viscosity x speed of the fluids behind the numbers, Pa m.
    """

    fine_roughness: SourcedValue
    cof_boundary: SourcedValue | None
    cof_hysteresis: SourcedValue
    deviation: float
    product: Range


def _level(value: float, deviation: float, unit: str, fluids: str) -> SourcedValue:
    return SourcedValue(
        value,
        unit,
        source=f"calibrated on {fluids}, {_PAIR}",
        uncertainty=deviation,
        assumed=True,
        note=f"Calibrated on {fluids}, {_PAIR}; taken to hold for this pair",
    )


_FITTED, _ALL = "the four fluids with a fit of Eq. 17", "all six fluids"
OWN_BOUNDARY = CalibratedLevels(
    fine_roughness=_level(15.65e-9, 0.58e-9, "m", _FITTED),
    cof_boundary=None,
    cof_hysteresis=_level(0.0952, 0.0110, "1", _FITTED),
    deviation=0.030,
    product=Range(0.52e-3 * 0.05, 5.54e-3, "Pa*m", f"{_FITTED}, {_PAIR}"),
)
"""For fluids whose COF_BL was measured as a limit at low speed; deviation: the five fluids that a
calibration on 50 % glycerol predicts blind."""

ONE_CURVE = CalibratedLevels(
    fine_roughness=_level(11.94e-9, 0.47e-9, "m", _ALL),
    cof_boundary=_level(0.7311, 0.0161, "1", _ALL),
    cof_hysteresis=_level(0.1243, 0.0061, "1", _ALL),
    deviation=0.046,
    product=Range(0.52e-3 * 0.05, 74.6e-3, "Pa*m", f"{_ALL}, {_PAIR}"),
)
"""For fluids of which only the viscosity is known: one curve of viscosity x speed for all;
deviation: each of the six fluids predicted by a calibration on the other five."""


def asperity_ehl_law(
    scale: AsperityScale,
    *,
    modulus: float,
    poisson_ratio: float = 0.5,
    viscosity: float | None,
    friction: BoundaryFriction | None = None,
    cof_hysteresis: SourcedValue | None = None,
    fine_roughness: SourcedValue | None = None,
    modulus_deviation: float | None = None,
    roughness_deviation: float | None = None,
) -> SpeedEffectLaw:
    """Return the law of films at asperities for a fluid, from what is known of it.

    With a measured limit COF_BL (a fluid with a fit of Eq. 17) that is the friction at rest
    (``OWN_BOUNDARY``); otherwise the viscosity alone decides (``ONE_CURVE``). A COF_BL that is a
    mean over speeds counts as none: it is no limit at low speed.

    Parameters
    ----------
    scale
        Asperities of sole and floor together.
    modulus, poisson_ratio, viscosity
        Of the sole, Pa and 1; of the fluid, Pa s, None for a dry floor.
    friction
        What was measured with this fluid.
    cof_hysteresis
        Measured hysteresis of the pair, in place of the calibrated one.
    fine_roughness
        m, in place of the calibrated one.
    modulus_deviation, roughness_deviation
        Standard deviations of the modulus (Pa) and of the roughness behind ``scale`` relative to
        itself (1); None when not known: then they count as exact.
    """
    limit = friction is not None and friction.tau_hydro is not None
    levels = OWN_BOUNDARY if limit else ONE_CURVE
    notes = []
    if limit:
        assert friction is not None
        boundary = friction.cof_boundary
        if friction.pair:
            notes.append(f"Friction at rest was measured on {friction.pair}.")
    else:
        assert levels.cof_boundary is not None
        boundary = levels.cof_boundary
        notes.append(
            "Only the viscosity of the fluid enters: friction at rest is one for all. Each of six "
            "fluids was so predicted from the other five within 0.040 of COF on average; from one "
            "fluid alone it was 0.061, more than the 0.05 aimed at."
        )
    fine = fine_roughness or levels.fine_roughness
    spreads = {
        "fine_roughness": fine,
        "modulus": SourcedValue(modulus, "Pa", "outsole", modulus_deviation),
        "roughness_factor": SourcedValue(1.0, "1", "interface", roughness_deviation),
    }
    return SpeedEffectLaw(
        effect=AsperityEHL(scale, modulus, poisson_ratio, fine.value),
        cof_boundary=boundary,
        cof_hysteresis=cof_hysteresis or levels.cof_hysteresis,
        viscosity=viscosity,
        model_deviation=levels.deviation,
        assumed=tuple(notes),
        calibrated_product=levels.product,
        effect_inputs={k: v for k, v in spreads.items() if v.uncertainty is not None},
    )
