"""One number that is missing among good ones is refused."""

import numpy as np
import pytest

from underfoot.core import InputError, RangeError
from underfoot.fluid.cheng_2008 import (
    glycerol_mass_fraction,
    glycerol_water_density,
    glycerol_water_viscosity,
)

CALLS = (glycerol_water_viscosity, glycerol_water_density, glycerol_mass_fraction)


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_one_number_of_several_that_is_not_finite(call, bad):
    with pytest.raises(InputError, match="a value is not finite"):
        call([0.5, bad, 0.2], 293.15)
    with pytest.raises(InputError, match="a value is not finite"):
        call(0.5, [293.15, bad])


@pytest.mark.parametrize("call", CALLS)
def test_one_number_of_several_that_is_out_of_range(call):
    for shares in ([0.5, 1.01], [-0.01, 0.5]):
        with pytest.raises(RangeError, match="glycerol fraction"):
            call(shares, 293.15)
    for kelvin in ([293.15, 373.2], [273.1, 293.15]):
        with pytest.raises(RangeError, match="temperature"):
            call(0.5, kelvin)
