"""When a slip class is contradicted: by the draws that are left, and by readings of one's own."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.friction.pair_contact import Pair, PairContactLaw, packaged_pair_draws
from underfoot.friction.propagation import named_shares
from underfoot.friction.shoe_class import (
    COUNT,
    REPEATS,
    ShoeClass,
    _ln_cof,
    certificate_line,
    exclusive,
    of_class,
    slip_tests,
)
from underfoot.friction.tread_error import READING

LAW = PairContactLaw(
    Pair(65.0, (2e-6, 6e-6), (3e-6, 3e-6), "aqueous"),
    0.2,
    packaged_pair_draws().rows(np.arange(40)),
)
FLAT = np.zeros(6)


def known(cof, kind="value", sd=0.02, fails=False):
    line = certificate_line("tile_glycerine", cof, kind, sd, "here")
    return ShoeClass("certified", "a test", (line,), fails)


def weights(cof, sd):
    """The weights of the draws by the normal error of one reading."""
    wide = LAW.draws.rows(np.tile(np.arange(LAW.draws.count), REPEATS))
    subject = LAW.pair.sole_roughness
    errors = {**wide.errors, subject: named_shares(3, subject, wide.count)}
    wide = replace(wide, errors=errors)
    ln_cof = _ln_cof(LAW, slip_tests()["tile_glycerine"], wide, FLAT, 3)
    repeat = READING if sd is None else sd / cof
    rest = (ln_cof - np.log(cof)) / np.hypot(repeat, wide.sd_reading)
    weight = np.exp(-0.5 * rest**2)
    return weight, float(np.sum(weight) ** 2 / np.sum(weight**2))


def test_fewer_than_fifty_effective_draws_contradict_a_class():
    low, high = 0.3, 8.0
    for _ in range(40):  # the higher the value, the fewer draws agree
        middle = np.sqrt(low * high)
        low, high = (middle, high) if weights(middle, 0.02)[1] > 50.4 else (low, middle)
    found = weights(low, 0.02)
    assert 50.0 < found[1] < 50.9
    made = of_class(LAW, known(low), FLAT, 3)
    assert not made.contradicted
    assert made.passing == pytest.approx(found[0].mean())
    assert made.law.draws.count == COUNT
    assert len(found[0]) == REPEATS * 40
    low, high = 0.3, 8.0
    for _ in range(40):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if weights(middle, 0.02)[1] > 49.6 else (low, middle)
    assert 49.0 < weights(high, 0.02)[1] < 50.0
    against = of_class(LAW, known(high), FLAT, 3)
    assert against.contradicted
    assert against.law.draws.count == 40


def test_readings_of_ones_own_go_before_a_class_that_fewer_than_one_in_twenty_reach():
    draws = packaged_pair_draws()
    read = PairContactLaw(
        LAW.pair, 0.2, replace(draws, errors={"laboratory": np.zeros(draws.count)})
    )

    def made(cof):
        return of_class(read, known(cof, "lower", None), FLAT, 3)

    low, high = 0.1, 3.0
    for _ in range(30):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if made(middle).passing > 0.05 else (low, middle)
    assert not made(0.999 * low).contradicted
    against = made(1.001 * high)
    assert against.contradicted
    assert 0.049 < against.passing < 0.05
    assert "your own tester" in str(against.law.draws.notes[-1])
    # without readings of its own the same probability is taken
    plain = PairContactLaw(LAW.pair, 0.2, draws)
    assert not of_class(plain, known(1.001 * high, "lower", None), FLAT, 3).contradicted


def test_bounds_of_one_test_exclude_each_other_where_the_lower_is_the_higher():
    lower, upper = (known(0.2, kind).readings[0] for kind in ("lower", "upper"))
    assert exclusive([lower, upper]) is None
    pair = exclusive([upper, replace(lower, cof=0.21)])
    assert pair is not None
    assert [one.kind for one in pair] == ["lower", "upper"]
    assert exclusive([replace(lower, cof=0.21), lower]) is None


@pytest.mark.parametrize("cof", [1e-3, 4.999])
def test_a_cof_between_nothing_and_five_is_one(cof):
    assert certificate_line("tile_glycerine", cof, "lower", None, "a").cof == cof
    for wrong in (0.0, 5.0):
        with pytest.raises(InputError, match="below 5"):
            certificate_line("tile_glycerine", wrong, "lower", None, "a")
