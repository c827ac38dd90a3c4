"""Changes lines of the source one at a time and counts the changes that no quick test sees.

    make mutants                              20 seeded faults in every room of the source
    make mutants ROOM="slip shoe" COUNT=40 SEED=7
    python tests/mutants.py --named [ROOM]    the faults of mutants.toml, which tests once let pass
    python tests/mutants.py --own fluid       tests of the room only: what others run isn't recorded

A fault turns a sign, a comparison or a choice round, moves a number or an index, or swaps two
arguments. Which quick tests run which lines is recorded first (``mutants_map.py``), where it isn't
known yet. A fault meets the tests that run its line, in a copy of the repository, until the first
that fails, in a fork of a process that holds the tests (``mutants_warm.py``) or, where its line
runs at import, in a kernel or in no test of this process, the libraries alone. First come those of
its room (they import its module, themselves or by a helper, or are called ``test_<room>_``), then
the others; those that import the module first, each test once before one comes again with other
parameters, the quickest first, ``--seconds`` of each at most. A line that runs at import meets
the tests of the lines that read its name and of the numbers that its room states, else those
that run anything of its file or are of its room; one that no test runs in this process meets
those of its room if it is compiled, else those that start a process. What survives is printed
with its place: mend the tests, or say in ``mutants_alive.toml`` why it may live. A test that
fails without a fault kills nothing; a fault that its room's test killed counts as dead while that
test and the source stand. Not part of ``make test``.
"""

import ast
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from argparse import ArgumentParser
from collections import defaultdict
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from mutants_map import digest, known_map, write_map
from mutants_warm import NOT_PLANTED, Plan, deaths

REPOSITORY = Path(__file__).resolve().parents[1]
SOURCE = Path("src", "underfoot")
NAMED = Path(__file__).with_suffix(".toml")
ALIVE = Path(__file__).with_name("mutants_alive.toml")
STATED = "tests/snapshots/test_stated_numbers.py"
"""Holds what lines at import state, without running them."""
NO_TESTS_OF_CODE = ("docs", "install")
QUICK = "not costly and not slow and not study and not browser"
CACHE = "__pycache__"
IMPORTED = re.compile(r"(?m)^(?:from|import) (\w+)")
PROCESSES = ("subprocess", "multiprocessing", "Popen", "processes=", "workers=")
LEAST_TIME = 60  # s of CPU, below which no fault is called endless
MOST_TESTS, MOST_FILES = 400, 30  # that one fault meets in its room, and elsewhere
# what a fork finds imported
LIBRARIES = (
    "numpy scipy.linalg scipy.optimize scipy.sparse.linalg scipy.stats scipy.special "
    "scipy.ndimage scipy.interpolate scipy.integrate scipy.spatial scipy.fft scipy.signal pandas "
    "xarray pydantic pint tomlkit typer rich matplotlib.pyplot hypothesis h5py".split()
)
FUNCTION = ast.FunctionDef | ast.AsyncFunctionDef
GUARD = 1e-5  # a number below it keeps a division or a rounding safe: twice it changes nothing
ALIKE = {"min", "max", "hypot", "minimum", "maximum", "gcd", "isinstance", "getattr", "swapaxes"}
OPERATORS: dict[type, tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Lt: ("<", ">="),
    ast.LtE: ("<=", ">"),
    ast.Gt: (">", "<="),
    ast.GtE: (">=", "<"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
}
NAMES = {"min": "max", "max": "min", "any": "all", "all": "any", "minimum": "maximum",
         "maximum": "minimum", "argmin": "argmax", "argmax": "argmin", "sqrt": "abs",
         "True": "False", "False": "True"}  # fmt: skip


class Mutant(NamedTuple):
    """One change of a file of ``src/underfoot``: the text between two offsets gives way."""

    file: str
    start: int
    end: int
    new: str
    shown: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}: {self.shown}"


