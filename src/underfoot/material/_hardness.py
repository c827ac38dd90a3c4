"""What the hardness relations share."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import RangeError
from underfoot.core.remark import Message


def checked_hardness(shore_a: ArrayLike) -> Any:
    """Return hardness as an array; refuse what no durometer shows."""
    hardness = np.asarray(shore_a, dtype=float)
    good = np.isfinite(hardness) & (hardness >= 0.0) & (hardness < 100.0)
    if not np.all(good):
        wrong = np.atleast_1d(hardness)[~np.atleast_1d(good)][0]
        raise RangeError(
            Message("Shore A hardness {wrong:g}", wrong=wrong),
            where="shore_a",
            allowed="0 to below 100",
            remedy="A harder material has no Shore A value: enter its modulus",
        )
    return hardness
