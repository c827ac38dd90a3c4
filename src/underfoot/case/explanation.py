"""Explanation of a formula, an equation of the report, a catalogue entry, a key or a term."""

import inspect
import re
import sys
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from importlib import import_module
from typing import Any

from underfoot.core import InputError, display, unknown_name
from underfoot.core.catalogue import Catalogue
from underfoot.core.remark import Message

from .equations import EQUATIONS
from .parts import field_at, keys, paths, unit_at
from .quantity import default_of
from .section import Option, quantity_of
from .terms import TERMS, term
from .versions import current_path

WIDTH = 80
"""Characters of a line in a list of formulas."""
FIRST_SCREEN = 20
"""Lines of a docstring in the short form."""
ROOMS = (
    "reference material surface fluid rough_contact film friction shoe sole_contact slip trials"
).split()
_EQUATION = re.compile(r"eq(?:uation)?\.?\s*\(?(\d+)\)?", re.IGNORECASE)
_SOURCE = re.compile(r"Source: .*?(?=\n\n|$)", re.DOTALL)
_SECTION = re.compile(r"\n\n(?=[A-Z][a-z]+(?::\n|\n-{3,}))")


class Explanation(str):
    """Text that prints as it reads."""

    def __repr__(self) -> str:
        return str(self)


def explain(name: str, *, full: bool = False) -> Explanation:
    """Return what is known under a name, with the package's own catalogue; see ``explanation``."""
    return Explanation(explanation(name, Catalogue.load(), full=full))


def explanation(name: str, catalogue: Catalogue, *, full: bool = False) -> str:
    """Return what is known under a name: term, catalogue entry, key of case files and formulas.

    The short form of a formula has its equation, tested range and source; ``full`` also its
    parameters, notes and errors.

    Raises:
        InputError: An unknown name, with the nearest one; an equation that the report has not.
    """
    parts = []
    if (meaning := term(name)) is not None:
        parts.append(f"{name}: {meaning}")
    if any(entry == name for _, entry in catalogue.entries):
        parts.append(catalogue.describe(name))
    if key := _key(name):
        parts.append(key)
    parts += _keys_ending(name)
    parts += _options_named(name)
    closures = dict(_closures())
    if (equation := _EQUATION.fullmatch(name.strip())) is not None:
        number = int(equation.group(1))
        if number not in EQUATIONS:
            raise InputError(
                name,
                where="explain",
                allowed=Message("Eq. 1 to Eq. {count} of the report", count=len(EQUATIONS)),
            )
        return _equation(number, closures)
    chosen = [name] if name in closures else _find_formulas(name, closures)
    main = [each for each in chosen if name.replace("_", "").casefold() in each.casefold()]
    if len(chosen) > 1 and len(main) == 1:
        parts.append(_document_item(main[0], closures[main[0]], full=full))
        chosen = [each for each in chosen if each not in main]
    elif len(chosen) == 1:
        parts.append(_document_item(chosen[0], closures[chosen[0]], full=full))
        chosen = []
    if chosen:
        width = max(map(len, chosen))
        lines = [
            f"  {each:{width}}  {_summary(closures[each], WIDTH - width - 4)}" for each in chosen
        ]
        parts.append("Formulas (underfoot explain NAME):\n" + "\n".join(lines))
    if not parts:
        ends = {path.rpartition(".")[2] for path in paths()}
        entries = {entry for _, entry in catalogue.entries}
        names = {*TERMS, *entries, *closures, *paths(), *ends}
        raise unknown_name("name", name, names)
    return "\n\n".join(parts)


def _key(path: str) -> str:
    """Return what a key of case files is: its unit, range and default, or the options of a slot."""
    if (slot := keys().get(current_path(path))) is not None:
        return _slot(path, slot)
    field = field_at(path)
    if field is None:
        below = [key for key in paths() if key.startswith(path + ".")]
        return _fold(f"{path} holds: {', '.join(below)}") if below else ""
    lines = [f"{path}: {field.description or 'a value of case files'}"]
    quantity = quantity_of(field)
    if quantity is not None:
        unit = unit_at(path)
        lines.append(f"  unit {unit if unit != '1' else 'none'}, {quantity.range_text()}")
    default = default_of(field)
    if default is not None:
        mark = ", assumed" if default.assumed else ""
        lines.append(f"  default {default.text} ({default.source}{mark})")
    return "\n".join(lines)


def _keys_ending(name: str) -> Iterator[str]:
    """Yield what the key of case files is that ends in a word, or a list of several keys."""
    ending = [
        path for path in paths() if path.endswith(f".{name}") and (field_at(path) or path in keys())
    ]
    if len(ending) == 1:
        yield _key(ending[0])
    elif ending:
        yield _fold("Keys of case files (underfoot explain KEY): " + ", ".join(ending))


