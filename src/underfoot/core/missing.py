"""Numbers that stand for "not measured": -9999, -32768, 1e30 and whatever else a program writes."""

import numpy as np

from .arrays import Array, Mask

ALONE = 20.0
"""Spreads of all others that a single number must lie off to be a code."""


def mask_of_codes(
    values: Array, *, apart: float = 5.0, least: float = 0.0, most: float = 0.5
) -> Mask:
    """Return which values are a code: the least or greatest number, far from all others.

    Parameters:
        values: Any shape; nan is neither.
        apart: Spreads of all others that a number that occurs more than once lies off them at
            least; a single one ``ALONE``.
        least: Its size, in the unit of the values.
        most: Share of the values that may hold it.
    """
    found = np.zeros(values.shape, dtype=bool)
    for away in (1.0, -1.0):
        known = values[np.isfinite(values) & ~found]
        if known.size < 3:
            return found
        end = known.min() if away > 0 else known.max()
        others = known[known != end]
        count = known.size - others.size
        if others.size == 0 or abs(end) < least or count > most * known.size:
            continue
        spread = float(np.ptp(others))
        gap = away * float((others.min() if away > 0 else others.max()) - end)
        if spread > 0.0 and gap > spread * (apart if count > 1 else max(apart, ALONE)):
            found |= values == end
    return found
