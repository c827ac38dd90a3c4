"""The same numbers for about the same CPU, whatever the environment says of threads.

Every command runs as a process of its own, as a user's does.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from commands import COMMAND
from underfoot.explore.store import Store

CASE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"
VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
CHANGES = {"numerics.quick_grid_spacing": "2.5 mm"}
FEW_RUNS = {"slip.fit_runs": 4, "slip.test_runs": 1, "slip.time_step": "20 ms"}
STUDY = f"""\
base = "{CASE.as_posix()}"
set = {{ "numerics.quick_grid_spacing" = "2.5 mm", "numerics.tread_positions" = 1 }}
vary = {{ "shoe.material.shore_a" = [50, 60] }}
outputs = {{ maximise = ["cof"] }}
"""
WORKER = f"""\
from pathlib import Path
from underfoot.app import work
from underfoot.core.worker import Worker

if __name__ == "__main__":
    with Worker() as worker:
        worker.wait(worker.submit(work.computed, {str(CASE)!r}, "out", {CHANGES}, True))
    print(Path("out", "result.json").read_text())
"""


def options(settings):
    return [word for pair in settings.items() for word in ("--set", "=".join(map(str, pair)))]


ONE = {"numerics.tread_positions": 1}
SQUARES = CHANGES | ONE | {"numerics.cells_along": 1}  # what solves the sole a dozen times
QUESTIONS = {
    "run": [*COMMAND, "run", CASE, *options(CHANGES | ONE), "--quick", "--json"],
    "risk": [*COMMAND, "risk", CASE, *options(SQUARES), "--json"],
    "validate": [*COMMAND, "validate", "--json"],
    "slip": [*COMMAND, "slip", CASE, *options(SQUARES | FEW_RUNS), "--subjects", "4", "--json"],
    "study": [*COMMAND, "study", "run", "study.toml", "--workers", "2"],
    "worker": [sys.executable, "worker.py"],
}
NOT_COMPUTED = {"provenance", "seconds", "cpu_seconds", "ended"}


def numbers(content, path=()):
    """Return the numbers of plain data under their paths, less moments and durations."""
    if isinstance(content, int | float):
        return {path: content}
    inner = content if isinstance(content, dict) else {}
    if isinstance(content, list):
        inner = dict(enumerate(content))
    found = {}
    for key in inner.keys() - NOT_COMPUTED:
        found |= numbers(inner[key], (*path, key))
    return found


def answered(question, folder, threads):
    """Return the numbers of a command's answer and the CPU s of its processes."""
    folder.mkdir()
    (folder / "study.toml").write_text(STUDY)
    (folder / "worker.py").write_text(WORKER)
    environment = {**os.environ, **dict.fromkeys(VARIABLES, str(threads))}
    before = os.times()
    done = subprocess.run(
        QUESTIONS[question],
        cwd=folder, env=environment | {"UNDERFOOT_CACHE": str(folder / "cache")},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    after = os.times()
    assert done.returncode == 0, done.stderr
    content = None
    if question == "study":
        (place,) = {path.parent for path in folder.rglob("cases-*.jsonl")}
        content = {key: one.numbers for key, one in Store(place).records().items()}
        assert len(content) == 2
        assert all(content.values())
    cpu = after.children_user + after.children_system
    return (
        numbers(content or json.loads(done.stdout)),
        cpu - before.children_user - before.children_system,
    )


@pytest.mark.parametrize(
    "question",
    [
        *(pytest.param(n, marks=pytest.mark.slow) for n in ("run", "risk", "study", "worker")),
        *(pytest.param(name, marks=pytest.mark.study) for name in ("slip", "validate")),
    ],
)
def test_number_of_threads_changes_neither_numbers_nor_cpu(question, tmp_path):
    one, cpu = answered(question, tmp_path / "1", 1)
    assert len(one) > 5
    other, more = answered(question, tmp_path / "8", 8)
    print(f"{question}, 8 threads: {more / cpu:.2f} of the CPU of one thread")
    assert other == pytest.approx(one, rel=1e-12, abs=0.0)
    assert more < 2 * cpu
