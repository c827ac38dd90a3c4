"""Rival speed effect: the film of the whole contact carries load beside all of its roughness."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError

from . import speed_effect
from ._load_sharing import fluid_share
from ._shared import PIN_PRESSURE

_U0, _P0 = 0.5, 0.375  # Persson 2007: p = 0.375 E* exp(-h / (0.5 Rq)), as in ExponentialLaw

RANGES = speed_effect.RANGES


@dataclass(frozen=True, slots=True)
class MeanFilmSharing:
    """Mixed lubrication by the mean film: adhesion is left in proportion to the load on asperities.

    1 - f = exp(-(h - h_dry) / (Rq/2)), h = h_min f^-0.65, with h_min of Eq. 18 for the whole
    contact (radius, load), h_dry = (Rq/2) ln(0.375 E* / p) and f the fluid's share of the load
    (Johnson, Greenwood and Poon 1972; Persson 2007).

    Parameters
    ----------
    radius, normal_force, effective_modulus
        R' (m), w (N) and E' (Pa) of Eq. 18 for the contact as a whole: the pin's, not the shoe's.
    rq
        Roughness that keeps the surfaces apart, m: composite of both surfaces, or the floor's
        alone where the sole's own roughness is taken as flattened, or calibrated.
    nominal_pressure
        Of the whole contact, Pa; the share is the same all over it.
    entrainment
        Mean speed of the surfaces over the sliding speed: 0.5; the report takes 1.
    stiffness
        E* of the rough interface, Pa; None takes E' / 2, as E' = 2 E* says.

    Notes
    -----
    Not for a local law under a shoe whose film is solved on its own: that counts it twice.
    """

    radius: float
    normal_force: float
    effective_modulus: float
    rq: float
    nominal_pressure: float = PIN_PRESSURE
    entrainment: float = 0.5
    stiffness: float | None = None
    name: str = field(default="mean_film_sharing", init=False)
    source: str = field(
        default="Hamrock and Dowson 1978 (Eq. 18); Johnson, Greenwood and Poon, Wear 19 (1972) "
        "91-108; Persson 2007",
        init=False,
    )
    assumptions: tuple[str, ...] = field(
        default=("The fall with speed is the film of the whole pin, not one of the asperities.",),
        init=False,
    )

    def __post_init__(self) -> None:
        for name in (
            "radius",
            "normal_force",
            "effective_modulus",
            "rq",
            "nominal_pressure",
            "entrainment",
        ):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise InputError(f"{value:g}", where=name, allowed="a finite number above 0")
        if self.stiffness is not None and not self.stiffness > 0:
            raise InputError(f"{self.stiffness:g} Pa", where="stiffness", allowed="above 0")

    def film_thickness(self, *, viscosity: float, speed: ArrayLike) -> NDArray[np.float64]:
        """Return the minimum film of the whole contact, m, as if the fluid carried all (Eq. 18)."""
        from underfoot.reference import soft_ehl_film

        moving = np.abs(np.asarray(speed, dtype=float))
        _, least = soft_ehl_film(
            viscosity=viscosity,
            entrainment_speed=self.entrainment * moving,
            load=self.normal_force,
            radius=self.radius,
            effective_modulus=self.effective_modulus,
        )
        return np.asarray(least)

    def adhesion_left(
        self, *, viscosity: float | None, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> NDArray[np.float64]:
        """Return the share of adhesion left; the same at every local pressure."""
        shape = np.broadcast_shapes(np.shape(speed), np.shape(contact_pressure))
        if viscosity is None:
            return np.ones(shape)
        decay = _U0 * self.rq
        stiffness = self.stiffness or 0.5 * self.effective_modulus
        dry_gap = max(math.log(_P0 * stiffness / self.nominal_pressure), 0.0)
        film = self.film_thickness(viscosity=viscosity, speed=speed)
        return np.broadcast_to(1 - fluid_share(film / decay, dry_gap), shape)
