"""The projects of this person, and the way from one to another: each has a server of its own."""

from __future__ import annotations

import asyncio
import re
import subprocess
import sys
import threading
from pathlib import Path

from platformdirs import user_state_path

from underfoot.core import InputError
from underfoot.core.files import whole_file

MOST_KNOWN = 12
"""Projects that are remembered, the newest."""
LINK = re.compile(r"http\S+token=\S+")
START = "from underfoot.cli import main; main()"


def known_projects() -> list[Path]:
    """Return the projects that were opened and are still there, the newest first."""
    try:
        listed = _list().read_text(encoding="utf-8").splitlines()
    except OSError:
        return []
    return [path for path in map(Path, listed) if (path / "variants").is_dir()]


def remember(folder: Path) -> None:
    """Note that a project was opened; where that can't be written it is not remembered."""
    listed = [folder, *(path for path in known_projects() if path != folder)][:MOST_KNOWN]
    try:
        with whole_file(_list()) as part:
            part.write_text("".join(f"{path}\n" for path in listed), encoding="utf-8")
    except OSError:
        pass


class Servers:
    """Servers of other projects that were opened from this one; they end with it."""

    def __init__(self) -> None:
        self._open: dict[Path, tuple[subprocess.Popen[str], str]] = {}

    async def link(self, folder: Path) -> str:
        """Return the address of the app on another project; its server starts where none runs.

        Raises:
            InputError: What the server says where it does not start.
        """
        process, link = self._open.get(folder, (None, ""))
        if process is None or process.poll() is not None:
            process, link = await asyncio.to_thread(_start_program, folder)
            self._open[folder] = process, link
        return link

    def close(self) -> None:
        """End them."""
        for process, _ in self._open.values():
            process.terminate()


def _start_program(folder: Path) -> tuple[subprocess.Popen[str], str]:
    program = [sys.executable] if getattr(sys, "frozen", False) else [sys.executable, "-c", START]
    process = subprocess.Popen(
        [*program, "app", str(folder), "--no-browser", "--port", "0"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
    )  # fmt: skip
    assert process.stdout is not None
    said = ""
    for line in process.stdout:
        said += line
        if link := LINK.search(line):
            # what it says later must not fill the pipe
            threading.Thread(target=process.stdout.read, daemon=True).start()
            return process, link[0]
    raise InputError(said.strip() or "the server of the project ended", where=str(folder))


def _list() -> Path:
    return user_state_path("underfoot") / "projects.txt"
