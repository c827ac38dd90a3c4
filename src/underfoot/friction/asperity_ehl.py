"""Speed effect within boundary lubrication: soft EHL at single asperities blocks adhesion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError, unknown_name

from . import speed_effect
from ._load_sharing import fluid_share
from .asperity_scale import AsperityScale
from .uncertain_inputs import with_values

STYLUS_RESOLUTION = 2.5e-6
"""m: shortest wave in a profile with a cut-off of 0.8 mm (ISO 3274:1996, Table 1: lambda_s)."""
Blocking = Literal["bearing", "sharing"]
BLOCKINGS = ("bearing", "sharing")
_U0, _P0 = 0.5, 0.375  # Persson 2007: p = 0.375 E* exp(-h / (0.5 Rq)), as in ExponentialLaw

RANGES = speed_effect.RANGES


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

    Parameters
    ----------
    scale
        Radius and slope of the asperities.
    modulus, poisson_ratio
        Of the sole, Pa and 1.
    fine_roughness
        s, root mean square, m; None takes that of ``scale``.
    blocking
        "bearing" or "sharing".

    Notes
    -----
    Tested against 6 fluids at one load and one pair (docs/physics/speed_effect.md). Eq. 18 was
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
        if not (math.isfinite(self.modulus) and self.modulus > 0):
            raise InputError(f"{self.modulus:g} Pa", where="modulus", allowed="above 0")
        if self.fine_roughness is not None and not self.fine_roughness > 0:
            raise InputError(
                f"{self.fine_roughness:g} m", where="fine_roughness", allowed="above 0"
            )
        if self.blocking not in BLOCKINGS:
            raise unknown_name("blocking", self.blocking, BLOCKINGS, where="blocking")

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What no measurement stands behind."""
        return (
            "Films at single asperities block adhesion; the fine roughness they must cover "
            f"({self._fine * 1e9:.3g} nm) is calibrated on friction, not measured.",
            "The film formula of soft contacts (Eq. 18) holds at asperities, beyond the range "
            "it was fitted in.",
        )

    def at(self, values: Mapping[str, float]) -> AsperityEHL:
        """Return the mechanism with other numbers; "roughness_factor" multiplies all roughness."""
        others = {k: v for k, v in values.items() if k != "roughness_factor"}
        found = with_values(self, others)
        if "roughness_factor" in values:
            found = replace(found, scale=self.scale.rougher(values["roughness_factor"]))
        return found

    def film_thickness(
        self, *, viscosity: float, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> NDArray[np.float64]:
        """Return the film of an asperity, m, as if the fluid alone carried it (Eq. 18)."""
        from underfoot.reference import soft_ehl_film

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
    ) -> NDArray[np.float64]:
        """Return the share of adhesion left; 1 without a fluid."""
        from scipy.special import erfc

        pressure = np.asarray(contact_pressure, dtype=float)
        if viscosity is None:
            return np.ones(np.broadcast_shapes(np.shape(speed), pressure.shape))
        film = self.film_thickness(viscosity=viscosity, speed=speed, contact_pressure=pressure)
        if self.blocking == "bearing":
            return erfc(film / (math.sqrt(2.0) * self._fine))
        stiffness = self.modulus / (1 - self.poisson_ratio**2)
        dry_gap = np.log(_P0 / self.scale.spot_pressure(pressure / stiffness))
        return 1 - fluid_share(film / (_U0 * self._fine), np.maximum(dry_gap, 0.0))

    @property
    def _fine(self) -> float:
        return self.scale.fine_roughness if self.fine_roughness is None else self.fine_roughness
