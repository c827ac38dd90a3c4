"""Steady sliding of a smooth viscoelastic half-space or layer over a rough rigid surface."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, Progress, Status, display, silent
from underfoot.core.arrays import Array
from underfoot.core.device import free_memory, to_card
from underfoot.core.fourier import transform
from underfoot.core.presentation import Presentable, Table
from underfoot.core.status import worst
from underfoot.core.threads import converter, namespace, on_host, threads_limited

from ._kernels import periodic
from ._kernels.complementarity import ContactState
from ._kernels.nested import solve_nested
from ._kernels.operators import ElasticBody
from .sliding_input import (
    Modulus,
    SlowTransform,
    batch_size,
    check_load,
    checked_contact_input,
    loss_reason,
    modulus_function,
    resolution_breaches,
    slow_transform,
)


@dataclass(frozen=True, slots=True)
class SlidingSettings:
    """How ``steady_sliding`` solves: numbers that change cost and error, not the physics.

    ``tolerance`` is that on ``complementarity_error``, ``max_iterations`` the active-set steps on
    the full grid before the result is marked as not converged, ``threads`` those of the Fourier
    transforms and matrix products (everything else runs on one), ``fft`` "mkl" (Intel's library,
    used when installed), "scipy" or "auto".
    """

    tolerance: float = 1e-6
    max_iterations: int = 60
    threads: int = 1
    fft: str = "auto"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SteadySliding(Presentable):
    """Steady contact under sliding.

    ``pressure`` (Pa, with the mean ``nominal_pressure``) and ``gap`` (m) are maps (nx, ny); the
    ``mean_gap`` counts contact as zero; ``speed`` in m/s. ``real_contact_fraction`` is the share of
    nodes in contact; corrected, the grid's staircase is taken off the edge of every spot (Yastrebov
    et al. 2017): closer to the continuous surface on a coarse grid. ``cof_hysteresis`` is the
    energy lost in the material per sliding distance and normal load, ``cof_slope`` the mean of
    pressure times slope over the mean pressure: the same number on a fine grid. ``rms_slope`` is
    that of the surface over all directions.

    ``full_contact``: the surfaces touch everywhere (closed form, no iteration). ``iterations``
    counts active-set steps, ``operator_applications`` FFT products (forward and back; a product on
    a coarser grid counts by its share of the points). ``complementarity_error`` is the largest of
    the deepest penetration and the pressure-weighted mean |gap|, both over the rms height, and the
    relative error of the load, before the last projection onto p, gap >= 0; ``history`` holds it
    after each iteration on the full grid. ``status`` and ``notes`` tell how it ended and what a
    reader must know, ``breaches`` the ranges that were left (a slope too steep, a grid too coarse),
    ``negligible_loss`` why the hysteresis is negligible where the material hardly loses energy at
    the frequencies of this surface and speed ("" otherwise), ``slow_transform`` that another size
    of the grid would be faster (None otherwise).
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
    rms_slope: float
    full_contact: bool
    iterations: int
    operator_applications: float
    complementarity_error: float
    history: tuple[float, ...]
    status: Status
    notes: tuple[str, ...]
    breaches: tuple[Breach, ...]
    negligible_loss: str = ""
    slow_transform: SlowTransform | None = None

    def table(self) -> Table:
        """Return the averages of the contact."""
        return Table(
            f"Steady sliding at {display(self.nominal_pressure, 'Pa')}, "
            f"{display(self.speed, 'm/s')} ({self.status})",
            ("quantity", "value", "unit"),
            [
                (
                    "real contact fraction (edges of spots corrected)",
                    self.real_contact_fraction_corrected,
                    "1",
                ),
                ("hysteresis COF", self.cof_hysteresis, "1"),
                ("mean gap", self.mean_gap, "m"),
                ("rms slope of the surface", self.rms_slope, "1"),
                ("complementarity error", self.complementarity_error, "1"),
            ],
        )

    def __repr__(self) -> str:
        return (
            f"SteadySliding({display(self.nominal_pressure, 'Pa')}, {display(self.speed, 'm/s')}: "
            f"contact {self.real_contact_fraction_corrected:.3g}, hysteresis COF "
            f"{self.cof_hysteresis:.3g}, gap {display(self.mean_gap, 'm')}, {self.status})"
        )


