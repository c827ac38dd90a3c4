"""Pressing and sliding of a condensed block over a rough rigid floor, without inertia."""

from __future__ import annotations

import math
import time as clock
from typing import Any, NamedTuple

import numpy as np

from underfoot.core import Cancelled, InputError, Progress, Status, silent
from underfoot.core.threads import threads_limited

from ._kernels.active_set import NodalContact, contact_at_height, contact_under_load
from .compliance import CondensedBlock, condensed_block, pressed_block
from .inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from .mesh import check_pattern
from .prony_march import (
    PronyStep,
    advance_memory,
    known_displacement,
    prony_step,
)
from .result import MicroResult, edge_excess_area, resolution_note, whole_wavelength_averages

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

    Parameters:
        block: A block, or one condensed before (``condensed_block``, ``pressed_block``) to use its
            compliance again; with its ``sideways`` motion, contact is where the nodes have gone and
            normal to the floor there.
        floor: Heights of the rigid floor.
        material: Shear spectrum; Poisson's ratio follows from K and the relaxed shear modulus
            (``condensed_poisson_ratio``).
        loading: Pressed under a load that grows linearly for ``press_time``, held for
            ``hold_time``, then slid at the height reached (control "displacement") or under the
            load.
        steps_per_wavelength: Time steps while the floor moves by one wavelength.
        finite_strain: Of a block not yet condensed: take ``pressed_block`` at ``pressure_ratio_of``
            instead of the block at rest. Ten times the cost.
        progress: A ``Cancelled`` that it raises ends the run with what there is.

    Raises:
        InputError: A floor whose wavelength the block can't hold or its elements can't follow;
            Poisson's ratio of 0.5; fewer than 16 steps a wavelength; a speed of 0 with a distance
            to slide.
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
    slid = loading.slide_distance
    places = np.minimum(pixel * np.arange(1, math.ceil(slid / pixel * (1.0 - 1e-9)) + 1), slid)
    # from rest to the speed at constant acceleration, in steps of one pixel or less
    ramp_length = 0.5 * loading.speed * loading.ramp_time
    times = np.where(
        places >= ramp_length,
        loading.ramp_time + (places - ramp_length) / loading.speed,
        np.sqrt(2.0 * places * loading.ramp_time / loading.speed),
    )
    steps = np.diff(times, prepend=0.0).tolist()
    return moments + [Moment(s, x, load) for s, x in zip(steps, places.tolist(), strict=True)]


def pressure_ratio_of(material: MicroMaterial, loading: MicroLoading) -> float:
    """Return mean pressure over the shear modulus that answers it at the end of pressing."""
    since = loading.press_time + loading.hold_time
    return loading.mean_pressure / float(material.shear.relaxation_modulus(since))


def condensed_poisson_ratio(material: MicroMaterial) -> float:
    """Return nu = (3 K - 2 G) / (2 (3 K + G)) with the relaxed shear modulus.

    Where the rubber relaxes to nothing, the instantaneous one is taken. Between both, the contact
    compliance changes by 2 (1 - nu): 2 % from 0.499 to 0.49.
    """
    k, g = material.bulk_modulus, material.shear.equilibrium_modulus
    g = g if g > 0.0 else material.shear.instantaneous_modulus
    return (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))


SIDEWAYS_STEPS, SIDEWAYS_TOLERANCE, SIDEWAYS_LIMIT = 12, 1e-5, 3e-3
"""Newton steps, change of displacement over roughness that ends them, and that marks a failure."""
SMALL_PRESSURE_RATIO = 0.1
"""Mean pressure over shear modulus below which small strains are right within 2 % in area."""
LEAST_LOSS_TANGENT = 1e-3
"""Below it hysteresis COF is less than 1e-4 on surfaces as rough as the report's."""


class Moment(NamedTuple):
    """One time of the march: how long the step before it took, where the floor is, what holds."""

    step: float
    distance: float
    load: float | None


