"""What readers make of exports whose rows and columns are lost, doubled, moved, empty or odd.

Of ``underfoot.trials.readers.amti``, ``underfoot.trials.readers.bts``,
``underfoot.trials.readers.columns``, ``underfoot.trials.readers.dflow``,
``underfoot.trials.readers.formats``, ``underfoot.trials.readers.instrument_logs``,
``underfoot.trials.readers.motive``, ``underfoot.trials.readers.pose_json``,
``underfoot.trials.readers.satra``, ``underfoot.trials.readers.text``,
``underfoot.trials.readers.text_exports``, ``underfoot.trials.readers.xsens``,
``underfoot.trials.readers.xsensor``.
"""

import re

import pytest

from recording_texts import TEXTS, changes, read_lines
from snapshot import held


def damaged(text: str) -> dict[str, str]:
    """Return a text with one thing wrong, each by its name."""
    lines = text.split("\n")
    first = next((i for i in range(3, len(lines)) if lines[i][:1].isdigit()), 12)
    head = min(first, 10, len(lines) - 2)
    variants = {}
    for i in range(1, head + 1):
        variants[f"an empty line before {i}"] = "\n".join([*lines[:i], "", *lines[i:]])
        if i % 2:
            turned = [*lines[: i - 1], lines[i], lines[i - 1], *lines[i + 1 :]]
            variants[f"lines {i - 1} and {i} turned"] = "\n".join(turned)
            variants[f"line {i} twice"] = "\n".join([*lines[:i], lines[i], *lines[i:]])
    at = min(first + 7, len(lines) - 2)
    cells = re.split(r"([\t;,])", lines[at])
    for k in range(0, min(len(cells), 13), 4):
        for name, new in (("empty", ""), ("a word", "bad"), ("zero", "0"), ("huge", "9e30")):
            changed = "".join([*cells[:k], new, *cells[k + 1 :]])
            variants[f"cell {k // 2} of row {at} {name}"] = "\n".join(
                [*lines[:at], changed, *lines[at + 1 :]]
            )
    sign = cells[1] if len(cells) > 1 else ","
    for k in (1, 2):
        rows = [
            sign.join(part for n, part in enumerate(line.split(sign)) if n != k or n + 1 < k)
            for line in lines
        ]
        variants[f"without column {k}"] = "\n".join(rows)
    variants["without rows"] = "\n".join(lines[: at - 5])
    variants["rows turned"] = "\n".join(
        [*lines[:at], *lines[at : at + 20][::-1], *lines[at + 20 :]]
    )
    variants["a row twice"] = "\n".join([*lines[:at], lines[at], *lines[at:]])
    variants["an empty line"] = "\n".join([*lines[:at], "", *lines[at:]])
    variants["a line of words"] = "\n".join([*lines[:at], "the belt stops", *lines[at:]])
    variants["words at the end"] = text + "\nend of file\n"
    return variants


@pytest.mark.parametrize("name", TEXTS)
def test_a_damaged_export(name, tmp_path, file_regression):
    text = TEXTS[name]()
    whole = read_lines(tmp_path, name, text)
    answers = {
        said: changes(whole, read_lines(tmp_path, name, data), most=3)
        for said, data in damaged(text).items()
    }
    held(file_regression, answers, f"damaged_{name.replace('.', '_')}")
