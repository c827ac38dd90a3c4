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

A contact under a lug is in one of two states: sealed, as the mean over pairs without edges has it,
or wiped, and nearly as it is at rest. Its adhesion is the mean of both with the probability

    W = lambda (1 - (h0 / u)^4) (1 - m / w) (1 - 4/3 (m w)^0.5 / b) exp(-eta V / (S w)),  m = phi l

that the edge let in too little, that nothing was drawn back through the gap (phi its flow factor,
0 where roughness seals) and that the boundary film drew off the spots while the lug passed: the
dry front moves on at S / eta per metre, S the one constant that is fitted (``dewetting``). Behind
no edge W is 0; on rough pairs, and in thick fluids, next to nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core.arrays import Array, Mask
from underfoot.core.presentation import percent
from underfoot.core.remark import NOTHING, Message
from underfoot.friction import FrictionLaw, FrictionParts
from underfoot.friction.two_states import TwoStateLaw, between_states
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
PRESSING = np.array([0.01, 0.02, 0.05, 0.1, 0.2, 0.4])
"""Pressure over E* h' of a pair, h' its rms slope."""
FLOW = np.array([0.64, 0.54, 0.34, 0.14, 0.005, 0.0])
"""Flow factor of the gap there: solved contacts of self-affine roughness, Hurst exponent 0.8."""
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
    left as it is), suction over it, the factor on its contact friction, and the probability that it
    is ``wiped``.
    """

    edges: LugEdges
    load: Array
    suction: Array
    factor: Array
    wiped: Array

    def factor_map(self) -> Array:
        """Return the factor on contact friction (nx, ny), 1 outside lugs."""
        return self.edges.map(self.factor, 1.0)

    def wiped_share(self, sealed: FrictionParts, wiped: FrictionParts) -> float:
        """Return the mean probability of the wiped state, by what it adds to friction."""
        more = (wiped.adhesion - sealed.adhesion) * self.factor_map() * self.edges.area
        return float((more * self.edges.map(self.wiped, 0.0)).sum() / max(more.sum(), 1e-30))

    def suction_share(self, parts: FrictionParts) -> float:
        """Return the share of the contact friction, factor included, that suction makes."""
        solid = (parts.adhesion + parts.hysteresis) * self.edges.area
        ratio = self.edges.map(self.suction / np.maximum(self.factor, 1e-9), 0.0)
        return float((solid * ratio).sum() / max(solid.sum(), 1e-30))

    def summary(self) -> Message:
        """Return what the edges do in one sentence."""
        weight = self.load / max(self.load.sum(), 1e-30)
        pull, wiped = (float(weight @ each) for each in (self.suction, self.wiped))
        dry = NOTHING
        if wiped > 0.005:
            dry = Message("; {share} of it is wiped nearly dry", share=percent(wiped))
        return Message(
            "suction behind the edges of {count} lugs adds {share} of their load{dry}",
            count=int(np.count_nonzero(self.load)), share=percent(pull), dry=dry,
        )  # fmt: skip


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
    cof_wiped: Array | None = None,
    full_contact: float = math.inf,
    dewetting: float = 0.0,
    film_load: Array | float = 0.0,
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
        cof_wiped: Friction of each contact that was wiped, (lugs,); None has no such state.
        full_contact: Pressure E* h' / 2^0.5 of the pair, Pa.
        dewetting: S, Pa; at 0 no contact is wiped.
        film_load: What the film bears of each lug, (lugs,), pressure times cells, Pa.
    """
    cells = _sums(edges.label, edges.length.size, edges.area)
    load = sum_by_lug(edges, contact_pressure)
    bears = load / cells > IDLE
    whole = load + film_load
    p = np.maximum(whole / cells, IDLE)
    touching = load / np.maximum(whole, 1e-30)
    slender = edges.height / edges.length
    drag = viscosity * abs(speed)
    # the lug turns about its root: half the moment of the traction moves the pressure forward
    shift = np.maximum(0.5 - 0.012 / slender**2, 0.0)
    shift += np.where(slender > 0.25, ON_RUBBER / np.sqrt(slender), 0.0)
    gaps, pressures = gap_table(asperities)
    mu, pull = np.array(cof_contact), np.zeros_like(p)
    wiped = np.zeros_like(p)
    drawn = np.exp(-drag / (max(dewetting, 1e-300) * edges.length))
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
        lacking = lifted * np.maximum(1 - (inlet / dry) ** 4, 0.0)
        emptied = lacking * _kept_empty(edges, back)
        sheared = drag / gap * (lifted - 0.5 * emptied) / p
        contact = cof_contact
        if cof_wiped is not None:
            flow = np.interp(most / (2**0.5 * full_contact), PRESSING, FLOW)
            wiped = edges.fed * lacking * _kept_empty(edges, flow * back) * drawn
            contact = cof_contact + wiped * (cof_wiped - cof_contact)
        now = contact * touching * (1 + pull) + sheared
        change = np.stack([now - mu, emptied * suction / p - pull])
        if np.abs(change[:, bears]).max(initial=0.0) < STILL:
            break
        turned = change - before
        share *= -(before * turned).sum(axis=0) / np.maximum((turned**2).sum(axis=0), 1e-300)
        share = np.clip(share, *RELAXATION)
        before = change
        mu, pull = np.stack([mu, pull]) + share * change
    pull = np.where(bears, edges.fed * pull, 0.0)
    load, wiped = np.where(bears, load, 0.0), np.where(bears, wiped, 0.0)
    return LugFriction(edges, load, pull, 1 + pull, wiped)


