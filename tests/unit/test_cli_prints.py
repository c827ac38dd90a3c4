"""What a command prints of an answer, how wide, and with which code it ends."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import rich.console
import typer

from commands import called
from underfoot import report
from underfoot.cli import output
from underfoot.core import InputError
from underfoot.core.presentation import Presentable, Table
from underfoot.report.writing import WRITTEN_IN_PART


class Answer(Presentable):
    kind = "answer"

    def __init__(self, usable=True, rows=(("a", "1"),), remarks=None):
        self._usable, self._rows, self._remarks = usable, rows, remarks or {}

    @property
    def usable(self):
        return self._usable

    def heading(self):
        return "Heading [red]"

    def headline(self):
        return ("It is so.",)

    def cautions(self):
        return ("Mind [it].",)

    def table(self):
        return Table("Numbers", ("name", "value"), list(self._rows))

    def remarks(self):
        return self._remarks

    def to_dict(self):
        return {"value": 1.0}


@pytest.fixture
def wide(monkeypatch):
    """Let terminals be as wide as is asked for."""

    def of(width):
        real = rich.console.Console
        monkeypatch.setattr(
            rich.console, "Console", lambda **more: real(**{**more, "width": width})
        )

    return of


@pytest.mark.parametrize("everything", [True, False])
def test_an_answer_is_shown_with_its_first_remarks_or_all(capsys, everything):
    long = "a remark (with its source) " + "and more " * 40
    remarks = {"Assumed": [long, "two", "three", "four", "five"], "One": ["only"], "None": []}
    output.show(Answer(remarks=remarks), everything=everything)
    lines = capsys.readouterr().out.splitlines()
    assert lines[1] == "Heading [red]"
    assert lines[2] == "It is so."
    assert lines[3] == "Caution: Mind [it]."
    assert "Assumed (5):" in lines
    assert "One:" in lines
    assert not [line for line in lines if line.startswith("None")]
    listed = [line for line in lines if line.startswith("  - ")]
    assert listed[1] == "  - two"
    assert ("  - four" in lines) is everything
    assert ("  … 2 more: --all" in lines) is not everything
    assert (listed[0] == "  - a remark") is not everything


@pytest.mark.parametrize("as_json", [True, False])
@pytest.mark.parametrize("usable", [True, False])
@pytest.mark.parametrize("failed", [None, 0, 2])
def test_a_command_ends_with_what_its_result_and_its_files_deserve(capsys, as_json, usable, failed):
    written: Any = failed if failed is None else SimpleNamespace(
        lines=lambda: ["Files in here", *["x failed"] * failed])  # fmt: skip
    code = WRITTEN_IN_PART if failed else 0 if usable else output.NOT_USABLE
    ended = 0
    try:
        output.finish(Answer(usable), written, json=as_json)
    except typer.Exit as stop:
        ended = stop.exit_code
    assert ended == code
    said = capsys.readouterr()
    if as_json:
        assert json.loads(said.out)["value"] == 1.0
    else:
        assert "It is so." in said.out
        assert ("Files in here" in said.out) is (failed is not None)
    assert said.err.count("error: x failed") == (failed or 0)
    assert ("written in part" in said.err) is bool(failed)


@pytest.mark.parametrize("as_json", [True, False])
def test_advice_follows_an_answer(capsys, as_json):
    advice: Any = Answer()
    advice.change_sentences = lambda: ["do this", "do that"]
    output.finish(Answer(), None, json=as_json, advice=advice)
    said = capsys.readouterr().out
    if as_json:
        assert json.loads(said)["advice"]["value"] == 1.0
    else:
        assert said.endswith("Numbers:\n  - do this\n  - do that\n")


@pytest.mark.parametrize("out", [None, "there"])
@pytest.mark.parametrize("further", [False, True])
def test_an_answer_is_written_where_that_is_asked_with_what_goes_with_it(
    monkeypatch, tmp_path, capsys, out, further
):
    result, wrote = Answer(), []

    def write(*given, **more):
        wrote.append((given, more))
        return SimpleNamespace(lines=lambda: ["Files in there"])

    monkeypatch.setattr(report, "write_report", write)
    folder = None if out is None else tmp_path / out
    more: dict[str, Any] = {"further": lambda told, path: {"of": (told, path)}} if further else {}
    output.answer("title", lambda _: result, out=folder, overwrite=True, **more)
    kept = {"further": {"of": (result, folder)}} if further else {}
    assert wrote == ([((result, folder), {"overwrite": True, **kept})] if out else [])
    assert ("Files in there" in capsys.readouterr().out) is (out is not None)
    if out:
        (tmp_path / out).mkdir()
        (tmp_path / out / "a.txt").touch()
        with pytest.raises(InputError):
            output.answer("title", lambda _: result, out=folder)


def printed(capsys, table, everything=True):
    output.print_table(table, everything=everything)
    return [line.rstrip() for line in capsys.readouterr().out.splitlines()]


def test_a_table_that_fits_has_a_line_a_row(wide, capsys):
    wide(40)
    table = Table("Title [x]", ("name", "value"), [("a", "1"), ("[b]", "22")])
    assert printed(capsys, table) == ["Title [x]", "name  value", "a     1", "[b]   22"]
    bare = Table("", ("", ""), [("a", "1")])
    assert printed(capsys, bare) == ["a  1"]


@pytest.mark.parametrize("width", [24, 23])
def test_a_table_is_cut_into_blocks_where_its_columns_do_not_fit_beside_each_other(
    wide, capsys, width
):
    wide(width)
    heads = ("key", "one", "two", "three")  # 4 + 2 + 5 + 2 + 4 + 2 + 5 = 24
    rows = [("aaaa", "11111", "2222", "33333"), ("b", "1", "2", "3")]
    lines = printed(capsys, Table("", heads, rows))
    assert max(map(len, lines)) <= width
    if width == 24:
        assert lines == [
            "key   one    two   three",
            "aaaa  11111  2222  33333",
            "b     1      2     3",
        ]
    else:
        assert lines == ["key   one    two", "aaaa  11111  2222", "b     1      2", "",
                         "key   three", "aaaa  33333", "b     3"]  # fmt: skip


def test_sentences_that_do_not_fit_stand_below_each_other(wide, capsys):
    wide(60)
    long = "word " * (output.LONGEST_VALUE // 4)
    table = Table("", ("name", "first", "second"), [("a", long, long), ("b", "-", "short")])
    lines = printed(capsys, table)
    assert lines[0] == "a"
    assert lines[1].startswith("  first   word word")
    assert max(map(len, lines)) <= 60
    at = lines.index("b")
    assert lines[at + 1 :] == ["  second  short"]
    assert all(line.startswith("          word") for line in lines[2:at] if "second" not in line)
    many = Table("", table.columns, [(f"r{k}", long, long) for k in range(output.MOST_RECORDS + 2)])
    cut = printed(capsys, many, everything=False)
    assert [line for line in cut if line.startswith("  …")] == [
        "  … 2 more rows: --all, or the CSV of --out"
    ]


def test_remarks_of_a_table_lose_their_sources_where_not_all_is_asked(wide, capsys):
    wide(200)
    source = "a remark (source " + "x" * output.LONGEST_VALUE + ")"
    table = Table("", ("name", "value", "remark"), [("a", "1", source), ("b", "2", "short (s)")])
    short = printed(capsys, table, everything=False)
    assert short[1].endswith("a remark")
    assert short[2].endswith("short (s)")
    assert printed(capsys, table)[1].endswith("x)")
    assert output.shorten_remark("x (y) z") == "x"
    two = Table("", ("name", "value"), [("a", source)])
    assert any("source" in line for line in printed(capsys, two, everything=False))


# curves of two conditions


def curves_file(folder, name, first, second):
    np.savez(folder / name, YA=first, YB=second)
    return folder / name


@pytest.mark.parametrize("as_json", [True, False])
def test_curves_of_two_conditions_are_told_with_where_they_differ(tmp_path, as_json):
    rng = np.random.default_rng(1)
    first = np.cumsum(rng.normal(size=(9, 40)), axis=1)
    second = first + 0.1 * np.cumsum(rng.normal(size=(9, 40)), axis=1)
    second[:, 20:30] += 30
    second[:, 0] = first[:, 0]
    file = curves_file(tmp_path, "both.npz", first, second)
    done = called("trials", "curves", file, *["--json"] * as_json)
    assert done.returncode == 0, done.stderr
    if as_json:
        told = json.loads(done.stdout)
        assert (told["persons"], told["nodes"]) == (9, 40)
        assert told["t"][0] is None
        assert told["still"] == [0]
        (cluster,) = told["clusters"]
        assert abs(cluster["first_node"] - 20) <= 2
        assert abs(cluster["last_node"] - 29) <= 2
    else:
        assert "they differ at nodes" in done.stderr
        assert "9 persons, 40 nodes" in done.stderr
        assert "nodes 0." in done.stderr
    pairs = called("trials", "curves", curves_file(tmp_path, "odd.npz", first, second[:8]))
    assert pairs.returncode != 0
    for alpha in ("0", "1"):
        assert called("trials", "curves", file, "--alpha", alpha).returncode != 0
    np.save(tmp_path / "one.npy", first)
    assert called("trials", "curves", tmp_path / "one.npy").returncode != 0
    same = called("trials", "curves", curves_file(tmp_path, "same.npz", first, first[::-1]))
    assert "nowhere" in same.stderr


@pytest.mark.parametrize(
    ("text", "read"),
    [("a.b=3", ("a.b", 3)), ("a = 1.5", ("a", 1.5)), ("a=0.3 m/s", ("a", "0.3 m/s")),
     ('a="x=y"', ("a", "x=y")), ("a=[1, 2]", ("a", [1, 2])), ("a", None), ("=3", None)],
)  # fmt: skip
def test_a_setting_is_a_path_and_a_value(text, read):
    from underfoot.cli.options import load_case, setting

    if read is None:
        with pytest.raises(InputError, match="not a setting"):
            setting(text)
    else:
        path, value = setting(text)
        assert path == read[0]
        assert value == read[1] or float(value) == read[1]
    with pytest.raises(InputError, match="is a folder"):
        load_case(Path(), None, None)
