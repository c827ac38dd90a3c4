"""Faults inside functions, put into a process that holds all tests: nothing is imported again.

A fork of the process that collected the tests gives the functions of a file the code that they
would have with the fault, and runs the tests that should see it until the first that fails. What
was computed while tests were collected stays as it was, as does what a process of its own computes:
a fault may be said to live that would die, never the other way round.
"""

import functools
import gc
import os
import resource
import signal
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from types import CodeType, FunctionType
from typing import NamedTuple

import pytest

NOT_PLANTED = "?"  # a fault that lies in no function of the process
STATUS = 4


class Plan(NamedTuple):
    """What one fault meets: the number of its plan, the text with it, tests and s of CPU."""

    number: int
    path: Path
    text: bytes
    names: list[str]
    limit: int


def codes(code: CodeType) -> Iterator[CodeType]:
    """Yield the code of every function and class of a module, in the order of its text."""
    for one in code.co_consts:
        if isinstance(one, CodeType):
            yield one
            yield from codes(one)


def place(code: CodeType) -> tuple[str, int, str]:
    """Return what tells a code apart from all others of a process."""
    return code.co_filename, code.co_firstlineno, code.co_qualname


class Warm:
    """A plugin that forks a child for each fault instead of running the tests."""

    def __init__(self, plans: list[Plan], jobs: int, tell: Callable[[int, str], None]) -> None:
        self._plans, self._jobs, self._tell = plans, jobs, tell
        self._functions: dict[tuple, list[FunctionType]] = defaultdict(list)
        self._caches: list = []
        self._children: dict[int, tuple[Plan, float, Path]] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Run every plan; no test runs in this process."""
        for one in gc.get_objects():
            if isinstance(one, FunctionType):
                self._functions[place(one.__code__)].append(one)
            elif isinstance(one, functools._lru_cache_wrapper):
                self._caches.append(one)
        gc.freeze()
        items = {one.nodeid: one for one in session.items}
        for plan in self._plans:
            while len(self._children) == self._jobs:
                self._take()
            at = Path.cwd() / f"runs{plan.number}"
            at.write_text("", encoding="utf-8")
            if number := os.fork():
                self._children[number] = plan, time.monotonic() + 8 * plan.limit, at
            else:
                self._child(
                    session, plan, [items[name] for name in plan.names if name in items], at
                )
        while self._children:
            self._take()
        return True

    def _child(self, session: pytest.Session, plan: Plan, items: list, at: Path) -> None:
        try:
            os.setsid()
            resource.setrlimit(resource.RLIMIT_CPU, (plan.limit, plan.limit))
            if not self._plant(plan):
                os._exit(STATUS)
            for one, following in zip(items, [*items[1:], None], strict=True):
                at.write_text(one.nodeid, encoding="utf-8")
                session.config.hook.pytest_runtest_protocol(item=one, nextitem=following)
                if session.testsfailed:
                    os._exit(1)
            os._exit(0)
        finally:
            os._exit(1)

    def _plant(self, plan: Plan) -> bool:
        """Put a fault into the functions that this process holds; return whether it did."""
        before, after = (
            list(codes(compile(text, str(plan.path), "exec", dont_inherit=True)))
            for text in (plan.path.read_bytes(), plan.text)
        )
        if len(before) != len(after):
            return False
        planted = False
        for old, new in zip(before, after, strict=True):
            for function in self._functions.get(place(old), ()) if old != new else ():
                if function.__code__ == old:
                    function.__code__ = new
                    planted = True
        for one in self._caches:  # what was computed while tests were collected
            one.cache_clear()
        return planted

    def _take(self) -> None:
        """Wait for a child; tell what it found."""
        while True:
            for number, (plan, until, at) in self._children.items():
                late = time.monotonic() > until
                if late:
                    os.killpg(number, signal.SIGKILL)
                done, status = os.waitpid(number, 0 if late else os.WNOHANG)
                if not done:
                    continue
                del self._children[number]
                with suppress(ProcessLookupError):  # what a killed test left behind
                    os.killpg(number, signal.SIGKILL)
                code = os.waitstatus_to_exitcode(status)
                told = {0: "", STATUS: NOT_PLANTED}
                self._tell(
                    plan.number, told.get(code) or at.read_text(encoding="utf-8") * bool(code)
                )
                at.unlink()
                return
            time.sleep(0.02)


def deaths(
    folder: Path, plans: list[Plan], files: list[str], marked: str, jobs: int
) -> Iterator[tuple[int, str]]:
    """Yield the number of each plan and the test that killed its fault, "" where all passed.

    Args:
        folder: A copy of the repository.
        plans: Faults of files in it.
        files: Of tests that are collected, relative to it.
        marked: Which of their tests.
        jobs: Children at a time.
    """
    reader, writer = os.pipe()
    if number := os.fork():
        os.close(writer)
        with os.fdopen(reader, encoding="utf-8") as told:
            for line in told:
                plan, _, killer = line.rstrip("\n").partition(" ")
                yield int(plan), killer
        os.waitpid(number, 0)
        return
    try:
        os.close(reader)
        os.chdir(folder)
        paths = [str(folder / "src"), str(folder / "tests")]
        sys.path[:0] = paths
        (folder / "made").mkdir(exist_ok=True)
        os.environ |= {
            "PYTHONPATH": os.pathsep.join(paths), "PYTHONDONTWRITEBYTECODE": "1",
            "PYTEST_DEBUG_TEMPROOT": str(folder / "made"),
        }  # fmt: skip
        sys.dont_write_bytecode = True
        silent = os.open(folder / "log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(silent, 1)
        os.dup2(silent, 2)

        def tell(number: int, killer: str) -> None:
            os.write(writer, f"{number} {killer}\n".encode())

        pytest.main(
            ["-q", "-p", "no:xdist", "-p", "no:cacheprovider", "-m", marked, "--capture", "sys",
             "-W", "ignore::pytest.PytestAssertRewriteWarning", *files],
            plugins=[Warm(plans, jobs, tell)],
        )  # fmt: skip
    finally:
        os._exit(0)
