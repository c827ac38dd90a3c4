"""Folders of results are made with all that they lie in; what can't be shown whole is counted."""

import shutil
from types import SimpleNamespace

import pytest

from underfoot.cli import output
from underfoot.core.files import whole_folder


def test_a_folder_is_made_in_folders_that_are_not_there_yet(tmp_path):
    path = tmp_path / "a" / "b" / "c"
    with whole_folder(path) as staging:
        (staging / "one.txt").write_text("1")
    assert (path / "one.txt").read_text() == "1"


def shown(lines):
    return SimpleNamespace(
        heading=lambda: "One", headline=list, cautions=list, tables=list,
        remarks=lambda: {"Assumed": [f"number {n}" for n in range(lines)]},
    )  # fmt: skip


@pytest.mark.parametrize("lines", [output.MOST_LINES, output.MOST_LINES + 2])
def test_remarks_that_are_left_out_are_counted(lines, capsys):
    output.show(shown(lines))
    short = capsys.readouterr().out
    assert short.count("number") == output.MOST_LINES
    assert ("2 more" in short) == (lines > output.MOST_LINES)
    output.show(shown(lines), everything=True)
    whole = capsys.readouterr().out
    assert whole.count("number") == lines
    assert "more" not in whole


@pytest.mark.parametrize("gone", [False, True])
def test_what_went_wrong_in_a_folder_is_told_though_the_folder_was_taken_away(tmp_path, gone):
    path = tmp_path / "made"

    def fails():
        with whole_folder(path) as staging:
            (staging / "one.txt").write_text("1")
            if gone:
                shutil.rmtree(staging)
            raise ValueError("the cause")

    with pytest.raises(ValueError, match="the cause"):
        fails()
    assert list(tmp_path.iterdir()) == []
