"""What every section of a case is: frozen fields that know where they come from; slots.

A *slot* is one choice of the case (its friction law, its tread pattern). It is a class derived from
``Option`` that names the slot; each option is a class derived from that one, with its own fields,
checks, sources and ``build``. Defining the class is all that a new option takes.
"""

import types
import typing
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, Protocol, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    GetCoreSchemaHandler,
    ModelWrapValidatorHandler,
    PrivateAttr,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, InitErrorDetails, core_schema

from underfoot.core import InputError, SourcedValue, unknown_name
from underfoot.core.arrays import of_python
from underfoot.core.leaves import INHERITED, Leaf
from underfoot.core.registry import all_offers, find_offer, load_address, offers
from underfoot.core.remark import Message
from underfoot.core.units import spread_to_si

from .quantity import Quantity, default_of, refusal

GIVEN, CATALOGUE, DEFAULT, FILE = "given", "catalogue", "default", "file"


@dataclass(frozen=True, slots=True)
class Origin:
    """Where one value comes from, and the value (SI) that this is true of."""

    kind: str
    """given, catalogue, default, or file: what a file beside the value holds"""
    leaf: Leaf
    entry: str = ""
    value: Any = None
    uncertainty: float | None = None


class CaseView(Protocol):
    """The sections of a case, for checks that look beyond their own section."""

    shoe: Any
    floor: Any
    contaminant: Any
    motion: Any
    interface: Any
    numerics: Any
    film: Any
    compliance: Any
    friction: Any


