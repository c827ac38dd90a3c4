"""Fall of adhesion with speed by a mechanism: what a mechanism is, and the law made of one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, SourcedValue, ValidityRange
from underfoot.core.arrays import Array, scalar_or_array
from underfoot.core.presentation import AssumingModel
from underfoot.core.remark import Message

from .law import PIN_PRESSURE, PIN_RANGES, UncertainInputs, coefficient, sourced_fields, with_values


@runtime_checkable
class SpeedEffect(AssumingModel, Protocol):
    """A mechanism that takes adhesion away as the sliding speed grows."""

    def adhesion_left(
        self, *, viscosity: float | None, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> Array:
        """Return the share of adhesion left (1 at rest) at Pa s, m/s and Pa, broadcast."""
        ...


def cof_with_speed(
    effect: SpeedEffect,
    *,
    viscosity: float | None,
    speed: ArrayLike,
    cof_boundary: float,
    cof_hysteresis: float,
    contact_pressure: ArrayLike = PIN_PRESSURE,
) -> Any:
    """Return COF = COF_hysteresis + (COF_BL - COF_hysteresis) a, a the share of adhesion left.

    Without the viscous part; ``viscosity`` Pa s or None for a dry floor, ``speed`` m/s,
    ``contact_pressure`` Pa. COF_BL is the friction at rest, and all of it is hysteresis where it
    is below ``cof_hysteresis``.

    Parameters:
        effect: The mechanism.
        viscosity: Pa s; None for a dry floor.
        speed: Of sliding, m/s.
        cof_boundary: COF_BL, at rest.
        cof_hysteresis: Part that speed leaves.
        contact_pressure: Pa.
    """
    left = effect.adhesion_left(viscosity=viscosity, speed=speed, contact_pressure=contact_pressure)
    hysteresis = min(cof_hysteresis, cof_boundary)
    cof = hysteresis + (cof_boundary - hysteresis) * left
    return scalar_or_array(cof)


@dataclass(frozen=True, slots=True, repr=False)
class SpeedEffectLaw(UncertainInputs):
    """tau = (COF_hysteresis + (COF_BL - COF_hysteresis) a) p_c + eta V / h.

    a is the share of adhesion that the mechanism ``effect`` leaves at the local speed and contact
    pressure: 1 at rest, where the friction is COF_BL, and 0 at high speed, where hysteresis and
    the viscous part are left.

    Parameters:
        effect: ``AsperityEHL``, ``MeanFilmSharing`` or ``ViscoelasticArea``.
        cof_boundary, cof_hysteresis: Friction of the pair with this fluid at rest, and what is left
            when all adhesion is gone.
        viscosity: Pa s; None for a dry floor: only what does not need a fluid acts.
        model_deviation: Standard deviation of the mechanism's blind predictions of COF, 1; None
            when not estimated.
        assumed: Further assumptions behind the numbers, in words.
        effect_inputs: Numbers of ``effect`` by field name, with their standard deviations.
        calibrated_product: Viscosity x speed of the data behind the levels, Pa m; None when not
            known.

    Raises:
        InputError: A coefficient that was not measured or is negative, a viscosity that is not
            positive.
    """

    effect: SpeedEffect
    cof_boundary: SourcedValue
    cof_hysteresis: SourcedValue
    viscosity: float | None = None
    model_deviation: float | None = None
    assumed: tuple[Message, ...] = ()
    effect_inputs: Mapping[str, SourcedValue] = field(default_factory=dict)
    calibrated_product: ValidityRange | None = None

    def __post_init__(self) -> None:
        UncertainInputs.__post_init__(self)
        if self.model_deviation is not None and not self.model_deviation >= 0:
            raise InputError(
                f"{self.model_deviation:g}", where="model_deviation", allowed="0 or more"
            )

    @property
    def name(self) -> str:
        """Name of the mechanism."""
        return self.effect.name

    @property
    def source(self) -> str:
        """Sources of the mechanism, then of the boundary friction."""
        return "; ".join(dict.fromkeys((self.effect.source, self.cof_boundary.source)))

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind."""
        levels = [
            Message.plain(value.note)
            for value in (self.cof_boundary, self.cof_hysteresis)
            if value.assumed and value.note
        ]
        return (
            Message("Contact friction at rest is proportional to the contact pressure."),
            *self.effect.assumptions,
            *levels,
            *self.assumed,
        )

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """Levels of friction and the numbers of the mechanism."""
        return {**sourced_fields(self), **self.effect_inputs}

    def at(self, values: Mapping[str, float]) -> SpeedEffectLaw:
        """Return the law at other levels and numbers of the mechanism."""
        law = with_values(self, {k: v for k, v in values.items() if k not in self.effect_inputs})
        own = {k: values[k] for k in self.effect_inputs if k in values}
        if not own:
            return law
        effect: Any = self.effect
        return replace(
            law, effect=effect.at(own) if hasattr(effect, "at") else with_values(effect, own)
        )

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        boundary = coefficient(self.cof_boundary, "cof_boundary")
        hysteresis = min(coefficient(self.cof_hysteresis, "cof_hysteresis"), boundary)
        left = self.effect.adhesion_left(
            viscosity=self.viscosity, speed=velocity, contact_pressure=pressure
        )
        return (boundary - hysteresis) * np.asarray(left) * pressure, hysteresis * pressure

    @property
    def ranges(self) -> Mapping[str, ValidityRange]:
        product = self.calibrated_product
        return PIN_RANGES if product is None else {**PIN_RANGES, "viscosity x speed": product}


FILM_EXPONENT = 0.65
"""Film at the fluid's share f of load and stiffness: h = h_full f^-0.65. Eq. 18 has
h ~ E'^-0.44 w^-0.21, and both E' and w count as multiplied by f."""
_STEPS = 60


def fluid_share(full_film: ArrayLike, dry_gap: ArrayLike) -> Array:
    """Return the share f of the load that the fluid carries beside exponential roughness.

    1 - f = exp(-(h - h_dry)), h = h_full f^-0.65; lengths in units of the decay length u0 of the
    roughness' pressure. ``full_film``: the film if the fluid carried all; ``dry_gap`` >= 0: the
    gap without a fluid. Broadcast; 0 at ``full_film`` 0, towards 1 as it grows.

    Solved by bisection in log f (the left side falls and the right side grows with f).
    """
    film, dry = np.broadcast_arrays(
        np.asarray(full_film, dtype=float), np.asarray(dry_gap, dtype=float)
    )
    log_share = np.full(film.shape, 0.5 * np.log(1e-300))
    step = -0.5 * log_share
    for _ in range(_STEPS):
        gap = film * np.exp(-FILM_EXPONENT * log_share)
        # roughness carries less than the load's rest: the film is too thick, f too small
        too_thick = np.exp(np.minimum(dry - gap, 700.0)) < -np.expm1(log_share)
        log_share += np.where(too_thick, step, -step)
        step *= 0.5
    return np.where(film > 0, np.exp(log_share), 0.0)
