"""The exact powers of ten against the unit library."""

from pathlib import Path

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.case import Case
from underfoot.core import InputError, to_si, units
from underfoot.core.units import _POWERS, si_unit

CASES = [(unit, text) for unit, names in _POWERS.items() for text in names]
REGISTRY = pint.UnitRegistry()


@pytest.mark.parametrize(("unit", "text"), CASES)
def test_a_power_of_ten_is_that_of_the_unit_library(unit, text):
    target = "dimensionless" if unit == "1" else unit
    expected = REGISTRY.Quantity(7.3, text).to(target).magnitude
    assert to_si(f"7.3 {text}", unit, where="x") == pytest.approx(expected, rel=1e-14)


@given(st.integers(1, 999999), st.integers(0, 5))
def test_a_prefix_only_moves_the_decimal_point(digits, places):
    text = f"{digits / 10**places:.{places}f}"
    assert to_si(f"{text} um", "m", where="x") == float(f"{text}e-6")
    assert to_si(f"{text} cP", "Pa*s", where="x") == float(f"{text}e-3")


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("219 cP", "Pa*s"),
        ("0.45 µm", "m"),
        ("10 deg", "rad"),
        ("20 °C", "K"),
        ("12 inch", "m"),
        ("161 %", "1"),
        ("0.5", "1"),
        ("36 Hz", "Hz"),
        ("0.013 1/s", "1/s"),
    ],
)
def test_the_si_unit_of_a_text(text, unit):
    assert si_unit(text, where="x") == unit


@pytest.mark.parametrize("text", ["3 mmm", "three", "3 A"])
def test_a_text_without_a_unit_in_use_is_refused(text):
    with pytest.raises(InputError, match=r"^x: "):
        si_unit(text, where="x")


@pytest.mark.parametrize(
    "path", sorted(Path("examples").glob("*.toml")), ids=lambda path: path.stem
)
def test_an_example_and_its_stored_case_wait_for_no_unit_library(path, monkeypatch):
    monkeypatch.setattr(units, "_registry", lambda: pytest.fail("takes a second to start"))
    Case.from_text(Case.load(path).to_toml(complete=True))
