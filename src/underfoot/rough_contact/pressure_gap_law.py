"""Pressure-gap laws of a rough interface: exponential, through computed points, from theory."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, ValidityRange, breaches
from underfoot.core.arrays import Array
from underfoot.core.checks import poisson_ratio, positive
from underfoot.core.deprecation import renamed_member
from underfoot.core.presentation import Presentable, SourcedModel, Table

from ._kernels.monotone import pchip_slopes
from .persson import GAP_SOURCE, cumulative, yang_persson_mean_gap
from .theory import checked_spectrum

DECAY_OVER_RQ, INTERCEPT_OVER_MODULUS = 0.5, 0.375
"""u0 / Rq and p0 / E* of ``ExponentialLaw``; its notes say what they stand for."""


@runtime_checkable
class PressureGapLaw(SourcedModel, Protocol):
    """Mean-field law of a rough interface: pressure and permeability against the mean gap.

    ``pressure`` decreases with the gap and continues linearly (once differentiable) below zero, so
    that a Newton iteration that overshoots meets a finite, growing pressure.
    """

    def pressure(self, gap: ArrayLike) -> Array:
        """Return the asperity pressure (Pa) at mean gap ``gap`` (m)."""
        ...

    def stiffness(self, gap: ArrayLike) -> Array:
        """Return -d pressure / d gap (Pa/m), never negative."""
        ...

    def flow_factor(self, gap: ArrayLike) -> Array:
        """Return the pressure flow factor phi that multiplies h^3 / (12 eta); 1 when smooth."""
        ...

    def flow_factor_slope(self, gap: ArrayLike) -> Array:
        """Return d phi / d gap (1/m)."""
        ...

    def breaches(self, *, pressure: ArrayLike, speed: ArrayLike) -> list[Breach]:
        """Return what leaves the tested range at these pressures (Pa) and speeds (m/s)."""
        ...


class _PresentableLaw(Presentable):
    """How every pressure-gap law presents itself: mean gap and stiffness at a few pressures."""

    __slots__ = ()

    def __repr__(self) -> str:
        law: Any = self
        return f"{type(self).__name__}({law.name}: {law.source})"[:199]

    def table(self) -> Table:
        """Return mean gap, stiffness and flow factor at contact pressures of 1 kPa to 10 MPa."""
        law: Any = self
        pressure = np.geomspace(1e3, 1e7, 9)
        gap = law.mean_gap(pressure)
        return Table(
            f"Pressure-gap law {law.name} ({law.source})",
            ("pressure Pa", "mean gap m", "stiffness Pa/m", "flow factor"),
            np.column_stack([pressure, gap, law.stiffness(gap), law.flow_factor(gap)]).tolist(),
        )


def _positive_pressures(pressure: ArrayLike, where: str) -> Array:
    p = np.asarray(pressure, dtype=float)
    if not np.all(p > 0.0):
        raise InputError("a pressure is zero or negative", where=where, allowed="above 0 Pa")
    return p


@dataclass(frozen=True, slots=True, repr=False)
class ExponentialLaw(_PresentableLaw):
    """P(h) = p0 exp(-h / u0) with p0 = 0.375 E / (1 - nu^2) and u0 = 0.5 Rq; phi = 1.

    Below h = 0 the pressure continues along its tangent, p0 (1 - h / u0).

    ``modulus`` (Pa, Young's, at the rate of the asperities) and ``poisson_ratio`` (0.5 for rubber)
    are those of the softer body, ``rq`` (m) the rms roughness of the two surfaces together.

    Persson, Physical Review Letters 99 (2007) 125502 gives the form p = beta E* exp(-u / u0). For a
    self-affine surface of Hurst exponent 0.8 and many scales the theory (Yang and Persson 2008,
    stored energy times 0.45) gives u0 = 0.45 sqrt(0.32 / pi) (10 / 3) Rq = 0.479 Rq, so 0.5 holds
    within 5 %. beta is no constant of the theory: it is 1.43 q0 Rq, with q0 the wave number of the
    longest wave. 0.375 (the constant of the grant report's macro model) stands for q0 Rq = 0.26; a
    surface with longer waves meets p at a gap smaller by u0 ln(0.26 / (q0 Rq)). Where the spectrum
    is known, ``persson_law`` takes it. Against the theory in full, for such surfaces of 1.5 to 3.5
    decades of waves, the gap is up to 0.2 Rq too large between 0.05 and 0.2 E*, where lugs press
    (the load on the film under the example treads is 14 to 24 % below that of the theory, COF 1 to
    4 %). It is 0 at p0, the end of the tested range, where the theory keeps 0.05 Rq.
    The gap enters the flow uncorrected (phi = 1), which overrates the permeability at small gaps.
    """

    modulus: float
    poisson_ratio: float
    rq: float
    name: str = field(default="exponential", init=False)
    source: str = field(default="Persson 2007, Phys. Rev. Lett. 99:125502", init=False)

    def __post_init__(self) -> None:
        positive(self.modulus, "modulus", "Pa")
        positive(self.rq, "rq", "m")
        poisson_ratio(self.poisson_ratio)

    @property
    def reference_pressure(self) -> float:
        """p0, the pressure at zero mean gap, Pa."""
        return INTERCEPT_OVER_MODULUS * self.modulus / (1 - self.poisson_ratio**2)

    @property
    def decay_length(self) -> float:
        """u0, the gap over which the pressure falls by e, m."""
        return DECAY_OVER_RQ * self.rq

    def mean_gap(self, pressure: ArrayLike) -> Array:
        """Return the gap (m) that carries ``pressure`` (Pa, > 0); negative above p0."""
        p = _positive_pressures(pressure, self.name) / self.reference_pressure
        return self.decay_length * np.where(p > 1.0, 1.0 - p, -np.log(p))

    def pressure(self, gap: ArrayLike) -> Array:
        """Return p0 exp(-h/u0), continued linearly below h = 0, in Pa."""
        reduced = np.asarray(gap, dtype=float) / self.decay_length
        falling = np.exp(-np.maximum(reduced, 0.0))
        return self.reference_pressure * np.where(reduced > 0, falling, 1 - reduced)

    def stiffness(self, gap: ArrayLike) -> Array:
        """Return -dP/dh in Pa/m."""
        reduced = np.asarray(gap, dtype=float) / self.decay_length
        return self.reference_pressure / self.decay_length * np.exp(-np.maximum(reduced, 0.0))

    def flow_factor(self, gap: ArrayLike) -> Array:
        """Return 1: the mean gap carries the flow."""
        return np.ones_like(np.asarray(gap, dtype=float))

    def flow_factor_slope(self, gap: ArrayLike) -> Array:
        """Return 0."""
        return np.zeros_like(np.asarray(gap, dtype=float))

    def breaches(self, *, pressure: ArrayLike, speed: ArrayLike) -> list[Breach]:
        """Return the breach of the range above, if any (the law does not know the speed)."""
        ranges = {"pressure": ValidityRange(0.0, self.reference_pressure, "Pa", self.source)}
        return breaches(self.name, ranges, {"pressure": pressure})


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TabulatedLaw(_PresentableLaw):
    """Pressure and flow factor against the mean gap, from nodes computed beforehand.

    Between the nodes ln(pressure) and the flow factor are monotone cubics of the gap (once
    differentiable). Above the largest gap the pressure decays exponentially and the flow factor
    tends to 1; below the smallest gap the pressure rises along its tangent and the flow factor
    decays to 0. Both tails continue the end slopes; leaving the nodes is a breach.

    ``gap`` are mean gaps (m, rising, (n,), n >= 3; contact counts as zero gap), ``node_pressure``
    (Pa) falls and is above 0, ``node_flow_factor`` is phi of h^3/(12 eta) with h the mean gap.
    ``speed`` (m/s) is that at which the nodes were computed; None when they do not depend on it.
    """

    name: str
    source: str
    gap: np.ndarray
    node_pressure: np.ndarray
    node_flow_factor: np.ndarray
    speed: float | None = None
    ranges: dict[str, ValidityRange] = field(default_factory=dict)
    _log: np.ndarray = field(init=False, repr=False)  # coefficients of the cubics
    _flow: np.ndarray = field(init=False, repr=False)
    _last_slopes: np.ndarray = field(init=False, repr=False)  # of both, exact where they are 0

    def __post_init__(self) -> None:
        gap, pressure, flow = (
            np.asarray(values, dtype=float)
            for values in (self.gap, self.node_pressure, self.node_flow_factor)
        )
        if gap.ndim != 1 or gap.size < 3 or pressure.shape != gap.shape or flow.shape != gap.shape:
            raise InputError(
                f"nodes of shape {gap.shape}, {pressure.shape}, {flow.shape}",
                where=self.name,
                allowed="three arrays of one length, at least 3",
            )
        if not (
            np.all(np.diff(gap) > 0.0)
            and np.all(np.diff(pressure) < 0.0)
            and pressure[-1] > 0.0
            and np.all(np.isfinite(flow))
            and flow.min() >= 0.0
        ):
            raise InputError(
                "the nodes are not a falling pressure over a rising gap",
                where=self.name,
                allowed="gap rising, pressure falling and positive, flow factor finite and >= 0",
            )
        from scipy.interpolate import CubicHermiteSpline

        logarithm = np.log(pressure)
        slope = pchip_slopes(gap, logarithm)
        # an end slope of zero would let the pressure stop rising: take the secant there
        secant = np.diff(logarithm) / np.diff(gap)
        slope[0] = min(slope[0], 0.1 * secant[0])
        slope[-1] = min(slope[-1], 0.1 * secant[-1])
        flow_slope = pchip_slopes(gap, flow)
        if flow[0] == 0.0:
            flow_slope[0] = 0.0  # a closed interface stays closed below
        for name, values in (
            ("gap", gap),
            ("node_pressure", pressure),
            ("node_flow_factor", flow),
            ("_log", CubicHermiteSpline(gap, logarithm, slope).c),
            ("_flow", CubicHermiteSpline(gap, flow, flow_slope).c),
            ("_last_slopes", np.array([slope[-1], flow_slope[-1]])),
        ):
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    def scale_contact(self, gap: float, pressure: float) -> "TabulatedLaw":
        """Return the law of an elastic contact alike, gaps and pressures times factors above 0.

        Heights times a make gaps times a, and pressures times a and the ratio of E / (1 - nu^2);
        flow factors stay. An elastic contact has no speed.
        """
        ranges = {
            name: replace(limits, low=limits.low * pressure, high=limits.high * pressure)
            for name, limits in self.ranges.items()
            if name == "pressure"
        }
        nodes = pressure * self.node_pressure
        return replace(self, gap=gap * self.gap, node_pressure=nodes, speed=None, ranges=ranges)

    scaled = renamed_member("scaled", "scale_contact", gone="0.4")

    def change_gap_and_flow(self, gap: float, flow: float) -> "TabulatedLaw":
        """Return the law with its gaps and flow factors (at most 1) times factors above 0."""
        passing = np.minimum(flow * self.node_flow_factor, 1.0)
        return replace(self, gap=gap * self.gap, node_flow_factor=passing)

    changed = renamed_member("changed", "change_gap_and_flow", gone="0.4")

    def pressure(self, gap: ArrayLike) -> Array:
        """Return the asperity pressure (Pa) at mean gap ``gap`` (m), any sign and shape."""
        g, first = np.asarray(gap, dtype=float), self.node_pressure[0]
        above = np.maximum(g - self.gap[-1], 0.0)
        pressure = np.exp(self._cubic(self._log, g) + self._last_slopes[0] * above)
        tangent = first * (1.0 + self._log[2, 0] * (g - self.gap[0]))
        return np.where(g < self.gap[0], tangent, pressure)

    def stiffness(self, gap: ArrayLike) -> Array:
        """Return -d pressure / d gap (Pa/m), > 0."""
        g = np.asarray(gap, dtype=float)
        return -self.pressure(np.maximum(g, self.gap[0])) * self._cubic(self._log, g, 1)

    def flow_factor(self, gap: ArrayLike) -> Array:
        """Return phi, which multiplies h^3/(12 eta) with h the mean gap."""
        return self._flow_and_slope(gap)[0]

    def flow_factor_slope(self, gap: ArrayLike) -> Array:
        """Return d phi / d gap (1/m)."""
        return self._flow_and_slope(gap)[1]

    def mean_gap(self, pressure: ArrayLike) -> Array:
        """Return the gap (m) that carries ``pressure`` (Pa, > 0); negative in the lower tail."""
        p = _positive_pressures(pressure, self.name)
        first, last = self.node_pressure[[0, -1]]
        low = self.gap[0] + np.maximum(p / first - 1.0, 0.0) / self._log[2, 0]
        high = self.gap[-1] + np.minimum(np.log(p / last), 0.0) / self._last_slopes[0]
        for _ in range(60):
            middle = 0.5 * (low + high)
            above = self.pressure(middle) > p
            low, high = np.where(above, middle, low), np.where(above, high, middle)
        return 0.5 * (low + high)

    def breaches(self, *, pressure: ArrayLike, speed: ArrayLike) -> list[Breach]:
        """Return what leaves the computed pressures and speeds."""
        return breaches(
            self.name, self.ranges, {"pressure": pressure, "speed": np.abs(np.asarray(speed))}
        )

    def _cubic(self, coefficients: np.ndarray, gap: ArrayLike, slope: int = 0) -> Array:
        """Return a cubic of the gap or its slope, beyond the nodes that of the outermost node."""
        from scipy.interpolate import PPoly

        inside = np.clip(gap, self.gap[0], self.gap[-1])
        return PPoly.construct_fast(coefficients, self.gap)(inside, slope)

    def _flow_and_slope(self, gap: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        g = np.asarray(gap, dtype=float)
        flow, slope = (self._cubic(self._flow, g, order) for order in (0, 1))
        first, rate = self.node_flow_factor[0], self._flow[2, 0]
        if first > 0.0:
            fall = first * np.exp(rate / first * np.minimum(g - self.gap[0], 0.0))
            slope = np.where(g < self.gap[0], fall * rate / first, slope)
            flow = np.where(g < self.gap[0], fall, flow)
        # towards 1 with the end's value and slope: 1 + (a + b x) exp(-x / length)
        last, rate = self.node_flow_factor[-1] - 1.0, self._last_slopes[1]
        length = -last / rate if last * rate < 0.0 else self.gap[-1]
        x = np.maximum(g - self.gap[-1], 0.0)
        linear = rate + last / length
        decay = np.exp(-x / length)
        tail = 1.0 + (last + linear * x) * decay
        tail_slope = (linear - (last + linear * x) / length) * decay
        beyond = g > self.gap[-1]
        return np.where(beyond, tail, flow), np.where(beyond, tail_slope, slope)


_NODES = 48
_LIGHTEST, _HEAVIEST = 1e-4, 0.5
"""Shares of E* h' between which the nodes lie; above, the theory's gap is 20 % off and more."""


def persson_law(
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: float,
    poisson_ratio: float = 0.5,
    flow_factor: Callable[[np.ndarray], np.ndarray] | None = None,
) -> TabulatedLaw:
    """Return the law p(u) of Yang and Persson's mean gap u between 1e-4 and 0.5 of E* h'.

    Parameters:
        wavenumber, spectrum: q (rad/m, rising) and C(q) (m^4), <h^2> = 2 pi int q C dq.
        modulus: Young's modulus of the rubber at the rate of its asperities, Pa.
        flow_factor: phi of the mean gap (m), 0 or more and not falling; None leaves it at 1, which
            lets too much fluid through at small gaps.

    Within 2 % of half-space gaps up to a tenth of E* h', 7 % at 0.3 and 20 % at 0.5 (self-affine,
    Hurst exponent 0.8). Without hysteresis: at speed take the modulus at the asperities' rate.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    positive(modulus, "modulus", "Pa")
    gradient = float(np.sqrt(2.0 * np.pi * cumulative(q**3 * c, q)[-1]))
    full = modulus / (1.0 - poisson_ratio**2) * gradient
    pressure = np.geomspace(_HEAVIEST, _LIGHTEST, _NODES) * full
    gap = yang_persson_mean_gap(pressure, q, c, modulus, poisson_ratio)
    flow = np.ones_like(gap) if flow_factor is None else np.asarray(flow_factor(gap), dtype=float)
    return TabulatedLaw(
        name="persson",
        source=GAP_SOURCE,
        gap=gap,
        node_pressure=pressure,
        node_flow_factor=flow,
        ranges={
            "pressure": ValidityRange(
                _LIGHTEST * full, _HEAVIEST * full, "Pa", "1e-4 to 0.5 of E* times the rms slope"
            )
        },
    )
