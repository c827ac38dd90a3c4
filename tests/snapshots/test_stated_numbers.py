"""The numbers that the source states are those of before: constants, defaults, ranges of fields.

A default that changes a number is a breaking change: whoever moves one of these sees it here, and
names it with its cause.
"""

import ast
import inspect
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import underfoot
from snapshot import held
from source_trees import tree

SOURCE = Path(underfoot.__file__).parent
ROOMS = [
    "underfoot.app", "underfoot.block", "underfoot.calibrate", "underfoot.case", "underfoot.cli",
    "underfoot.compute", "underfoot.core", "underfoot.explore", "underfoot.film",
    "underfoot.fluid", "underfoot.friction", "underfoot.material", "underfoot.places",
    "underfoot.questions", "underfoot.reference", "underfoot.report", "underfoot.rough_contact",
    "underfoot.shoe", "underfoot.slip", "underfoot.sole_contact", "underfoot.studies",
    "underfoot.surface", "underfoot.trials",
]  # fmt: skip
LONGEST = 400
"""Numbers of one name, beyond which it is a table of data, which has tests of its own."""


class Name(str):
    """The field of an object that the numbers behind it stand in."""

    __repr__ = str.__str__


def numbers(value: Any, seen: tuple[int, ...] = ()) -> Iterator[Any]:
    """Yield the numbers in a value, in their order; sets in the order of their text."""
    if id(value) in seen:
        return
    seen = (*seen, id(value))
    if isinstance(value, Enum | str | bytes):
        return
    if isinstance(value, bool | int | float | complex | np.generic):
        yield value.item() if isinstance(value, np.generic) else value
    elif isinstance(value, np.ndarray):
        yield from value.ravel().tolist() if value.dtype.kind in "biufc" else ()
    elif isinstance(value, Mapping):
        for key, part in value.items():
            yield from numbers(key, seen)
            yield from numbers(part, seen)
    elif isinstance(value, set | frozenset):
        for part in sorted(value, key=repr):
            yield from numbers(part, seen)
    elif isinstance(value, tuple | list):
        for part in value:
            yield from numbers(part, seen)
    elif hasattr(value, "__metadata__"):  # of Annotated
        yield from numbers(value.__metadata__, seen)
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            given = list(numbers(getattr(value, field.name, None), seen))
            yield from [Name(field.name), *given] if given else ()
    elif hasattr(value, "__slots__") and type(value).__module__.startswith("annotated_types"):
        yield from numbers([getattr(value, name) for name in value.__slots__], seen)


def defaults(call: Any) -> Iterator[tuple[str, Any]]:
    """Yield the parameters of a function that have a default, with it."""
    try:
        parameters = inspect.signature(call).parameters.values()
    except (TypeError, ValueError):
        return
    for one in parameters:
        if one.default is not inspect.Parameter.empty:
            yield f"({one.name})", one.default


def of_class(kind: type) -> Iterator[tuple[str, Any]]:
    """Yield what a class states: constants, defaults and ranges of fields, defaults of methods."""
    if is_dataclass(kind):
        for field in fields(kind):
            if field.default is not MISSING:
                yield f".{field.name}", field.default
    for name, field in getattr(kind, "model_fields", {}).items():
        if name in inspect.get_annotations(kind):
            yield f".{name}", (field.default, field.metadata, field.json_schema_extra)
    for name, value in list(vars(kind).items()):
        if name.startswith("__") or name in ("model_fields", "model_config"):
            continue
        call = getattr(value, "__func__", value)
        if inspect.isfunction(call):
            for parameter, default in defaults(call):
                yield f".{name}{parameter}", default
        elif not callable(value) and (name.isupper() or not isinstance(value, dict | list | set)):
            yield f".{name}", value


def is_filled_later(node: ast.expr | None) -> bool:
    """Return whether a name begins empty: a memory of this process, which states nothing."""
    if isinstance(node, ast.Call):
        made = node.func.value if isinstance(node.func, ast.Subscript) else node.func
        kind = ast.unparse(made).rpartition(".")[2].lower()
        return kind.endswith(("dict", "dictionary", "list", "set")) and not node.args
    begun = {ast.Dict: "keys", ast.List: "elts", ast.Set: "elts"}
    return type(node) in begun and not getattr(node, begun[type(node)])


def stated(module: Any, path: Path) -> Iterator[tuple[str, Any]]:
    """Yield what a module states itself, in the order of its lines."""
    for node in tree(path).body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and not is_filled_later(node.value):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for name in (one.id for each in targets for one in ast.walk(each)
                         if isinstance(one, ast.Name)):  # fmt: skip
                if hasattr(module, name):
                    yield name, getattr(module, name)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            call = getattr(module, node.name, None)
            for parameter, default in defaults(getattr(call, "py_func", call)):
                yield f"{node.name}{parameter}", default
        elif isinstance(node, ast.ClassDef) and isinstance(
            kind := getattr(module, node.name, None), type
        ):
            for name, value in of_class(kind):
                yield f"{node.name}{name}", value


@pytest.mark.parametrize("room", ROOMS)
def test_the_numbers_of_a_room(room, file_regression):
    folder = SOURCE / room.removeprefix("underfoot.")
    lines = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        if parts[-1] == "__main__":
            continue
        module = import_module(".".join(("underfoot", *parts)).removesuffix(".__init__"))
        for name, value in stated(module, path):
            given = list(numbers(value))
            if 0 < len(given) <= LONGEST:
                lines[f"{'/'.join(parts[1:])}: {name}"] = " ".join(map(repr, given))
    assert lines
    held(file_regression, "\n".join(f"{name} = {text}" for name, text in lines.items()), room)


def test_every_room_is_looked_at():
    assert [f"underfoot.{p.name}" for p in sorted(SOURCE.iterdir()) if (p / "__init__.py").exists()
            and p.name != "data"] == ROOMS  # fmt: skip