class CondensedMarch:
    """Displacement of the lower face, its memory and the contact, step by step."""

    def __init__(
        self,
        condensed: CondensedBlock,
        material: MicroMaterial,
        floor: MicroSurface,
    ) -> None:
        self.condensed, self.floor = condensed, floor
        self.material, self.shear = material, material.shear
        self.instantaneous = material.shear.instantaneous_modulus
        self.fractions = material.shear.term_moduli / self.instantaneous
        self.rates = 1.0 / material.shear.relaxation_times
        count = condensed.areas.size
        vector = condensed.unit_vector_compliance
        self.sideways = vector is not None
        self.compliance = condensed.unit_compliance if vector is None else vector
        axes = 3 if self.sideways else 1
        self.displacement = np.zeros((axes, count))  # the last axis is z
        self.memory = np.zeros((self.fractions.size, axes, count))
        self.active = np.zeros(count, dtype=bool)
        self.height = 0.0
        self.wrong = 0
        self.unsettled = 0.0
        self._coefficients: dict[float, tuple[PronyStep, float]] = {}
        self._scaled: tuple[float, np.ndarray] | None = None

    def run(
        self, moments: list[Moment], loading: MicroLoading, started: float, progress: Progress
    ) -> MicroResult:
        """March through all moments; ``started`` is the process time when the work began, s.

        Parameters:
            moments: Times of the march, in order.
            loading: Forces and motion of the block.
            started: Process time when the work began, s.
            progress: Called with stage, fraction and residual; an exception it raises stops the
                work.
        """
        rows: list[tuple[float, ...]] = []
        status, notes, now = Status.CONVERGED, [], 0.0
        try:
            for n, moment in enumerate(moments, start=1):
                progress("condensed block", n / len(moments), None)
                now += moment.step
                rows.append((now, moment.distance, *self.step(moment)))
        except Cancelled:
            status = Status.CANCELLED
            notes.append(f"cancelled after {len(rows)} of {len(moments)} steps")
        if self.wrong:
            status = Status.NOT_CONVERGED
            notes.append(f"{self.wrong} steps left nodes that press and gape at once")
        if self.unsettled > SIDEWAYS_LIMIT:
            status = Status.NOT_CONVERGED
            notes.append(f"sideways motion settled to {self.unsettled:.1g} of the roughness only")
        if rows and rows[-1][2] == 0.0:
            notes.append("the faces do not touch at the end")
        table = np.array(rows).reshape(-1, 9)
        averages = self._averages(table) if status is Status.CONVERGED else None
        if averages is not None:
            notes += self._loss_note(loading) + self._strain_note(loading)
            notes += resolution_note(averages)
        return MicroResult(
            *table[:, :8].T,
            nominal_area=self.condensed.block.nominal_area,
            averages=averages,
            energy=None,
            status=status,
            notes=tuple(notes),
            steps=len(rows),
            time_step=moments[-1].step,
            process_seconds=clock.process_time() - started,
        )

    def step(self, moment: Moment) -> tuple[float, ...]:
        """Advance to ``moment``; return forces, area, height and the number of solutions."""
        coefficients, modulus = self._at_step(moment.step)
        known: Any = known_displacement(self.memory, self.displacement, coefficients)
        solved = self._sideways if self.sideways else self._vertical
        contact, new, slope, across = solved(moment, known, modulus)
        force = contact.force
        self.wrong += contact.wrong > 0
        self.active, self.height = force > 0.0, contact.height
        advance_memory(self.memory, self.displacement, new, coefficients)
        self.displacement = new
        return (
            float(force.sum()),
            float(force @ slope),
            -float(force @ across),
            nodal_contact_area(self.condensed, self.active),
            edge_corrected_contact_area(self.condensed, self.active),
            contact.height,
            float(contact.steps),
        )

    def _vertical(self, moment: Moment, known: np.ndarray, modulus: float):
        """Return contact, displacement and the floor's slopes; nodes move up and down only."""
        points = self.condensed.points
        h, slope, across = self.floor.height_and_slope(points[:, 0] + moment.distance, points[:, 1])
        if self._scaled is None or self._scaled[0] != modulus:
            self._scaled = modulus, self.compliance / modulus
        compliance = self._scaled[1]
        contact = self._contact(compliance, points[:, 2] + known[0] - h, moment)
        return contact, known + compliance @ contact.force, slope, across

    def _sideways(self, moment: Moment, known: np.ndarray, modulus: float):
        """Return the same with nodes that move sideways: Newton on place and normal."""
        points, new = self.condensed.points, self.displacement
        largest = float(np.ptp(points[:, 2]) + self.floor.peak_to_valley)
        steps = 0
        while True:
            steps += 1
            x, y = points[:, 0] + moment.distance + new[0], points[:, 1] + new[1]
            h, slope, across = self.floor.height_and_slope(x, y)
            normal = np.stack([-slope, -across, np.ones(slope.size)])
            along = np.einsum("in,injm,jm->nm", normal, self.compliance, normal, optimize=True)
            clearance = points[:, 2] - h + slope * new[0] + across * new[1]
            clearance = clearance + (normal * known).sum(axis=0)
            contact = self._contact(along / modulus, clearance, moment)
            self.active = contact.force > 0.0
            pushed = np.einsum("injm,jm->in", self.compliance, normal * contact.force)
            before, new = new, known + pushed / modulus
            change = float(np.abs(new - before).max())
            if change <= SIDEWAYS_TOLERANCE * largest or steps == SIDEWAYS_STEPS:
                self.unsettled = max(self.unsettled, change / largest if largest > 0.0 else 0.0)
                return contact, new, slope, across

    def _contact(
        self, compliance: np.ndarray, clearance: np.ndarray, moment: Moment
    ) -> NodalContact:
        if moment.load is None:
            return contact_at_height(compliance, clearance, self.height, self.active)
        return contact_under_load(compliance, clearance, moment.load, self.active)

    def _at_step(self, step: float) -> tuple[PronyStep, float]:
        key = float(f"{step:.9e}")
        if key not in self._coefficients:
            coefficients = prony_step(self.fractions, self.rates, step)
            modulus = self.instantaneous * coefficients.stiffening
            self._coefficients[key] = coefficients, modulus
        return self._coefficients[key]

    def _loss_note(self, loading: MicroLoading) -> list[str]:
        """Say when the rubber loses next to nothing at the frequency of passing asperities."""
        frequency = 2.0 * np.pi * loading.speed / self.floor.wavelength
        loss = self.shear.loss_tangent(frequency)
        if loss > LEAST_LOSS_TANGENT:
            return []
        return [
            f"the loss tangent is {loss:.1g} at the frequency of passing asperities "
            f"({frequency:.3g} rad/s): no hysteresis friction to speak of"
        ]

    def _strain_note(self, loading: MicroLoading) -> list[str]:
        """Say when the block's own compression is more than its compliance knows."""
        ratio, known = pressure_ratio_of(self.material, loading), self.condensed.pressure_ratio
        if ratio - known <= SMALL_PRESSURE_RATIO:
            return []
        return [
            f"the mean pressure is {ratio:.2g} of the shear modulus: finite strain, left out here, "
            f"changes area by some {20 * (ratio - known):.0f} % and mean |shear| by "
            f"{60 * (ratio - known):.0f} % (finite_strain knows it)"
        ]

    def _averages(self, table: np.ndarray):
        sliding = np.flatnonzero(table[:, 1] > 0.0)
        if sliding.size < 4 or not self.floor.rough:
            return None
        first = sliding[0]
        ends = table[first - 1 :]
        middle = 0.5 * (ends[1:] + ends[:-1])
        normal, shear, lateral, area, corrected = middle[:, 2:7].T
        values = [normal, shear, np.abs(shear), np.hypot(shear, lateral), area, corrected]
        return whole_wavelength_averages(
            table[sliding, 1], values, self.floor.wavelength, self.condensed.block.nominal_area
        )


def nodal_contact_area(condensed: CondensedBlock, contact: np.ndarray) -> float:
    """Return the area that belongs to the nodes in ``contact`` (n,) bool, m^2."""
    return float(condensed.areas[contact].sum())


def edge_corrected_contact_area(condensed: CondensedBlock, contact: np.ndarray) -> float:
    """Return the nodal area less what its edges count too much (``edge_excess_area``), m^2."""
    nx, ny = condensed.grid
    size, elements = condensed.block.size, condensed.block.elements
    excess = edge_excess_area(
        contact.reshape(ny, nx),
        size[0] / elements[0],
        size[1] / elements[1],
        periodic=condensed.block.sides == "periodic",
    )
    return max(nodal_contact_area(condensed, contact) - excess, 0.0)
