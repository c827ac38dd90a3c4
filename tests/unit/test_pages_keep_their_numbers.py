"""No sentence of a page is contradicted by a number beside it: kinds found by reading aloud."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from commands import called
from underfoot.case import Case
from underfoot.compute import numbers, summary
from underfoot.core import SourcedValue
from underfoot.core.presentation import interval_text
from underfoot.core.remark import Remark
from underfoot.friction.pair_contact import TERMS
from underfoot.places import choice
from underfoot.questions.method import MethodCondition
from underfoot.slip.dynamics import FitError, error_text

CASE = """
name = "Ward, detergent"
shoe = "work_shoe_untreaded"
floor = "vinyl_g4"
contaminant = "detergent"
motion = "slip_tester_g4"
"""


@given(st.floats(1e-6, 1.0), st.floats(1.0, 1e3))
def test_an_interval_of_forces_never_ends_below_its_own_begin(low, wide):
    text = interval_text("fluid_load", SourcedValue(low, "N", interval=(low, low * wide)))
    if "below" in text:  # "below 0.01 N to 0.005 N" was told
        _, _, upper = text.partition(" to ")
        assert float(upper.removeprefix("below ").split()[0]) >= 0.01


@pytest.mark.parametrize(("share", "told"), [(0.0004, "below 0.1 %"), (0.004, "0.4 %")])
def test_a_film_that_carries_little_is_not_told_as_none(share, told):
    limit = summary.FrictionLimit(film_share=share, cof=0.2, cof_without_film=0.2)
    assert limit.sentence().startswith(f"The film carries {told} of the load")


def test_every_term_of_the_friction_of_a_pair_has_its_words():
    assert set(TERMS) <= set(numbers.INPUTS)


def test_draws_in_which_nobody_slips_have_no_ratio():
    """Half the steps dry leave half of the slips: where there are none, nothing is left out."""
    before = np.r_[np.zeros(30), np.linspace(0.1, 0.9, 70)]
    assert choice._slip_ratio(0.5 * before, before) == pytest.approx((0.5, 0.5, 0.5))
    nobody = choice._lever("wiped up", np.zeros(9), np.zeros(9))
    assert not nobody.does_something


class _Outcome:
    breaches = (Remark("report_g6", "ACOF - RCOF"), Remark("gent_1958", "shore_a 85"))


def test_a_test_method_tells_one_spread_and_nothing_of_slips():
    """COF 0.093 ± 0.138 beside 0.02 to 0.38 was told; and a slip model's range, of no slip."""
    cof = SourcedValue(0.093, "1", uncertainty=0.138, note="law")
    names = ("tile", "tile", "tile", "glycerine")
    condition = MethodCondition(*names, cof, 0.02, 0.38, None, None, None, _Outcome())
    assert "COF 0.093 (95 %: 0.02 to 0.38; law)" in condition.sentence
    assert [each.about for each in condition.breaches] == ["gent_1958"]


def test_an_error_too_small_to_print_is_told_as_that():
    assert error_text(0.0, "m/s") == "below 0.001 m/s"
    assert "± 0 " not in str(FitError(4, 0.0, 0.0008, 2e-7, 0.0, 1.0))


def test_a_case_that_was_changed_is_named_by_what_changed(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE, encoding="utf-8")
    changed = called("check", path, "--set", "contaminant.from=water")
    assert "Ward, detergent, contaminant water" in " ".join(changed.stdout.split())
    case = Case.load(path, settings={"friction.model": "boundary", "name": "Ward, water"})
    assert case.name == "Ward, water"
    assert Case.load(path, settings={"friction.model": "boundary"}).name.endswith(
        "friction boundary"
    )
