"""Numbers as people type them: one reader for fields, files and commands."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.core import InputError, to_si
from underfoot.core.typed import split_quantity

SPELLINGS = {
    ("Pa*s", "cP", 0.0415): ["41.5 cP", "41,5 cP", "41,5", "41.5", "41,5cP", "0.0415 Pa s",
                             "0,0415 Pa·s", "0.0415 Pa.s", "41,5 mPa·s", "41.5 mPas", "41,5 cps"],
    ("m/s", "m/s", 0.3): ["0,3 m/s", "0.3", ",3", "300 mm/s", "0,3m/s", "3e-1 m/s", "+0,3"],
    ("m", "mm", 0.0075): ["7,5", "7.5 mm", "7,5mm", "0,75 cm", "0,0075 m"],
    ("m", "in", 0.009525): ["3/8", "3/8 in", '3/8"', "0,375 in", "⅜ in", "0,9525 cm", "0.375"],
    ("m", "in", 0.0381): ["1 1/2", "1½ in", "1-1/2 in", '1 1/2"', "1,5", "1.5 inch"],
    ("N", "N", 1234.5): ["1.234,5", "1,234.5 N", "1 234,5", "1'234.5", "1\u00a0234,5 N",
                         "1,2345 kN", "1\u202f234,5"],
    ("rad", "deg", 0.17453292519943295): ["10°", "10 deg", "10", "10,0", "1e1", "10 Grad",
                                          "10Grad", "600 arcmin", "0.17453292519943295 rad"],
    ("rad/s", "rad/s", 62.83185307179586): ["10 Hz", "10Hz", "0,01 kHz", "600 rpm", "10 turn/s",
                                            "62.83185307179586", "62,83185307179586 rad/s"],
    ("Hz", "Hz", 10.0): ["10", "10 Hz", "600 rpm", "62.83185307179586 rad/s", "10 1/s"],
    ("1/s", "1/s", 10.0): ["10", "10 1/s", "10 Hz", "10 s^-1"],
    ("m", "mm", -0.003): ["-3 mm", "\u22123 mm", "\u20133", "-3,0"],
    ("K", "degC", 293.15): ["20 °C", "20", "20,0 degC", "20 deg C", "68 °F"],
    ("kg/m^3", "kg/m^3", 1100.0): ["1 100", "1100 kg/m³", "1,1 g/cm3", "1.1 g/cm^3"],
}  # fmt: skip


@pytest.mark.parametrize("comma", [False, True])
def test_no_spelling_of_a_quantity_is_wrong_in_silence(comma):
    for (si, usual, value), texts in SPELLINGS.items():
        for text in texts:
            read = to_si(text, si, where="field", usual=usual, comma=comma)
            assert read == pytest.approx(value, rel=1e-12), text


def test_what_can_be_two_numbers_is_asked():
    for text, comma in (("1,234", False), ("1.234", True), ("12,500 N", False), ("2.500", True)):
        with pytest.raises(InputError, match="can be") as told:
            to_si(text, "N", where="field", usual="N", comma=comma)
        assert " or " in str(told.value)
    assert split_quantity("0,123") == (0.123, "")  # no thousands begin with 0
    assert split_quantity("1234,567") == (1234.567, "")
    assert split_quantity("1.234") == (1.234, "")
    assert split_quantity("1,234", comma=True) == (1.234, "")


@pytest.mark.parametrize(
    "text",
    ["", "abc", "1.2.3", "1,2,3", "3 4", "1..2", "NaN", "inf", "1e400", "5 cP", "12 34", "3/0",
     "1.23,4.5", "--3", "1,23.456,7"],
)  # fmt: skip
def test_what_is_no_length_is_refused(text):
    with pytest.raises(InputError, match=r"field"):
        to_si(text, "m", where="field", usual="mm")


@pytest.mark.parametrize(
    ("text", "si"),
    [("10 grad", "rad"), ("2 %", "rad"), ("2%", "rad"), ("5 mm/m", "rad"), ("10 ppm", "rad"),
     ("41.5% mm", "m"), ("3 % N", "N"), ("10 rpm", "1/s"), ("10 rad/s", "1/s")],
)  # fmt: skip
def test_no_share_is_an_angle_and_no_turn_a_rate(text, si):
    """A library of units takes angles and shares for pure numbers; "grad" is degrees or gon."""
    with pytest.raises(InputError, match="is not a value in"):
        to_si(text, si, where="field")


GROUPS = st.sampled_from([",", ".", "'", "\u2019", " ", "\u00a0", "\u202f"])


@given(st.integers(1, 10**9), st.integers(0, 9999), GROUPS, st.sampled_from(",."))
def test_thousands_and_decimals_come_back(whole, part, sign, decimal):
    if sign == decimal:
        return
    text = f"{whole:,}".replace(",", sign) + f"{decimal}{part:04d}"
    for comma in (False, True):
        read, unit = split_quantity(f"{text} N", comma=comma)
        assert (read, unit) == (float(f"{whole}.{part:04d}"), "N")


@given(st.floats(-1e6, 1e6), st.sampled_from("gef"), st.integers(0, 12))
def test_what_python_writes_is_read_as_written(value, form, digits):
    text = f"{value:.{digits}{form}}"
    assert split_quantity(text) == (float(text), "")
    both = itertools.product((text.replace(".", ","),), (True,))
    assert all(split_quantity(each, comma=comma)[0] == float(text) for each, comma in both)
