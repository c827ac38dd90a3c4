"""``underfoot study`` as a person meets it: run, stopped in every way, gone on with, helped."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from commands import COMMAND, called
from machine import slowness
from underfoot.case import load
from underfoot.explore import Study
from underfoot.explore.store import Store

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDY = f"""\
base = "{(EXAMPLES / "work_shoe_untreaded_glycerol.toml").as_posix()}"
[set]
"numerics.quick_grid_spacing" = "3 mm"
"numerics.grid_spacing" = "3 mm"
"numerics.cells_along" = 1
"numerics.tread_positions" = 1
[vary]
"shoe.heel.profile.angle" = {{ from = "6 deg", to = "14 deg", steps = STEPS }}
"shoe.material.shore_a" = {{ from = 50, to = 70, steps = 2 }}
[outputs]
maximise = ["cof"]
minimise = ["stiffness"]
[method]
fields = true
"""


def numbers(folder):
    """Return what each case gave, and make sure that no case was done twice."""
    if not Path(folder).is_dir():
        return {}
    records = Store(folder).records()
    lines = sum(len(path.read_text().splitlines()) for path in Path(folder).glob("cases-*.jsonl"))
    assert len(records) in (lines, lines - 1)  # the last one may be half written
    return {
        key: (str(one.ending), one.numbers, one.spreads, one.draws.tolist())
        for key, one in records.items()
    }


def until(condition, seconds=90):
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, f"not within {seconds} s"
        time.sleep(0.05)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Return the folder of a study that ran without a break, in this process."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "heel.toml").write_text(STUDY.replace("STEPS", "2"))
    done = called("study", "run", "heel.toml", "--workers", "1", folder=folder)
    assert done.returncode == 0, done.stderr
    return folder, done


def test_a_study_leaves_tables_and_a_page_and_says_what_came_of_it(finished):
    folder, done = finished
    assert "4 of 4 cases of 4 designs ended: 4 computed." in done.stdout
    assert "The front has" in done.stdout
    names = {path.name for path in (folder / "out" / "heel").iterdir()}
    assert {"results.csv", "results.parquet", "report.html", "study.toml"} <= names
    page = (folder / "out" / "heel" / "report.html").read_text()
    assert page.count("<template data-sole=") >= 1
    assert "http://" not in page.replace("http://www.w3.org", "")


WITHOUT_EXTRAS = """\
from importlib.machinery import PathFinder

real = PathFinder.find_spec
EXTRAS = {"duckdb", "SALib", "pymoo", "moocore", "zarr", "emcee", "dask", "distributed"}


def find_spec(name, path=None, target=None):
    return None if name.partition(".")[0] in EXTRAS else real(name, path, target)


