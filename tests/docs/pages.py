"""Runs the blocks of a documentation page in their order and holds what they print to the page.

What a block is, the page shows: ``sh`` are commands of a terminal, ``python`` goes on in one
session, a ``{plot}`` draws a figure, a ``toml`` or ``csv`` block whose first line is ``# name`` is
that file. A ``text`` block after one of these is what it prints: each of its lines must come, in
order, with the same words and with numbers within 2 % or one unit of the last digit shown; within
20 % where the number is not known to half of itself ("7.6 ± 9.5 N": what few sensors read of a film
moves by 15 % with the rounding of another processor). ``...`` stands for lines left out.

``python tests/docs/pages.py docs/tutorials/designer.md`` prints what the blocks of a page print
now, ``--mend`` puts today's numbers into the page (``!!`` marks a line no longer printed).
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```(\w+|\{plot\})\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
UNCERTAIN = re.compile(rf"({NUMBER.pattern}) ± ({NUMBER.pattern})")
TOLERANCE, UNKNOWN = 0.02, 0.2


@dataclass(frozen=True)
class Block:
    """One fenced block and the output that the page shows after it (None: none)."""

    language: str
    text: str
    shown: str | None
    line: int


@dataclass
class Session:
    """A folder in which the blocks of a page run, one after the other."""

    folder: Path
    names: dict = field(default_factory=lambda: {"__name__": "__main__"})

    def output(self, block: Block) -> str:
        """Run one block in the folder (the working directory) and return what it prints."""
        if block.language in ("toml", "csv"):
            return self._written(block)
        if block.language == "{plot}":
            return self._drawn(block)
        if block.language == "python":
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile(block.text, f"line {block.line}", "exec"), self.names)
            return printed.getvalue()
        commands = block.text.replace("\\\n", " ").splitlines()
        return "".join(command_output(line) for line in commands if line.strip())

    def _drawn(self, block: Block) -> str:
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        code = re.sub(r"\A(?::\w[\w-]*:.*\n)*", "", block.text)
        try:
            exec(compile(code, f"line {block.line}", "exec"), {"__name__": "__main__"})
            assert pyplot.get_fignums(), f"line {block.line}: no figure"
        finally:
            pyplot.close("all")
        return ""

    def _written(self, block: Block) -> str:
        name = re.match(r"# ([\w./-]+\.\w+)$", block.text.splitlines()[0])
        if name:
            path = self.folder / name.group(1)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text.split("\n", 1)[1] if path.suffix == ".csv" else block.text)
        return ""


def command_output(line: str) -> str:
    """Standard output of a command; the program runs in this process, others in a shell."""
    if not line.startswith("underfoot "):
        done = subprocess.run(line, shell=True, capture_output=True, text=True, check=True)
        return done.stdout
    from typer.testing import CliRunner

    from underfoot.cli.app import app

    done = CliRunner().invoke(app, shlex.split(os.path.expandvars(line), comments=True)[1:])
    assert done.exit_code == 0, f"{line}\n{done.output}"
    return done.stdout


def blocks_of(page: Path) -> list[Block]:
    """All blocks that run, each with the output shown after it."""
    text = page.read_text()
    found = [
        (m.group(1), m.group(2), text[: m.start()].count("\n") + 1) for m in BLOCK.finditer(text)
    ]
    result = []
    for number, (language, body, line) in enumerate(found):
        if language not in ("sh", "python", "toml", "csv", "{plot}"):
            continue
        following = found[number + 1] if number + 1 < len(found) else ("", "", 0)
        shown = following[1] if following[0] == "text" else None
        result.append(Block(language, body, shown, line))
    return result


def close(shown: str, printed: str, tolerance: float) -> bool:
    """Whether two printed numbers agree within a share or one unit of the last digit shown."""
    mantissa, _, exponent = shown.partition("e")
    digits = len(mantissa.partition(".")[2])
    unit = 10.0 ** (int(exponent or 0) - digits)
    allowed = max(tolerance * abs(float(shown)), 1.001 * unit)
    return abs(float(shown) - float(printed)) <= allowed


def agrees(shown: str, printed: str) -> bool:
    """Whether a line has the same words and numbers near enough."""
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=False)
    known = UNCERTAIN.search(shown)
    unknown = known is not None and float(known[2]) > 0.5 * abs(float(known[1]))
    tolerance = UNKNOWN if unknown else TOLERANCE
    return _words(shown) == _words(printed) and all(close(a, b, tolerance) for a, b in pairs)


def held(shown: str, printed: str) -> int:
    """Hold the printed output to the shown lines; return how many numbers were compared."""
    lines = iter(printed.splitlines())
    numbers = 0
    for wanted in shown.splitlines():
        if wanted.strip() in ("", "..."):
            continue
        if not any(agrees(wanted, line) for line in lines):
            raise AssertionError(f"not printed (in this order):\n{wanted}\nprinted:\n{printed}")
        numbers += len(NUMBER.findall(wanted))
    return numbers


def mended(shown: str, printed: str) -> str:
    """The shown lines with today's numbers: each from the next printed line of the same words."""
    lines = printed.splitlines()
    result = []
    for wanted in shown.splitlines():
        if wanted.strip() not in ("", "..."):
            words = _words(wanted)
            same = [index for index, line in enumerate(lines) if _words(line) == words]
            near = [index for index in same if agrees(wanted, lines[index])]
            if not same:
                wanted = f"!! {wanted}"
            else:
                index = (near or same)[0]
                wanted = wanted if near else lines[index].rstrip()
                lines = lines[index + 1 :]
        result.append(wanted)
    return "\n".join(result) + "\n"


def _words(line: str) -> str:
    return " ".join(NUMBER.sub("#", line).split())


@contextlib.contextmanager
def reader(folder: Path):
    """The surroundings of a reader: a folder, a terminal of 100 columns, the cloned project."""
    before, environment = Path.cwd(), dict(os.environ)
    os.environ.update(COLUMNS="100", UNDERFOOT=str(ROOT), UNDERFOOT_CACHE=str(folder / ".cache"))
    os.environ.pop("UNDERFOOT_CATALOGUE", None)
    os.chdir(folder)
    try:
        yield Session(folder)
    finally:
        os.chdir(before)
        os.environ.clear()
        os.environ.update(environment)


def numbers_compared(page: Path, folder: Path) -> int:
    """Run a page in a folder; return how many of its printed numbers were compared."""
    numbers = 0
    with reader(folder) as session:
        for block in blocks_of(page):
            printed = session.output(block)
            if block.shown is not None:
                numbers += held(block.shown, printed)
    return numbers


def main(page: str, *, mend: bool) -> None:
    """Print what the blocks of a page print now; ``mend`` puts the numbers into the page."""
    source = Path(page).resolve()
    text = source.read_text()
    with tempfile.TemporaryDirectory() as folder, reader(Path(folder)) as session:
        total = 0.0
        for block in blocks_of(source):
            start = os.times()
            printed = session.output(block)
            used = sum(os.times()[:4]) - sum(start[:4])
            total += used
            print(f"--- line {block.line}, {used:.1f} s of processor\n{block.text}")
            print(f">>>\n{printed}", flush=True)
            if block.shown:
                text = text.replace(block.shown, mended(block.shown, printed))
        print(f"all blocks: {total:.0f} s of processor")
    if mend:
        source.write_text(text)


if __name__ == "__main__":
    main(sys.argv[1], mend="--mend" in sys.argv)
