"""The run sheet of a test: complete, in blocks, in an order that the seed fixes."""

import csv
import io
from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from underfoot.cli.app import app
from underfoot.core import InputError
from underfoot.trials.study.run_sheet import factors_from, run_sheet

FACTORS = {"shoe": ("A", "B", "C"), "fluid": ("dry", "water")}


@given(
    levels=st.lists(st.integers(2, 4), min_size=1, max_size=3),
    repeats=st.integers(1, 4),
    seed=st.integers(0, 99),
)
def test_every_combination_stands_once_in_each_block(levels, repeats, seed):
    factors = {f"f{k}": tuple(f"{i}" for i in range(n)) for k, n in enumerate(levels)}
    sheet = run_sheet(factors, repeats=repeats, seed=seed)
    combinations = len(sheet.runs) // repeats
    for block in range(repeats):
        part = sheet.runs[block * combinations : (block + 1) * combinations]
        assert {run["repeat"] for run in part} == {str(block + 1)}
        assert len({tuple(run.values()) for run in part}) == combinations


def test_the_order_is_random_and_the_seeds_own():
    first, again, other = (run_sheet(FACTORS, repeats=9, seed=seed).runs for seed in (1, 1, 2))
    assert first == again != other
    assert len({first[6 * k]["shoe"] + first[6 * k]["fluid"] for k in range(9)}) > 1
    # each combination comes first in a block about as often: 6 of 600 blocks, chi-squared
    starts = Counter(tuple(run_sheet(FACTORS, seed=seed).runs[0].values()) for seed in range(600))
    assert sum((n - 100) ** 2 / 100 for n in starts.values()) < 20.5  # 0.999 of 5 degrees


def test_what_is_slow_to_change_stays_together():
    sheet = run_sheet(FACTORS, repeats=4, together="fluid", seed=3)
    for block in range(4):
        fluids = [run["fluid"] for run in sheet.runs[6 * block : 6 * block + 6]]
        assert fluids in (["dry"] * 3 + ["water"] * 3, ["water"] * 3 + ["dry"] * 3)
    persons = run_sheet({"subject": ("1", "2", "3"), **FACTORS}, blocks="subject", seed=1)
    assert [len({r["subject"] for r in persons.runs[6 * k : 6 * k + 6]}) for k in range(3)] == [
        1
    ] * 3


@pytest.mark.parametrize(
    ("texts", "options", "word"),
    [
        (["shoe"], {}, "shoe=A,B"),
        (["shoe=A"], {}, "two levels"),
        (["shoe=A,A"], {}, "two levels"),
        (["run=A,B"], {}, "column"),
        (["shoe=A,B", "shoe=C,D"], {}, "each once"),
        (["shoe=A,B"], {"blocks": "floor"}, "shoe, repeat"),
        (["shoe=A,B"], {"repeats": 0}, "1 or more"),
        (["shoe=A,B"], {"repeats": 9999}, "10000"),
    ],
)
def test_a_plan_that_is_none_is_refused(texts, options, word):
    with pytest.raises(InputError, match=word):
        run_sheet(factors_from(texts), **options)


def test_the_sheet_is_the_conditions_of_the_analysis(tmp_path):
    from underfoot.trials.study.conditions import conditions_of

    out = tmp_path / "conditions.csv"
    given = ["trials", "plan", "shoe=A,B", "fluid=dry,water", "--repeats", "2", "--out", str(out)]
    shown = CliRunner().invoke(app, given)
    assert shown.exit_code == 0, shown.stderr
    assert "8 runs" in shown.stderr
    rows = list(csv.DictReader(io.StringIO(out.read_text())))
    assert rows[0]["file"] == "run_1.csv"
    noted = conditions_of(tmp_path)
    assert len(noted) == 8
    assert {own["fluid"] for own in noted.values()} == {"dry", "water"}
