"""Case files as text: read, change a value with its comments kept, write, and where keys stand."""

import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.items import InlineTable, Item

from underfoot.core import InputError
from underfoot.core.errors import missing_file
from underfoot.core.files import whole_file
from underfoot.core.remark import Message
from underfoot.core.typed import float_of_text


def read_text(path: Path) -> str:
    """Return the text of a case file; a byte-order mark is no part of it."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError as error:
        raise missing_file(path, "*.toml", remedy="Make one with: underfoot new FILE") from error
    except UnicodeDecodeError as error:
        raise InputError(
            Message("{path} can't be read ({strerror})", path=path, strerror=error),
            remedy="Save the file as UTF-8 text",
        ) from error
    except OSError as error:
        raise InputError(
            Message("{path} can't be read ({strerror})", path=path, strerror=error)
        ) from error


def parse_toml(text: str, file: str | None = None) -> dict[str, Any]:
    """Return a TOML text as nested dictionaries."""
    try:
        return tomllib.loads(text.removeprefix("\ufeff"), parse_float=float_of_text)
    except tomllib.TOMLDecodeError as error:
        remedy = 'Text and numbers with a unit stand in quotes, as in speed = "0.7 m/s"'
        if "Cannot overwrite" in str(error):
            remedy = 'Beside [shoe.material] write [shoe] with from = "NAME", not shoe = "NAME"'
        raise InputError(
            Message("is no TOML file: {error}", error=error), where=file, remedy=remedy
        ) from error
    except RecursionError as error:
        raise InputError(
            "brackets are nested too deeply",
            where=file,
            allowed="some levels of tables and lists",
            remedy="Close the brackets: a case needs no list within a list",
        ) from error


def change_text(text: str, settings: Mapping[str, Any], expand: Callable[[Any, str], Any]) -> str:
    """Return the text with values replaced and comments kept.

    A value None takes the key out. ``expand`` returns the section that a name stands for at a path:
    ``{"from": name}`` of a catalogue entry, ``{"model": name}`` of an option. A section that is
    named anew loses what the file said about it.
    """
    document = tomlkit.parse(text)
    for path, value in settings.items():
        _set(document, path.split("."), expand(value, path), expand)
    return tomlkit.dumps(document)


def _set(document: Any, parts: list[str], value: Any, expand: Callable[[Any, str], Any]) -> None:
    table = document
    for depth, part in enumerate(parts[:-1]):
        item = table.get(part)
        section = expand(item, ".".join(parts[: depth + 1])) if isinstance(item, str) else None
        if isinstance(section, Mapping):
            # shoe = "name" becomes shoe = {from = "name"} so that keys can stand beside it
            inline = tomlkit.inline_table()
            inline.update(section)
            table[part] = inline
        elif item is None:
            if value is None:
                return
            table[part] = tomlkit.table() if depth == 0 else _table_like(table)
        table = table[part]
        if not isinstance(table, dict):
            raise InputError("is a value, not a section", where=".".join(parts[: depth + 1]))
    key = parts[-1]
    if value is None:
        table.pop(key, None)
        return
    old = table.get(key)
    if isinstance(value, Mapping):
        if isinstance(old, str) and table is document:
            inline = tomlkit.inline_table()
            inline.update(value)
            table[key] = inline
        else:
            table.pop(key, None)
            leaf = "value" in value
            table[key] = tomlkit.value(_line(value)) if leaf else dict(value)
    elif isinstance(old, Item) and not isinstance(old, dict):
        item, trivia = tomlkit.item(value), old.trivia
        item.trivia.indent, item.trivia.trail = trivia.indent, trivia.trail
        item.trivia.comment_ws, item.trivia.comment = trivia.comment_ws, trivia.comment
        table[key] = item
    else:
        table[key] = value


def _table_like(parent: Any) -> Any:
    return tomlkit.inline_table() if isinstance(parent, InlineTable) else tomlkit.table()


def toml_text(tree: Mapping[str, Any], comment: str = "") -> str:
    """Return nested mappings as TOML: a mapping with ``value`` stands on one line."""
    tables = "\n".join(_tables(tree))
    return f"# {comment}\n{tables}" if comment else tables


def _tables(tree: Mapping[str, Any], path: tuple[str, ...] = ()) -> Iterator[str]:
    """Yield each table with its header; one of tables alone goes without."""
    below = {k: v for k, v in tree.items() if isinstance(v, Mapping) and "value" not in v}
    lines = [f"{_key(key)} = {_line(tree[key])}\n" for key in tree if key not in below]
    if lines or not below:
        header = f"[{'.'.join(map(_key, path))}]\n" if path else ""
        yield header + "".join(lines)
    for key, value in below.items():
        yield from _tables(value, (*path, key))


def _key(name: str) -> str:
    return tomlkit.key(name).as_string()


def _line(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key)} = {_line(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_line, value))}]"
    return tomlkit.item(value).as_string()


def save(text: str, path: Path, *, overwrite: bool = False) -> None:
    """Write a text file as a whole; an existing file is refused unless ``overwrite``."""
    if path.exists() and not overwrite:
        raise InputError(
            Message("the file {path} exists", path=path),
            remedy="Choose another name, or add --overwrite",
        )
    with whole_file(path) as part:
        part.write_text(text, encoding="utf-8")


class Places:
    """Where the keys of a case stand: ``shoe.tread.depth (file.toml, line 12)``.

    ``moved`` maps paths to those under which an older file writes them.
    """

    def __init__(
        self, file: str | None = None, text: str | None = None, *, changed: Iterable[str] = ()
    ) -> None:
        self.file = file
        self.text = text
        self.changed = tuple(changed)
        self.moved: dict[str, str] = {}

    @cached_property
    def lines(self) -> dict[tuple[str, ...], int]:
        """Line of every key."""
        return {} if self.text is None else key_lines(self.text)

    def __call__(self, path: str) -> str:
        """Return the dotted path with file and line, when they can be found."""
        if self.file is None:
            return path
        if any(path == other or path.startswith(other + ".") for other in self.changed):
            return Message("{path} (set for this run)", path=path)
        # an item of a list stands on the line of its list
        parts = self.moved.get(path, path).replace("[", ".").split(".")
        while parts:
            line = self.lines.get(tuple(parts))
            if line is not None:
                return Message("{path} ({file}, line {line})", path=path, file=self.file, line=line)
            parts.pop()
        return f"{path} ({self.file})"


def key_lines(text: str) -> dict[tuple[str, ...], int]:
    """Return the line of every table header and key of a TOML text.

    A plain scan: keys within inline tables and multi-line values are left to their parent key.
    """
    lines: dict[tuple[str, ...], int] = {}
    table: tuple[str, ...] = ()
    fence = ""
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.strip()
        if fence:
            fence = "" if fence in line else fence
            continue
        if line.startswith("[") and "=" not in line.split("]")[0]:
            table = _key_parts(line.strip("[]").split("]")[0])
            lines.setdefault(table, number)
            continue
        if not line or line.startswith("#") or "=" not in line:
            continue
        key, _, value = line.partition("=")
        parts = _key_parts(key)
        for depth in range(1, len(parts) + 1):
            lines.setdefault((*table, *parts[:depth]), number)
        for mark in ('"""', "'''"):
            if value.count(mark) == 1:
                fence = mark
    return lines


def _key_parts(text: str) -> tuple[str, ...]:
    return tuple(part.strip().strip("\"'") for part in text.split("."))
