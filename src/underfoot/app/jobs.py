"""What is computed: a queue of long jobs, and a process kept warm for quick questions.

All compute in processes of their own (``core.worker``), so the server answers meanwhile and a
solver that dies takes nothing along. The queue is a file, ``jobs.jsonl``: after a kill of the
server it shows what had finished and what was interrupted.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, fields
from importlib import import_module
from pathlib import Path
from typing import Any

from underfoot.core.errors import Cancelled, error_text
from underfoot.core.remark import from_stored, stored_form
from underfoot.core.unit_text import SYSTEMS, UNITS_VARIABLE
from underfoot.core.worker import Job, Worker

from .project import append_line, lines
from .text import LANGUAGE_VARIABLE

TICK = 0.01
"""s between two looks at a process that computes."""
GRACE = 0.25
"""s that a cancelled job has to end by itself before its process is killed."""
PATIENT = 5
"""Niceness of full runs: sliders move meanwhile."""
WAITING, RUNNING, DONE = "waiting", "running", "done"
STOPPED, FAILED, INTERRUPTED = "stopped", "failed", "interrupted"
PROJECT = "{project}"
"""What stands for the project's folder in ``jobs.jsonl``: a project may be copied or moved."""
SHOWN = 50
"""Ended jobs that are kept in mind, the newest."""


class Lane:
    """One process that computes one thing after the other; safe for many who ask.

    Parameters:
        preload: Modules that the process imports when it starts.
        patient: Give way to other processes, so that they answer at once.
    """

    def __init__(self, preload: Sequence[str] = (), *, patient: bool = False) -> None:
        self._preload = preload
        self._call = patiently if patient else call_by_name
        self._worker: Worker | None = None
        self._turn = asyncio.Lock()
        self._stop = False

    def start(self) -> None:
        """Start the process, so that the first question finds it warm."""
        if self._worker is None:
            self._worker = Worker(self._preload, grace=GRACE)

    async def ask(
        self,
        function: str,
        *args: Any,
        heard: Callable[[Job], None] | None = None,
        **options: Any,
    ) -> Any:
        """Return ``function(*args, progress=..., **options)``, computed in the process.

        The function is named "module:name", so that this process need not import it. ``heard`` is
        told the job whenever it may have got on. Errors of the function pass through.
        """
        work = asyncio.ensure_future(self._run_alone(function, args, options, heard))
        return await asyncio.shield(work)  # who asked may leave; the process is not left busy

    async def _run_alone(
        self,
        function: str,
        args: tuple[Any, ...],
        options: dict[str, Any],
        heard: Callable[[Job], None] | None,
    ) -> Any:
        async with self._turn:
            self.start()
            worker = self._worker
            assert worker is not None
            self._stop = False
            job = worker.submit(self._call, function, *args, **options)
            while not job.done:
                if self._stop:
                    await asyncio.to_thread(worker.cancel)
                    break
                worker.poll()
                if heard is not None:
                    heard(job)
                if not job.done:
                    await asyncio.sleep(TICK)
            return job.result()

    def stop(self) -> None:
        """Stop what is computed now; who asked gets ``Cancelled``."""
        self._stop = True

    def close(self) -> None:
        """End the process."""
        if self._worker is not None:
            self._worker.close()
            self._worker = None


@dataclass
class QueuedTask:
    """A job of the queue.

    Attributes:
        function: What computes it, "module:name".
        about: What it computes, such as the name of a variant.
        state: waiting, running, done, stopped, failed, or interrupted by the end of the server.
        problem: What went wrong, as the error says it.
        answer: What the function returned, while the server runs.
        arguments, options: What the function takes, plain data.
        then: Title, function and arguments of what is queued when it is done.
        first: Comes before those that wait and are not.
    """

    number: int
    title: str
    function: str = ""
    about: str = ""
    state: str = WAITING
    stage: str = ""
    fraction: float = 0.0
    problem: str = ""
    began: float = 0.0
    ended: float = 0.0
    answer: Any = field(default=None, repr=False)
    arguments: Sequence[Any] = ()
    options: dict[str, Any] = field(default_factory=dict)
    then: Sequence[Any] = ()
    first: bool = False

    @property
    def open(self) -> bool:
        """Whether it waits or runs."""
        return self.state in (WAITING, RUNNING)

    @property
    def module(self) -> str:
        """Name of the module whose function it is; one job of each is computed at a time."""
        return self.function.partition(":")[0]


