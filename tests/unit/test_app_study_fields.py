"""The study form reads what people type: right, asked, or refused at its field."""

import pytest

from underfoot.app.pages.studies import SEPARATOR, typed_value
from underfoot.core import InputError

VISCOSITY, HARDNESS, DEPTH = "contaminant.viscosity", "shoe.material.shore_a", "shoe.tread.depth"


@pytest.mark.parametrize(
    ("text", "path", "comma", "said"),
    [
        ("41,5 cP", VISCOSITY, False, "41.5 cP"),
        ("41,5 cP", VISCOSITY, True, "41.5 cP"),
        ("1.234,5 cP", VISCOSITY, False, "1234.5 cP"),
        ("1,234 cP", VISCOSITY, True, "1.234 cP"),
        ("62,5", HARDNESS, False, 62.5),
        ("62", HARDNESS, True, 62),
        ("1 1/2 in", DEPTH, False, "1.5 in"),
        ("canola_oil", "contaminant", False, "canola_oil"),
        ("hexagons", "shoe.tread.pattern", True, "hexagons"),
    ],
)
def test_what_is_typed_is_what_the_file_says(text, path, comma, said):
    assert typed_value(text, path, comma=comma, names=True) == said


@pytest.mark.parametrize(
    "text", ["", "abc", "1 cP 2 cP", "1e400 cP", "NaN", "3 mm", "41.5", "1,2,3"]
)
def test_what_is_no_viscosity_is_refused(text):
    with pytest.raises(InputError):
        typed_value(text, VISCOSITY, comma=False, names=True)


@pytest.mark.parametrize("text", ["", "abc", "62 63", "1e400", "NaN", "3 mm"])
def test_what_is_no_number_is_refused_where_one_stands(text):
    with pytest.raises(InputError):
        typed_value(text, HARDNESS, comma=False)


def test_what_can_be_two_numbers_is_asked_in_the_language_of_the_page():
    for text, comma in (("1.234 cP", True), ("1,234 cP", False)):
        with pytest.raises(InputError, match="can be"):
            typed_value(text, VISCOSITY, comma=comma)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("41,5 cP; 219 cP", ["41,5 cP", "219 cP"]),
        ("41 cP, 219 cP", ["41 cP", "219 cP"]),
        ("62,5", ["62,5"]),
        ("canola_oil,detergent", ["canola_oil", "detergent"]),
        ("41 cP,219 cP", ["41 cP", "219 cP"]),
    ],
)
def test_a_comma_between_digits_belongs_to_a_number(text, parts):
    assert SEPARATOR.split(text) == parts
