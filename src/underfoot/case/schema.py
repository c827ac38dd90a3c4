"""What a case file may hold: every key with its section, unit, default; and the JSON Schema."""

from __future__ import annotations

import types
import typing
from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

FILE_VERSION = 1
"""Version of the case files that this package writes; it reads this and older ones."""

CATALOGUE_SECTIONS: dict[str, tuple[str, str]] = {
    "shoe": ("shoe", ""),
    "shoe.material": ("material", ""),
    "shoe.roughness": ("material", "roughness"),
    "floor": ("floor", ""),
    "contaminant": ("fluid", ""),
    "motion": ("setup", "motion"),
    "sensor": ("setup", "sensor"),
    "risk": ("setup", "risk"),
}
"""Sections that can be taken ``from`` the catalogue: kind of entry and its sub-table."""

_SOURCED = "SourcedLeaf"


def section_of(field: FieldInfo) -> type[BaseModel] | None:
    """Return the section a field holds, or None for a value."""
    return _section(field.annotation)


def _section(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        for part in typing.get_args(annotation):
            found = _section(part)
            if found is not None:
                return found
    return None


def field_model(model: type[BaseModel], location: Sequence[str]) -> type[BaseModel] | None:
    """Return the section at a location within ``model``, looking through lists of sections."""
    found: type[BaseModel] | None = model
    for part in location:
        if found is None:
            return None
        if part.isdigit():
            continue
        field = found.model_fields.get(part)
        if field is None:
            return None
        found = section_of(field)
        if found is None:
            items = [_section(argument) for argument in typing.get_args(field.annotation)]
            found = next((item for item in items if item is not None), None)
    return found


def fields(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, FieldInfo]]:
    """Yield every leaf field of a section tree with its dotted path."""
    for name, field in model.model_fields.items():
        path = f"{prefix}{name}"
        section = section_of(field)
        if section is None:
            yield path, field
        else:
            yield from fields(section, f"{path}.")


def field_at(model: type[BaseModel], path: str) -> FieldInfo | None:
    """Return the leaf field at a dotted path, or None."""
    return dict(fields(model)).get(path)


def marks_of(field: FieldInfo) -> list[Any]:
    """Return the marks (such as the unit) annotated on a field."""
    return [*field.metadata, *_annotations(field.annotation)]


def _annotations(annotation: Any) -> list[Any]:
    found = list(getattr(annotation, "__metadata__", ()))
    for part in typing.get_args(annotation):
        found += _annotations(part)
    return found


def schema_text() -> str:
    """Return the JSON Schema of case files as text."""
    import json

    from .case import Case

    return json.dumps(json_schema(Case), indent=2, ensure_ascii=False) + "\n"


def json_schema(model: type[BaseModel]) -> dict[str, Any]:
    """Return the JSON Schema of case files: units, ranges in SI, defaults as text, ``from``."""
    schema = model.model_json_schema(mode="validation")
    marks = {name: {"type": "boolean"} for name in ("assumed", "verified")}
    marks |= {name: {"type": "string"} for name in ("source", "note")}
    sections = dict(_sections(model))
    origins = {
        sections[path].__name__: kind
        for path, (kind, _) in CATALOGUE_SECTIONS.items()
        if path in sections
    }
    for name, definition in schema["$defs"].items():
        properties = definition["properties"]
        definition["properties"] = {key: _leaf(entry) for key, entry in properties.items()}
        if name == "RelaxationTerm":
            continue
        definition["properties"].update(marks)
        # a section may come from the catalogue, so no key of it is required in the file
        definition.pop("required", None)
        if name in origins:
            definition["properties"]["from"] = {
                "type": "string",
                "description": f"a {origins[name]} of the catalogue; keys beside it override",
            }
    for path, entry in schema["properties"].items():
        plain = _leaf(entry, sourced=False)
        if path in CATALOGUE_SECTIONS:
            plain = {"anyOf": [plain, {"type": "string", "description": "name in the catalogue"}]}
        schema["properties"][path] = plain
    schema["$defs"][_SOURCED] = {
        "type": "object",
        "description": "a value with what a reader must know to trust it",
        "properties": {"value": {}, "uncertainty": {"type": ["number", "string"]}, **marks},
        "required": ["value"],
        "additionalProperties": False,
    }
    schema["required"] = sorted({*schema.get("required", ()), "contaminant"})
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "Underfoot case"
    return schema


def _sections(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, type[BaseModel]]]:
    for name, field in model.model_fields.items():
        section = section_of(field)
        if section is not None:
            yield f"{prefix}{name}", section
            yield from _sections(section, f"{prefix}{name}.")


def _leaf(entry: dict[str, Any], *, sourced: bool = True) -> dict[str, Any]:
    entry = dict(entry)
    text = entry.pop("default_text", None)
    entry.pop("default", None)
    entry.pop("title", None)
    options = [option for option in entry.pop("anyOf", []) if option.get("type") != "null"]
    if len(options) == 1:
        entry = {**options[0], **entry}
    if text is not None:
        entry["default"] = text
    if not sourced or "$ref" in entry or entry.get("type") == "array":
        return entry
    kind = entry.pop("type", None)
    plain = {"type": kind} if kind else {}
    if "enum" in entry:
        plain["enum"] = entry.pop("enum")
    return {**entry, "anyOf": [plain, {"$ref": f"#/$defs/{_SOURCED}"}]}
