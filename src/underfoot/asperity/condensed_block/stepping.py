"""The march of a condensed block: displacement, memory and contact, step by step."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.asperity._kernels.prony_march import (
    PronyStep,
    advance_memory,
    known_displacement,
    prony_step,
)
from underfoot.asperity.finite_element import (
    MicroLoading,
    MicroMaterial,
    MicroResult,
    MicroSurface,
)
from underfoot.asperity.finite_element.averages import (
    resolution_note,
    whole_wavelength_averages,
)
from underfoot.core import Cancelled, Progress, Status

from ._kernels.active_set import NodalContact, contact_at_height, contact_under_load
from .area import edge_corrected_contact_area, nodal_contact_area
from .compliance import CondensedBlock
from .moduli import pressure_ratio_of

SIDEWAYS_STEPS, SIDEWAYS_TOLERANCE, SIDEWAYS_LIMIT = 12, 1e-5, 3e-3
"""Newton steps, change of displacement over roughness that ends them, and that marks a failure."""
SMALL_PRESSURE_RATIO = 0.1
"""Mean pressure over shear modulus below which small strains are right within 2 % in area."""
LEAST_LOSS_TANGENT = 1e-3
"""Below it hysteresis COF is less than 1e-4 on surfaces as rough as the report's."""


@dataclass(frozen=True, slots=True)
class Moment:
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
        """March through all moments; ``started`` is the process time when the work began, s."""
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
            time=table[:, 0],
            distance=table[:, 1],
            normal_force=table[:, 2],
            shear_force=table[:, 3],
            lateral_force=table[:, 4],
            real_contact_area=table[:, 5],
            corrected_contact_area=table[:, 6],
            height=table[:, 7],
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
        return whole_wavelength_averages(
            table[sliding, 1],
            normal,
            shear,
            np.abs(shear),
            np.hypot(shear, lateral),
            area,
            corrected,
            wavelength=self.floor.wavelength,
            nominal_area=self.condensed.block.nominal_area,
        )
