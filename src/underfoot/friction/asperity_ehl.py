"""Speed effect within boundary lubrication: soft EHL at single asperities blocks adhesion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erfc

from underfoot.core import SourcedValue, ValidityRange
from underfoot.core.arrays import Array
from underfoot.core.checks import choice, positive
from underfoot.core.remark import Message
from underfoot.reference import soft_ehl_film
from underfoot.rough_contact.pressure_gap_law import DECAY_OVER_RQ, INTERCEPT_OVER_MODULUS

from .asperity_scale import AsperityScale
from .law import with_values
from .measured import BoundaryFriction
from .speed_effect import SpeedEffectLaw, fluid_share

STYLUS_RESOLUTION = 2.5e-6
"""m: shortest wave in a profile with a cut-off of 0.8 mm (ISO 3274:1996, Table 1: lambda_s)."""
Blocking = Literal["bearing", "sharing"]
BLOCKINGS = ("bearing", "sharing")


@dataclass(frozen=True, slots=True)
class AsperityEHL:
    """Each touching asperity drags in a film of its own; adhesion is left where it is pierced.

    Film of an asperity, Eq. 18 at its scale, entrainment at half the sliding speed::

        h = 2.80 R U^0.65 W^-0.21    U = eta (V/2) / (E' R), W = w / (E' R^2), E' = 2 E / (1-nu^2)

    R from the spectrum down to the resolution of the stylus (``AsperityScale``). The load w is
    that of a Hertz contact whose mean pressure is that of the touching spots:
    W = (9 pi^3 / 32) (p_spot / E*)^3. The fine roughness s on the asperity, finer than the stylus
    sees, is the one calibrated parameter. Share of adhesion left at the film h:

    - "bearing": erfc(h / (sqrt(2) s)), the bearing area of Gaussian fine roughness above h,
      relative to that without a film;
    - "sharing": the fine roughness carries the share exp(-(h - h_dry) / (s/2)) of the spot's load
      (Persson 2007), the fluid the rest, with the film of Johnson, Greenwood and Poon (1972).

    Parameters:
        scale: Radius and slope of the asperities.
        modulus, poisson_ratio: Of the sole, Pa and 1.
        fine_roughness: s, root mean square, m; None takes that of ``scale``.
        blocking: "bearing" or "sharing".

    Tested against 6 fluids at one load and one pair (docs/physics/friction_law.md). Eq. 18 was
    fitted at U near 1e-8 and W near 1e-3; asperities have U near 1e-5 and W near 0.1.
    """

    scale: AsperityScale
    modulus: float
    poisson_ratio: float = 0.5
    fine_roughness: float | None = None
    blocking: Blocking = "bearing"
    name: str = field(default="asperity_ehl", init=False)
    source: str = field(
        default="Hamrock and Dowson 1978 (Eq. 18) at single asperities; Johnson, Greenwood and "
        "Poon, Wear 19 (1972) 91-108; Persson 2001, 2007",
        init=False,
    )

    def __post_init__(self) -> None:
        positive(self.modulus, "modulus", "Pa")
        if self.fine_roughness is not None:
            positive(self.fine_roughness, "fine_roughness", "m")
        choice(self.blocking, BLOCKINGS, "blocking")

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind."""
        return (
            Message(
                "Films at single asperities block adhesion; the fine roughness they must cover "
                "({fine:.3g} nm) is calibrated on friction, not measured.",
                fine=self._fine * 1e9,
            ),
            Message(
                "The film formula of soft contacts (Eq. 18) holds at asperities, beyond the range "
                "it was fitted in."
            ),
        )

    def at(self, values: Mapping[str, float]) -> AsperityEHL:
        """Return the mechanism with other numbers; "roughness_factor" multiplies all roughness."""
        factor = values.get("roughness_factor", 1.0)
        other = with_values(self, {k: v for k, v in values.items() if k != "roughness_factor"})
        return other if factor == 1.0 else replace(other, scale=self.scale.rougher(factor))

    def film_thickness(
        self, *, viscosity: float, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> Array:
        """Return the film of an asperity, m, as if the fluid alone carried it (Eq. 18)."""
        stiffness = self.modulus / (1 - self.poisson_ratio**2)
        spot = self.scale.spot_pressure(np.asarray(contact_pressure, dtype=float) / stiffness)
        radius = self.scale.radius
        load = 9 * math.pi**3 / 32 * spot**3 * 2 * stiffness * radius**2
        moving, load = np.broadcast_arrays(np.abs(np.asarray(speed, dtype=float)), load)
        _, least = soft_ehl_film(
            viscosity=viscosity,
            entrainment_speed=0.5 * moving,
            load=load,
            radius=radius,
            effective_modulus=2 * stiffness,
        )
        return np.asarray(least)

    def adhesion_left(
        self, *, viscosity: float | None, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> Array:
        """Return the share of adhesion left; 1 without a fluid."""
        pressure = np.asarray(contact_pressure, dtype=float)
        if viscosity is None:
            return np.ones(np.broadcast_shapes(np.shape(speed), pressure.shape))
        film = self.film_thickness(viscosity=viscosity, speed=speed, contact_pressure=pressure)
        if self.blocking == "bearing":
            return erfc(film / (math.sqrt(2.0) * self._fine))
        stiffness = self.modulus / (1 - self.poisson_ratio**2)
        dry_gap = np.log(INTERCEPT_OVER_MODULUS / self.scale.spot_pressure(pressure / stiffness))
        return 1 - fluid_share(film / (DECAY_OVER_RQ * self._fine), np.maximum(dry_gap, 0.0))

    @property
    def _fine(self) -> float:
        return self.scale.fine_roughness if self.fine_roughness is None else self.fine_roughness


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
    product: ValidityRange


def _level(value: float, deviation: float, unit: str, fluids: str) -> SourcedValue:
    return SourcedValue(
        value,
        unit,
        source=f"calibrated on {fluids}, {_PAIR}",
        uncertainty=deviation,
        assumed=True,
        note=Message(
            "Calibrated on {fluids}, {pair}; taken to hold for this pair", fluids=fluids, pair=_PAIR
        ),
    )


_FITTED, _ALL = "the four fluids with a fit of Eq. 17", "all six fluids"
OWN_BOUNDARY = CalibratedLevels(
    fine_roughness=_level(15.65e-9, 0.58e-9, "m", _FITTED),
    cof_boundary=None,
    cof_hysteresis=_level(0.0952, 0.0110, "1", _FITTED),
    deviation=0.030,
    product=ValidityRange(0.52e-3 * 0.05, 5.54e-3, "Pa*m", f"{_FITTED}, {_PAIR}"),
)
"""For fluids whose COF_BL was measured as a limit at low speed; deviation: the five fluids that a
calibration on 50 % glycerol predicts blind."""

ONE_CURVE = CalibratedLevels(
    fine_roughness=_level(11.94e-9, 0.47e-9, "m", _ALL),
    cof_boundary=_level(0.7311, 0.0161, "1", _ALL),
    cof_hysteresis=_level(0.1243, 0.0061, "1", _ALL),
    deviation=0.046,
    product=ValidityRange(0.52e-3 * 0.05, 74.6e-3, "Pa*m", f"{_ALL}, {_PAIR}"),
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

    Parameters:
        scale: Asperities of sole and floor together.
        modulus, poisson_ratio, viscosity: Of the sole, Pa and 1; of the fluid, Pa s, None for a dry
            floor.
        friction: What was measured with this fluid.
        cof_hysteresis: Measured hysteresis of the pair, in place of the calibrated one.
        fine_roughness: m, in place of the calibrated one.
        modulus_deviation, roughness_deviation: Standard deviations of the modulus (Pa) and of the
            roughness behind ``scale`` relative to itself (1); None when not known: then they count
            as exact.
    """
    limit = friction is not None and friction.tau_hydro is not None
    levels = OWN_BOUNDARY if limit else ONE_CURVE
    notes = []
    if limit:
        assert friction is not None
        boundary = friction.cof_boundary
        if friction.pair:
            notes.append(Message("Friction at rest was measured on {pair}.", pair=friction.pair))
    else:
        assert levels.cof_boundary is not None
        boundary = levels.cof_boundary
        notes.append(
            Message(
                "Only the viscosity of the fluid enters: friction at rest is one for all. Each of "
                "six fluids was so predicted from the other five within 0.040 of COF on average; "
                "from one fluid alone it was 0.061, more than the 0.05 aimed at."
            )
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
