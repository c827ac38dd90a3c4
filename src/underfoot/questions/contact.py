"""Rubber on one rough surface, dry, at rest or sliding: real contact, hysteresis, gap, leakage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from underfoot.core import InputError, display
from underfoot.core.presentation import Presentable, Table
from underfoot.rough_contact import SteadySliding, steady_sliding
from underfoot.rough_contact.cutoff import CutoffDependence, cutoff_dependence
from underfoot.rough_contact.flow_factor import FlowFactors, flow_factors
from underfoot.surface import HeightMap, rms_slope

from .contact_input import RubberChoice, SurfaceChoice, rubber_from, surface_from

ROWS = (
    ("Mean pressure", "pressure_Pa", "Pa", ""),
    ("Sliding speed", "speed_m_per_s", "m/s", ""),
    ("Surface, rms height", "rms_height_m", "m", ""),
    ("Surface, rms slope", "rms_slope", "1", "both directions together"),
    ("Shortest wave", "shortest_wave_m", "m", "contact and friction refer to it"),
    ("Real contact fraction", "real_contact_fraction", "1", "edges of patches corrected"),
    ("Hysteresis COF", "cof_hysteresis", "1", ""),
    ("Mean gap", "mean_gap_m", "m", "contact counted as zero"),
    ("Flow factor along", "flow_factor_along", "1", "of a smooth gap of that mean; 0: sealed"),
    ("Flow factor across", "flow_factor_across", "1", ""),
)


@dataclass(frozen=True, slots=True)
class RoughContact(Presentable):
    """One rough contact: the surface, the solution, the leakage of its gap."""

    kind: ClassVar[str] = "contact"

    rubber: str
    floor: HeightMap
    contact: SteadySliding
    flow: FlowFactors
    scales: CutoffDependence | None
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<RoughContact of {self.rubber:.120}: {self.contact.status}>"

    @property
    def usable(self) -> bool:
        """Whether the numbers are a result."""
        return self.contact.status.usable

    def heading(self) -> str:
        """Return the title."""
        return "Rough contact"

    def headline(self) -> tuple[str, ...]:
        """Return contact fraction and hysteresis at this pressure and speed."""
        found = self.contact
        at = f"{display(found.nominal_pressure, 'Pa')}, {display(found.speed, 'm/s')}"
        if not self.usable:
            return (f"No result at {at}: {found.status}. {found.status.remedy}",)
        return (
            f"Real contact {100.0 * found.real_contact_fraction_corrected:.3g} %, hysteresis COF "
            f"{found.cof_hysteresis:.3g} at {at} ({self.rubber}).",
        )

    def table(self) -> Table:
        """Return the numbers of the contact."""
        content = self.to_dict()
        rows = [
            (
                label,
                "not estimated" if content[key] is None else display(content[key], unit),
                remark,
            )
            for label, key, unit, remark in ROWS
        ]
        status = (str(self.contact.status), f"{self.contact.iterations} iterations")
        return Table("Contact", ("Quantity", "Value", "Remark"), [*rows, ("Status", *status)])

    def tables(self) -> tuple[Table, ...]:
        """Return the contact, and how it depends on the shortest wave if that was computed."""
        if self.scales is None:
            return (self.table(),)
        rows = [
            (
                display(entry["shortest_wave_m"], "m"),
                *(
                    "not converged" if entry[key] is None else display(entry[key], "1")
                    for key in ("real_contact_fraction", "cof_hysteresis")
                ),
            )
            for entry in self._scale_entries()
        ]
        heads = ("Shortest wave", "Real contact fraction", "Hysteresis COF")
        return self.table(), Table("Dependence on the shortest wave", heads, rows)

    def remarks(self) -> dict[str, Sequence[str]]:
        """Return notes on the solution and the tested ranges left."""
        return {
            "Notes": self._notes(),
            "Outside the tested range": tuple(map(str, self.contact.breaches)),
        }

    def to_dict(self) -> dict[str, Any]:
        """Return everything in SI; numbers of a failed solution are None."""
        found, floor, flow = self.contact, self.floor, self.flow
        values = {
            "real_contact_fraction": found.real_contact_fraction_corrected,
            "cof_hysteresis": found.cof_hysteresis,
            "mean_gap_m": found.mean_gap,
            "flow_factor_along": flow.along,
            "flow_factor_across": flow.across,
        }
        content: dict[str, Any] = {
            "rubber": self.rubber,
            "pressure_Pa": found.nominal_pressure,
            "speed_m_per_s": found.speed,
            "rms_height_m": floor.rms_height,
            "rms_slope": rms_slope(floor),
            "grid": list(floor.shape),
            "spacing_m": floor.spacing,
            "shortest_wave_m": floor.resolution,
            **{name: float(value) if self.usable else None for name, value in values.items()},
            "status": str(found.status),
            "iterations": found.iterations,
            "complementarity_error": found.complementarity_error,
            "notes": list(self._notes()),
            "breaches": [str(breach) for breach in found.breaches],
        }
        if self.scales is not None:
            content["shortest_waves"] = self._scale_entries()
        return content

    def _notes(self) -> tuple[str, ...]:
        return self.notes if self.scales is None else (self.scales.note, *self.notes)

    def _scale_entries(self) -> list[dict[str, Any]]:
        scales = self.scales
        if scales is None:
            return []
        columns = (scales.shortest_wave, scales.real_contact_fraction, scales.cof_hysteresis)
        names = ("shortest_wave_m", "real_contact_fraction", "cof_hysteresis")
        return [
            {
                name: None if value != value else value
                for name, value in zip(names, row, strict=True)
            }
            for row in zip(*(column.tolist() for column in columns), strict=True)
        ]


def rough_contact(
    surface: SurfaceChoice,
    rubber: RubberChoice,
    *,
    pressure: float,
    speed: float = 0.0,
    poisson_ratio: float = 0.5,
    scales: bool = False,
) -> RoughContact:
    """Return the contact of a rubber on a surface at a mean pressure (Pa) and speed (m/s).

    ``scales`` also computes it for up to five shortest waves.
    """
    modulus, described, assumed = rubber_from(rubber)
    floor = surface_from(surface)
    contact, flow = solved(floor, modulus, speed, pressure, poisson_ratio)
    dependence = (
        scale_dependence(floor, modulus, speed, pressure, poisson_ratio) if scales else None
    )
    notes = (*assumed, *contact.notes, *floor.processing)
    return RoughContact(described, floor, contact, flow, dependence, notes)


def solved(
    floor: HeightMap, rubber: Any, speed: float, pressure: float, poisson_ratio: float
) -> tuple[SteadySliding, FlowFactors]:
    """Return the contact and the flow factors of its gap."""
    contact = steady_sliding(floor.heights, floor.spacing, rubber, speed, pressure, poisson_ratio)
    if not contact.status.usable:
        return contact, FlowFactors(np.nan, np.nan, np.nan, np.nan, np.nan)
    gap = np.where(contact.pressure > 0.0, 0.0, contact.gap)
    return contact, flow_factors(gap, floor.spacing)


def scale_dependence(
    floor: HeightMap, rubber: Any, speed: float, pressure: float, poisson_ratio: float
) -> CutoffDependence:
    """Return the contact at up to five shortest waves, each half the one before."""
    last = max(floor.resolution or 0.0, 4.0 * floor.spacing)
    waves = [last * 2.0**n for n in range(4, -1, -1) if last * 2.0**n < 0.5 * min(floor.size)]
    if len(waves) < 2:
        raise InputError(
            f"waves from {last:.3g} m on a side of {min(floor.size):.3g} m: nothing to compare",
            where="--cutoffs",
            remedy="Take more --points or a surface with several scales",
        )
    return cutoff_dependence(floor, rubber, speed, pressure, waves, poisson_ratio)
