"""Snapshots see a change of any part of an answer, and no rounding."""

from dataclasses import dataclass

import numpy as np
import pytest

from snapshot import refusal, same_lines, snapshot_lines
from underfoot.core.remark import Message


@dataclass
class Reading:
    cof: float
    note: str
    forces: np.ndarray
    steps: list[int]


def reading(**parts):
    given = {
        "cof": 0.123456789,
        "note": "dry",
        "forces": np.linspace(-3.0, 9.0, 50),
        "steps": [4, 7],
    }
    return Reading(**(given | parts))


def differ(folder, one, other):
    kept, now = folder / "kept.txt", folder / "now.txt"
    kept.write_text(snapshot_lines(one), encoding="utf-8")
    now.write_text(snapshot_lines(other), encoding="utf-8")
    try:
        same_lines(now, kept)
    except AssertionError:
        return True
    return False


def turned(values, place):
    values = values.copy()
    values[place] *= 1.01
    return values


@pytest.mark.parametrize(
    "changed",
    [
        {"cof": 0.12347},
        {"cof": None},
        {"note": "wet"},
        {"steps": [4, 8]},
        {"steps": [7, 4]},
        {"steps": [4]},
        {"forces": np.linspace(-3.0, 9.0, 51)},
        {"forces": np.linspace(-3.0, 9.0, 50)[::-1]},
        {"forces": turned(np.linspace(-3.0, 9.0, 50), 30)},
    ],
)
def test_a_change_of_any_part_is_seen(tmp_path, changed):
    assert differ(tmp_path, reading(), reading(**changed))


def test_rounding_is_none(tmp_path):
    near = reading(cof=0.123456789 * (1 + 1e-7), forces=np.linspace(-3.0, 9.0, 50) * (1 + 1e-7))
    assert not differ(tmp_path, reading(), near)


def test_of_a_page_counts_what_is_shown_and_drawn(tmp_path):
    page = "<p>COF 0.123</p><style>p {color: red}</style><path d='M 1 2 L 3 4.5'/><i>2026-01-02</i>"
    assert differ(tmp_path, page, page.replace("4.5", "5.5"))
    assert differ(tmp_path, page, page.replace("0.123", "0.133"))
    assert differ(tmp_path, page, page.replace("COF", "coefficient"))
    assert not differ(tmp_path, page, page.replace("red", "blue").replace("01-02", "03-04"))
    long = "<path d='" + " ".join(f"L{n},{n * n}" for n in range(40)) + "'/>"
    assert differ(tmp_path, long, long.replace("L7,49", "L7,94"))


def test_counts_and_whole_numbers_are_exact(tmp_path):
    assert differ(tmp_path, "1000000 steps", "1000001 steps")
    assert differ(tmp_path, "a force of 66 N", "a force of 67 N")
    assert not differ(tmp_path, "a COF of 0.1234", "a COF of 0.1235")
    assert differ(tmp_path, "a COF of 0.1", "a COF of 0.2")
    assert differ(tmp_path, "fastest 1e+09 rad/s", "fastest 2e+09 rad/s")
    assert differ(tmp_path, "a gap of 1.5e-05 m", "a gap of 1.6e-05 m")
    assert not differ(tmp_path, "a gap of 1.234e-05 m", "a gap of 1.235e-05 m")


def test_a_message_is_its_text():
    assert snapshot_lines(Message("{count} {count:step|steps}", count=2)) == "2 steps\n"


def test_of_an_error_its_kind_and_text_are_held():
    assert refusal(int, "x").startswith("ValueError: invalid literal")
    with pytest.raises(AssertionError, match="no error"):
        refusal(int, "1")
