"""Real contact area on a grid, and its correction for the staircase boundary."""

import math
from typing import Any

from underfoot.core.arrays import AnyArray

_STAIRCASE = (math.pi - 1.0 + math.log(2.0)) / 24.0


def boundary_length(contact: AnyArray, spacing: tuple[float, float], xp: Any) -> float:
    """Return the length of the grid lines between contact and no contact, periodic (m)."""
    along = int(xp.count_nonzero(contact != xp.roll(contact, 1, axis=0)))
    across = int(xp.count_nonzero(contact != xp.roll(contact, 1, axis=1)))
    return along * spacing[1] + across * spacing[0]


def contact_fractions(
    contact: AnyArray, spacing: tuple[float, float], xp: Any
) -> tuple[float, float]:
    """Return the fraction of nodes in contact, plain and corrected for its boundary.

    A' = A - (pi - 1 + ln 2)/24 * S * spacing, S the grid length of the boundary: on average a node
    counted as contact at the edge of a spot covers less than its cell.
    Source: Yastrebov, Anciaux and Molinari (2017) J. Mech. Phys. Solids 107:469 (arXiv 1701.02727).
    """
    nodes = contact.shape[0] * contact.shape[1]
    plain = float(xp.count_nonzero(contact)) / nodes
    width = math.sqrt(spacing[0] * spacing[1])
    excess = _STAIRCASE * boundary_length(contact, spacing, xp) * width
    area = nodes * spacing[0] * spacing[1]
    return plain, max(plain - excess / area, 0.0)
