"""A study that is killed at any write, and then gone on with, has every design that it planned.

Each call by which the study changes its folder is stopped in turn, half done where it is a write:
from there on nothing is written, as after kill -9 or a power cut.
"""

import os
import shutil
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.explore import plan as plan_module
from underfoot.explore import proposals, records, study
from underfoot.explore.claims import Round, begin_round, latest_round
from underfoot.explore.record import Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
TEXT = """\
base = "work_shoe_untreaded_glycerol.toml"
[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s" }
[method]
kind = "optimise"
budget = 12
batch = 3
front_grid = "none"
[outputs]
maximise = ["cof"]
"""
CHANGES = ("write", "fsync", "replace", "rename", "mkdir", "ftruncate", "unlink", "rmdir")
DEAD = 2**22 + 1
"""Number of no process: that of who was killed."""


class Killed(BaseException):
    """The end of a process."""


class Plug:
    """Pull it at one of the calls that change the folder."""

    def __init__(self, patch, at):
        self.at, self.count = at, 0
        for name in CHANGES:
            patch.setattr(os, name, self.guarded(name, getattr(os, name)))
        patch.setattr(os, "getpid", lambda: DEAD)

    def guarded(self, name, real):
        def call(*arguments, **named):
            self.count += 1
            if self.count == self.at and name == "write":
                real(arguments[0], arguments[1][: len(arguments[1]) // 2])
            if self.count >= self.at:
                raise Killed
            return real(*arguments, **named)

        return call


@pytest.fixture
def made_up(monkeypatch):
    """Cases that are numbers, and proposals that depend on every case that is finished."""
    keys = {}

    def key(self, changes, quick):
        return keys.setdefault(repr((changes, quick)), f"{len(keys):024x}")

    def computed(base, job):
        (cof,) = job.point or (0.5,)
        return Record(job.key, Ending.COMPUTED, numbers={"cof": cof}, draws=np.full(3, cof))

    def promising(so_far, count):
        values = so_far.goal_values(so_far.designs)[:, 0]
        assert np.isfinite(values).all()
        shift = float(values.sum()) % 1.0
        return [((shift + k / 7) % 1.0,) for k in range(count)]

    monkeypatch.setattr(plan_module.StudyPlan, "_key", key)
    monkeypatch.setattr(study, "compute_job", computed)
    monkeypatch.setattr(proposals, "_promising", promising)
    monkeypatch.setattr(records, "PACK", 5)
    return read_plan(TEXT, EXAMPLES)


def run(plan, folder, lead):
    """Run a study, or help with it without a leader."""
    one = Study(plan, folder)
    one.run(workers=1) if lead else one.work()


def answers(folder):
    """Return design, place and number of every case, as any process reads them."""
    result = Study.load(folder).result()
    return [(one.design, one.point, result.record(one).numbers["cof"]) for one in result.jobs]


def calls(plan, folder, lead, at):
    """Return how many calls changed the folder, up to the one at which the plug was pulled."""
    with pytest.MonkeyPatch.context() as patch:
        plug = Plug(patch, at)
        with suppress(Killed):
            run(plan, folder, lead)
    return plug.count


@pytest.mark.parametrize("lead", [True, False])
@pytest.mark.parametrize("step", [11, pytest.param(1, marks=pytest.mark.slow)])
def test_killed_at_every_write_the_designs_set_are_those_planned(made_up, tmp_path, lead, step):
    total = calls(made_up, tmp_path / "whole", lead, at=10**9)
    whole = answers(tmp_path / "whole")
    assert len(whole) == made_up.designs == 12
    assert list((tmp_path / "whole").glob("packed-*"))
    assert total > 90
    for at in range(1, total + 1, step):
        folder = tmp_path / str(at)
        calls(made_up, folder, lead, at)
        if at % 3 == 0:  # killed once more as it goes on
            calls(made_up, folder, lead, 1 + at % 41)
        Study(made_up, folder).run(workers=1)
        assert answers(folder) == whole, f"killed at call {at}"
        assert [one.name for one in folder.rglob(".*")] == [".underfoot"]
        shutil.rmtree(folder)


@pytest.mark.parametrize("name", ["jobs.jsonl", "cases", "draws", "jobs.npy", "study.toml"])
def test_a_folder_that_was_copied_in_part_is_completed(made_up, tmp_path, name, monkeypatch):
    monkeypatch.setattr(records, "PACK", 10**6)
    run(made_up, tmp_path / "whole", True)
    whole = answers(tmp_path / "whole")
    (path,) = [one for one in (tmp_path / "whole").rglob(f"{name}*") if one.is_file()]
    size = path.stat().st_size
    for share in (0.0, 0.3, 0.5, 0.97):
        copy = tmp_path / "copy"
        shutil.copytree(tmp_path / "whole", copy)
        os.truncate(copy / path.relative_to(tmp_path / "whole"), int(share * size))
        Study(made_up, copy).run(workers=1)
        assert answers(copy) == whole
        shutil.rmtree(copy)


@pytest.mark.parametrize("name", ["jobs.jsonl", "cases-"])
@pytest.mark.parametrize("line", [0, 5, -1])
def test_a_line_that_was_lost_is_set_or_computed_again(made_up, tmp_path, name, line, monkeypatch):
    monkeypatch.setattr(records, "PACK", 10**6)
    run(made_up, tmp_path, True)
    whole, path = answers(tmp_path), next(tmp_path.glob(f"{name}*"))
    lines = path.read_bytes().splitlines(keepends=True)
    del lines[line]
    path.write_bytes(b"".join(lines))
    assert Study.load(tmp_path).result().endings != {"computed": 12}
    Study(made_up, tmp_path).run(workers=1)
    assert answers(tmp_path) == whole


def test_a_study_file_that_was_changed_in_the_folder_is_not_taken_for_the_one_that_ran(
    made_up, tmp_path
):
    run(made_up, tmp_path / "study", True)
    before = Study.load(tmp_path / "study").result().jobs[3].changes
    file = tmp_path / "study" / "study.toml"
    file.write_text(file.read_text().replace("0.7 m/s", "0.9 m/s"))
    with pytest.raises(InputError, match=r"study.toml: was changed.*study run COPY.toml --out"):
        Study.load(tmp_path / "study")
    changed = read_plan(file.read_text(), EXAMPLES)
    run(changed, tmp_path / "study", True)
    jobs = Study.load(tmp_path / "study").result().jobs
    assert len(jobs) == 12
    assert jobs[3].changes == changed.design_changes(jobs[3].point) != before


def test_a_goal_that_no_design_meets_is_told_with_the_nearest_design(made_up, tmp_path):
    text = TEXT + 'require = ["cof > 1.5", "cof > 0.1"]\n'
    result = Study(read_plan(text, EXAMPLES), tmp_path).run(workers=1)
    assert len(result.designs) == 12
    (best,) = np.flatnonzero(
        result.goal_values(result.designs)[:, 0] == result.goal_values(result.designs).max()
    )
    told = " ".join(result.headline())
    assert "No design meets every requirement: cof > 1.5 is" in told
    assert f"at best (design {result.designs[best].number})" in told
    assert "cof > 0.1 is" not in told
    assert result.front == result.best() == []
    assert "cof" in result.summary()


@pytest.mark.slow
def test_a_study_whose_designs_are_all_the_same_ends_and_tells_one(tmp_path, monkeypatch):
    """An input that changes nothing: every case has the same numbers."""

    def computed(base, job):
        return Record(job.key, Ending.COMPUTED, numbers={"cof": 0.25}, errors={"cof": 0.0})

    monkeypatch.setattr(study, "compute_job", computed)
    plan = read_plan(TEXT, EXAMPLES)
    result = Study(plan, tmp_path).run(workers=1)
    assert len(result.designs) == 12
    assert [one.number for one in result.front] == [0]
    assert "COF 0.25" in " ".join(result.headline())
    (surrogate,) = result.surrogates(plan.goals)
    mean, deviation = surrogate.prediction(np.array([[0.3]]))
    assert mean == pytest.approx(0.25)
    assert deviation < 1e-3


@pytest.mark.parametrize("place", range(0, 2400, 480))
def test_a_list_of_jobs_with_one_changed_byte_is_set_again(made_up, tmp_path, place):
    run(made_up, tmp_path, True)
    whole, path = answers(tmp_path), tmp_path / "jobs.jsonl"
    data = bytearray(path.read_bytes())
    data[place] ^= 2
    path.write_bytes(data)
    assert len(Store(tmp_path).jobs()) < 12
    Study(made_up, tmp_path).run(workers=1)
    assert answers(tmp_path) == whole


def test_an_optimisation_with_a_larger_budget_goes_on_from_what_is_finished(made_up, tmp_path):
    again = TEXT.replace('"none"', '"quick"\nagain = 2')
    run(read_plan(again, EXAMPLES), tmp_path, True)
    first = answers(tmp_path)
    assert [len(place) for _, place, _ in first] == [1] * 14 + [0]  # two again, and the start
    longer = Study(read_plan(again.replace("12", "20"), EXAMPLES), tmp_path)
    longer.run(workers=1)
    jobs = answers(tmp_path)
    assert jobs[:15] == first
    result = longer.result()
    assert len(result.designs) == 20
    numbers = [one.number for one in result.all_designs if one.again and one.point]
    assert len(set(numbers)) == len(numbers)  # none is run again twice
    assert set(numbers) >= {one.number for one in result.best(2)}
    assert not jobs[-1][1]
    assert not longer._begin_next()
    shorter = Study(made_up, tmp_path)
    shorter.run(workers=1)
    assert len(answers(tmp_path)) == 12  # anything else is another study


def test_a_process_that_begins_as_another_takes_the_lead_computes_none_of_its_cases(
    made_up, tmp_path, monkeypatch
):
    for at in range(40, 200):  # killed with the first cases open
        folder = tmp_path / str(at)
        calls(made_up, folder, True, at)
        helper = Store.open_folder(folder)
        if helper.round is not None:
            break
    taken, real = [], Round.other

    def other(self, alive):
        alone = real(self, alive)
        taken.extend(helper.take(in_order=False) or [])  # between the look and the next round
        return alone

    monkeypatch.setattr(Round, "other", other)
    Study(made_up, folder).run(workers=1)
    assert len(answers(folder)) == 12
    assert not taken


def test_a_block_that_is_finished_as_a_leader_looks_counts_as_finished(tmp_path):
    leader = begin_round(tmp_path, np.arange(2), 2, "leader")
    helper = latest_round(tmp_path, "helper", None)
    block, _, _ = helper.claim(lambda *_: True, in_order=True)

    def alive(owner, path):
        helper.finish(block)
        return True

    assert not leader.over(alive)
    helper.claim(alive, in_order=True)
    assert (leader.folder / f"{block}.done").exists()


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="the processes are forked")
def test_commands_killed_at_random_moments_leave_the_undisturbed_study():
    """Many more: ``python tests/study_kills.py 50``."""
    script = Path(__file__).parents[1] / "study_kills.py"
    run = [sys.executable, str(script), "4", "1"]
    done = subprocess.run(run, capture_output=True, text=True, check=False)
    assert "finished: equal, none twice, none left" in done.stdout, done.stdout + done.stderr
