"""Catalogue: materials, floors, fluids, shoes, set-ups and published figures, each with its source.

An entry is a table in a TOML file, ``[fluid.canola_oil]``. Its leaves are plain values, which take
the ``source`` of the entry, or tables with ``value`` and any of ``uncertainty``, ``source``,
``assumed``, ``verified`` and ``note``. ``from = "name"`` takes over another entry of its kind.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from importlib import resources
from pathlib import Path
from typing import Any, ClassVar

from .errors import InputError, unknown_name
from .files import read_toml
from .leaves import INHERITED, Leaf, leaves
from .presentation import Presentable, Table
from .values import SourcedValue

KINDS = ("fluid", "floor", "material", "protocol", "published", "setup", "shoe")
BUILT_IN = "built in"
_NO_SOURCE = "no source given"
_ENTRY_KEYS = frozenset({"title", "from", "replaces", *INHERITED})


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry of the catalogue; ``values`` maps dotted paths to leaves."""

    kind: str
    name: str
    title: str
    origin: str
    values: Mapping[str, Leaf]
    note: str = ""
    parents: tuple[str, ...] = ()

    def leaf(self, path: str) -> Leaf:
        """Return the leaf at a dotted path."""
        try:
            return self.values[path]
        except KeyError:
            raise unknown_name(
                f"value of {self.kind} {self.name}", path, self.values, where=self._where(path)
            ) from None

    def sourced(self, path: str, unit: str | None = None) -> SourcedValue:
        """Return a number in SI with its source; ``unit`` None takes the unit that fits."""
        return self.leaf(path).sourced(unit, where=self._where(path))

    def numbers(self, path: str, unit: str | None = None) -> tuple[float, ...]:
        """Return a list of numbers in SI."""
        leaf = self.leaf(path)
        if not isinstance(leaf.given, list | tuple):
            raise InputError(f"{leaf.given!r} is no list", where=self._where(path))
        found = []
        for index, given in enumerate(leaf.given):
            value = replace(leaf, given=given).sourced(unit, where=f"{self._where(path)}[{index}]")
            found.append(float(value.value or 0.0))
        return tuple(found)

    def text(self, path: str) -> str:
        """Return a word."""
        return str(self.leaf(path).given)

    def under(self, section: str) -> dict[str, Leaf]:
        """Return the leaves of one sub-table, by the rest of their path."""
        start = section + "."
        return {path[len(start) :]: v for path, v in self.values.items() if path.startswith(start)}

    def _where(self, path: str) -> str:
        return f"{self.origin}, {self.kind}.{self.name}.{path}"


