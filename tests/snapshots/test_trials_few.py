"""The fewest lines, trials and samples that are enough, and one less: readers, tests, sentences."""

from types import SimpleNamespace

import numpy as np
import pytest

from recording_texts import TEXTS, changes, read_lines
from snapshot import held
from underfoot.trials.pages import report
from underfoot.trials.readers.seen import _steps
from underfoot.trials.readers.text import rate_of
from underfoot.trials.study import study_tests
from underfoot.trials.study.file_result import FileResult, Number
from underfoot.trials.study.study_tests import columns_of, persons_of, slip_findings, varying

KINDS = sorted(TEXTS)


@pytest.mark.parametrize("part", range(3))
def test_exports_of_a_few_lines(part, tmp_path, file_regression):
    """Each export cut after one line, two lines and so on: what is read, or why nothing."""
    answers = {}
    for name in KINDS[part::3]:
        lines = TEXTS[name]().split("\n")
        last = ""
        for count in range(1, min(len(lines), 13)):
            made = changes({}, read_lines(tmp_path, name, "\n".join(lines[:count])), most=2)[:160]
            if made != last:
                answers[f"{name} {count}"] = made
            last = made
    held(file_regression, answers, f"few lines {part}")


def file(name, curves=None, **main):
    conditions = {key: main.pop(key) for key in ("shoe", "person") if key in main}
    numbers = tuple(Number(key, value, main=key) for key, value in main.items())
    return FileResult(name, numbers=numbers, conditions=conditions, curves=curves or {})


def slipping(count, **more):
    rng = np.random.default_rng(3)
    x = 0.2 + 0.1 * rng.random(count)
    y = (x + 0.05 * rng.normal(size=count) < 0.25).astype(float)
    return [file(f"f{n}", rcof=float(x[n]), slip=float(y[n]), **more) for n in range(count)]


def names(findings):
    return [one.name for one in findings]


def test_a_logistic_regression_needs_eight_trials():
    assert study_tests._logistic(slipping(7), "") == ([], [])
    found, (curve,) = study_tests._logistic(slipping(8), "")
    assert names(found)[0] == "logistic_rcof"
    x = np.array(curve["x"])
    reach = 0.1 * np.ptp(x)
    assert (curve["grid"][0], curve["grid"][-1]) == pytest.approx(
        (x.min() - reach, x.max() + reach)
    )
    assert (len(curve["grid"]), curve["name"], len(curve["y"])) == (121, "rcof", 8)
    assert [row[0] for row in found[0].table.rows] == ["maximum likelihood", "firth"]


def test_t_tests_need_two_of_each():
    def files(first, second):
        groups = [("a", first), ("b", second)]
        return [file(f"{shoe}{n}", rcof=0.2 + 0.01 * n + 0.05 * (shoe == "b"), shoe=shoe)
                for shoe, count in groups for n in range(count)]  # fmt: skip

    assert study_tests._t_tests(files(1, 5), "shoe", ["a", "b"], "") == []
    (found,) = study_tests._t_tests(files(2, 5), "shoe", ["a", "b"], "")
    assert len(found.table.rows) == 2
    assert found.table.rows[0][2] == pytest.approx(0.205 - 0.27)
    assert found.table.rows[1][-1] is None
    assert found.table.rows[0][-1] == pytest.approx(found.table.rows[0][-2])


def test_subsets_need_twelve_passages_of_slips():
    def files(count, slip=1.0):
        rng = np.random.default_rng(4)
        rows = [{"pressure": 1e3 * (1 + rng.random()), "ml": rng.normal(), "irss": rng.random(),
                 "row": n % 3 + 1} for n in range(count)]  # fmt: skip
        return [file("a", {"sensor_rows": rows}, slip=slip)]

    assert study_tests._subsets(files(11)) == []
    assert study_tests._subsets(files(40, 0.0)) == []
    (found,) = study_tests._subsets(files(12))
    assert {row[4] for row in found.table.rows} == {12}
    assert len(found.table.rows) == 14


