"""Kills the commands of a study of made-up cases at random moments, then lets it finish.

``python tests/study_kills.py 50 [SEED]``: one ``underfoot study run`` and two ``underfoot study
work`` share a folder; 50 times one of the three is killed with SIGKILL and begins again. Then all
are killed and ``study run`` finishes. The study must be the one of an undisturbed run, to the last
digit: every design that it planned, none computed twice, no claim, process or half of a file left.
"""

import os
import random
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from hashlib import blake2b
from pathlib import Path

import numpy as np
import psutil

from underfoot.cli import main
from underfoot.explore import plan as plan_module
from underfoot.explore import proposals, records, study
from underfoot.explore.lines import whole_lines
from underfoot.explore.record import Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.report import live_study as live

BASE = (Path(__file__).parents[1] / "examples" / "work_shoe_untreaded_glycerol.toml").as_posix()
TEXT = f"""\
base = "{BASE}"
[vary]
"motion.speed" = {{ from = "0.3 m/s", to = "0.7 m/s" }}
[method]
kind = "optimise"
budget = BUDGET
batch = 40
front_grid = "none"
[outputs]
maximise = ["cof"]
"""
CASE = 0.02
"""s that a made-up case sleeps while processes are killed; nothing is solved."""
LIFE = 1.5
"""s between two kills at most."""
EACH = 120
"""Designs of the study for each kill."""


sleep = [CASE]


def made_up() -> None:
    """Make cases numbers, and proposals such that every finished case matters."""

    def key(self, changes, quick):
        return blake2b(repr((changes, quick)).encode(), digest_size=12).hexdigest()

    def computed(base, job):
        time.sleep(sleep[0])
        cof = float(np.sin(37.0 * job.point[0]) ** 2)
        return Record(job.key, Ending.COMPUTED, numbers={"cof": cof}, draws=np.full(50, cof))

    def promising(so_far, count):
        values = so_far.goal_values(so_far.designs)[:, 0]
        assert np.isfinite(values).all()
        shift = float(values.sum()) % 1.0
        return [((shift + k / 41) % 1.0,) for k in range(count)]

    plan_module.StudyPlan._key = key
    study.compute_job = computed
    proposals._promising = promising
    study.PAUSE, records.PACK = 0.05, 10**9
    live.PERIOD, live.SHARE = 0.2, 10.0  # pages are written as often as they can be


def forked(function: Callable[..., object], *arguments: object) -> int:
    """Begin a function in a process of its own, and return its number."""
    number = os.fork()
    if number:
        return number
    code = 70
    try:
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)
        os.dup2(nothing, 2)
        function(*arguments)
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(bool(end.code))
    finally:
        os._exit(code)


def command(*words: str) -> None:
    """Be an ``underfoot study`` command."""
    sys.argv = ["underfoot", "study", *words]
    main()


def finish(folder: Path, file: Path) -> None:
    """Do what ``study run`` does, without a report."""
    Study.load(file, folder).run(workers=1)


def finished(folder: Path, file: Path) -> list[tuple]:
    """Run a study to its end and return design, place, number and draws of every case."""
    _, status = os.waitpid(forked(finish, folder, file), 0)
    assert os.waitstatus_to_exitcode(status) == 0
    result = Study.load(folder).result()
    rows = [(job.design, job.point, result.record(job)) for job in result.jobs]
    return [(number, point, one.numbers["cof"], one.draws.tolist()) for number, point, one in rows]


def kill(folder: Path, file: Path, count: int, generator: random.Random) -> int:
    """Kill one of three commands so many times, then all; return how many were alive when killed.

    One that ended by itself, because another led as it began, counts as none.
    """
    at = (str(file), "--out", str(folder), "--workers", "1")
    words = [("run", *at), ("work", *at), ("work", *at)]
    alive = [forked(command, *each) for each in words]
    killed = 0
    while killed < count:
        time.sleep(generator.uniform(0.0, LIFE))
        place = generator.randrange(len(alive))
        for k, number in enumerate(alive):
            if k == place:
                os.kill(number, signal.SIGKILL)
            ended, status = os.waitpid(number, 0 if k == place else os.WNOHANG)
            if ended:
                killed += os.WIFSIGNALED(status)
                alive[k] = forked(command, *words[k])
    for number in alive:
        os.kill(number, signal.SIGKILL)
        os.waitpid(number, 0)
    return killed


def check(count: int, seed: int, place: Path) -> str:
    """Kill and finish a study, and assert that it is the undisturbed one; return what was done."""
    file = place / "killed.toml"
    file.write_text(TEXT.replace("BUDGET", str(EACH * count)), encoding="utf-8")
    made_up()
    Study.load(file)  # what every process reads first is read once, as is
    killed = kill(place / "killed", file, count, random.Random(seed))
    folder = place / "killed"
    before = Store(folder)
    done, planned = len(before.records()), EACH * count
    assert done < planned, "the study ended before the last kill: raise EACH"
    sleep[0] = 0.0
    rows = finished(folder, file)
    whole = finished(place / "whole", file)
    assert len(rows) == len(whole) == planned
    assert rows == whole
    lines = sum(1 for path in folder.glob("cases-*") for _ in whole_lines(path))
    twice = lines - len(Store(folder).records())
    left = [path.name for path in folder.rglob(".*") if path.name != ".underfoot"]
    assert not left, left
    assert not Store(folder).other
    assert not psutil.Process().children()
    assert all(one["ended"] for one in Store(folder).sessions())
    assert twice == 0, f"{twice} cases were computed twice"
    return f"{killed} kills, {done} of {planned} cases then; finished: equal, none twice, none left"


if __name__ == "__main__":
    repeats, chosen = int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0
    with tempfile.TemporaryDirectory() as temporary:
        print(check(repeats, chosen, Path(temporary)))