PathFinder.find_spec = staticmethod(find_spec)
"""


@pytest.mark.slow
def test_a_plain_sweep_needs_no_extra(tmp_path):
    """Neither the command nor its workers can import one: Python reads sitecustomize first."""
    text = STUDY.replace("STEPS", "2").split("[outputs]")[0]
    (tmp_path / "heel.toml").write_text(text)
    (tmp_path / "sitecustomize.py").write_text(WITHOUT_EXTRAS)
    place = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"}

    def ran(*words, code=0):
        run = [*COMMAND, "study", *words]
        done = subprocess.run(
            run, cwd=tmp_path, env=place, capture_output=True, text=True, check=False
        )
        assert done.returncode == code, done.stderr
        return done

    told = ran("check", "heel.toml", "--timed", "3").stdout
    assert "by 3 finished cases" in " ".join(told.split())
    done = ran("run", "heel.toml", "--workers", "2")
    assert "4 of 4 cases of 4 designs ended: 4 computed." in done.stdout
    names = {path.name for path in (tmp_path / "out" / "heel").iterdir()}
    assert {"results.csv", "report.html"} <= names
    assert "results.parquet" not in names
    told = ran("run", "heel.toml", "--out", "x", "--on", "dask", code=5).stderr
    assert 'pip install "underfoot[dask]"' in told


def test_check_status_best_and_export(finished):
    folder, _ = finished
    plain = json.loads(called("study", "check", "heel.toml", "--json", folder=folder).stdout)
    assert (plain["cases"], plain["infeasible"]) == (4, {})
    plain = json.loads(called("study", "status", "out/heel", "--json", folder=folder).stdout)
    assert plain["endings"] == {"computed": 4}
    assert 0.3 < plain["busy"] <= 1.0
    best = json.loads(called("study", "best", "out/heel", "--json", folder=folder).stdout)
    assert all(one["front"] for one in best)
    called("study", "export", "out/heel", "given", "--count", "1", "--no-step", folder=folder)
    (case,) = (folder / "given").glob("design_*.toml")
    assert "profile" in case.read_text()
    assert (folder / "given" / "results.csv").stat().st_size > 500
    maps = Study.load(folder / "out" / "heel").store.maps(next(iter(numbers(folder / "out/heel"))))
    assert maps is not None
    assert "contact_pressure" in maps


@pytest.mark.slow
def test_killed_at_any_time_it_goes_on_and_gives_the_same(finished, tmp_path):
    folder, _ = finished
    (tmp_path / "heel.toml").write_text((folder / "heel.toml").read_text())
    run = [*COMMAND, "study", "run", "heel.toml", "--workers", "2"]
    with (tmp_path / "log").open("w") as log:
        master = subprocess.Popen(run, cwd=tmp_path, stdout=log, stderr=log)
        store = tmp_path / "out" / "heel"
        until(lambda: len(numbers(store)) >= 1)
        worker = next(
            one
            for one in psutil.Process(master.pid).children()
            if "spawn_main" in " ".join(one.cmdline())
        )
        worker.kill()  # a worker first: it is replaced
        until(lambda: len(numbers(store)) >= 3 or master.poll() is not None)
        os.kill(master.pid, signal.SIGKILL)
        master.wait()
    before = numbers(store)
    study = Study.load(store)
    began = time.process_time()
    opened = study.result().endings["open"]
    assert time.process_time() - began < 5.0 * slowness()
    assert opened == len(numbers(folder / "out" / "heel")) - len(before)
    called("study", "run", "heel.toml", "--workers", "1", folder=tmp_path)
    assert numbers(store) == numbers(folder / "out" / "heel")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "word", "code"),
    [
        (signal.SIGINT, "stopped", 130),
        (signal.SIGTERM, "terminated", 143),
    ],
)
def test_stopped_it_says_what_is_kept_and_leaves_no_claim(tmp_path, number, word, code):
    (tmp_path / "heel.toml").write_text(STUDY.replace("STEPS", "20"))
    run = [*COMMAND, "study", "run", "heel.toml", "--out", "x", "--workers", "2"]
    store = tmp_path / "x"
    with subprocess.Popen(run, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as master:
        until(lambda: len(numbers(store)) >= 1)
        master.send_signal(number)
        began = time.monotonic()
        _, said = master.communicate(timeout=60)
    assert time.monotonic() - began < 5.0 * slowness()
    assert master.returncode == code, said
    assert f"{word}; every finished case is kept; the same command goes on" in said
    assert not Store(store).other
    assert Study.load(store).result().endings["open"] == 40 - len(numbers(store))


@pytest.mark.slow
def test_the_best_designs_leave_as_solids(finished, tmp_path):
    pytest.importorskip("netgen")
    folder, _ = finished
    study = Study.load(folder / "out" / "heel")
    called("study", "export", study.store.folder, "given", "--count", "2", folder=tmp_path)
    for one in study.result().best(2):
        case = load(tmp_path / "given" / f"design_{one.number}.toml")
        assert case.shoe.heel.profile.angle == one.changes["shoe.heel.profile.angle"]
        text = (tmp_path / "given" / f"design_{one.number}.step").read_text()
        assert text.startswith("ISO-10303-21")
        assert "MANIFOLD_SOLID_BREP" in text


@pytest.mark.slow
def test_two_that_share_a_folder_without_a_master_give_the_same(finished, tmp_path):
    folder, _ = finished
    (tmp_path / "heel.toml").write_text((folder / "heel.toml").read_text())
    work = [*COMMAND, "study", "work", "heel.toml"]
    both = [
        subprocess.Popen(work, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        for _ in range(2)
    ]
    texts = [one.communicate(timeout=200)[0].decode() for one in both]
    assert all("is done" in text for text in texts)
    assert numbers(tmp_path / "out" / "heel") == numbers(folder / "out" / "heel")
    assert len(list((tmp_path / "out" / "heel").glob("cases-*.jsonl"))) == 2


@pytest.mark.slow
def test_a_case_that_kills_its_workers_is_on_record_and_the_others_go_on(tmp_path):
    """A friction option that ends the process at one hardness: twice, then it is 'crashed'."""
    (tmp_path / "deadly.py").write_text(
        "import os\nfrom underfoot.case.friction import ConstantOption\n\n\n"
        "class Deadly(ConstantOption):\n    name = 'deadly'\n\n"
        "    def build(self, context):\n"
        "        if abs(self.cof - 0.5) < 1e-9:\n            os.kill(os.getpid(), 9)\n"
        "        return super().build(context)\n"
    )
    text = STUDY.split("[vary]")[0].replace("[set]", '[set]\n"friction.model" = "deadly:Deadly"')
    text += '[vary]\n"friction.cof" = [0.4, 0.5, 0.6]\n'
    (tmp_path / "deadly.toml").write_text(text.replace("[set]", '[set]\n"friction.cof" = 0.4'))
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"}
    run = [*COMMAND, "study", "run", "deadly.toml", "--workers", "2"]
    done = subprocess.run(
        run, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=200, check=False
    )
    assert "2 computed" in done.stdout, done.stdout + done.stderr
    assert "1 crashed" in done.stdout
    assert "twice: killed, or out of" in done.stdout


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[vary]\n", ["base", "is missing"]),
        ("base = [", ["no TOML file"]),
        ('base = "nowhere.toml"', ["there is no file"]),
        ("\x00\x01", ["TOML"]),
    ],
)
def test_hostile_study_files_get_sentences(tmp_path, text, words):
    (tmp_path / "bad.toml").write_text(text)
    done = called("study", "check", "bad.toml", folder=tmp_path)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    for word in words:
        assert word in done.stderr


def test_a_scheduler_that_is_not_there_is_named(finished, tmp_path):
    pytest.importorskip("distributed")
    folder, _ = finished
    address = "dask:tcp://127.0.0.1:9"
    run = ("study", "run", folder / "heel.toml", "--out", "x", "--on", address)
    done = called(*run, folder=tmp_path)
    assert done.returncode == 2
    assert "no Dask scheduler answers at tcp://127.0.0.1:9" in done.stderr


@pytest.mark.slow
def test_a_dask_cluster_that_loses_a_worker_and_then_its_scheduler(finished, tmp_path):
    """Scheduler and workers are processes of their own, as on several machines."""
    pytest.importorskip("distributed")
    folder, _ = finished
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--no-dashboard"]
    address = "tcp://127.0.0.1:8797"
    work = [sys.executable, "-m", "distributed.cli.dask_worker", address]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    run = [*COMMAND, "study", "run", folder / "heel.toml", "--out", "x", "--on", f"dask:{address}"]
    store = tmp_path / "x"
    scheduler = subprocess.Popen([*dask, "--port", "8797"], cwd=tmp_path, **quiet)
    workers = [
        subprocess.Popen([*work, "--nthreads", "1", "--no-dashboard"], cwd=tmp_path, **quiet)
        for _ in range(2)
    ]
    try:
        with subprocess.Popen(run, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as master:
            until(lambda: len(numbers(store)) >= 1)
            for child in psutil.Process(workers[0].pid).children():
                child.kill()  # the nanny starts another
            until(lambda: len(numbers(store)) >= 2)
            scheduler.kill()
            _, said = master.communicate(timeout=120)
        assert master.returncode == 1
        assert "the Dask scheduler tcp://127.0.0.1:8797 went away" in said
        assert "Finished cases are kept" in said
        assert "Traceback" not in said
    finally:
        for started in (scheduler, *workers):
            started.kill()
            started.wait()
    called("study", "run", folder / "heel.toml", "--out", "x", "--workers", "1", folder=tmp_path)
    assert numbers(store) == numbers(folder / "out" / "heel")


@pytest.mark.slow
def test_a_dask_cluster_that_loses_a_worker_gives_the_same(finished, tmp_path):
    pytest.importorskip("distributed")
    folder, _ = finished
    run = [*COMMAND, "study", "run", folder / "heel.toml", "--out", "x"]
    run += ["--on", "dask", "--workers", "2"]
    with (tmp_path / "log").open("w") as log:
        master = subprocess.Popen(run, cwd=tmp_path, stdout=log, stderr=log)
        until(lambda: len(numbers(tmp_path / "x")) >= 1)
        workers = [
            one
            for one in psutil.Process(master.pid).children(recursive=True)
            if "spawn_main" in " ".join(one.cmdline())
        ]
        workers[-1].kill()
        assert master.wait(timeout=240) == 0, (tmp_path / "log").read_text()
    assert numbers(tmp_path / "x") == numbers(folder / "out" / "heel")
