"""docs/studies/report.md: rows, sentences and equations, each with what shows it."""

import re
from functools import cache
from pathlib import Path

import pytest

from positive_bounds import bounds_below_zero
from underfoot.case.equations import EQUATIONS
from underfoot.core.catalogue import Catalogue
from underfoot.studies import report_ledger, studies, study
from underfoot.trials.recording.protocols import protocol

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "studies"
ROWS = report_ledger.rows()
STATEMENTS = {one.name for name in studies() for one in study(name).statements}
FIGURES = {
    number: (file, remark) for name in studies() for number, _, file, remark in study(name).figures
}
ERRATA = {where for name in studies() for where, *_ in study(name).errata}


@cache
def all_commands():
    from typer.main import get_command

    from underfoot.cli.app import app

    return get_command(app)


def command_exists(words):
    group = all_commands()
    for word in words.split():
        group = group.get_command(None, word)
        if group is None:
            return False
    return True


def exists(kind, name):
    if kind == "eq":
        return int(name) in EQUATIONS
    if kind == "statement":
        return name in STATEMENTS
    if kind == "figure":
        return bool(FIGURES[int(name)][0])
    if kind == "test":
        return (ROOT / name).is_file()
    if kind == "command":
        return command_exists(name)
    if kind == "entry":
        return any(entry == name for _, entry in Catalogue.load().entries)
    if kind == "protocol":
        return protocol(name) is not None
    return kind == "erratum" and name in ERRATA


def test_all_rows_of_the_report_are_there_once():
    assert [row.number for row in ROWS] == [
        *map(str, range(1, 82)), "81b", *map(str, range(82, 97))
    ]  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.number)
def test_a_row_has_what_shows_it_and_a_cause_where_it_falls_short(row):
    assert row.evidence
    for kind, name in row.evidence:
        assert exists(kind, name), f"{kind} {name}"
    assert (row.rating == "works") == (not row.cause)
    for command in re.findall(r"underfoot ((?:[a-z]+ ?)+)", row.how):
        first = command.split()[0]
        assert command_exists(first), row.how


def test_ninety_rows_work_and_every_other_has_its_cause():
    assert sum(row.rating == "works" for row in ROWS) >= 90


@pytest.mark.slow
def test_each_sentence_of_the_conclusions_is_judged():
    told = report_ledger.sentences()
    assert len(told) == 14
    for one in told:
        assert one.stands in report_ledger.STANDS
        assert one.finds
        assert one.why
        for name in re.findall(r"\bg\d\.\w+", one.sources):
            assert name in STATEMENTS, name
        if one.stands != "with":
            assert one.decides != "-", one.text


def test_the_numbers_say_what_the_sentences_say():
    """Signs that the text claims, read from the law as it is."""
    n = report_ledger.default_numbers()
    assert n["oil_soft"] > n["oil_hard"]
    assert n["oil_smooth"] == pytest.approx(n["oil_rough"], rel=0.02)
    assert n["oil_floor_rough"] > 1.2 * n["oil_floor_smooth"]
    assert n["dry_soft_smooth"] > 2 * n["dry_hard_rough"]
    assert n["water_rough"] > 2 * n["water_smooth"]
    assert n["water_light"] == pytest.approx(n["water_heavy"], rel=0.02)
    assert n["adhesion_hard"] > n["adhesion_soft"] > n["adhesion_pu"]
    assert n["adhesion_soft"] == pytest.approx(9.86, rel=0.02)
    assert n["glycerol_hard"] < n["glycerol_soft"] < 1.1 * n["glycerol_hard"]
    assert n["lambda_canola"] == pytest.approx(3.07, abs=0.01)


def test_the_page_is_what_the_command_writes():
    text = (FOLDER / "summary.md").read_text(encoding="utf-8")
    verdicts = report_ledger.summary_verdicts(text)
    assert (FOLDER / "report.md").read_text(encoding="utf-8") == report_ledger.markdown(verdicts)


PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def test_no_interval_of_a_positive_quantity_goes_below_zero(tmp_path):
    """In any page of the documentation; conftest.py reads those that tests make."""
    assert len(PAGES) > 50
    found = [line for page in PAGES for line in bounds_below_zero(page)]
    assert not found, found
    page = tmp_path / "page.md"
    page.write_text("| COF of the pair | 0.167 (-0.102 to 0.436) |", encoding="utf-8")
    assert len(bounds_below_zero(page)) == 1
    page = page.rename(tmp_path / "page.html")
    page.write_text("<tr><td>slip distance<td>54 mm (\u221291 to 199)</tr>", encoding="utf-8")
    assert len(bounds_below_zero(page)) == 1
    head = "<tr><th>speed</th><th>95 % low</th></tr>"
    page.write_text(f"<table>{head}<tr><td>peak</td><td>-0.38</td></tr></table>", encoding="utf-8")
    assert len(bounds_below_zero(page)) == 1
    page.unlink()
