"""Lines on a terminal by rules of their own: what is cut, what is left out, what fits."""

import io
from types import SimpleNamespace
from typing import Any, cast

import pytest
import typer
from rich.console import Console

from underfoot.cli.output import (
    LONGEST_PATH,
    LONGEST_VALUE,
    MOST_ROWS,
    _print_blocks,
    _print_records,
    _say_rest,
    narrow_cell,
    print_table,
)
from underfoot.cli.stribeck import _cases
from underfoot.cli.trials_analyse import analyse
from underfoot.core import InputError
from underfoot.core.presentation import Table
from underfoot.trials.study.file_result import FileResult


def console_of(width):
    return Console(width=width, file=io.StringIO(), highlight=False)


def printed(console):
    return cast(Any, console.file).getvalue()


def test_only_a_cell_longer_than_the_longest_is_narrowed():
    assert narrow_cell("x" * (LONGEST_VALUE - 3) + ".yz") == "x" * (LONGEST_VALUE - 3) + ".yz"
    assert narrow_cell("x" * LONGEST_VALUE + ".yz") == "x" * LONGEST_VALUE + ".\n  yz"
    sentence = "a sentence of many words is wrapped by the table"
    assert narrow_cell(sentence) == sentence
    assert narrow_cell("0123456789abcdef" * 4) == "0123456789ab…"
    path = "/a/long/folder/of/somebody/and/its/" + "file.toml"
    assert narrow_cell(path) == "…" + path[1 - LONGEST_PATH :]
    assert len(narrow_cell(path)) == LONGEST_PATH


@pytest.mark.parametrize(("rest", "said"), [(0, ""), (1, "… 1 more rows"), (7, "… 7 more rows")])
def test_rows_that_are_left_out_are_counted(rest, said):
    console = console_of(80)
    _say_rest(console, rest)
    assert printed(console).strip().startswith(said)
    assert bool(printed(console)) == (rest > 0)


@pytest.mark.parametrize("everything", [True, False])
def test_a_wide_table_is_printed_in_blocks_that_fit(everything):
    heads = ("shoe", "floor", *(f"column {n}" for n in range(9)))
    rows = [[f"shoe {n}", "vinyl", *(f"{n}.{k}" for k in range(9))] for n in range(20)]
    table, console = Table("", heads, rows), console_of(60)
    widths = [max(len(line[k]) for line in (heads, *rows)) for k in range(len(heads))]
    _print_blocks(console, table, rows, widths, everything=everything)
    blocks = printed(console).split("\n\n")
    lines = printed(console).splitlines()
    assert max(map(len, lines)) <= 60
    # as few blocks as hold 9 columns of 8 + 2 beside 6 + 2 + 5 + 2: four a block
    assert len(blocks) == 3
    shown = len(rows) if everything else MOST_ROWS
    for block in blocks:
        assert block.splitlines()[0].startswith("shoe")
        assert sum(line.startswith("shoe ") for line in block.splitlines()[1:]) == shown
    assert all(f"column {n}" in printed(console) for n in range(9))
    assert ("more rows" in lines[-1]) == (not everything)


TALL = ["first", "1.5", "m/s", "a remark"]


@pytest.mark.parametrize("everything", [True, False])
def test_a_table_that_fits_has_a_row_on_a_line_with_every_cell(capsys, monkeypatch, everything):
    monkeypatch.setenv("COLUMNS", "60")
    print_table(Table("", ("name", "value", "unit", "remark"), [TALL]), everything=everything)
    heads, row = capsys.readouterr().out.splitlines()
    assert heads.split() == ["name", "value", "unit", "remark"]
    assert row.split() == ["first", "1.5", "m/s", "a", "remark"]