def steady_sliding(
    height: ArrayLike,
    spacing: float | tuple[float, float],
    modulus: Modulus,
    speed: float,
    pressure: float,
    poisson_ratio: float = 0.5,
    *,
    layer_thickness: float | None = None,
    settings: SlidingSettings | None = None,
    progress: Progress = silent,
) -> SteadySliding:
    """Return the steady contact of smooth rubber sliding along axis 0 over a rough rigid surface.

    In the frame of the surface the rubber answers each wave with its complex modulus,
    u(q) = 2 (1 - nu^2) p(q) / (|q| E*(q_x v)), so that p >= 0, gap = d + u - h >= 0, p gap = 0 and
    mean p = ``pressure`` hold the whole history of any relaxation spectrum: no time march.

    Parameters:
        height: m, (nx, ny), positive towards the rubber, periodic; axis 0 along sliding.
        spacing: m, one number or (along axis 0, along axis 1).
        modulus: Young's modulus of the rubber: an object with ``complex_modulus``, a callable
            E*(angular frequency, rad/s >= 0) in Pa with positive real part and loss E'' >= 0, or a
            number (elastic).
        speed: m/s, of the rubber relative to the surface; 0 is the elastic contact of the relaxed
            rubber, a negative one slides towards -x and gives a negative COF.
        pressure: Mean contact pressure, Pa, > 0.
        poisson_ratio: Constant in time, 0 to 0.5.
        layer_thickness: m, of a layer bonded to a rigid base; None: half-space.
        settings: Tolerance, iterations, threads, Fourier transforms.
        progress: Receives the stage, the fraction done and the error; may raise ``Cancelled``.

    Validity: small slopes (tested below an rms slope of 0.5, assumed), smooth rubber, no
    adhesion, no friction at the spots themselves, inertia negligible (speed far below the shear
    wave speed).

    Raises:
        InputError: Heights missing or not a map, or more than fit into the memory where they lie,
            pressure, spacing or modulus not positive, speed not finite.

    Source: frame of the rough surface and complex modulus, e.g. Carbone and Putignano (2013)
    J. Mech. Phys. Solids 61:1822; active set of Hintermueller, Ito and Kunisch (2002) SIAM J.
    Optim. 13:865.
    """
    given = spacing, modulus, [(pressure, speed)], poisson_ratio
    options = {"layer_thickness": layer_thickness, "settings": settings, "progress": progress}
    (contact,) = contacts_of(height, *given, **options)
    return contact


