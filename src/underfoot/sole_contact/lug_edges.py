"""Edges of lugs: the film that a leading edge lets in, and the suction of the contact behind it.

A film solver on cells of half a millimetre does not see what the edge of a lug does on tenths of a
millimetre. Where a lug slides out of a groove full of fluid, its edge lets in a film, which
``lug_inlet`` gives to the solver:

    h0 = 1.06 (eta V / p)^0.6 r^0.4 (10 p / E)^0.15 exp(-k)
    k = min(0.27 mu (min(w, 2 h) / r)^0.5, 1)

(soft elastohydrodynamic inlet). Roughness stands against it: the gap is (u^4 + h0^4)^(1/4), u the
dry gap. A thin film is too little for the wider gap behind the edge peak: it ruptures and pulls
with up to the suction p_a over the share

    a = lambda (1 - (h0 / u)^4) (1 - l / w) (1 - 4/3 (l w)^0.5 / b),  l = u^2 p_a / (1.5 eta V)

Contact friction of the lug is multiplied by 1 + s, s = a p_a / p. Traction tilts a lug by statics:
the pressure's centre moves forward by c mu h, and the trailing part lifts off (lambda) beyond 0.12
of the length. Closed forms fitted to plane-strain finite elements coupled with Reynolds' equation
and rough contact; over blocks they miss ln of the contact friction by 0.31 (root mean square),
nearly all of it where the film sets in. A rib along the sliding has no such edge.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core.arrays import Array, Mask
from underfoot.friction import FrictionLaw, FrictionParts
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe import SoleMap

from .sole_state import CellState, SoleState

INLET = 1.06
NARROWEST = 0.1e-3
"""m: a lug edge drawn sharper is moulded with about this radius (assumed)."""
EXCESS = 0.36
"""The leading edge of a lug bears 36 % more than its mean (finite elements: friction 0.2, height
half the length) and wears more by that share of what is removed."""
ON_RUBBER = 0.12
LIFTING, LIFT = 0.12, 1.9
"""Shift of the pressure, over the length, from which a lug lifts; loss of contact per shift."""
LACKING = 0.25
"""Share of the gap that lacks fluid behind the edge (0.15 to 0.3 computed)."""
STEPS, STILL = 200, 1e-9
RELAXATION = 0.1, 1.0
IDLE = 20e3
"""Pa: a lug whose contact bears less on the mean hardly touches."""
GAPS = 400
FAR_FILM = 1e-3  # m, a film that no wall shear comes from


@dataclass(frozen=True, slots=True, eq=False)
class LugEdges:
    """Lugs of a sole; arrays (lugs,) in m. ``label`` (nx, ny) is 0 outside lugs, else 1, 2, ...

    ``area`` (nx, ny) is what each cell stands for, in cells.

    ``length`` along the sliding, ``width`` across, ``height`` of the groove; ``edge`` radius;
    ``fed`` is the share of the leading face that borders on a groove.
    """

    label: NDArray[np.intp]
    area: Array
    length: Array
    width: Array
    height: Array
    edge: Array
    fed: Array

    @property
    def reach(self) -> Array:
        """Root of the length over which friction turns an edge down, over its radius, (lugs,)."""
        return np.sqrt(np.minimum(self.length, 2 * self.height) / self.edge)

    def on(self, cells: CellState) -> LugEdges:
        """Return the lugs on finer cells."""
        return replace(self, label=self.label.ravel()[cells.square], area=cells.area)

    def map(self, values: Array, outside: float) -> Array:
        """Return one value a lug as a map (nx, ny)."""
        return np.concatenate([[outside], values])[self.label]


@dataclass(frozen=True, slots=True, eq=False)
class LugInlet:
    """What says how much film the edges of lugs let in.

    ``cof`` is the contact friction of the lugs, ``modulus`` Young's modulus of the rubber, Pa.
    """

    edges: LugEdges
    cof: float
    modulus: float


@dataclass(frozen=True, slots=True, eq=False)
class LugFriction:
    """What the edges do to each lug, (lugs,).

    ``load`` on its contact (pressure times cells, Pa; 0 of a lug that hardly bears, which is
    left as it is), suction over it, and the factor on its contact friction.
    """

    edges: LugEdges
    load: Array
    suction: Array
    factor: Array

    def factor_map(self) -> Array:
        """Return the factor on contact friction (nx, ny), 1 outside lugs."""
        return self.edges.map(self.factor, 1.0)

    def suction_share(self, parts: FrictionParts) -> float:
        """Return the share of the contact friction, factor included, that suction makes."""
        solid = (parts.adhesion + parts.hysteresis) * self.edges.area
        ratio = self.edges.map(self.suction / np.maximum(self.factor, 1e-9), 0.0)
        return float((solid * ratio).sum() / max(solid.sum(), 1e-30))

    def words(self) -> str:
        """Return what the edges do in one sentence."""
        weight = self.load / max(self.load.sum(), 1e-30)
        count = np.count_nonzero(self.load)
        return f"suction behind the edges of {count} lugs adds {weight @ self.suction:.0%} of load"


def lug_edges(
    sole: SoleMap, edge_radius: float, *, worn_edge_radius: float, forward: bool = True
) -> LugEdges | None:
    """Return the lugs of a sole; None where it has no tread.

    Parameters:
        sole: Map; lugs are connected land beside grooves.
        edge_radius: Of the new lugs, m; sharper than 0.1 mm counts as that. Wear takes this round
            off and makes its own.
        worn_edge_radius: Largest that wear makes, m.
        forward: Whether the sole slides towards the toe (fluid meets the front of a lug), else to
            the rear.
    """
    from scipy.ndimage import label

    found: Any = label(sole.land & (sole.tread_depth > 0))
    numbers, count = found
    groove = sole.inside & ~sole.land
    if count == 0 or not groove.any():
        return None
    step = -1 if forward else 1
    ahead = np.roll(numbers, step, axis=0)  # the cell met first by the fluid
    leading = (numbers > 0) & (ahead != numbers)
    from_groove = leading & np.roll(groove, step, axis=0)
    area = np.ones(numbers.shape) if sole.cut is None else sole.cut.area
    cells = _sums(numbers, count, area)
    faces = np.maximum(_sums(numbers, count, leading), 1)
    length = cells / faces * sole.spacing
    removed = 0.0 if sole.removed is None else sole.removed
    worn = _sums(numbers, count, removed * area) / cells
    return LugEdges(
        numbers,
        area,
        length,
        cells * sole.spacing**2 / length,
        _sums(numbers, count, sole.tread_depth * area) / cells,
        # the floor cuts the moulded round off, and the edge rounds anew
        np.maximum.reduce(
            [
                edge_radius - worn,
                np.minimum(EXCESS * worn, worn_edge_radius),
                np.full(count, NARROWEST),
            ]
        ),
        _sums(numbers, count, from_groove) / faces,
    )


def lug_friction(
    edges: LugEdges,
    contact_pressure: Array,
    cof_contact: Array,
    asperities: PressureGapLaw,
    *,
    modulus: float,
    viscosity: float,
    speed: float,
    suction: float,
) -> LugFriction:
    """Return what their edges do to lugs that slide.

    Parameters:
        edges: Of ``lug_edges``.
        contact_pressure: (nx, ny) as solved, Pa.
        cof_contact: Friction of the contact of each lug, (lugs,), 1.
        asperities: Pressure against gap of the pair.
        modulus: Young's modulus of the lugs, Pa.
        viscosity, speed: Pa s and m/s.
        suction: Highest pull p_a that an emptied contact holds, Pa, 0 or more.
    """
    cells = _sums(edges.label, edges.length.size, edges.area)
    load = sum_by_lug(edges, contact_pressure)
    bears = load / cells > IDLE
    p = np.maximum(load / cells, IDLE)
    slender = edges.height / edges.length
    drag = viscosity * abs(speed)
    # the lug turns about its root: half the moment of the traction moves the pressure forward
    shift = np.maximum(0.5 - 0.012 / slender**2, 0.0)
    shift += np.where(slender > 0.25, ON_RUBBER / np.sqrt(slender), 0.0)
    gaps, pressures = gap_table(asperities)
    mu, pull = np.array(cof_contact), np.zeros_like(p)
    # fixed point a lug, relaxed by what the last step turned the change by (Aitken's rule)
    share, before = np.full_like(p, RELAXATION[0]), np.zeros((2, p.size))
    for _ in range(STEPS):
        forward = np.minimum(shift * mu * slender, 0.47)
        lifted = np.maximum(1 - LIFT * np.maximum(forward - LIFTING, 0.0), 0.12)
        most = p * (1 + pull) / lifted
        inlet = let_in(drag, most, edges.edge, modulus, mu * edges.reach)
        dry = np.maximum(np.interp(most, pressures[::-1], gaps[::-1]), 1e-9)
        gap = (dry**4 + inlet**4) ** 0.25
        back = dry**2 * suction / (6 * LACKING * max(drag, 1e-12))
        emptied = lifted * np.maximum(1 - (inlet / dry) ** 4, 0.0)
        emptied *= np.maximum(1 - back / edges.length, 0.0)
        emptied *= np.maximum(1 - 4 / 3 * np.sqrt(back * edges.length) / edges.width, 0.0)
        sheared = drag / gap * (lifted - 0.5 * emptied) / p
        now = cof_contact * (1 + pull) + sheared
        change = np.stack([now - mu, emptied * suction / p - pull])
        if np.abs(change[:, bears]).max(initial=0.0) < STILL:
            break
        turned = change - before
        share *= -(before * turned).sum(axis=0) / np.maximum((turned**2).sum(axis=0), 1e-300)
        share = np.clip(share, *RELAXATION)
        before = change
        mu, pull = np.stack([mu, pull]) + share * change
    pull = np.where(bears, edges.fed * pull, 0.0)
    return LugFriction(edges, np.where(bears, load, 0.0), pull, 1 + pull)


def sum_by_lug(edges: LugEdges, values: Array | Mask) -> Array:
    """Return the sum of a map (nx, ny) over the cells of each lug, cut ones in part, (lugs,)."""
    return _sums(edges.label, edges.length.size, values * edges.area)


def _sums(label: NDArray[np.intp], count: int, values: ArrayLike) -> Array:
    sums = np.bincount(label.ravel(), np.ravel(values).astype(float), count + 1)
    return np.asarray(sums[1:], dtype=float)


def let_in(drag: float, pressure: Array, radius: Array, modulus: float, turned: Array) -> Array:
    """Return the film h0 (m) that edges of a ``radius`` (m) let in.

    Parameters:
        drag: Viscosity times speed, Pa m.
        pressure: Mean pressure behind the edge, Pa.
        modulus: Young's modulus of the lugs, Pa.
        turned: Friction of the lug times ``LugEdges.reach``: how far the edge is turned down.
    """
    film = INLET * (drag / pressure) ** 0.6 * radius**0.4 * (10 * pressure / modulus) ** 0.15
    return film * np.exp(-np.minimum(0.27 * turned, 1.0))


def gap_table(asperities: PressureGapLaw) -> tuple[Array, Array]:
    """Return gaps (m) from 0 to where the pressure is next to nothing, and the pressures (Pa)."""
    widest = 1e-6
    while float(asperities.pressure(widest)) > 1.0 and widest < 1e-2:
        widest *= 1.5
    gaps = np.linspace(0.0, widest, GAPS)
    return gaps, asperities.pressure(gaps)


@dataclass(frozen=True, slots=True, eq=False)
class EdgedLaw:
    """Local friction of a sole whose lugs have edges: a law and the factor on its contact part."""

    law: FrictionLaw
    edges: LugEdges
    asperities: PressureGapLaw
    modulus: float
    viscosity: float
    suction: float

    def on(self, state: SoleState | CellState) -> EdgedLaw:
        """Return the law on the cells of a state."""
        return replace(self, edges=self.edges.on(state)) if isinstance(state, CellState) else self

    def lugs(self, contact_pressure: Array, speed: float, film_thickness: Array) -> LugFriction:
        """Return what the edges do at contact pressure (Pa), speed (m/s) and film (m), (nx, ny)."""
        return self._lugs(
            self.law(contact_pressure, speed, film_thickness), contact_pressure, speed
        )

    def inlet(self, normal_force: float, speed: float) -> LugInlet:
        """Return what the edges let in under a load (N), at a speed (m/s)."""
        area = float((self.edges.length * self.edges.width).sum())
        pressure = np.full(1, normal_force / area)
        parts = self.law(pressure, speed, np.full(1, FAR_FILM))
        cof = float((parts.adhesion + parts.hysteresis)[0] / pressure[0])
        return LugInlet(self.edges, cof, self.modulus)

    def _lugs(self, parts: FrictionParts, contact_pressure: Array, speed: float) -> LugFriction:
        touching = np.where(contact_pressure > 0, contact_pressure, 1.0)
        cof = (parts.adhesion + parts.hysteresis) / touching
        load = np.maximum(sum_by_lug(self.edges, contact_pressure), 1e-9)
        return lug_friction(
            self.edges,
            contact_pressure,
            sum_by_lug(self.edges, cof * contact_pressure) / load,
            self.asperities,
            modulus=self.modulus,
            viscosity=self.viscosity,
            speed=speed,
            suction=self.suction,
        )

    def mean_factor(self, pressure: float, speed: float) -> float:
        """Return the mean factor on contact friction if every lug bore ``pressure`` (Pa), 1."""
        borne = np.where(self.edges.label > 0, pressure, 0.0)
        lugs = self.lugs(borne, speed, np.full_like(borne, FAR_FILM))
        return float(np.average(lugs.factor, weights=self.edges.length * self.edges.width))

    def __call__(
        self, contact_pressure: Array, speed: float, film_thickness: Array
    ) -> FrictionParts:
        """Return the shear stresses in Pa."""
        parts = self.law(contact_pressure, speed, film_thickness)
        factor = self._lugs(parts, contact_pressure, speed).factor_map()
        return replace(
            parts, adhesion=parts.adhesion * factor, hysteresis=parts.hysteresis * factor
        )
