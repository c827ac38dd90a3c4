"""The sole on the floor: compliance, contact and film solved together, and floor sensors."""

from .compliance import Compliance as Compliance
from .compliance import ConvolutionCompliance as ConvolutionCompliance
from .compliance import half_space_compliance as half_space_compliance
from .compliance import layered_compliance as layered_compliance
from .reading import SensorReading as SensorReading
from .reading import floor_sensor_reading as floor_sensor_reading
from .sole_state import SoleState as SoleState
from .sole_state import SolverSettings as SolverSettings
from .solver import SoleContact as SoleContact
from .solver import solve_sliding as solve_sliding
from .stepping import SlidingSole as SlidingSole
from .stepping import rolled_sole as rolled_sole
