"""The script that makes faults, on a made-up house: a bare room, an endless fault, a red test."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parents[1]
SCRIPTS = "mutants.py", "mutants_map.py", "mutants_warm.py"
# as ``make mutants`` runs it, but a fault is endless after 1 s of CPU and no library is imported
RUN = "import mutants; mutants.LEAST_TIME, mutants.LIBRARIES = 1, (); mutants.main()"
FILES = {
    "pyproject.toml": (
        '[tool.pytest.ini_options]\npythonpath = ["src"]\n'
        'markers = ["costly: c", "slow: s", "study: s", "browser: b"]\n'
    ),
    "src/underfoot/__init__.py": "",
    "src/underfoot/bare/__init__.py": "",
    "src/underfoot/bare/alone.py": "def twice(value):\n    return value + value\n",
    "src/underfoot/loop/__init__.py": "",
    "src/underfoot/loop/count.py": (
        "def down(value, step):\n    while value:\n        value = value - step\n"
        "    return value\n\n\n"
        "def half(value, two):\n    return value / two\n"
    ),
    "tests/mutants_alive.toml": (
        '"bare/alone.py" = [["return value [+ -> -] value", "nobody asks"]]\n'
    ),
    "tests/unit/test_loop_count.py": (
        "from underfoot.loop.count import down, half\n\n\n"
        "def test_down():\n    assert down(3, 1) == 0\n\n\n"
        "def test_red():\n    assert half(4, 2) == 3\n"
    ),
}


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    folder = tmp_path_factory.mktemp("house")
    for name, text in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    for name in SCRIPTS:
        shutil.copy2(HERE / name, folder / "tests" / name)
    for words in (["init", "-q"], ["add", "-A"]):
        subprocess.run(["git", *words], cwd=folder, check=True)
    return folder


def made(house, *words):
    """Return what the script prints of the house, and its exit code."""
    paths = f"{house / 'src'}:{house / 'tests'}"
    run = subprocess.run(
        [sys.executable, "-c", RUN, *words, "--jobs", "1"], cwd=house, capture_output=True,
        text=True, check=False, timeout=100, env={"PYTHONPATH": paths, "PATH": "/usr/bin:/bin"},
    )  # fmt: skip
    return run.stdout + run.stderr, run.returncode


@pytest.mark.slow
def test_what_has_no_test_lives_what_never_ends_dies_and_a_red_test_kills_none(house):
    printed, code = made(house)
    assert code == 0
    assert re.search(r"fail without a fault, and kill none:\s+tests/\S+::test_red\n", printed)
    answers = re.findall(r"(?m)^(\w+) +(\S+): line \d+: .*(\[.*\]).* <- (.*)$", printed)
    assert sorted(answers) == [
        ("ALIVE", "bare/alone.py", "[+ -> -]", "may live: nobody asks"),
        ("ALIVE", "loop/count.py", "[/ -> *]", "0 tests"),  # only the red test would see it
        ("own", "loop/count.py", "[- -> +]", "tests/unit/test_loop_count.py::test_down"),
    ]
    rooms = re.findall(r"(?m)^(bare|loop|all) +(\d+) +(\d+) +(\d+) +(\d+)$", printed)
    assert rooms == [
        ("bare", "1", "0", "0", "1"), ("loop", "2", "1", "1", "0"), ("all", "3", "1", "1", "1")
    ]  # fmt: skip


def test_a_room_that_is_not_there_is_refused_with_those_that_are(house):
    printed, code = made(house, "attic")
    assert code == 2
    assert "no room: attic. Allowed: bare, loop" in printed
