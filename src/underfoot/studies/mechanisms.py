"""The mechanisms of the speed effect: calibrated, tested on other fluids, and the one chosen."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.calibrate.least_squares import Calibration, Parameter, calibrate_model
from underfoot.calibrate.stribeck_points import (
    CofPoints,
    Pin,
    fluid_points,
    pin_on_disk,
    roughness_series,
)
from underfoot.core import InputError, unknown_name
from underfoot.core.remark import Message

if TYPE_CHECKING:
    from underfoot.core.catalogue import Catalogue
    from underfoot.friction import BoundaryFriction
    from underfoot.friction.speed_effect import SpeedEffect

CALIBRATION_FLUID = "glycerol_50pct"

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
    assumptions: tuple[Message, ...] = ()

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
    terms = (
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
    return {term.name: term for term in terms}


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
            [predict_cof(chosen, values, point, pin, own_boundary=own_boundary) for point in points]
        )

    fluids = ", ".join(dict.fromkeys(point.label for point in points))
    return calibrate_model(
        model,
        np.concatenate([point.cof for point in points]),
        unknown,
        source=f"{chosen.name} calibrated on {fluids}",
    )


def predict_cof(
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


@dataclass(frozen=True, slots=True)
class FluidPrediction:
    """One fluid (or roughness) predicted without having been seen."""

    points: CofPoints
    cof: NDArray[np.float64]

    @property
    def error(self) -> float:
        """Mean absolute error over the speeds."""
        return float(np.mean(np.abs(self.cof - self.points.cof)))


@dataclass(frozen=True, slots=True)
class BlindTest:
    """A mechanism calibrated on ``fluid`` and its predictions of the rest.

    ``own_boundary``: COF_BL of each fluid was an input where measured as a limit at low speed.
    """

    mechanism: Mechanism
    calibration: Calibration
    predictions: tuple[FluidPrediction, ...]
    own_boundary: bool

    @property
    def error(self) -> float:
        """Mean absolute error over fluids and speeds, each fluid counted alike."""
        return float(np.mean([prediction.error for prediction in self.predictions]))

    @property
    def deviation(self) -> float:
        """Root mean square error over fluids and speeds: the model's standard deviation."""
        return float(
            np.sqrt(np.mean([np.mean((p.cof - p.points.cof) ** 2) for p in self.predictions]))
        )


def blind_test(
    chosen: Mechanism,
    calibration_points: CofPoints,
    others: Sequence[CofPoints],
    pin: Pin,
    *,
    own_boundary: bool,
) -> BlindTest:
    """Return the predictions of ``others`` by a mechanism calibrated on one set of points alone."""
    fit = calibrated_mechanism(chosen, (calibration_points,), pin)
    return BlindTest(
        chosen,
        fit,
        tuple(
            FluidPrediction(
                other, predict_cof(chosen, fit.values, other, pin, own_boundary=own_boundary)
            )
            for other in others
        ),
        own_boundary,
    )


def leave_one_out(
    chosen: Mechanism, points: Sequence[CofPoints], pin: Pin
) -> tuple[FluidPrediction, ...]:
    """Return each fluid predicted from its viscosity by the mechanism calibrated on all others."""
    if len(points) < 2:
        raise InputError(f"{len(points)} fluid", where="points", allowed="2 or more")
    found = []
    for left_out in points:
        rest = tuple(point for point in points if point is not left_out)
        fit = calibrated_mechanism(chosen, rest, pin)
        found.append(
            FluidPrediction(
                left_out, predict_cof(chosen, fit.values, left_out, pin, own_boundary=False)
            )
        )
    return tuple(found)


def stribeck_left_out(fluids: Sequence[BoundaryFriction], pin: Pin) -> tuple[FluidPrediction, ...]:
    """Return each fluid predicted by ``stribeck_law_at`` from the others: the peer to beat."""
    from underfoot.friction import stribeck_law_at

    found = []
    for fluid in fluids:
        law = stribeck_law_at(fluid.viscosity, [other for other in fluids if other is not fluid])
        points = fluid_points(fluid, rq=pin.sole_rq)
        # a film of 1 m: the viscous part is no part of what Eq. 17 fits
        shear = law(pin.pressure, points.speed, 1.0)
        found.append(FluidPrediction(points, (shear.adhesion + shear.hysteresis) / pin.pressure))
    return tuple(found)


@dataclass(frozen=True, slots=True)
class MechanismTests:
    """A mechanism calibrated on ``CALIBRATION_FLUID`` and what it predicts of the rest.

    ``fluids`` and ``roughness`` (Table 3): (with COF_BL of the fluid as input, from viscosity and
    roughness alone); ``one_from_five``: mean error of each fluid from a fit to the other five.
    """

    mechanism: Mechanism
    fluids: tuple[BlindTest, BlindTest]
    roughness: tuple[BlindTest, BlindTest]
    one_from_five: float

    @property
    def calibration(self) -> Calibration:
        """The fit on the calibration fluid."""
        return self.fluids[0].calibration


@dataclass(frozen=True, slots=True)
class MechanismComparison:
    """Every mechanism on the same data; ``peer``: error of ``StribeckLaw`` from the other fluids.

    ``chosen`` is the one that friction laws use: among the films at asperities that with the
    smallest error on the calibration fluid. What it predicts of other fluids does not enter.
    """

    pin: Pin
    points: Mapping[str, CofPoints]
    fluids: Mapping[str, BoundaryFriction]
    tests: Mapping[str, MechanismTests]
    peer: float

    @property
    def chosen(self) -> MechanismTests:
        """The mechanism in use."""
        films = [t for name, t in self.tests.items() if name.startswith("asperity_ehl")]
        return min(films, key=lambda t: t.calibration.mean_absolute_error)


def compare_mechanisms(catalogue: Catalogue) -> MechanismComparison:
    """Return all mechanisms calibrated on 50 % glycerol and tested on everything else of G.2."""
    from underfoot.case.friction import measured_fluids

    pin = pin_on_disk(catalogue)
    measured = sorted(measured_fluids(catalogue), key=lambda one: one.viscosity)
    fluids = {one.fluid: one for one in measured}
    points = {name: fluid_points(one, rq=pin.sole_rq) for name, one in fluids.items()}
    base = points[CALIBRATION_FLUID]
    others = [point for point in points.values() if point is not base]
    series = [
        one
        for one in roughness_series(catalogue)
        if not (one.fluid == CALIBRATION_FLUID and abs(one.rq - pin.sole_rq) < 1e-9)
    ]

    def both(chosen: Mechanism, predicted_points: list[CofPoints]) -> tuple[BlindTest, BlindTest]:
        return (
            blind_test(chosen, base, predicted_points, pin, own_boundary=True),
            blind_test(chosen, base, predicted_points, pin, own_boundary=False),
        )

    tests = {}
    for name, chosen in mechanisms().items():
        left_out = leave_one_out(chosen, list(points.values()), pin)
        tests[name] = MechanismTests(
            chosen,
            both(chosen, others),
            both(chosen, series),
            float(np.mean([one.error for one in left_out])),
        )
    peer = float(np.mean([one.error for one in stribeck_left_out(list(fluids.values()), pin)]))
    return MechanismComparison(pin, points, fluids, tests, peer)
