"""From a case file and the catalogue to one complete set of values, each knowing its origin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from underfoot.core import InputError, unknown_name
from underfoot.core.catalogue import Catalogue, Entry
from underfoot.core.leaves import Leaf, leaves

from .errors import CaseError
from .places import Places
from .schema import CATALOGUE_SECTIONS

GIVEN = "given"
CATALOGUE = "catalogue"
DEFAULT = "default"
DRY = "none"


@dataclass(frozen=True, slots=True)
class Composition:
    """Values by path, catalogue entries by section, errors met, sections that were not found."""

    origins: dict[str, Origin]
    entries: dict[str, str]
    errors: list[InputError]
    failed: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Origin:
    """Where one value of a case comes from: ``kind`` is given, catalogue or default."""

    kind: str
    leaf: Leaf
    entry: str = ""


def composed(mapping: Mapping[str, Any], catalogue: Catalogue, places: Places) -> Composition:
    """Return the leaves of a case, which section came from which entry, and what went wrong.

    A section's ``from`` is laid first, then that of its sub-sections (which replaces the whole
    sub-section), then the keys of the file.
    """
    errors: list[InputError] = []
    failed: list[str] = []
    tables = {key: _expanded(key, item) for key, item in mapping.items()}
    found: dict[str, Origin] = {}
    entries: dict[str, str] = {}
    for section in sorted(CATALOGUE_SECTIONS, key=lambda path: path.count(".")):
        name = _from(tables, section)
        if name is None or (section == "contaminant" and name == DRY):
            continue
        kind, part = CATALOGUE_SECTIONS[section]
        where = places(f"{section}.from")
        if not isinstance(name, str):
            errors.append(InputError(f"{name!r} is no name", where=where, allowed="text"))
            continue
        try:
            entry = catalogue.entry(kind, name, where=where)
        except InputError as error:
            errors.append(error)
            failed.append(section)
            continue
        _replace_section(found, section, _part(entry, part, section), f"{kind} {name}")
        if part and not entry.under(part):
            known = [n for n in catalogue.names(kind) if catalogue.entry(kind, n).under(part)]
            errors.append(unknown_name(f"{kind} with {part}", name, known, where=where))
        entries[section] = name
    try:
        own = leaves(_without_from(tables), source="")
    except InputError as error:
        raise CaseError([*errors, _placed(error, places)]) from error
    for path, leaf in own.items():
        _drop_alternatives(found, path)
        found[path] = Origin(GIVEN, leaf)
    return Composition(found, entries, errors, tuple(failed))


def nested(origins: Mapping[str, Origin], mapping: Mapping[str, Any]) -> dict[str, Any]:
    """Return the given values as nested tables; the empty tables of ``mapping`` are kept."""
    tree: dict[str, Any] = {}
    for section in _tables({key: _expanded(key, item) for key, item in mapping.items()}):
        table = tree
        for part in section.split("."):
            table = table.setdefault(part, {})
    for path, origin in origins.items():
        *parents, key = path.split(".")
        table = tree
        for parent in parents:
            table = table.setdefault(parent, {})
            if not isinstance(table, dict):
                raise InputError("is both a value and a section", where=path)
        table[key] = origin.leaf.given
    return tree


def _tables(table: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    for key, item in table.items():
        if isinstance(item, Mapping) and "value" not in item:
            yield f"{prefix}{key}"
            yield from _tables(item, f"{prefix}{key}.")


def _expanded(key: str, item: Any) -> Any:
    """Return ``shoe = "name"`` as ``shoe = {from = "name"}``."""
    return {"from": item} if key in CATALOGUE_SECTIONS and isinstance(item, str) else item


def _from(tables: Mapping[str, Any], section: str) -> Any:
    table: Any = tables
    for part in section.split("."):
        if not isinstance(table, Mapping) or part not in table:
            return None
        table = table[part]
    if isinstance(table, str):
        return table
    return table.get("from") if isinstance(table, Mapping) else None


def _without_from(table: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    kept: dict[str, Any] = {}
    for key, item in table.items():
        here = f"{path}.{key}" if path else key
        if key == "from" and path in CATALOGUE_SECTIONS:
            continue
        if here in CATALOGUE_SECTIONS and isinstance(item, str):
            continue
        kept[key] = _without_from(item, here) if isinstance(item, Mapping) else item
    return kept


def _part(entry: Entry, part: str, section: str) -> dict[str, Leaf]:
    if part:
        return entry.under(part)
    if section == "shoe.material":
        return {path: v for path, v in entry.values.items() if not path.startswith("roughness.")}
    return dict(entry.values)


def _replace_section(
    found: dict[str, Origin], section: str, values: Mapping[str, Leaf], entry: str
) -> None:
    for path in [path for path in found if path.startswith(section + ".")]:
        del found[path]
    for path, leaf in values.items():
        found[f"{section}.{path}"] = Origin(CATALOGUE, leaf, entry)


def _drop_alternatives(found: dict[str, Origin], path: str) -> None:
    """Drop what a given value stands in for, so that no given value is silently unused."""
    alternatives = {
        "contaminant.viscosity": ("contaminant.glycerol_fraction", "contaminant.fraction_basis"),
        "contaminant.glycerol_fraction": ("contaminant.viscosity",),
        "shoe.material.shore_a": ("shoe.material.modulus",),
        "shoe.roughness.ra": ("shoe.roughness.rq",),
        "floor.roughness.ra": ("floor.roughness.rq",),
    }
    for other in alternatives.get(path, ()):
        if other in found and found[other].kind == CATALOGUE:
            del found[other]


def _placed(error: InputError, places: Places) -> InputError:
    return InputError(
        error.what,
        where=places(error.where or ""),
        allowed=error.allowed,
        nearest=error.nearest,
        remedy=error.remedy,
    )