class Faults(ast.NodeVisitor):
    """Every fault that a file may get; what is said to people and to type checkers gets none."""

    def __init__(self, file: str, text: str) -> None:
        self.file, self.text, self.found = file, text, list[Mutant]()
        self._free = set[int]()
        """Numbers that may be others: any negative one is the length left over of ``reshape``."""
        self._lines = [0]
        for line in text.encode().splitlines(keepends=True):
            self._lines.append(self._lines[-1] + len(line))
        self.visit(ast.parse(text))

    def _offsets(self, node: Any) -> tuple[int, int]:
        place = (node.lineno, node.end_lineno), (node.col_offset, node.end_col_offset)
        start, end = (self._lines[line - 1] + column for line, column in zip(*place, strict=True))
        return start, end

    def _change(self, start: int, end: int, new: str) -> None:
        data = self.text.encode()
        line = data[:start].count(b"\n") + 1
        begin, stop = data.rfind(b"\n", 0, start) + 1, data.find(b"\n", end)
        shown = (data[begin:start] + b"[" + data[start:end] + b" -> " + new.encode() + b"]"
                 + data[end:stop]).decode()  # fmt: skip
        self.found.append(Mutant(self.file, start, end, new, f"line {line}: {shown.strip()}", line))

    def _between(self, left: ast.AST, right: ast.AST, operator: ast.AST) -> None:
        old, new = OPERATORS.get(type(operator), ("", ""))
        start, end = self._offsets(left)[1], self._offsets(right)[0]
        at = self.text.encode().find(old.encode(), start, end) if old else -1
        words = any(
            isinstance(one, ast.JoinedStr) or isinstance(getattr(one, "value", None), str)
            for one in (left, right)
        )
        if at >= 0 and not words:
            self._change(at, at + len(old), new)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        self._between(node.left, node.right, node.op)
        self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> None:
        for (left, right), operator in zip(
            pairwise([node.left, *node.comparators]), node.ops, strict=True
        ):
            self._between(left, right, operator)
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        self._between(node.values[0], node.values[1], node.op)
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.USub | ast.Not):
            start = self._offsets(node)[0]
            self._change(start, start + (1 if isinstance(node.op, ast.USub) else 3), "")
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        start, end = self._offsets(node)
        if isinstance(node.value, bool):
            self._change(start, end, str(not node.value))
        elif isinstance(node.value, int) and id(node) not in self._free:
            self._change(start, end, str(node.value + 1))
        elif isinstance(node.value, float) and not 0 < node.value < GUARD:
            self._change(start, end, repr(2 * node.value) if node.value else "1.0")

    def visit_Call(self, node: ast.Call) -> None:
        name = node.func
        word = name.attr if isinstance(name, ast.Attribute) else getattr(name, "id", "")
        if word.endswith("Error") or word in ("cast", "field", "info", "warning", "note"):
            return
        if word == "reshape":
            self._free |= {id(one.operand) for one in node.args if ast.unparse(one) == "-1"}
        if new := NAMES.get(word):
            end = self._offsets(name)[1]
            self._change(end - len(word), end, new)
        if (
            len(node.args) > 1
            and word not in ALIKE
            and not any(isinstance(one, ast.Starred) for one in node.args[:2])
        ):
            (first, stop), (begin, last) = map(self._offsets, node.args[:2])
            data = self.text.encode()
            if data[first:stop] != data[begin:last]:
                swapped = data[begin:last] + data[stop:begin] + data[first:stop]
                self._change(first, last, swapped.decode())
        self.generic_visit(node)

    def visit_If(self, node: ast.If) -> None:
        start, end = self._offsets(node.test)
        if "TYPE_CHECKING" not in ast.unparse(node.test):
            self._change(start, end, f"not ({ast.unparse(node.test)})")
            self.generic_visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        for part in (*node.args.defaults, *filter(None, node.args.kw_defaults), *node.body):
            self.visit(part)

    visit_AsyncFunctionDef = visit_FunctionDef

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value:
            self.visit(node.value)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        for part in node.body:
            self.visit(part)

    def visit_keyword(self, node: ast.keyword) -> None:
        if node.arg != "strict":  # of a zip whose parts are of one length
            self.visit(node.value)

    def visit_Expr(self, node: ast.Expr) -> None:
        if not isinstance(node.value, ast.Constant):  # a docstring
            self.generic_visit(node)

    def _silent(self, node: ast.AST) -> None:
        """No fault in a text, an error, a name of a type."""

    visit_Raise = visit_JoinedStr = visit_Assert = visit_Import = visit_ImportFrom = _silent