class Section(BaseModel):
    """Base of all sections: frozen, SI floats inside, each value with its origin.

    A value may be given with what a reader must know to trust it: as ``SourcedValue`` or as a
    mapping with ``value`` and any of ``uncertainty``, ``source``, ``assumed``, ``verified``,
    ``note``.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    file_paths: ClassVar[tuple[str, ...]] = ()
    """Paths of files: a hash counts their names alone, and the checksums beside them."""
    replaced: ClassVar[tuple[str, ...]] = ()
    """Fields that name a file whose content is a field beside them."""
    without_spread: ClassVar[str] = ""
    """Why no value has a standard deviation of its own; "" where numbers may have one."""

    _origins: dict[str, Origin] = PrivateAttr(default_factory=dict)
    _entry: str = PrivateAttr(default="")

    @model_validator(mode="wrap")
    @classmethod
    def _with_origins(
        cls, given: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo
    ) -> Self:
        entry = given._entry if isinstance(given, Section) else ""
        if isinstance(given, Section):
            given = given.tree()
        if not isinstance(given, Mapping):
            return handler(given)
        given = cls.in_own_terms(given)
        origins = {key: origin for key, item in given.items() if (origin := origin_of(item))}
        plain = {
            key: of_python(origins[key].leaf.given) if key in origins else of_python(item)
            for key, item in given.items()
        }
        if issubclass(cls, Option):
            plain.pop(cls.key, None)
        section = handler(plain)
        section._origins = {
            key: cls._bound(section, key, origin) for key, origin in origins.items()
        }
        section._entry = entry
        for name in section.model_fields_set:
            items = getattr(section, name)
            for number, item in enumerate(items if isinstance(items, tuple) else (), start=1):
                cls._refuse_spreads(item, (name, number))
        return section

    @classmethod
    def _refuse_spreads(cls, item: Any, path: tuple[str | int, ...]) -> None:
        """Refuse a standard deviation in an item of a list, which nothing reads."""
        origins = item._origins if isinstance(item, Section) else {}
        for key, origin in origins.items():
            if origin.uncertainty is not None:
                error = InputError(
                    "a value in a list has no standard deviation of its own",
                    allowed="sd of a friction reading; of others none",
                    remedy="Leave uncertainty out",
                )
                where = (*map(str, path), key, "uncertainty")
                raise refused_at(cls, where, error, origin.leaf.uncertainty)

    @classmethod
    def in_own_terms(cls, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return what was given with the terms of a trade put into the fields of the section."""
        return given

    @classmethod
    def _bound(cls, section: "Section", key: str, origin: Origin) -> Origin:
        """Return the origin tied to the value that the section holds."""
        field, written = cls.model_fields.get(key), origin.leaf.uncertainty
        if field is None and written is None:
            return origin
        uncertainty = None
        if written is not None:
            number = field is not None and quantity_of(field)
            number = number and isinstance(getattr(section, key), float | None)
            if why := cls.without_spread or ("" if number else "it is no quantity"):
                error = InputError(
                    Message("has no standard deviation: {why}", why=why),
                    remedy="Leave uncertainty out",
                )
                raise refused_at(cls, (key, "uncertainty"), error, written)
            assert field is not None
            unit = unit_of(field)
            given, plain = of_python(origin.leaf.given), of_python(written)
            if all(type(each) in (int, float) for each in (given, plain)):  # both are SI
                plain = plain_text(plain, unit)
            try:
                uncertainty = spread_to_si(plain, given, unit, where="")
                if uncertainty < 0:
                    raise InputError(
                        Message("{written} is negative", written=written), allowed="0 or more"
                    )
            except InputError as error:
                raise refused_at(cls, (key, "uncertainty"), error, written) from error
        return replace(origin, value=getattr(section, key), uncertainty=uncertainty)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in type(self).model_fields:
            raise InputError(
                Message("a section of a case is frozen: {name} can't be set", name=name),
                where=f"{type(self).__name__}.{name}",
                remedy=Message(
                    'Make a new case: case.replace("PATH.{name}", ...), or a new section: '
                    "section.model_copy(update={update})",
                    name=name,
                    update=f'{{"{name}": ...}}',
                ),
            )
        super().__setattr__(name, value)

    def __delattr__(self, name: str) -> None:
        self.__setattr__(name, None)

    def tree(self) -> dict[str, Any]:
        """Return what was set, sub-sections and values, each value with its origin if it has one.

        Giving it to the class again makes an equal section.
        """
        tree: dict[str, Any] = {}
        if isinstance(self, Option) and (self.key in self._origins or self.name != self.usual):
            tree[self.key] = self._origins.get(self.key, self.name)
        for name in type(self).model_fields:
            value = getattr(self, name)
            if isinstance(value, Section):
                tree[name] = value
            elif name in self.model_fields_set:
                origin = self._origins.get(name)
                tree[name] = origin if origin is not None and origin.value == value else value
        return tree

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return the section with other values, checked; what is unchanged keeps its origin."""
        new = type(self).model_validate({**self.tree(), **(update or {})})
        new._entry = self._entry
        return new

    def origin(self, name: str) -> Origin | None:
        """Return where a value comes from; "given" where it isn't what its origin stands for."""
        if isinstance(self, Option) and name == self.key:
            leaf = Leaf(self.name, source=self.source)
            return self._origins.get(name, Origin(DEFAULT, leaf, value=self.name))
        value = getattr(self, name)
        origin = self._origins.get(name)
        if origin is not None and origin.value == value:
            return origin
        if value is None or isinstance(value, Section):
            return None
        field = type(self).model_fields[name]
        known = default_of(field)
        if name not in self.model_fields_set:
            if known is None:
                return None
            leaf = Leaf(known.text, source=known.source, assumed=known.assumed)
            return Origin(DEFAULT, leaf, value=value)
        return Origin(GIVEN, Leaf(plain_text(value, unit_of(field))), value=value)

    def sourced_value(self, name: str) -> SourcedValue:
        """Return a number of the section with its uncertainty, source and marks."""
        value, unit = getattr(self, name), unit_of(type(self).model_fields[name])
        if value is None:
            return SourcedValue(None, unit, reason="not given in the case")
        if not isinstance(value, float | int):
            raise InputError(
                Message("{name} is no number", name=name), allowed="the path of a quantity"
            )
        origin = self.origin(name)
        if origin is None:
            return SourcedValue(float(value), unit, source="case")
        leaf = origin.leaf
        source = leaf.source or ("given in the case" if origin.kind == GIVEN else origin.kind)
        return SourcedValue(
            float(value),
            unit,
            source=source + ("" if leaf.verified else " (from memory, not verified)"),
            uncertainty=origin.uncertainty,
            assumed=leaf.assumed,
            note="; ".join(part for part in (leaf.note, leaf.erratum) if part),
        )

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        """Return the section's table with what it takes from files; paths count from ``folder``."""
        return table

    def code(self) -> Any:
        """Return what of other packages it is computed with, beside its own class."""
        return None

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        """Return the fields of the section that count for nothing: this case reads them nowhere."""
        return ()

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        """Yield what does not fit together; ``where`` is the section's path in the case."""
        return iter(())


