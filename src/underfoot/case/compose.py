"""From what a case gives and the catalogue to one complete tree of values with their origins."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from underfoot.core import InputError, unknown_name
from underfoot.core.catalogue import Catalogue, Entry
from underfoot.core.leaves import Leaf, leaves
from underfoot.core.remark import Message

from .errors import CaseError, Place, place_error
from .friction import FrictionOption
from .parts import CATALOGUE_SECTIONS, CaseParts, slot_table
from .section import (
    CATALOGUE,
    DEFAULT,
    GIVEN,
    Option,
    Origin,
    Section,
    from_catalogue,
    origin_of,
    section_in,
)
from .versions import RENAMED, SHORT

DRY = "none"
MEASURED_CONTACT = "contact_table"
"""Option of ``rough_contact`` where nobody chose one and its inputs are measured."""
_ALTERNATIVES = {
    "contaminant.viscosity": ("contaminant.glycerol_fraction", "contaminant.fraction_basis"),
    "contaminant.glycerol_fraction": ("contaminant.viscosity",),
    "shoe.material.shore_a": ("shoe.material.modulus",),
    "shoe.roughness.ra": ("shoe.roughness.rq",),
    "floor.roughness.ra": ("floor.roughness.rq",),
    "shoe.roughness.rz": ("shoe.roughness.ra", "shoe.roughness.rq"),
    "floor.roughness.rz": ("floor.roughness.ra", "floor.roughness.rq"),
}
"""Given value: values of the catalogue that it stands in for."""


@dataclass(slots=True)
class Composition:
    """Tree of values with origins, catalogue entries by section, and what went wrong."""

    catalogue: Catalogue
    places: Place
    folder: Path
    lenient: Callable[[str], bool]
    """whether a given value at a path is left out where no chosen option takes it"""
    tree: dict[str, Any] = field(default_factory=dict)
    entries: dict[str, str] = field(default_factory=dict)
    errors: list[InputError] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    """sections whose entry is not in the catalogue"""
    dropped: dict[str, str] = field(default_factory=dict)
    """path of a given value that no chosen option takes: why"""


def compose_case(
    given: Mapping[str, Any],
    catalogue: Catalogue,
    places: Place,
    folder: Path,
    lenient: Callable[[str], bool],
) -> Composition:
    """Return the values of a case.

    A section's ``from`` is laid first, then that of its sub-sections (which replaces the whole
    sub-section), then what is given. Catalogue values that the chosen options don't take are left
    out; given ones too where ``lenient`` says so of their path, else they are an error later.
    """
    composition = Composition(catalogue, places, folder, lenient)
    tables = {key: expand_sections(item, key, composition.entries) for key, item in given.items()}
    laid: dict[str, Origin] = {}
    for section in sorted(CATALOGUE_SECTIONS, key=lambda path: path.count(".")):
        name = _from(tables, section)
        if name is not None and not (section == "contaminant" and name == DRY):
            _lay(composition, laid, section, name)
    _lay_roughness_of_compound(composition, laid)
    try:
        given_leaves = leaves(_without_from(tables), source="")
    except InputError as error:
        raise CaseError([*composition.errors, place_error(error, places)]) from error
    record, beneath = _friction_record(composition, tables), dict(laid)
    for path, leaf in given_leaves.items():
        origin = leaf.given if isinstance(leaf.given, Origin) else origin_of(leaf.given)
        if origin is None:
            origin = Origin(GIVEN, leaf)
        if path.startswith("friction.") and _of_another_fluid(origin, composition.entries):
            continue
        for other in _ALTERNATIVES.get(path, ()):
            if other in beneath and laid.get(other) is beneath[other]:
                del laid[other]
        laid[path] = origin
        record.pop(path, None)
    tree = _nest_values({**record, **laid}, tables)
    if tables.get("contaminant") is not None and _from(tables, "contaminant") == DRY:
        tree["contaminant"] = None
    composition.tree = _settle_section(composition, CaseParts, tree, "")
    _settle_hardness(composition)
    _settle_contact(composition)
    _settle_reads(composition)
    return composition


def expand_sections(item: Any, path: str, entries: dict[str, str] | None = None) -> Any:
    """Return sections as mappings, and names of entries and options as keys of a mapping."""
    if isinstance(item, Section):
        if entries is not None and item._entry:
            entries[path] = item._entry
        item = {k: v for k, v in item.tree().items() if k not in type(item).replaced}
    elif isinstance(item, str):
        if path in CATALOGUE_SECTIONS:
            return {"from": item}
        slot = slot_table().get(path)
        return item if slot is None else {slot.key: item}
    if not isinstance(item, Mapping) or "value" in item:
        return item
    return {key: expand_sections(below, f"{path}.{key}", entries) for key, below in item.items()}


def _lay(composition: Composition, laid: dict[str, Origin], section: str, name: Any) -> None:
    kind, part = CATALOGUE_SECTIONS[section]
    catalogue, where = composition.catalogue, composition.places(f"{section}.from")
    if not isinstance(name, str):
        composition.errors.append(
            InputError(Message("{name} is no name", name=repr(name)), where=where, allowed="text")
        )
        return
    try:
        entry = catalogue.entry(kind, name, where=where)
    except InputError as error:
        if section == "contaminant":
            error.remedy = 'A dry floor is contaminant = "none"'
        composition.errors.append(error)
        composition.failed.append(section)
        return
    if part and not entry.under(part):
        known = [n for n in catalogue.names(kind) if catalogue.entry(kind, n).under(part)]
        composition.errors.append(
            unknown_name(
                Message("{kind} with {part}", kind=kind, part=part), name, known, where=where
            )
        )
    for path in [path for path in laid if path.startswith(section + ".")]:
        del laid[path]
    for path, leaf in _part(entry, part, section).items():
        full = f"{section}.{path}"
        laid[RENAMED.get(full) or SHORT.get(full) or full] = Origin(
            CATALOGUE, leaf, f"{kind} {name}"
        )
    composition.entries[section] = name


def _lay_roughness_of_compound(composition: Composition, laid: dict[str, Origin]) -> None:
    """Put the roughness of a compound, if known, in place of that read on a shoe of another."""
    compound = composition.entries.get("shoe.material")
    if compound is None or "shoe.roughness" in composition.entries:
        return
    for path in [path for path in laid if path.startswith("shoe.roughness.")]:
        del laid[path]
    for path, leaf in composition.catalogue.entry("material", compound).under("roughness").items():
        laid[f"shoe.roughness.{path}"] = Origin(CATALOGUE, leaf, f"material {compound}")


def _part(entry: Entry, part: str, section: str) -> dict[str, Leaf]:
    if part:
        return entry.under(part)
    other = {"shoe.material": "roughness.", "contaminant": "boundary."}.get(section, "-")
    return {path: leaf for path, leaf in entry.values.items() if not path.startswith(other)}


def _friction_record(composition: Composition, tables: Mapping[str, Any]) -> dict[str, Origin]:
    """Return what the catalogue knows of friction under the fluid and the chosen law takes."""
    catalogue, name = composition.catalogue, composition.entries.get("contaminant")
    if name is None or ("fluid", name) not in catalogue.entries:
        return {}
    try:
        option = FrictionOption.pick(tables.get("friction", {}))
    except (ValidationError, PydanticCustomError):
        return {}
    return {
        f"friction.{key}": Origin(CATALOGUE, leaf, f"fluid {name}")
        for key, leaf in catalogue.entry("fluid", name).under("boundary").items()
        if key in option.model_fields
    }


def _of_another_fluid(origin: Origin, entries: Mapping[str, str]) -> bool:
    ours = f"fluid {entries.get('contaminant', '')}"
    return origin.kind == CATALOGUE and origin.entry.startswith("fluid ") and origin.entry != ours


def _nest_values(origins: Mapping[str, Origin], tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values as nested tables; the empty tables that were given are kept."""
    tree = _sections(tables)
    for path, origin in origins.items():
        *parents, key = path.split(".")
        table = tree
        for parent in parents:
            table = table.setdefault(parent, {})
            if not isinstance(table, dict):
                raise InputError("is both a value and a section", where=path)
        table[key] = origin
    return tree