def room_faults(room: str, count: int, seed: int) -> list[Mutant]:
    """Return ``count`` seeded faults of a room, on as many lines."""
    folder = REPOSITORY / SOURCE / room
    files = sorted(p for p in folder.rglob("*.py") if "text" not in p.relative_to(folder).parts)
    found: list[Mutant] = []
    for path in files:
        file = path.relative_to(REPOSITORY / SOURCE).as_posix()
        found += Faults(file, path.read_text(encoding="utf-8")).found
    random.Random(f"{room} {seed}").shuffle(found)
    a_line = {(one.file, one.shown.split(":")[0]): one for one in found}
    return list(a_line.values())[:count]


def named_faults() -> Iterator[Mutant]:
    """Yield the faults of ``mutants.toml``: ``old`` stands once in its file."""
    for file, faults in tomllib.loads(NAMED.read_text(encoding="utf-8")).items():
        data = (REPOSITORY / SOURCE / file).read_bytes()
        for old, new in faults:
            if data.count(old.encode()) != 1:
                raise SystemExit(f"{file}: {data.count(old.encode())} times {old!r}")
            start = data.index(old.encode())
            line = data[:start].count(b"\n") + 1
            yield Mutant(file, start, start + len(old.encode()), new, f"{old!r} -> {new!r}", line)


def tests_of(file: str) -> tuple[str, ...]:
    """Return the files of tests of a file of the source: that import its module, or of its room."""
    nearest, others = nearest_and_others(file)
    return (*nearest, *others)


@cache
def may_live() -> dict[tuple[str, str], str]:
    """Return why faults of ``mutants_alive.toml`` may live, by file and fault."""
    text = ALIVE.read_text(encoding="utf-8") if ALIVE.exists() else ""
    return {
        (file, fault): why for file, faults in tomllib.loads(text).items() for fault, why in faults
    }


