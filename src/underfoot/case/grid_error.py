"""What the grid leaves in the numbers of a result, from the same case on the quick grid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import SourcedValue, display

if TYPE_CHECKING:
    from underfoot.outsole import SensorReading
    from underfoot.outsole.solver import SoleContact

ORDER = 1.0
"""Of convergence: steps and rims of the film are first order on square cells."""
NAMES = ("fluid_load", "fluid_load_sensor", "peak_fluid_pressure_sensor")


def readings(contact: SoleContact, sensor: SensorReading) -> dict[str, float]:
    """Return the numbers that a grid error is estimated for."""
    return {
        "fluid_load": contact.fluid_load,
        "fluid_load_sensor": sensor.load.value or 0.0,
        "peak_fluid_pressure_sensor": sensor.peak_pressure.value or 0.0,
    }


def grid_errors(
    fine: Mapping[str, float], coarse: Mapping[str, float], refinement: float
) -> dict[str, float]:
    """Return |fine - coarse| / (r^p - 1): what the fine grid still lacks (Richardson, p = 1).

    ``refinement`` r is coarse over fine spacing, above 1.
    """
    return {name: abs(fine[name] - coarse[name]) / (refinement**ORDER - 1) for name in NAMES}


def with_grid_errors(
    numbers: Mapping[str, SourcedValue], errors: Mapping[str, float]
) -> dict[str, SourcedValue]:
    """Return the numbers with the grid's error in their uncertainty and said in their note."""
    found = dict(numbers)
    for name, error in errors.items():
        value = numbers[name]
        said = f"grid error about {display(float(f'{error:.2g}'), value.unit)}"
        # a spread that isn't known stays so: the grid is not what decides it
        spread = value.uncertainty
        found[name] = replace(
            value,
            uncertainty=None if spread is None else float(np.hypot(spread, error)),
            note=f"{value.note}; {said}" if value.note else said,
        )
    return found


def grid_words(
    numbers: Mapping[str, SourcedValue], errors: Mapping[str, float], fine: float, coarse: float
) -> str:
    """Return the remark on the grid for a summary."""
    parts = [
        f"{name.replace('_', ' ')} +- {display(float(f'{error:.2g}'), numbers[name].unit)}"
        for name, error in errors.items()
    ]
    return f"{', '.join(parts)} (from {coarse * 1e3:g} and {fine * 1e3:g} mm, first order)"
