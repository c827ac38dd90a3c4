"""Shore A hardness to Young's modulus: Gent (1958)."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, RangeError, ValidityRange, breaches
from underfoot.core.arrays import scalar_or_array
from underfoot.core.remark import Message

from ._hardness import checked_hardness

NAME = "gent_1958"
SOURCE = (
    "A. N. Gent, On the relation between indentation hardness and Young's modulus, "
    "Trans. Inst. Rubber Ind. 34 (1958) 46-57"
)
RANGES = {
    "shore_a": ValidityRange(
        40.0,
        80.0,
        "1",
        "lower end: Gent's abstract (theory holds from about 40); upper end: later users",
    )
}


def youngs_modulus_gent(shore_a: ArrayLike) -> Any:
    """Return Young's modulus, Pa, of a rubber from its Shore A hardness.

    E = 0.0981 (56 + 7.62336 S) / (0.137505 (254 - 2.54 S)) MPa

    ``shore_a`` of any shape, 0 <= S < 100; usable from about 40 to 80 (``gent_breaches`` tells):
    below 40 the theory departs from experiment, towards 100 it tends to infinity. The modulus is
    a static one (the durometer is read after seconds) and carries tens of percent of uncertainty:
    a relaxation or dynamic test is better.

    Raises:
        RangeError: Hardness outside 0 to below 100.

    >>> round(youngs_modulus_gent(60.0))
    3605073
    """
    hardness = checked_hardness(shore_a)
    modulus = 0.0981e6 * (56.0 + 7.62336 * hardness) / (0.137505 * (254.0 - 2.54 * hardness))
    return scalar_or_array(modulus)


def shore_a_gent(youngs_modulus: ArrayLike) -> Any:
    """Return the Shore A hardness at which ``youngs_modulus_gent`` gives ``youngs_modulus`` (Pa).

    Raises:
        RangeError: A modulus below that of Shore A 0 (0.157 MPa), or not finite.

    >>> round(float(shore_a_gent(3.6e6)), 1)
    60.0
    """
    modulus = np.asarray(youngs_modulus, dtype=float)
    lowest = 0.0981e6 * 56.0 / (0.137505 * 254.0)
    if not np.all(np.isfinite(modulus) & (modulus >= lowest * (1.0 - 1e-12))):
        raise RangeError(
            "modulus below that of Shore A 0, or missing",
            where="youngs_modulus",
            allowed=Message("{lowest:.3g} Pa or more", lowest=lowest),
        )
    ratio = modulus * 0.137505 / 0.0981e6
    return scalar_or_array(np.maximum((254.0 * ratio - 56.0) / (7.62336 + 2.54 * ratio), 0.0))


def gent_breaches(shore_a: ArrayLike) -> list[Breach]:
    """Return whether the hardness leaves the range in which Gent's relation is usable.

    >>> [str(one) for one in gent_breaches(95.0)][0].partition(":")[0]
    'gent_1958'
    """
    return breaches(NAME, RANGES, {"shore_a": shore_a})