KEPT = tuple(each.name for each in fields(QueuedTask) if each.name != "answer")
"""What of a task is written to ``jobs.jsonl``."""


class JobQueue:
    """The queue of long jobs of a project and the warm process for quick questions.

    Parameters:
        folder: The project's folder, for ``jobs.jsonl``.
        preload: Modules that both processes import when they start.

    Attributes:
        live: For questions that are answered while a person waits.
        reading: Reads files of soles, which may take long, while sliders go on.
        tasks: Jobs by number, the oldest first.
    """

    def __init__(self, folder: Path, preload: Sequence[str] = ()) -> None:
        self.live, self.reading = Lane(preload), Lane()
        self._preload = preload
        self._lanes: dict[str, Lane] = {}
        self._file = folder / "jobs.jsonl"
        self.tasks: dict[int, QueuedTask] = {}
        self._waiting: deque[QueuedTask] = deque()
        self._computing: dict[str, asyncio.Task[None]] = {}
        self._arrived = asyncio.Event()
        self._read()

    def submit(
        self,
        title: str,
        function: str,
        *args: Any,
        about: str = "",
        then: Sequence[Any] = (),
        first: bool = False,
        **options: Any,
    ) -> QueuedTask:
        """Queue ``function(*args, progress=..., **options)`` ("module:name"), return its task.

        The function writes what is to last into the project's folder; what it takes is plain data.
        ``then`` (title, function, arguments) is queued when it is done, whoever looks. ``first``:
        before those that wait.
        """
        number = max(self.tasks, default=0) + 1
        task = QueuedTask(
            number, title, function, about, arguments=args, options=options, then=then, first=first
        )
        self.tasks[number] = task
        waits = [first and not other.first for other in self._waiting]
        self._waiting.insert(waits.index(True) if True in waits else len(waits), task)
        self._write_line(task)
        self._arrived.set()
        return task

    def cancel(self, task: QueuedTask) -> None:
        """Stop a task that waits or runs."""
        if task.state == WAITING:
            self._waiting.remove(task)
            self._end(task, STOPPED)
        elif task.state == RUNNING:
            self._lane(task.module).stop()

    def cancel_all(self, function: str = "") -> None:
        """Stop all tasks that wait or run, those of one function if it is named."""
        for task in sorted(self.tasks.values(), key=lambda task: task.state == RUNNING):
            if not function or task.function == function:
                self.cancel(task)

    def again(self, task: QueuedTask) -> QueuedTask:
        """Queue a task once more."""
        about = {"about": task.about, "then": task.then, "first": task.first, **task.options}
        return self.submit(task.title, task.function, *task.arguments, **about)

    def latest(self, about: str, function: str) -> QueuedTask | None:
        """Return the newest task of a function about something, None where there is none."""
        tasks = [t for t in self.tasks.values() if (t.about, t.function) == (about, function)]
        return tasks[-1] if tasks else None

    async def run(self) -> None:
        """Compute what is queued, for ever: one job of a module at a time.

        So a run waits for another run, but not for a study or a report of trials.
        """
        while True:
            for task in list(self._waiting):
                if task.module not in self._computing:
                    self._waiting.remove(task)
                    self._computing[task.module] = asyncio.create_task(self._compute(task))
            self._arrived.clear()
            await self._arrived.wait()

    async def wait_for(self, task: QueuedTask) -> QueuedTask:
        """Return a task when it has ended."""
        while task.open:
            await asyncio.sleep(5 * TICK)
        return task

    def warm(self) -> None:
        """Start the process of runs, so that the first one does not wait for it."""
        self._lane(self._preload[0] if self._preload else "").start()

    def close(self) -> None:
        """End all processes."""
        for computing in self._computing.values():
            computing.cancel()
        for lane in (self.live, self.reading, *self._lanes.values()):
            lane.close()

    def _lane(self, module: str) -> Lane:
        """Return the process that computes what a module has."""
        if module not in self._lanes:
            self._lanes[module] = Lane(self._preload, patient=True)
        return self._lanes[module]

    async def _compute(self, task: QueuedTask) -> None:
        task.state, task.began = RUNNING, time.time()
        self._write_line(task)

        def heard(job: Job) -> None:
            task.stage, task.fraction = job.stage, job.fraction

        try:
            task.answer = await self._lane(task.module).ask(
                task.function, *task.arguments, heard=heard, **task.options
            )
            self._end(task, DONE)
            if task.then:
                self.submit(*task.then, about=task.about, **task.options)
        except Cancelled:
            self._end(task, STOPPED)
        except Exception as error:
            task.problem = error_text(error)
            self._end(task, FAILED)
        finally:
            self._computing.pop(task.module, None)
            self._arrived.set()

    def _end(self, task: QueuedTask, state: str) -> None:
        task.state, task.ended = state, time.time()
        task.fraction = 1.0 if state == DONE else task.fraction
        self._write_line(task)

    def _write_line(self, task: QueuedTask) -> None:
        line = {name: getattr(task, name) for name in KEPT if getattr(task, name)}
        line |= {"problem": stored_form(task.problem)} if task.problem else {}
        with suppress(OSError):  # a full disk: the job goes on, after a restart it is interrupted
            append_line(self._file, _move_paths(line, str(self._file.parent), PROJECT))
        for number in [n for n, each in self.tasks.items() if not each.open][:-SHOWN]:
            del self.tasks[number]

    def _read(self) -> None:
        for line in lines(self._file):
            if isinstance(line.get("number"), int):
                here = _move_paths(line, PROJECT, str(self._file.parent))
                fields = {name: value for name, value in here.items() if name in KEPT}
                fields["problem"] = from_stored(fields.get("problem", ""))
                self.tasks[line["number"]] = QueuedTask(**{"title": "", **fields})
        for task in list(self.tasks.values()):  # old ones are forgotten meanwhile
            if task.open:
                self._end(task, INTERRUPTED)
        self.tasks = dict(list(self.tasks.items())[-SHOWN:])


