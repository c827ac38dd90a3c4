"""Verdicts by rule."""

import pytest

from underfoot.core import InputError
from underfoot.studies import STUDIES, Verdict, compared_range, compared_sign, study
from underfoot.studies.g1_cases import G1Settings
from underfoot.studies.verdict import percent_range


@pytest.mark.parametrize(
    ("printed", "ours", "verdict"),
    [
        ((-0.29, -0.16), (-0.20, -0.17), Verdict.REPRODUCED),
        ((-0.29, -0.16), (-0.294, -0.156), Verdict.REPRODUCED),  # what rounding leaves open
        ((-0.29, -0.16), (-0.35, -0.17), Verdict.WITHIN_SCATTER),
        ((-0.29, -0.16), (-0.50, -0.10), Verdict.WITHIN_SCATTER),
        ((-0.29, -0.16), (-0.10, -0.02), Verdict.TREND_ONLY),
        ((-0.29, -0.16), (-0.10, 0.02), Verdict.DISAGREES),
        ((-0.29, -0.16), (0.0, 0.0), Verdict.DISAGREES),
        ((0.42, 0.45), (0.6, 0.9), Verdict.TREND_ONLY),
        ((0.42, 0.45), (-0.6, 0.3), Verdict.DISAGREES),
        ((0.42, 0.45), (), Verdict.NOT_AVAILABLE),
        ((0.42, 0.45), (float("nan"), 0.43), Verdict.NOT_AVAILABLE),
        ((-0.18, -0.18), (-0.18,), Verdict.REPRODUCED),
    ],
)
def test_ranges(printed, ours, verdict):
    assert compared_range(printed, ours) is verdict


def test_signs():
    assert compared_sign(1, (0.1, 0.3)) is Verdict.REPRODUCED
    assert compared_sign(-1, (0.1, 0.3)) is Verdict.DISAGREES
    assert compared_sign(-1, (-0.1, 0.001)) is Verdict.DISAGREES
    assert compared_sign(1, ()) is Verdict.NOT_AVAILABLE


def test_words():
    assert percent_range((-0.294, -0.16)) == "-29 to -16 %"
    assert percent_range((0.101, 0.1)) == "+10 %"
    assert percent_range((float("nan"), 0.1)) == percent_range(()) == "-"
    with pytest.raises(InputError, match="lowest first"):
        compared_range((0.2, 0.1), (0.15,))


def test_studies_are_found_by_name():
    assert study("G1").name == "g1"
    assert len({one.name for one in STUDIES}) == len(STUDIES)
    with pytest.raises(InputError, match="unknown study"):
        study("h1")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"series": ("wide",)}, "unknown series"),
        ({"solver": "ansys"}, "unknown solver"),
        ({"bulk_modulus": "best"}, "unknown bulk modulus"),
        ({"speeds": (0.1,)}, "two or more speeds"),
        ({"floor_wavelength": 4e-3}, "one whole wavelength"),
    ],
)
def test_settings_refuse_what_cannot_be_run(change, words):
    with pytest.raises(InputError, match=words):
        G1Settings(**change)
