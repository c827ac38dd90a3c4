"""Case files as text: read, change a value with its comments kept, write as a whole."""

from __future__ import annotations

import os
import tempfile
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from underfoot.core import InputError

from .unused import unused

if TYPE_CHECKING:
    from .case import Case


def read(path: Path) -> str:
    """Return the text of a case file."""
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        near = [other.name for other in path.parent.glob("*.toml")] if path.parent.is_dir() else []
        from underfoot.core import nearest_match

        raise InputError(
            f"there is no file {path}",
            nearest=nearest_match(path.name, near),
            remedy="Make one with: underfoot new FILE",
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path} can't be read ({error})") from error


def parsed(text: str, file: str | None = None) -> dict[str, Any]:
    """Return a TOML text as nested dictionaries."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(
            f"is no TOML file: {error}",
            where=file,
            remedy='Text and numbers with a unit stand in quotes, as in speed = "0.7 m/s"',
        ) from error


def written(mapping: Mapping[str, Any]) -> str:
    """Return nested mappings as TOML text."""
    import tomlkit

    plain = {key: item for key, item in mapping.items() if not isinstance(item, Mapping)}
    tables = {key: item for key, item in mapping.items() if isinstance(item, Mapping)}
    return tomlkit.dumps({**plain, **tables})


def changed(text: str, settings: Mapping[str, Any], kind: Callable[[str], str]) -> str:
    """Return the text with values replaced; ``kind`` tells sections from values by path.

    A value None takes the key out. A section takes the name of a catalogue entry and loses what
    the file said about it.
    """
    import tomlkit

    parsed(text)
    document = tomlkit.parse(text)
    for path, value in settings.items():
        section = kind(path) == "section"
        if section and not (value is None or isinstance(value, str | Mapping)):
            raise InputError(
                f"{value!r} can't stand for a section",
                where=path,
                allowed="the name of a catalogue entry, or a mapping",
            )
        if section and isinstance(value, str):
            value = {"from": value}
        _set(document, path.split("."), value)
    return tomlkit.dumps(document)


def _set(document: Any, parts: list[str], value: Any) -> None:
    import tomlkit
    from tomlkit.items import Item

    table = document
    for depth, part in enumerate(parts[:-1]):
        item = table.get(part)
        if isinstance(item, str):
            # shoe = "name" becomes shoe = {from = "name"} so that keys can stand beside it
            inline = tomlkit.inline_table()
            inline["from"] = item
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
            table[key] = dict(value)
    elif isinstance(old, Item) and not isinstance(old, dict):
        item, trivia = tomlkit.item(value), old.trivia
        item.trivia.indent, item.trivia.trail = trivia.indent, trivia.trail
        item.trivia.comment_ws, item.trivia.comment = trivia.comment_ws, trivia.comment
        table[key] = item
    else:
        table[key] = value


def _table_like(parent: Any) -> Any:
    import tomlkit
    from tomlkit.items import InlineTable

    return tomlkit.inline_table() if isinstance(parent, InlineTable) else tomlkit.table()


def save(text: str, path: Path, *, overwrite: bool = False) -> None:
    """Write a text file as a whole; an existing file is refused unless ``overwrite``."""
    if path.exists() and not overwrite:
        raise InputError(
            f"the file {path} exists", remedy="Choose another name, or add --overwrite"
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}-")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        os.chmod(name, 0o644)
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def complete_text(case: Case) -> str:
    """Return a case as TOML that needs no catalogue: every value with its source and marks."""
    import tomlkit

    document = tomlkit.document()
    document.add(tomlkit.comment("Complete case: every value with its source."))
    names = {"file_version": case.file_version, "name": case.name, "description": case.description}
    for key, value in names.items():
        document[key] = value
    if case.contaminant is None:
        document["contaminant"] = "none"
    tree: dict[str, Any] = {}
    left_aside = unused(case)
    for path, origin in case.origins.items():
        *parents, key = path.split(".")
        if not parents or path in left_aside:
            continue
        table = tree
        for parent in parents:
            table = table.setdefault(parent, {})
        table[key] = _complete(origin)
    for section in type(case).model_fields:
        if section in tree:
            document[section] = _as_table(tree[section])
    return tomlkit.dumps(document)


def _complete(origin: Any) -> Any:
    leaf = origin.leaf
    marks = {
        "uncertainty": leaf.uncertainty,
        "source": leaf.source or None,
        "assumed": True if leaf.assumed else None,
        "verified": None if leaf.verified else False,
        "note": leaf.note or None,
    }
    marks = {key: value for key, value in marks.items() if value is not None}
    return _Leaf({"value": leaf.given, **marks}) if marks else leaf.given


class _Leaf(dict[str, Any]):
    """A value with marks, written on one line."""


def _as_table(tree: Mapping[str, Any]) -> Any:
    import tomlkit

    table = tomlkit.table()
    plain = {k: v for k, v in tree.items() if isinstance(v, _Leaf) or not isinstance(v, dict)}
    for key, value in plain.items():
        table[key] = _inline(value)
    for key, value in tree.items():
        if key not in plain:
            table[key] = _as_table(value)
    return table


def _inline(value: Any) -> Any:
    import tomlkit

    if isinstance(value, dict):
        inline = tomlkit.inline_table()
        for key, item in value.items():
            inline[key] = _inline(item)
        return inline
    if isinstance(value, list | tuple):
        array = tomlkit.array()
        for item in value:
            array.append(_inline(item))
        return array
    return value
