"""Workers that end with their parent, however it ends; estimates of the time left."""

import io
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest
from hypothesis import given
from hypothesis import strategies as st
from short_work import fatal, fatal_once, squared, threads, wrong

from underfoot.core import Cancelled, UnderfootError
from underfoot.core import pool as pool_module
from underfoot.core import progress as progress_module
from underfoot.core.pool import answers_of, in_processes, kill_with
from underfoot.core.progress import TimeLeft, bar, part, silent

# A parent whose workers work for a minute: most in Python, some in a call that holds the lock.
PARENT = """
import ctypes, sys, time
from pathlib import Path
from underfoot.core.files import whole_folder
from underfoot.core.pool import in_processes

def work(number):
    Path(sys.argv[1], f"worker-{number}").write_text("")
    if number:
        ctypes.PyDLL(None).sleep(60)
    time.sleep(60)

if __name__ == "__main__":
    with whole_folder(Path(sys.argv[1], "out")) as folder:
        (folder / "half").write_text("x")
        list(in_processes(work, [0, 1], 2))
"""


@pytest.mark.parametrize(("processors", "taken"), [(1, 1), (4, 4), (16, 4)])
def test_as_many_work_as_there_are_processors_and_at_most_four(monkeypatch, processors, taken):
    monkeypatch.setattr(pool_module, "available_processors", lambda: processors)
    assert pool_module.workers(None) == taken
    assert pool_module.workers(7) == 7


@pytest.mark.parametrize("processes", [1, 2])
def test_answers_come_with_their_index_and_progress_ends_at_one(processes):
    told = []
    answers = in_processes(
        squared,
        [3, 4, 5],
        processes,
        progress=lambda stage, share, residual=None: told.append(share),
    )
    assert dict(answers) == {0: 9, 1: 16, 2: 25}
    assert told == pytest.approx([1 / 3, 2 / 3, 1])


