"""The content of things as a hash: two that compute different numbers never share one.

Numbers, text, arrays and mappings count by what they hold; an object by its class and its fields;
a class or function of another package by its code as it is loaded and by the text and version of
that package. Equal content of this package's own kinds gives equal hashes on every machine.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from functools import cache, cached_property
from importlib import metadata
from pathlib import Path
from types import (
    CodeType,
    FunctionType,
    GetSetDescriptorType,
    MappingProxyType,
    MemberDescriptorType,
    MethodType,
    ModuleType,
)
from typing import Any
from uuid import uuid4

import numpy as np

OWN = "underfoot"
UNKNOWN = "unknown"
CODE = (".py", ".toml", ".csv", ".json", ".so", ".pyd")
"""Endings of the files of a package that decide what it computes."""
DEEPEST = 60
"""Things within things; deeper ones are not read."""
_PLAIN = (bool, int, str, complex, type(None))
_KINDS = (np.ndarray, dict, MappingProxyType, list, tuple, set, frozenset, MethodType, CodeType)
_CACHED = type(cache(len))
_SLOTS = (MemberDescriptorType, GetSetDescriptorType)
_NO_CODE = ("_abc_impl",)
_UNNAMED: dict[int, tuple[Any, str]] = {}


def content_hash(*parts: Any) -> str:
    """Return a hash of what the parts hold, 64 hexadecimal digits.

    What can't be read (an open file, a handle of compiled code) counts as equal to itself alone.

    >>> content_hash([1.0, "a"]) == content_hash([1.0, "b"])
    False
    """
    walk = _Walk()
    for part in parts:
        walk.feed(part)
    return walk.digest.hexdigest()


def files_hash(folders: Sequence[str]) -> str:
    """Return a hash of the names and content of the program and data files in folders."""
    paths = [path for folder in folders for path in sorted(Path(folder).rglob("*"))]
    return _text_hash(path for path in paths if path.suffix in CODE)


@cache
def program_hash() -> str:
    """Return a hash of this package's own text and version: another code's numbers aren't ours."""
    return content_hash(package_version(OWN), files_hash((str(Path(__file__).parents[1]),)))


def package_version(name: str) -> str:
    """Return the version of a package, ``UNKNOWN`` where it is not recorded.

    An application that was frozen, or a folder on the path, carries no record of versions.
    """
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return UNKNOWN


class _Walk:
    """Feeds a digest with things, each told apart from all that is written otherwise."""

    def __init__(self) -> None:
        self.digest = hashlib.sha256()
        self._open: list[int] = []
        self._code: set[int] = set()

    def feed(self, part: Any) -> None:
        """Feed one thing."""
        if isinstance(part, np.generic):
            part = part.item()
        if isinstance(part, Enum):
            self._list("enum", (type(part), part.name))
        elif isinstance(part, float):
            self._text("float", part.hex())
        elif isinstance(part, _PLAIN):
            self._text(type(part).__name__, json.dumps(str(part)))
        elif isinstance(part, bytes | bytearray | Path):
            self._text(type(part).__name__, repr(part))
        elif isinstance(part, ModuleType):
            self._text("module", part.__name__)
        elif isinstance(part, type):
            self._class(part)
        elif isinstance(part, FunctionType):
            self._function(part)
        elif id(part) in self._open:  # a thing that holds itself
            self._text("up", str(self._open[::-1].index(id(part))))
        elif len(self._open) > DEEPEST:
            self._add_unnamed(part)
        else:
            self._open.append(id(part))
            self._compound(part)
            self._open.pop()

    def _text(self, kind: str, text: str) -> None:
        self.digest.update(f"{kind}{text};".encode())

    def _list(self, kind: str, items: Iterable[Any]) -> None:
        self.digest.update(f"{kind}[".encode())
        for item in items:
            self.feed(item)
        self.digest.update(b"]")

    def _compound(self, part: Any) -> None:
        if isinstance(part, np.ndarray) and part.dtype != object:
            array = np.ascontiguousarray(part)
            self.digest.update(f"array{array.dtype.str}{array.shape}".encode())
            self.digest.update(array.tobytes())
        elif isinstance(part, Mapping):
            by_name = all(isinstance(key, str) for key in part)
            self.digest.update(b"{")
            for key in sorted(part, key=None if by_name else _order):
                self.feed(key)
                self.feed(part[key])
            self.digest.update(b"}")
        elif isinstance(part, list | tuple):
            self._list("", part)
        elif isinstance(part, set | frozenset):
            self._list("set", sorted(part, key=_order))
        elif isinstance(part, MethodType):
            self._list("method", (part.__func__, part.__self__))
        elif isinstance(part, CodeType):
            self._list("code", (part.co_code, part.co_consts, part.co_names))
        elif (inner := _inner_function(part)) is not None:
            self.feed(inner)
        else:
            self._object(part)
            return
        if type(part) not in _KINDS:
            self._list("object", (type(part), attributes(part)))

    def _object(self, part: Any) -> None:
        """Feed an object by its class and attributes; by what it is copied from where it says."""
        cls = type(part)
        try:
            made = part.__reduce_ex__(4)
        except Exception:  # whatever another package raises: it can't be read
            self._add_unnamed(part)
            return
        self._list("object", (cls, attributes(part)))
        if isinstance(made, str):
            self._text("global", made)
        elif (cls.__reduce__, cls.__reduce_ex__) != (object.__reduce__, object.__reduce_ex__):
            function, given, state, items, pairs = (*made, None, None, None)[:5]
            self._list("made", (function, given, _without_lazy(cls, state)))
            self._list("items", [*(items or ()), *(pairs or ())])

    def _add_unnamed(self, part: Any) -> None:
        self._text("unnamed", _UNNAMED.setdefault(id(part), (part, uuid4().hex))[1])

    def _in_code(self, value: Any) -> Any:
        """Return a value that code refers to; of an object of a library its class alone."""
        plain = (*_PLAIN, *_KINDS, float, np.generic, Enum, type, FunctionType, ModuleType)
        if isinstance(value, plain) or _inner_function(value) is not None:
            return value
        return type(value) if self._told_by_version(type(value)) else value

    def _class(self, cls: type) -> None:
        self._text("class", f"{cls.__module__}.{cls.__qualname__}")
        for base in cls.__mro__:
            if self._told_by_version(base) or id(base) in self._code:
                continue
            self._code.add(id(base))
            self._text("text", _package_text(base.__module__))
            for name, member in sorted(vars(base).items()):
                self._member(name, member)

    def _member(self, name: str, member: Any) -> None:
        if isinstance(member, property):
            self._list(name, (member.fget, member.fset))
        elif isinstance(member, classmethod | staticmethod):
            self._list(name, (member.__func__,))
        elif isinstance(member, cached_property):
            self._list(name, (member.func,))
        elif isinstance(member, FunctionType) or not (name.startswith("__") or name in _NO_CODE):
            self._list(name, (() if isinstance(member, _SLOTS) else self._in_code(member),))

    def _function(self, function: FunctionType) -> None:
        self._text("function", f"{function.__module__}.{function.__qualname__}")
        if id(function) in self._code:
            return
        self._code.add(id(function))
        cells = [_content(cell) for cell in function.__closure__ or ()]
        self._list("given", (function.__defaults__, function.__kwdefaults__, cells))
        if self._told_by_version(function):
            return
        self._text("text", _package_text(function.__module__))
        self.feed(function.__code__)
        names = set(_names(function.__code__))
        for name in sorted(names & function.__globals__.keys()):
            value = function.__globals__[name]
            if isinstance(value, ModuleType) and not self._told_by_version(value):
                value = {key: vars(value)[key] for key in sorted(names & vars(value).keys())}
            self._list(name, (self._in_code(value),))

    def _told_by_version(self, part: Any) -> bool:
        """Return whether a version says all of the code behind a class, function or module."""
        name = part.__name__ if isinstance(part, ModuleType) else part.__module__ or ""
        top = name.partition(".")[0]
        if top == OWN or (top in sys.stdlib_module_names and top != "__main__"):
            return True
        if not _required_packages() & set(map(_plain, _distributions(top))):
            return False
        self._text("library", f"{top} {_versions(top)}")
        return True


