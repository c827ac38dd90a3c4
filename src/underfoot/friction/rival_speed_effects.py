"""Mechanisms of the fall with speed that the measurements speak against; the study G.2 compares.

The film of the whole contact beside all of its roughness, and the real contact area of a rubber
that stiffens with speed.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive
from underfoot.core.remark import Message
from underfoot.reference import soft_ehl_film
from underfoot.rough_contact.pressure_gap_law import DECAY_OVER_RQ, INTERCEPT_OVER_MODULUS

from .law import PIN_PRESSURE
from .speed_effect import fluid_share

REST_SPEED = 0.01
"""m/s: speed of the report's boundary tests (G.3.1), below which area counts as that at rest."""


def modulus_exponent(modulus: Callable[[Any], Any], low: float, high: float) -> float:
    """Return n of |E*| ~ frequency^n between two angular frequencies (rad/s), at least 0.

    n = ln(|E*(high)| / |E*(low)|) / ln(high / low). ``modulus``: complex modulus of an angular
    frequency, as a relaxation spectrum has it.
    """
    if not 0 < low < high:
        raise InputError(
            Message("{low:g} to {high:g} rad/s", low=low, high=high),
            where="modulus_exponent",
            allowed="0 < low < high",
        )
    ratio = np.abs(modulus(np.array([low, high])))
    return max(float(np.log(ratio[1] / ratio[0])) / math.log(high / low), 0.0)


@dataclass(frozen=True, slots=True)
class ViscoelasticArea:
    """Real contact area falls as the modulus rises: a = (1 + V / V0)^-n, whatever the fluid.

    At light load A = p / (E* slope) up to a constant (Persson 2001); a broad relaxation spectrum
    has |E*| ~ frequency^n, and frequency is proportional to the sliding speed.

    Parameters:
        exponent: n of the modulus, 1; ``modulus_exponent`` takes it from a relaxation spectrum. A
            power law has tan delta = tan(n pi / 2): a loss tangent of 0.1 to 0.5 is n of 0.06 to
            0.3. The report's own model loses 12 to 29 % of area from 0.1 to 1 m/s (G.1.2), n = 0.06
            to 0.15.
        rest_speed: V0, m/s.
    """

    exponent: float
    rest_speed: float = REST_SPEED
    name: str = field(default="viscoelastic_area", init=False)
    source: str = field(default="Persson 2001, J. Chem. Phys. 115:3840-3861", init=False)
    assumptions: tuple[Message, ...] = field(
        default=(
            Message("The fall with speed is that of the real contact area of a stiffening rubber."),
        ),
        init=False,
    )

    def __post_init__(self) -> None:
        not_negative(self.exponent, "exponent")
        positive(self.rest_speed, "rest_speed", "m/s")

    def adhesion_left(
        self, *, viscosity: float | None, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> Array:
        """Return the share of adhesion left; viscosity and pressure do not enter."""
        shape = np.broadcast_shapes(np.shape(speed), np.shape(contact_pressure))
        moving = np.abs(np.asarray(speed, dtype=float))
        return np.broadcast_to((1 + moving / self.rest_speed) ** -self.exponent, shape)


@dataclass(frozen=True, slots=True)
class MeanFilmSharing:
    """Mixed lubrication by the mean film: adhesion is left in proportion to the load on asperities.

    1 - f = exp(-(h - h_dry) / (Rq/2)), h = h_min f^-0.65, with h_min of Eq. 18 for the whole
    contact (radius, load), h_dry = (Rq/2) ln(0.375 E* / p) and f the fluid's share of the load
    (Johnson, Greenwood and Poon 1972; Persson 2007).

    Parameters:
        radius, normal_force, effective_modulus: R' (m), w (N) and E' (Pa) of Eq. 18 for the contact
            as a whole: the pin's, not the shoe's.
        rq: Roughness that keeps the surfaces apart, m: composite of both surfaces, or the floor's
            alone where the sole's own roughness is taken as flattened, or calibrated.
        nominal_pressure: Of the whole contact, Pa; the share is the same all over it.
        entrainment: Mean speed of the surfaces over the sliding speed: 0.5; the report takes 1.
        stiffness: E* of the rough interface, Pa; None takes E' / 2, as E' = 2 E* says.

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
    assumptions: tuple[Message, ...] = field(
        default=(
            Message("The fall with speed is the film of the whole pin, not one of the asperities."),
        ),
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
            positive(getattr(self, name), name)
        if self.stiffness is not None:
            positive(self.stiffness, "stiffness", "Pa")

    def film_thickness(self, *, viscosity: float, speed: ArrayLike) -> Array:
        """Return the minimum film of the whole contact, m, as if the fluid carried all (Eq. 18)."""
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
    ) -> Array:
        """Return the share of adhesion left; the same at every local pressure."""
        shape = np.broadcast_shapes(np.shape(speed), np.shape(contact_pressure))
        if viscosity is None:
            return np.ones(shape)
        decay = DECAY_OVER_RQ * self.rq
        stiffness = self.stiffness or 0.5 * self.effective_modulus
        dry_gap = max(math.log(INTERCEPT_OVER_MODULUS * stiffness / self.nominal_pressure), 0.0)
        film = self.film_thickness(viscosity=viscosity, speed=speed)
        return np.broadcast_to(1 - fluid_share(film / decay, dry_gap), shape)
