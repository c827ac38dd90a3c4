"""A folder of 500 slip trials and one of 2,004 walks: time, memory, size, limits."""

import os
import resource
import tempfile
import threading
import time
from pathlib import Path

import psutil

from underfoot.trials.pages.report import STORE, write_trials_report
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.simulator.folder import NAMES
from underfoot.trials.study import analyse_folder

TRIALS = 500
WALKS = 2004
TIME_LIMIT, MEMORY_LIMIT = 60.0, 1e9  # s on two cores, bytes over all processes


def main() -> None:
    walks()  # first: a process keeps the memory that it has once used
    with tempfile.TemporaryDirectory() as place:
        folder, out = Path(place) / "trials", Path(place) / "out"
        simulated_folder("slips", folder, count=TRIALS)
        size = sum(path.stat().st_size for path in folder.iterdir()) / 1e6
        print(f"{TRIALS} made-up trials, {size:.0f} MB; {os.cpu_count()} processors")
        with _Memory() as memory:
            begin, before = time.perf_counter(), _cpu()
            analysis = analyse_folder(folder, protocol("report_g6"), store=out / STORE, processes=2)
            analysed, middle = time.perf_counter() - begin, _cpu()
            write_trials_report(analysis, out, processes=2)
            total, after = time.perf_counter() - begin, _cpu()
        begin = time.perf_counter()
        analyse_folder(folder, protocol("report_g6"), store=out / STORE, processes=2)
        again = time.perf_counter() - begin
    usable = sum(one.usable for one in analysis.files)
    print(f"usable {usable}")
    print(f"{'':<28}{'wall s':>8}{'CPU s':>8}")
    print(f"{'files, two processes':<28}{analysed:>8.1f}{middle - before:>8.1f}")
    print(f"{'report, tables, figures':<28}{total - analysed:>8.1f}{after - middle:>8.1f}")
    print(f"{'both (limit 60)':<28}{total:>8.1f}{after - before:>8.1f}")
    print(f"{'again, from stored results':<28}{again:>8.1f}")
    print(f"largest memory of all processes {memory.largest / 1e6:.0f} MB (limit 1000 MB)")
    print(
        "within the limits" if total < TIME_LIMIT and memory.largest < MEMORY_LIMIT else "TOO MUCH"
    )


class _Memory:
    """Largest unique memory of this process and its children, sampled ten times a second."""

    def __enter__(self) -> "_Memory":
        self.largest = 0
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()

    def _watch(self) -> None:
        me = psutil.Process()
        while not self._stop.wait(0.1):
            total = 0
            for process in [me, *me.children(recursive=True)]:
                try:
                    total += process.memory_info().rss
                except psutil.Error:
                    continue
            self.largest = max(self.largest, total)


def _cpu() -> float:
    """CPU time of this process and its finished children."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def walks() -> None:
    """2,000 walks of a study: CPU time, memory and size of the report, with one process."""
    with tempfile.TemporaryDirectory() as place:
        folder, out = Path(place) / "study", Path(place) / "out"
        simulated_folder("study", folder, count=WALKS // 12)
        with _Memory() as memory:
            begin = _cpu()
            level = protocol("level_walking")
            analysis = analyse_folder(folder, level, names=NAMES, store=out / STORE, processes=1)
            middle = _cpu()
            write_trials_report(analysis, out, processes=1)
            end = _cpu()
        size = (out / "report.html").stat().st_size / 1e6
    print(f"{len(analysis.files)} made-up walks, one process")
    print(f"analysis {middle - begin:.1f} CPU s, report {end - middle:.1f} CPU s (both: limit 60)")
    print(f"memory {memory.largest / 1e6:.0f} MB (limit 400), report {size:.1f} MB (limit 8)")


if __name__ == "__main__":
    main()
