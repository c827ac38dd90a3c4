"""Each numbered equation of the report is answered by its own name, from one table."""

import re
from importlib import import_module

import pytest
from typer.testing import CliRunner

from underfoot.case.equations import EQUATIONS
from underfoot.case.explanation import equations
from underfoot.cli.app import app

NUMBERS = range(1, 28)
KNOWN = {
    1: "F_N(tot)", 2: "Bowden", 4: "Reynolds", 5: "G(x, y)", 6: "Greenwood", 7: "exp(-beta t)",
    10: "not printed", 13: "0.18 T", 17: "tau_hydro", 18: "7.43", 20: "1 / (2 B)",
    23: "SAE75W-140", 25: "F_lubricated", 26: "alpha + beta", 27: "sensor",
}  # fmt: skip
"""What only that equation has."""


def explained(name):
    shown = CliRunner().invoke(app, ["explain", name])
    assert shown.exit_code == 0, shown.stderr
    return shown.stdout


def test_the_table_has_every_number_once():
    assert list(EQUATIONS) == list(NUMBERS)


@pytest.mark.parametrize("number", NUMBERS)
def test_an_equation_is_explained_by_its_number(number):
    text = explained(f"Eq. {number}")
    assert text.startswith(f"Eq. {number} of the report ({EQUATIONS[number].place}): ")
    assert KNOWN.get(number, "") in text
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.parametrize("number", NUMBERS)
def test_what_computes_an_equation_exists(number):
    for path in EQUATIONS[number].code:
        package, _, name = path.rpartition(".")
        assert callable(getattr(import_module(package), name)), path
    assert EQUATIONS[number].code or number == 10


def test_a_formula_names_the_equations_that_the_table_gives_it():
    from underfoot.film import lambda_ratio
    from underfoot.fluid import glycerol_water_density
    from underfoot.reference import hertz_point

    assert equations(lambda_ratio) == [21]
    # of other papers, whose equations have numbers too
    assert equations(hertz_point) == equations(glycerol_water_density) == []
    assert "not in the report" in explained("glycerol_water_density")


def test_an_equation_that_the_report_has_not_is_refused():
    shown = CliRunner().invoke(app, ["explain", "Eq. 28"])
    assert shown.exit_code == 2
    assert re.search(r"Eq\. 1 to Eq\. 27", shown.stderr)
