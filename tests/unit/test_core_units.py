"""Units at the door."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.core import InputError, display, to_si
from underfoot.core.unit_text import metres
from underfoot.core.units import spread_to_si


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("219 cP", "Pa*s", 0.219),
        ("219 mPa*s", "Pa*s", 0.219),
        ("3 mm", "m", 3e-3),
        ("35.1 µm", "m", 35.1e-6),
        ("10 deg", "rad", math.radians(10)),
        ("10°", "rad", math.radians(10)),
        ("20 degC", "K", 293.15),
        ("20 °C", "K", 293.15),
        ("160 kPa", "Pa", 160e3),
        ("90 %", "1", 0.9),
        ("1e-3 m", "m", 1e-3),
        ("30 ms", "s", 0.03),
    ],
)
def test_text_with_a_unit_becomes_si(text, unit, expected):
    assert to_si(text, unit, where="x") == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("spread", "value", "unit", "expected"),
    [
        ("2 degC", "20 degC", "K", 2.0),
        ("2 C", "20 C", "K", 2.0),
        ("3,6 °F", "68 °F", "K", 2.0),
        ("2 K", "20 °C", "K", 2.0),
        ("5 cP", "219 cP", "Pa*s", 0.005),
        ("1 %", "90 %", "1", 0.01),
        (5, 68, "1", 5.0),
    ],
)
def test_a_spread_is_a_difference(spread, value, unit, expected):
    """Two degrees were 275.15 K."""
    assert spread_to_si(spread, value, unit, where="x") == pytest.approx(expected, rel=1e-9)


def test_percent_of_a_plain_number_is_asked():
    with pytest.raises(InputError, match=r"sd: 10 % can be of the value or in its unit"):
        spread_to_si("10 %", 68, "1", where="sd")


def test_a_plain_number_is_dimensionless_only():
    assert to_si(0.5, "1", where="x") == 0.5
    with pytest.raises(InputError, match=r"shoe\.tread\.depth: 3 has no unit.*\"3 mm\""):
        to_si(3, "m", where="shoe.tread.depth")


NO_UNITS = ("5\u00b11", "5 +/- 1", "5-6", "5..6", "0x10", "0b11", "5:6", "5?", "5*10")
"""Ranges, tolerances, codes: no number and a unit that could be left away."""


@pytest.mark.parametrize(
    ("text", "unit", "message"),
    [
        ("3 mmm", "m", "unknown unit"),
        ("3 kPa", "m", "is not a value in m"),
        ("three mm", "m", "is not a number"),
        ("inf m", "m", "is not a number"),
        ("1e999 m", "m", "not finite"),
        ("", "m", "is not a number"),
        *((text, unit, "is not a number") for text in NO_UNITS for unit in ("1", "m")),
        (True, "1", "is not a number"),
        ([1], "1", "is not a quantity"),
    ],
)
def test_bad_text_is_refused_with_an_example(text, unit, message):
    with pytest.raises(InputError, match=message) as caught:
        to_si(text, unit, where="here")
    assert str(caught.value).startswith("here: ")


def test_a_field_is_answered_in_its_own_unit():
    with pytest.raises(InputError, match=r'is not a value in cP\. Allowed: for example "5 cP"'):
        to_si("3 mm", "Pa*s", where="", usual="cP")


def test_a_misspelt_unit_gets_the_nearest_match():
    with pytest.raises(InputError) as caught:
        to_si("5 MPaa", "Pa", where="x")
    assert caught.value.nearest == "MPa"


@given(st.floats(1e-9, 1e9), st.sampled_from(["m", "Pa", "s", "N", "m/s", "m^2"]))
def test_displayed_text_reads_back(value, unit):
    assert to_si(display(value, unit, 12), unit, where="x") == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize(
    ("unit", "text"),
    [("m", "0 m"), ("Pa", "0 Pa"), ("s", "0 s"), ("N", "0 N"), ("N/m", "0 N/m"), ("kg", "0 kg"),
     ("Pa*s", "0 cP"), ("rad", "0 deg"), ("m^2", "0 cm^2"), ("1", "0")],
)  # fmt: skip
def test_nothing_is_said_in_the_plain_unit_or_in_the_largest_that_people_use(unit, text):
    assert display(0.0, unit) == text


def test_display_says_when_it_is_not_a_number():
    assert display(float("nan"), "Pa") == "not a number"


def test_inches_and_pounds_on_request(monkeypatch):
    from underfoot.core.presentation import quantity_text
    from underfoot.core.unit_text import UNITS_VARIABLE, tread_unit

    values = ((3e-3, "m"), (25.4e-6, "m"), (6894.757, "Pa"), (444.822, "N"), (6.4516e-4, "m^2"))
    assert [quantity_text(*each) for each in values][:2] == ["3 mm", "25.4 µm"]
    monkeypatch.setenv(UNITS_VARIABLE, "us")
    shown = [quantity_text(*each) for each in values]
    assert shown == ["0.118 in", "1 mil", "1 psi", "100 lbf", "1 in²"]
    assert tread_unit("m") == (25.4e-3, "in")
    assert tread_unit("m^3") == (pytest.approx(25.4e-3**3), "in^3")
    assert tread_unit("1") == (1.0, "1")
    # what is read does not change with what is written
    assert to_si("3 mm", "m", where="x") == 3e-3
    for value, unit in values:
        text = display(value, unit, 8).replace("mil", "thou")
        assert to_si(text, unit, where="x") == pytest.approx(value, rel=1e-6)


@pytest.mark.parametrize(
    ("length", "text"),
    [(3.125e-5, "31.25 um"), (1 / 3e3, "333.3 um"), (0.123456, "123.5 mm"), (2.0, "2 m")],
)
def test_a_length_has_four_digits_in_the_unit_that_fits_it(length, text):
    assert metres(length) == text
