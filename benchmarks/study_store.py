"""The store of a study at the size of a cluster, with made-up cases: nothing is solved.

``python -m benchmarks study_store`` sets cases and lets processes work on them as ``study work``
does, then opens the study again. UNDERFOOT_BENCH_CASES (20,000) and UNDERFOOT_BENCH_WORKERS (50)
set its size; a million cases in the order of 500 workers:

    UNDERFOOT_BENCH_CASES=1000000 UNDERFOOT_BENCH_WORKERS=500 python -m benchmarks study_store

Workers take turns on the processors there are: each is a ``Store`` of its own with its own files
and claims, and one process goes round them, a case each. CPU and operations are counted there, not
waits; fsync is counted and not done. An operation is a call to the file system: what a network file
system sends, a listing counts once for each 100 names. A few real processes
(UNDERFOOT_BENCH_PROCESSES, 4) show their memory first.
"""

from __future__ import annotations

import multiprocessing
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.explore.record import CaseJob, Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan

EXAMPLES = Path(__file__).parents[1] / "examples"
CASES = int(os.environ.get("UNDERFOOT_BENCH_CASES", "20000"))
WORKERS = int(os.environ.get("UNDERFOOT_BENCH_WORKERS", "50"))
PROCESSES = int(os.environ.get("UNDERFOOT_BENCH_PROCESSES", "4"))
TEXT = """
base = "work_shoe_untreaded_glycerol.toml"
[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s" }
[method]
budget = 1000000
"""
OUTPUTS = {f"output_{k:02}": 0.1 + k / 7 for k in range(40)}
"""As many numbers as a result has."""
DRAWS = np.random.default_rng(0).normal(0.2, 0.02, 500)
CALLS = ["open", "write", "fsync", "rename", "replace", "unlink", "stat", "utime", "listdir"]


def record(job: CaseJob) -> Record:
    """Return what a made-up case gives."""
    numbers = {name: value * (1 + job.point[0]) for name, value in OUTPUTS.items()}
    units, spreads = dict.fromkeys(OUTPUTS, "1"), dict.fromkeys(list(OUTPUTS)[:5], 0.01)
    return Record(
        job.key,
        Ending.COMPUTED,
        numbers=numbers,
        spreads=spreads,
        units=units,
        law="pair",
        draws=DRAWS * (1 + job.point[0]),
    )


def jobs(count: int) -> Iterator[CaseJob]:
    """Yield jobs of the study with made-up keys."""
    plan = read_plan(TEXT, EXAMPLES)
    for k in range(count):
        point = (k / count,)
        key = f"{k * 2654435761 % 2**96:024x}"
        yield CaseJob(key, k, 0, 0, 0, point, plan.design_changes(point))


