"""Mixed models against R: lme4's fit with the tests of pbkrtest, by tests/data/mixed_models."""

import csv
import io
import re
import runpy
import shutil
import subprocess
from collections import defaultdict
from contextlib import redirect_stdout
from pathlib import Path
from warnings import catch_warnings

import numpy as np
import pytest
from benchmarks.type_one_errors import DESIGNS, Design, shares

from underfoot.core import DataError
from underfoot.trials.statistics import (
    analysis_of_variance,
    letters,
    mixed_model,
    repeated_measures,
    told_apart,
    tukey_hsd,
)
from underfoot.trials.study.model_scripts import model_files

DATA = Path(__file__).parents[1] / "data" / "mixed_models"


def stored(name):
    rows = defaultdict(list)
    with (DATA / name).open(newline="") as stream:
        for row in csv.DictReader(stream):
            rows[row["study"]].append(row)
    return rows


@pytest.mark.parametrize("name", list(stored("tests.csv")))
def test_f_and_degrees_of_freedom_are_those_of_pbkrtest(name):
    rows = stored("trials.csv")[name]
    columns = {key: [row[key] for row in rows] for key in ("shoe", "floor", "side", "group")}
    factors = {key: column for key, column in columns.items() if len(set(column)) > 1}
    model = mixed_model([float(row["y"]) for row in rows], factors, [row["person"] for row in rows])
    found = {test.term: test for test in model.tests}
    expected = stored("tests.csv")[name]
    assert len(found) == len(expected)
    for row in expected:
        test = found[":".join(sorted(row["term"].split(":"), key=list(factors).index))]
        assert test.df == int(row["df"])
        assert test.error_df == pytest.approx(float(row["error_df"]), rel=1e-5)
        assert test.f == pytest.approx(float(row["f"]), rel=1e-5)
        assert test.p == pytest.approx(float(row["p"]), rel=1e-5)


def study(seed=1, own=1.0):
    return Design("", 9, (3, 2, 2), own, trials=2).study(np.random.default_rng(seed))


def test_complete_data_are_repeated_measures_in_every_term():
    """Also where a variance is below zero, which seed and size bring about."""
    from pandas import DataFrame
    from statsmodels.stats.anova import AnovaRM

    y, factors, who = study()
    model, repeated = mixed_model(y, factors, who), repeated_measures(y, factors, who)
    assert min(model.variances.values()) < 0
    frame = DataFrame({"y": y, "who": who, **factors})
    table = AnovaRM(frame, "y", "who", within=list(factors), aggregate_func="mean").fit()
    for one, other, (term, row) in zip(
        model.tests, repeated.rows, table.anova_table.iterrows(), strict=True
    ):
        assert one.term == other.term == str(term)
        expected = [row["F Value"], row["Den DF"], row["Pr > F"]]
        assert [one.f, one.error_df, one.p] == pytest.approx(expected, rel=1e-6)
        assert [other.f, other.error_df, other.p] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("persons", "shoes"), [(2, 3), (2, 5), (3, 3), (4, 3), (5, 2), (3, 5)])
def test_few_persons_are_repeated_measures_too(persons, shoes):
    """At two and at four degrees of freedom parts of Kenward and Roger's expansion vanish."""
    y, factors, who = Design("", persons, (shoes,), 1.0, trials=3).study(np.random.default_rng(2))
    one, other = mixed_model(y, factors, who).tests[0], repeated_measures(y, factors, who).rows[0]
    assert other.error_df == (persons - 1) * (shoes - 1)
    expected = pytest.approx([other.f, other.error_df, other.p], rel=1e-5)
    assert [one.f, one.error_df, one.p] == expected


def test_epsilon_of_each_term_is_that_of_its_own_contrasts():
    """Of one factor alone: Greenhouse and Geisser's formula on the double-centred covariance."""
    y, factors, who = study()
    repeated = repeated_measures(y, factors, who)
    cube = np.reshape(y, (9, 3, 2, 2, 2)).mean(axis=(2, 3, 4))
    middle = np.eye(3) - 1 / 3
    inner = middle @ np.cov(cube.T) @ middle
    assert repeated.epsilon[0] == pytest.approx(np.trace(inner) ** 2 / (2 * np.sum(inner**2)))
    assert repeated.epsilon[1] == 1.0
    alone = repeated_measures(y, {"shoe": factors["shoe"]}, who)
    assert alone.epsilon[0] == pytest.approx(repeated.epsilon[0])


def test_meaningless_columns_leave_the_p_of_others_alone():
    rng = np.random.default_rng(4)
    plain = Design("", 10, (3,), 1.0, trials=4)
    y, factors, who = plain.study(rng)
    alone = mixed_model(y, factors, who).tests[0]
    crossed = {"a": ["x", "x", "y", "y"] * 30, "b": ["l", "r"] * 60}
    more = mixed_model(y, {**factors, **crossed}, who).tests[0]
    assert (more.f, more.error_df, more.p) == pytest.approx((alone.f, alone.error_df, alone.p))
    same = letters(tukey_hsd(mixed_model(y, {**factors, **crossed}, who), "shoe"))
    assert same == letters(tukey_hsd(mixed_model(y, factors, who), "shoe"))


