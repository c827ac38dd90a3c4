"""Hardness to modulus: published relations and where they hold."""

import numpy as np
import pytest

from underfoot.core import RangeError
from underfoot.material import (
    bs903_breaches,
    gent_breaches,
    ruess_breaches,
    shore_a_gent,
    youngs_modulus_bs903,
    youngs_modulus_gent,
    youngs_modulus_ruess,
)

SHORE = np.array([40.0, 50.0, 60.0, 70.0, 85.0, 95.0])


def test_gent_and_ruess_tables():
    # Independent evaluations of the printed formulas, MPa, three digits.
    np.testing.assert_allclose(
        youngs_modulus_gent(SHORE) / 1e6, [1.69, 2.46, 3.61, 5.52, 13.2, 43.8], rtol=4e-3
    )
    np.testing.assert_allclose(
        youngs_modulus_ruess(SHORE) / 1e6, [1.99, 3.43, 5.88, 10.1, 22.8, 39.1], rtol=4e-3
    )
    # The natural logarithm, an error in print elsewhere, would give 2.2 MPa at 60.
    assert youngs_modulus_ruess(60.0) > 5e6


def test_bs903_from_its_own_definition():
    from scipy.special import erf

    modulus = youngs_modulus_bs903(SHORE)
    np.testing.assert_allclose(100.0 * erf(3.186e-4 * np.sqrt(modulus)), SHORE, rtol=1e-12)
    # Gent (1958) compared both: they meet between 40 and 80 (here within 25 %).
    ratio = youngs_modulus_gent(SHORE[:4]) / modulus[:4]
    assert np.all(np.abs(ratio - 1.0) < 0.25)


def test_ranges_are_told():
    assert gent_breaches([40.0, 80.0]) == []
    assert "shore_a 95" in str(gent_breaches(95.0)[0])
    assert gent_breaches(30.0)
    assert ruess_breaches([30.0, 60.0]) == []
    assert ruess_breaches(70.0)
    assert bs903_breaches(60.0) == []
    assert bs903_breaches(20.0)


@pytest.mark.parametrize(
    "relation", [youngs_modulus_gent, youngs_modulus_ruess, youngs_modulus_bs903]
)
@pytest.mark.parametrize("bad", [-1.0, 100.0, 120.0, np.nan])
def test_no_such_hardness(relation, bad):
    with pytest.raises(RangeError, match="Shore A hardness"):
        relation(bad)


def test_inverse_refuses_what_is_softer_than_zero():
    assert shore_a_gent(5.52050678e6) == pytest.approx(70.0, abs=1e-6)
    for bad in (1e3, np.nan):
        with pytest.raises(RangeError, match="modulus"):
            shore_a_gent(bad)
