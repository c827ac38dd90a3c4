"""Levels have the order of their value, and no order of rows, factors or levels changes a test."""

import numpy as np
import pytest
from test_trials_coded_levels import noted, samples
from test_trials_small_studies import crossed, files_of

from underfoot.trials.recording.protocols import protocol
from underfoot.trials.recording.tester_calibration import written_day
from underfoot.trials.statistics import mixed_model, ordered_levels, rank_test, repeated_measures
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.study import study_of


@pytest.mark.parametrize(
    ("labels", "order"),
    [
        (["3", "1", "2", "3"], ("1", "2", "3")),
        (["10", "9", "-1"], ("-1", "9", "10")),
        (["75 Shore A", "100 Shore A", "45 Shore A"], ("45 Shore A", "75 Shore A", "100 Shore A")),
        (["tile 10", "tile 2"], ("tile 2", "tile 10")),
        (["45 Shore A", "45 Shore D"], ("45 Shore A", "45 Shore D")),
        (["wet", "dry", "wet"], ("wet", "dry")),
        (["2", "new", "1"], ("2", "new", "1")),
        ([], ()),
    ],
)
def test_levels_are_ordered_by_the_one_number_that_they_differ_in(labels, order):
    assert ordered_levels(labels) == order


def test_tables_of_a_study_show_coded_levels_by_value():
    rows = [({**c, "shoe": {"a": "10", "b": "9", "c": "2"}[c["shoe"]]}, *x)
            for c, *x in crossed(6, "abc")]  # fmt: skip
    study = study_of(files_of(rows), protocol("level_walking"))
    table = next(one for one in study.tables if one.name == "conditions")
    assert [row[0] for row in table.rows[:3]] == ["2", "9", "10"]
    tukey = next(one for one in study.findings if one.marks)
    assert [*tukey.marks] == ["2", "9", "10"]


def test_no_order_of_rows_or_factors_changes_a_test():
    random = np.random.default_rng(8)
    cells = [(f"S{i}", shoe, floor) for i in range(9) for shoe in "312" for floor in ("wet", "dry")]
    y = random.normal(0.2, 0.02, len(cells)) + [0.01 * int(shoe) for _, shoe, _ in cells]
    keep = random.random(len(cells)) > 0.1

    def tests(order, names, rows):
        who, *factors = ([cells[i][k] for i in order] for k in range(3))
        own = dict(zip(("shoe", "floor"), factors, strict=True))
        values = [y[i] for i in order]
        made = mixed_model(values, {name: own[name] for name in names}, who).tests
        p = {frozenset(one.term.split(":")): one.p for one in made}
        p["ranks"] = rank_test(values, own["shoe"], who).p
        if len(order) == len(cells):
            whole = repeated_measures(values, {name: own[name] for name in names}, who).rows
            p |= {("whole", frozenset(one.term.split(":"))): one.p for one in whole}
        return p

    for rows in (np.arange(len(cells)), np.flatnonzero(keep)):
        first = tests(rows, ("shoe", "floor"), rows)
        other = tests(random.permutation(rows), ("floor", "shoe"), rows)
        assert first.keys() == other.keys()
        assert all(first[term] == pytest.approx(other[term], rel=1e-5) for term in first)


@pytest.mark.parametrize(
    "text",
    ["2024-03-01", "1.3.2024", "01.03.24", "2024/3/1", "1. 3. 2024", "2024-03-01 10:35",
     "01.03.2024 9:05:10"],
)  # fmt: skip
def test_one_day_is_one_day_however_it_is_written(text):
    assert str(written_day(text)) == "2024-03-01"


@pytest.mark.parametrize("text", ["03/05/2024", "31.2.2024", "1.3", "2024", "", "12.2024", "A"])
def test_what_is_no_day_or_two_is_none(text):
    assert written_day(text) is None


def test_three_spellings_of_a_day_are_one_sample_of_readings(tmp_path):
    days = ["2024-03-01", "1.3.2024", "01.03.24", "2024-03-01", "1.3.2024"]
    rows = [("A", "wet", 96, day, 36) for day in days]
    assert len(samples(tmp_path, "floor,condition,slider,date,PTV", rows)) == 1
    (tmp_path / "readings.csv").unlink()
    assert set(noted(tmp_path, "messdatum", ["1.3.2024", "2024-03-01", "02.03.24"] * 12)) == {
        "2024-03-01", "2024-03-02",
    }  # fmt: skip
    (tmp_path / "conditions.csv").unlink()
    # What is no day stays as it is written.
    assert set(noted(tmp_path, "compound", ["1.2.20", "1.2.21"] * 18)) == {"1.2.20", "1.2.21"}


def test_two_days_of_readings_are_two_samples(tmp_path):
    read = ("1.3.24", 24), ("2.3.24", 48)
    rows = "".join(f"A,wet,96,{day},{ptv + i % 2}\n" for day, ptv in read for i in range(5))
    (tmp_path / "readings.csv").write_text("floor,condition,slider,date,PTV\n" + rows, "utf-8")
    files = analyse_folder(tmp_path, protocol("en_16165_pendulum")).files
    assert {one.conditions["date"]: one.main["ptv"] for one in files} == pytest.approx(
        {"2024-03-01": 24.4, "2024-03-02": 48.4}
    )


def test_coded_levels_and_groups_are_tested_as_other_programs_do():
    """Shoes 1 to 3 on floors 45 and 60: statsmodels, SciPy's Friedman; groups 1 to 3: its F."""
    from pandas import DataFrame
    from scipy.stats import f_oneway, friedmanchisquare
    from statsmodels.stats.anova import AnovaRM

    random = np.random.default_rng(5)
    cells = [
        (f"S{i:02d}", shoe, floor) for i in range(9) for shoe in "312" for floor in ("60", "45")
    ]
    level = dict(
        zip(dict.fromkeys(who for who, *_ in cells), random.normal(0, 0.02, 9), strict=True)
    )
    y = np.array([0.2 + level[who] + 0.004 * int(shoe) for who, shoe, _ in cells])
    y += random.normal(0, 0.008, len(y))
    who, shoe, floor = map(list, zip(*cells, strict=True))
    frame = DataFrame({"y": y, "who": who, "shoe": shoe, "floor": floor})
    theirs = AnovaRM(frame, "y", "who", within=["shoe", "floor"]).fit().anova_table
    ours = mixed_model(y, {"shoe": shoe, "floor": floor}, who).tests
    assert [one.p for one in ours] == pytest.approx(list(theirs["Pr > F"]), rel=1e-5)

    means = frame.groupby(["who", "shoe"], sort=True)["y"].mean().unstack()
    ranked = rank_test(y, shoe, who)
    assert ranked.statistic == pytest.approx(friedmanchisquare(*means.to_numpy().T).statistic)

    group = [str(1 + int(one[1:]) % 3) for one in who]
    frame["group"] = group
    people = frame.groupby(["group", "who"])["y"].mean()
    expected = f_oneway(*(people[one].to_numpy() for one in "123"))
    between = next(one for one in mixed_model(y, {"group": group}, who).tests)
    assert (between.f, between.p) == pytest.approx((expected.statistic, expected.pvalue), rel=1e-5)