@cache
def nearest_and_others(file: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the files of tests that import the module of a file, and the others of its room."""
    parts = Path(file).with_suffix("").parts
    module, room = ".".join(("underfoot", *parts)), parts[0]
    whole = f"from {module.rpartition('.')[0]} import {parts[-1]}"
    names = module, f"{whole}\n", f"{whole} as "
    nearest, others = [], []
    for path, text in test_texts():
        text = with_helpers(text)
        if any(one in text for one in names):
            nearest.append(path)
        elif Path(path).name.startswith(f"test_{room}_") or f"underfoot.{room}" in text:
            others.append(path)
    return tuple(nearest), tuple(others)


@cache
def test_texts() -> tuple[tuple[str, str], ...]:
    """Return each file of tests of the code (relative to the repository) and its text."""
    paths = sorted((REPOSITORY / "tests").rglob("test_*.py"))
    names = [path.relative_to(REPOSITORY).as_posix() for path in paths]
    return tuple(
        (name, path.read_text(encoding="utf-8"))
        for name, path in zip(names, paths, strict=True)
        if name.split("/")[1] not in NO_TESTS_OF_CODE
    )


@cache
def with_helpers(text: str) -> str:
    """Return a text of tests with those of the helpers in ``tests`` that it imports."""
    paths = (REPOSITORY / "tests" / f"{name}.py" for name in re.findall(IMPORTED, text))
    return "\n".join([text, *(one.read_text(encoding="utf-8") for one in paths if one.exists())])


class Test(NamedTuple):
    """A quick test that passes, and the s of CPU that it takes."""

    name: str
    seconds: float

    @property
    def file(self) -> str:
        """The file that it stands in."""
        return self.name.partition("::")[0]


class Lines:
    """Which tests run which lines of some files of the source."""

    def __init__(self, files: set[str]) -> None:
        self.red: list[str] = []
        self.false = set[str]()
        """Tests that fail in a copy of the repository without a fault."""
        self.tests: dict[str, list[Test]] = {}
        self._lines: dict[str, dict[int, list[Test]]] = defaultdict(lambda: defaultdict(list))
        for file, _ in test_texts():
            found = known_map(file, files)
            if not found:
                continue
            every = [Test(one["name"], one.get("seconds", 0.0)) for one in found["tests"]]
            passed = [one["passed"] for one in found["tests"]]
            self.tests[file] = [one for one, good in zip(every, passed, strict=True) if good]
            self.red += [one.name for one, good in zip(every, passed, strict=True) if not good]
            for path in files & found["lines"].keys():
                for line, numbers in found["lines"][path].items():
                    self._lines[path][int(line)] += [every[n] for n in numbers if passed[n]]

    def run_inside(self, mutant: Mutant) -> bool:
        """Return whether tests run the line of a fault, inside a function."""
        begin = statement_lines(mutant.file, mutant.line)[0]
        met = self._lines.get(mutant.file, {})
        # what is compiled runs as it was, but where a test calls the function that it was made of
        met_here = met.get(mutant.line) or met.get(begin)
        return in_function(mutant) and not in_kernel(mutant) and bool(met_here)

    def meeting(self, mutant: Mutant) -> list[Test]:
        """Return the tests that a fault should meet."""
        return [one for one in self._meeting(mutant) if one.name not in self.false]

    def _meeting(self, mutant: Mutant) -> list[Test]:
        of_file, files = self._lines.get(mutant.file, {}), tests_of(mutant.file)
        begin, end = statement_lines(mutant.file, mutant.line)
        if begin < 0:  # runs at import, for whichever test comes first: what it makes is read later
            room = f"[underfoot.{mutant.file.split('/')[0]}]"
            told = {one for one in self.tests.get(STATED, ()) if one.name.endswith(room)}
            if read := {one for file, at in uses(mutant) for one in self._lines[file].get(at, ())}:
                return list(read | told)
            every = {one for tests in of_file.values() for one in tests}
            return list(every | {one for file in files for one in self.tests.get(file, ())})
        met = of_file.get(mutant.line) or of_file.get(begin)
        met = met or {one for line in range(begin, end + 1) for one in of_file.get(line, ())}
        if in_kernel(mutant):  # its calls leave no trace
            return list({*met, *(one for file in files for one in self.tests.get(file, ()))})
        if met:
            return list(met)
        if not compiled(mutant.file):
            apart = {file for file, text in test_texts() if any(one in text for one in PROCESSES)}
            files = tuple(file for file in files if file in apart)
        return [one for file in files for one in self.tests.get(file, ())]


@cache
def compiled(file: str) -> bool:
    """Return whether a file of the source has kernels, whose lines leave no trace."""
    return "@njit" in (REPOSITORY / SOURCE / file).read_text(encoding="utf-8")


@cache
def statements(file: str) -> list[tuple[int, int]]:
    """Return the lines of the statements inside the functions of a file, the longest first."""
    tree = ast.parse((REPOSITORY / SOURCE / file).read_text(encoding="utf-8"))
    found = {
        (one.lineno, one.end_lineno or one.lineno)
        for function in ast.walk(tree)
        if isinstance(function, FUNCTION)
        for part in function.body
        for one in ast.walk(part)
        if isinstance(one, ast.stmt)
    }
    return sorted(found, key=lambda lines: lines[0] - lines[1])


def statement_lines(file: str, line: int) -> tuple[int, int]:
    """Return the first and last line of the innermost statement in a function, else (-1, -1)."""
    around = [lines for lines in statements(file) if lines[0] <= line <= lines[1]]
    return around[-1] if around else (-1, -1)


def in_kernel(mutant: Mutant) -> bool:
    """Return whether the line of a fault stands in a function that is compiled."""
    tree = ast.parse((REPOSITORY / SOURCE / mutant.file).read_text(encoding="utf-8"))
    return any(
        one.lineno <= mutant.line <= (one.end_lineno or one.lineno)
        and any("njit" in ast.unparse(each) for each in one.decorator_list)
        for one in ast.walk(tree)
        if isinstance(one, ast.FunctionDef)
    )


def in_function(mutant: Mutant) -> bool:
    """Return whether the line of a fault stands in a function."""
    return statement_lines(mutant.file, mutant.line)[0] > 0


@cache
def words_in_functions(file: str) -> dict[str, list[int]]:
    """Return the lines inside functions of a file of the source at which each name stands."""
    tree = ast.parse((REPOSITORY / SOURCE / file).read_text(encoding="utf-8"))
    lines = defaultdict[str, list[int]](list)
    for function in ast.walk(tree):
        if isinstance(function, FUNCTION):
            for part in (each for line in function.body for each in ast.walk(line)):
                name = part.attr if isinstance(part, ast.Attribute) else getattr(part, "id", "")
                if name:
                    lines[name].append(part.lineno)
    return lines


@cache
def uses(mutant: Mutant) -> list[tuple[str, int]]:
    """Return the lines that read what a line at import names, where its module is imported."""
    tree = ast.parse((REPOSITORY / SOURCE / mutant.file).read_text(encoding="utf-8"))
    names = {
        target.id
        for part in ast.walk(tree)
        if isinstance(part, ast.Assign | ast.AnnAssign)
        and part.lineno <= mutant.line <= (part.end_lineno or part.lineno)
        for target in (part.targets if isinstance(part, ast.Assign) else [part.target])
        if isinstance(target, ast.Name)
    }
    module = Path(mutant.file).stem
    return [
        (file, line)
        for path in sorted((REPOSITORY / SOURCE).rglob("*.py"))
        if (file := path.relative_to(REPOSITORY / SOURCE).as_posix()) == mutant.file
        or re.search(
            rf"(?m)^ *from \S*\b{module} import|import {module}\b", path.read_text("utf-8")
        )
        for name in names
        for line in words_in_functions(file).get(name, ())
    ]


def in_turn(tests: Iterable[Test], seconds: float, first: tuple[str, ...] = ()) -> list[Test]:
    """Return tests, each once before one comes again with other parameters, quickest first.

    Those in files of ``first`` come before all others.
    """
    forms: dict[str, list[Test]] = defaultdict(list)
    for one in sorted(tests, key=lambda test: test.seconds):
        forms[one.name.partition("[")[0]].append(one)
    ranked = [
        (one.file not in first, rank, one.seconds, one)
        for form in forms.values()
        for rank, one in enumerate(form)
    ]
    chosen, files, total = list[Test](), set[str](), 0.0
    for *_, one in sorted(ranked):
        if one.file not in files and len(files) == MOST_FILES:
            continue
        files.add(one.file)
        total += one.seconds
        if total > seconds or len(chosen) == MOST_TESTS:
            break
        chosen.append(one)
    return chosen


def copied(folder: Path) -> Path:
    """Return a copy of what the repository holds."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=REPOSITORY, capture_output=True, check=True, text=True
    )
    for name in filter(None, listed.stdout.split("\0")):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(REPOSITORY / name, folder / name)
    # bytecode and kernels hold while the time of their file does
    for part in ("src", "tests"):
        for made in (REPOSITORY / part).rglob(CACHE):
            shutil.copytree(made, folder / made.relative_to(REPOSITORY), dirs_exist_ok=True)
    return folder


