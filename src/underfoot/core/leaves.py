"""One written value with what a reader must know to trust it: source, spread, marks."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Never

from .errors import InputError, unknown_name
from .units import si_unit, spread_to_si, to_si
from .values import SourcedValue

INHERITED = ("source", "assumed", "verified", "note")
"""Marks that a table hands down to the values in it."""
_LEAF_KEYS = frozenset({"value", "uncertainty", "erratum", *INHERITED})


class FrozenTable(dict[Any, Any]):
    """A table that all who read it share: it can't be changed."""

    def _raise_frozen(self, *_given: Any, **_more: Any) -> Never:
        raise InputError("this table is shared by all cases: it can't be changed")

    _refuse: Any = _raise_frozen
    __setitem__ = __delitem__ = __ior__ = update = pop = popitem = setdefault = clear = _refuse

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (dict(self),)


@dataclass(frozen=True, slots=True)
class Leaf:
    """One value as written, with what a reader must know to trust it.

    ``given`` is text with a unit, a plain number, a word, or a list of these. ``verified`` is False
    for values from memory, not checked against their source; ``erratum`` says what the source
    prints in its place.
    """

    given: Any
    source: str = ""
    uncertainty: str | float | None = None
    assumed: bool = False
    verified: bool = True
    note: str = ""
    erratum: str = ""

    def sourced_value(self, unit: str | None = None, *, where: str) -> SourcedValue:
        """Return the value in SI; ``unit`` None takes the SI unit that fits the text."""
        if unit is None:
            unit = si_unit(self.given, where=where) if isinstance(self.given, str) else "1"
        spread = self.uncertainty
        return SourcedValue(
            to_si(self.given, unit, where=where),
            unit,
            source=self.source + ("" if self.verified else " (from memory, not verified)"),
            uncertainty=None
            if spread is None
            else spread_to_si(spread, self.given, unit, where=where),
            assumed=self.assumed,
            note="; ".join(part for part in (self.note, self.erratum) if part),
        )


def leaves(
    table: Mapping[str, Any], *, source: str = "", skip: Iterable[str] = ()
) -> dict[str, Leaf]:
    """Return the leaves of nested tables by dotted path; sub-tables inherit source and marks."""
    top = {key: item for key, item in table.items() if key not in {*skip, "note"}}
    return dict(_leaves(top, "", Leaf(None, source=source)))


def _leaves(table: Mapping[str, Any], path: str, inherited: Leaf) -> Iterator[tuple[str, Leaf]]:
    inherited = replace(inherited, **{key: table[key] for key in INHERITED if key in table})
    for key, item in table.items():
        if key in INHERITED:
            continue
        where = path + key
        if isinstance(item, Mapping) and "value" in item:
            if unknown := set(item) - _LEAF_KEYS:
                raise unknown_name("mark", sorted(unknown)[0], _LEAF_KEYS, where=where)
            marks = {k: item[k] for k in (*INHERITED, "erratum") if k in item}
            if "source" in marks and "assumed" not in marks:
                marks["assumed"] = False
            spread = item.get("uncertainty")
            given = _frozen(item["value"])
            yield where, replace(inherited, given=given, uncertainty=spread, **marks)
        elif isinstance(item, Mapping):
            yield from _leaves(item, where + ".", inherited)
        else:
            yield where, replace(inherited, given=_frozen(item))


def _frozen(item: Any) -> Any:
    if isinstance(item, list):
        return tuple(map(_frozen, item))
    if isinstance(item, dict):
        return FrozenTable({key: _frozen(value) for key, value in item.items()})
    return item
