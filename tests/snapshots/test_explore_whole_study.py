"""A study of a small pad from its file to its tables, by the commands and as their results."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from commands import said
from small_pads import BARS, DRY, pad
from snapshot import held
from underfoot.explore.plan import POSITIONS
from underfoot.explore.record import Ending, Record
from underfoot.explore.result import Design, DesignRecords
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan

STUDY = """name = "pads"
base = "base.toml"
[vary]
"motion.speed" = ["0.2 m/s", "0.3 m/s"]
[outputs]
maximise = ["cof"]
[method]
grid = "quick"
"""
PASSING = r"[\d.]+ (?:to [\d.]+ )?(?:[kMG]?B|s|min|h)\b|[\d.]+ cases a minute, workers \d+%"

pytestmark = pytest.mark.usefixtures("wide")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "base.toml").write_text(pad(DRY).to_toml())
    (tmp_path / "s.toml").write_text(STUDY)
    return tmp_path


def test_from_the_file_to_the_tables(file_regression, folder):
    told: dict[str, Any] = {"run": said(folder, "study", "run", "s.toml", "--workers", "1")}
    assert told["run"][0] == 0
    told["again"] = said(folder, "study", "run", "s.toml", "--workers", "1", "--json")
    told["again"][1] = sorted(json.loads(told["again"][1]))
    for name in ("status", "report", "best", "work", "live"):
        told[name] = said(folder, "study", name, "s.toml")
    told["export"] = said(
        folder, "study", "export", "s.toml", "designs", "--no-step", "--count", "1"
    )
    told["files"] = sorted(p.relative_to(folder).as_posix() for p in folder.glob("designs/**/*"))
    held(file_regression, told, hide=PASSING)


def test_who_works_without_leading_finishes_what_nobody_began(folder):
    study = Study.load(folder / "s.toml", folder / "out")
    assert study.work() == 2
    assert study.work() == 0
    assert study.result().designs[0].usable


def test_draws_of_a_design_are_those_of_its_law_one_condition_after_another():
    records = {
        name: Record(name, Ending.COMPUTED, numbers={"cof": 9.0}, draws=np.array(draws))
        for name, draws in (("a", [0.1, 0.3]), ("b", [0.5, 0.7]), ("c", []))
    }

    def design(*names):
        keys = {(state, 0): name for state, name in enumerate(names)}
        return Design(0, (0.5,), {}, False, False, DesignRecords(keys, records))

    both = design("a", "b").cof_draws([1, 0])
    assert both is not None
    assert both.tolist() == [0.5, 0.7, 0.1, 0.3]
    assert design("a", "c").cof_draws([0]) is None


def test_a_job_of_a_condition_that_is_none_is_set_aside(folder):
    study = Study.load(folder / "s.toml", folder / "out")
    store, job = study.store.open_folder(study.store.folder), study.plan.job(0, (0.0,), 0, 0, 0)
    store.adopt(study.plan)
    assert store.round is None  # nothing is given out, nor is the study over
    for condition in (0, 1):
        (store.folder / "jobs.jsonl").unlink(missing_ok=True)
        store.add_batch(store.jobs(), [replace(job, condition=condition)])
        store.adopt(study.plan)
        assert len(list(store.folder.glob("jobs-before-*"))) == condition


@pytest.mark.parametrize(
    ("grid", "count", "again"),
    [("standard", 2, 3), ("standard", 62, 63), ("standard", 63, 62), ("standard", 64, 63),
     ("quick", 2, 3), ("quick", 3, 5), ("quick", 62, 63), ("quick", 63, 62), ("quick", 64, 62),
     ("quick", 1, None)],
)  # fmt: skip
def test_a_second_run_has_other_positions_and_their_number_is_allowed(folder, grid, count, again):
    """A quick run has half as many: where one more or less changes nothing it is two."""
    text = '[vary]\n"motion.speed" = ["0.2 m/s", "0.3 m/s"]\n'
    text += f'[method]\ngrid = "{grid}"\nfront_grid = "{grid}"\n'
    plan = read_plan(text, folder, base=pad(BARS, {POSITIONS: count}))
    assert plan.job(0, (0.0,), 0, 0, 0, again=True).changes.get(POSITIONS) == again
