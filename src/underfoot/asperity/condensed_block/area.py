"""Real contact area from the lower nodes that carry force."""

from __future__ import annotations

import numpy as np

from underfoot.asperity.finite_element.area import edge_excess_area

from .compliance import CondensedBlock


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
