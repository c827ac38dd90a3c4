"""One part of a contact table: one surface at one speed over all pressures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core import content_hash
from underfoot.core.provenance import version

from .composite import composite_surface
from .contact_table import QUANTITIES
from .flow_factor import flow_factors
from .steady import steady_sliding
from .steady_checks import Modulus, modulus_function


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """One surface at one speed: the unit of work and of the cache.

    ``floor_heights`` is the floor alone where ``heights`` is a composite: its hysteresis counts.
    """

    heights: np.ndarray
    spacing: float
    modulus: Any
    speed: float
    pressure: np.ndarray
    poisson_ratio: float
    layer_thickness: float | None
    floor_heights: np.ndarray | None = None

    @property
    def key(self) -> str:
        """Return the content key: program version, heights, loads, modulus at every frequency."""
        q = 2.0 * np.pi * np.fft.rfftfreq(self.heights.shape[0], self.spacing)
        young = modulus_function(self.modulus, q * self.speed)(q * self.speed)
        return content_hash(
            version(),
            self.heights,
            self.spacing,
            young,
            self.speed,
            self.pressure,
            self.poisson_ratio,
            self.layer_thickness,
            self.floor_heights,
        )


def surface_part(
    floor: Any,
    shoe: Any,
    modulus: Modulus,
    speed: float,
    pressure: np.ndarray,
    poisson_ratio: float,
    layer_thickness: float | None,
) -> Part:
    """Return the part of one floor (with its shoe or None) at one speed."""
    alone = np.asarray(floor.heights)
    if shoe is None:
        heights, floor_heights = alone, None
    else:
        heights = composite_surface(floor, shoe, modulus, speed).heights
        floor_heights = alone
    return Part(
        heights,
        floor.spacing,
        modulus,
        speed,
        pressure,
        poisson_ratio,
        layer_thickness,
        floor_heights,
    )


def part_column(part: Part) -> dict[str, np.ndarray]:
    """Return the averages of one surface at one speed over all pressures, with their status."""
    rows: list[list[float]] = []
    errors: list[float] = []
    notes: list[str] = []
    for p in part.pressure:
        contact = steady_sliding(
            part.heights,
            part.spacing,
            part.modulus,
            part.speed,
            float(p),
            part.poisson_ratio,
            layer_thickness=part.layer_thickness,
        )
        errors.append(contact.complementarity_error)
        if not contact.status.usable:
            rows.append([np.nan] * len(QUANTITIES))
            continue
        friction = contact
        if part.floor_heights is not None:
            friction = steady_sliding(
                part.floor_heights,
                part.spacing,
                part.modulus,
                part.speed,
                float(p),
                part.poisson_ratio,
                layer_thickness=part.layer_thickness,
            )
            errors[-1] = max(errors[-1], friction.complementarity_error)
            if not friction.status.usable:
                rows.append([np.nan] * len(QUANTITIES))
                continue
        flow = flow_factors(np.where(contact.pressure > 0.0, 0.0, contact.gap), part.spacing)
        rows.append(
            [
                contact.real_contact_fraction_corrected,
                friction.cof_hysteresis,
                contact.mean_gap,
                flow.along,
                flow.across,
            ]
        )
        notes += [f"breach|{breach}" for breach in contact.breaches]
        notes += [f"note|{note}" for note in contact.notes if note.startswith("hysteresis")]
    values = np.array(rows)
    column = {name: values[:, n] for n, name in enumerate(QUANTITIES)}
    column["error"] = np.array(errors)
    column["notes"] = np.array(list(dict.fromkeys(notes)), dtype=np.str_)
    return column
