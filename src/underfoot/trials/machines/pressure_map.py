"""Slip tester with a pressure sensor in the floor: scans joined to a map, the load on the fluid."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError
from underfoot.core.remark import Message

from ..recording.axes import Axes, axes_of
from ..recording.measurement import Measurement, remark_of
from ..recording.signals import MARKER_FILTER, LowPass, bridge_gaps, is_saturated, low_passed
from ..recording.trial import Channel, Marker, Trial

NARROW = 1.5  # spacings; pressure bumps narrower than this can hide between scans
OUTER_SHARE = 0.02
_BASELINE = 100


_SATURATED = Message("the sensor is saturated: the peak is a lower bound")


@dataclass(frozen=True, slots=True)
class PressureScan:
    """Pressure along one line under the shoe, in the shoe's frame.

    ``along`` (n,) is the place of the sensor forward of the heel's back (m), falling with time;
    ``pressure`` (n,), Pa, has its baseline subtracted; ``lateral`` is the place of the sensor to
    the left of the heel's middle (m), mean over the scan. ``speed`` is the mean sliding speed (m/s)
    and ``speed_change`` its range over its mean; ``baseline_sd`` the noise of the sensor (Pa);
    ``sample_load`` the line load of the scan (N/m): the sum of pressure times displacement per
    sample.
    """

    trial: str
    along: np.ndarray
    pressure: np.ndarray
    lateral: float
    speed: float
    speed_change: float
    baseline_sd: float
    sample_load: float
    flags: tuple[Message, ...] = ()


@dataclass(frozen=True, slots=True)
class PressureMap:
    """Scans joined by position, and what they carry.

    ``lateral`` (m,) is the place of each scan to the left of the heel's middle and ``along`` (k,)
    that forward of the heel's back (m), both ascending; ``pressure`` (m, k), Pa, is NaN where a
    scan did not reach. ``load`` is what the fluid carries (N), Eq. 27; ``peak`` the largest
    pressure (Pa) at ``peak_along`` and ``peak_lateral`` (m); ``line_loads`` (m,) the line load of
    each scan (N/m); ``outer_share`` the share of the load in the two outermost scans;
    ``half_spacing_change`` the largest relative change of the load when every second scan is left
    out.
    """

    lateral: np.ndarray
    along: np.ndarray
    pressure: np.ndarray
    load: Measurement
    peak: Measurement
    peak_along: Measurement
    peak_lateral: Measurement
    line_loads: np.ndarray
    outer_share: float
    half_spacing_change: float | None
    scans: tuple[PressureScan, ...]


def pressure_scan(
    trial: Trial,
    sensor: Channel,
    marker: Marker,
    *,
    position: ArrayLike,
    sliding: np.ndarray | None = None,
    heel_back: float = 0.0,
    heel_middle: float = 0.0,
    back: float = -0.01,
    front: float = 0.12,
    axes: Axes | None = None,
    low_pass: LowPass = MARKER_FILTER,
) -> PressureScan:
    """Return one slip over the sensor as pressure against place under the shoe.

    The marker's path, filtered and interpolated to the sensor's samples, tells at each sample
    which place of the shoe is over the sensor. The baseline is the mean of the sensor before
    that place enters the shoe from the front; fewer than 100 such samples are flagged.

    ``sensor`` is in Pa; ``marker`` is fixed to the shoe; ``position`` (3,) is the sensor's place in
    lab axes (m); ``sliding`` (3,) the direction in which the shoe slides, by default the marker's
    own path. ``heel_back`` and ``heel_middle`` are the place of the heel's back ahead of, and of
    the heel's middle to the left of, the marker (m); from ``back`` to ``front`` of the heel's back
    the shoe is scanned (m). A sensor whose unit is no pressure, a lost marker and a shoe that never
    passes the sensor are DataErrors.
    """
    where = trial.name
    if sensor.unit != "Pa":
        raise DataError(
            Message('the pressure is in "{unit}"', unit=sensor.unit), where=where, allowed="Pa"
        )
    up = (axes or axes_of(trial)).up
    path, filled = bridge_gaps(marker.positions, round(0.1 * marker.rate))
    seen = np.asarray(np.isfinite(path).all(axis=1))
    if seen.sum() < 30 or not seen[np.flatnonzero(seen)[0] : np.flatnonzero(seen)[-1] + 1].all():
        raise DataError("the shoe's marker is lost during the slip", where=where)
    path = low_passed(path[seen], marker.rate, low_pass)
    time = marker.time[seen]
    if sliding is None:
        step = path[-1] - path[0]
        step = step - (step @ up) * up
        if np.linalg.norm(step) < 0.02:
            raise DataError("the shoe's marker hardly moves", where=where)
        sliding = step / np.linalg.norm(step)
    assert sliding is not None
    left = np.cross(up, sliding)
    place = np.asarray(position, dtype=float)
    ahead = (place - path) @ sliding - heel_back
    sideways = (place - path) @ left - heel_middle
    at = sensor.time
    inside = (at >= time[0]) & (at <= time[-1]) & np.isfinite(sensor.values)
    along = np.interp(at, time, ahead)
    velocity = -np.gradient(ahead, time)
    # Only the slide itself: not the way back of a tester that scans twice.
    moving = np.interp(at, time, velocity) > 0.02
    under = inside & (along <= front) & (along >= back) & moving
    if under.sum() < 5:
        raise DataError(
            "the shoe never passes the sensor",
            where=where,
            remedy="Check the sensor's position and the axes in the profile",
        )
    first = int(np.flatnonzero(under)[0])
    quiet = inside & (np.arange(len(at)) < first)
    flags: list[Message] = []
    if quiet.sum() < _BASELINE:
        flags.append(
            Message(
                "baseline of {count} samples before the shoe reaches the sensor",
                count=int(quiet.sum()),
            )
        )
    rest = sensor.values[quiet] if quiet.sum() >= 10 else np.zeros(1)
    baseline, deviation = float(rest.mean()), float(rest.std())
    if is_saturated(sensor.values, sensor.rate):
        flags.append(_SATURATED)
    if filled[seen].any():
        flags.append(
            Message("{count} frames of the marker were bridged", count=int(filled[seen].sum()))
        )
    speed = np.interp(at[under], time, velocity)
    pressure = sensor.values[under] - baseline
    mean_speed = float(speed.mean())
    change = float(np.ptp(speed) / mean_speed)
    if change > 0.2:
        flags.append(
            Message(
                "the speed varies by {change:.0f} %: Eq. 27 takes it as steady", change=100 * change
            )
        )
    if along[under].max() < front - 0.01 or along[under].min() > back + 0.01:
        flags.append(
            Message(
                "scanned from {low:.0f} to {high:.0f} mm only",
                low=1e3 * along[under].min(),
                high=1e3 * along[under].max(),
            )
        )
    line_load = float(np.sum(pressure * speed) / sensor.rate)
    lateral = float(np.interp(at[under], time, sideways).mean())
    numbers = lateral, mean_speed, change, deviation, line_load
    return PressureScan(where, along[under], pressure, *numbers, tuple(flags))


def pressure_map(
    scans: Sequence[PressureScan],
    *,
    spacing: float | None = None,
    inlet_diameter: float | None = None,
    step: float = 1e-3,
) -> PressureMap:
    """Return the scans joined by position, with the load carried by the fluid.

    NF_fluid = sum p dx v dt (Eq. 27): each pressure times the distance between scans and the
    displacement per sample. dx is ``spacing``, or each scan's share of the measured lateral
    places. Checks: the outermost scans' share of the load (what lies outside is not measured),
    and the change of the load when every second scan is left out (what the spacing could hide;
    bumps narrower than about 1.5 spacings can slip through).

    ``spacing`` is the distance between scans (m) if it is to be taken as set rather than as
    measured, ``step`` that of the map along the shoe (m). Averaging over the sensor's inlet, of
    ``inlet_diameter`` (m), lowers a peak by about (d^2 / 32) times the curvature, which is then
    estimated and said. Fewer than two scans, or two at one place, are a DataError.
    """
    if len(scans) < 2:
        raise DataError(
            Message("{count} scans are no map", count=len(scans)), allowed="two or more"
        )
    if (spacing is not None and not spacing > 0) or not step > 0:
        raise InputError("spacing and step must be positive", where="pressure_map")
    ordered = tuple(sorted(scans, key=lambda scan: scan.lateral))
    lateral = np.array([scan.lateral for scan in ordered])
    gaps = np.diff(lateral)
    if gaps.min() < 1e-4:
        raise DataError("two scans lie at the same place", remedy="Average repeats first")
    widths = np.full(len(lateral), spacing) if spacing else _widths(gaps)
    loads = np.array([scan.sample_load for scan in ordered])
    load = float(loads @ widths)
    noise = [
        scan.baseline_sd * scan.speed / _rate(scan) * np.sqrt(len(scan.pressure))
        for scan in ordered
    ]
    sensor_error = float(np.sqrt(np.sum((np.array(noise) * widths) ** 2)))
    outer = abs(loads[0] * widths[0]) + abs(loads[-1] * widths[-1])
    outer_share = float(outer / abs(load)) if load else 0.0
    change = _half_spacing(lateral, loads, load)
    told = [(scan.trial, flag) for scan in ordered for flag in scan.flags]
    flags = [Message("{trial}: {flag}", trial=trial, flag=flag) for trial, flag in told]
    peak_flags = [
        line for line, (_, flag) in zip(flags, told, strict=True) if flag.code == _SATURATED.code
    ]
    if load > 5 * sensor_error and outer_share > OUTER_SHARE:
        flags.append(
            Message(
                "the outermost scans carry {share:.0f} % of the load: pressure "
                "reaches beyond the scanned width",
                share=100 * outer_share,
            )
        )
    mean_gap = float(gaps.mean())
    if spacing and abs(mean_gap / spacing - 1.0) > 0.05:
        flags.append(
            Message(
                "scans lie {gap:.1f} mm apart, not {spacing:.1f} mm",
                gap=1e3 * mean_gap,
                spacing=1e3 * spacing,
            )
        )
    if gaps.max() > 1.5 * np.median(gaps):
        flags.append(
            Message("a gap of {gap:.0f} mm between scans: one may be missing", gap=1e3 * gaps.max())
        )
    choices = {
        "load": Message("sum of p dx v dt (Eq. 27), baseline subtracted"),
        "dx": Message("{spacing:g} mm, given", spacing=1e3 * spacing)
        if spacing
        else Message("from the measured lateral places"),
        "covered width": Message(
            "{width:.0f} mm between the outermost scans", width=1e3 * (lateral[-1] - lateral[0])
        ),
        "hidden": Message(
            "bumps narrower than about {width:.0f} mm can hide between scans",
            width=1e3 * NARROW * mean_gap,
        ),
        "uncertainty": Message(
            "sensor noise; scans left out and positions are judged by the flags"
        ),
    }
    if change is not None:
        choices["every second scan left out"] = Message(
            "changes the load by up to {change:.1f} %", change=100 * change
        )
    grid = np.arange(
        min(scan.along.min() for scan in ordered), max(s.along.max() for s in ordered), step
    )
    pressure = np.array([_on_grid(scan, grid, step) for scan in ordered])
    which = int(np.argmax([scan.pressure.max() for scan in ordered]))
    top = int(np.argmax(ordered[which].pressure))
    peak = float(ordered[which].pressure[top])
    deviation = ordered[which].baseline_sd
    if peak < 5 * deviation:
        peak_flags.append(Message("within the noise: below 5 standard deviations of the baseline"))
    if inlet_diameter:
        lost = _inlet_loss(pressure, which, grid, float(ordered[which].along[top]), inlet_diameter)
        if lost is not None:
            choices["inlet"] = Message(
                "{width:g} mm wide: lowers the peak by about {lost:.1f} kPa",
                width=1e3 * inlet_diameter,
                lost=lost / 1e3,
            )
    largest = Measurement(
        "peak fluid pressure", peak, "Pa", deviation, n=len(ordered),
        flags=tuple(map(remark_of, peak_flags)), conventions=choices,
    )  # fmt: skip
    whole = Measurement(
        "fluid load", load, "N", sensor_error, n=len(ordered), flags=tuple(map(remark_of, flags)),
        conventions=choices,
    )  # fmt: skip
    forward = float(ordered[which].along[top])
    at_along = Measurement("peak along", forward, "m", step, conventions=choices)
    even = {**choices, "uncertainty": Message("half a spacing, taken as evenly likely")}
    place, sd = float(lateral[which]), mean_gap / np.sqrt(12.0)
    at_lateral = Measurement("peak lateral", place, "m", sd, conventions=even)
    places = whole, largest, at_along, at_lateral
    return PressureMap(lateral, grid, pressure, *places, loads, outer_share, change, ordered)


def _widths(gaps: np.ndarray) -> np.ndarray:
    """Return each scan's share of the width; the outermost get a full gap, as Eq. 27 does."""
    padded = np.concatenate(([gaps[0]], gaps, [gaps[-1]]))
    return (padded[:-1] + padded[1:]) / 2.0


