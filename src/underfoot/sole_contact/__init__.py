"""The sole on the floor: compliance, contact and film solved together, and floor sensors."""

from .compliance import (
    Compliance,
    ConvolutionCompliance,
    half_space_compliance,
    layered_compliance,
)
from .reading import SensorReading, floor_sensor_reading
from .sole_state import SoleState, SolverSettings
from .solver import SoleContact, solve_sliding
from .stepping import SlidingSole, rolled_clearance

__all__ = [
    "Compliance",
    "ConvolutionCompliance",
    "SensorReading",
    "SlidingSole",
    "SoleContact",
    "SoleState",
    "SolverSettings",
    "floor_sensor_reading",
    "half_space_compliance",
    "layered_compliance",
    "rolled_clearance",
    "solve_sliding",
]
