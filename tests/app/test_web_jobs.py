"""Jobs: order, progress, cancel at once, what a killed server leaves."""

import asyncio
import json
import os
import shutil
import time

import pytest

pytest.importorskip("nicegui")

from machine import slowness
from underfoot.app.jobs import JobQueue, Lane
from underfoot.core.errors import Cancelled

HERE = "short_jobs:"


@pytest.fixture
def path(monkeypatch):
    here = os.path.dirname(__file__)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([here, os.environ.get("PYTHONPATH", "")]))


async def with_jobs(folder, work):
    jobs = JobQueue(folder)
    runner = asyncio.create_task(jobs.run())
    try:
        return await work(jobs)
    finally:
        runner.cancel()
        jobs.close()


@pytest.mark.usefixtures("path")
def test_jobs_run_in_order_and_say_what_went_wrong(tmp_path):
    async def work(jobs):
        tasks = [jobs.submit("a", HERE + "doubled", n, about="x") for n in (1, 2)]
        tasks += [jobs.submit("b", HERE + name) for name in ("refused", "killed")]
        tasks.append(jobs.submit("c", HERE + "doubled", 3))
        for task in tasks:
            await jobs.wait_for(task)
        assert jobs.latest("x", HERE + "doubled") is tasks[1]
        return tasks

    one, two, bad, dead, last = asyncio.run(with_jobs(tmp_path, work))
    assert (one.answer, two.answer, last.answer) == (2, 4, 6)
    assert bad.state == "failed"
    assert bad.problem == "motion.speed: too fast. Allowed: at most 5 m/s."
    read = JobQueue(tmp_path).tasks[bad.number].problem
    assert (read, read.page_data()) == (bad.problem, bad.problem.page_data())
    assert "died" in dead.problem
    assert one.ended <= two.began


@pytest.mark.usefixtures("path")
def test_a_run_does_not_wait_for_a_study(tmp_path, monkeypatch):
    code = "import time\ndef study(progress):\n    progress('deaf', 0.1)\n    time.sleep(60)\n"
    (tmp_path / "beside.py").write_text(code)
    monkeypatch.syspath_prepend(tmp_path)

    async def work(jobs):
        study, second = (jobs.submit("study", "beside:study") for _ in range(2))
        while study.stage != "deaf":
            await asyncio.sleep(0.01)
        ran = await jobs.wait_for(jobs.submit("run", HERE + "doubled", 2))
        assert (ran.answer, study.state, second.state) == (4, "running", "waiting")
        jobs.cancel(study)
        while second.stage != "deaf":
            await asyncio.sleep(0.01)
        jobs.cancel(second)
        await jobs.wait_for(second)

    asyncio.run(with_jobs(tmp_path, work))


@pytest.mark.usefixtures("path")
def test_cancel_is_heeded_at_once_even_by_a_job_that_does_not_listen(tmp_path):
    async def work(jobs):
        task, waiting = (jobs.submit("deaf", HERE + "deaf", 60) for _ in range(2))
        while task.stage != "deaf":
            await asyncio.sleep(0.01)
        began = time.monotonic()
        jobs.cancel(waiting)
        jobs.cancel(task)
        await jobs.wait_for(task)
        return task, waiting, time.monotonic() - began

    task, waiting, took = asyncio.run(with_jobs(tmp_path, work))
    assert task.state == waiting.state == "stopped"
    assert took < 0.5 * slowness()


@pytest.mark.usefixtures("path")
def test_a_restart_shows_what_finished_and_what_was_interrupted(tmp_path):
    async def work(jobs):
        await jobs.wait_for(jobs.submit("one", HERE + "doubled", 1, about="x"))
        long, _ = (jobs.submit("two", HERE + "deaf", 60, about=a) for a in "yz")
        while long.stage != "deaf":
            await asyncio.sleep(0.01)

    asyncio.run(with_jobs(tmp_path, work))
    again = JobQueue(tmp_path)
    states = {task.about: task.state for task in again.tasks.values()}
    assert states == {"x": "done", "y": "interrupted", "z": "interrupted"}
    assert {task.about: task.state for task in JobQueue(tmp_path).tasks.values()} == states

    async def once_more(jobs):
        return await jobs.wait_for(jobs.again(jobs.tasks[1]))

    assert asyncio.run(with_jobs(tmp_path, once_more)).answer == 2


@pytest.mark.usefixtures("path")
def test_who_leaves_does_not_keep_the_process_busy():
    async def work():
        lane = Lane()
        try:
            with pytest.raises(asyncio.TimeoutError):
                await asyncio.wait_for(lane.ask(HERE + "deaf", 0.5), 0.1)
            assert await lane.ask(HERE + "doubled", 4) == 8
            asked = asyncio.create_task(lane.ask(HERE + "deaf", 60))
            await asyncio.sleep(0.2)
            lane.stop()
            with pytest.raises(Cancelled):
                await asked
            assert await lane.ask(HERE + "doubled", 5) == 10
        finally:
            lane.close()

    asyncio.run(work())


@pytest.mark.usefixtures("path")
def test_a_project_that_was_copied_computes_in_the_copy(tmp_path):
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()

    async def submitted(jobs):
        task = jobs.submit("a", HERE + "doubled", str(here / "variants" / "a.toml"), about="a")
        await jobs.wait_for(task)
        return task.arguments

    async def read(jobs):
        return next(iter(jobs.tasks.values())).arguments

    before = asyncio.run(with_jobs(here, submitted))
    shutil.copytree(here, there)
    shutil.rmtree(here)
    (after,) = asyncio.run(with_jobs(there, read))
    assert [str(here / "variants" / "a.toml")] == list(before)
    assert after == str(there / "variants" / "a.toml")
    assert str(tmp_path) not in (there / "jobs.jsonl").read_text()


@pytest.mark.usefixtures("path")
def test_what_a_person_waits_for_comes_first_and_all_can_be_stopped(tmp_path):
    async def work(jobs):
        first, *rest = (jobs.submit("many", HERE + "deaf", 60, about=str(n)) for n in range(60))
        while first.stage != "deaf":
            await asyncio.sleep(0.01)
        one, two = (jobs.submit("one", HERE + "doubled", n, first=True) for n in (1, 2))
        jobs.cancel(first)
        await jobs.wait_for(two)
        assert one.ended <= two.began
        jobs.cancel_all(HERE + "deaf")
        for task in (first, *rest):
            await jobs.wait_for(task)
        return one, rest

    one, rest = asyncio.run(with_jobs(tmp_path, work))
    assert (one.state, one.answer) == ("done", 2)
    assert {task.state for task in rest} == {"stopped"}


def test_a_long_queue_that_a_kill_interrupted_is_read_again(tmp_path):
    lines = [{"number": n, "title": "run", "about": str(n), "state": "done"} for n in range(1, 60)]
    lines += [{"number": n, "title": "run", "about": str(n), "state": "waiting"}
              for n in range(60, 63)]  # fmt: skip
    (tmp_path / "jobs.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    tasks = JobQueue(tmp_path).tasks
    assert [tasks[n].state for n in (60, 61, 62)] == ["interrupted"] * 3