def test_workers_have_one_thread_and_the_environment_comes_back(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    assert dict(in_processes(threads, [0, 1], 2)) == {0: "1", 1: "1"}
    assert os.environ["OMP_NUM_THREADS"] == "7"


def test_item_that_kills_its_worker_is_found_and_the_others_are_answered():
    answers = dict(in_processes(fatal, range(4), 2, died=lambda item: -item))
    assert answers == {0: 0, 1: 1, 2: -2, 3: 3}
    with pytest.raises(UnderfootError, match=r"ended without an answer.*memory"):
        list(in_processes(fatal, range(4), 2))


@pytest.mark.parametrize("processes", [1, 2])
def test_error_and_cancel_end_the_work_and_the_workers(processes):
    def workers():
        children = psutil.Process().children()
        return {p.pid for p in children if "spawn_main" in " ".join(p.cmdline())}

    before = workers()  # of pages that tests of this process showed
    with pytest.raises(ValueError, match="number"):
        list(in_processes(wrong, [1, 2], processes))

    def stop(stage, share, residual=None):
        raise Cancelled("stopped")

    with pytest.raises(Cancelled):
        list(in_processes(squared, [1, 2, 3], processes, progress=stop))
    assert not workers() - before


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_no_worker_and_no_hidden_folder_outlives_the_parent(tmp_path, number):
    script = tmp_path / "parent.py"
    script.write_text(PARENT)
    place = tmp_path / "work"
    place.mkdir()
    parent = subprocess.Popen(
        [sys.executable, str(script), str(place)], stderr=subprocess.DEVNULL, start_new_session=True
    )
    until(lambda: len(list(place.glob("worker-*"))) == 2, 60)
    family = psutil.Process(parent.pid).children(recursive=True)
    assert len(family) >= 3  # two workers and the guard of the folder
    os.kill(parent.pid, number)
    parent.wait(timeout=10)
    until(lambda: not [child for child in family if alive(child)], 3)
    until(lambda: {path.name for path in place.iterdir()} == {"worker-0", "worker-1"}, 3)


def alive(process):
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def until(condition, seconds):
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, f"not within {seconds} s"
        time.sleep(0.05)


def test_time_left_follows_the_rate_of_the_stage():
    left = TimeLeft()
    assert left("solve", 0.0, 10.0) is None
    assert left("solve", 0.25, 15.0) == pytest.approx(15.0)
    assert left("solve", 1.0, 30.0) == 0.0
    assert left("write", 0.5, 41.0) is None  # a new stage begins where it is first seen
    assert left("write", 0.75, 43.0) == pytest.approx(2.0)


@given(
    steps=st.lists(st.tuples(st.floats(0.01, 1.0), st.floats(1.0, 1.5)), min_size=30, max_size=60)
)
def test_time_left_of_steady_work_is_right_within_the_spread_of_its_rate(steps):
    total, whole = sum(size for size, _ in steps), sum(size * pace for size, pace in steps)
    left, done, now = TimeLeft(), 0.0, 0.0
    assert left("solve", 0.0, 0.0) is None
    for size, pace in steps[:-1]:
        done, now = done + size, now + size * pace
        seconds = left("solve", done / total, now)
        if done < 0.1 * total:
            assert seconds is None
        elif done > 0.11 * total:
            assert seconds is not None
            assert (whole - now) / 1.51 < seconds < 1.51 * (whole - now)


@given(
    reports=st.lists(st.tuples(st.floats(0.0, 0.2), st.floats(0.0, 1e4)), min_size=2, max_size=40)
)
def test_no_time_left_is_beyond_nine_times_the_time_spent(reports):
    """A march that hardly gets on was once told to have 102 h left after some minutes."""
    left, done, now = TimeLeft(), 0.0, 0.0
    for gain, seconds in [(0.0, 0.0), *reports]:
        done, now = min(1.0, done + gain), now + seconds
        estimate = left("solve", done, now)
        assert estimate is None or 0.0 <= estimate <= 9.001 * now


def test_work_that_stalls_or_starts_slowly_has_no_estimate():
    left = TimeLeft()
    for now in range(600):
        assert left("solve", 0.008 + 1e-5 * now, float(now)) is None
    for now in range(600, 660):  # then a march in its usual pace
        last = left("solve", 0.014 + 0.01 * (now - 600), float(now))
    assert last is None  # ten minutes of a tenth's work: its rate says nothing
    left = TimeLeft()
    for now in range(50):
        steady = left("solve", 0.01 * now, float(now))
    assert steady == pytest.approx(51.0)
    for now in range(50, 200):
        stalled = left("solve", 0.49, float(now))
    assert stalled is None


def test_lines_come_outside_a_terminal_after_a_while_and_not_too_often(monkeypatch, capsys):
    clock = [0.0]
    monkeypatch.setattr(progress_module.time, "monotonic", lambda: clock[0])
    with bar("shoe") as report:
        for clock[0] in (0.0, 1.0, 3.0, 4.0, 9.0):
            report("solve", clock[0] / 10)
    lines = capsys.readouterr().err.splitlines()
    assert lines == [
        "shoe: solve, 30 %, 3 s so far, about 7 s left",
        "shoe: solve, 90 %, 9 s so far, about 1 s left",
    ]


def test_the_guard_restores_the_old_folder_of_a_process_killed_between_two_renames(tmp_path):
    script = (
        "import os, sys\nfrom pathlib import Path\nfrom underfoot.core import files\n"
        "plain = Path.rename\n"
        "def rename(self, target):\n"
        "    plain(self, target)\n"
        "    os.kill(os.getpid(), 9)\n"
        "out = Path(sys.argv[1], 'out')\n"
        "with files.whole_folder(out) as folder: (folder / 'a').write_text('1')\n"
        "Path.rename = rename\n"
        "with files.whole_folder(out, overwrite=True) as folder: (folder / 'b').write_text('2')\n"
    )
    subprocess.run([sys.executable, "-c", script, str(tmp_path)], check=False)
    until(lambda: [path.name for path in tmp_path.iterdir()] == ["out"], 3)
    assert (Path(tmp_path) / "out" / "a").read_text() == "1"


def test_a_dead_worker_is_replaced_and_its_item_tried_once_more(tmp_path):
    places = [str(tmp_path / name) for name in "abc"]
    assert dict(in_processes(fatal_once, places, 2)) == dict.fromkeys(range(3), "second try")


def test_items_are_taken_when_a_worker_is_free():
    taken = []

    def items():
        for number in range(6):
            taken.append(number)
            yield number

    answers = answers_of(squared, items(), 2, died=squared)
    assert next(answers) in (0, 1)
    assert len(taken) <= 4
    assert sorted(answers)[-1] == 25


def test_a_script_without_a_guard_of_main_does_the_work_itself(tmp_path):
    script = tmp_path / "bare.py"
    script.write_text(
        "from underfoot.core.pool import in_processes\n"
        "print(dict(in_processes(abs, [-1, -2, -3], 2)))\n"
    )
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stdout.splitlines()[-1] == "{0: 1, 1: 2, 2: 3}"


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_progress_is_one_line_on_80_columns_and_no_number_is_cut(monkeypatch):
    screen = Terminal()
    monkeypatch.setattr("sys.stderr", screen)
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("TERM", "xterm")
    with bar("Running") as report:
        for step in range(12):
            report("contact and film, position 3 of 8, averaged over it", step / 12, 1.2e-4)
            time.sleep(0.03)
    plain = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", screen.getvalue())
    lines = [line for line in re.split(r"[\r\n]+", plain) if line.strip()]
    assert max(map(len, lines)) <= 80
    assert all("residual 1.2e-04" in line and " % " in line for line in lines[1:])


@pytest.mark.parametrize("told", [{}, {"by_kernel": False}, {"by_kernel": True}])
@pytest.mark.parametrize("orphan", [False, True])
def test_the_kernel_kills_a_process_with_its_parent_unless_it_is_told_not_to(
    monkeypatch, told, orphan
):
    """One whose parent has ended before it asks ends by itself: no signal would come."""
    asked, ended = [], []
    system = SimpleNamespace(prctl=lambda *given: asked.append(given))
    monkeypatch.setattr(pool_module, "ctypes", SimpleNamespace(CDLL=lambda _: system))
    monkeypatch.setattr(pool_module, "sys", SimpleNamespace(platform="linux"))
    monkeypatch.setattr(pool_module.os, "_exit", ended.append)
    kill_with(os.getppid() + orphan, **told)
    on_death = 1  # PR_SET_PDEATHSIG of <sys/prctl.h>
    by_kernel = told.get("by_kernel", True)
    assert asked == [(on_death, signal.SIGKILL)] * by_kernel
    assert ended == [1] * (by_kernel and orphan)


@pytest.mark.parametrize("told", [{}, {"kill": False}, {"kill": True}])
def test_workers_are_let_go_when_they_find_nothing_to_do_and_killed_only_where_nobody_waits(told):
    done = []

    def worker(name: str) -> Any:
        process = SimpleNamespace(
            kill=lambda: done.append(f"kill {name}"), join=lambda: done.append(f"join {name}")
        )
        pipe = SimpleNamespace(close=lambda: done.append(f"close {name}"))
        return SimpleNamespace(process=process, pipe=pipe)

    pool: Any = pool_module._Pool(abs, 2)
    pool.workers = [worker("a"), worker("b")]
    pool.end(**told)
    assert [each for each in done if each.startswith("kill")] == ["kill a", "kill b"] * bool(
        told.get("kill")
    )
    # every pipe is closed before any worker is waited for: they end at the same time
    assert done.index("close b") < done.index("join a")
    assert done.index("join b") == len(done) - 1
    assert pool.workers == []


@pytest.mark.parametrize(("low", "high"), [(0.9, 2.0), (0.5, 0.4), (-0.1, 1.0)])
def test_a_part_of_a_progress_lies_within_it(low, high):
    with pytest.raises(ValueError, match="no part of a progress"):
        part(silent, low, high)