def counted(calls: dict[str, int]) -> Callable[[], None]:
    """Count operations of the file system; return what ends the count."""
    real = {name: getattr(os, name) for name in CALLS}

    def wrap(name: str) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> Any:
            answer: Any = None if name == "fsync" else real[name](*arguments, **named)
            calls[name] += 1 + (len(answer) // 100 if name == "listdir" else 0)
            return answer

        return call

    for name in CALLS:
        setattr(os, name, wrap(name))

    def end() -> None:
        for name, function in real.items():
            setattr(os, name, function)

    return end


def work(folder: Path) -> None:
    """Finish cases as WORKERS processes would, one case each in turn."""
    with ExitStack() as stack:
        stores = [Store(folder) for _ in range(WORKERS)]
        for store in stores:
            store.name = f"node-1-{len(store.name):06}-{id(store):x}"  # one that is far away
            stack.enter_context(store.working(1))
        waiting: dict[Store, Iterator[CaseJob]] = {store: iter(()) for store in stores}
        while waiting:
            for store in list(waiting):
                job = next(waiting[store], None)
                if job is None:
                    took = store.take(in_order=False)
                    if took is None:
                        del waiting[store]
                        continue
                    waiting[store] = iter(took)
                    job = next(waiting[store], None)
                if job is not None:
                    store.add_record(record(job))


def peak() -> float:
    """Return the largest memory this process had, MB."""
    status = Path("/proc/self/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


def opened(folder: str, pipe: Any) -> None:
    """Open a study as a process that goes on with it does; send CPU seconds, memory and cases."""
    before, began = peak(), time.process_time()
    study = Study.load(folder)
    endings = study.result().endings
    pipe.send((time.process_time() - began, before, peak(), dict(endings)))


def helped(folder: str, pipe: Any) -> None:
    """Take a block and finish it; send the memory."""
    store, before = Store(folder), peak()
    with store.working(1):
        for job in store.take(in_order=False) or ():
            store.add_record(record(job))
    pipe.send((before, peak()))


def in_process(function: Callable[..., None], folder: Path, count: int = 1) -> list[Any]:
    """Return what ``count`` fresh processes at a time send."""
    context, pipes, processes = multiprocessing.get_context("spawn"), [], []
    for _ in range(count):
        ours, theirs = context.Pipe()
        processes.append(context.Process(target=function, args=(str(folder), theirs)))
        processes[-1].start()
        pipes.append(ours)
    answers = [pipe.recv() for pipe in pipes]
    for process in processes:
        process.join()
    return answers


def main() -> None:
    """Print CPU, operations, memory and opening time."""
    from underfoot.explore import records

    print(f"{CASES} made-up cases, 40 numbers and 500 draws each; {WORKERS} workers")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "study"
        store = Store.open_folder(folder)
        store.adopt(read_plan(TEXT, EXAMPLES))
        began = time.process_time()
        store.add_batch(store.jobs(), jobs(CASES))
        read = store.jobs()
        store.begin_round(read, ended=False)
        spent = time.process_time() - began
        print(f"set and given out: {1e3 * spent / CASES:.3f} ms CPU a case", flush=True)
        (before, after), *_ = answers = in_process(helped, folder, PROCESSES)
        more = max(b - a for a, b in answers)
        print(f"{len(answers)} processes that took a block: {after:.0f} MB, {more:.0f} more than")
        print(f"  the {before:.0f} MB of the package", flush=True)
        calls = dict.fromkeys(CALLS, 0)
        done = CASES - len(store.records())
        began, made_up = time.process_time(), _made_up(min(done, 2000))
        end = counted(calls)
        try:
            work(folder)
        finally:
            end()
        spent = time.process_time() - began
        cpu = 1e3 * (spent / done - made_up)
        print(f"finished: {cpu:.2f} ms CPU a case, {sum(calls.values()) / done:.2f} operations")
        print("  " + ", ".join(f"{name} {n / done:.3f}" for name, n in calls.items() if n))
        _print_opened(folder, "in lines")
        size = sum(one.stat().st_size for one in folder.rglob("*") if one.is_file())
        began = time.process_time()
        known = Store(folder).records()
        packed_from = len(known)
        if packed_from >= records.PACK:
            known.pack(read.keys)
            spent = time.process_time() - began
            after = sum(one.stat().st_size for one in folder.rglob("*") if one.is_file())
            print(f"packed in {1e3 * spent / packed_from:.2f} ms CPU a case: ", end="")
            print(f"{size / packed_from / 1e3:.1f} to {after / packed_from / 1e3:.1f} kB a case")
            _print_opened(folder, "packed")


def _print_opened(folder: Path, how: str) -> None:
    (spent, before, after, endings), *_ = in_process(opened, folder)
    files = sum(1 for _ in folder.glob("*-*"))
    print(f"opened, {how}, {files} files: {spent:.1f} s CPU, ", end="")
    print(f"{after:.0f} MB ({before:.0f} of the package): {endings}", flush=True)


def _made_up(count: int) -> float:
    """Return the seconds that a made-up case itself takes."""
    began = time.process_time()
    for job in jobs(count):
        record(job)
    return (time.process_time() - began) / count
