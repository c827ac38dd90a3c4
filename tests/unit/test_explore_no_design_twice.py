"""An optimisation runs no design that it has run."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import load
from underfoot.explore import scan
from underfoot.explore.proposals import next_batch
from underfoot.explore.record import Ending, Record
from underfoot.explore.records import Records
from underfoot.explore.result import StudyResult
from underfoot.explore.store import Store
from underfoot.explore.study_file import read_plan

EXAMPLES, BASE = Path(__file__).parents[2] / "examples", "work_shoe_full_tread_glycerol.toml"
STUDY = """\
[vary]
"shoe.material.shore_a" = [40, 45, 50, 55, 60, 65, 70, 75]
[outputs]
maximise = ["cof"]
[method]
kind = "optimise"
budget = 8
batch = 2
"""


def test_an_optimisation_over_few_values_runs_each_once():
    base = load(EXAMPLES / BASE)
    plan = read_plan(STUDY, base=base, folder=".")
    jobs, records = [], {}
    while batch := list(next_batch(plan, StudyResult(plan, jobs, records))):
        jobs += batch
        for job in batch:
            hardness = job.changes["shoe.material.shore_a"] if job.point else 60
            numbers = {"cof": 0.3 - 1e-4 * (float(hardness) - 62) ** 2}
            records[job.key] = Record(
                job.key, Ending.COMPUTED, numbers=numbers, errors={"cof": 0.0}
            )
    run = [job.changes["shoe.material.shore_a"] for job in jobs if job.quick and job.point]
    assert len(set(run)) == len(run) >= 6, run


def test_a_record_that_was_packed_meanwhile_is_read_where_it_lies_now():
    asked = []

    def read(place):
        asked.append(place)
        if len(asked) == 1:
            raise FileNotFoundError
        return f"at {place}"

    store = SimpleNamespace(_places={"one": 5 << 3 | 1}, _record=read)
    store.look = lambda: store._places.update(one=9 << 3 | 1)
    assert Records.__getitem__(cast(Any, store), "one") == "at 9"
    assert asked == [5, 9]


@pytest.mark.parametrize(("most", "every"), [(1000, 1), (400, 1), (399, 2), (100, 4)])
def test_of_many_draws_of_many_cases_so_many_are_kept_as_fit(monkeypatch, tmp_path, most, every):
    """Four cases of 100 draws."""
    monkeypatch.setattr(scan, "MOST_DRAWS", most)
    store = Store.open_folder(tmp_path / "study")
    store.adopt(read_plan(STUDY, base=load(EXAMPLES / BASE), folder="."))
    with store.working(1):
        for k in range(4):
            draws = k + np.arange(100.0)
            one = Record(f"{k}", Ending.COMPUTED, numbers={"cof": 0.3}, draws=draws)
            store.add_record(one)
    seen = scan.scan_cases(Store(store.folder).records(), ["cof"], draws=True)
    assert seen.every == every
    for k in range(4):
        assert seen.draws[seen.rows[f"{k}"]].tolist() == (k + np.arange(0.0, 100.0, every)).tolist()
