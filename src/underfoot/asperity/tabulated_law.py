"""A pressure-gap law through computed points, smooth and monotone, with explicit tails."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import Breach, InputError, Range, breaches

from ._kernels.monotone import interpolated, pchip_slopes


@dataclass(frozen=True, slots=True, eq=False)
class TabulatedLaw:
    """Pressure and flow factor against the mean gap, from nodes computed beforehand.

    Between the nodes ln(pressure) and the flow factor are monotone cubics of the gap (once
    differentiable). Above the largest gap the pressure decays exponentially and the flow factor
    tends to 1; below the smallest gap the pressure rises along its tangent and the flow factor
    decays to 0. Both tails continue the end slopes; leaving the nodes is a breach.

    Parameters
    ----------
    gap
        Mean gaps, m, rising, (n,), n >= 3; contact counts as zero gap.
    node_pressure
        Pa, falling, > 0.
    node_flow_factor
        phi of h^3/(12 eta) with h the mean gap.
    speed
        m/s at which the nodes were computed; None when they do not depend on it.
    """

    name: str
    source: str
    gap: np.ndarray
    node_pressure: np.ndarray
    node_flow_factor: np.ndarray
    speed: float | None = None
    ranges: dict[str, Range] = field(default_factory=dict)
    _log: np.ndarray = field(init=False, repr=False)
    _log_slope: np.ndarray = field(init=False, repr=False)
    _flow_slope: np.ndarray = field(init=False, repr=False)

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
            ("_log", logarithm),
            ("_log_slope", slope),
            ("_flow_slope", flow_slope),
        ):
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    def pressure(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return the asperity pressure (Pa) at mean gap ``gap`` (m), any sign and shape."""
        return self._pressure_and_slope(gap)[0]

    def stiffness(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return -d pressure / d gap (Pa/m), > 0."""
        return -self._pressure_and_slope(gap)[1]

    def flow_factor(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return phi, which multiplies h^3/(12 eta) with h the mean gap."""
        return self._flow_and_slope(gap)[0]

    def flow_factor_slope(self, gap: ArrayLike) -> NDArray[np.float64]:
        """Return d phi / d gap (1/m)."""
        return self._flow_and_slope(gap)[1]

    def mean_gap(self, pressure: ArrayLike) -> NDArray[np.float64]:
        """Return the gap (m) that carries ``pressure`` (Pa, > 0); negative in the lower tail."""
        p = np.asarray(pressure, dtype=float)
        if np.any(~(p > 0.0)):
            raise InputError("pressure must be positive", where=self.name)
        low = np.full(p.shape, self.gap[0])
        first = self.node_pressure[0]
        low = np.where(p > first, self.gap[0] + (p / first - 1.0) / self._log_slope[0], low)
        high = np.maximum(
            self.gap[-1], self.gap[-1] + (np.log(p) - self._log[-1]) / self._log_slope[-1]
        )
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

    def _pressure_and_slope(self, gap: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        g = np.asarray(gap, dtype=float)
        logarithm, slope = interpolated(self.gap, self._log, self._log_slope, g)
        above = np.maximum(g - self.gap[-1], 0.0)
        pressure = np.exp(logarithm + self._log_slope[-1] * above)
        derivative = pressure * slope
        tangent = self.node_pressure[0] * self._log_slope[0]
        below = g < self.gap[0]
        pressure = np.where(below, self.node_pressure[0] + tangent * (g - self.gap[0]), pressure)
        return pressure, np.where(below, tangent, derivative)

    def _flow_and_slope(self, gap: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        g = np.asarray(gap, dtype=float)
        flow, slope = interpolated(self.gap, self.node_flow_factor, self._flow_slope, g)
        first, rate = self.node_flow_factor[0], self._flow_slope[0]
        if first > 0.0:
            fall = first * np.exp(rate / first * np.minimum(g - self.gap[0], 0.0))
            slope = np.where(g < self.gap[0], fall * rate / first, slope)
            flow = np.where(g < self.gap[0], fall, flow)
        # towards 1 with the end's value and slope: 1 + (a + b x) exp(-x / length)
        last, rate = self.node_flow_factor[-1] - 1.0, self._flow_slope[-1]
        length = -last / rate if last * rate < 0.0 else self.gap[-1]
        x = np.maximum(g - self.gap[-1], 0.0)
        linear = rate + last / length
        decay = np.exp(-x / length)
        tail = 1.0 + (last + linear * x) * decay
        tail_slope = (linear - (last + linear * x) / length) * decay
        beyond = g > self.gap[-1]
        return np.where(beyond, tail, flow), np.where(beyond, tail_slope, slope)