class Option(Section):
    """One choice of a slot, with everything that belongs to it."""

    slot: ClassVar[str] = ""
    """Name of the slot and of the entry-point group ``underfoot.<slot>`` of other packages."""
    key: ClassVar[str] = "model"
    """Key by which a file names the option."""
    usual: ClassVar[str | None] = None
    """Option of the slot when none is named; None makes the choice required."""
    name: ClassVar[str] = ""
    source: ClassVar[str] = ""
    """Paper, equation or reason behind the option."""
    chosen_by: ClassVar[tuple[str, ...]] = ()
    """Keys that choose this option when none is named."""
    reads: ClassVar[tuple[str, ...]] = ()
    """Paths of other sections that only some options read; nobody else lets them be given."""
    consults: ClassVar[tuple[str, ...]] = ()
    """Kinds of entries that it looks up in ``context.catalogue``, which holds no others."""

    _known: ClassVar[dict[str, dict[str, type["Option"]]]] = {}

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        name = cls.__dict__.get("name")
        if not name:
            return
        present = cls._known.setdefault(cls.slot, {})
        other, where = present.get(name), f"{cls.__module__}.{cls.__qualname__}"
        option = {"slot": cls.slot, "name": name}
        if other is not None and f"{other.__module__}.{other.__qualname__}" != where:
            ours = other.__module__.startswith("underfoot.")
            by = "Underfoot" if ours else other.__module__
            what = Message('the {slot} option "{name}" is defined by {by}', **option, by=by)
            raise InputError(what, where=where, remedy="Give the class another name")
        if missing := sorted(cls.__abstractmethods__):
            what = Message(
                'the {slot} option "{name}" does not define {missing}', **option, missing=missing
            )
            remedy = Message("Define it as the other options of {slot} do", slot=cls.slot)
            raise InputError(what, where=where, remedy=remedy)
        present[name] = cls

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        if cls.name:
            return handler(source)
        return core_schema.with_info_plain_validator_function(cls._validate)

    @classmethod
    def _validate(cls, given: Any, info: ValidationInfo) -> "Option":
        return cls.pick(given).model_validate(
            {cls.key: given} if isinstance(given, str) else given, context=info.context
        )

    @classmethod
    def options(cls) -> dict[str, type["Option"]]:
        """Return the options of the slot by name, those of other packages too where they load."""
        list(cls.load_failures())  # ``underfoot doctor`` and who asks for it are told
        return dict(cls.known_options())

    @classmethod
    def load_failures(cls) -> Iterator[str]:
        """Yield what is wrong with each option that a package offers and that can't be loaded."""
        for name in offers(cls.slot).keys() - cls.known_options().keys():
            try:
                find_offer(cls.slot, name, cls._wrong)
            except InputError as error:
                yield error.what

    @classmethod
    def known_options(cls) -> dict[str, type["Option"]]:
        """Return the options of the slot whose classes are defined by now."""
        return cls._known.get(cls.slot, {})

    @classmethod
    def count(cls) -> int:
        """Return how many options all slots have: what is derived from them goes by it."""
        return sum(map(len, cls._known.values()))

    @classmethod
    def pick(cls, given: Any) -> type["Option"]:
        """Return the class of the option that ``given`` names, or that its keys choose."""
        if isinstance(given, cls):
            return type(given)
        if isinstance(given, str):
            given = {cls.key: given}
        if not isinstance(given, Mapping):
            allowed = Message(
                "one of {options}, or a section with its own keys", options=", ".join(cls.options())
            )
            raise refusal(
                "input",
                InputError(
                    Message("{given} can't be used here", given=repr(given)), allowed=allowed
                ),
            )
        origin = origin_of(given.get(cls.key))
        name = given.get(cls.key) if origin is None else origin.leaf.given
        if name is None:
            keys = {key for key, value in given.items() if value is not None}
            chosen = (o for o in cls.known_options().values() if keys & set(o.chosen_by))
            option = next(chosen, None) or cls.known_options().get(cls.usual or "")
            if option is None:
                error = InputError("is missing", allowed=", ".join(cls.options()))
                raise refused_at(cls, (cls.key,), error, given)
            return option
        option = cls.known_options().get(str(name))
        if option is not None:
            return option
        all_offers.cache_clear()  # a package may have been installed since
        try:
            return cls._elsewhere(str(name))
        except InputError as error:
            raise refused_at(cls, (cls.key,), error, name) from error

    @classmethod
    def _elsewhere(cls, name: str) -> type["Option"]:
        """Return the option that a package offers by this name, or at ``module:Class``."""
        if ":" not in name:
            option = find_offer(cls.slot, name, cls._wrong)
            return option or _find_option(cls.options(), name)
        option = load_address(name)
        if wrong := cls._wrong(option):
            raise InputError(f'"{name}" {wrong}')
        return option

    @classmethod
    def _wrong(cls, option: Any) -> str:
        """Return why an object is no option of the slot, "" where it is one."""
        slot = next((base for base in cls.__mro__ if "slot" in base.__dict__), cls)
        if isinstance(option, type) and issubclass(option, slot) and option.name:
            return ""
        address = f"{slot.__module__}.{slot.__qualname__}"
        return f"is no option of {cls.slot}: no class derived from {address} with a name"

    def __repr__(self) -> str:
        shown = [f"{name}={getattr(self, name)!r}" for name in sorted(self.model_fields_set)]
        return f"{type(self).__name__}({', '.join(shown)})"


