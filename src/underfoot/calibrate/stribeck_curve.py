"""COF of one pair and fluid over speed, in parts, from the friction law of a case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import InputError

from .pin_regimes import PinRegimes, pin_regimes
from .stribeck_points import SPEEDS, fluid_points

if TYPE_CHECKING:
    from underfoot.case import Case

COUNT = 61
ADHESION_STATES = {
    "boundary": "at least 90 % of the adhesion at rest is left",
    "part blocked": "10 to 90 % of it is left",
    "blocked": "less than 10 % of it is left",
}


@dataclass(frozen=True, slots=True, eq=False)
class StribeckCurve:
    """COF over ``speed`` (m/s) with its parts and, where published, points; arrays (n,).

    ``interval``: bounds of the central 95 % of COF, None when an input has no standard deviation.
    ``points``: speed and COF of the fit of Eq. 17, or of the mean, on ``pair``; ``adhesion_left``:
    over that at rest; ``regimes`` as on the report's pin; ``notes``: assumptions and breaches.
    """

    label: str
    law: str
    viscosity: float
    speed: np.ndarray
    parts: dict[str, np.ndarray]
    interval: tuple[np.ndarray, np.ndarray] | None
    deviation: np.ndarray | None
    adhesion_left: np.ndarray
    regimes: PinRegimes | None
    points: tuple[np.ndarray, np.ndarray] | None
    pair: str
    notes: tuple[str, ...]

    @property
    def states(self) -> tuple[str, ...]:
        """Name of each speed's share of adhesion, of ``ADHESION_STATES``."""
        names = tuple(ADHESION_STATES)
        return tuple(
            names[0] if x >= 0.9 else names[1] if x >= 0.1 else names[2] for x in self.adhesion_left
        )

    def rows(self) -> list[dict[str, Any]]:
        """Return one row for each speed, SI units."""
        known = {} if self.points is None else dict(zip(*self.points, strict=True))
        low, high = self.interval or (None, None)
        return [
            {
                "fluid": self.label,
                "viscosity_Pa_s": self.viscosity,
                "speed_m_per_s": float(speed),
                "viscosity_times_speed_Pa_m": self.viscosity * float(speed),
                "cof": float(sum(part[i] for part in self.parts.values())),
                "cof_sd": None if self.deviation is None else float(self.deviation[i]),
                "cof_low_95": None if low is None else float(low[i]),
                "cof_high_95": None if high is None else float(high[i]),
                **{name: float(part[i]) for name, part in self.parts.items()},
                "adhesion_left": float(self.adhesion_left[i]),
                "adhesion_state": self.states[i],
                **({} if self.regimes is None else self.regimes.row(i)),
                "published_cof": None if speed not in known else float(known[speed]),
            }
            for i, speed in enumerate(self.speed)
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {
            "fluid": self.label,
            "law": self.law,
            "pair_of_published": self.pair,
            "notes": list(self.notes),
            "rows": self.rows(),
        }


def stribeck_curve(
    case: Case, label: str, *, pressure: float, slowest: float, fastest: float
) -> StribeckCurve:
    """Return COF over speed of the case's friction law at one contact pressure (Pa).

    The viscous part takes the mean gap that the case's rough interface has at that pressure. The
    published speeds (0.05 to 1 m/s) within the range are among those computed.

    Errors:
        InputError: A dry case, a pressure that is not positive, or what the law itself misses.
    """
    from underfoot.case.friction import measured_fluids
    from underfoot.compute.resolve import resolve_context
    from underfoot.friction.sampled_cof import PARTS, sampled_points

    if not pressure > 0:
        raise InputError(f"{pressure:g} Pa", where="--pressure", allowed="above 0")
    context = resolve_context(case)
    fluid = context.viscosity
    if fluid is None or fluid.value is None:
        raise InputError(
            "a dry floor has no viscosity",
            where="contaminant",
            remedy='Choose a fluid, as --fluid water or contaminant = "canola_oil"',
        )
    law = case.friction.build(context)
    within = SPEEDS[(slowest <= SPEEDS) & (fastest >= SPEEDS)]
    speed = np.unique(np.concatenate([np.geomspace(slowest, fastest, COUNT), within]))
    gap = _gap(case, pressure)
    at: dict[str, Any] = {
        "contact_pressure": np.full(speed.shape, pressure),
        "speed": speed,
        "film_thickness": np.full(speed.shape, gap),
    }
    parts = law(**at)
    rest = float(law(pressure, 1e-9, gap).adhesion)
    left = parts.adhesion / rest if rest > 0 else np.zeros(speed.shape)
    spread = sampled_points(law, **at, fluid_inputs={"viscosity": fluid}, seed=case.numerics.seed)
    friction = next(
        (
            measured_fluid
            for measured_fluid in measured_fluids(case.catalogue)
            if measured_fluid.fluid == context.fluid
        ),
        None,
    )
    measured = None if friction is None else fluid_points(friction, rq=0.0, speed=within)
    return StribeckCurve(
        label=label,
        law=law.name,
        viscosity=fluid.value,
        speed=speed,
        parts={name: getattr(parts, name) / pressure for name in PARTS},
        interval=None if spread is None else (spread.low, spread.high),
        deviation=None if spread is None else spread.deviation,
        adhesion_left=left,
        regimes=pin_regimes(case, fluid.value, speed, pressure),
        points=None if measured is None else (measured.speed, measured.cof),
        pair="" if friction is None else friction.pair,
        notes=tuple(
            dict.fromkeys((*law.assumptions, *(str(breach) for breach in law.breaches(**at))))
        ),
    )


def _gap(case: Case, pressure: float) -> float:
    """Return the mean gap (m) at which the rough interface carries the pressure."""
    from scipy.optimize import brentq

    from underfoot.compute.resolve import resolve_context

    context = resolve_context(case)
    interface = case.rough_contact.build(context)

    def excess(gap: float) -> float:
        return float(interface.pressure(gap)) - pressure

    highest = 20 * context.rq_value
    if excess(0.0) <= 0:
        return 0.0
    if excess(highest) >= 0:
        return highest
    found: Any = brentq(excess, 0.0, highest, xtol=1e-12)
    return float(found)
