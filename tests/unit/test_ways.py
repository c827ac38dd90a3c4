"""A value on its way passes from file to file and does not go to and fro: eight ways, counted."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

WAYS = Path(__file__).parents[1] / "ways.py"


@pytest.mark.parametrize(
    ("way", "stays", "returns"),
    [
        ("viscosity", 11, 4),
        pytest.param("sole", 31, 16, marks=pytest.mark.slow),
        pytest.param("vertex", 26, 12, marks=pytest.mark.slow),
        ("sample", 13, 8),
        ("trial", 16, 4),
        pytest.param("scan", 25, 15, marks=pytest.mark.slow),
        pytest.param("reading", 12, 9, marks=pytest.mark.slow),
        pytest.param("slider", 44, 30, marks=pytest.mark.slow),
    ],
)
def test_a_value_takes_no_longer_way_than_it_did(way, stays, returns):
    """In a process of its own: what an earlier run has cached would shorten it."""
    answer = subprocess.run(
        [sys.executable, WAYS, way, "counts"], check=True, capture_output=True, encoding="utf-8"
    ).stdout
    counts = json.loads(answer[answer.index("{") :])
    assert counts["stays"] == counts["files"] + counts["returns"]
    assert counts["files"] >= 3  # the run was watched
    assert counts["stays"] <= stays
    assert counts["returns"] <= returns


def test_types_of_a_way_are_classes_of_the_source(monkeypatch):
    """A class with another name now would not be followed, and its way would look short."""
    monkeypatch.syspath_prepend(str(WAYS.parent))
    from ways import PACKAGE
    from ways import WAYS as ways

    source = "\n".join(path.read_text("utf-8") for path in PACKAGE.rglob("*.py"))
    classes = set(re.findall(r"(?m)^class (\w+)", source))
    assert {name for _, _, types in ways.values() for name in types.split()} <= classes


def test_what_a_stay_a_return_and_a_climb_are(monkeypatch):
    """By hand: out and back between two rooms, of which one is higher."""
    monkeypatch.syspath_prepend(str(WAYS.parent))
    from ways import Journey

    journey = Journey("Case")
    files = ["case/case.py", "core/units.py", "case/case.py", "case/text.py", "cli/app.py"]
    journey.stays = [(file, ["f"]) for file in files]
    assert journey.counts == {"stays": 5, "files": 4, "climbs": 2, "returns": 1}