class Chosen:
    """A plugin that runs some tests in their order and writes the one that runs to a file."""

    def __init__(self, names: list[str], at: Path) -> None:
        self._places, self._at = {name: place for place, name in enumerate(names)}, at

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Leave the others out."""
        items[:] = sorted(
            (one for one in items if one.nodeid in self._places),
            key=lambda one: self._places[one.nodeid],
        )

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> None:
        """Write its name."""
        self._at.write_text(item.nodeid, encoding="utf-8")


class Run(NamedTuple):
    """A child that runs tests in a copy."""

    folder: Path
    until: float
    mutant: Mutant | None
    names: list[str]


def start(folder: Path, mutant: Mutant | None, tests: list[Test]) -> tuple[int, Run]:
    """Run tests in a fork, with a fault in the copy; return its number and what it does."""
    names = [one.name for one in tests]
    at, seconds = folder / "runs", sum(one.seconds for one in tests)
    at.write_text("", encoding="utf-8")
    if mutant:
        path = folder / SOURCE / mutant.file
        data = path.read_bytes()
        path.write_bytes(data[: mutant.start] + mutant.new.encode() + data[mutant.end :])
    limit = int(LEAST_TIME + 4 * seconds)
    if number := os.fork():
        return number, Run(folder, time.monotonic() + 8 * limit, mutant, names)
    try:
        os.setsid()
        os.chdir(folder)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
        paths = [str(folder / "src"), str(folder / "tests")]
        sys.path[:0] = paths
        os.environ |= {"PYTHONPATH": os.pathsep.join(paths), "PYTHONDONTWRITEBYTECODE": "1"}
        sys.dont_write_bytecode = True
        if mutant and compiled(mutant.file):  # kernels of other files hold those of this one
            shutil.rmtree(folder / "kernels", ignore_errors=True)
            os.environ["NUMBA_CACHE_DIR"] = str(folder / "kernels")
        silent = os.open(folder / "log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(silent, 1)
        os.dup2(silent, 2)
        files = list(dict.fromkeys(one.file for one in tests))
        code = pytest.main(
            ["-x", "-q", "-p", "no:xdist", "-p", "no:cacheprovider", "-m", QUICK,
             "-W", "ignore::pytest.PytestAssertRewriteWarning",
             "--basetemp", str(folder / "made"), *files],
            plugins=[Chosen(names, at)],
        )  # fmt: skip
        os._exit(int(code))
    finally:
        os._exit(3)


def ended(runs: dict[int, Run]) -> tuple[Run, str | None]:
    """Wait for a run; return it and the test that failed (or its file), None where all passed."""
    while True:
        for number, run in runs.items():
            late = time.monotonic() > run.until
            if late:
                os.killpg(number, signal.SIGKILL)
            done, status = os.waitpid(number, 0 if late else os.WNOHANG)
            if not done:
                continue
            del runs[number]
            with suppress(ProcessLookupError):  # what a killed test left behind
                os.killpg(number, signal.SIGKILL)
            if run.mutant:
                file = SOURCE / run.mutant.file
                shutil.copy2(REPOSITORY / file, run.folder / file)
            if status == 0:
                return run, None
            return run, (run.folder / "runs").read_text(encoding="utf-8") or at_import(run)
        time.sleep(0.02)


def at_import(run: Run) -> str:
    """Return a file of tests that could not be imported, one of the fault's room if there is."""
    log = (run.folder / "log").read_text(encoding="utf-8", errors="replace")
    files = re.findall(r"(?m)^ERROR (tests/\S+\.py)", log)
    near = tests_of(run.mutant.file) if run.mutant else ()
    return next((one for one in files if one in near), files[0] if files else "")


