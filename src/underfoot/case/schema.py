"""The JSON Schema of case files: units, ranges in SI, defaults as text, catalogue entries."""

import json
import typing
from typing import Any

from pydantic.fields import FieldInfo

from .parts import CATALOGUE_SECTIONS, FILE_VERSION, CaseParts, slot_table
from .quantity import default_of
from .section import Option, Section, item_section, quantity_of, section_in

_SOURCED = "SourcedLeaf"
_MARKS = {
    **{name: {"type": "boolean"} for name in ("assumed", "verified")},
    **{name: {"type": "string"} for name in ("source", "note")},
}
_TYPES: dict[Any, str] = {int: "integer", bool: "boolean", str: "string", float: "number"}


def schema_text() -> str:
    """Return the JSON Schema of case files as text."""
    return json.dumps(json_schema(), indent=2, ensure_ascii=False) + "\n"


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of case files.

    A section may come from the catalogue, so no key of it is required in the file; a slot is one
    of its options, each with the keys that it takes.
    """
    definitions: dict[str, Any] = {
        _SOURCED: {
            "type": "object",
            "description": "a value with what a reader must know to trust it",
            "properties": {"value": {}, "uncertainty": {"type": ["number", "string"]}, **_MARKS},
            "required": ["value"],
            "additionalProperties": False,
        }
    }
    properties = {"file_version": {"type": "integer", "default": FILE_VERSION}}
    slot_names = slot_table()
    for name, field in CaseParts.model_fields.items():
        section = section_in(field)
        if section is None:
            properties[name] = {"type": "string", "default": field.default}
            continue
        kind = CATALOGUE_SECTIONS.get(name, ("",))[0]
        entry = _reference(section, definitions, kind)
        if kind or name in slot_names:
            plain = {"type": "string", "description": "name of an entry of the catalogue"}
            if not kind:
                plain = {"enum": list(slot_names[name].options())}
            entry = {"anyOf": [entry, plain]}
        if field.description:
            entry = {**entry, "description": field.description}
        properties[name] = entry
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Underfoot case",
        "type": "object",
        "properties": properties,
        "required": ["contaminant", "floor", "motion", "shoe"],
        "additionalProperties": False,
        "$defs": dict(sorted(definitions.items())),
    }


def _reference(section: type[Section], definitions: dict[str, Any], kind: str) -> dict[str, Any]:
    if issubclass(section, Option) and not section.name:
        options = section.options().values()
        return {"anyOf": [_reference(option, definitions, kind) for option in options]}
    name = section.__name__
    if name not in definitions:
        definitions[name] = {}  # stands for itself while its own fields are described
        definitions[name] = _definition(section, definitions, kind)
    return {"$ref": f"#/$defs/{name}"}


def _definition(section: type[Section], definitions: dict[str, Any], kind: str) -> dict[str, Any]:
    properties: dict[str, Any] = dict(_MARKS)
    if kind:
        properties["from"] = {
            "type": "string",
            "description": f"a {kind} of the catalogue; keys beside it override",
        }
    required: list[str] = []
    if issubclass(section, Option):
        choice = _with_source({"const": section.name})
        choice |= {"description": section.source} if section.source else {}
        usual = section.usual == section.name or section.chosen_by or kind
        properties[section.key] = choice
        required = [] if usual else [section.key]
    for key, field in section.model_fields.items():
        below = section_in(field)
        if below is not None:
            inner = "material" if key in ("material", "roughness") and kind == "shoe" else ""
            properties[key] = _reference(below, definitions, inner)
            if issubclass(below, Option) and not below.name:
                names = {"enum": list(below.options())}
                properties[key] = {"anyOf": [properties[key], names]}
        elif (item := item_section(field)) is not None:
            entry = {"type": "array", "items": _reference(item, definitions, "")}
            properties[key] = _describe_entry(entry, field)
        else:
            properties[key] = _leaf(field)
    return {
        "type": "object",
        "description": (section.__doc__ or "").strip().splitlines()[0],
        "properties": properties,
        **({"required": required} if required else {}),
        "additionalProperties": False,
    }


def _leaf(field: FieldInfo) -> dict[str, Any]:
    quantity = quantity_of(field)
    if quantity is not None:
        kinds = ["number", "string"] if quantity.unit == "1" else ["string"]
        limits = {"minimum_si": quantity.low, "maximum_si": quantity.high}
        entry = _with_source({"type": kinds}) | {"unit": quantity.unit} | limits
    else:
        parts = [part for part in _parts(field.annotation) if part is not type(None)]
        literal = next((p for p in parts if typing.get_origin(p) is typing.Literal), None)
        choices = {"enum": list(typing.get_args(literal))}
        entry = _with_source(choices if literal else {"type": _TYPES.get(parts[0], "string")})
    return _describe_entry(entry, field)


def _describe_entry(entry: dict[str, Any], field: FieldInfo) -> dict[str, Any]:
    known = default_of(field)
    if known is not None:
        entry = {**entry, "default": known.text}
    description = field.description or (known.source if known is not None else "")
    return entry | ({"description": description} if description else {})


def _with_source(plain: dict[str, Any]) -> dict[str, Any]:
    return {"anyOf": [plain, {"$ref": f"#/$defs/{_SOURCED}"}]}


def _parts(annotation: Any) -> list[Any]:
    if typing.get_origin(annotation) in (None, typing.Literal):
        return [annotation]
    if typing.get_origin(annotation) is typing.Annotated:
        return _parts(typing.get_args(annotation)[0])
    return [part for inner in typing.get_args(annotation) for part in _parts(inner)]