def _move_paths(content: Any, folder: str, to: str) -> Any:
    """Return plain data with the paths in ``folder`` as paths in ``to``."""
    if isinstance(content, str):
        inside = content == folder or content.startswith((f"{folder}/", f"{folder}{os.sep}"))
        return to + content[len(folder) :] if inside else content
    if isinstance(content, Mapping):
        return {key: _move_paths(each, folder, to) for key, each in content.items()}
    if isinstance(content, list | tuple):
        return [_move_paths(each, folder, to) for each in content]
    return content


def call_by_name(
    function: str,
    *args: Any,
    progress: Any,
    units: str = SYSTEMS[0],
    language: str = "en",
    **options: Any,
) -> Any:
    """Return what a function ("module:name") answers, with its texts in units and language."""
    os.environ[UNITS_VARIABLE], os.environ[LANGUAGE_VARIABLE] = units, language
    module, _, name = function.partition(":")
    return getattr(import_module(module), name)(*args, progress=progress, **options)


def patiently(function: str, *args: Any, progress: Any, **options: Any) -> Any:
    """Return what a function ("module:name") answers, at low priority from now on."""
    if hasattr(os, "nice") and os.nice(0) < PATIENT:
        os.nice(PATIENT - os.nice(0))
    return call_by_name(function, *args, progress=progress, **options)
