"""One process that stays warm: imports and what it solved serve the next question too.

An application asks it while a person moves a slider. It is a fresh process (spawned, one thread),
ends with its parent, and is started anew after a cancel that it does not heed, or a death.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from multiprocessing.connection import Connection
from multiprocessing.util import Finalize
from typing import Any

from .errors import Cancelled, UnderfootError
from .pool import one_thread, watch_parent
from .remark import Message


@dataclass
class Job:
    """What was asked and how far it is; ``Worker.poll`` brings it up to date.

    Attributes:
        stage, fraction, residual: The last progress that was heard.
        answer: What the function returned, once ``done``.
        error: What it raised; ``Cancelled`` after a cancel.
    """

    number: int
    stage: str = ""
    fraction: float = 0.0
    residual: float | None = None
    done: bool = False
    answer: Any = None
    error: BaseException | None = None

    def result(self) -> Any:
        """Return the answer of a finished job or raise its error."""
        if self.error is not None:
            raise self.error
        if not self.done:
            raise UnderfootError(
                Message("job {number} is not done", number=self.number), remedy="Poll until it is"
            )
        return self.answer


class Worker:
    """A process that computes one job after the other.

    Parameters:
        preload: Modules to import before the first job.
        grace: s that a cancelled job has to end by itself before its process is killed.

    Not for several threads at once. Use it as a context manager, or ``close`` it.
    """

    def __init__(self, preload: Sequence[str] = (), grace: float = 1.0) -> None:
        self._preload = tuple(preload)
        self._grace = grace
        self._count = 0
        self._job: Job | None = None
        self._start()

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def busy(self) -> bool:
        """Whether a job is under way."""
        return self._job is not None

    def submit(self, function: Callable[..., Any], *args: Any, **options: Any) -> Job:
        """Start ``function(*args, progress=..., **options)`` and return its job.

        The function is importable by name; it takes ``progress``, whose ``Cancelled`` stops it.

        Raises:
            UnderfootError: A job is under way.
        """
        if self._job is not None:
            raise UnderfootError("the worker is busy", remedy="Cancel its job or wait for it")
        self._count += 1
        self._job = job = Job(self._count)
        if not self._process.is_alive():
            self._restart()
        self._cancelled.clear()
        self._pipe.send((job.number, function, args, options))
        return job

    def poll(self, seconds: float = 0.0) -> Job | None:
        """Hear what there is to hear for up to ``seconds``; return the job if it has just ended."""
        job = self._job
        if job is None:
            return None
        try:
            while self._pipe.poll(seconds):
                number, kind, content = self._pipe.recv()
                if number != job.number:
                    continue  # the last words of a job that was given up
                if kind == "progress":
                    job.stage, job.fraction, job.residual = content
                    seconds = 0.0
                    continue
                return self._end(kind, content)
        except (EOFError, OSError):
            self._restart()
            return self._end("error", UnderfootError("the worker process died"))
        return None

    def wait(self, job: Job) -> Any:
        """Return the answer of the job under way, when it is there, or raise its error."""
        while not job.done:
            self.poll(0.1)
        return job.result()

    def cancel(self) -> Job | None:
        """Stop the job under way and return it; its process is killed if it does not heed."""
        if self._job is None:
            return None
        self._cancelled.set()
        ended = self.poll(self._grace)
        while ended is None and self._job is not None and self._pipe.poll(0.0):
            ended = self.poll()
        if ended is None:
            self._restart()
            ended = self._end("error", Cancelled("stopped"))
        return ended

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.join()
        self._pipe.close()

    def _end(self, kind: str, content: Any) -> Job:
        job, self._job = self._job, None
        assert job is not None
        job.done = True
        if kind == "answer":
            job.answer, job.fraction = content, 1.0
        else:
            job.error = content
        return job

    def _restart(self) -> None:
        self.close()
        self._start()

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        self._cancelled = context.Event()
        by_kernel = threading.current_thread() is threading.main_thread()
        arguments = (other, self._cancelled, self._preload, os.getpid(), by_kernel)
        self._process = context.Process(target=_serve, args=arguments)
        with one_thread():
            self._process.start()
        # no daemon, which could have no workers of its own: at this one's end it is killed
        Finalize(self, self._process.kill, exitpriority=1)
        other.close()


def _serve(
    pipe: Connection, cancelled: Any, preload: Sequence[str], parent: int, by_kernel: bool
) -> None:
    watch_parent(parent, by_kernel)
    for name in preload:
        import_module(name)
    while True:
        try:
            number, function, args, options = pipe.recv()
        except EOFError:
            return

        def report(
            stage: str, fraction: float, residual: float | None = None, number: int = number
        ) -> None:
            if cancelled.is_set():
                raise Cancelled("stopped")
            pipe.send((number, "progress", (stage, fraction, residual)))

        try:
            message = "answer", function(*args, progress=report, **options)
        except Exception as error:
            message = "error", error
        try:
            pipe.send((number, *message))
        except (pickle.PicklingError, TypeError, AttributeError):
            text = f"{type(message[1]).__name__}: {message[1]}"
            pipe.send((number, "error", UnderfootError(text)))