def _sections(table: Mapping[str, Any]) -> dict[str, Any]:
    return {
        key: _sections(item)
        for key, item in table.items()
        if isinstance(item, Mapping) and "value" not in item
    }


def _settle_section(
    composition: Composition, model: type[Section], table: dict[str, Any], path: str
) -> dict[str, Any]:
    """Return a section's table without what its option does not take, with what files hold."""
    if issubclass(model, Option) and not model.name:
        known = model.known_options().values()
        try:
            model = model.pick(table)
        except (ValidationError, PydanticCustomError):
            return table  # validation says what is wrong
        for key in [k for k in table if k != model.key and k not in model.model_fields]:
            here = f"{path}.{key}"
            if not any(key in option.model_fields for option in known):
                continue
            if from_catalogue(table[key]):
                del table[key]
            elif composition.lenient(here):
                del table[key]
                composition.dropped[here] = Message(
                    'not used by {key} = "{name}"', key=model.key, name=model.name
                )
    try:
        table = model.complete_data(table, composition.folder, path)
    except InputError as error:
        composition.errors.append(place_error(error, composition.places))
        composition.failed.append(path)
    for key, info in model.model_fields.items():
        section = section_in(info)
        if section is not None and isinstance(table.get(key), dict):
            below = f"{path}.{key}" if path else key
            table[key] = _settle_section(composition, section, table[key], below)
    return table


