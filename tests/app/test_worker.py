"""A process that stays warm: answers, progress, cancel, death."""

import os
import signal
import subprocess
import sys
import time

import pytest

from underfoot.core import InputError, UnderfootError
from underfoot.core.errors import Cancelled
from underfoot.core.pool import in_processes
from underfoot.core.worker import Worker

KEPT: list[int] = []


def counted(step, progress):
    """Return how often this process was asked."""
    KEPT.append(step)
    progress("counting", 0.5, 1e-3)
    return len(KEPT), os.getpid()


def patient(seconds, progress):
    """Work for a while and listen."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        progress("waiting", 0.1)
        time.sleep(0.01)


def deaf(seconds, progress):
    """Work for a while without listening."""
    progress("deaf", 0.1)
    time.sleep(seconds)


def refused(progress):
    """Refuse its input."""
    raise InputError("no", where="speed", allowed="yes")


@pytest.fixture(scope="module")
def worker():
    with Worker() as one:
        yield one


def test_a_worker_keeps_what_it_has_between_jobs(worker):
    first, process = worker.wait(worker.submit(counted, 1))
    job = worker.submit(counted, 2)
    assert worker.wait(job) == (first + 1, process)
    assert process != os.getpid()
    assert (job.stage, job.residual, job.fraction) == ("counting", 1e-3, 1.0)


def test_errors_of_the_function_arrive_as_they_are(worker):
    with pytest.raises(InputError, match="speed"):
        worker.wait(worker.submit(refused))
    assert not worker.busy


def test_one_job_at_a_time(worker):
    job = worker.submit(patient, 5.0)
    with pytest.raises(UnderfootError, match="busy"):
        worker.submit(counted, 1)
    with pytest.raises(UnderfootError, match="not done"):
        job.result()
    worker.cancel()


def test_a_cancelled_job_stops_and_the_process_stays(worker):
    _, process = worker.wait(worker.submit(counted, 1))
    job = worker.submit(patient, 30.0)
    while not job.stage:
        worker.poll(0.1)
    assert worker.cancel() is job
    with pytest.raises(Cancelled):
        job.result()
    assert worker.wait(worker.submit(counted, 1))[1] == process


@pytest.mark.parametrize("end", ["cancel", "kill"])
def test_a_deaf_or_killed_process_is_replaced(worker, end):
    _, process = worker.wait(worker.submit(counted, 1))
    job = worker.submit(deaf, 30.0)
    while not job.stage:
        worker.poll(0.1)
    if end == "cancel":
        worker.cancel()
    else:
        os.kill(process, signal.SIGKILL)
        while not job.done:
            worker.poll(0.1)
    with pytest.raises(UnderfootError):
        job.result()
    count, other = worker.wait(worker.submit(counted, 1))
    assert count == 1
    assert other != process


def shared(count, progress):
    """Return numbers that two workers of the warm process computed."""
    return sorted(number for _, number in in_processes(abs, range(-count, 0), 2))


def test_a_warm_process_may_have_workers_of_its_own():
    with Worker() as worker:
        assert worker.wait(worker.submit(shared, 3)) == [1, 2, 3]


def test_a_program_ends_though_its_worker_was_not_closed(tmp_path):
    script = tmp_path / "ends.py"
    script.write_text(
        "from underfoot.core.worker import Worker\n"
        "if __name__ == '__main__':\n    Worker()\n    kept = Worker()\n"
    )
    subprocess.run([sys.executable, script], check=True, timeout=60)