def _half_spacing(lateral: np.ndarray, loads: np.ndarray, load: float) -> float | None:
    if len(lateral) < 5 or load == 0:
        return None
    halves = slice(0, None, 2), slice(1, None, 2)
    kept = [loads[half] @ _widths(np.diff(lateral[half])) for half in halves]
    return float(np.max(np.abs(np.array(kept) / load - 1.0)))


def _rate(scan: PressureScan) -> float:
    """Samples per second of a scan, from its speed and the distance between its samples."""
    return scan.speed * (len(scan.along) - 1) / float(np.ptp(scan.along))


def _on_grid(scan: PressureScan, grid: np.ndarray, step: float) -> np.ndarray:
    order = np.argsort(scan.along)
    x, p = scan.along[order], scan.pressure[order]
    line = np.interp(grid, x, p)
    return np.where((grid < x[0] - step) | (grid > x[-1] + step), np.nan, line)


def _inlet_loss(
    pressure: np.ndarray, which: int, grid: np.ndarray, along: float, diameter: float
) -> float | None:
    """Return -(d^2 / 32) times the curvature along the shoe at the peak, twice (both ways)."""
    from scipy.signal import savgol_filter

    step = float(grid[1] - grid[0])
    line = pressure[which]
    window = 2 * round(0.5 * diameter / step) + 1
    if not np.isfinite(line).all() or window < 5 or len(line) <= window:
        return None
    curvature = savgol_filter(line, window, 2, deriv=2, delta=step)
    bend = float(curvature[int(np.argmin(np.abs(grid - along)))])
    return 2.0 * max(-bend, 0.0) * diameter**2 / 32.0
