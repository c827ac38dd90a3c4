"""Steady sliding of a smooth viscoelastic half-space or layer over a rough rigid surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, Progress, Status, silent

from ._kernels.active_set import solve_contact
from ._kernels.area import contact_fractions
from ._kernels.symbols import odd_wavenumbers, sliding_moduli, unit_compliance, wavenumbers
from ._kernels.transforms import RealTransform
from .steady_checks import (
    Modulus,
    checked_contact_input,
    loss_reason,
    modulus_function,
    resolution_breaches,
)


@dataclass(frozen=True, slots=True, eq=False)
class SteadySliding:
    """Steady contact under sliding.

    Parameters
    ----------
    pressure
        Contact pressure, Pa, (nx, ny); its mean is the nominal pressure.
    gap
        Distance between the surfaces, m, (nx, ny).
    nominal_pressure, speed
        Pa and m/s, as given.
    mean_gap
        m, contact counted as zero.
    real_contact_fraction
        Share of the nodes in contact.
    real_contact_fraction_corrected
        The same with the grid's staircase taken off the edge of every spot (Yastrebov et al.
        2017): closer to the continuous surface on a coarse grid.
    cof_hysteresis
        Energy lost in the material per sliding distance and normal load.
    cof_slope
        Mean of pressure times slope over the mean pressure: the same number on a fine grid.
    full_contact
        True when the surfaces touch everywhere (closed form, no iteration).
    iterations, operator_applications
        Active-set steps, and FFT products (forward and back; a product on a coarser grid counts by
        its share of the points).
    complementarity_error
        Larger of the deepest penetration and the pressure-weighted mean |gap|, over rms height.
    history
        That error after each iteration on the full grid.
    status, notes
        How it ended, and what a reader must know (why the friction is zero, what was assumed).
    breaches
        Ranges that were left, such as a slope too steep or a grid too coarse.
    """

    pressure: np.ndarray
    gap: np.ndarray
    nominal_pressure: float
    speed: float
    mean_gap: float
    real_contact_fraction: float
    real_contact_fraction_corrected: float
    cof_hysteresis: float
    cof_slope: float
    full_contact: bool
    iterations: int
    operator_applications: float
    complementarity_error: float
    history: tuple[float, ...]
    status: Status
    notes: tuple[str, ...]
    breaches: tuple[Breach, ...]


def steady_sliding(
    height: ArrayLike,
    spacing: float | tuple[float, float],
    modulus: Modulus,
    speed: float,
    pressure: float,
    poisson_ratio: float = 0.5,
    *,
    layer_thickness: float | None = None,
    tolerance: float = 1e-6,
    max_iterations: int = 200,
    threads: int = 1,
    progress: Progress = silent,
) -> SteadySliding:
    """Return the steady contact of smooth rubber sliding along axis 0 over a rough rigid surface.

    In the frame of the surface the rubber answers each wave with its complex modulus,
    u(q) = 2 (1 - nu^2) p(q) / (|q| E*(q_x v)), so that p >= 0, gap = d + u - h >= 0, p gap = 0 and
    mean p = ``pressure`` hold the whole history of any relaxation spectrum: no time march.

    Parameters
    ----------
    height
        m, (nx, ny), positive towards the rubber, periodic; axis 0 along sliding.
    spacing
        m, one number or (along axis 0, along axis 1).
    modulus
        Young's modulus of the rubber: an object with ``complex_modulus``, a callable E*(angular
        frequency, rad/s >= 0) in Pa with positive real part and loss E'' >= 0, or a number
        (elastic).
    speed
        m/s, of the rubber relative to the surface; 0 is the elastic contact of the relaxed
        rubber, a negative one slides towards -x and gives a negative COF.
    pressure
        Mean contact pressure, Pa, > 0.
    poisson_ratio
        Constant in time, 0 to 0.5.
    layer_thickness
        m, of a layer bonded to a rigid base; None: half-space.
    tolerance
        On ``complementarity_error``.
    max_iterations
        Active-set steps on the full grid before the result is marked as not converged.
    threads
        Of the Fourier transforms.
    progress
        Receives the stage, the fraction done and the error; may raise ``Cancelled``.

    Validity: small slopes (tested below an rms slope of 0.5, assumed), smooth rubber, no
    adhesion, no friction at the spots themselves, inertia negligible (speed far below the shear
    wave speed).

    Errors
    ------
    InputError
        Heights missing or not a map, pressure, spacing or modulus not positive, speed not finite.

    Source: frame of the rough surface and complex modulus, e.g. Carbone and Putignano (2013)
    J. Mech. Phys. Solids 61:1822; active set of Hintermueller, Ito and Kunisch (2002) SIAM J.
    Optim. 13:865.
    """
    h, steps = checked_contact_input(
        height, spacing, speed, pressure, poisson_ratio, layer_thickness
    )
    qx, qy = wavenumbers(h.shape, steps)
    young = modulus_function(modulus, np.unique(np.abs(qx * speed)))
    rms = float(h.std())
    notes: list[str] = []
    moduli = sliding_moduli(young, speed, qx)
    compliance: Any = unit_compliance(np.hypot(qx, qy), layer_thickness, poisson_ratio) / moduli
    if speed == 0.0 or not np.any(moduli.imag):
        compliance = compliance.real
    compliance[0, 0] = 1.0
    stiffness = 1.0 / compliance
    compliance[0, 0] = stiffness[0, 0] = 0.0
    transform = RealTransform(h.shape, threads)
    if rms == 0.0:
        p = np.full(h.shape, float(pressure))
        notes.append("the surface is flat: full contact, no deformation, no hysteresis")
        solved = None
        gap = np.zeros(h.shape)
    else:
        unit = float(np.std(transform.apply(stiffness, h)))
        solved = solve_contact(
            (h - h.mean()) / rms,
            compliance * (unit / rms),
            stiffness * (rms / unit),
            pressure / unit,
            transform,
            tolerance=tolerance,
            max_iterations=max_iterations,
            report=lambda error: progress(
                "rough contact", min(1.0, max(0.0, np.log10(error) / np.log10(tolerance))), error
            ),
        )
        p, gap = solved.pressure * unit, solved.gap * rms
    full = solved is None or solved.iterations == 0
    converged = solved is None or solved.converged
    if full and rms:
        notes.append(
            "the pressure closes the surface everywhere: full contact, solved in closed form"
        )
    spectrum = transform.forward(p)
    lost = _dissipation(spectrum, compliance, odd_wavenumbers(h.shape, steps), h.shape)
    slope = transform.backward(1j * odd_wavenumbers(h.shape, steps) * transform.forward(h))
    plain, corrected = contact_fractions(p > 0.0, steps)
    if speed == 0.0:
        notes.append("speed 0: elastic contact of the relaxed rubber")
    else:
        notes.extend(loss_reason(young, np.abs(qx * speed)))
    if not converged:
        notes.append(
            f"stopped after {max_iterations} iterations at an error of {solved.error:.1e} "  # type: ignore[union-attr]  # solved is set when not converged
            f"(asked for {tolerance:.1e})"
        )
    found = tuple(resolution_breaches(h, steps, transform))
    status = Status.CONVERGED if converged else Status.NOT_CONVERGED
    if converged and found:
        status = Status.OUT_OF_RANGE
    return SteadySliding(
        pressure=p,
        gap=gap,
        nominal_pressure=float(pressure),
        speed=float(speed),
        mean_gap=float(gap.mean()),
        real_contact_fraction=plain,
        real_contact_fraction_corrected=corrected,
        cof_hysteresis=lost / pressure,
        cof_slope=float((p * slope).mean()) / pressure,
        full_contact=full,
        iterations=0 if solved is None else solved.iterations,
        operator_applications=0 if solved is None else solved.operator_applications,
        complementarity_error=0.0 if solved is None else solved.error,
        history=() if solved is None else tuple(solved.history),
        status=status,
        notes=tuple(notes),
        breaches=found,
    )


def _dissipation(spectrum: Any, compliance: Any, qx: Any, shape: tuple[int, int]) -> float:
    """Return <p du/dx>, the energy lost per area and sliding distance (Pa)."""
    loss = -qx * np.imag(compliance) * (spectrum.real**2 + spectrum.imag**2)
    total = 2.0 * float(loss.sum()) - float(loss[:, 0].sum())
    if shape[1] % 2 == 0:
        total -= float(loss[:, -1].sum())
    return total / (shape[0] * shape[1]) ** 2