def contacts_of(
    height: ArrayLike,
    spacing: float | tuple[float, float],
    modulus: Modulus,
    loads: Sequence[tuple[float, float]],
    poisson_ratio: float = 0.5,
    *,
    layer_thickness: float | None = None,
    settings: SlidingSettings | None = None,
    progress: Progress = silent,
) -> list[SteadySliding]:
    """Return ``steady_sliding`` of one surface at each (pressure, speed), in one batch.

    A graphics card computes a batch of small grids in hardly more time than one of them; a
    processor takes twice as long as one by one. Each contact is solved to the same tolerance as
    alone; ``operator_applications`` are the products of the batch while it was part of it.

    Parameters:
        height, spacing, modulus, poisson_ratio, layer_thickness: As in ``steady_sliding``.
        loads: (pressure, Pa; speed, m/s) of each contact.
        settings, progress: As in ``steady_sliding``; the error is the largest of the batch.

    Raises:
        InputError: As ``steady_sliding``; more contacts than fit into the memory at once.
    """
    settings = settings or SlidingSettings()
    tolerance, threads, fft = settings.tolerance, settings.threads, settings.fft
    if len(loads) == 0:
        return []
    (pressure, speed), *others = loads
    h, steps = checked_contact_input(
        height, spacing, speed, pressure, poisson_ratio, layer_thickness, len(loads)
    )
    for load in others:
        check_load(*load)
    shape: tuple[int, int] = tuple(h.shape)
    xp = namespace(h)
    qx, qy = periodic.wavenumbers(shape, steps)
    length = shape[0] * steps[0]
    asarray = converter(h)
    odd = asarray(periodic.odd_wavenumbers(shape, steps))
    wave = np.arange(shape[0] // 2 + 1)
    frequencies = [2.0 * math.pi / length * abs(speed) * wave for _, speed in loads]
    youngs = [modulus_function(modulus, w) for w in frequencies]
    moduli = [young(w) for young, w in zip(youngs, frequencies, strict=True)]
    body = ElasticBody(
        lambda qx: np.stack(
            [
                periodic.sliding_moduli(table, length, speed > 0.0, qx)
                for table, (_, speed) in zip(moduli, loads, strict=True)
            ]
        ),
        partial(periodic.unit_compliance, thickness=layer_thickness, poisson_ratio=poisson_ratio),
        steps,
        xp=xp,
        asarray=asarray,
        threads=threads,
        library=fft,
    )
    with threads_limited(threads):
        exact = transform((1, *shape), xp.float64, xp=xp, threads=threads, library=fft)
        slope, short = periodic.slope_numbers(
            exact.forward(h[None, ...]),
            asarray(qx) ** 2 + asarray(qy) ** 2,
            shape,
            0.5 * math.pi / max(steps),
        )
        if slope == 0.0:
            return [_flat(h, float(pressure), float(speed), xp) for pressure, speed in loads]
        rms = float(xp.std(h))
        units = [
            0.5 * slope * abs(complex(young(np.asarray([slope / rms * abs(speed)]))[0]))
            for young, (_, speed) in zip(youngs, loads, strict=True)
        ]
        units = [unit / (1.0 - poisson_ratio**2) for unit in units]
        states, operators, cost = solve_nested(
            ((h - xp.mean(h)) / rms)[None, ...],
            replace(body, scale=np.array(units) / rms),
            [pressure / unit for (pressure, _), unit in zip(loads, units, strict=True)],
            exact=exact,
            tolerance=tolerance,
            max_steps=settings.max_iterations,
            report=lambda error: progress("rough contact", _fraction_done(error, tolerance), error),
        )
        contacts = []
        for n, (pressure, speed) in enumerate(loads):
            state, one = states.pop(0), operators.of([n])
            p, gap = _physical(state, units[n], rms, float(pressure), xp)
            transformed = exact.forward(p[None, ...])
            on_slope = periodic.work_against_slope(
                transformed, exact.forward(h[None, ...]), odd, shape
            )
            lost = 0.0
            if np.any(moduli[n].imag):
                lost = periodic.dissipation(transformed, one.unit(), one.rows, odd, shape)
                lost *= rms / units[n]
            del transformed
            plain, corrected = periodic.contact_fractions(p > 0.0, steps, xp)
            touching = int(xp.sum(xp.astype(p > 0.0, xp.int64)))
            out_of_range = tuple(resolution_breaches(slope, short, touching))
            status = Status.CONVERGED if state.converged else Status.NOT_CONVERGED
            contact = SteadySliding(
                pressure=p,
                gap=gap,
                nominal_pressure=float(pressure),
                speed=float(speed),
                mean_gap=float(xp.mean(gap)),
                real_contact_fraction=plain,
                real_contact_fraction_corrected=corrected,
                cof_hysteresis=lost / pressure,
                cof_slope=on_slope / pressure,
                rms_slope=slope,
                full_contact=state.full,
                iterations=state.steps,
                operator_applications=cost[n],
                complementarity_error=state.error,
                history=tuple(state.history),
                status=worst(status, Status.OUT_OF_RANGE) if out_of_range else status,
                notes=(),
                breaches=out_of_range,
                negligible_loss=loss_reason(moduli[n], frequencies[n]),
                slow_transform=slow_transform(shape),
            )
            contacts.append(
                replace(contact, notes=tuple(_notes(contact, state.converged, tolerance)))
            )
    return contacts


def _notes(contact: SteadySliding, converged: bool, tolerance: float) -> list[str]:
    """Return what a reader must know of a contact."""
    notes = []
    if contact.full_contact:
        notes.append(
            "the pressure closes the surface everywhere: full contact, solved in closed form"
        )
    if contact.speed == 0.0:
        notes.append("speed 0: elastic contact of the relaxed rubber")
    elif contact.negligible_loss:
        notes.append(contact.negligible_loss)
    if contact.slow_transform is not None:
        notes.append(str(contact.slow_transform))
    if not converged:
        notes.append(
            f"stopped after {contact.iterations} iterations at an error of "
            f"{contact.complementarity_error:.1e} (asked for {tolerance:.1e}): the numbers are not "
            "a result"
        )
    return notes


def contacts_on_card(
    height: Array,
    spacing: float | tuple[float, float],
    modulus: Modulus,
    loads: Sequence[tuple[float, float]],
    *given: Any,
    **settings: Any,
) -> Iterator[SteadySliding]:
    """Yield ``contacts_of`` heights (nx, ny) of NumPy on the graphics card, with maps of NumPy.

    A batch is as large as fills the card and fits into its memory.

    Raises:
        InputError: As ``steady_sliding``.
    """
    there = to_card(height)
    size = batch_size(math.prod(there.shape), free_memory(there))
    for n in range(0, len(loads), size):
        for contact in contacts_of(
            there, spacing, modulus, loads[n : n + size], *given, **settings
        ):
            yield replace(contact, pressure=on_host(contact.pressure), gap=on_host(contact.gap))


def _physical(
    state: ContactState, unit: float, rms: float, mean: float, xp: Any
) -> tuple[Any, Any]:
    """Return pressure and gap in SI: both >= 0, one of them 0 everywhere, the mean exact."""
    p = xp.astype(state.pressure[0, ...], xp.float64)
    p = xp.where(p > 0.0, p, xp.zeros_like(p))
    p *= mean / float(xp.mean(p))
    gap = xp.astype(state.gap[0, ...], xp.float64)
    gap = xp.where((gap > 0.0) & (p == 0.0), gap * rms, xp.zeros_like(gap))
    return p, gap


def _flat(height: Any, pressure: float, speed: float, xp: Any) -> SteadySliding:
    return SteadySliding(
        pressure=xp.zeros_like(height) + pressure,
        gap=xp.zeros_like(height),
        nominal_pressure=pressure,
        speed=speed,
        mean_gap=0.0,
        real_contact_fraction=1.0,
        real_contact_fraction_corrected=1.0,
        cof_hysteresis=0.0,
        cof_slope=0.0,
        rms_slope=0.0,
        full_contact=True,
        iterations=0,
        operator_applications=0.0,
        complementarity_error=0.0,
        history=(),
        status=Status.CONVERGED,
        notes=("the surface is flat: full contact, no deformation, no hysteresis",),
        breaches=(),
    )


def _fraction_done(error: float, tolerance: float) -> float:
    """Return the fraction done on a logarithmic scale from an error of 1."""
    return min(1.0, max(0.0, math.log(max(error, 1e-300)) / math.log(tolerance)))
