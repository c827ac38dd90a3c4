"""The mechanisms of the speed effect, each with what one fluid calibrates."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError, unknown_name

from .least_squares import Calibration, Parameter, calibrated
from .stribeck_points import CofPoints, Pin

if TYPE_CHECKING:
    from underfoot.friction.speed_effect import SpeedEffect

LEVELS = {
    "cof_adhesion": Parameter(0.4, 0.0, 3.0),
    "cof_hysteresis": Parameter(0.1, 0.0, 0.4),
}


@dataclass(frozen=True, slots=True)
class Mechanism:
    """One explanation of the fall with speed.

    ``effect(pin, rq, value)`` builds it for a sole of roughness ``rq`` (m) and its one calibrated
    number, whose search is ``parameter`` (None when measured inputs settle all). ``needs``: what
    it takes from measurement.
    """

    name: str
    label: str
    effect: Callable[[Pin, float, float], SpeedEffect]
    parameter: Parameter | None
    needs: str


@dataclass(frozen=True, slots=True)
class OneConstant:
    """No mechanism: a = exp(-viscosity V / constant), the collapse of Fig. 16 as a formula."""

    constant: float
    name: str = "one constant"
    source: str = "Eq. 17 with viscosity x tau_hydro constant"
    assumptions: tuple[str, ...] = ()

    def adhesion_left(
        self, *, viscosity: float | None, speed: ArrayLike, contact_pressure: ArrayLike
    ) -> NDArray[np.float64]:
        """Return the share of adhesion left."""
        moving = np.abs(np.asarray(speed, dtype=float)) * (viscosity or 0.0)
        return np.exp(-moving / self.constant) * np.ones(np.shape(contact_pressure))


def mechanisms() -> dict[str, Mechanism]:
    """Return all mechanisms by name, in the order of the tables."""
    from underfoot.friction import AsperityEHL, MeanFilmSharing, ViscoelasticArea, self_affine_scale
    from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION, Blocking

    def asperity(blocking: Blocking) -> Callable[[Pin, float, float], SpeedEffect]:
        def effect(pin: Pin, rq: float, value: float) -> SpeedEffect:
            scale = self_affine_scale(
                STYLUS_RESOLUTION, rq=math.hypot(rq, pin.floor_rq), longest_wave=pin.cutoff
            )
            return AsperityEHL(scale, pin.modulus, pin.poisson_ratio, value, blocking)

        return effect

    def mean_film(
        roughness: Callable[[Pin, float, float], float], printed: bool = False
    ) -> Callable[[Pin, float, float], SpeedEffect]:
        def effect(pin: Pin, rq: float, value: float) -> SpeedEffect:
            stiffness = pin.modulus / (1 - pin.poisson_ratio**2)
            return MeanFilmSharing(
                pin.radius,
                pin.normal_force,
                pin.modulus if printed else 2 * stiffness,
                roughness(pin, rq, value),
                pin.pressure,
                1.0 if printed else 0.5,
                stiffness,
            )

        return effect

    def both(pin: Pin, rq: float, _: float) -> float:
        return math.hypot(rq, pin.floor_rq)

    def floor(pin: Pin, _rq: float, _: float) -> float:
        return pin.floor_rq

    def free(_pin: Pin, _rq: float, value: float) -> float:
        return value

    def area(_pin: Pin, _rq: float, value: float) -> SpeedEffect:
        return ViscoelasticArea(value)

    def constant(_pin: Pin, _rq: float, value: float) -> SpeedEffect:
        return OneConstant(value)

    fine = Parameter(20e-9, 0.1e-9, 1e-5, "m", logarithmic=True)
    film = "Rq with its cut-off, modulus, viscosity"
    pin = "radius, load and modulus of the pin, Rq, viscosity"
    rough = Parameter(1e-6, 1e-8, 1e-4, "m", logarithmic=True)
    power = Parameter(0.2, 1e-4, 5.0, "1", logarithmic=True)
    scale = Parameter(1e-3, 1e-6, 1.0, "Pa*m", logarithmic=True)
    asperities = "film at asperities"
    whole = "film of the pin"
    found = (
        Mechanism("asperity_ehl", f"{asperities}, bearing area", asperity("bearing"), fine, film),
        Mechanism(
            "asperity_ehl_sharing", f"{asperities}, load shared", asperity("sharing"), fine, film
        ),
        Mechanism("mean_film_both", f"{whole}, Rq of both", mean_film(both), None, pin),
        Mechanism(
            "mean_film_both_printed",
            f"{whole} as printed, Rq of both",
            mean_film(both, True),
            None,
            pin,
        ),
        Mechanism("mean_film_floor", f"{whole}, Rq of the floor", mean_film(floor), None, pin),
        Mechanism(
            "mean_film_floor_printed",
            f"{whole} as printed, of the floor",
            mean_film(floor, True),
            None,
            pin,
        ),
        Mechanism("mean_film_free", f"{whole}, Rq calibrated", mean_film(free), rough, pin),
        Mechanism("viscoelastic_area", "area lost to stiffening rubber", area, power, "no fluid"),
        Mechanism("one_constant", "no mechanism: one constant", constant, scale, "viscosity"),
    )
    return {one.name: one for one in found}


def mechanism(name: str) -> Mechanism:
    """Return one mechanism; an unknown name is answered with the nearest one."""
    known = mechanisms()
    if name not in known:
        raise unknown_name("mechanism", name, known)
    return known[name]


def calibrated_mechanism(
    chosen: Mechanism, points: tuple[CofPoints, ...], pin: Pin, *, own_boundary: bool = False
) -> Calibration:
    """Return levels and parameter of a mechanism from the points of one or more fluids.

    Unknown are hysteresis, adhesion at rest (one for all fluids) and the mechanism's parameter;
    with ``own_boundary`` COF_BL of each fluid is taken as measured in place of the adhesion.
    """
    if not points:
        raise InputError("no points to calibrate on", where="points")
    unknown = dict(LEVELS)
    if own_boundary:
        del unknown["cof_adhesion"]
    if chosen.parameter is not None:
        unknown["parameter"] = chosen.parameter

    def model(values: Mapping[str, float]) -> NDArray[np.float64]:
        return np.concatenate(
            [predicted(chosen, values, one, pin, own_boundary=own_boundary) for one in points]
        )

    fluids = ", ".join(dict.fromkeys(one.label for one in points))
    return calibrated(
        model,
        np.concatenate([one.cof for one in points]),
        unknown,
        source=f"{chosen.name} calibrated on {fluids}",
    )


def predicted(
    chosen: Mechanism,
    values: Mapping[str, float],
    points: CofPoints,
    pin: Pin,
    *,
    own_boundary: bool,
    speed: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """Return COF of a fluid at its points' speeds (or ``speed``) from calibrated ``values``.

    ``own_boundary`` takes COF_BL of the fluid where it was measured as a limit at low speed; the
    other fluids, and all without it, take the calibrated level: then only the viscosity is theirs.
    """
    from underfoot.friction.speed_effect import cof_with_speed

    level = values.get("cof_adhesion", 0.0) + values["cof_hysteresis"]
    given = points.cof_boundary if own_boundary else None
    return np.asarray(
        cof_with_speed(
            chosen.effect(pin, points.rq, values.get("parameter", 0.0)),
            viscosity=points.viscosity,
            speed=points.speed if speed is None else speed,
            cof_boundary=level if given is None else given,
            cof_hysteresis=values["cof_hysteresis"],
            contact_pressure=pin.pressure,
        )
    )
