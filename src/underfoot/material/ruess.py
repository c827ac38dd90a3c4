"""Shore A hardness to Young's modulus: the logarithmic relation ascribed to Ruess."""

from typing import Any

from numpy.typing import ArrayLike

from underfoot.core import Breach, ValidityRange, breaches
from underfoot.core.arrays import scalar_or_array

from ._hardness import checked_hardness

NAME = "ruess"
SOURCE = (
    "log10 E = 0.0235 S - 0.6403, as given by K. Larson, Can you estimate modulus from durometer "
    "hardness for silicones?, Dow (2016), ascribed there to Ruess"
)
RANGES = {
    "shore_a": ValidityRange(30.0, 60.0, "1", "best fit for silicones 30 to 60 (secondary source)")
}


def youngs_modulus_ruess(shore_a: ArrayLike) -> Any:
    """Return Young's modulus, Pa, of a rubber from its Shore A hardness.

    log10(E / MPa) = 0.0235 S - 0.6403

    The logarithm is the decimal one. Several engineering pages print the same constants with the
    natural logarithm: at Shore A 60 that gives 2.2 MPa instead of 5.9 MPa.

    ``shore_a`` of any shape, 0 <= S < 100; best from 30 to 60 (``ruess_breaches`` tells).

    Raises:
        RangeError: Hardness outside 0 to below 100.

    >>> round(youngs_modulus_ruess(60.0))
    5884370
    """
    hardness = checked_hardness(shore_a)
    return scalar_or_array(1e6 * 10.0 ** (0.0235 * hardness - 0.6403))


def ruess_breaches(shore_a: ArrayLike) -> list[Breach]:
    """Return whether the hardness leaves the range in which Ruess' relation is usable."""
    return breaches(NAME, RANGES, {"shore_a": shore_a})