def warm_deaths(
    folder: Path,
    faults: list[Mutant],
    plans: dict[Mutant, tuple[list[Test], list[Test]]],
    jobs: int,
) -> Iterator[tuple[Mutant, str | None]]:
    """Yield the faults that a process with all tests could plant, and what killed each."""
    asked = list[Plan]()
    for number, mutant in enumerate(faults):
        path = folder / SOURCE / mutant.file
        data, tests = path.read_bytes(), [*plans[mutant][0], *plans[mutant][1]]
        text = data[: mutant.start] + mutant.new.encode() + data[mutant.end :]
        limit = int(LEAST_TIME + 4 * sum(one.seconds for one in tests))
        asked.append(Plan(number, path, text, [one.name for one in tests], limit))
    files = sorted({name.partition("::")[0] for plan in asked for name in plan.names})
    for number, killer in deaths(folder, asked, files, QUICK, jobs) if asked else ():
        if killer != NOT_PLANTED:
            yield faults[number], killer or None


def record(tests: Iterable[str], sources: set[str], jobs: int) -> None:
    """Run the quick tests, of these files, whose lines in ``sources`` are not known yet."""
    if not (files := [file for file in tests if known_map(file, sources) is None]):
        return
    print(f"recording the lines that the tests of {len(files)} files run", flush=True)
    spread = ["--dist", "loadfile", "-n", str(jobs)] if jobs > 1 else ["-n", "0"]
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "mutants_map", *spread, "-q", "-m", QUICK, *files],
        cwd=REPOSITORY, env={**os.environ, "PYTHONPATH": str(REPOSITORY / "tests")}, check=False,
    )  # fmt: skip
    without = [file for file in files if known_map(file, sources) is None]
    if run.returncode not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED,
                              pytest.ExitCode.NO_TESTS_COLLECTED):  # fmt: skip
        raise SystemExit(f"The recording ended ({run.returncode}) before: {', '.join(without)}")
    for file in without:
        print(f"no quick test: {file}")
        write_map(file, [], {})


