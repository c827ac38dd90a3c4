"""Changes lines of the source one at a time and counts the changes that no quick test sees.

    make mutants ROOM=compute                 20 seeded faults in one room (a folder of the source)
    python tests/mutants.py slip shoe --count 40 --seed 7
    python tests/mutants.py --named [ROOM]    the faults of mutants.toml, which tests once let pass

A fault turns a sign, a comparison or a choice round, moves a number or an index, or swaps two
arguments. It runs the quick tests that import its module, then those of its room (24 files at
most), in a copy of the repository, until the first that fails; three times the time of these tests
without a fault is its end. What survives is printed with its place: mend the tests, or say why it
may live (it changes nothing that can be seen). Not part of ``make test``: it takes minutes.
"""

import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from argparse import ArgumentParser
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path
from queue import Queue
from typing import Any, NamedTuple

REPOSITORY = Path(__file__).resolve().parents[1]
SOURCE = Path("src", "underfoot")
NAMED = Path(__file__).with_suffix(".toml")
NO_TESTS_OF_CODE = ("docs", "install")
MOST_FILES = 24
QUICK = "not slow and not study and not browser"
LEAST_TIME = 60.0  # s, below which no fault is called endless
GUARD = 1e-5  # a number below it keeps a division or a rounding safe: twice it changes nothing
ALIKE = {"min", "max", "hypot", "minimum", "maximum", "gcd", "isinstance", "getattr"}
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

    def __str__(self) -> str:
        return f"{self.file}: {self.shown}"


class Faults(ast.NodeVisitor):
    """Every fault that a file may get; what is said to people and to type checkers gets none."""

    def __init__(self, file: str, text: str) -> None:
        self.file, self.text, self.found = file, text, list[Mutant]()
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
        self.found.append(Mutant(self.file, start, end, new, f"line {line}: {shown.strip()}"))

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
        elif isinstance(node.value, int):
            self._change(start, end, str(node.value + 1))
        elif isinstance(node.value, float) and not 0 < node.value < GUARD:
            self._change(start, end, repr(2 * node.value) if node.value else "1.0")

    def visit_Call(self, node: ast.Call) -> None:
        name = node.func
        word = name.attr if isinstance(name, ast.Attribute) else getattr(name, "id", "")
        if word.endswith("Error") or word in ("cast", "field", "info", "warning", "note"):
            return
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

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        for part in (*node.args.defaults, *filter(None, node.args.kw_defaults), *node.body):
            self.visit(part)

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
            yield Mutant(file, start, start + len(old.encode()), new, f"{old!r} -> {new!r}")


def tests_of(file: str) -> tuple[str, ...]:
    """Return the tests of a file: those that import its module, then those of its room."""
    parts = Path(file).with_suffix("").parts
    module, room = ".".join(("underfoot", *parts)), parts[0]
    names = (module, f"from {module.rpartition('.')[0]} import {parts[-1]}\n")
    nearest, others = [], []
    for path in sorted((REPOSITORY / "tests").rglob("test_*.py")):
        text = path.read_text(encoding="utf-8")
        name = path.relative_to(REPOSITORY / "tests").as_posix()
        if name.split("/")[0] in NO_TESTS_OF_CODE:
            continue
        if any(one in text for one in names):
            nearest.append(name)
        elif path.name.startswith(f"test_{room}_") or f"underfoot.{room}" in text:
            others.append(name)
    others.sort(key=lambda name: not Path(name).name.startswith(f"test_{room}_"))
    return (*nearest, *others)[:MOST_FILES]


def copied(folder: Path) -> Path:
    """Return a copy of what the repository holds."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=REPOSITORY, capture_output=True, check=True, text=True
    )
    for name in filter(None, listed.stdout.split("\0")):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(REPOSITORY / name, folder / name)
    return folder


def passes(folder: Path, tests: tuple[str, ...], limit: float | None = None) -> bool:
    """Return whether some tests pass in a copy, within ``limit`` (s)."""
    paths = [folder / "src", folder / "tests"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))}
    options = ["-x", "-q", "-p", "no:xdist", "-m", QUICK]
    command = [sys.executable, "-m", "pytest", *options, *(f"tests/{name}" for name in tests)]
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, timeout=limit, check=False
        )
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def main() -> None:
    """Make, run and count."""
    rooms = sorted(p.name for p in (REPOSITORY / SOURCE).iterdir() if (p / "__init__.py").exists())
    parser = ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("rooms", nargs="*", metavar="ROOM", help=", ".join(rooms))
    parser.add_argument("--named", action="store_true", help=f"the faults of {NAMED.name}")
    parser.add_argument("--count", type=int, default=20, help="faults a room")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    if unknown := [room for room in given.rooms if room not in rooms]:
        parser.error(f"no room: {', '.join(unknown)}. Allowed: {', '.join(rooms)}")
    if not given.rooms and not given.named:
        parser.error(f"which room? {', '.join(rooms)}; or --named")
    chosen = [
        one
        for one in (named_faults() if given.named else ())
        if one.file.split("/")[0] in (given.rooms or rooms)
    ]
    for room in given.rooms if not given.named else ():
        if not (faults := room_faults(room, given.count, given.seed)):
            parser.error(f"{room}: nothing in it can be changed")
        chosen += faults
    alive: list[Mutant] = []
    with tempfile.TemporaryDirectory() as made, ThreadPoolExecutor(given.jobs) as pool:
        copies: Queue[Path] = Queue()
        for number in range(given.jobs):
            copies.put(copied(Path(made, str(number))))
        limits: dict[tuple[str, ...], float] = {}
        for tests in dict.fromkeys(tests_of(one.file) for one in chosen):
            if not tests:
                parser.error("a file has no tests: " + ", ".join(
                    sorted({one.file for one in chosen if not tests_of(one.file)})))  # fmt: skip
            begun = time.monotonic()
            if not passes(Path(made, "0"), tests):
                parser.error(f"these tests fail without a fault: {' '.join(tests)}")
            limits[tests] = max(3 * (time.monotonic() - begun), LEAST_TIME)

        def looked(mutant: Mutant) -> None:
            folder = copies.get()
            path = folder / SOURCE / mutant.file
            data, tests = path.read_bytes(), tests_of(mutant.file)
            path.write_bytes(data[: mutant.start] + mutant.new.encode() + data[mutant.end :])
            try:
                lives = passes(folder, tests, given.jobs * limits[tests])
            finally:
                path.write_bytes(data)
                copies.put(folder)
            print(f"{'ALIVE ' if lives else 'killed'} {mutant}", flush=True)
            if lives:
                alive.append(mutant)

        list(pool.map(looked, chosen))
    repeat = "" if given.named else f" (--seed {given.seed} repeats them)"
    print(f"{len(chosen) - len(alive)} of {len(chosen)} killed{repeat}")


if __name__ == "__main__":
    main()
