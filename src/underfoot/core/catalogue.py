"""Catalogue: materials, floors, fluids, shoes, set-ups and published figures, each with its source.

An entry is a table in a TOML file, ``[fluid.canola_oil]``. Its leaves are plain values, which take
the ``source`` of the entry, or tables with ``value`` and any of ``uncertainty``, ``source``,
``assumed``, ``verified`` and ``note``. ``from = "name"`` takes over another entry of its kind.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from importlib import resources
from pathlib import Path
from typing import Any, ClassVar

from .deprecation import renamed_member
from .errors import InputError, unknown_name
from .files import checksum, read_toml
from .leaves import FrozenTable, Leaf, leaves
from .presentation import Presentable, Table
from .registry import offers
from .remark import Message
from .values import SourcedValue

KINDS = ("fluid", "floor", "material", "protocol", "published", "setup", "shoe")
BUILT_IN = "built in"
_NO_SOURCE = "no source given"
_ENTRY_KEYS = frozenset({"title", "from", "replaces"})
_Tables = dict[tuple[str, str], tuple[str, dict[str, Any]]]
"""Where each entry, by kind and name, comes from, and what is written of it."""


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

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", FrozenTable(self.values))

    def leaf(self, path: str) -> Leaf:
        """Return the leaf at a dotted path."""
        try:
            return self.values[path]
        except KeyError:
            raise unknown_name(
                Message("value of {kind} {name}", kind=self.kind, name=self.name),
                path,
                self.values,
                where=self._where(path),
            ) from None

    def sourced_value(self, path: str, unit: str | None = None) -> SourcedValue:
        """Return a number in SI with its source; ``unit`` None takes the unit that fits."""
        return self.leaf(path).sourced_value(unit, where=self._where(path))

    sourced = renamed_member("sourced", "sourced_value", gone="0.4")

    def numbers(self, path: str, unit: str | None = None) -> tuple[float, ...]:
        """Return a list of numbers in SI."""
        leaf, where = self.leaf(path), self._where(path)
        if not isinstance(leaf.given, list | tuple):
            raise InputError(Message("{given} is no list", given=repr(leaf.given)), where=where)
        values = (
            replace(leaf, given=given).sourced_value(unit, where=f"{where}[{index}]").value
            for index, given in enumerate(leaf.given)
        )
        return tuple(float(value or 0.0) for value in values)

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

    def __post_init__(self) -> None:
        object.__setattr__(self, "entries", FrozenTable(self.entries))

    @classmethod
    def load(cls, folders: Iterable[Path | str] = ()) -> Catalogue:
        """Return the built-in entries and those of ``folders``, read in order.

        A name may stand once for each kind: a second entry of the same name is refused, unless
        it comes from a user's folder and says ``replaces = true``.

        Errors:
            InputError: A folder or file that can't be read, an unknown kind, a name clash, a
                ``from`` that leads nowhere or in a circle.
        """
        chosen = tuple(str(Path(folder)) for folder in folders)
        return _load_folders(chosen, tuple(map(_content, (*chosen, *_offered_folders()))))

    def __repr__(self) -> str:
        folders = f", with {', '.join(self.folders)}" if self.folders else ""
        return f"<Catalogue of {len(self.entries)} entries{folders:.120}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """Travel between processes by the folders where those still hold the same."""
        with suppress(InputError):
            if Catalogue.load(self.folders) is self:
                return Catalogue.load, (self.folders,)
        return Catalogue, (dict(self.entries), self.folders)

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

    def of(self, kinds: Iterable[str]) -> Catalogue:
        """Return the catalogue of some kinds alone."""
        kinds = set(kinds)
        return Catalogue({at: e for at, e in self.entries.items() if at[0] in kinds}, self.folders)

    def content(self) -> dict[str, Any]:
        """Return what the entries say in plain data, without sources and notes."""
        return {
            f"{kind}.{name}": {
                "parents": entry.parents,
                **{k: (v.given, v.uncertainty, v.assumed) for k, v in entry.values.items()},
            }
            for (kind, name), entry in self.entries.items()
        }

    def describe(self, name: str) -> str:
        """Return every entry of this name in words: values, sources, notes."""
        entries = [entry for (_, known), entry in self.entries.items() if known == name]
        if not entries:
            raise unknown_name("catalogue entry", name, {known for _, known in self.entries})
        return "\n\n".join(map(_describe_entry, entries))


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
    named = map(Path, os.environ.get("UNDERFOOT_CATALOGUE", "").split(os.pathsep))
    folders = [path for path in named if str(path) != "."]
    if beside is not None and (Path(beside) / "catalogue").is_dir():
        folders.append(Path(beside) / "catalogue")
    folders += map(Path, extra)
    return list({path.resolve(): path for path in folders}.values())


@cache
def _built_in_tables() -> _Tables:
    with resources.as_file(resources.files("underfoot") / "data") as folder:
        return _folder_tables(folder, built_in=True)


@lru_cache(maxsize=16)
def _load_folders(folders: tuple[str, ...], content: tuple[tuple[Any, ...], ...]) -> Catalogue:
    """Read folders once for each ``content`` of their files."""
    raw = dict(_built_in_tables())
    for folder in _offered_folders():
        with suppress(InputError):  # told by ``offered_catalogues``; nobody else is touched
            raw = _folder_tables(Path(folder)) | raw  # what is there already stays
    for folder in folders:
        for (kind, name), (origin, table) in _folder_tables(Path(folder)).items():
            if (kind, name) in raw and not table.get("replaces", False):
                raise _clash(kind, name, origin, raw[kind, name][0])
            raw[kind, name] = (origin, table)
    entries: dict[tuple[str, str], Entry] = {}
    for kind, name in raw:
        offered = raw[kind, name][0].startswith(_offered_folders())
        with suppress(*(InputError,) * offered):
            _resolve(kind, name, raw, entries, ())
    return Catalogue(entries, folders)


def _offered_folders() -> tuple[str, ...]:
    """Return the folders of catalogues that other packages ship (``underfoot.catalogues``)."""
    folders = []
    for offer in offers("catalogues").values():
        with suppress(InputError):
            folders.append(str(offer.folder()))
    return tuple(folders)


def offered_catalogues() -> Iterator[str]:
    """Yield what is wrong with the catalogues that other packages ship, a line each."""
    for offer in offers("catalogues").values():
        try:
            tables = _folder_tables(offer.folder())
        except InputError as error:
            yield f"{offer}: {error}"
            continue
        for kind, name in tables.keys() & _built_in_tables().keys():
            yield f"{offer}: the {kind} {name} stays as Underfoot has it"


def _content(folder: str) -> tuple[tuple[str, str], ...]:
    """Return name and checksum of every file of a folder: a copy may keep time and size."""
    return tuple((str(file), checksum(file)) for file in sorted(Path(folder).rglob("*.toml")))


def _folder_tables(folder: Path, *, built_in: bool = False) -> _Tables:
    if not folder.is_dir():
        what = Message("the catalogue folder {folder} does not exist", folder=folder)
        raise InputError(what, allowed="a folder with TOML files")
    tables: _Tables = {}
    for file in sorted(folder.rglob("*.toml")):
        # The corpus of measurements and the classes of shoes are read by their own rooms.
        if built_in and file.parent.name in ("measurements", "friction"):
            continue
        origin = BUILT_IN if built_in else str(file)
        for kind, entries in read_toml(file).items():
            if kind not in KINDS:
                raise unknown_name("kind of catalogue entry", kind, KINDS, where=str(file))
            if not isinstance(entries, dict):
                raise InputError(
                    Message("{kind} is no table of entries", kind=kind), where=str(file)
                )
            for name, table in entries.items():
                if not isinstance(table, dict):
                    raise InputError(
                        Message("{kind}.{name} is no table", kind=kind, name=name), where=str(file)
                    )
                if (kind, name) in tables:
                    raise _clash(kind, name, str(file), tables[kind, name][0])
                tables[kind, name] = (origin, table)
    return tables


def _clash(kind: str, name: str, place: str, first_place: str) -> InputError:
    return InputError(
        Message(
            'the {kind} "{name}" is defined twice, here and in: {first_place}',
            kind=kind,
            name=name,
            first_place=first_place,
        ),
        where=place,
        remedy="Give it another name, or write replaces = true in a catalogue of your own",
    )


def _resolve(
    kind: str, name: str, raw: _Tables, done: dict[tuple[str, str], Entry], chain: tuple[str, ...]
) -> Entry:
    if (kind, name) in done:
        return done[kind, name]
    origin, table = raw[kind, name]
    where = f"{origin}, {kind}.{name}"
    if name in chain:
        raise InputError(
            Message("from leads in a circle: {names}", names=" -> ".join((*chain, name))),
            where=where,
        )
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
    for path, leaf in leaves(table, skip=_ENTRY_KEYS).items():
        unknown = replace(leaf, source=f"{_NO_SOURCE} ({origin})", assumed=True)
        values[path] = leaf if leaf.source else unknown
    title, note = str(table.get("title", name)), str(table.get("note", ""))
    done[kind, name] = Entry(kind, name, title, origin, values, note, parents)
    return done[kind, name]


def _describe_entry(entry: Entry) -> str:
    lines = [f"{entry.kind} {entry.name}: {entry.title}"]
    if entry.note:
        lines.append(entry.note)
    if entry.parents:
        lines.append(f"takes over: {', '.join(entry.parents)}")
    for path, leaf in entry.values.items():
        spread = "" if leaf.uncertainty is None else f" ± {leaf.uncertainty}"
        marks = (
            leaf.source,
            "assumed" if leaf.assumed else "",
            "" if leaf.verified else "from memory, not verified",
            "" if leaf.note == entry.note else leaf.note,
            leaf.erratum,
        )
        lines.append(f"  {path} = {leaf.given}{spread}   [{'; '.join(filter(None, marks))}]")
    return "\n".join(lines)
