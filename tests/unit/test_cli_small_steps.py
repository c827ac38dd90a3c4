"""Lines on a terminal by rules of their own: what is cut, what is left out, what fits."""

import io
from typing import Any, cast

import pytest
from rich.console import Console

from underfoot.cli.output import (
    LONGEST_PATH,
    LONGEST_VALUE,
    MOST_ROWS,
    _print_blocks,
    _print_records,
    _say_rest,
    narrowed,
)
from underfoot.core.presentation import Table


def console_of(width):
    return Console(width=width, file=io.StringIO(), highlight=False)


def printed(console):
    return cast(Any, console.file).getvalue()


def test_only_a_cell_longer_than_the_longest_is_narrowed():
    assert narrowed("x" * (LONGEST_VALUE - 3) + ".yz") == "x" * (LONGEST_VALUE - 3) + ".yz"
    assert narrowed("x" * LONGEST_VALUE + ".yz") == "x" * LONGEST_VALUE + ".\n  yz"
    sentence = "a sentence of many words is wrapped by the table"
    assert narrowed(sentence) == sentence
    assert narrowed("0123456789abcdef" * 4) == "0123456789ab…"
    path = "/a/long/folder/of/somebody/and/its/" + "file.toml"
    assert narrowed(path) == "…" + path[1 - LONGEST_PATH :]
    assert len(narrowed(path)) == LONGEST_PATH


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


def test_a_record_has_a_line_for_each_column_that_says_something():
    table = Table("", ("name", "value", "remark"), [["first", "1.5", "-"], ["second", "", "long"]])
    console = console_of(60)
    _print_records(console, table, [["first", "1.5", "-"], ["second", "", "long"]], everything=True)
    assert [line.split() for line in printed(console).splitlines()] == [
        ["first"], ["value", "1.5"], ["second"], ["remark", "long"],
    ]  # fmt: skip