def _order(item: Any) -> tuple[str, str]:
    """Return what things are sorted by that have no order of their own."""
    return type(item).__name__, re.sub(r" at 0x[0-9a-f]+", "", repr(item))


def _content(cell: Any) -> Any:
    try:
        return cell.cell_contents
    except ValueError:  # not filled yet
        return None


def _names(code: CodeType) -> Iterable[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)


def _inner_function(part: Any) -> Any:
    """Return the function within a cached or compiled one, else None."""
    inner = getattr(part, "__wrapped__", None) if isinstance(part, _CACHED) else None
    return inner or getattr(part, "py_func", None)


def attributes(part: Any) -> dict[str, Any]:
    """Return what an object holds, without what is computed from that when it is asked for."""
    slots = [vars(base).get("__slots__", ()) for base in type(part).__mro__]
    names = [name for slot in slots for name in ([slot] if isinstance(slot, str) else slot)]
    held = {name: getattr(part, name) for name in names if hasattr(part, name)}
    held.pop("__weakref__", None)
    return _without_lazy(type(part), {**held, **getattr(part, "__dict__", {})})


def _without_lazy(cls: type, state: Any) -> Any:
    if not isinstance(state, Mapping):
        return state
    lazy = {
        name
        for base in cls.__mro__
        for name, member in vars(base).items()
        if isinstance(member, cached_property)
    }
    return {name: value for name, value in state.items() if name not in lazy}


def _package_text(module: str) -> str:
    """Return a hash of the version and the present text of the package that a module is of."""
    top = module.partition(".")[0]
    present = sys.modules.get(top)
    folders = list(getattr(present, "__path__", ()))
    file = getattr(present, "__file__", None)
    text = files_hash(folders) if folders else _text_hash([Path(file)] if file else ())
    return f"{top} {_versions(top)} {text}"


def _text_hash(paths: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for path in paths:
        if path.is_file():
            content = path.read_bytes()
            digest.update(f"{path.name} {len(content)} ".encode() + content)
    return digest.hexdigest()


@cache
def _distributions(top: str) -> Sequence[str]:
    """Return the packages that bring a module; that of its name alone, found at once, if any."""
    if top and package_version(top) != UNKNOWN:
        return (top,)
    return sorted(set(_all_distributions().get(top, ())))


@cache
def _all_distributions() -> Mapping[str, Sequence[str]]:
    return metadata.packages_distributions()  # reads the list of files of every package: 0.5 s


@cache
def _versions(top: str) -> str:
    return " ".join(f"{name} {package_version(name)}" for name in _distributions(top))


@cache
def _required_packages() -> frozenset[str]:
    """Return the packages that this one requires: the version of one says its code."""
    try:
        lines = metadata.requires(OWN) or []
    except metadata.PackageNotFoundError:
        lines = ["numpy", "scipy", "xarray", "pydantic"]
    return frozenset(_plain(re.split(r"[^\w.-]", line, maxsplit=1)[0]) for line in lines)


def _plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()