def test_a_label_stands_on_one_line_since_its_indent_is_its_level(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    label, value = "  as a floor sensor reads it", "257 ± 121 kPa (0 to above 99.9 %)"
    rows = [[label, value, "95 %: 53 kPa to 548 kPa at the sensor"], ["Contact area", "2", ""]]
    print_table(Table("", ("Quantity", "Value", "Remark"), rows), everything=False)
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert any(line.startswith(label) for line in lines)
    assert all(line.startswith((label, "Quantity", "Contact area", " " * 20)) for line in lines)


@pytest.mark.parametrize("long", [1, 2])
def test_one_column_of_sentences_is_wrapped_and_of_two_each_row_is_a_record(
    capsys, monkeypatch, long
):
    monkeypatch.setenv("COLUMNS", "60")
    sentence = "word " * 29 + "end"
    rows = [["first", *[sentence] * long], ["second", *["short"] * long]]
    print_table(Table("", ("name", *("one", "two")[:long]), rows))
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 60
    assert " ".join(lines).split().count("word") == 29 * long
    assert ("first" in lines) == (long == 2)  # alone on its line
    assert all(
        line[:7].isspace()
        for line in lines[2:]
        if "word" in line and "one" not in line and "two" not in line
    )  # under where its cell begins
    assert sum("short" in line for line in lines) == long


@pytest.mark.parametrize(("count", "told"), [(0, ""), (3, ": r0; r1; r2"), (5, "2 more in")])
@pytest.mark.parametrize("verdict", ["caution", "refused"])
def test_a_file_has_three_reasons_and_a_count_of_the_others(
    capsys, monkeypatch, tmp_path, count, told, verdict
):
    one = FileResult("a.c3d", verdict=verdict, reasons=tuple(f"r{k}" for k in range(count)))
    found = SimpleNamespace(files=[one], doubts=(), notes=(), study=SimpleNamespace(notes=()))
    monkeypatch.setattr("underfoot.trials.study.analyse_folder", lambda *a, **b: found)
    monkeypatch.setattr("underfoot.trials.pages.report.write_trials_report", lambda *a, **b: None)

    def call():
        analyse(tmp_path, protocol="level_walking", out=tmp_path / "out")

    if verdict == "refused":  # nothing is usable
        with pytest.raises(typer.Exit) as ended:
            call()
        assert ended.value.exit_code == 3
    else:
        call()
    said = capsys.readouterr()
    (line,) = said.out.splitlines()
    assert line.startswith(verdict)
    assert told in line
    assert ("more" in line) == (count > 3)
    assert f"{int(verdict == 'caution')} of 1 files usable" in said.err


def test_a_record_has_a_line_for_each_column_that_says_something():
    table = Table("", ("name", "value", "remark"), [["first", "1.5", "-"], ["second", "", "long"]])
    console = console_of(60)
    _print_records(console, table, [["first", "1.5", "-"], ["second", "", "long"]], everything=True)
    assert [line.split() for line in printed(console).splitlines()] == [
        ["first"], ["value", "1.5"], ["second"], ["remark", "long"],
    ]  # fmt: skip


@pytest.mark.parametrize(
    "given", [{"details": -1}, {"processes": 0}, {"details": -1, "processes": 2}, {"processes": -2}]
)
def test_no_analysis_has_fewer_than_no_details_or_than_one_process(tmp_path, given):
    (wrong, value), *_ = given.items()
    with pytest.raises(InputError, match=f"--{wrong}: {value}"):
        analyse(tmp_path, protocol="level_walking", out=tmp_path / "out", **given)


def test_a_title_in_brackets_is_printed_as_it_is(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    print_table(Table("Pressure [bold] [/] [kPa]", ("a", "b"), [["1", "2"]]))
    assert capsys.readouterr().out.splitlines()[0] == "Pressure [bold] [/] [kPa]"


@pytest.mark.parametrize("entry", ["canola_oil", None])
def test_curves_are_of_the_fluid_of_the_case_or_of_each_that_is_named_once(entry):
    """Named "measured": all that the catalogue has a coefficient of, the thinnest first."""
    measured = [SimpleNamespace(fluid=name, viscosity=k) for k, name in ((9, "oil"), (1, "water"))]
    case: Any = SimpleNamespace(
        entries={"floor": "vinyl_g2"} | ({"contaminant": entry} if entry else {}),
        catalogue=measured, replace=lambda path, name: (path, name),
    )  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("underfoot.case.friction.measured_fluids", list)
        (own,) = _cases(case, [])
        several = _cases(case, ["oil", "measured", "soap"])
    assert own == (case, entry or "the case's fluid")
    assert several == [(("contaminant", name), name) for name in ("oil", "water", "soap")]


@pytest.mark.parametrize("columns", [("Quantity", "Remark"), ("Quantity", "Value", "Remark")])
def test_of_two_columns_the_first_is_whole_and_a_long_one_of_three_is_not(
    capsys, monkeypatch, columns
):
    monkeypatch.setenv("COLUMNS", "64")
    label = "a long name of a quantity " * 2  # longer than LONGEST_VALUE, in words
    rows = [[label.strip(), *["1.5"] * (len(columns) - 2), "a remark of its own, short"]]
    print_table(Table("", columns, rows), everything=True)
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith(label.strip()) for line in lines) == (len(columns) == 2)
