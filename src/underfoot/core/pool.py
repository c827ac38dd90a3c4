"""Work in several processes that end with this one, however it ends.

Each worker watches its parent: after Ctrl-C, SIGTERM or a kill of the parent, and after an error or
a cancel in it, no worker goes on.
"""

import ctypes
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.connection import wait
from typing import TypeVar

from .errors import UnderfootError
from .progress import Progress, silent

Item = TypeVar("Item")
Answer = TypeVar("Answer")
_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
_PR_SET_PDEATHSIG = 1  # of <linux/prctl.h>


def available_processors() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) or 1
    return os.cpu_count() or 1


def in_processes(
    function: Callable[[Item], Answer],
    items: Sequence[Item],
    processes: int | None = None,
    *,
    progress: Progress = silent,
    stage: str = "computing",
    died: Callable[[Item], Answer] | None = None,
) -> Iterator[tuple[int, Answer]]:
    """Yield (index, answer) of ``function`` for each item, in the order in which they end.

    ``function`` is importable by name, as is what it takes and returns. ``processes`` are the
    workers at most, None for one a processor; with 1, or one item, the work is done here.
    ``progress`` is told ``stage`` and the share done after each item; an exception that it raises
    (``Cancelled``) ends the work. Where a worker ended without an answer (killed, out of memory),
    ``died`` gives that of its item; without it ``UnderfootError`` is raised. Errors of
    ``function`` pass through.
    """
    count = min(processes or available_processors(), len(items))
    done: set[int] = set()

    def told(index: int) -> None:
        done.add(index)
        progress(stage, len(done) / len(items))

    if count > 1:
        try:
            with worker_pool(count) as pool:
                jobs = {pool.submit(function, item): index for index, item in enumerate(items)}
                for job in as_completed(jobs):
                    answer = job.result()
                    yield jobs[job], answer
                    told(jobs[job])
            return
        except BrokenProcessPool:
            rest = [index for index in range(len(items)) if index not in done]
            if _workers_start():
                for index, answer in _one_at_a_time(function, items, rest, died):
                    yield index, answer
                    told(index)
                return
    # one process is asked for, or the script has no "if __name__ == '__main__'" to start others
    for index in range(len(items)):
        if index not in done:
            yield index, function(items[index])
            told(index)


@contextmanager
def worker_pool(processes: int) -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of fresh processes of one thread each; they are killed if the block fails.

    Fresh ones because a forked process can inherit locks of numerical libraries' threads.
    """
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))  # a worker reads them as it starts
    # the kernel's signal comes when the thread that started the worker ends: fit for the main one
    by_kernel = threading.current_thread() is threading.main_thread()
    pool = ProcessPoolExecutor(
        processes,
        mp_context=multiprocessing.get_context("spawn"),
        initializer=_watch_parent,
        initargs=(os.getpid(), by_kernel),
    )
    try:
        yield pool
        pool.shutdown()
    except BaseException:
        # GeneratorExit, KeyboardInterrupt and Cancelled too: nobody waits for the answers any more
        workers = list((getattr(pool, "_processes", None) or {}).values())
        for worker in workers:
            worker.kill()
        pool.shutdown(wait=True, cancel_futures=True)
        raise
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _one_at_a_time(
    function: Callable[[Item], Answer],
    items: Sequence[Item],
    rest: list[int],
    died: Callable[[Item], Answer] | None,
) -> Iterator[tuple[int, Answer]]:
    """Yield the answers of one worker, to find the item that kills it."""
    while rest:
        try:
            with worker_pool(1) as pool:
                while rest:
                    answer = pool.submit(function, items[rest[0]]).result()
                    yield rest.pop(0), answer
        except BrokenProcessPool:
            index = rest.pop(0)
            if died is None:
                raise UnderfootError(
                    "a worker process ended without an answer",
                    remedy="It may have run out of memory: use fewer processes or a coarser grid",
                ) from None
            yield index, died(items[index])


def _workers_start() -> bool:
    try:
        with worker_pool(1) as pool:
            return pool.submit(os.getpid).result() > 0
    except BrokenProcessPool:
        return False


def _watch_parent(parent: int, by_kernel: bool) -> None:
    """Make this worker end with its parent; Ctrl-C, which reaches the group, is the parent's."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform == "linux" and by_kernel:
        # holds in the middle of compiled code too, where the thread below waits for its turn
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    wait([parent.sentinel])
    os._exit(1)