@pytest.mark.parametrize("factor", [1e-8, 1e8])
def test_p_is_the_same_in_another_unit(factor):
    y, factors, who = study()
    one, other = mixed_model(y, factors, who).tests, mixed_model(factor * y, factors, who).tests
    assert [test.p for test in one] == pytest.approx([test.p for test in other], rel=1e-6)


@pytest.mark.study
def test_one_in_twenty_is_found_where_there_is_nothing():
    """Of 600 studies each: within four standard errors.

    Of complete data the tests above say more: there they are the classical ones.
    """
    for number, design in enumerate(DESIGNS):
        complete = not design.missing and not design.label
        if complete or design.persons * np.prod(design.levels) > 80:
            continue
        told = shares(design, 600, number)
        assert told.pop("not done") < 0.02
        assert all(0.015 < share < 0.086 for share in told.values()), (design, told)


def test_conditions_that_say_the_same_are_named():
    shoe = ["a", "b", "c"] * 4
    date = ["1", "2", "3"] * 4
    brand = ["x", "x", "y"] * 4
    person = [who for who in "pqrs" for _ in range(3)]
    sex = ["m" if who in "pq" else "f" for who in person]
    kept, left = told_apart({"date": date, "shoe": shoe, "brand": brand, "sex": sex}, person,
                            last=("date",))  # fmt: skip
    assert list(kept) == ["shoe", "sex"]
    assert {(one.factor, one.others, one.same) for one in left} == {
        ("brand", ("shoe",), False), ("date", ("shoe",), True)
    }  # fmt: skip
    kept, left = told_apart({"shoe": shoe, "initials": person}, person)
    assert (list(kept), left[0].others) == (["shoe"], ())
    assert str(left[0]).startswith('"initials" can\'t be told from the persons')
    with pytest.raises(DataError, match="told apart"):
        mixed_model(np.arange(12.0), {"shoe": shoe, "date": date}, person, ("shoe", "date"))


@pytest.mark.parametrize(
    ("y", "who"),
    [
        ([1.0, 2.0, 3.0], ["p"] * 3),  # one person, one trial a shoe
        ([1.0] * 6, ["p"] * 3 + ["q"] * 3),  # all the same
        ([1.0, 2.0, 3.0, 1.5, 2.5, 3.5], ["p"] * 3 + ["q"] * 3),  # persons react all alike
    ],
)
def test_what_can_not_be_told_is_refused_with_the_reason(y, who):
    with pytest.raises(DataError, match=r"scatter|constant|estimate"):
        mixed_model(y, {"shoe": ["a", "b", "c"] * (len(y) // 3)}, who)


def test_plain_analysis_says_when_columns_depend():
    y = np.random.default_rng(0).normal(size=12)
    table = analysis_of_variance(y, {"a": ["x", "y"] * 6, "b": ["u", "v"] * 6}, ("a", "b"))
    assert table.model.dependent


def scripts(folder, rows, shoe="shoe"):
    """Write data and scripts of the model of ``rows``, the shoe under another name; return it."""
    columns = {key: [row[key] for row in rows] for key in ("shoe", "floor", "side", "group")}
    factors = {shoe if key == "shoe" else key: column
               for key, column in columns.items() if len(set(column)) > 1}  # fmt: skip
    values, persons = [float(row["y"]) for row in rows], [row["person"] for row in rows]
    model = mixed_model(values, factors, persons)
    made = model_files("mixed_rcof", "Mixed model", model, "RCOF (1)", values, factors, persons)
    for name, text in made.items():
        (folder / name).write_text(text, encoding="utf-8")
    return model


@pytest.mark.parametrize("name", list(stored("tests.csv")))
def test_the_script_of_python_finds_the_numbers_again(tmp_path, name):
    model = scripts(tmp_path, stored("trials.csv")[name], "1st shoe's sole")
    told = io.StringIO()  # in this process: statsmodels takes two seconds to load
    with catch_warnings(action="ignore"), redirect_stdout(told):
        runpy.run_path(str(tmp_path / "mixed_rcof.py"), run_name="__main__")
    for line, row in zip(told.getvalue().splitlines()[1:], model.tests, strict=True):
        found = re.search(r"F\((.+), (.+)\) = (.+), p = (.+)", line)
        expected = [row.df, row.error_df, row.f, row.p]
        assert [float(one) for one in found.groups()] == pytest.approx(expected, rel=1e-3)


@pytest.mark.skipif(shutil.which("Rscript") is None, reason="R is not installed")
@pytest.mark.parametrize("name", list(stored("tests.csv")))
def test_the_script_of_r_finds_the_numbers_again(tmp_path, name):
    model = scripts(tmp_path, stored("trials.csv")[name])
    told = subprocess.run(["Rscript", "mixed_rcof.R"], cwd=tmp_path, check=True, text=True,
                          capture_output=True).stdout  # fmt: skip
    # term, sum and mean of squares, two degrees of freedom, F
    found = {line[0]: [float(one) for one in line[3:6]]
             for line in map(str.split, told.partition("Analysis of Variance")[2].splitlines())
             if len(line) > 6 and line[1][0].isdigit()}  # fmt: skip
    for row in model.tests:
        expected = [row.df, row.error_df, row.f]
        assert found[row.term] == pytest.approx(expected, rel=2e-3, abs=1e-4), row.term
