"""All studies in one run: failures, the page, the table in the documentation."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from underfoot.core.errors import Cancelled
from underfoot.document.studies_page import studies_page
from underfoot.studies import g3, summary
from underfoot.studies.figure_list import FIGURES, figure_rows
from underfoot.studies.pin_study import PinLine, PinTable
from underfoot.studies.registry import STUDIES, study
from underfoot.studies.study_result import StudyResult
from underfoot.studies.verdict import Erratum, Verdict

ROOT = Path(__file__).parents[2]


def result(name):
    line = PinLine(
        "a share", "G.9", "7 to 27 %", "20 to 30 %", Verdict.WITHIN_SCATTER, "so <it> is"
    )
    table = PinTable("t", "A table", ("x", "y"), (("a", 1.5), ("b", None)))
    erratum = Erratum("here", "1", "2", "because")
    return StudyResult(
        name, (line,), (table,), ("it holds",), (erratum,), ("n",), ("as",), 1.0, 1.0
    )


@pytest.fixture
def one_fails(monkeypatch):
    def run(one, **_):
        if one.name == "g2":
            raise ValueError("broken on purpose")
        return result(one.name)

    monkeypatch.setattr(summary, "run_study", run)


def test_a_failing_study_is_said_and_does_not_stop_the_rest(one_fails):
    runs = summary.run_all(quick=True)
    assert [run.study.name for run in runs] == [one.name for one in STUDIES]
    assert [run.study.name for run in runs if run.error] == ["g2"]
    text = summary.summary_markdown(runs)
    assert "Failed: ValueError: broken on purpose" in text
    assert "| a share (G.9) | 7 to 27 % | 20 to 30 % | +3 points | within scatter |" in text


def test_cancelling_stops(monkeypatch):
    def progress(stage, fraction, residual=None):
        if stage.startswith("g3"):
            raise Cancelled("stopped")

    monkeypatch.setattr(summary, "run_study", lambda one, **_: result(one.name))
    with pytest.raises(Cancelled):
        summary.run_all(progress=progress)


def test_the_page_holds_everything_and_needs_no_network(one_fails, tmp_path):
    runs = summary.run_all()
    lines = summary.summary_lines(runs)
    page = studies_page(
        runs, lines, counts=summary.verdict_counts(lines),
        rules={str(v): v.rule for v in Verdict}, figures=figure_rows({"g1": ["fig03_history"]}),
        remarks={}, images={("g1", "fig03_history"): b"\x89PNG"}, quick=True,
    )  # fmt: skip
    assert not re.search(r"(src|href)=[\"']https?:", page)
    assert "broken on purpose" in page
    assert "so &lt;it&gt; is" in page
    assert "data:image/png" in page
    assert "g1/fig03_history" in page
    summary.write_summary(runs, tmp_path)
    table = (tmp_path / "summary.csv").read_text(encoding="utf-8-sig").splitlines()
    assert len(table) == len(STUDIES)  # the head, and one line of each but the failed one
    assert table[0].startswith("study,source,quantity,printed,ours,difference,verdict,reason")


@pytest.mark.parametrize(
    ("printed", "ours", "wanted"),
    [
        ("7 to 27 %", "10 to 20 %", "inside"),
        ("7 to 27 %", "0 to 30 %", "-7 and +3 points"),
        ("234 kPa", "200 kPa", "-34 kPa"),
        ("0.49", "0.5", "+0.01"),
        ("234 kPa", "201 N", ""),
        ("least in water", "1", ""),
        ("< 5", "3", ""),
    ],
)
def test_differences_of_ranges(printed, ours, wanted):
    assert summary.range_difference(printed, ours) == wanted


def test_every_wanted_figure_is_in_the_list():
    wanted = {3, *range(5, 12), 14, 15, *range(16, 21), *range(22, 26), 29, 30, *range(32, 38)}
    assert wanted <= {one.number for one in FIGURES}
    assert all(one.file or one.remark for one in FIGURES)
    assert {one.study for one in FIGURES} <= {one.name for one in STUDIES}


def documented():
    """Rows of docs/studies/summary.md: statement -> (printed, ours, verdict)."""
    rows = {}
    for line in (ROOT / "docs/studies/summary.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if len(cells) == 6:
            rows[cells[0]] = cells[1:5]
    return rows


def test_the_documented_table_agrees_with_a_fresh_computation():
    rows = documented()
    fresh = summary.summary_lines([summary.StudyRun(study("g3"), g3.run(), "", 0, 0)])
    assert len(fresh) > 5
    for one in fresh:
        printed, ours, difference, verdict = rows[f"{one.quantity} ({one.source})"]
        assert (printed, ours, verdict) == (one.printed, one.ours, one.verdict)
        assert difference == one.difference
    from underfoot.studies.calibration import _decay_lines
    from underfoot.studies.g6_people import population_risk, risk_by_rcof

    for line in _decay_lines():
        assert rows[f"{line.quantity} ({line.source})"][1] == line.ours
    lowest, middle, highest = risk_by_rcof()
    ours = rows["risk at the lowest, median and highest RCOF (G.6.2)"][1]
    assert ours == f"{100 * lowest:.0f}, {100 * middle:.0f}, {100 * highest:.0f} %"
    hard = next(v for k, v in rows.items() if k.startswith("slip risk, hard outsole"))
    assert hard[1].startswith(f"{100 * population_risk(0.159)['report_g6']:.0f} %")


def studies(*arguments):
    return subprocess.run(
        [sys.executable, "-c", "from underfoot.cli import main; main()", "studies", *arguments],
        capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"}, check=False,
    )  # fmt: skip


def test_the_list_names_all_and_wrong_names_are_refused():
    found = studies("list")
    assert found.returncode == 0
    assert all(one.name in found.stdout for one in STUDIES)
    wrong = studies("run", "g9")
    assert wrong.returncode == 2
    assert "g" in wrong.stderr
    assert "Traceback" not in wrong.stderr
    explicit = studies("run", "all", "--explicit")
    assert explicit.returncode == 2
    assert "--explicit" in explicit.stderr
