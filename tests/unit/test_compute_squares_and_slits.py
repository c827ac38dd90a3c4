"""Stresses of finer cells on their squares; slits that leave no lug."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.compute.contact_friction import _on_squares
from underfoot.core import InputError
from underfoot.friction import FrictionParts
from underfoot.shoe import Sipes


def test_a_square_has_the_mean_of_its_cells_part_by_part():
    """Two squares of area 1 and 2: three cells on the first, two on the second, one of it dry."""
    square, area = np.array([0, 0, 0, 1, 1]), np.array([0.5, 0.25, 0.25, 1.5, 0.5])
    wet = np.array([True, True, True, True, False])
    parts = (np.array([4.0, 8, 0, 2, 6]), np.array([1.0, 1, 1, 3, 3]), np.array([2.0, 2, 2, 4, 4]))
    shown = _on_squares(
        FrictionParts(*parts),
        cast(Any, SimpleNamespace(square=square, area=area, wet=wet)),
        cast(Any, SimpleNamespace(areas={"area": np.array([[1.0], [2.0]])})),
    )
    assert shown.adhesion.ravel().tolist() == [4.0, 3.0]
    assert shown.hysteresis.ravel().tolist() == [1.0, 3.0]
    assert shown.viscous.ravel().tolist() == [2.0, 3.0]


@pytest.mark.parametrize(("width", "fits"), [(0.99e-3, True), (1e-3, False), (1.9e-3, False)])
def test_slits_take_less_than_half_of_their_spacing(width, fits):
    if fits:
        assert Sipes(width, 1e-3, 2e-3).width == width
    else:
        with pytest.raises(InputError, match="leave no lug"):
            Sipes(width, 1e-3, 2e-3)
