"""Dotted paths of case files: which there are, their units, values or sections."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from underfoot.core import InputError, unknown_name

from .quantity import Quantity
from .schema import field_at, fields, marks_of, section_of

if TYPE_CHECKING:
    from pydantic import BaseModel


def known_paths(model: type[BaseModel]) -> list[str]:
    """Return every dotted path that a case file may set, sections included."""
    leaf_paths = [path for path, _ in fields(model)]
    sections = {path.rsplit(".", depth)[0] for path in leaf_paths for depth in (1, 2, 3)}
    return sorted({*leaf_paths, *sections})


def unit_of(model: type[BaseModel], path: str) -> str:
    """Return the SI unit of the value at a dotted path, ``"1"`` for words."""
    field = field_at(model, path)
    if field is None:
        raise unknown_path(model, path)
    return next((mark.unit for mark in marks_of(field) if isinstance(mark, Quantity)), "1")


def path_kind(model: type[BaseModel], path: str) -> str:
    """Return "section" or "value"; refuse unknown paths."""
    found: Any = model
    for part in path.removesuffix(".from").split("."):
        if found is None or part not in found.model_fields:
            raise unknown_path(model, path)
        found = section_of(found.model_fields[part])
    return "value" if found is None or path.endswith(".from") else "section"


def unknown_path(model: type[BaseModel], path: str) -> InputError:
    """Return the error for a path that is none, with the nearest one."""
    return unknown_name("path", path, known_paths(model))