def _kept_empty(edges: LugEdges, back: Array) -> Array:
    """Return the share of each lug that fluid drawn back over a length (m) does not reach."""
    behind = np.maximum(1 - back / edges.length, 0.0)
    return behind * np.maximum(1 - 4 / 3 * np.sqrt(back * edges.length) / edges.width, 0.0)


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
    """Local friction of a sole whose lugs have edges: a law, its factor, and the two states.

    ``dewetting`` is S (Pa); the states are those of laws that know the real area of the pair
    (``full_contact``), others hold their mean.
    """

    law: FrictionLaw
    edges: LugEdges
    asperities: PressureGapLaw
    modulus: float
    viscosity: float
    suction: float
    dewetting: float = 0.0
    film_load: Array | float = 0.0

    @property
    def _full_contact(self) -> float | None:
        return getattr(self.law, "full_contact", None) if self.dewetting else None

    def on(self, state: SoleState | CellState) -> EdgedLaw:
        """Return the law on the cells of a state, with what its film bears of each lug."""
        edges = self.edges.on(state) if isinstance(state, CellState) else self.edges
        film = state.fluid_pressure * state.areas["film_area"]
        return replace(self, edges=edges, film_load=_sums(edges.label, edges.length.size, film))

    def lugs(self, contact_pressure: Array, speed: float, film_thickness: Array) -> LugFriction:
        """Return what the edges do at contact pressure (Pa), speed (m/s) and film (m), (nx, ny)."""
        return self._lugs(contact_pressure, *self._states(contact_pressure, speed, film_thickness))

    def _states(self, pressure: Array, speed: float, film: Array) -> tuple[Any, ...]:
        """Return speed, friction of the mean state, and that of a wiped contact: at rest."""
        sealed = self.law(pressure, speed, film)
        wiped = None if self._full_contact is None else self.law(pressure, 0.0, film)
        return speed, sealed, wiped

    def _lugs(
        self, pressure: Array, speed: float, sealed: FrictionParts, wiped: FrictionParts | None
    ) -> LugFriction:
        load = np.maximum(sum_by_lug(self.edges, pressure), 1e-9)

        def of_contact(parts: FrictionParts) -> Array:
            return sum_by_lug(self.edges, parts.adhesion + parts.hysteresis) / load

        return lug_friction(
            self.edges,
            pressure,
            of_contact(sealed),
            self.asperities,
            modulus=self.modulus,
            viscosity=self.viscosity,
            speed=speed,
            suction=self.suction,
            cof_wiped=None if wiped is None else of_contact(wiped),
            full_contact=self._full_contact or math.inf,
            dewetting=self.dewetting,
            film_load=self.film_load,
        )

    def inlet(self, normal_force: float, speed: float) -> LugInlet:
        """Return what the edges let in under a load (N), at a speed (m/s)."""
        area = float((self.edges.length * self.edges.width).sum())
        pressure = np.full(1, normal_force / area)
        parts = self.law(pressure, speed, np.full(1, FAR_FILM))
        cof = float((parts.adhesion + parts.hysteresis)[0] / pressure[0])
        return LugInlet(self.edges, cof, self.modulus)

    def mean_factor(self, pressure: float, speed: float) -> float:
        """Return the mean factor on contact friction if every lug bore ``pressure`` (Pa), 1."""
        borne = np.where(self.edges.label > 0, pressure, 0.0)
        film = np.full_like(borne, FAR_FILM)
        edged, plain = (
            float(((parts.adhesion + parts.hysteresis) * self.edges.area).sum())
            for parts in (self(borne, speed, film), self.law(borne, speed, film))
        )
        return edged / plain

    def with_mean_state(self, pressure: Array, speed: float, film: Array) -> FrictionLaw:
        """Return the law with the mean probability of the wiped state, for draws of its inputs."""
        states = self._states(pressure, speed, film)
        if states[2] is None:
            return self.law
        share = self._lugs(pressure, *states).wiped_share(*states[1:])
        return TwoStateLaw(self.law, share) if share > 0 else self.law

    def __call__(
        self, contact_pressure: Array, speed: float, film_thickness: Array
    ) -> FrictionParts:
        """Return the shear stresses in Pa."""
        states = self._states(contact_pressure, speed, film_thickness)
        lugs = self._lugs(contact_pressure, *states)
        _, parts, wiped = states
        if wiped is not None:
            parts = between_states(parts, wiped, self.edges.map(lugs.wiped, 0.0))
        factor = lugs.factor_map()
        return replace(
            parts, adhesion=parts.adhesion * factor, hysteresis=parts.hysteresis * factor
        )
