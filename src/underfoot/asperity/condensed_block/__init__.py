"""A rubber block reduced to its rough lower face: a contact problem a time step, no inertia."""

from .area import edge_corrected_contact_area, nodal_contact_area
from .compliance import CondensedBlock, condensed_block
from .march import condensed_sliding
from .moduli import condensed_poisson_ratio, pressure_ratio_of
from .pressed import pressed_block

__all__ = [
    "CondensedBlock",
    "condensed_block",
    "condensed_poisson_ratio",
    "condensed_sliding",
    "edge_corrected_contact_area",
    "nodal_contact_area",
    "pressed_block",
    "pressure_ratio_of",
]
