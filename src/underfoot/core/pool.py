"""Work in several processes that end with this one, however it ends.

Each worker watches its parent: after Ctrl-C, SIGTERM or a kill of the parent, and after an error or
a cancel in it, no worker goes on. A worker that dies is replaced, and its item tried once more.
"""

import ctypes
import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any, Generic, TypeVar

from .errors import UnderfootError
from .progress import Progress, silent
from .remark import Message

Item = TypeVar("Item")
Answer = TypeVar("Answer")
TRIES = 2
"""Workers that an item may cost before it counts as the cause of their death."""
_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
_PR_SET_PDEATHSIG = 1  # of <linux/prctl.h>


def available_processors() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) or 1
    return os.cpu_count() or 1


def workers(processes: int | None) -> int:
    """Return how many processes work at the same time: None takes the processors, at most 4."""
    return min(available_processors(), 4) if processes is None else processes


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
    (``Cancelled``) ends the work. Where two workers in turn ended without an answer (killed, out of
    memory), ``died`` gives that of their item; without it ``UnderfootError`` is raised. Errors of
    ``function`` pass through.
    """
    count = min(processes or available_processors(), len(items))
    answers = answers_of(_Numbered(function), enumerate(items), count, _Numbered(died))
    for done, (index, answer) in enumerate(answers, start=1):
        yield index, answer
        progress(stage, done / len(items))


def answers_of(
    function: Callable[[Item], Answer],
    items: Iterable[Item | None],
    processes: int,
    died: Callable[[Item], Answer],
) -> Iterator[Answer]:
    """Yield the answers of ``function`` in the order in which they end.

    An item is taken from ``items`` when a worker is free for it, not before; None says that there
    is none until a further answer has been used. With one process the work is done here. Otherwise
    as ``in_processes``.
    """
    waiting = iter(items)
    if processes > 1:
        pool = _Pool(function, processes)
        try:
            yield from pool.answers(waiting, died)
        except BaseException:
            # GeneratorExit, KeyboardInterrupt and Cancelled too: nobody waits for answers any more
            pool.end(kill=True)
            raise
        pool.end()
        waiting = iter([*pool.left_over, *waiting])
    # one process is asked for, or the script has no "if __name__ == '__main__'" to start others
    for item in waiting:
        if item is not None:
            yield function(item)


class _Numbered(Generic[Item, Answer]):
    """A function of (index, item) that keeps the index."""

    def __init__(self, function: Callable[[Item], Answer] | None) -> None:
        self.function = function

    def __call__(self, numbered: tuple[int, Item]) -> tuple[int, Answer]:
        if self.function is None:
            raise UnderfootError(
                "a worker process ended without an answer",
                remedy="It may have run out of memory: use fewer processes or a coarser grid",
            )
        return numbered[0], self.function(numbered[1])


@dataclass(eq=False)
class _Worker:
    """A process, our end of its pipe and what it works on."""

    process: Any
    pipe: Connection
    ready: bool = False
    task: "_Task | None" = None


@dataclass(eq=False)
class _Task:
    item: Any
    tries: int = 0


class _Pool:
    """Fresh processes of one thread each.

    Fresh ones because a forked process can inherit locks of numerical libraries' threads. One pipe
    a worker, because the queue of a killed process may hold half a message.
    """

    def __init__(self, function: Callable[[Any], Any], processes: int) -> None:
        self.function = function
        self.again: list[_Task] = []
        self.lost_before_ready = 0
        self.workers: list[_Worker] = []
        self.processes = processes

    def answers(self, items: Iterator[Any], died: Callable[[Any], Any]) -> Iterator[Any]:
        """Yield answers until nothing is left; stop where no worker can be started."""
        self.workers = [self._start_worker() for _ in range(self.processes)]
        while True:
            for worker in self.workers:
                if worker.ready and worker.task is None:
                    self._give(worker, items)
            if not (self.again or any(w.task or not w.ready for w in self.workers)):
                return
            heard = wait([worker.pipe for worker in self.workers])
            for worker in [w for w in self.workers if w.pipe in heard]:
                try:
                    good, answer = worker.pipe.recv()
                except (EOFError, OSError, pickle.UnpicklingError):
                    yield from self._replace(worker, died)
                    if self.lost_before_ready > self.processes:
                        return
                    continue
                if not worker.ready:
                    worker.ready, self.lost_before_ready = True, 0
                    continue
                worker.task = None
                if not good:
                    raise answer
                self._give(worker, items)  # before the answer is used: it must not wait for that
                yield answer

    @property
    def left_over(self) -> list[Any]:
        """Items that were taken and not answered."""
        return [task.item for task in self.again]

    def end(self, *, kill: bool = False) -> None:
        """End the workers, at once or when they find nothing to do."""
        for worker in self.workers:
            worker.pipe.close()
            if kill:
                worker.process.kill()
        for worker in self.workers:
            worker.process.join()
        self.workers = []

    def _start_worker(self) -> _Worker:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        # the kernel's signal comes when the thread that started the worker ends: fit for main alone
        by_kernel = threading.current_thread() is threading.main_thread()
        arguments = (theirs, self.function, os.getpid(), by_kernel)
        process = context.Process(target=_serve, args=arguments)
        with one_thread():
            process.start()
        theirs.close()
        return _Worker(process, ours)

    def _give(self, worker: _Worker, items: Iterator[Any]) -> None:
        if self.again:
            worker.task = self.again.pop()
        else:
            item = next(items, None)
            if item is None:
                return
            worker.task = _Task(item)
        with suppress(OSError):  # it died: its pipe says so at the next wait
            worker.pipe.send(worker.task.item)

    def _replace(self, worker: _Worker, died: Callable[[Any], Any]) -> Iterator[Any]:
        worker.pipe.close()
        worker.process.join()
        self.lost_before_ready += not worker.ready
        self.workers.remove(worker)
        task = worker.task
        if task is not None:
            task.tries += 1
            if task.tries < TRIES:
                self.again.append(task)
        if self.lost_before_ready <= self.processes:
            self.workers.append(self._start_worker())
        if task is not None and task.tries >= TRIES:
            yield died(task.item)


@contextmanager
def one_thread() -> Iterator[None]:
    """Let processes that start within have one thread each in numerical libraries."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))  # a worker reads them as it starts
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _serve(pipe: Connection, function: Callable[[Any], Any], parent: int, by_kernel: bool) -> None:
    """Answer items of the parent until it closes the pipe."""
    watch_parent(parent, by_kernel)
    pipe.send((True, None))
    while True:
        try:
            item = pipe.recv()
        except (EOFError, OSError):
            return
        try:
            message = True, function(item)
        except Exception as error:
            message = False, error
        try:
            pipe.send(message)
        except (pickle.PicklingError, TypeError, AttributeError):
            pipe.send(
                (
                    False,
                    UnderfootError(
                        Message("{name}: {error}", name=type(message[1]).__name__, error=message[1])
                    ),
                )
            )


def watch_parent(parent: int, by_kernel: bool) -> None:
    """Make this worker end with its parent; Ctrl-C, which reaches the group, is the parent's."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    kill_with(parent, by_kernel)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def kill_with(parent: int, by_kernel: bool = True) -> None:
    """Let Linux kill this process when its parent ends, in the middle of compiled code too."""
    if sys.platform == "linux" and by_kernel:
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)


def _end_with_parent() -> None:
    if parent := multiprocessing.parent_process():
        wait([parent.sentinel])
    os._exit(1)
