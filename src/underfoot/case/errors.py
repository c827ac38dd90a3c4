"""All that is wrong with a case at once, each with its place in the file."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from underfoot.core import InputError, RangeError, nearest_match, unknown_name
from underfoot.core.remark import Message

from .parts import CaseParts, nearest_path
from .section import Option, Section, item_section, section_in

_TYPES = {
    "string_type": "text",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "tuple_type": "a list",
    "model_type": "a section with its own keys",
    "model_attributes_type": "a section with its own keys",
}
Place = Callable[[str], str]


class CaseError(InputError):
    """One or several errors of one case."""

    def __init__(self, errors: Iterable[InputError]) -> None:
        self.errors = tuple(errors)
        first = self.errors[0]
        super().__init__(first.what, where=first.where, **first.parts)

    @property
    def message(self) -> Message:
        """All that is wrong, a line each."""
        if len(self.errors) == 1:
            return self.errors[0].message
        return Message(
            "{count} problems:\n  - {errors:\n  - }", count=len(self.errors), errors=self.errors
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.errors,)


def place_error(error: InputError, places: Place) -> InputError:
    """Return the error with its place in the file."""
    return type(error)(error.what, where=places(error.where or ""), **error.parts)


def translate_errors(
    error: ValidationError,
    model: type[Section],
    tree: Any,
    places: Place,
    *,
    without: Iterable[str] = (),
) -> list[InputError]:
    """Return the findings of a validation; what is missing within ``without`` is left out."""
    skipped = tuple(tuple(section.split(".")) for section in without)
    return [
        _translate_error(item, model, tree, places)
        for item in error.errors(include_url=False)
        if item["type"] != "missing" or not any(item["loc"][: len(s)] == s for s in skipped)
    ]


def _owner(model: type[Section], tree: Any, location: tuple[str, ...]) -> type[Section] | None:
    """Return the section at a location, of a slot the option that the tree chooses there."""
    owner: type[Section] | None = model
    for part in location:
        if part.isdigit():
            continue
        field = None if owner is None else owner.model_fields.get(part)
        if field is None:
            return None
        owner = section_in(field) or item_section(field)
        tree = tree.get(part) if isinstance(tree, Mapping) else None
        if owner is not None and issubclass(owner, Option) and not owner.name:
            try:
                owner = owner.pick(tree or {})
            except (ValidationError, PydanticCustomError):
                return None
    return owner


def _translate_error(
    item: Mapping[str, Any], model: type[Section], tree: Any, places: Place
) -> InputError:
    location = tuple(str(part) for part in item["loc"])
    where = places(".".join(location))
    kind, given, context = item["type"], item.get("input"), item.get("ctx", {})
    if kind.startswith("underfoot_"):
        error = RangeError if kind == "underfoot_range" else InputError
        pieces = {name: context.get(name) for name in ("allowed", "nearest", "remedy")}
        return error(context["what"], where=where, **pieces)
    if kind == "extra_forbidden":
        error = _not_taken(_owner(model, tree, location[:-1]), location[-1], where)
        if not (error.nearest or error.remedy) and issubclass(model, CaseParts):
            error.nearest = nearest_path(".".join(location))
        return error
    if kind == "missing":
        return _missing(_owner(model, tree, location[:-1]), location[-1], where)
    if kind == "literal_error":
        choices = [
            part.strip("' ") for part in str(context["expected"]).replace(" or ", ",").split(",")
        ]
        return InputError(
            Message('unknown choice "{given}"', given=given),
            where=where,
            allowed=", ".join(choices),
            nearest=nearest_match(str(given), choices),
        )
    if kind in ("greater_than_equal", "less_than_equal"):
        bound = context.get("ge", context.get("le"))
        low = kind.startswith("greater")
        return RangeError(
            Message("{given} is outside the range", given=given),
            where=where,
            allowed=Message("at least {least}", least=bound)
            if low
            else Message("at most {most}", most=bound),
        )
    return InputError(
        Message("{given} can't be used here", given=repr(given)),
        where=where,
        allowed=_TYPES.get(kind) or item["msg"].lower(),
    )


def _not_taken(owner: type[Section] | None, key: str, where: str) -> InputError:
    known = set(owner.model_fields) if owner else set()
    if owner is None or not issubclass(owner, Option):
        return unknown_name("key", key, known, where=where)
    others = {name: o for name, o in owner.options().items() if key in o.model_fields}
    if others:
        choice = " or ".join(f'{owner.key} = "{name}"' for name in others)
        return InputError(
            Message('is not used by {key} = "{name}"', key=owner.key, name=owner.name),
            where=where,
            allowed=", ".join(sorted(known)),
            remedy=Message("Remove it, or write {choice}", choice=choice),
        )
    siblings = {name for o in owner.options().values() for name in o.model_fields}
    known |= {owner.key}
    error = unknown_name("key", key, known, where=where)
    nearest = nearest_match(key, known | siblings)
    if nearest is None or nearest in known:
        return error
    takers = [name for name, o in owner.options().items() if nearest in o.model_fields]
    choice = " or ".join(f'{owner.key} = "{name}"' for name in takers)
    pieces = {
        "nearest": nearest,
        "remedy": Message("{nearest} belongs to {choice}", nearest=nearest, choice=choice),
    }
    return InputError(error.what, where=where, **(error.parts | pieces))


def _missing(owner: type[Section] | None, key: str, where: str) -> InputError:
    field = None if owner is None else owner.model_fields.get(key)
    add = 'Add it, or take the section from the catalogue with from = "name"'
    if field is not None and section_in(field) is not None:
        return InputError("this section is missing", where=where, remedy=add)
    extra = field.json_schema_extra if field is not None else None
    stated = extra if isinstance(extra, dict) else {}
    what = str(stated.get("missing", "is missing"))
    remedy = str(stated.get("remedy") or "")
    if owner is not None and issubclass(owner, Option) and "missing" not in stated:
        what = Message('is missing for {key} = "{name}"', key=owner.key, name=owner.name)
    if not remedy and field is not None and field.description:
        remedy = Message("Give {key}: {description}", key=key, description=field.description)
    return InputError(what, where=where, remedy=remedy or add)