def _settle_hardness(composition: Composition) -> None:
    material = composition.tree.get("shoe", {})
    for part in ("material", "modulus"):
        material = material.get(part) if isinstance(material, dict) else None
    if material is None or (isinstance(material, Origin) and material.leaf.given is None):
        return
    given = composition.tree.pop("hardness", None)
    composition.tree["hardness"] = None
    if not isinstance(given, dict) or not given:
        return
    if composition.lenient("hardness.model"):
        composition.dropped["hardness.model"] = "not used beside a measured modulus"
        return
    composition.errors.append(
        InputError(
            "is not used: the modulus of the compound is given",
            where=composition.places("hardness.model"),
            remedy="Remove it, or shoe.material.modulus",
        )
    )


def _settle_contact(composition: Composition) -> None:
    """Let two measured surfaces meet with a measured spectrum, where no contact is chosen.

    A modulus alone is that at rest: at the rates of sliding the rubber is stiffer and lets more
    fluid through.
    """
    given = composition.tree.get("rough_contact") or {}
    origin = origin_of(given.get("model"))
    if given and not (given.keys() == {"model"} and origin and origin.kind == DEFAULT):
        return
    composition.tree.pop("rough_contact", None)

    def value(*path: str) -> Any:
        item: Any = composition.tree
        for part in path:
            item = item.get(part) if isinstance(item, dict) else None
        return item

    def is_measured(item: Any) -> bool:
        """Return whether a value, or every value of a table, is given and not assumed."""
        if isinstance(item, dict):
            return bool(item) and all(map(is_measured, item.values()))
        origin = origin_of(item)
        return item is not None and not (origin and (origin.leaf.assumed or not origin.leaf.given))

    inputs = [value(part, "roughness", "file") for part in ("shoe", "floor")]
    if all(map(is_measured, [*inputs, value("shoe", "material", "relaxation")])):
        why = "both surfaces and the compound are measured"
        leaf = Leaf(MEASURED_CONTACT, source=why)
        composition.tree["rough_contact"] = {"model": Origin(DEFAULT, leaf, value=MEASURED_CONTACT)}


def _settle_reads(composition: Composition) -> None:
    """Take out, or refuse, what only options that were not chosen would read."""
    chosen = set()
    for name, slot in _top_slots().items():
        try:
            chosen |= set(slot.pick(composition.tree.get(name) or {}).reads)
        except (ValidationError, PydanticCustomError):
            return
    for path, readers in optional_reads().items():
        section, _, key = path.rpartition(".")
        table = composition.tree.get(section)
        if path in chosen or not isinstance(table, dict) or key not in table:
            continue
        if not from_catalogue(table[key]):
            if not composition.lenient(path):
                remedy = Message("Remove it, or choose {readers}", readers=" or ".join(readers))
                what = "is not read by any chosen option"
                error = InputError(what, where=composition.places(path), remedy=remedy)
                composition.errors.append(error)
                continue
            composition.dropped[path] = "not read by any chosen option"
        del table[key]


def _top_slots() -> dict[str, type[Option]]:
    return {path: slot for path, slot in slot_table().items() if "." not in path}


def optional_reads() -> dict[str, list[str]]:
    """Return the paths that only some options read, with the options that do."""
    reads: dict[str, list[str]] = {}
    for name, slot in _top_slots().items():
        for option in slot.known_options().values():
            for path in option.reads:
                reads.setdefault(path, []).append(f'{name}.{slot.key} = "{option.name}"')
    return reads


def _from(tables: Mapping[str, Any], section: str) -> Any:
    table: Any = tables
    for part in section.split("."):
        if not isinstance(table, Mapping) or part not in table:
            return None
        table = table[part]
    return table.get("from") if isinstance(table, Mapping) else None


def _without_from(table: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    kept: dict[str, Any] = {}
    for key, item in table.items():
        here = f"{path}.{key}" if path else key
        if key == "from" and path in CATALOGUE_SECTIONS:
            continue
        kept[key] = _without_from(item, here) if isinstance(item, Mapping) else item
    return kept
