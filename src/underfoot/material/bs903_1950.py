"""Rubber hardness to Young's modulus: the error-function relation of BS 903 (1950)."""

from typing import Any

from numpy.typing import ArrayLike

from underfoot.core import Breach, ValidityRange, breaches
from underfoot.core.arrays import scalar_or_array

from ._hardness import checked_hardness

NAME = "bs903_1950"
SOURCE = "BS 903:1950; S = 100 erf(3.186e-4 E^(1/2)), E in Pa, as quoted by Gent (1958) and later"
RANGES = {"shore_a": ValidityRange(30.0, 95.0, "1", "assumed: standard hardness range of IRHD")}


def youngs_modulus_bs903(shore_a: ArrayLike) -> Any:
    """Return Young's modulus, Pa, of a rubber from its hardness.

    S = 100 erf(3.186e-4 sqrt(E / Pa))

    Strictly for British Standard / international hardness degrees, which are close to Shore A.
    Better than Gent's relation below about 40 and above 80, because both ends are bounded by
    experiment. ``shore_a`` of any shape, 0 <= S < 100.

    Raises:
        RangeError: Hardness outside 0 to below 100.

    >>> round(float(youngs_modulus_bs903(60.0)))
    3489087
    """
    from scipy.special import erfinv  # reading a case needs no SciPy

    hardness = checked_hardness(shore_a)
    return scalar_or_array((erfinv(hardness / 100.0) / 3.186e-4) ** 2)


def bs903_breaches(shore_a: ArrayLike) -> list[Breach]:
    """Return whether the hardness leaves the range of the relation."""
    return breaches(NAME, RANGES, {"shore_a": shore_a})
