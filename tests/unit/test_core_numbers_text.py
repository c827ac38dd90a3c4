"""Numbers in every way people write them; what can be read two ways is asked."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.core import DataError
from underfoot.core.numbers_text import number_forms
from underfoot.core.text import cells_of


def read(*columns: list[str]) -> list[list[float]]:
    forms = number_forms(columns, "here")
    return [
        [form.number(cell) for cell in cells] for form, cells in zip(forms, columns, strict=True)
    ]


def written(value: float, digits: int, decimal: str, mark: str) -> str:
    return f"{value:,.{digits}f}".replace(",", "\0").replace(".", decimal).replace("\0", mark)


@given(
    st.lists(st.floats(-1e7, 1e7), min_size=3, max_size=20),
    st.sampled_from([".", ","]),
    st.sampled_from(["", "'", "’", *" \u00a0\u2007\u2009\u200a\u202f\u3000", ".", ","]),
    st.integers(1, 6),
)
def test_a_table_gives_its_numbers_whatever_its_marks(values, decimal, mark, digits):
    mark = "" if mark == decimal else mark
    values = [round(value, digits) for value in values]
    # what no file can be read without: one number that shows what its marks are
    shown = [*values, 0.5]
    cells = [written(value, digits, decimal, mark) for value in shown]
    whole = [written(round(value), 0, decimal, mark) for value in shown]
    found = read(cells, whole)
    assert found[0] == pytest.approx(shown)
    assert found[1] == pytest.approx([round(value) for value in shown])


@pytest.mark.parametrize(
    ("columns", "values"),
    [
        ([["0.001"], ["1,075"]], [[0.001], [1075.0]]),
        ([["0", "1"], ["1,075", "998"]], [[0, 1], [1075, 998]]),
        ([["0,5"], ["1.075"]], [[0.5], [1075]]),
        ([["1,075", "1234"]], [[1.075, 1234]]),
        ([["1.075", "998"]], [[1.075, 998]]),
        ([["1,075", "2,5"]], [[1.075, 2.5]]),
        ([["1,075,200"]], [[1075200.0]]),
        ([["−1.5D+03", "1e-3"]], [[-1500.0, 1e-3]]),
    ],
)
def test_what_decides(columns, values):
    assert read(*columns) == values


@pytest.mark.parametrize(
    "columns",
    [[["1,281", "2,137"]], [["1,5", "1.5"]], [["1,5", "1,234,567"]], [["0.5"], ["1,075", "1234"]]],
)
def test_what_nothing_decides_is_asked(columns):
    with pytest.raises(DataError, match="decimal point"):
        read(*columns)


def test_quotes_keep_their_commas():
    assert cells_of('"0,5","1,5"', ",") == ["0,5", "1,5"]
    assert cells_of("f,E',E\" (MPa)", ",") == ["f", "E'", 'E" (MPa)']
    assert cells_of('"x [mm]" G"', None) == ["x [mm]", 'G"']
