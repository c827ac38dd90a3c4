"""Where the keys of a case stand in its file."""

from __future__ import annotations

from collections.abc import Iterable


class Places:
    """Where the keys of a case stand: ``shoe.tread.depth (file.toml, line 12)``."""

    def __init__(
        self, file: str | None = None, text: str | None = None, *, changed: Iterable[str] = ()
    ) -> None:
        self.file = file
        self.lines = {} if text is None else key_lines(text)
        self.changed = tuple(changed)

    def __call__(self, path: str) -> str:
        """Return the dotted path with file and line, when they can be found."""
        if self.file is None:
            return path
        if any(path == other or path.startswith(other + ".") for other in self.changed):
            return f"{path} (set for this run)"
        parts = path.split(".")
        while parts:
            line = self.lines.get(tuple(parts))
            if line is not None:
                return f"{path} ({self.file}, line {line})"
            parts.pop()
        return f"{path} ({self.file})"


def key_lines(text: str) -> dict[tuple[str, ...], int]:
    """Return the line of every table header and key of a TOML text.

    A plain scan: keys within inline tables and multi-line values are left to their parent key.
    """
    found: dict[tuple[str, ...], int] = {}
    table: tuple[str, ...] = ()
    fence = ""
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.strip()
        if fence:
            fence = "" if fence in line else fence
            continue
        if line.startswith("[") and "=" not in line.split("]")[0]:
            table = _key_parts(line.strip("[]").split("]")[0])
            found.setdefault(table, number)
            continue
        if not line or line.startswith("#") or "=" not in line:
            continue
        key, _, value = line.partition("=")
        parts = _key_parts(key)
        for depth in range(1, len(parts) + 1):
            found.setdefault((*table, *parts[:depth]), number)
        for mark in ('"""', "'''"):
            if value.count(mark) == 1:
                fence = mark
    return found


def _key_parts(text: str) -> tuple[str, ...]:
    return tuple(part.strip().strip("\"'") for part in text.split("."))
