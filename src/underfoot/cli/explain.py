"""``underfoot explain``: a formula, a catalogue entry, a key of case files or a word."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import CatalogueFolders

if TYPE_CHECKING:
    from collections.abc import Iterator

_ROOMS = "reference material surface fluid asperity film friction outsole slip trials".split()


def explain(
    name: Annotated[
        str,
        typer.Argument(
            help="A formula (glycerol_water_viscosity), a catalogue entry (canola_oil), "
            "a key (contaminant.viscosity) or a word (acof).",
            show_default=False,
        ),
    ],
    catalogue: CatalogueFolders = None,
) -> None:
    """Explain a formula, a catalogue entry, a key of case files or a word of the field."""
    from underfoot.core.errors import unknown_name

    from .options import catalogue_for
    from .terms import TERMS

    known = catalogue_for(None, catalogue)
    found = []
    if name.casefold() in TERMS:
        found.append(f"{name}: {TERMS[name.casefold()]}")
    if any(entry == name for _, entry in known.entries):
        found.append(known.describe(name))
    key = _key(name)
    if key:
        found.append(key)
    closures = dict(_closures())
    if name in closures:
        found.append(_documented(name, closures[name]))
    else:
        found += [
            _documented(one, item)
            for one, item in closures.items()
            if name.casefold() in {*one.casefold().split("_"), item.__module__.rpartition(".")[2]}
        ]
    if not found:
        from underfoot.case import paths

        names = {*TERMS, *(entry for _, entry in known.entries), *closures, *paths()}
        raise unknown_name("name", name, names)
    print("\n\n".join(found))


def _key(path: str) -> str:
    from underfoot.case import Case, paths, unit_at
    from underfoot.case.quantity import Quantity, default_of
    from underfoot.case.schema import field_at, marks_of

    field = field_at(Case, path)
    if field is None:
        keys = [key for key in paths() if key.startswith(path + ".")]
        return f"{path} holds: {', '.join(keys)}" if keys else ""
    lines = [f"{path}: {field.description or 'a value of case files'}"]
    quantity = next((mark for mark in marks_of(field) if isinstance(mark, Quantity)), None)
    if quantity is not None:
        unit = unit_at(path)
        lines.append(f"  unit {unit if unit != '1' else 'none'}, {quantity.allowed()}")
    default = default_of(field)
    if default is not None:
        mark = ", assumed" if default.assumed else ""
        lines.append(f"  default {default.text} ({default.source}{mark})")
    return "\n".join(lines)


def _closures() -> Iterator[tuple[str, Any]]:
    """Yield the public functions and classes of the physics."""
    from importlib import import_module
    from importlib.util import find_spec

    for room in _ROOMS:
        if find_spec(f"underfoot.{room}") is None:
            continue
        module = import_module(f"underfoot.{room}")
        for name in getattr(module, "__all__", ()):
            item = getattr(module, name)
            if callable(item):
                yield name, item


def _documented(name: str, item: Any) -> str:
    try:
        signature = str(inspect.signature(item))
    except (TypeError, ValueError):
        signature = ""
    text = f"{item.__module__}.{name}{signature}\n\n{inspect.getdoc(item) or 'not documented'}"
    return "\n\n".join([text, *_origin(item)])


def _origin(item: Any) -> Iterator[str]:
    """Yield source and tested ranges of a closure that is a class, as its module holds them."""
    import sys
    from dataclasses import fields, is_dataclass

    from underfoot.core import display

    if not (inspect.isclass(item) and is_dataclass(item)):
        return
    source = next((field.default for field in fields(item) if field.name == "source"), None)
    if isinstance(source, str):
        yield f"Source: {source}"
    ranges = getattr(sys.modules[item.__module__], "RANGES", {})
    for quantity, tested in ranges.items():
        low, high = display(tested.low, tested.unit), display(tested.high, tested.unit)
        yield f"Tested: {quantity} {low} to {high} ({tested.source})"