def _slot(path: str, slot: type[Option]) -> str:
    """Return what the key that names the option of a slot can be, the default first."""
    options = slot.options()
    names = sorted(options, key=lambda each: (each != slot.usual, each))
    width = max(map(len, names))
    lines = [f"{path}: {_summary(slot, WIDTH)}", "Options (underfoot explain NAME):"]
    for each in names:
        text = _summary(options[each], WIDTH - width - 4)
        lines.append(f"  {each:{width}}  {text}")
    if slot.usual:
        lines.append(f'  default "{slot.usual}"')
    return "\n".join(lines)


def _options_named(name: str) -> Iterator[str]:
    """Yield each option of a slot that has a name: what it is, its keys, its source."""
    for path, slot in keys().items():
        option = slot.options().get(name)
        if option is None:
            continue
        own = [key for key in option.model_fields if key != slot.key]
        lines = [f'{path} = "{name}": {inspect.getdoc(option)}']
        if own:
            lines.append(_fold("Keys: " + ", ".join(own)))
        if option.source:
            lines.append(f"Source: {option.source}")
        yield "\n".join(lines)


def _fold(line: str, indent: str = "  ") -> str:
    return textwrap.fill(line, WIDTH, subsequent_indent=indent, break_on_hyphens=False)


def _closures() -> Iterator[tuple[str, Any]]:
    """Yield the public functions and classes of the physics."""
    for room in ROOMS:
        module = import_module(f"underfoot.{room}")
        for name, item in sorted(vars(module).items()):
            if callable(item) and str(item.__module__).startswith("underfoot") and name[0] != "_":
                yield name, item


def _find_formulas(name: str, closures: Mapping[str, Any]) -> list[str]:
    """Return the formulas of a word or an author."""
    word = name.casefold()
    return [
        closure
        for closure, item in closures.items()
        if word in {*closure.casefold().split("_"), item.__module__.rpartition(".")[2]}
        or word.replace("_", "") == closure.casefold().replace("_", "")
    ]


def equations(item: Any) -> list[int]:
    """Return the equations of the report that a public formula computes."""
    name = f".{getattr(item, '__name__', '')}"
    return [
        number
        for number, equation in EQUATIONS.items()
        if any(path.endswith(name) for path in equation.code)
    ]


def _equation(number: int, closures: Mapping[str, Any]) -> str:
    """Return an equation of the report with its place and the formulas that compute it."""
    equation = EQUATIONS[number]
    lines = [f"Eq. {number} of the report ({equation.place}): {equation.title}"]
    if equation.code:
        lines.append(f"  {equation.formula}")
    if equation.note:
        lines.append(f"  ({equation.note})")
    for path in equation.code:
        name = path.rpartition(".")[2]
        see = f": underfoot explain {name}" if name in closures else ""
        lines.append(f"Computed by {path}{see}")
    return "\n".join(_fold(line, "    ") for line in lines)


def _equation_text(numbers: list[int]) -> str:
    if not numbers:
        return "not in the report"
    return "Eq. " + ", ".join(map(str, numbers)) + " of the report"


def _summary(item: Any, longest: int) -> str:
    first = (inspect.getdoc(item) or "not documented").partition("\n\n")[0]
    text = " ".join(first.split())
    return text if len(text) <= longest else text[: longest - 2].rstrip() + " …"


def _document_item(name: str, item: Any, *, full: bool) -> str:
    try:
        signature = str(inspect.signature(item)).replace("'", "")
    except (TypeError, ValueError):
        signature = ""
    document = inspect.getdoc(item) or "not documented"
    heading = f"{item.__module__}.{name}: {_equation_text(equations(item))}"
    if full:
        return "\n\n".join([heading, f"{name}{signature}", document, *_origin(item)])
    paragraphs = _SECTION.split(document)[0].rstrip().split("\n\n")
    first = [part for part in paragraphs if not part.startswith("Source:")]
    while len(first) > 1 and len("\n\n".join(first).splitlines()) > FIRST_SCREEN:
        first.pop()
    if len(first) < len(paragraphs) and first[-1].endswith(":"):
        first[-1] += " …"
    origin = list(_origin(item))
    if not any("Source:" in part for part in (*origin, *first)):
        written = _SOURCE.search(document)
        module = (inspect.getdoc(inspect.getmodule(item)) or "").partition("\n\n")[0]
        origin.append(written.group(0) if written else f"From: {module}")
    more = f"Parameters, notes and errors: underfoot explain {name} --all"
    return "\n\n".join([heading, *first, *origin, more])


def _origin(item: Any) -> Iterator[str]:
    """Yield source and tested ranges of a closure that is a class, as its module holds them."""
    if not (inspect.isclass(item) and is_dataclass(item)):
        return
    source = next((field.default for field in fields(item) if field.name == "source"), None)
    if isinstance(source, str):
        yield f"Source: {source}"
    ranges = getattr(sys.modules[item.__module__], "RANGES", {})
    for quantity, tested in ranges.items():
        low, high = display(tested.low, tested.unit), display(tested.high, tested.unit)
        yield f"Tested: {quantity} {low} to {high} ({tested.source})"