class Deaths:
    """What killed faults before; a death counts while its test and the source stand."""

    PATH = REPOSITORY / "out" / "mutants" / "deaths.json"

    def __init__(self) -> None:
        self._known = json.loads(self.PATH.read_text("utf-8")) if self.PATH.exists() else {}

    @staticmethod
    def _key(mutant: Mutant) -> str:
        return f"{digest(REPOSITORY / SOURCE / mutant.file)} {mutant.start} {mutant.end} {mutant}"

    def killer(self, mutant: Mutant) -> str | None:
        """Return the test of its room that killed a fault, None where none is known."""
        killer, of = self._known.get(self._key(mutant), (None, ""))
        same = killer and digest(REPOSITORY / killer.partition("::")[0]) == of
        return killer if same else None

    def add(self, mutant: Mutant, killer: str) -> None:
        """Write a death down."""
        of = digest(REPOSITORY / killer.partition("::")[0])
        self.__init__()  # another process may have written
        self._known[self._key(mutant)] = killer, of
        self.PATH.parent.mkdir(parents=True, exist_ok=True)
        self.PATH.write_text(json.dumps(self._known), encoding="utf-8")


class Answer(NamedTuple):
    """What became of a fault."""

    mutant: Mutant
    killer: str | None
    own: bool
    met: int

    @property
    def why(self) -> str:
        """Why the fault may live; empty where nobody said."""
        return may_live().get((self.mutant.file, self.mutant.shown.partition(": ")[2]), "")

    def __str__(self) -> str:
        word = "ALIVE " if self.killer is None else "own   " if self.own else "other "
        alive = f"may live: {self.why}" if self.why else f"{self.met} tests"
        end = alive if self.killer is None else self.killer or "at import"
        return f"{word} {self.mutant}   <- {end}"


def met(
    faults: list[Mutant], lines: Lines, copies: list[Path], *, seconds: float, own_only: bool
) -> list[Answer]:
    """Let faults meet their tests, as many at a time as there are copies of the repository."""
    answers, known = list[Answer](), Deaths()
    plans = dict[Mutant, tuple[list[Test], list[Test]]]()

    def told(mutant: Mutant, killer: str | None, count: int) -> None:
        near = killer is not None and killer.partition("::")[0] in tests_of(mutant.file)
        answers.append(Answer(mutant, killer, near, count))
        print(answers[-1], flush=True)
        if killer and near:
            known.add(mutant, killer)

    for mutant in faults:
        if (killer := known.killer(mutant)) and killer not in lines.false:
            answers.append(Answer(mutant, killer, True, 0))
            continue
        meeting, files = lines.meeting(mutant), tests_of(mutant.file)
        nearest = nearest_and_others(mutant.file)[0] if in_function(mutant) else (STATED,)
        near = in_turn((one for one in meeting if one.file in files), seconds, nearest)
        others = [] if own_only else [one for one in meeting if one.file not in files]
        plans[mutant] = near, in_turn(others, seconds)
        if not any(plans[mutant]):
            del plans[mutant]
            told(mutant, None, 0)
    warm = [one for one in plans if lines.run_inside(one)]
    for mutant, killer in warm_deaths(copies[0], warm, plans, len(copies)):
        told(mutant, killer, sum(map(len, plans.pop(mutant))))
    free, runs = list(copies), dict[int, Run]()

    def take() -> None:
        run, killer = ended(runs)
        assert run.mutant is not None
        free.append(run.folder)
        told(run.mutant, killer, len(run.names))

    for mutant in list(plans):
        while not free:
            take()
        number, run = start(free.pop(), mutant, [*plans[mutant][0], *plans[mutant][1]])
        runs[number] = run
    while runs:
        take()
    return answers


