"""All that is wrong with a case at once, each with its place in the file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import BaseModel, ValidationError

from underfoot.core import InputError, RangeError, nearest_match, unknown_name

from .places import Places
from .schema import field_model

_WORDS = {
    "string_type": "text",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "tuple_type": "a list",
    "model_type": "a section with its own keys",
    "model_attributes_type": "a section with its own keys",
}


class CaseError(InputError):
    """One or several errors of one case."""

    def __init__(self, errors: Iterable[InputError]) -> None:
        self.errors = tuple(errors)
        first = self.errors[0]
        super().__init__(
            first.what,
            where=first.where,
            allowed=first.allowed,
            nearest=first.nearest,
            remedy=first.remedy,
        )

    def __str__(self) -> str:
        if len(self.errors) == 1:
            return str(self.errors[0])
        listed = "\n".join(f"  - {error}" for error in self.errors)
        return f"{len(self.errors)} problems:\n{listed}"


def translated(
    error: ValidationError,
    model: type[BaseModel],
    places: Places,
    *,
    without: Iterable[str] = (),
) -> list[InputError]:
    """Return pydantic's findings in our words; what is missing within ``without`` is left out."""
    skipped = tuple(tuple(section.split(".")) for section in without)
    found = []
    for item in error.errors(include_url=False):
        location = item["loc"]
        if item["type"] == "missing" and any(location[: len(s)] == s for s in skipped):
            continue
        found.append(_translated(item, model, places))
    return found


def _translated(item: Mapping[str, Any], model: type[BaseModel], places: Places) -> InputError:
    location = tuple(str(part) for part in item["loc"])
    where = places(".".join(location))
    kind, given, context = item["type"], item.get("input"), item.get("ctx", {})
    if kind.startswith("underfoot_"):
        error = RangeError if kind == "underfoot_range" else InputError
        pieces = {name: context.get(name) for name in ("allowed", "nearest", "remedy")}
        return error(context["what"], where=where, **pieces)
    if kind == "extra_forbidden":
        owner = field_model(model, location[:-1])
        known = set(owner.model_fields) if owner else set()
        return unknown_name("key", location[-1], known, where=where)
    if kind == "missing":
        owner = field_model(model, location[:-1])
        section = bool(owner) and field_model(model, location) is not None
        return InputError(
            "this section is missing" if section else "is missing",
            where=where,
            remedy='Add it, or take the section from the catalogue with from = "name"',
        )
    if kind == "literal_error":
        choices = [
            part.strip("' ") for part in str(context["expected"]).replace(" or ", ",").split(",")
        ]
        return InputError(
            f'unknown choice "{given}"',
            where=where,
            allowed=", ".join(choices),
            nearest=nearest_match(str(given), choices),
        )
    if kind in ("greater_than_equal", "less_than_equal"):
        bound = context.get("ge", context.get("le"))
        side = "at least" if kind.startswith("greater") else "at most"
        return RangeError(f"{given} is outside the range", where=where, allowed=f"{side} {bound}")
    wanted = _WORDS.get(kind)
    return InputError(
        f"{given!r} can't be used here", where=where, allowed=wanted or item["msg"].lower()
    )