def test_a_line_takes_trials_that_crossed_the_sensors():
    files = [file(f"f{n}", peak_pressure=1e3 * n, peak_slipping_speed=0.2 * n + 0.01 * (-1) ** n,
                  crossed_array=float(n != 3)) for n in range(8)]  # fmt: skip
    files.append(file("other", peak_pressure=5.0))
    curves = {}
    found = study_tests._line(files, curves, "")
    assert found.table.rows[0][-1] == 7
    assert curves["line"]["slope"] == pytest.approx(0.2, rel=0.02)
    assert curves["line"]["x"] == [0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0]


def test_factors_that_can_be_compared():
    factors = {"shoe": ["a", "a", "b"], "floor": ["x"] * 3, "date": ["1", "2", "3"], "none": []}
    kept, left = varying("rcof", factors)
    assert list(kept) == ["shoe"]
    told = [str(one) for one in left]
    assert len(told) == 3
    assert 'at one value only, "x"' in told[0]
    assert "once at each value" in told[1]
    assert "nowhere" in told[2]
    kept, left = varying("rcof", {"own": ["a", "a", "b", "b"]}, ["P", "P", "Q", "Q"])
    assert (kept, "one of their own" in str(left[0])) == ({}, True)
    files = [file("a", shoe="x", person="P"), file("b", shoe="y")]
    assert columns_of(files, ("shoe", "person")) == {"shoe": ["x", "y"]}
    assert persons_of(files, "person") == ("P", "b")
    assert persons_of(files, "") == ()


def test_slips_near_their_limit_are_counted():
    def said(*margins, **more):
        files = [
            file(f"f{n}", slip=float(m > 0), slip_margin=m, **more) for n, m in enumerate(margins)
        ]
        return str(report._slips(files))

    assert said(0.3, -0.2) == "1 slip in 2 trials (50 %)"
    assert "1 of them within 0.05 m/s" in said(0.049, -0.2)
    assert "2 of them" in said(0.049, -0.049, 0.051)
    assert "within" not in said(0.051, -0.051)
    assert said(0.3, 0.3, -0.3, rcof=0.2).endswith("; required friction 0.20 to 0.20")
    assert str(report._slips([file("a")])).startswith("0 slips in 0 trials")
    assert [str(report._count_text(n, "files")) for n in (0, 1, 2)] == [
        "0 files",
        "1 file",
        "2 files",
    ]
    assert report._places(SimpleNamespace(decimals=None)) == 3
    assert report._places(SimpleNamespace(decimals=2)) == 2


def test_which_tests_a_protocol_asks_for():
    files = [file(f"f{n}", slip=float(n % 3 == 0), rcof=0.2 + 0.01 * (n % 5) + 0.02 * (n % 2),
                  shoe="ab"[n % 2]) for n in range(20)]  # fmt: skip

    def asked(*wanted, **numbers):
        protocol = SimpleNamespace(
            texts=lambda key: wanted if key == "tests" else (), text=lambda _: "",
            number=lambda key, unit, usual: numbers.get(key, usual),
        )  # fmt: skip
        found, curves = slip_findings(files, protocol, ("shoe",))  # pyright: ignore[reportArgumentType]
        return names(found), sorted(curves)

    assert asked() == (["t_shoe"], [])
    assert asked("anova")[0][0].startswith("anova_rcof")
    assert "t_shoe" not in asked("anova")[0]
    assert "fisher_shoe" in asked("fisher")[0]
    assert asked("logistic")[1] == ["risk"]
    assert "line" in asked("line")[0]
    assert any("equivalence" in one for one in asked("anova", equivalence=0.02)[0])


def test_times_are_even_up_to_a_tenth_of_a_step():
    """Rounded stamps are even, with the mean rate; a wider scatter keeps its times."""
    grid = 0.01 * np.arange(101)
    for off, even in ((0.09, True), (0.11, False), (0.19, False)):
        times = grid.copy()
        times[50] += off * 0.01
        rate, start, kept = rate_of(times, "a file")
        assert (rate, start) == (pytest.approx(100.0), 0.0)
        assert (kept is None) is even


def test_a_path_of_one_frame_has_no_step():
    assert _steps(np.zeros((1, 3))).shape == (0,)
    assert _steps(np.array([[0.0, 0.0, 0.0], [1.0, -3.0, 2.0]])).tolist() == [3.0]