@dataclass(frozen=True, slots=True, repr=False)
class Catalogue(Presentable):
    """All entries of the package and of the user's folders."""

    kind: ClassVar[str] = "catalogue"

    entries: Mapping[tuple[str, str], Entry] = field(default_factory=dict)
    folders: tuple[str, ...] = ()

    @classmethod
    def load(cls, folders: Iterable[Path | str] = ()) -> Catalogue:
        """Return the built-in entries and those of ``folders``, read in order.

        A name may stand once for each kind: a second entry of the same name is refused, unless
        it comes from a user's folder and says ``replaces = true``.

        Errors
        ------
        InputError
            A folder or file that can't be read, an unknown kind, a name clash, a ``from`` that
            leads nowhere or in a circle.
        """
        chosen = tuple(str(Path(folder)) for folder in folders)
        return _loaded(chosen, tuple(_stamp(Path(folder)) for folder in chosen))

    def __repr__(self) -> str:
        own = f", with {', '.join(self.folders)}" if self.folders else ""
        return f"<Catalogue of {len(self.entries)} entries{own:.120}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """Travel between processes by the folders where those still hold the same."""
        try:
            same = Catalogue.load(self.folders) is self
        except InputError:
            same = False
        return (
            (Catalogue.load, (self.folders,))
            if same
            else (Catalogue, (dict(self.entries), self.folders))
        )

    def table(self) -> Table:
        """Return every entry with its kind and title."""
        rows = [(kind, name, self.entries[kind, name].title) for kind, name in sorted(self.entries)]
        return Table("Catalogue", ("kind", "name", "title"), rows)

    def names(self, kind: str) -> list[str]:
        """Return the sorted names of one kind."""
        if kind not in KINDS:
            raise unknown_name("kind of catalogue entry", kind, KINDS)
        return sorted(name for known, name in self.entries if known == kind)

    def entry(self, kind: str, name: str, *, where: str | None = None) -> Entry:
        """Return one entry; an unknown name is answered with the nearest one."""
        known = self.names(kind)
        if name not in known:
            raise unknown_name(kind, name, known, where=where)
        return self.entries[kind, name]

    def describe(self, name: str) -> str:
        """Return every entry of this name in words: values, sources, notes."""
        found = [entry for (_, known), entry in self.entries.items() if known == name]
        if not found:
            raise unknown_name("catalogue entry", name, {known for _, known in self.entries})
        return "\n\n".join(_described(entry) for entry in found)


def catalogue(*folders: Path | str) -> Catalogue:
    """Return the catalogue: the built-in entries and those of ``folders``."""
    return Catalogue.load(folders)


def catalogue_folders(
    beside: Path | str | None = None, extra: Iterable[Path | str] = ()
) -> list[Path]:
    """Return the user's catalogue folders, in the order in which they are read.

    ``UNDERFOOT_CATALOGUE`` (several folders, separated as in PATH), then the folder ``catalogue``
    beside the case, then ``extra``.
    """
    found = [Path(part) for part in os.environ.get("UNDERFOOT_CATALOGUE", "").split(os.pathsep)]
    found = [path for path in found if str(path) != "."]
    if beside is not None and (Path(beside) / "catalogue").is_dir():
        found.append(Path(beside) / "catalogue")
    found += [Path(path) for path in extra]
    unique = {path.resolve(): path for path in found}
    return list(unique.values())


@cache
def _built_in_tables() -> dict[tuple[str, str], tuple[str, dict[str, Any]]]:
    raw: dict[tuple[str, str], tuple[str, dict[str, Any]]] = {}
    with resources.as_file(resources.files("underfoot") / "data") as folder:
        _add(raw, _folder_tables(folder, built_in=True))
    return raw


@lru_cache(maxsize=16)
def _loaded(folders: tuple[str, ...], stamps: tuple[tuple[Any, ...], ...]) -> Catalogue:
    """Read folders once for each state (``stamps``) of their files."""
    raw = dict(_built_in_tables())
    for folder in folders:
        _add(raw, _folder_tables(Path(folder)))
    return Catalogue(_entries(raw), folders)


def _stamp(folder: Path) -> tuple[Any, ...]:
    """Return name, time and size of every file of a folder."""
    states = [(file, file.stat()) for file in sorted(folder.rglob("*.toml"))]
    return tuple((str(file), state.st_mtime_ns, state.st_size) for file, state in states)


def _folder_tables(
    folder: Path, *, built_in: bool = False
) -> dict[tuple[str, str], tuple[str, dict[str, Any]]]:
    if not folder.is_dir():
        raise InputError(
            f"the catalogue folder {folder} does not exist",
            allowed="a folder with TOML files",
        )
    tables: dict[tuple[str, str], tuple[str, dict[str, Any]]] = {}
    for file in sorted(folder.rglob("*.toml")):
        # The studies' statements and the corpus of measurements are read by their own rooms.
        if built_in and file.parent.name in ("statements", "measurements"):
            continue
        origin = BUILT_IN if built_in else str(file)
        for kind, entries in read_toml(file).items():
            if kind not in KINDS:
                raise unknown_name("kind of catalogue entry", kind, KINDS, where=str(file))
            if not isinstance(entries, dict):
                raise InputError(f"{kind} is no table of entries", where=str(file))
            for name, table in entries.items():
                if not isinstance(table, dict):
                    raise InputError(f"{kind}.{name} is no table", where=str(file))
                if (kind, name) in tables:
                    raise _clash(kind, name, str(file), tables[kind, name][0])
                tables[kind, name] = (origin, table)
    return tables


def _add(
    raw: dict[tuple[str, str], tuple[str, dict[str, Any]]],
    new: Mapping[tuple[str, str], tuple[str, dict[str, Any]]],
) -> None:
    for (kind, name), (origin, table) in new.items():
        if (kind, name) in raw and not table.get("replaces", False):
            raise _clash(kind, name, origin, raw[kind, name][0])
        raw[kind, name] = (origin, table)


def _clash(kind: str, name: str, here: str, there: str) -> InputError:
    return InputError(
        f'the {kind} "{name}" is defined twice, here and in: {there}',
        where=here,
        remedy="Give it another name, or write replaces = true in a catalogue of your own",
    )


def _entries(
    raw: Mapping[tuple[str, str], tuple[str, dict[str, Any]]],
) -> dict[tuple[str, str], Entry]:
    done: dict[tuple[str, str], Entry] = {}
    for kind, name in raw:
        _resolve(kind, name, raw, done, ())
    return done


def _resolve(
    kind: str,
    name: str,
    raw: Mapping[tuple[str, str], tuple[str, dict[str, Any]]],
    done: dict[tuple[str, str], Entry],
    chain: tuple[str, ...],
) -> Entry:
    if (kind, name) in done:
        return done[kind, name]
    origin, table = raw[kind, name]
    where = f"{origin}, {kind}.{name}"
    if name in chain:
        raise InputError(f"from leads in a circle: {' -> '.join((*chain, name))}", where=where)
    values: dict[str, Leaf] = {}
    parents: tuple[str, ...] = ()
    parent = table.get("from")
    if parent is not None:
        if (kind, parent) not in raw or (parent == name):
            known = {n for k, n in raw if k == kind} - {name}
            raise unknown_name(kind, str(parent), known, where=f"{where}.from")
        base = _resolve(kind, parent, raw, done, (*chain, name))
        values.update(base.values)
        parents = (parent, *base.parents)
    own = leaves(table, skip=_ENTRY_KEYS - set(INHERITED))
    values.update(_with_source(path, leaf, origin) for path, leaf in own.items())
    title, note = str(table.get("title", name)), str(table.get("note", ""))
    done[kind, name] = Entry(kind, name, title, origin, values, note, parents)
    return done[kind, name]


def _with_source(path: str, leaf: Leaf, origin: str) -> tuple[str, Leaf]:
    if leaf.source:
        return path, leaf
    return path, replace(leaf, source=f"{_NO_SOURCE} ({origin})", assumed=True)


def _described(entry: Entry) -> str:
    lines = [f"{entry.kind} {entry.name}: {entry.title}"]
    if entry.note:
        lines.append(entry.note)
    if entry.parents:
        lines.append(f"takes over: {', '.join(entry.parents)}")
    for path, leaf in entry.values.items():
        spread = "" if leaf.uncertainty is None else f" ± {leaf.uncertainty}"
        marks = [leaf.source]
        marks += ["assumed"] if leaf.assumed else []
        marks += [] if leaf.verified else ["from memory, not verified"]
        marks += [leaf.note] if leaf.note and leaf.note != entry.note else []
        marks += [leaf.erratum] if leaf.erratum else []
        lines.append(f"  {path} = {leaf.given}{spread}   [{'; '.join(marks)}]")
    return "\n".join(lines)
