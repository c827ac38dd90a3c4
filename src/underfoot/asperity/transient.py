"""Sliding of rough rubber over a rough rigid floor, marched in time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Cancelled, InputError, Progress, Status, silent

from ._kernels.threads import threads_limited
from .steady_checks import checked_contact_input
from .transient_march import March, MaxwellSpectrum


@dataclass(frozen=True, slots=True, eq=False)
class TransientSliding:
    """History of a sliding contact; arrays have one value per time step.

    Parameters
    ----------
    time, distance
        s and m since the start of sliding.
    pressure
        Mean contact pressure, Pa.
    shear
        Mean of pressure times floor slope, Pa: friction by hysteresis, positive against sliding;
        with a rough shoe it also swings elastically about its mean.
    real_contact_fraction, mean_gap
        Share of nodes in contact; m.
    period_cof
        Mean shear over mean pressure in each period of the floor.
    cof_hysteresis
        Of the last whole period; NaN when none was finished.
    contact_pressure, gap
        Last state, Pa and m, in the frame of the rubber.
    steady
        True when two periods running agreed within the tolerance asked for.
    status, notes
        How it ended.
    """

    time: np.ndarray
    distance: np.ndarray
    pressure: np.ndarray
    shear: np.ndarray
    real_contact_fraction: np.ndarray
    mean_gap: np.ndarray
    period_cof: np.ndarray
    cof_hysteresis: float
    contact_pressure: np.ndarray
    gap: np.ndarray
    steady: bool
    status: Status
    notes: tuple[str, ...]


def transient_sliding(
    floor_height: ArrayLike,
    spacing: float | tuple[float, float],
    modulus: MaxwellSpectrum,
    speed: float,
    *,
    pressure: float | None = None,
    separation: float | None = None,
    shoe_height: ArrayLike | None = None,
    poisson_ratio: float = 0.5,
    layer_thickness: float | None = None,
    start: str = "relaxed",
    steps_per_spacing: int = 2,
    max_periods: int = 8,
    steady_tolerance: float = 5e-3,
    tolerance: float = 1e-5,
    threads: int = 1,
    fft: str = "auto",
    progress: Progress = silent,
) -> TransientSliding:
    """Return the history of rough rubber sliding along +x over a rough floor.

    In the frame of the rubber the floor passes underneath. With E(t) = E0 [1 - sum g_i
    (1 - exp(-b_i t))] and a displacement linear within a step, each step is an elastic contact
    with modulus m E0 and a known displacement U: u = U + A p, gap = d + u - h_floor - h_shoe >= 0,
    p >= 0, p gap = 0. Exact in time for a displacement linear in time, second order otherwise, for
    any number of terms; terms much faster than a step act through E0.

    Parameters
    ----------
    floor_height, shoe_height
        m, (nx, ny), periodic, each positive out of its own body; None: smooth rubber.
    spacing
        m, one number or (along axis 0, along axis 1).
    modulus
        Generalised Maxwell material (Young's moduli).
    speed
        m/s, > 0.
    pressure, separation
        Exactly one: mean pressure (Pa, > 0) for a fixed load, or the distance of the mean planes
        of deformed rubber and floor (m) for a fixed height.
    poisson_ratio, layer_thickness
        As in ``steady_sliding``.
    start
        "relaxed" (long rest before sliding) or "fresh" (pressed on at the instant sliding starts).
    steps_per_spacing
        Time steps while the floor moves by one spacing; with 8 nodes to the shortest wave, 2 keep
        the COF within 2 %, 1 within 5 % (second order).
    max_periods
        Passages of the whole floor map at most.
    steady_tolerance
        The run ends when the COF of two periods running agrees to this, relative to the larger.
    tolerance
        On the contact of each step (penetration over rms height).
    threads, fft, progress
        As in ``steady_sliding``; ``Cancelled`` raised by progress ends the run early.

    Errors
    ------
    InputError
        As ``steady_sliding``; a material without relaxation terms; both or neither of pressure and
        separation; maps of different shape.

    Source: recursive convolution of Taylor, Pister and Goudreau (1970) Int. J. Numer. Methods Eng.
    2:45, with the half-space of Johnson (1985) Contact Mechanics, chapter 13.
    """
    if (pressure is None) == (separation is None):
        raise InputError(
            "give the pressure (fixed load) or the separation (fixed height), one of them",
            where="pressure, separation",
        )
    load = 1.0 if pressure is None else pressure
    floor, steps = checked_contact_input(
        floor_height, spacing, speed, load, poisson_ratio, layer_thickness
    )
    shoe = np.zeros_like(floor)
    if shoe_height is not None:
        shoe, _ = checked_contact_input(
            shoe_height, spacing, speed, load, poisson_ratio, layer_thickness
        )
    if shoe.shape != floor.shape:
        raise InputError(
            f"shoe map {shoe.shape} on floor map {floor.shape}",
            where="shoe_height",
            allowed="the same shape and spacing",
        )
    _check_choices(modulus, speed, start, steps_per_spacing, max_periods)
    with threads_limited(threads):
        march = March(
            floor - floor.mean(),
            shoe - shoe.mean(),
            steps,
            modulus,
            abs(speed),
            poisson_ratio,
            layer_thickness,
            steps[0] / (speed * steps_per_spacing),
            tolerance,
            threads,
            fft,
        )
        return _run(
            march,
            pressure,
            separation,
            start,
            floor.shape[0] * steps_per_spacing,
            max_periods,
            steady_tolerance,
            progress,
        )


def _run(
    march: March,
    pressure: float | None,
    separation: float | None,
    start: str,
    period: int,
    max_periods: int,
    steady_tolerance: float,
    progress: Progress,
) -> TransientSliding:
    rows: list[tuple[float, float, float, float, float, float]] = []
    cofs: list[float] = []
    status, steady = Status.CONVERGED, False
    notes: list[str] = []
    state = march.rest(pressure, separation, start)
    total = period * max_periods
    pixel = march.speed * march.time_step
    try:
        for n in range(1, total + 1):
            progress("transient sliding", n / total, None)
            guess = np.maximum(np.asarray(state.pressure, dtype=np.float32), 0.0)
            # the floor moves towards -x in the frame of the rubber
            guess = np.maximum(guess, 0.5 * np.roll(guess, -1, axis=0))
            state = march.step(n * pixel, guess, pressure, separation)
            p = np.asarray(state.pressure, dtype=float) * march.unit
            slope = march.floor.slope_at(n * pixel) * march.rms
            gap = np.where(p > 0.0, 0.0, np.maximum(state.gap, 0.0)) * march.rms
            rows.append(
                (
                    n * march.time_step,
                    n * pixel,
                    float(p.mean()),
                    float((p * slope).mean()),
                    float(np.count_nonzero(p > 0.0)) / p.size,
                    float(gap.mean()),
                )
            )
            if n % period == 0:
                last = np.array(rows[-period:])
                normal = float(last[:, 2].mean())
                cofs.append(float(last[:, 3].mean()) / normal if normal > 0.0 else float("nan"))
                steady = len(cofs) > 1 and _agree(cofs[-1], cofs[-2], steady_tolerance)
                if steady:
                    break
    except Cancelled:
        status = Status.CANCELLED
        notes.append(f"cancelled after {len(rows)} steps")
    if march.failures:
        status = Status.NOT_CONVERGED
        notes.append(f"{march.failures} of {len(rows)} contact steps did not reach the tolerance")
    elif status is Status.CONVERGED and not steady:
        status = Status.NOT_CONVERGED
        notes.append(
            f"not steady after {max_periods} periods: slow relaxation terms are still running; "
            "raise max_periods or leave out terms slower than the run"
        )
    history = np.array(rows).reshape(-1, 6).T
    p = np.maximum(np.asarray(state.pressure, dtype=float), 0.0) * march.unit
    return TransientSliding(
        *history,
        period_cof=np.array(cofs),
        cof_hysteresis=cofs[-1] if cofs else float("nan"),
        contact_pressure=p,
        gap=np.where(p > 0.0, 0.0, np.maximum(state.gap, 0.0)) * march.rms,
        steady=steady,
        status=status,
        notes=tuple(notes),
    )


def _agree(one: float, other: float, tolerance: float) -> bool:
    return abs(one - other) <= tolerance * max(abs(one), abs(other), 1e-9)


def _check_choices(
    modulus: Any, speed: float, start: str, steps_per_spacing: int, max_periods: int
) -> None:
    for name in ("equilibrium_modulus", "term_moduli", "relaxation_times"):
        if not hasattr(modulus, name):
            raise InputError(
                f"modulus is a {type(modulus).__name__} without {name}",
                where="modulus",
                allowed="a generalised Maxwell material, such as material.RelaxationSpectrum",
                remedy="A march in time needs relaxation terms; steady_sliding takes any E*",
            )
    if not modulus.equilibrium_modulus > 0.0:
        raise InputError(
            f"equilibrium modulus {modulus.equilibrium_modulus} Pa",
            where="modulus",
            allowed="above 0 Pa: a liquid can't carry the mean pressure",
        )
    if not speed > 0.0:
        raise InputError(f"speed {speed} m/s", where="speed", allowed="above 0 m/s")
    if start not in ("relaxed", "fresh"):
        raise InputError(f'start "{start}"', where="start", allowed='"relaxed" or "fresh"')
    for name, value in (("steps_per_spacing", steps_per_spacing), ("max_periods", max_periods)):
        if value < 1:
            raise InputError(f"{name} {value}", where=name, allowed="1 or more")
