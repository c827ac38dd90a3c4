"""Roughness of the interface: its spread, its decay length, and the regime of a result."""

import math
from types import SimpleNamespace

import pytest

from underfoot.case import Case
from underfoot.compute.numbers import regime
from underfoot.compute.resolve import resolve_context
from underfoot.film import SHARE_LIMITS

TEXT = """
shoe = {from = "work_shoe_untreaded", roughness.ra = {value = "4 um", uncertainty = "0.4 um"}}
floor = {from = "vinyl_g2", roughness.rq = {value = "3 um", uncertainty = "0.6 um"}}
contaminant = "glycerol_90pct"
motion = "slip_tester_g4"
"""


def test_the_spread_of_a_mean_roughness_is_that_of_its_rq():
    """d Rq / Rq with Rq = sqrt(a^2 + b^2), a = sqrt(pi/2) Ra: (a da + b db in square) / Rq^2."""
    sole, sole_spread = (math.sqrt(math.pi / 2) * value for value in (4e-6, 0.4e-6))
    floor, floor_spread = 3e-6, 0.6e-6
    expected = math.hypot(sole * sole_spread, floor * floor_spread) / (sole**2 + floor**2)
    context = resolve_context(Case.from_text(TEXT))
    assert context.rq_deviation == pytest.approx(expected, rel=1e-12)
    # by differences: move each height by its spread
    lengths = [math.hypot(sole + sole_spread, floor), math.hypot(sole, floor + floor_spread)]
    whole = math.hypot(sole, floor)
    moved = math.hypot(*(length / whole - 1 for length in lengths))
    assert context.rq_deviation == pytest.approx(moved, rel=0.1)


def test_the_spread_of_a_measured_interface_is_its_own():
    case = Case.from_text(TEXT)
    own = {"value": "12 um", "uncertainty": "3 um"}
    assert resolve_context(
        case.replace("interface.effective_rq", own)
    ).rq_deviation == pytest.approx(0.25)
    assert resolve_context(case.replace("interface.effective_rq", "12 um")).rq_deviation is None
    plain = case.replace({"shoe.roughness.ra": "4 um", "floor.roughness.rq": "3 um"})
    assert resolve_context(plain).rq_deviation is None


def test_the_exponential_law_falls_by_e_over_half_of_rq():
    """Persson 2007: p = beta E* exp(-u / u0) with u0 = gamma Rq; gamma about 0.5, beta 0.375."""
    case = Case.from_text(TEXT).replace("interface.effective_rq", "10 um")
    context = resolve_context(case)
    law = case.rough_contact.build(context)
    gap = 30e-6
    ratio = float(law.pressure(gap)) / float(law.pressure(gap + 0.5 * 10e-6))
    assert ratio == pytest.approx(math.e, rel=1e-6)
    expected = 0.375 * context.plane_strain_modulus * math.exp(-gap / (0.5 * 10e-6))
    assert float(law.pressure(gap)) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("share", "name"),
    [
        (0.0, "boundary lubrication"),
        (0.09, "boundary lubrication"),
        (0.11, "mixed lubrication"),
        (0.89, "mixed lubrication"),
        (0.91, "full film"),
        (1.0, "full film"),
    ],
)
def test_the_regime_is_named_by_one_definition(share, name):
    contact = SimpleNamespace(fluid_load=500 * share, normal_force=500.0)
    labels = regime(contact.fluid_load / contact.normal_force)
    assert labels["regime"] == name
    assert SHARE_LIMITS == (0.1, 0.9)
    assert labels["regime_rule"] == "by load share: below 10 % boundary, above 90 % full film"
