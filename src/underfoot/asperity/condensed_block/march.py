"""Pressing and sliding of a condensed block over a rough rigid floor, marched in time."""

from __future__ import annotations

import time as clock

import numpy as np

from underfoot.asperity._kernels.threads import threads_limited
from underfoot.asperity.finite_element import (
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroResult,
    MicroSurface,
)
from underfoot.asperity.finite_element.mesh import check_pattern
from underfoot.core import InputError, Progress, silent

from .compliance import CondensedBlock, condensed_block
from .moduli import condensed_poisson_ratio, pressure_ratio_of
from .pressed import pressed_block
from .stepping import CondensedMarch, Moment

PRESS_STEPS = 16
HOLD_STEPS = 8


def condensed_sliding(
    block: MicroBlock | CondensedBlock,
    floor: MicroSurface,
    material: MicroMaterial,
    loading: MicroLoading,
    *,
    steps_per_wavelength: int = 64,
    finite_strain: bool = False,
    progress: Progress = silent,
) -> MicroResult:
    """Return the history of a block pressed on a rough rigid floor and slid along +x.

    Small strains (about the pressed block's finite ones with ``finite_strain``), no inertia, no
    friction between the faces. With G(t) = G0 [1 - sum g_i
    (1 - exp(-b_i t))] and displacements u linear within a step, each step is an elastic contact
    of modulus m G0 with a known displacement U: gap = height + z + U + C f - h_floor >= 0,
    f >= 0, f gap = 0 at every lower node; exact for any number of terms. Bulk and shear relax
    together (nu constant): right for nearly incompressible rubber. Shear force is
    sum f dh/dx, the horizontal part of forces normal to the floor.

    Parameters
    ----------
    block
        A block, or one condensed before (``condensed_block``, ``pressed_block``) to use its
        compliance again; with its ``sideways`` motion, contact is where the nodes have gone and
        normal to the floor there.
    floor
        Heights of the rigid floor.
    material
        Shear spectrum; Poisson's ratio follows from K and the relaxed shear modulus
        (``condensed_poisson_ratio``).
    loading
        Pressed under a load that grows linearly for ``press_time``, held for ``hold_time``, then
        slid at the height reached (control "displacement") or under the load.
    steps_per_wavelength
        Time steps while the floor moves by one wavelength.
    finite_strain
        Of a block not yet condensed: take ``pressed_block`` at ``pressure_ratio_of`` instead of the
        block at rest. Ten times the cost.
    progress
        A ``Cancelled`` that it raises ends the run with what there is.

    Errors
    ------
    InputError
        A floor whose wavelength the block can't hold or its elements can't follow; Poisson's
        ratio of 0.5; fewer than 16 steps a wavelength; a speed of 0 with a distance to slide.
    """
    nu = condensed_poisson_ratio(material)
    outline = block.block if isinstance(block, CondensedBlock) else block
    check_pattern(outline, floor, "floor")
    if steps_per_wavelength < 16:
        raise InputError(
            f"{steps_per_wavelength}", where="steps_per_wavelength", allowed="16 or more"
        )
    if loading.slide_distance > 0.0 and not loading.speed > 0.0:
        raise InputError(
            f"{loading.speed:g} m/s with {loading.slide_distance:g} m to slide",
            where="MicroLoading.speed",
            allowed="above 0",
            remedy="Choose slide_distance = 0 to press only",
        )
    started = clock.process_time()
    with threads_limited(1):
        if isinstance(block, MicroBlock):
            if finite_strain:
                ratio = pressure_ratio_of(material, loading)
                block = pressed_block(block, nu, ratio, progress=progress)
            else:
                block = condensed_block(block, nu, progress=progress)
        elif abs(block.poisson_ratio - nu) > 1e-6:
            raise InputError(
                f"condensed for Poisson's ratio {block.poisson_ratio:.6g}, the material has "
                f"{nu:.6g}",
                where="block",
                remedy="Condense the block for this material",
            )
        moments = _schedule(loading, floor, outline, steps_per_wavelength)
        return CondensedMarch(block, material, floor).run(moments, loading, started, progress)


def _schedule(
    loading: MicroLoading, floor: MicroSurface, block: MicroBlock, per_wavelength: int
) -> list[Moment]:
    full = loading.mean_pressure * block.nominal_area
    moments = [
        Moment(loading.press_time / PRESS_STEPS, 0.0, full * n / PRESS_STEPS)
        for n in range(1, PRESS_STEPS + 1)
    ]
    if loading.hold_time > 0.0:
        moments += [Moment(loading.hold_time / HOLD_STEPS, 0.0, full)] * HOLD_STEPS
    if loading.slide_distance == 0.0:
        return moments
    length = floor.wavelength if floor.rough else loading.slide_distance
    pixel = length / per_wavelength
    load = full if loading.control == "load" else None
    # from rest to the speed at constant acceleration, in steps of one pixel or less
    ramp_length = 0.5 * loading.speed * loading.ramp_time
    distance = 0.0
    while distance < loading.slide_distance * (1.0 - 1e-9):
        following = min(distance + pixel, loading.slide_distance)
        step = _time_at(following, loading, ramp_length) - _time_at(distance, loading, ramp_length)
        moments.append(Moment(step, following, load))
        distance = following
    return moments


def _time_at(distance: float, loading: MicroLoading, ramp_length: float) -> float:
    """Return the time since sliding began at which ``distance`` is reached."""
    if distance >= ramp_length:
        return loading.ramp_time + (distance - ramp_length) / loading.speed
    return float(np.sqrt(2.0 * distance * loading.ramp_time / loading.speed))
