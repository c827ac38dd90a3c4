"""A grooved pad that strikes a wet floor: when does it touch?

Slipmeters such as the Brungraber Mark II drop a flat pad into a pool and pull at once. What the
pad traps must leave first: from under each rib into its grooves, and, once the grooves are full,
along them to the rim.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core.checks import positive

LAMINAR, TURBULENT = 64.0, 0.3
"""Friction factor of a pipe: 64 / Re, at least 0.3 Re^-1/4 (Blasius)."""
LONGEST = 1.0
"""s after which a pad counts as afloat."""
THINNEST = 1e-7


@dataclass(frozen=True, slots=True)
class Strike:
    """Square pad with straight grooves, and how it is dropped; SI.

    ``groove``, ``depth`` and ``rib`` are width and depth of a groove and width of a rib, ``pool``
    is the depth of the fluid, ``speed`` that of the pad as it meets the floor. Defaults: 76 mm and
    10 lb of a Brungraber Mark II; pool, speed and density of water are assumed.
    """

    groove: float
    depth: float
    rib: float
    viscosity: float
    side: float = 76e-3
    load: float = 44.5
    mass: float = 4.5
    pool: float = 2e-3
    speed: float = 0.1
    density: float = 1e3

    @property
    def land(self) -> float:
        """Share of the pad that touches."""
        return self.rib / (self.rib + self.groove)


def touch_time(strike: Strike, contact_pressure: Callable[[ArrayLike], Any]) -> float:
    """Return when half the load rests on the contact, s after the pad meets the floor's pool.

    m dv/dt = W - A [land (eta v b^2 / h^3 + rho (v b / 2 h)^2 / 6 + P(h)) + p_groove], with
    p_groove = rho u^2 (1/4 + f L / 24 D) of the speed u at the ends of full grooves, 0 before.

    Parameters:
        strike: Pad and drop.
        contact_pressure: Pressure (Pa) of rough pad and floor at a gap (m).

    Returns:
        float: Seconds; inf where it takes longer than a second.
    """
    for name in ("groove", "depth", "rib", "viscosity", "pool", "speed"):
        positive(getattr(strike, name), name, "Pa s" if name == "viscosity" else "m")
    area, land = strike.side**2, strike.land
    grooves = strike.side / (strike.rib + strike.groove)

    def contact(gap: ArrayLike) -> Any:
        return contact_pressure(gap) * land * area

    def rate(_: float, state: Any) -> list[float]:
        gap, speed = max(state[0], THINNEST), max(state[1], 0.0)
        out = speed * strike.rib / (2 * gap)
        under = strike.viscosity * speed * strike.rib**2 / gap**3 + strike.density * out**2 / 6
        force = under * land * area + float(contact(gap))
        if strike.pool - gap >= strike.depth * (1 - land):
            height = strike.depth + gap
            along = speed * area / (2 * grooves * strike.groove * height)
            hydraulic = 2 * strike.groove * height / (strike.groove + height)
            reynolds = max(strike.density * along * hydraulic / strike.viscosity, 1.0)
            factor = max(LAMINAR / reynolds, TURBULENT / reynolds**0.25)
            loss = 0.25 + factor * strike.side / (24 * hydraulic)
            force += strike.density * along**2 * loss * area
        return [-speed, (strike.load - force) / strike.mass]

    def touch_excess(_: float, state: Any) -> float:
        return float(contact(max(state[0], THINNEST))) - 0.5 * strike.load

    vars(touch_excess)["terminal"] = True  # SciPy ends the solution where this event is met
    start = [strike.pool, strike.speed]
    from scipy.integrate import solve_ivp  # heavy: it brings the optimisers along

    solved = solve_ivp(
        rate, (0.0, LONGEST), start, "LSODA", events=touch_excess, rtol=1e-6, atol=[1e-9, 1e-7]
    )
    return float(solved.t_events[0][0]) if solved.t_events[0].size else float(np.inf)