def false_killers(names: set[str], folder: Path) -> set[str]:
    """Return the tests that fail in a copy without a fault."""
    false = set[str]()
    while left := sorted(names - false):
        number, run = start(folder, None, [Test(name, 1.0) for name in left])
        run, killer = ended({number: run})
        if killer is None:
            break
        false.add(killer)
    return false


def main() -> None:
    """Make, run and count."""
    rooms = sorted(p.name for p in (REPOSITORY / SOURCE).iterdir() if (p / "__init__.py").exists())
    parser = ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("rooms", nargs="*", metavar="ROOM", help=", ".join(rooms))
    parser.add_argument("--named", action="store_true", help=f"the faults of {NAMED.name}")
    parser.add_argument("--count", type=int, default=20, help="faults a room")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=20.0, help="of tests that a fault meets")
    parser.add_argument("--own", action="store_true", help="meet tests of the fault's room only")
    parser.add_argument("--known", action="store_true", help="record nothing")
    given = parser.parse_args()
    if unknown := [room for room in given.rooms if room not in rooms]:
        parser.error(f"no room: {', '.join(unknown)}. Allowed: {', '.join(rooms)}")
    chosen, named = list[Mutant](), list(named_faults()) if given.named else []
    for room in given.rooms or rooms:
        faults = [
            one
            for one in (named if given.named else room_faults(room, given.count, given.seed))
            if one.file.split("/")[0] == room
        ]
        if not faults and given.rooms:
            parser.error(f"{room}: nothing in it can be changed")
        chosen += faults
    sources = {one.file for one in chosen}
    if not given.known:
        of_rooms = {test for one in chosen for test in tests_of(one.file)}
        wanted = [test for test, _ in test_texts() if not given.own or test in of_rooms]
        record(wanted, sources, given.jobs)
    lines = Lines(
        sources | {file for one in chosen if not in_function(one) for file, _ in uses(one)}
    )
    if lines.red:
        print("These tests fail without a fault, and kill none:", *lines.red, sep="\n  ")
    for library in LIBRARIES:
        import_module(library)
    answers, made = list[Answer](), Path(tempfile.mkdtemp())
    try:
        copies = [copied(made / str(number)) for number in range(given.jobs)]
        while chosen:  # what a test killed that fails without a fault too meets the others
            told = met(chosen, lines, copies, seconds=given.seconds, own_only=given.own)
            killers = {one.killer for one in told if one.killer and "::" in one.killer}
            lines.false |= false_killers(killers, copies[0])
            answers += [one for one in told if one.killer not in lines.false]
            chosen = [one.mutant for one in told if one.killer in lines.false]
    finally:
        shutil.rmtree(made, ignore_errors=True)
    if lines.false:
        names = sorted(lines.false)
        print("These tests fail in a copy without a fault, and kill none:", *names, sep="\n  ")
    print(f"{'room':14} faults  own  quick  may live   (seed {given.seed})")
    for room in (*(given.rooms or rooms), ""):
        of_room = [one for one in answers if one.mutant.file.startswith(f"{room}/" if room else "")]
        dead = [one for one in of_room if one.killer is not None]
        if of_room:
            own = sum(one.own for one in dead)
            quick = "-" if given.own else len(dead)
            allowed = sum(bool(one.why) for one in of_room if one.killer is None)
            print(f"{room or 'all':14} {len(of_room):6} {own:4} {quick:>6} {allowed:9}")


if __name__ == "__main__":
    main()