def _find_option(options: Mapping[str, type[Option]], name: str) -> type[Option]:
    if name not in options:
        error = unknown_name("choice", name, options)
        raise InputError(error.what, allowed=", ".join(options), nearest=error.nearest)
    return options[name]


def refused_at(
    cls: type[Section], path: tuple[str, ...], error: InputError, given: Any
) -> ValidationError:
    """Return the validation error of a field that was given what it can't be."""
    details = InitErrorDetails(type=refusal("input", error), loc=path, input=given)
    return ValidationError.from_exception_data(cls.__name__, [details])


def origin_of(item: Any) -> Origin | None:
    """Return the origin that a given value carries; None for a plain value."""
    if isinstance(item, Origin):
        return item
    if isinstance(item, SourcedValue):
        value, spread = (plain_text(x, item.unit) for x in (item.value, item.uncertainty))
        marks = {"source": item.source, "assumed": item.assumed, "note": item.note}
        return Origin(GIVEN, Leaf(value, uncertainty=spread, **marks))
    if isinstance(item, Mapping) and "value" in item:
        marks = {name: item[name] for name in (*INHERITED, "erratum") if name in item}
        return Origin(GIVEN, Leaf(item["value"], uncertainty=item.get("uncertainty"), **marks))
    return None


def from_catalogue(item: Any) -> bool:
    """Return whether a value, or every value of a table, is one of the catalogue."""
    if isinstance(item, dict):
        return all(from_catalogue(value) for value in item.values())
    origin = origin_of(item)
    return origin is not None and origin.kind == CATALOGUE


def with_file_values(
    table: Mapping[str, Any], values: Mapping[str, SourcedValue | Any], name: str
) -> dict[str, Any]:
    """Return a section's table with the ``values`` of its file ``name``.

    What was given goes before them; they go before the catalogue, and before those of an earlier
    file.
    """
    given = {}
    for key, item in table.items():
        origin = origin_of(item)
        if key not in values or origin is None or origin.kind not in (CATALOGUE, FILE):
            given[key] = item
    origins = {}
    for key, value in values.items():
        given_origin = origin_of(value)
        leaf = Leaf(value) if given_origin is None else given_origin.leaf
        origins[key] = Origin(FILE, leaf, name)
    return {**origins, **given}


def leaf_of(item: Any) -> Leaf:
    """Return a given value with the marks that it carries."""
    origin = origin_of(item)
    return Leaf(item) if origin is None else origin.leaf


def plain_text(value: Any, unit: str) -> Any:
    """Return an SI value as a file writes it: exact, with its unit."""
    value = of_python(value)
    if isinstance(value, bool) or not isinstance(value, float | int) or unit == "1":
        return value
    return f"{value!r} {unit}"


@cache
def _section_in(annotation: Any) -> type[Section] | None:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return annotation
    if typing.get_origin(annotation) in (typing.Union, types.UnionType, typing.Annotated):
        return next(filter(None, map(_section_in, typing.get_args(annotation))), None)
    return None


def section_in(field: FieldInfo) -> type[Section] | None:
    """Return the section (or slot) that a field holds, or None for a value."""
    return _section_in(field.annotation)


def item_section(field: FieldInfo) -> type[Section] | None:
    """Return the section of which a field holds a list, or None."""
    parts = [field.annotation, *typing.get_args(field.annotation)]
    lists = [part for part in parts if typing.get_origin(part) is tuple]
    items = [_section_in(item) for part in lists for item in typing.get_args(part)]
    return next(filter(None, items), None)


def _marks_in(annotation: Any) -> list[Any]:
    marks = list(getattr(annotation, "__metadata__", ()))
    for part in typing.get_args(annotation):
        marks += _marks_in(part)
    return marks


def quantity_of(field: FieldInfo) -> Quantity | None:
    """Return the unit and range of a field; None for words, counts and switches."""
    marks = [*field.metadata, *_marks_in(field.annotation)]
    return next((mark for mark in marks if isinstance(mark, Quantity)), None)


_UNITS: dict[int, tuple[FieldInfo, str]] = {}


def unit_of(field: FieldInfo) -> str:
    """Return the SI unit of a field, ``"1"`` for words."""
    known = _UNITS.get(id(field))
    if known is None or known[0] is not field:
        quantity = quantity_of(field)
        known = _UNITS[id(field)] = (field, "1" if quantity is None else quantity.unit)
    return known[1]


def walk(section: Section, path: str = "") -> Iterator[tuple[str, Section]]:
    """Yield every section below one, with its dotted path."""
    for name in type(section).model_fields:
        value = getattr(section, name)
        if isinstance(value, Section):
            here = f"{path}.{name}" if path else name
            yield here, value
            yield from walk(value, here)
